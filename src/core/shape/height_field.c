/* SPDX-License-Identifier: BSD-3-Clause */
/* A height field as a mesh: the surface, and with a floor the walls round it and the floor. */
#include <math.h>
#include <stdlib.h>

#include "base/workspace.h"
#include "shape/construct.h"

static const double MOST_LENGTH = 1e60;

/* These tell the workspace what is wrong. */
static bool check_axis(const cprox_height_field *field, int k, cprox_workspace *workspace) {
  const char axis = k == 0 ? 'x' : 'y';
  if (field->n[k] < 2) {
    workspace_fail(workspace, CPROX_INVALID, "the height field has %zu points along %c, at least 2 are needed",
                   field->n[k], axis);
    return false;
  }
  if (!(field->cell[k] > 0.0 && field->cell[k] <= MOST_LENGTH)) {
    workspace_fail(workspace, CPROX_INVALID, "the height field's cell is %g along %c, must be > 0 and finite",
                   field->cell[k], axis);
    return false;
  }
  if (!(fabs(field->origin[k]) <= MOST_LENGTH)) {
    workspace_fail(workspace, CPROX_INVALID, "the height field's origin is %g along %c, must be finite",
                   field->origin[k], axis);
    return false;
  }
  return true;
}

static bool check_heights(const cprox_height_field *field, cprox_workspace *workspace) {
  const size_t n = field->n[0];
  for (size_t i = 0; i < n * field->n[1]; i++) {
    const double h = field->heights[i];
    if (!(fabs(h) <= MOST_LENGTH)) {
      workspace_fail(workspace, CPROX_INVALID, "the height at (%zu, %zu) is %g, must be finite", i % n, i / n, h);
      return false;
    }
    if (h <= field->floor) {
      workspace_fail(workspace, CPROX_INVALID, "the height at (%zu, %zu) is %g, must be above the floor at %g", i % n,
                     i / n, h, field->floor);
      return false;
    }
  }
  return true;
}

static bool check_field(const cprox_height_field *field, cprox_workspace *workspace) {
  if (!field) {
    workspace_fail(workspace, CPROX_INVALID, "the height field is NULL");
    return false;
  }
  if (!check_axis(field, 0, workspace) || !check_axis(field, 1, workspace)) return false;
  if (field->n[0] > UINT32_MAX / 8 / field->n[1]) {
    workspace_fail(workspace, CPROX_INVALID, "the height field has too many points: %zu x %zu", field->n[0],
                   field->n[1]);
    return false;
  }
  if (!field->heights) {
    workspace_fail(workspace, CPROX_INVALID, "heights is NULL");
    return false;
  }
  if (isinf(field->floor)) {
    workspace_fail(workspace, CPROX_INVALID, "the floor is %g, must be finite, or NaN for none", field->floor);
    return false;
  }
  return check_heights(field, workspace);
}

/* The number of the i-th point along the rim of the grid, counter-clockwise as seen from above. */
static size_t rim_point(const size_t n[2], size_t i) {
  const size_t wide = n[0] - 1, deep = n[1] - 1;
  if (i < wide) return i;
  if (i < wide + deep) return (i - wide) * n[0] + wide;
  if (i < 2 * wide + deep) return deep * n[0] + (2 * wide + deep - i);
  return (2 * (wide + deep) - i) * n[0];
}

typedef struct triangle_list {
  uint32_t (*of)[3];
  size_t n;
} triangle_list;

static void add_triangle(triangle_list *list, size_t a, size_t b, size_t c) {
  uint32_t *added = list->of[list->n++];
  added[0] = (uint32_t)a, added[1] = (uint32_t)b, added[2] = (uint32_t)c;
}

static void add_surface(triangle_list *list, const size_t n[2]) {
  for (size_t j = 0; j + 1 < n[1]; j++) {
    for (size_t i = 0; i + 1 < n[0]; i++) {
      const size_t at = j * n[0] + i;
      add_triangle(list, at, at + 1, at + n[0] + 1);
      add_triangle(list, at, at + n[0] + 1, at + n[0]);
    }
  }
}

/* The points of the floor's rim come after those of the surface. */
static void add_walls(triangle_list *list, const size_t n[2], size_t rim) {
  const size_t below = n[0] * n[1];
  for (size_t i = 0; i < rim; i++) {
    const size_t next = (i + 1) % rim, upper = rim_point(n, i), upper_next = rim_point(n, next);
    add_triangle(list, upper, below + i, below + next);
    add_triangle(list, upper, below + next, upper_next);
    if (i > 0 && next > 0) add_triangle(list, below, below + next, below + i);
  }
}

cprox_status cprox_body_create_height_field(const cprox_height_field *field, size_t memory_limit,
                                            cprox_workspace *workspace, cprox_body **body) {
  WORKSPACE_USE(workspace);
  if (!check_field(field, workspace)) return CPROX_INVALID;
  const size_t *n = field->n, count = n[0] * n[1];
  const size_t rim = isnan(field->floor) ? 0 : 2 * (n[0] - 1 + n[1] - 1);
  vec3 *vertices = malloc((count + rim) * sizeof *vertices);
  cprox_status status;
  triangle_list list = {.of = malloc((2 * count + 3 * rim) * sizeof *list.of)};
  if (vertices && list.of) {
    for (size_t i = 0; i < count; i++) {
      const size_t column = i % n[0], row = i / n[0];
      vertices[i] = vec(field->origin[0] + field->cell[0] * (double)column,
                        field->origin[1] + field->cell[1] * (double)row, field->heights[i]);
    }
    for (size_t i = 0; i < rim; i++) {
      vertices[count + i] = vertices[rim_point(n, i)];
      vertices[count + i].z = field->floor;
    }
    add_surface(&list, n);
    add_walls(&list, n, rim);
    const cprox_mesh_fill fill = rim > 0 ? CPROX_MESH_FILL_SOLID : CPROX_MESH_FILL_SURFACE;
    status = WORKSPACE_LEND(workspace, cprox_body_create_mesh(vertices, count + rim, (const uint32_t(*)[3])list.of,
                                                              list.n, fill, memory_limit, workspace, body));
  } else {
    status = body_out_of_memory(workspace);
  }
  free(vertices);
  free(list.of);
  return status;
}
