/* SPDX-License-Identifier: BSD-3-Clause */
/* Motions from waypoints and from B-splines: checked, and turned into Bernstein coefficients. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/rounding.h"
#include "base/workspace.h"
#include "curve/curve.h"
#include "kinematics/lanes.h"
#include "kinematics/motion_build.h"

/* The largest value, velocity times duration, and so on. */
#define MOTION_LARGEST 1e100

/* ---- checks ---- */

static cprox_status check_source(const motion_source *s) {
  if (s->n > 0 && !s->variables) return workspace_fail(s->workspace, CPROX_INVALID, "variables is NULL");
  int32_t greatest = -1;
  for (size_t i = 0; i < s->n; i++) {
    if (s->variables[i] < 0 || (size_t)s->variables[i] >= s->robot->n_variables)
      return workspace_fail(s->workspace, CPROX_INVALID, "there is no variable %d: the robot has %zu",
                            (int)s->variables[i], s->robot->n_variables);
    if (s->variables[i] > greatest) {
      greatest = s->variables[i];
      continue;
    }
    for (size_t k = 0; k < i; k++)
      if (s->variables[k] == s->variables[i])
        return workspace_fail(s->workspace, CPROX_INVALID, "variable %d is named twice", (int)s->variables[i]);
  }
  for (size_t i = 0; s->rest && i < s->robot->n_variables; i++)
    if (!(fabs(s->rest[i]) <= MOTION_LARGEST))
      return workspace_fail(s->workspace, CPROX_INVALID, "the rest value of variable %zu is %g", i, s->rest[i]);
  return CPROX_OK;
}

static cprox_status check_row(const double *row, size_t n, const char *what, size_t point, cprox_workspace *workspace) {
  for (size_t i = 0; row && i < n; i++)
    if (!(fabs(row[i]) <= MOTION_LARGEST))
      return workspace_fail(workspace, CPROX_INVALID, "waypoint %zu: %s %zu is %g", point, what, i, row[i]);
  return CPROX_OK;
}

static cprox_status check_waypoint(const cprox_waypoint *p, size_t i, size_t n, cprox_interpolation interpolation,
                                   cprox_workspace *workspace) {
  if (!p->positions) return workspace_fail(workspace, CPROX_INVALID, "waypoint %zu has no positions", i);
  if (!(fabs(p->time) <= MOTION_LARGEST))
    return workspace_fail(workspace, CPROX_INVALID, "waypoint %zu: its time is %g", i, p->time);
  if (i > 0 && !(p[-1].time < p->time))
    return workspace_fail(workspace, CPROX_INVALID,
                          "waypoint %zu is at %.15g s, waypoint %zu at %.15g s: times must ascend", i - 1, p[-1].time,
                          i, p->time);
  const bool wants_velocity =
      interpolation == CPROX_INTERPOLATION_CUBIC || interpolation == CPROX_INTERPOLATION_QUINTIC;
  if (wants_velocity && !p->velocities)
    return workspace_fail(workspace, CPROX_INVALID, "waypoint %zu has no velocities, which the interpolation needs", i);
  if (interpolation == CPROX_INTERPOLATION_QUINTIC && !p->accelerations)
    return workspace_fail(workspace, CPROX_INVALID, "waypoint %zu has no accelerations, which quintics need", i);
  cprox_status status = check_row(p->positions, n, "position", i, workspace);
  if (status == CPROX_OK) status = check_row(p->velocities, n, "velocity", i, workspace);
  if (status == CPROX_OK) status = check_row(p->accelerations, n, "acceleration", i, workspace);
  return status;
}

