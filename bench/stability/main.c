/* SPDX-License-Identifier: BSD-3-Clause */
/* Hard inputs and what each method says of them: right, wrong, given up; and collisions that sampling does not see. */
#include <stdlib.h>

#include "stability/hard.h"

/* Seeds of the families, and of what was there before families were added. */
enum { SEED = 20260611, PLATES = SEED + 14, GAPS = SEED + 114, ROUGH = SEED + 200 };

int main(int argc, char **argv) {
  bench_size size = bench_arguments(argc, argv);
  size.rounds = 1; /* counts, not times */
  tools t = {.workspace = cprox_workspace_create(), .heap = calloc(PAPER_MAX_NODES, sizeof(paper_node))};
  if (!t.workspace || !t.heap) return 1;
  for (size_t i = 0; i < N_FAMILIES; i++)
    if (bench_wanted(&size, FAMILIES[i].name)) stability_family(&size, &FAMILIES[i], SEED + i, &t);
  stability_rough(&size, ROUGH, &t);
  stability_plates(&size, PLATES, &t);
  stability_gaps(&size, GAPS, &t);
  free(t.heap);
  cprox_workspace_free(t.workspace);
  return 0;
}
