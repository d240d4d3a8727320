/* SPDX-License-Identifier: BSD-3-Clause */
#include "robot_query/robot_scene.h"

#include <math.h>

#include "base/rounding.h"
#include "broadphase/obstacle_set.h"
#include "robot_query/groups.h"

/* Of pairs of several robots that may come near each other so many are listed one by one. */
enum { MOST_DISPLACEMENTS = 1 << 18, MOST_NEAR = 4096 };

/* ---- bodies ---- */

/* The finest model that the query allows. Clouds and octrees stay what they are, and so do halfspaces. */
static part_model model_for(const query *q, part_model model) {
  const bool many = model.tree && model.tree->kind != TREE_TRIANGLES && model.by_ball;
  if (q->options.max_lod == CPROX_LOD_MESH || many) return model;
  if (model.tree && model.by_ball && q->options.max_lod == CPROX_LOD_HULL) return model; /* it has no hull */
  model.tree = NULL, model.winding = NULL;
  const bool endless = model.shape->ops->kind == CPROX_BODY_HALFSPACE;
  return q->options.max_lod == CPROX_LOD_SPHERE && !endless ? part_model_ball(&model) : model;
}

/* What follows from all else. */
static robot_body with_core(const robot_body *body, const part_model *m) {
  robot_body whole = *body;
  whole.side.middle = m->middle, whole.side.half = m->half;
  whole.core = robot_core_radius(&whole);
  return whole;
}

/* ---- obstacles ---- */

/* A part of an obstacle; the frames of parts of unions are composed. */
static robot_body obstacle_of(const query *q, size_t index, size_t part) {
  const cprox_obstacle *obstacle = &q->obstacles[index];
  const cprox_body *body = body_part_at(obstacle->body, part);
  part_model m = model_for(q, part_model_of(body));
  if (m.shape->ops->kind != CPROX_BODY_HALFSPACE) part_model_find_box(&m);
  cprox_pose pose = obstacle->pose;
  double error = 0.0;
  if (obstacle->body->kind == CPROX_BODY_COMPOUND) {
    const body_part *p = &obstacle->body->parts[part];
    pose = frame_compose(&obstacle->pose, &p->pose);
    const double turned = vec_norm(p->pose.position) + vec_norm(body->ball_centre) + 2.0 * body->ball_radius;
    error = isfinite(turned) ? turned : vec_norm(p->pose.position) + vec_norm(body->centre) + body->shape.scale;
    error = ROUND_U * (ROUND_ROTATION * error + 3.0 * vec_norm(pose.position));
  }
  const frame f = frame_create(&pose, m.centre);
  robot_body placed = {.radius = m.radius + obstacle->margin, .index = (int32_t)index, .part = (int32_t)part};
  placed.side = (bound_side){.shape = m.shape, .margin = m.margin + obstacle->margin};
  for (int i = 0; i < 9; i++) placed.side.at.r[i] = f.r[i];
  placed.side.at.p = frame_to_world(&f, vec(0, 0, 0));
  placed.tree = m.tree, placed.clusters = m.tree ? m.clusters : NULL, placed.tree_at = m.tree_at,
  placed.tree_margin = m.tree_margin + obstacle->margin, placed.winding = m.winding;
  if (robot_body_is_halfspace(&placed)) placed.radius = m.shape->scale + placed.side.margin;
  const double sizes = vec_norm(m.centre) + placed.radius;
  placed.side.error = ROUND_UP * (error + ROUND_U * (ROUND_ROTATION * sizes + 3.0 * vec_norm(placed.side.at.p)));
  return with_core(&placed, &m);
}

/* There is room for them. */
static void add_parts(robot_scene *s, size_t obstacle) {
  const size_t parts = body_n_parts(s->q->obstacles[obstacle].body);
  for (size_t i = 0; i < parts; i++) {
    robot_body *made = &s->obstacles[s->n_obstacles++];
    *made = obstacle_of(s->q, obstacle, i);
    s->has_solids = s->has_solids || made->winding;
  }
}

