/* SPDX-License-Identifier: BSD-3-Clause */
/* What proofs cost: a verdict alone, the verdict with its certificate (nodes: bytes), and the checker's time with that
 * (nodes: leaves), for Bézier curves beside polytopes, for curves beside meshes of more and more triangles, and for
 * robots along joint splines (test/data/motion). The claim is a part of the distance. */
#define _POSIX_C_SOURCE 200809L
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "curve_proximity/cprox.h"
#include "solve/list.h"
#include "support/measure.h"
#include "support/of_list.h"
#include "support/problems.h"
#include "support/robot_case.h"

enum { MAX_CASES = 32, DEGREE = 5 };

/* One query, and what the checker is given. */
typedef struct query {
  cprox_mover mover;
  const cprox_obstacle *targets;
  size_t n;
  double delta;
  problem read;
  char *text;
  cprox_certificate *proof;
} query;

static cprox_status ask(const query *q, cprox_certificate *proof, cprox_workspace *ws, bench_answer *a) {
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.certificate = proof;
  cprox_result r = {.status = CPROX_INVALID};
  const cprox_status status = list_tolerance(q->mover, q->targets, q->n, q->delta, &options, ws, &r, NULL);
  *a = (bench_answer){
      .lower = NAN, .upper = NAN, .nodes = r.nodes, .distance_queries = r.distance_queries, .failed = status < 0};
  a->wrong = r.verdict == CPROX_VERDICT_VIOLATED;
  return status;
}

static void verdict(const void *queries, size_t i, void *state, bench_answer *a) {
  ask((const query *)queries + i, NULL, state, a);
}

static void with_certificate(const void *queries, size_t i, void *state, bench_answer *a) {
  const query *q = (const query *)queries + i;
  ask(q, q->proof, state, a);
  a->nodes = (uint32_t)cprox_certificate_get_info(q->proof).size;
  a->failed = a->failed || a->nodes == 0;
}

static void by_checker(const void *queries, size_t i, void *state, bench_answer *a) {
  const query *q = (const query *)queries + i;
  (void)state;
  const finding f =
      check(&q->read, cprox_certificate_get_info(q->proof).bytes, cprox_certificate_get_info(q->proof).size);
  *a = (bench_answer){.lower = NAN, .upper = NAN, .nodes = (uint32_t)f.leaves, .failed = f.claim != CLAIM_APART};
}

/* Reads the query back as the checker does: targets, then the line of the mover, which is freed. */
static void give_to_checker(query *q, char *line) {
  size_t length = 0;
  FILE *out = open_memstream(&q->text, &length);
  if (!out || !line) exit(1);
  fprintf(out, "cprox-problem 1\ntargets %zu\n", q->n);
  for (size_t i = 0; i < q->n; i++) {
    const size_t size = cprox_obstacle_describe(&q->targets[i], NULL, 0) + 1;
    char *text = calloc(size, 1);
    if (!text) exit(1);
    cprox_obstacle_describe(&q->targets[i], text, size);
    fputs(text, out);
    free(text);
  }
  fputs(line, out);
  fclose(out);
  free(line);
  FILE *in = fmemopen(q->text, length, "r");
  if (!in || !problem_open(&q->read, in) || !problem_next(&q->read)) {
    fprintf(stderr, "certificates: %s\n", q->read.fault);
    exit(1);
  }
  fclose(in);
  q->proof = cprox_certificate_create();
}

static void measure_at(const bench_size *size, const char *workload, const char *part, query *queries, size_t n,
                       cprox_workspace *ws) {
  const bench_workload w = {"certificates", workload, part, queries, n, NULL, 0.0};
  const bench_method methods[] = {{"curve_proximity", verdict, ws},
                                  {"curve_proximity with certificate", with_certificate, ws},
                                  {"cprox_check", by_checker, ws}};
  bench_measure(&w, size, methods, 3);
}

static void measure(const bench_size *size, const char *workload, query *queries, size_t n, cprox_workspace *ws) {
  measure_at(size, workload, "delta 0.9 d", queries, n, ws);
  for (size_t i = 0; i < n; i++) {
    problem_close(&queries[i].read);
    cprox_certificate_free(queries[i].proof);
    free(queries[i].text);
  }
  free(queries);
}

