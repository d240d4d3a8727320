/* SPDX-License-Identifier: BSD-3-Clause */
/* Certified edges: lanes against kinematics in long double, their motion bound against dense samples, verdicts against
 * dense samples and against the search. */
#include <math.h>
#include <string.h>

#define EDGE_TARGET
#define EDGE_KERNEL edge_kernel_of_the_test
#include "edges/kernel.h"

#include "curve_proximity/cprox.h"
#include "support/builders.h"
#include "support/cases.h"
#include "support/counting.h"
#include "support/robots.h"

enum { MOST_BALLS = 3 * TEST_MAX_LINKS, MOST_OBSTACLES = 6, MOST_SAMPLES = 2048 };

/* ---- random robots of balls ---- */

typedef struct ball_robot {
  test_robot t; /* its links */
  cprox_link_geometry geometries[MOST_BALLS];
  double radius[MOST_BALLS], half[MOST_BALLS]; /* half > 0: a capsule */
  size_t n;
  cprox_robot *robot;
} ball_robot;

static ref_pose pose_of(const cprox_pose *pose) {
  const cprox_quat q = pose->orientation;
  ref_pose out = {.p = ref_vec(pose->position), .q = {q.x, q.y, q.z, q.w}};
  long double norm = 0.0L;
  for (int k = 0; k < 4; k++) norm += out.q[k] * out.q[k];
  for (int k = 0; k < 4; k++) out.q[k] /= sqrtl(norm);
  return out;
}

/* All joints but floating ones, which lanes do not take; lengths by `scale`. */
static void make_balls(rng *r, double scale, bool capsules, ball_robot *b) {
  robot_make(r, 0.5, &b->t);
  test_robot *t = &b->t;
  b->n = 0;
  for (size_t i = 0; i < t->n_links; i++) {
    cprox_link *l = &t->links[i];
    if (l->type == CPROX_JOINT_FLOATING) l->type = CPROX_JOINT_FIXED;
    l->origin.position = vec_scale(scale, l->origin.position);
    if (rng_index(r, 3) == 0) l->axis = vec(0, 0, rng_index(r, 2) ? 1 : -1);
    if (rng_index(r, 3) == 0) l->origin.orientation = (cprox_quat){.w = 1, .x = rng_index(r, 2) ? 1 : 0};
    for (size_t k = 1 + rng_index(r, 3); k-- > 0; b->n++) {
      cprox_body *body = NULL;
      b->radius[b->n] = scale * rng_uniform(r, 0.02, 0.1);
      b->half[b->n] = capsules && rng_index(r, 2) ? scale * rng_uniform(r, 0.01, 0.15) : 0.0;
      if (b->half[b->n] > 0.0)
        assert_int_equal(cprox_body_create_capsule(2.0 * b->half[b->n], b->radius[b->n], ws, &body), CPROX_OK);
      else
        assert_int_equal(cprox_body_create_sphere(b->radius[b->n], ws, &body), CPROX_OK);
      b->geometries[b->n] = (cprox_link_geometry){.body = body, .pose = rng_pose(r, 0.2 * scale), .link = (int32_t)i};
    }
  }
  assert_int_equal(cprox_robot_create(t->links, t->n_links, b->geometries, b->n, t->n_variables, ws, &b->robot),
                   CPROX_OK);
}

static void free_balls(ball_robot *b) {
  cprox_robot_free(b->robot);
  for (size_t i = 0; i < b->n; i++) cprox_body_free((cprox_body *)b->geometries[i].body);
  robot_free(&b->t);
}

static bool shifts(const ball_robot *b, size_t variable) {
  for (size_t i = 0; i < b->t.n_links; i++) {
    const cprox_link *l = &b->t.links[i];
    const size_t first = (size_t)l->variable;
    if (l->type == CPROX_JOINT_PRISMATIC && first == variable) return true;
    if (l->type == CPROX_JOINT_PLANAR && variable >= first && variable < first + 2) return true;
  }
  return false;
}

static void draw_edge(rng *r, const ball_robot *b, double scale, double *from, double *to) {
  const double turn = rng_log_uniform(r, 1e-3, 3.0);
  for (size_t k = 0; k < b->t.n_variables; k++) {
    const double size = shifts(b, k) ? scale : 1.0;
    from[k] = size * rng_uniform(r, -2.0, 2.0);
    to[k] = from[k] + size * rng_uniform(r, -turn, turn);
    if (rng_index(r, 5) == 0) to[k] = from[k];
  }
}

static void links_at(const ball_robot *b, const double *from, const double *to, long double t, ref_pose *links) {
  long double values[TEST_MAX_VARIABLES + 1] = {0};
  for (size_t k = 0; k < b->t.n_variables; k++)
    values[k] = (long double)from[k] + t * ((long double)to[k] - (long double)from[k]);
  robot_ref_links(&b->t, values, links);
}

/* A part of one polynomial, or with degree 0 a straight edge. */
typedef struct edge_path {
  size_t degree;
  double from[TEST_MAX_VARIABLES + 1], to[TEST_MAX_VARIABLES + 1];
  double control[MOTION_MAX_DEGREE + 1][TEST_MAX_VARIABLES + 1];
  motion_interval over;
  cprox_motion *motion;
} edge_path;

static void draw_path(rng *r, const ball_robot *b, double scale, bool straight, edge_path *p) {
  draw_edge(r, b, scale, p->from, p->to);
  p->degree = straight ? 0 : 1 + rng_index(r, MOTION_MAX_DEGREE), p->motion = NULL;
  if (straight || b->t.n_variables == 0) {
    p->degree = 0;
    return;
  }
  const size_t n = b->t.n_variables, d = p->degree;
  double control[(MOTION_MAX_DEGREE + 1) * (TEST_MAX_VARIABLES + 1)], knots[2 * (MOTION_MAX_DEGREE + 1)];
  int32_t variables[TEST_MAX_VARIABLES + 1];
  for (size_t k = 0; k < n; k++) variables[k] = (int32_t)k;
  for (size_t i = 0; i <= d; i++)
    for (size_t k = 0; k < n; k++)
      p->control[i][k] = control[i * n + k] = p->from[k] + rng_uniform(r, -1, 1) * (p->to[k] - p->from[k]);
  for (size_t i = 0; i < 2 * (d + 1); i++) knots[i] = i <= d ? 0.0 : 1.0;
  const cprox_motion_description spline = {.kind = CPROX_MOTION_BSPLINE,
                                           .variables = variables,
                                           .n_variables = n,
                                           .control = control,
                                           .n_control = d + 1,
                                           .degree = d,
                                           .knots = knots,
                                           .n_knots = 2 * (d + 1)};
  if (cprox_motion_create(b->robot, &spline, ws, &p->motion) != CPROX_OK) fail_msg("%s", cprox_workspace_error(ws));
  const bool whole = rng_index(r, 2);
  p->over = (motion_interval){
      .a = whole ? 0.0 : rng_uniform(r, 0, 0.5), .b = whole ? 1.0 : rng_uniform(r, 0.5, 1), .last = 1};
}