int32_t robot_scene_add_obstacles(robot_scene *s, size_t obstacle) {
  const size_t before = s->n_obstacles, n = before + body_n_parts(s->q->obstacles[obstacle].body);
  if (n > INT32_MAX) return -1;
  robot_body *all = workspace_reserve(s->q->workspace, WORKSPACE_ROBOT_OBSTACLES, n * sizeof *all);
  if (!all) return -1;
  s->obstacles = all;
  add_parts(s, obstacle);
  return (int32_t)before;
}

static robot_body part_body(const query *q, size_t i) {
  const cprox_motion *motion = q->mover.motion;
  const robot_part *part = &motion->robot->parts[i];
  const part_model m = model_for(q, part->model);
  robot_body body = {.radius = m.radius, .steps = part->steps, .index = part->geometry, .part = (int32_t)i};
  body.side = (bound_side){.shape = m.shape, .margin = m.margin, .error = motion->part_error[i]};
  body.tree = m.tree, body.clusters = m.tree ? m.clusters : NULL, body.tree_at = m.tree_at,
  body.tree_margin = m.tree_margin, body.winding = m.winding;
  return with_core(&body, &m);
}

/* ---- pairs ---- */

robot_pair robot_scene_pair_of(const robot_scene *s, const planned_pair *planned, bool self) {
  robot_pair pair = {.moving = planned->moving,
                     .standing = planned->standing,
                     .element = {ROBOT_WHOLE, ROBOT_WHOLE},
                     .near = {ROBOT_WHOLE, ROBOT_WHOLE},
                     .self = self,
                     .common = -1};
  if (!self) return pair;
  const cprox_robot *robot = s->motion->robot;
  pair.common = robot_common_axis(robot, robot->parts[pair.moving].axis, robot->parts[pair.standing].axis);
  pair.shared = robot_axis_depth(robot, pair.common);
  return pair;
}

/* ---- far pairs ---- */

/* An upper bound of the distance of two parts: the least one measured at nine times. */
static double measured_apart(robot_scene *s, const planned_pair *parts) {
  enum { PLACES = 8 };
  double least = INFINITY;
  for (int k = 0; k <= PLACES; k++) {
    const double t = s->q->t0 + (s->q->t1 - s->q->t0) * k / PLACES;
    const motion_interval at = motion_interval_of(s->motion, t, t);
    robot_scene_enter_place(s, at.first, at.a);
    const robot_body *body[2];
    for (int side = 0; side < 2; side++) body[side] = robot_scene_part(s, side ? parts->standing : parts->moving);
    const robot_body *a = body[0], *b = body[1];
    const double apart = vec_norm(vec_sub(a->side.at.p, b->side.at.p));
    least = lesser(apart + a->radius + b->radius + a->side.error + b->side.error, least);
  }
  return ROUND_UP * least;
}

/* ---- two times ---- */

static double time_from(const robot_scene *s, const motion_interval *over) {
  return motion_time(s->motion, over->first, over->a);
}

static double time_to(const robot_scene *s, const motion_interval *over) {
  return motion_time(s->motion, over->last - 1, over->b);
}

static double most_apart(const robot_scene *s) {
  return (1.0 + 2.0 * ROUND_U) * (s->lead_tolerance + s->other_tolerance);
}

void robot_scene_range(const robot_scene *s, motion_interval *lead, motion_interval *other) {
  *lead = motion_interval_of(s->motion, s->q->t0 - s->lead_tolerance, s->q->t1 + s->lead_tolerance);
  *other = *lead;
  if (!robot_scene_has_two_times(s)) return;
  *other = motion_interval_of(s->motion, s->q->t0 - s->other_tolerance, s->q->t1 + s->other_tolerance);
  robot_scene_fit(s, lead, other);
}

