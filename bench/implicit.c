/* SPDX-License-Identifier: BSD-3-Clause */
/* Implicit bodies: the tables and the figure of Chakraborty et al. 2008 made again, the interior point method beside
 * the climb of the dual that goes before it, the search by support functions, and Ipopt where it is installed. `nodes`
 * are iterations. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "convex/pair.h"
#include "curve_proximity/cprox/translation.h"
#include "implicit_growth.h"
#include "peers/naive.h"
#include "shape/body.h"
#include "support/implicit_problems.h"
#include "support/measure.h"
#ifdef CPROX_BENCH_IPOPT
#include "peers/ipopt.h"
#endif
#ifdef CPROX_BENCH_FCL
#include "peers/mesh_fcl.h"
#endif

/* What is asked for, as a fraction of both bodies' sizes. */
static double accuracy = 1e-8;

/* What the methods need besides the problem. */
typedef struct bench_state {
  cprox_workspace *workspace;
  void *memory;
  const double *truth;
  double duration;
  const double *exponents;  /* deformation: to these */
  cprox_affine scale[2];    /* or each body by its own */
  cprox_pair_start *starts; /* of a motion: where the search of the problem before each ended */
  void *mesh[2];            /* of a peer */
  const cprox_body *surface[2];
  size_t n;
} bench_state;

static double accuracy_of(const implicit_problem *p) {
  return accuracy * (p->query.a->radius + p->query.b->radius);
}

/* ---- Table I ---- */

static void hybrid(const void *problems, size_t i, void *state, bench_answer *a) {
  const implicit_problem *p = (const implicit_problem *)problems + i;
  const bench_state *s = state;
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.epsilon = accuracy_of(p);
  cprox_result r;
  const cprox_status status = cprox_pair(cprox_obstacle_at(p->a, CPROX_POSE_IDENTITY), cprox_obstacle_at(p->b, p->pose),
                                         &options, s->workspace, &r);
  *a = (bench_answer){.lower = r.lower, .upper = r.upper, .nodes = r.nodes, .distance_queries = r.distance_queries};
  a->failed = status != CPROX_OK;
}

static void interior_point(const void *problems, size_t i, void *state, bench_answer *a) {
  const implicit_problem *p = (const implicit_problem *)problems + i;
  const bench_state *s = state;
  const implicit_goal goal = {.epsilon = accuracy_of(p), .max_steps = 2000};
  implicit_answer r;
  implicit_solve(&p->query, &goal, NULL, s->memory, &r);
  *a = (bench_answer){.lower = r.lower, .upper = r.upper, .nodes = r.steps, .failed = !r.certified};
}

/* The search by support functions alone; other bodies than superquadrics have theirs by an interior point method each
 * time. */
static void supports(const void *problems, size_t i, void *state, bench_answer *a) {
  (void)state;
  const implicit_problem *p = (const implicit_problem *)problems + i;
  pair_placement place = {.t = p->query.t};
  for (int k = 0; k < 9; k++) place.r[k] = p->query.m[k];
  const pair_goal goal = {.epsilon = accuracy_of(p), .max_steps = 2000};
  pair_answer r;
  pair_separate(&p->a->shape, 0.0, &p->b->shape, 0.0, &place, &goal, &r);
  *a = (bench_answer){.lower = r.lower, .upper = r.upper, .nodes = r.steps, .distance_queries = r.supports};
  a->failed = !(r.upper - r.lower <= goal.epsilon);
}

/* Neither has a certificate: what is off by more than 1e-6 counts as failed. */
static bool is_off(const bench_state *s, const implicit_problem *p, size_t i, double distance) {
  const double reach = p->query.a->radius + p->query.b->radius;
  return s->truth && !(fabs(distance - s->truth[i]) <= fmax(1e-6, accuracy) * (reach + s->truth[i]));
}

