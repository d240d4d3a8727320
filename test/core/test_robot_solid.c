/* SPDX-License-Identifier: BSD-3-Clause */
/* Solid meshes along motions: what is inside of one is in contact. Against the winding number of every vertex at many
 * times, in long double. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "curve_proximity/cprox.h"
#include "support/builders.h"
#include "support/cases.h"
#include "support/meshes.h"
#include "support/of_list.h"

enum { SAMPLES = 5, VARIABLES = 4, EVERY = 5 };

/* What is this near to a surface is on neither side. */
static const long double ON_SURFACE = 1e-9L;

/* ---- things ---- */

typedef enum thing_kind { THING_MESH, THING_TWO_MESHES, THING_CLOUD, THING_BOXES, THING_SPHERE, THING_BOX } thing_kind;

/* A body, the same with meshes as surfaces, and points of it: every fifth vertex, at least one of each connected part.
 */
typedef struct thing {
  thing_kind kind;
  bool solid;
  test_mesh mesh; /* of the first two kinds */
  cprox_body *body, *surface;
  cprox_body *parts[4]; /* that the two are made of */
  vec3 points[64];
  size_t n;
} thing;

static void add_point(thing *x, vec3 p) {
  assert_true(x->n < sizeof x->points / sizeof *x->points);
  x->points[x->n++] = p;
}

static test_mesh any_closed(rng *r, double size) {
  if (rng_index(r, 2)) return mesh_box(vec(size * rng_uniform(r, 0.3, 1), size * rng_uniform(r, 0.3, 1), size));
  return mesh_torus(6 + rng_index(r, 8), 4 + rng_index(r, 3), 0.6 * size, 0.38 * size, rng_uniform(r, 0.0, 0.2));
}

/* The second one beside the first. */
static void append(test_mesh *a, test_mesh *b, vec3 by) {
  a->vertices = realloc(a->vertices, (a->n + b->n) * sizeof *a->vertices);
  a->triangles = realloc(a->triangles, (a->m + b->m) * sizeof *a->triangles);
  assert_true(a->vertices && a->triangles);
  for (size_t i = 0; i < b->n; i++) a->vertices[a->n + i] = vec_add(b->vertices[i], by);
  for (size_t i = 0; i < b->m; i++)
    for (int k = 0; k < 3; k++) a->triangles[a->m + i][k] = (uint32_t)a->n + b->triangles[i][k];
  a->n += b->n, a->m += b->m;
  mesh_free(b);
}

/* As it is, or with its hull as a coarser level of detail. */
static cprox_body *maybe_lod(cprox_body *mesh, cprox_body *hull, bool lod) {
  cprox_body *made = mesh;
  if (lod) assert_int_equal(cprox_body_create_lod(hull, 0.0, mesh, ws, &made), CPROX_OK);
  return made;
}

static void make_mesh(rng *r, double size, thing *x) {
  x->mesh = any_closed(r, size);
  const size_t first = x->mesh.n;
  for (size_t i = 0; i < first; i += EVERY) add_point(x, x->mesh.vertices[i]);
  if (x->kind == THING_TWO_MESHES) {
    test_mesh second = any_closed(r, 0.5 * size);
    append(&x->mesh, &second, vec_scale(2.5 * size, rng_unit(r)));
  }
  const bool lod = rng_index(r, 2);
  x->parts[0] = mesh_body(&x->mesh, x->solid ? CPROX_MESH_FILL_SOLID : CPROX_MESH_FILL_SURFACE, ws);
  x->parts[1] = mesh_body(&x->mesh, CPROX_MESH_FILL_SURFACE, ws);
  assert_int_equal(cprox_body_create_polytope(x->mesh.vertices, x->mesh.n, ws, &x->parts[2]), CPROX_OK);
  assert_int_equal(cprox_body_get_info(x->parts[0]).is_solid, x->solid);
  x->body = maybe_lod(x->parts[0], x->parts[2], lod);
  x->surface = maybe_lod(x->parts[1], x->parts[2], lod);
  for (size_t i = first; i < x->mesh.n; i += EVERY) add_point(x, x->mesh.vertices[i]);
}