bool robot_scene_fit(const robot_scene *s, motion_interval *lead, motion_interval *other) {
  const start_times whole = {{time_from(s, lead), time_to(s, lead)}, {time_from(s, other), time_to(s, other)}};
  start_times left = whole;
  if (!start_times_fit(&left, most_apart(s))) return false;
  if (left.lead[0] > whole.lead[0] || left.lead[1] < whole.lead[1])
    *lead = motion_interval_of(s->motion, left.lead[0], left.lead[1]);
  if (left.other[0] > whole.other[0] || left.other[1] < whole.other[1])
    *other = motion_interval_of(s->motion, left.other[0], left.other[1]);
  return true;
}

double robot_scene_clock(const robot_scene *s, double lead, double other) {
  if (!(s->lead_tolerance > 0.0)) return lead;
  double earliest = lead - s->lead_tolerance;
  if (robot_scene_has_two_times(s)) earliest = greater(other - s->other_tolerance, earliest);
  const double rounding = 8.0 * ROUND_U * (fabs(lead) + fabs(other) + s->lead_tolerance + s->other_tolerance);
  return greater(earliest - rounding, s->q->t0);
}

/* What the plan says becomes the scene's pairs. many: more with itself than are listed one by one, unless those are
 * left out that do not matter to the query because they stay too far apart. */
static bool list_pairs(robot_scene *s, bool many, bool leaves_out, double cutoff) {
  const query *q = s->q;
  const bool distance = !query_wants_verdict(q);
  pair_plan *plan = &s->plan;
  *plan = (pair_plan){.q = q, .starts = s->starts, .reach = INFINITY};
  if (leaves_out && !q->is_signed) plan->reach = distance ? cutoff : q->limit + q->options.epsilon;
  if (!pair_plan_list(plan, s->obstacles, s->n_obstacles, s->groups)) return false;
  const planned_pair *nearest = leaves_out && !q->is_signed && distance ? pair_plan_nearest(plan) : NULL;
  if (nearest) pair_plan_leave_out(plan, lesser(measured_apart(s, nearest), cutoff));
  if (many && leaves_out && plan->n > MOST_NEAR) {
    if (!robot_groups_begin(s)) return false;
    plan->n = plan->n_against, plan->beyond = INFINITY;
  }
  s->n_pairs = plan->n;
  s->pairs = workspace_reserve(q->workspace, WORKSPACE_ROBOT_PAIRS, (s->n_pairs + 1) * sizeof *s->pairs);
  if (!s->pairs) return false;
  for (size_t i = 0; i < plan->n; i++) s->pairs[i] = robot_scene_pair_of(s, &plan->pairs[i], i >= plan->n_against);
  return true;
}

