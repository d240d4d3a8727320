/* SPDX-License-Identifier: BSD-3-Clause */
/* From URDF text, or from a model that urdfdom has read, to a Robot. */
#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <map>
#include <set>
#include <system_error>
#include <thread>
#include <utility>

#include <curve_proximity/urdf_model.hpp>

#include "geometry/mesh.h"
#include "geometry/placing.h"
#include "joint_parts.h"
#include "urdf_document.h"

namespace curve_proximity {
namespace {

/* ---- urdfdom's types in Eigen's ---- */

Eigen::Vector3d toEigen(const urdf::Vector3 &v) {
  return {v.x, v.y, v.z};
}

Eigen::Isometry3d toPose(const urdf::Pose &pose, const std::string &who) {
  const urdf::Rotation &r = pose.rotation;
  const Eigen::Vector3d position = toEigen(pose.position);
  if (!position.allFinite()) throw Error(who + "its origin is not finite");
  try {
    return toIsometry({toVec3(position), {r.w, r.x, r.y, r.z}});
  } catch (const Error &error) {
    throw Error(who + "its origin: " + error.what());
  }
}

ShapeDescription describe(const urdf::Collision &collision) {
  ShapeDescription shape;
  shape.pose = toPose(collision.origin, "");
  const urdf::Geometry &geometry = *collision.geometry;
  switch (geometry.type) {
    case urdf::Geometry::SPHERE:
      shape.type = ShapeType::SPHERE;
      shape.dimensions = {static_cast<const urdf::Sphere &>(geometry).radius};
      break;
    case urdf::Geometry::BOX: {
      const urdf::Vector3 &size = static_cast<const urdf::Box &>(geometry).dim;
      shape.type = ShapeType::BOX;
      shape.dimensions = {size.x, size.y, size.z};
      break;
    }
    case urdf::Geometry::CYLINDER: {
      const auto &cylinder = static_cast<const urdf::Cylinder &>(geometry);
      shape.type = ShapeType::CYLINDER;
      shape.dimensions = {cylinder.length, cylinder.radius};
      break;
    }
    case urdf::Geometry::MESH: {
      const auto &mesh = static_cast<const urdf::Mesh &>(geometry);
      shape.type = ShapeType::MESH;
      shape.resource = mesh.filename;
      shape.solid = true; // a link is made of something: what is wholly inside it hits it, where its mesh is closed
      shape.dimensions = {mesh.scale.x, mesh.scale.y, mesh.scale.z};
      if (shape.resource.empty()) throw Error("its mesh has no file name");
      break;
    }
  }
  return shape;
}

UrdfElement elementOf(const urdf::Collision &collision) {
  try {
    return {describe(collision), ""};
  } catch (const Error &error) {
    return {{}, error.what()};
  }
}

/* work(i) for all i < n, by so many threads (0: as many as the machine has). It must not throw. */
template <class Work>
void forEachInParallel(std::size_t n, unsigned threads, Work work) {
  if (threads == 0) threads = std::max(1U, std::thread::hardware_concurrency());
  std::atomic<std::size_t> next{0};
  const auto serve = [&] {
    for (std::size_t i = next++; i < n; i = next++) work(i);
  };
  std::vector<std::thread> others;
  try {
    while (others.size() + 1 < std::min<std::size_t>(threads, n)) others.emplace_back(serve);
  } catch (const std::system_error &) { /* fewer will do */
  }
  serve();
  for (std::thread &thread : others) thread.join();
}

std::string elementName(const std::string &link, std::size_t number, std::size_t of) {
  const std::string which = of > 1 ? ", collision element " + std::to_string(number + 1) : "";
  return "link '" + link + "'" + which + ": ";
}

} // namespace

/* ---- the reader ---- */

/* Builds one Robot; has access to its members. */
class RobotReader {
 public:
  explicit RobotReader(const RobotOptions &options) : options_(options), robot_(new Robot) {}

  std::shared_ptr<const Robot> read(const std::string &xml) {
    UrdfDocument document = readUrdf(xml);
    for (const std::string &message : document.unknown) {
      leaveOut(message);
      robot_->coverage_.add(Gap::PARTIAL, message);
    }
    return read(*document.model, std::move(document.elements));
  }

  std::shared_ptr<const Robot> read(const urdf::ModelInterface &model) {
    if (!model.getRoot()) throw Error("robot '" + model.getName() + "': the model has no root link");
    UrdfElements elements;
    for (const auto &[name, link] : model.links_) {
      std::vector<UrdfElement> &of_link = elements[name];
      for (const urdf::CollisionSharedPtr &collision : link->collision_array) {
        if (!collision || !collision->geometry) throw Error("link '" + name + "': a collision element has no geometry");
        of_link.push_back(elementOf(*collision));
      }
    }
    return read(model, std::move(elements));
  }

