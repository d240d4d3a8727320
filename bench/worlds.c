/* SPDX-License-Identifier: BSD-3-Clause */
/* Quintic Bézier curves against meshes of 1,280, 20,480 and 81,920 triangles, 10^5 points and octree cells, and sets of 10 to 10^4 bodies;
 * FCL at 100 points of the curve beside. The truth is our own interval at epsilon 1e-12, which tests hold against long double. Rows
 * "build …" have the time of one construction, and in the column nodes the bytes that an element takes. */
#define _POSIX_C_SOURCE 200809L
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "curve_proximity/cprox.h"
#include "peers/worlds.h"
#include "support/measure.h"
#include "support/random.h"

enum { POINTS = 6, SAMPLES = 100, CLOUD = 100000 };
static const double EPSILON = 1e-6, CONTACT = 1e-9, BALL = 0.05, CELL = 0.05;

static void check(cprox_status status, const cprox_workspace *ws) {
  if (status >= 0) return;
  fprintf(stderr, "worlds: %s\n", cprox_workspace_reason(ws));
  exit(1);
}

static void *get(size_t bytes) {
  void *memory = malloc(bytes);
  if (!memory) exit(1);
  return memory;
}

/* ---- worlds ------------------------------------------------------------------------------------------------------------- */

typedef struct mesh {
  size_t n, m;
  vec3 *vertices;
  uint32_t (*triangles)[3];
} mesh;

static vec3 bumpy(vec3 v) {
  const vec3 u = vec_scale(1.0 / vec_norm(v), v);
  return vec_scale(1.0 + 0.1 * sin(5.0 * u.x) * sin(6.0 * u.y) * cos(7.0 * u.z), u);
}

