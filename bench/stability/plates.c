/* SPDX-License-Identifier: BSD-3-Clause */
/* Collisions that sampling misses: a point or a ball along a quintic through thin plates, and grazes. Each case
 * collides by a witness that none of the methods gave: of 20001 points of the curve one is inside, or the ball at the
 * nearest point is larger than its distance. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/frame.h"
#include "peers/curve_peers.h"
#include "stability/hard.h"
#include "support/make_curve.h"

enum { DEGREE = 5, FINE = 1000, COARSE = 100, WITNESSES = 20000 };
static const double CONTACT = 1e-6;

/* What flies past what; 0: no plate, but a box that the ball grazes by that depth. */
typedef struct kind {
  const char *name;
  double thickness, radius, graze;
} kind;

static const kind KINDS[] = {
    {"plate 1 mm by a point", 1e-3, 1e-6, 0.0},  {"plate 3 mm by a point", 3e-3, 1e-6, 0.0},
    {"plate 10 mm by a point", 1e-2, 1e-6, 0.0}, {"plate 1 mm by a ball of 10 mm", 1e-3, 1e-2, 0.0},
    {"graze of 0.1 mm", 0.0, 0.0, 1e-4},         {"graze of 1 mm", 0.0, 0.0, 1e-3}};

typedef struct pass {
  cprox_curve *curve;
  cprox_body *body;
  cprox_obstacle target;
  double radius;
  double hit; /* a parameter at which it collides */
  double points[FINE + 1][3];
  void *fcl, *bullet;
} pass;

/* ---- the cases ---- */

/* The distance of the curve's point at t to the body. */
static double distance_at(const pass *p, double t) {
  vec3 x;
  cprox_curve_evaluate(p->curve, t, NULL, &x, NULL, NULL);
  double error = 0.0;
  const frame placed = frame_create(&p->target.pose, (vec3){0.0, 0.0, 0.0});
  return cprox_body_nearest(p->body, frame_to_local(&placed, x, &error), NULL);
}

/* Whether it collides, by a witness; for a graze the radius is chosen so. */
static bool collides(const kind *k, cprox_workspace *ws, pass *p) {
  p->radius = k->radius;
  if (k->graze > 0.0) {
    cprox_options options = CPROX_OPTIONS_DEFAULT;
    options.epsilon = 1e-12;
    cprox_result r;
    if (cprox_distance(cprox_point_along(p->curve), p->target, &options, ws, &r) != CPROX_OK || r.lower < 1e-2)
      return false;
    p->radius = r.upper + k->graze, p->hit = r.t;
    return distance_at(p, 0.0) > p->radius && distance_at(p, r.t) <= p->radius;
  }
  if (distance_at(p, 0.0) <= p->radius) return false; /* contacts begin outside */
  for (int i = 1; i <= WITNESSES; i++) {
    p->hit = (double)i / WITNESSES;
    if (distance_at(p, p->hit) <= p->radius) return true;
  }
  return false;
}

static void drop(pass *p) {
  cprox_curve_free(p->curve);
  cprox_body_free(p->body);
#ifdef CPROX_BENCH_FCL
  if (p->fcl) path_peer_fcl.drop(p->fcl);
#endif
#ifdef CPROX_BENCH_BULLET
  if (p->bullet) path_peer_bullet.drop(p->bullet);
#endif
}

static bool draw(rng *r, const kind *k, cprox_workspace *ws, pass *p) {
  *p = (pass){.curve = NULL};
  vec3 control[DEGREE + 1];
  for (int i = 0; i <= DEGREE; i++) control[i] = rng_in_cube(r, 1.0);
  const double size[3] = {rng_uniform(r, 0.4, 1.0), rng_uniform(r, 0.4, 1.0),
                          k->graze > 0.0 ? rng_uniform(r, 0.1, 0.5) : k->thickness};
  const cprox_pose pose = rng_pose(r, 0.3);
  if (curve_from(describe_bezier(control, DEGREE + 1, 0.0, 1.0), ws, &p->curve) != CPROX_OK ||
      cprox_body_create_box(vec(size[0], size[1], size[2]), ws, &p->body) != CPROX_OK)
    exit(1);
  p->target = cprox_obstacle_at(p->body, pose);
  if (!collides(k, ws, p)) {
    drop(p);
    return false;
  }
  for (int i = 0; i <= FINE; i++) {
    vec3 x;
    cprox_curve_evaluate(p->curve, (double)i / FINE, ws, &x, NULL, NULL);
    p->points[i][0] = x.x, p->points[i][1] = x.y, p->points[i][2] = x.z;
  }
  const cprox_quat q = pose.orientation;
  const solid s = {SOLID_BOX,
                   {size[0], size[1], size[2]},
                   {pose.position.x, pose.position.y, pose.position.z},
                   {q.w, q.x, q.y, q.z}};
#ifdef CPROX_BENCH_FCL
  p->fcl = path_peer_fcl.make(&s, p->radius);
#endif
#ifdef CPROX_BENCH_BULLET
  p->bullet = path_peer_bullet.make(&s, p->radius);
#endif
  return true;
}

