/* SPDX-License-Identifier: BSD-3-Clause */
#include "urdf_document.h"

#include <algorithm>
#include <cmath>
#include <locale>
#include <set>
#include <sstream>

#include <tinyxml2.h>

#include <curve_proximity/nearest_name.hpp>

#include "xacro.h"

namespace curve_proximity {
namespace {

using tinyxml2::XMLAttribute;
using tinyxml2::XMLElement;

std::string attribute(const XMLElement &element, const char *name) {
  const char *text = element.Attribute(name);
  return text ? text : "";
}

std::string lineOf(const XMLElement &element) {
  return " (line " + std::to_string(element.GetLineNum()) + ")";
}

/* ---- numbers ---- */

/* n finite numbers of an attribute. Throws Error where it is not there or is something else. */
std::vector<double> numbers(const XMLElement &element, const char *name, std::size_t n) {
  const char *text = element.Attribute(name);
  if (!text) throw Error(std::string(element.Name()) + " has no " + name);
  std::istringstream stream(text);
  stream.imbue(std::locale::classic());
  std::vector<double> out;
  for (double x; stream >> x;) out.push_back(x);
  const bool finite = std::all_of(out.begin(), out.end(), [](double x) { return std::isfinite(x); });
  if (stream.eof() && finite && out.size() == n) return out;
  const std::string wanted = n == 1 ? " is not one finite number" : " is not " + std::to_string(n) + " finite numbers";
  throw Error(std::string(element.Name()) + " " + name + "='" + text + "'" + wanted);
}

/* The same, or what stands for it where it is not there. */
std::vector<double> numbersOr(const XMLElement *element, const char *name, const std::vector<double> &otherwise) {
  return element && element->Attribute(name) ? numbers(*element, name, otherwise.size()) : otherwise;
}

double lengthOf(const XMLElement &element, const char *name) {
  const double out = numbers(element, name, 1).front();
  if (out < 0.0)
    throw Error(std::string(element.Name()) + " " + name + "='" + element.Attribute(name) + "' is below 0");
  return out;
}

/* ---- the reader ---- */

class Document {
 public:
  UrdfDocument read(const std::string &xml) {
    tinyxml2::XMLDocument document;
    if (document.Parse(xml.c_str(), xml.size()) != tinyxml2::XML_SUCCESS)
      throw Error("the URDF is no XML: " + std::string(document.ErrorStr()));
    const XMLElement *first = document.RootElement();
    for (const auto &[name, format] : {std::make_pair("mujoco", "MuJoCo's MJCF"), std::make_pair("sdf", "an SDF file")})
      if (first && std::string(first->Name()) == name)
        throw Error(std::string("this is ") + format + " (<" + name + ">), not a URDF: convert it to one first");
    const XMLElement *root = document.FirstChildElement("robot");
    if (!root) throw Error("the URDF has no <robot> element");
    if (const XMLElement *second = root->NextSiblingElement())
      throw Error("the URDF has a second element" + lineOf(*second) + ": <" + second->Name() + ">");
    refuseXacro(*root, {"link", "joint"});
    if (attribute(*root, "name").empty()) throw Error("the robot has no name");
    const std::string version = attribute(*root, "version");
    if (!version.empty() && !isAmong(version, {"1", "1.0", "1.1"}))
      throw Error("the URDF's version '" + version + "' is not known: 1.0 and 1.1 are");

    out_.model = std::make_shared<urdf::ModelInterface>();
    out_.model->clear();
    out_.model->name_ = attribute(*root, "name");
    note("the robot", *root, {"link", "joint"},
         {"material", "transmission", "gazebo", "sensor", "ros2_control", "mujoco", "frame", "verbose"});
    for (const XMLElement *e = root->FirstChildElement("link"); e; e = e->NextSiblingElement("link")) readLink(*e);
    if (out_.elements.empty()) throw Error("the robot has no links");
    for (const XMLElement *e = root->FirstChildElement("joint"); e; e = e->NextSiblingElement("joint")) readJoint(*e);
    makeTree();
    return std::move(out_);
  }

 private:
  /* Children that are not used, and of which it is not known that they say nothing of geometry. */
  void note(const std::string &who, const XMLElement &parent, const Words &used, const Words &harmless) {
    Words known = used;
    known.insert(known.end(), harmless.begin(), harmless.end());
    for (const XMLElement *child = parent.FirstChildElement(); child; child = child->NextSiblingElement())
      if (!isAmong(child->Name(), known))
        out_.unknown.push_back(who + ": <" + child->Name() + ">" + lineOf(*child) + " is not known" +
                               didYouMean(child->Name(), known));
  }

