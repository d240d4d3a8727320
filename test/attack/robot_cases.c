/* SPDX-License-Identifier: BSD-3-Clause */
/* Robots: trees of every type of joint with bodies of many kinds on their links, along few and many waypoints, against
 * obstacles, against themselves, and both at once; every query that robots have. Movers: two or three of these, or
 * bodies on pose splines, on one clock, half of them with starts that are only known to a tolerance or not at all.
 *
 * Held against poses in long double (support/robots.h) and nearest points by definition (bodies.h). Nearest points
 * taken in turns give two points, one of each body: their distance is an upper bound of the true one, so no lower bound
 * of the core may be above it, at any time. Supports along the line between them give a lower bound, which no upper
 * bound may be below. Witness points must lie in their bodies and be as near as said. Verdicts
 * and times of contact must follow. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "bodies.h"
#include "robot_cases.h"
#include "support/of_list.h"
#include "support/robots.h"

enum { OBSTACLES = 3, TURNS = 12, SAMPLES = 10, REFINEMENTS = 14, PAIRS = 3 };
enum { MEMBERS = 3, MOST_GEOMETRIES = MEMBERS * TEST_MAX_LINKS, MOST_PAIRS = MOST_GEOMETRIES * MOST_GEOMETRIES };

/* Times are rounded to double and joints turn at up to 1e2 rad/s or m/s in reaches of 1e1 m: 1e3 * 1e-15 m, and poses
 * in double by 1e-13 m. */
static const long double ROOM = 1e-11L;

static const cprox_pose HERE = {.orientation = {1, 0, 0, 0}};

