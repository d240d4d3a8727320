/* SPDX-License-Identifier: BSD-3-Clause */
/* OBJ. A line a vertex, `v x y z`, and a line a face, `f 1 2 3` or `f 1/1/1 2//2 -1`; a backslash continues a line. */
#include <cmath>

#include "text.h"

namespace curve_proximity::mesh_reader {
namespace {

class Obj {
 public:
  explicit Obj(std::string_view bytes) : words_(bytes) {}

  Triangles check() {
    do {
      const std::string_view word = words_.nextInLine();
      if (word == "v") readVertex();
      if (word == "f") readFace();
      while (!nextInStatement().empty()) continue;
    } while (words_.skipLine());
    if (largest_ > vertices_) throw Fault("line " + std::to_string(largest_line_) + ": " + outOfRange(largest_));
    if (!faces_) throw Fault("there is no face in it");
    return polygons_ ? std::nullopt : Triangles(triangles_);
  }

 private:
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
    return "a face uses vertex " + std::to_string(index) + ", but there are " + std::to_string(vertices_);
  }

  void readVertex() {
    for (int i = 0; i < 3; ++i) {
      const std::string_view word = nextInStatement();
      const std::optional<double> x = parseNumber(word);
      if (!x) words_.fail("a vertex needs three numbers" + (word.empty() ? "" : ": " + in_quotes(word) + " is none"));
      if (!std::isfinite(*x)) words_.fail("a vertex is not finite");
    }
    ++vertices_;
  }

  void readFace() {
    std::uint64_t corners = 0;
    for (std::string_view word = nextInStatement(); !word.empty(); word = nextInStatement(), ++corners) {
      if (word[0] == '#') break;
      const std::optional<std::int64_t> index = parseInteger(word.substr(0, word.find('/')));
      if (!index || *index == 0) words_.fail(in_quotes(word) + " is no vertex of a face");
      if (*index < -vertices_) words_.fail(outOfRange(*index));
      if (*index > largest_) largest_ = *index, largest_line_ = words_.line();
    }
    if (corners == 0) words_.fail("a face without vertices");
    faces_ = true;
    if (corners == 3) ++triangles_;
    if (corners > 3) polygons_ = true;
  }

  Words words_;
  std::int64_t vertices_ = 0, largest_ = 0;
  std::uint64_t largest_line_ = 0, triangles_ = 0;
  bool faces_ = false, polygons_ = false;
};

} // namespace

Triangles checkObj(std::string_view bytes) {
  return Obj(bytes).check();
}

} // namespace curve_proximity::mesh_reader
