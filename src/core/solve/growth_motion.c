/* SPDX-License-Identifier: BSD-3-Clause */
/* The least growth distance of a robot along its motion (doc/implicit.md, Along a robot's motion).
 *
 * One search over all pairs: a node is a range of pairs over all of the motion, or one pair over an interval. What is
 * measured in the middle of an interval leaves a plane, which bounds the interval (motion_growth_bound()). */
#include "solve/growth_motion.h"

#include <math.h>

#include "base/rounding.h"
#include "base/workspace.h"
#include "convex/feature.h"
#include "narrowphase/growth.h"
#include "robot_query/robot_depth.h"
#include "solve/motion_derivatives.h"

/* The part of the width that may be left where the centres meet and a relative width is none. */
static const double AT_CENTRES = 1e-3;

/* Of the range: the first step away from the minimiser, near the root of rounding, and where steps end that grow. */
static const double FIRST_STEP = 1e-8, LAST_STEP = 0.05;

/* How near another minimiser must not come, as a part of the value; the neighbourhoods of the minimiser that are tried,
 * as fractions of the motion, until their ends are greater by FARTHER times that; where within them the value must fall
 * towards the minimiser. */
static const double APART = 1e-9, NEIGHBOURHOOD[] = {1e-4, 1e-3, 1e-2, 3e-2}, FARTHER = 4.0, INSIDE = 0.25;

/* What is left of a slope that is 0, as a part of what it is made of. Where two planes change in the minimiser, the
 * derivatives on either side are continued from two places, so far away and twice as far, as a part of the motion; the
 * planes of both may differ by less than SAME_PLANE of their slope. */
static const double CANCELLED = 1e-5, ASIDE = 1e-6, SAME_PLANE = 1e-3;
enum { SIDES = 4 };

/* The most nodes of the search for another minimiser: what it leaves open counts as one. */
enum { MOST_NODES = 4000, NEIGHBOURHOODS = sizeof NEIGHBOURHOOD / sizeof *NEIGHBOURHOOD };

/* The shortest interval of a segment; what rounding takes of times, as a part of the motion. */
static const double SHORTEST = 0x1p-46, ROUNDED = 1e-13;

/* What is measured of a pair at one time. */
typedef struct place {
  int32_t pair; /* -1: nothing was measured */
  size_t segment;
  double u;
  double lower, upper;
  vec3 n;     /* unit, world, from the standing side to the moving one; (0,0,0): none */
  vec3 slope; /* the derivative by the moving side's place, and where both touch once they are scaled, world */
  vec3 touch;
  const char *tie; /* why it has no gradient by poses, or NULL */
} place;

typedef struct robot_growth {
  robot_scene scene;
  const query *q;
  double *inner; /* of each part, then of each obstacle: the radius of a ball about its origin that lies in it */
  placed_robot_pair placed;
  motion_interval entered; /* that the scene is at; last = 0: none */
  place best;
  uint32_t work; /* places measured */
  motion_interval within;
  /* what is left out: the pair that is nearest, about its minimiser */
  int32_t left_out;
  double from, to;
  spot_pair spot;
} robot_growth;

typedef struct growth_node {
  double a, b;
  uint32_t first, last;
  int32_t pair, n_pairs;
  bool bounded;
} growth_node;

static growth_node *own(search_node *node) {
  _Static_assert(sizeof(growth_node) <= sizeof(search_payload), "a node's payload holds it");
  return (growth_node *)node->payload.bytes;
}

/* ---- places ---- */

static void enter(robot_growth *o, const motion_interval *over) {
  const motion_interval *at = &o->entered;
  if (at->last > 0 && at->a == over->a && at->b == over->b && at->first == over->first && at->last == over->last)
    return;
  robot_scene_enter_span(&o->scene, over);
  o->entered = *over;
}

static void enter_pair(robot_growth *o, const motion_interval *over, int32_t pair) {
  enter(o, over);
  robot_scene_fill_pair(&o->scene, &o->scene.pairs[pair]);
  placed_robot_pair_at(&o->scene, pair, &o->placed);
}

