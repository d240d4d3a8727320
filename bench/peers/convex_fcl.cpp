// SPDX-License-Identifier: BSD-3-Clause
#include "sampling.h"

#include <algorithm>
#include <limits>
#include <memory>
#include <vector>

#include <fcl/geometry/shape/convex.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/narrowphase/distance.h>

namespace {

/* FCL knows no points; a ball of this radius stands for one [m]. */
constexpr double kSmall = 1e-6;

struct Polytope {
  std::shared_ptr<fcl::Convexd> convex;
  fcl::Sphered ball{kSmall};
};

} // namespace

const char *sampling_polytope_name(void) {
  return "FCL at points of the curve";
}

void *sampling_polytope(const cprox_vec3 *vertices, size_t n, const int (*triangles)[3], size_t m) {
  const auto corners = std::make_shared<std::vector<fcl::Vector3d>>();
  const auto faces = std::make_shared<std::vector<int>>();
  for (size_t i = 0; i < n; i++) corners->emplace_back(vertices[i].x, vertices[i].y, vertices[i].z);
  for (size_t i = 0; i < m; i++) faces->insert(faces->end(), {3, triangles[i][0], triangles[i][1], triangles[i][2]});
  auto *made = new Polytope;
  made->convex = std::make_shared<fcl::Convexd>(corners, static_cast<int>(m), faces);
  return made;
}

double sampling_polytope_distance(const void *polytope, const cprox_vec3 *points, size_t n) {
  const auto *p = static_cast<const Polytope *>(polytope);
  fcl::DistanceRequestd request;
  request.distance_tolerance = 1e-9;
  fcl::Transform3d at = fcl::Transform3d::Identity();
  const fcl::Transform3d here = fcl::Transform3d::Identity();
  double least = std::numeric_limits<double>::infinity();
  for (size_t i = 0; i < n; i++) {
    at.translation() = fcl::Vector3d(points[i].x, points[i].y, points[i].z);
    fcl::DistanceResultd found;
    fcl::distance(&p->ball, at, p->convex.get(), here, request, found);
    least = std::min(least, found.min_distance + kSmall);
  }
  return least;
}

void sampling_polytope_free(void *polytope) {
  delete static_cast<Polytope *>(polytope);
}
