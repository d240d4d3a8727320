/* SPDX-License-Identifier: BSD-3-Clause */
/* All that is asked of one body, and FCL beside it where that is installed. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "worlds/worlds.h"

static const double CONTACT = 1e-9, BALL = 0.05;

/* ---- methods ---- */

static void our_distance(const void *problems, size_t i, void *state, bench_answer *a) {
  const worlds_problem *p = (const worlds_problem *)problems + i;
  const cprox_options o = worlds_options(WORLDS_EPSILON);
  cprox_result r = {.status = CPROX_INVALID};
  cprox_distance(worlds_mover(p), p->target, &o, ((worlds_asked *)state)->ws, &r);
  worlds_take(&r, a);
}

static void our_collision(const void *problems, size_t i, void *state, bench_answer *a) {
  const worlds_problem *p = (const worlds_problem *)problems + i;
  cprox_result r = {.status = CPROX_INVALID};
  cprox_collision(worlds_mover(p), p->target, NULL, ((worlds_asked *)state)->ws, &r);
  worlds_take(&r, a);
  a->wrong = (r.verdict == CPROX_VERDICT_VIOLATED) != p->hits;
}

static void our_time_of_contact(const void *problems, size_t i, void *state, bench_answer *a) {
  const worlds_problem *p = (const worlds_problem *)problems + i;
  const cprox_options o = worlds_options(CONTACT);
  cprox_result r = {.status = CPROX_INVALID};
  cprox_time_of_contact(worlds_mover(p), p->target, &o, ((worlds_asked *)state)->ws, &r);
  worlds_take(&r, a);
  a->wrong = (r.verdict == CPROX_VERDICT_VIOLATED) != p->hits;
}

static void our_ball(const void *problems, size_t i, void *state, bench_answer *a) {
  const worlds_problem *p = (const worlds_problem *)problems + i;
  cprox_result r = {.status = CPROX_INVALID};
  cprox_pair(cprox_obstacle_at(p->ball, p->middle), p->target, NULL, ((worlds_asked *)state)->ws, &r);
  worlds_take(&r, a);
}

#ifdef CPROX_BENCH_FCL
static void peer_distance(const void *problems, size_t i, void *state, bench_answer *a) {
  const worlds_problem *p = (const worlds_problem *)problems + i;
  (void)state;
  a->lower = a->upper = world_peer_distance(p->peer, p->points, WORLDS_POINTS, WORLDS_SAMPLES) - p->radius;
}

static void peer_collision(const void *problems, size_t i, void *state, bench_answer *a) {
  const worlds_problem *p = (const worlds_problem *)problems + i;
  (void)state;
  *a = (bench_answer){.lower = NAN, .upper = NAN};
  a->wrong = world_peer_collides(p->peer, p->points, WORLDS_POINTS, p->radius, WORLDS_SAMPLES) != p->hits;
}

static void peer_ball(const void *problems, size_t i, void *state, bench_answer *a) {
  const worlds_problem *p = (const worlds_problem *)problems + i;
  (void)state;
  a->lower = a->upper = world_peer_ball(p->peer, p->middle.position, BALL);
}

/* What a user who knows FCL would write: a point's distance, less the radius. */
static void peer_point(const void *problems, size_t i, void *state, bench_answer *a) {
  const worlds_problem *p = (const worlds_problem *)problems + i;
  (void)state;
  a->lower = a->upper = world_peer_distance(p->peer, &p->middle.position, 1, 1) - BALL;
}

static const bench_method DISTANCE = {.name = "FCL at 100 points", .run = peer_distance};
static const bench_method COLLISION = {.name = "FCL at 100 points", .run = peer_collision};
static const bench_method BALLS[] = {{.name = "FCL", .run = peer_ball},
                                     {.name = "FCL point less radius", .run = peer_point}};
static const size_t N_PEERS = 1, N_BALLS = 2;
#else
static const bench_method DISTANCE, COLLISION, BALLS[1];
static const size_t N_PEERS = 0, N_BALLS = 0;
#endif

/* ---- workloads ---- */

/* Some problems of one scene. */
typedef struct some {
  const worlds_scene *scene;
  const bench_size *size;
  worlds_asked *q;
  worlds_problem *problems;
  const double *truth;
  size_t n;
} some;

/* Ours and, where there are any, the peers. */
static void measure(const some *s, const char *query, bench_run ours, const bench_method *peers, size_t n_peers) {
  char name[64];
  snprintf(name, sizeof name, "%s %s", s->scene->what, query);
  if (!bench_wanted(s->size, name) || s->n == 0) return;
  const bench_workload w = {.group = "worlds",
                            .name = name,
                            .parameter = s->scene->parameter,
                            .problems = s->problems,
                            .n = s->n,
                            .truth = s->truth,
                            .doubt = 1e-12};
  bench_method methods[4] = {{"curve_proximity", ours, s->q}};
  size_t count = 1;
  for (size_t i = 0; i < n_peers && s->scene->peer; i++) methods[count++] = peers[i];
  bench_measure(&w, s->size, methods, count);
}

