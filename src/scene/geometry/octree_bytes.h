/* SPDX-License-Identifier: BSD-3-Clause */
/* The bytes of an octree, looked through before octomap reads them: it trusts them. */
#ifndef CURVE_PROXIMITY_SCENE_OCTREE_BYTES_H
#define CURVE_PROXIMITY_SCENE_OCTREE_BYTES_H

#include <cstddef>

#include <curve_proximity/description.hpp>

namespace curve_proximity {

/* Levels below the root: cells are 2^-OCTREE_DEPTH of the whole. */
constexpr int OCTREE_DEPTH = 16;

/* How many nodes the bytes hold. Throws Error where they end too early, go deeper than octrees do or hold an occupancy
 * that is no number; for a resolution that is not above 0 and a kind of node that is not known. */
std::size_t countNodes(const OctreeData &octree);

} // namespace curve_proximity
#endif
