/* SPDX-License-Identifier: BSD-3-Clause */
/* First contacts of bodies that move and turn, in scenes that other libraries publish, each with its truth in closed
 * form: the nine scenes of DART's comparative benchmark of continuous collision, cuboids that parry's nonlinear cast
 * misses (issue 317), a ball that falls on boxes of 5, 50 and 500 m (parry, issue 429), and a sphere that slides beside
 * a box at 1e-6 m (hpp-core, pull request 334). Never late; at most epsilon of the way early; few nodes. */
#include <math.h>

#include "support/builders.h"
#include "support/cases.h"
#include "support/of_list.h"

static const cprox_pose HERE = {.orientation = {.w = 1.0}};
static const int32_t VARIABLES[7] = {0, 1, 2, 3, 4, 5, 6};

/* Control poses say how far a body gets before it can touch: a few steps lead to the contact. */
enum { MOST_NODES = 12 };

static const double PI = 3.14159265358979323846;

/* ---- scenes ---- */

/* A body on a joint of its own, and what stands. */
typedef struct scene {
  cprox_body *body, *other;
  cprox_robot *robot;
  cprox_motion *motion;
  cprox_obstacle target;
} scene;

static void scene_begin(cprox_body *body, cprox_pose in_link, cprox_joint_type type, cprox_body *other, cprox_pose at,
                        scene *s) {
  *s = (scene){.body = body, .other = other, .target = cprox_obstacle_at(other, at)};
  const cprox_link link = {.parent = -1, .type = type, .origin = HERE};
  const cprox_link_geometry geometry = {.body = body, .pose = in_link};
  const size_t n = type == CPROX_JOINT_FLOATING ? 7 : 6;
  assert_int_equal(cprox_robot_create(&link, 1, &geometry, 1, n, ws, &s->robot), CPROX_OK);
}

/* From one pose (x, y, z, quaternion x, y, z, w) to another in one second. */
static void go_to(scene *s, const double from[7], const double to[7], cprox_turning turning) {
  const cprox_waypoint ends[2] = {{.time = 0, .positions = from}, {.time = 1, .positions = to}};
  const cprox_motion_description d = {
      .variables = VARIABLES, .n_variables = 7, .waypoints = ends, .n_waypoints = 2, .turning = turning};
  if (cprox_motion_create(s->robot, &d, ws, &s->motion) != CPROX_OK) fail_msg("%s", cprox_workspace_error(ws));
}

static void scene_end(scene *s) {
  cprox_motion_free(s->motion);
  cprox_robot_free(s->robot);
  cprox_body_free(s->body);
  cprox_body_free(s->other);
}

/* The contact, at a speed of approach in m/s. */
static void meets(scene *s, const char *what, double truth, double speed) {
  cprox_result r = {0};
  if (time_of_contact_of_list(cprox_robot_along(s->motion, NULL, 0), &s->target, 1, NULL, ws, &r) < 0)
    fail_msg("%s: %s", what, cprox_workspace_error(ws));
  print_message("%-28s contact at %.12f, truth %.12f, early by %8.1e: %2llu nodes, %2llu distances\n", what,
                r.t_contact_lower, truth, truth - r.t_contact_lower, (unsigned long long)r.nodes,
                (unsigned long long)r.distance_queries);
  assert_int_not_equal(r.verdict, CPROX_VERDICT_CLEAR);
  if (!(r.t_contact_lower <= truth + 1e-15)) fail_msg("%s: late by %g s", what, r.t_contact_lower - truth);
  if (!(truth - r.t_contact_lower <= 2e-6 / speed)) fail_msg("%s: early by %g s", what, truth - r.t_contact_lower);
  if (r.nodes > MOST_NODES) fail_msg("%s: %llu nodes", what, (unsigned long long)r.nodes);
}

/* ---- bodies ---- */

static cprox_body *box(double x, double y, double z) {
  cprox_body *body = NULL;
  assert_int_equal(cprox_body_create_box(vec(x, y, z), NULL, &body), CPROX_OK);
  return body;
}

