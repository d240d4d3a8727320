/* SPDX-License-Identifier: BSD-3-Clause */
/* Curves that are absolutely continuous and no smoother, past a square: kinks, a speed that is infinite at one place,
 * and infinitely many turns about one place. All that is known of them is a point for each parameter and a bound of the
 * length between two. The nearest place is the rough one, and its distance is known. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "stability/hard.h"

enum { KINKS = 7 };
static const double EPSILON = 1e-9;

typedef enum roughness { ZIGZAG, INFINITE_SPEED, TURNS } roughness;

static const struct {
  const char *name;
  roughness of;
} ROUGH[] = {{"kinks", ZIGZAG}, {"infinite speed", INFINITE_SPEED}, {"infinitely many turns", TURNS}};
enum { N_ROUGH = sizeof ROUGH / sizeof *ROUGH };

/* On [0, 1]: of a zigzag the corners, one at each of the parameters; else the place that is rough. */
typedef struct rough {
  roughness of;
  double at[KINKS + 1], x[KINKS + 1], y[KINKS + 1];
  double place, truth, slope;
  cprox_curve *curve;
  cprox_body *square;
  const tools *tools;
} rough;

static const vec3 SQUARE[4] = {{-1.0, -1.0, 0.0}, {1.0, -1.0, 0.0}, {1.0, 0.0, 0.0}, {-1.0, 0.0, 0.0}};

static int leg_of(const rough *c, double t) {
  int i = 0;
  while (i + 1 < KINKS && t > c->at[i + 1]) i++;
  return i;
}

static vec3 point_of(const void *self, double t) {
  const rough *c = self;
  const double s = t - c->place;
  if (c->of == INFINITE_SPEED) return vec(c->slope * s, c->truth + sqrt(fabs(s)), 0.0);
  if (c->of == TURNS)
    return vec(c->slope * s, c->truth + (s == 0.0 ? 0.0 : fabs(s) * (1.5 + sin(3.0 * log(fabs(s))))), 0.0);
  const int i = leg_of(c, t);
  const double part = (t - c->at[i]) / (c->at[i + 1] - c->at[i]);
  return vec((1.0 - part) * c->x[i] + part * c->x[i + 1], (1.0 - part) * c->y[i] + part * c->y[i + 1], 0.0);
}

/* The integral of a bound of the square of the speed, from 0 to t: of the zigzag the square itself, of the turns by
 * |y'| <= 1.5 + sqrt(10) < 5; infinite where the speed's square has no integral. */
static double energy_of(const void *self, double t) {
  const rough *c = self;
  if (c->of == INFINITE_SPEED) return t > 0.0 ? (double)INFINITY : 0.0;
  if (c->of == TURNS) return t * (c->slope * c->slope + 25.0);
  double sum = 0.0;
  for (int i = 0; i < KINKS; i++) {
    const double dx = c->x[i + 1] - c->x[i], dy = c->y[i + 1] - c->y[i], dt = c->at[i + 1] - c->at[i];
    const double part = fmin(fmax(t - c->at[i], 0.0), dt);
    sum += part * (dx * dx + dy * dy) / (dt * dt);
  }
  return sum;
}

static void known_point(void *user, double t, vec3 *point) {
  *point = point_of(user, t);
}

/* Lemma 1's bound; where the speed is infinite, how far x and y go. */
static double known_length(void *user, double a, double b) {
  const rough *c = user;
  if (c->of == INFINITE_SPEED) {
    const double low = sqrt(fabs(a - c->place)), high = sqrt(fabs(b - c->place));
    const double y = a < c->place && b > c->place ? low + high : fabs(high - low);
    return (c->slope * (b - a) + y) * (1.0 + 1e-15) + 1e-16;
  }
  return sqrt((b - a) * (energy_of(c, b) - energy_of(c, a) + 1e-14)) * (1.0 + 1e-15);
}

