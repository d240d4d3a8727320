/* SPDX-License-Identifier: BSD-3-Clause */
#include "peers/ipopt.h"

#include <coin/IpStdCInterface.h>
#include <math.h>
#include <stdlib.h>

/* The problem, and how many iterations it has taken so far. */
typedef struct task {
  const implicit_question *q;
  int iterations;
} task;

static vec3 turn(const double *m, vec3 v) {
  return vec(m[0] * v.x + m[1] * v.y + m[2] * v.z, m[3] * v.x + m[4] * v.y + m[5] * v.z,
             m[6] * v.x + m[7] * v.y + m[8] * v.z);
}

static vec3 turn_back(const double *m, vec3 v) {
  return vec(m[0] * v.x + m[3] * v.y + m[6] * v.z, m[1] * v.x + m[4] * v.y + m[7] * v.z,
             m[2] * v.x + m[5] * v.y + m[8] * v.z);
}

static vec3 at(const double *x) {
  return vec(x[0], x[1], x[2]);
}

static vec3 apart(const task *t, const double *x) {
  return vec_sub(vec_sub(at(x), turn(t->q->m, at(x + 3))), t->q->t);
}

/* Constraint k of a body: value, gradient, second derivative (xx, xy, xz, yy, yz, zz). */
static double constraint(const implicit *body, int32_t k, vec3 x, vec3 *g, double h[6]) {
  for (int i = 0; i < 6; i++) h[i] = 0.0;
  if (k < body->n_planes) {
    *g = body->plane[k].b;
    return vec_dot(*g, x) + body->plane[k].c;
  }
  k -= body->n_planes;
  if (k < body->n_quadrics) {
    for (int i = 0; i < 6; i++) h[i] = 2.0 * body->quadric[k].q[i];
    return implicit_quadric_at(&body->quadric[k], x, g);
  }
  const implicit_power *power = &body->power[k - body->n_quadrics];
  double value = -1.0;
  *g = vec(0, 0, 0);
  for (int32_t i = power->first; i < power->first + power->n; i++) {
    const implicit_term *term = &body->term[i];
    const double row = implicit_row(term, x), u = fabs(row), raised = implicit_raise(term, u);
    const double slope = u > 0.0 ? term->p * raised / row : 0.0;
    /* p < 2 has no second derivative at 0: a large number stands for it */
    const double bend = u > 1e-12 ? term->p * (term->p - 1.0) * raised / (u * u) : term->p < 2.0 ? 1e8 : 0.0;
    value += raised;
    *g = vec_axpy(*g, slope, term->a);
    const vec3 a = term->a;
    h[0] += bend * a.x * a.x, h[1] += bend * a.x * a.y, h[2] += bend * a.x * a.z;
    h[3] += bend * a.y * a.y, h[4] += bend * a.y * a.z, h[5] += bend * a.z * a.z;
  }
  return value;
}

static Bool objective(Index n, Number *x, Bool new_x, Number *value, UserDataPtr user) {
  (void)n, (void)new_x;
  *value = 0.5 * vec_norm2(apart(user, x));
  return TRUE;
}

static Bool objective_gradient(Index n, Number *x, Bool new_x, Number *gradient, UserDataPtr user) {
  (void)n, (void)new_x;
  const vec3 e = apart(user, x), back = turn_back(((const task *)user)->q->m, e);
  gradient[0] = e.x, gradient[1] = e.y, gradient[2] = e.z;
  gradient[3] = -back.x, gradient[4] = -back.y, gradient[5] = -back.z;
  return TRUE;
}

static Bool constraints(Index n, Number *x, Bool new_x, Index m, Number *value, UserDataPtr user) {
  (void)n, (void)new_x, (void)m;
  const implicit_question *q = ((const task *)user)->q;
  const int32_t first = implicit_count(q->a), second = implicit_count(q->b);
  vec3 g;
  double h[6];
  for (int32_t k = 0; k < first; k++) value[k] = constraint(q->a, k, at(x), &g, h);
  for (int32_t k = 0; k < second; k++) value[first + k] = constraint(q->b, k, at(x + 3), &g, h);
  return TRUE;
}