static double inner_of(const robot_growth *o, int32_t pair, bool moving) {
  const robot_pair *p = &o->scene.pairs[pair];
  const size_t n_parts = o->scene.motion->robot->n_parts;
  if (moving) return o->inner[p->moving];
  return o->inner[p->self ? (size_t)p->standing : n_parts + (size_t)p->standing];
}

static pair_side side_of(const robot_body *body) {
  const bound_side *side = &body->side;
  pair_side out = {.shape = side->shape, .margin = side->margin, .error = side->error};
  out.f = (frame){.position = side->at.p, .centre = vec(0, 0, 0), .rotated = true};
  for (int i = 0; i < 9; i++) out.f.r[i] = side->at.r[i];
  return out;
}

/* The pair that was placed last, where it is in the middle of its node. */
static cprox_status measure(robot_growth *o, bool wants_derivatives, place *p) {
  const pair_side a = side_of(o->placed.standing), b = side_of(o->placed.moving);
  const pair_placement at = relative_pose_make(&a, &b);
  const double inner_a = inner_of(o, o->placed.index, false), inner_b = inner_of(o, o->placed.index, true);
  const double far = vec_norm(at.t), reach = o->placed.standing->radius + o->placed.moving->radius;
  *p = (place){.pair = o->placed.index, .segment = o->scene.centre.segment, .u = o->scene.centre.u};
  o->work++;
  ray_answer ray = {.found = false};
  if (far > GROWING_COINCIDE * reach)
    ray_leave(a.shape, a.margin, inner_a, b.shape, b.margin, inner_b, &at, wants_derivatives, &ray);
  /* the balls in both touch no earlier, and those round them no later */
  p->lower = fmax((far - at.error) / reach * (1.0 - ROUND_LENGTH * ROUND_U), 0.0);
  p->upper = (far + at.error) / (inner_a + inner_b) * (1.0 + ROUND_LENGTH * ROUND_U);
  p->tie = growing_tie(&ray);
  if (ray.found) {
    p->lower = fmax(p->lower, ray.lower), p->upper = fmin(p->upper, ray.upper);
    p->slope = frame_turn_to_world(&a.f, ray.slope);
    feature_unit(p->slope, &p->n);
    p->touch = frame_to_world(&a.f, vec_scale(0.5 * (ray.lower + ray.upper), ray.on_a));
  }
  return isnan(p->upper) ? workspace_fail(o->q->workspace, CPROX_INVALID, CONVEX_NO_SUPPORT) : CPROX_OK;
}

static cprox_status measure_at(robot_growth *o, int32_t pair, size_t segment, double u, bool wants_derivatives,
                               place *p) {
  const motion_interval at = {.a = u, .b = u, .first = segment, .last = segment + 1};
  enter_pair(o, &at, pair);
  return measure(o, wants_derivatives, p);
}

/* ---- the search ---- */

/* How far the sides move bounds what they are apart, and what they reach: scaled by s, about its centre that moves as
 * well, a side moves by s + |1 - s| times that. */
static double bound_by_displacement(double apart, double reach, double displacement) {
  const double near = (apart - displacement) / reach;
  return fmax(near > 1.0 ? (apart + displacement) / (reach + 2.0 * displacement) : near, 0.0) * (1.0 - 16.0 * ROUND_U);
}

static bool is_left_out(const robot_growth *o, const growth_node *at) {
  if (at->n_pairs != 1 || at->pair != o->left_out) return false;
  const cprox_motion *m = o->scene.motion;
  const double rounding = ROUNDED * (m->times[m->n_segments] - m->times[0]);
  return motion_time(m, at->first, at->a) >= o->from - rounding &&
         motion_time(m, at->last - 1, at->b) <= o->to + rounding;
}

static motion_interval interval_of(const growth_node *at) {
  return (motion_interval){.a = at->a, .b = at->b, .first = at->first, .last = at->last};
}

