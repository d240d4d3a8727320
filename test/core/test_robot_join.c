/* SPDX-License-Identifier: BSD-3-Clause */
/* Several robots on one clock: poses against each robot's own in long double; distances, verdicts and times of contact
 * of balls that move against each other, in closed form. */
#include <math.h>
#include <string.h>

#include "kinematics/bound.h"
#include "kinematics/motion.h"
#include "shape/body.h"
#include "support/builders.h"
#include "support/cases.h"
#include "support/of_list.h"
#include "support/robots.h"

enum { MEMBERS = 3, MAX_AXES = MEMBERS * 4 * TEST_MAX_LINKS, MAX_VARIABLES = MEMBERS * TEST_MAX_VARIABLES };

static const cprox_pose HERE = {.orientation = {.w = 1.0}};

static cprox_status join(const cprox_robot *robot, const cprox_joined_motion *joined, size_t n, cprox_motion **motion) {
  const cprox_motion_description d = {.kind = CPROX_MOTION_JOINED, .joined = joined, .n_joined = n};
  return cprox_motion_create(robot, &d, ws, motion);
}

/* ---- poses ---- */

typedef struct assembly {
  test_robot members[MEMBERS];
  double starts[MEMBERS];
  cprox_pose bases[MEMBERS];
  cprox_robot *robot;
  cprox_motion *motion;
} assembly;

/* Times that are multiples of 2^-20 have exact sums: what is joined is then what was given. */
static void assembly_make(rng *r, assembly *a) {
  const cprox_robot *robots[MEMBERS];
  cprox_joined_motion joined[MEMBERS];
  for (size_t i = 0; i < MEMBERS; i++) {
    test_robot *t = &a->members[i];
    const double speed = rng_log_uniform(r, 0.01, 3);
    if (rng_index(r, 2))
      robot_make(r, speed, t);
    else
      robot_make_turning(r, speed, (cprox_turning)rng_index(r, 3), 2 + rng_index(r, TEST_WAYPOINTS - 1), t);
    for (size_t k = 0; k < t->n_points + TEST_SPLINE_DEGREE + 1; k++)
      t->times[k] = ldexp(rint(ldexp(t->times[k], 20)), -20);
    robot_rebuild(t);
    /* begins before the first one has ended */
    const cprox_motion_info info = cprox_motion_get_info(t->motion),
                            first = cprox_motion_get_info(a->members[0].motion);
    const double from = first.t0 - info.t1, to = first.t1 - info.t0;
    a->starts[i] = i == 0 ? 0.0 : ldexp(rint(ldexp(rng_uniform(r, from, to), 20)), -20);
    a->bases[i] = rng_pose(r, 1.0);
    robots[i] = t->robot, joined[i] = (cprox_joined_motion){t->motion, a->starts[i], 0.0};
  }
  assert_int_equal(cprox_robot_join(robots, a->bases, MEMBERS, ws, &a->robot), CPROX_OK);
  if (join(a->robot, joined, MEMBERS, &a->motion) != CPROX_OK) fail_msg("%s", cprox_workspace_error(ws));
}

static void assembly_free(assembly *a) {
  cprox_motion_free(a->motion);
  cprox_robot_free(a->robot);
  for (size_t i = 0; i < MEMBERS; i++) robot_free(&a->members[i]);
}

/* The frames at one time, axis by axis. */
static void place_each_axis(const cprox_motion *m, size_t segment, double at, placement *frames) {
  axis_state axes[MAX_AXES + 1];
  for (size_t i = 0; i < m->robot->n_axes; i++) {
    double u = at;
    const size_t own = motion_track_place(m, motion_track_of(m, i), segment, &u);
    motion_place_axis(m, own, u, i, axes);
    frames[i] = axes[i].frame;
  }
}

/* Some segments of the track that shifts a part, round one of the clock. */
static motion_interval own_interval(rng *r, const cprox_motion *m, const part_sweep *sweep, size_t segment) {
  motion_interval over = {.first = segment - rng_index(r, segment + 1), .last = segment + 1, .a = 0.0, .b = 1.0};
  over.last += rng_index(r, m->n_segments - segment);
  return sweep->n_shifts ? motion_track_interval(m, motion_track_of(m, sweep->axes[0]), &over) : over;
}

