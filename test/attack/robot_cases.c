/* SPDX-License-Identifier: BSD-3-Clause */
/* Robots: trees of every type of joint with bodies of many kinds on their links, along few and many waypoints, against
 * obstacles, against themselves, and both at once; every query that robots have. Movers: two or three of these, or
 * bodies on pose splines, on one clock, half of them with starts that are only known to a tolerance or not at all.
 *
 * Held against poses in long double (support/robots.h) and nearest points by definition (bodies.h). Nearest points
 * taken in turns give two points, one of each body: their distance is an upper bound of the true one, so no lower bound
 * of the core may be above it, at any time. Supports along the line between them give a lower bound, which no upper
 * bound may be below. Witness points must lie in their bodies and be as near as said. Verdicts
 * and times of contact must follow.
 *
 * Times are drawn once for all pairs. Balls about the bodies tell which pairs, and at which times, cannot be nearer
 * than what was answered; only the others are measured. Steps about the best time become smaller until the distance
 * cannot come down to the answer any more. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "robot_cases.h"
#include "robot_world.h"
#include "support/of_list.h"

enum { REFINEMENTS = 16, PAIRS = 5 };

/* ---- pairs ---- */

/* Is the pair asked about, as cprox_robot_along() and cprox_robot_self() say? */
static bool is_asked(const world *w, pair p) {
  if (!p.self) return w->obstacles;
  if (!w->self || p.geometry == p.other) return false;
  if (w->across) return member_of(w, p.geometry) != member_of(w, p.other);
  const cprox_link_info between = cprox_motion_get_link_info(w->motion, link_of(w, p.geometry), link_of(w, p.other));
  return between.n_joints >= 2;
}

static void list_pairs(world *w) {
  w->n_asked = 0;
  for (size_t g = 0; g < count_geometries(w); g++) {
    for (size_t k = 0; k < g + OBSTACLES; k++) {
      const pair p = {g, k < g ? k : k - g, k < g};
      if (is_asked(w, p)) w->asked[w->n_asked++] = p;
    }
  }
}

/* The pair that a result is about. */
static bool pair_of_result(const world *w, const cprox_result *x, pair *p) {
  const int32_t first = w->obstacles ? OBSTACLES : 0, index = x->obstacle_index;
  *p = (pair){(size_t)x->mover_part, (size_t)(index < first ? index : index - first), index >= first};
  return x->mover_part >= 0 && (size_t)x->mover_part < count_geometries(w) && index >= 0 &&
         p->other < (p->self ? count_geometries(w) : OBSTACLES) && is_asked(w, *p);
}

/* ---- what holds of results ---- */

#define RESULT "[%.17g, %.17g] (%s, %s) at t = %.17g"
#define SHOWN(x) (x)->lower, (x)->upper, cprox_status_name((x)->status), cprox_verdict_name((x)->verdict), (x)->t

static void draw_places(world *w, double *place) {
  for (size_t m = 0; m < w->n_members && w->vague; m++)
    place[m] = rng_index(w->r, 4) ? rng_uniform(w->r, 0.0, 1.0) : (double)rng_index(w->r, 2);
}

/* Times in [t0, t1], one of them `begin`, ascending but for that. */
static void draw_views(world *w, double t0, double t1, double begin) {
  for (int i = 0; i < SAMPLES; i++) {
    view *v = &w->views[i];
    v->t = i == 0 ? begin : fmin(t0 + (t1 - t0) * (i - 1 + rng_uniform(w->r, 0.0, 1.0)) / (SAMPLES - 1), t1);
    draw_places(w, v->place);
    place_links(w, v);
  }
}

static long double balls_apart(const world *w, pair p, vec3l a, vec3l other) {
  const long double other_radius = p.self ? w->link_balls[p.other].radius : w->body_balls[p.other].radius;
  return ref_norm(ref_sub(a, other)) - w->link_balls[p.geometry].radius - other_radius;
}

/* Of the balls of a pair in a view. */
static long double balls_in_view(const world *w, pair p, const view *v) {
  return balls_apart(w, p, v->centres[p.geometry], p.self ? v->centres[p.other] : w->body_balls[p.other].centre);
}

/* What a search has found of a pair: the least distance, and where. The value is what times are compared by: a lower
 * bound where that is not below the limit, else the distance. */
typedef struct finding {
  pair p;
  long double limit, value;
  gap least;
  double t, place[MEMBERS];
  vec3l begin;
} finding;

