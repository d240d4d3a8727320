/* SPDX-License-Identifier: BSD-3-Clause */
/* Kinematics and motion bounds of random robots with every type of joint, against long double. Tolerances are the
 * bounds that the core itself states, rounding included; long double adds at most 1e-17. */
#include <math.h>

#include "kinematics/bound.h"
#include "support/cases.h"
#include "support/robots.h"

enum { MAX_AXES = 4 * TEST_MAX_LINKS, SAMPLES = 8 };

/* ---- kinematics ---- */

CASE(parts_are_within_their_error_of_where_they_are) {
  rng r = rng_seed(4401);
  double worst = 0.0;
  for (size_t i = 0; i < test_cases(2000); i++) {
    test_robot t;
    robot_make(&r, rng_log_uniform(&r, 0.01, 3), &t);
    for (int k = 0; k < 5; k++) {
      const size_t segment = rng_index(&r, t.motion->n_segments);
      const double u = rng_uniform(&r, 0, 1);
      const double off = robot_part_error(&t, segment, u);
      worst = fmax(worst, off);
      if (!(off <= 1.0)) fail_msg("robot %zu: a part is off by %.3g times what it is said to be at most", i, off);
    }
    robot_free(&t);
  }
  print_message("largest error / bound: %.3f\n", worst);
  assert_true(worst > 1e-3);
}

CASE(evaluation_agrees_with_the_splines) {
  rng r = rng_seed(4402);
  for (size_t i = 0; i < test_cases(500); i++) {
    test_robot t;
    robot_make(&r, 2.0, &t);
    double values[TEST_MAX_VARIABLES + 1];
    const cprox_motion_info info = cprox_motion_get_info(t.motion);
    const double t0 = info.t0, t1 = info.t1;
    long double exact[TEST_MAX_VARIABLES + 1];
    const double time = rng_uniform(&r, t0, t1);
    cprox_motion_evaluate(t.motion, time, values);
    robot_ref_values(&t, time, exact);
    for (size_t k = 0; k < t.n_variables; k++) assert_true(fabsl(exact[k] - values[k]) <= 1e-13L);

    ref_pose links[TEST_MAX_LINKS];
    robot_ref_links(&t, exact, links);
    for (size_t l = 0; l < t.n_links; l++) {
      vec3 position;
      double rotation[9];
      cprox_robot_link_frame(t.robot, values, l, &position, rotation);
      const vec3l x = ref_pose_apply(&links[l], (vec3l){1, 0, 0});
      assert_true(ref_error(links[l].p, position) <= 1e-12L);
      assert_true(ref_error(ref_sub(x, links[l].p), vec(rotation[0], rotation[3], rotation[6])) <= 1e-12L);
    }
    robot_free(&t);
  }
}

/* ---- bounds ---- */

/* An interval of a motion, one geometry seen from another one or from the world. */
typedef struct bound_case {
  size_t segment, moving;
  int standing; /* -1: the world */
  double a, b;
} bound_case;

static bound_case random_case(rng *r, const test_robot *t) {
  bound_case c = {.segment = rng_index(r, t->motion->n_segments), .moving = rng_index(r, t->n_links), .standing = -1};
  if (rng_index(r, 2)) c.standing = (int)rng_index(r, t->n_links);
  const double width = rng_log_uniform(r, 1e-4, 1.0);
  c.a = rng_uniform(r, 0, 1.0 - width);
  c.b = fmin(c.a + width, 1.0);
  return c;
}

/* The vertices of the moving geometry as the standing one sees them, brought to where the standing one is in the
 * middle. */
static void seen_vertices(const test_robot *t, const bound_case *c, long double u, const ref_pose *middle,
                          vec3l *seen) {
  const long double t0 = t->motion->times[c->segment], t1 = t->motion->times[c->segment + 1];
  long double values[TEST_MAX_VARIABLES + 1];
  ref_pose links[TEST_MAX_LINKS];
  robot_ref_values(t, (1 - u) * t0 + u * t1, values);
  robot_ref_links(t, values, links);
  robot_ref_vertices(t, links, c->moving, seen);
  if (c->standing < 0) return;
  for (size_t v = 0; v < TEST_VERTICES; v++)
    seen[v] = ref_pose_apply(middle, ref_pose_undo(&links[c->standing], seen[v]));
}

static ref_pose pose_in_the_middle(const test_robot *t, const bound_case *c) {
  const long double u = ((long double)c->a + c->b) / 2;
  const long double t0 = t->motion->times[c->segment], t1 = t->motion->times[c->segment + 1];
  long double values[TEST_MAX_VARIABLES + 1];
  ref_pose links[TEST_MAX_LINKS];
  robot_ref_values(t, (1 - u) * t0 + u * t1, values);
  robot_ref_links(t, values, links);
  return links[c->standing < 0 ? 0 : c->standing];
}

/* What the core says of the case: how far the part travels, and how far it stays above planes with the normal n. */
typedef struct bound_claim {
  chain_motion motion;
  double second, both; /* n·x is at least this */
} bound_claim;

