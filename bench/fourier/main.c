/* SPDX-License-Identifier: BSD-3-Clause */
/* Fourier gap functions: how far bodies apart are still called colliding, over n, ours beside the paper's kernel (its
 * Figs. 3 and 5); outlines of the SE(2) obstacle (Fig. 6); what their gradients are worth; what a query costs beside a
 * distance between convex bodies and beside tables of the spectrum; a nesting problem; planning problems from many starts. */
#include "fourier/parts.h"

#include <stdio.h>

void fourier_row(const char *workload, const char *method, const char *parameter, double microseconds, double count,
                 double error, unsigned long unsound, unsigned long failures) {
  printf("fourier,%s,%s,%s,%.4g,%.4g,%.0f,%.0f,%.6g,%lu,%lu\n", workload, method, parameter, microseconds, microseconds,
         count, count, error, unsound, failures);
  fflush(stdout);
}

int main(int argc, char **argv) {
  const bench_size size = bench_arguments(argc, argv);
  if (bench_wanted(&size, "dots")) fourier_dots(&size);
  if (bench_wanted(&size, "over-reach")) fourier_over_reach(&size);
  if (bench_wanted(&size, "obstacle")) fourier_obstacle(&size);
  if (bench_wanted(&size, "profile")) fourier_profile(&size);
  if (bench_wanted(&size, "gradient")) fourier_gradients(&size);
  if (bench_wanted(&size, "space")) fourier_space(&size);
  if (bench_wanted(&size, "boxes")) fourier_pairs(&size);
  if (bench_wanted(&size, "box value and gradient")) fourier_tables(&size);
  if (bench_wanted(&size, "nesting")) fourier_nesting(&size);
  if (bench_wanted(&size, "planning")) fourier_planning(&size);
  if (bench_wanted(&size, "smooth")) fourier_smooth(&size);
  return 0;
}
