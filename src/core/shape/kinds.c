/* SPDX-License-Identifier: BSD-3-Clause */
#include "shape/kinds.h"

#include "base/rounding.h"
#include "convex/depth.h"
#include "convex/feature.h"
#include "shape/construct.h"
#include "shape/distance_field.h"
#include "shape/elements.h"

/* ---- one convex shape ---- */

static double convex_body_support(const cprox_body *body, vec3 direction, vec3 *point) {
  const convex *shape = &body->shape;
  vec3 at, unit;
  double h = shape->ops->support(shape, direction, NULL, &at);
  const double norm = feature_unit(direction, &unit);
  h += norm * shape->margin;
  at = vec_axpy(at, shape->margin, unit);
  if (point) *point = vec_add(at, body->centre);
  return h + vec_dot(direction, body->centre);
}

/* Any multiple of its normal will do. */
static double halfspace_body_support(const cprox_body *body, vec3 direction, vec3 *point) {
  const convex *shape = &body->shape;
  vec3 at, unit;
  shape->ops->support(shape, direction, NULL, &at);
  feature_unit(direction, &unit);
  const vec3 n = vec(shape->size[0], shape->size[1], shape->size[2]);
  const double off = vec_norm(vec_sub(unit, n));
  const double h = off <= 8.0 * ROUND_U ? vec_dot(direction, at) : INFINITY;
  if (point) *point = vec_add(at, body->centre);
  return h + vec_dot(direction, body->centre);
}

static double convex_body_nearest(const cprox_body *body, vec3 point, vec3 *nearest) {
  const vec3 y = vec_sub(point, body->centre);
  convex_near near;
  body->shape.ops->nearest(&body->shape, y, NULL, &near);
  depth_complete(&body->shape, y, &near);
  if (nearest) *nearest = vec_add(near.point, body->centre);
  return near.distance;
}

/* ---- levels of detail: the finest one ---- */

static double finest_support(const cprox_body *body, vec3 direction, vec3 *point) {
  return cprox_body_support(body->mesh, direction, point);
}

static double finest_nearest(const cprox_body *body, vec3 point, vec3 *nearest) {
  return cprox_body_nearest(body->mesh, point, nearest);
}

/* ---- sets known by their distance: the support of the ball round them ---- */

static double field_support(const cprox_body *body, vec3 direction, vec3 *point) {
  vec3 unit;
  const double norm = feature_unit(direction, &unit);
  if (point) *point = vec_axpy(body->ball_centre, body->ball_radius, unit);
  return vec_dot(direction, body->ball_centre) + norm * body->ball_radius;
}

static double field_nearest(const cprox_body *body, vec3 point, vec3 *nearest) {
  distance_value seen;
  vec3 normal;
  if (distance_field_measure(body->field, point, NULL, NULL, &seen) != CPROX_OK) return NAN;
  if (nearest) *nearest = distance_field_nearest(body->field, &seen, &normal);
  return seen.value;
}

/* ---- balls inside ---- */

static double first_size(const convex *shape) {
  return shape->size[0];
}

static double least_of_two(const convex *shape) {
  return fmin(shape->size[0], shape->size[1]);
}

static double least_of_three(const convex *shape) {
  return fmin(shape->size[0], fmin(shape->size[1], shape->size[2]));
}

static double inside_cone(const convex *shape) {
  const double *s = shape->size;
  return fmin(s[1], 0.999 * s[0] * s[1] / sqrt(s[0] * s[0] + 4.0 * s[1] * s[1]));
}

/* ---- the rows ---- */

#define CONVEX_BODY .support_of = convex_body_support, .nearest_of = convex_body_nearest
#define ELEMENTS .support_of = elements_support, .nearest_of = elements_nearest
#define SIZES(...) .n_sizes = sizeof((int[]){__VA_ARGS__}) / sizeof(int), .sizes = {__VA_ARGS__}

static const body_kind rows[] = {
    [CPROX_BODY_POINT] = {CONVEX_BODY, .name = "point", .is_own_sphere = true, .has_certificate = true},
    [CPROX_BODY_SPHERE] = {CONVEX_BODY, .name = "sphere", .has_cheap_depth = true, .is_own_sphere = true,
                           .has_certificate = true, SIZES(0), .inner_radius = first_size},
    [CPROX_BODY_BOX] = {CONVEX_BODY, .name = "box", .has_cheap_depth = true, .has_certificate = true, SIZES(0, 1, 2),
                        .inner_radius = least_of_three},
    [CPROX_BODY_CAPSULE] = {CONVEX_BODY, .name = "capsule", .has_cheap_depth = true, .has_certificate = true,
                            SIZES(1, 0), .inner_radius = first_size},
    [CPROX_BODY_CYLINDER] = {CONVEX_BODY, .name = "cylinder", .has_cheap_depth = true, .has_certificate = true,
                             SIZES(1, 0), .inner_radius = least_of_two},
    [CPROX_BODY_CONE] = {CONVEX_BODY, .name = "cone", .has_cheap_depth = true, .has_certificate = true, SIZES(1, 0),
                         .inner_radius = inside_cone},
    [CPROX_BODY_ELLIPSOID] = {CONVEX_BODY, .name = "ellipsoid", .has_cheap_depth = true, .has_certificate = true,
                              SIZES(0, 1, 2), .inner_radius = least_of_three},
    [CPROX_BODY_HALFSPACE] = {.support_of = halfspace_body_support,
                              .nearest_of = convex_body_nearest,
                              .name = "halfspace",
                              .has_certificate = true,
                              SIZES(0, 1, 2, 3)},
    [CPROX_BODY_POLYTOPE] = {CONVEX_BODY, .name = "polytope", .has_cheap_depth = true, .has_certificate = true},
    [CPROX_BODY_POLYGON] = {CONVEX_BODY, .name = "polygon", .has_cheap_depth = true, .has_certificate = true},
    [CPROX_BODY_COMPOUND] = {.support_of = compound_support, .nearest_of = compound_nearest, .name = "compound"},
    [CPROX_BODY_SUPPORT] = {CONVEX_BODY, .name = "support"},
    [CPROX_BODY_SUPERQUADRIC] = {CONVEX_BODY, .name = "superquadric"},
    [CPROX_BODY_IMPLICIT] = {CONVEX_BODY, .name = "implicit"},
    [CPROX_BODY_MESH] = {ELEMENTS, .name = "mesh"},
    [CPROX_BODY_POINTS] = {ELEMENTS, .name = "points", .is_own_sphere = true},
    [CPROX_BODY_OCTREE] = {ELEMENTS, .name = "octree", .is_own_sphere = true},
    [CPROX_BODY_LOD] = {.support_of = finest_support, .nearest_of = finest_nearest, .name = "lod"},
    [CPROX_BODY_DISTANCE] = {.support_of = field_support, .nearest_of = field_nearest, .name = "distance"},
    [CPROX_BODY_DISTANCE_GRID] = {.support_of = field_support, .nearest_of = field_nearest, .name = "distance grid"},
};

const body_kind *body_kind_of(cprox_body_kind kind) {
  return &rows[kind];
}

/* ---- the public queries ---- */

const char *cprox_body_kind_name(cprox_body_kind kind) {
  return (size_t)kind < sizeof rows / sizeof *rows ? rows[kind].name : "unknown";
}

double cprox_body_support(const cprox_body *body, cprox_vec3 direction, cprox_vec3 *point) {
  return rows[body->kind].support_of(body, direction, point);
}

double cprox_body_nearest(const cprox_body *body, cprox_vec3 point, cprox_vec3 *nearest) {
  return rows[body->kind].nearest_of(body, point, nearest);
}
