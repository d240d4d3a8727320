/* SPDX-License-Identifier: BSD-3-Clause */
/* Every option of every query with every kind of mover and target: it has its effect, or the call is refused and says
 * so. */
#include <stdio.h>
#include <string.h>

#include "curve_proximity/cprox.h"
#include "curve_proximity/cprox_fourier.h"
#include "support/builders.h"
#include "support/cases.h"
#include "support/meshes.h"
#include "support/of_list.h"

/* ---- the options ---- */

typedef enum option { NOTHING, SIGNED, CERTIFICATE, STOP, RELATIVE, LOD, N_OPTIONS } option;

static const char *const OPTION_NAMES[N_OPTIONS] = {"nothing", "signed_distance",  "certificate",
                                                    "stop",    "relative_epsilon", "max_lod"};

static size_t stop_calls;

static bool count_and_go_on(void *user) {
  (void)user;
  stop_calls++;
  return false;
}

static cprox_certificate *proof;

static cprox_options with(option o) {
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  if (o == SIGNED) options.signed_distance = true;
  if (o == CERTIFICATE) options.certificate = proof;
  if (o == STOP) options.stop = count_and_go_on;
  if (o == RELATIVE) options.relative_epsilon = 0.5;
  if (o == LOD) options.max_lod = CPROX_LOD_SPHERE;
  return options;
}

/* ---- the movers and targets ---- */

typedef enum mover_kind { POINT, TUBE, BODY, ROBOT, ROBOT_SELF, N_MOVERS } mover_kind;
typedef enum target_kind { BALL, BOX, PLANE, QUADRIC, MESH, CLOUD, LINE, CLOCK, CLOCK_BODY, N_TARGETS } target_kind;

static const char *const MOVER_NAMES[N_MOVERS] = {"point", "tube", "body", "robot", "robot itself"};
static const char *const TARGET_NAMES[N_TARGETS] = {"ball",  "box",  "halfspace", "superquadric", "mesh",
                                                    "cloud", "line", "on clock",  "body on clock"};

typedef struct world {
  cprox_curve *way, *line;
  cprox_body *ball, *box, *plane, *quadric, *mesh, *cloud;
  cprox_robot *robot;
  cprox_motion *motion;
} world;

static cprox_robot *make_robot(const cprox_body *body) {
  /* two sliding links side by side on a third, so that pairs of its own are asked about */
  const cprox_link links[] = {
      {.parent = -1,
       .type = CPROX_JOINT_PRISMATIC,
       .origin = CPROX_POSE_IDENTITY,
       .axis = {1, 0, 0},
       .variable = 0,
       .multiplier = 1},
      {.parent = 0,
       .type = CPROX_JOINT_PRISMATIC,
       .origin = CPROX_POSE_IDENTITY,
       .axis = {0, 1, 0},
       .variable = 1,
       .multiplier = 1},
      {.parent = 1,
       .type = CPROX_JOINT_PRISMATIC,
       .origin = CPROX_POSE_IDENTITY,
       .axis = {0, 0, 1},
       .variable = 1,
       .multiplier = 1},
  };
  const cprox_link_geometry geometries[] = {{.body = body, .pose = CPROX_POSE_IDENTITY, .link = 0},
                                            {.body = body, .pose = CPROX_POSE_IDENTITY, .link = 2}};
  cprox_robot *robot = NULL;
  assert_int_equal(cprox_robot_create(links, 3, geometries, 2, 2, ws, &robot), CPROX_OK);
  return robot;
}

