/* SPDX-License-Identifier: BSD-3-Clause */
#include "robot_query/bound_node.h"

#include <math.h>

#include "base/rounding.h"
#include "base/workspace.h"
#include "broadphase/obstacle_set.h"
#include "robot_query/cluster.h"
#include "robot_query/deviation.h"
#include "robot_query/groups.h"
#include "robot_query/measure.h"

/* Of a pair that is too far to matter in the middle only so much of the excess need be known. */
static const double EXCESS_FRACTION = 0.05;

/* Parts that move farther than their own size, and than this fraction of their distance, are split before they are
 * measured. */
static const double MOST_DISPLACEMENT = 0.5;

/* Normals that turn faster than this over a node are taken to stand still. */
static const double FASTEST_NORMAL_RATE = 0.5;

/* Pairs are opened while there are no more than so many: the node is too long for more, halves will tell. */
enum { MOST_OPEN = 512 };

/* Groups move farther than what is near in them, so they are opened up to this many times that. */
static const double GROUP_DISPLACEMENT = 4.0;

/* Where a plane in the middle asks for more pieces than this, no distance is measured. */
static const double ENOUGH_PIECES = 3.0;

/* The pair's last normal, carried on to where the scene is as it turned; in the standing frame. (0,0,0) where there is
 * none. */
static vec3 known_normal(const robot_search *o, const robot_pair *pair) {
  if (!pair->normal_known) return vec(0, 0, 0);
  const double here = robot_scene_place(&o->scene, o->scene.centre.segment, o->scene.centre.u);
  const double away = here >= pair->from && here <= pair->to ? here - pair->found : 0.0;
  const vec3 n = vec_axpy(pair->normal, away, pair->normal_rate);
  return vec_scale(1.0 / vec_norm(n), n);
}

/* The beginning and the end of the node that the scene is at, along the motion; in that of one segment, of the segment.
 */
static void ends_of_node(const robot_search *o, bool whole, double *from, double *to) {
  const motion_interval *over = &o->scene.over;
  const bool segment = whole && !motion_is_span(over);
  *from = robot_scene_place(&o->scene, over->first, segment ? 0.0 : over->a);
  *to = robot_scene_place(&o->scene, over->last - 1, segment ? 1.0 : over->b);
}

static double width_of_node(const robot_search *o) {
  double from, to;
  ends_of_node(o, false, &from, &to);
  return to - from;
}

static vec3 normal_in_middle(const robot_search *o, const placed_robot_pair *p) {
  const vec3 n = placement_turn(&p->standing->side.at, known_normal(o, p->pair));
  return vec_scale(1.0 / vec_norm(n), n);
}

/* In the place of a normal that is not known yet. */
static void keep_guess(const robot_search *o, const placed_robot_pair *p) {
  const vec3 guess = robot_pair_guess(p->moving, p->standing);
  if (vec_norm2(guess) > 0.0) robot_place_normal(o, p->pair, guess);
}

/* How far the two are apart along it: only to choose by, its rounding is not counted. */
static double plane_middle(robot_search *o, const placed_robot_pair *p) {
  const vec3 n = normal_in_middle(o, p);
  bound_side side = p->nominal->side;
  if (o->scene.q->errors && !deviation_losses(&o->scene, p, n, 0.0, false, &side)) return -INFINITY;
  const double along = vec_dot(n, vec_sub(p->moving->side.at.p, p->standing->side.at.p));
  return along + bound_lowest(&side, n) - side.margin * vec_norm(n) - robot_pair_height(p->standing, n);
}

