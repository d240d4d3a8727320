/* SPDX-License-Identifier: BSD-3-Clause */
#include "robot_query/pair_state.h"

#include <math.h>

#include "base/rounding.h"
#include "broadphase/obstacle_set.h"
#include "convex/pair.h"

enum { GAP_STEPS = 128, MOST_DISPLACEMENTS = 1 << 18 };

static bool is_halfspace(const robot_body *body) {
  return body->side.shape->ops->kind == CPROX_BODY_HALFSPACE;
}

/* ---- bodies ---- */

/* The finest model that the query allows. Clouds and octrees stay what they are, and so do halfspaces. */
static part_model model_for(const query *q, part_model model) {
  const bool many = model.tree && model.tree->kind != TREE_TRIANGLES && model.by_ball;
  if (q->options.max_lod == CPROX_LOD_MESH || many) return model;
  if (model.tree && model.by_ball && q->options.max_lod == CPROX_LOD_HULL) return model; /* it has no hull */
  model.tree = NULL;
  const bool endless = model.shape->ops->kind == CPROX_BODY_HALFSPACE;
  return q->options.max_lod == CPROX_LOD_SPHERE && !endless ? part_model_ball(&model) : model;
}

/* ---- obstacles ---- */

/* A part of a target; the frames of parts of unions are composed. */
static robot_body obstacle_of(const query *q, size_t index, size_t part) {
  const cprox_obstacle *target = &q->targets[index];
  const cprox_body *body = body_part_at(target->body, part);
  part_model m = model_for(q, part_model_of(body));
  if (m.shape->ops->kind != CPROX_BODY_HALFSPACE) part_model_find_box(&m);
  cprox_pose pose = target->pose;
  double error = 0.0;
  if (target->body->kind == CPROX_BODY_COMPOUND) {
    const body_part *p = &target->body->parts[part];
    pose = frame_compose(&target->pose, &p->pose);
    const double turned = vec_norm(p->pose.position) + vec_norm(body->ball_centre) + 2.0 * body->ball_radius;
    error = isfinite(turned) ? turned : vec_norm(p->pose.position) + vec_norm(body->centre) + body->shape.scale;
    error = ROUND_U * (ROUND_ROTATION * error + 3.0 * vec_norm(pose.position));
  }
  const frame f = frame_create(&pose, m.centre);
  robot_body placed = {.radius = m.radius + target->margin, .index = (int32_t)index, .part = (int32_t)part};
  placed.side = (bound_side){.shape = m.shape, .margin = m.margin + target->margin};
  for (int i = 0; i < 9; i++) placed.side.at.r[i] = f.r[i];
  placed.side.at.p = frame_to_world(&f, vec(0, 0, 0));
  placed.tree = m.tree, placed.tree_at = m.tree_at, placed.tree_margin = m.tree_margin + target->margin;
  if (is_halfspace(&placed)) placed.radius = m.shape->scale + placed.side.margin;
  const double sizes = vec_norm(m.centre) + placed.radius;
  placed.side.error = ROUND_UP * (error + ROUND_U * (ROUND_ROTATION * sizes + 3.0 * vec_norm(placed.side.at.p)));
  placed.middle = m.middle, placed.half = m.half;
  return placed;
}

int32_t robot_scene_add_obstacles(robot_scene *s, size_t target) {
  const size_t parts = body_n_parts(s->q->targets[target].body), n = s->n_obstacles + parts;
  if (n > INT32_MAX) return -1;
  robot_body *all = workspace_reserve(s->q->workspace, WORKSPACE_ROBOT_OBSTACLES, (n + 1) * sizeof *all);
  if (!all) return -1;
  s->obstacles = all;
  for (size_t i = 0; i < parts; i++) all[s->n_obstacles + i] = obstacle_of(s->q, target, i);
  s->n_obstacles = n;
  return (int32_t)(n - parts);
}

static robot_body part_body(const query *q, size_t i) {
  const cprox_motion *motion = q->mover.motion;
  const robot_part *part = &motion->robot->parts[i];
  const part_model m = model_for(q, part->model);
  robot_body body = {.radius = m.radius, .steps = part->steps, .index = part->geometry, .part = (int32_t)i};
  body.side = (bound_side){.shape = m.shape, .margin = m.margin, .error = motion->part_error[i]};
  body.tree = m.tree, body.tree_at = m.tree_at, body.tree_margin = m.tree_margin;
  body.middle = m.middle, body.half = m.half;
  return body;
}

