/* SPDX-License-Identifier: BSD-3-Clause */
/* What a user would pick instead: points and curves against Bézier curves and B-splines by OpenCASCADE and SISL, a ball along a path
 * past a convex body by FCL at 100 points, its first contact by Bullet on 100 chords; each where it is installed. unsound counts
 * wrong answers: distances off by more than WRONG (but for samples, which claim nothing: their error tells), contacts missed or invented. References: long double for points and Bézier curves,
 * our interval of width 1e-12 elsewhere, which the soundness campaigns hold. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "peers/curve_peers.h"
#include "support/measure.h"
#include "support/problems.h"

enum { MOST_SPLINE_POINTS = 23, PATH_POINTS = 101, PATH_DEGREE = 5, MOST_METHODS = 4 };
static const double WRONG = 1e-6, BALL = 0.05, EPSILON = 1e-6;

static const curve_peer *const curve_peers[] = {
#ifdef CPROX_BENCH_OCCT
    &curve_peer_occt,
#endif
#ifdef CPROX_BENCH_SISL
    &curve_peer_sisl,
#endif
    NULL};

typedef struct asked {
  cprox_workspace *workspace;
  double epsilon;
} asked;

static void check(cprox_status status, const cprox_workspace *ws) {
  if (status == CPROX_OK) return;
  fprintf(stderr, "a problem could not be made: %s\n", cprox_workspace_reason(ws));
  exit(1);
}

static void *memory(size_t n, size_t size) {
  void *p = calloc(n + 1, size);
  if (!p) exit(1);
  return p;
}

/* A value that claims to be exact. */
static void judge_value(double value, double truth, bench_answer *a) {
  *a = (bench_answer){.lower = value, .upper = value};
  a->failed = isnan(value);
  a->wrong = !a->failed && fabs(value - truth) > WRONG;
}

static void take(cprox_status status, const cprox_result *r, bench_answer *a) {
  *a = (bench_answer){.lower = r->lower, .upper = r->upper, .nodes = r->nodes, .probes = r->probes};
  a->failed = status != CPROX_OK && status != CPROX_PRECISION;
}

/* ---- points and curves -------------------------------------------------------------------------------------------------------- */

/* One question: two curves, or a curve and a point. */
typedef struct question {
  cprox_mover mover;
  cprox_target target;
  double point[3];
  void *own[2][2]; /* a peer's curves, by the peer's number */
  bool is_point;
  double truth;
} question;

typedef struct peer_state {
  const curve_peer *peer;
  size_t number;
} peer_state;

static void ours(const void *problems, size_t i, void *state, bench_answer *a) {
  const question *p = (const question *)problems + i;
  const asked *q = state;
  cprox_options options = cprox_options_default();
  options.epsilon = q->epsilon;
  cprox_result r;
  take(cprox_distance(p->mover, p->target, &options, q->workspace, &r), &r, a);
}

static void theirs(const void *problems, size_t i, void *state, bench_answer *a) {
  const question *p = (const question *)problems + i;
  const peer_state *s = state;
  void *const *own = p->own[s->number];
  judge_value(p->is_point ? s->peer->to_point(own[0], p->point) : s->peer->to_curve(own[0], own[1]), p->truth, a);
}

static void measure_questions(const bench_size *size, const char *workload, const char *parameter,
                              const question *questions, size_t n, double doubt, asked *q) {
  peer_state states[2];
  bench_method methods[MOST_METHODS] = {{"curve_proximity", ours, q}};
  size_t count = 1;
  for (size_t k = 0; curve_peers[k]; k++) {
    states[k] = (peer_state){curve_peers[k], k};
    methods[count++] = (bench_method){curve_peers[k]->name, theirs, &states[k]};
  }
  double *truth = memory(n, sizeof *truth);
  for (size_t i = 0; i < n; i++) truth[i] = questions[i].truth;
  q->epsilon = 1e-12;
  const bench_workload w = {"peers", workload, parameter, questions, n, truth, doubt};
  bench_measure(&w, size, methods, count);
  free(truth);
}

static void give_peers(question *p, int side, const vec3 *points, size_t n, size_t degree, const double *knots) {
  double plain[PROBLEM_MAX_POINTS][3];
  for (size_t i = 0; i < n; i++) plain[i][0] = points[i].x, plain[i][1] = points[i].y, plain[i][2] = points[i].z;
  for (size_t k = 0; curve_peers[k]; k++)
    p->own[k][side] = curve_peers[k]->make((const double(*)[3])plain, n, degree, knots);
}

