/* SPDX-License-Identifier: BSD-3-Clause */
/* Several motions on one clock. Its segments end wherever one of the motions has a segment's end, so that over each of
 * them every variable is one polynomial. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/rounding.h"
#include "base/workspace.h"
#include "kinematics/motion_build.h"

/* When something of a motion happens on the clock of all: what is exact from here on. */
static double on_clock(const cprox_joined_motion *one, size_t knot) {
  return one->motion->times[knot] + one->start;
}

static double begin_of(const cprox_joined_motion *one) {
  return on_clock(one, 0);
}

static double end_of(const cprox_joined_motion *one) {
  return on_clock(one, one->motion->n_segments);
}

/* ---- checks ---- */

static cprox_status check_times(const cprox_joined_motion *one, size_t i, cprox_workspace *workspace) {
  if (!isfinite(one->start))
    return workspace_fail(workspace, CPROX_INVALID, "motion %zu: its start is %g s", i, one->start);
  for (size_t k = 0; k < one->motion->n_segments; k++)
    if (!(on_clock(one, k) < on_clock(one, k + 1)))
      return workspace_fail(
          workspace, CPROX_INVALID,
          "motion %zu: its start at %.15g s is so large that its times %.15g s and %.15g s become one", i, one->start,
          one->motion->times[k], one->motion->times[k + 1]);
  return CPROX_OK;
}

/* Nothing may happen only after everything else has ended. */
static cprox_status check_overlap(const cprox_joined_motion *joined, size_t n, cprox_workspace *workspace) {
  for (size_t i = 0; i < n; i++) {
    if (joined[i].motion->is_state) continue;
    const double begin = begin_of(&joined[i]);
    double before = -INFINITY; /* the last end of those that begin earlier */
    for (size_t k = 0; k < n; k++)
      if (!joined[k].motion->is_state && begin_of(&joined[k]) < begin) before = fmax(before, end_of(&joined[k]));
    if (before > -INFINITY && before < begin)
      return workspace_fail(workspace, CPROX_INVALID,
                            "the clocks do not overlap: motion %zu begins at %.15g s, %.3g s after all earlier ones "
                            "have ended",
                            i, begin, begin - before);
  }
  return CPROX_OK;
}

static cprox_status check_joined(const motion_source *s) {
  const cprox_joined_motion *joined = s->description->joined;
  const size_t n = s->description->n_joined;
  size_t variables = 0;
  bool moves = false;
  if (!joined || n == 0) return workspace_fail(s->workspace, CPROX_INVALID, "there is no motion to join");
  for (size_t i = 0; i < n; i++) {
    if (!joined[i].motion) return workspace_fail(s->workspace, CPROX_INVALID, "motion %zu is NULL", i);
    variables += joined[i].motion->robot->n_variables;
    moves = moves || !joined[i].motion->is_state;
    const cprox_status status = joined[i].motion->is_state ? CPROX_OK : check_times(&joined[i], i, s->workspace);
    if (status != CPROX_OK) return status;
  }
  if (variables != s->robot->n_variables)
    return workspace_fail(s->workspace, CPROX_INVALID,
                          "the motions have %zu variables, the robot has %zu: give one motion for each joined robot",
                          variables, s->robot->n_variables);
  if (!moves)
    return workspace_fail(s->workspace, CPROX_INVALID, "all motions are states: make a state of the joined robot");
  return check_overlap(joined, n, s->workspace);
}

/* ---- times ---- */

