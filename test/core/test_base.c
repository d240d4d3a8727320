/* SPDX-License-Identifier: BSD-3-Clause */
/* Statuses, the workspace and poses. u = 2^-53; exact answers in long double, 2000 times finer than every bound here.
 */
#include <stdio.h>
#include <string.h>

#include "base/frame.h"
#include "base/workspace.h"
#include "support/cases.h"
#include "support/counting.h"
#include "support/random.h"
#include "support/reference.h"

#define U 0x1p-53

/* ---- statuses ---- */

CASE(every_status_has_its_own_name_and_a_message) {
#define STATUS(code, value, name, message)            \
  assert_int_equal(code, value);                      \
  assert_string_equal(cprox_status_name(code), name); \
  assert_string_equal(cprox_status_text(code), message);
  CPROX_STATUS_LIST(STATUS)
#undef STATUS
#define NAME(code, value, name, message) name,
  const char *const names[] = {CPROX_STATUS_LIST(NAME)};
#undef NAME
  const size_t n = sizeof names / sizeof names[0];
  for (size_t i = 0; i < n; i++)
    for (size_t k = 0; k < i; k++) assert_string_not_equal(names[i], names[k]);
  assert_string_equal(cprox_status_name((cprox_status)99), "unknown");
  assert_string_equal(cprox_status_text((cprox_status)-99), "unknown status");
}

/* ---- version ---- */

/* PROJECT_VERSION is CMake's; package.xml has its own. */
CASE(the_version_is_that_of_the_project) {
  assert_string_equal(cprox_version(), PROJECT_VERSION);
  FILE *package = fopen(PACKAGE_XML, "r");
  assert_non_null(package);
  char line[256];
  bool same = false;
  while (fgets(line, sizeof line, package)) same = same || strstr(line, "<version>" PROJECT_VERSION "</version>");
  fclose(package);
  assert_true(same);
}

/* ---- workspace ---- */

CASE(a_workspace_grows_and_keeps_what_it_holds) {
  const size_t live = allocations_live();
  cprox_workspace *w = cprox_workspace_create();
  assert_non_null(w);
  for (int b = 0; b < WORKSPACE_BUFFERS; b++) {
    unsigned char *memory = workspace_reserve(w, (workspace_buffer)b, 100);
    assert_non_null(memory);
    memset(memory, b + 1, 100);
  }
  for (int b = 0; b < WORKSPACE_BUFFERS; b++) {
    const unsigned char *memory = workspace_reserve(w, (workspace_buffer)b, 1000);
    for (size_t i = 0; i < 100; i++) assert_int_equal(memory[i], b + 1);
  }

  /* what is large enough is handed out again; a small buffer is as large as asked; a large one that needs a little more
   * grows by half, so that growth costs little in sum */
  const size_t made = allocations_made(), held = cprox_workspace_bytes(w);
  assert_ptr_equal(workspace_reserve(w, WORKSPACE_NODES, 1000), workspace_reserve(w, WORKSPACE_NODES, 1));
  assert_int_equal(allocations_made(), made);
  workspace_reserve(w, WORKSPACE_NODES, 1001);
  assert_int_equal(cprox_workspace_bytes(w), held + 1);
  workspace_reserve(w, WORKSPACE_NODES, 10000);
  workspace_reserve(w, WORKSPACE_NODES, 10001);
  workspace_reserve(w, WORKSPACE_NODES, 15000);
  assert_int_equal(allocations_made(), made + 3);
  cprox_workspace_free(w);
  cprox_workspace_free(NULL);
  assert_int_equal(allocations_live(), live);
}

CASE(a_workspace_survives_memory_that_is_out) {
  const size_t live = allocations_live();
  allocations_fail_after(0);
  cprox_workspace *none = cprox_workspace_create();
  allocations_allow();
  assert_null(none);

  cprox_workspace *w = cprox_workspace_create();
  char *memory = workspace_reserve(w, WORKSPACE_POINTS, 8);
  memcpy(memory, "as it was", 8);
  allocations_fail_after(0);
  void *more = workspace_reserve(w, WORKSPACE_POINTS, 1 << 20);
  allocations_allow();
  assert_null(more);
  assert_memory_equal(workspace_reserve(w, WORKSPACE_POINTS, 8), "as it was", 8);
  assert_non_null(workspace_reserve(w, WORKSPACE_POINTS, 1 << 20));
  cprox_workspace_free(w);
  assert_int_equal(allocations_live(), live);
}

