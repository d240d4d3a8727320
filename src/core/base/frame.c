/* SPDX-License-Identifier: BSD-3-Clause */
#include "base/frame.h"

#include "base/rotation.h"
#include "base/rounding.h"

const char *frame_pose_error(const cprox_pose *pose) {
  const cprox_quat q = pose->orientation;
  const vec3 p = pose->position;
  if (!vec_finite(p)) return "the position is not finite";
  if (fmax(fabs(p.x), fmax(fabs(p.y), fabs(p.z))) > LENGTH_MOST)
    return "the position is farther than 1e60 m from the origin";
  if (!(isfinite(q.w) && isfinite(q.x) && isfinite(q.y) && isfinite(q.z))) return "the quaternion is not finite";
  const double norm2 = q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z;
  if (!(norm2 > 0.0)) return "the quaternion's norm is 0";
  if (norm2 < 1e-200 || norm2 > 1e200) return "the quaternion's norm is out of range";
  return NULL;
}

frame frame_create(const cprox_pose *pose, vec3 centre) {
  const cprox_quat q = pose->orientation;
  frame f = {.r = {1, 0, 0, 0, 1, 0, 0, 0, 1}, .position = pose->position, .centre = centre};
  f.rotated = q.x != 0.0 || q.y != 0.0 || q.z != 0.0;
  f.about_z = q.x == 0.0 && q.y == 0.0;
  if (!f.rotated) return f;

  /* R = 1 + s (w [v] + [v]^2), s = 2/(q·q) */
  const double s = 2.0 / (q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
  const double xs = q.x * s, ys = q.y * s, zs = q.z * s;
  const double wx = q.w * xs, wy = q.w * ys, wz = q.w * zs;
  const double xx = q.x * xs, xy = q.x * ys, xz = q.x * zs;
  const double yy = q.y * ys, yz = q.y * zs, zz = q.z * zs;
  f.r[0] = 1.0 - (yy + zz), f.r[1] = xy - wz, f.r[2] = xz + wy;
  f.r[3] = xy + wz, f.r[4] = 1.0 - (xx + zz), f.r[5] = yz - wx;
  f.r[6] = xz - wy, f.r[7] = yz + wx, f.r[8] = 1.0 - (xx + yy);
  return f;
}

/* local = R2^T (R1^T (p - x1) - x2) - c = (R1 R2)^T (p - x1) - (R2^T x2 + c). The product of two quaternions is within
 * 8u of its length, which turns by 16u. */
frame frame_create_within(const cprox_pose *outer, const cprox_pose *inner, vec3 centre) {
  cprox_pose both = frame_compose(outer, inner);
  both.position = outer->position;
  frame f = frame_create(&both, centre);
  const frame second = frame_create(&(cprox_pose){.orientation = inner->orientation}, vec(0, 0, 0));
  const vec3 shift = frame_turn_to_local(&second, inner->position);
  f.centre = vec_add(centre, shift);
  const cprox_quat q = outer->orientation;
  const bool first_turns = q.x != 0.0 || q.y != 0.0 || q.z != 0.0;
  f.misturned = first_turns && second.rotated ? 16.0 : 0.0;
  f.misplaced = ROUND_UP * ROUND_U * ((second.rotated ? ROUND_ROTATION * vec_norm(shift) : 0.0) + vec_norm(f.centre));
  return f;
}

vec3 frame_turn_to_local(const frame *f, vec3 v) {
  return f->rotated ? rotate_back(f->r, v) : v;
}

vec3 frame_turn_to_world(const frame *f, vec3 v) {
  return f->rotated ? rotate(f->r, v) : v;
}

static bool is_zero(vec3 v) {
  return v.x == 0.0 && v.y == 0.0 && v.z == 0.0;
}

vec3 frame_to_local(const frame *f, vec3 world, double *error) {
  /* world - position first: where the two share a large offset the difference is small, and so is its rounding */
  vec3 p = world;
  double bound = 0.0;
  if (!is_zero(f->position)) {
    p = vec_sub(world, f->position);
    bound += vec_norm(p);
  }
  if (f->rotated) {
    p = frame_turn_to_local(f, p);
    bound += (ROUND_ROTATION + f->misturned) * vec_norm(p);
  }
  if (!is_zero(f->centre)) {
    p = vec_sub(p, f->centre);
    bound += vec_norm(p);
  }
  bound = ROUND_UP * (ROUND_U * bound + f->misplaced);
  if (bound > *error) *error = bound;
  return p;
}

vec3 frame_to_world(const frame *f, vec3 local) {
  return vec_add(frame_turn_to_world(f, vec_add(local, f->centre)), f->position);
}

/* The same rotation by a quaternion whose products neither overflow nor vanish: scaled by a power of 2, exactly, where
 * its norm is far from 1. (A part that is lost to underflow then is 2^-1000 of the largest.) */
static cprox_quat mid_sized(cprox_quat q) {
  const double most = fmax(fmax(fabs(q.w), fabs(q.x)), fmax(fabs(q.y), fabs(q.z)));
  if (most > 1e-30 && most < 1e30) return q;
  const int e = -ilogb(most);
  return (cprox_quat){ldexp(q.w, e), ldexp(q.x, e), ldexp(q.y, e), ldexp(q.z, e)};
}

cprox_pose frame_compose(const cprox_pose *outer, const cprox_pose *inner) {
  const cprox_quat a = mid_sized(outer->orientation), b = mid_sized(inner->orientation);
  const frame f = frame_create(outer, vec(0, 0, 0));
  return (cprox_pose){
      .position = frame_to_world(&f, inner->position),
      .orientation = {a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z, a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
                      a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x, a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w}};
}
