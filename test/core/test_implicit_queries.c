/* SPDX-License-Identifier: BSD-3-Clause */
/* Implicit bodies in the queries of all bodies: against other kinds, overlapping, carried along curves, in compounds.
 */
#include <math.h>
#include <stdlib.h>

#include "curve_proximity/cprox.h"
#include "shape/body.h"
#include "support/cases.h"
#include "support/implicits.h"
#include "support/make_curve.h"
#include "support/random.h"

static int make_workspace(void **state) {
  *state = cprox_workspace_create();
  return *state ? 0 : -1;
}

static int free_workspace(void **state) {
  cprox_workspace_free(*state);
  return 0;
}

/* The same set twice: of a kind with a closed form, and as constraints; `kind` 0 … 3. */
static void make_twins(int kind, vec3 a, cprox_workspace *w, cprox_body **known, cprox_body **body) {
  const double planes[6][4] = {{1, 0, 0, -a.x},  {-1, 0, 0, -a.x}, {0, 2, 0, -2 * a.y},
                               {0, -1, 0, -a.y}, {0, 0, 1, -a.z},  {0, 0, -3, -3 * a.z}};
  const double ball[1][10] = {{1, 0, 0, 1, 0, 1, 0, 0, 0, -a.x * a.x}};
  const double tube[1][10] = {{1, 0, 0, 1, 0, 0, 0, 0, 0, -a.x * a.x}};
  cprox_implicit_description d = {0};
  if (kind == 0) {
    assert_int_equal(cprox_body_create_ellipsoid(a, w, known), CPROX_OK);
    assert_int_equal(cprox_body_create_superquadric(a, vec(2, 2, 2), w, body), CPROX_OK);
    return;
  }
  if (kind == 1) {
    assert_int_equal(cprox_body_create_box(vec_scale(2, a), w, known), CPROX_OK);
    d.planes = planes, d.n_planes = 6;
  } else if (kind == 2) {
    assert_int_equal(cprox_body_create_sphere(a.x, w, known), CPROX_OK);
    d.quadrics = ball, d.n_quadrics = 1;
  } else {
    assert_int_equal(cprox_body_create_cylinder(2 * a.z, a.x, w, known), CPROX_OK);
    d.planes = planes + 4, d.n_planes = 2, d.quadrics = tube, d.n_quadrics = 1;
  }
  assert_int_equal(cprox_body_create_implicit(&d, NULL, w, body), CPROX_OK);
}

static vec3 random_size(rng *r) {
  return vec(rng_uniform(r, 0.3, 2), rng_uniform(r, 0.3, 2), rng_uniform(r, 0.3, 2));
}

/* Tolerance of agreement of two certified intervals: none. */
static void assert_agree(const cprox_result *x, const cprox_result *y) {
  if (!(x->lower <= y->upper && y->lower <= x->upper))
    fail_msg("[%.17g, %.17g] and [%.17g, %.17g]", x->lower, x->upper, y->lower, y->upper);
}

/* Seed 31: pairs of twins against twins, apart, touching and overlapping to all depths: known-known, implicit-known and
 * implicit-implicit answer the same signed distance, each to 1e-6. */
CASE(pairs_of_twins_have_one_signed_distance) {
  cprox_workspace *w = *state;
  rng r = rng_seed(31);
  for (size_t i = 0; i < test_cases(400); i++) {
    cprox_body *known[2], *body[2];
    make_twins((int)rng_index(&r, 4), random_size(&r), w, &known[0], &body[0]);
    make_twins((int)rng_index(&r, 4), random_size(&r), w, &known[1], &body[1]);
    const cprox_pose pose[2] = {rng_pose(&r, 1), rng_pose(&r, 2.5)};
    cprox_result found[4];
    for (int k = 0; k < 4; k++) {
      const cprox_obstacle a = cprox_obstacle_at(k & 1 ? body[0] : known[0], pose[0]);
      const cprox_obstacle b = cprox_obstacle_at(k & 2 ? body[1] : known[1], pose[1]);
      assert_true(cprox_pair(a, b, NULL, w, &found[k]) >= 0);
      for (int j = 0; j < k; j++) assert_agree(&found[j], &found[k]);
      if (found[k].lower > 0.0) assert_true(found[k].upper - found[k].lower <= 1.0001e-6);
    }
    for (int k = 0; k < 2; k++) cprox_body_free(known[k]), cprox_body_free(body[k]);
  }
}

/* Seed 32: the paper's objects against boxes, capsules and polytopes by the search over supports, and against the box
 * as six planes by the interior point method. */