static void naive(const void *problems, size_t i, void *state, bench_answer *a) {
  const implicit_problem *p = (const implicit_problem *)problems + i;
  const naive_answer r = naive_pair(&p->query, accuracy);
  *a = (bench_answer){.lower = r.distance, .upper = r.distance, .nodes = (uint32_t)r.iterations};
  a->failed = !r.converged || is_off(state, p, i, r.distance);
}

#ifdef CPROX_BENCH_IPOPT
static void ipopt(const void *problems, size_t i, void *state, bench_answer *a) {
  const implicit_problem *p = (const implicit_problem *)problems + i;
  const ipopt_answer r = ipopt_pair(&p->query, accuracy);
  *a = (bench_answer){.lower = r.distance, .upper = r.distance, .nodes = (uint32_t)r.iterations};
  a->failed = !r.solved || is_off(state, p, i, r.distance);
}
#endif

/* Ipopt, where it is, by itself and in one round: its time is most of the group's, and what it is beside ours is no
 * matter of caches. */
static void measure_ipopt(const bench_workload *w, const bench_size *size, bench_state *s) {
#ifdef CPROX_BENCH_IPOPT
  const bench_size once = {.problems = size->problems, .rounds = 1};
  bench_measure(w, &once, &(bench_method){"ipopt", ipopt, s}, 1);
#else
  (void)w, (void)size, (void)s;
#endif
}

static void *memory_of(const cprox_body *a, const cprox_body *b) {
  return malloc(implicit_memory(a->shape.implicit, b->shape.implicit));
}

static void table_1(const bench_size *size, cprox_body *const *object, bench_state *s) {
  static const int pairs[8][2] = {{1, 2}, {1, 3}, {2, 3}, {3, 4}, {2, 4}, {3, 5}, {5, 6}, {3, 6}};
  static const char *const names[] = {"", "I", "II", "III", "IV", "V", "VI"};
  for (int k = 0; k < 8; k++) {
    char parameter[32];
    snprintf(parameter, sizeof parameter, "%s-%s", names[pairs[k][0]], names[pairs[k][1]]);
    const cprox_body *a = object[pairs[k][0]], *b = object[pairs[k][1]];
    implicit_problem *problems = implicit_problems_make(a, b, 2, 8, 31 + (uint64_t)k, size->problems);
    double *truth = implicit_problems_truth(problems, size->problems);
    s->truth = truth;
    s->memory = memory_of(a, b);
    /* what the two that are compared come after is neither of them: who asks the same ten problems again is faster */
    const bench_method methods[] = {{"naive", naive, s},
                                    {"curve_proximity", hybrid, s},
                                    {"supports", supports, s},
                                    {"interior_point", interior_point, s}};
    const bench_workload w = {.group = "implicit",
                              .name = "table I",
                              .parameter = parameter,
                              .problems = problems,
                              .n = size->problems,
                              .truth = truth,
                              .doubt = 1e-9};
    bench_measure(&w, size, methods, 4);
    measure_ipopt(&w, size, s);
    free(s->memory);
    free(truth);
    free(problems);
  }
}

/* ---- Table II: b flies past a, or into it ---- */

static void closest(const void *problems, size_t i, void *state, bench_answer *a) {
  const implicit_problem *p = (const implicit_problem *)problems + i;
  const bench_state *s = state;
  const cprox_translating x = {.from = cprox_obstacle_at(p->a, CPROX_POSE_IDENTITY)};
  const vec3 aim = vec_scale(-1.0, p->pose.position);
  const cprox_translating y = {.from = cprox_obstacle_at(p->b, p->pose),
                               .velocity = {aim.y + aim.x, aim.y - aim.x, aim.z}};
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.epsilon = accuracy_of(p);
  cprox_result r;
  const cprox_status status = cprox_translating_distance(x, y, s->duration, &options, s->workspace, &r);
  *a = (bench_answer){.lower = r.lower, .upper = r.upper, .nodes = r.nodes, .failed = status != CPROX_OK};
}