static void make_elements(rng *r, double size, thing *x) {
  vec3 low[12], high[12];
  const size_t n = 1 + rng_index(r, 12);
  for (size_t i = 0; i < n; i++) {
    low[i] = rng_in_cube(r, size);
    high[i] = vec_axpy(low[i], rng_uniform(r, 0.0, 0.3) * size, vec(1, 2, 1));
    add_point(x, low[i]);
  }
  if (x->kind == THING_CLOUD)
    assert_int_equal(cprox_body_create_points(low, n, 0.0, SIZE_MAX, ws, &x->body), CPROX_OK);
  else
    assert_int_equal(cprox_body_create_boxes(low, high, n, SIZE_MAX, ws, &x->body), CPROX_OK);
  x->surface = x->body;
}

static void thing_make(rng *r, thing_kind kind, bool solid, double size, thing *x) {
  memset(x, 0, sizeof *x);
  x->kind = kind;
  x->solid = solid && kind <= THING_TWO_MESHES;
  if (kind <= THING_TWO_MESHES) {
    make_mesh(r, size, x);
  } else if (kind <= THING_BOXES) {
    make_elements(r, size, x);
  } else {
    add_point(x, vec(0, 0, 0));
    if (kind == THING_SPHERE)
      assert_int_equal(cprox_body_create_sphere(size, ws, &x->body), CPROX_OK);
    else
      assert_int_equal(cprox_body_create_box(vec(size, 0.3 * size, 0.5 * size), ws, &x->body), CPROX_OK);
    x->surface = x->body;
  }
}

static void thing_free(thing *x) {
  if (x->surface != x->body && x->surface != x->parts[1]) cprox_body_free(x->surface);
  if (x->body != x->parts[0]) cprox_body_free(x->body);
  for (int i = 0; i < 4; i++) cprox_body_free(x->parts[i]);
  if (x->kind <= THING_TWO_MESHES) mesh_free(&x->mesh);
}

/* ---- a thing on a chain: three slides and a hinge ---- */

typedef struct carrier {
  cprox_pose base, pose;
  double from[VARIABLES], to[VARIABLES];
  cprox_robot *robot, *of_surface;
  cprox_motion *motion, *motion_of_surface;
} carrier;

static cprox_robot *make_robot(const carrier *c, const cprox_body *body) {
  cprox_link links[VARIABLES];
  for (int i = 0; i < VARIABLES; i++)
    links[i] = (cprox_link){.parent = i - 1,
                            .type = i < 3 ? CPROX_JOINT_PRISMATIC : CPROX_JOINT_REVOLUTE,
                            .origin = i == 0 ? c->base : CPROX_POSE_IDENTITY,
                            .axis = vec(i == 0, i == 1, i >= 2),
                            .variable = i,
                            .multiplier = 1.0};
  const cprox_link_geometry geometry = {.body = body, .pose = c->pose, .link = VARIABLES - 1};
  cprox_robot *robot = NULL;
  const cprox_status status = cprox_robot_create(links, VARIABLES, &geometry, 1, VARIABLES, ws, &robot);
  if (status != CPROX_OK) fail_msg("%s", cprox_workspace_error(ws));
  return robot;
}

static cprox_motion *make_motion(const carrier *c, const cprox_robot *robot) {
  static const int32_t ALL[VARIABLES] = {0, 1, 2, 3};
  const cprox_waypoint points[2] = {{.time = 0.0, .positions = c->from}, {.time = 1.0, .positions = c->to}};
  const cprox_motion_description description = {.kind = CPROX_MOTION_WAYPOINTS,
                                                .variables = ALL,
                                                .n_variables = VARIABLES,
                                                .waypoints = points,
                                                .n_waypoints = 2};
  cprox_motion *motion = NULL;
  assert_int_equal(cprox_motion_create(robot, &description, ws, &motion), CPROX_OK);
  return motion;
}

