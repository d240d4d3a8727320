/* SPDX-License-Identifier: BSD-3-Clause */
/* Occupancy octrees: from octomap's files and bytes to the boxes of their cells. */
#ifndef CURVE_PROXIMITY_SCENE_OCTREE_H
#define CURVE_PROXIMITY_SCENE_OCTREE_H

#include <string>

#include <curve_proximity/geometry.hpp>

namespace curve_proximity {

/* The octree in a .bt or .ot file. Throws Error, naming the file: no such header, a size that the header does not keep.
 */
OctreeData readOctree(const std::string &file);

/* A box for each occupied cell of the tree, merged where eight of them fill a larger one; with unknown_is_occupied also
 * for what was never measured inside the box of all measured cells. Throws Error: bytes that end too early or go deeper
 * than octrees do, a resolution that is not above 0, an unknown kind; CPROX_MEMORY beyond memory_limit bytes. */
Boxes cellBoxes(const OctreeData &octree, bool unknown_is_occupied, std::size_t memory_limit);

} // namespace curve_proximity
#endif
