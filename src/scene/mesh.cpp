/* SPDX-License-Identifier: BSD-3-Clause */
#include "mesh.h"

#include <algorithm>
#include <limits>
#include <tuple>
#include <utility>
#include <vector>

#include <geometric_shapes/bodies.h>

#include "mesh_process.h"

namespace curve_proximity {
namespace {

using Points = std::vector<Eigen::Vector3d>;

/* Below so many vertices a hull computation costs more than it saves. */
constexpr std::size_t FEW_VERTICES = 16;

/* Vertices that the hull computation dropped may stand out of the hull by this fraction of the mesh's size: then they
 * are covered by Geometry::excess. Farther ones are taken back. */
constexpr double DROPPED_TOLERANCE = 1e-12;

/* A mesh whose thickness is below this fraction of its size has no hull that qhull could compute. */
constexpr double FLATNESS = 1e-9;

/* Accuracy of cprox_body_nearest(), per unit of |point| + size (cprox/body.h). */
constexpr double NEAREST_ROUNDING = 64.0 * std::numeric_limits<double>::epsilon() / 2.0;

void checkTriangles(const MeshData &mesh) {
  const Eigen::Index n = mesh.vertices.cols();
  if (mesh.triangles.cols() == 0) throw Error("mesh has no triangle");
  for (Eigen::Index k = 0; k < mesh.triangles.size(); ++k) {
    const int index = mesh.triangles.data()[k];
    if (index >= 0 && index < n) continue;
    throw Error("mesh triangle " + std::to_string(k / 3) + " uses vertex " + std::to_string(index) +
                ", but there are " + std::to_string(n) + " vertices");
  }
}

/* The scaled vertices that triangles use, each once, in lexical order. */
Points usedVertices(const MeshData &mesh, const Eigen::Vector3d &scale) {
  std::vector<bool> used(static_cast<std::size_t>(mesh.vertices.cols()), false);
  for (Eigen::Index k = 0; k < mesh.triangles.size(); ++k) {
    used[static_cast<std::size_t>(mesh.triangles.data()[k])] = true;
  }

  Points points;
  for (std::size_t i = 0; i < used.size(); ++i) {
    const Eigen::Vector3d vertex = mesh.vertices.col(static_cast<Eigen::Index>(i));
    const Eigen::Vector3d scaled = vertex.cwiseProduct(scale);
    if (!scaled.allFinite()) throw Error("mesh vertex " + std::to_string(i) + " is not finite");
    if (used[i]) points.push_back(scaled);
  }

  const auto key = [](const Eigen::Vector3d &p) { return std::make_tuple(p.x(), p.y(), p.z()); };
  std::sort(points.begin(), points.end(),
            [&](const Eigen::Vector3d &a, const Eigen::Vector3d &b) { return key(a) < key(b); });
  points.erase(std::unique(points.begin(), points.end()), points.end());
  return points;
}

/* The farthest point by a measure, and how far. */
template <typename Measure>
std::pair<Eigen::Vector3d, double> farthest(const Points &points, Measure measure) {
  std::pair<Eigen::Vector3d, double> best(points.front(), -1.0);
  for (const Eigen::Vector3d &p : points) {
    const double d = measure(p);
    if (d > best.second) best = {p, d};
  }
  return best;
}

/* Is there no thickness to speak of? By the simplex of points that are each farthest from those before. */
bool isFlat(const Points &points) {
  const Eigen::Vector3d a = points.front();
  const auto [b, length] = farthest(points, [&](const Eigen::Vector3d &p) { return (p - a).norm(); });
  if (!(length > 0.0)) return true;
  const Eigen::Vector3d along = (b - a) / length;
  const auto [c, width] = farthest(points, [&](const Eigen::Vector3d &p) { return along.cross(p - a).norm(); });
  if (!(width > FLATNESS * length)) return true;
  const Eigen::Vector3d normal = along.cross(c - a) / width;
  const auto [d, thickness] = farthest(points, [&](const Eigen::Vector3d &p) { return std::abs(normal.dot(p - a)); });
  (void)d;
  return !(thickness > FLATNESS * length);
}

/* The extreme points as qhull finds them; empty where it gives up. */
Points extremePoints(const Points &points) {
  shapes::Mesh mesh(static_cast<unsigned>(points.size()), 0);
  for (std::size_t i = 0; i < points.size(); ++i) {
    Eigen::Map<Eigen::Vector3d>(mesh.vertices + 3 * i) = points[i];
  }
  const bodies::ConvexMesh hull(&mesh);
  return Points(hull.getVertices().begin(), hull.getVertices().end());
}

BodyHandle polytopeOf(const Points &points) {
  return makePolytope(
      Eigen::Map<const Eigen::Matrix3Xd>(points.front().data(), 3, static_cast<Eigen::Index>(points.size())));
}

double largestCoordinate(const Points &points) {
  double largest = 0.0;
  for (const Eigen::Vector3d &p : points) largest = std::max(largest, p.cwiseAbs().maxCoeff());
  return largest;
}

} // namespace

MeshData readMesh(const std::string &file) {
  static const std::string program = meshReaderProgram();
  try {
    return readMeshBy(program, file);
  } catch (const Error &error) {
    throw Error("mesh '" + file + "': " + error.what(), error.status());
  }
}

Hull hullCovering(const Points &all, Points kept) {
  Hull out;
  out.body = polytopeOf(kept);

  // What stands out a little is told, what stands out farther is taken back.
  const double size = largestCoordinate(all);
  Points back;
  for (const Eigen::Vector3d &p : all) {
    const double out_by = cprox_body_nearest(out.body.get(), toVec3(p), nullptr);
    if (out_by <= DROPPED_TOLERANCE * size) {
      out.excess = std::max(out.excess, out_by);
    } else {
      back.push_back(p);
    }
  }
  if (!back.empty()) {
    kept.insert(kept.end(), back.begin(), back.end());
    out.body = polytopeOf(kept);
  }
  out.excess += NEAREST_ROUNDING * 6.0 * size;
  return out;
}

/* Extreme points only, where that pays and can be had. Qhull merges facets: what it drops must be covered all the same. */
static Hull hullOf(const Points &all) {
  Points kept;
  if (all.size() > FEW_VERTICES && !isFlat(all)) kept = extremePoints(all);
  if (kept.size() >= 4) return hullCovering(all, std::move(kept));
  return {polytopeOf(all), 0.0};
}

Geometry makeMeshGeometry(const MeshData &mesh, const Eigen::Vector3d &scale, bool solid, std::size_t memory_limit) {
  if (!scale.allFinite() || (scale.array() == 0.0).any()) throw Error("mesh scale must be finite and not 0");
  checkTriangles(mesh);
  const Hull hull = hullOf(usedVertices(mesh, scale));
  const Eigen::Matrix3Xd vertices = scale.asDiagonal() * mesh.vertices;
  const auto lod = [&](cprox_mesh_fill fill) {
    return makeLod(hull.body, hull.excess, makeMesh(vertices, mesh.triangles, fill, memory_limit));
  };

  Geometry out;
  out.body = lod(solid ? CPROX_MESH_SOLID : CPROX_MESH_SURFACE);
  const bool has_inside = cprox_body_get_info(out.body.get()).is_solid;
  out.surface = has_inside ? lod(CPROX_MESH_SURFACE) : out.body;
  out.hull = hull.body;
  out.hull_excess = hull.excess;
  out.is_mesh = true;
  out.is_open = solid && !has_inside;
  return out;
}

} // namespace curve_proximity
