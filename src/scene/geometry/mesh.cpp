/* SPDX-License-Identifier: BSD-3-Clause */
#include "mesh.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include <curve_proximity/mesh_remarks.hpp>

#include "hull.h"
#include "mesh_cache.h"
#include "mesh_process.h"
#include "simplify.h"

namespace curve_proximity {
namespace {

void checkMesh(const MeshData &mesh, const Eigen::Vector3d &scale) {
  if (!scale.allFinite() || (scale.array() == 0.0).any()) throw Error("mesh scale must be finite and not 0");
  const Eigen::Index n = mesh.vertices.cols();
  if (mesh.triangles.cols() == 0) throw Error("mesh has no triangle");
  for (Eigen::Index k = 0; k < mesh.triangles.size(); ++k) {
    const int index = mesh.triangles.data()[k];
    if (index >= 0 && index < n) continue;
    throw Error("mesh triangle " + std::to_string(k / 3) + " uses vertex " + std::to_string(index) +
                ", but there are " + std::to_string(n) + " vertices");
  }
  for (Eigen::Index i = 0; i < n; ++i) {
    const Eigen::Vector3d scaled = mesh.vertices.col(i).cwiseProduct(scale);
    if (!scaled.allFinite()) throw Error("mesh vertex " + std::to_string(i) + " is not finite");
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
    if (used[i]) points.push_back(vertex.cwiseProduct(scale));
  }
  const auto key = [](const Eigen::Vector3d &p) { return std::make_tuple(p.x(), p.y(), p.z()); };
  std::sort(points.begin(), points.end(),
            [&](const Eigen::Vector3d &a, const Eigen::Vector3d &b) { return key(a) < key(b); });
  points.erase(std::unique(points.begin(), points.end()), points.end());
  return points;
}

/* Between steps that ask nobody while they last. */
void checkTime(const ResourceOptions &options) {
  if (options.stop && options.stop()) throw Error("stopped before its BVH was built", CPROX_STOPPED);
}

Geometry geometryOf(const MeshData &mesh, const PreparedMesh &prepared, const Eigen::Vector3d &scale, bool solid,
                    const ResourceOptions &options) {
  checkTime(options);
  const HullPoints &hull_points = prepared.hull;
  const BodyHandle hull = polytopeOf(hull_points.kept);
  const Eigen::Matrix3Xd vertices = scale.asDiagonal() * mesh.vertices;
  const BodyHandle triangles =
      makeMesh(vertices, mesh.triangles, solid ? CPROX_MESH_FILL_SOLID : CPROX_MESH_FILL_SURFACE, options.memory_limit,
               options.stop);
  const bool has_inside = cprox_body_get_info(triangles.get()).is_solid;

  Geometry out;
  out.body = makeLod(hull, hull_points.excess, triangles);
  out.surface = has_inside ? makeLod(hull, hull_points.excess, makeSurface(triangles)) : out.body;
  out.hull = hull;
  out.hull_excess = hull_points.excess;
  out.margin = prepared.moved;
  out.is_mesh = true;
  out.is_open = solid && !has_inside && mesh.vertices.cols() > 1; // what has become a point was small
  return out;
}

Digest keyOfFile(const Digest &content, const Eigen::Vector3d &scale, double tolerance) {
  return keyOf("file")
      .add(content.data(), content.size())
      .add(scale.data(), 3 * sizeof(double))
      .add(&tolerance, sizeof tolerance)
      .finish();
}

Digest keyOfArrays(const MeshData &mesh, const Eigen::Vector3d &scale, double tolerance) {
  const std::array<Eigen::Index, 2> counts = {mesh.vertices.cols(), mesh.triangles.cols()};
  return keyOf("arrays")
      .add(counts.data(), sizeof counts)
      .add(mesh.vertices.data(), static_cast<std::size_t>(mesh.vertices.size()) * sizeof(double))
      .add(mesh.triangles.data(), static_cast<std::size_t>(mesh.triangles.size()) * sizeof(int))
      .add(scale.data(), 3 * sizeof(double))
      .add(&tolerance, sizeof tolerance)
      .finish();
}

const std::string &readerProgram() {
  static const std::string program = meshReaderProgram();
  return program;
}

/* Errors say of which mesh they speak. */
template <class Work>
auto ofMesh(const std::string &name, Work work) -> decltype(work()) {
  try {
    return work();
  } catch (const Error &error) {
    throw Error("mesh '" + name + "': " + error.what(), error.status());
  }
}

/* What is kept of a file, or its mesh without the hull. */
struct Found {
  PreparedMeshPtr kept;
  std::shared_ptr<PreparedMesh> read;
  std::optional<Digest> key; /* of what may be kept */
};

Found find(const MeshRequest &request, const ResourceOptions &options, MeshTiming &timing) {
  const MeshFile file(request.file);
  Found out;
  if (file.digest()) out.key = keyOfFile(*file.digest(), request.scale, options.mesh_tolerance);
  if (out.key && (out.kept = recallMesh(*out.key))) timing.from = MeshTiming::MEMORY;
  if (out.key && !out.kept && (out.kept = loadMesh(options.cache_dir, *out.key))) timing.from = MeshTiming::CACHE_DIR;
  if (out.kept) return out;
  out.read = std::make_shared<PreparedMesh>();
  out.read->mesh = file.readBy(readerProgram());
  return out;
}

void simplifyAsAsked(PreparedMesh &mesh, const Eigen::Vector3d &scale, double tolerance) {
  if (!(tolerance >= 0.0) || !std::isfinite(tolerance)) throw Error("mesh_tolerance must be finite and not below 0");
  if (!(tolerance > 0.0)) return;
  SimplifiedMesh simple = simplify(mesh.mesh, scale, tolerance);
  simple.mesh.remark = std::move(mesh.mesh.remark);
  mesh.mesh = std::move(simple.mesh);
  mesh.moved = simple.moved;
}

/* The hull, made now where it is not kept. */
PreparedMeshPtr complete(const Found &found, const MeshRequest &request, const ResourceOptions &options) {
  const PreparedMesh &mesh = found.kept ? *found.kept : *found.read;
  checkMesh(mesh.mesh, request.scale);
  if (!found.kept) simplifyAsAsked(*found.read, request.scale, options.mesh_tolerance);
  if (!found.kept) found.read->hull = hullPointsOf(usedVertices(mesh.mesh, request.scale));
  const PreparedMeshPtr out = found.kept ? found.kept : found.read;
  if (found.key) keepMesh(*found.key, out);
  if (found.key && !found.kept) saveMesh(options.cache_dir, *found.key, *out);
  return out;
}

} // namespace

MeshData readMesh(const std::string &file) {
  return ofMesh(file, [&] { return readMeshBy(readerProgram(), file); });
}

Geometry makeMeshGeometry(const MeshData &mesh, const Eigen::Vector3d &scale, bool solid,
                          const ResourceOptions &options) {
  checkMesh(mesh, scale);
  checkTime(options);
  const Digest key = keyOfArrays(mesh, scale, options.mesh_tolerance);
  PreparedMeshPtr prepared = recallMesh(key);
  if (!prepared) {
    auto made = std::make_shared<PreparedMesh>();
    if (options.mesh_tolerance != 0.0) made->mesh = mesh; // else the caller has it, and it is not kept
    simplifyAsAsked(*made, scale, options.mesh_tolerance);
    made->hull = hullPointsOf(usedVertices(options.mesh_tolerance > 0.0 ? made->mesh : mesh, scale));
    keepMesh(key, made);
    prepared = made;
  }
  return geometryOf(options.mesh_tolerance > 0.0 ? prepared->mesh : mesh, *prepared, scale, solid, options);
}

bool MeshRequest::operator<(const MeshRequest &other) const {
  const auto key = [](const MeshRequest &r) {
    return std::make_tuple(r.file, r.uri, r.scale.x(), r.scale.y(), r.scale.z(), r.solid);
  };
  return key(*this) < key(other);
}

Geometry loadMeshGeometry(const MeshRequest &request, const ResourceOptions &options, MeshTiming *timing,
                          std::string *remark) {
  MeshTiming ignored;
  MeshTiming &times = timing ? *timing : ignored;
  times.file = request.file;
  std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now();
  const auto lap = [&start] {
    const auto before = std::exchange(start, std::chrono::steady_clock::now());
    return std::chrono::duration<double>(start - before).count();
  };
  const Found found = ofMesh(request.file, [&] { return find(request, options, times); });
  times.read = lap();
  return ofMesh(request.uri, [&] {
    const PreparedMeshPtr mesh = complete(found, request, options);
    times.hull = lap();
    Geometry out = geometryOf(mesh->mesh, *mesh, request.scale, request.solid, options);
    times.triangles = static_cast<std::size_t>(mesh->mesh.triangles.cols());
    if (remark) *remark = mesh->mesh.remark;
    times.tree = lap();
    return out;
  });
}

std::vector<std::string> meshRemarks(const ObjectDescription &object, const ResourceOptions &options) {
  std::vector<std::string> out;
  for (const ShapeDescription &shape : object.shapes) {
    if (shape.type != ShapeType::MESH || shape.resource.empty()) continue;
    MeshTiming ignored;
    const MeshRequest request{shape.resource, resolveResource(shape.resource, options), meshScale(shape), shape.solid};
    const Found found = ofMesh(request.file, [&] { return find(request, options, ignored); });
    const std::string &remark = (found.kept ? *found.kept : *found.read).mesh.remark;
    if (!remark.empty()) out.push_back("mesh '" + shape.resource + "': " + remark);
  }
  return out;
}

} // namespace curve_proximity
