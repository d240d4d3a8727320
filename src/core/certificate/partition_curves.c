/* SPDX-License-Identifier: BSD-3-Clause */
/* A curve against a curve: a tree of pairs of parts, in preorder. */
#include "certificate/partition.h"
#include "curve_query/newton_curves.h"

enum { MAX_DEPTH = 120 };

/* A pair of parts. */
typedef struct pair {
  reach_part part[2];
} pair;

/* What became of a pair: whether it is one leaf, and of what normal. */
typedef struct proven {
  cprox_status status;
  bool is_leaf;
  vec3 n;
} proven;

static bool separates(const cover *c, const pair *p, vec3 n) {
  if (vec_norm2(n) == 0.0) return false;
  const reach_direction direction = reach_along(n);
  const reach_value reach = reach_of_curve(&c->set, &direction, p->part[1]);
  return reach_separates(c->curve, c->radius, p->part[0], &direction, &reach, c->delta);
}

static void write_leaf(cover *c, vec3 n) {
  certificate_byte(c->certificate, COVER_LEAF);
  certificate_normal(c->certificate, n);
}

/* The chord of a part, in the world. */
static void chord(const cprox_curve *curve, const frame *placed, reach_part part, vec3 ends[2]) {
  ends[0] = partition_point(curve, part.from);
  ends[1] = partition_point(curve, part.to);
  for (int k = 0; placed && k < 2; k++) ends[k] = frame_to_world(placed, ends[k]);
}

static bool holds(reach_part part, double sigma) {
  return sigma >= part.from && sigma <= part.to;
}

/* Which side to cut, and where: at the witness, else the longer chord. NaN where it is too short. */
static double choose_cut(const cover *c, const pair *p, const vec3 first[2], const vec3 second[2], int *side) {
  const double witness[2] = {c->witness, c->witness_on_set};
  const bool inside = holds(p->part[0], witness[0]) && holds(p->part[1], witness[1]);
  for (int k = 0; inside && k < 2; k++) {
    *side = k;
    const double cut = partition_cut(c, p->part[k], witness[k]);
    if (cut == witness[k]) return cut;
  }
  const double lengths[2] = {vec_norm2(vec_sub(first[1], first[0])), vec_norm2(vec_sub(second[1], second[0]))};
  *side = lengths[0] >= lengths[1] ? 0 : 1;
  const double cut = partition_cut(c, p->part[*side], -1.0);
  if (!isnan(cut)) return cut;
  *side = 1 - *side;
  return partition_cut(c, p->part[*side], -1.0);
}

static proven prove(cover *c, const frame *placed, const pair *p, vec3 inherited, int depth) {
  if (c->budget == 0) return (proven){.status = CPROX_BUDGET};
  c->budget--;

  /* the normal of the parent, of the best point, of the two chords */
  vec3 first[2], second[2];
  double unused[2];
  chord(c->curve, NULL, p->part[0], first);
  chord(c->set.curve, placed, p->part[1], second);
  const vec3 of_chords = certificate_round(c->certificate, newton_curves_of_chords(first, second, unused));
  const vec3 trials[3] = {inherited, c->normal, of_chords};
  for (int i = 0; i < 3; i++) {
    if (!separates(c, p, trials[i])) continue;
    write_leaf(c, trials[i]);
    return (proven){.status = CPROX_OK, .is_leaf = true, .n = trials[i]};
  }

  /* both halves */
  int side;
  const double cut = choose_cut(c, p, first, second, &side);
  if (isnan(cut) || depth >= MAX_DEPTH) return (proven){.status = CPROX_PRECISION};
  const size_t place = c->certificate->size;
  certificate_byte(c->certificate, side == 0 ? COVER_CUT_FIRST : COVER_CUT_SECOND);
  certificate_number(c->certificate, cut);
  pair half[2] = {*p, *p};
  half[0].part[side].to = half[1].part[side].from = cut;
  const proven left = prove(c, placed, &half[0], of_chords, depth + 1);
  if (left.status != CPROX_OK) return left;
  const proven right = prove(c, placed, &half[1], left.is_leaf ? left.n : of_chords, depth + 1);
  if (right.status != CPROX_OK || !left.is_leaf || !right.is_leaf) return (proven){.status = right.status};

  /* two leaves that one normal can serve are one */
  const vec3 either[2] = {left.n, right.n};
  for (int i = 0; i < 2; i++) {
    if (!separates(c, p, either[i])) continue;
    c->certificate->size = place;
    write_leaf(c, either[i]);
    return (proven){.status = CPROX_OK, .is_leaf = true, .n = either[i]};
  }
  return (proven){.status = CPROX_OK};
}

cprox_status partition_curves(cover *c) {
  const frame placed = frame_create(&c->pose, vec(0, 0, 0));
  const cprox_curve *obstacle = c->set.curve;
  certificate_byte(c->certificate, SECTION_CURVE);
  certificate_breaks(c->certificate, obstacle->breaks, obstacle->n_pieces);
  c->normal = certificate_round(c->certificate, c->normal);
  const pair whole = {{{c->from, c->until}, {0.0, (double)obstacle->n_pieces}}};
  return prove(c, &placed, &whole, vec(0, 0, 0), 0).status;
}
