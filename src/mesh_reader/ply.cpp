/* SPDX-License-Identifier: BSD-3-Clause */
/* PLY. A header in text names elements, how many there are of each, and their properties; then come the elements, a
 * line each in the ascii format. */
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include "formats.h"
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

/* Whether this property says which vertices the faces, or strips of triangles, have. */
bool namesVertices(const Property &property) {
  return property.count && (property.name == "vertex_indices" || property.name == "vertex_index");
}

bool isCoordinate(const Property &property, std::size_t axis) {
  return !property.count && property.name == std::string(1, static_cast<char>('x' + axis));
}

template <class Is>
void expectOne(const Element &element, const std::string &what, Is is) {
  const auto n = std::count_if(element.properties.begin(), element.properties.end(), is);
  if (n == 1) return;
  throw Fault("the element " + in_quotes(element.name) + " has " +
              (n ? std::to_string(n) + " properties " : "no property ") + what);
}

void checkElements(Header &header) {
  std::size_t vertices = 0;
  bool faces = false;
  for (const Element &element : header.elements) {
    if (element.name == "vertex") {
      for (std::size_t axis = 0; axis < 3; ++axis)
        expectOne(element, std::string(1, static_cast<char>('x' + axis)),
                  [&](const Property &p) { return isCoordinate(p, axis); });
      header.vertices = element.n;
      ++vertices;
    } else if ((element.name == "face" || element.name == "tristrips") && element.n > 0) {
      expectOne(element, "vertex_indices", namesVertices);
      faces = true;
    }
  }
  if (vertices != 1)
    throw Fault(vertices ? "the header has two elements 'vertex'" : "the header has no element 'vertex'");
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

/* ---- the elements ---- */

std::string placeOf(const Element &element, std::uint64_t i) {
  return "element " + in_quotes(element.name) + " " + std::to_string(i + 1) + " of " + std::to_string(element.n);
}

std::string cutAfter(const Element &element, std::uint64_t i) {
  return "the header promises " + std::to_string(element.n) + " of the element " + in_quotes(element.name) +
         ", the file ends after " + std::to_string(i);
}

/* Numbers as the binary formats have them. */
class BinaryNumbers {
 public:
  BinaryNumbers(std::string_view bytes, const Header &header)
      : bytes_(bytes), little_(header.format == Format::LITTLE), at_(header.size) {}

  void begin(const Element &, std::uint64_t) {}
  void end() {}

  double next(const Type &type, const Element &element, std::uint64_t i) {
    expect(type.size, element, i);
    const char *at = bytes_.data() + at_;
    at_ += type.size;
    std::uint64_t bits = 0;
    for (std::size_t k = 0; k < type.size; ++k) {
      const std::size_t from = little_ ? k : type.size - 1 - k;
      bits |= std::uint64_t{static_cast<unsigned char>(at[from])} << (8 * k);
    }
    if (type.kind == Type::UNSIGNED) return static_cast<double>(bits);
    if (type.kind == Type::SIGNED) {
      const std::uint64_t sign = std::uint64_t{1} << (8 * type.size - 1);
      return static_cast<double>(bits & (sign - 1)) - ((bits & sign) != 0 ? static_cast<double>(sign) : 0.0);
    }
    if (type.size == sizeof(double)) return as<double>(bits);
    return static_cast<double>(as<float>(static_cast<std::uint32_t>(bits)));
  }

  /* Fails where so many bytes are not there. */
  void expect(std::uint64_t size, const Element &element, std::uint64_t i) const {
    if (bytes_.size() - at_ < size) throw Fault(cutAfter(element, i));
  }

 private:
  template <class Real, class Bits>
  static Real as(Bits bits) {
    static_assert(sizeof(Real) == sizeof(Bits));
    Real out;
    std::memcpy(&out, &bits, sizeof out);
    return out;
  }

  const std::string_view bytes_;
  const bool little_;
  std::size_t at_;
};

/* Numbers in text, a line an element. */
class TextNumbers {
 public:
  TextNumbers(std::string_view bytes, const Header &header) : words_(bytes.substr(header.size), header.line) {}

  void begin(const Element &element, std::uint64_t i) const {
    if (words_.atEnd()) throw Fault(cutAfter(element, i));
  }
  void end() {
    words_.skipLine();
  }

  double next(const Type &, const Element &element, std::uint64_t i) {
    const std::string_view word = words_.nextInLine();
    if (word.empty()) words_.fail(placeOf(element, i) + ": the line ends too early");
    const std::optional<double> value = parseNumber(word);
    if (!value) words_.fail(placeOf(element, i) + ": " + in_quotes(word) + " is no number");
    return *value;
  }

  void expect(std::uint64_t, const Element &, std::uint64_t) const {}

 private:
  Words words_;
};

template <class Numbers>
class Ply {
 public:
  Ply(std::string_view bytes, const Header &header) : numbers_(bytes, header), header_(header) {}

  Mesh read() {
    for (const Element &element : header_.elements) {
      if (element.properties.empty() && header_.format != Format::ASCII) continue;
      for (std::uint64_t i = 0; i < element.n; ++i) readElement(element, i);
    }
    return mesh_.finish();
  }

 private:
  void readElement(const Element &element, std::uint64_t i) {
    const bool is_vertex = element.name == "vertex", is_face = element.name == "face",
               is_strip = element.name == "tristrips";
    Point position{};
    numbers_.begin(element, i);
    for (const Property &p : element.properties) {
      const double value = numbers_.next(p.count ? *p.count : *p.value, element, i);
      if (p.count) {
        readList(p, value, element, i);
        if (namesVertices(p) && is_face) mesh_.addPolygon(list_);
        if (namesVertices(p) && is_strip) addStrips();
        continue;
      }
      for (std::size_t axis = 0; is_vertex && axis < 3; ++axis)
        if (isCoordinate(p, axis)) position[axis] = value;
    }
    numbers_.end();
    if (!is_vertex) return;
    for (const double x : position)
      if (!std::isfinite(x)) throw Fault(placeOf(element, i) + ": it is not finite");
    mesh_.add(position);
  }

  void readList(const Property &p, double length, const Element &element, std::uint64_t i) {
    if (!(length >= 0.0 && length <= std::numeric_limits<std::uint32_t>::max()))
      throw Fault(placeOf(element, i) + ": the length of a list is negative or too large");
    const auto n = static_cast<std::uint64_t>(length);
    numbers_.expect(n * p.value->size, element, i);
    const bool strips = element.name == "tristrips", wanted = namesVertices(p) && (strips || element.name == "face");
    list_.clear();
    for (std::uint64_t k = 0; k < n; ++k) {
      const double entry = numbers_.next(*p.value, element, i);
      if (!wanted) continue;
      if (strips && entry == -1.0) {
        list_.push_back(NEXT_STRIP);
      } else if (entry >= 0.0 && entry < static_cast<double>(header_.vertices) && entry == std::floor(entry)) {
        list_.push_back(static_cast<std::uint32_t>(entry));
      } else {
        const std::string index = std::to_string(entry);
        throw Fault(placeOf(element, i) + ": it uses vertex " +
                    (entry == std::floor(entry) ? index.substr(0, index.find('.')) : index) + ", but there are " +
                    std::to_string(header_.vertices));
      }
    }
  }

  /* Each corner from the third on makes a triangle with the two before it, every second one turned. */
  void addStrips() {
    std::size_t begin = 0;
    for (std::size_t k = 0; k < list_.size(); ++k) {
      if (list_[k] == NEXT_STRIP) begin = k + 1;
      if (list_[k] == NEXT_STRIP || k < begin + 2) continue;
      const bool turned = (k - begin) % 2 == 1;
      mesh_.addTriangle(list_[k - (turned ? 1 : 2)], list_[k - (turned ? 2 : 1)], list_[k]);
    }
  }

  static constexpr std::uint32_t NEXT_STRIP = std::numeric_limits<std::uint32_t>::max();

  Numbers numbers_;
  const Header &header_;
  MeshBuilder mesh_;
  std::vector<std::uint32_t> list_;
};

} // namespace

Mesh readPly(std::string_view bytes) {
  const Header header = readHeader(bytes);
  return header.format == Format::ASCII ? Ply<TextNumbers>(bytes, header).read()
                                        : Ply<BinaryNumbers>(bytes, header).read();
}

} // namespace curve_proximity::mesh_reader
