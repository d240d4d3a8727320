/* SPDX-License-Identifier: BSD-3-Clause */
#include "world/live_scene.h"

#include <cmath>
#include <sstream>

#include "messages/trajectory_message.h"

namespace curve_proximity {
namespace {

const VirtualJoint *fixedJointOf(const Robot &robot, const Srdf &srdf) {
  for (const VirtualJoint &joint : srdf.virtual_joints)
    if (joint.type == "fixed" && joint.child_link == robot.rootLink()) return &joint;
  return nullptr;
}

} // namespace

SceneState LiveScene::state(const Snapshot &snapshot) const {
  SceneState out;
  out.epoch = epoch;
  out.version = snapshot.version();
  out.joint_state_age = out.transform_age = std::numeric_limits<double>::quiet_NaN();
  out.sensors = sensors.states();
  out.objects =
      static_cast<std::uint32_t>(snapshot.objects().size() + snapshot.moving().size() + snapshot.attached().size());
  if (!snapshot.robot()) return out;
  for (const auto &link : snapshot.robot()->links()) out.links += !link.second.empty();
  return out;
}

const std::vector<std::array<std::string, 2>> &LiveScene::disabled() const {
  static const std::vector<std::array<std::string, 2>> none;
  return matrix_has_srdf ? none : srdf.disabled;
}

void LiveScene::demand(const Snapshot &snapshot, const ros::Time &epoch_wanted, std::uint64_t version_wanted) const {
  if (!epoch_wanted.isZero() && epoch_wanted != epoch) {
    std::ostringstream what;
    what << "scene_epoch is " << epoch_wanted << ", and this server started at " << epoch
         << ": what was sent to the one before may be lost";
    throw Error(what.str());
  }
  if (version_wanted > snapshot.version())
    throw Error("scene_version is " + std::to_string(version_wanted) + ", and the scene is at version " +
                std::to_string(snapshot.version()));
}

Eigen::Isometry3d rootPose(const Robot &robot, const Srdf &srdf, const ros::Time &stamp, FrameLookup &lookup) {
  const VirtualJoint *joint = fixedJointOf(robot, srdf);
  const bool by_tf = !joint || lookup.frames().has(robot.rootLink(), stamp);
  if (by_tf) return lookup.toFixed(robot.rootLink(), stamp);
  if (lookup.frames().settled()) return lookup.toFixed(joint->parent_frame, stamp);
  try {
    return lookup.toFixed(robot.rootLink(), stamp); // in the first moments tf2 may still hear of it
  } catch (const Error &) {
    return lookup.toFixed(joint->parent_frame, stamp);
  }
}

CurrentJoints currentJoints(const sensor_msgs::JointState &given, bool current, const JointBoard &board) {
  CurrentJoints out;
  out.positions = toJointPositions(given);
  if (!current) return out;
  for (const auto &[name, joint] : board.joints()) {
    if (!out.positions.emplace(name, joint.position).second) continue;
    out.age = std::fmax(out.age, joint.age.seconds());
  }
  if (out.positions.empty())
    throw Error("no joint position is known: joint_state names none, and none has come on ~joint_states");
  return out;
}

} // namespace curve_proximity
