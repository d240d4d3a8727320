/* SPDX-License-Identifier: BSD-3-Clause */
/* Nearest points of the primitives, held against long double at every scale and aspect ratio. */
#include "base/rounding.h"
#include "shape/body.h"
#include "support/cases.h"
#include "support/random.h"
#include "support/reference.h"

enum { CASES = 100000, SIZES_EACH = 8 };

/* ---- the same distances in long double, by other ways ---- */

/* Distance of (px, py) from the segment a b in a plane. */
static long double plane_segment(long double px, long double py, long double ax, long double ay, long double bx,
                                 long double by) {
  const vec3l p = {px, py, 0}, a = {ax, ay, 0}, b = {bx, by, 0};
  return ref_point_segment(p, a, b);
}

static long double ref_sphere(const double *size, vec3l y) {
  return ref_norm(y) - size[0];
}

static long double ref_box(const double *size, vec3l y) {
  const long double depth = fmaxl(fabsl(y.x) - size[0], fmaxl(fabsl(y.y) - size[1], fabsl(y.z) - size[2]));
  return depth <= 0 ? depth : ref_point_box(y, vec(size[0], size[1], size[2]));
}

static long double ref_capsule(const double *size, vec3l y) {
  const vec3l a = {0, 0, -(long double)size[1]}, b = {0, 0, size[1]};
  return ref_point_segment(y, a, b) - size[0];
}

static long double ref_cylinder(const double *size, vec3l y) {
  const long double a = hypotl(y.x, y.y) - size[0], b = fabsl(y.z) - size[1];
  if (a <= 0 || b <= 0) return fmaxl(a, b);
  return hypotl(a, b);
}

/* The cone's surface in the meridian plane is a base and a slant. */
static long double ref_cone(const double *size, vec3l y) {
  const long double r = size[0], h = size[1], rho = hypotl(y.x, y.y);
  const long double d = fminl(plane_segment(rho, y.z, 0, -h, r, -h), plane_segment(rho, y.z, r, -h, 0, h));
  return y.z >= -h && rho * (2 * h) + (y.z - h) * r <= 0 ? -d : d;
}

/* Lagrange: x_i = e_i² y_i/(t + e_i²); s = t + e_min² is found by bisecting its logarithm. */
static long double ref_ellipsoid(const double *size, vec3l y) {
  const long double p[3] = {fabsl(y.x), fabsl(y.y), fabsl(y.z)};
  int m = 0;
  for (int i = 1; i < 3; i++)
    if (size[i] < size[m]) m = i;
  long double e[3], k[3], high = 0, g0 = 0;
  bool infinite = false;
  for (int i = 0; i < 3; i++) {
    e[i] = size[i];
    k[i] = (e[i] - size[m]) * (e[i] + size[m]);
    high += e[i] * p[i] * e[i] * p[i];
    if (p[i] == 0) continue;
    if (k[i] == 0)
      infinite = true;
    else
      g0 += e[i] * p[i] / k[i] * (e[i] * p[i] / k[i]);
  }
  long double x[3], out = 0, d = 0;
  if (infinite || g0 >= 1) {
    high = sqrtl(high) * 2;
    long double low = high * 1e-4000L;
    for (int step = 0; step < 20000 && low < high; step++) {
      const long double s = sqrtl(low) * sqrtl(high);
      if (s <= low || s >= high) break;
      long double g = 0;
      for (int i = 0; i < 3; i++) g += p[i] == 0 ? 0 : e[i] * p[i] / (s + k[i]) * (e[i] * p[i] / (s + k[i]));
      if (g > 1)
        low = s;
      else
        high = s;
    }
    for (int i = 0; i < 3; i++) x[i] = p[i] == 0 ? 0 : e[i] * (e[i] * p[i] / (low + k[i]));
  } else {
    long double rest = 1;
    for (int i = 0; i < 3; i++) {
      x[i] = p[i] == 0 ? 0 : e[i] * (e[i] * p[i] / k[i]);
      rest -= x[i] / e[i] * (x[i] / e[i]);
    }
    x[m] = e[m] * sqrtl(rest);
  }
  for (int i = 0; i < 3; i++) {
    out += p[i] / e[i] * (p[i] / e[i]);
    d += (p[i] - x[i]) * (p[i] - x[i]);
  }
  return out > 1 ? sqrtl(d) : -sqrtl(d);
}

/* ---- shapes and points that are hard ---- */

