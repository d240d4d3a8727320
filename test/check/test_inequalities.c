/* SPDX-License-Identifier: BSD-3-Clause */
/* An attack on what multipliers prove of bodies by inequalities: whatever they are, no point of the body is farther
 * along the direction that they make. */
#define _POSIX_C_SOURCE 200809L
#include "inequalities.h"

#include <string.h>

#include "support/cases.h"
#include "support/queries.h"
#include "support/tampering.h"

enum { BODIES = 60, TRIES = 40, SAMPLES = 30 };

static void put_real(bytes *b, double value) {
  memcpy(b->at + b->n, &value, 8);
  b->n += 8;
}

static void put_short(bytes *b, size_t value) {
  b->at[b->n++] = (unsigned char)(value & 255);
  b->at[b->n++] = (unsigned char)(value >> 8);
}

/* Any multipliers, of a few rows or of all. */
static void multipliers_random(bytes *b, const inequalities *r, rng *g) {
  const size_t rows = r->n_planes + r->n_quadrics + r->n_sums, all = rows + r->n_terms;
  const double least = rng_index(g, 8) ? 0.0 : -1.0;
  unsigned char *place = b->at;
  b->n = 0;
  if (r->n_quadrics > 0)
    for (int k = 0; k < 3; k++) put_real(b, rng_uniform(g, -0.5, 0.5));
  place += b->n;
  put_short(b, 0);
  size_t n = 0;
  for (size_t row = 0; row < all; row++) {
    if (rng_index(g, 3) == 0) continue;
    put_short(b, row);
    put_real(b, row < rows ? rng_uniform(g, least, 1.0) : rng_uniform(g, -1.0, 1.0));
    n++;
  }
  memcpy(place, &n, 2);
}

/* Points that satisfy all inequalities, in exact arithmetic. */
static size_t points_inside(const cprox_body *body, const set *s, rng *g, vec3 points[SAMPLES]) {
  iv *x = iv_new(3), *value = iv_new(1);
  size_t n = 0;
  for (int i = 0; i < SAMPLES; i++) {
    vec3 p;
    cprox_body_support(body, rng_unit(g), &p);
    const vec3 centre = vec(s->centre[0], s->centre[1], s->centre[2]);
    p = vec_lerp(p, centre, rng_index(g, 4) ? 1e-9 : rng_uniform(g, 0.0, 1.0));
    iv_set_d(&x[0], p.x);
    iv_set_d(&x[1], p.y);
    iv_set_d(&x[2], p.z);
    inequalities_value(value, s, x);
    if (mpfr_sgn(value->hi) <= 0) points[n++] = p;
  }
  iv_free(x, 3);
  iv_free(value, 1);
  return n;
}

static void attack(const cprox_body *body, const set *s, rng *g, size_t tried[2]) {
  static bytes b;
  vec3 points[SAMPLES];
  const size_t n_points = points_inside(body, s, g, points);
  iv *n = iv_new(3), *most = iv_new(1), *x = iv_new(3), *along = iv_new(1);
  for (int i = 0; i < TRIES; i++) {
    multipliers_random(&b, &s->rows, g);
    reader in = {.at = b.at, .end = b.at + b.n};
    if (!inequalities_reach(n, most, s, 8, &in)) {
      tried[1]++;
      continue;
    }
    assert_ptr_equal(in.at, in.end);
    for (size_t k = 0; k < n_points; k++) {
      iv_set_d(&x[0], points[k].x);
      iv_set_d(&x[1], points[k].y);
      iv_set_d(&x[2], points[k].z);
      iv_dot(along, n, x);
      if (mpfr_greater_p(along->lo, most->hi)) fail_msg("a point reaches beyond what multipliers prove");
      tried[0]++;
    }
  }
  iv_free(n, 3);
  iv_free(most, 1);
  iv_free(x, 3);
  iv_free(along, 1);
}

