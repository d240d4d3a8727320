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

enum { MOST_PIECES = 4 }; /* curves of more are searched along their tree of capsules instead of sampled */

/* One call. */
typedef struct batch_run {
  const cprox_batch *batch;
  question q;
  double *lower; /* of each part's ball, padded */
  candidate *near;
  double *basis; /* of the degree below; 0: none yet */
  size_t degree;
  bool sampled; /* the mover has samples: */
  double samples[MOST_PIECES][3 * SAMPLES];
  double samples_slack; /* how far they may be from the curve */
} batch_run;

/* The part that is near in any case, and may already be met. */
typedef struct first_look {
  size_t most_promising; /* in `near` */
  double upper;          /* on the distance from it */
  bool met;              /* the sample of its seed lies in it, */
  vec3 at;               /* here */
} first_look;

/* ---- samples ------------------------------------------------------------------------------------------------------------ */

static void take_samples(batch_run *run, const cprox_curve *curve) {
  run->sampled = curve->n_pieces <= MOST_PIECES;
  if (!run->sampled) return;
  if (run->degree != curve->degree) {
    lanes_basis(curve->degree, run->basis);
    run->degree = curve->degree;
  }
  double error = 0.0;
  for (size_t i = 0; i < curve->n_pieces; i++) {
    lanes_sample(run->basis, curve_piece(curve, i), curve->degree, run->samples[i]);
    error = fmax(error, curve->error[i]);
  }
  /* the basis is within 4 n u of itself, sums of n + 1 products follow; the capsule holds all control points */
  const curve_capsule *capsule = &curve->capsules[1];
  const double magnitude = fmax(vec_norm(capsule->a), vec_norm(capsule->b)) + capsule->radius;
  const double n = (double)curve->degree;
  run->samples_slack = ROUND_UP * (error + (10.0 * n + 16.0) * ROUND_U * magnitude);
}

/* The sample that is nearest to a point; its square distance, and where it is on the curve. */
static double closest_sample(const batch_run *run, vec3 centre, size_t *piece, size_t *sample) {
  double least = INFINITY;
  for (size_t i = 0; i < run->q.mover.curve->n_pieces; i++) {
    size_t k;
    const double square = lanes_closest(run->samples[i], centre, &k);
    if (square >= least) continue;
    least = square;
    *piece = i, *sample = k;
  }
  return least;
}

/* The whole curve lies in a plane of constant z, exactly. */
static bool lies_in_plane(const cprox_curve *curve, double z) {
  const size_t n = curve->n_pieces * (curve->degree + 1);
  for (size_t i = 0; i < n; i++)
    if (curve->points[i].z != z) return false;
  return true;
}

/* Samples against the ball inside a part: where the search against it should begin, and an upper bound on the distance. */
static double look_at(const batch_run *run, candidate *c, size_t part, bool *met, vec3 *at) {
  const batch_core *core = &run->batch->cores[part];
  size_t piece = 0, sample = 0;
  const double distance = sqrt(closest_sample(run, core->centre, &piece, &sample));
  c->seed_piece = (uint32_t)piece;
  c->seed_s = ((double)sample + 0.5) / SAMPLES;

  /* any point of the part is within the bounding ball, and all points of the inscribed ball are of the part */
  const cprox_target *target = &run->batch->targets[c->target];
  const double margin = target->padding + run->q.mover.radius;
  const double slack = ROUND_UP * (run->samples_slack + 16.0 * ROUND_U * (distance + run->batch->balls.sizes[part]));
  const bool inside =
      core->radius >= 0.0 && (!core->flat || lies_in_plane(run->q.mover.curve, target->pose.position.z));
  const double reach = inside ? -core->radius : core->extent;
  const double upper = distance + reach - margin + slack;
  *met = inside && upper <= 0.0;
  if (*met) {
    const double *x = run->samples[piece] + sample;
    const vec3 y = vec(x[0], x[SAMPLES], x[2 * SAMPLES]);
    const double within = core->radius + target->padding;
    *at = distance > within ? vec_lerp(core->centre, y, within / distance) : y;
  }
  return upper;
}

