/* SPDX-License-Identifier: BSD-3-Clause */
/* Bodies that move and turn: first contacts in the scenes of DART's comparative benchmark of continuous collision, with
 * Bullet and FCL beside ours where they are installed, a
 * bodies carried along lines and cubics, a box that turns along a cubic Bézier curve beside the same box that does not, a sphere that slides beside a box, two
 * arms in one cell, and many movers on one clock. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "curve_proximity/cprox.h"
#include "peers/contact_peers.h"
#include "solve/list.h"
#include "support/measure.h"
#include "support/random.h"
#include "support/robot_case.h"

enum { MOST_PEERS = 5, FLYERS = 10, SEGMENTS = 100, FLYER_PAIRS = FLYERS * (FLYERS - 1) / 2 };

static const cprox_pose HERE = {.orientation = {.w = 1.0}};
static const int32_t VARIABLES[7] = {0, 1, 2, 3, 4, 5, 6};
static const double RIGHT_ANGLE = 1.57079632679489661923;

/* DART's curve. */
static const cprox_vec3 CURVE[4] = {{-2, 2, 0}, {-2, -2, 0}, {2, -2, 0}, {2, 2, 0}};

/* A body on a joint of its own, or along a curve, and what stands. */
typedef struct scene {
  const char *name;
  cprox_body *body, *other;
  cprox_robot *robot;
  cprox_motion *motion;
  cprox_curve *curve;
  cprox_obstacle target;
  cprox_mover mover;
} scene;

static void begin(scene *s, const char *name, cprox_body *body, cprox_body *other, cprox_pose at) {
  *s = (scene){.name = name, .body = body, .other = other, .target = cprox_obstacle_at(other, at)};
}

/* A motion of one second. */
static void ride(scene *s, cprox_joint_type type, cprox_motion_description d) {
  const cprox_link link = {.parent = -1, .type = type, .origin = HERE};
  const cprox_link_geometry geometry = {.body = s->body, .pose = HERE};
  d.variables = VARIABLES, d.n_variables = type == CPROX_JOINT_FLOATING ? 7 : 6;
  if (cprox_robot_create(&link, 1, &geometry, 1, d.n_variables, NULL, &s->robot) == CPROX_OK &&
      cprox_motion_create(s->robot, &d, NULL, &s->motion) == CPROX_OK)
    s->mover = cprox_robot_along(s->motion, NULL, 0);
}

static void go(scene *s, const double from[7], const double to[7], cprox_turning turning) {
  const cprox_waypoint ends[2] = {{.time = 0, .positions = from}, {.time = 1, .positions = to}};
  ride(s, CPROX_JOINT_FLOATING, (cprox_motion_description){.waypoints = ends, .n_waypoints = 2, .turning = turning});
}

/* Along the curve, turning so far about z. */
static void follow(scene *s, double turn) {
  double control[4][6];
  for (int i = 0; i < 4; i++) {
    const double row[6] = {CURVE[i].x, CURVE[i].y, CURVE[i].z, 0, 0, turn * i / 3.0};
    memcpy(control[i], row, sizeof row);
  }
  static const double KNOTS[8] = {0, 0, 0, 0, 1, 1, 1, 1};
  ride(s, CPROX_JOINT_ROTATION_VECTOR,
       (cprox_motion_description){.kind = CPROX_MOTION_BSPLINE,
                                  .control = control[0],
                                  .n_control = 4,
                                  .degree = 3,
                                  .knots = KNOTS,
                                  .n_knots = 8});
}

static void end(scene *s) {
  cprox_motion_free(s->motion);
  cprox_robot_free(s->robot);
  cprox_curve_free(s->curve);
  cprox_body_free(s->body);
  cprox_body_free(s->other);
}

/* ---- bodies ---- */

static cprox_body *box(void) {
  cprox_body *body = NULL;
  cprox_body_create_box((cprox_vec3){1, 1, 1}, NULL, &body);
  return body;
}

static cprox_body *sphere(void) {
  cprox_body *body = NULL;
  cprox_body_create_sphere(0.5, NULL, &body);
  return body;
}

