/* SPDX-License-Identifier: BSD-3-Clause */
#include "solids.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <curve_proximity/geometry.hpp>
#include <curve_proximity/superquadric_fit.hpp>

#include "../scene/geometry/hull.h"
#include "../scene/geometry/scaling.h"

namespace curve_proximity {
namespace {

using Vertices = std::vector<cprox_vec3>;
using Corners = std::vector<std::array<std::uint32_t, 3>>;

constexpr const char *ENDLESS = "it has no end, and a gap is periodic: give a box as large as what comes near it";

/* Of the pyramid round a cone. */
constexpr int SIDES = 32;

SolidHandle meshSolid(const Vertices &vertices, const Corners &triangles) {
  cprox_solid_description solid{};
  solid.kind = CPROX_SOLID_MESH;
  solid.points = vertices.data();
  solid.n = vertices.size();
  solid.triangles = reinterpret_cast<const std::uint32_t(*)[3]>(triangles.data());
  solid.n_triangles = triangles.size();
  return makeSolid(solid);
}

/* Turns each triangle so that it looks away from a point inside a convex hull. */
void lookOutward(const Vertices &vertices, const Eigen::Vector3d &inside, Corners &triangles) {
  for (auto &t : triangles) {
    const Eigen::Vector3d a = toEigen(vertices[t[0]]), b = toEigen(vertices[t[1]]), c = toEigen(vertices[t[2]]);
    if ((b - a).cross(c - a).dot(a - inside) < 0.0) std::swap(t[1], t[2]);
  }
}

/* A convex polytope. */
struct Hull {
  Vertices vertices;
  Corners triangles;
  Eigen::Vector3d middle = Eigen::Vector3d::Zero(); /* inside */
};

/* The hull of points with an interior. What the hull's computation dropped is taken in again: all is scaled about the
 * middle until every point is behind every face. Cost: points times faces. */
Hull hullOf(const Eigen::Matrix3Xd &points, const Stop &stop = {}) {
  Points given;
  for (Eigen::Index i = 0; i < points.cols(); ++i) given.emplace_back(points.col(i));
  const HullSurface hull = hullSurfaceOf(given, stop);
  if (hull.facets.size() < 4) throw Error("the hull of its vertices has no interior");
  Hull out;
  for (const Eigen::Vector3d &v : hull.points) {
    out.vertices.push_back(toVec3(v));
    out.middle += v / static_cast<double>(hull.points.size());
  }
  for (const HullFacet &corners : hull.facets) {
    const auto number = [&](std::size_t k) { return static_cast<std::uint32_t>(corners[k]); };
    out.triangles.push_back({number(0), number(1), number(2)});
  }
  lookOutward(out.vertices, out.middle, out.triangles);

  double scale = 1.0;
  std::size_t looked = 0;
  for (const auto &t : out.triangles) {
    if (looked++ % 16 == 0 && stop && stop()) throw Error("stopped while its hull was made", CPROX_STOPPED);
    const Eigen::Vector3d a = toEigen(out.vertices[t[0]]);
    const Eigen::Vector3d n = (toEigen(out.vertices[t[1]]) - a).cross(toEigen(out.vertices[t[2]]) - a).normalized();
    const double depth = n.dot(a - out.middle);
    if (!(depth > 0.0)) continue; // a sliver: its neighbours hold its place
    scale = std::max(
        scale,
        (points.colwise() - out.middle).cwiseProduct(n.replicate(1, points.cols())).colwise().sum().maxCoeff() / depth);
  }
  scale *= 1.0 + 1e-12;
  for (cprox_vec3 &v : out.vertices) v = toVec3(out.middle + scale * (toEigen(v) - out.middle));
  return out;
}

SolidHandle hullSolid(const Eigen::Matrix3Xd &points, const Stop &stop = {}) {
  const Hull hull = hullOf(points, stop);
  return meshSolid(hull.vertices, hull.triangles);
}

/* ---- what has no formula, or is enlarged ---- */

/* Directions in which a convex body is looked at, on a Fibonacci sphere, and in the plane. */
constexpr int DIRECTIONS = 200, PLANAR_DIRECTIONS = 64;

/* Of the proof that a polytope contains a body: its width as a fraction of the body's size, and its cells. */
constexpr double PROVEN_WITHIN = 1e-3;
constexpr int PROOF_CELLS = 20000;

SupportFunction bodySupport(const BodyHandle &body) {
  return [body](const Eigen::Vector3d &direction, Eigen::Vector3d &point) {
    cprox_vec3 at;
    const double height = cprox_body_support(body.get(), toVec3(direction), &at);
    point = toEigen(at);
    return height;
  };
}

/* Asks once in each direction. */
SupportFunction remembered(const SupportFunction &support) {
  struct Answer {
    double height;
    Eigen::Vector3d point;
  };
  const auto known = std::make_shared<std::map<std::array<double, 3>, Answer>>();
  return [support, known](const Eigen::Vector3d &u, Eigen::Vector3d &point) {
    const auto [at, is_new] = known->try_emplace({u.x(), u.y(), u.z()});
    if (is_new) at->second.height = support(u, at->second.point);
    point = at->second.point;
    return at->second.height;
  };
}

SupportFunction enlarged(const SupportFunction &support, double by) {
  return [support, by](const Eigen::Vector3d &direction, Eigen::Vector3d &point) {
    const double height = support(direction, point);
    point += by * direction;
    return height + by;
  };
}

Eigen::Matrix3Xd reached(const SupportFunction &support) {
  Eigen::Matrix3Xd points(3, DIRECTIONS);
  const double golden = M_PI * (3.0 - std::sqrt(5.0));
  for (int i = 0; i < DIRECTIONS; ++i) {
    const double z = 1.0 - (2.0 * i + 1.0) / DIRECTIONS, r = std::sqrt(1.0 - z * z);
    Eigen::Vector3d point;
    support({r * std::cos(golden * i), r * std::sin(golden * i), z}, point);
    points.col(i) = point;
  }
  return points;
}

/* A polytope that contains the body and all within `padding` of it: the hull of what it reaches in some directions,
 * with a padding that grows until the support functions prove it. */
SolidHandle polytopeRound(const BodyHandle &body, double padding) {
  // Of an implicit body a support is a convex program.
  const SupportFunction support = remembered(bodySupport(body)), whole = enlarged(support, padding);
  const double size = cprox_body_get_info(body.get()).radius + padding, within = PROVEN_WITHIN * size;
  // Where many directions reach one corner, what is added keeps their points apart.
  double more = padding > 0.0 ? 0.0 : 0.1 * within;
  for (int i = 0; i < 20; ++i) {
    const Hull hull = hullOf(reached(enlarged(support, padding + more)));
    Eigen::Matrix3Xd corners(3, static_cast<Eigen::Index>(hull.vertices.size()));
    for (std::size_t k = 0; k < hull.vertices.size(); ++k)
      corners.col(static_cast<Eigen::Index>(k)) = toEigen(hull.vertices[k]);
    const double out = supportGap(whole, bodySupport(makePolytope(corners)), within, PROOF_CELLS) + 1e-10 * size;
    if (out <= 0.0) return meshSolid(hull.vertices, hull.triangles);
    more += 1.1 * out + 0.1 * within;
  }
  throw Error("no polytope was found that contains it");
}

/* ---- intersections of halfspaces ---- */

/* n·x <= h, with n of length 1, in coordinates about the body's centre; the body is within `radius` of it. */
struct Halfspaces {
  Halfspaces(const std::vector<std::array<double, 4>> &planes, const BodyHandle &body) {
    const cprox_body_info info = cprox_body_get_info(body.get());
    centre = toEigen(info.centre);
    radius = info.radius;
    for (const std::array<double, 4> &p : planes) {
      const Eigen::Vector3d b(p[0], p[1], p[2]);
      if (b.isZero(0.0)) continue;
      normals.push_back(b.normalized());
      heights.push_back((-p[3] - b.dot(centre)) / b.norm());
    }
  }
  Eigen::Vector3d centre;
  double radius;
  std::vector<Eigen::Vector3d> normals;
  std::vector<double> heights;
};

/* Triples of planes that are solved for their common point are so many at most. */
constexpr std::size_t MOST_PLANES = 100;

/* Where three planes meet and no other cuts the point off, about the centre. Where more than three planes meet their
 * points are one. */
std::vector<Eigen::Vector3d> cornersOf(const Halfspaces &set) {
  constexpr double PARALLEL = 1e-9, NEAR = 1e-9, ROUND = 1e-14;
  std::vector<Eigen::Vector3d> out;
  const auto &n = set.normals;
  const auto add = [&](std::size_t i, std::size_t j, std::size_t k) {
    const Eigen::Vector3d jk = n[j].cross(n[k]), ki = n[k].cross(n[i]), ij = n[i].cross(n[j]);
    const double determinant = n[i].dot(jk);
    if (!(std::fabs(determinant) > PARALLEL)) return;
    const Eigen::Vector3d x = (set.heights[i] * jk + set.heights[j] * ki + set.heights[k] * ij) / determinant;
    const double within = (NEAR + ROUND / std::fabs(determinant)) * set.radius;
    if (!(x.norm() <= 2.0 * set.radius)) return;
    for (std::size_t m = 0; m < n.size(); ++m)
      if (!(n[m].dot(x) <= set.heights[m] + within)) return;
    for (const Eigen::Vector3d &other : out)
      if ((x - other).norm() <= NEAR * set.radius) return;
    out.push_back(x);
  };
  for (std::size_t i = 0; i < n.size(); ++i)
    for (std::size_t j = i + 1; j < n.size(); ++j)
      for (std::size_t k = j + 1; k < n.size(); ++k) add(i, j, k);
  return out;
}

/* The polytope of the corners, scaled about its middle until it contains the intersection: along a face's normal m no
 * point of that is beyond any h + |m - n| r, where r is how far it reaches from the middle. */
Hull hullOf(const Halfspaces &set) {
  const std::vector<Eigen::Vector3d> corners = cornersOf(set);
  if (corners.size() < 4) throw Error("its planes have no corners");
  Eigen::Matrix3Xd points(3, static_cast<Eigen::Index>(corners.size()));
  for (std::size_t i = 0; i < corners.size(); ++i) points.col(static_cast<Eigen::Index>(i)) = corners[i];
  Hull out = hullOf(points);
  const double reach = set.radius + out.middle.norm();
  double scale = 1.0;
  for (const auto &t : out.triangles) {
    const Eigen::Vector3d a = toEigen(out.vertices[t[0]]);
    const Eigen::Vector3d m = (toEigen(out.vertices[t[1]]) - a).cross(toEigen(out.vertices[t[2]]) - a).normalized();
    double height = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < set.normals.size(); ++i)
      height = std::min(height, set.heights[i] - set.normals[i].dot(out.middle) + (m - set.normals[i]).norm() * reach);
    scale = std::max(scale, height / m.dot(a - out.middle));
  }
  for (cprox_vec3 &v : out.vertices)
    v = toVec3(set.centre + out.middle + (1.0 + 1e-12) * scale * (toEigen(v) - out.middle));
  return out;
}

/* Planes alone make a polytope; whatever else is in the intersection, its directions are looked at. */
SolidHandle implicitSolid(const ConstraintBody::Part &part, double padding) {
  const ShapeDescription &shape = part.shape;
  if (shape.deformed || !shape.quadrics.empty() || !shape.hyperquadrics.empty() || shape.planes.size() > MOST_PLANES)
    return polytopeRound(part.body, padding);
  const Hull hull = hullOf(Halfspaces(shape.planes, part.body));
  if (padding == 0.0) return meshSolid(hull.vertices, hull.triangles);
  Eigen::Matrix3Xd corners(3, static_cast<Eigen::Index>(hull.vertices.size()));
  for (std::size_t k = 0; k < hull.vertices.size(); ++k)
    corners.col(static_cast<Eigen::Index>(k)) = toEigen(hull.vertices[k]);
  return polytopeRound(makePolytope(corners), padding);
}

/* ---- the plane ---- */

using Point = std::array<double, 2>;

SolidHandle loopSolid(const std::vector<Point> &corners) {
  cprox_solid_description solid{};
  solid.kind = CPROX_SOLID_POLYGON;
  solid.corners = reinterpret_cast<const double(*)[2]>(corners.data());
  solid.n = corners.size();
  return makeSolid(solid);
}

/* The hull of planar points, counter-clockwise (Andrew's chains). */
SolidHandle polygonSolid(std::vector<Point> sorted) {
  std::vector<Point> hull;
  std::sort(sorted.begin(), sorted.end());
  sorted.erase(std::unique(sorted.begin(), sorted.end()), sorted.end());
  const auto turns_right = [](const Point &a, const Point &b, const Point &c) {
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]) <= 0.0;
  };
  for (int chain = 0; chain < 2; ++chain, std::reverse(sorted.begin(), sorted.end())) {
    const std::size_t begin = hull.size();
    for (const Point &p : sorted) {
      while (hull.size() >= begin + 2 && turns_right(hull[hull.size() - 2], hull.back(), p)) hull.pop_back();
      hull.push_back(p);
    }
    hull.pop_back();
  }
  if (hull.size() < 3) throw Error("the hull of its vertices has no interior");
  return loopSolid(hull);
}

