/* SPDX-License-Identifier: BSD-3-Clause */
/* A solid cone about z: apex at +half height, base disc at -half height. size: radius, half height. */
#include "convex/feature.h"

/* In the meridian plane (rho, z) the cone is a right triangle. Apex and rim are told apart first, each in coordinates
 * about itself: about a blunt rim or a sharp apex the height over the side alone is too faint to say who is inside. */
static void cone_nearest(const convex *shape, vec3 y, convex_hint *hint, convex_near *near) {
  (void)hint;
  const double radius = shape->size[0], half = shape->size[1], height = 2.0 * half;
  const double rho = feature_hypot(y.x, y.y);
  const double cx = rho > 0.0 ? y.x / rho : 1.0, cy = rho > 0.0 ? y.y / rho : 0.0;
  const double a = rho - radius, b = y.z + half; /* from the rim */
  const double c = y.z - half;                   /* from the apex */
  const double slant = feature_hypot(radius, height);
  const double s = (rho * height + c * radius) / slant; /* over the side */
  *near = (convex_near){0};

  if (a <= 0.0 && (b < 0.0 || s <= -b)) { /* the base, from outside or from inside */
    near->distance = -b;
    near->point = vec(y.x, y.y, -half);
    near->normal = vec(0, 0, -1);
    feature_face(near, vec(0, 1, 0), vec(1, 0, 0));
  } else if (b * height <= a * radius) { /* the rim */
    const double d = feature_hypot(a, b);
    near->distance = d;
    near->point = vec(cx * radius, cy * radius, -half);
    near->normal = d > 0.0 ? vec(cx * (a / d), cy * (a / d), b / d) : vec(0, 0, -1);
    feature_axial(near, y.x, y.y, d > 0.0 ? a / d : 0.0, d > 0.0 ? b / d : -1.0, d > 0.0 ? 1.0 / d : 0.0);
  } else if (c * height >= rho * radius) { /* the apex */
    const vec3 apex = vec(0, 0, half);
    near->distance = feature_unit(vec_sub(y, apex), &near->normal);
    if (near->distance == 0.0) near->normal = vec(0, 0, 1);
    near->point = apex;
    feature_vertex(near, apex, 0.0);
  } else { /* the side, from outside or from inside */
    const double nr = height / slant, nz = radius / slant;
    /* from the nearer end of the slant; rounding must not carry the point past an end */
    const double from_apex = fmin(fmax((rho * radius - c * height) / slant, 0.0), slant);
    near->distance = s;
    near->point = vec(cx * (from_apex * nz), cy * (from_apex * nz), half - from_apex * nr);
    near->normal = vec(cx * nr, cy * nr, nz);
    feature_axial(near, y.x, y.y, nr, nz, 0.0);
  }
}

static vec3 cone_rim(const convex *shape, vec3 d) {
  const double radius = shape->size[0], e = feature_hypot(d.x, d.y);
  return e > 0.0 ? vec(radius * (d.x / e), radius * (d.y / e), -shape->size[1]) : vec(radius, 0, -shape->size[1]);
}

static double cone_support(const convex *shape, vec3 d, convex_hint *hint, vec3 *at) {
  (void)hint;
  const double half = shape->size[1];
  const double apex = half * d.z, rim = shape->size[0] * feature_hypot(d.x, d.y) - half * d.z;
  if (at) *at = apex > rim ? vec(0, 0, half) : cone_rim(shape, d);
  return fmax(apex, rim);
}

static vec3 cone_follow(const convex *shape, vec3 d, vec3 x) {
  return x.z > 0.0 ? x : cone_rim(shape, d);
}

static void cone_curvature(const convex *shape, vec3 d, vec3 x, double hessian[6]) {
  for (int i = 0; i < 6; i++) hessian[i] = 0.0;
  const double e = feature_hypot(d.x, d.y);
  if (x.z > 0.0 || e == 0.0) return;
  const double k = shape->size[0] / e, tx = -d.y / e, ty = d.x / e;
  hessian[0] = k * tx * tx;
  hessian[1] = k * tx * ty;
  hessian[3] = k * ty * ty;
}

/* Onto the slant: as far from the apex as the foot of the perpendicular, which stays on it whatever rounding does to
 * that. */
static void cone_project_on_slant(const convex *shape, vec3 y, double rho, convex_foot *foot) {
  const double radius = shape->size[0], half = shape->size[1], height = 2.0 * half;
  const double slant = feature_hypot(radius, height), nr = height / slant, nz = radius / slant;
  const double from_apex = (rho * radius - (y.z - half) * height) / slant, f = fmin(fmax(from_apex, 0.0), slant);
  const double cx = y.x / rho, cy = y.y / rho;
  foot->point = vec(cx * (f * nz), cy * (f * nz), half - f * nr);
  foot->tangents = f > 0.0 ? 2 : 0;
  foot->e[0] = vec(-cy, cx, 0), foot->e[1] = vec(cx * nz, cy * nz, -nr);
  foot->along[0] = f * nz / rho, foot->along[1] = 1.0;
}

static void cone_project(const convex *shape, vec3 y, convex_foot *foot) {
  const double radius = shape->size[0], half = shape->size[1], height = 2.0 * half;
  const double rho = feature_hypot(y.x, y.y), a = rho - radius, b = y.z + half, c = y.z - half;
  foot->along[0] = foot->along[1] = 1.0;
  if (a <= 0.0 && b <= 0.0) { /* the base */
    foot->point = vec(y.x, y.y, -half);
    foot->tangents = 2;
    foot->e[0] = vec(1, 0, 0), foot->e[1] = vec(0, 1, 0);
  } else if (b > 0.0 && rho * height + c * radius <= 0.0) {
    foot->point = y;
    foot->tangents = 3;
    foot->e[0] = vec(1, 0, 0), foot->e[1] = vec(0, 1, 0);
  } else if (b * height <= a * radius) { /* the rim */
    const double cx = y.x / rho, cy = y.y / rho;
    foot->point = vec(cx * radius, cy * radius, -half);
    foot->tangents = 1;
    foot->e[0] = vec(-cy, cx, 0);
    foot->along[0] = radius / rho;
  } else if (c * height >= rho * radius) {
    foot->point = vec(0, 0, half);
    foot->tangents = 0;
  } else {
    cone_project_on_slant(shape, y, rho, foot);
  }
}

/* near_rounding: rho (2u) times height (u), plus c (u) times radius (u), a sum (u), over slant (2u), a quotient (u): 7u
 * of rho and 6u of |c|, at most 10u of |y| + scale. A region mistaken by rounding changes the distance by as little,
 * since each test compares coordinates that are exact to u about the feature it decides for. */
const convex_ops convex_cone = {.kind = CPROX_BODY_CONE,
                                .near_rounding = 12.0,
                                .closed_form = true,
                                .round_core = CONVEX_ALWAYS_ROUND,
                                .nearest = cone_nearest,
                                .support = cone_support,
                                .project = cone_project,
                                .curvature = cone_curvature,
                                .follow = cone_follow};
