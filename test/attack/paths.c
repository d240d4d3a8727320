/* SPDX-License-Identifier: BSD-3-Clause */
#include "paths.h"
#include "support/make_curve.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char *const NAMES[PATH_FAMILIES] = {"bezier",        "bspline",    "polynomial", "legendre", "lagrange",
                                                 "trigonometric", "clothoid",   "dubins",     "involute", "pythagorean",
                                                 "smooth",        "arc length", "piecewise"};

const char *path_name(path_family family) {
  return NAMES[family];
}

/* ---- points by definition ---- */

/* The nodes and weights of Gauss' rule of twelve points on [-1, 1], by Newton's method on Legendre's polynomial. */
enum { GAUSS = 12 };

static void gauss_rule(long double *x, long double *w) {
  for (int i = 0; i < GAUSS; i++) {
    x[i] = cosl(3.14159265358979323846L * (i + 0.75L) / (GAUSS + 0.5L));
    long double slope = 1.0L;
    for (int step = 0; step < 8; step++) {
      long double p0 = 1.0L, p1 = x[i];
      for (int k = 2; k <= GAUSS; k++) {
        const long double p2 = ((2 * k - 1) * x[i] * p1 - (k - 1) * p0) / k;
        p0 = p1;
        p1 = p2;
      }
      slope = GAUSS * (x[i] * p1 - p0) / (x[i] * x[i] - 1.0L);
      x[i] -= p1 / slope;
    }
    w[i] = 2.0L / ((1.0L - x[i] * x[i]) * slope * slope);
  }
}

/* The integral of `rate` from 0 to t in panels. */
static vec3l integral(const random_path *p, vec3l (*rate)(const random_path *p, long double s), long double from,
                      long double to, int panels) {
  static long double x[GAUSS], w[GAUSS];
  if (w[0] == 0.0L) gauss_rule(x, w);
  vec3l sum = {0, 0, 0};
  const long double half = 0.5L * (to - from) / panels;
  for (int i = 0; i < panels; i++)
    for (int k = 0; k < GAUSS; k++)
      sum = ref_add(sum, ref_scale(half * w[k], rate(p, from + half * (2 * i + 1 + x[k]))));
  return sum;
}

static vec3l clothoid_rate(const random_path *p, long double t) {
  const long double angle = p->numbers[0] + t * (p->numbers[1] + 0.5L * p->numbers[2] * t);
  return (vec3l){cosl(angle), sinl(angle), 0};
}

static vec3l pythagorean_rate(const random_path *p, long double s) {
  long double q[4] = {0, 0, 0, 0};
  const int m = (int)p->n - 1;
  long double binomial = 1.0L;
  for (int i = 0; i <= m; i++) {
    const long double b = binomial * powl(s, i) * powl(1.0L - s, m - i);
    q[0] += b * p->preimage[i].w;
    q[1] += b * p->preimage[i].x;
    q[2] += b * p->preimage[i].y;
    q[3] += b * p->preimage[i].z;
    binomial = binomial * (m - i) / (i + 1);
  }
  const long double w = q[0], x = q[1], y = q[2], z = q[3];
  return (vec3l){w * w + x * x - y * y - z * z, 2.0L * (w * z + x * y), 2.0L * (x * z - w * y)};
}

static vec3l bspline_at(const random_path *p, long double t) {
  size_t r = p->degree;
  while (r + 1 < p->n && p->numbers[r + 1] <= (double)t) r++;
  while (p->numbers[r] == p->numbers[r + 1] && r > p->degree) r--;
  return ref_bspline(p->points, p->degree, p->numbers, r, t, 0);
}

static vec3l polynomial_at(const random_path *p, long double t) {
  vec3l sum = {0, 0, 0};
  for (size_t k = p->n; k-- > 0;) sum = ref_add(ref_scale(t, sum), ref_vec(p->points[k]));
  return sum;
}

static vec3l legendre_at(const random_path *p, long double t) {
  const long double x = (2.0L * t - p->t0 - p->t1) / ((long double)p->t1 - p->t0);
  long double p0 = 1.0L, p1 = x;
  vec3l sum = ref_vec(p->points[0]);
  for (size_t k = 1; k < p->n; k++) {
    sum = ref_add(sum, ref_scale(p1, ref_vec(p->points[k])));
    const long double next = ((long double)(2 * k + 1) * x * p1 - (long double)k * p0) / (long double)(k + 1);
    p0 = p1;
    p1 = next;
  }
  return sum;
}