std::vector<Point> planarPoints(const Eigen::Matrix3Xd &points) {
  std::vector<Point> out;
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    if (points(2, i) != 0.0) throw Error("in the plane vertices have z = 0");
    out.push_back({points(0, i), points(1, i)});
  }
  return out;
}

/* In the plane: where the tangents of neighbouring directions meet. */
SolidHandle polygonRound(const BodyHandle &body, double padding) {
  const SupportFunction whole = enlarged(bodySupport(body), padding);
  const double step = 2.0 * M_PI / PLANAR_DIRECTIONS;
  std::vector<double> heights;
  Eigen::Vector3d point;
  for (int i = 0; i < PLANAR_DIRECTIONS; ++i)
    heights.push_back(whole({std::cos(step * i), std::sin(step * i), 0.0}, point));
  std::vector<Point> corners;
  for (int i = 0; i < PLANAR_DIRECTIONS; ++i) {
    const double here = heights[static_cast<std::size_t>(i)],
                 next = heights[static_cast<std::size_t>((i + 1) % PLANAR_DIRECTIONS)];
    const double along = (next - here * std::cos(step)) / std::sin(step); // from the foot of this tangent
    corners.push_back({here * std::cos(step * i) - along * std::sin(step * i),
                       here * std::sin(step * i) + along * std::cos(step * i)});
  }
  return polygonSolid(corners);
}

