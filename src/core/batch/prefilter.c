/* SPDX-License-Identifier: BSD-3-Clause */
#include "batch/prefilter.h"

#include <math.h>

#include "base/rounding.h"

static double margin_of(const batch_run *run, size_t part) {
  return run->batch->cores[part].margin + run->q.mover.radius;
}

/* Placing the centre of a compound's part costs (26 + 16) u of its lengths, all of which are in the part's sizes, the
 * rest 18 u. */
static double slack_at(const batch_run *run, size_t part, double distance, double margin) {
  return ROUND_UP * (run->slack + ROUND_BALLS * ROUND_U * (distance + margin + run->batch->balls.sizes[part]));
}

/* ---- points against inner balls ---- */

/* All points of the inner ball are of the part; of a disc it counts only from its own plane. */
static bool has_inner_ball(const batch_run *run, size_t part) {
  const batch_core *core = &run->batch->cores[part];
  const cprox_curve *curve = run->q.mover.curve;
  return core->inner >= 0.0 && (!core->flat || (curve->flat && curve->points[0].z == core->plane));
}

/* A obb that is seen from chords is met there. */
static bool may_hit(const batch_run *run, size_t part, double limit) {
  return !(run->lower[part] > limit) && has_inner_ball(run, part) && !(run->joined && run->batch->cores[part].is_obb);
}

/* A point of half a piece that is within the limit of the part's inner ball. */
static bool hits(batch_run *run, size_t part, uint32_t half, double limit, batch_hit *hit) {
  const batch_core *core = &run->batch->cores[part];
  const double margin = margin_of(run, part), reach = core->inner + margin + limit;
  uint32_t k;
  const double square = batch_points_nearest(run, half, core->centre, &k);
  if (square > reach * reach) return false;
  const double distance = sqrt(square);
  const double upper = distance - core->inner - margin + slack_at(run, part, distance, margin);
  if (upper > limit) return false;
  const packet_chords *chords = &run->chords[half / 2];
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
  const curve_capsule whole = curve_whole(run->q.mover.curve);
  const vec3 chord = vec_sub(whole.b, whole.a);
  const double length2 = vec_norm2(chord);
  const vec3 per_chord = vec_scale(length2 > 0.0 ? 1.0 / length2 : 0.0, chord);
  const uint32_t halves = 2 * (uint32_t)run->q.mover.curve->n_pieces;
  for (size_t i = 0; i < run->n_open; i++) {
    const uint32_t k = run->open[i];
    if (!may_hit(run, k, limit)) continue;
    if (!run->measured && !batch_points_ready(run)) return false;
    if (hits(run, k, promising_half(&whole, per_chord, run->batch->cores[k].centre, halves), limit, hit)) return true;
  }
  for (size_t i = 0; i < run->n_open && run->measured; i++) {
    const uint32_t k = run->open[i];
    if (!may_hit(run, k, limit)) continue;
    const uint32_t first = promising_half(&whole, per_chord, run->batch->cores[k].centre, halves);
    for (uint32_t half = 0; half < halves; half++)
      if (half != first && hits(run, k, half, limit, hit)) return true;
  }
  return false;
}

/* ---- chords against all balls ---- */

/* Bounds on the distance, and where the search should begin. Raises c->lower; returns the upper bound. */
static double bound_by_balls(const batch_run *run, candidate *c, size_t part) {
  const batch_core *core = &run->batch->cores[part];
  double least = INFINITY, along = 0.0;
  size_t chord = 0, piece = 0;
  for (size_t i = 0; i < run->q.mover.curve->n_pieces; i++) {
    size_t k;
    double s;
    const double square = packet_closest(&run->chords[i], core->centre, &k, &s);
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

/* What balls leave open the obb may settle. */
static double measure_pair_at(batch_run *run, candidate *c, size_t part, double most, batch_prefilter_answer *look) {
  double upper = bound_by_balls(run, c, part), by_obb = INFINITY;
  if (run->batch->cores[part].has_obb && !(c->lower > most)) {
    look->is_hit = batch_bound_by_obb(run, part, most, c, &by_obb, &look->hit);
    look->hit.part = part;
    look->lod = CPROX_LOD_HULL;
  }
  return lesser(upper, by_obb);
}

/* The promising candidate first, the others nearest first. Those that a later one has ruled out leave: farther than the
 * first one is, they do not lower the union's bound. */
static void put_in_order(batch_run *run, size_t promising, double upper, batch_prefilter_answer *look) {
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

/* One part more that may matter: among the candidates where it comes within `most` as far as chords can tell. Lowers
 * *least_upper. */
static void consider(batch_run *run, size_t k, double most, double *least_upper, size_t *promising,
                     batch_prefilter_answer *look) {
  candidate *c = &run->near[look->n];
  *c = run->batch->parts[k];
  c->lower = run->lower[k];
  const double beyond = lesser(most, *least_upper);
  double upper = INFINITY;
  if (!(c->lower > beyond) && run->short_enough && run->batch->obstacles[c->obstacle].body) {
    if (!run->joined && (run->measured || batch_points_ready(run))) batch_points_join(run);
    if (run->joined) upper = measure_pair_at(run, c, k, beyond, look);
  }
  if (c->lower > beyond) {
    look->beyond = lesser(look->beyond, c->lower);
    return;
  }
  if (upper < *least_upper) *least_upper = upper, *promising = look->n;
  look->n++;
}

void batch_prefilter(batch_run *run, batch_prefilter_answer *look) {
  const query *q = &run->q;
  const bool decides = query_wants_verdict(q);
  const double most = decides ? q->limit : INFINITY;
  double least_upper = INFINITY;
  size_t promising = 0;
  look->n = 0;
  look->lod = CPROX_LOD_SPHERE;
  run->short_enough = q->mover.curve->n_pieces <= BATCH_MOST_PIECES;
  run->measured = run->joined = false;
  run->cut = 0;
  batch_cull_begin(run);

  /* a distance begins with the part that may be nearest: what is farther than that one's upper bound need not be listed
   */
  const size_t first = decides ? SIZE_MAX : batch_cull_nearest(run);
  look->beyond = INFINITY;
  look->is_hit = false;
  run->n_open = 0;
  if (first != SIZE_MAX) consider(run, first, most, &least_upper, &promising, look);
  if (!look->is_hit) {
    look->beyond = lesser(look->beyond, batch_cull_list(run, lesser(most, least_upper)));
    look->is_hit = run->short_enough && find_hit(run, greater(q->limit, 0.0), &look->hit);
  }
  for (size_t i = 0; i < run->n_open && !look->is_hit; i++)
    if (run->open[i] != first) consider(run, run->open[i], most, &least_upper, &promising, look);
  if (look->is_hit)
    for (size_t i = 0; i < run->n_open; i++) look->beyond = lesser(look->beyond, run->lower[run->open[i]]);
  else
    put_in_order(run, promising, least_upper, look);
}