static bool is_below(const finding *f) {
  return f->least.upper < f->limit - f->least.room;
}

static void keep_better(finding *f, const gap *g, long double value, double t, const double *place, vec3l begin) {
  if (g->upper < f->least.upper) f->least = *g;
  if (!(value < f->value) && !is_below(f)) return;
  f->value = value, f->t = t, f->begin = begin;
  memcpy(f->place, place, sizeof f->place);
}

static void measure_view(const world *w, const view *v, finding *f) {
  const long double apart = balls_in_view(w, f->p, v);
  const gap unknown = {.upper = HUGE_VALL};
  vec3l begin = w->link_balls[f->p.geometry].centre;
  if (apart >= f->limit) {
    keep_better(f, &unknown, apart, v->t, v->place, begin);
    return;
  }
  const placed a = place_geometry(w, &v->links[f->p.geometry], f->p.geometry),
               b = f->p.self ? place_geometry(w, &v->links[f->p.other], f->p.other) : place_obstacle(w, f->p.other);
  const gap g = gap_between(&a, &b, f->limit, fmaxl(f->value, f->limit), &begin);
  keep_better(f, &g, g.lower >= f->limit ? g.lower : g.upper, v->t, v->place, begin);
}

/* The value at a time and places beside the best one. */
static long double measure(const world *w, finding *f, double t, const double *place) {
  placed two[2];
  place_pair(w, f->p, place, t, two);
  const gap unknown = {.upper = HUGE_VALL};
  vec3l begin = f->begin;
  const vec3l centre = ref_pose_apply(&two[0].link, w->link_balls[f->p.geometry].centre),
              other = f->p.self ? ref_pose_apply(&two[1].link, w->link_balls[f->p.other].centre)
                                : w->body_balls[f->p.other].centre;
  const long double apart = balls_apart(w, f->p, centre, other);
  if (apart >= f->limit) {
    keep_better(f, &unknown, apart, t, place, begin);
    return apart;
  }
  const gap g = gap_between(&two[0], &two[1], f->limit, HUGE_VALL, &begin);
  const long double value = g.lower >= f->limit ? g.lower : g.upper;
  keep_better(f, &g, value, t, place, begin);
  return value;
}

/* One step to both sides of the best value along a coordinate (below 0: time; else the place of that member), and
 * where a parabola through the three is least. Returns how much the value changes; `inside` if the best one is not at
 * an end. */
static long double step_about(const world *w, finding *f, int coordinate, double low, double high, double step,
                              bool *inside) {
  const double middle = coordinate < 0 ? f->t : f->place[coordinate];
  const double at[2] = {fmax(middle - step, low), fmin(middle + step, high)};
  const long double value = f->value;
  long double ends[2];
  double place[MEMBERS];
  const double t = f->t;
  memcpy(place, f->place, sizeof place);
  for (int side = 0; side < 2; side++) {
    if (coordinate >= 0) place[coordinate] = at[side];
    ends[side] = measure(w, f, coordinate < 0 ? at[side] : t, place);
  }
  *inside = !(ends[0] < value && at[0] > low) && !(ends[1] < value && at[1] < high);
  const long double left = middle - at[0], right = at[1] - middle, down = ends[0] - value, up = ends[1] - value;
  const long double bend = down * right + up * left;
  if (bend > 0.0L) {
    const double best = middle + (double)((down * right * right - up * left * left) / (2.0L * bend));
    if (coordinate >= 0) place[coordinate] = fmin(fmax(best, low), high);
    measure(w, f, coordinate < 0 ? fmin(fmax(best, low), high) : t, place);
  }
  return fmaxl(fabsl(down), fabsl(up));
}

/* Smaller and smaller steps about the best view, until the distance cannot come down to the limit. */
static void refine(const world *w, double t0, double t1, finding *f) {
  double steps[MEMBERS + 1] = {(t1 - t0) / SAMPLES, 0.5, 0.5, 0.5};
  const size_t members[2] = {member_of(w, f->p.geometry), f->p.self ? member_of(w, f->p.other) : 0};
  for (int i = 0; i < REFINEMENTS && !is_below(f); i++) {
    long double change = 0.0L;
    for (int c = -1; c < (int)w->n_members; c++) {
      const bool moves = c < 0 || (w->vague && w->tolerances[c] > 0.0 &&
                                   ((size_t)c == members[0] || (f->p.self && (size_t)c == members[1])));
      if (!moves) continue;
      bool inside;
      change += step_about(w, f, c, c < 0 ? t0 : 0.0, c < 0 ? t1 : 1.0, steps[c + 1], &inside);
      if (inside) steps[c + 1] *= 0.25;
    }
    if (f->value - 3.0L * change > f->limit) return;
  }
}

