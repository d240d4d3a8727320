/* SPDX-License-Identifier: BSD-3-Clause */
#include "peers/cone_growth.h"

#include <math.h>
#include <string.h>

/* Of the four unknowns x and s. A body has at most 6 rows of the half-line, or two and a cone of 3, or a cone of 4. */
enum { UNKNOWNS = 4, MOST_ROWS = 12, MOST_CONES = 2, MOST_STEPS = 50 };

/* Of the residuals and the gap. Forms of cones that are nearly 0 cancel: 1e-8 is not reached in a third of random places. */
static const double TOLERANCE = 1e-6;

/* minimise s: h - G z in the product of half-lines (the first n_lines rows) and second-order cones. */
typedef struct program {
  int rows, n_lines, n_cones, first[MOST_CONES], size[MOST_CONES];
  double g[MOST_ROWS][UNKNOWNS], h[MOST_ROWS];
  bool of_b[MOST_ROWS];
} program;

/* Of the cone k: W is a multiple of 2 v v' - J, and so is its inverse. */
typedef struct scaling {
  double line[MOST_ROWS]; /* W of half-lines */
  double times[MOST_CONES], v[MOST_CONES][4];
} scaling;

static void rotation(const cprox_quat *q, double r[3][3]) {
  const double n = q->w * q->w + q->x * q->x + q->y * q->y + q->z * q->z, s = 2.0 / n;
  r[0][0] = 1 - s * (q->y * q->y + q->z * q->z), r[0][1] = s * (q->x * q->y - q->w * q->z),
  r[0][2] = s * (q->x * q->z + q->w * q->y);
  r[1][0] = s * (q->x * q->y + q->w * q->z), r[1][1] = 1 - s * (q->x * q->x + q->z * q->z),
  r[1][2] = s * (q->y * q->z - q->w * q->x);
  r[2][0] = s * (q->x * q->z - q->w * q->y), r[2][1] = s * (q->y * q->z + q->w * q->x),
  r[2][2] = 1 - s * (q->x * q->x + q->y * q->y);
}

/* The row  scale_s s + n·(x - c). */
static void add_row(program *p, double scale_s, const double n[3], const double c[3], bool of_b) {
  double *g = p->g[p->rows];
  for (int j = 0; j < 3; j++) g[j] = -n[j];
  g[3] = -scale_s;
  p->h[p->rows] = -(n[0] * c[0] + n[1] * c[1] + n[2] * c[2]);
  p->of_b[p->rows++] = of_b;
}

static void add_lines(program *p, const cone_body *body, const cprox_pose *pose, bool of_b) {
  double r[3][3];
  const double c[3] = {pose->position.x, pose->position.y, pose->position.z};
  rotation(&pose->orientation, r);
  for (int axis = body->kind == CONE_BOX ? 0 : 2; axis < 3 && body->kind != CONE_ELLIPSOID; axis++)
    for (int sign = -1; sign <= 1; sign += 2) {
      const double n[3] = {sign * r[0][axis], sign * r[1][axis], sign * r[2][axis]};
      add_row(p, body->kind == CONE_BOX ? body->size[axis] : body->size[1], n, c, of_b);
    }
}

static void add_cone(program *p, const cone_body *body, const cprox_pose *pose, bool of_b) {
  if (body->kind == CONE_BOX) return;
  double r[3][3];
  const double c[3] = {pose->position.x, pose->position.y, pose->position.z}, none[3] = {0, 0, 0};
  rotation(&pose->orientation, r);
  p->first[p->n_cones] = p->rows;
  p->size[p->n_cones++] = body->kind == CONE_CYLINDER ? 3 : 4;
  add_row(p, 1.0, none, c, of_b);
  for (int axis = 0; axis < (body->kind == CONE_CYLINDER ? 2 : 3); axis++) {
    const double by = 1.0 / body->size[body->kind == CONE_CYLINDER ? 0 : axis];
    const double n[3] = {by * r[0][axis], by * r[1][axis], by * r[2][axis]};
    add_row(p, 0.0, n, c, of_b);
  }
}

/* ---- cones ---- */

