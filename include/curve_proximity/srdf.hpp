/* SPDX-License-Identifier: BSD-3-Clause */
/** Reads virtual joints and disabled pairs of links from an SRDF. */
#ifndef CURVE_PROXIMITY_SRDF_HPP
#define CURVE_PROXIMITY_SRDF_HPP

#include <array>
#include <string>
#include <vector>

#include <curve_proximity/scene.hpp>

namespace curve_proximity {

/** The joint between the fixed frame and the robot's root link. */
struct VirtualJoint {
  std::string name;         /**< of the joint */
  std::string type;         /**< fixed, planar or floating */
  std::string parent_frame; /**< the fixed frame, or a frame in it */
  std::string child_link;   /**< the robot's root link */
};

/** The elements of an SRDF that this package uses. */
struct Srdf {
  std::vector<VirtualJoint> virtual_joints;         /**< in the order of the file */
  std::vector<std::array<std::string, 2>> disabled; /**< pairs of links that are not checked against each other */
  std::vector<std::string> disabled_by_default;     /**< links that are checked against nothing … */
  std::vector<std::array<std::string, 2>> enabled;  /**< … but these */
};

/** Reads an SRDF. Other elements are ignored.
 *
 *  Throws Error for malformed XML, a missing element `robot`, a virtual joint of an unknown type and a missing
 *  attribute. The message names the element. */
Srdf parseSrdf(const std::string &xml);

/** What the SRDF says of links by default, as MoveIt enters it into the allowed collision matrix: `true` as the default
 *  of each link in disabled_by_default, so that objects of the world may touch it too, and `false` for each pair in
 *  enabled. The pairs in `disabled` are not among them: RobotMotion takes these. */
std::vector<AllowedPair> allowedPairs(const Srdf &srdf);

} // namespace curve_proximity
#endif