static vec3l lagrange_at(const random_path *p, long double t) {
  vec3l sum = {0, 0, 0};
  for (size_t i = 0; i < p->n; i++) {
    long double weight = 1.0L;
    for (size_t k = 0; k < p->n; k++)
      if (k != i) weight *= (t - p->numbers[k]) / ((long double)p->numbers[i] - p->numbers[k]);
    sum = ref_add(sum, ref_scale(weight, ref_vec(p->points[i])));
  }
  return sum;
}

static vec3l trigonometric_at(const random_path *p, long double t) {
  vec3l sum = ref_vec(p->points[0]);
  for (size_t k = 1; 2 * k < p->n; k++) {
    sum = ref_add(sum, ref_scale(cosl((long double)k * t), ref_vec(p->points[2 * k - 1])));
    sum = ref_add(sum, ref_scale(sinl((long double)k * t), ref_vec(p->points[2 * k])));
  }
  return sum;
}

/* Arcs and lines as the word says, from the start. */
static vec3l dubins_at(const random_path *p, long double t) {
  static const char *const WORDS[] = {"", "LSL", "LSR", "RSL", "RSR", "RLR", "LRL"};
  vec3l x = ref_vec(p->points[0]);
  long double heading = p->numbers[0], begin = 0.0L;
  const long double radius = p->numbers[3];
  for (int i = 0; i < 3; i++) {
    const long double end = i < 2 && t > p->word.ends[i] ? p->word.ends[i] : t, length = end - begin;
    if (length > 0.0L) {
      const char turn = WORDS[p->word.word][i];
      const long double side = turn == 'S' ? 0.0L : turn == 'L' ? 1.0L : -1.0L, angle = side * length / radius;
      const long double chord = side == 0.0L ? length : 2.0L * radius * sinl(0.5L * length / radius);
      x.x += chord * cosl(heading + 0.5L * angle);
      x.y += chord * sinl(heading + 0.5L * angle);
      heading += angle;
    }
    begin = fmaxl(begin, end);
  }
  return x;
}

/* centre + radius (cos wt, sin wt, pitch t), as the caller's functions have it. */
static vec3l helix_at(const random_path *p, long double t) {
  const long double w = p->numbers[1];
  const vec3l turn = {cosl(w * t), sinl(w * t), p->numbers[2] * t};
  return ref_add(ref_vec(p->points[0]), ref_scale(p->numbers[0], turn));
}

static vec3l involute_at(const random_path *p, long double t) {
  const long double c = cosl(t), s = sinl(t), x = c + t * s, y = s - t * c, a = p->numbers[4], radius = p->numbers[3];
  const vec3l turned = {cosl(a) * x - sinl(a) * y, sinl(a) * x + cosl(a) * y, 0};
  return ref_add(ref_vec(p->points[0]), ref_scale(radius, turned));
}

static vec3l piecewise_at(const random_path *p, long double t) {
  size_t i = 0;
  while (i + 1 < p->n && t >= p->break_at[i + 1]) i++;
  const random_path *part = p->parts[i];
  const long double s = (t - p->break_at[i]) / ((long double)p->break_at[i + 1] - p->break_at[i]);
  return path_at(part, part->t0 + s * ((long double)part->t1 - part->t0));
}

vec3l path_at(const random_path *p, long double t) {
  switch (p->family) {
    case PATH_BEZIER: return ref_bezier(p->points, p->n - 1, (t - p->t0) / ((long double)p->t1 - p->t0), 0);
    case PATH_BSPLINE: return bspline_at(p, t);
    case PATH_POLYNOMIAL: return polynomial_at(p, t);
    case PATH_LEGENDRE: return legendre_at(p, t);
    case PATH_LAGRANGE: return lagrange_at(p, t);
    case PATH_TRIGONOMETRIC: return trigonometric_at(p, t);
    case PATH_CLOTHOID: {
      const int panels = 1 + (int)(2.0L * fabsl(t) * (fabs(p->numbers[1]) + fabsl(p->numbers[2] * t)));
      return ref_add(ref_vec(p->points[0]), integral(p, clothoid_rate, 0.0L, t, panels));
    }
    case PATH_DUBINS: return dubins_at(p, t);
    case PATH_INVOLUTE: return involute_at(p, t);
    case PATH_PYTHAGOREAN: {
      /* d psi/ds is a polynomial of degree 2m: exact by the rule, s in [0, 1] */
      const long double s = (t - p->t0) / ((long double)p->t1 - p->t0);
      return ref_add(ref_vec(p->points[0]), integral(p, pythagorean_rate, 0.0L, s, 1));
    }
    case PATH_SMOOTH:
    case PATH_RECTIFIABLE: return helix_at(p, t);
    default: return piecewise_at(p, t);
  }
}

