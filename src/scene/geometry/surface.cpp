/* SPDX-License-Identifier: BSD-3-Clause */
#include "surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <vector>

#include "mesh.h"

namespace curve_proximity {
namespace {

using Point = std::array<double, 3>;

/* Gathers triangles by their corners; equal corners become one vertex, and triangles of fewer than three are left out.
 */
class Sheet {
 public:
  void add(const Eigen::Vector3d &a, const Eigen::Vector3d &b, const Eigen::Vector3d &c) {
    const std::array<int, 3> corners{vertex(a), vertex(b), vertex(c)};
    if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0]) return;
    triangles_.push_back(corners);
  }

  void addQuad(const Eigen::Vector3d &a, const Eigen::Vector3d &b, const Eigen::Vector3d &c, const Eigen::Vector3d &d) {
    add(a, b, c);
    add(a, c, d);
  }

  void addBox(const Eigen::Vector3d &low, const Eigen::Vector3d &high) {
    const auto corner = [&](int x, int y, int z) {
      return Eigen::Vector3d(x ? high.x() : low.x(), y ? high.y() : low.y(), z ? high.z() : low.z());
    };
    addQuad(corner(0, 0, 0), corner(0, 1, 0), corner(1, 1, 0), corner(1, 0, 0));
    addQuad(corner(0, 0, 1), corner(1, 0, 1), corner(1, 1, 1), corner(0, 1, 1));
    addQuad(corner(0, 0, 0), corner(1, 0, 0), corner(1, 0, 1), corner(0, 0, 1));
    addQuad(corner(0, 1, 0), corner(0, 1, 1), corner(1, 1, 1), corner(1, 1, 0));
    addQuad(corner(0, 0, 0), corner(0, 0, 1), corner(0, 1, 1), corner(0, 1, 0));
    addQuad(corner(1, 0, 0), corner(1, 1, 0), corner(1, 1, 1), corner(1, 0, 1));
  }

  /* An octahedron: a point as it is seen. */
  void addPoint(const Eigen::Vector3d &middle, double radius) {
    const Eigen::Vector3d x = radius * Eigen::Vector3d::UnitX(), y = radius * Eigen::Vector3d::UnitY(),
                          z = radius * Eigen::Vector3d::UnitZ();
    for (const double s : {1.0, -1.0}) {
      add(middle + x, middle + y, middle + s * z);
      add(middle + y, middle - x, middle + s * z);
      add(middle - x, middle - y, middle + s * z);
      add(middle - y, middle + x, middle + s * z);
    }
  }

  Surface take() const {
    Surface out;
    out.vertices.resize(3, static_cast<Eigen::Index>(vertices_.size()));
    for (std::size_t i = 0; i < vertices_.size(); ++i)
      out.vertices.col(static_cast<Eigen::Index>(i)) = Eigen::Vector3d(vertices_[i].data());
    out.triangles.resize(3, static_cast<Eigen::Index>(triangles_.size()));
    for (std::size_t i = 0; i < triangles_.size(); ++i)
      out.triangles.col(static_cast<Eigen::Index>(i)) = Eigen::Vector3i(triangles_[i].data());
    return out;
  }

 private:
  int vertex(const Eigen::Vector3d &p) {
    const auto [found, added] = numbers_.emplace(Point{p.x(), p.y(), p.z()}, static_cast<int>(vertices_.size()));
    if (added) vertices_.push_back(found->first);
    return found->second;
  }

  std::map<Point, int> numbers_;
  std::vector<Point> vertices_;
  std::vector<std::array<int, 3>> triangles_;
};

/* The support points of a grid of directions: corners of the body's convex hull. */
Surface convexSurface(const cprox_body *body, std::size_t most) {
  const int rings = std::clamp(static_cast<int>(std::sqrt(static_cast<double>(most) / 4.0)), 4, 24), sides = 2 * rings;
  std::vector<Eigen::Vector3d> points;
  for (int ring = 0; ring <= rings; ++ring) {
    for (int side = 0; side < sides; ++side) {
      const double latitude = M_PI * (static_cast<double>(ring) / rings - 0.5), longitude = 2.0 * M_PI * side / sides;
      const bool is_pole = ring == 0 || ring == rings; // one point: 0 must not have a sign there
      const double across = std::cos(latitude);
      cprox_vec3 point{};
      const cprox_vec3 direction{is_pole ? 0.0 : across * std::cos(longitude),
                                 is_pole ? 0.0 : across * std::sin(longitude), std::sin(latitude)};
      cprox_body_support(body, direction, &point);
      points.emplace_back(point.x, point.y, point.z);
      if (!points.back().allFinite()) return {};
    }
  }
  Sheet sheet;
  const auto at = [&](int ring, int side) { return points[static_cast<std::size_t>(ring * sides + side % sides)]; };
  for (int ring = 0; ring < rings; ++ring) {
    for (int side = 0; side < sides; ++side)
      sheet.addQuad(at(ring, side), at(ring, side + 1), at(ring + 1, side + 1), at(ring + 1, side));
  }
  return sheet.take();
}

