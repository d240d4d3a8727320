/* SPDX-License-Identifier: BSD-3-Clause */
/* Everything with everything: curves of every family, points, balls and bodies on them, bodies of every kind, curves
 * and other moving objects as obstacles, every query, scales from 1e-6 to 1e6 m, up to 1e6 scales from the origin,
 * every accuracy and budget.
 *
 * Held against scenes.h. A lower bound must not be above a distance that is found at any parameter; at the parameter of
 * an upper bound the distance must not be above it, and the witness points must lie in both and be as near; verdicts
 * must follow from that; a status ok promises the width. Not a number, more intervals than the budget and results of a
 * failed call are faults. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "scenes.h"
#include "support/of_list.h"

typedef struct query {
  attack *a;
  rng *r;
  scene s;
  cprox_options options;
  const char *query;
} query;

#define RESULT "[%.17g, %.17g] (%s, %s) at t = %.17g"
#define SHOWN(x) (x)->lower, (x)->upper, cprox_status_name((x)->status), cprox_verdict_name((x)->verdict), (x)->t

/* ---- what holds of every result ---- */

static bool numbers_are_sound(query *q, const cprox_result *x, size_t targets) {
  const bool numbers = x->lower <= x->upper && !isnan(x->t) && isfinite(x->t_contact_lower) && vec_finite(x->normal) &&
                       (isinf(x->upper) || (vec_finite(x->witness_mover) && vec_finite(x->witness_obstacle)));
  attack_check(q->a, numbers, "%s: " RESULT " is not sound", q->query, SHOWN(x));
  const size_t most = (targets + 1) * ((size_t)q->options.max_nodes + 2) +
                      cprox_curve_get_info(q->s.path.curve).n_pieces * (targets + 1);
  return attack_check(q->a, x->nodes <= most, "%s: %u intervals with a budget of %u", q->query, x->nodes,
                      q->options.max_nodes);
}

/* The smallest distance from obstacle i that is found, and that lower is not above it. */
static void check_lower(query *q, size_t i, const cprox_result *x, double t0, double t1) {
  double where;
  const long double least = scene_least(&q->s, i, q->r, x->t, t0, t1, &where), room = scene_room(&q->s, i);
  const long double cut = q->options.signed_distance ? least : fmaxl(0.0L, least);
  attack_check(q->a, (long double)x->lower <= cut + room,
               "%s: " RESULT ", lower is above %.19Lg at t = %.17g, by %.3Lg (obstacle %zu: %s)", q->query, SHOWN(x),
               cut, where, (long double)x->lower - cut, i, q->s.obstacles[i].body.name);
}

/* The least over t and what its rounding may stand for; jumps belong to both sides. Where a curve goes through a flat
 * body no double need be a parameter at which they meet: the least is searched for between doubles, too. */
static long double distance_about(query *q, size_t i, double t, double at) {
  const scene *s = &q->s;
  const long double t0 = s->path.t0, t1 = s->path.t1;
  long double least = HUGE_VALL, best = t, width = 0.5L * scene_step(&s->path);
  for (int k = -2; k <= 2; k++) {
    const long double there = fmaxl(t0, fminl(t1, t + k * width));
    const long double d = scene_distance(s, i, there, at);
    if (d < least) least = d, best = there;
  }
  enum { HALVINGS = 10 };
  for (int step = 0; step < HALVINGS; step++) {
    width *= 0.5L;
    const long double middle = best;
    for (int side = -1; side <= 1; side += 2) {
      const long double there = fmaxl(t0, fminl(t1, middle + side * width));
      const long double d = scene_distance(s, i, there, at);
      if (d < least) least = d, best = there;
    }
  }
  return least;
}