/* Looks at all that is near; stops where the curve is seen to meet a part. */
static first_look look_around(batch_run *run, size_t n) {
  first_look look = {.upper = INFINITY};
  for (size_t i = 0; i < n && run->sampled && !look.met; i++) {
    candidate *c = &run->near[i];
    if (!candidate_body(&run->q, c)) continue;
    const size_t part = (size_t)c->mover_part;
    c->mover_part = 0;
    const double upper = look_at(run, c, part, &look.met, &look.at);
    if (upper < look.upper) look.upper = upper, look.most_promising = i;
  }
  return look;
}

/* ---- one mover ---------------------------------------------------------------------------------------------------------- */

/* The parts whose balls come within `most`, nearest first; *beyond becomes the least bound of the others. mover_part is lent to the
 * number of the part. */
static size_t gather(batch_run *run, double most, double *beyond) {
  const lanes_balls *balls = &run->batch->balls;
  lanes_ball_bounds(balls, &run->q.reach, run->q.mover.radius, run->lower);
  size_t n = 0;
  *beyond = INFINITY;
  for (size_t k = 0; k < balls->n; k++) {
    if (run->lower[k] > most) {
      *beyond = fmin(*beyond, run->lower[k]);
      continue;
    }
    run->near[n] = run->batch->parts[k];
    run->near[n].lower = run->lower[k];
    run->near[n++].mover_part = (int32_t)k;
  }
  candidates_sort(run->near, n);
  return n;
}

/* A sample lies in a part: they meet there, whatever else there is. */
static void report_meeting(const batch_run *run, const candidate *c, vec3 at, cprox_result *r) {
  const cprox_curve *curve = run->q.mover.curve;
  const double t0 = curve->breaks[c->seed_piece], t1 = curve->breaks[c->seed_piece + 1];
  *r = question_nothing();
  r->lower = r->upper = 0.0;
  r->t = t0 + c->seed_s * (t1 - t0);
  r->on_mover = r->on_target = at;
  r->target_index = c->target, r->target_part = c->part;
  r->rung = CPROX_RUNG_SPHERE;
}

/* The union of what is near, the most promising part first. */
static cprox_status search_near(const batch_run *run, size_t n, size_t most_promising, double beyond,
                                cprox_result *all) {
  const question *q = &run->q;
  cprox_status trouble = CPROX_OK;
  *all = question_nothing();
  double rest = INFINITY; /* the least bound of what was not searched */
  for (size_t turn = 0; turn < n; turn++) {
    const size_t i = turn == 0 ? most_promising : turn <= most_promising ? turn - 1 : turn;
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
  if (n == 0 && isfinite(beyond)) all->rung = CPROX_RUNG_SPHERE;
  all->lower = fmin(all->lower, fmax(fmin(rest, beyond), 0.0));
  return question_conclude(q, INFINITY, trouble, all);
}

static cprox_status answer_fast(batch_run *run, cprox_result *r) {
  question *q = &run->q;
  question_ask_whole(q);
  double beyond;
  size_t n = gather(run, question_wants_verdict(q) ? q->limit : INFINITY, &beyond);
  if (n > 0) take_samples(run, q->mover.curve);
  const first_look look = look_around(run, n);
  for (size_t i = 0; i < n; i++) run->near[i].mover_part = 0;
  if (look.met) {
    report_meeting(run, &run->near[look.most_promising], look.at, r);
    return question_conclude(q, INFINITY, CPROX_OK, r);
  }
  /* distances: what is farther than that does not matter */
  while (n > 0 && run->near[n - 1].lower > look.upper) beyond = fmin(beyond, run->near[--n].lower);
  return search_near(run, n, look.most_promising, beyond, r);
}

/* ---- the call ----------------------------------------------------------------------------------------------------------- */

/* The short way is for points and balls along curves with control points. */
static bool may_be_fast(const batch_run *run, const cprox_mover *mover) {
  return mover->curve && !mover->curve->arcs && !mover->body && mover->radius >= 0.0 && isfinite(mover->radius) &&
         !run->batch->on_clock;
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
  const size_t numbers = balls->padded + (CPROX_MAX_DEGREE + 1) * SAMPLES;
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
