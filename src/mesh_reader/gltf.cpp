/* SPDX-License-Identifier: BSD-3-Clause */
/* glTF 2.0: JSON, alone or as the first chunk of a .glb file. A scene has nodes with a pose each; a mesh has
 * primitives, which read positions and indices through accessors from views of buffers. */
#include <rapidjson/document.h>
#include <rapidjson/error/en.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "formats.h"
#include "pose.h"
#include "text.h"

namespace curve_proximity::mesh_reader {
namespace {

using Value = rapidjson::Value;

/* Nodes in nodes: a scene that contains itself has no end. */
constexpr int DEEPEST_SCENE = 200;

/* ---- JSON ---- */

const Value *find(const Value &object, const char *name) {
  if (!object.IsObject()) return nullptr;
  const auto member = object.FindMember(name);
  return member == object.MemberEnd() ? nullptr : &member->value;
}

/* A number from 0 on under a name. */
std::optional<std::size_t> findIndex(const Value &object, const char *name, const std::string &of) {
  const Value *value = find(object, name);
  if (!value) return std::nullopt;
  if (!value->IsUint()) throw Fault(of + ": its " + name + " is no integer from 0 on");
  return value->GetUint();
}

std::size_t indexOf(const Value &object, const char *name, const std::string &of) {
  const std::optional<std::size_t> out = findIndex(object, name, of);
  if (!out) throw Fault(of + " has no " + name);
  return *out;
}

std::string textOf(const Value &object, const char *name, const std::string &of) {
  const Value *value = find(object, name);
  if (!value || !value->IsString()) throw Fault(of + " has no " + name);
  return {value->GetString(), value->GetStringLength()};
}

/* As many finite numbers as `out` has; as it is where the name is not there. */
template <std::size_t N>
void readNumbers(const Value &object, const char *name, const std::string &of, std::array<double, N> &out) {
  const Value *value = find(object, name);
  if (!value) return;
  const std::string what = of + ": its " + name + " has not " + std::to_string(N) + " finite numbers";
  if (!value->IsArray() || value->Size() != N) throw Fault(what);
  for (std::size_t i = 0; i < N; ++i) {
    const Value &x = (*value)[static_cast<rapidjson::SizeType>(i)];
    if (!x.IsNumber() || !std::isfinite(x.GetDouble())) throw Fault(what);
    out[i] = x.GetDouble();
  }
}

/* ---- buffers ---- */

std::string fromBase64(std::string_view text, const std::string &of) {
  std::string out;
  out.reserve(text.size() / 4 * 3);
  std::uint32_t bits = 0;
  int n = 0;
  while (!text.empty() && text.back() == '=') text.remove_suffix(1);
  for (const char c : text) {
    const int value = c >= 'A' && c <= 'Z'   ? c - 'A'
                      : c >= 'a' && c <= 'z' ? c - 'a' + 26
                      : c >= '0' && c <= '9' ? c - '0' + 52
                      : c == '+'             ? 62
                      : c == '/'             ? 63
                                             : -1;
    if (value < 0) throw Fault(of + ": its base64 text has the character " + in_quotes(std::string_view(&c, 1)));
    bits = bits << 6 | static_cast<std::uint32_t>(value);
    if (++n % 4 == 1) continue;
    out += static_cast<char>(bits >> (2 * (3 - (n - 1) % 4)) & 0xff);
  }
  return out;
}

/* Of an accessor: a column of numbers of one type. */
struct Component {
  unsigned code;
  std::size_t size; /* [bytes] */
  bool is_signed;
  double largest; /* of integers: what counts as 1 where they are normalised; 0 of floats */
};
constexpr Component COMPONENTS[] = {{5120, 1, true, 127},    {5121, 1, false, 255},          {5122, 2, true, 32767},
                                    {5123, 2, false, 65535}, {5125, 4, false, 4294967295.0}, {5126, 4, true, 0}};

double numberAt(const char *at, const Component &type, bool normalised) {
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < type.size; ++i) bits |= std::uint32_t{static_cast<unsigned char>(at[i])} << (8 * i);
  if (type.largest == 0.0) {
    float value = 0.0F;
    std::memcpy(&value, &bits, sizeof value);
    return static_cast<double>(value);
  }
  const std::uint32_t sign = std::uint32_t{1} << (8 * type.size - 1);
  double value = bits;
  if (type.is_signed && (bits & sign) != 0) value -= 2.0 * static_cast<double>(sign);
  return normalised ? std::max(value / type.largest, -1.0) : value;
}

class Gltf {
 public:
  Gltf(std::string_view json, std::optional<std::string_view> binary) : binary_(binary) {
    // Iterative: nested lists do not use the stack.
    constexpr unsigned FLAGS = rapidjson::kParseIterativeFlag | rapidjson::kParseFullPrecisionFlag;
    document_.Parse<FLAGS>(json.data(), json.size());
    if (document_.HasParseError())
      throw Fault("its JSON is wrong at character " + std::to_string(document_.GetErrorOffset() + 1) + ": " +
                  rapidjson::GetParseError_En(document_.GetParseError()));
    checkVersion();
    checkExtensions();
  }

