/* SPDX-License-Identifier: BSD-3-Clause */
/* Gradients where the nearest points, the way out or the place on the curve may be more than one. What is called a
 * gradient must be the derivative to either side, by one-sided differences of distances that are known to 1e-10 or
 * better: steps of 1e-3 to 1e-8, of which one must fit within 2e-3. Ties turn the derivative by more than that; what is
 * smooth has second derivatives below 1e5. */
#include <math.h>

#include "attack.h"
#include "base/frame.h"
#include "support/make_curve.h"

enum { POINTS = 6 };

typedef struct problem {
  bool carries, synchronized, is_signed, splines;
  size_t n; /* points of the curve */
  vec3 points[POINTS], other[POINTS];
  cprox_body *body, *carried, *part;
  cprox_pose pose;
  double radius, margin;
} problem;

/* ---- asking ---- */

static cprox_curve *make_curve(attack *a, const problem *p, const vec3 *points) {
  cprox_curve *curve = NULL;
  double knots[POINTS + 2];
  for (size_t i = 0; i < p->n + 2; i++) knots[i] = ((double)i - 1.0) / (double)(p->n - 1);
  const cprox_status status =
      p->splines ? curve_from(describe_bspline(points, p->n, 1, knots, p->n + 2, 0.0, knots[p->n]), a->ws, &curve)
                 : curve_from(describe_bezier(points, p->n, 0.0, 1.0), a->ws, &curve);
  if (status != CPROX_OK) attack_fail(a, "%s", cprox_workspace_error(a->ws));
  return curve;
}

/* NaN where the distance is not known well enough. */
static double ask(attack *a, const problem *p, cprox_gradient *gradient) {
  cprox_curve *curve = make_curve(a, p, p->points), *clock = p->synchronized ? make_curve(a, p, p->other) : NULL;
  cprox_mover mover = cprox_tube_along(curve, p->radius), second = cprox_tube_along(clock, p->margin);
  if (p->carries) mover.kind = CPROX_MOVER_BODY, mover.body = p->carried;
  second.body = p->body;
  cprox_obstacle target =
      p->synchronized ? cprox_synchronized(second) : cprox_with_margin(cprox_obstacle_at(p->body, p->pose), p->margin);
  target.pose = p->pose;
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.epsilon = gradient ? 1e-9 : 1e-12;
  options.signed_distance = p->is_signed;
  if (!gradient)
    options.max_nodes = 2000; /* a depth may not be known as narrowly as that, and every node of it is slow */
  cprox_result result = {.upper = NAN};
  cprox_status status = cprox_distance(mover, target, &options, a->ws, &result);
  attack_check(a, status >= 0, "%s", cprox_workspace_error(a->ws));
  if (gradient && status >= 0) {
    status = cprox_distance_gradient(mover, target, &options, &result, a->ws, gradient);
    attack_check(a, status >= 0, "%s", cprox_workspace_error(a->ws));
  }
  cprox_curve_free(curve);
  cprox_curve_free(clock);
  return gradient || result.upper - result.lower <= 1e-10 ? 0.5 * (result.lower + result.upper) : NAN;
}

/* One direction in the space of all parameters. */
typedef struct step {
  vec3 points[POINTS], position, turn;
} step;

static problem moved(problem p, const step *d, double h) {
  for (size_t i = 0; i < p.n; i++) p.points[i] = vec_axpy(p.points[i], h, d->points[i]);
  p.pose.position = vec_axpy(p.pose.position, h, d->position);
  const vec3 w = vec_scale(h, d->turn);
  const double angle = vec_norm(w), s = angle > 0.0 ? sin(0.5 * angle) / angle : 0.5, c = cos(0.5 * angle);
  const cprox_quat u = {c, s * w.x, s * w.y, s * w.z}, q = p.pose.orientation;
  p.pose.orientation =
      (cprox_quat){u.w * q.w - u.x * q.x - u.y * q.y - u.z * q.z, u.w * q.x + u.x * q.w + u.y * q.z - u.z * q.y,
                   u.w * q.y - u.x * q.z + u.y * q.w + u.z * q.x, u.w * q.z + u.x * q.y - u.y * q.x + u.z * q.w};
  return p;
}

static double derivative(const problem *p, const cprox_gradient *g, const step *d) {
  double w[POINTS], knots[POINTS + 2], sum = vec_dot(g->position, d->position) + vec_dot(g->rotation, d->turn);
  for (size_t i = 0; i < p->n + 2; i++) knots[i] = ((double)i - 1.0) / (double)(p->n - 1);
  if (p->splines)
    curve_weights(describe_bspline(NULL, p->n, 1, knots, p->n + 1 + 1, 0.0, 1.0), g->t, w);
  else
    curve_weights(describe_bezier(NULL, p->n, 0.0, 1.0), g->t, w);
  for (size_t i = 0; i < p->n; i++) sum += w[i] * vec_dot(g->mover, d->points[i]);
  return sum;
}

