/* SPDX-License-Identifier: BSD-3-Clause */
#include "shape/body.h"
#include "shape/cluster_hulls.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/rounding.h"
#include "base/workspace.h"
#include "bvh/bvh.h"
#include "bvh/winding.h"
#include "convex/feature.h"
#include "shape/cluster_hulls.h"
#include "shape/construct.h"
#include "shape/convex_function.h"
#include "shape/distance_field.h"
#include "shape/elements.h"

/* Lengths beyond these would lose their squares to underflow or overflow. */
static const double LEAST_LENGTH = 1e-100, MOST_LENGTH = 1e100;

/* ---- checks: each returns CPROX_OK or fails with an error message that names the argument and its value ---- */

static cprox_status check_out(cprox_body **body, cprox_workspace *workspace) {
  return body ? CPROX_OK : workspace_fail(workspace, CPROX_INVALID, "body is NULL: nowhere to put the handle");
}

static cprox_status check_length(const char *name, double value, cprox_workspace *workspace) {
  if (!(value > 0.0)) return workspace_fail(workspace, CPROX_INVALID, "%s is %g, must be > 0", name, value);
  if (!isfinite(value)) return workspace_fail(workspace, CPROX_INVALID, "%s is %g, must be finite", name, value);
  if (value < LEAST_LENGTH || value > MOST_LENGTH)
    return workspace_fail(workspace, CPROX_INVALID, "%s is %g, must be between %g and %g", name, value, LEAST_LENGTH,
                          MOST_LENGTH);
  return CPROX_OK;
}

static cprox_status check_not_negative(const char *name, double value, cprox_workspace *workspace) {
  if (!(value >= 0.0)) return workspace_fail(workspace, CPROX_INVALID, "%s is %g, must be >= 0", name, value);
  if (!(value <= MOST_LENGTH))
    return workspace_fail(workspace, CPROX_INVALID, "%s is %g, must be at most %g", name, value, MOST_LENGTH);
  return CPROX_OK;
}

static cprox_status check_point(const char *name, vec3 p, cprox_workspace *workspace) {
  if (!vec_finite(p))
    return workspace_fail(workspace, CPROX_INVALID, "%s is not finite: (%g, %g, %g)", name, p.x, p.y, p.z);
  if (fmax(fabs(p.x), fmax(fabs(p.y), fabs(p.z))) > MOST_LENGTH)
    return workspace_fail(workspace, CPROX_INVALID, "%s is (%g, %g, %g), farther than %g from the origin", name, p.x,
                          p.y, p.z, MOST_LENGTH);
  return CPROX_OK;
}

static cprox_status check_vertices(size_t n, cprox_workspace *workspace) {
  const size_t most = INT32_MAX / 2;
  if (n > most) return workspace_fail(workspace, CPROX_INVALID, "%zu vertices, at most %zu are possible", n, most);
  return CPROX_OK;
}

/* ---- making ---- */

cprox_body *body_allocate(const convex_ops *ops, cprox_body_kind kind) {
  cprox_body *body = calloc(1, sizeof *body);
  if (!body) return NULL;
  body->kind = kind;
  body->shape.ops = ops;
  body->shape.scale = LEAST_LENGTH;
  return body;
}

cprox_status body_out_of_memory(cprox_workspace *workspace) {
  return workspace_fail(workspace, CPROX_MEMORY, "no memory for a body");
}

static double round_up(double length) {
  return length * (1.0 + ROUND_LENGTH * ROUND_U);
}

/* A primitive about the origin: its sizes, its margin, and the radius of a ball about the origin that holds it. */
static cprox_status body_create_primitive(const convex_ops *ops, const double size[3], double margin, double reach,
                                          cprox_workspace *workspace, cprox_body **body) {
  cprox_body *made = body_allocate(ops, ops->kind);
  if (!made) return body_out_of_memory(workspace);
  memcpy(made->shape.size, size, 3 * sizeof *size);
  made->shape.margin = margin;
  made->shape.scale = made->ball_radius = round_up(reach);
  *body = made;
  return CPROX_OK;
}

cprox_status cprox_body_create_point(cprox_vec3 point, cprox_workspace *workspace, cprox_body **body) {
  WORKSPACE_USE(workspace);
  cprox_status status;
  if ((status = check_out(body, workspace)) || (status = check_point("the point", point, workspace))) return status;
  cprox_body *made = body_allocate(&convex_point, CPROX_BODY_POINT);
  if (!made) return body_out_of_memory(workspace);
  made->centre = made->ball_centre = point;
  *body = made;
  return CPROX_OK;
}

