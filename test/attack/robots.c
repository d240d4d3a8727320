/* SPDX-License-Identifier: BSD-3-Clause */
/* Robots: trees of every type of joint with bodies of many kinds on their links, along few and many waypoints, against
 * obstacles, against themselves, and both at once; every query that robots have.
 *
 * Held against poses in long double (support/robots.h) and nearest points by definition (bodies.h). Nearest points
 * taken in turns give two points, one of each body: their distance is an upper bound of the true one, so no lower bound
 * of the core may be above it, at any time. Supports along the line between them give a lower bound where both are
 * convex, which no upper bound may be below. Witness points must lie in their bodies and be as near as said. Verdicts
 * and times of contact must follow. */
#include <math.h>
#include <stdio.h>

#include "bodies.h"
#include "support/of_list.h"
#include "support/robots.h"

enum { OBSTACLES = 3, TURNS = 12, SAMPLES = 10, REFINEMENTS = 14, PAIRS = 3 };

/* Times are rounded to double and joints turn at up to 1e2 rad/s or m/s in reaches of 1e1 m: 1e3 * 1e-15 m, and poses
 * in double by 1e-13 m. */
static const long double ROOM = 1e-11L;

static const cprox_pose HERE = {.orientation = {1, 0, 0, 0}};

typedef struct world {
  attack *a;
  rng *r;
  test_robot t;
  random_body links[TEST_MAX_LINKS], bodies[OBSTACLES];
  cprox_pose poses[OBSTACLES];
  double margins[OBSTACLES];
  cprox_obstacle targets[OBSTACLES];
  bool self, obstacles; /* what is asked about */
  cprox_mover mover;
  double t0, t1;
} world;

/* Two bodies: a geometry, and an obstacle or another geometry. */
typedef struct pair {
  size_t geometry, other;
  bool self;
} pair;

/* ---- what is where ---- */

typedef struct placed {
  const random_body *body;
  ref_pose link;     /* in the world; of an obstacle the identity */
  cprox_pose offset; /* of the body in it */
  double margin;
} placed;

static placed place_geometry(const world *w, const ref_pose *links, size_t g) {
  const cprox_link_geometry *geometry = &w->t.geometries[g];
  return (placed){&w->links[g], links[geometry->link], geometry->pose, geometry->margin};
}

static placed place_other(const world *w, const ref_pose *links, pair p) {
  if (p.self) return place_geometry(w, links, p.other);
  return (placed){&w->bodies[p.other], {.q = {0, 0, 0, 1}}, w->poses[p.other], w->margins[p.other]};
}

static vec3l nearest_on(const placed *s, vec3l x) {
  vec3l q;
  body_nearest(s->body, &HERE, ref_to_local(&s->offset, ref_pose_undo(&s->link, x)), &q);
  return ref_pose_apply(&s->link, ref_to_world(&s->offset, q));
}

static long double support_of(const placed *s, vec3l d) {
  const vec3l in_link = ref_pose_undo(&(ref_pose){.q = {s->link.q[0], s->link.q[1], s->link.q[2], s->link.q[3]}}, d);
  return ref_dot(d, s->link.p) + body_support(s->body, &s->offset, in_link);
}

/* Bounds of the distance of a pair at one time, margins taken off and not cut at 0. */
typedef struct gap {
  long double upper, lower;
  long double room; /* of the bodies that the core was given */
} gap;

static gap gap_at(const world *w, pair p, long double time) {
  long double values[TEST_MAX_VARIABLES + 1];
  ref_pose links[TEST_MAX_LINKS];
  robot_ref_values(&w->t, time, values);
  robot_ref_links(&w->t, values, links);
  const placed a = place_geometry(w, links, p.geometry), b = place_other(w, links, p);
  vec3l x = ref_pose_apply(&a.link, ref_vec(a.offset.position)), y = x;
  long double before = HUGE_VALL, apart = HUGE_VALL;
  for (int i = 0; i < TURNS; i++) {
    y = nearest_on(&b, x);
    x = nearest_on(&a, y);
    apart = ref_norm(ref_sub(x, y));
    if (!(apart < before * (1.0L - 1e-9L))) break;
    before = apart;
  }
  gap g = {.upper = apart - a.margin - b.margin,
           .lower = -HUGE_VALL,
           .room = ROOM + (long double)a.body->slack + (long double)b.body->slack};
  if (a.body->convex && b.body->convex && apart > 0.0L) {
    const vec3l n = ref_scale(1.0L / apart, ref_sub(x, y));
    const long double low = -support_of(&a, ref_scale(-1.0L, n)) - support_of(&b, n) - a.margin - b.margin;
    if (isfinite(low)) g.lower = low;
  }
  return g;
}

