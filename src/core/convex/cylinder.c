/* SPDX-License-Identifier: BSD-3-Clause */
/* A solid cylinder about z. size: radius, half height. */
#include "base/rounding.h"
#include "convex/feature.h"

static void cylinder_nearest(const convex *shape, vec3 y, convex_hint *hint, convex_near *near) {
  (void)hint;
  const double radius = shape->size[0], half = shape->size[1];
  const double rho = feature_hypot(y.x, y.y), side = y.z < 0.0 ? -1.0 : 1.0;
  const double cx = rho > 0.0 ? y.x / rho : 1.0, cy = rho > 0.0 ? y.y / rho : 0.0;
  const double a = rho - radius, b = fabs(y.z) - half; /* over the side, over the cap */
  *near = (convex_near){0};

  if (a > 0.0 && b > 0.0) { /* the rim */
    const double d = feature_hypot(a, b);
    near->distance = d;
    near->point = vec(cx * radius, cy * radius, side * half);
    near->normal = vec(cx * (a / d), cy * (a / d), side * (b / d));
    feature_axial(near, y.x, y.y, a / d, side * (b / d), 1.0 / d);
  } else if (a >= b) { /* the side, from outside or from inside */
    near->distance = a;
    near->point = vec(cx * radius, cy * radius, y.z);
    near->normal = vec(cx, cy, 0);
    feature_edge(near, vec(0, 0, 0), vec(0, 0, 1), radius);
  } else { /* a cap */
    near->distance = b;
    near->point = vec(y.x, y.y, side * half);
    near->normal = vec(0, 0, side);
    feature_face(near, vec(1, 0, 0), vec(0, 1, 0));
  }
}

static vec3 cylinder_rim(const convex *shape, vec3 d, double z) {
  const double radius = shape->size[0], e = feature_hypot(d.x, d.y);
  return e > 0.0 ? vec(radius * (d.x / e), radius * (d.y / e), z) : vec(radius, 0, z);
}

static double cylinder_support(const convex *shape, vec3 d, convex_hint *hint, vec3 *at) {
  (void)hint;
  const double half = shape->size[1];
  if (at) *at = cylinder_rim(shape, d, copysign(half, d.z));
  return shape->size[0] * feature_hypot(d.x, d.y) + half * fabs(d.z);
}

static vec3 cylinder_follow(const convex *shape, vec3 d, vec3 x) {
  return cylinder_rim(shape, d, x.z);
}

static void cylinder_curvature(const convex *shape, vec3 d, vec3 x, double hessian[6]) {
  (void)x;
  /* (r/e) tau tau^T, tau = (-dy, dx, 0)/e; along the axis itself the rim has no direction of its own */
  const double e = feature_hypot(d.x, d.y);
  const double k = e > 0.0 ? shape->size[0] / e : 0.0, tx = e > 0.0 ? -d.y / e : 0.0, ty = e > 0.0 ? d.x / e : 0.0;
  hessian[0] = k * tx * tx;
  hessian[1] = k * tx * ty;
  hessian[3] = k * ty * ty;
  hessian[2] = hessian[4] = hessian[5] = 0.0;
}

static bool cylinder_cover(const convex *shape, const convex_near *near, convex_cover *cover) {
  if (!near->flat || near->tangents != 1) return false;
  *cover = (convex_cover){.axis = {0, 0, 1}, .cylinder = true, .radius = shape->size[0]};
  return true;
}

static void cylinder_project(const convex *shape, vec3 y, convex_foot *foot) {
  const double radius = shape->size[0], half = shape->size[1], rho = feature_hypot(y.x, y.y);
  const bool beside = rho > radius, between = fabs(y.z) < half;
  const double z = between ? y.z : copysign(half, y.z);
  if (!beside) { /* a cap, from outside or from inside */
    foot->point = vec(y.x, y.y, z);
    foot->tangents = between ? 3 : 2;
    foot->e[0] = vec(1, 0, 0), foot->e[1] = vec(0, 1, 0);
    foot->along[0] = foot->along[1] = 1.0;
    return;
  }
  const double cx = y.x / rho, cy = y.y / rho;
  foot->point = vec(cx * radius, cy * radius, z);
  foot->tangents = between ? 2 : 1;
  foot->e[0] = vec(-cy, cx, 0), foot->e[1] = vec(0, 0, 1);
  foot->along[0] = radius / rho, foot->along[1] = 1.0;
}

/* near_rounding: rho (2u), two differences (u), a norm (2u), each of at most |y| + scale. */
const convex_ops convex_cylinder = {.kind = CPROX_BODY_CYLINDER,
                                    .near_rounding = 8.0,
                                    .closed_form = true,
                                    .round_core = CONVEX_ALWAYS_ROUND,
                                    .nearest = cylinder_nearest,
                                    .support = cylinder_support,
                                    .project = cylinder_project,
                                    .curvature = cylinder_curvature,
                                    .follow = cylinder_follow,
                                    .cover = cylinder_cover};
