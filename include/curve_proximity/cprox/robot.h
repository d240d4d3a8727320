/* SPDX-License-Identifier: BSD-3-Clause */
/** Robots: kinematic trees with bodies on their links, and motions of all their joints at once.
 *
 *  A motion becomes a mover (cprox_robot_along, cprox_robot_self), and every query of query.h answers for it: t is the
 *  time of the motion [s], mover_part a geometry of the robot, obstacle_index an obstacle, or in a query about the
 *  robot itself the other geometry. Robots and motions are immutable once made, shared by any number of threads.
 *  Constructors copy what they are given, but keep bodies by reference; they return CPROX_INVALID with a message in the
 *  workspace, or CPROX_MEMORY, and leave the handle untouched on failure. */
#ifndef CURVE_PROXIMITY_CPROX_ROBOT_H
#define CURVE_PROXIMITY_CPROX_ROBOT_H

#include <curve_proximity/cprox/query.h>

#ifdef __cplusplus
extern "C" {
#endif

/** A kinematic tree with bodies on its links. */
typedef struct cprox_robot cprox_robot;

/** How a link moves on its parent, and how many variables that takes. */
typedef enum cprox_joint_type {
  /** 0 */
  CPROX_JOINT_FIXED,
  /** 1 [rad], about the axis; URDF's continuous joints too: angles as they are, never wrapped */
  CPROX_JOINT_REVOLUTE,
  /** 1 [m], along the axis */
  CPROX_JOINT_PRISMATIC,
  /** 3: x, y [m] in the plane z = 0 of the joint's frame, then theta [rad] about its z */
  CPROX_JOINT_PLANAR,
  /** 7: x, y, z [m] and the quaternion's x, y, z, w: of any norm, so that its components may be polynomials; a
   *  motion on which it comes near 0 is refused */
  CPROX_JOINT_FLOATING,
  /** 6: x, y, z [m] and a rotation vector [rad]: it points along the axis, its length is the angle. All six may be
   *  splines of any kind that motions have */
  CPROX_JOINT_ROTATION_VECTOR
} cprox_joint_type;

/** One link and the joint that it hangs on. Its frame is the joint's, moved. */
typedef struct cprox_link {
  /** which link, one before this one; -1: the world */
  int32_t parent;
  /** How the link moves on its parent. */
  cprox_joint_type type;
  /** of the joint's frame in the parent link's */
  cprox_pose origin;
  /** revolute and prismatic: in the joint's frame, not 0, of any length */
  cprox_vec3 axis;
  /** the first of the joint's variables; links may share one (mimic joints), but not one of a quaternion, and on a
   *  screw not one of its position: floating joints may share all seven only */
  int32_t variable;
  /** revolute and prismatic: the joint is at multiplier * variable + offset; at most 1e60 in size */
  double multiplier;
  /** The offset of the joint. */
  double offset;
} cprox_link;

/** A body on a link. */
typedef struct cprox_link_geometry {
  /** convex, a level-of-detail body, a mesh, solid or not, points, boxes, or a compound of these; no halfspace; kept by
   *  reference */
  const cprox_body *body;
  /** in the link's frame */
  cprox_pose pose;
  /** The index of the link. */
  int32_t link;
  /** [m] >= 0 */
  double margin;
} cprox_link_geometry;

/** A robot of n_links >= 1 links, parents first, and n_geometries bodies; its variables are numbered from 0 to
 *  n_variables - 1. */
CPROX_API cprox_status cprox_robot_create(const cprox_link *links, size_t n_links,
                                          const cprox_link_geometry *geometries, size_t n_geometries,
                                          size_t n_variables, cprox_workspace *workspace, cprox_robot **robot);

/** Joins n >= 1 robots into one, so that one motion (CPROX_MOTION_JOINED) moves them all on one clock.
 *
 *  bases      where the world of each robot is in that of the joined one; NULL: at the origin, all of them.
 *  robot      receives the handle. The given robots may be freed; their bodies are kept by reference.
 *
 *  Variables and geometries are those of the first robot, then those of the second one, and so on. Each robot's links
 *  follow one fixed link, which is its base. Returns CPROX_OK, CPROX_INVALID or CPROX_MEMORY. */
CPROX_API cprox_status cprox_robot_join(const cprox_robot *const *robots, const cprox_pose *bases, size_t n,
                                        cprox_workspace *workspace, cprox_robot **robot);

/** Frees a robot; NULL is allowed. No motion may be using it. */
CPROX_API void cprox_robot_free(cprox_robot *robot);

/** Where the origin of a link's frame is, and where its axes point: columns of a row-major matrix, for the given values
 *  of all variables. A plain evaluation: 1e-15 of the robot's size a joint. */
CPROX_API void cprox_robot_link_frame(const cprox_robot *robot, const double *variables, size_t link,
                                      cprox_vec3 *position, double rotation[9]);

/** All variables of a robot as functions of time. */
typedef struct cprox_motion cprox_motion;

/** Where some variables are at one time. */
typedef struct cprox_waypoint {
  /** [s] */
  double time;
  /** one a variable */
  const double *positions;
  /** a second; NULL: unknown */
  const double *velocities;
  /** Accelerations, or NULL. */
  const double *accelerations;
} cprox_waypoint;

/** How variables go from one waypoint to the next, as joint_trajectory_controller has it. */
typedef enum cprox_interpolation {
  /** by what both waypoints know: positions: linear; velocities too: cubic; accelerations too: quintic */
  CPROX_INTERPOLATION_BY_WAYPOINTS,
  CPROX_INTERPOLATION_LINEAR,
  CPROX_INTERPOLATION_CUBIC,
  CPROX_INTERPOLATION_QUINTIC
} cprox_interpolation;

/** How floating joints turn from one waypoint to the next. */
typedef enum cprox_turning {
  /** The four numbers of the quaternion are polynomials, like all other variables. */
  CPROX_TURNING_POLYNOMIAL,
  /** At a constant rate about one axis, the shorter way (slerp). x, y and z are polynomials. Velocities and
   *  accelerations of the quaternion's numbers are not read. */
  CPROX_TURNING_SLERP,
  /** With a constant twist: at a constant rate about one line and along it. Velocities and accelerations of the joint's
   *  variables are not read. */
  CPROX_TURNING_SCREW
} cprox_turning;

/** The kinds of motions. Each comment names the members of cprox_motion_description that the kind reads, besides
 *  variables, n_variables and rest. */
typedef enum cprox_motion_kind {
  /** The motion through waypoints: Hermite polynomials between them. Where a controller would start from the state that
   *  the robot is in, that state is the first waypoint.
   *
   *  waypoints, n_waypoints   2 or more, at ascending times.
   *  interpolation            how the variables go from one waypoint to the next.
   *  turning                  how floating joints do. But for CPROX_TURNING_POLYNOMIAL: quaternions have any norm but
   * 0; a joint whose quaternion (for screws: whose pose) is given in part is refused, and so are orientations that are
   * half a turn apart: which way they turn is not said. */
  CPROX_MOTION_WAYPOINTS,
  /** The motion along a B-spline in the space of the variables, from knots[degree] to knots[n_control].
   *
   *  control, n_control       n_control rows of n_variables values.
   *  degree                   1 … 9.
   *  knots, n_knots           [s] n_control + degree + 1 knots, non-decreasing, none more than degree times inside. */
  CPROX_MOTION_BSPLINE,

  /** One state of the robot, which does not move. Every query answers for it; t is any time in [0, 1]. Many states are
   *  asked by cprox_robot_ask_states().
   *
   *  rest                     the values of all variables; NULL: all 0. */
  CPROX_MOTION_STATE,

  /** The motions of several robots on one clock, for their joined robot (cprox_robot_join()). It lasts from the first
   *  start to the last end. A motion that has not begun stands at its first values, one that has ended at its last
   *  ones. A state stands all the time. Motions must overlap in time: a gap in which no motion is active is an error.
   *  variables, n_variables and rest are not read. There is no certificate.
   *
   *  joined, n_joined         one motion for each of the joined robots, in their order. */
  CPROX_MOTION_JOINED
} cprox_motion_kind;

/** One of several motions on one clock. */
typedef struct cprox_joined_motion {
  /** of a robot like the one that was joined; it is copied */
  const cprox_motion *motion;
  /** [s] start time: added to each time of the motion; the rounded sums define the problem */
  double start;
  /** [s] >= 0: the start is only known to within this, before or after. INFINITY: the motion may be anywhere on its
   *  path at any time, whatever the start. Queries answer for all starts that are possible: the least distance of all,
   *  and contact as early as it can be; t is the earliest time at which that can be. There is no gradient. */
  double tolerance;
} cprox_joined_motion;

/** What a motion is made of. Set all members to 0, then those that the kind reads: cprox_motion_kind lists them. All
 *  numbers are finite. Arrays are copied. */
typedef struct cprox_motion_description {
  /** which members are read */
  cprox_motion_kind kind;
  /** the variables of the robot that the motion gives; none twice */
  const int32_t *variables;
  /** their number */
  size_t n_variables;
  /** the values of all variables of the robot, for those that stand still; NULL: all 0 */
  const double *rest;
  /** waypoints, at ascending times */
  const cprox_waypoint *waypoints;
  /** the number of waypoints */
  size_t n_waypoints;
  /** between waypoints */
  cprox_interpolation interpolation;
  /** of floating joints, between waypoints */
  cprox_turning turning;
  /** control points of a B-spline, one row of n_variables values each */
  const double *control;
  /** the number of control points */
  size_t n_control;
  /** of a B-spline */
  size_t degree;
  /** [s] knots of a B-spline */
  const double *knots;
  /** the number of knots */
  size_t n_knots;
  /** the motions of several robots */
  const cprox_joined_motion *joined;
  /** the number of these */
  size_t n_joined;
} cprox_motion_description;

/** Makes a motion.
 *
 *  robot        kept by reference: it must outlive the motion.
 *  description  checked once; what is wrong, and where, stands in the error message of the workspace.
 *  workspace    may be NULL: then there is no error message.
 *  motion       receives the handle, owned by the caller: cprox_motion_free(). Untouched on failure.
 *
 *  Returns CPROX_OK, CPROX_INVALID or CPROX_MEMORY. */
CPROX_API cprox_status cprox_motion_create(const cprox_robot *robot, const cprox_motion_description *description,
                                           cprox_workspace *workspace, cprox_motion **motion);

/** Frees a motion; NULL is allowed. */
CPROX_API void cprox_motion_free(cprox_motion *motion);

/** What is known of a motion. */
typedef struct cprox_motion_info {
  /** the kind that the motion was created as */
  cprox_motion_kind kind;
  /** [s] the start */
  double t0;
  /** [s] the end */
  double t1;
  /** the number of variables of the robot, at rest or not */
  size_t n_variables;
  /** the number of polynomial pieces */
  size_t n_pieces;
} cprox_motion_info;

/** What is known of a motion. */
CPROX_API cprox_motion_info cprox_motion_get_info(const cprox_motion *motion);

/** What is known of one variable of the robot along a motion: all its values are in [lowest, highest], and come as near
 *  to both as 1e-9 of the largest coefficient of the motion. */
typedef struct cprox_variable_info {
  /** no value is below this */
  double lowest;
  /** no value is above this */
  double highest;
} cprox_variable_info;

/** What is known of one variable of the robot along a motion. */
CPROX_API cprox_variable_info cprox_motion_get_variable_info(const cprox_motion *motion, size_t variable);

/** What is known of two links along a motion. */
typedef struct cprox_link_info {
  /** the joints between the two links that can move */
  size_t n_joints;
  /** the joints between them that this motion moves; 0: the links stand still against each other */
  size_t n_moved;
} cprox_link_info;

/** What is known of two links along a motion, or of one link and the world: link_b = -1. */
CPROX_API cprox_link_info cprox_motion_get_link_info(const cprox_motion *motion, int32_t link_a, int32_t link_b);

/** The values of all the robot's variables at a time (clamped to the domain). A plain evaluation. */
CPROX_API void cprox_motion_evaluate(const cprox_motion *motion, double t, double *variables);

/** A pair that is asked about: a geometry of the robot, and the number of an obstacle or of another geometry. */
typedef struct cprox_robot_pair {
  /** A geometry of the robot. */
  int32_t geometry;
  /** An obstacle, or another geometry of the robot. */
  int32_t other;
} cprox_robot_pair;

/** The robot along a motion. Obstacles are bodies. Of solid meshes, on links and as obstacles, the inside counts: what
 *  is wholly inside is in contact. Of level-of-detail bodies, on links and as obstacles, the mesh is asked where the
 * hull cannot decide; result.lod says whether. pairs: those that are asked about, kept by reference, `other` being
 *  obstacles; NULL: all geometries against all obstacles, whether or not the motion moves them. Pairs whose sides it
 *  does not move against each other are measured once. */
CPROX_API cprox_mover cprox_robot_along(const cprox_motion *motion, const cprox_robot_pair *pairs, size_t n_pairs);

/** The robot along a motion against itself: its queries have no obstacles (cprox_obstacles_distance(NULL, mover, …)).
 *  pairs: those that are asked about, kept by reference, `other` being geometries; NULL: all on
 *  links with at least two joints between them that can move (cprox_motion_get_link_info()), whether or not this motion
 *  moves them. */
CPROX_API cprox_mover cprox_robot_self(const cprox_motion *motion, const cprox_robot_pair *pairs, size_t n_pairs);

/** The robot against obstacles and itself at once: one search begins with the nearest pair of both kinds. It answers
 *  distance, tolerance, collision and time of contact, with certificates and without `each`. obstacle_index is that
 *  of an obstacle, or the number of obstacles plus that of the other geometry.
 *
 *  along         the robot against obstacles, by cprox_robot_along()
 *  self_pairs    the pairs with itself, as those of cprox_robot_self(), kept by reference; NULL: all
 *  n_self_pairs  their number */
CPROX_API cprox_mover cprox_robot_whole(cprox_mover along, const cprox_robot_pair *self_pairs, size_t n_self_pairs);

struct cprox_obstacles;

/** What many states of a robot are asked. Set all members to 0, then those that are needed. */
typedef struct cprox_state_query {
  /** what stands, see obstacles.h; NULL: nothing */
  const struct cprox_obstacles *obstacles;
  /** pairs of geometries and obstacles; NULL: as for cprox_robot_along() */
  const cprox_robot_pair *pairs;
  /** their number */
  size_t n_pairs;
  /** pairs of geometries; NULL: as for cprox_robot_self() */
  const cprox_robot_pair *self_pairs;
  /** their number */
  size_t n_self_pairs;
  /** the robot is not held against itself */
  bool without_self;
  /** [m] >= 0: verdicts are about this distance; 0: collision */
  double delta;
  /** the distance is wanted, not the verdict; delta is ignored */
  bool distance;
  /** NULL: the default */
  const cprox_options *options;
} cprox_state_query;

/** Asks about many states of a robot: its verdict or its distance, against the obstacles and itself at once.
 *
 *  states     n rows of the values of all variables of the robot.
 *  workspace  not NULL. Nothing is allocated once it has grown, but for one state for all rows.
 *  results    receives n results, each the answer of a motion that stands still. A result about the robot itself has
 *             the part that obstacle_index names in the robot: then about_self[i] is true.
 *  about_self n of them, or NULL.
 *
 *  A verdict ends with the first contact, be it with an obstacle or with itself. A state that is proven clear without a
 *  measurement has no witness: upper is infinite, obstacle_index and mover_part are -1. Returns CPROX_OK, or the least
 *  favourable status of a result; CPROX_INVALID or CPROX_MEMORY end the call, and results before that state are
 *  valid. */
CPROX_API cprox_status cprox_robot_ask_states(const cprox_robot *robot, const cprox_state_query *asked,
                                              const double *states, size_t n, cprox_workspace *workspace,
                                              cprox_result *results, bool *about_self);

/** Where a geometry of a robot is over an interval of its motion. */
typedef struct cprox_swept_pose {
  /** the geometry */
  int32_t geometry;
  /** in the middle of the interval, world frame */
  cprox_pose pose;
  /** [m] over the interval no point of the geometry is farther from where the pose has it, rounding included */
  double displacement;
  /** [s] the interval */
  double t0;
  /** [s] its end */
  double t1;
} cprox_swept_pose;

/** Cuts a motion into intervals over each of which a geometry moves by at most so far from their middle: what its
 *  bodies at the poses, each grown by its displacement, cover contains all that it passes through.
 *
 *  motion        not a joined one
 *  displacement  [m] > 0
 *  workspace     not NULL
 *  room, poses   receives the first `room` intervals, in the order of time; may be 0 and NULL
 *  n             receives how many there are
 *
 *  Returns CPROX_OK; CPROX_PRECISION: no interval is short enough; CPROX_INVALID, also by cprox_workspace_set_stop();
 *  CPROX_MEMORY. The cost is that of a few forward kinematics an interval. Source: doc/swept-volume.md */
CPROX_API cprox_status cprox_motion_sweep(const cprox_motion *motion, int32_t geometry, double displacement,
                                          cprox_workspace *workspace, size_t room, cprox_swept_pose *poses, size_t *n);

/** All values of the variables of a robot, each from lowest to highest on its own. */
typedef struct cprox_joint_box {
  /** [rad or m] of each variable */
  const double *lowest;
  /** [rad or m] of each variable, not below lowest */
  const double *highest;
  /** that of the robot */
  size_t n_variables;
} cprox_joint_box;

/** Do two geometries of a robot touch for any values of its variables in a box? What an allowed collision matrix asks.
 *
 *  pairs      n_pairs >= 1 pairs of geometries: all of two links, say
 *  box        of joints between the two sides: revolute, prismatic and planar. Values of others do not matter
 *  options    epsilon, max_nodes, stop and max_lod apply; max_nodes is the budget of all
 *  workspace  not NULL
 *  result     verdict clear: in no state of the box do the geometries of any pair touch. violated: they do at *state,
 *             and cprox_robot_ask_states() proves it there. undecided: neither is proven. lower: no pair is ever
 *             nearer. upper: the distance at *state, the smallest one that was found. There are no witness points
 *  state      receives the values of all variables of the robot; those that do not matter are in the middle. Or NULL
 *
 *  Returns as cprox_distance(). The work grows with the number of joints between the links, and as the clearance falls.
 *  Source: doc/collision-matrix.md */
CPROX_API cprox_status cprox_robot_box_collision(const cprox_robot *robot, const cprox_robot_pair *pairs,
                                                 size_t n_pairs, const cprox_joint_box *box,
                                                 const cprox_options *options, cprox_workspace *workspace,
                                                 cprox_result *result, double *state);

#ifdef __cplusplus
}
#endif
#endif
