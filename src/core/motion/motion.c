/* SPDX-License-Identifier: BSD-3-Clause */
/* A motion over a stretch of one of its segments: values, derivatives and their bounds, from Bernstein coefficients. */
#include "motion/motion.h"

#include <math.h>
#include <string.h>

#include "base/rounding.h"

/* ---- one variable --------------------------------------------------------------------------------------------------------- */

/* What the Bernstein coefficients of a stretch say of a variable: its value and derivatives in the middle, and bounds. */
typedef struct variable_state {
  double value, first, second;
  double w, a, g, shift, variation;
} variable_state;

/* The coefficients of [a, b], by two cuts. Both cuts of neighbours need not be the same point to the last bit: the error of a
 * segment covers that (doc/robot-bounds.md). */
static void section(const double *root, size_t degree, double a, double b, double *c) {
  memcpy(c, root, (degree + 1) * sizeof *c);
  if (a > 0.0)
    for (size_t r = 1; r <= degree; r++)
      for (size_t i = 0; i + r <= degree; i++) c[i] = (1.0 - a) * c[i] + a * c[i + 1];
  if (b >= 1.0) return;
  const double s = (b - a) / (1.0 - a);
  for (size_t r = 1; r <= degree; r++)
    for (size_t i = degree; i >= r; i--) c[i] = (1.0 - s) * c[i - 1] + s * c[i];
}

static double at_middle(const double *c, size_t degree) {
  double v[MOTION_MAX_DEGREE + 1] = {0};
  memcpy(v, c, (degree + 1) * sizeof *v);
  for (size_t r = 1; r <= degree; r++)
    for (size_t i = 0; i + r <= degree; i++) v[i] = 0.5 * (v[i] + v[i + 1]);
  return v[0];
}

/* The coefficients of the derivative take the place of those of the polynomial; returns the largest. */
static double differentiate(double *c, size_t degree) {
  double largest = 0.0;
  for (size_t i = 0; i < degree; i++) {
    c[i] = (double)degree * (c[i + 1] - c[i]);
    largest = fmax(largest, fabs(c[i]));
  }
  return largest;
}

/* `error` is that of the coefficients. */
static variable_state variable_over(double *c, size_t degree, double error) {
  variable_state v = {.value = at_middle(c, degree)};
  for (size_t i = 0; i <= degree; i++) v.shift = fmax(v.shift, fabs(c[i] - v.value));
  for (size_t i = 0; i < degree; i++) v.variation += fabs(c[i + 1] - c[i]);
  const double n = (double)degree;
  v.shift += 2.0 * error, v.variation += 2.0 * n * error;

  v.w = differentiate(c, degree) + 2.0 * n * error;
  v.first = at_middle(c, degree - 1);
  if (degree < 2) return v;
  v.a = differentiate(c, degree - 1) + 4.0 * n * (n - 1.0) * error;
  v.second = at_middle(c, degree - 2);
  if (degree < 3) return v;
  v.g = differentiate(c, degree - 2) + 8.0 * n * (n - 1.0) * (n - 2.0) * error;
  return v;
}

/* ---- one axis ------------------------------------------------------------------------------------------------------------- */

/* The coefficients of a variable over the stretch: those of a polynomial, or of a constant. */
static double coefficients_over(const cprox_motion *m, size_t segment, int32_t variable, double a, double b,
                                double *c) {
  const size_t degree = m->degree[segment];
  const int32_t slot = m->slot[variable];
  if (slot < 0) {
    for (size_t i = 0; i <= degree; i++) c[i] = m->rest[variable];
    return 0.0;
  }
  const size_t at = segment * m->n_moving + (size_t)slot;
  section(m->coefficients + at * m->stride, degree, a, b, c);
  return m->error[at];
}

static double largest_norm(double c[4][MOTION_MAX_DEGREE + 1], size_t count) {
  double largest = 0.0;
  for (size_t i = 0; i < count; i++)
    largest = fmax(largest, c[0][i] * c[0][i] + c[1][i] * c[1][i] + c[2][i] * c[2][i] + c[3][i] * c[3][i]);
  return sqrt(largest);
}

/* Twice the vector part of p q*, quaternions as x, y, z, w. */
static vec3 twice_product(const double *p, const double *q) {
  const vec3 u = vec(p[0], p[1], p[2]), v = vec(q[0], q[1], q[2]);
  return vec_scale(2.0, vec_sub(vec_sub(vec_scale(q[3], u), vec_scale(p[3], v)), vec_cross(u, v)));
}

