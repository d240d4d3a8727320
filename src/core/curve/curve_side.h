/* SPDX-License-Identifier: BSD-3-Clause */
/* One curve as a search sees it: its control points brought into a frame, a piece or a range of pieces at a time, and
 * what they say of an interval. Oracles have one side or two. */
#ifndef CPROX_CURVE_CURVE_SIDE_H
#define CPROX_CURVE_CURVE_SIDE_H

#include "base/frame.h"
#include "base/workspace.h"
#include "curve/curve.h"
#include "curve/pack.h"

/* A sub-interval of a piece of a curve, or a range of pieces. */
typedef struct curve_interval {
  double a, b;   /* in [0, 1] */
  double error;  /* of the stored points */
  uint32_t part; /* which piece or range: a node of the curve's tree */
  int32_t slot;  /* where its points are stored, -1 for nowhere */
} curve_interval;

/* Sets of control points by slot, in the workspace; slots given back are used again. */
typedef struct points_pool {
  cprox_workspace *workspace;
  double *points; /* of slot 0 */
  size_t stride;  /* numbers a slot */
  size_t slots, free_slots;
  cprox_status failure; /* negative where a curve's own functions failed; the workspace has the reason */
} points_pool;

/* A pool whose first `reserved` slots are never given out: each side's root. False where memory is out. */
bool points_pool_begin(points_pool *pool, size_t degree, size_t reserved, cprox_workspace *workspace);
double *points_pool_at(const points_pool *pool, size_t slot);
void points_pool_release(points_pool *pool, int32_t slot);

/* A radius that changes along a side, and its derivatives by the piece's own parameter. Zeros where there is none. */
typedef struct curve_thickness {
  double value, slope, bend;
} curve_thickness;

typedef struct curve_side {
  const cprox_curve *curve;
  const cprox_curve *radius; /* NULL, or a curve with the same pieces: its x is the radius of what rides this one */
  frame frame;
  curve_interval part; /* what of the curve is asked about: all of it, or some of one piece */
  points_pool *pool;
  size_t root_slot;  /* reserved: the whole piece that was asked for last */
  size_t root_piece; /* SIZE_MAX: none yet */
  double root_error, root_magnitude;
  double turned_slope,
      turned_offset; /* bringing points of |local| <= m into the frame is off by at most slope m + offset */
  double range_error, range_magnitude; /* what curve_side_reach() says of ranges of pieces, all of them */
} curve_side;

void curve_side_begin(curve_side *side, const cprox_curve *curve, const frame *placed, points_pool *pool,
                      size_t root_slot);

/* Gives a side that has begun, and whose pool has, a radius: bounds and cuts then know it, and slots hold its numbers
 * behind the control points. False where memory is out. */
bool curve_side_thicken(curve_side *side, const cprox_curve *radius);

/* The radius at s of a piece, which becomes the loaded one. Its error is within curve_side_point_error(). */
curve_thickness curve_side_thickness_of(curve_side *side, size_t piece, double s);

static inline curve_thickness curve_side_thickness(curve_side *side, size_t piece, double s) {
  return side->radius ? curve_side_thickness_of(side, piece, s) : (curve_thickness){0};
}

/* The radii at an interval's control points: the Bernstein coefficients. The interval has points of its own. */
const double *curve_side_radii(const curve_side *side, const curve_interval *at);

/* No radius over an interval is larger than *most or less than *least; zeros where there is none. */
void curve_side_radius_range(const curve_side *side, const curve_interval *at, double *least, double *most);

/* The control point of an interval with points of its own that is lowest along n, the first of several. */
size_t curve_side_lowest(const curve_side *side, const curve_interval *at, vec3 n);

/* The status of a call below that returned false: CPROX_MEMORY with its reason, or what a curve's own functions did
 * wrong. And the latter alone, CPROX_OK where they did nothing wrong: to be asked where points were taken. */
cprox_status curve_side_failure(const curve_side *side);
cprox_status curve_side_status(const curve_side *side);

/* The interval that is the whole curve. */
curve_interval curve_side_whole(void);

/* Intervals are single pieces or their parts, or ranges of pieces: nodes of the curve's tree. */
bool curve_side_is_piece(const curve_side *side, const curve_interval *at);
size_t curve_side_piece(const curve_side *side, const curve_interval *at);

/* The point of a range's chord that is nearest to the frame's origin, but for rounding. */
vec3 curve_side_chord_from_origin(const curve_side *side, const curve_interval *range);

