/* SPDX-License-Identifier: BSD-3-Clause */
/* Implicit bodies that translate, grow and deform. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "curve_proximity/cprox.h"
#include "shape/body.h"
#include "support/cases.h"
#include "support/implicits.h"
#include "support/random.h"
#include "support/shapes.h"

static const int PAIRS[8][2] = {{1, 2}, {1, 3}, {2, 3}, {3, 4}, {2, 4}, {3, 5}, {5, 6}, {3, 6}};

typedef struct bodies {
  cprox_body *body[7];
  cprox_workspace *workspace;
} bodies;

static int make_bodies(void **state) {
  bodies *b = calloc(1, sizeof *b);
  b->workspace = cprox_workspace_create();
  for (int object = 1; object <= 6; object++) {
    implicit_case c;
    implicit_case_paper(object, &c);
    b->body[object] = implicit_case_body(&c, NULL);
  }
  *state = b;
  return 0;
}

static int free_bodies(void **state) {
  bodies *b = *state;
  for (int object = 1; object <= 6; object++) cprox_body_free(b->body[object]);
  cprox_workspace_free(b->workspace);
  free(b);
  return 0;
}

static cprox_translating random_start(rng *r, const cprox_body *body, double near, double far) {
  return (cprox_translating){.from = cprox_obstacle_at(body, implicit_random_pose(r, near, far)),
                             .velocity = rng_in_cube(r, 3)};
}

static cprox_result pair_at(const bodies *b, cprox_translating x, cprox_translating y, double t, double epsilon) {
  x.from.pose.position = vec_axpy(x.from.pose.position, t, x.velocity);
  y.from.pose.position = vec_axpy(y.from.pose.position, t, y.velocity);
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.epsilon = epsilon;
  cprox_result r;
  assert_true(cprox_pair(x.from, y.from, &options, b->workspace, &r) >= 0);
  return r;
}

/* Seed 21, 40 places a pair: the least distance over the time is below that at 33 times, is attained at its own t, and
 * is not above what the separating plane at that t allows. Tolerance: the widths asked for, 1e-8. */
CASE(the_least_distance_over_a_time_is_below_that_at_every_time) {
  bodies *b = *state;
  rng r = rng_seed(21);
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.epsilon = 1e-8;
  for (int pair = 0; pair < 8; pair++) {
    for (size_t i = 0; i < test_cases(40); i++) {
      const cprox_translating x = random_start(&r, b->body[PAIRS[pair][0]], 0, 1);
      const cprox_translating y = random_start(&r, b->body[PAIRS[pair][1]], 2, 8);
      cprox_result found;
      assert_int_equal(cprox_translating_distance(x, y, 2.0, &options, b->workspace, &found), CPROX_OK);
      assert_true(found.lower <= found.upper && found.upper - found.lower <= 1e-8);
      assert_true(found.t >= 0.0 && found.t <= 2.0);
      const cprox_result there = pair_at(b, x, y, found.t, 1e-8);
      assert_true(fmax(there.lower, 0.0) <= found.upper);
      if (found.verdict != CPROX_VERDICT_VIOLATED) {
        const double gap = vec_norm(vec_sub(found.witness_mover, found.witness_obstacle));
        assert_true(fabs(gap - found.upper) <= 1e-9);
      }
      for (int k = 0; k <= 32; k++) {
        const cprox_result at = pair_at(b, x, y, 2.0 * k / 32.0, 1e-8);
        assert_true(found.lower <= fmax(at.upper, 0.0));
      }
    }
  }
}

/* Seed 22, 500 places a pair, contact tolerance 1e-7 of the sizes: nothing undecided, free before as bisection by pairs
 * finds it (within tolerance over the speed), no deeper at the end than `lower` says, and the least distance agrees with
 * the verdict. */
