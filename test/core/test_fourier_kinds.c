/* SPDX-License-Identifier: BSD-3-Clause */
/* Gaps of every pair of kinds of solids: those that can be proven are made for the delta that was asked, and what they
 * say of an overlap and of their over-reach holds against the distance of the same sets as convex bodies. */
#include <string.h>

#include "fourier/gap.h"
#include "support/builders.h"
#include "support/cases.h"
#include "support/solids.h"

#define MADE(call) \
  if ((call) != CPROX_OK) fail_msg("%s", cprox_workspace_error(ws))

/* A random pair of these kinds; the first and the second may be either. */
static void make_pair(rng *r, test_solid_kind i, test_solid_kind j, int dimension, test_solid s[2]) {
  const size_t swap = rng_index(r, 2);
  s[swap] = solid_make(r, i, dimension, 1.0, 3.0);
  s[1 - swap] = solid_make(r, j, dimension, 1.0, 3.0);
}

static void free_pair(test_solid s[2]) {
  solid_free(&s[0]);
  solid_free(&s[1]);
}

/* The bounding radii of both: the largest delta that may be asked. */
static double radii(const test_solid s[2]) {
  return s[0].solid->radius + s[1].solid->radius;
}

static bool is_made(const test_solid s[2]) {
  return s[0].kind != SOLID_SWEEP || s[1].kind != SOLID_SWEEP;
}

/* Whether an over-reach can be proven: not for two solids of which neither is a sum of indicators. In the plane loops
 * are. */
static bool is_provable(const test_solid s[2]) {
  int sums = 0;
  for (int k = 0; k < 2; k++) sums += s[k].kind != SOLID_SWEEP && (s[k].kind != SOLID_FOLDED || s[k].dimension == 2);
  return sums > 0;
}

/* Calls visit with a random pair of each two kinds. */
static void visit_pairs(rng *r, int dimension, void (*visit)(rng *, const test_solid[2])) {
  for (test_solid_kind i = 0; i < SOLID_KINDS; i++)
    for (test_solid_kind j = i; j < SOLID_KINDS; j++) {
      if (!solid_exists(i, dimension) || !solid_exists(j, dimension)) continue;
      test_solid s[2];
      make_pair(r, i, j, dimension, s);
      if (is_made(s)) visit(r, s);
      free_pair(s);
    }
}

static bool is_clear(cprox_gap_verdict verdict) {
  return verdict == CPROX_GAP_VERDICT_CLEAR || verdict == CPROX_GAP_VERDICT_FAR;
}

static const char *const MODES[] = {"certified", "tuned", "signal"};

static void fail_pair(const test_solid s[2], const cprox_gap_options *o, const char *what) {
  fail_msg("%d-D %s and %s, %s, delta %g of radii %g, period %g: %s", s[0].dimension, solid_name(s[0].kind),
           solid_name(s[1].kind), MODES[o->mode], o->delta, radii(s), o->period, what);
}

/* What the plan means by delta. */
static double accuracy(const gap_plan *plan) {
  return plan->mode == CPROX_GAP_MODE_SIGNAL ? 2.2 * plan->period / (2 * plan->N + 1) : plan->over_reach;
}

static cprox_status plan_with(const test_solid s[2], cprox_gap_options o, uint32_t samples, gap_plan *plan) {
  cprox_workspace_set_error(ws, NULL);
  o.samples = samples;
  if (samples > 0) o.delta = 0.0;
  return gap_plan_choose(s[0].solid, s[1].solid, &o, ws, plan);
}

/* Sets delta to what some samples have, and returns how many these are. */
static uint32_t choose_delta(rng *r, const test_solid s[2], cprox_gap_options *o) {
  gap_plan plan;
  uint32_t samples = 9 + 2 * (uint32_t)rng_index(r, 11);
  while (plan_with(s, *o, samples, &plan) != CPROX_OK || accuracy(&plan) > radii(s)) {
    samples += 4;
    if (samples > 200) fail_pair(s, o, "no samples are enough");
  }
  o->delta = accuracy(&plan);
  return samples;
}

