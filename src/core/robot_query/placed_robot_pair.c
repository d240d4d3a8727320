/* SPDX-License-Identifier: BSD-3-Clause */
#include "robot_query/placed_robot_pair.h"

#include <math.h>

#include "base/rounding.h"
#include "robot_query/deviation.h"
#include "robot_query/groups.h"

/* ---- sides ---- */

/* An element or a cluster, made anew only where it is not the last one. */
static const robot_body *element_of(const robot_scene *s, const robot_body *owner, int32_t part, int32_t code,
                                    bool self, robot_element *element) {
  if (element->node == s->node && element->part == part && element->code == code && element->self == self)
    return &element->body;
  const robot_body *made = robot_element_make(owner, code, element);
  element->node = s->node, element->part = part, element->code = code, element->self = self;
  return made;
}

/* Errors of both sides become a margin of the moving one. */
static void add_errors(placed_robot_pair *p) {
  const deviation d = deviation_of_pair(p->scene, p->pair, p->moving, p->standing, &p->places);
  p->off = *p->moving;
  p->off.side.margin += d.middle, p->off.tree_margin += d.middle, p->off.radius += d.middle;
  p->off.core = robot_core_radius(&p->off);
  p->errors = d;
  p->moving = &p->off;
}

void placed_robot_pair_of(robot_scene *s, robot_pair *pair, placed_robot_pair *p) {
  p->scene = s, p->pair = pair, p->index = -1, p->motion = NULL, p->errors = p->places = (deviation){0.0, 0.0};
  p->moving = robot_scene_part(s, pair->moving);
  p->standing = pair->self ? robot_scene_part(s, pair->standing) : &s->obstacles[pair->standing];
  const int32_t *code = pair->element;
  if (code[0] != ROBOT_WHOLE) p->moving = element_of(s, p->moving, pair->moving, code[0], true, &s->element[0]);
  if (code[1] != ROBOT_WHOLE)
    p->standing = element_of(s, p->standing, pair->standing, code[1], pair->self, &s->element[1]);
  p->nominal = p->moving;
  if (s->q->errors) add_errors(p);
}

void placed_robot_pair_at(robot_scene *s, int32_t index, placed_robot_pair *p) {
  placed_robot_pair_of(s, &s->pairs[index], p);
  p->index = index;
}

int32_t placed_robot_pair_open(const placed_robot_pair *p, uint32_t *count) {
  robot_scene *s = p->scene;
  const robot_pair whole = *p->pair;
  *count = whole.n_inner;
  if (whole.n_inner > 0) return whole.inner;
  const robot_body *const side[2] = {p->moving, p->standing};
  const int opened = robot_side_to_open(side);
  const cluster_hull *hull = robot_cluster_of(side[opened], whole.element[opened]);
  int32_t first = -1;
  for (uint32_t i = 0; i < hull->count; i++) {
    robot_pair inner = whole; /* with the direction that parts the whole */
    inner.element[opened] = robot_inner_code(hull, i);
    const int32_t number = robot_scene_add_pair(s, &inner);
    if (number < 0) return -1;
    if (i == 0) first = number;
  }
  s->pairs[p->index].inner = first, s->pairs[p->index].n_inner = *count = hull->count;
  return first;
}

/* ---- motion ---- */

/* What the motion of the moving side is seen from. */
static int32_t seen_from_axis(const placed_robot_pair *p) {
  return p->pair->self ? p->scene->motion->robot->parts[p->pair->standing].axis : -1;
}

static int32_t moving_axis(const placed_robot_pair *p) {
  return p->scene->motion->robot->parts[p->pair->moving].axis;
}

/* Whether what is known of a side, but for its margin, is its shape: then it may look the same all round an axis. */
static const bound_side *round_side(const robot_body *body) {
  return convex_is_round(body->side.shape) && !body->tree ? &body->side : NULL;
}

/* The axes that move the pair against each other. Those that turn a side about its own axis are left out where the
 * search has one time: both sides stay within *stray of where they are without. Without a turn about the standing side,
 * normals turn with it unseen, towards errors of other axes: where there are errors, none is left out there. The
 * certificate checker does not know of it, so nothing that is written for it rests on that. */