static void check_witness(query *q, size_t i, const cprox_result *x) {
  const scene *s = &q->s;
  const long double room = scene_witness_room(s, i);
  const double step = scene_step(&s->path);
  long double off = HUGE_VALL, off_obstacle = HUGE_VALL;
  for (int k = -1; k <= 1; k++) {
    const double t = fmax(s->path.t0, fmin(s->path.t1, x->t + k * step));
    off = fminl(off, scene_off_mover(s, t, ref_vec(x->witness_mover)));
    /* where an obstacle is a curve that jumps, both limits belong to it */
    const double either[2] = {x->t_obstacle, nextafter(x->t_obstacle, -INFINITY)};
    for (int side = 0; side < 2; side++)
      off_obstacle = fminl(off_obstacle, scene_off_obstacle(s, i, t, either[side], ref_vec(x->witness_obstacle)));
  }
  const long double apart = ref_norm(ref_sub(ref_vec(x->witness_mover), ref_vec(x->witness_obstacle)));
  attack_check(q->a, off <= room, "%s: " RESULT ", witness_mover is %.3Lg off", q->query, SHOWN(x), off);
  attack_check(q->a, off_obstacle <= room, "%s: " RESULT ", witness_obstacle is %.3Lg off obstacle %zu: %s", q->query,
               SHOWN(x), off_obstacle, i, q->s.obstacles[i].body.name);
  if (x->lower >= 0.0)
    attack_check(q->a, apart <= x->upper + room, "%s: " RESULT ", the witness points are %.17Lg apart", q->query,
                 SHOWN(x), apart);
}

static void check_upper(query *q, size_t i, const cprox_result *x) {
  const scene *s = &q->s;
  if (isinf(x->upper)) return;
  attack_check(q->a, x->t >= s->path.t0 && x->t <= s->path.t1, "%s: " RESULT " is not on the curve", q->query,
               SHOWN(x));
  if (attack_failed(q->a)) return;
  /* by the reference alone where it is exact, and there a pose of twice 2^-53 is not counted as an error */
  if (scene_is_exact(s, i)) {
    long double d = distance_about(q, i, x->t, x->t_obstacle);
    if (!q->options.signed_distance) d = fmaxl(0.0L, d);
    /* that it goes through is proven of the curve, but where of its pieces */
    const long double pieces = x->upper == 0.0 ? cprox_curve_get_info(s->path.curve).error : 0.0L;
    attack_check(q->a, d <= x->upper + pieces + scene_room(s, i),
                 "%s: " RESULT ", but there it is %.19Lg, above by %.3Lg (obstacle %zu: %s)", q->query, SHOWN(x), d,
                 d - (long double)x->upper, i, q->s.obstacles[i].body.name);
  }
  if (!q->options.signed_distance || x->upper > 0.0) check_witness(q, i, x);
}

static double width_asked(const query *q, double upper) {
  return fmax(q->options.epsilon, q->options.relative_epsilon * fabs(upper));
}

/* Of one obstacle alone, over [t0, t1]. */
static void check_one(query *q, size_t i, const cprox_result *x) {
  if (!numbers_are_sound(q, x, 1)) return;
  check_lower(q, i, x, q->s.path.t0, q->s.path.t1);
  check_upper(q, i, x);
}

/* Of the union: lower holds for all, upper for the one that is named. */
static void check_all(query *q, const cprox_result *x) {
  if (!numbers_are_sound(q, x, q->s.n)) return;
  for (size_t i = 0; i < q->s.n; i++) check_lower(q, i, x, q->s.path.t0, q->s.path.t1);
  if (isinf(x->upper)) return;
  const bool named = x->obstacle_index >= 0 && (size_t)x->obstacle_index < q->s.n;
  if (attack_check(q->a, named, "%s: " RESULT " names target %d of %zu", q->query, SHOWN(x), x->obstacle_index, q->s.n))
    check_upper(q, (size_t)x->obstacle_index, x);
}

static void check_width(query *q, const cprox_result *x) {
  if (x->status != CPROX_OK) {
    attack_count(q->a, cprox_status_name(x->status));
    return;
  }
  const double width = width_asked(q, x->upper);
  attack_check(q->a, x->upper - x->lower <= width * (1.0 + 1e-12), "%s: " RESULT " is wider than %.17g", q->query,
               SHOWN(x), width);
}

