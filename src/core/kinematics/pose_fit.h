/* SPDX-License-Identifier: BSD-3-Clause */
/* The pose of a part over an interval of its motion as a polynomial matrix in Bernstein form, with a proven remainder:
 * a body that turns then has control poses as a curve has control points. doc/robot-poses.md, Control poses. */
#ifndef CPROX_KINEMATICS_POSE_FIT_H
#define CPROX_KINEMATICS_POSE_FIT_H

#include "base/workspace.h"
#include "kinematics/motion.h"

enum {
  POSE_FIT_LEAST = 4,
  POSE_FIT_MOST = 14,
  POSE_FIT_POINTS = POSE_FIT_MOST + 1,
  POSE_FIT_DEGREES = (POSE_FIT_MOST - POSE_FIT_LEAST) / 2 + 1
};

/* How a part moves that at most one axis turns, and no shift follows it. */
typedef struct pose_chain {
  const cprox_motion *motion;
  int32_t track;
  size_t n_shifts;
  int32_t shift[6]; /* axes, and their directions in the world */
  vec3 along[6];
  int32_t turn;                           /* the axis that turns, or -1 */
  placement base;                         /* of that axis, or of the part where there is none; without the shifts */
  placement tip;                          /* of the part in the axis's moved frame */
  double arm;                             /* |tip.p| */
  bool base_is_straight, tip_is_straight; /* they turn nothing */
} pose_chain;

/* False where the part moves in another way, or not at all. */
bool pose_chain_of(const cprox_motion *motion, size_t part, pose_chain *chain);

/* Where the part is at u of a segment of the motion. */
placement pose_chain_at(const pose_chain *chain, size_t segment, double u);

/* The polynomials through values at degree + 1 points of [0, 1] in Bernstein form. */
typedef struct pose_basis {
  size_t degree;
  double x[POSE_FIT_POINTS];                       /* the points, Chebyshev's */
  double values[POSE_FIT_POINTS][POSE_FIT_POINTS]; /* [i][j]: what value i counts for coefficient j */
  double growth;                                   /* values of size 1 give no larger coefficients, */
  double error;                                    /* which are computed within this */
} pose_basis;

/* That of an even degree, which the workspace keeps; NULL where memory is out. */
const pose_basis *pose_basis_of(size_t degree, cprox_workspace *workspace);

/* What polynomials of degree 4, 6, 8 … through the poses of an interval are off by. */
typedef struct pose_remainder {
  motion_interval own;            /* the interval, of the part's track */
  double turn[POSE_FIT_DEGREES];  /* they turn a part otherwise by so much, per unit of its size, */
  double place[POSE_FIT_DEGREES]; /* and shift it by so much */
} pose_remainder;

/* Over [a, b] of a segment of the motion. Returns the least degree that moves no point of a part by more than
 * `tolerance`, or 0: there is none. size: of a ball about the part's frame. */
size_t pose_remainder_find(const pose_chain *chain, size_t segment, double a, double b, double size, double tolerance,
                           pose_remainder *remainder);

/* Poses at the points of x in [0, 1], which goes from one end of the interval to the other. */
typedef struct pose_fit {
  size_t degree;
  placement at[POSE_FIT_POINTS];
  double turn_error, place_error; /* the remainder */
} pose_fit;

/* basis: of that degree or of a higher one. */
void pose_fit_make(const pose_chain *chain, const pose_remainder *remainder, const pose_basis *basis, pose_fit *fit);

/* A direction of the world as the part sees it, and the height of the part's frame along it: coefficients of
 * polynomials of x. */
typedef struct pose_rows {
  size_t degree;
  double height;                    /* the largest of the values that were given */
  double c[POSE_FIT_POINTS + 1][4]; /* x, y, z, height */
} pose_rows;

/* Of the whole fit; heights are above `origin`. */
void pose_fit_along(const pose_fit *fit, const pose_basis *basis, vec3 n, vec3 origin, pose_rows *rows);

/* The same polynomials over [from, to]. */
void pose_rows_cut(pose_rows *rows, double from, double to);

/* Adds those of another direction times a linear function that goes from `from` to `to`: one degree more. */
void pose_rows_add_turning(pose_rows *rows, const pose_rows *rates, double from, double to);

#endif