/* ---- pairs ---- */

static robot_pair pair_of(const robot_scene *s, size_t moving, size_t standing, bool self) {
  robot_pair pair = {.moving = (int32_t)moving, .standing = (int32_t)standing, .element = {-1, -1}, .self = self};
  if (!self || !s->displacements) return pair;
  const cprox_robot *robot = s->motion->robot;
  const int32_t common = robot_common_axis(robot, robot->parts[moving].axis, robot->parts[standing].axis);
  pair.shared = robot_axis_depth(robot, common);
  return pair;
}

static int32_t geometry_of_part(const robot_scene *s, size_t part) {
  return s->motion->robot->parts[part].geometry;
}

static int32_t target_of_obstacle(const robot_scene *s, size_t obstacle) {
  return s->obstacles[obstacle].index;
}

/* The parts of a geometry stand side by side, in the order of the geometries; so do the obstacles of a target. The
 * first of n of them whose number is `number` or more. */
static size_t first_from(const robot_scene *s, int32_t (*number_of)(const robot_scene *, size_t), size_t n,
                         int32_t number) {
  size_t low = 0, high = n;
  while (low < high) {
    const size_t middle = low + (high - low) / 2;
    if (number_of(s, middle) < number)
      low = middle + 1;
    else
      high = middle;
  }
  return low;
}

/* Adds the pairs of convex parts of a geometry and a target, or of two geometries; only counts them where there is no
 * room. */
static void add_pairs(const robot_scene *s, int32_t geometry, int32_t other, bool self, robot_pair *pairs, size_t *n) {
  const cprox_robot *robot = s->motion->robot;
  const size_t others = self ? robot->n_parts : s->n_obstacles;
  const size_t first = first_from(s, self ? geometry_of_part : target_of_obstacle, others, other);
  for (size_t i = first_from(s, geometry_of_part, robot->n_parts, geometry);
       i < robot->n_parts && robot->parts[i].geometry == geometry; i++) {
    for (size_t k = first; k < others; k++) {
      if ((self ? robot->parts[k].geometry : s->obstacles[k].index) != other) break;
      if (pairs) pairs[*n] = pair_of(s, i, k, self);
      (*n)++;
    }
  }
}

bool robot_scene_asks(const robot_scene *s, size_t part) {
  return motion_moves_link(s->motion, s->motion->robot->parts[part].link);
}

/* All pairs that are worth asking for. */
static void add_all_pairs(const robot_scene *s, bool self, robot_pair *pairs, size_t *n) {
  const cprox_robot *robot = s->motion->robot;
  const size_t others = self ? robot->n_parts : s->n_obstacles;
  for (size_t i = 0; i < robot->n_parts; i++) {
    const robot_part *part = &robot->parts[i];
    if (!self && !robot_scene_asks(s, i)) continue;
    for (size_t k = 0; k < others; k++) {
      const robot_part *other = &robot->parts[k];
      if (self && (other->geometry >= part->geometry || !motion_relates_links(s->motion, part->link, other->link)))
        continue;
      if (pairs) pairs[*n] = pair_of(s, i, k, self);
      (*n)++;
    }
  }
}

/* Lists the pairs, or counts them where there is no room given. */
static size_t list_pairs(const robot_scene *s, robot_pair *pairs) {
  const cprox_mover *mover = &s->q->mover;
  size_t n = 0;
  const bool whole = mover_is_whole(mover);
  for (int self = mover_is_self(mover); self <= (mover_is_self(mover) || whole); self++) {
    const bool second = self && whole;
    const cprox_robot_pair *given = second ? mover->self_pairs : mover->pairs;
    const size_t count = second ? mover->n_self_pairs : mover->n_pairs;
    if (!given) add_all_pairs(s, self, pairs, &n);
    for (size_t i = 0; given && i < count; i++) add_pairs(s, given[i].geometry, given[i].other, self, pairs, &n);
  }
  return n;
}