static void time_of_contact(const void *problems, size_t i, void *state, bench_answer *a) {
  const implicit_problem *p = (const implicit_problem *)problems + i;
  const bench_state *s = state;
  const cprox_translating x = {.from = cprox_obstacle_at(p->a, CPROX_POSE_IDENTITY)};
  const cprox_translating y = {.from = cprox_obstacle_at(p->b, p->pose), .velocity = vec_scale(-1.0, p->pose.position)};
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.epsilon = 1e-7 * (p->query.a->radius + p->query.b->radius);
  cprox_result r;
  const cprox_status status = cprox_translating_contact(x, y, s->duration, &options, s->workspace, &r);
  *a = (bench_answer){
      .lower = r.t_contact_lower, .upper = r.t, .nodes = r.distance_queries, .failed = status != CPROX_OK};
  a->failed = a->failed || r.verdict != CPROX_VERDICT_VIOLATED;
}

static void table_2(const bench_size *size, cprox_body *const *object, bench_state *s) {
  static const int pairs[2][2] = {{1, 3}, {2, 3}};
  for (int k = 0; k < 2; k++) {
    const char *parameter = k == 0 ? "I-III" : "II-III";
    implicit_problem *problems =
        implicit_problems_make(object[pairs[k][0]], object[pairs[k][1]], 4, 8, 41 + (uint64_t)k, size->problems);
    bench_workload w = {.group = "implicit", .parameter = parameter, .problems = problems, .n = size->problems};
    s->duration = 1.0;
    w.name = "table II closest distance";
    bench_measure(&w, size, &(bench_method){"curve_proximity", closest, s}, 1);
    w.name = "table II time of contact";
    const bench_method contact[] = {{"curve_proximity", time_of_contact, s}, {"least distance", closest, s}};
    bench_measure(&w, size, contact, 2);
    free(problems);
  }
}

/* ---- Table III: the deformed body is made and measured ---- */

/* The body at a part of its deformation: to the exponents, or by the scale. */
static cprox_body *deformed_body(const cprox_body *from, const bench_state *s, int side, double part) {
  cprox_affine map = {.linear = {1, 0, 0, 0, 1, 0, 0, 0, 1}};
  double exponents[3];
  for (int k = 0; k < 3; k++) {
    const double p = from->shape.implicit->term[k].p;
    exponents[k] = s->exponents ? p + part * (s->exponents[k] - p) : p;
    if (!s->exponents) map.linear[4 * k] = 1.0 + part * (s->scale[side].linear[4 * k] - 1.0);
  }
  const cprox_implicit_description d = {
      .deformed = from, .exponents = s->exponents ? exponents : NULL, .n_exponents = 3};
  cprox_body *body = NULL;
  if (cprox_body_create_implicit(&d, s->exponents ? NULL : &map, s->workspace, &body) < 0) return NULL;
  return body;
}

/* The step of ten that the problem's number picks: exponents of a alone, the scale of both. */
static void deformed(const void *problems, size_t i, void *state, bench_answer *a) {
  const implicit_problem *p = (const implicit_problem *)problems + i;
  const bench_state *s = state;
  const double part = (double)(i % 10 + 1) / 10.0;
  cprox_body *first = deformed_body(p->a, s, 0, part), *second = s->exponents ? NULL : deformed_body(p->b, s, 1, part);
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.epsilon = accuracy_of(p);
  cprox_result r = {.status = CPROX_INVALID};
  if (first && (second || s->exponents))
    cprox_pair(cprox_obstacle_at(first, CPROX_POSE_IDENTITY), cprox_obstacle_at(second ? second : p->b, p->pose),
               &options, s->workspace, &r);
  cprox_body_free(first);
  cprox_body_free(second);
  *a = (bench_answer){.lower = r.lower, .upper = r.upper, .nodes = r.nodes, .failed = r.status != CPROX_OK};
}