 private:
  std::shared_ptr<const Robot> read(const urdf::ModelInterface &model, UrdfElements elements) {
    robot_->name_ = model.getName();
    robot_->resources_ = options_.resources;
    robot_->root_link_ = model.getRoot()->name;
    readJoints(model);
    for (const auto &[link, shapes] : options_.link_shapes) {
      const auto replaced = elements.find(link);
      if (replaced == elements.end())
        throw Error("link_shapes: robot '" + robot_->name_ + "' has no link '" + link + "'");
      replaced->second.clear();
      for (const ShapeDescription &shape : shapes) replaced->second.push_back({shape, ""});
    }
    readLinks(elements);
    return robot_;
  }

  /* What is neither used nor known to say nothing of geometry. */
  void leaveOut(const std::string &message) {
    robot_->warnings_.push_back(message + "; left out");
  }

  /* The joints from the root outwards; every link must be met. */
  void readJoints(const urdf::ModelInterface &model) {
    std::vector<std::string> reached = {robot_->root_link_};
    for (std::size_t i = 0; i < reached.size(); ++i) {
      for (const urdf::JointSharedPtr &joint : model.getLink(reached[i])->child_joints) {
        addJoint(*joint);
        reached.push_back(joint->child_link_name);
      }
    }
    for (const auto &[name, link] : model.links_) {
      if (name != robot_->root_link_ && (!link->parent_joint || !robot_->hasJoint(link->parent_joint->name))) {
        throw Error("link '" + name + "' is not connected to the root link '" + robot_->root_link_ + "'");
      }
    }
    for (Robot::Joint &joint : robot_->joints_) resolveMimic(joint, model);
  }

  void addJoint(const urdf::Joint &from) {
    const std::string who = "joint '" + from.name + "': ";
    Robot::Joint joint;
    joint.name = from.name;
    joint.parent = from.parent_link_name;
    joint.child = from.child_link_name;
    joint.origin = toPose(from.parent_to_joint_origin_transform, who);
    switch (from.type) {
      case urdf::Joint::REVOLUTE:
      case urdf::Joint::CONTINUOUS: joint.type = Robot::JointType::REVOLUTE; break;
      case urdf::Joint::PRISMATIC: joint.type = Robot::JointType::PRISMATIC; break;
      case urdf::Joint::PLANAR: joint.type = Robot::JointType::PLANAR; break;
      case urdf::Joint::FLOATING: joint.type = Robot::JointType::FLOATING; break;
      default: joint.type = Robot::JointType::FIXED; break;
    }

    // An axis is a direction.
    if (joint.type != Robot::JointType::FIXED && joint.type != Robot::JointType::FLOATING) {
      const Eigen::Vector3d axis = toEigen(from.axis);
      if (!axis.allFinite() || !(axis.norm() > 0.0)) throw Error(who + "its axis is not finite or has length 0");
      joint.axis = axis.stableNormalized();
    }

    // At rest at 0, or mid-range where 0 is outside the limits.
    const bool limited = from.type == urdf::Joint::REVOLUTE || from.type == urdf::Joint::PRISMATIC;
    if (limited && from.limits) {
      const double lower = from.limits->lower, upper = from.limits->upper;
      if (!(lower <= upper)) throw Error(who + "its lower limit is above its upper limit, or none is a number");
      if (lower > 0.0 || upper < 0.0) joint.rest = 0.5 * lower + 0.5 * upper;
      if (!std::isfinite(joint.rest)) throw Error(who + "its limits are not finite");
      joint.lower = lower;
      joint.upper = upper;
    }
    addVariables(joint);
    robot_->joints_.push_back(std::move(joint));
  }

  void addVariables(const Robot::Joint &joint) {
    std::vector<std::string> names;
    switch (joint.type) {
      case Robot::JointType::FIXED: break;
      case Robot::JointType::REVOLUTE:
      case Robot::JointType::PRISMATIC: names = {joint.name}; break;
      case Robot::JointType::PLANAR:
        for (const char *part : PLANAR_PARTS) names.push_back(joint.name + part);
        break;
      case Robot::JointType::FLOATING:
        for (const char *part : FLOATING_PARTS) names.push_back(joint.name + part);
        break;
    }
    const std::size_t index = robot_->joints_.size();
    robot_->joint_by_name_.emplace(joint.name, index);
    for (const std::string &name : names) robot_->joint_by_name_.emplace(name, index);
    robot_->variables_.insert(robot_->variables_.end(), names.begin(), names.end());
  }

