/* SPDX-License-Identifier: BSD-3-Clause */
#include "robot_query/refine.h"

#include <math.h>

#include "base/rounding.h"
#include "base/workspace.h"

/* More than so many elements near each other: the node is too long, halves will tell more. */
enum { MOST_FOUND = 256 };

/* What is out of reach need not be measured any better than this fraction of how far it is beyond. */
static const double BEYOND = 0.9;

enum { MOVING, STANDING };

/* Through one side's tree, with the other side as what its elements are near to. */
typedef struct descent {
  tree_seeker seeker; /* first: the seeker that a visitor gets is the descent */
  robot_refinement *refinement;
  const robot_body *side[2];
  int32_t code[2];
  int through;      /* whose tree it is */
  double allowance; /* what the tree's own bounds may be off by, and the elements' margin */
} descent;

/* A lower bound of the distance along any n of length 1 within 8 u, rounding included: the sides lie behind two planes
 * across n. Not of a halfspace. */
static double apart_along(const robot_body *const side[2], vec3 n) {
  const bound_side *m = &side[MOVING]->side, *s = &side[STANDING]->side;
  const vec3 apart = vec_sub(m->at.p, s->at.p);
  const double along = vec_dot(n, apart) - bound_height(m, vec_neg(n)) - bound_height(s, n);
  const double sizes = vec_norm(apart) + m->shape->scale + m->margin + s->shape->scale + s->margin;
  return along - ROUND_UP * (m->error + s->error + m->shape->slack + s->shape->slack + 128.0 * ROUND_U * sizes);
}

/* Do the two lie apart by the plane that told others of these sides apart? Neighbouring elements are often behind the
 * same one. */
static bool is_behind(const robot_refinement *c, const robot_body *const side[2], int level) {
  const vec3 n = c->last[level];
  return vec_norm2(n) > 0.0 && !robot_body_is_halfspace(side[STANDING]) && apart_along(side, n) >= c->reach;
}

/* Nothing is in reach any more. */
static void abandon(robot_refinement *c) {
  c->reach = -INFINITY;
  c->complete = false;
}

/* The distance of the two, and its normal for those that come next. What is out of reach need not be known well; of
 * hulls that have elements, only whether they are. */
static void ask(robot_refinement *c, const robot_body *const side[2], int level, robot_gap *gap) {
  robot_accuracy accuracy = {.epsilon = c->accuracy, .floor = c->reach, .fraction = BEYOND, .verdict = level == 0};
  if (vec_norm2(c->last[level]) > 0.0) accuracy.start = placement_turn_back(&side[STANDING]->side.at, c->last[level]);
  robot_pair_measure(side[MOVING], side[STANDING], accuracy, gap);
  c->gaps++;
  const bool measured = c->measured || c->nearest.gap.upper < INFINITY;
  if (c->goal && measured && search_must_end(c->goal, c->work + c->gaps)) abandon(c);
  if (!gap->support_failed && gap->upper > 0.0) c->last[level] = gap->normal;
}

static void fail(robot_refinement *c) {
  c->support_failed = true;
  abandon(c);
}

static void keep(robot_refinement *c, const int32_t code[2], const robot_gap *gap) {
  const robot_found found = {.element = {code[0], code[1]}, .gap = *gap};
  c->least = fmin(c->least, gap->lower);
  if (gap->upper < c->nearest.gap.upper) c->nearest = found;
  c->reach = fmin(c->reach, fmax(gap->upper, 0.0) + c->room);
  if (!c->listing) {
    if (gap->upper <= 0.0) c->reach = -INFINITY; /* nothing is nearer than what touches */
    return;
  }
  if (c->n_found == MOST_FOUND) {
    abandon(c);
    return;
  }
  c->found[c->n_found++] = found;
}

/* Two convex sides: elements, or what has none. */
static void measure(robot_refinement *c, const robot_body *const side[2], const int32_t code[2]) {
  if (robot_pair_ball_distance(side[MOVING], side[STANDING]) >= c->reach) return;
  if (is_behind(c, side, 1)) return;
  robot_gap gap;
  ask(c, side, 1, &gap);
  if (gap.support_failed)
    fail(c);
  else if (gap.lower < c->reach)
    keep(c, code, &gap);
}

