/* SPDX-License-Identifier: BSD-3-Clause */
/* Superquadrics anywhere, turned by quaternions of any norm: lines that pass them, standing points, each other. The
 * reference is an interval in long double that rests on a point of the body and on a tangent plane of it; it holds its
 * own rounding. */
#include <float.h>
#include <math.h>

#include "attack.h"
#include "support/builders.h"
#include "support/make_curve.h"
#include "support/superquadrics.h"

typedef struct scene {
  superquadric s;
  cprox_body *body, *compound;
  cprox_pose pose, inner; /* `inner`: of the body in the compound */
  vec3 ends[2];           /* of a straight curve */
} scene;

static scene scene_make(attack *a, rng *r) {
  static const double aspects[] = {1.0, 10.0, 30.0, 30.0, 100.0, 100.0, 1e3, 1e3, 1e3, 1e6};
  scene c = {.s = superquadric_random(r, aspects[rng_index(r, 10)])};
  c.body = superquadric_body(&c.s, a->ws);
  c.pose = superquadric_random_pose(r, rng_index(r, 4) == 0 ? 1e-6 : rng_log_uniform(r, 0.1, 1e6));
  const double length = rng_log_uniform(r, 0.1, 1e4);
  for (int i = 0; i < 2; i++) c.ends[i] = vec_add(c.pose.position, rng_in_cube(r, length));
  return c;
}

/* The curve's point at t in the body's frame: differences first, so that the position costs nothing. */
static vec3l local_point(const scene *c, long double t) {
  const cprox_pose turned = {.orientation = c->pose.orientation};
  const vec3l x = ref_vec(c->pose.position);
  const vec3l from = ref_sub(ref_vec(c->ends[0]), x), to = ref_sub(ref_vec(c->ends[1]), x);
  const vec3l p = ref_to_local(&turned, ref_add(ref_scale(1 - t, from), ref_scale(t, to)));
  return c->compound ? ref_to_local(&c->inner, p) : p;
}

static ref_interval distance_at(const scene *c, long double t) {
  return superquadric_distance(&c->s, local_point(c, t), NULL);
}

/* The distance along a line is convex: its least value, from both sides, by thirds. */
static ref_interval least_distance(const scene *c) {
  long double low = 0, high = 1;
  for (int i = 0; i < 150; i++) {
    const long double one = low + (high - low) / 3, two = high - (high - low) / 3;
    if (distance_at(c, one).upper < distance_at(c, two).upper)
      high = two;
    else
      low = one;
  }
  return distance_at(c, (low + high) / 2);
}

static void fail(attack *a, const scene *c, const cprox_result *r, const char *what, ref_interval truth) {
  const cprox_quat q = c->pose.orientation;
  attack_fail(
      a,
      "%s: [%.17g, %.17g] at t = %.17g, true [%.19Lg, %.19Lg]; %s; semi-axes %.17g %.17g %.17g, exponents %.17g %.17g "
      "%.17g, at %.17g %.17g %.17g, quaternion %.17g %.17g %.17g %.17g, from %.17g %.17g %.17g to %.17g %.17g %.17g",
      what, r->lower, r->upper, r->t, truth.lower, truth.upper, c->compound ? "a compound's part" : "alone", c->s.a.x,
      c->s.a.y, c->s.a.z, c->s.p.x, c->s.p.y, c->s.p.z, c->pose.position.x, c->pose.position.y, c->pose.position.z, q.w,
      q.x, q.y, q.z, c->ends[0].x, c->ends[0].y, c->ends[0].z, c->ends[1].x, c->ends[1].y, c->ends[1].z);
}

/* The least of the whole line is looked for only where the point that is named might not be it. */
static void check_line(attack *a, const scene *c, const cprox_result *r) {
  const double places[] = {r->t, 0.0, 1.0, 0.5};
  for (int i = 0; i < 4; i++) {
    const ref_interval there = distance_at(c, places[i]);
    if (r->lower > there.upper) fail(a, c, r, "lower is too high", there);
    if (i > 0 || r->upper >= there.lower) continue;
    const ref_interval least = least_distance(c);
    if (r->upper < least.lower) fail(a, c, r, "upper is too low", least);
  }
}