/* Is a pair below `limit` somewhere in the views' time? */
static finding search_pair(const world *w, pair p, double t0, double t1, long double limit) {
  finding f = {.p = p, .limit = limit, .value = HUGE_VALL, .least = {.upper = HUGE_VALL}};
  for (int i = 0; i < SAMPLES && !is_below(&f); i++) measure_view(w, &w->views[i], &f);
  refine(w, t0, t1, &f);
  return f;
}

static void swap_pairs(pair *p, pair *q) {
  const pair swapped = *p;
  *p = *q;
  *q = swapped;
}

/* The pairs whose balls come near the limit: the nearest one first, then in any order. Returns their number. */
static size_t near_pairs(world *w, long double limit, pair *near) {
  size_t n = 0, nearest = 0;
  long double least = HUGE_VALL;
  for (size_t i = 0; i < w->n_asked; i++) {
    long double low = balls_in_view(w, w->asked[i], &w->views[0]), before = low, change = 0.0L;
    for (int k = 1; k < SAMPLES; k++) {
      const long double apart = balls_in_view(w, w->asked[i], &w->views[k]);
      if (k > 1) change = fmaxl(change, fabsl(apart - before));
      low = fminl(low, apart), before = apart;
    }
    if (low - 2.0L * change > limit) continue;
    near[n] = w->asked[i];
    if (low < least) least = low, nearest = n;
    n++;
  }
  if (n > 0) swap_pairs(&near[0], &near[nearest]);
  for (size_t i = 1; i < n; i++) swap_pairs(&near[i], &near[i + rng_index(w->r, n - i)]);
  return n;
}

static bool same_pair(pair p, pair q) {
  if (p.self != q.self) return false;
  return (p.geometry == q.geometry && p.other == q.other) || (p.self && p.geometry == q.other && p.other == q.geometry);
}

/* Pairs that come near, and that of the result: the first that is below the limit. */
static bool find_below(world *w, const cprox_result *x, double t0, double t1, long double limit, finding *f) {
  pair near[MOST_PAIRS + 1], of_result;
  draw_views(w, t0, t1, x->t > t0 && x->t < t1 ? x->t : t0);
  const bool known = pair_of_result(w, x, &of_result);
  if (known) {
    *f = search_pair(w, of_result, t0, t1, limit);
    if (is_below(f)) return true;
  }
  const size_t n = near_pairs(w, limit, near);
  for (size_t i = 0, searched = 0; i < n && searched < PAIRS; i++) {
    if (known && same_pair(near[i], of_result)) continue;
    *f = search_pair(w, near[i], t0, t1, limit);
    if (is_below(f)) return true;
    searched++;
  }
  return false;
}

static const char *name_of_other(const world *w, pair p) {
  return p.self ? w->links[p.other].name : w->bodies[p.other].name;
}

/* No pair comes nearer than `lower` over [t0, t1]. */
static void check_lower(world *w, const cprox_result *x, double t0, double t1) {
  finding f;
  if (x->lower > 0.0 && find_below(w, x, t0, t1, x->lower, &f))
    attack_fail(w->a, RESULT ", but geometry %zu and %s %zu (%s, %s) are %.19Lg apart at %.17g", SHOWN(x), f.p.geometry,
                f.p.self ? "geometry" : "obstacle", f.p.other, w->links[f.p.geometry].name, name_of_other(w, f.p),
                f.least.upper, f.t);
}