/* The tolerance is what the core says of itself. */
CASE(every_part_is_where_its_own_robot_has_it_at_that_time) {
  rng r = rng_seed(7001);
  static assembly a;
  double worst = 0.0, reached = 0.0;
  for (size_t i = 0; i < test_cases(200); i++) {
    assembly_make(&r, &a);
    for (int k = 0; k < 12; k++) {
      const size_t segment = rng_index(&r, a.motion->n_segments);
      const double u = k == 0 ? 0.0 : k == 1 ? 1.0 : rng_uniform(&r, 0, 1);
      double values[MAX_VARIABLES + 1];
      placement frames[MAX_AXES + 1];
      if (k % 2)
        place_each_axis(a.motion, segment, u, frames);
      else
        motion_place(a.motion, segment, u, values, frames);
      const long double t0 = a.motion->times[segment], t1 = a.motion->times[segment + 1];
      const long double time = (1 - (long double)u) * t0 + u * t1;
      size_t part = 0;
      for (size_t m = 0; m < MEMBERS; m++) {
        const test_robot *t = &a.members[m];
        const cprox_motion_info info = cprox_motion_get_info(t->motion);
        const long double own = fminl(fmaxl(time - a.starts[m], info.t0), info.t1);
        long double exact[TEST_MAX_VARIABLES + 1];
        ref_pose links[TEST_MAX_LINKS];
        robot_ref_values(t, own, exact);
        robot_ref_links(t, exact, links);
        for (size_t p = 0; p < t->robot->n_parts; p++, part++) {
          const robot_part *of = &a.robot->parts[part];
          const placement at = placement_under(frames, of->axis, &of->at);
          vec3l vertices[TEST_VERTICES];
          robot_ref_vertices(t, links, p, vertices);
          for (size_t v = 0; v < TEST_VERTICES; v++) {
            const vec3 local = vec_sub(t->vertices[p][v], t->geometries[p].body->centre);
            const long double off = ref_error(ref_to_world(&a.bases[m], vertices[v]), placement_apply(&at, local));
            worst = fmax(worst, (double)off / a.motion->part_error[part]);
            const part_sweep *sweep = &a.motion->sweeps[part];
            const vec3l x = ref_to_world(&a.bases[m], vertices[v]);
            const motion_interval over = own_interval(&r, a.motion, sweep, segment);
            const sweep_box part_box = motion_sweep_over(a.motion, sweep, over.first, over.last),
                            *box = k % 3 ? &sweep->box : &part_box;
            const vec3l inside = {fminl(fmaxl(x.x, box->low.x), box->high.x),
                                  fminl(fmaxl(x.y, box->low.y), box->high.y),
                                  fminl(fmaxl(x.z, box->low.z), box->high.z)};
            if (ref_norm(ref_sub(x, inside)) > sweep->radius)
              fail_msg("assembly %zu part %zu leaves its sweep", i, part);
            reached = fmax(reached, (double)ref_norm(ref_sub(x, inside)) / sweep->radius);
            if (off > a.motion->part_error[part])
              fail_msg("assembly %zu part %zu is off by %.3Lg, said to be at most %.3g", i, part, off,
                       a.motion->part_error[part]);
          }
        }
      }
      assert_int_equal(part, a.robot->n_parts);
    }
    assembly_free(&a);
  }
  print_message("largest error / bound: %.3f; largest distance from a sweep's box / radius: %.3f\n", worst, reached);
  assert_true(worst > 1e-3 && reached > 0.5);
}

CASE(a_joined_motion_lasts_from_the_first_start_to_the_last_end) {
  rng r = rng_seed(7002);
  static assembly a;
  for (size_t i = 0; i < test_cases(100); i++) {
    assembly_make(&r, &a);
    double first = INFINITY, last = -INFINITY;
    size_t variables = 0;
    for (size_t m = 0; m < MEMBERS; m++) {
      const cprox_motion_info info = cprox_motion_get_info(a.members[m].motion);
      first = fmin(first, info.t0 + a.starts[m]), last = fmax(last, info.t1 + a.starts[m]);
      variables += info.n_variables;
    }
    const cprox_motion_info info = cprox_motion_get_info(a.motion);
    assert_true(info.t0 == first && info.t1 == last);
    assert_int_equal(info.kind, CPROX_MOTION_JOINED);
    assert_int_equal(info.n_variables, variables);
    assembly_free(&a);
  }
}

/* ---- bounds ---- */

enum { SIDES = 12, SAMPLES = 16 };

static motion_interval any_interval(rng *r, const cprox_motion *m) {
  motion_interval over = {.a = 0.0, .b = 1.0};
  over.first = rng_index(r, m->n_segments);
  const size_t most = m->n_segments - over.first;
  over.last = over.first + 1 + (rng_index(r, 3) ? rng_index(r, most) : 0);
  if (rng_index(r, 2)) over.a = rng_uniform(r, 0, 0.5);
  if (rng_index(r, 2)) over.b = rng_uniform(r, 0.5, 1);
  return over;
}

/* A geometry of one robot seen from one of the same or of another robot, and what the core says of it. */
typedef struct join_claim {
  size_t member[2], geometry[2], part[2];
  vec3 n, drift;
  chain_motion motion;
  double second, both;
} join_claim;

