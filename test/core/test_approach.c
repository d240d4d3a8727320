/* SPDX-License-Identifier: BSD-3-Clause */
/* Projections onto cores, and what is found by them of pairs: held against closed forms, differences and known
 * distances. */
#include "base/rounding.h"
#include "convex/feature.h"
#include "convex/pair.h"
#include "curve_proximity/cprox/query.h"
#include "shape/body.h"
#include "support/cases.h"
#include "support/random.h"
#include "support/reference.h"
#include "support/shapes.h"

/* The last is smooth and has no foot. */
static const cprox_body_kind PROJECTED[] = {CPROX_BODY_POINT,    CPROX_BODY_SPHERE,   CPROX_BODY_BOX,
                                            CPROX_BODY_CAPSULE,  CPROX_BODY_CYLINDER, CPROX_BODY_CONE,
                                            CPROX_BODY_ELLIPSOID};
enum { N_PROJECTED = 6, FIRST_SOLID = 2, N_SOLID = 5 };

/* ---- feet ---- */

/* Seed 801, 1e5 points, from inside to 10 sizes away, on both sides of every limit between pieces. The distance of the
 * foot is that of the closed form, margin put back, to 32 roundings of the sizes; the foot is a point of the core and,
 * inside, the point itself. */
CASE(a_foot_is_the_nearest_point_of_the_core) {
  rng r = rng_seed(801);
  static test_shape s;
  for (size_t i = 0; i < 100000; i++) {
    shape_make(&r, PROJECTED[rng_index(&r, N_PROJECTED)], 1.0, 1e3, &s);
    const convex *c = &s.body->shape;
    const vec3 y = vec_scale(rng_log_uniform(&r, 1e-3, 10.0), rng_unit(&r));
    convex_foot foot;
    c->ops->project(c, y, &foot);
    convex_near near;
    c->ops->nearest(c, y, NULL, &near);
    const double distance = vec_norm(vec_sub(y, foot.point));
    const double expected = fmax(near.distance + c->margin, 0.0), doubt = 32.0 * ROUND_U * (vec_norm(y) + c->scale);
    if (!(fabs(distance - expected) <= doubt))
      fail_msg("%s: the foot is %.17g away, the core %.17g", shape_name(&s), distance, expected);
    const vec3 d = rng_unit(&r);
    if (!(vec_dot(d, foot.point) <= c->ops->support(c, d, NULL, NULL) + 16.0 * ROUND_U * c->scale))
      fail_msg("%s: the foot lies beyond the support plane", shape_name(&s));
    if (foot.tangents == 3) assert_true(distance == 0.0);
    cprox_body_free(s.body);
  }
}

/* Seed 802, 5e4 points outside: the foot moves along its tangents as `along` says and nowhere else, by central
 * differences of 1e-6; where the two ends fall on pieces of other dimensions nothing is said. Tolerance 1e-6: second
 * derivatives of bodies of size .25 to 1 and rounding over the step. */
CASE(a_foot_moves_along_its_tangents) {
  rng r = rng_seed(802);
  const double h = 1e-6;
  static test_shape s;
  size_t checked = 0;
  for (size_t i = 0; i < 50000; i++) {
    shape_make(&r, PROJECTED[rng_index(&r, N_PROJECTED)], 1.0, 4.0, &s);
    const convex *c = &s.body->shape;
    const vec3 y = vec_scale(rng_uniform(&r, 0.5, 4.0), rng_unit(&r)), d = rng_unit(&r);
    convex_foot foot, ahead, behind;
    c->ops->project(c, y, &foot);
    c->ops->project(c, vec_axpy(y, h, d), &ahead);
    c->ops->project(c, vec_axpy(y, -h, d), &behind);
    if (foot.tangents < 3 && ahead.tangents == foot.tangents && behind.tangents == foot.tangents) {
      vec3 moved = vec_scale(0.5 / h, vec_sub(ahead.point, behind.point));
      for (int k = 0; k < foot.tangents; k++)
        moved = vec_axpy(moved, -foot.along[k] * vec_dot(d, foot.e[k]), foot.e[k]);
      if (!(vec_norm(moved) < 1e-6))
        fail_msg("%s, piece of dimension %d: %g is left", shape_name(&s), foot.tangents, vec_norm(moved));
      checked++;
    }
    cprox_body_free(s.body);
  }
  assert_true(checked > 40000);
}

/* ---- pairs ---- */

/* Turned by a multiple of 45 degrees about an axis, and from there by as little as `tilt`. */
static cprox_quat near_symmetric(rng *r, cprox_quat q, double tilt) {
  static const double half[4][2] = {
      {1.0, 0.0}, {0.92387953251128674, 0.38268343236508977}, {0.70710678118654757, 0.70710678118654757}, {0.0, 1.0}};
  const size_t k = rng_index(r, 4), axis = rng_index(r, 3);
  const vec3 small = vec_scale(tilt, rng_unit(r));
  const cprox_pose turn = {.orientation = {half[k][0], axis == 0 ? half[k][1] : 0.0, axis == 1 ? half[k][1] : 0.0,
                                           axis == 2 ? half[k][1] : 0.0}};
  const cprox_pose lean = {.orientation = {1.0, small.x, small.y, small.z}}, first = {.orientation = q};
  const cprox_pose turned = frame_compose(&first, &turn);
  return frame_compose(&turned, &lean).orientation;
}

