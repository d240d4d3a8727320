/* SPDX-License-Identifier: BSD-3-Clause */
/* Joint splines: one Bézier polynomial a segment and variable that moves, and what an interval of them says of every
 * axis. */
#ifndef CPROX_KINEMATICS_MOTION_H
#define CPROX_KINEMATICS_MOTION_H

#include "base/bernstein.h"
#include "kinematics/arcs.h"
#include "kinematics/given.h"
#include "kinematics/joint_tree.h"
#include "kinematics/spans.h"
#include "kinematics/sweeps.h"

/* Variables are worked on so many at a time; rows are padded to whole lanes. */
enum { MOTION_MAX_DEGREE = BERNSTEIN_MOST, MOTION_LANES = 8 };

/* Variables that share their segments: all of a motion that was given at once. A joined motion has a track for each
 * motion that was joined, and its own segments end wherever a track has a segment's end. */
typedef struct motion_track {
  size_t n_segments, n_moving;
  size_t stride;        /* room for the coefficients of one polynomial */
  size_t first_slot;    /* in rows; a multiple of MOTION_LANES */
  double *times;        /* n_segments + 1, ascending */
  uint8_t *degree;      /* of a segment */
  double *coefficients; /* [segment][moving variable][stride] */
  double *error;     /* [segment][moving variable]: of what is computed from the coefficients anywhere, 1e-15 of them */
  int32_t *moving;   /* the variables that do not stand still */
  size_t n_arcs;     /* floating joints that turn by slerp or by screws, */
  int32_t *arc_axes; /* their balls */
  motion_arc *arcs;  /* [joint][segment] */
  motion_spans spans;
  int32_t clock;    /* of a joined motion: whose track it is, */
  double tolerance; /* [s] and by how much that may start earlier or later */
  bool by_time;     /* spans of it are followed by time, as those of other tracks are, and not by their chord */
  bool stands_first, stands_last; /* it stands on its first segment, or on its last, because others move then */
} motion_track;

struct cprox_motion {
  const cprox_robot *robot;
  cprox_motion_kind kind;
  size_t n_segments, n_tracks;
  double *times; /* n_segments + 1, ascending; of one track its own */
  motion_track *tracks;
  int32_t *track_of; /* of a variable, its track */
  int32_t *slot;     /* of a variable in rows, or -1: it stands still */
  size_t row_size;   /* the numbers in one row; there are MOTION_ROWS */
  double *rest;      /* the values of those; of a state, room for another one behind them */
  bool is_state;     /* nothing moves, and everything is asked about that could */
  bool *axis_moves;
  int32_t *carrier; /* of axis i at i + 1: the last axis above it, or itself, that the motion moves; -1: none does. What
                       has the same one stands still against each other */
  placement *still; /* of an axis that does not: as it stands in its parent's frame */
  double *norm;     /* of a quaternion: at least this everywhere */
  int32_t *arc_of;  /* of an axis, which of its track's joints by arcs; -1: none. NULL: there are none at all */
  double *sagitta;  /* of an axis: how far the joint is from the polynomials, which are straight lines for it */
  motion_given given;    /* of a joined one nothing, but */
  motion_given *joined;  /* what each of its motions was made of (motion_keep_points()); NULL: it is none */
  motion_given *sources; /* the same, whole; none of those that stand. NULL: certificates do not know them */
  size_t n_joined;
  double *part_error; /* every point of a part is computed within this of where it is */
  part_sweep *sweeps; /* of each part, where there are several tracks; else NULL */
};

/* What a node, an interval [a, b] of a segment, says of one axis. Derivatives are by the node's own u in [0, 1]; all
 * bounds hold for the exact motion, rounding included. `velocity` and `acceleration` are those at the middle, in world
 * axes: angular for revolute axes and balls, linear for prismatic ones. */
typedef struct axis_state {
  axis_kind kind;
  placement frame; /* moved, at the middle */
  vec3 z;          /* unit, world; not of a ball */
  vec3 velocity, acceleration;
  double w, a, g;   /* bounds on the first, second and third derivative */
  double shift;     /* on the way from the middle to anywhere in the node */
  double line;      /* over spans: the same of the straight line that w, velocity and acceleration belong to; */
  double stray;     /* no value is farther from one on that line. Over one segment: shift and 0 */
  double variation; /* the length of the whole way */
  double error;     /* of half the computed velocity and an eighth of the acceleration together */
} axis_state;

