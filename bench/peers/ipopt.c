/* SPDX-License-Identifier: BSD-3-Clause */
#include "peers/ipopt.h"

#include <coin/IpStdCInterface.h>
#include <math.h>
#include <stdlib.h>

#include "peers/constraints.h"

/* The problem, and how many iterations it has taken so far. */
typedef struct task {
  const implicit_query *q;
  int iterations;
} task;

static vec3 at(const double *x) {
  return vec(x[0], x[1], x[2]);
}

static vec3 apart(const task *t, const double *x) {
  return vec_sub(vec_sub(at(x), constraint_turn(t->q->m, at(x + 3))), t->q->t);
}

static Bool objective(Index n, Number *x, Bool new_x, Number *value, UserDataPtr user) {
  (void)n, (void)new_x;
  *value = 0.5 * vec_norm2(apart(user, x));
  return TRUE;
}

static Bool objective_gradient(Index n, Number *x, Bool new_x, Number *gradient, UserDataPtr user) {
  (void)n, (void)new_x;
  const vec3 e = apart(user, x), back = constraint_turn_back(((const task *)user)->q->m, e);
  gradient[0] = e.x, gradient[1] = e.y, gradient[2] = e.z;
  gradient[3] = -back.x, gradient[4] = -back.y, gradient[5] = -back.z;
  return TRUE;
}

static Bool constraints(Index n, Number *x, Bool new_x, Index m, Number *value, UserDataPtr user) {
  (void)n, (void)new_x, (void)m;
  const implicit_query *q = ((const task *)user)->q;
  const int32_t first = implicit_count(q->a), second = implicit_count(q->b);
  vec3 g;
  double h[6];
  for (int32_t k = 0; k < first; k++) value[k] = constraint_at(q->a, k, at(x), &g, h);
  for (int32_t k = 0; k < second; k++) value[first + k] = constraint_at(q->b, k, at(x + 3), &g, h);
  return TRUE;
}

static Bool jacobian(Index n, Number *x, Bool new_x, Index m, Index nonzeros, Index *row, Index *column, Number *value,
                     UserDataPtr user) {
  (void)n, (void)new_x, (void)m, (void)nonzeros;
  const implicit_query *q = ((const task *)user)->q;
  const int32_t first = implicit_count(q->a), all = first + implicit_count(q->b);
  for (int32_t k = 0; k < all; k++) {
    const int offset = k < first ? 0 : 3;
    vec3 g;
    double h[6];
    if (value) {
      constraint_at(k < first ? q->a : q->b, k < first ? k : k - first, at(x + offset), &g, h);
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
  const implicit_query *q = ((const task *)user)->q;
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
      constraint_at(k < first ? q->a : q->b, k < first ? k : k - first, at(x + o), &g, h);
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

ipopt_answer ipopt_pair(const implicit_query *query, double tolerance) {
  task t = {.q = query};
  const int32_t m = implicit_count(query->a) + implicit_count(query->b);
  double low[6], high[6], x[6] = {0}, value = 0.0;
  for (int i = 0; i < 6; i++) low[i] = -2e19, high[i] = 2e19;
  double *g_low = malloc((size_t)m * sizeof *g_low), *g_high = calloc((size_t)m, sizeof *g_high);
  for (int32_t k = 0; k < m; k++) g_low[k] = -2e19;

  IpoptProblem problem = CreateIpoptProblem(6, low, high, m, g_low, g_high, 3 * m, 21, 0, objective, constraints,
                                            objective_gradient, jacobian, lagrangian);
  AddIpoptNumOption(problem, "tol", tolerance);
  AddIpoptIntOption(problem, "print_level", 0);
  AddIpoptIntOption(problem, "max_iter", 500);
  AddIpoptNumOption(problem, "max_cpu_time", 0.1);
  AddIpoptStrOption(problem, "sb", "yes");
  SetIntermediateCallback(problem, count);
  const enum ApplicationReturnStatus status = IpoptSolve(problem, x, NULL, &value, NULL, NULL, NULL, &t);
  FreeIpoptProblem(problem);
  free(g_low);
  free(g_high);
  return (ipopt_answer){.solved = status == Solve_Succeeded, .distance = sqrt(2.0 * value), .iterations = t.iterations};
}
