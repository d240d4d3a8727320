/* SPDX-License-Identifier: BSD-3-Clause */
/* Motions on one clock whose starts are only known to a tolerance, or that may be anywhere on their paths: balls along
 * straight lines, whose least distance over all times and starts is known in closed form, and turning bodies against
 * dense samples of both. */
#include <math.h>
#include <string.h>

#include "robot_query/starts.h"
#include "support/builders.h"
#include "support/cases.h"
#include "support/of_list.h"
#include "support/random.h"
#include "support/reference.h"

enum { POINTS = 4, MOST_BALLS = 3, PIECES = POINTS + 1 };

static const cprox_pose HERE = {.orientation = {.w = 1.0}};

/* ---- balls along straight lines ---- */

typedef struct ball {
  double radius, start, tolerance;
  double times[POINTS], values[POINTS][3];
  cprox_body *body;
  cprox_robot *robot;
  cprox_motion *motion;
} ball;

static void ball_make(rng *r, ball *b) {
  cprox_link links[3];
  for (int32_t i = 0; i < 3; i++)
    links[i] = (cprox_link){.parent = i - 1,
                            .type = CPROX_JOINT_PRISMATIC,
                            .origin = HERE,
                            .axis = {i == 0, i == 1, i == 2},
                            .variable = i,
                            .multiplier = 1.0};
  b->radius = rng_log_uniform(r, 0.01, 0.2);
  assert_int_equal(cprox_body_create_sphere(b->radius, NULL, &b->body), CPROX_OK);
  const cprox_link_geometry geometry = {.body = b->body, .pose = HERE, .link = 2};
  assert_int_equal(cprox_robot_create(links, 3, &geometry, 1, 3, ws, &b->robot), CPROX_OK);
  static const int32_t ALL[3] = {0, 1, 2};
  cprox_waypoint points[POINTS];
  for (size_t i = 0; i < POINTS; i++) {
    for (size_t k = 0; k < 3; k++) b->values[i][k] = rng_uniform(r, -1.5, 1.5);
    b->times[i] = (i > 0 ? b->times[i - 1] : 0.0) + 0.5 + ldexp((double)rng_index(r, 1 << 12), -12);
    points[i] = (cprox_waypoint){.time = b->times[i], .positions = b->values[i]};
  }
  b->start = ldexp((double)rng_index(r, 1 << 12), -12) - b->times[0];
  const double tolerances[] = {0.0, 0.0, 0.125, 1.0, 8.0, INFINITY};
  b->tolerance = tolerances[rng_index(r, 6)];
  const cprox_motion_description d = {.variables = ALL, .n_variables = 3, .waypoints = points, .n_waypoints = POINTS};
  assert_int_equal(cprox_motion_create(b->robot, &d, ws, &b->motion), CPROX_OK);
}

static vec3l ball_at(const ball *b, long double own) {
  const long double t = fminl(fmaxl(own, b->times[0]), b->times[POINTS - 1]);
  size_t i = 0;
  while (i + 2 < POINTS && t >= b->times[i + 1]) i++;
  const long double s = (t - b->times[i]) / ((long double)b->times[i + 1] - b->times[i]);
  const double *p = b->values[i], *q = b->values[i + 1];
  return (vec3l){p[0] + s * (q[0] - (long double)p[0]), p[1] + s * (q[1] - (long double)p[1]),
                 p[2] + s * (q[2] - (long double)p[2])};
}

typedef struct scene {
  size_t n;
  ball balls[MOST_BALLS];
  cprox_robot *robot;
  cprox_motion *motion;
  double t0, t1;
} scene;

static cprox_status join(scene *s, cprox_motion **motion) {
  cprox_joined_motion joined[MOST_BALLS];
  for (size_t i = 0; i < s->n; i++)
    joined[i] = (cprox_joined_motion){s->balls[i].motion, s->balls[i].start, s->balls[i].tolerance};
  const cprox_motion_description d = {.kind = CPROX_MOTION_JOINED, .joined = joined, .n_joined = s->n};
  return cprox_motion_create(s->robot, &d, ws, motion);
}