static double form(const double *u, int n) {
  double sum = 0.0;
  for (int i = 1; i < n; i++) sum += u[i] * u[i];
  const double norm = sqrt(sum);
  return (u[0] - norm) * (u[0] + norm);
}

static double dot(const double *u, const double *v, int n) {
  double sum = 0.0;
  for (int i = 0; i < n; i++) sum += u[i] * v[i];
  return sum;
}

static void scale_of(const program *p, const double *s, const double *z, scaling *w) {
  for (int i = 0; i < p->n_lines; i++) w->line[i] = sqrt(s[i] / z[i]);
  for (int k = 0; k < p->n_cones; k++) {
    const double *u = s + p->first[k], *v = z + p->first[k];
    const int n = p->size[k];
    const double us = sqrt(form(u, n)), vs = sqrt(form(v, n));
    const double gamma = sqrt(0.5 * (1.0 + dot(u, v, n) / (us * vs)));
    double mean[4] = {0};
    for (int i = 0; i < n; i++) mean[i] = (u[i] / us + (i ? -1.0 : 1.0) * v[i] / vs) / (2.0 * gamma);
    const double length = sqrt(2.0 * (mean[0] + 1.0));
    for (int i = 0; i < n; i++) w->v[k][i] = (mean[i] + (i ? 0.0 : 1.0)) / length;
    w->times[k] = sqrt(us / vs);
  }
}

/* out = W u, or its inverse. */
static void apply(const program *p, const scaling *w, bool inverse, const double *u, double *out) {
  for (int i = 0; i < p->n_lines; i++) out[i] = inverse ? u[i] / w->line[i] : u[i] * w->line[i];
  for (int k = 0; k < p->n_cones; k++) {
    const int at = p->first[k], n = p->size[k];
    double v[4];
    for (int i = 0; i < n; i++) v[i] = inverse && i ? -w->v[k][i] : w->v[k][i];
    const double along = 2.0 * dot(v, u + at, n), times = inverse ? 1.0 / w->times[k] : w->times[k];
    double result[4];
    for (int i = 0; i < n; i++) result[i] = times * (along * v[i] - (i ? -1.0 : 1.0) * u[at + i]);
    memcpy(out + at, result, (size_t)n * sizeof *result);
  }
}

/* The product of two vectors of each cone, and what times u is d. */
static void product(const program *p, const double *u, const double *v, double *out) {
  for (int i = 0; i < p->n_lines; i++) out[i] = u[i] * v[i];
  for (int k = 0; k < p->n_cones; k++) {
    const int at = p->first[k], n = p->size[k];
    const double first = dot(u + at, v + at, n);
    for (int i = 1; i < n; i++) out[at + i] = u[at] * v[at + i] + v[at] * u[at + i];
    out[at] = first;
  }
}

static void divide(const program *p, const double *u, const double *d, double *out) {
  for (int i = 0; i < p->n_lines; i++) out[i] = d[i] / u[i];
  for (int k = 0; k < p->n_cones; k++) {
    const int at = p->first[k], n = p->size[k];
    const double first = (u[at] * d[at] - dot(u + at + 1, d + at + 1, n - 1)) / form(u + at, n);
    for (int i = 1; i < n; i++) out[at + i] = (d[at + i] - first * u[at + i]) / u[at];
    out[at] = first;
  }
}

/* The largest step up to 1 along d that stays in the cones. */
static double room(const program *p, const double *u, const double *d) {
  double step = 1.0;
  for (int i = 0; i < p->n_lines; i++)
    if (d[i] < 0.0) step = fmin(step, -u[i] / d[i]);
  for (int k = 0; k < p->n_cones; k++) {
    const double *x = u + p->first[k], *y = d + p->first[k];
    const int n = p->size[k];
    double cross = x[0] * y[0];
    for (int i = 1; i < n; i++) cross -= x[i] * y[i];
    const double a = form(y, n), c = form(x, n), inside = cross * cross - a * c;
    if (y[0] < 0.0) step = fmin(step, -x[0] / y[0]);
    if (inside < 0.0) continue;
    /* a t² + 2 cross t + c = 0: the least root above 0 */
    const double q = -(cross + (cross < 0.0 ? -1.0 : 1.0) * sqrt(inside)), roots[2] = {q / a, c / q};
    for (int i = 0; i < 2; i++)
      if (roots[i] > 0.0) step = fmin(step, roots[i]);
  }
  return step;
}

