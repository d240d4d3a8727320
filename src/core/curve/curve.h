/* SPDX-License-Identifier: BSD-3-Clause */
/* What every basis compiles to: Bézier pieces of one degree, and a binary tree of chord capsules above them. */
#ifndef CPROX_CURVE_CURVE_H
#define CPROX_CURVE_CURVE_H

#include <stdbool.h>
#include <stdint.h>

#include "base/rounding.h"
#include "base/vec.h"
#include "curve_proximity/cprox/curve.h"

/* All points within `radius` of the segment between the ends of pieces [first, last): contains their control points,
 * rounding included. */
typedef struct curve_capsule {
  vec3 a, b;
  double radius;
} curve_capsule;

/* Nodes of the tree that are bounded at once lie side by side: what is three levels below a node. */
enum { CURVE_PACK = 8 };

/* The largest magnitude of a coordinate, a knot or a parameter. */
#define CURVE_LARGEST 1e150

/* Lengths below this may lose their squares to underflow; it is added where a length must not come out too small. */
#define CURVE_LEAST 1e-150

struct cprox_curve {
  uint32_t n_pieces, n_leaves, degree;
  uint8_t kind;   /* cprox_curve_kind */
  bool flat;      /* all control points have the z of the first, exactly */
  bool in_reach;  /* it keeps within what queries can hold */
  vec3 *points;   /* n_pieces * (degree + 1) control points */
  double *breaks; /* n_pieces + 1 parameters, ascending; piece i covers [breaks[i], breaks[i+1]] */
  double *error;  /* a piece's: each exact point of the curve is within this of the computed piece's (rounding of the
                     conversion; for compiled bases their remainder) */
  cprox_rectifiable_curve *arcs; /* NULL, or what a curve is known by that has no control points: then its pieces are
                                    chords of degree 1, their errors how far the curve is from them, and intervals are
                                    those of rectifiable.h */
  double radius;                 /* of node 1: it is asked for by every query, and often nothing else is */
  double largest;                /* at least |P| of every control point */
};

/* Behind the errors stand the radii of the nodes, where there is more than one, then the tables of a high degree, then
 * what the constructor wanted room for.
 *
 * Heap order: node 1 is the root, node k has children 2k and 2k+1; the n_leaves leaves (a power of two >= n_pieces)
 * stand at n_leaves + i for piece i. A node's capsule runs from the first to the last point of its pieces, so that only
 * its radius is kept, in units of curve_unit(). */
static inline float *curve_radii(const cprox_curve *c) {
  return (float *)(void *)(c->error + c->n_pieces);
}

static inline size_t curve_radii_size(size_t n_leaves) {
  return n_leaves > 1 ? 2 * n_leaves : 0;
}

static inline double curve_unit(const cprox_curve *c) {
  return c->largest + CURVE_LEAST;
}

static inline const vec3 *curve_piece(const cprox_curve *c, size_t i) {
  return c->points + i * ((size_t)c->degree + 1);
}

/* The last piece that begins at or before t, for t inside the domain; at its end the last one. */
size_t curve_piece_at(const cprox_curve *c, double t);

static inline double curve_radius_at(const cprox_curve *c, size_t node) {
  return node == 1 ? c->radius : curve_unit(c) * (double)curve_radii(c)[node];
}

/* Levels from a node down to the leaves. */
static inline int curve_levels_below(const cprox_curve *c, size_t node) {
  return __builtin_clzll(node) - __builtin_clzll(c->n_leaves);
}

/* A node below which there are no pieces. */
static inline bool curve_is_empty_at(const cprox_curve *c, size_t node) {
  return (node << curve_levels_below(c, node)) - c->n_leaves >= c->n_pieces;
}

/* The first and the last point of a node that is not empty. */
typedef struct curve_ends {
  const vec3 *a, *b;
} curve_ends;

