/* SPDX-License-Identifier: BSD-3-Clause */
#include "query/polish.h"

enum { MAX_ROUNDS = 6, MAX_STEPS = 8 };

/* The piece at s: point and derivatives by s. */
typedef struct jet {
  vec3 x, d1, d2;
} jet;

static jet jet_at(const curve_convex *o, const double *points, double s) {
  const size_t degree = o->side.curve->degree;
  jet j;
  curve_bezier_evaluate(points, points + degree + 1, points + 2 * (degree + 1), 1, degree, o->side.curve->binomial, s,
                        &j.x, &j.d1, &j.d2);
  return j;
}

/* The distance to the feature that was nearest at the sight, as a function of s: value and two derivatives. */
typedef struct model {
  double f, f1, f2;
} model;

static bool model_flat(const curve_sight *sight, const jet *j, model *m) {
  const convex_near *near = &sight->near;
  if (near->tangents == 2) {
    /* a plane: the signed height over it, so that the deepest point is found where the curve goes through */
    *m = (model){.f = vec_dot(near->normal, vec_sub(j->x, near->origin)) - near->offset,
                 .f1 = vec_dot(near->normal, j->d1),
                 .f2 = vec_dot(near->normal, j->d2)};
    return true;
  }
  /* f = |w|, w orthogonal to the tangents: f' = n·psi', f'' = n·psi'' + (|psi'|^2 - (n·psi')^2 - sum (e·psi')^2)/|w| */
  vec3 w = vec_sub(j->x, near->origin);
  double across2 = vec_norm2(j->d1);
  for (int k = 0; k < near->tangents; k++) {
    w = vec_axpy(w, -vec_dot(near->e[k], w), near->e[k]);
    const double along = vec_dot(near->e[k], j->d1);
    across2 -= along * along;
  }
  const double r = vec_norm(w);
  if (!(r > 0.0)) return false;
  const vec3 n = vec_scale(1.0 / r, w);
  m->f = r - near->offset;
  m->f1 = vec_dot(n, j->d1);
  m->f2 = vec_dot(n, j->d2) + fmax(0.0, across2 - m->f1 * m->f1) / r;
  return true;
}

static vec3 symmetric_times(const double h[6], vec3 v) {
  return vec(h[0] * v.x + h[1] * v.y + h[2] * v.z, h[1] * v.x + h[3] * v.y + h[4] * v.z,
             h[2] * v.x + h[4] * v.y + h[5] * v.z);
}

static bool model_curved(const curve_sight *sight, const jet *j, model *m) {
  /* second order about the sight: d + n·w + w·H w/2, w = psi - y */
  const vec3 w = vec_sub(j->x, sight->y), hw = symmetric_times(sight->near.hessian, w);
  const vec3 gradient = vec_add(sight->near.normal, hw);
  m->f = sight->near.distance + vec_dot(sight->near.normal, w) + 0.5 * vec_dot(w, hw);
  m->f1 = vec_dot(gradient, j->d1);
  m->f2 = vec_dot(gradient, j->d2) + vec_dot(j->d1, symmetric_times(sight->near.hessian, j->d1));
  return isfinite(m->f) && isfinite(m->f1) && isfinite(m->f2);
}

static bool model_at(const curve_sight *sight, const jet *j, model *m) {
  return sight->near.flat ? model_flat(sight, j, m) : model_curved(sight, j, m);
}

static double clamp(double x, double least, double most) {
  return x < least ? least : x > most ? most : x;
}

/* Newton on the model from the sight's s; *j is the jet at the point returned. */
static double descend(const curve_convex *o, const double *points, const curve_sight *sight, double step, jet *j) {
  double s = sight->s;
  *j = jet_at(o, points, s);
  for (int i = 0; i < MAX_STEPS; i++) {
    model m;
    if (!model_at(sight, j, &m)) break;
    const double wanted = m.f2 > 0.0 ? -m.f1 / m.f2 : (m.f1 > 0.0 ? -step : step);
    const double next = clamp(clamp(s + wanted, s - step, s + step), o->side.part.a, o->side.part.b);
    const double moved = fabs(next - s);
    if (moved < 1e-15) break;
    s = next;
    *j = jet_at(o, points, s);
    /* quadratic convergence: what such a step leaves is below rounding */
    if (moved < 1e-9) break;
  }
  return s;
}

cprox_status polish(curve_convex *o, const double *points, double step) {
  if (o->side.curve->arcs) return CPROX_OK; /* no derivatives to go by */
  const double error = curve_side_point_error(&o->side);
  curve_sight from = o->best;
  for (int round = 0; round < MAX_ROUNDS; round++) {
    jet j;
    const double s = descend(o, points, &from, step, &j);
    if (s == from.s) return CPROX_OK;
    model predicted;
    const bool predictable = model_at(&from, &j, &predicted);

    /* only a measured distance counts */
    curve_sight sight;
    search_best bound = {.upper = INFINITY};
    const cprox_status status = curve_convex_measure(o, from.piece, s, j.x, error, &sight, &bound);
    if (status < 0) return status;
    const bool better = bound.upper < o->best_bound.upper;
    if (better) curve_convex_adopt(o, &sight, bound);
    if (o->best_bound.upper <= o->good_enough) return CPROX_OK;

    /* the feature held on to is the nearest one here too: nothing more to find */
    const bool same_feature = predictable && fabs(sight.near.distance - predicted.f) <= bound.slack + 1e-3 * o->epsilon;
    if (same_feature || (!better && round > 0)) return CPROX_OK;
    step *= 0.5;
    from = sight;
  }
  return CPROX_OK;
}
