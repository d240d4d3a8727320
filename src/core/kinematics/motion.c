/* SPDX-License-Identifier: BSD-3-Clause */
/* A motion over an interval of one of its segments: values, derivatives and their bounds, from Bernstein coefficients.
 * */
#include "kinematics/motion.h"

#include <math.h>
#include <string.h>

#include "base/bernstein.h"
#include "base/round_down.h"
#include "base/rounding.h"
#include "kinematics/lanes.h"
#include "simd/dispatch.h"

/* ---- variables ---- */

static inline void lanes_middle(const lane_row *c, size_t degree, double *middle) {
  lane_row v[MOTION_MAX_DEGREE + 1];
  for (size_t i = 0; i <= degree; i++)
#pragma omp simd
    for (int l = 0; l < MOTION_LANES; l++) v[i][l] = c[i][l];
  for (size_t r = 1; r <= degree; r++)
    for (size_t i = 0; i + r <= degree; i++)
#pragma omp simd
      for (int l = 0; l < MOTION_LANES; l++) v[i][l] = 0.5 * (v[i][l] + v[i + 1][l]);
#pragma omp simd
  for (int l = 0; l < MOTION_LANES; l++) middle[l] = v[0][l];
}

/* The coefficients of the derivative take the place of those of the polynomial; the largest is at most largest + factor
 * * error. */
static inline void lanes_differentiate(lane_row *c, size_t degree, double factor, const double *error,
                                       double *largest) {
#pragma omp simd
  for (int l = 0; l < MOTION_LANES; l++) largest[l] = 0.0;
  for (size_t i = 0; i < degree; i++)
#pragma omp simd
    for (int l = 0; l < MOTION_LANES; l++) {
      c[i][l] = (double)degree * (c[i + 1][l] - c[i][l]);
      largest[l] = greater(largest[l], fabs(c[i][l]));
    }
#pragma omp simd
  for (int l = 0; l < MOTION_LANES; l++) largest[l] += factor * error[l];
}

/* `error` is that of the coefficients; row k begins at out + k * stride. */
SIMD_CLONES
static void fill_lanes(lane_row *c, size_t degree, double a, double b, const double *error, double *out,
                       size_t stride) {
  const double n = (double)degree;
  double *value = out, *second = out + MOTION_SECOND * stride, *third = out + MOTION_G * stride;
  double *acceleration = out + MOTION_A * stride, *shift = out + MOTION_SHIFT * stride,
         *variation = out + MOTION_VARIATION * stride, *line = out + MOTION_LINE * stride,
         *stray = out + MOTION_STRAY * stride;
  lanes_cut(degree, a, b, c);
  lanes_middle((const lane_row *)c, degree, value);
#pragma omp simd
  for (int l = 0; l < MOTION_LANES; l++) shift[l] = variation[l] = 0.0;
  for (size_t i = 0; i <= degree; i++)
#pragma omp simd
    for (int l = 0; l < MOTION_LANES; l++) shift[l] = greater(shift[l], fabs(c[i][l] - value[l]));
  for (size_t i = 0; i < degree; i++)
#pragma omp simd
    for (int l = 0; l < MOTION_LANES; l++) variation[l] += fabs(c[i + 1][l] - c[i][l]);
#pragma omp simd
  for (int l = 0; l < MOTION_LANES; l++) {
    shift[l] += 2.0 * error[l], variation[l] += 2.0 * n * error[l];
    line[l] = shift[l];
    second[l] = acceleration[l] = third[l] = stray[l] = 0.0;
  }

  lanes_differentiate(c, degree, 2.0 * n, error, out + MOTION_W * stride);
  lanes_middle((const lane_row *)c, degree - 1, out + MOTION_FIRST * stride);
  if (degree < 2) return;
  lanes_differentiate(c, degree - 1, 4.0 * n * (n - 1.0), error, acceleration);
  lanes_middle((const lane_row *)c, degree - 2, second);
  if (degree < 3) return;
  lanes_differentiate(c, degree - 2, 8.0 * n * (n - 1.0) * (n - 2.0), error, third);
}

/* ---- tracks ---- */

static size_t segment_of(const double *times, size_t n_segments, double t) {
  size_t first = 0, last = n_segments;
  while (first + 1 < last) {
    const size_t middle = first + (last - first) / 2;
    if (times[middle] <= t)
      first = middle;
    else
      last = middle;
  }
  return first;
}

/* A segment of the motion is a part of one of the track. Places are off by 6 u at most; the errors of a joined motion's
 * tracks have room for that (doc/robot-bounds.md). */
size_t motion_track_place(const cprox_motion *m, const motion_track *t, size_t segment, double *u) {
  if (m->n_tracks == 1) return segment;
  const double from = m->times[segment], to = m->times[segment + 1];
  const size_t own = segment_of(t->times, t->n_segments, from);
  const double begin = t->times[own], end = t->times[own + 1];
  const double low = (from - begin) / (end - begin), high = to >= end ? 1.0 : (to - begin) / (end - begin);
  *u = *u >= 1.0 ? high : lesser(low + (high - low) * *u, high);
  return own;
}

