/* SPDX-License-Identifier: BSD-3-Clause */
/** Answers for every execution of a robot's motion within bounds of its errors: cprox/robust.h by names of joints. */
#ifndef CURVE_PROXIMITY_ROBUST_HPP
#define CURVE_PROXIMITY_ROBUST_HPP

#include <map>
#include <string>
#include <vector>

#include <curve_proximity/motion.hpp>

namespace curve_proximity {

/** A joint is off by at most tracking + speed |q'| + acceleration |q''|. */
struct JointErrors {
  double tracking = 0.0;     /**< [rad, or m of prismatic joints] */
  double speed = 0.0;        /**< [s] */
  double acceleration = 0.0; /**< [s²] */
};

/** Bounds of all errors of an execution, none below 0; as in cprox_error_bounds. */
struct ErrorBounds {
  JointErrors every_joint; /**< of each revolute, continuous and prismatic joint that follows no other */
  std::map<std::string, JointErrors> joints; /**< of these joints, instead */
  double timing = 0.0;                       /**< [s] the whole motion is early or late by at most this */
  double base_position = 0.0;                /**< [m] where the robot's root link stands */
  double base_rotation = 0.0;   /**< [rad] how it is turned, about any axis through its origin at the motion's start */
  double object_position = 0.0; /**< [m] where each object stands */
  double object_rotation = 0.0; /**< [rad] how it is turned, about any axis through its pose's position */
  double sensor = 0.0;          /**< [m] each point of an object */
  double flex = 0.0;            /**< [m] each point of a link below the first joint */
};

/** The answer for every execution within the bounds, and by how much the bounds may grow. */
struct RobustAnswer {
  /** clear: every execution is farther than delta from everything at all times. violated: the motion itself, without
   *  errors, is not. undecided: neither is proven. lower: the clearance that is certified for every execution; upper
   *  is that of the method, not that of an execution. Names, status, rounding and coverage as of askEnvironment(). */
  Answer answer;

  /** With all bounds but timing times this the verdict is clear; 0: with none; infinity: the bounds do not matter. Of
   *  DISTANCE both are NaN. */
  double certified = 0.0;
  /** With all bounds times this it was not; infinity: no such scale was found. */
  double refused = 0.0;
};

/** query: any type; takes no certificate, no per_object, no signed_distance and no moving_only. Of DISTANCE the
 *  answer has no verdict, and lower is the clearance that every execution keeps. self: the robot against itself.
 *  Throws Error: a joint that the robot does not have or that follows another, a bound that is negative or not
 *  finite. Cost: at most ten verdicts. */
RobustAnswer askRobust(const RobotMotion &motion, bool self, const ErrorBounds &bounds, const Query &query,
                       Workspace &workspace);

/** The clearance of every execution within the bounds, on each interval between two breaks [s], ascending and within
 *  domain(). lower: every execution keeps this distance while its clock is in the interval. upper: this method
 *  certifies no more; t, witness points and names say where. Takes and throws what clearanceProfile() does, and
 *  askRobust() of bounds. Cost: a search an interval. */
std::vector<ClearanceInterval> robustProfile(const RobotMotion &motion, bool self, const ErrorBounds &bounds,
                                             const std::vector<double> &breaks, const Query &query,
                                             Workspace &workspace);

/** The time of contact of every execution within the bounds. result.t_contact_lower: before this time none touches
 *  anything, each by its own clock, timing errors included. Verdict clear: none does at all. violated: the motion
 *  itself, without errors, touches at result.t. undecided: neither is proven; t_contact_lower is then within
 *  `resolution` [s] > 0 of a time that is not certified. The query is COLLISION; takes and throws what timeOfContact()
 *  does, and askRobust() of bounds. Cost: a robust verdict for each
 *  halving of the time, and timeOfContact(). */
Answer robustTimeOfContact(const RobotMotion &motion, bool self, const ErrorBounds &bounds, double resolution,
                           const Query &query, Workspace &workspace);

} // namespace curve_proximity
#endif
