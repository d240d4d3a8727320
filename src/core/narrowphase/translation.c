/* SPDX-License-Identifier: BSD-3-Clause */
/* Bodies that translate. Their distance is a convex function of time, so the plane that separates them at one time
 * bounds it at all others: stepping as far as that bound allows never passes contact (doc/implicit.md). */
#include "curve_proximity/cprox/translation.h"

#include <math.h>

#include "base/rotation.h"
#include "base/rounding.h"
#include "base/workspace.h"
#include "implicit/implicit.h"
#include "narrowphase/relative_pose.h"
#include "narrowphase/translation.h"
#include "problem/validate.h"

enum { TRANSLATION_STEPS = 200 };

/* A distance is known to this part of epsilon, so that what two of them enclose is within epsilon. */
static const double PART_OF_EPSILON = 0.25;

/* Of a distance: so rough a lower bound still steps within 1e-3 of as far as the exact one. */
static const double ROUGH_STEP = 1e-3;

/* Of a step: 1000 times what its few operations round. */
static const double STEP_ROUNDING = 1e-12;

/* A position moved along a line: the difference of the velocities, its product with the time and the sum cost u each,
 * together 3 u of the way and u of the position. What is above that is an allowance. */
static const double ROUND_MOVED = 8.0;

/* Of the way between the bodies: what values of the two lines may round where the lines meet. */
static const double MEET_ROUNDING = 1e-14;

/* ---- arguments ---- */

static bool is_implicit(const cprox_body *body) {
  return body->kind == CPROX_BODY_SUPERQUADRIC || body->kind == CPROX_BODY_IMPLICIT;
}

cprox_status translation_check_body(const char *name, const cprox_obstacle *obstacle, cprox_workspace *workspace) {
  if (obstacle->curve || !obstacle->body) return workspace_fail(workspace, CPROX_INVALID, "%s is not a body", name);
  if (!obstacle->body->shape.ops)
    return workspace_fail(workspace, CPROX_INVALID, "%s is a %s, must be convex", name,
                          cprox_body_kind_name(obstacle->body->kind));
  return CPROX_OK;
}

static cprox_status check_motion(const cprox_translating *a, const cprox_translating *b, double duration,
                                 const cprox_options *options, arguments_query asked, cprox_workspace *workspace) {
  cprox_status status;
  if (!workspace) return CPROX_INVALID;
  if ((status = validate_options(options, asked, workspace)) || (status = validate_obstacle(&a->from, 0, workspace)) ||
      (status = validate_obstacle(&b->from, 1, workspace)) ||
      (status = translation_check_body("a", &a->from, workspace)) ||
      (status = translation_check_body("b", &b->from, workspace)))
    return status;
  if (!vec_finite(a->velocity) || !vec_finite(b->velocity))
    return workspace_fail(workspace, CPROX_INVALID, "a velocity is not finite");
  if (!(duration > 0.0) || !isfinite(duration))
    return workspace_fail(workspace, CPROX_INVALID, "duration is %g, must be > 0 and finite", duration);
  const vec3 u = a->velocity, v = b->velocity;
  const double speed = fabs(u.x) + fabs(u.y) + fabs(u.z) + fabs(v.x) + fabs(v.y) + fabs(v.z);
  if (!(fmax(speed, 1.0) * fmax(duration, 1.0) <= LENGTH_MOST))
    return workspace_fail(workspace, CPROX_INVALID, "velocities up to %g m/s for %g s: at most %g m are possible",
                          speed, duration, LENGTH_MOST);
  return CPROX_OK;
}

static cprox_status finish(cprox_status status, cprox_workspace *workspace) {
  if (status != CPROX_OK) workspace_fail(workspace, status, "%s", cprox_status_text(status));
  return status;
}

/* ---- the least distance ---- */