  Mesh read() {
    const std::size_t number = findIndex(document_, "scene", "the file").value_or(0);
    const Value &scene = entry("scenes", number);
    if (const Value *nodes = find(scene, "nodes")) readNodes(*nodes, "scene " + std::to_string(number), Pose{}, 0);
    return mesh_.finish();
  }

 private:
  static std::string nameOf(const char *list, std::size_t i) {
    const std::string plural = list;
    return plural.substr(0, plural.size() - (plural == "meshes" ? 2 : 1)) + " " + std::to_string(i); // "node 3"
  }

  const Value &entry(const char *list, std::size_t i) const {
    const Value *all = find(document_, list);
    const std::size_t n = all && all->IsArray() ? all->Size() : 0;
    if (i < n) return (*all)[static_cast<rapidjson::SizeType>(i)];
    throw Fault(nameOf(list, i) + " is used, but there are " + std::to_string(n));
  }

  void checkVersion() const {
    const Value *asset = find(document_, "asset");
    if (!asset) throw Fault("a glTF file has an 'asset' with its version");
    const std::string version = textOf(*asset, "version", "its asset");
    if (version.substr(0, 2) != "2.") throw Fault("its version is " + in_quotes(version) + ": glTF 2 is read");
  }

  /* What has to be known to show the file. */
  void checkExtensions() const {
    const Value *required = find(document_, "extensionsRequired");
    if (!required) return;
    if (!required->IsArray()) throw Fault("its extensionsRequired is no list");
    for (const Value &extension : required->GetArray()) {
      const std::string name = extension.IsString() ? extension.GetString() : "";
      bool known = name == "KHR_mesh_quantization";
      for (const char *looks : {"KHR_materials_", "KHR_texture_", "EXT_texture_", "KHR_lights_"})
        known = known || name.rfind(looks, 0) == 0;
      if (!known) throw Fault("it requires the extension " + in_quotes(name) + ", which is not read");
    }
  }

  /* ---- nodes ---- */

  void readNodes(const Value &list, const std::string &of, const Pose &pose, int depth) {
    if (!list.IsArray()) throw Fault(of + ": its nodes are no list");
    if (depth > DEEPEST_SCENE) throw Fault("more than " + std::to_string(DEEPEST_SCENE) + " nodes in each other");
    for (const Value &number : list.GetArray()) {
      if (!number.IsUint()) throw Fault(of + ": the number of a node is no integer from 0 on");
      readNode(number.GetUint(), pose, depth);
    }
  }

  void readNode(std::size_t number, const Pose &parent, int depth) {
    const Value &node = entry("nodes", number);
    const std::string name = nameOf("nodes", number);
    const Pose pose = parent * poseOf(node, name);
    const Value *extensions = find(node, "extensions");
    if (extensions && find(*extensions, "EXT_mesh_gpu_instancing"))
      throw Fault(name + ": its instances (EXT_mesh_gpu_instancing) are not read");
    if (const std::optional<std::size_t> mesh = findIndex(node, "mesh", name)) {
      if (find(node, "skin")) throw Fault(name + ": skinned meshes are not read");
      readMesh(entry("meshes", *mesh), node, "mesh " + std::to_string(*mesh), pose);
    }
    if (const Value *children = find(node, "children")) readNodes(*children, name, pose, depth + 1);
  }