/* What that normal says of the node. */
static double bound_by_normal(robot_search *o, const placed_robot_pair *p, double goal, double *slack) {
  const robot_pair *pair = p->pair;
  const robot_body *moving = p->nominal, *standing = p->standing;
  const double here = robot_scene_place(&o->scene, o->scene.centre.segment, o->scene.centre.u);
  const bool turning = here >= pair->from && here <= pair->to;
  const vec3 n = normal_in_middle(o, p);
  if (pair->self && robot_scene_has_two_times(&o->scene)) {
    o->planes++;
    return motion_plane_bound_of_two(p->motion, &o->scene.times, &moving->side, &standing->side, n,
                                     robot_pair_height(standing, n), moving->steps + standing->steps, slack);
  }
  vec3 normal_rate = placement_turn(&standing->side.at, vec_scale(turning ? width_of_node(o) : 0.0, pair->normal_rate));
  normal_rate = vec_axpy(normal_rate, -vec_dot(normal_rate, n), n);
  if (!(vec_norm2(normal_rate) < FASTEST_NORMAL_RATE * FASTEST_NORMAL_RATE)) normal_rate = vec(0, 0, 0);
  double heights[2];
  heights[0] = robot_pair_height(standing, vec_axpy(n, -0.5, normal_rate));
  heights[1] = vec_norm2(normal_rate) > 0.0 ? robot_pair_height(standing, vec_axpy(n, 0.5, normal_rate)) : heights[0];
  o->planes++;
  bound_side side = moving->side;
  if (o->scene.q->errors && !deviation_losses(&o->scene, p, n, vec_norm(normal_rate), true, &side)) return -INFINITY;
  return motion_plane_bound(p->motion, &side, &standing->side, n, normal_rate, heights, moving->steps + standing->steps,
                            goal, slack);
}

/* What a cut into so many pieces would do for one pair counts for the node. */
static void want_pieces(robot_search *o, double pieces) {
  o->pieces = greater(pieces, o->pieces);
}

/* A pair that is `middle` apart in the middle, of which the whole node says `bound`: what is lost shrinks as the square
 * of the length on the piece that is nearest; on others it may shrink slower, but there is more to lose. */
static double pieces_for(const robot_search *o, double middle, double bound) {
  const double goal = robot_pruning_bound(o);
  return middle > goal ? sqrt(1.05 * (middle - bound) / (middle - goal)) : 2.0;
}

/* The plane of the distance just measured, turning as its feature does. */
static double bound_by_gap(robot_search *o, const placed_robot_pair *p, const robot_gap *gap, double *slack) {
  if (robot_scene_has_two_times(&o->scene)) return bound_by_normal(o, p, 0.0, slack);
  const vec3 rate = robot_pair_normal_rate(gap, p->nominal, p->standing, p->motion);
  p->pair->normal_rate = placement_turn_back(&p->standing->side.at, vec_scale(1.0 / width_of_node(o), rate));
  ends_of_node(o, true, &p->pair->from, &p->pair->to);
  return bound_by_normal(o, p, robot_pruning_bound(o), slack);
}

static bool keep_entry(robot_search *o, const list_entry *entry) {
  list_entry *next = workspace_reserve(o->scene.q->workspace, WORKSPACE_ROBOT_NEXT, (o->n_next + 1) * sizeof *next);
  if (!next) return false;
  o->next = next;
  next[o->n_next++] = *entry;
  return true;
}

/* One of the pairs of elements that take the place of a pair: kept where its own plane does not settle it. */
static cprox_status enlist(robot_search *o, search_node *node, const robot_pair *whole, const robot_found *found) {
  robot_pair pair = {.moving = whole->moving,
                     .standing = whole->standing,
                     .element = {found->element[0], found->element[1]},
                     .near = {ROBOT_WHOLE, ROBOT_WHOLE},
                     .self = whole->self,
                     .common = whole->common,
                     .shared = whole->shared};
  placed_robot_pair p;
  placed_robot_pair_of(&o->scene, &pair, &p);
  const double displacement = placed_robot_pair_move(&p)->displacement;
  robot_keep_normal(o, &p, &found->gap);
  list_entry entry = {.lower = found->gap.lower - displacement, .bounded = true};
  double slack = p.moving->side.error + p.standing->side.error;
  if (!robot_is_pruned(o, entry.lower) && pair.normal_known && found->gap.upper > 0.0)
    entry.lower = fmax(entry.lower, bound_by_gap(o, &p, &found->gap, &slack));
  if (robot_is_pruned(o, entry.lower)) {
    o->dropped = fmin(o->dropped, entry.lower);
    return CPROX_OK;
  }
  entry.pair = robot_scene_add_pair(&o->scene, &pair);
  if (entry.pair < 0 || !keep_entry(o, &entry))
    return workspace_fail(o->scene.q->workspace, CPROX_MEMORY, "no memory for the elements of a mesh");
  if (entry.lower < node->lower) node->lower = entry.lower, node->slack = slack;
  return CPROX_OK;
}

/* The nearest elements in the middle, if they are nearer than the best, or of a verdict violate its limit: less what
 * the part moves they bound all. */
