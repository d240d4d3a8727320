/* SPDX-License-Identifier: BSD-3-Clause */
/* A planar convex polygon in z = 0, vertices counter-clockwise: x, y; z is 0. */
#include <stdlib.h>

#include "convex/feature.h"
#include "convex/vertices.h"
#include "simd/dispatch.h"

enum { LANES = 8 }; /* the arrays are padded to a multiple of this */

/* What the edges say of a point p of the plane. */
typedef struct polygon_place {
  double inside;   /* the greatest signed distance from an edge's line: at most 0 inside */
  int32_t line;    /* whose line that was */
  double boundary; /* the distance from the nearest edge */
  int32_t edge;
  bool vertex;   /* nearest at the edge's first vertex rather than between its ends */
  double height; /* signed distance from that edge's line */
} polygon_place;

/* Signed distance of p from the line of edge i, measured from the nearer end so that it is exact to u about either. */
static double polygon_height(const convex *shape, int32_t i, double px, double py, double *ex, double *ey,
                             double *along, double *length) {
  const double *edge = shape->edge + i;
  const int32_t stride = shape->padded;
  *ex = edge[0];
  *ey = edge[stride];
  *length = edge[2 * stride];
  const double ax = px - shape->x[i], ay = py - shape->y[i];
  *along = ax * *ex + ay * *ey;
  if (*along < 0.5 * *length) return ax * *ey - ay * *ex;
  return (px - edge[3 * stride]) * *ey - (py - edge[4 * stride]) * *ex;
}

bool convex_polygon_measure_edges(convex *shape) {
  const int32_t stride = shape->padded;
  shape->edge = malloc(5 * (size_t)stride * sizeof *shape->edge);
  if (!shape->edge) return false;
  for (int32_t k = 0; k < stride; k++) {
    const int32_t i = k < shape->n ? k : shape->n - 1, j = i + 1 < shape->n ? i + 1 : 0;
    const double ex = shape->x[j] - shape->x[i], ey = shape->y[j] - shape->y[i], length = feature_hypot(ex, ey);
    const double edge[5] = {ex / length, ey / length, length, shape->x[j], shape->y[j]};
    for (int m = 0; m < 5; m++) shape->edge[m * stride + k] = edge[m];
  }
  return true;
}

/* The greatest height over an edge's line, and the least square distance from an edge, of each lane, and which edges
 * those are; indices are kept as doubles so that a lane is as wide as its value. */
typedef struct polygon_lanes {
  double height[LANES], line[LANES], square[LANES], edge[LANES];
} polygon_lanes;

SIMD_CLONES
static void polygon_nearest_edges(const convex *shape, double px, double py, polygon_lanes *best) {
  const int32_t stride = shape->padded;
  polygon_lanes b;
  for (int l = 0; l < LANES; l++) {
    b.height[l] = -INFINITY, b.square[l] = INFINITY;
    b.line[l] = b.edge[l] = 0.0;
  }
  for (int32_t i = 0; i < stride; i += LANES) {
    const double *restrict x = shape->x + i, *restrict y = shape->y + i, *restrict edge = shape->edge + i;
    const double base = i;
#pragma omp simd
    for (int l = 0; l < LANES; l++) {
      const double ex = edge[l], ey = edge[stride + l], length = edge[2 * stride + l];
      const double ax = px - x[l], ay = py - y[l];
      const double bx = px - edge[3 * stride + l], by = py - edge[4 * stride + l];
      const double along = ax * ex + ay * ey;
      const double from_a = ax * ey - ay * ex, from_b = bx * ey - by * ex;
      const double height = along < 0.5 * length ? from_a : from_b;
      /* each vertex is looked at once, as the first of its edge */
      const double between = along >= length ? INFINITY : height * height;
      const double square = along <= 0.0 ? ax * ax + ay * ay : between;
      b.line[l] = height > b.height[l] ? base : b.line[l];
      b.height[l] = height > b.height[l] ? height : b.height[l];
      b.edge[l] = square < b.square[l] ? base : b.edge[l];
      b.square[l] = square < b.square[l] ? square : b.square[l];
    }
  }
  *best = b;
}

/* The same, an edge at a time and at every magnitude. */
static polygon_place polygon_locate_any(const convex *shape, double px, double py) {
  polygon_place place = {.inside = -INFINITY, .boundary = INFINITY};
  for (int32_t i = 0; i < shape->n; i++) {
    double ex, ey, along, length;
    const double height = polygon_height(shape, i, px, py, &ex, &ey, &along, &length);
    if (height > place.inside) {
      place.inside = height;
      place.line = i;
    }
    const bool vertex = along <= 0.0;
    if (!vertex && along >= length) continue;
    const double d = vertex ? feature_hypot(px - shape->x[i], py - shape->y[i]) : fabs(height);
    if (d >= place.boundary) continue;
    place.boundary = d;
    place.edge = i;
    place.vertex = vertex;
    place.height = height;
  }
  return place;
}