/* By de Casteljau's scheme. */
static void path_links(const ball_robot *b, const edge_path *p, long double t, ref_pose *links) {
  if (p->degree == 0) {
    links_at(b, p->from, p->to, t, links);
    return;
  }
  const long double u = (long double)p->over.a + t * ((long double)p->over.b - (long double)p->over.a);
  long double values[TEST_MAX_VARIABLES + 1] = {0};
  for (size_t k = 0; k < b->t.n_variables; k++) {
    long double c[MOTION_MAX_DEGREE + 1];
    for (size_t i = 0; i <= p->degree; i++) c[i] = (long double)p->control[i][k];
    for (size_t n = p->degree; n > 0; n--)
      for (size_t i = 0; i < n; i++) c[i] += u * (c[i + 1] - c[i]);
    values[k] = c[0];
  }
  robot_ref_links(&b->t, values, links);
}

/* A point of a geometry's line: -1 … 1 along a capsule, else the centre. */
static vec3l centre_of(const ball_robot *b, const ref_pose *links, size_t i, double along) {
  const ref_pose at = pose_of(&b->geometries[i].pose);
  const vec3l own = {0, 0, (long double)(along * b->half[i])};
  return ref_pose_apply(&links[b->geometries[i].link], ref_pose_apply(&at, own));
}

/* ---- lanes ---- */

typedef struct lane_memory {
  _Alignas(64) char lanes[1 << 16];
  _Alignas(64) char motion[1 << 14];
} lane_memory;

static cprox_edge_checker *checker_of(const cprox_robot *robot, const cprox_edge_query *q) {
  cprox_edge_checker *c = NULL;
  if (cprox_edge_checker_create(robot, q, ws, &c) != CPROX_OK) fail_msg("%s", cprox_workspace_error(ws));
  return c;
}

static vec3l lane_of(lane3 v, int i) {
  return (vec3l){v.x[i], v.y[i], v.z[i]};
}

/* 1,500 robots and edges, every other one a polynomial of degree 1 to 9 (seed 401, sizes of 1e-3 to 1e3 m), eight random
 * intervals each: every ball's centre is where long double has it, within what the edge allows for rounding, and from
 * there it stays within the motion bound, seen from the base and from the frames of other balls. */
