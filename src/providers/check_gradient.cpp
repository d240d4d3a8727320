/* SPDX-License-Identifier: BSD-3-Clause */
#include "check_gradient.h"

#include <cmath>
#include <functional>

namespace curve_proximity {
namespace {

constexpr double STEP = 2e-4; /* [m], [rad] and so on */
constexpr const char *AXES[] = {"x", "y", "z"};

/** Changes a case by a step of one of its numbers. */
using Change = std::function<void(ConstraintCase &asked, double step)>;

class Checker {
 public:
  Checker(ProviderSet &providers, const ConstraintCase &asked, const ConstraintRow &given,
          const ResourceOptions &resources, Workspace &workspace)
      : providers_(providers), asked_(asked), given_(given), resources_(resources), workspace_(workspace) {
    asked_.providers = {given.provider};
  }

  GradientCheck run() {
    check_.agrees = true;
    if (asked_.motion)
      checkMotion();
    else
      checkSides();
    return check_;
  }

 private:
  double valueAt(const Change &change, double step) {
    ConstraintCase moved = asked_;
    change(moved, step);
    const ConstraintRow row = answerCase(providers_, moved, resources_, workspace_).front();
    if (row.status < 0) throw Error("a step of " + std::to_string(step) + " has no answer: " + row.message, row.status);
    return row.value.value;
  }

  double slope(const Change &change, double step) {
    return (valueAt(change, step) - valueAt(change, -step)) / (2.0 * step);
  }

  void compare(const std::string &derivative, double gradient, const Change &change) {
    GradientMisfit found;
    found.derivative = derivative;
    found.gradient = gradient;
    found.difference = slope(change, 0.5 * STEP);
    const double size = 1.0 + std::fabs(found.difference);
    found.doubt = std::fabs(found.difference - slope(change, STEP)) / size;
    found.misfit = std::fabs(gradient - found.difference) / size;
    const bool fits = found.misfit <= GRADIENT_TOLERANCE;
    check_.agrees = check_.agrees && fits;
    const bool differs = !(found.misfit <= GRADIENT_TOLERANCE + 4.0 * found.doubt);
    const bool larger = differs == check_.differs && !(found.misfit <= check_.worst.misfit);
    if (check_.count++ == 0 || (differs && !check_.differs) || larger) check_.worst = found;
    check_.differs = check_.differs || differs;
  }

  void checkSide(const char *name, const ConstraintGradient &gradient, ObjectDescription ConstraintCase::*side) {
    for (int i = 0; i < 3; ++i) {
      compare(std::string(name) + " linear " + AXES[i], gradient.linear[i],
              [&](ConstraintCase &moved, double step) { (moved.*side).pose.translation()[i] += step; });
      compare(std::string(name) + " angular " + AXES[i], gradient.angular[i], [&](ConstraintCase &moved, double step) {
        Eigen::Isometry3d &pose = (moved.*side).pose;
        pose.linear() = Eigen::AngleAxisd(step, Eigen::Vector3d::Unit(i)) * pose.linear();
      });
    }
  }

  void checkSides() {
    const ConstraintValue &value = given_.value;
    checkSide("b", value.b, &ConstraintCase::b);
    if (!asked_.curve) {
      checkSide("a", value.a, &ConstraintCase::a);
      return;
    }
    checkCurve(*asked_.curve, value);
    /* the curve as a whole moves, and turns about the origin */
    for (int i = 0; i < 3; ++i) {
      const auto step_by = [i](ConstraintCase &moved, double along, double angle) {
        Eigen::Isometry3d by = Eigen::Isometry3d::Identity();
        by.translation()[i] = along;
        by.linear() = Eigen::AngleAxisd(angle, Eigen::Vector3d::Unit(i)).toRotationMatrix();
        moved.curve->pose = by * moved.curve->pose.value_or(Eigen::Isometry3d::Identity());
      };
      compare(std::string("curve linear ") + AXES[i], value.a.linear[i],
              [&](ConstraintCase &moved, double step) { step_by(moved, step, 0.0); });
      compare(std::string("curve angular ") + AXES[i], value.a.angular[i],
              [&](ConstraintCase &moved, double step) { step_by(moved, 0.0, step); });
    }
    if (asked_.curve->radius > STEP)
      compare("radius", value.radius, [](ConstraintCase &moved, double step) { moved.curve->radius += step; });
  }

