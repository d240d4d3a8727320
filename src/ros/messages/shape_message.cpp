/* SPDX-License-Identifier: BSD-3-Clause */
#include "messages/shape_message.h"

#include <algorithm>
#include <array>

#include "messages/cloud.h"
#include "messages/curve_message.h"
#include "messages/geometry_message.h"

namespace curve_proximity {
namespace {

/* ---- from messages ---- */

ShapeDescription toShape(const shape_msgs::SolidPrimitive &primitive) {
  ShapeDescription shape;
  switch (primitive.type) {
    case shape_msgs::SolidPrimitive::BOX: shape.type = ShapeType::BOX; break;
    case shape_msgs::SolidPrimitive::SPHERE: shape.type = ShapeType::SPHERE; break;
    case shape_msgs::SolidPrimitive::CYLINDER: shape.type = ShapeType::CYLINDER; break;
    case shape_msgs::SolidPrimitive::CONE: shape.type = ShapeType::CONE; break;
    default: throw Error("unknown type " + std::to_string(primitive.type));
  }
  shape.dimensions.assign(primitive.dimensions.begin(), primitive.dimensions.end());
  return shape;
}

Triangles toTriangles(const std::vector<shape_msgs::MeshTriangle> &triangles, std::size_t vertices) {
  Triangles out(3, static_cast<Eigen::Index>(triangles.size()));
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t index = triangles[i].vertex_indices[k];
      if (index >= vertices)
        throw Error("triangle " + std::to_string(i) + " names vertex " + std::to_string(index) + ", there are " +
                    std::to_string(vertices));
      out(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(i)) = static_cast<int>(index);
    }
  }
  return out;
}

ShapeDescription toShape(const shape_msgs::Mesh &mesh) {
  ShapeDescription shape;
  shape.type = ShapeType::MESH;
  shape.vertices = toPoints(mesh.vertices);
  shape.triangles = toTriangles(mesh.triangles, mesh.vertices.size());
  return shape;
}

/** Does somebody mean the cloud? */
bool isSet(const sensor_msgs::PointCloud2 &cloud) {
  return !cloud.fields.empty() || !cloud.data.empty() || cloud.width > 0;
}

ShapeDescription toShape(const shape_msgs::Plane &plane) {
  ShapeDescription shape;
  shape.type = ShapeType::HALFSPACE;
  shape.dimensions.assign(plane.coef.begin(), plane.coef.end());
  return shape;
}

/** A flat list as rows of N numbers; `what` names a row in a message. */
template <std::size_t N>
std::vector<std::array<double, N>> toRows(const std::vector<double> &numbers, const char *what) {
  if (numbers.size() % N != 0)
    throw Error(std::to_string(numbers.size()) + " numbers are not a whole number of " + what + " of " +
                std::to_string(N));
  std::vector<std::array<double, N>> out(numbers.size() / N);
  for (std::size_t i = 0; i < numbers.size(); ++i) out[i / N][i % N] = numbers[i];
  return out;
}

void fillDeformation(const Body &body, ShapeDescription &shape) {
  if (body.linear.empty() && body.translation.empty() && body.exponents.empty()) return;
  ShapeDeformation &out = shape.deformed.emplace();
  if (!body.linear.empty() && body.linear.size() != 9)
    throw Error("linear has " + std::to_string(body.linear.size()) + " numbers, must be none or 9");
  if (!body.translation.empty() && body.translation.size() != 3)
    throw Error("translation has " + std::to_string(body.translation.size()) + " numbers, must be none or 3");
  if (!body.linear.empty())
    out.linear = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(body.linear.data());
  if (!body.translation.empty()) out.translation = Eigen::Map<const Eigen::Vector3d>(body.translation.data());
  out.exponents = body.exponents;
}

