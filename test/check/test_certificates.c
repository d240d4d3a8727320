/* SPDX-License-Identifier: BSD-3-Clause */
/* What a query leaves behind is accepted by the checker, which reads the question itself and shares no line with the search. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "support/questions.h"

/* Figures of a campaign, printed at its end. */
typedef struct tally {
  size_t asked, apart, near, none;
  size_t bytes, leaves, largest;
} tally;

static cprox_status ask(const asked *q, double delta, const cprox_options *options, cprox_workspace *ws,
                        cprox_result *result) {
  const cprox_mover along = cprox_tube_along(q->mover.curve, q->radius);
  return delta < 0.0 ? cprox_distance_all(along, q->targets, q->n, options, ws, result, NULL)
                     : cprox_tolerance_all(along, q->targets, q->n, delta, options, ws, result, NULL);
}

/* Asks the distance and two tolerances about it; every certificate is checked. */
static void examine(const asked *q, cprox_workspace *ws, cprox_certificate *c, tally *sum) {
  cprox_options options = cprox_options_default();
  options.epsilon = 1e-6 * q->scale;
  options.certificate = c;
  double distance = 0.0;
  for (int i = 0; i < 3; i++) {
    cprox_result r;
    const double delta = i == 0 ? -1.0 : i == 1 ? 0.5 * distance : 1.5 * distance;
    const cprox_status status = ask(q, delta, &options, ws, &r);
    assert_true(status >= 0);
    if (i == 0) distance = r.lower;
    sum->asked++;
    const bool open = i == 0 ? r.lower == 0.0 && r.upper == 0.0 : r.upper > delta && r.lower <= delta;
    if (cprox_certificate_size(c) == 0) {
      sum->none++;
      if (!open) fail_msg("no certificate of lower %.17g over %.17g: %s", r.lower, delta, cprox_workspace_reason(ws));
      continue;
    }
    const finding found = asked_check(q, cprox_certificate_bytes(c), cprox_certificate_size(c));
    if (found.fault)
      fail_msg("refused: %s (lower %.17g, delta %.17g)", found.fault, r.lower, cprox_certificate_delta(c));
    assert_int_equal(found.claim, cprox_certificate_claim(c));
    assert_true(found.delta == cprox_certificate_delta(c));
    sum->apart += found.claim == CLAIM_APART;
    if (i == 0 && found.claim == CLAIM_APART && found.delta < r.lower - 1e-12 * q->scale)
      fail_msg("distance > %.17g is proven, but not > %.17g", found.delta, r.lower);
    sum->near += found.claim == CLAIM_NEAR;
    if (found.claim == CLAIM_APART && i == 1) {
      sum->bytes += cprox_certificate_size(c);
      sum->leaves += found.leaves;
      if (cprox_certificate_size(c) > sum->largest) sum->largest = cprox_certificate_size(c);
    }
  }
}

static void examine_many(uint64_t seed, size_t cases, asked_kinds kinds, const char *what) {
  rng r = rng_seed(seed);
  cprox_workspace *ws = cprox_workspace_create();
  cprox_certificate *c = cprox_certificate_create();
  tally sum = {0};
  for (size_t i = 0; i < test_cases(cases); i++) {
    asked q;
    const double scale = rng_index(&r, 2) ? 1.0 : rng_log_uniform(&r, 1e-3, 1e3);
    asked_random(&q, &r, kinds, scale, rng_index(&r, 3) ? scale : 1e4 * scale, ws);
    examine(&q, ws, c, &sum);
    asked_free(&q);
  }
  print_message(
      "%s: %zu asked, %zu apart, %zu near, %zu without; a tolerance: %.0f bytes, %.1f directions, at most %zu bytes\n",
      what, sum.asked, sum.apart, sum.near, sum.none, (double)sum.bytes / fmax(1.0, (double)sum.apart / 2.0),
      (double)sum.leaves / fmax(1.0, (double)sum.apart / 2.0), sum.largest);
  cprox_certificate_free(c);
  cprox_workspace_free(ws);
}

/* Seeds 1 to 3, sizes below. */
static void a_bezier_curve_and_a_polytope_leave_a_certificate_that_holds(void **state) {
  (void)state;
  examine_many(1, 200, (asked_kinds){.bezier_only = true, .polytope_only = true}, "bezier, polytope");
}

static void every_basis_and_every_convex_kind_leave_certificates_that_hold(void **state) {
  (void)state;
  examine_many(2, 200, (asked_kinds){0}, "all kinds");
}

static void curves_against_curves_leave_certificates_that_hold(void **state) {
  (void)state;
  examine_many(3, 60, (asked_kinds){.curve_target = true}, "curve, curve");
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_bezier_curve_and_a_polytope_leave_a_certificate_that_holds),
      cmocka_unit_test(every_basis_and_every_convex_kind_leave_certificates_that_hold),
      cmocka_unit_test(curves_against_curves_leave_certificates_that_hold),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