motion_interval motion_track_interval(const cprox_motion *m, const motion_track *t, const motion_interval *over) {
  motion_interval own = *over;
  if (m->n_tracks == 1) return own;
  own.first = motion_track_place(m, t, over->first, &own.a);
  own.last = motion_track_place(m, t, over->last - 1, &own.b) + 1;
  if (!motion_is_span(&own)) own.b = greater(own.a, own.b);
  return own;
}

size_t motion_rows_stride(const cprox_motion *m) {
  const motion_track *last = &m->tracks[m->n_tracks - 1];
  return last->first_slot + lanes_padded(last->n_moving);
}

size_t motion_rows_size(const cprox_motion *m) {
  return MOTION_ROWS * motion_rows_stride(m);
}

static void fill_segment(const motion_track *t, const motion_interval *own, double *rows, size_t stride) {
  const size_t segment = own->first, degree = t->degree[segment];
  for (size_t first = 0; first < t->n_moving; first += MOTION_LANES) {
    lane_row c[LANE_ROWS], error;
    lanes_load(t, segment, first, c, error);
    fill_lanes(c, degree, own->a, own->b, error, rows + t->first_slot + first, stride);
  }
}

void motion_fill_track(const cprox_motion *m, size_t track, const motion_interval *over, const motion_interval *own,
                       span_centre *centre, double *rows) {
  const motion_track *t = &m->tracks[track];
  if (motion_is_span(own))
    motion_fill_span(m, t, over, own, centre, rows);
  else
    fill_segment(t, own, rows, motion_rows_stride(m));
}

/* Rounding may move it a little: any place of the interval will do that all tracks take for the same. */
span_centre motion_middle(const cprox_motion *m, const motion_interval *over) {
  if (!motion_is_span(over)) return (span_centre){.segment = over->first, .u = 0.5 * (over->a + over->b)};
  const double *times = m->times, base = times[over->first];
  const double from = over->a * (times[over->first + 1] - base);
  const double to = (times[over->last - 1] - base) + over->b * (times[over->last] - times[over->last - 1]);
  const double middle = 0.5 * (from + to);
  size_t first = over->first, last = over->last;
  while (first + 1 < last) {
    const size_t half = first + (last - first) / 2;
    if (times[half] - base <= middle)
      first = half;
    else
      last = half;
  }
  const double u = (middle - (times[first] - base)) / (times[first + 1] - times[first]);
  const double low = first == over->first ? over->a : 0.0, high = first + 1 == over->last ? over->b : 1.0;
  return (span_centre){.segment = first, .u = lesser(greater(u, low), high)};
}

/* ---- one variable ---- */

/* The coefficients of the derivative take the place of those of the polynomial. */
static void differentiate(double *c, size_t degree) {
  for (size_t i = 0; i < degree; i++) c[i] = (double)degree * (c[i + 1] - c[i]);
}

/* The coordinates of a ball over the interval, one a lane; returns the sum of their errors. */
static double coordinates_over(const cprox_motion *m, const motion_interval *own, const robot_axis *axis,
                               double c[4][MOTION_MAX_DEGREE + 1]) {
  const int32_t variable = axis->variable, count = axis_variables(axis->kind);
  const motion_track *t = &m->tracks[m->track_of[variable]];
  const size_t segment = own->first, degree = t->degree[segment];
  lane_row lanes[MOTION_MAX_DEGREE + 1] = {{0}};
  double error = 0.0;
  for (int32_t k = 0; k < count; k++) {
    const int32_t slot = m->slot[variable + k];
    const size_t at = segment * t->n_moving + (slot < 0 ? 0 : (size_t)slot - t->first_slot);
    for (size_t i = 0; i <= degree; i++)
      lanes[i][k] = slot < 0 ? m->rest[variable + k] : t->coefficients[at * t->stride + i];
    error += slot < 0 ? 0.0 : t->error[at];
  }
  lanes_cut(degree, own->a, own->b, lanes);
  for (int k = 0; k < 4; k++)
    for (size_t i = 0; i <= degree; i++) c[k][i] = lanes[i][k];
  return error;
}

/* ---- one axis ---- */

/* Straight lines of quaternions that come nearer to 0 than this part of their middle bound nothing. */
static const double NEAREST_LINE = 0.25;
#define NO_LINE 1e300

static double largest_norm(double c[4][MOTION_MAX_DEGREE + 1], size_t count) {
  double largest = 0.0;
  for (size_t i = 0; i < count; i++)
    largest = fmax(largest, c[0][i] * c[0][i] + c[1][i] * c[1][i] + c[2][i] * c[2][i] + c[3][i] * c[3][i]);
  return sqrt(largest);
}

