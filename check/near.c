/* SPDX-License-Identifier: BSD-3-Clause */
/* At the parameter t the point y of the mover is within delta + radius + margin of a point of the set: then the
 * distance is at most delta. Everything is seen from the set's own frame. What the point of the set is:
 *   a curve's own at a parameter; a point itself; of four vertices of a polytope the mean by weights, or where all
 * weights are 0 y itself, inside their tetrahedron; of elements one of them, as of a polytope; of the other bodies y -
 * v, v being given. */
#include "near.h"

#include "check.h"
#include "inequalities.h"
#include "pieces.h"
#include "support.h"
#include "winding.h"

/* out = the point of the curve at t, at a jump its limit from the left or from the right, within the remainder */
static const char *point_at(iv out[3], iv *remainder, const curve *c, double t, bool left) {
  if (!(t >= c->t0 && t <= c->t1)) return "its parameter lies outside the curve";
  return pieces_point(out, remainder, c, t, left);
}

/* Something was neither so nor not so: more bits may tell. */
static _Thread_local bool left_open;

bool near_left_open(void) {
  return left_open;
}

/* a <= b, whatever the numbers are */
static bool at_most(const iv *a, const iv *b) {
  const bool is_so = mpfr_number_p(a->hi) && mpfr_number_p(b->lo) && mpfr_lessequal_p(a->hi, b->lo);
  if (!is_so && !mpfr_greater_p(a->lo, b->hi)) left_open = true;
  return is_so;
}

static bool at_most_d(const iv *a, double b) {
  const bool is_so = mpfr_number_p(a->hi) && mpfr_cmp_d(a->hi, b) <= 0;
  if (!is_so && !(mpfr_number_p(a->lo) && mpfr_cmp_d(a->lo, b) > 0)) left_open = true;
  return is_so;
}

/* The determinant of b - a, c - a, d - a. */
static void volume(iv *out, iv *const corner[4]) {
  iv *e = iv_new(9), *w = iv_new(3);
  for (int i = 0; i < 3; i++)
    for (int k = 0; k < 3; k++) iv_sub(&e[3 * i + k], &corner[i + 1][k], &corner[0][k]);
  iv_set_d(&w[2], 0.0);
  for (int k = 0; k < 3; k++) {
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    iv_mul(&w[0], &e[3 + i], &e[6 + j]);
    iv_mul(&w[1], &e[3 + j], &e[6 + i]);
    iv_sub(&w[0], &w[0], &w[1]);
    iv_mul(&w[0], &w[0], &e[k]);
    iv_add(&w[2], &w[2], &w[0]);
  }
  iv_set(out, &w[2]);
  iv_free(e, 9);
  iv_free(w, 3);
}

/* y lies in the tetrahedron of four vertices: the five volumes have one sign. */
static bool in_tetrahedron(const set *s, const uint32_t vertex[4], iv *y) {
  iv *v = iv_new(12), *w = iv_new(1);
  iv *corner[4];
  for (int i = 0; i < 4; i++) {
    corner[i] = v + 3 * i;
    for (int k = 0; k < 3; k++) {
      iv_set_d(&corner[i][k], s->vertices[vertex[i]][k]);
      iv_set_d(w, s->centre[k]);
      iv_add(&corner[i][k], &corner[i][k], w);
    }
  }
  int positive = 0, negative = 0;
  for (int i = -1; i < 4; i++) {
    iv *replaced[4] = {corner[0], corner[1], corner[2], corner[3]};
    if (i >= 0) replaced[i] = y;
    volume(w, replaced);
    const bool above = iv_is_positive(w);
    iv_neg(w, w);
    const bool below = iv_is_positive(w);
    positive += above;
    negative += below;
    if (!above && !below && mpfr_cmp(w->lo, w->hi) != 0) left_open = true;
  }
  iv_free(v, 12);
  iv_free(w, 1);
  return positive == 5 || negative == 5;
}

/* v = y less the polytope's point that four vertices and their weights name. False where y ought to lie inside and does
 * not. */
static bool from_polytope(iv v[3], const set *s, iv *y, reader *in) {
  uint32_t vertex[4];
  double weight[4], largest = 0.0;
  for (int i = 0; i < 4; i++) {
    vertex[i] = reader_count(in);
    weight[i] = reader_number(in);
    if (in->bad || vertex[i] >= s->n || !(weight[i] >= 0.0)) return false;
    largest = weight[i] > largest ? weight[i] : largest;
  }
  for (int k = 0; k < 3; k++) iv_set_d(&v[k], 0.0);
  if (largest == 0.0) return in_tetrahedron(s, vertex, y);

  iv *w = iv_new(3); /* sum of weights, of weight * vertex */
  for (int i = 0; i < 4; i++) {
    iv_set_d(&w[1], weight[i]);
    iv_add(&w[0], &w[0], &w[1]);
  }
  for (int k = 0; k < 3; k++) {
    for (int i = 0; i < 4; i++) {
      iv_set_d(&w[1], s->vertices[vertex[i]][k]);
      iv_mul_d(&w[1], &w[1], weight[i]);
      iv_add(&v[k], &v[k], &w[1]);
    }
    iv_div(&v[k], &v[k], &w[0]);
    iv_set_d(&w[2], s->centre[k]);
    iv_add(&v[k], &v[k], &w[2]);
    iv_sub(&v[k], &y[k], &v[k]);
  }
  iv_free(w, 3);
  return true;
}

