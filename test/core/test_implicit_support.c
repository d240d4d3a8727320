/* SPDX-License-Identifier: BSD-3-Clause */
/* The support function of implicit bodies along directions that are normal to faces, edges and straight lines of the
 * body, exactly or but for 1e-3 … 1e-17: there the body's extreme points are many, or hardly fewer. */
#include <math.h>

#include "curve_proximity/cprox.h"
#include "shape/body.h"
#include "support/cases.h"
#include "support/random.h"

enum { MOST_PLANES = 12 };

typedef struct solid {
  double planes[MOST_PLANES][4], quadrics[1][10], terms[3][5];
  cprox_hyperquadric power;
  size_t n;
  vec3 line; /* the body's curved part is a cylinder along it; 0: it has none */
  cprox_body *body;
} solid;

/* Whether the planes' normals surround the origin, by a margin: else their body is unbounded. */
static bool surrounds(const solid *s) {
  for (size_t i = 0; i < s->n; i++)
    for (size_t j = 0; j < i; j++)
      for (int sign = -1; sign <= 1; sign += 2) {
        const vec3 a = vec(s->planes[i][0], s->planes[i][1], s->planes[i][2]);
        const vec3 b = vec(s->planes[j][0], s->planes[j][1], s->planes[j][2]);
        const vec3 d = vec_scale(sign / vec_norm(vec_cross(a, b)), vec_cross(a, b));
        double most = -INFINITY;
        for (size_t k = 0; k < s->n; k++)
          if (k != i && k != j) most = fmax(most, vec_dot(d, vec(s->planes[k][0], s->planes[k][1], s->planes[k][2])));
        if (!(most > 0.1)) return false;
      }
  return true;
}

static void random_planes(rng *r, solid *s, size_t n, double scale) {
  s->n = n;
  do
    for (size_t i = 0; i < n; i++) {
      const vec3 b = vec_scale(rng_log_uniform(r, 0.5, 2), rng_unit(r));
      s->planes[i][0] = b.x, s->planes[i][1] = b.y, s->planes[i][2] = b.z;
      s->planes[i][3] = -scale * rng_log_uniform(r, 0.1, 1);
    }
  while (!surrounds(s));
}

/* Kind 0: 4 … 12 planes. 1: a cylinder cut by them. 2: a cylinder of exponents 1.2 … 8 cut by them. */
static solid random_solid(rng *r, int kind) {
  solid s = {.line = vec(0, 0, 0)};
  const double scale = rng_log_uniform(r, 1e-3, 1e3);
  random_planes(r, &s, 4 + (size_t)(rng_next(r) % (MOST_PLANES - 3)), scale);
  const vec3 axis = rng_unit(r),
             e = vec_scale(1.0 / vec_norm(vec_cross(axis, vec(0.6, 0.8, 0.0))), vec_cross(axis, vec(0.6, 0.8, 0.0)));
  const vec3 f = vec_cross(axis, e);
  const double radius = 0.3 * scale;
  cprox_implicit_description d = {.planes = (const double(*)[4])s.planes, .n_planes = s.n};
  if (kind == 1) {
    const double q[10] = {e.x * e.x + f.x * f.x,
                          e.x * e.y + f.x * f.y,
                          e.x * e.z + f.x * f.z,
                          e.y * e.y + f.y * f.y,
                          e.y * e.z + f.y * f.z,
                          e.z * e.z + f.z * f.z,
                          0,
                          0,
                          0,
                          -radius * radius};
    for (int i = 0; i < 10; i++) s.quadrics[0][i] = q[i];
    d.quadrics = (const double(*)[10])s.quadrics;
    d.n_quadrics = 1;
  } else if (kind == 2) {
    const vec3 row[2] = {e, f};
    for (int i = 0; i < 2; i++) {
      const double term[5] = {row[i].x / radius, row[i].y / radius, row[i].z / radius, 0.0, rng_uniform(r, 1.2, 8)};
      for (int k = 0; k < 5; k++) s.terms[i][k] = term[k];
    }
    s.power = (cprox_hyperquadric){.terms = (const double(*)[5])s.terms, .n_terms = 2};
    d.hyperquadrics = &s.power;
    d.n_hyperquadrics = 1;
  }
  if (kind > 0) s.line = axis;
  assert_int_equal(cprox_body_create_implicit(&d, NULL, NULL, &s.body), CPROX_OK);
  return s;
}

