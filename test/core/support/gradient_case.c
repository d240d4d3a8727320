/* SPDX-License-Identifier: BSD-3-Clause */
#include "support/gradient_case.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "support/builders.h"
#include "support/meshes.h"
#include "support/shapes.h"

/* For a distance as exact as it can be had. Depths of curved bodies may be known no better than to 1e-7, and then more
 * nodes, each of them as dear as a depth is, say nothing more. */
enum { MOST_NODES = 3000 };

/* What is taken for the rounding of a growth distance: differences are judged by it. */
static const double VALUE_ROUNDING = 1e-12;

/* ---- growth distances at one time, by kinematics in long double ---- */

static cprox_pose pose_of(const ref_pose *at) {
  return (cprox_pose){{(double)at->p.x, (double)at->p.y, (double)at->p.z},
                      {(double)at->q[3], (double)at->q[0], (double)at->q[1], (double)at->q[2]}};
}

static cprox_obstacle geometry_at(const test_robot *t, const ref_pose *links, size_t i) {
  const cprox_link_geometry *g = &t->geometries[i];
  const cprox_pose link = pose_of(&links[g->link]);
  const cprox_quat q = link.orientation, p = g->pose.orientation;
  const vec3 v = vec(q.x, q.y, q.z), x = g->pose.position, twice = vec_scale(2.0, vec_cross(v, x));
  const vec3 turned = vec_add(vec_add(x, vec_scale(q.w, twice)), vec_cross(v, twice));
  const cprox_pose pose = {
      vec_add(turned, link.position),
      {q.w * p.w - q.x * p.x - q.y * p.y - q.z * p.z, q.w * p.x + q.x * p.w + q.y * p.z - q.z * p.y,
       q.w * p.y - q.x * p.z + q.y * p.w + q.z * p.x, q.w * p.z + q.x * p.y - q.y * p.x + q.z * p.w}};
  return cprox_obstacle_at(g->body, pose);
}

double gradient_case_growth_at(const gradient_case *p, double t) {
  const test_robot *robot = &p->robot;
  long double values[TEST_MAX_VARIABLES];
  ref_pose links[TEST_MAX_LINKS];
  robot_ref_values(robot, t, values);
  robot_ref_links(robot, values, links);
  cprox_options options = accurate(1e-12);
  double least = INFINITY;
  for (size_t i = 0; i < robot->n_links; i++) {
    const cprox_obstacle a = geometry_at(robot, links, i);
    cprox_growth g;
    for (int k = 0; k < GRADIENT_TARGETS && p->kind != CPROX_MOVER_ROBOT_SELF; k++) {
      assert_true(cprox_growth_distance(a, p->targets[k], &options, ws, &g) >= 0);
      least = fmin(least, 0.5 * (g.lower + g.upper));
    }
    for (size_t k = 0; k < i && p->kind != CPROX_MOVER_ROBOT; k++) {
      const cprox_link_info between =
          cprox_motion_get_link_info(robot->motion, robot->geometries[i].link, robot->geometries[k].link);
      if (between.n_joints < 2) continue;
      assert_true(cprox_growth_distance(a, geometry_at(robot, links, k), &options, ws, &g) >= 0);
      least = fmin(least, 0.5 * (g.lower + g.upper));
    }
  }
  return least;
}

/* ---- the core's answers ---- */

static cprox_result result_of(const cprox_motion_growth *growth) {
  return (cprox_result){.status = growth->growth.status,
                        .lower = growth->growth.lower,
                        .upper = growth->growth.upper,
                        .t = growth->t,
                        .mover_part = growth->mover_part,
                        .obstacle_index = growth->obstacle_index};
}

