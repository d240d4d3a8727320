/* SPDX-License-Identifier: BSD-3-Clause */
/* Gaps in space against n: what share of the clear poses a verdict calls clear, how far apart solids may be and still
 * be called colliding, and what a verdict costs, beside the certified distance of the same solids (cprox_pair). And
 * what else could be done for them: a gap for each pair of convex parts, bounds per direction, a shorter period. */
#define _POSIX_C_SOURCE 200809L
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "base/frame.h"
#include "base/rotation.h"
#include "curve_proximity/cprox.h"
#include "fourier/gap.h"
#include "fourier/parts.h"
#include "shape/body.h"
#include "support/random.h"

enum { MOST_POSES = 600, ROUNDS = 3, PARTS = 2 };

/* A solid, and the same set as convex bodies. */
typedef struct solid_in_space {
  const char *name;
  cprox_solid *solid;
  cprox_solid *piece[PARTS]; /* of more than one part: each */
  cprox_body *part[PARTS];
  cprox_vec3 at[PARTS]; /* where the parts stand */
  int n;
} solid_in_space;

static void made(cprox_status status) {
  if (status != CPROX_OK) abort();
}

static solid_in_space make_box(cprox_vec3 size) {
  solid_in_space s = {.name = "box", .n = 1};
  made(cprox_solid_create(&(cprox_solid_description){.kind = CPROX_SOLID_BOX, .dimension = 3, .size = size}, NULL,
                          &s.solid));
  made(cprox_body_create_box(size, NULL, &s.part[0]));
  return s;
}

static solid_in_space make_capsule(double height, double radius) {
  solid_in_space s = {.name = "capsule", .n = 1};
  made(cprox_solid_create(
      &(cprox_solid_description){.kind = CPROX_SOLID_CAPSULE, .dimension = 3, .height = height, .radius = radius}, NULL,
      &s.solid));
  made(cprox_body_create_capsule(height, radius, NULL, &s.part[0]));
  return s;
}

/* An octahedron, as a mesh. */
static solid_in_space make_octahedron(double x, double y, double z) {
  solid_in_space s = {.name = "octahedron", .n = 1};
  const cprox_vec3 v[6] = {{x, 0, 0}, {-x, 0, 0}, {0, y, 0}, {0, -y, 0}, {0, 0, z}, {0, 0, -z}};
  const uint32_t faces[8][3] = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  made(cprox_solid_create(
      &(cprox_solid_description){.kind = CPROX_SOLID_MESH, .points = v, .n = 6, .triangles = faces, .n_triangles = 8},
      NULL, &s.solid));
  made(cprox_body_create_polytope(v, 6, NULL, &s.part[0]));
  return s;
}

