/* SPDX-License-Identifier: BSD-3-Clause */
/* Many movers against the same targets. doc/batches.md says what is done for each, and why that is sound. */
#include "curve_proximity/cprox/batch.h"

#include <math.h>
#include <stdio.h>

#include "base/rounding.h"
#include "base/workspace.h"
#include "query/answer.h"
#include "query/arguments.h"
#include "query/batch_targets.h"
#include "query/candidate_search.h"

enum { MOST_PIECES = 4 }; /* curves of more are searched along their tree of capsules instead of cut into chords */

/* One call. */
typedef struct batch_run {
  const cprox_batch *batch;
  question q;
  double *lower;   /* of each part's ball, padded */
  candidate *near; /* what may matter to the mover */
  double *basis;   /* of the degree below; 0: none yet */
  size_t degree;
  bool cut; /* the mover has chords: */
  lanes_chords chords[MOST_PIECES];
  double beside; /* how far the curve may be from the chords' points of the same parameter */
  double slack;  /* how much rounding may add to that */
  bool flat;     /* the whole curve lies in the plane of constant z */
  double plane;  /* this, exactly */
} batch_run;

/* As fmin and fmax for numbers, without a call. */
static inline double lesser(double a, double b) {
  return a < b ? a : b;
}

static inline double greater(double a, double b) {
  return a > b ? a : b;
}

/* What the chords tell of the parts. */
typedef struct first_look {
  size_t n;         /* candidates in `near`, */
  size_t promising; /* the one that has the least upper bound, */
  double upper;     /* this */
  double beyond;    /* the least lower bound of all others */
  bool met;         /* the promising one is met at its seed: the ball about `centre` with radius `within` is of it */
  vec3 centre;
  double within;
} first_look;

/* ---- chords ------------------------------------------------------------------------------------------------------------- */

/* The whole curve lies in a plane of constant z, exactly. */
static bool lies_in_plane(const cprox_curve *curve, double z) {
  const size_t n = curve->n_pieces * (curve->degree + 1);
  for (size_t i = 0; i < n; i++)
    if (curve->points[i].z != z) return false;
  return true;
}

/* Chords of parameter length h are within h²/8 max|psi''| of the curve, |psi''| <= n (n-1) max|second difference|. */
static void cut_curve(batch_run *run, const cprox_curve *curve) {
  run->cut = curve->n_pieces <= MOST_PIECES;
  if (!run->cut) return;
  if (run->degree != curve->degree) {
    lanes_basis(curve->degree, run->basis);
    run->degree = curve->degree;
  }
  double error = 0.0, bend2 = 0.0;
  for (size_t i = 0; i < curve->n_pieces; i++) {
    lanes_cut(run->basis, curve_piece(curve, i), curve->degree, &run->chords[i]);
    bend2 = greater(bend2, lanes_bend2(curve_piece(curve, i), curve->degree));
    error = greater(error, curve->error[i]);
  }
  run->plane = curve->points[0].z;
  run->flat = lies_in_plane(curve, run->plane);
  const double n = (double)curve->degree;
  run->beside = ROUND_UP * n * (n - 1.0) * sqrt(bend2) / (8.0 * CHORDS * CHORDS);
  /* the capsule holds all control points */
  const curve_capsule *capsule = &curve->capsules[1];
  const double magnitude = greater(vec_norm(capsule->a), vec_norm(capsule->b)) + capsule->radius;
  run->slack = ROUND_UP * (error + (10.0 * n + 40.0 + n * n / (CHORDS * CHORDS)) * ROUND_U * magnitude);
}

/* Chords against the balls of a part: bounds on the distance, and where the search should begin. Sets look->met
 * where the curve is seen to meet the part there. */
static double look_at(const batch_run *run, candidate *c, size_t part, first_look *look) {
  const batch_core *core = &run->batch->cores[part];
  double least = INFINITY, along = 0.0;
  size_t chord = 0, piece = 0;
  for (size_t i = 0; i < run->q.mover.curve->n_pieces; i++) {
    size_t k;
    double s;
    const double square = lanes_closest(&run->chords[i], core->centre, &k, &s);
    if (square >= least) continue;
    least = square;
    piece = i, chord = k, along = s;
  }
  const cprox_target *target = &run->batch->targets[c->target];
  const double distance = sqrt(least), margin = target->padding + run->q.mover.radius;
  const double slack =
      run->beside + ROUND_UP * (run->slack + 32.0 * ROUND_U * (distance + margin + run->batch->balls.sizes[part]));
  c->lower = greater(c->lower, distance - core->outer - margin - slack);
  c->seed_piece = (uint32_t)piece;
  c->seed_s = lesser(greater(((double)chord + along) / CHORDS, 1e-3), 1.0 - 1e-3);

  /* any point of the part is within the outer ball, and all points of the inner ball are of the part */
  const bool inside = core->inner >= 0.0 && (!core->flat || (run->flat && run->plane == target->pose.position.z));
  const double upper = distance + (inside ? -core->inner : core->outer) - margin + slack;
  look->met = inside && upper <= 0.0;
  if (look->met) {
    look->within = core->inner + target->padding;
    look->centre = core->centre;
    c->seed_s = ((double)chord + along) / CHORDS;
  }
  return upper;
}

