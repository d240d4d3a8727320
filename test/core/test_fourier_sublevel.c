/* SPDX-License-Identifier: BSD-3-Clause */
/* Solids made of functions and of convex bodies: sublevel sets and regions. A certified "clear" is never wrong, held
 * against exact distances; lying functions are refused. */
#include <string.h>

#include "fourier/gap.h"
#include "support/builders.h"
#include "support/cases.h"
#include "support/random.h"
#include "support/solids.h"

#define MADE(call) \
  if ((call) != CPROX_OK) fail_msg("%s", cprox_workspace_error(ws))

/* ---- functions ---- */

/* A superquadric: its gauge less 1, which grows by at most 1/min a, as exponents are 2 at least. */
typedef struct superquadric {
  double a[3], n;
} superquadric;

static double gauge(void *user, cprox_vec3 p) {
  const superquadric *s = user;
  const double x = pow(fabs(p.x / s->a[0]), s->n), y = pow(fabs(p.y / s->a[1]), s->n);
  return pow(x + y + pow(fabs(p.z / s->a[2]), s->n), 1.0 / s->n) - 1.0;
}

/* A torus about z by its distance. */
typedef struct torus {
  double across, radius;
} torus;

static double torus_distance(void *user, cprox_vec3 p) {
  const torus *t = user;
  return hypot(hypot(p.x, p.y) - t->across, p.z) - t->radius;
}

static double not_a_number(void *user, cprox_vec3 p) {
  return p.x > 0.0 ? NAN : *(const double *)user;
}

static double steep(void *user, cprox_vec3 p) {
  return *(const double *)user * p.x;
}

static cprox_solid_description sublevel(int dimension, double half, uint32_t cells) {
  return (cprox_solid_description){.kind = CPROX_SOLID_SUBLEVEL,
                                   .dimension = dimension,
                                   .lowest = {-half, -half, dimension == 2 ? 0.0 : -half},
                                   .cell = 2.0 * half / cells,
                                   .counts = {cells, cells, dimension == 2 ? 1 : cells}};
}

static cprox_solid *make(const cprox_solid_description *d) {
  cprox_solid *solid = NULL;
  MADE(cprox_solid_create(d, ws, &solid));
  return solid;
}

static cprox_solid *make_ball(int dimension, double radius) {
  return make(&(cprox_solid_description){.kind = CPROX_SOLID_BALL, .dimension = dimension, .radius = radius});
}

/* ---- verdicts ---- */

typedef struct counts {
  size_t clear, deep;
} counts;

static cprox_gap *make_gap(const cprox_solid *a, const cprox_solid *b, uint32_t samples) {
  cprox_gap_options o = CPROX_GAP_OPTIONS_DEFAULT;
  o.samples = samples;
  cprox_gap *gap = NULL;
  MADE(cprox_gap_create(a, b, &o, ws, &gap));
  return gap;
}

/* Asks at a pose whose signed distance is known. */
static bool is_clear(const cprox_gap *gap, const cprox_pose *a, const cprox_pose *b, double distance, counts *seen) {
  cprox_gap_result x;
  MADE(cprox_gap_test(gap, a, b, ws, &x));
  const bool clear = x.verdict == CPROX_GAP_VERDICT_CLEAR || x.verdict == CPROX_GAP_VERDICT_FAR;
  if (clear && distance < -1e-9) fail_msg("clear at an overlap of %g, value %g", -distance, x.value);
  seen->clear += clear, seen->deep += distance < -1e-9;
  return clear;
}

static double pair_distance(const cprox_body *a, const cprox_pose *pa, const cprox_body *b, const cprox_pose *pb) {
  cprox_options o = CPROX_OPTIONS_DEFAULT;
  o.signed_distance = true;
  cprox_result r;
  if (cprox_pair(cprox_obstacle_at(a, *pa), cprox_obstacle_at(b, *pb), &o, ws, &r) < CPROX_OK)
    fail_msg("%s", cprox_workspace_error(ws));
  return r.upper;
}

/* Seed 761: superquadrics of exponents 2 to 8, once by their function and once as the region of a box round them,
 * against boxes: along lines, halving to where the verdict changes. */
