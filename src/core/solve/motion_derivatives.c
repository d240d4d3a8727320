/* SPDX-License-Identifier: BSD-3-Clause */
/* doc/robot-depth.md, Gradients. */
#include "solve/motion_derivatives.h"

#include <math.h>
#include <string.h>

#include "base/bernstein.h"

/* ---- variables by what was given ---- */

/* What every variable is made of at one time: the sum of these multiples of what was given at points first …
 * first + n - 1, waypoints or control points. */
typedef struct motion_weights {
  size_t first, n;
  double position[MOTION_MAX_DEGREE + 1];
  double velocity[2], acceleration[2]; /* of waypoints */
} motion_weights;

static void bernstein(size_t degree, double u, double *b) {
  b[0] = 1.0;
  for (size_t r = 1; r <= degree; r++) {
    b[r] = u * b[r - 1];
    for (size_t i = r - 1; i > 0; i--) b[i] = (1.0 - u) * b[i] + u * b[i - 1];
    b[0] *= 1.0 - u;
  }
}

/* The Bernstein coefficients of a Hermite polynomial of degree 1, 3 or 5 over h seconds, taken apart. */
static motion_weights weights_of_waypoints(const motion_track *t, size_t own, size_t point, double u) {
  const size_t degree = t->degree[own];
  const double h = t->times[own + 1] - t->times[own], n = (double)degree;
  motion_weights w = {.first = point, .n = 2};
  double b[MOTION_MAX_DEGREE + 1] = {0};
  bernstein(degree, u, b);
  w.position[0] = b[0], w.position[1] = b[degree];
  if (degree == 1) return w;
  w.position[0] += b[1], w.position[1] += b[degree - 1];
  w.velocity[0] = h / n * b[1], w.velocity[1] = -h / n * b[degree - 1];
  if (degree == 3) return w;
  w.position[0] += b[2], w.position[1] += b[3];
  w.velocity[0] += 2.0 * h / n * b[2], w.velocity[1] -= 2.0 * h / n * b[3];
  w.acceleration[0] = h * h / 20.0 * b[2], w.acceleration[1] = h * h / 20.0 * b[3];
  return w;
}

/* Cox's and de Boor's recursion over the knots of the span. */
static motion_weights weights_of_spline(const motion_given *g, size_t span, double u) {
  const double *knots = g->times;
  size_t r = g->degree;
  for (size_t left = span;; r++)
    if (knots[r] < knots[r + 1] && left-- == 0) break;
  const double t = (1.0 - u) * knots[r] + u * knots[r + 1];
  motion_weights w = {.first = r - g->degree, .n = g->degree + 1};
  w.position[0] = 1.0;
  for (size_t k = 1; k <= g->degree; k++) {
    double carried = 0.0;
    for (size_t i = 0; i < k; i++) {
      const double from = knots[r + 1 + i - k], to = knots[r + 1 + i], part = w.position[i] / (to - from);
      w.position[i] = carried + (to - t) * part;
      carried = (t - from) * part;
    }
    w.position[k] = carried;
  }
  return w;
}

/* Where a track stands it is at its first or its last point. */
static size_t given_segment(const motion_track *t, size_t *own, double *u) {
  const size_t first = t->stands_first, last = t->n_segments - t->stands_last;
  if (*own < first) *own = first, *u = 0.0;
  if (*own >= last) *own = last - 1, *u = 1.0;
  return *own - first;
}

/* Those at u of a segment of the track; n is 0 where nothing was given. */
static motion_weights weights_at(const motion_given *g, const motion_track *t, size_t own, double u) {
  if (g->n == 0 || g->n_points == 0) return (motion_weights){0};
  const size_t segment = given_segment(t, &own, &u);
  return g->degree > 0 ? weights_of_spline(g, segment, u) : weights_of_waypoints(t, own, segment, u);
}

/* How fast a variable of the track, its k-th that moves, grows with the logarithm of the duration: at the same fraction
 * of the way, the points' own values being kept. */