/* ---- beginning ---- */

bool robot_scene_begin(robot_scene *s, const query *q, size_t first, size_t last) {
  const bool self = mover_is_self(&q->mover) || mover_is_whole(&q->mover);
  *s = (robot_scene){.q = q, .motion = q->mover.motion, .self = self};
  const cprox_robot *robot = s->motion->robot;
  const size_t n_axes = robot->n_axes + 1;
  size_t deepest = 0;
  for (size_t i = 0; s->self && i < robot->n_parts; i++) {
    const size_t depth = robot_axis_depth(robot, robot->parts[i].axis);
    deepest = depth > deepest ? depth : deepest;
  }
  s->n_displacements = deepest + 1;
  const size_t all_displacements =
      s->self && s->n_displacements * robot->n_parts <= MOST_DISPLACEMENTS ? s->n_displacements * robot->n_parts : 0;
  const size_t bytes = (robot->n_parts + 1) * sizeof *s->parts +
                       n_axes * (sizeof *s->axes + sizeof *s->chain + sizeof *s->scratch + sizeof *s->axis_placed) +
                       (motion_rows_size(s->motion) + all_displacements) * sizeof *s->rows;
  char *memory = workspace_reserve(q->workspace, WORKSPACE_ROBOT, bytes);
  if (!memory) return false;
  s->parts = (part_state *)(void *)memory;
  s->axes = (axis_state *)(void *)(s->parts + robot->n_parts + 1);
  s->chain = (chain_axis *)(void *)(s->axes + n_axes);
  s->rows = (double *)(void *)(s->chain + n_axes);
  s->scratch = s->rows + motion_rows_size(s->motion);
  s->displacements = all_displacements ? s->scratch + n_axes : NULL;
  s->axis_placed = (uint32_t *)(void *)(s->scratch + n_axes + all_displacements);
  for (size_t i = 0; i < n_axes; i++) s->axis_placed[i] = 0;

  const size_t listed = q->set ? q->set->n_unbounded : last - first;
  for (size_t i = 0; i < listed; i++)
    if (robot_scene_add_obstacles(s, q->set ? q->set->unbounded[i] : first + i) < 0) return false;
  for (size_t i = 0; i < robot->n_parts; i++) s->parts[i] = (part_state){.body = part_body(q, i)};

  s->n_pairs = list_pairs(s, NULL);
  s->pairs = workspace_reserve(q->workspace, WORKSPACE_ROBOT_PAIRS, (s->n_pairs + 1) * sizeof *s->pairs);
  if (!s->pairs) return false;
  list_pairs(s, s->pairs);
  return true;
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
  s->node++;
  s->over = (motion_interval){.a = a, .b = b, .first = segment, .last = segment + 1};
  s->segment = segment, s->u = 0.5 * (a + b);
  s->bent = false;
  motion_fill_rows(s->motion, segment, a, b, s->rows);
}

void robot_scene_enter_span(robot_scene *s, const motion_interval *over) {
  if (!motion_is_span(over)) {
    robot_scene_enter(s, over->first, over->a, over->b);
    return;
  }
  s->node++;
  s->over = *over;
  const span_centre centre = motion_fill_span(s->motion, over->first, over->a, over->last, over->b, s->rows);
  s->segment = centre.segment, s->u = centre.u;
  s->bent = centre.bent;
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
    motion_find_axis(s->motion, &s->over, s->rows, (size_t)next, s->axes);
    s->axis_placed[next] = s->node;
  }
}

static void place_part(robot_scene *s, int32_t index) {
  part_state *state = &s->parts[index];
  const robot_part *part = &s->motion->robot->parts[index];
  place_axis(s, part->axis);
  state->body.side.at = part->axis < 0 ? part->at : placement_compose(&s->axes[part->axis].frame, &part->at);
  state->placed = s->node;
}

static inline part_state *place(robot_scene *s, int32_t index) {
  part_state *state = &s->parts[index];
  if (state->placed != s->node) place_part(s, index);
  return state;
}

const robot_body *robot_scene_moving(robot_scene *s, const robot_pair *pair) {
  const robot_body *body = &place(s, pair->moving)->body;
  return pair->element[0] < 0 ? body : robot_element_make(body, pair->element[0], &s->element[0]);
}

