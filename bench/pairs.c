/* SPDX-License-Identifier: BSD-3-Clause */
/* Pairs of convex bodies whose distance is known by construction: at one size, and over twelve decades of size and of
 * size ratio, to a relative 1e-9, beside FCL; depths of overlap; whether they touch. A method that says how far it may be off is wrong
 * where its interval misses the distance; FCL, which does not, where it is off by more than a thousandth of the
 * distance and 1e-9 of the sizes. */
#define _POSIX_C_SOURCE 200809L
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "base/frame.h"
#include "pairs_meshes.h"
#include "support/measure.h"
#include "support/problems.h"
#ifdef CPROX_BENCH_FCL
#include "peers/pair_fcl.h"
#endif

enum { POLYTOPES = 6, CORNERS = 200 };

/* A body with its copy in FCL's terms. */
typedef struct convex {
  cprox_body *body;
  double size; /* at least its circumradius */
  void *fcl;
  bool shared; /* a polytope: one of a few */
} convex;

typedef struct pair {
  convex a, b;
  cprox_pose at, bt;
  double distance, size; /* of both together */
} pair;

typedef struct kinds {
  const char *name;
  cprox_body_kind a, b;
  const char *prefix; /* of the workloads' names: of kinds for which others have formulas as well */
} kinds;

static const kinds KINDS[] = {{"ellipsoids", CPROX_BODY_ELLIPSOID, CPROX_BODY_ELLIPSOID, ""},
                              {"box and cylinder", CPROX_BODY_BOX, CPROX_BODY_CYLINDER, ""},
                              {"capsule and box", CPROX_BODY_CAPSULE, CPROX_BODY_BOX, ""},
                              {"polytopes of 200", CPROX_BODY_POLYTOPE, CPROX_BODY_POLYTOPE, ""},
                              {"sphere and box", CPROX_BODY_SPHERE, CPROX_BODY_BOX, "simple "},
                              {"capsules", CPROX_BODY_CAPSULE, CPROX_BODY_CAPSULE, "simple "},
                              {"boxes", CPROX_BODY_BOX, CPROX_BODY_BOX, "simple "},
                              {"cylinders", CPROX_BODY_CYLINDER, CPROX_BODY_CYLINDER, "simple "}};

typedef struct asked {
  cprox_workspace *workspace;
  convex polytope[POLYTOPES];
} asked;

/* ---- bodies and pairs ---- */

static convex polytope_make(rng *r) {
  static obstacle o;
  o = (obstacle){.n = CORNERS};
  for (size_t i = 0; i < o.n; i++) o.vertex[i] = vec_scale(0.5, rng_unit(r));
  obstacle_find_faces(&o);
  convex c = {.size = 0.5, .shared = true};
  if (cprox_body_create_polytope(o.vertex, o.n, NULL, &c.body) != CPROX_OK) exit(1);
#ifdef CPROX_BENCH_FCL
  c.fcl = pair_fcl_make_polytope(o.vertex, o.n, (const int(*)[3])o.triangle, o.triangles);
#endif
  free(o.triangle);
  return c;
}

static convex convex_make(rng *r, cprox_body_kind kind, double scale, const asked *q) {
  if (kind == CPROX_BODY_POLYTOPE) return q->polytope[rng_index(r, POLYTOPES)];
  const double s[3] = {scale * rng_uniform(r, 0.2, 1.0), scale * rng_uniform(r, 0.2, 1.0),
                       scale * rng_uniform(r, 0.2, 1.0)};
  convex c = {.size = 2.0 * scale};
  cprox_status status;
  switch (kind) {
    case CPROX_BODY_SPHERE: status = cprox_body_create_sphere(s[0], NULL, &c.body); break;
    case CPROX_BODY_BOX: status = cprox_body_create_box(vec(s[0], s[1], s[2]), NULL, &c.body); break;
    case CPROX_BODY_CYLINDER: status = cprox_body_create_cylinder(s[0], s[1], NULL, &c.body); break;
    case CPROX_BODY_CAPSULE: status = cprox_body_create_capsule(s[0], s[1], NULL, &c.body); break;
    default: status = cprox_body_create_ellipsoid(vec(s[0], s[1], s[2]), NULL, &c.body);
  }
  if (status != CPROX_OK) exit(1);
#ifdef CPROX_BENCH_FCL
  c.fcl = pair_fcl_make(kind, s);
#endif
  return c;
}

static void convex_free(const convex *c) {
#ifdef CPROX_BENCH_FCL
  pair_fcl_free(c->fcl);
#endif
  cprox_body_free(c->body);
}

/* The point of the posed body that is farthest along d. */
static vec3 extreme(const cprox_body *body, const cprox_pose *pose, vec3 d) {
  const frame f = frame_create(pose, vec(0.0, 0.0, 0.0));
  vec3 at;
  cprox_body_support(body, frame_turn_to_local(&f, d), &at);
  return frame_to_world(&f, at);
}

