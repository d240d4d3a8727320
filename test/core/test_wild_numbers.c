/* SPDX-License-Identifier: BSD-3-Clause */
/* Every number of every argument and option, one at a time, is made not finite or longer than squares hold: the call is
 * refused with a reason, and nothing is written. */
#include <math.h>
#include <string.h>

#include "support/builders.h"
#include "support/cases.h"
#include "support/of_list.h"

static const double WILD[] = {NAN, INFINITY, -INFINITY, 1e308, -1e308, 1e61};
enum { N_WILD = sizeof WILD / sizeof *WILD };

/* All arguments that queries may have. */
typedef struct arguments {
  cprox_mover mover;
  cprox_obstacle target, other;
  cprox_options options;
  double delta, duration;
  vec3 velocity;
} arguments;

typedef cprox_status (*query)(const arguments *a);

static cprox_result result;

static cprox_status ask_distance(const arguments *a) {
  return cprox_distance(a->mover, a->target, &a->options, ws, &result);
}
static cprox_status ask_tolerance(const arguments *a) {
  return cprox_tolerance(a->mover, a->target, a->delta, &a->options, ws, &result);
}
static cprox_status ask_collision(const arguments *a) {
  return cprox_collision(a->mover, a->target, &a->options, ws, &result);
}
static cprox_status ask_time_of_contact(const arguments *a) {
  return cprox_time_of_contact(a->mover, a->target, &a->options, ws, &result);
}
static cprox_status ask_nearest(const arguments *a) {
  size_t count;
  return nearest_of_list(a->mover, &a->target, 1, 1, &a->options, ws, &result, &count);
}
static cprox_status ask_within(const arguments *a) {
  size_t count;
  return within_of_list(a->mover, &a->target, 1, a->delta, &a->options, ws, &result, &count);
}
static cprox_status ask_profile(const arguments *a) {
  const double breaks[2] = {0.0, 1.0};
  cprox_profile_interval interval;
  return profile_of_list(a->mover, &a->target, 1, breaks, 1, &a->options, ws, &interval);
}
static cprox_status ask_pair(const arguments *a) {
  return cprox_pair(a->other, a->target, &a->options, ws, &result);
}
static cprox_status ask_pair_swapped(const arguments *a) {
  return cprox_pair(a->target, a->other, &a->options, ws, &result);
}
static cprox_status ask_set(const arguments *a) {
  cprox_obstacles *set = NULL;
  cprox_status status = cprox_obstacles_create(&a->target, 1, CPROX_INDEX_BVH, ws, &set);
  if (status >= 0) status = cprox_obstacles_tolerance(set, a->mover, a->delta, &a->options, ws, &result, NULL);
  cprox_obstacles_free(set);
  return status;
}
static cprox_status ask_batch(const arguments *a) {
  cprox_obstacles *batch = NULL;
  cprox_status status = cprox_obstacles_create(&a->target, 1, CPROX_INDEX_BATCH, ws, &batch);
  if (status >= 0) status = cprox_obstacles_tolerance_batch(batch, &a->mover, 0, 1, a->delta, &a->options, ws, &result);
  cprox_obstacles_free(batch);
  return status;
}
static cprox_status ask_gradient(const arguments *a) {
  cprox_gradient gradient;
  const cprox_result answer = {.upper = 1.0, .lower = 1.0};
  return cprox_distance_gradient(a->mover, a->target, &a->options, &answer, ws, &gradient);
}
static cprox_status ask_certificate(const arguments *a) {
  cprox_certificate *certificate = cprox_certificate_create();
  const cprox_result answer = {.upper = 1.0, .lower = 1.0};
  const cprox_status status = certify_of_list(a->mover, &a->target, 1, a->delta, &answer, &a->options, ws, certificate);
  cprox_certificate_free(certificate);
  return status;
}
static cprox_status ask_translating(const arguments *a) {
  const cprox_translating one = {a->target, a->velocity}, two = {a->other, {0, 0, 0}};
  return cprox_translating_contact(one, two, a->duration, &a->options, ws, &result);
}
static cprox_status ask_translating_distance(const arguments *a) {
  const cprox_translating one = {a->target, {0, 0, 0}}, two = {a->other, a->velocity};
  return cprox_translating_distance(one, two, a->duration, &a->options, ws, &result);
}
static cprox_status ask_growth(const arguments *a) {
  cprox_growth growth;
  return cprox_growth_distance(a->target, a->other, &a->options, ws, &growth);
}

