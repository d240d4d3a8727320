/* SPDX-License-Identifier: BSD-3-Clause */
/* Poses by slerp, by screws and by rotation vectors: kinematics, bounds on an interval of a segment and on spans of
 * segments, against long double. Tolerances are the bounds that the core itself states, rounding included. */
#include <math.h>
#include <string.h>

#include "kinematics/bound.h"
#include "support/builders.h"
#include "support/cases.h"
#include "support/of_list.h"
#include "support/robots.h"

enum { MAX_AXES = 4 * TEST_MAX_LINKS, SAMPLES = 8, TURNINGS = 3 };

static const cprox_pose HERE = {.orientation = {.w = 1.0}};

/* Small and large turns. */
static void any_robot(rng *r, size_t i, size_t points, test_robot *t) {
  *t = (test_robot){0};
  robot_make_turning(r, rng_log_uniform(r, rng_index(r, 3) ? 0.02 : 1e-9, 4), (cprox_turning)(i % TURNINGS), points, t);
}

/* Long steps beside short ones: a span's waypoints then say little of the way between them. */
static void make_uneven(rng *r, test_robot *t) {
  double steps[TEST_MAX_WAYPOINTS][TEST_MAX_VARIABLES];
  for (size_t i = 1; i < t->n_points; i++) {
    const double part = rng_index(r, 2) ? rng_log_uniform(r, 1e-6, 1e-3) : 1.0;
    for (size_t k = 0; k < t->n_variables; k++) steps[i][k] = part * (t->positions[i][k] - t->positions[i - 1][k]);
  }
  for (size_t i = 1; i < t->n_points; i++)
    for (size_t k = 0; k < t->n_variables; k++) t->positions[i][k] = t->positions[i - 1][k] + steps[i][k];
  robot_rebuild(t);
}

/* Even steps along a line, turning to and fro: waypoints on a straight line say nothing of the arcs between them. Small
 * bodies, so that it matters where they are and not how they turn. */
static void make_zigzag(test_robot *t) {
  for (size_t i = 0; i < t->n_links; i++) {
    for (size_t k = 0; k < TEST_VERTICES; k++) t->vertices[i][k] = vec_scale(0.01, t->vertices[i][k]);
    cprox_body_free((cprox_body *)t->geometries[i].body);
    cprox_body *body = NULL;
    assert_int_equal(cprox_body_create_polytope(t->vertices[i], TEST_VERTICES, NULL, &body), CPROX_OK);
    t->geometries[i].body = body;
    t->geometries[i].pose.position = vec_scale(0.01, t->geometries[i].pose.position);
  }
  for (size_t i = 2; i < t->n_points; i++)
    for (size_t k = 0; k < t->n_variables; k++)
      t->positions[i][k] = t->positions[0][k] + (double)i * (t->positions[1][k] - t->positions[0][k]);
  for (size_t l = 0; l < t->n_links; l++)
    for (size_t i = 2; i < t->n_points && t->links[l].type == CPROX_JOINT_FLOATING; i++)
      for (size_t k = 3; k < 7; k++) {
        const size_t v = (size_t)t->links[l].variable + k;
        t->positions[i][v] = t->positions[i % 2][v];
      }
  robot_rebuild(t);
}

/* ---- kinematics ---- */

CASE(parts_are_within_their_error_of_where_they_are) {
  rng r = rng_seed(7101);
  double worst[TURNINGS] = {0};
  for (size_t i = 0; i < test_cases(800); i++) {
    test_robot t;
    any_robot(&r, i, 2 + rng_index(&r, 4), &t);
    for (int k = 0; k < 6; k++) {
      const size_t segment = rng_index(&r, t.motion->n_segments);
      const double u = k < 2 ? k : rng_uniform(&r, 0, 1);
      const double off = robot_part_error(&t, segment, u);
      worst[i % TURNINGS] = fmax(worst[i % TURNINGS], off);
      if (!(off <= 1.0)) fail_msg("robot %zu: a part is off by %.3g times what it is said to be at most", i, off);
    }
    robot_free(&t);
  }
  print_message("largest error / bound: %.3f, slerp %.3f, screws %.3f\n", worst[0], worst[1], worst[2]);
}

/* ---- bounds ---- */