/* ---- the methods ---- */

static void ours(const void *problems, size_t i, void *state, bench_answer *a) {
  const pass *p = (const pass *)problems + i;
  cprox_result r = {.status = CPROX_INVALID};
  cprox_collision(cprox_tube_along(p->curve, p->radius), p->target, NULL, ((const tools *)state)->workspace, &r);
  *a = (bench_answer){.lower = NAN, .upper = NAN, .nodes = r.nodes, .distance_queries = r.distance_queries};
  a->wrong = r.verdict == CPROX_VERDICT_CLEAR;
  a->failed = r.verdict == CPROX_VERDICT_UNDECIDED;
}

/* Never late, and not early by more than was asked. */
static void our_contact(const void *problems, size_t i, void *state, bench_answer *a) {
  const pass *p = (const pass *)problems + i;
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.epsilon = CONTACT;
  cprox_result r = {.status = CPROX_INVALID};
  cprox_time_of_contact(cprox_tube_along(p->curve, p->radius), p->target, &options, ((const tools *)state)->workspace,
                        &r);
  *a = (bench_answer){.lower = NAN, .upper = NAN, .nodes = r.nodes, .distance_queries = r.distance_queries};
  a->failed = r.status != CPROX_OK;
  a->wrong = !a->failed && (r.verdict != CPROX_VERDICT_VIOLATED || r.t_contact_lower > p->hit ||
                            distance_at(p, r.t_contact_lower) > p->radius + CONTACT + 1e-12);
}

#ifdef CPROX_BENCH_FCL
/* Every tenth of the points, or all. */
static void fcl_at(const pass *p, int samples, bench_answer *a) {
  double points[FINE + 1][3];
  const int step = FINE / samples;
  for (int i = 0; i <= samples; i++)
    for (int k = 0; k < 3; k++) points[i][k] = p->points[i * step][k];
  *a = (bench_answer){.lower = NAN, .upper = NAN, .nodes = (uint32_t)samples};
  a->wrong = path_peer_fcl.answer(p->fcl, (const double(*)[3])points, (size_t)samples + 1) > 0.0;
}

static void fcl_coarse(const void *problems, size_t i, void *state, bench_answer *a) {
  (void)state;
  fcl_at((const pass *)problems + i, COARSE, a);
}

static void fcl_fine(const void *problems, size_t i, void *state, bench_answer *a) {
  (void)state;
  fcl_at((const pass *)problems + i, FINE, a);
}
#endif

#ifdef CPROX_BENCH_BULLET
static void bullet(const void *problems, size_t i, void *state, bench_answer *a) {
  const pass *p = (const pass *)problems + i;
  (void)state;
  double points[COARSE + 1][3];
  for (int k = 0; k <= COARSE; k++)
    for (int c = 0; c < 3; c++) points[k][c] = p->points[k * (FINE / COARSE)][c];
  *a = (bench_answer){.lower = NAN, .upper = NAN, .nodes = COARSE};
  a->wrong = path_peer_bullet.answer(p->bullet, (const double(*)[3])points, COARSE + 1) < 0.0;
}
#endif

void stability_plates(const bench_size *size, uint64_t seed, tools *t) {
  const size_t n = 3 * size->problems;
  pass *problems = calloc(n, sizeof *problems);
  if (!problems) exit(1);
  const bench_method methods[] = {
      {"curve_proximity", ours, t},         {"curve_proximity time of contact", our_contact, t},
#ifdef CPROX_BENCH_FCL
      {"FCL at 100 points", fcl_coarse, t}, {"FCL at 1000 points", fcl_fine, t},
#endif
#ifdef CPROX_BENCH_BULLET
      {"Bullet on 100 chords", bullet, t},
#endif
  };
  for (size_t k = 0; k < sizeof KINDS / sizeof *KINDS; k++) {
    if (!bench_wanted(size, KINDS[k].name)) continue;
    rng r = rng_seed(seed + k);
    for (size_t i = 0; i < n;) i += draw(&r, &KINDS[k], t->workspace, &problems[i]);
    char parameter[48];
    snprintf(parameter, sizeof parameter, "%zu cases seed %llu", n, (unsigned long long)(seed + k));
    const bench_workload w = {
        .group = "stability", .name = KINDS[k].name, .parameter = parameter, .problems = problems, .n = n};
    bench_measure(&w, size, methods, sizeof methods / sizeof *methods);
    for (size_t i = 0; i < n; i++) drop(&problems[i]);
  }
  free(problems);
}
