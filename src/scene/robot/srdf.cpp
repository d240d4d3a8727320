/* SPDX-License-Identifier: BSD-3-Clause */
#include <curve_proximity/collision_matrix.hpp>
#include <curve_proximity/nearest_name.hpp>
#include <curve_proximity/srdf.hpp>

#include <tinyxml2.h>

#include <algorithm>
#include <set>

#include <curve_proximity/core.hpp>
#include <curve_proximity/robot.hpp>

#include "xacro.h"

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

/* Elements that others than MoveIt read are none of these, and look like none of these. */
void refuseMisspelt(const XMLElement &parent, const std::vector<std::string> &known) {
  for (const XMLElement *e = parent.FirstChildElement(); e; e = e->NextSiblingElement()) {
    const std::string meant = didYouMean(e->Name(), known);
    if (meant.empty() || std::find(known.begin(), known.end(), e->Name()) != known.end()) continue;
    throw Error("line " + std::to_string(e->GetLineNum()) + ": <" + e->Name() + "> is not known" + meant);
  }
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

std::vector<std::string> readNames(const XMLElement &group, const char *element) {
  std::vector<std::string> out;
  for (const XMLElement *e = group.FirstChildElement(element); e; e = e->NextSiblingElement(element))
    out.push_back(required(*e, "name"));
  return out;
}

SrdfGroup readGroup(const XMLElement &element) {
  SrdfGroup group;
  group.name = required(element, "name");
  refuseMisspelt(element, {"link", "joint", "group", "chain"});
  group.links = readNames(element, "link");
  group.joints = readNames(element, "joint");
  group.groups = readNames(element, "group");
  for (const XMLElement *e = element.FirstChildElement("chain"); e; e = e->NextSiblingElement("chain"))
    group.chains.push_back({required(*e, "base_link"), required(*e, "tip_link")});
  return group;
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
  refuseXacro(*robot,
              {"virtual_joint", "group", "disable_collisions", "enable_collisions", "disable_default_collisions"});
  refuseMisspelt(*robot,
                 {"virtual_joint", "group", "group_state", "end_effector", "disable_collisions", "enable_collisions",
                  "disable_default_collisions", "passive_joint", "joint_property", "link_sphere_approximation"});

  Srdf out;
  for (const XMLElement *e = robot->FirstChildElement("virtual_joint"); e; e = e->NextSiblingElement("virtual_joint")) {
    out.virtual_joints.push_back(readVirtualJoint(*e));
  }
  out.disabled = readPairs(*robot, "disable_collisions");
  out.enabled = readPairs(*robot, "enable_collisions");
  for (const XMLElement *e = robot->FirstChildElement("group"); e; e = e->NextSiblingElement("group"))
    out.groups.push_back(readGroup(*e));
  const char *all = "disable_default_collisions";
  for (const XMLElement *e = robot->FirstChildElement(all); e; e = e->NextSiblingElement(all)) {
    out.disabled_by_default.push_back(required(*e, "link"));
  }
  return out;
}

namespace {

void removeAll(XMLElement &robot, const char *name) {
  while (XMLElement *element = robot.FirstChildElement(name)) robot.DeleteChild(element);
}

} // namespace

std::vector<DisabledPair> disabledPairs(const std::string &srdf_xml) {
  const Srdf srdf = parseSrdf(srdf_xml);
  std::vector<DisabledPair> out;
  tinyxml2::XMLDocument document;
  document.Parse(srdf_xml.data(), srdf_xml.size());
  const XMLElement *element = document.FirstChildElement("robot")->FirstChildElement("disable_collisions");
  for (const std::array<std::string, 2> &links : srdf.disabled) {
    const char *reason = element->Attribute("reason");
    out.push_back({links, reason ? reason : ""});
    element = element->NextSiblingElement("disable_collisions");
  }
  return out;
}

std::string withDisabledPairs(const std::string &srdf_xml, const std::string &robot,
                              const std::vector<DisabledPair> &pairs) {
  tinyxml2::XMLDocument document;
  if (srdf_xml.empty()) {
    document.InsertEndChild(document.NewDeclaration());
    document.InsertEndChild(document.NewElement("robot"))->ToElement()->SetAttribute("name", robot.c_str());
  } else {
    parseSrdf(srdf_xml);
    document.Parse(srdf_xml.data(), srdf_xml.size());
  }
  XMLElement &root = *document.FirstChildElement("robot");
  const XMLElement *first = root.FirstChildElement("disable_collisions");
  tinyxml2::XMLNode *before = first ? const_cast<tinyxml2::XMLNode *>(first->PreviousSibling()) : root.LastChild();
  removeAll(root, "disable_collisions");
  for (const DisabledPair &pair : pairs) {
    XMLElement *element = document.NewElement("disable_collisions");
    element->SetAttribute("link1", pair.links[0].c_str());
    element->SetAttribute("link2", pair.links[1].c_str());
    if (!pair.reason.empty()) element->SetAttribute("reason", pair.reason.c_str());
    before = before ? root.InsertAfterChild(before, element) : root.InsertFirstChild(element);
  }
  tinyxml2::XMLPrinter printer;
  document.Print(&printer);
  return printer.CStr();
}

namespace {

/** Collects the links of a group and of the groups in it, each group once. */
class GroupLinks {
 public:
  GroupLinks(const Srdf &srdf, const Robot &robot) : srdf_(srdf), robot_(robot) {}

  void add(const std::string &name) {
    if (!seen_.insert(name).second) return;
    const auto group = std::find_if(srdf_.groups.begin(), srdf_.groups.end(),
                                    [&](const SrdfGroup &candidate) { return candidate.name == name; });
    if (group == srdf_.groups.end()) {
      std::vector<std::string> names;
      for (const SrdfGroup &other : srdf_.groups) names.push_back(other.name);
      throw Error("there is no group '" + name + "' in the SRDF" + didYouMean(name, names));
    }
    for (const std::string &link : group->links) addLink(link);
    for (const std::string &joint : group->joints) addJoint(joint);
    for (const auto &[base, tip] : group->chains) addChain(base, tip);
    for (const std::string &other : group->groups) add(other);
  }

  std::vector<std::string> take() {
    return std::move(links_);
  }

 private:
  void addLink(const std::string &link) {
    if (robot_.links().count(link) == 0)
      throw Error("the SRDF's group names link '" + link + "', which robot '" + robot_.name() + "' does not have" +
                  didYouMean(link, namesOf(robot_.links())));
    if (std::find(links_.begin(), links_.end(), link) == links_.end()) links_.push_back(link);
  }

  void addJoint(const std::string &name) {
    for (const Robot::Joint &joint : robot_.joints())
      if (joint.name == name) return addLink(joint.child);
    for (const VirtualJoint &joint : srdf_.virtual_joints)
      if (joint.name == name) return addLink(joint.child_link);
    throw Error("the SRDF's group names joint '" + name + "', which robot '" + robot_.name() + "' does not have");
  }

  void addChain(const std::string &base, const std::string &tip) {
    std::string link = tip;
    while (link != base) {
      addLink(link);
      const auto above = std::find_if(robot_.joints().begin(), robot_.joints().end(),
                                      [&](const Robot::Joint &joint) { return joint.child == link; });
      if (above == robot_.joints().end())
        throw Error("the SRDF's chain from '" + base + "' to '" + tip + "' is none of robot '" + robot_.name() + "'");
      link = above->parent;
    }
    addLink(base);
  }

  const Srdf &srdf_;
  const Robot &robot_;
  std::set<std::string> seen_;
  std::vector<std::string> links_;
};

} // namespace

std::vector<std::string> linksOfGroup(const Srdf &srdf, const Robot &robot, const std::string &group) {
  GroupLinks links(srdf, robot);
  links.add(group);
  return links.take();
}

std::vector<std::string> unknownLinks(const Srdf &srdf, const Robot &robot) {
  std::vector<std::string> out;
  for (const auto &pair : srdf.disabled) {
    for (const std::string &link : pair) {
      if (robot.links().count(link) == 0 && std::find(out.begin(), out.end(), link) == out.end()) out.push_back(link);
    }
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