enum { OPTIONS = 1, MOVER = 2, TARGET = 4, DELTA = 8, WAY = 16 };
static const struct {
  const char *name;
  query ask;
  int takes;
} QUERIES[] = {
    {"distance", ask_distance, OPTIONS | MOVER | TARGET},
    {"tolerance", ask_tolerance, OPTIONS | MOVER | TARGET | DELTA},
    {"collision", ask_collision, OPTIONS | MOVER | TARGET},
    {"time of contact", ask_time_of_contact, OPTIONS | MOVER | TARGET},
    {"nearest", ask_nearest, OPTIONS | MOVER | TARGET},
    {"within", ask_within, OPTIONS | MOVER | TARGET | DELTA},
    {"profile", ask_profile, OPTIONS | MOVER | TARGET},
    {"pair", ask_pair, OPTIONS | TARGET},
    {"pair, swapped", ask_pair_swapped, OPTIONS | TARGET},
    {"set", ask_set, OPTIONS | MOVER | TARGET | DELTA},
    {"batch", ask_batch, OPTIONS | MOVER | TARGET | DELTA},
    {"gradient", ask_gradient, OPTIONS | MOVER | TARGET},
    {"certificate", ask_certificate, OPTIONS | MOVER | TARGET | DELTA},
    {"translating contact", ask_translating, OPTIONS | TARGET | WAY},
    {"translating distance", ask_translating_distance, OPTIONS | TARGET | WAY},
    {"growth", ask_growth, OPTIONS | TARGET},
};

/* The numbers of the arguments, and which of them a query takes. */
static size_t list_numbers(arguments *a, int takes, const char **name, double **number) {
  const struct {
    int of;
    const char *name;
    double *at;
  } all[] = {
      {OPTIONS, "epsilon", &a->options.epsilon},
      {OPTIONS, "relative_epsilon", &a->options.relative_epsilon},
      {MOVER, "radius", &a->mover.radius},
      {TARGET, "margin", &a->target.margin},
      {TARGET, "position.x", &a->target.pose.position.x},
      {TARGET, "position.y", &a->target.pose.position.y},
      {TARGET, "position.z", &a->target.pose.position.z},
      {TARGET, "orientation.w", &a->target.pose.orientation.w},
      {TARGET, "orientation.x", &a->target.pose.orientation.x},
      {TARGET, "orientation.y", &a->target.pose.orientation.y},
      {TARGET, "orientation.z", &a->target.pose.orientation.z},
      {DELTA, "delta", &a->delta},
      {WAY, "velocity.x", &a->velocity.x},
      {WAY, "velocity.y", &a->velocity.y},
      {WAY, "velocity.z", &a->velocity.z},
      {WAY, "duration", &a->duration},
  };
  size_t n = 0;
  for (size_t i = 0; i < sizeof all / sizeof *all; i++) {
    if (!(all[i].of & takes)) continue;
    name[n] = all[i].name;
    number[n++] = all[i].at;
  }
  return n;
}

static void check_query(arguments *a, size_t q) {
  const char *name[20];
  double *number[20];
  const size_t n = list_numbers(a, QUERIES[q].takes, name, number);
  for (size_t i = 0; i < n; i++) {
    for (size_t k = 0; k < N_WILD; k++) {
      if (WILD[k] == 1e61 && strncmp(name[i], "orientation", 11) == 0) continue; /* quaternions may be that long */
      const double kept = *number[i];
      *number[i] = WILD[k];
      const cprox_status status = QUERIES[q].ask(a);
      if (status != CPROX_INVALID || cprox_workspace_error(ws)[0] == '\0')
        fail_msg("%s with %s = %g: %s, \"%s\"", QUERIES[q].name, name[i], WILD[k], cprox_status_name(status),
                 cprox_workspace_error(ws));
      *number[i] = kept;
    }
  }
}

CASE(every_number_of_every_query_is_finite_or_refused) {
  const vec3 ends[2] = {{3, 0, 0}, {3, 1, 0}};
  cprox_curve *curve = bezier(ends, 2);
  cprox_body *points = NULL, *ball = NULL;
  assert_int_equal(cprox_body_create_points(ends, 2, 0.1, SIZE_MAX, ws, &points), CPROX_OK);
  assert_int_equal(cprox_body_create_superquadric(vec(1, 1, 1), vec(2, 2, 2), ws, &ball), CPROX_OK);
  for (size_t q = 0; q < sizeof QUERIES / sizeof *QUERIES; q++) {
    const bool bodies = (QUERIES[q].takes & WAY) || QUERIES[q].ask == ask_growth;
    const cprox_body *targets[2] = {ball, points};
    for (int i = 0; i < (bodies ? 1 : 2); i++) {
      arguments a = {.mover = cprox_point_along(curve),
                     .target = cprox_obstacle_at(targets[i], CPROX_POSE_IDENTITY),
                     .other = cprox_obstacle_at(ball, (cprox_pose){{5, 0, 0}, {1, 0, 0, 0}}),
                     .options = CPROX_OPTIONS_DEFAULT,
                     .delta = 0.1,
                     .duration = 1.0,
                     .velocity = {1, 0, 0}};
      check_query(&a, q);
    }
  }
  cprox_body_free(points);
  cprox_body_free(ball);
  cprox_curve_free(curve);
}