  void noteAttributes(const std::string &who, const XMLElement &element, const Words &known) {
    for (const XMLAttribute *a = element.FirstAttribute(); a; a = a->Next())
      if (!isAmong(a->Name(), known))
        out_.unknown.push_back(who + ": the attribute '" + a->Name() + "' of <" + element.Name() + ">" +
                               lineOf(element) + " is not known" + didYouMean(a->Name(), known));
  }

  /* The one child of that name; null: there is none. */
  static const XMLElement *onlyChild(const XMLElement &parent, const char *name) {
    const XMLElement *out = parent.FirstChildElement(name);
    if (const XMLElement *second = out ? out->NextSiblingElement(name) : nullptr)
      throw Error("it has two of <" + std::string(name) + ">" + lineOf(*second));
    return out;
  }

  /* The same, of one that has these attributes and nothing inside. */
  const XMLElement *onlyLeaf(const std::string &who, const XMLElement &parent, const char *name,
                             const Words &attributes) {
    const XMLElement *out = onlyChild(parent, name);
    if (!out) return nullptr;
    noteAttributes(who, *out, attributes);
    note(who, *out, {}, {});
    return out;
  }

  /* Its position, and its rotation by rpy or, of URDF 1.1, by quat_xyzw. */
  urdf::Pose originOf(const std::string &who, const XMLElement &parent) {
    urdf::Pose pose;
    pose.clear();
    const XMLElement *origin = onlyLeaf(who, parent, "origin", {"xyz", "rpy", "quat_xyzw"});
    if (!origin) return pose;
    const std::vector<double> p = numbersOr(origin, "xyz", {0, 0, 0}), r = numbersOr(origin, "rpy", {0, 0, 0});
    pose.position = urdf::Vector3(p[0], p[1], p[2]);
    pose.rotation.setFromRPY(r[0], r[1], r[2]);
    if (!origin->Attribute("quat_xyzw")) return pose;
    if (origin->Attribute("rpy")) throw Error("origin has both rpy and quat_xyzw");
    const std::vector<double> q = numbers(*origin, "quat_xyzw", 4);
    if (!(std::abs(Eigen::Map<const Eigen::Vector4d>(q.data()).stableNorm() - 1.0) <= 1e-3))
      throw Error(std::string("origin quat_xyzw='") + origin->Attribute("quat_xyzw") + "': its norm is not 1");
    pose.rotation = urdf::Rotation(q[0], q[1], q[2], q[3]);
    return pose;
  }

  /* Flat shapes, lines and points, as the hull of a box's corners. */
  static ShapeDescription hullOfBox(const Eigen::Vector3d &size) {
    ShapeDescription out;
    out.type = size.isZero(0.0) ? ShapeType::POINT : ShapeType::POLYTOPE;
    std::vector<Eigen::Vector3d> corners = {Eigen::Vector3d::Zero()};
    for (int k = 0; k < 3; ++k) {
      if (size[k] == 0.0) continue;
      const std::size_t n = corners.size();
      for (std::size_t i = 0; i < n; ++i) corners.push_back(corners[i] + 0.5 * size[k] * Eigen::Vector3d::Unit(k));
      for (std::size_t i = 0; i < n; ++i) corners[i][k] = -0.5 * size[k];
    }
    if (out.type == ShapeType::POINT) return out;
    out.vertices.resize(3, static_cast<Eigen::Index>(corners.size()));
    for (std::size_t i = 0; i < corners.size(); ++i) out.vertices.col(static_cast<Eigen::Index>(i)) = corners[i];
    return out;
  }

  static ShapeDescription shapeOf(ShapeType type, std::vector<double> dimensions) {
    ShapeDescription out;
    out.type = type;
    out.dimensions = std::move(dimensions);
    return out;
  }

