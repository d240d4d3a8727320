/* SPDX-License-Identifier: BSD-3-Clause */
#include <stdio.h>
#include <stdlib.h>

#include "peers/ask.h"
#include "peers/libraries.h"

void ask_check(cprox_status status, const cprox_workspace *ws) {
  if (status == CPROX_OK) return;
  fprintf(stderr, "a problem could not be made: %s\n", cprox_workspace_error(ws));
  exit(1);
}

void *ask_memory(size_t n, size_t size) {
  void *p = calloc(n + 1, size);
  if (!p) exit(1);
  return p;
}

void ask_take(cprox_status status, const cprox_result *r, bench_answer *a) {
  *a = (bench_answer){.lower = r->lower, .upper = r->upper, .nodes = r->nodes, .distance_queries = r->distance_queries};
  a->failed = status != CPROX_OK && status != CPROX_PRECISION;
}

int main(int argc, char **argv) {
  const bench_size size = bench_arguments(argc, argv);
  asked q = {.workspace = cprox_workspace_create()};
  if (!q.workspace) return 1;
  if (!curve_libraries[0]) fputs("peers: neither OpenCASCADE nor SISL is installed, both are left out\n", stderr);
  static const size_t degrees[] = {3, 5, 10, 20};
  for (size_t k = 0; k < 4 && bench_wanted(&size, "point and curve"); k++) ask_points_and_curves(&size, degrees[k], &q);
  for (size_t k = 1; k < 3 && bench_wanted(&size, "curve and curve"); k++) ask_curves_and_curves(&size, degrees[k], &q);
  if (bench_wanted(&size, "curve and curve")) ask_splines_and_splines(&size, &q);
  for (int kind = 0; kind < SOLID_KINDS; kind++) {
    if (bench_wanted(&size, "path distance")) ask_paths(&size, false, (solid_kind)kind, &q);
    if (bench_wanted(&size, "time of contact")) ask_paths(&size, true, (solid_kind)kind, &q);
  }
  cprox_workspace_free(q.workspace);
  return 0;
}
