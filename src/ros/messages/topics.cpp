/* SPDX-License-Identifier: BSD-3-Clause */
#include "messages/topics.h"

#include "../../scene/motion/path_times.h"
#include "../../scene/robot/free_joints.h"
#include "messages/geometry_message.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

namespace curve_proximity {
namespace {

bool isFinite(double x, double y, double z) {
  return std::isfinite(x) && std::isfinite(y) && std::isfinite(z);
}

/* ---- splines ---- */

/** The three cubic B-splines of a knot vector that are not 0 at its inner knot number i (counted from the first, i >=
 * 1), and their second derivatives there. */
struct AtKnot {
  double value[3];
  double second[3];
};

AtKnot atKnot(const std::vector<double> &knots, std::size_t i) {
  // With t = knots[i + 3] the B-splines i, i + 1, i + 2 live on the intervals around t.
  const double *u = knots.data() + i;
  const double t = u[3];
  AtKnot out{};
  const double wide_left = u[4] - u[1], wide_right = u[5] - u[2], inner = u[4] - u[2];
  out.value[0] = (u[4] - t) * (u[4] - t) / (wide_left * inner);
  out.value[2] = (t - u[2]) * (t - u[2]) / (wide_right * inner);
  out.value[1] = 1.0 - out.value[0] - out.value[2];
  out.second[0] = 6.0 / (wide_left * inner);
  out.second[2] = 6.0 / (wide_right * inner);
  out.second[1] = -out.second[0] - out.second[2];
  return out;
}

} // namespace

void fitNaturalSpline(const std::vector<geometry_msgs::Point> &points, const std::vector<double> &at, Curve &curve) {
  // Clamped knots: three more of each end.
  curve.basis = "bspline";
  curve.degree = 3;
  curve.knots.assign(3, at.front());
  curve.knots.insert(curve.knots.end(), at.begin(), at.end());
  curve.knots.insert(curve.knots.end(), 3, at.back());

  // Unknown are the inner n control points c[1 … n]; c[0] and c[n+1] are the end points. The rows: no second derivative
  // at the first knot, the n - 2 inner points met, no second derivative at the last knot. At a clamped end the three
  // B-splines' second derivatives are those of atKnot() with the coinciding knots in place, so each row has three
  // neighbours.
  const std::size_t n = points.size();
  std::vector<double> lower(n), diagonal(n), upper(n);
  std::vector<Eigen::Vector3d> right(n, Eigen::Vector3d::Zero());
  const auto vector = [](const geometry_msgs::Point &p) { return Eigen::Vector3d(p.x, p.y, p.z); };
  for (std::size_t i = 0; i < n; ++i) {
    const bool end = i == 0 || i + 1 == n;
    const AtKnot row = atKnot(curve.knots, i);
    const double *entries = end ? row.second : row.value;
    lower[i] = entries[0];
    diagonal[i] = entries[1];
    upper[i] = entries[2];
    if (!end) right[i] = vector(points[i]);
  }
  right.front() -= lower.front() * vector(points.front());
  right.back() -= upper.back() * vector(points.back());

  // Thomas's algorithm; the matrix is diagonally dominant.
  for (std::size_t i = 1; i < n; ++i) {
    const double factor = lower[i] / diagonal[i - 1];
    diagonal[i] -= factor * upper[i - 1];
    right[i] -= factor * right[i - 1];
  }
  curve.points.assign(n + 2, points.front());
  curve.points.back() = points.back();
  Eigen::Vector3d next = Eigen::Vector3d::Zero();
  for (std::size_t i = n; i-- > 0;) {
    next = (right[i] - (i + 1 < n ? upper[i] : 0.0) * next) / diagonal[i];
    curve.points[i + 1] = toPointMessage(next);
  }
}

/* ---- paths ---- */

Curve toCurve(const nav_msgs::Path &path, double radius) {
  if (path.poses.empty()) throw Error("the path has no poses");
  Curve curve;
  curve.header = path.header;
  curve.id = "path";
  curve.radius = radius;

  std::vector<geometry_msgs::Point> points;
  std::vector<double> at;
  for (std::size_t i = 0; i < path.poses.size(); ++i) {
    const std::string &frame = path.poses[i].header.frame_id;
    const geometry_msgs::Point &p = path.poses[i].pose.position;
    if (!frame.empty() && frame != path.header.frame_id)
      throw Error("pose " + std::to_string(i) + " is in frame '" + frame + "', the path in '" + path.header.frame_id +
                  "'");
    if (!isFinite(p.x, p.y, p.z)) throw Error("pose " + std::to_string(i) + ": the position is not finite");
    const double chord =
        points.empty() ? 0.0 : std::hypot(p.x - points.back().x, p.y - points.back().y, p.z - points.back().z);
    const double length = at.empty() ? 0.0 : at.back() + chord;
    if (!at.empty() && !(length > at.back())) continue;
    points.push_back(p);
    at.push_back(length);
  }

  if (points.size() == 1) {
    curve.basis = "polynomial";
    curve.points = points;
  } else {
    fitNaturalSpline(points, at, curve);
  }
  return curve;
}

/* ---- planar and floating joints ---- */

namespace {

using trajectory_msgs::MultiDOFJointTrajectory;

cprox_pose poseOf(const MultiDOFJointTrajectory &trajectory, std::size_t point, std::size_t joint) {
  const auto &transforms = trajectory.points[point].transforms;
  if (transforms.size() != trajectory.joint_names.size())
    throw Error("point " + std::to_string(point) + " has " + std::to_string(transforms.size()) +
                " transforms, there are " + std::to_string(trajectory.joint_names.size()) + " joints");
  const geometry_msgs::Vector3 &p = transforms[joint].translation;
  const geometry_msgs::Quaternion &q = transforms[joint].rotation;
  if (!isFinite(p.x, p.y, p.z))
    throw Error("point " + std::to_string(point) + ", joint '" + trajectory.joint_names[joint] +
                "': the translation is not finite");
  return {{p.x, p.y, p.z}, {q.w, q.x, q.y, q.z}};
}

/** Appends the columns of one joint to all points. */
void addColumns(const MultiDOFJointTrajectory &trajectory, std::size_t j, const FreeJoint &joint,
                trajectory_msgs::JointTrajectory &out) {
  std::vector<cprox_pose> poses;
  for (std::size_t i = 0; i < trajectory.points.size(); ++i) poses.push_back(poseOf(trajectory, i, j));
  for (const std::string &name : variablesOf(joint)) out.joint_names.push_back(name);
  const std::vector<std::vector<double>> values = valuesAt(poses, joint);
  for (std::size_t i = 0; i < values.size(); ++i)
    out.points[i].positions.insert(out.points[i].positions.end(), values[i].begin(), values[i].end());
}

} // namespace

bool movesRobot(const MultiDOFJointTrajectory &trajectory, const Robot *robot, const Srdf &srdf) {
  return robot &&
         std::any_of(trajectory.joint_names.begin(), trajectory.joint_names.end(), [&](const std::string &name) {
           return findFreeJoint(name, *robot, srdf.virtual_joints).has_value();
         });
}

trajectory_msgs::JointTrajectory toJointTrajectory(const MultiDOFJointTrajectory &trajectory, const Robot &robot,
                                                   const Srdf &srdf) {
  trajectory_msgs::JointTrajectory out;
  out.header = trajectory.header;
  out.points.resize(trajectory.points.size());
  for (std::size_t i = 0; i < trajectory.points.size(); ++i)
    out.points[i].time_from_start = trajectory.points[i].time_from_start;
  for (std::size_t j = 0; j < trajectory.joint_names.size(); ++j) {
    const std::optional<FreeJoint> joint = findFreeJoint(trajectory.joint_names[j], robot, srdf.virtual_joints);
    if (!joint) throw Error("joint '" + trajectory.joint_names[j] + "' is no planar or floating joint of the robot");
    const std::string &frame = trajectory.header.frame_id;
    if (!frame.empty() && frame != joint->parent)
      throw Error("the trajectory is in frame '" + frame + "', joint '" + joint->name + "' moves in '" + joint->parent +
                  "'");
    addColumns(trajectory, j, *joint, out);
  }
  return out;
}

std::vector<TimedPose> toPoses(const MultiDOFJointTrajectory &trajectory, std::size_t joint) {
  if (trajectory.points.empty()) throw Error("the trajectory has no points");
  std::vector<TimedPose> poses;
  for (std::size_t i = 0; i < trajectory.points.size(); ++i) {
    const std::string where = "point " + std::to_string(i);
    const double time = trajectory.points[i].time_from_start.toSec();
    if (i > 0 && !(time > poses.back().time)) throw Error(where + ": its time is not after that of the point before");
    const cprox_pose given = poseOf(trajectory, i, joint);
    const Eigen::Quaterniond before =
        i > 0 ? Eigen::Quaterniond(poses.back().pose.linear()) : Eigen::Quaterniond::Identity();
    TimedPose pose;
    pose.time = time;
    pose.pose.linear() = rotationOf(given, where, before).toRotationMatrix();
    pose.pose.translation() << given.position.x, given.position.y, given.position.z;
    poses.push_back(pose);
  }
  return poses;
}

PathPoses toPoses(const nav_msgs::Path &path) {
  if (path.poses.empty()) throw Error("the path has no poses");
  std::vector<TimedPose> poses;
  std::vector<std::int64_t> stamps;
  for (std::size_t i = 0; i < path.poses.size(); ++i) {
    const geometry_msgs::PoseStamped &given = path.poses[i];
    const std::string where = "pose " + std::to_string(i);
    const std::string &frame = given.header.frame_id;
    if (!frame.empty() && frame != path.header.frame_id)
      throw Error(where + " is in frame '" + frame + "', the path in '" + path.header.frame_id + "'");
    TimedPose pose;
    try {
      pose.pose = toIsometry(given.pose);
    } catch (const Error &error) {
      throw Error(where + ": " + error.what());
    }
    stamps.push_back(static_cast<std::int64_t>(given.header.stamp.toNSec()));
    poses.push_back(pose);
  }
  PathTimes at = timesOf(stamps, static_cast<std::int64_t>(path.header.stamp.toNSec()));
  for (std::size_t i = 0; i < poses.size(); ++i) poses[i].time = at.times[i];
  return {std::move(poses), ros::Time().fromNSec(static_cast<std::uint64_t>(at.origin)), std::move(at.remark)};
}

std::vector<Curve> toCurves(const MultiDOFJointTrajectory &trajectory, double radius) {
  if (trajectory.joint_names.empty()) throw Error("the trajectory names no joints");
  if (trajectory.points.size() < 2) throw Error("the trajectory has fewer than two points");
  std::vector<double> at;
  for (const auto &point : trajectory.points) {
    at.push_back(point.time_from_start.toSec());
    if (at.size() > 1 && !(at.back() > at[at.size() - 2]))
      throw Error("point " + std::to_string(at.size() - 1) + ": its time is not after that of the point before");
  }

  std::vector<Curve> curves;
  for (std::size_t j = 0; j < trajectory.joint_names.size(); ++j) {
    std::vector<geometry_msgs::Point> points(at.size());
    for (std::size_t i = 0; i < at.size(); ++i) points[i] = toPointMessage(poseOf(trajectory, i, j).position);
    Curve curve;
    curve.header = trajectory.header;
    curve.id = trajectory.joint_names[j];
    curve.radius = radius;
    fitNaturalSpline(points, at, curve);
    curves.push_back(std::move(curve));
  }
  return curves;
}

} // namespace curve_proximity
