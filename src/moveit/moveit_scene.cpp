/* SPDX-License-Identifier: BSD-3-Clause */
#include "moveit_scene.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <octomap/octomap.h>
#include <ros/node_handle.h>

#include <moveit/robot_model/planar_joint_model.h>
#include <moveit/robot_model/revolute_joint_model.h>

#include <curve_proximity/geometric_shapes.hpp>
#include <curve_proximity/urdf_model.hpp>

namespace curve_proximity {
namespace {

using collision_detection::AllowedCollisionMatrix;
using moveit::core::JointModel;
using moveit::core::LinkModel;
using moveit::core::PlanarJointModel;
using moveit::core::RevoluteJointModel;
using moveit::core::RobotModel;
using moveit::core::RobotState;

/* MoveIt's FCL takes the plane ax + by + cz = d, where shape_msgs has ax + by + cz + d = 0. */
bool planesLikeFcl() {
  return ros::NodeHandle("~").param("curve_proximity/planes_like_fcl", false);
}

/* How many attachments are kept: states with and without an object, or at two places, come in turn. */
std::size_t keptAttachments(std::size_t in_one_state) {
  return std::max<std::size_t>(16, 4 * in_one_state);
}

ShapeDescription descriptionOf(const shapes::Shape &shape) {
  ShapeDescription out = fromShape(shape);
  if (shape.type == shapes::PLANE && planesLikeFcl()) out.dimensions[3] = -out.dimensions[3];
  return out;
}

std::uint64_t mixed(std::uint64_t hash, std::uint64_t value) {
  hash = (hash ^ value) * 0x9e3779b97f4a7c15u;
  return hash ^ (hash >> 29);
}

/* Depth first, of each cell that has children: which, and of those that have none which are occupied. */
std::uint64_t mixedCells(const octomap::OcTree &tree, const octomap::OcTreeNode &node, std::uint64_t hash) {
  std::array<const octomap::OcTreeNode *, 8> children, inner;
  unsigned int n_children = 0, n_inner = 0;
  std::uint64_t cells = 0;
  for (unsigned int i = 0; i < 8; ++i) {
    if (!tree.nodeChildExists(&node, i)) continue;
    children[n_children++] = tree.getNodeChild(&node, i);
    cells |= 1u << i;
  }
  for (unsigned int i = 0; i < n_children; ++i) {
    cells <<= 2;
    if (tree.nodeHasChildren(children[i])) {
      cells |= 2;
      inner[n_inner++] = children[i];
    } else if (tree.isNodeOccupied(*children[i])) {
      cells |= 1;
    }
  }
  hash = mixed(hash, cells);
  for (unsigned int i = 0; i < n_inner; ++i) hash = mixedCells(tree, *inner[i], hash);
  return hash;
}

/* A variable of a joint that is an angle without limits; a planar joint has it behind x and y. */
bool goesRound(const JointModel &joint, std::size_t variable) {
  if (joint.getType() == JointModel::REVOLUTE) return static_cast<const RevoluteJointModel &>(joint).isContinuous();
  return joint.getType() == JointModel::PLANAR && variable == 2;
}

/* The angle that is `to` and not more than half a turn from `from`. */
double nearest(double from, double to) {
  return from + std::remainder(to - from, 2.0 * M_PI);
}

void checkInterpolation(const JointModel &joint) {
  if (joint.getType() == JointModel::PLANAR &&
      static_cast<const PlanarJointModel &>(joint).getMotionModel() == PlanarJointModel::DIFF_DRIVE)
    throw Error("joint '" + joint.getName() +
                "' is a differential drive: how it goes from one pose to another is not known here");
}

/* Appends the joint's values, angles beside those of the point before. */
void appendJoint(const JointModel &joint, const RobotState &state, const TrajectoryPoint *before,
                 TrajectoryPoint &point) {
  const double *values = state.getJointPositions(&joint);
  for (std::size_t i = 0; i < joint.getVariableCount(); ++i) {
    const std::size_t k = point.positions.size();
    point.positions.push_back(before && goesRound(joint, i) ? nearest(before->positions[k], values[i]) : values[i]);
  }
}

bool sameJoint(const JointModel &joint, const RobotState &a, const RobotState &b) {
  const double *x = a.getJointPositions(&joint), *y = b.getJointPositions(&joint);
  return std::equal(x, x + joint.getVariableCount(), y);
}

void appendNames(const JointModel &joint, std::vector<std::string> &names) {
  const std::vector<std::string> &variables = joint.getVariableNames();
  names.insert(names.end(), variables.begin(), variables.end());
}

} // namespace

std::shared_ptr<const Robot> toRobot(const RobotModel &model) {
  RobotOptions options;
  for (const LinkModel *link : model.getLinkModels()) {
    std::vector<ShapeDescription> &shapes = options.link_shapes[link->getName()];
    for (std::size_t i = 0; i < link->getShapes().size(); ++i) {
      shapes.push_back(descriptionOf(*link->getShapes()[i]));
      shapes.back().pose = link->getCollisionOriginTransforms()[i];
      shapes.back().solid = shapes.back().type == ShapeType::MESH; // as of a URDF
    }
  }
  return fromModel(*model.getURDF(), options);
}

std::vector<const LinkModel *> linksInOrder(const Robot &robot, const RobotModel &model) {
  std::vector<const LinkModel *> out;
  for (const auto &[name, geometries] : robot.links()) out.push_back(model.getLinkModel(name));
  return out;
}

std::vector<VirtualJoint> virtualJoints(const RobotModel &model) {
  const JointModel &root = *model.getRootJoint();
  if (root.getVariableCount() == 0) return {};
  const std::string type = root.getType() == JointModel::PLANAR ? "planar" : "floating";
  return {{root.getName(), type, model.getModelFrame(), model.getRootLinkName()}};
}

Eigen::Isometry3d baseAt(const RobotState &state) {
  const JointModel &root = *state.getRobotModel()->getRootJoint();
  Eigen::Isometry3d out = Eigen::Isometry3d::Identity();
  root.computeTransform(state.getJointPositions(&root), out);
  return out;
}

std::uint64_t cellsOf(const shapes::Shape &shape) {
  if (shape.type != shapes::OCTREE) return 0;
  const auto &tree = static_cast<const shapes::OcTree &>(shape).octree;
  if (!tree) return 0;
  const std::uint64_t hash = mixed(tree->size(), static_cast<std::uint64_t>(tree->getResolution() * 1e9));
  const octomap::OcTreeNode *root = tree->getRoot();
  if (!root) return hash;
  return tree->nodeHasChildren(root) ? mixedCells(*tree, *root, hash)
                                     : mixed(hash, tree->isNodeOccupied(*root) ? 1 : 2);
}

std::uint64_t cellsOf(const collision_detection::World::Object &object) {
  std::uint64_t out = 0;
  for (const shapes::ShapeConstPtr &shape : object.shapes_)
    if (shape->type == shapes::OCTREE) out = mixed(out, cellsOf(*shape));
  return out;
}

ShapeDescription KnownShapes::at(const shapes::ShapeConstPtr &shape, const Eigen::Isometry3d &pose) {
  ShapeDescription out;
  const bool takes_long = shape->type == shapes::MESH || shape->type == shapes::OCTREE;
  if (takes_long) {
    const std::uint64_t cells = cellsOf(*shape);
    const std::lock_guard<std::mutex> lock(mutex_);
    Known &known = known_[shape.get()];
    if (known.shape.lock() != shape || known.cells != cells) {
      known.shape = shape;
      known.cells = cells;
      known.description = ShapeDescription();
    }
    if (!known.description.made) {
      known.description = descriptionOf(*shape);
      known.description.made = std::make_shared<const Geometry>(makeGeometry(known.description));
    }
    out = known.description;
    if (known_.size() > most_) {
      for (auto it = known_.begin(); it != known_.end();) it = it->second.shape.expired() ? known_.erase(it) : ++it;
      most_ = 2 * known_.size();
    }
  } else {
    out = descriptionOf(*shape);
  }
  out.pose = pose;
  return out;
}

ObjectDescription toObject(const collision_detection::World::Object &object, KnownShapes &shapes) {
  ObjectDescription out;
  out.id = object.id_;
  out.pose = object.pose_;
  for (std::size_t i = 0; i < object.shapes_.size(); ++i)
    out.shapes.push_back(shapes.at(object.shapes_[i], object.shape_poses_[i]));
  return out;
}

bool alwaysAllowed(const AllowedCollisionMatrix &matrix, const std::string &a, const std::string &b) {
  collision_detection::AllowedCollision::Type type;
  return matrix.getAllowedCollision(a, b, type) && type == collision_detection::AllowedCollision::ALWAYS;
}

std::vector<AllowedPair> allowedPairs(const AllowedCollisionMatrix &matrix, const Snapshot &scene,
                                      const AttachedObjects &attached) {
  namespace AllowedCollision = collision_detection::AllowedCollision;
  std::set<std::string> moving;
  for (const auto &[link, geometries] : scene.robot()->links())
    if (!geometries.empty()) moving.insert(link);
  for (const auto &[id, object] : attached) moving.insert(id);

  std::vector<AllowedPair> out;
  AllowedCollision::Type type;
  std::vector<std::string> names;
  matrix.getAllEntryNames(names);
  for (const std::string &a : moving)
    for (const std::string &b : names) {
      if ((a < b || moving.count(b) == 0) && matrix.getEntry(a, b, type))
        out.push_back({a, b, type == AllowedCollision::ALWAYS});
    }
  const auto add_default = [&](const std::string &name) {
    if (matrix.getDefaultEntry(name, type)) out.push_back({name, "", type == AllowedCollision::ALWAYS});
  };
  for (const std::string &name : moving) add_default(name);
  for (const auto &[id, object] : scene.objects()) add_default(id);
  return out;
}

AttachedObjects AttachedBodies::of(const RobotState &state, const Snapshot &scene, KnownShapes &shapes) {
  std::vector<const moveit::core::AttachedBody *> bodies;
  state.getAttachedBodies(bodies);
  AttachedObjects out;
  for (const moveit::core::AttachedBody *body : bodies) {
    const std::string &id = body->getName(), &link = body->getAttachedLinkName();
    const auto scale = scene.linkScales().find(link);
    Known now{id,
              link,
              body->getTouchLinks(),
              body->getShapes(),
              body->getShapePosesInLinkFrame(),
              scale == scene.linkScales().end() ? 1.0 : scale->second,
              0,
              nullptr};
    for (const shapes::ShapeConstPtr &shape : now.shapes)
      if (shape->type == shapes::OCTREE) now.cells = mixed(now.cells, cellsOf(*shape));
    const auto same_pose = [](const Eigen::Isometry3d &a, const Eigen::Isometry3d &b) {
      return a.matrix() == b.matrix();
    };
    const auto before = std::find_if(known_.begin(), known_.end(), [&](const Known &other) {
      return other.id == id && other.link == link && other.touch_links == now.touch_links &&
             other.shapes == now.shapes && other.scale == now.scale && other.cells == now.cells &&
             std::equal(now.poses.begin(), now.poses.end(), other.poses.begin(), other.poses.end(), same_pose);
    });
    if (before != known_.end()) {
      out[id] = before->object;
      std::rotate(before, before + 1, known_.end());
      continue;
    }
    Attachment given;
    given.link = link;
    given.touch_links.assign(now.touch_links.begin(), now.touch_links.end());
    given.object.id = id;
    for (std::size_t i = 0; i < now.shapes.size(); ++i)
      given.object.shapes.push_back(shapes.at(now.shapes[i], now.poses[i]));
    out[id] = now.object = attachedObject(given, now.scale);
    known_.push_back(std::move(now));
  }
  const std::size_t most = keptAttachments(bodies.size());
  if (known_.size() > most) known_.erase(known_.begin(), known_.end() - static_cast<std::ptrdiff_t>(most));
  return out;
}

JointPositions jointPositions(const RobotState &state) {
  JointPositions out;
  for (const std::string &name : state.getVariableNames()) out[name] = state.getVariablePosition(name);
  return out;
}

TrajectoryDescription straight(const RobotState &from, const RobotState &to) {
  TrajectoryDescription out;
  out.points.resize(2);
  out.points[1].time = 1.0;
  for (const JointModel *joint : from.getRobotModel()->getActiveJointModels()) {
    if (joint->getMimic() || sameJoint(*joint, from, to)) continue;
    checkInterpolation(*joint);
    appendNames(*joint, out.joints);
    appendJoint(*joint, from, nullptr, out.points[0]);
    appendJoint(*joint, to, &out.points[0], out.points[1]);
  }
  return out;
}

TrajectoryDescription timed(const robot_trajectory::RobotTrajectory &trajectory) {
  TrajectoryDescription out;
  out.id = trajectory.getGroupName().empty() ? "trajectory" : trajectory.getGroupName();
  const std::size_t n = trajectory.getWayPointCount();
  if (n == 0) throw Error("the trajectory has no waypoint");
  if (n > 1 && !(trajectory.getDuration() > 0.0)) throw Error("the trajectory is not timed");
  std::vector<const JointModel *> joints;
  for (const JointModel *joint : trajectory.getGroup() ? trajectory.getGroup()->getActiveJointModels()
                                                       : trajectory.getRobotModel()->getActiveJointModels()) {
    if (joint->getMimic()) continue;
    checkInterpolation(*joint);
    joints.push_back(joint);
    appendNames(*joint, out.joints);
  }
  if (joints.empty()) throw Error("group '" + trajectory.getGroupName() + "' has no joint that can move");
  out.points.reserve(n);
  double time = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    const RobotState &state = trajectory.getWayPoint(i);
    const double *velocities = state.hasVelocities() ? state.getVariableVelocities() : nullptr,
                 *accelerations = velocities && state.hasAccelerations() ? state.getVariableAccelerations() : nullptr;
    TrajectoryPoint point;
    point.time = time += trajectory.getWayPointDurationFromPrevious(i);
    point.positions.reserve(out.joints.size());
    if (velocities) point.velocities.reserve(out.joints.size());
    if (accelerations) point.accelerations.reserve(out.joints.size());
    for (const JointModel *joint : joints) {
      appendJoint(*joint, state, i > 0 ? &out.points[i - 1] : nullptr, point);
      const std::size_t first = joint->getFirstVariableIndex(), last = first + joint->getVariableCount();
      if (velocities) point.velocities.insert(point.velocities.end(), velocities + first, velocities + last);
      if (accelerations)
        point.accelerations.insert(point.accelerations.end(), accelerations + first, accelerations + last);
    }
    out.points.push_back(std::move(point));
  }
  return out;
}

