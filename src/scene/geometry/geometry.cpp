/* SPDX-License-Identifier: BSD-3-Clause */
#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <filesystem>

#include <curve_proximity/geometry.hpp>

#include "mesh.h"
#include "octree.h"
#include "superellipsoid.h"

namespace curve_proximity {
namespace {

/* What a type expects in `dimensions`: how many, what they are called, and from which value on; `optional`: or none at
 * all. */
struct Expected {
  std::size_t n;
  const char *names;
  enum Range { ANY, NOT_NEGATIVE, POSITIVE } range = POSITIVE;
  bool optional = false;
};

Expected expectedDimensions(ShapeType type) {
  switch (type) {
    case ShapeType::SPHERE: return {1, "[radius]"};
    case ShapeType::BOX: return {3, "[x, y, z]"};
    case ShapeType::CAPSULE:
    case ShapeType::CYLINDER:
    case ShapeType::CONE: return {2, "[height, radius]"};
    case ShapeType::ELLIPSOID: return {3, "[x, y, z] (semi-axes)"};
    case ShapeType::HALFSPACE: return {4, "[a, b, c, d]", Expected::ANY};
    case ShapeType::SUPERQUADRIC: return {6, "[a1, a2, a3, n1, n2, n3]"};
    case ShapeType::SUPERELLIPSOID: return {5, "[a1, a2, a3, e1, e2]"};
    case ShapeType::MESH: return {3, "[x, y, z] (the scale)", Expected::ANY, true};
    case ShapeType::POINTS: return {1, "[radius]", Expected::NOT_NEGATIVE, true};
    case ShapeType::POINT:
    case ShapeType::POLYTOPE:
    case ShapeType::POLYGON:
    case ShapeType::IMPLICIT:
    case ShapeType::OCTREE:
    case ShapeType::HEIGHT_FIELD:
    case ShapeType::CURVE:
    case ShapeType::DISTANCE_GRID: break;
  }
  return {0, ""};
}

std::string number(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%g", x);
  return text;
}

bool isGrid(ShapeType type) {
  return type == ShapeType::HEIGHT_FIELD || type == ShapeType::DISTANCE_GRID;
}

/* The counts of a grid are whole numbers, and there is a value for each point. */
void checkGrid(const ShapeDescription &shape) {
  const std::string name = shapeTypeName(shape.type);
  const bool heights = shape.type == ShapeType::HEIGHT_FIELD;
  const std::string names = heights ? "[cell_x, cell_y, n_x, n_y] or with a floor"
                                    : "[cell, n_x, n_y, n_z], or with an error, and where values are truncated";
  const std::size_t n = shape.dimensions.size(), most = heights ? 5 : 6, first = heights ? 2 : 1;
  if (n < 4 || n > most) throw Error(name + " needs dimensions " + names + ", got " + std::to_string(n));
  double points = 1.0;
  for (std::size_t i = first; i < 4; ++i) {
    const double count = shape.dimensions[i];
    if (!(count >= 2.0 && count <= 1e9 && count == std::floor(count)))
      throw Error(name + " dimension " + std::to_string(i) + " of " + names + " is " + number(count) +
                  ": it must be a whole number from 2 on");
    points *= count;
  }
  if (points != static_cast<double>(shape.values.size()))
    throw Error(name + " has " + std::to_string(shape.values.size()) + " values, but " + number(points) + " points");
  if (heights && n == 5 && !std::isfinite(shape.dimensions[4]))
    throw Error(name + " has a floor of " + number(shape.dimensions[4]) + ": it must be finite");
}

void checkDimensions(const ShapeDescription &shape) {
  if (isGrid(shape.type)) return checkGrid(shape);
  if (!shape.values.empty()) throw Error(std::string(shapeTypeName(shape.type)) + " takes no values");
  const std::string name = shapeTypeName(shape.type);
  const Expected expected = expectedDimensions(shape.type);
  const std::size_t n = shape.dimensions.size();

  if (n != expected.n && !(expected.optional && n == 0)) {
    const std::string wanted = expected.n == 0   ? "no dimensions"
                               : expected.n == 1 ? "1 dimension "
                                                 : std::to_string(expected.n) + " dimensions ";
    throw Error(name + " needs " + (expected.optional ? "none or " : "") + wanted + expected.names + ", got " +
                std::to_string(n));
  }

  for (std::size_t i = 0; i < n; ++i) {
    const double x = shape.dimensions[i];
    const bool large =
        expected.range == Expected::ANY || x > 0.0 || (expected.range == Expected::NOT_NEGATIVE && x == 0.0);
    if (std::isfinite(x) && large) continue;
    const char *range = expected.range == Expected::POSITIVE       ? " and above 0"
                        : expected.range == Expected::NOT_NEGATIVE ? " and not below 0"
                                                                   : "";
    throw Error(name + " dimension " + std::to_string(i) + " of " + expected.names + " is " + number(x) +
                ": it must be finite" + range);
  }
}

void checkVertices(const ShapeDescription &shape) {
  const std::string name = shapeTypeName(shape.type);
  const Eigen::Index n = shape.vertices.cols();
  for (Eigen::Index i = 0; i < n; ++i) {
    if (!shape.vertices.col(i).allFinite()) throw Error(name + " vertex " + std::to_string(i) + " is not finite");
  }

  // Which types have vertices, and what else belongs to a mesh alone.
  const bool mesh = shape.type == ShapeType::MESH, octree = shape.type == ShapeType::OCTREE;
  const bool polygon = shape.type == ShapeType::POLYGON;
  const bool points = polygon || shape.type == ShapeType::POLYTOPE || shape.type == ShapeType::POINTS;
  for (Eigen::Index i = 0; polygon && i < n; ++i) {
    if (shape.vertices(2, i) != 0.0) {
      throw Error("polygon vertex " + std::to_string(i) + " has z = " + number(shape.vertices(2, i)) +
                  ": a polygon lies in the plane z = 0 of its frame, and its pose may move that");
    }
  }
  if (shape.type == ShapeType::POINT && n > 1) throw Error("point needs at most 1 vertex, got " + std::to_string(n));
  if (points && n == 0) throw Error(name + " has no vertices");
  if (shape.type != ShapeType::POINT && !points && !mesh && n > 0) {
    throw Error(name + " takes no vertices, got " + std::to_string(n));
  }
  if (!mesh && shape.triangles.cols() > 0) throw Error(name + " takes no triangles");
  if (!mesh && !octree && !shape.resource.empty()) throw Error(name + " takes no file, got '" + shape.resource + "'");
  if (!mesh && shape.solid) throw Error(name + " is not asked whether it is solid: meshes are");
  if (!octree && !shape.octree.data.empty()) throw Error(name + " takes no octree");
  if (octree && !shape.resource.empty() && !shape.octree.data.empty())
    throw Error("octree '" + shape.resource + "' has bytes beside the file: give one of the two");
  const bool tree_without_nodes = !shape.octree.id.empty() && shape.octree.resolution > 0.0;
  if (octree && shape.resource.empty() && shape.octree.data.empty() && !tree_without_nodes)
    throw Error("octree has neither a file nor bytes");
  if (mesh && !shape.resource.empty() && (n > 0 || shape.triangles.cols() > 0)) {
    throw Error("mesh '" + shape.resource + "' has vertices or triangles beside the file: give one of the two");
  }
}

void checkConstraints(const ShapeDescription &shape) {
  const bool any = !shape.hyperquadrics.empty() || !shape.planes.empty() || !shape.quadrics.empty();
  if (shape.type == ShapeType::IMPLICIT && !any) throw Error("implicit has no terms, planes or quadrics");
  if (shape.type != ShapeType::IMPLICIT && any)
    throw Error(std::string(shapeTypeName(shape.type)) + " takes no terms, planes or quadrics");
}

Geometry makeMeshShape(const ShapeDescription &shape, const ResourceOptions &options, const MeshLoader &loader) {
  const Eigen::Vector3d scale = meshScale(shape);
  if (shape.resource.empty()) {
    return makeMeshGeometry({shape.vertices, shape.triangles}, scale, shape.solid, options);
  }
  return loader({shape.resource, resolveResource(shape.resource, options), scale, shape.solid});
}

/* Says of which file it speaks, where there is one. */
template <class Work>
auto ofOctree(const ShapeDescription &shape, Work work) -> decltype(work()) {
  try {
    return work();
  } catch (const Error &error) {
    if (shape.resource.empty()) throw;
    throw Error("octree '" + shape.resource + "': " + error.what(), error.status());
  }
}

BodyHandle makeCells(const ShapeDescription &shape, const ResourceOptions &options) {
  const Boxes cells = octreeBoxes(shape, options);
  if (cells.low.cols() == 0) return {};
  return ofOctree(shape, [&] { return makeBoxes(cells.low, cells.high, options.memory_limit, options.stop); });
}

std::size_t count(double dimension) {
  return static_cast<std::size_t>(dimension);
}

BodyHandle makeDistances(const ShapeDescription &shape, const ResourceOptions &options) {
  const std::vector<double> &d = shape.dimensions;
  if (shape.values.size() > options.memory_limit / sizeof(double))
    throw Error(std::to_string(shape.values.size()) + " distances are above the limit of memory", CPROX_MEMORY);
  return makeDistanceGrid({count(d[1]), count(d[2]), count(d[3])}, d[0], shape.values, d.size() > 4 ? d[4] : 0.0,
                          d.size() > 5 ? d[5] : std::numeric_limits<double>::infinity());
}

/* The ground's box stands for it where that is enough. */
Geometry makeGround(const ShapeDescription &shape, const ResourceOptions &options) {
  const std::vector<double> &d = shape.dimensions;
  const double floor = d.size() > 4 ? d[4] : std::numeric_limits<double>::quiet_NaN();
  const BodyHandle mesh = makeHeightField({count(d[2]), count(d[3])}, {d[0], d[1]}, shape.values, floor,
                                          options.memory_limit, options.stop);
  const auto range = std::minmax_element(shape.values.begin(), shape.values.end());
  const double low = d.size() > 4 ? floor : *range.first;
  const Eigen::AlignedBox3d box(Eigen::Vector3d(0.0, 0.0, low),
                                Eigen::Vector3d(d[0] * (d[2] - 1.0), d[1] * (d[3] - 1.0), *range.second));
  Eigen::Matrix3Xd corners(3, 8);
  for (int i = 0; i < 8; ++i) corners.col(i) = box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(i));
  Geometry out;
  out.hull = makePolytope(corners);
  out.body = makeLod(out.hull, 0.0, mesh);
  out.surface = d.size() > 4 ? makeLod(out.hull, 0.0, makeSurface(mesh)) : out.body;
  out.is_mesh = true;
  return out;
}

BodyHandle makeBody(const ShapeDescription &shape, const ResourceOptions &options) {
  const std::vector<double> &d = shape.dimensions;
  switch (shape.type) {
    case ShapeType::POINT:
      return makePoint(shape.vertices.cols() ? Eigen::Vector3d(shape.vertices.col(0)) : Eigen::Vector3d::Zero());
    case ShapeType::SPHERE: return makeSphere(d[0]);
    case ShapeType::BOX: return makeBox({d[0], d[1], d[2]});
    case ShapeType::CAPSULE: return makeCapsule(d[0], d[1]);
    case ShapeType::CYLINDER: return makeCylinder(d[0], d[1]);
    case ShapeType::CONE: return makeCone(d[0], d[1]);
    case ShapeType::ELLIPSOID: return makeEllipsoid({d[0], d[1], d[2]});
    case ShapeType::HALFSPACE: return makeHalfspace({d[0], d[1], d[2]}, d[3]);
    case ShapeType::POLYTOPE: return makePolytope(shape.vertices);
    case ShapeType::POLYGON: return makePolygon(shape.vertices.topRows<2>());
    case ShapeType::SUPERQUADRIC: return makeSuperquadric({d[0], d[1], d[2]}, {d[3], d[4], d[5]});
    case ShapeType::SUPERELLIPSOID: return makeSuperellipsoid({d[0], d[1], d[2]}, {d[3], d[4]});
    case ShapeType::IMPLICIT: return makeImplicit(shape.hyperquadrics, shape.planes, shape.quadrics);
    case ShapeType::POINTS:
      return makePoints(shape.vertices, d.empty() ? 0.0 : d[0], options.memory_limit, options.stop);
    case ShapeType::OCTREE: return makeCells(shape, options);
    case ShapeType::DISTANCE_GRID: return makeDistances(shape, options);
    case ShapeType::CURVE:
    case ShapeType::HEIGHT_FIELD:
    case ShapeType::MESH: break;
  }
  throw Error("a shape's type is not known");
}

Geometry makeCurveGeometry(const ShapeDescription &shape) {
  if (!shape.curve) throw Error("curve: there is none");
  if (!shape.curve->radius_polynomial.empty() && !shape.synchronized)
    throw Error("curve: its radius changes, so it must be synchronized");
  try {
    const CompiledCurve curve = compile(*shape.curve, CurveBoxes::NONE);
    Geometry out;
    out.curve = curve.curve;
    out.radius_curve = curve.radius_curve;
    out.radius = curve.radius;
    out.synchronized = shape.synchronized;
    return out;
  } catch (const Error &error) {
    throw Error(std::string("curve: ") + error.what(), error.status());
  }
}

/* The image of the body under x -> A x + b. */
BodyHandle deform(const BodyHandle &body, const ShapeDescription &shape) {
  const ShapeDeformation &by = *shape.deformed;
  try {
    return makeDeformed(body, by.linear, by.translation, by.exponents);
  } catch (const Error &error) {
    throw Error(std::string(shapeTypeName(shape.type)) + ", deformed: " + error.what(), error.status());
  }
}

bool startsWith(const std::string &text, const std::string &start) {
  return text.compare(0, start.size(), start) == 0;
}

/* %41 is A, as URIs have it. */
std::string decodePercent(const std::string &text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool code = text[i] == '%' && i + 2 < text.size() && std::isxdigit(static_cast<unsigned char>(text[i + 1])) &&
                      std::isxdigit(static_cast<unsigned char>(text[i + 2]));
    out += code ? static_cast<char>(std::stoi(text.substr(i + 1, 2), nullptr, 16)) : text[i];
    if (code) i += 2;
  }
  return out;
}

