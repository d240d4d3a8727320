/* SPDX-License-Identifier: BSD-3-Clause */
#include "kinematics.h"

#include <algorithm>
#include <cstdio>

#include "joint_parts.h"

namespace curve_proximity {
namespace {

using JointType = Robot::JointType;

/* Builds the core's lists; nothing is kept but what goes into the Kinematics. */
class Builder {
 public:
  Builder(const Snapshot &snapshot, Kinematics &out) : snapshot_(snapshot), robot_(*snapshot.robot()), out_(out) {}

  void build(const std::vector<VirtualJoint> &base, const std::vector<std::string> &base_joints,
             const Eigen::Isometry3d &place) {
    addRoot(base, base_joints, place);
    for (const Robot::Joint &joint : robot_.joints()) addJoint(joint);
    for (const auto &[name, geometries] : robot_.links()) addGeometries(name, snapshot_.linkGeometry(name), nullptr);
    for (const auto &[id, object] : snapshot_.attached()) {
      const std::string &link = robot_.links().find(object->link)->first;
      addGeometries(link, object->shapes, object.get());
    }

    cprox_robot *made = nullptr;
    const cprox_status status = cprox_robot_create(links_.data(), links_.size(), geometries_.data(), geometries_.size(),
                                                   out_.rest.size(), workspace_.get(), &made);
    if (status != CPROX_OK) throw Error("robot '" + robot_.name() + "': " + workspace_.reason(), status);
    out_.core.reset(made);
  }

 private:
  int addVariable(const std::string &name, double rest) {
    const int variable = static_cast<int>(out_.rest.size());
    if (!out_.variables.emplace(name, variable).second) throw Error("two joints have a value named '" + name + "'");
    out_.rest.push_back(rest);
    return variable;
  }

  /* The variables of a joint with parts, the first one's number. */
  template <std::size_t N>
  int addParts(const std::string &name, const char *const (&parts)[N], const std::vector<std::string> &names) {
    for (std::size_t i = 0; i < N; ++i) addVariable(names.empty() ? name + parts[i] : names[i], i == 6 ? 1.0 : 0.0);
    return static_cast<int>(out_.rest.size() - N);
  }

  /* A link on a joint of the core; returns its number. */
  std::size_t addLink(int parent, cprox_joint_type type, const Eigen::Isometry3d &origin, const Eigen::Vector3d &axis,
                      int variable, double multiplier, double offset) {
    links_.push_back({parent, type, toPose(origin), toVec3(axis), variable, multiplier, offset});
    out_.parents.push_back(parent);
    return links_.size() - 1;
  }

  std::size_t addFixed(int parent, const Eigen::Isometry3d &origin) {
    return addLink(parent, CPROX_JOINT_FIXED, origin, Eigen::Vector3d::UnitZ(), 0, 1.0, 0.0);
  }

  void addRoot(const std::vector<VirtualJoint> &base, const std::vector<std::string> &base_joints,
               const Eigen::Isometry3d &here) {
    const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
    if (base.empty() || base.front().type == "fixed") {
      out_.links[robot_.rootLink()] = addFixed(-1, here);
      return;
    }
    const VirtualJoint &joint = base.front();
    if (joint.child_link != robot_.rootLink()) {
      throw Error("the virtual joint's child '" + joint.child_link + "' is not the root link '" + robot_.rootLink() +
                  "'");
    }
    const bool planar = joint.type == "planar";
    const int variable =
        planar ? addParts(joint.name, PLANAR_PARTS, base_joints) : addParts(joint.name, FLOATING_PARTS, base_joints);
    out_.links[robot_.rootLink()] =
        addLink(-1, planar ? CPROX_JOINT_PLANAR : CPROX_JOINT_FLOATING, here, up, variable, 1.0, 0.0);
  }

  void addJoint(const Robot::Joint &joint) {
    const int parent = static_cast<int>(out_.links.at(joint.parent));
    std::size_t link = 0;
    switch (joint.type) {
      case JointType::FIXED:
        link = addFixed(parent, joint.origin);
        out_.leaders[joint.name] = "";
        break;
      case JointType::REVOLUTE: link = addScalar(parent, joint, CPROX_JOINT_REVOLUTE); break;
      case JointType::PRISMATIC: link = addScalar(parent, joint, CPROX_JOINT_PRISMATIC); break;
      case JointType::PLANAR: link = addPlanar(parent, joint); break;
      case JointType::FLOATING:
        link = addLink(parent, CPROX_JOINT_FLOATING, joint.origin, Eigen::Vector3d::UnitZ(),
                       addParts(joint.name, FLOATING_PARTS, {}), 1.0, 0.0);
        break;
    }
    out_.links[joint.child] = link;
  }

