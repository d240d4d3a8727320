/* SPDX-License-Identifier: BSD-3-Clause */
/* Executions of a motion within bounds of their errors: certified clearances against random executions in long double. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "curve_proximity/cprox.h"
#include "edges/first_level.h"
#include "edges/kernels.h"
#include "kinematics/errors.h"
#include "problem/problem.h"
#include "support/builders.h"
#include "support/cases.h"
#include "support/robots.h"

/* The lanes of any machine, to ask for what they say of one interval. */
#define EDGE_TARGET
#define EDGE_KERNEL kernel_of_test
edge_kernel kernel_of_test;
#include "edges/kernel.h"

enum { TARGETS = 3, EXECUTIONS = 400 };

typedef struct world {
  test_robot t;
  vec3 points[TARGETS]; /* in the frames of their poses */
  cprox_obstacle targets[TARGETS];
  double tracking[TEST_MAX_VARIABLES], speed[TEST_MAX_VARIABLES], acceleration[TEST_MAX_VARIABLES];
  cprox_error_bounds bounds;
} world;

static bool is_free_of_errors(const test_robot *t, size_t variable) {
  for (size_t i = 0; i < t->n_links; i++) {
    const size_t first = (size_t)t->links[i].variable;
    if (t->links[i].type == CPROX_JOINT_FLOATING && variable >= first && variable < first + 7) return true;
  }
  return false;
}

static double some(rng *r, double most) {
  return rng_index(r, 3) ? rng_log_uniform(r, 1e-5, most) : 0.0;
}

static void make_world(rng *r, world *w) {
  robot_make(r, rng_log_uniform(r, 0.1, 2), &w->t);
  for (size_t i = 0; i < TARGETS; i++) {
    cprox_body *body;
    w->points[i] = rng_in_cube(r, 0.5);
    assert_int_equal(cprox_body_create_point(w->points[i], ws, &body), CPROX_OK);
    w->targets[i] = cprox_obstacle_at(body, rng_pose(r, 2.0));
  }
  const double most = rng_log_uniform(r, 1e-4, 0.2);
  for (size_t v = 0; v < w->t.n_variables; v++) {
    const bool none = is_free_of_errors(&w->t, v);
    w->tracking[v] = none ? 0.0 : some(r, most), w->speed[v] = none ? 0.0 : some(r, most);
    w->acceleration[v] = none ? 0.0 : some(r, most);
  }
  w->bounds = (cprox_error_bounds){.tracking = w->tracking,
                                   .speed = w->speed,
                                   .acceleration = w->acceleration,
                                   .n_variables = w->t.n_variables,
                                   .timing = some(r, 0.3),
                                   .base_position = some(r, most),
                                   .base_rotation = some(r, most),
                                   .base_origin = rng_in_cube(r, 1.0),
                                   .object_position = some(r, most),
                                   .object_rotation = some(r, most),
                                   .sensor = some(r, most),
                                   .flex = some(r, most)};
}

static void free_world(world *w) {
  for (size_t i = 0; i < TARGETS; i++) cprox_body_free((cprox_body *)w->targets[i].body);
  robot_free(&w->t);
}

/* -1, 1, or between: the ends are what bounds are about. */
static double part(rng *r) {
  return rng_index(r, 4) ? (rng_index(r, 2) ? 1.0 : -1.0) : rng_uniform(r, -1, 1);
}

static vec3l turned(rng *r, double angle, vec3l about, vec3l x) {
  const vec3 axis = rng_unit(r);
  const double half = 0.5 * angle * part(r);
  const long double q[4] = {axis.x * sin(half), axis.y * sin(half), axis.z * sin(half), cos(half)};
  return ref_add(ref_turn(q, ref_sub(x, about)), about);
}

static vec3l shifted(rng *r, double by, vec3l x) {
  return ref_add(x, ref_scale(by * fabs(part(r)), ref_vec(rng_unit(r))));
}

