/* SPDX-License-Identifier: BSD-3-Clause */
/* Pairs whose distance is a formula, against long double, and against the search that answers all other pairs. */
#include "base/rounding.h"
#include "curve_proximity/cprox/query.h"
#include "narrowphase/relative_pose.h"
#include "support/builders.h"
#include "support/cases.h"
#include "support/random.h"
#include "support/reference.h"

enum { FAMILIES = 9 };

/* A point, a ball, a capsule or a box somewhere. */
typedef struct part {
  cprox_body *body;
  cprox_pose pose;
  double half, radius, margin; /* of a capsule's core, of a capsule or a ball */
  vec3 box;                    /* half extents, of a box */
} part;

typedef enum part_kind { PART_POINT, PART_BALL, PART_CAPSULE, PART_BOX } part_kind;

static part part_make(rng *r, part_kind kind, double size, double radius) {
  part p = {.pose = rng_pose(r, size), .radius = kind == PART_POINT || kind == PART_BOX ? 0.0 : radius};
  if (kind == PART_CAPSULE) p.half = size * rng_uniform(r, 0.01, 1.0);
  p.box = vec(size, radius, size * rng_uniform(r, 0.1, 1.0));
  cprox_status status;
  switch (kind) {
    case PART_POINT: status = cprox_body_create_point(vec(0, 0, 0), ws, &p.body); break;
    case PART_BALL: status = cprox_body_create_sphere(radius, ws, &p.body); break;
    case PART_CAPSULE: status = cprox_body_create_capsule(2.0 * p.half, radius, ws, &p.body); break;
    default: status = cprox_body_create_box(vec_scale(2.0, p.box), ws, &p.body);
  }
  assert_int_equal(status, CPROX_OK);
  if (rng_index(r, 3) == 0) p.margin = size * rng_uniform(r, 0.0, 0.5);
  const double norm = rng_log_uniform(r, 0.1, 10.0); /* a quaternion of any length is one */
  cprox_quat *q = &p.pose.orientation;
  if (rng_index(r, 4) == 0) *q = (cprox_quat){q->w * norm, q->x * norm, q->y * norm, q->z * norm};
  if (rng_index(r, 8) == 0) *q = (cprox_quat){1, 0, 0, 0};
  return p;
}

/* Directions of a pose, without its position. */
static vec3l turned(const part *p, vec3l v) {
  const cprox_pose turn = {.orientation = p->pose.orientation};
  return ref_to_world(&turn, v);
}

static vec3l along_of(const part *p) {
  return turned(p, (vec3l){0, 0, 1});
}

/* A place of the core: where on its axis, in [-1, 1]. */
static vec3l on_core(const part *p, double place) {
  return ref_scale((long double)place * p->half, along_of(p));
}

static void stand_at(part *p, vec3l where) {
  p->pose.position = vec((double)where.x, (double)where.y, (double)where.z);
}

/* Poses that a formula could fail at. */
static void stand_badly(rng *r, int family, part *a, part *b, double size) {
  const vec3l here = ref_vec(a->pose.position);
  const double place = rng_index(r, 2) ? rng_uniform(r, -1, 1) : rng_index(r, 2) ? 1.0 : -1.0;
  if (family == 1) { /* far from the origin */
    const vec3 far = vec_scale(1e7 * size, rng_unit(r));
    a->pose.position = vec_add(a->pose.position, far);
    b->pose.position = vec_add(b->pose.position, far);
  }
  if (family == 2 || family == 3) b->pose.orientation = a->pose.orientation; /* parallel, and nearly */
  if (family == 3) b->pose.orientation.x += rng_log_uniform(r, 1e-18, 1e-6);
  if (family == 4) /* the cores cross, or nearly */
    stand_at(b, ref_add(ref_sub(ref_add(here, on_core(a, place)), on_core(b, rng_uniform(r, -1, 1))),
                        ref_scale(rng_log_uniform(r, 1e-18, 1e-3) * size, ref_vec(rng_unit(r)))));
  if (family == 5) { /* they touch along a direction */
    const double apart = a->radius + b->radius + a->margin + b->margin;
    stand_at(b, ref_add(ref_sub(ref_add(here, on_core(a, place)), on_core(b, rng_uniform(r, -1, 1))),
                        ref_scale(apart, ref_vec(rng_unit(r)))));
  }
  if (family == 6) b->pose = a->pose; /* nested */
  if (family == 7) {                  /* on one line */
    b->pose.orientation = a->pose.orientation;
    stand_at(b, ref_add(here, ref_scale(rng_uniform(r, -3, 3) * size, along_of(a))));
  }
}