/* The core's answer; with a gradient where there is room for it. *width grows to that of the interval. */
static double ask(const gradient_case *p, gradient_answer *a, double *width) {
  cprox_obstacles *obstacles = NULL;
  const cprox_obstacle_index index = p->indexed ? CPROX_INDEX_BVH : CPROX_INDEX_NONE;
  assert_int_equal(cprox_obstacles_create(p->targets, GRADIENT_TARGETS, index, ws, &obstacles), CPROX_OK);
  cprox_mover mover = cprox_robot_along(p->robot.motion, NULL, 0);
  mover.kind = p->kind;
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.epsilon = a ? 1e-6 : 0.0;
  if (!a && !p->growth) options.max_nodes = MOST_NODES;
  options.signed_distance = p->is_signed;
  const cprox_obstacles *against = p->kind == CPROX_MOVER_ROBOT_SELF ? NULL : obstacles;
  cprox_result r;
  cprox_status status;
  cprox_motion_growth growth;
  if (a) {
    a->gradient = (cprox_motion_gradient){.variables = a->variables};
    memset(a->rows, 0, sizeof a->rows);
    if (p->robot.turning == CPROX_TURNING_POLYNOMIAL)
      a->gradient.positions = a->rows[0], a->gradient.velocities = a->rows[1], a->gradient.accelerations = a->rows[2];
    if (p->growth)
      status = cprox_robot_growth(against, mover, &options, ws, &growth, &a->gradient);
    else
      status = cprox_robot_distance_gradient(against, mover, &options, ws, &a->result, &a->gradient);
    if (p->growth) a->result = result_of(&growth);
    r = a->result;
  } else if (p->growth) {
    /* with derivatives the minimiser is refined */
    cprox_motion_gradient unused = {.variables = NULL};
    options.epsilon = 1e-9;
    status = cprox_robot_growth(against, mover, &options, ws, &growth, &unused);
    r = result_of(&growth);
    if (isfinite(r.upper)) r.upper = gradient_case_growth_at(p, growth.t);
    r.lower = r.upper * (1.0 - VALUE_ROUNDING);
  } else {
    status = cprox_obstacles_distance(against, mover, &options, ws, &r, NULL);
  }
  if (p->pair) {
    cprox_profile_interval least;
    mover.pairs = p->pair, mover.n_pairs = 1;
    status = cprox_obstacles_profile(against, mover, p->breaks, 1, INFINITY, &options, ws, &least);
    r.lower = least.lower, r.upper = least.upper;
  }
  if (status < 0) fail_msg("%s", cprox_workspace_error(ws));
  cprox_obstacles_free(obstacles);
  if (!isfinite(r.upper)) return r.upper;
  *width = fmax(r.upper - r.lower, *width);
  return 0.5 * (r.lower + r.upper);
}

double gradient_case_ask(const gradient_case *p, gradient_answer *a) {
  double width = 0.0;
  return ask(p, a, &width);
}

gradient_step gradient_step_random(rng *r, const gradient_case *p) {
  gradient_step d = {0};
  /* slerp and screws have no gradient by their waypoints */
  const bool moves = p->robot.turning == CPROX_TURNING_POLYNOMIAL;
  for (int order = 0; order < 3; order++)
    for (size_t i = 0; i < p->robot.n_points; i++)
      for (size_t k = 0; k < p->robot.n_variables; k++) d.rows[order][i][k] = moves ? rng_uniform(r, -1, 1) : 0.0;
  d.stretch = rng_uniform(r, -1, 1), d.margin = rng_uniform(r, -1, 1);
  d.base = rng_in_cube(r, 1.0), d.base_turn = rng_in_cube(r, 1.0);
  d.position = rng_in_cube(r, 1.0), d.turn = rng_in_cube(r, 1.0);
  return d;
}

static cprox_quat product(cprox_quat a, cprox_quat b) {
  return (cprox_quat){a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z, a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
                      a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x, a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w};
}

static cprox_quat turn_by(vec3 w) {
  const double angle = vec_norm(w), s = angle > 0.0 ? sin(0.5 * angle) / angle : 0.5;
  return (cprox_quat){cos(0.5 * angle), s * w.x, s * w.y, s * w.z};
}

static vec3 turned(cprox_quat q, vec3 x) {
  const vec3 v = vec(q.x, q.y, q.z), twice = vec_scale(2.0, vec_cross(v, x));
  return vec_add(vec_add(x, vec_scale(q.w, twice)), vec_cross(v, twice));
}

/* The distance h along the step; `nearest` is the obstacle whose pose and margin belong to it. */
static double ask_along(const gradient_case *p, const gradient_step *d, int32_t nearest, double h, double *width) {
  gradient_case moved = *p;
  test_robot *t = &moved.robot;
  double(*const rows[3])[TEST_MAX_VARIABLES] = {t->positions, t->velocities, t->accelerations};
  for (int order = 0; order < 3; order++)
    for (size_t i = 0; i < t->n_points; i++)
      for (size_t k = 0; k < t->n_variables; k++) rows[order][i][k] += h * d->rows[order][i][k];
  for (size_t i = 0; i < TEST_WAYPOINTS + TEST_SPLINE_DEGREE + 1; i++) t->times[i] *= 1.0 + h * d->stretch;
  const cprox_quat base = turn_by(vec_scale(h, d->base_turn));
  for (size_t i = 0; i < t->n_links; i++) {
    cprox_pose *origin = &t->links[i].origin;
    if (t->links[i].parent >= 0) continue;
    origin->position = vec_axpy(turned(base, origin->position), h, d->base);
    origin->orientation = product(base, origin->orientation);
  }
  if (nearest >= 0 && nearest < GRADIENT_TARGETS) {
    cprox_obstacle *target = &moved.targets[nearest];
    target->margin += h * d->margin;
    target->pose.position = vec_axpy(target->pose.position, h, d->position);
    target->pose.orientation = product(turn_by(vec_scale(h, d->turn)), target->pose.orientation);
  }
  t->robot = NULL, t->motion = NULL;
  robot_rebuild(t);
  const double distance = ask(&moved, NULL, width);
  cprox_motion_free(t->motion);
  cprox_robot_free(t->robot);
  return distance;
}

