/* SPDX-License-Identifier: BSD-3-Clause */
#include "robot_query/settle_flight.h"

#include <math.h>

#include "base/rounding.h"
#include "robot_query/flight.h"
#include "robot_query/measure.h"

/* Bounds may be off by this part of the width asked for. */
static const double BOUND_FRACTION = 0.01;

/* As elsewhere: normals that turn faster than this over an interval are taken to stand still. */
static const double FASTEST_NORMAL_RATE = 0.5;

/* Of a pair that is too far to matter only so much of the excess need be known. */
static const double EXCESS_FRACTION = 0.05;

/* An interval of x, inside the node. */
typedef struct stretch {
  double from, to;
  double lower;
  double lowest; /* x where to look */
} stretch;

/* Of an interval: places that are nearer to each other, or to an end, are one. */
static const double SAME_PLACE = 1e-9;

enum { MOST_STRETCHES = 64, FEW_STRETCHES = 4 };

typedef struct settling {
  robot_search *o;
  int32_t pair;
  flight f;
  robot_gap gap; /* at x, measured last */
  double x;
  flight_plane plane; /* the last one */
  bool may_turn;      /* how fast it turns was not looked at */
  double slack;
} settling;

static bool begin(settling *s, robot_search *o, const search_node *node, int32_t index) {
  const robot_scene *scene = &o->scene;
  const robot_pair *pair = &scene->pairs[index];
  const motion_interval over = robot_interval(node);
  const robot_body *const body[2] = {&scene->parts[pair->moving].body, pair->self ? &scene->parts[pair->standing].body
                                                                                  : &scene->obstacles[pair->standing]};
  s->o = o, s->pair = index;
  if (!flight_begin(&s->f, scene->motion, body, pair->self, &over, BOUND_FRACTION * o->goal.epsilon,
                    scene->q->workspace))
    return false;
  s->slack = s->f.error;
  return true;
}

/* One more interval counts like a node; false where the budget has none left. */
static bool take_interval(robot_search *o) {
  if (robot_must_end(o)) return false;
  o->flights++;
  return true;
}

/* ---- measuring ---- */

static double u_of(const flight *f, double x) {
  return x >= 1.0 ? f->b : f->a + (f->b - f->a) * x;
}

static vec3 known_direction(const settling *s) {
  const robot_pair *pair = &s->o->scene.pairs[s->pair];
  return pair->normal_known ? pair->normal : vec(0, 0, 0);
}

static cprox_status measure(settling *s, double x, double fraction) {
  robot_search *o = s->o;
  flight_place(&s->f, x);
  const robot_accuracy accuracy = {.epsilon = ROBOT_GAP_FRACTION * o->goal.epsilon,
                                   .floor = robot_pruning_bound(o),
                                   .fraction = fraction,
                                   .start = known_direction(s),
                                   .depth = o->goal.is_signed};
  s->x = x;
  return robot_measure_placed(o, s->pair, &s->f.body[0], &s->f.body[1], accuracy, s->f.segment, u_of(&s->f, x),
                              &s->gap);
}

/* ---- rates ---- */

/* How the moving side moves as the standing one sees it, and how the standing one turns, by x. */
static chain_motion rates_at(const flight *f, double x, vec3 *turn) {
  static const double STEP = 1e-5;
  placement at[2][2];
  const double from = x > 0.5 ? x - 2.0 * STEP : x, to = from + 2.0 * STEP;
  vec3 v[2], omega[2] = {vec(0, 0, 0), vec(0, 0, 0)};
  for (int k = 0; k < 2; k++) {
    v[k] = vec(0, 0, 0);
    if (k == 1 && !f->rides) continue;
    at[0][k] = pose_chain_at(&f->chain[k], f->segment, u_of(f, from));
    at[1][k] = pose_chain_at(&f->chain[k], f->segment, u_of(f, to));
    v[k] = vec_scale(0.5 / STEP, vec_sub(at[1][k].p, at[0][k].p));
    /* (R1 - R0) R0^T is about [omega] times the step */
    const double *r = at[0][k].r, *q = at[1][k].r;
    double w[9];
    for (int i = 0; i < 3; i++)
      for (int j = 0; j < 3; j++)
        w[3 * i + j] = q[3 * i] * r[3 * j] + q[3 * i + 1] * r[3 * j + 1] + q[3 * i + 2] * r[3 * j + 2];
    omega[k] = vec_scale(0.25 / STEP, vec(w[7] - w[5], w[2] - w[6], w[3] - w[1]));
  }
  *turn = omega[1];
  const vec3 apart = vec_sub(f->body[0].side.at.p, f->body[1].side.at.p);
  return (chain_motion){.v = vec_sub(vec_sub(v[0], v[1]), vec_cross(omega[1], apart)),
                        .omega = vec_sub(omega[0], omega[1])};
}