/* Semi-axes of an ellipsoid that contains all within p of the one with semi-axes a: for any c > 0
 * (h + p)² <= (1 + c) h² + (1 + 1/c) p², and h² = sum a_i² u_i². */
cprox_vec3 enlargedAxes(const std::vector<double> &a, int dimension, double p) {
  if (p == 0.0) return {a.at(0), a.at(1), a.at(2)};
  const double mean = dimension == 2 ? std::sqrt(a.at(0) * a.at(1)) : std::cbrt(a.at(0) * a.at(1) * a.at(2));
  const double c = p / mean;
  const auto axis = [&](double x) { return std::sqrt((1.0 + c) * x * x + (1.0 + 1.0 / c) * p * p) * (1.0 + 1e-14); };
  return {axis(a[0]), axis(a[1]), axis(a[2])};
}

/* Twice the area of a loop, positive counter-clockwise, and whether it never turns to the right then. */
double area2(const std::vector<Point> &loop) {
  double sum = 0.0;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const Point &p = loop[i], &q = loop[(i + 1) % loop.size()];
    sum += (p[0] - loop[0][0]) * (q[1] - loop[0][1]) - (q[0] - loop[0][0]) * (p[1] - loop[0][1]);
  }
  return sum;
}

bool isConvex(const std::vector<Point> &loop) {
  const std::size_t n = loop.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Point &a = loop[i], &b = loop[(i + 1) % n], &c = loop[(i + 2) % n];
    if ((b[0] - a[0]) * (c[1] - b[1]) - (b[1] - a[1]) * (c[0] - b[0]) < 0.0) return false;
  }
  return true;
}

