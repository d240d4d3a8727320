/* SPDX-License-Identifier: BSD-3-Clause */
/* Signed distances of standing bodies, held against distances that are known by construction. */
#include <string.h>

#include "base/frame.h"
#include "base/rounding.h"
#include "convex/feature.h"
#include "curve_proximity/cprox/query.h"
#include "shape/body.h"
#include "support/cases.h"
#include "support/counting.h"
#include "support/implicits.h"
#include "support/random.h"
#include "support/reference.h"
#include "support/shapes.h"

static void check_bracket(const test_shape *a, const test_shape *b, double gap, double tolerance,
                          const cprox_result *r) {
  if (!(r->upper >= gap - tolerance && r->lower <= fmax(gap, 0.0) + tolerance && r->lower <= r->upper))
    fail_msg("%s and %s at gap %.17g: [%.17g, %.17g], status %s", shape_name(a), shape_name(b), gap, r->lower, r->upper,
             cprox_status_name(r->status));
}

static double reach_of(const test_shape *a, const cprox_pose *pa, const test_shape *b, const cprox_pose *pb) {
  return a->body->ball_radius + b->body->ball_radius + vec_norm(a->body->ball_centre) + vec_norm(b->body->ball_centre) +
         vec_norm(vec_sub(pa->position, pb->position));
}

/* ---- properties ---- */

typedef struct sweep {
  uint64_t seed;
  size_t cases;
  double aspect, ratio, least_gap, most_gap;
  double allowed_undecided; /* fraction that may end without the accuracy asked for */
} sweep;

/* Distances by construction, apart. At relative 1e-9 (or 64 rounding errors, for gaps near them) nearly all are
 * decided. */
static void check_apart(const sweep *w) {
  rng r = rng_seed(w->seed);
  size_t undecided = 0;
  const size_t cases = test_cases(w->cases);
  static test_shape a, b;
  for (size_t i = 0; i < cases; i++) {
    const double scale = rng_log_uniform(&r, 1e-3, 1e3), ratio = rng_log_uniform(&r, 1.0 / w->ratio, 1.0);
    shape_make(&r, TEST_BOUNDED[rng_index(&r, TEST_N_BOUNDED)], scale, w->aspect, &a);
    shape_make(&r, TEST_BOUNDED[rng_index(&r, TEST_N_BOUNDED)], scale * ratio, w->aspect, &b);
    const cprox_pose pa = rng_pose(&r, rng_index(&r, 2) ? 0.0 : scale);
    cprox_pose pb = rng_pose(&r, 0.0);
    const bool by_a = rng_index(&r, 2);
    const vec3 n = by_a ? vec_neg(shape_telling_direction(&r, &a, &pa)) : shape_telling_direction(&r, &b, &pb);
    const double gap = scale * rng_log_uniform(&r, w->least_gap, w->most_gap);
    const double tolerance = shape_place(&a, &pa, &b, &pb, n, gap);

    cprox_options options = CPROX_OPTIONS_DEFAULT;
    const double floor = 200.0 * ROUND_U * reach_of(&a, &pa, &b, &pb);
    options.epsilon = floor;
    options.relative_epsilon = 1e-9;
    cprox_result result;
    const cprox_status status =
        cprox_pair(cprox_obstacle_at(a.body, pa), cprox_obstacle_at(b.body, pb), &options, NULL, &result);
    assert_true(status == result.status && status >= CPROX_OK);
    check_bracket(&a, &b, gap, tolerance, &result);
    undecided += status != CPROX_OK;
    if (status == CPROX_OK) assert_true(result.upper - result.lower <= fmax(floor, 1e-9 * result.upper));
    if (gap > 1.01 * tolerance && status == CPROX_OVERLAP)
      fail_msg("%s and %s overlap at gap %g", shape_name(&a), shape_name(&b), gap);

    /* the points attain upper, one on each body, and the normal points from b to a */
    if (status != CPROX_OVERLAP && gap > 1e-6 * scale) {
      const vec3 apart = vec_sub(result.witness_mover, result.witness_obstacle);
      const double noise = floor + 1e-12 * vec_norm(pa.position);
      assert_true(fabs(vec_norm(apart) - result.upper) <= 1e-9 * result.upper + 2.0 * noise);
      if (status == CPROX_OK) assert_true(vec_dot(apart, result.normal) >= (1.0 - 1e-7) * result.upper - 2.0 * noise);
      assert_true(fabs(vec_norm(result.normal) - 1.0) < 1e-14);
    }
    cprox_body_free(a.body);
    cprox_body_free(b.body);
  }
  print_message("undecided: %zu of %zu\n", undecided, cases);
  assert_true((double)undecided <= 2.0 + w->allowed_undecided * (double)cases);
}

