/* SPDX-License-Identifier: BSD-3-Clause */
/* The core of the checker. A leaf with the direction n proves that a part of the mover is farther than delta from a
 * set, if min n·psi over the control points of the part  -  max n·x over the set  >  (delta + radius + margin) |n|:
 * weak duality, for any n whatever. The leaves together cover all of the parameter range. */
#include "check.h"

#include <float.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "bytes.h"
#include "inequalities.h"
#include "near.h"
#include "pieces.h"
#include "quick.h"
#include "robot_check.h"
#include "support.h"
#include "winding.h"

enum { MAX_DEPTH = 256, BALLS = 4 };

/* Bits of the arithmetic: few at first, many for what the few leave open. Doubles with radii come before (quick.h). */
static const int BITS[PIECES_LEVELS] = {640, 4096};

/* What a section is checked against. */
typedef struct section {
  reader *in;
  uint32_t width;
  const set *set;
  pieces *mover, *obstacle; /* obstacle: of a set that is a curve */
  pieces *clock[3];         /* NULL, or what else is at the mover's parameter: its growth; the set's ride and growth */
  const set *carried;       /* by the mover, or NULL */
  double from, until;       /* the part of the mover that is spoken of, in pieces */
  double balls[BALLS];      /* delta, radius, margin, that of what is carried */
  size_t *leaves;
} section;

typedef struct part {
  double from, to;
} part;

/* As a leaf has it: n, or of a body by inequalities where the multipliers stand that make n. */
typedef struct direction {
  double n[3];
  reader multipliers;
} direction;

static direction read_direction(const section *c) {
  direction d = {.multipliers = *c->in};
  if (c->set->kind == IMPLICIT)
    inequalities_skip(c->set, c->width, c->in);
  else
    reader_normal(c->in, c->width, d.n);
  return d;
}

/* What a number that is known within an interval is. */
typedef enum sign { NOT_POSITIVE, POSITIVE, OPEN } sign;

static sign sign_of(const iv *a) {
  if (iv_is_positive(a)) return POSITIVE;
  return mpfr_number_p(a->hi) && mpfr_sgn(a->hi) <= 0 ? NOT_POSITIVE : OPEN;
}

/* out = max n·x over the posed set, without margin; n becomes that of its own frame. */
static void reach_along(iv *out, const set *s, iv n[3]) {
  iv *w = iv_new(1), *own = iv_new(3);
  support_of_frame(out, own, s, n);
  support_of_body(w, s, own);
  iv_add(out, out, w);
  iv_free(w, 1);
  iv_free(own, 3);
}

/* The least height along n of what moves over the set, of all that is at one parameter: the mover's curve; less the
 * set's, seen as its first pose turns it; less |n| times what both grow. */
static void least_height(iv *out, const section *c, int level, const iv n[3], part mine) {
  iv *own = iv_new(3), *far = iv_new(1), *thick = iv_new(3);
  const set outer = support_outermost(c->set);
  support_of_frame(far, own, &outer, n);
  for (int k = 0; k < 3; k++) iv_neg(&own[k], &own[k]);
  iv_norm(&thick[0], n);
  iv_neg(&thick[0], &thick[0]);
  pieces_share shares[4] = {{c->mover, n}};
  size_t n_shares = 1;
  for (int i = 0; i < 3; i++)
    if (c->clock[i]) shares[n_shares++] = (pieces_share){c->clock[i], i == 1 ? own : thick};
  pieces_least(out, shares, n_shares, level, mine.from, mine.to);
  iv_free(own, 3);
  iv_free(far, 1);
  iv_free(thick, 3);
}