/* ---- making them ---- */

static vec3 point_near(rng *r, double scale, vec3 origin, bool planar) {
  const vec3 d = rng_in_cube(r, scale);
  return vec_add(origin, vec(d.x, d.y, planar ? 0.0 : d.z));
}

static void make_points(rng *r, size_t least, size_t most, double scale, vec3 origin, bool planar, random_path *p) {
  p->n = least + rng_index(r, most - least + 1);
  const size_t pattern = rng_index(r, 8);
  for (size_t i = 0; i < p->n; i++) {
    p->points[i] = point_near(r, scale, origin, planar);
    if (i > 0 && (pattern == 0 || (pattern == 1 && i % 2))) p->points[i] = p->points[i - 1];
    if (i > 1 && pattern == 2) p->points[i] = vec_lerp(p->points[0], p->points[1], rng_uniform(r, -1.0, 2.0));
  }
}

/* Coefficients: the constant at the origin, all others of the size. */
static void make_coefficients(rng *r, size_t n, double scale, vec3 origin, bool planar, random_path *p) {
  p->n = n;
  for (size_t i = 0; i < n; i++) p->points[i] = point_near(r, scale, i == 0 ? origin : vec(0, 0, 0), planar);
}

static void make_bspline(rng *r, double scale, vec3 origin, bool planar, random_path *p) {
  p->degree = 1 + rng_index(r, 5);
  make_points(r, p->degree + 1, PATH_POINTS - 1, scale, origin, planar, p);
  double at = p->t0;
  const size_t inner = p->n - p->degree;
  for (size_t i = 0; i < p->n + p->degree + 1; i++) {
    if (i > p->degree && i <= p->n) {
      const bool repeat = i > p->degree + 2 && i < p->n && rng_index(r, 6) == 0 && p->numbers[i - 2] != at;
      if (!repeat) at = i == p->n ? p->t1 : p->t0 + (p->t1 - p->t0) * (double)(i - p->degree) / (double)inner;
    }
    p->numbers[i] = at;
  }
}

static void helix_jet(void *user, double t, cprox_vec3 jet[3]) {
  const random_path *p = user;
  const double w = p->numbers[1], radius = p->numbers[0], c = cos(w * t), s = sin(w * t);
  jet[0] = vec_add(p->points[0], vec_scale(radius, vec(c, s, p->numbers[2] * t)));
  jet[1] = vec_scale(radius, vec(-w * s, w * c, p->numbers[2]));
  jet[2] = vec_scale(radius * w * w, vec(-c, -s, 0.0));
}

static double helix_sixth(void *user, double from, double to) {
  (void)from;
  (void)to;
  const random_path *p = user;
  return 1.0000001 * p->numbers[0] * pow(p->numbers[1], 6.0);
}

static void helix_point(void *user, double t, cprox_vec3 *point) {
  cprox_vec3 jet[3];
  helix_jet(user, t, jet);
  *point = jet[0];
}

static double helix_length(void *user, double from, double to) {
  const random_path *p = user;
  return (1.0 + 1e-12) * p->numbers[0] * hypot(p->numbers[1], p->numbers[2]) * (to - from);
}

/* How far a computed point of the helix is from the exact one. */
static double helix_error(const random_path *p) {
  const double turn = fabs(p->numbers[1]) * fmax(fabs(p->t0), fabs(p->t1)),
               climb = fabs(p->numbers[2]) * fmax(fabs(p->t0), fabs(p->t1));
  return 0x1p-52 * (vec_norm(p->points[0]) + p->numbers[0] * (8.0 + turn + climb));
}