static world make_world(void) {
  world w = {.way = bezier((vec3[]){{-1.1, 0.02, 0.01}, {0.1, -0.1, 0.03}, {1.2, 0.05, -0.02}}, 3),
             .line = bezier((vec3[]){{0.05, -1, 0.3}, {0.02, 1, 0.2}}, 2)};
  test_mesh torus = mesh_torus(12, 9, 0.5, 0.2, 0.0);
  w.mesh = mesh_body(&torus, CPROX_MESH_FILL_SURFACE, ws);
  assert_int_equal(cprox_body_create_points(torus.vertices, torus.n, 0.01, SIZE_MAX, ws, &w.cloud), CPROX_OK);
  mesh_free(&torus);
  assert_int_equal(cprox_body_create_sphere(0.5, ws, &w.ball), CPROX_OK);
  assert_int_equal(cprox_body_create_box((vec3){0.5, 0.4, 0.3}, ws, &w.box), CPROX_OK);
  assert_int_equal(cprox_body_create_halfspace((vec3){0, 0, 1}, -0.3, ws, &w.plane), CPROX_OK);
  assert_int_equal(cprox_body_create_superquadric((vec3){0.5, 0.4, 0.3}, (cprox_vec3){4, 2, 3}, ws, &w.quadric),
                   CPROX_OK);
  w.robot = make_robot(w.box);
  const cprox_waypoint points[] = {{.time = 0, .positions = (double[]){-1, 0.1}},
                                   {.time = 2, .positions = (double[]){1, 2}}};
  assert_int_equal(cprox_motion_create(w.robot,
                                       &(cprox_motion_description){.kind = CPROX_MOTION_WAYPOINTS,
                                                                   .variables = (int32_t[]){0, 1},
                                                                   .n_variables = 2,
                                                                   .waypoints = points,
                                                                   .n_waypoints = 2,
                                                                   .interpolation = CPROX_INTERPOLATION_LINEAR},
                                       ws, &w.motion),
                   CPROX_OK);
  return w;
}

static void free_world(world *w) {
  cprox_motion_free(w->motion);
  cprox_robot_free(w->robot);
  cprox_body *const bodies[] = {w->ball, w->box, w->plane, w->quadric, w->mesh, w->cloud};
  for (size_t i = 0; i < sizeof bodies / sizeof *bodies; i++) cprox_body_free(bodies[i]);
  cprox_curve_free(w->way);
  cprox_curve_free(w->line);
}

static cprox_mover mover_of(const world *w, mover_kind kind) {
  switch (kind) {
    case TUBE: return cprox_tube_along(w->way, 0.05);
    case BODY: return cprox_body_along(w->box, w->way);
    case ROBOT: return cprox_robot_along(w->motion, NULL, 0);
    case ROBOT_SELF: return cprox_robot_self(w->motion, NULL, 0);
    default: return cprox_point_along(w->way);
  }
}

static cprox_obstacle target_of(const world *w, target_kind kind, double height) {
  const cprox_body *const bodies[] = {w->ball, w->box, w->plane, w->quadric, w->mesh, w->cloud};
  cprox_obstacle t =
      kind < LINE ? cprox_obstacle_at(bodies[kind], CPROX_POSE_IDENTITY) : cprox_obstacle_curve(w->line, 0.05);
  if (kind == CLOCK) t = cprox_synchronized(cprox_tube_along(w->line, 0.05));
  if (kind == CLOCK_BODY) t = cprox_synchronized(cprox_body_along(w->box, w->line));
  t.pose.position.z = -height;
  return t;
}

/* ---- the queries ---- */

/* What a query leaves behind: all that it writes, and the interval in it. */
typedef struct reply {
  cprox_result result[4];
  cprox_profile_interval interval;
  cprox_gradient gradient;
  cprox_growth growth;
  size_t count;
  double lower, upper; /* set by hand */
  cprox_lod lod;
} reply;

typedef cprox_status (*query)(const world *w, cprox_mover m, cprox_obstacle t, const cprox_options *o, reply *r);

static size_t targets_of(const cprox_mover *m) {
  return m->kind == CPROX_MOVER_ROBOT_SELF ? 0 : 1;
}

static cprox_status distance(const world *w, cprox_mover m, cprox_obstacle t, const cprox_options *o, reply *r) {
  (void)w;
  return distance_of_list(m, &t, targets_of(&m), o, ws, r->result, NULL);
}

static cprox_status tolerance(const world *w, cprox_mover m, cprox_obstacle t, const cprox_options *o, reply *r) {
  (void)w;
  return tolerance_of_list(m, &t, targets_of(&m), 0.1, o, ws, r->result, NULL);
}

static cprox_status collision(const world *w, cprox_mover m, cprox_obstacle t, const cprox_options *o, reply *r) {
  (void)w;
  return collision_of_list(m, &t, targets_of(&m), o, ws, r->result, NULL);
}

static cprox_status time_of_contact(const world *w, cprox_mover m, cprox_obstacle t, const cprox_options *o, reply *r) {
  (void)w;
  return time_of_contact_of_list(m, &t, targets_of(&m), o, ws, r->result);
}

static cprox_status nearest(const world *w, cprox_mover m, cprox_obstacle t, const cprox_options *o, reply *r) {
  (void)w;
  return nearest_of_list(m, &t, targets_of(&m), 1, o, ws, r->result, &r->count);
}