/* Is what the two are apart along n more than n makes of the balls? Of all of the set, or of a part of a curve. */
static sign separation(const section *c, int level, const direction *along, part mine, const part *theirs) {
  iv *n = iv_new(3), *own = iv_new(3), *w = iv_new(3), *gap = iv_new(1);
  const bool flat = c->set->kind == HALFSPACE, implicit = c->set->kind == IMPLICIT; /* a halfspace has one direction */
  reader multipliers = along->multipliers;
  const bool known = !implicit || inequalities_reach(n, &w[1], c->set, c->width, &multipliers);
  for (int k = 0; k < 3 && !implicit; k++) iv_set_d(&n[k], flat ? c->set->size[k] : along->n[k]);
  if (flat || implicit) support_to_world(n, c->set);
  support_of_frame(&w[0], own, c->set, n);
  if (theirs) {
    for (int k = 0; k < 3; k++) iv_neg(&own[k], &own[k]);
    pieces_least(&w[1], &(pieces_share){c->obstacle, own}, 1, level, theirs->from, theirs->to);
    iv_neg(&w[1], &w[1]);
  } else if (!implicit) {
    support_of_body(&w[1], c->set, own);
  }
  iv_add(&w[0], &w[0], &w[1]);
  if (c->carried) {
    for (int k = 0; k < 3; k++) iv_neg(&own[k], &n[k]);
    reach_along(&w[1], c->carried, own);
    iv_add(&w[0], &w[0], &w[1]);
  }
  for (int i = 0; i < BALLS; i++) {
    iv_set_d(&w[1], c->balls[i]);
    iv_add(gap, gap, &w[1]);
  }
  iv_norm(&w[1], n);
  const sign proper = sign_of(&w[1]);
  iv_mul(&w[1], &w[1], gap);
  iv_add(&w[0], &w[0], &w[1]);
  least_height(&w[2], c, level, n, mine);
  iv_sub(&w[2], &w[2], &w[0]);
  const sign apart = sign_of(&w[2]);
  iv_free(n, 3);
  iv_free(own, 3);
  iv_free(w, 3);
  iv_free(gap, 1);
  return !known ? NOT_POSITIVE : proper == POSITIVE ? apart : proper;
}

/* One leaf. More bits are for what fewer leave open, and for nothing else: to refuse it needs no more than to accept.
 */
static bool separates(const section *c, const direction *along, part mine, const part *theirs) {
  const set group =
      theirs && c->set->corners > 0 ? set_group(c->set, (size_t)theirs->from, (size_t)theirs->to) : (set){.corners = 0};
  section of_group = *c;
  if (group.n > 0) {
    of_group.set = &group;
    theirs = NULL;
    c = &of_group;
  }
  quick_query quick = {.set = c->set, .mover = c->mover, .obstacle = c->obstacle, .from = mine.from, .to = mine.to};
  if (theirs) {
    quick.theirs[0] = theirs->from;
    quick.theirs[1] = theirs->to;
  }
  memcpy(quick.normal, along->n, sizeof quick.normal);
  memcpy(quick.balls, c->balls, sizeof quick.balls);
  const bool simple = !c->carried && !c->clock[0] && !c->clock[1] && !c->clock[2];
  sign found = simple && quick_separates(&quick) ? POSITIVE : OPEN;
  for (int level = 0; level < PIECES_LEVELS && found == OPEN; level++) {
    iv_precision(BITS[level]);
    found = separation(c, level, along, mine, theirs);
  }
  iv_precision(BITS[0]);
  ++*c->leaves;
  return found == POSITIVE;
}

/* m leaves {end, n}, the ends ascending from 0 to the number of pieces. */
static const char *check_convex(const section *c) {
  const uint32_t m = reader_count(c->in);
  double from = c->from;
  for (uint32_t i = 0; i < m; i++) {
    const double end = reader_number(c->in);
    const direction along = read_direction(c);
    if (c->in->bad) return "it is cut off or not a number";
    if (!(end > from && end <= c->until)) return "its parts do not follow each other";
    if (!separates(c, &along, (part){from, end}, NULL)) return "a direction does not separate its part";
    from = end;
  }
  return from == c->until ? NULL : "its parts do not cover the curve";
}

