/* SPDX-License-Identifier: BSD-3-Clause */
#include "moving_body.h"

#include <array>

#include "geometry/placing.h"

namespace curve_proximity {
namespace {

void expect(cprox_status status, const Workspace &workspace) {
  if (status != CPROX_OK) throw Error(workspace.reason(), status);
}

void makeRobot(const ObjectDescription &object, MovingBody &out) {
  if (object.shapes.empty()) throw Error("it has no shapes");
  checkPadding(object.padding);
  std::vector<cprox_link_geometry> geometries;
  for (std::size_t i = 0; i < object.shapes.size(); ++i) {
    if (out.geometries[i].curve) throw Error("a curve stands where it is: it takes no trajectory");
    if (!out.geometries[i].body) throw Error("its octree has no occupied cell");
    geometries.push_back(
        {out.geometries[i].body.get(), toPose(object.shapes[i].pose), 0, object.padding + out.geometries[i].margin});
  }
  cprox_link link{};
  link.parent = -1;
  link.type = CPROX_JOINT_FLOATING;
  link.origin.orientation.w = 1.0;
  Workspace workspace;
  cprox_robot *made = nullptr;
  expect(cprox_robot_create(&link, 1, geometries.data(), geometries.size(), 7, workspace.get(), &made), workspace);
  out.robot.reset(made);
}

void makeMotion(const std::vector<TimedPose> &poses, Turning turning, MovingBody &out) {
  if (poses.empty()) throw Error("it has no poses");
  std::vector<std::array<double, 7>> values;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    checkPose(poses[i].pose, "waypoint " + std::to_string(i));
    const cprox_pose pose = toPose(poses[i].pose);
    values.push_back({pose.position.x, pose.position.y, pose.position.z, pose.orientation.x, pose.orientation.y,
                      pose.orientation.z, pose.orientation.w});
  }
  static constexpr std::array<std::int32_t, 7> VARIABLES{0, 1, 2, 3, 4, 5, 6};
  std::vector<cprox_waypoint> points;
  for (std::size_t i = 0; i < values.size(); ++i) points.push_back({poses[i].time, values[i].data(), nullptr, nullptr});
  cprox_motion_description description{};
  const bool stands = points.size() == 1;
  description.kind = stands ? CPROX_MOTION_STATE : CPROX_MOTION_WAYPOINTS;
  description.rest = stands ? values.front().data() : nullptr;
  description.variables = stands ? nullptr : VARIABLES.data();
  description.n_variables = stands ? 0 : VARIABLES.size();
  description.waypoints = points.data();
  description.n_waypoints = points.size();
  description.turning = turning == Turning::SCREW ? CPROX_TURNING_SCREW : CPROX_TURNING_SLERP;
  Workspace workspace;
  cprox_motion *made = nullptr;
  expect(cprox_motion_create(out.robot.get(), &description, workspace.get(), &made), workspace);
  out.motion.reset(made);
}

} // namespace

std::shared_ptr<const MovingBody> makeMovingBody(const ObjectDescription &object, std::vector<Geometry> geometries,
                                                 const std::vector<TimedPose> &poses, Turning turning) {
  const auto out = std::make_shared<MovingBody>();
  out->geometries = std::move(geometries);
  makeRobot(object, *out);
  makeMotion(poses, turning, *out);
  return out;
}

} // namespace curve_proximity