static cprox_status within(const world *w, cprox_mover m, cprox_obstacle t, const cprox_options *o, reply *r) {
  (void)w;
  return within_of_list(m, &t, targets_of(&m), 9.0, o, ws, r->result, &r->count);
}

static cprox_status nearest_pairs(const world *w, cprox_mover m, cprox_obstacle t, const cprox_options *o, reply *r) {
  (void)w;
  return nearest_pairs_of_list(m, &t, targets_of(&m), 1, 9.0, o, ws, r->result, &r->count);
}

static cprox_status profile(const world *w, cprox_mover m, cprox_obstacle t, const cprox_options *o, reply *r) {
  (void)w;
  const double breaks[] = {0.0, 1.0};
  const cprox_status status = profile_of_list(m, &t, targets_of(&m), breaks, 1, o, ws, &r->interval);
  if (status >= 0) r->result->lower = r->interval.lower, r->result->upper = r->interval.upper;
  return status;
}

/* Of the distance that was asked for with the same options, less the certificate. */
static cprox_status gradient(const world *w, cprox_mover m, cprox_obstacle t, const cprox_options *o, reply *r) {
  (void)w;
  cprox_options before = *o;
  before.certificate = NULL;
  cprox_result found;
  const cprox_status status = cprox_distance(m, t, &before, ws, &found);
  if (status < 0) return status;
  const cprox_status told = cprox_distance_gradient(m, t, o, &found, ws, &r->gradient);
  if (told >= 0) *r->result = found;
  return told;
}

static cprox_status certify(const world *w, cprox_mover m, cprox_obstacle t, const cprox_options *o, reply *r) {
  (void)w;
  cprox_result found;
  cprox_status status = cprox_tolerance(m, t, 0.01, NULL, ws, &found);
  if (status < 0) return status;
  cprox_certificate *own = cprox_certificate_create();
  status = certify_of_list(m, &t, 1, 0.01, &found, o, ws, own);
  cprox_certificate_free(own);
  if (status >= 0) *r->result = found;
  return status;
}

static cprox_status nearest_of_set(const cprox_obstacles *set, cprox_mover m, const cprox_options *o, reply *r) {
  cprox_listed listed = {0, 0.0};
  const cprox_status status = cprox_obstacles_nearest(set, m, 1, o, ws, r->result, &listed);
  if (status >= 0) r->count = listed.count;
  return status;
}

static cprox_status of_set(const cprox_obstacle *t, cprox_mover m, const cprox_options *o, int which, reply *r) {
  cprox_obstacles *set = NULL;
  assert_int_equal(cprox_obstacles_create(t, 1, CPROX_INDEX_BVH, ws, &set), CPROX_OK);
  const cprox_status status = which == 0   ? cprox_obstacles_distance(set, m, o, ws, r->result, NULL)
                              : which == 1 ? cprox_obstacles_tolerance(set, m, 0.1, o, ws, r->result, NULL)
                              : which == 2 ? cprox_obstacles_collision(set, m, o, ws, r->result, NULL)
                              : which == 3 ? cprox_obstacles_time_of_contact(set, m, o, ws, r->result)
                                           : nearest_of_set(set, m, o, r);
  cprox_obstacles_free(set);
  return status;
}

static cprox_status set_distance(const world *w, cprox_mover m, cprox_obstacle t, const cprox_options *o, reply *r) {
  (void)w;
  return of_set(&t, m, o, 0, r);
}

static cprox_status set_tolerance(const world *w, cprox_mover m, cprox_obstacle t, const cprox_options *o, reply *r) {
  (void)w;
  return of_set(&t, m, o, 1, r);
}

static cprox_status set_collision(const world *w, cprox_mover m, cprox_obstacle t, const cprox_options *o, reply *r) {
  (void)w;
  return of_set(&t, m, o, 2, r);
}

static cprox_status set_time_of_contact(const world *w, cprox_mover m, cprox_obstacle t, const cprox_options *o,
                                        reply *r) {
  (void)w;
  return of_set(&t, m, o, 3, r);
}

static cprox_status set_nearest(const world *w, cprox_mover m, cprox_obstacle t, const cprox_options *o, reply *r) {
  (void)w;
  return of_set(&t, m, o, 4, r);
}

