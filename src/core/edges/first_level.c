/* SPDX-License-Identifier: BSD-3-Clause */
#include "edges/first_level.h"

#include <math.h>
#include <string.h>

#include "edges/kernels.h"

/* Beyond these the trees and groups of the search find what is near sooner than lanes do. */
enum { MOST_OBSTACLES = 512, MOST_NEAR = 4096, MOST_OPEN = 256 };

/* So many times eight intervals: what they leave open is left to the search. */
enum { MOST_BATCHES = 32 };

/* A motion of more segments is cut at its knots by the search, which takes many at once. */
enum { MOST_SEGMENTS = 16 };

/* ---- the model ---- */

static edge_asked asked_of(const query *q) {
  const cprox_mover *m = &q->mover;
  const bool self = mover_is_self(m), whole = mover_is_whole(m);
  edge_asked asked = {.robot = m->motion->robot, .about_obstacles = !self, .about_self = self || whole};
  if (!self) asked.pairs = m->pairs, asked.n_pairs = m->pairs ? m->n_pairs : 0;
  if (asked.pairs) asked.n_obstacles = q->n;
  if (self) asked.self_pairs = m->pairs, asked.n_self_pairs = m->pairs ? m->n_pairs : 0;
  if (whole) asked.self_pairs = m->self_pairs, asked.n_self_pairs = m->self_pairs ? m->n_self_pairs : 0;
  return asked;
}

static size_t aligned(size_t bytes) {
  return (bytes + 63) / 64 * 64;
}

/* NULL: there is none for this robot, or memory is out. */
static cprox_edge_checker *model_of(const query *q) {
  const edge_asked asked = asked_of(q);
  const workspace_buffer buffer = mover_is_self(&q->mover)    ? WORKSPACE_EDGE_SELF
                                  : mover_is_whole(&q->mover) ? WORKSPACE_EDGE_WHOLE
                                                              : WORKSPACE_EDGE_ROBOT;
  return edge_model_keep(&asked, q->workspace, buffer);
}

/* ---- what is left ---- */

static int32_t obstacle_of(const cprox_edge_checker *c, uint32_t near) {
  return c->obstacles[c->near[near]].obstacle;
}

static const edge_part *part_of(const cprox_edge_checker *c, uint32_t near) {
  const edge_part *part = c->parts;
  while (near >= part->first_near + part->n_near) part++;
  return part;
}

static void add_obstacle(edge_rest *rest, size_t obstacle) {
  if (rest->n_pairs == 0 || obstacle < rest->first) rest->first = obstacle;
  if (rest->n_pairs == 0 || obstacle >= rest->last) rest->last = obstacle + 1;
}

/* Two geometries of the robot, in the order of the caller's list. */
static cprox_robot_pair as_asked(const query *q, int32_t a, int32_t b) {
  const edge_asked asked = asked_of(q);
  for (size_t i = 0; asked.self_pairs && i < asked.n_self_pairs; i++)
    if (asked.self_pairs[i].geometry == b && asked.self_pairs[i].other == a) return asked.self_pairs[i];
  return (cprox_robot_pair){a, b};
}

/* The pairs of geometries of what lanes left open, in an order of their own, to lists that have room for them. */
static void take_open(const query *q, const cprox_edge_checker *c, const edge_open *open, cprox_robot_pair *pairs,
                      cprox_robot_pair *selves, edge_rest *rest) {
  for (uint32_t i = 0; i < open->n; i++) {
    const uint32_t number = open->pairs[i];
    const bool self = number >= c->n_near;
    const edge_pair *two = self ? &c->lane_pairs[number - c->n_near] : NULL;
    const edge_part *part = self ? &c->parts[two->a] : part_of(c, number), *other = self ? &c->parts[two->b] : NULL;
    bool known = false; /* by another part of the same obstacle */
    for (uint32_t k = 0; k < i && !self && !known; k++)
      known = open->pairs[k] < c->n_near && obstacle_of(c, open->pairs[k]) == obstacle_of(c, number) &&
              part_of(c, open->pairs[k]) == part;
    for (uint32_t k = part->first_member; k < part->first_member + part->n_members && !known; k++) {
      if (!self) add_obstacle(rest, (size_t)obstacle_of(c, number));
      if (!self) pairs[rest->n_pairs++] = (cprox_robot_pair){c->members[k], obstacle_of(c, number)};
      for (uint32_t l = 0; self && l < other->n_members; l++)
        selves[rest->n_self_pairs++] = as_asked(q, c->members[k], c->members[other->first_member + l]);
    }
  }
  rest->pairs = pairs, rest->self_pairs = selves;
}