static void scene_make(rng *r, scene *s) {
  *s = (scene){.n = 2 + rng_index(r, 2)};
  const cprox_robot *robots[MOST_BALLS];
  for (size_t i = 0; i < s->n; i++) {
    ball_make(r, &s->balls[i]);
    robots[i] = s->balls[i].robot;
  }
  assert_int_equal(cprox_robot_join(robots, NULL, s->n, ws, &s->robot), CPROX_OK);
  if (join(s, &s->motion) != CPROX_OK) fail_msg("%s", cprox_workspace_error(ws));
  const cprox_motion_info info = cprox_motion_get_info(s->motion);
  s->t0 = info.t0, s->t1 = info.t1;
}

static void scene_free(scene *s) {
  cprox_motion_free(s->motion);
  cprox_robot_free(s->robot);
  for (size_t i = 0; i < s->n; i++) {
    cprox_motion_free(s->balls[i].motion);
    cprox_robot_free(s->balls[i].robot);
    cprox_body_free(s->balls[i].body);
  }
}

/* ---- the truth ---- */

typedef struct span {
  long double from, to;
} span;

/* The times that a ball's own clock can have while that of all is in [t0, t1]. */
static span own_times(const ball *b, span clock) {
  if (isinf(b->tolerance)) return (span){b->times[0], b->times[POINTS - 1]};
  return (span){clock.from - b->start - b->tolerance, clock.to - b->start + b->tolerance};
}

/* The pieces of a ball's way, by its own time, cut to a span. */
static size_t pieces_of(const ball *b, span within, span *pieces) {
  long double knots[POINTS + 2] = {within.from};
  size_t n = 1, count = 0;
  for (size_t i = 0; i < POINTS; i++)
    if (b->times[i] > within.from && b->times[i] < within.to) knots[n++] = b->times[i];
  knots[n++] = within.to;
  for (size_t i = 0; i + 1 < n; i++) pieces[count++] = (span){knots[i], knots[i + 1]};
  return count;
}

/* The least |d + x u - y v| over a straight line of (x, y) from p to q. */
static long double least_along(vec3l d, vec3l u, vec3l v, const long double p[2], const long double q[2]) {
  const vec3l from = ref_add(d, ref_sub(ref_scale(p[0], u), ref_scale(p[1], v)));
  const vec3l way = ref_sub(ref_scale(q[0] - p[0], u), ref_scale(q[1] - p[1], v));
  const long double square = ref_dot(way, way);
  const long double s = square > 0.0L ? fminl(fmaxl(-ref_dot(from, way) / square, 0.0L), 1.0L) : 0.0L;
  return ref_norm(ref_add(from, ref_scale(s, way)));
}

/* Two straight pieces: x in [0, dx] after the begin of the one, y in [0, dy] of the other, low <= x - y <= high. The
 * least distance is inside, where both derivatives vanish, or on an edge. */