/* The point y of the set's own frame lies in the body, which is none of the above. */
static bool contains(const set *s, const iv *y) {
  const double *size = s->size;
  iv *w = iv_new(4);
  bool inside = false;
  for (int k = 0; k < 3; k++) iv_abs(&w[k], &y[k]);
  switch (s->kind) {
    case SPHERE:
      iv_norm(&w[3], w);
      inside = at_most_d(&w[3], size[0]);
      break;
    case BOX: inside = at_most_d(&w[0], size[0]) && at_most_d(&w[1], size[1]) && at_most_d(&w[2], size[2]); break;
    case ELLIPSOID:
      for (int k = 0; k < 3; k++) {
        iv_set_d(&w[3], size[k]);
        iv_div(&w[k], &w[k], &w[3]);
      }
      iv_norm(&w[3], w);
      inside = at_most_d(&w[3], 1.0);
      break;
    case CAPSULE: /* beyond the segment along z, or beside it */
      iv_set_d(&w[3], size[0]);
      iv_sub(&w[2], &w[2], &w[3]);
      iv_set_d(&w[3], 0.0);
      iv_max(&w[2], &w[2], &w[3]);
      iv_norm(&w[3], w);
      inside = at_most_d(&w[3], size[1]);
      break;
    case CYLINDER:
      inside = at_most_d(&w[2], size[0]);
      iv_set_d(&w[2], 0.0);
      iv_norm(&w[3], w);
      inside = inside && at_most_d(&w[3], size[1]);
      break;
    case CONE: /* rho 2h <= r (h - z) */
      inside = at_most_d(&w[2], size[0]);
      iv_set_d(&w[2], 0.0);
      iv_norm(&w[3], w);
      iv_mul_d(&w[3], &w[3], 2.0 * size[0]);
      iv_set_d(&w[2], size[0]);
      iv_sub(&w[2], &w[2], &y[2]);
      iv_mul_d(&w[2], &w[2], size[1]);
      inside = inside && at_most(&w[3], &w[2]);
      break;
    case HALFSPACE:
      for (int k = 0; k < 3; k++) iv_set_d(&w[k], size[k]);
      iv_dot(&w[3], w, y);
      inside = at_most_d(&w[3], -size[3]);
      break;
    case IMPLICIT:
      inequalities_value(&w[3], s, y);
      inside = at_most_d(&w[3], 0.0);
      break;
    default: break;
  }
  iv_free(w, 4);
  return inside;
}

bool near_read_point(iv x[3], const set *s, reader *in) {
  for (int k = 0; k < 3; k++) iv_set_d(&x[k], s->kind == POINT ? s->centre[k] : 0.0);
  if (s->kind == POINT) return true;
  if (s->kind == POLYTOPE) { /* 0 less the way from the mean to it */
    iv *v = iv_new(3);
    const bool found = from_polytope(v, s, x, in);
    for (int k = 0; k < 3; k++) iv_sub(&x[k], &x[k], &v[k]);
    iv_free(v, 3);
    return found && !in->bad;
  }
  for (int k = 0; k < 3; k++) iv_set_d(&x[k], reader_number(in));
  return !in->bad && contains(s, x);
}

/* One element, or that y is inside of a closed mesh. */
static const char *check_element(const set *s, iv *y, iv *apart, reader *in, bool left) {
  const uint32_t element = reader_count(in);
  if (in->bad) return "it is cut off or not a number";
  if (element == UINT32_MAX && s->kind == SOLID) {
    const vec seen = winding_ball_of(y), centre = vec_of(s->centre), own = vec_sub(&seen, &centre);
    return winding_side(s, &own) == INSIDE ? NULL : "the point is not inside the mesh";
  }
  if (element >= set_elements(s)) return "it is about no element of the target";
  set one = set_group(s, element, element + (size_t)1);
  one.kind = POLYTOPE;
  iv *ball = iv_new(1);
  iv_set_d(ball, s->size[0]);
  iv_add(apart, apart, ball);
  iv_free(ball, 1);
  return near_check_point(&one, y, apart, in, left);
}

