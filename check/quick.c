/* SPDX-License-Identifier: BSD-3-Clause */
#include "quick.h"

#include <math.h>

#include "ball.h"
#include "span.h"

enum { MOST_POINTS = 61 };

/* Beyond these squares and products may underflow or overflow: then nothing is said. */
static const double SMALL = 1e-100, LARGE = 1e100;

static bool used = true;

void quick_use(bool on) {
  used = on;
}

/* a becomes the part [s, 1] or, left, the part [0, s] of the polynomial with these Bézier numbers. */
static void cut(num *a, size_t degree, num s, bool left) {
  for (size_t r = 1; r <= degree; r++)
    for (size_t i = 0; i + r <= degree; i++) {
      const size_t j = left ? degree - i : i, other = left ? j - 1 : j + 1;
      const num step = num_mul(left ? num_sub(num_of(1.0), s) : s, num_sub(a[other], a[j]));
      a[j] = num_add(a[j], step);
    }
}

bool quick_point(pieces *p, size_t i, double s, vec *point) {
  const pieces_quick *piece = pieces_quick_at(p, i);
  if (!piece || p->degree + 1 > MOST_POINTS) return false;
  *point = (vec){.e = piece->radius + piece->remainder};
  for (int k = 0; k < 3; k++) {
    num a[MOST_POINTS];
    for (size_t j = 0; j <= p->degree; j++) a[j] = num_of(piece->points[j][k]);
    if (s > 0.0) cut(a, p->degree, num_of(s), false);
    point->m[k] = a[0].m;
    point->e += a[0].e;
  }
  point->e = GROW(point->e);
  return true;
}

/* A lower bound of n·x over the part [from, to] of the pieces; -infinity where there is none. */
static double least_of(pieces *p, const vec *n, double from, double to) {
  double least = INFINITY;
  if (p->degree + 1 > MOST_POINTS) return -INFINITY;
  for (size_t i = (size_t)floor(from); i < (size_t)ceil(to) && i < p->n; i++) {
    const pieces_quick *piece = pieces_quick_at(p, i);
    if (!piece) return -INFINITY;
    num a[MOST_POINTS];
    for (size_t j = 0; j <= p->degree; j++) {
      const vec point = {{piece->points[j][0], piece->points[j][1], piece->points[j][2]}, piece->radius};
      a[j] = vec_dot(n, &point);
    }
    const double k = (double)i, s0 = fmax(from - k, 0.0), s1 = fmin(to - k, 1.0);
    if (s0 > 0.0) cut(a, p->degree, num_of(s0), false);
    if (s1 < 1.0) { /* (s1 - s0) / (1 - s0) of what is left */
      const num all = num_sub(num_of(1.0), num_of(s0)), part = num_sub(num_of(s1), num_of(s0));
      cut(a, p->degree, num_div(part, all), true);
    }
    const num off = num_mul(num_of(vec_top(n)), num_of(piece->remainder));
    for (size_t j = 0; j <= p->degree; j++) {
      const double bottom = num_bottom(num_sub(a[j], off));
      if (!isfinite(bottom)) return -INFINITY;
      if (bottom < least) least = bottom;
    }
  }
  return least;
}

static bool turns(const pose *p) {
  return p->q[1] != 0.0 || p->q[2] != 0.0 || p->q[3] != 0.0;
}

static rot rot_of_pose(const pose *p) {
  const num q[4] = {num_of(p->q[0]), num_of(p->q[1]), num_of(p->q[2]), num_of(p->q[3])};
  return rot_of_quaternion(q);
}

vec quick_to_frame(const set *s, const vec *p) {
  vec own = *p;
  for (size_t i = 0; i < s->n_poses; i++) {
    const vec x = vec_of(s->poses[i].x);
    own = vec_sub(&own, &x);
    if (!turns(&s->poses[i])) continue;
    const rot r = rot_of_pose(&s->poses[i]);
    own = rot_turn(&r, &own, true);
  }
  return own;
}

bool quick_separates(const quick_query *q) {
  const set *s = q->set;
  if (!used) return false;
  vec n = vec_of(s->kind == HALFSPACE ? s->size : q->normal); /* a halfspace has no other */
  const double size = length_of(n.m);
  if (!(size > SMALL && size < LARGE)) return false;
  const double reach = s->kind == CURVE ? 0.0 : span_radius(s);
  if (!(reach < LARGE)) return false;
  if (s->kind == HALFSPACE) {
    for (size_t i = s->n_poses; i-- > 0;)
      if (turns(&s->poses[i])) {
        const rot r = rot_of_pose(&s->poses[i]);
        n = rot_turn(&r, &n, false);
      }
  }

  /* how far the set reaches along n: where its frame stands, its centre, and it about that */
  num far = num_of(0.0);
  vec own = n;
  for (size_t i = 0; i < s->n_poses; i++) {
    const vec x = vec_of(s->poses[i].x);
    far = num_add(far, vec_dot(&own, &x));
    if (!turns(&s->poses[i])) continue;
    const rot r = rot_of_pose(&s->poses[i]);
    own = rot_turn(&r, &own, true);
  }
  if (s->kind == CURVE) {
    const vec back = vec_scale(num_of(-1.0), &own);
    far = num_add(far, num_of(-least_of(q->obstacle, &back, q->theirs[0], q->theirs[1])));
  } else if (s->kind == HALFSPACE) {
    far = num_sub(far, num_of(s->size[3]));
  } else {
    const vec centre = vec_of(s->centre);
    const bool has_centre = s->kind == POINT || s->kind == POLYTOPE || s->kind == HULL;
    if (has_centre) far = num_add(far, vec_dot(&own, &centre));
    far = num_add(far, span_along(s, reach, &own));
  }

  /* the balls, by the length of n */
  num balls = num_of(0.0);
  for (int i = 0; i < 3; i++) balls = num_add(balls, num_of(q->balls[i]));
  far = num_add(far, num_mul(balls, num_of(vec_top(&n))));
  const double top = num_top(far);
  return isfinite(top) && least_of(q->mover, &n, q->from, q->to) > top;
}
