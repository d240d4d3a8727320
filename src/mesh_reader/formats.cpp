/* SPDX-License-Identifier: BSD-3-Clause */
#include "formats.h"

#include "text.h"

namespace curve_proximity::mesh_reader {

std::string extensionOf(const std::string &file) {
  const std::size_t point = file.find_last_of('.');
  if (point == std::string::npos) return "";
  std::string out = file.substr(point + 1);
  for (char &c : out) c = lower(c);
  return out.find("stl") != std::string::npos ? "stl" : out;
}

Mesh readBytes(const std::string &extension, std::string_view bytes) {
  struct Format {
    std::string_view extension;
    Mesh (*read)(std::string_view bytes);
  };
  constexpr Format FORMATS[] = {{"stl", readStl},     {"ply", readPly},   {"obj", readObj},
                                {"dae", readCollada}, {"gltf", readGltf}, {"glb", readGltf}};
  for (const Format &format : FORMATS) {
    if (extension != format.extension) continue;
    Mesh mesh = format.read(bytes);
    if (mesh.triangles.empty()) throw Fault("there is no triangle in it");
    return mesh;
  }
  throw Fault("its format " + in_quotes(extension) + " is none of stl, ply, obj, dae, gltf, glb");
}

} // namespace curve_proximity::mesh_reader
