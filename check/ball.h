/* SPDX-License-Identifier: BSD-3-Clause */
/* Numbers, vectors and rotations in double arithmetic, each with a radius: what is meant is within e of what is
 * computed (vectors: in Euclid's norm; rotations: in the norm of matrices that it makes). Every operation adds what its
 * own rounding may cost; GROW covers the rounding of the radii themselves. Compiled without value-changing
 * optimisations; products and sums may be fused.
 *
 * Robots are checked with these and not with MPFR's intervals: a chain of rotations in intervals grows by sqrt(3) a
 * joint, and a trajectory takes thousands of support values. */
#ifndef CHECK_BALL_H
#define CHECK_BALL_H

#include <math.h>
#include <stdbool.h>

#define BALL_U 0x1p-53

/* Radii are sums of at most 20 terms that are not negative: their own rounding is below 2^-46 of them. */
#define GROW(e) ((e) * (1.0 + 0x1p-46) + 0x1p-900)

typedef struct num {
  double m, e;
} num;

typedef struct vec {
  double m[3], e;
} vec;

typedef struct rot {
  double m[9], e; /* row by row */
} rot;

/* x -> r x + p */
typedef struct place {
  rot r;
  vec p;
} place;

/* ---- numbers ---- */

static inline num num_of(double m) {
  return (num){m, 0.0};
}

static inline double num_top(num a) {
  return a.m + GROW(a.e) + 0x1p-52 * fabs(a.m);
}

static inline double num_bottom(num a) {
  return a.m - GROW(a.e) - 0x1p-52 * fabs(a.m);
}

static inline double num_size(num a) {
  return GROW(fabs(a.m) + a.e);
}

static inline num num_add(num a, num b) {
  const double m = a.m + b.m;
  return (num){m, GROW(a.e + b.e + BALL_U * fabs(m))};
}

static inline num num_neg(num a) {
  return (num){-a.m, a.e};
}

static inline num num_sub(num a, num b) {
  return num_add(a, num_neg(b));
}

static inline num num_mul(num a, num b) {
  const double m = a.m * b.m;
  return (num){m, GROW(fabs(a.m) * b.e + fabs(b.m) * a.e + a.e * b.e + BALL_U * fabs(m))};
}

/* Of what may be 0: infinite. */
static inline num num_div(num a, num b) {
  const double m = a.m / b.m, least = fabs(b.m) - b.e;
  if (!(least > 0.5 * fabs(b.m))) return (num){0.0, INFINITY};
  return (num){m, GROW((a.e + fabs(m) * b.e) / least + 4.0 * BALL_U * fabs(m))};
}

/* Of what may be 0: infinite. */
static inline num num_sqrt(num a) {
  if (!(a.m > 2.0 * a.e)) return (num){0.0, INFINITY};
  const double m = sqrt(a.m);
  return (num){m, GROW(a.e / m + 4.0 * BALL_U * m)};
}

/* ---- vectors ---- */

static inline vec vec_of(const double x[3]) {
  return (vec){{x[0], x[1], x[2]}, 0.0};
}

/* From above but for roundings: squares that underflow lose less than what is added. */
static inline double length_of(const double x[3]) {
  return sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]) + 0x1p-500;
}

/* At least the length. */
static inline double vec_top(const vec *a) {
  return GROW(length_of(a->m) + a->e);
}

/* a + s b for a double s */
static inline vec vec_axpy(const vec *a, double s, const vec *b) {
  vec c;
  double sizes = 0.0;
  for (int k = 0; k < 3; k++) {
    c.m[k] = a->m[k] + s * b->m[k];
    sizes += fabs(a->m[k]) + 2.0 * fabs(s * b->m[k]);
  }
  c.e = GROW(a->e + fabs(s) * b->e + 2.0 * BALL_U * sizes);
  return c;
}

static inline vec vec_add(const vec *a, const vec *b) {
  return vec_axpy(a, 1.0, b);
}

static inline vec vec_sub(const vec *a, const vec *b) {
  return vec_axpy(a, -1.0, b);
}

static inline vec vec_scale(num s, const vec *a) {
  vec c;
  for (int k = 0; k < 3; k++) c.m[k] = s.m * a->m[k];
  const double size = length_of(a->m);
  c.e = GROW(fabs(s.m) * a->e + s.e * (size + a->e) + 2.0 * BALL_U * fabs(s.m) * size);
  return c;
}

static inline num vec_dot(const vec *a, const vec *b) {
  double m = 0.0, sizes = 0.0;
  for (int k = 0; k < 3; k++) {
    m += a->m[k] * b->m[k];
    sizes += fabs(a->m[k] * b->m[k]);
  }
  const double x = length_of(a->m), y = length_of(b->m);
  return (num){m, GROW(a->e * y + x * b->e + a->e * b->e + 4.0 * BALL_U * sizes)};
}

static inline vec vec_cross(const vec *a, const vec *b) {
  const double *x = a->m, *y = b->m, sizes = length_of(x) * length_of(y);
  return (vec){{x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2], x[0] * y[1] - x[1] * y[0]},
               GROW(a->e * length_of(y) + length_of(x) * b->e + a->e * b->e + 8.0 * BALL_U * sizes)};
}

/* ---- rotations ---- */

/* With nine numbers. */
static inline rot rot_of(const num k[9]) {
  rot r;
  double square = 0.0;
  for (int i = 0; i < 9; i++) {
    r.m[i] = k[i].m;
    square += k[i].e * k[i].e;
  }
  r.e = GROW(sqrt(square) + 0x1p-500);
  return r;
}

static inline vec rot_turn(const rot *r, const vec *a, bool back) {
  vec c;
  for (int i = 0; i < 3; i++)
    c.m[i] = back ? r->m[i] * a->m[0] + r->m[3 + i] * a->m[1] + r->m[6 + i] * a->m[2]
                  : r->m[3 * i] * a->m[0] + r->m[3 * i + 1] * a->m[1] + r->m[3 * i + 2] * a->m[2];
  const double size = length_of(a->m);
  c.e = GROW(a->e + r->e * size + 8.0 * BALL_U * (1.0 + r->e) * size);
  return c;
}

static inline rot rot_product(const rot *a, const rot *b) {
  rot c;
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      c.m[3 * i + j] = a->m[3 * i] * b->m[j] + a->m[3 * i + 1] * b->m[3 + j] + a->m[3 * i + 2] * b->m[6 + j];
  c.e = GROW(a->e + b->e + a->e * b->e + 12.0 * BALL_U * (1.0 + a->e) * (1.0 + b->e));
  return c;
}

static inline vec place_apply(const place *at, const vec *x) {
  const vec turned = rot_turn(&at->r, x, false);
  return vec_add(&turned, &at->p);
}

static inline place place_product(const place *outer, const place *inner) {
  return (place){rot_product(&outer->r, &inner->r), place_apply(outer, &inner->p)};
}

/* Of a quaternion w, x, y, z of any norm that is not 0. */
rot rot_of_quaternion(const num q[4]);

void num_turn(num angle, num *sine, num *cosine);

/* About an axis whose length is 1 but for its numbers' radii. */
rot rot_about(const num *axis, num angle);

#endif