/* A mover that fails alone has a result: that counts as untouched. */
static cprox_status of_batch(const cprox_obstacle *t, const cprox_mover *m, const cprox_options *o, int which,
                             reply *r) {
  cprox_obstacles *batch = NULL;
  assert_int_equal(cprox_obstacles_create(t, 1, CPROX_INDEX_BATCH, ws, &batch), CPROX_OK);
  const cprox_result before = *r->result;
  const cprox_status status = which == 0   ? cprox_obstacles_distance_batch(batch, m, 0, 1, o, ws, r->result)
                              : which == 1 ? cprox_obstacles_tolerance_batch(batch, m, 0, 1, 0.1, o, ws, r->result)
                                           : cprox_obstacles_tolerance_batch(batch, m, 0, 1, 0.0, o, ws, r->result);
  cprox_obstacles_free(batch);
  if (status < 0) memcpy(r->result, &before, sizeof before);
  return status;
}

static cprox_status batch_distance(const world *w, cprox_mover m, cprox_obstacle t, const cprox_options *o, reply *r) {
  (void)w;
  return of_batch(&t, &m, o, 0, r);
}

static cprox_status batch_tolerance(const world *w, cprox_mover m, cprox_obstacle t, const cprox_options *o, reply *r) {
  (void)w;
  return of_batch(&t, &m, o, 1, r);
}

static cprox_status batch_collision(const world *w, cprox_mover m, cprox_obstacle t, const cprox_options *o, reply *r) {
  (void)w;
  return of_batch(&t, &m, o, 2, r);
}

/* Standing and translating bodies: the mover's place is taken by a body. */
static cprox_obstacle own_body(const world *w) {
  return cprox_obstacle_at(w->quadric, CPROX_POSE_IDENTITY);
}

static cprox_status pair(const world *w, cprox_mover m, cprox_obstacle t, const cprox_options *o, reply *r) {
  (void)m;
  return cprox_pair(own_body(w), t, o, ws, r->result);
}

static cprox_status pair_of_parts(const world *w, cprox_mover m, cprox_obstacle t, const cprox_options *o, reply *r) {
  (void)m;
  const cprox_body *const parts[2] = {w->quadric, w->ball};
  cprox_pose poses[2] = {CPROX_POSE_IDENTITY, CPROX_POSE_IDENTITY};
  poses[1].position.z = 2.0;
  cprox_body *two = NULL;
  assert_int_equal(cprox_body_create_compound(parts, poses, 2, ws, &two), CPROX_OK);
  const cprox_status status = cprox_pair(cprox_obstacle_at(two, CPROX_POSE_IDENTITY), t, o, ws, r->result);
  cprox_body_free(two);
  return status;
}

static cprox_status translating(const world *w, cprox_mover m, cprox_obstacle t, const cprox_options *o, reply *r) {
  (void)m;
  const cprox_translating a = {.from = own_body(w)}, b = {.from = t, .velocity = {0.1, 0, 0}};
  return cprox_translating_distance(a, b, 1.0, o, ws, r->result);
}

static cprox_status translating_contact(const world *w, cprox_mover m, cprox_obstacle t, const cprox_options *o,
                                        reply *r) {
  (void)m;
  const cprox_translating a = {.from = own_body(w)}, b = {.from = t, .velocity = {0.1, 0, 3.9}};
  return cprox_translating_contact(a, b, 1.0, o, ws, r->result);
}

static cprox_status growth(const world *w, cprox_mover m, cprox_obstacle t, const cprox_options *o, reply *r) {
  (void)m;
  return cprox_growth_distance(own_body(w), t, o, ws, &r->growth);
}

enum {
  SEARCH = 1 << STOP | 1 << RELATIVE | 1 << LOD,
  TAKES_MOVERS = 1 << 20,
  TAKES_SELF = 1 << 21,
  IS_DISTANCE = 1 << 22, /* the interval is that of a distance */
};

typedef struct row {
  const char *name;
  query ask;
  unsigned has;
} row;

