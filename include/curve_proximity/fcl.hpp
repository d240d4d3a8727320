/* SPDX-License-Identifier: BSD-3-Clause */
/** Bodies and poses from FCL's collision objects.
 *
 *  Header-only over libcprox and FCL (0.5, 0.6, 0.7). FCL's data is read; no FCL algorithm is called. */
#ifndef CURVE_PROXIMITY_FCL_HPP
#define CURVE_PROXIMITY_FCL_HPP

#include <fcl/config.h>
#if FCL_MAJOR_VERSION == 0 && FCL_MINOR_VERSION < 6
#include <fcl/BVH/BVH_model.h>
#include <fcl/collision_object.h>
#include <fcl/shape/geometric_shapes.h>
#else
#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/capsule.h>
#include <fcl/geometry/shape/cone.h>
#include <fcl/geometry/shape/convex.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/geometry/shape/ellipsoid.h>
#include <fcl/geometry/shape/halfspace.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/geometry/shape/triangle_p.h>
#include <fcl/narrowphase/collision_object.h>
#endif

#include <curve_proximity/core.hpp>

namespace curve_proximity {

namespace detail {
namespace fcl_types {

/* The one difference of the versions that matters here: templates on the scalar since 0.6, Vec3f and friends before. */
#if FCL_MAJOR_VERSION == 0 && FCL_MINOR_VERSION < 6
using Object = ::fcl::CollisionObject;
using Geometry = ::fcl::CollisionGeometry;
using Vector = ::fcl::Vec3f;
using Sphere = ::fcl::Sphere;
using Box = ::fcl::Box;
using Capsule = ::fcl::Capsule;
using Cylinder = ::fcl::Cylinder;
using Cone = ::fcl::Cone;
using Ellipsoid = ::fcl::Ellipsoid;
using Halfspace = ::fcl::Halfspace;
using Convex = ::fcl::Convex;
using Triangle = ::fcl::TriangleP;
using AABB = ::fcl::AABB;
using OBB = ::fcl::OBB;
using RSS = ::fcl::RSS;
using kIOS = ::fcl::kIOS;
using OBBRSS = ::fcl::OBBRSS;
template <std::size_t N>
using KDOP = ::fcl::KDOP<N>;
#else
using Object = ::fcl::CollisionObjectd;
using Geometry = ::fcl::CollisionGeometryd;
using Vector = ::fcl::Vector3d;
using Sphere = ::fcl::Sphered;
using Box = ::fcl::Boxd;
using Capsule = ::fcl::Capsuled;
using Cylinder = ::fcl::Cylinderd;
using Cone = ::fcl::Coned;
using Ellipsoid = ::fcl::Ellipsoidd;
using Halfspace = ::fcl::Halfspaced;
using Convex = ::fcl::Convexd;
using Triangle = ::fcl::TrianglePd;
using AABB = ::fcl::AABBd;
using OBB = ::fcl::OBBd;
using RSS = ::fcl::RSSd;
using kIOS = ::fcl::kIOSd;
using OBBRSS = ::fcl::OBBRSSd;
template <std::size_t N>
using KDOP = ::fcl::KDOPd<N>;
#endif

} // namespace fcl_types

inline Eigen::Vector3d fromFcl(const fcl_types::Vector &v) {
  return {v[0], v[1], v[2]};
}

/** The hull of a range of FCL's vectors. */
inline BodyHandle hullFromFcl(const fcl_types::Vector *vertices, std::size_t n) {
  Eigen::Matrix3Xd points(3, static_cast<Eigen::Index>(n));
  for (std::size_t i = 0; i < n; ++i) points.col(static_cast<Eigen::Index>(i)) = fromFcl(vertices[i]);
  return makePolytope(points);
}

inline BodyHandle hullFromFcl(const fcl_types::Convex &convex) {
#if FCL_MAJOR_VERSION == 0 && FCL_MINOR_VERSION < 6
  return hullFromFcl(convex.points, static_cast<std::size_t>(convex.num_points));
#else
  return hullFromFcl(convex.getVertices().data(), convex.getVertices().size());
#endif
}

template <typename BV>
BodyHandle hullFromFclBvh(const fcl_types::Geometry &geometry) {
  const auto &model = static_cast<const ::fcl::BVHModel<BV> &>(geometry);
  return hullFromFcl(model.vertices, static_cast<std::size_t>(model.num_vertices));
}

} // namespace detail

/** The body of an FCL geometry, in the geometry's frame. A BVH (mesh or point cloud) becomes its convex hull.
 *
 *  Throws Error for planes, octrees and user-defined geometries, and for sizes that core.hpp refuses. */
inline BodyHandle bodyFromFcl(const detail::fcl_types::Geometry &geometry) {
  namespace types = detail::fcl_types;
  switch (geometry.getNodeType()) {
    case ::fcl::GEOM_SPHERE: return makeSphere(static_cast<const types::Sphere &>(geometry).radius);
    case ::fcl::GEOM_BOX: return makeBox(detail::fromFcl(static_cast<const types::Box &>(geometry).side));
    case ::fcl::GEOM_ELLIPSOID:
      return makeEllipsoid(detail::fromFcl(static_cast<const types::Ellipsoid &>(geometry).radii));
    case ::fcl::GEOM_CONVEX: return detail::hullFromFcl(static_cast<const types::Convex &>(geometry));
    case ::fcl::GEOM_CAPSULE: {
      const auto &s = static_cast<const types::Capsule &>(geometry);
      return makeCapsule(s.lz, s.radius);
    }
    case ::fcl::GEOM_CYLINDER: {
      const auto &s = static_cast<const types::Cylinder &>(geometry);
      return makeCylinder(s.lz, s.radius);
    }
    case ::fcl::GEOM_CONE: {
      const auto &s = static_cast<const types::Cone &>(geometry);
      return makeCone(s.lz, s.radius);
    }
    case ::fcl::GEOM_HALFSPACE: { // FCL's inside is n·x <= d
      const auto &s = static_cast<const types::Halfspace &>(geometry);
      return makeHalfspace(detail::fromFcl(s.n), -s.d);
    }
    case ::fcl::GEOM_TRIANGLE: {
      const auto &s = static_cast<const types::Triangle &>(geometry);
      const types::Vector corners[3] = {s.a, s.b, s.c};
      return detail::hullFromFcl(corners, 3);
    }
    case ::fcl::BV_AABB: return detail::hullFromFclBvh<types::AABB>(geometry);
    case ::fcl::BV_OBB: return detail::hullFromFclBvh<types::OBB>(geometry);
    case ::fcl::BV_RSS: return detail::hullFromFclBvh<types::RSS>(geometry);
    case ::fcl::BV_kIOS: return detail::hullFromFclBvh<types::kIOS>(geometry);
    case ::fcl::BV_OBBRSS: return detail::hullFromFclBvh<types::OBBRSS>(geometry);
    case ::fcl::BV_KDOP16: return detail::hullFromFclBvh<types::KDOP<16>>(geometry);
    case ::fcl::BV_KDOP18: return detail::hullFromFclBvh<types::KDOP<18>>(geometry);
    case ::fcl::BV_KDOP24: return detail::hullFromFclBvh<types::KDOP<24>>(geometry);
    case ::fcl::GEOM_PLANE: throw Error("an FCL plane is a surface without an inside: use a halfspace");
    case ::fcl::GEOM_OCTREE: throw Error("an FCL octree is not convex: hand over its boxes");
    default: throw Error("an FCL geometry of unknown type has no body");
  }
}

/** A body with its pose. */
struct PosedBody {
  BodyHandle body;                                        /**< in its own frame */
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity(); /**< in the world */
};

/** The body and the current pose of an FCL object. Later changes of the object have no effect. */
inline PosedBody fromFcl(const detail::fcl_types::Object &object) {
  PosedBody out;
  out.body = bodyFromFcl(*object.collisionGeometry());
#if FCL_MAJOR_VERSION == 0 && FCL_MINOR_VERSION < 6
  const auto &q = object.getQuatRotation();
  out.pose.linear() = Eigen::Quaterniond(q.getW(), q.getX(), q.getY(), q.getZ()).normalized().toRotationMatrix();
  out.pose.translation() = detail::fromFcl(object.getTranslation());
#else
  out.pose = object.getTransform();
#endif
  return out;
}

} // namespace curve_proximity
#endif