static cprox_status check_spline(const cprox_motion_description *d, cprox_workspace *workspace) {
  const size_t degree = d->degree, n_control = d->n_control, n = d->n_variables;
  const double *control = d->control, *knots = d->knots;
  if (degree < 1 || degree > MOTION_MAX_DEGREE)
    return workspace_fail(workspace, CPROX_INVALID, "the degree is %zu, must be 1 … %d", degree, MOTION_MAX_DEGREE);
  if (n_control < degree + 1)
    return workspace_fail(workspace, CPROX_INVALID, "degree %zu needs at least %zu control points, got %zu", degree,
                          degree + 1, n_control);
  if (d->n_knots != n_control + degree + 1)
    return workspace_fail(workspace, CPROX_INVALID, "%zu control points of degree %zu need %zu knots, got %zu",
                          n_control, degree, n_control + degree + 1, d->n_knots);
  if (!control || !knots) return workspace_fail(workspace, CPROX_INVALID, "the control points or the knots are NULL");
  for (size_t i = 0; i < n_control * n; i++)
    if (!(fabs(control[i]) <= MOTION_LARGEST))
      return workspace_fail(workspace, CPROX_INVALID, "control point %zu, value %zu is %g", i / n, i % n, control[i]);
  for (size_t i = 0; i < n_control + degree + 1; i++) {
    if (!(fabs(knots[i]) <= MOTION_LARGEST))
      return workspace_fail(workspace, CPROX_INVALID, "knot %zu is %g", i, knots[i]);
    if (i > 0 && knots[i] < knots[i - 1])
      return workspace_fail(workspace, CPROX_INVALID, "knot %zu is %.15g, below knot %zu at %.15g", i, knots[i], i - 1,
                            knots[i - 1]);
    if (i > degree && i < n_control && knots[i] == knots[i - degree])
      return workspace_fail(workspace, CPROX_INVALID,
                            "knots %zu to %zu are all %.15g: so many inside would let the motion jump", i - degree, i,
                            knots[i]);
  }
  if (knots[degree] < knots[n_control]) return CPROX_OK;
  return workspace_fail(workspace, CPROX_INVALID, "the motion takes no time: knots %zu to %zu are all %.15g", degree,
                        n_control, knots[degree]);
}

/* ---- memory ---- */

bool motion_allocate_track(motion_track *t, size_t n_segments, size_t n_variables, size_t degree) {
  const size_t n = n_variables + 1, room = n_segments + 1;
  t->n_segments = n_segments;
  t->n_moving = n_variables;
  t->stride = degree + 1;
  t->times = calloc(room, sizeof *t->times);
  t->degree = calloc(room, sizeof *t->degree);
  t->coefficients = calloc(room * n * t->stride, sizeof *t->coefficients);
  t->error = calloc(room * n, sizeof *t->error);
  t->moving = calloc(n, sizeof *t->moving);
  return t->times && t->degree && t->coefficients && t->error && t->moving;
}

cprox_motion *motion_allocate(const motion_source *s, size_t n_tracks) {
  cprox_motion *m = calloc(1, sizeof *m);
  if (!m) return NULL;
  const size_t n_variables = s->robot->n_variables + 1;
  m->robot = s->robot;
  m->kind = s->description->kind;
  m->tracks = calloc(n_tracks + 1, sizeof *m->tracks);
  m->track_of = calloc(n_variables, sizeof *m->track_of);
  m->slot = calloc(n_variables, sizeof *m->slot);
  m->rest = calloc(2 * n_variables, sizeof *m->rest);
  m->axis_moves = calloc(s->robot->n_axes + 1, sizeof *m->axis_moves);
  m->carrier = calloc(s->robot->n_axes + 1, sizeof *m->carrier);
  m->still = calloc(s->robot->n_axes + 1, sizeof *m->still);
  m->norm = calloc(s->robot->n_axes + 1, sizeof *m->norm);
  m->part_error = calloc(s->robot->n_parts + 1, sizeof *m->part_error);
  if (m->tracks) m->n_tracks = n_tracks;
  if (m->tracks && m->track_of && m->slot && m->rest && m->axis_moves && m->carrier && m->still && m->norm &&
      m->part_error)
    return m;
  cprox_motion_free(m);
  return NULL;
}