/* What samples have delta has, with no more of them, and no fewer (looked for down to half of them). */
static void check_delta(rng *r, const test_solid s[2], cprox_gap_options *o) {
  gap_plan plan;
  const uint32_t samples = choose_delta(r, s, o);
  if (plan_with(s, *o, 0, &plan) != CPROX_OK) fail_pair(s, o, cprox_workspace_error(ws));
  assert_string_equal(cprox_workspace_error(ws), "");
  assert_true(accuracy(&plan) <= o->delta);
  if (o->period > 0.0) assert_true(plan.period == o->period);
  const uint32_t found = 2 * (uint32_t)plan.N + 1;
  if (found > samples) fail_pair(s, o, "more samples than are enough");
  for (uint32_t n = found / 4 * 2 + 3; n < found; n += 2)
    if (plan_with(s, *o, n, &plan) == CPROX_OK && accuracy(&plan) <= o->delta)
      fail_pair(s, o, "fewer samples are enough");
}

static void delta_in_every_mode(rng *r, const test_solid s[2]) {
  gap_plan plan;
  for (int mode = 0; mode < 3; mode++) {
    cprox_gap_options o = CPROX_GAP_OPTIONS_DEFAULT;
    o.mode = (cprox_gap_mode)mode;
    if (o.mode == CPROX_GAP_MODE_CERTIFIED && !is_provable(s)) {
      o.delta = radii(s);
      assert_int_equal(plan_with(s, o, 0, &plan), CPROX_INVALID);
      assert_non_null(strstr(cprox_workspace_error(ws), "no over-reach can be proven for these solids"));
      continue;
    }
    if (rng_index(r, 2)) o.period = rng_uniform(r, 3.1, 6.0) * radii(s);
    check_delta(r, s, &o);
  }
}

/* Seed 731: every pair of kinds in both dimensions and all modes, with the least period or a given one. */
CASE(delta_is_had_by_every_pair_that_can_be_proven) {
  rng r = rng_seed(731);
  for (size_t i = 0; i < test_cases(1); i++)
    for (int dimension = 2; dimension <= 3; dimension++) visit_pairs(&r, dimension, delta_in_every_mode);
}

static cprox_curve *segment(vec3 from, vec3 to) {
  return bezier((const vec3[2]){from, to}, 2);
}

/* The gap of the largest delta, its cascade and both queries along a curve answer, and speak of one pair. */
static void every_call(rng *r, const test_solid s[2]) {
  const int dimension = s[0].dimension;
  if (dimension == 3 && s[0].kind != SOLID_BOX && s[1].kind != SOLID_BOX && s[0].kind != s[1].kind) return;
  for (int mode = 0; mode < 3; mode++) {
    cprox_gap_options o = CPROX_GAP_OPTIONS_DEFAULT;
    o.mode = (cprox_gap_mode)mode, o.delta = radii(s);
    if (o.mode == CPROX_GAP_MODE_CERTIFIED && !is_provable(s)) o.samples = 9, o.delta = 0.0;
    cprox_gap *gap;
    if (cprox_gap_create(s[0].solid, s[1].solid, &o, ws, &gap) != CPROX_OK) fail_pair(s, &o, cprox_workspace_error(ws));
    const cprox_gap_info info = cprox_gap_get_info(gap);
    assert_true(info.mode == o.mode && info.guaranteed == (o.mode == CPROX_GAP_MODE_CERTIFIED));
    if (o.samples == 0 && o.mode != CPROX_GAP_MODE_SIGNAL) assert_true(info.over_reach <= o.delta);

    const cprox_pose a = solid_pose(r, dimension, 0.3), b = solid_pose(r, dimension, 0.3);
    cprox_curve *line = segment(b.position, solid_pose(r, dimension, 2.0).position);
    cprox_gap_result at, along;
    cprox_gap_along_result whole;
    double derivative;
    MADE(cprox_gap_evaluate(gap, &a, &b, ws, &at));
    MADE(cprox_gap_along(gap, &a, &(cprox_gap_carried){.curve = line, .orientation = b.orientation}, 0.0, ws, &along,
                         &derivative));
    /* the signal is -log of what has the error */
    const double x = o.mode == CPROX_GAP_MODE_SIGNAL ? exp(-at.value) : at.value,
                 y = o.mode == CPROX_GAP_MODE_SIGNAL ? exp(-along.value) : along.value;
    assert_true(along.verdict == at.verdict && fabs(x - y) <= along.error + at.error + 1e-12);
    const cprox_status status = cprox_gap_along_test(
        gap, &a, &(cprox_gap_carried){.curve = line, .orientation = b.orientation}, 0.0, 1.0, 2, ws, &whole);
    if (o.mode == CPROX_GAP_MODE_SIGNAL)
      assert_string_equal(cprox_workspace_error(ws), "the signal mode has no verdict");
    if (o.mode != CPROX_GAP_MODE_SIGNAL && status < CPROX_OK) fail_pair(s, &o, cprox_workspace_error(ws));
    cprox_curve_free(line);
    if (o.mode == CPROX_GAP_MODE_CERTIFIED) {
      cprox_gap_cascade *cascade;
      MADE(cprox_gap_cascade_create(s[0].solid, s[1].solid, &o, ws, &cascade));
      assert_int_equal(cprox_gap_get_info(cprox_gap_cascade_finest(cascade)).samples, info.samples);
      MADE(cprox_gap_cascade_test(cascade, &a, &b, ws, &along));
      if (is_clear(at.verdict)) assert_true(is_clear(along.verdict));
      cprox_gap_cascade_free(cascade);
    }
    cprox_gap_free(gap);
  }
}

