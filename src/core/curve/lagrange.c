/* SPDX-License-Identifier: BSD-3-Clause */
/* The polynomial through n + 1 points, psi(t) = sum_i y_i l_i(t), l_i(t) = product over m != i of (t - x_m)/(x_i -
 * x_m). Over [a, b] a factor is alpha (1-s) + beta s, alpha = (a - x_m)/(x_i - x_m), beta = (b - x_m)/(x_i - x_m); the
 * factors are multiplied in the scaled Bernstein basis s^j (1-s)^(n-j), in which q_j <- alpha q_j + beta q_(j-1).
 *
 * Error: differences of nodes are exact, so alpha and beta have the error of a division; a factor adds that, a product
 * and a sum. With Q_j the same recurrence in |alpha|, |beta|, the values' products and sum and the division by C(n, j)
 * included: (n (divide + multiply + add) + scale + (n+1) add + divide) u² max_j sum_i |y_i| Q_j/C(n, j), Q being
 * carried along. Factors whose node lies outside [a, b] lose nothing to signs (Q = |q|), so long curves are cut first:
 * to about 8 nodes a piece. Parameters are scaled by a power of two, to at most 1; nodes are at least CLOSEST apart
 * then. What underflows is off by fewer than 1e6 times 2^-1074 in a quotient's numerator, and so by 1e-310/gap times
 * the growth of the factors. */
#include <stdlib.h>

#include "base/workspace.h"
#include "curve/convert.h"

/* The least distance of two nodes, in units of the largest parameter. */
#define CLOSEST 1e-100

/* Nodes a piece, about. */
#define NODES_A_PIECE 8

static cprox_status check_nodes(const double *nodes, size_t n, double largest, cprox_workspace *workspace) {
  for (size_t i = 0; i < n; i++) {
    for (size_t m = 0; m < i; m++) {
      if (nodes[i] == nodes[m])
        return workspace_fail(workspace, CPROX_INVALID, "nodes %zu and %zu are both %.15g; nodes must differ", m, i,
                              nodes[i]);
      if (!(fabs(nodes[i] - nodes[m]) >= CLOSEST * largest))
        return workspace_fail(workspace, CPROX_INVALID, "nodes %zu and %zu, %g and %g, are too close together", m, i,
                              nodes[m], nodes[i]);
    }
  }
  return CPROX_OK;
}

/* l_i over [a, b] in the scaled basis, and the same with absolute values; returns the product of all max(1, |alpha|,
 * |beta|), which no part of it exceeds. */
static double multiply_factors(const double *x, size_t n, size_t i, double a, double b, dd *q, double *size) {
  double growth = 1.0;
  size_t degree = 0;
  q[0] = dd_from(1.0);
  size[0] = 1.0;
  for (size_t m = 0; m <= n; m++) {
    if (m == i) continue;
    const dd divisor = dd_sum(x[i], -x[m]);
    const dd alpha = dd_divide(dd_sum(a, -x[m]), divisor), beta = dd_divide(dd_sum(b, -x[m]), divisor);
    const double alpha_size = fabs(alpha.high), beta_size = fabs(beta.high);
    growth *= fmax(1.0, fmax(alpha_size, beta_size));
    degree++;
    q[degree] = dd_multiply(beta, q[degree - 1]);
    size[degree] = beta_size * size[degree - 1];
    for (size_t j = degree; j-- > 1;) {
      q[j] = dd_add(dd_multiply(alpha, q[j]), dd_multiply(beta, q[j - 1]));
      size[j] = alpha_size * size[j] + beta_size * size[j - 1];
    }
    q[0] = dd_multiply(alpha, q[0]);
    size[0] *= alpha_size;
  }
  return growth;
}

/* The Bézier points of the polynomial over [a, b]; returns their error, INFINITY where it may go beyond all bounds. */
static double interpolate(const vec3 *y, const double *x, size_t n, double a, double b, double gap,
                          convert_point *bezier) {
  dd q[CPROX_MAX_DEGREE + 1];
  double q_size[CPROX_MAX_DEGREE + 1], underflow = 0.0;
  vec3 size[CPROX_MAX_DEGREE + 1];
  for (size_t j = 0; j <= n; j++) {
    bezier[j] = (convert_point){{{0, 0}, {0, 0}, {0, 0}}};
    size[j] = vec(0, 0, 0);
  }
  for (size_t i = 0; i <= n; i++) {
    const double growth = multiply_factors(x, n, i, a, b, q, q_size) * fmax(1.0, vec_norm(y[i]));
    if (!(growth <= CURVE_LARGEST)) return INFINITY;
    underflow += growth * (1e-310 / gap);
    const vec3 y_size = vec(fabs(y[i].x), fabs(y[i].y), fabs(y[i].z));
    for (size_t j = 0; j <= n; j++) {
      size[j] = vec_axpy(size[j], q_size[j], y_size);
      for (int k = 0; k < 3; k++) bezier[j].k[k] = dd_add(bezier[j].k[k], dd_scale(q[j], convert_coordinate(y[i], k)));
    }
  }

  double largest = 0.0;
  for (size_t j = 0; j <= n; j++) {
    const dd binomial = dd_from_count(convert_binomial(n, j));
    for (int k = 0; k < 3; k++) bezier[j].k[k] = dd_divide(bezier[j].k[k], binomial);
    largest = fmax(largest, vec_norm(size[j]) / binomial.high);
  }
  const double degree = (double)n;
  const double steps = degree * (DD_DIVIDE + DD_MULTIPLY + DD_ADD) + DD_SCALE + (degree + 1.0) * DD_ADD + DD_DIVIDE;
  return ROUND_UP * (steps * DD_UNIT * largest + underflow) + CURVE_LEAST;
}