/* A motion of one track. */
static cprox_motion *allocate_one(const motion_source *s, size_t n_segments, size_t degree) {
  cprox_motion *m = motion_allocate(s, 1);
  if (!m) return NULL;
  if (motion_allocate_track(m->tracks, n_segments, s->n, degree)) {
    m->times = m->tracks->times, m->n_segments = n_segments;
    return m;
  }
  cprox_motion_free(m);
  return NULL;
}

static void free_track(motion_track *t) {
  free(t->times);
  free(t->degree);
  free(t->coefficients);
  free(t->error);
  free(t->moving);
  free(t->arc_axes);
  free(t->arcs);
  motion_spans_free(&t->spans);
}

void cprox_motion_free(cprox_motion *motion) {
  if (!motion) return;
  if (motion->n_tracks == 0 || motion->times != motion->tracks->times) free(motion->times);
  for (size_t i = 0; i < motion->n_tracks; i++) free_track(&motion->tracks[i]);
  free(motion->tracks);
  free(motion->track_of);
  free(motion->slot);
  free(motion->rest);
  free(motion->axis_moves);
  free(motion->carrier);
  free(motion->still);
  free(motion->norm);
  free(motion->part_error);
  free(motion->sweeps);
  free(motion->arc_of);
  free(motion->sagitta);
  motion_given_free(&motion->given);
  for (size_t i = 0; i < motion->n_joined; i++) motion_given_free(&motion->joined[i]);
  for (size_t i = 0; i < motion->n_joined && motion->sources; i++) motion_given_free(&motion->sources[i]);
  free(motion->joined);
  free(motion->sources);
  free(motion);
}

/* ---- finishing ---- */

/* The largest coefficient of a variable over the whole motion, and the largest error. */
static double largest_value(const cprox_motion *m, int32_t variable, double *error) {
  *error = 0.0;
  const int32_t slot = m->slot[variable];
  if (slot < 0) return fabs(m->rest[variable]);
  const motion_track *t = &m->tracks[m->track_of[variable]];
  double largest = 0.0;
  for (size_t s = 0; s < t->n_segments; s++) {
    const size_t at = s * t->n_moving + (size_t)slot - t->first_slot;
    for (size_t i = 0; i <= t->degree[s]; i++) largest = fmax(largest, fabs(t->coefficients[at * t->stride + i]));
    *error = fmax(*error, t->error[at]);
  }
  return largest;
}

/* Variables that stand still are taken out of the list of the one track. */
static void find_moving(cprox_motion *m, const motion_source *s) {
  motion_track *t = m->tracks;
  const size_t n = s->n;
  size_t kept = 0;
  for (size_t v = 0; v < s->robot->n_variables; v++) {
    m->slot[v] = -1;
    m->rest[v] = s->rest ? s->rest[v] : 0.0;
  }
  for (size_t k = 0; k < n; k++) {
    const double first = t->coefficients[k * t->stride];
    bool moves = motion_moves_by_arc(m, s->variables[k]);
    for (size_t segment = 0; segment < t->n_segments; segment++)
      for (size_t i = 0; i <= t->degree[segment]; i++)
        moves = moves || t->coefficients[(segment * n + k) * t->stride + i] != first;
    m->rest[s->variables[k]] = first;
    if (!moves) continue;
    m->slot[s->variables[k]] = (int32_t)kept;
    t->moving[kept++] = (int32_t)k;
  }
  /* rows move towards the front only */
  for (size_t segment = 0; segment < t->n_segments; segment++)
    for (size_t k = 0; k < kept; k++) {
      const size_t from = segment * n + (size_t)t->moving[k], to = segment * kept + k;
      memmove(t->coefficients + to * t->stride, t->coefficients + from * t->stride, t->stride * sizeof(double));
      t->error[to] = t->error[from];
    }
  for (size_t k = 0; k < kept; k++) t->moving[k] = s->variables[t->moving[k]];
  t->n_moving = kept;
}