/* A tree in preorder: leaves {0, n}; {1 or 2, cut} and two trees for a pair whose first or second part is cut. Parts of
 * elements are counted by these. */
static const char *check_tree(const section *c, part mine, part theirs, int depth) {
  const unsigned char tag = reader_byte(c->in);
  if (c->in->bad || tag > 2 || depth > MAX_DEPTH) return "its tree is broken";
  if (tag == 0) {
    const direction along = read_direction(c);
    if (c->in->bad) return "it is cut off or not a number";
    return separates(c, &along, mine, &theirs) ? NULL : "a direction does not separate its parts";
  }
  const double at = reader_number(c->in);
  part *whole = tag == 1 ? &mine : &theirs;
  if (c->in->bad || !(at > whole->from && at < whole->to)) return "a cut lies outside its part";
  if (tag == 2 && c->set->corners > 0 && at != floor(at)) return "a cut lies inside an element";
  const part all = *whole;
  *whole = (part){all.from, at};
  const char *fault = check_tree(c, mine, theirs, depth + 1);
  if (fault) return fault;
  *whole = (part){at, all.to};
  return check_tree(c, mine, theirs, depth + 1);
}

/* The number of pieces and where they join, and the pieces of it. *breaks is to be freed after them. */
static const char *read_pieces(reader *in, const curve *c, pieces *p, double **breaks) {
  const uint32_t n = reader_count(in);
  if (in->bad || n == 0 || n - 1 > reader_left(in) / 8) return "it is cut off";
  double *b = *breaks = malloc((n + (size_t)1) * sizeof *b);
  if (!b) return "memory is out";
  b[0] = c->t0;
  b[n] = c->t1;
  for (uint32_t i = 1; i < n; i++) b[i] = reader_number(in);
  return in->bad ? "it is cut off or not a number" : pieces_make(p, c, b, n);
}

static const char *check_section(section *c) {
  const unsigned char wanted = c->set->kind == CURVE ? 2 : c->set->corners > 0 ? 3 : 1;
  const part all = {c->from, c->until};
  if (reader_byte(c->in) != wanted) return "it is about another kind of target";
  if (wanted == 1) return check_convex(c);
  if (c->set->kind == SOLID && (c->carried || c->clock[1])) return "what is inside a mesh that moves is not known";
  if (wanted == 3) {
    const char *broken = check_tree(c, all, (part){0.0, (double)set_elements(c->set)}, 0);
    if (broken || c->set->kind != SOLID || winding_pieces_begin_outside(c->set, c->mover, c->from, c->until))
      return broken;
    return "the curve does not begin outside the mesh";
  }
  pieces obstacle = {0};
  double *breaks = NULL;
  const char *fault = read_pieces(c->in, &c->set->curve, &obstacle, &breaks);
  c->obstacle = &obstacle;
  if (!fault) fault = check_tree(c, all, (part){0.0, (double)obstacle.n}, 0);
  c->obstacle = NULL;
  pieces_free(&obstacle);
  free(breaks);
  return fault;
}

/* The parameter at a number of pieces, rounded down, or up. */
static double parameter_at(const double *breaks, double at, mpfr_rnd_t rounding) {
  const size_t i = (size_t)floor(at);
  if (at == (double)i) return breaks[i];
  iv *w = iv_new(3);
  iv_set_d(&w[0], breaks[i]);
  iv_set_d(&w[1], breaks[i + 1]);
  iv_set_d(&w[2], at - (double)i);
  iv_blend(&w[0], &w[1], &w[2]);
  const double t = mpfr_get_d(rounding == MPFR_RNDD ? w[0].lo : w[0].hi, rounding);
  iv_free(w, 3);
  return t;
}

/* A place of a robot's motion. */
static bool read_place(const robot *r, reader *in, motion_place *at) {
  at->segment = reader_count(in);
  at->u = reader_number(in);
  return !in->bad && at->segment < r->n_segments && at->u >= 0.0 && at->u <= 1.0;
}