static void take_from_peers(question *questions, size_t n) {
  for (size_t i = 0; i < n; i++)
    for (size_t k = 0; curve_peers[k]; k++)
      for (int side = 0; side < 2; side++)
        if (questions[i].own[k][side]) curve_peers[k]->drop(questions[i].own[k][side]);
  free(questions);
}

static void points_and_curves(const bench_size *size, size_t degree, asked *q) {
  const size_t n = size->problems;
  curve_problem *problems = curve_problems_make(OBSTACLE_POINT, degree, n);
  double *truth = curve_problems_truth(problems, n, OBSTACLE_POINT);
  question *questions = memory(n, sizeof *questions);
  for (size_t i = 0; i < n; i++) {
    const vec3 p = problems[i].obstacle.vertex[0];
    questions[i] = (question){.mover = cprox_point_along(problems[i].curve),
                              .target = problems[i].target,
                              .point = {p.x, p.y, p.z},
                              .is_point = true,
                              .truth = truth[i]};
    give_peers(&questions[i], 0, problems[i].points, degree + 1, degree, NULL);
  }
  char parameter[32];
  snprintf(parameter, sizeof parameter, "degree %zu", degree);
  measure_questions(size, "point and curve", parameter, questions, n, 1e-15, q);
  take_from_peers(questions, n);
  free(truth);
  curve_problems_free(problems, n);
}

static void curves_and_curves(const bench_size *size, size_t degree, asked *q) {
  const size_t n = size->problems / 2;
  curve_pair *pairs = curve_pairs_make(degree, false, n);
  double *truth = curve_pairs_truth(pairs, n);
  question *questions = memory(n, sizeof *questions);
  for (size_t i = 0; i < n; i++) {
    questions[i] = (question){.mover = cprox_point_along(pairs[i].curve[0]),
                              .target = cprox_curve_target(pairs[i].curve[1], 0.0),
                              .truth = truth[i]};
    for (int k = 0; k < 2; k++) give_peers(&questions[i], k, pairs[i].points[k], degree + 1, degree, NULL);
  }
  char parameter[32];
  snprintf(parameter, sizeof parameter, "degree %zu", degree);
  measure_questions(size, "curve and curve", parameter, questions, n, 1e-15, q);
  take_from_peers(questions, n);
  free(truth);
  curve_pairs_free(pairs, n);
}

/* Two cubic B-splines of 20 segments in neighbouring cubes. */
static void splines_and_splines(const bench_size *size, asked *q) {
  const size_t n = size->problems / 2;
  question *questions = memory(n, sizeof *questions);
  rng r = rng_seed(77);
  double knots[MOST_SPLINE_POINTS + 4];
  for (size_t i = 0; i < MOST_SPLINE_POINTS + 4; i++) knots[i] = (double)i;
  for (size_t i = 0; i < n; i++) {
    cprox_curve *curve[2] = {NULL, NULL};
    for (int k = 0; k < 2; k++) {
      vec3 points[MOST_SPLINE_POINTS];
      for (size_t j = 0; j < MOST_SPLINE_POINTS; j++) points[j] = vec_add(vec(1.1 * k, 0, 0), rng_in_cube(&r, 0.5));
      check(cprox_curve_create_bspline(points, MOST_SPLINE_POINTS, 3, knots, MOST_SPLINE_POINTS + 4, 3.0,
                                       MOST_SPLINE_POINTS, q->workspace, &curve[k]),
            q->workspace);
      give_peers(&questions[i], k, points, MOST_SPLINE_POINTS, 3, knots);
    }
    questions[i].mover = cprox_point_along(curve[0]);
    questions[i].target = cprox_curve_target(curve[1], 0.0);
    cprox_options options = cprox_options_default();
    options.epsilon = 1e-13;
    cprox_result found;
    cprox_distance(questions[i].mover, questions[i].target, &options, q->workspace, &found);
    questions[i].truth = 0.5 * (found.lower + found.upper);
  }
  measure_questions(size, "curve and curve", "20 segments", questions, n, 1e-12, q);
  for (size_t i = 0; i < n; i++) {
    cprox_curve_free((cprox_curve *)questions[i].mover.curve);
    cprox_curve_free((cprox_curve *)questions[i].target.curve);
  }
  take_from_peers(questions, n);
}

