/* SPDX-License-Identifier: BSD-3-Clause */
/* The letters are those of doc/robot-bounds.md, Spans. */
#include "kinematics/spans.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/bernstein.h"
#include "base/rounding.h"
#include "kinematics/motion.h"

/* The finest blocks that are stored are of 4 segments. */
enum { FINEST = 2, FINEST_SIZE = 1 << FINEST, MOST_PIECES = 2 * (SPAN_MOST_LEVELS + FINEST_SIZE) };

/* Spans that stray farther than this part of their chord are only bounded by their ranges. */
static const double BENT = 0.1;

/* ---- blocks ---- */

typedef enum block_row { BLOCK_LOW, BLOCK_HIGH, BLOCK_BELOW, BLOCK_ABOVE, BLOCK_ROWS } block_row;

static size_t blocks_of_level(const motion_track *t, size_t level) {
  return (t->n_segments + ((size_t)1 << level) - 1) >> level;
}

/* That of segments k 2^level … (k + 1) 2^level - 1. */
static double *block_at(const motion_track *t, size_t level, size_t k) {
  return t->spans.blocks + (t->spans.first[level] + k) * BLOCK_ROWS * t->n_moving;
}

/* The values at the beginning of a segment whose number is a multiple of 4, or at the end of the last one. */
static const double *knot_at(const motion_track *t, size_t segment) {
  const size_t k = segment < t->n_segments ? segment / FINEST_SIZE : blocks_of_level(t, FINEST);
  return t->spans.knots + k * t->n_moving;
}

static const double *coefficients_of(const motion_track *t, size_t segment) {
  return t->coefficients + segment * t->n_moving * t->stride;
}

/* ---- along a chord ---- */

/* From when to when a span goes, after the knot `base`. */
typedef struct duration {
  double base, begin, length;
} duration;

/* A chord, and what the pieces so far say of the way beside it. */
typedef struct walk {
  size_t n;
  const double *from, *to;
  double inverse;          /* 1 over the chord's length squared, 0 for one that is too short */
  const duration *by_time; /* places are told by the time that has passed; NULL: by how far the motion has come */
  double *low, *high, *below, *above;
} walk;

static walk walk_along(size_t n, const double *from, const double *to, const duration *by_time, double *low,
                       double *high, double *below, double *above) {
  double length2 = 0.0;
  for (size_t j = 0; j < n; j++) {
    length2 += (to[j] - from[j]) * (to[j] - from[j]);
    low[j] = below[j] = INFINITY, high[j] = above[j] = -INFINITY;
  }
  const double inverse = length2 > 1e-280 ? 1.0 / length2 : 0.0;
  return (walk){.n = n,
                .from = from,
                .to = to,
                .inverse = inverse,
                .by_time = by_time,
                .low = low,
                .high = high,
                .below = below,
                .above = above};
}

/* Where on the chord a point is seen to be, in units of its length; points of all variables, `stride` apart. */
static double along_of(const walk *w, const double *point, size_t stride) {
  double along = 0.0;
  for (size_t j = 0; j < w->n; j++) along += (point[j * stride] - w->from[j]) * (w->to[j] - w->from[j]);
  return along * w->inverse;
}

static double clamped(double along) {
  return lesser(greater(along, 0.0), 1.0);
}

/* Where on the chord the motion is taken to be at a time, or at a point that it reaches then. */
static double place_of(const walk *w, double t, const double *point, size_t stride) {
  const duration *d = w->by_time;
  return clamped(d ? (t - d->base - d->begin) / d->length : along_of(w, point, stride));
}

static double beside(const walk *w, double along, double value, size_t j) {
  return value - ((1.0 - along) * w->from[j] + along * w->to[j]);
}

/* A piece by its own ends, their places, and what it says of the way beside its own chord: that chord strays as far as
 * its ends. */
static void take_block(walk *w, const double *begin, const double *end, const double *block, const double along[2]) {
  const size_t n = w->n;
  for (size_t j = 0; j < n; j++) {
    const double e0 = beside(w, along[0], begin[j], j), e1 = beside(w, along[1], end[j], j);
    w->low[j] = lesser(block[BLOCK_LOW * n + j], w->low[j]);
    w->high[j] = greater(block[BLOCK_HIGH * n + j], w->high[j]);
    w->below[j] = lesser(lesser(e0, e1) + block[BLOCK_BELOW * n + j], w->below[j]);
    w->above[j] = greater(greater(e0, e1) + block[BLOCK_ABOVE * n + j], w->above[j]);
  }
}

/* A polynomial by its coefficients: those of its place along the chord are in [0, 1], so that its place is. By time it
 * is a straight line between the places of both ends, which are given. */