CASE(superquadrics_by_function_and_as_region_are_never_clear_in_an_overlap) {
  rng r = rng_seed(761);
  counts seen = {0, 0};
  for (size_t i = 0; i < test_cases(2); i++) {
    superquadric s = {{rng_uniform(&r, 0.3, 1.0), rng_uniform(&r, 0.3, 1.0), rng_uniform(&r, 0.3, 1.0)},
                      rng_uniform(&r, 2.0, 8.0)};
    const cprox_vec3 axes = {s.a[0], s.a[1], s.a[2]}, exponents = {s.n, s.n, s.n};
    const cprox_vec3 edges = {rng_uniform(&r, 0.3, 1.2), rng_uniform(&r, 0.3, 1.2), rng_uniform(&r, 0.3, 1.2)};
    cprox_body *body, *box;
    MADE(cprox_body_create_superquadric(axes, exponents, ws, &body));
    MADE(cprox_body_create_box(edges, ws, &box));
    cprox_solid_description by_function = sublevel(3, 1.05, 16);
    by_function.function = gauge, by_function.user = &s;
    by_function.lipschitz = 1.0 / fmin(s.a[0], fmin(s.a[1], s.a[2]));
    const cprox_solid_description whole = {.kind = CPROX_SOLID_BOX, .dimension = 3, .size = {2, 2, 2}};
    cprox_solid *round = make(&whole);
    cprox_solid *solids[2] = {make(&by_function), make(&(cprox_solid_description){
                                                      .kind = CPROX_SOLID_CLIPPED, .solid = round, .body = body})};
    cprox_solid *other = make(&(cprox_solid_description){.kind = CPROX_SOLID_BOX, .dimension = 3, .size = edges});
    for (int k = 0; k < 2; k++) {
      cprox_gap *gap = make_gap(solids[k], other, 9);
      for (size_t line = 0; line < 12; line++) {
        const cprox_pose a = rng_pose(&r, 1.0);
        cprox_pose b = rng_pose(&r, 1.0);
        const vec3 way = rng_unit(&r);
        double near = 0.0, far = 4.0;
        for (int step = 0; step < 12; step++) {
          const double at = step == 0 ? near : 0.5 * (near + far);
          b.position = vec_axpy(a.position, at, way);
          *(is_clear(gap, &a, &b, pair_distance(body, &a, box, &b), &seen) ? &far : &near) = at;
        }
      }
      cprox_gap_free(gap);
      cprox_solid_free(solids[k]);
    }
    cprox_solid_free(other);
    cprox_solid_free(round);
    cprox_body_free(body);
    cprox_body_free(box);
  }
  print_message("%zu clear, %zu overlapping\n", seen.clear, seen.deep);
  assert_true(seen.clear > 50 && seen.deep > 20);
}

/* Seed 762: balls about a torus, in its hole, and along its surface, where a ball touches it within 1e-6. */
CASE(a_torus_by_its_function_is_never_clear_in_an_overlap) {
  rng r = rng_seed(762);
  torus t = {0.7, 0.2};
  cprox_solid_description d = sublevel(3, 0.95, 24);
  d.function = torus_distance, d.user = &t, d.lipschitz = 1.0;
  cprox_solid *ring = make(&d), *ball = make_ball(3, 0.15);
  cprox_gap *gap = make_gap(ring, ball, 17);
  counts seen = {0, 0};
  for (size_t i = 0; i < test_cases(400); i++) {
    vec3 at = rng_in_cube(&r, 1.3);
    if (i % 2) { /* on the surface */
      const double u = rng_uniform(&r, 0, 6.2831853), v = rng_uniform(&r, 0, 6.2831853);
      const double off = 0.35 + rng_uniform(&r, -1e-6, 1e-6), across = 0.7 + off * cos(v);
      at = vec(across * cos(u), across * sin(u), off * sin(v));
    }
    const cprox_pose a = CPROX_POSE_IDENTITY, b = {.position = at, .orientation = rng_quat(&r)};
    is_clear(gap, &a, &b, torus_distance(&t, at) - 0.15, &seen);
  }
  print_message("%zu clear, %zu overlapping\n", seen.clear, seen.deep);
  assert_true(seen.clear > 20 && seen.deep > 50);
  cprox_gap_free(gap);
  cprox_solid_free(ring);
  cprox_solid_free(ball);
}