/* A loop as it is, with padding also capsules along its edges. */
SolidHandle loopWithRim(const std::vector<Point> &loop, double padding) {
  const SolidHandle inside = loopSolid(loop);
  if (padding == 0.0) return inside;
  Vertices edges;
  for (std::size_t i = 0; i <= loop.size(); ++i)
    edges.push_back({loop[i % loop.size()][0], loop[i % loop.size()][1], 0.0});
  cprox_solid_description rim{};
  rim.kind = CPROX_SOLID_POLYLINE;
  rim.dimension = 2;
  rim.points = edges.data();
  rim.n = edges.size();
  rim.radius = padding;
  return makeUnion({inside, makeSolid(rim)}, {CPROX_POSE_IDENTITY, CPROX_POSE_IDENTITY});
}

/* An outline, convex or not, as it is; with padding all within it of a convex one. */
SolidHandle outlineSolid(const ConstraintBody::Part &part, double padding) {
  std::vector<Point> loop = planarPoints(part.shape.vertices);
  if (area2(loop) < 0.0) std::reverse(loop.begin(), loop.end());
  if (isConvex(loop)) return padding > 0.0 ? polygonRound(part.body, padding) : polygonSolid(std::move(loop));
  return loopWithRim(loop, padding);
}

/* ---- clouds and octrees ---- */

