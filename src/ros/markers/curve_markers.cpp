/* SPDX-License-Identifier: BSD-3-Clause */
#include "markers/curve_markers.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "messages/geometry_message.h"

namespace curve_proximity {
namespace {

using visualization_msgs::Marker;

constexpr double CURVE_WIDTH = 0.006;                    /* [m] */
constexpr double LABEL_ABOVE = 0.1, LABEL_HEIGHT = 0.05; /* [m] */

/** So many points of a curve, both ends among them. */
std::vector<Eigen::Vector3d> samplesOf(const cprox_curve *curve, std::size_t n) {
  const cprox_curve_info info = cprox_curve_get_info(curve);
  std::vector<Eigen::Vector3d> out;
  for (std::size_t i = 0; i < n; ++i) {
    cprox_vec3 point;
    if (cprox_curve_evaluate(curve, sampleAt({info.t0, info.t1}, i, n - 1), nullptr, &point, nullptr, nullptr) ==
        CPROX_OK)
      out.push_back(toEigen(point));
  }
  return out;
}

} // namespace

double clearance(const cprox_vec3 &centre, double radius, const StandingBodies &placed) {
  double least = std::numeric_limits<double>::infinity();
  for (const StandingBody &p : placed) {
    const double d = cprox_body_nearest(p.body, toVec3(p.pose.inverse() * toEigen(centre)), nullptr);
    least = std::min(least, d - radius - p.padding);
  }
  return least;
}

/* ---- curves ---- */

void addTube(Canvas &canvas, const std::string &space, const std::vector<Eigen::Vector3d> &points,
             const std::vector<std_msgs::ColorRGBA> &tints, double radius) {
  const double width = std::max(2.0 * radius, CURVE_WIDTH);
  for (const int type : {Marker::LINE_STRIP, Marker::SPHERE_LIST}) { // the balls round off its joints and its ends
    const double across = type == Marker::SPHERE_LIST ? width : 0.0;
    Marker &marker = canvas.add(space, type, {width, across, across}, colour(1, 1, 1, 1));
    for (const Eigen::Vector3d &point : points) marker.points.push_back(toPointMessage(toVec3(point)));
    marker.colors = tints;
  }
}

void addObstacleCurve(Canvas &canvas, const Geometry &geometry, const Eigen::Isometry3d &pose, double padding) {
  constexpr std::size_t SAMPLES = 101;
  std::vector<Eigen::Vector3d> points = samplesOf(geometry.curve.get(), SAMPLES);
  for (Eigen::Vector3d &point : points) point = pose * point;
  const std::vector<std_msgs::ColorRGBA> tints(points.size(), colour(0.55, 0.6, 0.66, 1.0));
  addTube(canvas, "scene", points, tints, geometry.radius + padding);
}

void addCurve(Canvas &canvas, const CompiledCurve &curve, const StandingBodies &placed, std::size_t samples) {
  const std::vector<Eigen::Vector3d> points = samplesOf(curve.curve.get(), samples);
  std::vector<std_msgs::ColorRGBA> tints;
  for (const Eigen::Vector3d &point : points)
    tints.push_back(clearanceColour(clearance(toVec3(point), curve.reach, placed)));
  addTube(canvas, "curves", points, tints, curve.reach);
}

/* ---- pairs ---- */

const Answer *nearestOf(const std::vector<Answer> &answers) {
  const Answer *nearest = nullptr;
  for (const Answer &answer : answers) {
    const bool measured = answer.result.status >= 0 && !answer.b.empty() && std::isfinite(answer.result.upper);
    if (measured && (!nearest || answer.result.upper < nearest->result.upper)) nearest = &answer;
  }
  return nearest;
}

void addPair(Canvas &canvas, const Answer &answer) {
  const cprox_result &result = answer.result;
  const bool apart = result.upper > 0.0 || result.lower > 0.0;
  const std_msgs::ColorRGBA tint = apart ? colour(0.12, 0.12, 0.14, 1.0) : clearanceColour(0.0);
  canvas.add("pairs", Marker::LINE_LIST, {CURVE_WIDTH, 0.0, 0.0}, tint).points = {
      toPointMessage(result.witness_mover), toPointMessage(result.witness_obstacle)};
  const Eigen::Vector3d ends[] = {toEigen(result.witness_mover), toEigen(result.witness_obstacle)};
  for (const Eigen::Vector3d &end : ends)
    canvas.add("pairs", Marker::SPHERE, Eigen::Vector3d::Constant(3 * CURVE_WIDTH), tint,
               Eigen::Isometry3d(Eigen::Translation3d(end)));

  char text[64];
  std::snprintf(text, sizeof text, "%.1f mm", 1e3 * result.upper);
  const Eigen::Vector3d above = 0.5 * (ends[0] + ends[1]) + LABEL_ABOVE * Eigen::Vector3d::UnitZ();
  const std_msgs::ColorRGBA ink = colour(0.1, 0.1, 0.12, 1.0);
  const Eigen::Isometry3d pose(Eigen::Translation3d{above});
  canvas.add("labels", Marker::TEXT_VIEW_FACING, {0.0, 0.0, LABEL_HEIGHT}, ink, pose).text = text;
}

} // namespace curve_proximity
