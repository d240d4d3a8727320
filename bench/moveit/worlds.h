/* SPDX-License-Identifier: BSD-3-Clause */
/* Scene files as worlds of MoveIt. */
#ifndef CURVE_PROXIMITY_BENCH_MOVEIT_WORLDS_H
#define CURVE_PROXIMITY_BENCH_MOVEIT_WORLDS_H

#include <memory>
#include <string>
#include <vector>

#include <geometric_shapes/shapes.h>
#include <moveit/collision_detection/world.h>

#include <curve_proximity/files.hpp>
#include <curve_proximity/scene.hpp>

inline shapes::ShapeConstPtr toShape(const curve_proximity::ShapeDescription &shape) {
  using curve_proximity::ShapeType;
  const std::vector<double> &d = shape.dimensions;
  if (shape.type == ShapeType::BOX) return std::make_shared<shapes::Box>(d[0], d[1], d[2]);
  if (shape.type == ShapeType::CYLINDER) return std::make_shared<shapes::Cylinder>(d[1], d[0]);
  if (shape.type == ShapeType::SPHERE) return std::make_shared<shapes::Sphere>(d[0]);
  throw curve_proximity::Error("the scenes of this bench have boxes, cylinders and spheres");
}

/* The objects of a scene file, whose frame stands at `frame`. */
inline collision_detection::WorldPtr worldOf(const std::string &path,
                                             const Eigen::Isometry3d &frame = Eigen::Isometry3d::Identity()) {
  curve_proximity::Scene scene;
  scene.apply(curve_proximity::loadSceneFile(path).change);
  auto out = std::make_shared<collision_detection::World>();
  for (const auto &[id, object] : scene.snapshot()->objects()) {
    std::vector<shapes::ShapeConstPtr> all;
    EigenSTL::vector_Isometry3d poses;
    for (const curve_proximity::ShapeDescription &shape : object->description.shapes) {
      all.push_back(toShape(shape));
      poses.push_back(shape.pose);
    }
    out->addToObject(id, frame * object->description.pose, all, poses);
  }
  return out;
}

#endif