/* What the variables do over the interval, all at once: rows of numbers, one for each variable that moves. */
typedef enum motion_row {
  MOTION_VALUE, /* in the middle, with two derivatives */
  MOTION_FIRST,
  MOTION_SECOND,
  MOTION_W, /* bounds, as those of an axis */
  MOTION_A,
  MOTION_G,
  MOTION_SHIFT,
  MOTION_VARIATION,
  MOTION_LINE,
  MOTION_STRAY,
  MOTION_FROM, /* of a span: its ends, its range, how far it is beside its chord; room for two segments */
  MOTION_TO,
  MOTION_LOW,
  MOTION_HIGH,
  MOTION_BELOW,
  MOTION_ABOVE,
  MOTION_CUT,
  MOTION_ROWS = MOTION_CUT + 2 * (MOTION_MAX_DEGREE + 1)
} motion_row;

/* Whether certificates can be about it. */
bool motion_is_described(const cprox_motion *motion);

/* A place or an interval of the motion, in the segments of a track. */
size_t motion_track_place(const cprox_motion *motion, const motion_track *track, size_t segment, double *u);
motion_interval motion_track_interval(const cprox_motion *motion, const motion_track *track,
                                      const motion_interval *over);

/* That of an axis. */
static inline const motion_track *motion_track_of(const cprox_motion *m, size_t axis) {
  return &m->tracks[m->track_of[m->robot->axes[axis].variable]];
}

/* That of a joint that turns by arcs, by its ball, over a segment of its track. */
static inline const motion_arc *motion_arc_at(const cprox_motion *m, size_t axis, size_t segment) {
  const motion_track *track = motion_track_of(m, axis);
  return &track->arcs[(size_t)m->arc_of[axis] * track->n_segments + segment];
}

/* The values of such a joint at u of that segment: its own seven; x, y and z only of a screw. */
void motion_arc_values(const cprox_motion *motion, size_t axis, size_t segment, double u, double values[7]);

/* The value of a variable at u of a segment of its track. */
double motion_value(const cprox_motion *motion, int32_t variable, size_t own, double u);

/* Bounds on all derivatives of an axis's variables (of a ball, of their vector) over an interval of its track, by the
 * interval's own parameter: rates[1] … rates[n]. Returns n, their degree. */
size_t motion_derivative_bounds(const cprox_motion *motion, int32_t axis, const motion_interval *own, double *rates);

/* The part of the rows that belongs to a track; `own` is its interval of `over`. A span of one track has its centre
 * where the track passes the middle of its chord, and *centre becomes that; of several it is given, by motion_middle().
 * What the span looks like is added to it. */
void motion_fill_track(const cprox_motion *motion, size_t track, const motion_interval *over,
                       const motion_interval *own, span_centre *centre, double *rows);

/* The middle of an interval by time. */
span_centre motion_middle(const cprox_motion *motion, const motion_interval *over);

/* The state of one axis by them, over its track's own interval; that of its parent must be known. Of an axis that does
 * not move, only the frame. */
void motion_find_axis(const cprox_motion *motion, const motion_interval *own, const double *rows, size_t axis,
                      axis_state *axes);

/* The frame of one axis at u of a segment of its track; that of its parent must be known. All else in its state is 0.
 */
void motion_place_axis(const cprox_motion *motion, size_t own, double u, size_t axis, axis_state *axes);

/* Changes a motion of the kind CPROX_MOTION_STATE, which no query may be using, to these values of all variables.
 * Allocates nothing; untouched on failure. */
cprox_status motion_set_state(cprox_motion *motion, const double *values, cprox_workspace *workspace);

/* True if at least two joints between the links can move: neighbours in the chain overlap by design. */
bool motion_relates_links(const cprox_motion *motion, int32_t link_a, int32_t link_b);

/* The segment that holds a time: the last one that begins at it or before it. */
size_t motion_segment_at(const cprox_motion *motion, double t);

/* Contains [t0, t1]. */
motion_interval motion_interval_of(const cprox_motion *motion, double t0, double t1);

/* The states of all axes over the interval. */
span_centre motion_span_node(const cprox_motion *motion, const motion_interval *over, double *rows, axis_state *axes);
void motion_node(const cprox_motion *motion, size_t segment, double a, double b, double *rows, axis_state *axes);

/* The moved frames of all axes at u of a segment; `values` has room for all variables. */
void motion_place(const cprox_motion *motion, size_t segment, double u, double *values, placement *frames);

/* The time at u of a segment, within the segment. */
double motion_time(const cprox_motion *motion, size_t segment, double u);
/* The same, rounded down: for what is certified of all times before. */
double motion_time_below(const cprox_motion *motion, size_t segment, double u);

#endif