const robot_body *robot_scene_standing(robot_scene *s, const robot_pair *pair) {
  const robot_body *body = pair->self ? &place(s, pair->standing)->body : &s->obstacles[pair->standing];
  return pair->element[1] < 0 ? body : robot_element_make(body, pair->element[1], &s->element[1]);
}

/* What the motion of a pair's moving side is seen from. */
static int32_t seen_from_axis(const robot_scene *s, const robot_pair *pair) {
  return pair->self ? s->motion->robot->parts[pair->standing].axis : -1;
}

static void find_motion(robot_scene *s, const robot_pair *pair, const robot_body *body, chain_motion *m) {
  const size_t n =
      motion_chain(s->motion, seen_from_axis(s, pair), s->motion->robot->parts[pair->moving].axis, s->chain);
  motion_of_part(s->axes, s->chain, n, body->side.at.p, body->radius + body->side.error, s->scratch, m);
}

/* How far a whole part moves, seen from the world; its displacements are known then. */
static double displacement_of_part(robot_scene *s, int32_t index) {
  part_state *state = place(s, index);
  if (state->displaced == s->node) return state->displacement;
  const robot_body *body = &state->body;
  const int32_t axis = s->motion->robot->parts[index].axis;
  double *displacements = s->displacements ? s->displacements + (size_t)index * s->n_displacements : NULL;
  state->displaced = s->node;
  state->displacement =
      motion_displacements(s->motion, s->axes, axis, displacements ? robot_axis_depth(s->motion->robot, axis) : 0,
                           body->side.at.p, body->radius + body->side.error, displacements);
  return state->displacement;
}

double robot_scene_coarse_displacement(robot_scene *s, const robot_pair *pair) {
  const double coarse = displacement_of_part(s, pair->moving);
  if (!pair->self) return coarse;
  const double other = displacement_of_part(s, pair->standing);
  if (!s->displacements) return coarse + other;
  return s->displacements[(size_t)pair->moving * s->n_displacements + pair->shared] +
         s->displacements[(size_t)pair->standing * s->n_displacements + pair->shared];
}

double robot_scene_displacement(robot_scene *s, const robot_pair *pair, const robot_body *moving) {
  if (!pair->self && pair->element[0] < 0) return displacement_of_part(s, pair->moving);
  return motion_displacement(s->motion, s->axes, seen_from_axis(s, pair), s->motion->robot->parts[pair->moving].axis,
                             moving->side.at.p, moving->radius + moving->side.error);
}

const chain_motion *robot_scene_motion(robot_scene *s, const robot_pair *pair, const robot_body *moving,
                                       chain_motion *own) {
  if (pair->self || pair->element[0] >= 0) {
    find_motion(s, pair, moving, own);
    return own;
  }
  part_state *state = &s->parts[pair->moving];
  if (state->moved != s->node) find_motion(s, pair, moving, &state->motion);
  state->moved = s->node;
  return &state->motion;
}

/* ---- cheap distances ---- */

/* Of a point from the box round a body, or from its halfspace. */
static double from_box(const robot_body *body, vec3 point) {
  const vec3 y = placement_turn_back(&body->side.at, vec_sub(point, body->side.at.p));
  if (is_halfspace(body)) {
    const double *h = body->side.shape->size;
    return h[0] * y.x + h[1] * y.y + h[2] * y.z + h[3];
  }
  const vec3 z = vec_sub(y, body->middle);
  const vec3 out = vec(greater(fabs(z.x) - body->half.x, 0.0), greater(fabs(z.y) - body->half.y, 0.0),
                       greater(fabs(z.z) - body->half.z, 0.0));
  return vec_norm(out);
}

double robot_scene_balls(const robot_body *moving, const robot_body *standing) {
  if (is_halfspace(standing)) return -INFINITY;
  const double between = vec_norm(vec_sub(moving->side.at.p, standing->side.at.p));
  const double radii = moving->radius + standing->radius;
  return between - radii - ROUND_UP * (moving->side.error + standing->side.error + 8.0 * ROUND_U * (between + radii));
}