static int compare_times(const void *a, const void *b) {
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

/* The ends of all segments, ascending, none twice; *count of them. NULL where memory is out. */
static double *unite_times(const cprox_joined_motion *joined, size_t n, size_t *count) {
  size_t most = 0, all = 0;
  for (size_t i = 0; i < n; i++) most += joined[i].motion->n_segments + 1;
  double *times = malloc((most + 1) * sizeof *times);
  if (!times) return NULL;
  for (size_t i = 0; i < n; i++)
    for (size_t k = 0; k <= joined[i].motion->n_segments && !joined[i].motion->is_state; k++)
      times[all++] = on_clock(&joined[i], k);
  qsort(times, all, sizeof *times, compare_times);
  *count = 0;
  for (size_t i = 0; i < all; i++)
    if (i == 0 || times[i] > times[*count - 1]) times[(*count)++] = times[i];
  return times;
}

/* ---- coefficients ---- */

/* What one motion does over a segment of all. */
typedef struct joined_piece {
  size_t segment;
  double a, b; /* of it */
  bool stands; /* at a, which is 0 or 1 */
} joined_piece;

/* *segment: the one before, or 0; times come in their order. */
static joined_piece piece_over(const cprox_joined_motion *one, double t0, double t1, size_t *segment) {
  const size_t last = one->motion->n_segments;
  if (one->motion->is_state || t1 <= begin_of(one)) return (joined_piece){.stands = true};
  if (t0 >= end_of(one)) return (joined_piece){.segment = last - 1, .a = 1.0, .b = 1.0, .stands = true};
  while (*segment + 1 < last && on_clock(one, *segment + 1) <= t0) (*segment)++;
  const double from = on_clock(one, *segment), to = on_clock(one, *segment + 1);
  return (joined_piece){
      .segment = *segment, .a = (t0 - from) / (to - from), .b = t1 >= to ? 1.0 : (t1 - from) / (to - from)};
}

static double largest_of(const double *c, size_t degree) {
  double largest = 0.0;
  for (size_t i = 0; i <= degree; i++) largest = fmax(largest, fabs(c[i]));
  return largest;
}

/* The part [a, b], in place. */
static void cut(double *c, size_t degree, double a, double b) {
  if (a > 0.0)
    for (size_t r = 1; r <= degree; r++)
      for (size_t i = 0; i + r <= degree; i++) c[i] = (1.0 - a) * c[i] + a * c[i + 1];
  if (b >= 1.0) return;
  const double s = (b - a) / (1.0 - a);
  for (size_t r = 1; r <= degree; r++)
    for (size_t i = degree; i >= r; i--) c[i] = (1.0 - s) * c[i - 1] + s * c[i];
}

static void elevate(double *c, size_t degree, size_t to) {
  for (size_t n = degree; n < to; n++) {
    c[n + 1] = c[n];
    for (size_t i = n; i > 0; i--) {
      const double s = (double)i / (double)(n + 1);
      c[i] = s * c[i - 1] + (1.0 - s) * c[i];
    }
  }
}

/* All variables of one motion over a segment of all. Each elevation rounds by 4 u at most; the places that a and b
 * stand for are off by as much as those of two neighbouring nodes. */
static void copy_piece(const cprox_motion *from, const joined_piece *piece, size_t degree, size_t stride, double *c,
                       double *error) {
  const size_t own = from->degree[piece->segment];
  for (size_t k = 0; k < from->n_moving; k++, c += stride) {
    const size_t at = piece->segment * from->n_moving + k;
    memcpy(c, from->coefficients + at * from->stride, (own + 1) * sizeof *c);
    const double largest = largest_of(c, own);
    error[k] = from->error[at] + motion_cutting_error(own, largest) + motion_cutting_error(degree, largest);
    if (piece->stands) {
      const double still = piece->a > 0.0 ? c[own] : c[0];
      for (size_t i = 0; i <= degree; i++) c[i] = still;
      continue;
    }
    cut(c, own, piece->a, piece->b);
    elevate(c, own, degree);
    error[k] += ROUND_UP * ROUND_U * 4.0 * (double)(degree - own) * largest;
  }
}

/* ---- the whole ---- */

static void fill(cprox_motion *m, const cprox_joined_motion *joined, size_t n, size_t *segments) {
  for (size_t i = 0; i < m->n_segments; i++) {
    size_t degree = 1;
    for (int pass = 0; pass < 2; pass++) {
      size_t first = 0;
      for (size_t k = 0; k < n; k++) {
        const cprox_motion *from = joined[k].motion;
        const joined_piece piece = piece_over(&joined[k], m->times[i], m->times[i + 1], &segments[k]);
        const size_t own = from->degree[piece.segment], at = i * m->n_moving + first;
        if (pass == 0 && !piece.stands) degree = own > degree ? own : degree;
        if (pass == 1) copy_piece(from, &piece, degree, m->stride, m->coefficients + at * m->stride, m->error + at);
        first += from->n_moving;
      }
    }
    m->degree[i] = (uint8_t)degree;
  }
}

/* Joints that turn by arcs: over each segment of all, a part of one of their own. */
static void fill_arcs(cprox_motion *m, const cprox_joined_motion *joined, size_t n, size_t *segments) {
  size_t axes = 0, arcs = 0;
  for (size_t k = 0; k < n; k++) {
    const cprox_motion *from = joined[k].motion;
    for (size_t i = 0; i < from->robot->n_axes && from->arcs; i++)
      if (from->arc_of[i] >= 0) m->arc_of[axes + i] = (int32_t)arcs + from->arc_of[i];
    segments[k] = 0;
    for (size_t i = 0; i < m->n_segments && from->arcs && m->arcs; i++) {
      const joined_piece piece = piece_over(&joined[k], m->times[i], m->times[i + 1], &segments[k]);
      for (size_t j = 0; j < from->n_arcs; j++) {
        motion_arc *arc = &m->arcs[(arcs + j) * m->n_segments + i];
        *arc = from->arcs[j * from->n_segments + piece.segment];
        const double begin = arc->from, part = arc->to - begin;
        arc->from = begin + part * piece.a, arc->to = begin + part * piece.b;
      }
    }
    axes += from->robot->n_axes, arcs += from->n_arcs;
  }
}

/* The variables that move, in the joined robot's numbers, and the rest values of all. */
static void number_variables(const cprox_joined_motion *joined, size_t n, int32_t *variables, double *rest) {
  size_t first = 0, count = 0;
  for (size_t i = 0; i < n; i++) {
    const cprox_motion *from = joined[i].motion;
    for (size_t k = 0; k < from->n_moving; k++) variables[count++] = (int32_t)first + from->moving[k];
    memcpy(rest + first, from->rest, from->robot->n_variables * sizeof *rest);
    first += from->robot->n_variables;
  }
}

cprox_status motion_create_joined(const motion_source *s, cprox_motion **motion) {
  const cprox_status status = check_joined(s);
  if (status != CPROX_OK) return status;
  const cprox_joined_motion *joined = s->description->joined;
  const size_t n = s->description->n_joined;
  size_t moving = 0, degree = 1, count = 0, arcs = 0;
  for (size_t i = 0; i < n; i++) {
    const cprox_motion *from = joined[i].motion;
    moving += from->n_moving, arcs += from->n_arcs;
    for (size_t k = 0; k < from->n_segments; k++) degree = from->degree[k] > degree ? from->degree[k] : degree;
  }
  int32_t *variables = calloc(moving + 1, sizeof *variables);
  double *rest = calloc(s->robot->n_variables + 1, sizeof *rest), *times = unite_times(joined, n, &count);
  size_t *segments = calloc(n + 1, sizeof *segments);
  motion_source all = *s;
  all.variables = variables, all.n = moving, all.rest = rest;
  cprox_motion *m = variables && rest && times && segments ? motion_allocate(&all, count - 1, degree) : NULL;
  cprox_status made;
  if (m && arcs > 0 && !motion_allocate_arcs(m, arcs)) {
    cprox_motion_free(m);
    m = NULL;
  }
  if (m) {
    number_variables(joined, n, variables, rest);
    memcpy(m->times, times, count * sizeof *times);
    fill(m, joined, n, segments);
    if (arcs > 0) fill_arcs(m, joined, n, segments);
    made = motion_finish(m, &all, motion);
  } else {
    made = workspace_fail(s->workspace, CPROX_MEMORY, "no memory to join %zu motions", n);
  }
  free(variables);
  free(rest);
  free(times);
  free(segments);
  return made;
}
