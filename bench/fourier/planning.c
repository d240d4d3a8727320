/* SPDX-License-Identifier: BSD-3-Clause */
/* A planner's problems from many starts, most of them in contact: a solid that is placed as near to its goal as
 * obstacles allow, and a path among obstacles that is as short as they allow, in the plane and in space. What differs is
 * what tells the optimiser how free a pose is: the signed distance of convex parts, the same of superquadrics in their
 * place, the growth distance, certified gaps, signals, and sequences of these. Two optimisers solve them: a sequence of
 * quadratic programs (SLSQP) with constraints, and quasi-Newton (L-BFGS) with a penalty that grows. Whether an end is
 * free is measured by the boxes' distance, which shares no code with a gap. */
#include "fourier/parts.h"

#ifndef HAVE_NLOPT
#include <stdio.h>

void fourier_planning(const bench_size *size) {
  (void)size;
  fprintf(stderr, "fourier: without NLopt the planning problems are left out\n");
}

void fourier_smooth(const bench_size *size) {
  (void)size;
}
#else
#include <math.h>
#include <nlopt.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "curve_proximity/cprox.h"
#include "curve_proximity/cprox_fourier.h"
#include "peers/cone_growth.h"
#include "support/random.h"

enum { PARTS = 6, POINTS = 6, SAMPLES = 49, MOST = 3 * POINTS, DENSE = 400 };

/* A solid of boxes, or one ball. */
typedef struct thing {
  int n;
  cprox_body *part[PARTS], *rounded[PARTS];
  cone_body cone[PARTS];
  cprox_pose at[PARTS];
  cprox_solid *solid;
} thing;

/* How free a pose is, and its gradient: by the position in the world, by the rotation in the body's axes. */
typedef struct freedom {
  double value;
  cprox_vec3 position, rotation;
} freedom;

/* COARSE to FINE are certified gaps: 17, 33, 65 samples in the plane, 9, 17, 33 in space; the signal has 9. */
typedef enum measure {
  NONE,
  DISTANCE,
  SUPERQUADRIC,
  GROWTH,
  CONES,    /* the growth distance by a cone program */
  TILTED,   /* the mean of growth distances of TILTS turned poses */
  JITTERED, /* the mean of signed distances of JITTERS random poses beside: randomised smoothing */
  COARSE,
  MIDDLE,
  FINE,
  SIGNAL,
  GUIDE
} measure;
enum { CERTIFIED = 3, GAPS = CERTIFIED + 1 };

/* A signal leads out of where it is below this: where V is above e^-2 of its mean over all places. */
#define LEVEL 2.0

/* Samples of a path are apart by so much that between two of them a ball may come nearer by less than this [m]. */
#define PAD 0.02

/* By how much poses are turned, and moved [m, rad], where means are taken. */
enum { TILTS = 8, JITTERS = 16 };
static const double TILT = 0.02, JITTER = 0.02;

/* Below this V/t its logarithm is continued by the tangent. */
#define LEAST 0.05

typedef struct problem {
  int dimension;
  bool path;
  thing fixed, moving;
  double goal[6]; /* of a path: both ends */
  cprox_gap *gap[GAPS];
  cprox_gap_info info[GAPS];
  cprox_workspace *ws;
  measure by;
  double weight; /* of a penalty; 0: none */
} problem;

static void add_box(thing *t, int dimension, const double low[3], const double high[3]) {
  /* in the plane the boxes are high enough never to be left along z */
  const cprox_vec3 size = {high[0] - low[0], high[1] - low[1], dimension == 2 ? 8.0 : high[2] - low[2]};
  const cprox_vec3 half = {0.5 * size.x, 0.5 * size.y, 0.5 * size.z};
  t->at[t->n] = CPROX_POSE_IDENTITY;
  t->at[t->n].position =
      (cprox_vec3){0.5 * (low[0] + high[0]), 0.5 * (low[1] + high[1]), dimension == 2 ? 0.0 : 0.5 * (low[2] + high[2])};
  t->cone[t->n] = (cone_body){CONE_BOX, {half.x, half.y, half.z}};
  if (cprox_body_create_box(size, NULL, &t->part[t->n])) abort();
  if (cprox_body_create_superquadric(half, (cprox_vec3){10, 10, 10}, NULL, &t->rounded[t->n])) abort();
  t->n++;
}