static vec3l apart_of(const part *a, const part *b) {
  return ref_sub(ref_vec(b->pose.position), ref_vec(a->pose.position));
}

static long double between_cores(const part *a, const part *b) {
  const vec3l ua = along_of(a), ub = along_of(b), apart = apart_of(a, b);
  const vec3l a0 = ref_scale(-a->half, ua), a1 = ref_scale(a->half, ua);
  const vec3l b0 = ref_sub(apart, ref_scale(b->half, ub)), b1 = ref_add(apart, ref_scale(b->half, ub));
  long double least = fminl(fminl(ref_point_segment(a0, b0, b1), ref_point_segment(a1, b0, b1)),
                            fminl(ref_point_segment(b0, a0, a1), ref_point_segment(b1, a0, a1)));
  const vec3l n = ref_cross(ua, ub);
  const long double n2 = ref_dot(n, n);
  if (n2 > 0.0L) {
    const long double s = ref_dot(ref_cross(apart, ub), n) / n2, t = ref_dot(ref_cross(apart, ua), n) / n2;
    if (fabsl(s) <= a->half && fabsl(t) <= b->half)
      least = fminl(least, ref_norm(ref_sub(ref_sub(ref_scale(s, ua), ref_scale(t, ub)), apart)));
  }
  return least;
}

static long double signed_to_box(const part *box, const part *ball) {
  const cprox_pose turn = {.orientation = box->pose.orientation};
  const vec3l p = ref_to_local(&turn, apart_of(box, ball));
  const long double out = ref_point_box(p, box->box);
  if (out > 0.0L) return out;
  return fmaxl(fmaxl(fabsl(p.x) - box->box.x, fabsl(p.y) - box->box.y), fabsl(p.z) - box->box.z);
}

static long double truth_of(const part *a, part_kind ka, const part *b, part_kind kb) {
  const long double margins = (long double)a->radius + b->radius + a->margin + b->margin;
  if (ka == PART_BOX) return signed_to_box(a, b) - margins;
  if (kb == PART_BOX) return signed_to_box(b, a) - margins;
  return between_cores(a, b) - margins;
}

static cprox_obstacle placed(const part *p) {
  return cprox_with_margin(cprox_obstacle_at(p->body, p->pose), p->margin);
}

/* What the search says of the same pair. */
static pair_answer searched(const part *a, const part *b) {
  const cprox_obstacle oa = placed(a), ob = placed(b);
  const pair_side sa = relative_pose_of_side(&oa, 0), sb = relative_pose_of_side(&ob, 0);
  const pair_placement place = relative_pose_make(&sa, &sb);
  const pair_goal goal = {.max_steps = 400, .wants_depth = true};
  pair_answer answer;
  pair_separate(sa.shape, sa.margin, sb.shape, sb.margin, &place, &goal, &answer);
  return answer;
}

/* How far apart the planes across the normal leave the two, where both are round; the normal proves `lower`. */
static long double proven(const part *a, const part *b, vec3 normal) {
  const vec3l n = ref_vec(normal);
  return -ref_dot(n, apart_of(a, b)) - a->half * fabsl(ref_dot(n, along_of(a))) -
         b->half * fabsl(ref_dot(n, along_of(b))) - a->radius - b->radius - a->margin - b->margin;
}

/* 300,000 pairs (seed 431) at scales from 1e-6 to 1e6: apart, touching, nested, crossing, parallel, far from the origin,
 * needles and plates, sizes a million times apart. The reference is exact but for 2^-60 of the sizes. */
