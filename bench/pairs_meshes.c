/* SPDX-License-Identifier: BSD-3-Clause */
/* Two bumpy closed meshes of 960 to 80,088 triangles each, apart, hulls apart too or not, and crossing: their distance
 * and whether they touch, beside FCL and coal. */
#include "pairs_meshes.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "peers/pair_peers.h"
#include "support/problems.h"

enum { BUMPS = 8 };

typedef struct mesh_pair {
  cprox_body *body[2];
  void *copy[2][PAIR_PEERS_MOST];
  cprox_pose pose[2];
} mesh_pair;

/* A ball of radius 0.5 with bumps, n rows of 2n corners. */
static size_t mesh_make(rng *r, uint32_t n, cprox_body **body, void *copy[PAIR_PEERS_MOST]) {
  const uint32_t m = 2 * n, corners = (n - 1) * m + 2;
  const size_t triangles = (size_t)2 * m * (n - 1);
  vec3 *v = calloc(corners, sizeof *v);
  uint32_t(*t)[3] = calloc(triangles, sizeof *t);
  double phase[BUMPS][3];
  if (!v || !t) exit(1);
  for (int k = 0; k < BUMPS; k++)
    for (int j = 0; j < 3; j++) phase[k][j] = rng_uniform(r, 0.0, 6.28);
  for (uint32_t i = 0; i < corners; i++) {
    const uint32_t row = i == 0 ? 0 : i == corners - 1 ? n : 1 + (i - 1) / m, column = i == 0 ? 0 : (i - 1) % m;
    const double polar = 3.141592653589793 * row / n, turn = 6.283185307179586 * column / m;
    const vec3 u = vec(sin(polar) * cos(turn), sin(polar) * sin(turn), cos(polar));
    double radius = 0.5;
    for (int k = 0; k < BUMPS; k++)
      radius +=
          0.04 * sin((3 + k) * u.x + phase[k][0]) * sin((4 + k) * u.y + phase[k][1]) * sin((5 + k) * u.z + phase[k][2]);
    v[i] = vec_scale(radius, u);
  }
  size_t made = 0;
  for (uint32_t j = 0; j < m; j++) {
    const uint32_t next = (j + 1) % m, last = 1 + (n - 2) * m;
    const uint32_t caps[2][3] = {{0, 1 + j, 1 + next}, {corners - 1, last + next, last + j}};
    for (int k = 0; k < 2; k++, made++)
      for (int c = 0; c < 3; c++) t[made][c] = caps[k][c];
    for (uint32_t i = 0; i + 2 < n; i++) {
      const uint32_t a = 1 + i * m + j, b = 1 + i * m + next;
      const uint32_t two[2][3] = {{a, a + m, b + m}, {a, b + m, b}};
      for (int k = 0; k < 2; k++, made++)
        for (int c = 0; c < 3; c++) t[made][c] = two[k][c];
    }
  }
  if (cprox_body_create_mesh(v, corners, (const uint32_t(*)[3])t, made, CPROX_MESH_FILL_SURFACE, SIZE_MAX, NULL, body) <
      0)
    exit(1);
  const pair_peer *peers[PAIR_PEERS_MOST];
  const size_t many = pair_peers(peers);
  for (size_t k = 0; k < many; k++)
    copy[peers[k]->number] = peers[k]->make_mesh(v, corners, (const uint32_t(*)[3])t, made);
  free(v);
  free(t);
  return made;
}

static cprox_obstacle side(const mesh_pair *p, int k) {
  return cprox_obstacle_at(p->body[k], p->pose[k]);
}

static void our_distance(const void *problems, size_t i, void *workspace, bench_answer *a) {
  const mesh_pair *p = (const mesh_pair *)problems + i;
  cprox_result r = {.status = CPROX_INVALID};
  cprox_pair(side(p, 0), side(p, 1), NULL, workspace, &r);
  *a = (bench_answer){
      .lower = NAN, .upper = NAN, .nodes = r.nodes, .distance_queries = r.distance_queries, .failed = r.status < 0};
}

