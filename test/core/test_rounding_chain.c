/* SPDX-License-Identifier: BSD-3-Clause */
/* T5 of doc/rounding.md against 320 bits: points at the end of a chain of revolute joints are off by no more than the
 * running sum says, and that sum is not padded: the largest error is at least FULL of it. Built with and without fused
 * multiply-add. Tolerance 0; the reference's own error is 2^-267. */
#include "base/rounding.h"
#include "kinematics/motion.h"
#include "support/cases.h"
#include "support/exact.h"
#include "support/random.h"

enum { CASES = 8000, JOINTS = 8, ENOUGH = 5000 };

#define FULL 0.1

/* Of one joint, doc/rounding.md: an axis along a coordinate; any other; what a turned origin adds. */
static const double ALIGNED = 20.0, GENERAL = 40.0, TURNED = 29.0;

typedef struct chain {
  size_t n;
  cprox_link links[JOINTS];
  double values[JOINTS];
  vec3 vertex;
} chain;

/* ---- random chains ---- */

static chain chain_random(rng *r, bool aligned) {
  static const vec3 ALONG[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const bool turned = rng_index(r, 2);
  chain c = {.n = 1 + rng_index(r, 1 + rng_index(r, JOINTS)), .vertex = rng_in_cube(r, rng_log_uniform(r, 1e-2, 1.0))};
  for (size_t i = 0; i < c.n; i++) {
    c.links[i] =
        (cprox_link){.parent = (int32_t)i - 1,
                     .type = CPROX_JOINT_REVOLUTE,
                     .origin = {.position = rng_in_cube(r, rng_log_uniform(r, 1e-2, 1.0)), .orientation = {1, 0, 0, 0}},
                     .axis = aligned ? ALONG[rng_index(r, 3)] : vec_scale(rng_log_uniform(r, 0.1, 10.0), rng_unit(r)),
                     .variable = (int32_t)i,
                     .multiplier = 1.0};
    if (turned) c.links[i].origin.orientation = rng_quat(r);
    c.values[i] = rng_index(r, 4) ? rng_uniform(r, -3.2, 3.2) : rng_awkward(r, 1.0);
  }
  return c;
}

static bool is_turned(const cprox_link *link) {
  return link->origin.orientation.w != 1.0;
}

static bool is_aligned(const cprox_link *link) {
  const vec3 z = link->axis;
  return (z.x == 0.0) + (z.y == 0.0) + (z.z == 0.0) == 2;
}

/* ---- the exact counterpart ---- */

static num3 add(num3 a, num3 b) {
  num3 out;
  for (int k = 0; k < 3; k++) out.k[k] = exact_add(a.k[k], b.k[k]);
  return out;
}

static num3 scale(num s, num3 a) {
  num3 out;
  for (int k = 0; k < 3; k++) out.k[k] = exact_mul(s, a.k[k]);
  return out;
}

static num3 cross(num3 a, num3 b) {
  num3 out;
  for (int k = 0; k < 3; k++) {
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    out.k[k] = exact_sub(exact_mul(a.k[i], b.k[j]), exact_mul(a.k[j], b.k[i]));
  }
  return out;
}

/* x + 2/q·q (w v × x + v × (v × x)) */
static num3 turn_by(cprox_quat q, num3 x) {
  const num3 v = exact3(vec(q.x, q.y, q.z)), once = cross(v, x), twice = cross(v, once);
  const num w = exact(q.w), s = exact_div(exact(2.0), exact_add(exact_mul(w, w), exact3_dot(v, v)));
  return add(x, scale(s, add(scale(w, once), twice)));
}

/* x cos + (z × x) sin + z (z·x) (1 - cos), z of unit length */
static num3 turn_about(vec3 axis, double angle, num3 x) {
  num3 z = exact3(axis);
  z = scale(exact_div(exact(1.0), exact3_norm(z)), z);
  const num c = exact_cos(exact(angle)), s = exact_sin(exact(angle));
  const num3 along = scale(exact_mul(exact3_dot(z, x), exact_sub(exact(1.0), c)), z);
  return add(add(scale(c, x), scale(s, cross(z, x))), along);
}

static num3 end_of_chain(const chain *c) {
  num3 x = exact3(c->vertex);
  for (size_t i = c->n; i-- > 0;) {
    x = turn_by(c->links[i].origin.orientation, turn_about(c->links[i].axis, c->values[i], x));
    x = add(x, exact3(c->links[i].origin.position));
  }
  return x;
}

/* ---- T5 ---- */

/* u (sum over transforms of (error of the rotation so far + 6) times the length it turns, + 3 times all computed
 * origins) */
static double running_sum(const chain *c, const placement *frames) {
  double rotation = 0.0, sum = 0.0;
  for (size_t i = 0; i < c->n; i++) {
    sum += (rotation + 6.0) * vec_norm(c->links[i].origin.position) + 3.0 * vec_norm(frames[i].p);
    rotation += (is_aligned(&c->links[i]) ? ALIGNED : GENERAL) + (is_turned(&c->links[i]) ? TURNED : 0.0);
  }
  return ROUND_UP * ROUND_U * (sum + (rotation + 6.0) * vec_norm(c->vertex));
}

static void hold_chains(uint64_t seed, bool aligned, const char *what) {
  rng r = rng_seed(seed);
  double most = 0.0;
  size_t cases = 0;
  for (size_t i = 0; i < test_cases(CASES); i++) {
    const chain c = chain_random(&r, aligned);
    cprox_robot *robot;
    placement frames[JOINTS];
    assert_int_equal(cprox_robot_create(c.links, c.n, NULL, 0, c.n, NULL, &robot), CPROX_OK);
    robot_place_axes(robot, c.values, frames);
    const vec3 end = placement_apply(&frames[c.n - 1], c.vertex);
    exact_reset();
    const double error = exact3_error(end_of_chain(&c), end), bound = running_sum(&c, frames);
    if (!(error <= bound)) fail_msg("%s: error %.17g above its bound %.17g", what, error, bound);
    most = fmax(most, error / bound);
    cases++;
    cprox_robot_free(robot);
  }
  print_message("%s: %zu cases, largest error %.3f of its bound\n", what, cases, most);
  if (cases >= ENOUGH) assert_true(most >= FULL);
}

/* Seeds 1 and 2. */
CASE(chains_about_coordinates_are_off_by_the_running_sum_at_most) {
  hold_chains(1, true, "T5, chains about coordinates");
}

CASE(chains_about_any_axes_are_off_by_the_running_sum_at_most) {
  hold_chains(2, false, "T5, chains about any axes");
}

static int give_up_numbers(void **state) {
  (void)state;
  exact_free();
  return 0;
}

int main(void) {
  return cases_run(NULL, give_up_numbers);
}