static cprox_body *capsule(void) {
  cprox_body *body = NULL;
  cprox_body_create_capsule(1.0, 0.4, NULL, &body);
  return body;
}

static cprox_body *cylinder(void) {
  cprox_body *body = NULL;
  cprox_body_create_cylinder(1.0, 0.5, NULL, &body);
  return body;
}

static cprox_body *octahedron(void) {
  static const cprox_vec3 TIPS[6] = {{0.6, 0, 0}, {-0.6, 0, 0}, {0, 0.6, 0}, {0, -0.6, 0}, {0, 0, 0.6}, {0, 0, -0.6}};
  cprox_body *body = NULL;
  cprox_body_create_polytope(TIPS, 6, NULL, &body);
  return body;
}

/* ---- methods ---- */

static void answer_with(cprox_status status, const cprox_result *r, double lower, double upper, bench_answer *answer) {
  *answer = (bench_answer){.lower = lower, .upper = upper, .nodes = r->nodes, .distance_queries = r->distance_queries};
  answer->failed = status != CPROX_OK;
}

/* The answer is the time: a contact that was found, and a time before which there is none. */
static void contact(const void *problems, size_t i, void *state, bench_answer *answer) {
  const scene *s = (const scene *)problems + i;
  cprox_result r;
  const cprox_status status = list_time_of_contact(s->mover, &s->target, 1, NULL, state, &r);
  answer_with(status, &r, r.t_contact_lower, r.t, answer);
  answer->failed = answer->failed || r.verdict != CPROX_VERDICT_VIOLATED;
}

static void distance(const void *problems, size_t i, void *state, bench_answer *answer) {
  const scene *s = (const scene *)problems + i;
  cprox_result r;
  const cprox_status status = list_distance(s->mover, &s->target, 1, NULL, state, &r, NULL);
  answer_with(status, &r, r.lower, r.upper, answer);
}

static void among(const void *problems, size_t i, void *state, bench_answer *answer) {
  const cprox_mover *mover = (const cprox_mover *)problems + i;
  cprox_result r;
  const cprox_status status = list_distance(*mover, NULL, 0, NULL, state, &r, NULL);
  answer_with(status, &r, r.lower, r.upper, answer);
}

/* ---- first contacts ---- */

static const contact_peer *const PEERS[MOST_PEERS + 1] = {
#ifdef CPROX_BENCH_BULLET
    &contact_peer_bullet_convex,
    &contact_peer_bullet_subsimplex,
#endif
#ifdef CPROX_BENCH_FCL
    &contact_peer_fcl_advancement,
    &contact_peer_fcl_other_solver,
    &contact_peer_fcl_defaults,
#endif
    NULL};

/* What a peer was given, and when the contact is. */
typedef struct peer_scene {
  const contact_peer *peer;
  void *own;
  double truth;
} peer_scene;

/* Wrong: later than the truth by more than the 1e-6 that all are asked for, or never. */
static void contact_of_peer(const void *problems, size_t i, void *state, bench_answer *answer) {
  (void)problems, (void)i;
  const peer_scene *p = state;
  const double t = p->own ? p->peer->answer(p->own) : NAN;
  *answer = (bench_answer){.lower = t, .upper = t, .failed = isnan(t), .wrong = t > p->truth + 1e-6};
}

static cprox_body *body_of(contact_shape shape) {
  switch (shape) {
    case CONTACT_BOX: return box();
    case CONTACT_SPHERE: return sphere();
    case CONTACT_CAPSULE: return capsule();
    case CONTACT_CYLINDER: return cylinder();
    default: return octahedron();
  }
}

