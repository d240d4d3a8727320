/* SPDX-License-Identifier: BSD-3-Clause */
#include "curve/relative_curve.h"

#include "base/frame.h"
#include "base/rounding.h"
#include "base/workspace.h"

enum { MOST_POINTS = CPROX_MAX_DEGREE + 1 };

/* ---- one piece ---- */

/* Control points about a common base, and how far the exact piece may be from them. */
typedef struct section {
  vec3 points[MOST_POINTS];
  size_t degree;
  double error;
} section;

static double largest(const section *s) {
  double most = 0.0;
  for (size_t i = 0; i <= s->degree; i++) most = fmax(most, vec_norm(s->points[i]));
  return most;
}

/* Cuts the piece over [left, right] down to [t0, t1]; exact in t, 5 p u max|P| in the points (curve_blossom). */
static void section_cut(section *s, double left, double right, double t0, double t1) {
  if (t0 == left && t1 == right) return;
  double knots[2 * CPROX_MAX_DEGREE];
  for (size_t k = 0; k < s->degree; k++) {
    knots[k] = left;
    knots[s->degree + k] = right;
  }
  s->error += ROUND_UP * 5.0 * (double)s->degree * ROUND_U * largest(s);
  vec3 cut[MOST_POINTS];
  curve_blossom(s->points, knots, s->degree, t0, t1, cut);
  for (size_t i = 0; i <= s->degree; i++) s->points[i] = cut[i];
}

/* Raises the degree by one: q_i = i/n p_(i-1) + (1 - i/n) p_i. A weight has at most 2 roundings, product and sum one
 * each. */
static void section_elevate(section *s) {
  s->error += ROUND_UP * 4.0 * ROUND_U * largest(s);
  const size_t n = ++s->degree;
  s->points[n] = s->points[n - 1];
  for (size_t i = n - 1; i > 0; i--) {
    const double before = (double)i / (double)n, after = (double)(n - i) / (double)n;
    s->points[i] = vec_axpy(vec_scale(before, s->points[i - 1]), after, s->points[i]);
  }
}

/* The part [t0, t1] of a piece of the first curve, about `base`. */
static void section_of_first(const cprox_curve *c, size_t piece, vec3 base, double t0, double t1, section *s) {
  s->degree = c->degree;
  s->error = c->error[piece];
  const vec3 *p = curve_piece(c, piece);
  for (size_t i = 0; i <= c->degree; i++) s->points[i] = vec_sub(p[i], base);
  s->error += ROUND_UP * ROUND_U * largest(s);
  section_cut(s, c->breaks[piece], c->breaks[piece + 1], t0, t1);
}

/* The same of the second one, turned and moved by its pose. */
static void section_of_second(const cprox_curve *c, size_t piece, const frame *f, vec3 base, double t0, double t1,
                              section *s) {
  s->degree = c->degree;
  const vec3 *q = curve_piece(c, piece), ahead = vec_sub(f->position, base);
  double size = 0.0;
  for (size_t i = 0; i <= c->degree; i++) {
    s->points[i] = vec_add(frame_turn_to_world(f, q[i]), ahead);
    size = fmax(size, vec_norm(q[i]));
  }
  /* the turn; the base taken off, which is exact without a position; the sum */
  const bool moved = vec_norm2(f->position) > 0.0;
  s->error =
      c->error[piece] +
      ROUND_UP * ROUND_U * ((f->rotated ? ROUND_ROTATION * size : 0.0) + (moved ? vec_norm(ahead) : 0.0) + largest(s));
  section_cut(s, c->breaks[piece], c->breaks[piece + 1], t0, t1);
}

/* ---- the curve ---- */

