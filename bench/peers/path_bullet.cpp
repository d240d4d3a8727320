// SPDX-License-Identifier: BSD-3-Clause
#include "curve_peers.h"

#include <memory>

#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletCollision/CollisionShapes/btCapsuleShape.h>
#include <BulletCollision/CollisionShapes/btConeShape.h>
#include <BulletCollision/CollisionShapes/btCylinderShape.h>
#include <BulletCollision/CollisionShapes/btSphereShape.h>
#include <BulletCollision/NarrowPhaseCollision/btContinuousConvexCollision.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkEpaPenetrationDepthSolver.h>
#include <BulletCollision/NarrowPhaseCollision/btVoronoiSimplexSolver.h>

namespace {

struct path {
  std::unique_ptr<btConvexShape> solid;
  btSphereShape ball{1};
  btTransform placed;
};

btScalar scalar(double x) {
  return static_cast<btScalar>(x);
}

std::unique_ptr<btConvexShape> shape_of(const solid &s) {
  const btScalar a = scalar(s.size[0]), b = scalar(s.size[1]), c = scalar(s.size[2]);
  const btScalar half(0.5);
  switch (s.kind) {
    case SOLID_SPHERE: return std::make_unique<btSphereShape>(a);
    case SOLID_BOX: return std::make_unique<btBoxShape>(btVector3(a * half, b * half, c * half));
    case SOLID_CAPSULE: return std::make_unique<btCapsuleShapeZ>(b, a);
    case SOLID_CYLINDER: return std::make_unique<btCylinderShapeZ>(btVector3(b, b, a * half));
    default: return std::make_unique<btConeShapeZ>(b, a);
  }
}

void *make(const solid *standing, double radius) {
  auto *made = new path;
  made->solid = shape_of(*standing);
  made->ball.setUnscaledRadius(scalar(radius));
  const double *p = standing->position, *q = standing->quaternion;
  made->placed.setRotation(btQuaternion(scalar(q[1]), scalar(q[2]), scalar(q[3]), scalar(q[0])).normalized());
  made->placed.setOrigin(btVector3(scalar(p[0]), scalar(p[1]), scalar(p[2])));
  return made;
}

double answer(const void *self, const double (*points)[3], size_t n) {
  const auto *p = static_cast<const path *>(self);
  btVoronoiSimplexSolver simplex;
  btGjkEpaPenetrationDepthSolver depth;
  btTransform from = btTransform::getIdentity(), to = from;
  for (size_t i = 0; i + 1 < n; i++) {
    from.setOrigin(btVector3(scalar(points[i][0]), scalar(points[i][1]), scalar(points[i][2])));
    to.setOrigin(btVector3(scalar(points[i + 1][0]), scalar(points[i + 1][1]), scalar(points[i + 1][2])));
    btContinuousConvexCollision cast(&p->ball, p->solid.get(), &simplex, &depth);
    btConvexCast::CastResult found;
    if (cast.calcTimeOfImpact(from, to, p->placed, p->placed, found))
      return static_cast<double>(i) + static_cast<double>(found.m_fraction);
  }
  return -1.0;
}

void drop(void *self) {
  delete static_cast<path *>(self);
}

} // namespace

const path_peer path_peer_bullet = {"Bullet on 100 chords", make, answer, drop};
