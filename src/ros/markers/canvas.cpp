/* SPDX-License-Identifier: BSD-3-Clause */
#include "markers/canvas.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <vector>

#include "messages/geometry_message.h"

namespace curve_proximity {
namespace {

using visualization_msgs::Marker;

constexpr double GREEN_CLEARANCE = 0.3; /* [m] from here on there is room to spare */
constexpr double HALFSPACE_SIZE = 4.0;  /* [m] of the slab that stands for a halfspace */
constexpr Eigen::Index MOST_TRIANGLES = 20000, MOST_POINTS = 20000, MOST_CELLS = 50000;
constexpr double POINT_SIZE = 0.005; /* [m] at least */

using Outline = std::vector<std::pair<double, double>>;

/** Two triangles over the corners of a quadrilateral. */
void addQuad(Marker &marker, const geometry_msgs::Point (&corners)[4]) {
  for (const int c : {0, 1, 2, 0, 2, 3}) marker.points.push_back(corners[c]);
}

/** The surface of a solid of revolution about z, as triangles: `profile` is a list of (radius, z) from bottom to top.
 */
void addLathe(Marker &marker, const Outline &profile) {
  constexpr int SIDES = 24;
  const auto at = [](const std::pair<double, double> &p, int k) {
    const double angle = 2.0 * M_PI * k / SIDES;
    return toPointMessage(cprox_vec3{p.first * std::cos(angle), p.first * std::sin(angle), p.second});
  };
  for (std::size_t i = 0; i + 1 < profile.size(); ++i) {
    for (int k = 0; k < SIDES; ++k)
      addQuad(marker, {at(profile[i], k), at(profile[i], k + 1), at(profile[i + 1], k + 1), at(profile[i + 1], k)});
  }
}

/** The outline of a capsule: two half circles. */
Outline capsuleProfile(double height, double radius) {
  constexpr int STEPS = 8;
  Outline profile;
  for (const double side : {-1.0, 1.0}) {
    for (int k = 0; k <= STEPS; ++k) {
      const double angle = 0.5 * M_PI * (side < 0 ? k - STEPS : k) / STEPS;
      profile.emplace_back(radius * std::cos(angle), side * height / 2 + radius * std::sin(angle));
    }
  }
  return profile;
}

/** A finite point in every coordinate. */
bool isFinite(const Marker &marker) {
  const auto finite = [](const geometry_msgs::Point &p) {
    return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
  };
  return finite(marker.pose.position) && std::all_of(marker.points.begin(), marker.points.end(), finite);
}

} // namespace

/* ---- colours ---- */

std_msgs::ColorRGBA colour(double r, double g, double b, double a) {
  std_msgs::ColorRGBA out;
  out.r = static_cast<float>(r);
  out.g = static_cast<float>(g);
  out.b = static_cast<float>(b);
  out.a = static_cast<float>(a);
  return out;
}

std_msgs::ColorRGBA clearanceColour(double clearance, double alpha) {
  static const Eigen::Vector3d stops[] = {
      {0.78, 0.10, 0.16}, {0.96, 0.62, 0.20}, {0.35, 0.72, 0.62}, {0.10, 0.46, 0.56}};
  constexpr int LAST = 3;
  const double s = LAST * std::sqrt(std::clamp(clearance / GREEN_CLEARANCE, 0.0, 1.0));
  const int i = std::min(LAST - 1, static_cast<int>(s));
  const Eigen::Vector3d c = stops[i] + (s - i) * (stops[i + 1] - stops[i]);
  return colour(c.x(), c.y(), c.z(), alpha);
}

std_msgs::ColorRGBA shaded(std_msgs::ColorRGBA tint, const Eigen::Vector3d &normal) {
  static const Eigen::Vector3d light = Eigen::Vector3d(0.3, -0.4, 0.85).normalized();
  const auto share = static_cast<float>(0.72 + 0.28 * normal.dot(light));
  tint.r *= share;
  tint.g *= share;
  tint.b *= share;
  return tint;
}

void setScale(Marker &marker, double x, double y, double z) {
  marker.scale.x = x;
  marker.scale.y = y;
  marker.scale.z = z;
}

/* ---- the canvas ---- */

Canvas::Canvas(std::string frame) : frame_(std::move(frame)) {
  Marker all;
  all.header.frame_id = frame_;
  all.action = Marker::DELETEALL;
  all.pose.orientation.w = 1.0;
  array_.markers.push_back(all);
}

Marker &Canvas::add(const std::string &space, int type, const Eigen::Isometry3d &pose) {
  Marker marker;
  marker.header.frame_id = frame_;
  marker.ns = space;
  marker.id = static_cast<int>(array_.markers.size());
  marker.type = type;
  marker.action = Marker::ADD;
  marker.pose = toMessage(pose);
  setScale(marker, 1.0, 1.0, 1.0);
  array_.markers.push_back(marker);
  return array_.markers.back();
}

visualization_msgs::MarkerArray Canvas::take() {
  auto &markers = array_.markers;
  markers.erase(std::remove_if(markers.begin(), markers.end(), [](const Marker &m) { return !isFinite(m); }),
                markers.end());
  return std::move(array_);
}

/* ---- bodies ---- */

/** The support points of a grid of directions are corners of the body's hull. */
void Canvas::addConvex(const std::string &space, const cprox_body *body, const Eigen::Isometry3d &pose,
                       const std_msgs::ColorRGBA &tint) {
  constexpr int RINGS = 24, SIDES = 48;
  Marker &marker = add(space, Marker::TRIANGLE_LIST, pose);
  marker.color = tint;
  const auto at = [body](int ring, int side) {
    const double latitude = M_PI * (static_cast<double>(ring) / RINGS - 0.5), longitude = 2.0 * M_PI * side / SIDES;
    const bool is_pole = ring == 0 || ring == RINGS; // one point: 0 must not have a sign there
    const double x = is_pole ? 0.0 : std::cos(latitude) * std::cos(longitude),
                 y = is_pole ? 0.0 : std::cos(latitude) * std::sin(longitude);
    cprox_vec3 point{};
    cprox_body_support(body, {x, y, std::sin(latitude)}, &point);
    return toPointMessage(point);
  };
  for (int ring = 0; ring < RINGS; ++ring) {
    for (int side = 0; side < SIDES; ++side)
      addQuad(marker, {at(ring, side), at(ring, side + 1), at(ring + 1, side + 1), at(ring + 1, side)});
  }
}

/** A fan of triangles, seen from both sides. */
void Canvas::addPolygon(const std::string &space, const ShapeDescription &shape, const Eigen::Isometry3d &pose,
                        const std_msgs::ColorRGBA &tint) {
  Marker &marker = add(space, Marker::TRIANGLE_LIST, pose);
  marker.color = tint;
  const auto corner = [&](Eigen::Index i) { marker.points.push_back(toPointMessage(toVec3(shape.vertices.col(i)))); };
  for (Eigen::Index i = 1; i + 1 < shape.vertices.cols(); ++i) {
    for (const Eigen::Index k : {Eigen::Index{0}, i, i + 1, Eigen::Index{0}, i + 1, i}) corner(k);
  }
}

/** A slab whose upper face is the halfspace's boundary near the origin of its frame. */
void Canvas::addHalfspace(const std::string &space, const ShapeDescription &shape, const Eigen::Isometry3d &pose,
                          const std_msgs::ColorRGBA &tint) {
  const Eigen::Vector3d normal(shape.dimensions[0], shape.dimensions[1], shape.dimensions[2]);
  constexpr double THICKNESS = 0.02;
  Eigen::Isometry3d local = Eigen::Isometry3d::Identity();
  local.linear() = rotationBetween(Eigen::Vector3d::UnitZ(), normal).toRotationMatrix();
  local.translation() = -normal * (shape.dimensions[3] / normal.squaredNorm()) - normal.normalized() * (THICKNESS / 2);
  Marker &marker = add(space, Marker::CUBE, pose * local);
  setScale(marker, HALFSPACE_SIZE, HALFSPACE_SIZE, THICKNESS);
  marker.color = tint;
}

/** Not more of them than RViz can turn. */
void Canvas::addPoints(const std::string &space, const ShapeDescription &shape, const Eigen::Isometry3d &pose,
                       const std_msgs::ColorRGBA &tint) {
  Marker &marker = add(space, Marker::SPHERE_LIST, pose);
  marker.color = tint;
  const double size = shape.dimensions.empty() ? POINT_SIZE : std::max(POINT_SIZE, 2 * shape.dimensions[0]);
  setScale(marker, size, size, size);
  const Eigen::Index step = 1 + shape.vertices.cols() / MOST_POINTS;
  for (Eigen::Index i = 0; i < shape.vertices.cols(); i += step)
    marker.points.push_back(toPointMessage(toVec3(shape.vertices.col(i))));
}

/** Its cells, a marker for all of a size; higher ones are lighter, so that they can be told apart. Nothing where its
 * file has gone. */
void Canvas::addOctree(const std::string &space, const ShapeDescription &shape, const ResourceOptions &resources,
                       const Eigen::Isometry3d &pose, const std_msgs::ColorRGBA &tint) {
  Boxes cells;
  try {
    cells = octreeBoxes(shape, resources);
  } catch (const Error &) {
    return;
  }
  const double bottom = cells.low.row(2).minCoeff(), height = cells.high.row(2).maxCoeff() - bottom;
  std::map<std::array<double, 3>, std::size_t> of_size; // to single precision: where its marker is
  const Eigen::Index step = 1 + cells.low.cols() / MOST_CELLS;
  for (Eigen::Index i = 0; i < cells.low.cols(); i += step) {
    const Eigen::Vector3d size = cells.high.col(i) - cells.low.col(i);
    const Eigen::Vector3d middle = 0.5 * (cells.low.col(i) + cells.high.col(i));
    const auto round = [](double x) { return static_cast<double>(static_cast<float>(x)); };
    const auto [found, added] = of_size.emplace(
        std::array<double, 3>{round(size.x()), round(size.y()), round(size.z())}, array_.markers.size());
    if (added) {
      Marker &marker = add(space, Marker::CUBE_LIST, pose);
      marker.color = tint;
      setScale(marker, size.x(), size.y(), size.z());
    }
    Marker &marker = array_.markers[found->second];
    marker.points.push_back(toPointMessage(toVec3(middle)));
    const double share = 0.55 + 0.45 * (middle.z() - bottom) / height;
    marker.colors.push_back(colour(share * tint.r, share * tint.g, share * tint.b, tint.a));
  }
}

/** As it is: by its file, which RViz reads itself, or by its triangles. False where that is not to be had. */
bool Canvas::addMesh(const std::string &space, const ShapeDescription &shape, const ResourceOptions &resources,
                     const Eigen::Isometry3d &pose, const std_msgs::ColorRGBA &tint) {
  const Eigen::Vector3d scale =
      shape.dimensions.size() == 3 ? Eigen::Vector3d(shape.dimensions.data()) : Eigen::Vector3d::Ones();
  if (!shape.resource.empty()) {
    try {
      const std::string file = resolveResource(shape.resource, resources);
      Marker &marker = add(space, Marker::MESH_RESOURCE, pose);
      marker.mesh_resource = "file://" + file;
      marker.color = tint;
      setScale(marker, scale.x(), scale.y(), scale.z());
      return true;
    } catch (const Error &) {
      return false; // the file has gone since the body was made
    }
  }
  if (shape.triangles.cols() == 0 || shape.triangles.cols() > MOST_TRIANGLES) return false;
  Marker &marker = add(space, Marker::TRIANGLE_LIST, pose);
  marker.color = tint;
  setScale(marker, scale.x(), scale.y(), scale.z());
  for (Eigen::Index i = 0; i < shape.triangles.size(); ++i)
    marker.points.push_back(toPointMessage(toVec3(shape.vertices.col(shape.triangles(i)))));
  return true;
}

/** The heights of a height field as a mesh. */
static ShapeDescription surfaceOf(const ShapeDescription &field) {
  ShapeDescription out;
  out.type = ShapeType::MESH;
  const auto wide = static_cast<Eigen::Index>(field.dimensions[2]),
             deep = static_cast<Eigen::Index>(field.dimensions[3]);
  out.vertices.resize(3, wide * deep);
  for (Eigen::Index i = 0; i < wide * deep; ++i)
    out.vertices.col(i) << field.dimensions[0] * static_cast<double>(i % wide),
        field.dimensions[1] * static_cast<double>(i / wide), field.values[static_cast<std::size_t>(i)];
  out.triangles.resize(3, 2 * (wide - 1) * (deep - 1));
  for (Eigen::Index k = 0; k < (wide - 1) * (deep - 1); ++k) {
    const int at = static_cast<int>(k / (wide - 1) * wide + k % (wide - 1)), above = at + static_cast<int>(wide);
    out.triangles.col(2 * k) << at, at + 1, above + 1;
    out.triangles.col(2 * k + 1) << at, above + 1, above;
  }
  return out;
}

void Canvas::addShape(const std::string &space, const ShapeDescription &shape, const BodyHandle &body,
                      const ResourceOptions &resources, const Eigen::Isometry3d &pose,
                      const std_msgs::ColorRGBA &tint) {
  const std::vector<double> &d = shape.dimensions;
  const auto solid = [&](int type, double x, double y, double z) -> Marker & {
    Marker &marker = add(space, type, pose);
    marker.color = tint;
    setScale(marker, x, y, z);
    return marker;
  };
  switch (shape.type) {
    case ShapeType::HALFSPACE: addHalfspace(space, shape, pose, tint); break;
    case ShapeType::BOX: solid(Marker::CUBE, d[0], d[1], d[2]); break;
    case ShapeType::SPHERE: solid(Marker::SPHERE, 2 * d[0], 2 * d[0], 2 * d[0]); break;
    case ShapeType::ELLIPSOID: solid(Marker::SPHERE, 2 * d[0], 2 * d[1], 2 * d[2]); break;
    case ShapeType::CYLINDER: solid(Marker::CYLINDER, 2 * d[1], 2 * d[1], d[0]); break;
    case ShapeType::CONE:
      addLathe(solid(Marker::TRIANGLE_LIST, 1, 1, 1), {{0.0, -d[0] / 2}, {d[1], -d[0] / 2}, {0.0, d[0] / 2}});
      break;
    case ShapeType::CAPSULE: addLathe(solid(Marker::TRIANGLE_LIST, 1, 1, 1), capsuleProfile(d[0], d[1])); break;
    case ShapeType::MESH:
      if (!addMesh(space, shape, resources, pose, tint)) addConvex(space, body.get(), pose, tint);
      break;
    case ShapeType::HEIGHT_FIELD:
      if (!addMesh(space, surfaceOf(shape), resources, pose, tint)) addConvex(space, body.get(), pose, tint);
      break;
    case ShapeType::POLYGON: addPolygon(space, shape, pose, tint); break;
    case ShapeType::POINTS: addPoints(space, shape, pose, tint); break;
    case ShapeType::OCTREE: addOctree(space, shape, resources, pose, tint); break;
    default: addConvex(space, body.get(), pose, tint); break;
  }
}

} // namespace curve_proximity