static void find_claim(rng *r, const assembly *a, const axis_state *axes, join_claim *c) {
  for (int side = 0; side < 2; side++) {
    c->member[side] = rng_index(r, MEMBERS);
    c->geometry[side] = c->part[side] = rng_index(r, a->members[c->member[side]].n_links);
    for (size_t m = 0; m < c->member[side]; m++) c->part[side] += a->members[m].n_links;
  }
  c->n = rng_unit(r);
  c->n = vec_scale(1.0 / vec_norm(c->n), c->n);
  c->drift = rng_index(r, 2) ? vec_scale(rng_log_uniform(r, 1e-3, 0.5), rng_unit(r)) : vec(0, 0, 0);
  c->drift = vec_axpy(c->drift, -vec_dot(c->drift, c->n), c->n);

  double scratch[MAX_AXES];
  chain_axis chain[MAX_AXES];
  placement frames[MAX_AXES + 1];
  for (size_t i = 0; i < a->robot->n_axes; i++) frames[i] = axes[i].frame;
  const robot_part *part = &a->robot->parts[c->part[0]], *other = &a->robot->parts[c->part[1]];
  const placement at = placement_under(frames, part->axis, &part->at);
  const double error = a->motion->part_error[c->part[0]];
  const size_t length = motion_chain(a->motion, other->axis, part->axis, chain);
  motion_of_part(axes, chain, length, at.p, part->model.radius + error, scratch, &c->motion);
  cprox_body *origin;
  assert_int_equal(cprox_body_create_point(vec(0, 0, 0), NULL, &origin), CPROX_OK);
  const bound_side moving = {.shape = part->model.shape,
                             .at = at,
                             .margin = part->model.margin,
                             .error = error,
                             .middle = part->model.middle,
                             .half = part->model.half};
  const bound_side standing = {
      .shape = &origin->shape, .at = {.r = {1, 0, 0, 0, 1, 0, 0, 0, 1}}, .error = a->motion->part_error[c->part[1]]};
  double slack;
  const double heights[2] = {bound_height(&standing, vec_axpy(c->n, -0.5, c->drift)),
                             bound_height(&standing, vec_axpy(c->n, 0.5, c->drift))};
  const uint32_t steps = part->steps + other->steps;
  c->second = motion_plane_bound(&c->motion, &moving, &standing, c->n, c->drift, heights, steps, -INFINITY, &slack);
  c->both = motion_plane_bound(&c->motion, &moving, &standing, c->n, c->drift, heights, steps, INFINITY, &slack);
  cprox_body_free(origin);
}

/* The links of a member at a time of the clock, in the frame of its base. */
static void member_links(const assembly *a, size_t member, long double time, ref_pose *links) {
  const test_robot *t = &a->members[member];
  const cprox_motion_info info = cprox_motion_get_info(t->motion);
  long double values[TEST_MAX_VARIABLES + 1];
  robot_ref_values(t, fminl(fmaxl(time - a->starts[member], info.t0), info.t1), values);
  robot_ref_links(t, values, links);
}

/* The vertices of the moving geometry as the standing one sees them. */
static void seen_at(const assembly *a, const join_claim *c, long double time, vec3l *seen) {
  ref_pose links[TEST_MAX_LINKS];
  member_links(a, c->member[0], time, links);
  robot_ref_vertices(&a->members[c->member[0]], links, c->geometry[0], seen);
  member_links(a, c->member[1], time, links);
  for (size_t v = 0; v < TEST_VERTICES; v++) {
    const vec3l world = ref_to_world(&a->bases[c->member[0]], seen[v]);
    const ref_pose standing = ref_pose_under(&a->bases[c->member[1]], &links[c->geometry[1]]);
    seen[v] = ref_pose_undo(&standing, world);
  }
}

static long double time_at(const cprox_motion *m, size_t segment, double u) {
  return (1 - (long double)u) * m->times[segment] + (long double)u * m->times[segment + 1];
}

/* The standing side is held where it is in the middle. Intervals and spans of the clock are of other lengths for each
 * of the robots: parts of a segment, many segments, and what stands before and after. */