  /* By the numbers that define the curve. Points move along the axes of their own frame: those of a Dubins path stay in
   * its plane. */
  void checkCurve(const CurveDescription &curve, const ConstraintValue &value) {
    const Eigen::Matrix3d frame = curve.pose.value_or(Eigen::Isometry3d::Identity()).linear();
    const bool is_planar = curve.basis.rfind("dubins", 0) == 0;
    for (Eigen::Index k = 0; k < value.points.cols(); ++k)
      for (int i = 0; i < (is_planar ? 2 : 3); ++i)
        compare("point " + std::to_string(k) + ' ' + AXES[i], frame.col(i).dot(value.points.col(k)),
                [&](ConstraintCase &moved, double step) { moved.curve->points(i, k) += step; });
    for (Eigen::Index k = 0; k < value.parameters.size(); ++k)
      compare("parameter " + std::to_string(k), value.parameters[k], [&](ConstraintCase &moved, double step) {
        moved.curve->parameters[static_cast<std::size_t>(k)] += step;
      });
    /* the other bases are reparametrised by their range, or have none of their own */
    if (curve.basis != "clothoid" && curve.basis != "involute") return;
    const bool restricts = curve.restrict_t0 != 0.0 || curve.restrict_t1 != 0.0;
    compare("range start", value.range_start, [&](ConstraintCase &moved, double step) {
      (restricts ? moved.curve->restrict_t0 : moved.curve->t0) += step;
    });
    compare("range end", value.range_end, [&](ConstraintCase &moved, double step) {
      (restricts ? moved.curve->restrict_t1 : moved.curve->t1) += step;
    });
  }

  void checkList(const char *name, const Eigen::MatrixXd &gradient, std::vector<double> TrajectoryPoint::*list) {
    const TrajectoryDescription &trajectory = asked_.motion->trajectory;
    if (gradient.size() > 0 && (static_cast<std::size_t>(gradient.rows()) != trajectory.points.size() ||
                                static_cast<std::size_t>(gradient.cols()) != trajectory.joints.size()))
      throw Error("the gradient by each " + std::string(name) + " is " + std::to_string(gradient.rows()) + " by " +
                  std::to_string(gradient.cols()) + ", not points by joints");
    if (gradient.size() == 0) return;
    for (std::size_t i = 0; i < trajectory.points.size(); ++i) {
      if ((trajectory.points[i].*list).empty()) continue;
      for (std::size_t k = 0; k < trajectory.joints.size(); ++k)
        compare(std::string(name) + ' ' + std::to_string(i) + ' ' + trajectory.joints[k],
                gradient(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k)),
                [&](ConstraintCase &moved, double step) { (moved.motion->trajectory.points[i].*list)[k] += step; });
    }
  }

  /* Of the least of all values. Without a row all derivatives are 0. */
  void checkMotion() {
    MotionRow row;
    row.positions = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(asked_.motion->trajectory.points.size()),
                                          static_cast<Eigen::Index>(asked_.motion->trajectory.joints.size()));
    if (!given_.motion->rows.empty()) row = given_.motion->rows.front();
    checkList("position", row.positions, &TrajectoryPoint::positions);
    checkList("velocity", row.velocities, &TrajectoryPoint::velocities);
    checkList("acceleration", row.accelerations, &TrajectoryPoint::accelerations);
    const TrajectoryDescription &asked = asked_.motion->trajectory;
    const bool spline = asked.degree > 0;
    const double start = spline ? asked.knots[asked.degree] : asked.points.front().time;
    const double duration = (spline ? asked.knots[asked.points.size()] : asked.points.back().time) - start;
    if (!(duration > 10.0 * STEP)) return;
    compare("duration", row.duration, [&](ConstraintCase &moved, double step) {
      const auto stretch = [&](double time) { return start + (time - start) * ((duration + step) / duration); };
      for (TrajectoryPoint &point : moved.motion->trajectory.points) point.time = stretch(point.time);
      for (double &knot : moved.motion->trajectory.knots) knot = stretch(knot);
    });
  }

  ProviderSet &providers_;
  ConstraintCase asked_;
  const ConstraintRow &given_;
  const ResourceOptions &resources_;
  Workspace &workspace_;
  GradientCheck check_;
};

} // namespace

GradientCheck checkGradient(ProviderSet &providers, const ConstraintCase &asked, const ConstraintRow &given,
                            const ResourceOptions &resources, Workspace &workspace) {
  GradientCheck none;
  if (!given.value.valid) {
    none.reason = "the gradient is not valid: " + given.message;
    return none;
  }
  return Checker(providers, asked, given, resources, workspace).run();
}

} // namespace curve_proximity
