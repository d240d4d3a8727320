/* SPDX-License-Identifier: BSD-3-Clause */
/* Distance, tolerance, collision: of one mover against one target or against many. All six are one search. */
#include "base/frame.h"
#include "base/rounding.h"
#include "base/workspace.h"
#include "body/body.h"
#include "curve/curve.h"
#include "query/arguments.h"
#include "query/curve_convex.h"
#include "search/search.h"

/* ---- the question ----------------------------------------------------------------------------------------------------- */

typedef struct question {
  cprox_mover mover;
  const cprox_target *targets;
  size_t n;
  double limit;        /* verdicts: delta, 0 for collision; distance: -1 */
  bool farther_is_yes; /* tolerance's yes is collision's no */
  cprox_options options;
  cprox_workspace *workspace;
} question;

static bool wants_verdict(const question *q) {
  return q->limit >= 0.0;
}

/* One convex part of one target, with what its bounding ball says. */
typedef struct candidate {
  double lower;
  int32_t target, part;
} candidate;

static const cprox_body *candidate_body(const question *q, const candidate *c) {
  const cprox_body *body = q->targets[c->target].body;
  return body->kind == CPROX_COMPOUND ? body->parts[c->part].body : body;
}

static cprox_pose candidate_pose(const question *q, const candidate *c) {
  const cprox_target *target = &q->targets[c->target];
  if (target->body->kind != CPROX_COMPOUND) return target->pose;
  return frame_compose(&target->pose, &target->body->parts[c->part].pose);
}

static double candidate_offset(const question *q, const candidate *c) {
  return q->mover.radius + q->targets[c->target].padding;
}

/* ---- bounding balls ---------------------------------------------------------------------------------------------------- */

static double distance_to_segment(vec3 p, vec3 a, vec3 b) {
  const vec3 ab = vec_sub(b, a), ap = vec_sub(p, a);
  const double length2 = vec_norm2(ab), along = vec_dot(ap, ab);
  const double s = length2 > 0.0 ? fmin(fmax(along / length2, 0.0), 1.0) : 0.0;
  return vec_norm(vec_sub(p, vec_lerp(a, b, s)));
}

/* The curve's capsule against the candidate's ball: never above the true distance. */
static double ball_bound(const question *q, const candidate *c) {
  const cprox_body *body = candidate_body(q, c);
  if (!isfinite(body->ball_radius)) return -INFINITY;
  const cprox_pose pose = candidate_pose(q, c);
  const frame f = frame_create(&pose, vec(0, 0, 0));
  const vec3 centre = frame_to_world(&f, body->ball_centre);
  const curve_capsule *capsule = &q->mover.curve->capsules[1];
  const double reach = capsule->radius + body->ball_radius + candidate_offset(q, c);
  /* rounding: the pose of the centre, the projection on the chord, the sums; doc/rounding.md */
  const double sizes = vec_norm(capsule->a) + vec_norm(capsule->b) + vec_norm(centre) + vec_norm(f.position) +
                       vec_norm(body->ball_centre) + reach;
  return distance_to_segment(centre, capsule->a, capsule->b) - reach - 64.0 * ROUND_U * sizes;
}

/* Shell's sort by lower: qsort may allocate. */
static void sort_candidates(candidate *list, size_t n) {
  for (size_t gap = n / 2; gap > 0; gap /= 2) {
    for (size_t i = gap; i < n; i++) {
      const candidate moved = list[i];
      size_t k = i;
      for (; k >= gap && list[k - gap].lower > moved.lower; k -= gap) list[k] = list[k - gap];
      list[k] = moved;
    }
  }
}

/* All parts of targets first … last - 1, nearest ball first. NULL where memory is out. */
static candidate *list_candidates(const question *q, size_t first, size_t last, size_t *count) {
  size_t n = 0;
  for (size_t i = first; i < last; i++)
    n += q->targets[i].body->kind == CPROX_COMPOUND ? q->targets[i].body->n_parts : 1;
  candidate *list = workspace_reserve(q->workspace, WORKSPACE_ORDER, n * sizeof *list);
  if (!list) return NULL;
  size_t k = 0;
  for (size_t i = first; i < last; i++) {
    const cprox_body *body = q->targets[i].body;
    const size_t parts = body->kind == CPROX_COMPOUND ? body->n_parts : 1;
    for (size_t part = 0; part < parts; part++) {
      list[k] = (candidate){.target = (int32_t)i, .part = (int32_t)part};
      list[k].lower = ball_bound(q, &list[k]);
      k++;
    }
  }
  sort_candidates(list, n);
  *count = n;
  return list;
}

/* ---- one candidate ------------------------------------------------------------------------------------------------------ */

enum { VERDICT_NODES_BEFORE_NEWTON = 4 };