static const row QUERIES[] = {
    {"distance", distance, SEARCH | 1 << CERTIFICATE | 1 << SIGNED | TAKES_MOVERS | TAKES_SELF | IS_DISTANCE},
    {"tolerance", tolerance, SEARCH | 1 << CERTIFICATE | TAKES_MOVERS | TAKES_SELF},
    {"collision", collision, SEARCH | 1 << CERTIFICATE | TAKES_MOVERS | TAKES_SELF},
    {"time of contact", time_of_contact, 1 << STOP | 1 << LOD | TAKES_MOVERS | TAKES_SELF},
    {"nearest", nearest, SEARCH | 1 << SIGNED | TAKES_MOVERS | IS_DISTANCE},
    {"within", within, SEARCH | 1 << SIGNED | TAKES_MOVERS | IS_DISTANCE},
    {"nearest pairs", nearest_pairs, SEARCH | TAKES_MOVERS | TAKES_SELF | IS_DISTANCE},
    {"profile", profile, SEARCH | 1 << SIGNED | TAKES_MOVERS | TAKES_SELF | IS_DISTANCE},
    {"gradient", gradient, SEARCH | 1 << SIGNED | TAKES_MOVERS | IS_DISTANCE},
    {"certify", certify, 1 << RELATIVE | 1 << LOD | TAKES_MOVERS},
    {"set distance", set_distance, SEARCH | 1 << SIGNED | TAKES_MOVERS | IS_DISTANCE},
    {"set tolerance", set_tolerance, SEARCH | TAKES_MOVERS},
    {"set collision", set_collision, SEARCH | TAKES_MOVERS},
    {"set time of contact", set_time_of_contact, 1 << STOP | 1 << LOD | TAKES_MOVERS},
    {"set nearest", set_nearest, SEARCH | 1 << SIGNED | TAKES_MOVERS | IS_DISTANCE},
    {"batch distance", batch_distance, SEARCH | 1 << SIGNED | TAKES_MOVERS | IS_DISTANCE},
    {"batch tolerance", batch_tolerance, SEARCH | TAKES_MOVERS},
    {"batch collision", batch_collision, SEARCH | TAKES_MOVERS},
    {"pair", pair, SEARCH | 1 << SIGNED},
    {"pair of parts", pair_of_parts, SEARCH | 1 << SIGNED},
    {"translating distance", translating, 1 << RELATIVE},
    {"translating contact", translating_contact, 1 << STOP},
    {"growth distance", growth, 1 << STOP},
};
enum { N_QUERIES = sizeof QUERIES / sizeof *QUERIES };

/* ---- the table ---- */

typedef struct walk {
  world w;
  size_t refused, answered, stopped[N_QUERIES], proven, deep;
} walk;

/* With the option it must answer, and the option must show. */
static void expect_effect(walk *all, size_t q, mover_kind mover, target_kind target, bool apart, option o,
                          const reply *plain, const reply *r, const char *what) {
  const cprox_result *before = plain->result, *now = r->result;
  const bool measured = (QUERIES[q].has & IS_DISTANCE) != 0;
  if (o == STOP) all->stopped[q] += stop_calls;
  if (o == SIGNED && measured && !apart && (target == BALL || target == BOX || target == PLANE || target == QUADRIC)) {
    if (!(now->upper < -0.01)) fail_msg("%s: [%g, %g] is not signed", what, now->lower, now->upper);
    all->deep++;
  }
  const bool itself = mover == ROBOT_SELF; /* whatever its obstacles are, it overlaps itself */
  if (o == SIGNED && measured && apart && !itself && fabs(now->upper - before->upper) > 2e-6)
    fail_msg("%s: %.9g, not %.9g", what, now->upper, before->upper);
  if (o == CERTIFICATE && apart && mover <= TUBE && (target <= PLANE || target == LINE)) {
    if (cprox_certificate_get_info(proof).size == 0) fail_msg("%s: no certificate", what);
    all->proven++;
  }
  if (o == RELATIVE && measured && (now->lower > before->upper || before->lower > now->upper))
    fail_msg("%s: [%g, %g], not [%g, %g]", what, now->lower, now->upper, before->lower, before->upper);
  if (o == LOD && measured && now->lower > before->upper) fail_msg("%s: a ball is farther than what is in it", what);
}

