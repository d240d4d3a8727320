/* SPDX-License-Identifier: BSD-3-Clause */
#include "bodies.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* ---- forms: nearest points ---- */

static vec3l mix(vec3l a, vec3l b, long double s) {
  return ref_add(ref_scale(1.0L - s, a), ref_scale(s, b));
}

static vec3l on_segment(vec3l p, vec3l a, vec3l b) {
  const vec3l d = ref_sub(b, a);
  const long double along = ref_dot(ref_sub(p, a), d), length2 = ref_dot(d, d);
  if (along <= 0.0L || length2 == 0.0L) return a;
  return along >= length2 ? b : mix(a, b, along / length2);
}

static void keep_nearer(vec3l p, vec3l candidate, vec3l *best, long double *least) {
  const long double d = ref_norm(ref_sub(p, candidate));
  if (!(d < *least)) return;
  *least = d;
  *best = candidate;
}

static void keep_on_triangle(vec3l p, vec3l a, vec3l b, vec3l c, vec3l *best, long double *least) {
  keep_nearer(p, on_segment(p, a, b), best, least);
  keep_nearer(p, on_segment(p, b, c), best, least);
  keep_nearer(p, on_segment(p, c, a), best, least);
  const vec3l normal = ref_cross(ref_sub(b, a), ref_sub(c, a));
  const long double area2 = ref_dot(normal, normal);
  if (area2 == 0.0L) return;
  if (ref_dot(ref_cross(ref_sub(b, a), ref_sub(p, a)), normal) < 0.0L ||
      ref_dot(ref_cross(ref_sub(c, b), ref_sub(p, b)), normal) < 0.0L ||
      ref_dot(ref_cross(ref_sub(a, c), ref_sub(p, c)), normal) < 0.0L)
    return;
  keep_nearer(p, ref_sub(p, ref_scale(ref_dot(ref_sub(p, a), normal) / area2, normal)), best, least);
}

static vec3l corner(const part *f, size_t triangle, size_t k) {
  return ref_vec(f->points[f->triangles[triangle][k]]);
}

/* How far above the plane of a triangle, by its outward normal. */
static long double above(const part *f, size_t triangle, vec3l p) {
  const vec3l a = corner(f, triangle, 0);
  const vec3l normal = ref_cross(ref_sub(corner(f, triangle, 1), a), ref_sub(corner(f, triangle, 2), a));
  return ref_dot(ref_sub(p, a), normal) / ref_norm(normal);
}

static long double depth_in_hull(const part *f, vec3l p) {
  if (!f->full) return 0.0L;
  long double depth = HUGE_VALL;
  for (size_t i = 0; i < f->m; i++) depth = fminl(depth, -above(f, i, p));
  return fmaxl(depth, 0.0L);
}

/* By all triangles' solid angles. */
static bool in_mesh(const part *f, vec3l p) {
  long double sum = 0.0L;
  for (size_t i = 0; i < f->m; i++) {
    const vec3l a = ref_sub(corner(f, i, 0), p), b = ref_sub(corner(f, i, 1), p), c = ref_sub(corner(f, i, 2), p);
    const long double x = ref_norm(a), y = ref_norm(b), z = ref_norm(c);
    sum += 2.0L *
           atan2l(ref_dot(a, ref_cross(b, c)), x * y * z + ref_dot(a, b) * z + ref_dot(b, c) * x + ref_dot(c, a) * y);
  }
  return fabsl(sum) > 6.283185307179586L;
}

static vec3l nearest_of_faces(const part *f, vec3l p) {
  if (f->full && (f->form == FORM_HULL ? depth_in_hull(f, p) > 0.0L : in_mesh(f, p))) return p;
  vec3l best = p;
  long double least = HUGE_VALL;
  for (size_t i = 0; i < f->m; i++)
    keep_on_triangle(p, corner(f, i, 0), corner(f, i, 1), corner(f, i, 2), &best, &least);
  if (f->form == FORM_HULL)
    for (size_t i = 0; i < f->n; i++)
      for (size_t j = 0; j <= i && !f->full; j++)
        keep_nearer(p, on_segment(p, ref_vec(f->points[i]), ref_vec(f->points[j])), &best, &least);
  return best;
}

