/* SPDX-License-Identifier: BSD-3-Clause */
/* A first interior point by the ellipsoid method with deep cuts: in three dimensions it is cheap, and nothing can make
 * it fail but an interior that is not there. The ellipsoid that is left holds the whole body. Then what queries need to
 * know about a body besides its coefficients. */
#include "base/rounding.h"
#include "implicit/implicit.h"

enum { CENTRE_MAX_CUTS = 4000 };

/* Nothing lies farther out. */
static const double CENTRE_REACH = 2e10;

/* What a cut and its few products round, with much to spare: ellipsoids grow and radii shrink by it. */
static const double CENTRE_ROUNDING = 1e-12;

/* The deepest cut: a deeper one would leave an ellipsoid without a volume. */
static const double DEEPEST_CUT = 1.0 - 1e-9;

/* Of an inner radius, which need not be the largest; and what sums of powers round. */
static const double RADIUS_KNOWN = 1e-3, SUM_ROUNDING = 1e-9;

/* The determinant of a matrix by the cube of its trace: below it the rows do not span the space, but for rounding. */
static const double GRAM_SPANS = 1e-14;

/* The constraint that a point breaks most, as a cut g·(x - point) <= -depth that every point of the body obeys; false
 * where it breaks none. Depths are compared in the ellipsoid's own measure. */
typedef struct cut {
  bool found;
  vec3 g;       /* B'g / |B'g|, B the ellipsoid's matrix */
  double depth; /* in units of |B'g| */
} cut;

typedef struct ellipsoid {
  vec3 centre;
  double b[9]; /* { centre + B w : |w| <= 1 }, row-major */
} ellipsoid;

static vec3 columns(const double *b, vec3 g) {
  return vec(b[0] * g.x + b[3] * g.y + b[6] * g.z, b[1] * g.x + b[4] * g.y + b[7] * g.z,
             b[2] * g.x + b[5] * g.y + b[8] * g.z);
}

static void consider(const ellipsoid *e, vec3 g, double value, cut *worst) {
  if (value < 0.0) return;
  const vec3 w = columns(e->b, g);
  const double norm = vec_norm(w);
  const double depth = norm > 0.0 ? value / norm : INFINITY;
  if (worst->found && depth <= worst->depth) return;
  *worst = (cut){.found = true, .g = vec_scale(norm > 0.0 ? 1.0 / norm : 0.0, w), .depth = depth};
}

/* While a term is beyond 1 it gives the cut itself: its power might overflow. */
static void consider_power(const implicit *body, const implicit_power *power, const ellipsoid *e, vec3 at, cut *worst) {
  double value = -1.0;
  vec3 gradient = vec(0, 0, 0);
  bool beyond = false;
  for (int32_t i = power->first; i < power->first + power->n; i++) {
    const implicit_term *term = &body->term[i];
    const double u = implicit_row(term, at), size = fabs(u), side = u < 0.0 ? -1.0 : 1.0;
    if (size > 1.0) {
      beyond = true;
      consider(e, vec_scale(side, term->a), size - 1.0, worst);
      continue;
    }
    const double raised = implicit_raise(term, size);
    value += raised;
    if (size > 0.0) gradient = vec_axpy(gradient, side * term->p * raised / size, term->a);
  }
  if (!beyond) consider(e, gradient, value, worst);
}

static cut worst_cut(const implicit *body, const ellipsoid *e, vec3 at) {
  cut worst = {0};
  for (int32_t k = 0; k < body->n_planes; k++)
    consider(e, body->plane[k].b, vec_dot(body->plane[k].b, at) + body->plane[k].c, &worst);
  for (int32_t k = 0; k < body->n_quadrics; k++) {
    vec3 gradient;
    const double value = implicit_quadric_at(&body->quadric[k], at, &gradient);
    consider(e, gradient, value, &worst);
  }
  for (int32_t k = 0; k < body->n_powers; k++) consider_power(body, &body->power[k], e, at, &worst);
  return worst;
}

/* The least ellipsoid about what the cut leaves (Grötschel, Lovász and Schrijver 1988, ch. 3), grown by what rounding
 * may take. */
