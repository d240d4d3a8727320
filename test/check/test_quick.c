/* SPDX-License-Identifier: BSD-3-Clause */
/* Doubles with radii never accept a direction that intervals of 640 bits do not accept, and accept almost all that they
 * do: random movers, sets, directions and parts, the claim as close to what the direction proves as doubles are. */
#define _POSIX_C_SOURCE 200809L
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "quick.h"
#include "support.h"
#include "support/cases.h"
#include "support/queries.h"

enum { QUERIES = 150, DIRECTIONS = 16, MOST_BREAKS = 64 };

typedef struct tally {
  size_t tight, beyond, loose, accepted_tight, accepted_loose;
} tally;

/* Where a curve can be cut into pieces. */
static size_t breaks_of(const curve *c, double *breaks) {
  size_t n = 0;
  breaks[n++] = c->t0;
  for (size_t i = 0; c->basis == BSPLINE && i < c->n_knots; i++)
    if (c->knots[i] > breaks[n - 1] && c->knots[i] < c->t1) breaks[n++] = c->knots[i];
  const double middle = 0.5 * (breaks[n - 1] + c->t1);
  if (middle > breaks[n - 1] && middle < c->t1) breaks[n++] = middle;
  breaks[n] = c->t1;
  return n;
}

/* What the direction proves, by the functions of the exact way: the mover is farther than this from the set, all balls
 * left out. Two doubles that contain it. */
static void proven(const quick_query *q, double *low, double *high) {
  iv *n = iv_new(3), *own = iv_new(3), *w = iv_new(3);
  const bool flat = q->set->kind == HALFSPACE;
  for (int k = 0; k < 3; k++) iv_set_d(&n[k], flat ? q->set->size[k] : q->normal[k]);
  if (flat) support_to_world(n, q->set);
  support_of_frame(&w[0], own, q->set, n);
  if (q->set->kind == CURVE) {
    for (int k = 0; k < 3; k++) iv_neg(&own[k], &own[k]);
    pieces_least(&w[1], &(pieces_share){q->obstacle, own}, 1, 0, q->theirs[0], q->theirs[1]);
    iv_neg(&w[1], &w[1]);
  } else {
    support_of_body(&w[1], q->set, own);
  }
  iv_add(&w[0], &w[0], &w[1]);
  pieces_least(&w[1], &(pieces_share){q->mover, n}, 1, 0, q->from, q->to);
  iv_sub(&w[0], &w[1], &w[0]);
  iv_norm(&w[1], n);
  iv_div(&w[0], &w[0], &w[1]);
  *low = mpfr_get_d(w[0].lo, MPFR_RNDD);
  *high = mpfr_get_d(w[0].hi, MPFR_RNDU);
  iv_free(n, 3);
  iv_free(own, 3);
  iv_free(w, 3);
}

static void part_of(rng *r, size_t n, double *from, double *to) {
  *from = rng_index(r, 2) ? (double)rng_index(r, n) : rng_uniform(r, 0.0, (double)n);
  *to = rng_index(r, 2) ? (double)n : *from + (double)1e-9 + rng_uniform(r, 0.0, (double)n - *from);
  if (*to > (double)n) *to = (double)n;
}

/* One direction: at the limit from both sides, and a little below. */
static void examine(quick_query *q, rng *r, double scale, tally *sum) {
  const vec3 n = rng_unit(r);
  const double size = rng_index(r, 4) ? 1.0 : rng_log_uniform(r, 1e-30, 1e30);
  const double normal[3] = {n.x * size, n.y * size, n.z * size};
  for (int k = 0; k < 3; k++) q->normal[k] = rng_index(r, 2) ? (double)(float)normal[k] : normal[k];
  double low, high;
  proven(q, &low, &high);
  if (!(high > 0.0)) { /* the other way round, or they overlap */
    for (int k = 0; k < 3; k++) q->normal[k] = -q->normal[k];
    proven(q, &low, &high);
  }
  if (!(low > 0.0)) return;
  q->balls[1] = q->balls[2] = 0.0;
  const double tight[3] = {high, nextafter(high, INFINITY), high + 1e-16 * scale};
  for (int i = 0; i < 3; i++) { /* not farther than this: more than it is not proven */
    q->balls[0] = tight[i];
    sum->beyond++;
    if (quick_separates(q))
      fail_msg("accepted beyond the limit: %.17g of %.17g, kind %d", tight[i], high, q->set->kind);
  }
  q->balls[0] = nextafter(low, -INFINITY);
  sum->tight++;
  sum->accepted_tight += quick_separates(q);
  q->balls[0] = low - 1e-9 * scale;
  if (q->balls[0] < 0.0) return;
  sum->loose++;
  sum->accepted_loose += quick_separates(q);
}

