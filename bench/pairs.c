/* SPDX-License-Identifier: BSD-3-Clause */
/* Pairs of convex bodies whose distance is known by construction: at one size, and over twelve decades of size and of
 * size ratio, to a relative 1e-9, beside FCL and coal; depths of overlap; whether they touch. A method that says how far it may be off is wrong
 * where its interval misses the distance; FCL and coal, which do not, where they are off by more than a thousandth of the
 * distance and 1e-9 of the sizes. */
#define _POSIX_C_SOURCE 200809L
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "base/frame.h"
#include "pairs_ccd.h"
#include "pairs_meshes.h"
#include "peers/pair_peers.h"
#include "support/measure.h"
#include "support/problems.h"

enum { POLYTOPES = 6, CORNERS = 200, POSES = 100 };

/* A body with its copies in the peers' terms. */
typedef struct convex {
  cprox_body *body;
  double size; /* at least its circumradius */
  void *copy[PAIR_PEERS_MOST];
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
  const pair_peer *peer[PAIR_PEERS_MOST];
  size_t peers;
} asked;

/* ---- bodies and pairs ---- */

static convex polytope_make(rng *r, const asked *q) {
  static obstacle o;
  o = (obstacle){.n = CORNERS};
  for (size_t i = 0; i < o.n; i++) o.vertex[i] = vec_scale(0.5, rng_unit(r));
  obstacle_find_faces(&o);
  convex c = {.size = 0.5, .shared = true};
  if (cprox_body_create_polytope(o.vertex, o.n, NULL, &c.body) != CPROX_OK) exit(1);
  for (size_t k = 0; k < q->peers; k++)
    c.copy[q->peer[k]->number] = q->peer[k]->make_polytope(o.vertex, o.n, (const int(*)[3])o.triangle, o.triangles);
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
  for (size_t k = 0; k < q->peers; k++) c.copy[q->peer[k]->number] = q->peer[k]->make(kind, s);
  return c;
}