static long double least_of_pieces(const ball *a, const ball *b, span of_a, span of_b, long double low,
                                   long double high) {
  const long double dx = of_a.to - of_a.from, dy = of_b.to - of_b.from;
  const vec3l p = ball_at(a, of_a.from), q = ball_at(b, of_b.from), d = ref_sub(p, q);
  const vec3l u = dx > 0.0L ? ref_scale(1.0L / dx, ref_sub(ball_at(a, of_a.to), p)) : (vec3l){0, 0, 0};
  const vec3l v = dy > 0.0L ? ref_scale(1.0L / dy, ref_sub(ball_at(b, of_b.to), q)) : (vec3l){0, 0, 0};
  long double least = HUGE_VALL;

  /* the edges of the polygon, each cut by the others */
  const long double xs[2] = {0.0L, dx}, ys[2] = {0.0L, dy}, lags[2] = {low, high};
  for (int k = 0; k < 2; k++) {
    long double from = fmaxl(0.0L, xs[k] - high), to = fminl(dy, xs[k] - low);
    if (from <= to)
      least = fminl(least, least_along(d, u, v, (long double[2]){xs[k], from}, (long double[2]){xs[k], to}));
    from = fmaxl(0.0L, ys[k] + low), to = fminl(dx, ys[k] + high);
    if (from <= to)
      least = fminl(least, least_along(d, u, v, (long double[2]){from, ys[k]}, (long double[2]){to, ys[k]}));
    if (!isfinite(lags[k])) continue;
    from = fmaxl(0.0L, lags[k]), to = fminl(dx, dy + lags[k]);
    if (from <= to)
      least = fminl(least,
                    least_along(d, u, v, (long double[2]){from, from - lags[k]}, (long double[2]){to, to - lags[k]}));
  }
  const long double uu = ref_dot(u, u), uv = ref_dot(u, v), vv = ref_dot(v, v), det = uu * vv - uv * uv;
  if (!(det > 1e-15L * uu * vv)) return least;
  const long double x = (uv * ref_dot(d, v) - vv * ref_dot(d, u)) / det,
                    y = (uu * ref_dot(d, v) - uv * ref_dot(d, u)) / det;
  if (x >= 0.0L && x <= dx && y >= 0.0L && y <= dy && x - y >= low && x - y <= high)
    least = fminl(least, ref_norm(ref_add(d, ref_sub(ref_scale(x, u), ref_scale(y, v)))));
  return least;
}

static long double least_of_pair(const ball *a, const ball *b, span clock) {
  span of_a[PIECES], of_b[PIECES];
  const size_t n = pieces_of(a, own_times(a, clock), of_a), m = pieces_of(b, own_times(b, clock), of_b);
  long double least = HUGE_VALL;
  for (size_t i = 0; i < n; i++)
    for (size_t k = 0; k < m; k++) {
      /* both on the clock of all, late by their tolerances together at most */
      const long double room = (long double)a->tolerance + b->tolerance;
      const long double apart = (of_b[k].from + b->start) - (of_a[i].from + a->start);
      least = fminl(least, least_of_pieces(a, b, of_a[i], of_b[k], apart - room, apart + room));
    }
  return fmaxl(least - a->radius - b->radius, 0.0L);
}

static long double least_of(const scene *s, span clock) {
  long double least = HUGE_VALL;
  for (size_t i = 0; i < s->n; i++)
    for (size_t k = i + 1; k < s->n; k++) least = fminl(least, least_of_pair(&s->balls[i], &s->balls[k], clock));
  return least;
}

static cprox_mover all_pairs(const scene *s, cprox_robot_pair pairs[3]) {
  size_t n = 0;
  for (int32_t i = 0; i < (int32_t)s->n; i++)
    for (int32_t k = i + 1; k < (int32_t)s->n; k++) pairs[n++] = (cprox_robot_pair){i, k};
  return cprox_robot_self(s->motion, pairs, n);
}

/* ---- queries ---- */

static const long double HAIR = 1e-12L; /* long double, and rounding of poses and times: a hundred times either */