/* One geometry seen from another one or from the world, and what the core says of an interval. */
typedef struct bound_case {
  motion_interval over;
  size_t moving;
  int standing; /* -1: the world */
  size_t centre_segment;
  double centre; /* u of that */
  chain_motion motion;
  double second, both; /* n·x is at least this */
} bound_case;

static void claim(const test_robot *t, vec3 n, vec3 drift, bound_case *c) {
  double rows[MOTION_ROWS * (TEST_MAX_VARIABLES + MOTION_LANES)], scratch[MAX_AXES];
  axis_state axes[MAX_AXES + 1];
  chain_axis chain[MAX_AXES];
  placement frames[MAX_AXES + 1];
  c->centre_segment = c->over.first, c->centre = 0.5 * (c->over.a + c->over.b);
  if (motion_is_span(&c->over)) {
    const span_centre centre = motion_span_node(t->motion, &c->over, rows, axes);
    c->centre_segment = centre.segment, c->centre = centre.u;
  } else {
    motion_node(t->motion, c->over.first, c->over.a, c->over.b, rows, axes);
  }
  for (size_t i = 0; i < t->robot->n_axes; i++) frames[i] = axes[i].frame;
  const robot_part *part = &t->robot->parts[c->moving];
  const placement at = placement_under(frames, part->axis, &part->at);
  const double error = t->motion->part_error[c->moving];
  const size_t length =
      motion_chain(t->motion, c->standing < 0 ? -1 : t->robot->parts[c->standing].axis, part->axis, chain);
  motion_of_part(axes, chain, length, at.p, part->model.radius + error, scratch, &c->motion);
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
  c->second = motion_plane_bound(&c->motion, &moving, &standing, n, drift, heights, steps, -INFINITY, &slack);
  c->both = motion_plane_bound(&c->motion, &moving, &standing, n, drift, heights, steps, INFINITY, &slack);
  cprox_body_free(origin);
}

static void links_at(const test_robot *t, size_t segment, long double u, ref_pose *links) {
  const long double t0 = t->motion->times[segment], t1 = t->motion->times[segment + 1];
  long double values[TEST_MAX_VARIABLES + 1];
  robot_ref_values(t, (1 - u) * t0 + u * t1, values);
  robot_ref_links(t, values, links);
}

/* The vertices of the moving geometry as the standing one sees them, brought to where the standing one is in the
 * middle. */
static void seen_vertices(const test_robot *t, const bound_case *c, size_t segment, long double u,
                          const ref_pose *middle, vec3l *seen) {
  ref_pose links[TEST_MAX_LINKS];
  links_at(t, segment, u, links);
  robot_ref_vertices(t, links, c->moving, seen);
  for (size_t v = 0; v < TEST_VERTICES && c->standing >= 0; v++)
    seen[v] = ref_pose_apply(middle, ref_pose_undo(&links[c->standing], seen[v]));
}

static void check_case(const test_robot *t, size_t i, const bound_case *c, vec3 n, vec3 drift) {
  ref_pose links[TEST_MAX_LINKS];
  links_at(t, c->centre_segment, c->centre, links);
  const ref_pose middle = links[c->standing < 0 ? 0 : c->standing];
  vec3l at_middle[TEST_VERTICES], seen[TEST_VERTICES];
  seen_vertices(t, c, c->centre_segment, c->centre, &middle, at_middle);
  for (size_t segment = c->over.first; segment < c->over.last; segment++) {
    const double a = segment == c->over.first ? c->over.a : 0.0, b = segment + 1 == c->over.last ? c->over.b : 1.0;
    for (int s = 0; s <= SAMPLES; s++) {
      const long double part = (long double)s / SAMPLES;
      seen_vertices(t, c, segment, a + ((long double)b - a) * part, &middle, seen);
      const vec3l turned = ref_add(ref_vec(n), ref_scale(part - 0.5L, ref_vec(drift)));
      for (size_t v = 0; v < TEST_VERTICES; v++) {
        const long double height = ref_dot(turned, seen[v]) / ref_norm(turned) - t->margin;
        const long double way = ref_norm(ref_sub(seen[v], at_middle[v]));
        if (height < c->both || height < c->second)
          fail_msg("robot %zu: height %.17Lg below the bounds %.17g, %.17g", i, height, c->second, c->both);
        if (way > c->motion.displacement + 1e-14L)
          fail_msg("robot %zu: moves %.17Lg, said to be at most %.17g", i, way, c->motion.displacement);
      }
    }
  }
}