/* Cells along the longest side of a grid. */
constexpr double CELLS_ACROSS = 64.0;

/* The cells of a grid that meet one of the boxes, each enlarged by the padding. */
SolidHandle gridSolid(const Boxes &boxes, double padding, int dimension) {
  const Eigen::Vector3d low = boxes.low.rowwise().minCoeff().array() - padding,
                        high = boxes.high.rowwise().maxCoeff().array() + padding;
  const double size = (high - low).maxCoeff(), rounding = 1e-12 * std::max(low.norm(), high.norm());
  const double cell = std::max(size, rounding) / CELLS_ACROSS;
  if (!(cell > 0.0)) throw Error("it has no size");
  const Eigen::Vector3d lowest = low.array() - 0.5 * cell;

  std::array<Eigen::Index, 3> counts{1, 1, 1};
  for (int i = 0; i < dimension; ++i) counts.at(i) = static_cast<Eigen::Index>((high - lowest)[i] / cell) + 2;
  std::vector<unsigned char> occupied(static_cast<std::size_t>(counts[0] * counts[1] * counts[2]));
  for (Eigen::Index b = 0; b < boxes.low.cols(); ++b) {
    std::array<Eigen::Index, 3> from{0, 0, 0}, to{0, 0, 0};
    for (int i = 0; i < dimension; ++i) {
      from.at(i) = static_cast<Eigen::Index>((boxes.low(i, b) - padding - rounding - lowest[i]) / cell);
      to.at(i) = static_cast<Eigen::Index>((boxes.high(i, b) + padding + rounding - lowest[i]) / cell);
    }
    for (Eigen::Index z = from[2]; z <= to[2]; ++z)
      for (Eigen::Index y = from[1]; y <= to[1]; ++y)
        for (Eigen::Index x = from[0]; x <= to[0]; ++x)
          occupied[static_cast<std::size_t>(x + counts[0] * (y + counts[1] * z))] = 1;
  }
  cprox_solid_description grid{};
  grid.kind = CPROX_SOLID_GRID;
  grid.dimension = dimension;
  grid.lowest = {lowest.x(), lowest.y(), dimension == 2 ? 0.0 : lowest.z()};
  grid.cell = cell;
  for (std::size_t i = 0; i < 3; ++i) grid.counts[i] = static_cast<std::uint32_t>(counts.at(i));
  grid.occupied = occupied.data();
  return makeSolid(grid);
}