static void check_witness(world *w, const cprox_result *x, pair p, const gap *g) {
  placed two[2];
  place_pair(w, p, w->place, x->t, two);
  const placed a = two[0], b = two[1];
  const vec3l on_a = ref_vec(x->witness_mover), on_b = ref_vec(x->witness_obstacle);
  const long double off_a = ref_norm(ref_sub(nearest_on(&a, on_a), on_a)) - a.margin;
  const long double off_b = ref_norm(ref_sub(nearest_on(&b, on_b), on_b)) - b.margin;
  const long double room = g->room + 1e-9L;
  attack_check(w->a, off_a <= room, RESULT ": the robot's witness is %.3Lg off geometry %zu (%s)", SHOWN(x), off_a,
               p.geometry, a.body->name);
  attack_check(w->a, off_b <= room, RESULT ": the other witness is %.3Lg off %s %zu (%s)", SHOWN(x), off_b,
               p.self ? "geometry" : "obstacle", p.other, b.body->name);
  const long double between = ref_norm(ref_sub(on_a, on_b));
  if (x->upper > 0.0)
    attack_check(w->a, fabsl(between - x->upper) <= room, RESULT ": the witnesses are %.17Lg apart", SHOWN(x), between);
}

/* How far a point is from a geometry at the nearest, whatever the start: places of its member side by side, then
 * smaller and smaller steps about the best. More places where that is above what is enough. */
static long double nearest_of_all(world *w, size_t g, vec3l x, double time, long double enough) {
  enum { STEPS = 40, MOST = 30000 };
  double *place = &w->place[member_of(w, g)], best = 0.0;
  long double least = HUGE_VALL;
  for (int drawn = 300; drawn <= MOST && least > enough; drawn *= 10) {
    for (int i = 0; i < drawn + 2 * STEPS && least > enough; i++) {
      const int k = i - drawn;
      const double step = (k % 2 ? 1.0 : -1.0) * ldexp(1.0 / drawn, -k / 4);
      *place = k < 0 ? (double)i / (drawn - 1) : fmin(fmax(best + step, 0.0), 1.0);
      const ref_pose link = place_link(w, g, w->place, time);
      const ball *about = &w->link_balls[g];
      if (ref_norm(ref_sub(ref_pose_apply(&link, about->centre), x)) - about->radius >= least) continue;
      const placed a = place_geometry(w, &link, g);
      const long double off = ref_norm(ref_sub(nearest_on(&a, x), x)) - a.margin;
      if (off < least) least = off, best = *place;
    }
  }
  return least;
}

/* Of starts with a tolerance the result does not say with which ones it was measured: each witness is near its geometry
 * with some start that is possible then. What is found of the best one is right to about the square root of the room of
 * nearest points. */
static void check_witness_of_some_start(world *w, const cprox_result *x, pair p) {
  const long double room = 1e-4L;
  const vec3l on_a = ref_vec(x->witness_mover), on_b = ref_vec(x->witness_obstacle);
  const long double off_a = nearest_of_all(w, p.geometry, on_a, x->t, room);
  attack_check(w->a, off_a <= room, RESULT ": no start brings geometry %zu nearer than %.3Lg to its witness", SHOWN(x),
               p.geometry, off_a);
  if (!p.self) return;
  const long double off_b = nearest_of_all(w, p.other, on_b, x->t, room);
  attack_check(w->a, off_b <= room, RESULT ": no start brings geometry %zu nearer than %.3Lg to its witness", SHOWN(x),
               p.other, off_b);
}

static void check_upper(world *w, const cprox_result *x) {
  pair p;
  if (isinf(x->upper)) return;
  if (!attack_check(w->a, pair_of_result(w, x, &p), RESULT ": parts %d and %d are not asked about", SHOWN(x),
                    x->mover_part, x->obstacle_index))
    return;
  if (w->vague) {
    check_witness_of_some_start(w, x, p);
    return;
  }
  const gap g = gap_at(w, p, x->t);
  attack_check(w->a, g.lower <= x->upper + g.room, RESULT ", but a plane proves %.19Lg there", SHOWN(x), g.lower);
  check_witness(w, x, p, &g);
}

/* t is not a number where no distance was measured. */
static bool is_sound(world *w, const cprox_result *x) {
  const bool measured = isfinite(x->upper);
  return attack_check(w->a, x->lower <= x->upper && (!measured || (x->t >= w->t0 && x->t <= w->t1)),
                      RESULT " is not sound", SHOWN(x));
}

static void check_result(world *w, const cprox_result *x) {
  if (!is_sound(w, x)) return;
  check_lower(w, x, w->t0, w->t1);
  check_upper(w, x);
}

static bool answered(world *w, cprox_status status) {
  attack_count(w->a, cprox_status_name(status));
  return attack_check(w->a, status >= 0, "%s: %s", cprox_status_name(status), cprox_workspace_error(w->a->ws));
}

/* ---- queries ---- */