/* The derivative along the step, by the gradient. */
double gradient_derivative(const gradient_case *p, const gradient_answer *a, const gradient_step *d) {
  const cprox_motion_gradient *g = &a->gradient;
  const test_robot *t = &p->robot;
  const size_t n = t->n_variables;
  double sum = 0.0;
  for (int order = 0; order < (t->spline ? 1 : 3); order++)
    for (size_t i = 0; i < t->n_points; i++)
      for (size_t k = 0; k < n; k++) sum += a->rows[order][i * n + k] * d->rows[order][i][k];
  const size_t last = t->spline ? TEST_WAYPOINTS : t->n_points - 1, first = t->spline ? TEST_SPLINE_DEGREE : 0;
  sum += g->duration * d->stretch * (t->times[last] - t->times[first]);
  sum += vec_dot(g->base_position, d->base) + vec_dot(g->base_rotation, d->base_turn);
  if (a->result.obstacle_index < GRADIENT_TARGETS && vec_norm2(g->position) > 0.0)
    sum += g->margin * d->margin + vec_dot(g->position, d->position) + vec_dot(g->rotation, d->turn);
  return sum;
}

/* Of one difference with one extrapolation: two differences of distances that are each known within `width`, divided by
 * twice their steps, the one half of the other. */
static double noise_of(double width, double h) {
  return 1.5 * width / h;
}

gradient_fit gradient_compare(const gradient_case *p, const gradient_answer *a, const gradient_step *d,
                              double expected) {
  const int32_t nearest = vec_norm2(a->gradient.position) > 0.0 ? a->result.obstacle_index : -1;
  const double widths[] = {1e-4, 1e-5, 1e-6, 1e-3}, most_noise = 3.0 * GRADIENT_TOLERANCE;
  gradient_fit fit = {.off = INFINITY, .kink = INFINITY, .least_kink = INFINITY, .one_sided = INFINITY};
  double width = 0.0;
  const double here = ask(p, NULL, &width);
  for (int k = 0; k < 4 && fit.off > 0.1 * GRADIENT_TOLERANCE; k++) {
    double slope[2], kink = INFINITY;
    for (int m = 0; m < 2; m++) {
      const double h = widths[k] / (m + 1), ahead = ask_along(p, d, nearest, h, &width),
                   behind = ask_along(p, d, nearest, -h, &width);
      slope[m] = (ahead - behind) / (2.0 * h);
      fit.one_sided =
          fmin(fmin(fabs((ahead - here) / h - expected), fabs((here - behind) / h - expected)), fit.one_sided);
      kink = fmin(fabs(ahead - 2.0 * here + behind) / h, kink);
    }
    const double noise = noise_of(width, widths[k]);
    fit.least_kink = fmin(kink, fit.least_kink);
    if (noise <= most_noise) fit.kink = fmin(kink, fit.kink);
    fit.is_known = fit.is_known || noise <= 0.1 * GRADIENT_TOLERANCE;
    if (noise <= most_noise)
      fit.off = fmin(fmax(fmin(fabs((4.0 * slope[1] - slope[0]) / 3.0 - expected),
                               fabs(2.0 * slope[1] - slope[0] - expected)) - /* where the second derivative jumps */
                              noise,
                          0.0),
                     fit.off);
  }
  return fit;
}

static const cprox_body_kind SOLID[] = {CPROX_BODY_SPHERE, CPROX_BODY_BOX,  CPROX_BODY_CAPSULE,  CPROX_BODY_CYLINDER,
                                        CPROX_BODY_POINT,  CPROX_BODY_CONE, CPROX_BODY_POLYTOPE, CPROX_BODY_ELLIPSOID};

/* Convex, or one in nine times the surface of a torus with bumps, where that is allowed. */
static cprox_body *body_random(rng *r, double scale, bool no_mesh) {
  if (rng_index(r, 9) == 0 && !no_mesh) {
    test_mesh mesh = mesh_torus(7, 5, 0.7 * scale, 0.2 * scale, 0.2);
    cprox_body *surface = mesh_body(&mesh, CPROX_MESH_FILL_SURFACE, ws);
    mesh_free(&mesh);
    return surface;
  }
  test_shape s;
  shape_make(r, SOLID[rng_index(r, 8)], scale, 3.0, &s);
  return s.body;
}