SolidHandle cloudSolid(const ShapeDescription &shape, double padding, int dimension) {
  if (dimension == 2 && !shape.vertices.row(2).isZero(0.0)) throw Error("in the plane points have z = 0");
  return gridSolid({shape.vertices, shape.vertices}, padding + (shape.dimensions.empty() ? 0.0 : shape.dimensions[0]),
                   dimension);
}

/* A box about each cell of a height field: from the floor, or from its lowest corner, to its highest. */
SolidHandle groundSolid(const ShapeDescription &shape, double padding) {
  const std::vector<double> &d = shape.dimensions;
  const auto across = static_cast<std::size_t>(d.at(2)), along = static_cast<std::size_t>(d.at(3));
  if (shape.values.size() != across * along || across < 2 || along < 2) throw Error("it has no cells");
  Boxes boxes;
  const auto cells = static_cast<Eigen::Index>((across - 1) * (along - 1));
  boxes.low.resize(3, cells), boxes.high.resize(3, cells);
  Eigen::Index k = 0;
  for (std::size_t j = 0; j + 1 < along; ++j)
    for (std::size_t i = 0; i + 1 < across; ++i, ++k) {
      const double *row = &shape.values[j * across + i];
      const auto [lowest, highest] = std::minmax({row[0], row[1], row[across], row[across + 1]});
      if (!std::isfinite(lowest + highest)) throw Error("its heights must be finite");
      const double x = d[0] * static_cast<double>(i), y = d[1] * static_cast<double>(j);
      boxes.low.col(k) << x, y, d.size() > 4 ? d[4] : lowest;
      boxes.high.col(k) << x + d[0], y + d[1], highest;
    }
  return gridSolid(boxes, padding, 3);
}

SolidHandle coneSolid(double height, double radius) {
  const double r = radius / std::cos(M_PI / SIDES);
  Eigen::Matrix3Xd points(3, SIDES + 1);
  for (int i = 0; i < SIDES; ++i)
    points.col(i) << r * std::cos(2.0 * M_PI * i / SIDES), r * std::sin(2.0 * M_PI * i / SIDES), -0.5 * height;
  points.col(SIDES) << 0.0, 0.0, 0.5 * height;
  return hullSolid(points);
}

/* Vertices at one place are one: files of triangles repeat them. */
void weld(const ShapeDescription &shape, Vertices &vertices, Corners &triangles) {
  Eigen::Vector3d scale = Eigen::Vector3d::Ones();
  if (shape.dimensions.size() == 3) scale = Eigen::Vector3d(shape.dimensions.data());
  std::vector<std::uint32_t> numbers;
  std::map<std::array<double, 3>, std::uint32_t> known;
  for (Eigen::Index i = 0; i < shape.vertices.cols(); ++i) {
    const Eigen::Vector3d v = scale.cwiseProduct(shape.vertices.col(i));
    const auto [at, is_new] =
        known.emplace(std::array<double, 3>{v.x(), v.y(), v.z()}, static_cast<std::uint32_t>(vertices.size()));
    if (is_new) vertices.push_back(toVec3(v));
    numbers.push_back(at->second);
  }
  const bool mirrored = scale.prod() < 0.0;
  for (Eigen::Index i = 0; i < shape.triangles.cols(); ++i) {
    const auto corner = [&](int k) { return numbers[static_cast<std::size_t>(shape.triangles(k, i))]; };
    triangles.push_back({corner(0), corner(mirrored ? 2 : 1), corner(mirrored ? 1 : 2)});
  }
}

SolidHandle meshOf(const ShapeDescription &shape) {
  Vertices vertices;
  Corners triangles;
  weld(shape, vertices, triangles);
  return meshSolid(vertices, triangles);
}

/* What the plane z = 0 cuts out of a closed mesh, counter-clockwise: a vertex at z = 0 counts as above. A triangle that
 * is cut leads from its edge that goes down to its edge that goes up. */
