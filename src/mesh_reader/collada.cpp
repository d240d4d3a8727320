/* SPDX-License-Identifier: BSD-3-Clause */
/* Collada. <scene> names a <visual_scene>; its <node>s have a pose each, as a product of elementary maps, nodes below,
 * and instances of geometries and of other nodes. A <mesh> has <source>s of numbers, <vertices> that name the one of
 * the positions, and lists of polygons whose indices stand in <p>. */
#include <tinyxml2.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <unordered_map>
#include <vector>

#include "formats.h"
#include "pose.h"
#include "text.h"

namespace curve_proximity::mesh_reader {
namespace {

using tinyxml2::XMLElement;

/* Nodes in nodes: a scene that contains itself has no end. */
constexpr int DEEPEST = 200;

std::string_view nameOf(const XMLElement &element) {
  return element.Name();
}

[[noreturn]] void fail(const XMLElement &element, const std::string &what) {
  throw Fault("line " + std::to_string(element.GetLineNum()) + ": " + what);
}

std::string tag(const XMLElement &element) {
  return "<" + std::string(nameOf(element).substr(0, 40)) + ">";
}

const XMLElement &childOf(const XMLElement &element, const char *name) {
  const XMLElement *out = element.FirstChildElement(name);
  if (!out) fail(element, tag(element) + " has no <" + name + ">");
  return *out;
}

template <class Take>
void forEachNumber(const XMLElement &element, Take take) {
  Words words(element.GetText() ? element.GetText() : "");
  for (std::string_view word = words.next(); !word.empty(); word = words.next()) take(word);
}

std::vector<double> numbersOf(const XMLElement &element) {
  std::vector<double> out;
  forEachNumber(element, [&](std::string_view word) {
    const std::optional<double> x = parseNumber(word);
    if (!x || !std::isfinite(*x)) fail(element, in_quotes(word) + " in " + tag(element) + " is no finite number");
    out.push_back(*x);
  });
  return out;
}

std::vector<std::uint32_t> indicesOf(const XMLElement &element) {
  std::vector<std::uint32_t> out;
  forEachNumber(element, [&](std::string_view word) {
    const std::optional<std::int64_t> x = parseInteger(word);
    if (!x || *x < 0 || *x > std::numeric_limits<std::int32_t>::max())
      fail(element, in_quotes(word) + " in " + tag(element) + " is no index");
    out.push_back(static_cast<std::uint32_t>(*x));
  });
  return out;
}

/* An attribute that is a number from 0 on. */
std::size_t countOf(const XMLElement &element, const char *name, std::size_t otherwise) {
  const char *text = element.Attribute(name);
  if (!text) return otherwise;
  const std::optional<std::int64_t> out = parseInteger(text);
  if (!out || *out < 0) fail(element, in_quotes(text) + " is no " + name + " of " + tag(element));
  return static_cast<std::size_t>(*out);
}

/* ---- poses ---- */

Pose rotation(const Point &axis, double degrees) {
  const double length = std::hypot(std::hypot(axis[0], axis[1]), axis[2]);
  if (!(length > 0.0)) return {};
  // Exact at quarter turns, which sin and cos of radians are not.
  const double quarters = degrees / 90.0, rest = std::remainder(quarters, 1.0) * M_PI / 2.0;
  const double s0 = std::sin(rest), c0 = std::cos(rest);
  const int turns = static_cast<int>(std::fmod(std::nearbyint(quarters), 4.0)) & 3;
  const double s = turns == 0   ? s0
                   : turns == 1 ? c0
                   : turns == 2 ? -s0
                                : -c0,
               c = turns == 0   ? c0
                   : turns == 1 ? -s0
                   : turns == 2 ? -c0
                                : s0;
  const double x = axis[0] / length, y = axis[1] / length, z = axis[2] / length, k = 1.0 - c;
  return {{{{x * x * k + c, x * y * k - z * s, x * z * k + y * s, 0.0},
            {y * x * k + z * s, y * y * k + c, y * z * k - x * s, 0.0},
            {z * x * k - y * s, z * y * k + x * s, z * z * k + c, 0.0}}}};
}

/* What an element of a node does to what comes after it; false where it is none of these maps. */
bool poseOf(const XMLElement &element, Pose &out) {
  struct Map {
    std::string_view name;
    std::size_t numbers;
  };
  constexpr Map MAPS[] = {{"matrix", 16}, {"translate", 3}, {"scale", 3}, {"rotate", 4}};
  const std::string_view name = nameOf(element);
  if (name == "lookat" || name == "skew") fail(element, tag(element) + " is not read");
  for (const Map &map : MAPS) {
    if (name != map.name) continue;
    const std::vector<double> x = numbersOf(element);
    if (x.size() != map.numbers)
      fail(element,
           tag(element) + " has " + std::to_string(x.size()) + " of " + std::to_string(map.numbers) + " numbers");
    if (name == "translate") out = Pose::translation(x[0], x[1], x[2]);
    if (name == "scale") out = Pose::scaling(x[0], x[1], x[2]);
    if (name == "rotate") out = rotation({x[0], x[1], x[2]}, x[3]);
    if (name != "matrix") return true;
    if (x[12] != 0.0 || x[13] != 0.0 || x[14] != 0.0 || x[15] != 1.0)
      fail(element, "the last row of <matrix> is not 0 0 0 1");
    for (std::size_t i = 0; i < 12; ++i) out.rows[i / 4][i % 4] = x[i];
    return true;
  }
  return false;
}

/* ---- the document ---- */

class Collada {
 public:
  explicit Collada(const XMLElement &root) : root_(root) {
    if (nameOf(root) != "COLLADA") fail(root, "a Collada document begins with <COLLADA>, not with " + tag(root));
    readUnit();
    index(root);
  }