/* Seed 301, 1e5 pairs of all kinds at scales 1e-3 to 1e3. Tolerance: what the rounding of b's position moved. */
CASE(a_distance_known_by_construction_lies_in_the_interval) {
  check_apart(&(sweep){301, 100000, 4.0, 4.0, 1e-3, 10.0, 5e-4});
}

/* Seed 302, 1e5 pairs, gaps 1e-15 to 1e-2 of the size. */
CASE(gaps_down_to_rounding_lie_in_the_interval) {
  check_apart(&(sweep){302, 100000, 4.0, 4.0, 1e-15, 1e-2, 2e-3});
}

/* Seed 303, 3e4 pairs of aspect up to 1e6; seed 304, 3e4 pairs whose sizes are up to 1e12 apart. What thin shapes leave
 * undecided is counted, not wrong. */
CASE(needles_and_wafers_lie_in_the_interval) {
  check_apart(&(sweep){303, 30000, 1e6, 4.0, 1e-9, 1.0, 5e-2});
}

CASE(sizes_a_million_million_apart_lie_in_the_interval) {
  check_apart(&(sweep){304, 30000, 4.0, 1e12, 1e-9, 1.0, 2e-3});
}

/* Seed 305, 1e5 pairs that share a point, from a touch to deep inside: the interval starts at or below 0, ends at or
 * above phi of any direction, and where the overlap is proven that is said. */
CASE(overlaps_are_never_called_apart) {
  rng r = rng_seed(305);
  size_t proven = 0, deep = 0;
  static test_shape a, b;
  for (size_t i = 0; i < test_cases(100000); i++) {
    shape_make(&r, TEST_BOUNDED[rng_index(&r, TEST_N_BOUNDED)], 1.0, 4.0, &a);
    shape_make(&r, TEST_BOUNDED[rng_index(&r, TEST_N_BOUNDED)], 1.0, 4.0, &b);
    const cprox_pose pa = rng_pose(&r, 1.0);
    cprox_pose pb = rng_pose(&r, 0.0);
    const double fraction = rng_index(&r, 2) ? rng_log_uniform(&r, 1e-16, 1.0) : rng_uniform(&r, 0.1, 1.0);
    const vec3l x = ref_sub(shape_point_within(&r, &a, &pa, fraction), shape_point_within(&r, &b, &pb, fraction));
    pb.position = vec((double)x.x, (double)x.y, (double)x.z);
    const long double tolerance = ref_error(x, pb.position) + 1e-17L;
    cprox_result result;
    assert_true(cprox_pair(cprox_obstacle_at(a.body, pa), cprox_obstacle_at(b.body, pb), NULL, NULL, &result) >=
                CPROX_OK);
    if (!(result.lower <= tolerance && result.lower <= result.upper))
      fail_msg("%s and %s share a point: [%.17g, %.17g]", shape_name(&a), shape_name(&b), result.lower, result.upper);
    for (int k = 0; k < 4; k++) {
      const vec3l u = ref_vec(rng_unit(&r));
      const long double phi =
          ref_dot(u, shape_extreme(&a, &pa, ref_scale(-1, u))) - ref_dot(u, shape_extreme(&b, &pb, u));
      if (phi / ref_norm(u) > result.upper + 1e-15L)
        fail_msg("upper %.17g, a direction gives %.20Lg", result.upper, phi);
    }
    if (result.upper < 0.0) {
      /* the two points are the way out: as far apart as upper says, each on its own body */
      const vec3 out = vec_sub(result.witness_obstacle, result.witness_mover);
      if (!(fabs(vec_norm(out) + result.upper) < 1e-12))
        fail_msg("%s in %s: [%.17g, %.17g] %s, points %.17g apart, normal %g", shape_name(&a), shape_name(&b),
                 result.lower, result.upper, cprox_status_name(result.status), vec_norm(out), vec_norm(result.normal));
      const vec3l u = ref_vec(rng_unit(&r)), p = ref_vec(result.witness_mover), q = ref_vec(result.witness_obstacle);
      assert_true(ref_dot(u, ref_sub(p, shape_extreme(&a, &pa, u))) < 1e-12L);
      assert_true(ref_dot(u, ref_sub(q, shape_extreme(&b, &pb, u))) < 1e-12L);
      proven++;
    }
    const bool solid = a.body->shape.ops->curvature && b.body->shape.ops->curvature;
    if (solid && fraction > 0.1) {
      deep++;
      if (!(result.upper < 0.0))
        fail_msg("%s and %s overlap by a fraction %g, status %s [%g, %g]", shape_name(&a), shape_name(&b), fraction,
                 cprox_status_name(result.status), result.lower, result.upper);
    }
    cprox_body_free(a.body);
    cprox_body_free(b.body);
  }
  print_message("proven to overlap: %zu\n", proven);
  assert_true(proven > 1000 || test_cases(100) < 100);
  assert_true(deep > 1000 || test_cases(100) < 100);
}