static cprox_body *sphere(double radius) {
  cprox_body *body = NULL;
  assert_int_equal(cprox_body_create_sphere(radius, NULL, &body), CPROX_OK);
  return body;
}

static cprox_body *capsule(double height, double radius) {
  cprox_body *body = NULL;
  assert_int_equal(cprox_body_create_capsule(height, radius, NULL, &body), CPROX_OK);
  return body;
}

static cprox_body *cylinder(double height, double radius) {
  cprox_body *body = NULL;
  assert_int_equal(cprox_body_create_cylinder(height, radius, NULL, &body), CPROX_OK);
  return body;
}

static cprox_body *octahedron(double s) {
  const vec3 tips[6] = {{s, 0, 0}, {-s, 0, 0}, {0, s, 0}, {0, -s, 0}, {0, 0, s}, {0, 0, -s}};
  cprox_body *body = NULL;
  assert_int_equal(cprox_body_create_polytope(tips, 6, NULL, &body), CPROX_OK);
  return body;
}

/* ---- DART ---- */

/* Along x from -5 to 5. */
static void sweep(const char *what, cprox_body *body, cprox_body *other, double truth) {
  static const double FROM[7] = {-5, 0, 0, 0, 0, 0, 1}, TO[7] = {5, 0, 0, 0, 0, 0, 1};
  scene s;
  scene_begin(body, HERE, CPROX_JOINT_FLOATING, other, HERE, &s);
  go_to(&s, FROM, TO, CPROX_TURNING_SLERP);
  meets(&s, what, truth, 10.0);
  scene_end(&s);
}

CASE(straight_sweeps_meet_when_they_do) {
  sweep("box, box", box(1, 1, 1), box(1, 1, 1), 0.4);
  sweep("sphere, sphere", sphere(0.5), sphere(0.5), 0.4);
  sweep("capsule, capsule", capsule(1, 0.4), capsule(1, 0.4), 0.42);
  sweep("sphere, box", sphere(0.5), box(1, 1, 1), 0.4);
  sweep("octahedron, octahedron", octahedron(0.6), octahedron(0.6), 0.38);
  sweep("sphere, cylinder", sphere(0.5), cylinder(1, 0.5), 0.4);
}

/* A box turns by a right angle on its way: its corner is at x = 3t - 3 + (cos(90°t) + sin(90°t))/2. */
CASE(a_box_that_turns_meets_with_its_corner) {
  const double half = sqrt(0.5), from[7] = {-3, 0, 0, 0, 0, 0, 1}, to[7] = {0, 0, 0, 0, 0, half, half};
  long double low = 0, high = 1;
  for (int i = 0; i < 80; i++) {
    const long double t = (low + high) / 2, angle = t * (long double)PI / 2;
    if (3 * t - 3 + (cosl(angle) + sinl(angle)) / 2 < -0.5L)
      low = t;
    else
      high = t;
  }
  scene s;
  scene_begin(box(1, 1, 1), HERE, CPROX_JOINT_FLOATING, box(1, 1, 1), HERE, &s);
  go_to(&s, from, to, CPROX_TURNING_SLERP);
  meets(&s, "box that turns, box", (double)low, 3.0);
  scene_end(&s);
}

CASE(a_box_on_a_screw_meets_face_to_face) {
  const double half = sqrt(0.5), from[7] = {0, 0, -2, 0, 0, 0, 1}, to[7] = {0, 0, 0, 0, 0, half, half};
  scene s;
  scene_begin(box(1, 1, 1), HERE, CPROX_JOINT_FLOATING, box(1, 1, 1), HERE, &s);
  go_to(&s, from, to, CPROX_TURNING_SCREW);
  meets(&s, "box on a screw, box", 0.5, 2.0);
  scene_end(&s);
}