static cprox_status bound_by_nearest(robot_search *o, const placed_robot_pair *p, list_entry *entry,
                                     const robot_gap *hulls) {
  const double limit = o->goal.limit, best = o->best_bound.upper;
  const double reach = limit >= 0.0 ? lesser(best, nextafter(limit, INFINITY)) : best;
  robot_refinement nearest = robot_refinement_from(o, p, hulls, reach, 0.0);
  const cprox_status status = robot_refine_elements(o, &nearest);
  if (status >= 0 && nearest.complete)
    entry->lower = fmax(entry->lower, nearest.rest - p->motion->displacement - hulls->slack);
  return status;
}

/* The hulls do not settle it: what of their elements comes near enough takes the place of the pair. */
static cprox_status refine_pair_elements(robot_search *o, const placed_robot_pair *p, search_node *node,
                                         list_entry *entry, const robot_gap *hulls) {
  const double displacement = p->motion->displacement, room = displacement + 4.0 * hulls->slack;
  robot_refinement c = robot_refinement_from(o, p, hulls, robot_pruning_bound(o) + room, room);
  c.listing = true;
  const cprox_status status = robot_refine_elements(o, &c);
  if (status < 0) return status;
  if (!c.complete) return o->goal.limit >= 0.0 ? bound_by_nearest(o, p, entry, hulls) : CPROX_OK;
  entry->lower = fmax(entry->lower, c.rest - displacement - hulls->slack);
  const robot_pair whole = *p->pair;
  for (size_t i = 0; i < c.n_found; i++) {
    const cprox_status listed = enlist(o, node, &whole, &c.found[i]);
    if (listed < 0) return listed;
  }
  return CPROX_OK;
}

/* Raises the bound of one pair over the node that the scene is at by balls and boxes. A part that moves too far to be
 * measured wants the node cut. */
static void bound_pair_roughly(robot_search *o, const search_node *node, list_entry *entry) {
  placed_robot_pair p;
  placed_robot_pair_at(&o->scene, entry->pair, &p);
  entry->needs_split = false;
  o->balls++;
  double coarse = INFINITY;
  if (robot_pair_is_whole(p.pair)) {
    coarse = placed_robot_pair_coarse_displacement(&p);
    entry->lower = greater(robot_pair_balls(p.moving, p.standing) - coarse, entry->lower);
    if (robot_is_pruned(o, entry->lower)) return;
  }
  const double apart = robot_pair_ball_distance(p.moving, p.standing);
  entry->lower = greater(apart - coarse, entry->lower);
  if (robot_is_pruned(o, entry->lower)) return;
  const double displacement = placed_robot_pair_displacement(&p);
  entry->lower = greater(apart - displacement, entry->lower);
  const double size = greater(MOST_DISPLACEMENT * apart, p.moving->radius);
  if (robot_is_pruned(o, entry->lower) || !(displacement > size) || robot_is_short(o, node)) return;
  const double round = placed_robot_pair_round_displacement(&p);
  entry->lower = greater(apart - round, entry->lower);
  if (robot_is_pruned(o, entry->lower) || round <= size) return;
  entry->needs_split = true;
  want_pieces(o, lesser(displacement, round) / size);
}

static inline cprox_status keep_open(robot_search *o, const list_entry *entry) {
  if (!robot_is_pruned(o, entry->lower)) return keep_entry(o, entry) ? CPROX_OK : robot_no_memory(o);
  o->dropped = lesser(entry->lower, o->dropped);
  return CPROX_OK;
}

/* The clusters of one side take the place of the pair. */
static cprox_status open_pair(robot_search *o, const placed_robot_pair *p, const search_node *node, list_entry *entry) {
  uint32_t count;
  const int32_t first = placed_robot_pair_open(p, &count);
  if (first < 0) return robot_no_memory(o);
  o->refined = true;
  cprox_status status = CPROX_OK;
  for (uint32_t i = 0; i < count && status == CPROX_OK; i++) {
    list_entry inner = {.lower = entry->lower, .pair = first + (int32_t)i};
    bound_pair_roughly(o, node, &inner);
    status = keep_open(o, &inner);
  }
  entry->lower = INFINITY;
  return status;
}

/* Of a posture the nearest elements say all. What is nearer than the best by no more than rounding is not looked for.
 */
