/* SPDX-License-Identifier: BSD-3-Clause */
/* From URDF text to a Robot. urdfdom parses; what it drops without a word is found by counting, and refused. */
#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <locale>
#include <map>
#include <set>
#include <sstream>
#include <system_error>
#include <thread>
#include <utility>

#include <tinyxml2.h>
#include <urdf_parser/urdf_parser.h>

#include <curve_proximity/urdf_model.hpp>

#include "joint_parts.h"
#include "mesh.h"
#include "placing.h"

namespace curve_proximity {
namespace {

using tinyxml2::XMLElement;

std::string attribute(const XMLElement &element, const char *name) {
  const char *text = element.Attribute(name);
  return text ? text : "";
}

/* ---- the document, before urdfdom sees it ---- */

/* Elements that say nothing about where collision geometry is. urdfdom gives up on a whole link where it dislikes one
 * of them, so they are taken out. */
void stripTo(XMLElement &parent, const std::set<std::string> &wanted) {
  for (XMLElement *child = parent.FirstChildElement(); child;) {
    XMLElement *next = child->NextSiblingElement();
    if (!wanted.count(child->Name())) parent.DeleteChild(child);
    child = next;
  }
}

/* Why an attribute is not n finite numbers; "" where it is, or is not there. */
std::string numbersFault(const XMLElement *element, const char *name, int n) {
  const char *text = element ? element->Attribute(name) : nullptr;
  if (!text) return "";
  std::istringstream stream(text);
  stream.imbue(std::locale::classic());
  int found = 0;
  for (double x; stream >> x;) found += std::isfinite(x) ? 1 : 0;
  if (stream.eof() && found == n) return "";
  const std::string wanted = n == 1 ? " is not one finite number" : " is not " + std::to_string(n) + " finite numbers";
  return std::string(element->Name()) + " " + name + "='" + text + "'" + wanted;
}

std::string originFault(const XMLElement &parent) {
  const XMLElement *origin = parent.FirstChildElement("origin");
  const std::string fault = numbersFault(origin, "xyz", 3);
  return fault.empty() ? numbersFault(origin, "rpy", 3) : fault;
}

/* What is wrong with a collision element that urdfdom will not tell; "" where nothing is seen. */
std::string collisionFault(const XMLElement &collision) {
  const XMLElement *geometry = collision.FirstChildElement("geometry");
  const XMLElement *shape = geometry ? geometry->FirstChildElement() : nullptr;
  if (!shape) return "it has no geometry";
  static const std::map<std::string, std::vector<std::pair<const char *, int>>> known = {
      {"box", {{"size", 3}}},
      {"sphere", {{"radius", 1}}},
      {"cylinder", {{"length", 1}, {"radius", 1}}},
      {"mesh", {{"scale", 3}}}};
  const auto kind = known.find(shape->Name());
  if (kind == known.end()) return std::string("geometry '") + shape->Name() + "' is not known to URDF";
  for (const auto &[name, n] : kind->second) {
    if (!shape->Attribute(name) && kind->first != "mesh") return kind->first + " has no " + name;
    const std::string fault = numbersFault(shape, name, n);
    if (!fault.empty()) return fault;
  }
  return originFault(collision);
}

void checkJointElement(const XMLElement &joint) {
  const std::string name = attribute(joint, "name");
  if (name.empty()) throw Error("a joint has no name");
  const std::string who = "joint '" + name + "': ";

  // A type that there is, two ends, limits where they are needed.
  static const std::set<std::string> types = {"revolute", "continuous", "prismatic", "fixed", "planar", "floating"};
  const std::string type = attribute(joint, "type");
  if (!types.count(type)) throw Error(who + "its type '" + type + "' is not known to URDF");
  for (const char *end : {"parent", "child"}) {
    const XMLElement *element = joint.FirstChildElement(end);
    if (!element || attribute(*element, "link").empty()) throw Error(who + "it has no " + end + " link");
  }
  const XMLElement *limit = joint.FirstChildElement("limit");
  if ((type == "revolute" || type == "prismatic") && !limit) throw Error(who + "a " + type + " joint needs limits");

  // Numbers that are numbers.
  const XMLElement *mimic = joint.FirstChildElement("mimic");
  for (const std::string &fault :
       {originFault(joint), numbersFault(joint.FirstChildElement("axis"), "xyz", 3), numbersFault(limit, "lower", 1),
        numbersFault(limit, "upper", 1), numbersFault(mimic, "multiplier", 1), numbersFault(mimic, "offset", 1)}) {
    if (!fault.empty()) throw Error(who + fault);
  }
}

/* What stands in the document: for each link its collision elements, as the faults that are seen in them. */
using Inventory = std::map<std::string, std::vector<std::string>>;

void readLinkElements(XMLElement &robot, Inventory &inventory) {
  for (XMLElement *link = robot.FirstChildElement("link"); link; link = link->NextSiblingElement("link")) {
    const std::string name = attribute(*link, "name");
    if (name.empty()) throw Error("a link has no name");
    if (inventory.count(name)) throw Error("link '" + name + "' occurs twice");
    stripTo(*link, {"collision"});
    std::vector<std::string> &faults = inventory[name];
    for (XMLElement *c = link->FirstChildElement("collision"); c; c = c->NextSiblingElement("collision")) {
      faults.push_back(collisionFault(*c));
    }
  }
  if (inventory.empty()) throw Error("the robot has no links");
}

void readJointElements(XMLElement &robot, const Inventory &inventory) {
  std::set<std::string> joints, children;
  for (XMLElement *joint = robot.FirstChildElement("joint"); joint; joint = joint->NextSiblingElement("joint")) {
    checkJointElement(*joint);
    const std::string name = attribute(*joint, "name");
    if (!joints.insert(name).second) throw Error("joint '" + name + "' occurs twice");
    stripTo(*joint, {"parent", "child", "origin", "axis", "limit", "mimic"});
    for (const char *end : {"parent", "child"}) {
      const std::string link = attribute(*joint->FirstChildElement(end), "link");
      if (!inventory.count(link)) {
        throw Error("joint '" + name + "': its " + end + " link '" + link + "' does not exist");
      }
    }
    const std::string child = attribute(*joint->FirstChildElement("child"), "link");
    if (!children.insert(child).second) throw Error("link '" + child + "' is the child of two joints");
  }
}

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

ShapeDescription describe(const urdf::Collision &collision, const std::string &who) {
  ShapeDescription shape;
  shape.pose = toPose(collision.origin, who);
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
      if (shape.resource.empty()) throw Error(who + "its mesh has no file name");
      break;
    }
  }
  return shape;
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
    // Well-formed, and structured as a URDF.
    tinyxml2::XMLDocument document;
    if (document.Parse(xml.c_str(), xml.size()) != tinyxml2::XML_SUCCESS) {
      throw Error("the URDF is no XML: " + std::string(document.ErrorStr()));
    }
    XMLElement *root = document.FirstChildElement("robot");
    if (!root) throw Error("the URDF has no <robot> element");
    if (attribute(*root, "name").empty()) throw Error("the robot has no name");
    stripTo(*root, {"link", "joint"});
    Inventory inventory;
    readLinkElements(*root, inventory);
    readJointElements(*root, inventory);