/* Of the whole clock and of parts of it. */
CASE(balls_come_as_near_as_some_start_lets_them) {
  rng r = rng_seed(9101);
  size_t touching = 0, apart = 0;
  double most = 0.0;
  for (size_t i = 0; i < test_cases(600); i++) {
    scene s;
    scene_make(&r, &s);
    cprox_robot_pair pairs[3];
    const cprox_mover mover = all_pairs(&s, pairs);
    cprox_options options = CPROX_OPTIONS_DEFAULT;
    double interval[2] = {s.t0, s.t1};
    if (rng_index(&r, 2)) {
      interval[0] = rng_uniform(&r, s.t0, s.t1), interval[1] = rng_uniform(&r, interval[0], s.t1);
      options.interval = interval;
    }
    const long double exact = least_of(&s, (span){interval[0], interval[1]});
    cprox_result d = {0}, v = {0};
    const cprox_status status = distance_of_list(mover, NULL, 0, &options, ws, &d, NULL);
    if (status != CPROX_OK)
      fail_msg("case %zu: status %s (%s), %u nodes, [%.17g, %.17g]", i, cprox_status_name(status),
               cprox_workspace_error(ws), d.nodes, d.lower, d.upper);
    if (!(d.lower <= exact + HAIR && d.upper >= exact - HAIR && d.upper - d.lower <= 1.01e-6))
      fail_msg("case %zu: [%.17g, %.17g], exactly %.17Lg", i, d.lower, d.upper, exact);
    assert_true(d.t >= interval[0] && d.t <= interval[1]);
    most = fmax(most, d.nodes);
    touching += exact <= 0.0L, apart += exact > 1e-3L;
    assert_true(tolerance_of_list(mover, NULL, 0, (double)(0.9L * exact), &options, ws, &v, NULL) >= 0);
    if (exact > 1e-9L) assert_int_equal(v.verdict, CPROX_VERDICT_CLEAR);
    assert_true(tolerance_of_list(mover, NULL, 0, (double)(1.1L * exact) + 1e-5, &options, ws, &v, NULL) >= 0);
    assert_int_equal(v.verdict, CPROX_VERDICT_VIOLATED);
    /* violated by a pair that is not the nearest one */
    assert_true(tolerance_of_list(mover, NULL, 0, (double)(2.0L * exact) + 0.3, &options, ws, &v, NULL) >= 0);
    assert_int_equal(v.verdict, CPROX_VERDICT_VIOLATED);
    if (!(v.lower <= exact + HAIR))
      fail_msg("case %zu: violated, [%.17g, %.17g], exactly %.17Lg", i, v.lower, v.upper, exact);
    scene_free(&s);
  }
  print_message("%zu touch, %zu stay apart; %.0f nodes at most\n", touching, apart, most);
  assert_true(touching > 20 && apart > 100);
}

/* The first time at which some start lets two balls touch, by halving; infinity: none does. */
static long double first_contact(const scene *s) {
  if (least_of(s, (span){s->t0, s->t1}) > 0.0L) return HUGE_VALL;
  long double free = s->t0, touching = s->t1;
  if (least_of(s, (span){s->t0, s->t0}) <= 0.0L) return s->t0;
  for (int i = 0; i < 60; i++) {
    const long double middle = 0.5L * (free + touching);
    if (least_of(s, (span){s->t0, middle}) <= 0.0L)
      touching = middle;
    else
      free = middle;
  }
  return touching;
}

CASE(contact_is_told_as_early_as_some_start_makes_it) {
  rng r = rng_seed(9102);
  size_t touching = 0;
  double late = 0.0;
  for (size_t i = 0; i < test_cases(300); i++) {
    scene s;
    scene_make(&r, &s);
    cprox_robot_pair pairs[3];
    const long double exact = first_contact(&s), clearance = least_of(&s, (span){s.t0, s.t1});
    cprox_result c = {0};
    const cprox_status status = time_of_contact_of_list(all_pairs(&s, pairs), NULL, 0, NULL, ws, &c);
    if (status < 0) fail_msg("case %zu: %s", i, cprox_workspace_error(ws));
    if (exact < HUGE_VALL) {
      assert_int_not_equal(c.verdict, CPROX_VERDICT_CLEAR);
      if (!(c.t_contact_lower <= exact + HAIR))
        fail_msg("case %zu: contact at %.17Lg, none was said before %.17g", i, exact, c.t_contact_lower);
      if (c.verdict == CPROX_VERDICT_VIOLATED && !(c.t >= exact - HAIR))
        fail_msg("case %zu: contact at %.17Lg, was said at %.17g", i, exact, c.t);
      /* within epsilon of contact: grazes may be early */
      late = fmax(late, (double)(exact - c.t_contact_lower));
      touching++;
    } else if (clearance > 1e-6L) {
      assert_int_equal(c.verdict, CPROX_VERDICT_CLEAR);
    }
    scene_free(&s);
  }
  print_message("%zu touch; %.3g s early at most\n", touching, late);
  assert_true(touching > 20 && late < 1e-2);
}

