/* SPDX-License-Identifier: BSD-3-Clause */
/* Peers that a user would pick instead, each where it is installed: OpenCASCADE and SISL for points and curves against
 * Bézier curves and B-splines, FCL at 100 points for a sphere along a path past a convex body, and Bullet on 100 chords
 * for its time of contact. */
#ifndef CPROX_BENCH_ASK_H
#define CPROX_BENCH_ASK_H

#include "curve_proximity/cprox.h"
#include "peers/curve_peers.h"
#include "support/measure.h"

enum { MOST_METHODS = 4 };

typedef struct asked {
  cprox_workspace *workspace;
  double epsilon;
} asked;

/* Ends the program with the reason where a problem cannot be made. */
void ask_check(cprox_status status, const cprox_workspace *ws);
void *ask_memory(size_t n, size_t size);

/* Our answer. */
void ask_take(cprox_status status, const cprox_result *r, bench_answer *a);

void ask_points_and_curves(const bench_size *size, size_t degree, asked *q);
void ask_curves_and_curves(const bench_size *size, size_t degree, asked *q);
void ask_splines_and_splines(const bench_size *size, asked *q);
void ask_paths(const bench_size *size, bool touching, solid_kind kind, asked *q);

#endif
