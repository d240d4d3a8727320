/* SPDX-License-Identifier: BSD-3-Clause */
/* Edges read no finer model of a robot or an obstacle than their verdict needs: what lies below a level is taken away,
 * so that any look at it ends the program, and the answers are the same. */
#include <math.h>
#include <string.h>

#include "curve_proximity/cprox.h"
#include "edges/edge_model.h"
#include "support/builders.h"
#include "support/cases.h"
#include "support/random.h"

enum { LINKS = 3, BALLS = 4, STANDING = 2, CORNERS = 12, EDGES = 4000, MOST = LINKS * BALLS };

/* A chain of links, each with balls or a box, among a polytope and a mesh. */
typedef struct world {
  cprox_body *made[MOST + STANDING];
  cprox_obstacle targets[STANDING];
  cprox_robot *robot;
  cprox_obstacles *set;
  cprox_edge_checker *checker;
  size_t n;
} world;

static void make(rng *r, bool by_balls, world *w) {
  cprox_link links[LINKS];
  cprox_link_geometry geometries[MOST];
  w->n = 0;
  for (size_t i = 0; i < LINKS; i++) {
    links[i] = (cprox_link){.parent = (int32_t)i - 1,
                            .type = CPROX_JOINT_REVOLUTE,
                            .axis = rng_unit(r),
                            .origin = CPROX_POSE_IDENTITY,
                            .variable = (int32_t)i,
                            .multiplier = 1.0};
    links[i].origin.position = vec(0.3, 0, 0);
    for (size_t k = 0; k < (by_balls ? BALLS : 1); k++, w->n++) {
      const vec3 at = vec(0.3 * rng_uniform(r, 0, 1), 0, 0);
      if (by_balls)
        assert_int_equal(cprox_body_create_sphere(rng_uniform(r, 0.02, 0.06), ws, &w->made[w->n]), CPROX_OK);
      else
        assert_int_equal(cprox_body_create_box(vec(0.3, 0.05, 0.08), ws, &w->made[w->n]), CPROX_OK);
      geometries[w->n] = (cprox_link_geometry){.body = w->made[w->n], .link = (int32_t)i, .pose = CPROX_POSE_IDENTITY};
      geometries[w->n].pose.position = at;
    }
  }
  assert_int_equal(cprox_robot_create(links, LINKS, geometries, w->n, LINKS, ws, &w->robot), CPROX_OK);
  for (size_t i = 0; i < STANDING; i++, w->n++) {
    cprox_vec3 corners[CORNERS];
    uint32_t triangles[CORNERS / 3][3];
    for (size_t k = 0; k < CORNERS; k++) corners[k] = rng_in_cube(r, 0.15), triangles[k / 3][k % 3] = (uint32_t)k;
    if (i == 0)
      assert_int_equal(cprox_body_create_polytope(corners, CORNERS, ws, &w->made[w->n]), CPROX_OK);
    else
      assert_int_equal(cprox_body_create_mesh(corners, CORNERS, (const uint32_t(*)[3])triangles, CORNERS / 3,
                                              CPROX_MESH_FILL_SURFACE, SIZE_MAX, ws, &w->made[w->n]),
                       CPROX_OK);
    w->targets[i] = cprox_obstacle_at(w->made[w->n], rng_pose(r, 0.9));
  }
  assert_int_equal(cprox_obstacles_create(w->targets, STANDING, CPROX_INDEX_NONE, ws, &w->set), CPROX_OK);
  const cprox_edge_query asked = {.obstacles = w->set, .without_self = true};
  assert_int_equal(cprox_edge_checker_create(w->robot, &asked, ws, &w->checker), CPROX_OK);
}

static void free_all(world *w) {
  cprox_edge_checker_free(w->checker);
  cprox_obstacles_free(w->set);
  cprox_robot_free(w->robot);
  while (w->n > 0) cprox_body_free(w->made[--w->n]);
}

static cprox_edge_result ask(const world *w, const double *from, const double *to) {
  uint8_t verdict;
  cprox_edge_result result;
  cprox_robot_edges(w->checker, from, to, 1, ws, &verdict, &result);
  return result;
}

/* Nothing may be read there. */
static const struct tree *const NOWHERE = (const struct tree *)8;

/* Asks random edges, and again without what is finer than a level those that this level decided. How many there were.
 */
static size_t asked_again(bool by_balls, cprox_edge_level level, uint64_t seed) {
  rng r = rng_seed(seed);
  size_t n = 0;
  for (size_t i = 0; i < test_cases(EDGES) / 40; i++) {
    world w;
    make(&r, by_balls, &w);
    double from[LINKS], to[LINKS];
    for (size_t times = 0; times < 40; times++) {
      const double turn = rng_log_uniform(&r, 0.01, 1.0);
      for (size_t k = 0; k < LINKS; k++)
        from[k] = rng_uniform(&r, -3, 3), to[k] = from[k] + rng_uniform(&r, -turn, turn);
      const cprox_edge_result whole = ask(&w, from, to);
      if (whole.level != level) continue;
      const struct cprox_edge_checker kept = *w.checker;
      const struct tree *trees[STANDING];
      for (size_t k = 0; k < kept.n_obstacles; k++) {
        trees[k] = kept.obstacles[k].tree;
        if (trees[k] && level == CPROX_EDGE_BALL) w.checker->obstacles[k].tree = NOWHERE;
      }
      if (level == CPROX_EDGE_BALL) w.checker->balls = NULL;
      w.checker->hulls = NULL, w.checker->points = NULL, w.checker->corners = NULL;
      const cprox_edge_result again = ask(&w, from, to);
      *w.checker = kept;
      for (size_t k = 0; k < kept.n_obstacles; k++) w.checker->obstacles[k].tree = trees[k];
      assert_int_equal(again.verdict, whole.verdict);
      assert_int_equal(again.level, whole.level);
      assert_int_equal(again.intervals, whole.intervals);
      assert_int_equal(again.nodes, 0);
      n++;
    }
    free_all(&w);
  }
  return n;
}

CASE(an_edge_that_balls_decide_reads_neither_covers_nor_hulls_nor_triangles) {
  assert_true(asked_again(true, CPROX_EDGE_BALL, 81) > test_cases(EDGES) / 8);
  assert_true(asked_again(false, CPROX_EDGE_BALL, 82) > test_cases(EDGES) / 8);
}

CASE(an_edge_that_covers_decide_reads_neither_hulls_nor_corners) {
  assert_true(asked_again(true, CPROX_EDGE_COVER, 83) > test_cases(EDGES) / 40);
}

int main(void) {
  return cases_run(workspace_setup, workspace_teardown);
}
