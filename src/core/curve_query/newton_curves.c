/* SPDX-License-Identifier: BSD-3-Clause */
#include "curve_query/newton_curves.h"

#include "curve_query/newton_steps.h"

enum { MAX_STEPS = 16 };

/* The squared sine of an angle below which chords are parallel: less is the rounding of their products. */
#define PARALLEL 1e-14

/* The square of a gap, by that of the chords' lengths, whose direction is noise: the rounding of points, squared. */
#define NO_GAP 1e-24

/* Parallel tangents: so much is added to the squares of the speeds that the system stays regular. */
#define REGULAR 1e-9

static double clamp(double x, double least, double most) {
  return x < least ? least : x > most ? most : x;
}

vec3 newton_curves_of_chords(const vec3 first[2], const vec3 second[2], double fraction[2]) {
  const vec3 d = vec_sub(first[1], first[0]), e = vec_sub(second[1], second[0]), r = vec_sub(first[0], second[0]);
  const double dd = vec_norm2(d), ee = vec_norm2(e), de = vec_dot(d, e), dr = vec_dot(d, r), er = vec_dot(e, r);

  /* the nearest points of the lines, then of the segments (C. Ericson, Real-Time Collision Detection, 2005, 5.1.9);
   * parallel ones meet at their middle */
  const double determinant = dd * ee - de * de;
  double s = determinant > PARALLEL * dd * ee ? clamp((de * er - dr * ee) / determinant, 0.0, 1.0) : 0.5;
  double t = ee > 0.0 ? (de * s + er) / ee : 0.5;
  if (t < 0.0 || t > 1.0) {
    t = clamp(t, 0.0, 1.0);
    s = dd > 0.0 ? clamp((de * t - dr) / dd, 0.0, 1.0) : 0.5;
  }
  fraction[0] = s;
  fraction[1] = t;

  vec3 n = vec_sub(vec_axpy(first[0], s, d), vec_axpy(second[0], t, e));
  if (vec_norm2(n) <= NO_GAP * (dd + ee)) n = vec_cross(d, e);
  const double length = vec_norm(n);
  return length > 0.0 ? vec_scale(1.0 / length, n) : vec(0, 0, 0);
}

/* Point and derivatives of a side's loaded piece. */
typedef struct jet {
  vec3 x, d1, d2;
} jet;

static jet jet_at(const curve_side *side, double s) {
  const size_t degree = side->curve->degree;
  const double *points = points_pool_at(side->pool, side->root_slot);
  jet j;
  curve_bezier_evaluate(points, points + degree + 1, points + 2 * (degree + 1), 1, degree, curve_binomial(side->curve),
                        s, &j.x, &j.d1, &j.d2);
  return j;
}

/* A parameter at an end of its range stays there while the distance falls outwards. */
static bool is_held(double s, double slope) {
  return (s <= 0.0 && slope > 0.0) || (s >= 1.0 && slope < 0.0);
}

/* First and second derivatives of what is to be least, by s and t; a Gauss–Newton model for where it is not convex. */
typedef struct slopes {
  double gs, gt, hss, htt, cross, ss, tt;
} slopes;

/* Of F(s,t) = |x(s) - y(t)|²/2. */
static slopes slopes_of_points(const jet *x, const jet *y) {
  const vec3 w = vec_sub(x->x, y->x);
  slopes k = {.gs = vec_dot(w, x->d1),
              .gt = -vec_dot(w, y->d1),
              .ss = vec_norm2(x->d1),
              .tt = vec_norm2(y->d1),
              .cross = -vec_dot(x->d1, y->d1)};
  k.hss = k.ss + vec_dot(w, x->d2);
  k.htt = k.tt - vec_dot(w, y->d2);
  return k;
}

/* Of |x(s) - y(t)|. */
static slopes slopes_of_balls(const jet *x, const jet *y) {
  const vec3 w = vec_sub(x->x, y->x);
  const double d = vec_norm(w), by = d > 0.0 ? 1.0 / d : 0.0;
  const vec3 n = vec_scale(by, w);
  const double xn = vec_dot(n, x->d1), yn = vec_dot(n, y->d1);
  slopes k = {.gs = xn,
              .gt = -yn,
              .ss = by * (vec_norm2(x->d1) - xn * xn),
              .tt = by * (vec_norm2(y->d1) - yn * yn),
              .cross = -by * (vec_dot(x->d1, y->d1) - xn * yn)};
  k.hss = k.ss + vec_dot(n, x->d2);
  k.htt = k.tt - vec_dot(n, y->d2);
  return k;
}

static vec3 hessian_times(const double h[6], vec3 v) {
  return vec(h[0] * v.x + h[1] * v.y + h[2] * v.z, h[1] * v.x + h[3] * v.y + h[4] * v.z,
             h[2] * v.x + h[4] * v.y + h[5] * v.z);
}

