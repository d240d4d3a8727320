/* SPDX-License-Identifier: BSD-3-Clause */
#include "peers/two_ended.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "robot_query/answer.h"
#include "robot_query/placed_robot_pair.h"
#include "solve/solve.h"

/* A pair on an interval: what is known of its distance at both ends. */
typedef struct ends {
  double lower, at[2];
  int32_t pair;
  bool known[2];
} ends;

typedef struct interval {
  size_t segment;
  double a, b, lower;
  ends *list;
  size_t n;
} interval;

typedef struct search {
  robot_scene scene;
  interval *heap;
  size_t count, room;
  double upper, dropped, epsilon;
  uint32_t nodes, distance_queries;
  int order; /* 0: by both ends */
} search;

static void push(search *s, interval node) {
  if (s->count == s->room) {
    s->room = 2 * s->room + 64;
    s->heap = realloc(s->heap, s->room * sizeof *s->heap);
  }
  size_t i = s->count++;
  for (; i > 0 && s->heap[(i - 1) / 2].lower > node.lower; i = (i - 1) / 2) s->heap[i] = s->heap[(i - 1) / 2];
  s->heap[i] = node;
}

static interval pop(search *s) {
  const interval top = s->heap[0], moved = s->heap[--s->count];
  size_t i = 0;
  for (size_t child = 1; child < s->count; child = 2 * i + 1) {
    if (child + 1 < s->count && s->heap[child + 1].lower < s->heap[child].lower) child++;
    if (s->heap[child].lower >= moved.lower) break;
    s->heap[i] = s->heap[child], i = child;
  }
  s->heap[i] = moved;
  return top;
}

/* How far the part can get along the way: the variation of each axis times a lever_arm that holds everywhere. */
static double way_of(search *s, robot_pair *pair, const axis_state *axes, chain_axis *chain) {
  const cprox_robot *robot = s->scene.motion->robot;
  const robot_part *part = &robot->parts[pair->moving];
  const int32_t from = pair->self ? robot->parts[pair->standing].axis : -1;
  const double standing = pair->self ? robot->parts[pair->standing].reach : 0.0;
  const size_t n = motion_chain(s->scene.motion, from, part->axis, chain);
  placed_robot_pair placed; /* the states of their axes */
  placed_robot_pair_of(&s->scene, pair, &placed);
  double way = 0.0;
  for (size_t i = 0; i < n; i++) {
    const robot_axis *axis = &robot->axes[chain[i].axis];
    double lever_arm = part->reach - axis->reach;
    if (chain[i].sign < 0.0) lever_arm += standing; /* passed upwards: the part beyond hangs on it, too */
    way += axes[chain[i].axis].variation * (axis->kind == AXIS_PRISMATIC ? 1.0 : lever_arm);
  }
  return way;
}

static double ball_gap(search *s, robot_pair *pair) {
  placed_robot_pair placed;
  placed_robot_pair_of(&s->scene, pair, &placed);
  return robot_pair_ball_distance(placed.moving, placed.standing);
}

static double measured_gap(search *s, robot_pair *pair) {
  robot_gap gap;
  placed_robot_pair placed;
  placed_robot_pair_of(&s->scene, pair, &placed);
  robot_pair_measure(placed.moving, placed.standing, (robot_accuracy){.epsilon = 0.02 * s->epsilon}, &gap);
  s->distance_queries++;
  s->upper = fmin(s->upper, fmax(gap.upper, 0.0));
  return fmax(gap.lower, 0.0);
}