static inline curve_ends curve_ends_at(const cprox_curve *c, size_t node) {
  const int levels = curve_levels_below(c, node);
  const size_t first = (node << levels) - c->n_leaves, end = ((node + 1) << levels) - c->n_leaves;
  return (curve_ends){curve_piece(c, first), curve_piece(c, end < c->n_pieces ? end : c->n_pieces) - 1};
}

/* radius < 0: no pieces. */
static inline curve_capsule curve_capsule_at(const cprox_curve *c, size_t node) {
  if (curve_is_empty_at(c, node)) return (curve_capsule){.radius = -1.0};
  const curve_ends ends = curve_ends_at(c, node);
  return (curve_capsule){*ends.a, *ends.b, curve_radius_at(c, node)};
}

static inline curve_capsule curve_whole(const cprox_curve *c) {
  return (curve_capsule){c->points[0], *(curve_piece(c, c->n_pieces) - 1), c->radius};
}

/* A curve with room for the pieces; breaks, points and error are the caller's to fill, then curve_finish(). NULL where
 * memory is out (cprox_curve_free() frees). `room`: bytes that the caller wants besides, at curve_room(). */
cprox_curve *curve_allocate(size_t degree, size_t n_pieces);
cprox_curve *curve_allocate_with(size_t degree, size_t n_pieces, size_t room);
void *curve_room(const cprox_curve *c);

/* The same in memory of the caller's, curve_arrays_size() bytes. */
size_t curve_arrays_size(size_t degree, size_t n_pieces);
void curve_lay_out(cprox_curve *c, size_t degree, size_t n_pieces, void *memory);

/* Numbers of a degree: C(degree - 2, k), for evaluation by the last three de Casteljau points, none below 2; and for
 * control_distance_from(): 1 / C(2 degree, k), k <= degree. Of low degrees they are constants. */
enum { CURVE_LOW_DEGREE = 5 };
extern const double *const curve_low_tables[CURVE_LOW_DEGREE + 1];
size_t curve_tables_size(size_t degree);
void curve_fill_tables(size_t degree, double *tables);

static inline const double *curve_own_tables(const cprox_curve *c) {
  return (const double *)(const void *)(curve_radii(c) + curve_radii_size(c->n_leaves));
}

static inline const double *curve_binomial(const cprox_curve *c) {
  return c->degree <= CURVE_LOW_DEGREE ? curve_low_tables[c->degree] : curve_own_tables(c);
}

static inline const double *curve_per_twice(const double *binomial, size_t degree) {
  return binomial + (degree < 2 ? 0 : degree - 1);
}

/* C(degree, k) of C(degree - 2, k), by Pascal's rule twice. */
static inline void curve_own_binomials(const double *binomial, size_t degree, double own[CPROX_MAX_DEGREE + 1]) {
  double padded[CPROX_MAX_DEGREE + 3];
  if (degree < 2) {
    own[0] = own[degree] = 1.0;
    return;
  }
  padded[0] = padded[1] = 0.0;
  for (size_t k = 0; k + 2 <= degree; k++) padded[k + 2] = binomial[k];
  padded[degree + 1] = padded[degree + 2] = 0.0;
  for (size_t k = 0; k <= degree; k++) own[k] = padded[k] + 2.0 * padded[k + 1] + padded[k + 2];
}

/* Builds the capsules and tables over pieces that are filled in. */
void curve_build(cprox_curve *c);

/* The same at the end of a constructor, which hands the curve over. Where cprox_workspace_set_stop() wants an end it is
 * freed instead. */
cprox_status curve_finish(cprox_curve *c, cprox_workspace *workspace, cprox_curve **curve);

/* Whether an end is wanted of what has made so many pieces by now; asked after each thousand or so of them. */
bool curve_stops(size_t n_pieces, cprox_workspace *workspace);

/* Says so, and frees what there is of the curve. */
cprox_status curve_stopped(cprox_curve *c, cprox_workspace *workspace);

/* The constructors, one a kind: each reads and checks the members of the description that its kind has. *curve is
 * untouched on failure. create.c lists them. */
typedef cprox_status curve_constructor(const cprox_curve_description *d, cprox_workspace *workspace,
                                       cprox_curve **curve);
