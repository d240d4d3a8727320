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
#include "robots_edges.h"
#include "shape/body.h"
#include "support/random.h"

enum { TREE = 128, MEMORY = 1 << 18, CLOUD = 100000, CLOUDS = 8 };

#define PANDA_TURNS                                                                    \
  .joints = 7, .low = {-2.9671, -1.8326, -2.9671, -3.1416, -2.9671, -0.0873, -2.9671}, \
  .high = {2.9671, 1.8326, 2.9671, 0.0873, 2.9671, 3.8223, 2.9671}

static const edge_robot ROBOTS[] = {
    {.parameter = "panda_spheres scene and self", .name = "panda_spheres", .scenes = "panda", PANDA_TURNS},
    {.parameter = "panda_spheres among boxes and capsules",
     .name = "panda_spheres",
     .scenes = "panda",
     .beside = true,
     PANDA_TURNS},
    {.parameter = "panda hulls scene and self", .name = "panda", .scenes = "panda", .shapes = BY_HULLS, PANDA_TURNS},
    {.parameter = "panda meshes scene and self", .name = "panda", .scenes = "panda", .shapes = BY_MESHES, PANDA_TURNS},
    {.parameter = "ur5 meshes scene and self",
     .name = "ur5",
     .scenes = "panda",
     .shapes = BY_MESHES,
     .joints = 6,
     .low = {-3.1416, -3.1416, -3.1416, -3.1416, -3.1416, -3.1416},
     .high = {3.1416, 3.1416, 3.1416, 3.1416, 3.1416, 3.1416}},
    {.parameter = "fanuc_m10ia meshes scene and self",
     .name = "fanuc_m10ia",
     .scenes = "fanuc_m10ia",
     .shapes = BY_MESHES,
     .joints = 6,
     .low = {-2.97, -1.57, -2.8, -3.31, -2.27, -4.71},
     .high = {2.97, 2.79, 3.2, 3.31, 2.27, 4.71}},
    {.parameter = "two_ur5s meshes scene and self",
     .name = "ur5",
     .scenes = "panda",
     .shapes = BY_MESHES,
     .two_arms = true,
     .joints = 12,
     .low = {-3.1416, -3.1416, -3.1416, -3.1416, -3.1416, -3.1416, -3.1416, -3.1416, -3.1416, -3.1416, -3.1416,
             -3.1416},
     .high = {3.1416, 3.1416, 3.1416, 3.1416, 3.1416, 3.1416, 3.1416, 3.1416, 3.1416, 3.1416, 3.1416, 3.1416}}};

/* The longest edge [rad], the share of edges towards the goal, and samples to each radian. */
static const double LONGEST = 2.0, TO_GOAL = 0.2, PER_RADIAN = 32.0;

static _Alignas(64) char lanes[MEMORY], motion[MEMORY];

static void by_checker(const cprox_edge_checker *checker, const edge_problem *p, cprox_workspace *ws,
                       bench_answer *answer) {
  uint8_t verdict;
  cprox_edge_result r;
  const cprox_status status = cprox_robot_edges(checker, p->from, p->to, 1, ws, &verdict, &r);
  *answer = (bench_answer){.lower = NAN, .upper = NAN, .nodes = r.intervals, .distance_queries = r.nodes};
  answer->failed = status < 0 || verdict == CPROX_VERDICT_UNDECIDED;
  answer->wrong = verdict != (p->valid ? CPROX_VERDICT_CLEAR : CPROX_VERDICT_VIOLATED);
}

void edge_certified(const void *problems, size_t i, void *state, bench_answer *answer) {
  const edge_problem *p = (const edge_problem *)problems + i;
  by_checker(p->world->checker, p, ((const edge_state *)state)->workspace, answer);
}

static void by_cloud(const void *problems, size_t i, void *state, bench_answer *answer) {
  const edge_problem *p = (const edge_problem *)problems + i;
  by_checker(p->world->cloud, p, ((const edge_state *)state)->workspace, answer);
}

void edge_by_lanes(const void *problems, size_t i, void *state, bench_answer *answer) {
  const edge_problem *p = (const edge_problem *)problems + i;
  const edge_state *s = state;
  *answer = (bench_answer){.lower = NAN, .upper = NAN};
  answer->wrong = lane_sampling_hits(p->world->checker, p->from, p->to, s->per_radian, lanes, motion) == p->valid;
}