static void table_3(const bench_size *size, cprox_body *const *object, bench_state *s) {
  static const double third[3] = {76.0 / 9, 71.0 / 5, 179.0 / 13};
  for (int k = 0; k < 4; k++) {
    const int first = k % 2 + 1;
    implicit_problem *problems =
        implicit_problems_make(object[first], object[3], 7, 10, 51 + (uint64_t)k, size->problems);
    const bench_workload w = {.group = "implicit",
                              .name = k < 2 ? "table III scaling" : "table III exponents",
                              .parameter = first == 1 ? "I-III" : "II-III",
                              .problems = problems,
                              .n = size->problems};
    s->exponents = k < 2 ? NULL : third;
    s->scale[0] = (cprox_affine){.linear = {1, 0, 0, 0, 0.5, 0, 0, 0, 2}};
    s->scale[1] = (cprox_affine){.linear = {0.5, 0, 0, 0, 3, 0, 0, 0, 0.67}};
    bench_measure(&w, size, &(bench_method){"curve_proximity", deformed, s}, 1);
    free(problems);
  }
}

/* ---- the accuracy asked for ---- */

static void accuracies(const bench_size *size, cprox_body *const *object, bench_state *s) {
  const double usual = accuracy;
  implicit_problem *problems = implicit_problems_make(object[2], object[3], 2, 8, 81, size->problems);
  double *truth = implicit_problems_truth(problems, size->problems);
  s->truth = truth;
  s->memory = memory_of(object[2], object[3]);
  for (int digits = 2; digits <= 12; digits += 2) {
    accuracy = pow(10.0, -digits);
    char parameter[32];
    snprintf(parameter, sizeof parameter, "1e-%02d", digits);
    const bench_method methods[] = {
        {"curve_proximity", hybrid, s}, {"supports", supports, s}, {"interior_point", interior_point, s}};
    const bench_workload w = {.group = "implicit",
                              .name = "accuracy",
                              .parameter = parameter,
                              .problems = problems,
                              .n = size->problems,
                              .truth = truth,
                              .doubt = 1e-9};
    bench_measure(&w, size, methods, 3);
    measure_ipopt(&w, size, s);
  }
  accuracy = usual;
  free(s->memory);
  free(truth);
  free(problems);
}

/* ---- a motion: each problem is the one before it, a little moved ---- */

static void tracked(const void *problems, size_t i, void *state, bench_answer *a) {
  const implicit_problem *p = (const implicit_problem *)problems + i;
  const bench_state *s = state;
  cprox_pair_start start = s->starts[i];
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.epsilon = accuracy_of(p);
  options.start = &start;
  cprox_result r;
  const cprox_status status = cprox_pair(cprox_obstacle_at(p->a, CPROX_POSE_IDENTITY), cprox_obstacle_at(p->b, p->pose),
                                         &options, s->workspace, &r);
  *a = (bench_answer){.lower = r.lower, .upper = r.upper, .nodes = r.nodes, .distance_queries = r.distance_queries};
  a->failed = status != CPROX_OK;
  if (i + 1 < s->n) s->starts[i + 1] = start;
}

