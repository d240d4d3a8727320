/* SPDX-License-Identifier: BSD-3-Clause */
/* A ball along a quintic past a convex solid: the least distance and the time of contact. unsound counts contacts
 * missed or invented; samples claim nothing, their error tells. References: our intervals of width 1e-12, which the
 * soundness campaigns hold. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "peers/ask.h"
#include "support/make_curve.h"
#include "support/random.h"

enum { PATH_POINTS = 101, PATH_DEGREE = 5 };
static const double BALL = 0.05, EPSILON = 1e-6;

/* A ball along a quintic past a solid. */
typedef struct path {
  cprox_curve *curve;
  cprox_body *body;
  cprox_obstacle target;
  double points[PATH_POINTS][3]; /* of the curve, at equal steps */
  void *distance, *contact;      /* of the peers */
  double truth;                  /* the distance */
  bool touches;
  double first; /* contact, in steps */
} path;

static void path_distance(const void *problems, size_t i, void *state, bench_answer *a) {
  const path *p = (const path *)problems + i;
  const asked *q = state;
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.epsilon = EPSILON;
  cprox_result r;
  ask_take(cprox_distance(cprox_tube_along(p->curve, BALL), p->target, &options, q->workspace, &r), &r, a);
}

static void path_contact(const void *problems, size_t i, void *state, bench_answer *a) {
  const path *p = (const path *)problems + i;
  const asked *q = state;
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.epsilon = EPSILON;
  cprox_result r;
  ask_take(cprox_time_of_contact(cprox_tube_along(p->curve, BALL), p->target, &options, q->workspace, &r), &r, a);
  a->wrong = (r.verdict == CPROX_VERDICT_VIOLATED) != p->touches;
  a->lower = a->upper = p->touches ? r.t_contact_lower * (PATH_POINTS - 1) : -1.0;
}

#ifdef CPROX_BENCH_FCL
static void fcl_distance(const void *problems, size_t i, void *state, bench_answer *a) {
  const path *p = (const path *)problems + i;
  (void)state;
  const double least = path_peer_fcl.answer(p->distance, (const double(*)[3])p->points, PATH_POINTS - 1);
  *a = (bench_answer){.lower = least, .upper = least};
}
#endif

#ifdef CPROX_BENCH_BULLET
static void bullet_contact(const void *problems, size_t i, void *state, bench_answer *a) {
  const path *p = (const path *)problems + i;
  (void)state;
  const double at = path_peer_bullet.answer(p->contact, (const double(*)[3])p->points, PATH_POINTS);
  *a = (bench_answer){.lower = at, .upper = at};
  a->wrong = (at >= 0.0) != p->touches;
  if (a->wrong) a->upper = NAN;
}
#endif

static solid solid_random(rng *r, solid_kind kind) {
  const cprox_pose pose = rng_pose(r, 0.3);
  const solid s = {.kind = kind,
                   .size = {rng_uniform(r, 0.1, 0.4), rng_uniform(r, 0.1, 0.3), rng_uniform(r, 0.1, 0.4)},
                   .position = {pose.position.x, pose.position.y, pose.position.z},
                   .quaternion = {pose.orientation.w, pose.orientation.x, pose.orientation.y, pose.orientation.z}};
  return s;
}

static cprox_status solid_body(const solid *s, cprox_workspace *ws, cprox_body **body) {
  switch (s->kind) {
    case SOLID_SPHERE: return cprox_body_create_sphere(s->size[0], ws, body);
    case SOLID_BOX: return cprox_body_create_box(vec(s->size[0], s->size[1], s->size[2]), ws, body);
    case SOLID_CAPSULE: return cprox_body_create_capsule(s->size[0], s->size[1], ws, body);
    case SOLID_CYLINDER: return cprox_body_create_cylinder(s->size[0], s->size[1], ws, body);
    default: return cprox_body_create_cone(s->size[0], s->size[1], ws, body);
  }
}

