/* SPDX-License-Identifier: BSD-3-Clause */
/* One tetrahedron in each format whose files are checked, and a folder for files. */
#ifndef CURVE_PROXIMITY_TEST_SCENE_MESH_FILES_H
#define CURVE_PROXIMITY_TEST_SCENE_MESH_FILES_H

#include <unistd.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace curve_proximity {
namespace test {

constexpr std::array<std::array<float, 3>, 4> CORNERS = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.25F, 0.25F, 1}}};
constexpr std::array<std::array<int, 3>, 4> FACES = {{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};

/* The bytes of a number, the lowest first, or last. */
template <class T>
std::string bytesOf(T value, bool lowest_first = true) {
  std::string out(reinterpret_cast<const char *>(&value), sizeof value);
  return lowest_first ? out : std::string(out.rbegin(), out.rend());
}

inline std::string binaryStl() {
  std::string out(80, ' ');
  out += bytesOf(static_cast<std::uint32_t>(FACES.size()));
  for (const auto &face : FACES) {
    out += std::string(12, '\0');
    for (const int corner : face)
      for (const float x : CORNERS[static_cast<std::size_t>(corner)]) out += bytesOf(x);
    out += std::string(2, '\0');
  }
  return out;
}

inline std::string textStl() {
  std::ostringstream out;
  out << "solid t\n";
  for (const auto &face : FACES) {
    out << "facet normal 0 0 0\n outer loop\n";
    for (const int corner : face) {
      const auto &p = CORNERS[static_cast<std::size_t>(corner)];
      out << "  vertex " << p[0] << " " << p[1] << " " << p[2] << "\n";
    }
    out << " endloop\nendfacet\n";
  }
  out << "endsolid t\n";
  return out.str();
}

inline std::string plyHeader(const std::string &format) {
  return "ply\nformat " + format +
         " 1.0\ncomment four corners\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
         "property uchar red\nelement face 4\nproperty list uchar int vertex_indices\nend_header\n";
}

inline std::string textPly() {
  std::ostringstream out;
  out << plyHeader("ascii");
  for (const auto &p : CORNERS) out << p[0] << " " << p[1] << " " << p[2] << " 255\n";
  for (const auto &face : FACES) out << "3 " << face[0] << " " << face[1] << " " << face[2] << "\n";
  return out.str();
}

inline std::string binaryPly(bool little) {
  std::string out = plyHeader(little ? "binary_little_endian" : "binary_big_endian");
  for (const auto &p : CORNERS) {
    for (const float x : p) out += bytesOf(x, little);
    out += '\xff';
  }
  for (const auto &face : FACES) {
    out += '\3';
    for (const int corner : face) out += bytesOf(corner, little);
  }
  return out;
}

inline std::string obj() {
  std::ostringstream out;
  out << "# four corners\nmtllib none.mtl\no t\n";
  for (const auto &p : CORNERS) out << "v " << p[0] << " " << p[1] << " " << p[2] << "\n";
  out << "vn 0 0 1\nvt 0 1\ng a\nf 1 3 2\nf 1/1/1 2/1/1 4/1/1\ng b\nf 2//1 \\\n3//1 4//1\nf -2 -4 -1\n";
  return out.str();
}

inline std::string collada() {
  return R"(<?xml version="1.0" encoding="utf-8"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="meter" meter="1"/><up_axis>Z_UP</up_axis></asset>
<library_geometries><geometry id="m" name="m"><mesh>
<source id="p"><float_array id="pa" count="12">0 0 0 1 0 0 0 1 0 0.25 0.25 1</float_array><technique_common>
<accessor source="#pa" count="4" stride="3"><param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/></accessor>
</technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="4"><input semantic="VERTEX" source="#v" offset="0"/><p>0 2 1 0 1 3 1 2 3 2 0 3</p></triangles>
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node id="n"><instance_geometry url="#m"/></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene>
</COLLADA>
)";
}

/* Name of a file, and what is in it. */
inline std::vector<std::pair<std::string, std::string>> meshFiles() {
  return {{"binary.stl", binaryStl()},     {"text.stl", textStl()},       {"text.ply", textPly()},
          {"little.ply", binaryPly(true)}, {"big.ply", binaryPly(false)}, {"wavefront.obj", obj()},
          {"collada.dae", collada()}};
}

/* A folder that is gone when the test is over. */
class MeshFolder {
 public:
  MeshFolder() : path_(std::filesystem::temp_directory_path() / ("mesh_files_" + std::to_string(::getpid()))) {
    std::filesystem::create_directories(path_);
  }
  ~MeshFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  MeshFolder(const MeshFolder &) = delete;
  MeshFolder &operator=(const MeshFolder &) = delete;
  std::string write(const std::string &name, const std::string &content) const {
    const std::string file = (path_ / name).string();
    std::ofstream(file, std::ios::binary) << content;
    return file;
  }

 private:
  const std::filesystem::path path_;
};

} // namespace test
} // namespace curve_proximity
#endif
