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

constexpr double CURVE_WIDTH = 0.006; /* [m] */
constexpr int HALVINGS = 10;
constexpr int TUBE_SIDES = 16;
constexpr double LABEL_ABOVE = 0.1, LABEL_HEIGHT = 0.05; /* [m] */

/** Two unit vectors across each point of a polyline, carried along it without turning about it. */
std::vector<std::pair<Eigen::Vector3d, Eigen::Vector3d>> framesAlong(const std::vector<Eigen::Vector3d> &points) {
  std::vector<std::pair<Eigen::Vector3d, Eigen::Vector3d>> frames;
  Eigen::Vector3d along = Eigen::Vector3d::UnitX(), across = Eigen::Vector3d::UnitZ();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d chord = points[std::min(i + 1, points.size() - 1)] - points[i > 0 ? i - 1 : 0];
    if (chord.norm() > 0.0) {
      const Eigen::Vector3d next = chord.normalized();
      across = i == 0 ? next.unitOrthogonal() : Eigen::Vector3d(rotationBetween(along, next) * across);
      along = next;
    }
    frames.emplace_back(across, along.cross(across));
  }
  return frames;
}

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

/** Appends the control points of [a, b], where joints of pieces lie inside those of halves without one. What is left
 * about a joint after so many halvings is too short to be seen. */
void addControlPoints(const cprox_curve *curve, double a, double b, int halvings, std::size_t degree,
                      std::vector<cprox_vec3> &points) {
  std::vector<cprox_vec3> own(degree + 1);
  if (cprox_curve_control_points(curve, a, b, nullptr, own.data()) == CPROX_OK) {
    points.insert(points.end(), own.begin(), own.end());
  } else if (halvings > 0) {
    addControlPoints(curve, a, 0.5 * (a + b), halvings - 1, degree, points);
    addControlPoints(curve, 0.5 * (a + b), b, halvings - 1, degree, points);
  }
}