static Bool jacobian(Index n, Number *x, Bool new_x, Index m, Index nonzeros, Index *row, Index *column, Number *value,
                     UserDataPtr user) {
  (void)n, (void)new_x, (void)m, (void)nonzeros;
  const implicit_question *q = ((const task *)user)->q;
  const int32_t first = implicit_count(q->a), all = first + implicit_count(q->b);
  for (int32_t k = 0; k < all; k++) {
    const int offset = k < first ? 0 : 3;
    vec3 g;
    double h[6];
    if (value) {
      constraint(k < first ? q->a : q->b, k < first ? k : k - first, at(x + offset), &g, h);
      value[3 * k] = g.x, value[3 * k + 1] = g.y, value[3 * k + 2] = g.z;
      continue;
    }
    for (int i = 0; i < 3; i++) row[3 * k + i] = k, column[3 * k + i] = offset + i;
  }
  return TRUE;
}

static Bool lagrangian(Index n, Number *x, Bool new_x, Number factor, Index m, Number *lambda, Bool new_lambda,
                       Index nonzeros, Index *row, Index *column, Number *value, UserDataPtr user) {
  (void)n, (void)new_x, (void)m, (void)new_lambda, (void)nonzeros;
  const implicit_question *q = ((const task *)user)->q;
  double full[6][6] = {{0}};
  if (value) {
    const int32_t first = implicit_count(q->a), all = first + implicit_count(q->b);
    for (int i = 0; i < 6; i++) full[i][i] = factor;
    for (int i = 0; i < 3; i++)
      for (int j = 0; j < 3; j++) full[3 + i][j] = -factor * q->m[3 * j + i];
    for (int32_t k = 0; k < all; k++) {
      const int o = k < first ? 0 : 3;
      vec3 g;
      double h[6];
      constraint(k < first ? q->a : q->b, k < first ? k : k - first, at(x + o), &g, h);
      full[o][o] += lambda[k] * h[0], full[o + 1][o] += lambda[k] * h[1], full[o + 2][o] += lambda[k] * h[2];
      full[o + 1][o + 1] += lambda[k] * h[3], full[o + 2][o + 1] += lambda[k] * h[4];
      full[o + 2][o + 2] += lambda[k] * h[5];
    }
  }
  int entry = 0;
  for (int i = 0; i < 6; i++) {
    for (int j = 0; j <= i; j++, entry++) {
      if (value)
        value[entry] = full[i][j];
      else
        row[entry] = i, column[entry] = j;
    }
  }
  return TRUE;
}

static Bool count(Index mode, Index iteration, Number value, Number primal, Number dual, Number mu, Number d,
                  Number regularised, Number alpha_dual, Number alpha_primal, Index tries, UserDataPtr user) {
  (void)mode, (void)value, (void)primal, (void)dual, (void)mu, (void)d, (void)regularised, (void)alpha_dual;
  (void)alpha_primal, (void)tries;
  ((task *)user)->iterations = iteration;
  return TRUE;
}

ipopt_answer ipopt_pair(const implicit_question *question) {
  task t = {.q = question};
  const int32_t m = implicit_count(question->a) + implicit_count(question->b);
  double low[6], high[6], x[6] = {0}, value = 0.0;
  for (int i = 0; i < 6; i++) low[i] = -2e19, high[i] = 2e19;
  double *g_low = malloc((size_t)m * sizeof *g_low), *g_high = calloc((size_t)m, sizeof *g_high);
  for (int32_t k = 0; k < m; k++) g_low[k] = -2e19;

  IpoptProblem problem = CreateIpoptProblem(6, low, high, m, g_low, g_high, 3 * m, 21, 0, objective, constraints,
                                            objective_gradient, jacobian, lagrangian);
  AddIpoptNumOption(problem, "tol", 1e-8);
  AddIpoptIntOption(problem, "print_level", 0);
  AddIpoptIntOption(problem, "max_iter", 500);
  AddIpoptStrOption(problem, "sb", "yes");
  SetIntermediateCallback(problem, count);
  const enum ApplicationReturnStatus status = IpoptSolve(problem, x, NULL, &value, NULL, NULL, NULL, &t);
  FreeIpoptProblem(problem);
  free(g_low);
  free(g_high);
  return (ipopt_answer){.solved = status == Solve_Succeeded, .distance = sqrt(2.0 * value), .iterations = t.iterations};
}
