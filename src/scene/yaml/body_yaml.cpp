/* SPDX-License-Identifier: BSD-3-Clause */
#include "body_yaml.h"

#include <algorithm>
#include <array>
#include <limits>

#include "bad_input.h"
#include "curve_yaml.h"

namespace curve_proximity::yaml {
namespace {

/* A triangle as shape_msgs/MeshTriangle prints it, or as a list. */
Eigen::Vector3i readTriangle(const YamlValue &value) {
  if (value.isMap()) value.refuseOthers({"vertex_indices"});
  const std::vector<YamlValue> corners = (value.isMap() ? value.at("vertex_indices") : value).items();
  if (corners.size() != 3) value.fail("a triangle has three vertex indices");
  Eigen::Vector3i out;
  for (int k = 0; k < 3; ++k) {
    const std::size_t index = corners[static_cast<std::size_t>(k)].count();
    if (index > static_cast<std::size_t>(std::numeric_limits<int>::max())) value.fail("the index is too large");
    out[k] = static_cast<int>(index);
  }
  return out;
}

/* A list of lists of N numbers, under a key that may be missing. */
template <std::size_t N>
std::vector<std::array<double, N>> readRows(const std::vector<YamlValue> &rows, const char *what) {
  std::vector<std::array<double, N>> out;
  for (const YamlValue &row : rows) {
    const std::vector<double> numbers = row.numbers();
    if (numbers.size() != N)
      row.fail(std::string(what) + " has " + std::to_string(N) + " numbers, not " + std::to_string(numbers.size()));
    out.emplace_back();
    std::copy(numbers.begin(), numbers.end(), out.back().begin());
  }
  return out;
}

/* deform: {linear: nine numbers, translation: [x, y, z], exponents: one a term}. */
void readDeformation(const YamlValue &value, ShapeDescription &shape, Warnings &warnings) {
  const std::optional<YamlValue> deform = value.find("deform");
  if (!deform) return;
  deform->warnOfOthers({"linear", "translation", "exponents"}, warnings);
  shape.deformed.emplace();
  if (const auto linear = deform->find("linear")) {
    const std::vector<double> numbers = linear->numbers();
    if (numbers.size() != 9) linear->fail("has nine numbers, row by row, not " + std::to_string(numbers.size()));
    shape.deformed->linear = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(numbers.data());
  }
  if (const auto translation = deform->find("translation")) shape.deformed->translation = translation->vector();
  if (const auto exponents = deform->find("exponents")) shape.deformed->exponents = exponents->numbers();
}

void readCurveBody(const YamlValue &value, ShapeDescription &shape, Warnings &warnings) {
  value.warnOfOthers({"type", "curve", "synchronized", "pose"}, warnings);
  shape.curve = std::make_shared<const CurveDescription>(readCurve(value.at("curve"), warnings));
  if (const auto synchronized = value.find("synchronized")) shape.synchronized = synchronized->truth();
}

void readImplicit(const YamlValue &value, ShapeDescription &shape, Warnings &warnings) {
  value.warnOfOthers({"type", "terms", "planes", "quadrics", "deform", "pose"}, warnings);
  readDeformation(value, shape, warnings);
  for (const YamlValue &hyperquadric : value.itemsOf("terms"))
    shape.hyperquadrics.push_back(readRows<5>(hyperquadric.items(), "a term [a, b, c, d, n]"));
  shape.planes = readRows<4>(value.itemsOf("planes"), "a plane [b1, b2, b3, c]");
  shape.quadrics = readRows<10>(value.itemsOf("quadrics"), "a quadric");
}

void readOctree(const YamlValue &value, ShapeDescription &shape, Warnings &warnings) {
  value.warnOfOthers({"type", "resource", "unknown_is_occupied", "pose"}, warnings);
  shape.resource = value.at("resource").text();
  if (const auto occupied = value.find("unknown_is_occupied")) shape.unknown_is_occupied = occupied->truth();
}

void readGrid(const YamlValue &value, ShapeDescription &shape, Warnings &warnings) {
  value.warnOfOthers({"type", "dimensions", "values", "pose"}, warnings);
  shape.dimensions = value.at("dimensions").numbers();
  shape.values = value.at("values").numbers();
}

/* Five dimensions [a1, a2, a3, e1, e2] are Barr's. With e1 = e2 it is a sum of three powers, where it is convex. */
void readBarr(ShapeDescription &shape) {
  constexpr std::size_t BARR = 5;
  std::vector<double> &d = shape.dimensions;
  if (d.size() != BARR) return;
  if (d[3] != d[4] || !(d[3] > 0.0 && d[3] <= 2.0)) {
    shape.type = ShapeType::SUPERELLIPSOID;
    return;
  }
  d[3] = d[4] = 2.0 / d[3];
  d.push_back(d[3]);
}

} // namespace

Eigen::Matrix3Xd readVertices(const YamlValue &value) {
  return readPoints(value, "vertices");
}

Eigen::Matrix3Xd readPoints(const YamlValue &value, const char *key) {
  const std::vector<YamlValue> items = value.itemsOf(key);
  Eigen::Matrix3Xd out(3, static_cast<Eigen::Index>(items.size()));
  for (std::size_t i = 0; i < items.size(); ++i) out.col(static_cast<Eigen::Index>(i)) = items[i].vector();
  return out;
}

void readMesh(const YamlValue &value, ShapeDescription &shape, Warnings &warnings) {
  shape.type = ShapeType::MESH;

  /* a file's name alone, or a map */
  if (value.isScalar()) {
    shape.resource = value.text();
    return;
  }
  value.warnOfOthers({"type", "vertices", "triangles", "resource", "dimensions", "scale", "solid", "pose"}, warnings);
  if (const auto resource = value.find("resource")) shape.resource = resource->text();
  if (value.find("dimensions") && value.find("scale")) value.fail("has both dimensions and a scale");
  for (const char *key : {"dimensions", "scale"}) {
    if (const auto scale = value.find(key)) shape.dimensions = scale->numbers();
  }

  if (const auto solid = value.find("solid")) shape.solid = solid->truth();
  shape.vertices = readVertices(value);
  const std::vector<YamlValue> triangles = value.itemsOf("triangles");
  shape.triangles.resize(3, static_cast<Eigen::Index>(triangles.size()));
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    shape.triangles.col(static_cast<Eigen::Index>(i)) = readTriangle(triangles[i]);
  }
  if (!shape.resource.empty() && shape.vertices.cols() > 0) value.fail("has both a resource and vertices");
  if (shape.resource.empty() && shape.vertices.cols() == 0) value.fail("has neither a resource nor vertices");
}