size_t motion_derivative_bounds(const cprox_motion *m, int32_t axis, const motion_interval *own, double *rates) {
  const robot_axis *of = &m->robot->axes[axis];
  const size_t degree = m->tracks[m->track_of[of->variable]].degree[own->first];
  double c[4][MOTION_MAX_DEGREE + 1], factor = 1.0;
  const double error = coordinates_over(m, own, of, c);
  for (size_t order = 1; order <= degree; order++) {
    for (int k = 0; k < 4; k++) differentiate(c[k], degree - order + 1);
    factor *= 2.0 * (double)(degree - order + 1);
    rates[order] = ROUND_UP * largest_norm(c, degree - order + 1) + factor * error;
  }
  return degree;
}

/* Twice the vector part of p q*, quaternions as x, y, z, w. */
static vec3 twice_product(const double *p, const double *q) {
  const vec3 u = vec(p[0], p[1], p[2]), v = vec(q[0], q[1], q[2]);
  return vec_scale(2.0, vec_sub(vec_sub(vec_scale(q[3], u), vec_scale(p[3], v)), vec_cross(u, v)));
}

/* The frame of a ball by its quaternion and two derivatives of that, and its velocities. */
static void place_ball(const robot_axis *axis, double p[3][4], const placement *parent, const placement *before,
                       axis_state *state) {
  double square = 0.0, along = 0.0;
  for (int k = 0; k < 4; k++) square += p[0][k] * p[0][k], along += p[0][k] * p[1][k];
  const vec3 omega = vec_scale(1.0 / square, twice_product(p[1], p[0]));
  const vec3 alpha = vec_axpy(vec_scale(1.0 / square, twice_product(p[2], p[0])), -2.0 * along / square, omega);
  state->velocity = placement_turn(before, omega);
  state->acceleration = placement_turn(before, alpha);
  const placement own = axis_move(axis, NULL, 0.0, p[0]);
  state->frame = parent ? placement_compose(parent, &own) : own;
}

/* Over a span the quaternion is within `stray` of a straight line. Quaternions that are e apart, one of them of norm m
 * > e, turn vectors to where they are 2 e / m of their length apart at most, and any two turn them 2 apart at most. */
static void ball_over_span(const cprox_motion *m, size_t axis_index, const double *rows, const placement *parent,
                           const placement *before, axis_state *state) {
  const robot_axis *axis = &m->robot->axes[axis_index];
  const size_t stride = motion_rows_stride(m);
  double p[3][4] = {{0}}, line = 0.0, stray = 0.0, shift = 0.0, norm = 0.0;
  for (int k = 0; k < 4; k++) {
    const int32_t slot = m->slot[axis->variable + k];
    const double *of = rows + (slot < 0 ? 0 : slot);
    p[0][k] = slot < 0 ? m->rest[axis->variable + k] : of[MOTION_VALUE * stride];
    norm += p[0][k] * p[0][k];
    if (slot < 0) continue;
    p[1][k] = of[MOTION_FIRST * stride];
    line += of[MOTION_LINE * stride] * of[MOTION_LINE * stride];
    stray += of[MOTION_STRAY * stride] * of[MOTION_STRAY * stride];
    shift += of[MOTION_SHIFT * stride] * of[MOTION_SHIFT * stride];
  }
  norm = (1.0 - 16.0 * ROUND_U) * sqrt(norm);
  const double sagitta = m->arc_of ? m->sagitta[axis_index] : 0.0;
  line = ROUND_UP * sqrt(line), stray = ROUND_UP * sqrt(stray) + sagitta, shift = ROUND_UP * sqrt(shift) + sagitta;
  const double least = norm - line, rate = 2.0 * line / greater(least, NEAREST_LINE * norm);
  state->w = 2.0 * rate;
  state->a = 4.0 * rate * rate;
  state->g = 20.0 * rate * rate * rate;
  state->shift = 2.0 * lesser(ROUND_UP * shift / norm, 1.0);
  state->line = 2.0 * lesser(ROUND_UP * line / norm, 1.0);
  state->stray = least > NEAREST_LINE * norm ? 2.0 * lesser(ROUND_UP * stray / least, 1.0) : NO_LINE;
  state->variation = INFINITY;
  state->error = 256.0 * ROUND_U * (1.0 + state->w) * (1.0 + state->w);
  place_ball(axis, p, parent, before, state);
}

/* A quaternion of any norm turns at omega = 2 vec(p' p*) / |p|² and omega' = 2 vec(p'' p*) / |p|² - 2 omega (p·p') /
 * |p|². */