/* An L of two boxes that share a face, as one mesh that is not convex, or as the union of both boxes. */
static solid_in_space make_prism(bool mesh) {
  solid_in_space s = {.name = mesh ? "L-prism" : "two-boxes", .n = 2};
  const double outline[6][2] = {{-0.5, -0.5}, {0.5, -0.5}, {0.5, -0.1}, {-0.1, -0.1}, {-0.1, 0.5}, {-0.5, 0.5}};
  const cprox_vec3 size[2] = {{1.0, 0.4, 0.5}, {0.4, 0.6, 0.5}};
  s.at[0] = (cprox_vec3){0.0, -0.3, 0.0}, s.at[1] = (cprox_vec3){-0.3, 0.2, 0.0};
  for (int i = 0; i < 2; i++) {
    made(cprox_body_create_box(size[i], NULL, &s.part[i]));
    made(cprox_solid_create(&(cprox_solid_description){.kind = CPROX_SOLID_BOX, .dimension = 3, .size = size[i]}, NULL,
                            &s.piece[i]));
  }
  if (mesh) {
    cprox_vec3 v[12];
    for (int i = 0; i < 12; i++) v[i] = (cprox_vec3){outline[i % 6][0], outline[i % 6][1], i < 6 ? -0.25 : 0.25};
    uint32_t faces[20][3] = {{0, 3, 1}, {1, 3, 2}, {0, 5, 3}, {3, 5, 4}};
    for (uint32_t i = 0; i < 4; i++)
      for (int k = 0; k < 3; k++) faces[4 + i][k] = 6 + faces[i][2 - k];
    for (uint32_t i = 0; i < 6; i++) {
      const uint32_t j = (i + 1) % 6;
      const uint32_t side[2][3] = {{i, j, j + 6}, {i, j + 6, i + 6}};
      for (int k = 0; k < 3; k++) faces[8 + 2 * i][k] = side[0][k], faces[9 + 2 * i][k] = side[1][k];
    }
    made(cprox_solid_create(&(cprox_solid_description){.kind = CPROX_SOLID_MESH,
                                                       .points = v,
                                                       .n = 12,
                                                       .triangles = (const uint32_t(*)[3])faces,
                                                       .n_triangles = 20},
                            NULL, &s.solid));
    return s;
  }
  cprox_pose poses[2];
  for (int i = 0; i < 2; i++) poses[i] = CPROX_POSE_IDENTITY, poses[i].position = s.at[i];
  made(cprox_solid_create(
      &(cprox_solid_description){
          .kind = CPROX_SOLID_UNION, .parts = (const cprox_solid *const *)s.piece, .poses = poses, .n = 2},
      NULL, &s.solid));
  return s;
}

static void free_solid(solid_in_space *s) {
  cprox_solid_free(s->solid);
  for (int i = 0; i < s->n; i++) {
    cprox_solid_free(s->piece[i]);
    cprox_body_free(s->part[i]);
  }
}

static cprox_pose part_pose(const solid_in_space *s, int i, const cprox_pose *pose) {
  cprox_pose out = *pose;
  const frame f = frame_create(pose, vec(0, 0, 0));
  out.position = vec_add(pose->position, rotate(f.r, s->at[i]));
  return out;
}

/* The distance of the solids, negative inside. */
static double distance(const solid_in_space *a, const cprox_pose *pa, const solid_in_space *b, const cprox_pose *pb,
                       cprox_workspace *ws) {
  cprox_options o = CPROX_OPTIONS_DEFAULT;
  o.signed_distance = true;
  double least = INFINITY;
  for (int i = 0; i < a->n; i++)
    for (int j = 0; j < b->n; j++) {
      cprox_result r = {0};
      if (cprox_pair(cprox_obstacle_at(a->part[i], part_pose(a, i, pa)),
                     cprox_obstacle_at(b->part[j], part_pose(b, j, pb)), &o, ws, &r) < 0)
        abort();
      least = fmin(least, r.upper);
    }
  return least;
}

/* Poses of the second solid inside the bounding spheres, evenly over that ball, with the distance at each. */
typedef struct sample {
  size_t n;
  double size; /* the sum of both radii */
  cprox_pose pose[MOST_POSES];
  double distance[MOST_POSES];
} sample;

static void take_sample(const solid_in_space *a, const solid_in_space *b, size_t n, cprox_workspace *ws, sample *out) {
  const cprox_solid_info ia = cprox_solid_get_info(a->solid), ib = cprox_solid_get_info(b->solid);
  rng r = rng_seed(86);
  out->n = n, out->size = ia.radius + ib.radius;
  const cprox_pose here = CPROX_POSE_IDENTITY;
  for (size_t i = 0; i < n; i++) {
    out->pose[i] = (cprox_pose){.orientation = rng_quat(&r)};
    const frame f = frame_create(&out->pose[i], vec(0, 0, 0));
    const vec3 away = vec_scale(out->size * cbrt(rng_uniform(&r, 0, 1)), rng_unit(&r));
    out->pose[i].position = vec_sub(vec_add(ia.centre, away), rotate(f.r, ib.centre));
    out->distance[i] = distance(a, &here, b, &out->pose[i], ws);
  }
}

