/* SPDX-License-Identifier: BSD-3-Clause */
#include "cloud_file.h"

#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <sstream>
#include <vector>

#include "bad_input.h"
#include "numbers.h"

namespace curve_proximity::yaml {
namespace {

using Words = std::vector<std::string>;

Words wordsOf(std::string line) {
  for (char &c : line)
    if (c == ',' || c == ';') c = ' ';
  std::istringstream stream(line);
  return {std::istream_iterator<std::string>(stream), {}};
}

/* A number of a record, as PCD and PLY name its kind: F or f float, I or i signed, U or u unsigned; size in bytes. */
struct Field {
  std::string name;
  char kind = 'f';
  std::size_t size = 4;
};

/* The points of one file, as they are read. */
class Cloud {
 public:
  explicit Cloud(const std::string &path) : path_(path) {
    std::ifstream in(path, std::ios::binary);
    if (!in || std::filesystem::is_directory(path)) throw BadInput(path + ": cannot be read");
    text_.assign(std::istreambuf_iterator<char>(in), {});
  }

  Eigen::Matrix3Xd read() {
    const std::string end = std::filesystem::path(path_).extension().string();
    if (end == ".pcd")
      readPcd();
    else if (end == ".ply")
      readPly();
    else if (end == ".xyz" || end == ".txt" || end == ".csv" || end == ".pts")
      readLines(std::nullopt, {0, 1, 2}, 3);
    else
      fail("points are read from .pcd, .ply and .xyz files");
    if (points_.empty()) fail("has no point");
    return Eigen::Map<const Eigen::Matrix3Xd>(points_.data(), 3, static_cast<Eigen::Index>(points_.size() / 3));
  }

 private:
  using Columns = std::array<std::size_t, 3>;

  [[noreturn]] void fail(const std::string &what) const {
    throw BadInput(path_ + ": " + what);
  }

  std::optional<std::string> nextLine() {
    if (at_ >= text_.size()) return std::nullopt;
    const std::size_t end = std::min(text_.find('\n', at_), text_.size());
    std::string out = text_.substr(at_, end - at_);
    at_ = end + 1;
    ++line_;
    if (!out.empty() && out.back() == '\r') out.pop_back();
    return out;
  }

  void add(const std::array<double, 3> &point) {
    for (const double x : point)
      if (std::isnan(x)) return; // no measurement
    for (const double x : point)
      if (!std::isfinite(x)) fail("point " + std::to_string(points_.size() / 3) + " is not finite");
    points_.insert(points_.end(), point.begin(), point.end());
  }

  /* A point a line: `count` of them, or all to the end; lines have `least` numbers or more. */
  void readLines(const std::optional<std::size_t> &count, const Columns &columns, std::size_t least) {
    std::size_t n = 0;
    while (!count || n < *count) {
      const std::optional<std::string> line = nextLine();
      if (!line && !count) return;
      if (!line) fail("ends after " + std::to_string(n) + " of " + std::to_string(*count) + " points");
      const Words words = wordsOf(*line);
      if (words.empty() || words[0][0] == '#' || words[0].rfind("//", 0) == 0) continue;
      if (words.size() < least) fail("line " + std::to_string(line_) + ": '" + *line + "' is no point");
      std::array<double, 3> point{};
      for (std::size_t k = 0; k < 3; ++k) {
        const std::string &word = words[columns[k]];
        const bool nan = word == "nan" || word == "NaN" || word == "-nan";
        const std::optional<double> value = nan ? std::nan("") : parseFinite(word);
        if (!value) fail("line " + std::to_string(line_) + ": '" + word + "' is not a finite number");
        point[k] = *value;
      }
      add(point);
      ++n;
    }
  }

  double numberAt(const Field &field, std::size_t at) const {
    const char *bytes = text_.data() + at;
    const auto take = [bytes](auto out) {
      std::memcpy(&out, bytes, sizeof out);
      return static_cast<double>(out);
    };
    if (field.kind == 'f') return field.size == 8 ? take(double()) : take(float());
    fail("the coordinate '" + field.name + "' is a whole number");
  }

  static Columns columnsOf(const std::vector<Field> &fields, std::size_t &found) {
    Columns out{};
    found = 0;
    for (std::size_t i = 0; i < fields.size(); ++i)
      for (std::size_t k = 0; k < 3; ++k)
        if (fields[i].name == std::string(1, "xyz"[k])) out[k] = i, ++found;
    return out;
  }

  void readRecords(const std::vector<Field> &fields, std::size_t count, bool binary) {
    std::size_t found = 0, size = 0;
    const Columns columns = columnsOf(fields, found);
    if (found != 3) fail("has not one each of x, y and z");
    if (!binary) return readLines(count, columns, fields.size());
    std::vector<std::size_t> offsets;
    for (const Field &field : fields) offsets.push_back(size), size += field.size;
    if (count > (text_.size() - std::min(at_, text_.size())) / size)
      fail("ends before the last of " + std::to_string(count) + " points");
    for (std::size_t i = 0; i < count; ++i, at_ += size) {
      std::array<double, 3> point{};
      for (std::size_t k = 0; k < 3; ++k) point[k] = numberAt(fields[columns[k]], at_ + offsets[columns[k]]);
      add(point);
    }
  }

