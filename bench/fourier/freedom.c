/* SPDX-License-Identifier: BSD-3-Clause */
#include "fourier/freedom.h"

#include <math.h>
#include <stdlib.h>

#include "support/random.h"

/* A signal leads out of where it is below this: where V is above e^-2 of its mean over all places. */
#define LEVEL 2.0

/* By how much poses are turned, and moved [m, rad], where means are taken. */
enum { TILTS = 8, JITTERS = 16 };
static const double TILT = 0.02, JITTER = 0.02;

/* Below this V/t its logarithm is continued by the tangent. */
#define LEAST 0.05

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

cprox_quat rotation_exponential(cprox_vec3 r) {
  const double angle = sqrt(r.x * r.x + r.y * r.y + r.z * r.z), s = angle > 1e-9 ? sin(0.5 * angle) / angle : 0.5;
  return (cprox_quat){cos(0.5 * angle), s * r.x, s * r.y, s * r.z};
}

cprox_vec3 rotation_by_vector(cprox_vec3 r, cprox_vec3 g) {
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

freedom freedom_by_pairs(problem *p, measure by, const cprox_pose *pose) {
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
    const cprox_pose by_step = {step, rotation_exponential(add(zero, turned, w))}, near = compose(pose, &by_step);
    const freedom f = freedom_by_pairs(p, by, &near);
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
  const freedom exact = freedom_by_pairs(p, DISTANCE, pose);
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

freedom freedom_of(problem *p, const cprox_pose *pose) {
  switch (p->by) {
    case COARSE:
    case MIDDLE:
    case FINE: return by_gap(p, (int)p->by - COARSE, pose);
    case SIGNAL: return by_gap(p, CERTIFIED, pose);
    case GUIDE: return guided(p, pose);
    case TILTED: return mean_of(p, GROWTH, pose, TILTS, 0.0, TILT);
    case JITTERED: return mean_of(p, DISTANCE, pose, JITTERS, JITTER, JITTER);
    default: return freedom_by_pairs(p, p->by, pose);
  }
}
