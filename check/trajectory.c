/* SPDX-License-Identifier: BSD-3-Clause */
#include "trajectory.h"

#include <stdlib.h>

#include "slerp.h"

enum { MAX_HALVINGS = 12, ROW = ROBOT_MAX_DEGREE + 1, MOST_ROWS = 1 << 22 };

/* Variables that are moved together: the Bézier points of each over each of their own segments. */
typedef struct source {
  size_t n, n_segments;
  size_t *variables; /* which */
  double *times;     /* n_segments + 1, on the clock of all */
  size_t *degrees;
  num *points;     /* [segment][n][ROW] */
  slerp_arc *arcs; /* [segment][axis]; NULL: nothing turns by slerp */
} source;

static num *row_of(const source *s, size_t segment, size_t k) {
  return s->points + (segment * s->n + k) * ROW;
}

static void make_room(words *w, source *s, size_t segments) {
  s->n_segments = segments;
  s->times = words_room(w, segments + 1, sizeof *s->times);
  s->degrees = words_room(w, segments, sizeof *s->degrees);
  s->points = words_room(w, segments * s->n * ROW, sizeof *s->points);
}

/* N and as many variables, none twice. */
static void read_variables(words *w, robot *r, source *s) {
  s->n = words_count(w);
  s->variables = words_room(w, s->n, sizeof *s->variables);
  for (size_t k = 0; k < s->n && !w->wrong; k++) {
    s->variables[k] = words_size(w);
    if (s->variables[k] >= r->n_variables || r->moved[s->variables[k]])
      w->wrong = true;
    else
      r->moved[s->variables[k]] = true;
  }
}

/* ---- waypoints ---- */

/* One line: at TIME ORDERS, then positions, with 2 orders velocities, with 3 accelerations. */
typedef struct waypoint {
  double time;
  size_t orders;
  double *values;
} waypoint;

static void read_waypoint(words *w, size_t n, waypoint *p) {
  p->time = words_number(w);
  p->orders = words_size(w);
  if (p->orders < 1 || p->orders > 3) w->wrong = true;
  p->values = words_room(w, 3 * n, sizeof *p->values);
  if (!w->wrong) words_numbers(w, p->orders * n, p->values);
}

static num fraction(num a, double b) {
  return num_div(a, num_of(b));
}

/* Degree 1, 3 or 5 by what both ends know: the Bézier points of Hermite's polynomial. */
static void hermite(const waypoint *p, const waypoint *q, size_t n, size_t k, size_t degree, num *c) {
  const num h = num_sub(num_of(q->time), num_of(p->time)), d = num_of((double)degree);
  c[0] = num_of(p->values[k]), c[degree] = num_of(q->values[k]);
  if (degree == 1) return;
  const num v0 = num_div(num_mul(h, num_of(p->values[n + k])), d),
            v1 = num_div(num_mul(h, num_of(q->values[n + k])), d);
  c[1] = num_add(c[0], v0), c[degree - 1] = num_sub(c[degree], v1);
  if (degree == 3) return;
  const num hh = num_mul(h, h);
  const num a0 = fraction(num_mul(hh, num_of(p->values[2 * n + k])), 20.0);
  const num a1 = fraction(num_mul(hh, num_of(q->values[2 * n + k])), 20.0);
  c[2] = num_add(num_add(num_add(c[0], v0), v0), a0), c[3] = num_add(num_sub(num_sub(c[5], v1), v1), a1);
}

/* The lower of the two orders counts, and the interpolation's where it is one: linear, cubic, quintic. */
static void join_waypoints(words *w, source *s, const waypoint *points, size_t n_points, size_t order) {
  make_room(w, s, n_points - 1);
  for (size_t i = 0; i + 1 < n_points && !w->wrong; i++) {
    const waypoint *p = &points[i], *q = p + 1;
    const size_t both = p->orders < q->orders ? p->orders : q->orders, known = order ? order : both;
    if (!(p->time < q->time) || known > both) w->wrong = true;
    if (w->wrong) break;
    s->times[i] = p->time, s->times[i + 1] = q->time;
    s->degrees[i] = 2 * known - 1;
    for (size_t k = 0; k < s->n; k++) hermite(p, q, s->n, k, s->degrees[i], row_of(s, i, k));
  }
}