/* The least norm of a quaternion over the interval, from below; 0 where it cannot be told from 0. */
static double least_norm(double c[4][MOTION_MAX_DEGREE + 1], size_t degree, double error, int depth) {
  double middle[4] = {0}, left[4][MOTION_MAX_DEGREE + 1], right[4][MOTION_MAX_DEGREE + 1];
  for (int k = 0; k < 4; k++) {
    memcpy(right[k], c[k], sizeof right[k]);
    for (size_t r = 0; r <= degree; r++) {
      left[k][r] = right[k][0];
      for (size_t i = 0; i + r < degree; i++) right[k][i] = 0.5 * (right[k][i] + right[k][i + 1]);
    }
    middle[k] = left[k][degree];
  }
  double norm = 0.0, spread = 0.0;
  for (int k = 0; k < 4; k++) norm += middle[k] * middle[k];
  for (size_t i = 0; i <= degree; i++) {
    double d = 0.0;
    for (int k = 0; k < 4; k++) d += (c[k][i] - middle[k]) * (c[k][i] - middle[k]);
    spread = fmax(spread, d);
  }
  const double bound = (1.0 - 16.0 * ROUND_U) * (sqrt(norm) - sqrt(spread)) - error;
  if (bound >= 0.5 * sqrt(norm) && norm > 0.0) return bound;
  if (depth == 0) return 0.0;
  return fmin(least_norm(left, degree, error, depth - 1), least_norm(right, degree, error, depth - 1));
}

static double least_norm_of(const cprox_motion *m, int32_t variable) {
  const motion_track *t = &m->tracks[m->track_of[variable]];
  double least = INFINITY;
  for (size_t s = 0; s < t->n_segments; s++) {
    double c[4][MOTION_MAX_DEGREE + 1] = {{0}}, error = 0.0;
    for (int k = 0; k < 4; k++) {
      const int32_t slot = m->slot[variable + k];
      const size_t at = s * t->n_moving + (slot < 0 ? 0 : (size_t)slot - t->first_slot);
      for (size_t i = 0; i <= t->degree[s]; i++)
        c[k][i] = slot < 0 ? m->rest[variable + k] : t->coefficients[at * t->stride + i];
      error += slot < 0 ? 0.0 : t->error[at];
    }
    least = fmin(least, least_norm(c, t->degree[s], error, 12));
  }
  return least;
}

/* Of joints that turn by arcs: the axes that shift with a screw, and how far all are from straight lines. */
static void finish_arcs(cprox_motion *m) {
  for (size_t i = 0; i < m->robot->n_axes && m->arc_of; i++) {
    if (m->arc_of[i] < 0 || m->robot->axes[i].kind != AXIS_BALL) continue;
    const motion_arc *arcs = motion_arc_at(m, i, 0);
    for (size_t k = 0; k < motion_track_of(m, i)->n_segments; k++) {
      double position;
      const double turned = arc_sagitta(&arcs[k], &position);
      m->sagitta[i] = fmax(m->sagitta[i], turned);
      for (size_t j = 1; j <= 3 && arcs[k].screw; j++) {
        m->sagitta[i - j] = fmax(m->sagitta[i - j], position);
        m->arc_of[i - j] = m->arc_of[i];
      }
    }
  }
}

/* What is known of each axis and part once the coefficients are there. */
static cprox_status finish_axes(cprox_motion *m, const motion_source *s) {
  m->carrier[0] = -1;
  for (size_t i = 0; i < s->robot->n_axes; i++) {
    const robot_axis *axis = &s->robot->axes[i];
    for (int32_t k = 0; k < axis_variables(axis->kind); k++)
      m->axis_moves[i] = m->axis_moves[i] || (m->slot[axis->variable + k] >= 0 && axis->multiplier != 0.0);
    m->carrier[i + 1] = m->axis_moves[i] ? (int32_t)i : m->carrier[axis->parent + 1];
    const double *rest = m->rest + axis->variable;
    if (!m->axis_moves[i]) m->still[i] = robot_axis_move(axis, NULL, axis->multiplier * rest[0] + axis->offset, rest);
    if (axis->kind != AXIS_BALL) continue;
    m->norm[i] = least_norm_of(m, axis->variable);
    if (!(m->norm[i] > 1e-9))
      return workspace_fail(s->workspace, CPROX_INVALID,
                            "the quaternion of variables %d to %d comes too near 0 to be a rotation",
                            (int)axis->variable, (int)axis->variable + 3);
  }
  return CPROX_OK;
}

