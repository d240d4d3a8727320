/* SPDX-License-Identifier: BSD-3-Clause */
/** The way of an arm as a cubic B-spline of its joints, for optimisers: its trajectory, its jerk, its limits, and the
 * files that it begins with. */
#ifndef CURVE_PROXIMITY_EXAMPLES_ARM_SPLINE_H
#define CURVE_PROXIMITY_EXAMPLES_ARM_SPLINE_H

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <curve_proximity/motion.hpp>

#include "../src/scene/yaml/scene_change.h"

namespace curve_proximity {

/* ---- the spline ---- */

constexpr int kSpans = 10;
constexpr double kDuration = 5.0; /* [s] */

/* Uniform cubic B-splines with the first and the last three control points alike begin and end at rest. A row a control
 * point, a column a joint. */
constexpr int kControls = kSpans + 3, kInner = kControls - 6;
constexpr double kStep = kDuration / kSpans;

/* The numbers of the spline at its knots are weighted control points: exactly a trajectory of cubic segments. */
struct Weights {
  double position[3] = {1.0 / 6.0, 4.0 / 6.0, 1.0 / 6.0};
  double velocity[3] = {-0.5 / kStep, 0.0, 0.5 / kStep};
};

inline TrajectoryDescription trajectoryOf(const std::vector<std::string> &joints, const Eigen::MatrixXd &control) {
  const Weights weights;
  TrajectoryDescription out;
  out.joints = joints;
  for (int knot = 0; knot <= kSpans; ++knot) {
    Eigen::RowVectorXd position = Eigen::RowVectorXd::Zero(control.cols()), velocity = position;
    for (int k = 0; k < 3; ++k) {
      position += weights.position[k] * control.row(knot + k);
      velocity += weights.velocity[k] * control.row(knot + k);
    }
    TrajectoryPoint point;
    point.time = knot * kStep;
    point.positions.assign(position.data(), position.data() + position.size());
    point.velocities.assign(velocity.data(), velocity.data() + velocity.size());
    out.points.push_back(std::move(point));
  }
  return out;
}

/* The gradient by control points, from that by positions and velocities at the knots. */
template <typename Row> /* MotionRow, ClearanceGradient */
Eigen::MatrixXd byControls(const Row &row) {
  const Weights weights;
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(kControls, row.positions.cols());
  for (int knot = 0; knot <= kSpans; ++knot)
    for (int k = 0; k < 3; ++k)
      out.row(knot + k) +=
          weights.position[k] * row.positions.row(knot) + weights.velocity[k] * row.velocities.row(knot);
  return out;
}

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/* The first and the last three control points stay; what lies between are the variables. */
inline Eigen::MatrixXd withInner(const Eigen::MatrixXd &control, const double *x) {
  Eigen::MatrixXd out = control;
  out.middleRows(3, kInner) = Eigen::Map<const RowMajor>(x, kInner, out.cols());
  return out;
}

inline void putInner(const Eigen::MatrixXd &by_controls, double *gradient) {
  Eigen::Map<RowMajor>(gradient, kInner, by_controls.cols()) = by_controls.middleRows(3, kInner);
}

/* The integral of the squared third derivative, which is constant on each span; the times are left out. */
inline double squaredJerk(const Eigen::MatrixXd &control, Eigen::MatrixXd &by_controls) {
  by_controls = Eigen::MatrixXd::Zero(control.rows(), control.cols());
  double sum = 0.0;
  for (int i = 0; i < kSpans; ++i) {
    const Eigen::RowVectorXd third =
        control.row(i + 3) - 3.0 * control.row(i + 2) + 3.0 * control.row(i + 1) - control.row(i);
    sum += third.squaredNorm();
    by_controls.row(i + 3) += 2.0 * third;
    by_controls.row(i + 2) -= 6.0 * third;
    by_controls.row(i + 1) += 6.0 * third;
    by_controls.row(i) -= 2.0 * third;
  }
  return sum;
}

/* The joint limits, for all variables: a B-spline stays within those of its control points. */
inline void limitsOf(const Robot &robot, const std::vector<std::string> &joints, std::vector<double> &lower,
                     std::vector<double> &upper) {
  for (int i = 0; i < kInner; ++i)
    for (const std::string &name : joints)
      for (const Robot::Joint &joint : robot.joints()) {
        if (joint.name != name) continue;
        lower.push_back(joint.lower);
        upper.push_back(joint.upper);
      }
}

/* ---- files ---- */

inline std::string readText(const std::string &path) {
  std::ifstream file(path);
  if (!file) throw Error(path + " cannot be read");
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

inline SnapshotPtr readScene(const std::string &urdf, const Srdf &srdf, const std::string &path) {
  RobotOptions options;
  options.resources.base_dir = yaml::folderOf(urdf);
  yaml::Warnings warnings;
  Scene scene(Robot::fromUrdf(readText(urdf), options), {}, allowedPairs(srdf));
  for (const std::string &fault : scene.apply(yaml::toChange(yaml::readScene(path, warnings), path, warnings)))
    throw Error(fault);
  return scene.snapshot();
}

/* A planner's path, and the values of joints that it does not move. */
inline TrajectoryDescription readPath(const std::string &path, JointPositions &rest) {
  const YAML::Node file = YAML::LoadFile(path);
  TrajectoryDescription out;
  out.joints = file["joint_trajectory"]["joint_names"].as<std::vector<std::string>>();
  if (file["fixed_joints"]) rest = file["fixed_joints"].as<JointPositions>();
  for (const YAML::Node &node : file["joint_trajectory"]["points"]) {
    TrajectoryPoint point;
    point.positions = node["positions"].as<std::vector<double>>();
    point.time = node["time_from_start"].as<double>();
    out.points.push_back(std::move(point));
  }
  checkTrajectory(out);
  return out;
}

/* Control points on straight lines between the path's points, evenly spaced in its time. */
inline Eigen::MatrixXd controlsOf(const TrajectoryDescription &path) {
  Eigen::MatrixXd out(kControls, static_cast<Eigen::Index>(path.joints.size()));
  std::size_t k = 0;
  for (int i = 0; i < kControls; ++i) {
    const double inner = std::clamp((i - 2.0) / (kControls - 5.0), 0.0, 1.0);
    const double t = path.points.front().time + inner * (path.points.back().time - path.points.front().time);
    while (k + 2 < path.points.size() && path.points[k + 1].time < t) ++k;
    const TrajectoryPoint &a = path.points[k], &b = path.points[k + 1];
    const double s = std::clamp((t - a.time) / (b.time - a.time), 0.0, 1.0);
    for (std::size_t j = 0; j < path.joints.size(); ++j)
      out(i, static_cast<Eigen::Index>(j)) = a.positions[j] + s * (b.positions[j] - a.positions[j]);
  }
  return out;
}

} // namespace curve_proximity
#endif
