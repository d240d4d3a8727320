/* SPDX-License-Identifier: BSD-3-Clause */
/* Straight edges of a planner, as RRT-Connect meets them in the scenes of the saved trajectories: certified, beside
 * samples by the same lanes. The Panda by 59 balls; the Panda, a UR5 and a Fanuc by their own meshes under their hulls;
 * each against the scene and itself. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/vec.h"
#include "curve_proximity/cprox.h"
#include "peers/lane_sampling.h"
#include "robots.h"
#include "support/random.h"

enum { EDGES = 4096, MOST_JOINTS = 7, TREE = 128, MOST_WORLDS = 64, MEMORY = 1 << 18, CLOUD = 100000, CLOUDS = 8 };

/* A robot, what it turns [rad], and in whose scenes it stands. */
typedef struct edge_robot {
  const char *parameter, *name, *scenes;
  bool by_meshes;
  int joints;
  double low[MOST_JOINTS], high[MOST_JOINTS];
} edge_robot;

static const edge_robot ROBOTS[] = {{"panda_spheres scene and self",
                                     "panda_spheres",
                                     "panda",
                                     false,
                                     7,
                                     {-2.9671, -1.8326, -2.9671, -3.1416, -2.9671, -0.0873, -2.9671},
                                     {2.9671, 1.8326, 2.9671, 0.0873, 2.9671, 3.8223, 2.9671}},
                                    {"panda meshes scene and self",
                                     "panda",
                                     "panda",
                                     true,
                                     7,
                                     {-2.9671, -1.8326, -2.9671, -3.1416, -2.9671, -0.0873, -2.9671},
                                     {2.9671, 1.8326, 2.9671, 0.0873, 2.9671, 3.8223, 2.9671}},
                                    {"ur5 meshes scene and self",
                                     "ur5",
                                     "panda",
                                     true,
                                     6,
                                     {-3.1416, -3.1416, -3.1416, -3.1416, -3.1416, -3.1416},
                                     {3.1416, 3.1416, 3.1416, 3.1416, 3.1416, 3.1416}},
                                    {"fanuc_m10ia meshes scene and self",
                                     "fanuc_m10ia",
                                     "fanuc_m10ia",
                                     true,
                                     6,
                                     {-2.97, -1.57, -2.8, -3.31, -2.27, -4.71},
                                     {2.97, 2.79, 3.2, 3.31, 2.27, 4.71}}};

/* The longest edge [rad], the share of edges towards the goal, and samples to each radian. */
static const double LONGEST = 2.0, TO_GOAL = 0.2, PER_RADIAN = 32.0;

typedef struct edge_problem {
  const cprox_edge_checker *checker;
  const cprox_edge_checker *cloud; /* of the same scene as points, or NULL */
  const cprox_robot *robot;        /* what that was made of */
  const cprox_obstacles *obstacles;
  const cprox_robot_pair *self_pairs;
  size_t n_self_pairs;
  const edge_robot *moves;
  double from[CASE_MAX_VARIABLES], to[CASE_MAX_VARIABLES];
  bool valid;
} edge_problem;

typedef struct edge_state {
  cprox_workspace *workspace;
  double per_radian;
} edge_state;

static _Alignas(64) char lanes[MEMORY], motion[MEMORY];

static void certified(const void *problems, size_t i, void *state, bench_answer *answer) {
  const edge_problem *p = (const edge_problem *)problems + i;
  const edge_state *s = state;
  uint8_t verdict;
  cprox_edge_result r;
  const cprox_status status = cprox_robot_edges(p->checker, p->from, p->to, 1, s->workspace, &verdict, &r);
  *answer = (bench_answer){.lower = NAN, .upper = NAN, .nodes = r.intervals, .distance_queries = r.nodes};
  answer->failed = status < 0 || verdict == CPROX_VERDICT_UNDECIDED;
  answer->wrong = verdict != (p->valid ? CPROX_VERDICT_CLEAR : CPROX_VERDICT_VIOLATED);
}