static void make_solid(thing *t, int dimension) {
  cprox_solid *parts[PARTS];
  for (int i = 0; i < t->n; i++) {
    const cprox_body_info info = cprox_body_get_info(t->part[i]);
    cprox_vec3 most;
    cprox_solid_description d = {.dimension = dimension};
    if (info.kind == CPROX_BODY_SPHERE) {
      d.kind = CPROX_SOLID_BALL, d.radius = cprox_body_support(t->part[i], (cprox_vec3){1, 0, 0}, &most);
    } else {
      cprox_body_support(t->part[i], (cprox_vec3){1, 1, 1}, &most);
      d.kind = CPROX_SOLID_BOX, d.size = (cprox_vec3){2 * most.x, 2 * most.y, 2 * most.z};
    }
    if (cprox_solid_create(&d, NULL, &parts[i])) abort();
  }
  if (cprox_solid_create(
          &(cprox_solid_description){
              .kind = CPROX_SOLID_UNION, .parts = (const cprox_solid *const *)parts, .poses = t->at, .n = (size_t)t->n},
          NULL, &t->solid))
    abort();
  for (int i = 0; i < t->n; i++) cprox_solid_free(parts[i]);
}

static void make_ball(thing *t, double radius) {
  t->n = 1;
  t->at[0] = CPROX_POSE_IDENTITY;
  t->cone[0] = (cone_body){CONE_ELLIPSOID, {radius, radius, radius}};
  if (cprox_body_create_sphere(radius, NULL, &t->part[0])) abort();
  if (cprox_body_create_sphere(radius, NULL, &t->rounded[0])) abort();
}

static void free_thing(thing *t) {
  for (int i = 0; i < t->n; i++) cprox_body_free(t->part[i]), cprox_body_free(t->rounded[i]);
  cprox_solid_free(t->solid);
}

/* ---- Rotations ---- */