CASE(lanes_are_where_they_say_and_stay_where_they_say) {
  static lane_memory memory;
  rng r = rng_seed(401);
  long double worst = 0.0L, fullest = 0.0L, fullest_pair = 0.0L;
  size_t refused = 0, lanes = 0;
  for (size_t i = 0; i < test_cases(1500); i++) {
    const double scale = rng_log_uniform(&r, 1e-3, 1e3);
    ball_robot b;
    make_balls(&r, scale, false, &b);
    cprox_body *box = NULL;
    assert_int_equal(cprox_body_create_box(vec(scale, scale, scale), ws, &box), CPROX_OK);
    const cprox_obstacle target = cprox_obstacle_at(box, CPROX_POSE_IDENTITY);
    cprox_obstacles *set = NULL;
    assert_int_equal(cprox_obstacles_create(&target, 1, CPROX_INDEX_NONE, ws, &set), CPROX_OK);
    cprox_robot_pair pairs[MOST_BALLS], selves[MOST_BALLS * MOST_BALLS];
    size_t n_selves = 0;
    for (size_t k = 0; k < b.n; k++) pairs[k] = (cprox_robot_pair){(int32_t)k, 0};
    for (size_t k = 0; k < b.n; k++)
      for (size_t l = 0; l < k; l++) selves[n_selves++] = (cprox_robot_pair){(int32_t)k, (int32_t)l};
    const cprox_edge_query q = {
        .obstacles = set, .pairs = pairs, .n_pairs = b.n, .self_pairs = selves, .n_self_pairs = n_selves};
    cprox_edge_checker *c = checker_of(b.robot, &q);
    assert_true(c->in_lanes && c->n_parts == b.n && c->n_lane_pairs == n_selves);
    assert_true(edge_lanes_size(c, c->n_near) <= sizeof memory.lanes && edge_motion_size(c) <= sizeof memory.motion);

    edge_path path;
    draw_path(&r, &b, scale, i % 2, &path);
    edge_motion motion = edge_motion_in(c, memory.motion);
    const bool fits = path.degree == 0 /* a mimic joint may turn by what others shift */
                          ? edge_motion_fill(c, path.from, path.to, &motion)
                          : edge_motion_fill_along(c, path.motion, &path.over, &motion);
    if (fits) edge_motion_relate(c, &motion);
    edge_found found = {0};
    edge_open open = {0};
    lane_batch batch = {.c = c, .motion = &motion, .found = &found, .open = &open, .all = 0};
    batch.frames = (lane_frame *)(void *)memory.lanes;
    batch.parts = (lane_part *)(void *)(batch.frames + c->n_frames);
    memset(&batch.frames[0], 0, sizeof batch.frames[0]);
    for (int k = 0; k < 9; k += 4) batch.frames[0].r[k] = lane_all(1.0f);
    for (int l = 0; l < EDGE_LANES; l++) {
      const int depth = (int)rng_index(&r, 12);
      const double half = 0.0625 / (double)(1 << depth);
      batch.half[l] = (float)half;
      batch.middle[l] = (float)(-0.5 + half * (2.0 * (double)rng_index(&r, (size_t)8 << depth) + 1.0));
    }
    batch.half2 = batch.half * batch.half;
    for (size_t k = 1; k < c->n_frames && fits; k++) place_frame(&batch, k), move_frame(&batch, k);

    const vec3 base = c->robot->n_axes > 0 ? c->robot->axes[0].at.p : vec(0, 0, 0);
    refused += !fits;
    for (int l = 0; l < EDGE_LANES && fits; l++) {
      const long double middle = 0.5L + (long double)batch.middle[l], half = (long double)batch.half[l];
      const long double t = middle + half * (long double)(rng_index(&r, 3)   ? rng_uniform(&r, -1, 1)
                                                          : rng_index(&r, 2) ? 1
                                                                             : -1);
      ref_pose here[TEST_MAX_LINKS], there[TEST_MAX_LINKS];
      path_links(&b, &path, middle, here);
      path_links(&b, &path, t, there);
      for (size_t p = 0; p < c->n_parts; p++) {
        const edge_part *part = &c->parts[p];
        const size_t g = (size_t)c->members[part->first_member];
        lane3 speed;
        const edge_ball *ball = &c->balls[part->first];
        const lane_frame *own = &batch.frames[part->frame];
        const vec3l at = lane_of(place_point(own, lane_turn(own, ball->centre), &speed), l);
        batch.parts[p].centre = place_point(own, lane_turn(own, part->centre), &batch.parts[p].speed);
        const vec3l exact = ref_sub(centre_of(&b, here, g, 0), ref_vec(base));
        const long double room = (long double)motion.room[p];
        const long double off = ref_norm(ref_sub(exact, at)) / room;
        worst = off > worst ? off : worst, lanes++;
        if (!(off <= 1.0L)) fail_msg("robot %zu: a ball is off by %Lg of its room", i, off);

        const lane moves = moves_of(&batch, speed, motion.frames[part->frame], ball->reach);
        const long double moved = ref_norm(ref_sub(centre_of(&b, there, g, 0), centre_of(&b, here, g, 0)));
        if (!(moved <= (long double)moves[l] + room))
          fail_msg("robot %zu: a ball moves %Lg, not %g", i, moved, (double)moves[l]);
        const long double full = moved / ((long double)moves[l] + room);
        fullest = full > fullest ? full : fullest;
      }
      for (size_t p = 0; p < c->n_lane_pairs; p++) {
        const edge_pair *pair = &c->lane_pairs[p];
        const edge_part *first = &c->parts[pair->a], *second = &c->parts[pair->b];
        const size_t a = (size_t)c->members[first->first_member], z = (size_t)c->members[second->first_member];
        const lane3 speed =
            relative_speed(&batch.frames[second->frame], batch.parts[pair->a].centre, batch.parts[pair->a].speed);
        const lane moves = moves_of(&batch, speed, motion.relations[pair->relation], (float)first->reach_of_centre);
        const int32_t link = b.geometries[z].link;
        const vec3l seen = ref_pose_undo(&here[link], centre_of(&b, here, a, 0)),
                    later = ref_pose_undo(&there[link], centre_of(&b, there, a, 0));
        const long double moved = ref_norm(ref_sub(later, seen));
        const long double room = (long double)motion.room[pair->a] + (long double)motion.room[pair->b];
        if (!(moved <= (long double)moves[l] + room))
          fail_msg("robot %zu: a ball moves %Lg as another sees it, not %g", i, moved, (double)moves[l]);
        const long double full = moved / ((long double)moves[l] + room);
        fullest_pair = full > fullest_pair ? full : fullest_pair;
      }
    }
    cprox_motion_free(path.motion);
    cprox_edge_checker_free(c);
    cprox_obstacles_free(set);
    cprox_body_free(box);
    free_balls(&b);
  }
  print_message("%zu lanes, off by %.3Lg of what rounding may cost at most\n", lanes, worst);
  /* the bounds are not idle */
  assert_true(refused * 10 < test_cases(1500));
  if (test_cases(1500) >= 1000) assert_true(worst > 0.01L && fullest > 0.99L && fullest_pair > 0.99L);
}

/* Chains whose velocities cancel in the middle, so that accelerations alone move the ball: a shift along an axis that
 * turns (2 W g), and a turn about an axis that a shift is away from (W^2 of the shift). Half of what they reach, or a
 * term less, would be too little, seen from the base and from a ball there. */
CASE(accelerations_alone_are_bounded) {
  static lane_memory memory;
  enum { CASES = 2 };
  static const double RATE[CASES][3] = {{-1.0, 0.1, 1.0}, {-1.0, 1.0, 0.0}}, MIDDLE[CASES] = {0.0, 1.0};
  for (int i = 0; i < CASES; i++) {
    const vec3 first = i == 0 ? vec(1, 0, 0) : vec(0, 1, 0);
    const cprox_link links[4] = {
        {.parent = -1, .type = CPROX_JOINT_FIXED, .origin = CPROX_POSE_IDENTITY, .axis = {0, 0, 1}, .multiplier = 1.0},
        {.parent = 0, .type = CPROX_JOINT_PRISMATIC, .origin = CPROX_POSE_IDENTITY, .axis = first, .multiplier = 1.0},
        {.parent = 1,
         .type = CPROX_JOINT_REVOLUTE,
         .origin = CPROX_POSE_IDENTITY,
         .axis = {0, 0, 1},
         .variable = 1,
         .multiplier = 1.0},
        {.parent = 2,
         .type = CPROX_JOINT_PRISMATIC,
         .origin = CPROX_POSE_IDENTITY,
         .axis = {1, 0, 0},
         .variable = 2,
         .multiplier = 1.0}};
    cprox_body *ball = NULL;
    assert_int_equal(cprox_body_create_sphere(0.01, ws, &ball), CPROX_OK);
    const cprox_link_geometry geometries[2] = {{.body = ball, .pose = CPROX_POSE_IDENTITY, .link = 3},
                                               {.body = ball, .pose = CPROX_POSE_IDENTITY, .link = 0}};
    cprox_robot *robot = NULL;
    assert_int_equal(cprox_robot_create(links, 4, geometries, 2, 3, ws, &robot), CPROX_OK);
    const cprox_robot_pair pair = {0, 1};
    cprox_edge_checker *c = checker_of(robot, &(cprox_edge_query){.self_pairs = &pair, .n_self_pairs = 1});
    double from[3], to[3];
    for (int k = 0; k < 3; k++) {
      const double middle = k == 2 ? MIDDLE[i] : 0.0;
      from[k] = middle - 0.5 * RATE[i][k], to[k] = middle + 0.5 * RATE[i][k];
    }
    edge_motion motion = edge_motion_in(c, memory.motion);
    assert_true(edge_motion_fill(c, from, to, &motion));
    edge_motion_relate(c, &motion);
    const double half = 0.0625, angle = RATE[i][1] * half, along = MIDDLE[i] + RATE[i][2] * half;
    const double x = along * cos(angle) + (i == 0 ? RATE[i][0] * half : 0.0) - MIDDLE[i];
    const double y = along * sin(angle) + (i == 0 ? 0.0 : RATE[i][0] * half);
    const double moved = sqrt(x * x + y * y);
    const edge_half_bound seen[2] = {motion.frames[c->parts[c->lane_pairs[0].a].frame], motion.relations[0]};
    for (int k = 0; k < 2; k++)
      assert_true(moved <= half * half * (double)seen[k].acceleration + 2.0 * (double)motion.room[0]);
    if (!(moved > 50.0 * (double)motion.room[0]))
      fail_msg("%d: %g is no more than %g", i, moved, (double)motion.room[0]);
    cprox_edge_checker_free(c);
    cprox_robot_free(robot);
    cprox_body_free(ball);
  }
}