CASE(the_reason_is_kept_until_the_next_call) {
  cprox_workspace *w = cprox_workspace_create();
  assert_string_equal(cprox_workspace_error(w), "");
  assert_int_equal(workspace_fail(w, CPROX_INVALID, "knot %d is %g", 7, 0.3), CPROX_INVALID);
  assert_string_equal(cprox_workspace_error(w), "knot 7 is 0.3");

  /* a reason that is too long is cut, not overrun */
  char longer[1000];
  memset(longer, 'x', sizeof longer - 1);
  longer[sizeof longer - 1] = '\0';
  workspace_fail(w, CPROX_INVALID, "%s", longer);
  const size_t length = strlen(cprox_workspace_error(w));
  assert_true(length > 100 && length < 1000);
  workspace_clear(w);
  assert_string_equal(cprox_workspace_error(w), "");

  /* none is allowed */
  assert_int_equal(workspace_fail(NULL, CPROX_MEMORY, "lost"), CPROX_MEMORY);
  workspace_clear(NULL);
  assert_string_equal(cprox_workspace_error(NULL), "");
  cprox_workspace_free(w);
}

/* ---- poses ---- */

CASE(poses_that_are_no_rotation_are_named) {
  cprox_pose pose = CPROX_POSE_IDENTITY;
  assert_null(frame_pose_error(&pose));
  pose.position.y = NAN;
  assert_string_equal(frame_pose_error(&pose), "the position is not finite");
  pose = CPROX_POSE_IDENTITY;
  pose.orientation.z = INFINITY;
  assert_string_equal(frame_pose_error(&pose), "the quaternion is not finite");
  pose.orientation = (cprox_quat){0, 0, 0, 0};
  assert_string_equal(frame_pose_error(&pose), "the quaternion's norm is 0");
  pose.orientation = (cprox_quat){1e-170, 0, 0, 0};
  assert_string_equal(frame_pose_error(&pose), "the quaternion's norm is 0");
  pose.orientation = (cprox_quat){1e-120, 0, 0, 0};
  assert_string_equal(frame_pose_error(&pose), "the quaternion's norm is out of range");
  pose.orientation = (cprox_quat){0, 1e155, 1e155, 0};
  assert_string_equal(frame_pose_error(&pose), "the quaternion's norm is out of range");
}

/* A quaternion of any norm and any sparsity, a position up to 1e6 m away. */
static cprox_pose awkward_pose(rng *r) {
  cprox_pose pose = rng_pose(r, rng_index(r, 4) ? rng_log_uniform(r, 1e-3, 1e6) : 0.0);
  cprox_quat *q = &pose.orientation;
  const size_t kind = rng_index(r, 7);
  const double norm = rng_index(r, 2) ? 1.0 : rng_log_uniform(r, 1e-90, 1e90);
  if (kind == 0) *q = (cprox_quat){rng_awkward(r, 1), rng_awkward(r, 1), rng_awkward(r, 1), rng_awkward(r, 1)};
  if (kind == 1) q->x = q->y = 0.0;
  if (kind == 2) q->w *= 1e-9;
  if (kind == 3) q->x *= 1e-9, q->y *= 1e-12, q->z *= 1e-6;
  if (kind == 4) *q = (cprox_quat){-1, 0, 0, 0};
  if (q->w == 0.0 && q->x == 0.0 && q->y == 0.0 && q->z == 0.0) q->w = 1.0;
  *q = (cprox_quat){norm * q->w, norm * q->x, norm * q->y, norm * q->z};
  return pose;
}

/* seed 401, 200,000 poses and points, half of the points near the pose's position: the error that is reported is an
 * upper bound (T3 and T7), and not padded: some cases come within 1/20 of it. */
CASE(the_error_of_local_coordinates_is_never_understated) {
  rng r = rng_seed(401);
  double largest = 0.0;
  for (size_t i = test_cases(200000); i-- > 0;) {
    const cprox_pose pose = awkward_pose(&r);
    const vec3 centre = rng_in_cube(&r, rng_index(&r, 2) ? rng_log_uniform(&r, 1e-6, 1e3) : 0.0);
    const double reach = rng_log_uniform(&r, 1e-6, 1e6);
    vec3 world = rng_in_cube(&r, reach);
    if (rng_index(&r, 2)) world = vec_add(world, pose.position);
    if (rng_index(&r, 8) == 0) world = vec(rng_awkward(&r, reach), rng_awkward(&r, reach), rng_awkward(&r, reach));

    const frame f = frame_create(&pose, centre);
    double bound = 0.0;
    const vec3 local = frame_to_local(&f, world, &bound);
    const vec3l exact = ref_sub(ref_to_local(&pose, ref_vec(world)), ref_vec(centre));
    const double size = vec_norm(vec_sub(world, pose.position));
    const double error = (double)ref_error(exact, local);
    assert_true(error <= bound + 16.0 * 0x1p-64 * (size + vec_norm(centre))); /* the reference's own rounding */
    if (bound > 0.0) largest = fmax(largest, error / bound);

    /* at 1e6 m the error is that of the difference: 28 sizes of what is left, and the centre's */
    assert_true(bound <= 1.001 * U * (28.0 * size + size + vec_norm(centre)));

    /* an error that is larger already stays */
    double kept = 1.0 + bound;
    frame_to_local(&f, world, &kept);
    assert_true(kept == 1.0 + bound);
  }
  print_message("largest error of local coordinates: %.2f of its bound\n", largest);
  assert_true(largest > 0.05);
}

