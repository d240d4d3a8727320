/* SPDX-License-Identifier: BSD-3-Clause */
/* Lengths of any size, from those whose squares vanish to those whose squares overflow: a query is refused with a
 * reason, or its interval is true. The reference: every body holds the origin of its frame and lies in a ball about it,
 * so that the distance of the origins, in long double, bounds that of the bodies from both sides. */
#include <float.h>
#include <math.h>

#include "attack.h"
#include "support/builders.h"
#include "support/make_curve.h"
#include "support/reference.h"

enum { KINDS = 13 };
static const char *const KIND[KINDS] = {"point",  "sphere",    "box",         "capsule", "cylinder",
                                        "cone",   "ellipsoid", "polytope",    "support", "mesh",
                                        "points", "boxes",     "superquadric"};

typedef struct thing {
  size_t kind;
  double size; /* the body is within twice this of its frame's origin */
  cprox_body *body;
  cprox_pose pose;
} thing;

static void support_of_ball(const void *shape, const double direction[3], double point[3]) {
  const double *radius = shape;
  const double most = fmax(fabs(direction[0]), fmax(fabs(direction[1]), fabs(direction[2])));
  double norm = 0.0;
  for (int i = 0; i < 3; i++) norm += direction[i] / most * (direction[i] / most);
  for (int i = 0; i < 3; i++) point[i] = *radius * (direction[i] / most / sqrt(norm));
}

/* Anything, or within what squares hold, or as in a room. */
static double length(rng *r) {
  switch (rng_index(r, 4)) {
    case 0: return rng_log_uniform(r, 1e-170, 1e170);
    case 1: return rng_log_uniform(r, 1e-70, 1e70);
    default: return rng_log_uniform(r, 1e-3, 1e3);
  }
}

static bool is_usual(double x) {
  return x == 0.0 || (fabs(x) >= 1e-3 && fabs(x) <= 1e3);
}