static double now_us(void) {
  struct timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return 1e6 * (double)t.tv_sec + 1e-3 * (double)t.tv_nsec;
}

static int by_size(const void *a, const void *b) {
  const double p = *(const double *)a, q = *(const double *)b;
  return p < q ? -1 : p > q;
}

/* The median of what each pose costs. */
typedef bool (*asker)(const void *asked, const sample *s, size_t i, cprox_workspace *ws);

static double median_time(asker ask, const void *asked, const sample *s, cprox_workspace *ws) {
  static double times[MOST_POSES];
  for (size_t i = 0; i < s->n; i++) {
    times[i] = INFINITY;
    for (int round = 0; round < ROUNDS; round++) {
      const double begin = now_us();
      ask(asked, s, i, ws);
      times[i] = fmin(times[i], now_us() - begin);
    }
  }
  qsort(times, s->n, sizeof *times, by_size);
  return times[s->n / 2];
}

static bool is_clear_by_gap(const void *asked, const sample *s, size_t i, cprox_workspace *ws) {
  const cprox_pose here = CPROX_POSE_IDENTITY;
  cprox_gap_result r = {0};
  if (cprox_gap_test(asked, &here, &s->pose[i], ws, &r) < 0) abort();
  return r.verdict == CPROX_GAP_VERDICT_CLEAR || r.verdict == CPROX_GAP_VERDICT_FAR;
}

typedef struct bodies {
  const solid_in_space *a, *b;
} bodies;

static bool is_clear_by_distance(const void *asked, const sample *s, size_t i, cprox_workspace *ws) {
  const bodies *of = asked;
  const cprox_pose here = CPROX_POSE_IDENTITY;
  return distance(of->a, &here, of->b, &s->pose[i], ws) > 0.0;
}

/* Lets V decide alone, without the bounds per direction. */
static void decide_by_sum(cprox_gap *gap) {
  enclosures_free(&gap->bounds_a);
  enclosures_free(&gap->bounds_b);
}

static cprox_gap *gap_of_sum(const cprox_solid *a, const cprox_solid *b, uint32_t samples, cprox_workspace *ws) {
  cprox_gap_options o = CPROX_GAP_OPTIONS_DEFAULT;
  o.samples = samples;
  cprox_gap *gap = NULL;
  made(cprox_gap_create(a, b, &o, ws, &gap));
  decide_by_sum(gap);
  return gap;
}

/* A gap for each pair of convex parts: clear where all of them are. */
typedef struct parts_gap {
  const solid_in_space *a, *b;
  cprox_gap *gap[PARTS][PARTS];
} parts_gap;

static bool is_clear_by_parts(const void *asked, const sample *s, size_t i, cprox_workspace *ws) {
  const parts_gap *of = asked;
  const cprox_pose here = CPROX_POSE_IDENTITY;
  for (int j = 0; j < of->a->n; j++)
    for (int k = 0; k < of->b->n; k++) {
      const cprox_pose a = part_pose(of->a, j, &here), b = part_pose(of->b, k, &s->pose[i]);
      cprox_gap_result r = {0};
      if (cprox_gap_test(of->gap[j][k], &a, &b, ws, &r) < 0) abort();
      if (r.verdict != CPROX_GAP_VERDICT_CLEAR && r.verdict != CPROX_GAP_VERDICT_FAR) return false;
    }
  return true;
}

/* By the bounds per direction alone. */
static bool is_clear_by_directions(const void *asked, const sample *s, size_t i, cprox_workspace *ws) {
  (void)ws;
  const cprox_pose here = CPROX_POSE_IDENTITY;
  return gap_clearance(asked, &here, &s->pose[i]) > 0.0;
}

/* Clear poses farther apart than this share of the size should be called clear. */
#define BEYOND 0.05