static void ball_over(const cprox_motion *m, const motion_interval *own, size_t axis_index, const placement *parent,
                      const placement *before, axis_state *state) {
  const robot_axis *axis = &m->robot->axes[axis_index];
  const size_t degree = motion_track_of(m, axis_index)->degree[own->first];
  const double n = (double)degree;
  double c[4][MOTION_MAX_DEGREE + 1], p[3][4] = {{0}}, bound[4] = {0}, factor = 2.0 * n;
  const double error = coordinates_over(m, own, axis, c);
  for (int k = 0; k < 4; k++) p[0][k] = bernstein_at(c[k], degree, 0.5);
  for (size_t order = 1; order <= 3 && order <= degree; order++) {
    for (int k = 0; k < 4; k++) {
      differentiate(c[k], degree - order + 1);
      if (order < 3) p[order][k] = bernstein_at(c[k], degree - order, 0.5);
    }
    bound[order] = ROUND_UP * largest_norm(c, degree - order + 1) + factor * error;
    factor *= 2.0 * (n - (double)order);
  }

  /* all rates are in units of the least norm */
  const double norm = m->norm[axis_index], r1 = bound[1] / norm, r2 = bound[2] / norm, r3 = bound[3] / norm;
  state->w = 2.0 * r1;
  state->a = 2.0 * r2 + 4.0 * r1 * r1;
  state->g = 2.0 * r3 + 14.0 * r1 * r2 + 20.0 * r1 * r1 * r1;
  state->shift = state->line = 0.5 * state->w;
  state->variation = state->w;
  state->stray = 0.0;
  state->error = 2.0 * (2.0 * n + 1.0) * (2.0 * n + 1.0) * (1.0 + state->w) * (1.0 + state->w) * error / norm;

  place_ball(axis, p, parent, before, state);
}

/* ---- balls by rotation vectors ---- */

/* A = (1 - cos x)/x^2, B = (x - sin x)/x^3 and the derivatives of both by x, over x; square = x^2. Below 1 by their
 * series, whose remainders are below the first term that is left out: 1e-20. */
typedef struct turn_series {
  double a, b, da, db;
} turn_series;

static turn_series turn_series_of(double square) {
  turn_series t = {0};
  if (square > 1.0) {
    const double x = sqrt(square), sine = sin(x), half = sin(0.5 * x), versine = 2.0 * half * half;
    t.a = versine / square, t.b = (x - sine) / (square * x);
    t.da = (x * sine - 2.0 * versine) / (square * square);
    t.db = (3.0 * sine - 2.0 * x - x * (1.0 - versine)) / (square * square * x);
    return t;
  }
  enum { TERMS = 10 };
  double term = 1.0; /* of sin x / x: (-square)^k / (2k + 1)! */
  for (int k = 0; k < TERMS; k++) {
    const double n = 2.0 * k, next = 1.0 / ((n + 2.0) * (n + 3.0)), rate = 2.0 * (k + 1);
    t.a += term / (n + 2.0), t.b += term * next;
    /* the next terms of both, differentiated */
    t.da -= rate * term * next / (n + 4.0), t.db -= rate * term * next / ((n + 4.0) * (n + 5.0));
    term *= -square * next;
  }
  return t;
}

/* The frame of a rotation vector p, its two derivatives given, and its velocities: omega = J p', J = 1 + A [p] + B
 * [p]^2. */
static void place_vector(const robot_axis *axis, double values[3][4], const placement *parent, const placement *before,
                         axis_state *state) {
  const vec3 p = vec(values[0][0], values[0][1], values[0][2]), v = vec(values[1][0], values[1][1], values[1][2]),
             a = vec(values[2][0], values[2][1], values[2][2]);
  const turn_series t = turn_series_of(vec_norm2(p));
  const vec3 pv = vec_cross(p, v), ppv = vec_cross(p, pv), pa = vec_cross(p, a), ppa = vec_cross(p, pa);
  const vec3 omega = vec_axpy(vec_axpy(v, t.a, pv), t.b, ppv);
  const double pace = vec_dot(p, v);
  vec3 alpha = vec_axpy(vec_axpy(a, t.a, pa), t.b, ppa);
  alpha = vec_axpy(vec_axpy(alpha, t.da * pace, pv), t.db * pace, ppv);
  alpha = vec_axpy(alpha, t.b, vec_cross(v, pv)); /* of [p]^2 v; what has v cross v is 0 */
  state->velocity = placement_turn(before, omega);
  state->acceleration = placement_turn(before, alpha);
  const placement own = axis_move(axis, NULL, 0.0, values[0]);
  state->frame = parent ? placement_compose(parent, &own) : own;
}

/* With bounds r1, r2, r3 on the derivatives of p: |omega| <= r1, |omega'| <= r2 + r1^2/2, |omega''| <= r3 + 3/2 r1 r2 +
 * r1^3/2. */
