/* SPDX-License-Identifier: BSD-3-Clause */
/* At one place of the motion a point of the one body is within delta and both margins of a point of the other. Which
 * points these are is told as for curves (near.c); where they stand at that time, by kinematics.c. */
#include <stdlib.h>

#include "kinematics.h"
#include "near.h"
#include "robot_check.h"
#include "winding.h"

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
  const vec named = winding_ball_of(y), centre = vec_of(moving->shape->centre), other = vec_of(standing->shape->centre);
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
    kinematics_hold(r, segment, u, points, states, places);
    fault = check_points(r, in, &r->pairs[index], places, delta);
  }
  free(points);
  free(states);
  free(places);
  return fault;
}
