/* SPDX-License-Identifier: BSD-3-Clause */
/** What was done to read mesh files that their user may not expect. */
#ifndef CURVE_PROXIMITY_MESH_REMARKS_HPP
#define CURVE_PROXIMITY_MESH_REMARKS_HPP

#include <string>
#include <vector>

#include <curve_proximity/description.hpp>
#include <curve_proximity/geometry.hpp>

namespace curve_proximity {

/** A message for each mesh file of the object whose unit is not 1 m, or whose polygons cross themselves. Throws Error
 *  as makeGeometry() does. Cost: none where the meshes are still kept in memory, else they are read again. Thread
 *  safety: any number of threads. */
std::vector<std::string> meshRemarks(const ObjectDescription &object, const ResourceOptions &options);

} // namespace curve_proximity
#endif