/* Seed 311, 1e5 pairs of boxes, as boxes and as polytopes, aligned with the axes: the gaps are differences of the
 * doubles given, long double is exact to 2^-64, and there is no tolerance: the reference lies in the interval itself.
 */
CASE(aligned_boxes_need_no_tolerance) {
  rng r = rng_seed(311);
  for (size_t i = 0; i < test_cases(100000); i++) {
    cprox_body *body[2] = {NULL, NULL};
    vec3 size[2], corner[8];
    const bool polytopes = i % 2;
    for (int k = 0; k < 2; k++) {
      size[k] = vec(2 * rng_uniform(&r, 0.1, 1.0), 2 * rng_uniform(&r, 0.1, 1.0), 2 * rng_uniform(&r, 0.1, 1.0));
      const vec3 h = vec_scale(0.5, size[k]);
      for (int c = 0; c < 8; c++) corner[c] = vec(c & 1 ? h.x : -h.x, c & 2 ? h.y : -h.y, c & 4 ? h.z : -h.z);
      assert_int_equal(polytopes ? cprox_body_create_polytope(corner, 8, NULL, &body[k])
                                 : cprox_body_create_box(size[k], NULL, &body[k]),
                       CPROX_OK);
    }
    const vec3 d = vec_scale(rng_log_uniform(&r, 1e-3, 1.0), rng_unit(&r));
    cprox_pose pose = CPROX_POSE_IDENTITY;
    pose.position = vec(d.x + 0.5 * (size[0].x + size[1].x), d.y + 0.5 * (size[0].y + size[1].y),
                        rng_index(&r, 2) ? d.z : d.z + 0.5 * (size[0].z + size[1].z));
    const vec3 p = pose.position;
    const vec3l gap = {fmaxl(0, fabsl(p.x) - (0.5L * size[0].x + 0.5L * size[1].x)),
                       fmaxl(0, fabsl(p.y) - (0.5L * size[0].y + 0.5L * size[1].y)),
                       fmaxl(0, fabsl(p.z) - (0.5L * size[0].z + 0.5L * size[1].z))};
    const long double exact = ref_norm(gap);
    cprox_options options = CPROX_OPTIONS_DEFAULT;
    options.epsilon = 1e-13;
    cprox_result result;
    cprox_pair(cprox_obstacle_at(body[0], CPROX_POSE_IDENTITY), cprox_obstacle_at(body[1], pose), &options, NULL,
               &result);
    if (exact > 0 && !(result.lower <= exact && exact <= result.upper && result.status == CPROX_OK))
      fail_msg("[%.17g, %.17g], exact %.20Lg", result.lower, result.upper, exact);
    cprox_body_free(body[0]);
    cprox_body_free(body[1]);
  }
}

/* Seed 312, needles of length 100 side by side, not turned and less than 5 apart: the rounding that sizes bring, K u S,
 * has to be in the interval by itself, since positions are short. Tolerance: the rounding of b's position, 5 u. */
CASE(the_rounding_of_large_bodies_close_together_is_in_the_interval) {
  rng r = rng_seed(312);
  static test_shape s[2];
  size_t asked = 0;
  for (size_t i = 0; i < test_cases(100000); i++) {
    const vec3 along = rng_unit(&r);
    for (int k = 0; k < 2; k++) {
      s[k] = (test_shape){.kind = CPROX_BODY_POLYTOPE, .n = 20};
      for (size_t j = 0; j < s[k].n; j++) s[k].v[j] = vec_axpy(rng_unit(&r), rng_uniform(&r, -50.0, 50.0), along);
      assert_int_equal(cprox_body_create_polytope(s[k].v, s[k].n, NULL, &s[k].body), CPROX_OK);
    }
    const cprox_pose pa = CPROX_POSE_IDENTITY;
    cprox_pose pb = CPROX_POSE_IDENTITY;
    vec3 n = vec_cross(along, rng_unit(&r));
    n = vec_scale(1.0 / vec_norm(n), n);
    const double gap = rng_log_uniform(&r, 1e-3, 1.0), tolerance = shape_place(&s[0], &pa, &s[1], &pb, n, gap);
    if (vec_norm(pb.position) < 5.0) {
      cprox_options options = CPROX_OPTIONS_DEFAULT;
      options.epsilon = 0.0;
      cprox_result result;
      cprox_pair(cprox_obstacle_at(s[0].body, pa), cprox_obstacle_at(s[1].body, pb), &options, NULL, &result);
      check_bracket(&s[0], &s[1], gap, tolerance, &result);
      asked++;
    }
    cprox_body_free(s[0].body);
    cprox_body_free(s[1].body);
  }
  print_message("asked %zu\n", asked);
  assert_true(asked > 1000 || test_cases(100) < 100);
}

