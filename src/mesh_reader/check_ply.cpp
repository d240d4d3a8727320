/* SPDX-License-Identifier: BSD-3-Clause */
/* PLY. A header in text names elements, how many there are of each, and their properties; then come the elements, a
 * line each in the ascii format. */
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include "text.h"

namespace curve_proximity::mesh_reader {
namespace {

enum class Format { ASCII, LITTLE, BIG };

struct Type {
  const char *name, *other_name;
  std::size_t size; /* [bytes] */
  enum Kind { SIGNED, UNSIGNED, REAL } kind;
};

constexpr std::array<Type, 8> TYPES = {{{"char", "int8", 1, Type::SIGNED},
                                        {"uchar", "uint8", 1, Type::UNSIGNED},
                                        {"short", "int16", 2, Type::SIGNED},
                                        {"ushort", "uint16", 2, Type::UNSIGNED},
                                        {"int", "int32", 4, Type::SIGNED},
                                        {"uint", "uint32", 4, Type::UNSIGNED},
                                        {"float", "float32", 4, Type::REAL},
                                        {"double", "float64", 8, Type::REAL}}};

struct Property {
  std::string name;
  const Type *count = nullptr; /* of a list */
  const Type *value = nullptr;
};

struct Element {
  std::string name;
  std::uint64_t n = 0;
  std::vector<Property> properties;
};

struct Header {
  Format format = Format::ASCII;
  std::vector<Element> elements;
  std::size_t size = 0;   /* [bytes] the elements begin there */
  std::uint64_t line = 1; /* and in this line */
  std::uint64_t vertices = 0;
};

const Type &typeNamed(const Words &words, std::string_view name) {
  for (const Type &type : TYPES)
    if (name == type.name || name == type.other_name) return type;
  words.fail(in_quotes(name) + " is no type of a property");
}

/* ---- the header ---- */

void readFormat(Words &words, Header &header) {
  const std::string_view format = words.nextInLine();
  if (format == "ascii") {
    header.format = Format::ASCII;
  } else if (format == "binary_little_endian") {
    header.format = Format::LITTLE;
  } else if (format == "binary_big_endian") {
    header.format = Format::BIG;
  } else {
    words.fail("the format " + in_quotes(format) + " is none of ascii, binary_little_endian, binary_big_endian");
  }
}

void readElement(Words &words, Header &header) {
  const std::string_view name = words.nextInLine(), n = words.nextInLine();
  const std::optional<std::int64_t> number = parseInteger(n);
  if (name.empty()) words.fail("an element without a name");
  if (!number || *number < 0 || *number > std::numeric_limits<std::uint32_t>::max())
    words.fail("element " + in_quotes(name) + ": " + in_quotes(n) + " is no number of elements");
  header.elements.push_back({std::string(name), static_cast<std::uint64_t>(*number), {}});
}

void readProperty(Words &words, Header &header) {
  if (header.elements.empty()) words.fail("a property before the first element");
  Property property;
  std::string_view word = words.nextInLine();
  if (word == "list") {
    property.count = &typeNamed(words, words.nextInLine());
    if (property.count->kind == Type::REAL) words.fail("the length of a list must be an integer");
    word = words.nextInLine();
  }
  property.value = &typeNamed(words, word);
  property.name = std::string(words.nextInLine());
  header.elements.back().properties.push_back(std::move(property));
}

bool has(const Element &element, const char *property) {
  for (const Property &p : element.properties)
    if (p.name == property) return true;
  return false;
}

void checkElements(Header &header) {
  bool vertices = false, faces = false;
  for (const Element &element : header.elements) {
    if (element.name == "vertex") {
      if (!has(element, "x") || !has(element, "y") || !has(element, "z"))
        throw Fault("the element 'vertex' has no property x, y or z");
      header.vertices = element.n;
      vertices = true;
    }
    faces = faces || ((element.name == "face" || element.name == "tristrips") && element.n > 0);
  }
  if (!vertices) throw Fault("the header has no element 'vertex'");
  if (!faces) throw Fault("the header promises no face");
}

Header readHeader(std::string_view bytes) {
  Words words(bytes);
  if (words.next() != "ply") throw Fault("a PLY file begins with 'ply'");
  Header header;
  bool format = false;
  for (;;) {
    if (!words.skipLine()) words.fail("the file ends within the header");
    const std::string_view word = words.nextInLine();
    if (word == "end_header") break;
    if (word == "format") {
      readFormat(words, header);
      format = true;
    } else if (word == "element") {
      readElement(words, header);
    } else if (word == "property") {
      readProperty(words, header);
    } else if (!word.empty() && word != "comment" && word != "obj_info") {
      words.fail(in_quotes(word) + " is no word of a PLY header");
    }
  }
  if (!format) throw Fault("the header has no format");
  if (!words.skipLine()) words.fail("the file ends after the header");
  header.size = words.position();
  header.line = words.line();
  checkElements(header);
  return header;
}

/* ---- what counts are held against ---- */

/* Whether this property says which vertices a face has. */
bool namesVertices(const Element &element, const Property &property) {
  return element.name == "face" && property.count &&
         (property.name == "vertex_indices" || property.name == "vertex_index");
}

/* Counts the triangles; a polygon, or strips of triangles, leaves their number open. */
struct Faces {
  std::uint64_t triangles = 0;
  bool open = false;

