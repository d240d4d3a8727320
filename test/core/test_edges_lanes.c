/* SPDX-License-Identifier: BSD-3-Clause */
/* Lanes of edges against kinematics in long double, their motion bound against random moments, their distances against
 * those in double precision, and both kernels against each other. */
#include <math.h>
#include <string.h>

#define EDGE_TARGET
#define EDGE_KERNEL edge_kernel_of_the_test
#include "edges/kernel.h"

#include "curve_proximity/cprox.h"
#include "support/builders.h"
#include "support/cases.h"
#include "support/edge_worlds.h"

/* A part of one polynomial, or with degree 0 a straight edge. */
typedef struct edge_path {
  size_t degree;
  double from[TEST_MAX_VARIABLES + 1], to[TEST_MAX_VARIABLES + 1];
  double control[MOTION_MAX_DEGREE + 1][TEST_MAX_VARIABLES + 1];
  motion_interval over;
  cprox_motion *motion;
} edge_path;

static void draw_path(rng *r, const edge_robot *b, double scale, bool straight, edge_path *p) {
  edge_robot_draw(r, b, scale, p->from, p->to);
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
static void path_links(const edge_robot *b, const edge_path *p, long double t, ref_pose *links) {
  if (p->degree == 0) {
    edge_robot_links(b, p->from, p->to, t, links);
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
} /* ---- lanes ---- */

typedef struct lane_memory {
  _Alignas(64) char lanes[1 << 16];
  _Alignas(64) char motion[1 << 14];
} lane_memory;

static vec3l lane_of(lane3 v, int i) {
  return (vec3l){v.x[i], v.y[i], v.z[i]};
}

/* 1,500 robots and edges, every other one a polynomial of degree 1 to 9 (seed 401, sizes of 1e-3 to 1e3 m), eight
 * random intervals each: rates of joints and lengths of shifts are within their bounds, every ball's centre is where
 * long double has it, within what the edge allows for rounding, and from there it stays within the motion bound, seen
 * from the base and from the frames of other balls. */
CASE(lanes_are_where_they_say_and_stay_where_they_say) {
  static lane_memory memory;
  rng r = rng_seed(401);
  long double worst = 0.0L, fullest = 0.0L, fullest_pair = 0.0L;
  size_t refused = 0, lanes = 0;
  for (size_t i = 0; i < test_cases(1500); i++) {
    const double scale = rng_log_uniform(&r, 1e-3, 1e3);
    edge_robot b;
    edge_robot_make(&r, scale, false, &b);
    cprox_body *box = NULL;
    assert_int_equal(cprox_body_create_box(vec(scale, scale, scale), ws, &box), CPROX_OK);
    const cprox_obstacle target = cprox_obstacle_at(box, CPROX_POSE_IDENTITY);
    cprox_obstacles *set = NULL;
    assert_int_equal(cprox_obstacles_create(&target, 1, CPROX_INDEX_NONE, ws, &set), CPROX_OK);
    cprox_robot_pair pairs[EDGE_WORLD_BALLS], selves[EDGE_WORLD_BALLS * EDGE_WORLD_BALLS];
    size_t n_selves = 0;
    for (size_t k = 0; k < b.n; k++) pairs[k] = (cprox_robot_pair){(int32_t)k, 0};
    for (size_t k = 0; k < b.n; k++)
      for (size_t l = 0; l < k; l++) selves[n_selves++] = (cprox_robot_pair){(int32_t)k, (int32_t)l};
    const cprox_edge_query q = {
        .obstacles = set, .pairs = pairs, .n_pairs = b.n, .self_pairs = selves, .n_self_pairs = n_selves};
    cprox_edge_checker *c = edge_world_checker(b.robot, &q);
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
    for (size_t k = 1; k < c->n_frames && fits; k++) {
      place_frame(&batch, k), move_frame(&batch, k);
      const edge_frame_bound *bound = &motion.bounds[k];
      const size_t first = k * EDGE_POWERS;
      const lane rate = powers_at(&batch, motion.more_rate + first, motion.rate[k]),
                 value =
                     lane_all(motion.middle[k]) + batch.middle * powers_at(&batch, motion.more + first, motion.rate[k]);
      for (int l = 0; l < EDGE_LANES; l++) {
        assert_true(fabs((double)rate[l]) <= bound->rate + bound->rate_error + 1e-30 + EDGE_U * bound->rate);
        if (c->frames[k].shifts) assert_true(fabs((double)value[l]) <= bound->shift + bound->value_error);
      }
    }

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
        const vec3l exact = ref_sub(edge_robot_centre(&b, here, g, 0), ref_vec(base));
        const long double room = (long double)motion.room[p];
        const long double off = ref_norm(ref_sub(exact, at)) / room;
        worst = off > worst ? off : worst, lanes++;
        if (!(off <= 1.0L)) fail_msg("robot %zu: a ball is off by %Lg of its room", i, off);

        const lane moves = moves_of(&batch, speed, motion.frames[part->frame], ball->reach);
        const long double moved =
            ref_norm(ref_sub(edge_robot_centre(&b, there, g, 0), edge_robot_centre(&b, here, g, 0)));
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
        const vec3l seen = ref_pose_undo(&here[link], edge_robot_centre(&b, here, a, 0)),
                    later = ref_pose_undo(&there[link], edge_robot_centre(&b, there, a, 0));
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
    edge_robot_free(&b);
  }
  print_message("%zu lanes, off by %.3Lg of what rounding may cost at most\n", lanes, worst);
  /* the bounds are not idle */
  assert_true(refused * 10 < test_cases(1500));
  if (test_cases(1500) >= 1000) assert_true(worst > 0.01L && fullest > 0.99L && fullest_pair > 0.99L);
}

/* Chains whose velocities cancel in the middle, so that accelerations alone move the ball: a shift along an axis that
 * turns (2 W g), a turn about an axis that a shift is away from (W^2 of the shift), two turns about one axis, and a
 * turn about an axis that another one is away from. Half of what they reach, or a term less, would be too little,
 * seen from the base and from a ball there. */
CASE(accelerations_alone_are_bounded) {
  static lane_memory memory;
  enum { CASES = 4, LINKS = 5 };
  static const double RATE[CASES][LINKS - 1] = {
      {-1.0, 0.1, 1.0, 0.0}, {-1.0, 1.0, 0.0, 0.0}, {-2.0, 1.0, 0.0, 1.0}, {-1.0, 1.0, 0.0, 0.0}};
  static const double MIDDLE[CASES] = {0.0, 1.0, 1.0, 0.0}, BETWEEN[CASES] = {0.0, 0.0, 0.0, 1.0};
  for (int i = 0; i < CASES; i++) {
    const vec3 first = i == 0 ? vec(1, 0, 0) : vec(0, 1, 0);
    const cprox_link links[LINKS] = {
        {.parent = -1, .type = CPROX_JOINT_FIXED, .origin = CPROX_POSE_IDENTITY, .axis = {0, 0, 1}, .multiplier = 1.0},
        {.parent = 0, .type = CPROX_JOINT_PRISMATIC, .origin = CPROX_POSE_IDENTITY, .axis = first, .multiplier = 1.0},
        {.parent = 1,
         .type = CPROX_JOINT_REVOLUTE,
         .origin = CPROX_POSE_IDENTITY,
         .axis = {0, 0, 1},
         .variable = 1,
         .multiplier = 1.0},
        {.parent = 2,
         .type = CPROX_JOINT_REVOLUTE,
         .origin = {{BETWEEN[i], 0, 0}, {.w = 1}},
         .axis = {0, 0, 1},
         .variable = 3,
         .multiplier = 1.0},
        {.parent = 3,
         .type = CPROX_JOINT_PRISMATIC,
         .origin = CPROX_POSE_IDENTITY,
         .axis = {1, 0, 0},
         .variable = 2,
         .multiplier = 1.0}};
    cprox_body *ball = NULL;
    assert_int_equal(cprox_body_create_sphere(0.01, ws, &ball), CPROX_OK);
    const cprox_link_geometry geometries[2] = {{.body = ball, .pose = CPROX_POSE_IDENTITY, .link = LINKS - 1},
                                               {.body = ball, .pose = CPROX_POSE_IDENTITY, .link = 0}};
    cprox_robot *robot = NULL;
    assert_int_equal(cprox_robot_create(links, LINKS, geometries, 2, LINKS - 1, ws, &robot), CPROX_OK);
    const cprox_robot_pair pair = {0, 1};
    cprox_edge_checker *c = edge_world_checker(robot, &(cprox_edge_query){.self_pairs = &pair, .n_self_pairs = 1});
    double from[LINKS - 1], to[LINKS - 1];
    for (int k = 0; k < LINKS - 1; k++) {
      const double middle = k == 2 ? MIDDLE[i] : 0.0;
      from[k] = middle - 0.5 * RATE[i][k], to[k] = middle + 0.5 * RATE[i][k];
    }
    edge_motion motion = edge_motion_in(c, memory.motion);
    assert_true(edge_motion_fill(c, from, to, &motion));
    edge_motion_relate(c, &motion);
    const double half = 0.0625, angle = RATE[i][1] * half, both = (RATE[i][1] + RATE[i][3]) * half;
    const double along = MIDDLE[i] + RATE[i][2] * half, shifted = RATE[i][0] * half;
    const double x = BETWEEN[i] * (cos(angle) - 1.0) + along * cos(both) + (i == 0 ? shifted : 0.0) - MIDDLE[i];
    const double y = BETWEEN[i] * sin(angle) + along * sin(both) + (i == 0 ? 0.0 : shifted);
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

/* Chains in a plane whose joints turn by up to 60 rad (1,000 edges, seed 407), at eight random times: orientations, places,
 * rotation rates and velocities of all frames are within what their bounds say of single precision, against long double. */
CASE(frames_that_turn_fast_are_within_their_own_errors) {
  enum { JOINTS = 4 };
  static lane_memory memory;
  rng r = rng_seed(407);
  cprox_body *ball = NULL;
  assert_int_equal(cprox_body_create_sphere(0.1, ws, &ball), CPROX_OK);
  const cprox_obstacle target = cprox_obstacle_at(ball, CPROX_POSE_IDENTITY);
  cprox_obstacles *set = NULL;
  assert_int_equal(cprox_obstacles_create(&target, 1, CPROX_INDEX_NONE, ws, &set), CPROX_OK);
  for (size_t i = 0; i < test_cases(1000); i++) {
    cprox_link links[JOINTS];
    double length[JOINTS], from[JOINTS], to[JOINTS];
    for (int k = 0; k < JOINTS; k++) {
      length[k] = k > 0 ? rng_uniform(&r, 0.1, 2) : 0.0;
      from[k] = rng_uniform(&r, -3, 3), to[k] = from[k] + rng_uniform(&r, -1, 1) * rng_log_uniform(&r, 0.1, 60);
      links[k] = (cprox_link){.parent = k - 1,
                              .type = CPROX_JOINT_REVOLUTE,
                              .origin = {.position = {length[k], 0, 0}, .orientation = {.w = 1}},
                              .axis = {0, 0, 1},
                              .variable = k,
                              .multiplier = 1.0};
    }
    const cprox_link_geometry geometry = {.body = ball, .pose = CPROX_POSE_IDENTITY, .link = JOINTS - 1};
    cprox_robot *robot = NULL;
    assert_int_equal(cprox_robot_create(links, JOINTS, &geometry, 1, JOINTS, ws, &robot), CPROX_OK);
    cprox_edge_checker *c = edge_world_checker(robot, &(cprox_edge_query){.obstacles = set});
    edge_motion motion = edge_motion_in(c, memory.motion);
    assert_true(c->n_frames == JOINTS + 1 && edge_motion_fill(c, from, to, &motion));
    lane_batch batch = {.c = c, .motion = &motion};
    batch.frames = (lane_frame *)(void *)memory.lanes;
    memset(&batch.frames[0], 0, sizeof batch.frames[0]);
    for (int k = 0; k < 9; k += 4) batch.frames[0].r[k] = lane_all(1.0f);
    for (int l = 0; l < EDGE_LANES; l++) batch.middle[l] = (float)rng_uniform(&r, -0.5, 0.5);
    for (size_t k = 1; k < c->n_frames; k++) place_frame(&batch, k), move_frame(&batch, k);
    for (int l = 0; l < EDGE_LANES; l++) {
      long double angle = 0.0L, spin = 0.0L, x = 0.0L, y = 0.0L, vx = 0.0L, vy = 0.0L;
      for (int k = 0; k < JOINTS; k++) {
        const lane_frame *f = &batch.frames[k + 1];
        const edge_frame_bound *b = &motion.bounds[k + 1];
        const long double ahead = (long double)length[k], across = cosl(angle) * ahead, up = sinl(angle) * ahead;
        x += across, y += up, vx -= spin * up, vy += spin * across;
        const long double rate = (long double)to[k] - (long double)from[k];
        angle += (long double)from[k] + (0.5L + (long double)batch.middle[l]) * rate, spin += rate;
        const lane3 turn = {f->r[0], f->r[3], f->r[6]};
        const long double off[4] = {ref_norm(ref_sub(lane_of(turn, l), (vec3l){cosl(angle), sinl(angle), 0.0L})),
                                    ref_norm(ref_sub(lane_of(f->spin, l), (vec3l){0.0L, 0.0L, spin})),
                                    ref_norm(ref_sub(lane_of(f->o, l), (vec3l){x, y, 0.0L})),
                                    ref_norm(ref_sub(lane_of(f->speed, l), (vec3l){vx, vy, 0.0L}))};
        const double bound[4] = {b->turn_error, b->spin_error, b->place_error, b->speed_error};
        for (int e = 0; e < 4; e++)
          if (!(off[e] <= (long double)bound[e])) fail_msg("frame %d, error %d: %Lg, not %g", k, e, off[e], bound[e]);
      }
    }
    cprox_edge_checker_free(c);
    cprox_robot_free(robot);
  }
  cprox_obstacles_free(set);
  cprox_body_free(ball);
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
  for (size_t i = 0; i < test_cases(1000 * EDGE_WORLD_KINDS); i++) {
    const double scale = rng_log_uniform(&r, 1e-3, 1e3);
    cprox_body *body = edge_world_body(&r, scale, i % EDGE_WORLD_KINDS);
    cprox_obstacle target = cprox_obstacle_at(body, rng_pose(&r, scale));
    if (rng_index(&r, 3) == 0) target.pose.orientation = (cprox_quat){.w = 1};
    if (rng_index(&r, 4) == 0) target.pose.orientation = (cprox_quat){.w = 1, .y = -1};
    if (rng_index(&r, 3) == 0) target.margin = scale * rng_uniform(&r, 0, 0.1);
    cprox_obstacles *set = NULL;
    assert_int_equal(cprox_obstacles_create(&target, 1, CPROX_INDEX_NONE, ws, &set), CPROX_OK);
    cprox_edge_checker *c = edge_world_checker(robot, &(cprox_edge_query){.obstacles = set});
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
      if (!(lanes <= exact + room)) fail_msg("kind %zu: %.9g is more than %.9g", i % EDGE_WORLD_KINDS, lanes, exact);
      if (isfinite((double)c->obstacles[0].grown) && !(lanes >= exact - room - (double)c->obstacles[0].grown))
        fail_msg("kind %zu: %.9g is less than %.9g", i % EDGE_WORLD_KINDS, lanes, exact);
    }
    cprox_edge_checker_free(c);
    cprox_obstacles_free(set);
    cprox_body_free(body);
  }
  cprox_robot_free(robot);
  cprox_body_free(ball);
}

/* Points beside a face of a box that is up to 10,000 times as large as they are away from it: what single precision does
 * to the box counts, not what it does to the points (10,000 boxes, seed 408, as above). */
CASE(large_boxes_are_no_farther_than_they_are) {
  rng r = rng_seed(408);
  cprox_body *ball = NULL;
  assert_int_equal(cprox_body_create_sphere(0.1, ws, &ball), CPROX_OK);
  const cprox_link link = {
      .parent = -1, .type = CPROX_JOINT_PRISMATIC, .origin = CPROX_POSE_IDENTITY, .axis = {0, 0, 1}, .multiplier = 1.0};
  const cprox_link_geometry g = {.body = ball, .pose = CPROX_POSE_IDENTITY};
  cprox_robot *robot = NULL;
  assert_int_equal(cprox_robot_create(&link, 1, &g, 1, 1, ws, &robot), CPROX_OK);
  for (size_t i = 0; i < test_cases(10000); i++) {
    const double size = rng_log_uniform(&r, 1, 1e3), away = rng_uniform(&r, 0, 0.1);
    cprox_body *box = NULL;
    assert_int_equal(cprox_body_create_box(vec(2 * size, 2 * size, 2 * size), ws, &box), CPROX_OK);
    cprox_pose pose = {.orientation = rng_quat(&r)};
    if (i % 2) pose.orientation = (cprox_quat){.w = 1};
    const frame turn = frame_create(&pose, vec(0, 0, 0));
    pose.position = rotate(turn.r, vec(size + away, 0.5 * size, 0));
    const cprox_obstacle target = cprox_obstacle_at(box, pose);
    cprox_obstacles *set = NULL;
    assert_int_equal(cprox_obstacles_create(&target, 1, CPROX_INDEX_NONE, ws, &set), CPROX_OK);
    cprox_edge_checker *c = edge_world_checker(robot, &(cprox_edge_query){.obstacles = set});
    const lane origin = lane_all(0.0f);
    const double lanes = sqrt((double)distance2_from(&c->obstacles[0], (lane3){origin, origin, origin})[0]);
    const double room = EDGE_GROW * away + 1e-12 * size;
    if (!(lanes <= away + room)) fail_msg("box of %g: %.9g is more than %.9g", size, lanes, away);
    if (!(lanes >= away - room - (double)c->obstacles[0].grown)) fail_msg("%.9g is less than %.9g", lanes, away);
    cprox_edge_checker_free(c);
    cprox_obstacles_free(set);
    cprox_body_free(box);
  }
  cprox_robot_free(robot);
  cprox_body_free(ball);
}

/* The plain kernel and that of the machine give the same results, bit by bit (300 worlds, seed 406). */
CASE(all_instruction_sets_find_the_same) {
  static lane_memory memory;
  rng r = rng_seed(406);
  for (size_t i = 0; i < test_cases(300); i++) {
    edge_world w;
    edge_world_make(&r, 1.0, i % 2, false, &w);
    const cprox_edge_query q = edge_world_asks(&w, true, 0.0);
    cprox_edge_checker *c = edge_world_checker(w.b.robot, &q);
    double from[TEST_MAX_VARIABLES + 1], to[TEST_MAX_VARIABLES + 1];
    edge_robot_draw(&r, &w.b, 1.0, from, to);
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
    edge_world_free(&w);
  }
}

int main(void) {
  return cases_run(workspace_setup, workspace_teardown);
}
