/* SPDX-License-Identifier: BSD-3-Clause */
#include "peers/naive.h"

#include <math.h>
#include <stdlib.h>

#include "peers/constraints.h"

enum { NAIVE_STEPS = 200, NAIVE_BACKTRACKS = 60 };

/* One constraint: slack, multiplier, their steps. */
typedef struct naive_row {
  double f, l, df, dl, h[6];
  vec3 g;
} naive_row;

typedef struct naive {
  const implicit_query *q;
  int32_t first, all; /* constraints of a, of both */
  naive_row *row;
  double x[6];
} naive;

static const implicit *body_of(const naive *n, int32_t k) {
  return k < n->first ? n->q->a : n->q->b;
}

static vec3 point_of(const naive *n, const double *x, int32_t k) {
  const double *p = x + (k < n->first ? 0 : 3);
  return vec(p[0], p[1], p[2]);
}

static vec3 apart(const naive *n, const double *x) {
  return vec_sub(vec_sub(vec(x[0], x[1], x[2]), constraint_turn(n->q->m, vec(x[3], x[4], x[5]))), n->q->t);
}

static void look(naive *n) {
  for (int32_t k = 0; k < n->all; k++) {
    naive_row *row = &n->row[k];
    row->f = constraint_at(body_of(n, k), k < n->first ? k : k - n->first, point_of(n, n->x, k), &row->g, row->h);
  }
}

static bool inside(const naive *n, const double *x) {
  for (int32_t k = 0; k < n->all; k++) {
    vec3 g;
    double h[6];
    const double f = constraint_at(body_of(n, k), k < n->first ? k : k - n->first, point_of(n, x, k), &g, h);
    if (!(f < 0.0)) return false;
  }
  return true;
}

/* Gaussian elimination with pivots; false where the matrix is singular. */
static bool solve(double a[6][6], double b[6]) {
  for (int j = 0; j < 6; j++) {
    int pivot = j;
    for (int i = j + 1; i < 6; i++)
      if (fabs(a[i][j]) > fabs(a[pivot][j])) pivot = i;
    if (!(fabs(a[pivot][j]) > 0.0) || !isfinite(a[pivot][j])) return false;
    for (int k = 0; k < 6; k++) {
      const double swap = a[j][k];
      a[j][k] = a[pivot][k];
      a[pivot][k] = swap;
    }
    const double swap = b[j];
    b[j] = b[pivot];
    b[pivot] = swap;
    for (int i = j + 1; i < 6; i++) {
      const double factor = a[i][j] / a[j][j];
      for (int k = j; k < 6; k++) a[i][k] -= factor * a[j][k];
      b[i] -= factor * b[j];
    }
  }
  for (int i = 5; i >= 0; i--) {
    for (int k = i + 1; k < 6; k++) b[i] -= a[i][k] * b[k];
    b[i] /= a[i][i];
  }
  return true;
}

/* Newton's direction for products of slack and multiplier equal to `target`; *residual is that of the gradients. */
static bool direction(naive *n, double target, double step[6], double *residual) {
  double a[6][6] = {{0}};
  const vec3 e = apart(n, n->x), back = constraint_turn_back(n->q->m, e);
  double force[6] = {e.x, e.y, e.z, -back.x, -back.y, -back.z};
  for (int i = 0; i < 6; i++) step[i] = -force[i];
  for (int i = 0; i < 6; i++) a[i][i] = 1.0;
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) a[3 + i][j] = a[j][3 + i] = -n->q->m[3 * j + i];
  for (int32_t k = 0; k < n->all; k++) {
    const naive_row *row = &n->row[k];
    const int o = k < n->first ? 0 : 3;
    const double g[3] = {row->g.x, row->g.y, row->g.z}, s = -row->f;
    const double h[3][3] = {
        {row->h[0], row->h[1], row->h[2]}, {row->h[1], row->h[3], row->h[4]}, {row->h[2], row->h[4], row->h[5]}};
    for (int i = 0; i < 3; i++) {
      force[o + i] += row->l * g[i];
      step[o + i] -= target / s * g[i];
      for (int j = 0; j < 3; j++) a[o + i][o + j] += row->l * h[i][j] + row->l / s * g[i] * g[j];
    }
  }
  *residual = 0.0;
  for (int i = 0; i < 6; i++) *residual += force[i] * force[i];
  *residual = sqrt(*residual);
  return solve(a, step);
}

static bool advance(naive *n, const double step[6], double target) {
  double primal = 1.0, dual = 1.0, next[6];
  for (int32_t k = 0; k < n->all; k++) {
    naive_row *row = &n->row[k];
    const double *d = step + (k < n->first ? 0 : 3), s = -row->f;
    row->df = row->g.x * d[0] + row->g.y * d[1] + row->g.z * d[2];
    row->dl = (target - row->l * s + row->l * row->df) / s;
    if (row->dl < 0.0) dual = fmin(dual, -0.99 * row->l / row->dl);
  }
  for (int i = 0; i < NAIVE_BACKTRACKS; i++, primal *= 0.6) {
    for (int j = 0; j < 6; j++) next[j] = n->x[j] + primal * step[j];
    if (!inside(n, next)) continue;
    for (int j = 0; j < 6; j++) n->x[j] = next[j];
    for (int32_t k = 0; k < n->all; k++) n->row[k].l += dual * n->row[k].dl;
    return true;
  }
  return false;
}

naive_answer naive_pair(const implicit_query *query, double tolerance) {
  naive n = {.q = query, .first = implicit_count(query->a)};
  n.all = n.first + implicit_count(query->b);
  n.row = calloc((size_t)n.all, sizeof *n.row);
  naive_answer answer = {.distance = INFINITY};
  look(&n);
  double mu = 0.1 * vec_norm2(apart(&n, n.x)) / n.all;
  const double reach = query->a->radius + query->b->radius;
  for (int32_t k = 0; k < n.all; k++) n.row[k].l = -mu / n.row[k].f;
  for (; answer.iterations < NAIVE_STEPS; answer.iterations++) {
    double products = 0.0, step[6], residual;
    for (int32_t k = 0; k < n.all; k++) products -= n.row[k].l * n.row[k].f;
    mu = 0.1 * products / n.all;
    const double d = vec_norm(apart(&n, n.x));
    if (!direction(&n, mu, step, &residual)) break;
    answer.distance = d;
    answer.converged = products + residual * reach <= tolerance * (d + reach) * fmax(d, tolerance * reach);
    if (answer.converged || !advance(&n, step, mu)) break;
    look(&n);
  }
  free(n.row);
  return answer;
}