static vec3 normal(const solid *s, size_t k) {
  const vec3 b = vec(s->planes[k][0], s->planes[k][1], s->planes[k][2]);
  return vec_scale(1.0 / vec_norm(b), b);
}

/* Normal to a face, to an edge, or to the curved part's lines; tilted. */
static vec3 random_direction(rng *r, const solid *s) {
  const size_t i = (size_t)(rng_next(r) % s->n), j = (size_t)(rng_next(r) % s->n);
  vec3 d = normal(s, i);
  const bool curved = vec_norm2(s->line) > 0.0;
  const uint64_t what = rng_next(r) % (curved ? 4 : 3);
  if (what == 1 || what == 2) d = vec_axpy(d, rng_uniform(r, 0, 2), normal(s, j));
  if (what == 3) d = vec_cross(s->line, rng_unit(r));
  d = vec_scale(1.0 / vec_norm(d), d);
  if (rng_next(r) % 4 != 0) d = vec_axpy(d, rng_log_uniform(r, 1e-17, 1e-3), rng_unit(r));
  return vec_scale(1.0 / vec_norm(d), d);
}

/* The reach of the planes' body along d about its centre, by its vertices in long double; what rounding may have done
 * to a vertex is 1e-17 of the size over the determinant, and a vertex is taken where it is outside by no more. */
static long double reach_of_vertices(const solid *s, vec3 centre, vec3 d) {
  long double most = -INFINITY;
  for (size_t i = 0; i < s->n; i++)
    for (size_t j = 0; j < i; j++)
      for (size_t k = 0; k < j; k++) {
        const double *p[3] = {s->planes[i], s->planes[j], s->planes[k]};
        long double cross[3][3], x[3] = {0}, volume = 0;
        for (int a = 0; a < 3; a++) {
          const double *u = p[(a + 1) % 3], *v = p[(a + 2) % 3];
          for (int c = 0; c < 3; c++)
            cross[a][c] = (long double)u[(c + 1) % 3] * v[(c + 2) % 3] - (long double)u[(c + 2) % 3] * v[(c + 1) % 3];
        }
        for (int c = 0; c < 3; c++) volume += p[0][c] * cross[0][c];
        if (fabsl(volume) < 1e-9L) continue;
        for (int c = 0; c < 3; c++)
          for (int a = 0; a < 3; a++) x[c] -= p[a][3] * cross[a][c] / volume;
        bool inside = true;
        for (size_t m = 0; m < s->n; m++)
          if (m != i && m != j && m != k)
            inside =
                inside && s->planes[m][0] * x[0] + s->planes[m][1] * x[1] + s->planes[m][2] * x[2] + s->planes[m][3] <=
                              1e-17L / fabsl(volume) * fabsl(s->planes[m][3]);
        const long double reach = d.x * (x[0] - centre.x) + d.y * (x[1] - centre.y) + d.z * (x[2] - centre.z);
        if (inside && reach > most) most = reach;
      }
  return most;
}

/* Seed 15 and the kind, 20,000 directions a kind. The reference's own error is far below the slack, which is 4e-11 of
 * the size. */