/* ---- times ---- */

/* Where the edge's parameter, seen from its middle, is along the motion. */
static double time_of(const query *q, const motion_interval *over, double at) {
  const double u = over->a + (over->b - over->a) * (0.5 + at);
  return fmin(fmax(motion_time(q->mover.motion, over->first, fmin(fmax(u, 0.0), 1.0)), q->t0), q->t1);
}

/* Adds the part of a segment from one parameter to another one to the times that are open, rounding on the side of
 * more. */
static void add_times(const query *q, const motion_interval *over, const edge_open *open, edge_rest *rest) {
  const cprox_motion *m = q->mover.motion;
  const double width = over->b - over->a, room = 0x1p-44;
  const double a = fmax(over->a + width * (0.5 + (double)open->from) - room, 0.0),
               b = fmin(over->a + width * (0.5 + (double)open->to) + room, 1.0);
  const double from = motion_time_below(m, over->first, a), to = motion_time(m, over->first, b);
  const double up = 0x1p-50 * (fabs(to) + fabs(m->times[over->first]));
  rest->from = lesser(greater(from, q->t0), rest->from);
  rest->to = greater(lesser(to + up, q->t1), rest->to);
}

/* ---- lanes ---- */

static bool can_ask(const query *q, size_t first, size_t last, motion_interval *over) {
  const cprox_motion *m = q->mover.motion;
  if (!query_wants_verdict(q) || q->choice != PAIRS_ALL || q->options.max_lod != CPROX_LOD_MESH || q->is_signed ||
      m->n_tracks != 1 || m->tracks[0].tolerance > 0.0 || last - first > MOST_OBSTACLES || !(q->limit < 1e6))
    return false;
  *over = motion_interval_of(m, q->t0, q->t1);
  return over->last - over->first <= MOST_SEGMENTS;
}

/* One pair at one time. */
static void take_one(const query *q, int32_t geometry, int32_t other, bool self, double at, cprox_robot_pair *pair,
                     edge_rest *rest) {
  *pair = self ? as_asked(q, geometry, other) : (cprox_robot_pair){geometry, other};
  *rest = (edge_rest){.pairs = pair, .self_pairs = pair, .n_pairs = !self, .n_self_pairs = self, .from = at, .to = at};
  if (!self) rest->first = (size_t)other, rest->last = (size_t)other + 1;
}

static void take_nearest(const query *q, const cprox_edge_checker *c, const edge_found *f, const motion_interval *over,
                         cprox_robot_pair *pair, edge_rest *rest) {
  *rest = (edge_rest){.n_pairs = 0};
  if (f->nearest == UINT32_MAX) return;
  const bool self = f->nearest >= c->n_near;
  const edge_pair *two = self ? &c->lane_pairs[f->nearest - c->n_near] : NULL;
  const edge_part *part = self ? &c->parts[two->a] : part_of(c, f->nearest);
  const int32_t other = self ? c->members[c->parts[two->b].first_member] : obstacle_of(c, f->nearest);
  take_one(q, c->members[part->first_member], other, self, time_of(q, over, (double)f->nearest_at), pair, rest);
}

/* All that a query needs in the workspace. */
typedef struct edge_run {
  edge_motion motion;
  edge_losses losses;
  edge_lanes lanes;
  edge_open all;                    /* what is open in any segment */
  uint32_t *known;                  /* whether it is there */
  cprox_robot_pair *pairs, *selves; /* room for the rest */
  uint64_t batches;
} edge_run;