static void carrier_make(rng *r, const thing *x, double far, double speed, carrier *c) {
  *c = (carrier){.base = rng_pose(r, 0.0), .pose = rng_pose(r, 0.1)};
  for (int i = 0; i < VARIABLES; i++) {
    c->from[i] = rng_uniform(r, -far, far);
    c->to[i] = c->from[i] + rng_uniform(r, -speed, speed);
  }
  c->robot = make_robot(c, x->body), c->of_surface = make_robot(c, x->surface);
  c->motion = make_motion(c, c->robot), c->motion_of_surface = make_motion(c, c->of_surface);
}

static void carrier_free(carrier *c) {
  cprox_motion_free(c->motion);
  cprox_motion_free(c->motion_of_surface);
  cprox_robot_free(c->robot);
  cprox_robot_free(c->of_surface);
}

static vec3l turned(vec3l x, long double angle) {
  const long double s = sinl(angle), c = cosl(angle);
  return (vec3l){c * x.x - s * x.y, s * x.x + c * x.y, x.z};
}

static long double value_at(const carrier *c, int i, long double t) {
  return c->from[i] + ((long double)c->to[i] - c->from[i]) * t;
}

static vec3l shift_at(const carrier *c, long double t) {
  return (vec3l){value_at(c, 0, t), value_at(c, 1, t), value_at(c, 2, t)};
}

static vec3l to_world(const carrier *c, long double t, vec3l x) {
  return ref_to_world(&c->base, ref_add(shift_at(c, t), turned(ref_to_world(&c->pose, x), value_at(c, 3, t))));
}

static vec3l to_thing(const carrier *c, long double t, vec3l x) {
  const vec3l y = ref_sub(ref_to_local(&c->base, x), shift_at(c, t));
  return ref_to_local(&c->pose, turned(y, -value_at(c, 3, t)));
}

/* ---- one moving thing and another one, which stands or moves ---- */

typedef struct scene {
  thing a, b;
  carrier on_a, on_b;
  cprox_pose at; /* of b where it stands */
  bool both;     /* b moves, too */
} scene;

static vec3l world_of_b(const scene *s, long double t, vec3l x) {
  return s->both ? to_world(&s->on_b, t, x) : ref_to_world(&s->at, x);
}

static vec3l to_b(const scene *s, long double t, vec3l x) {
  return s->both ? to_thing(&s->on_b, t, x) : ref_to_local(&s->at, x);
}

/* Whether a point of one is inside of the other, which is solid, and not on its surface. */
static bool holds(const thing *host, const thing *guest, const scene *s, bool host_is_a, long double t) {
  for (size_t i = 0; host->solid && i < guest->n; i++) {
    const vec3l point = ref_vec(guest->points[i]),
                world = host_is_a ? world_of_b(s, t, point) : to_world(&s->on_a, t, point);
    const vec3l x = host_is_a ? to_thing(&s->on_a, t, world) : to_b(s, t, world);
    if (fabsl(mesh_winding(&host->mesh, x)) > 0.5L && mesh_distance(&host->mesh, x) > ON_SURFACE) return true;
  }
  return false;
}

static bool one_in_the_other(const scene *s, long double t) {
  return holds(&s->b, &s->a, s, false, t) || holds(&s->a, &s->b, s, true, t);
}

/* ---- asking ---- */

typedef struct asked {
  cprox_robot *joined;
  cprox_motion *motion;
  cprox_obstacles *obstacles;
  cprox_mover mover;
} asked;