static double stretch_rate(const motion_given *g, const motion_track *t, size_t k, size_t own, double u) {
  if (g->degree > 0) return 0.0;
  given_segment(t, &own, &u);
  const size_t degree = t->degree[own];
  const double *c = t->coefficients + (own * t->n_moving + k) * t->stride;
  double b[MOTION_MAX_DEGREE + 1] = {0};
  bernstein(degree, u, b);
  /* the second coefficient has the velocity times h/degree, the third one twice that and the acceleration times h²/20
   */
  if (degree == 3) return b[1] * (c[1] - c[0]) + b[2] * (c[2] - c[3]);
  if (degree != 5) return 0.0;
  return b[1] * (c[1] - c[0]) + 2.0 * b[2] * (c[2] - c[1]) + 2.0 * b[3] * (c[3] - c[4]) + b[4] * (c[4] - c[5]);
}

/* Whether the variable follows its waypoints by slerp or by screws: then it is no sum of them. */
static bool is_on_arc(const cprox_motion *m, int32_t variable) {
  for (size_t i = 0; i < m->robot->n_axes && m->arc_of; i++) {
    const int32_t first = m->robot->axes[i].variable;
    if (m->robot->axes[i].kind != AXIS_BALL || m->arc_of[i] < 0) continue;
    const bool screw = motion_arc_at(m, i, 0)->screw;
    if (variable >= first - (screw ? 3 : 0) && variable < first + 4) return true;
  }
  return false;
}

/* ---- points ---- */

/* By what was given of one variable at the points of a motion, rows of n. */
static void fill_rows(const double *weights, const motion_weights *w, size_t last, size_t n, size_t k, double by,
                      double *rows) {
  for (size_t i = 0; rows && i < last; i++) rows[(w->first + i) * n + k] = weights[i] * by;
}

static void fill_points(const cprox_motion *m, const motion_given *given, const motion_track *track, size_t own,
                        double u, const double *by_variable, double *const rows[3]) {
  const motion_weights w = weights_at(given, track, own, u);
  const size_t n = given->n, points = given->n_points;
  for (int order = 0; order < 3 && n > 0; order++)
    if (rows[order]) memset(rows[order], 0, points * n * sizeof(double));
  for (size_t k = 0; k < n && w.n > 0; k++) {
    const double by = by_variable[given->variables[k]];
    fill_rows(w.position, &w, w.n, n, k, by, rows[0]);
    if (given->degree > 0 || is_on_arc(m, given->variables[k])) continue;
    fill_rows(w.velocity, &w, 2, n, k, by, rows[1]);
    fill_rows(w.acceleration, &w, 2, n, k, by, rows[2]);
  }
}

/* By the duration of a track at the same fraction of it, its points being kept. */
static double by_stretch(const cprox_motion *m, const motion_given *given, const motion_track *t, size_t own, double u,
                         const double *by_variable) {
  double sum = 0.0;
  for (size_t k = 0; k < t->n_moving; k++)
    if (!is_on_arc(m, t->moving[k])) sum += by_variable[t->moving[k]] * stretch_rate(given, t, k, own, u);
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
static void add_slopes(const spot_pair *p, double part, double *slopes) {
  const cprox_motion *m = p->scene->motion;
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
  if (slopes) add_slopes(p, part, slopes);
  const robot_scene *scene = p->scene;
  for (size_t v = 0; v < scene->motion->robot->n_variables; v++) p->sum[v] += part * p->by_variable[v];
  if (p->pair.self) return;
  const vec3 n = spot->gap.normal;
  const cprox_obstacle *obstacle = &scene->q->obstacles[scene->obstacles[p->pair.standing].index];
  to->base_position = vec_axpy(to->base_position, part, n);
  to->base_rotation = vec_axpy(to->base_rotation, part, vec_cross(spot->gap.on_moving, n));
  to->position = vec_axpy(to->position, -part, n);
  to->rotation = vec_axpy(to->rotation, part, vec_cross(n, vec_sub(spot->gap.on_standing, obstacle->pose.position)));
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