/* Seed 306, 2e4 pairs far from the origin of the world: what positions share does not enter the interval's width. */
CASE(a_common_offset_of_a_million_metres_costs_nothing) {
  rng r = rng_seed(306);
  static test_shape a, b;
  for (size_t i = 0; i < test_cases(20000); i++) {
    shape_make(&r, TEST_BOUNDED[rng_index(&r, TEST_N_BOUNDED)], 1.0, 4.0, &a);
    shape_make(&r, TEST_BOUNDED[rng_index(&r, TEST_N_BOUNDED)], 1.0, 4.0, &b);
    const vec3 offset = vec(1e6, -2e6, 5e5);
    cprox_pose pa = rng_pose(&r, 0.0), pb = rng_pose(&r, 0.0);
    pa.position = offset;
    const double tolerance = shape_place(&a, &pa, &b, &pb, rng_unit(&r), 0.1);
    cprox_options options = CPROX_OPTIONS_DEFAULT;
    options.epsilon = 1e-12;
    cprox_result result;
    cprox_pair(cprox_obstacle_at(a.body, pa), cprox_obstacle_at(b.body, pb), &options, NULL, &result);
    check_bracket(&a, &b, 0.1, tolerance, &result);
    assert_true(result.upper - result.lower < 1e-11);
    cprox_body_free(a.body);
    cprox_body_free(b.body);
  }
}

/* Seed 307, 5e4 pairs with a ball: exact on both sides of the surface, against the ball's centre in long double for a
 * ball and against 2e4 directions for the rest: no direction may do better than lower says. */
CASE(balls_have_their_exact_signed_distance) {
  rng r = rng_seed(307);
  static test_shape a, b;
  for (size_t i = 0; i < test_cases(50000); i++) {
    shape_make(&r, rng_index(&r, 2) ? CPROX_BODY_SPHERE : CPROX_BODY_POINT, 1.0, 4.0, &a);
    shape_make(&r, rng_index(&r, 4) ? TEST_BOUNDED[1 + rng_index(&r, 6)] : CPROX_BODY_SPHERE, 1.0, 4.0, &b);
    const cprox_pose pa = rng_pose(&r, 1.5), pb = rng_pose(&r, 1.5);
    cprox_options options = CPROX_OPTIONS_DEFAULT;
    options.epsilon = 1e-12;
    cprox_result ab, ba;
    assert_int_equal(cprox_pair(cprox_obstacle_at(a.body, pa), cprox_obstacle_at(b.body, pb), &options, NULL, &ab),
                     CPROX_OK);
    assert_int_equal(cprox_pair(cprox_obstacle_at(b.body, pb), cprox_obstacle_at(a.body, pa), &options, NULL, &ba),
                     CPROX_OK);
    assert_true(ab.lower <= ba.upper && ba.lower <= ab.upper);
    assert_true(vec_norm(vec_sub(ab.witness_mover, ba.witness_obstacle)) < 1e-12 &&
                vec_norm(vec_add(ab.normal, ba.normal)) < 1e-12);
    for (int k = 0; k < 8; k++) { /* phi of any direction is a bound below the signed distance */
      const vec3l u = ref_vec(k == 0 ? ab.normal : rng_unit(&r));
      const long double phi =
          ref_dot(u, shape_extreme(&a, &pa, ref_scale(-1, u))) - ref_dot(u, shape_extreme(&b, &pb, u));
      if (!((long double)ab.upper >= phi - 1e-15L)) fail_msg("upper %.17g, a direction gives %.20Lg", ab.upper, phi);
      if (k == 0) assert_true(phi >= (long double)ab.lower - 1e-7L && phi <= (long double)ab.upper + 1e-15L);
    }
    cprox_body_free(a.body);
    cprox_body_free(b.body);
  }
}