/* The same edge as a motion that is made for it, by the query for any motion. */
static void as_motion(const void *problems, size_t i, void *state, bench_answer *answer) {
  const edge_problem *p = (const edge_problem *)problems + i;
  const edge_state *s = state;
  static const int32_t VARIABLES[MOST_JOINTS] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11};
  const cprox_waypoint ends[2] = {{.time = 0.0, .positions = p->from}, {.time = 1.0, .positions = p->to}};
  const cprox_motion_description edge = {.kind = CPROX_MOTION_WAYPOINTS,
                                         .variables = VARIABLES,
                                         .n_variables = (size_t)p->world->moves->joints,
                                         .waypoints = ends,
                                         .n_waypoints = 2,
                                         .interpolation = CPROX_INTERPOLATION_LINEAR,
                                         .rest = p->from};
  *answer = (bench_answer){.lower = NAN, .upper = NAN, .failed = true};
  cprox_motion *along = NULL;
  if (cprox_motion_create(p->world->robot, &edge, s->workspace, &along) < 0) return;
  const robot_case *model = p->world->model;
  const cprox_mover mover =
      cprox_robot_whole(cprox_robot_along(along, NULL, 0), model->self_pairs, model->n_self_pairs);
  cprox_result r = {0};
  const cprox_status status = cprox_obstacles_collision(p->world->obstacles, mover, NULL, s->workspace, &r, NULL);
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
static bool draw_state(const edge_world *in, rng *r, double *state, cprox_workspace *ws) {
  for (int tries = 0; tries < 1000; tries++) {
    for (int k = 0; k < in->moves->joints; k++) state[k] = rng_uniform(r, in->moves->low[k], in->moves->high[k]);
    if (verdict_of(in->checker, state, state, ws) == CPROX_VERDICT_CLEAR) return true;
  }
  return false;
}

/* The edges that a tree from a beginning and an end tries. */
static size_t grow(const edge_world *in, const double ends[2][CASE_MAX_VARIABLES], size_t wanted, rng *r,
                   edge_problem *out, cprox_workspace *ws) {
  const cprox_edge_checker *c = in->checker;
  const int joints = in->moves->joints;
  static double grown[TREE][CASE_MAX_VARIABLES];
  size_t n_grown = 2, n = 0;
  memcpy(grown, ends, 2 * sizeof grown[0]);
  for (size_t tries = 0; tries < 4 * wanted && n < wanted; tries++) {
    edge_problem p = {.world = in};
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
    cprox_robot_edges(all[i].world->checker, all[i].from, all[i].to, 1, ws, &verdict, &r);
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
  bench_method methods[4] = {{"curve_proximity", edge_certified, &state}, {"each as a motion", as_motion, &state}};
  size_t n_methods = 2;
  if (lane_sampling_exists() && robot->shapes == BY_BALLS)
    methods[n_methods++] = (bench_method){"the same lanes at 32 a radian", edge_by_lanes, &state};
  char validator[80];
  snprintf(validator, sizeof validator, "%s at 32 a radian", edge_validator_name() ? edge_validator_name() : "");
  if (count > 0 && some[0].world->validator)
    methods[n_methods++] = (bench_method){validator, edge_by_validator, &state};
  const bench_workload w = {"robots", valid ? "valid edges" : "invalid edges", robot->parameter, some, count, NULL,
                            0.0};
  if (count > 0 && bench_wanted(size, w.name)) bench_measure(&w, size, methods, n_methods);
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
    if (all[i].valid && all[i].world->cloud) some[count++] = all[i];
  edge_state state = {.workspace = ws};
  const bench_method methods[] = {{"curve_proximity", by_cloud, &state},
                                  {"the same scene as boxes", edge_certified, &state}};
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
  const bench_method methods[] = {{"curve_proximity", edge_certified, &state}};
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
    for (int k = 0; k < out->world->moves->joints; k++)
      out->to[k] = clear->to[k] + at * (not_clear->to[k] - clear->to[k]);
    const cprox_verdict verdict = verdict_of(out->world->checker, out->from, out->to, ws);
    out->valid = verdict == CPROX_VERDICT_CLEAR;
    if (verdict == CPROX_VERDICT_UNDECIDED) return false;
    if (step < 20 && out->valid) low = at;
    if (step < 20 && !out->valid) high = at;
  }
  return verdict_of(out->world->checker, out->to, out->to, ws) == CPROX_VERDICT_CLEAR;
}

static size_t draw_all_grazing(const edge_problem *all, size_t n, edge_problem *out, cprox_workspace *ws) {
  rng r = rng_seed(96);
  size_t count = 0;
  for (size_t i = 0; i < n; i++)
    for (size_t k = 0; k < i && !all[i].valid; k++)
      if (all[k].valid && all[k].world == all[i].world &&
          apart2(all[k].from, all[i].from, all[k].world->moves->joints) == 0.0) {
        for (int times = 0; times < 8 && count < EDGES; times++)
          count += draw_grazing(&all[k], &all[i], &r, &out[count], ws);
        break;
      }
  return count;
}