cprox_status cprox_body_create_sphere(double radius, cprox_workspace *workspace, cprox_body **body) {
  WORKSPACE_USE(workspace);
  cprox_status status;
  if ((status = check_out(body, workspace)) || (status = check_length("radius", radius, workspace))) return status;
  return body_create_primitive(&convex_sphere, (double[3]){radius, 0, 0}, radius, radius, workspace, body);
}

cprox_status cprox_body_create_box(cprox_vec3 size, cprox_workspace *workspace, cprox_body **body) {
  WORKSPACE_USE(workspace);
  cprox_status status;
  if ((status = check_out(body, workspace)) || (status = check_length("size.x", size.x, workspace)) ||
      (status = check_length("size.y", size.y, workspace)) || (status = check_length("size.z", size.z, workspace)))
    return status;
  const vec3 half = vec_scale(0.5, size);
  return body_create_primitive(&convex_box, (double[3]){half.x, half.y, half.z}, 0.0, vec_norm(half), workspace, body);
}

static cprox_status check_height_and_radius(double height, double radius, cprox_workspace *workspace,
                                            cprox_body **body) {
  cprox_status status;
  if ((status = check_out(body, workspace)) || (status = check_length("height", height, workspace))) return status;
  return check_length("radius", radius, workspace);
}

cprox_status cprox_body_create_capsule(double height, double radius, cprox_workspace *workspace, cprox_body **body) {
  WORKSPACE_USE(workspace);
  const cprox_status status = check_height_and_radius(height, radius, workspace, body);
  if (status) return status;
  const double half = 0.5 * height;
  return body_create_primitive(&convex_capsule, (double[3]){radius, half, 0}, radius, half + radius, workspace, body);
}

cprox_status cprox_body_create_cylinder(double height, double radius, cprox_workspace *workspace, cprox_body **body) {
  WORKSPACE_USE(workspace);
  const cprox_status status = check_height_and_radius(height, radius, workspace, body);
  if (status) return status;
  const double half = 0.5 * height;
  return body_create_primitive(&convex_cylinder, (double[3]){radius, half, 0}, 0.0, feature_hypot(radius, half),
                               workspace, body);
}

cprox_status cprox_body_create_cone(double height, double radius, cprox_workspace *workspace, cprox_body **body) {
  WORKSPACE_USE(workspace);
  const cprox_status status = check_height_and_radius(height, radius, workspace, body);
  if (status) return status;
  const double half = 0.5 * height;
  return body_create_primitive(&convex_cone, (double[3]){radius, half, 0}, 0.0, feature_hypot(radius, half), workspace,
                               body);
}

cprox_status cprox_body_create_ellipsoid(cprox_vec3 semi_axes, cprox_workspace *workspace, cprox_body **body) {
  WORKSPACE_USE(workspace);
  cprox_status status;
  if ((status = check_out(body, workspace)) || (status = check_length("semi_axes.x", semi_axes.x, workspace)) ||
      (status = check_length("semi_axes.y", semi_axes.y, workspace)) ||
      (status = check_length("semi_axes.z", semi_axes.z, workspace)))
    return status;
  const double most = fmax(semi_axes.x, fmax(semi_axes.y, semi_axes.z));
  const double least = fmin(semi_axes.x, fmin(semi_axes.y, semi_axes.z));
  if (most > 1e6 * least)
    return workspace_fail(workspace, CPROX_INVALID, "semi-axis %g is more than 1e6 times semi-axis %g", most, least);
  return body_create_primitive(&convex_ellipsoid, (double[3]){semi_axes.x, semi_axes.y, semi_axes.z},
                               least * (least / most), most, workspace, body);
}

cprox_status cprox_body_create_halfspace(cprox_vec3 normal, double offset, cprox_workspace *workspace,
                                         cprox_body **body) {
  WORKSPACE_USE(workspace);
  cprox_status status;
  if ((status = check_out(body, workspace)) || (status = check_point("normal", normal, workspace))) return status;
  if (!isfinite(offset)) return workspace_fail(workspace, CPROX_INVALID, "offset is %g, must be finite", offset);
  vec3 unit;
  const double norm = feature_unit(normal, &unit);
  if (!(norm > 0.0)) return workspace_fail(workspace, CPROX_INVALID, "normal is (0, 0, 0)");
  const double distance = offset / norm;
  if (!(fabs(distance) <= MOST_LENGTH))
    return workspace_fail(workspace, CPROX_INVALID, "offset/|normal| is %g, must be at most %g", distance, MOST_LENGTH);
  status = body_create_primitive(&convex_halfspace, (double[3]){unit.x, unit.y, unit.z}, 0.0, fabs(distance), workspace,
                                 body);
  if (status) return status;
  (*body)->shape.size[3] = distance;
  (*body)->ball_radius = INFINITY;
  return CPROX_OK;
}