std::vector<std::vector<Point>> sectionOf(const ShapeDescription &shape) {
  Vertices vertices;
  Corners triangles;
  weld(shape, vertices, triangles);
  using Edge = std::array<std::uint32_t, 2>; // above, below
  std::map<Edge, Edge> next;
  for (const auto &t : triangles) {
    std::optional<Edge> down, up;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t from = t[k], to = t[(k + 1) % 3];
      const bool above = vertices[from].z >= 0.0;
      if (above == (vertices[to].z >= 0.0)) continue;
      if (above)
        down = Edge{from, to};
      else
        up = Edge{to, from};
    }
    if (down && !next.emplace(*down, *up).second) throw Error("its surface is not closed");
  }
  if (next.empty()) throw Error("it does not meet the plane z = 0");
  std::vector<std::vector<Point>> out;
  while (!next.empty()) {
    std::vector<Point> loop;
    const Edge begin = next.begin()->first;
    Edge at = begin;
    for (auto step = next.begin(); step != next.end(); step = next.find(at)) {
      const cprox_vec3 &a = vertices[at[0]], &b = vertices[at[1]];
      const double part = a.z / (a.z - b.z);
      const Point p = {a.x + part * (b.x - a.x), a.y + part * (b.y - a.y)};
      if (loop.empty() || loop.back() != p) loop.push_back(p);
      at = step->second;
      next.erase(step);
    }
    if (at != begin) throw Error("its surface is not closed");
    if (loop.size() > 1 && loop.front() == loop.back()) loop.pop_back();
    if (loop.size() < 3 || area2(loop) == 0.0) continue; // it touches the plane
    out.push_back(std::move(loop));
  }
  return out;
}

/* In the plane a mesh is its section. */
SolidHandle sectionSolid(const ShapeDescription &shape, double padding) {
  std::vector<SolidHandle> parts;
  for (const std::vector<Point> &loop : sectionOf(shape)) {
    if (area2(loop) < 0.0)
      throw Error("its section at z = 0 has a hole, or its surface looks inwards: give convex parts");
    parts.push_back(loopWithRim(loop, padding));
  }
  if (parts.empty()) throw Error("it does not meet the plane z = 0");
  return parts.size() == 1 ? parts.front()
                           : makeUnion(parts, std::vector<cprox_pose>(parts.size(), CPROX_POSE_IDENTITY));
}

SolidHandle planarSolid(const ConstraintBody::Part &part, double padding) {
  const ShapeDescription &shape = part.shape;
  const std::vector<double> &d = shape.dimensions;
  cprox_solid_description solid{};
  solid.dimension = 2;
  switch (shape.type) {
    case ShapeType::SPHERE:
      solid.kind = CPROX_SOLID_BALL;
      solid.radius = d.at(0) + padding;
      return makeSolid(solid);
    case ShapeType::BOX:
      if (padding > 0.0) return polygonRound(part.body, padding);
      solid.kind = CPROX_SOLID_BOX;
      solid.size = {d.at(0), d.at(1), d.at(2)};
      return makeSolid(solid);
    case ShapeType::ELLIPSOID:
      solid.kind = CPROX_SOLID_ELLIPSOID;
      solid.semi_axes = enlargedAxes(d, 2, padding);
      return makeSolid(solid);
    case ShapeType::CYLINDER: // along z: their sections at z = 0 are discs
    case ShapeType::CAPSULE:
      solid.kind = CPROX_SOLID_BALL;
      solid.radius = d.at(1) + padding;
      return makeSolid(solid);
    case ShapeType::CONE: // half as wide at z = 0; what is padded is wider there by the padding over a cosine at most
      solid.kind = CPROX_SOLID_BALL;
      solid.radius = 0.5 * d.at(1) + padding * std::hypot(1.0, d.at(1) / d.at(0)) * (1.0 + 1e-14);
      return makeSolid(solid);
    case ShapeType::POLYGON: return outlineSolid(part, padding);
    case ShapeType::POINTS: return cloudSolid(shape, padding, 2);
    case ShapeType::POLYTOPE: {
      std::vector<Point> corners = planarPoints(shape.vertices);
      return padding > 0.0 ? polygonRound(part.body, padding) : polygonSolid(std::move(corners));
    }
    case ShapeType::SUPERQUADRIC:
      if (shape.deformed) throw Error("FourierGap takes no deformed bodies in the plane");
      return polygonRound(part.body, padding); // its shadow is its section
    case ShapeType::MESH: return sectionSolid(loadedShape(shape, {}), padding);
    case ShapeType::HALFSPACE: throw Error(ENDLESS);
    default: throw Error("FourierGap has no solid for it in the plane");
  }
}

