/* SPDX-License-Identifier: BSD-3-Clause */
#include "report_drawing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "../scene/geometry/surface.h"

namespace curve_proximity::cli {
namespace {

/* All objects together, and all of the robot: what a browser turns without effort. */
constexpr std::size_t kMostTriangles = 40000, kMostOfABody = 2500, kLeastOfABody = 100;
constexpr int kCurveSamples = 200;

/* Ten micrometres: more than a picture shows. */
double rounded(double x) {
  constexpr double kSteps = 1e5;
  return std::round(x * kSteps) / kSteps;
}

void addNumbers(const Eigen::Vector3d &p, std::vector<double> &out) {
  for (const double x : {p.x(), p.y(), p.z()}) out.push_back(rounded(x));
}

/* Adds one body's surface, unless it has none. */
void addBody(const std::string &name, const std::string &kind, const std::string &on, const Surface &surface,
             const Eigen::Isometry3d &pose, Json &bodies) {
  if (surface.triangles.cols() == 0 || !surface.vertices.allFinite()) return;
  std::vector<double> vertices, triangles;
  for (Eigen::Index i = 0; i < surface.vertices.cols(); ++i) addNumbers(pose * surface.vertices.col(i), vertices);
  for (Eigen::Index i = 0; i < surface.triangles.size(); ++i) triangles.push_back(surface.triangles(i));
  bodies.items.push_back(
      Json::mapOf({{"name", name}, {"kind", kind}, {"on", on}, {"vertices", vertices}, {"triangles", triangles}}));
}

/* As [x, y, z, qx, qy, qz, qw], at the end of a list. */
void addPose(const Eigen::Isometry3d &pose, Json &poses) {
  const Eigen::Quaterniond q(pose.linear());
  std::vector<double> out;
  addNumbers(pose.translation(), out);
  for (const double x : {q.x(), q.y(), q.z(), q.w()}) out.push_back(rounded(x));
  poses.kind = Json::Kind::LIST;
  poses.items.emplace_back(out);
}

/* [m] The planes of halfspaces are drawn as far as all else reaches. */
double sizeOf(const World &world) {
  Eigen::AlignedBox3d box(Eigen::Vector3d::Zero());
  for (const auto &[id, object] : world.snapshot->objects()) {
    for (const ObjectShape &shape : object->shapes) {
      if (shape.geometry.body && shape.placed.box.sizes().allFinite()) box.extend(shape.placed.box);
    }
  }
  for (const auto &[name, pose] : world.links) box.extend(Eigen::Vector3d(pose.translation()));
  constexpr double kLeast = 2.0;
  return std::max(kLeast, box.sizes().maxCoeff());
}

/* Triangles for each of so many shapes. */
std::size_t mostOf(std::size_t shapes) {
  return std::clamp(kMostTriangles / std::max<std::size_t>(shapes, 1), kLeastOfABody, kMostOfABody);
}

/* The links of a robot and what they carry, each in its link's frame: prefix + link. */
void addRobot(const Snapshot &scene, const std::string &kind, const std::string &prefix, std::size_t most,
              double plane_size, Json &bodies) {
  for (const auto &[link, parts] : scene.robot()->links()) {
    for (const LinkGeometry &part : scene.linkGeometry(link))
      addBody(prefix + link, kind, prefix + link,
              surfaceOf(part.description, part.geometry.body, scene.robot()->resources(), most, plane_size), part.pose,
              bodies);
  }
  for (const auto &[id, object] : scene.attached()) {
    for (const LinkGeometry &part : object->shapes)
      addBody(prefix + id, kind, prefix + object->link,
              surfaceOf(part.description, part.geometry.body, {}, most, plane_size), part.pose, bodies);
  }
}

} // namespace

void drawWorld(const World &world, const RobotMotion *motion, const std::vector<double> &times, Json &out) {
  const Snapshot &scene = *world.snapshot;
  const bool with_robot = scene.robot() != nullptr;
  std::size_t count = 0;
  for (const auto &[id, object] : scene.objects()) count += object->shapes.size();
  if (with_robot) {
    for (const auto &[link, parts] : scene.robot()->links()) count += parts.size();
  }
  const std::size_t most = mostOf(count);
  const double plane_size = sizeOf(world);

  // The objects, where they stand.
  Json bodies = Json::listOf({});
  for (const auto &[id, object] : scene.objects()) {
    for (std::size_t i = 0; i < object->shapes.size(); ++i) {
      const ShapeDescription &shape = object->description.shapes[i];
      addBody(id, "object", "", surfaceOf(shape, object->shapes[i].geometry.body, {}, most, plane_size),
              object->description.pose * shape.pose, bodies);
    }
  }

  if (with_robot) addRobot(scene, "link", "", most, plane_size, bodies);
  out["bodies"] = std::move(bodies);

  // Where the links are.
  Json frames = Json::mapOf({{"times", times}, {"poses", Json::mapOf({})}});
  for (const double t : times) {
    const LinkPoses poses = motion ? motion->linkPoses(t) : world.links;
    for (const auto &[link, pose] : poses) addPose(pose, frames["poses"][link]);
  }
  out["frames"] = std::move(frames);
}

void drawMovers(const World &world, const MovingWorld &moving, const std::vector<double> &times, Json &out) {
  Json &bodies = out["bodies"], &poses = out["frames"]["poses"];
  std::size_t count = 0;
  for (const auto &[id, object] : world.snapshot->moving()) count += object->description.shapes.size();
  for (const MovingRobot &robot : moving.others) count += robot.motion->snapshot()->robot()->links().size();
  const std::size_t most = mostOf(count);
  const double plane_size = sizeOf(world);
  for (const auto &[id, object] : world.snapshot->moving()) {
    for (const ShapeDescription &shape : object->description.shapes)
      addBody(id, "mover", id,
              surfaceOf(shape, makeGeometry(shape, world.resources).body, world.resources, most, plane_size),
              shape.pose, bodies);
    for (const double t : times) addPose(moving.movers.objectPose(id, t), poses[id]);
  }
  for (const MovingRobot &robot : moving.others) {
    const std::string prefix = robot.name + "/";
    addRobot(*robot.motion->snapshot(), "mover", prefix, most, plane_size, bodies);
    const std::array<double, 2> domain = robot.motion->domain();
    for (const double t : times)
      for (const auto &[link, pose] : robot.motion->linkPoses(std::clamp(t - robot.start, domain[0], domain[1])))
        addPose(pose, poses[prefix + link]);
  }
}

Json drawCurve(const CompiledCurve &curve, Workspace &workspace) {
  const cprox_curve_info info = cprox_curve_get_info(curve.curve.get());
  std::vector<double> points, parameters;
  for (int i = 0; i <= kCurveSamples; ++i) {
    const double share = static_cast<double>(i) / kCurveSamples;
    const double t = info.t0 * (1.0 - share) + info.t1 * share;
    cprox_vec3 point{};
    if (cprox_curve_evaluate(curve.curve.get(), t, workspace.get(), &point, nullptr, nullptr) != CPROX_OK) continue;
    parameters.push_back(t);
    addNumbers({point.x, point.y, point.z}, points);
  }
  return Json::mapOf({{"name", curve.id}, {"radius", curve.radius}, {"t", parameters}, {"points", points}});
}

} // namespace curve_proximity::cli