static cprox_status bound_posture(robot_search *o, const placed_robot_pair *p, list_entry *entry,
                                  const robot_gap *hulls) {
  const double rounding = hulls->slack;
  const double reach =
      o->goal.limit < 0.0 ? lesser(o->best_bound.upper, o->goal.cutoff) : robot_pruning_bound(o) + 4.0 * rounding;
  robot_refinement c = robot_refinement_from(o, p, hulls, reach, -rounding);
  const cprox_status status = robot_refine_elements(o, &c);
  if (status >= 0 && c.complete) entry->lower = fmax(entry->lower, c.rest - hulls->slack);
  return status;
}

/* The same by planes and distances, the cheapest way that settles it. */
static cprox_status bound_pair(robot_search *o, search_node *node, list_entry *entry, double *slack) {
  placed_robot_pair p;
  placed_robot_pair_at(&o->scene, entry->pair, &p);
  *slack = p.moving->side.error + p.standing->side.error;
  const double displacement = placed_robot_pair_move(&p)->displacement;
  const bool can_open = robot_can_open((const robot_body *const[2]){p.moving, p.standing});

  if (!p.pair->normal_known) keep_guess(o, &p);
  if (p.pair->normal_known) {
    const double bound = bound_by_normal(o, &p, robot_pruning_bound(o), slack);
    entry->lower = fmax(entry->lower, bound);
    if (robot_is_pruned(o, entry->lower)) return CPROX_OK;

    /* verdicts: a plane that parts the two in the middle says how short the pieces must be; no distance could say much
     * more */
    const double pieces = o->goal.limit >= 0.0 ? pieces_for(o, plane_middle(o, &p), bound) : 2.0;
    if (pieces > ENOUGH_PIECES && !robot_is_short(o, node)) {
      want_pieces(o, pieces);
      return CPROX_OK;
    }
  }

  /* another pair wants the node cut: pieces will tell more */
  if (o->cut) return CPROX_OK;
  robot_gap gap;
  const robot_accuracy accuracy = {.epsilon = ROBOT_GAP_FRACTION * o->goal.epsilon,
                                   .floor = robot_pruning_bound(o),
                                   .fraction = EXCESS_FRACTION,
                                   .start = known_normal(o, p.pair),
                                   .depth = o->goal.is_signed};
  const cprox_status status = robot_measure(o, &p, accuracy, &gap);
  if (status < 0) return status;
  entry->lower = fmax(entry->lower, gap.lower - displacement);
  /* in the middle; what errors take off is less along the normal than along any */
  const double middle = o->scene.q->errors ? gap.upper : gap.lower;
  if (p.pair->normal_known && (gap.upper + gap.loss > 0.0 || o->goal.is_signed))
    entry->lower = fmax(entry->lower, bound_by_gap(o, &p, &gap, slack));
  if (robot_is_pruned(o, entry->lower)) return CPROX_OK;
  if (o->scene.motion->is_state && !o->scene.q->errors && !placed_robot_pair_is_convex(&p))
    return bound_posture(o, &p, entry, &gap);
  const double pieces = pieces_for(o, middle, entry->lower);
  if (can_open && !robot_is_pruned(o, middle) && o->goal.limit < 0.0 && robot_pair_is_whole(p.pair)) {
    const cprox_status refined = bound_by_nearest(o, &p, entry, &gap);
    if (refined < 0 || robot_is_pruned(o, entry->lower)) return refined;
  }
  const bool too_many = o->n_next > MOST_OPEN && !robot_is_short(o, node);
  if (can_open && !too_many && (!robot_is_pruned(o, middle) || robot_is_short(o, node)))
    return open_pair(o, &p, node, entry);
  want_pieces(o, pieces);
  if (can_open || placed_robot_pair_is_convex(&p) || robot_is_pruned(o, entry->lower)) return CPROX_OK;

  /* where the hulls are far enough apart in the middle, halves will settle them: their elements cannot do better */
  if (o->goal.limit < 0.0 && middle < o->best_bound.upper) {
    const cprox_status refined = bound_by_nearest(o, &p, entry, &gap);
    if (refined < 0 || robot_is_pruned(o, entry->lower)) return refined;
  }
  if (robot_is_pruned(o, middle) && !robot_is_short(o, node)) return CPROX_OK;
  return refine_pair_elements(o, &p, node, entry, &gap);
}

