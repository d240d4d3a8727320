/* SPDX-License-Identifier: BSD-3-Clause */
#include "reading.hpp"

#include <yaml-cpp/yaml.h>

#include <curve_proximity/srdf.hpp>

#include <fstream>
#include <sstream>
#include <stdexcept>

using namespace curve_proximity;

namespace {

std::string textOf(const std::string &file) {
  std::ifstream in(file);
  std::ostringstream text;
  text << in.rdbuf();
  if (!in) throw std::runtime_error(file + " cannot be read");
  return text.str();
}

Eigen::Isometry3d poseOf(const YAML::Node &node) {
  const auto p = node["position"].as<std::vector<double>>(), q = node["orientation"].as<std::vector<double>>();
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = Eigen::Vector3d(p.at(0), p.at(1), p.at(2));
  pose.linear() = Eigen::Quaterniond(q.at(3), q.at(0), q.at(1), q.at(2)).normalized().toRotationMatrix();
  return pose;
}

Operation objectOf(const YAML::Node &node) {
  Operation add;
  add.object.id = node["id"].as<std::string>();
  for (std::size_t i = 0; i < node["primitives"].size(); ++i) {
    const YAML::Node primitive = node["primitives"][i];
    const auto type = shapeTypeFromName(primitive["type"].as<std::string>());
    if (!type) throw std::runtime_error("object '" + add.object.id + "': unknown type");
    ShapeDescription shape;
    shape.type = *type;
    shape.dimensions = primitive["dimensions"].as<std::vector<double>>();
    shape.pose = poseOf(node["primitive_poses"][i]);
    add.object.shapes.push_back(shape);
  }
  return add;
}

SnapshotPtr readWorld(const std::string &urdf, const std::string &scene_file) {
  RobotOptions options;
  options.resources.base_dir = urdf.substr(0, urdf.find_last_of('/') + 1);
  Scene scene(Robot::fromUrdf(textOf(urdf), options));

  SceneChange change;
  for (const YAML::Node &object : YAML::Load(textOf(scene_file))["world"]["collision_objects"])
    change.operations.push_back(objectOf(object));
  const std::vector<std::string> faults = scene.apply(change);
  if (!faults.empty()) throw std::runtime_error(faults.front());
  return scene.snapshot();
}

} // namespace

Task readTask(const std::string &urdf, const std::string &srdf, const std::string &scene,
              const std::string &trajectory) {
  Task task;
  const SnapshotPtr world = readWorld(urdf, scene);
  task.rest = {{"panda_finger_joint1", 0.04}, {"panda_finger_joint2", 0.04}};

  const YAML::Node file = YAML::Load(textOf(trajectory))["joint_trajectory"];
  const YAML::Node points = file["points"];
  task.joints = file["joint_names"].as<std::vector<std::string>>();
  if (task.joints.size() != 7 || points.size() < 2) throw std::runtime_error(trajectory + ": seven joints, two points");
  task.start = points[0]["positions"].as<std::vector<double>>();
  task.goal = points[points.size() - 1]["positions"].as<std::vector<double>>();

  Query query;
  query.query_type = QueryType::TOLERANCE;
  query.delta = task.clearance;
  const PreparedRobot robot(world, parseSrdf(textOf(srdf)).disabled);
  task.checker = std::make_shared<EdgeChecker>(robot, task.joints, task.rest, RobotPairs::WHOLE, query);
  if (!task.checker->coverage().complete()) throw std::runtime_error(task.checker->coverage().message());
  return task;
}
