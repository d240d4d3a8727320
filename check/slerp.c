/* SPDX-License-Identifier: BSD-3-Clause */
#include "slerp.h"

/* The angle from 0 to pi / 2 of a direction with this sine and cosine, of any length. A guess x is made good by the
 * sine of what it is off by: sine cos x - cosine sin x of a length, and |d| <= pi/2 |sin d| to pi/2. */
static num angle_of(num sine, num cosine) {
  const double guess = atan2(sine.m, cosine.m);
  num s, c;
  num_turn(num_of(guess), &s, &c);
  const num length = num_sqrt(num_add(num_mul(sine, sine), num_mul(cosine, cosine)));
  const num off = num_div(num_sub(num_mul(sine, c), num_mul(cosine, s)), length);
  const num along = num_add(num_mul(cosine, c), num_mul(sine, s));
  return (num){guess, num_bottom(along) > 0.0 ? GROW(1.6 * num_size(off)) : INFINITY};
}

bool slerp_between(const num p[4], const num q[4], slerp_arc *a) {
  num u[3], along = num_of(0.0), square = num_of(0.0);
  for (int k = 0; k < 4; k++) along = num_add(along, num_mul(p[k], q[k]));
  if (!(fabs(along.m) > 2.0 * along.e)) return false;
  const num sign = num_of(along.m < 0.0 ? -1.0 : 1.0);
  along = num_mul(sign, along);
  for (int k = 0; k < 3; k++) { /* the vector part of q p*, which is along times the tangent of half the angle long */
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    const num turned = num_sub(num_mul(q[j], p[i]), num_mul(q[i], p[j]));
    const num straight = num_sub(num_mul(p[3], q[k]), num_mul(q[3], p[k]));
    u[k] = num_mul(sign, num_add(straight, turned));
    square = num_add(square, num_mul(u[k], u[k]));
  }
  const num sine = num_sqrt(square), two = num_of(2.0), start[4] = {p[3], p[0], p[1], p[2]};
  const bool turns = square.m > 2.0 * square.e;
  *a = (slerp_arc){.used = true, .start = rot_of_quaternion(start)};
  if (turns)
    a->angle = num_mul(two, angle_of(sine, along));
  else /* by so little that the axis is not known */
    a->angle.e = GROW(2.0 * sqrt(square.m + square.e) / num_bottom(along));
  for (int k = 0; k < 3; k++) a->z[k] = turns ? num_div(u[k], sine) : (num){0.0, 1.0};
  return true;
}
