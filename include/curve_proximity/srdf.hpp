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

/** A group of links and joints, by name. */
struct SrdfGroup {
  std::string name;                               /**< of the group */
  std::vector<std::string> links;                 /**< links */
  std::vector<std::string> joints;                /**< joints: their child links belong to the group */
  std::vector<std::array<std::string, 2>> chains; /**< base link and tip link: all links from one to the other */
  std::vector<std::string> groups;                /**< groups that are part of it */
};

/** The elements of an SRDF that this package uses. */
struct Srdf {
  std::vector<VirtualJoint> virtual_joints;         /**< in the order of the file */
  std::vector<std::array<std::string, 2>> disabled; /**< pairs of links that are not checked against each other */
  std::vector<std::string> disabled_by_default;     /**< links that are checked against nothing … */
  std::vector<std::array<std::string, 2>> enabled;  /**< … but these */
  std::vector<SrdfGroup> groups;                    /**< in the order of the file */
};

class Robot;

/** The links of a group, each once. Throws Error for an unknown group, link or joint. */
std::vector<std::string> linksOfGroup(const Srdf &srdf, const Robot &robot, const std::string &group);

/** The links that an SRDF disables and a robot does not have: perhaps it is another robot's. Each once. */
std::vector<std::string> unknownLinks(const Srdf &srdf, const Robot &robot);

/** Reads an SRDF. Elements of other names, which say nothing of these, are ignored.
 *
 *  Throws Error for malformed XML, a missing element `robot`, elements that xacro has left, a misspelt element, a
 * virtual joint of an unknown type and a missing attribute. The message names the element. */
Srdf parseSrdf(const std::string &xml);

/** What the SRDF says of links by default, as MoveIt enters it into the allowed collision matrix: `true` as the default
 *  of each link in disabled_by_default, so that objects of the world may touch it too, and `false` for each pair in
 *  enabled. The pairs in `disabled` are not among them: RobotMotion takes these. */
std::vector<AllowedPair> allowedPairs(const Srdf &srdf);

} // namespace curve_proximity
#endif