CASE(time_of_contact_is_never_late_and_never_undecided) {
  bodies *b = *state;
  rng r = rng_seed(22);
  uint64_t pairs = 0, contacts = 0;
  for (int pair = 0; pair < 8; pair++) {
    const cprox_body *first = b->body[PAIRS[pair][0]], *second = b->body[PAIRS[pair][1]];
    for (size_t i = 0; i < test_cases(500); i++) {
      cprox_translating x = random_start(&r, first, 0, 1), y = random_start(&r, second, 4, 8);
      if (i % 2 == 0) { /* aimed: most hit */
        const vec3 aim = vec_add(vec_sub(x.from.pose.position, y.from.pose.position), rng_in_cube(&r, 1));
        y.velocity = vec_axpy(x.velocity, 0.7, aim);
      }
      cprox_options options = CPROX_OPTIONS_DEFAULT;
      options.epsilon = 1e-7 * (first->ball_radius + second->ball_radius);
      cprox_result found, least;
      const cprox_status status = cprox_translating_contact(x, y, 2.0, &options, b->workspace, &found);
      assert_int_equal(status, CPROX_OK);
      assert_int_not_equal(found.verdict, CPROX_VERDICT_UNDECIDED);
      assert_int_equal(cprox_translating_distance(x, y, 2.0, &options, b->workspace, &least), CPROX_OK);
      pairs += found.distance_queries;
      contacts += found.verdict == CPROX_VERDICT_VIOLATED;
      if (found.verdict == CPROX_VERDICT_VIOLATED)
        assert_true(least.lower <= options.epsilon);
      else
        assert_true(least.upper > 0.0);
      if (found.verdict == CPROX_VERDICT_VIOLATED && found.t > 0.0) {
        assert_true(found.upper <= 0.0 && found.t_contact_lower <= found.t);
        assert_true(found.lower <= pair_at(b, x, y, found.t, 1e-9).upper);
        assert_true(pair_at(b, x, y, found.t, 1e-3 * options.epsilon).lower <= 0.0); /* no plane fits between them */
        assert_true(pair_at(b, x, y, found.t_contact_lower, 0.01 * options.epsilon).lower <= options.epsilon);
        for (int k = 1; k <= 8; k++) /* free before */
          assert_true(pair_at(b, x, y, found.t_contact_lower * (1.0 - ldexp(1.0, -3 * k)), 1e-9).upper > 0.0);
      }
    }
  }
  print_message("%llu contacts, %.1f pairs a query\n", (unsigned long long)contacts,
                (double)pairs / (8.0 * (double)test_cases(500)));
  assert_true(contacts > test_cases(1000));
}

CASE(bodies_that_part_or_overlap_at_once_are_told_at_once) {
  bodies *b = *state;
  cprox_pose away = CPROX_POSE_IDENTITY;
  away.position.x = 6;
  cprox_translating x = {.from = cprox_obstacle_at(b->body[2], CPROX_POSE_IDENTITY)};
  cprox_translating y = {.from = cprox_obstacle_at(b->body[3], away), .velocity = {1, 0, 0}};
  cprox_result r;
  assert_int_equal(cprox_translating_contact(x, y, 10, NULL, b->workspace, &r), CPROX_OK);
  assert_int_equal(r.verdict, CPROX_VERDICT_CLEAR);
  assert_int_equal(r.distance_queries, 1);
  y.from.pose.position.x = 0.5;
  assert_true(cprox_translating_contact(x, y, 10, NULL, b->workspace, &r) >= 0);
  assert_int_equal(r.verdict, CPROX_VERDICT_VIOLATED);
  assert_true(r.t == 0.0 && r.t_contact_lower == 0.0);
  y.velocity.x = NAN;
  assert_int_equal(cprox_translating_contact(x, y, 10, NULL, b->workspace, &r), CPROX_INVALID);
  assert_string_equal(cprox_workspace_error(b->workspace), "a velocity is not finite");
  y.velocity.x = 1;
  assert_int_equal(cprox_translating_distance(x, y, 0, NULL, b->workspace, &r), CPROX_INVALID);
  cprox_body *points = NULL;
  assert_int_equal(cprox_body_create_points(&(vec3){1, 1, 1}, 1, 0.1, SIZE_MAX, b->workspace, &points), CPROX_OK);
  y.from.body = points;
  assert_int_equal(cprox_translating_distance(x, y, 1, NULL, b->workspace, &r), CPROX_INVALID);
  assert_string_equal(cprox_workspace_error(b->workspace), "b is a points, must be convex");
  cprox_body_free(points);
}

/* ---- any convex kind ---- */

/* Seed 26, 40 places for each of 10 kinds against boxes and Object III: the least distance over the time is that of the
 * body carried along its segment, which another search answers. Tolerance: the widths asked for. */
