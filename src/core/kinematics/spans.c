/* SPDX-License-Identifier: BSD-3-Clause */
/* The letters are those of doc/robot-bounds.md, Spans. */
#include "kinematics/spans.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/rounding.h"
#include "kinematics/motion.h"

/* The finest blocks that are stored are of 4 segments. */
enum { FINEST = 2, FINEST_SIZE = 1 << FINEST, MOST_PIECES = 2 * (SPAN_MOST_LEVELS + FINEST_SIZE) };

/* Spans that stray farther than this part of their chord are only bounded by their ranges. */
static const double BENT = 0.1;

/* ---- blocks ---- */

typedef enum block_row { BLOCK_LOW, BLOCK_HIGH, BLOCK_BELOW, BLOCK_ABOVE, BLOCK_ROWS } block_row;

static size_t blocks_of_level(const cprox_motion *m, size_t level) {
  return (m->n_segments + ((size_t)1 << level) - 1) >> level;
}

/* That of segments k 2^level … (k + 1) 2^level - 1. */
static double *block_at(const cprox_motion *m, size_t level, size_t k) {
  return m->spans.blocks + (m->spans.first[level] + k) * BLOCK_ROWS * m->n_moving;
}

/* The values at the beginning of a segment whose number is a multiple of 4, or at the end of the last one. */
static const double *knot_at(const cprox_motion *m, size_t segment) {
  const size_t k = segment < m->n_segments ? segment / FINEST_SIZE : blocks_of_level(m, FINEST);
  return m->spans.knots + k * m->n_moving;
}

static const double *coefficients_of(const cprox_motion *m, size_t segment) {
  return m->coefficients + segment * m->n_moving * m->stride;
}

/* ---- along a chord ---- */

/* A chord, and what the pieces so far say of the way beside it. */
typedef struct walk {
  size_t n;
  const double *from, *to;
  double inverse; /* 1 over the chord's length squared, 0 for one that is too short */
  double *low, *high, *below, *above;
} walk;