static void contact_in(const contact_scene *given, double truth, const bench_size *size, cprox_workspace *ws) {
  scene s;
  begin(&s, given->name, body_of(given->moving), body_of(given->standing), given->at);
  const cprox_vec3 from = given->from.position, to = given->to.position;
  const cprox_quat p = given->from.orientation, q = given->to.orientation;
  if (given->path == CONTACT_BEZIER)
    follow(&s, 0.0);
  else
    go(&s, (double[7]){from.x, from.y, from.z, p.x, p.y, p.z, p.w}, (double[7]){to.x, to.y, to.z, q.x, q.y, q.z, q.w},
       given->path == CONTACT_SCREW ? CPROX_TURNING_SCREW : CPROX_TURNING_SLERP);

  bench_method methods[MOST_PEERS + 1] = {{"curve_proximity", contact, ws}};
  peer_scene peers[MOST_PEERS];
  size_t n = 0;
  for (; PEERS[n]; n++) {
    peers[n] = (peer_scene){PEERS[n], PEERS[n]->make(given), truth};
    methods[n + 1] = (bench_method){PEERS[n]->name, contact_of_peer, &peers[n]};
  }
  const bench_workload w = {"moving", "contact", given->name, &s, 1, &truth, 1e-11};
  bench_measure(&w, size, methods, n + 1);
  for (size_t k = 0; k < n; k++)
    if (peers[k].own) peers[k].peer->drop(peers[k].own);
  end(&s);
}

static void contacts(const bench_size *size, cprox_workspace *ws) {
  const double h = sqrt(0.5);
  const cprox_pose from = {.position = {-5, 0, 0}, .orientation = {.w = 1}},
                   to = {.position = {5, 0, 0}, .orientation = {.w = 1}},
                   turning = {.position = {-3, 0, 0}, .orientation = {.w = 1}},
                   above = {.position = {0, 0, -2}, .orientation = {.w = 1}},
                   turned = {.orientation = {.w = h, .z = h}},
                   below = {.position = {0, -1, 0}, .orientation = {.w = 1}};
  const contact_scene scenes[] = {
      {"box box", CONTACT_BOX, CONTACT_BOX, CONTACT_STRAIGHT, from, to, CURVE, HERE},
      {"sphere sphere", CONTACT_SPHERE, CONTACT_SPHERE, CONTACT_STRAIGHT, from, to, CURVE, HERE},
      {"capsule capsule", CONTACT_CAPSULE, CONTACT_CAPSULE, CONTACT_STRAIGHT, from, to, CURVE, HERE},
      {"sphere box", CONTACT_SPHERE, CONTACT_BOX, CONTACT_STRAIGHT, from, to, CURVE, HERE},
      {"octahedron octahedron", CONTACT_OCTAHEDRON, CONTACT_OCTAHEDRON, CONTACT_STRAIGHT, from, to, CURVE, HERE},
      {"sphere cylinder", CONTACT_SPHERE, CONTACT_CYLINDER, CONTACT_STRAIGHT, from, to, CURVE, HERE},
      {"box box turning", CONTACT_BOX, CONTACT_BOX, CONTACT_STRAIGHT, turning, turned, CURVE, HERE},
      {"box box screw", CONTACT_BOX, CONTACT_BOX, CONTACT_SCREW, above, turned, CURVE, HERE},
      {"box box spline", CONTACT_BOX, CONTACT_BOX, CONTACT_BEZIER, HERE, HERE, CURVE, below}};
  static const double TRUTH[] = {0.4, 0.4, 0.42, 0.4, 0.38, 0.4, 0.600565822321, 0.5, 0.326351822333};
  for (size_t i = 0; i < sizeof scenes / sizeof *scenes; i++) contact_in(&scenes[i], TRUTH[i], size, ws);
}

/* ---- bodies that are carried without turning ---- */

enum { MOST_CARRIED = 100 };

/* A box, a capsule or a ball along a random line or cubic into a box that stands as it likes: contacts that begin
 * outside, to the epsilon of 1e-6 that is the default. */