/* The ends of n_pieces parts of about the same length; fewer where there are not as many doubles. */
static size_t cut_range(double t0, double t1, size_t n_pieces, double *ends) {
  size_t n = 0;
  ends[0] = t0;
  for (size_t i = 1; i < n_pieces; i++) {
    const double s = (double)i / (double)n_pieces, cut = (1.0 - s) * t0 + s * t1;
    if (ends[n] < cut && cut < t1) ends[++n] = cut;
  }
  ends[++n] = t1;
  return n;
}

/* A single value is a line that stands still. */
static cprox_status stand_still(const vec3 *point, double t0, double t1, cprox_workspace *workspace,
                                cprox_curve **curve) {
  const vec3 both[2] = {point[0], point[0]};
  return curve_create_bezier(&(cprox_curve_description){.points = both, .n = 2, .t0 = t0, .t1 = t1}, workspace, curve);
}

cprox_status curve_create_lagrange(const cprox_curve_description *d, cprox_workspace *workspace, cprox_curve **curve) {
  const cprox_vec3 *points = d->points;
  const double *nodes = d->knots;
  const size_t n_points = d->n;
  const double t0 = d->t0, t1 = d->t1;
  cprox_status status = curve_check_values("point", points, n_points, CPROX_MAX_DEGREE + 1, workspace);
  if (status == CPROX_OK && !nodes) return workspace_fail(workspace, CPROX_INVALID, "the nodes are NULL");
  if (status == CPROX_OK && d->n_knots != n_points)
    return workspace_fail(workspace, CPROX_INVALID, "%zu points need as many nodes, got %zu", n_points, d->n_knots);
  if (status == CPROX_OK) status = curve_check_range(t0, t1, workspace);
  if (status != CPROX_OK) return status;

  /* the sizes of parameters, and their scale */
  double largest = fmax(fabs(t0), fabs(t1));
  for (size_t i = 0; i < n_points; i++) {
    if (!(fabs(nodes[i]) <= CURVE_LARGEST))
      return workspace_fail(workspace, CPROX_INVALID, "node %zu is %g, not finite or beyond %g", i, nodes[i],
                            CURVE_LARGEST);
    largest = fmax(largest, fabs(nodes[i]));
  }
  status = check_nodes(nodes, n_points, largest, workspace);
  if (status != CPROX_OK) return status;
  if (n_points == 1) return stand_still(points, t0, t1, workspace, curve);
  int exponent;
  frexp(largest, &exponent);
  const size_t n = n_points - 1;
  double x[CPROX_MAX_DEGREE + 1], gap = 1.0;
  for (size_t i = 0; i <= n; i++) {
    x[i] = ldexp(nodes[i], -exponent);
    for (size_t m = 0; m < i; m++) gap = fmin(gap, fabs(x[i] - x[m]));
  }

  double ends[CPROX_MAX_DEGREE / NODES_A_PIECE + 2];
  const size_t n_pieces = cut_range(t0, t1, (n + NODES_A_PIECE - 1) / NODES_A_PIECE, ends);
  convert_piece *pieces = convert_allocate(n_pieces);
  if (!pieces) return workspace_fail(workspace, CPROX_MEMORY, "no memory for a curve of degree %zu", n);
  for (size_t i = 0; i < n_pieces; i++) {
    pieces[i].from = ends[i];
    pieces[i].to = ends[i + 1];
    pieces[i].error =
        interpolate(points, x, n, ldexp(ends[i], -exponent), ldexp(ends[i + 1], -exponent), gap, pieces[i].control);
    if (!(pieces[i].error <= CURVE_LARGEST)) {
      free(pieces);
      return workspace_fail(workspace, CPROX_INVALID,
                            "between its nodes the curve may go beyond %g m: they are too unevenly placed",
                            CURVE_LARGEST);
    }
  }
  return convert_finish(pieces, n_pieces, n, workspace, curve);
}
