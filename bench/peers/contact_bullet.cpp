// SPDX-License-Identifier: BSD-3-Clause
// A motion is given as Bullet's users give it: two poses, between which it moves and turns at a constant rate. Curves
// are 100 chords.
#include "contact_peers.h"

#include <cmath>
#include <memory>
#include <vector>

#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletCollision/CollisionShapes/btCapsuleShape.h>
#include <BulletCollision/CollisionShapes/btConvexHullShape.h>
#include <BulletCollision/CollisionShapes/btCylinderShape.h>
#include <BulletCollision/CollisionShapes/btSphereShape.h>
#include <BulletCollision/NarrowPhaseCollision/btContinuousConvexCollision.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkEpaPenetrationDepthSolver.h>
#include <BulletCollision/NarrowPhaseCollision/btSubSimplexConvexCast.h>
#include <BulletCollision/NarrowPhaseCollision/btVoronoiSimplexSolver.h>

namespace {

constexpr int CHORDS = 100;

struct scene {
  std::unique_ptr<btConvexShape> moving, standing;
  std::vector<btTransform> poses; // at equal times
  btTransform at;
};

btVector3 vector(const cprox_vec3 &v) {
  return {static_cast<btScalar>(v.x), static_cast<btScalar>(v.y), static_cast<btScalar>(v.z)};
}

btTransform transform(const cprox_pose &pose) {
  const cprox_quat &q = pose.orientation;
  const btQuaternion turned(static_cast<btScalar>(q.x), static_cast<btScalar>(q.y), static_cast<btScalar>(q.z),
                            static_cast<btScalar>(q.w));
  return btTransform(turned.normalized(), vector(pose.position));
}

std::unique_ptr<btConvexShape> shape_of(contact_shape shape) {
  const btScalar half(0.5), tip(0.6);
  switch (shape) {
    case CONTACT_BOX: return std::make_unique<btBoxShape>(btVector3(half, half, half));
    case CONTACT_SPHERE: return std::make_unique<btSphereShape>(half);
    case CONTACT_CAPSULE: return std::make_unique<btCapsuleShapeZ>(btScalar(0.4), btScalar(1));
    case CONTACT_CYLINDER: return std::make_unique<btCylinderShapeZ>(btVector3(half, half, half));
    default: {
      auto hull = std::make_unique<btConvexHullShape>();
      for (int k = 0; k < 3; k++)
        for (int sign = -1; sign <= 1; sign += 2) {
          btVector3 point(0, 0, 0);
          point[k] = static_cast<btScalar>(sign) * tip;
          hull->addPoint(point);
        }
      hull->setMargin(0); // by default a hull is larger by 4 cm
      return hull;
    }
  }
}

cprox_vec3 on_curve(const cprox_vec3 *c, double t) {
  const double s = 1 - t, b[4] = {s * s * s, 3 * s * s * t, 3 * s * t * t, t * t * t};
  return {b[0] * c[0].x + b[1] * c[1].x + b[2] * c[2].x + b[3] * c[3].x,
          b[0] * c[0].y + b[1] * c[1].y + b[2] * c[2].y + b[3] * c[3].y,
          b[0] * c[0].z + b[1] * c[1].z + b[2] * c[2].z + b[3] * c[3].z};
}

// The screw of the scenes turns about an axis along which it moves, through the origin: it is a constant rate of both.
void *make(const contact_scene *given) {
  auto *made = new scene;
  made->moving = shape_of(given->moving);
  made->standing = shape_of(given->standing);
  made->at = transform(given->at);
  if (given->path != CONTACT_BEZIER) {
    made->poses = {transform(given->from), transform(given->to)};
    return made;
  }
  for (int i = 0; i <= CHORDS; i++) {
    btTransform pose = btTransform::getIdentity();
    pose.setOrigin(vector(on_curve(given->control, static_cast<double>(i) / CHORDS)));
    made->poses.push_back(pose);
  }
  return made;
}

double first_hit(const scene &s, btConvexCast &cast) {
  const size_t n = s.poses.size() - 1;
  for (size_t i = 0; i < n; i++) {
    btConvexCast::CastResult found;
    found.m_fraction = 1;
    if (cast.calcTimeOfImpact(s.poses[i], s.poses[i + 1], s.at, s.at, found))
      return (static_cast<double>(i) + static_cast<double>(found.m_fraction)) / static_cast<double>(n);
  }
  return INFINITY;
}

double continuous_convex(void *self) {
  const scene &s = *static_cast<scene *>(self);
  btVoronoiSimplexSolver simplex;
  btGjkEpaPenetrationDepthSolver depth;
  btContinuousConvexCollision cast(s.moving.get(), s.standing.get(), &simplex, &depth);
  return first_hit(s, cast);
}

void *make_without_turning(const contact_scene *given) {
  const cprox_quat &p = given->from.orientation, &q = given->to.orientation;
  const bool turns = given->path == CONTACT_SCREW || p.x != q.x || p.y != q.y || p.z != q.z || p.w != q.w;
  return turns ? nullptr : make(given);
}

double subsimplex(void *self) {
  const scene &s = *static_cast<scene *>(self);
  btVoronoiSimplexSolver simplex;
  btSubsimplexConvexCast cast(s.moving.get(), s.standing.get(), &simplex);
  return first_hit(s, cast);
}

void drop(void *self) {
  delete static_cast<scene *>(self);
}

} // namespace

const contact_peer contact_peer_bullet_convex = {"Bullet continuous convex", make, continuous_convex, drop};
const contact_peer contact_peer_bullet_subsimplex = {"Bullet subsimplex cast", make_without_turning, subsimplex, drop};