/* b stands so that both touch the same two parallel planes, `distance` apart, with a segment between them along their
 * normal, which is that of b's nearest point to somewhere: faces, edges and corners take part. */
static pair pair_make(rng *r, const kinds *k, double scale_a, double scale_b, double relative_gap, const asked *q) {
  pair p = {.a = convex_make(r, k->a, scale_a, q), .b = convex_make(r, k->b, scale_b, q)};
  p.size = p.a.size + p.b.size;
  p.at = rng_pose(r, 0.0), p.bt = rng_pose(r, 0.0);
  const frame f = frame_create(&p.bt, vec(0.0, 0.0, 0.0));
  const vec3 somewhere = vec_scale(2.0 * p.b.size, rng_unit(r));
  vec3 nearest;
  cprox_body_nearest(p.b.body, somewhere, &nearest);
  const vec3 n =
      frame_turn_to_world(&f, vec_scale(1.0 / vec_norm(vec_sub(somewhere, nearest)), vec_sub(somewhere, nearest)));
  p.distance = relative_gap * p.size;
  const vec3 on_a = extreme(p.a.body, &p.at, vec_scale(-1.0, n)), on_b = extreme(p.b.body, &p.bt, n);
  p.bt.position = vec_sub(vec_axpy(on_a, -p.distance, n), on_b);
  return p;
}

static void pair_free(const pair *p) {
  if (!p->a.shared) convex_free(&p->a);
  if (!p->b.shared) convex_free(&p->b);
}

/* ---- the methods ---- */

static cprox_result ask(const pair *p, const asked *q) {
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.epsilon = p->distance < 0.0 ? 1e-8 * p->size : 0.0;
  options.relative_epsilon = 1e-9;
  cprox_result r = {.status = CPROX_INVALID};
  cprox_pair(cprox_obstacle_at(p->a.body, p->at), cprox_obstacle_at(p->b.body, p->bt), &options, q->workspace, &r);
  return r;
}

static bool is_decided(const cprox_result *r) {
  return r->status == CPROX_OK || r->status == CPROX_PRECISION;
}

static void ours(const void *problems, size_t i, void *state, bench_answer *a) {
  const pair *p = (const pair *)problems + i;
  const cprox_result r = ask(p, state);
  *a = (bench_answer){
      .lower = NAN, .upper = NAN, .nodes = r.nodes, .distance_queries = r.distance_queries, .failed = r.status < 0};
  const double doubt = 256.0 * 0x1p-53 * p->size; /* of the construction: a few roundings of positions and supports */
  a->wrong = p->distance < 0.0 ? r.lower > 0.0 : r.lower > p->distance + doubt || r.upper < p->distance - doubt;
}

static void our_verdict(const void *problems, size_t i, void *state, bench_answer *a) {
  const pair *p = (const pair *)problems + i;
  cprox_result r = {.status = CPROX_INVALID};
  cprox_pair_tolerance(cprox_obstacle_at(p->a.body, p->at), cprox_obstacle_at(p->b.body, p->bt), 0.0, NULL,
                       ((const asked *)state)->workspace, &r);
  *a = (bench_answer){
      .lower = NAN, .upper = NAN, .nodes = r.nodes, .distance_queries = r.distance_queries, .failed = r.status < 0};
  a->wrong = p->distance < 0.0 ? r.verdict == CPROX_VERDICT_CLEAR : r.verdict == CPROX_VERDICT_VIOLATED;
}

#ifdef CPROX_BENCH_FCL
static void fcl_verdict(const void *problems, size_t i, void *state, bench_answer *a) {
  const pair *p = (const pair *)problems + i;
  (void)state;
  const int touch = pair_fcl_collides(p->a.fcl, &p->at, p->b.fcl, &p->bt);
  *a = (bench_answer){.lower = NAN, .upper = NAN, .failed = touch < 0};
  a->wrong = touch >= 0 && touch != (p->distance < 0.0);
}

static void fcl(const void *problems, size_t i, void *state, bench_answer *a) {
  const pair *p = (const pair *)problems + i;
  (void)state;
  const double d = pair_fcl_distance(p->a.fcl, &p->at, p->b.fcl, &p->bt);
  *a = (bench_answer){.lower = NAN, .upper = NAN, .failed = isnan(d)};
  a->wrong = !a->failed && fabs(d - p->distance) > 1e-3 * p->distance + 1e-9 * p->size;
}
#endif

/* ---- the workloads ---- */