    // Parsed by urdfdom.
    tinyxml2::XMLPrinter printer;
    document.Print(&printer);
    return read(*parse(printer.CStr()), std::move(inventory));
  }

  std::shared_ptr<const Robot> read(const urdf::ModelInterface &model) {
    if (!model.getRoot()) throw Error("robot '" + model.getName() + "': the model has no root link");
    Inventory inventory;
    for (const auto &[name, link] : model.links_) {
      inventory[name].resize(link->collision_array.size());
      for (const urdf::CollisionSharedPtr &collision : link->collision_array)
        if (!collision || !collision->geometry) throw Error("link '" + name + "': a collision element has no geometry");
    }
    return read(model, std::move(inventory));
  }

 private:
  std::shared_ptr<const Robot> read(const urdf::ModelInterface &model, Inventory inventory) {
    robot_->name_ = model.getName();
    robot_->resources_ = options_.resources;
    robot_->root_link_ = model.getRoot()->name;
    readJoints(model);
    for (const auto &[link, shapes] : options_.link_shapes) {
      if (inventory.erase(link) == 0)
        throw Error("link_shapes: robot '" + robot_->name_ + "' has no link '" + link + "'");
      std::vector<LinkGeometry> &geometry = robot_->links_[link];
      for (std::size_t i = 0; i < shapes.size(); ++i)
        addGeometry([&] { return shapes[i]; }, elementName(link, i, shapes.size()), geometry);
    }
    readLinks(model, inventory);
    return robot_;
  }

  static urdf::ModelInterfaceSharedPtr parse(const char *xml) {
    urdf::ModelInterfaceSharedPtr model;
    try {
      model = urdf::parseURDF(xml);
    } catch (const std::exception &error) {
      throw Error(std::string("the URDF cannot be read: ") + error.what());
    }
    if (!model || !model->getRoot()) {
      throw Error("the URDF cannot be read: its links are no tree with one root, or a number is none");
    }
    return model;
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
  void loadMeshes(const urdf::ModelInterface &model, const Inventory &inventory) {
    for (const auto &[name, faults] : inventory) {
      const urdf::LinkConstSharedPtr link = model.getLink(name);
      if (!link) continue;
      for (const urdf::CollisionSharedPtr &collision : link->collision_array) requestMesh(*collision);
    }
    std::vector<std::pair<const MeshRequest, LoadedMesh> *> files;
    for (auto &entry : meshes_) files.push_back(&entry);
    forEachInParallel(files.size(), options_.threads, [&](std::size_t i) {
      const auto &[request, loaded] = *files[i];
      LoadedMesh &out = files[i]->second;
      try {
        out.geometry = loadMeshGeometry(request, options_.resources, &out.timing);
      } catch (...) {
        out.error = std::current_exception();
      }
    });
    for (const auto &[request, loaded] : meshes_)
      if (!loaded.error) robot_->mesh_timings_.push_back(loaded.timing);
  }

  void requestMesh(const urdf::Collision &collision) {
    try {
      const ShapeDescription shape = describe(collision, "");
      if (shape.type != ShapeType::MESH) return;
      const std::string file = resolveResource(shape.resource, options_.resources);
      meshes_[{shape.resource, file, meshScale(shape), shape.solid}];
    } catch (const Error &) { /* told later */
    }
  }

  Geometry loadedMesh(const MeshRequest &request) const {
    const auto it = meshes_.find(request);
    if (it == meshes_.end()) return loadMeshGeometry(request, options_.resources);
    if (it->second.error) std::rethrow_exception(it->second.error);
    return it->second.geometry;
  }

  void readLinks(const urdf::ModelInterface &model, const Inventory &inventory) {
    loadMeshes(model, inventory);
    for (const auto &[name, faults] : inventory) {
      const urdf::LinkConstSharedPtr link = model.getLink(name);
      if (!link) throw Error("link '" + name + "' was not understood");
      std::vector<LinkGeometry> &geometry = robot_->links_[name];
      for (std::size_t i = 0; i < link->collision_array.size(); ++i) {
        addGeometry([&] { return describe(*link->collision_array[i], ""); }, elementName(name, i, faults.size()),
                    geometry);
      }
      reportDropped(name, faults, link->collision_array.size());
    }
  }

  template <class Description>
  void addGeometry(Description description, const std::string &who, std::vector<LinkGeometry> &to) {
    try {
      LinkGeometry out;
      out.description = description();
      out.pose = out.description.pose;
      checkPose(out.pose, "its pose");
      out.geometry = makeGeometry(out.description, options_.resources,
                                  [this](const MeshRequest &request) { return loadedMesh(request); });
      to.push_back(std::move(out));
    } catch (const Error &error) {
      fault(who + error.what());
    }
  }

  /* urdfdom stops at the first collision element of a link that it cannot read. */
  void reportDropped(const std::string &name, const std::vector<std::string> &faults, std::size_t parsed) {
    for (std::size_t i = parsed; i < faults.size(); ++i) {
      const char *otherwise = i == parsed ? "it cannot be read" : "it comes after one that cannot be read";
      fault(elementName(name, i, faults.size()) + (faults[i].empty() ? otherwise : faults[i]));
    }
  }

  void fault(const std::string &sentence) {
    if (!options_.allow_missing_geometry) throw Error(sentence);
    robot_->warnings_.push_back(sentence + "; left out");
  }

  struct LoadedMesh {
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