  Mesh read() {
    const XMLElement &instance = childOf(childOf(root_, "scene"), "instance_visual_scene");
    const XMLElement &scene = target(instance, "url", "visual_scene");
    readChildren(scene, Pose::scaling(unit_, unit_, unit_), 0);
    Mesh out = mesh_.finish();
    if (unit_ == 1.0) return out;
    const std::string remark = "its unit is " + in_quotes(unit_text_) + " m: its coordinates are multiplied by that";
    out.remark = out.remark.empty() ? remark : remark + "; " + out.remark;
    return out;
  }

 private:
  void readUnit() {
    const XMLElement *asset = root_.FirstChildElement("asset");
    const XMLElement *unit = asset ? asset->FirstChildElement("unit") : nullptr;
    unit_element_ = unit;
    if (!unit || !unit->Attribute("meter")) return;
    unit_text_ = unit->Attribute("meter");
    Words words(unit_text_);
    const std::optional<double> metres = parseNumber(words.next());
    if (!metres || !(*metres > 0.0) || !std::isfinite(*metres))
      fail(*unit, in_quotes(unit_text_) + " is no unit: a number of metres above 0 is expected");
    unit_ = *metres;
  }

  /* All that has an id. Another unit than the document's has no place in one mesh. */
  void index(const XMLElement &element) {
    for (const XMLElement *e = element.FirstChildElement(); e; e = e->NextSiblingElement()) {
      if (const char *id = e->Attribute("id")) {
        if (!by_id_.emplace(id, e).second) twice_.emplace(id, e);
      }
      const char *metres = nameOf(*e) == "unit" && nameOf(element) == "asset" ? e->Attribute("meter") : nullptr;
      if (metres && e != unit_element_) {
        const std::optional<double> other = parseNumber(metres);
        if (!other || *other != unit_) fail(*e, "a second unit, " + in_quotes(metres) + ", is not read");
      }
      index(*e);
    }
  }

  /* What an attribute `#id` names. */
  const XMLElement &target(const XMLElement &from, const char *attribute, const char *kind) const {
    const char *url = from.Attribute(attribute);
    if (!url) fail(from, tag(from) + " has no " + attribute);
    if (url[0] != '#') fail(from, tag(from) + " names " + in_quotes(url) + ": other files are not read");
    const auto found = by_id_.find(url + 1);
    if (found == by_id_.end() || nameOf(*found->second) != kind)
      fail(from, tag(from) + " names " + in_quotes(url) + ", but there is no such <" + kind + ">");
    if (twice_.count(url + 1)) fail(*twice_.at(url + 1), "the id " + in_quotes(url + 1) + " stands twice");
    return *found->second;
  }

  void readChildren(const XMLElement &parent, Pose pose, int depth) {
    if (depth > DEEPEST) fail(parent, "more than " + std::to_string(DEEPEST) + " nodes in each other");
    for (const XMLElement *e = parent.FirstChildElement(); e; e = e->NextSiblingElement()) {
      Pose map;
      if (poseOf(*e, map)) {
        pose = pose * map;
      } else if (nameOf(*e) == "node") {
        readChildren(*e, pose, depth + 1);
      } else if (nameOf(*e) == "instance_node") {
        readChildren(target(*e, "url", "node"), pose, depth + 1);
      } else if (nameOf(*e) == "instance_geometry") {
        readGeometry(target(*e, "url", "geometry"), pose);
      } else if (nameOf(*e) == "instance_controller") {
        fail(*e, "skinned and morphed meshes (<instance_controller>) are not read");
      }
    }
  }