bool robot_scene_begin(robot_scene *s, const query *q, const start_class *starts, size_t first, size_t last,
                       size_t most_listed, double cutoff) {
  const bool self = pair_plan_has_self(&q->mover);
  *s = (robot_scene){.q = q, .motion = q->mover.motion, .starts = starts};
  if (starts) {
    s->lead_tolerance = starts->lead_tolerance;
    s->other_tolerance = starts->other_tolerance;
  }
  const cprox_robot *robot = s->motion->robot;
  const size_t n_axes = robot->n_axes + 1;
  const bool leaves_out = self && s->motion->sweeps && most_listed < SIZE_MAX;
  const bool many = pair_plan_count_self(&q->mover) > most_listed;
  if (many && !leaves_out && !robot_groups_begin(s)) return false;
  size_t deepest = 0;
  for (size_t i = 0; self && !s->groups && i < robot->n_parts; i++) {
    const size_t depth = robot_axis_depth(robot, robot->parts[i].axis);
    deepest = depth > deepest ? depth : deepest;
  }
  s->n_displacements = deepest + 1;
  const size_t all_displacements = self && !s->groups && s->n_displacements * robot->n_parts <= MOST_DISPLACEMENTS
                                       ? s->n_displacements * robot->n_parts
                                       : 0;
  const size_t bytes = (robot->n_parts + 1) * sizeof *s->parts + s->motion->n_tracks * sizeof *s->tracks +
                       n_axes * (sizeof *s->axes + sizeof *s->chain + sizeof *s->scratch + sizeof *s->axis_placed) +
                       (MOTION_ROWS * s->motion->row_size + all_displacements) * sizeof *s->rows +
                       (q->errors ? n_axes * sizeof *s->deviations + robot->n_parts * sizeof *s->part_deviations : 0);
  const uint32_t *listed = q->set ? q->set->unbounded : NULL;
  const size_t n_listed = q->set ? q->set->n_unbounded : last - first;
  size_t n_obstacles = 0;
  for (size_t i = 0; i < n_listed; i++) n_obstacles += body_n_parts(q->obstacles[listed ? listed[i] : first + i].body);
  s->obstacles = workspace_reserve(q->workspace, WORKSPACE_ROBOT_OBSTACLES, (n_obstacles + 1) * sizeof *s->obstacles);
  char *memory = workspace_reserve(q->workspace, WORKSPACE_ROBOT, bytes);
  if (!memory || !s->obstacles || n_obstacles > INT32_MAX) return false;
  s->parts = (part_state *)(void *)memory;
  s->tracks = (track_state *)(void *)(s->parts + robot->n_parts + 1);
  s->axes = (axis_state *)(void *)(s->tracks + s->motion->n_tracks);
  s->chain = (chain_axis *)(void *)(s->axes + n_axes);
  s->rows = (double *)(void *)(s->chain + n_axes);
  s->scratch = s->rows + MOTION_ROWS * s->motion->row_size;
  s->displacements = all_displacements ? s->scratch + n_axes : NULL;
  s->deviations = (axis_deviations *)(void *)(s->scratch + n_axes + all_displacements);
  s->part_deviations = (part_deviation *)(void *)(s->deviations + (q->errors ? n_axes : 0));
  s->axis_placed = (uint32_t *)(void *)(s->part_deviations + (q->errors ? robot->n_parts : 0));
  for (size_t i = 0; i < n_axes; i++) s->axis_placed[i] = 0;
  for (size_t i = 0; i < n_axes && q->errors; i++) s->deviations[i].found = 0;
  for (size_t i = 0; i < robot->n_parts && q->errors; i++) s->part_deviations[i].found = 0;
  for (size_t i = 0; i < s->motion->n_tracks; i++) s->tracks[i].found = s->tracks[i].filled = 0;

  for (size_t i = 0; i < n_listed; i++) add_parts(s, listed ? listed[i] : first + i);
  s->has_solids = s->has_solids || (q->set && q->set->has_solids);
  for (size_t i = 0; i < robot->n_parts; i++) {
    s->parts[i] = (part_state){.body = part_body(q, i), .carrier = s->motion->carrier[robot->parts[i].axis + 1]};
    s->has_solids = s->has_solids || s->parts[i].body.winding;
  }

  return list_pairs(s, many, leaves_out, cutoff);
}

int32_t robot_scene_add_pair(robot_scene *s, const robot_pair *pair) {
  if (s->n_pairs >= INT32_MAX / sizeof *pair) return -1;
  robot_pair *pairs = workspace_reserve(s->q->workspace, WORKSPACE_ROBOT_PAIRS, (s->n_pairs + 1) * sizeof *pairs);
  if (!pairs) return -1;
  s->pairs = pairs;
  pairs[s->n_pairs] = *pair;
  return (int32_t)s->n_pairs++;
}

/* ---- over a node ---- */

void robot_scene_enter(robot_scene *s, size_t segment, double a, double b) {
  const motion_interval over = {.a = a, .b = b, .first = segment, .last = segment + 1};
  robot_scene_enter_span(s, &over);
}

static bool is_on_other_clock(const robot_scene *s, const motion_track *t) {
  return s->starts && robot_scene_has_two_times(s) && t->clock == s->starts->other;
}

