/* SPDX-License-Identifier: BSD-3-Clause */
#include "trajectory_yaml.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>

#include "bad_input.h"
#include "motion/trajectory_points.h"
#include "robot_state_yaml.h"

namespace curve_proximity::yaml {
namespace {

Interpolation readInterpolation(const YamlValue &value) {
  const std::optional<Interpolation> known = interpolationFromName(value.text());
  if (!known) value.fail("the interpolation '" + value.text() + "' is none of linear, cubic, quintic");
  return *known;
}

/* Seconds and nanoseconds, as ROS prints a duration: secs and nsecs, of ROS 2 sec and nanosec. */
std::array<double, 2> readParts(const YamlValue &value) {
  const bool second = value.find("sec") || value.find("nanosec");
  const char *const keys[] = {second ? "sec" : "secs", second ? "nanosec" : "nsecs"};
  value.refuseOthers({keys[0], keys[1]});
  const std::optional<YamlValue> whole = value.find(keys[0]), parts = value.find(keys[1]);
  if (!whole && !parts) value.fail("needs secs or nsecs (of ROS 2 sec or nanosec)");
  return {whole ? whole->number() : 0.0, parts ? parts->number() : 0.0};
}

std::vector<double> readList(const YamlValue &point, const char *key) {
  const std::optional<YamlValue> list = point.find(key);
  return list ? list->numbers() : std::vector<double>();
}

TrajectoryPoint readPoint(const YamlValue &value, Warnings &warnings) {
  value.warnOfOthers({"positions", "velocities", "accelerations", "effort", "time_from_start"}, warnings);
  TrajectoryPoint out;
  out.positions = readList(value, "positions");
  out.velocities = readList(value, "velocities");
  out.accelerations = readList(value, "accelerations");
  out.time = readTime(value.at("time_from_start"));
  return out;
}

void readFixed(const YamlValue &value, JointPositions &out) {
  for (const auto &[joint, entry] : value.entries()) out[joint] = entry.number();
}

void readBase(const YamlValue &value, TrajectoryDescription &out, Warnings &warnings) {
  value.warnOfOthers({"name", "type", "joints", "parent_frame", "child_link"}, warnings);
  VirtualJoint joint;
  if (const auto name = value.find("name")) joint.name = name->text();
  joint.type = value.at("type").text();
  if (joint.type != "planar" && joint.type != "floating") value.fail("the type must be planar or floating");
  if (const auto frame = value.find("parent_frame")) joint.parent_frame = frame->text();
  joint.child_link = value.at("child_link").text();
  for (const YamlValue &part : value.itemsOf("joints")) out.base_joints.push_back(part.text());
  const std::size_t parts = joint.type == "planar" ? 3 : 7;
  if (!out.base_joints.empty() && out.base_joints.size() != parts) {
    value.fail("joints must name the " + std::to_string(parts) + " parts of a " + joint.type + " joint");
  }
  if (out.base_joints.empty() && joint.name.empty()) value.fail("needs joints, or a name that their names begin with");
  out.base.push_back(joint);
}

/* joint_spline: a B-spline of the joint values, by its control points. */
void readSpline(const YamlValue &spline, TrajectoryDescription &out, Warnings &warnings) {
  spline.warnOfOthers({"header", "joint_names", "degree", "knots", "control_points"}, warnings);
  readFrame(spline, warnings);
  for (const YamlValue &name : spline.at("joint_names").items()) out.joints.push_back(name.text());
  out.degree = spline.at("degree").count();
  if (out.degree < 1) spline.at("degree").fail("the degree of a spline is at least 1");
  out.knots = spline.at("knots").numbers();
  for (const YamlValue &point : spline.at("control_points").items()) {
    out.points.emplace_back();
    out.points.back().positions = point.numbers();
  }
}

/* A trajectory_msgs/JointTrajectory or MultiDOFJointTrajectory within a message. */
const YamlValue &alone(const YamlValue &trajectory, Warnings &warnings) {
  trajectory.warnOfOthers({"header", "joint_names", "points"}, warnings);
  return trajectory;
}

void readNames(const YamlValue &trajectory, std::vector<std::string> &out) {
  for (const YamlValue &name : trajectory.at("joint_names").items()) out.push_back(name.text());
}

/* trajectory_msgs/JointTrajectory. */
void readJointTrajectory(const YamlValue &trajectory, TrajectoryDescription &out, Warnings &warnings) {
  readFrame(trajectory, warnings); // joint values are of no frame
  readNames(trajectory, out.joints);
  for (const YamlValue &point : trajectory.at("points").items()) out.points.push_back(readPoint(point, warnings));
}

/* trajectory_msgs/MultiDOFJointTrajectory: poses of joints, at the points that there are, or at points of its own. */
void readFreeJoints(const YamlValue &trajectory, TrajectoryDescription &out, Warnings &warnings) {
  const std::string frame = readFrame(trajectory, warnings);
  std::vector<std::string> names;
  readNames(trajectory, names);
  const std::vector<YamlValue> points = trajectory.itemsOf("points");
  if (names.empty() && points.empty()) return;
  const bool alone = out.points.empty();
  if (!alone && out.points.size() != points.size())
    trajectory.fail("has " + std::to_string(points.size()) + " points, joint_trajectory has " +
                    std::to_string(out.points.size()));
  std::vector<FreeJointPoses> joints;
  for (const std::string &name : names) joints.push_back({name, frame, {}});
  for (std::size_t i = 0; i < points.size(); ++i) {
    points[i].warnOfOthers({"transforms", "velocities", "accelerations", "time_from_start"}, warnings);
    const double time = readTime(points[i].at("time_from_start"));
    if (alone) {
      out.points.emplace_back();
      out.points.back().time = time;
    } else if (time != out.points[i].time) {
      points[i].fail("its time is " + std::to_string(time) + " s, that of joint_trajectory's point is " +
                     std::to_string(out.points[i].time) + " s");
    }
    const std::vector<cprox_pose> poses = readTransforms(points[i], warnings);
    if (poses.size() != names.size())
      points[i].fail("has " + std::to_string(poses.size()) + " transforms for " + std::to_string(names.size()) +
                     " joints");
    for (std::size_t k = 0; k < poses.size(); ++k) joints[k].poses.push_back(poses[k]);
    const bool smooth = !points[i].itemsOf("velocities").empty() || !points[i].itemsOf("accelerations").empty();
    if (smooth && out.interpolation != Interpolation::LINEAR)
      warnings.leaveOut(trajectory.where() +
                        ": velocities of poses are not used: joints go straight from pose to pose "
                        "(interpolation: linear says that this is meant)");
  }
  out.free_joints.insert(out.free_joints.end(), joints.begin(), joints.end());
}

/* The parts of a moveit_msgs/RobotTrajectory. */
void readRobotTrajectory(const YamlValue &value, TrajectoryDescription &out, Warnings &warnings) {
  const std::optional<YamlValue> joints = value.find("joint_trajectory"),
                                 free = value.find("multi_dof_joint_trajectory");
  if (!joints && !free) value.fail("has no 'joint_trajectory'");
  if (joints) readJointTrajectory(alone(*joints, warnings), out, warnings);
  if (free) readFreeJoints(alone(*free, warnings), out, warnings);
}

/* moveit_msgs/RobotState at which the trajectory begins: joints that it does not move stand there. */
void readStart(const YamlValue &state, TrajectoryDescription &out, Warnings &warnings) {
  state.warnOfOthers({"joint_state", "multi_dof_joint_state", "attached_collision_objects", "is_diff"}, warnings);
  const JointsFile start = readJoints(state, warnings);
  for (const auto &[joint, value] : start.joints) out.fixed_joints.emplace(joint, value);
  for (const FreeJointPoses &joint : start.free_joints) {
    const auto same = [&](const FreeJointPoses &moved) { return moved.joint == joint.joint; };
    if (std::none_of(out.free_joints.begin(), out.free_joints.end(), same)) out.free_joints.push_back(joint);
  }
  for (const YamlValue &attached : state.itemsOf("attached_collision_objects"))
    out.carried.push_back(attached.at("object").at("id").text());

  /* the way from there, as the node adds it */
  if (out.points.empty() || !(out.points.front().time > 0.0)) return;
  const std::size_t points = out.points.size();
  if (!beginAt(start.joints, out.joints, out.points)) return;
  for (FreeJointPoses &joint : out.free_joints)
    if (joint.poses.size() == points) {
      cprox_pose from = joint.poses.front();
      for (const FreeJointPoses &standing : start.free_joints)
        if (standing.joint == joint.joint) from = standing.poses.front();
      joint.poses.insert(joint.poses.begin(), from);
    }
}

/* A trajectory under the key `trajectory`: of a DisplayTrajectory a list; of a plan, or of the goal of an action, one.
 */
void readUnderTrajectory(const YamlValue &value, TrajectoryDescription &out, Warnings &warnings) {
  if (value.isSequence()) {
    const std::vector<YamlValue> parts = value.items();
    if (parts.size() != 1)
      value.fail("has " + std::to_string(parts.size()) +
                 " trajectories: a file holds one; give each a file of its own");
    return readUnderTrajectory(parts.front(), out, warnings);
  }
  if (value.find("joint_names")) return readJointTrajectory(alone(value, warnings), out, warnings);
  value.warnOfOthers({"joint_trajectory", "multi_dof_joint_trajectory"}, warnings);
  readRobotTrajectory(value, out, warnings);
}

/* Poses have no positions beside them: a MultiDOFJointTrajectory. */
bool hasTransforms(const YamlValue &trajectory) {
  const std::vector<YamlValue> points = trajectory.itemsOf("points");
  return !points.empty() && points.front().find("transforms").has_value();
}

TrajectoryDescription readTrajectoryMap(const YamlValue &root, Warnings &warnings) {
  if (!root.isMap()) root.fail("must be a map with joint_trajectory or joint_spline");
  if (const auto goal = root.find("goal")) {
    root.warnOfOthers({"goal", "goal_id", "header"}, warnings);
    return readTrajectoryMap(*goal, warnings);
  }
  TrajectoryDescription out;
  if (const auto interpolation = root.find("interpolation")) out.interpolation = readInterpolation(*interpolation);
  if (const auto way = root.find("shortest_way")) out.shortest_way = way->truth();
  if (const auto fixed = root.find("fixed_joints")) readFixed(*fixed, out.fixed_joints);
  if (const auto base = root.find("virtual_joint")) readBase(*base, out, warnings);

  if (const auto spline = root.find("joint_spline")) {
    root.warnOfOthers({"joint_spline", "shortest_way", "fixed_joints", "virtual_joint", "robot", "scene"}, warnings);
    if (root.find("joint_trajectory")) root.fail("has both a joint_trajectory and a joint_spline");
    if (root.find("interpolation")) root.fail("a joint_spline has no interpolation");
    readSpline(*spline, out, warnings);
    return out;
  }
  if (root.find("joint_names") && root.find("points")) {
    root.warnOfOthers({"header", "joint_names", "points", "interpolation", "shortest_way", "fixed_joints",
                       "virtual_joint", "robot", "scene"},
                      warnings);
    hasTransforms(root) ? readFreeJoints(root, out, warnings) : readJointTrajectory(root, out, warnings);
    return out;
  }
  root.warnOfOthers({"joint_trajectory", "multi_dof_joint_trajectory", "interpolation", "shortest_way", "fixed_joints",
                     "virtual_joint", "robot", "scene",
                     /* of moveit_msgs/DisplayTrajectory and MotionPlanResponse */
                     "trajectory", "trajectory_start", "model_id", "group_name", "planning_time", "error_code",
                     /* of control_msgs/FollowJointTrajectoryGoal: what a controller tolerates moves nothing */
                     "multi_dof_trajectory", "path_tolerance", "component_path_tolerance", "goal_tolerance",
                     "component_goal_tolerance", "goal_time_tolerance"},
                    warnings);
  if (const auto trajectory = root.find("trajectory")) {
    if (root.find("joint_trajectory")) root.fail("has both a trajectory and a joint_trajectory");
    readUnderTrajectory(*trajectory, out, warnings);
    if (const auto free = root.find("multi_dof_trajectory")) readFreeJoints(alone(*free, warnings), out, warnings);
  } else {
    readRobotTrajectory(root, out, warnings);
  }
  if (const auto start = root.find("trajectory_start")) readStart(*start, out, warnings);
  return out;
}

TrajectoryDescription readFile(const YamlValue &root, Warnings &told) {
  Warnings warnings;
  TrajectoryDescription out = readTrajectoryMap(root, warnings);
  out.coverage = warnings.coverage();
  told.add(warnings);
  return out;
}

} // namespace

std::int64_t readStamp(const YamlValue &value) {
  constexpr double BILLION = 1e9, MOST = 9.2e9; /* [s] */
  const std::array<double, 2> parts = value.isMap() ? readParts(value) : std::array<double, 2>{value.number(), 0.0};
  if (!(std::abs(parts[0]) < MOST && std::abs(parts[1]) < BILLION)) value.fail("is out of range");
  const double whole = std::floor(parts[0]);
  return static_cast<std::int64_t>(whole) * 1000000000 + std::llround((parts[0] - whole) * BILLION + parts[1]);
}

double readTime(const YamlValue &value) {
  if (!value.isMap()) return value.number();
  const std::array<double, 2> parts = readParts(value);
  return parts[0] + 1e-9 * parts[1];
}

double readStartTolerance(const YamlValue &value) {
  const auto tolerance = value.find("start_tolerance"), anywhere = value.find("any_time");
  double out = 0.0;
  if (tolerance) out = tolerance->number();
  if (!(out >= 0.0)) tolerance->fail("is " + tolerance->text() + ": it must be at least 0");
  return anywhere && anywhere->truth() ? std::numeric_limits<double>::infinity() : out;
}

ObjectTrajectory readObjectTrajectory(const YamlValue &value, Warnings &warnings) {
  if (!value.isMap()) value.fail("must be a map with waypoints: [{time, pose}]");
  value.warnOfOthers({"start", "start_tolerance", "any_time", "turning", "waypoints"}, warnings);
  ObjectTrajectory out;
  if (const auto start = value.find("start")) out.start = readStamp(*start);
  out.tolerance = readStartTolerance(value);
  if (const auto turning = value.find("turning")) {
    const std::optional<Turning> known = turningFromName(turning->text());
    if (!known) turning->fail("the turning '" + turning->text() + "' is none of slerp, screw");
    out.turning = *known;
  }
  for (const YamlValue &point : value.at("waypoints").items()) {
    point.warnOfOthers({"time", "pose"}, warnings);
    const double time = readTime(point.at("time"));
    if (!out.poses.empty() && !(time > out.poses.back().time))
      point.at("time").fail("does not ascend: the waypoint before is at " + std::to_string(out.poses.back().time) +
                            " s");
    out.poses.push_back({time, toIsometry(point.at("pose").pose(warnings))});
  }
  if (out.poses.empty()) value.fail("there are no waypoints");
  return out;
}

TrajectoryDescription readTrajectoryValue(const YamlValue &value, const std::string &folder, Warnings &warnings) {
  if (value.isScalar()) return readTrajectory((std::filesystem::path(folder) / value.text()).string(), warnings);
  TrajectoryDescription out = readFile(value, warnings);
  try {
    checkTrajectory(out);
  } catch (const Error &error) {
    value.fail(error.what());
  }
  return out;
}

TrajectoryDescription readTrajectory(const std::string &path, Warnings &warnings) {
  try {
    TrajectoryDescription out = readFile(loadYaml(path), warnings);
    out.id = std::filesystem::path(path).stem().string();
    checkTrajectory(out);
    return out;
  } catch (const BadInput &e) {
    throw BadUsage(path + ": " + e.what());
  } catch (const Error &e) {
    throw BadUsage(path + ": " + e.what());
  }
}

} // namespace curve_proximity::yaml