/* Bounds all pairs of an interval; keeps those that matter. Balls first, then distances at the ends. */
static void bound(search *s, interval *node) {
  const size_t n_axes = s->scene.motion->robot->n_axes;
  double *ways = malloc(node->n * sizeof *ways);
  chain_axis *chain = malloc((n_axes + 1) * sizeof *chain);
  s->nodes++;
  robot_scene_enter(&s->scene, node->segment, node->a, node->b);
  for (size_t i = 0; i < node->n; i++) ways[i] = way_of(s, &s->scene.pairs[node->list[i].pair], s->scene.axes, chain);
  double *balls[2] = {malloc(node->n * sizeof(double)), malloc(node->n * sizeof(double))};
  for (int end = 0; end < 2; end++) {
    const double u = end == 0 ? node->a : node->b;
    robot_scene_enter(&s->scene, node->segment, u, u);
    for (size_t i = 0; i < node->n; i++) {
      ends *e = &node->list[i];
      balls[end][i] = e->known[end] ? e->at[end] : ball_gap(s, &s->scene.pairs[e->pair]);
    }
  }
  for (int end = 0; end < 2; end++) {
    const double u = end == 0 ? node->a : node->b;
    robot_scene_enter(&s->scene, node->segment, u, u);
    for (size_t i = 0; i < node->n; i++) {
      ends *e = &node->list[i];
      e->lower = fmax(e->lower, 0.5 * (balls[0][i] + balls[1][i] - ways[i]));
      if (e->known[end] || e->lower > s->upper - s->epsilon) continue;
      e->at[end] = balls[end][i] = measured_gap(s, &s->scene.pairs[e->pair]);
      e->known[end] = true;
    }
  }
  size_t kept = 0;
  node->lower = INFINITY;
  for (size_t i = 0; i < node->n; i++) {
    ends e = node->list[i];
    e.lower = fmax(e.lower, 0.5 * (balls[0][i] + balls[1][i] - ways[i]));
    if (e.lower > s->upper - s->epsilon) {
      s->dropped = fmin(s->dropped, e.lower);
      continue;
    }
    node->lower = fmin(node->lower, e.lower);
    node->list[kept++] = e;
  }
  node->n = kept;
  free(ways), free(chain), free(balls[0]), free(balls[1]);
}

/* Bounds all pairs of an interval by what is measured in its middle. */
static void bound_centrally(search *s, interval *node, int order) {
  size_t kept = 0;
  s->nodes++;
  robot_scene_enter(&s->scene, node->segment, node->a, node->b);
  node->lower = INFINITY;
  for (size_t i = 0; i < node->n; i++) {
    ends e = node->list[i];
    placed_robot_pair placed;
    placed_robot_pair_at(&s->scene, e.pair, &placed);
    const robot_body *moving = placed.moving, *standing = placed.standing;
    const chain_motion *motion = placed_robot_pair_move(&placed);
    e.lower = fmax(e.lower, robot_pair_ball_distance(moving, standing) - motion->displacement);
    if (!(e.lower > s->upper - s->epsilon)) {
      robot_gap gap;
      robot_pair_measure(moving, standing, (robot_accuracy){.epsilon = 0.02 * s->epsilon}, &gap);
      s->distance_queries++;
      s->upper = fmin(s->upper, fmax(gap.upper, 0.0));
      e.lower = fmax(e.lower, gap.lower - motion->displacement);
      if (order > 2 && gap.lower > 0.0) {
        const double height = robot_pair_height(standing, gap.normal), heights[2] = {height, height};
        double slack;
        e.lower = fmax(e.lower,
                       motion_plane_bound(motion, &moving->side, &standing->side, gap.normal, vec(0, 0, 0), heights,
                                          moving->steps + standing->steps, order == 3 ? -INFINITY : INFINITY, &slack));
      }
    }
    if (e.lower > s->upper - s->epsilon) {
      s->dropped = fmin(s->dropped, e.lower);
      continue;
    }
    node->lower = fmin(node->lower, e.lower);
    node->list[kept++] = e;
  }
  node->n = kept;
}

static void add(search *s, size_t segment, double a, double b, const interval *parent, int side) {
  interval node = {.segment = segment, .a = a, .b = b, .n = parent ? parent->n : s->scene.n_pairs};
  node.list = malloc((node.n + 1) * sizeof *node.list);
  for (size_t i = 0; i < node.n; i++) {
    node.list[i] = parent ? parent->list[i] : (ends){.lower = -INFINITY, .pair = (int32_t)i};
    if (parent) node.list[i].known[1 - side] = false;
  }
  if (s->order > 0)
    bound_centrally(s, &node, s->order);
  else
    bound(s, &node);
  if (node.n > 0)
    push(s, node);
  else
    free(node.list);
}