static vec3l in_ball(vec3l p, vec3l centre, long double radius) {
  const vec3l d = ref_sub(p, centre);
  const long double length = ref_norm(d);
  return length <= radius ? p : ref_add(centre, ref_scale(radius / length, d));
}

static long double clamped(long double x, long double low, long double high) {
  return fmaxl(low, fminl(x, high));
}

/* Bodies about the z axis: the nearest point of the half-plane (distance from the axis, z). */
static vec3l nearest_round(const part *f, vec3l p) {
  const long double radius = f->size.x, half = f->size.z, rho = hypotl(p.x, p.y);
  long double x = fminl(rho, radius), z = clamped(p.z, -half, half);
  if (f->form == FORM_CONE) {
    const vec3l q = {rho, 0, p.z}, apex = {0, 0, half}, rim = {radius, 0, -half};
    if (p.z >= -half && rho * 2.0L * half <= radius * (half - p.z)) return p;
    vec3l best = q;
    long double least = HUGE_VALL;
    keep_nearer(q, on_segment(q, apex, rim), &best, &least);
    keep_nearer(q, on_segment(q, rim, (vec3l){0, 0, -half}), &best, &least);
    x = best.x;
    z = best.z;
  }
  const long double shrink = rho > 0.0L ? x / rho : 0.0L;
  return (vec3l){p.x * shrink, p.y * shrink, z};
}

/* x^e for x >= 0, within 2^-57 of itself where it is not tiny. */
static long double power(long double x, long double e) {
  if (e == 0.0L) return 1.0L;
  if (e == 1.0L) return x;
  return e == 2.0L ? x * x : exp2l(e * log2l(x));
}

static long double power_at(const part *f, vec3l x) {
  return power(fabsl(x.x) / f->size.x, f->exponents.x) + power(fabsl(x.y) / f->size.y, f->exponents.y) +
         power(fabsl(x.z) / f->size.z, f->exponents.z);
}

/* The same in double, where the search in long double begins. The pull alone takes x at most to where it is 2 p. */
static double roughly_shrunken(double p, double a, double e, double weight) {
  const double most = a * pow(2.0 * p * a / (weight * e), 1.0 / (e - 1.0));
  double low = 0.0, high = most < p ? most : p, x = high;
  for (int i = 0; i < 100; i++) {
    const double pull = weight * e / a * pow(x / a, e - 1.0), value = 2.0 * (x - p) + pull;
    if (value > 0.0)
      high = x;
    else
      low = x;
    const double step = x - value / (2.0 + (e - 1.0) * pull / x);
    const double next = step > low && step < high ? step : 0.5 * (low + high);
    if (fabs(next - x) <= 1e-6 * x || next == 0.0) break; /* two steps in long double make that 1e-18 */
    x = next;
  }
  return x;
}

/* The x in [0, p] at which (x - p)² + weight |x/a|^e is least: Newton's method on its monotone derivative. */
static long double shrunken(long double p, long double a, long double e, long double weight) {
  if (e == 2.0L) return p / (1.0L + weight / (a * a));
  if (e == 1.0L) return fmaxl(0.0L, p - 0.5L * weight / a);
  if (!(p > 0.0L)) return p;
  long double x = roughly_shrunken((double)p, (double)a, (double)e, (double)weight);
  for (int i = 0; i < 2 && x > 0.0L; i++) {
    const long double pull = weight * e / a * power(x / a, e - 1.0L);
    x = fmaxl(0.5L * x, fminl(p, x - (2.0L * (x - p) + pull) / (2.0L + (e - 1.0L) * pull / x)));
  }
  return x;
}

static vec3l all_shrunken(const part *f, vec3l p, long double weight) {
  return (vec3l){copysignl(shrunken(fabsl(p.x), f->size.x, f->exponents.x, weight), p.x),
                 copysignl(shrunken(fabsl(p.y), f->size.y, f->exponents.y, weight), p.y),
                 copysignl(shrunken(fabsl(p.z), f->size.z, f->exponents.z, weight), p.z)};
}

