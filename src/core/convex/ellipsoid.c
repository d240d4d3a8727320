/* SPDX-License-Identifier: BSD-3-Clause */
/* The ellipsoid sum (x_i/a_i)² <= 1. size: semi-axes. Its core is what is left when the largest ball that is a summand
 * of it, of radius a_min²/a_max, is split off. */
#include "base/rounding.h"
#include "convex/feature.h"

enum { ELLIPSOID_MAX_STEPS = 60 };

/* The point in the first octant, axes in descending order: rz_i = r_i |y_i|/e_i with r_i = (e_i/e_2)², and k_i = r_i -
 * 1 without cancellation. */
typedef struct ellipsoid_octant {
  int axis[3];
  double e[3], y[3], r[3], k[3], rz[3];
} ellipsoid_octant;

static ellipsoid_octant ellipsoid_sort(const double semi_axes[3], vec3 point) {
  const double p[3] = {point.x, point.y, point.z};
  ellipsoid_octant o = {.axis = {0, 1, 2}};
  for (int pass = 0; pass < 3; pass++) {
    const int i = pass == 1 ? 1 : 0;
    if (semi_axes[o.axis[i]] >= semi_axes[o.axis[i + 1]]) continue;
    const int swap = o.axis[i];
    o.axis[i] = o.axis[i + 1];
    o.axis[i + 1] = swap;
  }
  const double least = semi_axes[o.axis[2]];
  for (int i = 0; i < 3; i++) {
    o.e[i] = semi_axes[o.axis[i]];
    o.y[i] = fabs(p[o.axis[i]]);
    const double q = o.e[i] / least;
    o.r[i] = q * q;
    o.k[i] = ((o.e[i] - least) / least) * ((o.e[i] + least) / least);
    /* a coordinate that small cannot be told from 0, and its square would be lost */
    if (o.y[i] < 1e-130 * least) o.y[i] = 0.0;
    o.rz[i] = o.r[i] * (o.y[i] / o.e[i]);
  }
  return o;
}

/* G(sigma) = sum (rz_i/(sigma + k_i))², and D = sum rz_i²/(sigma + k_i)³. */
static double ellipsoid_g(const ellipsoid_octant *o, double sigma, double *d) {
  double g = 0.0;
  *d = 0.0;
  for (int i = 0; i < 3; i++) {
    if (o->rz[i] == 0.0) continue;
    const double w = o->rz[i] / (sigma + o->k[i]);
    g += w * w;
    *d += w * w / (sigma + o->k[i]);
  }
  return g;
}

/* The root of G = 1: Newton on 1/sqrt(G), which is nearly a straight line, from a point at or left of the root. */
static double ellipsoid_solve(const ellipsoid_octant *o) {
  double sigma = 0.0;
  for (int i = 0; i < 3; i++) sigma = fmax(sigma, o->rz[i] - o->k[i]);
  for (int step = 0; step < ELLIPSOID_MAX_STEPS; step++) {
    double d;
    const double g = ellipsoid_g(o, sigma, &d), root = sqrt(g);
    if (fabs(root - 1.0) <= 4.0 * ROUND_U) break;
    double next = sigma + g * (root - 1.0) / d;
    if (!(next > 0.0)) next = 0.5 * sigma;
    if (next == sigma) break;
    sigma = next;
  }
  return sigma;
}

