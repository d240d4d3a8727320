/* SPDX-License-Identifier: BSD-3-Clause */
#include "markers/canvas.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "../../scene/geometry/surface.h"
#include "messages/geometry_message.h"

namespace curve_proximity {
namespace {

using visualization_msgs::Marker;

constexpr double GREEN_CLEARANCE = 0.3; /* [m] from here on there is room to spare */
constexpr double HALFSPACE_SIZE = 4.0;  /* [m] of the square that stands for a halfspace */
constexpr std::size_t MOST_TRIANGLES = 20000;
constexpr Eigen::Index MOST_POINTS = 20000, MOST_CELLS = 50000;
constexpr double POINT_SIZE = 0.005; /* [m] at least */

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

std_msgs::ColorRGBA clearanceColour(double clearance) {
  static const Eigen::Vector3d stops[] = {
      {0.78, 0.10, 0.16}, {0.96, 0.62, 0.20}, {0.35, 0.72, 0.62}, {0.10, 0.46, 0.56}};
  constexpr int LAST = 3;
  const double s = LAST * std::sqrt(std::clamp(clearance / GREEN_CLEARANCE, 0.0, 1.0));
  const int i = std::min(LAST - 1, static_cast<int>(s));
  const Eigen::Vector3d c = stops[i] + (s - i) * (stops[i + 1] - stops[i]);
  return colour(c.x(), c.y(), c.z(), 1.0);
}

/* ---- the canvas ---- */

Canvas::Canvas(std::string frame) : frame_(std::move(frame)) {
  Marker all;
  all.header.frame_id = frame_;
  all.action = Marker::DELETEALL;
  all.pose.orientation.w = 1.0;
  array_.markers.push_back(all);
}

Marker &Canvas::add(const std::string &space, int type, const Eigen::Vector3d &scale, const std_msgs::ColorRGBA &tint,
                    const Eigen::Isometry3d &pose) {
  Marker marker;
  marker.header.frame_id = frame_;
  marker.ns = space;
  marker.id = static_cast<int>(array_.markers.size());
  marker.type = type;
  marker.action = Marker::ADD;
  marker.pose = toMessage(pose);
  marker.scale = toVectorMessage(scale);
  marker.color = tint;
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

/** Not more of them than RViz can turn. */
void Canvas::addPoints(const std::string &space, const ShapeDescription &shape, const Eigen::Isometry3d &pose,
                       const std_msgs::ColorRGBA &tint) {
  const double size = shape.dimensions.empty() ? POINT_SIZE : std::max(POINT_SIZE, 2 * shape.dimensions[0]);
  Marker &marker = add(space, Marker::SPHERE_LIST, Eigen::Vector3d::Constant(size), tint, pose);
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
    if (added) add(space, Marker::CUBE_LIST, size, tint, pose);
    Marker &marker = array_.markers[found->second];
    marker.points.push_back(toPointMessage(toVec3(middle)));
    const double share = 0.55 + 0.45 * (middle.z() - bottom) / height;
    marker.colors.push_back(colour(share * tint.r, share * tint.g, share * tint.b, tint.a));
  }
}

/** A mesh by its file, which RViz reads itself. False where the file has gone since the body was made. */
bool Canvas::addFile(const std::string &space, const ShapeDescription &shape, const ResourceOptions &resources,
                     const Eigen::Isometry3d &pose, const std_msgs::ColorRGBA &tint) {
  std::string file;
  try {
    file = resolveResource(shape.resource, resources);
  } catch (const Error &) {
    return false;
  }
  const Eigen::Vector3d scale =
      shape.dimensions.size() == 3 ? Eigen::Vector3d(shape.dimensions.data()) : Eigen::Vector3d::Ones();
  add(space, Marker::MESH_RESOURCE, scale, tint, pose).mesh_resource = "file://" + file;
  return true;
}

/** By its triangles, or where these are too many or not to be had by its convex hull. What is flat is seen from both
 *  sides. */
void Canvas::addSurface(const std::string &space, const ShapeDescription &shape, const BodyHandle &body,
                        const ResourceOptions &resources, const Eigen::Isometry3d &pose,
                        const std_msgs::ColorRGBA &tint) {
  const ShapeDescription convex;
  const std::size_t triangles = std::max(static_cast<std::size_t>(shape.triangles.cols()), 2 * shape.values.size());
  Surface surface =
      surfaceOf(triangles <= MOST_TRIANGLES ? shape : convex, body, resources, MOST_TRIANGLES, HALFSPACE_SIZE);
  if (surface.triangles.cols() == 0) surface = surfaceOf(convex, body, resources, MOST_TRIANGLES, HALFSPACE_SIZE);
  Marker &marker = add(space, Marker::TRIANGLE_LIST, Eigen::Vector3d::Ones(), tint, pose);
  for (Eigen::Index i = 0; i < surface.triangles.size(); ++i)
    marker.points.push_back(toPointMessage(toVec3(surface.vertices.col(surface.triangles(i)))));
  if (shape.type == ShapeType::POLYGON || shape.type == ShapeType::HALFSPACE)
    for (std::size_t i = marker.points.size(); i-- > 0;)
      marker.points.push_back(geometry_msgs::Point(marker.points[i]));
}

void Canvas::addShape(const std::string &space, const ShapeDescription &shape, const BodyHandle &body,
                      const ResourceOptions &resources, const Eigen::Isometry3d &pose,
                      const std_msgs::ColorRGBA &tint) {
  const std::vector<double> &d = shape.dimensions;
  switch (shape.type) {
    case ShapeType::BOX: add(space, Marker::CUBE, {d[0], d[1], d[2]}, tint, pose); break;
    case ShapeType::SPHERE: add(space, Marker::SPHERE, {2 * d[0], 2 * d[0], 2 * d[0]}, tint, pose); break;
    case ShapeType::ELLIPSOID: add(space, Marker::SPHERE, {2 * d[0], 2 * d[1], 2 * d[2]}, tint, pose); break;
    case ShapeType::CYLINDER: add(space, Marker::CYLINDER, {2 * d[1], 2 * d[1], d[0]}, tint, pose); break;
    case ShapeType::POINTS: addPoints(space, shape, pose, tint); break;
    case ShapeType::OCTREE: addOctree(space, shape, resources, pose, tint); break;
    default:
      if (shape.resource.empty() || !addFile(space, shape, resources, pose, tint))
        addSurface(space, shape, body, resources, pose, tint);
  }
}

} // namespace curve_proximity
