/* SPDX-License-Identifier: BSD-3-Clause */
/* Is a mesh file whole? Header, counts and indices of STL, PLY and OBJ files, before libassimp reads them. */
#ifndef CURVE_PROXIMITY_MESH_READER_CHECK_H
#define CURVE_PROXIMITY_MESH_READER_CHECK_H

#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

namespace curve_proximity::mesh_reader {

/* What is wrong with a file, and where: "line 7: ...". */
struct Fault : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/* The triangles that the file has; none where a format or a polygon leaves it open. Each check throws Fault. */
using Triangles = std::optional<std::uint64_t>;
Triangles checkStl(std::string_view bytes);
Triangles checkPly(std::string_view bytes);
Triangles checkObj(std::string_view bytes);

/* The check for a file of this name; every other format is left to libassimp. */
Triangles checkFile(const std::string &extension, std::string_view bytes);

/* The letters after the last point, as libassimp is told them: in lower case, "stl" for what contains it. */
std::string extensionOf(const std::string &file);

/* What is wrong with the XML of a Collada file, "" for nothing or another format. libassimp decides whether it can be
 * read. */
std::string noteOn(const std::string &extension, std::string_view bytes);

} // namespace curve_proximity::mesh_reader
#endif