static void convex_free(const convex *c, const asked *q) {
  for (size_t k = 0; k < q->peers; k++) q->peer[k]->free(c->copy[q->peer[k]->number]);
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

static void pair_free(const pair *p, const asked *q) {
  if (!p->a.shared) convex_free(&p->a, q);
  if (!p->b.shared) convex_free(&p->b, q);
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

static void peer_verdict(const void *problems, size_t i, void *state, bench_answer *a) {
  const pair *p = (const pair *)problems + i;
  const pair_peer *peer = state;
  const size_t k = peer->number;
  const int touch = peer->collides(p->a.copy[k], &p->at, p->b.copy[k], &p->bt);
  *a = (bench_answer){.lower = NAN, .upper = NAN, .failed = touch < 0};
  a->wrong = touch >= 0 && touch != (p->distance < 0.0);
}

static void peer_distance(const void *problems, size_t i, void *state, bench_answer *a) {
  const pair *p = (const pair *)problems + i;
  const pair_peer *peer = state;
  const size_t k = peer->number;
  const double d = peer->distance(p->a.copy[k], &p->at, p->b.copy[k], &p->bt);
  *a = (bench_answer){.lower = NAN, .upper = NAN, .failed = isnan(d)};
  a->wrong = !a->failed && fabs(d - p->distance) > 1e-3 * p->distance + 1e-9 * p->size;
}

/* ---- the workloads ---- */

/* Ours first, then the peers, each by `run`. How many. */
static size_t methods_of(const asked *q, bench_run our_run, bench_run peer_run,
                         bench_method methods[1 + PAIR_PEERS_MOST]) {
  methods[0] = (bench_method){"curve_proximity", our_run, (void *)q};
  for (size_t k = 0; k < q->peers; k++) methods[1 + k] = (bench_method){q->peer[k]->name, peer_run, (void *)q->peer[k]};
  return 1 + q->peers;
}

static void measure(const bench_size *size, const char *workload, const kinds *k, const pair *pairs, size_t n,
                    asked *q) {
  char parameter[64];
  snprintf(parameter, sizeof parameter, "%s %zu cases", k->name, n);
  const bench_workload w = {"pairs", workload, parameter, pairs, n, NULL, 0.0};
  bench_method methods[1 + PAIR_PEERS_MOST];
  const size_t many = methods_of(q, ours, peer_distance, methods);
  bench_measure(&w, size, methods, pairs[0].distance < 0.0 ? 1 : many);
}

/* Whether they touch, and no more. */
static void measure_verdict(const bench_size *size, const char *apart, const kinds *k, const pair *pairs, asked *q) {
  char workload[96], parameter[64];
  snprintf(workload, sizeof workload, "verdict %s", apart);
  snprintf(parameter, sizeof parameter, "%s %zu cases", k->name, size->problems);
  const bench_workload w = {"pairs", workload, parameter, pairs, size->problems, NULL, 0.0};
  bench_method methods[1 + PAIR_PEERS_MOST];
  const size_t many = methods_of(q, our_verdict, peer_verdict, methods);
  bench_measure(&w, size, methods, many);
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
    for (size_t i = 0; i < many; i++) pair_free(&pairs[i], q);
  }
  free(pairs);
}

/* ---- sequences of poses ---- */

/* Two bodies, one of which moves in small steps. The distances come from searches that begin from scratch. */
typedef struct sequence {
  convex a, b;
  cprox_pose at, bt[POSES];
  double lower[POSES], upper[POSES];
} sequence;

static cprox_result ask_pose(const sequence *s, size_t pose, cprox_pair_start *start, cprox_workspace *workspace) {
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.epsilon = 0.0;
  options.relative_epsilon = 1e-9;
  options.start = start;
  cprox_result r = {.status = CPROX_INVALID};
  cprox_pair(cprox_obstacle_at(s->a.body, s->at), cprox_obstacle_at(s->b.body, s->bt[pose]), &options, workspace, &r);
  return r;
}

/* Each pose is `step` of the size farther along a line away from a, and turned by `step` more. */
static sequence sequence_make(rng *r, const kinds *k, double step, const asked *q) {
  const pair p = pair_make(r, k, 1.0, 1.0, rng_uniform(r, 0.1, 0.5), q);
  sequence s = {.a = p.a, .b = p.b, .at = p.at};
  vec3 way = rng_unit(r);
  if (vec_dot(way, vec_sub(p.at.position, p.bt.position)) > 0.0) way = vec_scale(-1.0, way);
  const vec3 axis = rng_unit(r);
  for (size_t i = 0; i < POSES; i++) {
    const double turn = 0.5 * step * (double)i, c = cos(turn), h = sin(turn);
    const cprox_quat o = p.bt.orientation;
    const vec3 v = vec_scale(h, axis), u = vec(o.x, o.y, o.z);
    const vec3 uv = vec_add(vec_add(vec_scale(c, u), vec_scale(o.w, v)), vec_cross(v, u));
    s.bt[i] = (cprox_pose){vec_axpy(p.bt.position, step * p.size * (double)i, way),
                           {uv.x, uv.y, uv.z, c * o.w - vec_dot(v, u)}};
    const cprox_result found = ask_pose(&s, i, NULL, q->workspace);
    s.lower[i] = found.lower, s.upper[i] = found.upper;
  }
  return s;
}

static void answer_sequence(const sequence *s, cprox_pair_start *start, const asked *q, bench_answer *a) {
  *a = (bench_answer){.lower = NAN, .upper = NAN};
  for (size_t i = 0; i < POSES; i++) {
    const cprox_result r = ask_pose(s, i, start, q->workspace);
    a->nodes += r.nodes;
    a->distance_queries += r.distance_queries;
    a->failed |= r.status < 0;
    a->wrong += r.lower > s->upper[i] || r.upper < s->lower[i];
  }
}

static void ours_followed(const void *problems, size_t i, void *state, bench_answer *a) {
  cprox_pair_start start = {.usable = false};
  answer_sequence((const sequence *)problems + i, &start, state, a);
}

static void ours_from_scratch(const void *problems, size_t i, void *state, bench_answer *a) {
  answer_sequence((const sequence *)problems + i, NULL, state, a);
}

static void judge_sequence(const sequence *s, const double *found, bench_answer *a) {
  *a = (bench_answer){.lower = NAN, .upper = NAN};
  for (size_t i = 0; i < POSES; i++) {
    a->failed |= isnan(found[i]);
    a->wrong += fabs(found[i] - s->upper[i]) > 1e-3 * s->upper[i];
  }
}

static void peer_followed(const void *problems, size_t i, void *state, bench_answer *a) {
  const sequence *s = (const sequence *)problems + i;
  const pair_peer *peer = state;
  double found[POSES];
  peer->follow(s->a.copy[peer->number], &s->at, s->b.copy[peer->number], s->bt, POSES, found);
  judge_sequence(s, found, a);
}

static void peer_from_scratch(const void *problems, size_t i, void *state, bench_answer *a) {
  const sequence *s = (const sequence *)problems + i;
  const pair_peer *peer = state;
  double found[POSES];
  for (size_t j = 0; j < POSES; j++)
    found[j] = peer->distance(s->a.copy[peer->number], &s->at, s->b.copy[peer->number], &s->bt[j]);
  judge_sequence(s, found, a);
}

static void measure_sequences(const bench_size *size, asked *q) {
  static const double steps[] = {1e-4, 1e-3, 1e-2};
  const size_t n = (size->problems + 4) / 5;
  sequence *sequences = calloc(n, sizeof *sequences);
  if (!sequences) exit(1);
  for (size_t k = 0; k < sizeof KINDS / sizeof *KINDS; k++) {
    if (*KINDS[k].prefix && KINDS[k].a != CPROX_BODY_BOX) continue; /* formulas need no start */
    for (size_t j = 0; j < sizeof steps / sizeof *steps; j++) {
      rng r = rng_seed(640);
      for (size_t i = 0; i < n; i++) sequences[i] = sequence_make(&r, &KINDS[k], steps[j], q);
      char parameter[64];
      snprintf(parameter, sizeof parameter, "%s step %g", KINDS[k].name, steps[j]);
      const bench_workload w = {"pairs", "sequence of 100 poses", parameter, sequences, n, NULL, 0.0};
      bench_method methods[2 + 2 * PAIR_PEERS_MOST] = {{"curve_proximity", ours_followed, q},
                                                       {"curve_proximity from scratch", ours_from_scratch, q}};
      size_t many = 2;
      for (size_t m = 0; m < q->peers; m++) {
        methods[many++] = (bench_method){q->peer[m]->name, q->peer[m]->follow ? peer_followed : peer_from_scratch,
                                         (void *)q->peer[m]};
        if (q->peer[m]->follow)
          methods[many++] = (bench_method){"coal from scratch", peer_from_scratch, (void *)q->peer[m]};
      }
      bench_measure(&w, size, methods, many);
      for (size_t i = 0; i < n; i++) pair_free(&(pair){.a = sequences[i].a, .b = sequences[i].b}, q);
    }
  }
  free(sequences);
}

int main(int argc, char **argv) {
  const bench_size size = bench_arguments(argc, argv);
  asked q = {.workspace = cprox_workspace_create()};
  q.peers = pair_peers(q.peer);
  rng r = rng_seed(600);
  for (int i = 0; i < POLYTOPES; i++) q.polytope[i] = polytope_make(&r, &q);
  for (size_t k = 0; k < sizeof KINDS / sizeof *KINDS; k++) one_kind(&size, &KINDS[k], &q);
  if (bench_wanted(&size, "sequence of 100 poses")) measure_sequences(&size, &q);
  if (bench_wanted(&size, "CCD")) pairs_ccd(&size, q.workspace);
  if (bench_wanted(&size, "meshes")) pairs_meshes(&size, q.workspace);
  for (int i = 0; i < POLYTOPES; i++) convex_free(&q.polytope[i], &q);
  cprox_workspace_free(q.workspace);
  return 0;
}