static void descend(robot_refinement *c, const robot_body *const side[2], const int32_t code[2], int through);

/* One element and the convex shape of the other side: where these are within reach, the other side's tree. Their own
 * plane tells most of its elements apart. */
static void descend_under(robot_refinement *c, const robot_body *const side[2], const int32_t code[2], int through) {
  if (robot_pair_ball_distance(side[MOVING], side[STANDING]) >= c->reach) return;
  if (is_behind(c, side, 0)) return;
  robot_gap gap;
  ask(c, side, 0, &gap);
  if (gap.support_failed) {
    fail(c);
    return;
  }
  if (gap.lower >= c->reach) return;
  const vec3 normal = c->normal;
  c->normal = gap.upper > 0.0 ? gap.normal : vec(0, 0, 0);
  descend(c, side, code, through);
  c->normal = normal;
}

/* One element: measured, or what it may be near to in the other side's tree. */
static void visit(tree_seeker *seeker, tree_place at, uint32_t element) {
  (void)element;
  descent *d = (descent *)(void *)seeker;
  robot_refinement *c = d->refinement;
  int32_t code[2] = {d->code[0], d->code[1]};
  code[d->through] = robot_element_code(at);
  const robot_body *side[2] = {d->side[0], d->side[1]};
  side[d->through] = robot_element_make(side[d->through], code[d->through], &c->pair->scene->element[d->through]);
  const int other = 1 - d->through;
  if (side[other]->tree)
    descend_under(c, side, code, other);
  else
    measure(c, side, code);
  seeker->bound = c->reach + d->allowance;
}

/* The other side, seen from the tree: its ball, and behind which plane it lies. */
static void descend(robot_refinement *c, const robot_body *const side[2], const int32_t code[2], int through) {
  const robot_body *own = side[through], *shape = side[1 - through];
  descent d = {.refinement = c, .side = {side[0], side[1]}, .code = {code[0], code[1]}, .through = through};
  const vec3 apart = vec_sub(shape->side.at.p, own->side.at.p);
  d.seeker.visit = visit;
  d.seeker.centre = vec_sub(placement_turn_back(&own->side.at, apart), own->tree_at);
  d.seeker.radius = shape->radius;

  /* of a halfspace, what is within reach of the part; its plane says the rest */
  const bool endless = robot_body_is_halfspace(shape);
  if (endless) d.seeker.centre = vec_neg(own->tree_at), d.seeker.radius = own->radius + c->reach;
  if (vec_norm2(c->normal) > 0.0) {
    const vec3 n = through == MOVING ? c->normal : vec_neg(c->normal); /* from the other side to the tree */
    const double high = vec_dot(n, apart) + (endless ? robot_pair_height(shape, n) : bound_height(&shape->side, n));
    d.seeker.known = true;
    d.seeker.normal = vec_neg(placement_turn_back(&own->side.at, n));
    d.seeker.least = -high - vec_dot(d.seeker.normal, own->tree_at);
  }

  /* lengths that enter: where the sides are, how large they are */
  const double sizes = vec_norm(apart) + vec_norm(own->tree_at) + own->tree->scale + own->radius + d.seeker.radius +
                       shape->side.shape->scale + fabs(c->reach);
  d.allowance = own->tree_margin + own->side.error + shape->side.error + shape->side.shape->slack +
                ROUND_UP * ROUND_U * (TREE_ROUND + 64.0) * sizes;
  d.seeker.bound = c->reach + d.allowance;
  tree_seek(own->tree, &d.seeker);
}

/* ---- clusters ---- */

/* Two sides that are still of interest, by their numbers. */
typedef struct open_sides {
  double apart;
  int32_t code[2];
} open_sides;

typedef struct cluster_descent {
  const robot_body *whole[2];
  size_t count;
  open_sides open[2 * TREE_LANES * TREE_DEEPEST];
} cluster_descent;