/* The second derivative of the distance at y: S (1 + d S)^-1 on the tangent plane, S the shape operator at x. */
static void ellipsoid_hessian(const double semi_axes[3], vec3 x, vec3 n, double d, double hessian[6]) {
  const vec3 w = vec(1.0 / (semi_axes[0] * semi_axes[0]), 1.0 / (semi_axes[1] * semi_axes[1]),
                     1.0 / (semi_axes[2] * semi_axes[2]));
  const double gradient = vec_norm(vec(x.x * w.x, x.y * w.y, x.z * w.z));
  vec3 e, f;
  feature_tangents(n, &e, &f);
  const double see = (e.x * e.x * w.x + e.y * e.y * w.y + e.z * e.z * w.z) / gradient;
  const double sef = (e.x * f.x * w.x + e.y * f.y * w.y + e.z * f.z * w.z) / gradient;
  const double sff = (f.x * f.x * w.x + f.y * f.y * w.y + f.z * f.z * w.z) / gradient;
  const double trace = see + sff, det = see * sff - sef * sef;
  const double spread = 1.0 + d * trace + d * d * det; /* 0 at a centre of curvature, inside */
  const double scale = spread > 0.0 ? 1.0 / spread : 0.0;
  const double a = scale * (see + d * det), b = scale * sef, c = scale * (sff + d * det);
  hessian[0] = a * e.x * e.x + 2.0 * b * e.x * f.x + c * f.x * f.x;
  hessian[1] = a * e.x * e.y + b * (e.x * f.y + e.y * f.x) + c * f.x * f.y;
  hessian[2] = a * e.x * e.z + b * (e.x * f.z + e.z * f.x) + c * f.x * f.z;
  hessian[3] = a * e.y * e.y + 2.0 * b * e.y * f.y + c * f.y * f.y;
  hessian[4] = a * e.y * e.z + b * (e.y * f.z + e.z * f.y) + c * f.y * f.z;
  hessian[5] = a * e.z * e.z + 2.0 * b * e.z * f.z + c * f.z * f.z;
}

static void ellipsoid_nearest(const convex *shape, vec3 y, convex_hint *hint, convex_near *near) {
  (void)hint;
  const double p[3] = {y.x, y.y, y.z};
  const ellipsoid_octant o = ellipsoid_sort(shape->size, y);
  double x[3], n[3], unused;
  *near = (convex_near){0};

  if (o.y[2] == 0.0 && (o.y[1] == 0.0 || o.k[1] > 0.0) && (o.y[0] == 0.0 || o.k[0] > 0.0) &&
      ellipsoid_g(&o, 0.0, &unused) < 1.0) {
    /* in the plane of the longer axes, within the curve that the centres of curvature make: two points are nearest, one
     * on each side of the plane */
    double rest = 1.0, d2 = 0.0;
    for (int i = 0; i < 2; i++) {
      const double t = o.y[i] > 0.0 ? o.rz[i] / o.k[i] : 0.0;
      x[i] = t * o.e[i];
      n[i] = o.y[i] > 0.0 ? o.y[i] / o.k[i] : 0.0;
      rest -= t * t;
      d2 += n[i] * n[i];
    }
    n[2] = x[2] = o.e[2] * sqrt(fmax(rest, 0.0));
    near->distance = -sqrt(d2 + n[2] * n[2]);
  } else {
    /* x_i = r_i y_i/(sigma + k_i), y - x = (sigma - 1) y/(sigma + k), and the normal is along y/(sigma + k) */
    const double sigma = ellipsoid_solve(&o);
    for (int i = 0; i < 3; i++) {
      n[i] = o.y[i] > 0.0 ? o.y[i] / (sigma + o.k[i]) : 0.0;
      x[i] = o.y[i] > 0.0 ? o.rz[i] / (sigma + o.k[i]) * o.e[i] : 0.0;
    }
    near->distance = (sigma - 1.0) * vec_norm(vec(n[0], n[1], n[2]));
  }

  /* back to the octant of y; the point is drawn in by more than its rounding, so that it is a point of the ellipsoid */
  double q[3] = {0, 0, 0}, normal[3] = {0, 0, 0};
  for (int i = 0; i < 3; i++) {
    const double side = p[o.axis[i]] < 0.0 ? -1.0 : 1.0;
    q[o.axis[i]] = side * (x[i] * (1.0 - 40.0 * ROUND_U));
    normal[o.axis[i]] = side * n[i];
  }
  near->point = vec(q[0], q[1], q[2]);
  feature_unit(vec(normal[0], normal[1], normal[2]), &near->normal);
  ellipsoid_hessian(shape->size, near->point, near->normal, near->distance, near->hessian);
}