static void carried_contacts(const bench_size *size, cprox_workspace *ws, const char *name, size_t points,
                             const char *path) {
  rng r = rng_seed(44);
  scene *s = calloc(MOST_CARRIED, sizeof *s);
  const size_t most = size->problems < MOST_CARRIED ? size->problems : MOST_CARRIED;
  size_t n = 0;
  while (s && n < most) {
    scene *at = &s[n];
    cprox_body *body = NULL, *other = NULL;
    cprox_vec3 p[4];
    for (size_t k = 0; k < points; k++) p[k] = rng_in_cube(&r, 1.5);
    const double a = rng_uniform(&r, 0.1, 0.4), b = rng_uniform(&r, 0.05, 0.3), c = rng_uniform(&r, 0.1, 0.4);
    cprox_body_create_box((cprox_vec3){c, a, b}, NULL, &other);
    if (strcmp(name, "box") == 0) cprox_body_create_box((cprox_vec3){a, b, c}, NULL, &body);
    if (strcmp(name, "capsule") == 0) cprox_body_create_capsule(a, b, NULL, &body);
    if (strcmp(name, "ball") == 0) cprox_body_create_sphere(b, NULL, &body);
    begin(at, name, body, other, rng_pose(&r, 0.3));
    const cprox_curve_description d = {.kind = CPROX_CURVE_BEZIER, .points = p, .n = points, .t1 = 1.0};
    cprox_result found = {0};
    if (cprox_curve_create(&d, NULL, &at->curve) == CPROX_OK) {
      at->mover = cprox_body_along(body, at->curve);
      cprox_time_of_contact(at->mover, at->target, NULL, ws, &found);
    }
    if (found.verdict == CPROX_VERDICT_VIOLATED && found.t_contact_lower > 0.0)
      n++;
    else
      end(at);
  }
  char parameter[32];
  snprintf(parameter, sizeof parameter, "%s %s", name, path);
  const bench_workload w = {"moving", "carried contact", parameter, s, n, NULL, 0.0};
  const bench_method ours = {"curve_proximity", contact, ws};
  bench_measure(&w, size, &ours, 1);
  for (size_t i = 0; i < n; i++) end(&s[i]);
  free(s);
}

/* ---- other workloads ---- */

/* The other box stands 1 m below the lowest point of the curve. */
static void turning_box(const bench_size *size, cprox_workspace *ws) {
  const cprox_pose below = {.position = {0.3, -3, 0.2}, .orientation = {.w = 1.0}};
  scene s[3];
  for (int i = 0; i < 3; i++) begin(&s[i], "cubic Bezier", box(), box(), below);
  follow(&s[0], RIGHT_ANGLE);
  follow(&s[1], 0.0);
  const cprox_curve_description d = {.kind = CPROX_CURVE_BEZIER, .points = CURVE, .n = 4, .t1 = 1.0};
  if (cprox_curve_create(&d, NULL, &s[2].curve) == CPROX_OK) s[2].mover = cprox_body_along(s[2].body, s[2].curve);
  static const char *const NAMES[3] = {"curve_proximity", "rotation vector at rest", "body along a curve"};
  for (int i = 0; i < 3; i++) {
    const bench_workload w = {"moving", "turning box", "cubic Bezier eps 1e-06", &s[i], 1, NULL, 0.0};
    const bench_method method = {NAMES[i], distance, ws};
    bench_measure(&w, size, &method, 1);
  }
  for (int i = 0; i < 3; i++) end(&s[i]);
}