/* Along an axis of the shape or between two of them, and from there by as little as `tilt`. */
static vec3 near_axis(rng *r, const cprox_pose *pose, double tilt) {
  vec3 n = vec(0, 0, 0);
  while (vec_norm2(n) == 0.0)
    n = vec((double)rng_index(r, 3) - 1.0, (double)rng_index(r, 3) - 1.0, (double)rng_index(r, 3) - 1.0);
  const vec3l turned = pose_turn(pose, ref_vec(n));
  return vec_axpy(vec((double)turned.x, (double)turned.y, (double)turned.z), tilt, rng_unit(r));
}

/* Seed 803, 2e5 pairs of boxes, capsules, cylinders, cones and ellipsoids: half of them in the attitudes where faces,
 * edges, rims and axes are parallel or nearly so (tilts of 1e-16 to 1e-2), aspects up to 1e6, size ratios up to 1e12,
 * gaps of 1e-15 to 10 sizes. Distances by construction; tolerance: what the rounding of b's position moved. */
CASE(grazing_rims_and_parallel_edges_lie_in_the_interval) {
  rng r = rng_seed(803);
  static test_shape a, b;
  size_t open = 0;
  const size_t cases = test_cases(200000);
  for (size_t i = 0; i < cases; i++) {
    const double aspect = rng_index(&r, 3) ? 4.0 : 1e6, ratio = rng_index(&r, 3) ? 4.0 : 1e12;
    const double scale = rng_log_uniform(&r, 1.0 / ratio, 1.0);
    shape_make(&r, PROJECTED[FIRST_SOLID + rng_index(&r, N_SOLID)], 1.0, aspect, &a);
    shape_make(&r, PROJECTED[FIRST_SOLID + rng_index(&r, N_SOLID)], scale, aspect, &b);
    const cprox_pose pa = rng_pose(&r, 0.0);
    cprox_pose pb = rng_pose(&r, 0.0);
    const bool symmetric = rng_index(&r, 2);
    const double tilt = rng_index(&r, 4) ? rng_log_uniform(&r, 1e-16, 1e-2) : 0.0;
    if (symmetric) pb.orientation = near_symmetric(&r, pa.orientation, tilt);
    const vec3 n = symmetric ? near_axis(&r, rng_index(&r, 2) ? &pa : &pb, tilt) : shape_telling_direction(&r, &b, &pb);
    const double gap = rng_log_uniform(&r, 1e-15, 10.0), tolerance = shape_place(&a, &pa, &b, &pb, n, gap);

    cprox_options options = CPROX_OPTIONS_DEFAULT;
    const double sizes = a.body->ball_radius + b.body->ball_radius + vec_norm(vec_sub(pa.position, pb.position));
    options.epsilon = 400.0 * ROUND_U * (sizes + vec_norm(a.body->ball_centre) + vec_norm(b.body->ball_centre));
    options.relative_epsilon = 1e-9;
    cprox_result result;
    assert_true(cprox_pair(cprox_obstacle_at(a.body, pa), cprox_obstacle_at(b.body, pb), &options, NULL, &result) >=
                CPROX_OK);
    if (!(result.upper >= gap - tolerance && result.lower <= gap + tolerance && result.lower <= result.upper))
      fail_msg("%s and %s at gap %.17g, tilt %g: [%.17g, %.17g], status %s", shape_name(&a), shape_name(&b), gap, tilt,
               result.lower, result.upper, cprox_status_name(result.status));
    if (result.status == CPROX_OK && gap > 1e-6) {
      const vec3 apart = vec_sub(result.witness_mover, result.witness_obstacle);
      assert_true(fabs(vec_norm(apart) - result.upper) <= 1e-9 * result.upper + 2.0 * options.epsilon);
      assert_true(vec_dot(apart, result.normal) >= (1.0 - 1e-7) * result.upper - 2.0 * options.epsilon);
    }
    open += result.status != CPROX_OK;
    cprox_body_free(a.body);
    cprox_body_free(b.body);
  }
  print_message("open: %zu of %zu\n", open, cases);
  assert_true((double)open <= 2.0 + 0.01 * (double)cases);
}

static double distance_at(const test_shape *a, const test_shape *b, const pair_placement *place, vec3 shift,
                          pair_feature *feature) {
  pair_placement moved = *place;
  moved.t = vec_add(place->t, shift);
  const pair_goal goal = {.relative_epsilon = 1e-13, .max_steps = 256, .wants_feature = true};
  pair_answer answer;
  pair_separate(&a->body->shape, 0.0, &b->body->shape, 0.0, &moved, &goal, &answer);
  if (feature) *feature = answer.feature;
  return answer.upper - answer.rounding;
}

