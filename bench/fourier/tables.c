/* SPDX-License-Identifier: BSD-3-Clause */
/* Value and gradient of a box's gap: by the closed form that turns with the body, by tables of its spectrum with
 * tricubic interpolation, and the sum of a body that does not turn, which no way can undercut. */
#define _POSIX_C_SOURCE 200809L
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "fourier/parts.h"
#include "fourier/table.h"
#include "support/random.h"

typedef struct box_problem {
  cprox_pose a, b;
  double turn[9]; /* the same, of the turned box in the other's frame */
  vec3 x;
} box_problem;

typedef struct asked {
  const cprox_gap *gap;
  table *look;
  table_floor *bare;
  cprox_workspace *ws;
} asked;

static void by_gap(const void *problems, size_t i, void *state, bench_answer *answer) {
  const box_problem *p = (const box_problem *)problems + i;
  const asked *q = state;
  cprox_gap_result r = {0};
  const cprox_status status = cprox_gap_evaluate(q->gap, &p->a, &p->b, q->ws, &r);
  *answer = (bench_answer){.lower = r.value, .upper = r.value, .nodes = r.terms, .failed = status != CPROX_OK};
}

static void by_table(const void *problems, size_t i, void *state, bench_answer *answer) {
  const box_problem *p = (const box_problem *)problems + i;
  const asked *q = state;
  const table_answer r = table_look_up(q->look, p->turn, p->x);
  *answer = (bench_answer){.lower = r.value, .upper = r.value, .nodes = (uint32_t)table_terms(q->look)};
}

/* Its value is another body's, one that does not turn: it has no error to speak of. */
static void by_floor(const void *problems, size_t i, void *state, bench_answer *answer) {
  const box_problem *p = (const box_problem *)problems + i;
  const asked *q = state;
  const table_answer r = table_floor_sum(q->bare, p->x);
  *answer = (bench_answer){.lower = NAN, .upper = NAN, .nodes = (uint32_t)q->gap->info.terms, .failed = isnan(r.value)};
}

/* Random rotations, centres inside each other's bounding spheres. The fixed box stands at the origin, unturned. */
static box_problem *make_problems(const cprox_gap *gap, size_t n) {
  box_problem *problems = calloc(n, sizeof *problems);
  rng r = rng_seed(79);
  for (size_t i = 0; problems && i < n; i++) {
    box_problem *p = &problems[i];
    const cprox_pose at = {.orientation = rng_quat(&r),
                           .position = vec_scale(rng_uniform(&r, 0.2, 1.25), rng_unit(&r))};
    const frame f = frame_create(&at, vec(0, 0, 0));
    for (int k = 0; k < 9; k++) p->turn[k] = f.r[k];
    p->x = at.position;
    p->a = gap->info.turned_first ? at : CPROX_POSE_IDENTITY;
    p->b = gap->info.turned_first ? CPROX_POSE_IDENTITY : at;
  }
  return problems;
}

/* Our gradients as the tables give theirs: by position in the fixed frame, by rotation in the turned one's. */
static table_answer gradients_of(const box_problem *p, const asked *q, bool ours) {
  if (!ours) return table_look_up(q->look, p->turn, p->x);
  cprox_gap_result r = {.value = NAN};
  cprox_gap_evaluate(q->gap, &p->a, &p->b, q->ws, &r);
  const bool first = q->gap->info.turned_first;
  return (table_answer){r.value, first ? r.position_a : r.position_b, first ? r.rotation_a : r.rotation_b};
}

/* Rows of the largest error of a gradient over the largest gradient. */
static void gradient_rows(const box_problem *problems, size_t n, const asked *q, bool ours, const char *name,
                          const char *parameter) {
  double worst[2] = {0}, most[2] = {0};
  for (size_t i = 0; i < n; i++) {
    const table_answer truth = table_exact(q->look, problems[i].turn, problems[i].x);
    const table_answer found = gradients_of(&problems[i], q, ours);
    worst[0] = fmax(worst[0], vec_norm(vec_sub(found.position, truth.position)));
    worst[1] = fmax(worst[1], vec_norm(vec_sub(found.rotation, truth.rotation)));
    most[0] = fmax(most[0], vec_norm(truth.position)), most[1] = fmax(most[1], vec_norm(truth.rotation));
  }
  fourier_row("box gradient by position", name, parameter, NAN, 0, worst[0] / most[0], 0, 0);
  fourier_row("box gradient by rotation", name, parameter, NAN, 0, worst[1] / most[1], 0, 0);
}