static asked ask_about(const scene *s, bool surfaces, cprox_obstacle_index index, double tolerance) {
  asked q = {.joined = NULL};
  cprox_motion *const a = surfaces ? s->on_a.motion_of_surface : s->on_a.motion;
  if (!s->both) {
    const cprox_obstacle target = cprox_obstacle_at(surfaces ? s->b.surface : s->b.body, s->at);
    assert_int_equal(cprox_obstacles_create(&target, 1, index, ws, &q.obstacles), CPROX_OK);
    q.mover = cprox_robot_along(a, NULL, 0);
    return q;
  }
  const cprox_robot *robots[2] = {surfaces ? s->on_a.of_surface : s->on_a.robot,
                                  surfaces ? s->on_b.of_surface : s->on_b.robot};
  assert_int_equal(cprox_robot_join(robots, NULL, 2, ws, &q.joined), CPROX_OK);
  const cprox_joined_motion parts[2] = {
      {.motion = a}, {.motion = surfaces ? s->on_b.motion_of_surface : s->on_b.motion, .tolerance = tolerance}};
  const cprox_motion_description description = {.kind = CPROX_MOTION_JOINED, .joined = parts, .n_joined = 2};
  assert_int_equal(cprox_motion_create(q.joined, &description, ws, &q.motion), CPROX_OK);
  q.mover = cprox_robot_self(q.motion, NULL, 0);
  return q;
}

static void asked_free(asked *q) {
  cprox_obstacles_free(q->obstacles);
  cprox_motion_free(q->motion);
  cprox_robot_free(q->joined);
}

static cprox_result distance(const asked *q, double epsilon) {
  const cprox_options options = accurate(epsilon);
  cprox_result r;
  const cprox_status status = cprox_obstacles_distance(q->obstacles, q->mover, &options, ws, &r, NULL);
  if (status < 0) fail_msg("%s", cprox_workspace_error(ws));
  return r;
}

static void scene_make(rng *r, size_t i, scene *s) {
  const bool swap = i % 3 == 2; /* the moving one is the larger one */
  const thing_kind kind = i % 2 ? (thing_kind)rng_index(r, THING_BOX + 1) : THING_TWO_MESHES;
  s->both = i % 4 == 3;
  thing *small = swap ? &s->b : &s->a, *large = swap ? &s->a : &s->b;
  thing_make(r, kind, rng_index(r, 2), rng_log_uniform(r, 0.02, 0.4), small);
  thing_make(r, (thing_kind)rng_index(r, 2), true, 1.0, large);
  const double speed = rng_log_uniform(r, 0.02, 2.0);
  s->at = rng_pose(r, 0.7);
  carrier_make(r, &s->a, 0.5, speed, &s->on_a);
  carrier_make(r, &s->b, s->both ? 0.5 : 0.0, speed, &s->on_b);
}

static void scene_free(scene *s) {
  carrier_free(&s->on_a);
  carrier_free(&s->on_b);
  thing_free(&s->a);
  thing_free(&s->b);
}

/* What every query says where one is in the other at the start, or not. */
static void check_others(const asked *q, const scene *s, bool inside, bool apart) {
  const cprox_options options = accurate(1e-5);
  cprox_result r;
  assert_true(cprox_obstacles_collision(q->obstacles, q->mover, &options, ws, &r, NULL) >= 0);
  if (inside) assert_int_equal(r.verdict, CPROX_VERDICT_VIOLATED);
  if (apart) assert_int_equal(r.verdict, CPROX_VERDICT_CLEAR);
  assert_true(cprox_obstacles_tolerance(q->obstacles, q->mover, 1e-4, &options, ws, &r, NULL) >= 0);
  if (inside) assert_int_equal(r.verdict, CPROX_VERDICT_VIOLATED);
  assert_true(cprox_obstacles_time_of_contact(q->obstacles, q->mover, &options, ws, &r) >= 0);
  if (inside) assert_true(r.verdict == CPROX_VERDICT_VIOLATED && r.t == 0.0 && r.t_contact_lower == 0.0);
  if (apart) assert_int_equal(r.verdict, CPROX_VERDICT_CLEAR);
  const double breaks[4] = {0.0, 0.3, 0.5, 1.0};
  cprox_profile_interval interval[3];
  assert_true(cprox_obstacles_profile(q->obstacles, q->mover, breaks, 3, INFINITY, &options, ws, interval) >= 0);
  for (int k = 0; k < 3; k++) {
    if (one_in_the_other(s, (long double)breaks[k])) assert_true(interval[k].upper == 0.0 && interval[k].lower == 0.0);
    if (apart) assert_true(interval[k].lower > 0.0);
  }
}