static void our_verdict(const void *problems, size_t i, void *workspace, bench_answer *a) {
  const mesh_pair *p = (const mesh_pair *)problems + i;
  cprox_result r = {.status = CPROX_INVALID};
  cprox_pair_tolerance(side(p, 0), side(p, 1), 0.0, NULL, workspace, &r);
  *a = (bench_answer){.lower = NAN,
                      .upper = NAN,
                      .nodes = r.nodes,
                      .distance_queries = r.distance_queries,
                      .failed = r.verdict == CPROX_VERDICT_UNDECIDED};
}

static void peer_distance(const void *problems, size_t i, void *state, bench_answer *a) {
  const mesh_pair *p = (const mesh_pair *)problems + i;
  const pair_peer *peer = state;
  const size_t k = peer->number;
  *a = (bench_answer){.lower = NAN, .upper = NAN};
  a->failed = isnan(peer->distance(p->copy[0][k], &p->pose[0], p->copy[1][k], &p->pose[1]));
}

static void peer_verdict(const void *problems, size_t i, void *state, bench_answer *a) {
  const mesh_pair *p = (const mesh_pair *)problems + i;
  const pair_peer *peer = state;
  const size_t k = peer->number;
  *a = (bench_answer){.lower = NAN, .upper = NAN};
  a->failed = peer->collides(p->copy[0][k], &p->pose[0], p->copy[1][k], &p->pose[1]) < 0;
}

/* The middles between `least` and `most` apart: of meshes of radius 0.4 to 0.6. */
static void measure(const bench_size *size, const char *name, const char *parameter, double least, double most,
                    mesh_pair *pairs, size_t n, cprox_workspace *workspace) {
  rng r = rng_seed(661);
  for (size_t i = 0; i < n; i++) {
    pairs[i].pose[0] = rng_pose(&r, 0.0);
    pairs[i].pose[1] = rng_pose(&r, 0.0);
    pairs[i].pose[1].position = vec_scale(rng_uniform(&r, least, most), rng_unit(&r));
  }
  char verdict[64];
  snprintf(verdict, sizeof verdict, "verdict %s", name);
  const bench_workload distances = {"pairs", name, parameter, pairs, n, NULL, 0.0};
  const bench_workload verdicts = {"pairs", verdict, parameter, pairs, n, NULL, 0.0};
  const pair_peer *peers[PAIR_PEERS_MOST];
  const size_t many = pair_peers(peers);
  bench_method asked[1 + PAIR_PEERS_MOST] = {{"curve_proximity", our_distance, workspace}},
                         told[1 + PAIR_PEERS_MOST] = {{"curve_proximity", our_verdict, workspace}};
  for (size_t k = 0; k < many; k++) {
    asked[1 + k] = (bench_method){peers[k]->name, peer_distance, (void *)peers[k]};
    told[1 + k] = (bench_method){peers[k]->name, peer_verdict, (void *)peers[k]};
  }
  bench_measure(&distances, size, asked, 1 + many);
  bench_measure(&verdicts, size, told, 1 + many);
}

void pairs_meshes(const bench_size *size, cprox_workspace *workspace) {
  static const uint32_t rows[] = {16, 36, 71, 142};
  const size_t n = size->problems;
  const pair_peer *peers[PAIR_PEERS_MOST];
  const size_t many = pair_peers(peers);
  mesh_pair *pairs = calloc(n, sizeof *pairs);
  if (!pairs) exit(1);
  for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
    rng r = rng_seed(660);
    cprox_body *body[2];
    void *copy[2][PAIR_PEERS_MOST] = {{NULL}};
    char parameter[32];
    for (int j = 0; j < 2; j++)
      snprintf(parameter, sizeof parameter, "%zu triangles", mesh_make(&r, rows[k], &body[j], copy[j]));
    for (size_t i = 0; i < n; i++)
      for (int j = 0; j < 2; j++) {
        pairs[i].body[j] = body[j];
        memcpy(pairs[i].copy[j], copy[j], sizeof copy[j]);
      }
    measure(size, "meshes apart", parameter, 1.2, 2.0, pairs, n, workspace);
    measure(size, "meshes close", parameter, 1.0, 1.2, pairs, n, workspace);
    measure(size, "meshes crossing", parameter, 0.7, 1.0, pairs, n, workspace);
    for (int j = 0; j < 2; j++) {
      cprox_body_free(body[j]);
      for (size_t m = 0; m < many; m++) peers[m]->free(copy[j][peers[m]->number]);
    }
  }
  free(pairs);
}