/* How far the derivative to one side is from what is expected, at the step
 * where that is least. */
static double misfit(attack *a, const problem *p, const step *d, double side, double here, double expected) {
  double least = INFINITY;
  for (double h = 1e-3; h > 5e-9 && !attack_failed(a); h *= 0.1) {
    const problem there = moved(*p, d, side * h);
    const double off = fabs((ask(a, &there, NULL) - here) / h - side * expected);
    if (off < least) least = off;
  }
  return least;
}

static void check(attack *a, rng *r, const problem *p) {
  cprox_gradient g = {.valid = false};
  ask(a, p, &g);
  attack_count(a, g.valid ? "with a gradient" : cprox_workspace_error(a->ws));
  const double here = ask(a, p, NULL);
  if (!g.valid || isnan(here)) return;
  for (int i = 0; i < 3 && !attack_failed(a); i++) {
    step d = {0};
    if (i != 1) d.turn = rng_unit(r);
    if (i != 0)
      for (size_t k = 0; k < p->n; k++) d.points[k] = rng_in_cube(r, 1.0);
    if (i == 2) d.position = rng_unit(r);
    const double expected = derivative(p, &g, &d), scale = 1.0 + fabs(expected);
    const double ahead = misfit(a, p, &d, 1.0, here, expected), behind = misfit(a, p, &d, -1.0, here, expected);
    if (isinf(ahead) || isinf(behind)) continue; /* not known well enough */
    attack_check(a, ahead < 2e-3 * scale && behind < 2e-3 * scale,
                 "distance %.17g, t %.17g: derivative %.9g, but %.3g off ahead "
                 "and %.3g behind",
                 here, g.t, expected, ahead, behind);
  }
}

/* ---- problems ---- */

static cprox_quat turn_about(int axis, double angle) {
  cprox_quat q = {cos(0.5 * angle), 0, 0, 0};
  *(axis == 0 ? &q.x : axis == 1 ? &q.y : &q.z) = sin(0.5 * angle);
  return q;
}

static cprox_quat product(cprox_quat a, cprox_quat b) {
  return (cprox_quat){a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z, a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
                      a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x, a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w};
}

static const char *const NAMES[] = {"box", "cylinder", "cone", "capsule", "polytope", "ellipsoid", "halfspace"};

static cprox_body *make_body(attack *a, rng *r, size_t kind, double size) {
  cprox_body *body = NULL;
  const double x = size * rng_log_uniform(r, 0.2, 1.0), y = size * rng_log_uniform(r, 0.2, 1.0),
               z = size * rng_log_uniform(r, 0.2, 1.0);
  cprox_status status = CPROX_INVALID;
  if (kind == 0) status = cprox_body_create_box(vec(x, y, z), a->ws, &body);
  if (kind == 1) status = cprox_body_create_cylinder(0.5 * x, y, a->ws, &body);
  if (kind == 2) status = cprox_body_create_cone(0.5 * x, y, a->ws, &body);
  if (kind == 3) status = cprox_body_create_capsule(0.3 * x, y, a->ws, &body);
  if (kind == 5) status = cprox_body_create_ellipsoid(vec(0.5 * x, 0.5 * y, 0.5 * z), a->ws, &body);
  if (kind == 6) status = cprox_body_create_halfspace(vec(0, 0, 1), 0.0, a->ws, &body);
  if (kind == 4) { /* a prism or an antiprism: faces, some all but level */
    vec3 v[12];
    const size_t n = 3 + rng_index(r, 4);
    const double turn = rng_index(r, 2) ? 0.0 : rng_uniform(r, 0, 3),
                 slope = rng_index(r, 2) ? 0.0 : rng_log_uniform(r, 1e-3, 0.1);
    for (size_t i = 0; i < n; i++) {
      const double angle = 6.283185307179586 * (double)i / (double)n;
      v[i] = vec(0.5 * x * cos(angle), 0.5 * x * sin(angle), -0.5 * y);
      v[n + i] =
          vec(0.4 * x * cos(angle + turn), 0.4 * x * sin(angle + turn), 0.5 * y + slope * fabs(cos(angle + turn)) * x);
    }
    status = cprox_body_create_polytope(v, 2 * n, a->ws, &body);
  }
  if (status != CPROX_OK) attack_fail(a, "%s", cprox_workspace_error(a->ws));
  return body;
}

/* Turns that lay faces, edges and axes along each other, or all but. */
static cprox_quat level_turn(rng *r) {
  const double quarter = 1.5707963267948966;
  cprox_quat q = turn_about((int)rng_index(r, 3), quarter * (double)rng_index(r, 4));
  if (rng_index(r, 3) == 0) q = product(turn_about((int)rng_index(r, 2), 0.5 * quarter), q);
  if (rng_index(r, 2)) q = product(turn_about(2, rng_uniform(r, 0, 6)), q);
  if (rng_index(r, 3) == 0) {
    const vec3 axis = rng_unit(r);
    const double tilt = rng_log_uniform(r, 1e-17, 1e-2);
    q = product((cprox_quat){1.0, tilt * axis.x, tilt * axis.y, tilt * axis.z}, q);
  }
  return q;
}

