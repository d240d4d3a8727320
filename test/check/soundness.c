/* SPDX-License-Identifier: BSD-3-Clause */
/* soundness SIZE SEED: random queries in the plane and in space, scales from 1e-6 to 1e6 m, up to 1e6 m from the
 * origin, each interval held against distances in long double: lower is not above the distance at any point of the
 * curve that is looked at (the witness, its neighbourhood, 16 others), upper not below that at the witness. Half of the
 * queries ask for the narrowest interval, so that a lower bound which is too high by a rounding shows.
 *
 * Points lie on a grid on which their differences to the body's position are exact: the reference works on those, so
 * that its own error is 2^-64 of the sizes and not of the offset; ROOM covers that. Run by CI with 20,000 queries;
 * scripts/soundness runs more. */
#include <float.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>

#include "curve_proximity/cprox.h"
#include "support/make_curve.h"
#include "support/random.h"
#include "support/reference.h"

enum { MAX_DEGREE = 10, SAMPLES = 16 };

/* Of the reference, in its own roundings of the sizes: degree + 1 products and sums three times, a turn, a distance. */
#define ROOM (400.0L * LDBL_EPSILON)

typedef struct sample_problem {
  bool planar;
  size_t degree;
  vec3 points[MAX_DEGREE + 1], nearby[MAX_DEGREE + 1];
  double scale, offset, distance_from_origin;
  int shape; /* a sphere, a box, a capsule, a hull; in the plane a polygon */
  vec3 size, vertex[6];
  cprox_pose pose;
  cprox_curve *curve;
  cprox_body *body;
} sample_problem;

static vec3 on_grid(vec3 p, double step) {
  return vec(step * nearbyint(p.x / step), step * nearbyint(p.y / step), step * nearbyint(p.z / step));
}

static vec3 flattened(vec3 p, bool planar) {
  return planar ? vec(p.x, p.y, 0.0) : p;
}

static void make_body(sample_problem *p, rng *r, cprox_workspace *ws) {
  p->size = vec(rng_log_uniform(r, 0.05, 1.0) * p->scale, rng_log_uniform(r, 0.05, 1.0) * p->scale,
                rng_log_uniform(r, 0.05, 1.0) * p->scale);
  p->shape = p->planar ? 4 : (int)rng_index(r, 4);
  double flat[6][2];
  for (int i = 0; i < 6; i++) {
    const double angle = 2.0 * 3.14159265358979 * (i + rng_uniform(r, 0.0, 0.8)) / 6.0;
    flat[i][0] = p->size.x * cos(angle);
    flat[i][1] = p->size.y * sin(angle);
    p->vertex[i] = p->planar ? vec(flat[i][0], flat[i][1], 0.0) : rng_in_cube(r, p->size.x);
  }
  switch (p->shape) {
    case 0: cprox_body_create_sphere(p->size.x, ws, &p->body); break;
    case 1: cprox_body_create_box(vec_scale(2.0, p->size), ws, &p->body); break;
    case 2: cprox_body_create_capsule(2.0 * p->size.z, p->size.x, ws, &p->body); break;
    case 3: cprox_body_create_polytope(p->vertex, 6, ws, &p->body); break;
    default: cprox_body_create_polygon((const double(*)[2])flat, 6, ws, &p->body);
  }
}

/* False where the library refuses it, with its reason in the workspace. */
static bool make_problem(sample_problem *p, rng *r, cprox_workspace *ws) {
  *p = (sample_problem){.planar = rng_index(r, 3) == 0};
  p->scale = rng_index(r, 2) ? 1.0 : rng_log_uniform(r, 1e-6, 1e6);
  const double far[] = {0.0, 1e3, 1e6};
  p->distance_from_origin = far[rng_index(r, 3)];
  const vec3 away = flattened(rng_in_cube(r, p->distance_from_origin), p->planar);
  const double step = ldexp(1.0, ilogb(fmax(p->scale, vec_norm(away))) - 49);
  p->degree = 1 + rng_index(r, MAX_DEGREE);
  p->pose.position = on_grid(vec_add(away, flattened(rng_in_cube(r, p->scale), p->planar)), step);
  p->pose.orientation = rng_index(r, 3) ? rng_quat(r) : (cprox_quat){1, 0, 0, 0};
  if (p->planar) p->pose.orientation.x = p->pose.orientation.y = 0.0;
  for (size_t i = 0; i <= p->degree; i++) {
    p->points[i] = on_grid(vec_add(away, flattened(rng_in_cube(r, 2.0 * p->scale), p->planar)), step);
    p->nearby[i] = vec_sub(p->points[i], p->pose.position);
  }
  p->offset = rng_index(r, 2) ? 0.0 : rng_uniform(r, 0.0, 0.1 * p->scale);
  make_body(p, r, ws);
  return p->body && curve_from(describe_bezier(p->points, p->degree + 1, 0.0, 1.0), ws, &p->curve) == CPROX_OK;
}