/* Sine and cosine of lanes at 4 million angles up to 40, against long double: within 4 u. */
CASE(lanes_know_sine_and_cosine) {
  rng r = rng_seed(402);
  for (size_t i = 0; i < test_cases(500000); i++) {
    lane x, s, c;
    for (int l = 0; l < EDGE_LANES; l++)
      x[l] = (float)(rng_index(&r, 4) ? rng_uniform(&r, -40, 40) : rng_log_uniform(&r, 1e-9, 1));
    lane_sincos(x, &s, &c);
    for (int l = 0; l < EDGE_LANES; l++) {
      assert_true(fabsl(sinl((long double)x[l]) - (long double)s[l]) <= 4.0L * (long double)EDGE_U);
      assert_true(fabsl(cosl((long double)x[l]) - (long double)c[l]) <= 4.0L * (long double)EDGE_U);
    }
  }
}

/* ---- obstacles ---- */

static cprox_body *random_body(rng *r, double s, size_t kind) {
  cprox_body *body = NULL;
  vec3 v[8];
  switch (kind) {
    case 0: cprox_body_create_sphere(s * rng_uniform(r, 0.05, 0.3), ws, &body); break;
    case 1:
      cprox_body_create_box(
          vec(s * rng_uniform(r, 0.01, 0.5), s * rng_uniform(r, 0.01, 0.5), s * rng_uniform(r, 0.01, 0.5)), ws, &body);
      break;
    case 2: cprox_body_create_capsule(s * rng_uniform(r, 0.1, 0.6), s * rng_uniform(r, 0.005, 0.1), ws, &body); break;
    case 3: cprox_body_create_cylinder(s * rng_uniform(r, 0.005, 0.6), s * rng_uniform(r, 0.01, 0.2), ws, &body); break;
    case 4: cprox_body_create_cone(s * rng_uniform(r, 0.05, 0.6), s * rng_uniform(r, 0.02, 0.2), ws, &body); break;
    case 5: cprox_body_create_halfspace(rng_unit(r), s * rng_uniform(r, -1.5, -0.7), ws, &body); break;
    case 6:
      cprox_body_create_ellipsoid(
          vec(s * rng_uniform(r, 0.05, 0.3), s * rng_uniform(r, 0.05, 0.3), s * rng_uniform(r, 0.05, 0.3)), ws, &body);
      break;
    default:
      for (int k = 0; k < 8; k++) v[k] = rng_in_cube(r, 0.2 * s);
      cprox_body_create_polytope(v, 8, ws, &body);
  }
  assert_non_null(body);
  return body;
}

enum { BODY_KINDS = 8 };

/* Distances of lanes from what stands, 1,000 obstacles of every kind (seed 403): never larger than those in double by
 * more than the room of a point that is exact, never smaller by more than what the obstacle was grown by. Tolerance:
 * 13 u of the vector to it, as doc/rounding.md counts it. */
CASE(lanes_know_how_far_obstacles_are) {
  rng r = rng_seed(403);
  test_robot t = {.n_links = 1, .n_variables = 1};
  t.links[0] = (cprox_link){
      .parent = -1, .type = CPROX_JOINT_PRISMATIC, .origin = CPROX_POSE_IDENTITY, .axis = {0, 0, 1}, .multiplier = 1.0};
  cprox_body *ball = NULL;
  assert_int_equal(cprox_body_create_sphere(0.1, ws, &ball), CPROX_OK);
  const cprox_link_geometry g = {.body = ball, .pose = CPROX_POSE_IDENTITY};
  cprox_robot *robot = NULL;
  assert_int_equal(cprox_robot_create(t.links, 1, &g, 1, 1, ws, &robot), CPROX_OK);
  for (size_t i = 0; i < test_cases(1000 * BODY_KINDS); i++) {
    const double scale = rng_log_uniform(&r, 1e-3, 1e3);
    cprox_body *body = random_body(&r, scale, i % BODY_KINDS);
    cprox_obstacle target = cprox_obstacle_at(body, rng_pose(&r, scale));
    if (rng_index(&r, 3) == 0) target.pose.orientation = (cprox_quat){.w = 1};
    if (rng_index(&r, 4) == 0) target.pose.orientation = (cprox_quat){.w = 1, .y = -1};
    if (rng_index(&r, 3) == 0) target.margin = scale * rng_uniform(&r, 0, 0.1);
    cprox_obstacles *set = NULL;
    assert_int_equal(cprox_obstacles_create(&target, 1, CPROX_INDEX_NONE, ws, &set), CPROX_OK);
    cprox_edge_checker *c = checker_of(robot, &(cprox_edge_query){.obstacles = set});
    lane3 x;
    for (int l = 0; l < EDGE_LANES; l++) {
      const vec3 p = rng_in_cube(&r, scale * rng_log_uniform(&r, 0.1, 3));
      x.x[l] = (float)p.x, x.y[l] = (float)p.y, x.z[l] = (float)p.z;
    }
    const lane distance2 = distance2_from(&c->obstacles[0], x);
    const frame f = frame_create(&target.pose, body->centre);
    for (int l = 0; l < EDGE_LANES; l++) {
      double error = 0.0;
      const vec3 p = vec((double)x.x[l], (double)x.y[l], (double)x.z[l]);
      convex_near near;
      convex_hint hint = {0};
      body->shape.ops->nearest(&body->shape, frame_to_local(&f, p, &error), &hint, &near);
      const double exact = fmax(near.distance - target.margin, 0.0), lanes = sqrt((double)distance2[l]);
      const double room = 13.0 * EDGE_U * vec_norm(p) + EDGE_GROW * exact + 1e-12 * scale;
      if (!(lanes <= exact + room)) fail_msg("kind %zu: %.9g is more than %.9g", i % BODY_KINDS, lanes, exact);
      if (isfinite((double)c->obstacles[0].grown) && !(lanes >= exact - room - (double)c->obstacles[0].grown))
        fail_msg("kind %zu: %.9g is less than %.9g", i % BODY_KINDS, lanes, exact);
    }
    cprox_edge_checker_free(c);
    cprox_obstacles_free(set);
    cprox_body_free(body);
  }
  cprox_robot_free(robot);
  cprox_body_free(ball);
}