static void motions(const bench_size *size, cprox_body *const *object, bench_state *s) {
  static const int pairs[3][2] = {{2, 3}, {3, 4}, {5, 6}};
  static const char *const names[3] = {"II-III", "III-IV", "V-VI"};
  for (int k = 0; k < 3; k++) {
    for (int digits = 1; digits <= 3; digits++) {
      const double step = pow(10.0, -digits);
      implicit_problem *problems =
          implicit_problems_make(object[pairs[k][0]], object[pairs[k][1]], 6, 6.5, 91 + (uint64_t)k, size->problems);
      rng r = rng_seed(95 + (uint64_t)k);
      cprox_pose pose = problems[0].pose;
      for (size_t i = 0; i < size->problems; i++) {
        implicit_problem_place(&problems[i], pose);
        const vec3 across = vec_cross(pose.position, rng_unit(&r));
        pose.position = vec_axpy(pose.position, step / vec_norm(across), across);
        pose.position = vec_scale(6.0 / vec_norm(pose.position), pose.position);
        pose.orientation.x += step * rng_uniform(&r, -1, 1), pose.orientation.y += step * rng_uniform(&r, -1, 1);
      }
      char parameter[32];
      snprintf(parameter, sizeof parameter, "%s step %g", names[k], step);
      const bench_workload w = {
          .group = "implicit", .name = "motion", .parameter = parameter, .problems = problems, .n = size->problems};
      const bench_method methods[] = {{"curve_proximity", hybrid, s}, {"curve_proximity tracked", tracked, s}};
      s->n = size->problems;
      s->starts = calloc(s->n, sizeof *s->starts);
      if (!s->starts) exit(1);
      bench_measure(&w, size, methods, 2);
      free(s->starts);
      free(problems);
    }
  }
}

/* ---- the objects as meshes, as the paper gave them to PQP ---- */

/* Support points in the directions of a sphere of `rings` circles and twice as many points each. */
static size_t mesh_of(const cprox_body *body, int rings, vec3 *vertex, uint32_t (*triangle)[3]) {
  const int sides = 2 * rings;
  const double pi = 3.14159265358979323846;
  for (int i = 0; i <= rings; i++) {
    for (int k = 0; k < sides; k++) {
      const double latitude = pi * ((double)i / rings - 0.5), longitude = 2.0 * pi * k / sides;
      const vec3 u = {cos(latitude) * cos(longitude), cos(latitude) * sin(longitude), sin(latitude)};
      cprox_body_support(body, u, &vertex[i * sides + k]);
    }
  }
  size_t n = 0;
  for (int i = 0; i < rings; i++) {
    for (int k = 0; k < sides; k++) {
      const uint32_t a = (uint32_t)(i * sides + k), b = (uint32_t)(i * sides + (k + 1) % sides);
      const uint32_t c = a + (uint32_t)sides, d = b + (uint32_t)sides;
      if (!vec_equal(vertex[a], vertex[b])) triangle[n][0] = a, triangle[n][1] = b, triangle[n][2] = d, n++;
      if (!vec_equal(vertex[c], vertex[d])) triangle[n][0] = a, triangle[n][1] = d, triangle[n][2] = c, n++;
    }
  }
  return n;
}

static void meshes_ours(const void *problems, size_t i, void *state, bench_answer *a) {
  const implicit_problem *p = (const implicit_problem *)problems + i;
  const bench_state *s = state;
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.epsilon = 1e-6;
  options.max_nodes = 1000000;
  cprox_result r;
  const cprox_status status = cprox_pair(cprox_obstacle_at(s->surface[0], CPROX_POSE_IDENTITY),
                                         cprox_obstacle_at(s->surface[1], p->pose), &options, s->workspace, &r);
  *a = (bench_answer){.lower = r.lower, .upper = r.upper, .nodes = r.nodes, .distance_queries = r.distance_queries};
  a->failed = status < 0;
}

#ifdef CPROX_BENCH_FCL
static void meshes_fcl(const void *problems, size_t i, void *state, bench_answer *a) {
  const implicit_problem *p = (const implicit_problem *)problems + i;
  const bench_state *s = state;
  const cprox_pose here = CPROX_POSE_IDENTITY;
  const double d = mesh_fcl_distance(s->mesh[0], &here, s->mesh[1], &p->pose);
  *a = (bench_answer){.lower = d, .upper = d, .failed = isnan(d)};
}
#endif

