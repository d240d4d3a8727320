/* SPDX-License-Identifier: BSD-3-Clause */
#include "trajectory.h"

#include <stdlib.h>

enum { MAX_HALVINGS = 12 };

/* What both kinds of motion have. */
typedef struct source {
  robot *robot;
  size_t n;          /* variables that are moved */
  size_t *variables; /* which */
} source;

static num *row_of(const source *s, size_t segment, size_t k) {
  return s->robot->points + (segment * s->robot->n_variables + s->variables[k]) * (ROBOT_MAX_DEGREE + 1);
}

static void make_room(words *w, robot *r, size_t segments) {
  r->n_segments = segments;
  r->times = words_room(w, segments + 1, sizeof *r->times);
  r->degrees = words_room(w, segments, sizeof *r->degrees);
  r->points = words_room(w, segments * r->n_variables * (ROBOT_MAX_DEGREE + 1), sizeof *r->points);
}

/* N and as many variables, none twice. */
static void read_variables(words *w, source *s) {
  s->n = words_count(w);
  s->variables = words_room(w, s->n, sizeof *s->variables);
  for (size_t k = 0; k < s->n && !w->wrong; k++) {
    s->variables[k] = words_size(w);
    if (s->variables[k] >= s->robot->n_variables || s->robot->moved[s->variables[k]])
      w->wrong = true;
    else
      s->robot->moved[s->variables[k]] = true;
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
static void join_waypoints(words *w, const source *s, const waypoint *points, size_t n_points, size_t order) {
  robot *r = s->robot;
  make_room(w, r, n_points - 1);
  for (size_t i = 0; i + 1 < n_points && !w->wrong; i++) {
    const waypoint *p = &points[i], *q = p + 1;
    const size_t both = p->orders < q->orders ? p->orders : q->orders, known = order ? order : both;
    if (!(p->time < q->time) || known > both) w->wrong = true;
    if (w->wrong) break;
    r->times[i] = p->time, r->times[i + 1] = q->time;
    r->degrees[i] = 2 * known - 1;
    for (size_t k = 0; k < s->n; k++) hermite(p, q, s->n, k, r->degrees[i], row_of(s, i, k));
  }
}

/* waypoints ORDER N variable×N POINTS, then a line a point. ORDER: 0: what both ends of a segment know; 1, 2, 3. */
static bool read_waypoints(problem *p, words *w, source *s) {
  const size_t order = words_size(w);
  read_variables(w, s);
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
static bool read_spline(problem *p, words *w, source *s) {
  robot *r = s->robot;
  const size_t degree = words_size(w);
  read_variables(w, s);
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
  if (good) make_room(w, r, segments);
  segments = 0;
  for (size_t i = degree; i < n && good && !w->wrong; i++) {
    if (!(knots[i] < knots[i + 1])) continue;
    r->times[segments] = knots[i], r->times[segments + 1] = knots[i + 1];
    r->degrees[segments] = degree;
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

/* ---- the whole ---- */

static void find_what_moves(robot *r) {
  for (size_t i = 0; i < r->n_axes; i++) {
    axis *a = &r->axes[i];
    const bool ball = a->kind == AXIS_QUATERNION;
    for (size_t k = 0; k < (ball ? 4u : 1u); k++) a->moves = a->moves || r->moved[a->variable + k];
    if (ball) a->least = least_of_axis(r, a);
  }
}

bool trajectory_read(problem *p, words *w, robot *r) {
  static const char *const names[] = {"waypoints", "bspline"};
  source s = {.robot = r};
  bool good = false;
  if (words_begin(p, w, "motion"))
    good = words_choose(w, names, 2) == 0 ? read_waypoints(p, w, &s) : read_spline(p, w, &s);
  if (!p->fault[0] && !good) words_end(p, w);
  free(s.variables);
  if (good) find_what_moves(r);
  return good;
}
