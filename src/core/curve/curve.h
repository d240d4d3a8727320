/* SPDX-License-Identifier: BSD-3-Clause */
/* What every basis compiles to: Bézier pieces of one degree, and a binary tree of chord capsules above them. */
#ifndef CPROX_CURVE_CURVE_H
#define CPROX_CURVE_CURVE_H

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

/* Eight capsules, one array a number: what lies three levels below a node of the tree is bounded in vector registers.
 */
enum { CURVE_PACK = 8 };
typedef struct curve_pack {
  double ax[CURVE_PACK], ay[CURVE_PACK], az[CURVE_PACK], bx[CURVE_PACK], by[CURVE_PACK], bz[CURVE_PACK];
  double radius[CURVE_PACK];
} curve_pack;

struct cprox_curve {
  cprox_curve_kind kind;
  cprox_dubins_path dubins; /* zeros for other kinds */
  size_t degree;
  size_t n_pieces;
  double *breaks; /* n_pieces + 1 parameters, ascending; piece i covers [breaks[i], breaks[i+1]] */
  vec3 *points;   /* n_pieces * (degree + 1) control points */
  double *error;  /* a piece's: each exact point of the curve is within this of the computed piece's (rounding of the
                     conversion; for compiled bases their remainder) */
  /* Heap order: node 1 is the root, node k has children 2k and 2k+1; the n_leaves leaves (a power of two >= n_pieces)
   * stand at n_leaves + i for piece i; a node without pieces has radius < 0. Node k is lane k % CURVE_PACK of pack
   * k / CURVE_PACK, of which there are curve_packs(); lanes that are no nodes have radius < 0. */
  curve_pack *packs;
  size_t n_leaves;
  curve_capsule whole;           /* node 1: it is asked for by every query, and often nothing else is */
  cprox_rectifiable_curve *arcs; /* NULL, or what a curve is known by that has no control points: then its pieces are
                                    chords of degree 1, their errors how far the curve is from them, and intervals are
                                    those of rectifiable.h */
  double worst;                  /* the largest of the pieces' errors */
  double largest;                /* at least |P| of every control point, */
  bool flat;                     /* all have the z of the first, exactly */
  double *tables;                /* numbers of the degree, curve_tables_size() of them, which curve_finish() fills: */
  const double *binomial; /* C(degree - 2, k), for evaluation by the last three de Casteljau points; none below 2, */
  const double *square;   /* and for control_distance_from(): C(degree, k), then 1 / C(2 degree, k) */
};

static inline const vec3 *curve_piece(const cprox_curve *c, size_t i) {
  return c->points + i * (c->degree + 1);
}

/* The last piece that begins at or before t, for t inside the domain; at its end the last one. */
size_t curve_piece_at(const cprox_curve *c, double t);

static inline curve_capsule curve_capsule_at(const cprox_curve *c, size_t node) {
  if (node == 1) return c->whole;
  const curve_pack *p = &c->packs[node / CURVE_PACK];
  const size_t l = node % CURVE_PACK;
  return (curve_capsule){{p->ax[l], p->ay[l], p->az[l]}, {p->bx[l], p->by[l], p->bz[l]}, p->radius[l]};
}

/* How many packs a tree of so many leaves takes: none where there is nothing below node 1. */
static inline size_t curve_packs(size_t n_leaves) {
  return n_leaves > 1 ? (2 * n_leaves + CURVE_PACK - 1) / CURVE_PACK : 0;
}

/* A curve with room for the pieces; breaks, points and error are the caller's to fill, then curve_finish(). NULL where
 * memory is out (cprox_curve_free() frees). */
cprox_curve *curve_allocate(size_t degree, size_t n_pieces);

size_t curve_tables_size(size_t degree);
void curve_fill_tables(size_t degree, double *tables);

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

/* The largest magnitude of a coordinate, a knot or a parameter. */
#define CURVE_LARGEST 1e150

/* Lengths below this may lose their squares to underflow; it is added where a length must not come out too small. */
#define CURVE_LEAST 1e-150

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
static inline double curve_error(const cprox_curve *c) {
  return c->arcs ? c->arcs->error : c->worst;
}

/* Whether it keeps within what queries can hold. */
static inline bool curve_is_in_reach(const cprox_curve *c) {
  const vec3 a = c->whole.a, b = c->whole.b;
  const double ends = fmax(fmax(fabs(a.x), fmax(fabs(a.y), fabs(a.z))), fmax(fabs(b.x), fmax(fabs(b.y), fabs(b.z))));
  return fmax(ends, c->whole.radius) <= LENGTH_MOST;
}

#endif