CASE(the_support_is_found_along_normals_of_faces_and_edges) {
  for (int kind = 0; kind < 3; kind++) {
    rng r = rng_seed(15 + (uint64_t)kind);
    size_t missing = 0, wide = 0, wrong = 0;
    const size_t n = test_cases(200);
    for (size_t i = 0; i < n; i++) {
      solid s = random_solid(&r, kind);
      const convex *shape = &s.body->shape;
      for (size_t k = 0; k < 100; k++) {
        const vec3 d = random_direction(&r, &s);
        vec3 at = vec(0, 0, 0);
        const double h = shape->ops->support(shape, d, NULL, &at);
        missing += isnan(h) != 0;
        wide += !isnan(h) && !(h - vec_dot(d, at) <= shape->slack);
        if (kind > 0 || isnan(h)) continue;
        const long double reach = reach_of_vertices(&s, s.body->centre, d);
        wrong += !(h >= reach - 1e-15L * shape->scale && h <= reach + shape->slack);
      }
      cprox_body_free(s.body);
    }
    print_message("kind %d: %zu directions, %zu without an answer, %zu too wide, %zu wrong\n", kind, 100 * n, missing,
                  wide, wrong);
    assert_int_equal(missing + wide + wrong, 0);
  }
}

/* An ellipsoid of any proportions up to 1 : 3000, turned, as one quadric about its own centre. Seed 19. The reference
 * is sqrt(sum (a_i e_i·d)^2) of the semi-axes a_i e_i. A quadric of coefficients in double is that ellipsoid only
 * within what the slack says. */
CASE(the_support_of_thin_ellipsoids_is_found) {
  rng r = rng_seed(19);
  size_t missing = 0, wide = 0, wrong = 0;
  const size_t n = test_cases(2000);
  for (size_t i = 0; i < n; i++) {
    const vec3 x = rng_unit(&r), any = rng_unit(&r);
    const vec3 y = vec_scale(1.0 / vec_norm(vec_cross(x, any)), vec_cross(x, any)), z = vec_cross(x, y);
    const vec3 axis[3] = {x, y, z};
    const double scale = rng_log_uniform(&r, 1e-3, 1e3);
    double half[3], q[1][10] = {{0}};
    for (int k = 0; k < 3; k++) {
      half[k] = scale * rng_log_uniform(&r, 1.0 / 3000.0, 1.0);
      const vec3 e = vec_scale(1.0 / half[k], axis[k]);
      const double square[6] = {e.x * e.x, e.x * e.y, e.x * e.z, e.y * e.y, e.y * e.z, e.z * e.z};
      for (int c = 0; c < 6; c++) q[0][c] += square[c];
    }
    q[0][9] = -1.0;
    const cprox_implicit_description d = {.quadrics = (const double(*)[10])q, .n_quadrics = 1};
    cprox_body *body;
    assert_int_equal(cprox_body_create_implicit(&d, NULL, NULL, &body), CPROX_OK);
    const convex *shape = &body->shape;
    for (size_t k = 0; k < 20; k++) {
      const vec3 to = k < 6 ? vec_scale(k % 2 ? -1.0 : 1.0, vec(k / 2 == 0, k / 2 == 1, k / 2 == 2)) : rng_unit(&r);
      vec3 at = vec(0, 0, 0);
      const double h = shape->ops->support(shape, to, NULL, &at);
      long double square = 0.0L;
      for (int c = 0; c < 3; c++) {
        const long double along = (long double)half[c] * vec_dot(axis[c], to);
        square += along * along;
      }
      const double centre = vec_dot(body->centre, to);
      missing += isnan(h) != 0;
      wide += !isnan(h) && !(h - vec_dot(to, at) <= shape->slack);
      wrong += !isnan(h) && !(fabsl(h + centre - sqrtl(square)) <= shape->slack);
    }
    cprox_body_free(body);
  }
  print_message("%zu directions, %zu without an answer, %zu too wide, %zu wrong\n", 20 * n, missing, wide, wrong);
  assert_int_equal(missing + wide + wrong, 0);
}

int main(void) {
  return cases_run(NULL, NULL);
}
