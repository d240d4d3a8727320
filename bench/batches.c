/* SPDX-License-Identifier: BSD-3-Clause */
/* A thousand quintic Bézier curves against two polygons (Fig. 12 of Lakshmanan et al. 2019) and against 2, 50 and 100
 * boxes: the batch call, one query after another, the paper's method, and FCL at 100 points of each curve. A problem is
 * a whole scene: times are those of all its curves. error: the largest |distance - midpoint of the certified interval|;
 * unsound: curves with a wrong verdict. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "curve_proximity/cprox.h"
#include "paper/paper.h"
#include "peers/sampling.h"
#include "solve/list.h"
#include "support/make_curve.h"
#include "support/measure.h"
#include "support/random.h"

enum { CURVES = 1000, POINTS = 6, MAX_OBSTACLES = 100, SCENES = 3, SIDES = 20 };

typedef enum query_type { DISTANCE, TOLERANCE, COLLISION } query_type;
static const double DELTA = 0.03, EPSILON = 1e-10, TUBE = 0.005;

typedef struct scene {
  bool planar;
  double radius;
  vec3 points[CURVES][POINTS];
  cprox_curve *curves[CURVES];
  cprox_mover movers[CURVES];
  paper_bezier bezier[CURVES];
  size_t n;
  vec3 vertex[2][SIDES], half[MAX_OBSTACLES];
  cprox_body *bodies[MAX_OBSTACLES];
  cprox_obstacle targets[MAX_OBSTACLES];
  cprox_obstacles *batch;
  sampling *sampling;
  cprox_result truth[3][CURVES]; /* certified, by query */
} scene;

/* A method's own state; what it answers never changes, so that each scene is judged once and not on the clock of the
 * others. */
typedef struct judged {
  struct asked *asked;
  bool known[SCENES][3];
  bench_answer answer[SCENES][3];
} judged;

typedef struct asked {
  query_type query_type;
  cprox_workspace *workspace;
  cprox_result *results;
  double *values;
  paper_node *heap;
} asked;

static void check(cprox_status status) {
  if (status == CPROX_OK) return;
  fprintf(stderr, "a scene could not be made: %s\n", cprox_status_text(status));
  exit(1);
}

/* ---- scenes ---- */

/* From one side to the other, by two random control points. */
static void make_curves(rng *r, scene *s) {
  for (size_t i = 0; i < CURVES; i++) {
    vec3 *p = s->points[i];
    const double z = s->planar ? 0.0 : 0.5;
    p[0] = vec(-0.2, 0.5, z), p[1] = vec(0, 0.5, z), p[4] = vec(1, 0.5, z), p[5] = vec(1.2, 0.5, z);
    for (int k = 2; k < 4; k++)
      p[k] = vec(rng_uniform(r, 0, 1), rng_uniform(r, 0, 1), s->planar ? 0 : rng_uniform(r, 0, 1));
    check(curve_from(describe_bezier(p, POINTS, 0, 1), NULL, &s->curves[i]));
    s->movers[i] = cprox_tube_along(s->curves[i], s->radius);
    paper_bezier_make(p, POINTS - 1, &s->bezier[i]);
  }
}

static void make_polygons(scene *s) {
  const double centre[2][2] = {{0.35, 0.6}, {0.65, 0.4}}, radius = 0.12;
  for (size_t k = 0; k < s->n; k++) {
    double v[SIDES][2];
    for (int i = 0; i < SIDES; i++) {
      const double angle = 6.283185307179586 * (i + 0.3 * (double)k) / SIDES;
      v[i][0] = centre[k][0] + radius * cos(angle), v[i][1] = centre[k][1] + radius * sin(angle);
      s->vertex[k][i] = vec(v[i][0], v[i][1], 0);
    }
    check(cprox_body_create_polygon((const double(*)[2])v, SIDES, NULL, &s->bodies[k]));
    s->targets[k] = cprox_obstacle_at(s->bodies[k], CPROX_POSE_IDENTITY);
  }
}

/* Boxes anywhere in the cube, smaller the more there are. */
static void make_boxes(rng *r, scene *s) {
  s->sampling = sampling_create();
  const double size = 0.5 / sqrt((double)s->n);
  for (size_t k = 0; k < s->n; k++) {
    const vec3 edges = vec(rng_uniform(r, 0.3, 1) * size, rng_uniform(r, 0.3, 1) * size, rng_uniform(r, 0.3, 1) * size);
    check(cprox_body_create_box(edges, NULL, &s->bodies[k]));
    cprox_pose pose = rng_pose(r, 0.5);
    pose.position = vec_add(pose.position, vec(0.5, 0.5, 0.5));
    s->targets[k] = cprox_obstacle_at(s->bodies[k], pose);
    sampling_add_box(s->sampling, edges, pose);
  }
  sampling_ready(s->sampling);
}