double robot_scene_ball_distance(const robot_body *moving, const robot_body *standing) {
  const vec3 apart = vec_sub(moving->side.at.p, standing->side.at.p);
  double most = from_box(standing, moving->side.at.p) - standing->side.margin - moving->radius;
  if (!is_halfspace(standing))
    most = greater(most, from_box(moving, standing->side.at.p) - moving->side.margin - standing->radius);
  const double sizes = vec_norm(apart) + moving->radius +
                       (is_halfspace(standing) ? fabs(standing->side.shape->size[3]) : standing->radius);
  return most - ROUND_UP * (moving->side.error + standing->side.error + 40.0 * ROUND_U * sizes);
}

vec3 robot_scene_guess(const robot_body *moving, const robot_body *standing) {
  if (is_halfspace(standing)) return vec(0, 0, 0);
  const vec3 apart = vec_sub(moving->side.at.p, standing->side.at.p), half = standing->half;
  const vec3 y = vec_sub(placement_turn_back(&standing->side.at, apart), standing->middle);
  const vec3 out = vec(copysign(greater(fabs(y.x) - half.x, 0.0), y.x), copysign(greater(fabs(y.y) - half.y, 0.0), y.y),
                       copysign(greater(fabs(y.z) - half.z, 0.0), y.z));
  const double length = vec_norm(out);
  return length > 0.0 ? vec_scale(1.0 / length, out) : vec(0, 0, 0);
}

double robot_scene_height(const robot_body *standing, vec3 normal) {
  if (!is_halfspace(standing)) return bound_height(&standing->side, normal);
  return standing->side.margin - standing->side.shape->size[3];
}

/* ---- the distance ---- */

static void measure_halfspace(const robot_body *moving, const robot_body *standing, robot_gap *gap) {
  const double *h = standing->side.shape->size;
  const vec3 n = placement_turn(&standing->side.at, vec(h[0], h[1], h[2]));
  vec3 at;
  const convex *shape = moving->side.shape;
  const double low = -shape->ops->support(shape, placement_turn_back(&moving->side.at, vec_neg(n)), NULL, &at);
  const double along = vec_dot(n, vec_sub(moving->side.at.p, standing->side.at.p));
  const double distance = along + h[3] + low - moving->side.margin - standing->side.margin;
  const double sizes =
      vec_norm(vec_sub(moving->side.at.p, standing->side.at.p)) + fabs(h[3]) + moving->radius + standing->side.margin;
  const double rounding =
      ROUND_UP * (moving->side.error + standing->side.error + 40.0 * ROUND_U * sizes + 2.0 * shape->slack);
  const vec3 lowest = vec_axpy(placement_apply(&moving->side.at, at), -moving->side.margin, n);
  *gap = (robot_gap){.lower = distance - rounding,
                     .upper = distance + rounding,
                     .slack = rounding,
                     .on_moving = lowest,
                     .on_standing = distance > 0.0 ? vec_axpy(lowest, -distance, n) : lowest,
                     .normal = n,
                     .support_failed = isnan(distance)};
}

/* What moves, in the frame of what stands. */
static pair_placement seen_from(const robot_body *standing, const robot_body *moving) {
  pair_placement seen = {.error = moving->side.error + standing->side.error};
  for (int i = 0; i < 3; i++) {
    const double *r = moving->side.at.r;
    const vec3 column = placement_turn_back(&standing->side.at, vec(r[i], r[3 + i], r[6 + i]));
    seen.r[i] = column.x, seen.r[3 + i] = column.y, seen.r[6 + i] = column.z;
  }
  const vec3 apart = vec_sub(moving->side.at.p, standing->side.at.p);
  seen.t = placement_turn_back(&standing->side.at, apart);
  seen.error += ROUND_UP * ROUND_U * ROUND_ROTATION * (vec_norm(apart) + moving->radius);
  return seen;
}

