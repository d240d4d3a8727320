/* SPDX-License-Identifier: BSD-3-Clause */
/* STL. Binary: a header of 80 bytes, the number of triangles, 50 bytes each and nothing more. Text: solids of facets of
 * three vertices each, up to `endsolid`; keywords in letters of either case. */
#include <array>
#include <cstring>
#include <vector>

#include "formats.h"
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

/* Begins with `solid`, after a byte order mark and blanks, and has no zero byte where a binary header would have one.
 */
bool isText(std::string_view bytes) {
  constexpr std::size_t LOOKED_AT = 500;
  return isWord(Words(bytes).next().substr(0, 5), "solid") &&
         bytes.substr(0, LOOKED_AT).find('\0') == std::string_view::npos;
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

/* Three floats, the lowest byte first. */
Point binaryPoint(const char *at) {
  Point out{};
  for (double &x : out) {
    std::uint32_t bits = 0;
    for (int i = 0; i < 4; ++i) bits |= std::uint32_t{static_cast<unsigned char>(*at++)} << (8 * i);
    float value = 0.0F;
    std::memcpy(&value, &bits, sizeof value);
    x = static_cast<double>(value);
  }
  return out;
}

/* A normal, three corners, and two bytes for whatever a program likes. */
void readBinary(std::string_view bytes, MeshBuilder &mesh) {
  constexpr std::size_t POINT = 12;
  for (std::size_t at = HEADER; at < bytes.size(); at += TRIANGLE) {
    const char *corner = bytes.data() + at + POINT;
    const std::uint32_t a = mesh.add(binaryPoint(corner)), b = mesh.add(binaryPoint(corner + POINT)),
                        c = mesh.add(binaryPoint(corner + 2 * POINT));
    mesh.addTriangle(a, b, c);
  }
}

/* One solid after another. Words but those of the format are skipped: names, colours. */
class TextStl {
 public:
  TextStl(std::string_view bytes, MeshBuilder &mesh) : words_(bytes), mesh_(mesh) {}

  void read() {
    std::string_view word = words_.next();
    do {
      if (!isWord(word.substr(0, 5), "solid")) words_.fail(in_quotes(word) + " stands after the end of the solid");
      words_.skipLine();
      readSolid();
      word = words_.next();
    } while (!word.empty());
  }

 private:
  void readSolid() {
    open_ = false;
    for (;;) {
      const std::string_view word = words_.next();
      if (word.empty()) {
        words_.fail("the file ends after " + count(triangles_, "triangle") + " without 'endsolid': it is cut short");
      }
      const bool begin = isWord(word, "facet"), end = isWord(word.substr(0, 8), "endsolid");
      if (isWord(word, "vertex")) {
        readVertex();
      } else if (begin || end || isWord(word, "endfacet")) {
        if (open_) words_.fail("a facet ends after " + std::to_string(corners_.size()) + " of 3 vertices");
        corners_.clear();
        open_ = begin;
        if (end) break;
      }
    }
    words_.skipLine();
  }

  void readVertex() {
    if (!open_) words_.fail("a vertex outside of a facet, or the fourth in one");
    corners_.push_back(mesh_.add(readPoint([this] { return words_.nextInLine(); }, words_)));
    if (corners_.size() < 3) return;
    mesh_.addPolygon(corners_);
    ++triangles_;
    open_ = false;
  }

  Words words_;
  MeshBuilder &mesh_;
  std::uint64_t triangles_ = 0;
  std::vector<std::uint32_t> corners_;
  bool open_ = false; /* within a facet that lacks corners */
};

} // namespace

Mesh readStl(std::string_view bytes) {
  MeshBuilder mesh;
  if (isBinary(bytes)) {
    readBinary(bytes, mesh);
  } else if (isText(bytes)) {
    TextStl(bytes, mesh).read();
  } else {
    failBinary(bytes);
  }
  return mesh.finish();
}

} // namespace curve_proximity::mesh_reader