  static Pose poseOf(const Value &node, const std::string &name) {
    Pose out;
    if (find(node, "matrix")) { // column by column
      std::array<double, 16> m{};
      readNumbers(node, "matrix", name, m);
      if (m[3] != 0.0 || m[7] != 0.0 || m[11] != 0.0 || m[15] != 1.0)
        throw Fault(name + ": the last row of its matrix is not 0 0 0 1");
      for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t k = 0; k < 4; ++k) out.rows[i][k] = m[4 * k + i];
      return out;
    }
    Point t{}, s{1.0, 1.0, 1.0};
    std::array<double, 4> q{0.0, 0.0, 0.0, 1.0};
    readNumbers(node, "translation", name, t);
    readNumbers(node, "rotation", name, q);
    readNumbers(node, "scale", name, s);
    const double length = std::hypot(std::hypot(q[0], q[1]), std::hypot(q[2], q[3]));
    if (!(length > 0.0)) throw Fault(name + ": its rotation is 0 0 0 0");
    for (double &x : q) x /= length;
    const double x = q[0], y = q[1], z = q[2], w = q[3];
    const Pose turn{{{{1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y), 0.0},
                      {2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x), 0.0},
                      {2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y), 0.0}}}};
    return Pose::translation(t[0], t[1], t[2]) * turn * Pose::scaling(s[0], s[1], s[2]);
  }

  /* ---- meshes ---- */

  /* Whether the weights of a node, or else of its mesh, move vertices. */
  static bool isMorphed(const Value &mesh, const Value &node) {
    const Value *weights = find(node, "weights");
    if (!weights) weights = find(mesh, "weights");
    if (!weights || !weights->IsArray()) return false;
    for (const Value &weight : weights->GetArray())
      if (!weight.IsNumber() || weight.GetDouble() != 0.0) return true;
    return false;
  }

  void readMesh(const Value &mesh, const Value &node, const std::string &name, const Pose &pose) {
    if (isMorphed(mesh, node)) throw Fault(name + ": morphed meshes are not read");
    const Value *primitives = find(mesh, "primitives");
    if (!primitives || !primitives->IsArray()) throw Fault(name + " has no primitives");
    for (const Value &primitive : primitives->GetArray()) {
      constexpr std::size_t TRIANGLES = 4, STRIP = 5, FAN = 6;
      const std::size_t mode = findIndex(primitive, "mode", name).value_or(TRIANGLES);
      if (mode > FAN) throw Fault(name + ": " + std::to_string(mode) + " is no mode of a primitive");
      if (mode < TRIANGLES) continue; // points and lines
      const Value *attributes = find(primitive, "attributes");
      if (!attributes) throw Fault(name + ": a primitive has no attributes");
      const std::size_t first = mesh_.positions();
      readPositions(indexOf(*attributes, "POSITION", name), pose);
      const std::vector<std::uint32_t> corners = cornersOf(primitive, name, first);
      if (mode == TRIANGLES && corners.size() % 3 != 0)
        throw Fault(name + ": " + std::to_string(corners.size()) + " corners are no multiple of 3");
      for (std::size_t k = 2; k < corners.size(); k += mode == TRIANGLES ? 3 : 1) {
        const bool turned = (mode == STRIP && k % 2 == 1) != pose.mirrors();
        const std::uint32_t a = corners[mode == FAN ? 0 : k - 2], b = corners[k - 1];
        mesh_.addTriangle(turned ? b : a, turned ? a : b, corners[k]);
      }
    }
  }

  void readPositions(std::size_t accessor, const Pose &pose) {
    const std::vector<double> x = columnsOf(accessor, "VEC3", 3);
    for (std::size_t i = 0; i < x.size(); i += 3) {
      const Point p = pose({x[i], x[i + 1], x[i + 2]});
      if (!std::isfinite(p[0]) || !std::isfinite(p[1]) || !std::isfinite(p[2]))
        throw Fault(nameOf("accessors", accessor) + ": position " + std::to_string(i / 3) + " is not finite");
      mesh_.add(p);
    }
  }

  /* The positions from `first` on that make triangles: those of the indices, or all. */
  std::vector<std::uint32_t> cornersOf(const Value &primitive, const std::string &name, std::size_t first) const {
    std::vector<std::uint32_t> out;
    const std::size_t n = mesh_.positions() - first;
    const auto add = [&](double index) {
      if (!(index < static_cast<double>(n)))
        throw Fault(name + " uses vertex " + std::to_string(static_cast<std::uint64_t>(index)) + ", but there are " +
                    std::to_string(n));
      out.push_back(static_cast<std::uint32_t>(first) + static_cast<std::uint32_t>(index));
    };
    if (const std::optional<std::size_t> indices = findIndex(primitive, "indices", name)) {
      for (const double index : columnsOf(*indices, "SCALAR", 1)) add(index);
    } else {
      for (std::size_t i = 0; i < n; ++i) add(static_cast<double>(i));
    }
    return out;
  }

  /* ---- accessors ---- */

  static const Component &componentOf(const Value &accessor, const std::string &name) {
    const std::size_t code = indexOf(accessor, "componentType", name);
    for (const Component &type : COMPONENTS)
      if (code == type.code) return type;
    throw Fault(name + ": " + std::to_string(code) + " is no componentType");
  }

  /* `columns` numbers of each element, element by element. */
  std::vector<double> columnsOf(std::size_t number, const char *type, std::size_t columns) const {
    const Value &accessor = entry("accessors", number);
    const std::string name = nameOf("accessors", number);
    const std::string there = textOf(accessor, "type", name);
    if (there != type) throw Fault(name + " is of type " + in_quotes(there) + ", not " + type);
    const Component &component = componentOf(accessor, name);
    if (columns == 1 && (component.is_signed || component.largest == 0.0))
      throw Fault(name + ": indices are unsigned integers");
    const Value *flag = find(accessor, "normalized");
    const bool normalised = flag && flag->IsTrue();
    const std::size_t n = indexOf(accessor, "count", name);
    std::vector<double> out;
    if (find(accessor, "bufferView")) {
      out = read(accessor, component, n, columns, normalised, name);
    } else {
      if (n > std::numeric_limits<std::int32_t>::max() / 8) throw Fault(name + " has more elements than are read");
      out.assign(n * columns, 0.0);
    }
    if (const Value *sparse = find(accessor, "sparse")) replace(*sparse, component, columns, normalised, name, out);
    return out;
  }

  std::vector<double> read(const Value &from, const Component &component, std::size_t n, std::size_t columns,
                           bool normalised, const std::string &name) const {
    const std::size_t number = indexOf(from, "bufferView", name);
    const Value &view = entry("bufferViews", number);
    const std::string view_name = nameOf("bufferViews", number);
    const std::string_view buffer = bufferOf(indexOf(view, "buffer", view_name));
    const std::size_t begin = findIndex(view, "byteOffset", view_name).value_or(0),
                      length = indexOf(view, "byteLength", view_name),
                      offset = findIndex(from, "byteOffset", name).value_or(0), element = columns * component.size,
                      stride = findIndex(view, "byteStride", view_name).value_or(element);
    if (begin > buffer.size() || length > buffer.size() - begin)
      throw Fault(view_name + " goes beyond its buffer of " + count(buffer.size(), "byte"));
    if (stride < element) throw Fault(view_name + ": its byteStride is less than an element");
    if (n > 0 && (offset > length || element > length - offset || (n - 1) > (length - offset - element) / stride))
      throw Fault(name + " goes beyond its view of " + count(length, "byte"));
    std::vector<double> out;
    out.reserve(n * columns);
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t k = 0; k < columns; ++k)
        out.push_back(
            numberAt(buffer.data() + begin + offset + i * stride + k * component.size, component, normalised));
    return out;
  }

  /* The elements that a sparse accessor has of its own. */
  void replace(const Value &sparse, const Component &component, std::size_t columns, bool normalised,
               const std::string &name, std::vector<double> &out) const {
    const Value *indices = find(sparse, "indices"), *values = find(sparse, "values");
    if (!indices || !values) throw Fault(name + ": its sparse part has no indices or no values");
    const std::size_t n = indexOf(sparse, "count", name);
    const std::vector<double> at = read(*indices, componentOf(*indices, name), n, 1, false, name),
                              with = read(*values, component, n, columns, normalised, name);
    for (std::size_t i = 0; i < n; ++i) {
      if (!(at[i] >= 0.0 && at[i] < static_cast<double>(out.size() / columns)))
        throw Fault(name + ": its sparse part goes beyond its elements");
      for (std::size_t k = 0; k < columns; ++k)
        out[static_cast<std::size_t>(at[i]) * columns + k] = with[i * columns + k];
    }
  }

  std::string_view bufferOf(std::size_t number) const {
    const Value &buffer = entry("buffers", number);
    const std::string name = nameOf("buffers", number);
    const Value *uri = find(buffer, "uri");
    if (!uri && number == 0 && binary_) return *binary_;
    if (!uri || !uri->IsString()) throw Fault(name + " has no content");
    if (buffers_.size() <= number) buffers_.resize(number + 1);
    std::optional<std::string> &decoded = buffers_[number];
    if (decoded) return *decoded;
    const std::string_view text(uri->GetString(), uri->GetStringLength());
    const std::size_t comma = text.find(";base64,");
    if (text.substr(0, 5) != "data:" || comma == std::string_view::npos)
      throw Fault(name + " is in another file, " + in_quotes(text) + ": only a buffer within the file is read");
    decoded = fromBase64(text.substr(comma + 8), name);
    return *decoded;
  }

  rapidjson::Document document_;
  const std::optional<std::string_view> binary_;
  mutable std::vector<std::optional<std::string>> buffers_; /* decoded */
  MeshBuilder mesh_;
};