typedef struct kind {
  const char *name;
  cprox_body *(*create)(const double *size);
  long double (*distance)(const double *size, vec3l y);
  uint64_t seed;
  double aspect;
} kind;

static cprox_body *created(cprox_status status, cprox_body *body) {
  assert_int_equal(status, CPROX_OK);
  return body;
}

#define CREATE(name, call)                   \
  static cprox_body *name(const double *s) { \
    cprox_body *body = NULL;                 \
    const cprox_status status = call;        \
    return created(status, body);            \
  }
CREATE(make_sphere, ((void)s[1], cprox_body_create_sphere(s[0], NULL, &body)))
CREATE(make_box, cprox_body_create_box(vec(2 * s[0], 2 * s[1], 2 * s[2]), NULL, &body))
CREATE(make_capsule, cprox_body_create_capsule(2 * s[1], s[0], NULL, &body))
CREATE(make_cylinder, cprox_body_create_cylinder(2 * s[1], s[0], NULL, &body))
CREATE(make_cone, cprox_body_create_cone(2 * s[1], s[0], NULL, &body))
CREATE(make_ellipsoid, cprox_body_create_ellipsoid(vec(s[0], s[1], s[2]), NULL, &body))

static const kind SPHERE = {"sphere", make_sphere, ref_sphere, 101, 1e6};
static const kind BOX = {"box", make_box, ref_box, 102, 1e6};
static const kind CAPSULE = {"capsule", make_capsule, ref_capsule, 103, 1e6};
static const kind CYLINDER = {"cylinder", make_cylinder, ref_cylinder, 104, 1e6};
static const kind CONE = {"cone", make_cone, ref_cone, 105, 1e6};
static const kind ELLIPSOID = {"ellipsoid", make_ellipsoid, ref_ellipsoid, 106, 1e6};

static void random_size(rng *r, double aspect, double *size) {
  const double scale = rng_log_uniform(r, 1e-6, 1e6);
  const bool tame = rng_index(r, 3) == 0, equal = rng_index(r, 8) == 0;
  for (int i = 0; i < 3; i++)
    size[i] = scale * (tame ? rng_uniform(r, 0.5, 2.0) : rng_log_uniform(r, 1.0 / aspect, 1.0));
  if (rng_index(r, 8) == 0) size[1] = size[0];
  if (equal) size[1] = size[2] = size[0];
  /* the quotient of two of them rounds: keep it within the limit of the constructor */
  for (int i = 0; i < 3; i++) size[i] = fmax(size[i], 1.0000001 * scale / aspect);
}

/* A coordinate on, beside or far from what a size marks. */
static double random_coordinate(rng *r, double size, double scale) {
  const double side = rng_index(r, 2) ? 1.0 : -1.0;
  switch (rng_index(r, 8)) {
    case 0: return 0.0;
    case 1: return side * size;
    case 2: return side * size * (1.0 + (double)rng_index(r, 9) * 2.0 * ROUND_U - 8.0 * ROUND_U);
    case 3: return side * size * (1.0 + rng_log_uniform(r, 1e-15, 1e-3) * side);
    case 4: return side * scale * rng_log_uniform(r, 1e-30, 1.0);
    case 5: return side * scale * rng_log_uniform(r, 1.0, 1e6);
    default: return rng_uniform(r, -1.5, 1.5) * (rng_index(r, 2) ? size : scale);
  }
}

static vec3 random_point(rng *r, const convex *shape) {
  const double *s = shape->size;
  const cprox_body_kind type = shape->ops->kind;
  const bool round = type == CPROX_BODY_CAPSULE || type == CPROX_BODY_CYLINDER || type == CPROX_BODY_CONE;
  const double scale = shape->scale;
  if (rng_index(r, 4) == 0) { /* on the surface, or a little beside it */
    vec3 at;
    const vec3 d = rng_unit(r);
    shape->ops->support(shape, vec(d.x / (s[0] + 1e-3 * scale), d.y, d.z * rng_log_uniform(r, 1e-6, 1.0)), NULL, &at);
    return vec_axpy(at, shape->margin + (rng_index(r, 2) ? scale * rng_log_uniform(r, 1e-18, 1.0) : 0.0), d);
  }
  if (round) { /* the sizes mark the distance from the axis and the height */
    const double rho = random_coordinate(r, s[0], scale), angle = rng_uniform(r, 0.0, 7.0);
    const double z = random_coordinate(r, s[1], scale);
    return rng_index(r, 3) == 0 ? vec(rho, 0, z) : vec(rho * cos(angle), rho * sin(angle), z);
  }
  return vec(random_coordinate(r, s[0], scale), random_coordinate(r, s[1], scale), random_coordinate(r, s[2], scale));
}

