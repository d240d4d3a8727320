/* SPDX-License-Identifier: BSD-3-Clause */
#include "kinematics/given.h"

#include <stdlib.h>
#include <string.h>

/* Room for all, and the variables in it. */
static bool make_room(motion_given *g, const int32_t *variables, size_t per_point) {
  g->variables = calloc(g->n + 1, sizeof *g->variables);
  g->times = calloc(g->n_times + 1, sizeof *g->times);
  g->orders = calloc(g->n_points + 1, sizeof *g->orders);
  g->values = calloc(g->n_points * per_point + 1, sizeof *g->values);
  if (!g->variables || !g->times || !g->orders || !g->values) {
    motion_given_free(g);
    return false;
  }
  if (g->n > 0) memcpy(g->variables, variables, g->n * sizeof *variables);
  return true;
}

bool motion_keep_waypoints(motion_given *g, const cprox_motion_description *d) {
  const cprox_waypoint *points = d->waypoints;
  const size_t n = d->n_variables, n_points = d->n_waypoints;
  *g = (motion_given){
      .interpolation = d->interpolation, .turning = d->turning, .n = n, .n_points = n_points, .n_times = n_points};
  if (!make_room(g, d->variables, 3 * n)) return false;
  for (size_t i = 0; i < n_points; i++) {
    const double *rows[3] = {points[i].positions, points[i].velocities, points[i].accelerations};
    g->times[i] = points[i].time;
    for (size_t k = 0; k < 3 && rows[k]; k++) {
      if (n > 0) memcpy(g->values + (3 * i + k) * n, rows[k], n * sizeof(double));
      g->orders[i] = (uint8_t)(k + 1);
    }
  }
  return true;
}

bool motion_keep_spline(motion_given *g, const cprox_motion_description *d) {
  const size_t n = d->n_variables, n_control = d->n_control;
  *g = (motion_given){.degree = d->degree, .n = n, .n_points = n_control, .n_times = d->n_knots};
  if (!make_room(g, d->variables, n)) return false;
  memcpy(g->times, d->knots, g->n_times * sizeof *d->knots);
  if (n > 0) memcpy(g->values, d->control, n_control * n * sizeof *d->control);
  return true;
}

bool motion_keep_points(motion_given *g, const motion_given *from, int32_t first_variable) {
  *g = (motion_given){.degree = from->degree, .n = from->n, .n_points = from->n_points};
  g->n_times = from->degree > 0 ? from->n_times : 0;
  g->variables = calloc(g->n + 1, sizeof *g->variables);
  g->times = calloc(g->n_times + 1, sizeof *g->times);
  if (!g->variables || !g->times) {
    motion_given_free(g);
    return false;
  }
  for (size_t k = 0; k < g->n; k++) g->variables[k] = first_variable + from->variables[k];
  if (g->n_times > 0) memcpy(g->times, from->times, g->n_times * sizeof *from->times);
  return true;
}

bool motion_keep_joined(motion_given *g, const motion_given *from, int32_t first_variable, double start) {
  const size_t per_point = (from->degree > 0 ? 1 : 3) * from->n;
  *g = *from;
  g->start = start;
  if (!make_room(g, from->variables, per_point)) return false;
  for (size_t k = 0; k < g->n; k++) g->variables[k] += first_variable;
  memcpy(g->times, from->times, g->n_times * sizeof *g->times);
  memcpy(g->orders, from->orders, g->n_points * sizeof *g->orders);
  memcpy(g->values, from->values, g->n_points * per_point * sizeof *g->values);
  return true;
}

void motion_given_free(motion_given *g) {
  free(g->variables);
  free(g->times);
  free(g->orders);
  free(g->values);
  *g = (motion_given){0};
}