/* The variables at a time, and how far each may be off, by difference quotients of the reference. */
static void draw_values(rng *r, const world *w, double from, double to, long double *values) {
  const cprox_error_bounds *b = &w->bounds;
  double time = from + (to - from) * (rng_index(r, 8) ? rng_uniform(r, 0, 1) : (double)rng_index(r, 2));
  time = fmin(fmax(time + b->timing * part(r), w->t.spline ? w->t.times[TEST_SPLINE_DEGREE] : w->t.times[0]),
              w->t.spline ? w->t.times[w->t.n_points] : w->t.times[w->t.n_points - 1]);
  robot_ref_values(&w->t, time, values);
  const long double h = 1e-5L;
  long double before[TEST_MAX_VARIABLES + 1], after[TEST_MAX_VARIABLES + 1];
  robot_ref_values(&w->t, (long double)time - h, before);
  robot_ref_values(&w->t, (long double)time + h, after);
  for (size_t v = 0; v < w->t.n_variables; v++) {
    /* both sides of a waypoint are polynomials of their own: there the quotients are not taken */
    bool smooth = true;
    for (size_t k = 0; k < w->t.n_points + (w->t.spline ? TEST_SPLINE_DEGREE + 1 : 0); k++)
      smooth = smooth && fabs(time - w->t.times[k]) > 2e-5;
    const double rate = smooth ? (double)fabsl((after[v] - before[v]) / (2 * h)) * (1 - 1e-6) : 0.0;
    const double second = smooth ? (double)fabsl((after[v] - 2 * values[v] + before[v]) / (h * h)) * (1 - 1e-3) : 0.0;
    const double most =
        b->tracking[v] + b->speed[v] * fmax(rate - 1e-6, 0.0) + b->acceleration[v] * fmax(second - 1e-3, 0.0);
    values[v] += most * part(r);
  }
}

static size_t first_moving_link(const test_robot *t, size_t link) {
  for (int32_t i = (int32_t)link; i >= 0; i = t->links[i].parent)
    if (t->links[i].type != CPROX_JOINT_FIXED) return 1;
  return 0;
}

/* The least distance of one execution from all points, at one time. Flex is left to the sum of all shifts: it moves a
 * link as a whole. */
static long double execution(rng *r, const world *w, double from, double to) {
  const cprox_error_bounds *b = &w->bounds;
  long double values[TEST_MAX_VARIABLES + 1], least = HUGE_VALL;
  ref_pose links[TEST_MAX_LINKS];
  draw_values(r, w, from, to, values);
  robot_ref_links(&w->t, values, links);
  const vec3l nowhere = {0, 0, 0};
  const rng base = *r;
  for (size_t g = 0; g < w->t.n_links; g++) {
    vec3l exact[TEST_VERTICES];
    vec3 v[TEST_VERTICES];
    robot_ref_vertices(&w->t, links, g, exact);
    const vec3l bent = first_moving_link(&w->t, g) ? shifted(r, b->flex, nowhere) : nowhere;
    for (size_t k = 0; k < TEST_VERTICES; k++) {
      rng same = base; /* the base is where it is for all links */
      const vec3l at = shifted(&same, b->base_position,
                               turned(&same, b->base_rotation, ref_vec(b->base_origin), ref_add(exact[k], bent)));
      v[k] = vec((double)at.x, (double)at.y, (double)at.z);
    }
    for (size_t i = 0; i < TARGETS; i++) {
      const cprox_pose *pose = &w->targets[i].pose;
      vec3l point = ref_to_world(pose, shifted(r, b->sensor, ref_vec(w->points[i])));
      point = shifted(r, b->object_position, turned(r, b->object_rotation, ref_vec(pose->position), point));
      least = fminl(least, fmaxl(ref_point_hull(point, v, TEST_VERTICES) - w->t.margin, 0.0L));
    }
  }
  return least;
}

