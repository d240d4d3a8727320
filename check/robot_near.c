/* SPDX-License-Identifier: BSD-3-Clause */
/* At one place of the motion a point of the one body is within delta and both margins of a point of the other. Which
 * points these are is told as for curves (near.c); where they stand at that time, by kinematics.c. */
#include <stdlib.h>

#include "kinematics.h"
#include "near.h"
#include "robot_check.h"

/* De Casteljau at u: all points become the value there, as if the variable stood still. */
static void hold_at(num *c, size_t degree, double u) {
  const num s = num_of(u);
  for (size_t level = 1; level <= degree; level++)
    for (size_t i = 0; i + level <= degree; i++) c[i] = num_add(c[i], num_mul(s, num_sub(c[i + 1], c[i])));
  for (size_t i = 1; i <= degree; i++) c[i] = c[0];
}

/* The places of all bodies at u of a segment. */
static void place_bodies(const robot *r, size_t segment, double u, num *points, axis_state *states, place *places) {
  const size_t row = ROBOT_MAX_DEGREE + 1;
  for (size_t i = 0; i < r->n_variables * row; i++) points[i] = robot_points(r, segment, 0)[i];
  for (size_t v = 0; v < r->n_variables; v++)
    if (r->moved[v]) hold_at(points + v * row, r->degrees[segment], u);
  kinematics_axes(r, r->degrees[segment], points, states);
  for (size_t i = 0; i < r->n_bodies; i++) places[i] = kinematics_place(&r->bodies[i], states);
}

static vec vec_of_intervals(const iv x[3]) {
  vec v = {.e = 0.0};
  for (int k = 0; k < 3; k++) {
    const double low = mpfr_get_d(x[k].lo, MPFR_RNDD), high = mpfr_get_d(x[k].hi, MPFR_RNDU);
    v.m[k] = 0.5 * (low + high);
    v.e += GROW(high - low + BALL_U * fabs(v.m[k]));
  }
  v.e = GROW(v.e);
  return v;
}

static void intervals_of_vec(iv x[3], const vec *v) {
  for (int k = 0; k < 3; k++) {
    mpfr_set_d(x[k].lo, v->m[k], MPFR_RNDD);
    mpfr_sub_d(x[k].lo, x[k].lo, v->e, MPFR_RNDD);
    mpfr_set_d(x[k].hi, v->m[k], MPFR_RNDU);
    mpfr_add_d(x[k].hi, x[k].hi, v->e, MPFR_RNDU);
  }
}

/* The moving body's point y, brought from its frame about the centre into the standing one's. */
static void bring(iv y[3], const body *moving, const place *at, const body *standing, const place *from) {
  const vec named = vec_of_intervals(y), centre = vec_of(moving->shape->centre),
            other = vec_of(standing->shape->centre);
  vec x = vec_sub(&named, &centre);
  x = place_apply(at, &x);
  x = vec_sub(&x, &from->p);
  x = rot_turn(&from->r, &x, true);
  x = vec_add(&x, &other);
  intervals_of_vec(y, &x);
}

static const char *check_points(const robot *r, reader *in, const pair *p, const place *places, double delta) {
  const body *moving = &r->bodies[p->moving], *standing = &r->bodies[p->standing];
  iv *y = iv_new(3), *apart = iv_new(2);
  const char *fault = near_read_point(y, moving->shape, in) ? NULL : "the point it names is not in the robot's part";
  if (!fault) {
    const double balls[3] = {delta, moving->shape->margin, standing->shape->margin};
    for (int i = 0; i < 3; i++) {
      iv_set_d(&apart[1], balls[i]);
      iv_add(&apart[0], &apart[0], &apart[1]);
    }
    bring(y, moving, &places[p->moving], standing, &places[p->standing]);
    fault = near_check_point(standing->shape, y, apart, in, true);
  }
  iv_free(y, 3);
  iv_free(apart, 2);
  return fault;
}

const char *robot_near(const robot *r, reader *in, double delta) {
  const size_t index = reader_count(in), segment = reader_count(in);
  const double u = reader_number(in);
  if (in->bad || index >= r->n_pairs || segment >= r->n_segments || !(u >= 0.0 && u <= 1.0))
    return "it is about no pair or no time of these";
  num *points = malloc((r->n_variables + 1) * (ROBOT_MAX_DEGREE + 1) * sizeof *points);
  axis_state *states = malloc((r->n_axes + 1) * sizeof *states);
  place *places = malloc((r->n_bodies + 1) * sizeof *places);
  const char *fault = "memory is out";
  if (points && states && places) {
    place_bodies(r, segment, u, points, states, places);
    fault = check_points(r, in, &r->pairs[index], places, delta);
  }
  free(points);
  free(states);
  free(places);
  return fault;
}
