/* SPDX-License-Identifier: BSD-3-Clause */
#include "implicit_growth.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "curve_proximity/cprox.h"
#include "peers/cone_growth.h"
#include "support/random.h"

/* Of randomised smoothing: poses beside, and how far they are [m, rad]. */
enum { JITTERS = 16 };
static const double JITTER = 0.02;

typedef struct growth_problem {
  cprox_obstacle a, b;
  const cone_body *cone[2];   /* NULL: the body is no cone's */
  cprox_pose beside[JITTERS]; /* of b */
} growth_problem;

static void by_gradient(const void *problems, size_t i, void *state, bench_answer *a) {
  const growth_problem *p = (const growth_problem *)problems + i;
  cprox_growth growth;
  cprox_growth_derivatives d;
  const cprox_status status = cprox_growth_gradient(p->a, p->b, NULL, state, &growth, &d);
  *a = (bench_answer){.lower = growth.lower, .upper = growth.upper, .nodes = growth.pairs};
  a->failed = status != CPROX_OK || !d.valid;
}

static void by_value(const void *problems, size_t i, void *state, bench_answer *a) {
  const growth_problem *p = (const growth_problem *)problems + i;
  cprox_growth growth;
  const cprox_status status = cprox_growth_distance(p->a, p->b, NULL, state, &growth);
  *a = (bench_answer){.lower = growth.lower, .upper = growth.upper, .nodes = growth.pairs};
  a->failed = status != CPROX_OK;
}

/* A value and a gradient, not certified. nodes: steps. */
static void by_cones(const void *problems, size_t i, void *state, bench_answer *a) {
  const growth_problem *p = (const growth_problem *)problems + i;
  (void)state;
  const cone_answer c = cone_growth(p->cone[0], &p->a.pose, p->cone[1], &p->b.pose);
  *a = (bench_answer){.lower = c.value, .upper = c.value, .nodes = (uint32_t)c.steps, .failed = !c.solved};
}

/* The mean signed distance of poses beside, whose mean normal is its gradient: another value than the growth distance. */
static void by_jitters(const void *problems, size_t i, void *state, bench_answer *a) {
  const growth_problem *p = (const growth_problem *)problems + i;
  *a = (bench_answer){.lower = 0.0};
  for (int k = 0; k < JITTERS; k++) {
    cprox_obstacle b = p->b;
    cprox_result r;
    b.pose = p->beside[k];
    a->failed = cprox_pair(p->a, b, NULL, state, &r) < 0 || a->failed;
    a->lower += r.lower / JITTERS, a->upper += r.upper / JITTERS, a->nodes += r.distance_queries;
  }
}

/* Turned about its position by h round an axis: the quaternion's product, to first order. */
static void turn_slightly(cprox_pose *pose, int axis, double h) {
  const cprox_quat q = pose->orientation;
  const double x = axis == 0 ? 0.5 * h : 0.0, y = axis == 1 ? 0.5 * h : 0.0, z = axis == 2 ? 0.5 * h : 0.0;
  pose->orientation = (cprox_quat){q.w - x * q.x - y * q.y - z * q.z, q.x + x * q.w + y * q.z - z * q.y,
                                   q.y - x * q.z + y * q.w + z * q.x, q.z + x * q.y - y * q.x + z * q.w};
}

/* By the twelve numbers of both poses. */
static void by_differences(const void *problems, size_t i, void *state, bench_answer *a) {
  static const double step = 1e-5;
  const growth_problem *p = (const growth_problem *)problems + i;
  by_value(problems, i, state, a);
  for (int variable = 0; variable < 24; variable++) {
    growth_problem moved = *p;
    cprox_pose *pose = variable % 2 ? &moved.b.pose : &moved.a.pose;
    const int axis = variable / 2 % 3;
    const double h = variable / 6 % 2 ? step : -step;
    double *const at[3] = {&pose->position.x, &pose->position.y, &pose->position.z};
    if (variable < 12)
      *at[axis] += h;
    else
      turn_slightly(pose, axis, h);
    bench_answer one;
    by_value(&moved, 0, state, &one);
    a->nodes += one.nodes;
  }
}