static void any_sides(rng *r, const test_robot *t, bound_case *c, vec3 *n) {
  *c = (bound_case){.moving = rng_index(r, t->n_links), .standing = -1};
  if (rng_index(r, 2)) c->standing = (int)rng_index(r, t->n_links);
  *n = rng_unit(r);
  *n = vec_scale(1.0 / vec_norm(*n), *n);
}

CASE(no_point_is_nearer_than_the_bounds_of_an_interval_say) {
  rng r = rng_seed(7102);
  for (size_t i = 0; i < test_cases(300); i++) {
    test_robot t;
    any_robot(&r, i, 2 + rng_index(&r, 4), &t);
    for (int k = 0; k < 40; k++) {
      bound_case c;
      vec3 n;
      any_sides(&r, &t, &c, &n);
      const size_t segment = rng_index(&r, t.motion->n_segments);
      const double width = rng_log_uniform(&r, 1e-4, 1.0), a = rng_uniform(&r, 0, 1.0 - width);
      c.over = (motion_interval){.a = a, .b = fmin(a + width, 1.0), .first = segment, .last = segment + 1};
      vec3 drift = rng_index(&r, 3) ? vec_scale(rng_log_uniform(&r, 1e-3, 1), rng_unit(&r)) : vec(0, 0, 0);
      drift = vec_axpy(drift, -vec_dot(drift, n), n);
      claim(&t, n, drift, &c);
      check_case(&t, i, &c, n, drift);
    }
    robot_free(&t);
  }
}

CASE(no_point_is_nearer_than_the_bounds_of_a_span_say) {
  rng r = rng_seed(7103);
  for (size_t i = 0; i < test_cases(90); i++) {
    test_robot t;
    const bool few = rng_index(&r, 2);
    any_robot(&r, i, few ? 3 : TEST_WAYPOINTS + 1 + rng_index(&r, TEST_MAX_WAYPOINTS - TEST_WAYPOINTS - 1), &t);
    if (!t.spline && few && rng_index(&r, 2))
      make_zigzag(&t);
    else if (!t.spline && rng_index(&r, 3))
      make_uneven(&r, &t);
    for (int k = 0; k < 20 && t.motion->n_segments > 1; k++) {
      bound_case c;
      vec3 n;
      any_sides(&r, &t, &c, &n);
      c.over.first = rng_index(&r, t.motion->n_segments - 1);
      const size_t most = t.motion->n_segments - c.over.first - 1;
      c.over.last = c.over.first + 2 + (most > 0 ? rng_index(&r, most < 6 || rng_index(&r, 3) == 0 ? most : 6) : 0);
      c.over.a = rng_index(&r, 2) ? 0.0 : rng_uniform(&r, 0, 1),
      c.over.b = rng_index(&r, 2) ? 1.0 : rng_uniform(&r, 0, 1);
      claim(&t, n, vec(0, 0, 0), &c);
      check_case(&t, i, &c, n, vec(0, 0, 0));
    }
    robot_free(&t);
  }
}

/* Spans take arcs for the straight line between their waypoints. */
CASE(arcs_stay_as_near_to_their_chords_as_said) {
  rng r = rng_seed(7105);
  double nearest[2] = {0};
  for (size_t i = 0; i < test_cases(3000); i++) {
    const double angle = rng_log_uniform(&r, 1e-6, 3.1);
    const vec3 u = rng_unit(&r), p0 = rng_in_cube(&r, 2.0), p1 = rng_in_cube(&r, 2.0);
    const cprox_quat given = rng_quat(&r);
    const double q0[4] = {given.x, given.y, given.z, given.w}, c = cos(angle / 2), s = sin(angle / 2);
    const vec3 v = vec(given.x, given.y, given.z);
    const vec3 turned = vec_add(vec_add(vec_scale(c, v), vec_scale(s * given.w, u)), vec_scale(s, vec_cross(u, v)));
    const double q1[4] = {turned.x, turned.y, turned.z, c * given.w - s * vec_dot(u, v)};
    const motion_arc arc = arc_screw(q0, q1, p0, p1);
    double position;
    const double orientation = arc_sagitta(&arc, &position);
    for (int k = 0; k <= 16; k++) {
      const double t = k / 16.0;
      double q[4], off = 0.0;
      vec3 p[3];
      arc_orientation(&arc, t, q);
      arc_position(&arc, t, p);
      for (int j = 0; j < 4; j++) off += pow(q[j] - (1.0 - t) * q0[j] - t * q1[j], 2);
      const double aside = vec_norm(vec_sub(p[0], vec_axpy(p0, t, vec_sub(p1, p0))));
      assert_true(sqrt(off) <= orientation + 1e-15 && aside <= position + 1e-14);
      nearest[0] = fmax(nearest[0], sqrt(off) / (orientation + 1e-12));
      nearest[1] = fmax(nearest[1], aside / (position + 1e-12));
    }
  }
  print_message("largest distance / bound: quaternions %.3f, positions %.3f\n", nearest[0], nearest[1]);
  assert_true(nearest[0] > 0.9 && nearest[1] > 0.9);
}