static bound_claim claim_of(const test_robot *t, const bound_case *c, vec3 n, vec3 drift) {
  double rows[MOTION_ROWS * (TEST_MAX_VARIABLES + MOTION_LANES)], scratch[MAX_AXES];
  axis_state axes[MAX_AXES + 1];
  chain_axis chain[MAX_AXES];
  placement frames[MAX_AXES + 1];
  motion_node(t->motion, c->segment, c->a, c->b, rows, axes);
  for (size_t i = 0; i < t->robot->n_axes; i++) frames[i] = axes[i].frame;
  const robot_part *part = &t->robot->parts[c->moving];
  const placement at = placement_under(frames, part->axis, &part->at);
  const double error = t->motion->part_error[c->moving];
  const size_t length =
      motion_chain(t->motion, c->standing < 0 ? -1 : t->robot->parts[c->standing].axis, part->axis, chain);
  bound_claim claim;
  motion_of_part(axes, chain, length, at.p, part->model.radius + error, scratch, &claim.motion);

  /* against the origin of the world: a point that stands there */
  cprox_body *origin;
  assert_int_equal(cprox_body_create_point(vec(0, 0, 0), NULL, &origin), CPROX_OK);
  const bound_side moving = {.shape = part->model.shape,
                             .at = at,
                             .margin = part->model.margin,
                             .error = error,
                             .middle = part->model.middle,
                             .half = part->model.half};
  const bound_side standing = {.shape = &origin->shape,
                               .at = {.r = {1, 0, 0, 0, 1, 0, 0, 0, 1}},
                               .error = c->standing < 0 ? 0.0 : t->motion->part_error[c->standing]};
  const uint32_t steps = part->steps + (c->standing < 0 ? 0 : t->robot->parts[c->standing].steps);
  double slack;
  const double heights[2] = {bound_height(&standing, vec_axpy(n, -0.5, drift)),
                             bound_height(&standing, vec_axpy(n, 0.5, drift))};
  claim.second = motion_plane_bound(&claim.motion, &moving, &standing, n, drift, heights, steps, -INFINITY, &slack);
  claim.both = motion_plane_bound(&claim.motion, &moving, &standing, n, drift, heights, steps, INFINITY, &slack);
  cprox_body_free(origin);
  return claim;
}

/* At least 1e5 random pairs of an interval and two geometries (or one and the world), over all types of joint. */
CASE(no_point_is_nearer_than_the_bounds_say) {
  rng r = rng_seed(4403);
  size_t checks = 0, third_wins = 0;
  for (size_t i = 0; i < test_cases(2000); i++) {
    test_robot t;
    robot_make(&r, rng_log_uniform(&r, 0.05, 2), &t);
    for (int k = 0; k < 52; k++) {
      const bound_case c = random_case(&r, &t);
      vec3 n = rng_unit(&r);
      n = vec_scale(1.0 / vec_norm(n), n);
      vec3 drift = rng_index(&r, 3) ? vec_scale(rng_log_uniform(&r, 1e-3, 1), rng_unit(&r)) : vec(0, 0, 0);
      drift = vec_axpy(drift, -vec_dot(drift, n), n);
      const bound_claim claim = claim_of(&t, &c, n, drift);
      const ref_pose middle = pose_in_the_middle(&t, &c);
      vec3l at_middle[TEST_VERTICES], seen[TEST_VERTICES];
      seen_vertices(&t, &c, ((long double)c.a + c.b) / 2, &middle, at_middle);
      third_wins += claim.both > claim.second;
      checks++;
      for (int s = 0; s <= SAMPLES; s++) {
        const long double u = c.a + ((long double)c.b - c.a) * s / SAMPLES;
        seen_vertices(&t, &c, u, &middle, seen);
        for (size_t v = 0; v < TEST_VERTICES; v++) {
          const vec3l turned = ref_add(ref_vec(n), ref_scale((long double)s / SAMPLES - 0.5L, ref_vec(drift)));
          const long double height = ref_dot(turned, seen[v]) / ref_norm(turned) - t.margin;
          const long double way = ref_norm(ref_sub(seen[v], at_middle[v]));
          if (height < claim.both || height < claim.second)
            fail_msg("robot %zu case %d: height %.17Lg below the bounds %.17g, %.17g", i, k, height, claim.second,
                     claim.both);
          if (way > claim.motion.displacement + 1e-15L)
            fail_msg("robot %zu case %d: travels %.17Lg, said to be at most %.17g", i, k, way,
                     claim.motion.displacement);
        }
      }
    }
    robot_free(&t);
  }
  print_message("%zu checks; the bound of third order is the better one in %.0f %%\n", checks,
                100.0 * (double)third_wins / (double)checks);
}

/* ---- balls ---- */

/* The angular velocity of a floating link at u of a segment, by u, from central differences of its quaternion in long
 * double. */