/* By the multiplier of the constraint, in its logarithm: secants, and where these leave the interval or are slow, its
 * middle. The greater end is always inside the body. */
static vec3l nearest_power(const part *f, vec3l p) {
  if (power_at(f, p) <= 1.0L) return p;
  const long double far = ref_norm(p) + f->size.x + f->size.y + f->size.z, unit = far * far, least = -90.0L;
  long double low = least, high = HUGE_VALL, at = 0.0L, before = 0.0L, value_before = 0.0L;
  vec3l best = p;
  for (int i = 0; i < 200 && at < 12000.0L; i++) {
    const vec3l x = all_shrunken(f, p, unit * exp2l(at));
    const long double value = logl(power_at(f, x)), width = high - low;
    if (value > 0.0L)
      low = at;
    else
      high = at, best = x;
    if (value <= 0.0L && (value >= -0x1p-55L || at <= least)) break;
    if (high - low <= 0x1p-62L * (fabsl(low) + fabsl(high))) break;
    const long double slope = (value - value_before) / (at - before);
    long double next = at - value / slope + 0x1p-58L; /* a little to the inside */
    if (isinf(high))
      next = at > 0.0L ? 2.0L * at : 8.0L;
    else if (low == least)
      next = fmaxl(at - 8.0L, least);
    else if (i % 3 == 2 && high - low > 0.5L * width)
      next = 0.5L * (low + high);
    if (!(next > low || low == least) || !(next < high)) next = 0.5L * (low + high);
    before = at, value_before = value, at = next;
  }
  return best;
}

static vec3l nearest_without_margin(const part *f, vec3l p) {
  vec3l best = p;
  long double least = HUGE_VALL;
  switch (f->form) {
    case FORM_HULL:
    case FORM_MESH: return nearest_of_faces(f, p);
    case FORM_BALLS:
      for (size_t i = 0; i < f->n; i++) keep_nearer(p, in_ball(p, ref_vec(f->points[i]), f->size.x), &best, &least);
      return best;
    case FORM_BOXES:
      for (size_t i = 0; i < f->n; i++)
        keep_nearer(p,
                    (vec3l){clamped(p.x, f->points[i].x, f->high[i].x), clamped(p.y, f->points[i].y, f->high[i].y),
                            clamped(p.z, f->points[i].z, f->high[i].z)},
                    &best, &least);
      return best;
    case FORM_CAPSULE: return in_ball(p, (vec3l){0, 0, clamped(p.z, -(long double)f->size.z, f->size.z)}, f->size.x);
    case FORM_CYLINDER:
    case FORM_CONE: return nearest_round(f, p);
    case FORM_POWER: return nearest_power(f, p);
    default: { /* halfspace */
      const vec3l n = ref_vec(f->size);
      const long double out = ref_dot(n, p) + f->offset;
      return out <= 0.0L ? p : ref_sub(p, ref_scale(out / ref_dot(n, n), n));
    }
  }
}

/* ---- forms: depths and supports ---- */

static long double part_depth(const part *f, vec3l p) {
  const long double rho = hypotl(p.x, p.y), radius = f->size.x, half = f->size.z;
  long double depth = 0.0L;
  switch (f->form) {
    case FORM_HULL: return depth_in_hull(f, p);
    case FORM_BALLS: return radius - ref_norm(ref_sub(p, ref_vec(f->points[0])));
    case FORM_BOXES:
      depth = fminl(fminl(p.x - f->points[0].x, f->high[0].x - p.x), fminl(p.y - f->points[0].y, f->high[0].y - p.y));
      return fminl(depth, fminl(p.z - f->points[0].z, f->high[0].z - p.z));
    case FORM_CAPSULE: return radius - ref_norm(ref_sub(p, (vec3l){0, 0, clamped(p.z, -half, half)}));
    case FORM_CYLINDER: return fminl(radius - rho, half - fabsl(p.z));
    case FORM_CONE: return fminl(p.z + half, (radius * (half - p.z) - 2.0L * half * rho) / hypotl(radius, 2.0L * half));
    case FORM_HALFSPACE: return -(ref_dot(ref_vec(f->size), p) + f->offset) / ref_norm(ref_vec(f->size));
    default: return 0.0L;
  }
}