/* The pairs of a part and the obstacle in a box of the set's tree. */
static cprox_status open_box(robot_search *o, const search_node *node, const list_entry *entry) {
  size_t count;
  const int32_t pairs = cluster_pairs(&o->scene, entry->part, entry->under, &count);
  if (pairs < 0) return robot_no_memory(o);
  cprox_status status = CPROX_OK;
  for (size_t k = 0; k < count && status == CPROX_OK; k++) {
    list_entry one = {.lower = entry->lower, .pair = pairs + (int32_t)k};
    bound_pair_roughly(o, node, &one);
    status = keep_open(o, &one);
  }
  return status;
}

/* From this bound on what is under a node of the set's tree, or in two groups, does not matter. */
static double pruning_bar(const robot_search *o) {
  const double bound = robot_pruning_bound(o);
  return o->goal.limit >= 0.0 ? nextafter(bound, INFINITY) : bound;
}

/* What is under a node of the set's tree and within reach of a part: pairs, or, where the part moves too far for these
 * to be measured, nodes that hold them. */
static cprox_status open_cluster(robot_search *o, const search_node *node, const list_entry *entry,
                                 const cluster_view *view) {
  const bool is_short = robot_is_short(o, node);
  const double bar = pruning_bar(o);
  uint32_t stack[TREE_LANES * TREE_DEEPEST];
  stack[0] = entry->under;
  size_t n = 1;
  cprox_status status = CPROX_OK;
  while (n > 0 && status == CPROX_OK) {
    const uint32_t at = stack[--n];
    cluster_lanes lanes;
    cluster_measure(view, at, bar, &lanes);
    if (lanes.live && (at & TREE_LEAF)) cluster_measure_boxes(view, at, bar, &lanes);
    o->dropped = lesser(lanes.dropped, o->dropped);
    for (uint32_t left = lanes.live; left && status == CPROX_OK; left &= left - 1) {
      const uint32_t l = (uint32_t)__builtin_ctz(left);
      const double size = greater(MOST_DISPLACEMENT * lanes.apart[l], view->radius);
      list_entry lane = *entry;
      lane.lower = greater(lanes.lower[l], entry->lower), lane.under = lanes.under[l];
      lane.needs_split = view->displacement > size && !is_short;
      if (at & TREE_LEAF) {
        status = open_box(o, node, &lane);
      } else if (lane.needs_split) {
        want_pieces(o, view->displacement / size);
        status = keep_open(o, &lane);
      } else {
        stack[n++] = lane.under;
      }
    }
  }
  return status;
}

/* Two single parts. */
static cprox_status open_parts(robot_search *o, const search_node *node, group_pair groups, double lower) {
  list_entry one = {.lower = lower, .pair = robot_groups_pair(&o->scene, groups)};
  if (one.pair < 0) return robot_no_memory(o);
  bound_pair_roughly(o, node, &one);
  return keep_open(o, &one);
}

/* Two groups, on a stack. */
typedef struct open_groups {
  group_pair groups;
  double lower, displacement; /* neither group's parts move farther than those of what contains them */
} open_groups;

/* Raises the bound of two groups. Whether they move too far to be opened on this node, which they want cut. */
static bool bound_groups(robot_search *o, const search_node *node, double bar, open_groups *pair) {
  const double apart = robot_groups_apart(&o->scene, pair->groups);
  pair->lower = greater(apart - pair->displacement, pair->lower);
  if (pair->lower >= bar) return false;
  pair->displacement = lesser(robot_groups_displacement(&o->scene, pair->groups), pair->displacement);
  pair->lower = greater(apart - pair->displacement, pair->lower);
  if (pair->lower >= bar || robot_groups_are_parts(&o->scene, pair->groups)) return false;
  const double size = greater(MOST_DISPLACEMENT * apart, robot_groups_radius(&o->scene, pair->groups));
  if (!(pair->displacement > GROUP_DISPLACEMENT * size) || robot_is_short(o, node)) return false;
  want_pieces(o, pair->displacement / (GROUP_DISPLACEMENT * size));
  return true;
}

/* Two groups of parts: what is within reach of each other becomes pairs, or, where they move too far for these to be
 * measured, pairs of groups. */