static void take_polynomial(walk *w, const double *c, size_t stride, size_t degree, double along[2]) {
  double places[MOTION_MAX_DEGREE + 1];
  for (size_t i = 0; i <= degree; i++) {
    const double share = (double)i / (double)degree;
    places[i] = w->by_time ? (1.0 - share) * along[0] + share * along[1] : clamped(along_of(w, c + i, stride));
  }
  along[0] = places[0], along[1] = places[degree];
  for (size_t j = 0; j < w->n; j++, c += stride) {
    double low = w->low[j], high = w->high[j], below = w->below[j], above = w->above[j];
    for (size_t i = 0; i <= degree; i++) {
      const double e = beside(w, places[i], c[i], j);
      low = lesser(c[i], low), high = greater(c[i], high);
      below = lesser(e, below), above = greater(e, above);
    }
    w->low[j] = low, w->high[j] = high, w->below[j] = below, w->above[j] = above;
  }
}

/* What rounding adds: four roundings of the sizes that enter; by time as much again for the places. */
static void round_outward(const walk *w) {
  const double roundings = w->by_time ? 32.0 : 16.0;
  for (size_t j = 0; j < w->n; j++) {
    const double off = roundings * ROUND_U * greater(fabs(w->low[j]), fabs(w->high[j]));
    w->below[j] -= off, w->above[j] += off;
  }
}

/* ---- the tree ---- */

static void make_block(const motion_track *t, size_t level, size_t k) {
  const size_t n = t->n_moving, size = (size_t)1 << level, first = k * size;
  const size_t last = first + size < t->n_segments ? first + size : t->n_segments;
  const duration whole = {.base = t->times[first], .length = t->times[last] - t->times[first]};
  double *block = block_at(t, level, k);
  walk w = walk_along(n, knot_at(t, first), knot_at(t, last), t->by_time ? &whole : NULL, block, block + BLOCK_HIGH * n,
                      block + BLOCK_BELOW * n, block + BLOCK_ABOVE * n);
  for (size_t i = first; i < last && level == FINEST; i++) {
    double along[2] = {0.0, 1.0};
    for (size_t end = 0; end < 2 && t->by_time; end++) along[end] = place_of(&w, t->times[i + end], NULL, 0);
    take_polynomial(&w, coefficients_of(t, i), t->stride, t->degree[i], along);
  }
  for (size_t i = first; i < last && level > FINEST; i += size / 2) {
    const size_t end = i + size / 2 < last ? i + size / 2 : last;
    const double *from = knot_at(t, i), *to = knot_at(t, end);
    const double along[2] = {place_of(&w, t->times[i], from, 1), place_of(&w, t->times[end], to, 1)};
    take_block(&w, from, to, block_at(t, level - 1, i >> (level - 1)), along);
  }
  round_outward(&w);
}

bool motion_spans_make(motion_track *t) {
  motion_spans *s = &t->spans;
  const size_t n = t->n_moving;
  *s = (motion_spans){0};
  if (t->n_segments < 2 || n == 0) return true;
  size_t top = FINEST, blocks = 0;
  while (((size_t)1 << top) < t->n_segments) top++;
  for (size_t level = FINEST; level <= top; level++) {
    s->first[level] = blocks;
    blocks += blocks_of_level(t, level);
  }
  const size_t knots = blocks_of_level(t, FINEST);
  s->blocks = malloc(blocks * BLOCK_ROWS * n * sizeof *s->blocks);
  s->knots = malloc((knots + 1) * n * sizeof *s->knots);
  s->error = calloc(n, sizeof *s->error);
  if (!s->blocks || !s->knots || !s->error) {
    motion_spans_free(s);
    return false;
  }
  s->levels = top + 1;
  for (size_t k = 0; k <= knots; k++) {
    const size_t segment = k < knots ? k * FINEST_SIZE : t->n_segments - 1, i = k < knots ? 0 : t->degree[segment];
    for (size_t j = 0; j < n; j++) s->knots[k * n + j] = coefficients_of(t, segment)[j * t->stride + i];
  }
  for (size_t i = 0; i < t->n_segments; i++)
    for (size_t j = 0; j < n; j++) s->error[j] = greater(t->error[i * n + j], s->error[j]);
  for (size_t level = FINEST; level <= top; level++)
    for (size_t k = 0; k < blocks_of_level(t, level); k++) make_block(t, level, k);
  return true;
}

void motion_spans_free(motion_spans *s) {
  free(s->blocks);
  free(s->knots);
  free(s->error);
  *s = (motion_spans){0};
}

/* ---- a span ---- */