/* Refusals are for bodies and curves that the queries' headers name, each with a message. */
static bool answered(query *q, cprox_status status) {
  if (status >= 0) return true;
  const char *reason = cprox_workspace_error(q->a->ws);
  attack_check(q->a, reason[0], "%s: %s without a reason", q->query, cprox_status_name(status));
  char said[90];
  const char *last = strrchr(reason, ':');
  snprintf(said, sizeof said, "%s: %s", "refused", last ? last + 2 : reason);
  attack_count(q->a, said);
  return false;
}

/* ---- the queries ---- */

static void ask_distance(query *q) {
  cprox_result x, each[SCENE_OBSTACLES];
  const scene *s = &q->s;
  const bool all = s->n > 1 || rng_index(q->r, 2), separately = rng_index(q->r, 2);
  const cprox_status status =
      all ? distance_of_list(s->mover, s->targets, s->n, &q->options, q->a->ws, &x, separately ? each : NULL)
          : cprox_distance(s->mover, s->targets[0], &q->options, q->a->ws, &x);
  if (!answered(q, status)) return;
  if (all)
    check_all(q, &x);
  else
    check_one(q, 0, &x);
  check_width(q, &x);
  for (size_t i = 0; all && separately && i < s->n; i++) {
    check_one(q, i, &each[i]);
    check_width(q, &each[i]);
    attack_check(q->a, x.lower <= each[i].upper, "distance: lower %.17g of all is above upper %.17g of obstacle %zu",
                 x.lower, each[i].upper, i);
  }
}

static double some_delta(query *q, const cprox_result *x) {
  switch (rng_index(q->r, 6)) {
    case 0: return fmax(0.0, x->lower);
    case 1: return fmax(0.0, x->upper);
    case 2: return fmax(0.0, nextafter(x->lower, -1.0));
    case 3: return 0.0;
    case 4: return fmax(0.0, x->upper) * rng_uniform(q->r, 0.9, 1.1);
    default: return q->s.scale * rng_log_uniform(q->r, 1e-3, 3.0);
  }
}

/* delta < 0: a collision. */
static void check_verdict(query *q, const cprox_result *x, double delta) {
  attack_count(q->a, cprox_verdict_name(x->verdict));
  if (delta >= 0.0) {
    if (x->verdict == CPROX_VERDICT_CLEAR)
      attack_check(q->a, x->lower > delta, "%s: " RESULT " of %.17g", q->query, SHOWN(x), delta);
    if (x->verdict == CPROX_VERDICT_VIOLATED)
      attack_check(q->a, x->upper <= delta, "%s: " RESULT " of %.17g", q->query, SHOWN(x), delta);
  } else {
    if (x->verdict == CPROX_VERDICT_CLEAR) attack_check(q->a, x->lower > 0.0, "%s: " RESULT, q->query, SHOWN(x));
    if (x->verdict == CPROX_VERDICT_VIOLATED) attack_check(q->a, x->lower == 0.0, "%s: " RESULT, q->query, SHOWN(x));
  }
  if (x->verdict == CPROX_VERDICT_UNDECIDED && x->status == CPROX_OK)
    attack_check(q->a, x->upper - x->lower <= width_asked(q, x->upper) * (1.0 + 1e-12),
                 "%s: " RESULT " of %.17g is undecided", q->query, SHOWN(x), delta);
}

static void ask_tolerance(query *q) {
  const scene *s = &q->s;
  cprox_result x, before;
  if (!answered(q, distance_of_list(s->mover, s->targets, s->n, &q->options, q->a->ws, &before, NULL))) return;
  const double delta = some_delta(q, &before);
  if (isinf(delta)) return;
  if (!answered(q, tolerance_of_list(s->mover, s->targets, s->n, delta, &q->options, q->a->ws, &x, NULL))) return;
  check_all(q, &x);
  check_verdict(q, &x, delta);
  attack_check(q->a, x.lower <= before.upper && before.lower <= x.upper, "tolerance: [%.17g, %.17g] and [%.17g, %.17g]",
               x.lower, x.upper, before.lower, before.upper);
}