CASE(no_point_is_nearer_than_intervals_of_the_clock_say) {
  rng r = rng_seed(7006);
  static assembly a;
  size_t checks = 0, told = 0, spans = 0;
  double nearest = 0.0;
  for (size_t i = 0; i < test_cases(120); i++) {
    assembly_make(&r, &a);
    for (int k = 0; k < 8; k++) {
      const motion_interval over = any_interval(&r, a.motion);
      static double rows[MOTION_ROWS * (MAX_VARIABLES + MEMBERS * MOTION_LANES)];
      static axis_state axes[MAX_AXES + 1];
      const span_centre centre = motion_span_node(a.motion, &over, rows, axes);
      spans += motion_is_span(&over);
      const long double t0 = time_at(a.motion, over.first, over.a), t1 = time_at(a.motion, over.last - 1, over.b);
      const long double middle = time_at(a.motion, centre.segment, centre.u);
      for (int side = 0; side < SIDES; side++) {
        join_claim c;
        find_claim(&r, &a, axes, &c);
        vec3l before[TEST_VERTICES], x[TEST_VERTICES];
        ref_pose links[TEST_MAX_LINKS];
        member_links(&a, c.member[1], middle, links);
        const ref_pose standing = ref_pose_under(&a.bases[c.member[1]], &links[c.geometry[1]]);
        seen_at(&a, &c, middle, before);
        for (int s = 0; s <= SAMPLES; s++, checks++) {
          const long double share = (long double)s / SAMPLES;
          seen_at(&a, &c, t0 + share * (t1 - t0), x);
          const vec3l n = ref_add(ref_vec(c.n), ref_scale(share - 0.5L, ref_vec(c.drift)));
          for (size_t v = 0; v < TEST_VERTICES; v++) {
            const long double way = ref_norm(ref_sub(x[v], before[v]));
            if (way > c.motion.displacement + 1e-14L)
              fail_msg("assembly %zu: moves %.17Lg, said to be at most %.17g", i, way, c.motion.displacement);
            if (c.motion.displacement > 1e-9) nearest = fmax(nearest, (double)(way / c.motion.displacement));
            const long double height =
                ref_dot(n, ref_pose_apply(&standing, x[v])) / ref_norm(n) - a.members[c.member[0]].margin;
            if (height < c.second || height < c.both)
              fail_msg("assembly %zu: height %.17Lg below the bounds %.17g, %.17g", i, height, c.second, c.both);
            told += c.both > height - 0.1L * c.motion.displacement;
          }
        }
      }
    }
    assembly_free(&a);
  }
  print_message("%zu checks, %zu spans; largest way / bound %.4f, %zu heights near their bound\n", checks, spans,
                nearest, told);
  assert_true(nearest > 0.9 && told > 1000);
}

/* ---- balls ---- */

enum { BALL_POINTS = 4 };

/* A ball on a floating joint along straight lines. */
typedef struct ball {
  double radius, start;
  double times[BALL_POINTS];
  double values[BALL_POINTS][7];
  cprox_body *body;
  cprox_robot *robot;
  cprox_motion *motion;
} ball;

static void ball_make(rng *r, ball *b) {
  const cprox_link link = {.parent = -1, .type = CPROX_JOINT_FLOATING, .origin = HERE};
  b->radius = rng_log_uniform(r, 0.01, 0.3);
  assert_int_equal(cprox_body_create_sphere(b->radius, NULL, &b->body), CPROX_OK);
  const cprox_link_geometry geometry = {.body = b->body, .pose = HERE};
  assert_int_equal(cprox_robot_create(&link, 1, &geometry, 1, 7, ws, &b->robot), CPROX_OK);
  static const int32_t ALL[7] = {0, 1, 2, 3, 4, 5, 6};
  cprox_waypoint points[BALL_POINTS];
  double t = 0.0;
  for (size_t i = 0; i < BALL_POINTS; i++) {
    t += 0.5 + ldexp((double)rng_index(r, 1 << 12), -12);
    for (size_t k = 0; k < 3; k++) b->values[i][k] = rng_uniform(r, -1.5, 1.5);
    const vec3 v = rng_unit(r);
    const double q[4] = {v.x, v.y, v.z, 2.0};
    memcpy(b->values[i] + 3, q, sizeof q);
    b->times[i] = t;
    points[i] = (cprox_waypoint){.time = t, .positions = b->values[i]};
  }
  b->start = ldexp((double)rng_index(r, 1 << 12), -12) - b->times[0]; /* begins in [0, 1], ends after 1.5 */
  const cprox_motion_description d = {
      .variables = ALL, .n_variables = 7, .waypoints = points, .n_waypoints = BALL_POINTS};
  assert_int_equal(cprox_motion_create(b->robot, &d, ws, &b->motion), CPROX_OK);
}

static void ball_free(ball *b) {
  cprox_motion_free(b->motion);
  cprox_robot_free(b->robot);
  cprox_body_free(b->body);
}

static vec3l ball_at(const ball *b, long double time) {
  const long double t = fminl(fmaxl(time - b->start, b->times[0]), b->times[BALL_POINTS - 1]);
  size_t i = 0;
  while (i + 2 < BALL_POINTS && t >= b->times[i + 1]) i++;
  const long double s = (t - b->times[i]) / ((long double)b->times[i + 1] - b->times[i]);
  const double *p = b->values[i], *q = b->values[i + 1];
  return (vec3l){p[0] + s * (q[0] - (long double)p[0]), p[1] + s * (q[1] - (long double)p[1]),
                 p[2] + s * (q[2] - (long double)p[2])};
}

/* The least distance of two points on straight lines over [t0, t1], and where they first come within `near`. */
typedef struct approach {
  long double distance, first; /* first: infinity where they do not */
} approach;