static void make_rough(rng *r, roughness of, const tools *t, rough *c) {
  *c = (rough){.of = of, .tools = t, .truth = rng_uniform(r, 0.05, 0.2), .slope = rng_uniform(r, 0.2, 0.8)};
  c->place = rng_uniform(r, 0.2, 0.8);
  const int least = 1 + (int)rng_uniform(r, 0.0, KINKS - 1.001);
  for (int i = 0; i <= KINKS; i++) {
    c->at[i] = i == 0 ? 0.0 : i == KINKS ? 1.0 : (i + rng_uniform(r, -0.4, 0.4)) / KINKS;
    c->x[i] = rng_uniform(r, -0.9, 0.9);
    c->y[i] = c->truth + (i == least ? 0.0 : rng_uniform(r, 0.01, 1.0));
  }
  const cprox_rectifiable_curve functions = {.point = known_point, .length = known_length, .user = c, .error = 1e-15};
  const cprox_curve_description d = {.kind = CPROX_CURVE_RECTIFIABLE, .t1 = 1.0, .rectifiable = &functions};
  if (cprox_curve_create(&d, NULL, &c->curve) < 0) exit(1);
  if (cprox_body_create_polytope(SQUARE, 4, NULL, &c->square) < 0) exit(1);
}

static void judge(const rough *c, bool ended, double lower, double upper, bench_answer *a) {
  const double slack = 4e-15;
  const bool contains = lower <= c->truth + slack && upper >= c->truth - slack;
  a->lower = a->upper = NAN;
  a->wrong = !contains || (ended && !(upper - lower <= EPSILON + slack));
  a->failed = !a->wrong && !ended;
}

static void ours(const void *problems, size_t i, void *state, bench_answer *a) {
  (void)state;
  const rough *c = (const rough *)problems + i;
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.epsilon = EPSILON;
  cprox_result r = {.status = CPROX_INVALID};
  cprox_distance(cprox_point_along(c->curve), cprox_obstacle_at(c->square, CPROX_POSE_IDENTITY), &options,
                 c->tools->workspace, &r);
  *a = (bench_answer){.nodes = r.nodes, .distance_queries = r.distance_queries};
  judge(c, r.status == CPROX_OK, r.lower, r.upper, a);
}

static void paper(const void *problems, size_t i, void *state, bench_answer *a) {
  (void)state;
  const rough *c = (const rough *)problems + i;
  const paper_curve curve = {.t1 = 1.0, .planar = true, .self = c, .point = point_of, .energy = energy_of};
  const paper_obstacle obstacle = {.vertex = SQUARE, .n = 4};
  const paper_query q = {.query_type = PAPER_DISTANCE, .epsilon = EPSILON, .max_nodes = 20000};
  paper_answer r = {.lower = 0.0, .upper = INFINITY}; /* it has no bound where the energy has no end */
  if (isfinite(energy_of(c, 1.0))) paper_search(&curve, &obstacle, &q, c->tools->heap, &r);
  *a = (bench_answer){.nodes = r.nodes, .distance_queries = r.evaluations};
  judge(c, r.ended, r.lower, r.upper, a);
}

static void sampling(const void *problems, size_t i, void *state, bench_answer *a) {
  enum { SAMPLES = 1000 };
  (void)state;
  const rough *c = (const rough *)problems + i;
  double least = INFINITY;
  for (size_t k = 0; k <= SAMPLES; k++)
    least = fmin(least, cprox_body_nearest(c->square, point_of(c, (double)k / SAMPLES), NULL));
  *a = (bench_answer){.nodes = SAMPLES};
  judge(c, true, least, least, a);
}

void stability_rough(const bench_size *size, uint64_t seed, tools *t) {
  rough *problems = calloc(size->problems, sizeof *problems);
  if (!problems) exit(1);
  for (int k = 0; k < N_ROUGH; k++) {
    if (!bench_wanted(size, ROUGH[k].name)) continue;
    rng r = rng_seed(seed + (uint64_t)k);
    for (size_t i = 0; i < size->problems; i++) make_rough(&r, ROUGH[k].of, t, &problems[i]);
    char parameter[48];
    snprintf(parameter, sizeof parameter, "%zu cases seed %llu", size->problems,
             (unsigned long long)seed + (unsigned)k);
    const bench_workload w = {
        .group = "stability", .name = ROUGH[k].name, .parameter = parameter, .problems = problems, .n = size->problems};
    const bench_method methods[3] = {
        {"curve_proximity", ours, NULL}, {"paper", paper, NULL}, {"sampling at 1000 points", sampling, NULL}};
    bench_measure(&w, size, methods, 3);
    for (size_t i = 0; i < size->problems; i++) {
      cprox_curve_free(problems[i].curve);
      cprox_body_free(problems[i].square);
    }
  }
  free(problems);
}
