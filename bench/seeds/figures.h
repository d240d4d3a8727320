/* SPDX-License-Identifier: BSD-3-Clause */
/* Figures of Lakshmanan et al. (2019) that are mostly counted: Fig. 10 b and the ellipsoids of Fig. 11 b. */
#ifndef CPROX_BENCH_SEEDS_FIGURES_H
#define CPROX_BENCH_SEEDS_FIGURES_H

#include "named.h"
#include "support/measure.h"

/* How far ellipsoids (Theorem 1) and hulls of control points reach beyond the chords of a curve in 2, 4, … 256 parts,
 * on the average; and intervals and time of a search by either. */
void figure_eleven(const bench_size *size, const char *name, const named_curve *curve, const cprox_obstacle *polygon,
                   const paper_obstacle *vertices, paper_node *heap);

/* Bytes of a curve of an order and of the search for its distance from a point. */
void figure_ten_memory(size_t order);

#endif