CASE(other_kinds_are_measured_against_implicit_bodies) {
  cprox_workspace *w = *state;
  rng r = rng_seed(32);
  for (int object = 1; object <= 6; object++) {
    implicit_case c;
    implicit_case_paper(object, &c);
    cprox_body *body = implicit_case_body(&c, NULL);
    for (size_t i = 0; i < test_cases(60); i++) {
      cprox_body *known, *planes;
      make_twins(1, random_size(&r), w, &known, &planes);
      const cprox_obstacle a = cprox_obstacle_at(body, rng_pose(&r, 1)), b = {.body = known, .pose = rng_pose(&r, 5)};
      cprox_obstacle b2 = b;
      b2.body = planes;
      cprox_result x, y;
      assert_true(cprox_pair(a, b, NULL, w, &x) >= 0);
      assert_true(cprox_pair(a, b2, NULL, w, &y) >= 0);
      assert_agree(&x, &y);
      assert_true(x.lower <= 0.0 || x.upper - x.lower <= 1.0001e-6);
      cprox_body_free(known);
      cprox_body_free(planes);
    }
    cprox_body_free(body);
  }
}

/* Seed 33: a carried twin and its known kind along the same curve, against a twin and a known kind that stand; and the
 * same in a compound: distance, signed distance and time of contact agree. */
CASE(a_carried_twin_is_measured_like_the_kind_it_equals) {
  cprox_workspace *w = *state;
  rng r = rng_seed(33);
  for (size_t i = 0; i < test_cases(25); i++) {
    cprox_body *known[2], *body[2], *compound = NULL;
    make_twins((int)(i % 4), random_size(&r), w, &known[0], &body[0]);
    make_twins((int)rng_index(&r, 4), random_size(&r), w, &known[1], &body[1]);
    const cprox_body *parts[2] = {body[1], body[1]};
    cprox_pose places[2] = {CPROX_POSE_IDENTITY, CPROX_POSE_IDENTITY};
    places[1].position.x = 1e3; /* far away */
    assert_int_equal(cprox_body_create_compound(parts, places, 2, w, &compound), CPROX_OK);
    cprox_vec3 points[4];
    for (int k = 0; k < 4; k++) points[k] = rng_in_cube(&r, 6);
    cprox_curve *curve = NULL;
    assert_int_equal(curve_from(describe_bezier(points, 4, 0, 1), w, &curve), CPROX_OK);
    const cprox_pose pose = rng_pose(&r, 2);
    cprox_result expected, found;
    assert_true(
        cprox_distance(cprox_body_along(known[0], curve), cprox_obstacle_at(known[1], pose), NULL, w, &expected) >= 0);
    assert_true(cprox_distance(cprox_body_along(body[0], curve), cprox_obstacle_at(body[1], pose), NULL, w, &found) >=
                0);
    assert_agree(&expected, &found);
    assert_true(found.upper - found.lower <= 1.0001e-6);
    assert_true(cprox_distance(cprox_body_along(body[0], curve), cprox_obstacle_at(compound, pose), NULL, w, &found) >=
                0);
    assert_agree(&expected, &found);
    cprox_options deep = CPROX_OPTIONS_DEFAULT;
    deep.signed_distance = true;
    assert_true(cprox_distance(cprox_point_along(curve), cprox_obstacle_at(known[1], pose), &deep, w, &expected) >= 0);
    assert_true(cprox_distance(cprox_point_along(curve), cprox_obstacle_at(body[1], pose), &deep, w, &found) >= 0);
    assert_agree(&expected, &found);
    cprox_result first, second;
    assert_true(cprox_time_of_contact(cprox_point_along(curve), cprox_obstacle_at(known[1], pose), NULL, w, &first) >=
                0);
    assert_true(cprox_time_of_contact(cprox_point_along(curve), cprox_obstacle_at(body[1], pose), NULL, w, &second) >=
                0);
    assert_true(first.verdict == second.verdict || first.verdict == CPROX_VERDICT_UNDECIDED ||
                second.verdict == CPROX_VERDICT_UNDECIDED);
    if (first.verdict == CPROX_VERDICT_VIOLATED && second.verdict == CPROX_VERDICT_VIOLATED)
      assert_true(second.t_contact_lower <= first.t && first.t_contact_lower <= second.t);
    cprox_curve_free(curve);
    cprox_body_free(compound);
    for (int k = 0; k < 2; k++) cprox_body_free(known[k]), cprox_body_free(body[k]);
  }
}

int main(void) {
  return cases_run(make_workspace, free_workspace);
}