/* Seed 308, 5e4 bodies above, through and below a halfspace: the lowest point's height in long double. */
CASE(a_halfspace_knows_the_signed_distance_of_everything) {
  rng r = rng_seed(308);
  static test_shape b;
  for (size_t i = 0; i < test_cases(50000); i++) {
    shape_make(&r, TEST_BOUNDED[rng_index(&r, TEST_N_BOUNDED)], 1.0, 10.0, &b);
    const cprox_pose ph = rng_pose(&r, 2.0), pb = rng_pose(&r, 2.0);
    const vec3 normal = vec_scale(rng_log_uniform(&r, 1e-3, 1e3), rng_unit(&r));
    const double offset = rng_uniform(&r, -2.0, 2.0);
    cprox_body *h = NULL;
    assert_int_equal(cprox_body_create_halfspace(normal, offset, NULL, &h), CPROX_OK);
    const vec3l n = pose_turn(&ph, ref_vec(normal)), low = ref_to_local(&ph, shape_extreme(&b, &pb, ref_scale(-1, n)));
    const long double exact = (ref_dot(ref_vec(normal), low) + offset) / ref_norm(ref_vec(normal));
    cprox_options options = CPROX_OPTIONS_DEFAULT;
    options.epsilon = 1e-9;
    cprox_result hb, bh;
    assert_int_equal(cprox_pair(cprox_obstacle_at(h, ph), cprox_obstacle_at(b.body, pb), &options, NULL, &hb),
                     CPROX_OK);
    assert_int_equal(cprox_pair(cprox_obstacle_at(b.body, pb), cprox_obstacle_at(h, ph), &options, NULL, &bh),
                     CPROX_OK);
    if (!(hb.lower <= exact && exact <= hb.upper && bh.lower <= exact && exact <= bh.upper))
      fail_msg("%s: [%.17g, %.17g], exact %.20Lg", shape_name(&b), hb.lower, hb.upper, exact);
    assert_true(hb.upper - hb.lower < 1e-10 * (1.0 + vec_norm(vec_scale(offset / vec_norm(normal), normal))));
    /* from b's lowest point straight to the surface */
    const vec3 step = vec_sub(hb.witness_mover, hb.witness_obstacle);
    assert_true(vec_norm(vec_sub(step, vec_scale((double)exact, hb.normal))) < 1e-9 * (1.0 + fabs((double)exact)));
    assert_true(vec_norm(vec_add(hb.normal, bh.normal)) < 1e-15);
    cprox_body_free(h);
    cprox_body_free(b.body);
  }
}

/* Seed 309, 2e4 pairs. */
CASE(padding_is_taken_off_the_distance) {
  rng r = rng_seed(309);
  static test_shape a, b;
  for (size_t i = 0; i < test_cases(20000); i++) {
    shape_make(&r, TEST_BOUNDED[rng_index(&r, TEST_N_BOUNDED)], 1.0, 4.0, &a);
    shape_make(&r, TEST_BOUNDED[rng_index(&r, TEST_N_BOUNDED)], 1.0, 4.0, &b);
    const cprox_pose pa = rng_pose(&r, 1.0);
    cprox_pose pb = rng_pose(&r, 0.0);
    const double gap = rng_uniform(&r, 0.1, 1.0), pad_a = rng_uniform(&r, 0.0, 0.7), pad_b = rng_uniform(&r, 0.0, 0.7);
    const double tolerance = shape_place(&a, &pa, &b, &pb, shape_telling_direction(&r, &b, &pb), gap),
                 exact = gap - (pad_a + pad_b);
    cprox_options options = CPROX_OPTIONS_DEFAULT;
    options.epsilon = 1e-9;
    cprox_result result;
    const cprox_obstacle ta = cprox_with_margin(cprox_obstacle_at(a.body, pa), pad_a),
                         tb = cprox_with_margin(cprox_obstacle_at(b.body, pb), pad_b);
    cprox_pair(ta, tb, &options, NULL, &result);
    /* the cores are apart: the depth is exact as well */
    if (!(result.lower <= exact + tolerance && result.upper >= exact - tolerance))
      fail_msg("%s and %s: [%.17g, %.17g], exact %.17g", shape_name(&a), shape_name(&b), result.lower, result.upper,
               exact);
    assert_int_equal(result.status, CPROX_OK);
    cprox_body_free(a.body);
    cprox_body_free(b.body);
  }
}

/* Seed 310, 5000 unions of three against unions of two: the least of the six, and which part it was. */
CASE(a_compound_is_as_near_as_its_nearest_part) {
  rng r = rng_seed(310);
  static test_shape part[5];
  for (size_t i = 0; i < test_cases(5000); i++) {
    const cprox_body *bodies[5];
    cprox_pose poses[5];
    for (int k = 0; k < 5; k++) {
      shape_make(&r, TEST_BOUNDED[rng_index(&r, TEST_N_BOUNDED)], 0.5, 4.0, &part[k]);
      bodies[k] = part[k].body;
      poses[k] = rng_pose(&r, 1.0);
    }
    cprox_body *a = NULL, *b = NULL;
    assert_int_equal(cprox_body_create_compound(bodies, poses, 3, NULL, &a), CPROX_OK);
    assert_int_equal(cprox_body_create_compound(bodies + 3, poses + 3, 2, NULL, &b), CPROX_OK);
    cprox_pose away = rng_pose(&r, 1.0);
    away.position.x += 6.0;
    cprox_options options = CPROX_OPTIONS_DEFAULT;
    options.epsilon = 1e-9;
    cprox_result whole, single, least = {.upper = INFINITY, .lower = INFINITY};
    assert_int_equal(
        cprox_pair(cprox_obstacle_at(a, away), cprox_obstacle_at(b, CPROX_POSE_IDENTITY), &options, NULL, &whole),
        CPROX_OK);
    for (int p = 0; p < 3; p++)
      for (int q = 0; q < 2; q++) {
        const cprox_obstacle ta = cprox_obstacle_at(bodies[p], frame_compose(&away, &poses[p]));
        cprox_pair(ta, cprox_obstacle_at(bodies[3 + q], poses[3 + q]), &options, NULL, &single);
        if (single.upper >= least.upper) continue;
        least = single;
        least.obstacle_part = q;
      }
    assert_true(whole.lower <= least.upper && least.lower <= whole.upper + 1e-12);
    assert_int_equal(whole.obstacle_part, least.obstacle_part);
    cprox_body_free(a);
    cprox_body_free(b);
    for (int k = 0; k < 5; k++) cprox_body_free(part[k].body);
  }
}

