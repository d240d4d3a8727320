/* SPDX-License-Identifier: BSD-3-Clause */
/** Places of the sides and the curve of a constraint, small steps from there, and the value after a step. */
#ifndef CURVE_PROXIMITY_TEST_PROVIDERS_STEPS_H
#define CURVE_PROXIMITY_TEST_PROVIDERS_STEPS_H

#include <optional>

#include "support.h"

namespace curve_proximity {

/** A small step of everything that a value depends on. */
struct Step {
  Eigen::Vector3d linear_a, angular_a, linear_b, angular_b;
  Eigen::Matrix3Xd points;
  double radius = 0.0;
};

inline cprox_pose moved(const cprox_pose &pose, const Eigen::Vector3d &linear, const Eigen::Vector3d &angular,
                        double h) {
  const Eigen::Vector3d w = h * angular;
  const double angle = w.norm();
  Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();
  if (angle > 0.0) turn = Eigen::Quaterniond(Eigen::AngleAxisd(angle, w / angle));
  const Eigen::Quaterniond q =
      turn * Eigen::Quaterniond(pose.orientation.w, pose.orientation.x, pose.orientation.y, pose.orientation.z);
  return {toVec3(toEigen(pose.position) + h * linear), {q.w(), q.x(), q.y(), q.z()}};
}

struct Case {
  cprox_pose a = CPROX_POSE_IDENTITY, b = CPROX_POSE_IDENTITY;
  std::optional<CurveDescription> curve;
};

/** Of a series only the first coefficient is a point: it alone moves with the curve. */
inline bool isSeries(const CurveDescription &curve) {
  return curve.basis == "polynomial" || curve.basis == "legendre" || curve.basis == "trigonometric";
}

inline double valueAt(const Constraint &constraint, const Case &c, const Step &step, double h, Workspace &workspace,
                      ConstraintValue &value) {
  ConstraintPlace place;
  ConstraintCurve curve;
  place.b = moved(c.b, step.linear_b, step.angular_b, h);
  if (c.curve) {
    // The curve as a whole turns about the origin and moves; its points move by themselves on top.
    curve.description = *c.curve;
    Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
    const Eigen::Vector3d w = h * step.angular_a;
    if (w.norm() > 0.0) turn = Eigen::AngleAxisd(w.norm(), w.normalized()).toRotationMatrix();
    curve.description.points = turn * c.curve->points + h * step.points;
    const Eigen::Index n = isSeries(*c.curve) ? 1 : curve.description.points.cols();
    curve.description.points.leftCols(n).colwise() += h * step.linear_a;
    curve.description.radius += h * step.radius;
    curve.curve = compile(curve.description).curve;
    place.curve = &curve;
  } else {
    place.a = moved(c.a, step.linear_a, step.angular_a, h);
  }
  constraint.evaluate(place, workspace, value);
  return value.value;
}

inline Step randomStep(Random &random, const Case &c, bool planar = false) {
  Step s;
  s.linear_a = random.inCube(1.0), s.angular_a = random.inCube(1.0);
  s.linear_b = random.inCube(1.0), s.angular_b = random.inCube(1.0);
  if (planar) {
    s.linear_a.z() = s.linear_b.z() = 0.0;
    s.angular_a.head<2>().setZero();
    s.angular_b.head<2>().setZero();
  }
  if (c.curve) {
    s.points = Eigen::Matrix3Xd::Random(3, c.curve->points.cols());
    for (Eigen::Index i = 0; i < s.points.cols(); ++i) s.points.col(i) = random.inCube(1.0);
    s.radius = c.curve->radius > 0.0 ? random.uniform(-1.0, 1.0) : 0.0;
  }
  return s;
}

} // namespace curve_proximity
#endif
