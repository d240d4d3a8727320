/* SPDX-License-Identifier: BSD-3-Clause */
/* Loops over many points at once that run in vector registers, for batches and for the first look of a search. All of
 * them give the same results whatever the registers' width. */
#ifndef CPROX_CURVE_PACKETS_H
#define CPROX_CURVE_PACKETS_H

#include "curve/curve.h"

/* A piece is cut into CHORDS of equal parameter length, of which LANES at a time are worked on. */
enum { LANES = 8, CHORDS = 16 };

/* Parts are bounded in clusters of so many. */
enum { CLUSTER = 4 };

/* Balls, one array a number, `padded` of each: n up to a multiple of CLUSTER. */
typedef struct packet_balls {
  size_t n, padded;
  double *x, *y, *z;
  double *reach; /* radius and margin */
  double *sizes; /* the sum of the lengths that entered, for rounding */
} packet_balls;

/* lower[k]: the distance of the capsule, grown by `radius`, from ball k, rounding included; negative where they
 * overlap. */
void packet_ball_bounds(const packet_balls *balls, const curve_capsule *capsule, double radius, double *lower);

/* basis[j * CHORDS + k]: Bernstein polynomial j of the degree at k/CHORDS. Kept in the workspace until another degree
 * is asked for; NULL where memory is out. */
const double *packet_basis(size_t degree, cprox_workspace *workspace);

/* The same within chord `chord`: at (chord + k/CHORDS) / CHORDS. Valid until another degree is asked for. */
const double *packet_fine_basis(size_t degree, size_t chord, cprox_workspace *workspace);

/* Where on a piece (control points one array a coordinate) it comes nearest to the origin, as far as CHORDS + 1 points
 * tell: s. `binomial`: curve_binomial(). */
double packet_nearest_sample(const double *binomial, const double *x, const double *y, const double *z, size_t degree);

/* The tables of two degrees at once. False where memory is out. */
bool packet_bases(const size_t degree[2], cprox_workspace *workspace, const double *basis[2]);

/* Where two pieces come nearest to each other, as far as CHORDS + 1 points of each tell: s of both. */
typedef struct packet_piece {
  const double *basis;
  const double *points; /* control points, one array a coordinate */
  size_t degree;
} packet_piece;
void packet_first_pair(const packet_piece *first, const packet_piece *second, double s[2]);

/* The chords of a Bézier piece: chord k begins at the point of s = k/CHORDS, and how it goes on to the next. */
typedef struct packet_chords {
  double x[CHORDS + 1], y[CHORDS + 1], z[CHORDS + 1]; /* the last is the end of the piece */
  double dx[CHORDS], dy[CHORDS], dz[CHORDS];
  double per_length2[CHORDS]; /* 1/|d|², 0 where that would overflow */
} packet_chords;

/* The points where LANES of the chords begin, from the first on, and the end of the piece. Where the piece is flat z is
 * that of its control points, exactly. The least square distance of these LANES from a point; first + *nearest is the
 * first that has it. */
double packet_points(const double *basis, const vec3 *points, size_t degree, bool flat, uint32_t first, vec3 from,
                     packet_chords *chords, uint32_t *nearest);

/* The same of points that are there. */
double packet_nearest_point(const packet_chords *chords, uint32_t first, vec3 from, uint32_t *nearest);

/* How each point goes on to the next. */
void packet_join(packet_chords *chords);

/* The square distance of a point from the chords, and where it is attained: the first chord that has it, and s in [0,
 * 1] of it. */
double packet_closest(const packet_chords *chords, vec3 point, size_t *chord, double *s);

/* The boxes round intervals of the chords. */
enum { PACKET_INTERVALS = 4, INTERVAL = CHORDS / PACKET_INTERVALS };
typedef struct packet_box {
  vec3 low, high;
} packet_box;
void packet_boxes(const packet_chords *chords, packet_box boxes[PACKET_INTERVALS]);

/* Raises lower[k] to the distance of ball k, grown by `radius`, from the nearest of n boxes, where that is more; the
 * points in the boxes are known to `slack`, the rest of the rounding is included. */
void packet_box_bounds(const packet_balls *balls, const packet_box *boxes, size_t n, double radius, double slack,
                       double *lower);

/* A box that stands anywhere: the points x with |r^T (x - position) - centre| <= half, each coordinate by itself; r is
 * row-major. */
typedef struct packet_obb {
  double r[9];
  vec3 position, centre, half;
} packet_obb;

/* What a obb is to each chord, but for rounding: */
typedef struct packet_sample {
  double lower[CHORDS];  /* the chord is at least so far away, */
  double square[CHORDS]; /* and the square distance of one point of it */
  double s[CHORDS];      /* is this: that of s in [0, 1] */
} packet_sample;
/* The least of CHORDS numbers, and the first that is it. */
double packet_least(const double *values, uint32_t *which);

void packet_see_obb(const packet_chords *chords, const packet_obb *obb, packet_sample *sample);

/* Boxes round the balls of clusters, one array a number, padded likewise. */
typedef struct packet_clusters {
  size_t n, padded;
  double *low[3], *high[3];
  double *sizes; /* the largest of the balls' */
} packet_clusters;

/* lower[b]: the distance of cluster b from the nearest of n boxes, likewise. */
void packet_cluster_bounds(const packet_clusters *clusters, const packet_box *boxes, size_t n, double radius,
                           double slack, double *lower);

/* max|P_(i+2) - 2 P_(i+1) + P_i|² over the control points. */
double packet_bend2(const vec3 *points, size_t degree);

#endif