static void meshes(const bench_size *size, cprox_body *const *object, bench_state *s) {
  static const int pairs[3][2] = {{2, 3}, {3, 4}, {5, 6}};
  static const char *const names[3] = {"II-III", "III-IV", "V-VI"};
  enum { RINGS = 69, MOST = 2 * RINGS * 2 * RINGS };
  vec3 *vertex = malloc(MOST * sizeof *vertex);
  uint32_t(*triangle)[3] = malloc(MOST * sizeof *triangle);
  if (!vertex || !triangle) exit(1);
  for (int k = 0; k < 3; k++) {
    implicit_problem *problems =
        implicit_problems_make(object[pairs[k][0]], object[pairs[k][1]], 2, 8, 101 + (uint64_t)k, size->problems);
    cprox_body *surface[2] = {NULL, NULL};
    for (int side = 0; side < 2; side++) {
      const size_t n = mesh_of(object[pairs[k][side]], RINGS, vertex, triangle);
      const size_t corners = (RINGS + 1) * 2 * RINGS;
      if (cprox_body_create_mesh(vertex, corners, (const uint32_t(*)[3])triangle, n, CPROX_MESH_FILL_SURFACE, SIZE_MAX,
                                 s->workspace, &surface[side]) < 0)
        exit(1);
      s->surface[side] = surface[side];
#ifdef CPROX_BENCH_FCL
      s->mesh[side] = mesh_fcl_make(vertex, corners, (const uint32_t(*)[3])triangle, n);
#endif
    }
    const bench_workload w = {
        .group = "implicit", .name = "as meshes", .parameter = names[k], .problems = problems, .n = size->problems};
    const bench_method methods[] = {
        {"curve_proximity bodies", hybrid, s},
        {"curve_proximity", meshes_ours, s},
#ifdef CPROX_BENCH_FCL
        {"fcl meshes", meshes_fcl, s},
#endif
    };
    bench_measure(&w, size, methods, sizeof methods / sizeof *methods);
    for (int side = 0; side < 2; side++) {
      cprox_body_free(surface[side]);
#ifdef CPROX_BENCH_FCL
      mesh_fcl_free(s->mesh[side]);
#endif
    }
    free(problems);
  }
  free(vertex);
  free(triangle);
}

/* ---- Fig. 2: growth in the number of constraints ---- */

static void figure_2(const bench_size *size, bench_state *s) {
  static const char *const names[3] = {"figure 2 planes", "figure 2 quadrics", "figure 2 superquadrics"};
  const size_t n = size->problems < 50 ? size->problems : 50;
  for (int kind = 0; kind < 3; kind++) {
    for (size_t count = 6; count <= 192; count *= 2) {
      cprox_body *a = implicit_body_of_many((implicit_many)kind, count, 61);
      cprox_body *b = implicit_body_of_many((implicit_many)kind, count, 62);
      implicit_problem *problems = implicit_problems_make(a, b, 2.7, 8, 63, n);
      char parameter[32];
      snprintf(parameter, sizeof parameter, "%zu", 2 * count);
      s->memory = memory_of(a, b);
      s->truth = NULL;
      const bench_method methods[] = {{"naive", naive, s}, {"interior_point", interior_point, s}};
      const bench_workload w = {
          .group = "implicit", .name = names[kind], .parameter = parameter, .problems = problems, .n = n};
      bench_measure(&w, size, methods, 2);
      if (count <= 24) measure_ipopt(&w, size, s);
      free(s->memory);
      free(problems);
      cprox_body_free(a);
      cprox_body_free(b);
    }
  }
}

/* ---- the families on which solvers fail ---- */