/* ---- verdicts ---- */

typedef struct world {
  ball_robot b;
  cprox_obstacle targets[MOST_OBSTACLES];
  size_t n;
  cprox_obstacles *set;
  cprox_robot_pair pairs[MOST_BALLS * MOST_OBSTACLES], selves[MOST_BALLS * MOST_BALLS];
  size_t n_pairs, n_selves;
} world;

/* Wires, pins and plates: up to ten thousand times as long as thick. */
static cprox_body *thin_body(rng *r, double s) {
  const double thick = s * rng_log_uniform(r, 5e-5, 1e-3), length = s * rng_uniform(r, 0.1, 1.0);
  cprox_body *body = NULL;
  switch (rng_index(r, 4)) {
    case 0: cprox_body_create_capsule(length, thick, ws, &body); break;
    case 1: cprox_body_create_cylinder(length, thick, ws, &body); break;
    case 2: cprox_body_create_box(vec(length, s * rng_uniform(r, 0.1, 1.0), thick), ws, &body); break;
    default: cprox_body_create_box(vec(length, thick, thick), ws, &body);
  }
  assert_non_null(body);
  return body;
}

static void make_world_of(rng *r, double scale, bool capsules, bool thin, world *w) {
  make_balls(r, scale, capsules, &w->b);
  w->n = 1 + rng_index(r, MOST_OBSTACLES);
  for (size_t i = 0; i < w->n; i++) {
    cprox_body *body = thin ? thin_body(r, scale) : random_body(r, scale, rng_index(r, BODY_KINDS));
    w->targets[i] = cprox_obstacle_at(body, rng_pose(r, 1.2 * scale));
    if (!thin && rng_index(r, 4) == 0) w->targets[i].margin = scale * rng_uniform(r, 0, 0.05);
  }
  assert_int_equal(cprox_obstacles_create(w->targets, w->n, CPROX_INDEX_NONE, ws, &w->set), CPROX_OK);
  w->n_pairs = w->n_selves = 0;
  for (size_t g = 0; g < w->b.n; g++) {
    for (size_t k = 0; k < w->n; k++) w->pairs[w->n_pairs++] = (cprox_robot_pair){(int32_t)g, (int32_t)k};
    for (size_t k = 0; k < g; k++) {
      const int32_t a = w->b.geometries[g].link, z = w->b.geometries[k].link;
      const int32_t up = w->b.t.links[a].parent, down = w->b.t.links[z].parent;
      if (a != z && up != z && down != a) w->selves[w->n_selves++] = (cprox_robot_pair){(int32_t)g, (int32_t)k};
    }
  }
}

static void make_world(rng *r, double scale, bool capsules, world *w) {
  make_world_of(r, scale, capsules, false, w);
}

static void free_world(world *w) {
  cprox_obstacles_free(w->set);
  for (size_t i = 0; i < w->n; i++) cprox_body_free((cprox_body *)w->targets[i].body);
  free_balls(&w->b);
}

/* The least distance of the pairs at one time, capsules by points of their lines. */
static double distance_at(const world *w, const double *from, const double *to, double t, bool self) {
  ref_pose links[TEST_MAX_LINKS];
  links_at(&w->b, from, to, (long double)t, links);
  double least = INFINITY;
  enum { ALONG = 9 };
  for (size_t i = 0; i < w->n_pairs; i++) {
    const size_t g = (size_t)w->pairs[i].geometry;
    const cprox_obstacle *o = &w->targets[w->pairs[i].other];
    const frame f = frame_create(&o->pose, o->body->centre);
    const int points = w->b.half[g] > 0.0 ? ALONG : 1;
    for (int k = 0; k < points; k++) {
      const vec3l p = centre_of(&w->b, links, g, points > 1 ? 2.0 * k / (ALONG - 1) - 1.0 : 0.0);
      double error = 0.0;
      convex_near near;
      convex_hint hint = {0};
      o->body->shape.ops->nearest(&o->body->shape,
                                  frame_to_local(&f, vec((double)p.x, (double)p.y, (double)p.z), &error), &hint, &near);
      least = fmin(least, near.distance - o->margin - w->b.radius[g]);
    }
  }
  for (size_t i = 0; i < w->n_selves && self; i++) {
    const size_t a = (size_t)w->selves[i].geometry, z = (size_t)w->selves[i].other;
    for (int k = 0; k < (w->b.half[a] > 0.0 ? ALONG : 1); k++)
      for (int l = 0; l < (w->b.half[z] > 0.0 ? ALONG : 1); l++) {
        const vec3l p = centre_of(&w->b, links, a, w->b.half[a] > 0.0 ? 2.0 * k / (ALONG - 1) - 1.0 : 0.0),
                    s = centre_of(&w->b, links, z, w->b.half[z] > 0.0 ? 2.0 * l / (ALONG - 1) - 1.0 : 0.0);
        least = fmin(least, (double)ref_norm(ref_sub(p, s)) - w->b.radius[a] - w->b.radius[z]);
      }
  }
  return least;
}