CASE(no_execution_comes_nearer_than_is_certified) {
  rng r = rng_seed(4601);
  size_t executions = 0, tight = 0, worlds = 0;
  for (size_t i = 0; i < test_cases(250); i++) {
    world w;
    make_world(&r, &w);
    cprox_obstacles *obstacles = NULL;
    const cprox_obstacle_index index = rng_index(&r, 2) ? CPROX_INDEX_BVH : CPROX_INDEX_NONE;
    assert_int_equal(cprox_obstacles_create(w.targets, TARGETS, index, ws, &obstacles), CPROX_OK);
    const cprox_motion_info info = cprox_motion_get_info(w.t.motion);
    const double length = info.t1 - info.t0;
    const double interval[2] = {info.t0 + rng_uniform(&r, 0, 0.4) * length, info.t1 - rng_uniform(&r, 0, 0.4) * length};
    const bool all = rng_index(&r, 2);
    cprox_options options = accurate(1e-5);
    if (!all) options.interval = interval;
    cprox_result d, verdict;
    const cprox_mover mover = cprox_robot_along(w.t.motion, NULL, 0);
    const cprox_status status = cprox_robust_distance(obstacles, mover, &w.bounds, &options, ws, &d);
    if (status != CPROX_OK) fail_msg("world %zu: %s", i, cprox_workspace_error(ws));
    if (d.lower > 0.0) {
      const double delta = 0.9 * d.lower;
      assert_int_equal(cprox_robust_tolerance(obstacles, mover, delta, &w.bounds, &options, ws, &verdict), CPROX_OK);
      assert_int_equal(verdict.verdict, CPROX_VERDICT_CLEAR);
      assert_true(verdict.lower > delta);
      worlds++;
      /* near where it is least, and anywhere */
      for (size_t k = 0; k < EXECUTIONS; k++) {
        const double at = fmin(fmax(d.t, all ? info.t0 : interval[0]), all ? info.t1 : interval[1]);
        const bool near = k % 2;
        const long double least = execution(&r, &w,
                                            near  ? at
                                            : all ? info.t0
                                                  : interval[0],
                                            near  ? at
                                            : all ? info.t1
                                                  : interval[1]);
        if (least < d.lower) fail_msg("world %zu: %.12Lg, certified %.12g", i, least, d.lower);
        tight += least < d.lower + 0.003;
        executions++;
      }
    }
    cprox_obstacles_free(obstacles);
    free_world(&w);
  }
  print_message("%zu executions of %zu motions, none nearer than certified; %zu within 3 mm of it\n", executions,
                worlds, tight);
  if (worlds >= 50) assert_true(worlds > test_cases(50) && tight > 0);
}

/* The distance of two links in one execution, at one time: links are drawn from the same values, and bent each by itself. */
static double pair_in_execution(rng *r, const world *w, cprox_robot_pair pair, double from, double to) {
  long double values[TEST_MAX_VARIABLES + 1];
  ref_pose links[TEST_MAX_LINKS];
  draw_values(r, w, from, to, values);
  robot_ref_links(&w->t, values, links);
  cprox_obstacle side[2];
  for (int k = 0; k < 2; k++) {
    const cprox_link_geometry *g = &w->t.geometries[k ? pair.other : pair.geometry];
    const ref_pose *l = &links[g->link];
    vec3l p = l->p;
    if (first_moving_link(&w->t, (size_t)g->link)) p = shifted(r, w->bounds.flex, p);
    const cprox_pose link = {.position = {(double)p.x, (double)p.y, (double)p.z},
                             .orientation = {(double)l->q[3], (double)l->q[0], (double)l->q[1], (double)l->q[2]}};
    side[k] = cprox_with_margin(cprox_obstacle_at(g->body, frame_compose(&link, &g->pose)), g->margin);
  }
  cprox_result at;
  assert_true(cprox_pair(side[0], side[1], NULL, ws, &at) >= 0);
  return at.upper;
}

CASE(no_execution_brings_two_links_nearer_than_is_certified) {
  rng r = rng_seed(4602);
  size_t asked = 0;
  for (size_t i = 0; i < test_cases(120); i++) {
    world w;
    make_world(&r, &w);
    for (int32_t a = 1; a < (int32_t)w.t.n_links; a++) {
      const cprox_robot_pair pair = {a, (int32_t)rng_index(&r, (size_t)a)};
      if (cprox_motion_get_link_info(w.t.motion, pair.geometry, pair.other).n_joints < 2) continue;
      cprox_options options = accurate(1e-5);
      cprox_result d;
      const cprox_mover self = cprox_robot_self(w.t.motion, &pair, 1);
      const cprox_status status = cprox_robust_distance(NULL, self, &w.bounds, &options, ws, &d);
      if (status != CPROX_OK) fail_msg("world %zu: %s", i, cprox_workspace_error(ws));
      if (!(d.lower > 0.0)) continue;
      asked++;
      const cprox_motion_info info = cprox_motion_get_info(w.t.motion);
      for (int k = 0; k < 40; k++) {
        const double least = pair_in_execution(&r, &w, pair, k % 2 ? d.t : info.t0, k % 2 ? d.t : info.t1);
        if (least < d.lower - 1e-12) fail_msg("world %zu: %.12g, certified %.12g", i, least, d.lower);
      }
    }
    free_world(&w);
  }
  print_message("%zu pairs of links\n", asked);
  if (test_cases(120) >= 60) assert_true(asked > test_cases(60));
}

