/* SPDX-License-Identifier: BSD-3-Clause */
/** No id or name of a request is longer than ~max_name_length: answers repeat them once a row. */
#ifndef CURVE_PROXIMITY_ROS_NAME_LIMITS_H
#define CURVE_PROXIMITY_ROS_NAME_LIMITS_H

#include <curve_proximity/ApplyScene.h>
#include <curve_proximity/EvaluateConstraints.h>
#include <curve_proximity/GetScene.h>
#include <curve_proximity/MeasurePairs.h>
#include <curve_proximity/ProximityQuery.h>

#include <curve_proximity/core.hpp>
#include <string>
#include <vector>

namespace curve_proximity {

/** Throws Error for the first name that is too long, with its kind and its first letters. */
class NameLimits {
 public:
  explicit NameLimits(int most) : most_(static_cast<std::size_t>(most)) {}

  void check(const char *kind, const std::string &name) const {
    if (name.size() <= most_) return;
    throw Error(std::string(kind) + " '" + name.substr(0, 32) + "…' has " + std::to_string(name.size()) +
                " bytes, more than ~max_name_length = " + std::to_string(most_));
  }

  void check(const char *kind, const std::vector<std::string> &names) const {
    for (const std::string &name : names) check(kind, name);
  }

  void check(const Curve &curve) const {
    check("a curve's id", curve.id);
    check("a curve's frame", curve.header.frame_id);
    check("a curve's basis", curve.basis);
    for (const CurvePiece &piece : curve.pieces) check("a curve's basis", piece.basis);
  }

  void check(const nav_msgs::Path &path) const {
    check("a path's frame", path.header.frame_id);
    for (const auto &pose : path.poses) check("a pose's frame", pose.header.frame_id);
  }

  void check(const trajectory_msgs::MultiDOFJointTrajectory &trajectory) const {
    check("a trajectory's frame", trajectory.header.frame_id);
    check("the name of a joint", trajectory.joint_names);
  }

  void check(const ProximityQuery &query) const {
    check("the name of an object", query.objects);
    check("the name of a link", query.links);
    check("the name of a group", query.group);
    check("the name of a joint", query.joint_state.name);
    check(query.body);
    check(query.moving_robots);
  }

  void check(const std::vector<RobotTrajectory> &robots) const {
    for (const RobotTrajectory &robot : robots) {
      check("the name of a robot", robot.name);
      check("the name of a robot", robot.robot);
      check("a robot's frame", robot.base.header.frame_id);
      check("the name of a joint", robot.trajectory.joint_names);
      check("the name of a joint", robot.joint_state.name);
    }
  }

  void check(const Body &body) const {
    check("a body's type", body.type);
    check("an octree's id", body.octree.id);
    check(body.curve);
    if (body.resource.size() > LONGEST_PATH) throw Error("a body's resource is longer than any path");
  }

  void check(const MeasurePairsRequest &request) const {
    for (const PairQuery &pair : request.pairs) {
      check("a pair's id", pair.id);
      check("what is asked of a pair", pair.ask);
      check(pair.a);
      check(pair.b);
    }
  }

  void check(const CollisionObject &object) const {
    check("an object's id", object.id);
    check("an object's frame", object.header.frame_id);
    check("the turning of a trajectory", object.trajectory.turning);
    for (const Body &body : object.bodies) check(body);
  }

  void check(const ApplySceneRequest &request) const {
    for (const CollisionObject &object : request.objects) check(object);
    for (const AttachedCollisionObject &attached : request.attached_collision_objects) {
      check(attached.object);
      check("the name of a link", attached.link_name);
      check("the name of a link", attached.touch_links);
    }
    for (const LinkPadding &padding : request.link_padding) check("the name of a link", padding.link_name);
    for (const LinkScale &scale : request.link_scale) check("the name of a link", scale.link_name);
    for (const AllowedContact &contact : request.allowed_contacts) {
      check("the name of an allowed pair", contact.first);
      check("the name of an allowed pair", contact.second);
    }
    check("the name of a joint", request.joint_state.name);
  }

  void check(const EvaluateConstraintsRequest &request) const {
    for (const ConstraintQuery &query : request.cases) {
      check("a case's id", query.id);
      check("the name of a provider", query.providers);
      check(query.a);
      check(query.b);
      check(query.curve);
      check("a trajectory's frame", query.trajectory.header.frame_id);
      check("the name of a joint", query.trajectory.joint_names);
      check("the name of a joint", query.joint_state.name);
      check(query.moving_robots);
    }
  }

 private:
  static constexpr std::size_t LONGEST_PATH = 4096;

  const std::size_t most_;
};

} // namespace curve_proximity
#endif