/* ---- vertex sets ---- */

/* Stores n vertices about the middle of their box; the arrays are one block, padded with the last vertex. */
static cprox_status body_store_vertices(cprox_body *made, const vec3 *vertices, size_t n) {
  const size_t padded = (n + 7) / 8 * 8;
  double *memory = malloc(3 * padded * sizeof *memory);
  if (!memory) return CPROX_MEMORY;
  convex *shape = &made->shape;
  shape->n = (int32_t)n;
  shape->padded = (int32_t)padded;
  shape->x = memory;
  shape->y = memory + padded;
  shape->z = memory + 2 * padded;

  vec3 low = vertices[0], high = vertices[0];
  for (size_t i = 1; i < n; i++) {
    low = vec(fmin(low.x, vertices[i].x), fmin(low.y, vertices[i].y), fmin(low.z, vertices[i].z));
    high = vec(fmax(high.x, vertices[i].x), fmax(high.y, vertices[i].y), fmax(high.z, vertices[i].z));
  }
  made->centre = made->ball_centre = vec_axpy(vec_scale(0.5, low), 0.5, high);

  double reach = LEAST_LENGTH;
  for (size_t i = 0; i < padded; i++) {
    const vec3 v = vec_sub(vertices[i < n ? i : n - 1], made->centre);
    vec3 unused;
    shape->x[i] = v.x;
    shape->y[i] = v.y;
    shape->z[i] = v.z;
    reach = fmax(reach, feature_unit(v, &unused));
  }
  shape->scale = made->ball_radius = round_up(reach);
  return CPROX_OK;
}

cprox_status cprox_body_create_polytope(const cprox_vec3 *vertices, size_t n, cprox_workspace *workspace,
                                        cprox_body **body) {
  WORKSPACE_USE(workspace);
  cprox_status status;
  if ((status = check_out(body, workspace)) || (status = check_vertices(n, workspace))) return status;
  if (n == 0) return workspace_fail(workspace, CPROX_INVALID, "a polytope needs at least 1 vertex, got none");
  if (!vertices) return workspace_fail(workspace, CPROX_INVALID, "vertices is NULL");
  for (size_t i = 0; i < n; i++) {
    char name[32];
    snprintf(name, sizeof name, "vertex %zu", i);
    if ((status = check_point(name, vertices[i], workspace))) return status;
  }
  cprox_body *made = body_allocate(&convex_polytope, CPROX_BODY_POLYTOPE);
  if (!made || body_store_vertices(made, vertices, n)) {
    cprox_body_free(made);
    return body_out_of_memory(workspace);
  }
  *body = made;
  return CPROX_OK;
}

/* Distinct neighbours only, counter-clockwise. Returns how many remain. */
static size_t polygon_clean(const double (*vertices)[2], size_t n, bool clockwise, vec3 *clean) {
  size_t kept = 0;
  for (size_t i = 0; i < n; i++) {
    const double *v = vertices[clockwise ? n - 1 - i : i];
    const vec3 p = vec(v[0], v[1], 0);
    if (kept == 0 || !vec_equal(p, clean[kept - 1])) clean[kept++] = p;
  }
  while (kept > 1 && vec_equal(clean[0], clean[kept - 1])) kept--;
  return kept;
}

/* Twice the signed area, about the first vertex so that sizes and not positions enter its rounding. */
static double polygon_area2(const double (*vertices)[2], size_t n, double *size2) {
  double area2 = 0.0;
  *size2 = 0.0;
  for (size_t i = 1; i + 1 < n; i++) {
    const double ax = vertices[i][0] - vertices[0][0], ay = vertices[i][1] - vertices[0][1];
    const double bx = vertices[i + 1][0] - vertices[0][0], by = vertices[i + 1][1] - vertices[0][1];
    area2 += ax * by - ay * bx;
    *size2 = fmax(*size2, fmax(ax * ax + ay * ay, bx * bx + by * by));
  }
  return area2;
}