/* ---- .glb ---- */

constexpr std::size_t WORD = 4;

std::uint32_t wordAt(std::string_view bytes, std::size_t at) {
  std::uint32_t out = 0;
  for (std::size_t i = 0; i < WORD; ++i) out |= std::uint32_t{static_cast<unsigned char>(bytes[at + i])} << (8 * i);
  return out;
}

/* A header of three words; chunks of a length, a kind, and that many bytes. */
Mesh readBinary(std::string_view bytes) {
  constexpr std::size_t HEADER = 3 * WORD, CHUNK = 2 * WORD;
  constexpr std::uint32_t JSON = 0x4e4f534a, BIN = 0x004e4942;
  if (bytes.size() < HEADER) throw Fault("the file ends within its header");
  if (wordAt(bytes, WORD) != 2)
    throw Fault("its version is " + std::to_string(wordAt(bytes, WORD)) + ": glTF 2 is read");
  if (wordAt(bytes, 2 * WORD) != bytes.size())
    throw Fault("the header promises " + count(wordAt(bytes, 2 * WORD), "byte") + ", the file has " +
                std::to_string(bytes.size()));
  std::optional<std::string_view> json, binary;
  for (std::size_t at = HEADER; at < bytes.size();) {
    const std::size_t left = bytes.size() - at, length = left < CHUNK ? 0 : wordAt(bytes, at);
    if (left < CHUNK || length > left - CHUNK) throw Fault("the file ends within a chunk");
    const std::uint32_t kind = wordAt(bytes, at + WORD);
    const std::string_view content = bytes.substr(at + CHUNK, length);
    if (!json && kind != JSON) throw Fault("its first chunk is not JSON");
    if (!json) {
      json = content;
    } else if (kind == BIN && !binary) {
      binary = content;
    }
    at += CHUNK + length;
  }
  if (!json) throw Fault("it has no chunk");
  return Gltf(*json, binary).read();
}

} // namespace

Mesh readGltf(std::string_view bytes) {
  if (bytes.substr(0, 4) == "glTF") return readBinary(bytes);
  if (bytes.substr(0, BYTE_ORDER_MARK.size()) == BYTE_ORDER_MARK) bytes.remove_prefix(BYTE_ORDER_MARK.size());
  return Gltf(bytes, std::nullopt).read();
}

} // namespace curve_proximity::mesh_reader