/* ---- bounds of a node ---- */

static double farthest_from(const vec3l *x, vec3 centre) {
  double most = 0.0;
  for (size_t k = 0; k < TEST_VERTICES; k++) most = fmax(most, (double)ref_norm(ref_sub(x[k], ref_vec(centre))));
  return most;
}

/* A part of one segment, and how its axes stand in its middle. */
typedef struct node {
  motion_interval over;
  axis_state *axes;
  axis_deviations *off;
} node;

static void draw_node(rng *r, const cprox_motion *m, const robot_errors *errors, double *rows, node *at) {
  const size_t k = rng_index(r, m->n_segments);
  const double a = rng_uniform(r, 0, 0.5);
  at->over = (motion_interval){.a = a, .b = rng_uniform(r, a, 1.0), .first = k, .last = k + 1};
  motion_node(m, k, at->over.a, at->over.b, rows, at->axes);
  for (size_t i = 0; i < m->robot->n_axes; i++)
    at->off[i].of = errors_of_axis(m, errors, (int32_t)i, k, 0.5 * (at->over.a + at->over.b), &at->over);
}

/* How far a vertex of a geometry is from where the motion has it at a time of the node, in one execution: by its joints,
 * and by its joints and its base; over what is bounded. */
static void expect_within(rng *r, const world *w, const node *at, size_t geometry, const robot_errors *errors,
                          double share[2]) {
  const cprox_motion *m = w->t.motion;
  const int32_t axis = m->robot->parts[geometry].axis;
  if (axis < 0) return;
  long double values[TEST_MAX_VARIABLES + 1];
  ref_pose links[TEST_MAX_LINKS];
  vec3l exact[TEST_VERTICES], off[TEST_VERTICES];
  robot_ref_values(&w->t, motion_time(m, at->over.first, 0.5 * (at->over.a + at->over.b)), values);
  robot_ref_links(&w->t, values, links);
  robot_ref_vertices(&w->t, links, geometry, exact);
  const vec3 centre = vec((double)exact[0].x, (double)exact[0].y, (double)exact[0].z);
  const double radius = farthest_from(exact, centre),
               time = motion_time(m, at->over.first, rng_index(r, 2) ? at->over.a : at->over.b);
  double travel;
  const deviation joints = errors_along_chain(m, at->axes, at->off, axis, -1, centre, radius, &travel);
  const deviation base = errors_of_base(errors, centre, radius, travel);

  robot_ref_values(&w->t, time, values);
  robot_ref_links(&w->t, values, links);
  robot_ref_vertices(&w->t, links, geometry, exact);
  draw_values(r, w, time, time, values);
  robot_ref_links(&w->t, values, links);
  robot_ref_vertices(&w->t, links, geometry, off);
  const cprox_error_bounds *b = &w->bounds;
  const double most[2] = {joints.middle + joints.growth, base.middle + base.growth};
  for (size_t k = 0; k < TEST_VERTICES; k++) {
    const vec3l x = shifted(r, b->base_position, turned(r, b->base_rotation, ref_vec(b->base_origin), off[k]));
    const double by[2] = {(double)ref_norm(ref_sub(off[k], exact[k])), (double)ref_norm(ref_sub(x, exact[k]))};
    for (int i = 0; i < 2; i++) {
      const double bound = most[0] + (i ? most[1] : 0.0);
      if (by[i] > bound + 1e-9) fail_msg("%s: off by %.12g, bound %.12g", i ? "base" : "joints", by[i], bound);
      if (bound > 1e-3) share[i] = fmax(share[i], by[i] / bound);
    }
  }
}