/* The line of a Bézier curve. */
static char *line_of(const vec3 *points, size_t degree) {
  char *line = NULL;
  size_t length = 0;
  FILE *out = open_memstream(&line, &length);
  if (!out) exit(1);
  fprintf(out, "mover m 0 bezier %zu 0 1 %zu", degree, degree + 1);
  for (size_t k = 0; k <= degree; k++) fprintf(out, " %a %a %a", points[k].x, points[k].y, points[k].z);
  fputs(" 0\n", out);
  fclose(out);
  return line;
}

static void curves(const bench_size *size, cprox_workspace *ws) {
  const size_t n = size->problems;
  curve_problem *problems = curve_problems_make(OBSTACLE_POLYTOPE, DEGREE, n);
  double *truth = curve_problems_truth(problems, n, OBSTACLE_POLYTOPE);
  query *queries = calloc(n, sizeof *queries);
  if (!queries) exit(1);
  for (size_t i = 0; i < n; i++) {
    queries[i] = (query){.mover = cprox_point_along(problems[i].curve), .targets = &problems[i].target, .n = 1};
    queries[i].delta = 0.9 * truth[i];
    give_to_checker(&queries[i], line_of(problems[i].points, DEGREE));
  }
  measure(size, "Bezier and polytope", queries, n, ws);
  free(truth);
  curve_problems_free(problems, n);
}

/* A ball of radius .5 with bumps, a closed mesh: rings of so many corners between two poles. */
static cprox_body *bumpy_ball(size_t rings, size_t corners, cprox_workspace *ws) {
  const size_t n = rings * corners + 2, m = 2 * rings * corners;
  vec3 *vertices = calloc(n, sizeof *vertices);
  uint32_t(*triangles)[3] = calloc(m, sizeof *triangles);
  if (!vertices || !triangles) exit(1);
  const double pi = acos(-1.0);
  vertices[n - 2] = vec(0, 0, 0.5), vertices[n - 1] = vec(0, 0, -0.5);
  size_t t = 0;
  for (size_t i = 0; i < rings; i++)
    for (size_t k = 0; k < corners; k++) {
      const double a = pi * (double)(i + 1) / (double)(rings + 1), b = 2.0 * pi * (double)k / (double)corners;
      const double r = 0.5 * (1.0 + 0.1 * sin(5.0 * a) * cos(7.0 * b));
      vertices[i * corners + k] = vec(r * sin(a) * cos(b), r * sin(a) * sin(b), r * cos(a));
      const uint32_t here = (uint32_t)(i * corners + k), next = (uint32_t)(i * corners + (k + 1) % corners),
                     below = here + (uint32_t)corners, beside = next + (uint32_t)corners;
      if (i == 0) memcpy(triangles[t++], (const uint32_t[3]){(uint32_t)n - 2, here, next}, sizeof *triangles);
      if (i + 1 == rings) memcpy(triangles[t++], (const uint32_t[3]){(uint32_t)n - 1, next, here}, sizeof *triangles);
      if (i + 1 == rings) continue;
      memcpy(triangles[t++], (const uint32_t[3]){here, below, next}, sizeof *triangles);
      memcpy(triangles[t++], (const uint32_t[3]){next, below, beside}, sizeof *triangles);
    }
  cprox_body *body = NULL;
  if (cprox_body_create_mesh(vertices, n, (const uint32_t(*)[3])triangles, t, CPROX_MESH_FILL_SOLID, SIZE_MAX, ws,
                             &body) != CPROX_OK)
    exit(1);
  free(vertices);
  free(triangles);
  return body;
}