static cprox_status make_helix(attack *a, rng *r, double scale, vec3 origin, bool planar, random_path *p) {
  p->numbers[0] = scale * rng_log_uniform(r, 0.01, 1.0);
  p->numbers[1] = rng_uniform(r, 0.5, 3.0) / (p->t1 - p->t0) * 2.0;
  p->numbers[2] = planar ? 0.0 : rng_uniform(r, -1.0, 1.0) / (p->t1 - p->t0);
  p->points[0] = origin;
  p->extent = vec_norm(origin) + 4.0 * scale + p->numbers[0] * fabs(p->numbers[2]) * fmax(fabs(p->t0), fabs(p->t1));
  const double error = helix_error(p), w = p->numbers[1];
  if (p->family == PATH_RECTIFIABLE) {
    const cprox_rectifiable_curve functions = {.point = helix_point, .length = helix_length, .user = p, .error = error};
    return curve_from(describe_rectifiable(&functions, p->t0, p->t1), a->ws, &p->curve);
  }
  const cprox_smooth_curve functions = {.evaluate = helix_jet,
                                        .sixth = helix_sixth,
                                        .user = p,
                                        .error = {error, 8.0 * error * w, 8.0 * error * w * w},
                                        .accuracy = 1e-10 * scale};
  return curve_from(describe_smooth(&functions, p->t0, p->t1), a->ws, &p->curve);
}

static cprox_status make_planar(attack *a, rng *r, double scale, vec3 origin, bool planar, random_path *p) {
  p->points[0] = origin;
  p->numbers[0] = rng_uniform(r, -4.0, 4.0);
  if (p->family == PATH_DUBINS) {
    p->numbers[3] = scale * rng_log_uniform(r, 0.05, 0.5);
    p->points[1] = vec(origin.x + rng_uniform(r, -scale, scale), origin.y + rng_uniform(r, -scale, scale), origin.z);
    const cprox_status status =
        curve_from(describe_dubins(origin, p->numbers[0], p->points[1], rng_uniform(r, -4.0, 4.0), p->numbers[3],
                                   CPROX_DUBINS_SHORTEST),
                   a->ws, &p->curve);
    if (status != CPROX_OK) return status;
    const cprox_curve_info info = cprox_curve_get_info(p->curve);
    p->t0 = info.t0, p->t1 = info.t1, p->word = info.dubins;
    return status;
  }
  if (p->family == PATH_INVOLUTE) {
    p->numbers[3] = scale * rng_log_uniform(r, 0.05, 0.5);
    p->numbers[4] = rng_uniform(r, -4.0, 4.0);
    p->t0 = rng_uniform(r, -4.0, 3.0);
    p->t1 = p->t0 + rng_log_uniform(r, 1e-2, 4.0);
    return curve_from(describe_involute(origin, p->numbers[3], p->numbers[4], p->t0, p->t1), a->ws, &p->curve);
  }
  if (p->family == PATH_CLOTHOID) {
    p->t1 = scale * rng_log_uniform(r, 0.1, 3.0);
    p->t0 = rng_index(r, 2) ? 0.0 : p->t1 * rng_uniform(r, -1.0, 0.9);
    p->numbers[1] = rng_index(r, 4) ? rng_uniform(r, -2.0, 2.0) / scale : 0.0;
    p->numbers[2] = rng_index(r, 4) ? rng_uniform(r, -1.0, 1.0) / (scale * scale) : 0.0;
    return curve_from(describe_clothoid(origin, p->numbers[0], p->numbers[1], p->numbers[2], p->t0, p->t1), a->ws,
                      &p->curve);
  }
  /* Pythagorean hodographs; in the plane with preimages (a, 0, 0, b) */
  p->n = 1 + rng_index(r, 5);
  const double size = sqrt(scale);
  for (size_t i = 0; i < p->n; i++) {
    p->preimage[i] = (cprox_quat){size * rng_uniform(r, -1, 1), size * rng_uniform(r, -1, 1),
                                  size * rng_uniform(r, -1, 1), size * rng_uniform(r, -1, 1)};
    if (planar) p->preimage[i].x = p->preimage[i].y = 0.0;
  }
  return curve_from(describe_pythagorean_hodograph(origin, p->preimage, p->n, p->t0, p->t1), a->ws, &p->curve);
}

static cprox_status make_piecewise(attack *a, rng *r, double scale, vec3 origin, bool planar, random_path *p) {
  static const path_family PARTS[] = {PATH_BEZIER, PATH_POLYNOMIAL, PATH_CLOTHOID, PATH_TRIGONOMETRIC, PATH_LAGRANGE};
  const cprox_curve *curves[PATH_PARTS];
  p->n = 1 + rng_index(r, PATH_PARTS);
  for (size_t i = 0; i <= p->n; i++)
    p->break_at[i] = i == p->n ? p->t1 : p->t0 + (p->t1 - p->t0) * (double)i / (double)p->n;
  for (size_t i = 0; i < p->n; i++) {
    p->parts[i] = calloc(1, sizeof *p->parts[i]);
    path_make(a, r, PARTS[rng_index(r, 5)], scale, origin, planar, p->parts[i]);
    curves[i] = p->parts[i]->curve;
    if (!curves[i]) return CPROX_INVALID;
    p->extent = fmax(p->extent, p->parts[i]->extent);
  }
  return curve_from(describe_piecewise(curves, p->n, p->break_at, INFINITY), a->ws, &p->curve);
}