/* How many of the cone program's values are not within 1e-5 of the certified ones. */
static size_t count_wrong(const growth_problem *problems, size_t n, cprox_workspace *workspace) {
  size_t wrong = 0;
  for (size_t i = 0; i < n; i++) {
    const growth_problem *p = &problems[i];
    cprox_growth g;
    const cone_answer c = cone_growth(p->cone[0], &p->a.pose, p->cone[1], &p->b.pose);
    wrong += cprox_growth_distance(p->a, p->b, NULL, workspace, &g) < 0 ||
             !(c.value >= g.lower - 1e-5 && c.value <= g.upper + 1e-5);
  }
  return wrong;
}

void implicit_growths(const bench_size *size, cprox_body *const *object, cprox_workspace *workspace) {
  static const cone_body cone_box = {CONE_BOX, {0.5, 0.7, 0.4}}, cone_cylinder = {CONE_CYLINDER, {0.4, 0.75, 0}},
                         cone_ellipsoid = {CONE_ELLIPSOID, {1.0, 0.6, 0.4}};
  cprox_body *box = NULL, *cylinder = NULL, *ellipsoid = NULL;
  if (cprox_body_create_box((cprox_vec3){1.0, 1.4, 0.8}, workspace, &box) < 0 ||
      cprox_body_create_cylinder(1.5, 0.4, workspace, &cylinder) < 0 ||
      cprox_body_create_ellipsoid((cprox_vec3){1.0, 0.6, 0.4}, workspace, &ellipsoid) < 0)
    exit(1);
  const struct {
    const char *name;
    const cprox_body *body[2];
    const cone_body *cone[2];
  } pairs[] = {{"box-box", {box, box}, {&cone_box, &cone_box}},
               {"box-cylinder", {box, cylinder}, {&cone_box, &cone_cylinder}},
               {"cylinder-cylinder", {cylinder, cylinder}, {&cone_cylinder, &cone_cylinder}},
               {"box-ellipsoid", {box, ellipsoid}, {&cone_box, &cone_ellipsoid}},
               {"ellipsoid-ellipsoid", {ellipsoid, ellipsoid}, {&cone_ellipsoid, &cone_ellipsoid}},
               {"box-I", {box, object[1]}, {NULL, NULL}},
               {"I-II", {object[1], object[2]}, {NULL, NULL}},
               {"I-III", {object[1], object[3]}, {NULL, NULL}}};
  rng r = rng_seed(95);
  growth_problem *problems = calloc(size->problems, sizeof *problems);
  for (size_t k = 0; problems && k < sizeof pairs / sizeof *pairs; k++) {
    for (size_t i = 0; i < size->problems; i++) {
      growth_problem *p = &problems[i];
      *p = (growth_problem){cprox_obstacle_at(pairs[k].body[0], rng_pose(&r, 1.0)),
                            cprox_obstacle_at(pairs[k].body[1], rng_pose(&r, 1.0)),
                            {pairs[k].cone[0], pairs[k].cone[1]},
                            {{{0, 0, 0}, {1, 0, 0, 0}}}};
      for (int j = 0; j < JITTERS; j++) {
        p->beside[j] = p->b.pose;
        p->beside[j].position.x += JITTER * rng_uniform(&r, -1.0, 1.0);
        p->beside[j].position.y += JITTER * rng_uniform(&r, -1.0, 1.0);
        p->beside[j].position.z += JITTER * rng_uniform(&r, -1.0, 1.0);
        for (int axis = 0; axis < 3; axis++) turn_slightly(&p->beside[j], axis, JITTER * rng_uniform(&r, -1.0, 1.0));
      }
    }
    const bench_method methods[] = {{"curve_proximity", by_gradient, workspace},
                                    {"value", by_value, workspace},
                                    {"differences", by_differences, workspace},
                                    {"randomised smoothing", by_jitters, workspace},
                                    {"cone program", by_cones, workspace}};
    const bench_workload w = {.group = "implicit",
                              .name = "growth gradient",
                              .parameter = pairs[k].name,
                              .problems = problems,
                              .n = size->problems};
    const bool cones = pairs[k].cone[0] != NULL;
    if (cones)
      fprintf(stderr, "cone program: %zu of %zu values are not those of %s\n",
              count_wrong(problems, size->problems, workspace), size->problems, pairs[k].name);
    bench_measure(&w, size, methods, cones ? 5 : 4);
  }
  free(problems);
  cprox_body_free(box);
  cprox_body_free(cylinder);
  cprox_body_free(ellipsoid);
}