/* Seed 732: one gap of every pair of kinds in each mode; in space of each kind with itself and with a box. */
CASE(every_call_takes_every_pair) {
  rng r = rng_seed(732);
  for (size_t i = 0; i < test_cases(1); i++)
    for (int dimension = 2; dimension <= 3; dimension++) visit_pairs(&r, dimension, every_call);
}

/* ---- What is said of a pair is true ---- */

static struct {
  size_t poses, clear, deep, called;
  double most;
} seen;

static bool says_clear(const cprox_gap *gap, const test_solid s[2], const cprox_pose *a, const cprox_pose *b,
                       double over_reach) {
  cprox_gap_result x, alone;
  cprox_gap by_sum = *gap; /* without bounds per direction */
  by_sum.bounds_a = by_sum.bounds_b = (enclosures){0};
  MADE(cprox_gap_test(&by_sum, a, b, ws, &x));
  MADE(cprox_gap_test(gap, a, b, ws, &alone));
  const bool clear = is_clear(x.verdict);
  const double d = solid_distance(&s[0], a, &s[1], b), reached = solid_reached(&s[0], a, &s[1], b);
  seen.poses++, seen.clear += clear, seen.deep += d < -1e-9;
  if (clear && !is_clear(alone.verdict))
    fail_msg("with bounds per direction the verdict is %d, without it is clear", alone.verdict);
  if (is_clear(alone.verdict) && d < -1e-6)
    fail_msg("%s and %s: clear at an overlap of %g, value %g", solid_name(s[0].kind), solid_name(s[1].kind), -d,
             x.value);
  if (!clear && reached > over_reach)
    fail_msg("%s and %s: called colliding %g apart, over-reach %g", solid_name(s[0].kind), solid_name(s[1].kind),
             reached, over_reach);
  if (!clear) seen.most = fmax(seen.most, reached / over_reach);
  return clear;
}