/* By the balls round both sides. */
static double filter(void *self, search_node *node, double goal) {
  robot_growth *o = self;
  (void)goal;
  growth_node *at = own(node);
  if (at->n_pairs != 1 || at->bounded) return node->lower;
  at->bounded = true;
  if (is_left_out(o, at)) return INFINITY;
  const motion_interval over = interval_of(at);
  enter_pair(o, &over, at->pair);
  const robot_body *moving = o->placed.moving, *standing = o->placed.standing;
  const double slack = moving->side.error + standing->side.error;
  return greater(
      bound_by_displacement(vec_norm(vec_sub(moving->side.at.p, standing->side.at.p)) - slack,
                            ROUND_UP * (moving->radius + standing->radius), placed_robot_pair_displacement(&o->placed)),
      node->lower);
}

static double bound_by_plane(robot_growth *o, const motion_interval *over, const place *p) {
  const robot_body *moving = o->placed.moving, *standing = o->placed.standing;
  const uint32_t steps = moving->steps + standing->steps;
  const chain_motion *m = placed_robot_pair_move(&o->placed);
  if (!motion_is_span(over)) return motion_growth_bound(m, &moving->side, &standing->side, p->n, steps);
  chain_motion still = {.displacement = 0.0};
  const double here = motion_growth_bound(&still, &moving->side, &standing->side, p->n, steps);
  const double reach = bound_height(&standing->side, p->n) - bound_lowest(&moving->side, p->n) + moving->side.margin;
  return bound_by_displacement(here * reach, ROUND_UP * reach, m->displacement);
}

static cprox_status probe(void *self, search_node *node, search_best *best) {
  robot_growth *o = self;
  const growth_node *at = own(node);
  if (at->n_pairs != 1) return CPROX_OK;
  const motion_interval over = interval_of(at);
  enter_pair(o, &over, at->pair);
  place p;
  const cprox_status status = measure(o, false, &p);
  if (status < 0) return status;
  if (robot_scene_stands(&o->scene, &o->scene.pairs[at->pair]) || o->scene.motion->is_state)
    node->lower = greater(p.lower, node->lower);
  else if (vec_norm2(p.n) > 0.0)
    node->lower = greater(bound_by_plane(o, &over, &p), node->lower);
  node->slack = p.upper - p.lower;
  if (!(p.upper < best->upper)) return CPROX_OK;
  o->best = p;
  *best = (search_best){.upper = p.upper, .slack = p.upper - p.lower, .at = INFINITY};
  return CPROX_OK;
}

/* The segments of a span in two; within a segment at the ends of what is left out, else in the middle. */
static int split(void *self, search_node *node, search_node *child) {
  robot_growth *o = self;
  const growth_node at = *own(node);
  for (int k = 0; k < 2; k++) {
    child[k] = *node;
    own(&child[k])->bounded = false;
  }
  growth_node *left = own(&child[0]), *right = own(&child[1]);
  if (at.n_pairs > 1) {
    left->n_pairs = at.n_pairs / 2;
    right->pair = at.pair + left->n_pairs, right->n_pairs = at.n_pairs - left->n_pairs;
    return 2;
  }
  if (o->scene.motion->is_state) return 0;
  if (at.first + 1 < at.last) {
    const uint32_t middle = at.first + (at.last - at.first) / 2;
    left->last = middle, left->b = 1.0;
    right->first = middle, right->a = 0.0;
    return 2;
  }
  if (!(at.b - at.a > SHORTEST)) return 0;
  double cut = 0.5 * (at.a + at.b);
  const double t0 = o->scene.motion->times[at.first], length = o->scene.motion->times[at.last] - t0;
  for (int k = 0; k < 2 && at.pair == o->left_out; k++) {
    const double end = ((k ? o->to : o->from) - t0) / length;
    if (end > at.a + SHORTEST && end < at.b - SHORTEST) cut = end;
  }
  left->b = cut, right->a = cut;
  return 2;
}

static void release(void *self, const search_node *node) {
  (void)self, (void)node;
}