  ShapeDescription readShape(const std::string &who, const XMLElement &geometry) {
    const XMLElement *shape = geometry.FirstChildElement();
    if (!shape) throw Error("it has no geometry");
    if (const XMLElement *second = shape->NextSiblingElement())
      throw Error("it has two geometries, <" + std::string(shape->Name()) + "> and <" + second->Name() + ">" +
                  lineOf(*second) + ": give each a collision element of its own");
    const std::string name = shape->Name();
    const auto known = [&](const Words &attributes) {
      noteAttributes(who, *shape, attributes);
      note(who, *shape, {}, {"drake:declare_convex"});
    };

    if (name == "box") {
      known({"size"});
      const std::vector<double> d = numbers(*shape, "size", 3);
      for (const double x : d)
        if (x < 0.0) throw Error(std::string("box size='") + shape->Attribute("size") + "' is below 0");
      const bool solid = d[0] > 0.0 && d[1] > 0.0 && d[2] > 0.0;
      return solid ? shapeOf(ShapeType::BOX, d) : hullOfBox({d[0], d[1], d[2]});
    }
    if (name == "sphere") {
      known({"radius"});
      const double radius = lengthOf(*shape, "radius");
      return radius > 0.0 ? shapeOf(ShapeType::SPHERE, {radius}) : hullOfBox({0, 0, 0});
    }
    if (name == "cylinder" || name == "capsule") {
      known({"length", "radius"});
      const double length = lengthOf(*shape, "length"), radius = lengthOf(*shape, "radius");
      if (radius == 0.0) return hullOfBox({0, 0, length});
      if (name == "cylinder") return shapeOf(ShapeType::CYLINDER, {length > 0.0 ? length : kThin, radius});
      return length > 0.0 ? shapeOf(ShapeType::CAPSULE, {length, radius}) : shapeOf(ShapeType::SPHERE, {radius});
    }
    if (name == "mesh") {
      known({"filename", "scale"});
      ShapeDescription mesh = shapeOf(ShapeType::MESH, numbersOr(shape, "scale", {1, 1, 1}));
      mesh.resource = attribute(*shape, "filename");
      mesh.solid = true; // a link is made of something: what is wholly inside it hits it, where its mesh is closed
      if (mesh.resource.empty()) throw Error("its mesh has no file name");
      return mesh;
    }
    throw Error("geometry '" + name + "' is not known to URDF" +
                didYouMean(name, {"box", "sphere", "cylinder", "capsule", "mesh"}));
  }

  UrdfElement readCollision(const std::string &who, const XMLElement &collision) {
    UrdfElement out;
    note(who, collision, {"geometry", "origin"},
         {"name", "verbose", "material", "contact_coefficients", "max_contacts", "surface",
          "drake:proximity_properties"});
    try {
      const XMLElement *geometry = onlyChild(collision, "geometry");
      if (!geometry) throw Error("it has no geometry");
      out.shape = readShape(who, *geometry);
      const urdf::Pose pose = originOf(who, collision);
      const urdf::Rotation &r = pose.rotation;
      out.shape.pose = toIsometry({{pose.position.x, pose.position.y, pose.position.z}, {r.w, r.x, r.y, r.z}});
    } catch (const Error &error) {
      out.fault = error.what();
    }
    return out;
  }

  void readLink(const XMLElement &element) {
    const std::string name = attribute(element, "name");
    if (name.empty()) throw Error("a link has no name");
    const std::string who = "link '" + name + "'";
    const auto [entry, is_new] = out_.elements.emplace(name, std::vector<UrdfElement>());
    if (!is_new) throw Error(who + " occurs twice");
    note(who, element, {"collision"},
         {"visual", "inertial", "gazebo", "sensor", "material", "contact", "self_collision_checking"});
    for (const XMLElement *c = element.FirstChildElement("collision"); c; c = c->NextSiblingElement("collision"))
      entry->second.push_back(readCollision(who, *c));
    const auto link = std::make_shared<urdf::Link>();
    link->name = name;
    out_.model->links_.emplace(name, link);
  }

  void readJoint(const XMLElement &element) {
    const std::string name = attribute(element, "name");
    if (name.empty()) throw Error("a joint has no name");
    const std::string who = "joint '" + name + "'";
    if (out_.model->joints_.count(name) > 0) throw Error(who + " occurs twice");
    try {
      const auto joint = readJoint(name, who, element);
      out_.model->joints_.emplace(name, joint);
      for (const auto &[end, link] :
           {std::make_pair("parent", joint->parent_link_name), std::make_pair("child", joint->child_link_name)})
        if (out_.elements.count(link) == 0)
          throw Error("its " + std::string(end) + " link '" + link + "' does not exist" +
                      didYouMean(link, namesOf(out_.elements)));
      if (!children_.insert(joint->child_link_name).second)
        throw Error("link '" + joint->child_link_name + "' is the child of two joints");
    } catch (const Error &error) {
      throw Error(who + ": " + error.what());
    }
  }

