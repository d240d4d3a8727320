/* SPDX-License-Identifier: BSD-3-Clause */
#include "shapes.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "base/rounding.h"

const cprox_body_kind TEST_BOUNDED[10] = {
    CPROX_BODY_POINT, CPROX_BODY_SPHERE,    CPROX_BODY_BOX,      CPROX_BODY_CAPSULE, CPROX_BODY_CYLINDER,
    CPROX_BODY_CONE,  CPROX_BODY_ELLIPSOID, CPROX_BODY_POLYTOPE, CPROX_BODY_POLYGON, CPROX_BODY_SUPPORT};

/* A user's callback: a box, given by its half extents. */
static void box_callback(const void *user, const double d[3], double p[3]) {
  const double *half = user;
  for (int i = 0; i < 3; i++) p[i] = d[i] < 0.0 ? -half[i] : half[i];
}

/* Fills s, which must stay where it is: a callback points into it. */
void shape_make(rng *r, cprox_body_kind kind, double scale, double aspect, test_shape *s) {
  memset(s, 0, sizeof *s);
  s->kind = kind;
  for (int i = 0; i < 3; i++) s->size[i] = scale * rng_log_uniform(r, 1.0 / aspect, 1.0);
  const double *z = s->size;
  cprox_status status = CPROX_INVALID;
  switch (kind) {
    case CPROX_BODY_POINT:
      s->v[s->n++] = rng_in_cube(r, scale);
      status = cprox_body_create_point(s->v[0], NULL, &s->body);
      break;
    case CPROX_BODY_SPHERE: status = cprox_body_create_sphere(z[0], NULL, &s->body); break;
    case CPROX_BODY_BOX: status = cprox_body_create_box(vec(2 * z[0], 2 * z[1], 2 * z[2]), NULL, &s->body); break;
    case CPROX_BODY_CAPSULE: status = cprox_body_create_capsule(2 * z[1], z[0], NULL, &s->body); break;
    case CPROX_BODY_CYLINDER: status = cprox_body_create_cylinder(2 * z[1], z[0], NULL, &s->body); break;
    case CPROX_BODY_CONE: status = cprox_body_create_cone(2 * z[1], z[0], NULL, &s->body); break;
    case CPROX_BODY_ELLIPSOID: status = cprox_body_create_ellipsoid(vec(z[0], z[1], z[2]), NULL, &s->body); break;
    case CPROX_BODY_POLYTOPE:
      for (s->n = 1 + rng_index(r, TEST_MAX_VERTICES); s->body == NULL;) {
        const vec3 offset = rng_in_cube(r, scale);
        for (size_t i = 0; i < s->n; i++) {
          const vec3 u = rng_unit(r);
          s->v[i] = vec(offset.x + z[0] * u.x, offset.y + z[1] * u.y, offset.z + z[2] * u.z);
        }
        status = cprox_body_create_polytope(s->v, s->n, NULL, &s->body);
      }
      break;
    case CPROX_BODY_POLYGON: {
      double flat[TEST_MAX_VERTICES][2];
      s->n = 3 + rng_index(r, 12);
      for (size_t i = 0; i < s->n; i++) {
        const double angle = 6.283185307 * ((double)i + 0.4 * rng_uniform(r, 0.0, 1.0)) / (double)s->n;
        s->v[i] = vec(z[0] * cos(angle), z[1] * sin(angle), 0.0);
        flat[i][0] = s->v[i].x;
        flat[i][1] = s->v[i].y;
      }
      status = cprox_body_create_polygon((const double(*)[2])flat, s->n, NULL, &s->body);
      break;
    }
    case CPROX_BODY_SUPPORT:
      status = cprox_body_create_support(box_callback, s->size, vec(0, 0, 0), 2 * scale, 0.0, 0.0, NULL, &s->body);
      break;
    default: break;
  }
  assert_int_equal(status, CPROX_OK);
}

