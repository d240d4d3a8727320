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

/* It may be anywhere on its path at any time. */
static bool is_anywhere(const cprox_joined_motion *one) {
  return isinf(one->tolerance);
}

static cprox_status no_memory(size_t n, cprox_workspace *workspace) {
  return workspace_fail(workspace, CPROX_MEMORY, "no memory to join %zu motions", n);
}

/* ---- checks ---- */

static cprox_status check_times(const cprox_joined_motion *one, size_t i, cprox_workspace *workspace) {
  if (!isfinite(one->start))
    return workspace_fail(workspace, CPROX_INVALID, "motion %zu: its start is %g s", i, one->start);
  if (!(one->tolerance >= 0.0))
    return workspace_fail(workspace, CPROX_INVALID, "motion %zu: the tolerance of its start is %g s", i,
                          one->tolerance);
  for (size_t k = 0; k < one->motion->n_tracks; k++)
    if (one->motion->tracks[k].tolerance > 0.0)
      return workspace_fail(workspace, CPROX_INVALID, "motion %zu has a start with a tolerance: join all at once", i);
  for (size_t k = 0; k < one->motion->n_segments; k++)
    if (!(on_clock(one, k) < on_clock(one, k + 1)))
      return workspace_fail(
          workspace, CPROX_INVALID,
          "motion %zu: its start at %.15g s is so large that its times %.15g s and %.15g s become one", i, one->start,
          one->motion->times[k], one->motion->times[k + 1]);
  return CPROX_OK;
}

/* From when to when a motion may go on. */
typedef struct clock_range {
  double begin, end;
  size_t motion;
} clock_range;

static int compare_begins(const void *a, const void *b) {
  const double x = ((const clock_range *)a)->begin, y = ((const clock_range *)b)->begin;
  return (x > y) - (x < y);
}