/* All edges, and edges that graze something, beside samples from coarse to fine. */
static void rows_beside(const edge_robot *robot, edge_problem *all, size_t n, const bench_size *size,
                        cprox_workspace *ws) {
  static edge_problem grazing[EDGES];
  if (!robot->beside || n == 0) return;
  if (bench_wanted(size, "all edges")) {
    edge_judge(all, n);
    edge_rows_of_samples(robot, "all edges", all, n, size, ws);
  }
  if (!bench_wanted(size, "grazing edges")) return;
  const size_t count = draw_all_grazing(all, n, grazing, ws);
  edge_judge(grazing, count);
  edge_rows_of_samples(robot, "grazing edges", grazing, count, size, ws);
}

/* The ends of the motion of a case, if it is one of this robot. */
static bool ends_of(const robot_case *c, const edge_robot *robot, double ends[2][CASE_MAX_VARIABLES]) {
  if (strcmp(c->robot_name, robot->scenes) != 0 || strcmp(robot->name, "ur5") == 0) return false;
  const cprox_motion_info info = cprox_motion_get_info(c->motion);
  for (int k = 0; k < 2; k++) cprox_motion_evaluate(c->motion, k ? info.t1 : info.t0, ends[k]);
  return true;
}

/* Two arms beside each other on one base, by their meshes. */
static bool make_two_arms(const robot_case *one, robot_case *two) {
  static const double ASIDE = 0.35;
  cprox_link links[2 * CASE_MAX_LINKS + 1] = {{.parent = -1, .origin = CPROX_POSE_IDENTITY}};
  cprox_link_geometry geometries[2 * CASE_MAX_GEOMETRIES];
  const int32_t n_links = (int32_t)one->n_links, n_geometries = (int32_t)one->n_geometries;
  *two = (robot_case){.n_variables = 2 * one->n_variables, .n_geometries = 2 * one->n_geometries};
  if (two->n_variables > CASE_MAX_VARIABLES || two->n_geometries > CASE_MAX_GEOMETRIES) return false;
  for (int32_t arm = 0; arm < 2; arm++) {
    for (int32_t i = 0; i < n_links; i++) {
      cprox_link *link = &links[1 + arm * n_links + i];
      *link = one->tree[i];
      if (link->parent < 0) link->origin.position.y += arm ? ASIDE : -ASIDE;
      link->parent = link->parent < 0 ? 0 : 1 + arm * n_links + link->parent;
      link->variable += arm * (int32_t)one->n_variables;
    }
    for (int32_t g = 0; g < n_geometries; g++)
      geometries[arm * n_geometries + g] = (cprox_link_geometry){.link = 1 + arm * n_links + one->links[g],
                                                                 .body = one->lods[g] ? one->lods[g] : one->bodies[g],
                                                                 .pose = one->poses[g]};
    for (size_t k = 0; k < one->n_self_pairs; k++)
      two->self_pairs[two->n_self_pairs++] = (cprox_robot_pair){one->self_pairs[k].geometry + arm * n_geometries,
                                                                one->self_pairs[k].other + arm * n_geometries};
  }
  for (int32_t a = 0; a < n_geometries; a++)
    for (int32_t b = 0; b < n_geometries && two->n_self_pairs < CASE_MAX_PAIRS; b++)
      two->self_pairs[two->n_self_pairs++] = (cprox_robot_pair){n_geometries + a, b};
  return cprox_robot_create(links, 2 * one->n_links + 1, geometries, two->n_geometries, two->n_variables, NULL,
                            &two->mesh_robot) == CPROX_OK;
}

/* A robot in the scene of a case. */
static bool make_world(const edge_robot *moves, const robot_case *scene, const robot_case *model, edge_world *world,
                       cprox_workspace *ws) {
  *world = (edge_world){.moves = moves,
                        .model = model,
                        .robot = moves->shapes == BY_MESHES ? model->mesh_robot : model->robot,
                        .n_targets = scene->n_targets};
  memcpy(world->targets, scene->targets, sizeof world->targets);
  for (size_t i = 0; moves->beside && i < world->n_targets; i++) {
    const cprox_body *body = world->targets[i].body;
    if (!body || body->kind != CPROX_BODY_CYLINDER) continue;
    const double *sizes = body->shape.size;
    if (cprox_body_create_capsule(2.0 * sizes[1], sizes[0], ws, &world->made[i]) != CPROX_OK) return false;
    world->targets[i].body = world->made[i];
  }
  if (cprox_obstacles_create(world->targets, world->n_targets, CPROX_INDEX_NONE, ws, &world->obstacles) != CPROX_OK)
    return false;
  const cprox_edge_query asked = {
      .obstacles = world->obstacles, .self_pairs = model->self_pairs, .n_self_pairs = model->n_self_pairs};
  if (cprox_edge_checker_create(world->robot, &asked, ws, &world->checker) != CPROX_OK) return false;
  if (moves->beside) edge_world_ready_peers(world);
  return true;
}