/* The point of the shape farthest along d, in its frame. */
static vec3l extreme(const test_shape *s, vec3l d) {
  const long double a = s->size[0], b = s->size[1], c = s->size[2], e = hypotl(d.x, d.y), length = ref_norm(d);
  vec3l x = {0, 0, 0};
  switch (s->kind) {
    case CPROX_BODY_SPHERE: return ref_scale(a / length, d);
    case CPROX_BODY_BOX:
    case CPROX_BODY_SUPPORT: return (vec3l){copysignl(a, d.x), copysignl(b, d.y), copysignl(c, d.z)};
    case CPROX_BODY_CAPSULE: x.z = copysignl(b, d.z); return ref_add(x, ref_scale(a / length, d));
    case CPROX_BODY_CYLINDER: return (vec3l){a * d.x / e, a * d.y / e, copysignl(b, d.z)};
    case CPROX_BODY_CONE:
      if (b * d.z > a * e - b * d.z) return (vec3l){0, 0, b};
      return (vec3l){a * d.x / e, a * d.y / e, -b};
    case CPROX_BODY_ELLIPSOID: {
      const vec3l w = {a * d.x, b * d.y, c * d.z};
      const long double n = ref_norm(w);
      return (vec3l){a * w.x / n, b * w.y / n, c * w.z / n};
    }
    default: { /* vertices */
      size_t best = 0;
      for (size_t i = 1; i < s->n; i++)
        if (ref_dot(d, ref_vec(s->v[i])) > ref_dot(d, ref_vec(s->v[best]))) best = i;
      return ref_vec(s->v[best]);
    }
  }
}

vec3l pose_turn(const cprox_pose *pose, vec3l v) {
  const cprox_pose still = {.orientation = pose->orientation};
  return ref_to_world(&still, v);
}

vec3l pose_turn_back(const cprox_pose *pose, vec3l v) {
  const cprox_pose still = {.orientation = pose->orientation};
  return ref_to_local(&still, v);
}

vec3l shape_extreme(const test_shape *s, const cprox_pose *pose, vec3l d) {
  return ref_to_world(pose, extreme(s, pose_turn_back(pose, d)));
}

/* A direction that matters to the shape: the normal of its nearest point to somewhere, in the world. */
vec3 shape_telling_direction(rng *r, const test_shape *s, const cprox_pose *pose) {
  if (rng_index(r, 3) == 0) return rng_unit(r);
  convex_near near;
  s->body->shape.ops->nearest(&s->body->shape, vec_scale(1.5 * s->body->shape.scale, rng_unit(r)), NULL, &near);
  if (vec_norm2(near.normal) == 0.0) return rng_unit(r);
  const vec3l n = pose_turn(pose, ref_vec(near.normal));
  return vec((double)n.x, (double)n.y, (double)n.z);
}

/* Moves b so that a's least and b's greatest point along n are `gap` apart along n: their distance if gap >= 0, a bound
 * below the signed distance if not. Returns by how much the rounding of b's position may have changed it. */
double shape_place(const test_shape *a, const cprox_pose *pa, const test_shape *b, cprox_pose *pb, vec3 n, double gap) {
  const vec3l d = ref_vec(n), away = ref_scale(-1, d);
  pb->position = vec(0, 0, 0);
  const vec3l p = shape_extreme(a, pa, away), q = shape_extreme(b, pb, d);
  const vec3l x = ref_sub(ref_sub(p, q), ref_scale(gap / ref_norm(d), d));
  pb->position = vec((double)x.x, (double)x.y, (double)x.z);
  /* and long double's own rounding, 2048 times finer */
  return (double)ref_error(x, pb->position) + 0.01 * ROUND_U * (double)(ref_norm(p) + ref_norm(q) + ref_norm(x));
}

const char *shape_name(const test_shape *s) {
  return cprox_body_kind_name(s->kind);
}

/* A point of the shape: an extreme one, moved towards the mean of others by the fraction. */
vec3l shape_point_within(rng *r, const test_shape *s, const cprox_pose *pose, double fraction) {
  const vec3l p = shape_extreme(s, pose, ref_vec(rng_unit(r)));
  vec3l mean = {0, 0, 0};
  for (int i = 0; i < 8; i++)
    mean = ref_add(
        mean, ref_scale(0.125L,
                        shape_extreme(s, pose, ref_vec(vec(i & 1 ? 1 : -1, i & 2 ? 1.1 : -1.1, i & 4 ? 0.9 : -0.9)))));
  return ref_add(ref_scale(1 - fraction, p), ref_scale(fraction, mean));
}
