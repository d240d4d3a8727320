/* SPDX-License-Identifier: BSD-3-Clause */
#include <array>
#include <utility>

#include <curve_proximity/description.hpp>

namespace curve_proximity {
namespace {

constexpr std::array<std::pair<ShapeType, const char *>, 19> SHAPE_TYPES = {
    {{ShapeType::POINT, "point"},
     {ShapeType::SPHERE, "sphere"},
     {ShapeType::BOX, "box"},
     {ShapeType::CAPSULE, "capsule"},
     {ShapeType::CYLINDER, "cylinder"},
     {ShapeType::CONE, "cone"},
     {ShapeType::ELLIPSOID, "ellipsoid"},
     {ShapeType::HALFSPACE, "halfspace"},
     {ShapeType::POLYTOPE, "polytope"},
     {ShapeType::POLYGON, "polygon"},
     {ShapeType::MESH, "mesh"},
     {ShapeType::SUPERQUADRIC, "superquadric"},
     {ShapeType::SUPERELLIPSOID, "superellipsoid"},
     {ShapeType::IMPLICIT, "implicit"},
     {ShapeType::POINTS, "points"},
     {ShapeType::OCTREE, "octree"},
     {ShapeType::HEIGHT_FIELD, "height_field"},
     {ShapeType::DISTANCE_GRID, "distance_grid"},
     {ShapeType::CURVE, "curve"}}};

} // namespace

const char *shapeTypeName(ShapeType type) {
  for (const auto &entry : SHAPE_TYPES) {
    if (entry.first == type) return entry.second;
  }
  return "unknown";
}

std::optional<ShapeType> shapeTypeFromName(const std::string &name) {
  for (const auto &entry : SHAPE_TYPES) {
    if (entry.second == name) return entry.first;
  }
  return std::nullopt;
}

const char *turningName(Turning turning) {
  return turning == Turning::SCREW ? "screw" : "slerp";
}

std::optional<Turning> turningFromName(const std::string &name) {
  if (name == "screw") return Turning::SCREW;
  if (name == "slerp" || name.empty()) return Turning::SLERP;
  return std::nullopt;
}

Eigen::Quaterniond rotationBetween(const Eigen::Vector3d &from, const Eigen::Vector3d &to) {
  return Eigen::Quaterniond::FromTwoVectors(from, to);
}

} // namespace curve_proximity