  /* A joint of one value, its own or its leader's. A leader that is fixed is at 0. */
  std::size_t addScalar(int parent, const Robot::Joint &joint, cprox_joint_type type) {
    if (joint.leader.empty()) {
      return addLink(parent, type, joint.origin, joint.axis, variableOf(joint.name), 1.0, 0.0);
    }
    out_.leaders[joint.name] = joint.leader;
    return addLink(parent, type, joint.origin, joint.axis, variableOf(joint.leader), joint.multiplier, joint.offset);
  }

  /* The variable of a joint of one value. A leader may come after those that follow it: its variable is made when it is
   * first heard of. */
  int variableOf(const std::string &name) {
    const auto known = out_.variables.find(name);
    if (known != out_.variables.end()) return known->second;
    for (const Robot::Joint &joint : robot_.joints()) {
      if (joint.name == name) return addVariable(name, joint.type == JointType::FIXED ? 0.0 : joint.rest);
    }
    throw Error("joint '" + name + "', which others follow, is not there");
  }

  /* The core's planar joint moves in z = 0: its frame is turned to the plane, and turned back behind it. */
  std::size_t addPlanar(int parent, const Robot::Joint &joint) {
    Eigen::Isometry3d to_plane = Eigen::Isometry3d::Identity();
    to_plane.linear() = rotationBetween(Eigen::Vector3d::UnitZ(), joint.axis).toRotationMatrix();
    const std::size_t moved = addLink(parent, CPROX_JOINT_PLANAR, joint.origin * to_plane, Eigen::Vector3d::UnitZ(),
                                      addParts(joint.name, PLANAR_PARTS, {}), 1.0, 0.0);
    return to_plane.matrix().isIdentity(0.0) ? moved : addFixed(static_cast<int>(moved), to_plane.inverse());
  }

  void addGeometries(const std::string &name, const std::vector<LinkGeometry> &geometries,
                     const AttachedObject *attached) {
    const int link = static_cast<int>(out_.links.at(name));
    const double own = attached ? attached->description.padding : 0.0;
    const double of_link = snapshot_.linkPadding(name);
    for (std::size_t i = 0; i < geometries.size(); ++i) {
      const Geometry &geometry = geometries[i].geometry;
      const cprox_body *body = geometry.body.get();
      MovingGeometry made{&name, attached, static_cast<int>(i), geometry.excess, geometry.is_mesh, geometry.is_open,
                          body};
      const auto add = [&](double padding) {
        geometries_.push_back({body, toPose(geometries[i].pose), link, padding + geometry.margin});
        out_.geometries.push_back(made);
      };
      const bool twice = of_link > 0.0;
      made.unpadded = static_cast<std::int32_t>(geometries_.size() + (twice ? 1 : 0));
      add(own + of_link);
      made.within = twice;
      if (twice) add(own);
    }
  }

  const Snapshot &snapshot_;
  const Robot &robot_;
  Kinematics &out_;
  Workspace workspace_;
  std::vector<cprox_link> links_;
  std::vector<cprox_link_geometry> geometries_;
};

} // namespace

std::shared_ptr<const Kinematics> makeKinematics(const Snapshot &snapshot, const std::vector<VirtualJoint> &base,
                                                 const std::vector<std::string> &base_joints,
                                                 const Eigen::Isometry3d &place) {
  if (!snapshot.robot()) throw Error("a trajectory needs a robot, and the scene has none");
  auto out = std::make_shared<Kinematics>();
  out->robot = snapshot.robot();
  Builder(snapshot, *out).build(base, base_joints, place);
  return out;
}

std::vector<std::string> beyondLimits(const Kinematics &kinematics, const cprox_motion &motion) {
  constexpr double ROOM = 1e-6; /* what printing a limit with a few digits costs is no fault */
  std::vector<std::string> out;
  for (const Robot::Joint &joint : kinematics.robot->joints()) {
    const auto variable = kinematics.variables.find(joint.leader.empty() ? joint.name : joint.leader);
    if (variable == kinematics.variables.end() || !(std::isfinite(joint.lower) && std::isfinite(joint.upper))) continue;
    const cprox_variable_info range =
        cprox_motion_get_variable_info(&motion, static_cast<std::size_t>(variable->second));
    double low = joint.multiplier * range.lowest + joint.offset;
    double high = joint.multiplier * range.highest + joint.offset;
    if (low > high) std::swap(low, high);
    char text[96];
    if (low < joint.lower - ROOM) {
      std::snprintf(text, sizeof text, "goes to %.6g, below its lower limit %.6g", low, joint.lower);
      out.push_back("joint '" + joint.name + "' " + text);
    }
    if (high > joint.upper + ROOM) {
      std::snprintf(text, sizeof text, "goes to %.6g, above its upper limit %.6g", high, joint.upper);
      out.push_back("joint '" + joint.name + "' " + text);
    }
  }
  return out;
}

} // namespace curve_proximity