/* Of two implicit bodies: one search over both bodies and the time. */
static cprox_status distance_of_implicit(const cprox_translating *first, const cprox_translating *second,
                                         double duration, const cprox_options *options, cprox_workspace *workspace,
                                         cprox_result *result) {
  const cprox_translating a = *first, b = *second;
  const cprox_options asked = *options;
  const pair_side x = relative_pose_of_side(&a.from, 0), y = relative_pose_of_side(&b.from, 0);
  const pair_placement place = relative_pose_make(&x, &y);
  implicit_query query = {
      .a = x.shape->implicit, .b = y.shape->implicit, .moving = true, .t = place.t, .duration = duration};
  for (int i = 0; i < 9; i++) query.m[i] = place.r[i];
  const vec3 relative = vec_sub(b.velocity, a.velocity);
  query.velocity = frame_turn_to_local(&x.f, relative);
  void *memory = workspace_reserve(workspace, WORKSPACE_INTERIOR, implicit_memory(query.a, query.b));
  if (!memory) return workspace_fail(workspace, CPROX_MEMORY, "no memory for a pair of implicit bodies");

  const double displacement = vec_norm(relative) * duration, margins = x.margin + y.margin;
  const double rounding = ROUND_UP * (place.error + (ROUND_ROTATION + 4.0) * ROUND_U * displacement);
  const implicit_goal goal = {.epsilon = fmax(asked.epsilon - 2.0 * rounding, 0.0),
                              .relative_epsilon = margins > 0.0 ? 0.0 : asked.relative_epsilon,
                              .max_steps = asked.max_nodes};
  implicit_answer found;
  implicit_solve(&query, &goal, NULL, memory, &found);

  /* the points, where the bodies are then: a has moved on as well */
  const vec3 moved = vec_scale(found.time, a.velocity);
  const vec3 on_a = vec_axpy(found.x, -x.margin, found.normal);
  vec3 on_b = vec_axpy(found.x, y.margin - found.upper, found.normal);
  if (found.overlap) on_b = on_a;
  *result = (cprox_result){.verdict = CPROX_VERDICT_UNDECIDED,
                           .lower = fmax(found.lower - margins - rounding, 0.0),
                           .upper = found.overlap ? 0.0 : fmax(found.upper - margins + rounding, 0.0),
                           .t = found.time,
                           .t_obstacle = NAN,
                           .witness_mover = vec_add(frame_to_world(&x.f, on_a), moved),
                           .witness_obstacle = vec_add(frame_to_world(&x.f, on_b), moved),
                           .normal = frame_turn_to_world(&x.f, found.overlap ? vec(0, 0, 0) : found.normal),
                           .lod = CPROX_LOD_HULL,
                           .nodes = found.steps};
  if (result->lower > 0.0) result->verdict = CPROX_VERDICT_CLEAR;
  if (found.overlap || found.upper - margins + rounding <= 0.0) result->verdict = CPROX_VERDICT_VIOLATED;
  const double width = result->upper - result->lower;
  const cprox_status status = width <= width_allowed(asked.epsilon, asked.relative_epsilon, result->upper) ? CPROX_OK
                              : found.steps >= asked.max_nodes ? CPROX_BUDGET
                                                               : CPROX_PRECISION;
  result->status = status;
  return finish(status, workspace);
}

/* A plane that separates the two at one time, and so bounds their distance at all times: value + slope (t - at). */
typedef struct time_cut {
  double at, value, slope;
} time_cut;

/* The pair at a time: its cut, and the least distance so far in *result. */
static cprox_status cut_at(const cprox_translating *a, const cprox_translating *b, double t,
                           const cprox_options *options, cprox_workspace *workspace, time_cut *cut,
                           cprox_result *result) {
  const vec3 relative = vec_sub(b->velocity, a->velocity);
  cprox_obstacle moved = b->from;
  moved.pose.position = vec_axpy(moved.pose.position, t, relative);
  cprox_result r;
  const cprox_status status = WORKSPACE_LEND(workspace, cprox_pair(a->from, moved, options, workspace, &r));
  if (status < 0) return status;
  const double rounding = ROUND_UP * ROUND_MOVED * ROUND_U * (vec_norm(b->from.pose.position) + vec_norm(relative) * t);
  *cut = (time_cut){.at = t, .value = r.lower - rounding, .slope = -vec_dot(r.normal, relative)};
  if (!(r.lower > 0.0)) cut->slope = 0.0; /* nothing separates them there; a distance is never below that value */
  r.upper += rounding;
  const uint32_t pairs = result->distance_queries + 1;
  if (r.upper < result->upper) {
    *result = r;
    result->t = t;
    result->witness_mover = vec_axpy(r.witness_mover, t, a->velocity);
    result->witness_obstacle = vec_axpy(r.witness_obstacle, t, a->velocity);
  }
  result->distance_queries = pairs;
  return CPROX_OK;
}

/* Of any two convex bodies: the distance is a convex function of time. A cut that falls and one that rises leave the
 * least value where they meet, and the pair there replaces one of them. */
