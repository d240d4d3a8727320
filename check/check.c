/* SPDX-License-Identifier: BSD-3-Clause */
/* The core of the checker. A leaf with the direction n proves that a part of the mover is farther than delta from a set, if
 *   min n·psi over the control points of the part  -  max n·x over the set  >  (delta + radius + padding) |n|:
 * weak duality, for any n whatever. The leaves together cover all of the parameter range. */
#include "check.h"

#include <float.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "bytes.h"
#include "near.h"
#include "pieces.h"
#include "robot_check.h"
#include "support.h"

enum { MAX_DEPTH = 256 };

/* What a section is checked against. */
typedef struct section {
  reader *in;
  uint32_t width;
  const set *set;
  const pieces *mover, *target; /* target: of a set that is a curve */
  const iv *gap;                /* delta + radius + padding */
  size_t *leaves;
} section;

typedef struct part {
  double from, to;
} part;

/* One leaf: of all of the set, or of a part of a curve. */
static bool separates(const section *c, const double normal[3], part mine, const part *theirs) {
  iv *n = iv_new(3), *own = iv_new(3), *w = iv_new(3);
  for (int k = 0; k < 3; k++) iv_set_d(&n[k], normal[k]);
  if (c->set->kind == HALFSPACE) support_halfspace_normal(n, c->set); /* it has no other */
  support_of_frame(&w[0], own, c->set, n);
  if (theirs) {
    for (int k = 0; k < 3; k++) iv_neg(&own[k], &own[k]);
    pieces_least(&w[1], c->target, own, theirs->from, theirs->to);
    iv_neg(&w[1], &w[1]);
  } else {
    support_of_body(&w[1], c->set, own);
  }
  iv_add(&w[0], &w[0], &w[1]);
  iv_norm(&w[1], n);
  const bool proper = iv_is_positive(&w[1]);
  iv_mul(&w[1], &w[1], c->gap);
  iv_add(&w[0], &w[0], &w[1]);
  pieces_least(&w[2], c->mover, n, mine.from, mine.to);
  iv_sub(&w[2], &w[2], &w[0]);
  const bool separated = proper && iv_is_positive(&w[2]);
  iv_free(n, 3);
  iv_free(own, 3);
  iv_free(w, 3);
  ++*c->leaves;
  return separated;
}

/* m leaves {end, n}, the ends ascending from 0 to the number of pieces. */
static const char *check_convex(const section *c) {
  const uint32_t m = reader_count(c->in);
  double from = 0.0, normal[3];
  for (uint32_t i = 0; i < m; i++) {
    const double end = reader_number(c->in);
    reader_normal(c->in, c->width, normal);
    if (c->in->bad) return "it is cut off or not a number";
    if (!(end > from && end <= (double)c->mover->n)) return "its parts do not follow each other";
    if (!separates(c, normal, (part){from, end}, NULL)) return "a direction does not separate its part";
    from = end;
  }
  return from == (double)c->mover->n ? NULL : "its parts do not cover the curve";
}

/* A tree in preorder: leaves {0, n}; {1 or 2, cut} and two trees for a pair whose first or second part is cut. */
static const char *check_tree(const section *c, part mine, part theirs, int depth) {
  const unsigned char tag = reader_byte(c->in);
  if (c->in->bad || tag > 2 || depth > MAX_DEPTH) return "its tree is broken";
  if (tag == 0) {
    double normal[3];
    reader_normal(c->in, c->width, normal);
    if (c->in->bad) return "it is cut off or not a number";
    return separates(c, normal, mine, &theirs) ? NULL : "a direction does not separate its parts";
  }
  const double at = reader_number(c->in);
  part *whole = tag == 1 ? &mine : &theirs;
  if (c->in->bad || !(at > whole->from && at < whole->to)) return "a cut lies outside its part";
  const part all = *whole;
  *whole = (part){all.from, at};
  const char *fault = check_tree(c, mine, theirs, depth + 1);
  if (fault) return fault;
  *whole = (part){at, all.to};
  return check_tree(c, mine, theirs, depth + 1);
}