/* Collects what comes within `most` as far as balls and chords can tell; stops where the curve is seen to meet a part. */
static first_look look_around(batch_run *run, double most) {
  const cprox_batch *batch = run->batch;
  const question *q = &run->q;
  first_look look = {.upper = INFINITY, .beyond = INFINITY};
  lanes_ball_bounds(&batch->balls, &q->reach, q->mover.radius, run->lower);
  bool cut = false;
  for (size_t k = 0; k < batch->balls.n; k++) {
    candidate c = batch->parts[k];
    c.lower = run->lower[k];
    double upper = INFINITY;
    if (c.lower <= lesser(most, look.upper) && batch->targets[c.target].body) {
      if (!cut) cut_curve(run, q->mover.curve);
      cut = true;
      if (run->cut) upper = look_at(run, &c, k, &look);
    }
    if (c.lower > lesser(most, look.upper)) {
      look.beyond = lesser(look.beyond, c.lower);
      continue;
    }
    if (upper < look.upper || look.met) look.upper = upper, look.promising = look.n;
    run->near[look.n++] = c;
    if (look.met) break;
  }
  return look;
}

/* The promising candidate first, the others nearest first. Those that a later one has ruled out leave: farther than the first one is,
 * they do not lower the union's bound. */
static void put_in_order(batch_run *run, first_look *look) {
  if (look->n == 0) return;
  candidate *near = run->near;
  const candidate first = near[look->promising];
  near[look->promising] = near[0];
  near[0] = first;
  size_t kept = 1;
  for (size_t i = 1; i < look->n; i++) {
    if (near[i].lower <= look->upper) near[kept++] = near[i];
  }
  look->n = kept;
  candidates_sort(near + 1, kept - 1);
}

/* ---- one mover ---------------------------------------------------------------------------------------------------------- */

/* The curve's point of the seed lies in a part: they meet there, whatever else there is. */
static cprox_status report_meeting(const batch_run *run, const first_look *look, cprox_result *r) {
  const cprox_curve *curve = run->q.mover.curve;
  const candidate *c = &run->near[look->promising];
  const double t0 = curve->breaks[c->seed_piece], t1 = curve->breaks[c->seed_piece + 1];
  const vec3 *p = curve_piece(curve, c->seed_piece);
  vec3 y;
  curve_bezier_evaluate(&p->x, &p->y, &p->z, 3, curve->degree, curve->binomial, c->seed_s, &y, NULL, NULL);
  const double distance = vec_norm(vec_sub(y, look->centre));
  if (distance > look->within) y = vec_lerp(look->centre, y, look->within / distance);
  *r = (cprox_result){.t = c->seed_s == 1.0 ? t1 : t0 + c->seed_s * (t1 - t0),
                      .t_target = NAN,
                      .on_mover = y,
                      .on_target = y,
                      .target_index = c->target,
                      .target_part = c->part,
                      .rung = CPROX_RUNG_SPHERE};
  return question_conclude(&run->q, INFINITY, CPROX_OK, r);
}

/* The union of what is near. */
static cprox_status search_near(const batch_run *run, const first_look *look, cprox_result *all) {
  const question *q = &run->q;
  cprox_status trouble = CPROX_OK;
  *all = question_nothing();
  double rest = look->beyond; /* the least bound of what was not searched */
  for (size_t i = 0; i < look->n; i++) {
    const candidate *c = &run->near[i];
    const bool too_far = !question_wants_verdict(q) && c->lower > all->upper;
    if (too_far || all->upper <= fmax(q->limit, 0.0) || trouble == CPROX_STOPPED) {
      rest = fmin(rest, c->lower);
      continue;
    }
    cprox_result one = {0};
    const cprox_status status = candidate_search(q, c, all->upper, &one);
    if (status < 0) return status;
    if (status != CPROX_OK) trouble = status;
    question_join(all, &one);
  }
  if (look->n == 0 && run->batch->n > 0) all->rung = CPROX_RUNG_SPHERE;
  all->lower = fmin(all->lower, fmax(rest, 0.0));
  return question_conclude(q, INFINITY, trouble, all);
}

static cprox_status answer_fast(batch_run *run, cprox_result *r) {
  const question *q = &run->q;
  question_ask_whole(&run->q);
  first_look look = look_around(run, question_wants_verdict(q) ? q->limit : INFINITY);
  if (look.met) return report_meeting(run, &look, r);
  put_in_order(run, &look);
  return search_near(run, &look, r);
}

/* ---- the call ----------------------------------------------------------------------------------------------------------- */

/* The short way is for points and balls along curves with control points. */
static bool may_be_fast(const batch_run *run, const cprox_mover *mover) {
  return mover->curve && !mover->curve->arcs && !mover->body && !mover->motion && mover->radius >= 0.0 &&
         isfinite(mover->radius) && !run->batch->on_clock && run->q.options.max_rung == CPROX_RUNG_MESH;
}