static void ask_collision(query *q) {
  const scene *s = &q->s;
  cprox_result x;
  if (!answered(q, collision_of_list(s->mover, s->targets, s->n, &q->options, q->a->ws, &x, NULL))) return;
  check_all(q, &x);
  check_verdict(q, &x, -1.0);
}

/* Is there a parameter before t_contact_lower at which they overlap by more than the reference's error? */
static void check_not_late(query *q, const cprox_result *x) {
  const scene *s = &q->s;
  const double t0 = s->path.t0;
  if (!(x->t_contact_lower > t0)) return;
  const double before = nextafter(x->t_contact_lower - 2.0 * scene_step(&s->path), t0);
  if (before <= t0) return;
  for (size_t i = 0; i < s->n; i++) {
    double where;
    const long double least = scene_least(s, i, q->r, before, t0, before, &where);
    attack_check(q->a, least >= -scene_room(s, i) - 4.0L * cprox_curve_get_info(s->path.curve).error,
                 "time of contact: none before %.17g, but at %.17g they overlap by %.3Lg (obstacle %zu: %s)",
                 x->t_contact_lower, where, -least, i, s->obstacles[i].body.name);
  }
}

static void ask_time_of_contact(query *q) {
  const scene *s = &q->s;
  cprox_result x;
  q->options.relative_epsilon = 0.0; /* it does not apply */
  const cprox_status status = s->n == 1 && rng_index(q->r, 2)
                                  ? cprox_time_of_contact(s->mover, s->targets[0], &q->options, q->a->ws, &x)
                                  : time_of_contact_of_list(s->mover, s->targets, s->n, &q->options, q->a->ws, &x);
  if (!answered(q, status)) return;
  attack_count(q->a, cprox_verdict_name(x.verdict));
  attack_check(q->a, x.t_contact_lower >= s->path.t0 && x.t_contact_lower <= s->path.t1,
               "time of contact: t_contact_lower %.17g", x.t_contact_lower);
  attack_check(q->a, x.lower <= x.upper, "time of contact: " RESULT, SHOWN(&x));
  for (size_t i = 0; i < s->n; i++) check_lower(q, i, &x, s->path.t0, s->path.t1);
  check_not_late(q, &x);
  /* at t_contact_lower something is as near as epsilon, at t there is contact */
  long double at_free = HUGE_VALL, at_t = HUGE_VALL, room = 0.0L;
  bool exact = true;
  for (size_t i = 0; i < s->n; i++) {
    at_free = fminl(at_free, distance_about(q, i, x.t_contact_lower, NAN));
    at_t = fminl(at_t, distance_about(q, i, x.t, NAN));
    room = fmaxl(room, scene_witness_room(s, i));
    exact = exact && scene_is_exact(s, i);
  }
  if (x.verdict == CPROX_VERDICT_CLEAR) attack_check(q->a, x.lower > 0.0, "time of contact: " RESULT, SHOWN(&x));
  if (x.verdict == CPROX_VERDICT_VIOLATED && exact)
    attack_check(q->a, x.t >= x.t_contact_lower && at_t <= room,
                 "time of contact: touching at %.17g, free before %.17g, but there it is %.3Lg", x.t, x.t_contact_lower,
                 at_t);
  if (x.status == CPROX_OK && x.t_contact_lower < s->path.t1 && exact)
    attack_check(q->a, at_free <= q->options.epsilon + room,
                 "time of contact: t_contact_lower = %.17g with ok, epsilon %.3g, but there it is %.3Lg",
                 x.t_contact_lower, q->options.epsilon, at_free);
}