/* Down to a height and up again, or down and no farther. */
static void come_down(rng *r, problem *p, double height) {
  const vec3 low = vec(rng_uniform(r, -0.3, 0.3), rng_uniform(r, -0.3, 0.3), height);
  p->n = 3;
  p->points[0] = vec(rng_uniform(r, -1, 1), rng_uniform(r, -1, 1), 2.0);
  p->points[1] = vec(low.x, low.y, 2.0 * height - 2.0);
  p->points[2] = vec(rng_uniform(r, -1, 1), rng_uniform(r, -1, 1), 2.0);
  if (rng_index(r, 3) == 0) p->n = 2, p->points[1] = low;
}

/* A carried body over a standing one, level with it. */
static void carried(attack *a, rng *r, problem *p) {
  const size_t standing = rng_index(r, 7), rider = rng_index(r, 6);
  attack_kind(a, "%s on %s", NAMES[rider], NAMES[standing]);
  p->carries = true;
  p->body = make_body(a, r, standing, 1.0);
  p->part = make_body(a, r, rider, 1.0);
  p->synchronized = standing != 6 && rng_index(r, 4) == 0;
  p->pose =
      (cprox_pose){.position = rng_in_cube(r, 0.1), .orientation = standing == 6 ? turn_about(0, 0) : level_turn(r)};
  const cprox_pose own = {.position = {0, 0, 0}, .orientation = level_turn(r)};
  if (p->part && cprox_body_create_compound((const cprox_body *[]){p->part}, &own, 1, a->ws, &p->carried) != CPROX_OK)
    attack_fail(a, "%s", cprox_workspace_error(a->ws));
  if (rng_index(r, 4) == 0) p->radius = 0.05;
  p->is_signed = rng_index(r, 3) == 0;
  come_down(r, p, p->is_signed ? rng_uniform(r, 0.3, 0.9) : rng_uniform(r, 0.8, 1.5));
  for (size_t i = 0; i < p->n; i++) p->other[i] = rng_in_cube(r, 0.02);
}

/* A point that goes into a body near where two sides are as near. */
static void inside(attack *a, rng *r, problem *p) {
  const size_t kind = rng_index(r, 5) == 0 ? 5 : rng_index(r, 5);
  attack_kind(a, "point inside a %s", NAMES[kind]);
  p->body = make_body(a, r, kind, 2.0);
  p->pose = (cprox_pose){.position = rng_in_cube(r, 0.1), .orientation = rng_quat(r)};
  p->is_signed = true;
  const double away = rng_log_uniform(r, 1e-17, 1e-1);
  const frame f = frame_create(&p->pose, vec(0, 0, 0));
  p->n = 2;
  p->points[0] = frame_to_world(&f, vec_scale(4.0, rng_unit(r)));
  p->points[1] = frame_to_world(&f, vec_add(vec_scale(rng_index(r, 2) ? 0.0 : 0.1, rng_unit(r)), rng_in_cube(r, away)));
}

/* Level intervals and two dips on the way past a box, of any length. */
static void level(attack *a, rng *r, problem *p) {
  attack_kind(a, "level interval or two dips");
  p->body = make_body(a, r, 0, 4.0);
  p->pose = CPROX_POSE_IDENTITY;
  p->splines = true;
  p->n = 5;
  const double high = rng_uniform(r, 2.5, 3.0), low = rng_uniform(r, 2.1, 2.4), length = rng_log_uniform(r, 1e-7, 0.3),
               rise = rng_index(r, 2)   ? 0.0
                      : rng_index(r, 2) ? rng_log_uniform(r, 1e-17, 1e-10)
                                        : rng_log_uniform(r, 1e-4, 1e-1);
  const double x[5] = {-0.3 - length, -length, 0.0, length, 0.3 + length};
  const double z[5] = {high, low, rng_index(r, 2) ? low : low + rise, low + (rng_index(r, 2) ? 0.0 : rise), high};
  for (size_t i = 0; i < p->n; i++) p->points[i] = vec(0.1 * x[i], 0.01 * x[i], z[i]);
}

static void one_case(attack *a, rng *r) {
  problem p = {.n = 0};
  const size_t kind = rng_index(r, 6);
  if (kind == 0)
    inside(a, r, &p);
  else if (kind == 1)
    level(a, r, &p);
  else
    carried(a, r, &p);
  if (!attack_failed(a)) check(a, r, &p);
  cprox_body_free(p.carried);
  cprox_body_free(p.part);
  cprox_body_free(p.body);
}

int main(int argc, char **argv) {
  return attack_main(argc, argv, "ties", one_case);
}
