/* SPDX-License-Identifier: BSD-3-Clause */
#include "mesh_builder.h"

#include <cmath>
#include <cstring>
#include <limits>

#include "text.h"

namespace curve_proximity::mesh_reader {
namespace {

constexpr std::size_t MOST = std::numeric_limits<std::int32_t>::max();

/* Numbers positions in the order of their first use, equal ones alike: a table of open addresses. */
class Vertices {
 public:
  explicit Vertices(const std::vector<Point> &positions) : positions_(positions), known_(positions.size(), NONE) {
    std::size_t size = 16;
    while (size < 2 * positions.size()) size *= 2;
    table_.assign(size, NONE);
  }

  std::int32_t number(std::uint32_t position) {
    std::uint32_t &known = known_[position];
    if (known == NONE) known = find(position);
    return static_cast<std::int32_t>(known);
  }

  std::vector<double> take() {
    return std::move(out_);
  }

 private:
  static constexpr std::uint32_t NONE = std::numeric_limits<std::uint32_t>::max();

  static std::size_t hash(const Point &p) {
    std::uint64_t out = 0;
    for (const double x : p) {
      const double value = x + 0.0; // -0 is 0
      std::uint64_t bits = 0;
      std::memcpy(&bits, &value, sizeof bits);
      out = (out ^ bits) * 0x9e3779b97f4a7c15U;
      out ^= out >> 29;
    }
    return static_cast<std::size_t>(out);
  }

  std::uint32_t find(std::uint32_t position) {
    const Point &p = positions_[position];
    for (std::size_t i = hash(p) & (table_.size() - 1);; i = (i + 1) & (table_.size() - 1)) {
      std::uint32_t &entry = table_[i];
      if (entry == NONE) {
        entry = static_cast<std::uint32_t>(out_.size() / 3);
        out_.insert(out_.end(), p.begin(), p.end());
        return entry;
      }
      const double *there = &out_[3 * std::size_t{entry}];
      if (there[0] == p[0] && there[1] == p[1] && there[2] == p[2]) return entry;
    }
  }

  const std::vector<Point> &positions_;
  std::vector<std::uint32_t> known_, table_;
  std::vector<double> out_;
};

/* A polygon in the plane, whose ears are cut. */
class Polygon {
 public:
  Polygon(const std::vector<Point> &positions, const std::uint32_t *corners, std::size_t n) {
    Point normal{};
    for (std::size_t i = 0; i < n; ++i) { // Newell's
      const Point &p = positions[corners[i]], &q = positions[corners[(i + 1) % n]], &o = positions[corners[0]];
      for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t a = (k + 1) % 3, b = (k + 2) % 3;
        normal[k] += (p[a] - o[a]) * (q[b] - o[b]) - (p[b] - o[b]) * (q[a] - o[a]);
      }
    }
    std::size_t axis = 0;
    for (std::size_t k = 1; k < 3; ++k)
      if (std::fabs(normal[k]) > std::fabs(normal[axis])) axis = k;
    const std::size_t x = (axis + 1) % 3, y = (axis + 2) % 3;
    const double sign = normal[axis] < 0.0 ? -1.0 : 1.0;
    for (std::size_t i = 0; i < n; ++i) {
      left_.push_back(corners[i]);
      flat_.push_back({positions[corners[i]][x], sign * positions[corners[i]][y]});
    }
  }

  /* Hands each triangle over. Returns false where no ear was found, and a fan was made. */
  template <class Take>
  bool cut(Take take) {
    bool simple = true;
    while (left_.size() > 3) {
      std::size_t ear = simple ? findEar() : 1;
      if (ear == left_.size()) simple = false, ear = 1;
      const std::size_t n = left_.size();
      take(left_[(ear + n - 1) % n], left_[ear], left_[(ear + 1) % n]);
      left_.erase(left_.begin() + static_cast<std::ptrdiff_t>(ear));
      flat_.erase(flat_.begin() + static_cast<std::ptrdiff_t>(ear));
    }
    take(left_[0], left_[1], left_[2]);
    return simple;
  }

 private:
  using Flat = std::array<double, 2>;

  static double turn(const Flat &a, const Flat &b, const Flat &c) {
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
  }

  /* From the second corner on, the first last; n for none. */
  std::size_t findEar() const {
    const std::size_t n = left_.size();
    for (std::size_t k = 1; k <= n; ++k)
      if (isEar(k % n)) return k % n;
    return n;
  }

  bool isEar(std::size_t i) const {
    const std::size_t n = left_.size();
    const Flat &a = flat_[(i + n - 1) % n], &b = flat_[i], &c = flat_[(i + 1) % n];
    const double area = turn(a, b, c);
    if (area == 0.0) return true; // nothing is cut off
    if (!(area > 0.0)) return false;
    for (std::size_t k = 2; k + 1 < n; ++k) {
      const Flat &p = flat_[(i + k) % n];
      if (p == a || p == b || p == c) continue;
      if (turn(a, b, p) >= 0.0 && turn(b, c, p) >= 0.0 && turn(c, a, p) >= 0.0) return false;
    }
    return true;
  }

  std::vector<std::uint32_t> left_;
  std::vector<Flat> flat_;
};

} // namespace

std::uint32_t MeshBuilder::add(const Point &position) {
  if (positions_.size() >= MOST) throw Fault("it has more vertices than can be numbered");
  positions_.push_back(position);
  return static_cast<std::uint32_t>(positions_.size() - 1);
}

void MeshBuilder::addPolygon(const std::vector<std::uint32_t> &corners) {
  if (corners.size() < 3) throw Fault("a face has three vertices or more, got " + std::to_string(corners.size()));
  corners_.insert(corners_.end(), corners.begin(), corners.end());
  sizes_.push_back(static_cast<std::uint32_t>(corners.size()));
}

void MeshBuilder::addTriangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  corners_.insert(corners_.end(), {a, b, c});
  sizes_.push_back(3);
}

Mesh MeshBuilder::finish() {
  Mesh out;
  Vertices vertices(positions_);
  std::uint64_t crossed = 0;
  const auto take = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    for (const std::uint32_t corner : {a, b, c}) out.triangles.push_back(vertices.number(corner));
  };
  const std::uint32_t *at = corners_.data();
  if (corners_.size() > MOST) throw Fault("it has more triangles than can be numbered");
  for (const std::uint32_t size : sizes_) {
    if (size == 3) {
      take(at[0], at[1], at[2]);
    } else if (!Polygon(positions_, at, size).cut(take)) {
      ++crossed;
    }
    at += size;
  }
  out.vertices = vertices.take();
  if (crossed > 0)
    out.remark = count(crossed, "polygon") + (crossed == 1 ? " crosses itself: it is" : " cross themselves: each is") +
                 " cut into a fan of triangles";
  return out;
}

} // namespace curve_proximity::mesh_reader
