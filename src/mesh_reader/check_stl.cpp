/* SPDX-License-Identifier: BSD-3-Clause */
/* STL. Binary: a header of 80 bytes, the number of triangles, 50 bytes each and nothing more. Text: solids of facets of
 * three vertices each, up to `endsolid`. */
#include <cmath>

#include "text.h"

namespace curve_proximity::mesh_reader {
namespace {

constexpr std::size_t HEADER = 84, TRIANGLE = 50; /* [bytes] */

std::uint64_t promised(std::string_view bytes) {
  std::uint64_t out = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    out |= std::uint64_t{static_cast<unsigned char>(bytes[HEADER - 4 + i])} << (8 * i);
  }
  return out;
}

bool isBinary(std::string_view bytes) {
  return bytes.size() >= HEADER && bytes.size() == HEADER + TRIANGLE * promised(bytes);
}

/* Begins with `solid` and has no zero byte where a binary header would have one. */
bool isText(std::string_view bytes) {
  constexpr std::size_t LOOKED_AT = 500;
  std::size_t at = 0;
  while (at < bytes.size() && (bytes[at] == ' ' || bytes[at] == '\t')) ++at;
  const std::string_view start = bytes.substr(0, LOOKED_AT);
  return bytes.substr(at, 5) == "solid" && start.find('\0') == std::string_view::npos;
}

[[noreturn]] void failBinary(std::string_view bytes) {
  const std::uint64_t size = bytes.size();
  if (size < HEADER)
    throw Fault("an STL file begins with 'solid' or has a header of 84 bytes: this one ends after " +
                count(size, "byte"));
  const std::uint64_t triangles = promised(bytes), whole = (size - HEADER) / TRIANGLE;
  const std::string start = "the header promises " + count(triangles, "triangle");
  if (whole < triangles) throw Fault(start + ", the file ends after " + std::to_string(whole));
  const std::uint64_t end = HEADER + TRIANGLE * triangles;
  throw Fault(start + ", which end at byte " + std::to_string(end) + ": the file has " + count(size - end, "byte") +
              " more");
}

/* One solid after another, in the words that libassimp looks for; it skips all others. */
class TextStl {
 public:
  explicit TextStl(std::string_view bytes) : words_(bytes) {}

  std::uint64_t check() {
    std::string_view word = words_.next();
    do {
      if (word.substr(0, 5) != "solid") words_.fail(in_quotes(word) + " stands after the end of the solid");
      words_.skipLine();
      checkSolid();
      word = words_.next();
    } while (!word.empty());
    return triangles_;
  }

 private:
  void checkSolid() {
    corners_ = 3;
    for (;;) {
      const std::string_view word = words_.next();
      if (word.empty()) {
        words_.fail("the file ends after " + count(triangles_, "triangle") + " without 'endsolid': it is cut short");
      }
      if (word == "vertex") {
        readVertex();
      } else if (word == "facet" || word == "endfacet" || word.substr(0, 8) == "endsolid") {
        if (corners_ != 3) words_.fail("a facet ends after " + std::to_string(corners_) + " of 3 vertices");
        if (word == "facet") corners_ = 0;
        if (word.substr(0, 8) == "endsolid") break;
      }
    }
    words_.skipLine();
  }

  void readVertex() {
    if (corners_ == 3) words_.fail("a vertex outside of a facet, or the fourth in one");
    for (int i = 0; i < 3; ++i) {
      const std::string_view word = words_.nextInLine();
      const std::optional<double> x = parseNumber(word);
      if (!x) words_.fail("a vertex needs three numbers" + (word.empty() ? "" : ": " + in_quotes(word) + " is none"));
      if (!std::isfinite(*x)) words_.fail("a vertex is not finite");
    }
    if (++corners_ == 3) ++triangles_;
  }

  Words words_;
  std::uint64_t triangles_ = 0, corners_ = 3; /* of the facet: 3 outside of one */
};

} // namespace

Triangles checkStl(std::string_view bytes) {
  if (isBinary(bytes)) return promised(bytes);
  if (!isText(bytes)) failBinary(bytes);
  return TextStl(bytes).check();
}

} // namespace curve_proximity::mesh_reader