static void measure(const bench_size *size, const char *workload, const kinds *k, const pair *pairs, size_t n,
                    asked *q) {
  char parameter[64];
  snprintf(parameter, sizeof parameter, "%s %zu cases", k->name, n);
  const bench_workload w = {"pairs", workload, parameter, pairs, n, NULL, 0.0};
  const bench_method methods[] = {{"curve_proximity", ours, q},
#ifdef CPROX_BENCH_FCL
                                  {"FCL", fcl, q}
#endif
  };
  bench_measure(&w, size, methods, pairs[0].distance < 0.0 ? 1 : sizeof methods / sizeof *methods);
}

/* Whether they touch, and no more. */
static void measure_verdict(const bench_size *size, const char *apart, const kinds *k, const pair *pairs, asked *q) {
  char workload[96], parameter[64];
  snprintf(workload, sizeof workload, "verdict %s", apart);
  snprintf(parameter, sizeof parameter, "%s %zu cases", k->name, size->problems);
  const bench_workload w = {"pairs", workload, parameter, pairs, size->problems, NULL, 0.0};
  const bench_method methods[] = {{"curve_proximity", our_verdict, q},
#ifdef CPROX_BENCH_FCL
                                  {"FCL", fcl_verdict, q}
#endif
  };
  bench_measure(&w, size, methods, sizeof methods / sizeof *methods);
}

static int ascending(const void *a, const void *b) {
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

static double microseconds_of(const pair *p, const asked *q, cprox_result *r) {
  struct timespec begin, end;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &begin);
  *r = ask(p, q);
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &end);
  return 1e6 * (double)(end.tv_sec - begin.tv_sec) + 1e-3 * (double)(end.tv_nsec - begin.tv_nsec);
}

/* The time of the slowest pair in a thousand, and how many were not decided within the limit of iterations. Of three
 * times each the middle one: the slowest of single times are those that something else of the machine interrupted. */
static void measure_tail(const char *workload, const kinds *k, const pair *pairs, size_t n, asked *q) {
  double *times = calloc(n, sizeof *times);
  if (!times) exit(1);
  size_t undecided = 0;
  for (size_t i = 0; i < n; i++) {
    cprox_result r;
    double t[3];
    for (int turn = 0; turn < 3; turn++) t[turn] = microseconds_of(&pairs[i], q, &r);
    qsort(t, 3, sizeof *t, ascending);
    times[i] = t[1];
    undecided += !is_decided(&r);
  }
  qsort(times, n, sizeof *times, ascending);
  printf("pairs,%s p99.9,curve_proximity,%s %zu cases,%.4g,%.4g,0,0,%.3g,0,0\n", workload, k->name, n,
         times[(size_t)(0.999 * (double)(n - 1))], times[n - 1], (double)undecided / (double)n);
  fflush(stdout);
  free(times);
}

static void one_kind(const bench_size *size, const kinds *k, asked *q) {
  const size_t many = 50 * size->problems;
  pair *pairs = calloc(many, sizeof *pairs);
  if (!pairs) exit(1);
  static const char *const workloads[] = {"apart", "apart at all sizes", "overlapping"};
  for (int w = 0; w < 3; w++) {
    char workload[64];
    snprintf(workload, sizeof workload, "%s%s", k->prefix, workloads[w]);
    if (!bench_wanted(size, workload) || (w == 1 && k->a == CPROX_BODY_POLYTOPE))
      continue; /* polytopes have one size here */
    rng r = rng_seed(601 + (uint64_t)w);
    for (size_t i = 0; i < many; i++) {
      const double a = w == 1 ? rng_log_uniform(&r, 1e-6, 1e6) : 1.0, b = w == 1 ? rng_log_uniform(&r, 1e-6, 1e6) : 1.0;
      const double gap = w == 2 ? -rng_log_uniform(&r, 1e-6, 0.1) : rng_log_uniform(&r, 1e-6, 1.0);
      pairs[i] = pair_make(&r, k, a, b, gap, q);
    }
    if (w == 1) {
      const bench_size once = {.problems = many, .rounds = 1};
      measure(&once, workload, k, pairs, many, q);
    } else {
      measure(size, workload, k, pairs, size->problems, q);
      measure_tail(workload, k, pairs, many, q);
      measure_verdict(size, workload, k, pairs, q);
    }
    for (size_t i = 0; i < many; i++) pair_free(&pairs[i]);
  }
  free(pairs);
}

int main(int argc, char **argv) {
  const bench_size size = bench_arguments(argc, argv);
  asked q = {.workspace = cprox_workspace_create()};
  rng r = rng_seed(600);
  for (int i = 0; i < POLYTOPES; i++) q.polytope[i] = polytope_make(&r);
  for (size_t k = 0; k < sizeof KINDS / sizeof *KINDS; k++) one_kind(&size, &KINDS[k], &q);
  if (bench_wanted(&size, "meshes")) pairs_meshes(&size, q.workspace);
  for (int i = 0; i < POLYTOPES; i++) convex_free(&q.polytope[i]);
  cprox_workspace_free(q.workspace);
  return 0;
}
