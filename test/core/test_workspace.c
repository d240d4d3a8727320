/* SPDX-License-Identifier: BSD-3-Clause */
/* A workspace has one user at a time: what a query calls gets an error, and the query does not notice. */
#include <math.h>
#include <string.h>

#include "curve_proximity/cprox.h"
#include "curve_proximity/cprox_fourier.h"
#include "support/builders.h"
#include "support/cases.h"
#include "support/make_curve.h"

/* ---- what is asked from inside ---- */

typedef struct inner {
  cprox_workspace *asked; /* NULL: nothing is asked */
  const cprox_curve *curve;
  cprox_obstacle ball;
  size_t calls, refused;
} inner;

/* Everything that takes a workspace: each is refused, or each is answered. */
static void ask_inside(inner *in) {
  if (!in->asked) return;
  in->calls++;
  cprox_workspace *w = in->asked;
  cprox_result r;
  cprox_body *body = NULL;
  cprox_curve *curve = NULL;
  cprox_vec3 at;
  const cprox_vec3 ends[2] = {vec(0, 0, 0), vec(1, 0, 0)};
  const cprox_status status[] = {
      cprox_distance(cprox_point_along(in->curve), in->ball, NULL, w, &r),
      cprox_tolerance(cprox_point_along(in->curve), in->ball, 0.1, NULL, w, &r),
      cprox_time_of_contact(cprox_point_along(in->curve), in->ball, NULL, w, &r),
      cprox_pair(in->ball, in->ball, NULL, w, &r),
      cprox_curve_evaluate(in->curve, 0.5, w, &at, NULL, NULL),
      curve_from(describe_bezier(ends, 2, 0.0, 1.0), w, &curve),
      cprox_body_create_sphere(1.0, w, &body),
  };
  const size_t n = sizeof status / sizeof *status;
  size_t refused = 0;
  for (size_t i = 0; i < n; i++) refused += status[i] == CPROX_INVALID;
  assert_true(refused == 0 || refused == n);
  if (refused == n) assert_non_null(strstr(cprox_workspace_error(w), "the workspace is in use"));
  if (refused == n) in->refused++;
  cprox_curve_free(curve);
  cprox_body_free(body);
}

static bool stop_and_ask(void *user) {
  ask_inside(user);
  return false;
}

static double distance_and_ask(const void *shape, const double p[3]) {
  inner *in = (inner *)(uintptr_t)shape;
  ask_inside(in);
  return sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]) - 0.25;
}

static void support_and_ask(const void *shape, const double d[3], double point[3]) {
  inner *in = (inner *)(uintptr_t)shape;
  ask_inside(in);
  const double length = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
  for (int k = 0; k < 3; k++) point[k] = 0.25 * d[k] / length;
}

static double convex_and_ask(const void *user, const double p[3], double gradient[3], double hessian[6]) {
  inner *in = (inner *)(uintptr_t)user;
  ask_inside(in);
  static const double TWICE[6] = {2, 0, 0, 2, 0, 2};
  memcpy(hessian, TWICE, sizeof TWICE);
  for (int k = 0; k < 3; k++) gradient[k] = 2.0 * p[k];
  return p[0] * p[0] + p[1] * p[1] + p[2] * p[2] - 0.0625;
}

/* ---- queries round it ---- */

enum { STOP, DISTANCE, SUPPORT, CONVEX, CALLBACKS };

static cprox_status make(int callback, inner *in, cprox_workspace *w, cprox_body **body) {
  const cprox_convex_function function = {
      .evaluate = convex_and_ask, .user = in, .interior = vec(0.01, 0, 0), .radius = 0.5};
  switch (callback) {
    case DISTANCE: return cprox_body_create_distance(distance_and_ask, in, vec(0, 0, 0), 0.5, 1.0, 1e-9, w, body);
    case SUPPORT: return cprox_body_create_support(support_and_ask, in, vec(0, 0, 0), 0.25, 1e-12, 0.0, w, body);
    case CONVEX: return cprox_body_create_convex_function(&function, 0.0, w, body);
    default: return cprox_body_create_sphere(0.25, w, body);
  }
}

/* Each callback of a query asks on the query's own workspace and is refused, and asks on another one and is answered;
 * the query's answer has the same bits as without a question. */
