/* SPDX-License-Identifier: BSD-3-Clause */
/* The formats of mesh files, one reader each. Coordinates are read in double precision. A reader takes the whole file
 * or throws Fault: what it does not know, and might be geometry, is refused. */
#ifndef CURVE_PROXIMITY_MESH_READER_FORMATS_H
#define CURVE_PROXIMITY_MESH_READER_FORMATS_H

#include <string>
#include <string_view>

#include "mesh_builder.h"

namespace curve_proximity::mesh_reader {

/* STL, binary or text, with any number of solids. */
Mesh readStl(std::string_view bytes);

/* PLY, in text or binary of either order: vertices with faces or strips of triangles. */
Mesh readPly(std::string_view bytes);

/* OBJ: vertices and faces. Free-form surfaces are refused. */
Mesh readObj(std::string_view bytes);

/* Collada 1.4 and 1.5: the scene's nodes at their poses, times the document's unit. The axes are not turned, whatever
 * <up_axis> says: so RViz and geometric_shapes have it. Skins, splines and other documents are refused. */
Mesh readCollada(std::string_view bytes);

/* glTF 2.0 as JSON or binary: the nodes of its scene at their poses. The axes are not turned. Buffers must be in the
 * file; skins, morphed meshes and required extensions that change geometry are refused. */
Mesh readGltf(std::string_view bytes);

/* Reads a file by the letters after the last point of its name. Throws Fault, also for another format and where there
 * is no triangle in it. */
Mesh readBytes(const std::string &extension, std::string_view bytes);

/* The letters after the last point: in lower case, "stl" for what contains it. */
std::string extensionOf(const std::string &file);

} // namespace curve_proximity::mesh_reader
#endif
