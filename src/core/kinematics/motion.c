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
 * tracks have room for that (doc/robot-clocks.md). */
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
    fill_segment(t, own, rows, m->row_size);
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

/* ---- a node ---- */

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
  if (!m->arc_of || m->arc_of[i] < 0) {
    for (int32_t k = 0; k < axis_variables(axis->kind); k++) joint[k] = motion_value(m, axis->variable + k, own, u);
  } else {
    const int32_t ball = motion_track_of(m, i)->arc_axes[m->arc_of[i]];
    motion_arc_values(m, i, own, u, joint);
    values += axis->variable - (m->robot->axes[ball].variable - 3);
  }
  state->frame = robot_axis_move(axis, parent, axis->multiplier * values[0] + axis->offset, values);
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
  return (motion->given.times || motion->sources) && motion->given.turning != CPROX_TURNING_SCREW && !vectors;
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

bool motion_relates_links(const cprox_motion *motion, int32_t link_a, int32_t link_b) {
  return cprox_motion_get_link_info(motion, link_a, link_b).n_joints >= 2;
}
