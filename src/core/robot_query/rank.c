/* SPDX-License-Identifier: BSD-3-Clause */
#include "robot_query/rank.h"

#include <math.h>
#include <stdlib.h>

#include "base/rounding.h"
#include "robot_query/measure.h"

/* Into about so many pieces the motion is cut. */
enum { PIECES = 16 };

typedef struct ranking {
  const query *q;
  robot_scene scene;
  pair_rank *rank; /* in the order of the pairs */
  size_t n;
  bool looked; /* at one piece: what stands is as far on all others */
  bool stopped;
} ranking;

static size_t parts_of_geometry(const ranking *r, int32_t geometry) {
  return body_n_parts(r->scene.motion->robot->given_geometries[geometry].body);
}

/* The scene lists the pairs of convex parts of one pair after the other. */
static size_t parts_of_pair(const ranking *r, const cprox_robot_pair *pair) {
  const size_t others =
      mover_is_self(&r->q->mover) ? parts_of_geometry(r, pair->other) : body_n_parts(r->q->obstacles[pair->other].body);
  return parts_of_geometry(r, pair->geometry) * others;
}

static void look_at_parts(robot_scene *s, robot_pair *pair, pair_rank *rank) {
  placed_robot_pair p;
  placed_robot_pair_of(s, pair, &p);
  const double apart = robot_pair_ball_distance(p.moving, p.standing);
  rank->near = lesser(rank->near, apart);
  if (rank->lower > -INFINITY) rank->lower = lesser(rank->lower, apart - placed_robot_pair_coarse_displacement(&p));
}

static void look_over(ranking *r, const motion_interval *over) {
  robot_scene *s = &r->scene;
  robot_scene_enter_span(s, over);
  size_t at = 0;
  for (size_t i = 0; i < r->n; i++) {
    const size_t parts = parts_of_pair(r, &r->q->mover.pairs[i]);
    for (size_t k = 0; k < parts; k++, at++)
      if (!r->looked || !robot_scene_stands(s, &s->pairs[at])) look_at_parts(s, &s->pairs[at], &r->rank[i]);
  }
  r->looked = true;
  r->stopped = r->stopped || (r->q->options.stop && r->q->options.stop(r->q->options.stop_user));
}

/* Pieces of a single segment. */
static void look_over_segment(ranking *r, const motion_interval *over, size_t pieces) {
  double from = over->a;
  for (size_t k = 1; k <= pieces && !r->stopped; k++) {
    const double to = k == pieces ? over->b : over->a + (over->b - over->a) * (double)k / (double)pieces;
    look_over(r, &(motion_interval){.a = from, .b = to, .first = over->first, .last = over->last});
    from = to;
  }
}

/* Pieces of about the same time, from knot to knot. */
static void look_over_segments(ranking *r, const motion_interval *over) {
  const cprox_motion *m = r->scene.motion;
  const double t0 = motion_time(m, over->first, over->a), t1 = motion_time(m, over->last - 1, over->b);
  size_t from = over->first;
  for (size_t k = 1; k <= PIECES && from < over->last && !r->stopped; k++) {
    const size_t to = k == PIECES
                          ? over->last
                          : robot_knot_near(m, over->first, over->last, 1, t0 + (t1 - t0) * (double)k / (double)PIECES);
    if (to <= from) continue;
    look_over(r, &(motion_interval){.a = from == over->first ? over->a : 0.0,
                                    .b = to == over->last ? over->b : 1.0,
                                    .first = from,
                                    .last = to});
    from = to;
  }
}

static int nearer_first(const void *a, const void *b) {
  const pair_rank *x = a, *y = b;
  if (x->near != y->near) return x->near < y->near ? -1 : 1;
  return (x->pair > y->pair) - (x->pair < y->pair);
}

pair_rank *robot_rank_pairs(const query *q) {
  ranking r = {.q = q, .n = q->mover.n_pairs};
  r.rank = workspace_reserve(q->workspace, WORKSPACE_ROBOT_RANKING, (r.n + 1) * sizeof *r.rank);
  if (!r.rank || !robot_scene_begin(&r.scene, q, NULL, 0, q->n, SIZE_MAX, INFINITY)) return NULL;
  for (size_t i = 0; i < r.n; i++) r.rank[i] = (pair_rank){.lower = INFINITY, .near = INFINITY, .pair = i};

  const motion_interval over = motion_interval_of(q->mover.motion, q->t0, q->t1);
  const size_t segments = over.last - over.first;
  if (segments >= PIECES) look_over_segments(&r, &over);
  for (size_t i = over.first; segments < PIECES && i < over.last; i++) {
    const motion_interval one = {
        .a = i == over.first ? over.a : 0.0, .b = i + 1 == over.last ? over.b : 1.0, .first = i, .last = i + 1};
    look_over_segment(&r, &one, (PIECES + segments - 1) / segments);
  }
  /* where it was ended, not all of the motion was looked at */
  const bool vague = r.stopped || start_class_is_one_of_many(q->mover.motion); /* or starts are not known */
  for (size_t i = 0; vague && i < r.n; i++) r.rank[i].lower = -INFINITY;
  qsort(r.rank, r.n, sizeof *r.rank, nearer_first);
  return r.rank;
}