static cprox_status distance_of_convex(const cprox_translating *a, const cprox_translating *b, double duration,
                                       const cprox_options *options, cprox_workspace *workspace, cprox_result *result) {
  cprox_options asked = *options;
  asked.epsilon = PART_OF_EPSILON * options->epsilon;
  cprox_result best = {.upper = INFINITY};
  time_cut falling, rising, cut;
  cprox_status status = cut_at(a, b, 0.0, &asked, workspace, &falling, &best);
  if (status >= 0) status = cut_at(a, b, duration, &asked, workspace, &rising, &best);
  if (status < 0) return status;
  const double room = MEET_ROUNDING * vec_norm(vec_sub(b->velocity, a->velocity)) * duration;
  double lower = 0.0;
  for (int i = 0; i < TRANSLATION_STEPS; i++) {
    const bool inner = falling.slope < 0.0 && rising.slope > 0.0;
    double meet = falling.slope >= 0.0 ? 0.0 : duration;
    if (inner)
      meet = (rising.slope * rising.at - falling.slope * falling.at + falling.value - rising.value) /
             (rising.slope - falling.slope);
    meet = fmin(fmax(meet, 0.0), duration);
    lower = fmax(falling.value + falling.slope * (meet - falling.at), rising.value + rising.slope * (meet - rising.at));
    lower -= room;
    if (!inner) lower = falling.slope >= 0.0 ? falling.value - room : rising.value - room;
    const double width = width_allowed(options->epsilon, options->relative_epsilon, best.upper);
    if (!inner || best.upper <= 0.0 || best.upper - fmax(lower, 0.0) <= width || meet == falling.at ||
        meet == rising.at)
      break;
    if ((status = cut_at(a, b, meet, &asked, workspace, &cut, &best)) < 0) return status;
    if (cut.slope < 0.0)
      falling = cut;
    else
      rising = cut;
    if (cut.slope == 0.0) falling = rising = cut; /* the least value is the cut's own */
  }
  best.verdict = best.upper <= 0.0 ? CPROX_VERDICT_VIOLATED
                 : lower > 0.0     ? CPROX_VERDICT_CLEAR
                                   : CPROX_VERDICT_UNDECIDED;
  best.upper = fmax(best.upper, 0.0);
  best.lower = fmin(fmax(lower, 0.0), best.upper);
  best.t_obstacle = NAN;
  best.status = best.upper - best.lower <= width_allowed(options->epsilon, options->relative_epsilon, best.upper)
                    ? CPROX_OK
                    : CPROX_PRECISION;
  workspace_clear(workspace);
  *result = best;
  return finish(best.status, workspace);
}

cprox_status cprox_translating_distance(cprox_translating a, cprox_translating b, double duration,
                                        const cprox_options *options, cprox_workspace *workspace,
                                        cprox_result *result) {
  WORKSPACE_USE(workspace);
  workspace_clear(workspace);
  const cprox_options asked = validate_defaults(options);
  const arguments_query kind = {"the distance of bodies that translate", ARGUMENTS_RELATIVE};
  const cprox_status status = check_motion(&a, &b, duration, &asked, kind, workspace);
  if (status) return status;
  if (!result) return workspace_fail(workspace, CPROX_INVALID, "result is NULL: nowhere to put the answer");
  const bool implicit_both = is_implicit(a.from.body) && is_implicit(b.from.body);
  return (implicit_both ? distance_of_implicit : distance_of_convex)(&a, &b, duration, &asked, workspace, result);
}

/* ---- time of contact ---- */

/* An approach of b to a: where it is, how far it is proven to be free. */
typedef struct approach {
  cprox_obstacle a, b; /* b at time 0 */
  vec3 velocity;       /* of b, seen from a */
  double duration;
  double free_until;
  bool never;             /* they part from here on */
  cprox_result last;      /* the pair at free_until */
  cprox_pair_start start; /* where the search of the last pair ended */
  uint32_t pairs;
} approach;

static cprox_obstacle approach_at(const approach *p, double t) {
  cprox_obstacle b = p->b;
  b.pose.position = vec_axpy(b.pose.position, t, p->velocity);
  return b;
}

/* Of two closed implicit bodies one search finds normal and time; where it stalls the interior point method says along
 * which normal to go on. What was proven counts in any case. */
