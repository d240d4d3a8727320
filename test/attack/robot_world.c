/* SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>

#include "robot_world.h"
#include "support/of_list.h"

enum { TURNS = 12 }; /* of nearest points */

/* Times are rounded to double and joints turn at up to 1e2 rad/s or m/s in reaches of 1e1 m: 1e3 * 1e-15 m, and poses
 * in double by 1e-13 m. */
static const long double ROOM = 1e-11L;

static const cprox_pose HERE = {.orientation = {1, 0, 0, 0}};

/* ---- what is where ---- */

size_t count_geometries(const world *w) {
  return w->first[w->n_members];
}

size_t member_of(const world *w, size_t g) {
  size_t m = 0;
  while (g >= w->first[m + 1]) m++;
  return m;
}

int32_t link_of(const world *w, size_t g) {
  return (int32_t)(w->n_members > 1 ? g + member_of(w, g) + 1 : g);
}

/* The time on the clock of a member. */
static long double own_time(const world *w, size_t m, const double *place, long double time) {
  if (w->n_members == 1) return time;
  const cprox_motion_info info = cprox_motion_get_info(w->members[m].motion);
  const bool anywhere = isinf(w->tolerances[m]);
  const long double late = anywhere ? 0.0L : (2.0L * place[m] - 1.0L) * w->tolerances[m];
  const long double at = anywhere ? info.t0 + place[m] * ((long double)info.t1 - info.t0) : time - w->starts[m] - late;
  return fminl(fmaxl(at, info.t0), info.t1);
}

ref_pose place_link(const world *w, size_t g, const double *place, long double time) {
  const size_t m = member_of(w, g);
  const ref_pose pose = robot_ref_link(&w->members[m], g - w->first[m], own_time(w, m, place, time));
  return w->n_members > 1 ? ref_pose_under(&w->bases[m], &pose) : pose;
}

void place_links(const world *w, view *v) {
  for (size_t m = 0; m < w->n_members; m++) {
    const test_robot *t = &w->members[m];
    long double values[TEST_MAX_VARIABLES + 1];
    ref_pose *of = v->links + w->first[m];
    robot_ref_values(t, own_time(w, m, v->place, v->t), values);
    robot_ref_links(t, values, of);
    for (size_t i = 0; i < t->n_links && w->n_members > 1; i++) of[i] = ref_pose_under(&w->bases[m], &of[i]);
  }
  for (size_t g = 0; g < count_geometries(w); g++)
    v->centres[g] = ref_pose_apply(&v->links[g], w->link_balls[g].centre);
}

placed place_geometry(const world *w, const ref_pose *link, size_t g) {
  const size_t m = member_of(w, g);
  const cprox_link_geometry *geometry = &w->members[m].geometries[g - w->first[m]];
  return (placed){&w->links[g], *link, geometry->pose, geometry->margin};
}

placed place_obstacle(const world *w, size_t o) {
  return (placed){&w->bodies[o], {.q = {0, 0, 0, 1}}, w->poses[o], w->margins[o]};
}

void place_pair(const world *w, pair p, const double *place, long double time, placed two[2]) {
  const ref_pose link = place_link(w, p.geometry, place, time);
  two[0] = place_geometry(w, &link, p.geometry);
  if (!p.self) {
    two[1] = place_obstacle(w, p.other);
    return;
  }
  const ref_pose other = place_link(w, p.other, place, time);
  two[1] = place_geometry(w, &other, p.other);
}

/* About the box of a body, or about its frame where that is smaller. */
static ball ball_about(const random_body *body, const cprox_pose *offset, double margin) {
  long double low[3], high[3];
  for (int k = 0; k < 3; k++) {
    const vec3l axis = {k == 0, k == 1, k == 2};
    high[k] = body_support(body, &HERE, axis), low[k] = -body_support(body, &HERE, ref_scale(-1.0L, axis));
  }
  const vec3l half = {(high[0] - low[0]) / 2, (high[1] - low[1]) / 2, (high[2] - low[2]) / 2};
  ball b = {{(high[0] + low[0]) / 2, (high[1] + low[1]) / 2, (high[2] + low[2]) / 2}, ref_norm(half)};
  const bool bounded = isfinite(b.radius);
  if (!bounded || body->extent < b.radius) b.centre = (vec3l){0, 0, 0};
  if (bounded && body->extent < b.radius) b.radius = body->extent;
  return (ball){ref_to_world(offset, b.centre), b.radius * (1.0L + 1e-12L) + margin};
}