SolidHandle spatialSolid(const ConstraintBody::Part &part, double padding, const Stop &stop) {
  const ShapeDescription &shape = part.shape;
  const std::vector<double> &d = shape.dimensions;
  cprox_solid_description solid{};
  solid.dimension = 3;
  switch (shape.type) {
    case ShapeType::SPHERE:
      solid.kind = CPROX_SOLID_BALL;
      solid.radius = d.at(0) + padding;
      return makeSolid(solid);
    case ShapeType::BOX:
      solid.kind = CPROX_SOLID_BOX;
      solid.size = {d.at(0) + 2.0 * padding, d.at(1) + 2.0 * padding, d.at(2) + 2.0 * padding};
      return makeSolid(solid);
    case ShapeType::ELLIPSOID:
      solid.kind = CPROX_SOLID_ELLIPSOID;
      solid.semi_axes = enlargedAxes(d, 3, padding);
      return makeSolid(solid);
    case ShapeType::CYLINDER:
      solid.kind = CPROX_SOLID_CYLINDER;
      solid.height = d.at(0) + 2.0 * padding;
      solid.radius = d.at(1) + padding;
      return makeSolid(solid);
    case ShapeType::CAPSULE:
      solid.kind = CPROX_SOLID_CAPSULE;
      solid.height = d.at(0);
      solid.radius = d.at(1) + padding;
      return makeSolid(solid);
    case ShapeType::CONE: return padding > 0.0 ? polytopeRound(part.body, padding) : coneSolid(d.at(0), d.at(1));
    case ShapeType::POLYTOPE:
      return padding > 0.0 ? polytopeRound(part.body, padding) : hullSolid(shape.vertices, stop);
    case ShapeType::MESH:
      return padding > 0.0 ? polytopeRound(part.body, padding + part.excess) : meshOf(loadedShape(shape, {}));
    case ShapeType::POINTS: return cloudSolid(shape, padding, 3);
    case ShapeType::OCTREE: return gridSolid(octreeBoxes(shape), padding, 3);
    case ShapeType::HEIGHT_FIELD: return groundSolid(shape, padding);
    case ShapeType::SUPERQUADRIC: return polytopeRound(part.body, padding);
    case ShapeType::IMPLICIT: return implicitSolid(part, padding);
    case ShapeType::HALFSPACE: throw Error(ENDLESS);
    default: throw Error("FourierGap has no solid for it in space");
  }
}

} // namespace

SolidHandle makeSolid(const ConstraintBody &side, int dimension, const Stop &stop) {
  if (side.parts.empty()) throw Error("the side has no shape");
  if (!(side.padding >= 0.0)) throw Error("the padding must be finite and at least 0");
  std::vector<SolidHandle> parts;
  std::vector<cprox_pose> poses;
  bool moved = false;
  for (const ConstraintBody::Part &part : side.parts) {
    try {
      parts.push_back(dimension == 2 ? planarSolid(part, side.padding) : spatialSolid(part, side.padding, stop));
    } catch (const Error &error) {
      throw Error(std::string(shapeTypeName(part.shape.type)) + ": " + error.what(), error.status());
    }
    poses.push_back(toPose(part.shape.pose));
    moved = moved || !part.shape.pose.matrix().isIdentity(0.0);
  }
  if (parts.size() == 1 && !moved) return parts.front();
  return makeUnion(parts, poses);
}

} // namespace curve_proximity