CASE(no_point_is_farther_off_than_a_node_says) {
  rng r = rng_seed(4606);
  double share[2] = {0.0, 0.0};
  for (size_t i = 0; i < test_cases(600); i++) {
    world w;
    make_world(&r, &w);
    w.bounds.timing = 0.0;
    const bool base_alone = rng_index(&r, 2);
    for (size_t v = 0; base_alone && v < w.t.n_variables; v++) w.tracking[v] = w.speed[v] = w.acceleration[v] = 0.0;
    const cprox_motion *m = w.t.motion;
    const robot_errors errors = {.bounds = &w.bounds, .scale = 1.0};
    double *rows = calloc(MOTION_ROWS * m->row_size + 1, sizeof *rows);
    node at = {.axes = calloc(m->robot->n_axes + 1, sizeof *at.axes),
               .off = calloc(m->robot->n_axes + 1, sizeof *at.off)};
    assert_true(rows && at.axes && at.off);
    for (int k = 0; k < 20; k++) {
      draw_node(&r, m, &errors, rows, &at);
      for (size_t g = 0; g < w.t.n_links; g++) expect_within(&r, &w, &at, g, &errors, share);
    }
    free(rows), free(at.axes), free(at.off);
    free_world(&w);
  }
  print_message("points are off by up to %.3f of what joints, and %.3f of what joints and base are bounded by\n",
                share[0], share[1]);
  assert_true(share[0] > 0.9 && share[1] > 0.9);
}

/* ---- lanes ---- */

/* Whether lanes alone prove that all executions are farther than delta. */
static bool lanes_prove(const world *w, cprox_mover mover, size_t n, double delta) {
  query q = query_create(mover, w->targets, n, delta, NULL, ws);
  assert_int_equal(query_begin(&q, (arguments_query){"the test", ~0u}), CPROX_OK);
  robot_errors errors = {.bounds = &w->bounds, .scale = 1.0};
  q.errors = &errors;
  edge_first first;
  workspace_forget_work(ws);
  return edge_first_level(&q, 0, n, false, &first) && first.verdict == CPROX_VERDICT_CLEAR;
}

/* The largest delta for which they do, nearly; negative: none. */
static double most_by_lanes(const world *w, cprox_mover mover, size_t n) {
  double proven = -1.0, open = 10.0;
  for (int k = 0; k < 24; k++) {
    const double delta = k == 0 ? 0.0 : 0.5 * (proven + open);
    if (lanes_prove(w, mover, n, delta))
      proven = delta;
    else
      open = delta;
    if (proven < 0.0) return proven;
  }
  return proven;
}

/* One segment in lanes, at eight intervals of any length. */
typedef struct segment_in_lanes {
  cprox_edge_checker *model;
  edge_motion motion;
  edge_losses losses;
  lane_batch batch;
  size_t number;
  void *memory[5];
} segment_in_lanes;

static void *take_lanes(size_t n, size_t size) {
  void *memory = aligned_alloc(64, (n * size / 64 + 1) * 64);
  assert_non_null(memory);
  memset(memory, 0, (n * size / 64 + 1) * 64);
  return memory;
}

