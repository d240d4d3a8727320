/* SPDX-License-Identifier: BSD-3-Clause */
/* doc/robot-depth.md, Gradients. */
#include "solve/motion_derivatives.h"

#include <math.h>
#include <string.h>

/* By what was given of one variable at the points of a motion, rows of n. */
static void fill_rows(const double *weights, const motion_weights *w, size_t last, size_t n, size_t k, double by,
                      double *rows) {
  for (size_t i = 0; rows && i < last; i++) rows[(w->first + i) * n + k] = weights[i] * by;
}

static void fill_points(const cprox_motion *m, const motion_given *given, const motion_track *track, size_t own,
                        double u, const double *by_variable, double *const rows[3]) {
  const motion_weights w = motion_weights_at(given, track, own, u);
  const size_t n = given->n, points = given->n_points;
  for (int order = 0; order < 3 && n > 0; order++)
    if (rows[order]) memset(rows[order], 0, points * n * sizeof(double));
  for (size_t k = 0; k < n && w.n > 0; k++) {
    const double by = by_variable[given->variables[k]];
    fill_rows(w.position, &w, w.n, n, k, by, rows[0]);
    if (given->degree > 0 || motion_is_on_arc(m, given->variables[k])) continue;
    fill_rows(w.velocity, &w, 2, n, k, by, rows[1]);
    fill_rows(w.acceleration, &w, 2, n, k, by, rows[2]);
  }
}

/* By the duration of a track at the same fraction of it, its points being kept. */
static double by_stretch(const cprox_motion *m, const motion_given *given, const motion_track *t, size_t own, double u,
                         const double *by_variable) {
  double sum = 0.0;
  for (size_t k = 0; k < t->n_moving; k++)
    if (!motion_is_on_arc(m, t->moving[k])) sum += by_variable[t->moving[k]] * motion_stretch_rate(given, t, k, own, u);
  return sum / (t->times[t->n_segments - t->stands_last] - t->times[t->stands_first]);
}

/* ---- several motions on one clock ---- */

/* The track of one of the motions, and its place at the spot. False: that motion is a state. */
static bool find_track(const cprox_motion *m, size_t member, const motion_spot *spot, const motion_track **track,
                       size_t *own, double *u) {
  for (size_t i = 0; i < m->n_tracks; i++) {
    if (m->tracks[i].clock != (int32_t)member) continue;
    *track = &m->tracks[i], *u = spot->u;
    *own = motion_track_place(m, *track, spot->segment, u);
    return true;
  }
  return false;
}

/* Whether one of the track's own times is that of the spot: then the spot goes with it, if it is there for a kink. */
static bool is_at_own_time(const motion_track *t, size_t own, double time) {
  const double rounding = 1e-12 * (t->times[t->n_segments] - t->times[0]);
  for (size_t i = own; i <= own + 1; i++)
    if (i >= t->stands_first && i + t->stands_last <= t->n_segments && fabs(t->times[i] - time) <= rounding)
      return true;
  return false;
}

/* Whether a step of the track changes the distance: else its times are no kinks of it. */
static bool is_felt(const spot_pair *p, const motion_track *t) {
  for (size_t k = 0; k < t->n_moving; k++)
    if (p->sum[t->moving[k]] != 0.0) return true;
  return false;
}

/* What each motion adds to the slope of the distance along the clock, a part of it by what was found at one spot. */
static void add_slopes(spot_pair *p, const motion_spot *spot, double part, double *slopes) {
  const cprox_motion *m = p->scene->motion;
  motion_rates(m, spot->segment, spot->u, p->rates);
  for (size_t i = 0; i < m->n_tracks; i++) {
    const motion_track *t = &m->tracks[i];
    for (size_t v = 0; v < m->robot->n_variables; v++)
      if (m->track_of[v] == (int32_t)i) slopes[t->clock] += part * p->by_variable[v] * p->rates[v];
  }
}

/* A motion that starts later is where it was before: its own slope, taken off. At a kink, or at an end of the clock,
 * the slopes do not cancel: that place goes with the motion that has it. */