/* The least value; or whether any of what is not left out is at most `limit`, where that is >= 0. */
static cprox_status search(robot_growth *o, double limit, uint32_t most, search_outcome *found) {
  const cprox_options *asked = &o->q->options;
  const double epsilon = asked->epsilon;
  search_node root = {.lower = 0.0};
  *own(&root) = (growth_node){.a = o->within.a,
                              .b = o->within.b,
                              .first = (uint32_t)o->within.first,
                              .last = (uint32_t)o->within.last,
                              .n_pairs = (int32_t)o->scene.n_pairs};
  search_goal goal = {.order = SEARCH_BEST_FIRST,
                      .limit = limit,
                      .cutoff = INFINITY,
                      .time_cutoff = INFINITY,
                      .epsilon = limit < 0.0 ? AT_CENTRES * epsilon : 0.0,
                      .relative_epsilon = epsilon,
                      .max_nodes = most,
                      .stop = asked->stop,
                      .stop_user = asked->stop_user};
  const search_oracle oracle = {
      .self = o, .work = &o->work, .filter = filter, .probe = probe, .split = split, .release = release};
  o->work = 0;
  const cprox_status status = search_run(&goal, &oracle, root, o->q->workspace, found);
  if (status == CPROX_MEMORY) return workspace_fail(o->q->workspace, status, "no memory for the open intervals");
  return status;
}

/* ---- the minimiser ---- */

/* A place, and the derivative of the value by time there in spot->slope; *size: the sum of the sizes of its parts, or
 * NULL. from_left: of a waypoint, as the segment before has it. */
static cprox_status look_at(robot_growth *o, double t, bool from_left, place *p, motion_spot *spot, double *size) {
  const cprox_motion *m = o->scene.motion;
  size_t segment = motion_segment_at(m, t);
  if (from_left && segment > 0 && m->times[segment] >= t) segment--;
  const double u = (t - m->times[segment]) / (m->times[segment + 1] - m->times[segment]);
  const cprox_status status = measure_at(o, o->best.pair, segment, fmin(fmax(u, 0.0), 1.0), true, p);
  if (status < 0) return status;
  *spot = (motion_spot){.segment = p->segment, .u = p->u};
  spot->gap.normal = p->slope, spot->gap.on_moving = spot->gap.on_standing = p->touch;
  spot_differentiate(&o->spot, spot);
  motion_rates(m, p->segment, p->u, o->spot.rates);
  double sum = 0.0;
  for (size_t v = 0; v < m->robot->n_variables; v++) {
    const double by = o->spot.by_variable[v] * o->spot.rates[v];
    spot->slope += by, sum += fabs(by);
  }
  if (size) *size = sum;
  return CPROX_OK;
}

/* Between left, where the value falls, and right, where it grows: bisection, as its slope may jump. */
static cprox_status find_root(robot_growth *o, double left, double right, double *t) {
  enum { MOST_STEPS = 80 };
  for (int i = 0; i < MOST_STEPS; i++) {
    const double middle = 0.5 * (left + right);
    if (!(middle > left && middle < right)) break;
    place p;
    motion_spot spot;
    const cprox_status status = look_at(o, middle, false, &p, &spot, NULL);
    if (status < 0) return status;
    *t = middle;
    if (spot.slope == 0.0) break;
    *(spot.slope < 0.0 ? &left : &right) = middle;
  }
  return CPROX_OK;
}

/* The minimiser near *t. */
static cprox_status refine(robot_growth *o, double t0, double t1, double *t) {
  place p;
  motion_spot before, behind;
  double step = FIRST_STEP * (t1 - t0);
  while (step < LAST_STEP * (t1 - t0)) {
    const double left = fmax(*t - step, t0), right = fmin(*t + step, t1);
    cprox_status status = look_at(o, left, false, &p, &before, NULL);
    if (status >= 0) status = look_at(o, right, true, &p, &behind, NULL);
    if (status < 0) return status;
    if (left == t0 && before.slope >= 0.0 && behind.slope >= 0.0) return *t = t0, CPROX_OK;
    if (right == t1 && before.slope <= 0.0 && behind.slope <= 0.0) return *t = t1, CPROX_OK;
    if (before.slope < 0.0 && behind.slope > 0.0) return find_root(o, left, right, t);
    step *= 8.0;
  }
  return CPROX_OK;
}