/* ---- random worlds ---- */

/* Not every body may be on a link: a halfspace and solid surfaces may not. */
static bool link_takes(const cprox_body *body) {
  const cprox_link link = {.parent = -1, .type = CPROX_JOINT_FIXED, .origin = HERE, .axis = {0, 0, 1}, .multiplier = 1};
  const cprox_link_geometry geometry = {.body = body, .pose = HERE};
  cprox_robot *robot = NULL;
  const bool taken = cprox_robot_create(&link, 1, &geometry, 1, 0, NULL, &robot) == CPROX_OK;
  cprox_robot_free(robot);
  return taken;
}

/* And not every body may be an obstacle of a robot. */
static bool robot_meets(world *w, const cprox_body *body) {
  const cprox_obstacle target = cprox_obstacle_at(body, HERE);
  cprox_result x;
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.max_nodes = 1;
  return distance_of_list(cprox_robot_along(w->t.motion, NULL, 0), &target, 1, &options, w->a->ws, &x, NULL) >= 0;
}

static bool make_links(world *w, double scale) {
  for (size_t i = 0; i < w->t.n_links; i++) {
    int tries = 0;
    do {
      if (tries) body_free(&w->links[i]);
      if (tries++ == 20) return false;
      body_make(w->a, w->r, rng_index(w->r, 3) ? rng_index(w->r, 8) : rng_index(w->r, BODY_KINDS), scale, &w->links[i]);
      if (attack_failed(w->a)) return false;
    } while (!link_takes(w->links[i].body));
    cprox_body_free((cprox_body *)w->t.geometries[i].body);
    w->t.geometries[i].body = w->links[i].body;
  }
  return true;
}

static bool make_obstacles(world *w, double scale) {
  for (size_t i = 0; i < OBSTACLES; i++) {
    int tries = 0;
    do {
      if (tries) body_free(&w->bodies[i]);
      if (tries++ == 20) return false;
      body_make(w->a, w->r, rng_index(w->r, BODY_KINDS), 2.0 * scale, &w->bodies[i]);
      if (attack_failed(w->a)) return false;
    } while (!robot_meets(w, w->bodies[i].body));
    w->poses[i] = rng_pose(w->r, 1.5);
    w->margins[i] = rng_index(w->r, 2) ? 0.0 : rng_uniform(w->r, 0.0, 0.05);
    w->targets[i] = cprox_with_margin(cprox_obstacle_at(w->bodies[i].body, w->poses[i]), w->margins[i]);
  }
  return true;
}

/* Few waypoints as robot_make() draws them, or many in small steps. */
static bool world_make(world *w, double scale) {
  rng *r = w->r;
  const double speed = rng_log_uniform(r, 0.05, 2.0);
  robot_make(r, speed, &w->t);
  const bool many = rng_index(r, 2);
  if (many) {
    const size_t n = 6 + rng_index(r, TEST_MAX_WAYPOINTS - 6);
    robot_draw_motion(r, speed / sqrt((double)n), n, &w->t);
  }
  if (!make_links(w, scale)) return false;
  robot_rebuild(&w->t);
  if (!make_obstacles(w, scale)) return false;
  const cprox_motion_info info = cprox_motion_get_info(w->t.motion);
  w->t0 = info.t0, w->t1 = info.t1;
  return true;
}

/* The bodies of links belong to the robot: robot_free() frees them. */
static void world_free(world *w) {
  robot_free(&w->t);
  for (size_t i = 0; i < TEST_MAX_LINKS; i++) {
    for (size_t k = 0; k < BODY_PARTS + 1; k++) cprox_body_free(w->links[i].owned[k]);
  }
  for (size_t i = 0; i < OBSTACLES; i++)
    if (w->bodies[i].body) body_free(&w->bodies[i]);
}

/* ---- pairs ---- */

/* Is the pair asked about, as cprox_robot_along() and cprox_robot_self() say? */
static bool is_asked(const world *w, pair p) {
  if (!p.self) return w->obstacles && cprox_motion_get_link_info(w->t.motion, (int32_t)p.geometry, -1).n_moved > 0;
  if (!w->self || p.geometry == p.other) return false;
  const cprox_link_info between = cprox_motion_get_link_info(w->t.motion, (int32_t)p.geometry, (int32_t)p.other);
  return between.n_joints >= 2 && between.n_moved > 0;
}

