/* SPDX-License-Identifier: BSD-3-Clause */
#include <curve_proximity/trajectory.hpp>

#include <cmath>
#include <set>

namespace curve_proximity {
namespace {

/* One of a point's three lists: all joints, or none where it may be missing. */
void checkList(const TrajectoryDescription &trajectory, std::size_t i, const char *what,
               const std::vector<double> &values, bool needed) {
  const std::string place = "point " + std::to_string(i) + ": ";
  if (values.empty() && !needed) return;
  if (values.size() != trajectory.joints.size()) {
    throw Error(place + "has " + std::to_string(values.size()) + " " + what + " for " +
                std::to_string(trajectory.joints.size()) + " joints");
  }
  for (std::size_t k = 0; k < values.size(); ++k) {
    if (!std::isfinite(values[k])) {
      throw Error(place + "the entry of '" + trajectory.joints[k] + "' in " + what + " is not finite");
    }
  }
}

/* Degree, knots and control points of a B-spline. */
void checkSpline(const TrajectoryDescription &trajectory) {
  const std::size_t n = trajectory.points.size(), degree = trajectory.degree;
  for (std::size_t i = 0; i < n; ++i) checkList(trajectory, i, "positions", trajectory.points[i].positions, true);
  if (n <= degree)
    throw Error("a spline of degree " + std::to_string(degree) + " needs at least " + std::to_string(degree + 1) +
                " control points, got " + std::to_string(n));
  if (trajectory.knots.size() != n + degree + 1)
    throw Error(std::to_string(n) + " control points of degree " + std::to_string(degree) + " need " +
                std::to_string(n + degree + 1) + " knots, got " + std::to_string(trajectory.knots.size()));
}

} // namespace

void adoptBase(const std::vector<VirtualJoint> &joints, TrajectoryDescription &trajectory) {
  for (const VirtualJoint &joint : joints) {
    for (const std::string &name : trajectory.joints) {
      if (trajectory.base.empty() && name.rfind(joint.name + "/", 0) == 0) trajectory.base.push_back(joint);
    }
  }
}

void checkTrajectory(const TrajectoryDescription &trajectory) {
  if (trajectory.joints.empty()) throw Error("the trajectory names no joints");
  if (trajectory.points.empty()) throw Error("the trajectory has no points");
  std::set<std::string> names;
  for (const std::string &joint : trajectory.joints) {
    if (!names.insert(joint).second) throw Error("joint '" + joint + "' is named twice");
  }

  if (trajectory.degree > 0) return checkSpline(trajectory);
  if (!trajectory.knots.empty()) throw Error("a trajectory through waypoints has no knots");
  const Interpolation kind = trajectory.interpolation;
  for (std::size_t i = 0; i < trajectory.points.size(); ++i) {
    const TrajectoryPoint &point = trajectory.points[i];
    checkList(trajectory, i, "positions", point.positions, true);
    checkList(trajectory, i, "velocities", point.velocities,
              kind == Interpolation::CUBIC || kind == Interpolation::QUINTIC);
    checkList(trajectory, i, "accelerations", point.accelerations, kind == Interpolation::QUINTIC);
    if (!std::isfinite(point.time)) throw Error("point " + std::to_string(i) + ": its time is not finite");
    if (i > 0 && !(point.time > trajectory.points[i - 1].time)) {
      throw Error("point " + std::to_string(i) + ": its time " + std::to_string(point.time) + " s is not after point " +
                  std::to_string(i - 1) + " at " + std::to_string(trajectory.points[i - 1].time) + " s");
    }
  }
}

} // namespace curve_proximity