/* ---- the method ---- */

static void times_g(const program *p, const double *x, double *out) {
  for (int i = 0; i < p->rows; i++) out[i] = dot(p->g[i], x, UNKNOWNS);
}

static void times_gt(const program *p, const double *u, double out[UNKNOWNS]) {
  for (int j = 0; j < UNKNOWNS; j++) {
    out[j] = 0.0;
    for (int i = 0; i < p->rows; i++) out[j] += p->g[i][j] * u[i];
  }
}

static bool cholesky(double m[UNKNOWNS][UNKNOWNS]) {
  for (int j = 0; j < UNKNOWNS; j++) {
    for (int i = j; i < UNKNOWNS; i++) {
      double sum = m[i][j];
      for (int k = 0; k < j; k++) sum -= m[i][k] * m[j][k];
      if (i == j && !(sum > 0.0)) return false;
      m[i][j] = i == j ? sqrt(sum) : sum / m[j][j];
    }
  }
  return true;
}

static void substitute(double m[UNKNOWNS][UNKNOWNS], double x[UNKNOWNS]) {
  for (int i = 0; i < UNKNOWNS; i++) {
    for (int k = 0; k < i; k++) x[i] -= m[i][k] * x[k];
    x[i] /= m[i][i];
  }
  for (int i = UNKNOWNS - 1; i >= 0; i--) {
    for (int k = i + 1; k < UNKNOWNS; k++) x[i] -= m[k][i] * x[k];
    x[i] /= m[i][i];
  }
}

/* G' W^-2 G, factored. */
static bool factor(const program *p, const scaling *w, double m[UNKNOWNS][UNKNOWNS]) {
  double column[UNKNOWNS][MOST_ROWS];
  for (int j = 0; j < UNKNOWNS; j++) {
    double g[MOST_ROWS];
    for (int i = 0; i < p->rows; i++) g[i] = p->g[i][j];
    apply(p, w, true, g, column[j]);
  }
  for (int i = 0; i < UNKNOWNS; i++)
    for (int j = 0; j < UNKNOWNS; j++) m[i][j] = dot(column[i], column[j], p->rows);
  return cholesky(m);
}

/* G' dz = bx,  G dx - W² dz = bz. */
static void solve(const program *p, const scaling *w, double m[UNKNOWNS][UNKNOWNS], const double bx[UNKNOWNS],
                  const double *bz, double dx[UNKNOWNS], double *dz) {
  double u[MOST_ROWS], back[UNKNOWNS];
  apply(p, w, true, bz, u), apply(p, w, true, u, u);
  times_gt(p, u, back);
  for (int j = 0; j < UNKNOWNS; j++) dx[j] = bx[j] + back[j];
  substitute(m, dx);
  times_g(p, dx, u);
  for (int i = 0; i < p->rows; i++) u[i] -= bz[i];
  apply(p, w, true, u, u), apply(p, w, true, u, dz);
}

static void unit(const program *p, double *e) {
  memset(e, 0, MOST_ROWS * sizeof *e);
  for (int i = 0; i < p->n_lines; i++) e[i] = 1.0;
  for (int k = 0; k < p->n_cones; k++) e[p->first[k]] = 1.0;
}

/* How far u is outside of the cones; below 0: inside by that. */
static double outside(const program *p, const double *u) {
  double most = -INFINITY;
  for (int i = 0; i < p->n_lines; i++) most = fmax(most, -u[i]);
  for (int k = 0; k < p->n_cones; k++) {
    const double *x = u + p->first[k];
    most = fmax(most, sqrt(fmax(dot(x + 1, x + 1, p->size[k] - 1), 0.0)) - x[0]);
  }
  return most;
}

static void shift_inside(const program *p, const double *e, double *u) {
  const double by = outside(p, u);
  for (int i = 0; by > -1e-3 && i < p->rows; i++) u[i] += (1.0 + fmax(by, 0.0)) * e[i];
}

