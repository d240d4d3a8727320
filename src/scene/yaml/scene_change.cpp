/* SPDX-License-Identifier: BSD-3-Clause */
#include "scene_change.h"

#include <filesystem>
#include <set>

#include "bad_input.h"
#include "robot/free_joints.h"

namespace curve_proximity::yaml {
namespace {

/* Frames that only the node's tf2 knows stay as they are; those that the file itself explains are resolved. */
void resolveFrame(ObjectDescription &object, const Frames &frames) {
  if (!frames.knows(object.frame)) return;
  object.pose = frames.find(object.frame) * object.pose;
  object.frame.clear();
}

/* The same of all poses of an object that moves; its own is left as it is. */
void movePoses(const Eigen::Isometry3d &frame, Operation &operation) {
  for (TimedPose &waypoint : operation.trajectory->poses) waypoint.pose = frame * waypoint.pose;
  operation.object.frame.clear();
}

void resolveFrame(Operation &operation, const Frames &frames) {
  if (!operation.trajectory) return resolveFrame(operation.object, frames);
  if (frames.knows(operation.object.frame)) movePoses(frames.find(operation.object.frame), operation);
}

/* The node does not know the folder that paths in the file are relative to. */
void makeResourcesAbsolute(ObjectDescription &object, const std::string &folder) {
  for (ShapeDescription &shape : object.shapes) {
    const bool relative = !shape.resource.empty() && shape.resource.find("://") == std::string::npos &&
                          std::filesystem::path(shape.resource).is_relative();
    if (relative) shape.resource = (std::filesystem::path(folder) / shape.resource).string();
  }
}

/* An object's pose, from the frame that it names to the fixed frame. Shapes that are appended without a pose belong to
 * an object that stands there already. */
Operation toFixed(Operation operation, const Frames &frames) {
  ObjectDescription &object = operation.object;
  const bool relative = operation.kind == Operation::Kind::APPEND && object.pose.matrix().isIdentity(0.0);
  if (operation.kind == Operation::Kind::REMOVE || relative) return operation;
  try {
    const Eigen::Isometry3d frame = frames.find(object.frame);
    if (operation.trajectory) {
      movePoses(frame, operation);
    } else {
      object.pose = frame * object.pose;
      object.frame.clear();
    }
  } catch (const BadInput &e) {
    throw BadUsage("object '" + object.id + "': " + e.what());
  }
  return operation;
}

/* What a link carries, from the frame that it names to the link's, by where the scene's robot_state has the link.
 * Without a robot it stands where it is. */
void attach(const Attachment &given, const Frames &frames, const Robot *robot, const LinkPoses &links,
            SceneChange &change) {
  if (!robot) {
    change.operations.push_back(toFixed(Operation{Operation::Kind::ADD, given.object}, frames));
    return;
  }
  const auto link = links.find(given.link);
  if (link == links.end()) {
    throw BadUsage("object '" + given.object.id + "' is attached to '" + given.link +
                   "', which is no link of the robot");
  }
  Attachment attachment = given;
  if (given.object.frame != given.link) {
    const Operation standing = toFixed(Operation{Operation::Kind::ADD, given.object}, frames);
    attachment.object.pose = link->second.inverse() * standing.object.pose;
  }
  change.attachments.push_back(std::move(attachment));
}

/* An id that comes twice: the later object takes the earlier one's place, which is hardly what was meant. */
void warnOfReplaced(const std::vector<Operation> &operations, Warnings &warnings) {
  std::set<std::string> there;
  for (const Operation &operation : operations) {
    const std::string &id = operation.object.id;
    if (operation.kind == Operation::Kind::REMOVE && id.empty()) {
      there.clear();
    } else if (operation.kind == Operation::Kind::REMOVE) {
      there.erase(id);
    } else if (operation.kind == Operation::Kind::ADD && !there.insert(id).second) {
      warnings.leaveOut("object '" + id + "' comes twice; the later one replaces the earlier", Missing::GEOMETRY);
    }
  }
}

} // namespace

void makeResourcesAbsolute(SceneChange &change, const std::string &folder) {
  for (Operation &operation : change.operations) makeResourcesAbsolute(operation.object, folder);
  for (Attachment &attachment : change.attachments) makeResourcesAbsolute(attachment.object, folder);
}

std::string folderOf(const std::string &path) {
  std::error_code error;
  if (path == "/dev/stdin") return std::filesystem::current_path(error).string();
  return std::filesystem::absolute(path, error).parent_path().string();
}

SceneChange toChange(const SceneFile &file, const std::string &path, Warnings &warnings) {
  const Frames frames({}, file.transforms, {}, warnings);
  SceneChange change;
  change.coverage = file.coverage;
  change.clear = !file.is_diff;
  change.operations = file.operations;
  change.attachments = file.attached;
  const auto prepare = [&](auto &what, const std::string &id) {
    try {
      resolveFrame(what, frames);
    } catch (const BadInput &e) {
      throw BadUsage(path + ": object '" + id + "': " + e.what());
    }
  };
  if (!file.moving_robots.empty())
    throw BadUsage(path + ": moving robot '" + file.moving_robots.front().name +
                   "': a live scene takes no further robots; requests name them (moving_robots)");
  for (Operation &operation : change.operations) prepare(operation, operation.object.id);
  for (Attachment &attachment : change.attachments) prepare(attachment.object, attachment.object.id);
  makeResourcesAbsolute(change, folderOf(path));
  change.link_padding = file.link_padding;
  change.link_scale = file.link_scale;
  change.allowed = file.allowed;
  warnOfReplaced(change.operations, warnings);
  change.coverage.add(warnings.coverage());
  if (!change.coverage.complete())
    throw BadUsage(path + ": " + change.coverage.message() + ": a live scene takes the whole of a file");
  return change;
}

RobotPlace placeRobot(const SceneFile &file, const Robot &robot, const std::vector<VirtualJoint> &virtual_joints,
                      Warnings &warnings) {
  RobotPlace out;
  std::string others;
  for (const auto &[joint, value] : file.joints) {
    if (robot.hasJoint(joint)) {
      out.joints.emplace(joint, value);
    } else {
      others += (others.empty() ? "'" : ", '") + joint + "'";
    }
  }
  const std::string none = "robot_state: the robot has no joint " + others + "; ignored";
  const bool of_another = !file.robot.empty() && file.robot != robot.name(); /* its other joints are not this one's */
  if (!others.empty()) of_another ? warnings.add(none) : warnings.leaveOut(none);

  /* planar and floating joints */
  for (const FreeJointPoses &given : file.free_joints) {
    const std::optional<FreeJoint> joint = resolveFreeJoint(given, robot, virtual_joints);
    if (!joint) continue;
    const std::vector<double> values = valuesAt(given.poses, *joint).front();
    if (joint->is_virtual) {
      const Eigen::Isometry3d base = toIsometry(given.poses.front());
      if (base.matrix().isIdentity(0.0)) continue;
      if (joint->name != virtual_joints.front().name)
        throw Error("joint '" + joint->name + "': the robot stands on its first virtual joint, '" +
                    virtual_joints.front().name + "'");
      out.base = base;
      continue;
    }
    const std::vector<std::string> names = variablesOf(*joint);
    for (std::size_t k = 0; k < names.size(); ++k) out.joints[names[k]] = values[k];
  }
  try {
    out.links = robot.linkPoses(out.joints, out.base);
  } catch (const Error &e) {
    throw Error(std::string("robot_state: ") + e.what());
  }
  if (out.base.matrix().isIdentity(0.0)) out.fixed.insert(robot.rootLink());
  if (!virtual_joints.empty()) out.fixed.insert(virtual_joints.front().parent_frame);
  return out;
}

SceneChange toFixedChange(const SceneFile &file, const Frames &frames, const Robot *robot, const LinkPoses &links,
                          Warnings &warnings) {
  SceneChange change;
  change.coverage = file.coverage;
  for (const Operation &operation : file.operations) change.operations.push_back(toFixed(operation, frames));
  for (const Attachment &attached : file.attached) attach(attached, frames, robot, links, change);
  warnOfReplaced(change.operations, warnings);

  /* without a robot there are no links to be enlarged */
  if (robot) change.link_padding = file.link_padding;
  if (robot) change.link_scale = file.link_scale;
  change.allowed = file.allowed;
  change.coverage.add(warnings.coverage());
  return change;
}

} // namespace curve_proximity::yaml
