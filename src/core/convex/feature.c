/* SPDX-License-Identifier: BSD-3-Clause */
#include "convex/feature.h"

#include "base/rounding.h"

void feature_vertex(convex_near *near, vec3 origin, double offset) {
  near->flat = true;
  near->tangents = 0;
  near->origin = origin;
  near->offset = offset;
}

void feature_edge(convex_near *near, vec3 origin, vec3 axis, double offset) {
  near->flat = true;
  near->tangents = 1;
  near->e[0] = axis;
  near->origin = origin;
  near->offset = offset;
}

void feature_face(convex_near *near, vec3 e, vec3 f) {
  /* |w| has no sign: from inside the origin is set as deep again below y, and the offset takes that back */
  const double sunk = near->distance < 0.0 ? -2.0 * near->distance : 0.0;
  near->flat = true;
  near->tangents = 2;
  near->e[0] = e;
  near->e[1] = f;
  near->origin = vec_axpy(near->point, -sunk, near->normal);
  near->offset = sunk;
}

void feature_axial(convex_near *near, double x, double y, double radial, double axial, double in_meridian) {
  const double rho = feature_hypot(x, y);
  const double cx = rho > 0.0 ? x / rho : 1.0, cy = rho > 0.0 ? y / rho : 0.0;
  const double round = rho > 0.0 ? radial / rho : 0.0;
  const vec3 t = vec(-axial * cx, -axial * cy, radial);
  near->flat = false;
  near->tangents = 0;
  near->hessian[0] = in_meridian * t.x * t.x + round * cy * cy;
  near->hessian[1] = in_meridian * t.x * t.y - round * cx * cy;
  near->hessian[2] = in_meridian * t.x * t.z;
  near->hessian[3] = in_meridian * t.y * t.y + round * cx * cx;
  near->hessian[4] = in_meridian * t.y * t.z;
  near->hessian[5] = in_meridian * t.z * t.z;
}

/* The part of v orthogonal to the cover's axis, if it has one. */
static vec3 partition_across(const convex_cover *cover, vec3 v) {
  return cover->cylinder ? vec_axpy(v, -vec_dot(cover->axis, v), cover->axis) : v;
}

bool feature_cover(const convex_near *near, int32_t n, const double *x, const double *y, const double *z, double scale,
                   convex_cover *cover) {
  const vec3 b = near->point, normal = near->normal;
  if (!near->flat || near->tangents > 1 || vec_norm2(normal) == 0.0) return false;
  cover->cylinder = near->tangents == 1;
  cover->axis = near->e[0];

  /* the least R whose ball about b - R n reaches every vertex: |b - w|² <= 2 R n·(b - w). Vertices on the feature
   * itself fall upon b. */
  const double same = 64.0 * ROUND_U * scale;
  double radius = 0.0;
  for (int32_t i = 0; i < n; i++) {
    const vec3 w = partition_across(cover, vec_sub(b, vec(x[i], y[i], z[i])));
    const double w2 = vec_norm2(w), along = vec_dot(normal, w);
    if (w2 <= same * same) continue;
    if (w2 > 2e6 * scale * along) return false; /* so flat that the ball says no more than the plane */
    radius = greater(w2 / (2.0 * along), radius);
  }

  /* measured again, over all of them: what the rounding of b, n and R did to it is in the measure */
  cover->centre = vec_axpy(b, -radius, normal);
  double measured = 0.0;
  for (int32_t i = 0; i < n; i++) {
    const vec3 w = partition_across(cover, vec_sub(vec(x[i], y[i], z[i]), cover->centre));
    measured = greater(vec_norm2(w), measured);
  }
  cover->radius = sqrt(measured) * (1.0 + ROUND_LENGTH * ROUND_U) + 16.0 * ROUND_U * (radius + 2.0 * scale);
  return true;
}