/* Splines of 100 segments over 20 m by 20 m, each with a height and a start of its own: they cross above each other. */
static void quadrotors(const bench_size *size, cprox_workspace *ws) {
  rng r = rng_seed(2010);
  scene s[FLYERS];
  const cprox_robot *robots[FLYERS];
  cprox_joined_motion motions[FLYERS];
  double knots[SEGMENTS + 7];
  for (int k = 0; k < SEGMENTS + 7; k++) knots[k] = fmin(fmax(k - 3, 0), SEGMENTS) * 0.1;
  for (int i = 0; i < FLYERS; i++) {
    static double control[SEGMENTS + 3][6];
    cprox_vec3 at = {rng_uniform(&r, -10, 10), rng_uniform(&r, -10, 10), 0.9 * i};
    cprox_vec3 v = {0, 0, 0};
    for (int k = 0; k < SEGMENTS + 3; k++) {
      v = (cprox_vec3){0.95 * v.x + rng_uniform(&r, -0.05, 0.05) - 0.002 * at.x,
                       0.95 * v.y + rng_uniform(&r, -0.05, 0.05) - 0.002 * at.y,
                       0.9 * v.z + rng_uniform(&r, -0.01, 0.01) - 0.05 * (at.z - 0.9 * i)};
      at = (cprox_vec3){at.x + v.x, at.y + v.y, at.z + v.z};
      const double row[6] = {at.x, at.y, at.z, -v.y, v.x, 0.01 * k};
      memcpy(control[k], row, sizeof row);
    }
    cprox_body *body = NULL;
    cprox_body_create_cylinder(0.2, 0.3, NULL, &body);
    begin(&s[i], "quadrotor", body, NULL, HERE);
    ride(&s[i], CPROX_JOINT_ROTATION_VECTOR,
         (cprox_motion_description){.kind = CPROX_MOTION_BSPLINE,
                                    .control = control[0],
                                    .n_control = SEGMENTS + 3,
                                    .degree = 3,
                                    .knots = knots,
                                    .n_knots = SEGMENTS + 7});
    robots[i] = s[i].robot;
    motions[i] = (cprox_joined_motion){s[i].motion, 0.03 * i, 0.0};
  }
  cprox_robot *all = NULL;
  cprox_motion *motion = NULL;
  cprox_robot_pair pairs[FLYER_PAIRS];
  size_t n = 0;
  for (int32_t i = 0; i < FLYERS; i++)
    for (int32_t k = i + 1; k < FLYERS; k++) pairs[n++] = (cprox_robot_pair){i, k};
  const cprox_motion_description d = {.kind = CPROX_MOTION_JOINED, .joined = motions, .n_joined = FLYERS};
  if (cprox_robot_join(robots, NULL, FLYERS, ws, &all) == CPROX_OK &&
      cprox_motion_create(all, &d, ws, &motion) == CPROX_OK) {
    const cprox_mover mover = cprox_robot_self(motion, pairs, n);
    const bench_workload w = {"moving", "quadrotors", "10 of 100 segments eps 1e-06", &mover, 1, NULL, 0.0};
    const bench_method ours = {"curve_proximity", among, ws};
    bench_measure(&w, size, &ours, 1);
  }
  cprox_motion_free(motion);
  cprox_robot_free(all);
  for (int i = 0; i < FLYERS; i++) end(&s[i]);
}

/* hpp-core, pull request 334: a sphere slides beside a box at a clearance of 1e-6 m. Its answer is a verdict. */
static void verdict(const void *problems, size_t i, void *state, bench_answer *answer) {
  const scene *s = (const scene *)problems + i;
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.epsilon = 1e-7;
  cprox_result r;
  const cprox_status status = list_collision(s->mover, &s->target, 1, &options, state, &r, NULL);
  answer_with(r.verdict == CPROX_VERDICT_CLEAR ? status : CPROX_INVALID, &r, r.lower, r.lower, answer);
}

static void sphere_beside_box(const bench_size *size, cprox_workspace *ws, double radius, const char *parameter) {
  const double y = 0.5 + radius + 1e-6, from[7] = {-2, y, 0, 0, 0, 0, 1}, to[7] = {2, y, 0, 0, 0, 0.6, 0.8};
  cprox_body *body = NULL;
  cprox_body_create_sphere(radius, NULL, &body);
  scene s;
  begin(&s, "sphere beside box", body, box(), HERE);
  go(&s, from, to, CPROX_TURNING_SLERP);
  const bench_workload w = {"moving", "sphere beside box", parameter, &s, 1, NULL, 0.0};
  const bench_method ours = {"curve_proximity", verdict, ws};
  bench_measure(&w, size, &ours, 1);
  end(&s);
}

/* ---- two arms in one cell ---- */

/* A saved Panda and its scene; the same pair back to back with it, 1 m away, which begins after a quarter of its time.
 */
typedef struct cell {
  robot_case c;
  cprox_robot *both;
  cprox_motion *motion;
  cprox_obstacle targets[2 * CASE_MAX_OBJECTS];
  cprox_robot_pair pairs[2 * CASE_MAX_PAIRS + CASE_MAX_GEOMETRIES * CASE_MAX_GEOMETRIES];
  size_t n_pairs;
} cell;