static void walk_option(walk *all, size_t q, mover_kind mover, target_kind target, bool apart, option o,
                        const reply *plain, cprox_status base) {
  const cprox_mover m = mover_of(&all->w, mover);
  const cprox_obstacle t = target_of(&all->w, target, apart ? 4.0 : 0.0);
  const cprox_options options = with(o);
  reply r, untouched;
  memset(&r, 0x5a, sizeof r);
  memset(&untouched, 0x5a, sizeof untouched);
  stop_calls = 0;
  const cprox_status status = QUERIES[q].ask(&all->w, m, t, &options, &r);
  char what[160];
  snprintf(what, sizeof what, "%s, %s, %s, %s, %s", QUERIES[q].name, MOVER_NAMES[mover], TARGET_NAMES[target],
           apart ? "apart" : "not apart", OPTION_NAMES[o]);

  const bool has = (QUERIES[q].has >> o & 1u) != 0;
  const bool without_depth = o == SIGNED && mover == ROBOT && (target == MESH || target == CLOUD);
  if (!has) {
    all->refused++;
    const char *reason = cprox_workspace_error(ws);
    if (status != CPROX_INVALID) fail_msg("%s: %s, and the option does not apply", what, cprox_status_name(status));
    if (base >= 0 && (!strstr(reason, OPTION_NAMES[o]) || !strstr(reason, "does not apply")))
      fail_msg("%s: '%s'", what, reason);
    if (memcmp(&r, &untouched, sizeof r) != 0) fail_msg("%s: refused, but the result is written", what);
    return;
  }
  if (without_depth && base >= 0) { /* robots know the depth of hulls, and these have none */
    all->refused++;
    assert_int_equal(status, CPROX_INVALID);
    assert_non_null(strstr(cprox_workspace_error(ws), "signed_distance: obstacle 0 is a mesh without a hull"));
    return;
  }
  if (base < 0) {
    /* balls may be answered where bodies are not */
    if (o != LOD) assert_int_equal(status, base);
    return;
  }
  if (status < 0) fail_msg("%s: %s", what, cprox_workspace_error(ws));
  all->answered++;
  expect_effect(all, q, mover, target, apart, o, plain, &r, what);
}

/* 23 queries, 5 movers, 9 targets, apart or not, 5 options. What the plain query refuses is refused with the option,
 * too. */
CASE(options_have_their_effect_or_are_refused) {
  walk all = {.w = make_world()};
  for (size_t q = 0; q < N_QUERIES; q++) {
    for (mover_kind mover = POINT; mover < N_MOVERS; mover++) {
      if (mover != POINT && !(QUERIES[q].has & TAKES_MOVERS)) continue;
      if (mover == ROBOT_SELF && !(QUERIES[q].has & TAKES_SELF)) continue;
      for (target_kind target = BALL; target < N_TARGETS; target++) {
        for (int apart = 0; apart < 2; apart++) {
          const cprox_options options = CPROX_OPTIONS_DEFAULT;
          reply plain = {0};
          const cprox_obstacle t = target_of(&all.w, target, apart ? 4.0 : 0.0);
          const cprox_status base = QUERIES[q].ask(&all.w, mover_of(&all.w, mover), t, &options, &plain);
          for (option o = SIGNED; o < N_OPTIONS; o++) walk_option(&all, q, mover, target, apart, o, &plain, base);
        }
      }
    }
  }
  for (size_t q = 0; q < N_QUERIES; q++)
    if ((QUERIES[q].has >> STOP & 1u) && all.stopped[q] == 0 && strcmp(QUERIES[q].name, "pair") != 0)
      fail_msg("%s never asks its stop function", QUERIES[q].name);
  assert_true(all.refused > 500 && all.answered > 1000 && all.proven > 10 && all.deep > 30);
  free_world(&all.w);
}

/* ---- sizes ---- */

/* Options of a caller that was compiled with other headers: nothing of them but their size is read, nothing is written.
 */
CASE(options_of_another_size_are_refused_by_every_query) {
  world w = make_world();
  const size_t right = sizeof(cprox_options), wrong[] = {0, 8, right - 8, right + 8, SIZE_MAX};
  for (size_t q = 0; q < N_QUERIES; q++) {
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
      cprox_options options = CPROX_OPTIONS_DEFAULT;
      assert_int_equal(options.size, right);
      options.size = wrong[i];
      reply r, untouched;
      memset(&r, 0x5a, sizeof r);
      memset(&untouched, 0x5a, sizeof untouched);
      const cprox_obstacle t = target_of(&w, BALL, 4.0);
      assert_int_equal(QUERIES[q].ask(&w, cprox_point_along(w.way), t, &options, &r), CPROX_INVALID);
      if (!strstr(cprox_workspace_error(ws), "options.size is") || !strstr(cprox_workspace_error(ws), cprox_version()))
        fail_msg("%s: '%s'", QUERIES[q].name, cprox_workspace_error(ws));
      if (memcmp(&r, &untouched, sizeof r) != 0) fail_msg("%s: refused, but the result is written", QUERIES[q].name);
    }
  }
  free_world(&w);

  cprox_solid *ball = NULL;
  const cprox_solid_description description = {.kind = CPROX_SOLID_BALL, .dimension = 3, .radius = 1.0};
  assert_int_equal(cprox_solid_create(&description, ws, &ball), CPROX_OK);
  cprox_gap_options o = CPROX_GAP_OPTIONS_DEFAULT;
  cprox_gap *gap = NULL;
  cprox_gap_cascade *cascade = NULL;
  o.samples = 9, o.size += 8;
  assert_int_equal(cprox_gap_create(ball, ball, &o, ws, &gap), CPROX_INVALID);
  assert_non_null(strstr(cprox_workspace_error(ws), "options.size is"));
  assert_int_equal(cprox_gap_cascade_create(ball, ball, &o, ws, &cascade), CPROX_INVALID);
  assert_non_null(strstr(cprox_workspace_error(ws), "options.size is"));
  assert_true(!gap && !cascade);
  cprox_solid_free(ball);
}