/* ---- where a former search ended ---- */

static void move_a_little(rng *r, double step, cprox_pose *pose) {
  pose->position = vec_axpy(pose->position, step, rng_unit(r));
  pose->orientation.x += step * rng_uniform(r, -1, 1);
  pose->orientation.z += step * rng_uniform(r, -1, 1);
}

/* Steps of pairs of the paper's objects, or of `kinds`, over a motion: from scratch and from the former answer. Both
 * intervals hold the one distance. */
static void track(uint64_t seed, bool implicit, uint64_t *cold, uint64_t *warm) {
  rng r = rng_seed(seed);
  cprox_workspace *workspace = cprox_workspace_create();
  static test_shape shape[2];
  *cold = *warm = 0;
  for (size_t i = 0; i < test_cases(100); i++) {
    cprox_body *body[2];
    for (int k = 0; k < 2; k++) {
      implicit_case c;
      if (implicit) {
        implicit_case_paper(1 + (int)rng_index(&r, 6), &c);
        body[k] = implicit_case_body(&c, NULL);
      } else {
        shape_make(&r, TEST_BOUNDED[rng_index(&r, TEST_N_BOUNDED)], 1.0, 3.0, &shape[k]);
        body[k] = shape[k].body;
      }
    }
    cprox_pose a = rng_pose(&r, 0.5), b = rng_pose(&r, 0.5);
    b.position = vec_axpy(b.position, 1.2 * (body[0]->ball_radius + body[1]->ball_radius), rng_unit(&r));
    cprox_pair_start start = {0};
    cprox_options options = CPROX_OPTIONS_DEFAULT;
    options.epsilon = 1e-8;
    for (int k = 0; k < 20; k++) {
      const cprox_obstacle pa = cprox_with_margin(cprox_obstacle_at(body[0], a), 0.01),
                           pb = cprox_obstacle_at(body[1], b);
      cprox_result none, some;
      options.start = NULL;
      assert_true(cprox_pair(pa, pb, &options, workspace, &none) >= 0);
      options.start = &start;
      assert_true(cprox_pair(pa, pb, &options, workspace, &some) >= 0);
      assert_true(none.lower <= some.upper && some.lower <= none.upper);
      assert_true(some.status == none.status || some.status == CPROX_OK || some.upper < 1e-6);
      if (k > 0 && none.lower > 0.0) *cold += none.nodes, *warm += some.nodes;
      move_a_little(&r, 1e-3, &a);
      move_a_little(&r, 1e-3, &b);
    }
    for (int k = 0; k < 2; k++) cprox_body_free(body[k]);
  }
  cprox_workspace_free(workspace);
}

/* Seeds 61 and 62: 2000 places each. */
CASE(a_start_answers_what_none_does_in_fewer_steps) {
  uint64_t cold, warm;
  track(61, false, &cold, &warm);
  print_message("primitives and polytopes: %lu steps from scratch, %lu from the former answer\n", (unsigned long)cold,
                (unsigned long)warm);
  assert_true(warm < cold);
  track(62, true, &cold, &warm);
  print_message("implicit bodies: %lu steps from scratch, %lu from the former answer\n", (unsigned long)cold,
                (unsigned long)warm);
  assert_true(warm < cold);
}