/* How far the computed value of an axis may be from the exact one, and how large it gets. */
static double value_error(const cprox_motion *m, int32_t i, double *value) {
  const robot_axis *axis = &m->robot->axes[i];
  const int32_t count = axis_variables(axis->kind);
  double largest = 0.0, error, sum = 0.0;
  for (int32_t k = 0; k < count; k++) largest = largest_value(m, axis->variable + k, &error), sum += error;
  *value = fabs(axis->multiplier) * largest + fabs(axis->offset);
  if (m->arc_of) *value += m->sagitta[i];
  if (axis->kind == AXIS_BALL) return 2.0 * sum / m->norm[i];
  return fabs(axis->multiplier) * sum + 2.0 * ROUND_U * (*value + fabs(axis->offset));
}

/* What the transforms and values of an axis and of all above it do to what is at the axis, and to what is behind it. */
typedef struct chain_error {
  double shifts;    /* the most that prismatic axes add to the reach */
  double turned;    /* by how much the transforms may turn it, in ROUND_JOINT, times the lengths behind them */
  double values;    /* so far may axes shift it whose values are off, */
  double rotations; /* and so far for each unit of length behind the axis */
} chain_error;

static const chain_error NO_ERROR = {.shifts = 0.0};

static chain_error error_of_axis(const cprox_motion *m, int32_t i, const chain_error *chain) {
  const robot_axis *axis = &m->robot->axes[i];
  const bool shifts = axis->kind == AXIS_PRISMATIC;
  const chain_error above = axis->parent < 0 ? NO_ERROR : chain[axis->parent];
  double largest;
  const double error = value_error(m, i, &largest), shift = shifts ? largest : 0.0;
  const double length = axis->reach - (axis->parent < 0 ? 0.0 : m->robot->axes[axis->parent].reach) + shift;
  return (chain_error){.shifts = above.shifts + shift,
                       .turned = above.turned + (double)axis->steps * length,
                       .values = above.values + above.rotations * length + (shifts ? error : 0.0),
                       .rotations = above.rotations + (shifts ? 0.0 : error)};
}

/* Transforms that turn by ROUND_JOINT too much, and values that are off by theirs, about lever arms of at most the
 * lengths that are behind them; then what sums of places round. Each axis adds its own length to what is behind all
 * above it. */
static cprox_status finish_parts(cprox_motion *m, cprox_workspace *workspace) {
  const cprox_robot *robot = m->robot;
  chain_error *chain = calloc(robot->n_axes + 1, sizeof *chain);
  if (!chain) return workspace_fail(workspace, CPROX_MEMORY, "no memory for a motion of %zu axes", robot->n_axes);
  for (size_t i = 0; i < robot->n_axes; i++) chain[i] = error_of_axis(m, (int32_t)i, chain);
  cprox_status status = CPROX_OK;
  for (size_t p = 0; p < robot->n_parts && status == CPROX_OK; p++) {
    const robot_part *part = &robot->parts[p];
    const chain_error above = part->axis < 0 ? NO_ERROR : chain[part->axis];
    const double length = part->reach - (part->axis < 0 ? 0.0 : robot->axes[part->axis].reach);
    const double reach = part->reach + above.shifts;
    if (!(reach <= LENGTH_MOST))
      status = workspace_fail(workspace, CPROX_INVALID,
                              "the motion takes geometry %d as far as %g m, at most %g m are possible",
                              (int)part->geometry, reach, LENGTH_MOST);
    const double turned = above.turned + (double)part->steps * length,
                 places = ROUND_PLACE * (1.0 + (double)part->steps) * reach,
                 values = above.values + above.rotations * length;
    m->part_error[p] = ROUND_UP * (ROUND_U * (ROUND_JOINT * turned + places) + values);
  }
  free(chain);
  return status;
}