/* Of one ball against another that stands. */
CASE(contact_with_what_stands_is_told_as_early) {
  rng r = rng_seed(9107);
  size_t touching = 0;
  double early = 0.0;
  for (size_t i = 0; i < test_cases(300); i++) {
    scene s = {.n = 1};
    ball *b = s.balls;
    ball_make(&r, &b[0]);
    b[0].tolerance = rng_index(&r, 2) ? 0.125 : 2.0;
    const cprox_robot *robot = b[0].robot;
    assert_int_equal(cprox_robot_join(&robot, NULL, 1, ws, &s.robot), CPROX_OK);
    assert_int_equal(join(&s, &s.motion), CPROX_OK);
    const cprox_motion_info info = cprox_motion_get_info(s.motion);
    s.t0 = info.t0, s.t1 = info.t1;

    b[1] = b[0], b[1].tolerance = 0.0;
    const double *near = b[0].values[rng_index(&r, POINTS)], x = near[0] + rng_uniform(&r, -0.3, 0.3);
    for (size_t k = 0; k < POINTS; k++) b[1].values[k][0] = x, b[1].values[k][1] = near[1], b[1].values[k][2] = near[2];
    const cprox_obstacle target =
        cprox_obstacle_at(b[0].body, (cprox_pose){.position = {x, near[1], near[2]}, .orientation = {.w = 1.0}});
    s.n = 2;
    const long double exact = first_contact(&s);
    s.n = 1;
    cprox_result c = {0};
    assert_true(time_of_contact_of_list(cprox_robot_along(s.motion, NULL, 0), &target, 1, NULL, ws, &c) >= 0);
    if (exact < HUGE_VALL) {
      touching++;
      early = fmax(early, (double)(exact - c.t_contact_lower)); /* grazes may be early */
      if (!(c.verdict != CPROX_VERDICT_CLEAR && c.t_contact_lower <= exact + HAIR && c.t >= c.t_contact_lower))
        fail_msg("case %zu: contact at %.17Lg, was said in [%.17g, %.17g]", i, exact, c.t_contact_lower, c.t);
      if (c.verdict == CPROX_VERDICT_VIOLATED) assert_true(c.t >= exact - HAIR && c.t <= exact + 1e-3);
    }
    scene_free(&s);
  }
  print_message("%zu touch; %.3g s early at most\n", touching, early);
  assert_true(touching > 100 && early < 1e-2);
}

/* What is possible at one time. */
static long double least_at(const scene *s, long double t) {
  return least_of(s, (span){t, t});
}