static bool make_cell(cell *p, cprox_workspace *ws) {
  const robot_case *c = &p->c;
  const cprox_pose bases[2] = {HERE, {.position = {-1, 0, 0}, .orientation = {.z = 1}}};
  const cprox_robot *robots[2] = {c->robot, c->robot};
  const cprox_motion_info info = cprox_motion_get_info(c->motion);
  const cprox_joined_motion motions[2] = {{c->motion, 0.0, 0.0}, {c->motion, 0.25 * (info.t1 - info.t0), 0.0}};
  for (size_t i = 0; i < c->n_targets; i++) {
    const cprox_pose *at = &c->targets[i].pose;
    const cprox_quat q = at->orientation;
    p->targets[i] = p->targets[c->n_targets + i] = c->targets[i];
    p->targets[c->n_targets + i].pose = (cprox_pose){.position = {-1 - at->position.x, -at->position.y, at->position.z},
                                                     .orientation = {.x = -q.y, .y = q.x, .z = q.w, .w = -q.z}};
  }
  const int32_t n = (int32_t)c->n_geometries;
  p->n_pairs = 0;
  for (size_t i = 0; i < c->n_self_pairs; i++) {
    const cprox_robot_pair own = c->self_pairs[i];
    p->pairs[p->n_pairs++] = own;
    p->pairs[p->n_pairs++] = (cprox_robot_pair){own.geometry + n, own.other + n};
  }
  for (int32_t i = 0; i < n; i++)
    for (int32_t k = 0; k < n; k++) p->pairs[p->n_pairs++] = (cprox_robot_pair){i, n + k};
  const cprox_motion_description d = {.kind = CPROX_MOTION_JOINED, .joined = motions, .n_joined = 2};
  return cprox_robot_join(robots, bases, 2, ws, &p->both) == CPROX_OK &&
         cprox_motion_create(p->both, &d, ws, &p->motion) == CPROX_OK;
}

/* Both arms against the scenes, themselves and each other. */
static void two_arms(const void *problems, size_t i, void *state, bench_answer *answer) {
  const cell *p = (const cell *)problems + i;
  const cprox_mover mover = cprox_robot_whole(cprox_robot_along(p->motion, NULL, 0), p->pairs, p->n_pairs);
  cprox_result r;
  const cprox_status status = list_distance(mover, p->targets, 2 * p->c.n_targets, NULL, state, &r, NULL);
  answer_with(status, &r, r.lower, r.upper, answer);
}

/* One arm against its scene, and then itself. */
static void one_arm(const void *problems, size_t i, void *state, bench_answer *answer) {
  const robot_case *c = &((const cell *)problems + i)->c;
  cprox_result world, self;
  const cprox_status a =
      list_distance(cprox_robot_along(c->motion, NULL, 0), c->targets, c->n_targets, NULL, state, &world, NULL);
  const cprox_status b =
      list_distance(cprox_robot_self(c->motion, c->self_pairs, c->n_self_pairs), NULL, 0, NULL, state, &self, NULL);
  world.nodes += self.nodes, world.distance_queries += self.distance_queries;
  answer_with(a < 0 ? a : b, &world, fmin(world.lower, self.lower), fmin(world.upper, self.upper), answer);
}

static void cells(const bench_size *size, cprox_workspace *ws) {
  static const char FOLDER[] = BENCH_DATA_DIR "/motion";
  FILE *f = fopen(BENCH_DATA_DIR "/motion/cases.txt", "r");
  size_t n = 0;
  if (!f || fscanf(f, "%zu", &n) != 1) exit(1);
  for (size_t i = 0; i < n; i++) {
    static cell p;
    memset(&p, 0, sizeof p);
    if (!robot_case_read(f, FOLDER, &p.c)) exit(1);
    if (strncmp(p.c.name, "panda_", 6) == 0 && make_cell(&p, ws)) {
      const bench_workload w = {"moving", "two arms in one cell", p.c.name, &p, 1, NULL, 0.0};
      const bench_method methods[] = {{"curve_proximity", two_arms, ws}, {"one arm", one_arm, ws}};
      bench_measure(&w, size, methods, 2);
    }
    cprox_motion_free(p.motion);
    cprox_robot_free(p.both);
    robot_case_free(&p.c);
  }
  fclose(f);
}

