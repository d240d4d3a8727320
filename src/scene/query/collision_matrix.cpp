/* SPDX-License-Identifier: BSD-3-Clause */
#include <curve_proximity/collision_matrix.hpp>

#include <algorithm>
#include <cmath>
#include <set>

#include "robot/kinematics.h"

namespace curve_proximity {

struct CollisionMatrix::Data {
  SnapshotPtr snapshot;
  std::shared_ptr<const Kinematics> kinematics;
  std::vector<double> lowest, highest;
  std::map<std::string, const Robot::Joint *> above; /* the joint above each link but the root */
  std::vector<std::array<std::string, 2>> pairs;

  bool hasGeometry(const std::string &link) const {
    return !kinematics->robot->links().at(link).empty();
  }

  /* The joints from a link up to the root. */
  std::vector<const Robot::Joint *> upFrom(std::string link) const {
    std::vector<const Robot::Joint *> out;
    for (auto it = above.find(link); it != above.end(); it = above.find(link)) {
      out.push_back(it->second);
      link = it->second->parent;
    }
    return out;
  }

  /* The joints between two links. */
  std::vector<const Robot::Joint *> between(const std::string &a, const std::string &b) const {
    std::vector<const Robot::Joint *> from = upFrom(a), to = upFrom(b);
    while (!from.empty() && !to.empty() && from.back() == to.back()) from.pop_back(), to.pop_back();
    from.insert(from.end(), to.rbegin(), to.rend());
    return from;
  }

  std::vector<cprox_robot_pair> geometriesOf(const std::array<std::string, 2> &links) const {
    std::vector<std::int32_t> side[2];
    for (std::size_t i = 0; i < kinematics->geometries.size(); ++i) {
      const MovingGeometry &geometry = kinematics->geometries[i];
      if (geometry.attached || geometry.unpadded != static_cast<std::int32_t>(i)) continue;
      for (int k = 0; k < 2; ++k)
        if (*geometry.link == links[k]) side[k].push_back(static_cast<std::int32_t>(i));
    }
    std::vector<cprox_robot_pair> out;
    for (const std::int32_t a : side[0])
      for (const std::int32_t b : side[1]) out.push_back({a, b});
    return out;
  }
};

namespace {

/* The joint that decides where a joint is. */
const std::string &deciderOf(const Robot::Joint &joint) {
  return joint.leader.empty() ? joint.name : joint.leader;
}

/* A joint of one value goes from its lower limit to its upper one, without limits once round. */
void limitVariables(const Kinematics &kinematics, std::vector<double> &lowest, std::vector<double> &highest) {
  lowest = highest = kinematics.rest;
  for (const Robot::Joint &joint : kinematics.robot->joints()) {
    const auto variable = kinematics.variables.find(joint.name);
    if (variable == kinematics.variables.end()) continue;
    double low = joint.lower, high = joint.upper;
    if (joint.type == Robot::JointType::REVOLUTE && !(std::isfinite(low) && std::isfinite(high)))
      low = -M_PI, high = M_PI;
    const auto i = static_cast<std::size_t>(variable->second);
    if (std::isfinite(low) && std::isfinite(high)) lowest[i] = low, highest[i] = high;
  }
}

/* Those of one value have limits, or turn once round. */
void refuseSeveralValues(const Robot::Joint &joint) {
  using Type = Robot::JointType;
  if (joint.type == Type::PLANAR || joint.type == Type::FLOATING)
    throw Error("joint '" + joint.name + "' has several values without limits: the links behind it may be anywhere");
}

/* Geometry that was not read may be that of these links. */
void cover(const Coverage &coverage, LinkContact &contact) {
  if (coverage.complete()) return;
  contact.result.lower = 0.0;
  const bool never = contact.result.verdict == CPROX_VERDICT_CLEAR;
  if (!never && coverage.provesContact()) return;
  contact.result.verdict = CPROX_VERDICT_UNDECIDED;
  contact.message = coverage.message();
}

} // namespace

const char *contactName(const LinkContact &contact) {
  switch (contact.result.verdict) {
    case CPROX_VERDICT_CLEAR: return "never";
    case CPROX_VERDICT_VIOLATED: return contact.rigid ? "always" : "possible";
    case CPROX_VERDICT_UNDECIDED: break;
  }
  return "undecided";
}

CollisionMatrix::CollisionMatrix(SnapshotPtr snapshot) {
  auto data = std::make_unique<Data>();
  data->kinematics = makeKinematics(*snapshot, {}, {}, Eigen::Isometry3d::Identity());
  data->snapshot = std::move(snapshot);
  const Robot &robot = *data->kinematics->robot;
  limitVariables(*data->kinematics, data->lowest, data->highest);
  for (const Robot::Joint &joint : robot.joints()) data->above[joint.child] = &joint;
  for (auto a = robot.links().begin(); a != robot.links().end(); ++a)
    for (auto b = std::next(a); b != robot.links().end(); ++b)
      if (!a->second.empty() && !b->second.empty()) data->pairs.push_back({a->first, b->first});
  data_ = std::move(data);
}

CollisionMatrix::~CollisionMatrix() = default;

const std::vector<std::array<std::string, 2>> &CollisionMatrix::pairs() const {
  return data_->pairs;
}

LinkContact CollisionMatrix::ask(std::size_t pair, const cprox_options &options, Workspace &workspace) const {
  const std::array<std::string, 2> &links = data_->pairs.at(pair);
  const Kinematics &kinematics = *data_->kinematics;
  LinkContact out;
  out.a = links[0], out.b = links[1];

  /* what is between them */
  std::set<std::string> movers;
  std::size_t n_moving = 0;
  bool others = false;
  for (const Robot::Joint *joint : data_->between(links[0], links[1])) {
    refuseSeveralValues(*joint);
    for (const std::string &link : {joint->parent, joint->child})
      others = others || (link != links[0] && link != links[1] && data_->hasGeometry(link));
    if (joint->type == Robot::JointType::FIXED || kinematics.variables.count(deciderOf(*joint)) == 0) continue;
    ++n_moving;
    movers.insert(deciderOf(*joint));
  }
  out.adjacent = n_moving <= 1 && !others;
  out.rigid = n_moving == 0;

  const std::vector<cprox_robot_pair> pairs = data_->geometriesOf(links);
  const cprox_joint_box box = {data_->lowest.data(), data_->highest.data(), data_->lowest.size()};
  std::vector<double> state(kinematics.rest.size());
  const cprox_status status = cprox_robot_box_collision(kinematics.core.get(), pairs.data(), pairs.size(), &box,
                                                        &options, workspace.get(), &out.result, state.data());
  if (status < 0) throw Error(workspace.reason(), status);
  if (out.result.verdict == CPROX_VERDICT_UNDECIDED) out.message = workspace.reason();
  cover(kinematics.robot->coverage(), out);
  for (const std::string &joint : movers)
    out.posture[joint] = state[static_cast<std::size_t>(kinematics.variables.at(joint))];
  return out;
}

} // namespace curve_proximity