/* Along random lines out of the other solid, halving to where the verdict changes. */
static void verdict_holds(rng *r, const test_solid s[2]) {
  cprox_gap_options o = CPROX_GAP_OPTIONS_DEFAULT;
  o.samples = 7 + 2 * (uint32_t)rng_index(r, 3);
  cprox_gap *gap;
  MADE(cprox_gap_create(s[0].solid, s[1].solid, &o, ws, &gap));
  const double over_reach = cprox_gap_get_info(gap).over_reach;
  for (size_t i = 0; i < test_cases(3); i++) {
    const cprox_pose a = solid_pose(r, s[0].dimension, 1.0);
    cprox_pose b = solid_pose(r, s[0].dimension, 1.0);
    vec3 way = rng_unit(r);
    if (s[0].dimension == 2) way.z = 0.0;
    double near = 0.0, far = 3.0 * radii(s);
    for (int k = 0; k < 12; k++) {
      const double at = k == 0 ? near : 0.5 * (near + far);
      b.position = vec_axpy(a.position, at, way);
      if (says_clear(gap, s, &a, &b, over_reach))
        far = at;
      else
        near = at;
    }
  }
  cprox_gap_free(gap);
}

/* Seed 733: certified gaps of every pair of kinds at n = 7 … 11. No overlap deeper than 1e-6 is called clear, nothing
 * beyond the over-reach is called colliding. */
CASE(over_reach_holds_for_every_pair) {
  rng r = rng_seed(733);
  for (int dimension = 2; dimension <= 3; dimension++) {
    memset(&seen, 0, sizeof seen);
    for (size_t i = 0; i < test_cases(1); i++) visit_pairs(&r, dimension, verdict_holds);
    print_message("%d-D: %zu poses, %zu clear, %zu overlapping, reached %.3f of the over-reach\n", dimension,
                  seen.poses, seen.clear, seen.deep, seen.most);
    assert_true(seen.clear > seen.poses / 10 && seen.deep > seen.poses / 50 && seen.most > 0.3);
  }
}

/* ---- Bounds per direction ---- */

static void bounds_hold(rng *r, const test_solid s[2]) {
  cprox_gap_options o = CPROX_GAP_OPTIONS_DEFAULT;
  o.samples = 7;
  cprox_gap *gap;
  MADE(cprox_gap_create(s[0].solid, s[1].solid, &o, ws, &gap));
  for (size_t i = 0; i < test_cases(20); i++) {
    const cprox_pose a = solid_pose(r, s[0].dimension, 5.0);
    cprox_pose b = solid_pose(r, s[0].dimension, 1.0);
    vec3 way = rng_unit(r);
    if (s[0].dimension == 2) way.z = 0.0;
    b.position = vec_axpy(a.position, radii(s) * rng_uniform(r, 0.2, 1.1), way);
    const double d = solid_distance(&s[0], &a, &s[1], &b), bound = gap_clearance(gap, &a, &b);
    seen.poses++, seen.deep += d < 0.0;
    if (d > 0.1 * radii(s)) seen.clear++, seen.called += bound > 0.0;
    if (bound > fmax(d, 0.0) + (s[0].kind == SOLID_SWEEP || s[1].kind == SOLID_SWEEP ? 1e-6 : 1e-9))
      fail_msg("%d-D %s and %s: %.17g apart by directions, %.17g by their distance", s[0].dimension,
               solid_name(s[0].kind), solid_name(s[1].kind), bound, d);
    cprox_gap_result x;
    MADE(cprox_gap_test(gap, &a, &b, ws, &x));
    assert_true(x.clearance == bound && (x.verdict == CPROX_GAP_VERDICT_FAR) == (bound > 0.0));
  }
  cprox_gap_free(gap);
}

/* Seed 734: of every pair of kinds, against the distance of the same sets. */
CASE(bounds_per_direction_are_below_the_distance_of_every_pair) {
  rng r = rng_seed(734);
  for (int dimension = 2; dimension <= 3; dimension++) {
    memset(&seen, 0, sizeof seen);
    for (size_t i = 0; i < test_cases(1); i++) visit_pairs(&r, dimension, bounds_hold);
    print_message("%d-D: %zu poses, %zu overlapping, of %zu apart by a tenth of the size %zu separated\n", dimension,
                  seen.poses, seen.deep, seen.clear, seen.called);
    assert_true(seen.deep > seen.poses / 10 && seen.called > seen.clear / 2);
  }
}

int main(void) {
  return cases_run(workspace_setup, workspace_teardown);
}