/* The path that a URI means, whether it is there or not. */
std::string pathOf(const std::string &uri, const ResourceOptions &options, const std::string &what) {
  const std::string who = what + " '" + uri + "': ";
  if (startsWith(uri, "package://")) {
    const std::string rest = uri.substr(10);
    const std::size_t slash = rest.find('/');
    const std::string package = rest.substr(0, slash);
    if (package.empty() || slash == std::string::npos) throw Error(who + "package://NAME/path is wanted");
    if (!options.find_package) throw Error(who + "there is nowhere to look for package '" + package + "'");
    const std::string folder = options.find_package(package);
    if (folder.empty()) throw Error(who + "package '" + package + "' was not found");
    return folder + rest.substr(slash);
  }
  if (startsWith(uri, "file://")) {
    const std::string rest = decodePercent(uri.substr(startsWith(uri, "file://localhost/") ? 16 : 7));
    if (!startsWith(rest, "/")) throw Error(who + "file:// needs an absolute path (three slashes)");
    return rest;
  }
  const std::size_t scheme = uri.find("://");
  if (scheme != std::string::npos) {
    throw Error(who + uri.substr(0, scheme) + ":// is not fetched: give package://, file:// or a path");
  }
  if (startsWith(uri, "/")) return uri;
  if (options.base_dir.empty()) throw Error(who + "the path is relative, and there is no folder it is relative to");
  return options.base_dir + "/" + uri;
}

} // namespace

