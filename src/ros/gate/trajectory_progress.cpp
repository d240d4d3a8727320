/* SPDX-License-Identifier: BSD-3-Clause */
#include "gate/trajectory_progress.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <utility>

#include "../../scene/robot/urdf_document.h"

namespace curve_proximity {
namespace {

using trajectory_msgs::JointTrajectoryPoint;

constexpr double SLACK = 0.1; /* [s] that a message may have been on its way */

struct PositionRange {
  double least, most;
  void add(double value) {
    least = std::min(least, value), most = std::max(most, value);
  }
};

double at(const std::vector<double> &values, std::size_t joint) {
  return joint < values.size() ? values[joint] : 0.0;
}

/** Where a joint can be between two points: the range of the Bézier points of what controllers put between them. */
PositionRange rangeBetween(const JointTrajectoryPoint &a, const JointTrajectoryPoint &b, std::size_t joint) {
  const double p = at(a.positions, joint), q = at(b.positions, joint);
  const double h = (b.time_from_start - a.time_from_start).toSec();
  PositionRange range = {std::min(p, q), std::max(p, q)};
  if (a.velocities.empty() || b.velocities.empty() || h <= 0.0) return range;
  const double v = h * at(a.velocities, joint), w = h * at(b.velocities, joint);
  range.add(p + v / 3.0), range.add(q - w / 3.0);
  if (a.accelerations.empty() || b.accelerations.empty()) return range;
  range.add(p + v / 5.0), range.add(p + 2.0 * v / 5.0 + h * h * at(a.accelerations, joint) / 20.0);
  range.add(q - w / 5.0), range.add(q - 2.0 * w / 5.0 + h * h * at(b.accelerations, joint) / 20.0);
  return range;
}

/** How far a value is from a range; of a continuous joint, up to full turns. */
double distanceTo(const PositionRange &range, double value, bool continuous) {
  constexpr double TURN = 2.0 * M_PI;
  if (continuous) value += TURN * std::round((0.5 * (range.least + range.most) - value) / TURN);
  return std::max({range.least - value, value - range.most, 0.0});
}

} // namespace

std::set<std::string> continuousJoints(const std::string &urdf) {
  std::set<std::string> out;
  const UrdfDocument document = readUrdf(urdf);
  for (const auto &[name, joint] : document.model->joints_)
    if (joint->type == urdf::Joint::CONTINUOUS) out.insert(name);
  return out;
}

TrajectoryProgress::TrajectoryProgress(trajectory_msgs::JointTrajectory trajectory, double tolerance,
                                       const std::set<std::string> &continuous)
    : trajectory_(std::move(trajectory)), tolerance_(tolerance) {
  for (const std::string &joint : trajectory_.joint_names) continuous_.push_back(continuous.count(joint) > 0);
}

double TrajectoryProgress::deviation(std::size_t point, const std::vector<double> &joints, std::size_t &worst) const {
  const auto &points = trajectory_.points;
  const JointTrajectoryPoint &next = points[std::min(point + 1, points.size() - 1)];
  double most = 0.0;
  for (std::size_t j = 0; j < joints.size(); ++j) {
    const double far = distanceTo(rangeBetween(points[point], next, j), joints[j], continuous_[j]);
    if (far > most) most = far, worst = j;
  }
  return most;
}

std::string TrajectoryProgress::tell(const std::vector<std::string> &names, const std::vector<double> &positions,
                                     double elapsed) {
  std::vector<double> joints;
  for (const std::string &joint : trajectory_.joint_names) {
    const auto found = std::find(names.begin(), names.end(), joint);
    const auto index = static_cast<std::size_t>(found - names.begin());
    if (index >= std::min(names.size(), positions.size()) || !std::isfinite(positions[index]))
      return "where joint '" + joint + "' is was not told";
    joints.push_back(positions[index]);
  }

  const auto &points = trajectory_.points;
  const std::size_t last = points.size() - 1;
  const double latest = latest_ + elapsed;
  double least = std::numeric_limits<double>::infinity(), end = 0.0;
  std::size_t joint = 0, first = points.size();
  for (std::size_t i = point_; i < std::max<std::size_t>(last, 1); ++i) {
    if (i > point_ && points[i].time_from_start.toSec() > latest + SLACK) break;
    std::size_t worst = 0;
    const double far = deviation(i, joints, worst);
    if (far < least) least = far, joint = worst;
    if (far > tolerance_) continue;
    first = std::min(first, i);
    end = points[std::min(i + 1, last)].time_from_start.toSec();
  }
  if (first < points.size()) {
    std::size_t unused;
    point_ = first;
    latest_ = std::min(latest, end);
    at_end_ = first + 1 >= last && deviation(last, joints, unused) <= tolerance_;
    return "";
  }
  std::ostringstream text;
  text.precision(4);
  text << "the robot is not on the trajectory: joint '" << trajectory_.joint_names[joint] << "' at " << joints[joint]
       << " is " << least << " away from it, more than ~path_tolerance = " << tolerance_;
  return text.str();
}

} // namespace curve_proximity