/* The share of those that are. */
static double share_clear(asker ask, const void *asked, const sample *s, cprox_workspace *ws, unsigned long *unsound) {
  size_t clear = 0, beyond = 0;
  for (size_t i = 0; i < s->n; i++) {
    const bool says_clear = ask(asked, s, i, ws);
    *unsound += says_clear && s->distance[i] < -1e-9;
    if (s->distance[i] > BEYOND * s->size) beyond++, clear += says_clear;
  }
  return (double)clear / (double)beyond;
}

/* A gap of the same samples at `share` of the least period that keeps bounding spheres apart: a verdict is as good with
 * images, which only add to V. */
static cprox_gap *gap_of_period(const solid_in_space *a, const solid_in_space *b, uint32_t samples, double share,
                                cprox_workspace *ws) {
  cprox_gap_options o = CPROX_GAP_OPTIONS_DEFAULT;
  o.samples = samples;
  gap_plan plan;
  made(gap_plan_choose(a->solid, b->solid, &o, ws, &plan));
  plan.period = share * 2.0 * (a->solid->radius + b->solid->radius);
  plan.offset = kernel_offset(3, (int)samples, plan.mode) * plan.period / samples;
  double reach = 0.0;
  cprox_gap *gap = NULL;
  made(gap_build(&plan, solid_offset(a->solid, plan.offset, &reach), solid_offset(b->solid, plan.offset, &reach),
                 o.memory_limit, ws, &gap));
  gap->centre_a = a->solid->centre, gap->centre_b = b->solid->centre;
  gap->radius_a = a->solid->radius, gap->radius_b = b->solid->radius;
  gap->half_energy = INFINITY; /* the solids may not fit into the period */
  return gap;
}

static void measure_others(const solid_in_space *a, const solid_in_space *b, uint32_t samples, const sample *s,
                           cprox_workspace *ws) {
  char parameter[32], called[64];
  snprintf(parameter, sizeof parameter, "n %u", samples);
  snprintf(called, sizeof called, "space: others %s %s", a->name, b->name);
  unsigned long unsound[4] = {0};
  if (a->n * b->n > 1) {
    parts_gap of = {.a = a, .b = b};
    for (int j = 0; j < a->n; j++)
      for (int k = 0; k < b->n; k++)
        of.gap[j][k] = gap_of_sum(a->n > 1 ? a->piece[j] : a->solid, b->n > 1 ? b->piece[k] : b->solid, samples, ws);
    const double share = share_clear(is_clear_by_parts, &of, s, ws, &unsound[0]);
    fourier_row(called, "curve_proximity by parts", parameter, median_time(is_clear_by_parts, &of, s, ws), 0, share,
                unsound[0], 0);
    for (int j = 0; j < a->n; j++)
      for (int k = 0; k < b->n; k++) cprox_gap_free(of.gap[j][k]);
  }
  cprox_gap *shorter = gap_of_period(a, b, samples, 0.85, ws);
  double share = share_clear(is_clear_by_gap, shorter, s, ws, &unsound[1]);
  fourier_row(called, "curve_proximity period", parameter, median_time(is_clear_by_gap, shorter, s, ws), 0, share,
              unsound[1], 0);
  cprox_gap_free(shorter);

  cprox_gap_options o = CPROX_GAP_OPTIONS_DEFAULT;
  o.samples = samples;
  cprox_gap *whole = NULL;
  made(cprox_gap_create(a->solid, b->solid, &o, ws, &whole));
  share = share_clear(is_clear_by_directions, whole, s, ws, &unsound[2]);
  fourier_row(called, "curve_proximity directions", parameter, median_time(is_clear_by_directions, whole, s, ws), 0,
              share, unsound[2], 0);
  share = share_clear(is_clear_by_gap, whole, s, ws, &unsound[3]);
  fourier_row(called, "curve_proximity verdict", parameter, median_time(is_clear_by_gap, whole, s, ws), 0, share,
              unsound[3], 0);
  cprox_gap_free(whole);
}