/* An infinite epsilon once led a distance to a cloud out of its memory. */
CASE(the_widest_epsilon_is_answered) {
  vec3 cloud[300];
  for (size_t i = 0; i < 300; i++)
    cloud[i] = vec(0.01 * (double)(i % 17), 0.02 * (double)(i % 23), 0.03 * (double)(i % 7));
  const vec3 control[4] = {{3, 0, 0}, {1, 2, 0}, {2, -1, 1}, {1, 0, 2}};
  cprox_body *points = NULL;
  assert_int_equal(cprox_body_create_points(cloud, 300, 0.0, SIZE_MAX, ws, &points), CPROX_OK);
  cprox_curve *curve = bezier(control, 4);
  const double widest[] = {1.0, 1e10, 1e60};
  for (int i = 0; i < 3; i++) {
    cprox_options options = accurate(widest[i]);
    options.relative_epsilon = i == 2 ? 1e60 : 0.0;
    const cprox_obstacle target = cprox_obstacle_at(points, CPROX_POSE_IDENTITY);
    assert_int_equal(cprox_distance(cprox_point_along(curve), target, &options, ws, &result), CPROX_OK);
    assert_true(0.0 <= result.lower && result.lower <= result.upper && result.upper < 4.0);
  }
  cprox_curve_free(curve);
  cprox_body_free(points);
}

/* ---- robots ---- */

typedef struct robot_arguments {
  cprox_link link;
  cprox_link_geometry geometry;
  double time[2], position[2], velocity[2], acceleration[2], rest;
} robot_arguments;

static cprox_status make_robot(const robot_arguments *a) {
  const int32_t variable = 0;
  cprox_robot *robot = NULL;
  cprox_motion *motion = NULL;
  cprox_status status = cprox_robot_create(&a->link, 1, &a->geometry, 1, 2, ws, &robot);
  const cprox_waypoint points[2] = {{a->time[0], &a->position[0], &a->velocity[0], &a->acceleration[0]},
                                    {a->time[1], &a->position[1], &a->velocity[1], &a->acceleration[1]}};
  const double rest[2] = {0.0, a->rest};
  if (status >= 0)
    status = cprox_motion_create(robot,
                                 &(cprox_motion_description){.kind = CPROX_MOTION_WAYPOINTS,
                                                             .variables = &variable,
                                                             .n_variables = 1,
                                                             .waypoints = points,
                                                             .n_waypoints = 2,
                                                             .interpolation = CPROX_INTERPOLATION_QUINTIC,
                                                             .rest = rest},
                                 ws, &motion);
  cprox_motion_free(motion);
  cprox_robot_free(robot);
  return status;
}

CASE(every_number_of_a_robot_and_its_motion_is_finite_or_refused) {
  cprox_body *ball = NULL;
  assert_int_equal(cprox_body_create_sphere(1.0, ws, &ball), CPROX_OK);
  robot_arguments a = {.link = {.parent = -1,
                                .type = CPROX_JOINT_PRISMATIC,
                                .origin = {{1, 0, 0}, {1, 0, 0, 0}},
                                .axis = {0, 0, 1},
                                .multiplier = 1.0},
                       .geometry = {.body = ball, .pose = {{0, 1, 0}, {1, 0, 0, 0}}, .margin = 0.1},
                       .time = {0, 1},
                       .position = {0.5, 1}};
  assert_int_equal(make_robot(&a), CPROX_OK);
  double *numbers[] = {&a.link.origin.position.x,
                       &a.link.origin.position.y,
                       &a.link.origin.orientation.w,
                       &a.link.origin.orientation.z,
                       &a.link.axis.x,
                       &a.link.axis.z,
                       &a.link.multiplier,
                       &a.link.offset,
                       &a.geometry.pose.position.z,
                       &a.geometry.pose.orientation.x,
                       &a.geometry.margin,
                       &a.time[0],
                       &a.time[1],
                       &a.position[0],
                       &a.position[1],
                       &a.velocity[0],
                       &a.velocity[1],
                       &a.acceleration[0],
                       &a.acceleration[1],
                       &a.rest};
  for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++) {
    for (size_t k = 0; k < 5; k++) {
      const double kept = *numbers[i];
      *numbers[i] = WILD[k];
      const cprox_status status = make_robot(&a);
      if (status != CPROX_INVALID || cprox_workspace_error(ws)[0] == '\0')
        fail_msg("number %zu = %g: %s, \"%s\"", i, WILD[k], cprox_status_name(status), cprox_workspace_error(ws));
      *numbers[i] = kept;
    }
  }
  cprox_body_free(ball);
}

int main(void) {
  return cases_run(workspace_setup, workspace_teardown);
}