/** Appends one list of shapes with their poses; `what` names the list's elements in a message. */
template <class Shape>
void append(const std::vector<Shape> &shapes, const std::vector<geometry_msgs::Pose> &poses, const char *what,
            std::vector<ShapeDescription> &out) {
  if (!poses.empty() && poses.size() != shapes.size())
    throw Error(std::to_string(shapes.size()) + " " + what + " shapes have " + std::to_string(poses.size()) + " poses");
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    try {
      out.push_back(toShape(shapes[i]));
      if (!poses.empty()) out.back().pose = toIsometry(poses[i]);
    } catch (const Error &error) {
      throw Error(std::string(what) + " " + std::to_string(i) + ": " + error.what());
    }
  }
}

/** The points of a cloud stand in the frame of their object: no other may be meant. */
void checkCloudFrames(const CollisionObject &object) {
  for (const Body &body : object.bodies) {
    const std::string &frame = body.cloud.header.frame_id;
    if (!frame.empty() && frame != object.header.frame_id) {
      throw Error("a cloud in frame '" + frame + "' is part of an object in frame '" + object.header.frame_id +
                  "': give both the same");
    }
  }
}

/* ---- to messages ---- */

std::vector<shape_msgs::MeshTriangle> toTriangleMessages(const Triangles &triangles) {
  std::vector<shape_msgs::MeshTriangle> out(static_cast<std::size_t>(triangles.cols()));
  for (Eigen::Index i = 0; i < triangles.cols(); ++i) {
    for (Eigen::Index k = 0; k < 3; ++k)
      out[static_cast<std::size_t>(i)].vertex_indices[static_cast<std::size_t>(k)] =
          static_cast<std::uint32_t>(triangles(k, i));
  }
  return out;
}

template <std::size_t N>
std::vector<double> toNumbers(const std::vector<std::array<double, N>> &rows) {
  std::vector<double> out;
  for (const auto &row : rows) out.insert(out.end(), row.begin(), row.end());
  return out;
}

void addPrimitive(CollisionObject &message, std::uint8_t type, const ShapeDescription &shape) {
  shape_msgs::SolidPrimitive primitive;
  primitive.type = type;
  primitive.dimensions.assign(shape.dimensions.begin(), shape.dimensions.end());
  message.primitives.push_back(primitive);
  message.primitive_poses.push_back(toMessage(shape.pose));
}

/** shape_msgs knows neither a scale nor a file nor an inside. */
bool isPlainMesh(const ShapeDescription &shape) {
  return shape.resource.empty() && shape.dimensions.empty() && !shape.solid;
}

void addMesh(CollisionObject &message, const ShapeDescription &shape) {
  shape_msgs::Mesh mesh;
  mesh.vertices = toPointMessages(shape.vertices);
  mesh.triangles = toTriangleMessages(shape.triangles);
  message.meshes.push_back(mesh);
  message.mesh_poses.push_back(toMessage(shape.pose));
}

void addBody(CollisionObject &message, const ShapeDescription &shape) {
  Body body;
  body.type = shapeTypeName(shape.type);
  body.dimensions = shape.dimensions;
  body.vertices = toPointMessages(shape.vertices);
  body.triangles = toTriangleMessages(shape.triangles);
  body.resource = shape.resource;
  body.solid = shape.solid;
  if (!shape.octree.data.empty()) body.octree = toOctreeMessage(shape.octree);
  body.unknown_is_occupied = shape.unknown_is_occupied;
  for (const auto &terms : shape.hyperquadrics) {
    body.hyperquadrics.emplace_back();
    body.hyperquadrics.back().terms = toNumbers(terms);
  }
  body.planes = toNumbers(shape.planes);
  body.quadrics = toNumbers(shape.quadrics);
  body.values = shape.values;
  if (shape.curve) body.curve = toMessage(*shape.curve);
  body.synchronized = shape.synchronized;
  if (shape.deformed) {
    const Eigen::Matrix3d rows = shape.deformed->linear.transpose();
    body.linear.assign(rows.data(), rows.data() + rows.size());
    body.translation.assign(shape.deformed->translation.data(), shape.deformed->translation.data() + 3);
    body.exponents = shape.deformed->exponents;
  }
  message.bodies.push_back(body);
  message.body_poses.push_back(toMessage(shape.pose));
}