/* One box flies 4 m through a hall in which n others fall and turn. The hall grows with n: few of them are near. */
static void among_many(const bench_size *size, cprox_workspace *ws) {
  static const int NUMBERS[] = {10, 32, 100, 316, 1000};
  for (size_t row = 0; row < sizeof NUMBERS / sizeof *NUMBERS; row++) {
    const int n = NUMBERS[row] + 1;
    rng r = rng_seed(317);
    scene *s = calloc((size_t)n, sizeof *s);
    const cprox_robot **robots = calloc((size_t)n, sizeof *robots);
    cprox_joined_motion *motions = calloc((size_t)n, sizeof *motions);
    cprox_robot_pair *pairs = calloc((size_t)n, sizeof *pairs);
    if (!s || !robots || !motions || !pairs) exit(1);
    for (int i = 0; i < n; i++) {
      begin(&s[i], "falling", box(), NULL, HERE);
      const double x = 2.5 * (i - 0.5 * n), h = sqrt(0.5);
      const double y = (i & 1 ? 1.6 : -1.6) + rng_uniform(&r, -0.2, 0.2);
      const double top[7] = {x, y, 3, 0, 0, 0, 1}, floor[7] = {x, y, -3, h, 0, 0, h};
      const double from[7] = {-2, 0, 0, 0, 0, 0, 1}, to[7] = {2, 0, 0, 0, 0, h, h};
      go(&s[i], i ? top : from, i ? floor : to, CPROX_TURNING_SLERP);
      robots[i] = s[i].robot;
      motions[i] = (cprox_joined_motion){s[i].motion, i ? rng_uniform(&r, -0.2, 0.2) : 0.0, 0.0};
      if (i) pairs[i - 1] = (cprox_robot_pair){0, i};
    }
    cprox_robot *all = NULL;
    cprox_motion *motion = NULL;
    const cprox_motion_description d = {.kind = CPROX_MOTION_JOINED, .joined = motions, .n_joined = (size_t)n};
    if (cprox_robot_join(robots, NULL, (size_t)n, ws, &all) == CPROX_OK &&
        cprox_motion_create(all, &d, ws, &motion) == CPROX_OK) {
      const cprox_mover mover = cprox_robot_self(motion, pairs, (size_t)n - 1);
      char parameter[40];
      snprintf(parameter, sizeof parameter, "%d falling eps 1e-06", n - 1);
      const bench_workload w = {"moving", "box among falling boxes", parameter, &mover, 1, NULL, 0.0};
      const bench_method ours = {"curve_proximity", among, ws};
      bench_measure(&w, size, &ours, 1);
    }
    cprox_motion_free(motion);
    cprox_robot_free(all);
    for (int i = 0; i < n; i++) end(&s[i]);
    free(pairs);
    free(motions);
    free(robots);
    free(s);
  }
}

int main(int argc, char **argv) {
  const bench_size size = bench_arguments(argc, argv);
  cprox_workspace *ws = cprox_workspace_create();
  if (bench_wanted(&size, "contact")) contacts(&size, ws);
  static const char *const CARRIED[3] = {"box", "capsule", "ball"};
  for (int i = 0; i < 3 && bench_wanted(&size, "carried contact"); i++) {
    carried_contacts(&size, ws, CARRIED[i], 2, "line");
    carried_contacts(&size, ws, CARRIED[i], 4, "cubic");
  }
  if (bench_wanted(&size, "turning box")) turning_box(&size, ws);
  if (bench_wanted(&size, "quadrotors")) quadrotors(&size, ws);
  if (bench_wanted(&size, "sphere beside box")) {
    sphere_beside_box(&size, ws, 0.2, "clearance 1e-06");
    sphere_beside_box(&size, ws, 0.5, "clearance 1e-06 radius 0.5");
  }
  if (bench_wanted(&size, "two arms in one cell")) cells(&size, ws);
  if (bench_wanted(&size, "box among falling boxes")) among_many(&size, ws);
  cprox_workspace_free(ws);
  return 0;
}