/* Curves about the ball that stay outside of it, at parts of their distance. */
static void meshes(const bench_size *size, cprox_workspace *ws) {
  enum { CURVES = 40, SIZES = 3, CLAIMS = 3 };
  static const size_t SHAPE[SIZES][2] = {{10, 16}, {32, 50}, {100, 100}};
  static const double CLAIM[CLAIMS] = {0.5, 0.9, 0.99};
  static const char *const NAME[CLAIMS] = {"delta 0.5 d", "delta 0.9 d", "delta 0.99 d"};
  for (size_t s = 0; s < SIZES; s++) {
    char name[60];
    snprintf(name, sizeof name, "mesh of %zu triangles", 2 * SHAPE[s][0] * SHAPE[s][1]);
    cprox_body *body = bumpy_ball(SHAPE[s][0], SHAPE[s][1], ws);
    const cprox_obstacle target = cprox_obstacle_at(body, CPROX_POSE_IDENTITY);
    query queries[CURVES];
    double distance[CURVES];
    cprox_curve *curves_made[CURVES];
    rng r = rng_seed(45);
    for (size_t i = 0; i < CURVES;) {
      vec3 points[DEGREE + 1];
      for (size_t k = 0; k <= DEGREE; k++) points[k] = vec_scale(rng_uniform(&r, 0.6, 1.6), rng_unit(&r));
      const cprox_curve_description d = {.kind = CPROX_CURVE_BEZIER, .t1 = 1.0, .points = points, .n = DEGREE + 1};
      if (cprox_curve_create(&d, ws, &curves_made[i]) != CPROX_OK) exit(1);
      queries[i] = (query){.mover = cprox_point_along(curves_made[i]), .targets = &target, .n = 1};
      cprox_options options = CPROX_OPTIONS_DEFAULT;
      options.epsilon = 1e-9;
      cprox_result found;
      const cprox_status status = list_distance(queries[i].mover, &target, 1, &options, ws, &found, NULL);
      if (status < 0 || found.lower < 0.02) {
        cprox_curve_free(curves_made[i]);
        continue;
      }
      distance[i] = found.lower;
      give_to_checker(&queries[i++], line_of(points, DEGREE));
    }
    for (size_t c = 0; c < CLAIMS; c++) {
      for (size_t i = 0; i < CURVES; i++) queries[i].delta = CLAIM[c] * distance[i];
      measure_at(size, name, NAME[c], queries, CURVES, ws);
    }
    for (size_t i = 0; i < CURVES; i++) {
      problem_close(&queries[i].read);
      cprox_certificate_free(queries[i].proof);
      free(queries[i].text);
      cprox_curve_free(curves_made[i]);
    }
    cprox_body_free(body);
  }
}

static void robots(const bench_size *size, cprox_workspace *ws) {
  static robot_case cases[MAX_CASES];
  size_t n_cases = 0, n = 0;
  FILE *f = fopen(BENCH_DATA_DIR "/motion/cases.txt", "r");
  if (!f || fscanf(f, "%zu", &n_cases) != 1 || n_cases > MAX_CASES) exit(1);
  query *queries = calloc(n_cases, sizeof *queries);
  if (!queries) exit(1);
  for (size_t i = 0; i < n_cases; i++) {
    robot_case *c = &cases[i];
    if (!robot_case_read(f, BENCH_DATA_DIR "/motion", c)) exit(1);
    for (size_t k = 0; k < c->n_answers; k++) {
      if (c->answers[k].self || c->answers[k].lower <= 1e-3) continue;
      query *q = &queries[n++];
      *q = (query){.mover = cprox_robot_along(c->motion, NULL, 0), .targets = c->targets, .n = c->n_targets};
      q->delta = 0.9 * c->answers[k].lower;
      const size_t most = describe_mover_of_list(&q->mover, q->targets, q->n, "m", ws, NULL, 0) + 1;
      char *text = calloc(most, 1);
      if (!text) exit(1);
      describe_mover_of_list(&q->mover, q->targets, q->n, "m", ws, text, most);
      give_to_checker(q, text);
      break;
    }
  }
  fclose(f);
  measure(size, "robot trajectory", queries, n, ws);
  for (size_t i = 0; i < n_cases; i++) robot_case_free(&cases[i]);
}

int main(int argc, char **argv) {
  const bench_size size = bench_arguments(argc, argv);
  cprox_workspace *ws = cprox_workspace_create();
  if (!ws) return 1;
  if (bench_wanted(&size, "Bezier and polytope")) curves(&size, ws);
  if (bench_wanted(&size, "mesh")) meshes(&size, ws);
  if (bench_wanted(&size, "robot trajectory")) robots(&size, ws);
  cprox_workspace_free(ws);
  return 0;
}