/* waypoints ORDER N variable×N POINTS, then a line a point. ORDER: 0: what both ends of a segment know; 1, 2, 3. */
static bool read_waypoints(problem *p, words *w, robot *r, source *s) {
  const size_t order = words_size(w);
  read_variables(w, r, s);
  const size_t n_points = words_size(w);
  if (order > 3 || n_points < 2) w->wrong = true;
  if (!words_end(p, w)) return false;
  waypoint *points = words_room(w, n_points, sizeof *points);
  bool good = !w->wrong;
  for (size_t i = 0; i < n_points && good; i++) {
    if (words_begin(p, w, "at")) read_waypoint(w, s->n, &points[i]);
    if (i + 1 == n_points && !w->wrong) join_waypoints(w, s, points, n_points, order);
    good = words_end(p, w);
  }
  for (size_t i = 0; points && i < n_points; i++) free(points[i].values);
  free(points);
  return good;
}

/* ---- B-splines ---- */

/* The Bézier points of the span [knot r, knot r + 1]: blossoms at its ends, by de Boor. */
static void blossom(const double *control, size_t n, const double *knots, size_t degree, size_t r, num *c) {
  for (size_t i = 0; i <= degree; i++) {
    num d[ROBOT_MAX_DEGREE + 1];
    for (size_t j = 0; j <= degree; j++) d[j] = num_of(control[(r - degree + j) * n]);
    for (size_t level = 1; level <= degree; level++) {
      const num x = num_of(level <= i ? knots[r + 1] : knots[r]);
      for (size_t j = 0; j + level <= degree; j++) {
        const num low = num_of(knots[r - degree + j + level]), high = num_of(knots[r + 1 + j]);
        const num s = num_div(num_sub(x, low), num_sub(high, low));
        d[j] = num_add(d[j], num_mul(s, num_sub(d[j + 1], d[j])));
      }
    }
    c[i] = d[0];
  }
}

/* bspline DEGREE N variable×N POINTS, then "knots" and POINTS + DEGREE + 1 of them, and a line "control" with N values
 * a point. */
static bool read_spline(problem *p, words *w, robot *r, source *s) {
  const size_t degree = words_size(w);
  read_variables(w, r, s);
  const size_t n = words_size(w);
  if (degree < 1 || degree > ROBOT_MAX_DEGREE || n <= degree) w->wrong = true;
  if (!words_end(p, w)) return false;
  double *knots = words_room(w, n + degree + 1, sizeof *knots), *control = words_room(w, n * s->n, sizeof *control);
  if (words_begin(p, w, "knots")) words_numbers(w, n + degree + 1, knots);
  for (size_t i = 1; i < n + degree + 1 && !w->wrong; i++)
    if (!(knots[i - 1] <= knots[i]) || (i > degree && i < n && knots[i] == knots[i - degree])) w->wrong = true;
  bool good = words_end(p, w);
  for (size_t i = 0; i < n && good; i++) {
    if (words_begin(p, w, "control")) words_numbers(w, s->n, control + i * s->n);
    good = words_end(p, w);
  }

  size_t segments = 0;
  for (size_t i = degree; i < n && good; i++) segments += knots[i] < knots[i + 1];
  if (good && segments == 0) w->wrong = true;
  if (good) make_room(w, s, segments);
  segments = 0;
  for (size_t i = degree; i < n && good && !w->wrong; i++) {
    if (!(knots[i] < knots[i + 1])) continue;
    s->times[segments] = knots[i], s->times[segments + 1] = knots[i + 1];
    s->degrees[segments] = degree;
    for (size_t k = 0; k < s->n; k++) blossom(control + k, s->n, knots, degree, i, row_of(s, segments, k));
    segments++;
  }
  if (good && w->wrong && !w->starved)
    snprintf(p->fault, sizeof p->fault, "the motion that ends in line %zu takes no time", p->number);
  free(knots);
  free(control);
  return good && !w->wrong;
}