std::string resolveResource(const std::string &uri, const ResourceOptions &options, const std::string &what) {
  if (uri.empty()) throw Error(what + " without a file name");
  const std::string path = pathOf(uri, options, what), who = what + " '" + uri + "': '";

  // There, a file, and not empty.
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) throw Error(what + " '" + uri + "': there is no file '" + path + "'");
  if (!std::filesystem::is_regular_file(status)) throw Error(who + path + "' is no regular file");
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  if (error || size == 0) throw Error(who + path + "' is empty");
  return path;
}

Boxes octreeBoxes(const ShapeDescription &shape, const ResourceOptions &options) {
  const OctreeData octree =
      shape.resource.empty() ? shape.octree : readOctree(resolveResource(shape.resource, options, "octree"));
  return ofOctree(shape, [&] { return cellBoxes(octree, shape.unknown_is_occupied, options.memory_limit); });
}

Eigen::Vector3d meshScale(const ShapeDescription &shape) {
  if (shape.dimensions.empty()) return Eigen::Vector3d::Ones();
  return Eigen::Map<const Eigen::Vector3d>(shape.dimensions.data());
}

std::string userCacheDir() {
  const auto variable = [](const char *name) {
    const char *text = std::getenv(name);
    return std::string(text && text[0] == '/' ? text : ""); /* relative ones are to be ignored: XDG */
  };
  const std::string xdg = variable("XDG_CACHE_HOME"), home = variable("HOME");
  if (!xdg.empty()) return xdg + "/curve_proximity/meshes";
  return home.empty() ? "" : home + "/.cache/curve_proximity/meshes";
}