static void vector_over(const cprox_motion *m, const motion_interval *own, const robot_axis *axis,
                        const placement *parent, const placement *before, axis_state *state) {
  const size_t degree = m->tracks[m->track_of[axis->variable]].degree[own->first];
  const double n = (double)degree;
  double c[4][MOTION_MAX_DEGREE + 1], p[3][4] = {{0}}, bound[4] = {0}, factor = 2.0 * n, shift = 0.0;
  const double error = coordinates_over(m, own, axis, c);
  for (int k = 0; k < 3; k++) p[0][k] = bernstein_at(c[k], degree, 0.5);
  for (size_t i = 0; i <= degree; i++)
    shift = greater(vec_norm(vec(c[0][i] - p[0][0], c[1][i] - p[0][1], c[2][i] - p[0][2])), shift);
  for (size_t order = 1; order <= 3 && order <= degree; order++) {
    for (int k = 0; k < 3; k++) {
      differentiate(c[k], degree - order + 1);
      if (order < 3) p[order][k] = bernstein_at(c[k], degree - order, 0.5);
    }
    bound[order] = ROUND_UP * largest_norm(c, degree - order + 1) + factor * error;
    factor *= 2.0 * (n - (double)order);
  }
  const double r1 = bound[1], r2 = bound[2], r3 = bound[3];
  state->w = r1;
  state->a = ROUND_UP * (r2 + 0.5 * r1 * r1);
  state->g = ROUND_UP * (r3 + 1.5 * r1 * r2 + 0.5 * r1 * r1 * r1);
  state->shift = state->line = lesser(ROUND_UP * shift + 2.0 * error, 2.0);
  state->variation = r1;
  state->stray = 0.0;
  state->error = 4.0 * (2.0 * n + 1.0) * (2.0 * n + 1.0) * (1.0 + r1) * (1.0 + r1) * error +
                 256.0 * ROUND_U * ((1.0 + r1) * (1.0 + r1) + r2);
  place_vector(axis, p, parent, before, state);
}

/* Over a span the vector is within `stray` of a straight line; rotations are no farther apart than their vectors. */
static void vector_over_span(const cprox_motion *m, const robot_axis *axis, const double *rows, const placement *parent,
                             const placement *before, axis_state *state) {
  const size_t stride = motion_rows_stride(m);
  double p[3][4] = {{0}}, line = 0.0, stray = 0.0, shift = 0.0;
  for (int k = 0; k < 3; k++) {
    const int32_t slot = m->slot[axis->variable + k];
    const double *of = rows + (slot < 0 ? 0 : slot);
    p[0][k] = slot < 0 ? m->rest[axis->variable + k] : of[MOTION_VALUE * stride];
    if (slot < 0) continue;
    p[1][k] = of[MOTION_FIRST * stride];
    line += of[MOTION_LINE * stride] * of[MOTION_LINE * stride];
    stray += of[MOTION_STRAY * stride] * of[MOTION_STRAY * stride];
    shift += of[MOTION_SHIFT * stride] * of[MOTION_SHIFT * stride];
  }
  line = ROUND_UP * sqrt(line), stray = ROUND_UP * sqrt(stray), shift = ROUND_UP * sqrt(shift);
  const double rate = 2.0 * line;
  state->w = rate;
  state->a = ROUND_UP * 0.5 * rate * rate;
  state->g = ROUND_UP * 0.5 * rate * rate * rate;
  state->shift = lesser(shift, 2.0), state->line = lesser(line, 2.0), state->stray = lesser(stray, 2.0);
  state->variation = INFINITY;
  state->error = 256.0 * ROUND_U * (1.0 + rate) * (1.0 + rate);
  place_vector(axis, p, parent, before, state);
}

/* ---- balls and shifts by arcs ---- */

static vec3 world_axis(const robot_axis *axis, const placement *before) {
  if (axis->along < 0) return placement_turn(before, axis->z);
  const double *column = before->r + axis->along;
  const double sign = axis->along == 0 ? axis->z.x : axis->along == 1 ? axis->z.y : axis->z.z;
  return vec(sign * column[0], sign * column[3], sign * column[6]);
}

/* A screw's shift is all in the first of its three shifts; the ball's frame has the whole pose. */
static void arc_over(const cprox_motion *m, const motion_interval *own, size_t i, const placement *before,
                     axis_state *state) {
  const robot_axis *axis = &m->robot->axes[i];
  const motion_arc *arc = motion_arc_at(m, i, own->first);
  const double part = arc->to - arc->from, s = arc->from + part * (0.5 * (own->a + own->b)),
               ds = part * (own->b - own->a);
  vec3 p[3] = {vec(0, 0, 0), vec(0, 0, 0), vec(0, 0, 0)};
  if (arc->screw) arc_position(arc, s, p);
  *state = (axis_state){.kind = axis->kind, .frame = *before};
  if (axis->kind == AXIS_PRISMATIC) {
    state->z = world_axis(axis, before);
    if (!axis->first_of_joint) return;
    double across;
    const double speed = arc_speed(arc, &across);
    state->velocity = vec_scale(ds, placement_turn(before, p[1]));
    state->acceleration = vec_scale(ds * ds, placement_turn(before, p[2]));
    state->w = ROUND_UP * ds * speed;
    state->a = ROUND_UP * ds * ds * across * arc->angle;
    state->g = ROUND_UP * ds * ds * ds * across * arc->angle * arc->angle;
  } else {
    double q[4];
    arc_orientation(arc, s, q);
    placement here = axis_move(axis, NULL, 0.0, q);
    here.p = p[0];
    state->frame = placement_compose(before, &here);
    state->velocity = vec_scale(ds * arc->angle, placement_turn(before, arc->z));
    state->w = ROUND_UP * ds * arc->angle;
  }
  state->shift = state->line = 0.5 * state->w, state->variation = state->w;
  state->error = 256.0 * ROUND_U * (state->w + state->a);
}