/* seed 402, 100,000 round trips: the error of the way there, 27 u of the local size and u of the world's for the way
 * back */
CASE(world_coordinates_come_back) {
  rng r = rng_seed(402);
  for (size_t i = test_cases(100000); i-- > 0;) {
    const cprox_pose pose = awkward_pose(&r);
    const vec3 centre = rng_in_cube(&r, 1.0), world = vec_add(rng_in_cube(&r, 10.0), pose.position);
    const frame f = frame_create(&pose, centre);
    double bound = 0.0;
    const vec3 local = frame_to_local(&f, world, &bound), back = frame_to_world(&f, local);
    const double there = vec_norm(vec_add(local, centre));
    assert_true(vec_norm(vec_sub(back, world)) <= bound + 1.001 * U * (28.0 * there + 2.0 * vec_norm(world)));
    const vec3l exact = ref_to_world(&pose, ref_add(ref_vec(local), ref_vec(centre)));
    assert_true(ref_error(exact, back) <= 1.001 * U * (27.0 * there + vec_norm(back)));
  }
}

/* seed 403, 100,000 directions: 26 u of their length, both ways; the worst comes within 1/10 of it */
CASE(directions_turn_within_their_bound) {
  rng r = rng_seed(403);
  double largest = 0.0;
  for (size_t i = test_cases(100000); i-- > 0;) {
    cprox_pose pose = awkward_pose(&r);
    const frame f = frame_create(&pose, vec(0, 0, 0));
    const vec3 d = rng_unit(&r);
    pose.position = vec(0, 0, 0);
    const double there = (double)ref_error(ref_to_local(&pose, ref_vec(d)), frame_turn_to_local(&f, d));
    const double back = (double)ref_error(ref_to_world(&pose, ref_vec(d)), frame_turn_to_world(&f, d));
    assert_true(fmax(there, back) <= 26.001 * U);
    largest = fmax(largest, fmax(there, back) / (26.0 * U));
  }
  print_message("largest error of a turned direction: %.2f of its bound\n", largest);
  assert_true(largest > 0.1);
}

/* seed 404: no rotation and rotations about z are told exactly, so that planar problems stay planar */
CASE(planar_poses_stay_planar) {
  rng r = rng_seed(404);
  for (size_t i = test_cases(10000); i-- > 0;) {
    cprox_pose pose = rng_pose(&r, 10.0);
    pose.position.z = 0.0;
    const vec3 p = vec(rng_uniform(&r, -5, 5), rng_uniform(&r, -5, 5), rng_index(&r, 2) ? 0.0 : 0.1);
    frame f = frame_create(&pose, vec(0, 0, 0));
    assert_true(f.rotated && !f.about_z);
    pose.orientation.x = 0.0;
    assert_false(frame_create(&pose, vec(0, 0, 0)).about_z);
    pose.orientation.y = 0.0;
    f = frame_create(&pose, vec(0, 0, 0));
    assert_true(f.rotated && f.about_z);
    double bound = 0.0;
    assert_true(frame_to_local(&f, p, &bound).z == p.z);
    assert_true(frame_to_world(&f, p).z == p.z);
    pose.orientation.z = 0.0;
    f = frame_create(&pose, vec(0, 0, 0));
    assert_true(!f.rotated && f.about_z);
    assert_true(vec_equal(frame_turn_to_world(&f, p), p) && vec_equal(frame_turn_to_local(&f, p), p));
  }
}

static void scale_quaternion(cprox_quat *q, double norm) {
  q->w *= norm, q->x *= norm, q->y *= norm, q->z *= norm;
}

/* seed 405, 100,000 pairs of poses, quaternions of any norm: one after the other is their composition. 64 u of all
 * sizes covers two turns of 26 u and the rounding of the product of the quaternions. */
CASE(composition_applies_the_inner_pose_first) {
  rng r = rng_seed(405);
  for (size_t i = test_cases(100000); i-- > 0;) {
    cprox_pose outer = rng_pose(&r, rng_log_uniform(&r, 1e-2, 1e3)),
               inner = rng_pose(&r, rng_log_uniform(&r, 1e-2, 1e3));
    scale_quaternion(&outer.orientation, rng_log_uniform(&r, 1e-99, 1e99));
    scale_quaternion(&inner.orientation, rng_log_uniform(&r, 1e-99, 1e99));
    const vec3 p = rng_in_cube(&r, 10.0);
    const cprox_pose both = frame_compose(&outer, &inner);
    const vec3l exact = ref_to_world(&outer, ref_to_world(&inner, ref_vec(p)));
    const frame f = frame_create(&both, vec(0, 0, 0));
    const double sizes = vec_norm(p) + vec_norm(inner.position) + vec_norm(outer.position);
    assert_true(ref_error(exact, frame_to_world(&f, p)) <= 64.0 * U * sizes);
  }
}

int main(void) {
  return cases_run(NULL, NULL);
}