static bool approach_implicit(approach *p, const cprox_options *options, cprox_workspace *workspace) {
  enum { MOST_STALLS = 3 };
  const pair_side x = relative_pose_of_side(&p->a, 0), y = relative_pose_of_side(&p->b, 0);
  const implicit *first = x.shape->implicit, *second = y.shape->implicit;
  if (!first->closed || !second->closed) return false;
  const pair_placement place = relative_pose_make(&x, &y);
  implicit_query query = {.a = first, .b = second, .moving = true, .t = place.t, .duration = p->duration};
  for (int i = 0; i < 9; i++) query.m[i] = place.r[i];
  query.velocity = frame_turn_to_local(&x.f, p->velocity);
  const double margins = x.margin + y.margin, moves = vec_norm(p->velocity) * p->duration,
               rounding = ROUND_UP * (place.error + (ROUND_ROTATION + 4.0) * ROUND_U * moves),
               epsilon = options->epsilon - 2.0 * rounding;
  implicit_answer found = {.time = 0.0};
  implicit_warm warm = {.usable = false};
  bool met = false;
  for (int stalls = 0;; stalls++) {
    met = implicit_approach(&query, epsilon, margins + rounding, &warm, &found);
    p->free_until = found.time;
    if (met || !warm.usable || stalls == MOST_STALLS) break;
    void *memory = workspace_reserve(workspace, WORKSPACE_INTERIOR, implicit_memory(first, second));
    if (!memory) return false;
    implicit_query there = query;
    there.moving = false;
    there.t = vec_axpy(query.t, found.time, query.velocity);
    const implicit_goal goal = {
        .epsilon = PART_OF_EPSILON * epsilon, .relative_epsilon = 1e-5, .max_steps = options->max_nodes};
    implicit_answer stood;
    implicit_solve(&there, &goal, &warm, memory, &stood);
    p->pairs++;
    if (stood.overlap || !(stood.lower > 0.0)) break;
    warm = (implicit_warm){.usable = true, .apart = stood.normal};
  }
  if (!met) return false;
  const vec3 on_a = convex_drawn(x.shape, found.x), b_is_at = vec_axpy(place.t, found.time, query.velocity),
             on_b = vec_add(rotate(query.m, convex_drawn(y.shape, found.y)), b_is_at);
  const double sizes = x.shape->scale + y.shape->scale + vec_norm(b_is_at) + margins;
  p->last = (cprox_result){
      .lower = found.lower - margins - rounding,
      .upper = vec_norm(vec_sub(on_a, on_b)) - margins + rounding + ROUND_UP * ROUND_WITNESS * ROUND_U * sizes,
      .t_obstacle = NAN,
      .witness_mover = frame_to_world(&x.f, vec_axpy(on_a, -x.margin, found.normal)),
      .witness_obstacle = frame_to_world(&x.f, vec_axpy(on_b, y.margin, found.normal)),
      .normal = frame_turn_to_world(&x.f, found.normal),
      .lod = CPROX_LOD_HULL};
  return p->last.upper <= options->epsilon;
}

/* Steps until the distance is at most epsilon, the end, or no further step can be proven. */
static cprox_status approach_run(approach *p, const cprox_options *options, cprox_workspace *workspace) {
  cprox_options asked = *options;
  if (is_implicit(p->a.body) && is_implicit(p->b.body) && approach_implicit(p, options, workspace)) return CPROX_OK;
  if (is_implicit(p->a.body) || is_implicit(p->b.body)) asked.start = &p->start; /* no pair of theirs has a formula */
  for (; p->pairs < TRANSLATION_STEPS; p->pairs++) {
    if (options->stop && p->pairs > 0 && options->stop(options->stop_user)) return CPROX_STOPPED;
    /* far away a rough answer steps as far as a fine one */
    asked.epsilon = PART_OF_EPSILON * options->epsilon;
    asked.relative_epsilon = ROUGH_STEP;
    const cprox_status status =
        WORKSPACE_LEND(workspace, cprox_pair(p->a, approach_at(p, p->free_until), &asked, workspace, &p->last));
    if (status < 0) return status;
    const cprox_result *r = &p->last;
    if (r->upper <= options->epsilon || r->status == CPROX_OVERLAP) return CPROX_OK;
    if (!(r->lower > 0.0)) return CPROX_PRECISION;

    /* what is between them along the normal shrinks by their speed along it; positions are rounded */
    const double towards = vec_dot(r->normal, p->velocity), speed = vec_norm(p->velocity);
    if (towards <= -ROUND_TOWARDS * ROUND_U * speed || speed == 0.0) {
      p->never = true;
      return CPROX_OK;
    }
    const double rounded = ROUND_MOVED * ROUND_U * (vec_norm(p->b.pose.position) + speed * p->duration);
    const double step = (r->lower - rounded) / (towards + ROUND_TOWARDS * ROUND_U * speed) * (1.0 - STEP_ROUNDING);
    const double next = step > 0.0 ? nextafter(p->free_until + step, -INFINITY) : 0.0; /* below the exact sum */
    if (!(next > p->free_until)) return CPROX_PRECISION;
    p->free_until = next;
    if (p->free_until >= p->duration) {
      p->free_until = p->duration;
      p->never = true;
      return CPROX_OK;
    }
  }
  return CPROX_BUDGET;
}

