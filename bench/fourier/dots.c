/* SPDX-License-Identifier: BSD-3-Clause */
/* Two dots at one place: the pair for which the threshold is exact, so that V/t is 1. A sum that is too small proves an
 * overlap clear here before anywhere else, and one that is too large shows as an error. */
#include "fourier/parts.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "curve_proximity/cprox_fourier.h"

void fourier_dots(const bench_size *size) {
  (void)size;
  static const uint32_t samples[] = {9, 17, 33, 65};
  cprox_workspace *ws = cprox_workspace_create();
  for (int dimension = 2; dimension <= 3; dimension++)
    for (int tuned = 0; tuned < 2; tuned++)
      for (int i = 0; i < (dimension == 2 ? 4 : 3); i++) {
        /* against the offset of some hundredths a radius of 1e-6 is none */
        const cprox_solid_description dot = {.kind = CPROX_SOLID_BALL, .dimension = dimension, .radius = 1e-6};
        cprox_solid *solid;
        cprox_gap *gap;
        cprox_gap_options options = CPROX_GAP_OPTIONS_DEFAULT;
        options.mode = tuned ? CPROX_GAP_MODE_TUNED : CPROX_GAP_MODE_CERTIFIED;
        options.samples = samples[i], options.period = 1.0;
        if (cprox_solid_create(&dot, ws, &solid) || cprox_gap_create(solid, solid, &options, ws, &gap)) abort();
        /* exact at one place, and by symmetry below that anywhere else; farther the balls tell, and not the sum */
        cprox_pose a = CPROX_POSE_IDENTITY, b = CPROX_POSE_IDENTITY;
        a.position = b.position = (cprox_vec3){0.3, -0.2, dimension == 2 ? 0.0 : 0.1};
        cprox_gap_result here, beside;
        if (cprox_gap_evaluate(gap, &a, &b, ws, &here)) abort();
        b.position.x += 1.5e-6;
        if (cprox_gap_evaluate(gap, &a, &b, ws, &beside) < CPROX_OK) abort();
        char parameter[40];
        snprintf(parameter, sizeof parameter, "%s n %u", dimension == 2 ? "plane" : "space", samples[i]);
        fourier_row("dots at one place", tuned ? "curve_proximity tuned sum" : "curve_proximity sum", parameter, 0,
                    (double)here.terms, fabs(here.value - 1.0), here.value + here.error < 1.0,
                    beside.verdict == CPROX_GAP_VERDICT_FAR || !(beside.value < here.value));
        cprox_gap_free(gap);
        cprox_solid_free(solid);
      }
  cprox_workspace_free(ws);
}