static cprox_status open_groups_of(robot_search *o, const search_node *node, const list_entry *entry) {
  const double bar = pruning_bar(o);
  open_groups stack[GROUP_STACK];
  stack[0] = (open_groups){{{entry->part, (int32_t)entry->under}}, entry->lower, INFINITY};
  size_t n = 1;
  cprox_status status = CPROX_OK;
  while (n > 0 && status == CPROX_OK) {
    open_groups top = stack[--n];
    const bool needs_split = !group_pair_is_one(top.groups) && bound_groups(o, node, bar, &top);
    if (top.lower >= bar) {
      o->dropped = lesser(top.lower, o->dropped);
    } else if (robot_groups_are_parts(&o->scene, top.groups)) {
      status = open_parts(o, node, top.groups, top.lower);
    } else if (needs_split) {
      const list_entry kept = {.lower = top.lower,
                               .pair = LIST_GROUPS,
                               .part = top.groups.group[0],
                               .under = (uint32_t)top.groups.group[1],
                               .needs_split = true};
      status = keep_open(o, &kept);
    } else {
      group_pair inside[GROUP_PAIRS_INSIDE];
      const size_t count = robot_groups_open(&o->scene, top.groups, inside);
      for (size_t i = 0; i < count; i++) stack[n++] = (open_groups){inside[i], top.lower, top.displacement};
    }
  }
  return status;
}

/* Of two times: whether the side on the other clock moves farther than that on the lead; of the first pair of the list.
 */
static bool other_moves_farther(robot_search *o) {
  robot_scene *s = &o->scene;
  double other = 0.0, lead = 0.0;
  for (size_t i = 0; i < o->n_next; i++)
    if (o->next[i].pair >= 0) {
      robot_scene_displacements(s, &s->pairs[o->next[i].pair], &other, &lead);
      return other > lead;
    }
  return motion_time(s->motion, s->other.last - 1, s->other.b) - motion_time(s->motion, s->other.first, s->other.a) >
         motion_time(s->motion, s->over.last - 1, s->over.b) - motion_time(s->motion, s->over.first, s->over.a);
}

/* A node of a robot of a thousand links has a hundred thousand pairs: the stop function is asked between them, too. One
 * distance is measured all the same (robot_must_end). */
static bool is_stopped(robot_search *o) {
  enum { BALLS_BETWEEN_LOOKS = 256 };
  search_goal *goal = &o->goal;
  const bool looks = goal->stop && o->balls % BALLS_BETWEEN_LOOKS == BALLS_BETWEEN_LOOKS - 1;
  if (looks && goal->ended == CPROX_OK && goal->stop(goal->stop_user)) goal->ended = CPROX_STOPPED;
  return goal->ended == CPROX_STOPPED;
}

/* Balls and boxes of all pairs of a node; those that still matter are kept. What is not bounded yet when the search
 * must stop stays as it is. */
static cprox_status bound_roughly(robot_search *o, const search_node *node, int32_t list) {
  const size_t n = lists_count(&o->lists, list);
  const bool sweeps = o->scene.motion->sweeps != NULL;
  cluster_view view = {.part = -1};
  cprox_status status = CPROX_OK;
  for (size_t i = 0; i < n && status == CPROX_OK; i++) {
    list_entry entry = lists_at(&o->lists, list)[i];
    if (robot_is_pruned(o, entry.lower)) {
      o->dropped = lesser(entry.lower, o->dropped);
    } else if (entry.pair == LIST_CLUSTER) {
      if (view.part != entry.part) view = cluster_see(&o->scene, entry.part, true);
      status = open_cluster(o, node, &entry, &view);
    } else if (entry.pair < 0) {
      status = open_groups_of(o, node, &entry);
    } else {
      if (sweeps) entry.lower = greater(robot_scene_swept_apart(&o->scene, &o->scene.pairs[entry.pair]), entry.lower);
      if ((!sweeps || !robot_is_pruned(o, entry.lower)) && !is_stopped(o)) bound_pair_roughly(o, node, &entry);
      status = keep_open(o, &entry);
    }
  }
  return status;
}

/* ---- what stands ---- */

/* Raises the bound of a pair to what its distance is, as far as that can be less than the best. */
static cprox_status measure_standing(robot_search *o, list_entry *entry) {
  const robot_accuracy accuracy = {.epsilon = ROBOT_GAP_FRACTION * o->goal.epsilon,
                                   .floor = robot_pruning_bound(o),
                                   .fraction = EXCESS_FRACTION,
                                   .depth = o->goal.is_signed};
  robot_gap gap;
  placed_robot_pair p;
  placed_robot_pair_at(&o->scene, entry->pair, &p);
  const cprox_status status = robot_measure(o, &p, accuracy, &gap);
  if (status < 0) return status;
  entry->lower = fmax(entry->lower, gap.lower);
  if (placed_robot_pair_is_convex(&p) || robot_is_pruned(o, entry->lower)) return CPROX_OK;
  return bound_posture(o, &p, entry, &gap);
}