static void measure_gap(const solid_in_space *a, const solid_in_space *b, cprox_gap_mode mode, uint32_t samples,
                        const sample *s, cprox_workspace *ws) {
  const char *method = mode == CPROX_GAP_MODE_CERTIFIED ? "curve_proximity" : "curve_proximity tuned";
  char parameter[32], called[64], reached[64], proven[64];
  snprintf(parameter, sizeof parameter, "n %u", samples);
  snprintf(called, sizeof called, "space: clear %s %s", a->name, b->name);
  snprintf(reached, sizeof reached, "space: reach %s %s", a->name, b->name);
  snprintf(proven, sizeof proven, "space: proven %s %s", a->name, b->name);

  cprox_gap_options o = CPROX_GAP_OPTIONS_DEFAULT;
  o.mode = mode, o.samples = samples;
  cprox_gap *gap = NULL;
  if (cprox_gap_create(a->solid, b->solid, &o, ws, &gap) != CPROX_OK) {
    fourier_row(called, method, parameter, NAN, 0, NAN, 0, 1);
    return;
  }
  const cprox_gap_info info = cprox_gap_get_info(gap);
  decide_by_sum(gap);
  size_t clear = 0, beyond = 0;
  double most = 0.0;
  unsigned long unsound = 0;
  for (size_t i = 0; i < s->n; i++) {
    const bool says_clear = is_clear_by_gap(gap, s, i, ws);
    unsound += says_clear && s->distance[i] < -1e-9;
    if (!says_clear) most = fmax(most, s->distance[i]);
    if (s->distance[i] > BEYOND * s->size) beyond++, clear += says_clear;
  }
  const double time = median_time(is_clear_by_gap, gap, s, ws);
  fourier_row(called, method, parameter, time, (double)info.terms, (double)clear / (double)beyond, unsound, 0);
  fourier_row(reached, method, parameter, NAN, 0, most / s->size, 0, 0);
  fourier_row(proven, method, parameter, NAN, 0, info.over_reach / s->size, 0, 0);
  cprox_gap_free(gap);
}

void fourier_space(const bench_size *size) {
  cprox_workspace *ws = cprox_workspace_create();
  solid_in_space all[] = {make_box((cprox_vec3){1.0, 0.7, 0.5}),
                          make_box((cprox_vec3){0.8, 0.8, 0.4}),
                          make_capsule(0.8, 0.2),
                          make_octahedron(0.6, 0.5, 0.4),
                          make_prism(true),
                          make_prism(false)};
  const int pairs[][2] = {{0, 1}, {2, 1}, {3, 1}, {4, 1}, {5, 5}};
  const bool full = size->problems >= 200;
  const uint32_t samples[] = {9, 17, 33, 65, 129};
  sample *s = malloc(sizeof *s);
  if (!s) abort();
  for (size_t p = 0; p < sizeof pairs / sizeof *pairs; p++) {
    const solid_in_space *a = &all[pairs[p][0]], *b = &all[pairs[p][1]];
    take_sample(a, b, full ? MOST_POSES : 300, ws, s);
    char called[64];
    snprintf(called, sizeof called, "space: clear %s %s", a->name, b->name);
    fourier_row(called, "curve_proximity distance", "", median_time(is_clear_by_distance, &(bodies){a, b}, s, ws), 0,
                1.0, 0, 0);
    for (int i = 0; i < 3; i++) measure_others(a, b, samples[i], s, ws);
    for (int i = 0; i < (full ? p == 0 ? 5 : 4 : 3); i++)
      for (int mode = 0; mode < 2; mode++) measure_gap(a, b, (cprox_gap_mode)mode, samples[i], s, ws);
  }
  free(s);
  for (size_t i = 0; i < sizeof all / sizeof *all; i++) free_solid(&all[i]);
  cprox_workspace_free(ws);
}