void gradient_case_make(rng *r, bool is_signed, gradient_case *p) {
  test_robot *t = &p->robot;
  *p = (gradient_case){.kind = (cprox_mover_kind)(CPROX_MOVER_ROBOT + rng_index(r, 3)),
                       .indexed = rng_index(r, 2),
                       .is_signed = is_signed};
  const double speed = rng_log_uniform(r, 0.1, 1.5);
  if (rng_index(r, 4) > 0)
    robot_make(r, speed, t);
  else
    robot_make_turning(r, speed, (cprox_turning)rng_index(r, 3), 2 + rng_index(r, TEST_WAYPOINTS - 1), t);
  for (size_t i = 0; i < t->n_links; i++) {
    if (rng_index(r, 2)) continue;
    cprox_body_free((cprox_body *)t->geometries[i].body);
    t->geometries[i].body = body_random(r, 0.2, is_signed);
  }
  robot_rebuild(t);
  for (int i = 0; i < GRADIENT_TARGETS; i++) {
    p->targets[i] = cprox_obstacle_at(body_random(r, 0.5, is_signed), rng_pose(r, is_signed ? 1.0 : 2.0));
    p->targets[i].margin = 0.05;
  }
}

void gradient_case_free(gradient_case *p) {
  robot_free(&p->robot);
  for (int i = 0; i < GRADIENT_TARGETS; i++) cprox_body_free((cprox_body *)p->targets[i].body);
}

/* Whether the distance to the obstacles, or of the robot to itself, is attained again within 1e-8, far from the
 * minimiser of all. */
static bool is_attained_again(const gradient_case *p, const gradient_answer *a, bool self) {
  enum { MOST_ROWS = 300 };
  cprox_obstacles *obstacles = NULL;
  assert_int_equal(cprox_obstacles_create(p->targets, self ? 0 : GRADIENT_TARGETS, CPROX_INDEX_NONE, ws, &obstacles),
                   CPROX_OK);
  const cprox_motion *motion = p->robot.motion;
  const cprox_mover mover = self ? cprox_robot_self(motion, NULL, 0) : cprox_robot_along(motion, NULL, 0);
  const cprox_motion_info info = cprox_motion_get_info(motion);
  const double t = a->result.t, aside = 3e-2 * (info.t1 - info.t0), upper = a->result.upper + 1e-8;
  const double breaks[] = {info.t0, fmax(t - aside, info.t0), fmin(t + aside, info.t1), info.t1};
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.epsilon = 1e-10;
  options.signed_distance = p->is_signed;
  static cprox_motion_row rows[MOST_ROWS];
  bool again = false;
  for (int k = 0; k < 4 && !again; k += 2) {
    const cprox_rows_query asked = {.breaks = &breaks[k], .n_intervals = 1, .horizon = fmax(upper, 0.0), .per_pair = 1};
    if (!(breaks[k] < breaks[k + 1])) continue;
    size_t n = 0;
    memset(rows, 0, sizeof rows);
    const cprox_status status = cprox_robot_rows(obstacles, mover, &asked, &options, ws, rows, MOST_ROWS, &n);
    if (status < 0) fail_msg("%s", cprox_workspace_error(ws));
    for (size_t i = 0; i < n; i++) again = again || rows[i].result.upper <= upper;
  }
  cprox_obstacles_free(obstacles);
  return again;
}

gradient_verdict gradient_case_judge(rng *r, const gradient_case *p, gradient_judgement *j) {
  *j = (gradient_judgement){.why = ""};
  gradient_case_ask(p, &j->answer);
  snprintf(j->why, sizeof j->why, "%s", cprox_workspace_error(ws));
  const gradient_step d = gradient_step_random(r, p);
  const double distance = j->answer.result.upper;
  if (!(p->is_signed ? distance < -0.01 : distance > 0.01) || !isfinite(distance)) return GRADIENT_NOT_ASKED;
  j->expected = gradient_derivative(p, &j->answer, &d);
  j->fit = gradient_compare(p, &j->answer, &d, j->expected);
  const double kinks = 1e-4;
  if (!j->answer.gradient.valid) {
    const bool again = (p->kind != CPROX_MOVER_ROBOT_SELF && is_attained_again(p, &j->answer, false)) ||
                       (p->kind != CPROX_MOVER_ROBOT && is_attained_again(p, &j->answer, true));
    return j->fit.least_kink > kinks || again ? GRADIENT_TIED : GRADIENT_MISSING;
  }
  if (j->fit.kink > kinks && j->fit.one_sided < 1e-5) return GRADIENT_BESIDE_TIE;
  j->off = j->fit.off / (1.0 + fabs(j->expected));
  if (j->off <= GRADIENT_TOLERANCE) return GRADIENT_FITS;
  return j->fit.is_known ? GRADIENT_WRONG : GRADIENT_UNKNOWN;
}