static void take_line(const ball *a, const ball *b, long double t0, long double t1, long double near, approach *out) {
  const vec3l d = ref_sub(ball_at(a, t0), ball_at(b, t0)), e = ref_sub(ball_at(a, t1), ball_at(b, t1)),
              v = ref_sub(e, d);
  const long double vv = ref_dot(v, v), dv = ref_dot(d, v);
  const long double s = vv > 0 ? fminl(fmaxl(-dv / vv, 0), 1) : 0;
  out->distance = fminl(out->distance, ref_norm(ref_add(d, ref_scale(s, v))));
  if (out->first < HUGE_VALL) return;
  if (ref_norm(d) <= near) out->first = t0;
  const long double inside = dv * dv - vv * (ref_dot(d, d) - near * near);
  if (ref_norm(d) <= near || vv == 0 || inside < 0) return;
  const long double root = (-dv - sqrtl(inside)) / vv;
  if (root >= 0 && root <= 1) out->first = t0 + root * (t1 - t0);
}

static approach approach_of(const ball *a, const ball *b) {
  long double knots[2 * BALL_POINTS];
  size_t n = 0;
  for (size_t i = 0; i < BALL_POINTS; i++) {
    knots[n++] = (long double)a->times[i] + a->start;
    knots[n++] = (long double)b->times[i] + b->start;
  }
  for (size_t i = 1; i < n; i++)
    for (size_t k = i; k > 0 && knots[k] < knots[k - 1]; k--) {
      const long double swapped = knots[k];
      knots[k] = knots[k - 1], knots[k - 1] = swapped;
    }
  approach out = {HUGE_VALL, HUGE_VALL};
  for (size_t i = 0; i + 1 < n; i++)
    if (knots[i] < knots[i + 1]) take_line(a, b, knots[i], knots[i + 1], (long double)a->radius + b->radius, &out);
  return out;
}

/* Two balls as robots of one motion. */
typedef struct pair_of_balls {
  ball a, b;
  cprox_robot *robot;
  cprox_motion *motion;
} pair_of_balls;

static void pair_make(rng *r, pair_of_balls *p) {
  *p = (pair_of_balls){0};
  ball_make(r, &p->a);
  ball_make(r, &p->b);
  const cprox_robot *robots[2] = {p->a.robot, p->b.robot};
  const cprox_joined_motion joined[2] = {{p->a.motion, p->a.start, 0.0}, {p->b.motion, p->b.start, 0.0}};
  assert_int_equal(cprox_robot_join(robots, NULL, 2, ws, &p->robot), CPROX_OK);
  assert_int_equal(join(p->robot, joined, 2, &p->motion), CPROX_OK);
}

static void pair_free(pair_of_balls *p) {
  cprox_motion_free(p->motion);
  cprox_robot_free(p->robot);
  ball_free(&p->a);
  ball_free(&p->b);
}

/* Long double and rounding of poses: 1e-12 is a hundred times either. */
CASE(balls_on_one_clock_are_as_near_and_meet_when_they_do) {
  rng r = rng_seed(7003);
  size_t touching = 0;
  for (size_t i = 0; i < test_cases(1500); i++) {
    pair_of_balls p;
    pair_make(&r, &p);
    const cprox_mover mover = cprox_robot_self(p.motion, &(cprox_robot_pair){0, 1}, 1);
    const approach exact = approach_of(&p.a, &p.b);
    const long double clearance = fmaxl(exact.distance - p.a.radius - p.b.radius, 0);
    touching += exact.first < HUGE_VALL;

    cprox_result d = {0}, v = {0}, c = {0};
    assert_int_equal(distance_of_list(mover, NULL, 0, NULL, ws, &d, NULL), CPROX_OK);
    if (!(d.lower <= clearance + 1e-12L && d.upper >= clearance - 1e-12L && d.upper - d.lower <= 1.01e-6))
      fail_msg("case %zu: the distance is %.17Lg, said to be in [%.17g, %.17g]", i, clearance, d.lower, d.upper);
    assert_true(tolerance_of_list(mover, NULL, 0, (double)(0.9L * clearance), NULL, ws, &v, NULL) >= 0);
    if (clearance > 1e-9L) assert_int_equal(v.verdict, CPROX_VERDICT_CLEAR);
    assert_true(time_of_contact_of_list(mover, NULL, 0, NULL, ws, &c) >= 0);
    if (exact.first < HUGE_VALL) {
      assert_int_not_equal(c.verdict, CPROX_VERDICT_CLEAR);
      if (!(c.t_contact_lower <= exact.first + 1e-12L))
        fail_msg("case %zu: contact at %.17Lg, no later than %.17g was said", i, exact.first, c.t_contact_lower);
    } else if (clearance > 1e-6L) {
      assert_int_equal(c.verdict, CPROX_VERDICT_CLEAR);
    }
    pair_free(&p);
  }
  assert_true(touching > 50);
}

