/* SPDX-License-Identifier: BSD-3-Clause */
/** Speed and separation monitoring: how fast a robot may go along its trajectory while a person may walk up to it. */
#ifndef CURVE_PROXIMITY_SEPARATION_HPP
#define CURVE_PROXIMITY_SEPARATION_HPP

#include <cstddef>
#include <optional>
#include <vector>

#include <curve_proximity/motion.hpp>

namespace curve_proximity {

/** The constants of the protective separation distance (ISO/TS 15066, 5.5.4), finite and none below 0. The names behind
 *  are those of the standard. */
struct Separation {
  double person_speed = 0.0;    /**< [m/s] v_h: a person, and each part of a person, is never faster */
  double reaction_time = 0.0;   /**< [s] T_r: from the event to the moment in which the robot begins to brake */
  double stopping_time = 0.0;   /**< [s] T_s: from full speed, override 1, to rest; the override falls at a constant
                                   rate, so that it takes k T_s from override k */
  double intrusion = 0.0;       /**< [m] C: how far a person reaches into the zone before the person is detected */
  double person_position = 0.0; /**< [m] Z_d: uncertainty of the person's position */
  double robot_position = 0.0;  /**< [m] Z_r: uncertainty of the robot's position */
  /** [m/s] v_r: no point of the robot is faster at override 1. Given: a robot that brakes may leave its path. Not
   *  given: the robot brakes along its path, and the clearance along it says how far the robot comes nearer. */
  std::optional<double> robot_speed;
};

/** How fast the robot may go. A limit is an override: a factor of the trajectory's own speed, from 0 to 1. */
struct SpeedLimits {
  std::vector<ClearanceInterval> profile; /**< the clearance to where persons may be, by intervals of trajectory time */
  std::vector<double> overrides;          /**< the limit on each interval */
  /** the highest constant override that is safe: the least of all limits */
  double constant = 1.0;
  /** The least constant override at which the motion ends before persons who are not watched can come near: they were
   *  where the scene has them when the motion begins. Infinity: not even override 1. */
  double unwatched = 0.0;
};

/** Limits from a clearance profile that begins and ends with the motion, its intervals one after the other.
 *
 *  Persons are in the objects that the profile is about. Whenever one leaves them, the robot begins to brake after
 *  reaction_time. If the override has always been within the limits, every point of the robot then keeps intrusion +
 *  person_position + robot_position from every person until the robot stands (doc/separation.md). An interval without a
 *  clearance (a gap, a search that was stopped) has the limit 0. Throws Error for constants that are not finite or
 *  below 0. */
SpeedLimits limitSpeed(std::vector<ClearanceInterval> profile, const Separation &separation);

/** The same of a motion, whose profile has n >= 1 intervals of equal length. query.objects: where persons may be; none:
 *  all objects. Takes and throws what clearanceProfile() does. */
SpeedLimits speedLimits(const RobotMotion &motion, std::size_t n, const Separation &separation, const Query &query,
                        Workspace &workspace);

} // namespace curve_proximity
#endif