/* Whether the value falls towards t from the end of a neighbourhood on this side, and is greater there. */
static cprox_status rises_towards(robot_growth *o, double t, double end, double value, bool *rises) {
  *rises = true;
  if (end == t) return CPROX_OK;
  place p;
  motion_spot spot;
  cprox_status status = look_at(o, end, end > t, &p, &spot, NULL);
  if (status < 0) return status;
  *rises = p.lower >= value * (1.0 + FARTHER * APART);
  status = look_at(o, t + INSIDE * (end - t), end > t, &p, &spot, NULL);
  *rises = *rises && status >= 0 && (end > t ? spot.slope > 0.0 : spot.slope < 0.0);
  return status;
}

/* Whether the value is greater everywhere else, and of all other pairs. */
static cprox_status is_alone(robot_growth *o, double t0, double t1, double t, double value, bool *alone) {
  *alone = false;
  const place best = o->best;
  for (int k = 0; k < NEIGHBOURHOODS && !*alone; k++) {
    const double width = NEIGHBOURHOOD[k] * (t1 - t0);
    bool good[2];
    o->from = fmax(t - width, t0), o->to = fmin(t + width, t1);
    cprox_status status = rises_towards(o, t, o->from, value, &good[0]);
    if (status >= 0) status = rises_towards(o, t, o->to, value, &good[1]);
    if (status < 0) return status;
    if (!good[0] || !good[1]) continue;
    search_outcome found = {.lower = INFINITY};
    const double limit = value * (1.0 + APART);
    o->left_out = best.pair;
    status = search(o, limit, MOST_NODES, &found);
    o->best = best, o->left_out = -1;
    if (status < 0) return status;
    *alone = found.lower > limit;
  }
  return CPROX_OK;
}

static bool is_at_waypoint(const robot_growth *o, double t) {
  const cprox_motion *m = o->scene.motion;
  const double rounding = ROUNDED * (m->times[m->n_segments] - m->times[0]);
  for (size_t i = 0; i <= m->n_segments; i++)
    if (fabs(m->times[i] - t) <= rounding) return true;
  return false;
}

static bool is_same_plane(vec3 a, vec3 b) {
  return vec_norm(vec_sub(a, b)) <= SAME_PLANE * vec_norm(a);
}

/* Two planes change in the minimiser: the value there is that of both, g1 = g2, so that its derivative is the sum of
 * theirs with the parts that take away the slope. *found: either plane is alone beside it. */
static cprox_status find_crossing(robot_growth *o, double t0, double t1, double t, motion_spot side[SIDES],
                                  double part[SIDES], bool *found) {
  const double aside = ASIDE * (t1 - t0);
  double slope[2];
  vec3 plane[2];
  *found = true;
  for (int k = 0; k < 2; k++) {
    place p[2];
    for (int i = 0; i < 2; i++) {
      const double there = t + (k == 0 ? -1.0 : 1.0) * (i + 1) * aside;
      const cprox_status status = look_at(o, there, k == 0, &p[i], &side[2 * k + i], NULL);
      if (status < 0) return status;
      *found = *found && there > t0 && there < t1 && !p[i].tie && side[2 * k + i].segment == side[0].segment;
    }
    *found = *found && is_same_plane(p[0].slope, p[1].slope);
    plane[k] = p[0].slope;
    slope[k] = 2.0 * side[2 * k].slope - side[2 * k + 1].slope;
  }
  const bool kink = slope[0] < 0.0 && slope[1] > 0.0;
  *found = *found && (kink || is_same_plane(plane[0], plane[1])); /* where one joint moves no slope cancels */
  const double before = kink ? slope[1] / (slope[1] - slope[0]) : 0.5;
  part[0] = 2.0 * before, part[1] = -before, part[2] = 2.0 * (1.0 - before), part[3] = before - 1.0;
  return CPROX_OK;
}