CASE(the_least_distance_of_any_two_convex_kinds_is_that_along_a_segment) {
  const bodies *b = *state;
  rng r = rng_seed(26);
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.epsilon = 1e-8;
  size_t free_of_contact = 0, inside = 0;
  const size_t cases = test_cases(40 * TEST_N_BOUNDED);
  for (size_t i = 0; i < cases; i++) {
    test_shape shape, other;
    shape_make(&r, TEST_BOUNDED[i % TEST_N_BOUNDED], 1.0, 10.0, &shape);
    shape_make(&r, CPROX_BODY_BOX, 1.0, 10.0, &other);
    const cprox_body *second = i % 3 ? other.body : b->body[3];
    const cprox_translating x = random_start(&r, shape.body, 0, 3), y = random_start(&r, second, 1, 6);
    cprox_result got, along;
    assert_true(cprox_translating_distance(x, y, 1.5, &options, b->workspace, &got) >= 0);

    /* seen from y, x moves along a segment and does not turn; its pose is part of what is carried */
    const vec3 ends[2] = {vec(0, 0, 0), vec_scale(1.5, vec_sub(x.velocity, y.velocity))};
    const cprox_curve_description segment = {.kind = CPROX_CURVE_BEZIER, .points = ends, .n = 2, .t0 = 0.0, .t1 = 1.5};
    cprox_curve *curve = NULL;
    cprox_body *posed = NULL;
    assert_int_equal(cprox_curve_create(&segment, b->workspace, &curve), CPROX_OK);
    assert_int_equal(
        cprox_body_create_compound((const cprox_body *[]){shape.body}, &x.from.pose, 1, b->workspace, &posed),
        CPROX_OK);
    assert_true(cprox_distance(cprox_body_along(posed, curve), y.from, &options, b->workspace, &along) >= 0);
    assert_true(got.lower <= along.upper + 1e-9 && along.lower <= got.upper + 1e-9);
    if (got.status == CPROX_OK) assert_true(got.upper - got.lower <= 1e-8);
    assert_true(got.t >= 0.0 && got.t <= 1.5 && got.distance_queries <= 60);
    free_of_contact += got.verdict == CPROX_VERDICT_CLEAR && got.status == CPROX_OK;
    inside += got.t > 0.0 && got.t < 1.5;
    const vec3 apart = vec_sub(got.witness_mover, got.witness_obstacle);
    if (got.lower > 1e-6) assert_true(fabs(vec_norm(apart) - got.upper) < 1e-6);
    cprox_curve_free(curve);
    cprox_body_free(posed);
    cprox_body_free(shape.body);
    cprox_body_free(other.body);
  }
  assert_true(free_of_contact > cases / 3 && inside > cases / 5);
}

/* Seed 27: two boxes with the same axes touch when scaled by the largest of |apart|/(half + half) along an axis; two
 * balls by |apart|/(r + s). A centre that is not inside, and what has no end, is refused. */
