/* SPDX-License-Identifier: BSD-3-Clause */
/* What an interval of a motion says of each axis: its frame in the middle, its velocities, and bounds on both. The
 * letters are those of doc/robot-motion-bounds.md. */
#include "kinematics/motion.h"

#include <math.h>

#include "base/bernstein.h"
#include "base/rounding.h"
#include "kinematics/lanes.h"

/* Velocity and acceleration of a ball are off by less than 64 u of (1 + w)² + a (doc/rounding.md, Counts that recur).
 * Four times that is an allowance. */
static const double ROUND_RATES = 256.0;

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

/* The values in the middle with two derivatives, bounds on the first three of these, and how far the first three
 * coordinates are from their middle at most, but for errors; returns the sum of their errors. */
static double derivatives_over(const cprox_motion *m, const motion_interval *own, const robot_axis *axis,
                               double p[3][4], double bound[4], double *shift) {
  const size_t degree = m->tracks[m->track_of[axis->variable]].degree[own->first];
  const int count = axis_variables(axis->kind);
  double c[4][MOTION_MAX_DEGREE + 1], factor = 2.0 * (double)degree;
  const double error = coordinates_over(m, own, axis, c);
  *shift = 0.0;
  for (int k = 0; k < count; k++) p[0][k] = bernstein_at(c[k], degree, 0.5);
  for (size_t i = 0; i <= degree && axis->kind == AXIS_VECTOR; i++)
    *shift = greater(vec_norm(vec(c[0][i] - p[0][0], c[1][i] - p[0][1], c[2][i] - p[0][2])), *shift);
  for (size_t order = 1; order <= 3 && order <= degree; order++) {
    for (int k = 0; k < count; k++) {
      differentiate(c[k], degree - order + 1);
      if (order < 3) p[order][k] = bernstein_at(c[k], degree - order, 0.5);
    }
    bound[order] = ROUND_UP * largest_norm(c, degree - order + 1) + factor * error;
    factor *= 2.0 * (double)(degree - order);
  }
  return error;
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

/* The velocities of a ball by its quaternion and two derivatives of that. */
static void find_ball(double p[3][4], const placement *before, axis_state *state) {
  double square = 0.0, along = 0.0;
  for (int k = 0; k < 4; k++) square += p[0][k] * p[0][k], along += p[0][k] * p[1][k];
  const vec3 omega = vec_scale(1.0 / square, twice_product(p[1], p[0]));
  const vec3 alpha = vec_axpy(vec_scale(1.0 / square, twice_product(p[2], p[0])), -2.0 * along / square, omega);
  state->velocity = placement_turn(before, omega);
  state->acceleration = placement_turn(before, alpha);
}

/* Over a span the quaternion is within `stray` of a straight line. Quaternions that are e apart, one of them of norm m
 * > e, turn vectors to where they are 2 e / m of their length apart at most, and any two turn them 2 apart at most. */
static void ball_over_span(const cprox_motion *m, size_t axis_index, const double *rows, const placement *before,
                           double p[3][4], axis_state *state) {
  const robot_axis *axis = &m->robot->axes[axis_index];
  const size_t stride = m->row_size;
  double line = 0.0, stray = 0.0, shift = 0.0, norm = 0.0;
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
  state->error = ROUND_RATES * ROUND_U * (1.0 + state->w) * (1.0 + state->w);
  find_ball(p, before, state);
}

/* A quaternion of any norm turns at omega = 2 vec(p' p*) / |p|² and omega' = 2 vec(p'' p*) / |p|² - 2 omega (p·p') /
 * |p|². */
static void ball_over(const cprox_motion *m, const motion_interval *own, size_t axis_index, const placement *before,
                      double p[3][4], axis_state *state) {
  const robot_axis *axis = &m->robot->axes[axis_index];
  const size_t degree = motion_track_of(m, axis_index)->degree[own->first];
  const double n = (double)degree;
  double bound[4] = {0}, shift;
  const double error = derivatives_over(m, own, axis, p, bound, &shift);

  /* all rates are in units of the least norm */
  const double norm = m->norm[axis_index], r1 = bound[1] / norm, r2 = bound[2] / norm, r3 = bound[3] / norm;
  state->w = 2.0 * r1;
  state->a = 2.0 * r2 + 4.0 * r1 * r1;
  state->g = 2.0 * r3 + 14.0 * r1 * r2 + 20.0 * r1 * r1 * r1;
  state->shift = state->line = 0.5 * state->w;
  state->variation = state->w;
  state->stray = 0.0;
  state->error = 2.0 * (2.0 * n + 1.0) * (2.0 * n + 1.0) * (1.0 + state->w) * (1.0 + state->w) * error / norm;

  find_ball(p, before, state);
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

/* The velocities of a rotation vector p, its two derivatives given: omega = J p', J = 1 + A [p] + B
 * [p]^2. */
static void find_vector(double values[3][4], const placement *before, axis_state *state) {
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
}

/* With bounds r1, r2, r3 on the derivatives of p: |omega| <= r1, |omega'| <= r2 + r1^2/2, |omega''| <= r3 + 3/2 r1 r2 +
 * r1^3/2. */
static void vector_over(const cprox_motion *m, const motion_interval *own, const robot_axis *axis,
                        const placement *before, double p[3][4], axis_state *state) {
  const size_t degree = m->tracks[m->track_of[axis->variable]].degree[own->first];
  const double n = (double)degree;
  double bound[4] = {0}, shift;
  const double error = derivatives_over(m, own, axis, p, bound, &shift);
  const double r1 = bound[1], r2 = bound[2], r3 = bound[3];
  state->w = r1;
  state->a = ROUND_UP * (r2 + 0.5 * r1 * r1);
  state->g = ROUND_UP * (r3 + 1.5 * r1 * r2 + 0.5 * r1 * r1 * r1);
  state->shift = state->line = lesser(ROUND_UP * shift + 2.0 * error, 2.0);
  state->variation = r1;
  state->stray = 0.0;
  state->error = 4.0 * (2.0 * n + 1.0) * (2.0 * n + 1.0) * (1.0 + r1) * (1.0 + r1) * error +
                 ROUND_RATES * ROUND_U * ((1.0 + r1) * (1.0 + r1) + r2);
  find_vector(p, before, state);
}

/* Over a span the vector is within `stray` of a straight line; rotations are no farther apart than their vectors. */
static void vector_over_span(const cprox_motion *m, const robot_axis *axis, const double *rows, const placement *before,
                             double p[3][4], axis_state *state) {
  const size_t stride = m->row_size;
  double line = 0.0, stray = 0.0, shift = 0.0;
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
  state->error = ROUND_RATES * ROUND_U * (1.0 + rate) * (1.0 + rate);
  find_vector(p, before, state);
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
  if (axis->kind != AXIS_PRISMATIC) {
    double q[4];
    arc_orientation(arc, s, q);
    placement here = robot_axis_move(axis, NULL, 0.0, q);
    here.p = p[0];
    state->frame = placement_compose(before, &here);
    state->velocity = vec_scale(ds * arc->angle, placement_turn(before, arc->z));
    state->w = ROUND_UP * ds * arc->angle;
  } else {
    double across;
    const double speed = arc_speed(arc, &across);
    state->z = world_axis(axis, before);
    if (!axis->first_of_joint) return;
    state->velocity = vec_scale(ds, placement_turn(before, p[1]));
    state->acceleration = vec_scale(ds * ds, placement_turn(before, p[2]));
    state->w = ROUND_UP * ds * speed;
    state->a = ROUND_UP * ds * ds * across * arc->angle;
    state->g = ROUND_UP * ds * ds * ds * across * arc->angle * arc->angle;
  }
  state->shift = state->line = 0.5 * state->w, state->variation = state->w;
  state->error = ROUND_RATES * ROUND_U * (state->w + state->a);
}

static void line_over(const cprox_motion *m, const motion_interval *own, const robot_axis *axis, const double *rows,
                      const placement *before, axis_state *state) {
  const size_t stride = m->row_size, slot = (size_t)m->slot[axis->variable];
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
  robot_axis_advance(axis, before, value, &state->frame);
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
  } else {
    double values[3][4] = {{0}}; /* with two derivatives */
    if (axis->kind == AXIS_VECTOR && motion_is_span(own))
      vector_over_span(m, axis, rows, &before, values, state);
    else if (axis->kind == AXIS_VECTOR)
      vector_over(m, own, axis, &before, values, state);
    else if (motion_is_span(own))
      ball_over_span(m, i, rows, &before, values, state);
    else
      ball_over(m, own, i, &before, values, state);
    const placement moved = robot_axis_move(axis, NULL, 0.0, values[0]);
    state->frame = parent ? placement_compose(parent, &moved) : moved;
  }
}