/* ---- quaternions ---- */

void trajectory_halve(num *points, size_t degree, num *left) {
  for (size_t level = 0; level <= degree; level++) {
    left[level] = points[0];
    for (size_t i = 0; i + level < degree; i++) {
      const num sum = num_add(points[i], points[i + 1]);
      points[i] = (num){0.5 * sum.m, GROW(0.5 * sum.e)};
    }
  }
}

/* The least length over an interval: halves, until the ball round the point in the middle that holds all Bézier points
 * does not reach half way to 0. */
static double least_length(num c[4][ROBOT_MAX_DEGREE + 1], size_t degree, int halvings) {
  num left[4][ROBOT_MAX_DEGREE + 1], all[4][ROBOT_MAX_DEGREE + 1];
  double square = 0.0, off = 0.0, spread = 0.0;
  for (int k = 0; k < 4; k++) {
    for (size_t i = 0; i <= degree; i++) all[k][i] = c[k][i];
    trajectory_halve(c[k], degree, left[k]);
    square += c[k][0].m * c[k][0].m;
    off += c[k][0].e;
  }
  for (size_t i = 0; i <= degree; i++) {
    double d = 0.0, e = 0.0;
    for (int k = 0; k < 4; k++) {
      d += (all[k][i].m - c[k][0].m) * (all[k][i].m - c[k][0].m);
      e += all[k][i].e;
    }
    spread = fmax(spread, GROW(sqrt(d) + e));
  }
  const double length = sqrt(square), least = (1.0 - 0x1p-46) * length - GROW(off + spread + 0x1p-46 * spread);
  if (least >= 0.5 * length && length > 0.0) return least;
  if (halvings == 0) return 0.0;
  return fmin(least_length(left, degree, halvings - 1), least_length(c, degree, halvings - 1));
}

static double least_of_axis(const robot *r, const axis *a) {
  double least = INFINITY;
  for (size_t segment = 0; segment < r->n_segments; segment++) {
    num c[4][ROBOT_MAX_DEGREE + 1];
    for (size_t k = 0; k < 4; k++)
      for (size_t i = 0; i <= r->degrees[segment]; i++)
        c[k][i] =
            r->moved[a->variable + k] ? robot_points(r, segment, a->variable + k)[i] : num_of(r->rest[a->variable + k]);
    least = fmin(least, least_length(c, r->degrees[segment], MAX_HALVINGS));
  }
  return least;
}

/* ---- slerp ---- */

/* Of the source's rows those of the quaternion's numbers; false where it moves none of them. All four must be moved, and
 * nothing else by their variables. */
static bool find_quaternion(const robot *r, const source *s, const axis *a, size_t rows[4], words *w) {
  size_t n = 0;
  for (size_t k = 0; k < s->n; k++)
    if (s->variables[k] >= a->variable && s->variables[k] < a->variable + 4)
      rows[s->variables[k] - a->variable] = k, n++;
  for (size_t j = 0; j < r->n_axes && n > 0; j++) {
    const axis *b = &r->axes[j];
    const bool is_line = b->kind == AXIS_TURN || b->kind == AXIS_SHIFT;
    const size_t last = b->variable + (is_line ? 0 : 3);
    if ((is_line || b->variable != a->variable) && b->variable <= a->variable + 3 && last >= a->variable)
      w->wrong = true;
  }
  if (n > 0 && n < 4) w->wrong = true;
  return n > 0 && !w->wrong;
}