/* 300 scenes (seed 8101): a mesh of one or two connected parts, points, boxes or a convex body, and a solid mesh, large
 * or small, moving past each other. Where a point is inside at any of 5 times the distance is 0; where one is at the
 * start every query says contact there; where none is, and the surfaces do not touch, it is that of the surfaces. */
CASE(what_is_inside_of_a_solid_is_in_contact) {
  rng r = rng_seed(8101);
  size_t contained = 0, clear = 0, touching = 0;
  for (size_t i = 0; i < test_cases(300); i++) {
    scene *s = malloc(sizeof *s);
    assert_non_null(s);
    scene_make(&r, i, s);
    asked q = ask_about(s, false, i % 5 ? CPROX_INDEX_NONE : CPROX_INDEX_BVH, 0.0);
    asked of_surfaces = ask_about(s, true, CPROX_INDEX_NONE, 0.0);
    const cprox_result d = distance(&q, 1e-5), surface = distance(&of_surfaces, 1e-5);
    const bool inside = one_in_the_other(s, 0.0L);
    for (int k = 0; k < SAMPLES && d.lower > 0.0; k++)
      if (one_in_the_other(s, (long double)k / (SAMPLES - 1))) fail_msg("scene %zu: %g, but inside", i, d.lower);
    const bool apart = surface.lower > 1e-5 && !inside;
    if (inside && !(d.upper == 0.0 && d.lower == 0.0))
      fail_msg("scene %zu: [%g, %g], inside at the start", i, d.lower, d.upper);
    if (inside && surface.lower > 0.0) assert_int_equal(d.lod, CPROX_LOD_MESH);
    if (!inside && surface.lower > 0.0 &&
        !(d.lower <= surface.upper && surface.lower <= d.upper && d.upper <= surface.upper + 1e-5))
      fail_msg("scene %zu: [%g, %g], the surfaces [%g, %g]", i, d.lower, d.upper, surface.lower, surface.upper);
    contained += inside && surface.lower > 0.0, clear += apart, touching += surface.upper == 0.0;
    check_others(&q, s, inside, apart);
    asked_free(&q);
    asked_free(&of_surfaces);
    scene_free(s);
    free(s);
  }
  print_message("%zu inside and clear of the surface, %zu apart, %zu touching\n", contained, clear, touching);
  assert_true(contained > test_cases(300) / 12 && clear > test_cases(300) / 12 && touching > test_cases(300) / 12);
}

/* 80 pairs of moving things (seed 8102), one of which starts up to .3 s earlier or later: what is inside for one of the
 * starts is in contact. */
CASE(whenever_it_starts) {
  rng r = rng_seed(8102);
  size_t contained = 0;
  for (size_t i = 0; i < test_cases(80); i++) {
    scene *s = malloc(sizeof *s);
    assert_non_null(s);
    scene_make(&r, 4 * i + 3, s);
    asked q = ask_about(s, false, CPROX_INDEX_NONE, 0.3), known = ask_about(s, false, CPROX_INDEX_NONE, 0.0);
    const cprox_result d = distance(&q, 1e-4), e = distance(&known, 1e-4);
    assert_true(d.lower <= e.upper);
    const bool inside = one_in_the_other(s, 0.0L);
    if (inside) assert_true(d.lower == 0.0 && d.upper == 0.0);
    contained += inside;
    asked_free(&q);
    asked_free(&known);
    scene_free(s);
    free(s);
  }
  assert_true(contained > test_cases(80) / 8);
}

/* A box inside of another one, 0.9 from its walls, on a pose that stands: at most as deep as their hulls, where depths
 * are asked for, and of no gradient where they are not. */
