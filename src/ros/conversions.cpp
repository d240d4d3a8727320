/* SPDX-License-Identifier: BSD-3-Clause */
#include "conversions.h"

#include "../scene/curve_basis.h"
#include "asking.h"
#include "cloud.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace curve_proximity {
namespace {

geometry_msgs::Point toPointMessage(const Eigen::Vector3d &point) {
  geometry_msgs::Point message;
  message.x = point.x();
  message.y = point.y();
  message.z = point.z();
  return message;
}

void fillPoints(const std::vector<geometry_msgs::Point> &points, Eigen::Matrix3Xd &out) {
  out.resize(3, static_cast<Eigen::Index>(points.size()));
  for (std::size_t i = 0; i < points.size(); ++i)
    out.col(static_cast<Eigen::Index>(i)) << points[i].x, points[i].y, points[i].z;
}

Eigen::Matrix3Xd toPoints(const std::vector<geometry_msgs::Point> &points) {
  Eigen::Matrix3Xd out;
  fillPoints(points, out);
  return out;
}

std::vector<geometry_msgs::Point> toPointMessages(const Eigen::Matrix3Xd &points) {
  std::vector<geometry_msgs::Point> out;
  out.reserve(static_cast<std::size_t>(points.cols()));
  for (Eigen::Index i = 0; i < points.cols(); ++i) out.push_back(toPointMessage(Eigen::Vector3d(points.col(i))));
  return out;
}

/** A message that nobody filled in has zeros everywhere. */
bool isUnset(const geometry_msgs::Pose &pose) {
  const geometry_msgs::Point &p = pose.position;
  const geometry_msgs::Quaternion &q = pose.orientation;
  return p.x == 0 && p.y == 0 && p.z == 0 && q.x == 0 && q.y == 0 && q.z == 0 && q.w == 0;
}

/* ---- shapes, from messages ---- */

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

std::vector<shape_msgs::MeshTriangle> toTriangleMessages(const Triangles &triangles) {
  std::vector<shape_msgs::MeshTriangle> out(static_cast<std::size_t>(triangles.cols()));
  for (Eigen::Index i = 0; i < triangles.cols(); ++i) {
    for (Eigen::Index k = 0; k < 3; ++k)
      out[static_cast<std::size_t>(i)].vertex_indices[static_cast<std::size_t>(k)] =
          static_cast<std::uint32_t>(triangles(k, i));
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

OctreeData toOctree(const Octree &octree) {
  return {octree.id, octree.resolution, octree.binary != 0, std::string(octree.data.begin(), octree.data.end())};
}

Octree toOctreeMessage(const OctreeData &octree) {
  Octree message;
  message.binary = octree.binary;
  message.id = octree.id;
  message.resolution = octree.resolution;
  message.data.assign(octree.data.begin(), octree.data.end());
  return message;
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

/** A flat list as rows of N numbers; `what` names a row in a sentence. */
template <std::size_t N>
std::vector<std::array<double, N>> toRows(const std::vector<double> &numbers, const char *what) {
  if (numbers.size() % N != 0)
    throw Error(std::to_string(numbers.size()) + " numbers are not a whole number of " + what + " of " +
                std::to_string(N));
  std::vector<std::array<double, N>> out(numbers.size() / N);
  for (std::size_t i = 0; i < numbers.size(); ++i) out[i / N][i % N] = numbers[i];
  return out;
}

template <std::size_t N>
std::vector<double> toNumbers(const std::vector<std::array<double, N>> &rows) {
  std::vector<double> out;
  for (const auto &row : rows) out.insert(out.end(), row.begin(), row.end());
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

/** The way back, for what was a message. */
template <class Message>
void fillMessage(const CurveDescription &curve, Message &message) {
  message.basis = curve.basis;
  message.degree = static_cast<std::uint32_t>(curve.degree);
  if (!hasOwnRange(curve.basis)) message.t0 = curve.t0, message.t1 = curve.t1;
  message.points = toPointMessages(curve.points);
  message.knots = curve.knots;
  message.parameters = curve.parameters;
}

Curve toCurveMessage(const CurveDescription &curve) {
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

/** Appends one list of shapes with their poses; `what` names the list's elements in a sentence. */
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

Operation::Kind toKind(int operation) {
  switch (operation) {
    case CollisionObject::ADD: return Operation::Kind::ADD;
    case CollisionObject::REMOVE: return Operation::Kind::REMOVE;
    case CollisionObject::APPEND: return Operation::Kind::APPEND;
    case CollisionObject::MOVE: return Operation::Kind::MOVE;
    default: throw Error("unknown operation " + std::to_string(operation));
  }
}

CollisionObject::_operation_type toOperationByte(Operation::Kind kind) {
  switch (kind) {
    case Operation::Kind::REMOVE: return CollisionObject::REMOVE;
    case Operation::Kind::APPEND: return CollisionObject::APPEND;
    case Operation::Kind::MOVE: return CollisionObject::MOVE;
    case Operation::Kind::ADD: break;
  }
  return CollisionObject::ADD;
}

/** The way of an object that moves. */
ObjectTrajectory toTrajectory(const PoseTrajectory &message) {
  const std::optional<Turning> turning = turningFromName(message.turning);
  if (!turning) throw Error("the turning '" + message.turning + "' is none of slerp, screw");
  ObjectTrajectory out;
  out.turning = *turning;
  out.start = static_cast<std::int64_t>(message.start.toNSec());
  out.tolerance = toStartTolerance(message.start_tolerance, message.any_time != 0);
  for (const Waypoint &waypoint : message.waypoints) {
    try {
      if (!std::isfinite(waypoint.time)) throw Error("the time is not finite");
      out.poses.push_back({waypoint.time, toIsometry(waypoint.pose)});
    } catch (const Error &error) {
      throw Error("waypoint " + std::to_string(out.poses.size()) + ": " + error.what());
    }
  }
  return out;
}

PoseTrajectory toTrajectoryMessage(const ObjectTrajectory &trajectory) {
  constexpr std::int64_t SECOND = 1000000000;
  if (trajectory.start < 0 || trajectory.start / SECOND > std::numeric_limits<std::uint32_t>::max())
    throw Error("a trajectory starts at a time that no stamp has: " + std::to_string(trajectory.start / SECOND) + " s");
  PoseTrajectory message;
  message.start.fromNSec(static_cast<std::uint64_t>(trajectory.start));
  message.any_time = std::isinf(trajectory.tolerance);
  message.start_tolerance = message.any_time ? 0.0 : trajectory.tolerance;
  message.turning = turningName(trajectory.turning);
  for (const TimedPose &pose : trajectory.poses) {
    message.waypoints.emplace_back();
    message.waypoints.back().time = pose.time;
    message.waypoints.back().pose = toMessage(pose.pose);
  }
  return message;
}

/** An object that stands in `frame_in_fixed` gets its pose in the fixed frame. APPEND may leave the pose out: then the
 *  shapes are relative to the object that is there, and nothing is to be brought anywhere. */
void bringToFixed(Operation &operation, const Eigen::Isometry3d &frame_in_fixed) {
  const bool relative = operation.kind == Operation::Kind::APPEND && operation.object.pose.matrix().isIdentity(0.0);
  if (operation.trajectory) {
    for (TimedPose &waypoint : operation.trajectory->poses) waypoint.pose = frame_in_fixed * waypoint.pose;
  } else if (!relative) {
    operation.object.pose = frame_in_fixed * operation.object.pose;
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

/** A missing transform is told with the object's name. */
Eigen::Isometry3d frameOf(const CollisionObject &object, const ToFixed &to_fixed) {
  try {
    return to_fixed(object.header);
  } catch (const std::exception &error) {
    throw Error("object '" + object.id + "': " + error.what());
  }
}

/* ---- what links carry ---- */

/** An object that names its link's frame needs no transform; others are brought there. */
Attachment toAttachment(const AttachedCollisionObject &message, const ToFixed &to_fixed,
                        const LinkToFixed &link_to_fixed, const Snapshot &before) {
  Operation operation = toOperation(message.object);
  if (operation.trajectory)
    throw Error("object '" + message.object.id + "': what a link carries moves with it, and takes no trajectory");
  Attachment out;
  out.link = message.link_name;
  out.touch_links = message.touch_links;
  const std_msgs::Header &header = message.object.header;
  const auto locate = [&](const std::string &link) {
    if (out.link_poses.count(link) == 0) out.link_poses[link] = link_to_fixed(link, header.stamp);
  };
  try {
    if (operation.kind == Operation::Kind::REMOVE) {
      out.kind = Attachment::Kind::DETACH;
      for (const auto &entry : before.attached()) locate(entry.second->link);
    } else if (operation.kind != Operation::Kind::ADD) {
      throw Error("what a link carries is added or removed, not appended to or moved");
    } else if (operation.object.shapes.empty()) {
      locate(out.link);
    } else if (header.frame_id != out.link) {
      locate(out.link);
      const bool on_link = before.robot() && before.robot()->links().count(header.frame_id) > 0;
      const Eigen::Isometry3d frame = on_link ? link_to_fixed(header.frame_id, header.stamp) : to_fixed(header);
      operation.object.pose = out.link_poses.at(out.link).inverse() * frame * operation.object.pose;
    }
  } catch (const std::exception &error) {
    throw Error("object '" + message.object.id + "': " + error.what());
  }
  out.object = std::move(operation.object);
  return out;
}

LinkScale toScaleMessage(const std::pair<const std::string, double> &scale) {
  LinkScale message;
  message.link_name = scale.first;
  message.scale = scale.second;
  return message;
}

/* ---- shapes, to messages ---- */

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
  if (shape.curve) body.curve = toCurveMessage(*shape.curve);
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

AllowedContact toMessage(const AllowedPair &pair) {
  AllowedContact message;
  message.first = pair.a;
  message.second = pair.b;
  message.allowed = pair.allowed;
  return message;
}

LinkPadding toPaddingMessage(const std::string &link, double padding) {
  LinkPadding message;
  message.link_name = link;
  message.padding = padding;
  return message;
}

} // namespace

/* ---- poses ---- */

Eigen::Isometry3d toIsometry(const geometry_msgs::Pose &pose) {
  const geometry_msgs::Point &p = pose.position;
  const geometry_msgs::Quaternion &q = pose.orientation;
  if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) throw Error("the position is not finite");
  return toIsometry(cprox_pose{{p.x, p.y, p.z}, {q.w, q.x, q.y, q.z}});
}

geometry_msgs::Pose toMessage(const Eigen::Isometry3d &pose) {
  const cprox_pose p = toPose(pose);
  geometry_msgs::Pose message;
  message.position = toPointMessage(p.position);
  message.orientation.w = p.orientation.w;
  message.orientation.x = p.orientation.x;
  message.orientation.y = p.orientation.y;
  message.orientation.z = p.orientation.z;
  return message;
}

geometry_msgs::Point toPointMessage(const cprox_vec3 &point) {
  return toPointMessage(toEigen(point));
}

/* ---- curves ---- */

/* A coefficient that is not a point of the curve turns, and does not move: all but the first of a series. */
static bool isSeries(const std::string &basis) {
  return basis == "polynomial" || basis == "legendre" || basis == "trigonometric";
}

CurveDescription toDescription(const Curve &curve, const Eigen::Isometry3d &frame_in_fixed) {
  CurveDescription out;
  toDescription(curve, frame_in_fixed, out);
  return out;
}

/* What a curve and a piece have in common. */
template <typename Message>
static void fillBasis(const Message &curve, CurveDescription &out) {
  out.basis = curve.basis;
  out.degree = curve.degree;
  out.t0 = curve.t0;
  out.t1 = curve.t1;
  fillPoints(curve.points, out.points);
  out.knots = curve.knots;
  out.parameters = curve.parameters;
  takeWholeRange(out);
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

/* ---- pairs ---- */

static PlacedBody toPlacedBody(const Body &body, const geometry_msgs::Pose &pose, const char *name) {
  try {
    PlacedBody out;
    out.shape = toShape(body);
    if (isUnset(pose)) return out;
    toIsometry(pose); // so that it is finite, and the quaternion a rotation
    out.pose = {{pose.position.x, pose.position.y, pose.position.z},
                {pose.orientation.w, pose.orientation.x, pose.orientation.y, pose.orientation.z}};
    return out;
  } catch (const Error &error) {
    throw Error(std::string(name) + ": " + error.what(), error.status());
  }
}

PairDescription toDescription(const PairQuery &message) {
  const std::optional<PairDescription::Asked> asked = pairQuestion(message.ask);
  if (!asked)
    throw Error("ask '" + message.ask +
                "' is unknown; it must be distance, growth, translating_distance or translating_contact");
  PairDescription out;
  out.asked = *asked;
  out.id = message.id;
  out.a = toPlacedBody(message.a, message.pose_a, "a");
  out.b = toPlacedBody(message.b, message.pose_b, "b");
  out.velocity_a = {message.velocity_a.x, message.velocity_a.y, message.velocity_a.z};
  out.velocity_b = {message.velocity_b.x, message.velocity_b.y, message.velocity_b.z};
  out.duration = message.duration;
  const bool moves = !out.velocity_a.isZero(0.0) || !out.velocity_b.isZero(0.0) || out.duration != 0.0;
  if (moves && !isTranslating(out.asked))
    throw Error("there is a velocity or a duration: bodies move with translating_distance and translating_contact");
  return out;
}

/* ---- the scene ---- */

Operation toOperation(const CollisionObject &message) {
  Operation out;
  out.object.id = message.id;
  out.object.frame = message.header.frame_id;
  out.object.padding = message.padding;
  try {
    out.kind = toKind(message.operation);
    if (out.kind == Operation::Kind::REMOVE) return out;
    const bool optional = out.kind != Operation::Kind::MOVE;
    if (!optional || !isUnset(message.pose)) out.object.pose = toIsometry(message.pose);
    append(message.primitives, message.primitive_poses, "primitive", out.object.shapes);
    append(message.meshes, message.mesh_poses, "mesh", out.object.shapes);
    append(message.planes, message.plane_poses, "plane", out.object.shapes);
    checkCloudFrames(message);
    append(message.bodies, message.body_poses, "body", out.object.shapes);
    if (!message.trajectory.waypoints.empty()) out.trajectory = toTrajectory(message.trajectory);
  } catch (const Error &error) {
    throw Error("object '" + message.id + "': " + error.what());
  }
  return out;
}

SceneChange toSceneChange(const ApplySceneRequest &request, const ToFixed &to_fixed, std::vector<std::string> &faults) {
  SceneChange change;
  change.clear = request.clear;
  for (const CollisionObject &object : request.objects) {
    try {
      Operation operation = toOperation(object);
      if (operation.kind != Operation::Kind::REMOVE) bringToFixed(operation, frameOf(object, to_fixed));
      change.operations.push_back(std::move(operation));
    } catch (const std::exception &error) {
      faults.push_back(error.what());
    }
  }
  for (const LinkPadding &padding : request.link_padding) {
    if (padding.link_name.empty()) {
      change.default_link_padding = padding.padding;
    } else {
      change.link_padding[padding.link_name] = padding.padding;
    }
  }
  for (const LinkScale &scale : request.link_scale) change.link_scale[scale.link_name] = scale.scale;
  for (const AllowedContact &contact : request.allowed_contacts)
    change.allowed.push_back({contact.first, contact.second, contact.allowed != 0});
  return change;
}

void addAttachments(const ApplySceneRequest &request, const ToFixed &to_fixed, const LinkToFixed &link_to_fixed,
                    const Snapshot &before, SceneChange &change, std::vector<std::string> &faults) {
  for (const AttachedCollisionObject &message : request.attached_collision_objects) {
    try {
      change.attachments.push_back(toAttachment(message, to_fixed, link_to_fixed, before));
    } catch (const std::exception &error) {
      faults.push_back(error.what());
    }
  }
}

AttachedCollisionObject toMessage(const Attachment &attachment) {
  AttachedCollisionObject message;
  message.link_name = attachment.link;
  message.touch_links = attachment.touch_links;
  message.object = toMessage(attachment.object);
  return message;
}

CollisionObject toMessage(const ObjectDescription &object) {
  CollisionObject message;
  message.header.frame_id = object.frame;
  message.id = object.id;
  message.pose = toMessage(object.pose);
  message.padding = object.padding;
  message.operation = CollisionObject::ADD;
  for (const ShapeDescription &shape : object.shapes) addShape(message, shape);
  return message;
}

/* What ~apply_scene would take to build it again. */
static CollisionObject toMessage(const MovingSceneObject &object) {
  CollisionObject message = toMessage(object.description);
  message.trajectory = toTrajectoryMessage(object.trajectory);
  return message;
}

void toMessage(const Snapshot &snapshot, const std::vector<std::string> &ids, GetSceneResponse &response) {
  if (ids.empty()) {
    for (const auto &object : snapshot.objects()) response.objects.push_back(toMessage(object.second->description));
    for (const auto &object : snapshot.moving()) response.objects.push_back(toMessage(*object.second));
  }
  for (const std::string &id : ids) {
    const auto object = snapshot.objects().find(id);
    const auto moving = snapshot.moving().find(id);
    if (object != snapshot.objects().end()) {
      response.objects.push_back(toMessage(object->second->description));
    } else if (moving != snapshot.moving().end()) {
      response.objects.push_back(toMessage(*moving->second));
    } else if (snapshot.attached().count(id) == 0) {
      throw Error("there is no object '" + id + "'");
    }
  }
  for (const auto &entry : snapshot.attached()) {
    if (!ids.empty() && std::find(ids.begin(), ids.end(), entry.first) == ids.end()) continue;
    const AttachedObject &object = *entry.second;
    response.attached_collision_objects.push_back(
        toMessage(Attachment{Attachment::Kind::ATTACH, object.link, object.touch_links, object.description, {}}));
  }
  for (const auto &scale : snapshot.linkScales()) response.link_scale.push_back(toScaleMessage(scale));
  if (snapshot.defaultLinkPadding() != 0.0)
    response.link_padding.push_back(toPaddingMessage("", snapshot.defaultLinkPadding()));
  for (const auto &padding : snapshot.linkPaddings())
    response.link_padding.push_back(toPaddingMessage(padding.first, padding.second));
  for (const AllowedPair &pair : snapshot.allowed()) response.allowed_contacts.push_back(toMessage(pair));
}

ApplySceneRequest toMessage(const SceneChange &change) {
  ApplySceneRequest request;
  request.clear = change.clear;
  for (const Operation &operation : change.operations) {
    request.objects.push_back(toMessage(operation.object));
    request.objects.back().operation = toOperationByte(operation.kind);
    if (operation.trajectory) request.objects.back().trajectory = toTrajectoryMessage(*operation.trajectory);
  }
  if (change.default_link_padding) request.link_padding.push_back(toPaddingMessage("", *change.default_link_padding));
  for (const auto &padding : change.link_padding)
    request.link_padding.push_back(toPaddingMessage(padding.first, padding.second));
  for (const Attachment &attachment : change.attachments)
    request.attached_collision_objects.push_back(toMessage(attachment));
  for (const auto &scale : change.link_scale) request.link_scale.push_back(toScaleMessage(scale));
  for (const AllowedPair &pair : change.allowed) request.allowed_contacts.push_back(toMessage(pair));
  return request;
}

/* ---- answers ---- */

void fillRow(const Answer &answer, QueryType query_type, Proximity &message) {
  if (answer.result.status < 0) {
    message = toFailedRow(answer.id, answer.kind, answer.message);
    message.status = answer.status;
    return;
  }
  const cprox_result &result = answer.result;
  message.id = answer.id;
  message.kind = answer.kind;
  message.status = answer.status;
  if (query_type != QueryType::DISTANCE) message.verdict = cprox_verdict_name(result.verdict);
  message.lower = result.lower;
  message.upper = result.upper;
  message.t = result.t;
  const bool on_curve = answer.kind == Proximity::KIND_CURVE && result.obstacle_index >= 0;
  message.t_b = on_curve ? result.t_obstacle : std::numeric_limits<double>::quiet_NaN();
  message.t_contact_lower = std::numeric_limits<double>::quiet_NaN();
  message.second_opinion = secondOpinionName(answer.second_opinion.verdict);
  message.second_distance = answer.second_opinion.distance;
  message.witness_a = toPointMessage(result.witness_mover);
  message.witness_b = toPointMessage(result.witness_obstacle);
  message.normal.x = result.normal.x;
  message.normal.y = result.normal.y;
  message.normal.z = result.normal.z;
  message.a = answer.a;
  message.b = answer.b;
  message.nodes = result.nodes;
  message.distance_queries = result.distance_queries;
  message.microseconds = answer.microseconds;
  message.lod = cprox_lod_name(result.lod);
  message.message = answer.message;
}

Proximity toFailedRow(const std::string &id, const std::string &kind, const std::string &why) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  Proximity message;
  message.id = id;
  message.kind = kind;
  message.status = cprox_status_name(CPROX_INVALID);
  message.lower = message.upper = message.t = message.t_b = message.t_contact_lower = message.second_distance = none;
  message.witness_a.x = message.witness_a.y = message.witness_a.z = none;
  message.witness_b = message.witness_a;
  message.normal.x = message.normal.y = message.normal.z = none;
  message.microseconds = none;
  message.a = id;
  message.lod = cprox_lod_name(CPROX_LOD_NONE);
  message.message = why;
  return message;
}

double toStartTolerance(double tolerance, bool any_time) {
  if (!(tolerance >= 0.0 && std::isfinite(tolerance)))
    throw Error("start_tolerance is " + std::to_string(tolerance) + " s: it must be at least 0 and finite");
  return any_time ? std::numeric_limits<double>::infinity() : tolerance;
}

ViolationIntervals toMessage(const Violations &violations) {
  if (violations.list.size() > MOST_VIOLATIONS)
    throw Error("there are more than " + std::to_string(MOST_VIOLATIONS) +
                " violations: a larger resolution has fewer");
  ViolationIntervals message;
  for (const Violation &one : violations.list) {
    message.enter_lower.push_back(one.enter_lower);
    message.enter_upper.push_back(one.enter_upper);
    message.leave_lower.push_back(one.leave_lower);
    message.leave_upper.push_back(one.leave_upper);
    message.verdict.emplace_back(cprox_verdict_name(one.verdict));
    message.upper.push_back(one.upper);
    message.t.push_back(one.t);
    message.a.push_back(one.a);
    message.b.push_back(one.b);
  }
  return message;
}

Profile toMessage(const std::vector<ClearanceInterval> &intervals) {
  Profile message;
  for (const ClearanceInterval &interval : intervals) {
    message.t0.push_back(interval.t0);
    message.t1.push_back(interval.t1);
    message.lower.push_back(interval.lower);
    message.upper.push_back(interval.upper);
    message.t.push_back(interval.t);
    message.a.push_back(interval.a);
    message.b.push_back(interval.b);
    message.witness_a.push_back(toPointMessage(interval.witness_a));
    message.witness_b.push_back(toPointMessage(interval.witness_b));
    message.converged.push_back(interval.status == CPROX_OK);
  }
  return message;
}

/* ---- joints ---- */

JointPositions toJointPositions(const sensor_msgs::JointState &state) {
  if (state.name.size() != state.position.size())
    throw Error("joint_state has " + std::to_string(state.name.size()) + " names and " +
                std::to_string(state.position.size()) + " positions");
  JointPositions positions;
  for (std::size_t i = 0; i < state.name.size(); ++i) {
    if (!positions.emplace(state.name[i], state.position[i]).second)
      throw Error("joint_state names '" + state.name[i] + "' twice");
  }
  return positions;
}

/* ---- trajectories ---- */

TrajectoryDescription toDescription(const trajectory_msgs::JointTrajectory &trajectory, const JointPositions &now,
                                    std::string &remark) {
  TrajectoryDescription out;
  out.joints = trajectory.joint_names;
  const auto timeless = [](const trajectory_msgs::JointTrajectoryPoint &point) {
    return point.time_from_start.isZero() && point.velocities.empty() && point.accelerations.empty();
  };
  const bool untimed =
      trajectory.points.size() > 1 && std::all_of(trajectory.points.begin(), trajectory.points.end(), timeless);
  if (untimed) remark = "its times are all 0: t counts its points";
  for (const trajectory_msgs::JointTrajectoryPoint &point : trajectory.points) {
    TrajectoryPoint next{point.positions, point.velocities, point.accelerations, point.time_from_start.toSec()};
    if (untimed) next.time = static_cast<double>(out.points.size());
    if (!out.points.empty()) {
      const TrajectoryPoint &last = out.points.back();
      const bool repeated = next.time == last.time && next.positions == last.positions &&
                            next.velocities == last.velocities && next.accelerations == last.accelerations;
      if (repeated) continue;
    }
    out.points.push_back(std::move(next));
  }
  if (out.points.empty() || !(out.points.front().time > 0.0)) return out;

  // The way from where the robot is.
  TrajectoryPoint start;
  for (const std::string &joint : out.joints) {
    const auto it = now.find(joint);
    if (it == now.end()) return out;
    start.positions.push_back(it->second);
  }
  if (!out.points.front().velocities.empty()) start.velocities.assign(out.joints.size(), 0.0);
  if (!out.points.front().accelerations.empty()) start.accelerations.assign(out.joints.size(), 0.0);
  out.points.insert(out.points.begin(), start);
  return out;
}

} // namespace curve_proximity