/* The least distance that samples find, refined round the least of them. */
static double sampled(const world *w, const double *from, const double *to, size_t samples, bool self, double *at) {
  double least = INFINITY;
  for (size_t k = 0; k <= samples; k++) {
    const double t = (double)k / (double)samples, d = distance_at(w, from, to, t, self);
    if (d < least) least = d, *at = t;
  }
  for (double step = 0.5 / (double)samples; step > 1e-7; step *= 0.5)
    for (int side = -1; side <= 1; side += 2) {
      const double t = fmin(fmax(*at + side * step, 0.0), 1.0), d = distance_at(w, from, to, t, self);
      if (d < least) least = d, *at = t;
    }
  return least;
}

/* What is clear must be; what is violated must be so where it says. Tolerance: 1e-9 of the scene's size, for poses and
 * distances in double on either side. */
static void check(const world *w, const cprox_edge_query *q, const cprox_edge_result *r, uint8_t verdict,
                  const double *from, const double *to, double scale, bool self, double least) {
  assert_int_equal(r->verdict, verdict);
  if (verdict == CPROX_VERDICT_CLEAR && !(least >= q->delta - 1e-9 * scale))
    fail_msg("clear, but %.9g at delta %.9g (level %d, scale %g, self %d)", least, q->delta, (int)r->level, scale,
             self);
  if (verdict != CPROX_VERDICT_VIOLATED) return;
  assert_true(r->t >= 0.0 && r->t <= 1.0 && r->geometry >= 0 && r->other >= 0);
  const bool other_is_line = r->other >= (int32_t)w->n && w->b.half[r->other - (int32_t)w->n] > 0.0;
  if (w->b.half[r->geometry] > 0.0 || other_is_line) return; /* samples of lines are not the nearest points */
  const double there = distance_at(w, from, to, r->t, self);
  if (!(there <= q->delta + 1e-9 * scale))
    fail_msg("violated, but %.9g at t = %.9g, delta %.9g (level %d)", there, r->t, q->delta, (int)r->level);
}

static cprox_edge_query ask_of(const world *w, bool self, double delta) {
  return (cprox_edge_query){.obstacles = w->set,
                            .pairs = w->pairs,
                            .n_pairs = w->n_pairs,
                            .self_pairs = w->selves,
                            .n_self_pairs = w->n_selves,
                            .without_self = !self,
                            .delta = delta};
}

enum { EDGES = 8 };

/* So many worlds, 8 edges each: no verdict is wrong, by 64 samples refined. */
static void try_edges(uint64_t seed, size_t worlds, bool thin, size_t counts[3], size_t levels[CPROX_EDGE_SEARCH + 1]) {
  rng r = rng_seed(seed);
  for (size_t i = 0; i < worlds; i++) {
    const double scale = rng_log_uniform(&r, 1e-2, 1e2);
    const bool self = rng_index(&r, 2);
    world w;
    make_world_of(&r, scale, i % 2, thin, &w);
    const cprox_edge_query q = ask_of(&w, self, rng_index(&r, 2) ? 0.0 : scale * rng_uniform(&r, 0, 0.1));
    cprox_edge_checker *c = checker_of(w.b.robot, &q);
    double from[EDGES * TEST_MAX_VARIABLES + 1], to[EDGES * TEST_MAX_VARIABLES + 1];
    const size_t n = w.b.t.n_variables;
    for (size_t k = 0; k < EDGES; k++) draw_edge(&r, &w.b, scale, from + k * n, to + k * n);
    uint8_t verdicts[EDGES];
    cprox_edge_result results[EDGES];
    assert_true(cprox_robot_edges(c, from, to, EDGES, ws, verdicts, results) >= 0);
    for (size_t k = 0; k < EDGES; k++) {
      double at = 0.0;
      const double least = sampled(&w, from + k * n, to + k * n, 64, self, &at);
      check(&w, &q, &results[k], verdicts[k], from + k * n, to + k * n, scale, self, least);
      if (least < q.delta - 1e-3 * scale) assert_int_not_equal(verdicts[k], CPROX_VERDICT_CLEAR);
      counts[verdicts[k]]++, levels[results[k].level]++;
    }
    cprox_edge_checker_free(c);
    free_world(&w);
  }
  print_message("%zu %sedges, none wrong\n", EDGES * worlds, thin ? "thin " : "");
}

/* 120 worlds (seed 404), every kind of obstacle, balls and capsules. */
CASE(edge_verdicts_are_never_wrong) {
  size_t counts[3] = {0}, levels[CPROX_EDGE_SEARCH + 1] = {0};
  try_edges(404, test_cases(120), false, counts, levels);
  if (test_cases(120) < 60) return; /* what follows is about many */
  assert_true(counts[0] > EDGES * test_cases(120) / 10 && counts[1] > EDGES * test_cases(120) / 10);
  assert_true(counts[2] * 100 < counts[0] + counts[1]);
  assert_true(levels[CPROX_EDGE_BALL] > 0 && levels[CPROX_EDGE_COVER] > 0);
  assert_true(levels[CPROX_EDGE_MEASUREMENT] + levels[CPROX_EDGE_SEARCH] > 0);
}

/* 120 worlds (seed 412), balls and capsules among wires, pins and plates. */
CASE(wires_pins_and_plates_are_never_missed) {
  size_t counts[3] = {0}, levels[CPROX_EDGE_SEARCH + 1] = {0};
  try_edges(412, test_cases(120), true, counts, levels);
  if (test_cases(120) >= 60) assert_true(20 * counts[0] > EDGES * 120 && 20 * counts[1] > EDGES * 120);
}

/* The delta is drawn beside the least distance that was sampled, by 1e-5 to 1e-2 of the scene's size on either side
 * (1000 worlds, seed 405): the verdict is that side's. */
