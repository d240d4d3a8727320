/* SPDX-License-Identifier: BSD-3-Clause */
/** moveit_msgs/PlanningScene as a change of the scene, full or a diff, by the rules of MoveIt's PlanningScene
 *  (setPlanningSceneMsg, setPlanningSceneDiffMsg). Needs no node and no master. */
#ifndef CURVE_PROXIMITY_ROS_PLANNING_SCENE_H
#define CURVE_PROXIMITY_ROS_PLANNING_SCENE_H

#include <curve_proximity/scene.hpp>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "moveit/moveit_messages.h"

namespace curve_proximity {

/** MoveIt's name for the octomap of its world. */
constexpr const char *MOVEIT_OCTOMAP = "<octomap>";

/** What planning scenes have said and the scene itself does not keep. */
struct PlanningSceneState {
  struct Frame {
    std::string parent;
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity(); /**< in the parent */
  };
  using Subframes = std::map<std::string, Eigen::Isometry3d>;
  using Names = std::pair<std::string, std::string>; /**< in order; the second empty: the default of the first */

  std::map<std::string, Frame> transforms;    /**< fixed_frame_transforms, by child frame */
  std::map<std::string, Subframes> subframes; /**< by object, in the object's frame */
  JointPositions joints;                      /**< of robot_state, as far as the robot has them */
  std::map<Names, bool> allowed;              /**< the allowed collision matrix */
};

/** What a message comes to. */
struct PlanningSceneChange {
  SceneChange change;             /**< in the fixed frame */
  PlanningSceneState state;       /**< after the message */
  std::vector<std::string> wrong; /**< what is not used, a message each */
};

/** What the message is brought into. */
struct PlanningSceneContext {
  const Snapshot &before;
  const PlanningSceneState &state;
  std::set<std::string> kept; /**< objects that a full scene leaves: those of sensors */
  bool unknown_is_occupied = false;
  /** Both throw Error. A frame that neither the message nor the scene explains, in the fixed frame: */
  std::function<Eigen::Isometry3d(const std::string &frame)> to_fixed;
  /** A link in the fixed frame, for the joints that planning scenes have told, or none: */
  std::function<Eigen::Isometry3d(const std::string &link, const JointPositions &joints)> link_to_fixed;
};

/** What cannot be used becomes a message in `wrong`, and the rest is used. Joint values stay in the state.
 *
 *  As in MoveIt: a full scene replaces transforms' values, attached objects, matrix and world; paddings and scales
 *  change for the links that are named. A diff changes what it names; its matrix replaces the one before as a whole.
 *  What is attached and detached comes before the world's objects. A pose is in a link's frame, an object's, a
 *  subframe's (OBJECT/NAME), one of fixed_frame_transforms, or one of tf2. Differences: objects of sensors stay; an
 *  octomap that cannot be used leaves the one before; types, colours, weights and postures are not used. */
PlanningSceneChange toSceneChange(const moveit::PlanningScene &message, const PlanningSceneContext &context);

/** How the world of a full scene differs from a snapshot: a message for each object, attached object, padding and
 *  scale that differs or cannot be used, at most `most`. Poses within 1e-6 m are the same. */
std::vector<std::string> differences(const moveit::PlanningScene &message, const PlanningSceneContext &context,
                                     std::size_t most);

} // namespace curve_proximity
#endif
