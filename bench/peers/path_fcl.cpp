// SPDX-License-Identifier: BSD-3-Clause
#include "curve_peers.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include <fcl/fcl.h>

namespace {

struct path {
  std::shared_ptr<fcl::CollisionGeometryd> solid;
  fcl::Sphered ball{1.0};
  fcl::Transform3d placed;
};

std::shared_ptr<fcl::CollisionGeometryd> shape_of(const solid &s) {
  switch (s.kind) {
    case SOLID_SPHERE: return std::make_shared<fcl::Sphered>(s.size[0]);
    case SOLID_BOX: return std::make_shared<fcl::Boxd>(s.size[0], s.size[1], s.size[2]);
    case SOLID_CAPSULE: return std::make_shared<fcl::Capsuled>(s.size[1], s.size[0]);
    case SOLID_CYLINDER: return std::make_shared<fcl::Cylinderd>(s.size[1], s.size[0]);
    default: return std::make_shared<fcl::Coned>(s.size[1], s.size[0]);
  }
}

void *make(const solid *standing, double radius) {
  auto *made = new path;
  made->solid = shape_of(*standing);
  made->ball = fcl::Sphered(radius);
  made->placed = fcl::Transform3d::Identity();
  const double *q = standing->quaternion;
  made->placed.linear() = fcl::Quaterniond(q[0], q[1], q[2], q[3]).normalized().toRotationMatrix();
  made->placed.translation() = fcl::Vector3d(standing->position[0], standing->position[1], standing->position[2]);
  return made;
}

double answer(const void *self, const double (*points)[3], size_t n) {
  const auto *p = static_cast<const path *>(self);
  fcl::DistanceRequestd request;
  request.distance_tolerance = 1e-6;
  double least = INFINITY;
  fcl::Transform3d at = fcl::Transform3d::Identity();
  for (size_t i = 0; i < n; i++) {
    at.translation() = fcl::Vector3d(points[i][0], points[i][1], points[i][2]);
    fcl::DistanceResultd found;
    fcl::distance(&p->ball, at, p->solid.get(), p->placed, request, found);
    least = std::min(least, found.min_distance);
  }
  return std::max(least, 0.0);
}

void drop(void *self) {
  delete static_cast<path *>(self);
}

} // namespace

const path_peer path_peer_fcl = {"FCL at 100 points", make, answer, drop};