/* False: not in lanes. */
static bool begin_lanes(rng *r, const world *w, const query *q, segment_in_lanes *s) {
  const edge_asked asked = {.robot = w->t.motion->robot, .about_obstacles = true};
  cprox_edge_checker *c = edge_model_keep(&asked, ws, WORKSPACE_EDGE_ROBOT);
  if (!c || !c->in_lanes) return false;
  *s = (segment_in_lanes){.model = c, .number = rng_index(r, w->t.motion->n_segments)};
  s->memory[0] = take_lanes(1, edge_motion_size(c));
  s->memory[1] = take_lanes(c->n_frames, sizeof(lane_frame));
  s->memory[2] = take_lanes(c->n_parts, sizeof(lane_part));
  s->memory[3] = take_lanes(c->n_frames, sizeof(lane_off));
  s->memory[4] = take_lanes(1, edge_losses_size(c));
  s->motion = edge_motion_in(c, s->memory[0]);
  const motion_interval over = {.a = 0.0, .b = 1.0, .first = s->number, .last = s->number + 1};
  s->losses = edge_losses_in(c, q, 0, TARGETS, s->memory[4]);
  if (!edge_motion_fill_along(c, w->t.motion, &over, &s->motion)) return false;
  edge_losses_over(q, c, &over, &s->motion, &s->losses);
  s->motion.losses = &s->losses;
  s->batch.c = c, s->batch.motion = &s->motion;
  s->batch.frames = s->memory[1], s->batch.parts = s->memory[2], s->batch.off = s->memory[3];
  for (int k = 0; k < 9; k += 4) s->batch.frames[0].r[k] = lane_all(1.0f);
  for (int i = 0; i < EDGE_LANES; i++) {
    s->batch.half[i] = rng_index(r, 3) ? (float)rng_uniform(r, 0, 0.5) : 0.0f;
    s->batch.middle[i] = (0.5f - s->batch.half[i]) * (float)rng_uniform(r, -1, 1);
  }
  for (size_t i = 1; i < c->n_frames; i++) place_frame(&s->batch, i);
  for (size_t i = 0; i < c->n_parts; i++) {
    const lane_frame *own = &s->batch.frames[c->parts[i].frame];
    s->batch.parts[i].centre = lane3_add(own->o, lane_turn(own, c->parts[i].centre));
  }
  return true;
}

/* How far the vertices of a part are off at one time of an interval, in any direction and along n, over what is said. */
static void expect_within_losses(rng *r, const world *w, const segment_in_lanes *s, size_t number, int lane_at, vec3 n,
                                 double any, double along, double share[2]) {
  const double u = 0.5 + (double)s->batch.middle[lane_at] + (double)s->batch.half[lane_at] * part(r);
  const double time = motion_time(w->t.motion, s->number, fmin(fmax(u, 0.0), 1.0));
  long double values[TEST_MAX_VARIABLES + 1];
  ref_pose links[TEST_MAX_LINKS];
  vec3l exact[TEST_VERTICES], off[TEST_VERTICES];
  const edge_part *p = &s->model->parts[number];
  robot_ref_values(&w->t, time, values);
  robot_ref_links(&w->t, values, links);
  ref_pose other[TEST_MAX_LINKS];
  draw_values(r, w, time, time, values);
  robot_ref_links(&w->t, values, other);
  for (uint32_t g = p->first_member; g < p->first_member + p->n_members; g++) {
    robot_ref_vertices(&w->t, links, (size_t)s->model->members[g], exact);
    robot_ref_vertices(&w->t, other, (size_t)s->model->members[g], off);
    for (size_t k = 0; k < TEST_VERTICES; k++) {
      const vec3l moved = ref_sub(off[k], exact[k]);
      const double by[2] = {(double)ref_norm(moved), (double)fabsl(ref_dot(ref_vec(n), moved))}, said[2] = {any, along};
      for (int i = 0; i < 2; i++) {
        if (by[i] > said[i] + 1e-9) fail_msg("%s: %.12g, lanes say %.12g", i ? "along" : "any", by[i], said[i]);
        if (said[i] > 1e-3) share[i] = fmax(share[i], by[i] / said[i]);
      }
    }
  }
}

