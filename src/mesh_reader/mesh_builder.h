/* SPDX-License-Identifier: BSD-3-Clause */
/* From positions and polygons to vertices and triangles. */
#ifndef CURVE_PROXIMITY_MESH_READER_MESH_BUILDER_H
#define CURVE_PROXIMITY_MESH_READER_MESH_BUILDER_H

#include <array>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

namespace curve_proximity::mesh_reader {

/* What is wrong with a file, and where: "line 7: ...". */
struct Fault : std::runtime_error {
  using std::runtime_error::runtime_error;
};

struct Mesh {
  std::vector<double> vertices;        /* [m] x, y, z of each */
  std::vector<std::int32_t> triangles; /* three vertices each */
  std::string remark;                  /* what was done that its reader may not expect; "" for nothing */
};

using Point = std::array<double, 3>;

/* Gathers positions and polygons, which name positions by their number, before or after these are added. */
class MeshBuilder {
 public:
  /* Returns its number. Throws Fault where there are more than a mesh can number. */
  std::uint32_t add(const Point &position);

  std::size_t positions() const {
    return positions_.size();
  }

  /* Polygons of fewer than three corners have no surface: they are left out. */
  void addPolygon(const std::vector<std::uint32_t> &corners);
  void addTriangle(std::uint32_t a, std::uint32_t b, std::uint32_t c);

  /* The triangles of all polygons, in their order; equal positions become one vertex, unused ones none.
   *
   * A polygon is cut by its ears, seen along the axis nearest to its normal: a convex one into a fan about its first
   * corner, a square with a reflex corner along the diagonal of that. One that crosses itself has no inside: it becomes
   * a fan, and the remark says so. */
  Mesh finish();

 private:
  std::vector<Point> positions_;
  std::vector<std::uint32_t> corners_, sizes_;
};

} // namespace curve_proximity::mesh_reader
#endif