static void ask_profile(query *q) {
  enum { INTERVALS = 4 };
  const scene *s = &q->s;
  double breaks[INTERVALS + 1];
  cprox_profile_interval intervals[INTERVALS];
  for (int k = 0; k <= INTERVALS; k++)
    breaks[k] = k == INTERVALS ? s->path.t1 : s->path.t0 + (s->path.t1 - s->path.t0) * k / INTERVALS;
  const cprox_status status =
      profile_of_list(s->mover, s->targets, s->n, breaks, INTERVALS, &q->options, q->a->ws, intervals);
  if (!answered(q, status)) return;
  for (int k = 0; k < INTERVALS; k++) {
    const cprox_profile_interval *p = &intervals[k];
    attack_check(q->a, p->t0 == breaks[k] && p->t1 == breaks[k + 1] && p->lower <= p->upper, "profile: [%.17g, %.17g]",
                 p->lower, p->upper);
    const cprox_result x = {.lower = p->lower,
                            .upper = p->upper,
                            .t = p->t,
                            .t_obstacle = NAN,
                            .status = status,
                            .verdict = CPROX_VERDICT_UNDECIDED};
    /* a jump at the end of an interval belongs to the next */
    const double end = k + 1 < INTERVALS ? p->t1 - scene_step(&s->path) : p->t1;
    for (size_t i = 0; i < s->n; i++) check_lower(q, i, &x, p->t0, end);
    if (isinf(p->upper) || p->obstacle_index < 0 || (size_t)p->obstacle_index >= s->n) {
      attack_check(q->a, isinf(p->upper), "profile: target %d", p->obstacle_index);
      continue;
    }
    attack_check(q->a, p->t >= p->t0 && p->t <= p->t1, "profile: t = %.17g", p->t);
    const size_t i = (size_t)p->obstacle_index;
    if (scene_is_exact(s, i) && !attack_failed(q->a)) {
      const long double d = distance_about(q, i, p->t, NAN);
      attack_check(q->a, d <= p->upper + scene_room(s, i), "profile: " RESULT ", but there it is %.19Lg", SHOWN(&x), d);
    }
    if (status == CPROX_OK)
      attack_check(q->a, p->upper - p->lower <= width_asked(q, p->upper) * (1.0 + 1e-12),
                   "profile: " RESULT " is too wide", SHOWN(&x));
  }
}

/* What is not among the answers must be far enough. */
static void check_left_out(query *q, const cprox_result *found, size_t count, double beyond) {
  const scene *s = &q->s;
  for (size_t i = 0; i < s->n; i++) {
    bool among = false;
    for (size_t k = 0; k < count; k++) among = among || found[k].obstacle_index == (int32_t)i;
    if (among) continue;
    double where;
    const long double least = fmaxl(0.0L, scene_least(s, i, q->r, s->path.t0, s->path.t0, s->path.t1, &where));
    attack_check(q->a, least >= beyond - scene_room(s, i),
                 "%s: obstacle %zu is left out, but %.19Lg away at t = %.17g, not %.17g", q->query, i, least, where,
                 beyond);
  }
}

static void ask_nearest(query *q) {
  const scene *s = &q->s;
  cprox_result found[SCENE_OBSTACLES];
  size_t count = 0;
  const size_t k = 1 + rng_index(q->r, s->n);
  const cprox_status status = nearest_of_list(s->mover, s->targets, s->n, k, &q->options, q->a->ws, found, &count);
  if (!answered(q, status)) return;
  if (!attack_check(q->a, count == k, "nearest: %zu results for k = %zu", count, k)) return;
  for (size_t i = 0; i < count; i++) {
    const bool named = found[i].obstacle_index >= 0 && (size_t)found[i].obstacle_index < s->n;
    if (!attack_check(q->a, named || isinf(found[i].upper), "nearest: target %d", found[i].obstacle_index)) return;
    if (named) check_one(q, (size_t)found[i].obstacle_index, &found[i]);
    attack_check(q->a, i == 0 || found[i - 1].upper <= found[i].upper, "nearest: not ascending");
  }
  if (status == CPROX_OK)
    check_left_out(q, found, count, found[count - 1].upper - width_asked(q, found[count - 1].upper));
}