static bool fill_segment(const query *q, const cprox_edge_checker *c, const motion_interval *segment, edge_run *run) {
  if (!edge_motion_fill_along(c, q->mover.motion, segment, &run->motion)) return false;
  if (q->errors) edge_losses_over(q, c, segment, &run->motion, &run->losses);
  return true;
}

/* How far each part comes from the base, errors included, on one segment after another, the first one last. */
static bool fill_reach(const query *q, const cprox_edge_checker *c, const motion_interval *over, edge_run *run,
                       double *reach) {
  for (size_t i = 0; i < c->n_parts; i++) reach[i] = 0.0;
  for (size_t k = over->last; k-- > over->first;) {
    const motion_interval segment = edge_segment(over, k);
    if (!fill_segment(q, c, &segment, run)) return false;
    for (size_t i = 0; i < c->n_parts; i++) {
      const double off = q->errors ? (double)run->losses.standing[i] : 0.0;
      reach[i] = greater(edge_motion_reach(c, &run->motion, i) + off, reach[i]);
    }
  }
  return true;
}

/* The model's other side. False: beyond single precision, or memory is out. */
static bool place(const query *q, cprox_edge_checker *c, size_t first, size_t last, const motion_interval *over,
                  edge_run *run) {
  size_t n_obstacles = 0;
  for (size_t i = first; i < last; i++) n_obstacles += body_n_parts(q->obstacles[i].body);
  if (n_obstacles > MOST_OBSTACLES) return false;
  const size_t scene = aligned(edge_model_scene_size(c, q->obstacles, first, last)),
               moves = aligned(edge_motion_size(c)), reaches = aligned(c->n_parts * sizeof(double)),
               losses = q->errors ? aligned(edge_losses_size(c)) : 0, near = c->n_parts * n_obstacles,
               noted = near + c->n_lane_pairs + 1, listed = c->n_members * n_obstacles + 1,
               rows = aligned(edge_lanes_size(c, near < MOST_NEAR ? near : MOST_NEAR));
  size_t selves = 1;
  for (size_t i = 0; i < c->n_lane_pairs; i++)
    selves += (size_t)c->parts[c->lane_pairs[i].a].n_members * c->parts[c->lane_pairs[i].b].n_members;
  const size_t lists = (listed + selves) * sizeof(cprox_robot_pair);
  char *memory = workspace_reserve(q->workspace, WORKSPACE_EDGE_SCENE,
                                   64 + rows + moves + losses + reaches + scene + lists + 4 * noted * sizeof(uint32_t));
  if (!memory) return false;
  memory += 64 - (uintptr_t)memory % 64;
  *run = (edge_run){.motion = edge_motion_in(c, memory + rows), .lanes = {.memory = memory, .measures = true}};
  memory += rows + moves;
  if (q->errors) run->losses = edge_losses_in(c, q, first, last, memory), run->motion.losses = &run->losses;
  double *reach = (double *)(void *)(memory + losses);
  memory += losses + reaches;
  if (!fill_reach(q, c, over, run, reach)) return false;
  if (!c->has_scene) /* of many states all are within reach of what the robot can reach */
    edge_model_fill_scene(c, q->obstacles, first, last, q->is_bare ? NULL : reach, memory);
  run->pairs = (cprox_robot_pair *)(void *)(memory + scene), run->selves = run->pairs + listed;
  uint32_t *marks = (uint32_t *)(void *)(run->selves + selves);
  memset(marks, 0, 2 * noted * sizeof *marks);
  run->lanes.open.seen = marks, run->known = marks + noted;
  run->lanes.open.pairs = marks + 2 * noted, run->all.pairs = marks + 3 * noted;
  const uint64_t done = workspace_work(q->workspace), most = q->options.max_nodes;
  run->batches = done < most ? most - done : 1;
  if (run->batches > MOST_BATCHES + over->last - over->first) run->batches = MOST_BATCHES + over->last - over->first;
  c->has_scene = c->in_lanes && c->n_near <= MOST_NEAR;
  return c->has_scene;
}

