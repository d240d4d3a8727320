/* SPDX-License-Identifier: BSD-3-Clause */
/** How far objects may be moved before a robot's motion is no longer clear of them. */
#ifndef CURVE_PROXIMITY_MARGINS_HPP
#define CURVE_PROXIMITY_MARGINS_HPP

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <curve_proximity/motion.hpp>

namespace curve_proximity {

/** How far one object may be moved, all of its shapes together and without turning. */
struct ObjectMargin {
  std::string object;    /**< its id */
  std::string direction; /**< "any", or an axis of the fixed frame: "+x", "-x", "+y", "-y", "+z", "-z" */
  /** [m] moved by less than this the motion is clear of it: farther than Query::delta all the way. Of "any": in all
   *  directions at once, also there and back */
  double free = 0.0;
  /** [m] moved by this it is not: within Query::delta; infinity: nothing of the kind was found. Of "any": in the
   *  direction of `toward` */
  double blocked = std::numeric_limits<double>::infinity();
  double t = 0.0; /**< [s] when the robot is nearest to it, moved to blocked or free */
  std::string a;  /**< then the nearest link or carried object; "": not measured */
  Eigen::Vector3d toward = Eigen::Vector3d::Zero(); /**< a unit vector: the direction of this row */
  cprox_status status = CPROX_OK; /**< CPROX_PRECISION: blocked is more than 1 % above free and a tenth of a mm */
  std::optional<Gap> gap;         /**< the row does not cover all that was given: free is 0 */
};

/** For each object (query.objects: only these) a row for any direction and one for each axis.
 *
 *  within  [m] > 0, finite: objects are moved no farther; free is this where the motion is clear all the way.
 *  query   TOLERANCE, or COLLISION for a delta of 0; takes no certificate. query.links as in askEnvironment().
 *
 *  Every free is certified, and every blocked is proven by a point of the robot and one of the moved object. Throws
 *  Error as askEnvironment() refuses, and where the core refuses. Cost: some distance searches for each
 *  object and axis, typically 5 to 9. */
std::vector<ObjectMargin> objectMargins(const RobotMotion &motion, double within, const Query &query,
                                        Workspace &workspace);

} // namespace curve_proximity
#endif