  urdf::JointSharedPtr readJoint(const std::string &name, const std::string &who, const XMLElement &element) {
    note(who, element, {"parent", "child", "origin", "axis", "limit", "mimic"},
         {"dynamics", "safety_controller", "calibration", "gazebo", "sensor", "hardwareInterface"});
    const auto out = std::make_shared<urdf::Joint>();
    out->clear();
    out->name = name;
    out->type = typeOf(attribute(element, "type"));
    out->parent_link_name = endOf(who, element, "parent");
    out->child_link_name = endOf(who, element, "child");
    out->parent_to_joint_origin_transform = originOf(who, element);
    /* an axis has no rotation; some exporters write one of zeros */
    const XMLElement *given = onlyChild(element, "axis");
    const std::vector<double> turn = numbersOr(given, "rpy", {0, 0, 0});
    const bool turned = std::any_of(turn.begin(), turn.end(), [](double angle) { return angle != 0.0; });
    onlyLeaf(who, element, "axis", turned ? Words{"xyz"} : Words{"xyz", "rpy"});
    const std::vector<double> axis = numbersOr(given, "xyz", {1, 0, 0});
    out->axis = urdf::Vector3(axis[0], axis[1], axis[2]);

    /* effort and velocity say nothing of where the joint goes */
    const XMLElement *limit = onlyLeaf(
        who, element, "limit", {"lower", "upper", "effort", "velocity", "acceleration", "deceleration", "jerk"});
    if (!limit && out->type == urdf::Joint::REVOLUTE) throw Error("a revolute joint needs limits");
    if (!limit && out->type == urdf::Joint::PRISMATIC) throw Error("a prismatic joint needs limits");
    if (limit) {
      out->limits = std::make_shared<urdf::JointLimits>();
      out->limits->clear();
      out->limits->lower = numbersOr(limit, "lower", {0}).front();
      out->limits->upper = numbersOr(limit, "upper", {0}).front();
    }
    if (const XMLElement *mimic = onlyLeaf(who, element, "mimic", {"joint", "multiplier", "offset"})) {
      out->mimic = std::make_shared<urdf::JointMimic>();
      out->mimic->clear();
      out->mimic->joint_name = attribute(*mimic, "joint");
      if (out->mimic->joint_name.empty()) throw Error("its mimic element has no joint");
      out->mimic->multiplier = numbersOr(mimic, "multiplier", {1}).front();
      out->mimic->offset = numbersOr(mimic, "offset", {0}).front();
    }
    return out;
  }

  static decltype(urdf::Joint::type) typeOf(const std::string &name) {
    if (name == "revolute") return urdf::Joint::REVOLUTE;
    if (name == "continuous") return urdf::Joint::CONTINUOUS;
    if (name == "prismatic") return urdf::Joint::PRISMATIC;
    if (name == "fixed") return urdf::Joint::FIXED;
    if (name == "planar") return urdf::Joint::PLANAR;
    if (name == "floating") return urdf::Joint::FLOATING;
    throw Error("its type '" + name + "' is not known to URDF" +
                didYouMean(name, {"revolute", "continuous", "prismatic", "fixed", "planar", "floating"}));
  }

  std::string endOf(const std::string &who, const XMLElement &joint, const char *end) {
    const XMLElement *element = onlyLeaf(who, joint, end, {"link"});
    const std::string link = element ? attribute(*element, "link") : "";
    if (link.empty()) throw Error("it has no " + std::string(end) + " link");
    return link;
  }

  void makeTree() {
    std::map<std::string, std::string> parents;
    try {
      out_.model->initTree(parents);
      out_.model->initRoot(parents);
    } catch (const urdf::ParseError &error) {
      throw Error("the links are no tree: " + std::string(error.what()));
    }
  }

  static constexpr double kThin = 1e-90; /* [m] the height of a disc: below every rounding */

  UrdfDocument out_;
  std::set<std::string> children_;
};

} // namespace

UrdfDocument readUrdf(const std::string &xml) {
  return Document().read(xml);
}

} // namespace curve_proximity