/* ---- paths -------------------------------------------------------------------------------------------------------------------- */

/* A ball along a quintic past a solid. */
typedef struct path {
  cprox_curve *curve;
  cprox_body *body;
  cprox_target target;
  double points[PATH_POINTS][3]; /* of the curve, at equal steps */
  void *distance, *contact;      /* of the peers */
  double truth;                  /* the distance */
  bool touches;
  double first; /* contact, in steps */
} path;

static void path_distance(const void *problems, size_t i, void *state, bench_answer *a) {
  const path *p = (const path *)problems + i;
  const asked *q = state;
  cprox_options options = cprox_options_default();
  options.epsilon = EPSILON;
  cprox_result r;
  take(cprox_distance(cprox_tube_along(p->curve, BALL), p->target, &options, q->workspace, &r), &r, a);
}

static void path_contact(const void *problems, size_t i, void *state, bench_answer *a) {
  const path *p = (const path *)problems + i;
  const asked *q = state;
  cprox_options options = cprox_options_default();
  options.epsilon = EPSILON;
  cprox_result r;
  take(cprox_first_contact(cprox_tube_along(p->curve, BALL), p->target, &options, q->workspace, &r), &r, a);
  a->wrong = (r.verdict == CPROX_YES) != p->touches;
  a->lower = a->upper = p->touches ? r.t_free * (PATH_POINTS - 1) : -1.0;
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
  check(cprox_curve_create_bezier(control, PATH_DEGREE + 1, 0.0, 1.0, ws, &p->curve), ws);
  check(solid_body(&s, ws, &p->body), ws);
  p->target = cprox_at(p->body, (cprox_pose){{s.position[0], s.position[1], s.position[2]},
                                             {s.quaternion[0], s.quaternion[1], s.quaternion[2], s.quaternion[3]}});
  for (int i = 0; i < PATH_POINTS; i++) {
    cprox_vec3 at;
    cprox_curve_evaluate(p->curve, (double)i / (PATH_POINTS - 1), ws, &at, NULL, NULL);
    p->points[i][0] = at.x, p->points[i][1] = at.y, p->points[i][2] = at.z;
  }
  cprox_options options = cprox_options_default();
  options.epsilon = 1e-12;
  cprox_result found;
  cprox_distance(cprox_tube_along(p->curve, BALL), p->target, &options, ws, &found);
  p->truth = 0.5 * (found.lower + found.upper);
  p->touches = found.upper <= 0.0;
  cprox_first_contact(cprox_tube_along(p->curve, BALL), p->target, &options, ws, &found);
  p->first = p->touches ? found.t_free * (PATH_POINTS - 1) : -1.0;
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

static void measure_paths(const bench_size *size, bool touching, solid_kind kind, asked *q) {
  static const char *const names[] = {"sphere", "box", "capsule", "cylinder", "cone"};
  const size_t n = size->problems / 2;
  path *paths = memory(n, sizeof *paths);
  double *truth = memory(n, sizeof *truth);
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
  const bench_workload w = {"peers", touching ? "first contact" : "path distance", names[kind], paths, n, truth, 2e-12};
  bench_measure(&w, size, methods, count);
  free(truth);
  free_paths(paths, n);
}

int main(int argc, char **argv) {
  const bench_size size = bench_arguments(argc, argv);
  asked q = {.workspace = cprox_workspace_create()};
  if (!q.workspace) return 1;
  if (!curve_peers[0]) fputs("peers: neither OpenCASCADE nor SISL is installed, both are left out\n", stderr);
  static const size_t degrees[] = {3, 5, 10, 20};
  for (size_t k = 0; k < 4 && bench_wanted(&size, "point and curve"); k++) points_and_curves(&size, degrees[k], &q);
  for (size_t k = 1; k < 3 && bench_wanted(&size, "curve and curve"); k++) curves_and_curves(&size, degrees[k], &q);
  if (bench_wanted(&size, "curve and curve")) splines_and_splines(&size, &q);
  for (int kind = 0; kind < SOLID_KINDS; kind++) {
    if (bench_wanted(&size, "path distance")) measure_paths(&size, false, (solid_kind)kind, &q);
    if (bench_wanted(&size, "first contact")) measure_paths(&size, true, (solid_kind)kind, &q);
  }
  cprox_workspace_free(q.workspace);
  return 0;
}