/* 60 bodies × 40 multipliers × up to 30 points, seed 1. A negative multiplier of an inequality proves nothing. */
CASE(no_multipliers_prove_less_than_the_body_reaches) {
  rng g = rng_seed(1);
  cprox_workspace *ws = cprox_workspace_create();
  size_t tried[2] = {0, 0};
  for (size_t i = 0; i < test_cases(BODIES); i++) {
    asked q = {.scale = 1.0, .n = 1, .n_bodies = 1};
    q.bodies[0] = query_implicit(&g, 1.0, ws);
    q.targets[0] = cprox_obstacle_at(q.bodies[0], rng_pose(&g, 1.0));
    q.mover = (given_curve){.basis = "bezier", .degree = 1, .t1 = 1.0, .n = 2, .points = {{0, 0, 0}, {1, 0, 0}}};
    asked_text text = asked_text_of(&q);
    attack(q.bodies[0], &text.read.sets[0], &g, tried);
    asked_text_free(&text);
    asked_free(&q);
  }
  print_message("multipliers: %zu points held, %zu refused\n", tried[0], tried[1]);
  assert_true(tried[0] > test_cases(BODIES) * TRIES * SAMPLES / 2 && tried[1] > 0);
  cprox_workspace_free(ws);
}

/* x'Qx with one negative eigenvalue is not convex: its tangents bound nothing. */
CASE(a_quadric_that_is_not_convex_proves_nothing) {
  double quadric[10] = {1, 0, 0, 1, 0, -1e-9, 0, 0, 0, -1};
  set s = {.kind = IMPLICIT, .rows = {.n_quadrics = 1, .quadrics = &quadric}};
  static bytes b;
  put_real(&b, 1.0);
  put_real(&b, 0.0);
  put_real(&b, 0.0);
  put_short(&b, 1);
  put_short(&b, 0);
  put_real(&b, 1.0);
  iv *n = iv_new(3), *most = iv_new(1);
  for (int flat = 0; flat < 2; flat++) {
    reader in = {.at = b.at, .end = b.at + b.n};
    quadric[5] = flat ? 0.0 : -1e-9;
    assert_int_equal(inequalities_reach(n, most, &s, 8, &in), flat);
  }
  iv_free(n, 3);
  iv_free(most, 1);
}

/* 2000 numbers between 1e-20 and 1e4 in size, seed 2, against MPFR's own functions with many more bits. */
CASE(exponentials_and_logarithms_hold_what_mpfr_finds) {
  static const int BITS[2] = {640, 4096};
  rng g = rng_seed(2);
  mpfr_t exact, width;
  mpfr_init2(exact, 6000);
  mpfr_init2(width, 6000);
  for (int level = 0; level < 2; level++) {
    iv_precision(BITS[level]);
    iv *a = iv_new(2);
    for (size_t i = 0; i < (level == 0 ? 2000u : 50u); i++) {
      const double size = rng_log_uniform(&g, 1e-20, 1e4);
      for (int which = 0; which < 3; which++) { /* e^x, e^-x, log x */
        iv_set_d(&a[0], which == 1 ? -size : size);
        mpfr_set(exact, a[0].lo, MPFR_RNDN);
        which < 2 ? iv_exp(&a[1], &a[0]) : iv_log(&a[1], &a[0]);
        which < 2 ? mpfr_exp(exact, exact, MPFR_RNDN) : mpfr_log(exact, exact, MPFR_RNDN);
        assert_true(mpfr_lessequal_p(a[1].lo, exact) && mpfr_greaterequal_p(a[1].hi, exact));
        mpfr_sub(width, a[1].hi, a[1].lo, MPFR_RNDU);
        mpfr_div(width, width, exact, MPFR_RNDN);
        assert_true(mpfr_zero_p(width) || mpfr_get_exp(width) < 16 - BITS[level]);
      }
    }
    iv_free(a, 2);
  }
  iv_precision(BITS[0]);
  mpfr_clear(exact);
  mpfr_clear(width);
}

int main(void) {
  return cases_run(NULL, NULL);
}