static void by_cloud(const void *problems, size_t i, void *state, bench_answer *answer) {
  edge_problem p = ((const edge_problem *)problems)[i];
  p.checker = p.cloud;
  certified(&p, 0, state, answer);
}

static void by_samples(const void *problems, size_t i, void *state, bench_answer *answer) {
  const edge_problem *p = (const edge_problem *)problems + i;
  const edge_state *s = state;
  *answer = (bench_answer){.lower = NAN, .upper = NAN};
  answer->wrong = lane_sampling_hits(p->checker, p->from, p->to, s->per_radian, lanes, motion) == p->valid;
}

/* The same edge as a motion that is made for it, by the query for any motion. */
static void as_motion(const void *problems, size_t i, void *state, bench_answer *answer) {
  const edge_problem *p = (const edge_problem *)problems + i;
  const edge_state *s = state;
  static const int32_t VARIABLES[MOST_JOINTS] = {0, 1, 2, 3, 4, 5, 6};
  const cprox_waypoint ends[2] = {{.time = 0.0, .positions = p->from}, {.time = 1.0, .positions = p->to}};
  const cprox_motion_description edge = {.kind = CPROX_MOTION_WAYPOINTS,
                                         .variables = VARIABLES,
                                         .n_variables = (size_t)p->moves->joints,
                                         .waypoints = ends,
                                         .n_waypoints = 2,
                                         .interpolation = CPROX_INTERPOLATION_LINEAR,
                                         .rest = p->from};
  *answer = (bench_answer){.lower = NAN, .upper = NAN, .failed = true};
  cprox_motion *along = NULL;
  if (cprox_motion_create(p->robot, &edge, s->workspace, &along) < 0) return;
  const cprox_mover mover = cprox_robot_whole(cprox_robot_along(along, NULL, 0), p->self_pairs, p->n_self_pairs);
  cprox_result r = {0};
  const cprox_status status = cprox_obstacles_collision(p->obstacles, mover, NULL, s->workspace, &r, NULL);
  answer->nodes = r.nodes, answer->distance_queries = r.distance_queries;
  answer->failed = status < 0 || r.verdict == CPROX_VERDICT_UNDECIDED;
  answer->wrong = r.verdict != (p->valid ? CPROX_VERDICT_CLEAR : CPROX_VERDICT_VIOLATED);
  cprox_motion_free(along);
}

static double apart2(const double *a, const double *b, int joints) {
  double d = 0.0;
  for (int k = 0; k < joints; k++) d += (a[k] - b[k]) * (a[k] - b[k]);
  return d;
}

static cprox_verdict verdict_of(const cprox_edge_checker *c, const double *from, const double *to,
                                cprox_workspace *ws) {
  uint8_t verdict = CPROX_VERDICT_UNDECIDED;
  cprox_robot_edges(c, from, to, 1, ws, &verdict, NULL);
  return (cprox_verdict)verdict;
}

/* A clear state. False: none was found. */
static bool draw_state(const edge_problem *in, rng *r, double *state, cprox_workspace *ws) {
  for (int tries = 0; tries < 1000; tries++) {
    for (int k = 0; k < in->moves->joints; k++) state[k] = rng_uniform(r, in->moves->low[k], in->moves->high[k]);
    if (verdict_of(in->checker, state, state, ws) == CPROX_VERDICT_CLEAR) return true;
  }
  return false;
}