/* An octahedron's faces cut into k² each and laid on a sphere with bumps: 8 k² triangles. */
static mesh mesh_make(uint32_t k) {
  static const double corner[6][3] = {{1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  mesh made = {.vertices = get(8 * (k + 1) * (k + 1) * sizeof(vec3)),
               .triangles = get(8 * k * k * 3 * sizeof(uint32_t))};
  for (int f = 0; f < 8; f++) {
    const double *a = corner[f % 4], *b = corner[(f + 1) % 4], *c = corner[f < 4 ? 4 : 5];
    const uint32_t first = (uint32_t)made.n;
    for (uint32_t i = 0; i <= k; i++) {
      for (uint32_t j = 0; i + j <= k; j++) {
        const double u = (double)i / k, v = (double)j / k, w = 1.0 - u - v;
        made.vertices[made.n++] =
            bumpy(vec(w * a[0] + u * b[0] + v * c[0], w * a[1] + u * b[1] + v * c[1], w * a[2] + u * b[2] + v * c[2]));
      }
    }
    /* row i begins behind the rows before it, of k + 1, k … points */
    for (uint32_t i = 0; i < k; i++) {
      const uint32_t row = first + i * (k + 1) - i * (i - 1) / 2 * (i > 0), next = row + k + 1 - i;
      for (uint32_t j = 0; i + j < k; j++) {
        const uint32_t one[3] = {row + j, next + j, row + j + 1}, two[3] = {row + j + 1, next + j, next + j + 1};
        memcpy(made.triangles[made.m++], one, sizeof one);
        if (i + j + 1 < k) memcpy(made.triangles[made.m++], two, sizeof two);
      }
    }
  }
  return made;
}

/* Places on the floor, two walls and forty blocks of a room of 10 x 10 x 3 m, with a millimetre's noise. */
static vec3 in_room(rng *r) {
  const size_t where = rng_index(r, 10);
  const double noise = rng_uniform(r, -1e-3, 1e-3);
  if (where < 4) return vec(rng_uniform(r, -5, 5), rng_uniform(r, -5, 5), noise);
  if (where < 5) return vec(-5.0 + noise, rng_uniform(r, -5, 5), rng_uniform(r, 0, 3));
  if (where < 6) return vec(rng_uniform(r, -5, 5), 5.0 + noise, rng_uniform(r, 0, 3));
  const size_t block = rng_index(r, 40);
  const double x = -4.5 + 1.2 * (double)(block % 8), y = -4.0 + 1.8 * (double)(block % 5),
               h = 0.5 + 0.05 * (double)block;
  const double a = rng_uniform(r, -0.25, 0.25), b = rng_uniform(r, -0.25, 0.25), z = rng_uniform(r, 0, h);
  switch (rng_index(r, 5)) {
    case 0: return vec(x - 0.25 + noise, y + b, z);
    case 1: return vec(x + 0.25 + noise, y + b, z);
    case 2: return vec(x + a, y - 0.25 + noise, z);
    case 3: return vec(x + a, y + 0.25 + noise, z);
    default: return vec(x + a, y + b, h + noise);
  }
}

static int by_place(const void *a, const void *b) {
  const vec3 *p = a, *q = b;
  if (p->x != q->x) return p->x < q->x ? -1 : 1;
  if (p->y != q->y) return p->y < q->y ? -1 : 1;
  return (p->z > q->z) - (p->z < q->z);
}

/* The centres of n cells of the room's octree, each once. */
static size_t cells_make(rng *r, size_t n, vec3 *centres) {
  size_t count = 0;
  for (int round = 0; round < 8 && count < n; round++) {
    for (size_t i = count; i < n; i++) {
      const vec3 p = in_room(r);
      centres[i] =
          vec((floor(p.x / CELL) + 0.5) * CELL, (floor(p.y / CELL) + 0.5) * CELL, (floor(p.z / CELL) + 0.5) * CELL);
    }
    qsort(centres, n, sizeof *centres, by_place);
    count = 1;
    for (size_t i = 1; i < n; i++)
      if (by_place(&centres[i], &centres[count - 1]) != 0) centres[count++] = centres[i];
  }
  return count;
}

/* ---- problems ----------------------------------------------------------------------------------------------------------- */

/* A curve, what it is asked against, and what that is to the peer. */
typedef struct problem {
  vec3 points[POINTS];
  cprox_curve *curve;
  cprox_body *ball; /* at the curve's middle, for questions about one point */
  cprox_pose middle;
  double radius;
  cprox_target target;
  const cprox_set *set;
  const cprox_target *targets;
  size_t n_targets;
  const world_peer *peer;
  bool hits;
} problem;

/* Curves of the scale about the origin of a cube of the half width: from a point to another by random ones. */
static void curve_make(rng *r, problem *p, vec3 centre, vec3 half, double scale) {
  p->points[0] = vec_add(
      centre, vec(rng_uniform(r, -half.x, half.x), rng_uniform(r, -half.y, half.y), rng_uniform(r, -half.z, half.z)));
  const vec3 step = vec_scale(scale / 5.0, rng_unit(r));
  for (int k = 1; k < POINTS; k++)
    p->points[k] = vec_add(vec_add(p->points[k - 1], step), rng_in_cube(r, 0.15 * scale));
  if (cprox_curve_create_bezier(p->points, POINTS, 0.0, 1.0, NULL, &p->curve) != CPROX_OK) exit(1);
}

typedef struct asked {
  cprox_workspace *ws;
} asked;

static cprox_mover mover_of(const problem *p) {
  return cprox_tube_along(p->curve, p->radius);
}

static void take(const cprox_result *r, bench_answer *a) {
  *a = (bench_answer){.lower = r->lower, .upper = r->upper, .nodes = r->nodes, .probes = r->probes};
  a->failed = r->status < 0 || r->status == CPROX_BUDGET;
}

/* ---- methods ------------------------------------------------------------------------------------------------------------ */

static cprox_options options_of(double epsilon) {
  cprox_options o = cprox_options_default();
  o.epsilon = epsilon;
  return o;
}

static void our_distance(const void *problems, size_t i, void *state, bench_answer *a) {
  const problem *p = (const problem *)problems + i;
  const cprox_options o = options_of(EPSILON);
  cprox_result r = {.status = CPROX_INVALID};
  cprox_distance(mover_of(p), p->target, &o, ((asked *)state)->ws, &r);
  take(&r, a);
}

static void our_collision(const void *problems, size_t i, void *state, bench_answer *a) {
  const problem *p = (const problem *)problems + i;
  cprox_result r = {.status = CPROX_INVALID};
  cprox_collision(mover_of(p), p->target, NULL, ((asked *)state)->ws, &r);
  take(&r, a);
  a->wrong = (r.verdict == CPROX_YES) != p->hits;
}

static void our_first_contact(const void *problems, size_t i, void *state, bench_answer *a) {
  const problem *p = (const problem *)problems + i;
  const cprox_options o = options_of(CONTACT);
  cprox_result r = {.status = CPROX_INVALID};
  cprox_first_contact(mover_of(p), p->target, &o, ((asked *)state)->ws, &r);
  take(&r, a);
  a->wrong = (r.verdict == CPROX_YES) != p->hits;
}

static void our_ball(const void *problems, size_t i, void *state, bench_answer *a) {
  const problem *p = (const problem *)problems + i;
  cprox_result r = {.status = CPROX_INVALID};
  cprox_pair(cprox_at(p->ball, p->middle), p->target, NULL, ((asked *)state)->ws, &r);
  take(&r, a);
}

static void of_set(const void *problems, size_t i, void *state, bench_answer *a) {
  const problem *p = (const problem *)problems + i;
  const cprox_options o = options_of(EPSILON);
  cprox_result r = {.status = CPROX_INVALID};
  cprox_set_distance(p->set, mover_of(p), &o, ((asked *)state)->ws, &r);
  take(&r, a);
}

static void of_all(const void *problems, size_t i, void *state, bench_answer *a) {
  const problem *p = (const problem *)problems + i;
  const cprox_options o = options_of(EPSILON);
  cprox_result r = {.status = CPROX_INVALID};
  cprox_distance_all(mover_of(p), p->targets, p->n_targets, &o, ((asked *)state)->ws, &r, NULL);
  take(&r, a);
}

#ifdef CPROX_BENCH_FCL
static const char PEER[] = "FCL at 100 points";

static void peer_distance(const void *problems, size_t i, void *state, bench_answer *a) {
  const problem *p = (const problem *)problems + i;
  (void)state;
  a->lower = a->upper = world_peer_distance(p->peer, p->points, POINTS, SAMPLES) - p->radius;
}

static void peer_collision(const void *problems, size_t i, void *state, bench_answer *a) {
  const problem *p = (const problem *)problems + i;
  (void)state;
  *a = (bench_answer){.lower = NAN, .upper = NAN};
  a->wrong = world_peer_collides(p->peer, p->points, POINTS, p->radius, SAMPLES) != p->hits;
}

static void peer_point(const void *problems, size_t i, void *state, bench_answer *a) {
  const problem *p = (const problem *)problems + i;
  (void)state;
  a->lower = a->upper = world_peer_distance(p->peer, p->points, POINTS, 1) - p->radius;
}
#endif

/* ---- workloads ---------------------------------------------------------------------------------------------------------- */

/* Ours and, where there is one, the peer. */
static void measure(const char *name, const char *parameter, const problem *problems, size_t n, const double *truth,
                    const bench_size *size, bench_run ours, bench_run peer, asked *q) {
  if (!bench_wanted(size, name) || n == 0) return;
  const bench_workload w = {.group = "worlds",
                            .name = name,
                            .parameter = parameter,
                            .problems = problems,
                            .n = n,
                            .truth = truth,
                            .doubt = 1e-12};
  bench_method methods[2] = {{"curve_proximity", ours, q}};
  size_t count = 1;
#ifdef CPROX_BENCH_FCL
  if (peer && problems[0].peer) methods[count++] = (bench_method){PEER, peer, q};
#else
  (void)peer;
#endif
  bench_measure(&w, size, methods, count);
}

/* Sorts problems into those that stay clear and those that do not. */
static size_t split(problem *problems, size_t n, bool hits, problem *out) {
  size_t m = 0;
  for (size_t i = 0; i < n; i++)
    if (problems[i].hits == hits) out[m++] = problems[i];
  return m;
}

#ifdef CPROX_BENCH_FCL
#define PEER_OR_NOTHING(f) f
#else
#define PEER_OR_NOTHING(f) NULL
#endif

/* All that is asked of one body. */
static void ask_body(const char *what, const char *parameter, const cprox_body *body, const world_peer *peer, rng *r,
                     vec3 centre, vec3 half, double scale, const bench_size *size, asked *q) {
  const size_t n = size->problems < 60 ? size->problems : 60;
  problem *clear = get(n * sizeof *clear), *balls = get(2 * n * sizeof *balls), *some = get(2 * n * sizeof *some);
  double *truth = get(n * sizeof *truth), *middles = get(n * sizeof *middles);
  const cprox_options fine = options_of(1e-12);
  cprox_body *ball = NULL;
  check(cprox_body_create_sphere(BALL, q->ws, &ball), q->ws);
  size_t found = 0;
  for (int tries = 0; found < n && tries < 100000; tries++) {
    problem p = {.target = cprox_at(body, cprox_pose_identity()), .peer = peer, .ball = ball};
    curve_make(r, &p, centre, half, scale);
    cprox_result result;
    check(cprox_distance(mover_of(&p), p.target, &fine, q->ws, &result), q->ws);
    if (!(result.upper > 1e-2)) {
      cprox_curve_free(p.curve);
      continue;
    }
    p.middle = cprox_pose_identity();
    cprox_curve_evaluate(p.curve, 0.5, NULL, &p.middle.position, NULL, NULL);
    truth[found] = 0.5 * (result.lower + result.upper);
    middles[found] = NAN;
    clear[found++] = p;
  }
  /* tubes: clear or not */
  size_t tubes = 0;
  for (int tries = 0; tubes < 2 * n && tries < 100000; tries++) {
    problem p = {.target = cprox_at(body, cprox_pose_identity()), .peer = peer, .radius = BALL};
    curve_make(r, &p, centre, half, scale);
    cprox_result result;
    check(cprox_collision(mover_of(&p), p.target, NULL, q->ws, &result), q->ws);
    p.hits = result.verdict == CPROX_YES;
    size_t same = 0;
    for (size_t i = 0; i < tubes; i++) same += balls[i].hits == p.hits;
    if (same < n)
      balls[tubes++] = p;
    else
      cprox_curve_free(p.curve);
  }
  char name[64];
  snprintf(name, sizeof name, "%s distance", what);
  measure(name, parameter, clear, found, truth, size, our_distance, PEER_OR_NOTHING(peer_distance), q);
  snprintf(name, sizeof name, "%s ball", what);
  measure(name, parameter, clear, found, NULL, size, our_ball, PEER_OR_NOTHING(peer_point), q);
  for (int hits = 0; hits < 2; hits++) {
    const size_t m = split(balls, tubes, hits == 1, some);
    snprintf(name, sizeof name, "%s collision %s", what, hits ? "hit" : "free");
    measure(name, parameter, some, m, NULL, size, our_collision, PEER_OR_NOTHING(peer_collision), q);
    snprintf(name, sizeof name, "%s first contact %s", what, hits ? "hit" : "free");
    measure(name, parameter, some, m, NULL, size, our_first_contact, NULL, q);
  }
  for (size_t i = 0; i < found; i++) cprox_curve_free(clear[i].curve);
  for (size_t i = 0; i < tubes; i++) cprox_curve_free(balls[i].curve);
  cprox_body_free(ball);
  free(clear), free(balls), free(some), free(truth), free(middles);
}

static double now(void) {
  struct timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void say_build(const char *what, size_t n, double seconds, const cprox_body *body) {
  printf("worlds,build %s,curve_proximity,elements %zu,%.4g,%.4g,%.4g,,,0,0\n", what, n, 1e6 * seconds, 1e6 * seconds,
         (double)cprox_body_bytes(body) / (double)n);
  fflush(stdout);
}

static int by_number(const void *a, const void *b) {
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

static void ask_meshes(const bench_size *size, asked *q) {
  static const uint32_t cuts[] = {13, 51, 101};
  static const char *const names[] = {"triangles 1352", "triangles 20808", "triangles 81608"};
  for (int k = 0; k < 3; k++) {
    mesh m = mesh_make(cuts[k]);
    cprox_body *body = NULL;
    const double start = now();
    check(cprox_body_create_mesh(m.vertices, m.n, (const uint32_t(*)[3])m.triangles, m.m, CPROX_MESH_SURFACE, SIZE_MAX,
                                 q->ws, &body),
          q->ws);
    if (bench_wanted(size, "build mesh")) say_build("mesh", m.m, now() - start, body);
#ifdef CPROX_BENCH_FCL
    world_peer *peer = world_peer_mesh(m.vertices, m.n, (const uint32_t(*)[3])m.triangles, m.m);
#else
    world_peer *peer = NULL;
#endif
    rng r = rng_seed(301);
    ask_body("mesh", names[k], body, peer, &r, vec(0, 0, 0), vec(1.8, 1.8, 1.8), 1.5, size, q);
#ifdef CPROX_BENCH_FCL
    world_peer_free(peer);
#endif
    cprox_body_free(body);
    free(m.vertices), free(m.triangles);
  }
}

static void ask_clouds(const bench_size *size, asked *q) {
  rng r = rng_seed(303);
  vec3 *points = get(CLOUD * sizeof *points), *high = get(CLOUD * sizeof *high);
  for (size_t i = 0; i < CLOUD; i++) points[i] = in_room(&r);
  cprox_body *body = NULL;
  double start = now();
  check(cprox_body_create_points(points, CLOUD, 0.01, SIZE_MAX, q->ws, &body), q->ws);
  if (bench_wanted(size, "build points")) say_build("points", CLOUD, now() - start, body);
  ask_body("points", "points 100000", body, NULL, &r, vec(0, 0, 1.5), vec(4.5, 4.5, 1.2), 2.5, size, q);
  cprox_body_free(body);

  const size_t n = cells_make(&r, CLOUD, points);
  world_peer *peer = NULL;
#ifdef CPROX_BENCH_FCL
  peer = world_peer_octree(points, n, CELL);
#endif
  for (size_t i = 0; i < n; i++) {
    high[i] = vec_add(points[i], vec(0.5 * CELL, 0.5 * CELL, 0.5 * CELL));
    points[i] = vec_sub(points[i], vec(0.5 * CELL, 0.5 * CELL, 0.5 * CELL));
  }
  body = NULL;
  start = now();
  check(cprox_body_create_boxes(points, high, n, SIZE_MAX, q->ws, &body), q->ws);
  if (bench_wanted(size, "build octree")) say_build("octree", n, now() - start, body);
  char name[32];
  snprintf(name, sizeof name, "cells %zu", n);
  ask_body("octree", name, body, peer, &r, vec(0, 0, 1.5), vec(4.5, 4.5, 1.2), 2.5, size, q);
#ifdef CPROX_BENCH_FCL
  world_peer_free(peer);
#endif
  cprox_body_free(body);
  free(points), free(high);
}

/* A million points in a cube, of which those in three of its 64 cells move, with the memory of the body before the last. */
static void ask_updates(const bench_size *size, asked *q) {
  enum { MANY = 1000000, UPDATES = 9 };
  if (!bench_wanted(size, "update points")) return;
  rng r = rng_seed(311);
  vec3 *points = get(MANY * sizeof *points), *places = get(MANY * sizeof *places);
  uint32_t *changed = get(MANY * sizeof *changed);
  for (size_t i = 0; i < MANY; i++) points[i] = rng_in_cube(&r, 5.0);
  cprox_body *body = NULL, *before = NULL;
  const double start = now();
  check(cprox_body_create_points(points, MANY, 0.01, SIZE_MAX, q->ws, &body), q->ws);
  say_build("points", MANY, now() - start, body);
  double best[UPDATES];
  for (int k = 0; k < UPDATES; k++) {
    const double low = -5.0 + 2.5 * (k % 4);
    size_t n = 0;
    for (uint32_t i = 0; i < MANY; i++) {
      if (points[i].x < low || points[i].x > low + 2.5 || points[i].y > -2.5 || points[i].z > 2.5) continue;
      points[i] = vec_add(points[i], rng_in_cube(&r, 0.01));
      changed[n] = i, places[n++] = points[i];
    }
    cprox_body *next = NULL;
    const double begun = now();
    check(cprox_body_update_points(body, changed, places, n, before, q->ws, &next), q->ws);
    best[k] = now() - begun;
    before = body, body = next;
  }
  qsort(best + 1, UPDATES - 1, sizeof *best, by_number); /* the first had no memory to take over */
  printf("worlds,update points,curve_proximity,points %d cells 3 of 64,%.4g,%.4g,,,,0,0\n", MANY,
         1e6 * best[UPDATES / 2], 1e6 * best[UPDATES - 1]);
  cprox_body_free(before);
  cprox_body_free(body);
  free(points), free(places), free(changed);
}

/* Boxes at one density: a curve meets as many, however many there are. */
static void ask_sets(const bench_size *size, asked *q) {
  static const size_t counts[] = {10, 100, 1000, 10000};
  if (!bench_wanted(size, "set distance")) return;
  cprox_body *body = NULL;
  check(cprox_body_create_box(vec(0.2, 0.1, 0.3), q->ws, &body), q->ws);
  for (int k = 0; k < 4; k++) {
    rng r = rng_seed(307);
    const size_t n = counts[k], m = size->problems < 40 ? size->problems : 40;
    const double half = 0.5 * cbrt((double)n);
    cprox_target *targets = get(n * sizeof *targets);
    for (size_t i = 0; i < n; i++) targets[i] = cprox_at(body, rng_pose(&r, half));
    cprox_set *set = NULL;
    check(cprox_set_create(targets, n, q->ws, &set), q->ws);
    problem *problems = get(m * sizeof *problems);
    double *truth = get(m * sizeof *truth);
    for (size_t i = 0; i < m; i++) {
      problems[i] = (problem){.set = set, .targets = targets, .n_targets = n};
      const double inner = 0.5 * half;
      curve_make(&r, &problems[i], vec(0, 0, 0), vec(inner, inner, inner), 1.0);
      cprox_result result;
      const cprox_options fine = options_of(1e-12);
      check(cprox_distance_all(mover_of(&problems[i]), targets, n, &fine, q->ws, &result, NULL), q->ws);
      truth[i] = 0.5 * (result.lower + result.upper);
    }
    char parameter[32];
    snprintf(parameter, sizeof parameter, "targets %zu", n);
    const bench_workload w = {.group = "worlds",
                              .name = "set distance",
                              .parameter = parameter,
                              .problems = problems,
                              .n = m,
                              .truth = truth,
                              .doubt = 1e-12};
    const bench_method methods[2] = {{"curve_proximity", of_set, q}, {"all targets", of_all, q}};
    bench_measure(&w, size, methods, 2);
    for (size_t i = 0; i < m; i++) cprox_curve_free(problems[i].curve);
    cprox_set_free(set);
    free(targets), free(problems), free(truth);
  }
  cprox_body_free(body);
}

int main(int argc, char **argv) {
  const bench_size size = bench_arguments(argc, argv);
  asked q = {.ws = cprox_workspace_create()};
  if (!q.ws) return 1;
  ask_sets(&size, &q);
  ask_meshes(&size, &q);
  ask_clouds(&size, &q);
  ask_updates(&size, &q);
  cprox_workspace_free(q.ws);
  return 0;
}