Surface meshSurface(const ShapeDescription &shape, const ResourceOptions &resources) {
  Surface out;
  if (shape.resource.empty()) {
    out.vertices = shape.vertices;
    out.triangles = shape.triangles;
  } else {
    try {
      const MeshData mesh = readMesh(resolveResource(shape.resource, resources));
      out.vertices = mesh.vertices;
      out.triangles = mesh.triangles;
    } catch (const Error &) {
      return {};
    }
  }
  out.vertices = meshScale(shape).asDiagonal() * out.vertices;
  return out;
}

Surface polygonSurface(const ShapeDescription &shape) {
  Sheet sheet;
  for (Eigen::Index i = 1; i + 1 < shape.vertices.cols(); ++i)
    sheet.add(shape.vertices.col(0), shape.vertices.col(i), shape.vertices.col(i + 1));
  return sheet.take();
}

/* The heights of a height field, joined by triangles. */
Surface groundSurface(const ShapeDescription &field) {
  const auto wide = static_cast<Eigen::Index>(field.dimensions[2]),
             deep = static_cast<Eigen::Index>(field.dimensions[3]);
  Surface out;
  out.vertices.resize(3, wide * deep);
  for (Eigen::Index i = 0; i < wide * deep; ++i)
    out.vertices.col(i) << field.dimensions[0] * static_cast<double>(i % wide),
        field.dimensions[1] * static_cast<double>(i / wide), field.values[static_cast<std::size_t>(i)];
  out.triangles.resize(3, 2 * (wide - 1) * (deep - 1));
  for (Eigen::Index k = 0; k < (wide - 1) * (deep - 1); ++k) {
    const int at = static_cast<int>(k / (wide - 1) * wide + k % (wide - 1)), above = at + static_cast<int>(wide);
    out.triangles.col(2 * k) << at, at + 1, above + 1;
    out.triangles.col(2 * k + 1) << at, above + 1, above;
  }
  return out;
}

Surface planeSurface(const ShapeDescription &shape, double size) {
  const Eigen::Vector3d normal(shape.dimensions[0], shape.dimensions[1], shape.dimensions[2]);
  const Eigen::Matrix3d axes = rotationBetween(Eigen::Vector3d::UnitZ(), normal).toRotationMatrix();
  const Eigen::Vector3d middle = -normal * (shape.dimensions[3] / normal.squaredNorm());
  const Eigen::Vector3d u = 0.5 * size * axes.col(0), v = 0.5 * size * axes.col(1);
  Sheet sheet;
  sheet.addQuad(middle - u - v, middle + u - v, middle + u + v, middle - u + v);
  return sheet.take();
}

Surface pointsSurface(const ShapeDescription &shape, std::size_t most) {
  constexpr double VISIBLE = 0.004; /* [m] */
  constexpr std::size_t TRIANGLES = 8;
  const double radius = std::max(VISIBLE, shape.dimensions.empty() ? 0.0 : shape.dimensions[0]);
  const Eigen::Index step = 1 + shape.vertices.cols() / static_cast<Eigen::Index>(most / TRIANGLES);
  Sheet sheet;
  for (Eigen::Index i = 0; i < shape.vertices.cols(); i += step) sheet.addPoint(shape.vertices.col(i), radius);
  return sheet.take();
}

/* Balls along the curve. */
Surface tubeSurface(const ShapeDescription &shape, std::size_t most) {
  if (!shape.curve) return {};
  const CompiledCurve curve = compile(*shape.curve, CurveBoxes::NONE);
  const cprox_curve_info info = cprox_curve_get_info(curve.curve.get());
  constexpr double VISIBLE = 0.004; /* [m] */
  constexpr std::size_t TRIANGLES = 8, BALLS = 200;
  const std::size_t balls = std::clamp<std::size_t>(most / TRIANGLES, 2, BALLS);
  Sheet sheet;
  for (std::size_t i = 0; i < balls; ++i) {
    const double s = static_cast<double>(i) / static_cast<double>(balls - 1);
    const double t = i + 1 == balls ? info.t1 : info.t0 + s * (info.t1 - info.t0);
    cprox_vec3 point{};
    if (cprox_curve_evaluate(curve.curve.get(), t, nullptr, &point, nullptr, nullptr) == CPROX_OK)
      sheet.addPoint(toEigen(point), std::max(VISIBLE, radiusAt(curve, t)));
  }
  return sheet.take();
}