ShapeDescription readBody(const YamlValue &value, Warnings &warnings) {
  ShapeDescription shape;

  /* the type */
  const YamlValue type = value.at("type");
  const std::string name = type.text();
  const std::optional<ShapeType> known = shapeTypeFromName(name);
  if (!known) {
    type.fail("type '" + name + "' is unknown; it must be point, sphere, box, capsule, cylinder, cone, ellipsoid, " +
              "halfspace, polytope, polygon, mesh, points, octree, superquadric, superellipsoid, implicit, "
              "height_field, distance_grid "
              "or curve");
  }
  shape.type = *known;

  /* a mesh under its own key, or beside the type */
  if (shape.type == ShapeType::MESH) {
    const std::optional<YamlValue> mesh = value.find("mesh");
    if (mesh) value.warnOfOthers({"type", "mesh", "pose"}, warnings);
    readMesh(mesh ? *mesh : value, shape, warnings);
    return shape;
  }

  /* lists of constraints */
  if (shape.type == ShapeType::IMPLICIT) {
    readImplicit(value, shape, warnings);
    return shape;
  }

  if (shape.type == ShapeType::OCTREE) {
    readOctree(value, shape, warnings);
    return shape;
  }

  if (shape.type == ShapeType::HEIGHT_FIELD || shape.type == ShapeType::DISTANCE_GRID) {
    readGrid(value, shape, warnings);
    return shape;
  }

  if (shape.type == ShapeType::CURVE) {
    readCurveBody(value, shape, warnings);
    return shape;
  }

  /* numbers, or points */
  if (shape.type == ShapeType::POINTS && value.find("resource")) {
    value.warnOfOthers({"type", "dimensions", "resource", "pose"}, warnings);
    shape.resource = value.at("resource").text();
    if (const auto radius = value.find("dimensions")) shape.dimensions = radius->numbers();
    return shape;
  }
  value.warnOfOthers({"type", "dimensions", "vertices", "deform", "pose"}, warnings);
  readDeformation(value, shape, warnings);
  if (const auto dimensions = value.find("dimensions")) shape.dimensions = dimensions->numbers();
  if (shape.type == ShapeType::SUPERQUADRIC) readBarr(shape);
  shape.vertices = readVertices(value);
  const bool by_vertices = shape.type == ShapeType::POLYTOPE || shape.type == ShapeType::POLYGON ||
                           shape.type == ShapeType::POINT || shape.type == ShapeType::POINTS;
  if (!by_vertices && shape.vertices.cols() > 0) value.fail("a " + name + " has dimensions, not vertices");
  return shape;
}

} // namespace curve_proximity::yaml