/* ---- rates ---- */

/* That of the first link, by u, from central differences in long double. */
static vec3l angular_velocity(const test_robot *t, size_t segment, long double u) {
  static const long double STEP = 1e-5L;
  ref_pose before[TEST_MAX_LINKS], here[TEST_MAX_LINKS], after[TEST_MAX_LINKS];
  links_at(t, segment, u - STEP, before);
  links_at(t, segment, u, here);
  links_at(t, segment, u + STEP, after);
  const long double *p = here[0].q;
  long double d[4], along = 0;
  for (int k = 0; k < 4; k++) along += before[0].q[k] * after[0].q[k];
  for (int k = 0; k < 4; k++) d[k] = (after[0].q[k] - (along < 0 ? -1 : 1) * before[0].q[k]) / (2 * STEP);
  const vec3l a = {d[0], d[1], d[2]}, b = {p[0], p[1], p[2]};
  const vec3l omega = ref_scale(2, ref_sub(ref_sub(ref_scale(p[3], a), ref_scale(d[3], b)), ref_cross(a, b)));
  long double sign = 0; /* a quaternion and its opposite are one rotation */
  for (int k = 0; k < 4; k++) sign += p[k] * after[0].q[k];
  return ref_scale(sign < 0 ? -1 : 1, omega);
}

/* Differences of differences leave 1e-5 of the rates; rotation vectors that go straight come near their bounds. */
CASE(joints_turn_no_faster_than_said) {
  static const long double STEP = 1e-3L, LEFT = 1e-5L;
  rng r = rng_seed(7104);
  double nearest[3] = {0};
  for (size_t i = 0; i < test_cases(900); i++) {
    test_robot t;
    any_robot(&r, i, 2 + rng_index(&r, 3), &t);
    const double a = rng_uniform(&r, 0.1, 0.8), width = 0.05;
    double rows[MOTION_ROWS * (TEST_MAX_VARIABLES + MOTION_LANES)];
    axis_state axes[MAX_AXES + 1];
    motion_node(t.motion, 0, a, a + width, rows, axes);
    const axis_state *axis = &axes[t.robot->links[0].axis];
    vec3l omega[3];
    for (int k = 0; k < 3; k++) omega[k] = angular_velocity(&t, 0, a + 0.5L * width + (k - 1) * STEP);
    const vec3l second = ref_add(ref_sub(omega[2], ref_scale(2, omega[1])), omega[0]);
    const long double rate[3] = {width * ref_norm(omega[1]),
                                 width * width * ref_norm(ref_sub(omega[2], omega[0])) / (2 * STEP),
                                 width * width * width * ref_norm(second) / (STEP * STEP)};
    const double said[3] = {axis->w, axis->a, axis->g};
    const bool straight =
        t.links[0].type == CPROX_JOINT_ROTATION_VECTOR && !t.spline && t.interpolation == CPROX_INTERPOLATION_LINEAR;
    for (int k = 0; k < 3; k++) {
      if (rate[k] > said[k] * (1 + LEFT) + LEFT * powl(width, k + 1))
        fail_msg("robot %zu: derivative %d is %.9Lg, said to be at most %.9g", i, k + 1, rate[k], said[k]);
      if (straight && said[k] > 1e-6) nearest[k] = fmax(nearest[k], (double)rate[k] / said[k]);
    }
    robot_free(&t);
  }
  print_message("largest rate / bound: %.3f, %.3f, %.3f\n", nearest[0], nearest[1], nearest[2]);
  assert_true(nearest[0] > 0.9 && nearest[1] > 0.3 && nearest[2] > 0.1);
}

