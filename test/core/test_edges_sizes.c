/* SPDX-License-Identifier: BSD-3-Clause */
/* Edges of robots from one link to 300, and of calls from one edge to a million: verdicts against a planar chain in
 * long double, memory by its allocations. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "curve_proximity/cprox.h"
#include "support/builders.h"
#include "support/cases.h"
#include "support/counting.h"
#include "support/random.h"

enum { MOST_LINKS = 300, STANDING = 4, SAMPLES = 32 };

static const double LENGTH = 0.05, RADIUS = 0.015;

/* A chain in a plane: all axes along z, links of one length, a ball in the middle of each. */
typedef struct chain {
  cprox_body *ball, *post;
  cprox_obstacle targets[STANDING];
  double post_radius;
  cprox_robot *robot;
  cprox_obstacles *set;
  size_t n;
} chain;

static void make(rng *r, size_t n, double least, double most, chain *c) {
  static cprox_link links[MOST_LINKS];
  static cprox_link_geometry geometries[MOST_LINKS];
  c->n = n, c->post_radius = 0.02 * (double)n * LENGTH;
  assert_int_equal(cprox_body_create_sphere(RADIUS, ws, &c->ball), CPROX_OK);
  assert_int_equal(cprox_body_create_sphere(c->post_radius, ws, &c->post), CPROX_OK);
  for (size_t i = 0; i < n; i++) {
    links[i] = (cprox_link){.parent = (int32_t)i - 1,
                            .type = CPROX_JOINT_REVOLUTE,
                            .axis = vec(0, 0, 1),
                            .origin = CPROX_POSE_IDENTITY,
                            .variable = (int32_t)i,
                            .multiplier = 1.0};
    links[i].origin.position = vec(i > 0 ? LENGTH : 0.0, 0, 0);
    geometries[i] = (cprox_link_geometry){.body = c->ball, .pose = CPROX_POSE_IDENTITY, .link = (int32_t)i};
    geometries[i].pose.position = vec(0.5 * LENGTH, 0, 0);
  }
  assert_int_equal(cprox_robot_create(links, n, geometries, n, n, ws, &c->robot), CPROX_OK);
  for (int k = 0; k < STANDING; k++) {
    const double angle = rng_uniform(r, -3.0, 3.0), far = (double)n * LENGTH * rng_uniform(r, least, most);
    cprox_pose at = CPROX_POSE_IDENTITY;
    at.position = vec(far * cos(angle), far * sin(angle), 0);
    c->targets[k] = cprox_obstacle_at(c->post, at);
  }
  assert_int_equal(cprox_obstacles_create(c->targets, STANDING, CPROX_INDEX_NONE, ws, &c->set), CPROX_OK);
}

static void free_chain(chain *c) {
  cprox_obstacles_free(c->set);
  cprox_robot_free(c->robot);
  cprox_body_free(c->ball);
  cprox_body_free(c->post);
}

/* The least distance at one time, of all balls and posts, and of balls with at least one between them. */
static double distance_at(const chain *c, const double *from, const double *to, double t) {
  static long double x[MOST_LINKS], y[MOST_LINKS];
  long double angle = 0, px = 0, py = 0, least = INFINITY;
  for (size_t i = 0; i < c->n; i++) {
    angle += (long double)from[i] + (long double)t * ((long double)to[i] - (long double)from[i]);
    const long double dx = (long double)LENGTH * cosl(angle), dy = (long double)LENGTH * sinl(angle);
    x[i] = px + dx / 2, y[i] = py + dy / 2, px += dx, py += dy;
    for (int k = 0; k < STANDING; k++)
      least = fminl(least, hypotl(x[i] - (long double)c->targets[k].pose.position.x,
                                  y[i] - (long double)c->targets[k].pose.position.y) -
                               (long double)(RADIUS + c->post_radius));
    for (size_t k = 0; k + 1 < i; k++)
      least =
          fminl(least, sqrtl((x[i] - x[k]) * (x[i] - x[k]) + (y[i] - y[k]) * (y[i] - y[k])) - 2 * (long double)RADIUS);
  }
  return (double)least;
}

/* 24 edges of each chain of 1, 2, 10, 64 and 300 links (seed 431), obstacles and itself: no verdict is wrong by 33
 * samples, violated is said where contact is, and lanes look at all. */
