/* SPDX-License-Identifier: BSD-3-Clause */
#include "edges/cover.h"

#include "base/rounding.h"

/* Cells along a side are at most COVER_MOST: their places are rounded by less than this part of a cell. */
static const double UP = 1.0 + 0x1p-40, DOWN = 1.0 - 0x1p-40;

/* Balls about points of a capsule's line, both ends among them. Between two of these a point of the capsule is at most
 * half a step along the line and a radius across it from the nearer one; beyond an end it is within a radius of that.
 */
static size_t cover_capsule(const part_model *m, cover_ball *balls) {
  enum { MOST = 24 };
  const double half = m->shape->size[1], radius = m->margin;
  const double wanted = ceil(half / (0.35 * radius));
  const size_t steps = !(wanted > 1.0) ? 1 : wanted < MOST ? (size_t)wanted : MOST;
  const double step = half / (double)steps;
  for (size_t i = 0; i <= steps; i++)
    balls[i] = (cover_ball){.centre = vec(0, 0, (2.0 * (double)i - (double)steps) * step),
                            .outer = UP * sqrt(step * step + radius * radius),
                            .inner = m->tree ? -1.0 : DOWN * radius};
  return steps + 1;
}

/* How many cells along each side of a box, as nearly cubes as so many allow. */
static void choose_cells(const double half[3], size_t most, size_t n[3]) {
  n[0] = n[1] = n[2] = 1;
  for (;;) {
    int longest = 0;
    for (int k = 1; k < 3; k++)
      if (half[k] / (double)n[k] > half[longest] / (double)n[longest]) longest = k;
    n[longest]++;
    if (n[0] * n[1] * n[2] <= most && half[longest] > 0.0) continue;
    n[longest]--;
    return;
  }
}

/* The box round the core in cells, but for cells that the core does not reach. */
static size_t cover_box(const part_model *m, cover_ball *balls) {
  const double half[3] = {m->half.x, m->half.y, m->half.z};
  size_t cells[3], n = 0;
  choose_cells(half, COVER_MOST, cells);
  const vec3 cell = vec(half[0] / (double)cells[0], half[1] / (double)cells[1], half[2] / (double)cells[2]);
  const double radius = UP * vec_norm(cell);
  for (size_t i = 0; i < cells[0]; i++)
    for (size_t j = 0; j < cells[1]; j++)
      for (size_t k = 0; k < cells[2]; k++) {
        const vec3 at = vec_add(m->middle, vec(((2.0 * (double)i + 1.0) - (double)cells[0]) * cell.x,
                                               ((2.0 * (double)j + 1.0) - (double)cells[1]) * cell.y,
                                               ((2.0 * (double)k + 1.0) - (double)cells[2]) * cell.z));
        convex_hint hint = {0};
        convex_near near = {.distance = 0.0};
        if (m->shape->ops->kind != CPROX_BODY_BOX) m->shape->ops->nearest(m->shape, at, &hint, &near);
        const double off = m->shape->ops->near_rounding * ROUND_U * (vec_norm(at) + m->shape->scale) + m->shape->slack;
        const double apart = near.distance + m->shape->margin - off; /* of the core; NaN keeps the cell */
        if (apart > radius) continue;
        balls[n++] = (cover_ball){.centre = at, .outer = UP * (radius + m->margin), .inner = -1.0};
      }
  return n;
}

size_t cover_of_part(const part_model *m, cover_ball balls[COVER_MOST]) {
  const cprox_body_kind kind = m->shape->ops->kind;
  const bool is_point = m->shape->ops == &convex_point || kind == CPROX_BODY_SPHERE;
  if (kind == CPROX_BODY_CAPSULE && m->margin > 0.0) return cover_capsule(m, balls);
  if (!is_point) {
    const size_t n = cover_box(m, balls);
    if (n > 0) return n;
  }
  balls[0] = (cover_ball){.outer = UP * (is_point ? m->margin : m->radius), .inner = -1.0};
  if (is_point && !m->tree) balls[0].inner = DOWN * m->margin;
  return 1;
}