/* The edges that a tree from a beginning and an end tries. */
static size_t grow(const edge_problem *in, const double ends[2][CASE_MAX_VARIABLES], size_t wanted, rng *r,
                   edge_problem *out, cprox_workspace *ws) {
  const cprox_edge_checker *c = in->checker;
  const int joints = in->moves->joints;
  static double grown[TREE][CASE_MAX_VARIABLES];
  size_t n_grown = 2, n = 0;
  memcpy(grown, ends, 2 * sizeof grown[0]);
  for (size_t tries = 0; tries < 4 * wanted && n < wanted; tries++) {
    edge_problem p = *in;
    double towards[CASE_MAX_VARIABLES];
    const bool to_goal = rng_uniform(r, 0, 1) < TO_GOAL;
    for (int k = 0; k < joints; k++)
      towards[k] = to_goal ? ends[1][k] : rng_uniform(r, in->moves->low[k], in->moves->high[k]);
    size_t nearest = 0;
    double least = INFINITY;
    for (size_t k = 0; k < n_grown; k++) {
      const double d = apart2(grown[k], towards, joints);
      if (d < least && d > 1e-6) least = d, nearest = k;
    }
    if (isinf(least)) continue;
    const double share = fmin(1.0, LONGEST / sqrt(least));
    memcpy(p.from, grown[nearest], sizeof p.from), memcpy(p.to, p.from, sizeof p.to);
    for (int k = 0; k < joints; k++) p.to[k] = p.from[k] + share * (towards[k] - p.from[k]);
    if (verdict_of(c, p.from, p.from, ws) != CPROX_VERDICT_CLEAR) continue;
    const cprox_verdict verdict = verdict_of(c, p.from, p.to, ws);
    if (verdict == CPROX_VERDICT_UNDECIDED) fprintf(stderr, "edges: one is undecided\n");
    p.valid = verdict == CPROX_VERDICT_CLEAR;
    out[n++] = p;
    if (p.valid && n_grown < TREE) memcpy(grown[n_grown++], p.to, sizeof p.to);
  }
  return n;
}

/* How many edges are left to the search (distance queries) of all (nodes), their share (error), and the mean time of
 * all edges. */
static void row_of_levels(const edge_robot *robot, const edge_problem *all, size_t n, bool valid,
                          const bench_size *size, cprox_workspace *ws) {
  const char *name = valid ? "valid edges left to the search" : "invalid edges left to the search";
  if (!bench_wanted(size, name)) return;
  size_t count = 0, searched = 0;
  const double began = bench_thread_seconds();
  for (size_t i = 0; i < n; i++) {
    if (all[i].valid != valid) continue;
    uint8_t verdict;
    cprox_edge_result r;
    cprox_robot_edges(all[i].checker, all[i].from, all[i].to, 1, ws, &verdict, &r);
    count++, searched += r.level == CPROX_EDGE_SEARCH;
  }
  if (count == 0) return;
  const double mean = 1e6 * (bench_thread_seconds() - began) / (double)count;
  printf("robots,%s,curve_proximity,%s,%.4g,nan,%zu,%zu,%.4g,0,0\n", name, robot->parameter, mean, count, searched,
         (double)searched / (double)count);
  fflush(stdout);
}

static void rows(const edge_robot *robot, const edge_problem *all, size_t n, bool valid, const bench_size *size,
                 cprox_workspace *ws) {
  static edge_problem some[EDGES];
  size_t count = 0;
  for (size_t i = 0; i < n; i++)
    if (all[i].valid == valid) some[count++] = all[i];
  edge_state state = {.workspace = ws, .per_radian = PER_RADIAN};
  const bench_method methods[] = {{"curve_proximity", certified, &state},
                                  {"each as a motion", as_motion, &state},
                                  {"the same lanes at 32 a radian", by_samples, &state}};
  const bench_workload w = {"robots", valid ? "valid edges" : "invalid edges", robot->parameter, some, count, NULL,
                            0.0};
  if (count > 0 && bench_wanted(size, w.name))
    bench_measure(&w, size, methods, lane_sampling_exists() && !robot->by_meshes ? 3 : 2);
  row_of_levels(robot, all, n, valid, size, ws);
}

/* ---- clouds ---- */