/** The convex hull of some control points, blown up to be seen. */
void addHull(Canvas &canvas, const std::vector<cprox_vec3> &points, double radius) {
  Eigen::Matrix3Xd all(3, static_cast<Eigen::Index>(6 * points.size()));
  Eigen::Index column = 0;
  const double r = std::max(radius, CURVE_WIDTH);
  for (const cprox_vec3 &p : points) {
    for (int axis = 0; axis < 3; ++axis) {
      for (const double side : {-r, r}) all.col(column++) = toEigen(p) + side * Eigen::Vector3d::Unit(axis);
    }
  }
  ShapeDescription hull;
  hull.type = ShapeType::POLYTOPE;
  canvas.addShape("open", hull, makePolytope(all), {}, Eigen::Isometry3d::Identity(), colour(0.95, 0.55, 0.1, 0.35));
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
  Marker &tube = canvas.add(space, Marker::TRIANGLE_LIST);
  tube.color = colour(1, 1, 1, 1);
  const auto frames = framesAlong(points);
  const double r = std::max(radius, 0.5 * CURVE_WIDTH);
  const auto corner = [&](std::size_t i, int k) {
    const double angle = 2.0 * M_PI * k / TUBE_SIDES;
    const Eigen::Vector3d out = std::cos(angle) * frames[i].first + std::sin(angle) * frames[i].second;
    tube.points.push_back(toPointMessage(toVec3(points[i] + r * out)));
    tube.colors.push_back(shaded(tints[i], out));
  };
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    for (int k = 0; k < TUBE_SIDES; ++k) {
      corner(i, k);
      corner(i + 1, k);
      corner(i + 1, k + 1);
      corner(i, k);
      corner(i + 1, k + 1);
      corner(i, k + 1);
    }
  }

  // Rounded ends.
  if (points.empty()) return;
  for (const std::size_t end : {std::size_t{0}, points.size() - 1}) {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.translation() = points[end];
    Marker &ball = canvas.add(space, Marker::SPHERE, pose);
    ball.color = tints[end];
    setScale(ball, 2 * r, 2 * r, 2 * r);
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

void addPair(Canvas &canvas, const Answer &answer) {
  const cprox_result &result = answer.result;
  const bool apart = result.upper > 0.0 || result.lower > 0.0;
  if (result.status < 0 || answer.b.empty() || !std::isfinite(result.upper)) return;
  const std_msgs::ColorRGBA tint = apart ? colour(0.12, 0.12, 0.14, 1.0) : clearanceColour(0.0);
  Marker &line = canvas.add("pairs", Marker::LINE_LIST);
  setScale(line, CURVE_WIDTH, 0.0, 0.0);
  line.color = tint;
  line.points = {toPointMessage(result.witness_mover), toPointMessage(result.witness_obstacle)};
  for (const cprox_vec3 &end : {result.witness_mover, result.witness_obstacle}) {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.translation() = toEigen(end);
    Marker &ball = canvas.add("pairs", Marker::SPHERE, pose);
    setScale(ball, 3 * CURVE_WIDTH, 3 * CURVE_WIDTH, 3 * CURVE_WIDTH);
    ball.color = tint;
  }

  char text[64];
  std::snprintf(text, sizeof text, "%.1f mm", 1e3 * result.upper);
  Eigen::Isometry3d middle = Eigen::Isometry3d::Identity();
  middle.translation() =
      0.5 * (toEigen(result.witness_mover) + toEigen(result.witness_obstacle)) + LABEL_ABOVE * Eigen::Vector3d::UnitZ();
  Marker &label = canvas.add("labels", Marker::TEXT_VIEW_FACING, middle);
  setScale(label, 0.0, 0.0, LABEL_HEIGHT);
  label.color = colour(0.1, 0.1, 0.12, 1.0);
  label.text = text;
}

/* ---- what is open ---- */

bool isOpen(const Answer &answer, QueryType query_type) {
  const cprox_status status = answer.result.status;
  const bool undecided =
      status >= 0 && query_type != QueryType::DISTANCE && answer.result.verdict == CPROX_VERDICT_UNDECIDED;
  return undecided || status == CPROX_BUDGET || status == CPROX_STOPPED;
}

void addOpenHulls(Canvas &canvas, const Drawing &drawing, const Drawing::Line &line, const Answer &answer) {
  const cprox_curve *curve = line.curve.curve.get();
  const cprox_curve_info info = cprox_curve_get_info(curve);
  const std::size_t degree = info.degree;
  if (degree == 0) return; // known by its arc length: it has no control points
  constexpr std::size_t INTERVALS = 48;
  constexpr std::uint32_t NODES = 4; /* for each of them and each target */
  const Targets all(drawing.snapshot, drawing.links, Query{});
  const std::vector<cprox_obstacle> targets = coreTargets(all);
  std::vector<double> breaks;
  for (std::size_t i = 0; i <= INTERVALS; ++i) breaks.push_back(sampleAt({info.t0, info.t1}, i, INTERVALS));

  Workspace workspace;
  std::vector<cprox_profile_interval> intervals(INTERVALS);
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.epsilon = 1e-4;
  options.max_nodes = NODES;
  ObstaclesHandle obstacles;
  if (makeObstacles(targets, CPROX_INDEX_NONE, workspace, obstacles) < 0 ||
      cprox_obstacles_profile(obstacles.get(), cprox_tube_along(curve, line.curve.reach), breaks.data(), INTERVALS,
                              answer.result.upper, &options, workspace.get(), intervals.data()) < 0)
    return;
  for (const cprox_profile_interval &interval : intervals) {
    // Nearer than the best point that is known: the least distance may be here.
    if (interval.lower > answer.result.upper) continue;
    std::vector<cprox_vec3> points;
    addControlPoints(curve, interval.t0, interval.t1, HALVINGS, degree, points);
    addHull(canvas, points, line.curve.reach);
  }
}

} // namespace curve_proximity