/* Whether a ball of the radius `room` about a point is proven to lie in a body. An implicit one is scaled about its
 * centre by more than the ball takes of its inner ball. */
static bool body_holds(const cprox_obstacle *obstacle, vec3 point, double room) {
  const pair_side side = relative_pose_of_side(obstacle, 0);
  const convex *shape = side.shape;
  double error = 0.0;
  const vec3 local = frame_to_local(&side.f, point, &error);
  room += error + side.error;
  if (is_implicit(obstacle->body)) {
    const implicit *body = shape->implicit;
    const double part = 1.01 * (room + 2.0 * body->give) / body->inner;
    return part < 0.5 && implicit_value(body, vec_scale(1.0 / (1.0 - part), local)) <= 0.0;
  }
  convex_near near;
  shape->ops->nearest(shape, local, NULL, &near);
  room += shape->ops->near_rounding * ROUND_U * (vec_norm(local) + shape->scale) + shape->slack;
  return near.distance <= -room;
}

/* They are within epsilon at free_until. A little later they may certainly touch: by their speed, a hundredth of
 * epsilon deep, and deeper than rounding could hide. Halfway between what were the nearest points is a common one,
 * where both bodies can tell. Else it is asked whether they touch, and not how deep: no distance changes by more than
 * they move. Then *at is that time, and p->last holds what is known there. */
static cprox_status approach_prove(approach *p, const cprox_options *options, cprox_workspace *workspace, double *at) {
  enum { MOST_STEPS = 12 };
  cprox_options fine = *options;
  fine.epsilon = fmin(PART_OF_EPSILON * options->epsilon, ROUGH_STEP * fabs(p->last.upper));
  fine.relative_epsilon = 0.0;
  cprox_result r = p->last;
  const double speed = vec_norm(p->velocity), towards = vec_dot(r.normal, p->velocity),
               rounded = 2.0 * ROUND_MOVED * ROUND_U * (vec_norm(p->b.pose.position) + speed * p->duration);
  double t = p->free_until, hidden = 128.0 * ROUND_U *
                                     (vec_norm(p->b.pose.position) + vec_norm(p->a.pose.position) +
                                      speed * p->duration + p->a.body->ball_radius + p->b.body->ball_radius);
  hidden = fmax(hidden, 0.01 * options->epsilon);
  for (int i = 0; i < MOST_STEPS && t < p->duration && r.upper > 0.0 && towards > 0.0; i++, hidden *= 8.0) {
    const double next = fmin(t + (r.upper + hidden) / towards * (1.0 + STEP_ROUNDING), p->duration);
    if (!(next > t)) break;
    t = next;
    const cprox_obstacle then = approach_at(p, t);
    const vec3 moved = vec_axpy(p->last.witness_obstacle, t - p->free_until, p->velocity),
               middle = vec_scale(0.5, vec_add(p->last.witness_mover, moved));
    p->pairs++;
    if (body_holds(&p->a, middle, rounded) && body_holds(&then, middle, rounded)) {
      r.upper = 0.0, r.witness_mover = r.witness_obstacle = middle;
      break;
    }
    const cprox_status status = WORKSPACE_LEND(workspace, cprox_pair_tolerance(p->a, then, 0.0, &fine, workspace, &r));
    if (status < 0) return status;
  }
  if (r.upper > 0.0) return CPROX_OK;
  r.lower = fmin(p->last.lower - ROUND_UP * (speed * (t - p->free_until) + rounded), 0.0);
  r.normal = p->last.normal;
  p->last = r;
  *at = t;
  return CPROX_OK;
}