/* Seed 763: a plate clipped by an ellipsoid, in the plane and in space: where a ball reaches a point of both, it is
 * never called clear. Far outside of the region it is, within the plate. */
CASE(a_product_with_an_ellipsoid_holds_what_is_in_both) {
  rng r = rng_seed(763);
  for (int dimension = 2; dimension <= 3; dimension++) {
    const cprox_vec3 size = {3.0, 0.6, 0.4}, axes = {0.5, 0.7, 0.3};
    cprox_body *ellipsoid;
    MADE(cprox_body_create_ellipsoid(axes, ws, &ellipsoid));
    cprox_solid *plate =
        make(&(cprox_solid_description){.kind = CPROX_SOLID_BOX, .dimension = dimension, .size = size});
    cprox_solid *product =
        make(&(cprox_solid_description){.kind = CPROX_SOLID_CLIPPED, .solid = plate, .body = ellipsoid});
    assert_true(cprox_solid_get_info(product).radius < 1.0);
    cprox_solid *ball = make_ball(dimension, 0.2);
    cprox_gap *gap = make_gap(product, ball, dimension == 2 ? 17 : 9);
    counts seen = {0, 0};
    const cprox_pose a = CPROX_POSE_IDENTITY;
    cprox_pose b = CPROX_POSE_IDENTITY;
    for (size_t i = 0; i < test_cases(400); i++) {
      vec3 p = rng_in_cube(&r, 1.0), way = rng_unit(&r);
      p = vec(axes.x * p.x, axes.y * p.y, axes.z * p.z);
      if (dimension == 2) p.z = way.z = 0.0, way = vec_scale(1.0 / vec_norm(way), way);
      const vec3 scaled = vec(p.x / axes.x, p.y / axes.y, p.z / axes.z);
      if (fabs(p.y) > 0.3 || fabs(p.z) > 0.2 || vec_norm(scaled) > 1.0) continue;
      b.position = vec_axpy(p, rng_uniform(&r, 0.0, 0.2 - 1e-6), way);
      is_clear(gap, &a, &b, -1e-6, &seen);
    }
    b.position = vec(1.4, 0, 0);
    assert_true(is_clear(gap, &a, &b, 1.0, &seen));
    assert_true(seen.deep > 50);
    cprox_gap_free(gap);
    cprox_solid_free(product);
    cprox_solid_free(plate);
    cprox_solid_free(ball);
    cprox_body_free(ellipsoid);
  }
}

static void refuse(const cprox_solid_description *d, const char *why) {
  cprox_solid *solid = NULL;
  assert_int_equal(cprox_solid_create(d, ws, &solid), CPROX_INVALID);
  if (!strstr(cprox_workspace_error(ws), why)) fail_msg("'%s' is not in '%s'", why, cprox_workspace_error(ws));
  assert_null(solid);
}

CASE(functions_that_lie_and_regions_without_bounds_are_refused) {
  double two = 2.0;
  cprox_solid_description d = sublevel(2, 1.0, 10);
  refuse(&d, "function is NULL");
  d.function = steep, d.user = &two;
  refuse(&d, "lipschitz is 0");
  d.lipschitz = 1.9;
  refuse(&d, "contradicts lipschitz = 1.9");
  d.lipschitz = 2.0;
  cprox_solid_free(make(&d));
  d.function = not_a_number;
  refuse(&d, "the function is nan at");
  d.counts[0] = 5; /* there it is 2 everywhere, and no cell may meet the set */
  refuse(&d, "no cell");
  d.counts[2] = 2;
  refuse(&d, "the last 1 in the plane");

  cprox_body *half;
  MADE(cprox_body_create_halfspace((cprox_vec3){0, 0, 1}, 0.0, ws, &half));
  cprox_solid *box = make(&(cprox_solid_description){.kind = CPROX_SOLID_BOX, .dimension = 3, .size = {1, 1, 1}});
  cprox_solid_description clipped = {.kind = CPROX_SOLID_CLIPPED, .solid = box, .body = half};
  refuse(&clipped, "is not bounded");
  clipped.body = NULL;
  refuse(&clipped, "no half-space");
  cprox_solid_free(box);
  cprox_body_free(half);
}

int main(void) {
  return cases_run(workspace_setup, workspace_teardown);
}