static const robot_body *side_of(robot_refinement *c, const cluster_descent *d, int which, int32_t code) {
  const robot_body *whole = d->whole[which];
  return code == ROBOT_WHOLE ? whole : robot_element_make(whole, code, &c->pair->scene->element[which]);
}

/* What one side consists of takes its place, the nearest on top. */
static void open_inside(robot_refinement *c, cluster_descent *d, const robot_body *const side[2],
                        const int32_t code[2]) {
  const int opened = robot_side_to_open(side);
  const cluster_hull *hull = robot_cluster_of(side[opened], code[opened]);
  const size_t floor = d->count;
  for (uint32_t i = 0; i < hull->count; i++) {
    open_sides inner = {.code = {code[0], code[1]}};
    inner.code[opened] = robot_inner_code(hull, i);
    const robot_body *const sides[2] = {side_of(c, d, MOVING, inner.code[MOVING]),
                                        side_of(c, d, STANDING, inner.code[STANDING])};
    inner.apart = robot_pair_ball_distance(sides[MOVING], sides[STANDING]);
    if (inner.apart >= c->reach) continue;
    size_t k = d->count++;
    for (; k > floor && d->open[k - 1].apart < inner.apart; k--) d->open[k] = d->open[k - 1];
    d->open[k] = inner;
  }
}

static void visit_sides(robot_refinement *c, cluster_descent *d, const int32_t code[2]) {
  const robot_body *const side[2] = {side_of(c, d, MOVING, code[MOVING]), side_of(c, d, STANDING, code[STANDING])};
  if (!robot_can_open(side)) {
    measure(c, side, code);
    return;
  }
  const bool whole = code[MOVING] == ROBOT_WHOLE && code[STANDING] == ROBOT_WHOLE; /* it is known how far these are */
  if (!whole && is_behind(c, side, 0)) return;
  robot_gap gap = {.lower = -INFINITY};
  if (!whole) ask(c, side, 0, &gap);
  if (gap.support_failed)
    fail(c);
  else if (gap.lower < c->reach)
    open_inside(c, d, side, code);
}

/* The nearest elements by the hulls of clusters. Those that were nearest when the pair was looked at last come first:
 * mostly they still are, or nearly so. */
static void descend_clusters(robot_refinement *c, const robot_body *const side[2]) {
  cluster_descent d;
  d.whole[MOVING] = side[MOVING], d.whole[STANDING] = side[STANDING];
  d.open[0] = (open_sides){.apart = -INFINITY, .code = {ROBOT_WHOLE, ROBOT_WHOLE}};
  d.count = 1;
  robot_pair *known = c->pair->pair;
  if (known->near[MOVING] != known->near[STANDING]) visit_sides(c, &d, known->near);
  while (d.count > 0) {
    const open_sides top = d.open[--d.count];
    if (top.apart < c->reach) visit_sides(c, &d, top.code);
  }
  for (int k = 0; k < 2 && c->nearest.gap.upper < INFINITY; k++) known->near[k] = c->nearest.element[k];
}

/* The standing side's elements first, where both have some: each of them is small. */
void robot_refinement_run(robot_refinement *c) {
  c->n_found = 0, c->gaps = 0;
  c->last[0] = c->last[1] = vec(0, 0, 0);
  c->complete = true;
  c->support_failed = c->no_memory = false;
  c->nearest.gap.upper = c->least = INFINITY;
  if (c->listing) {
    c->found = workspace_reserve(c->pair->scene->q->workspace, WORKSPACE_ROBOT_FOUND, MOST_FOUND * sizeof *c->found);
    c->no_memory = c->found == NULL;
    if (c->no_memory) return;
  }
  const robot_body *const side[2] = {c->pair->moving, c->pair->standing};
  if (!c->listing && robot_can_open(side)) {
    descend_clusters(c, side);
    c->rest = fmin(c->reach, c->least);
    return;
  }
  const int32_t whole[2] = {-1, -1};
  descend(c, side, whole, side[STANDING]->tree ? STANDING : MOVING);
  c->rest = c->listing ? c->reach : fmin(c->reach, c->least);
}