/* Of the distance of w = x(s) - y(t) + shift from the feature seen at `seen`. */
static slopes slopes_of_body(const convex_near *near, vec3 seen, vec3 w, const jet *x, const jet *y) {
  vec3 n = near->normal, hx, hy;
  if (near->flat && near->tangents < 2) { /* |part of w - origin across the tangents| */
    vec3 across = vec_sub(w, near->origin);
    for (int i = 0; i < near->tangents; i++) across = vec_axpy(across, -vec_dot(near->e[i], across), near->e[i]);
    const double r = vec_norm(across);
    if (r > 0.0) n = vec_scale(1.0 / r, across);
    hx = vec_axpy(x->d1, -vec_dot(n, x->d1), n), hy = vec_axpy(y->d1, -vec_dot(n, y->d1), n);
    for (int i = 0; i < near->tangents; i++) {
      hx = vec_axpy(hx, -vec_dot(near->e[i], hx), near->e[i]);
      hy = vec_axpy(hy, -vec_dot(near->e[i], hy), near->e[i]);
    }
    const double curved = r > 0.0 ? 1.0 / r : 0.0;
    hx = vec_scale(curved, hx), hy = vec_scale(curved, hy);
  } else if (near->flat) {
    hx = hy = vec(0, 0, 0);
  } else {
    n = vec_add(n, hessian_times(near->hessian, vec_sub(w, seen)));
    hx = hessian_times(near->hessian, x->d1), hy = hessian_times(near->hessian, y->d1);
  }
  slopes k = {.gs = vec_dot(n, x->d1),
              .gt = -vec_dot(n, y->d1),
              .ss = vec_dot(x->d1, hx),
              .tt = vec_dot(y->d1, hy),
              .cross = -vec_dot(x->d1, hy)};
  k.hss = k.ss + vec_dot(n, x->d2);
  k.htt = k.tt - vec_dot(n, y->d2);
  return k;
}

/* One Newton step, or one of the Gauss–Newton model where that is not convex. */
static void newton_step(const slopes *k, const double s[2], double step[2]) {
  const bool hold_s = is_held(s[0], k->gs), hold_t = is_held(s[1], k->gt);
  step[0] = step[1] = 0.0;
  if (hold_s && hold_t) return;
  if (hold_s || hold_t) {
    const int i = hold_s ? 1 : 0;
    const double g = hold_s ? k->gt : k->gs, h = hold_s ? k->htt : k->hss, flat = hold_s ? k->tt : k->ss;
    const double curvature = h > 0.0 ? h : flat;
    if (curvature > 0.0) step[i] = -g / curvature;
    return;
  }
  double hss = k->hss, htt = k->htt, determinant = hss * htt - k->cross * k->cross;
  if (!(hss > 0.0 && determinant > 0.0)) {
    hss = k->ss * (1.0 + REGULAR), htt = k->tt * (1.0 + REGULAR);
    determinant = hss * htt - k->cross * k->cross;
  }
  if (!(determinant > 0.0)) return;
  step[0] = (k->cross * k->gt - htt * k->gs) / determinant;
  step[1] = (k->cross * k->gs - hss * k->gt) / determinant;
}

static vec3 gap_of(const jet *x, const jet *y, const vec3 *shift) {
  const vec3 w = vec_sub(x->x, y->x);
  return shift ? vec_add(w, *shift) : w;
}

bool newton_curves_descend(curve_side side[2], const vec3 *shift, curve_meeting *meeting, double step) {
  if (side[0].curve->arcs || side[1].curve->arcs) return false; /* no derivatives to go by */
  double s[2] = {meeting->s[0], meeting->s[1]};
  jet x = jet_at(&side[0], s[0]), y = jet_at(&side[1], s[1]);
  const vec3 seen = gap_of(&x, &y, shift);
  for (int i = 0; i < MAX_STEPS; i++) {
    double wanted[2], moved = 0.0;
    slopes at = shift             ? slopes_of_body(&meeting->near, seen, gap_of(&x, &y, shift), &x, &y)
                : !side[0].radius ? slopes_of_points(&x, &y)
                                  : slopes_of_balls(&x, &y);
    if (side[0].radius) {
      const curve_thickness radius = curve_side_thickness(&side[0], meeting->piece[0], s[0]);
      at.gs -= radius.slope, at.hss -= radius.bend;
    }
    newton_step(&at, s, wanted);
    for (int k = 0; k < 2; k++) {
      const double next = clamp(s[k] + clamp(wanted[k], -step, step), side[k].part.a, side[k].part.b);
      moved = fmax(moved, fabs(next - s[k]));
      s[k] = next;
    }
    if (moved < NEWTON_STANDS) break;
    x = jet_at(&side[0], s[0]), y = jet_at(&side[1], s[1]);
    if (moved < NEWTON_CONVERGED) break;
  }
  if (s[0] == meeting->s[0] && s[1] == meeting->s[1]) return false;
  for (int k = 0; k < 2; k++) {
    meeting->s[k] = s[k];
    meeting->point[k] = k == 0 ? x.x : y.x;
  }
  return true;
}