/* Points of the surfaces of a scene, at random: those nearest to random points beside them. */
static cprox_body *draw_cloud(const robot_case *scene, rng *r, cprox_workspace *ws) {
  static cprox_vec3 points[CLOUD];
  cprox_body *probe = NULL, *cloud = NULL;
  if (cprox_body_create_sphere(1e-6, ws, &probe) != CPROX_OK) return NULL;
  size_t n = 0;
  for (size_t tries = 0; n < CLOUD && tries < 2 * CLOUD; tries++) {
    const cprox_obstacle *o = &scene->targets[rng_index(r, scene->n_targets)];
    const cprox_body_info info = cprox_body_get_info(o->body);
    cprox_pose at = o->pose;
    const double reach = vec_norm(info.centre) + info.radius;
    for (int k = 0; k < 3; k++) (&at.position.x)[k] += rng_uniform(r, -reach, reach);
    cprox_result near;
    if (cprox_pair(cprox_obstacle_at(probe, at), *o, NULL, ws, &near) == CPROX_OK) points[n++] = near.witness_obstacle;
  }
  cprox_body_free(probe);
  return cprox_body_create_points(points, n, 0.0, SIZE_MAX, ws, &cloud) == CPROX_OK ? cloud : NULL;
}

typedef struct edge_cloud {
  cprox_body *points;
  cprox_obstacles *set;
  cprox_edge_checker *checker;
} edge_cloud;

static bool make_cloud(const robot_case *scene, const robot_case *model, edge_cloud *cloud, cprox_workspace *ws) {
  rng r = rng_seed(95);
  *cloud = (edge_cloud){.points = scene->n_targets > 0 ? draw_cloud(scene, &r, ws) : NULL};
  if (!cloud->points) return false;
  const cprox_obstacle stands = cprox_obstacle_at(cloud->points, CPROX_POSE_IDENTITY);
  if (cprox_obstacles_create(&stands, 1, CPROX_INDEX_NONE, ws, &cloud->set) != CPROX_OK) return false;
  const cprox_edge_query asked = {
      .obstacles = cloud->set, .self_pairs = model->self_pairs, .n_self_pairs = model->n_self_pairs};
  return cprox_edge_checker_create(model->robot, &asked, ws, &cloud->checker) == CPROX_OK;
}

static void free_cloud(edge_cloud *cloud) {
  cprox_edge_checker_free(cloud->checker);
  cprox_obstacles_free(cloud->set);
  cprox_body_free(cloud->points);
}

/* Edges that are clear of a scene, which is a cloud of points of it, too. */
static void rows_of_clouds(const edge_robot *robot, const edge_problem *all, size_t n, const bench_size *size,
                           cprox_workspace *ws) {
  static edge_problem some[EDGES];
  size_t count = 0;
  for (size_t i = 0; i < n; i++)
    if (all[i].valid && all[i].cloud) some[count++] = all[i];
  edge_state state = {.workspace = ws};
  const bench_method methods[] = {{"curve_proximity", by_cloud, &state},
                                  {"the same scene as boxes", certified, &state}};
  const bench_workload w = {"robots", "clear edges among a cloud", robot->parameter, some, count, NULL, 0.0};
  if (count > 0 && bench_wanted(size, w.name)) bench_measure(&w, size, methods, 2);
}

/* The beginnings of all edges, each an edge of length 0. They are clear: a tree has them. */
static void rows_of_states(const edge_robot *robot, const edge_problem *all, size_t n, const bench_size *size,
                           cprox_workspace *ws) {
  static edge_problem states[EDGES];
  for (size_t i = 0; i < n; i++) {
    states[i] = all[i], states[i].valid = true;
    memcpy(states[i].to, states[i].from, sizeof states[i].to);
  }
  edge_state state = {.workspace = ws};
  const bench_method methods[] = {{"curve_proximity", certified, &state}};
  const bench_workload w = {"robots", "clear states as edges", robot->parameter, states, n, NULL, 0.0};
  if (n > 0 && bench_wanted(size, w.name)) bench_measure(&w, size, methods, 1);
}

