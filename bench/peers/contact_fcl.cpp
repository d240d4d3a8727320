// SPDX-License-Identifier: BSD-3-Clause
// Motions by FCL's own classes: translations, slerp about the body's frame, screws, and cubic splines by de Boor
// points.
#include "contact_peers.h"

#include <cmath>
#include <exception>
#include <memory>
#include <vector>

#include <fcl/fcl.h>

namespace {

struct scene {
  std::shared_ptr<fcl::CollisionGeometryd> moving, standing;
  std::shared_ptr<fcl::MotionBase<double>> motion, rest;
};

fcl::Vector3d vector(const cprox_vec3 &v) {
  return {v.x, v.y, v.z};
}

fcl::Transform3d transform(const cprox_pose &pose) {
  const cprox_quat &q = pose.orientation;
  fcl::Transform3d out = fcl::Transform3d::Identity();
  out.linear() = fcl::Quaterniond(q.w, q.x, q.y, q.z).normalized().toRotationMatrix();
  out.translation() = vector(pose.position);
  return out;
}

std::shared_ptr<fcl::CollisionGeometryd> octahedron() {
  const auto tips = std::make_shared<std::vector<fcl::Vector3d>>();
  const auto faces = std::make_shared<std::vector<int>>();
  for (int k = 0; k < 3; k++)
    for (int sign = 1; sign >= -1; sign -= 2) tips->push_back(0.6 * sign * fcl::Vector3d::Unit(k));
  for (int i = 0; i < 8; i++) { // counter-clockwise from outside
    const int x = i & 1, y = 2 + (i >> 1 & 1), z = 4 + (i >> 2 & 1);
    const bool mirrored = (x + y + z) % 2 == 1;
    faces->insert(faces->end(), {3, x, mirrored ? z : y, mirrored ? y : z});
  }
  return std::make_shared<fcl::Convexd>(tips, 8, faces);
}

std::shared_ptr<fcl::CollisionGeometryd> shape_of(contact_shape shape) {
  switch (shape) {
    case CONTACT_BOX: return std::make_shared<fcl::Boxd>(1, 1, 1);
    case CONTACT_SPHERE: return std::make_shared<fcl::Sphered>(0.5);
    case CONTACT_CAPSULE: return std::make_shared<fcl::Capsuled>(0.4, 1);
    case CONTACT_CYLINDER: return std::make_shared<fcl::Cylinderd>(0.5, 1);
    default: return octahedron();
  }
}

bool turns(const contact_scene &s) {
  const cprox_quat &p = s.from.orientation, &q = s.to.orientation;
  return p.x != q.x || p.y != q.y || p.z != q.z || p.w != q.w;
}

// A Bézier curve as a span of a uniform cubic B-spline.
std::shared_ptr<fcl::MotionBase<double>> spline(const cprox_vec3 *control) {
  const fcl::Vector3d b0 = vector(control[0]), b1 = vector(control[1]), b2 = vector(control[2]),
                      b3 = vector(control[3]);
  const fcl::Vector3d d1 = 2 * b1 - b2, d2 = 2 * b2 - b1, none = fcl::Vector3d::Zero();
  const fcl::Vector3d d0 = 6 * b0 - 4 * d1 - d2, d3 = 6 * b3 - d1 - 4 * d2;
  return std::make_shared<fcl::SplineMotion<double>>(d0, d1, d2, d3, none, none, none, none);
}

std::shared_ptr<fcl::MotionBase<double>> motion_of(const contact_scene &s) {
  const fcl::Transform3d from = transform(s.from), to = transform(s.to);
  if (s.path == CONTACT_BEZIER) return spline(s.control);
  if (s.path == CONTACT_SCREW) return std::make_shared<fcl::ScrewMotion<double>>(from, to);
  if (turns(s)) return std::make_shared<fcl::InterpMotion<double>>(from, to);
  return std::make_shared<fcl::TranslationMotion<double>>(from, to);
}

void *make(const contact_scene *given) {
  auto *made = new scene;
  made->moving = shape_of(given->moving);
  made->standing = shape_of(given->standing);
  made->motion = motion_of(*given);
  const fcl::Transform3d at = transform(given->at);
  made->rest = std::make_shared<fcl::TranslationMotion<double>>(at, at);
  return made;
}

double ask(void *self, const fcl::ContinuousCollisionRequestd &request) try {
  const scene &s = *static_cast<scene *>(self);
  s.motion->integrate(0.0);
  fcl::ContinuousCollisionResultd found;
  if (fcl::continuousCollide(s.moving.get(), s.motion.get(), s.standing.get(), s.rest.get(), request, found) < 0)
    return NAN;
  return found.is_collide ? found.time_of_contact : INFINITY;
} catch (const std::exception &) {
  return NAN;
}

double advance(void *self, fcl::GJKSolverType solver) {
  fcl::ContinuousCollisionRequestd request;
  request.ccd_solver_type = fcl::CCDC_CONSERVATIVE_ADVANCEMENT;
  request.gjk_solver_type = solver;
  request.toc_err = 1e-6;
  return ask(self, request);
}

double advancement(void *self) {
  return advance(self, fcl::GST_LIBCCD);
}

double other_solver(void *self) {
  return advance(self, fcl::GST_INDEP);
}

double defaults(void *self) {
  return ask(self, fcl::ContinuousCollisionRequestd());
}

void drop(void *self) {
  delete static_cast<scene *>(self);
}

} // namespace

const contact_peer contact_peer_fcl_advancement = {"FCL advancement", make, advancement, drop};
const contact_peer contact_peer_fcl_other_solver = {"FCL advancement own GJK", make, other_solver, drop};
const contact_peer contact_peer_fcl_defaults = {"FCL at 10 samples", make, defaults, drop};