/* The plane of the gap measured last. */
static void plane_of_gap(settling *s) {
  const vec3 n = s->gap.normal;
  flight_plane_make(&s->f, vec_scale(1.0 / vec_norm(n), n), s->x, &s->plane);
  s->may_turn = !robot_body_is_halfspace(&s->f.body[1]);
}

/* Lets it turn as its feature does. Both bodies stand where it was measured. */
static void turn_plane(settling *s) {
  vec3 turn;
  const flight *f = &s->f;
  const chain_motion motion = rates_at(f, s->x, &turn);
  const vec3 n = s->plane.n;
  vec3 rate = vec_add(robot_pair_normal_rate(&s->gap, &f->body[0], &f->body[1], &motion), vec_cross(turn, n));
  rate = vec_axpy(rate, -vec_dot(rate, n), n);
  s->may_turn = false;
  if (vec_finite(rate) && vec_norm2(rate) > 0.0) flight_plane_turn(f, rate, &s->plane);
}

/* ---- Newton's method ---- */

/* A polynomial by its Bernstein coefficients, with two derivatives: the scheme of base/bernstein.h as far as its row of
 * three. */
static void polynomial_at(const double *c, size_t n, double x, double value[3]) {
  double v[POSE_FIT_POINTS] = {0.0};
  for (size_t i = 0; i <= n; i++) v[i] = c[i];
  for (size_t j = 1; j <= n; j++)
    for (size_t i = j; i > 0 && j - i + 2 < n; i--) v[i - 1] += x * (v[i] - v[i - 1]);
  value[2] = (double)(n * (n - 1)) * (v[2] - 2.0 * v[1] + v[0]);
  value[1] = (double)n * ((1.0 - x) * (v[1] - v[0]) + x * (v[2] - v[1]));
  value[0] = (1.0 - x) * ((1.0 - x) * v[0] + x * v[1]) + x * ((1.0 - x) * v[1] + x * v[2]);
}

/* The distance along the plane's own normal of the two points that are nearest now, as both move. */
static void nearest_points_move(const settling *s, double *c) {
  const vec3 point[2] = {s->gap.on_moving, s->gap.on_standing};
  for (int k = 0; k < 2; k++) {
    const placement *at = &s->f.body[k].side.at;
    if (k == 1 && !s->f.rides) continue;
    const vec3 own = placement_turn_back(at, vec_sub(point[k], at->p));
    for (size_t j = 0; j <= s->f.basis->degree; j++) {
      const double *row = s->plane.rows[k].c[j];
      const double along = row[0] * own.x + row[1] * own.y + row[2] * own.z + row[3];
      c[j] = k == 0 ? along : c[j] - along;
    }
  }
}

/* From the gap measured last to the nearest place of the distance's local minimum, in [from, to]; the gap measured last
 * is then the least one. */
static cprox_status refine(settling *s, double from, double to) {
  enum { ROUNDS = 5, STEPS = 8 };
  robot_search *o = s->o;
  double low = from, high = to, last_slope = 0.0, last_x = NAN;
  for (int round = 0; round < ROUNDS; round++) {
    if (robot_is_answered(o) || !(s->gap.upper > 0.0 || o->goal.is_signed)) return CPROX_OK;
    double c[POSE_FIT_POINTS], at[3];
    nearest_points_move(s, c);
    polynomial_at(c, s->f.basis->degree, s->x, at);
    const double slope = at[1], enough = 0.2 * o->goal.epsilon;
    if (fabs(slope) * (to - from) <= enough) return CPROX_OK;
    if (slope > 0.0)
      high = s->x;
    else
      low = s->x;

    /* the turning plane bends the distance along the normal, too; later, what two slopes say */
    double bend = 0.0;
    if (round > 0 && last_x != s->x) bend = (slope - last_slope) / (s->x - last_x) - at[2];
    double x = s->x;
    for (int k = 0; k < STEPS; k++) {
      double here[3];
      polynomial_at(c, s->f.basis->degree, x, here);
      const double fall = here[1] + bend * (x - s->x), curve = here[2] + bend;
      double next = curve > 0.0 ? x - fall / curve : fall > 0.0 ? low : high;
      next = lesser(greater(next, low), high);
      if (fabs(next - x) <= SAME_PLACE * (to - from)) {
        x = next;
        break;
      }
      x = next;
    }
    if (fabs(x - s->x) <= SAME_PLACE * (to - from)) return CPROX_OK;
    last_slope = slope, last_x = s->x;
    const robot_gap before = s->gap;
    const cprox_status status = measure(s, x, 0.0);
    if (status < 0) return status;
    if (s->gap.upper > before.upper + before.slack && round + 1 == ROUNDS) {
      s->x = last_x, s->gap = before; /* no better: stay there */
      flight_place(&s->f, s->x);
      return CPROX_OK;
    }
    plane_of_gap(s);
  }
  return CPROX_OK;
}