/* Along a cubic Bézier curve whose chord passes the other box. */
static void along_curve(scene *s, const double rotation[3]) {
  double control[4][6] = {{-2, 2, 0}, {-2, -2, 0}, {2, -2, 0}, {2, 2, 0}};
  for (int i = 0; i < 4; i++)
    for (int k = 0; k < 3; k++) control[i][3 + k] = (double)i / 3.0 * rotation[k];
  const double knots[8] = {0, 0, 0, 0, 1, 1, 1, 1};
  scene_begin(box(1, 1, 1), HERE, CPROX_JOINT_ROTATION_VECTOR, box(1, 1, 1),
              (cprox_pose){.position = {0, -1, 0}, .orientation = {.w = 1.0}}, s);
  const cprox_motion_description d = {.kind = CPROX_MOTION_BSPLINE,
                                      .variables = VARIABLES,
                                      .n_variables = 6,
                                      .control = control[0],
                                      .n_control = 4,
                                      .degree = 3,
                                      .knots = knots,
                                      .n_knots = 8};
  if (cprox_motion_create(s->robot, &d, ws, &s->motion) != CPROX_OK) fail_msg("%s", cprox_workspace_error(ws));
}

/* x = 3v - v³, v = 2t - 1, is -1 at v = -2 sin 10°; the speed there is 2(3 - 3v²) = 5.3 m/s. */
CASE(a_box_along_a_curve_meets_at_half_less_sin_10_degrees) {
  scene s;
  along_curve(&s, (const double[3]){0, 0, 0});
  meets(&s, "box along a curve, box", 0.5 - sin(PI / 18), 5.3);
  scene_end(&s);
}

/* The same, and it turns by a right angle about z: the corner is at x = 3v - v³ + (cos(90°t) + sin(90°t))/2. */
CASE(a_box_that_turns_along_a_curve_meets_with_its_corner) {
  long double low = 0, high = 0.5L;
  for (int i = 0; i < 80; i++) {
    const long double t = (low + high) / 2, v = 2 * t - 1, angle = t * (long double)PI / 2;
    if (3 * v - v * v * v + (cosl(angle) + sinl(angle)) / 2 < -0.5L)
      low = t;
    else
      high = t;
  }
  scene s;
  along_curve(&s, (const double[3]){0, 0, PI / 2});
  meets(&s, "box turns along a curve, box", (double)low, 5.0);
  scene_end(&s);
}

/* ---- parry ---- */

/* Millimetres: cuboids of half extents up to 650, one of which shifts and turns about a point of its own. */
CASE(cuboids_that_a_nonlinear_cast_misses_meet) {
  const vec3 origin = vec(6458.7905, -209.1331, 1014.52124), centre = vec(99.97085, -2.2888184e-5, -35.0);
  const double q[4] = {5.3359954e-20, 9.459897e-20, -0.84035015, -0.542044}; /* x, y, z, w */
  const double turned = -1.770823, s = sin(turned / 2), c = cos(turned / 2);
  const double n = sqrt(q[2] * q[2] + q[3] * q[3]), cosine = (q[3] * q[3] - q[2] * q[2]) / n / n,
               sine = 2.0 * q[2] * q[3] / n / n;
  const double from[7] = {origin.x + cosine * centre.x - sine * centre.y,
                          origin.y + sine * centre.x + cosine * centre.y,
                          origin.z + centre.z,
                          q[0],
                          q[1],
                          q[2],
                          q[3]};
  const double to[7] = {from[0] + 588.2583,  from[1] - 553.06335, from[2] + 471.54688, 0, 0,
                        c * q[2] + s * q[3], c * q[3] - s * q[2]};
  scene m;
  scene_begin(box(470, 210, 220), (cprox_pose){.position = vec_neg(centre), .orientation = {.w = 1.0}},
              CPROX_JOINT_FLOATING, box(1300, 660, 550),
              (cprox_pose){.position = {6079.4917, -849.3108, 853.8756},
                           .orientation = {.w = 0.99999607, .x = 0.002524775, .y = -0.00026210435, .z = -0.0012064485}},
              &m);
  go_to(&m, from, to, CPROX_TURNING_SLERP);
  cprox_result r = {0};
  assert_true(time_of_contact_of_list(cprox_robot_along(m.motion, NULL, 0), &m.target, 1, NULL, ws, &r) >= 0);
  print_message("%-28s contact at %.12f: %2llu nodes\n", "cuboids", r.t_contact_lower, (unsigned long long)r.nodes);
  assert_int_not_equal(r.verdict, CPROX_VERDICT_CLEAR);
  assert_true(fabs(r.t_contact_lower - 0.0939336) < 1e-7);
  assert_true(r.nodes <= MOST_NODES);
  scene_end(&m);
}