/* Every turn to the left, and once round in all. A turn that is all rounding counts as straight. */
static cprox_status polygon_check_turns(const vec3 *v, size_t n, cprox_workspace *workspace) {
  double turned = 0.0;
  for (size_t i = 0; i < n; i++) {
    const vec3 b = v[(i + 1) % n], in = vec_sub(b, v[i]), out = vec_sub(v[(i + 2) % n], b);
    const double cross = in.x * out.y - in.y * out.x, along = in.x * out.x + in.y * out.y;
    const double noise = 16.0 * ROUND_U * sqrt(vec_norm2(in) * vec_norm2(out));
    if (cross < -noise)
      return workspace_fail(workspace, CPROX_INVALID,
                            "the polygon is not convex: it turns to the other side at (%g, %g)", b.x, b.y);
    if (cross <= noise && along < 0.0)
      return workspace_fail(workspace, CPROX_INVALID, "the polygon is not convex: it turns back at (%g, %g)", b.x, b.y);
    turned += atan2(cross, along);
  }
  if (turned > 7.0) /* 2 pi, or 4 pi and more */
    return workspace_fail(workspace, CPROX_INVALID, "the polygon is not convex: it winds round %.0f times",
                          turned / 6.2832);
  return CPROX_OK;
}

cprox_status cprox_body_create_polygon(const double (*vertices)[2], size_t n, cprox_workspace *workspace,
                                       cprox_body **body) {
  WORKSPACE_USE(workspace);
  cprox_status status;
  if ((status = check_out(body, workspace)) || (status = check_vertices(n, workspace))) return status;
  if (n < 3) return workspace_fail(workspace, CPROX_INVALID, "a polygon needs at least 3 vertices, got %zu", n);
  if (!vertices) return workspace_fail(workspace, CPROX_INVALID, "vertices is NULL");
  for (size_t i = 0; i < n; i++) {
    char name[32];
    snprintf(name, sizeof name, "vertex %zu", i);
    if ((status = check_point(name, vec(vertices[i][0], vertices[i][1], 0), workspace))) return status;
  }
  double size2;
  const double area2 = polygon_area2(vertices, n, &size2);
  if (!(fabs(area2) > 1024.0 * ROUND_U * size2))
    return workspace_fail(workspace, CPROX_INVALID, "the polygon's area is %g, must be > 0", 0.5 * fabs(area2));

  cprox_body *made = body_allocate(&convex_polygon, CPROX_BODY_POLYGON);
  vec3 *clean = malloc(n * sizeof *clean);
  if (made && clean) {
    const size_t kept = polygon_clean(vertices, n, area2 < 0.0, clean);
    status = polygon_check_turns(clean, kept, workspace);
    if (!status) {
      if (body_store_vertices(made, clean, kept) || !convex_polygon_measure_edges(&made->shape))
        status = body_out_of_memory(workspace);
    }
  } else {
    status = body_out_of_memory(workspace);
  }
  free(clean);
  if (status) {
    cprox_body_free(made);
    return status;
  }
  *body = made;
  return CPROX_OK;
}

cprox_status cprox_body_create_support(cprox_support_fn support, const void *shape, cprox_vec3 centre, double radius,
                                       double slack, double margin, cprox_workspace *workspace, cprox_body **body) {
  WORKSPACE_USE(workspace);
  cprox_status status;
  if ((status = check_out(body, workspace))) return status;
  if (!support) return workspace_fail(workspace, CPROX_INVALID, "support is NULL");
  if ((status = check_point("centre", centre, workspace)) || (status = check_length("radius", radius, workspace)) ||
      (status = check_not_negative("slack", slack, workspace)) ||
      (status = check_not_negative("margin", margin, workspace)))
    return status;
  status = body_create_primitive(&convex_support_callback, (double[3]){radius, 0, 0}, margin, radius + slack + margin,
                                 workspace, body);
  if (status) return status;
  cprox_body *made = *body;
  made->centre = made->ball_centre = made->shape.user_centre = centre;
  /* the callback's points are taken about the centre: so much may be lost of them */
  made->shape.slack = made->shape.outside = slack + ROUND_U * radius;
  made->shape.callback = support;
  made->shape.user = shape;
  return CPROX_OK;
}

void cprox_body_free(cprox_body *body) {
  if (!body) return;
  free(body->shape.x); /* y and z are in the same block */
  free(body->shape.edge);
  free(body->parts);
  free(body->shape.implicit); /* one block */
  if (!body->borrows_tree) tree_free(body->tree);
  winding_free(body->winding);
  cluster_hulls_free(body->clusters);
  distance_field_free(body->field);
  free(body->function);
  free(body);
}

/* ---- queries ---- */

cprox_body_info cprox_body_get_info(const cprox_body *body) {
  return (cprox_body_info){.kind = body->kind,
                           .is_solid = elements_are_solid(body),
                           .bytes = elements_bytes(body),
                           .centre = body->ball_centre,
                           .radius = body->ball_radius};
}