/* What stands, what moves against it, and both at once. */
CASE(obstacles_and_the_other_robot_are_asked_about_at_once) {
  rng r = rng_seed(7004);
  for (size_t i = 0; i < test_cases(200); i++) {
    pair_of_balls p;
    pair_make(&r, &p);
    cprox_body *box = NULL;
    assert_int_equal(cprox_body_create_box(vec(0.2, 0.3, 0.4), NULL, &box), CPROX_OK);
    const cprox_obstacle target = cprox_obstacle_at(box, rng_pose(&r, 1.0));
    const cprox_robot_pair pair = {0, 1};
    const cprox_mover whole = cprox_robot_whole(cprox_robot_along(p.motion, NULL, 0), &pair, 1);
    cprox_result all = {0}, standing = {0}, between = {0};
    assert_int_equal(distance_of_list(whole, &target, 1, NULL, ws, &all, NULL), CPROX_OK);
    assert_int_equal(distance_of_list(cprox_robot_along(p.motion, NULL, 0), &target, 1, NULL, ws, &standing, NULL),
                     CPROX_OK);
    assert_int_equal(distance_of_list(cprox_robot_self(p.motion, &pair, 1), NULL, 0, NULL, ws, &between, NULL),
                     CPROX_OK);
    const double lower = fmin(standing.lower, between.lower), upper = fmin(standing.upper, between.upper);
    assert_true(all.lower <= upper && lower <= all.upper);

    /* on one half of the clock and on the other */
    const cprox_motion_info info = cprox_motion_get_info(p.motion);
    const double breaks[3] = {info.t0, 0.5 * (info.t0 + info.t1), info.t1};
    cprox_profile_interval halves[2] = {0};
    assert_true(profile_of_list(cprox_robot_self(p.motion, &pair, 1), NULL, 0, breaks, 2, NULL, ws, halves) >= 0);
    assert_true(fmin(halves[0].lower, halves[1].lower) <= between.upper);
    assert_true(between.lower <= fmin(halves[0].upper, halves[1].upper));
    pair_free(&p);
    cprox_body_free(box);
  }
}

/* Each arm overlaps its own base, which nobody asks about: the two have one joint between them. So the arms are the one
 * pair, 10 m apart. */
CASE(what_is_not_asked_about_leaves_no_pair_out) {
  enum { LINKS = 2 };
  const cprox_link links[LINKS] = {
      {.parent = -1, .type = CPROX_JOINT_FIXED, .origin = HERE},
      {.parent = 0, .type = CPROX_JOINT_REVOLUTE, .origin = HERE, .axis = {0, 0, 1}, .variable = 0, .multiplier = 1.0}};
  cprox_body *bodies[LINKS] = {NULL};
  for (int k = 0; k < LINKS; k++) assert_int_equal(cprox_body_create_sphere(0.3, NULL, &bodies[k]), CPROX_OK);
  const cprox_link_geometry geometries[LINKS] = {{.body = bodies[0], .pose = HERE, .link = 0},
                                                 {.body = bodies[1], .pose = HERE, .link = 1}};
  cprox_robot *arm = NULL, *both = NULL;
  cprox_motion *turn = NULL, *motion = NULL;
  assert_int_equal(cprox_robot_create(links, LINKS, geometries, LINKS, 1, ws, &arm), CPROX_OK);
  const cprox_waypoint points[2] = {{.time = 0.0, .positions = (const double[]){0.0}},
                                    {.time = 1.0, .positions = (const double[]){1.0}}};
  const cprox_motion_description d = {
      .variables = (const int32_t[]){0}, .n_variables = 1, .waypoints = points, .n_waypoints = 2};
  assert_int_equal(cprox_motion_create(arm, &d, ws, &turn), CPROX_OK);
  const cprox_robot *robots[2] = {arm, arm};
  cprox_pose bases[2] = {HERE, HERE};
  bases[1].position.x = 10.0;
  const cprox_joined_motion joined[2] = {{turn, 0.0, 0.0}, {turn, 0.0, 0.0}};
  assert_int_equal(cprox_robot_join(robots, bases, 2, ws, &both), CPROX_OK);
  assert_int_equal(join(both, joined, 2, &motion), CPROX_OK);
  cprox_result r = {0};
  assert_int_equal(distance_of_list(cprox_robot_self(motion, NULL, 0), NULL, 0, NULL, ws, &r, NULL), CPROX_OK);
  assert_true(r.lower <= 9.4 + 1e-12 && r.upper >= 9.4 - 1e-12 && r.upper - r.lower <= 1.01e-6);
  cprox_motion_free(motion), cprox_motion_free(turn);
  cprox_robot_free(both), cprox_robot_free(arm);
  for (int k = 0; k < LINKS; k++) cprox_body_free(bodies[k]);
}

/* ---- many ---- */

enum { MANY = 300 };

static bool stops_after(void *user) {
  size_t *left = user;
  return (*left)-- == 0;
}