/* Casts of a ball straight down on boxes of 5, 50 and 500 m, from 20 m: 20 m in a second. */
CASE(a_ball_falls_as_far_on_a_large_box_as_on_a_small_one) {
  const double radius = 0.5166, halves[3] = {5, 50, 500};
  for (int i = 0; i < 3; i++)
    for (int k = 0; k < 9; k++) {
      const int column = k % 3 - 1, row = k / 3 - 1;
      const double half = halves[i], x = 0.83 * half * column, y = 0.61 * half * row;
      const double from[7] = {x, y, half + 20, 0, 0, 0, 1}, to[7] = {x, y, half, 0, 0, 0, 1};
      scene s;
      scene_begin(sphere(radius), HERE, CPROX_JOINT_FLOATING, box(2 * half, 2 * half, 2 * half), HERE, &s);
      go_to(&s, from, to, CPROX_TURNING_SCREW);
      /* tops of 500 m round to 6e-14 m, which is 3e-15 s */
      meets(&s, "ball on a box", (20 - radius) / 20 + 4e-15, 20.0);
      scene_end(&s);
    }
}

/* ---- hpp-core ---- */

/* A sphere slides beside a box at a clearance of 1e-6 m, straight, and along an arc that comes no nearer. */
static void slides_beside_a_box(double radius) {
  const double gap = 1e-6, y = 0.5 + radius + gap;
  const double from[7] = {-2, y, 0, 0, 0, 0, 1}, to[7] = {2, y, 0, 0, 0, 0.6, 0.8}, up[7] = {0, y + 1, 0, 0, 0, 0, 1};
  scene s;
  cprox_result r = {0};
  scene_begin(sphere(radius), HERE, CPROX_JOINT_FLOATING, box(1, 1, 1), HERE, &s);
  go_to(&s, from, to, CPROX_TURNING_SLERP);
  const cprox_options o = accurate(1e-7);
  assert_int_equal(collision_of_list(cprox_robot_along(s.motion, NULL, 0), &s.target, 1, &o, ws, &r, NULL), CPROX_OK);
  print_message("%-28s %2llu nodes\n", "sphere beside a box", (unsigned long long)r.nodes);
  assert_int_equal(r.verdict, CPROX_VERDICT_CLEAR);
  assert_true(r.nodes <= 4);
  cprox_motion_free(s.motion);

  /* a parabola that touches the line y from above */
  const double v0[7] = {0.25, -1}, v1[7] = {0.25, 1};
  double ends[2][7];
  for (int k = 0; k < 7; k++) ends[0][k] = ends[1][k] = up[k];
  ends[0][0] = -0.25, ends[1][0] = 0.25, ends[0][1] = ends[1][1] = y + 0.25;
  const cprox_waypoint points[2] = {{.time = 0, .positions = ends[0], .velocities = v0},
                                    {.time = 1, .positions = ends[1], .velocities = v1}};
  const cprox_motion_description d = {.variables = VARIABLES, .n_variables = 7, .waypoints = points, .n_waypoints = 2};
  assert_int_equal(cprox_motion_create(s.robot, &d, ws, &s.motion), CPROX_OK);
  assert_int_equal(collision_of_list(cprox_robot_along(s.motion, NULL, 0), &s.target, 1, &o, ws, &r, NULL), CPROX_OK);
  print_message("%-28s %2llu nodes\n", "sphere dips beside a box", (unsigned long long)r.nodes);
  assert_int_equal(r.verdict, CPROX_VERDICT_CLEAR);
  assert_true(r.nodes <= 4);
  scene_end(&s);
}

CASE(a_sphere_beside_a_box_is_clear_after_few_nodes) {
  slides_beside_a_box(0.2);
  slides_beside_a_box(0.5);
}

int main(void) {
  return cases_run(workspace_setup, workspace_teardown);
}