static void ask_within(query *q) {
  const scene *s = &q->s;
  cprox_result found[SCENE_OBSTACLES];
  size_t count = 0;
  const double delta = rng_index(q->r, 4) ? s->scale * rng_log_uniform(q->r, 1e-2, 10.0) : 0.0;
  const cprox_status status = within_of_list(s->mover, s->targets, s->n, delta, &q->options, q->a->ws, found, &count);
  if (!answered(q, status)) return;
  for (size_t i = 0; i < count && i < SCENE_OBSTACLES; i++) {
    const bool named = found[i].obstacle_index >= 0 && (size_t)found[i].obstacle_index < s->n;
    if (!attack_check(q->a, named, "within: target %d", found[i].obstacle_index)) return;
    attack_check(q->a, found[i].lower <= delta, "within %.17g: " RESULT, delta, SHOWN(&found[i]));
    attack_check(q->a, found[i].verdict != CPROX_VERDICT_VIOLATED || found[i].upper <= delta, "within %.17g: " RESULT,
                 delta, SHOWN(&found[i]));
    check_one(q, (size_t)found[i].obstacle_index, &found[i]);
  }
  check_left_out(q, found, count, delta);
}

static void ask_set(query *q) {
  const scene *s = &q->s;
  cprox_obstacles *set = NULL;
  cprox_result x;
  if (!answered(q, cprox_obstacles_create(s->targets, s->n, CPROX_INDEX_BVH, q->a->ws, &set))) return;
  cprox_status status = cprox_obstacles_distance(set, s->mover, &q->options, q->a->ws, &x, NULL);
  const size_t which = rng_index(q->r, 3);
  if (which == 1) status = cprox_obstacles_tolerance(set, s->mover, s->scale, &q->options, q->a->ws, &x, NULL);
  if (which == 2) status = cprox_obstacles_collision(set, s->mover, &q->options, q->a->ws, &x, NULL);
  if (answered(q, status)) {
    check_all(q, &x);
    if (which == 0)
      check_width(q, &x);
    else
      check_verdict(q, &x, which == 1 ? s->scale : -1.0);
  }
  cprox_obstacles_free(set);
}

static void ask_batch(query *q) {
  const scene *s = &q->s;
  cprox_obstacles *batch = NULL;
  cprox_result x[2];
  const cprox_mover movers[2] = {s->mover, s->mover};
  if (!answered(q, cprox_obstacles_create(s->targets, s->n, CPROX_INDEX_BATCH, q->a->ws, &batch))) return;
  const size_t which = rng_index(q->r, 3);
  cprox_status status = CPROX_OK;
  if (which == 0) status = cprox_obstacles_distance_batch(batch, movers, 0, 2, &q->options, q->a->ws, x);
  if (which == 1) status = cprox_obstacles_tolerance_batch(batch, movers, 0, 2, s->scale, &q->options, q->a->ws, x);
  if (which == 2) status = cprox_obstacles_tolerance_batch(batch, movers, 0, 2, 0.0, &q->options, q->a->ws, x);
  if (answered(q, status)) {
    check_all(q, &x[0]);
    attack_check(q->a, x[0].lower == x[1].lower && x[0].upper == x[1].upper,
                 "batch: the same mover twice: [%.17g, %.17g], [%.17g, %.17g]", x[0].lower, x[0].upper, x[1].lower,
                 x[1].upper);
    if (which == 0)
      check_width(q, &x[0]);
    else
      check_verdict(q, &x[0], which == 1 ? s->scale : -1.0);
  }
  cprox_obstacles_free(batch);
}

static void ask_signed(query *q) {
  const scene *s = &q->s;
  cprox_result x;
  q->options.signed_distance = true;
  if (!answered(q, cprox_distance(s->mover, s->targets[0], &q->options, q->a->ws, &x))) return;
  if (!numbers_are_sound(q, &x, 1)) return;
  const obstacle *o = &s->obstacles[0];
  const bool known = scene_is_exact(s, 0) && (o->curved ? !o->bodied : o->body.depth);
  if (known) check_one(q, 0, &x);
  check_width(q, &x);
}