/* Curves that stay clear, with their distances. */
static size_t make_clear(const worlds_scene *scene, rng *r, worlds_asked *q, size_t n, worlds_problem *clear,
                         double *truth) {
  const cprox_options fine = worlds_options(1e-12);
  size_t found = 0;
  for (int tries = 0; found < n && tries < 100000; tries++) {
    worlds_problem p = {.target = cprox_obstacle_at(scene->body, CPROX_POSE_IDENTITY), .peer = scene->peer};
    worlds_curve_make(r, &p, scene->centre, scene->half, scene->scale);
    cprox_result result;
    worlds_check(cprox_distance(worlds_mover(&p), p.target, &fine, q->ws, &result), q->ws);
    if (!(result.upper > 1e-2)) {
      cprox_curve_free(p.curve);
      continue;
    }
    p.middle = CPROX_POSE_IDENTITY;
    cprox_curve_evaluate(p.curve, 0.5, NULL, &p.middle.position, NULL, NULL);
    truth[found] = 0.5 * (result.lower + result.upper);
    clear[found++] = p;
  }
  return found;
}

/* Those whose middle has room for a ball. */
static size_t choose_balls(const worlds_problem *clear, size_t n, const cprox_body *ball, worlds_asked *q,
                           worlds_problem *balls, double *truth) {
  size_t found = 0;
  for (size_t i = 0; i < n; i++) {
    worlds_problem p = clear[i];
    p.ball = (cprox_body *)ball;
    cprox_result result;
    worlds_check(cprox_pair(cprox_obstacle_at(ball, p.middle), p.target, NULL, q->ws, &result), q->ws);
    if (!(result.lower > 1e-3)) continue;
    truth[found] = 0.5 * (result.lower + result.upper);
    balls[found++] = p;
  }
  return found;
}

/* Tubes, n that are clear and n that are not. */
static size_t make_tubes(const worlds_scene *scene, rng *r, worlds_asked *q, size_t n, worlds_problem *tubes) {
  size_t found = 0;
  for (int tries = 0; found < 2 * n && tries < 100000; tries++) {
    worlds_problem p = {
        .target = cprox_obstacle_at(scene->body, CPROX_POSE_IDENTITY), .peer = scene->peer, .radius = BALL};
    worlds_curve_make(r, &p, scene->centre, scene->half, scene->scale);
    cprox_result result;
    worlds_check(cprox_collision(worlds_mover(&p), p.target, NULL, q->ws, &result), q->ws);
    p.hits = result.verdict == CPROX_VERDICT_VIOLATED;
    size_t same = 0;
    for (size_t i = 0; i < found; i++) same += tubes[i].hits == p.hits;
    if (same < n)
      tubes[found++] = p;
    else
      cprox_curve_free(p.curve);
  }
  return found;
}

void worlds_ask_body(const worlds_scene *scene, rng *r, const bench_size *size, worlds_asked *q) {
  const size_t n = size->problems < 60 ? size->problems : 60;
  worlds_problem *clear = worlds_get(n * sizeof *clear), *tubes = worlds_get(2 * n * sizeof *tubes),
                 *chosen = worlds_get(2 * n * sizeof *chosen);
  double *truth = worlds_get(n * sizeof *truth);
  cprox_body *ball = NULL;
  worlds_check(cprox_body_create_sphere(BALL, q->ws, &ball), q->ws);
  const size_t n_clear = make_clear(scene, r, q, n, clear, truth), n_tubes = make_tubes(scene, r, q, n, tubes);

  some s = {.scene = scene, .size = size, .q = q, .problems = clear, .truth = truth, .n = n_clear};
  measure(&s, "distance", our_distance, &DISTANCE, N_PEERS);
  s.problems = chosen;
  s.n = choose_balls(clear, n_clear, ball, q, chosen, truth);
  measure(&s, "ball", our_ball, BALLS, N_BALLS);
  s.truth = NULL;
  for (int hits = 0; hits < 2; hits++) {
    s.n = 0;
    for (size_t i = 0; i < n_tubes; i++)
      if (tubes[i].hits == (hits == 1)) chosen[s.n++] = tubes[i];
    measure(&s, hits ? "collision hit" : "collision free", our_collision, &COLLISION, N_PEERS);
    measure(&s, hits ? "time of contact hit" : "time of contact free", our_time_of_contact, NULL, 0);
  }

  for (size_t i = 0; i < n_clear; i++) cprox_curve_free(clear[i].curve);
  for (size_t i = 0; i < n_tubes; i++) cprox_curve_free(tubes[i].curve);
  cprox_body_free(ball);
  free(clear), free(tubes), free(chosen), free(truth);
}