static void shrink(ellipsoid *e, const cut *c) {
  const double n = 3.0, alpha = fmin(c->depth, DEEPEST_CUT);
  const double shift = (1.0 + n * alpha) / (n + 1.0), grow = sqrt(n * n * (1.0 - alpha * alpha) / (n * n - 1.0));
  const double squeeze = 2.0 * (1.0 + n * alpha) / ((n + 1.0) * (1.0 + alpha)), less = 1.0 - sqrt(1.0 - squeeze);
  double *b = e->b;
  for (int i = 0; i < 3; i++) {
    const double along = b[3 * i] * c->g.x + b[3 * i + 1] * c->g.y + b[3 * i + 2] * c->g.z;
    (&e->centre.x)[i] -= shift * along;
    const double by = (1.0 + CENTRE_ROUNDING) * grow;
    b[3 * i] = by * (b[3 * i] - less * along * c->g.x);
    b[3 * i + 1] = by * (b[3 * i + 1] - less * along * c->g.y);
    b[3 * i + 2] = by * (b[3 * i + 2] - less * along * c->g.z);
  }
}

/* The centre is inside: a cut through a point a tenth of the way to the ellipsoid's surface, where one of six is
 * outside. Such a cut leaves less than the whole, and in the end
 * six points a tenth of the way out are in the body. */
static cut cut_beside(const implicit *body, const ellipsoid *e) {
  for (int k = 0; k < 6; k++) {
    const double side = k % 2 == 0 ? 0.1 : -0.1;
    const vec3 w = vec(k / 2 == 0 ? side : 0.0, k / 2 == 1 ? side : 0.0, k / 2 == 2 ? side : 0.0);
    const double *b = &e->b[k / 2];
    cut c = worst_cut(body, e, vec_axpy(e->centre, side, vec(b[0], b[3], b[6])));
    c.depth -= vec_dot(c.g, w); /* seen from the centre */
    if (c.found) return c;
  }
  return (cut){0};
}

bool implicit_find_interior(const implicit *body, vec3 *point, double *reach) {
  ellipsoid e = {.b = {CENTRE_REACH, 0, 0, 0, CENTRE_REACH, 0, 0, 0, CENTRE_REACH}};
  vec3 first = e.centre, last = e.centre;
  bool found = false;
  for (int i = 0; i < CENTRE_MAX_CUTS; i++) {
    cut next = worst_cut(body, &e, e.centre);
    if (!next.found) {
      last = e.centre;
      if (!found) first = last;
      found = true;
      next = cut_beside(body, &e);
    }
    if (!next.found || !(next.depth < 1.0)) break;
    shrink(&e, &next);
  }
  if (!found) return false;
  double square = 0.0;
  for (int j = 0; j < 9; j++) square += e.b[j] * e.b[j];
  const double radius = sqrt(square);
  /* where the set is unbounded the last point may be anywhere along it */
  *point = radius < 0.5 * CENTRE_REACH ? last : first;
  *reach = (1.0 + 1e-9) * (vec_norm(vec_sub(*point, e.centre)) + radius);
  return true;
}

/* ---- measures ---- */

/* The radius of a ball about the centre inside the power body, by the triangle inequality: sum (|d| + |a| r)^p <= 1. */
static double power_inner(const implicit *body, const implicit_power *power, double most) {
  double inside = 0.0, outside = most;
  for (int step = 0; step < 60 && outside - inside > RADIUS_KNOWN * outside; step++) {
    const double r = 0.5 * (inside + outside);
    double sum = 0.0;
    for (int32_t i = power->first; i < power->first + power->n; i++) {
      const implicit_term *term = &body->term[i];
      sum += pow(fabs(term->d) + vec_norm(term->a) * r, term->p);
    }
    if (sum <= 1.0 - SUM_ROUNDING)
      inside = r;
    else
      outside = r;
  }
  return inside;
}

/* (A'A)^-1 of a power's rows, false where they do not span the space. Rows are scaled by the box, or long thin bodies
 * would seem flat. */