static bool draw_pair(const world *w, pair *p) {
  for (int tries = 0; tries < 20; tries++) {
    const bool self = w->self && (!w->obstacles || rng_index(w->r, 2));
    *p = (pair){rng_index(w->r, w->t.n_links), rng_index(w->r, self ? w->t.n_links : OBSTACLES), self};
    if (is_asked(w, *p)) return true;
  }
  return false;
}

/* The pair that a result is about. */
static bool pair_of_result(const world *w, const cprox_result *x, pair *p) {
  const int32_t first = w->obstacles ? OBSTACLES : 0, index = x->obstacle_index;
  *p = (pair){(size_t)x->mover_part, (size_t)(index < first ? index : index - first), index >= first};
  return x->mover_part >= 0 && (size_t)x->mover_part < w->t.n_links && index >= 0 &&
         p->other < (p->self ? w->t.n_links : OBSTACLES) && is_asked(w, *p);
}

/* ---- what holds of results ---- */

#define RESULT "[%.17g, %.17g] (%s, %s) at t = %.17g"
#define SHOWN(x) (x)->lower, (x)->upper, cprox_status_name((x)->status), cprox_verdict_name((x)->verdict), (x)->t

/* The least distance of a pair that is found over [t0, t1]: samples, then smaller and smaller steps about the best. */
static gap least_gap(const world *w, pair p, double t0, double t1, double begin, double *where) {
  gap best = gap_at(w, p, begin);
  *where = begin;
  for (int i = 0; i <= SAMPLES; i++) {
    const double t = fmin(t0 + (t1 - t0) * (i + rng_uniform(w->r, 0.0, 1.0)) / SAMPLES, t1);
    const gap g = gap_at(w, p, t);
    if (g.upper < best.upper) best = g, *where = t;
  }
  double step = (t1 - t0) / SAMPLES;
  for (int i = 0; i < REFINEMENTS; i++, step *= 0.5) {
    for (int side = -1; side <= 1; side += 2) {
      const double t = fmin(fmax(*where + side * step, t0), t1);
      const gap g = gap_at(w, p, t);
      if (g.upper < best.upper) best = g, *where = t;
    }
  }
  return best;
}

/* No pair comes nearer than `lower` over [t0, t1]: drawn pairs, and that of the result. */
static void check_lower(world *w, const cprox_result *x, double t0, double t1) {
  pair p;
  for (int i = 0; i <= PAIRS && !attack_failed(w->a); i++) {
    if (i == 0 ? !pair_of_result(w, x, &p) : !draw_pair(w, &p)) continue;
    double where;
    const double begin = i == 0 && x->t > t0 && x->t < t1 ? x->t : t0;
    const gap g = least_gap(w, p, t0, t1, begin, &where);
    attack_check(w->a, fmaxl(g.upper, 0.0L) >= x->lower - g.room,
                 RESULT ", but geometry %zu and %s %zu (%s, %s) are %.19Lg apart at %.17g", SHOWN(x), p.geometry,
                 p.self ? "geometry" : "obstacle", p.other, w->links[p.geometry].name,
                 p.self ? w->links[p.other].name : w->bodies[p.other].name, g.upper, where);
  }
}

static void check_witness(world *w, const cprox_result *x, pair p, const gap *g) {
  long double values[TEST_MAX_VARIABLES + 1];
  ref_pose links[TEST_MAX_LINKS];
  robot_ref_values(&w->t, x->t, values);
  robot_ref_links(&w->t, values, links);
  const placed a = place_geometry(w, links, p.geometry), b = place_other(w, links, p);
  const vec3l on_a = ref_vec(x->witness_mover), on_b = ref_vec(x->witness_obstacle);
  const long double off_a = ref_norm(ref_sub(nearest_on(&a, on_a), on_a)) - a.margin;
  const long double off_b = ref_norm(ref_sub(nearest_on(&b, on_b), on_b)) - b.margin;
  const long double room = g->room + 1e-9L;
  attack_check(w->a, off_a <= room, RESULT ": the robot's witness is %.3Lg off geometry %zu (%s)", SHOWN(x), off_a,
               p.geometry, a.body->name);
  attack_check(w->a, off_b <= room, RESULT ": the other witness is %.3Lg off %s %zu (%s)", SHOWN(x), off_b,
               p.self ? "geometry" : "obstacle", p.other, b.body->name);
  const long double between = ref_norm(ref_sub(on_a, on_b));
  if (x->upper > 0.0)
    attack_check(w->a, fabsl(between - x->upper) <= room, RESULT ": the witnesses are %.17Lg apart", SHOWN(x), between);
}