/* Between the ends of a clear edge and of one that is not, which begin at one state, there is an end whose edge grazes
 * something. This one is near it, on either side, and its ends are clear. */
static bool draw_grazing(const edge_problem *clear, const edge_problem *not_clear, rng *r, edge_problem *out,
                         cprox_workspace *ws) {
  double low = 0.0, high = 1.0;
  *out = *clear;
  const double beside = rng_log_uniform(r, 1e-4, 1e-2) * (rng_index(r, 2) ? 1.0 : -1.0);
  for (int step = 0; step <= 20; step++) {
    const double at = step < 20 ? 0.5 * (low + high) : low + beside;
    for (int k = 0; k < out->moves->joints; k++) out->to[k] = clear->to[k] + at * (not_clear->to[k] - clear->to[k]);
    const cprox_verdict verdict = verdict_of(out->checker, out->from, out->to, ws);
    out->valid = verdict == CPROX_VERDICT_CLEAR;
    if (verdict == CPROX_VERDICT_UNDECIDED) return false;
    if (step < 20 && out->valid) low = at;
    if (step < 20 && !out->valid) high = at;
  }
  return verdict_of(out->checker, out->to, out->to, ws) == CPROX_VERDICT_CLEAR;
}

static size_t draw_all_grazing(const edge_problem *all, size_t n, edge_problem *out, cprox_workspace *ws) {
  rng r = rng_seed(96);
  size_t count = 0;
  for (size_t i = 0; i < n; i++)
    for (size_t k = 0; k < i && !all[i].valid; k++)
      if (all[k].valid && all[k].checker == all[i].checker &&
          memcmp(all[k].from, all[i].from, sizeof all[k].from) == 0) {
        for (int times = 0; times < 8 && count < EDGES; times++)
          count += draw_grazing(&all[k], &all[i], &r, &out[count], ws);
        break;
      }
  return count;
}

/* Edges beside samples from coarse to fine: what these cost, and how many edges they pass that hit. */
static void rows_of_samples(const edge_robot *robot, const edge_problem *all, size_t n, const bench_size *size,
                            cprox_workspace *ws) {
  static const char *const NAMES[] = {"4 samples a radian",   "8 samples a radian",  "16 samples a radian",
                                      "32 samples a radian",  "64 samples a radian", "128 samples a radian",
                                      "256 samples a radian", "512 samples a radian"};
  enum { FINENESS = sizeof NAMES / sizeof *NAMES };
  static edge_problem grazing[EDGES];
  if (robot->by_meshes || !lane_sampling_exists()) return;
  edge_state states[FINENESS], own = {.workspace = ws};
  bench_method methods[FINENESS + 1] = {{"curve_proximity", certified, &own}};
  for (int k = 0; k < FINENESS; k++) {
    states[k] = (edge_state){.workspace = ws, .per_radian = (double)(4 << k)};
    methods[k + 1] = (bench_method){NAMES[k], by_samples, &states[k]};
  }
  const bench_workload w = {"robots", "all edges", robot->parameter, all, n, NULL, 0.0};
  if (n > 0 && bench_wanted(size, w.name)) bench_measure(&w, size, methods, FINENESS + 1);
  if (!bench_wanted(size, "grazing edges")) return;
  const size_t count = draw_all_grazing(all, n, grazing, ws);
  const bench_workload near = {"robots", "grazing edges", robot->parameter, grazing, count, NULL, 0.0};
  if (count > 0) bench_measure(&near, size, methods, FINENESS + 1);
}

/* The ends of the motion of a case, if it is one of this robot. */
static bool ends_of(const robot_case *c, const edge_robot *robot, double ends[2][CASE_MAX_VARIABLES]) {
  if (strcmp(c->robot_name, robot->scenes) != 0 || strcmp(robot->name, "ur5") == 0) return false;
  const cprox_motion_info info = cprox_motion_get_info(c->motion);
  for (int k = 0; k < 2; k++) cprox_motion_evaluate(c->motion, k ? info.t1 : info.t0, ends[k]);
  return true;
}