typedef struct world {
  attack *a;
  rng *r;
  bool several, vague;                  /* starts have tolerances */
  test_robot members[MEMBERS];          /* one geometry a link */
  size_t n_members, first[MEMBERS + 1]; /* their geometries */
  double starts[MEMBERS], tolerances[MEMBERS];
  double place[MEMBERS]; /* in [0, 1]: which of the possible starts; of what may be anywhere, where it is */
  cprox_pose bases[MEMBERS];
  cprox_robot *joined; /* of several */
  cprox_motion *motion;
  bool across; /* of the pairs with itself only those of two members */
  cprox_robot_pair pairs[MOST_PAIRS];
  random_body links[MOST_GEOMETRIES], bodies[OBSTACLES];
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

static size_t count_geometries(const world *w) {
  return w->first[w->n_members];
}

static size_t member_of(const world *w, size_t g) {
  size_t m = 0;
  while (g >= w->first[m + 1]) m++;
  return m;
}

/* The link of a geometry in the robot that is asked about. */
static int32_t link_of(const world *w, size_t g) {
  return (int32_t)(w->n_members > 1 ? g + member_of(w, g) + 1 : g);
}

/* The links of all geometries at a time. */
static void place_links(const world *w, long double time, ref_pose *links) {
  for (size_t m = 0; m < w->n_members; m++) {
    const test_robot *t = &w->members[m];
    const cprox_motion_info info = cprox_motion_get_info(t->motion);
    const bool anywhere = isinf(w->tolerances[m]);
    const long double late = anywhere ? 0.0L : (2.0L * w->place[m] - 1.0L) * w->tolerances[m];
    const long double at =
        anywhere ? info.t0 + w->place[m] * ((long double)info.t1 - info.t0) : time - w->starts[m] - late;
    const long double own = w->n_members > 1 ? fminl(fmaxl(at, info.t0), info.t1) : time;
    long double values[TEST_MAX_VARIABLES + 1];
    ref_pose *of = links + w->first[m];
    robot_ref_values(t, own, values);
    robot_ref_links(t, values, of);
    for (size_t i = 0; i < t->n_links && w->n_members > 1; i++) of[i] = ref_pose_under(&w->bases[m], &of[i]);
  }
}

static placed place_geometry(const world *w, const ref_pose *links, size_t g) {
  const size_t m = member_of(w, g);
  const cprox_link_geometry *geometry = &w->members[m].geometries[g - w->first[m]];
  return (placed){&w->links[g], links[g], geometry->pose, geometry->margin};
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

/* The plane across the way from y to x: everything of a is so far from everything of b, at least. */
static long double plane_between(const placed *a, const placed *b, vec3l x, vec3l y) {
  const long double apart = ref_norm(ref_sub(x, y));
  if (!(apart > 0.0L)) return -HUGE_VALL;
  const vec3l n = ref_scale(1.0L / apart, ref_sub(x, y));
  const long double low = -support_of(a, ref_scale(-1.0L, n)) - support_of(b, n) - a->margin - b->margin;
  return isfinite(low) ? low : -HUGE_VALL;
}

/* The same of the balls about the frames of both. */
static long double balls_between(const placed *a, const placed *b) {
  const vec3l from = ref_pose_apply(&a->link, ref_vec(a->offset.position)),
              to = ref_pose_apply(&b->link, ref_vec(b->offset.position));
  return ref_norm(ref_sub(from, to)) - a->body->extent * (1.0L + 1e-12L) - b->body->extent * (1.0L + 1e-12L) -
         a->margin - b->margin;
}

/* Where it is known that the upper bound will not be below `most`, that is infinite. */
static gap gap_below(const world *w, pair p, long double time, long double most) {
  ref_pose links[MOST_GEOMETRIES];
  place_links(w, time, links);
  const placed a = place_geometry(w, links, p.geometry), b = place_other(w, links, p);
  gap g = {
      .upper = HUGE_VALL, .lower = -HUGE_VALL, .room = ROOM + (long double)a.body->slack + (long double)b.body->slack};
  if (balls_between(&a, &b) >= most) return g;
  vec3l x = ref_pose_apply(&a.link, ref_vec(a.offset.position)), y = x;
  long double before = HUGE_VALL, apart = HUGE_VALL;
  for (int i = 0; i < TURNS; i++) {
    y = nearest_on(&b, x);
    x = nearest_on(&a, y);
    apart = ref_norm(ref_sub(x, y));
    if (most < HUGE_VALL && plane_between(&a, &b, x, y) >= most) return g;
    if (!(apart < before * (1.0L - 1e-9L))) break;
    before = apart;
  }
  g.upper = apart - a.margin - b.margin;
  g.lower = plane_between(&a, &b, x, y);
  return g;
}

static gap gap_at(const world *w, pair p, long double time) {
  return gap_below(w, p, time, HUGE_VALL);
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
  cprox_result x = {0};
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.max_nodes = 1;
  return distance_of_list(cprox_robot_along(w->members[0].motion, NULL, 0), &target, 1, &options, w->a->ws, &x, NULL) >=
         0;
}

static bool make_links(world *w, size_t m, double scale) {
  test_robot *t = &w->members[m];
  for (size_t k = 0; k < t->n_links; k++) {
    const size_t i = w->first[m] + k;
    int tries = 0;
    do {
      if (tries) body_free(&w->links[i]);
      if (tries++ == 20) return false;
      body_make(w->a, w->r, rng_index(w->r, 3) ? rng_index(w->r, 8) : rng_index(w->r, BODY_KINDS), scale, &w->links[i]);
      if (attack_failed(w->a)) return false;
    } while (!link_takes(w->links[i].body));
    cprox_body_free((cprox_body *)t->geometries[k].body);
    t->geometries[k].body = w->links[i].body;
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
static bool make_member(world *w, size_t m, double scale) {
  rng *r = w->r;
  test_robot *t = &w->members[m];
  const double speed = rng_log_uniform(r, 0.05, 2.0);
  const bool poses = w->several && rng_index(r, 2);
  if (poses)
    robot_make_turning(r, speed, (cprox_turning)rng_index(r, 3), 2 + rng_index(r, TEST_WAYPOINTS - 1), t);
  else
    robot_make(r, speed, t);
  const bool many = rng_index(r, 2);
  if (many) {
    const size_t n = 6 + rng_index(r, TEST_MAX_WAYPOINTS - 6);
    robot_draw_motion(r, speed / sqrt((double)n), n, t);
  }
  w->first[m + 1] = w->first[m] + t->n_links;
  w->n_members = m + 1;
  if (!make_links(w, m, scale)) return false;
  robot_rebuild(t);
  return true;
}

/* Each begins before the first one has ended, and ends after that has begun. */
static bool join_members(world *w) {
  const cprox_robot *robots[MEMBERS];
  cprox_joined_motion motions[MEMBERS];
  const cprox_motion_info first = cprox_motion_get_info(w->members[0].motion);
  for (size_t m = 0; m < w->n_members; m++) {
    const cprox_motion_info info = cprox_motion_get_info(w->members[m].motion);
    w->starts[m] = m == 0 ? 0.0 : rng_uniform(w->r, first.t0 - info.t1, first.t1 - info.t0);
    w->bases[m] = rng_pose(w->r, 0.5);
    w->tolerances[m] = !w->vague || rng_index(w->r, 2) ? 0.0
                       : m == 0 || rng_index(w->r, 3)  ? rng_log_uniform(w->r, 1e-3, 3.0) * (info.t1 - info.t0)
                                                       : INFINITY;
    robots[m] = w->members[m].robot;
    motions[m] = (cprox_joined_motion){w->members[m].motion, w->starts[m], w->tolerances[m]};
  }
  const cprox_motion_description d = {.kind = CPROX_MOTION_JOINED, .joined = motions, .n_joined = w->n_members};
  return attack_check(w->a,
                      cprox_robot_join(robots, w->bases, w->n_members, w->a->ws, &w->joined) == CPROX_OK &&
                          cprox_motion_create(w->joined, &d, w->a->ws, &w->motion) == CPROX_OK,
                      "%s", cprox_workspace_error(w->a->ws));
}

static bool world_make(world *w, double scale) {
  const size_t n = w->several ? 2 + rng_index(w->r, MEMBERS - 1) : 1;
  for (size_t m = 0; m < n; m++)
    if (!make_member(w, m, scale)) return false;
  if (w->several && !join_members(w)) return false;
  if (!w->several) w->motion = w->members[0].motion;
  if (!make_obstacles(w, scale)) return false;
  const cprox_motion_info info = cprox_motion_get_info(w->motion);
  w->t0 = info.t0, w->t1 = info.t1;
  return true;
}

/* The bodies of links belong to the robot: robot_free() frees them. */
static void world_free(world *w) {
  if (w->joined) cprox_motion_free(w->motion);
  cprox_robot_free(w->joined);
  for (size_t m = 0; m < w->n_members; m++) robot_free(&w->members[m]);
  for (size_t i = 0; i < MOST_GEOMETRIES; i++) {
    for (size_t k = 0; k < BODY_PARTS + 1; k++) cprox_body_free(w->links[i].owned[k]);
  }
  for (size_t i = 0; i < OBSTACLES; i++)
    if (w->bodies[i].body) body_free(&w->bodies[i]);
}

/* ---- pairs ---- */

/* Is the pair asked about, as cprox_robot_along() and cprox_robot_self() say? */
static bool is_asked(const world *w, pair p) {
  if (!p.self) return w->obstacles && cprox_motion_get_link_info(w->motion, link_of(w, p.geometry), -1).n_moved > 0;
  if (!w->self || p.geometry == p.other) return false;
  if (w->across) return member_of(w, p.geometry) != member_of(w, p.other);
  const cprox_link_info between = cprox_motion_get_link_info(w->motion, link_of(w, p.geometry), link_of(w, p.other));
  return between.n_joints >= 2 && between.n_moved > 0;
}

static bool draw_pair(const world *w, pair *p) {
  for (int tries = 0; tries < 20; tries++) {
    const bool self = w->self && (!w->obstacles || rng_index(w->r, 2));
    *p = (pair){rng_index(w->r, count_geometries(w)), rng_index(w->r, self ? count_geometries(w) : OBSTACLES), self};
    if (is_asked(w, *p)) return true;
  }
  return false;
}

/* The pair that a result is about. */
static bool pair_of_result(const world *w, const cprox_result *x, pair *p) {
  const int32_t first = w->obstacles ? OBSTACLES : 0, index = x->obstacle_index;
  *p = (pair){(size_t)x->mover_part, (size_t)(index < first ? index : index - first), index >= first};
  return x->mover_part >= 0 && (size_t)x->mover_part < count_geometries(w) && index >= 0 &&
         p->other < (p->self ? count_geometries(w) : OBSTACLES) && is_asked(w, *p);
}

/* ---- what holds of results ---- */

#define RESULT "[%.17g, %.17g] (%s, %s) at t = %.17g"
#define SHOWN(x) (x)->lower, (x)->upper, cprox_status_name((x)->status), cprox_verdict_name((x)->verdict), (x)->t

static void draw_places(world *w) {
  for (size_t m = 0; m < w->n_members && w->vague; m++)
    w->place[m] = rng_index(w->r, 4) ? rng_uniform(w->r, 0.0, 1.0) : (double)rng_index(w->r, 2);
}

/* The least distance of a pair that is found over [t0, t1]: samples, then smaller and smaller steps about the best. */
static gap least_gap(world *w, pair p, double t0, double t1, double begin, double *where) {
  draw_places(w);
  gap best = gap_at(w, p, begin);
  double places[MEMBERS];
  *where = begin;
  memcpy(places, w->place, sizeof places);
  for (int i = 0; i <= SAMPLES; i++) {
    const double t = fmin(t0 + (t1 - t0) * (i + rng_uniform(w->r, 0.0, 1.0)) / SAMPLES, t1);
    draw_places(w);
    const gap g = gap_below(w, p, t, best.upper);
    if (g.upper < best.upper) best = g, *where = t, memcpy(places, w->place, sizeof places);
  }
  memcpy(w->place, places, sizeof places);
  double step = (t1 - t0) / SAMPLES;
  for (int i = 0; i < REFINEMENTS; i++, step *= 0.5) {
    for (int side = -1; side <= 1; side += 2) {
      const double t = fmin(fmax(*where + side * step, t0), t1);
      const gap g = gap_below(w, p, t, best.upper);
      if (g.upper < best.upper) best = g, *where = t;
      for (size_t m = 0; m < w->n_members && w->vague; m++) {
        const double kept = w->place[m];
        w->place[m] = fmin(fmax(kept + side * ldexp(0.5, -i), 0.0), 1.0);
        const gap moved = gap_below(w, p, *where, best.upper);
        if (moved.upper < best.upper)
          best = moved;
        else
          w->place[m] = kept;
      }
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
  ref_pose links[MOST_GEOMETRIES];
  place_links(w, x->t, links);
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

/* How far a point is from a geometry at the nearest, whatever the start: places of its member side by side, then
 * smaller and smaller steps about the best. More places where that is above what is enough. */
static long double nearest_of_all(world *w, size_t g, vec3l x, long double time, long double enough) {
  enum { STEPS = 40, MOST = 30000 };
  double *place = &w->place[member_of(w, g)], best = 0.0;
  long double least = HUGE_VALL;
  for (int drawn = 300; drawn <= MOST && least > enough; drawn *= 10) {
    for (int i = 0; i < drawn + 2 * STEPS; i++) {
      const int k = i - drawn;
      const double step = (k % 2 ? 1.0 : -1.0) * ldexp(1.0 / drawn, -k / 4);
      *place = k < 0 ? (double)i / (drawn - 1) : fmin(fmax(best + step, 0.0), 1.0);
      ref_pose links[MOST_GEOMETRIES];
      place_links(w, time, links);
      const placed a = place_geometry(w, links, g);
      const long double off = ref_norm(ref_sub(nearest_on(&a, x), x)) - a.margin;
      if (off < least) least = off, best = *place;
    }
  }
  return least;
}

/* Of starts with a tolerance the result does not say with which ones it was measured: each witness is near its geometry
 * with some start that is possible then. What is found of the best one is right to about the square root of the room of
 * nearest points. */
static void check_witness_of_some_start(world *w, const cprox_result *x, pair p) {
  const long double room = 1e-4L;
  const vec3l on_a = ref_vec(x->witness_mover), on_b = ref_vec(x->witness_obstacle);
  const long double off_a = nearest_of_all(w, p.geometry, on_a, x->t, room);
  attack_check(w->a, off_a <= room, RESULT ": no start brings geometry %zu nearer than %.3Lg to its witness", SHOWN(x),
               p.geometry, off_a);
  if (!p.self) return;
  const long double off_b = nearest_of_all(w, p.other, on_b, x->t, room);
  attack_check(w->a, off_b <= room, RESULT ": no start brings geometry %zu nearer than %.3Lg to its witness", SHOWN(x),
               p.other, off_b);
}

static void check_upper(world *w, const cprox_result *x) {
  pair p;
  if (isinf(x->upper)) return;
  if (!attack_check(w->a, pair_of_result(w, x, &p), RESULT ": parts %d and %d are not asked about", SHOWN(x),
                    x->mover_part, x->obstacle_index))
    return;
  if (w->vague) {
    check_witness_of_some_start(w, x, p);
    return;
  }
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
  cprox_result x = {0};
  if (!answered(w, distance_of_list(w->mover, targets, n, options, w->a->ws, &x, NULL))) return;
  check_result(w, &x);
  if (x.status == CPROX_OK) check_width(w, &x, options);
}

static void ask_tolerance(world *w, const cprox_options *options) {
  size_t n;
  const cprox_obstacle *targets = targets_of(w, &n);
  const double delta = rng_index(w->r, 3) ? rng_log_uniform(w->r, 1e-4, 1.0) : 0.0;
  cprox_result x = {0};
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
  cprox_result x = {0};
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
    if (pair_of_result(w, &x, &p) && !w->vague) {
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

/* Of the pairs with itself only those of two members. */
static size_t pairs_across(world *w) {
  size_t n = 0;
  for (size_t g = 0; g < count_geometries(w); g++)
    for (size_t k = g + 1; k < count_geometries(w); k++)
      if (member_of(w, g) != member_of(w, k)) w->pairs[n++] = (cprox_robot_pair){(int32_t)g, (int32_t)k};
  return n;
}

static cprox_mover mover_of(world *w) {
  if (w->several) w->across = rng_index(w->r, 2);
  const size_t n = w->across ? pairs_across(w) : 0;
  const cprox_robot_pair *pairs = w->across ? w->pairs : NULL;
  if (!w->obstacles) return cprox_robot_self(w->motion, pairs, n);
  cprox_mover mover = cprox_robot_along(w->motion, NULL, 0);
  if (w->self) mover.kind = CPROX_MOVER_ROBOT_WHOLE, mover.self_pairs = pairs, mover.n_self_pairs = n;
  return mover;
}

static cprox_options some_options(rng *r) {
  const double epsilons[] = {1e-6, 1e-6, 1e-4, 1e-3, 0.05}, relative[] = {0.0, 0.0, 1e-3, 0.3};
  const uint32_t budgets[] = {2000, 2000, 500, 20, 1};
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.epsilon = epsilons[rng_index(r, 5)];
  options.relative_epsilon = relative[rng_index(r, 4)];
  options.max_nodes = budgets[rng_index(r, 5)];
  return options;
}

void robot_case(attack *a, rng *r, bool several) {
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
  w = (world){.a = a, .r = r, .several = several, .vague = several && rng_index(r, 2)};
  if (world_make(&w, rng_log_uniform(r, 0.02, 0.3))) {
    const size_t which = rng_index(r, sizeof QUERIES / sizeof *QUERIES);
    const size_t about = 1 + rng_index(r, QUERIES[which].both ? 3 : 2);
    w.obstacles = about & 1, w.self = about & 2;
    w.mover = mover_of(&w);
    const test_robot *t = &w.members[0];
    attack_kind(a, "%s: %s, %s%s", QUERIES[which].name, ABOUT[about], w.vague ? "vague starts, " : "",
                t->spline                      ? "spline"
                : t->n_points > TEST_WAYPOINTS ? "many waypoints"
                                               : "few waypoints");
    const cprox_options options = some_options(r);
    if (a->alone)
      printf("%zu links, %zu waypoints, interpolation %d, epsilon %g, relative %g, budget %u\n", count_geometries(&w),
             t->n_points, (int)t->interpolation, options.epsilon, options.relative_epsilon, options.max_nodes);
    QUERIES[which].ask(&w, &options);
  }
  world_free(&w);
}