static void check_upper(world *w, const cprox_result *x) {
  pair p;
  if (isinf(x->upper)) return;
  if (!attack_check(w->a, pair_of_result(w, x, &p), RESULT ": parts %d and %d are not asked about", SHOWN(x),
                    x->mover_part, x->obstacle_index))
    return;
  const gap g = gap_at(w, p, x->t);
  attack_check(w->a, g.lower <= x->upper + g.room, RESULT ", but a plane proves %.19Lg there", SHOWN(x), g.lower);
  check_witness(w, x, p, &g);
}

/* t is not a number where no distance was measured. */
static bool is_sound(world *w, const cprox_result *x) {
  const bool measured = isfinite(x->upper);
  return attack_check(w->a, x->lower <= x->upper && (!measured || (x->t >= w->t0 && x->t <= w->t1)),
                      RESULT " is not sound", SHOWN(x));
}

static void check_result(world *w, const cprox_result *x) {
  if (!is_sound(w, x)) return;
  check_lower(w, x, w->t0, w->t1);
  check_upper(w, x);
}

static bool answered(world *w, cprox_status status) {
  attack_count(w->a, cprox_status_name(status));
  return attack_check(w->a, status >= 0, "%s: %s", cprox_status_name(status), cprox_workspace_error(w->a->ws));
}

/* ---- queries ---- */

static const cprox_obstacle *targets_of(const world *w, size_t *n) {
  *n = w->obstacles ? OBSTACLES : 0;
  return w->obstacles ? w->targets : NULL;
}

/* Status ok promises it. Against nothing both ends are infinite. */
static void check_width(world *w, const cprox_result *x, const cprox_options *options) {
  if (isinf(x->lower)) return;
  const double width = fmax(options->epsilon, isinf(x->upper) ? 0.0 : options->relative_epsilon * x->upper);
  attack_check(w->a, x->upper - x->lower <= width * (1.0 + 1e-12) + 1e-12, RESULT " is too wide", SHOWN(x));
}

static void ask_distance(world *w, const cprox_options *options) {
  size_t n;
  const cprox_obstacle *targets = targets_of(w, &n);
  cprox_result x;
  if (!answered(w, distance_of_list(w->mover, targets, n, options, w->a->ws, &x, NULL))) return;
  check_result(w, &x);
  if (x.status == CPROX_OK) check_width(w, &x, options);
}

static void ask_tolerance(world *w, const cprox_options *options) {
  size_t n;
  const cprox_obstacle *targets = targets_of(w, &n);
  const double delta = rng_index(w->r, 3) ? rng_log_uniform(w->r, 1e-4, 1.0) : 0.0;
  cprox_result x;
  if (!answered(w, delta > 0.0 ? tolerance_of_list(w->mover, targets, n, delta, options, w->a->ws, &x, NULL)
                               : collision_of_list(w->mover, targets, n, options, w->a->ws, &x, NULL)))
    return;
  check_result(w, &x);
  attack_count(w->a, cprox_verdict_name(x.verdict));
  if (x.verdict == CPROX_VERDICT_UNDECIDED && x.status == CPROX_OK) check_width(w, &x, options);
  if (x.verdict == CPROX_VERDICT_CLEAR) attack_check(w->a, x.lower > delta, "delta %.17g: " RESULT, delta, SHOWN(&x));
  if (x.verdict == CPROX_VERDICT_VIOLATED)
    attack_check(w->a, x.upper <= delta, "delta %.17g: " RESULT, delta, SHOWN(&x));
}

static void ask_time_of_contact(world *w, const cprox_options *asked) {
  size_t n;
  const cprox_obstacle *targets = targets_of(w, &n);
  cprox_options options = *asked;
  options.relative_epsilon = 0.0; /* it does not apply */
  cprox_result x;
  if (!answered(w, time_of_contact_of_list(w->mover, targets, n, &options, w->a->ws, &x))) return;
  if (!is_sound(w, &x)) return;
  attack_count(w->a, cprox_verdict_name(x.verdict));
  check_lower(w, &x, w->t0, w->t1);
  attack_check(w->a, x.t_contact_lower >= w->t0 && x.t_contact_lower <= w->t1, "t_contact_lower = %.17g",
               x.t_contact_lower);
  /* before it nothing overlaps, by more than what the reference cannot tell */
  pair p;
  for (int i = 0; i < PAIRS && !attack_failed(w->a); i++) {
    if (!draw_pair(w, &p) || x.t_contact_lower <= w->t0) continue;
    double where;
    const gap g = least_gap(w, p, w->t0, x.t_contact_lower, w->t0, &where);
    attack_check(w->a, g.upper >= -g.room,
                 RESULT ", free before %.17g, but geometry %zu and %zu overlap by %.3Lg at %.17g", SHOWN(&x),
                 x.t_contact_lower, p.geometry, p.other, -g.upper, where);
  }
  if (x.verdict == CPROX_VERDICT_CLEAR) attack_check(w->a, x.lower > 0.0, RESULT, SHOWN(&x));
  if (x.verdict == CPROX_VERDICT_VIOLATED) {
    attack_check(w->a, x.t >= x.t_contact_lower, RESULT ", free before %.17g", SHOWN(&x), x.t_contact_lower);
    if (pair_of_result(w, &x, &p)) {
      const gap g = gap_at(w, p, x.t);
      attack_check(w->a, g.lower <= g.room, RESULT ": touching, but a plane proves %.19Lg", SHOWN(&x), g.lower);
    }
  }
}