CASE(violations_are_all_times_at_which_some_start_allows_one) {
  enum { ROOM = 64, SAMPLES = 100 };
  rng r = rng_seed(9103);
  size_t inside = 0, certain = 0;
  for (size_t i = 0; i < test_cases(60); i++) {
    scene s;
    scene_make(&r, &s);
    cprox_robot_pair pairs[3];
    const double delta = rng_uniform(&r, 0.0, 0.4);
    cprox_violation room[ROOM];
    cprox_violations found = {room, ROOM, 0};
    cprox_options options = CPROX_OPTIONS_DEFAULT;
    options.max_nodes = 10 * options.max_nodes; /* one budget for the whole list */
    const cprox_status status =
        violations_of_list(all_pairs(&s, pairs), NULL, 0, delta, 1e-3 * (s.t1 - s.t0), &options, ws, &found);
    if (status != CPROX_OK) fail_msg("case %zu: %s", i, cprox_workspace_error(ws));
    for (int k = 0; k <= SAMPLES; k++) {
      const long double t = fminl(s.t0 + ((long double)s.t1 - s.t0) * k / SAMPLES, s.t1), d = least_at(&s, t);
      bool may = false, must = false;
      for (size_t v = 0; v < found.count; v++) {
        may = may || (t >= room[v].enter_lower && t <= room[v].leave_upper);
        must = must || (room[v].verdict == CPROX_VERDICT_VIOLATED && room[v].enter_upper < room[v].leave_lower &&
                        t >= room[v].enter_upper && t <= room[v].leave_lower);
      }
      if (!may && !(d > delta - HAIR)) fail_msg("case %zu: %.17Lg at %.17Lg, delta %.17g", i, d, t, delta);
      if (must && !(d <= delta + HAIR)) fail_msg("case %zu: %.17Lg at %.17Lg, delta %.17g", i, d, t, delta);
      inside += d <= delta, certain += must;
    }
    scene_free(&s);
  }
  print_message("%zu places within delta, %zu of them certain\n", inside, certain);
  assert_true(inside > 10 * test_cases(60) && certain > inside / 2);
}

/* Two balls side by side: as far apart whatever the start is. One plane says it. */
CASE(parallel_paths_take_few_nodes) {
  scene s = {.n = 2};
  const cprox_robot *robots[2];
  rng r = rng_seed(9104);
  for (size_t i = 0; i < 2; i++) {
    ball *b = &s.balls[i];
    ball_make(&r, b);
    cprox_motion_free(b->motion);
    cprox_waypoint points[POINTS];
    for (size_t k = 0; k < POINTS; k++) {
      b->values[k][0] = b->times[k], b->values[k][1] = (double)i, b->values[k][2] = 0.0;
      points[k] = (cprox_waypoint){.time = b->times[k], .positions = b->values[k]};
    }
    static const int32_t ALL[3] = {0, 1, 2};
    const cprox_motion_description d = {.variables = ALL, .n_variables = 3, .waypoints = points, .n_waypoints = POINTS};
    assert_int_equal(cprox_motion_create(b->robot, &d, ws, &b->motion), CPROX_OK);
    b->tolerance = i == 0 ? 0.0 : INFINITY;
    robots[i] = b->robot;
  }
  assert_int_equal(cprox_robot_join(robots, NULL, 2, ws, &s.robot), CPROX_OK);
  assert_int_equal(join(&s, &s.motion), CPROX_OK);
  cprox_robot_pair pairs[3];
  cprox_result d = {0};
  assert_int_equal(distance_of_list(all_pairs(&s, pairs), NULL, 0, NULL, ws, &d, NULL), CPROX_OK);
  const double exact = 1.0 - s.balls[0].radius - s.balls[1].radius;
  assert_true(d.lower <= exact + 1e-12 && d.upper >= exact - 1e-12);
  if (d.nodes > 60) fail_msg("%u nodes", d.nodes);
  scene_free(&s);
}