static const cprox_obstacle *targets_of(const world *w, size_t *n) {
  *n = w->obstacles ? OBSTACLES : 0;
  return w->obstacles ? w->targets : NULL;
}

/* Status ok promises it. Against nothing both ends are infinite. */
static void check_width(world *w, const cprox_result *x, const cprox_options *options) {
  if (isinf(x->lower)) return;
  const double width = fmax(options->epsilon, isinf(x->upper) ? 0.0 : options->relative_epsilon * x->upper);
  attack_check(w->a, x->upper - x->lower <= width * (1.0 + 1e-12) + 1e-12, RESULT " is too wide", SHOWN(x));
}

static void ask_distance(world *w, const cprox_options *options) {
  size_t n;
  const cprox_obstacle *targets = targets_of(w, &n);
  cprox_result x = {0};
  if (!answered(w, distance_of_list(w->mover, targets, n, options, w->a->ws, &x, NULL))) return;
  check_result(w, &x);
  if (x.status == CPROX_OK) check_width(w, &x, options);
}

static void ask_tolerance(world *w, const cprox_options *options) {
  size_t n;
  const cprox_obstacle *targets = targets_of(w, &n);
  const double delta = rng_index(w->r, 3) ? rng_log_uniform(w->r, 1e-4, 1.0) : 0.0;
  cprox_result x = {0};
  if (!answered(w, delta > 0.0 ? tolerance_of_list(w->mover, targets, n, delta, options, w->a->ws, &x, NULL)
                               : collision_of_list(w->mover, targets, n, options, w->a->ws, &x, NULL)))
    return;
  check_result(w, &x);
  attack_count(w->a, cprox_verdict_name(x.verdict));
  if (x.verdict == CPROX_VERDICT_UNDECIDED && x.status == CPROX_OK) check_width(w, &x, options);
  if (x.verdict == CPROX_VERDICT_CLEAR) attack_check(w->a, x.lower > delta, "delta %.17g: " RESULT, delta, SHOWN(&x));
  if (x.verdict == CPROX_VERDICT_VIOLATED)
    attack_check(w->a, x.upper <= delta, "delta %.17g: " RESULT, delta, SHOWN(&x));
}

static void ask_time_of_contact(world *w, const cprox_options *asked) {
  size_t n;
  const cprox_obstacle *targets = targets_of(w, &n);
  cprox_options options = *asked;
  options.relative_epsilon = 0.0; /* it does not apply */
  cprox_result x = {0};
  if (!answered(w, time_of_contact_of_list(w->mover, targets, n, &options, w->a->ws, &x))) return;
  if (!is_sound(w, &x)) return;
  attack_count(w->a, cprox_verdict_name(x.verdict));
  check_lower(w, &x, w->t0, w->t1);
  attack_check(w->a, x.t_contact_lower >= w->t0 && x.t_contact_lower <= w->t1, "t_contact_lower = %.17g",
               x.t_contact_lower);
  /* before it nothing overlaps, by more than what the reference cannot tell */
  finding f;
  pair p;
  if (x.t_contact_lower > w->t0 && find_below(w, &x, w->t0, x.t_contact_lower, 0.0L, &f))
    attack_fail(w->a, RESULT ", free before %.17g, but geometry %zu and %s %zu (%s, %s) overlap by %.3Lg at %.17g",
                SHOWN(&x), x.t_contact_lower, f.p.geometry, f.p.self ? "geometry" : "obstacle", f.p.other,
                w->links[f.p.geometry].name, name_of_other(w, f.p), -f.least.upper, f.t);
  if (x.verdict == CPROX_VERDICT_CLEAR) attack_check(w->a, x.lower > 0.0, RESULT, SHOWN(&x));
  if (x.verdict == CPROX_VERDICT_VIOLATED) {
    attack_check(w->a, x.t >= x.t_contact_lower, RESULT ", free before %.17g", SHOWN(&x), x.t_contact_lower);
    if (pair_of_result(w, &x, &p) && !w->vague) {
      const gap g = gap_at(w, p, x.t);
      attack_check(w->a, g.lower <= g.room, RESULT ": touching, but a plane proves %.19Lg", SHOWN(&x), g.lower);
    }
  }
}