/* The derivatives at the minimiser; *why: NULL, or why there are none. */
static cprox_status differentiate(robot_growth *o, cprox_motion_growth *answer, cprox_motion_gradient *gradient,
                                  const char **why) {
  const cprox_motion *m = o->scene.motion;
  if (!spot_begin(&o->scene, o->best.pair, &o->spot))
    return workspace_fail(o->q->workspace, CPROX_MEMORY, "no memory for a gradient");
  const double t0 = motion_time(m, o->within.first, o->within.a), t1 = motion_time(m, o->within.last - 1, o->within.b);
  const bool stands = m->is_state || robot_scene_stands(&o->scene, &o->scene.pairs[o->best.pair]);
  const uint32_t work = o->work;
  double t = motion_time(m, o->best.segment, o->best.u), size = 0.0, part[SIDES];
  bool alone = m->is_state, crosses = false;
  place p;
  motion_spot spot, side[SIDES];
  cprox_status status = stands ? CPROX_OK : refine(o, t0, t1, &t);
  if (status >= 0) status = look_at(o, t, t == t1, &p, &spot, &size);
  if (status < 0) return status;
  if (p.lower > o->best.upper * (1.0 + ROUNDED)) { /* there is another minimum between */
    t = motion_time(m, o->best.segment, o->best.u);
    status = look_at(o, t, t == t1, &p, &spot, &size);
  }
  if (status >= 0 && !stands) status = is_alone(o, t0, t1, t, p.upper, &alone);
  if (status < 0) return status;
  const bool is_inside = !stands && t > t0 && t < t1 && !is_at_waypoint(o, t);
  if (alone && is_inside && (p.tie || fabs(spot.slope) > CANCELLED * size)) {
    status = find_crossing(o, t0, t1, t, side, part, &crosses);
    if (status < 0) return status;
    if (crosses)
      p.tie = NULL;
    else if (!p.tie)
      p.tie = "more than one plane fits between the scaled bodies";
  }
  const spots one = {&spot, NULL, 1}, crossing = {side, part, SIDES};
  motion_derivatives_fill(&o->spot, &spot, crosses ? &crossing : &one, gradient);
  gradient->margin = 0.0;
  o->work += work;
  o->best = p;
  answer->growth.upper = fmin(answer->growth.upper, p.upper);
  answer->growth.lower = fmin(answer->growth.lower, answer->growth.upper);
  *why = p.tie   ? p.tie
         : alone ? NULL
                 : "the growth distance is as small elsewhere along the motion, or of another pair";
  gradient->valid = !*why;
  return CPROX_OK;
}

/* ---- the query ---- */

static cprox_status check(robot_growth *o, const robot_body *body, const char *name, double *inner) {
  const convex *shape = body->side.shape;
  *inner = body->tree || robot_body_is_halfspace(body) ? 0.0 : growing_inner_radius(shape);
  if (*inner > GROWING_COINCIDE * shape->scale) return CPROX_OK;
  return workspace_fail(o->q->workspace, CPROX_INVALID,
                        "%s %d is a %s, must be convex and bounded and have its centre inside", name, (int)body->index,
                        cprox_body_kind_name(shape->ops->kind));
}

/* Of all sides of pairs the radii of the balls in them. */
static cprox_status begin(robot_growth *o) {
  const query *q = o->q;
  const cprox_robot *robot = q->mover.motion->robot;
  if (start_class_is_one_of_many(q->mover.motion))
    return workspace_fail(q->workspace, CPROX_INVALID, "a growth distance is not known where starts have tolerances");
  for (size_t i = 0; i < robot->n_geometries; i++)
    if (robot->given_geometries[i].margin > 0.0)
      return workspace_fail(q->workspace, CPROX_INVALID, "geometry %zu has a margin, which is not scaled", i);
  for (size_t i = 0; i < q->n; i++)
    if (q->obstacles[i].margin > 0.0)
      return workspace_fail(q->workspace, CPROX_INVALID, "obstacle %zu has a margin, which is not scaled", i);
  robot_scene *s = &o->scene;
  if (!robot_scene_begin(s, q, NULL, 0, q->n, SIZE_MAX, INFINITY))
    return workspace_fail(q->workspace, CPROX_MEMORY, "no memory for the pairs of a robot");
  const size_t n = robot->n_parts + s->n_obstacles;
  o->inner = workspace_reserve(q->workspace, WORKSPACE_ROBOT_GROWTH, (n + 1) * sizeof(double));
  if (!o->inner) return workspace_fail(q->workspace, CPROX_MEMORY, "no memory for the pairs of a robot");
  for (size_t i = 0; i < n; i++) o->inner[i] = 0.0;
  o->within = motion_interval_of(s->motion, q->t0, q->t1);
  const motion_interval start = {
      .a = o->within.a, .b = o->within.a, .first = o->within.first, .last = o->within.first + 1};
  for (size_t i = 0; i < s->n_pairs; i++) {
    enter_pair(o, &start, (int32_t)i);
    const robot_pair *p = &s->pairs[i];
    double *inner[2] = {&o->inner[p->moving], &o->inner[(p->self ? 0 : robot->n_parts) + (size_t)p->standing]};
    cprox_status status = CPROX_OK;
    if (!(*inner[0] > 0.0)) status = check(o, o->placed.moving, "geometry", inner[0]);
    if (status >= 0 && !(*inner[1] > 0.0))
      status = check(o, o->placed.standing, p->self ? "geometry" : "obstacle", inner[1]);
    if (status < 0) return status;
  }
  return CPROX_OK;
}