cprox_status motion_finish(cprox_motion *m, const motion_source *s, cprox_motion **motion) {
  if (m->kind != CPROX_MOTION_JOINED) find_moving(m, s);
  const motion_track *last = &m->tracks[m->n_tracks - 1];
  m->row_size = last->first_slot + lanes_padded(last->n_moving);
  finish_arcs(m);
  cprox_status status = finish_axes(m, s);
  if (status == CPROX_OK) status = finish_parts(m, s->workspace);
  for (size_t i = 0; i < m->n_tracks && status == CPROX_OK; i++) {
    if (!motion_spans_make(&m->tracks[i]))
      status = workspace_fail(s->workspace, CPROX_MEMORY, "no memory for the spans of %zu segments",
                              m->tracks[i].n_segments);
    else if (workspace_stops(s->workspace))
      status = workspace_fail(s->workspace, CPROX_INVALID, "stopped while a motion of %zu segments was being made",
                              m->n_segments);
  }
  if (status == CPROX_OK && m->n_tracks > 1 && !motion_sweeps_make(m))
    status = workspace_fail(s->workspace, CPROX_MEMORY, "no memory for the parts of %zu motions", m->n_tracks);
  if (status != CPROX_OK) {
    cprox_motion_free(m);
    return status;
  }
  *motion = m;
  return CPROX_OK;
}

double motion_cutting_error(size_t degree, double largest) {
  return ROUND_UP * ROUND_U * (16.0 * (double)degree + 8.0) * largest;
}

/* ---- waypoints ---- */

static size_t degree_between(const cprox_waypoint *a, const cprox_waypoint *b, cprox_interpolation interpolation) {
  switch (interpolation) {
    case CPROX_INTERPOLATION_LINEAR: return 1;
    case CPROX_INTERPOLATION_CUBIC: return 3;
    case CPROX_INTERPOLATION_QUINTIC: return 5;
    case CPROX_INTERPOLATION_BY_WAYPOINTS: break;
  }
  if (!a->velocities || !b->velocities) return 1;
  return a->accelerations && b->accelerations ? 5 : 3;
}

/* The Hermite polynomial of one variable over h seconds; returns the size of what was added up. */
static double hermite(const cprox_waypoint *p, const cprox_waypoint *q, size_t k, size_t degree, double h, double *c) {
  const double n = (double)degree;
  c[0] = p->positions[k], c[degree] = q->positions[k];
  double size = fmax(fabs(c[0]), fabs(c[degree]));
  if (degree == 1) return size;
  const double v0 = h * p->velocities[k] / n, v1 = h * q->velocities[k] / n;
  c[1] = c[0] + v0, c[degree - 1] = c[degree] - v1;
  size += 2.0 * fmax(fabs(v0), fabs(v1));
  if (degree == 3) return size;
  const double a0 = h * h * p->accelerations[k] / 20.0, a1 = h * h * q->accelerations[k] / 20.0;
  c[2] = c[0] + 2.0 * v0 + a0, c[3] = c[5] - 2.0 * v1 + a1;
  return size + fmax(fabs(a0), fabs(a1));
}