static void free_problem(sample_problem *p) {
  cprox_body_free(p->body);
  cprox_curve_free(p->curve);
}

/* The distance at s, 0 where they overlap. */
static long double distance_at(const sample_problem *p, long double s) {
  const cprox_pose turn = {.orientation = p->pose.orientation};
  const vec3l y = ref_to_local(&turn, ref_bezier(p->nearby, p->degree, s, 0));
  long double d;
  switch (p->shape) {
    case 0: d = ref_norm(y) - (long double)p->size.x; break;
    case 1: d = ref_point_box(y, p->size); break;
    case 2:
      d = ref_point_segment(y, (vec3l){0, 0, -p->size.z}, (vec3l){0, 0, p->size.z}) - (long double)p->size.x;
      break;
    case 3: d = ref_point_hull(y, p->vertex, 6); break;
    default: d = ref_point_polygon(y, p->vertex, 6);
  }
  d -= (long double)p->offset;
  return d > 0 ? d : 0;
}

/* The least distance that is seen. */
static long double least_distance(const sample_problem *p, double t, rng *r) {
  long double least = distance_at(p, t);
  for (int i = 0; i < SAMPLES; i++) {
    const double near = t + rng_log_uniform(r, 1e-12, 1e-1) * (i % 2 ? 1.0 : -1.0);
    const double s = i < SAMPLES / 2 && near >= 0.0 && near <= 1.0 ? near : rng_uniform(r, 0.0, 1.0);
    least = fminl(least, distance_at(p, s));
  }
  return least;
}

/* Are both ends right? What is not is told on standard output. */
static bool examine(const sample_problem *p, rng *r, cprox_workspace *ws, size_t number, long double *tightest) {
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.epsilon = rng_index(r, 2) ? 0.0 : 1e-6 * p->scale;
  cprox_result result;
  const cprox_mover along = cprox_tube_along(p->curve, p->offset);
  const cprox_status status = cprox_distance(along, cprox_obstacle_at(p->body, p->pose), &options, ws, &result);
  if (status < 0) {
    printf("FAILED query %zu: %s\n", number, cprox_workspace_error(ws));
    return false;
  }
  const long double room = ROOM * (long double)(4.0 * p->scale + p->offset);
  const long double least = least_distance(p, result.t, r), witness = distance_at(p, result.t);
  if (options.epsilon == 0.0 && least > 0) *tightest = fminl(*tightest, (least - (long double)result.lower) / p->scale);
  /* t is a double: rounding it moves the point by u times the speed, at most 2 n |P| */
  const long double moved = 4.0L * (long double)p->degree * (long double)p->scale * (long double)DBL_EPSILON;
  const bool right = (long double)result.lower <= least + room && (long double)result.upper >= witness - room - moved;
  if (!right)
    printf(
        "FAILED query %zu: [%.17g, %.17g], but %.19Lg at t = %.17g and %.19Lg nearby (shape %d, degree %zu, scale %g, "
        "%g away)\n",
        number, result.lower, result.upper, witness, result.t, least, p->shape, p->degree, p->scale,
        p->distance_from_origin);
  return right;
}

int main(int argc, char **argv) {
  if (argc != 3) {
    fputs("usage: soundness SIZE SEED\n", stderr);
    return 2;
  }
  const size_t size = strtoul(argv[1], NULL, 10);
  rng r = rng_seed(strtoumax(argv[2], NULL, 10));
  cprox_workspace *ws = cprox_workspace_create();
  size_t asked = 0, wrong = 0;
  long double tightest = 1.0L;
  for (; asked < size; asked++) {
    sample_problem p;
    if (!make_problem(&p, &r, ws)) {
      printf("FAILED query %zu: %s\n", asked, cprox_workspace_error(ws));
      wrong++;
    } else if (!examine(&p, &r, ws, asked, &tightest)) {
      wrong++;
    }
    free_problem(&p);
  }
  cprox_workspace_free(ws);
  printf("lower came within %.1Lg of the scale of a distance that was seen\n", tightest);
  printf("%zu passed, %zu failed\n", asked - wrong, wrong);
  return wrong > 0 || asked == 0;
}