/* Seed 63: a start of another pair, or one that is no answer at all, changes no truth. */
CASE(a_false_start_is_as_true_as_none) {
  rng r = rng_seed(63);
  cprox_workspace *workspace = cprox_workspace_create();
  for (size_t i = 0; i < test_cases(400); i++) {
    implicit_case c;
    cprox_body *body[2];
    for (int k = 0; k < 2; k++) {
      implicit_case_paper(1 + (int)rng_index(&r, 6), &c);
      body[k] = implicit_case_body(&c, NULL);
    }
    const cprox_pose a = rng_pose(&r, 0.0), b = implicit_random_pose(&r, 2.5, 6);
    const cprox_obstacle pa = cprox_obstacle_at(body[0], a), pb = cprox_obstacle_at(body[1], b);
    cprox_pair_start start = {.usable = true,
                              .point_a = rng_in_cube(&r, 3.0),
                              .point_b = rng_in_cube(&r, 3.0),
                              .normal = rng_unit(&r),
                              .distance = rng_uniform(&r, 0.0, 5.0)};
    if (i % 8 == 0) start.point_a.x = NAN;
    if (i % 8 == 1) start.distance = INFINITY;
    if (i % 8 == 2) start.normal = vec(0, 0, 0);
    if (i % 8 == 3) start.distance = -1.0;
    if (i % 8 == 4) start.point_b.y = 1e300;
    cprox_options options = CPROX_OPTIONS_DEFAULT;
    cprox_result none, some;
    assert_true(cprox_pair(pa, pb, &options, workspace, &none) >= 0);
    options.start = &start;
    assert_true(cprox_pair(pa, pb, &options, workspace, &some) >= 0);
    assert_true(none.lower <= some.upper && some.lower <= none.upper);
    assert_true(some.upper - some.lower <= fmax(none.upper - none.lower, 1e-6));
    for (int k = 0; k < 2; k++) cprox_body_free(body[k]);
  }
  cprox_workspace_free(workspace);
}

/* How far b would have to go along n, a unit vector in the world, to leave a. */
static double way_out(const cprox_body *a, const cprox_pose *pa, const cprox_body *b, const cprox_pose *pb, vec3 n) {
  const frame fa = frame_create(pa, vec(0, 0, 0)), fb = frame_create(pb, vec(0, 0, 0));
  vec3 x, y;
  cprox_body_support(a, frame_turn_to_local(&fa, n), &x);
  cprox_body_support(b, frame_turn_to_local(&fb, vec_neg(n)), &y);
  return vec_dot(n, vec_sub(frame_to_world(&fa, x), frame_to_world(&fb, y)));
}

/* Seed 66: 1500 pairs in overlap, a quarter of them with a second way out that is all but as near. Directions beside the
 * normal, against it, along the axes of both and at random are longer ways out by what the shift says. */
CASE(no_other_way_out_is_the_nearest_within_the_shift) {
  rng r = rng_seed(66);
  static test_shape a, b;
  cprox_workspace *workspace = cprox_workspace_create();
  size_t overlaps = 0, known = 0;
  for (size_t i = 0; i < test_cases(1500); i++) {
    shape_make(&r, TEST_BOUNDED[rng_index(&r, TEST_N_BOUNDED)], 1.0, 3.0, &a);
    shape_make(&r, TEST_BOUNDED[rng_index(&r, TEST_N_BOUNDED)], 1.0, 3.0, &b);
    const cprox_pose pa = rng_pose(&r, 0.0);
    cprox_pose pb = rng_pose(&r, i % 4 ? 0.4 : 0.0);
    if (i % 4 == 0) {
      if (i % 8) pb.orientation = pa.orientation;
      pb.position = vec_axpy(pa.position, i % 16 ? rng_log_uniform(&r, 1e-9, 1e-2) : 0.0, rng_unit(&r));
    }
    cprox_pair_start start = {.usable = false};
    cprox_options options = CPROX_OPTIONS_DEFAULT;
    options.epsilon = 1e-9;
    options.start = &start;
    cprox_result result;
    assert_true(
        cprox_pair(cprox_obstacle_at(a.body, pa), cprox_obstacle_at(b.body, pb), &options, workspace, &result) >= 0);
    /* a sphere's and a capsule's radius is a margin: without it they may be apart, where the normal only turns */
    const bool margins = a.body->shape.margin > 0.0 || b.body->shape.margin > 0.0;
    if (result.upper < 0.0 && !margins) {
      overlaps++;
      known += start.shift > 1e-6;
      const frame f[2] = {frame_create(&pa, vec(0, 0, 0)), frame_create(&pb, vec(0, 0, 0))};
      const vec3 out = vec_neg(result.normal);
      vec3 e, g;
      feature_tangents(out, &e, &g);
      for (int k = 0; k < 200 && start.shift > 0.0; k++) {
        vec3 n = rng_unit(&r);
        if (k < 12)
          n = vec_scale(k % 2 ? 1.0 : -1.0, frame_turn_to_world(&f[k / 6], k / 2 % 3 == 0   ? vec(1, 0, 0)
                                                                           : k / 2 % 3 == 1 ? vec(0, 1, 0)
                                                                                            : vec(0, 0, 1)));
        if (k == 12) n = vec_neg(out);
        if (k > 12 && k < 100) {
          const double tilt = rng_log_uniform(&r, 2e-3, 1.0), turn = rng_uniform(&r, 0.0, 6.3);
          feature_unit(vec_axpy(vec_axpy(out, tilt * cos(turn), e), tilt * sin(turn), g), &n);
        }
        const double angle = vec_norm(vec_sub(n, out));
        if (!(angle > 2e-3)) continue;
        const double longer = way_out(a.body, &pa, b.body, &pb, n) + result.upper;
        if (!(longer > start.shift * angle - 1e-8))
          fail_msg("case %zu, %s in %s: %.9g rad beside the way out only %.9g longer, but the shift is %.9g", i,
                   shape_name(&b), shape_name(&a), angle, longer, start.shift);
      }
      if (i % 16 == 0 && start.shift > 2e-8) { /* both stand about one centre: the opposite way is as near */
        const double back = way_out(a.body, &pa, b.body, &pb, vec_neg(out)) + result.upper;
        assert_true(back > 2.0 * start.shift - 1e-8);
      }
    }
    cprox_body_free(a.body);
    cprox_body_free(b.body);
  }
  print_message("%zu of %zu overlaps have one way out\n", known, overlaps);
  assert_true(known * 10 > overlaps * 7);
  cprox_workspace_free(workspace);
}