static bool is_zero(const uint64_t *reserved, size_t n) {
  for (size_t i = 0; i < n; i++)
    if (reserved[i] != 0) return false;
  return true;
}

/* The room for later members is 0 in whatever a query writes. */
CASE(results_keep_room_for_later_members) {
  world w = make_world();
  size_t results = 0, others = 0;
  for (size_t q = 0; q < N_QUERIES; q++) {
    for (mover_kind mover = POINT; mover < N_MOVERS; mover++) {
      if (mover != POINT && !(QUERIES[q].has & TAKES_MOVERS)) continue;
      for (int apart = 0; apart < 2; apart++) {
        const cprox_options options = CPROX_OPTIONS_DEFAULT;
        reply r, untouched;
        memset(&r, 0x5a, sizeof r);
        memset(&untouched, 0x5a, sizeof untouched);
        const cprox_obstacle t = target_of(&w, BALL, apart ? 4.0 : 0.0);
        if (QUERIES[q].ask(&w, mover_of(&w, mover), t, &options, &r) < 0) continue;
        if (r.result->status != untouched.result->status) {
          results++;
          if (!is_zero(r.result->reserved, 4)) fail_msg("%s: the result", QUERIES[q].name);
        }
        if (r.interval.obstacle_index != untouched.interval.obstacle_index) {
          others++;
          assert_true(is_zero(r.interval.reserved, 2));
        }
        if (strcmp(QUERIES[q].name, "gradient") == 0) others++, assert_true(is_zero(r.gradient.reserved, 4));
        if (strcmp(QUERIES[q].name, "growth distance") == 0) others++, assert_true(is_zero(r.growth.reserved, 2));
      }
    }
  }
  assert_true(results > 60 && others >= 6);
  free_world(&w);
}

/* ---- structures besides the options ---- */

/* Pairs and `self` are a robot's: with a curve they are refused by every query. */
CASE(what_belongs_to_robots_is_refused_with_curves) {
  world w = make_world();
  const cprox_robot_pair one = {0, 0};
  for (size_t q = 0; q < N_QUERIES; q++) {
    if (!(QUERIES[q].has & TAKES_MOVERS)) continue;
    for (int i = 0; i < 3; i++) {
      cprox_mover m = cprox_point_along(w.way);
      if (i == 0) m.pairs = &one, m.n_pairs = 1;
      if (i == 1) m.n_pairs = 1;
      reply r;
      const cprox_options options = CPROX_OPTIONS_DEFAULT;
      const cprox_obstacle t = target_of(&w, BALL, 4.0);
      cprox_mover asked = m;
      if (i == 2) asked.kind = CPROX_MOVER_ROBOT_SELF;
      assert_int_equal(QUERIES[q].ask(&w, asked, t, &options, &r), CPROX_INVALID);
    }
  }
  cprox_mover m = cprox_robot_along(w.motion, NULL, 0);
  m.radius = 0.1;
  cprox_result r;
  /* a tag that does not fit what it is of */
  cprox_mover wrong[6] = {cprox_point_along(w.way),
                          cprox_point_along(w.way),
                          cprox_body_along(w.box, w.way),
                          cprox_robot_along(w.motion, NULL, 0),
                          cprox_robot_self(w.motion, NULL, 0),
                          cprox_body_along(NULL, w.way)};
  wrong[0].kind = CPROX_MOVER_BODY, wrong[1].kind = CPROX_MOVER_ROBOT, wrong[2].kind = CPROX_MOVER_BALL;
  wrong[3].kind = CPROX_MOVER_BALL, wrong[4].kind = (cprox_mover_kind)9;
  for (int i = 0; i < 6; i++) {
    const cprox_status status = cprox_distance(wrong[i], target_of(&w, BALL, 4.0), NULL, ws, &r);
    if (status != CPROX_INVALID || !strstr(cprox_workspace_error(ws), "mover")) fail_msg("mover %d is not refused", i);
  }
  assert_int_equal(cprox_distance(m, target_of(&w, BALL, 4.0), NULL, ws, &r), CPROX_INVALID);
  free_world(&w);
}