/* |Dd| - m |d|, and the extreme point D²d/|Dd| - m d/|d| of the core. */
static inline double ellipsoid_reach(const convex *shape, vec3 d, vec3 *at) {
  const double *a = shape->size, m = shape->margin;
  vec3 scaled, unit;
  const double eta = feature_unit(vec(a[0] * d.x, a[1] * d.y, a[2] * d.z), &scaled), length = feature_unit(d, &unit);
  *at = vec(a[0] * scaled.x - m * unit.x, a[1] * scaled.y - m * unit.y, a[2] * scaled.z - m * unit.z);
  return eta - m * length;
}

static double ellipsoid_support(const convex *shape, vec3 d, convex_hint *hint, vec3 *at) {
  (void)hint;
  vec3 unused;
  return ellipsoid_reach(shape, d, at ? at : &unused);
}

static vec3 ellipsoid_follow(const convex *shape, vec3 d, vec3 x) {
  ellipsoid_reach(shape, d, &x);
  return x;
}

static void ellipsoid_curvature(const convex *shape, vec3 d, vec3 x, double hessian[6]) {
  (void)x;
  /* (D² - x x^T)/eta - m (1 - d d^T), eta = |Dd|, x = D²d/eta the maximiser of the whole ellipsoid */
  const double *a = shape->size, m = shape->margin;
  const double eta = vec_norm(vec(a[0] * d.x, a[1] * d.y, a[2] * d.z));
  const vec3 w = vec(a[0] * a[0] * d.x / eta, a[1] * a[1] * d.y / eta, a[2] * a[2] * d.z / eta);
  hessian[0] = (a[0] * a[0] - w.x * w.x) / eta - m * (1.0 - d.x * d.x);
  hessian[1] = -w.x * w.y / eta + m * d.x * d.y;
  hessian[2] = -w.x * w.z / eta + m * d.x * d.z;
  hessian[3] = (a[1] * a[1] - w.y * w.y) / eta - m * (1.0 - d.y * d.y);
  hessian[4] = -w.y * w.z / eta + m * d.y * d.z;
  hessian[5] = (a[2] * a[2] - w.z * w.z) / eta - m * (1.0 - d.z * d.z);
}

/* Blaschke: a ball of the largest radius of curvature, a_max²/a_min, that touches from outside contains the ellipsoid.
 */
static bool ellipsoid_cover(const convex *shape, const convex_near *near, convex_cover *cover) {
  const double *a = shape->size;
  const double most = fmax(a[0], fmax(a[1], a[2])), least = fmin(a[0], fmin(a[1], a[2]));
  const double radius = most * (most / least);
  *cover = (convex_cover){.centre = vec_axpy(near->point, -radius, near->normal)};
  /* normal and point are off the exact ones by a few u (and 40u), R n with them */
  cover->radius = radius * (1.0 + 32.0 * ROUND_U) + 128.0 * ROUND_U * most;
  return true;
}

/* near_rounding: each term rz_i/(sigma + k_i) is within 12u, so G within 27u and the sigma found solves the problem of
 * a point within 18u |y| of y; the formula for d adds 30u of d <= |y| + a_max. */
const convex_ops convex_ellipsoid = {.kind = CPROX_BODY_ELLIPSOID,
                                     .near_rounding = 64.0,
                                     .closed_form = true,
                                     .round_core = CONVEX_ROUND_IF_EQUAL,
                                     .nearest = ellipsoid_nearest,
                                     .support = ellipsoid_support,
                                     .curvature = ellipsoid_curvature,
                                     .smooth = true,
                                     .follow = ellipsoid_follow,
                                     .cover = ellipsoid_cover};