/* A block of the tree (level >= 2), or a segment or a part of one. */
typedef struct piece {
  size_t level, segment;
  double a, b;
  double along[2]; /* where on the chord its ends are seen */
} piece;

/* A part of a segment, [variable][stride]. */
static void cut_segment(const motion_track *t, size_t segment, double a, double b, double *out) {
  const size_t degree = t->degree[segment];
  for (size_t j = 0; j < t->n_moving; j++) {
    double *c = out + j * t->stride;
    memcpy(c, coefficients_of(t, segment) + j * t->stride, (degree + 1) * sizeof *c);
    if (a > 0.0) bernstein_cut_front(c, degree, a);
    if (b < 1.0) bernstein_cut_back(c, degree, (b - a) / (1.0 - a));
  }
}

/* The values of all variables at u of a segment; each is off by less than 4 u of a degree. */
static void values_at(const motion_track *t, size_t segment, double u, double *values) {
  const double *c = coefficients_of(t, segment);
  for (size_t j = 0; j < t->n_moving; j++, c += t->stride) values[j] = bernstein_at(c, t->degree[segment], u);
}

/* The largest block that begins at the segment and ends by `last`; 0: only the segment itself. */
static size_t level_of_block(const motion_track *t, size_t segment, size_t last) {
  size_t level = 0;
  for (size_t l = FINEST; l < t->spans.levels; l++) {
    const size_t size = (size_t)1 << l;
    if (segment % size != 0 || (segment + size > last && last < t->n_segments)) break;
    level = l;
    if (segment + size >= last) break;
  }
  return level;
}

static size_t take_pieces(const motion_track *t, walk *w, const motion_interval *own, double *cut, piece *pieces) {
  size_t count = 0, i = own->first;
  while (i < own->last) {
    const bool begins = i == own->first && own->a > 0.0, ends = i + 1 == own->last && own->b < 1.0;
    piece *p = &pieces[count++];
    *p = (piece){.segment = i, .a = begins ? own->a : 0.0, .b = ends ? own->b : 1.0};
    p->level = begins || ends ? 0 : level_of_block(t, i, own->b < 1.0 ? own->last - 1 : own->last);
    const size_t size = (size_t)1 << p->level, end = i + size < t->n_segments ? i + size : t->n_segments;
    if (w->by_time) {
      p->along[0] = begins ? 0.0 : place_of(w, t->times[i], NULL, 0);
      p->along[1] = ends ? 1.0 : place_of(w, t->times[end], NULL, 0);
    }
    if (p->level > 0) {
      const double *from = knot_at(t, i), *to = knot_at(t, end);
      p->along[0] = place_of(w, t->times[i], from, 1), p->along[1] = place_of(w, t->times[end], to, 1);
      take_block(w, from, to, block_at(t, p->level, i >> p->level), p->along);
    } else {
      if (begins || ends) cut_segment(t, i, p->a, p->b, cut);
      take_polynomial(w, begins || ends ? cut : coefficients_of(t, i), t->stride, t->degree[i], p->along);
    }
    i = end;
  }
  return count;
}

/* Where in [a, b] of a segment the middle of the chord is seen. */
static double middle_within(const motion_track *t, const walk *w, size_t segment, double a, double b) {
  enum { HALVINGS = 24 };
  const size_t degree = t->degree[segment];
  double along[MOTION_MAX_DEGREE + 1];
  for (size_t i = 0; i <= degree; i++) along[i] = along_of(w, coefficients_of(t, segment) + i, t->stride);
  if (degree == 1) return lesser(greater((0.5 - along[0]) / (along[1] - along[0]), a), b);
  for (int i = 0; i < HALVINGS; i++) {
    const double middle = 0.5 * (a + b);
    if (bernstein_at(along, degree, middle) < 0.5)
      a = middle;
    else
      b = middle;
  }
  return 0.5 * (a + b);
}

/* The place where the motion passes the middle of the chord; any place of the span will do. */
static void find_middle(const motion_track *t, const walk *w, const piece *pieces, size_t count, span_centre *centre) {
  size_t k = 0;
  while (k + 1 < count && pieces[k].along[1] < 0.5) k++;
  const piece *p = &pieces[k];
  size_t segment = p->segment;
  for (size_t level = p->level; level > FINEST; level--) {
    const size_t half = segment + ((size_t)1 << (level - 1));
    if (half < t->n_segments && along_of(w, knot_at(t, half), 1) < 0.5) segment = half;
  }
  const size_t end = segment + (p->level > 0 ? FINEST_SIZE : 1);
  while (segment + 1 < end && segment + 1 < t->n_segments &&
         along_of(w, coefficients_of(t, segment + 1), t->stride) < 0.5)
    segment++;
  centre->segment = segment, centre->u = middle_within(t, w, segment, p->a, p->b);
}