/* A quaternion of any norm turns at omega = 2 vec(p' p*) / |p|² and omega' = 2 vec(p'' p*) / |p|² - 2 omega (p·p') / |p|². */
static void ball_over(const cprox_motion *m, size_t segment, size_t axis_index, double a, double b,
                      const placement *before, axis_state *state) {
  const robot_axis *axis = &m->robot->axes[axis_index];
  const size_t degree = m->degree[segment];
  const double n = (double)degree;
  double c[4][MOTION_MAX_DEGREE + 1] = {{0}}, p[3][4] = {{0}}, bound[4] = {0}, error = 0.0, factor = 2.0 * n;
  for (int k = 0; k < 4; k++) {
    error += coefficients_over(m, segment, axis->variable + k, a, b, c[k]);
    p[0][k] = at_middle(c[k], degree);
  }
  for (size_t order = 1; order <= 3 && order <= degree; order++) {
    for (int k = 0; k < 4; k++) {
      differentiate(c[k], degree - order + 1);
      if (order < 3) p[order][k] = at_middle(c[k], degree - order);
    }
    bound[order] = ROUND_UP * largest_norm(c, degree - order + 1) + factor * error;
    factor *= 2.0 * (n - (double)order);
  }

  /* all rates are in units of the least norm */
  const double norm = m->norm[axis_index], r1 = bound[1] / norm, r2 = bound[2] / norm, r3 = bound[3] / norm;
  state->w = 2.0 * r1;
  state->a = 2.0 * r2 + 4.0 * r1 * r1;
  state->g = 2.0 * r3 + 14.0 * r1 * r2 + 20.0 * r1 * r1 * r1;
  state->shift = 0.5 * state->w;
  state->variation = state->w;
  state->error = 2.0 * (2.0 * n + 1.0) * (2.0 * n + 1.0) * (1.0 + state->w) * (1.0 + state->w) * error / norm;

  double square = 0.0, along = 0.0;
  for (int k = 0; k < 4; k++) square += p[0][k] * p[0][k], along += p[0][k] * p[1][k];
  const vec3 omega = vec_scale(1.0 / square, twice_product(p[1], p[0]));
  const vec3 alpha = vec_axpy(vec_scale(1.0 / square, twice_product(p[2], p[0])), -2.0 * along / square, omega);
  state->velocity = placement_turn(before, omega);
  state->acceleration = placement_turn(before, alpha);
  state->frame = axis_move(axis, NULL, 0.0, p[0]);
}

static void line_over(const cprox_motion *m, size_t segment, const robot_axis *axis, double a, double b, double *values,
                      axis_state *state) {
  double c[MOTION_MAX_DEGREE + 1] = {0};
  variable_state v = {.value = m->rest[axis->variable]};
  double error = 0.0;
  if (state->moves) {
    error = coefficients_over(m, segment, axis->variable, a, b, c);
    v = variable_over(c, m->degree[segment], error);
  }
  values[axis->variable] = v.value;

  const double factor = fabs(axis->multiplier), value = axis->multiplier * v.value + axis->offset;
  state->w = factor * v.w, state->a = factor * v.a, state->g = factor * v.g;
  state->shift = factor * v.shift, state->variation = factor * v.variation;
  const double n = (double)m->degree[segment];
  state->error = factor * error * (n + 0.5 * n * n);
  state->velocity = vec_scale(axis->multiplier * v.first, state->z);
  state->acceleration = vec_scale(axis->multiplier * v.second, state->z);
  state->frame = axis_move(axis, NULL, value, NULL);
}

void motion_node(const cprox_motion *m, size_t segment, double a, double b, double *values, axis_state *axes) {
  static const placement HERE = {.r = {1, 0, 0, 0, 1, 0, 0, 0, 1}};
  for (size_t i = 0; i < m->robot->n_axes; i++) {
    const robot_axis *axis = &m->robot->axes[i];
    axis_state *state = &axes[i];
    const placement *parent = axis->parent < 0 ? &HERE : &axes[axis->parent].frame;
    const placement before = placement_compose(parent, &axis->at);
    state->kind = axis->kind;
    state->moves = m->axis_moves[i];
    state->z = placement_turn(&before, axis->z);
    if (axis->kind == AXIS_BALL)
      ball_over(m, segment, i, a, b, &before, state);
    else
      line_over(m, segment, axis, a, b, values, state);
    state->frame = placement_compose(parent, &state->frame);
  }
}

/* ---- one time ------------------------------------------------------------------------------------------------------------- */

static double value_at(const double *root, size_t degree, double u) {
  double c[MOTION_MAX_DEGREE + 1];
  memcpy(c, root, (degree + 1) * sizeof *c);
  for (size_t r = 1; r <= degree; r++)
    for (size_t i = 0; i + r <= degree; i++) c[i] = (1.0 - u) * c[i] + u * c[i + 1];
  return c[0];
}

static void values_at(const cprox_motion *m, size_t segment, double u, double *values) {
  memcpy(values, m->rest, m->robot->n_variables * sizeof *values);
  for (size_t k = 0; k < m->n_moving; k++)
    values[m->moving[k]] = value_at(m->coefficients + (segment * m->n_moving + k) * m->stride, m->degree[segment], u);
}