  void add(std::uint64_t corners) {
    if (corners == 3) ++triangles;
    if (corners > 3) open = true;
  }
};

std::string placeOf(const Element &element, std::uint64_t i) {
  return "element " + in_quotes(element.name) + " " + std::to_string(i + 1) + " of " + std::to_string(element.n);
}

std::string cutAfter(const Element &element, std::uint64_t i) {
  return "the header promises " + std::to_string(element.n) + " of the element " + in_quotes(element.name) +
         ", the file ends after " + std::to_string(i);
}

void checkIndex(double index, const Header &header, const Element &element, std::uint64_t i) {
  if (index >= 0.0 && index < static_cast<double>(header.vertices)) return;
  throw Fault(placeOf(element, i) + ": it uses vertex " +
              std::to_string(index).substr(0, std::to_string(index).find('.')) + ", but there are " +
              std::to_string(header.vertices));
}

/* ---- binary elements ---- */

class BinaryPly {
 public:
  BinaryPly(std::string_view bytes, const Header &header) : bytes_(bytes), header_(header), at_(header.size) {}

  Faces check() {
    for (const Element &element : header_.elements) {
      std::size_t fixed = 0;
      bool lists = false;
      for (const Property &p : element.properties) {
        fixed += p.count ? p.count->size : p.value->size;
        lists = lists || p.count;
      }
      if (element.name == "tristrips") faces_.open = true;
      if (fixed == 0) continue;
      const std::uint64_t there = (bytes_.size() - at_) / fixed;
      if (!lists) {
        if (there < element.n) fail(element, there);
        at_ += fixed * element.n;
      }
      for (std::uint64_t i = 0; lists && i < element.n; ++i) readLists(element, i);
    }
    return faces_;
  }

 private:
  [[noreturn]] void fail(const Element &element, std::uint64_t i) const {
    throw Fault(cutAfter(element, i));
  }

  void readLists(const Element &element, std::uint64_t i) {
    for (const Property &p : element.properties) {
      if (!p.count) {
        take(p.value->size, element, i);
        continue;
      }
      const double n = valueOf(*p.count, take(p.count->size, element, i));
      if (n < 0.0)
        throw Fault(placeOf(element, i) + ": a list of " + std::to_string(static_cast<long>(n)) + " entries");
      const auto length = static_cast<std::uint64_t>(n);
      const char *entries = take(length * p.value->size, element, i);
      if (!namesVertices(element, p)) continue;
      faces_.add(length);
      for (std::uint64_t k = 0; k < length; ++k)
        checkIndex(valueOf(*p.value, entries + k * p.value->size), header_, element, i);
    }
  }

  const char *take(std::uint64_t size, const Element &element, std::uint64_t i) {
    if (bytes_.size() - at_ < size) fail(element, i);
    at_ += size;
    return bytes_.data() + at_ - size;
  }

  double valueOf(const Type &type, const char *at) const {
    std::uint64_t bits = 0;
    for (std::size_t i = 0; i < type.size; ++i) {
      const std::size_t from = header_.format == Format::LITTLE ? i : type.size - 1 - i;
      bits |= std::uint64_t{static_cast<unsigned char>(at[from])} << (8 * i);
    }
    if (type.kind == Type::UNSIGNED) return static_cast<double>(bits);
    if (type.kind == Type::SIGNED) {
      const std::uint64_t sign = std::uint64_t{1} << (8 * type.size - 1);
      return static_cast<double>(bits & (sign - 1)) - ((bits & sign) != 0 ? static_cast<double>(sign) : 0.0);
    }
    if (type.size == sizeof(double)) return as<double>(bits);
    return static_cast<double>(as<float>(static_cast<std::uint32_t>(bits)));
  }

  template <class Real, class Bits>
  static Real as(Bits bits) {
    static_assert(sizeof(Real) == sizeof(Bits));
    Real out;
    std::memcpy(&out, &bits, sizeof out);
    return out;
  }

  const std::string_view bytes_;
  const Header &header_;
  std::size_t at_;
  Faces faces_;
};

/* ---- elements in text ---- */

class TextPly {
 public:
  TextPly(std::string_view bytes, const Header &header)
      : words_(bytes.substr(header.size), header.line), header_(header) {}

  Faces check() {
    for (const Element &element : header_.elements) {
      if (element.name == "tristrips") faces_.open = true;
      for (std::uint64_t i = 0; i < element.n; ++i) {
        if (words_.atEnd()) throw Fault(cutAfter(element, i));
        readLine(element, i);
        words_.skipLine();
      }
    }
    return faces_;
  }

 private:
  void readLine(const Element &element, std::uint64_t i) {
    for (const Property &p : element.properties) {
      const double first = number(element, i);
      if (!p.count) continue;
      if (!(first >= 0.0 && first <= std::numeric_limits<std::uint32_t>::max()))
        words_.fail(placeOf(element, i) + ": the length of a list is negative or too large");
      const auto length = static_cast<std::uint64_t>(first);
      if (namesVertices(element, p)) faces_.add(length);
      for (std::uint64_t k = 0; k < length; ++k) {
        const double entry = number(element, i);
        if (namesVertices(element, p)) checkIndex(entry, header_, element, i);
      }
    }
  }

  double number(const Element &element, std::uint64_t i) {
    const std::string_view word = words_.nextInLine();
    if (word.empty()) words_.fail(placeOf(element, i) + ": the line ends too early");
    const std::optional<double> value = parseNumber(word);
    if (!value) words_.fail(placeOf(element, i) + ": " + in_quotes(word) + " is no number");
    return *value;
  }

  Words words_;
  const Header &header_;
  Faces faces_;
};

} // namespace

Triangles checkPly(std::string_view bytes) {
  const Header header = readHeader(bytes);
  const Faces faces =
      header.format == Format::ASCII ? TextPly(bytes, header).check() : BinaryPly(bytes, header).check();
  return faces.open ? std::nullopt : Triangles(faces.triangles);
}

} // namespace curve_proximity::mesh_reader