/* ---- exact poses ---- */

/* A body on one floating joint between two poses. */
typedef struct mover {
  cprox_body *body;
  cprox_robot *robot;
  cprox_motion *motion;
} mover;

static const int32_t SEVEN[7] = {0, 1, 2, 3, 4, 5, 6};

static mover mover_make(cprox_body *body, const double from[7], const double to[7], cprox_turning turning) {
  mover m = {.body = body};
  const cprox_link link = {.parent = -1, .type = CPROX_JOINT_FLOATING, .origin = HERE};
  const cprox_link_geometry geometry = {.body = body, .pose = HERE};
  assert_int_equal(cprox_robot_create(&link, 1, &geometry, 1, 7, ws, &m.robot), CPROX_OK);
  const cprox_waypoint ends[2] = {{.time = 0, .positions = from}, {.time = 1, .positions = to}};
  const cprox_motion_description d = {
      .variables = SEVEN, .n_variables = 7, .waypoints = ends, .n_waypoints = 2, .turning = turning};
  if (cprox_motion_create(m.robot, &d, ws, &m.motion) != CPROX_OK) fail_msg("%s", cprox_workspace_error(ws));
  return m;
}

static void mover_free(mover *m) {
  cprox_motion_free(m->motion);
  cprox_robot_free(m->robot);
  cprox_body_free(m->body);
}

/* A point at distance 1 from the line of a screw is on a helix about that line: as far from it all the way. */
CASE(a_screw_keeps_points_at_their_distance_from_its_line) {
  const double half = sqrt(0.5);
  const double from[7] = {1, 0, 0, 0, 0, 0, 1}, to[7] = {0, 1, 0.5, 0, 0, half, half};
  cprox_body *body = NULL;
  assert_int_equal(cprox_body_create_sphere(0.1, NULL, &body), CPROX_OK);
  mover m = mover_make(body, from, to, CPROX_TURNING_SCREW);
  for (int i = 0; i <= 10; i++) {
    double values[7];
    cprox_motion_evaluate(m.motion, 0.1 * i, values);
    assert_true(fabs(hypot(values[0], values[1]) - 1.0) < 1e-15 && fabs(values[2] - 0.05 * i) < 1e-15);
    assert_true(fabs(atan2(values[1], values[0]) - 0.1 * i * acos(0.0)) < 1e-15);
  }
  /* the distance from a ball on that line is the same everywhere: 1 - 0.1 - 0.2 */
  cprox_body *pole = NULL;
  assert_int_equal(cprox_body_create_capsule(5.0, 0.2, NULL, &pole), CPROX_OK);
  const cprox_obstacle target = cprox_obstacle_at(pole, HERE);
  cprox_result r;
  assert_int_equal(distance_of_list(cprox_robot_along(m.motion, NULL, 0), &target, 1, NULL, ws, &r, NULL), CPROX_OK);
  assert_true(r.lower <= 0.7 && r.upper >= 0.7 - 1e-15 && r.upper - r.lower <= 1e-6);
  cprox_body_free(pole);
  mover_free(&m);
}

CASE(slerp_turns_at_a_constant_rate_the_shorter_way) {
  const double angle = 2.5, from[7] = {0, 0, 0, 0, 0, 0, 2};
  const double to[7] = {1, 2, 3, 0, -3 * sin(angle / 2), 0, -3 * cos(angle / 2)};
  cprox_body *body = NULL;
  assert_int_equal(cprox_body_create_sphere(0.1, NULL, &body), CPROX_OK);
  mover m = mover_make(body, from, to, CPROX_TURNING_SLERP);
  for (int i = 0; i <= 10; i++) {
    double values[7];
    cprox_motion_evaluate(m.motion, 0.1 * i, values);
    assert_true(fabs(values[4] - sin(0.05 * i * angle)) < 1e-15 && fabs(values[6] - cos(0.05 * i * angle)) < 1e-15);
    assert_true(fabs(values[2] - 0.3 * i) < 1e-15);
  }
  mover_free(&m);
}

/* ---- what is refused ---- */

