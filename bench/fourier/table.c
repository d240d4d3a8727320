/* SPDX-License-Identifier: BSD-3-Clause */
#include "fourier/table.h"

#include <stdlib.h>
#include <string.h>

/* A row of four neighbours. */
typedef double row4 __attribute__((vector_size(32)));
#define INLINE static inline __attribute__((always_inline))

typedef struct term {
  int k[3];
  double re, im;
} term;

struct table {
  int N, half, width; /* points -half … half + 1 along an axis */
  size_t n_terms;
  term *terms; /* along x, then y, then z, so that neighbours are looked up after each other */
  double *value[2];
  double period, finer, inverse, constant;
  vec3 box; /* half edges */
};

/* C exp(i q·x) of a term. */
INLINE void turn_term(const phases *p, const term *t, double *re, double *im) {
  double a = t->re, b = t->im;
  for (int j = 0; j < 3; j++) {
    const int k = t->k[j] < 0 ? -t->k[j] : t->k[j];
    const double c = p->re[j][k], s = t->k[j] < 0 ? -p->im[j][k] : p->im[j][k], was = a;
    a = was * c - b * s, b = was * s + b * c;
  }
  *re = a, *im = b;
}

/* ---- the table ---- */

static int along_rows(const void *a, const void *b) {
  const term *p = a, *q = b;
  for (int j = 2; j >= 0; j--)
    if (p->k[j] != q->k[j]) return p->k[j] < q->k[j] ? -1 : 1;
  return 0;
}

static bool list_terms(const cprox_gap *gap, table *t) {
  t->terms = malloc(gap->n_blocks * LANES * sizeof *t->terms);
  for (size_t i = 0; t->terms && i < gap->n_blocks; i++)
    for (int l = 0; l < LANES; l++) {
      const double *c = gap->c + 2 * LANES * i + l;
      const block *b = &gap->blocks[i];
      if (c[0] != 0.0 || c[LANES] != 0.0)
        t->terms[t->n_terms++] = (term){{b->k[0] + l, b->k[1], b->k[2]}, c[0], c[LANES]};
    }
  if (t->terms) qsort(t->terms, t->n_terms, sizeof *t->terms, along_rows);
  return t->terms != NULL;
}

static void fill_values(const cprox_gap *gap, table *t) {
  const double step = TAU / (t->period * t->finer);
  size_t at = 0;
  for (int z = -t->half; z <= t->half + 1; z++)
    for (int y = -t->half; y <= t->half + 1; y++)
      for (int x = -t->half; x <= t->half + 1; x++, at++) {
        wave_jet jet = {0};
        solid_spectrum(gap->turned, vec(step * x, step * y, step * z), false, &jet);
        t->value[0][at] = jet.value.re;
        if (t->value[1]) t->value[1][at] = jet.value.im;
      }
}

table *table_create(const cprox_gap *gap, int finer, bool complex) {
  table *t = calloc(1, sizeof *t);
  if (!t) return NULL;
  t->N = gap->N, t->period = gap->info.period, t->finer = finer;
  t->inverse = gap->inverse, t->constant = gap->constant;
  const double *h = gap->turned->pieces[0].size;
  t->box = vec(h[0], h[1], h[2]);
  t->half =
      (int)ceil(sqrt(3.0) * gap->N * finer) + 1; /* the lattice's corners, turned, and the neighbours of their cells */
  t->width = 2 * t->half + 2;
  const size_t n = (size_t)t->width * (size_t)t->width * (size_t)t->width;
  t->value[0] = malloc(n * sizeof(double));
  t->value[1] = complex ? malloc(n * sizeof(double)) : NULL;
  if (!t->value[0] || (complex && !t->value[1]) || !list_terms(gap, t)) {
    table_free(t);
    return NULL;
  }
  fill_values(gap, t);
  return t;
}

void table_free(table *t) {
  if (!t) return;
  free(t->terms);
  free(t->value[0]);
  free(t->value[1]);
  free(t);
}

size_t table_bytes(const table *t) {
  const size_t n = (size_t)t->width * (size_t)t->width * (size_t)t->width;
  return sizeof *t + t->n_terms * sizeof *t->terms + n * (t->value[1] ? 2 : 1) * sizeof(double);
}

size_t table_terms(const table *t) {
  return t->n_terms;
}

/* Catmull-Rom's weights of four neighbours, and their derivatives. */
INLINE void weigh(double s, double w[4], double d[4]) {
  const double s2 = s * s, s3 = s2 * s;
  w[0] = 0.5 * (-s3 + 2.0 * s2 - s), w[1] = 0.5 * (3.0 * s3 - 5.0 * s2 + 2.0);
  w[2] = 0.5 * (-3.0 * s3 + 4.0 * s2 + s), w[3] = 0.5 * (s3 - s2);
  d[0] = 0.5 * (-3.0 * s2 + 4.0 * s - 1.0), d[1] = 0.5 * (9.0 * s2 - 10.0 * s);
  d[2] = 0.5 * (-9.0 * s2 + 8.0 * s + 1.0), d[3] = 0.5 * (3.0 * s2 - 2.0 * s);
}

/* Value and derivatives by the table's coordinates from 64 neighbours. */
typedef struct cell {
  size_t first;
  double w[3][4], d[3][4];
} cell;