CASE(what_a_query_calls_is_refused_its_workspace_and_changes_nothing) {
  cprox_workspace *other = cprox_workspace_create();
  const vec3 control[4] = {vec(-1, 0.4, 0), vec(-0.3, 0.5, 0.6), vec(0.5, 0.2, -0.7), vec(1, 0.6, 0.1)};
  cprox_curve *curve = NULL;
  cprox_body *ball = NULL;
  assert_int_equal(curve_from(describe_bezier(control, 4, 0.0, 1.0), ws, &curve), CPROX_OK);
  assert_int_equal(cprox_body_create_sphere(0.1, ws, &ball), CPROX_OK);
  for (int callback = STOP; callback < CALLBACKS; callback++) {
    cprox_result plain = {0};
    for (int way = 0; way < 3; way++) {
      inner in = {.curve = curve, .ball = cprox_obstacle_at(ball, CPROX_POSE_IDENTITY)};
      in.asked = way == 0 ? NULL : way == 1 ? ws : other;
      cprox_body *body = NULL;
      if (make(callback, &in, ws, &body) != CPROX_OK) fail_msg("%s", cprox_workspace_error(ws));
      cprox_options options = CPROX_OPTIONS_DEFAULT;
      if (callback == STOP) options.stop = stop_and_ask, options.stop_user = &in;
      cprox_result r;
      const cprox_status status =
          cprox_distance(cprox_point_along(curve), cprox_obstacle_at(body, CPROX_POSE_IDENTITY), &options, ws, &r);
      assert_true(status == CPROX_OK || (callback != STOP && status == CPROX_PRECISION));
      if (status == CPROX_OK) assert_string_equal(cprox_workspace_error(ws), "");
      assert_true(way == 0 || in.calls > 0);
      assert_int_equal(in.refused, way == 1 ? in.calls : 0);
      if (way == 0) plain = r;
      assert_true(r.lower == plain.lower && r.upper == plain.upper && r.nodes == plain.nodes);
      cprox_body_free(body);
    }
  }
  cprox_body_free(ball);
  cprox_curve_free(curve);
  cprox_workspace_free(other);
}

/* ---- solids ---- */

static size_t solids_refused, solids_made;

/* A ball, whose value asks for a box on the workspace of the solid that is being made. */
static double ball_and_ask(void *user, cprox_vec3 p) {
  const cprox_solid_description box = {.kind = CPROX_SOLID_BOX, .dimension = 2, .size = vec(1, 1, 1)};
  cprox_solid *solid = NULL;
  const cprox_status status = cprox_solid_create(&box, user, &solid);
  solids_refused += status == CPROX_INVALID;
  solids_made += status == CPROX_OK;
  cprox_solid_free(solid);
  return vec_norm(p) - 0.3;
}

CASE(a_solid_that_is_being_made_has_its_workspace_alone) {
  cprox_workspace *other = cprox_workspace_create();
  for (int own = 0; own < 2; own++) {
    const cprox_solid_description ball = {.kind = CPROX_SOLID_SUBLEVEL,
                                          .dimension = 2,
                                          .lowest = vec(-0.5, -0.5, 0),
                                          .cell = 0.1,
                                          .counts = {10, 10, 1},
                                          .function = ball_and_ask,
                                          .user = own ? other : ws,
                                          .lipschitz = 1.0};
    cprox_solid *solid = NULL;
    solids_refused = solids_made = 0;
    if (cprox_solid_create(&ball, ws, &solid) != CPROX_OK) fail_msg("%s", cprox_workspace_error(ws));
    assert_int_equal(solids_refused, own ? 0 : 100);
    assert_int_equal(solids_made, own ? 100 : 0);
    cprox_solid_free(solid);
  }
  cprox_workspace_free(other);
}

/* ---- memory ---- */

CASE(a_workspace_says_what_it_holds) {
  cprox_workspace *fresh = cprox_workspace_create();
  const size_t empty = cprox_workspace_bytes(fresh);
  assert_int_equal(cprox_workspace_bytes(NULL), 0);
  assert_in_range(empty, 1, 4096);
  const vec3 control[4] = {vec(-1, 0.4, 0), vec(-0.3, 0.5, 0.6), vec(0.5, 0.2, -0.7), vec(1, 0.6, 0.1)};
  cprox_curve *curve = NULL;
  cprox_body *box = NULL;
  assert_int_equal(curve_from(describe_bezier(control, 4, 0.0, 1.0), fresh, &curve), CPROX_OK);
  assert_int_equal(cprox_body_create_box(vec(0.1, 0.1, 0.1), fresh, &box), CPROX_OK);
  cprox_result r;
  for (int i = 0; i < 2; i++)
    cprox_distance(cprox_point_along(curve), cprox_obstacle_at(box, CPROX_POSE_IDENTITY), NULL, fresh, &r);
  const size_t grown = cprox_workspace_bytes(fresh);
  assert_true(grown > empty);
  cprox_distance(cprox_point_along(curve), cprox_obstacle_at(box, CPROX_POSE_IDENTITY), NULL, fresh, &r);
  assert_int_equal(cprox_workspace_bytes(fresh), grown); /* the same query needs no more */
  cprox_body_free(box);
  cprox_curve_free(curve);
  cprox_workspace_free(fresh);
}

int main(void) {
  return cases_run(workspace_setup, workspace_teardown);
}
