/* SPDX-License-Identifier: BSD-3-Clause */
#include "problems.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "support/make_curve.h"
#include "support/random.h"
#include "support/reference.h"

static void check(cprox_status status) {
  if (status == CPROX_OK) return;
  fprintf(stderr, "a problem could not be made: %s\n", cprox_status_text(status));
  exit(1);
}

static void *memory(size_t count, size_t size) {
  void *p = calloc(count, size);
  if (!p) {
    fputs("out of memory\n", stderr);
    exit(1);
  }
  return p;
}

/* ---- obstacles ---- */

static int ascending(const void *a, const void *b) {
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

static void make_polygon(rng *r, vec3 centre, double radius, obstacle *o) {
  double angle[OBSTACLE_MAX_VERTICES];
  o->n = 5 + rng_index(r, 36);
  for (size_t i = 0; i < o->n; i++) angle[i] = rng_uniform(r, 0.0, 6.283185307179586);
  qsort(angle, o->n, sizeof *angle, ascending);
  double plane[OBSTACLE_MAX_VERTICES][2];
  for (size_t i = 0; i < o->n; i++) {
    o->vertex[i] = vec_add(centre, vec(radius * cos(angle[i]), radius * sin(angle[i]), 0.0));
    plane[i][0] = o->vertex[i].x, plane[i][1] = o->vertex[i].y;
  }
  check(cprox_body_create_polygon((const double(*)[2])plane, o->n, NULL, &o->body));
}

/* All triples with every other vertex on one side: for a few dozen vertices. */
void obstacle_find_faces(obstacle *o) {
  o->triangle = memory(4 * o->n, sizeof *o->triangle);
  const int n = (int)o->n;
  for (int i = 0; i < n; i++) {
    for (int j = i + 1; j < n; j++) {
      for (int k = j + 1; k < n; k++) {
        const vec3 normal = vec_cross(vec_sub(o->vertex[j], o->vertex[i]), vec_sub(o->vertex[k], o->vertex[i]));
        int above = 0, below = 0;
        for (int m = 0; m < n && !(above && below); m++) {
          if (m == i || m == j || m == k) continue;
          const double h = vec_dot(normal, vec_sub(o->vertex[m], o->vertex[i]));
          above += h > 0.0, below += h < 0.0;
        }
        if (above && below) continue;
        o->triangle[o->triangles][0] = i, o->triangle[o->triangles][1] = j, o->triangle[o->triangles][2] = k;
        o->triangles++;
      }
    }
  }
}

void obstacle_make(rng *r, obstacle_kind kind, obstacle *o) {
  *o = (obstacle){.n = 0};
  const bool planar = kind == OBSTACLE_POINT || kind == OBSTACLE_POLYGON;
  vec3 centre = vec_add(vec(0.5, 0.5, planar ? 0.0 : 0.5), rng_in_cube(r, 1.0));
  if (planar) centre.z = 0.0;
  const double radius = rng_uniform(r, 0.1, 0.3);
  switch (kind) {
    case OBSTACLE_POINT:
      o->n = 1;
      o->vertex[0] = centre;
      check(cprox_body_create_point(centre, NULL, &o->body));
      return;
    case OBSTACLE_POLYGON: make_polygon(r, centre, radius, o); return;
    default:
      o->n = kind == OBSTACLE_POLYTOPE ? 8 + rng_index(r, 57) : 500;
      for (size_t i = 0; i < o->n; i++) o->vertex[i] = vec_axpy(centre, radius, rng_unit(r));
      if (kind == OBSTACLE_POLYTOPE) obstacle_find_faces(o);
  }
  check(cprox_body_create_polytope(o->vertex, o->n, NULL, &o->body));
}

void obstacle_free(obstacle *o) {
  cprox_body_free(o->body);
  free(o->triangle);
  *o = (obstacle){.n = 0};
}

/* ---- curves and obstacles ---- */

static void make_points(rng *r, size_t degree, bool planar, vec3 *points) {
  for (size_t i = 0; i <= degree; i++) {
    points[i] = vec_add(vec(0.5, 0.5, 0.5), rng_in_cube(r, 0.5));
    if (planar) points[i].z = 0.0;
  }
}

/* Problems in which curve and obstacle touch have no distance to find: drawn again. */
static bool make_problem(rng *r, obstacle_kind kind, size_t degree, cprox_workspace *ws, curve_problem *p) {
  const bool planar = kind == OBSTACLE_POINT || kind == OBSTACLE_POLYGON;
  p->degree = degree;
  make_points(r, degree, planar, p->points);
  obstacle_make(r, kind, &p->obstacle);
  check(curve_from(describe_bezier(p->points, degree + 1, 0.0, 1.0), NULL, &p->curve));
  p->target = cprox_obstacle_at(p->obstacle.body, CPROX_POSE_IDENTITY);
  cprox_result result;
  check(cprox_distance(cprox_point_along(p->curve), p->target, NULL, ws, &result));
  if (result.lower > 1e-3) {
    paper_bezier_make(p->points, degree, &p->bezier);
    p->paper = paper_bezier_curve(&p->bezier, planar);
    p->paper_obstacle = (paper_obstacle){.vertex = p->obstacle.vertex, .n = p->obstacle.n};
    return true;
  }
  obstacle_free(&p->obstacle);
  cprox_curve_free(p->curve);
  return false;
}

curve_problem *curve_problems_make(obstacle_kind kind, size_t degree, size_t n) {
  rng r = rng_seed(100 * (uint64_t)degree + (uint64_t)kind + 1);
  cprox_workspace *ws = cprox_workspace_create();
  curve_problem *problems = memory(n, sizeof *problems);
  for (size_t i = 0; i < n;) i += make_problem(&r, kind, degree, ws, &problems[i]);
  cprox_workspace_free(ws);
  return problems;
}

void curve_problems_free(curve_problem *problems, size_t n) {
  for (size_t i = 0; i < n; i++) {
    obstacle_free(&problems[i].obstacle);
    cprox_curve_free(problems[i].curve);
  }
  free(problems);
}

/* ---- exact distances ---- */

static long double distance_at(const curve_problem *p, obstacle_kind kind, long double t) {
  const vec3l x = ref_bezier(p->points, p->degree, t, 0);
  const obstacle *o = &p->obstacle;
  if (kind == OBSTACLE_POINT) return ref_norm(ref_sub(x, ref_vec(o->vertex[0])));
  if (kind == OBSTACLE_POLYGON) return ref_point_polygon(x, o->vertex, o->n);
  long double least = INFINITY;
  for (size_t i = 0; i < o->triangles; i++) {
    const int *v = o->triangle[i];
    least = fminl(least,
                  ref_point_triangle(x, ref_vec(o->vertex[v[0]]), ref_vec(o->vertex[v[1]]), ref_vec(o->vertex[v[2]])));
  }
  return least;
}

static long double refine(const curve_problem *p, obstacle_kind kind, long double a, long double b) {
  const long double ratio = 0.6180339887498949L;
  long double c = b - ratio * (b - a), d = a + ratio * (b - a);
  long double fc = distance_at(p, kind, c), fd = distance_at(p, kind, d);
  for (int i = 0; i < 80; i++) {
    if (fc < fd) {
      b = d, d = c, fd = fc, c = b - ratio * (b - a), fc = distance_at(p, kind, c);
    } else {
      a = c, c = d, fc = fd, d = a + ratio * (b - a), fd = distance_at(p, kind, d);
    }
  }
  return fminl(fc, fd);
}

double *curve_problems_truth(const curve_problem *problems, size_t n, obstacle_kind kind) {
  enum { SAMPLES = 600 };
  double *truth = memory(n, sizeof *truth);
  for (size_t i = 0; i < n; i++) {
    const curve_problem *p = &problems[i];
    truth[i] = NAN;
    if (kind == OBSTACLE_LARGE_POLYTOPE) continue;
    long double f[SAMPLES + 1], least = INFINITY;
    for (int k = 0; k <= SAMPLES; k++) least = fminl(least, f[k] = distance_at(p, kind, (long double)k / SAMPLES));
    const long double sampled = least;
    for (int k = 0; k <= SAMPLES; k++) {
      const bool valley = (k == 0 || f[k] <= f[k - 1]) && (k == SAMPLES || f[k] <= f[k + 1]);
      if (!valley || f[k] > sampled + 0.05L) continue;
      least = fminl(least, refine(p, kind, fmaxl(k - 1, 0) / SAMPLES, fminl(k + 1, SAMPLES) / SAMPLES));
    }
    truth[i] = (double)least;
  }
  return truth;
}

/* ---- pairs of curves ---- */

curve_pair *curve_pairs_make(size_t degree, bool planar, size_t n) {
  rng r = rng_seed(7000 + (uint64_t)degree + (planar ? 500 : 0));
  cprox_workspace *ws = cprox_workspace_create();
  curve_pair *pairs = memory(n, sizeof *pairs);
  for (size_t i = 0; i < n;) {
    curve_pair *p = &pairs[i];
    p->degree = degree;
    for (int k = 0; k < 2; k++) {
      make_points(&r, degree, planar, p->points[k]);
      if (k == 1)
        for (size_t j = 0; j <= degree; j++) p->points[k][j] = vec_add(p->points[k][j], vec(0.8, 0.3, 0.0));
      check(curve_from(describe_bezier(p->points[k], degree + 1, 0.0, 1.0), NULL, &p->curve[k]));
      paper_bezier_make(p->points[k], degree, &p->bezier[k]);
      p->paper[k] = paper_bezier_curve(&p->bezier[k], planar);
    }
    cprox_result result;
    check(cprox_distance(cprox_point_along(p->curve[0]), cprox_obstacle_curve(p->curve[1], 0.0), NULL, ws, &result));
    if (result.lower > 1e-3) {
      i++;
    } else {
      cprox_curve_free(p->curve[0]);
      cprox_curve_free(p->curve[1]);
    }
  }
  cprox_workspace_free(ws);
  return pairs;
}

void curve_pairs_free(curve_pair *pairs, size_t n) {
  for (size_t i = 0; i < n; i++) {
    cprox_curve_free(pairs[i].curve[0]);
    cprox_curve_free(pairs[i].curve[1]);
  }
  free(pairs);
}

/* Distance of two curve points. */
static long double apart(const curve_pair *p, long double s, long double t) {
  return ref_norm(ref_sub(ref_bezier(p->points[0], p->degree, s, 0), ref_bezier(p->points[1], p->degree, t, 0)));
}

/* A pattern search that shrinks about its best point. */
static long double refine_pair(const curve_pair *p, long double s, long double t, long double step) {
  long double best = apart(p, s, t);
  while (step > 1e-13L) {
    long double s0 = s, t0 = t;
    bool better = false;
    for (int i = -1; i <= 1; i++) {
      for (int j = -1; j <= 1; j++) {
        const long double x = fminl(fmaxl(s0 + i * step, 0), 1), y = fminl(fmaxl(t0 + j * step, 0), 1);
        const long double d = apart(p, x, y);
        if (d < best) best = d, s = x, t = y, better = true;
      }
    }
    if (!better) step *= 0.5L;
  }
  return best;
}

double *curve_pairs_truth(const curve_pair *pairs, size_t n) {
  enum { SAMPLES = 100 };
  double *truth = memory(n, sizeof *truth);
  for (size_t i = 0; i < n; i++) {
    const curve_pair *p = &pairs[i];
    vec3l x[SAMPLES + 1], y[SAMPLES + 1];
    for (int k = 0; k <= SAMPLES; k++) {
      x[k] = ref_bezier(p->points[0], p->degree, (long double)k / SAMPLES, 0);
      y[k] = ref_bezier(p->points[1], p->degree, (long double)k / SAMPLES, 0);
    }
    static long double f[SAMPLES + 1][SAMPLES + 1];
    long double least = INFINITY;
    for (int a = 0; a <= SAMPLES; a++)
      for (int b = 0; b <= SAMPLES; b++) least = fminl(least, f[a][b] = ref_norm(ref_sub(x[a], y[b])));
    const long double sampled = least;
    for (int a = 0; a <= SAMPLES; a++) {
      for (int b = 0; b <= SAMPLES; b++) {
        const bool valley = (a == 0 || f[a][b] <= f[a - 1][b]) && (a == SAMPLES || f[a][b] <= f[a + 1][b]) &&
                            (b == 0 || f[a][b] <= f[a][b - 1]) && (b == SAMPLES || f[a][b] <= f[a][b + 1]);
        if (valley && f[a][b] <= sampled + 0.05L)
          least = fminl(least, refine_pair(p, (long double)a / SAMPLES, (long double)b / SAMPLES, 0.5L / SAMPLES));
      }
    }
    truth[i] = (double)least;
  }
  return truth;
}
