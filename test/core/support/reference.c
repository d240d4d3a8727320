/* SPDX-License-Identifier: BSD-3-Clause */
#include "reference.h"

#include <math.h>

#define MAX_DEGREE 60

long double ref_error(vec3l exact, vec3 computed) {
  return ref_norm(ref_sub(exact, ref_vec(computed)));
}

double ref_largest(const vec3 *p, size_t n) {
  double largest = 0.0;
  for (size_t i = 0; i < n; i++) largest = fmax(largest, vec_norm(p[i]));
  return largest;
}

/* ---- curves ---- */

static vec3l mix(vec3l a, vec3l b, long double s) {
  return ref_add(ref_scale(1.0L - s, a), ref_scale(s, b));
}

vec3l ref_bezier(const vec3 *p, size_t degree, long double s, size_t order) {
  if (order > degree) return (vec3l){0, 0, 0};
  vec3l q[MAX_DEGREE + 1];
  for (size_t i = 0; i <= degree; i++) q[i] = ref_vec(p[i]);

  /* the control points of the derivative */
  size_t n = degree;
  for (size_t k = 0; k < order; k++, n--)
    for (size_t i = 0; i < n; i++) q[i] = ref_scale((long double)n, ref_sub(q[i + 1], q[i]));

  for (; n > 0; n--)
    for (size_t i = 0; i < n; i++) q[i] = mix(q[i], q[i + 1], s);
  return q[0];
}

void ref_bezier_section(const vec3 *p, size_t degree, long double s0, long double s1, vec3l *section) {
  /* keep the left part of a cut at s1: the first points of the levels */
  vec3l q[MAX_DEGREE + 1], left[MAX_DEGREE + 1];
  for (size_t i = 0; i <= degree; i++) q[i] = ref_vec(p[i]);
  for (size_t n = degree; n > 0; n--) {
    left[degree - n] = q[0];
    for (size_t i = 0; i < n; i++) q[i] = mix(q[i], q[i + 1], s1);
  }
  left[degree] = q[0];

  /* then the right part of a cut at s0/s1: the last points of the levels */
  const long double s = s0 / s1;
  for (size_t n = degree; n > 0; n--) {
    section[n] = left[n];
    for (size_t i = 0; i < n; i++) left[i] = mix(left[i], left[i + 1], s);
  }
  section[0] = left[0];
}

vec3l ref_bspline(const vec3 *p, size_t degree, const double *knots, size_t r, long double t, size_t order) {
  if (order > degree) return (vec3l){0, 0, 0};

  /* control points r - degree … r of the derivative: d_i = (degree - k)(d_(i+1) - d_i) / (u_(i+degree+1) - u_(i+k+1))
   */
  vec3l d[MAX_DEGREE + 1];
  for (size_t i = 0; i <= degree; i++) d[i] = ref_vec(p[r - degree + i]);
  for (size_t k = 0; k < order; k++)
    for (size_t i = 0; i + k < degree; i++) {
      const size_t at = r - degree + i;
      const long double length = (long double)knots[at + degree + 1] - knots[at + k + 1];
      d[i] = ref_scale((long double)(degree - k) / length, ref_sub(d[i + 1], d[i]));
    }

  /* the basis functions that do not vanish on the span */
  const size_t q = degree - order;
  long double basis[MAX_DEGREE + 1] = {1.0L};
  for (size_t j = 1; j <= q; j++) {
    long double carried = 0.0L;
    for (size_t i = 0; i < j; i++) {
      const long double right = knots[r + i + 1], left = knots[r + i + 1 - j];
      const long double share = basis[i] / (right - left);
      basis[i] = carried + (right - t) * share;
      carried = (t - left) * share;
    }
    basis[j] = carried;
  }

  vec3l sum = {0, 0, 0};
  for (size_t i = 0; i <= q; i++) sum = ref_add(sum, ref_scale(basis[i], d[i]));
  return sum;
}

/* ---- poses ---- */

/* q v q* / |q|², written out as a rotation by the angle and axis that the quaternion means. */
static vec3l turn(cprox_quat q, vec3l v, long double sign) {
  const vec3l axis = ref_scale(sign, (vec3l){q.x, q.y, q.z});
  const long double w = q.w, a2 = ref_dot(axis, axis), n2 = w * w + a2;
  const vec3l sum = ref_add(ref_scale(w * w - a2, v),
                            ref_add(ref_scale(2.0L * ref_dot(axis, v), axis), ref_scale(2.0L * w, ref_cross(axis, v))));
  return ref_scale(1.0L / n2, sum);
}

