/* SPDX-License-Identifier: BSD-3-Clause */
/* The seven MotionBenchMaker trajectories that MoveIt was measured on: the certified minimum, of hulls and of meshes,
 * to the scene and to the robot itself, beside the boolean check of states that a planner makes, at MoveIt's usual
 * step; and that check by ourselves. MoveIt's own figures, measured by themselves with moveit_core 1.1.16 and FCL,
 * stand beside them for reference: they are not of this process. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "curve_proximity/cprox.h"
#include "kinematics/motion.h"
#include "peers/robot_states.h"
#include "peers/two_ended.h"
#include "solve/list.h"
#include "support/measure.h"

/* MoveIt's longest valid segment: this fraction of the joint space's extent, which is the sum of the Panda's seven
 * ranges [rad]. */
static const double SEGMENT_FRACTION = 0.01, PANDA_EXTENT = 33.476;

/* MoveIt's boolean check of the trajectory at that step [ms]. */
static const struct {
  const char *scene;
  double milliseconds;
} MOVEIT[] = {{"panda_bookshelf_small_0001_rrt", 0.57},
              {"panda_bookshelf_tall_0001_rrt", 1.1},
              {"panda_bookshelf_thin_0001_rrt", 2.6},
              {"panda_box_0001_rrt", 1.6},
              {"panda_cage_0001_rrt", 3.5},
              {"panda_table_pick_0001_rrt", 0.45},
              {"panda_table_under_pick_0001_rrt", 0.62}};

enum { SCENES = sizeof MOVEIT / sizeof MOVEIT[0] };

typedef struct problem {
  robot_case c;
  robot_fcl *fcl;
  cprox_obstacles *set;
  size_t states;
  double truth;
} problem;

typedef struct method_state {
  cprox_workspace *workspace;
  bool meshes;
} method_state;

/* ---- ours ---- */

static void ours(const void *problems, size_t i, void *state, bench_answer *answer) {
  const problem *p = (const problem *)problems + i;
  const method_state *s = state;
  const cprox_motion *motion = s->meshes ? p->c.mesh_motion : p->c.motion;
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.epsilon = 1e-3;
  cprox_result scene, self;
  const cprox_status a = list_distance(cprox_robot_along(motion, NULL, 0), p->c.targets, p->c.n_targets, &options,
                                       s->workspace, &scene, NULL);
  const cprox_status b = list_distance(cprox_robot_self(motion, p->c.self_pairs, p->c.n_self_pairs), NULL, 0, &options,
                                       s->workspace, &self, NULL);
  *answer = (bench_answer){.lower = scene.lower,
                           .upper = scene.upper,
                           .nodes = scene.nodes + self.nodes,
                           .distance_queries = scene.distance_queries + self.distance_queries,
                           .failed = a < 0 || b < 0};
}

/* ---- states by FCL ---- */

/* As many states as MoveIt checks on a path of that length. */
static size_t states_of(const robot_case *c) {
  double before[CASE_MAX_VARIABLES], after[CASE_MAX_VARIABLES], length = 0.0;
  const cprox_motion_info info = cprox_motion_get_info(c->motion);
  const double t0 = info.t0, t1 = info.t1;
  cprox_motion_evaluate(c->motion, t0, before);
  for (int k = 1; k <= 1000; k++) {
    cprox_motion_evaluate(c->motion, t0 + (t1 - t0) * k / 1000, after);
    for (size_t v = 0; v < c->n_variables; v++) length += fabs(after[v] - before[v]), before[v] = after[v];
  }
  return 1 + (size_t)ceil(length / (SEGMENT_FRACTION * PANDA_EXTENT));
}

/* All states, as an edge check must look at those of a path that is clear. */
static void states_by_fcl(const void *problems, size_t i, void *state, bench_answer *answer) {
  (void)state;
  const problem *p = (const problem *)problems + i;
  double values[CASE_MAX_VARIABLES];
  const cprox_motion_info info = cprox_motion_get_info(p->c.motion);
  const double t0 = info.t0, t1 = info.t1;
  bool hit = false;
  for (size_t k = 0; k < p->states; k++) {
    cprox_motion_evaluate(p->c.motion, t0 + (t1 - t0) * (double)k / (double)(p->states - 1), values);
    robot_states_place(p->fcl, &p->c, values);
    hit = robot_fcl_collides(p->fcl) || hit;
  }
  *answer = (bench_answer){.lower = NAN, .upper = NAN, .nodes = (uint32_t)p->states};
  answer->wrong = hit && p->truth > 0.0;
}

/* ---- verdicts of the scene alone ---- */

static void scene_verdict(const void *problems, size_t i, void *state, bench_answer *answer) {
  const problem *p = (const problem *)problems + i;
  const method_state *s = state;
  cprox_result r;
  const cprox_status status =
      cprox_obstacles_collision(p->set, cprox_robot_along(p->c.mesh_motion, NULL, 0), NULL, s->workspace, &r, NULL);
  *answer = (bench_answer){.lower = NAN,
                           .upper = NAN,
                           .nodes = r.nodes,
                           .distance_queries = r.distance_queries,
                           .wrong = r.verdict != CPROX_VERDICT_CLEAR && p->truth > 0.0,
                           .failed = status != CPROX_OK};
}

