/* SPDX-License-Identifier: BSD-3-Clause */
/* Intersections of planes b·x + c <= 0, convex quadrics x'Qx + b·x + c <= 0 and hyperquadrics sum |a_i·x + d_i|^p_i <=
 * 1 (a superquadric is one of three terms), p_i >= 1: bounded, with an interior. Coordinates are about an interior
 * point, the centre, so that sizes and not positions enter the rounding. Theory: doc/implicit.md. */
#ifndef CPROX_IMPLICIT_IMPLICIT_H
#define CPROX_IMPLICIT_IMPLICIT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/rounding.h"
#include "base/vec.h"

typedef struct implicit_plane {
  vec3 b;
  double c;
} implicit_plane;

typedef struct implicit_quadric {
  double q[6]; /* xx, xy, xz, yy, yz, zz of the symmetric matrix */
  vec3 b;
  double c;
} implicit_quadric;

/* |a·x + d|^p */
typedef struct implicit_term {
  vec3 a;
  double d, p;
  double root;  /* 1/p */
  double slope; /* 1/(p - 1), infinite for p = 1 */
  int whole;    /* p where it is a small whole number, else 0 */
} implicit_term;

/* A hyperquadric: `n` terms from `first` on. */
typedef struct implicit_power {
  int32_t first, n;
  bool spans; /* its rows span the space: gram holds (A'A)^-1 (xx, xy, xz, yy, yz, zz) */
  double gram[6];
} implicit_power;

typedef struct implicit {
  int32_t n_planes, n_quadrics, n_powers, n_terms;
  implicit_plane *plane;
  implicit_quadric *quadric;
  implicit_power *power;
  implicit_term *term;
  double radius;     /* every point is within it of the origin */
  vec3 box;          /* half extents of a box about the origin that holds the body */
  double inner;      /* a ball of it about the origin is inside */
  double give;       /* a point whose computed constraints are all <= 0 is within it of a point of the body */
  bool closed;       /* one hyperquadric of three independent terms: its support function has a closed form */
  bool orthogonal;   /* closed, and its rows are orthogonal to each other */
  double inverse[9]; /* closed: the inverse of its rows' matrix, row-major */
} implicit;

/* No more constraints and terms together, so that a query's memory fits on a stack. */
enum { IMPLICIT_MOST_ROWS = 1024, IMPLICIT_MOST_TERMS = 64 };

static inline int32_t implicit_count(const implicit *body) {
  return body->n_planes + body->n_quadrics + body->n_powers;
}

/* ---- making one (build.c, centre.c) ---- */

/* x = linear x' + shift, row-major; NULL stands for the map that changes nothing. */
typedef struct implicit_map {
  double linear[9];
  vec3 shift;
} implicit_map;

/* Empty arrays for so many constraints, all in the one block of the handle: free() frees it. NULL where memory is out.
 */
implicit *implicit_allocate(size_t planes, size_t quadrics, size_t powers, size_t terms);

/* The coefficients as the caller gave them: each is finite, of a convex set, in range, and named in the reason if not.
 */
cprox_status implicit_check(const implicit *given, const implicit_map *map, cprox_workspace *workspace);

/* Applies the map and finds the centre, about which *made is written, for free(). The
 * coefficients have passed implicit_check(). CPROX_INVALID: unbounded, or without an interior. */
cprox_status implicit_build(const implicit *given, const implicit_map *map, cprox_workspace *workspace, vec3 *centre,
                            implicit **made);

/* The image of a built body under linear map, about the image of its centre: *made for free(). */
cprox_status implicit_deform(const implicit *body, const double linear[9], cprox_workspace *workspace, implicit **made);

/* from about c, or mapped: coefficients in twice the precision, rounded once. Arrays of `to` have the sizes of
 * `from`'s. */
void implicit_recentre(const implicit *from, vec3 c, implicit *to);

/* A point strictly inside and a bound on the body's reach from it; false where there is none. */
bool implicit_find_interior(const implicit *body, vec3 *point, double *reach);

/* Whether the body is one hyperquadric of three independent terms, and then the inverse of its rows' matrix. */
bool implicit_is_closed(const implicit *body, double inverse[9]);

/* A ball about the centre holds it: the least that is known of one with orthogonal rows, infinite for others. */
double implicit_closed_radius(const implicit *body);

/* Sets what queries need besides the coefficients (about the centre): inner, give, spans and closed; box and radius are
 * set already. False where the centre is not inside by more than rounding. */
bool implicit_measure(implicit *body);

/* ---- constraints (constraint.c) ---- */

static inline double implicit_row(const implicit_term *term, vec3 x) {
  return vec_dot(term->a, x) + term->d;
}

/* |u|^p for u >= 0 */
double implicit_raise(const implicit_term *term, double u);

/* The greatest of all constraints at x: < 0 inside, where the body's numbers are exact but for rounding. */
double implicit_value(const implicit *body, vec3 x);

/* Value, gradient and second derivative (xx, xy, xz, yy, yz, zz; NULL if not needed) of quadric k. */
double implicit_quadric_at(const implicit_quadric *quadric, vec3 x, vec3 *gradient);

/* The least g such that x lies in the body scaled by g about its centre, from above, to a relative `tolerance`: for x
 * inside. */
double implicit_gauge(const implicit *body, vec3 x, double tolerance);

/* ---- support (power.c, support_height.c, solve.c) ---- */

