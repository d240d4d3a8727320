/* SPDX-License-Identifier: BSD-3-Clause */
/* A planar convex polygon in z = 0, vertices counter-clockwise: x, y; z is 0. */
#include "convex/feature.h"
#include "convex/vertices.h"

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
  *ex = shape->edge[i];
  *ey = shape->edge[shape->n + i];
  *length = shape->edge[2 * shape->n + i];
  const double ax = px - shape->x[i], ay = py - shape->y[i];
  *along = ax * *ex + ay * *ey;
  if (*along < 0.5 * *length) return ax * *ey - ay * *ex;
  const int32_t j = i + 1 < shape->n ? i + 1 : 0;
  return (px - shape->x[j]) * *ey - (py - shape->y[j]) * *ex;
}

void convex_polygon_measure_edges(convex *shape) {
  for (int32_t i = 0; i < shape->n; i++) {
    const int32_t j = i + 1 < shape->n ? i + 1 : 0;
    const double ex = shape->x[j] - shape->x[i], ey = shape->y[j] - shape->y[i], length = feature_hypot(ex, ey);
    shape->edge[i] = ex / length;
    shape->edge[shape->n + i] = ey / length;
    shape->edge[2 * shape->n + i] = length;
  }
}

static polygon_place polygon_locate(const convex *shape, double px, double py) {
  polygon_place place = {.inside = -INFINITY, .boundary = INFINITY};
  for (int32_t i = 0; i < shape->n; i++) {
    double ex, ey, along, length;
    const double height = polygon_height(shape, i, px, py, &ex, &ey, &along, &length);
    if (height > place.inside) {
      place.inside = height;
      place.line = i;
    }
    /* each vertex is looked at once, as the first of its edge */
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

/* Inside, the least depth under an edge's line is the distance from the boundary; outside, some line is passed. Comparing
 * the two tells them apart wherever it matters: a sharp corner's lines alone are too faint beyond its tip. */
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

/* near_rounding: vertices about the centre (u), a difference (u), an edge's direction (3u), a product (3u), a norm (3u). */
const convex_ops convex_polygon = {.kind = CPROX_POLYGON,
                                   .near_rounding = 16.0,
                                   .nearest = polygon_nearest,
                                   .support = vertices_support,
                                   .cover = vertices_cover};