static void add_open(edge_run *run) {
  const edge_open *open = &run->lanes.open;
  for (uint32_t i = 0; i < open->n; i++) {
    if (run->known[open->pairs[i]]) continue;
    run->known[open->pairs[i]] = 1;
    run->all.pairs[run->all.n++] = open->pairs[i];
  }
}

/* One segment after another; `nearest` is where the least of all was found. False: lanes cannot tell. */
static bool look_along(const query *q, const cprox_edge_checker *c, const motion_interval *over, edge_run *run,
                       edge_found *f, motion_interval *nearest, edge_rest *rest) {
  edge_kernel *kernel = edge_kernel_at(simd_of_machine());
  *f = (edge_found){.verdict = CPROX_VERDICT_CLEAR, .least = INFINITY, .nearest = UINT32_MAX};
  *rest = (edge_rest){.from = INFINITY, .to = -INFINITY};
  for (size_t k = over->first; k < over->last; k++) {
    const motion_interval segment = edge_segment(over, k);
    if (over->last - over->first > 1 && !fill_segment(q, c, &segment, run)) return false;
    if (run->batches == 0) return false;
    run->lanes.open.edge++, run->lanes.most_batches = (uint32_t)run->batches;
    edge_found one;
    kernel(c, &run->motion, &run->lanes, &one);
    if (one.too_much) return false;
    run->batches -= one.batches < run->batches ? one.batches : run->batches;
    if (one.verdict == CPROX_VERDICT_VIOLATED || one.is_suspect) {
      *f = one, *nearest = segment;
      return true;
    }
    if (one.verdict == CPROX_VERDICT_UNDECIDED) {
      add_open(run), add_times(q, &segment, &run->lanes.open, rest);
      f->verdict = CPROX_VERDICT_UNDECIDED;
    }
    if (one.least < f->least)
      f->least = one.least, f->nearest = one.nearest, f->nearest_at = one.nearest_at, *nearest = segment;
  }
  return run->all.n <= MOST_OPEN;
}

bool edge_first_level(const query *q, size_t first, size_t last, bool suspects, edge_first *found) {
  motion_interval over, nearest;
  if (!can_ask(q, first, last, &over)) return false;
  cprox_edge_checker *c = model_of(q);
  if (!c || !c->in_lanes) return false;
  edge_run run;
  c->clear_beyond = c->hit_within = q->limit;
  c->has_scene = c->has_scene && q->is_repeated;
  const bool placed = place(q, c, first, last, &over, &run);
  c->in_lanes = true; /* the robot's side is */
  if (!placed || c->n_near + c->n_lane_pairs == 0) return false;
  edge_found f;
  *found = (edge_first){.verdict = CPROX_VERDICT_UNDECIDED};
  nearest = over;
  run.lanes.suspects = suspects;
  if (!look_along(q, c, &over, &run, &f, &nearest, &found->rest)) return false;
  found->is_suspect = f.is_suspect;
  found->verdict = f.is_suspect ? CPROX_VERDICT_VIOLATED : f.verdict;
  if (found->verdict == CPROX_VERDICT_VIOLATED) {
    take_one(q, f.geometry, f.other, f.self, time_of(q, &nearest, (double)f.at), run.pairs, &found->rest);
    return true;
  }
  const double least = lesser((double)f.least * (1.0 - 0x1p-20), c->beyond);
  found->lower = greater(q->limit + greater(least, 0.0) * (1.0 - 0x1p-50), nextafter(q->limit, INFINITY));
  if (f.verdict == CPROX_VERDICT_CLEAR) {
    take_nearest(q, c, &f, &nearest, run.pairs, &found->nearest);
    return true;
  }
  if (!(found->rest.from < found->rest.to)) found->rest.from = q->t0, found->rest.to = q->t1;
  take_open(q, c, &run.all, run.pairs, run.selves, &found->rest);
  return true;
}
