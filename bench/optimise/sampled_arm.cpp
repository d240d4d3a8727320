/* SPDX-License-Identifier: BSD-3-Clause */
#include "sampled_arm.h"

#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/convex.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/narrowphase/distance.h>

#include <set>

namespace curve_proximity {
namespace {

using Object = fcl::CollisionObjectd;

/* The corners of a binary STL file, each once. FCL takes the convex hull of what it gets without faces. */
std::shared_ptr<fcl::Convexd> hullOfStl(const std::string &path) {
  const std::string bytes = readText(path);
  constexpr std::size_t HEAD = 84, TRIANGLE = 50, NORMAL = 12;
  std::set<std::array<float, 3>> corners;
  for (std::size_t at = HEAD; at + TRIANGLE <= bytes.size(); at += TRIANGLE)
    for (std::size_t k = 0; k < 3; ++k) {
      std::array<float, 3> corner;
      std::memcpy(corner.data(), bytes.data() + at + NORMAL + k * sizeof corner, sizeof corner);
      corners.insert(corner);
    }
  if (corners.empty()) throw Error(path + " is no binary STL file with triangles");
  const auto vertices = std::make_shared<std::vector<fcl::Vector3d>>();
  for (const auto &corner : corners) vertices->emplace_back(corner[0], corner[1], corner[2]);
  return std::make_shared<fcl::Convexd>(vertices, 0, std::make_shared<std::vector<int>>());
}

std::shared_ptr<fcl::CollisionGeometryd> geometryOf(const ShapeDescription &shape, const std::string &folder) {
  const std::vector<double> &size = shape.dimensions;
  switch (shape.type) {
    case ShapeType::BOX: return std::make_shared<fcl::Boxd>(size[0], size[1], size[2]);
    case ShapeType::CYLINDER: return std::make_shared<fcl::Cylinderd>(size[1], size[0]);
    case ShapeType::SPHERE: return std::make_shared<fcl::Sphered>(size[0]);
    case ShapeType::MESH: return hullOfStl(folder + "/" + shape.resource);
    default: throw Error("the scenes of this bench have boxes, cylinders, spheres and the robot's meshes");
  }
}

/* A shape that moves with a link, or stands. */
struct Part {
  std::unique_ptr<Object> object;
  Eigen::Isometry3d pose; /* in the link's frame */
  std::string link;
};

} // namespace

struct SampledArm::Data {
  const ArmScene &scene;
  std::vector<Part> links, objects;
  std::vector<std::pair<const Object *, const Object *>> pairs;
  std::vector<std::pair<std::size_t, std::size_t>>
      of_pair; /* links' numbers; the second may be an object's: SIZE_MAX */
  std::map<std::string, std::vector<std::size_t>> moved_by; /* joints of the trajectory above each link */
  std::vector<Eigen::Vector3d> axes, origins;
};

namespace {

constexpr std::size_t STANDS = static_cast<std::size_t>(-1);

struct Witness {
  double distance;
  Eigen::Vector3d normal; /* from b to a */
  Eigen::Vector3d a, b;
};

Witness measurePair(const Object &a, const Object &b) {
  fcl::DistanceRequestd request(true, true);
  request.distance_tolerance = 1e-9;
  fcl::DistanceResultd result;
  const double distance = fcl::distance(&a, &b, request, result);
  const Eigen::Vector3d p = result.nearest_points[0], q = result.nearest_points[1];
  return {distance, (distance < 0.0 ? q - p : p - q).normalized(), p, q};
}

} // namespace

SampledArm::SampledArm(const ArmScene &scene) : data_(new Data{scene, {}, {}, {}, {}, {}, {}, {}}) {
  const Robot &robot = *scene.snapshot->robot();
  const std::string folder = robot.resources().base_dir;

  // What moves each link.
  std::map<std::string, const Robot::Joint *> above;
  for (const Robot::Joint &joint : robot.joints()) above[joint.child] = &joint;
  for (const auto &[link, shapes] : robot.links())
    for (auto at = above.find(link); at != above.end(); at = above.find(at->second->parent)) {
      const auto found = std::find(scene.path.joints.begin(), scene.path.joints.end(), at->second->name);
      if (found != scene.path.joints.end()) data_->moved_by[link].push_back(found - scene.path.joints.begin());
    }
  data_->axes.resize(scene.path.joints.size());
  data_->origins.resize(scene.path.joints.size());

  // The shapes, and the pairs of them.
  for (const auto &[link, shapes] : robot.links())
    for (const LinkGeometry &shape : shapes)
      data_->links.push_back(
          {std::make_unique<Object>(geometryOf(shape.description, folder)), shape.description.pose, link});
  for (const auto &[id, object] : scene.snapshot->objects())
    for (const ShapeDescription &shape : object->description.shapes) {
      data_->objects.push_back({std::make_unique<Object>(geometryOf(shape, "")), {}, ""});
      data_->objects.back().object->setTransform(object->description.pose * shape.pose);
      data_->objects.back().object->computeAABB();
    }
  std::set<std::array<std::string, 2>> disabled;
  for (const auto &[a, b] : scene.srdf.disabled) disabled.insert({std::min(a, b), std::max(a, b)});
  const auto add = [this](std::size_t a, std::size_t b, const Part &other) {
    data_->pairs.emplace_back(data_->links[a].object.get(), other.object.get());
    data_->of_pair.emplace_back(a, b);
  };
  for (std::size_t a = 0; a < data_->links.size(); ++a) {
    const std::string &link = data_->links[a].link;
    for (const Part &object : data_->objects)
      if (!data_->moved_by[link].empty()) add(a, STANDS, object);
    for (std::size_t b = a + 1; b < data_->links.size(); ++b) {
      const std::string &other = data_->links[b].link;
      if (data_->moved_by[link] == data_->moved_by[other]) continue;
      if (disabled.count({std::min(link, other), std::max(link, other)}) == 0) add(a, b, data_->links[b]);
    }
  }
}

SampledArm::~SampledArm() = default;

void SampledArm::measure(const Eigen::RowVectorXd &state, double horizon, std::vector<PairDistance> &out) {
  const ArmScene &scene = data_->scene;
  const Robot &robot = *scene.snapshot->robot();
  JointPositions positions = scene.rest;
  for (std::size_t j = 0; j < scene.path.joints.size(); ++j) positions[scene.path.joints[j]] = state[j];
  const LinkPoses poses = robot.linkPoses(positions);
  for (const Robot::Joint &joint : robot.joints()) {
    const auto found = std::find(scene.path.joints.begin(), scene.path.joints.end(), joint.name);
    if (found == scene.path.joints.end()) continue;
    const Eigen::Isometry3d &frame = poses.at(joint.child);
    data_->axes[found - scene.path.joints.begin()] = frame.linear() * joint.axis;
    data_->origins[found - scene.path.joints.begin()] = frame.translation();
  }
  for (Part &part : data_->links) {
    part.object->setTransform(poses.at(part.link) * part.pose);
    part.object->computeAABB();
  }

  out.clear();
  for (std::size_t i = 0; i < data_->pairs.size(); ++i) {
    const auto &[a, b] = data_->pairs[i];
    if (a->getAABB().distance(b->getAABB()) > horizon) continue;
    const Witness seen = measurePair(*a, *b);
    if (seen.distance > horizon) continue;
    PairDistance found = {i, seen.distance, Eigen::RowVectorXd::Zero(state.size())};
    const auto add = [&](const std::string &link, const Eigen::Vector3d &point, double sign) {
      for (const std::size_t j : data_->moved_by[link])
        found.by_joints[j] += sign * seen.normal.dot(data_->axes[j].cross(point - data_->origins[j]));
    };
    const auto [first, second] = data_->of_pair[i];
    add(data_->links[first].link, seen.a, 1.0);
    if (second != STANDS) add(data_->links[second].link, seen.b, -1.0);
    out.push_back(std::move(found));
  }
}

} // namespace curve_proximity
