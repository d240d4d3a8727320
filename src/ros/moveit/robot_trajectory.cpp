/* SPDX-License-Identifier: BSD-3-Clause */
#include "moveit/robot_trajectory.h"

#include <algorithm>
#include <boost/algorithm/string/join.hpp>
#include <cmath>
#include <set>

#include "../../scene/motion/trajectory_points.h"
#include "messages/topics.h"

namespace curve_proximity {
namespace {

using trajectory_msgs::JointTrajectory;
using trajectory_msgs::JointTrajectoryPoint;
using trajectory_msgs::MultiDOFJointTrajectory;

const Robot &robotOf(const Snapshot &snapshot) {
  if (!snapshot.robot()) throw Error("a trajectory needs a robot, and this server has none");
  return *snapshot.robot();
}

std::string quotedNames(const std::vector<std::string> &names) {
  return "'" + boost::algorithm::join(names, "', '") + "'";
}

/** The entries of the columns that stay; lists that have not as many entries as there are joints stay as they are, for
 *  the query to refuse. */
template <class Value>
void keepColumns(const std::vector<bool> &keep, std::vector<Value> &values) {
  if (values.size() != keep.size()) return;
  std::size_t n = 0;
  for (std::size_t i = 0; i < keep.size(); ++i)
    if (keep[i]) values[n++] = values[i];
  values.resize(n);
}

void keepColumns(const std::vector<bool> &keep, JointTrajectoryPoint &point) {
  for (std::vector<double> *values : {&point.positions, &point.velocities, &point.accelerations})
    keepColumns(keep, *values);
}

void keepColumns(const std::vector<bool> &keep, trajectory_msgs::MultiDOFJointTrajectoryPoint &point) {
  keepColumns(keep, point.transforms);
}

/** Without the joints that are not known; their names come back. */
template <class Trajectory, class IsKnown>
std::vector<std::string> keepKnown(Trajectory &trajectory, const IsKnown &isKnown) {
  std::vector<bool> keep;
  std::vector<std::string> names, unknown;
  for (const std::string &name : trajectory.joint_names) {
    keep.push_back(isKnown(name));
    (keep.back() ? names : unknown).push_back(name);
  }
  for (auto &point : trajectory.points) keepColumns(keep, point);
  trajectory.joint_names = names;
  return unknown;
}

std::vector<std::string> keepFree(const Robot &robot, const Srdf &srdf, MultiDOFJointTrajectory &trajectory) {
  return keepKnown(trajectory, [&](const std::string &name) {
    MultiDOFJointTrajectory alone;
    alone.joint_names = {name};
    return movesRobot(alone, &robot, srdf);
  });
}

void addRemark(const std::string &remark, std::vector<std::string> &remarks) {
  if (std::find(remarks.begin(), remarks.end(), remark) == remarks.end()) remarks.push_back(remark);
}

/** What can make an answer wrong. */
void leaveOut(const std::string &remark, Missing missing, RobotMotions &motions) {
  addRemark(remark, motions.remarks);
  motions.coverage.add(Gap::PARTIAL, remark, missing);
}

/** The columns of both. */
JointTrajectory merged(const JointTrajectory &joints, const JointTrajectory &free, RobotMotions &motions) {
  JointTrajectory out = joints;
  if (joints.points.size() != free.points.size())
    throw Error("joint_trajectory has " + std::to_string(joints.points.size()) +
                " points, multi_dof_joint_trajectory has " + std::to_string(free.points.size()));
  out.joint_names.insert(out.joint_names.end(), free.joint_names.begin(), free.joint_names.end());
  bool smooth = false;
  for (std::size_t i = 0; i < out.points.size(); ++i) {
    JointTrajectoryPoint &point = out.points[i];
    const JointTrajectoryPoint &other = free.points[i];
    if (point.time_from_start != other.time_from_start)
      throw Error("point " + std::to_string(i) +
                  ": the times of joint_trajectory and multi_dof_joint_trajectory differ");
    if (point.positions.size() != joints.joint_names.size())
      throw Error("point " + std::to_string(i) + ": has " + std::to_string(point.positions.size()) + " positions for " +
                  std::to_string(joints.joint_names.size()) + " joints");
    smooth = smooth || !point.velocities.empty() || !point.accelerations.empty();
    point.velocities.clear();
    point.accelerations.clear();
    point.positions.insert(point.positions.end(), other.positions.begin(), other.positions.end());
  }
  if (smooth)
    leaveOut("with a multi-DOF part all joints go straight from point to point: velocities are not used",
             Missing::ANYTHING, motions);
  return out;
}

JointTrajectory toTrajectory(const moveit::RobotTrajectory &message, const Robot &robot, const Srdf &srdf,
                             RobotMotions &motions) {
  JointTrajectory joints = message.joint_trajectory;
  MultiDOFJointTrajectory free = message.multi_dof_joint_trajectory;
  joints.header.stamp = free.header.stamp = ros::Time(); // when it was planned is no time to look transforms up for
  std::vector<std::string> unknown = keepKnown(joints, [&](const std::string &name) { return robot.hasJoint(name); });
  const std::vector<std::string> other = keepFree(robot, srdf, free);
  unknown.insert(unknown.end(), other.begin(), other.end());
  if (joints.joint_names.empty() && free.joint_names.empty())
    throw Error(unknown.empty() ? "the trajectory names no joints"
                                : "the robot has none of the trajectory's joints: " + quotedNames(unknown));
  if (!unknown.empty())
    addRemark("joints that the robot does not have are left out: " + quotedNames(unknown), motions.remarks);
  if (free.joint_names.empty()) return joints;
  JointTrajectory freely = toJointTrajectory(free, robot, srdf);
  if (joints.joint_names.empty()) return freely;
  return merged(joints, freely, motions);
}

/** Further joints that stand at these values. */
void hold(const JointPositions &values, JointTrajectory &trajectory) {
  const std::set<std::string> moved(trajectory.joint_names.begin(), trajectory.joint_names.end());
  const std::size_t before = trajectory.joint_names.size();
  for (const auto &[name, value] : values) {
    if (moved.count(name) > 0) continue;
    trajectory.joint_names.push_back(name);
    for (JointTrajectoryPoint &point : trajectory.points) {
      if (point.positions.size() < before) continue; // the query refuses it
      point.positions.push_back(value);
      if (point.velocities.size() >= before) point.velocities.push_back(0.0);
      if (point.accelerations.size() >= before) point.accelerations.push_back(0.0);
    }
  }
}

/** The variables of planar and floating joints in a state. */
JointPositions freeValues(const sensor_msgs::MultiDOFJointState &state, const Robot &robot, const Srdf &srdf) {
  MultiDOFJointTrajectory point;
  point.joint_names = state.joint_names;
  point.points.resize(1);
  point.points[0].transforms = state.transforms;
  keepFree(robot, srdf, point);
  JointPositions out;
  if (point.joint_names.empty()) return out;
  const JointTrajectory values = toJointTrajectory(point, robot, srdf);
  for (std::size_t i = 0; i < values.joint_names.size(); ++i)
    out[values.joint_names[i]] = values.points[0].positions[i];
  return out;
}

std::uint32_t bodyType(const std::string &name, const Snapshot &snapshot) {
  if (snapshot.attached().count(name) > 0) return moveit::ContactInformation::ROBOT_ATTACHED;
  const bool link = snapshot.robot() && snapshot.robot()->links().count(name) > 0;
  return link ? moveit::ContactInformation::ROBOT_LINK : moveit::ContactInformation::WORLD_OBJECT;
}

} // namespace

RobotMotions toMotions(const moveit::RobotTrajectory &message, const Snapshot &snapshot, const Srdf &srdf) {
  RobotMotions out;
  out.trajectories.push_back(toTrajectory(message, robotOf(snapshot), srdf, out));
  return out;
}

RobotMotions toMotions(const moveit::DisplayTrajectory &message, const Snapshot &snapshot, const Srdf &srdf) {
  const Robot &robot = robotOf(snapshot);
  const moveit::RobotState &start = message.trajectory_start;
  RobotMotions out;
  if (message.trajectory.empty()) throw Error("the message has no trajectory");
  if (!message.model_id.empty() && message.model_id != robot.name()) {
    // as of a planning scene of another robot: joints of one name may move other links
    out.remarks.push_back("the trajectory is of robot '" + message.model_id + "', and this server's is '" +
                          robot.name() + "'");
    out.coverage.add(Gap::UNKNOWN, out.remarks.back());
  }

  std::vector<std::string> unknown;
  if (start.joint_state.name.size() != start.joint_state.position.size())
    throw Error("trajectory_start: " + std::to_string(start.joint_state.name.size()) + " joints have " +
                std::to_string(start.joint_state.position.size()) + " positions");
  for (std::size_t i = 0; i < start.joint_state.name.size(); ++i) {
    const std::string &name = start.joint_state.name[i];
    if (!robot.hasJoint(name)) {
      unknown.push_back(name);
      continue;
    }
    out.start.name.push_back(name);
    out.start.position.push_back(start.joint_state.position[i]);
  }
  out.start.header = start.joint_state.header;
  if (!unknown.empty())
    out.remarks.push_back("joints of trajectory_start that the robot does not have: " + quotedNames(unknown));
  for (const moveit::AttachedCollisionObject &attached : start.attached_collision_objects) {
    const std::string &id = attached.object.id;
    if (snapshot.attached().count(id) == 0)
      leaveOut("trajectory_start: link '" + attached.link_name + "' carries '" + id +
                   "', and in the scene it does not: '" + id + "' is not measured",
               Missing::GEOMETRY, out);
  }

  JointPositions stood;
  for (std::size_t i = 0; i < out.start.name.size(); ++i) stood[out.start.name[i]] = out.start.position[i];
  JointPositions held = freeValues(start.multi_dof_joint_state, robot, srdf);
  for (const moveit::RobotTrajectory &part : message.trajectory) {
    const bool first = out.trajectories.empty();
    JointTrajectory trajectory = toTrajectory(part, robot, srdf, out);
    hold(held, trajectory);
    auto &points = trajectory.points;
    if (!first && !points.empty() && points.front().time_from_start > ros::Duration(0.0)) {
      // the way from where the part before has ended, as from where the robot stands before the first
      JointPositions ended = held;
      ended.insert(stood.begin(), stood.end());
      beginAt(ended, trajectory.joint_names, points);
    }
    if (!points.empty() && points.back().positions.size() == trajectory.joint_names.size())
      for (std::size_t i = 0; i < trajectory.joint_names.size(); ++i)
        held[trajectory.joint_names[i]] = points.back().positions[i];
    out.trajectories.push_back(std::move(trajectory));
  }
  return out;
}

std::optional<moveit::ContactInformation> toContact(const Proximity &row, double epsilon, const Snapshot &snapshot) {
  const bool touches = row.verdict.empty() ? row.upper <= epsilon : row.verdict == Proximity::VERDICT_VIOLATED;
  const bool clear = row.verdict.empty() ? row.lower > epsilon : row.verdict == Proximity::VERDICT_CLEAR;
  if (clear) return std::nullopt;
  moveit::ContactInformation out;
  out.contact_body_1 = row.a;
  out.body_type_1 = bodyType(row.a, snapshot);
  if (!touches || !std::isfinite(row.upper)) {
    out.contact_body_2 = "<" + (row.status == Proximity::STATUS_OK ? Proximity::VERDICT_UNDECIDED : row.status) + ">";
    out.body_type_2 = moveit::ContactInformation::WORLD_OBJECT;
    return out;
  }
  out.position.x = 0.5 * (row.witness_a.x + row.witness_b.x);
  out.position.y = 0.5 * (row.witness_a.y + row.witness_b.y);
  out.position.z = 0.5 * (row.witness_a.z + row.witness_b.z);
  out.normal = row.normal;
  out.depth = -row.upper;
  out.contact_body_2 = row.b;
  out.body_type_2 = bodyType(row.b, snapshot);
  return out;
}

} // namespace curve_proximity