CASE(depths_of_solids_are_at_most_those_of_their_hulls) {
  test_mesh large = mesh_box(vec(1, 1, 1)), small = mesh_box(vec(0.1, 0.1, 0.1));
  cprox_body *surface = mesh_body(&small, CPROX_MESH_FILL_SURFACE, ws);
  cprox_body *hull = NULL, *lod = NULL, *of_small = NULL, *small_lod = NULL;
  cprox_body *solid = mesh_body(&large, CPROX_MESH_FILL_SOLID, ws);
  assert_int_equal(cprox_body_create_polytope(large.vertices, large.n, ws, &hull), CPROX_OK);
  assert_int_equal(cprox_body_create_polytope(small.vertices, small.n, ws, &of_small), CPROX_OK);
  assert_int_equal(cprox_body_create_lod(hull, 0.0, solid, ws, &lod), CPROX_OK);
  assert_int_equal(cprox_body_create_lod(of_small, 0.0, surface, ws, &small_lod), CPROX_OK);
  carrier c = {.base = CPROX_POSE_IDENTITY, .pose = CPROX_POSE_IDENTITY, .to = {0.0, 0.0, 0.2, 0.0}};
  c.robot = make_robot(&c, small_lod);
  c.motion = make_motion(&c, c.robot);
  const cprox_obstacle target = cprox_obstacle_at(lod, CPROX_POSE_IDENTITY);
  cprox_options options = accurate(1e-6);
  cprox_result r;
  cprox_obstacles *obstacles = NULL;
  assert_int_equal(cprox_obstacles_create(&target, 1, CPROX_INDEX_NONE, ws, &obstacles), CPROX_OK);
  cprox_motion_gradient gradient = {0};
  assert_int_equal(
      cprox_robot_distance_gradient(obstacles, cprox_robot_along(c.motion, NULL, 0), &options, ws, &r, &gradient),
      CPROX_OK);
  assert_true(r.lower == 0.0 && r.upper == 0.0 && !gradient.valid);
  options.signed_distance = true;
  assert_int_equal(cprox_obstacles_distance(obstacles, cprox_robot_along(c.motion, NULL, 0), &options, ws, &r, NULL),
                   CPROX_OVERLAP);
  /* at the start the way out is 1 and the half of the small one */
  assert_true(r.lower <= -1.1 && r.lower >= -1.1 - 2e-6 && r.upper == 0.0);
  assert_int_equal(r.lod, CPROX_LOD_HULL);
  const cprox_obstacle bare = cprox_obstacle_at(solid, CPROX_POSE_IDENTITY);
  assert_int_equal(distance_of_list(cprox_robot_along(c.motion, NULL, 0), &bare, 1, &options, ws, &r, NULL),
                   CPROX_INVALID);
  cprox_obstacles_free(obstacles);
  cprox_motion_free(c.motion);
  cprox_robot_free(c.robot);
  cprox_body_free(small_lod);
  cprox_body_free(lod);
  cprox_body_free(hull);
  cprox_body_free(of_small);
  cprox_body_free(solid);
  cprox_body_free(surface);
  mesh_free(&large);
  mesh_free(&small);
}

/* Of two standing meshes all connected parts are looked at: the second one alone is inside. */
CASE(every_part_of_a_standing_mesh_counts) {
  test_mesh large = mesh_box(vec(1, 1, 1)), parts = mesh_box(vec(0.1, 0.1, 0.1)), second = mesh_box(vec(0.2, 0.1, 0.1));
  append(&parts, &second, vec(5, 0, 0));
  cprox_body *solid = mesh_body(&large, CPROX_MESH_FILL_SOLID, ws),
             *surface = mesh_body(&parts, CPROX_MESH_FILL_SURFACE, ws);
  const double x[3] = {0.0, -5.0, 8.0};
  for (int k = 0; k < 3; k++) {
    cprox_pose at = CPROX_POSE_IDENTITY;
    at.position.x = x[k];
    const cprox_obstacle a = cprox_obstacle_at(solid, CPROX_POSE_IDENTITY), b = cprox_obstacle_at(surface, at);
    cprox_result r;
    for (int swapped = 0; swapped < 2; swapped++)
      assert_int_equal(cprox_pair(swapped ? b : a, swapped ? a : b, NULL, ws, &r), k < 2 ? CPROX_OVERLAP : CPROX_OK);
  }
  cprox_body_free(solid);
  cprox_body_free(surface);
  mesh_free(&large);
  mesh_free(&parts);
}

int main(void) {
  return cases_run(workspace_setup, workspace_teardown);
}