CASE(chains_of_1_to_300_links_are_judged_rightly) {
  static const size_t LINKS[] = {1, 2, 10, 64, MOST_LINKS};
  rng r = rng_seed(431);
  for (size_t l = 0; l < sizeof LINKS / sizeof *LINKS; l++) {
    size_t counts[3] = {0}, asked = 0;
    const double bent = 3.0 / sqrt((double)LINKS[l]); /* [rad] */
    while (asked < 4 || asked < test_cases(24)) {
      chain c;
      make(&r, LINKS[l], 0.2, 1.1, &c);
      const cprox_edge_query q = {.obstacles = c.set};
      cprox_edge_checker *checker = NULL;
      assert_int_equal(cprox_edge_checker_create(c.robot, &q, ws, &checker), CPROX_OK);
      for (int k = 0; k < 4; k++, asked++) {
        double from[MOST_LINKS], to[MOST_LINKS];
        for (size_t i = 0; i < c.n; i++) {
          from[i] = rng_uniform(&r, -0.3, 0.3) * bent;
          to[i] = from[i] + rng_uniform(&r, -0.1, 0.1) * bent;
        }
        uint8_t verdict;
        cprox_edge_result v;
        assert_true(cprox_robot_edges(checker, from, to, 1, ws, &verdict, &v) >= 0);
        counts[verdict]++;
        assert_true(v.intervals > 0 && v.intervals < 4096);
        for (int s = 0; s <= SAMPLES && verdict == CPROX_VERDICT_CLEAR; s++)
          assert_true(distance_at(&c, from, to, (double)s / SAMPLES) > -1e-9);
        if (verdict == CPROX_VERDICT_VIOLATED) assert_true(distance_at(&c, from, to, v.t) < 1e-9);
      }
      cprox_edge_checker_free(checker);
      free_chain(&c);
    }
    print_message("%zu links: %zu clear, %zu violated of %zu\n", LINKS[l], counts[CPROX_VERDICT_CLEAR],
                  counts[CPROX_VERDICT_VIOLATED], asked);
    assert_int_equal(counts[CPROX_VERDICT_UNDECIDED], 0);
    assert_true(counts[CPROX_VERDICT_CLEAR] > 0);
  }
}

/* A million edges in one call (seed 432): no more memory than one takes, and the verdicts that each has alone. One row
 * that is not finite, and one beyond single precision, change no other. */
CASE(a_million_edges_take_the_memory_of_one) {
  rng r = rng_seed(432);
  chain c;
  make(&r, 3, 1.3, 2.0, &c);
  const size_t n = test_cases(1000000), odd = n / 2;
  const cprox_edge_query q = {.obstacles = c.set};
  cprox_edge_checker *checker = NULL;
  assert_int_equal(cprox_edge_checker_create(c.robot, &q, ws, &checker), CPROX_OK);
  double *from = malloc(3 * n * sizeof *from), *to = malloc(3 * n * sizeof *to);
  uint8_t *verdicts = malloc(n);
  assert_true(from && to && verdicts && n > 100);
  for (size_t i = 0; i < 3 * n; i++) from[i] = rng_uniform(&r, -0.8, 0.8), to[i] = from[i] + rng_uniform(&r, -0.4, 0.4);
  to[3 * odd] = NAN, to[3 * odd + 4] = 1e7;
  uint8_t one;
  assert_true(cprox_robot_edges(checker, from, to, 1, ws, &one, NULL) >= 0);
  const size_t before = allocations_made();
  assert_true(cprox_robot_edges(checker, from, to, odd, ws, verdicts, NULL) >= 0);
  assert_true(allocations_made() == before);
  assert_int_equal(cprox_robot_edges(checker, from, to, n, ws, verdicts, NULL), CPROX_INVALID);
  assert_int_equal(verdicts[odd], CPROX_VERDICT_UNDECIDED);
  size_t counts[3] = {0};
  for (size_t i = 0; i < n; i++) {
    counts[verdicts[i]]++;
    if (i == odd || (i % 997 != 0 && (i + 8 < odd || i > odd + 8))) continue;
    assert_true(cprox_robot_edges(checker, from + 3 * i, to + 3 * i, 1, ws, &one, NULL) >= 0);
    assert_int_equal(one, verdicts[i]);
  }
  assert_true(counts[CPROX_VERDICT_CLEAR] > n / 2 && counts[CPROX_VERDICT_UNDECIDED] <= 2);
  free(from), free(to), free(verdicts);
  cprox_edge_checker_free(checker);
  free_chain(&c);
}

/* A robot has at least one link; one with nothing on it is clear, and nothing was asked. */
CASE(a_robot_without_geometries_is_clear) {
  const cprox_link link = {.type = CPROX_JOINT_FIXED, .parent = -1, .origin = CPROX_POSE_IDENTITY, .variable = -1};
  cprox_robot *robot = NULL;
  assert_int_equal(cprox_robot_create(&link, 0, NULL, 0, 0, ws, &robot), CPROX_INVALID);
  assert_int_equal(cprox_robot_create(&link, 1, NULL, 0, 0, ws, &robot), CPROX_OK);
  cprox_edge_checker *checker = NULL;
  assert_int_equal(cprox_edge_checker_create(robot, NULL, ws, &checker), CPROX_OK);
  const double none = 0.0;
  uint8_t verdict = CPROX_VERDICT_UNDECIDED;
  cprox_edge_result v;
  assert_int_equal(cprox_robot_edges(checker, &none, &none, 1, ws, &verdict, &v), CPROX_OK);
  assert_int_equal(verdict, CPROX_VERDICT_CLEAR);
  assert_true(v.t_free == 1.0);
  cprox_edge_checker_free(checker);
  cprox_robot_free(robot);
}

int main(void) {
  return cases_run(workspace_setup, workspace_teardown);
}
