/* SPDX-License-Identifier: BSD-3-Clause */
/** What an SRDF says that matters here: how the robot stands in the world, and which links need no check against each
 *  other. */
#ifndef CURVE_PROXIMITY_SRDF_HPP
#define CURVE_PROXIMITY_SRDF_HPP

#include <array>
#include <string>
#include <vector>

namespace curve_proximity {

/** The joint between the fixed frame and the robot's root link. */
struct VirtualJoint {
  std::string name, type; /**< type: fixed, planar or floating */
  std::string parent_frame, child_link;
};

struct Srdf {
  std::vector<VirtualJoint> virtual_joints;
  std::vector<std::array<std::string, 2>> disabled; /**< pairs of links that are not checked against each other */
};

/** Reads an SRDF. Throws Error, naming the element: XML that is none, no <robot>, a virtual joint of an unknown type,
 *  elements that lack an attribute. Elements that say nothing of the above are not looked at. */
Srdf parseSrdf(const std::string &xml);

} // namespace curve_proximity
#endif