static scene *scene_make(uint64_t seed, bool planar, size_t n, asked *q) {
  scene *s = calloc(1, sizeof *s);
  if (!s) exit(1);
  rng r = rng_seed(seed);
  s->planar = planar, s->n = n, s->radius = planar ? 0.0 : TUBE;
  make_curves(&r, s);
  if (planar)
    make_polygons(s);
  else
    make_boxes(&r, s);
  check(cprox_obstacles_create(s->targets, n, CPROX_INDEX_BATCH, q->workspace, &s->batch));
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.epsilon = EPSILON;
  for (size_t i = 0; i < CURVES; i++) {
    cprox_workspace *w = q->workspace;
    list_distance(s->movers[i], s->targets, n, &options, w, &s->truth[DISTANCE][i], NULL);
    list_tolerance(s->movers[i], s->targets, n, DELTA, &options, w, &s->truth[TOLERANCE][i], NULL);
    list_collision(s->movers[i], s->targets, n, &options, w, &s->truth[COLLISION][i], NULL);
  }
  return s;
}

static void scene_free(scene *s) {
  for (size_t i = 0; i < CURVES; i++) cprox_curve_free(s->curves[i]);
  for (size_t k = 0; k < s->n; k++) cprox_body_free(s->bodies[k]);
  cprox_obstacles_free(s->batch);
  sampling_free(s->sampling);
  free(s);
}

/* ---- answers ---- */

static void judge_results(const scene *s, const asked *q, bench_answer *a) {
  *a = (bench_answer){0};
  uint32_t nodes = 0, distance_queries = 0;
  for (size_t i = 0; i < CURVES; i++) {
    const cprox_result *r = &q->results[i], *t = &s->truth[q->query_type][i];
    nodes += r->nodes, distance_queries += r->distance_queries;
    if (r->status < 0 || r->status == CPROX_BUDGET) a->failed = true;
    a->wrong += r->verdict != t->verdict || r->lower > t->upper || t->lower > r->upper;
    if (q->query_type == DISTANCE) a->upper = fmax(a->upper, fabs(r->upper - 0.5 * (t->lower + t->upper)));
  }
  a->nodes = nodes, a->distance_queries = distance_queries;
  a->lower = a->upper;
}

/* Of a method that gives a number a curve: the distance, or 1 for "touches" or "closer than delta". */
static void judge_values(const scene *s, const asked *q, bench_answer *a) {
  *a = (bench_answer){0};
  for (size_t i = 0; i < CURVES; i++) {
    const cprox_result *t = &s->truth[q->query_type][i];
    if (q->query_type == DISTANCE)
      a->upper = fmax(a->upper, fabs(q->values[i] - 0.5 * (t->lower + t->upper)));
    else
      a->wrong += (q->values[i] == 1.0) == (t->verdict == CPROX_VERDICT_CLEAR);
  }
  a->lower = a->upper;
}

/* ---- methods ---- */

static void batch(const void *problems, size_t i, void *state, bench_answer *a) {
  const scene *s = ((scene *const *)problems)[i];
  judged *own = state;
  const asked *q = own->asked;
  cprox_options o = CPROX_OPTIONS_DEFAULT;
  o.epsilon = EPSILON;
  if (q->query_type == DISTANCE)
    cprox_obstacles_distance_batch(s->batch, s->movers, 0, CURVES, &o, q->workspace, q->results);
  if (q->query_type == TOLERANCE)
    cprox_obstacles_tolerance_batch(s->batch, s->movers, 0, CURVES, DELTA, &o, q->workspace, q->results);
  if (q->query_type == COLLISION)
    cprox_obstacles_tolerance_batch(s->batch, s->movers, 0, CURVES, 0.0, &o, q->workspace, q->results);
  if (!own->known[i][q->query_type]) judge_results(s, q, &own->answer[i][q->query_type]);
  own->known[i][q->query_type] = true;
  *a = own->answer[i][q->query_type];
}

static void one_by_one(const void *problems, size_t i, void *state, bench_answer *a) {
  const scene *s = ((scene *const *)problems)[i];
  judged *own = state;
  const asked *q = own->asked;
  cprox_options o = CPROX_OPTIONS_DEFAULT;
  o.epsilon = EPSILON;
  for (size_t k = 0; k < CURVES; k++) {
    cprox_result *r = &q->results[k];
    if (q->query_type == DISTANCE) list_distance(s->movers[k], s->targets, s->n, &o, q->workspace, r, NULL);
    if (q->query_type == TOLERANCE) list_tolerance(s->movers[k], s->targets, s->n, DELTA, &o, q->workspace, r, NULL);
    if (q->query_type == COLLISION) list_collision(s->movers[k], s->targets, s->n, &o, q->workspace, r, NULL);
  }
  if (!own->known[i][q->query_type]) judge_results(s, q, &own->answer[i][q->query_type]);
  own->known[i][q->query_type] = true;
  *a = own->answer[i][q->query_type];
}

