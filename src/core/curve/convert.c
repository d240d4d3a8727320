/* SPDX-License-Identifier: BSD-3-Clause */
#include "curve/convert.h"

#include <stdlib.h>
#include <string.h>

#include "base/workspace.h"

/* A piece whose points are more than this many times as large as the curve is halved. */
#define CROWDED 4.0

/* Halving ends here at the latest. */
#define MOST_PIECES 256

convert_piece *convert_allocate(size_t n) {
  return calloc(n, sizeof(convert_piece));
}

uint64_t convert_binomial(size_t n, size_t k) {
  uint64_t c = 1;
  if (k > n - k) k = n - k;
  for (size_t i = 1; i <= k; i++) {
    /* c (n - k + i) / i without leaving 64 bits: the whole part and the rest apart */
    const uint64_t whole = c / i, rest = c % i, factor = n - k + i;
    c = whole * factor + rest * factor / i;
  }
  return c;
}

static vec3 high_part(const convert_point *p) {
  return vec(p->k[0].high, p->k[1].high, p->k[2].high);
}

static vec3 low_part(const convert_point *p) {
  return vec(p->k[0].low, p->k[1].low, p->k[2].low);
}

static double largest_point(const convert_piece *piece, size_t degree) {
  double largest = 0.0;
  for (size_t j = 0; j <= degree; j++) largest = fmax(largest, vec_norm2(high_part(&piece->control[j])));
  return sqrt(largest);
}

/* A size that the curve has at least: that of its points at the ends of pieces. */
static double curve_size(const convert_piece *pieces, size_t n, size_t degree) {
  double largest = 0.0;
  for (size_t i = 0; i < n; i++)
    largest = fmax(largest,
                   fmax(vec_norm2(high_part(&pieces[i].control[0])), vec_norm2(high_part(&pieces[i].control[degree]))));
  return sqrt(largest);
}

static double middle(const convert_piece *piece) {
  return 0.5 * piece->from + 0.5 * piece->to;
}

/* Whether half of the piece would be rounded better: its points are large against the curve, what rounding them costs
 * is more than the error they have already, and there is a double to cut it at. */
static bool is_ill_conditioned(const convert_piece *piece, size_t degree, double size) {
  const double largest = largest_point(piece, degree), cut = middle(piece);
  return largest > CROWDED * size && ROUND_U * largest > piece->error && piece->from < cut && cut < piece->to;
}

/* de Casteljau at the double nearest to the middle.
 *
 * Error: the differences of parameters are exact, so a weight has the error of its division; its product and the sum
 * add theirs. The combinations are convex, so n levels add n (divide + multiply + add) u² max|P|. */
static void halve(const convert_piece *piece, size_t degree, convert_piece *left, convert_piece *right) {
  const double cut = middle(piece);
  const dd length = dd_sum(piece->to, -piece->from);
  const dd of_left = dd_divide(dd_sum(piece->to, -cut), length);
  const dd of_right = dd_divide(dd_sum(cut, -piece->from), length);
  const double levels = (double)degree * (DD_DIVIDE + DD_MULTIPLY + DD_ADD);
  const double error = piece->error + ROUND_UP * levels * DD_UNIT * largest_point(piece, degree);

  *right = *piece;
  left->from = piece->from;
  left->to = right->from = cut;
  left->error = right->error = error;
  convert_point *p = right->control;
  left->control[0] = p[0];
  for (size_t level = 1; level <= degree; level++) {
    for (size_t i = 0; i + level <= degree; i++)
      for (int k = 0; k < 3; k++)
        p[i].k[k] = dd_add(dd_multiply(of_left, p[i].k[k]), dd_multiply(of_right, p[i + 1].k[k]));
    left->control[level] = p[0];
  }
}

/* Halves every crowded piece once. Takes *pieces and *n over: false where memory is out, with both as they were. */
static bool halve_ill_conditioned(convert_piece **pieces, size_t *n, size_t degree, bool *changed) {
  const double size = curve_size(*pieces, *n, degree);
  size_t crowded = 0;
  for (size_t i = 0; i < *n; i++) crowded += is_ill_conditioned(&(*pieces)[i], degree, size);
  *changed = crowded > 0;
  if (crowded == 0) return true;

  convert_piece *finer = convert_allocate(*n + crowded), *next = finer;
  if (!finer) return false;
  for (size_t i = 0; i < *n; i++) {
    const convert_piece *piece = &(*pieces)[i];
    if (is_ill_conditioned(piece, degree, size)) {
      halve(piece, degree, next, next + 1);
      next += 2;
    } else {
      *next++ = *piece;
    }
  }
  free(*pieces);
  *pieces = finer;
  *n += crowded;
  return true;
}

/* Rounds a piece to doubles; returns its error. What is cut off is known exactly; combinations of the points being
 * convex, it moves no point by more than the largest cut. */
static double round_piece(const convert_piece *piece, size_t degree, vec3 *points) {
  double cut = 0.0;
  for (size_t j = 0; j <= degree; j++) {
    points[j] = high_part(&piece->control[j]);
    cut = fmax(cut, vec_norm2(low_part(&piece->control[j])));
  }
  return ROUND_UP * (sqrt(cut) + piece->error) + CURVE_LEAST;
}

static cprox_status round_pieces(const convert_piece *pieces, size_t n, size_t degree, cprox_workspace *workspace,
                                 cprox_curve **curve) {
  cprox_curve *c = curve_allocate(degree, n);
  if (!c) return workspace_fail(workspace, CPROX_MEMORY, "no memory for a curve of %zu pieces", n);
  c->breaks[0] = pieces[0].from;
  for (size_t i = 0; i < n; i++) {
    vec3 *points = c->points + i * (degree + 1);
    c->breaks[i + 1] = pieces[i].to;
    c->error[i] = round_piece(&pieces[i], degree, points);

    /* the negation catches what is not a number, too */
    bool small = c->error[i] <= CURVE_LARGEST;
    for (size_t j = 0; j <= degree; j++)
      small = small && fabs(points[j].x) <= CURVE_LARGEST && fabs(points[j].y) <= CURVE_LARGEST &&
              fabs(points[j].z) <= CURVE_LARGEST;
    if (!small) {
      cprox_curve_free(c);
      return workspace_fail(workspace, CPROX_INVALID, "on [%.15g, %.15g] the curve goes beyond %g m", pieces[i].from,
                            pieces[i].to, CURVE_LARGEST);
    }
  }
  return curve_finish(c, workspace, curve);
}

cprox_status convert_finish(convert_piece *pieces, size_t n, size_t degree, cprox_workspace *workspace,
                            cprox_curve **curve) {
  bool changed = true;
  while (changed && n <= MOST_PIECES) {
    if (!halve_ill_conditioned(&pieces, &n, degree, &changed)) {
      free(pieces);
      return workspace_fail(workspace, CPROX_MEMORY, "no memory for a curve of %zu pieces", n);
    }
  }
  const cprox_status status = round_pieces(pieces, n, degree, workspace, curve);
  free(pieces);
  return status;
}
