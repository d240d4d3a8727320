/* SPDX-License-Identifier: BSD-3-Clause */
/* Curves that jump from one piece to the next are all of their pieces, and nothing between them. */
#include <math.h>

#include "curve_proximity/cprox.h"
#include "support/builders.h"
#include "support/cases.h"
#include "support/make_curve.h"
#include "support/meshes.h"
#include "support/random.h"
#include "support/reference.h"
#include "support/shapes.h"

enum { MOST_PIECES = 4, MOST_POINTS = 4, SAMPLES = 40 };

#define SPREAD 0.3 /* [m] control points are within this of the middle of their piece, by coordinates */
#define TUBE 0.05
#define OTHER_TUBE 0.1

typedef struct jumping_curve {
  vec3 points[MOST_PIECES][MOST_POINTS];
  size_t n, degree;
  cprox_curve *curve; /* piece i over [i, i + 1] */
} jumping_curve;

/* Its n pieces have their middles in a cube with half edges of `half`. */
static jumping_curve jumping_make(rng *r, size_t n, double half) {
  jumping_curve j = {.n = n, .degree = 1 + rng_index(r, MOST_POINTS - 1)};
  cprox_curve *pieces[MOST_PIECES];
  double ends[MOST_PIECES + 1] = {0.0};
  for (size_t i = 0; i < n; i++) {
    const vec3 middle = rng_in_cube(r, half);
    for (size_t k = 0; k <= j.degree; k++) j.points[i][k] = vec_add(middle, rng_in_cube(r, SPREAD));
    pieces[i] = bezier(j.points[i], j.degree + 1);
    ends[i + 1] = (double)(i + 1);
  }
  const cprox_curve_description d = describe_piecewise((const cprox_curve *const *)pieces, n, ends, (double)INFINITY);
  assert_int_equal(cprox_curve_create(&d, ws, &j.curve), CPROX_OK);
  for (size_t i = 0; i < n; i++) cprox_curve_free(pieces[i]);
  return j;
}

/* A curve that stays at a point of a piece. */
static cprox_curve *jumping_stay(const jumping_curve *j, size_t piece, double s) {
  const vec3l p = ref_bezier(j->points[piece], j->degree, (long double)s, 0);
  const vec3 y = vec((double)p.x, (double)p.y, (double)p.z), points[2] = {y, y};
  return bezier(points, 2);
}

/* [m] no point of it is farther from the nearest sample. */
static double jumping_step(const jumping_curve *j) {
  return 2.0 * sqrt(3.0) * SPREAD * (double)j->degree / (2 * SAMPLES);
}

typedef enum beside { BESIDE_SOLID, BESIDE_SURFACE, BESIDE_CONVEX, BESIDE_CURVE, BESIDE_MOVER, BESIDE_KINDS } beside;

typedef struct jumping_case {
  beside kind;
  jumping_curve curve, other;
  int carries; /* 0: nothing, 1: a radius, 2: a box */
  test_shape box, convex;
  const cprox_body *body; /* what stands at the pose */
  cprox_pose pose;
} jumping_case;

static cprox_mover mover_along(const jumping_case *c, const cprox_curve *curve) {
  if (c->carries == 2) return cprox_body_along(c->box.body, curve);
  return c->carries == 1 ? cprox_tube_along(curve, TUBE) : cprox_point_along(curve);
}

/* along: where the other one moves, if it does. */
static cprox_obstacle obstacle_of(const jumping_case *c, const cprox_curve *along) {
  if (c->kind == BESIDE_CURVE) return cprox_obstacle_curve(c->other.curve, 0.0);
  if (c->kind == BESIDE_MOVER) return cprox_synchronized(cprox_tube_along(along, OTHER_TUBE));
  return cprox_obstacle_at(c->body, c->pose);
}

/* The distance at a parameter: of what stands there. */
static cprox_result sample(const jumping_case *c, size_t piece, double s) {
  cprox_curve *curve = jumping_stay(&c->curve, piece, s);
  cprox_curve *along = c->kind == BESIDE_MOVER ? jumping_stay(&c->other, piece, s) : NULL;
  cprox_result r;
  if (cprox_distance(mover_along(c, curve), obstacle_of(c, along), NULL, ws, &r) != CPROX_OK)
    fail_msg("%s", cprox_workspace_error(ws));
  cprox_curve_free(curve);
  cprox_curve_free(along);
  return r;
}