void robot_scene_measure(const robot_body *moving, const robot_body *standing, robot_accuracy accuracy,
                         robot_gap *gap) {
  if (is_halfspace(standing)) {
    measure_halfspace(moving, standing, gap);
    return;
  }
  const pair_placement seen = seen_from(standing, moving);
  const pair_goal goal = {.epsilon = accuracy.epsilon,
                          .floor = accuracy.floor,
                          .fraction = accuracy.fraction,
                          .start = vec_neg(accuracy.start),
                          .max_steps = GAP_STEPS,
                          .wants_feature = true};
  pair_answer answer;
  pair_separate(standing->side.shape, standing->side.margin, moving->side.shape, moving->side.margin, &seen, &goal,
                &answer);
  *gap = (robot_gap){
      .support_failed = answer.support_failed, .lower = answer.lower, .upper = answer.upper, .slack = answer.rounding};
  if (answer.support_failed) return;
  const bool apart = answer.upper > 0.0;
  gap->on_standing = placement_apply(&standing->side.at, apart ? answer.on_a : answer.common);
  gap->on_moving = placement_apply(&standing->side.at, apart ? answer.on_b : answer.common);
  gap->normal = vec_neg(placement_turn(&standing->side.at, answer.normal));
  if (!apart) return;
  if (!answer.feature.flat) {
    for (int i = 0; i < 6; i++) gap->hessian[i] = answer.feature.hessian[i];
    return;
  }
  gap->n = answer.feature.n;
  for (int i = 0; i < gap->n && i < 3; i++) {
    gap->on_edge[i] = placement_apply(&moving->side.at, answer.feature.b[i]);
    gap->across[i] = vec_neg(placement_turn(&standing->side.at, answer.feature.w[i]));
  }
}

/* The direction from 0 to the flat through the points, towards `like`; (0,0,0) where there is none. */
static vec3 direction_of(const vec3 *w, int n, vec3 like) {
  vec3 v = w[0];
  if (n == 2) {
    const vec3 e = vec_sub(w[1], w[0]);
    v = vec_axpy(v, -vec_dot(v, e) / vec_norm2(e), e);
  } else if (n == 3) {
    v = vec_cross(vec_sub(w[1], w[0]), vec_sub(w[2], w[0]));
  }
  const double length = vec_norm(v);
  if (!(length > 0.0)) return vec(0, 0, 0);
  return vec_scale((vec_dot(v, like) < 0.0 ? -1.0 : 1.0) / length, v);
}

static vec3 orthogonal_part(vec3 normal_rate, vec3 normal) {
  return vec_finite(normal_rate) ? vec_axpy(normal_rate, -vec_dot(normal_rate, normal), normal) : vec(0, 0, 0);
}

/* As if what moves were only shifted, as fast as its nearest point moves. */
static vec3 normal_rate_of_curved(const robot_gap *gap, const robot_body *moving, const robot_body *standing,
                                  const chain_motion *motion) {
  const vec3 from = vec_sub(gap->on_moving, moving->side.at.p);
  const vec3 v = placement_turn_back(&standing->side.at, vec_add(motion->v, vec_cross(motion->omega, from)));
  const double *h = gap->hessian;
  const vec3 turned = vec(h[0] * v.x + h[1] * v.y + h[2] * v.z, h[1] * v.x + h[3] * v.y + h[4] * v.z,
                          h[2] * v.x + h[4] * v.y + h[5] * v.z);
  return orthogonal_part(placement_turn(&standing->side.at, turned), gap->normal);
}

/* By a difference quotient: any rate of the normal is allowed, this one is near the best. */
vec3 robot_scene_normal_rate(const robot_gap *gap, const robot_body *moving, const robot_body *standing,
                             const chain_motion *motion) {
  static const double STEP = 1e-5;
  vec3 n[2];
  if (gap->n < 1) return normal_rate_of_curved(gap, moving, standing, motion);
  for (int k = 0; k < 2; k++) {
    vec3 w[3];
    for (int i = 0; i < gap->n; i++) {
      const vec3 from = vec_sub(gap->on_edge[i], moving->side.at.p);
      const vec3 velocity = vec_add(motion->v, vec_cross(motion->omega, from));
      w[i] = vec_axpy(gap->across[i], k == 0 ? -STEP : STEP, velocity);
    }
    n[k] = direction_of(w, gap->n, gap->normal);
  }
  return orthogonal_part(vec_scale(0.5 / STEP, vec_sub(n[1], n[0])), gap->normal);
}