/* The second derivative along d that the feature says: of a flat one, what is across its directions, over the distance.
 */
static double curvature_along(const pair_feature *feature, vec3 d, double distance) {
  if (!feature->flat) return feature_quadratic(feature->hessian, d, d);
  vec3 e, f, rest = d, foot = feature->w[0];
  if (feature->n > 1) {
    feature_unit(vec_sub(feature->w[1], feature->w[0]), &e);
    rest = vec_axpy(rest, -vec_dot(rest, e), e);
    foot = vec_axpy(foot, -vec_dot(foot, e), e);
  }
  if (feature->n > 2) {
    const vec3 second = vec_sub(feature->w[2], feature->w[0]);
    feature_unit(vec_axpy(second, -vec_dot(second, e), e), &f);
    rest = vec_axpy(rest, -vec_dot(rest, f), f);
    foot = vec_axpy(foot, -vec_dot(foot, f), f);
  }
  feature_unit(foot, &foot);
  rest = vec_axpy(rest, -vec_dot(rest, foot), foot);
  return vec_norm2(rest) / distance;
}

/* Seed 806, 2e4 pairs, somewhere and apart by their sizes: the feature tells the second derivative of the distance of
 * the cores, by central differences of 1e-4. Tolerance 1e-4: rounding of 1e-15 over 1e-8, and fourth derivatives up to
 * 1e3 times 1e-8; in one pair of five hundred the step may cross to another feature. */
CASE(the_feature_tells_how_the_distance_bends) {
  rng r = rng_seed(806);
  const double h = 1e-4;
  static test_shape a, b;
  size_t wrong = 0;
  const size_t cases = test_cases(20000);
  for (size_t i = 0; i < cases; i++) {
    shape_make(&r, PROJECTED[rng_index(&r, N_PROJECTED)], 1.0, 3.0, &a);
    shape_make(&r, PROJECTED[rng_index(&r, N_PROJECTED)], 1.0, 3.0, &b);
    cprox_pose pb = rng_pose(&r, 0.0);
    pb.position = vec_scale(rng_uniform(&r, 1.1, 4.0) * (a.body->ball_radius + b.body->ball_radius), rng_unit(&r));
    const frame f = frame_create(&pb, b.body->centre);
    pair_placement place = {.t = vec_sub(frame_to_world(&f, vec(0, 0, 0)), a.body->centre)};
    for (int k = 0; k < 9; k++) place.r[k] = f.r[k];
    pair_feature feature;
    const vec3 d = rng_unit(&r);
    const double here = distance_at(&a, &b, &place, vec(0, 0, 0), &feature);
    const double ahead = distance_at(&a, &b, &place, vec_scale(h, d), NULL);
    const double behind = distance_at(&a, &b, &place, vec_scale(-h, d), NULL);
    const double bend = (ahead + behind - 2.0 * here) / (h * h), told = curvature_along(&feature, d, here);
    wrong += !(fabs(bend - told) <= 1e-4 * fmax(1.0, told));
    cprox_body_free(a.body);
    cprox_body_free(b.body);
  }
  print_message("%zu of %zu cross to another feature\n", wrong, cases);
  assert_true((double)wrong <= 2.0 + 0.002 * (double)cases);
}

/* The mean of looks over 1e4 pairs, gaps of 1e-6 to 1 sizes, to a relative 1e-9. */
static double looks_of(uint64_t seed, cprox_body_kind kind_a, cprox_body_kind kind_b) {
  rng r = rng_seed(seed);
  static test_shape a, b;
  double looks = 0.0;
  const size_t cases = test_cases(10000);
  for (size_t i = 0; i < cases; i++) {
    shape_make(&r, kind_a, 1.0, 4.0, &a);
    shape_make(&r, kind_b, 1.0, 4.0, &b);
    const cprox_pose pa = rng_pose(&r, 0.0);
    cprox_pose pb = rng_pose(&r, 0.0);
    shape_place(&a, &pa, &b, &pb, shape_telling_direction(&r, &b, &pb), rng_log_uniform(&r, 1e-6, 1.0));
    cprox_options options = CPROX_OPTIONS_DEFAULT;
    options.epsilon = 0.0;
    options.relative_epsilon = 1e-9;
    cprox_result result;
    cprox_pair(cprox_obstacle_at(a.body, pa), cprox_obstacle_at(b.body, pb), &options, NULL, &result);
    looks += result.distance_queries;
    cprox_body_free(a.body);
    cprox_body_free(b.body);
  }
  print_message("%.2f looks in the mean\n", looks / (double)cases);
  return looks / (double)cases;
}

/* Seeds 804 and 805: the simplex search takes 10 looks for the one, 6 for the other. */
CASE(projections_and_smoothness_save_looks) {
  assert_true(looks_of(804, CPROX_BODY_BOX, CPROX_BODY_CYLINDER) <= 4.0);
  assert_true(looks_of(805, CPROX_BODY_ELLIPSOID, CPROX_BODY_ELLIPSOID) <= 5.0);
}

int main(void) {
  return cases_run(NULL, NULL);
}