static void look_at(const walk *w, span_centre *centre) {
  for (size_t j = 0; j < w->n; j++) {
    centre->stray = greater(w->above[j] - w->below[j], centre->stray);
    centre->chord = greater(fabs(w->to[j] - w->from[j]), centre->chord);
  }
  centre->bent = centre->stray > BENT * centre->chord;
}

/* Where joints are that turn by arcs, in the rows of the variables that move. */
static void place_arcs(const cprox_motion *m, const motion_track *t, size_t segment, double u, double *value) {
  for (size_t k = 0; k < t->n_arcs; k++) {
    const size_t i = (size_t)t->arc_axes[k];
    if (!m->axis_moves[i]) continue;
    const int32_t *slot = m->slot + m->robot->axes[i].variable;
    double values[7];
    motion_arc_values(m, i, segment, u, values);
    for (int j = motion_arc_at(m, i, 0)->screw ? 0 : 3; j < 7; j++) value[slot[j - 3]] = values[j];
  }
}

/* By how much places by time may be off: the begin and the end are rounded, and the differences of times. */
static double place_error(const cprox_motion *m, const motion_interval *over, const duration *whole) {
  const double h =
      (m->times[over->first + 1] - m->times[over->first]) + (m->times[over->last] - m->times[over->last - 1]);
  return 8.0 * ROUND_U * (1.0 + h / whole->length);
}

static duration duration_of(const cprox_motion *m, const motion_interval *over) {
  const double *times = m->times, base = times[over->first], last = times[over->last - 1];
  const double begin = over->a * (times[over->first + 1] - base),
               end = (last - base) + over->b * (times[over->last] - last);
  return (duration){.base = base, .begin = begin, .length = end - begin};
}

void motion_fill_span(const cprox_motion *m, const motion_track *t, const motion_interval *over,
                      const motion_interval *own, span_centre *centre, double *rows) {
  const size_t n = t->n_moving, stride = motion_rows_stride(m);
  const duration whole = duration_of(m, over);
  rows += t->first_slot;
  double *from = rows + MOTION_FROM * stride, *to = rows + MOTION_TO * stride;
  values_at(t, own->first, own->a, from);
  values_at(t, own->last - 1, own->b, to);
  piece pieces[MOST_PIECES];
  walk w = walk_along(n, from, to, t->by_time ? &whole : NULL, rows + MOTION_LOW * stride, rows + MOTION_HIGH * stride,
                      rows + MOTION_BELOW * stride, rows + MOTION_ABOVE * stride);
  const size_t count = n > 0 ? take_pieces(t, &w, own, rows + MOTION_CUT * stride, pieces) : 0;
  round_outward(&w);
  look_at(&w, centre);

  double off_place = 0.0;
  size_t segment;
  if (t->by_time) {
    off_place = place_error(m, over, &whole);
  } else {
    centre->segment = own->first + (own->last - own->first) / 2, centre->u = 0.0;
    if (!centre->bent && w.inverse > 0.0 && count > 0) find_middle(t, &w, pieces, count, centre);
  }
  double u = centre->u;
  segment = motion_track_place(m, t, centre->segment, &u);

  double *value = rows + MOTION_VALUE * stride;
  values_at(t, segment, u, value);
  place_arcs(m, t, segment, u, value - t->first_slot);
  const double along = t->by_time ? 0.5 : clamped(along_of(&w, value, 1)),
               reach = ROUND_UP * greater(along, 1.0 - along);
  for (size_t j = 0; j < n; j++) {
    const double slope = 2.0 * reach * (to[j] - from[j]), off = beside(&w, along, value[j], j);
    const double size = greater(fabs(w.low[j]), fabs(w.high[j]));
    const double error =
        2.0 * t->spans.error[j] + 32.0 * ROUND_U * (1.0 + reach) * size + 2.0 * off_place * fabs(slope);
    const double stray = greater(w.above[j] - off, off - w.below[j]) + error;
    const double by_range = greater(w.high[j] - value[j], value[j] - w.low[j]) + error;
    const double line = 0.5 * fabs(slope);
    rows[MOTION_FIRST * stride + j] = slope;
    rows[MOTION_W * stride + j] = fabs(slope);
    rows[MOTION_SECOND * stride + j] = rows[MOTION_A * stride + j] = rows[MOTION_G * stride + j] = 0.0;
    rows[MOTION_SHIFT * stride + j] = lesser(by_range, line + stray);
    rows[MOTION_VARIATION * stride + j] = INFINITY;
    rows[MOTION_LINE * stride + j] = line;
    rows[MOTION_STRAY * stride + j] = stray;
  }
}