static cprox_status make(attack *a, rng *r, thing *t) {
  const double s = t->size, h = 0.5 * s;
  const vec3 corner[4] = {{0, 0, 0}, {s, 0, 0}, {0, s, 0}, {0, 0, s}}, low = {-h, -h, -h}, high = {h, h, h};
  const uint32_t face[4][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  cprox_workspace *w = a->ws;
  cprox_body **body = &t->body;
  switch (t->kind) {
    case 0: return cprox_body_create_point(vec(0, 0, 0), w, body);
    case 1: return cprox_body_create_sphere(s, w, body);
    case 2: return cprox_body_create_box(vec(s, h, s), w, body);
    case 3: return cprox_body_create_capsule(s, h, w, body);
    case 4: return cprox_body_create_cylinder(s, h, w, body);
    case 5: return cprox_body_create_cone(s, h, w, body);
    case 6: return cprox_body_create_ellipsoid(vec(s, h, 0.1 * s), w, body);
    case 7: return cprox_body_create_polytope(corner, 4, w, body);
    case 8: return cprox_body_create_support(support_of_ball, &t->size, vec(0, 0, 0), s, 0, 0, w, body);
    case 9: return cprox_body_create_mesh(corner, 4, face, 4, rng_index(r, 2), SIZE_MAX, w, body);
    case 10: return cprox_body_create_points(corner, 4, rng_index(r, 2) ? 0.0 : h, SIZE_MAX, w, body);
    case 11: return cprox_body_create_boxes(&low, &high, 1, SIZE_MAX, w, body);
    default: return cprox_body_create_superquadric(vec(s, h, s), vec(2, 3, 1.5), w, body);
  }
}

/* What is asked about: b, and a that stands, is carried along a line, or is a ball along a line. */
typedef struct setting {
  thing a, b;
  vec3 ends[2];
  double margin, radius;
  cprox_options options;
  double delta;
  cprox_curve *curve;
} setting;

static bool setting_make(attack *a, rng *r, setting *s) {
  *s = (setting){.a.kind = rng_index(r, KINDS), .b.kind = rng_index(r, KINDS), .options = CPROX_OPTIONS_DEFAULT};
  const double away = length(r), step = length(r);
  s->a.size = length(r), s->b.size = length(r);
  s->margin = rng_index(r, 3) ? 0.0 : length(r);
  s->radius = rng_index(r, 3) ? 0.0 : length(r);
  s->delta = rng_index(r, 3) ? away : length(r);
  s->options.epsilon = rng_index(r, 2) ? 1e-6 : rng_index(r, 2) ? 1e-6 * away : 0.0;
  s->options.relative_epsilon = rng_index(r, 2) ? 0.0 : 1e-3;
  s->options.max_nodes = 200;
  s->a.pose = rng_pose(r, 1.0), s->b.pose = rng_pose(r, 1.0);
  s->a.pose.position = rng_in_cube(r, rng_index(r, 2) ? 0.0 : length(r));
  s->b.pose.position = vec_add(s->a.pose.position, rng_in_cube(r, away));
  for (int i = 0; i < 2; i++) s->ends[i] = vec_add(s->a.pose.position, rng_in_cube(r, step));
  const bool usual = is_usual(away) && is_usual(step) && is_usual(s->a.size) && is_usual(s->b.size) &&
                     is_usual(s->margin) && is_usual(s->radius) && is_usual(s->delta) &&
                     vec_norm(s->a.pose.position) < 2e3;
  const bool made = make(a, r, &s->a) >= 0 && make(a, r, &s->b) >= 0 &&
                    curve_from(describe_bezier(s->ends, 2, 0.0, 1.0), a->ws, &s->curve) >= 0;
  attack_check(a, made || !usual, "usual sizes are refused: %s", cprox_workspace_error(a->ws));
  return made;
}

static void setting_free(setting *s) {
  cprox_body_free(s->a.body);
  cprox_body_free(s->b.body);
  cprox_curve_free(s->curve);
}

/* The distance between `reach` of a line (or of its first end) and b: no less than low, no more than high. */
typedef struct truth {
  long double low, high;
} truth;

static truth truth_of(const setting *s, bool line, long double reach) {
  const vec3l x = ref_vec(s->b.pose.position), p = ref_vec(line ? s->ends[0] : s->a.pose.position);
  const long double far = ref_norm(ref_sub(p, x));
  const long double near = line ? ref_point_segment(x, p, ref_vec(s->ends[1])) : far;
  const long double both = reach + 2.0L * (long double)s->b.size;
  return (truth){near - both, far};
}

static void check(attack *a, const setting *s, const char *what, cprox_status status, const cprox_result *r, truth t) {
  if (status < 0) {
    attack_check(a, cprox_workspace_error(a->ws)[0] != '\0', "%s of %s and %s is refused without a reason", what,
                 KIND[s->a.kind], KIND[s->b.kind]);
    attack_count(a, "refused");
    return;
  }
  /* signed distances of what overlaps are below 0: then low is no bound that says anything */
  const long double lower = r->lower, upper = r->upper;
  const bool good = lower <= upper && lower <= t.high * (1 + 1e-12L) && upper >= t.low * (t.low > 0 ? 1 - 1e-12L : 1) &&
                    isfinite(r->lower) && (isinf(r->upper) || !isnan(r->t));
  attack_check(a, good,
               "%s of %s %.17g and %s %.17g: [%.17g, %.17g] %s; the truth is in [%.19Lg, %.19Lg]; margin %g, radius "
               "%g, epsilon "
               "%g, from %g %g %g, to %g %g %g, a at %g %g %g, b at %g %g %g",
               what, KIND[s->a.kind], s->a.size, KIND[s->b.kind], s->b.size, r->lower, r->upper,
               cprox_status_name(status), t.low, t.high, s->margin, s->radius, s->options.epsilon, s->ends[0].x,
               s->ends[0].y, s->ends[0].z, s->ends[1].x, s->ends[1].y, s->ends[1].z, s->a.pose.position.x,
               s->a.pose.position.y, s->a.pose.position.z, s->b.pose.position.x, s->b.pose.position.y,
               s->b.pose.position.z);
}

/* Every query of a moving a and a standing b. */
static void ask_moving(attack *a, rng *r, setting *s) {
  const bool carried = rng_index(r, 3) == 0;
  cprox_mover mover = carried ? cprox_body_along(s->a.body, s->curve) : cprox_tube_along(s->curve, s->radius);
  const cprox_obstacle target = cprox_with_margin(cprox_obstacle_at(s->b.body, s->b.pose), s->margin);
  const truth t =
      truth_of(s, true, (carried ? 2.0L * (long double)s->a.size : (long double)s->radius) + (long double)s->margin);
  cprox_result result = {0};
  s->options.signed_distance = rng_index(r, 4) == 0;
  cprox_status status = cprox_distance(mover, target, &s->options, a->ws, &result);
  check(a, s, "distance", status, &result, t);
  cprox_gradient gradient;
  if (status >= 0) cprox_distance_gradient(mover, target, &s->options, &result, a->ws, &gradient);
  s->options.signed_distance = false;
  check(a, s, "tolerance", cprox_tolerance(mover, target, s->delta, &s->options, a->ws, &result), &result, t);
  check(a, s, "collision", cprox_collision(mover, target, &s->options, a->ws, &result), &result, t);
  check(a, s, "time of contact", cprox_time_of_contact(mover, target, &s->options, a->ws, &result), &result, t);

  cprox_obstacles *set = NULL;
  if (cprox_obstacles_create(&target, 1, CPROX_INDEX_BVH, a->ws, &set) >= 0)
    check(a, s, "set", cprox_obstacles_distance(set, mover, &s->options, a->ws, &result, NULL), &result, t);
  cprox_obstacles_free(set);
  cprox_obstacles *batch = NULL;
  if (cprox_obstacles_create(&target, 1, CPROX_INDEX_BATCH, a->ws, &batch) >= 0)
    check(a, s, "batch", cprox_obstacles_distance_batch(batch, &mover, 0, 1, &s->options, a->ws, &result), &result, t);
  cprox_obstacles_free(batch);
}

/* A ball or a body on a link that slides along the line. */
static void ask_robot(attack *a, setting *s) {
  const vec3 way = vec_sub(s->ends[1], s->ends[0]);
  const cprox_link link = {.parent = -1,
                           .type = CPROX_JOINT_PRISMATIC,
                           .origin = {.position = s->ends[0], .orientation = {1, 0, 0, 0}},
                           .axis = way,
                           .multiplier = 1.0};
  const cprox_link_geometry geometry = {
      .body = s->a.body, .pose = {.orientation = s->a.pose.orientation}, .margin = s->radius};
  const int32_t variable = 0;
  const double from = 0.0, to = vec_norm(way);
  const cprox_waypoint points[2] = {{.time = 0.0, .positions = &from}, {.time = 1.0, .positions = &to}};
  const cprox_obstacle target = cprox_with_margin(cprox_obstacle_at(s->b.body, s->b.pose), s->margin);
  cprox_robot *robot = NULL;
  cprox_motion *motion = NULL;
  cprox_result result = {0};
  if (cprox_robot_create(&link, 1, &geometry, 1, 1, a->ws, &robot) >= 0 &&
      cprox_motion_create(robot,
                          &(cprox_motion_description){.kind = CPROX_MOTION_WAYPOINTS,
                                                      .variables = &variable,
                                                      .n_variables = 1,
                                                      .waypoints = points,
                                                      .n_waypoints = 2,
                                                      .interpolation = CPROX_INTERPOLATION_LINEAR},
                          a->ws, &motion) >= 0) {
    const truth t = truth_of(s, true, 2.0L * (long double)s->a.size + (long double)s->radius + (long double)s->margin);
    const cprox_mover mover = cprox_robot_along(motion, NULL, 0);
    check(a, s, "robot", cprox_distance(mover, target, &s->options, a->ws, &result), &result, t);
    check(a, s, "robot's time of contact", cprox_time_of_contact(mover, target, &s->options, a->ws, &result), &result,
          t);
  }
  cprox_motion_free(motion);
  cprox_robot_free(robot);
}

static void ask_pair(attack *a, setting *s) {
  const truth t = truth_of(s, false, 2.0L * (long double)s->a.size + (long double)s->margin + (long double)s->radius);
  const cprox_obstacle one = cprox_with_margin(cprox_obstacle_at(s->a.body, s->a.pose), s->radius),
                       two = cprox_with_margin(cprox_obstacle_at(s->b.body, s->b.pose), s->margin);
  cprox_result result = {0};
  check(a, s, "pair", cprox_pair(one, two, &s->options, a->ws, &result), &result, t);
  check(a, s, "pair, swapped", cprox_pair(two, one, &s->options, a->ws, &result), &result, t);
}

/* Two curves: the other runs from b's position to where the first ends. */
static void ask_curves(attack *a, rng *r, setting *s) {
  const vec3 ends[2] = {s->b.pose.position, vec_add(s->b.pose.position, rng_in_cube(r, s->b.size))};
  cprox_curve *other = NULL;
  if (curve_from(describe_bezier(ends, 2, 0.0, 1.0), a->ws, &other) < 0) return;
  const truth t = truth_of(s, true, (long double)s->radius + (long double)s->margin);
  cprox_result result = {0};
  check(a, s, "curve",
        cprox_distance(cprox_tube_along(s->curve, s->radius), cprox_obstacle_curve(other, s->margin), &s->options,
                       a->ws, &result),
        &result, t);
  cprox_curve_free(other);
}

/* ---- the same in other units: lengths times a power of 2, which rounds nothing ---- */

static vec3 scaled(double by, vec3 p) {
  return vec_scale(by, p);
}

/* Two balls' or bodies' intervals, brought to the same unit, hold the same distance: they meet. */
static void check_units(attack *a, const setting *s, const char *what, double by, const cprox_result *r,
                        const cprox_result *other) {
  attack_check(a, other->lower <= by * r->upper && by * r->lower <= other->upper && isfinite(other->lower),
               "%s of %s %.17g and %s %.17g, times %g: [%.17g, %.17g] %s became [%.17g, %.17g] %s", what,
               KIND[s->a.kind], s->a.size, KIND[s->b.kind], s->b.size, by, r->lower, r->upper,
               cprox_status_name(r->status), other->lower / by, other->upper / by, cprox_status_name(other->status));
}

/* Bodies near each other or overlapping, in metres and in a unit that is up to 1e60 times as long or as short. */
static void ask_in_other_units(attack *a, rng *r) {
  setting s = {.a.kind = rng_index(r, KINDS - 1), .b.kind = rng_index(r, KINDS - 1), .options = accurate(1e-6)}, o;
  s.a.size = rng_log_uniform(r, 0.01, 1.0), s.b.size = rng_log_uniform(r, 0.01, 1.0);
  s.a.pose = rng_pose(r, 1.0), s.b.pose = rng_pose(r, 1.0);
  s.b.pose.position = vec_add(s.a.pose.position, rng_in_cube(r, rng_index(r, 2) ? 1.0 : 0.1));
  s.margin = rng_index(r, 3) ? 0.0 : rng_uniform(r, 0.0, 0.3);
  for (int i = 0; i < 2; i++) s.ends[i] = vec_add(s.a.pose.position, rng_in_cube(r, 1.0));
  s.options.signed_distance = rng_index(r, 2);
  s.options.max_nodes = 2000;
  const double by = ldexp(1.0, (int)rng_index(r, 393) - 196);
  o = s;
  o.a.size *= by, o.b.size *= by, o.margin *= by, o.options.epsilon *= by;
  o.a.pose.position = scaled(by, s.a.pose.position), o.b.pose.position = scaled(by, s.b.pose.position);
  for (int i = 0; i < 2; i++) o.ends[i] = scaled(by, s.ends[i]);
  const rng before = *r; /* the same choices for both */
  bool made = make(a, r, &s.a) >= 0 && make(a, r, &s.b) >= 0;
  *r = before;
  made = made && make(a, r, &o.a) >= 0 && make(a, r, &o.b) >= 0 &&
         curve_from(describe_bezier(s.ends, 2, 0.0, 1.0), a->ws, &s.curve) >= 0 &&
         curve_from(describe_bezier(o.ends, 2, 0.0, 1.0), a->ws, &o.curve) >= 0;
  attack_check(a, made, "refused: %s", cprox_workspace_error(a->ws));
  const cprox_obstacle b = cprox_with_margin(cprox_obstacle_at(s.b.body, s.b.pose), s.margin),
                       ob = cprox_with_margin(cprox_obstacle_at(o.b.body, o.b.pose), o.margin);
  cprox_result one = {0}, two = {0};
  const bool pair = rng_index(r, 2);
  const cprox_mover mover = rng_index(r, 2) ? cprox_tube_along(s.curve, s.margin) : cprox_body_along(s.a.body, s.curve);
  cprox_mover other = mover;
  other.curve = o.curve, other.body = mover.body ? o.a.body : NULL, other.radius = by * mover.radius;
  if (made) {
    const cprox_status first = pair ? cprox_pair(cprox_obstacle_at(s.a.body, s.a.pose), b, &s.options, a->ws, &one)
                                    : cprox_distance(mover, b, &s.options, a->ws, &one);
    const cprox_status second = pair ? cprox_pair(cprox_obstacle_at(o.a.body, o.a.pose), ob, &o.options, a->ws, &two)
                                     : cprox_distance(other, ob, &o.options, a->ws, &two);
    if (attack_check(a, (first < 0) == (second < 0), "%s and %s, times %g: %s, %s", KIND[s.a.kind], KIND[s.b.kind], by,
                     cprox_status_name(first), cprox_workspace_error(a->ws)) &&
        first >= 0)
      check_units(a, &s, pair ? "pair" : "distance", by, &one, &two);
  }
  setting_free(&s);
  setting_free(&o);
}

static void one_case(attack *a, rng *r) {
  setting s;
  const size_t kind = rng_index(r, 6);
  static const char *const name[6] = {"moving", "robot", "pair", "curves", "other units", "other units"};
  attack_kind(a, "%s", name[kind]);
  if (kind >= 4) {
    ask_in_other_units(a, r);
    return;
  }
  if (setting_make(a, r, &s)) {
    if (kind == 0) ask_moving(a, r, &s);
    if (kind == 1) ask_robot(a, &s);
    if (kind == 2) ask_pair(a, &s);
    if (kind == 3) ask_curves(a, r, &s);
  } else {
    attack_count(a, "refused when made");
  }
  setting_free(&s);
}

int main(int argc, char **argv) {
  return attack_main(argc, argv, "lengths", one_case);
}