static void free_world(edge_world *world) {
  cprox_edge_checker_free(world->checker);
  cprox_obstacles_free(world->obstacles);
  for (size_t i = 0; i < world->n_targets; i++) cprox_body_free(world->made[i]);
  if (world->fcl) robot_fcl_free(world->fcl);
  edge_validator_free(world->validator);
}

static void bench_robot(const edge_robot *moves, const robot_case *cases, size_t n, const bench_size *size,
                        cprox_workspace *ws) {
  static robot_case arm, arms;
  static edge_problem all[EDGES];
  static edge_world made[MOST_WORLDS];
  if (!robot_case_read_robot(BENCH_DATA_DIR "/motion", moves->name, &arm)) return;
  if (moves->two_arms && !make_two_arms(&arm, &arms)) return;
  const robot_case *model = moves->two_arms ? &arms : &arm;
  edge_cloud clouds[CLOUDS];
  size_t n_clouds = 0;
  size_t n_worlds = 0, worlds = 0, n_all = 0;
  for (size_t i = 0; i < n; i++) worlds += strcmp(cases[i].robot_name, moves->scenes) == 0 && worlds < MOST_WORLDS;
  const size_t wanted = worlds > 1 ? EDGES / worlds : EDGES / 8;
  rng r = rng_seed(94);
  for (size_t i = 0; i < n && n_worlds < worlds; i++) {
    if (strcmp(cases[i].robot_name, moves->scenes) != 0) continue;
    edge_world *world = &made[n_worlds++];
    if (!make_world(moves, &cases[i], model, world, ws)) {
      fprintf(stderr, "edges: %s\n", cprox_workspace_error(ws));
      continue;
    }
    const bool clouded = moves->shapes == BY_BALLS && !moves->beside && n_clouds < CLOUDS &&
                         bench_wanted(size, "clear edges among a cloud") &&
                         make_cloud(&cases[i], model, &clouds[n_clouds], ws);
    if (clouded) world->cloud = clouds[n_clouds++].checker;
    double ends[2][CASE_MAX_VARIABLES] = {{0.0}};
    if (!ends_of(&cases[i], moves, ends) && !(draw_state(world, &r, ends[0], ws) && draw_state(world, &r, ends[1], ws)))
      continue;
    n_all += grow(world, (const double(*)[CASE_MAX_VARIABLES])ends, wanted, &r, all + n_all, ws);
  }
  if (moves->shapes != BY_HULLS) {
    rows(moves, all, n_all, true, size, ws);
    rows(moves, all, n_all, false, size, ws);
  }
  rows_beside(moves, all, n_all, size, ws);
  if (moves->shapes != BY_HULLS && !moves->beside) rows_of_states(moves, all, n_all, size, ws);
  rows_of_clouds(moves, all, n_all, size, ws);
  if (!moves->beside) edge_rows_of_levels(moves, all, n_all, size, ws);
  while (n_clouds > 0) free_cloud(&clouds[--n_clouds]);
  while (n_worlds > 0) free_world(&made[--n_worlds]);
  if (moves->two_arms) cprox_robot_free(arms.mesh_robot);
  robot_case_free(&arm);
}

void bench_robot_edges(const robot_case *cases, size_t n, const bench_size *size, cprox_workspace *ws) {
  static const char *const ROWS[] = {"valid edges left to the search",
                                     "invalid edges left to the search",
                                     "clear edges among a cloud",
                                     "clear states as edges",
                                     "levels of edges",
                                     "all edges",
                                     "grazing edges"};
  bool wanted = false;
  for (size_t i = 0; i < sizeof ROWS / sizeof *ROWS; i++) wanted = wanted || bench_wanted(size, ROWS[i]);
  if (!wanted) return;
  for (size_t i = 0; i < sizeof ROBOTS / sizeof *ROBOTS; i++) bench_robot(&ROBOTS[i], cases, n, size, ws);
}