static bool power_gram(const implicit *body, implicit_power *power) {
  const double s[3] = {body->box.x, body->box.y, body->box.z};
  double g[6] = {0};
  for (int32_t i = power->first; i < power->first + power->n; i++) {
    const vec3 a = body->term[i].a;
    const double x = a.x * s[0], y = a.y * s[1], z = a.z * s[2];
    g[0] += x * x, g[1] += x * y, g[2] += x * z, g[3] += y * y, g[4] += y * z, g[5] += z * z;
  }
  const double c00 = g[3] * g[5] - g[4] * g[4], c01 = g[2] * g[4] - g[1] * g[5], c02 = g[1] * g[4] - g[2] * g[3];
  const double det = g[0] * c00 + g[1] * c01 + g[2] * c02, trace = g[0] + g[3] + g[5];
  if (!(det > GRAM_SPANS * trace * trace * trace)) return false;
  const double inverse[6] = {
      c00, c01, c02, g[0] * g[5] - g[2] * g[2], g[1] * g[2] - g[0] * g[4], g[0] * g[3] - g[1] * g[1]};
  static const int row[6] = {0, 0, 0, 1, 1, 2}, column[6] = {0, 1, 2, 1, 2, 2};
  for (int i = 0; i < 6; i++) power->gram[i] = inverse[i] / det * s[row[i]] * s[column[i]];
  return true;
}

/* |a|·box: how large the parts of a row's value get over the body. */
static double row_size(vec3 a, vec3 box) {
  return fabs(a.x) * box.x + fabs(a.y) * box.y + fabs(a.z) * box.z;
}

/* How far rounding of a constraint's value may carry a point: by convexity, drawing a point in by the fraction
 * error/-f(centre) of its distance from the centre lowers f by as much. The same covers the rounding of the stored
 * coefficients. */
static double body_shrinkage(const implicit *body) {
  double fraction = 0.0;
  for (int32_t k = 0; k < body->n_planes; k++) {
    const implicit_plane *plane = &body->plane[k];
    fraction = fmax(fraction, 5.0 * (row_size(plane->b, body->box) + fabs(plane->c)) / -plane->c);
  }
  for (int32_t k = 0; k < body->n_quadrics; k++) {
    const implicit_quadric *quadric = &body->quadric[k];
    const double *q = quadric->q;
    const vec3 x = body->box;
    const double square = fabs(q[0]) * x.x * x.x + fabs(q[3]) * x.y * x.y + fabs(q[5]) * x.z * x.z +
                          2.0 * (fabs(q[1]) * x.x * x.y + fabs(q[2]) * x.x * x.z + fabs(q[4]) * x.y * x.z);
    /* and an eigenvalue may be negative by 64 u */
    const double size = 12.0 * square + 5.0 * row_size(quadric->b, x) + 3.0 * fabs(quadric->c);
    fraction = fmax(fraction, (size + 64.0 * square) / -quadric->c);
  }
  for (int32_t k = 0; k < body->n_powers; k++) {
    const implicit_power *power = &body->power[k];
    double error = power->n + 2.0, value = -1.0;
    for (int32_t i = power->first; i < power->first + power->n; i++) {
      const implicit_term *term = &body->term[i];
      /* |u| <= 1 is off by 5 u of its parts' size and by its power's own rounding, the exponent times both */
      error += term->p * (5.0 * (row_size(term->a, body->box) + fabs(term->d)) + 2.0) + 2.0;
      value += implicit_raise(term, fabs(term->d));
    }
    fraction = fmax(fraction, error / -value);
  }
  return ROUND_UP * fraction * ROUND_U * body->radius;
}

bool implicit_measure(implicit *body) {
  if (!(implicit_value(body, vec(0, 0, 0)) < 0.0)) return false;
  double inner = body->radius;
  for (int32_t k = 0; k < body->n_planes; k++) inner = fmin(inner, -body->plane[k].c / vec_norm(body->plane[k].b));
  for (int32_t k = 0; k < body->n_quadrics; k++) {
    /* c + |b| r + |Q| r² <= 0, |Q| at most the sum of its diagonal */
    const implicit_quadric *quadric = &body->quadric[k];
    const double b = vec_norm(quadric->b), q = quadric->q[0] + quadric->q[3] + quadric->q[5];
    inner = fmin(inner, -2.0 * quadric->c / (b + sqrt(b * b - 4.0 * q * quadric->c)));
  }
  for (int32_t k = 0; k < body->n_powers; k++) {
    inner = fmin(inner, power_inner(body, &body->power[k], inner));
    body->power[k].spans = power_gram(body, &body->power[k]);
  }
  body->inner = inner * (1.0 - CENTRE_ROUNDING);
  body->closed = implicit_is_closed(body, body->inverse);
  body->orthogonal = body->closed && isfinite(implicit_closed_radius(body));
  body->give = body_shrinkage(body);
  return inner > 0.0;
}