vec3l nearest_on(const placed *s, vec3l x) {
  vec3l q;
  body_nearest(s->body, &HERE, ref_to_local(&s->offset, ref_pose_undo(&s->link, x)), &q);
  return ref_pose_apply(&s->link, ref_to_world(&s->offset, q));
}

static long double support_of(const placed *s, vec3l d) {
  const vec3l in_link = ref_pose_undo(&(ref_pose){.q = {s->link.q[0], s->link.q[1], s->link.q[2], s->link.q[3]}}, d);
  return ref_dot(d, s->link.p) + body_support(s->body, &s->offset, in_link);
}

/* The plane across the way from y to x: everything of a is so far from everything of b, at least. */
static long double plane_between(const placed *a, const placed *b, vec3l x, vec3l y) {
  const long double apart = ref_norm(ref_sub(x, y));
  if (!(apart > 0.0L)) return -HUGE_VALL;
  const vec3l n = ref_scale(1.0L / apart, ref_sub(x, y));
  const long double low = -support_of(a, ref_scale(-1.0L, n)) - support_of(b, n) - a->margin - b->margin;
  return isfinite(low) ? low : -HUGE_VALL;
}

/* How deep a point is in a body, where that is known. */
static long double depth_in(const placed *s, vec3l x) {
  return s->body->depth ? body_depth(s->body, &HERE, ref_to_local(&s->offset, ref_pose_undo(&s->link, x))) : 0.0L;
}

gap gap_between(const placed *a, const placed *b, long double limit, long double best, vec3l *begin) {
  const long double margins = (long double)a->margin + b->margin;
  gap g = {.room = ROOM + (long double)a->body->slack + (long double)b->body->slack};
  vec3l x = ref_pose_apply(&a->link, *begin), y = x;
  long double before = HUGE_VALL;
  for (int i = 0; i < TURNS; i++) {
    y = nearest_on(b, x);
    x = nearest_on(a, y);
    const long double apart = ref_norm(ref_sub(x, y));
    g.upper = apart - margins;
    g.lower = plane_between(a, b, x, y);
    if (g.lower >= best || (g.lower >= limit && g.upper - g.lower <= 0.25L * (g.upper - limit))) break;
    if (!(apart < before * (1.0L - 1e-9L))) break;
    before = apart;
  }
  if (g.upper == -margins) g.upper -= fmaxl(depth_in(a, x), depth_in(b, x));
  *begin = ref_pose_undo(&a->link, x);
  return g;
}

gap gap_at(const world *w, pair p, double time) {
  placed two[2];
  place_pair(w, p, w->place, time, two);
  vec3l begin = w->link_balls[p.geometry].centre;
  return gap_between(&two[0], &two[1], HUGE_VALL, HUGE_VALL, &begin);
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
    w->link_balls[i] = ball_about(&w->links[i], &t->geometries[k].pose, t->geometries[k].margin);
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
    w->body_balls[i] = ball_about(&w->bodies[i], &w->poses[i], w->margins[i]);
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

bool world_make(world *w, double scale) {
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

void world_free(world *w) {
  if (w->joined) cprox_motion_free(w->motion);
  cprox_robot_free(w->joined);
  for (size_t m = 0; m < w->n_members; m++) robot_free(&w->members[m]);
  for (size_t i = 0; i < MOST_GEOMETRIES; i++) {
    for (size_t k = 0; k < BODY_PARTS + 1; k++) cprox_body_free(w->links[i].owned[k]);
  }
  for (size_t i = 0; i < OBSTACLES; i++)
    if (w->bodies[i].body) body_free(&w->bodies[i]);
}