/* What answers for known starts alone says so. */
CASE(there_is_no_gradient_and_no_certificate) {
  rng r = rng_seed(9106);
  scene s;
  do {
    scene_make(&r, &s);
    if (s.balls[0].tolerance > 0.0) break;
    scene_free(&s);
  } while (true);
  cprox_robot_pair pairs[3];
  const cprox_mover mover = all_pairs(&s, pairs);
  cprox_result result = {0};
  double variables[3 * MOST_BALLS];
  cprox_motion_gradient gradient = {.variables = variables};
  assert_int_equal(cprox_robot_distance_gradient(NULL, mover, NULL, ws, &result, &gradient), CPROX_INVALID);
  assert_string_equal(cprox_workspace_error(ws), "there is no gradient where starts have tolerances");
  cprox_certificate *certificate = cprox_certificate_create();
  assert_int_equal(certify_of_list(mover, NULL, 0, 0.0, NULL, NULL, ws, certificate), CPROX_INVALID);
  assert_non_null(strstr(cprox_workspace_error(ws), "no certificates: starts with a tolerance"));
  cprox_certificate_free(certificate);

  /* nor can it be joined again */
  const cprox_robot *robots[1] = {s.robot};
  const cprox_joined_motion again[1] = {{s.motion, 0.0, 0.0}};
  const cprox_motion_description d = {.kind = CPROX_MOTION_JOINED, .joined = again, .n_joined = 1};
  cprox_robot *robot = NULL;
  cprox_motion *motion = NULL;
  assert_int_equal(cprox_robot_join(robots, NULL, 1, ws, &robot), CPROX_OK);
  assert_int_equal(cprox_motion_create(robot, &d, ws, &motion), CPROX_INVALID);
  assert_string_equal(cprox_workspace_error(ws), "motion 0 has a start with a tolerance: join all at once");
  assert_null(motion);
  cprox_robot_free(robot);
  scene_free(&s);
}

/* ---- two times ---- */

/* Nothing that is possible is taken off, what is left has a possible middle, and the corners contain all of it. */
CASE(what_is_possible_stays_within_the_corners) {
  rng r = rng_seed(9105);
  size_t inside = 0, cut = 0;
  for (size_t i = 0; i < test_cases(20000); i++) {
    const double most = rng_log_uniform(&r, 1e-3, 10), size = rng_log_uniform(&r, 1e-3, 10);
    start_times whole, fit;
    for (int side = 0; side < 2; side++) {
      double *of = side ? whole.other : whole.lead;
      of[0] = rng_uniform(&r, -size, size), of[1] = of[0] + rng_uniform(&r, 0.0, size);
    }
    fit = whole;
    const bool any = start_times_fit(&fit, most);
    double corners[START_CORNERS][2];
    const size_t n = any ? start_times_corners(&fit, most, corners) : 0;
    cut += n > 4;
    const double w = fit.lead[1] - fit.lead[0], h = fit.other[1] - fit.other[0];
    if (any) {
      const double apart = 0.5 * (fit.lead[0] + fit.lead[1]) - 0.5 * (fit.other[0] + fit.other[1]);
      assert_true(fabs(apart) <= most * (1.0 + 1e-12) + 1e-12 * size);
    }
    for (int k = 0; k < 20; k++) {
      const double x = whole.lead[0] + rng_uniform(&r, 0, 1) * (whole.lead[1] - whole.lead[0]);
      double y = whole.other[0] + rng_uniform(&r, 0, 1) * (whole.other[1] - whole.other[0]);
      if (k % 2) y = fmin(fmax(y, x - most), x + most); /* on the edge of what is possible */
      if (fabs(x - y) > most || y < whole.other[0] || y > whole.other[1]) continue;
      assert_true(any && x >= fit.lead[0] && x <= fit.lead[1] && y >= fit.other[0] && y <= fit.other[1]);
      if (w < 1e-9 || h < 1e-9) continue;
      const double u = (x - fit.lead[0]) / w - 0.5, v = (y - fit.other[0]) / h - 0.5;
      inside++;
      for (int direction = 0; direction < 16; direction++) {
        const double a = cos(direction * 0.3927), b = sin(direction * 0.3927);
        double least = INFINITY;
        for (size_t c = 0; c < n; c++) least = fmin(least, a * corners[c][0] + b * corners[c][1]);
        if (!(a * u + b * v >= least - 1e-9)) fail_msg("case %zu: (%g, %g) is outside of the corners", i, u, v);
      }
    }
  }
  print_message("%zu places, %zu polygons with a corner cut off\n", inside, cut);
  assert_true(inside > 10000 && cut > 500);
}

int main(void) {
  return cases_run(workspace_setup, workspace_teardown);
}