static cprox_vec3 cross(cprox_vec3 a, cprox_vec3 b) {
  return (cprox_vec3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

static cprox_vec3 add(cprox_vec3 a, double s, cprox_vec3 b) {
  return (cprox_vec3){a.x + s * b.x, a.y + s * b.y, a.z + s * b.z};
}

static cprox_vec3 turn(cprox_quat q, double sign, cprox_vec3 v) {
  const cprox_vec3 u = {sign * q.x, sign * q.y, sign * q.z}, t = cross(u, v);
  return add(add(v, 2 * q.w, t), 2.0, cross(u, t));
}

static cprox_quat exponential(cprox_vec3 r) {
  const double angle = sqrt(r.x * r.x + r.y * r.y + r.z * r.z), s = angle > 1e-9 ? sin(0.5 * angle) / angle : 0.5;
  return (cprox_quat){cos(0.5 * angle), s * r.x, s * r.y, s * r.z};
}

/* By the rotation vector r, of a gradient by a turn in the axes of the body that exp(r) has turned. */
static cprox_vec3 by_vector(cprox_vec3 r, cprox_vec3 g) {
  const double a2 = r.x * r.x + r.y * r.y + r.z * r.z, a = sqrt(a2);
  const double c = a > 1e-4 ? (1 - cos(a)) / a2 : 0.5, s = a > 1e-4 ? (a - sin(a)) / (a2 * a) : 1.0 / 6.0;
  const cprox_vec3 rg = cross(r, g);
  return add(add(g, c, rg), s, cross(r, rg));
}

static cprox_pose compose(const cprox_pose *p, const cprox_pose *q) {
  const cprox_quat a = p->orientation, b = q->orientation;
  return (cprox_pose){
      .position = add(p->position, 1.0, turn(a, 1.0, q->position)),
      .orientation = {a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z, a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
                      a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x, a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w}};
}

/* ---- How free a pose is ---- */

static freedom by_pairs(problem *p, measure by, const cprox_pose *pose) {
  freedom least = {.value = INFINITY};
  for (int i = 0; i < p->fixed.n; i++)
    for (int j = 0; j < p->moving.n; j++) {
      cprox_body *const *a = by == SUPERQUADRIC ? p->fixed.rounded : p->fixed.part, *const *b = by == SUPERQUADRIC
                                                                                                    ? p->moving.rounded
                                                                                                    : p->moving.part;
      const cprox_obstacle first = cprox_obstacle_at(a[i], p->fixed.at[i]),
                           second = cprox_obstacle_at(b[j], compose(pose, &p->moving.at[j]));
      if (by == CONES) {
        const cone_answer c = cone_growth(&p->fixed.cone[i], &first.pose, &p->moving.cone[j], &second.pose);
        if (!c.solved || !(c.value - 1.0 < least.value)) continue;
        const cprox_vec3 arm = add(c.touch, -1.0, pose->position);
        least = (freedom){c.value - 1.0, c.by_b, turn(pose->orientation, -1.0, cross(arm, c.by_b))};
      } else if (by == GROWTH) {
        cprox_growth g;
        cprox_growth_derivatives d;
        if (cprox_growth_gradient(first, second, NULL, p->ws, &g, &d) < 0) continue;
        const double value = 0.5 * (g.lower + g.upper) - 1.0;
        if (!(value < least.value)) continue;
        /* those of the part are about its own position */
        const cprox_vec3 arm = add(second.pose.position, -1.0, pose->position);
        least = (freedom){value, d.b_position,
                          turn(pose->orientation, -1.0, add(d.b_rotation, 1.0, cross(arm, d.b_position)))};
      } else {
        cprox_result r;
        if (cprox_pair(first, second, NULL, p->ws, &r) < 0) abort();
        const double value = 0.5 * (r.lower + r.upper);
        if (!(value < least.value)) continue;
        const cprox_vec3 arm = add(r.witness_obstacle, -1.0, pose->position),
                         n = add((cprox_vec3){0, 0, 0}, -1.0, r.normal);
        least = (freedom){value, n, turn(pose->orientation, -1.0, cross(arm, n))};
      }
    }
  return least;
}

/* The mean over poses that are moved and turned in their own axes by the given steps: the same at every call. */
static freedom mean_of(problem *p, measure by, const cprox_pose *pose, int n, double shift, double angle) {
  rng r = rng_seed(831);
  freedom sum = {.value = 0.0};
  for (int i = 0; i < n; i++) {
    const cprox_vec3 zero = {0, 0, 0}, v = rng_unit(&r),
                     w = p->dimension == 2 ? (cprox_vec3){0, 0, i % 2 ? 1 : -1} : rng_unit(&r);
    const double far = rng_uniform(&r, 0.0, 1.0), turned = p->dimension == 2 ? angle * (1 + i / 2) * 2.0 / n : angle;
    cprox_vec3 step = add(zero, shift * far, v);
    if (p->dimension == 2) step.z = 0.0;
    const cprox_pose by_step = {step, exponential(add(zero, turned, w))}, near = compose(pose, &by_step);
    const freedom f = by_pairs(p, by, &near);
    /* of the step's turned axes, and of a turn about the pose's own origin */
    const cprox_vec3 local = turn(pose->orientation, -1.0, f.position),
                     about = add(turn(by_step.orientation, 1.0, f.rotation), 1.0, cross(step, local));
    sum.value += f.value / n;
    sum.position = add(sum.position, 1.0 / n, f.position);
    sum.rotation = add(sum.rotation, 1.0 / n, about);
  }
  return sum;
}

static freedom scaled(double value, double by, const cprox_gap_result *r) {
  const cprox_vec3 zero = {0, 0, 0};
  return (freedom){value, add(zero, by, r->position_b), add(zero, by, r->rotation_b)};
}

/* In metres. */
static freedom by_gap(problem *p, int k, const cprox_pose *pose) {
  static const cprox_pose here = {.orientation = {.w = 1}};
  const cprox_gap_info *info = &p->info[k];
  cprox_gap_result r;
  if (cprox_gap_evaluate(p->gap[k], &here, pose, p->ws, &r) < CPROX_OK) abort();
  if (r.verdict == CPROX_GAP_VERDICT_FAR) return (freedom){.value = 10.0};
  if (info->mode == CPROX_GAP_MODE_SIGNAL) return scaled(info->length * (r.value - LEVEL), info->length, &r);
  const double v = fmax(r.value, LEAST);
  return scaled(-info->length * (log(v) + (r.value < LEAST ? r.value / LEAST - 1.0 : 0.0)), -info->length / v, &r);
}

static double rise(double x, double *slope) {
  const double y = fmin(fmax(x, 0.0), 1.0);
  *slope = 6.0 * y * (1.0 - y);
  return y * y * (3.0 - 2.0 * y);
}

static freedom mixed(double a, freedom x, double b, freedom y, double value) {
  const cprox_vec3 zero = {0, 0, 0};
  return (freedom){value, add(add(zero, a, x.position), b, y.position), add(add(zero, a, x.rotation), b, y.rotation)};
}

/* The mode guide of the provider: the distance apart, in an overlap gaps, the coarser the deeper. */
static freedom guided(problem *p, const cprox_pose *pose) {
  enum { FINEST = CERTIFIED - 1 };
  const freedom exact = by_pairs(p, DISTANCE, pose);
  if (exact.value >= 0.0) return exact;
  freedom stage[FINEST + 1];
  double sample[FINEST + 1];
  int last = 0;
  for (;; last++) {
    stage[last] = by_gap(p, last, pose);
    sample[last] = p->info[last].period / p->info[last].samples;
    if (last == FINEST || stage[last].value <= -2.0 * sample[last]) break;
  }
  freedom all = stage[last];
  for (int k = last; k-- > 0;) {
    double slope;
    const double fine = rise(stage[k].value / sample[k] + 2.0, &slope), apart = all.value - stage[k].value;
    all = mixed(1.0 - fine + apart * slope / sample[k], stage[k], fine, all, stage[k].value + fine * apart);
  }
  double slope;
  const double length = p->info[FINEST].period / p->info[FINEST].samples,
               near = rise(1.0 + exact.value / length, &slope), apart = exact.value - all.value;
  return mixed(1.0 - near, all, near + apart * slope / length, exact, all.value + near * apart);
}

static freedom free_of(problem *p, const cprox_pose *pose) {
  switch (p->by) {
    case COARSE:
    case MIDDLE:
    case FINE: return by_gap(p, (int)p->by - COARSE, pose);
    case SIGNAL: return by_gap(p, CERTIFIED, pose);
    case GUIDE: return guided(p, pose);
    case TILTED: return mean_of(p, GROWTH, pose, TILTS, 0.0, TILT);
    case JITTERED: return mean_of(p, DISTANCE, pose, JITTERS, JITTER, JITTER);
    default: return by_pairs(p, p->by, pose);
  }
}

/* ---- Unknowns ---- */

static int unknowns(const problem *p) {
  return p->path ? p->dimension * POINTS : p->dimension == 2 ? 3 : 6;
}

/* The cubic B-spline of 8 points with clamped ends, at t of [0, 1]. */
static void spline_weights(double t, double w[POINTS + 2]) {
  enum { N = POINTS + 2, K = 4 };
  static const double knots[N + K] = {0, 0, 0, 0, 0.2, 0.4, 0.6, 0.8, 1, 1, 1, 1};
  double b[N + K - 1] = {0};
  int span = 3;
  while (span < N - 1 && t >= knots[span + 1]) span++;
  b[span] = 1.0;
  for (int d = 1; d < K; d++)
    for (int i = 0; i < N + K - 1 - d; i++) {
      const double l = knots[i + d] - knots[i], r = knots[i + d + 1] - knots[i + 1];
      b[i] = (l > 0 ? (t - knots[i]) / l * b[i] : 0) + (r > 0 ? (knots[i + d + 1] - t) / r * b[i + 1] : 0);
    }
  for (int i = 0; i < N; i++) w[i] = b[i];
}

static cprox_pose pose_at(const problem *p, const double *x, double t, double w[POINTS + 2]) {
  cprox_pose pose = CPROX_POSE_IDENTITY;
  if (!p->path) {
    pose.position = (cprox_vec3){x[0], x[1], p->dimension == 2 ? 0 : x[2]};
    pose.orientation = exponential(p->dimension == 2 ? (cprox_vec3){0, 0, x[2]} : (cprox_vec3){x[3], x[4], x[5]});
    return pose;
  }
  spline_weights(t, w);
  double at[3] = {0, 0, 0};
  for (int j = 0; j < p->dimension; j++) {
    at[j] = w[0] * p->goal[j] + w[POINTS + 1] * p->goal[3 + j];
    for (int i = 0; i < POINTS; i++) at[j] += w[i + 1] * x[p->dimension * i + j];
  }
  pose.position = (cprox_vec3){at[0], at[1], at[2]};
  return pose;
}

static double objective(const problem *p, const double *x, double *g) {
  const int n = unknowns(p);
  for (int i = 0; i < n && g; i++) g[i] = 0;
  double sum = 0.0;
  if (!p->path) {
    for (int i = 0; i < n; i++) {
      const double weight = i < p->dimension ? 1.0 : 0.1, d = x[i] - p->goal[i];
      sum += weight * d * d;
      if (g) g[i] = 2 * weight * d;
    }
    return sum;
  }
  for (int i = 0; i <= POINTS; i++)
    for (int j = 0; j < p->dimension; j++) {
      const double from = i == 0 ? p->goal[j] : x[p->dimension * (i - 1) + j],
                   to = i == POINTS ? p->goal[3 + j] : x[p->dimension * i + j], d = to - from;
      sum += d * d;
      if (g && i > 0) g[p->dimension * (i - 1) + j] -= 2 * d;
      if (g && i < POINTS) g[p->dimension * i + j] += 2 * d;
    }
  return sum;
}

/* How free sample i of the problem is; the gradient by the unknowns. */
static double freedom_at(problem *p, const double *x, int i, double *g) {
  double w[POINTS + 2];
  const cprox_pose pose = pose_at(p, x, (i + 1.0) / (SAMPLES + 1.0), w);
  const freedom f = free_of(p, &pose);
  const double by[3] = {f.position.x, f.position.y, f.position.z};
  if (!g) return f.value;
  if (p->path) {
    for (int k = 0; k < POINTS; k++)
      for (int j = 0; j < p->dimension; j++) g[p->dimension * k + j] = w[k + 1] * by[j];
  } else if (p->dimension == 2) {
    g[0] = by[0], g[1] = by[1], g[2] = f.rotation.z;
  } else {
    const cprox_vec3 r = by_vector((cprox_vec3){x[3], x[4], x[5]}, f.rotation);
    for (int j = 0; j < 3; j++) g[j] = by[j];
    g[3] = r.x, g[4] = r.y, g[5] = r.z;
  }
  return f.value;
}

static int samples_of(const problem *p) {
  return p->path ? SAMPLES : 1;
}

static void constraints(unsigned m, double *result, unsigned n, const double *x, double *gradient, void *data) {
  problem *p = data;
  for (unsigned i = 0; i < m; i++) {
    result[i] = -freedom_at(p, x, (int)i, gradient ? gradient + i * n : NULL);
    for (unsigned j = 0; j < n && gradient; j++) gradient[i * n + j] = -gradient[i * n + j];
  }
}

static double cost(unsigned n, const double *x, double *gradient, void *data) {
  problem *p = data;
  double sum = objective(p, x, gradient), g[MOST];
  for (int i = 0; p->weight > 0.0 && i < samples_of(p); i++) {
    const double v = fmin(0.0, freedom_at(p, x, i, g)), w = p->weight / samples_of(p);
    sum += w * v * v;
    for (unsigned j = 0; gradient && j < n; j++) gradient[j] += 2 * w * v * g[j];
  }
  return sum;
}

/* By constraints (SLSQP), or by a penalty of this weight for each square metre of violation (L-BFGS). */
static void solve(problem *p, measure by, double weight, double *x) {
  const unsigned n = (unsigned)unknowns(p);
  double least, tolerance[SAMPLES];
  for (int i = 0; i < SAMPLES; i++) tolerance[i] = 1e-6;
  p->by = by, p->weight = weight;
  const bool constrained = weight == 0.0 && by != NONE;
  nlopt_opt solver = nlopt_create(constrained ? NLOPT_LD_SLSQP : NLOPT_LD_LBFGS, n);
  nlopt_set_min_objective(solver, cost, p);
  if (constrained) nlopt_add_inequality_mconstraint(solver, (unsigned)samples_of(p), constraints, p, tolerance);
  nlopt_set_xtol_rel(solver, 1e-6);
  nlopt_set_ftol_rel(solver, 1e-8);
  nlopt_set_maxeval(solver, 200);
  nlopt_optimize(solver, x, &least);
  nlopt_destroy(solver);
}

/* The least exact distance over the end of a run. */
static double clearance(problem *p, const double *x) {
  double least = INFINITY, w[POINTS + 2];
  for (int i = 0; i <= (p->path ? DENSE : 0); i++) {
    const cprox_pose pose = pose_at(p, x, (double)i / DENSE, w);
    least = fmin(least, by_pairs(p, DISTANCE, &pose).value);
  }
  return least;
}

/* What leads first, in order; the distance comes last, but where a method is alone. */
enum { STAGES = 4 };
typedef struct recipe {
  const char *name;
  int n;
  measure by[STAGES];
} recipe;

static const recipe RECIPES[] = {
    {"signed distance", 1, {DISTANCE}},
    {"superquadrics; then distance", 2, {SUPERQUADRIC, DISTANCE}},
    {"growth distance; then distance", 2, {GROWTH, DISTANCE}},
    {"no obstacle; then distance", 2, {NONE, DISTANCE}},
    {"finest gap", 1, {FINE}},
    {"signal; then distance", 2, {SIGNAL, DISTANCE}},
    {"gaps from coarse to fine; then distance", 4, {COARSE, MIDDLE, FINE, DISTANCE}},
    {"guide", 1, {GUIDE}},
};

/* What of these is smooth, and how others measure it. */
static const recipe SMOOTH[] = {
    {"signed distance", 1, {DISTANCE}},
    {"growth distance; then distance", 2, {GROWTH, DISTANCE}},
    {"growth by a cone program; then distance", 2, {CONES, DISTANCE}},
    {"growth of 8 tilts; then distance", 2, {TILTED, DISTANCE}},
    {"randomised smoothing; then distance", 2, {JITTERED, DISTANCE}},
};
enum { N_RECIPES = sizeof RECIPES / sizeof *RECIPES, N_SMOOTH = sizeof SMOOTH / sizeof *SMOOTH };

/* Penalties grow. A stage that leads begins and ends with weights that let the next one correct it. */
static const double LEADING[] = {10, 100}, FINAL[] = {10, 100, 1e3, 1e4, 1e6};

static void follow(problem *p, const recipe *how, bool by_penalties, double *x) {
  for (int k = 0; k < how->n; k++) {
    const bool leads = k + 1 < how->n;
    if (!by_penalties || how->by[k] == NONE) {
      solve(p, how->by[k], leads && how->by[k] == SIGNAL ? 10.0 : 0.0, x);
      continue;
    }
    const double *weights = leads ? LEADING : FINAL;
    const size_t n = leads ? sizeof LEADING / sizeof *LEADING : sizeof FINAL / sizeof *FINAL;
    for (size_t i = how->n > 1 && !leads ? 2 : 0; i < n; i++) solve(p, how->by[k], weights[i], x);
  }
}

/* A shelf of three or four boxes, and a part of two whose place is a third of a metre within its floor. */
static void make_placing(problem *p) {
  const int d = p->dimension;
  add_box(&p->fixed, d, (double[]){-0.8, -0.3, -0.6}, (double[]){0.8, 0.0, 0.6});
  add_box(&p->fixed, d, (double[]){-0.8, 0.0, -0.6}, (double[]){-0.5, 0.9, 0.6});
  add_box(&p->fixed, d, (double[]){0.5, 0.0, -0.6}, (double[]){0.8, 0.9, 0.6});
  if (d == 3) add_box(&p->fixed, d, (double[]){-0.8, -0.3, -0.9}, (double[]){0.8, 0.9, -0.6});
  add_box(&p->moving, d, (double[]){-0.4, -0.3, -0.4}, (double[]){0.4, 0.0, 0.4});
  add_box(&p->moving, d, (double[]){-0.4, 0.0, -0.4}, (double[]){-0.1, 0.5, 0.4});
  p->goal[1] = 0.3 - 0.35;
}

/* Six boxes at random between both ends of a path. */
static void make_path(problem *p, unsigned scene) {
  rng r = rng_seed(830 + scene);
  for (int i = 0; i < PARTS; i++) {
    double low[3], high[3];
    for (int j = 0; j < 3; j++) {
      const double middle = rng_uniform(&r, -0.9, 0.9), half = rng_uniform(&r, 0.1, j == 0 ? 0.25 : 0.5);
      low[j] = middle - half, high[j] = middle + half;
    }
    add_box(&p->fixed, p->dimension, low, high);
  }
  make_ball(&p->moving, 0.1 + PAD);
  p->goal[0] = -1.4, p->goal[3] = 1.4;
}

static void make_problem(problem *p, int dimension, bool path, unsigned scene, bool gaps, cprox_workspace *ws) {
  *p = (problem){.ws = ws, .dimension = dimension, .path = path};
  const int d = dimension;
  if (path)
    make_path(p, scene);
  else
    make_placing(p);
  make_solid(&p->fixed, d);
  make_solid(&p->moving, d);
  for (int k = 0; k < GAPS && gaps; k++) {
    cprox_gap_options o = CPROX_GAP_OPTIONS_DEFAULT;
    o.mode = k == CERTIFIED ? CPROX_GAP_MODE_SIGNAL : CPROX_GAP_MODE_CERTIFIED;
    const uint32_t samples[GAPS] = {d == 2 ? 17 : 9, d == 2 ? 33 : 17, d == 2 ? 65 : 33, 9};
    o.samples = samples[k];
    if (cprox_gap_create(p->fixed.solid, p->moving.solid, &o, ws, &p->gap[k])) abort();
    p->info[k] = cprox_gap_get_info(p->gap[k]);
  }
}

static void start(const problem *p, rng *r, double *x) {
  const int n = unknowns(p), d = p->dimension;
  for (int i = 0; i < n; i++) x[i] = rng_uniform(r, -1.2, 1.2);
  if (!p->path)
    for (int i = d; i < n; i++) x[i] = rng_uniform(r, -1.5, 1.5);
  else
    for (int i = 0; i < POINTS; i++)
      x[d * i] = p->goal[0] + (p->goal[3] - p->goal[0]) * (i + 1.0) / (POINTS + 1.0) + rng_uniform(r, -0.2, 0.2);
}

/* How many starts end free, and how many of these near the best that any method has found there. */
typedef struct tally {
  double seconds;
  size_t starts, free, near;
} tally;

/* From the same starts for all. */
static void compare(problem *p, const recipe *recipes, int n, bool by_penalties, unsigned scene, size_t starts,
                    tally *sum) {
  double *found = calloc((size_t)n * starts, sizeof *found), best = INFINITY;
  if (!found) abort();
  for (int m = 0; m < n; m++) {
    rng r = rng_seed(83 + scene);
    const double begin = bench_thread_seconds();
    for (size_t i = 0; i < starts; i++) {
      double x[MOST];
      start(p, &r, x);
      follow(p, &recipes[m], by_penalties, x);
      const bool is_free = clearance(p, x) >= -(p->path ? PAD : 1e-3);
      found[(size_t)m * starts + i] = is_free ? objective(p, x, NULL) : (double)INFINITY;
      best = fmin(best, found[(size_t)m * starts + i]);
    }
    sum[m].seconds += bench_thread_seconds() - begin;
  }
  for (int m = 0; m < n; m++)
    for (size_t i = 0; i < starts; i++) {
      const double x = found[(size_t)m * starts + i];
      sum[m].starts++, sum[m].free += isfinite(x), sum[m].near += x <= 1.1 * best;
    }
  free(found);
}

/* The placing problems, or all of them, by these recipes: rows of workloads `what`. */
static void plan_all(const bench_size *size, const char *what, const recipe *recipes, int n, bool all) {
  static const char *const names[2][2] = {{"an L into a U", "a prism into a bracket"},
                                          {"a disc's path", "a ball's path"}};
  cprox_workspace *ws = cprox_workspace_create();
  const size_t starts = size->problems < 50 ? size->problems : 50;
  for (int path = 0; path < (all ? 2 : 1); path++)
    for (int dimension = 2; dimension <= 3; dimension++) {
      const unsigned scenes = path ? 10 : 1;
      tally sum[2][N_RECIPES] = {0};
      for (unsigned scene = 0; scene < scenes; scene++) {
        problem p;
        make_problem(&p, dimension, path, scene, all, ws);
        for (int k = 0; k < 2; k++) compare(&p, recipes, n, k == 1, scene, (starts + scenes - 1) / scenes, sum[k]);
        for (int k = 0; k < GAPS; k++) cprox_gap_free(p.gap[k]);
        free_thing(&p.fixed), free_thing(&p.moving);
      }
      for (int k = 0; k < 2; k++)
        for (int m = 0; m < n; m++) {
          const tally *t = &sum[k][m];
          const double tried = (double)t->starts, us = 1e6 * t->seconds / tried;
          char workload[80];
          snprintf(workload, sizeof workload, "%s: %s by %s", what, names[path][dimension - 2],
                   k ? "penalties" : "constraints");
          /* the last number: the share of starts that do not end so */
          fourier_row(workload, recipes[m].name, "free", us, (double)t->free, 1.0 - (double)t->free / tried, 0, 0);
          fourier_row(workload, recipes[m].name, "near the best", us, (double)t->near, 1.0 - (double)t->near / tried, 0,
                      0);
        }
    }
  cprox_workspace_free(ws);
}

void fourier_planning(const bench_size *size) {
  plan_all(size, "planning", RECIPES, N_RECIPES, true);
}

void fourier_smooth(const bench_size *size) {
  _Static_assert(N_SMOOTH <= N_RECIPES, "a tally has room for all");
  plan_all(size, "smooth", SMOOTH, N_SMOOTH, false);
}
#endif