static void line_over(const cprox_motion *m, const motion_interval *own, const robot_axis *axis, const double *rows,
                      const placement *before, axis_state *state) {
  const size_t stride = motion_rows_stride(m), slot = (size_t)m->slot[axis->variable];
  const motion_track *t = &m->tracks[m->track_of[axis->variable]];
  const double *of = rows + slot;
  const double n = (double)t->degree[own->first];
  const double error = motion_is_span(own) ? 0.0 : t->error[own->first * t->n_moving + slot - t->first_slot];
  const double factor = fabs(axis->multiplier), value = axis->multiplier * of[MOTION_VALUE] + axis->offset;
  state->w = factor * of[MOTION_W * stride], state->a = factor * of[MOTION_A * stride];
  state->g = factor * of[MOTION_G * stride];
  state->shift = factor * of[MOTION_SHIFT * stride], state->variation = factor * of[MOTION_VARIATION * stride];
  state->line = factor * of[MOTION_LINE * stride], state->stray = factor * of[MOTION_STRAY * stride];
  state->error = factor * error * (n + 0.5 * n * n);
  state->z = world_axis(axis, before);
  state->velocity = vec_scale(axis->multiplier * of[MOTION_FIRST * stride], state->z);
  state->acceleration = vec_scale(axis->multiplier * of[MOTION_SECOND * stride], state->z);
  axis_advance(axis, before, value, &state->frame);
}

void motion_find_axis(const cprox_motion *m, const motion_interval *own, const double *rows, size_t i,
                      axis_state *axes) {
  const robot_axis *axis = &m->robot->axes[i];
  axis_state *state = &axes[i];
  const placement *parent = axis->parent < 0 ? NULL : &axes[axis->parent].frame;
  if (!m->axis_moves[i]) {
    *state = (axis_state){.kind = axis->kind};
    state->frame = parent ? placement_compose(parent, &m->still[i]) : m->still[i];
    return;
  }
  state->kind = axis->kind;
  const placement before = parent ? placement_compose(parent, &axis->at) : axis->at;
  if (m->arc_of && m->arc_of[i] >= 0 && !motion_is_span(own)) {
    arc_over(m, own, i, &before, state);
  } else if (axis->kind < AXIS_BALL) {
    line_over(m, own, axis, rows, &before, state);
    if (m->arc_of) state->shift += m->sagitta[i], state->stray += m->sagitta[i];
  } else if (axis->kind == AXIS_VECTOR && motion_is_span(own))
    vector_over_span(m, axis, rows, parent, &before, state);
  else if (axis->kind == AXIS_VECTOR)
    vector_over(m, own, axis, parent, &before, state);
  else if (motion_is_span(own))
    ball_over_span(m, i, rows, parent, &before, state);
  else
    ball_over(m, own, i, parent, &before, state);
}

span_centre motion_span_node(const cprox_motion *m, const motion_interval *over, double *rows, axis_state *axes) {
  span_centre centre = motion_middle(m, over);
  for (size_t k = 0; k < m->n_tracks; k++) {
    const motion_interval own = motion_track_interval(m, &m->tracks[k], over);
    motion_fill_track(m, k, over, &own, &centre, rows);
  }
  for (size_t i = 0; i < m->robot->n_axes; i++) {
    const motion_interval own = motion_track_interval(m, motion_track_of(m, i), over);
    motion_find_axis(m, &own, rows, i, axes);
  }
  return centre;
}

void motion_node(const cprox_motion *m, size_t segment, double a, double b, double *rows, axis_state *axes) {
  const motion_interval over = {.a = a, .b = b, .first = segment, .last = segment + 1};
  motion_span_node(m, &over, rows, axes);
}

/* ---- one time ---- */

double motion_value(const cprox_motion *m, int32_t variable, size_t own, double u) {
  const int32_t slot = m->slot[variable];
  if (slot < 0) return m->rest[variable];
  const motion_track *t = &m->tracks[m->track_of[variable]];
  return bernstein_at(t->coefficients + (own * t->n_moving + (size_t)slot - t->first_slot) * t->stride, t->degree[own],
                      u);
}