/* Seed 64, 20,000 pairs of boxes and polytopes, apart, touching and overlapping: vertices of another answer, or numbers
 * of none, change no truth. Of the pair's own answer they leave one step, if it stands as it did. */
CASE(numbers_of_any_vertices_change_no_truth) {
  rng r = rng_seed(64);
  static test_shape a, b;
  uint64_t cold = 0, warm = 0;
  for (size_t i = 0; i < test_cases(20000); i++) {
    shape_make(&r, i % 3 ? CPROX_BODY_POLYTOPE : CPROX_BODY_BOX, 1.0, i % 5 ? 3.0 : 1e5, &a);
    shape_make(&r, i % 2 ? CPROX_BODY_POLYTOPE : CPROX_BODY_BOX, 1.0, 3.0, &b);
    const cprox_obstacle pa = cprox_obstacle_at(a.body, rng_pose(&r, 0.5));
    const cprox_obstacle pb = cprox_obstacle_at(b.body, rng_pose(&r, i % 4 ? 3.0 : 0.5));
    cprox_options options = CPROX_OPTIONS_DEFAULT;
    cprox_pair_start start = {.usable = false};
    cprox_result none, own, some;
    assert_true(cprox_pair(pa, pb, &options, NULL, &none) >= 0);
    options.start = &start;
    assert_true(cprox_pair(pa, pb, &options, NULL, &own) >= 0);
    /* of an overlap it is asked as well whether there is one way out, which takes a narrower interval */
    if (none.lower > 0.0) assert_true(own.lower == none.lower && own.upper == none.upper);
    assert_true(own.lower >= none.lower && own.upper <= none.upper);
    assert_true(cprox_pair(pa, pb, &options, NULL, &own) >= 0);
    if (none.lower > 1e-3 && a.body->kind != b.body->kind) cold += none.nodes, warm += own.nodes;

    start = (cprox_pair_start){.usable = true,
                               .point_a = rng_in_cube(&r, 2.0),
                               .point_b = rng_in_cube(&r, 2.0),
                               .normal = rng_unit(&r),
                               .n_vertices = (int32_t)rng_index(&r, 5) - 1};
    for (int k = 0; k < 3; k++) {
      start.vertices_a[k] = (int32_t)rng_index(&r, 12) - (i % 7 == 0);
      start.vertices_b[k] = i % 11 ? (int32_t)rng_index(&r, 12) : INT32_MAX;
    }
    assert_true(cprox_pair(pa, pb, &options, NULL, &some) >= 0);
    const double narrow = fmax(none.upper - none.lower, 1e-6) * (1.0 + 1e-9);
    if (!(none.lower <= some.upper && some.lower <= none.upper && none.lower <= own.upper && own.lower <= none.upper))
      fail_msg("case %zu: [%.17g, %.17g], but from vertices [%.17g, %.17g] and [%.17g, %.17g]", i, none.lower,
               none.upper, own.lower, own.upper, some.lower, some.upper);
    if (some.status == CPROX_OK && none.status == CPROX_OK) assert_true(some.upper - some.lower <= narrow);
    cprox_body_free(a.body);
    cprox_body_free(b.body);
  }
  print_message("%lu steps from scratch, %lu from their own vertices\n", (unsigned long)cold, (unsigned long)warm);
  assert_true(2 * warm < cold);
}

int main(void) {
  return cases_run(NULL, NULL);
}