static void examine_query(const asked *given, rng *r, double scale, tally *sum) {
  char *text = NULL;
  size_t length = 0;
  FILE *out = open_memstream(&text, &length);
  asked_write_targets(given, out);
  asked_write_mover(given, "mover", out);
  fclose(out);
  FILE *in = fmemopen(text, length, "r");
  problem p;
  if (!problem_open(&p, in) || !problem_next(&p)) fail_msg("%s in\n%s", p.fault, text);
  double mine[MOST_BREAKS], theirs[MOST_BREAKS];
  pieces moving = {0};
  iv_precision(640);
  const size_t n = breaks_of(&p.mover.curve, mine);
  assert_null(pieces_make(&moving, &p.mover.curve, mine, n));
  for (size_t i = 0; i < p.n_sets; i++) {
    const bool elements = p.sets[i].corners > 0; /* the hull of all of them */
    const set hull = elements ? set_group(&p.sets[i], 0, set_elements(&p.sets[i])) : p.sets[i];
    quick_query q = {.set = &hull, .mover = &moving};
    pieces obstacle = {0};
    if (q.set->kind == CURVE) {
      const size_t m = breaks_of(&q.set->curve, theirs);
      assert_null(pieces_make(&obstacle, &q.set->curve, theirs, m));
      q.obstacle = &obstacle;
    }
    for (int k = 0; k < DIRECTIONS; k++) {
      part_of(r, n, &q.from, &q.to);
      if (q.obstacle) part_of(r, obstacle.n, &q.theirs[0], &q.theirs[1]);
      examine(&q, r, scale, sum);
    }
    pieces_free(&obstacle);
  }
  pieces_free(&moving);
  problem_close(&p);
  fclose(in);
  free(text);
}

CASE(doubles_accept_nothing_that_is_not_proven_and_almost_all_that_is) {
  rng r = rng_seed(71);
  cprox_workspace *ws = cprox_workspace_create();
  tally sum = {0};
  double scale = 1.0;
  for (size_t i = 0; i < test_cases(QUERIES); i++) {
    asked q;
    scale = rng_index(&r, 3) ? 1.0 : rng_log_uniform(&r, 1e-6, 1e6);
    const double away = rng_index(&r, 3) ? 0.0 : rng_log_uniform(&r, scale, 1e6 * scale);
    asked_random(&q, &r,
                 (asked_kinds){.curve_target = rng_index(&r, 2) == 0,
                               .elements = true,
                               .meshes = scale == 1.0 && away == 0.0 && rng_index(&r, 4) == 0},
                 scale, away, ws);
    examine_query(&q, &r, scale + away, &sum);
    asked_free(&q);
  }
  cprox_workspace_free(ws);
  print_message("%zu claims beyond the limit, none accepted; at it %zu of %zu, 1e-9 below %zu of %zu\n", sum.beyond,
                sum.accepted_tight, sum.tight, sum.accepted_loose, sum.loose);
  assert_true(sum.accepted_loose * 100 >= sum.loose * 99);
}

CASE(what_is_no_number_or_too_large_proves_nothing) {
  double points[2][3] = {{0.0, 0.0, 2.0}, {1.0, 0.0, 2.0}}, breaks[2] = {0.0, 1.0};
  curve line = {.basis = BEZIER, .degree = 1, .t0 = 0.0, .t1 = 1.0, .n = 2, .points = points};
  set ball = {.kind = SPHERE, .size = {1.0}};
  const double normals[6][3] = {{0.0, 0.0, 0.0}, {0.0, 0.0, 1e-200},   {0.0, 0.0, 1e200},
                                {0.0, NAN, 1.0}, {INFINITY, 0.0, 1.0}, {0.0, 0.0, 1.0}};
  for (int i = 0; i < 6; i++) {
    for (int k = 0; k < 4; k++) {
      pieces moving = {0};
      iv_precision(640);
      assert_null(pieces_make(&moving, &line, breaks, 1));
      points[0][0] = k == 1 ? 1e305 : k == 2 ? INFINITY : k == 3 ? NAN : 0.0;
      quick_query q = {.set = &ball, .mover = &moving, .to = 1.0, .balls = {0.5, 0.0, 0.0}};
      memcpy(q.normal, normals[i], sizeof q.normal);
      assert_int_equal(quick_separates(&q), i == 5 && k == 0);
      pieces_free(&moving);
    }
  }
}

int main(void) {
  return cases_run(NULL, NULL);
}