static track_state *find_track(robot_scene *s, size_t track) {
  track_state *state = &s->tracks[track];
  if (state->found == s->node) return state;
  const motion_track *t = &s->motion->tracks[track];
  const motion_interval *over = is_on_other_clock(s, t) ? &s->other : &s->over;
  state->found = s->node;
  if (s->at_place) {
    state->own = *over;
    state->own.first = motion_track_place(s->motion, t, over->first, &state->own.a);
  } else {
    state->own = motion_track_interval(s->motion, t, over);
  }
  return state;
}

static void fill_track(robot_scene *s, size_t track) {
  track_state *state = find_track(s, track);
  if (state->filled == s->node || s->at_place) return;
  const bool other = is_on_other_clock(s, &s->motion->tracks[track]);
  state->filled = s->node;
  motion_fill_track(s->motion, track, other ? &s->other : &s->over, &state->own, other ? &s->other_centre : &s->centre,
                    s->rows);
}

static bool is_same(const motion_interval *a, const motion_interval *b) {
  return a->first == b->first && a->last == b->last && a->a == b->a && a->b == b->b;
}

void robot_scene_enter_place(robot_scene *s, size_t segment, double u) {
  s->node++;
  s->at_place = true;
  s->over = s->other = (motion_interval){.a = u, .b = u, .first = segment, .last = segment + 1};
  s->centre = s->other_centre = (span_centre){.segment = segment, .u = u};
}

void robot_scene_enter_both(robot_scene *s, const motion_interval *lead, const motion_interval *other) {
  const bool known = s->node > 0 && !s->at_place && is_same(lead, &s->over) && is_same(other, &s->other);
  if (known) return;
  s->node++;
  s->at_place = false;
  s->over = *lead, s->other = *other;
  const bool two = robot_scene_has_two_times(s);
  s->centre = motion_middle(s->motion, lead);
  s->other_centre =
      two ? motion_middle(s->motion, other) : (span_centre){.u = s->centre.u, .segment = s->centre.segment};
  /* the one track says where the centre is */
  if (s->motion->n_tracks == 1) fill_track(s, 0);
  if (!two) return;
  const start_times times = {{time_from(s, lead), time_to(s, lead)}, {time_from(s, other), time_to(s, other)}};
  s->times.n = start_times_corners(&times, most_apart(s), s->times.corner);
}

/* Within what is asked about of the other clock. */
void robot_scene_enter_span(robot_scene *s, const motion_interval *over) {
  motion_interval other = *over;
  if (robot_scene_has_two_times(s)) {
    const double from = s->q->t0 - s->other_tolerance, to = s->q->t1 + s->other_tolerance;
    other = motion_interval_of(s->motion, lesser(greater(time_from(s, over), from), to),
                               lesser(greater(time_to(s, over), from), to));
  }
  robot_scene_enter_both(s, over, &other);
}

double robot_scene_other_time(const robot_scene *s) {
  return motion_time(s->motion, s->other_centre.segment, s->other_centre.u);
}

bool robot_scene_is_possible(const robot_scene *s) {
  if (!robot_scene_has_two_times(s)) return true;
  const double lead = motion_time(s->motion, s->centre.segment, s->centre.u), other = robot_scene_other_time(s);
  const double rounding = 64.0 * ROUND_U * (fabs(lead) + fabs(other) + most_apart(s));
  return fabs(lead - other) <= most_apart(s) + rounding;
}

static void fill_part(robot_scene *s, int32_t part) {
  const cprox_robot *robot = s->motion->robot;
  for (int32_t axis = robot->parts[part].axis; axis >= 0; axis = robot->axes[axis].parent)
    if (s->motion->axis_moves[axis]) fill_track(s, (size_t)s->motion->track_of[robot->axes[axis].variable]);
}

void robot_scene_fill_pair(robot_scene *s, const robot_pair *pair) {
  if (s->motion->n_tracks == 1) return; /* it was filled when the node was entered */
  fill_part(s, pair->moving);
  if (pair->self) fill_part(s, pair->standing);
}