/* One vertex, along normals that an axis does not move it along, but by what its arc bends. Lanes round 1e-7 of it. */
static void expect_vertex_within_losses(rng *r, const world *w, const segment_in_lanes *s, size_t number,
                                        double *share) {
  const edge_part *p = &s->model->parts[number];
  const size_t geometry = (size_t)s->model->members[p->first_member + rng_index(r, p->n_members)];
  const size_t k = rng_index(r, TEST_VERTICES);
  int32_t about = p->frame;
  while (s->model->frames[about].parent > 0 && rng_index(r, 2)) about = s->model->frames[about].parent;
  long double values[TEST_MAX_VARIABLES + 1];
  ref_pose links[TEST_MAX_LINKS];
  vec3l exact[TEST_VERTICES], off[TEST_VERTICES];
  lane3 at;
  double time[EDGE_LANES];
  for (int l = 0; l < EDGE_LANES; l++) {
    time[l] = motion_time(w->t.motion, s->number, 0.5 + (double)s->batch.middle[l]);
    robot_ref_values(&w->t, time[l], values);
    robot_ref_links(&w->t, values, links);
    robot_ref_vertices(&w->t, links, geometry, exact);
    const vec3l seen = ref_sub(exact[k], ref_vec(s->model->base));
    at.x[l] = (float)seen.x, at.y[l] = (float)seen.y, at.z[l] = (float)seen.z;
  }
  const lane3 z = axis_of_frame(&s->batch.frames[about]), arm = lane3_sub(at, s->batch.frames[about].o);
  const lane3 radial = lane3_cross(lane3_cross(z, arm), z);
  const lane length = lane_sqrt(lane3_norm2(radial));
  const lane3 n = {radial.x / length, radial.y / length, radial.z / length};
  const lane_loss along = loss_along(&s->batch, number, at, 0.0f, n);
  for (int l = 0; l < EDGE_LANES; l++) {
    if (s->batch.half[l] > 0.0f || length[l] < 1e-2f) continue;
    robot_ref_values(&w->t, time[l], values);
    robot_ref_links(&w->t, values, links);
    robot_ref_vertices(&w->t, links, geometry, exact);
    draw_values(r, w, time[l], time[l], values);
    robot_ref_links(&w->t, values, links);
    robot_ref_vertices(&w->t, links, geometry, off);
    const vec3l normal = {(long double)n.x[l], (long double)n.y[l], (long double)n.z[l]};
    const double by = (double)fabsl(ref_dot(normal, ref_sub(off[k], exact[k]))), said = (double)along.most[l];
    if (by > said + 1e-7) fail_msg("%.12g across an arc, lanes say %.12g", by, said);
    if (said > 1e-3) *share = fmax(*share, by / said);
  }
}

CASE(no_point_is_farther_off_than_lanes_say) {
  rng r = rng_seed(4607);
  double share[2] = {0.0, 0.0}, bent = 0.0;
  size_t asked = 0;
  for (size_t i = 0; i < test_cases(800); i++) {
    world w;
    make_world(&r, &w);
    const size_t alone = rng_index(&r, 2 * w.t.n_variables + 1);
    for (size_t v = 0; v < w.t.n_variables && alone < w.t.n_variables; v++)
      if (v != alone) w.tracking[v] = w.speed[v] = w.acceleration[v] = 0.0;
    w.bounds = (cprox_error_bounds){
        .tracking = w.tracking, .speed = w.speed, .acceleration = w.acceleration, .n_variables = w.t.n_variables};
    query q = query_create(cprox_robot_along(w.t.motion, NULL, 0), w.targets, TARGETS, 0.0, NULL, ws);
    assert_int_equal(query_begin(&q, (arguments_query){"the test", ~0u}), CPROX_OK);
    robot_errors errors = {.bounds = &w.bounds, .scale = 1.0};
    q.errors = &errors;
    segment_in_lanes s = {.model = NULL};
    const bool known = begin_lanes(&r, &w, &q, &s);
    for (size_t part = 0; known && part < s.model->n_parts; part++) {
      find_loss(&s.batch, part);
      for (int k = 0; k < 10; k++) {
        const vec3 n = rng_unit(&r);
        const edge_part *p = &s.model->parts[part];
        const lane3 normal = {lane_all((float)n.x), lane_all((float)n.y), lane_all((float)n.z)};
        const lane_loss along = loss_along(&s.batch, part, s.batch.parts[part].centre, p->core, normal);
        for (int l = 0; l < EDGE_LANES; l++)
          expect_within_losses(&r, &w, &s, part, l, n, (double)s.batch.loss.most[l], (double)along.most[l], share);
        asked++;
      }
      for (int k = 0; k < 10; k++) expect_vertex_within_losses(&r, &w, &s, part, &bent);
    }
    for (int k = 0; k < 5; k++) free(s.memory[k]);
    free_world(&w);
  }
  print_message("%zu parts along a normal: off by up to %.3f of what is said, %.3f along it, %.3f across an arc\n",
                asked, share[0], share[1], bent);
  assert_true(asked > test_cases(800) && share[0] > 0.9 && share[1] > 0.8 && bent > 0.8);
}

