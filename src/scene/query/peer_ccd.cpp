/* SPDX-License-Identifier: BSD-3-Clause */
#include <cmath>

#include <ccd/ccd.h>

#include "peers.h"

namespace curve_proximity {
namespace {

/* What libccd's callbacks are given. */
struct Inflated {
  const Piece &piece;
  double margin;
};

Eigen::Vector3d signsOf(const Eigen::Vector3d &v) {
  return v.unaryExpr([](double x) { return x < 0.0 ? -1.0 : 1.0; });
}

/* The point of a disc about z that is farthest along u. */
Eigen::Vector3d onDisc(const Eigen::Vector3d &u, double radius, double z) {
  const double length = u.head<2>().norm();
  if (!(length > 0.0)) return {radius, 0.0, z};
  return {radius * u.x() / length, radius * u.y() / length, z};
}

/* In the piece's frame. Capsules and spheres are their cores: their radius is a margin. */
Eigen::Vector3d support(const Piece &piece, const Eigen::Vector3d &u) {
  const Eigen::Vector3d &size = piece.size;
  const double end = u.z() < 0.0 ? -0.5 * size.x() : 0.5 * size.x(); /* of what has a height */
  switch (piece.type) {
    case ShapeType::BOX: return 0.5 * signsOf(u).cwiseProduct(size);
    case ShapeType::CAPSULE: return {0.0, 0.0, end};
    case ShapeType::CYLINDER: return onDisc(u, size.y(), end);
    case ShapeType::CONE: {
      const Eigen::Vector3d apex(0.0, 0.0, 0.5 * size.x()), rim = onDisc(u, size.y(), -0.5 * size.x());
      return apex.dot(u) > rim.dot(u) ? apex : rim;
    }
    case ShapeType::ELLIPSOID: {
      const Eigen::Vector3d scaled = size.cwiseProduct(u);
      const double length = scaled.norm();
      return length > 0.0 ? Eigen::Vector3d(size.cwiseProduct(scaled) / length) : Eigen::Vector3d::Zero();
    }
    case ShapeType::POLYTOPE: {
      Eigen::Index best = 0;
      (u.transpose() * piece.vertices).maxCoeff(&best);
      return piece.vertices.col(best);
    }
    default: return Eigen::Vector3d::Zero();
  }
}

double roundness(const Piece &piece) {
  if (piece.type == ShapeType::SPHERE) return piece.size.x();
  return piece.type == ShapeType::CAPSULE ? piece.size.y() : 0.0;
}

void toCcd(const Eigen::Vector3d &v, ccd_vec3_t *out) {
  for (int i = 0; i < 3; ++i) out->v[i] = static_cast<ccd_real_t>(v[i]);
}

void supportOf(const void *object, const ccd_vec3_t *direction, ccd_vec3_t *out) {
  const auto &shape = *static_cast<const Inflated *>(object);
  const Eigen::Vector3d u(direction->v[0], direction->v[1], direction->v[2]);
  const double length = u.norm();
  Eigen::Vector3d point = shape.piece.pose * support(shape.piece, shape.piece.pose.linear().transpose() * u);
  if (length > 0.0) point += (shape.margin + roundness(shape.piece)) / length * u;
  toCcd(point, out);
}

void centreOf(const void *object, ccd_vec3_t *out) {
  toCcd(static_cast<const Inflated *>(object)->piece.centre, out);
}

bool meet(const Piece &a, const Piece &b, double margin) {
  ccd_t ccd;
  CCD_INIT(&ccd);
  ccd.support1 = ccd.support2 = supportOf;
  ccd.center1 = ccd.center2 = centreOf;
  ccd.max_iterations = 1000;
  ccd.mpr_tolerance = static_cast<ccd_real_t>(1e-12);
  const Inflated one{a, margin}, other{b, 0.0};
  return ccdMPRIntersect(&one, &other, &ccd) != 0;
}

} // namespace

double ccdDistance(const Piece &a, const Piece &b, double limit) {
  constexpr double WIDTH = 1e-9; /* [m] of the bracket */
  double low = 0.0, high = std::min(limit, (a.centre - b.centre).norm() + 1e-6);
  if (!meet(a, b, high)) return limit;
  if (meet(a, b, 0.0)) return 0.0;
  while (high - low > WIDTH * std::max(1.0, high)) {
    const double middle = 0.5 * (low + high);
    (meet(a, b, middle) ? high : low) = middle;
  }
  return high;
}

} // namespace curve_proximity