/* Which piece of a range may be nearest the frame's origin: the one that the nearer chords lead to; and s of it, by its
 * own chord. */
size_t curve_side_nearest_piece(const curve_side *side, const curve_interval *range, double *s);

/* Brings a piece's control points into the frame, in the root slot. */
void curve_side_load(curve_side *side, size_t piece);

/* The interval that is [a, b] of a piece, 0 <= a < b <= 1. */
curve_interval curve_side_section(const cprox_curve *curve, size_t piece, double a, double b);

/* Gives a piece's interval control points of its own: of a curve that is known by its arc length, its ends and their
 * ellipsoid (rectifiable.h), which bounds see and others need not. False where memory is out, or by
 * curve_side_failure(). */
bool curve_side_materialise(curve_side *side, curve_interval *at);

/* Gives an interval that shares its control points with another a copy of its own. False where memory is out. */
bool curve_side_copy(const curve_side *side, curve_interval *at);

/* What an interval reaches along a direction. */
typedef struct curve_reach {
  double least;     /* min n·x over the interval's hull; less the radius at each point, where there is one */
  double error;     /* how far the exact curve can be from the computed hull */
  double magnitude; /* of the points that entered, for the rounding of the products */
} curve_reach;

/* A range falls into 2, 4 or 8 ranges or pieces, fewer where there are no pieces: their number, where they are, and
 * their capsules. */
size_t curve_side_children(const curve_side *side, const curve_interval *range, curve_interval part[CURVE_PACK],
                           curve_pack *pack);

/* What each of them reaches: least[k] of part k, the rest of the answer being that of all. */
curve_reach curve_side_children_reach(const curve_side *side, const curve_pack *pack, vec3 n, double least[CURVE_PACK]);

/* How far each of them is from the frame's origin, likewise; the products lose 64 u of the magnitude. */
curve_reach curve_side_children_distance(const curve_side *side, const curve_pack *pack, double least[CURVE_PACK]);

/* n: unit within 4 u. A piece with points of its own must be the loaded one. */
curve_reach curve_side_reach(const curve_side *side, const curve_interval *at, vec3 n);

/* An interval lies in the hull of balls about points: how many (at most degree + 1), and their one radius. */
typedef struct curve_hull {
  size_t n;
  double radius;
  double error; /* as in curve_reach */
} curve_hull;

/* Fills points, relative to `from`; a radius that changes is not in it. A piece must have points of its own. */
curve_hull curve_side_hull(const curve_side *side, const curve_interval *at, vec3 from, double *x, double *y,
                           double *z);

/* Cuts a piece's interval of a curve that is known by its arc length at n places, ascending, into n + 1 parts, of which
 * the last one takes over its slot. False as by curve_side_cut_piece(). */
bool curve_side_cut_arcs(const curve_side *side, const curve_interval *piece, const double *cut, int n,
                         curve_interval *part);

/* The first point of a piece's interval with points of its own, or the last. */
vec3 curve_side_end(const curve_side *side, const curve_interval *at, bool last);

/* A lower bound of the distance from a centre, or an axis through it (NULL for none), over an interval with points of
 * its own, as control_distance_from() gives it, less the radius. */
double curve_side_distance_from(const curve_side *side, const curve_interval *at, vec3 centre, const vec3 *axis);

/* A point of the loaded piece, and how far a point computed so may be from the exact curve. */
vec3 curve_side_point(const curve_side *side, double s);
double curve_side_point_error(const curve_side *side);

/* The control point at which a range falls in two: its piece, parameter and error. Loads that piece. */
vec3 curve_side_junction(curve_side *side, const curve_interval *range, size_t *piece, double *s, double *error);

/* Cuts a range at its junction, or a piece at `cut` of its parameter range (s of the interval itself). False where
 * memory is out. A half without pieces has curve_side_is_empty(). */
void curve_side_cut_range(const curve_interval *range, curve_interval half[2]);
bool curve_side_cut_piece(curve_side *side, curve_interval *piece, double cut, double s, curve_interval half[2]);
bool curve_side_is_empty(const curve_side *side, const curve_interval *at);

/* The curve's parameter where an interval begins. */
double curve_side_start(const curve_side *side, const curve_interval *at);

/* The curve's parameter at s of a piece. */
double curve_side_parameter(const curve_side *side, size_t piece, double s);
/* The same, rounded down: for what is certified of all parameters before. */
double curve_side_parameter_below(const curve_side *side, size_t piece, double s);

#endif