void motion_place_axis(const cprox_motion *m, size_t own, double u, size_t i, axis_state *axes) {
  const robot_axis *axis = &m->robot->axes[i];
  const placement *parent = axis->parent < 0 ? NULL : &axes[axis->parent].frame;
  axis_state *state = &axes[i];
  *state = (axis_state){.kind = axis->kind};
  if (!m->axis_moves[i]) {
    state->frame = parent ? placement_compose(parent, &m->still[i]) : m->still[i];
    return;
  }
  double joint[7];
  const double *values = joint;
  if (m->arc_of && m->arc_of[i] >= 0) {
    const int32_t ball = motion_track_of(m, i)->arc_axes[m->arc_of[i]];
    motion_arc_values(m, i, own, u, joint);
    values += axis->variable - (m->robot->axes[ball].variable - 3);
  } else {
    for (int32_t k = 0; k < axis_variables(axis->kind); k++) joint[k] = motion_value(m, axis->variable + k, own, u);
  }
  state->frame = axis_move(axis, parent, axis->multiplier * values[0] + axis->offset, values);
}

static void values_at(const cprox_motion *m, size_t segment, double at, double *values) {
  memcpy(values, m->rest, m->robot->n_variables * sizeof *values);
  for (size_t j = 0; j < m->n_tracks; j++) {
    const motion_track *t = &m->tracks[j];
    double u = at;
    const size_t own = motion_track_place(m, t, segment, &u);
    for (size_t k = 0; k < t->n_moving; k++)
      values[t->moving[k]] = bernstein_at(t->coefficients + (own * t->n_moving + k) * t->stride, t->degree[own], u);
    for (size_t k = 0; k < t->n_arcs; k++) {
      const size_t i = (size_t)t->arc_axes[k];
      if (m->axis_moves[i]) motion_arc_values(m, i, own, u, values + m->robot->axes[i].variable - 3);
    }
  }
}

void motion_place(const cprox_motion *m, size_t segment, double u, double *values, placement *frames) {
  values_at(m, segment, u, values);
  robot_place_axes(m->robot, values, frames);
}

double motion_time(const cprox_motion *m, size_t segment, double u) {
  return (1.0 - u) * m->times[segment] + u * m->times[segment + 1];
}

double motion_time_below(const cprox_motion *m, size_t segment, double u) {
  return round_down_between(m->times[segment], m->times[segment + 1], u);
}

bool motion_is_described(const cprox_motion *motion) {
  bool vectors = false;
  for (size_t i = 0; i < motion->robot->n_axes; i++) vectors = vectors || motion->robot->axes[i].kind == AXIS_VECTOR;
  return motion->given.times && !motion->arc_of && !vectors;
}

cprox_motion_info cprox_motion_get_info(const cprox_motion *motion) {
  return (cprox_motion_info){.kind = motion->kind,
                             .t0 = motion->times[0],
                             .t1 = motion->times[motion->n_segments],
                             .n_variables = motion->robot->n_variables,
                             .n_pieces = motion->n_segments};
}

size_t motion_segment_at(const cprox_motion *m, double t) {
  return segment_of(m->times, m->n_segments, t);
}

/* Fractions are rounded outwards by a little more than a division can be off. */
motion_interval motion_interval_of(const cprox_motion *m, double t0, double t1) {
  const size_t first = motion_segment_at(m, t0);
  size_t last = motion_segment_at(m, t1) + 1;
  if (last > first + 1 && m->times[last - 1] >= t1) last--;
  const double a = (t0 - m->times[first]) / (m->times[first + 1] - m->times[first]);
  const double b = (t1 - m->times[last - 1]) / (m->times[last] - m->times[last - 1]);
  return (motion_interval){.a = t0 <= m->times[first] ? 0.0 : fmax(a - 0x1p-50, 0.0),
                           .b = t1 >= m->times[last] ? 1.0 : fmin(b + 0x1p-50, 1.0),
                           .first = first,
                           .last = last};
}

void cprox_motion_evaluate(const cprox_motion *motion, double t, double *variables) {
  const size_t segment = motion_segment_at(motion, t);
  const double t0 = motion->times[segment], t1 = motion->times[segment + 1];
  values_at(motion, segment, fmin(fmax((t - t0) / (t1 - t0), 0.0), 1.0), variables);
}

/* ---- ranges ---- */

enum { RANGE_HALVINGS = 40 };

typedef struct value_range {
  double low, high; /* values that are taken */
  double room;      /* what is beyond them by less is not looked for */
} value_range;

/* Takes in the values of a polynomial. Intervals whose coefficients promise more than is known are cut in halves, from
 * left to right. */
