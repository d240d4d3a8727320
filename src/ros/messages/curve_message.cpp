/* SPDX-License-Identifier: BSD-3-Clause */
#include "messages/curve_message.h"

#include <algorithm>

#include "../../scene/motion/curve_basis.h"
#include "messages/geometry_message.h"

namespace curve_proximity {
namespace {

/** A coefficient that is not a point of the curve turns, and does not move: all but the first of a series. */
bool isSeries(const std::string &basis) {
  return basis == "polynomial" || basis == "legendre" || basis == "trigonometric";
}

/** What a curve and a piece have in common. */
template <typename Message>
void fillBasis(const Message &curve, CurveDescription &out) {
  out.basis = curve.basis;
  out.degree = curve.degree;
  out.t0 = curve.t0;
  out.t1 = curve.t1;
  fillPoints(curve.points, out.points);
  out.knots = curve.knots;
  out.parameters = curve.parameters;
  takeWholeRange(out);
}

/** What a curve and a piece have in common. */
template <class Message>
void fillMessage(const CurveDescription &curve, Message &message) {
  message.basis = curve.basis;
  message.degree = static_cast<std::uint32_t>(curve.degree);
  if (!hasOwnRange(curve.basis)) message.t0 = curve.t0, message.t1 = curve.t1;
  message.points = toPointMessages(curve.points);
  message.knots = curve.knots;
  message.parameters = curve.parameters;
}

} // namespace

CurveDescription toDescription(const Curve &curve, const Eigen::Isometry3d &frame_in_fixed) {
  CurveDescription out;
  toDescription(curve, frame_in_fixed, out);
  return out;
}

void toDescription(const Curve &curve, const Eigen::Isometry3d &frame_in_fixed, CurveDescription &out) {
  fillBasis(curve, out);
  out.id = curve.id;
  out.radius = curve.radius;
  out.radius_polynomial = curve.radius_polynomial;
  out.restrict_t0 = curve.restrict_t0;
  out.restrict_t1 = curve.restrict_t1;
  out.pieces.resize(curve.pieces.size());
  for (std::size_t i = 0; i < out.pieces.size(); ++i) fillBasis(curve.pieces[i], out.pieces[i]);
  out.pose.reset();

  // The identity leaves the points to the last bit as they are.
  if (frame_in_fixed.matrix().isIdentity(0.0)) return;
  if (isNamedBasis(out.basis) || out.basis == Curve::PIECEWISE) { // its points do not say where it is
    out.pose = frame_in_fixed;
    return;
  }
  out.points = frame_in_fixed.linear() * out.points;
  const Eigen::Index moved = isSeries(out.basis) ? std::min<Eigen::Index>(1, out.points.cols()) : out.points.cols();
  out.points.leftCols(moved).colwise() += frame_in_fixed.translation();
}

Curve toMessage(const CurveDescription &curve) {
  if (curve.pose) throw Error("curve '" + curve.id + "' has a pose of its own, which no message has");
  Curve message;
  fillMessage(curve, message);
  message.id = curve.id;
  message.radius = curve.radius;
  message.radius_polynomial = curve.radius_polynomial;
  message.restrict_t0 = curve.restrict_t0;
  message.restrict_t1 = curve.restrict_t1;
  message.pieces.resize(curve.pieces.size());
  for (std::size_t i = 0; i < curve.pieces.size(); ++i) fillMessage(curve.pieces[i], message.pieces[i]);
  return message;
}

} // namespace curve_proximity