  void readGeometry(const XMLElement &geometry, const Pose &pose) {
    for (const XMLElement *e = geometry.FirstChildElement(); e; e = e->NextSiblingElement()) {
      if (nameOf(*e) == "mesh") {
        readMesh(*e, pose);
      } else if (nameOf(*e) == "convex_mesh" || nameOf(*e) == "spline" || nameOf(*e) == "brep") {
        fail(*e, tag(*e) + " is not read: a <mesh> is");
      }
    }
  }

  void readMesh(const XMLElement &mesh, const Pose &pose) {
    const std::size_t first = mesh_.positions();
    bool read = false;
    for (const XMLElement *e = mesh.FirstChildElement(); e; e = e->NextSiblingElement()) {
      const std::string_view name = nameOf(*e);
      const bool polygons = name == "triangles" || name == "polylist" || name == "polygons",
                 strips = name == "tristrips" || name == "trifans";
      if (!polygons && !strips) continue;
      const std::size_t stride = strideOf(*e);
      if (stride == 0) { // without <input>
        if (countOf(*e, "count", 0) > 0 || e->FirstChildElement("p")) fail(*e, tag(*e) + " has no input VERTEX");
        continue;
      }
      if (!read) readPositions(mesh, pose);
      read = true;
      const Corners corners{stride, vertexOffset(*e), first, mesh_.positions() - first, pose.mirrors()};
      strips ? readStrips(*e, corners) : readPolygons(*e, corners);
    }
  }

  /* ---- positions ---- */

  static const XMLElement *inputOf(const XMLElement &element, std::string_view semantic) {
    for (const XMLElement *e = element.FirstChildElement("input"); e; e = e->NextSiblingElement("input"))
      if (e->Attribute("semantic") && semantic == e->Attribute("semantic")) return e;
    return nullptr;
  }

  void readPositions(const XMLElement &mesh, const Pose &pose) {
    const XMLElement &vertices = childOf(mesh, "vertices");
    const XMLElement *input = inputOf(vertices, "POSITION");
    if (!input) fail(vertices, "<vertices> has no input POSITION");
    const XMLElement &source = target(*input, "source", "source");
    const XMLElement &accessor = childOf(childOf(source, "technique_common"), "accessor");
    const std::vector<double> numbers = arrayOf(target(accessor, "source", "float_array"));
    const std::size_t n = countOf(accessor, "count", 0), stride = countOf(accessor, "stride", 1),
                      offset = countOf(accessor, "offset", 0);
    const std::array<std::size_t, 3> axes = axesOf(accessor);
    const std::size_t last = std::max(axes[0], std::max(axes[1], axes[2]));
    if (n > 0 && (stride <= last || stride > numbers.size() || n > numbers.size() / stride + 1 ||
                  offset > numbers.size() || offset + (n - 1) * stride + last >= numbers.size()))
      fail(accessor, "the accessor of " + count(n, "position") + " goes beyond its " + std::to_string(numbers.size()) +
                         " numbers");
    for (std::size_t i = 0; i < n; ++i) {
      const double *at = numbers.data() + offset + i * stride;
      const Point p = pose({at[axes[0]], at[axes[1]], at[axes[2]]});
      if (!std::isfinite(p[0]) || !std::isfinite(p[1]) || !std::isfinite(p[2]))
        fail(accessor, "position " + std::to_string(i) + " is not finite at its pose");
      mesh_.add(p);
    }
  }

  static std::vector<double> arrayOf(const XMLElement &array) {
    std::vector<double> out = numbersOf(array);
    const char *promised = array.Attribute("count");
    if (!promised || countOf(array, "count", 0) != out.size())
      fail(array, "a float_array promises " + in_quotes(promised ? promised : "") + " numbers and has " +
                      std::to_string(out.size()));
    return out;
  }

  /* Where x, y and z stand among the numbers of a position: by the names of the parameters, or in their order. */
  static std::array<std::size_t, 3> axesOf(const XMLElement &accessor) {
    std::array<std::size_t, 3> out{0, 1, 2};
    std::size_t at = 0, named = 0;
    for (const XMLElement *e = accessor.FirstChildElement("param"); e; e = e->NextSiblingElement("param"), ++at) {
      const std::string_view name = e->Attribute("name") ? e->Attribute("name") : "";
      if (name.size() != 1 || name[0] < 'X' || name[0] > 'Z') continue;
      out[static_cast<std::size_t>(name[0] - 'X')] = at;
      ++named;
    }
    if (named != 3 && named != 0) fail(accessor, "the accessor of positions has not the parameters X, Y and Z");
    return out;
  }

  /* ---- polygons ---- */

  /* How the indices of a list name vertices: those of the mesh begin at `first`. */
  struct Corners {
    std::size_t stride, offset, first, positions;
    bool turned;
  };