static cprox_status settle_entries(robot_search *o) {
  cprox_status status = CPROX_OK;
  /* the nearest first: the others need only be known to be farther */
  for (size_t i = 1; i < o->n_next; i++)
    if (o->next[i].lower < o->next[0].lower) {
      const list_entry nearer = o->next[i];
      o->next[i] = o->next[0], o->next[0] = nearer;
    }
  for (size_t i = 0; i < o->n_next && status >= 0; i++) {
    list_entry entry = o->next[i];
    const bool open = !robot_is_answered(o) && !robot_is_pruned(o, entry.lower);
    if (open && !robot_must_end(o)) status = measure_standing(o, &entry);
    o->dropped = lesser(entry.lower, o->dropped);
    /* from left to right: it may touch from the beginning on */
    if (o->goal.limit >= 0.0 && entry.lower <= o->goal.limit) o->unsure = true;
  }
  return status;
}

cprox_status robot_settle_standing(robot_search *o, const search_node *root) {
  const int32_t list = o->standing;
  if (list < 0) return CPROX_OK;
  o->standing = -1;
  if (o->scene.groups) robot_groups_choose(&o->scene, PAIRS_STANDING);
  const motion_interval over = robot_interval(root);
  robot_scene_enter(&o->scene, over.first, over.a, over.a);
  const robot_sample best = o->best;
  const search_best bound = o->best_bound;
  cprox_status status = o->best.pair < 0 ? robot_seed_here(o, list) : CPROX_OK;
  o->n_next = 0;
  if (status >= 0) status = bound_roughly(o, root, list);
  if (status >= 0) status = settle_entries(o);
  lists_release(&o->lists, list);
  if (o->scene.groups) robot_groups_choose(&o->scene, PAIRS_MOVING);
  /* from left to right: what stands as near as epsilon, and does not touch, hides no contact that comes later */
  const bool in_time = o->goal.order == SEARCH_LEFT_TO_RIGHT;
  if (in_time && !o->unsure && !isfinite(o->touch_at) && lists_count(&o->lists, robot_known(root)->list) > 0)
    o->best = best, o->best_bound = bound;
  return status;
}

cprox_status robot_bound_node(robot_search *o, search_node *node) {
  robot_node *payload = robot_own(node);
  const int32_t old = payload->list;
  const double inherited = node->lower;
  const motion_interval over = robot_interval(node), other = robot_other_interval(node);
  robot_scene_enter_both(&o->scene, &over, &other);
  o->n_next = 0;
  const cprox_status rough = bound_roughly(o, node, old);
  if (rough < 0) return rough;
  if (robot_scene_has_two_times(&o->scene)) o->cut_other = other_moves_farther(o);

  /* those that stay move to the front, what takes the place of a pair comes behind the last one */
  o->cut = o->pieces > 2.0;
  size_t kept = 0;
  node->lower = INFINITY;
  for (size_t i = 0; i < o->n_next; i++) {
    list_entry entry = o->next[i];
    double slack = 0.0;
    if (!robot_is_pruned(o, entry.lower) && !entry.needs_split && !entry.bounded && !robot_scene_is_bent(&o->scene) &&
        !robot_must_end(o)) {
      const cprox_status status = bound_pair(o, node, &entry, &slack);
      if (status < 0) return status;
      if (robot_is_answered(o)) {
        node->lower = inherited;
        return CPROX_OK;
      }
    }
    if (robot_is_pruned(o, entry.lower)) {
      o->dropped = lesser(entry.lower, o->dropped);
      continue;
    }
    entry.bounded = false;
    o->next[kept++] = entry;
    if (entry.lower < node->lower) node->lower = entry.lower, node->slack = slack;
  }
  o->n_next = kept;

  const int32_t list = lists_take(&o->lists, o->n_next);
  if (list < 0) return CPROX_MEMORY;
  list_entry *to = lists_at(&o->lists, list);
  for (size_t i = 0; i < o->n_next; i++) to[i] = o->next[i];
  lists_set_count(&o->lists, list, o->n_next);
  lists_release(&o->lists, old);
  payload->list = list;
  node->lower = fmax(node->lower, inherited);
  return CPROX_OK;
}
