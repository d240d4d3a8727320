/* SPDX-License-Identifier: BSD-3-Clause */
#include "batch/prefilter.h"

#include <math.h>

#include "base/rotation.h"
#include "base/rounding.h"

/* One look at a obb: what a bound of chords is worth for the mover. */
typedef struct look {
  batch_run *run;
  const batch_core *core;
  double margin; /* margin and the mover's radius */
  double slack;  /* rounding */
  double limit;  /* points that are no farther are hits; < 0: none are looked for */
} look;

/* 28 (|p| + |c|) u to bring a point into the frame, p its place from the frame's, c its centre; 56 |p| u for the
 * chord's direction, and 10 u of all sizes for the bound and the margin. */
static double slack_of(const batch_run *run, const batch_core *core, double margin) {
  const double sizes = run->q.mover.curve->largest + core->obb_sizes + margin;
  return ROUND_UP * (run->slack + (128.0 + core->obb_turned) * ROUND_U * sizes + core->obb_misplaced);
}

/* ---- points ---- */

/* The part is a obb: how far a point is from it, and which point of it is nearest. */
static double from_obb(const packet_obb *b, vec3 x, vec3 *surface) {
  const vec3 y = vec_sub(rotate_back(b->r, vec_sub(x, b->position)), b->centre);
  const vec3 h = b->half;
  const vec3 on =
      vec(lesser(greater(y.x, -h.x), h.x), lesser(greater(y.y, -h.y), h.y), lesser(greater(y.z, -h.z), h.z));
  const vec3 local = vec_add(on, b->centre);
  *surface = vec_add(rotate(b->r, local), b->position);
  return vec_norm(vec_sub(y, on));
}

/* The point of the curve at s of a piece is within the limit. */
static bool hits_at(const look *l, uint32_t piece, double s, batch_hit *hit) {
  const cprox_curve *curve = l->run->q.mover.curve;
  const vec3 *points = curve_piece(curve, piece);
  vec3 at;
  curve_bezier_evaluate(&points->x, &points->y, &points->z, 3, curve->degree, curve_binomial(curve), s, &at, NULL,
                        NULL);
  vec3 surface;
  const double distance = from_obb(&l->core->obb, at, &surface);
  const double upper = distance - l->margin + l->slack;
  if (upper > l->limit) return false;
  hit->upper = greater(upper, 0.0);
  hit->distance = distance;
  hit->piece = piece, hit->s = s;
  hit->point = at, hit->surface = surface;
  return true;
}

/* ---- chords ---- */

/* Chord k of a piece, cut into CHORDS itself. */
static bool cut_chord(batch_run *run, uint32_t piece, uint32_t k, packet_chords *fine) {
  const cprox_curve *curve = run->q.mover.curve;
  const vec3 *points = curve_piece(curve, piece);
  const packet_chords *chords = &run->chords[piece];
  const double *basis = packet_fine_basis(curve->degree, k, run->q.workspace);
  if (!basis) return false;
  uint32_t unused;
  for (uint32_t first = 0; first < CHORDS; first += LANES)
    packet_points(basis, points, curve->degree, curve->flat, first, vec(0, 0, 0), fine, &unused);
  fine->x[CHORDS] = chords->x[k + 1], fine->y[CHORDS] = chords->y[k + 1], fine->z[CHORDS] = chords->z[k + 1];
  packet_join(fine);
  return true;
}

/* A chord that may come too near is cut again: raises *lower, its bound. True for a hit. */
static bool subdivide_chord(look *l, uint32_t piece, uint32_t k, double *lower, batch_hit *hit) {
  packet_chords fine;
  if (!cut_chord(l->run, piece, k, &fine)) return false;
  packet_sample sample;
  packet_see_obb(&fine, &l->core->obb, &sample);
  const double beside = l->run->beside * (1.0 / (CHORDS * CHORDS));
  uint32_t nearest, unused;
  *lower = greater(*lower, packet_least(sample.lower, &unused) - beside - l->margin - l->slack);
  if (!(l->limit >= 0.0)) return false;
  const double square = packet_least(sample.square, &nearest);
  const double s = ((double)k + ((double)nearest + sample.s[nearest]) / CHORDS) / CHORDS;
  return sqrt(square) - beside - l->margin <= l->limit && hits_at(l, piece, s, hit);
}

bool batch_bound_by_obb(batch_run *run, size_t part, double most, candidate *c, double *upper, batch_hit *hit) {
  enum { MOST_CUT = 6 }; /* a search is faster than more of these */
  const batch_core *core = &run->batch->cores[part];
  const uint32_t pieces = (uint32_t)run->q.mover.curve->n_pieces;
  look l = {.run = run, .core = core, .margin = core->margin + run->q.mover.radius, .limit = -INFINITY};
  l.slack = slack_of(run, core, l.margin);
  if (core->is_obb) l.limit = greater(run->q.limit, 0.0);

  /* all chords */
  packet_sample sample[BATCH_MOST_PIECES];
  double lower = INFINITY, square = INFINITY, s = 0.0;
  uint32_t piece = 0;
  for (uint32_t i = 0; i < pieces; i++) {
    packet_see_obb(&run->chords[i], &core->obb, &sample[i]);
    uint32_t k, unused;
    const double least = packet_least(sample[i].square, &k);
    if (least < square) square = least, piece = i, s = ((double)k + sample[i].s[k]) / CHORDS;
    lower = lesser(lower, packet_least(sample[i].lower, &unused));
  }
  const double off = run->beside + l.margin + l.slack, distance = sqrt(square);
  c->lower = greater(c->lower, lower - off);
  c->seed_piece = piece;
  c->seed_s = lesser(greater(s, 1e-3), 1.0 - 1e-3);
  *upper = core->is_obb ? distance + run->beside - l.margin + l.slack : INFINITY;
  const double settles = query_wants_verdict(&run->q) ? most : 0.0; /* of distances only contact is */
  if (c->lower > lesser(most, settles)) return false;

  /* the nearest chord's point, then each chord that is not too far */
  if (distance - run->beside - l.margin <= l.limit && hits_at(&l, piece, s, hit)) return true;
  int cut = 0;
  lower = INFINITY;
  for (uint32_t i = 0; i < pieces; i++) {
    for (uint32_t k = 0; k < CHORDS; k++) {
      double bound = sample[i].lower[k] - off;
      if (bound <= settles && cut++ < MOST_CUT && subdivide_chord(&l, i, k, &bound, hit)) return true;
      lower = lesser(lower, bound);
    }
  }
  c->lower = greater(c->lower, lower);
  return false;
}