static cprox_status create_waypoints(const motion_source *s, cprox_motion **motion) {
  cprox_workspace *const workspace = s->workspace;
  const cprox_waypoint *points = s->description->waypoints;
  const size_t n = s->n, n_points = s->description->n_waypoints;
  const cprox_interpolation interpolation = s->description->interpolation;
  if (!points || n_points < 2)
    return workspace_fail(workspace, CPROX_INVALID, "a motion needs at least 2 waypoints, got %zu",
                          points ? n_points : (size_t)0);
  if ((unsigned)interpolation > CPROX_INTERPOLATION_QUINTIC)
    return workspace_fail(workspace, CPROX_INVALID, "%d is no interpolation", (int)interpolation);
  if ((unsigned)s->description->turning > CPROX_TURNING_SCREW)
    return workspace_fail(workspace, CPROX_INVALID, "%d is no way to turn", (int)s->description->turning);
  cprox_status status = CPROX_OK;
  for (size_t i = 0; i < n_points && status == CPROX_OK; i++)
    status = check_waypoint(&points[i], i, n, interpolation, workspace);
  if (status != CPROX_OK) return status;

  cprox_motion *m = allocate_one(s, n_points - 1, 5);
  if (m && !motion_keep_waypoints(&m->given, s->description)) {
    cprox_motion_free(m);
    m = NULL;
  }
  if (!m) return workspace_fail(workspace, CPROX_MEMORY, "no memory for a motion of %zu waypoints", n_points);
  motion_track *t = m->tracks;
  t->times[0] = points[0].time;
  for (size_t i = 0; i + 1 < n_points; i++) {
    const cprox_waypoint *p = &points[i];
    t->times[i + 1] = p[1].time;
    t->degree[i] = (uint8_t)degree_between(&p[0], &p[1], interpolation);
    for (size_t k = 0; k < n; k++) {
      const size_t at = i * n + k;
      const double size =
          hermite(&p[0], &p[1], k, t->degree[i], p[1].time - p[0].time, t->coefficients + at * t->stride);
      t->error[at] =
          motion_cutting_error(t->degree[i], size); /* the sums of hermite() are off by 8 u of their size at most */
    }
  }
  if (s->description->turning != CPROX_TURNING_POLYNOMIAL) {
    status = motion_turn_by_arcs(s, m);
    if (status != CPROX_OK) {
      cprox_motion_free(m);
      return status;
    }
  }
  return motion_finish(m, s, motion);
}

/* ---- B-splines ---- */

/* One span of one variable; returns the size of its de Boor points. */
static double convert_span(const double *control, size_t n, const double *knots, size_t degree, size_t r, double *c) {
  vec3 points[MOTION_MAX_DEGREE + 1], bezier[MOTION_MAX_DEGREE + 1];
  double size = 0.0;
  for (size_t i = 0; i <= degree; i++) {
    points[i] = vec(control[(r - degree + i) * n], 0, 0);
    size = fmax(size, fabs(points[i].x));
  }
  curve_blossom(points, knots + r - degree + 1, degree, knots[r], knots[r + 1], bezier);
  for (size_t i = 0; i <= degree; i++) c[i] = bezier[i].x;
  return size;
}

static cprox_status create_bspline(const motion_source *s, cprox_motion **motion) {
  cprox_workspace *const workspace = s->workspace;
  const double *control = s->description->control, *knots = s->description->knots;
  const size_t n = s->n, degree = s->description->degree, n_control = s->description->n_control;
  const cprox_status status = check_spline(s->description, workspace);
  if (status != CPROX_OK) return status;

  size_t n_segments = 0;
  for (size_t r = degree; r < n_control; r++) n_segments += knots[r] < knots[r + 1];
  cprox_motion *m = allocate_one(s, n_segments, degree);
  if (m && !motion_keep_spline(&m->given, s->description)) {
    cprox_motion_free(m);
    m = NULL;
  }
  if (!m) return workspace_fail(workspace, CPROX_MEMORY, "no memory for a motion of %zu spans", n_segments);
  motion_track *t = m->tracks;
  t->times[0] = knots[degree];
  size_t i = 0;
  for (size_t r = degree; r < n_control; r++) {
    if (!(knots[r] < knots[r + 1])) continue;
    t->times[i + 1] = knots[r + 1];
    t->degree[i] = (uint8_t)degree;
    for (size_t k = 0; k < n; k++) {
      const size_t at = i * n + k;
      const double size = convert_span(control + k, n, knots, degree, r, t->coefficients + at * t->stride);
      t->error[at] = motion_cutting_error(degree, size) + ROUND_UP * ROUND_U * 5.0 * (double)degree * size;
    }
    i++;
  }
  return motion_finish(m, s, motion);
}