/* No value changes faster with a side's place. */
static double steepest(const robot_growth *o) {
  double most = 0.0;
  for (size_t i = 0; i < o->scene.plan.n; i++)
    most = fmax(most, ROUND_UP / (inner_of(o, (int32_t)i, false) + inner_of(o, (int32_t)i, true)));
  return most;
}

static void report(const robot_growth *o, cprox_motion_growth *to) {
  const robot_scene *s = &o->scene;
  const place *p = &o->best;
  const robot_pair *pair = &s->pairs[p->pair];
  to->growth.normal = p->n;
  to->growth.pairs = o->work;
  to->touch = p->touch;
  to->t = fmin(fmax(motion_time(s->motion, p->segment, p->u), o->q->t0), o->q->t1);
  to->mover_part = s->parts[pair->moving].body.index;
  to->obstacle_index = pair->self ? s->parts[pair->standing].body.index : s->obstacles[pair->standing].index;
  if (pair->self && mover_is_whole(&o->q->mover)) to->obstacle_index += (int32_t)o->q->n;
}

cprox_status growth_motion_answer(const query *asked, cprox_motion_growth *found, cprox_motion_gradient *gradient) {
  const query q = robot_depth_hulls(asked);
  robot_growth o = {.q = &q, .best = {.pair = -1}, .left_out = -1};
  cprox_status status = begin(&o);
  if (status < 0) return status;
  cprox_motion_growth answer = {.growth = {.lower = INFINITY, .upper = INFINITY}, .t = NAN, .touch = {NAN, NAN, NAN}};
  answer.mover_part = answer.obstacle_index = -1;
  const char *why = "there is nothing to be near";
  if (o.scene.n_pairs == 0) {
    if (gradient) motion_derivatives_fill_nothing(q.mover.motion, gradient), gradient->valid = false;
  } else {
    search_outcome outcome;
    status = search(&o, -1.0, q.options.max_nodes, &outcome);
    if (status < 0) return status;
    answer.steepest = steepest(&o);
    answer.growth.upper = o.best.upper, answer.growth.lower = fmin(fmax(outcome.lower, 0.0), o.best.upper);
    why = NULL;
    if (gradient && o.best.pair < 0) motion_derivatives_fill_nothing(q.mover.motion, gradient);
    const cprox_status differentiated =
        gradient && o.best.pair >= 0 ? differentiate(&o, &answer, gradient, &why) : CPROX_OK;
    if (differentiated < 0) return differentiated;
    if (gradient && status != CPROX_OK) gradient->valid = false;
    if (o.best.pair >= 0) report(&o, &answer);
  }
  answer.growth.status = status;
  *found = answer;
  workspace_clear(q.workspace);
  if (status != CPROX_OK)
    workspace_fail(q.workspace, status, "%s", query_shortfall(status));
  else if (why && gradient)
    workspace_fail(q.workspace, CPROX_OK, "no gradient: %s", why);
  return status;
}
