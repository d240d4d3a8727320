/* SPDX-License-Identifier: BSD-3-Clause */
#include "kinematics/part_cover.h"

#include <stdlib.h>
#include <string.h>

#include "base/rounding.h"
#include "kinematics/joint_tree.h"

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

/* ---- of a robot ---- */

/* What of a part is not in its balls. */
typedef struct part_place {
  placement at;
  int32_t geometry, link, axis;
} part_place;

static void add_bytes(robot_covers *c, const void *from, size_t bytes) {
  if (bytes > 0) memcpy(c->signature + c->n_signature, from, bytes);
  c->n_signature += bytes;
}

static bool sign(const cprox_robot *robot, robot_covers *c) {
  static _Atomic size_t hulls_made;
  const size_t number = c->hulls.n > 0 ? atomic_fetch_add_explicit(&hulls_made, 1, memory_order_relaxed) + 1 : 0;
  const size_t counts[] = {robot->n_axes, robot->n_parts, robot->n_geometries, robot->n_variables, number};
  const size_t axes = robot->n_axes * sizeof *robot->axes, n_balls = c->first[robot->n_parts];
  c->signature = malloc(sizeof counts + axes + robot->n_geometries * 2 * sizeof(int32_t) +
                        robot->n_parts * (sizeof(part_place) + sizeof(size_t)) + n_balls * sizeof *c->balls);
  if (!c->signature) return false;
  add_bytes(c, counts, sizeof counts);
  add_bytes(c, robot->axes, axes);
  for (size_t i = 0; i < robot->n_geometries; i++) {
    const int32_t link = robot->given_geometries[i].link, two[2] = {link, robot->links[link].axis};
    add_bytes(c, two, sizeof two);
  }
  for (size_t i = 0; i < robot->n_parts; i++) {
    const robot_part *part = &robot->parts[i];
    part_place place;
    memset(&place, 0, sizeof place);
    place.at = part->at, place.geometry = part->geometry, place.link = part->link, place.axis = part->axis;
    add_bytes(c, &place, sizeof place);
    add_bytes(c, &c->first[i + 1], sizeof c->first[i + 1]);
  }
  add_bytes(c, c->balls, n_balls * sizeof *c->balls);
  return true;
}

static bool cover_all(const cprox_robot *robot, robot_covers *c) {
  size_t room = robot->n_parts + COVER_MOST, n = 0;
  c->first = malloc((robot->n_parts + 1) * sizeof *c->first);
  c->first_hull = malloc((robot->n_parts + 1) * sizeof *c->first_hull);
  c->balls = calloc(room, sizeof *c->balls);
  for (size_t i = 0; i < robot->n_parts && c->first && c->first_hull && c->balls; i++) {
    c->first[i] = n, c->first_hull[i] = c->hulls.n;
    if (cover_is_by_hulls(&robot->parts[i].model)) {
      if (!cover_by_hulls(&robot->parts[i].model, &c->hulls)) return false;
      continue;
    }
    if (n + COVER_MOST > room) {
      room += room / 2 + COVER_MOST;
      cover_ball *grown = realloc(c->balls, room * sizeof *grown);
      if (!grown) return false;
      c->balls = grown;
    }
    n += cover_of_part(&robot->parts[i].model, c->balls + n);
    c->n_coarse += cover_is_coarse(c->balls[n - 1].outer, c->balls[n - 1].inner);
  }
  if (!c->first || !c->first_hull || !c->balls) return false;
  c->first[robot->n_parts] = n, c->first_hull[robot->n_parts] = c->hulls.n;
  return sign(robot, c);
}

void robot_covers_free(robot_covers *c) {
  if (!c) return;
  free(c->first), free(c->balls), free(c->signature);
  free(c->first_hull), free(c->hulls.hull), free(c->hulls.point);
  free(c);
}

const robot_covers *robot_covers_of(const cprox_robot *robot) {
  cprox_robot *own = (cprox_robot *)robot; /* a robot is never a const object: cprox_robot_create() allocates it */
  robot_covers *known = atomic_load_explicit(&own->covers, memory_order_acquire);
  if (known) return known;
  robot_covers *made = calloc(1, sizeof *made);
  if (made && cover_all(robot, made) &&
      atomic_compare_exchange_strong_explicit(&own->covers, &known, made, memory_order_acq_rel, memory_order_acquire))
    return made;
  robot_covers_free(made);
  return known; /* that of another thread, which was faster */
}
