/* SPDX-License-Identifier: BSD-3-Clause */
/** What an SRDF says that matters here: how the robot stands in the world, and which links need no check against each
 *  other. */
#ifndef CURVE_PROXIMITY_SRDF_HPP
#define CURVE_PROXIMITY_SRDF_HPP

#include <array>
#include <string>
#include <vector>

#include <curve_proximity/scene.hpp>

namespace curve_proximity {

/** The joint between the fixed frame and the robot's root link. */
struct VirtualJoint {
  std::string name, type; /**< type: fixed, planar or floating */
  std::string parent_frame, child_link;
};

struct Srdf {
  std::vector<VirtualJoint> virtual_joints;
  std::vector<std::array<std::string, 2>> disabled; /**< pairs of links that are not checked against each other */
  std::vector<std::string> disabled_by_default;     /**< links that are checked against nothing … */
  std::vector<std::array<std::string, 2>> enabled;  /**< … but these */
};

/** Reads an SRDF. Throws Error, naming the element: XML that is none, no <robot>, a virtual joint of an unknown type,
 *  elements that lack an attribute. Elements that say nothing of the above are not looked at. */
Srdf parseSrdf(const std::string &xml);

/** What the SRDF says of links by default, as MoveIt enters it into the allowed collision matrix: `true` as the default
 *  of each link in disabled_by_default, so that objects of the world may touch it too, and `false` for each pair in
 *  enabled. The pairs in `disabled` are not among them: RobotMotion takes these. */
std::vector<AllowedPair> allowedPairs(const Srdf &srdf);

} // namespace curve_proximity
#endif