Geometry makeGeometry(const ShapeDescription &shape, const ResourceOptions &options, const MeshLoader &loader) {
  if (shape.made) return *shape.made;
  checkDimensions(shape);
  checkVertices(shape);
  checkConstraints(shape);
  if (shape.type != ShapeType::CURVE && (shape.curve || shape.synchronized))
    throw Error(std::string(shapeTypeName(shape.type)) + " takes no curve, and is not synchronized");
  if (shape.deformed && shape.type != ShapeType::SUPERQUADRIC && shape.type != ShapeType::IMPLICIT)
    throw Error(std::string(shapeTypeName(shape.type)) + " cannot be deformed: superquadrics and implicit bodies can");
  if (shape.type == ShapeType::MESH) return makeMeshShape(shape, options, loader);
  if (shape.type == ShapeType::HEIGHT_FIELD) return makeGround(shape, options);
  if (shape.type == ShapeType::CURVE) return makeCurveGeometry(shape);
  Geometry out;
  out.body = makeBody(shape, options);
  if (shape.deformed) out.body = deform(out.body, shape);
  out.hull = out.surface = out.body;
  return out;
}

Geometry makeGeometry(const ShapeDescription &shape, const ResourceOptions &options) {
  return makeGeometry(shape, options, [&](const MeshRequest &request) { return loadMeshGeometry(request, options); });
}

} // namespace curve_proximity
