/* SPDX-License-Identifier: BSD-3-Clause */
/* Bounds on the support function from above, by weak duality (doc/implicit.md). */
#include "base/rounding.h"
#include "implicit/barrier.h"

/* A multiplier that is smaller than this fraction of the largest one is taken for 0. */
static const double HEIGHT_SLIGHT = 1e-7;

/* What a bound is made of. */
typedef struct height {
  double sum;   /* of the constraints' shares */
  double sizes; /* of their absolute values: for the rounding */
  double pulls; /* sum of multiplier times gradient length: for the rounding of what is left */
  vec3 left;    /* of the direction */
  int32_t n;    /* constraints and terms summed up */
} height;

static void height_take(height *h, double multiplier, vec3 gradient) {
  h->left = vec_axpy(h->left, -multiplier, gradient);
  h->pulls += fabs(multiplier) * (fabs(gradient.x) + fabs(gradient.y) + fabs(gradient.z));
  h->n++;
}

static void height_plane(height *h, const implicit_plane *plane, double multiplier) {
  height_take(h, multiplier, plane->b);
  h->sum -= multiplier * plane->c;
  h->sizes += multiplier * fabs(plane->c);
}

/* A convex f lies above its tangent at x: f <= 0 implies g·z <= g·x - f(x) = x'Qx - c. */
static void height_quadric(height *h, const implicit_quadric *quadric, double multiplier, vec3 x) {
  vec3 gradient;
  const double value = implicit_quadric_at(quadric, x, &gradient);
  const vec3 half = vec_scale(0.5, vec_sub(gradient, quadric->b)); /* Qx */
  const double square = vec_dot(half, x), rough = vec_norm(half) * vec_norm(x) + fabs(quadric->c) + fabs(value);
  height_take(h, multiplier, gradient);
  h->sum += multiplier * (square - quadric->c);
  h->sizes += 4.0 * multiplier * rough;
}

/* The multipliers of the terms |u_i|^p_i: of the lifted pair, or of the tangent. */
static void power_multipliers(const barrier *b, const implicit_power *power, double l, double share,
                              barrier_reading reading, double *w) {
  for (int32_t i = 0; i < power->n; i++) {
    const barrier_term *work = &b->term[power->first + i];
    const implicit_term *term = &b->body->term[power->first + i];
    const double u = fabs(work->u);
    if (work->lifted && (reading == BARRIER_LIFTED || (reading == BARRIER_MIXED && term->p < 2.0)))
      w[i] = (work->l[0] - work->l[1]) * share;
    else
      w[i] = u > 0.0 ? l * term->p * implicit_raise(term, u) / work->u : 0.0;
  }
}

/* Changes the multipliers so that nothing of the direction is left: w += A (A'A)^-1 left. */
static void power_take_rest(const implicit *body, const implicit_power *power, vec3 left, double *w) {
  const double *g = power->gram;
  const vec3 x = vec(g[0] * left.x + g[1] * left.y + g[2] * left.z, g[1] * left.x + g[3] * left.y + g[4] * left.z,
                     g[2] * left.x + g[4] * left.y + g[5] * left.z);
  for (int32_t i = 0; i < power->n; i++) w[i] += vec_dot(body->term[power->first + i].a, x);
}

static vec3 power_left(const implicit *body, const implicit_power *power, const double *w, vec3 left) {
  for (int32_t i = 0; i < power->n; i++) left = vec_axpy(left, -w[i], body->term[power->first + i].a);
  return left;
}

/* dual: of the power's terms, or NULL. Returns the multiplier of the power itself. */
static double height_power(height *h, const barrier *b, const implicit_power *power, double l, double share,
                           barrier_reading reading, bool takes_rest, double *dual) {
  enum { REFINEMENTS = 2, NEWTON = 4 };
  const implicit *body = b->body;
  const implicit_term *term = body->term + power->first;
  double w[IMPLICIT_MOST_TERMS], u[IMPLICIT_MOST_TERMS], mu = l * share;
  power_multipliers(b, power, mu, share, reading, w);
  for (int i = 0; i < REFINEMENTS && takes_rest; i++)
    power_take_rest(body, power, power_left(body, power, w, h->left), w);

  double offset = 0.0, weights = 0.0;
  for (int32_t i = 0; i < power->n; i++) {
    height_take(h, w[i], term[i].a);
    offset += w[i] * term[i].d;
    h->sizes += fabs(w[i] * term[i].d);
    if (dual) dual[i] = w[i];
    w[i] = fabs(w[i]);
    weights += w[i];
  }
  const double reach = implicit_power_reach(term, power->n, w, &mu, NEWTON, u);
  h->sum += reach - offset;
  /* each term of the reach is computed within 6 u w_i: a power whose exponent is off by u, of a number that is off by 2
   * u */
  h->sizes += reach + 8.0 * weights;
  return mu;
}

/* The sum, what is left of the direction, and rounding. */
static double height_end(const height *h, const implicit *body, vec3 n) {
  const double rounding = ROUND_U * (h->n + 8) * (h->sizes + body->radius * (vec_norm(n) + h->pulls));
  return h->sum + (1.0 + 4.0 * ROUND_U) * vec_norm(h->left) * body->radius + ROUND_UP * rounding + body->give;
}

double implicit_quadric_height(const implicit *body, vec3 n, vec3 x, double multiplier) {
  height h = {.left = n};
  height_quadric(&h, &body->quadric[0], multiplier, x);
  return height_end(&h, body, n);
}

/* The multipliers of planes and quadrics as the barrier has them; no power pulls yet. */
static void dual_begin(const barrier *b, double share, implicit_dual *dual) {
  const int32_t rows = implicit_count(b->body), linear = rows - b->body->n_powers;
  dual->x = b->z;
  for (int32_t k = 0; k < rows + b->body->n_terms; k++) dual->row[k] = k < linear ? b->row[k].l * share : 0.0;
}

double barrier_height(const barrier *b, vec3 n, double share, barrier_reading reading, implicit_dual *dual) {
  const implicit *body = b->body;
  const int32_t first_power = body->n_planes + body->n_quadrics;
  height h = {.left = n};
  if (dual) dual_begin(b, share, dual);
  for (int32_t k = 0; k < body->n_planes; k++) height_plane(&h, &body->plane[k], b->row[k].l * share);
  for (int32_t k = 0; k < body->n_quadrics; k++)
    height_quadric(&h, &body->quadric[k], b->row[body->n_planes + k].l * share, b->z);

  /* of those that span the space, the one with the largest multiplier takes what the others leave; any split will do,
   * so that powers which hardly pull are left out */
  int32_t last = -1;
  for (int32_t k = 0; k < body->n_powers; k++)
    if (body->power[k].spans && (last < 0 || b->row[first_power + k].l > b->row[first_power + last].l)) last = k;
  const double least = last >= 0 ? HEIGHT_SLIGHT * b->row[first_power + last].l : 0.0;
  for (int32_t i = 0; i <= body->n_powers; i++) {
    const int32_t k = i < body->n_powers ? i : last; /* the last one last */
    if (k < 0 || (i == last) || (i != body->n_powers && b->row[first_power + k].l < least)) continue;
    double *terms = dual ? dual->row + implicit_count(body) + body->power[k].first : NULL;
    const double mu = height_power(&h, b, &body->power[k], b->row[first_power + k].l, share, reading, k == last, terms);
    if (dual) dual->row[first_power + k] = mu;
  }
  return height_end(&h, body, n);
}