static walk walk_along(size_t n, const double *from, const double *to, double *low, double *high, double *below,
                       double *above) {
  double length2 = 0.0;
  for (size_t j = 0; j < n; j++) {
    length2 += (to[j] - from[j]) * (to[j] - from[j]);
    low[j] = below[j] = INFINITY, high[j] = above[j] = -INFINITY;
  }
  const double inverse = length2 > 1e-280 ? 1.0 / length2 : 0.0;
  return (walk){
      .n = n, .from = from, .to = to, .inverse = inverse, .low = low, .high = high, .below = below, .above = above};
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

static double beside(const walk *w, double along, double value, size_t j) {
  return value - ((1.0 - along) * w->from[j] + along * w->to[j]);
}

/* A piece by its own ends and what it says of the way beside its own chord: that chord strays as far as its ends. */
static void take_block(walk *w, const double *begin, const double *end, const double *block, double along[2]) {
  const size_t n = w->n;
  along[0] = clamped(along_of(w, begin, 1)), along[1] = clamped(along_of(w, end, 1));
  for (size_t j = 0; j < n; j++) {
    const double e0 = beside(w, along[0], begin[j], j), e1 = beside(w, along[1], end[j], j);
    w->low[j] = lesser(block[BLOCK_LOW * n + j], w->low[j]);
    w->high[j] = greater(block[BLOCK_HIGH * n + j], w->high[j]);
    w->below[j] = lesser(lesser(e0, e1) + block[BLOCK_BELOW * n + j], w->below[j]);
    w->above[j] = greater(greater(e0, e1) + block[BLOCK_ABOVE * n + j], w->above[j]);
  }
}

/* A polynomial by its coefficients: those of its place along the chord are in [0, 1], so that its place is. */
static void take_polynomial(walk *w, const double *c, size_t stride, size_t degree, double along[2]) {
  for (size_t i = 0; i <= degree; i++) {
    const double s = clamped(along_of(w, c + i, stride));
    if (i == 0) along[0] = s;
    along[1] = s;
    for (size_t j = 0; j < w->n; j++) {
      const double value = c[j * stride + i], e = beside(w, s, value, j);
      w->low[j] = lesser(value, w->low[j]), w->high[j] = greater(value, w->high[j]);
      w->below[j] = lesser(e, w->below[j]), w->above[j] = greater(e, w->above[j]);
    }
  }
}

/* What rounding adds: four roundings of the sizes that enter. */
static void round_outward(const walk *w) {
  for (size_t j = 0; j < w->n; j++) {
    const double off = 16.0 * ROUND_U * greater(fabs(w->low[j]), fabs(w->high[j]));
    w->below[j] -= off, w->above[j] += off;
  }
}

/* ---- the tree ---- */

static void make_block(const cprox_motion *m, size_t level, size_t k) {
  const size_t n = m->n_moving, size = (size_t)1 << level, first = k * size;
  const size_t last = first + size < m->n_segments ? first + size : m->n_segments;
  double *block = block_at(m, level, k), along[2];
  walk w = walk_along(n, knot_at(m, first), knot_at(m, last), block, block + BLOCK_HIGH * n, block + BLOCK_BELOW * n,
                      block + BLOCK_ABOVE * n);
  for (size_t i = first; i < last && level == FINEST; i++)
    take_polynomial(&w, coefficients_of(m, i), m->stride, m->degree[i], along);
  for (size_t i = first; i < last && level > FINEST; i += size / 2) {
    const size_t end = i + size / 2 < last ? i + size / 2 : last;
    take_block(&w, knot_at(m, i), knot_at(m, end), block_at(m, level - 1, i >> (level - 1)), along);
  }
  round_outward(&w);
}

bool motion_spans_make(cprox_motion *m) {
  motion_spans *s = &m->spans;
  const size_t n = m->n_moving;
  *s = (motion_spans){0};
  if (m->n_segments < 2 || n == 0) return true;
  size_t top = FINEST, blocks = 0;
  while (((size_t)1 << top) < m->n_segments) top++;
  for (size_t level = FINEST; level <= top; level++) {
    s->first[level] = blocks;
    blocks += blocks_of_level(m, level);
  }
  const size_t knots = blocks_of_level(m, FINEST);
  s->blocks = malloc(blocks * BLOCK_ROWS * n * sizeof *s->blocks);
  s->knots = malloc((knots + 1) * n * sizeof *s->knots);
  s->error = calloc(n, sizeof *s->error);
  if (!s->blocks || !s->knots || !s->error) {
    motion_spans_free(s);
    return false;
  }
  s->levels = top + 1;
  for (size_t k = 0; k <= knots; k++) {
    const size_t segment = k < knots ? k * FINEST_SIZE : m->n_segments - 1, i = k < knots ? 0 : m->degree[segment];
    for (size_t j = 0; j < n; j++) s->knots[k * n + j] = coefficients_of(m, segment)[j * m->stride + i];
  }
  for (size_t i = 0; i < m->n_segments; i++)
    for (size_t j = 0; j < n; j++) s->error[j] = greater(m->error[i * n + j], s->error[j]);
  for (size_t level = FINEST; level <= top; level++)
    for (size_t k = 0; k < blocks_of_level(m, level); k++) make_block(m, level, k);
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
static void cut_segment(const cprox_motion *m, size_t segment, double a, double b, double *out) {
  const size_t degree = m->degree[segment];
  for (size_t j = 0; j < m->n_moving; j++) {
    double *c = out + j * m->stride;
    memcpy(c, coefficients_of(m, segment) + j * m->stride, (degree + 1) * sizeof *c);
    if (a > 0.0)
      for (size_t r = 1; r <= degree; r++)
        for (size_t i = 0; i + r <= degree; i++) c[i] = (1.0 - a) * c[i] + a * c[i + 1];
    if (b >= 1.0) continue;
    const double s = (b - a) / (1.0 - a);
    for (size_t r = 1; r <= degree; r++)
      for (size_t i = degree; i >= r; i--) c[i] = (1.0 - s) * c[i - 1] + s * c[i];
  }
}

static double value_at(const double *coefficients, size_t degree, double u) {
  double c[MOTION_MAX_DEGREE + 1] = {0};
  memcpy(c, coefficients, (degree + 1) * sizeof *c);
  for (size_t r = 1; r <= degree; r++)
    for (size_t i = 0; i + r <= degree; i++) c[i] = (1.0 - u) * c[i] + u * c[i + 1];
  return c[0];
}

/* The largest block that begins at the segment and ends by `last`; 0: only the segment itself. */
static size_t level_of_block(const cprox_motion *m, size_t segment, size_t last) {
  size_t level = 0;
  for (size_t l = FINEST; l < m->spans.levels; l++) {
    const size_t size = (size_t)1 << l;
    if (segment % size != 0 || (segment + size > last && last < m->n_segments)) break;
    level = l;
    if (segment + size >= last) break;
  }
  return level;
}

static size_t take_pieces(const cprox_motion *m, walk *w, size_t first, double a, size_t last, double b, double *cut,
                          piece *pieces) {
  size_t count = 0, i = first;
  while (i < last) {
    const bool begins = i == first && a > 0.0, ends = i + 1 == last && b < 1.0;
    piece *p = &pieces[count++];
    *p = (piece){.segment = i, .a = begins ? a : 0.0, .b = ends ? b : 1.0};
    if (begins || ends) {
      cut_segment(m, i, p->a, p->b, cut);
      take_polynomial(w, cut, m->stride, m->degree[i], p->along);
      i++;
      continue;
    }
    p->level = level_of_block(m, i, b < 1.0 ? last - 1 : last);
    if (p->level == 0) {
      take_polynomial(w, coefficients_of(m, i), m->stride, m->degree[i], p->along);
      i++;
      continue;
    }
    const size_t size = (size_t)1 << p->level, end = i + size < m->n_segments ? i + size : m->n_segments;
    take_block(w, knot_at(m, i), knot_at(m, end), block_at(m, p->level, i >> p->level), p->along);
    i = end;
  }
  return count;
}

/* Where in [a, b] of a segment the middle of the chord is seen. */
static double middle_within(const cprox_motion *m, const walk *w, size_t segment, double a, double b) {
  enum { HALVINGS = 24 };
  const size_t degree = m->degree[segment];
  double along[MOTION_MAX_DEGREE + 1];
  for (size_t i = 0; i <= degree; i++) along[i] = along_of(w, coefficients_of(m, segment) + i, m->stride);
  if (degree == 1) return lesser(greater((0.5 - along[0]) / (along[1] - along[0]), a), b);
  for (int i = 0; i < HALVINGS; i++) {
    const double middle = 0.5 * (a + b);
    if (value_at(along, degree, middle) < 0.5)
      a = middle;
    else
      b = middle;
  }
  return 0.5 * (a + b);
}

/* The place where the motion passes the middle of the chord; any place of the span will do. */
static span_centre find_middle(const cprox_motion *m, const walk *w, const piece *pieces, size_t count) {
  size_t k = 0;
  while (k + 1 < count && pieces[k].along[1] < 0.5) k++;
  const piece *p = &pieces[k];
  size_t segment = p->segment;
  for (size_t level = p->level; level > FINEST; level--) {
    const size_t half = segment + ((size_t)1 << (level - 1));
    if (half < m->n_segments && along_of(w, knot_at(m, half), 1) < 0.5) segment = half;
  }
  const size_t end = segment + (p->level > 0 ? FINEST_SIZE : 1);
  while (segment + 1 < end && segment + 1 < m->n_segments &&
         along_of(w, coefficients_of(m, segment + 1), m->stride) < 0.5)
    segment++;
  return (span_centre){.segment = segment, .u = middle_within(m, w, segment, p->a, p->b)};
}

static bool is_bent(const walk *w) {
  double most = 0.0, chord = 0.0;
  for (size_t j = 0; j < w->n; j++) {
    most = greater(w->above[j] - w->below[j], most);
    chord = greater(fabs(w->to[j] - w->from[j]), chord);
  }
  return most > BENT * chord;
}

/* Where joints are that turn by arcs, in the rows of the variables that move. */
static void place_arcs(const cprox_motion *m, size_t segment, double u, double *value) {
  for (size_t i = 0; i < m->robot->n_axes && m->arcs; i++) {
    if (m->arc_of[i] < 0 || m->robot->axes[i].kind != AXIS_BALL || !m->axis_moves[i]) continue;
    const int32_t *slot = m->slot + m->robot->axes[i].variable;
    double values[7];
    motion_arc_values(m, i, segment, u, values);
    const bool screw = m->arcs[(size_t)m->arc_of[i] * m->n_segments].screw;
    for (int k = screw ? 0 : 3; k < 7; k++) value[slot[k - 3]] = values[k];
  }
}

span_centre motion_fill_span(const cprox_motion *m, size_t first, double a, size_t last, double b, double *rows) {
  const size_t n = m->n_moving, stride = motion_rows_stride(m);
  double *from = rows + MOTION_FROM * stride, *to = rows + MOTION_TO * stride;
  const size_t end_degree = m->degree[last - 1];
  for (size_t j = 0; j < n; j++) {
    from[j] = value_at(coefficients_of(m, first) + j * m->stride, m->degree[first], a);
    to[j] = value_at(coefficients_of(m, last - 1) + j * m->stride, end_degree, b);
  }
  piece pieces[MOST_PIECES];
  walk w = walk_along(n, from, to, rows + MOTION_LOW * stride, rows + MOTION_HIGH * stride,
                      rows + MOTION_BELOW * stride, rows + MOTION_ABOVE * stride);
  const size_t count = n > 0 ? take_pieces(m, &w, first, a, last, b, rows + MOTION_CUT * stride, pieces) : 0;
  round_outward(&w);

  const bool bent = is_bent(&w);
  const size_t half = first + (last - first) / 2;
  span_centre centre = {.segment = half};
  if (!bent && w.inverse > 0.0 && count > 0) centre = find_middle(m, &w, pieces, count);
  centre.bent = bent;

  double *value = rows + MOTION_VALUE * stride;
  for (size_t j = 0; j < n; j++)
    value[j] = value_at(coefficients_of(m, centre.segment) + j * m->stride, m->degree[centre.segment], centre.u);
  place_arcs(m, centre.segment, centre.u, value);
  const double along = clamped(along_of(&w, value, 1)), reach = ROUND_UP * greater(along, 1.0 - along);
  for (size_t j = 0; j < n; j++) {
    const double slope = 2.0 * reach * (to[j] - from[j]), off = beside(&w, along, value[j], j);
    const double size = greater(fabs(w.low[j]), fabs(w.high[j]));
    const double error = 2.0 * m->spans.error[j] + 32.0 * ROUND_U * (1.0 + reach) * size;
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
  return centre;
}