static void refused(const cprox_robot *robot, const cprox_motion_description *d, const char *because) {
  cprox_motion *motion = NULL;
  assert_int_equal(cprox_motion_create(robot, d, ws, &motion), CPROX_INVALID);
  assert_null(motion);
  if (!strstr(cprox_workspace_error(ws), because))
    fail_msg("'%s' does not say '%s'", cprox_workspace_error(ws), because);
}

CASE(poses_that_do_not_say_how_they_turn_get_a_message) {
  cprox_body *body = NULL;
  assert_int_equal(cprox_body_create_sphere(0.1, NULL, &body), CPROX_OK);
  const double zero[7] = {0, 0, 0, 0, 0, 0, 1};
  double to[7] = {1, 0, 0, 1, 0, 0, 0};
  mover m = mover_make(body, zero, zero, CPROX_TURNING_SLERP);
  const cprox_waypoint ends[2] = {{.time = 0, .positions = zero}, {.time = 1, .positions = to}};
  cprox_motion_description d = {
      .variables = SEVEN, .n_variables = 7, .waypoints = ends, .n_waypoints = 2, .turning = CPROX_TURNING_SLERP};
  refused(m.robot, &d, "half a turn apart");
  to[3] = 0.0;
  refused(m.robot, &d, "waypoint 1: the quaternion of variables 3 to 6 is 0");
  to[3] = 1.0, to[6] = 1.0;
  d.n_variables = 6;
  refused(m.robot, &d, "the motion gives 3 of the variables 3 to 6: slerp needs all of them");
  d.turning = CPROX_TURNING_SCREW;
  refused(m.robot, &d, "the motion gives 6 of the variables 0 to 6: a screw needs all of them");
  d.turning = (cprox_turning)7;
  refused(m.robot, &d, "7 is no way to turn");
  mover_free(&m);
}

CASE(a_joint_that_shares_a_number_of_a_quaternion_is_refused) {
  const cprox_link floating = {.parent = -1, .type = CPROX_JOINT_FLOATING, .origin = CPROX_POSE_IDENTITY};
  const cprox_joint_type types[] = {CPROX_JOINT_REVOLUTE, CPROX_JOINT_PRISMATIC, CPROX_JOINT_PLANAR,
                                    CPROX_JOINT_FLOATING, CPROX_JOINT_ROTATION_VECTOR};
  const int32_t counts[] = {1, 1, 3, 7, 6};
  for (int type = 0; type < 5; type++)
    for (int32_t variable = 0; variable < 10; variable++) {
      const cprox_link links[2] = {floating,
                                   {.parent = 0,
                                    .type = types[type],
                                    .origin = CPROX_POSE_IDENTITY,
                                    .axis = {0, 0, 1},
                                    .variable = variable,
                                    .multiplier = 1.0}};
      const bool same = types[type] == CPROX_JOINT_FLOATING && variable == 0;
      /* two quaternions: either may begin within the other */
      const bool shares = variable < 7 && variable + counts[type] > 3;
      cprox_robot *robot = NULL;
      const cprox_status status = cprox_robot_create(links, 2, NULL, 0, 17, ws, &robot);
      assert_int_equal(status, shares && !same ? CPROX_INVALID : CPROX_OK);
      if (status != CPROX_OK && !strstr(cprox_workspace_error(ws), "shares a variable with the quaternion of link"))
        fail_msg("%s", cprox_workspace_error(ws));
      if (status == CPROX_OK && types[type] == CPROX_JOINT_REVOLUTE && variable < 3) {
        /* with the position: not on a screw */
        const double from[7] = {0, 0, 0, 0, 0, 0, 1}, to[7] = {1, 0, 0, 1, 0, 0, 1};
        const cprox_waypoint ends[2] = {{.time = 0, .positions = from}, {.time = 1, .positions = to}};
        cprox_motion_description d = {
            .variables = SEVEN, .n_variables = 7, .waypoints = ends, .n_waypoints = 2, .turning = CPROX_TURNING_SLERP};
        cprox_motion *motion = NULL;
        assert_int_equal(cprox_motion_create(robot, &d, ws, &motion), CPROX_OK);
        cprox_motion_free(motion);
        d.turning = CPROX_TURNING_SCREW;
        refused(robot, &d, "link 1: its joint shares a variable with a floating joint that moves by screws");
      }
      cprox_robot_free(robot);
    }
}

int main(void) {
  return cases_run(workspace_setup, workspace_teardown);
}