/* ---- intervals ---- */

/* The best of what a plane says that stands, and that turns. */
static flight_bound bound_by(settling *s, double from, double to, double level) {
  const double goal = robot_pruning_bound(s->o);
  flight_bound bound, turned;
  s->o->planes++;
  flight_bound_over(&s->f, &s->plane, false, from, to, goal, level, &bound);
  if (robot_is_pruned(s->o, bound.lower)) return bound;
  if (s->may_turn) turn_plane(s);
  const double speed = vec_norm(s->plane.rate) * greater(fabs(from - s->plane.at), fabs(to - s->plane.at));
  if (!(speed > 0.0 && speed < FASTEST_NORMAL_RATE)) return bound;
  flight_bound_over(&s->f, &s->plane, true, from, to, goal, level, &turned);
  if (turned.lower > bound.lower) bound.lower = turned.lower, bound.lowest = turned.lowest, bound.slack = turned.slack;
  bound.clear = greater(turned.clear, bound.clear);
  return bound;
}

/* Where the pair's balls and boxes come nearest, as far as the poses tell. */
static double promising(settling *s) {
  flight *f = &s->f;
  double least = INFINITY, x = 0.5;
  for (size_t i = 0; i <= f->basis->degree; i++) {
    for (int k = 0; k <= f->rides; k++) f->body[k].side.at = f->fit[k].at[i];
    const double apart = robot_pair_ball_distance(&f->body[0], &f->body[1]);
    if (apart < least) least = apart, x = f->basis->x[i];
  }
  return x;
}

static size_t least_of(const stretch *all, size_t n) {
  size_t least = 0;
  for (size_t i = 1; i < n; i++)
    if (all[i].lower < all[least].lower) least = i;
  return least;
}

static double well_inside(double x) {
  return lesser(greater(x, 0.125), 0.875);
}

/* One interval: measured where it may be nearest, cut there, both parts bounded. */
static cprox_status work_on(settling *s, const stretch *whole, stretch part[2]) {
  robot_search *o = s->o;
  part[0] = part[1] = *whole;
  const cprox_status status = measure(s, whole->lowest, EXCESS_FRACTION);
  if (status < 0 || robot_is_answered(o)) return status;
  const bool apart = vec_norm2(s->gap.normal) > 0.0 && (s->gap.upper > 0.0 || o->goal.is_signed);
  if (apart) {
    plane_of_gap(s);
    /* the least one so far: is there less beside it? */
    if (s->gap.upper <= o->best_bound.upper && o->goal.limit < 0.0) {
      const cprox_status refined = refine(s, whole->from, whole->to);
      if (refined < 0) return refined;
    }
  }
  const double width = whole->to - whole->from;
  const bool inside = s->x > whole->from + SAME_PLACE * width && s->x < whole->to - SAME_PLACE * width;
  const double ends[3] = {whole->from, inside ? s->x : 0.5 * (whole->from + whole->to), whole->to};
  for (int k = 0; k < 2; k++) {
    stretch *c = &part[k];
    *c = (stretch){.from = ends[k], .to = ends[k + 1], .lower = whole->lower};
    c->lowest = 0.5 * (c->from + c->to);
    if (!apart) continue;
    const flight_bound bound = bound_by(s, c->from, c->to, 0.0);
    if (bound.lower > c->lower) c->lower = bound.lower;
    c->lowest = c->from + (c->to - c->from) * well_inside(bound.lowest);
    s->slack = greater(bound.slack, s->slack);
  }
  return CPROX_OK;
}