static double feature_distance(const convex_near *near, vec3 y) {
  vec3 w = vec_sub(y, near->origin);
  for (int i = 0; i < near->tangents; i++) w = vec_axpy(w, -vec_dot(near->e[i], w), near->e[i]);
  return vec_norm(w) - near->offset;
}

/* What must hold of an answer whatever the kind. The slack is near_rounding u (|y| + scale), as convex.h states it. */
static void check_answer(const kind *k, const convex *shape, vec3 y, const convex_near *near, long double exact,
                         long double *worst) {
  const double reach = vec_norm(y) + shape->scale, slack = shape->ops->near_rounding * ROUND_U * reach;
  const long double error = fabsl(near->distance - exact);
  if (!(error <= slack))
    fail_msg("%s (%.17g %.17g %.17g) at (%.17g %.17g %.17g): distance %.17g, exact %.20Lg, off by %Lg, allowed %g",
             k->name, shape->size[0], shape->size[1], shape->size[2], y.x, y.y, y.z, near->distance, exact, error,
             slack);
  *worst = fmaxl(*worst, error / (long double)(ROUND_U * reach));

  /* the point is that far away, and on the shape: the shape's own distance says so */
  const long double away = ref_norm(ref_sub(ref_vec(y), ref_vec(near->point)));
  if (!(fabsl(away - fabsl(exact)) <= 2 * slack))
    fail_msg("%s: the point is %.20Lg away, the distance is %.20Lg", k->name, away, exact);
  if (!(fabsl(k->distance(shape->size, ref_vec(near->point))) <= 2 * slack))
    fail_msg("%s (%.17g %.17g %.17g) at (%.17g %.17g %.17g): the point is %.3Lg off the surface", k->name,
             shape->size[0], shape->size[1], shape->size[2], y.x, y.y, y.z,
             k->distance(shape->size, ref_vec(near->point)));

  /* the normal is a unit vector; with it weak duality bounds the distance from below, outside as tightly as its
   * rounding near the surface lets it */
  assert_true(fabs(vec_norm(near->normal) - 1.0) <= 8.0 * ROUND_U);
  const double h = shape->ops->support(shape, near->normal, NULL, NULL) + shape->margin;
  const double bound = vec_dot(near->normal, y) - h;
  if (!(bound <= (double)exact + slack + 16.0 * ROUND_U * reach))
    fail_msg("%s: the bound of the normal is %.17g, above the distance %.20Lg", k->name, bound, exact);
  if (exact > 1e-3 * shape->scale && bound < (double)exact - 1e-9 * reach)
    fail_msg("%s: the bound of the normal is %.17g, far below the distance %.20Lg", k->name, bound, exact);

  if (near->flat && !(fabs(feature_distance(near, y) - near->distance) <= 8.0 * slack))
    fail_msg("%s: the feature says %.17g, the distance is %.17g", k->name, feature_distance(near, y), near->distance);
}

static void check_kind(const kind *k) {
  rng r = rng_seed(k->seed);
  long double worst = 0;
  for (size_t i = 0; i < test_cases(CASES / SIZES_EACH); i++) {
    double size[3];
    random_size(&r, k->aspect, size);
    cprox_body *body = k->create(size);
    for (int j = 0; j < SIZES_EACH; j++) {
      const vec3 y = random_point(&r, &body->shape);
      convex_near near;
      body->shape.ops->nearest(&body->shape, y, NULL, &near);
      check_answer(k, &body->shape, y, &near, k->distance(body->shape.size, ref_vec(y)), &worst);
    }
    cprox_body_free(body);
  }
  print_message("%s: worst error %.2Lf u (|y| + scale)\n", k->name, worst);
}

/* Seeds 101 to 106, 1e5 points each at scales 1e-6 to 1e6, aspects up to 1e6: on and beside faces, edges, rims, axes
 * and surfaces, and far away. Long double (2^-64) is 2048 times finer than what is tested. */
CASE(the_distance_of_a_sphere_is_within_its_rounding) {
  check_kind(&SPHERE);
}
CASE(the_distance_of_a_box_is_within_its_rounding) {
  check_kind(&BOX);
}
CASE(the_distance_of_a_capsule_is_within_its_rounding) {
  check_kind(&CAPSULE);
}
CASE(the_distance_of_a_cylinder_is_within_its_rounding) {
  check_kind(&CYLINDER);
}
CASE(the_distance_of_a_cone_is_within_its_rounding) {
  check_kind(&CONE);
}
CASE(the_distance_of_an_ellipsoid_is_within_its_rounding) {
  check_kind(&ELLIPSOID);
}