/* All pairs of a robot, over all of the motion, or up to a place of it, or from one to another. */
static const char *check_robot_apart(robot *r, reader *in, uint32_t width, claim of, finding *found) {
  motion_place from = {0, 0.0}, until = {r->n_segments - 1, 1.0};
  const bool good =
      (of != CLAIM_DURING || read_place(r, in, &from)) && (of == CLAIM_APART || read_place(r, in, &until));
  if (!good || from.segment > until.segment || (from.segment == until.segment && !(from.u < until.u)))
    return "it ends outside the motion";
  found->from = parameter_at(r->times + from.segment, from.u, MPFR_RNDU);
  found->until = parameter_at(r->times + until.segment, until.u, MPFR_RNDD);
  return robot_apart(r, in, width, found->delta, &from, &until, &found->leaves);
}

/* All sets against one body that is carried, or the curve alone. clock: that of the mover's own growth. */
static const char *check_sets(const problem *p, section *c, pieces *growth, double delta) {
  const char *fault = NULL;
  for (size_t i = 0; i < p->n_sets && !fault; i++) {
    c->set = &p->sets[i];
    const double balls[BALLS] = {delta, p->mover.radius, c->set->margin, c->carried ? c->carried->margin : 0.0};
    memcpy(c->balls, balls, sizeof balls);
    pieces made[2] = {{0}, {0}};
    const curve *given[2] = {&c->set->ride, &c->set->growth};
    c->clock[0] = growth->n > 0 ? growth : NULL;
    for (int k = 0; k < 2; k++) {
      const bool there = curve_is_there(given[k]);
      if (there && !fault) fault = pieces_make(&made[k], given[k], c->mover->breaks, c->mover->n);
      c->clock[1 + k] = there ? &made[k] : NULL;
    }
    if (!fault) fault = check_section(c);
    for (int k = 0; k < 2; k++) pieces_free(&made[k]), c->clock[1 + k] = NULL;
  }
  return fault;
}

static const char *check_apart(const problem *p, reader *in, uint32_t width, claim of, finding *found) {
  const mover *m = &p->mover;
  pieces path = {0}, growth = {0};
  double *breaks = NULL;
  const double from = of == CLAIM_DURING ? reader_number(in) : 0.0, end = of != CLAIM_APART ? reader_number(in) : 0.0;
  const char *fault = read_pieces(in, &m->curve, &path, &breaks);
  if (!fault && curve_is_there(&m->growth)) fault = pieces_make(&growth, &m->growth, breaks, path.n);
  const double until = of != CLAIM_APART ? end : (double)path.n;
  if (!fault && !(from >= 0.0 && from < until && until <= (double)path.n)) fault = "it ends outside the curve";
  if (!fault) found->from = parameter_at(breaks, from, MPFR_RNDU);
  if (!fault) found->until = parameter_at(breaks, until, MPFR_RNDD);
  section c = {.in = in, .width = width, .mover = &path, .leaves = &found->leaves};
  c.from = from, c.until = until;
  for (size_t i = 0; (i == 0 || i < m->n_carried) && !fault; i++) {
    c.carried = m->n_carried > 0 ? &m->carried[i] : NULL;
    fault = check_sets(p, &c, &growth, found->delta);
  }
  pieces_free(&path);
  pieces_free(&growth);
  free(breaks);
  return fault;
}

/* One point: what few bits leave open is tried once more with many. */
static const char *check_one_point(const problem *p, reader *in, double delta) {
  const reader start = *in;
  const char *fault = "";
  for (int level = 0; level < PIECES_LEVELS && fault && (level == 0 || near_left_open()); level++) {
    *in = start;
    iv_precision(BITS[level]);
    fault = check_near(p, in, delta);
  }
  iv_precision(BITS[0]);
  return fault;
}

static const char *check_place(const problem *p, reader *in, double delta) {
  return p->mover.robot ? robot_near(p->mover.robot, in, delta) : check_one_point(p, in, delta);
}