INLINE cell find_cell(const table *t, vec3 p) {
  const double at[3] = {p.x, p.y, p.z};
  size_t low[3];
  cell c;
  for (int j = 0; j < 3; j++) {
    const double below = floor(at[j]);
    low[j] = (size_t)((int)below - 1 + t->half);
    weigh(at[j] - below, c.w[j], c.d[j]);
  }
  c.first = (low[2] * (size_t)t->width + low[1]) * (size_t)t->width + low[0];
  return c;
}

INLINE double dot4(row4 a, const double b[4]) {
  return (a[0] * b[0] + a[1] * b[1]) + (a[2] * b[2] + a[3] * b[3]);
}

INLINE void interpolate(const double *from, int width, const cell *c, double out[4]) {
  row4 value = {0}, by_y = {0}, by_z = {0};
  for (int k = 0; k < 4; k++) {
    row4 plane = {0}, slope = {0};
    for (int j = 0; j < 4; j++) {
      row4 row;
      memcpy(&row, from + c->first + (size_t)(k * width + j) * (size_t)width, sizeof row);
      plane += c->w[1][j] * row, slope += c->d[1][j] * row;
    }
    value += c->w[2][k] * plane, by_y += c->w[2][k] * slope, by_z += c->d[2][k] * plane;
  }
  out[0] = dot4(value, c->w[0]), out[1] = dot4(value, c->d[0]), out[2] = dot4(by_y, c->w[0]),
  out[3] = dot4(by_z, c->w[0]);
}

/* The sum by terms whose spectra and gradients come from `kind`. */
enum { REAL, COMPLEX, FORMULA };

static double sinc(double y) {
  return fabs(y) < 1e-4 ? 1.0 - y * y / 6.0 : sin(y) / y;
}

static double sinc_slope(double y) {
  return fabs(y) < 1e-2 ? -y / 3.0 * (1.0 - y * y / 10.0 * (1.0 - y * y / 28.0)) : (cos(y) - sin(y) / y) / y;
}

static void by_formula(const table *t, vec3 p, double jet[4]) {
  const double h[3] = {t->box.x, t->box.y, t->box.z}, y[3] = {h[0] * p.x, h[1] * p.y, h[2] * p.z};
  const double volume = 8.0 * h[0] * h[1] * h[2], s[3] = {sinc(y[0]), sinc(y[1]), sinc(y[2])};
  jet[0] = volume * s[0] * s[1] * s[2];
  for (int j = 0; j < 3; j++) jet[1 + j] = volume * h[j] * sinc_slope(y[j]) * s[(j + 1) % 3] * s[(j + 2) % 3];
}

INLINE table_answer sum_terms(const table *t, const double turn[9], vec3 x, int kind) {
  const double step = TAU / t->period;
  phases p;
  fill_phases(&p, t->N, step, x);
  double v = 0.0;
  vec3 position = vec(0, 0, 0), rotation = position;
  for (size_t i = 0; i < t->n_terms; i++) {
    const term *k = &t->terms[i];
    const vec3 at = rotate_back(turn, vec(k->k[0], k->k[1], k->k[2])); /* in steps of the lattice */
    double a, b, jet[2][4] = {{0}};
    turn_term(&p, k, &a, &b);
    if (kind == FORMULA) {
      by_formula(t, vec_scale(step, at), jet[0]);
      for (int j = 1; j < 4; j++) jet[0][j] *= step;
    } else {
      const cell c = find_cell(t, vec_scale(t->finer, at));
      for (int part = 0; part < (kind == COMPLEX ? 2 : 1); part++) {
        interpolate(t->value[part], t->width, &c, jet[part]);
        for (int j = 1; j < 4; j++) jet[part][j] *= t->finer;
      }
    }
    /* Re and Im of C exp(iq·x) conj(T); the gradient's G × p does not see the step's unit */
    v += a * jet[0][0] + b * jet[1][0];
    const double im = b * jet[0][0] - a * jet[1][0];
    position = vec_sub(position, vec(im * k->k[0], im * k->k[1], im * k->k[2]));
    const vec3 g = vec(a * jet[0][1] + b * jet[1][1], a * jet[0][2] + b * jet[1][2], a * jet[0][3] + b * jet[1][3]);
    rotation = vec_add(rotation, vec_cross(g, at));
  }
  const double scale = 2.0 * t->inverse;
  return (table_answer){t->constant * t->inverse + scale * v, vec_scale(scale * step, position),
                        vec_scale(scale, rotation)};
}

INLINE table_answer sum_kinds(const table *t, const double turn[9], vec3 x) {
  return t->value[1] ? sum_terms(t, turn, x, COMPLEX) : sum_terms(t, turn, x, REAL);
}

WIDTH_512 static table_answer sum_512(const table *t, const double turn[9], vec3 x) {
  return sum_kinds(t, turn, x);
}

WIDTH_256 static table_answer sum_256(const table *t, const double turn[9], vec3 x) {
  return sum_kinds(t, turn, x);
}

static table_answer sum_128(const table *t, const double turn[9], vec3 x) {
  return sum_kinds(t, turn, x);
}

table_answer table_look_up(const table *t, const double turn[9], vec3 x) {
  switch (simd_of_machine()) {
    case SIMD_AVX512: return sum_512(t, turn, x);
    case SIMD_AVX2: return sum_256(t, turn, x);
    default: return sum_128(t, turn, x);
  }
}

table_answer table_exact(const table *t, const double turn[9], vec3 x) {
  return sum_terms(t, turn, x, FORMULA);
}