/* ---- states ---- */

/* All that depends on the values of the variables, which stand in m->rest. */
static cprox_status place_state(cprox_motion *m, cprox_workspace *workspace) {
  const motion_source s = {.robot = m->robot, .workspace = workspace};
  const cprox_status status = finish_axes(m, &s);
  return status == CPROX_OK ? finish_parts(m, workspace) : status;
}

/* Its time is any in [0, 1]: a motion that goes nowhere. */
static cprox_status create_state(const motion_source *s, cprox_motion **motion) {
  cprox_workspace *const workspace = s->workspace;
  if (s->n > 0) return workspace_fail(workspace, CPROX_INVALID, "a state gives all variables by rest, none by name");
  static const double NOTHING = 0.0;
  const cprox_waypoint ends[2] = {{.time = 0.0, .positions = &NOTHING}, {.time = 1.0, .positions = &NOTHING}};
  const cprox_motion_description given = {
      .waypoints = ends, .n_waypoints = 2, .interpolation = CPROX_INTERPOLATION_LINEAR};
  cprox_motion *m = allocate_one(s, 1, 1);
  if (m && !motion_keep_waypoints(&m->given, &given)) {
    cprox_motion_free(m);
    m = NULL;
  }
  if (!m)
    return workspace_fail(workspace, CPROX_MEMORY, "no memory for a state of %zu variables", s->robot->n_variables);
  m->is_state = true;
  m->tracks->times[1] = 1.0;
  m->tracks->degree[0] = 1;
  return motion_finish(m, s, motion);
}

cprox_status motion_set_state(cprox_motion *motion, const double *values, cprox_workspace *workspace) {
  workspace_clear(workspace);
  if (!motion || !values) return workspace_fail(workspace, CPROX_INVALID, "%s is NULL", motion ? "values" : "motion");
  if (!motion->is_state) return workspace_fail(workspace, CPROX_INVALID, "the motion is no state");
  const size_t n = motion->robot->n_variables;
  const motion_source s = {.robot = motion->robot, .rest = values, .workspace = workspace};
  cprox_status status = check_source(&s);
  if (status != CPROX_OK) return status;
  double *before = motion->rest + n; /* there is room for two states */
  memcpy(before, motion->rest, n * sizeof *before);
  memcpy(motion->rest, values, n * sizeof *values);
  status = place_state(motion, workspace);
  if (status == CPROX_OK) return CPROX_OK;
  memcpy(motion->rest, before, n * sizeof *before);
  place_state(motion, NULL);
  return status;
}

/* ---- every kind ---- */

cprox_status cprox_motion_create(const cprox_robot *robot, const cprox_motion_description *description,
                                 cprox_workspace *workspace, cprox_motion **motion) {
  WORKSPACE_USE(workspace);
  workspace_clear(workspace);
  if (!motion) return workspace_fail(workspace, CPROX_INVALID, "motion is NULL: nowhere to put the handle");
  if (!robot) return workspace_fail(workspace, CPROX_INVALID, "robot is NULL");
  if (!description) return workspace_fail(workspace, CPROX_INVALID, "the description of the motion is NULL");
  const bool joined = description->kind == CPROX_MOTION_JOINED;
  const motion_source s = {.robot = robot,
                           .variables = joined ? NULL : description->variables,
                           .n = joined ? 0 : description->n_variables,
                           .rest = joined ? NULL : description->rest,
                           .description = description,
                           .workspace = workspace};
  const cprox_status status = check_source(&s);
  if (status != CPROX_OK) return status;
  switch (description->kind) {
    case CPROX_MOTION_WAYPOINTS: return create_waypoints(&s, motion);
    case CPROX_MOTION_BSPLINE: return create_bspline(&s, motion);
    case CPROX_MOTION_STATE: return create_state(&s, motion);
    case CPROX_MOTION_JOINED: return motion_create_joined(&s, motion);
  }
  return workspace_fail(workspace, CPROX_INVALID, "%d is no kind of motion", (int)description->kind);
}