/* The parameter of a point that is named, rounded up: of a curve u32, f64; of a robot u32, u32 segment, f64 u. */
static double parameter_of_place(const problem *p, reader in) {
  const robot *r = p->mover.robot;
  reader_count(&in);
  if (!r) return reader_number(&in);
  const size_t segment = reader_count(&in);
  const double u = reader_number(&in);
  if (in.bad || segment >= r->n_segments || !(u >= 0.0 && u <= 1.0)) return INFINITY;
  const double back[2] = {-r->times[segment + 1], -r->times[segment]};
  return u == 0.0 ? r->times[segment] : -parameter_at(back, nextafter(1.0 - u, 0.0), MPFR_RNDD);
}

/* Farther than delta up to a parameter; what follows is near. */
static const char *check_before(const problem *p, reader *in, uint32_t width, finding *found) {
  const char *fault = p->mover.robot ? check_robot_apart(p->mover.robot, in, width, CLAIM_BEFORE, found)
                                     : check_apart(p, in, width, CLAIM_BEFORE, found);
  if (fault || in->at == in->end) return fault;
  found->meets_delta = reader_number(in);
  found->meets_by = parameter_of_place(p, *in);
  if (in->bad || !(found->meets_delta >= 0.0)) return "it is cut off or not a number";
  found->meets = true;
  return check_place(p, in, found->meets_delta);
}

static const char *check_claim(const problem *p, reader *in, uint32_t width, uint32_t claimed, size_t sections,
                               finding *found) {
  robot *r = p->mover.robot;
  const bool apart = claimed == CLAIM_APART || claimed == CLAIM_BEFORE || claimed == CLAIM_DURING;
  if (!apart && claimed != CLAIM_NEAR) return "it claims nothing that is known";
  if (r && sections != r->n_pairs) return "it is about another number of pairs";
  const size_t loads = p->mover.n_carried > 0 ? p->mover.n_carried : 1;
  if (!r && apart && sections != loads * p->n_sets) return "it is about another number of targets";
  if (claimed == CLAIM_NEAR) return check_place(p, in, found->delta);
  if (claimed == CLAIM_BEFORE) return check_before(p, in, width, found);
  const claim of = (claim)claimed;
  return r ? check_robot_apart(r, in, width, of, found) : check_apart(p, in, width, of, found);
}

static finding find(const problem *p, const unsigned char *bytes, size_t size) {
  finding found = {0};
  reader in = {.at = bytes, .end = bytes + size};
  const double before = iv_work();
  mpfr_clear_flags();
  iv_precision(BITS[0]);

  /* the head */
  char magic[4];
  for (int i = 0; i < 4; i++) magic[i] = (char)reader_byte(&in);
  const uint32_t width = reader_count(&in);
  found.delta = reader_number(&in);
  const uint32_t claimed = reader_count(&in), sections = reader_count(&in);
  if (in.bad || memcmp(magic, "CPC1", 4) != 0 || (width != 4 && width != 8) || !(found.delta >= 0.0)) {
    const bool other = memcmp(magic, "CPC", 3) == 0 && magic[3] > '1' && magic[3] <= '9';
    found.fault = other ? "it is a certificate of a later version" : "it is no certificate";
    return found;
  }

  found.fault = check_claim(p, &in, width, claimed, sections, &found);
  if (!found.fault && in.at != in.end) found.fault = "bytes follow its end";
  if (!found.fault && mpfr_nanflag_p()) found.fault = "its arithmetic broke down";
  if (!found.fault) found.claim = (claim)claimed;
  found.work = iv_work() - before;
  return found;
}

finding check(const problem *p, const unsigned char *bytes, size_t size) {
  finding found = {.fault = "memory is out"};
  if (!iv_begin()) return found;
  found = find(p, bytes, size);
  return iv_end() ? found : (finding){.fault = "memory is out"};
}