/* The angle takes the place of a quaternion's first number. */
static void read_arcs(words *w, robot *r, source *s) {
  if (w->wrong || r->n_axes == 0) return;
  if (s->n_segments > MOST_ROWS / r->n_axes) w->wrong = true;
  s->arcs = words_room(w, s->n_segments * r->n_axes, sizeof *s->arcs);
  for (size_t i = 0; i < r->n_axes && !w->wrong; i++) {
    size_t rows[4];
    if (r->axes[i].kind != AXIS_QUATERNION || !find_quaternion(r, s, &r->axes[i], rows, w)) continue;
    for (size_t segment = 0; segment < s->n_segments && !w->wrong; segment++) {
      const size_t degree = s->degrees[segment];
      num p[4], q[4];
      for (int k = 0; k < 4; k++) p[k] = row_of(s, segment, rows[k])[0], q[k] = row_of(s, segment, rows[k])[degree];
      if (!slerp_between(p, q, &s->arcs[segment * r->n_axes + i])) w->wrong = true;
    }
  }
  for (size_t i = 0; i < r->n_axes && !w->wrong; i++) {
    size_t rows[4];
    axis *a = &r->axes[i];
    if (a->kind != AXIS_QUATERNION || !find_quaternion(r, s, a, rows, w)) continue;
    a->kind = AXIS_ARC;
    a->multiplier = 1.0;
    for (size_t segment = 0; segment < s->n_segments; segment++)
      for (size_t k = 0; k <= s->degrees[segment]; k++) {
        const num part = fraction(num_of((double)k), (double)s->degrees[segment]);
        row_of(s, segment, rows[0])[k] = num_mul(part, s->arcs[segment * r->n_axes + i].angle);
      }
  }
}

/* ---- one clock ---- */

/* The polynomial over [a, b]: blossoms, i times of b. */
static void cut(const num *c, size_t degree, num a, num b, num *out) {
  for (size_t i = 0; i <= degree; i++) {
    num d[ROW];
    for (size_t j = 0; j <= degree; j++) d[j] = c[j];
    for (size_t level = 1; level <= degree; level++)
      for (size_t j = 0; j + level <= degree; j++)
        d[j] = num_add(d[j], num_mul(level <= i ? b : a, num_sub(d[j + 1], d[j])));
    out[i] = d[0];
  }
}

/* The same polynomial with more points. */
static void elevate(num *c, size_t degree, size_t wanted) {
  for (size_t n = degree + 1; n <= wanted; n++) {
    c[n] = c[n - 1];
    for (size_t i = n - 1; i > 0; i--)
      c[i] = num_add(c[i], num_mul(fraction(num_of((double)i), (double)n), num_sub(c[i - 1], c[i])));
  }
}

/* What the source does over a segment of the clock: before it begins and after it has ended it stands. `own` is its own
 * segment there. */
static void fill_segment(robot *r, const source *s, size_t segment, size_t own) {
  const double begin = s->times[own], end = s->times[own + 1], from = r->times[segment], to = r->times[segment + 1];
  const num length = num_sub(num_of(end), num_of(begin));
  num a = num_div(num_sub(num_of(from), num_of(begin)), length),
      b = num_div(num_sub(num_of(to), num_of(begin)), length);
  if (from <= begin) a = num_of(0.0);
  if (to <= begin) b = num_of(0.0);
  if (from >= end) a = num_of(1.0);
  if (to >= end) b = num_of(1.0);
  const size_t degree = s->degrees[own];
  for (size_t k = 0; k < s->n; k++) {
    num *out = r->points + (segment * r->n_variables + s->variables[k]) * ROW;
    const num *c = row_of(s, own, k);
    for (size_t i = 0; i <= degree; i++) out[i] = c[i];
    if (from != begin || to != end) cut(c, degree, a, b, out);
    elevate(out, degree, r->degrees[segment]);
  }
  for (size_t i = 0; i < r->n_axes && s->arcs; i++)
    if (s->arcs[own * r->n_axes + i].used) r->arcs[segment * r->n_axes + i] = s->arcs[own * r->n_axes + i];
}

