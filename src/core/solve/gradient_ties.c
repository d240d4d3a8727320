/* SPDX-License-Identifier: BSD-3-Clause */
#include "solve/gradient_ties.h"

#include "convex/feature.h"
#include "narrowphase/witness.h"

const double TIES_NEAR = 1e-6, TIES_FAR = 1e-4;

/* In sizes: nearest points are known to the root of what distances are, and
 * differences of normals likewise. */
static const double POINT_NOISE = 1e-6, NORMAL_NOISE = 2e-5;

/* What is smooth shrinks to a hundredth; the rest is left for rounding. */
static const double LEAST_LEFT = 0.03;

bool ties_is_jump(double near, double far, double noise) {
  return near > noise && near > LEAST_LEFT * far;
}

static cprox_status witness_of(const placed_bodies *p, const cprox_obstacle *a, const cprox_obstacle *b,
                               pair_witness *witness) {
  return pair_witness_of(a, p->part_a, b, p->part_b, p->finest, p->depth, p->workspace, witness);
}

/* Turned about a point by the small vector w. */
static cprox_pose turned_about(const cprox_pose *pose, vec3 centre, vec3 w) {
  /* the quaternion (1, w/2), whose angle is |w| but for its cube */
  const vec3 u = vec_scale(0.5, w), v = vec_sub(pose->position, centre);
  const cprox_quat q = pose->orientation;
  const vec3 across = vec_cross(u, vec_add(vec_cross(u, v), v));
  const vec3 part = vec(q.x, q.y, q.z), turned = vec_add(vec_axpy(part, q.w, u), vec_cross(u, part));
  return (cprox_pose){.position = vec_add(pose->position, vec_scale(2.0 / (1.0 + vec_norm2(u)), across)),
                      .orientation = {q.w - vec_dot(u, part), turned.x, turned.y, turned.z}};
}

/* How far apart b's nearest points are when it has turned to one side and to
 * the other, about the axis where that is most. */
static cprox_status spread_of(const placed_bodies *p, const pair_witness *here, double turn, double *spread) {
  vec3 axis[2];
  feature_tangents(here->normal, &axis[0], &axis[1]);
  *spread = 0.0;
  for (int i = 0; i < 2; i++) {
    pair_witness seen[2];
    for (int k = 0; k < 2; k++) {
      cprox_obstacle b = p->b;
      b.pose = turned_about(&p->b.pose, here->on_b, vec_scale(k ? turn : -turn, axis[i]));
      const cprox_status status = witness_of(p, &p->a, &b, &seen[k]);
      if (status < 0) return status;
    }
    *spread = greater(vec_norm(vec_sub(seen[1].on_b, seen[0].on_b)), *spread);
  }
  return CPROX_OK;
}

cprox_status ties_point_is_alone(const placed_bodies *p, bool *alone) {
  pair_witness here;
  double near, far = 0.0;
  *alone = true;
  cprox_status status = witness_of(p, &p->a, &p->b, &here);
  if (status < 0 || vec_norm2(here.normal) == 0.0) return status;
  status = spread_of(p, &here, TIES_NEAR, &near);
  if (status >= 0 && near > POINT_NOISE * p->size) status = spread_of(p, &here, TIES_FAR, &far);
  *alone = !ties_is_jump(near, far, POINT_NOISE * p->size);
  return status < 0 ? status : CPROX_OK;
}

static cprox_status lean_of(const placed_bodies *p, double step, double *lean) {
  *lean = 0.0;
  for (int i = 0; i < 3; i++) {
    pair_witness seen[2];
    for (int k = 0; k < 2; k++) {
      cprox_obstacle a = p->a;
      const double d = k ? step : -step;
      a.pose.position = vec_add(a.pose.position, vec(i == 0 ? d : 0.0, i == 1 ? d : 0.0, i == 2 ? d : 0.0));
      const cprox_status status = witness_of(p, &a, &p->b, &seen[k]);
      if (status < 0) return status;
    }
    *lean = greater(vec_norm(vec_sub(seen[1].normal, seen[0].normal)), *lean);
  }
  return CPROX_OK;
}

cprox_status ties_normal_is_alone(const placed_bodies *p, bool *alone) {
  double near, far = 0.0;
  *alone = true;
  cprox_status status = lean_of(p, TIES_NEAR * p->size, &near);
  if (status >= 0 && near > NORMAL_NOISE) status = lean_of(p, TIES_FAR * p->size, &far);
  *alone = !ties_is_jump(near, far, NORMAL_NOISE);
  return status < 0 ? status : CPROX_OK;
}