CASE(grazing_edges_are_decided_rightly) {
  rng r = rng_seed(405);
  size_t decided = 0, asked = 0;
  for (size_t i = 0; i < test_cases(1000); i++) {
    world w;
    make_world(&r, 1.0, false, &w);
    double from[TEST_MAX_VARIABLES + 1], to[TEST_MAX_VARIABLES + 1], at = 0.0;
    draw_edge(&r, &w.b, 1.0, from, to);
    const bool self = rng_index(&r, 2);
    const double least = sampled(&w, from, to, 256, self, &at);
    const double beside = rng_log_uniform(&r, 1e-5, 1e-2) * (rng_index(&r, 2) ? 1.0 : -1.0);
    if (least + beside > 1e-6 && isfinite(least)) {
      const cprox_edge_query q = ask_of(&w, self, least + beside);
      cprox_edge_checker *c = checker_of(w.b.robot, &q);
      uint8_t verdict;
      cprox_edge_result result;
      assert_true(cprox_robot_edges(c, from, to, 1, ws, &verdict, &result) >= 0);
      check(&w, &q, &result, verdict, from, to, 1.0, self, least);
      asked++, decided += verdict == (beside > 0.0 ? CPROX_VERDICT_VIOLATED : CPROX_VERDICT_CLEAR);
      cprox_edge_checker_free(c);
    }
    free_world(&w);
  }
  print_message("%zu grazing edges, none wrong\n", asked);
  if (test_cases(1000) >= 500) assert_true(asked > test_cases(1000) / 4 && decided * 100 >= 97 * asked);
}

/* What the caller's numbers may be off by (125 worlds, seed 411, 8 edges each; CPROX_TEST_SCALE=100 for 10^5 edges). The
 * delta is drawn beside the least distance by up to three times that, or is 0. Clear is farther than both together,
 * violated is nearer than delta without it, and the verdicts are those of two checkers that are asked for the one and
 * for the other. Tolerance beside check()'s: the search is undecided within its epsilon, 1e-6 of 1 m. */
CASE(rounding_of_the_caller_is_on_the_safe_side_of_both_verdicts) {
  rng r = rng_seed(411);
  size_t counts[3] = {0}, levels[CPROX_EDGE_SEARCH + 1] = {0}, differ = 0, asked = 0;
  for (size_t i = 0; i < test_cases(125); i++) {
    world w;
    make_world(&r, 1.0, i % 8 == 0, &w);
    const bool self = rng_index(&r, 2);
    const size_t n = w.b.t.n_variables;
    double from[EDGES * TEST_MAX_VARIABLES + 1], to[EDGES * TEST_MAX_VARIABLES + 1], least[EDGES], at = 0.0;
    for (size_t k = 0; k < EDGES; k++) {
      draw_edge(&r, &w.b, 1.0, from + k * n, to + k * n);
      least[k] = sampled(&w, from + k * n, to + k * n, 64, self, &at);
    }
    cprox_edge_query q = ask_of(&w, self, 0.0), clear = q, hit = q;
    q.rounding = rng_log_uniform(&r, 1e-12, 1e-2);
    const double beside = least[rng_index(&r, EDGES)] + 3.0 * q.rounding * rng_uniform(&r, -1, 1);
    if (isfinite(beside) && rng_index(&r, 4)) q.delta = fmax(beside, 0.0);
    clear.delta = q.delta + q.rounding, hit.delta = fmax(q.delta - q.rounding, 0.0);
    uint8_t verdicts[3][EDGES];
    cprox_edge_result results[EDGES];
    for (int by = 0; by < 3; by++) {
      cprox_edge_checker *c = checker_of(w.b.robot, by == 0 ? &q : by == 1 ? &clear : &hit);
      assert_true(cprox_robot_edges(c, from, to, EDGES, ws, verdicts[by], by == 0 ? results : NULL) >= 0);
      cprox_edge_checker_free(c);
    }
    for (size_t k = 0; k < EDGES; k++) {
      const uint8_t verdict = verdicts[0][k];
      check(&w, verdict == CPROX_VERDICT_CLEAR ? &clear : &hit, &results[k], verdict, from + k * n, to + k * n, 1.0,
            self, least[k]);
      const uint8_t both = verdicts[1][k] == CPROX_VERDICT_CLEAR      ? CPROX_VERDICT_CLEAR
                           : verdicts[2][k] == CPROX_VERDICT_VIOLATED ? CPROX_VERDICT_VIOLATED
                                                                      : CPROX_VERDICT_UNDECIDED;
      asked++, differ += verdict != both;
      if (verdict != both && fmin(fabs(least[k] - clear.delta), fabs(least[k] - hit.delta)) > 3e-6)
        fail_msg("%d, by two checkers %d: least %.9g, delta %.9g, rounding %.9g, level %d", (int)verdict, (int)both,
                 least[k], q.delta, q.rounding, (int)results[k].level);
      counts[verdict]++, levels[results[k].level]++;
    }
    free_world(&w);
  }
  if (asked < 500) return;
  assert_true(counts[0] > asked / 10 && counts[1] > asked / 10 && differ * 1000 <= asked);
  if (asked >= 1000) assert_true(counts[2] > 0 && levels[CPROX_EDGE_MEASUREMENT] > 0 && levels[CPROX_EDGE_SEARCH] > 0);
}

/* The plain kernel and that of the machine give the same results, bit by bit (300 worlds, seed 406). */
CASE(all_instruction_sets_find_the_same) {
  static lane_memory memory;
  rng r = rng_seed(406);
  for (size_t i = 0; i < test_cases(300); i++) {
    world w;
    make_world(&r, 1.0, i % 2, &w);
    const cprox_edge_query q = ask_of(&w, true, 0.0);
    cprox_edge_checker *c = checker_of(w.b.robot, &q);
    double from[TEST_MAX_VARIABLES + 1], to[TEST_MAX_VARIABLES + 1];
    draw_edge(&r, &w.b, 1.0, from, to);
    edge_motion motion = edge_motion_in(c, memory.motion);
    assert_true(edge_motion_fill(c, from, to, &motion));
    edge_found found[2];
    uint32_t pairs[2][1024], seen[1024], n[2];
    for (int k = 0; k < 2; k++) {
      memset(seen, 0, sizeof seen);
      edge_lanes lanes = {.memory = memory.lanes, .open = {.pairs = pairs[k], .seen = seen, .edge = 1}};
      edge_kernel_at(k ? simd_of_machine() : SIMD_BASE)(c, &motion, &lanes, &found[k]);
      n[k] = lanes.open.n;
    }
    assert_int_equal(found[0].verdict, found[1].verdict);
    assert_int_equal(found[0].level, found[1].level);
    assert_int_equal(found[0].intervals, found[1].intervals);
    assert_true(found[0].verdict != CPROX_VERDICT_VIOLATED || found[0].at == found[1].at);
    assert_int_equal(n[0], n[1]);
    assert_memory_equal(pairs[0], pairs[1], n[0] * sizeof pairs[0][0]);
    cprox_edge_checker_free(c);
    free_world(&w);
  }
}