/* d a unit vector of the part's frame; the margin is left out. */
static long double part_support(const part *f, vec3l d) {
  const long double rho = hypotl(d.x, d.y), radius = f->size.x, half = f->size.z;
  long double most = -HUGE_VALL;
  switch (f->form) {
    case FORM_HULL:
    case FORM_MESH:
      for (size_t i = 0; i < f->n; i++) most = fmaxl(most, ref_dot(d, ref_vec(f->points[i])));
      return most;
    case FORM_BALLS:
      for (size_t i = 0; i < f->n; i++) most = fmaxl(most, ref_dot(d, ref_vec(f->points[i])) + radius);
      return most;
    case FORM_BOXES:
      for (size_t i = 0; i < f->n; i++)
        most = fmaxl(most, d.x * (d.x > 0 ? f->high[i].x : f->points[i].x) +
                               d.y * (d.y > 0 ? f->high[i].y : f->points[i].y) +
                               d.z * (d.z > 0 ? f->high[i].z : f->points[i].z));
      return most;
    case FORM_CAPSULE: return half * fabsl(d.z) + radius;
    case FORM_CYLINDER: return half * fabsl(d.z) + radius * rho;
    case FORM_CONE: return fmaxl(half * d.z, radius * rho - half * d.z);
    case FORM_POWER: /* an ellipsoid, or in the box of its sizes */
      if (f->exponents.x == 2.0 && f->exponents.y == 2.0 && f->exponents.z == 2.0)
        return ref_norm((vec3l){d.x * f->size.x, d.y * f->size.y, d.z * f->size.z});
      return fabsl(d.x) * f->size.x + fabsl(d.y) * f->size.y + fabsl(d.z) * f->size.z;
    default: return HUGE_VALL;
  }
}

/* ---- bodies ---- */

long double body_nearest(const random_body *b, const cprox_pose *pose, vec3l p, vec3l *nearest) {
  const vec3l own = ref_to_local(pose, p);
  long double least = HUGE_VALL;
  for (size_t i = 0; i < b->n_parts; i++) {
    const part *f = &b->parts[i];
    const vec3l x = ref_to_local(&f->pose, own), q = nearest_without_margin(f, x);
    const vec3l way = ref_sub(x, q);
    const long double length = ref_norm(way), d = fmaxl(0.0L, length - f->margin);
    if (!(d < least)) continue;
    least = d;
    *nearest = p;
    if (d == 0.0L) continue;
    const vec3l reached = ref_add(q, ref_scale(f->margin / length, way));
    *nearest = ref_to_world(pose, ref_to_world(&f->pose, reached));
  }
  return least;
}

long double body_depth(const random_body *b, const cprox_pose *pose, vec3l p) {
  const vec3l own = ref_to_local(pose, p);
  long double depth = 0.0L;
  for (size_t i = 0; i < b->n_parts; i++) {
    const part *f = &b->parts[i];
    const long double d = part_depth(f, ref_to_local(&f->pose, own));
    if (d > 0.0L) depth = fmaxl(depth, d + f->margin);
  }
  return depth;
}

long double body_support(const random_body *b, const cprox_pose *pose, vec3l d) {
  const cprox_pose turn = {.orientation = pose->orientation};
  const vec3l own = ref_to_local(&turn, d);
  long double most = -HUGE_VALL;
  for (size_t i = 0; i < b->n_parts; i++) {
    const part *f = &b->parts[i];
    const cprox_pose turned = {.orientation = f->pose.orientation};
    const long double h = part_support(f, ref_to_local(&turned, own)) + ref_dot(own, ref_vec(f->pose.position));
    most = fmaxl(most, h + f->margin);
  }
  return most + ref_dot(d, ref_vec(pose->position));
}

void body_free(random_body *b) {
  cprox_body_free(b->body);
  for (size_t i = 0; i <= BODY_PARTS; i++) cprox_body_free(b->owned[i]);
}