/* Balls with times of their own: what is kept of each grows with its own waypoints and not with those of others. */
CASE(a_joined_motion_is_as_large_as_its_members_together) {
  rng r = rng_seed(7007);
  static ball balls[MANY];
  const cprox_robot *robots[MANY];
  cprox_joined_motion joined[MANY];
  for (size_t i = 0; i < MANY; i++) {
    ball_make(&r, &balls[i]);
    robots[i] = balls[i].robot, joined[i] = (cprox_joined_motion){balls[i].motion, balls[i].start, 0.0};
  }
  cprox_robot *robot = NULL;
  cprox_motion *motion = NULL;
  assert_int_equal(cprox_robot_join(robots, NULL, MANY, ws, &robot), CPROX_OK);
  assert_int_equal(join(robot, joined, MANY, &motion), CPROX_OK);
  size_t numbers = 0;
  for (size_t i = 0; i < motion->n_tracks; i++) {
    const motion_track *t = &motion->tracks[i];
    assert_true(t->times[0] == motion->times[0] && t->times[t->n_segments] == motion->times[motion->n_segments]);
    numbers += t->n_segments * t->n_moving * t->stride;
  }
  assert_true(motion->n_segments > (BALL_POINTS - 1) * MANY);
  assert_true(numbers <= (size_t)MANY * (BALL_POINTS + 1) * 7 * 6);
  cprox_motion_free(motion);

  /* whoever waits may end it at any time */
  for (size_t calls = 0; calls < 2 * MANY; calls += MANY / 2) {
    size_t left = calls;
    cprox_motion *none = NULL;
    cprox_workspace_set_stop(ws, stops_after, &left);
    assert_int_equal(join(robot, joined, MANY, &none), CPROX_INVALID);
    assert_non_null(strstr(cprox_workspace_error(ws), "stopped while"));
    assert_null(none);
  }
  cprox_workspace_set_stop(ws, NULL, NULL);
  cprox_robot_free(robot);
  for (size_t i = 0; i < MANY; i++) ball_free(&balls[i]);
}

enum { SPREAD = 40, SPREAD_PAIRS = SPREAD * (SPREAD - 1) / 2 };

/* Balls of which few come near each other: those that stay far are left out, whatever is asked. 780 pairs. */
CASE(the_nearest_of_many_movers_are_found_whoever_is_left_out) {
  rng r = rng_seed(7008);
  size_t touching = 0;
  for (size_t i = 0; i < test_cases(60); i++) {
    static ball balls[SPREAD];
    const cprox_robot *robots[SPREAD];
    cprox_joined_motion joined[SPREAD];
    cprox_pose bases[SPREAD];
    cprox_robot_pair pairs[SPREAD_PAIRS];
    const double room = rng_log_uniform(&r, 1, 30);
    size_t n = 0;
    for (size_t k = 0; k < SPREAD; k++) {
      ball_make(&r, &balls[k]);
      bases[k] = HERE;
      bases[k].position = vec_scale(room, rng_in_cube(&r, 1.0));
      robots[k] = balls[k].robot, joined[k] = (cprox_joined_motion){balls[k].motion, balls[k].start, 0.0};
      for (size_t j = 0; j < k; j++) pairs[n++] = (cprox_robot_pair){(int32_t)j, (int32_t)k};
    }
    cprox_robot *robot = NULL;
    cprox_motion *motion = NULL;
    assert_int_equal(cprox_robot_join(robots, bases, SPREAD, ws, &robot), CPROX_OK);
    assert_int_equal(join(robot, joined, SPREAD, &motion), CPROX_OK);
    for (size_t k = 0; k < SPREAD; k++)
      for (size_t j = 0; j < BALL_POINTS; j++) {
        double *p = balls[k].values[j];
        p[0] += bases[k].position.x, p[1] += bases[k].position.y, p[2] += bases[k].position.z;
      }
    long double clearance = HUGE_VALL, first = HUGE_VALL;
    for (size_t k = 0; k < n; k++) {
      const ball *a = &balls[pairs[k].geometry], *b = &balls[pairs[k].other];
      const approach exact = approach_of(a, b);
      clearance = fminl(clearance, fmaxl(exact.distance - a->radius - b->radius, 0));
      first = fminl(first, exact.first);
    }
    touching += first < HUGE_VALL;
    for (int all = 0; all < 2; all++) {
      const cprox_mover mover = cprox_robot_self(motion, all ? NULL : pairs, all ? 0 : n);
      cprox_result d = {0}, v = {0}, c = {0};
      assert_int_equal(distance_of_list(mover, NULL, 0, NULL, ws, &d, NULL), CPROX_OK);
      if (!(d.lower <= clearance + 1e-12L && d.upper >= clearance - 1e-12L && d.upper - d.lower <= 1.01e-6))
        fail_msg("case %zu: the distance is %.17Lg, said to be in [%.17g, %.17g]", i, clearance, d.lower, d.upper);
      for (int side = 0; side < 2; side++) {
        const double delta = (double)(clearance * (side ? 1.1L : 0.9L)) + (side ? 1e-5 : 0.0);
        assert_true(tolerance_of_list(mover, NULL, 0, delta, NULL, ws, &v, NULL) >= 0);
        if (side || clearance > 1e-9L) assert_int_equal(v.verdict, side ? CPROX_VERDICT_VIOLATED : CPROX_VERDICT_CLEAR);
      }
      assert_true(time_of_contact_of_list(mover, NULL, 0, NULL, ws, &c) >= 0);
      if (first < HUGE_VALL && !(c.t_contact_lower <= first + 1e-12L))
        fail_msg("case %zu: contact at %.17Lg, no later than %.17g was said", i, first, c.t_contact_lower);
      if (first < HUGE_VALL) assert_int_not_equal(c.verdict, CPROX_VERDICT_CLEAR);
      if (clearance > 1e-6L) assert_int_equal(c.verdict, CPROX_VERDICT_CLEAR);
    }
    cprox_motion_free(motion);
    cprox_robot_free(robot);
    for (size_t k = 0; k < SPREAD; k++) ball_free(&balls[k]);
  }
  assert_true(touching > 5 && touching < test_cases(60));
}