Surface cellsSurface(const ShapeDescription &shape, const ResourceOptions &resources, std::size_t most) {
  constexpr std::size_t TRIANGLES = 12;
  Boxes cells;
  try {
    cells = octreeBoxes(shape, resources);
  } catch (const Error &) {
    return {};
  }
  const Eigen::Index step = 1 + cells.low.cols() / static_cast<Eigen::Index>(most / TRIANGLES);
  Sheet sheet;
  for (Eigen::Index i = 0; i < cells.low.cols(); i += step) sheet.addBox(cells.low.col(i), cells.high.col(i));
  return sheet.take();
}

/* The mesh over the cells of a grid, so many along its longest side. */
Surface clustered(const Surface &mesh, int cells) {
  const Eigen::Vector3d low = mesh.vertices.rowwise().minCoeff();
  const double size = (mesh.vertices.rowwise().maxCoeff() - low).maxCoeff() / cells;

  // The mean of the vertices of each cell.
  std::map<std::array<int, 3>, std::size_t> numbers;
  std::vector<Eigen::Vector4d> sums; /* the vertices' sum, and how many they are */
  std::vector<std::size_t> cell_of(static_cast<std::size_t>(mesh.vertices.cols()));
  for (Eigen::Index i = 0; i < mesh.vertices.cols(); ++i) {
    const Eigen::Vector3d p = (mesh.vertices.col(i) - low) / size;
    const auto [found, added] = numbers.emplace(
        std::array<int, 3>{static_cast<int>(p.x()), static_cast<int>(p.y()), static_cast<int>(p.z())}, sums.size());
    if (added) sums.emplace_back(Eigen::Vector4d::Zero());
    sums[found->second] += mesh.vertices.col(i).homogeneous();
    cell_of[static_cast<std::size_t>(i)] = found->second;
  }

  // Triangles whose corners are in three cells, each once.
  Sheet sheet;
  std::set<std::array<std::size_t, 3>> seen;
  const auto mean = [&](std::size_t cell) { return Eigen::Vector3d(sums[cell].hnormalized()); };
  for (Eigen::Index i = 0; i < mesh.triangles.cols(); ++i) {
    std::array<std::size_t, 3> corner{};
    for (Eigen::Index k = 0; k < 3; ++k)
      corner[static_cast<std::size_t>(k)] = cell_of[static_cast<std::size_t>(mesh.triangles(k, i))];
    std::array<std::size_t, 3> sorted = corner;
    std::sort(sorted.begin(), sorted.end());
    if (seen.insert(sorted).second) sheet.add(mean(corner[0]), mean(corner[1]), mean(corner[2]));
  }
  return sheet.take();
}

} // namespace

Surface decimated(const Surface &mesh, std::size_t most) {
  constexpr int FINEST = 256, COARSEST = 2;
  if (static_cast<std::size_t>(mesh.triangles.cols()) <= most) return mesh;
  Surface out;
  for (int cells = FINEST; cells >= COARSEST; cells = cells * 3 / 4) {
    out = clustered(mesh, cells);
    if (static_cast<std::size_t>(out.triangles.cols()) <= most) break;
  }
  return out;
}

Surface surfaceOf(const ShapeDescription &shape, const BodyHandle &body, const ResourceOptions &resources,
                  std::size_t most, double plane_size) {
  switch (shape.type) {
    case ShapeType::MESH: return decimated(meshSurface(shape, resources), most);
    case ShapeType::HEIGHT_FIELD: return decimated(groundSurface(shape), most);
    case ShapeType::POLYGON: return polygonSurface(shape);
    case ShapeType::HALFSPACE: return planeSurface(shape, plane_size);
    case ShapeType::POINTS: return pointsSurface(shape, most);
    case ShapeType::OCTREE: return cellsSurface(shape, resources, most);
    case ShapeType::CURVE: return tubeSurface(shape, most);
    default: return body ? convexSurface(body.get(), most) : Surface();
  }
}

} // namespace curve_proximity
