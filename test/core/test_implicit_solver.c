/* SPDX-License-Identifier: BSD-3-Clause */
/* The interior point method by itself: random places of the paper's pairs, each answered to 1e-8 with a certificate
 * (CPROX_TEST_SCALE=100: a million a pair), starts from a former answer, many constraints. */
#include <math.h>
#include <stdlib.h>

#include "base/frame.h"
#include "curve_proximity/cprox.h"
#include "implicit/implicit.h"
#include "shape/body.h"
#include "support/cases.h"
#include "support/implicits.h"
#include "support/random.h"

typedef struct two {
  cprox_body *a, *b;
  void *memory;
} two;

static two two_create(int first, int second) {
  implicit_case c;
  two t;
  implicit_case_paper(first, &c);
  t.a = implicit_case_body(&c, NULL);
  implicit_case_paper(second, &c);
  t.b = implicit_case_body(&c, NULL);
  t.memory = malloc(implicit_memory(t.a->shape.implicit, t.b->shape.implicit));
  return t;
}

static void two_free(two *t) {
  cprox_body_free(t->a);
  cprox_body_free(t->b);
  free(t->memory);
}

/* b posed in a's frame, both about their centres. */
static implicit_query ask(const two *t, const cprox_pose *pose) {
  const frame f = frame_create(pose, vec(0, 0, 0));
  implicit_query q = {.a = t->a->shape.implicit, .b = t->b->shape.implicit};
  for (int i = 0; i < 9; i++) q.m[i] = f.r[i];
  q.t = vec_sub(frame_to_world(&f, t->b->centre), t->a->centre);
  return q;
}

static implicit_goal goal_of(const two *t, double relative, double distance) {
  return (implicit_goal){.epsilon = relative * (t->a->ball_radius + t->b->ball_radius + distance), .max_steps = 2000};
}

static const int PAIRS[8][2] = {{1, 2}, {1, 3}, {2, 3}, {3, 4}, {2, 4}, {3, 5}, {5, 6}, {3, 6}};

/* Seed 11 and the pair's number, 10,000 places at 1 … 8: none is left wider than 1e-8 of distance and sizes, whichever
 * level of detail of the level-of-detail body it takes; the support function search, where there is one, agrees on
 * every tenth. */
CASE(every_random_place_is_certified_to_1e_8) {
  cprox_workspace *workspace = cprox_workspace_create();
  for (int pair = 0; pair < 8; pair++) {
    rng r = rng_seed(11 + (uint64_t)pair);
    two t = two_create(PAIRS[pair][0], PAIRS[pair][1]);
    size_t left = 0, overlaps = 0, later = 0;
    uint64_t steps = 0;
    const size_t n = test_cases(10000);
    for (size_t i = 0; i < n; i++) {
      const cprox_pose pose = implicit_random_pose(&r, 1, 8);
      const implicit_query q = ask(&t, &pose);
      const implicit_goal goal = goal_of(&t, 1e-8, vec_norm(q.t));
      implicit_answer answer;
      implicit_solve(&q, &goal, NULL, t.memory, &answer);
      left += !answer.certified;
      overlaps += answer.overlap;
      later += answer.attempt > 0;
      steps += answer.steps;
      assert_true(answer.overlap || answer.lower <= answer.upper);
      if (i % 10 != 0) continue;
      cprox_result other;
      cprox_options options = CPROX_OPTIONS_DEFAULT;
      options.epsilon = goal.epsilon;
      assert_true(cprox_pair(cprox_obstacle_at(t.a, CPROX_POSE_IDENTITY), cprox_obstacle_at(t.b, pose), &options,
                             workspace, &other) >= 0);
      if (answer.overlap)
        assert_true(other.lower <= 0.0);
      else
        assert_true(answer.lower <= fmax(other.upper, 0.0) && fmax(other.lower, 0.0) <= answer.upper);
    }
    print_message(
        "objects %d and %d: %zu places, %zu overlap, %.1f steps, %zu by a later level of detail, %zu uncertified\n",
        PAIRS[pair][0], PAIRS[pair][1], n, overlaps, (double)steps / (double)n, later, left);
    assert_int_equal(left, 0);
    two_free(&t);
  }
  cprox_workspace_free(workspace);
}

/* Seed 12: a body that moves by steps of 1e-6 … 1: the answer from a former one is the answer from scratch, in fewer
 * steps where the move is small. */
CASE(a_warm_start_answers_what_a_cold_one_does) {
  for (int pair = 0; pair < 8; pair++) {
    rng r = rng_seed(12 + (uint64_t)pair);
    two t = two_create(PAIRS[pair][0], PAIRS[pair][1]);
    uint64_t cold_steps = 0, warm_steps = 0;
    for (size_t i = 0; i < test_cases(50); i++) {
      cprox_pose pose = implicit_random_pose(&r, 2, 5);
      implicit_warm warm = {0};
      for (int k = 0; k < 20; k++) {
        const implicit_query q = ask(&t, &pose);
        const implicit_goal goal = goal_of(&t, 1e-8, vec_norm(q.t));
        implicit_answer cold, answer;
        implicit_solve(&q, &goal, NULL, t.memory, &cold);
        implicit_solve(&q, &goal, &warm, t.memory, &answer);
        assert_true(cold.certified && answer.certified);
        if (!cold.overlap && !answer.overlap)
          assert_true(cold.lower <= answer.upper && answer.lower <= cold.upper);
        else
          assert_true(fmax(cold.lower, answer.lower) <= 0.0);
        const double step = k < 10 ? 1e-3 : rng_log_uniform(&r, 1e-6, 1);
        if (k > 0 && k < 10 && !cold.overlap) {
          cold_steps += cold.steps;
          warm_steps += answer.steps;
        }
        pose.position = vec_axpy(pose.position, step, rng_unit(&r));
        pose.orientation.x += step * rng_uniform(&r, -1, 1);
      }
    }
    assert_true(warm_steps < cold_steps);
    two_free(&t);
  }
}

