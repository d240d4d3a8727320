/* SPDX-License-Identifier: BSD-3-Clause */
/* Meshes with fewer triangles, within a proven distance of the ones they come from. */
#ifndef CURVE_PROXIMITY_SCENE_SIMPLIFY_H
#define CURVE_PROXIMITY_SCENE_SIMPLIFY_H

#include "mesh.h"

namespace curve_proximity {

struct SimplifiedMesh {
  MeshData mesh;
  double moved = 0.0; /* [m], scaled: no point of either surface is farther from the other */
};

/* Unites vertices that are within `tolerance` [m] > 0 of each other once scaled, and leaves out what that makes
 * superfluous. A closed mesh stays closed: where it is farther than `moved` from the surface, its inside stays inside.
 * The mesh was checked. */
SimplifiedMesh simplify(const MeshData &mesh, const Eigen::Vector3d &scale, double tolerance);

} // namespace curve_proximity
#endif