static void ask_gradient(query *q) {
  const scene *s = &q->s;
  cprox_result x;
  cprox_gradient g;
  q->options.signed_distance = rng_index(q->r, 2);
  if (!answered(q, cprox_distance(s->mover, s->targets[0], &q->options, q->a->ws, &x))) return;
  if (!answered(q, cprox_distance_gradient(s->mover, s->targets[0], &q->options, &x, q->a->ws, &g))) return;
  attack_count(q->a, g.valid ? "gradient valid" : "gradient not valid");
  const bool sound = vec_finite(g.mover) && vec_finite(g.position) && vec_finite(g.rotation) && isfinite(g.t0) &&
                     isfinite(g.t1) && isfinite(g.t);
  attack_check(q->a, sound, "gradient: not finite");
  if (!g.valid) return;
  /* by moving the mover's point: a unit vector, and what the target's position does is its opposite */
  attack_check(q->a, fabs(vec_norm(g.mover) - 1.0) < 1e-9, "gradient: |by the mover| = %.17g", vec_norm(g.mover));
  attack_check(q->a, vec_norm(vec_add(g.mover, g.position)) < 1e-9,
               "gradient: by the mover (%.17g, %.17g, %.17g), by the position (%.17g, %.17g, %.17g)", g.mover.x,
               g.mover.y, g.mover.z, g.position.x, g.position.y, g.position.z);
}

/* ---- one case ---- */

static cprox_options some_options(rng *r, double scale) {
  const double epsilons[] = {0.0, 1e-9 * scale, 1e-6 * scale, 1e-6, 1e-3 * scale, 0.3 * scale, 1e3 * scale};
  const double relative[] = {0.0, 0.0, 1e-6, 1e-2, 0.999, 10.0};
  const uint32_t budgets[] = {2000, 2000, 2000, 20000, 200, 10, 1};
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.epsilon = epsilons[rng_index(r, 7)];
  options.relative_epsilon = relative[rng_index(r, 6)];
  options.max_nodes = budgets[rng_index(r, 7)];
  return options;
}

static void one_case(attack *a, rng *r) {
  static const struct {
    const char *name;
    void (*ask)(query *q);
  } QUERIES[] = {{"distance", ask_distance},
                 {"distance", ask_distance},
                 {"tolerance", ask_tolerance},
                 {"collision", ask_collision},
                 {"time of contact", ask_time_of_contact},
                 {"profile", ask_profile},
                 {"nearest", ask_nearest},
                 {"within", ask_within},
                 {"set", ask_set},
                 {"batch", ask_batch},
                 {"signed", ask_signed},
                 {"gradient", ask_gradient}};
  static query q;
  q = (query){.a = a, .r = r};
  const size_t which = rng_index(r, sizeof QUERIES / sizeof *QUERIES);
  q.query = QUERIES[which].name;
  if (scene_make(a, r, &q.s)) {
    const obstacle *o = &q.s.obstacles[0];
    attack_kind(a, "%s: %s on %s", q.query,
                q.s.bodied         ? "body"
                : q.s.radius > 0.0 ? "ball"
                                   : "point",
                path_name(q.s.path.family));
    if (a->alone)
      printf("%s, scale %g: %s on a %s curve, obstacle 0 of %zu: %s%s%s\n", q.query, q.s.scale,
             q.s.bodied ? q.s.body.name : "a point", path_name(q.s.path.family), q.s.n,
             o->curved ? path_name(o->path.family) : "", o->synchronized ? " on the clock " : "", o->body.name);
    q.options = some_options(r, q.s.scale);
    if (a->alone)
      printf("epsilon %g, relative %g, budget %u\n", q.options.epsilon, q.options.relative_epsilon,
             q.options.max_nodes);
    QUERIES[which].ask(&q);
  }
  scene_free(&q.s);
}

int main(int argc, char **argv) {
  return attack_main(argc, argv, "compose", one_case);
}
