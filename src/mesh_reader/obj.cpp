/* SPDX-License-Identifier: BSD-3-Clause */
/* OBJ. A line a vertex, `v x y z`, and a line a face, `f 1 2 3` or `f 1/1/1 2//2 -1`; a backslash continues a line. */
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "formats.h"
#include "text.h"

namespace curve_proximity::mesh_reader {
namespace {

/* Statements without a surface: normals, textures, materials, groups, points, lines, and how things are shown. */
constexpr std::array<std::string_view, 21> WITHOUT_SURFACE = {
    "vn",       "vt",       "vp",    "o",   "g",          "s",         "mg",    "mtllib", "usemtl", "maplib", "usemap",
    "c_interp", "d_interp", "bevel", "lod", "shadow_obj", "trace_obj", "ctech", "stech",  "l",      "p"};

class Obj {
 public:
  explicit Obj(std::string_view bytes) : words_(bytes) {}

  Mesh read() {
    do {
      const std::string_view word = words_.nextInLine();
      if (word == "v") {
        readVertex();
      } else if (word == "f" || word == "fo") {
        readFace();
      } else if (!word.empty() && word[0] != '#' &&
                 std::find(WITHOUT_SURFACE.begin(), WITHOUT_SURFACE.end(), word) == WITHOUT_SURFACE.end()) {
        words_.fail(in_quotes(word) + " is not read: of OBJ files the vertices and the faces are");
      }
      while (!nextInStatement().empty()) continue;
    } while (words_.skipLine());
    if (largest_ > vertices()) throw Fault("line " + std::to_string(largest_line_) + ": " + outOfRange(largest_));
    if (!faces_) throw Fault("there is no face in it");
    return mesh_.finish();
  }

 private:
  std::int64_t vertices() const {
    return static_cast<std::int64_t>(mesh_.positions());
  }

  /* The next word of the line, or of that which continues it. */
  std::string_view nextInStatement() {
    for (;;) {
      std::string_view word = words_.nextInLine();
      if (word.empty() || word.back() != '\\') return word;
      word.remove_suffix(1);
      const bool goes_on = words_.skipLine();
      if (!word.empty() || !goes_on) return word;
    }
  }

  std::string outOfRange(std::int64_t index) const {
    return "a face uses vertex " + std::to_string(index) + ", but there are " + std::to_string(vertices());
  }

  /* x y z, a weight that divides them, or a colour of three or four numbers. */
  void readVertex() {
    Point p = readPoint([this] { return nextInStatement(); }, words_);
    std::size_t more = 0;
    double weight = 1.0;
    for (std::string_view word = nextInStatement(); !word.empty() && word[0] != '#'; word = nextInStatement()) {
      const std::optional<double> x = parseNumber(word);
      if (!x) words_.fail(in_quotes(word) + " of a vertex is no number");
      if (more++ == 0) weight = *x;
    }
    if (more == 2 || more > 4)
      words_.fail("a vertex has three numbers, four with a weight, or six or seven with a colour, got " +
                  std::to_string(3 + more));
    if (more == 1) {
      for (double &x : p) x /= weight;
      if (!std::isfinite(p[0]) || !std::isfinite(p[1]) || !std::isfinite(p[2]))
        words_.fail("a vertex divided by its weight is not finite");
    }
    mesh_.add(p);
  }

  void readFace() {
    corners_.clear();
    for (std::string_view word = nextInStatement(); !word.empty() && word[0] != '#'; word = nextInStatement()) {
      const std::optional<std::int64_t> index = parseInteger(word.substr(0, word.find('/')));
      if (!index || *index == 0) words_.fail(in_quotes(word) + " is no vertex of a face");
      if (*index < -vertices() || *index > std::numeric_limits<std::int32_t>::max()) words_.fail(outOfRange(*index));
      if (*index > largest_) largest_ = *index, largest_line_ = words_.line();
      corners_.push_back(static_cast<std::uint32_t>(*index < 0 ? vertices() + *index : *index - 1));
    }
    if (corners_.size() < 3) words_.fail("a face has three vertices or more, got " + std::to_string(corners_.size()));
    faces_ = true;
    mesh_.addPolygon(corners_);
  }

  Words words_;
  MeshBuilder mesh_;
  std::vector<std::uint32_t> corners_;
  std::int64_t largest_ = 0;
  std::uint64_t largest_line_ = 0;
  bool faces_ = false;
};

} // namespace

Mesh readObj(std::string_view bytes) {
  return Obj(bytes).read();
}

} // namespace curve_proximity::mesh_reader