void robot_scene_fill(robot_scene *s) {
  for (size_t k = 0; k < s->motion->n_tracks; k++) fill_track(s, k);
}

double robot_scene_place(const robot_scene *s, size_t segment, double u) {
  const double *times = s->motion->times, from = times[0], duration = times[s->motion->n_segments] - from;
  return (times[segment] - from + u * (times[segment + 1] - times[segment])) / duration;
}

/* An axis and all above it that are not known yet; those are found from the base down. */
static void place_axis(robot_scene *s, int32_t axis) {
  const robot_axis *axes = s->motion->robot->axes;
  size_t n = 0;
  for (; axis >= 0 && s->axis_placed[axis] != s->node; axis = axes[axis].parent) s->chain[n++].axis = axis;
  while (n > 0) {
    const int32_t next = s->chain[--n].axis;
    const size_t track = (size_t)s->motion->track_of[axes[next].variable];
    if (s->motion->axis_moves[next]) fill_track(s, track);
    const motion_interval *own = &s->tracks[track].own;
    if (s->at_place)
      motion_place_axis(s->motion, own->first, own->a, (size_t)next, s->axes);
    else
      motion_find_axis(s->motion, own, s->rows, (size_t)next, s->axes);
    s->axis_placed[next] = s->node;
  }
}

void robot_scene_place_part(robot_scene *s, int32_t index) {
  part_state *state = &s->parts[index];
  const robot_part *part = &s->motion->robot->parts[index];
  place_axis(s, part->axis);
  state->body.side.at = part->axis < 0 ? part->at : placement_compose(&s->axes[part->axis].frame, &part->at);
  state->placed = s->node;
}

/* Where a whole part is over the node. */
static const sweep_box *sweep_of(robot_scene *s, int32_t index) {
  part_state *state = &s->parts[index];
  const part_sweep *sweep = &s->motion->sweeps[index];
  if (sweep->n_shifts == 0) return &sweep->box;
  if (state->swept == s->node) return &state->sweep;
  const int32_t variable = s->motion->robot->axes[sweep->axes[0]].variable;
  const motion_interval *own = &find_track(s, (size_t)s->motion->track_of[variable])->own;
  state->swept = s->node;
  state->sweep = motion_sweep_over(s->motion, sweep, own->first, own->last);
  return &state->sweep;
}

double robot_scene_swept_apart(robot_scene *s, const robot_pair *pair) {
  const part_sweep *sweeps = s->motion->sweeps;
  if (!pair->self) return -INFINITY;
  const double radii = sweeps[pair->moving].radius + sweeps[pair->standing].radius;
  const double apart = sweep_boxes_apart(sweep_of(s, pair->moving), sweep_of(s, pair->standing), radii);
  return apart > 0.0 ? apart : -INFINITY; /* boxes that overlap do not say how far */
}

double robot_scene_part_displacement(robot_scene *s, int32_t index) {
  part_state *state = &s->parts[index];
  if (state->displaced == s->node) return state->displacement;
  const robot_body *body = robot_scene_part(s, index);
  const int32_t axis = s->motion->robot->parts[index].axis;
  double *displacements = s->displacements ? s->displacements + (size_t)index * s->n_displacements : NULL;
  state->displaced = s->node;
  state->displacement =
      motion_displacements(s->motion, s->axes, axis, displacements ? robot_axis_depth(s->motion->robot, axis) : 0,
                           body->side.at.p, body->core, displacements);
  return state->displacement;
}

void robot_scene_displacements(robot_scene *s, const robot_pair *pair, double *other, double *lead) {
  const double moving = robot_scene_part_displacement(s, pair->moving),
               standing = robot_scene_part_displacement(s, pair->standing);
  const bool is_other = start_clock_of(s->motion, pair->moving) == s->starts->other;
  *other = is_other ? moving : standing;
  *lead = is_other ? standing : moving;
}