static cprox_status answer_one(batch_run *run, const cprox_mover *mover, cprox_result *r) {
  const question *q = &run->q;
  const cprox_target *targets = run->batch->targets;
  const size_t n = run->batch->n;
  workspace_clear(q->workspace);
  if (may_be_fast(run, mover)) {
    run->q.mover = *mover;
    return answer_fast(run, r);
  }
  if (!question_wants_verdict(q)) return cprox_distance_all(*mover, targets, n, &q->options, q->workspace, r, NULL);
  if (!q->farther_is_yes) return cprox_collision_all(*mover, targets, n, &q->options, q->workspace, r, NULL);
  return cprox_tolerance_all(*mover, targets, n, q->limit, &q->options, q->workspace, r, NULL);
}

static cprox_status check_call(const batch_run *run, const cprox_mover *movers, size_t first, size_t last,
                               const cprox_result *results) {
  cprox_workspace *workspace = run->q.workspace;
  if (!workspace) return CPROX_INVALID;
  workspace_clear(workspace);
  if (!run->batch) return workspace_fail(workspace, CPROX_INVALID, "batch is NULL");
  if (first > last)
    return workspace_fail(workspace, CPROX_INVALID, "the range begins at mover %zu and ends at %zu", first, last);
  if (first < last && !movers) return workspace_fail(workspace, CPROX_INVALID, "movers is NULL");
  if (first < last && !results) return workspace_fail(workspace, CPROX_INVALID, "results is NULL");
  if (run->q.options.certificate)
    return workspace_fail(workspace, CPROX_INVALID, "a batch leaves no certificates: ask about one mover for that");
  return arguments_check_options(&run->q.options, workspace);
}

static bool reserve(batch_run *run) {
  const lanes_balls *balls = &run->batch->balls;
  const size_t numbers = balls->padded + (CPROX_MAX_DEGREE + 1) * CHORDS;
  run->lower = workspace_reserve(run->q.workspace, WORKSPACE_BATCH, numbers * sizeof(double));
  run->near = workspace_reserve(run->q.workspace, WORKSPACE_BATCH_NEAR, (balls->n + 1) * sizeof *run->near);
  if (!run->lower || !run->near) return false;
  run->basis = run->lower + balls->padded;
  return true;
}

static cprox_status answer_range(question q, const cprox_batch *batch, const cprox_mover *movers, size_t first,
                                 size_t last, cprox_result *results) {
  batch_run run = {.batch = batch, .q = q};
  const cprox_status checked = check_call(&run, movers, first, last, results);
  if (checked != CPROX_OK) return checked;
  run.q.targets = batch->targets;
  run.q.n = batch->n;
  if (!reserve(&run))
    return workspace_fail(q.workspace, CPROX_MEMORY, "no memory for a batch of %zu targets", batch->n);

  cprox_status worst = CPROX_OK;
  char reason[320] = "";
  for (size_t i = first; i < last; i++) {
    cprox_result *r = &results[i];
    const cprox_status status = answer_one(&run, &movers[i], r);
    if (status < 0) {
      *r = question_nothing();
      r->status = status, r->lower = 0.0, r->verdict = CPROX_UNDECIDED;
    }
    if (worst >= 0 && (status < 0 || status > worst)) {
      worst = status;
      snprintf(reason, sizeof reason, "mover %zu: %s", i, cprox_workspace_reason(q.workspace));
    }
  }
  workspace_clear(q.workspace);
  return worst == CPROX_OK ? CPROX_OK : workspace_fail(q.workspace, worst, "%s", reason);
}

cprox_status cprox_batch_distance(const cprox_batch *batch, const cprox_mover *movers, size_t first, size_t last,
                                  const cprox_options *options, cprox_workspace *workspace, cprox_result *results) {
  const question q = question_create((cprox_mover){0}, NULL, 0, -1.0, false, options, workspace);
  return answer_range(q, batch, movers, first, last, results);
}

cprox_status cprox_batch_tolerance(const cprox_batch *batch, const cprox_mover *movers, size_t first, size_t last,
                                   double delta, const cprox_options *options, cprox_workspace *workspace,
                                   cprox_result *results) {
  if (!workspace) return CPROX_INVALID;
  const cprox_status checked = arguments_check_delta(delta, workspace);
  if (checked != CPROX_OK) return checked;
  const question q = question_create((cprox_mover){0}, NULL, 0, delta, true, options, workspace);
  return answer_range(q, batch, movers, first, last, results);
}

cprox_status cprox_batch_collision(const cprox_batch *batch, const cprox_mover *movers, size_t first, size_t last,
                                   const cprox_options *options, cprox_workspace *workspace, cprox_result *results) {
  const question q = question_create((cprox_mover){0}, NULL, 0, 0.0, false, options, workspace);
  return answer_range(q, batch, movers, first, last, results);
}