/* [least lower, least upper] of all samples. */
static cprox_result least_sample(const jumping_case *c) {
  cprox_result least = {.lower = INFINITY, .upper = INFINITY};
  for (size_t i = 0; i < c->curve.n; i++)
    for (int k = 0; k <= SAMPLES; k++) {
      const cprox_result r = sample(c, i, (double)k / SAMPLES);
      least.lower = fmin(least.lower, r.lower), least.upper = fmin(least.upper, r.upper);
    }
  return least;
}

/* False where the library does not answer: bodies are not carried past meshes. */
static bool check_case(const jumping_case *c, size_t number) {
  const cprox_mover mover = mover_along(c, c->curve.curve);
  const cprox_obstacle obstacle = obstacle_of(c, c->other.curve);
  cprox_result distance, collision, contact;
  if (c->carries == 2 && c->kind <= BESIDE_SURFACE) {
    assert_int_equal(cprox_distance(mover, obstacle, NULL, ws, &distance), CPROX_INVALID);
    return false;
  }
  assert_int_equal(cprox_distance(mover, obstacle, NULL, ws, &distance), CPROX_OK);
  assert_int_equal(cprox_collision(mover, obstacle, NULL, ws, &collision), CPROX_OK);
  assert_int_equal(cprox_time_of_contact(mover, obstacle, NULL, ws, &contact), CPROX_OK);
  const cprox_result least = least_sample(c);
  const double step = jumping_step(&c->curve) + (c->kind == BESIDE_MOVER ? jumping_step(&c->other) : 0.0);
  if (!(distance.lower <= least.upper + 1e-12) || !(distance.upper >= least.lower - step))
    fail_msg("%zu: [%g, %g], samples [%g, %g]", number, distance.lower, distance.upper, least.lower, least.upper);
  if (least.upper == 0.0) {
    assert_int_equal(collision.verdict, CPROX_VERDICT_VIOLATED);
    assert_int_not_equal(contact.verdict, CPROX_VERDICT_CLEAR);
  }
  if (least.lower > step) {
    assert_int_equal(collision.verdict, CPROX_VERDICT_CLEAR);
    assert_int_not_equal(contact.verdict, CPROX_VERDICT_VIOLATED);
  }
  return distance.upper == 0.0;
}

/* Random curves of 2 to 4 pieces anywhere, bare, as tubes and carrying a box, beside a solid torus, a plate, convex
 * bodies, curves that jump, and tubes that jump at the same time (seed 61), against samples of what stands. */
CASE(curves_that_jump_are_measured_on_all_their_pieces) {
  rng r = rng_seed(61);
  test_mesh torus = mesh_torus(20, 12, 1.0, 0.4, 0.0), plate = mesh_plate(3, 1.0);
  cprox_body *solid = mesh_body(&torus, CPROX_MESH_FILL_SOLID, ws);
  cprox_body *surface = mesh_body(&plate, CPROX_MESH_FILL_SURFACE, ws);
  size_t contacts[BESIDE_KINDS] = {0};
  for (size_t i = 0; i < test_cases(600); i++) {
    jumping_case c = {.kind = (beside)rng_index(&r, BESIDE_KINDS), .carries = (int)rng_index(&r, 3)};
    shape_make(&r, TEST_BOUNDED[rng_index(&r, TEST_N_BOUNDED)], 0.8, 4.0, &c.convex);
    shape_make(&r, CPROX_BODY_BOX, 0.2, 3.0, &c.box);
    c.body = c.kind == BESIDE_SOLID ? solid : (c.kind == BESIDE_SURFACE ? surface : c.convex.body);
    c.pose = rng_pose(&r, 1.0);
    const size_t n = 2 + rng_index(&r, MOST_PIECES - 1);
    const double half = c.kind >= BESIDE_CURVE ? 0.4 : 2.0;
    c.curve = jumping_make(&r, n, half), c.other = jumping_make(&r, n, half);
    contacts[c.kind] += check_case(&c, i);
    cprox_curve_free(c.curve.curve), cprox_curve_free(c.other.curve);
    cprox_body_free(c.convex.body), cprox_body_free(c.box.body);
  }
  for (int k = 0; k < BESIDE_KINDS; k++) assert_true(contacts[k] > 0);
  cprox_body_free(solid);
  cprox_body_free(surface);
  mesh_free(&torus);
  mesh_free(&plate);
}

int main(void) {
  return cases_run(workspace_setup, workspace_teardown);
}