static void ask_profile(world *w, const cprox_options *options) {
  enum { INTERVALS = 4 };
  size_t n;
  const cprox_obstacle *targets = targets_of(w, &n);
  double breaks[INTERVALS + 1];
  cprox_profile_interval found[INTERVALS];
  for (int k = 0; k <= INTERVALS; k++) breaks[k] = k == INTERVALS ? w->t1 : w->t0 + (w->t1 - w->t0) * k / INTERVALS;
  if (!answered(w, profile_of_list(w->mover, targets, n, breaks, INTERVALS, options, w->a->ws, found))) return;
  for (int k = 0; k < INTERVALS && !attack_failed(w->a); k++) {
    const cprox_result x = {.lower = found[k].lower,
                            .upper = found[k].upper,
                            .t = found[k].t,
                            .obstacle_index = found[k].obstacle_index,
                            .mover_part = -1};
    attack_check(w->a, x.lower <= x.upper, "profile: " RESULT, SHOWN(&x));
    check_lower(w, &x, breaks[k], breaks[k + 1]);
  }
}

/* ---- one case ---- */

/* Of the pairs with itself only those of two members. */
static size_t pairs_across(world *w) {
  size_t n = 0;
  for (size_t g = 0; g < count_geometries(w); g++)
    for (size_t k = g + 1; k < count_geometries(w); k++)
      if (member_of(w, g) != member_of(w, k)) w->pairs[n++] = (cprox_robot_pair){(int32_t)g, (int32_t)k};
  return n;
}

static cprox_mover mover_of(world *w) {
  if (w->several) w->across = rng_index(w->r, 2);
  const size_t n = w->across ? pairs_across(w) : 0;
  const cprox_robot_pair *pairs = w->across ? w->pairs : NULL;
  if (!w->obstacles) return cprox_robot_self(w->motion, pairs, n);
  const cprox_mover along = cprox_robot_along(w->motion, NULL, 0);
  return w->self ? cprox_robot_whole(along, pairs, n) : along;
}

static cprox_options some_options(rng *r) {
  const double epsilons[] = {1e-6, 1e-6, 1e-4, 1e-3, 0.05}, relative[] = {0.0, 0.0, 1e-3, 0.3};
  const uint32_t budgets[] = {2000, 2000, 500, 20, 1};
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.epsilon = epsilons[rng_index(r, 5)];
  options.relative_epsilon = relative[rng_index(r, 4)];
  options.max_nodes = budgets[rng_index(r, 5)];
  return options;
}

/* Of the starts the least known one. */
static const char *starts_of(const world *w) {
  double most = 0.0;
  for (size_t m = 0; m < w->n_members; m++) most = fmax(most, w->tolerances[m]);
  return most == 0.0 ? "" : isinf(most) ? "anywhere on its path, " : "vague starts, ";
}

void robot_case(attack *a, rng *r, bool several) {
  static const struct {
    const char *name;
    void (*ask)(world *w, const cprox_options *options);
    bool both; /* does it answer for obstacles and itself at once? */
  } QUERIES[] = {{"distance", ask_distance, true},
                 {"distance", ask_distance, true},
                 {"tolerance", ask_tolerance, true},
                 {"tolerance", ask_tolerance, true},
                 {"time of contact", ask_time_of_contact, true},
                 {"profile", ask_profile, false}};
  static const char *const ABOUT[] = {"", "obstacles", "itself", "obstacles and itself"};
  static world w;
  w = (world){.a = a, .r = r, .several = several, .vague = several && rng_index(r, 2)};
  if (world_make(&w, rng_log_uniform(r, 0.02, 0.3))) {
    const size_t which = rng_index(r, sizeof QUERIES / sizeof *QUERIES);
    const size_t about = 1 + rng_index(r, QUERIES[which].both ? 3 : 2);
    w.obstacles = about & 1, w.self = about & 2;
    w.mover = mover_of(&w);
    list_pairs(&w);
    const test_robot *t = &w.members[0];
    attack_kind(a, "%s: %s, %s%s", QUERIES[which].name, ABOUT[about], starts_of(&w),
                t->spline                      ? "spline"
                : t->n_points > TEST_WAYPOINTS ? "many waypoints"
                                               : "few waypoints");
    const cprox_options options = some_options(r);
    if (a->alone)
      printf("%zu links, %zu waypoints, interpolation %d, epsilon %g, relative %g, budget %u\n", count_geometries(&w),
             t->n_points, (int)t->interpolation, options.epsilon, options.relative_epsilon, options.max_nodes);
    QUERIES[which].ask(&w, &options);
  }
  world_free(&w);
}
