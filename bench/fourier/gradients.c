/* SPDX-License-Identifier: BSD-3-Clause */
/* What the gradients of gap functions are worth to a solver: their cosine to the exact gradient of the distance, over
 * the clearance. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "fourier/parts.h"
#include "fourier/shapes.h"
#include "support/random.h"

enum { BINS = 6, MOST = 4000, MODES = 3 };
static const double EDGES[BINS + 1] = {0.0, 0.05, 0.1, 0.2, 0.4, 0.8, 1.6};
static const char *const NAMES[MODES] = {"curve_proximity", "curve_proximity tuned", "curve_proximity signal"};
static const cprox_gap_mode KINDS[MODES] = {CPROX_GAP_MODE_CERTIFIED, CPROX_GAP_MODE_TUNED, CPROX_GAP_MODE_SIGNAL};

static int ascending(const void *a, const void *b) {
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

/* Of the distance, with respect to b's position, by central differences; false where it has a kink. */
static bool exact_gradient(const shape *a, const shape *b, const cprox_pose *pb, double g[2]) {
  const cprox_pose here = shape_pose(0, 0, 0);
  const double h = 1e-6;
  for (int k = 0; k < 2; k++) {
    cprox_pose up = *pb, down = *pb;
    *(k == 0 ? &up.position.x : &up.position.y) += h;
    *(k == 0 ? &down.position.x : &down.position.y) -= h;
    g[k] = (shape_distance(a, &here, b, &up) - shape_distance(a, &here, b, &down)) / (2.0 * h);
  }
  return fabs(hypot(g[0], g[1]) - 1.0) < 1e-3; /* a distance grows as fast as it can */
}

/* Random poses inside the bounding spheres: the cosine of each goes to its bin. */
static void measure(const shape *a, const shape *b, int mode, uint32_t samples, size_t poses, cprox_workspace *ws) {
  cprox_gap_options o = CPROX_GAP_OPTIONS_DEFAULT;
  o.mode = KINDS[mode], o.samples = samples;
  cprox_gap *gap = NULL;
  if (cprox_gap_create(a->solid, b->solid, &o, ws, &gap)) abort();
  static double cosine[BINS][MOST];
  size_t n[BINS] = {0};
  rng r = rng_seed(83);
  const cprox_pose here = shape_pose(0, 0, 0);
  const double sign =
      KINDS[mode] == CPROX_GAP_MODE_SIGNAL ? 1.0 : -1.0; /* the signal is a logarithm that grows with the distance */
  for (size_t i = 0; i < poses; i++) {
    const double phi = rng_uniform(&r, 0.0, 6.283185307179586), far = rng_uniform(&r, 0.0, 2.0);
    const cprox_pose at = shape_pose(far * cos(phi), far * sin(phi), rng_uniform(&r, 0.0, 6.283185307179586));
    const double d = shape_distance(a, &here, b, &at);
    double g[2];
    cprox_gap_result found;
    if (d <= 1e-3 || !exact_gradient(a, b, &at, g) || cprox_gap_evaluate(gap, &here, &at, ws, &found) < CPROX_OK ||
        found.verdict == CPROX_GAP_VERDICT_FAR)
      continue;
    const double size = hypot(found.position_b.x, found.position_b.y);
    for (int k = 0; k < BINS; k++)
      if (d >= EDGES[k] && d < EDGES[k + 1] && n[k] < MOST)
        cosine[k][n[k]++] = size > 0.0 ? sign * (g[0] * found.position_b.x + g[1] * found.position_b.y) / size : 0.0;
  }
  for (int k = 0; k < BINS; k++) {
    if (n[k] < 20) continue;
    char parameter[64];
    snprintf(parameter, sizeof parameter, "clearance %g to %g n %u", EDGES[k], EDGES[k + 1], samples);
    qsort(cosine[k], n[k], sizeof **cosine, ascending);
    fourier_row("gradient 1 - median cosine", NAMES[mode], parameter, NAN, (double)n[k], 1.0 - cosine[k][n[k] / 2], 0,
                0);
  }
  cprox_gap_free(gap);
}

void fourier_gradients(const bench_size *size) {
  shape s[SHAPES];
  shapes_create(s);
  cprox_workspace *ws = cprox_workspace_create();
  const size_t poses = size->problems >= 200 ? MOST : 800;
  for (int mode = 0; mode < MODES; mode++) measure(&s[0], &s[1], mode, 33, poses, ws);
  cprox_workspace_free(ws);
  shapes_free(s);
}