CASE(no_execution_comes_nearer_than_lanes_say) {
  rng r = rng_seed(4604);
  size_t executions = 0, tight = 0, worlds = 0, more = 0, ended = 0;
  for (size_t i = 0; i < test_cases(800); i++) {
    world w;
    make_world(&r, &w);
    w.bounds.timing = 0.0;
    const cprox_mover mover = cprox_robot_along(w.t.motion, NULL, 0);
    const cprox_motion_info info = cprox_motion_get_info(w.t.motion);
    const double lanes = most_by_lanes(&w, mover, TARGETS);
    if (lanes > 0.0) {
      cprox_obstacles *obstacles = NULL;
      assert_int_equal(cprox_obstacles_create(w.targets, TARGETS, CPROX_INDEX_NONE, ws, &obstacles), CPROX_OK);
      const cprox_options options = accurate(1e-5);
      cprox_result d, verdict;
      assert_true(cprox_robust_distance(obstacles, mover, &w.bounds, &options, ws, &d) >= 0);
      more += lanes > d.upper;
      /* the normal of one distance may leave less than what another normal proves: there a verdict ends undecided */
      assert_true(cprox_robust_tolerance(obstacles, mover, 0.99 * d.lower, &w.bounds, &options, ws, &verdict) >= 0);
      if (verdict.verdict != CPROX_VERDICT_CLEAR) assert_true(verdict.upper <= 0.99 * d.lower);
      ended += verdict.verdict != CPROX_VERDICT_CLEAR;
      double proven = lanes; /* by a verdict, whoever gave it */
      for (int k = 0; k < 4; k++) {
        const double delta = fmax(d.upper, lanes) * (1.0 + rng_log_uniform(&r, 1e-3, 1.0));
        assert_true(cprox_robust_tolerance(obstacles, mover, delta, &w.bounds, &options, ws, &verdict) >= 0);
        if (verdict.verdict == CPROX_VERDICT_CLEAR) proven = fmax(delta, proven);
      }
      for (size_t k = 0; k < EXECUTIONS; k++) {
        const long double least = execution(&r, &w, k % 2 ? d.t : info.t0, k % 2 ? d.t : info.t1);
        if (least < proven) fail_msg("world %zu: %.12Lg, proven %.12g", i, least, proven);
        tight += least < lanes + 0.003;
        executions++;
      }
      worlds++;
      cprox_obstacles_free(obstacles);
    }
    free_world(&w);
  }
  print_message(
      "%zu executions of %zu motions, none nearer than lanes say; %zu within 3 mm of it; %zu motions by more "
      "than the search says; %zu verdicts end where a distance certifies more\n",
      executions, worlds, tight, more, ended);
  assert_true(ended <= worlds / 500);
  if (worlds >= 50) assert_true(tight > 0);
}

CASE(no_execution_brings_two_links_nearer_than_lanes_say) {
  rng r = rng_seed(4605);
  size_t asked = 0, tight = 0;
  for (size_t i = 0; i < test_cases(300); i++) {
    world w;
    make_world(&r, &w);
    w.bounds.timing = 0.0;
    const cprox_motion_info info = cprox_motion_get_info(w.t.motion);
    for (int32_t a = 1; a < (int32_t)w.t.n_links; a++) {
      const cprox_robot_pair pair = {a, (int32_t)rng_index(&r, (size_t)a)};
      const double lanes = most_by_lanes(&w, cprox_robot_self(w.t.motion, &pair, 1), 0);
      if (!(lanes > 0.0)) continue;
      asked++;
      for (int k = 0; k < 40; k++) {
        const double least = pair_in_execution(&r, &w, pair, info.t0, info.t1);
        if (least < lanes - 1e-12) fail_msg("world %zu: %.12g, by lanes %.12g", i, least, lanes);
        tight += least < lanes + 0.003;
      }
    }
    free_world(&w);
  }
  print_message("%zu pairs of links, %zu executions within 3 mm\n", asked, tight);
  if (asked >= 50) assert_true(tight > 0);
}

int main(void) {
  return cases_run(workspace_setup, workspace_teardown);
}