vec3l ref_to_local(const cprox_pose *pose, vec3l p) {
  return turn(pose->orientation, ref_sub(p, ref_vec(pose->position)), -1.0L);
}

vec3l ref_to_world(const cprox_pose *pose, vec3l p) {
  return ref_add(turn(pose->orientation, p, 1.0L), ref_vec(pose->position));
}

/* ---- distances ---- */

long double ref_point_segment(vec3l p, vec3l a, vec3l b) {
  const vec3l d = ref_sub(b, a), w = ref_sub(p, a);
  const long double along = ref_dot(w, d), length2 = ref_dot(d, d);
  if (along <= 0.0L || length2 == 0.0L) return ref_norm(w);
  if (along >= length2) return ref_norm(ref_sub(p, b));
  return ref_norm(ref_sub(w, ref_scale(along / length2, d)));
}

long double ref_point_triangle(vec3l p, vec3l a, vec3l b, vec3l c) {
  const long double edges =
      fminl(ref_point_segment(p, a, b), fminl(ref_point_segment(p, b, c), ref_point_segment(p, c, a)));
  const vec3l normal = ref_cross(ref_sub(b, a), ref_sub(c, a));
  const long double area = ref_norm(normal);
  if (area == 0.0L) return edges;

  /* above the inside, where p lies to the same side of all three edges */
  const long double ab = ref_dot(ref_cross(ref_sub(b, a), ref_sub(p, a)), normal);
  const long double bc = ref_dot(ref_cross(ref_sub(c, b), ref_sub(p, b)), normal);
  const long double ca = ref_dot(ref_cross(ref_sub(a, c), ref_sub(p, c)), normal);
  if (ab < 0.0L || bc < 0.0L || ca < 0.0L) return edges;
  return fminl(edges, fabsl(ref_dot(ref_sub(p, a), normal)) / area);
}

long double ref_point_polygon(vec3l p, const vec3 *vertex, size_t n) {
  /* inside or beside the column over the polygon; the nearest edge */
  bool left = false, right = false;
  long double nearest = HUGE_VALL;
  for (size_t i = 0; i < n; i++) {
    const vec3l a = {vertex[i].x, vertex[i].y, 0.0L}, b = {vertex[(i + 1) % n].x, vertex[(i + 1) % n].y, 0.0L};
    const long double side = (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
    left = left || side > 0.0L;
    right = right || side < 0.0L;
    nearest = fminl(nearest, ref_point_segment(p, a, b));
  }
  return left && right ? nearest : fminl(nearest, fabsl(p.z));
}

long double ref_point_box(vec3l p, vec3 half) {
  const vec3l outside = {fmaxl(0.0L, fabsl(p.x) - half.x), fmaxl(0.0L, fabsl(p.y) - half.y),
                         fmaxl(0.0L, fabsl(p.z) - half.z)};
  return ref_norm(outside);
}

/* Six times the signed volume. */
static long double volume(vec3l a, vec3l b, vec3l c, vec3l d) {
  return ref_dot(ref_sub(a, d), ref_cross(ref_sub(b, d), ref_sub(c, d)));
}

static bool in_tetrahedron(vec3l p, vec3l a, vec3l b, vec3l c, vec3l d) {
  const long double whole = volume(a, b, c, d);
  if (whole == 0.0L) return false;
  return volume(p, b, c, d) / whole >= 0.0L && volume(a, p, c, d) / whole >= 0.0L &&
         volume(a, b, p, d) / whole >= 0.0L && volume(a, b, c, p) / whole >= 0.0L;
}

long double ref_point_hull(vec3l p, const vec3 *vertex, size_t n) {
  if (n == 1) return ref_norm(ref_sub(p, ref_vec(vertex[0])));
  if (n == 2) return ref_point_segment(p, ref_vec(vertex[0]), ref_vec(vertex[1]));

  /* the hull is the union of its vertices' tetrahedra, its surface lies in the union of their triangles */
  long double nearest = HUGE_VALL;
  for (size_t i = 0; i < n; i++)
    for (size_t j = i + 1; j < n; j++)
      for (size_t k = j + 1; k < n; k++) {
        const vec3l a = ref_vec(vertex[i]), b = ref_vec(vertex[j]), c = ref_vec(vertex[k]);
        nearest = fminl(nearest, ref_point_triangle(p, a, b, c));
        for (size_t l = k + 1; l < n; l++)
          if (in_tetrahedron(p, a, b, c, ref_vec(vertex[l]))) return 0.0L;
      }
  return nearest;
}