/* Spheres cut by n planes that touch them: 12 … 500 constraints, still certified, in a number of steps that hardly
 * grows. */
CASE(many_constraints_take_hardly_more_steps) {
  rng r = rng_seed(13);
  uint32_t most = 0;
  for (size_t n = 6; n <= 500; n *= 3) {
    double(*planes)[4] = calloc(n, sizeof *planes);
    for (size_t i = 0; i < n; i++) {
      const vec3 b = rng_unit(&r);
      planes[i][0] = b.x, planes[i][1] = b.y, planes[i][2] = b.z, planes[i][3] = -1;
    }
    const double quadrics[1][10] = {{1, 0, 0, 1, 0, 1, 0, 0, 0, -1.44}};
    const cprox_implicit_description d = {
        .planes = (const double(*)[4])planes, .n_planes = n, .quadrics = quadrics, .n_quadrics = 1};
    two t = {0};
    assert_int_equal(cprox_body_create_implicit(&d, NULL, NULL, &t.a), CPROX_OK);
    assert_int_equal(cprox_body_create_implicit(&d, NULL, NULL, &t.b), CPROX_OK);
    t.memory = malloc(implicit_memory(t.a->shape.implicit, t.b->shape.implicit));
    for (int i = 0; i < 20; i++) {
      const cprox_pose pose = implicit_random_pose(&r, 2.5, 8);
      const implicit_query q = ask(&t, &pose);
      const implicit_goal goal = goal_of(&t, 1e-8, vec_norm(q.t));
      implicit_answer answer;
      implicit_solve(&q, &goal, NULL, t.memory, &answer);
      assert_true(answer.certified);
      most = answer.steps > most ? answer.steps : most;
    }
    two_free(&t);
    free(planes);
  }
  assert_true(most < 60);
}

/* Seed 14: intersections of 2 … 40 superquadrics in general position: certified to 1e-8, their support function to
 * 1e-11 of the size. */
CASE(intersections_of_superquadrics_are_certified) {
  cprox_workspace *workspace = cprox_workspace_create();
  rng r = rng_seed(14);
  for (size_t n = 2; n <= 40; n *= 2) {
    cprox_hyperquadric lists[64];
    static double terms[64][3][5];
    two t = {0};
    for (int side = 0; side < 2; side++) {
      for (size_t i = 0; i < n; i++) {
        const vec3 u = rng_unit(&r);
        vec3 rows[3] = {u};
        implicit_across(u, &rows[1], &rows[2]);
        static const double exponents[3] = {2.5, 1.6, 7.0}, size[3] = {1.0, 3.0, 2.0};
        for (int k = 0; k < 3; k++) {
          double *row = terms[i][k];
          row[0] = rows[k].x / size[k], row[1] = rows[k].y / size[k], row[2] = rows[k].z / size[k];
          row[3] = rng_uniform(&r, -0.2, 0.2), row[4] = exponents[k];
        }
        lists[i] = (cprox_hyperquadric){.terms = (const double(*)[5])terms[i], .n_terms = 3};
      }
      const cprox_implicit_description d = {.hyperquadrics = lists, .n_hyperquadrics = n};
      assert_int_equal(cprox_body_create_implicit(&d, NULL, NULL, side == 0 ? &t.a : &t.b), CPROX_OK);
    }
    t.memory = malloc(implicit_memory(t.a->shape.implicit, t.b->shape.implicit));
    for (int i = 0; i < 20; i++) {
      const cprox_pose pose = implicit_random_pose(&r, 2.5, 8);
      const implicit_query q = ask(&t, &pose);
      const implicit_goal goal = goal_of(&t, 1e-8, vec_norm(q.t));
      implicit_answer answer;
      implicit_solve(&q, &goal, NULL, t.memory, &answer);
      assert_true(answer.certified && answer.attempt == 0);
      const convex *shape = &t.a->shape;
      vec3 at;
      const vec3 d = rng_unit(&r);
      const double h = shape->ops->support(shape, d, NULL, &at);
      assert_true(h - vec_dot(d, at) <= shape->slack);
      cprox_result other;
      assert_true(cprox_pair(cprox_obstacle_at(t.a, CPROX_POSE_IDENTITY), cprox_obstacle_at(t.b, pose), NULL, workspace,
                             &other) >= 0);
      if (!answer.overlap) assert_true(answer.lower <= other.upper && other.lower <= answer.upper);
    }
    two_free(&t);
  }
  cprox_workspace_free(workspace);
}

int main(void) {
  return cases_run(NULL, NULL);
}
