/* SPDX-License-Identifier: BSD-3-Clause */
/* Vertex clustering (Rossignac and Borrel 1993). Every vertex moves to one of its cell's; a triangle moves with its
 * corners. A point of a triangle is a convex combination of the corners, and moves no farther than the corner that
 * moves farthest. So both surfaces lie within that distance of each other, whatever collapses.
 *
 * What collapses may be left out where something else covers it. Of triangles with the same corners as many stay as one
 * way round exceeds the other, at least one: so every edge is still run through as often one way as the other, and a
 * closed mesh stays closed. While all vertices move to their places along straight lines, the surface stays within
 * `moved` of where it was; so the winding number of a point that is farther away does not change. */
#include "simplify.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <tuple>
#include <utility>
#include <vector>

namespace curve_proximity {
namespace {

using Cell = std::array<std::int64_t, 3>;

/* Of sides so short that any two points of one are within the tolerance. */
Cell cellOf(const Eigen::Vector3d &p, double side) {
  Cell out{};
  for (int k = 0; k < 3; ++k) out[static_cast<std::size_t>(k)] = static_cast<std::int64_t>(std::floor(p[k] / side));
  return out;
}

/* Of each vertex the one that stands for it: that of its cell which is nearest to their mean. */
std::vector<int> representatives(const Eigen::Matrix3Xd &points, double side) {
  struct Member {
    Cell cell;
    int vertex;
  };
  std::vector<Member> members;
  for (int i = 0; i < static_cast<int>(points.cols()); ++i) members.push_back({cellOf(points.col(i), side), i});
  std::sort(members.begin(), members.end(),
            [](const Member &a, const Member &b) { return std::tie(a.cell, a.vertex) < std::tie(b.cell, b.vertex); });
  std::vector<int> out(members.size());
  for (std::size_t first = 0, last = 0; first < members.size(); first = last) {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (last = first; last < members.size() && members[last].cell == members[first].cell; ++last)
      mean += points.col(members[last].vertex);
    mean /= static_cast<double>(last - first);
    int nearest = members[first].vertex;
    for (std::size_t i = first; i < last; ++i)
      if ((points.col(members[i].vertex) - mean).norm() < (points.col(nearest) - mean).norm())
        nearest = members[i].vertex;
    for (std::size_t i = first; i < last; ++i) out[static_cast<std::size_t>(members[i].vertex)] = nearest;
  }
  return out;
}

/* Corners in ascending order, and whether the triangle runs through them in that order (1) or the other (-1). */
struct Turned {
  std::array<int, 3> corners;
  int way;
};

Turned turned(std::array<int, 3> t) {
  int way = 1;
  const auto order = [&](std::size_t a, std::size_t b) {
    if (t[a] <= t[b]) return;
    std::swap(t[a], t[b]);
    way = -way;
  };
  order(0, 1), order(1, 2), order(0, 1);
  return {t, way};
}

using Edge = std::array<int, 2>;

template <typename T>
void sortOnce(std::vector<T> &list) {
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end()), list.end());
}

/* The triangles between representatives, as few as cover all and balance. */
class Kept {
 public:
  explicit Kept(std::vector<Turned> all) {
    std::sort(all.begin(), all.end(), [](const Turned &a, const Turned &b) { return a.corners < b.corners; });
    for (std::size_t first = 0, last = 0; first < all.size(); first = last) {
      int sum = 0;
      for (last = first; last < all.size() && all[last].corners == all[first].corners; ++last) sum += all[last].way;
      add(all[first].corners, sum);
    }
    addCollapsed();
  }

  const std::vector<std::array<int, 3>> &triangles() const {
    return triangles_;
  }

 private:
  void add(const std::array<int, 3> &t, int sum) {
    if (t[0] == t[2]) return points_.push_back(t[0]);
    if (t[0] == t[1] || t[1] == t[2]) return segments_.push_back({t[0], t[2]});
    for (const Edge &edge : {Edge{t[0], t[1]}, Edge{t[1], t[2]}, Edge{t[0], t[2]}}) edges_.push_back(edge);
    const std::array<int, 3> back{t[0], t[2], t[1]};
    if (sum == 0) triangles_.insert(triangles_.end(), {t, back});
    for (int i = 0; i < std::abs(sum); ++i) triangles_.push_back(sum > 0 ? t : back);
  }

  /* Segments and points that nothing else covers, as triangles without an area. */
  void addCollapsed() {
    sortOnce(edges_);
    sortOnce(segments_);
    sortOnce(points_);
    for (const Edge &s : segments_)
      if (!std::binary_search(edges_.begin(), edges_.end(), s)) triangles_.push_back({s[0], s[1], s[1]});
    std::vector<int> covered;
    for (const std::array<int, 3> &t : triangles_) covered.insert(covered.end(), t.begin(), t.end());
    sortOnce(covered);
    for (const int p : points_)
      if (!std::binary_search(covered.begin(), covered.end(), p)) triangles_.push_back({p, p, p});
  }

  std::vector<std::array<int, 3>> triangles_;
  std::vector<Edge> edges_, segments_;
  std::vector<int> points_;
};

/* With the vertices that the triangles use alone. */
MeshData meshOf(const Eigen::Matrix3Xd &vertices, const std::vector<std::array<int, 3>> &triangles) {
  std::vector<int> used;
  for (const std::array<int, 3> &t : triangles) used.insert(used.end(), t.begin(), t.end());
  sortOnce(used);
  MeshData out;
  out.vertices.resize(3, static_cast<Eigen::Index>(used.size()));
  for (std::size_t i = 0; i < used.size(); ++i) out.vertices.col(static_cast<Eigen::Index>(i)) = vertices.col(used[i]);
  out.triangles.resize(3, static_cast<Eigen::Index>(triangles.size()));
  for (std::size_t i = 0; i < triangles.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k)
      out.triangles(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(i)) =
          static_cast<int>(std::lower_bound(used.begin(), used.end(), triangles[i][k]) - used.begin());
  return out;
}

} // namespace

SimplifiedMesh simplify(const MeshData &mesh, const Eigen::Vector3d &scale, double tolerance) {
  constexpr double SHORTER = 1.0 - 1e-9, MOST_CELLS = 1e15, ROUND = 1.0 + 8.0 * std::numeric_limits<double>::epsilon();
  const Eigen::Matrix3Xd points = scale.asDiagonal() * mesh.vertices;
  const double side = SHORTER * tolerance / std::sqrt(3.0);
  if (!(points.cwiseAbs().maxCoeff() < MOST_CELLS * side)) return {mesh, 0.0}; // finer than doubles are
  const std::vector<int> of = representatives(points, side);

  SimplifiedMesh out;
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const Eigen::Vector3d way = points.col(i) - points.col(of[static_cast<std::size_t>(i)]);
    out.moved = std::max(out.moved, ROUND * way.norm());
  }
  std::vector<Turned> triangles;
  const auto corner = [&](int k, Eigen::Index i) { return of[static_cast<std::size_t>(mesh.triangles(k, i))]; };
  for (Eigen::Index i = 0; i < mesh.triangles.cols(); ++i)
    triangles.push_back(turned({corner(0, i), corner(1, i), corner(2, i)}));
  out.mesh = meshOf(mesh.vertices, Kept(std::move(triangles)).triangles());
  return out;
}

} // namespace curve_proximity