static void ask_profile(world *w, const cprox_options *options) {
  enum { INTERVALS = 4 };
  size_t n;
  const cprox_obstacle *targets = targets_of(w, &n);
  double breaks[INTERVALS + 1];
  cprox_profile_interval found[INTERVALS];
  for (int k = 0; k <= INTERVALS; k++) breaks[k] = k == INTERVALS ? w->t1 : w->t0 + (w->t1 - w->t0) * k / INTERVALS;
  if (!answered(w, profile_of_list(w->mover, targets, n, breaks, INTERVALS, options, w->a->ws, found))) return;
  for (int k = 0; k < INTERVALS && !attack_failed(w->a); k++) {
    const cprox_result x = {.lower = found[k].lower,
                            .upper = found[k].upper,
                            .t = found[k].t,
                            .obstacle_index = found[k].obstacle_index,
                            .mover_part = -1};
    attack_check(w->a, x.lower <= x.upper, "profile: " RESULT, SHOWN(&x));
    check_lower(w, &x, breaks[k], breaks[k + 1]);
  }
}

/* ---- one case ---- */

static cprox_options some_options(rng *r) {
  const double epsilons[] = {1e-6, 1e-6, 1e-4, 1e-3, 0.05}, relative[] = {0.0, 0.0, 1e-3, 0.3};
  const uint32_t budgets[] = {2000, 2000, 500, 20, 1};
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.epsilon = epsilons[rng_index(r, 5)];
  options.relative_epsilon = relative[rng_index(r, 4)];
  options.max_nodes = budgets[rng_index(r, 5)];
  return options;
}

static void one_case(attack *a, rng *r) {
  static const struct {
    const char *name;
    void (*ask)(world *w, const cprox_options *options);
    bool both; /* does it answer for obstacles and itself at once? */
  } QUERIES[] = {{"distance", ask_distance, true},
                 {"distance", ask_distance, true},
                 {"tolerance", ask_tolerance, true},
                 {"tolerance", ask_tolerance, true},
                 {"time of contact", ask_time_of_contact, true},
                 {"profile", ask_profile, false}};
  static const char *const ABOUT[] = {"", "obstacles", "itself", "obstacles and itself"};
  static world w;
  w = (world){.a = a, .r = r};
  if (world_make(&w, rng_log_uniform(r, 0.02, 0.3))) {
    const size_t which = rng_index(r, sizeof QUERIES / sizeof *QUERIES);
    const size_t about = 1 + rng_index(r, QUERIES[which].both ? 3 : 2);
    w.obstacles = about & 1, w.self = about & 2;
    w.mover = w.obstacles ? cprox_robot_along(w.t.motion, NULL, 0) : cprox_robot_self(w.t.motion, NULL, 0);
    if (w.obstacles && w.self) w.mover.kind = CPROX_MOVER_ROBOT_WHOLE;
    attack_kind(a, "%s: %s, %s", QUERIES[which].name, ABOUT[about],
                w.t.spline                      ? "spline"
                : w.t.n_points > TEST_WAYPOINTS ? "many waypoints"
                                                : "few waypoints");
    const cprox_options options = some_options(r);
    if (a->alone)
      printf("%zu links, %zu waypoints, interpolation %d, epsilon %g, relative %g, budget %u\n", w.t.n_links,
             w.t.n_points, (int)w.t.interpolation, options.epsilon, options.relative_epsilon, options.max_nodes);
    QUERIES[which].ask(&w, &options);
  }
  world_free(&w);
}

int main(int argc, char **argv) {
  return attack_main(argc, argv, "robots", one_case);
}