static vec3l angular_velocity(const test_robot *t, size_t segment, int32_t variable, long double u) {
  static const long double STEP = 1e-5L;
  const long double t0 = t->motion->times[segment], t1 = t->motion->times[segment + 1];
  long double q[3][TEST_MAX_VARIABLES + 1];
  for (int k = 0; k < 3; k++) robot_ref_values(t, t0 + (t1 - t0) * (u + (k - 1) * STEP), q[k]);
  const long double *p = q[1] + variable;
  long double d[4], square = 0;
  for (int k = 0; k < 4; k++) {
    d[k] = (q[2][variable + k] - q[0][variable + k]) / (2 * STEP);
    square += p[k] * p[k];
  }
  const vec3l a = {d[0], d[1], d[2]}, b = {p[0], p[1], p[2]};
  return ref_scale(2 / square, ref_sub(ref_sub(ref_scale(p[3], a), ref_scale(d[3], b)), ref_cross(a, b)));
}

/* Differences of differences leave 1e-5 of the rates. */
CASE(balls_turn_no_faster_than_said) {
  static const long double STEP = 1e-3L, LEFT = 1e-5L;
  rng r = rng_seed(4405);
  double nearest[3] = {0};
  for (size_t i = 0; i < test_cases(1500); i++) {
    test_robot t;
    robot_make(&r, 4.0, &t);
    for (size_t axis = 0; axis < t.robot->n_axes; axis++) {
      if (t.robot->axes[axis].kind != AXIS_BALL || t.spline) continue;
      const double a = rng_uniform(&r, 0.1, 0.8), width = 0.05;
      double rows[MOTION_ROWS * (TEST_MAX_VARIABLES + MOTION_LANES)];
      axis_state axes[MAX_AXES + 1];
      motion_node(t.motion, 0, a, a + width, rows, axes);
      vec3l omega[4];
      const long double u = a + 0.5L * width;
      for (int k = 0; k < 4; k++) omega[k] = angular_velocity(&t, 0, t.robot->axes[axis].variable, u + (k - 1) * STEP);
      const vec3l second = ref_add(ref_sub(omega[2], ref_scale(2, omega[1])), omega[0]);
      const long double rate[3] = {width * ref_norm(omega[1]),
                                   width * width * ref_norm(ref_sub(omega[2], omega[0])) / (2 * STEP),
                                   width * width * width * ref_norm(second) / (STEP * STEP)};
      const double said[3] = {axes[axis].w, axes[axis].a, axes[axis].g};
      for (int k = 0; k < 3; k++) {
        if (rate[k] > said[k] * (1 + LEFT) + LEFT * width)
          fail_msg("robot %zu axis %zu: derivative %d is %.9Lg, said to be at most %.9g", i, axis, k + 1, rate[k],
                   said[k]);
        if (said[k] > 0.0) nearest[k] = fmax(nearest[k], (double)rate[k] / said[k]);
      }
    }
    robot_free(&t);
  }
  print_message("largest rate / bound: %.3f, %.3f, %.3f\n", nearest[0], nearest[1], nearest[2]);
  assert_true(nearest[0] > 0.5 && nearest[1] > 0.3 && nearest[2] > 0.1);
}

/* Halving a node takes the bound of third order an eighth nearer, that of second order a quarter, the travel a half. */
CASE(bounds_are_of_their_order) {
  rng r = rng_seed(4404);
  double log_ratio[3] = {0};
  size_t counted = 0;
  for (size_t i = 0; i < 400; i++) {
    test_robot t;
    robot_make(&r, 1.0, &t);
    bound_case c = {.segment = 0, .moving = t.n_links - 1, .standing = -1};
    vec3 n = rng_unit(&r);
    n = vec_scale(1.0 / vec_norm(n), n);
    double gap[2][3];
    for (int k = 0; k < 2; k++) {
      c.a = 0.5 - (k == 0 ? 0.005 : 0.0025), c.b = 1.0 - c.a;
      const bound_claim claim = claim_of(&t, &c, n, vec(0, 0, 0));
      vec3l seen[TEST_VERTICES];
      const ref_pose middle = pose_in_the_middle(&t, &c);
      long double least = HUGE_VALL;
      for (int s = 0; s <= 200; s++) {
        seen_vertices(&t, &c, c.a + ((long double)c.b - c.a) * s / 200, &middle, seen);
        for (size_t v = 0; v < TEST_VERTICES; v++) least = fminl(least, ref_dot(ref_vec(n), seen[v]) - t.margin);
      }
      gap[k][0] = claim.motion.displacement;
      gap[k][1] = claim.motion.second;
      gap[k][2] = claim.motion.third;
      assert_true((double)least - claim.both <= 0.25 * claim.motion.second + 1e-11);
    }
    if (gap[0][2] > 1e-12) {
      for (int k = 0; k < 3; k++) log_ratio[k] += log2(gap[0][k] / gap[1][k]);
      counted++;
    }
    robot_free(&t);
  }
  assert_true(counted > 100);
  for (int k = 0; k < 3; k++) assert_true(fabs(log_ratio[k] / (double)counted - (k + 1)) < 0.1);
}

int main(void) {
  return cases_run(NULL, NULL);
}
