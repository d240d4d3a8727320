/* SPDX-License-Identifier: BSD-3-Clause */
/* The letters are those of doc/robot-clocks.md, Spans. */
#include "kinematics/spans.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/bernstein.h"
#include "base/rounding.h"
#include "kinematics/lanes.h"
#include "simd/dispatch.h"

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

/* A chord, and what the pieces so far say of the way beside it: rows of whole lanes. */
typedef struct walk {
  size_t n;
  const double *from, *to;
  double inverse;          /* 1 over the chord's length squared, 0 for one that is too short */
  const duration *by_time; /* places are told by the time that has passed; NULL: by how far the motion has come */
  double *low, *high, *below, *above;
} walk;

/* The rows are `stride` apart, as those of a motion are: from MOTION_FROM, which is given with MOTION_TO, to
 * MOTION_ABOVE. */
static walk walk_along(size_t n, const duration *by_time, double *rows, size_t stride) {
  walk w = {.n = n,
            .from = rows,
            .to = rows + (MOTION_TO - MOTION_FROM) * stride,
            .by_time = by_time,
            .low = rows + (MOTION_LOW - MOTION_FROM) * stride,
            .high = rows + (MOTION_HIGH - MOTION_FROM) * stride,
            .below = rows + (MOTION_BELOW - MOTION_FROM) * stride,
            .above = rows + (MOTION_ABOVE - MOTION_FROM) * stride};
  double length2 = 0.0;
  for (size_t j = 0; j < n; j++) length2 += (w.to[j] - w.from[j]) * (w.to[j] - w.from[j]);
  w.inverse = length2 > 1e-280 ? 1.0 / length2 : 0.0;
  for (size_t j = 0; j < lanes_padded(n); j++) {
    w.low[j] = w.below[j] = INFINITY;
    w.high[j] = w.above[j] = -INFINITY;
  }
  return w;
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

/* A piece by its own ends, their places, and what it says of the way beside its own chord: that chord strays as far as
 * its ends. */
static inline void take_block(const walk *w, const double *begin, const double *end, const double *block,
                              const double along[2]) {
  const size_t n = w->n;
  const double *from = w->from, *to = w->to, a = along[0], b = along[1];
  double *low = w->low, *high = w->high, *below = w->below, *above = w->above;
#pragma omp simd
  for (size_t j = 0; j < n; j++) {
    const double e0 = begin[j] - ((1.0 - a) * from[j] + a * to[j]), e1 = end[j] - ((1.0 - b) * from[j] + b * to[j]);
    low[j] = lesser(block[BLOCK_LOW * n + j], low[j]), high[j] = greater(block[BLOCK_HIGH * n + j], high[j]);
    below[j] = lesser(lesser(e0, e1) + block[BLOCK_BELOW * n + j], below[j]);
    above[j] = greater(greater(e0, e1) + block[BLOCK_ABOVE * n + j], above[j]);
  }
}

static double along_of_lanes(const walk *w, const lane_row *c, size_t i) {
  double along = 0.0;
  for (size_t j = 0; j < w->n; j++) {
    const double value = c[j / MOTION_LANES * LANE_ROWS + i][j % MOTION_LANES];
    along += (value - w->from[j]) * (w->to[j] - w->from[j]);
  }
  return along * w->inverse;
}

/* A polynomial by its coefficients: those of its place along the chord are in [0, 1], so that its place is. By time it
 * is a straight line between the places of both ends, which are given. */
static inline void take_polynomial(walk *w, const lane_row *c, size_t degree, double along[2]) {
  double places[LANE_ROWS];
  for (size_t i = 0; i <= degree; i++) {
    const double share = (double)i / (double)degree;
    places[i] = w->by_time ? (1.0 - share) * along[0] + share * along[1] : clamped(along_of_lanes(w, c, i));
  }
  along[0] = places[0], along[1] = places[degree];
  for (size_t first = 0; first < w->n; first += MOTION_LANES, c += LANE_ROWS) {
    const double *from = w->from + first, *to = w->to + first;
    double *low = w->low + first, *high = w->high + first, *below = w->below + first, *above = w->above + first;
    for (size_t i = 0; i <= degree; i++) {
      const double place = places[i];
#pragma omp simd
      for (int l = 0; l < MOTION_LANES; l++) {
        const double e = c[i][l] - ((1.0 - place) * from[l] + place * to[l]);
        low[l] = lesser(c[i][l], low[l]), high[l] = greater(c[i][l], high[l]);
        below[l] = lesser(e, below[l]), above[l] = greater(e, above[l]);
      }
    }
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

static inline void load_segment(const motion_track *t, size_t segment, lane_row *c) {
  for (size_t first = 0; first < t->n_moving; first += MOTION_LANES, c += LANE_ROWS)
    lanes_load(t, segment, first, c, NULL);
}

/* ---- the tree ---- */

/* `rows`: room for BLOCK_SCRATCH rows of whole lanes. */
enum { BLOCK_SCRATCH = MOTION_CUT - MOTION_FROM + LANE_ROWS };

static void make_block(const motion_track *t, size_t level, size_t k, double *rows) {
  const size_t n = t->n_moving, stride = lanes_padded(n), size = (size_t)1 << level, first = k * size;
  const size_t last = first + size < t->n_segments ? first + size : t->n_segments;
  const duration whole = {.base = t->times[first], .length = t->times[last] - t->times[first]};
  memcpy(rows, knot_at(t, first), n * sizeof *rows);
  memcpy(rows + stride, knot_at(t, last), n * sizeof *rows);
  walk w = walk_along(n, t->by_time ? &whole : NULL, rows, stride);
  for (size_t i = first; i < last && level == FINEST; i++) {
    double along[2] = {0.0, 1.0};
    for (size_t end = 0; end < 2 && t->by_time; end++) along[end] = place_of(&w, t->times[i + end], NULL, 0);
    lane_row *segment = (lane_row *)(rows + (MOTION_CUT - MOTION_FROM) * stride);
    load_segment(t, i, segment);
    take_polynomial(&w, (const lane_row *)segment, t->degree[i], along);
  }
  for (size_t i = first; i < last && level > FINEST; i += size / 2) {
    const size_t end = i + size / 2 < last ? i + size / 2 : last;
    const double *from = knot_at(t, i), *to = knot_at(t, end);
    const double along[2] = {place_of(&w, t->times[i], from, 1), place_of(&w, t->times[end], to, 1)};
    take_block(&w, from, to, block_at(t, level - 1, i >> (level - 1)), along);
  }
  round_outward(&w);
  for (size_t row = 0; row < BLOCK_ROWS; row++)
    memcpy(block_at(t, level, k) + row * n, w.low + row * stride, n * sizeof *rows);
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
  s->error = calloc(lanes_padded(n), sizeof *s->error);
  double *rows = calloc(BLOCK_SCRATCH * lanes_padded(n), sizeof *rows);
  if (!s->blocks || !s->knots || !s->error || !rows) {
    free(rows);
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
    for (size_t k = 0; k < blocks_of_level(t, level); k++) make_block(t, level, k, rows);
  free(rows);
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

/* A part of a segment. */
static inline void cut_segment(const motion_track *t, size_t segment, double a, double b, lane_row *c) {
  load_segment(t, segment, c);
  for (size_t first = 0; first < t->n_moving; first += MOTION_LANES, c += LANE_ROWS)
    lanes_cut(t->degree[segment], a, b, c);
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

void motion_track_range(const motion_track *t, size_t column, size_t first, size_t last, double *low, double *high) {
  double least = INFINITY, most = -INFINITY;
  for (size_t i = first; i < last;) {
    const size_t level = level_of_block(t, i, last);
    if (level > 0) {
      const double *block = block_at(t, level, i >> level) + column;
      least = lesser(block[BLOCK_LOW * t->n_moving], least), most = greater(block[BLOCK_HIGH * t->n_moving], most);
    }
    const double *c = coefficients_of(t, i) + column * t->stride;
    for (size_t k = 0; k <= t->degree[i] && level == 0; k++) least = lesser(c[k], least), most = greater(c[k], most);
    i += (size_t)1 << level;
  }
  *low = least, *high = most;
}

/* `ends`: the first segment's part and the last one's, where they are cut; room for the others. */
static inline size_t take_pieces(const motion_track *t, walk *w, const motion_interval *own, lane_row *ends[2],
                                 piece *pieces) {
  size_t count = 0, i = own->first;
  while (i < own->last) {
    const bool begins = i == own->first && own->a > 0.0, ends_here = i + 1 == own->last && own->b < 1.0;
    piece *p = &pieces[count++];
    *p = (piece){.segment = i, .a = begins ? own->a : 0.0, .b = ends_here ? own->b : 1.0};
    p->level = begins || ends_here ? 0 : level_of_block(t, i, own->b < 1.0 ? own->last - 1 : own->last);
    const size_t size = (size_t)1 << p->level, end = i + size < t->n_segments ? i + size : t->n_segments;
    if (w->by_time) {
      p->along[0] = begins ? 0.0 : place_of(w, t->times[i], NULL, 0);
      p->along[1] = ends_here ? 1.0 : place_of(w, t->times[end], NULL, 0);
    }
    if (p->level > 0) {
      const double *from = knot_at(t, i), *to = knot_at(t, end);
      p->along[0] = place_of(w, t->times[i], from, 1), p->along[1] = place_of(w, t->times[end], to, 1);
      take_block(w, from, to, block_at(t, p->level, i >> p->level), p->along);
    } else {
      lane_row *c = ends[i + 1 == own->last];
      if (!begins && !ends_here) load_segment(t, i, c);
      take_polynomial(w, (const lane_row *)c, t->degree[i], p->along);
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

/* The straight line through the values at the centre, which are `along` the chord, and how far the motion is from it.
 */
SIMD_CLONES
static void fill_rows(const walk *w, double along, double off_place, const double *spans_error, double *rows,
                      size_t stride) {
  const double reach = ROUND_UP * greater(along, 1.0 - along), round = 32.0 * ROUND_U * (1.0 + reach);
  const double *value = rows + MOTION_VALUE * stride, *from = w->from, *to = w->to, *low = w->low, *high = w->high,
               *below = w->below, *above = w->above;
  double *first = rows + MOTION_FIRST * stride, *rate = rows + MOTION_W * stride,
         *second = rows + MOTION_SECOND * stride, *acceleration = rows + MOTION_A * stride,
         *third = rows + MOTION_G * stride, *shift = rows + MOTION_SHIFT * stride,
         *variation = rows + MOTION_VARIATION * stride, *lines = rows + MOTION_LINE * stride,
         *strays = rows + MOTION_STRAY * stride;
  const size_t n = lanes_padded(w->n);
#pragma omp simd
  for (size_t j = 0; j < n; j++) {
    const double slope = 2.0 * reach * (to[j] - from[j]);
    const double off = value[j] - ((1.0 - along) * from[j] + along * to[j]);
    const double size = greater(fabs(low[j]), fabs(high[j]));
    const double error = 2.0 * spans_error[j] + round * size + 2.0 * off_place * fabs(slope);
    const double stray = greater(above[j] - off, off - below[j]) + error;
    const double by_range = greater(high[j] - value[j], value[j] - low[j]) + error;
    const double line = 0.5 * fabs(slope);
    first[j] = slope, rate[j] = fabs(slope);
    second[j] = acceleration[j] = third[j] = 0.0;
    shift[j] = lesser(by_range, line + stray);
    variation[j] = INFINITY;
    lines[j] = line, strays[j] = stray;
  }
}

/* The span's own range, and its range beside its chord. */
SIMD_CLONES
static size_t walk_over(const motion_track *t, const motion_interval *own, walk *w, lane_row *ends[2], piece *pieces) {
  const size_t count = take_pieces(t, w, own, ends, pieces);
  round_outward(w);
  return count;
}

/* The values where the span begins, or ends; there the segment is cut, if it is. */
SIMD_CLONES
static void cut_end(const motion_track *t, const motion_interval *own, bool at_end, lane_row *c, double *values) {
  const size_t segment = at_end ? own->last - 1 : own->first, i = at_end ? t->degree[segment] : 0;
  const double a = at_end ? 0.0 : own->a, b = at_end ? own->b : 1.0;
  if (a > 0.0 || b < 1.0) {
    cut_segment(t, segment, a, b, c);
    for (size_t first = 0; first < t->n_moving; first += MOTION_LANES, c += LANE_ROWS)
      memcpy(values + first, c[i], sizeof c[i]);
  } else {
    const double *of = coefficients_of(t, segment) + i;
    for (size_t j = 0; j < t->n_moving; j++) values[j] = of[j * t->stride];
  }
}

void motion_fill_span(const cprox_motion *m, const motion_track *t, const motion_interval *over,
                      const motion_interval *own, span_centre *centre, double *rows) {
  const size_t n = t->n_moving, stride = m->row_size;
  const duration whole = duration_of(m, over);
  double *cut = rows + MOTION_CUT * stride;
  lane_row *ends[2] = {(lane_row *)cut, (lane_row *)(cut + LANE_ROWS * lanes_padded(n))};
  rows += t->first_slot;
  double *span = rows + MOTION_FROM * stride;
  cut_end(t, own, false, ends[0], span);
  cut_end(t, own, true, ends[1], rows + MOTION_TO * stride);
  walk w = walk_along(n, t->by_time ? &whole : NULL, span, stride);
  piece pieces[MOST_PIECES];
  const size_t count = n > 0 ? walk_over(t, own, &w, ends, pieces) : 0;
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
  const double along = t->by_time ? 0.5 : clamped(along_of(&w, value, 1));
  if (n > 0) fill_rows(&w, along, off_place, t->spans.error, rows, stride);
}