/* States between which no joint moves farther than .05 rad; these paths are clear, so that all are looked at. */
static void scene_verdict_by_fcl(const void *problems, size_t i, void *state, bench_answer *answer) {
  (void)state;
  const problem *p = (const problem *)problems + i;
  const cprox_motion *motion = p->c.motion;
  double values[CASE_MAX_VARIABLES];
  *answer = (bench_answer){.lower = NAN, .upper = NAN};
  for (size_t segment = 0; segment < motion->n_segments; segment++) {
    const int count = sampled_steps(motion, segment, 0.05);
    for (int k = segment == 0 ? 0 : 1; k <= count; k++) {
      cprox_motion_evaluate(motion, motion_time(motion, segment, (double)k / count), values);
      robot_states_place(p->fcl, &p->c, values);
      answer->wrong = (robot_fcl_hits_world(p->fcl) && p->truth > 0.0) || answer->wrong;
      answer->nodes++;
    }
  }
}

/* ---- states by ourselves ---- */

enum { MOST_STATES = 4096 };

/* The same states, all by one call. */
static void states_by_us(const void *problems, size_t i, void *state, bench_answer *answer) {
  static double values[MOST_STATES * CASE_MAX_VARIABLES];
  static cprox_result results[MOST_STATES];
  const problem *p = (const problem *)problems + i;
  const method_state *s = state;
  const cprox_motion_info info = cprox_motion_get_info(p->c.motion);
  const size_t n = p->states < MOST_STATES ? p->states : MOST_STATES;
  for (size_t k = 0; k < n; k++) {
    const double t = info.t0 + (info.t1 - info.t0) * (double)k / (double)(n - 1);
    cprox_motion_evaluate(p->c.motion, t, values + k * p->c.n_variables);
  }
  const cprox_state_query query = {
      .obstacles = p->set, .self_pairs = p->c.self_pairs, .n_self_pairs = p->c.n_self_pairs};
  const cprox_status status =
      cprox_robot_ask_states(s->meshes ? p->c.mesh_robot : p->c.robot, &query, values, n, s->workspace, results, NULL);
  *answer = (bench_answer){.lower = NAN, .upper = NAN, .nodes = (uint32_t)n, .failed = status < 0};
  bool hit = false;
  for (size_t k = 0; k < n && status >= 0; k++) {
    answer->distance_queries += results[k].distance_queries;
    hit = hit || results[k].verdict != CPROX_VERDICT_CLEAR;
  }
  answer->wrong = hit && p->truth > 0.0;
}

/* ---- the workload ---- */

static bool read_problem(FILE *f, problem *p) {
  if (!robot_case_read(f, BENCH_DATA_DIR "/motion", &p->c)) return false;
  for (size_t k = 0; k < p->c.n_answers; k++)
    if (!p->c.answers[k].self) p->truth = 0.5 * (p->c.answers[k].lower + p->c.answers[k].upper);
  return true;
}

int main(int argc, char **argv) {
  const bench_size size = bench_arguments(argc, argv);
  if (!bench_wanted(&size, "planning") && !bench_wanted(&size, "states") && !bench_wanted(&size, "environment verdict"))
    return 0;
  method_state by_hull = {.workspace = cprox_workspace_create()},
               by_mesh = {.workspace = by_hull.workspace, .meshes = true};
  const bench_method hulls[] = {{"curve_proximity", ours, &by_hull}, {robot_fcl_name(), states_by_fcl, NULL}};
  const bench_method meshes[] = {{"curve_proximity", ours, &by_mesh}, {"by hulls", ours, &by_hull}};
  const bench_method states[] = {{"curve_proximity", states_by_us, &by_mesh},
                                 {"by hulls", states_by_us, &by_hull},
                                 {robot_fcl_name(), states_by_fcl, NULL}};
  const bench_method scenes[] = {{"curve_proximity", scene_verdict, &by_mesh},
                                 {"FCL boolean at .05", scene_verdict_by_fcl, NULL}};
  FILE *f = fopen(BENCH_DATA_DIR "/motion/cases.txt", "r");
  size_t n;
  if (!f || fscanf(f, "%zu", &n) != 1) return 1;
  for (size_t i = 0; i < n; i++) {
    static problem p;
    memset(&p, 0, sizeof p);
    if (!read_problem(f, &p)) return 1;
    for (size_t k = 0; k < SCENES; k++) {
      if (strcmp(p.c.name, MOVEIT[k].scene) != 0) continue;
      p.states = states_of(&p.c);
      p.fcl = robot_states_fcl(&p.c);
      const bench_workload w = {"robots", "planning", p.c.name, &p, 1, &p.truth, 1.1e-6};
      const bench_workload of_meshes = {"robots", "meshes", p.c.name, &p, 1, &p.truth, 1.1e-6};
      bench_measure(&w, &size, hulls, robot_fcl_name() ? 2 : 1);
      bench_measure(&of_meshes, &size, meshes, 2);
      if (cprox_obstacles_create(p.c.targets, p.c.n_targets, CPROX_INDEX_BVH, by_hull.workspace, &p.set) != CPROX_OK)
        return 1;
      const bench_workload of_states = {"robots", "states", p.c.name, &p, 1, NULL, 0.0};
      bench_measure(&of_states, &size, states, robot_fcl_name() ? 3 : 2);
      const bench_workload of_scene = {"robots", "environment verdict", p.c.name, &p, 1, NULL, 0.0};
      bench_measure(&of_scene, &size, scenes, robot_fcl_name() ? 2 : 1);
      cprox_obstacles_free(p.set);
      printf("robots,planning,MoveIt 1.1.16 by itself,%s,%g,%g,%zu,0,,0,0\n", p.c.name, 1e3 * MOVEIT[k].milliseconds,
             1e3 * MOVEIT[k].milliseconds, p.states);
      robot_fcl_free(p.fcl);
    }
    robot_case_free(&p.c);
  }
  fclose(f);
  cprox_workspace_free(by_hull.workspace);
  return 0;
}