static void bench_robot(const edge_robot *moves, const robot_case *cases, size_t n, const bench_size *size,
                        cprox_workspace *ws) {
  static robot_case model;
  static edge_problem all[EDGES];
  if (!robot_case_read_robot(BENCH_DATA_DIR "/motion", moves->name, &model)) return;
  const cprox_robot *robot = moves->by_meshes ? model.mesh_robot : model.robot;
  cprox_obstacles *sets[MOST_WORLDS];
  cprox_edge_checker *checkers[MOST_WORLDS];
  edge_cloud clouds[CLOUDS];
  size_t n_clouds = 0;
  size_t n_worlds = 0, worlds = 0, n_all = 0;
  for (size_t i = 0; i < n; i++) worlds += strcmp(cases[i].robot_name, moves->scenes) == 0 && worlds < MOST_WORLDS;
  const size_t wanted = worlds > 1 ? EDGES / worlds : EDGES / 8;
  rng r = rng_seed(94);
  for (size_t i = 0; i < n && n_worlds < worlds; i++) {
    if (strcmp(cases[i].robot_name, moves->scenes) != 0) continue;
    if (cprox_obstacles_create(cases[i].targets, cases[i].n_targets, CPROX_INDEX_NONE, ws, &sets[n_worlds]) != CPROX_OK)
      continue;
    const cprox_edge_query asked = {
        .obstacles = sets[n_worlds], .self_pairs = model.self_pairs, .n_self_pairs = model.n_self_pairs};
    if (cprox_edge_checker_create(robot, &asked, ws, &checkers[n_worlds]) != CPROX_OK) {
      cprox_obstacles_free(sets[n_worlds]);
      continue;
    }
    const bool clouded = !moves->by_meshes && n_clouds < CLOUDS && make_cloud(&cases[i], &model, &clouds[n_clouds], ws);
    const edge_problem in = {.checker = checkers[n_worlds],
                             .cloud = clouded ? clouds[n_clouds].checker : NULL,
                             .robot = robot,
                             .obstacles = sets[n_worlds],
                             .self_pairs = model.self_pairs,
                             .n_self_pairs = model.n_self_pairs,
                             .moves = moves};
    n_worlds++, n_clouds += clouded;
    double ends[2][CASE_MAX_VARIABLES] = {{0.0}};
    if (!ends_of(&cases[i], moves, ends) && !(draw_state(&in, &r, ends[0], ws) && draw_state(&in, &r, ends[1], ws)))
      continue;
    n_all += grow(&in, (const double(*)[CASE_MAX_VARIABLES])ends, wanted, &r, all + n_all, ws);
  }
  rows(moves, all, n_all, true, size, ws);
  rows(moves, all, n_all, false, size, ws);
  rows_of_samples(moves, all, n_all, size, ws);
  rows_of_states(moves, all, n_all, size, ws);
  rows_of_clouds(moves, all, n_all, size, ws);
  while (n_clouds > 0) free_cloud(&clouds[--n_clouds]);
  for (size_t i = 0; i < n_worlds; i++) {
    cprox_edge_checker_free(checkers[i]);
    cprox_obstacles_free(sets[i]);
  }
  robot_case_free(&model);
}

void bench_robot_edges(const robot_case *cases, size_t n, const bench_size *size, cprox_workspace *ws) {
  static const char *const ROWS[] = {"valid edges left to the search",
                                     "invalid edges left to the search",
                                     "clear edges among a cloud",
                                     "clear states as edges",
                                     "all edges",
                                     "grazing edges"};
  bool wanted = false;
  for (size_t i = 0; i < sizeof ROWS / sizeof *ROWS; i++) wanted = wanted || bench_wanted(size, ROWS[i]);
  if (!wanted) return;
  for (size_t i = 0; i < sizeof ROBOTS / sizeof *ROBOTS; i++) bench_robot(&ROBOTS[i], cases, n, size, ws);
}
