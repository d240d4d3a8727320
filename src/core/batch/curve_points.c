/* SPDX-License-Identifier: BSD-3-Clause */
/* Points of the mover's curve at equal steps, and the chords between them. */
#include "batch/prefilter.h"

#include <math.h>

#include "base/rounding.h"

/* What rounding may do to points at equal steps of the parameter, to chords between them and to lengths along these. */
bool batch_points_ready(batch_run *run) {
  const cprox_curve *curve = run->q.mover.curve;
  if (run->degree != curve->degree) {
    run->basis = packet_basis(curve->degree, run->q.workspace);
    run->degree = run->basis ? curve->degree : SIZE_MAX;
  }
  if (!run->basis) return false;
  const double n = (double)curve->degree;
  run->slack = ROUND_UP *
               (curve_error(curve) + (10.0 * n + 40.0 + n * n * (1.0 / (CHORDS * CHORDS))) * ROUND_U * curve->largest);
  run->measured = true;
  return true;
}

/* The least square distance of the points of half a piece from a point, and which one has it. */
double batch_points_nearest(batch_run *run, uint32_t half, vec3 from, uint32_t *nearest) {
  const cprox_curve *curve = run->q.mover.curve;
  const uint32_t piece = half / 2, first = half % 2 * LANES;
  packet_chords *chords = &run->chords[piece];
  double square;
  if (run->cut >> half & 1)
    square = packet_nearest_point(chords, first, from, nearest);
  else
    square =
        packet_points(run->basis, curve_piece(curve, piece), curve->degree, curve->flat, first, from, chords, nearest);
  run->cut |= 1u << half;
  *nearest += first;
  return square;
}

/* Chords of parameter length h are within h²/8 max|psi''| of the curve, |psi''| <= n (n-1) max|second difference|. */
void batch_points_join(batch_run *run) {
  const cprox_curve *curve = run->q.mover.curve;
  double bend2 = 0.0;
  for (uint32_t i = 0; i < curve->n_pieces; i++) {
    uint32_t unused;
    for (uint32_t half = 2 * i; half < 2 * i + 2; half++)
      if (!(run->cut >> half & 1)) batch_points_nearest(run, half, vec(0, 0, 0), &unused);
    packet_join(&run->chords[i]);
    bend2 = greater(bend2, packet_bend2(curve_piece(curve, i), curve->degree));
  }
  const double n = (double)curve->degree;
  run->beside = ROUND_UP * n * (n - 1.0) * sqrt(bend2) / (8.0 * CHORDS * CHORDS);
  run->joined = true;
}