/* ---- what is refused ---- */

static void refused(cprox_status status, const char *because) {
  assert_int_equal(status, CPROX_INVALID);
  if (!strstr(cprox_workspace_error(ws), because))
    fail_msg("'%s' does not say '%s'", cprox_workspace_error(ws), because);
}

CASE(what_cannot_be_joined_gets_a_message) {
  rng r = rng_seed(7005);
  ball a, b;
  ball_make(&r, &a);
  ball_make(&r, &b);
  const cprox_robot *robots[2] = {a.robot, b.robot};
  cprox_robot *robot = NULL;
  cprox_motion *motion = NULL, *stand = NULL;
  refused(cprox_robot_join(NULL, NULL, 2, ws, &robot), "no robot to join");
  refused(cprox_robot_join(robots, NULL, 0, ws, &robot), "no robot to join");
  const cprox_pose bases[2] = {HERE, {.orientation = {0, 0, 0, 0}}};
  refused(cprox_robot_join(robots, bases, 2, ws, &robot), "the base of robot 1");
  const cprox_robot *missing[2] = {a.robot, NULL};
  refused(cprox_robot_join(missing, NULL, 2, ws, &robot), "robot 1 is NULL");
  assert_null(robot);
  assert_int_equal(cprox_robot_join(robots, NULL, 2, ws, &robot), CPROX_OK);

  cprox_joined_motion joined[2] = {{a.motion, 0.0, 0.0}, {b.motion, 100.0, 0.0}};
  refused(join(robot, NULL, 2, &motion), "no motion to join");
  refused(join(robot, joined, 1, &motion), "one motion for each joined robot");
  refused(join(robot, joined, 2, &motion), "the clocks do not overlap: motion 1 begins at");
  joined[1].start = NAN;
  refused(join(robot, joined, 2, &motion), "its start is nan");
  joined[1].start = 1e18;
  refused(join(robot, joined, 2, &motion), "become one");
  joined[1] = (cprox_joined_motion){b.motion, 0.0, -1.0};
  refused(join(robot, joined, 2, &motion), "motion 1: the tolerance of its start is -1 s");
  joined[1].tolerance = NAN;
  refused(join(robot, joined, 2, &motion), "motion 1: the tolerance of its start is nan s");
  joined[1] = (cprox_joined_motion){b.motion, 100.0, 1.0};
  refused(join(robot, joined, 2, &motion), "the clocks do not overlap: motion 1 begins at");
  joined[1].motion = NULL;
  refused(join(robot, joined, 2, &motion), "motion 1 is NULL");
  const double pose[7] = {1, 2, 3, 0, 0, 0, 1};
  const cprox_motion_description stands = {.kind = CPROX_MOTION_STATE, .rest = pose};
  assert_int_equal(cprox_motion_create(b.robot, &stands, ws, &stand), CPROX_OK);
  joined[0] = joined[1] = (cprox_joined_motion){stand, 0.0, 0.0};
  refused(join(robot, joined, 2, &motion), "all motions are states");
  assert_null(motion);

  /* a stand stands on the clock of the others */
  joined[0] = (cprox_joined_motion){a.motion, 0.0, 0.0};
  assert_int_equal(join(robot, joined, 2, &motion), CPROX_OK);
  double values[14];
  cprox_motion_evaluate(motion, a.times[1], values);
  assert_memory_equal(values + 7, pose, sizeof pose);

  /* certificates know when everything starts */
  cprox_certificate *certificate = cprox_certificate_create();
  assert_non_null(certificate);
  cprox_motion_free(motion);
  motion = NULL;
  joined[0].tolerance = 0.5;
  assert_int_equal(join(robot, joined, 2, &motion), CPROX_OK);
  refused(certify_of_list(cprox_robot_self(motion, &(cprox_robot_pair){0, 1}, 1), NULL, 0, 0.0, NULL, NULL, ws,
                          certificate),
          "no certificates: starts with a tolerance");
  cprox_certificate_free(certificate);
  cprox_motion_free(motion);
  cprox_motion_free(stand);
  cprox_robot_free(robot);
  ball_free(&a);
  ball_free(&b);
}

int main(void) {
  return cases_run(workspace_setup, workspace_teardown);
}
