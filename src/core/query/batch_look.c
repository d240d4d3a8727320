/* SPDX-License-Identifier: BSD-3-Clause */
#include "query/batch_look.h"

#include <math.h>

#include "base/rounding.h"

/* ---- the curve ---------------------------------------------------------------------------------------------------------- */

/* What rounding may do to points at equal steps of the parameter, to chords between them and to lengths along these. */
static bool measure(batch_run *run) {
  const cprox_curve *curve = run->q.mover.curve;
  if (run->degree != curve->degree) {
    run->basis = lanes_basis(curve->degree, run->q.workspace);
    run->degree = run->basis ? curve->degree : SIZE_MAX;
  }
  if (!run->basis) return false;
  const double n = (double)curve->degree;
  run->slack =
      ROUND_UP * (curve->worst + (10.0 * n + 40.0 + n * n * (1.0 / (CHORDS * CHORDS))) * ROUND_U * curve->largest);
  run->measured = true;
  return true;
}

/* The least square distance of the points of half a piece from a point, and which one has it. */
static double look_along(batch_run *run, uint32_t half, vec3 from, uint32_t *nearest) {
  const cprox_curve *curve = run->q.mover.curve;
  const uint32_t piece = half / 2, first = half % 2 * LANES;
  lanes_chords *chords = &run->chords[piece];
  double square;
  if (run->cut >> half & 1)
    square = lanes_nearest_point(chords, first, from, nearest);
  else
    square =
        lanes_points(run->basis, curve_piece(curve, piece), curve->degree, curve->flat, first, from, chords, nearest);
  run->cut |= 1u << half;
  *nearest += first;
  return square;
}

/* Chords of parameter length h are within h²/8 max|psi''| of the curve, |psi''| <= n (n-1) max|second difference|. */
static void join_points(batch_run *run) {
  const cprox_curve *curve = run->q.mover.curve;
  double bend2 = 0.0;
  for (uint32_t i = 0; i < curve->n_pieces; i++) {
    uint32_t unused;
    for (uint32_t half = 2 * i; half < 2 * i + 2; half++)
      if (!(run->cut >> half & 1)) look_along(run, half, vec(0, 0, 0), &unused);
    lanes_join(&run->chords[i]);
    bend2 = greater(bend2, lanes_bend2(curve_piece(curve, i), curve->degree));
  }
  const double n = (double)curve->degree;
  run->beside = ROUND_UP * n * (n - 1.0) * sqrt(bend2) / (8.0 * CHORDS * CHORDS);
  run->joined = true;
}

static double margin_of(const batch_run *run, size_t part) {
  return run->batch->cores[part].padding + run->q.mover.radius;
}

/* Placing the centre of a compound's part costs (26 + 16) u of its lengths, all of which are in the part's sizes, the rest 18 u. */
static double slack_at(const batch_run *run, size_t part, double distance, double margin) {
  return ROUND_UP * (run->slack + 64.0 * ROUND_U * (distance + margin + run->batch->balls.sizes[part]));
}

/* ---- boxes against all balls ------------------------------------------------------------------------------------------------ */

/* The parts that come within `most` as far as `lower` can tell; the least bound of the others. */
static double list_open(batch_run *run, double most) {
  double beyond = INFINITY;
  size_t n = 0;
  for (size_t k = 0; k < run->batch->balls.n; k++) {
    const double lower = run->lower[k];
    const bool is_open = !(lower > most);
    run->open[n] = (uint32_t)k;
    n += is_open;
    beyond = lesser(beyond, is_open ? INFINITY : lower);
  }
  run->n_open = n;
  return beyond;
}

/* Where many parts come within `most` of the curve's capsule, boxes round stretches of its pieces rule out most of them at once. */
static double bound_by_boxes(batch_run *run, double most, double beyond) {
  enum { PAYS_FROM = 8 };
  if (run->n_open < PAYS_FROM || !measure(run)) return beyond;
  join_points(run);
  const size_t pieces = run->q.mover.curve->n_pieces;
  lanes_box boxes[BATCH_MOST_PIECES * STRETCHES];
  for (size_t i = 0; i < pieces; i++) lanes_boxes(&run->chords[i], boxes + i * STRETCHES);
  const double radius = run->q.mover.radius + run->beside;
  lanes_box_bounds(&run->batch->balls, boxes, pieces * STRETCHES, radius, run->slack, run->lower);
  return list_open(run, most);
}

/* ---- points against inner balls ------------------------------------------------------------------------------------------- */

/* All points of the inner ball are of the part; of a disc it counts only from its own plane. */
static bool has_inner_ball(const batch_run *run, size_t part) {
  const batch_core *core = &run->batch->cores[part];
  const cprox_curve *curve = run->q.mover.curve;
  return core->inner >= 0.0 && (!core->flat || (curve->flat && curve->points[0].z == core->plane));
}

