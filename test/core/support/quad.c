/* SPDX-License-Identifier: BSD-3-Clause */
#include "support/quad.h"

size_t quad_piece_at(const cprox_curve *c, double t) {
  size_t piece = 0;
  while (piece + 1 < c->n_pieces && c->breaks[piece + 1] <= t) piece++;
  return piece;
}

quad3 quad_piece(const cprox_curve *c, size_t piece, double t) {
  const quad a = c->breaks[piece], b = c->breaks[piece + 1];
  const quad s = ((quad)t - a) / (b - a), r = (b - (quad)t) / (b - a);
  const vec3 *p = curve_piece(c, piece);

  /* Horner in s, with the powers of 1 - s and the binomials carried along */
  quad3 sum = {{(quad)p[0].x, (quad)p[0].y, (quad)p[0].z}};
  quad weight = 1;
  for (size_t j = 1; j <= c->degree; j++) {
    weight = weight * s * (quad)(c->degree - j + 1) / (quad)j;
    for (int k = 0; k < 3; k++) sum.k[k] *= r;
    sum = quad_axpy(sum, weight, p[j]);
  }
  return sum;
}

double quad_parameter(const cprox_curve *c, rng *r) {
  const double t0 = c->breaks[0], t1 = c->breaks[c->n_pieces];
  switch (rng_index(r, 6)) {
    case 0: return t0;
    case 1: return t1;
    case 2: return c->breaks[rng_index(r, c->n_pieces)];
    default: return fmin(fmax(rng_uniform(r, t0, t1), t0), t1);
  }
}