  /* Follows mimic tags to a joint that mimics nothing. */
  void resolveMimic(Robot::Joint &joint, const urdf::ModelInterface &model) const {
    const std::string who = "joint '" + joint.name + "': ";
    const auto scalar = [](const Robot::Joint &j) {
      return j.type != Robot::JointType::PLANAR && j.type != Robot::JointType::FLOATING;
    };
    urdf::JointConstSharedPtr at = model.getJoint(joint.name);
    if (!at->mimic || joint.type == Robot::JointType::FIXED) return;
    if (!scalar(joint)) throw Error(who + "a planar or floating joint cannot mimic another");

    for (std::set<std::string> seen = {joint.name}; at->mimic && at->type != urdf::Joint::FIXED;) {
      const urdf::JointMimic &mimic = *at->mimic;
      if (!std::isfinite(mimic.multiplier) || !std::isfinite(mimic.offset)) {
        throw Error(who + "its mimic multiplier or offset is not finite");
      }
      joint.offset += joint.multiplier * mimic.offset;
      joint.multiplier *= mimic.multiplier;
      at = model.getJoint(mimic.joint_name);
      if (!at || !robot_->hasJoint(at->name)) {
        throw Error(who + "it mimics joint '" + mimic.joint_name + "', which does not exist");
      }
      if (!seen.insert(at->name).second) throw Error(who + "its mimic tags run in a ring");
    }
    if (!scalar(robot_->joints_[robot_->joint_by_name_.at(at->name)])) {
      throw Error(who + "it mimics joint '" + at->name + "', which is planar or floating");
    }
    joint.leader = at->name;
  }

  /* The mesh files of all links, each once, loaded by several threads. What cannot be resolved is told where its link
   * is read. */
  void loadMeshes(const UrdfElements &elements) {
    for (const auto &[name, of_link] : elements)
      for (const UrdfElement &element : of_link) requestMesh(element);
    std::vector<std::pair<const MeshRequest, LoadedMesh> *> files;
    for (auto &entry : meshes_) files.push_back(&entry);
    forEachInParallel(files.size(), options_.threads, [&](std::size_t i) {
      const auto &[request, loaded] = *files[i];
      LoadedMesh &out = files[i]->second;
      try {
        out.geometry = loadMeshGeometry(request, options_.resources, &out.timing, &out.remark);
      } catch (...) {
        out.error = std::current_exception();
      }
    });
    for (const auto &[request, loaded] : meshes_)
      if (!loaded.error) robot_->mesh_timings_.push_back(loaded.timing);
  }

  void requestMesh(const UrdfElement &element) {
    const ShapeDescription &shape = element.shape;
    if (!element.fault.empty() || shape.type != ShapeType::MESH || shape.resource.empty()) return;
    try {
      const std::string file = resolveResource(shape.resource, options_.resources);
      meshes_[{shape.resource, file, meshScale(shape), shape.solid}];
    } catch (const Error &) { /* told later */
    }
  }

  Geometry loadedMesh(const MeshRequest &request, std::string &remark) const {
    const auto it = meshes_.find(request);
    if (it == meshes_.end()) return loadMeshGeometry(request, options_.resources, nullptr, &remark);
    if (it->second.error) std::rethrow_exception(it->second.error);
    remark = it->second.remark;
    return it->second.geometry;
  }

  void readLinks(const UrdfElements &elements) {
    loadMeshes(elements);
    for (const auto &[name, of_link] : elements) {
      std::vector<LinkGeometry> &geometry = robot_->links_[name];
      for (std::size_t i = 0; i < of_link.size(); ++i)
        addGeometry(of_link[i], elementName(name, i, of_link.size()), geometry);
    }
  }

  void addGeometry(const UrdfElement &element, const std::string &who, std::vector<LinkGeometry> &to) {
    try {
      if (!element.fault.empty()) throw Error(element.fault);
      LinkGeometry out;
      out.description = element.shape;
      out.pose = out.description.pose;
      checkPose(out.pose, "its pose");
      std::string remark;
      out.geometry = makeGeometry(out.description, options_.resources,
                                  [&](const MeshRequest &request) { return loadedMesh(request, remark); });
      if (!remark.empty()) robot_->warnings_.push_back(who + "mesh '" + out.description.resource + "': " + remark);
      to.push_back(std::move(out));
    } catch (const Error &error) {
      fault(who + error.what());
    }
  }

  void fault(const std::string &message) {
    if (!options_.allow_missing_geometry) throw Error(message);
    leaveOut(message);
    robot_->coverage_.add(Gap::PARTIAL, message, Missing::GEOMETRY);
  }

  struct LoadedMesh {
    std::string remark;
    Geometry geometry;
    MeshTiming timing;
    std::exception_ptr error;
  };

  const RobotOptions &options_;
  std::shared_ptr<Robot> robot_;
  std::map<MeshRequest, LoadedMesh> meshes_;
};

std::shared_ptr<const Robot> Robot::fromUrdf(const std::string &xml, const RobotOptions &options) {
  return RobotReader(options).read(xml);
}

std::shared_ptr<const Robot> fromModel(const urdf::ModelInterface &model, const RobotOptions &options) {
  return RobotReader(options).read(model);
}

} // namespace curve_proximity
