/* SPDX-License-Identifier: BSD-3-Clause */
/* How far one convex set stands out of another, from above: branch and bound over directions,
 * doc/constraint-providers.md. */
#include <algorithm>
#include <array>
#include <limits>
#include <queue>

#include <curve_proximity/superquadric_fit.hpp>

namespace curve_proximity {
namespace {

/* A direction, and what both sets say about it. */
struct Corner {
  Eigen::Vector3d u, on_outer;
  double inner = 0.0, outer = 0.0;
};

/* A cone of directions over a triangle of corners. */
struct Cell {
  std::array<Corner, 3> corners;
  double bound = 0.0;

  bool operator<(const Cell &other) const {
    return bound < other.bound;
  }
};

class Search {
 public:
  Search(const SupportFunction &inner, const SupportFunction &outer) : inner_(inner), outer_(outer) {}

  Corner look(const Eigen::Vector3d &direction) {
    Corner corner;
    Eigen::Vector3d on_inner;
    corner.u = direction.normalized();
    corner.inner = inner_(corner.u, on_inner);
    corner.outer = outer_(corner.u, corner.on_outer);
    found_ = std::max(found_, corner.inner - corner.outer);
    return corner;
  }

  /* For u = sum l_i u_i of the cell: h_inner(u) <= sum l_i h_inner(u_i), h_outer(u) >= p·u for p of the outer set, and
   * 1 <= sum l_i <= 1/m, m being how far the triangle's plane is from the origin. */
  Cell cell(const Corner &a, const Corner &b, const Corner &c) {
    Eigen::Vector3d on_middle;
    outer_((a.u + b.u + c.u).normalized(), on_middle);
    Cell out{{a, b, c}, std::numeric_limits<double>::infinity()};
    for (const Eigen::Vector3d &p : {a.on_outer, b.on_outer, c.on_outer, on_middle}) {
      double worst = -std::numeric_limits<double>::infinity();
      for (const Corner &corner : out.corners) worst = std::max(worst, corner.inner - p.dot(corner.u));
      out.bound = std::min(out.bound, worst);
    }
    const Eigen::Vector3d normal = (b.u - a.u).cross(c.u - a.u).normalized();
    if (out.bound > 0.0) out.bound /= std::abs(normal.dot(a.u)) * (1.0 - 1e-14);
    return out;
  }

  /* The largest difference met. */
  double found() const {
    return found_;
  }

 private:
  const SupportFunction &inner_, &outer_;
  double found_ = -std::numeric_limits<double>::infinity();
};

} // namespace

double supportGap(const SupportFunction &inner, const SupportFunction &outer, double tolerance, int cells) {
  Search search(inner, outer);
  std::priority_queue<Cell> open;

  // The eight octants.
  std::array<std::array<Corner, 2>, 3> axes;
  for (int i = 0; i < 3; ++i) {
    axes[static_cast<std::size_t>(i)] = {search.look(Eigen::Vector3d::Unit(i)), search.look(-Eigen::Vector3d::Unit(i))};
  }
  for (std::size_t k = 0; k < 8; ++k) open.push(search.cell(axes[0][k & 1], axes[1][k >> 1 & 1], axes[2][k >> 2]));

  // The most promising cell becomes four, until it can promise no more than has been met.
  for (int used = 8; used + 4 <= cells && open.top().bound > search.found() + tolerance; used += 4) {
    const std::array<Corner, 3> c = open.top().corners;
    open.pop();
    const Corner ab = search.look(c[0].u + c[1].u), bc = search.look(c[1].u + c[2].u),
                 ca = search.look(c[2].u + c[0].u);
    open.push(search.cell(c[0], ab, ca));
    open.push(search.cell(ab, c[1], bc));
    open.push(search.cell(ca, bc, c[2]));
    open.push(search.cell(ab, bc, ca));
  }
  return open.top().bound;
}

} // namespace curve_proximity