cone_answer cone_growth(const cone_body *a, const cprox_pose *pose_a, const cone_body *b, const cprox_pose *pose_b) {
  static const double cost[UNKNOWNS] = {0, 0, 0, 1};
  program p = {0};
  add_lines(&p, a, pose_a, false), add_lines(&p, b, pose_b, true);
  p.n_lines = p.rows;
  add_cone(&p, a, pose_a, false), add_cone(&p, b, pose_b, true);

  double x[UNKNOWNS] = {0}, s[MOST_ROWS], z[MOST_ROWS] = {0}, e[MOST_ROWS];
  scaling w;
  double m[UNKNOWNS][UNKNOWNS];
  unit(&p, e);
  scale_of(&p, e, e, &w);
  cone_answer out = {.solved = false};
  if (!factor(&p, &w, m)) return out;
  const double nothing[UNKNOWNS] = {0}, minus[UNKNOWNS] = {0, 0, 0, -1}, none[MOST_ROWS] = {0};
  double unused[UNKNOWNS];
  solve(&p, &w, m, nothing, p.h, x, s);
  for (int i = 0; i < p.rows; i++) s[i] = -s[i];
  solve(&p, &w, m, minus, none, unused, z);
  shift_inside(&p, e, s), shift_inside(&p, e, z);
  const double degree = p.n_lines + p.n_cones;

  for (; out.steps < MOST_STEPS; out.steps++) {
    double rx[UNKNOWNS], rz[MOST_ROWS], gx[MOST_ROWS], most = 0.0;
    times_gt(&p, z, rx), times_g(&p, x, gx);
    for (int j = 0; j < UNKNOWNS; j++) rx[j] += cost[j], most = fmax(most, fabs(rx[j]));
    for (int i = 0; i < p.rows; i++) rz[i] = gx[i] + s[i] - p.h[i], most = fmax(most, fabs(rz[i]));
    const double gap = dot(s, z, p.rows), mu = gap / degree;
    out.solved = most < TOLERANCE && gap < TOLERANCE * fmax(1.0, x[3]);
    if (out.solved) break;
    scale_of(&p, s, z, &w);
    if (!factor(&p, &w, m)) break;
    double point[MOST_ROWS], right[MOST_ROWS], bx[UNKNOWNS], bz[MOST_ROWS], dx[UNKNOWNS], dz[MOST_ROWS], ds[MOST_ROWS],
        other[MOST_ROWS], correction[MOST_ROWS], step = 0.0;
    apply(&p, &w, false, z, point);
    product(&p, point, point, right);
    for (int i = 0; i < p.rows; i++) right[i] = -right[i];
    for (int pass = 0; pass < 2; pass++) {
      divide(&p, point, right, other);
      double scaled[MOST_ROWS];
      apply(&p, &w, false, other, scaled);
      for (int j = 0; j < UNKNOWNS; j++) bx[j] = -rx[j];
      for (int i = 0; i < p.rows; i++) bz[i] = -rz[i] - scaled[i];
      solve(&p, &w, m, bx, bz, dx, dz);
      double turned[MOST_ROWS];
      apply(&p, &w, false, dz, turned);
      for (int i = 0; i < p.rows; i++) other[i] -= turned[i];
      apply(&p, &w, false, other, ds);
      step = fmin(room(&p, s, ds), room(&p, z, dz));
      if (pass) break;
      const double left = 1.0 - step, sigma = left * left * left;
      product(&p, other, turned, correction);
      for (int i = 0; i < p.rows; i++) right[i] += sigma * mu * e[i] - correction[i];
    }
    step = fmin(1.0, 0.99 * step);
    for (int j = 0; j < UNKNOWNS; j++) x[j] += step * dx[j];
    for (int i = 0; i < p.rows; i++) s[i] += step * ds[i], z[i] += step * dz[i];
  }

  /* the Lagrange function by b's position: its rows are functions of x less that */
  out.value = x[3];
  out.touch = (cprox_vec3){x[0], x[1], x[2]};
  for (int i = 0; i < p.rows; i++)
    if (p.of_b[i]) out.by_b.x -= z[i] * p.g[i][0], out.by_b.y -= z[i] * p.g[i][1], out.by_b.z -= z[i] * p.g[i][2];
  return out;
}