static double now(void) {
  struct timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* The tables: of any body, on the lattice itself; of one whose spectrum is real, on the lattice and finer. */
enum { TABLES = 4 };
static const struct {
  const char *name;
  int finer;
  bool complex;
} KINDS[TABLES] = {{"tricubic table", 1, true},
                   {"tricubic table real", 1, false},
                   {"tricubic table real half spacing", 2, false},
                   {"tricubic table real quarter spacing", 4, false}};

static void measure(cprox_solid *const s[2], uint32_t samples, const bench_size *size, cprox_workspace *ws) {
  char parameter[32];
  snprintf(parameter, sizeof parameter, "n %u", samples);
  cprox_gap_options o = CPROX_GAP_OPTIONS_DEFAULT;
  o.samples = samples;
  cprox_gap *gap = NULL;
  double start = now();
  if (cprox_gap_create(s[0], s[1], &o, ws, &gap)) abort();
  fourier_row("box made ready", "curve_proximity", parameter, 1e6 * (now() - start), (double)gap->info.bytes, NAN, 0,
              0);
  box_problem *problems = make_problems(gap, size->problems);
  double *truth = calloc(size->problems, sizeof *truth);
  asked ours = {.gap = gap, .ws = ws, .bare = table_floor_create(gap)}, theirs[TABLES];
  bench_method methods[TABLES + 2] = {{"curve_proximity", by_gap, &ours}, {"no rotation", by_floor, &ours}};
  if (!problems || !truth || !ours.bare) abort();

  for (int k = 0; k < TABLES; k++) {
    start = now();
    table *made = table_create(gap, KINDS[k].finer, KINDS[k].complex);
    if (!made) abort();
    fourier_row("box made ready", KINDS[k].name, parameter, 1e6 * (now() - start), (double)table_bytes(made), NAN, 0,
                0);
    theirs[k] = ours, theirs[k].look = made;
    methods[2 + k] = (bench_method){KINDS[k].name, by_table, &theirs[k]};
  }
  for (size_t i = 0; i < size->problems; i++)
    truth[i] = table_exact(theirs[0].look, problems[i].turn, problems[i].x).value;
  const bench_workload w = {"fourier", "box value and gradient", parameter, problems, size->problems, truth, 0.0};
  bench_measure(&w, size, methods, TABLES + 2);
  gradient_rows(problems, size->problems, &theirs[0], true, "curve_proximity", parameter);
  for (int k = 0; k < TABLES; k++) {
    gradient_rows(problems, size->problems, &theirs[k], false, KINDS[k].name, parameter);
    table_free(theirs[k].look);
  }
  table_floor_free(ours.bare);
  free(truth);
  free(problems);
  cprox_gap_free(gap);
}

/* A sum takes as long at one pose as at any other: few are enough. */
void fourier_tables(const bench_size *asked_for) {
  enum { MOST_PROBLEMS = 60, MOST_ROUNDS = 3 };
  const bench_size some = {.problems = asked_for->problems < MOST_PROBLEMS ? asked_for->problems : MOST_PROBLEMS,
                           .rounds = asked_for->rounds < MOST_ROUNDS ? asked_for->rounds : MOST_ROUNDS};
  static const cprox_vec3 EDGES[2] = {{1.0, 0.7, 0.5}, {0.8, 0.8, 0.4}};
  cprox_workspace *ws = cprox_workspace_create();
  cprox_solid *s[2];
  for (int k = 0; k < 2; k++)
    if (cprox_solid_create(&(cprox_solid_description){.kind = CPROX_SOLID_BOX, .dimension = 3, .size = EDGES[k]}, ws,
                           &s[k]))
      abort();
  measure(s, 17, &some, ws);
  measure(s, 33, &some, ws);
  for (int k = 0; k < 2; k++) cprox_solid_free(s[k]);
  cprox_workspace_free(ws);
}
