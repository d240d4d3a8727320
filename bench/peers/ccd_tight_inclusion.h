/* SPDX-License-Identifier: BSD-3-Clause */
/* Tight-Inclusion, which scripts/bench_peers builds. */
#ifndef CPROX_BENCH_CCD_TIGHT_INCLUSION_H
#define CPROX_BENCH_CCD_TIGHT_INCLUSION_H

#include <stdbool.h>

#include "curve_proximity/cprox.h"

#ifdef __cplusplus
extern "C" {
#endif

/* By what its authors suggest: tolerance 1e-6, at most 1e6 steps, no minimum separation. *t: the time of impact. */
bool tight_inclusion_vertex_face(const cprox_vec3 start[4], const cprox_vec3 end[4], double *t);
bool tight_inclusion_edge_edge(const cprox_vec3 start[4], const cprox_vec3 end[4], double *t);

#ifdef __cplusplus
}
#endif
#endif
