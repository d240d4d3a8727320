/* SPDX-License-Identifier: BSD-3-Clause */
#include "query/meeting.h"

enum { MAX_STEPS = 16 };

static double clamp(double x, double least, double most) {
  return x < least ? least : x > most ? most : x;
}

vec3 meeting_of_chords(const vec3 first[2], const vec3 second[2], double fraction[2]) {
  const vec3 d = vec_sub(first[1], first[0]), e = vec_sub(second[1], second[0]), r = vec_sub(first[0], second[0]);
  const double dd = vec_norm2(d), ee = vec_norm2(e), de = vec_dot(d, e), dr = vec_dot(d, r), er = vec_dot(e, r);

  /* the nearest points of the lines, then of the segments (C. Ericson, Real-Time Collision Detection, 2005, 5.1.9); parallel
   * ones meet at their middle */
  const double determinant = dd * ee - de * de;
  double s = determinant > 1e-14 * dd * ee ? clamp((de * er - dr * ee) / determinant, 0.0, 1.0) : 0.5;
  double t = ee > 0.0 ? (de * s + er) / ee : 0.5;
  if (t < 0.0 || t > 1.0) {
    t = clamp(t, 0.0, 1.0);
    s = dd > 0.0 ? clamp((de * t - dr) / dd, 0.0, 1.0) : 0.5;
  }
  fraction[0] = s;
  fraction[1] = t;

  vec3 n = vec_sub(vec_axpy(first[0], s, d), vec_axpy(second[0], t, e));
  if (vec_norm2(n) <= 1e-24 * (dd + ee)) n = vec_cross(d, e);
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
  curve_bezier_evaluate(points, points + degree + 1, points + 2 * (degree + 1), 1, degree, side->curve->binomial, s,
                        &j.x, &j.d1, &j.d2);
  return j;
}

/* A parameter at an end of its range stays there while the distance falls outwards. */
static bool is_held(double s, double slope) {
  return (s <= 0.0 && slope > 0.0) || (s >= 1.0 && slope < 0.0);
}

/* One Newton step of F(s,t) = |x(s) - y(t)|²/2, or of its Gauss–Newton model where F is not convex. */
static void newton_step(const jet *x, const jet *y, const double s[2], double step[2]) {
  const vec3 w = vec_sub(x->x, y->x);
  const double gs = vec_dot(w, x->d1), gt = -vec_dot(w, y->d1);
  const double ss = vec_norm2(x->d1), tt = vec_norm2(y->d1), cross = -vec_dot(x->d1, y->d1);
  double hss = ss + vec_dot(w, x->d2), htt = tt - vec_dot(w, y->d2);
  const bool hold_s = is_held(s[0], gs), hold_t = is_held(s[1], gt);
  step[0] = step[1] = 0.0;
  if (hold_s && hold_t) return;
  if (hold_s || hold_t) {
    const int k = hold_s ? 1 : 0;
    const double g = hold_s ? gt : gs, h = hold_s ? htt : hss, flat = hold_s ? tt : ss;
    const double curvature = h > 0.0 ? h : flat;
    if (curvature > 0.0) step[k] = -g / curvature;
    return;
  }
  double determinant = hss * htt - cross * cross;
  if (!(hss > 0.0 && determinant > 0.0)) {
    hss = ss * (1.0 + 1e-9), htt = tt * (1.0 + 1e-9); /* parallel tangents: kept regular */
    determinant = hss * htt - cross * cross;
  }
  if (!(determinant > 0.0)) return;
  step[0] = (cross * gt - htt * gs) / determinant;
  step[1] = (cross * gs - hss * gt) / determinant;
}

bool meeting_descend(const curve_side side[2], curve_meeting *meeting, double step) {
  double s[2] = {meeting->s[0], meeting->s[1]};
  jet x = jet_at(&side[0], s[0]), y = jet_at(&side[1], s[1]);
  for (int i = 0; i < MAX_STEPS; i++) {
    double wanted[2], moved = 0.0;
    newton_step(&x, &y, s, wanted);
    for (int k = 0; k < 2; k++) {
      const double next = clamp(s[k] + clamp(wanted[k], -step, step), side[k].part.a, side[k].part.b);
      moved = fmax(moved, fabs(next - s[k]));
      s[k] = next;
    }
    if (moved < 1e-15) break;
    x = jet_at(&side[0], s[0]), y = jet_at(&side[1], s[1]);
    /* quadratic convergence: what such a step leaves is below rounding */
    if (moved < 1e-9) break;
  }
  if (s[0] == meeting->s[0] && s[1] == meeting->s[1]) return false;
  for (int k = 0; k < 2; k++) {
    meeting->s[k] = s[k];
    meeting->point[k] = k == 0 ? x.x : y.x;
  }
  return true;
}