/* Nothing may happen only after everything else has ended. */
static cprox_status check_overlap(const cprox_joined_motion *joined, size_t n, cprox_workspace *workspace) {
  clock_range *ranges = malloc((n + 1) * sizeof *ranges);
  if (!ranges) return no_memory(n, workspace);
  size_t count = 0;
  for (size_t i = 0; i < n; i++) {
    const cprox_joined_motion *one = &joined[i];
    if (!one->motion->is_state && !is_anywhere(one))
      ranges[count++] = (clock_range){begin_of(one) - one->tolerance, end_of(one) + one->tolerance, i};
  }
  qsort(ranges, count, sizeof *ranges, compare_begins);
  cprox_status status = CPROX_OK;
  double before = INFINITY; /* the last end of those that begin earlier */
  for (size_t i = 0; i < count && status == CPROX_OK; i++) {
    const clock_range *one = &ranges[i];
    if (before < one->begin)
      status = workspace_fail(workspace, CPROX_INVALID,
                              "the clocks do not overlap: motion %zu begins at %.15g s, %.3g s after all earlier ones "
                              "have ended",
                              one->motion, one->begin, one->begin - before);
    before = i == 0 ? one->end : fmax(before, one->end);
  }
  free(ranges);
  return status;
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

/* The first start and the last end, whenever motions with a tolerance begin. Those that may be anywhere take as long as
 * they need, and count where nothing else moves. */
static clock_range range_of_all(const cprox_joined_motion *joined, size_t n) {
  clock_range all = {.begin = INFINITY, .end = -INFINITY};
  double anywhere = INFINITY;
  for (size_t i = 0; i < n; i++) {
    const cprox_joined_motion *one = &joined[i];
    if (one->motion->is_state) continue;
    if (is_anywhere(one)) {
      anywhere = fmin(anywhere, begin_of(one));
      continue;
    }
    all.begin = fmin(all.begin, begin_of(one) - one->tolerance);
    all.end = fmax(all.end, end_of(one) + one->tolerance);
  }
  if (!isfinite(all.begin)) all.begin = anywhere;
  for (size_t i = 0; i < n; i++)
    if (!joined[i].motion->is_state && is_anywhere(&joined[i]))
      all.end = fmax(all.end, all.begin + (end_of(&joined[i]) - begin_of(&joined[i])));
  return all;
}

/* What may be anywhere begins with the clock, as much earlier or later as all of that. NULL where memory is out. */
static cprox_joined_motion *settle_starts(const motion_source *s, const clock_range *all) {
  const size_t n = s->description->n_joined;
  cprox_joined_motion *joined = malloc((n + 1) * sizeof *joined);
  if (!joined) return NULL;
  memcpy(joined, s->description->joined, n * sizeof *joined);
  for (size_t i = 0; i < n; i++)
    if (!joined[i].motion->is_state && is_anywhere(&joined[i]))
      joined[i].start = all->begin - joined[i].motion->times[0], joined[i].tolerance = all->end - all->begin;
  return joined;
}

/* The ends of all segments and of the whole, ascending, none twice; *count of them. NULL where memory is out. */
static double *unite_times(const cprox_joined_motion *joined, size_t n, const clock_range *whole, size_t *count) {
  size_t most = 2, all = 0;
  for (size_t i = 0; i < n; i++) most += joined[i].motion->n_segments + 1;
  double *times = malloc((most + 1) * sizeof *times);
  if (!times) return NULL;
  for (size_t i = 0; i < n; i++)
    for (size_t k = 0; k <= joined[i].motion->n_segments && !joined[i].motion->is_state; k++)
      times[all++] = on_clock(&joined[i], k);
  times[all++] = whole->begin, times[all++] = whole->end;
  qsort(times, all, sizeof *times, compare_times);
  *count = 0;
  for (size_t i = 0; i < all; i++)
    if (i == 0 || times[i] > times[*count - 1]) times[(*count)++] = times[i];
  return times;
}

/* ---- tracks ---- */

static double largest_of(const double *c, size_t degree) {
  double largest = 0.0;
  for (size_t i = 0; i <= degree; i++) largest = fmax(largest, fabs(c[i]));
  return largest;
}

/* A segment over which everything stands as it does where the track begins, or ends. */
static void stand(motion_track *t, size_t segment, const motion_track *from, bool at_end) {
  const size_t source = at_end ? from->n_segments - 1 : 0, degree = from->degree[source];
  t->degree[segment] = 1;
  for (size_t k = 0; k < t->n_moving; k++) {
    const size_t at = segment * t->n_moving + k, of = source * from->n_moving + k;
    const double value = from->coefficients[of * from->stride + (at_end ? degree : 0)];
    t->coefficients[at * t->stride] = t->coefficients[at * t->stride + 1] = value;
    t->error[at] = from->error[of] + motion_cutting_error(1, fabs(value));
  }
  for (size_t j = 0; j < t->n_arcs; j++) {
    motion_arc *arc = &t->arcs[j * t->n_segments + segment];
    *arc = from->arcs[j * from->n_segments + source];
    arc->from = arc->to = at_end ? arc->to : arc->from;
  }
}

/* The places of a track that places on the clock stand for are off by a few roundings, which costs as much as cutting
 * there does. */
static void copy_segments(motion_track *t, size_t first, const motion_track *from) {
  const size_t n = t->n_moving;
  for (size_t i = 0; i < from->n_segments; i++) {
    t->degree[first + i] = from->degree[i];
    for (size_t k = 0; k < n; k++) {
      const double *c = from->coefficients + (i * n + k) * from->stride;
      const size_t at = (first + i) * n + k;
      memcpy(t->coefficients + at * t->stride, c, (from->degree[i] + 1u) * sizeof *c);
      t->error[at] = from->error[i * n + k] + motion_cutting_error(from->degree[i], largest_of(c, from->degree[i]));
    }
    for (size_t j = 0; j < t->n_arcs; j++)
      t->arcs[j * t->n_segments + first + i] = from->arcs[j * from->n_segments + i];
  }
}

/* One track over the whole clock: before it begins and after it has ended everything of it stands. `variable` and
 * `axis` are the first ones of its robot. */
static bool copy_track(const cprox_motion *m, const motion_track *from, double start, size_t variable, size_t axis,
                       motion_track *t) {
  const double begin = m->times[0], end = m->times[m->n_segments];
  const size_t before = from->times[0] + start > begin, after = from->times[from->n_segments] + start < end;
  const size_t n = from->n_segments + before + after;
  if (!motion_allocate_track(t, n, from->n_moving, from->stride - 1)) return false;
  if (from->n_arcs > 0 && !motion_allocate_track_arcs(t, from->n_arcs)) return false;
  for (size_t k = 0; k < from->n_moving; k++) t->moving[k] = (int32_t)variable + from->moving[k];
  for (size_t k = 0; k < from->n_arcs; k++) t->arc_axes[k] = (int32_t)axis + from->arc_axes[k];
  t->times[0] = begin, t->times[n] = end;
  for (size_t i = 0; i <= from->n_segments; i++) t->times[before + i] = from->times[i] + start;
  if (before) stand(t, 0, from, false);
  copy_segments(t, before, from);
  if (after) stand(t, n - 1, from, true);
  t->stands_first = before, t->stands_last = after;
  return true;
}

/* ---- the whole ---- */

/* What is known of the variables and axes of one motion, whose robot's begin with these; its first track is `track`. */
static void copy_robot(cprox_motion *m, const cprox_motion *from, size_t variable, size_t axis, size_t track) {
  const cprox_robot *robot = from->robot;
  memcpy(m->rest + variable, from->rest, robot->n_variables * sizeof *m->rest);
  for (size_t k = 0; k < robot->n_variables; k++) {
    m->slot[variable + k] = -1;
    if (!from->is_state) m->track_of[variable + k] = (int32_t)track + from->track_of[k];
  }
  for (size_t i = 0; i < robot->n_axes && from->arc_of; i++)
    if (from->robot->axes[i].kind == AXIS_BALL) m->arc_of[axis + i] = from->arc_of[i];
}

/* Whether certificates know a motion, so joined. */
static bool is_source(const cprox_joined_motion *one) {
  return one->motion->is_state ||
         (one->tolerance == 0.0 && one->motion->given.times && motion_is_described(one->motion));
}

/* False where memory is out. */
static bool copy_sources(cprox_motion *m, const cprox_joined_motion *joined) {
  for (size_t i = 0; i < m->n_joined; i++)
    if (!is_source(&joined[i])) return true;
  m->sources = calloc(m->n_joined > 0 ? m->n_joined : 1, sizeof *m->sources);
  size_t variable = 0;
  for (size_t i = 0; i < m->n_joined && m->sources; i++) {
    const cprox_motion *from = joined[i].motion;
    if (!from->is_state && !motion_keep_joined(&m->sources[i], &from->given, (int32_t)variable, joined[i].start))
      return false;
    variable += from->robot->n_variables;
  }
  return m->sources;
}

static bool copy_motions(cprox_motion *m, const motion_source *s, const cprox_joined_motion *joined) {
  size_t variable = 0, axis = 0, track = 0, slot = 0;
  for (size_t i = 0; i < s->description->n_joined; i++) {
    const cprox_joined_motion *one = &joined[i];
    const cprox_motion *from = one->motion;
    copy_robot(m, from, variable, axis, track);
    if (!from->is_state && !from->arc_of && !motion_keep_points(&m->joined[i], &from->given, (int32_t)variable))
      return false;
    for (size_t k = 0; k < from->n_tracks && !from->is_state; k++, track++) {
      motion_track *t = &m->tracks[track];
      if (workspace_stops(s->workspace) || !copy_track(m, &from->tracks[k], one->start, variable, axis, t))
        return false;
      t->by_time = m->n_tracks > 1;
      t->clock = (int32_t)i, t->tolerance = one->tolerance;
      t->first_slot = slot;
      for (size_t j = 0; j < t->n_moving; j++) m->slot[t->moving[j]] = (int32_t)(slot + j);
      slot += (t->n_moving + MOTION_LANES - 1) / MOTION_LANES * MOTION_LANES;
    }
    variable += from->robot->n_variables, axis += from->robot->n_axes;
  }
  return true;
}

static cprox_motion *make_joined(const motion_source *s, const clock_range *whole, const cprox_joined_motion *joined) {
  const size_t n = s->description->n_joined;
  size_t tracks = 0, arcs = 0, count = 0;
  for (size_t i = 0; i < n; i++) {
    const cprox_motion *from = joined[i].motion;
    tracks += from->is_state ? 0 : from->n_tracks;
    arcs += from->arc_of != NULL;
  }
  double *times = unite_times(joined, n, whole, &count);
  cprox_motion *m = times ? motion_allocate(s, tracks) : NULL;
  if (!m) free(times);
  if (m) m->times = times, m->n_segments = count - 1;
  if (m && (m->joined = calloc(n, sizeof *m->joined))) m->n_joined = n;
  if (m && m->joined && (arcs == 0 || motion_allocate_arcs(m)) && copy_sources(m, joined) && copy_motions(m, s, joined))
    return m;
  cprox_motion_free(m);
  return NULL;
}

cprox_status motion_create_joined(const motion_source *s, cprox_motion **motion) {
  const cprox_status status = check_joined(s);
  if (status != CPROX_OK) return status;
  const size_t n = s->description->n_joined;
  const clock_range whole = range_of_all(s->description->joined, n);
  cprox_joined_motion *joined = settle_starts(s, &whole);
  cprox_motion *m = joined ? make_joined(s, &whole, joined) : NULL;
  free(joined);
  if (m) return motion_finish(m, s, motion);
  if (workspace_has_stopped(s->workspace))
    return workspace_fail(s->workspace, CPROX_INVALID, "stopped while %zu motions were being joined", n);
  return no_memory(n, s->workspace);
}