/* Best first. */
static cprox_status settle(settling *s, size_t most, double *lower) {
  robot_search *o = s->o;
  const robot_pair *pair = &o->scene.pairs[s->pair];
  stretch all[MOST_STRETCHES + 1] = {{.from = 0.0, .to = 1.0, .lower = -INFINITY, .lowest = NAN}};
  size_t n = 1;
  if (pair->normal_known && !s->f.rides) {
    const vec3 known = placement_turn(&s->f.body[1].side.at, pair->normal);
    flight_plane_make(&s->f, vec_scale(1.0 / vec_norm(known), known), 0.5, &s->plane);
    s->may_turn = false;
    const flight_bound bound = bound_by(s, 0.0, 1.0, 0.0);
    all[0].lower = bound.lower, all[0].lowest = well_inside(bound.lowest);
  }
  *lower = INFINITY;
  for (size_t count = 0; n > 0; count++) {
    const size_t least = least_of(all, n);
    stretch top = all[least];
    if (robot_is_pruned(o, top.lower) || search_is_unresolved(&o->goal, &o->best_bound, top.lower, s->slack)) break;
    if (count >= most || n + 1 > MOST_STRETCHES || (count > 0 && !take_interval(o))) break;
    if (isnan(top.lowest)) top.lowest = promising(s);
    all[least] = all[--n];
    stretch part[2];
    const cprox_status status = work_on(s, &top, part);
    if (status < 0) return status;
    for (int k = 0; k < 2; k++) {
      if (robot_is_pruned(o, part[k].lower))
        *lower = lesser(part[k].lower, *lower);
      else
        all[n++] = part[k];
    }
    if (robot_is_answered(o)) break;
  }
  for (size_t i = 0; i < n; i++) *lower = lesser(all[i].lower, *lower);
  return CPROX_OK;
}

/* From left to right: *from becomes the x up to which the distance is clear of the limit. */
static cprox_status advance(settling *s, double *from, double *lower) {
  enum { ROUNDS = 24 };
  static const double LEAST_PROGRESS = 1e-9;
  robot_search *o = s->o;

  /* where two come within half of epsilon of the limit they are measured to be within epsilon */
  const double near = o->goal.limit + o->goal.epsilon, level = o->goal.limit + 0.5 * o->goal.epsilon;
  *from = 0.0, *lower = -INFINITY;
  for (int round = 0; round < ROUNDS; round++) {
    if (round > 0 && !take_interval(o)) break;
    const cprox_status status = measure(s, *from, EXCESS_FRACTION);
    if (status < 0) return status;
    if (s->gap.upper <= near || !(vec_norm2(s->gap.normal) > 0.0)) break;
    plane_of_gap(s);
    const flight_bound bound = bound_by(s, *from, 1.0, level);
    s->slack = bound.slack;
    if (robot_is_pruned(o, bound.lower)) {
      *lower = bound.lower;
      break;
    }
    /* places in the segment are rounded */
    const double next = *from + bound.clear * (1.0 - *from) - 8.0 * ROUND_U / (s->f.b - s->f.a);
    if (!(next - *from > LEAST_PROGRESS)) break;
    o->dropped = lesser(level, o->dropped);
    *from = next;
  }
  return CPROX_OK;
}

/* ---- a node ---- */

static bool is_one_flight(robot_search *o, const search_node *node, int32_t *pair) {
  const int32_t list = robot_known(node)->list;
  const motion_interval over = robot_interval(node);
  /* among several pairs a node of one segment would be ahead of spans, which have no control poses */
  if (o->scene.n_pairs - o->n_standing != 1 || o->scene.groups || o->scene.q->set ||
      robot_scene_has_two_times(&o->scene) || o->scene.q->errors) /* their margins change over the node */
    return false;
  if (lists_count(&o->lists, list) != 1 || motion_is_span(&over) || o->scene.motion->is_state) return false;
  *pair = lists_at(&o->lists, list)->pair;
  if (*pair < 0 || !robot_pair_is_whole(&o->scene.pairs[*pair])) return false;

  /* where a side turns about its own axis little is left to bound */
  placed_robot_pair placed;
  robot_scene_enter_both(&o->scene, &over, &over);
  placed_robot_pair_at(&o->scene, *pair, &placed);
  return !(placed_robot_pair_round_displacement(&placed) <= 0.25 * o->goal.epsilon);
}

cprox_status robot_bound_flight(robot_search *o, search_node *node, bool *served) {
  settling s;
  int32_t pair;
  *served = is_one_flight(o, node, &pair) && begin(&s, o, node, pair);
  if (!*served) return CPROX_OK;
  double lower, from = 0.0;
  /* what is beyond the least distance cannot be settled where that is */
  const size_t most = o->goal.beyond > 0.0 ? FEW_STRETCHES : MOST_STRETCHES;
  const bool in_time = o->goal.order == SEARCH_LEFT_TO_RIGHT;
  const cprox_status status = in_time ? advance(&s, &from, &lower) : settle(&s, most, &lower);
  if (status < 0) return status;
  node->slack = s.slack;
  if (!robot_is_answered(o)) node->lower = greater(lower, node->lower);
  if (from > 0.0) {
    robot_node *payload = robot_own(node);
    payload->a = greater(u_of(&s.f, from), payload->a);
    payload->other_a = payload->a;
    const double start = motion_time_below(o->scene.motion, payload->first, payload->a);
    node->start = robot_scene_clock(&o->scene, start, start);
  }
  return CPROX_OK;
}
