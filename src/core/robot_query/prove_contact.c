/* SPDX-License-Identifier: BSD-3-Clause */
/* Proof of contact, after a search from left to right. */
#include <math.h>

#include "robot_query/measure.h"

/* Times here are those of the lead of the class of starts. */
static double time_of(const robot_search *o, const robot_sample *sample) {
  return sample->pair < 0 ? INFINITY : motion_time_below(o->scene.motion, sample->segment, sample->u);
}

/* The distance of a pair at a time, as exactly as arithmetic has it, or of every pair that may touch (-1); what it
 * proves stands in o->touch. */
static cprox_status measure_pair_at(robot_search *o, int32_t pair, double t, search_best *found) {
  const cprox_motion *m = o->scene.motion;
  const size_t segment = motion_segment_at(m, t);
  const double from = m->times[segment], to = m->times[segment + 1];
  const double u = fmin(fmax((t - from) / (to - from), 0.0), 1.0), known = o->touch_at;
  const motion_interval at = {.a = u, .b = u, .first = segment, .last = segment + 1};
  const double other = t + (o->best.other - time_of(o, &o->best)); /* with the same starts as at the best place */
  const motion_interval late = robot_scene_has_two_times(&o->scene) ? motion_interval_of(m, other, other) : at;
  robot_scene_enter_both(&o->scene, &at, &late);

  /* what was found stays the best, whatever is seen here */
  const robot_sample best = o->best;
  const search_best bound = o->best_bound;
  const double epsilon = o->goal.epsilon;
  o->best_bound = (search_best){.upper = INFINITY, .at = INFINITY};
  o->goal.epsilon = 0.0;
  cprox_status status = CPROX_OK;
  if (pair >= 0) status = robot_measure_whole(o, pair);
  const size_t n = pair < 0 ? o->scene.n_pairs : 0;
  for (size_t i = 0; i < n && status >= 0 && o->touch_at == known && o->goal.ended != CPROX_STOPPED; i++)
    status = robot_measure_if_near(o, (int32_t)i);
  if (pair < 0 && o->scene.groups && status >= 0 && o->touch_at == known)
    status = robot_visit_near_groups(o, (group_pair){{0, 0}}, robot_measure_if_near);
  *found = o->best_bound;
  o->best = best, o->best_bound = bound, o->goal.epsilon = epsilon;
  return status;
}

/* By the speed at which the two approach each other. */
static cprox_status prove_by_speed(robot_search *o, int32_t pair, double t, double first, double end) {
  enum { MOST_STEPS = 8 };
  search_best before, now;
  double step = first;
  cprox_status status = measure_pair_at(o, pair, t, &before);
  for (int i = 0; i < MOST_STEPS && status >= 0 && t + step < time_of(o, &o->touch); i++) {
    const double next = fmin(t + step, end);
    if (!(next > t)) break;
    status = measure_pair_at(o, pair, next, &now);
    if (status < 0 || !(now.upper > 0.0)) break;
    const double speed = (before.upper - now.upper) / (next - t);
    if (!(speed > 0.0)) break;
    /* a little deeper than the surface, or rounding hides it */
    step = (now.upper * (1.0 + 1e-6) + 4.0 * now.slack) / speed + 1e-9 * first;
    t = next, before = now;
  }
  return status;
}

/* Elements that only slide along each other prove nothing, where others of the same two parts do. */
static int32_t whole_pair(const robot_search *o, int32_t index) {
  const robot_pair *of = &o->scene.pairs[index];
  for (size_t i = 0; i < o->scene.n_pairs; i++) {
    const robot_pair *pair = &o->scene.pairs[i];
    if (pair->moving == of->moving && pair->standing == of->standing && pair->self == of->self &&
        pair->element[0] == ROBOT_WHOLE && pair->element[1] == ROBOT_WHOLE)
      return (int32_t)i;
  }
  return index;
}

/* Of the time that is left: the first step by speed; the first of steps that double, which 24 of them outgrow; and how
 * near the beginning of what is proven is brought to the end of what is not. */
static const double FIRST_BY_SPEED = 1e-6, FIRST_DOUBLED = 1e-7, CUT_TO = 1e-9;

cprox_status robot_search_prove(robot_search *o, double end) {
  enum { MOST_STEPS = 24, MOST_CUTS = 40, EVERY_PAIR = -1 };
  const double begin = time_of(o, &o->best), range = end - begin;
  if (o->best.pair < 0 || !(o->best_bound.upper <= o->goal.epsilon) || !(o->best_bound.upper > 0.0) || !(range > 0.0))
    return CPROX_OK;
  const double known = time_of(o, &o->touch);
  search_best unused;
  cprox_status status = prove_by_speed(o, whole_pair(o, o->best.pair), begin, FIRST_BY_SPEED * range, end);
  if (status < 0 || time_of(o, &o->touch) < known) return status;

  /* farther along in growing steps, and then back to where it is not proven */
  double step = FIRST_DOUBLED * range, before = begin;
  for (int i = 0; i < MOST_STEPS && step < range && begin + step < known; i++, step *= 2.0) {
    status = measure_pair_at(o, EVERY_PAIR, begin + step, &unused);
    if (status < 0 || time_of(o, &o->touch) < known) break;
    before = begin + step;
  }
  if (status < 0 || !(time_of(o, &o->touch) < known)) return status;
  const int32_t pair = o->touch.pair;
  for (int i = 0; i < MOST_CUTS && time_of(o, &o->touch) - before > CUT_TO * range; i++) {
    const double middle = 0.5 * (before + time_of(o, &o->touch));
    status = measure_pair_at(o, pair, middle, &unused);
    if (status < 0) return status;
    if (time_of(o, &o->touch) > middle) before = middle;
  }
  return CPROX_OK;
}