  static std::size_t strideOf(const XMLElement &list) {
    std::size_t out = 0;
    for (const XMLElement *e = list.FirstChildElement("input"); e; e = e->NextSiblingElement("input"))
      out = std::max(out, countOf(*e, "offset", 0) + 1);
    return out;
  }

  static std::size_t vertexOffset(const XMLElement &list) {
    const XMLElement *input = inputOf(list, "VERTEX");
    if (!input) fail(list, tag(list) + " has no input VERTEX");
    return countOf(*input, "offset", 0);
  }

  /* The vertices that a <p> names. */
  std::vector<std::uint32_t> cornersOf(const XMLElement &p, const Corners &corners) const {
    const std::vector<std::uint32_t> indices = indicesOf(p);
    if (indices.size() % corners.stride != 0)
      fail(p, std::to_string(indices.size()) + " indices in <p> are no multiple of " + std::to_string(corners.stride));
    std::vector<std::uint32_t> out;
    for (std::size_t i = corners.offset; i < indices.size(); i += corners.stride) {
      if (indices[i] >= corners.positions)
        fail(p,
             "it uses vertex " + std::to_string(indices[i]) + ", but there are " + std::to_string(corners.positions));
      out.push_back(static_cast<std::uint32_t>(corners.first) + indices[i]);
    }
    return out;
  }

  void addPolygon(const std::uint32_t *corners, std::size_t n, bool turned) {
    polygon_.assign(corners, corners + n);
    if (turned) std::reverse(polygon_.begin(), polygon_.end());
    mesh_.addPolygon(polygon_);
  }

  void readPolygons(const XMLElement &list, const Corners &corners) {
    const bool each = nameOf(list) == "polygons";
    std::size_t made = 0;
    if (list.FirstChildElement("ph")) fail(list, "polygons with holes (<ph>) are not read");
    for (const XMLElement *p = list.FirstChildElement("p"); p; p = p->NextSiblingElement("p")) {
      const std::vector<std::uint32_t> all = cornersOf(*p, corners);
      if (each) {
        addPolygon(all.data(), all.size(), corners.turned);
        ++made;
        continue;
      }
      if (p != list.FirstChildElement("p")) fail(*p, "a second <p> in " + tag(list));
      const XMLElement *sizes = list.FirstChildElement("vcount");
      if (!sizes && nameOf(list) == "polylist") fail(list, "<polylist> has no <vcount>");
      std::size_t at = 0;
      const auto next = [&](std::size_t n) {
        if (all.size() - at < n) fail(*p, "<p> ends within polygon " + std::to_string(made + 1));
        addPolygon(all.data() + at, n, corners.turned);
        at += n;
        ++made;
      };
      if (sizes) {
        for (const std::uint32_t n : indicesOf(*sizes)) next(n);
      } else {
        while (at < all.size()) next(3);
      }
      if (at < all.size()) fail(*p, "<p> has more indices than its polygons have corners");
    }
    const std::size_t promised = countOf(list, "count", made);
    if (promised != made)
      fail(list, tag(list) + " promises " + count(promised, "polygon") + " and has " + std::to_string(made));
  }

  void readStrips(const XMLElement &list, const Corners &corners) {
    const bool fan = nameOf(list) == "trifans";
    std::size_t made = 0;
    for (const XMLElement *p = list.FirstChildElement("p"); p; p = p->NextSiblingElement("p"), ++made) {
      const std::vector<std::uint32_t> all = cornersOf(*p, corners);
      for (std::size_t k = 2; k < all.size(); ++k) {
        const bool swap = (!fan && k % 2 == 1) != corners.turned;
        const std::uint32_t a = fan ? all[0] : all[k - 2], b = all[k - 1];
        mesh_.addTriangle(swap ? b : a, swap ? a : b, all[k]);
      }
    }
    const std::size_t promised = countOf(list, "count", made);
    if (promised != made)
      fail(list, tag(list) + " promises " + count(promised, "strip") + " and has " + std::to_string(made));
  }

  const XMLElement &root_;
  const XMLElement *unit_element_ = nullptr;
  double unit_ = 1.0; /* [m] */
  std::string unit_text_;
  std::unordered_map<std::string, const XMLElement *> by_id_, twice_;
  MeshBuilder mesh_;
  std::vector<std::uint32_t> polygon_;
};

} // namespace

Mesh readCollada(std::string_view bytes) {
  tinyxml2::XMLDocument document;
  if (document.Parse(bytes.data(), bytes.size()) != tinyxml2::XML_SUCCESS)
    throw Fault("its XML is wrong in line " + std::to_string(document.ErrorLineNum()));
  const XMLElement *root = document.RootElement();
  if (!root) throw Fault("its XML has no element");
  return Collada(*root).read();
}

} // namespace curve_proximity::mesh_reader