cprox_status cprox_translating_contact(cprox_translating a, cprox_translating b, double duration,
                                       const cprox_options *options, cprox_workspace *workspace, cprox_result *result) {
  WORKSPACE_USE(workspace);
  workspace_clear(workspace);
  const cprox_options asked = validate_defaults(options);
  const arguments_query kind = {"contact of bodies that translate", ARGUMENTS_STOP};
  cprox_status status = check_motion(&a, &b, duration, &asked, kind, workspace);
  if (status) return status;
  if (!result) return workspace_fail(workspace, CPROX_INVALID, "result is NULL: nowhere to put the answer");

  approach p = {.a = a.from, .b = b.from, .velocity = vec_sub(b.velocity, a.velocity), .duration = duration};
  status = approach_run(&p, &asked, workspace);
  if (status < 0) return status;
  double at = p.free_until;
  if (status == CPROX_OK && !p.never && p.last.upper > 0.0) {
    const cprox_status proved = approach_prove(&p, &asked, workspace, &at);
    if (proved < 0) return proved;
  }
  workspace_clear(workspace);
  const vec3 moved = vec_scale(at, a.velocity);
  *result = p.last;
  result->t = at, result->t_contact_lower = p.free_until;
  result->verdict = p.never               ? CPROX_VERDICT_CLEAR
                    : p.last.upper <= 0.0 ? CPROX_VERDICT_VIOLATED
                                          : CPROX_VERDICT_UNDECIDED;
  result->witness_mover = vec_add(result->witness_mover, moved);
  result->witness_obstacle = vec_add(result->witness_obstacle, moved);
  result->distance_queries = p.pairs + 1;
  result->status = status;
  if (p.never) result->t_contact_lower = duration;
  return finish(status, workspace);
}

/* ---- growth, by an approach ---- */

cprox_status translation_growth(cprox_obstacle a, cprox_obstacle b, double inner, const cprox_options *asked,
                                cprox_workspace *workspace, cprox_growth *growth) {
  /* a's centre stands at 0, and b's comes along the line of the centres: what the positions share does not enter */
  const pair_side x = relative_pose_of_side(&a, 0), y = relative_pose_of_side(&b, 0);
  const vec3 centre_a = frame_turn_to_world(&x.f, x.f.centre), centre_b = frame_turn_to_world(&y.f, y.f.centre);
  const vec3 between = vec_sub(b.pose.position, a.pose.position), apart = vec_add(between, vec_sub(centre_b, centre_a));
  const double turned = ROUND_UP * (ROUND_ROTATION + 2.0) * ROUND_U * (vec_norm(centre_a) + vec_norm(centre_b)),
               apart_error = turned + ROUND_UP * ROUND_U * (vec_norm(between) + vec_norm(apart));
  const double reach = a.body->ball_radius + b.body->ball_radius, far = vec_norm(apart);
  *growth = (cprox_growth){.status = CPROX_OK};

  /* time runs from `most` centre distances down to 0; an error of the distance costs its part of the time */
  const double most = 1.01 * reach / far + 1e-6, begins = most * far;
  a.pose.position = vec_neg(centre_a);
  approach p = {.a = a, .b = b, .velocity = vec_neg(apart), .duration = most};
  p.b.pose.position = vec_axpy(vec_neg(centre_b), most, apart);
  cprox_options fine = *asked;
  fine.epsilon = fmax(0.1 * fmin(asked->epsilon, 0.1) * inner, 1e-13 * (reach + begins));
  const cprox_status status = approach_run(&p, &fine, workspace);
  if (status < 0) return status;
  const double rounding = 16.0 * ROUND_U * most,
               placed = turned + ROUND_MOVED * ROUND_U * (begins + vec_norm(centre_b));
  const double least = most - p.free_until + rounding;
  growth->lower = fmax(1.0 - (placed + least * apart_error) / inner, 0.0) / least;
  growth->normal = p.last.normal;
  growth->upper = INFINITY;

  /* from above by a place where they are proven to overlap: a little further on, and further until it is. The ball of
   * the radius `inner` within the difference of both bounds what the places' errors do to the factor */
  double beyond = 2.0 * fine.epsilon / far;
  for (int i = 0; i < 60 && isinf(growth->upper); i++, beyond *= 4.0) {
    const double s = most - p.free_until - beyond;
    cprox_result r;
    if (s <= rounding) break;
    const cprox_status found =
        WORKSPACE_LEND(workspace, cprox_pair(a, approach_at(&p, p.free_until + beyond), &fine, workspace, &r));
    if (found < 0) return found;
    p.pairs++;
    if (r.upper <= 0.0) growth->upper = (1.0 + (placed + s * apart_error) / inner) / (s - rounding);
  }
  growth->pairs = p.pairs + 1;
  const bool narrow = growth->upper - growth->lower <= asked->epsilon * fmax(growth->upper, 1e-300);
  growth->status = narrow ? CPROX_OK : status == CPROX_STOPPED ? CPROX_STOPPED : CPROX_PRECISION;
  return CPROX_OK;
}