static void hard(const bench_size *size, bench_state *s) {
  static const char *const tags[] = {"exponent", "aspect", "scale",  "mixedscale", "far",        "faceface",
                                     "apexapex", "discs",  "parcyl", "spheres",    "cuboidflat", "mixed"};
  for (size_t k = 0; k < sizeof tags / sizeof *tags; k++) {
    implicit_problem *problems;
    double *truth;
    const size_t n = implicit_problems_read(BENCH_DATA_DIR "/reference/implicit_hard.csv", tags[k], &problems, &truth);
    if (n > 0) {
      s->truth = truth;
      size_t most = 0;
      for (size_t i = 0; i < n; i++) {
        const size_t bytes = implicit_memory(problems[i].query.a, problems[i].query.b);
        most = bytes > most ? bytes : most;
      }
      s->memory = malloc(most);
      const bench_method methods[] = {
          {"naive", naive, s}, {"curve_proximity", hybrid, s}, {"interior_point", interior_point, s}};
      char parameter[48];
      snprintf(parameter, sizeof parameter, "%s %zu cases", tags[k], n);
      const bench_workload w = {
          .group = "implicit", .name = "hard families", .parameter = parameter, .problems = problems, .n = n};
      bench_measure(&w, size, methods, 3);
      measure_ipopt(&w, size, s);
      free(s->memory);
    }
    free(problems);
    free(truth);
  }
}

/* ---- one point ---- */

static void point_quick(const void *problems, size_t i, void *state, bench_answer *a) {
  (void)state;
  const implicit_problem *p = (const implicit_problem *)problems + i;
  convex_near near;
  p->a->shape.ops->nearest(&p->a->shape, p->query.t, NULL, &near);
  *a = (bench_answer){.lower = near.distance, .upper = near.distance};
}

static void point_interior(const void *problems, size_t i, void *state, bench_answer *a) {
  const implicit_problem *p = (const implicit_problem *)problems + i;
  const bench_state *s = state;
  const implicit_query query = {.a = p->query.a, .t = p->query.t};
  const implicit_goal goal = {.epsilon = 1e-12 * p->query.a->radius, .relative_epsilon = 1e-12, .max_steps = 2000};
  implicit_answer r;
  implicit_solve(&query, &goal, NULL, s->memory, &r);
  *a = (bench_answer){.lower = r.lower, .upper = r.upper, .nodes = r.steps, .failed = !r.certified};
}

static void points(const bench_size *size, cprox_body *const *object, bench_state *s) {
  static const char *const names[] = {"", "I", "II", "III", "IV", "V", "VI"};
  for (int k = 1; k <= 6; k++) {
    implicit_problem *problems = implicit_problems_make(object[k], object[3], 4, 8, 71 + (uint64_t)k, size->problems);
    s->memory = memory_of(object[k], object[3]);
    const bench_method methods[6] = {{"curve_proximity", point_quick, s}, {"interior_point", point_interior, s}};
    const bench_workload w = {
        .group = "implicit", .name = "point", .parameter = names[k], .problems = problems, .n = size->problems};
    bench_measure(&w, size, methods, 2);
    free(s->memory);
    free(problems);
  }
}

int main(int argc, char **argv) {
  const bench_size size = bench_arguments(argc, argv);
  bench_state s = {.workspace = cprox_workspace_create()};
  cprox_body *object[7] = {NULL};
  for (int k = 1; k <= 6; k++) object[k] = implicit_object(k);
  if (bench_wanted(&size, "table I")) table_1(&size, object, &s);
  if (bench_wanted(&size, "table II")) table_2(&size, object, &s);
  if (bench_wanted(&size, "table III")) table_3(&size, object, &s);
  if (bench_wanted(&size, "accuracy")) accuracies(&size, object, &s);
  if (bench_wanted(&size, "motion")) motions(&size, object, &s);
  if (bench_wanted(&size, "as meshes")) meshes(&size, object, &s);
  if (bench_wanted(&size, "figure 2")) figure_2(&size, &s);
  if (bench_wanted(&size, "hard families")) hard(&size, &s);
  if (bench_wanted(&size, "point")) points(&size, object, &s);
  if (bench_wanted(&size, "growth gradient")) implicit_growths(&size, object, s.workspace);
  for (int k = 1; k <= 6; k++) cprox_body_free(object[k]);
  cprox_workspace_free(s.workspace);
  return 0;
}
