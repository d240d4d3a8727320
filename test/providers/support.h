/* SPDX-License-Identifier: BSD-3-Clause */
/** What the tests of the providers share: bodies by type and dimensions, random places, providers by pluginlib. */
#ifndef CURVE_PROXIMITY_TEST_PROVIDERS_SUPPORT_H
#define CURVE_PROXIMITY_TEST_PROVIDERS_SUPPORT_H

#include <gtest/gtest.h>

#include <curve_proximity/geometry.hpp>
#include <curve_proximity/query.hpp>
#include <random>
#include <string>
#include <vector>

#include "constraint_case.h"

namespace curve_proximity {

inline ShapeDescription shape(ShapeType type, std::vector<double> dimensions) {
  ShapeDescription out;
  out.type = type;
  out.dimensions = std::move(dimensions);
  return out;
}

inline ShapeDescription polytope(const Eigen::Matrix3Xd &vertices) {
  ShapeDescription out;
  out.type = ShapeType::POLYTOPE;
  out.vertices = vertices;
  return out;
}

inline ConstraintBody side(const std::vector<ShapeDescription> &shapes, double padding = 0.0) {
  ConstraintBody out;
  for (const ShapeDescription &s : shapes) out.parts.push_back({s, makeGeometry(s).body, 0.0, {}});
  out.padding = padding;
  return out;
}

/** The convex pieces of two unions of boxes, which overlap each other at places. */
inline ConstraintPair unions() {
  ShapeDescription arm = shape(ShapeType::BOX, {0.3, 0.8, 0.6}), foot = shape(ShapeType::BOX, {0.9, 0.25, 0.6});
  arm.pose.translation() = Eigen::Vector3d(-0.3, 0.3, 0.0);
  ConstraintPair pair;
  pair.a = side({arm, foot}, 0.02);
  pair.b = side({shape(ShapeType::CAPSULE, {0.5, 0.2}), shape(ShapeType::ELLIPSOID, {0.5, 0.3, 0.4})});
  return pair;
}

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}

  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine_);
  }
  Eigen::Vector3d inCube(double half) {
    return {uniform(-half, half), uniform(-half, half), uniform(-half, half)};
  }
  Eigen::Vector3d direction() {
    Eigen::Vector3d v;
    do v = inCube(1.0);
    while (v.norm() > 1.0 || v.norm() < 1e-3);
    return v.normalized();
  }
  Eigen::Quaterniond rotation() {
    return Eigen::Quaterniond(Eigen::AngleAxisd(uniform(0.0, M_PI), direction()));
  }
  cprox_pose pose(double half) {
    const Eigen::Quaterniond q = rotation();
    return {toVec3(inCube(half)), {q.w(), q.x(), q.y(), q.z()}};
  }

 private:
  std::mt19937 engine_;
};

/** One provider, loaded as others would load it. */
class Loaded {
 public:
  Loaded(const std::string &type, const ParameterMap &parameters) : set_({{"it", type, parameters}}) {
    if (!provider()) throw Error(set_.all().front().failure);
  }
  const ConstraintProvider *provider() const {
    return set_.all().front().provider.get();
  }
  const ConstraintProvider *operator->() const {
    return provider();
  }

 private:
  ProviderSet set_;
};

} // namespace curve_proximity
#endif