/* The number of samples follows from delta, or is given. */
CASE(gaps_refuse_delta_and_samples_together) {
  cprox_solid *ball = NULL;
  assert_int_equal(cprox_solid_create(
                       &(cprox_solid_description){.kind = CPROX_SOLID_BALL, .dimension = 3, .radius = 1.0}, ws, &ball),
                   CPROX_OK);
  cprox_gap_options o = CPROX_GAP_OPTIONS_DEFAULT;
  cprox_gap *gap = NULL;
  o.samples = 9, o.delta = 0.3;
  assert_int_equal(cprox_gap_create(ball, ball, &o, ws, &gap), CPROX_INVALID);
  assert_non_null(strstr(cprox_workspace_error(ws), "delta is 0.3 and samples is 9"));
  o.delta = NAN;
  assert_int_equal(cprox_gap_create(ball, ball, &o, ws, &gap), CPROX_INVALID);
  o.delta = 0.0;
  assert_int_equal(cprox_gap_create(ball, ball, &o, ws, &gap), CPROX_OK);
  cprox_gap_free(gap);
  cprox_solid_free(ball);
}

/* A start is of pairs that stand, and it is written then. */
CASE(a_start_is_refused_by_all_but_pairs) {
  world w = make_world();
  cprox_pair_start start = {.usable = false};
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.start = &start;
  cprox_result r;
  assert_int_equal(cprox_distance(cprox_point_along(w.way), target_of(&w, BOX, 0.0), &options, ws, &r), CPROX_INVALID);
  assert_non_null(strstr(cprox_workspace_error(ws), "start does not apply to"));
  assert_int_equal(cprox_time_of_contact(cprox_point_along(w.way), target_of(&w, BOX, 0.0), &options, ws, &r),
                   CPROX_INVALID);
  assert_true(cprox_pair(target_of(&w, BOX, 0.0), target_of(&w, BALL, 9.0), &options, ws, &r) >= 0);
  assert_true(start.usable);
  free_world(&w);
}

/* Signed: of two bodies that the curve goes through the deeper one is the nearest, alone, in a set and in a batch. */
CASE(the_deepest_is_the_nearest_where_distances_are_signed) {
  world w = make_world();
  cprox_obstacle targets[3] = {target_of(&w, BOX, 0.0), target_of(&w, BALL, 0.0), target_of(&w, BALL, 3.0)};
  const cprox_options options = with(SIGNED);
  const cprox_mover m = cprox_point_along(w.way);
  cprox_obstacles *set = NULL;
  assert_int_equal(cprox_obstacles_create(targets, 3, CPROX_INDEX_BVH, ws, &set), CPROX_OK);
  cprox_result one[3], near[3], found[3];
  size_t n = 0;
  cprox_listed listed;
  for (size_t i = 0; i < 3; i++) assert_int_equal(cprox_distance(m, targets[i], &options, ws, &one[i]), CPROX_OK);
  assert_true(one[1].upper < one[0].upper && one[0].upper < -0.1);
  for (size_t k = 1; k <= 3; k++) {
    assert_int_equal(nearest_of_list(m, targets, 3, k, &options, ws, near, &n), CPROX_OK);
    assert_int_equal(cprox_obstacles_nearest(set, m, k, &options, ws, found, &listed), CPROX_OK);
    assert_true(n == k && listed.count == k);
    const int32_t order[3] = {1, 0, 2};
    for (size_t i = 0; i < k; i++) {
      assert_int_equal(near[i].obstacle_index, order[i]);
      assert_int_equal(found[i].obstacle_index, order[i]);
      assert_true(fabs(near[i].upper - one[order[i]].upper) <= 2e-6 && fabs(found[i].upper - near[i].upper) <= 2e-6);
    }
  }
  assert_int_equal(within_of_list(m, targets, 3, 0.0, &options, ws, near, &n), CPROX_OK);
  assert_true(n == 2 && near[0].upper < -0.1 && near[0].upper - near[0].lower <= 1e-6);
  cprox_obstacles_free(set);
  free_world(&w);
}

static int setup(void **state) {
  proof = cprox_certificate_create();
  return workspace_setup(state);
}

static int teardown(void **state) {
  cprox_certificate_free(proof);
  return workspace_teardown(state);
}

int main(void) {
  return cases_run(setup, teardown);
}