void addPlane(CollisionObject &message, const ShapeDescription &shape) {
  shape_msgs::Plane plane;
  std::copy(shape.dimensions.begin(), shape.dimensions.end(), plane.coef.begin());
  message.planes.push_back(plane);
  message.plane_poses.push_back(toMessage(shape.pose));
}

} // namespace

Octree toOctreeMessage(const OctreeData &octree) {
  Octree message;
  message.binary = octree.binary;
  message.id = octree.id;
  message.resolution = octree.resolution;
  message.data.assign(octree.data.begin(), octree.data.end());
  return message;
}

ShapeDescription toShape(const Body &body) {
  const std::optional<ShapeType> type = shapeTypeFromName(body.type);
  if (!type) throw Error("unknown type '" + body.type + "'");
  ShapeDescription shape;
  shape.type = *type;
  shape.dimensions = body.dimensions;
  shape.vertices = toPoints(body.vertices);
  shape.triangles = toTriangles(body.triangles, body.vertices.size());
  shape.resource = body.resource;
  shape.solid = body.solid != 0;
  if (isSet(body.cloud)) {
    if (shape.type != ShapeType::POINTS) throw Error("'" + body.type + "' takes no cloud");
    if (!body.vertices.empty()) throw Error("points have both vertices and a cloud: give one of the two");
    shape.vertices = toCloud(body.cloud).points;
  }
  shape.octree = toOctree(body.octree);
  shape.unknown_is_occupied = body.unknown_is_occupied != 0;
  for (const Hyperquadric &h : body.hyperquadrics) shape.hyperquadrics.push_back(toRows<5>(h.terms, "terms"));
  shape.planes = toRows<4>(body.planes, "planes");
  shape.quadrics = toRows<10>(body.quadrics, "quadrics");
  shape.values = body.values;
  if (shape.type == ShapeType::CURVE)
    shape.curve = std::make_shared<const CurveDescription>(toDescription(body.curve, Eigen::Isometry3d::Identity()));
  else if (!body.curve.basis.empty())
    throw Error("'" + body.type + "' takes no curve");
  shape.synchronized = body.synchronized != 0;
  fillDeformation(body, shape);
  return shape;
}

std::vector<ShapeDescription> toShapes(const CollisionObject &object) {
  std::vector<ShapeDescription> shapes;
  append(object.primitives, object.primitive_poses, "primitive", shapes);
  append(object.meshes, object.mesh_poses, "mesh", shapes);
  append(object.planes, object.plane_poses, "plane", shapes);
  checkCloudFrames(object);
  append(object.bodies, object.body_poses, "body", shapes);
  return shapes;
}

void addShape(CollisionObject &message, const ShapeDescription &shape) {
  switch (shape.type) {
    case ShapeType::BOX: addPrimitive(message, shape_msgs::SolidPrimitive::BOX, shape); return;
    case ShapeType::SPHERE: addPrimitive(message, shape_msgs::SolidPrimitive::SPHERE, shape); return;
    case ShapeType::CYLINDER: addPrimitive(message, shape_msgs::SolidPrimitive::CYLINDER, shape); return;
    case ShapeType::CONE: addPrimitive(message, shape_msgs::SolidPrimitive::CONE, shape); return;
    case ShapeType::HALFSPACE:
      if (shape.dimensions.size() == shape_msgs::Plane().coef.size()) return addPlane(message, shape);
      return addBody(message, shape); // wrong as it is, so that the node can say so
    case ShapeType::MESH: return isPlainMesh(shape) ? addMesh(message, shape) : addBody(message, shape);
    default: addBody(message, shape);
  }
}

} // namespace curve_proximity