static size_t chain_of(const placed_robot_pair *p, double *stray) {
  const robot_scene *s = p->scene;
  size_t n = motion_chain(s->motion, seen_from_axis(p), moving_axis(p), s->chain);
  *stray = 0.0;
  if (robot_scene_has_two_times(s) || p->moving->side.margin_turns) return n;
  const bound_side *round[2] = {round_side(p->moving), s->q->errors ? NULL : round_side(p->standing)};
  if (round[0] || round[1])
    *stray = motion_leave_out_round(s->axes, s->chain, &n, round[0], round[1], p->moving->steps + p->standing->steps);
  return n;
}

static void find_motion(const placed_robot_pair *p, chain_motion *m) {
  robot_scene *s = p->scene;
  const vec3 centre = p->moving->side.at.p;
  double stray;
  const size_t n = chain_of(p, &stray);
  motion_of_part(s->axes, s->chain, n, centre, p->moving->core, s->scratch, m);
  m->displacement += stray + p->errors.growth, m->stray += stray;
  if (!robot_scene_has_two_times(s) || !p->pair->self) return;
  motion_find_standing_rates(s->axes, s->chain, n, centre, m);
  s->times.standing = start_clock_of(s->motion, p->pair->standing) == s->starts->other;
}

/* Of whole parts against most obstacles it is the same, seen from the world. */
const chain_motion *placed_robot_pair_move(placed_robot_pair *p) {
  if (p->motion) return p->motion;
  part_state *part = &p->scene->parts[p->pair->moving];
  const bool alone =
      p->pair->self || p->pair->element[0] != ROBOT_WHOLE || round_side(p->standing) || p->scene->q->errors;
  chain_motion *to = alone ? &p->own : &part->motion;
  if (alone || part->moved != p->scene->node) find_motion(p, to);
  if (!alone) part->moved = p->scene->node;
  return p->motion = to;
}

double placed_robot_pair_coarse_displacement(const placed_robot_pair *p) {
  robot_scene *s = p->scene;
  const robot_pair *pair = p->pair;
  if (!pair->self) return robot_scene_part_displacement(s, pair->moving) + p->errors.growth;
  if (s->groups) return robot_groups_displacement_of(s, pair);
  const double moving = robot_scene_part_displacement(s, pair->moving),
               standing = robot_scene_part_displacement(s, pair->standing);
  if (!s->displacements) return moving + standing + p->errors.growth;
  return s->displacements[(size_t)pair->moving * s->n_displacements + pair->shared] +
         s->displacements[(size_t)pair->standing * s->n_displacements + pair->shared] + p->errors.growth;
}

double placed_robot_pair_displacement(const placed_robot_pair *p) {
  robot_scene *s = p->scene;
  if (!p->pair->self && p->pair->element[0] == ROBOT_WHOLE)
    return robot_scene_part_displacement(s, p->pair->moving) + p->errors.growth;
  return motion_displacement(s->motion, s->axes, seen_from_axis(p), moving_axis(p), p->moving->side.at.p,
                             p->moving->core) +
         p->errors.growth;
}

double placed_robot_pair_round_displacement(placed_robot_pair *p) {
  if (robot_scene_has_two_times(p->scene) || (!round_side(p->moving) && !round_side(p->standing))) return INFINITY;
  return placed_robot_pair_move(p)->displacement;
}

double placed_robot_pair_travel(robot_scene *s, int32_t index, double lead, double other) {
  const double clock = robot_scene_clock(s, lead, other), t0 = s->q->t0 - clock, t1 = s->q->t1 - clock;
  const bool shifted = s->starts && (s->lead_tolerance > 0.0 || robot_scene_has_two_times(s));
  const motion_interval over =
      shifted ? motion_interval_of(s->motion, lead + t0, lead + t1) : motion_interval_of(s->motion, s->q->t0, s->q->t1);
  const motion_interval late = shifted ? motion_interval_of(s->motion, other + t0, other + t1) : over;
  robot_scene_enter_both(s, &over, &late);
  placed_robot_pair p;
  placed_robot_pair_at(s, index, &p);
  return ROUND_UP * 2.0 * (placed_robot_pair_displacement(&p) + p.moving->side.error + p.standing->side.error);
}