/* Past the body, or past a compound of it alone. */
static void ask_line(attack *a, rng *r, bool compound) {
  scene c = scene_make(a, r);
  if (compound) {
    const cprox_body *part = c.body;
    c.inner = superquadric_random_pose(r, 10.0);
    cprox_body_create_compound(&part, &c.inner, 1, a->ws, &c.compound);
  }
  const cprox_body *body = compound ? c.compound : c.body;
  cprox_curve *curve = NULL;
  curve_from(describe_bezier(c.ends, 2, 0.0, 1.0), a->ws, &curve);
  static const double epsilons[] = {0.0, 1e-9, 1e-6, 1e-2};
  cprox_options options = accurate(epsilons[rng_index(r, 4)]);
  options.max_nodes = 100;
  cprox_result answer;
  if (attack_check(
          a, cprox_distance(cprox_point_along(curve), cprox_obstacle_at(body, c.pose), &options, a->ws, &answer) >= 0,
          "%s", cprox_workspace_error(a->ws)))
    check_line(a, &c, &answer);
  cprox_curve_free(curve);
  cprox_body_free(c.compound);
  cprox_body_free(c.body);
}

/* In both orders. */
static void ask_point(attack *a, rng *r) {
  scene c = scene_make(a, r);
  c.ends[1] = c.ends[0];
  cprox_body *point = NULL;
  cprox_body_create_point(c.ends[0], a->ws, &point);
  const cprox_obstacle standing = cprox_obstacle_at(point, CPROX_POSE_IDENTITY),
                       body = cprox_obstacle_at(c.body, c.pose);
  const cprox_options options = accurate(rng_index(r, 2) ? 0.0 : 1e-9);
  const bool swapped = rng_index(r, 2);
  cprox_result answer;
  if (attack_check(a, cprox_pair(swapped ? body : standing, swapped ? standing : body, &options, a->ws, &answer) >= 0,
                   "%s", cprox_workspace_error(a->ws)) &&
      answer.upper > 0.0)
    check_line(a, &c, &answer);
  cprox_body_free(point);
  cprox_body_free(c.body);
}

/* What bounds the distance of two from both sides: points of the bodies that are found by going to and fro, and the
 * planes across their differences. Coordinates are those of the world about c's position. */
static ref_interval distance_of_two(const scene *c, const scene *d, vec3l start, double apart) {
  const vec3l shift = ref_sub(ref_vec(d->pose.position), ref_vec(c->pose.position));
  const cprox_pose turn_c = {.orientation = c->pose.orientation}, turn_d = {.orientation = d->pose.orientation};
  const long double rounding = 64 * LDBL_EPSILON * (2 + apart);
  ref_interval found = {-INFINITY, INFINITY};
  vec3l x = start;
  for (int k = 0; k < 8; k++) {
    vec3l local;
    superquadric_distance(&d->s, ref_to_local(&turn_d, ref_sub(x, shift)), &local);
    const vec3l y = ref_add(ref_to_world(&turn_d, local), shift);
    superquadric_distance(&c->s, ref_to_local(&turn_c, y), &local);
    x = ref_to_world(&turn_c, local);
    const vec3l n = ref_sub(x, y);
    const long double length = ref_norm(n);
    found.upper = fminl(found.upper, length + rounding);
    const long double reach = superquadric_reach(&c->s, ref_to_local(&turn_c, ref_scale(-1, n))) +
                              superquadric_reach(&d->s, ref_to_local(&turn_d, n));
    if (length > 0) found.lower = fmaxl(found.lower, (-ref_dot(n, shift) - reach) / length - rounding);
  }
  return found;
}

static void ask_two(attack *a, rng *r) {
  scene c = scene_make(a, r), d = scene_make(a, r);
  const double apart = rng_log_uniform(r, 0.1, 1e4);
  d.pose.position = vec_add(c.pose.position, rng_in_cube(r, apart));
  const cprox_options options = accurate(rng_index(r, 2) ? 0.0 : 1e-9);
  cprox_result answer;
  if (attack_check(a,
                   cprox_pair(cprox_obstacle_at(c.body, c.pose), cprox_obstacle_at(d.body, d.pose), &options, a->ws,
                              &answer) >= 0,
                   "%s", cprox_workspace_error(a->ws)) &&
      answer.upper > 0.0) {
    const vec3l start = ref_sub(ref_vec(answer.witness_mover), ref_vec(c.pose.position));
    const ref_interval truth = distance_of_two(&c, &d, start, 2.0 * apart);
    if (answer.lower > truth.upper) fail(a, &c, &answer, "of two, lower is too high", truth);
    if (answer.upper < truth.lower) fail(a, &c, &answer, "of two, upper is too low", truth);
  }
  cprox_body_free(c.body);
  cprox_body_free(d.body);
}

static void one_case(attack *a, rng *r) {
  const size_t kind = rng_index(r, 10);
  attack_kind(a, kind < 3 ? "a line" : kind < 5 ? "a line, compound" : kind < 9 ? "a point" : "two superquadrics");
  if (kind < 5)
    ask_line(a, r, kind >= 3);
  else if (kind < 9)
    ask_point(a, r);
  else
    ask_two(a, r);
}

int main(int argc, char **argv) {
  return attack_main(argc, argv, "superquadrics", one_case);
}