robot_trajectory::RobotTrajectoryPtr upTo(const robot_trajectory::RobotTrajectory &trajectory, double end) {
  const TrajectoryDescription spline = timed(trajectory);
  auto out = std::make_shared<robot_trajectory::RobotTrajectory>(trajectory.getRobotModel(), trajectory.getGroupName());
  std::size_t next = 0;
  for (; next < spline.points.size() && (next == 0 || spline.points[next].time < end); ++next)
    out->addSuffixWayPoint(trajectory.getWayPoint(next), 0.0);
  if (next == spline.points.size()) return out;
  const TrajectoryPoint &a = spline.points[next - 1], &b = spline.points[next];
  const double step = b.time - a.time, u = (end - a.time) / step, w = 1.0 - u;
  moveit::core::RobotState last(trajectory.getWayPoint(next));
  for (std::size_t i = 0; i < spline.joints.size(); ++i) {
    double value = w * a.positions[i] + u * b.positions[i];
    if (!a.velocities.empty()) { // Hermite's cubic; the accelerations bend it but little
      value = w * w * (1.0 + 2.0 * u) * a.positions[i] + u * u * (1.0 + 2.0 * w) * b.positions[i] +
              u * w * step * (w * a.velocities[i] - u * b.velocities[i]);
    }
    last.setVariablePosition(spline.joints[i], value);
  }
  last.update();
  out->addSuffixWayPoint(last, 0.0);
  return out;
}

} // namespace curve_proximity