static search_goal goal_of(const question *q, double ceiling) {
  return (search_goal){.order = wants_verdict(q) ? SEARCH_DEPTH_FIRST : SEARCH_BEST_FIRST,
                       .limit = q->limit,
                       .ceiling = ceiling,
                       .epsilon = q->options.epsilon,
                       .relative_epsilon = q->options.relative_epsilon,
                       .max_nodes = q->options.max_nodes,
                       .stop = q->options.stop,
                       .stop_user = q->options.stop_user};
}

/* Writes the best sight as a result in the world frame: surface points of the padded body and of the ball. */
static void report_witness(const question *q, const candidate *c, const curve_convex *o, cprox_result *r) {
  const curve_sight *best = &o->best;
  const double padding = q->targets[c->target].padding;
  const frame *f = &o->side.frame;
  const vec3 centre = frame_to_world(f, best->y), surface = frame_to_world(f, best->near.point);
  const vec3 normal = frame_turn_to_world(f, best->normal);
  r->t = curve_side_parameter(&o->side, best->piece, best->s);
  const double d = best->near.distance;
  r->normal = normal;
  r->target_index = c->target, r->target_part = c->part;
  if (d > o->offset) {
    r->on_target = vec_axpy(surface, padding, normal);
    r->on_mover = vec_axpy(centre, -q->mover.radius, normal);
  } else {
    /* overlap: one point of both, the padded body's nearest one to the ball's centre */
    r->on_mover = r->on_target = d > padding ? vec_axpy(surface, padding, normal) : centre;
  }
}

/* Searches one candidate; *r holds its own interval, and the witness where it beats `ceiling`. */
static cprox_status search_candidate(const question *q, const candidate *c, double ceiling, cprox_result *r) {
  const cprox_body *body = candidate_body(q, c);
  const cprox_pose pose = candidate_pose(q, c);
  curve_convex o;
  if (!curve_convex_begin(&o, q->mover.curve, &body->shape, frame_create(&pose, body->centre), candidate_offset(q, c),
                          q->workspace))
    return workspace_fail(q->workspace, CPROX_MEMORY, "no memory for the control points");
  o.polish_after = wants_verdict(q) ? VERDICT_NODES_BEFORE_NEWTON : 0;
  o.good_enough = wants_verdict(q) ? q->limit : q->options.epsilon;
  o.epsilon = q->options.epsilon;

  const search_goal goal = goal_of(q, ceiling);
  const search_oracle oracle = curve_convex_oracle(&o);
  search_outcome found;
  const cprox_status status = search_run(&goal, &oracle, curve_convex_root(), q->workspace, &found);
  if (status < 0) {
    if (status == CPROX_MEMORY) workspace_fail(q->workspace, status, "no memory for the open intervals");
    return status;
  }

  *r = (cprox_result){
      .status = status, .target_index = -1, .rung = CPROX_RUNG_HULL, .nodes = found.nodes, .probes = o.probes};
  r->upper = fmax(found.best.upper, 0.0);
  r->lower = fmin(fmax(found.lower, 0.0), r->upper);
  r->lower = fmax(r->lower, fmin(fmax(c->lower, 0.0), r->upper));
  if (o.incumbent > 0) report_witness(q, c, &o, r);
  return status;
}

/* ---- the answer --------------------------------------------------------------------------------------------------------- */

static cprox_verdict verdict_of(const question *q, const cprox_result *r) {
  if (!wants_verdict(q)) return CPROX_UNDECIDED;
  if (r->upper <= q->limit) return q->farther_is_yes ? CPROX_NO : CPROX_YES;
  if (r->lower > q->limit) return q->farther_is_yes ? CPROX_YES : CPROX_NO;
  return CPROX_UNDECIDED;
}

/* Whether the interval is what was asked for, whatever happened on the way. */
static bool is_satisfied(const question *q, const cprox_result *r) {
  if (wants_verdict(q) && verdict_of(q, r) != CPROX_UNDECIDED) return true;
  return !(r->upper - r->lower > fmax(q->options.epsilon, q->options.relative_epsilon * r->upper));
}

static const char *shortfall(cprox_status status) {
  switch (status) {
    case CPROX_BUDGET: return "the budget of nodes ended the search: raise max_nodes or epsilon";
    case CPROX_PRECISION: return "epsilon is below what double arithmetic allows at this scale";
    case CPROX_STOPPED: return "the stop function ended the search";
    default: return "";
  }
}

