/* SPDX-License-Identifier: BSD-3-Clause */
#include "query/batch_look.h"

#include <math.h>

#include "base/rounding.h"

/* ---- the curve ---------------------------------------------------------------------------------------------------------- */

/* Points at equal steps of the parameter, and what rounding may do to them, to chords between them and to lengths along these. */
static bool cut_curve(batch_run *run) {
  const cprox_curve *curve = run->q.mover.curve;
  const double *basis = lanes_basis(curve->degree, run->q.workspace);
  if (!basis) return false;
  double error = 0.0;
  for (size_t i = 0; i < curve->n_pieces; i++) {
    lanes_points(basis, curve_piece(curve, i), curve->degree, curve->flat, &run->chords[i]);
    error = greater(error, curve->error[i]);
  }
  const double n = (double)curve->degree;
  run->slack = ROUND_UP * (error + (10.0 * n + 40.0 + n * n / (CHORDS * CHORDS)) * ROUND_U * curve->largest);
  run->cut = true;
  return true;
}

/* Chords of parameter length h are within h²/8 max|psi''| of the curve, |psi''| <= n (n-1) max|second difference|. */
static void join_points(batch_run *run) {
  const cprox_curve *curve = run->q.mover.curve;
  double bend2 = 0.0;
  for (size_t i = 0; i < curve->n_pieces; i++) {
    lanes_join(&run->chords[i]);
    bend2 = greater(bend2, lanes_bend2(curve_piece(curve, i), curve->degree));
  }
  const double n = (double)curve->degree;
  run->beside = ROUND_UP * n * (n - 1.0) * sqrt(bend2) / (8.0 * CHORDS * CHORDS);
  run->joined = true;
}

static double margin_of(const batch_run *run, size_t part) {
  return run->batch->targets[run->batch->parts[part].target].padding + run->q.mover.radius;
}

/* Placing the centre of a compound's part costs (26 + 16) u of its lengths, all of which are in the part's sizes, the rest 18 u. */
static double slack_at(const batch_run *run, size_t part, double distance, double margin) {
  return ROUND_UP * (run->slack + 64.0 * ROUND_U * (distance + margin + run->batch->balls.sizes[part]));
}

/* ---- points against inner balls ------------------------------------------------------------------------------------------- */

/* All points of the inner ball are of the part; of a disc it counts only from its own plane. */
static bool has_inner_ball(const batch_run *run, size_t part) {
  const batch_core *core = &run->batch->cores[part];
  if (core->inner < 0.0) return false;
  return !core->flat ||
         (run->q.mover.curve->flat &&
          run->q.mover.curve->points[0].z == run->batch->targets[run->batch->parts[part].target].pose.position.z);
}

/* A point of the curve that is within the limit of the part's inner ball. */
static bool hits(const batch_run *run, size_t part, double limit, batch_hit *hit) {
  if (!has_inner_ball(run, part)) return false;
  const batch_core *core = &run->batch->cores[part];
  const double margin = margin_of(run, part), reach = core->inner + margin + limit;
  for (size_t i = 0; i < run->q.mover.curve->n_pieces; i++) {
    size_t k;
    const double square = lanes_nearest_point(&run->chords[i], core->centre, reach * reach, &k);
    if (square > reach * reach) continue;
    const double distance = sqrt(square);
    const double upper = distance - core->inner - margin + slack_at(run, part, distance, margin);
    if (upper > limit) continue;
    *hit = (batch_hit){.upper = greater(upper, 0.0),
                       .part = part,
                       .centre = core->centre,
                       .within = core->inner + margin - run->q.mover.radius,
                       .point = vec(run->chords[i].x[k], run->chords[i].y[k], run->chords[i].z[k]),
                       .piece = i,
                       .s = (double)k / CHORDS};
    return true;
  }
  return false;
}

static bool find_hit(batch_run *run, double limit, batch_hit *hit) {
  const cprox_batch *batch = run->batch;
  for (size_t k = 0; k < batch->balls.n; k++) {
    if (run->lower[k] > limit) continue;
    if (!run->cut && !cut_curve(run)) return false;
    if (hits(run, k, limit, hit)) return true;
  }
  return false;
}

/* ---- chords against all balls --------------------------------------------------------------------------------------------- */

/* Bounds on the distance, and where the search should begin. Raises c->lower; returns the upper bound. */
static double look_at(const batch_run *run, candidate *c, size_t part) {
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
  const double distance = sqrt(least), margin = margin_of(run, part);
  const double slack = run->beside + slack_at(run, part, distance, margin);
  c->lower = greater(c->lower, distance - core->outer - margin - slack);
  c->seed_piece = (uint32_t)piece;
  c->seed_s = lesser(greater(((double)chord + along) / CHORDS, 1e-3), 1.0 - 1e-3);
  return distance + (has_inner_ball(run, part) ? -core->inner : core->outer) - margin + slack;
}

/* The promising candidate first, the others nearest first. Those that a later one has ruled out leave: farther than the first one is,
 * they do not lower the union's bound. */
static void put_in_order(batch_run *run, size_t promising, double upper, batch_look *look) {
  if (look->n < 2) return;
  candidate *near = run->near;
  const candidate first = near[promising];
  near[promising] = near[0];
  near[0] = first;
  size_t kept = 1;
  for (size_t i = 1; i < look->n; i++) {
    if (near[i].lower <= upper) near[kept++] = near[i];
  }
  look->n = kept;
  candidates_sort(near + 1, kept - 1);
}

void batch_look_around(batch_run *run, batch_look *look) {
  const cprox_batch *batch = run->batch;
  const question *q = &run->q;
  look->n = 0;
  look->beyond = INFINITY;
  run->cut = run->joined = false;
  lanes_ball_bounds(&batch->balls, &q->reach, q->mover.radius, run->lower);

  const bool short_enough = q->mover.curve->n_pieces <= BATCH_MOST_PIECES;
  look->is_hit = short_enough && find_hit(run, greater(q->limit, 0.0), &look->hit);
  if (look->is_hit) {
    for (size_t k = 0; k < batch->balls.n; k++) look->beyond = lesser(look->beyond, run->lower[k]);
    return;
  }

  /* what comes within `most` as far as balls and chords can tell */
  const double most = question_wants_verdict(q) ? q->limit : INFINITY;
  double least_upper = INFINITY;
  size_t promising = 0;
  for (size_t k = 0; k < batch->balls.n; k++) {
    if (run->lower[k] > lesser(most, least_upper)) {
      look->beyond = lesser(look->beyond, run->lower[k]);
      continue;
    }
    candidate *c = &run->near[look->n];
    *c = batch->parts[k];
    c->lower = run->lower[k];
    double upper = INFINITY;
    if (short_enough && batch->targets[c->target].body) {
      if (!run->joined && (run->cut || cut_curve(run))) join_points(run);
      if (run->joined) upper = look_at(run, c, k);
    }
    if (c->lower > lesser(most, least_upper)) {
      look->beyond = lesser(look->beyond, c->lower);
      continue;
    }
    if (upper < least_upper) least_upper = upper, promising = look->n;
    look->n++;
  }
  put_in_order(run, promising, least_upper, look);
}
