/* SPDX-License-Identifier: BSD-3-Clause */
#include "pairs_ccd.h"

#include <math.h>
#include <stdio.h>

#include "curve_proximity/cprox/ccd.h"
#ifdef CPROX_BENCH_TIGHT_INCLUSION
#include "peers/ccd_tight_inclusion.h"
#endif
#include "support/problems.h"

enum { STEPS = 200 };

typedef struct step {
  cprox_vec3 start[4], end[4];
  bool hits; /* made so that both come to one point at t = .5 */
} step;

typedef cprox_status (*asked_step)(const cprox_vec3 start[4], const cprox_vec3 end[4], double margin,
                                   const cprox_options *options, cprox_workspace *workspace, cprox_ccd *ccd);

typedef struct asked {
  bool edges;
  asked_step ask;
  cprox_workspace *workspace;
} asked;

static void ours(const void *problems, size_t i, void *state, bench_answer *a) {
  const step *s = (const step *)problems + i;
  const asked *q = state;
  cprox_ccd c = {.status = CPROX_INVALID};
  q->ask(s->start, s->end, 0.0, NULL, q->workspace, &c);
  *a = (bench_answer){.lower = NAN, .upper = NAN, .nodes = c.nodes, .failed = c.status < 0};
  a->wrong = s->hits && (c.verdict == CPROX_VERDICT_CLEAR || c.t_contact_lower > 0.5 + 1e-12);
}

#ifdef CPROX_BENCH_TIGHT_INCLUSION
static void tight_inclusion(const void *problems, size_t i, void *state, bench_answer *a) {
  const step *s = (const step *)problems + i;
  const asked *q = state;
  double t = INFINITY;
  const bool met = (q->edges ? tight_inclusion_edge_edge : tight_inclusion_vertex_face)(s->start, s->end, &t);
  *a = (bench_answer){.lower = NAN, .upper = NAN};
  a->wrong = s->hits && (!met || t > 0.5 + 1e-12);
}
#endif

/* Points in a unit cube that move by up to .1 each; what moves, a vertex or an edge, goes 1 m besides. A hit is shifted
 * so that its middle and that of the other are in one place half way. */
static step step_make(rng *r, bool edges, bool hits) {
  step s = {.hits = hits};
  const size_t first = edges ? 2 : 1;
  const cprox_vec3 way = rng_unit(r);
  cprox_vec3 apart = vec(0, 0, 0);
  for (size_t k = 0; k < 4; k++) {
    s.start[k] = rng_in_cube(r, 0.5);
    s.end[k] = vec_add(s.start[k], rng_in_cube(r, 0.1));
    if (k < first) s.end[k] = vec_add(s.end[k], way);
    const double share = k < first ? 0.5 / (double)first : -0.5 / (double)(4 - first);
    apart = vec_axpy(apart, share, vec_add(s.start[k], s.end[k]));
  }
  for (size_t k = 0; k < first && hits; k++)
    s.start[k] = vec_sub(s.start[k], apart), s.end[k] = vec_sub(s.end[k], apart);
  return s;
}

void pairs_ccd(const bench_size *size, cprox_workspace *workspace) {
  static step steps[STEPS];
  for (int edges = 0; edges < 2; edges++) {
    for (int hits = 0; hits < 2; hits++) {
      rng r = rng_seed(640);
      asked q = {edges, edges ? cprox_ccd_edge_edge : cprox_ccd_vertex_face, workspace};
      for (size_t n = 0; n < STEPS; n++) {
        cprox_ccd c = {.verdict = CPROX_VERDICT_CLEAR};
        do {
          steps[n] = step_make(&r, edges, hits);
          if (!hits) q.ask(steps[n].start, steps[n].end, 0.0, NULL, workspace, &c);
        } while (c.verdict != CPROX_VERDICT_CLEAR);
      }
      char workload[64];
      snprintf(workload, sizeof workload, "CCD %s", hits ? "hit" : "miss");
      const bench_workload w = {"pairs", workload, edges ? "two edges" : "vertex and face", steps, STEPS, NULL, 0.0};
      const bench_method methods[] = {{"curve_proximity", ours, &q},
#ifdef CPROX_BENCH_TIGHT_INCLUSION
                                      {"Tight-Inclusion", tight_inclusion, &q}
#endif
      };
      bench_measure(&w, size, methods, sizeof methods / sizeof *methods);
    }
  }
}
