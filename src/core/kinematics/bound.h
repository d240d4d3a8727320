/* SPDX-License-Identifier: BSD-3-Clause */
/* Lower bounds on the distance of a part of a robot over an interval of its motion; doc/robot-motion-bounds.md proves
 * them. */
#ifndef CPROX_KINEMATICS_BOUND_H
#define CPROX_KINEMATICS_BOUND_H

#include "kinematics/motion.h"

/* One axis of a chain; sign -1 where it is passed from its tip to its base. */
typedef struct chain_axis {
  int32_t axis;
  double sign;
} chain_axis;

/* The axes that move on the way from what `from` carries (-1: the world) to what `to` carries, in that order. Room for
 * all axes. */
size_t motion_chain(const cprox_motion *motion, int32_t from, int32_t to, chain_axis *chain);

/* How a part moves over a node, seen from where its chain begins; directions are those of the world in the middle of
 * the node. */
typedef struct chain_motion {
  vec3 v, omega, a, alpha; /* velocity of the part's centre, angular velocity, their derivatives, in the middle */
  double displacement;     /* no point of the part comes farther than this from where it is in the middle */
  double rate;             /* bounds on the first, second and third derivative of any point's position */
  double second, third;
  double stray; /* over spans all but `displacement` is of a straight line of the variables; points are within this of
                   those on it */
  double error; /* of what is computed with v, omega, a and alpha over the node */
  vec3 v_standing, omega_standing; /* by motion_find_standing_rates(): the part of v and omega that is the standing
                                      side's own */
} chain_motion;

/* The two sides of a pair at two times, each from -1/2 to 1/2 of its interval; what is possible of both together is in
 * a polygon. */
typedef struct two_times {
  double corner[6][2];
  size_t n;
  int standing; /* which of the two times is that of the standing side */
} two_times;

/* centre: of a ball that contains the part, in the middle of the node, world; radius: with the error of the part's
 * place. scratch: a number for each axis of the chain. */
void motion_of_part(const axis_state *axes, const chain_axis *chain, size_t n, vec3 centre, double radius,
                    double *scratch, chain_motion *m);

/* What the standing side's own axes add to v and omega. */
void motion_find_standing_rates(const axis_state *axes, const chain_axis *chain, size_t n, vec3 centre,
                                chain_motion *m);

/* The displacement bound alone, by the chain of motion_chain(). */
double motion_displacement(const cprox_motion *motion, const axis_state *axes, int32_t from, int32_t to, vec3 centre,
                           double radius);

/* How far a part on the axis moves as each axis above it sees it, and the world: displacements[k] of the k-th from the
 * world, which is 0, up to `depth`, its own. Returns the first; displacements may be NULL. */
double motion_displacements(const cprox_motion *motion, const axis_state *axes, int32_t axis, size_t depth, vec3 centre,
                            double radius, double *displacements);

/* What is added to the displacement bound of something on `axis` on the way up to an axis above it, which sees it so:
 * begins with displacements[depth of `axis`] and fills those of all depths down to that of `from`. */
void motion_displacements_up(const cprox_motion *motion, const axis_state *axes, int32_t axis, int32_t from,
                             vec3 centre, double radius, double *displacements);

/* The two sides of a pair in the middle of the node. */
typedef struct bound_side {
  const convex *shape;
  placement at;      /* of the shape's frame, world */
  double margin;     /* of the shape, and margin: a ball about each point of the core, which does not turn */
  double error;      /* every point is within this of where it is exactly */
  bool margin_turns; /* bounds are to hold as if the margin turned with the core: the certificate checker has no cores
                      */
  /* of a box, axes those of the shape, that contains the core; half is infinite for halfspaces, 0 where no box is known
   */
  vec3 middle, half;
  /* along the plane's normal the core may be lower than it is: each vertex by so much, in the order of the shape's;
   * NULL: all of it by the largest of that, */
  const double *losses;
  double loss; /* which is this */
} bound_side;

/* Takes off the ends of a chain the axes that turn the side beside them about its own axis of symmetry, or so nearly
 * that planes would tell less: the first ones turn the standing side, the last ones the moving one. NULL: the side has
 * none. Neither side is ever farther than what is returned from where it would be without a turn of these axes. */
double motion_leave_out_round(const axis_state *axes, chain_axis *chain, size_t *n, const bound_side *moving,
                              const bound_side *standing, uint32_t steps);

/* The support of a side along n, seen from its own origin, its margin included. */
double bound_height(const bound_side *side, vec3 n);

/* The least d·x over the moving side's core, seen from its own origin, less what it may be lower. */
double bound_lowest(const bound_side *side, vec3 d);

/* The best of the bounds of second and third order by a plane that turns: at tau in [-1/2, 1/2] of the node its normal
 * is n + tau normal_rate, from the standing side to the moving one. n is unit within 4 u, normal_rate is orthogonal to
 * it within 8 u |normal_rate|. heights are those of the standing side along n - normal_rate/2 and n + normal_rate/2.
 * `goal`: what would be enough. steps: transforms in the chain. */
double motion_plane_bound(const chain_motion *m, const bound_side *moving, const bound_side *standing, vec3 n,
                          vec3 normal_rate, const double heights[2], uint32_t steps, double goal, double *slack);

/* The same of second order where the two sides are at two times, by a plane that does not turn; `height` is that of the
 * standing side along n. The chain goes by the world. */
double motion_plane_bound_of_two(const chain_motion *m, const two_times *times, const bound_side *moving,
                                 const bound_side *standing, vec3 n, double height, uint32_t steps, double *slack);

/* The least factor by which both sides, each scaled about its own origin, touch at any time of the node is at least
 * this: by the plane with the normal n, unit within 4 u, from the standing side to the moving one. */
double motion_growth_bound(const chain_motion *m, const bound_side *moving, const bound_side *standing, vec3 n,
                           uint32_t steps);

#endif