const char *near_check_point(const set *s, iv *y, iv *apart, reader *in, bool left) {
  if (s->corners > 0) return check_element(s, y, apart, in, left);
  iv *v = iv_new(3), *w = iv_new(2);
  const char *fault = NULL;
  if (s->kind == CURVE) { /* the point of the other curve */
    fault = point_at(v, &w[0], &s->curve, reader_number(in), left);
    iv_sub(apart, apart, &w[0]);
    for (int k = 0; k < 3; k++) iv_sub(&v[k], &y[k], &v[k]);
  } else if (s->kind == POINT) {
    for (int k = 0; k < 3; k++) {
      iv_set_d(&v[k], s->centre[k]);
      iv_sub(&v[k], &y[k], &v[k]);
    }
  } else if (s->kind == POLYTOPE) {
    if (!from_polytope(v, s, y, in)) fault = "the point it names is not in the target";
  } else {
    for (int k = 0; k < 3; k++) {
      iv_set_d(&v[k], reader_number(in));
      iv_sub(&y[k], &y[k], &v[k]);
    }
    if (!contains(s, y)) fault = "the point it names is not in the target";
  }
  iv_norm(&w[1], v);
  if (!fault && in->bad) fault = "it is cut off or not a number";
  if (!fault && !at_most(&w[1], apart)) fault = "the two points it names are too far apart";
  iv_free(v, 3);
  iv_free(w, 2);
  return fault;
}

/* What is added to the balls at t: the growth, as little as it can be. */
static const char *add_growth(iv *balls, const curve *growth, double t, bool left) {
  if (!curve_is_there(growth)) return NULL;
  iv *x = iv_new(3), *w = iv_new(1);
  const char *fault = point_at(x, w, growth, t, left);
  iv_add(balls, balls, &x[0]);
  iv_sub(balls, balls, w);
  iv_free(x, 3);
  iv_free(w, 1);
  return fault;
}

/* The point of a body that is carried by a curve's point y, which becomes it. */
static const char *add_carried(iv y[3], const set *carried, reader *in) {
  iv *x = iv_new(3), *n = iv_new(3);
  const char *fault = near_read_point(n, carried, in) ? NULL : "the point it names is not in what is carried";
  support_point_to_world(x, carried, n);
  for (int k = 0; k < 3; k++) iv_add(&y[k], &y[k], &x[k]);
  iv_free(x, 3);
  iv_free(n, 3);
  return fault;
}

/* With the limits from the left or from the right, of all that is at the mover's parameter and of an obstacle, where they
 * jump. */
static const char *check_limits(const problem *p, reader *in, double delta, int limits) {
  const mover *m = &p->mover;
  const uint32_t index = reader_count(in);
  const double t = reader_number(in);
  if (in->bad || p->n_sets == 0 || index / p->n_sets >= (m->n_carried > 0 ? m->n_carried : 1))
    return "it is about no target of these";
  const set *s = &p->sets[index % p->n_sets], *carried = m->n_carried > 0 ? &m->carried[index / p->n_sets] : NULL;
  const bool left = (limits & 1) != 0, rides = curve_is_there(&s->ride);
  iv *y = iv_new(3), *own = iv_new(3), *ride = iv_new(3), *w = iv_new(3);
  const char *fault = point_at(y, &w[0], &m->curve, t, left);
  if (!fault && rides) fault = point_at(ride, &w[2], &s->ride, t, left);
  if (!fault && carried) fault = add_carried(y, carried, in);
  iv_add(&w[0], &w[0], &w[2]);
  iv_neg(&w[0], &w[0]); /* remainders take from the balls */
  if (!fault) fault = add_growth(&w[0], &m->growth, t, left);
  if (!fault) fault = add_growth(&w[0], &s->growth, t, left);
  if (!fault) {
    support_point_to_frame(own, s, y, rides ? ride : NULL);
    const double balls[4] = {delta, m->radius, s->margin, carried ? carried->margin : 0.0};
    for (int i = 0; i < 4; i++) {
      iv_set_d(&w[1], balls[i]);
      iv_add(&w[0], &w[0], &w[1]);
    }
    fault = near_check_point(s, own, &w[0], in, (limits & 2) != 0);
  }
  iv_free(y, 3);
  iv_free(own, 3);
  iv_free(ride, 3);
  iv_free(w, 3);
  return fault;
}

const char *check_near(const problem *p, reader *in, double delta) {
  const char *fault = NULL;
  left_open = false;
  const reader start = *in;
  reader ahead = start;
  const uint32_t index = reader_count(&ahead);
  if (ahead.bad || p->n_sets == 0) return "it is about no target of these";

  /* splines alone can jump: of other curves both limits are one */
  const set *s = &p->sets[index % p->n_sets];
  const curve *clock[4] = {&p->mover.curve, &p->mover.growth, &s->ride, &s->growth};
  int jumps = s->kind == CURVE && s->curve.basis == BSPLINE ? 2 : 0;
  for (int i = 0; i < 4; i++)
    if (curve_is_there(clock[i]) && clock[i]->basis == BSPLINE) jumps |= 1;
  for (int limits = 0; limits < 4; limits++) {
    if ((limits & ~jumps) != 0) continue;
    *in = start;
    fault = check_limits(p, in, delta, limits);
    if (!fault) break;
  }
  return fault;
}