static void paper(const void *problems, size_t i, void *state, bench_answer *a) {
  const scene *s = ((scene *const *)problems)[i];
  judged *own = state;
  const asked *q = own->asked;
  const paper_query_type query_types[] = {PAPER_DISTANCE, PAPER_TOLERANCE, PAPER_COLLISION};
  const paper_query query = {query_types[q->query_type], DELTA, EPSILON, PAPER_MAX_NODES};
  uint32_t nodes = 0, evaluations = 0;
  for (size_t k = 0; k < CURVES; k++) {
    const paper_curve curve = paper_bezier_curve(&s->bezier[k], true);
    double value = q->query_type == DISTANCE ? INFINITY : 0.0;
    for (size_t j = 0; j < s->n && value != 1.0; j++) {
      const paper_obstacle obstacle = {s->vertex[j], SIDES};
      paper_answer r;
      paper_search(&curve, &obstacle, &query, q->heap, &r);
      nodes += r.nodes, evaluations += r.evaluations;
      if (q->query_type == DISTANCE)
        value = fmin(value, r.upper);
      else if (r.verdict == (q->query_type == COLLISION))
        value = 1.0;
    }
    q->values[k] = value;
  }
  judge_values(s, q, a);
  a->nodes = nodes, a->distance_queries = evaluations;
}

static void sampled(const void *problems, size_t i, void *state, bench_answer *a) {
  const scene *s = ((scene *const *)problems)[i];
  judged *own = state;
  const asked *q = own->asked;
  for (size_t k = 0; k < CURVES; k++) {
    if (q->query_type == COLLISION)
      q->values[k] = sampling_collides(s->sampling, s->points[k], POINTS, TUBE, 100);
    else
      q->values[k] = sampling_distance(s->sampling, s->points[k], POINTS, TUBE, 100);
    if (q->query_type == TOLERANCE) q->values[k] = q->values[k] <= DELTA ? 1.0 : 0.0;
  }
  judge_values(s, q, a);
}

/* ---- workloads ---- */

static void measure_scenes(const bench_size *size, const char *name, bool planar, size_t n, asked *q) {
  if (!bench_wanted(size, name)) return;
  static const char *const query_types[] = {"distance", "tolerance", "collision"};
  scene *s[SCENES];
  for (size_t i = 0; i < SCENES; i++) s[i] = scene_make(100 + i, planar, n, q);
  judged own[3] = {{.asked = q}, {.asked = q}, {.asked = q}};
  bench_method methods[3] = {{"curve_proximity", batch, &own[0]}, {"one by one", one_by_one, &own[1]}};
  size_t n_methods = 2;
  if (planar) methods[n_methods++] = (bench_method){"paper", paper, &own[2]};
  if (!planar && sampling_name()) methods[n_methods++] = (bench_method){sampling_name(), sampled, &own[2]};
  const double none[SCENES] = {0};
  for (int v = 0; v < 3; v++) {
    char workload[64], parameter[32];
    snprintf(workload, sizeof workload, "%s %s", name, query_types[v]);
    snprintf(parameter, sizeof parameter, "%zu obstacles", n);
    const bench_workload w = {"batches", workload, parameter, s, SCENES, none, 0.0};
    q->query_type = (query_type)v;
    bench_measure(&w, size, methods, n_methods);
  }
  for (size_t i = 0; i < SCENES; i++) scene_free(s[i]);
}

int main(int argc, char **argv) {
  const bench_size size = bench_arguments(argc, argv);
  asked q = {.workspace = cprox_workspace_create(),
             .results = calloc(CURVES, sizeof(cprox_result)),
             .values = calloc(CURVES, sizeof(double)),
             .heap = calloc(PAPER_MAX_NODES, sizeof(paper_node))};
  if (!q.workspace || !q.results || !q.values || !q.heap) return 1;
  if (!sampling_name()) fputs("batches: FCL is not installed, sampling is left out\n", stderr);
  measure_scenes(&size, "polygons", true, 2, &q);
  measure_scenes(&size, "boxes", false, 2, &q);
  measure_scenes(&size, "boxes", false, 50, &q);
  measure_scenes(&size, "boxes", false, 100, &q);
  free(q.heap);
  free(q.values);
  free(q.results);
  cprox_workspace_free(q.workspace);
  return 0;
}
