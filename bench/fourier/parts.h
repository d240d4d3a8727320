/* SPDX-License-Identifier: BSD-3-Clause */
/* The parts of the Fourier group. */
#ifndef CPROX_BENCH_FOURIER_PARTS_H
#define CPROX_BENCH_FOURIER_PARTS_H

#include "support/measure.h"

/* One row of results.csv; count: terms summed, or starts that succeeded. */
void fourier_row(const char *workload, const char *method, const char *parameter, double microseconds, double count,
                 double error, unsigned long unsound, unsigned long failures);

void fourier_dots(const bench_size *size);
void fourier_over_reach(const bench_size *size);
void fourier_obstacle(const bench_size *size);
void fourier_profile(const bench_size *size);
void fourier_gradients(const bench_size *size);
void fourier_space(const bench_size *size);
void fourier_pairs(const bench_size *size);
void fourier_tables(const bench_size *size);
void fourier_nesting(const bench_size *size);
void fourier_planning(const bench_size *size);
void fourier_smooth(const bench_size *size);

#endif