static bool begin(search *s, query *q, const cprox_mover *mover, const cprox_obstacle *targets, size_t n,
                  double epsilon, cprox_workspace *workspace) {
  *q = query_create(*mover, targets, n, -1.0, NULL, workspace);
  query_ask_whole(q);
  *s = (search){.upper = INFINITY, .dropped = INFINITY, .epsilon = epsilon};
  return robot_scene_begin(&s->scene, q, NULL, 0, n, SIZE_MAX, INFINITY);
}

void central_distance(const cprox_mover *mover, const cprox_obstacle *targets, size_t n, int order, double epsilon,
                      uint32_t max_nodes, cprox_workspace *workspace, peer_answer *answer) {
  search s;
  query q;
  *answer = (peer_answer){0};
  if (!begin(&s, &q, mover, targets, n, epsilon, workspace)) return;
  s.order = order;
  for (size_t i = 0; i < s.scene.motion->n_segments; i++) add(&s, i, 0.0, 1.0, NULL, 0);
  double lower = INFINITY;
  bool complete = true;
  while (s.count > 0) {
    interval node = pop(&s);
    complete = s.nodes < max_nodes;
    const bool done = node.lower > s.upper - epsilon || s.upper <= 0.0 || !complete;
    if (done) lower = fmin(lower, node.lower);
    if (!done) {
      const double middle = 0.5 * (node.a + node.b);
      add(&s, node.segment, node.a, middle, &node, 0);
      add(&s, node.segment, middle, node.b, &node, 1);
    }
    free(node.list);
    if (done) break;
  }
  for (size_t i = 0; i < s.count; i++) free(s.heap[i].list);
  free(s.heap);
  *answer = (peer_answer){.lower = fmax(fmin(fmin(lower, s.dropped), s.upper), 0.0),
                          .upper = s.upper,
                          .nodes = s.nodes,
                          .distance_queries = s.distance_queries,
                          .complete = complete};
}

void two_ended_distance(const cprox_mover *mover, const cprox_obstacle *targets, size_t n, double epsilon,
                        uint32_t max_nodes, cprox_workspace *workspace, peer_answer *answer) {
  central_distance(mover, targets, n, 0, epsilon, max_nodes, workspace, answer);
}

/* How far the fastest variable moves over a segment. */
static double swing(const cprox_motion *m, size_t segment) {
  const motion_track *t = m->tracks; /* the motions of the benchmark have one */
  double most = 0.0;
  for (size_t k = 0; k < t->n_moving; k++) {
    const double *c = t->coefficients + (segment * t->n_moving + k) * t->stride;
    double way = 0.0;
    for (size_t i = 0; i < t->degree[segment]; i++) way += fabs(c[i + 1] - c[i]);
    most = fmax(most, way);
  }
  return most;
}

int sampled_steps(const cprox_motion *motion, size_t segment, double step) {
  return 1 + (int)(swing(motion, segment) / step);
}

void sampled_distance(const cprox_mover *mover, const cprox_obstacle *targets, size_t n, double step, bool first_hit,
                      cprox_workspace *workspace, peer_answer *answer) {
  search s;
  query q;
  *answer = (peer_answer){0};
  if (!begin(&s, &q, mover, targets, n, 1e-9, workspace)) return;
  for (size_t segment = 0; segment < s.scene.motion->n_segments; segment++) {
    const int count = sampled_steps(s.scene.motion, segment, step);
    for (int i = segment == 0 ? 0 : 1; i <= count; i++) {
      const double u = (double)i / count;
      robot_scene_enter(&s.scene, segment, u, u);
      s.nodes++;
      for (size_t k = 0; k < s.scene.n_pairs; k++) {
        const double near = ball_gap(&s, &s.scene.pairs[k]);
        if (near < s.upper && !(first_hit && near > 0.0)) measured_gap(&s, &s.scene.pairs[k]);
      }
      if (first_hit && s.upper <= 0.0) segment = s.scene.motion->n_segments - 1, i = count;
    }
  }
  *answer = (peer_answer){
      .lower = s.upper, .upper = s.upper, .nodes = s.nodes, .distance_queries = s.distance_queries, .complete = true};
}
