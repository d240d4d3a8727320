/* SPDX-License-Identifier: BSD-3-Clause */
#include <curve_proximity/srdf.hpp>

#include <tinyxml2.h>

#include <curve_proximity/core.hpp>

namespace curve_proximity {
namespace {

using tinyxml2::XMLElement;

/* An attribute that must be there. */
std::string required(const XMLElement &element, const char *name) {
  const char *text = element.Attribute(name);
  if (!text || !*text) {
    throw Error("line " + std::to_string(element.GetLineNum()) + ": <" + element.Name() + "> has no " + name);
  }
  return text;
}

VirtualJoint readVirtualJoint(const XMLElement &element) {
  VirtualJoint joint;
  joint.name = required(element, "name");
  joint.type = required(element, "type");
  joint.parent_frame = required(element, "parent_frame");
  joint.child_link = required(element, "child_link");
  if (joint.type != "fixed" && joint.type != "planar" && joint.type != "floating") {
    throw Error("virtual joint '" + joint.name + "': the type '" + joint.type + "' is none of fixed, planar, floating");
  }
  return joint;
}

using LinkPairs = std::vector<std::array<std::string, 2>>;

LinkPairs readPairs(const XMLElement &robot, const char *name) {
  LinkPairs out;
  for (const XMLElement *e = robot.FirstChildElement(name); e; e = e->NextSiblingElement(name))
    out.push_back({required(*e, "link1"), required(*e, "link2")});
  return out;
}

} // namespace

Srdf parseSrdf(const std::string &xml) {
  tinyxml2::XMLDocument document;
  if (document.Parse(xml.data(), xml.size()) != tinyxml2::XML_SUCCESS) {
    throw Error("no XML: line " + std::to_string(document.ErrorLineNum()));
  }
  const XMLElement *robot = document.FirstChildElement("robot");
  if (!robot) throw Error("no SRDF: it has no <robot>");

  Srdf out;
  for (const XMLElement *e = robot->FirstChildElement("virtual_joint"); e; e = e->NextSiblingElement("virtual_joint")) {
    out.virtual_joints.push_back(readVirtualJoint(*e));
  }
  out.disabled = readPairs(*robot, "disable_collisions");
  out.enabled = readPairs(*robot, "enable_collisions");
  const char *all = "disable_default_collisions";
  for (const XMLElement *e = robot->FirstChildElement(all); e; e = e->NextSiblingElement(all)) {
    out.disabled_by_default.push_back(required(*e, "link"));
  }
  return out;
}

std::vector<AllowedPair> allowedPairs(const Srdf &srdf) {
  std::vector<AllowedPair> out;
  for (const std::string &link : srdf.disabled_by_default) out.push_back({link, "", true});
  for (const auto &[a, b] : srdf.enabled) out.push_back({a, b, false});
  return out;
}

} // namespace curve_proximity
