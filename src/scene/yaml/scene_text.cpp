/* SPDX-License-Identifier: BSD-3-Clause */
/* A name, then the objects, then a line with a dot. An object: `* id`, its pose, the number of its shapes, the shapes,
 * the number of its subframes, and of each a name and a pose. Older files have neither the object's pose nor subframes:
 * the line after the id is then one number. A shape: its kind, its sizes, its pose, its colour. */
#include "scene_text.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "bad_input.h"
#include "numbers.h"

namespace curve_proximity::yaml {
namespace {

class SceneText {
 public:
  explicit SceneText(std::istream &in) : text_(std::istreambuf_iterator<char>(in), {}) {}

  YAML::Node scene() {
    YAML::Node out;
    std::string line = nextLine();
    if (line.empty()) fail("is empty: that is no scene");
    if (!isObject(line) && line != ".") {
      out["name"] = line;
      line = nextLine();
    }
    YAML::Node objects(YAML::NodeType::Sequence);
    for (; isObject(line); line = nextLine()) objects.push_back(object(std::string(trimmed(line.substr(1)))));
    if (line.empty()) fail("ends without the line '.'");
    if (line != ".") fail("'" + line + "' is neither an object, '* id', nor the end, '.'");
    if (!nextLine().empty()) fail("text after the end, '.'");
    out["world"]["collision_objects"] = objects;
    return out;
  }

 private:
  static bool isObject(const std::string &line) {
    return !line.empty() && line.front() == '*';
  }

  [[noreturn]] void fail(const std::string &what) const {
    throw BadInput("line " + std::to_string(line_) + ": " + what);
  }

  void skipBlanks() {
    for (; at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_])); ++at_)
      line_ += text_[at_] == '\n';
  }

  /* The rest of the line, or the next one that is not blank; empty at the end of the file. */
  std::string nextLine() {
    skipBlanks();
    const std::size_t end = std::min(text_.find('\n', at_), text_.size());
    std::string out = text_.substr(at_, end - at_);
    while (!out.empty() && std::isspace(static_cast<unsigned char>(out.back()))) out.pop_back();
    at_ = end;
    return out;
  }

  std::string nextWord(const std::string &what) {
    skipBlanks();
    const std::size_t from = at_;
    while (at_ < text_.size() && !std::isspace(static_cast<unsigned char>(text_[at_]))) ++at_;
    if (from == at_) fail("the file ends before " + what);
    return text_.substr(from, at_ - from);
  }

  std::size_t nextCount(const std::string &what) {
    const std::string word = nextWord(what);
    const std::optional<std::uint64_t> n = parseCount(word);
    if (!n) fail("'" + word + "' is not " + what);
    return static_cast<std::size_t>(*n);
  }

  YAML::Node nextNumbers(std::size_t n, const std::string &what) {
    YAML::Node out(YAML::NodeType::Sequence);
    for (std::size_t i = 0; i < n; ++i) {
      const std::string word = nextWord(what);
      if (!parseFinite(word)) fail("'" + word + "' of " + what + " is not a finite number");
      out.push_back(word);
    }
    return out;
  }

  YAML::Node nextPose(const std::string &of) {
    YAML::Node out;
    out["position"] = nextNumbers(3, "the position of " + of);
    out["orientation"] = nextNumbers(4, "the orientation of " + of);
    return out;
  }

  YAML::Node object(const std::string &id) {
    YAML::Node out;
    out["id"] = id;
    const bool has_pose = lineHasSeveralWords();
    const std::string name = "'" + id + "'";
    if (has_pose) out["pose"] = nextPose(name);
    const std::size_t shapes = nextCount("the number of shapes of " + name);
    for (std::size_t i = 0; i < shapes; ++i) addShape(out, name);
    if (!has_pose) return out;
    const std::size_t subframes = nextCount("the number of subframes of " + name);
    for (std::size_t i = 0; i < subframes; ++i) {
      out["subframe_names"].push_back(nextLine());
      out["subframe_poses"].push_back(nextPose("a subframe of " + name));
    }
    return out;
  }

  bool lineHasSeveralWords() {
    const std::size_t at = at_, line = line_;
    const std::string next = nextLine();
    at_ = at, line_ = line;
    return next.find_first_of(" \t") != std::string::npos;
  }

  void addShape(YAML::Node &object, const std::string &of) {
    const std::string kind = nextWord("a shape of " + of);
    YAML::Node shape;
    const char *list = "primitives", *poses = "primitive_poses";
    if (kind == "box" || kind == "sphere") {
      shape["type"] = kind;
      shape["dimensions"] = nextNumbers(kind == "box" ? 3 : 1, "the sizes of a " + kind);
    } else if (kind == "cylinder" || kind == "cone") {
      const YAML::Node sizes = nextNumbers(2, "the sizes of a " + kind); /* radius, length */
      shape["type"] = kind;
      shape["dimensions"].push_back(sizes[1]);
      shape["dimensions"].push_back(sizes[0]);
    } else if (kind == "plane") {
      list = "planes", poses = "plane_poses";
      shape["coef"] = nextNumbers(4, "the coefficients of a plane");
    } else if (kind == "mesh") {
      list = "meshes", poses = "mesh_poses";
      shape = nextMesh();
    } else {
      fail("the shape '" + kind + "' is none of box, sphere, cylinder, cone, plane, mesh");
    }
    object[list].push_back(shape);
    object[poses].push_back(nextPose("a " + kind + " of " + of));
    nextNumbers(4, "the colour of a " + kind);
  }

  YAML::Node nextMesh() {
    const std::size_t vertices = nextCount("a mesh's number of vertices"),
                      triangles = nextCount("its number of triangles");
    YAML::Node out;
    for (std::size_t i = 0; i < vertices; ++i) out["vertices"].push_back(nextNumbers(3, "a vertex"));
    for (std::size_t i = 0; i < triangles; ++i) out["triangles"].push_back(nextNumbers(3, "a triangle"));
    return out;
  }

  std::string text_;
  std::size_t at_ = 0, line_ = 1;
};

} // namespace

bool isSceneText(const std::string &path) {
  return std::filesystem::path(path).extension() == ".scene";
}

YamlValue loadSceneText(const std::string &path) {
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw BadUsage(path + ": cannot be read");
  try {
    return YamlValue(SceneText(stream).scene(), "");
  } catch (const BadInput &e) {
    throw BadUsage(path + ": " + e.what());
  }
}

} // namespace curve_proximity::yaml