/* The number of pieces and where they join, and the pieces themselves. */
static const char *read_pieces(reader *in, const curve *c, pieces *p) {
  const uint32_t n = reader_count(in);
  if (in->bad || n == 0 || n - 1 > reader_left(in) / 8) return "it is cut off";
  double *breaks = malloc((n + (size_t)1) * sizeof *breaks);
  if (!breaks) return "memory is out";
  breaks[0] = c->t0;
  breaks[n] = c->t1;
  for (uint32_t i = 1; i < n; i++) breaks[i] = reader_number(in);
  const char *fault = in->bad ? "it is cut off or not a number" : pieces_make(p, c, breaks, n);
  free(breaks);
  return fault;
}

static const char *check_section(section *c, const problem *p, double delta) {
  iv *gap = iv_new(2);
  const double balls[3] = {delta, p->mover.radius, c->set->padding};
  for (int i = 0; i < 3; i++) {
    iv_set_d(&gap[1], balls[i]);
    iv_add(&gap[0], &gap[0], &gap[1]);
  }
  c->gap = gap;
  const unsigned char wanted = c->set->kind == CURVE ? 2 : 1;
  const char *fault = NULL;
  if (reader_byte(c->in) != wanted) {
    fault = "it is about another kind of target";
  } else if (wanted == 1) {
    fault = check_convex(c);
  } else {
    pieces target = {0};
    fault = read_pieces(c->in, &c->set->curve, &target);
    c->target = &target;
    if (!fault) fault = check_tree(c, (part){0.0, (double)c->mover->n}, (part){0.0, (double)target.n}, 0);
    pieces_free(&target);
  }
  iv_free(gap, 2);
  return fault;
}

static const char *check_robot(robot *r, reader *in, uint32_t width, claim claimed, size_t pairs, finding *found) {
  if (pairs != r->n_pairs) return "it is about another number of pairs";
  return claimed == CLAIM_APART ? robot_apart(r, in, width, found->delta, &found->leaves)
                                : robot_near(r, in, found->delta);
}

static const char *check_apart(const problem *p, reader *in, uint32_t width, finding *found) {
  pieces path = {0};
  const char *fault = read_pieces(in, &p->mover.curve, &path);
  for (size_t i = 0; i < p->n_sets && !fault; i++) {
    section c = {.in = in, .width = width, .set = &p->sets[i], .mover = &path, .leaves = &found->leaves};
    fault = check_section(&c, p, found->delta);
  }
  pieces_free(&path);
  return fault;
}

finding check_certificate(const problem *p, const unsigned char *bytes, size_t size, int bits) {
  finding found = {0};
  reader in = {.at = bytes, .end = bytes + size};
  mpfr_clear_flags();
  iv_precision(bits);

  /* the head */
  char magic[4];
  for (int i = 0; i < 4; i++) magic[i] = (char)reader_byte(&in);
  const uint32_t width = reader_count(&in);
  found.delta = reader_number(&in);
  const uint32_t claimed = reader_count(&in), sections = reader_count(&in);
  if (in.bad || memcmp(magic, "CPC1", 4) != 0 || (width != 4 && width != 8) || !(found.delta >= 0.0)) {
    found.fault = "it is no certificate";
    return found;
  }

  if (p->mover.robot && (claimed == CLAIM_APART || claimed == CLAIM_NEAR))
    found.fault = check_robot(p->mover.robot, &in, width, (claim)claimed, sections, &found);
  else if (claimed == CLAIM_APART)
    found.fault = sections == p->n_sets ? check_apart(p, &in, width, &found) : "it is about another number of targets";
  else if (claimed == CLAIM_NEAR)
    found.fault = check_near(p, &in, found.delta);
  else
    found.fault = "it claims nothing that is known";
  if (!found.fault && in.at != in.end) found.fault = "bytes follow its end";
  if (!found.fault && mpfr_nanflag_p()) found.fault = "its arithmetic broke down";
  if (!found.fault) found.claim = (claim)claimed;
  return found;
}

finding check(const problem *p, const unsigned char *bytes, size_t size) {
  const finding found = check_certificate(p, bytes, size, 640);
  return found.fault && !p->mover.robot ? check_certificate(p, bytes, size, 4096) : found;
}