static void take_in(const double *root, size_t degree, value_range *range) {
  double stack[RANGE_HALVINGS + 1][MOTION_MAX_DEGREE + 1];
  int depths[RANGE_HALVINGS + 1], n = 1;
  memcpy(stack[0], root, (degree + 1) * sizeof *root);
  depths[0] = 0;
  while (n > 0) {
    double *c = stack[n - 1], right[MOTION_MAX_DEGREE + 1];
    double low = c[0], high = c[0];
    for (size_t i = 1; i <= degree; i++) low = lesser(low, c[i]), high = greater(high, c[i]);
    range->low = lesser(range->low, lesser(c[0], c[degree]));
    range->high = greater(range->high, greater(c[0], c[degree]));
    const bool known = low >= range->low - range->room && high <= range->high + range->room;
    if (known || depths[n - 1] >= RANGE_HALVINGS) {
      range->low = lesser(range->low, low), range->high = greater(range->high, high);
      n--;
      continue;
    }

    /* the right half takes the place of the whole, the left one is looked at next */
    memcpy(right, c, (degree + 1) * sizeof *c);
    double left[MOTION_MAX_DEGREE + 1] = {c[0]};
    for (size_t r = 1; r <= degree; r++) {
      for (size_t i = 0; i + r <= degree; i++) right[i] = 0.5 * (right[i] + right[i + 1]);
      left[r] = right[0];
    }
    const int depth = ++depths[n - 1];
    memcpy(stack[n - 1], right, (degree + 1) * sizeof *right);
    memcpy(stack[n], left, (degree + 1) * sizeof *left);
    depths[n++] = depth;
  }
}

/* How far a variable is from its polynomial. */
static double sagitta_of_variable(const cprox_motion *m, size_t variable) {
  double most = 0.0;
  for (size_t i = 0; i < m->robot->n_axes && m->arc_of; i++) {
    const size_t first = (size_t)m->robot->axes[i].variable, n = (size_t)axis_variables(m->robot->axes[i].kind);
    if (m->arc_of[i] >= 0 && variable >= first && variable < first + n) most = greater(m->sagitta[i], most);
  }
  return most;
}

cprox_variable_info cprox_motion_get_variable_info(const cprox_motion *motion, size_t variable) {
  const int32_t slot = motion->slot[variable];
  const double rest = motion->rest[variable];
  if (slot < 0) return (cprox_variable_info){.lowest = rest, .highest = rest};
  value_range range = {.low = INFINITY, .high = -INFINITY};
  const motion_track *t = &motion->tracks[motion->track_of[variable]];
  for (int pass = 0; pass < 2; pass++) {
    for (size_t segment = 0; segment < t->n_segments; segment++) {
      const double *c = t->coefficients + (segment * t->n_moving + (size_t)slot - t->first_slot) * t->stride;
      const size_t degree = t->degree[segment];
      if (pass == 1) {
        take_in(c, degree, &range);
        continue;
      }

      /* first the segments' ends: where the values between them are within those, nothing is cut */
      range.low = lesser(range.low, lesser(c[0], c[degree]));
      range.high = greater(range.high, greater(c[0], c[degree]));
      for (size_t i = 0; i <= degree; i++) range.room = greater(range.room, 1e-9 * fabs(c[i]));
    }
  }
  const double arcs = sagitta_of_variable(motion, variable);
  return (cprox_variable_info){.lowest = range.low - arcs, .highest = range.high + arcs};
}

/* ---- what moves ---- */

/* Counts the joints from an axis up to, not including, another one, and those of them that the motion moves. */
static void count_joints(const cprox_motion *m, int32_t from, int32_t to, size_t *joints, size_t *moved) {
  for (int32_t i = from; i != to; i = m->robot->axes[i].parent) {
    *joints += m->robot->axes[i].first_of_joint;
    *moved += m->axis_moves[i];
  }
}

cprox_link_info cprox_motion_get_link_info(const cprox_motion *motion, int32_t link_a, int32_t link_b) {
  const int32_t a = link_a < 0 ? -1 : motion->robot->links[link_a].axis;
  const int32_t b = link_b < 0 ? -1 : motion->robot->links[link_b].axis;
  const int32_t common = robot_common_axis(motion->robot, a, b);
  cprox_link_info info = {0};
  count_joints(motion, a, common, &info.n_joints, &info.n_moved);
  count_joints(motion, b, common, &info.n_joints, &info.n_moved);
  return info;
}

bool motion_moves_link(const cprox_motion *motion, int32_t link) {
  const cprox_link_info to_world = cprox_motion_get_link_info(motion, link, -1);
  return (motion->is_state ? to_world.n_joints : to_world.n_moved) > 0;
}

bool motion_relates_links(const cprox_motion *motion, int32_t link_a, int32_t link_b) {
  const cprox_link_info between = cprox_motion_get_link_info(motion, link_a, link_b);
  return between.n_joints >= 2 && (motion->is_state || between.n_moved >= 1);
}