static int ascending(const void *a, const void *b) {
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

/* Segments end wherever one of a source does. */
static void join_sources(words *w, robot *r, const source *sources, size_t n) {
  size_t all = 0, count = 0;
  for (size_t i = 0; i < n; i++) all += sources[i].n_segments + 1;
  double *times = r->times = words_room(w, all, sizeof *r->times);
  for (size_t i = 0; i < n && !w->wrong; i++)
    for (size_t k = 0; k <= sources[i].n_segments; k++) times[count++] = sources[i].times[k];
  if (w->wrong) return;
  qsort(times, all, sizeof *times, ascending);
  count = 0;
  for (size_t i = 0; i < all; i++)
    if (count == 0 || times[i] > times[count - 1]) times[count++] = times[i];
  if (count < 2 || (n > 1 && count > MOST_ROWS / (r->n_variables + r->n_axes + 1))) w->wrong = true;
  if (w->wrong) return;
  r->n_segments = count - 1;
  r->degrees = words_room(w, r->n_segments, sizeof *r->degrees);
  r->points = words_room(w, r->n_segments * r->n_variables * ROW, sizeof *r->points);
  r->arcs = words_room(w, r->n_segments * r->n_axes, sizeof *r->arcs);
  for (int pass = 0; pass < 2 && !w->wrong; pass++)
    for (size_t i = 0; i < n; i++) {
      size_t own = 0;
      for (size_t k = 0; k < r->n_segments; k++) {
        while (own + 1 < sources[i].n_segments && sources[i].times[own + 1] <= times[k]) own++;
        if (pass == 1) fill_segment(r, &sources[i], k, own);
        if (sources[i].degrees[own] > r->degrees[k]) r->degrees[k] = sources[i].degrees[own];
      }
    }
}

/* ---- the whole ---- */

static void find_what_moves(robot *r) {
  for (size_t i = 0; i < r->n_axes; i++) {
    axis *a = &r->axes[i];
    const bool ball = a->kind == AXIS_QUATERNION;
    for (size_t k = 0; k < (ball ? 4u : 1u); k++) a->moves = a->moves || r->moved[a->variable + k];
    if (ball) a->least = least_of_axis(r, a);
  }
}

/* Waypoints, a B-spline, or waypoints between which floating joints turn by slerp; times are later by `start`. */
static bool read_source(problem *p, words *w, robot *r, size_t which, double start, source *s) {
  const bool good = which == 1 ? read_spline(p, w, r, s) : read_waypoints(p, w, r, s);
  if (!good) return false;
  if (which == 2) read_arcs(w, r, s);
  for (size_t i = 0; i <= s->n_segments; i++) {
    s->times[i] += start;
    if (i > 0 && !(s->times[i - 1] < s->times[i])) w->wrong = true;
  }
  if (w->wrong && !w->starved)
    snprintf(p->fault, sizeof p->fault, "the motion that ends in line %zu turns or starts as none can", p->number);
  return !w->wrong;
}

/* joined N, then N times "start TIME" and another motion. */
static bool read_sources(problem *p, words *w, robot *r, source **sources, size_t *n) {
  static const char *const names[] = {"waypoints", "bspline", "slerp", "joined"};
  if (!words_begin(p, w, "motion")) return false;
  const size_t which = words_choose(w, names, 4);
  *n = which == 3 ? words_size(w) : 1;
  if (*n < 1 || *n > r->n_links + 1) w->wrong = true;
  *sources = words_room(w, *n, sizeof **sources);
  if (which < 3) return !w->wrong && read_source(p, w, r, which, 0.0, *sources);
  bool good = words_end(p, w);
  for (size_t i = 0; i < *n && good; i++) {
    double start = 0.0;
    if (words_begin(p, w, "start")) start = words_number(w);
    good = words_end(p, w) && words_begin(p, w, "motion");
    const size_t one = words_choose(w, names, 3);
    good = good && !w->wrong && read_source(p, w, r, one, start, *sources + i);
  }
  return good;
}

bool trajectory_read(problem *p, words *w, robot *r) {
  source *sources = NULL;
  size_t n = 0;
  bool good = read_sources(p, w, r, &sources, &n);
  if (!p->fault[0] && !good) words_end(p, w);
  if (good) join_sources(w, r, sources, n);
  if (good && w->wrong && !w->starved)
    snprintf(p->fault, sizeof p->fault, "the motions that end in line %zu have too many segments", p->number);
  for (size_t i = 0; sources && i < n; i++) {
    free(sources[i].variables);
    free(sources[i].times);
    free(sources[i].degrees);
    free(sources[i].points);
    free(sources[i].arcs);
  }
  free(sources);
  if (!good || w->wrong) return false;
  find_what_moves(r);
  return true;
}