void motion_place(const cprox_motion *m, size_t segment, double u, double *values, placement *frames) {
  values_at(m, segment, u, values);
  robot_place_axes(m->robot, values, frames);
}

double motion_time(const cprox_motion *m, size_t segment, double u) {
  return (1.0 - u) * m->times[segment] + u * m->times[segment + 1];
}

void cprox_motion_domain(const cprox_motion *motion, double *t0, double *t1) {
  *t0 = motion->times[0];
  *t1 = motion->times[motion->n_segments];
}

void cprox_motion_evaluate(const cprox_motion *motion, double t, double *variables) {
  size_t segment = 0;
  while (segment + 1 < motion->n_segments && t >= motion->times[segment + 1]) segment++;
  const double t0 = motion->times[segment], t1 = motion->times[segment + 1];
  values_at(motion, segment, fmin(fmax((t - t0) / (t1 - t0), 0.0), 1.0), variables);
}

/* ---- ranges --------------------------------------------------------------------------------------------------------------- */

enum { RANGE_HALVINGS = 40 };

typedef struct value_range {
  double low, high; /* values that are taken */
  double room;      /* what is beyond them by less is not looked for */
} value_range;

/* Takes in the values of a polynomial. Stretches whose coefficients promise more than is known are cut in halves, from left to right. */
static void take_in(const double *root, size_t degree, value_range *range) {
  double stack[RANGE_HALVINGS + 1][MOTION_MAX_DEGREE + 1];
  int depths[RANGE_HALVINGS + 1], n = 1;
  memcpy(stack[0], root, (degree + 1) * sizeof *root);
  depths[0] = 0;
  while (n > 0) {
    double *c = stack[n - 1], right[MOTION_MAX_DEGREE + 1];
    double low = c[0], high = c[0];
    for (size_t i = 1; i <= degree; i++) low = fmin(low, c[i]), high = fmax(high, c[i]);
    range->low = fmin(range->low, fmin(c[0], c[degree]));
    range->high = fmax(range->high, fmax(c[0], c[degree]));
    const bool known = low >= range->low - range->room && high <= range->high + range->room;
    if (known || depths[n - 1] >= RANGE_HALVINGS) {
      range->low = fmin(range->low, low), range->high = fmax(range->high, high);
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

void cprox_motion_range(const cprox_motion *motion, size_t variable, double *low, double *high) {
  const int32_t slot = motion->slot[variable];
  *low = *high = motion->rest[variable];
  if (slot < 0) return;
  value_range range = {.low = INFINITY, .high = -INFINITY};
  for (int pass = 0; pass < 2; pass++) {
    for (size_t segment = 0; segment < motion->n_segments; segment++) {
      const double *c = motion->coefficients + (segment * motion->n_moving + (size_t)slot) * motion->stride;
      for (size_t i = 0; pass == 0 && i <= motion->degree[segment]; i++)
        range.room = fmax(range.room, 1e-9 * fabs(c[i]));
      if (pass == 1) take_in(c, motion->degree[segment], &range);
    }
  }
  *low = range.low, *high = range.high;
}

/* ---- what moves ----------------------------------------------------------------------------------------------------------- */

/* Counts the joints from an axis up to, not including, another one, and those of them that the motion moves. */
static void count_joints(const cprox_motion *m, int32_t from, int32_t to, size_t *joints, size_t *moved) {
  for (int32_t i = from; i != to; i = m->robot->axes[i].parent) {
    *joints += m->robot->axes[i].first_of_joint;
    *moved += m->axis_moves[i];
  }
}

bool cprox_motion_moves_link(const cprox_motion *motion, size_t link) {
  size_t joints = 0, moved = 0;
  count_joints(motion, motion->robot->links[link].axis, -1, &joints, &moved);
  return moved > 0;
}

/* The same between two links. */
static void count_between(const cprox_motion *motion, size_t link_a, size_t link_b, size_t *joints, size_t *moved) {
  const int32_t a = motion->robot->links[link_a].axis, b = motion->robot->links[link_b].axis;
  const int32_t common = robot_common_axis(motion->robot, a, b);
  count_joints(motion, a, common, joints, moved);
  count_joints(motion, b, common, joints, moved);
}

bool cprox_motion_moves_between(const cprox_motion *motion, size_t link_a, size_t link_b) {
  size_t joints = 0, moved = 0;
  count_between(motion, link_a, link_b, &joints, &moved);
  return moved >= 1;
}

bool cprox_motion_relates_links(const cprox_motion *motion, size_t link_a, size_t link_b) {
  size_t joints = 0, moved = 0;
  count_between(motion, link_a, link_b, &joints, &moved);
  return joints >= 2 && moved >= 1;
}