/* A point of half a piece that is within the limit of the part's inner ball. */
static bool hits(batch_run *run, size_t part, uint32_t half, double limit, batch_hit *hit) {
  const batch_core *core = &run->batch->cores[part];
  const double margin = margin_of(run, part), reach = core->inner + margin + limit;
  uint32_t k;
  const double square = look_along(run, half, core->centre, &k);
  if (square > reach * reach) return false;
  const double distance = sqrt(square);
  const double upper = distance - core->inner - margin + slack_at(run, part, distance, margin);
  if (upper > limit) return false;
  const lanes_chords *chords = &run->chords[half / 2];
  const vec3 point = vec(chords->x[k], chords->y[k], chords->z[k]);
  const vec3 outwards = distance > 0.0 ? vec_scale(1.0 / distance, vec_sub(point, core->centre)) : vec(0, 0, 0);
  *hit = (batch_hit){.upper = greater(upper, 0.0),
                     .part = part,
                     .piece = half / 2,
                     .s = (double)k / CHORDS,
                     .point = point,
                     .distance = distance - core->inner,
                     .surface = vec_axpy(core->centre, core->inner, outwards)};
  return true;
}

/* The half piece that a part may be nearest to, as the curve's chord tells. */
static uint32_t promising_half(const curve_capsule *whole, vec3 per_chord, vec3 centre, uint32_t halves) {
  const double along = vec_dot(vec_sub(centre, whole->a), per_chord) * (double)halves;
  return along > 0.0 ? (uint32_t)lesser(along, (double)(halves - 1)) : 0;
}

/* The halves that are promising first, then the others. */
static bool find_hit(batch_run *run, double limit, batch_hit *hit) {
  const curve_capsule *whole = &run->q.mover.curve->whole;
  const vec3 chord = vec_sub(whole->b, whole->a);
  const double length2 = vec_norm2(chord);
  const vec3 per_chord = vec_scale(length2 > 0.0 ? 1.0 / length2 : 0.0, chord);
  const uint32_t halves = 2 * (uint32_t)run->q.mover.curve->n_pieces;
  for (size_t i = 0; i < run->n_open; i++) {
    const uint32_t k = run->open[i];
    if (run->lower[k] > limit || !has_inner_ball(run, k)) continue;
    if (!run->measured && !measure(run)) return false;
    if (hits(run, k, promising_half(whole, per_chord, run->batch->cores[k].centre, halves), limit, hit)) return true;
  }
  for (size_t i = 0; i < run->n_open && run->measured; i++) {
    const uint32_t k = run->open[i];
    if (run->lower[k] > limit || !has_inner_ball(run, k)) continue;
    const uint32_t first = promising_half(whole, per_chord, run->batch->cores[k].centre, halves);
    for (uint32_t half = 0; half < halves; half++)
      if (half != first && hits(run, k, half, limit, hit)) return true;
  }
  return false;
}

/* ---- chords against all balls --------------------------------------------------------------------------------------------- */

/* Bounds on the distance, and where the search should begin. Raises c->lower; returns the upper bound. */
static double look_at_balls(const batch_run *run, candidate *c, size_t part) {
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

/* What balls leave open the brick may settle. */
static double look_at(batch_run *run, candidate *c, size_t part, double most, batch_look *look) {
  double upper = look_at_balls(run, c, part), by_brick = INFINITY;
  if (run->batch->cores[part].has_brick && !(c->lower > most)) {
    look->is_hit = batch_look_at_brick(run, part, most, c, &by_brick, &look->hit);
    look->hit.part = part;
    look->rung = CPROX_RUNG_HULL;
  }
  return lesser(upper, by_brick);
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
  const double most = question_wants_verdict(q) ? q->limit : INFINITY;
  const bool short_enough = q->mover.curve->n_pieces <= BATCH_MOST_PIECES;
  look->n = 0;
  look->rung = CPROX_RUNG_SPHERE;
  run->measured = run->joined = false;
  run->cut = 0;
  lanes_ball_bounds(&batch->balls, &q->mover.curve->whole, q->mover.radius, run->lower);
  look->beyond = list_open(run, most);
  if (short_enough) look->beyond = bound_by_boxes(run, most, look->beyond);

  look->is_hit = short_enough && find_hit(run, greater(q->limit, 0.0), &look->hit);

  /* what comes within `most` as far as chords can tell */
  double least_upper = INFINITY;
  size_t promising = 0;
  for (size_t i = 0; i < run->n_open && !look->is_hit; i++) {
    const size_t k = run->open[i];
    if (run->lower[k] > least_upper) {
      look->beyond = lesser(look->beyond, run->lower[k]);
      continue;
    }
    candidate *c = &run->near[look->n];
    *c = batch->parts[k];
    c->lower = run->lower[k];
    double upper = INFINITY;
    if (short_enough && batch->targets[c->target].body) {
      if (!run->joined && (run->measured || measure(run))) join_points(run);
      if (run->joined) upper = look_at(run, c, k, lesser(most, least_upper), look);
    }
    if (c->lower > lesser(most, least_upper)) {
      look->beyond = lesser(look->beyond, c->lower);
      continue;
    }
    if (upper < least_upper) least_upper = upper, promising = look->n;
    look->n++;
  }
  if (look->is_hit)
    for (size_t i = 0; i < run->n_open; i++) look->beyond = lesser(look->beyond, run->lower[run->open[i]]);
  else
    put_in_order(run, promising, least_upper, look);
}