CASE(a_formula_contains_the_distance_and_is_narrower_than_a_search) {
  rng r = rng_seed(431);
  const size_t cases = test_cases(300000);
  size_t wider = 0, one_step = 0;
  for (size_t i = 0; i < cases; i++) {
    const int family = (int)(i % FAMILIES);
    const double size = rng_log_uniform(&r, 1e-6, 1e6),
                 other = family == 8 ? size * rng_log_uniform(&r, 1e-6, 1.0) : size;
    const bool thin = rng_index(&r, 3) == 0;
    part_kind ka = (part_kind)rng_index(&r, 4), kb = (part_kind)rng_index(&r, 3);
    if (ka == PART_BOX && kb == PART_CAPSULE) kb = PART_BALL;
    part a = part_make(&r, ka, size, size * (thin ? rng_log_uniform(&r, 1e-9, 1e-3) : rng_uniform(&r, 0.1, 1.0)));
    part b = part_make(&r, kb, other, other * (thin ? rng_log_uniform(&r, 1e-9, 1e-3) : rng_uniform(&r, 0.1, 1.0)));
    stand_badly(&r, family, &a, &b, size);
    const bool swapped = rng_index(&r, 2);
    const part *x = swapped ? &b : &a, *y = swapped ? &a : &b;

    cprox_options options = CPROX_OPTIONS_DEFAULT;
    options.epsilon = 1e-6 * size;
    cprox_result found, verdict;
    assert_int_equal(cprox_pair(placed(x), placed(y), &options, ws, &found), CPROX_OK);
    const long double truth = swapped ? truth_of(x, kb, y, ka) : truth_of(x, ka, y, kb);
    const double sizes = vec_norm(vec_sub(x->pose.position, y->pose.position)) + 2.0 * (size + other);
    const long double doubt = 0x1p-60L * sizes;
    if (!(found.lower <= truth + doubt && truth - doubt <= found.upper))
      fail_msg("case %zu, family %d, kinds %d %d: %.20Lg is not in [%.17g, %.17g]", i, family, (int)ka, (int)kb, truth,
               found.lower, found.upper);
    const double gap = vec_norm(vec_sub(found.witness_mover, found.witness_obstacle));
    const double noise = 256.0 * ROUND_U * (sizes + vec_norm(x->pose.position) + vec_norm(y->pose.position));
    assert_true(fabs(gap - fabs(found.upper)) <= noise + options.epsilon);
    assert_true(fabs(vec_norm(found.normal) - 1.0) < 1e-14);
    if (ka != PART_BOX && kb != PART_BOX)
      assert_true(proven(x, y, found.normal) >= found.lower - 8.0L * ROUND_U * sizes);

    /* a verdict at a limit beside it, and at the distance itself */
    const double at = fmax((double)truth, 0.0), limit = rng_index(&r, 4) ? at * rng_uniform(&r, 0.5, 1.5) : at;
    assert_true(cprox_pair_tolerance(placed(x), placed(y), limit, &options, ws, &verdict) >= 0);
    if ((verdict.verdict == CPROX_VERDICT_CLEAR && !(truth + doubt > limit)) ||
        (verdict.verdict == CPROX_VERDICT_VIOLATED && truth - doubt > limit))
      fail_msg("case %zu, family %d: %s at %.17g, but %.20Lg", i, family, cprox_verdict_name(verdict.verdict), limit,
               truth);

    const pair_answer search = searched(x, y);
    assert_true(search.lower <= found.upper && found.lower <= search.upper);
    wider += found.upper - found.lower > (search.upper - search.lower) && found.nodes == 1;
    one_step += found.nodes == 1;
    cprox_body_free(a.body);
    cprox_body_free(b.body);
  }
  print_message("wider than a search: %zu of %zu; by a formula: %zu\n", wider, cases, one_step);
  assert_true(one_step > cases * 9 / 10);
  assert_true(wider <= cases / 500); /* by less than a rounding of the sizes */
}

int main(void) {
  return cases_run(workspace_setup, workspace_teardown);
}
