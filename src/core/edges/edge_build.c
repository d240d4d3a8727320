/* SPDX-License-Identifier: BSD-3-Clause */
#include "edges/edge_build.h"

/* Entries of rotations below this are 0. */
#define EDGE_SNAP 1e-9

bool edge_snap(const double r[9], float out[9], int32_t from[3], float sign[3]) {
  bool exchanges = true;
  for (int k = 0; k < 9; k++) {
    const double x = fabs(r[k]) < EDGE_SNAP ? 0.0 : fabs(fabs(r[k]) - 1.0) < EDGE_SNAP ? copysign(1.0, r[k]) : r[k];
    out[k] = (float)x;
    exchanges = exchanges && (x == 0.0 || fabs(x) == 1.0);
  }
  for (int c = 0; c < 3; c++)
    for (int k = 0; k < 3; k++)
      if (out[3 * k + c] != 0.0f) from[c] = k, sign[c] = out[3 * k + c];
  return exchanges;
}

void edge_enclose_points(edge_hull *hull, const float *points) {
  float low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
  for (uint32_t i = 0; i < hull->n; i++)
    for (size_t k = 0; k < 3; k++) {
      const float x = points[edge_point_place(i) + k * EDGE_BLOCK];
      low[k] = x < low[k] ? x : low[k], high[k] = x > high[k] ? x : high[k];
    }
  for (int k = 0; k < 3; k++) hull->centre[k] = 0.5f * low[k] + 0.5f * high[k];
  double core2 = 0.0;
  const vec3 centre = vec((double)hull->centre[0], (double)hull->centre[1], (double)hull->centre[2]);
  for (uint32_t i = 0; i < hull->n; i++) {
    const vec3 apart = vec_sub(edge_point(points, i), centre);
    core2 = greater(vec_dot(apart, apart), core2);
  }
  hull->core = edge_float_above(sqrt(core2) * (1.0 + 0x1p-40));
}

/* Joints above a link. */
static size_t joints_between(const cprox_robot *robot, int32_t link_a, int32_t link_b) {
  const int32_t a = link_a < 0 ? -1 : robot->links[link_a].axis, b = link_b < 0 ? -1 : robot->links[link_b].axis;
  const int32_t common = robot_common_axis(robot, a, b);
  size_t n = 0;
  for (int32_t i = a; i != common; i = robot->axes[i].parent) n += robot->axes[i].first_of_joint;
  for (int32_t i = b; i != common; i = robot->axes[i].parent) n += robot->axes[i].first_of_joint;
  return n;
}

bool edge_is_worth_asking(const cprox_robot *robot, size_t g, size_t k) {
  return joints_between(robot, robot->given_geometries[g].link, robot->given_geometries[k].link) >= 2;
}
