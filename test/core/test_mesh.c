/* SPDX-License-Identifier: BSD-3-Clause */
/* Curves against meshes: sound, as narrow as asked, whatever the triangles look like. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <stdio.h>
#include <string.h>

#include "body/body.h"
#include "curve_proximity/cprox.h"
#include "support/counting.h"
#include "support/meshes.h"
#include "tree/kernels.h"

static cprox_workspace *ws;

static int setup(void **state) {
  (void)state;
  ws = cprox_workspace_create();
  return ws ? 0 : 1;
}

static int teardown(void **state) {
  (void)state;
  cprox_workspace_free(ws);
  return 0;
}

/* ---- builders --------------------------------------------------------------------------------------------------------- */

typedef struct test_bezier {
  size_t degree;
  vec3 points[12];
  cprox_curve *curve;
} test_bezier;

static test_bezier bezier_make(const vec3 *points, size_t degree) {
  test_bezier b = {.degree = degree};
  memcpy(b.points, points, (degree + 1) * sizeof *points);
  if (cprox_curve_create_bezier(b.points, degree + 1, 0.0, 1.0, ws, &b.curve) != CPROX_OK)
    fail_msg("%s", cprox_workspace_reason(ws));
  return b;
}

static cprox_options accurate(double epsilon) {
  cprox_options options = cprox_options_default();
  options.epsilon = epsilon;
  return options;
}

/* Of the curve's point at t from the posed mesh, exactly but for long double. */
static long double distance_at(const test_bezier *b, const test_mesh *mesh, const cprox_pose *pose, long double t) {
  return mesh_distance(mesh, ref_to_local(pose, ref_bezier(b->points, b->degree, t, 0)));
}

/* The least distance near t: the best of a few steps of golden section. */
static long double least_near(const test_bezier *b, const test_mesh *mesh, const cprox_pose *pose, long double t,
                              long double h) {
  long double low = fmaxl(t - h, 0.0L), high = fminl(t + h, 1.0L), least = distance_at(b, mesh, pose, t);
  for (int i = 0; i < 24; i++) {
    const long double p = low + 0.381966L * (high - low), q = low + 0.618034L * (high - low);
    const long double dp = distance_at(b, mesh, pose, p), dq = distance_at(b, mesh, pose, q);
    least = fminl(least, fminl(dp, dq));
    if (dp < dq)
      high = q;
    else
      low = p;
  }
  return least;
}

/* ---- distance --------------------------------------------------------------------------------------------------------- */

/* 2,000 random queries (seed 51; CPROX_TEST_SCALE=50 asks 100,000) against soups with needles, points and repeated triangles, and
 * closed tori, at any pose and padding, offsets up to 1e6 m of pose and curve together. epsilon is 1e-12 at unit scale, where double
 * allows it. Wanted: lower <= the true distance anywhere on the curve, the true distance at t <= upper. No tolerance: rounding is the
 * interval's own affair; the reference's, some 40 roundings of 2^-64 of the sizes, is given away. */
static void distance_holds_everywhere_and_at_its_witness(void **state) {
  (void)state;
  rng r = rng_seed(51);
  const cprox_options options = accurate(1e-12);
  size_t unconverged = 0;
  const size_t cases = test_cases(2000);
  for (size_t i = 0; i < cases; i++) {
    const size_t m = 1 + rng_index(&r, 60);
    test_mesh mesh = i % 2 ? mesh_soup(&r, m, 1.0, rng_log_uniform(&r, 1e-2, 1.0))
                           : mesh_torus(4 + rng_index(&r, 5), 3 + rng_index(&r, 4), 1.0, 0.3, 0.2);
    cprox_body *body = mesh_body(&mesh, CPROX_MESH_SURFACE, ws);
    cprox_pose pose = i % 3 ? rng_pose(&r, 1.0) : cprox_pose_identity();
    vec3 points[12];
    const size_t degree = 1 + rng_index(&r, 8);
    for (size_t k = 0; k <= degree; k++) points[k] = rng_in_cube(&r, i % 5 ? 1.5 : 4.0);
    if (i % 7 == 0) {
      const vec3 offset = rng_in_cube(&r, 1e6);
      pose.position = vec_add(pose.position, offset);
      for (size_t k = 0; k <= degree; k++) points[k] = vec_add(points[k], offset);
    }
    const test_bezier b = bezier_make(points, degree);
    const double radius = i % 4 ? 0.0 : rng_uniform(&r, 0.0, 0.3), padding = i % 6 ? 0.0 : 0.1;
    cprox_result result;
    const cprox_status status = cprox_distance(cprox_tube_along(b.curve, radius),
                                               cprox_padded(cprox_at(body, pose), padding), &options, ws, &result);
    if (status < 0) fail_msg("case %zu: %s", i, cprox_workspace_reason(ws));
    if (status != CPROX_OK) unconverged++;
    if (status == CPROX_OK && result.upper - result.lower > 1e-12) fail_msg("case %zu: too wide", i);

    const long double grown = (long double)radius + (long double)padding, give = i % 7 ? 1e-17L : 2e-12L;
    const long double at = fmaxl(distance_at(&b, &mesh, &pose, result.t) - grown, 0.0L);
    if (at > result.upper + give) fail_msg("case %zu: %Lg at t, above upper %g", i, at, result.upper);
    long double least = fmaxl(least_near(&b, &mesh, &pose, result.t, 1e-3L) - grown, 0.0L);
    for (int k = 0; k <= 8; k++)
      least = fminl(least, fmaxl(distance_at(&b, &mesh, &pose, (long double)rng_uniform(&r, 0.0, 1.0)) - grown, 0.0L));
    if (least < result.lower - give) fail_msg("case %zu: %Lg somewhere, below lower %g", i, least, result.lower);
    cprox_curve_free(b.curve);
    cprox_body_free(body);
    mesh_free(&mesh);
  }
  /* at unit scale 1e-12 is in reach; at 1e6 m the curve's own rounding is 1e-10, and needles cost more */
  if (unconverged > cases / 4) fail_msg("%zu of %zu did not converge", unconverged, cases);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(distance_holds_everywhere_and_at_its_witness),
  };
  return cmocka_run_group_tests(tests, setup, teardown);
}