/* Seed 107, 1e5 points. The point must be attained, whatever rounding did: the exact sum is at most 1. */
CASE(the_nearest_point_of_an_ellipsoid_is_a_point_of_it) {
  rng r = rng_seed(107);
  for (size_t i = 0; i < test_cases(CASES); i++) {
    double size[3];
    random_size(&r, 1e6, size);
    cprox_body *body = make_ellipsoid(size);
    convex_near near;
    body->shape.ops->nearest(&body->shape, random_point(&r, &body->shape), NULL, &near);
    const vec3l x = ref_vec(near.point);
    const long double a = x.x / size[0], b = x.y / size[1], c = x.z / size[2];
    if (a * a + b * b + c * c > 1) fail_msg("the point is outside by %Lg", a * a + b * b + c * c - 1);
    cprox_body_free(body);
  }
}

static double at_distance(const convex *shape, vec3 y) {
  convex_near near;
  shape->ops->nearest(shape, y, NULL, &near);
  return near.distance;
}

/* A cone's side is told from its rim by being straight. */
static bool same_feature(const convex_near *a, const convex_near *b) {
  if (a->flat != b->flat || a->tangents != b->tangents) return false;
  if (!a->flat) return (a->hessian[5] == 0.0) == (b->hessian[5] == 0.0);
  if (a->tangents == 0) return vec_equal(a->origin, b->origin);
  return vec_equal(a->e[0], b->e[0]) && (a->tangents == 1 || vec_equal(a->e[1], b->e[1]));
}

/* Seed 108, 2e4 points a kind outside shapes of aspect up to 3, no nearer than 0.1 sizes, not within 1e-2 of a border
 * between features. Second differences with steps of 1e-4 sizes are good to 1e-7 (rounding/step², truncation step²). */
CASE(the_distance_field_bends_as_its_feature_says) {
  const kind *kinds[] = {&SPHERE, &BOX, &CAPSULE, &CYLINDER, &CONE, &ELLIPSOID};
  rng r = rng_seed(108);
  for (size_t i = 0; i < test_cases(6 * 20000); i++) {
    const kind *k = kinds[i % 6];
    const double size[3] = {rng_uniform(&r, 0.5, 1.5), rng_uniform(&r, 0.5, 1.5), rng_uniform(&r, 0.5, 1.5)};
    cprox_body *body = k->create(size);
    const convex *shape = &body->shape;
    const vec3 y = rng_in_cube(&r, 4.0), d = rng_unit(&r);
    convex_near near, beside[2];
    shape->ops->nearest(shape, y, NULL, &near);
    shape->ops->nearest(shape, vec_axpy(y, 1e-2, d), NULL, &beside[0]);
    shape->ops->nearest(shape, vec_axpy(y, -1e-2, d), NULL, &beside[1]);
    const bool border = !same_feature(&near, &beside[0]) || !same_feature(&near, &beside[1]);
    if (near.distance > 0.1 && !border) {
      const double step = 1e-4, up = at_distance(shape, vec_axpy(y, step, d)),
                   down = at_distance(shape, vec_axpy(y, -step, d));
      const double slope = (up - down) / (2 * step), bend = (up - 2 * near.distance + down) / (step * step);
      assert_true(fabs(slope - vec_dot(near.normal, d)) < 1e-6);
      double stated;
      if (near.flat) {
        const double far = 1e-2, a = feature_distance(&near, vec_axpy(y, far, d)), b = beside[0].distance;
        assert_true(fabs(a - b) < 1e-12);
        stated = bend;
      } else {
        const double *h = near.hessian;
        stated = d.x * (h[0] * d.x + 2 * h[1] * d.y + 2 * h[2] * d.z) + d.y * (h[3] * d.y + 2 * h[4] * d.z) +
                 h[5] * d.z * d.z;
      }
      if (!(fabs(stated - bend) < 2e-5))
        fail_msg("%s at (%g %g %g): second derivative %.9g, differences say %.9g", k->name, y.x, y.y, y.z, stated,
                 bend);
    }
    cprox_body_free(body);
  }
}

int main(void) {
  return cases_run(NULL, NULL);
}