/* Lays out the arrays of a curve in a buffer of the workspace. */
static bool lay_out(size_t degree, size_t n_pieces, cprox_workspace *workspace, workspace_buffer buffer,
                    cprox_curve *c) {
  void *memory =
      n_pieces <= INT32_MAX / 2 ? workspace_reserve(workspace, buffer, curve_arrays_size(degree, n_pieces)) : NULL;
  if (!memory) return false;
  *c = (cprox_curve){.arcs = NULL};
  curve_lay_out(c, degree, n_pieces, memory);
  return true;
}

/* The first curve, cut at the joints of both and of the higher degree, less the second one where a frame places it. */
static bool combine(const cprox_curve *first, const cprox_curve *second, const frame *placed, double t0, double t1,
                    cprox_workspace *workspace, workspace_buffer buffer, cprox_curve *relative) {
  size_t i = curve_piece_at(first, t0), j = curve_piece_at(second, t0), n_pieces = 1;

  /* every joint of either begins a piece */
  size_t a = i, b = j;
  for (;; n_pieces++) {
    const double next = fmin(first->breaks[a + 1], second->breaks[b + 1]);
    if (!(next < t1)) break;
    a += first->breaks[a + 1] == next;
    b += second->breaks[b + 1] == next;
  }
  const size_t degree = first->degree > second->degree ? first->degree : second->degree;
  if (!lay_out(degree, n_pieces, workspace, buffer, relative)) return false;

  relative->breaks[0] = t0;
  for (size_t k = 0; k < n_pieces; k++) {
    const double left = relative->breaks[k];
    const double right = k + 1 < n_pieces ? fmin(first->breaks[i + 1], second->breaks[j + 1]) : t1;
    relative->breaks[k + 1] = right;
    const vec3 base = placed ? curve_piece(first, i)[0] : vec(0, 0, 0);
    section own, other = {.degree = degree};
    section_of_first(first, i, base, left, right, &own);
    if (placed) section_of_second(second, j, placed, base, left, right, &other);
    while (own.degree < degree) section_elevate(&own);
    while (other.degree < degree) section_elevate(&other);
    double size = 0.0;
    vec3 *points = relative->points + k * (degree + 1);
    for (size_t p = 0; p <= degree; p++) {
      points[p] = vec_sub(own.points[p], other.points[p]);
      size = fmax(size, vec_norm(points[p]));
    }
    relative->error[k] = ROUND_UP * (own.error + other.error + ROUND_U * size);
    i += first->breaks[i + 1] == right && i + 1 < first->n_pieces;
    j += second->breaks[j + 1] == right && j + 1 < second->n_pieces;
  }
  curve_build(relative);
  return true;
}

bool relative_create(const cprox_curve *first, const cprox_curve *second, const cprox_pose *pose, double t0, double t1,
                     cprox_workspace *workspace, workspace_buffer buffer, cprox_curve *relative) {
  const frame f = frame_create(pose, vec(0, 0, 0));
  return combine(first, second, &f, t0, t1, workspace, buffer, relative);
}

bool relative_align(const cprox_curve *curve, const cprox_curve *like, double t0, double t1, cprox_workspace *workspace,
                    workspace_buffer buffer, cprox_curve *aligned) {
  return combine(curve, like, NULL, t0, t1, workspace, buffer, aligned);
}

static vec3 point_at(const cprox_curve *curve, double t, bool from_left, cprox_workspace *workspace) {
  const size_t i = curve_piece_at(curve, t);
  if (from_left && i > 0 && curve->breaks[i] == t) return curve_piece(curve, i - 1)[curve->degree];
  vec3 point = vec(0, 0, 0);
  (void)WORKSPACE_LEND(workspace, cprox_curve_evaluate(curve, t, workspace, &point, NULL, NULL));
  return point;
}

vec3 relative_position(const cprox_curve *curve, const cprox_pose *pose, double t, bool from_left,
                       cprox_workspace *workspace) {
  const vec3 point = point_at(curve, t, from_left, workspace);
  const frame f = frame_create(pose, vec(0, 0, 0));
  return frame_to_world(&f, point);
}