/* A point u >= 0 with sum u^p = 1 + miss and sum p u^p = slope may be drawn to the surface by the one factor 1 -
 * miss/slope: the sum is convex in the logarithm of the factor, with a second derivative of at most the largest p times
 * the slope, so that what is left outside is half of p (miss/slope)², and so at most u/2 of the length. */
static inline bool implicit_is_drawn(double miss, double slope, double steepest) {
  const double by = miss / slope;
  return steepest * by * by <= ROUND_U;
}

/* max of sum w_i u_i over sum |u_i|^p_i <= 1, for w_i >= 0: an upper bound whatever `mu` > 0 it starts from (<= 0: from
 * scratch), within 8 u of itself of the maximum once Newton's method has ended; u receives the maximiser, *mu where it
 * ended. */
double implicit_power_reach(const implicit_term *term, int32_t n, const double *w, double *mu, int steps, double *u);

/* The support function of a closed body: h(n) for any n, its maximiser (at NULL if not needed) and, hessian NULL if not
 * needed, the maximiser's derivative by n. mu: where Newton's method may start, <= 0 from scratch; left for the next
 * call.
 */
double implicit_closed_support(const implicit *body, vec3 n, double *mu, vec3 *at, double hessian[6]);

/* An upper bound of the support function along n from one tangent of the only quadric, whatever x and the multiplier
 * are. */
double implicit_quadric_height(const implicit *body, vec3 n, vec3 x, double multiplier);

/* The support function of a body of one quadric along the unit vector n (ellipsoid.c): from above, and an extreme point
 * that is inside as computed. False where the body is none or rounding forbids it. */
bool implicit_ellipsoid_support(const implicit *body, vec3 n, vec3 *at, double *upper);

/* ---- the interior point method (solve.c) ---- */

/* Where a search ended, for the next one that is much like it. Zero-initialised: from scratch. */
typedef struct implicit_warm {
  bool usable;
  vec3 x, y;
  vec3 apart; /* x - y in a's frame */
} implicit_warm;

/* Multipliers that prove an upper bound of the support function (doc/implicit.md): row holds one of each plane, quadric
 * and power, then one of each term; quadrics are touched at x. The direction is what the multipliers make. */
typedef struct implicit_dual {
  vec3 x;
  double *row;
} implicit_dual;

/* What is asked: the point x of a nearest to the point y0 (b NULL), or x of a and y of b with x - (M y + t) shortest,
 * or with b moving by `velocity` for a time in [0, duration]; or, `b` NULL and `far`, the x extreme along the unit
 * vector t. */
typedef struct implicit_query {
  const implicit *a, *b;
  bool far, moving;
  double m[9]; /* a rotation, row-major */
  vec3 t;
  vec3 velocity;
  double duration;
  implicit_dual *dual; /* far: receives the multipliers of the best bound; or NULL */
} implicit_query;

/* The interval asked for: epsilon or relative_epsilon times upper wide. */
typedef struct implicit_goal {
  double epsilon, relative_epsilon;
  uint32_t max_steps;
  bool coarse; /* far: no accuracy near rounding is needed, and the body may be unbounded */
} implicit_goal;

typedef struct implicit_answer {
  bool certified; /* the interval is as narrow as asked */
  bool overlap;   /* x is proven to lie inside both */
  double lower, upper;
  vec3 x, y;         /* in a's and in b's frame, strictly inside but for rounding */
  double time;       /* of a moving b */
  vec3 normal;       /* a's frame, unit, from b to a: lower is what separates them along it */
  double height;     /* h_a(-normal) from above: from the same multipliers as lower */
  double hessian[6]; /* a point: the distance's second derivative by it */
  uint32_t steps;    /* Newton steps, over all attempts */
  int attempt;       /* which level of detail of the level-of-detail body of settings answered, 0 the first */
} implicit_answer;

/* Multipliers of a bound along the direction n, or nearly so; `memory` of implicit_memory(body, NULL). False: none were
 * found. */
bool implicit_dual_along(const implicit *body, vec3 n, void *memory, implicit_dual *dual);

/* The nearest point of an orthogonal body to a point outside, in a fraction of the time; false where it could not be
 * found to within the width: then implicit_solve() does. The bounds are without give and rounding. */
bool implicit_closed_nearest(const implicit *body, vec3 y, double width, implicit_answer *answer);

/* Two closed bodies that stand apart, by their support functions, from `warm` on; false where that stalls or there is
 * no gap to be seen: then implicit_solve() answers, from `warm` as it then is. What it found is true all the same,
 * rounding included. */
bool implicit_separate(const implicit_query *query, const implicit_goal *goal, implicit_warm *warm,
                       implicit_answer *answer);

/* Two closed bodies, b moving: each plane between them says how much later they meet, so b goes on at each step of the
 * search above. From answer->time on, where they are further apart than `lost`; so they are until the answer's time,
 * and then, where true, no further than epsilon more. False where that stalls, with `warm` for implicit_solve() there,
 * or where they do not meet. */
bool implicit_approach(const implicit_query *query, double epsilon, double lost, implicit_warm *warm,
                       implicit_answer *answer);

/* Two unit vectors across the unit vector n. */
void implicit_across(vec3 n, vec3 *e, vec3 *f);

/* The bytes that implicit_solve() needs; b may be NULL. */
size_t implicit_memory(const implicit *a, const implicit *b);

/* Solves; warm NULL: from scratch. The answer is true whatever happens: only `certified` says whether it is narrow. */
void implicit_solve(const implicit_query *query, const implicit_goal *goal, implicit_warm *warm, void *memory,
                    implicit_answer *answer);

#endif