CASE(growth_distances_of_boxes_and_balls_are_their_formulas) {
  const bodies *b = *state;
  rng r = rng_seed(27);
  cprox_growth growth;
  for (size_t i = 0; i < test_cases(200); i++) {
    const vec3 size = vec_add(vec(1.1, 1.1, 1.1), rng_in_cube(&r, 1.0)),
               other = vec_add(vec(1.1, 1.1, 1.1), rng_in_cube(&r, 1.0)), apart = rng_in_cube(&r, 3.0);
    cprox_body *boxes[2] = {NULL, NULL}, *balls[2] = {NULL, NULL};
    assert_int_equal(cprox_body_create_box(size, b->workspace, &boxes[0]), CPROX_OK);
    assert_int_equal(cprox_body_create_box(other, b->workspace, &boxes[1]), CPROX_OK);
    assert_int_equal(cprox_body_create_sphere(size.x, b->workspace, &balls[0]), CPROX_OK);
    assert_int_equal(cprox_body_create_sphere(other.x, b->workspace, &balls[1]), CPROX_OK);
    const cprox_pose here = CPROX_POSE_IDENTITY, there = {.position = apart, .orientation = {1, 0, 0, 0}};
    const double of_boxes = 2.0 * fmax(fabs(apart.x) / (size.x + other.x),
                                       fmax(fabs(apart.y) / (size.y + other.y), fabs(apart.z) / (size.z + other.z)));
    assert_int_equal(cprox_growth_distance(cprox_obstacle_at(boxes[0], here), cprox_obstacle_at(boxes[1], there), NULL,
                                           b->workspace, &growth),
                     CPROX_OK);
    assert_true(growth.lower <= of_boxes * (1 + 1e-12) && of_boxes <= growth.upper * (1 + 1e-12));
    const double of_balls = vec_norm(apart) / (size.x + other.x);
    assert_int_equal(cprox_growth_distance(cprox_obstacle_at(balls[0], here), cprox_obstacle_at(balls[1], there), NULL,
                                           b->workspace, &growth),
                     CPROX_OK);
    assert_true(growth.lower <= of_balls * (1 + 1e-12) && of_balls <= growth.upper * (1 + 1e-12));
    for (int k = 0; k < 2; k++) cprox_body_free(boxes[k]), cprox_body_free(balls[k]);
  }
  cprox_body *flat = NULL, *endless = NULL;
  const vec3 corners[3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  assert_int_equal(cprox_body_create_polytope(corners, 3, b->workspace, &flat), CPROX_OK);
  assert_int_equal(cprox_body_create_halfspace(vec(0, 0, 1), 1, b->workspace, &endless), CPROX_OK);
  const cprox_obstacle x = cprox_obstacle_at(b->body[2], CPROX_POSE_IDENTITY);
  const cprox_body *refused[2] = {flat, endless};
  for (int k = 0; k < 2; k++) {
    const cprox_obstacle y = cprox_obstacle_at(refused[k], CPROX_POSE_IDENTITY);
    assert_int_equal(cprox_growth_distance(x, y, NULL, b->workspace, &growth), CPROX_INVALID);
    assert_non_null(strstr(cprox_workspace_error(b->workspace), "must be bounded and have its centre inside"));
  }
  cprox_body_free(flat);
  cprox_body_free(endless);
}

/* Scaled about its centre by g. */
static cprox_body *scaled(const bodies *b, const cprox_body *body, double g) {
  cprox_affine map = {.linear = {g, 0, 0, 0, g, 0, 0, 0, g}, .translation = vec_scale(1.0 - g, body->centre)};
  cprox_body *made = NULL;
  assert_int_equal(implicit_deformed(body, &map, NULL, 0, b->workspace, &made), CPROX_OK);
  return made;
}

/* Seed 23, 60 places a pair, near and deep: scaled by a little less the bodies are apart, by a little more they
 * overlap. */
CASE(scaled_by_the_growth_distance_bodies_touch) {
  bodies *b = *state;
  rng r = rng_seed(23);
  for (int pair = 0; pair < 8; pair++) {
    const cprox_body *first = b->body[PAIRS[pair][0]], *second = b->body[PAIRS[pair][1]];
    for (size_t i = 0; i < test_cases(60); i++) {
      const cprox_obstacle x = cprox_obstacle_at(first, implicit_random_pose(&r, 0, 1));
      const cprox_obstacle y = cprox_obstacle_at(second, implicit_random_pose(&r, 0, 5));
      cprox_growth growth;
      assert_int_equal(cprox_growth_distance(x, y, NULL, b->workspace, &growth), CPROX_OK);
      assert_true(growth.lower <= growth.upper && growth.upper - growth.lower <= 1e-6 * growth.upper);
      for (int side = 0; side < 2; side++) {
        const double g = side == 0 ? growth.lower * (1 - 1e-9) : growth.upper * (1 + 1e-9);
        cprox_body *small = scaled(b, first, g), *other = scaled(b, second, g);
        cprox_options options = CPROX_OPTIONS_DEFAULT;
        options.epsilon = 1e-10;
        cprox_result found;
        assert_true(cprox_pair(cprox_obstacle_at(small, x.pose), cprox_obstacle_at(other, y.pose), &options,
                               b->workspace, &found) >= 0);
        if (side == 0)
          assert_true(found.upper > -1e-9);
        else
          assert_true(found.lower < 1e-9);
        cprox_body_free(small);
        cprox_body_free(other);
      }
      cprox_result now;
      assert_true(cprox_pair(x, y, NULL, b->workspace, &now) >= 0);
      if (growth.upper < 1.0) assert_true(now.lower <= 0.0);
      if (growth.lower > 1.0) assert_true(now.upper >= 0.0);
    }
  }
}

CASE(concentric_bodies_have_growth_distance_zero) {
  bodies *b = *state;
  cprox_growth growth;
  const cprox_obstacle x = cprox_obstacle_at(b->body[2], CPROX_POSE_IDENTITY);
  assert_int_equal(
      cprox_growth_distance(x, cprox_obstacle_at(b->body[3], CPROX_POSE_IDENTITY), NULL, b->workspace, &growth),
      CPROX_OK);
  assert_true(growth.lower == 0.0 && growth.upper <= 1e-9);
  assert_int_equal(cprox_growth_distance(x, cprox_with_margin(x, 0.1), NULL, b->workspace, &growth), CPROX_INVALID);
}

/* Seed 24, 20 maps a body, the deformation by a map and the body made anew under the same map answer the same; and the
 * paper's Fig. 7: object I with the exponents of III is object III but for its semi-axes. */
CASE(a_deformed_body_is_the_one_made_anew) {
  bodies *b = *state;
  rng r = rng_seed(24);
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.epsilon = 1e-9;
  for (int object = 1; object <= 6; object++) {
    implicit_case c;
    implicit_case_paper(object, &c);
    for (int i = 0; i < 20; i++) {
      cprox_affine map;
      for (int k = 0; k < 9; k++) map.linear[k] = rng_uniform(&r, -0.7, 0.7) + (k % 4 == 0 ? 1.5 : 0.0);
      map.translation = rng_in_cube(&r, 2);
      cprox_body *anew = implicit_case_body(&c, &map), *deformed = NULL;
      assert_int_equal(implicit_deformed(b->body[object], &map, NULL, 0, b->workspace, &deformed), CPROX_OK);
      const cprox_obstacle other = cprox_obstacle_at(b->body[3], implicit_random_pose(&r, 6, 12));
      cprox_result x, y;
      assert_int_equal(cprox_pair(cprox_obstacle_at(anew, CPROX_POSE_IDENTITY), other, &options, b->workspace, &x),
                       CPROX_OK);
      assert_int_equal(cprox_pair(cprox_obstacle_at(deformed, CPROX_POSE_IDENTITY), other, &options, b->workspace, &y),
                       CPROX_OK);
      assert_true(x.lower <= y.upper + 1e-12 && y.lower <= x.upper + 1e-12);
      cprox_body_free(anew);
      cprox_body_free(deformed);
    }
  }
  const double exponents[3] = {76.0 / 9, 71.0 / 5, 179.0 / 13}, bad[3] = {0.5, 2, 2};
  const cprox_affine interval = {.linear = {1, 0, 0, 0, 1 / 0.7, 0, 0, 0, 1}};
  cprox_body *third = NULL;
  assert_int_equal(implicit_deformed(b->body[1], &interval, exponents, 3, b->workspace, &third), CPROX_OK);
  cprox_result x, y;
  cprox_pose far = CPROX_POSE_IDENTITY;
  far.position = vec(3, 2, 4);
  const cprox_obstacle other = cprox_obstacle_at(b->body[2], far);
  assert_int_equal(cprox_pair(cprox_obstacle_at(third, CPROX_POSE_IDENTITY), other, &options, b->workspace, &x),
                   CPROX_OK);
  assert_int_equal(cprox_pair(cprox_obstacle_at(b->body[3], CPROX_POSE_IDENTITY), other, &options, b->workspace, &y),
                   CPROX_OK);
  assert_true(x.lower <= y.upper + 1e-12 && y.lower <= x.upper + 1e-12);
  cprox_body_free(third);
  third = NULL;
  assert_int_equal(implicit_deformed(b->body[1], NULL, bad, 3, b->workspace, &third), CPROX_INVALID);
  assert_non_null(strstr(cprox_workspace_error(b->workspace), "the exponent is 0.5"));
  assert_int_equal(implicit_deformed(b->body[1], NULL, exponents, 2, b->workspace, &third), CPROX_INVALID);
  assert_null(third);
}

int main(void) {
  return cases_run(make_bodies, free_bodies);
}