bool path_has_range(path_family family) {
  return family != PATH_CLOTHOID && family != PATH_DUBINS && family != PATH_INVOLUTE;
}

static cprox_status make(attack *a, rng *r, double scale, vec3 origin, bool planar, random_path *p) {
  double *const numbers = p->numbers;
  const double far = fmax(1.0, fmax(fabs(p->t0), fabs(p->t1)));
  switch (p->family) {
    case PATH_BEZIER:
      make_points(r, 2, PATH_POINTS, scale, origin, planar, p);
      return curve_from(describe_bezier(p->points, p->n, p->t0, p->t1), a->ws, &p->curve);
    case PATH_BSPLINE:
      make_bspline(r, scale, origin, planar, p);
      return curve_from(describe_bspline(p->points, p->n, p->degree, numbers, p->n + p->degree + 1, p->t0, p->t1),
                        a->ws, &p->curve);
    case PATH_POLYNOMIAL:
      make_coefficients(r, 1 + rng_index(r, 9), scale, origin, planar, p);
      for (size_t k = 1; k < p->n; k++) p->points[k] = vec_scale(pow(far, -(double)k), p->points[k]);
      return curve_from(describe_polynomial(p->points, p->n, p->t0, p->t1), a->ws, &p->curve);
    case PATH_LEGENDRE:
      make_coefficients(r, 1 + rng_index(r, PATH_POINTS), scale, origin, planar, p);
      return curve_from(describe_legendre(p->points, p->n, p->t0, p->t1), a->ws, &p->curve);
    case PATH_LAGRANGE:
      make_points(r, 1, 8, scale, origin, planar, p);
      for (size_t i = 0; i < p->n; i++)
        numbers[i] =
            p->n == 1 ? p->t0 : p->t0 + (p->t1 - p->t0) * ((double)i + rng_uniform(r, 0.0, 0.3)) / (double)(p->n - 1);
      return curve_from(describe_lagrange(p->points, numbers, p->n, p->t0, p->t1), a->ws, &p->curve);
    case PATH_TRIGONOMETRIC:
      make_coefficients(r, 3 + 2 * rng_index(r, 4), scale, origin, planar, p);
      return curve_from(describe_trigonometric(p->points, p->n, p->t0, p->t1), a->ws, &p->curve);
    case PATH_SMOOTH:
    case PATH_RECTIFIABLE: return make_helix(a, r, scale, origin, planar, p);
    case PATH_PIECEWISE: return make_piecewise(a, r, scale, origin, planar, p);
    default: return make_planar(a, r, scale, origin, planar, p);
  }
}

void path_make_on(attack *a, rng *r, path_family family, double scale, vec3 origin, bool planar, double t0, double t1,
                  random_path *p) {
  memset(p, 0, sizeof *p);
  p->family = family;
  p->t0 = t0;
  p->t1 = t1;
  if (make(a, r, scale, origin, planar, p) < 0)
    attack_fail(a, "a %s curve was refused: %s", NAMES[family], cprox_workspace_error(a->ws));
  double sum = vec_norm(origin) + 20.0 * scale;
  for (size_t i = 0; i < p->n && i < PATH_POINTS; i++) sum += vec_norm(p->points[i]);
  p->extent = fmax(p->extent, sum);
}

void path_make(attack *a, rng *r, path_family family, double scale, vec3 origin, bool planar, random_path *p) {
  const double length = rng_index(r, 3) ? 1.0 : rng_log_uniform(r, 0.1, 10.0);
  const double t0 = rng_index(r, 3) ? 0.0 : rng_uniform(r, -10.0, 10.0);
  path_make_on(a, r, family, scale, origin, planar, t0, t0 + length, p);
}

void path_free(random_path *p) {
  cprox_curve_free(p->curve);
  for (size_t i = 0; i < PATH_PARTS; i++)
    if (p->parts[i]) {
      path_free(p->parts[i]);
      free(p->parts[i]);
    }
}