/* The union of targets first … last - 1. */
static cprox_status answer(const question *q, size_t first, size_t last, cprox_result *result) {
  size_t n = 0;
  const candidate *list = NULL;
  if (last > first) {
    list = list_candidates(q, first, last, &n);
    if (!list) return workspace_fail(q->workspace, CPROX_MEMORY, "no memory for a list of targets");
  }

  cprox_result all = {.lower = INFINITY, .upper = INFINITY, .target_index = -1};
  cprox_status trouble = CPROX_OK;
  for (size_t i = 0; i < n; i++) {
    /* sorted: when one ball is too far to matter, so are the rest */
    const bool too_far = wants_verdict(q) ? list[i].lower > q->limit : list[i].lower > all.upper;
    if (too_far || trouble == CPROX_STOPPED) {
      all.lower = fmin(all.lower, fmax(list[i].lower, 0.0));
      if (all.rung == CPROX_RUNG_NONE) all.rung = CPROX_RUNG_SPHERE;
      break;
    }

    cprox_result one = {0};
    const cprox_status status = search_candidate(q, &list[i], all.upper, &one);
    if (status < 0) return status;
    if (status != CPROX_OK) trouble = status;

    /* the union's interval: the least of both ends, with the witness of the upper one */
    const double lower = fmin(all.lower, one.lower);
    const uint32_t nodes = all.nodes + one.nodes, probes = all.probes + one.probes;
    if (one.upper < all.upper || all.target_index < 0) all = one;
    all.lower = lower, all.nodes = nodes, all.probes = probes;
    all.rung = CPROX_RUNG_HULL;
    if (wants_verdict(q) ? all.upper <= q->limit : all.upper <= 0.0) break;
  }

  all.lower = fmin(all.lower, all.upper);
  all.status = is_satisfied(q, &all) ? CPROX_OK : trouble != CPROX_OK ? trouble : CPROX_PRECISION;
  all.verdict = verdict_of(q, &all);
  if (all.status != CPROX_OK) workspace_fail(q->workspace, all.status, "%s", shortfall(all.status));
  *result = all;
  return all.status;
}

static cprox_status ask(const question *q, cprox_result *nearest, cprox_result *each) {
  workspace_clear(q->workspace);
  const cprox_status checked = arguments_check_query(&q->mover, q->targets, q->n, &q->options, q->workspace);
  if (checked != CPROX_OK) return checked;
  if (!each) return answer(q, 0, q->n, nearest);

  /* each target by itself; the union is the least of them */
  cprox_result all = {.lower = INFINITY, .upper = INFINITY, .target_index = -1};
  all.verdict = verdict_of(q, &all);
  for (size_t i = 0; i < q->n; i++) {
    cprox_result one;
    const cprox_status status = answer(q, i, i + 1, &one);
    if (status < 0) return status;
    if (one.target_index < 0) one.target_index = (int32_t)i;
    each[i] = one;
    const double lower = fmin(all.lower, one.lower);
    const uint32_t nodes = all.nodes + one.nodes, probes = all.probes + one.probes;
    const cprox_status worst = one.status > all.status ? one.status : all.status;
    if (one.upper < all.upper || i == 0) all = one;
    all.lower = lower, all.nodes = nodes, all.probes = probes, all.status = worst;
  }
  all.verdict = verdict_of(q, &all);
  *nearest = all;
  return all.status;
}

static question question_create(cprox_mover mover, const cprox_target *targets, size_t n, double limit,
                                bool farther_is_yes, const cprox_options *options, cprox_workspace *workspace) {
  return (question){.mover = mover,
                    .targets = targets,
                    .n = n,
                    .limit = limit,
                    .farther_is_yes = farther_is_yes,
                    .options = options ? *options : cprox_options_default(),
                    .workspace = workspace};
}

/* ---- the verbs ---------------------------------------------------------------------------------------------------------- */

cprox_status cprox_distance_all(cprox_mover mover, const cprox_target *targets, size_t n, const cprox_options *options,
                                cprox_workspace *workspace, cprox_result *nearest, cprox_result *each) {
  const question q = question_create(mover, targets, n, -1.0, false, options, workspace);
  return ask(&q, nearest, each);
}

cprox_status cprox_tolerance_all(cprox_mover mover, const cprox_target *targets, size_t n, double delta,
                                 const cprox_options *options, cprox_workspace *workspace, cprox_result *nearest,
                                 cprox_result *each) {
  const cprox_status checked = arguments_check_delta(delta, workspace);
  if (checked != CPROX_OK) return checked;
  const question q = question_create(mover, targets, n, delta, true, options, workspace);
  return ask(&q, nearest, each);
}

cprox_status cprox_collision_all(cprox_mover mover, const cprox_target *targets, size_t n, const cprox_options *options,
                                 cprox_workspace *workspace, cprox_result *nearest, cprox_result *each) {
  const question q = question_create(mover, targets, n, 0.0, false, options, workspace);
  return ask(&q, nearest, each);
}

cprox_status cprox_distance(cprox_mover mover, cprox_target target, const cprox_options *options,
                            cprox_workspace *workspace, cprox_result *result) {
  return cprox_distance_all(mover, &target, 1, options, workspace, result, NULL);
}

cprox_status cprox_tolerance(cprox_mover mover, cprox_target target, double delta, const cprox_options *options,
                             cprox_workspace *workspace, cprox_result *result) {
  return cprox_tolerance_all(mover, &target, 1, delta, options, workspace, result, NULL);
}

cprox_status cprox_collision(cprox_mover mover, cprox_target target, const cprox_options *options,
                             cprox_workspace *workspace, cprox_result *result) {
  return cprox_collision_all(mover, &target, 1, options, workspace, result, NULL);
}
