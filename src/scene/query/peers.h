/* SPDX-License-Identifier: BSD-3-Clause */
/* Pairs of shapes as FCL and libccd take them, and the distances that these measure. */
#ifndef CURVE_PROXIMITY_SCENE_PEERS_H
#define CURVE_PROXIMITY_SCENE_PEERS_H

#include <memory>
#include <mutex>
#include <vector>

#include <curve_proximity/description.hpp>

#include "geometry/mesh.h"

namespace curve_proximity {

/* The surface of a mesh, and what a peer has made of it. */
struct PeerMesh {
  MeshData data;
  mutable std::once_flag once;
  mutable std::shared_ptr<const void> made;
};

/* A set that a peer measures by itself: a POINT, SPHERE, BOX, CAPSULE, CYLINDER, CONE or ELLIPSOID with the dimensions
 * of a description, the POLYTOPE of `vertices`, or the surface of a MESH. */
struct Piece {
  ShapeType type = ShapeType::POINT;
  Eigen::Vector3d size = Eigen::Vector3d::Zero();
  Eigen::Matrix3Xd vertices;
  std::shared_ptr<const PeerMesh> mesh;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity(); /* in the fixed frame */
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();       /* a point inside, in the fixed frame */
  double radius = 0.0;                                    /* of a ball about the centre that holds the set */
};

/* Fills centre and radius. */
void bound(Piece &piece);

/* The distances of two pieces [m]; 0 where they touch or overlap. Throw Error where the library gives none.
 * ccdDistance() takes convex pieces alone; it looks no farther than `limit`, and returns it where they are farther. */
double fclDistance(const Piece &a, const Piece &b);
double ccdDistance(const Piece &a, const Piece &b, double limit);

} // namespace curve_proximity
#endif