static bool make_path(rng *r, solid_kind kind, bool touching, cprox_workspace *ws, path *p) {
  vec3 control[PATH_DEGREE + 1];
  for (size_t i = 0; i <= PATH_DEGREE; i++) control[i] = rng_in_cube(r, 1.5);
  const solid s = solid_random(r, kind);
  *p = (path){.curve = NULL};
  ask_check(curve_from(describe_bezier(control, PATH_DEGREE + 1, 0.0, 1.0), ws, &p->curve), ws);
  ask_check(solid_body(&s, ws, &p->body), ws);
  p->target =
      cprox_obstacle_at(p->body, (cprox_pose){{s.position[0], s.position[1], s.position[2]},
                                              {s.quaternion[0], s.quaternion[1], s.quaternion[2], s.quaternion[3]}});
  for (int i = 0; i < PATH_POINTS; i++) {
    cprox_vec3 at;
    cprox_curve_evaluate(p->curve, (double)i / (PATH_POINTS - 1), ws, &at, NULL, NULL);
    p->points[i][0] = at.x, p->points[i][1] = at.y, p->points[i][2] = at.z;
  }
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.epsilon = 1e-12;
  cprox_result found;
  cprox_distance(cprox_tube_along(p->curve, BALL), p->target, &options, ws, &found);
  p->truth = 0.5 * (found.lower + found.upper);
  p->touches = found.upper <= 0.0;
  cprox_time_of_contact(cprox_tube_along(p->curve, BALL), p->target, &options, ws, &found);
  p->first = p->touches ? found.t_contact_lower * (PATH_POINTS - 1) : -1.0;
  /* contacts begin outside */
  const bool fits = touching ? p->touches && p->first > 1.0 : p->truth > 1e-3;
  if (fits) {
#ifdef CPROX_BENCH_FCL
    p->distance = path_peer_fcl.make(&s, BALL);
#endif
#ifdef CPROX_BENCH_BULLET
    p->contact = path_peer_bullet.make(&s, BALL);
#endif
    return true;
  }
  cprox_curve_free(p->curve);
  cprox_body_free(p->body);
  return false;
}

static void free_paths(path *paths, size_t n) {
  for (size_t i = 0; i < n; i++) {
    cprox_curve_free(paths[i].curve);
    cprox_body_free(paths[i].body);
#ifdef CPROX_BENCH_FCL
    path_peer_fcl.drop(paths[i].distance);
#endif
#ifdef CPROX_BENCH_BULLET
    path_peer_bullet.drop(paths[i].contact);
#endif
  }
  free(paths);
}

void ask_paths(const bench_size *size, bool touching, solid_kind kind, asked *q) {
  static const char *const names[] = {"sphere", "box", "capsule", "cylinder", "cone"};
  const size_t n = size->problems / 2;
  path *paths = ask_memory(n, sizeof *paths);
  double *truth = ask_memory(n, sizeof *truth);
  rng r = rng_seed(50 + (uint64_t)kind + (touching ? 10 : 0));
  for (size_t i = 0; i < n;) i += make_path(&r, kind, touching, q->workspace, &paths[i]);
  for (size_t i = 0; i < n; i++) truth[i] = touching ? paths[i].first : paths[i].truth;
  bench_method methods[MOST_METHODS] = {{"curve_proximity", touching ? path_contact : path_distance, q}};
  size_t count = 1;
#ifdef CPROX_BENCH_FCL
  if (!touching) methods[count++] = (bench_method){path_peer_fcl.name, fcl_distance, NULL};
#endif
#ifdef CPROX_BENCH_BULLET
  if (touching) methods[count++] = (bench_method){path_peer_bullet.name, bullet_contact, NULL};
#endif
  const bench_workload w = {"peers", touching ? "time of contact" : "path distance", names[kind], paths, n, truth,
                            2e-12};
  bench_measure(&w, size, methods, count);
  free(truth);
  free_paths(paths, n);
}