/* ---- input ---- */

CASE(an_edge_that_is_not_finite_is_refused_alone) {
  rng r = rng_seed(407);
  world w;
  make_world(&r, 1.0, false, &w);
  const cprox_edge_query q = ask_of(&w, false, 0.0);
  cprox_edge_checker *c = checker_of(w.b.robot, &q);
  assert_true(c->n_frames > 1);
  const size_t n = w.b.t.n_variables;
  double from[3 * TEST_MAX_VARIABLES] = {0}, to[3 * TEST_MAX_VARIABLES] = {0};
  to[n] = NAN;
  uint8_t verdicts[3];
  cprox_edge_result results[3];
  assert_int_equal(cprox_robot_edges(c, from, to, 3, ws, verdicts, results), CPROX_INVALID);
  assert_non_null(strstr(cprox_workspace_error(ws), "edge 1"));
  assert_int_equal(verdicts[1], CPROX_VERDICT_UNDECIDED);
  assert_int_equal(results[1].status, CPROX_INVALID);
  assert_int_equal(results[1].level, CPROX_EDGE_NONE);
  assert_true(results[0].status >= 0 && results[2].status >= 0);
  assert_int_equal(verdicts[0], verdicts[2]);

  /* beyond single precision: by the search, or refused by it, never by lanes */
  to[n] = 0.0;
  for (size_t k = 0; k < n; k++) to[k] = 1e7;
  assert_true(cprox_robot_edges(c, from, to, 1, ws, verdicts, results) >= 0);
  assert_int_equal(results[0].intervals, 0);
  cprox_edge_checker_free(c);
  free_world(&w);
}

CASE(what_is_asked_of_edges_is_checked) {
  rng r = rng_seed(408);
  world w;
  make_world(&r, 1.0, false, &w);
  cprox_edge_checker *c = NULL;
  cprox_edge_query q = ask_of(&w, true, -1.0);
  assert_int_equal(cprox_edge_checker_create(w.b.robot, &q, ws, &c), CPROX_INVALID);
  q.delta = 0.1, q.first = true;
  assert_int_equal(cprox_edge_checker_create(w.b.robot, &q, ws, &c), CPROX_INVALID);
  static const double BAD[] = {-1e-9, NAN, INFINITY};
  for (size_t i = 0; i < sizeof BAD / sizeof *BAD; i++) {
    q = ask_of(&w, true, 0.1), q.rounding = BAD[i];
    assert_int_equal(cprox_edge_checker_create(w.b.robot, &q, ws, &c), CPROX_INVALID);
    assert_non_null(strstr(cprox_workspace_error(ws), "rounding is"));
  }
  q = ask_of(&w, false, 0.0), q.first = true, q.rounding = 1e-9;
  assert_int_equal(cprox_edge_checker_create(w.b.robot, &q, ws, &c), CPROX_INVALID);
  const cprox_robot_pair none = {0, (int32_t)w.n}, itself = {0, 0};
  q = (cprox_edge_query){.obstacles = w.set, .pairs = &none, .n_pairs = 1};
  assert_int_equal(cprox_edge_checker_create(w.b.robot, &q, ws, &c), CPROX_INVALID);
  q = (cprox_edge_query){.self_pairs = &itself, .n_self_pairs = 1};
  assert_int_equal(cprox_edge_checker_create(w.b.robot, &q, ws, &c), CPROX_INVALID);
  assert_int_equal(cprox_edge_checker_create(NULL, NULL, ws, &c), CPROX_INVALID);
  assert_null(c);
  free_world(&w);
}

/* Of edges that hit something t_free is never late, and t is where contact is proven (200 worlds, seed 409). */
CASE(the_first_contact_is_never_late) {
  rng r = rng_seed(409);
  size_t hits = 0;
  for (size_t i = 0; i < test_cases(200); i++) {
    world w;
    make_world(&r, 1.0, false, &w);
    cprox_edge_query q = ask_of(&w, false, 0.0);
    q.first = true;
    cprox_edge_checker *c = checker_of(w.b.robot, &q);
    double from[TEST_MAX_VARIABLES + 1], to[TEST_MAX_VARIABLES + 1];
    draw_edge(&r, &w.b, 1.0, from, to);
    uint8_t verdict;
    cprox_edge_result result;
    assert_true(cprox_robot_edges(c, from, to, 1, ws, &verdict, &result) >= 0);
    if (verdict == CPROX_VERDICT_CLEAR) assert_true(result.t_free == 1.0);
    for (int k = 0; k <= 256 && verdict == CPROX_VERDICT_VIOLATED; k++)
      if ((double)k / 256.0 < result.t_free) assert_true(distance_at(&w, from, to, (double)k / 256.0, false) >= -1e-9);
    if (verdict == CPROX_VERDICT_VIOLATED) hits++, assert_true(result.t_free <= result.t);
    cprox_edge_checker_free(c);
    free_world(&w);
  }
  if (test_cases(200) >= 100) assert_true(hits > test_cases(200) / 10);
}

/* Edges that lanes decide allocate nothing once the workspace has grown. */
CASE(edges_allocate_nothing) {
  rng r = rng_seed(410);
  world w;
  make_world(&r, 1.0, false, &w);
  const cprox_edge_query q = ask_of(&w, true, 0.0);
  cprox_edge_checker *c = checker_of(w.b.robot, &q);
  double from[TEST_MAX_VARIABLES + 1], to[TEST_MAX_VARIABLES + 1];
  uint8_t verdict;
  cprox_edge_result result;
  size_t by_lanes = 0;
  for (size_t i = 0; i < 100; i++) {
    draw_edge(&r, &w.b, 1.0, from, to);
    const size_t before = allocations_made();
    assert_true(cprox_robot_edges(c, from, to, 1, ws, &verdict, &result) >= 0);
    if (i == 0 || result.level == CPROX_EDGE_SEARCH) continue;
    assert_true(allocations_made() == before);
    by_lanes++;
  }
  assert_true(by_lanes > 50);
  cprox_edge_checker_free(c);
  free_world(&w);
}

int main(void) {
  return cases_run(workspace_setup, workspace_teardown);
}