static void fill_clocks(const spot_pair *p, const motion_spot *at, double *slopes, cprox_motion_gradient *to) {
  static const double CANCELLED = 1e-7;
  const cprox_motion *m = p->scene->motion;
  const double time = spot_time(p, at);
  double slope = 0.0, all = 0.0;
  size_t attached = 0, own = 0;
  const motion_track *t = NULL;
  double u = 0.0;
  for (size_t i = 0; i < m->n_joined; i++) {
    slope += slopes[i], all += fabs(slopes[i]);
    attached += find_track(m, i, at, &t, &own, &u) && is_felt(p, t) && is_at_own_time(t, own, time);
  }
  if (fabs(slope) <= CANCELLED * all) attached = 0;
  for (size_t i = 0; i < m->n_joined; i++) {
    const bool moves = find_track(m, i, at, &t, &own, &u);
    double by_start = moves ? -slopes[i] : 0.0;
    if (moves && attached > 0 && is_felt(p, t) && is_at_own_time(t, own, time))
      by_start = attached > 1 ? NAN : by_start + slope;
    if (to->starts) to->starts[i] = by_start;
    if (!to->durations) continue;
    to->durations[i] = 0.0;
    if (!moves) continue;
    const double begin = t->times[t->stands_first], end = t->times[t->n_segments - t->stands_last];
    const double passed = fmin(fmax((time - begin) / (end - begin), 0.0), 1.0);
    to->durations[i] = by_stretch(m, &m->joined[i], t, own, u, p->sum) + (passed > 0.0 ? passed * by_start : 0.0);
  }
}

/* ---- all of it ---- */

static void fill_given(const cprox_motion *m, const motion_spot *spot, const double *by_variable,
                       cprox_motion_gradient *g) {
  double *rows[3] = {g->positions, g->velocities, g->accelerations};
  g->duration = 0.0;
  if (!m->joined) {
    fill_points(m, &m->given, m->tracks, spot->segment, spot->u, by_variable, rows);
    g->duration = by_stretch(m, &m->given, m->tracks, spot->segment, spot->u, by_variable);
  }
  for (size_t i = 0; i < m->n_joined; i++) {
    const motion_given *given = &m->joined[i];
    const motion_track *t = NULL;
    size_t own = 0;
    double u = 0.0;
    if (!find_track(m, i, spot, &t, &own, &u)) continue;
    fill_points(m, given, t, own, u, by_variable, rows);
    for (int order = 0; order < 3; order++)
      if (rows[order]) rows[order] += given->n * given->n_points;
  }
}

/* A part of the derivative is that at a spot. */
static void add_spot(spot_pair *p, const motion_spot *spot, double part, double *slopes, cprox_motion_gradient *to) {
  spot_differentiate(p, spot);
  if (slopes) add_slopes(p, spot, part, slopes);
  const robot_scene *scene = p->scene;
  for (size_t v = 0; v < scene->motion->robot->n_variables; v++) p->sum[v] += part * p->by_variable[v];
  if (p->pair.self) return;
  const vec3 n = spot->gap.normal;
  const cprox_obstacle *target = &scene->q->targets[scene->obstacles[p->pair.standing].index];
  to->base_position = vec_axpy(to->base_position, part, n);
  to->base_rotation = vec_axpy(to->base_rotation, part, vec_cross(spot->gap.on_moving, n));
  to->position = vec_axpy(to->position, -part, n);
  to->rotation = vec_axpy(to->rotation, part, vec_cross(n, vec_sub(spot->gap.on_standing, target->pose.position)));
}

void motion_derivatives_fill(spot_pair *p, const motion_spot *at, const spots *by, cprox_motion_gradient *to) {
  const cprox_motion *motion = p->scene->motion;
  const size_t all = motion->robot->n_variables * sizeof(double);
  to->base_position = to->base_rotation = to->position = to->rotation = vec(0, 0, 0);
  memset(p->sum, 0, all);
  double *slopes = !motion->joined ? NULL : to->starts ? to->starts : to->durations;
  if (slopes) memset(slopes, 0, motion->n_joined * sizeof *slopes);
  for (int k = 0; k < by->n; k++) add_spot(p, &by->spot[k], by->part ? by->part[k] : 1.0, slopes, to);
  to->t = spot_time(p, at);
  to->margin = -1.0;
  if (to->variables) memcpy(to->variables, p->sum, all);
  fill_given(motion, at, p->sum, to);
  if (slopes) fill_clocks(p, at, slopes, to);
}

void motion_derivatives_fill_nothing(const cprox_motion *m, cprox_motion_gradient *to) {
  size_t given = m->given.n * m->given.n_points * sizeof(double);
  for (size_t i = 0; i < m->n_joined; i++) given += m->joined[i].n * m->joined[i].n_points * sizeof(double);
  if (to->starts && m->joined) memset(to->starts, 0, m->n_joined * sizeof *to->starts);
  if (to->durations && m->joined) memset(to->durations, 0, m->n_joined * sizeof *to->durations);
  if (to->variables) memset(to->variables, 0, m->robot->n_variables * sizeof *to->variables);
  if (to->positions && given > 0) memset(to->positions, 0, given);
  if (to->velocities && given > 0) memset(to->velocities, 0, given);
  if (to->accelerations && given > 0) memset(to->accelerations, 0, given);
  to->t = NAN;
  to->base_position = to->base_rotation = to->position = to->rotation = vec(0, 0, 0);
  to->duration = to->margin = 0.0;
}