curve_constructor curve_create_bezier, curve_create_bspline, curve_create_polynomial, curve_create_legendre,
    curve_create_lagrange, curve_create_trigonometric, curve_create_clothoid, curve_create_dubins,
    curve_create_involute, curve_create_pythagorean_hodograph, curve_create_piecewise, curve_create_smooth,
    curve_create_rectifiable, curve_create_rational_bezier, curve_create_nurbs, curve_create_part;

/* The weights of a kind's coefficients at t, as many as there are coefficients; the description is not checked. */
typedef void curve_weighting(const cprox_curve_description *d, double t, double *weights);
curve_weighting curve_weights_bezier, curve_weights_bspline, curve_weights_polynomial, curve_weights_legendre,
    curve_weights_lagrange, curve_weights_trigonometric, curve_weights_rational_bezier, curve_weights_nurbs;

/* The derivatives of a kind's point at t by the numbers that define the curve; the description is not checked. */
typedef cprox_status curve_differentiator(const cprox_curve_description *d, double t, cprox_vec3 *columns);
curve_differentiator curve_jacobian_clothoid, curve_jacobian_dubins, curve_jacobian_involute,
    curve_jacobian_pythagorean_hodograph, curve_jacobian_rational_bezier, curve_jacobian_nurbs;

/* The arcs and the line of a Dubins path as it would be made; false where there is none. */
bool curve_find_dubins(const cprox_curve_description *d, cprox_dubins_path *path);
/* Which way part i of a path of this word turns: 1 left, -1 right, 0 straight on. */
int curve_dubins_turn(cprox_dubins_word word, int i);

/* Checks that constructors share: CPROX_OK, or CPROX_INVALID with the message set. The points: at least 2, finite,
 * small enough that their squares do not overflow. The range: finite, t0 < t1. */
cprox_status curve_check_points(const vec3 *points, size_t n, cprox_workspace *workspace);
/* 1 … most vectors that are no points of the curve, under a name of their own ("coefficient"). */
cprox_status curve_check_values(const char *name, const vec3 *values, size_t n, size_t most,
                                cprox_workspace *workspace);
/* Points, degree, knots and range of a spline, rational or not. */
cprox_status curve_check_spline(const cprox_curve_description *d, cprox_workspace *workspace);
cprox_status curve_check_range(double t0, double t1, cprox_workspace *workspace);
/* All of it for a sum of coefficients times functions of t. */
cprox_status curve_check_sum(const vec3 *coefficients, size_t n, double t0, double t1, cprox_workspace *workspace);

/* The Bézier points b_j = f(lo^(p-j), hi^j) of the polynomial whose blossom f has the p + 1 de Boor points d over the
 * 2p knots u, for u[p-1] <= lo < hi <= u[p]. Convex combinations only: each b_j is within 5 p u max|d| of the exact
 * one. */
void curve_blossom(const vec3 *d, const double *u, size_t p, double lo, double hi, vec3 *b);

/* The same for one span of a spline, or a part of a Bézier piece whose knots all stand at its ends; returns the error
 * of the points. */
double curve_convert_span(const vec3 *control, const double *knots, size_t degree, double lo, double hi, vec3 *bezier);

/* Value and derivatives (by the local parameter s of [0,1]) of one Bézier piece of degree >= 1, SoA or not is the
 * caller's: x, y, z with the given stride. Any output may be NULL. The value is within (3 n + 3) u max|P| of the exact
 * one. */
void curve_bezier_evaluate(const double *x, const double *y, const double *z, size_t stride, size_t degree,
                           const double *binomial, double s, vec3 *value, vec3 *first, vec3 *second);

/* The ends of the parameter range. */
static inline void curve_domain(const cprox_curve *c, double *t0, double *t1) {
  *t0 = c->breaks[0];
  *t1 = c->breaks[c->n_pieces];
}

/* How far the curve as it was given may be from its computed pieces; of one known by its arc length: from its points.
 */
double curve_error(const cprox_curve *c);

#endif