  std::size_t countOf(const Words &words, std::size_t i) const {
    const std::optional<std::uint64_t> n = i < words.size() ? parseCount(words[i]) : std::nullopt;
    if (!n) fail("line " + std::to_string(line_) + ": a count is missing or is none");
    return static_cast<std::size_t>(*n);
  }

  void readPcd() {
    Words names, sizes, kinds, counts;
    std::optional<std::size_t> points;
    while (const std::optional<std::string> line = nextLine()) {
      Words words = wordsOf(*line);
      if (words.empty() || words[0][0] == '#') continue;
      const std::string key = words[0];
      if (key == "POINTS") points = countOf(words, 1);
      words.erase(words.begin());
      if (key == "FIELDS") names = words;
      if (key == "SIZE") sizes = words;
      if (key == "TYPE") kinds = words;
      if (key == "COUNT") counts = words;
      if (key != "DATA") continue;
      const std::string data = words.empty() ? "" : words[0];
      if (data != "ascii" && data != "binary")
        fail("its DATA is '" + data + "': ascii and binary are read (pcl_convert_pcd_ascii_binary converts it)");
      if (!points || sizes.size() != names.size() || kinds.size() != names.size())
        fail("its header lacks POINTS, or FIELDS, SIZE and TYPE of the same length");
      std::vector<Field> fields;
      for (std::size_t i = 0; i < names.size(); ++i) {
        const std::size_t times = counts.empty() ? 1 : countOf(counts, i);
        const Field field{names[i], kinds[i] == "F" ? 'f' : 'i', countOf(sizes, i)};
        if (field.size == 0 || field.size > 8) fail("the size of '" + field.name + "' is not 1 to 8");
        for (std::size_t k = 0; k < times; ++k) fields.push_back(field);
      }
      return readRecords(fields, *points, data == "binary");
    }
    fail("is no PCD file: it has no DATA");
  }

  void readPly() {
    static const std::array<std::pair<const char *, Field>, 16> known = {{{"char", {"", 'i', 1}},
                                                                          {"uchar", {"", 'i', 1}},
                                                                          {"int8", {"", 'i', 1}},
                                                                          {"uint8", {"", 'i', 1}},
                                                                          {"short", {"", 'i', 2}},
                                                                          {"ushort", {"", 'i', 2}},
                                                                          {"int16", {"", 'i', 2}},
                                                                          {"uint16", {"", 'i', 2}},
                                                                          {"int", {"", 'i', 4}},
                                                                          {"uint", {"", 'i', 4}},
                                                                          {"int32", {"", 'i', 4}},
                                                                          {"uint32", {"", 'i', 4}},
                                                                          {"float", {"", 'f', 4}},
                                                                          {"float32", {"", 'f', 4}},
                                                                          {"double", {"", 'f', 8}},
                                                                          {"float64", {"", 'f', 8}}}};
    if (nextLine() != "ply") fail("is no PLY file");
    std::string format, element;
    std::size_t count = 0;
    std::vector<Field> fields;
    while (const std::optional<std::string> line = nextLine()) {
      const Words words = wordsOf(*line);
      if (words.empty()) continue;
      if (words[0] == "format" && words.size() > 1) format = words[1];
      if (words[0] == "element" && words.size() > 1) {
        if (element.empty() && words[1] != "vertex") fail("its first element is not vertex");
        element = words[1];
        if (element == "vertex") count = countOf(words, 2);
      }
      if (words[0] == "property" && element == "vertex" && words.size() > 2) {
        Field field{words[2], 'f', 0};
        for (const auto &[name, kind] : known)
          if (words[1] == name) field.kind = kind.kind, field.size = kind.size;
        if (field.size == 0) fail("a vertex has a property of the type '" + words[1] + "'");
        fields.push_back(field);
      }
      if (words[0] != "end_header") continue;
      if (format != "ascii" && format != "binary_little_endian")
        fail("its format is '" + format + "': ascii and binary_little_endian are read");
      return readRecords(fields, count, format != "ascii");
    }
    fail("is no PLY file: its header does not end");
  }

  const std::string path_;
  std::string text_;
  std::size_t at_ = 0, line_ = 0;
  std::vector<double> points_;
};

} // namespace

Eigen::Matrix3Xd readCloud(const std::string &path) {
  return Cloud(path).read();
}

void readClouds(ObjectDescription &object, const std::string &folder) {
  for (ShapeDescription &shape : object.shapes) {
    if (shape.type != ShapeType::POINTS || shape.resource.empty()) continue;
    const std::string prefix = "file://";
    std::string path = shape.resource;
    if (path.rfind(prefix, 0) == 0)
      path.erase(0, prefix.size());
    else if (path.find("://") != std::string::npos)
      throw BadInput("object '" + object.id + "': points are read from files, not from '" + path + "'");
    if (std::filesystem::path(path).is_relative()) path = (std::filesystem::path(folder) / path).string();
    shape.vertices = readCloud(path);
    shape.resource.clear();
  }
}

} // namespace curve_proximity::yaml