static polygon_place polygon_locate(const convex *shape, double px, double py) {
  polygon_lanes lanes;
  polygon_nearest_edges(shape, px, py, &lanes);
  int line = 0, edge = 0;
  double height = lanes.height[0], square = lanes.square[0];
  for (int l = 1; l < LANES; l++) {
    line = lanes.height[l] > height ? l : line;
    height = lanes.height[l] > height ? lanes.height[l] : height;
    edge = lanes.square[l] < square ? l : edge;
    square = lanes.square[l] < square ? lanes.square[l] : square;
  }
  if (!(square > FEATURE_LEAST_SQUARE && square < FEATURE_MOST_SQUARE)) return polygon_locate_any(shape, px, py);
  /* the margin repeats the last edge */
  const int32_t last = shape->n - 1;
  const int32_t on = (int32_t)lanes.line[line] + line, at = (int32_t)lanes.edge[edge] + edge;
  polygon_place place = {.inside = height, .line = on < last ? on : last, .edge = at < last ? at : last};
  double ex, ey, along, length;
  place.height = polygon_height(shape, place.edge, px, py, &ex, &ey, &along, &length);
  place.vertex = along <= 0.0;
  place.boundary = sqrt(square);
  return place;
}

/* Inside, the least depth under an edge's line is the distance from the boundary; outside, some line is passed.
 * Comparing the two tells them apart wherever it matters: a sharp corner's lines alone are too faint beyond its tip. */
static bool polygon_contains(const polygon_place *place) {
  return place->inside <= -0.5 * place->boundary;
}

/* Nearest feature of the boundary from outside, or from inside (height < 0), for a point at z over the plane. */
static void polygon_nearest_boundary(const convex *shape, const polygon_place *place, vec3 y, convex_near *near) {
  const int32_t i = place->edge;
  const vec3 a = vec(shape->x[i], shape->y[i], 0);
  if (place->vertex) {
    near->distance = feature_unit(vec_sub(y, a), &near->normal);
    near->point = a;
    feature_vertex(near, a, 0.0);
    return;
  }
  double ex, ey, along, length;
  const double height = polygon_height(shape, i, y.x, y.y, &ex, &ey, &along, &length);
  const double d = feature_hypot(height, y.z);
  near->distance = d;
  near->normal = d > 0.0 ? vec(ey * (height / d), -ex * (height / d), y.z / d) : vec(ey, -ex, 0);
  near->point = vec(a.x + along * ex, a.y + along * ey, 0);
  feature_edge(near, a, vec(ex, ey, 0), 0.0);
}

static void polygon_nearest(const convex *shape, vec3 y, convex_hint *hint, convex_near *near) {
  (void)hint;
  const polygon_place place = polygon_locate(shape, y.x, y.y);
  *near = (convex_near){0};
  if (!polygon_contains(&place)) {
    polygon_nearest_boundary(shape, &place, y, near);
    return;
  }
  near->distance = fabs(y.z);
  near->point = vec(y.x, y.y, 0);
  near->normal = vec(0, 0, y.z < 0.0 ? -1.0 : 1.0);
  feature_face(near, vec(1, 0, 0), vec(0, 1, 0));
}

void convex_polygon_nearest_in_plane(const convex *shape, vec3 y, convex_near *near) {
  const vec3 p = vec(y.x, y.y, 0);
  const polygon_place place = polygon_locate(shape, y.x, y.y);
  *near = (convex_near){0};
  if (!polygon_contains(&place)) {
    polygon_nearest_boundary(shape, &place, p, near);
    return;
  }
  double ex, ey, along, length;
  near->distance = polygon_height(shape, place.line, p.x, p.y, &ex, &ey, &along, &length);
  near->normal = vec(ey, -ex, 0);
  near->point = vec(shape->x[place.line] + along * ex, shape->y[place.line] + along * ey, 0);
  /* within the plane the edge is a face: along it and along z the distance does not change */
  feature_face(near, vec(ex, ey, 0), vec(0, 0, 1));
}

/* near_rounding: vertices about the centre (u), a difference (u), an edge's direction (3u), a product (3u), a norm
 * (3u). */
const convex_ops convex_polygon = {.kind = CPROX_BODY_POLYGON,
                                   .near_rounding = 16.0,
                                   .closed_form = true,
                                   .nearest = polygon_nearest,
                                   .support = vertices_support,
                                   .cover = vertices_cover};
