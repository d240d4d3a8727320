/* SPDX-License-Identifier: BSD-3-Clause */
/* Solids of gaps contain what they are made of, with its padding, and not much more. */
#include "solids.h"

#include "support.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>

namespace curve_proximity {
namespace {

double measureOf(const ShapeDescription &s, double padding, int dimension = 3) {
  return cprox_solid_get_info(makeSolid(side({s}, padding), dimension).get()).measure;
}

/* The volume of a convex body and all within p of it, from its volume, surface and mean width (Steiner). */
double steiner(double volume, double surface, double width, double p) {
  return volume + surface * p + 2.0 * M_PI * width * p * p + 4.0 / 3.0 * M_PI * p * p * p;
}

ShapeDescription cube(double edge) {
  Eigen::Matrix3Xd corners(3, 8);
  for (int i = 0; i < 8; ++i)
    corners.col(i) = 0.5 * edge * Eigen::Vector3d(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
  return polytope(corners);
}

/* Of a polytope that contains a body the volume is at least that of the body; 12 % more is what 200 directions leave.
 */
void expectRound(const ShapeDescription &s, double padding, double volume) {
  const double measure = measureOf(s, padding);
  EXPECT_GE(measure, volume * (1.0 - 1e-12)) << shapeTypeName(s.type) << " " << padding;
  EXPECT_LE(measure, 1.12 * volume) << shapeTypeName(s.type) << " " << padding;
}

TEST(Solids, with_padding_hold_the_volume_of_the_enlarged_body_and_not_much_more) {
  for (const double p : {0.02, 0.1, 0.5}) {
    EXPECT_NEAR(measureOf(shape(ShapeType::SPHERE, {0.3}), p), 4.0 / 3.0 * M_PI * std::pow(0.3 + p, 3), 1e-12);
    EXPECT_NEAR(measureOf(shape(ShapeType::CAPSULE, {0.6, 0.2}), p),
                M_PI * std::pow(0.2 + p, 2) * 0.6 + 4.0 / 3.0 * M_PI * std::pow(0.2 + p, 3), 1e-12);
    expectRound(cube(0.6), p, steiner(0.216, 6 * 0.36, 0.9, p));
    expectRound(shape(ShapeType::SUPERQUADRIC, {0.3, 0.3, 0.3, 2, 2, 2}), p, 4.0 / 3.0 * M_PI * std::pow(0.3 + p, 3));
    EXPECT_GE(measureOf(shape(ShapeType::BOX, {0.6, 0.6, 0.6}), p), steiner(0.216, 6 * 0.36, 0.9, p));
    EXPECT_GE(measureOf(shape(ShapeType::CYLINDER, {0.6, 0.2}), p),
              steiner(0.6 * M_PI * 0.04, M_PI * (2 * 0.04 + 0.24), 0.5 * (0.6 + M_PI * 0.2), p));
    EXPECT_GE(measureOf(shape(ShapeType::ELLIPSOID, {0.3, 0.3, 0.3}), p),
              4.0 / 3.0 * M_PI * std::pow(0.3 + p, 3) * (1.0 - 1e-12));
  }
}

TEST(Solids, of_superquadrics_and_flat_polytopes_hold_their_volume) {
  expectRound(shape(ShapeType::SUPERQUADRIC, {0.3, 0.2, 0.5, 2, 2, 2}), 0.0, 4.0 / 3.0 * M_PI * 0.03);
  expectRound(shape(ShapeType::SUPERQUADRIC, {0.3, 0.2, 0.5, 1, 1, 1}), 0.0, 4.0 / 3.0 * 0.03); // an octahedron
  Eigen::Matrix3Xd square(3, 4);
  square << 0.5, -0.5, -0.5, 0.5, 0.5, 0.5, -0.5, -0.5, 0, 0, 0, 0;
  expectRound(polytope(square), 0.1, steiner(0.0, 2.0, 1.0, 0.1));
}

/* ---- intersections of planes ---- */

/* b·x + c <= 0 for x at R x0 + p where b0·x0 + c0 <= 0. */
std::array<double, 4> placed(const Eigen::Vector3d &b, double c, const Eigen::Matrix3d &r, const Eigen::Vector3d &p,
                             double factor) {
  const Eigen::Vector3d turned = r * b;
  return {factor * turned.x(), factor * turned.y(), factor * turned.z(), factor * (c - turned.dot(p))};
}

struct Polyhedron {
  std::vector<std::pair<Eigen::Vector3d, double>> planes; /* b·x + c <= 0 */
  double volume;
};

/* A prism of height 1, or a pyramid with that many planes through its tip, over a regular polygon of radius 1 in z = 0.
 */
Polyhedron overPolygon(int sides, bool pyramid) {
  const double step = 2.0 * M_PI / sides, inner = std::cos(0.5 * step), area = 0.5 * sides * std::sin(step);
  Polyhedron out{{{{0, 0, -1}, 0.0}}, pyramid ? area / 3.0 : area};
  if (!pyramid) out.planes.push_back({{0, 0, 1}, -1.0});
  for (int i = 0; i < sides; ++i)
    out.planes.push_back({{std::cos(step * i), std::sin(step * i), pyramid ? inner : 0.0}, -inner});
  return out;
}

/* Planes of any length, in any order, moved and turned, some twice, some that touch a corner only: the volume is that
 * of the exact corners. Seed 4711, 40 of each kind. The bound is 1e-9 of the size for corners that are one. */
TEST(Solids, of_planes_hold_the_volume_between_them) {
  Random random(4711);
  for (int round = 0; round < 80; ++round) {
    const int sides = 3 + round / 2 % 10;
    const Polyhedron body = overPolygon(sides, round % 2 == 0);
    const Eigen::Matrix3d r = random.rotation().toRotationMatrix();
    const Eigen::Vector3d p = random.inCube(round % 3 == 0 ? 0.0 : 5.0);
    ShapeDescription s;
    s.type = ShapeType::IMPLICIT;
    for (const auto &[b, c] : body.planes) s.planes.push_back(placed(b, c, r, p, random.uniform(0.01, 100.0)));
    s.planes.push_back(placed(body.planes.back().first, body.planes.back().second, r, p, 2.0));
    if (round % 2 == 0) s.planes.push_back(placed({0, 0, 1}, -1.0, r, p, 1.0)); // touches the tip
    std::shuffle(s.planes.begin(), s.planes.end(), std::mt19937(static_cast<unsigned>(round)));
    const double measure = measureOf(s, 0.0);
    EXPECT_GE(measure, body.volume * (1.0 - 1e-12)) << sides << " sides";
    EXPECT_LE(measure, body.volume * (1.0 + 1e-6)) << sides << " sides";
  }
}

TEST(Solids, of_planes_with_padding_and_of_other_implicit_bodies_with_corners_hold_their_volume) {
  ShapeDescription block;
  block.type = ShapeType::IMPLICIT;
  block.planes = {{1, 0, 0, -0.3},  {-1, 0, 0, -0.3}, {0, 1, 0, -0.3},
                  {0, -1, 0, -0.3}, {0, 0, 1, -0.3},  {0, 0, -1, -0.3}};
  EXPECT_NEAR(measureOf(block, 0.0), 0.216, 1e-9);
  expectRound(block, 0.1, steiner(0.216, 6 * 0.36, 0.9, 0.1));
  ShapeDescription cylinder;
  cylinder.type = ShapeType::IMPLICIT;
  cylinder.quadrics = {{1, 0, 0, 1, 0, 0, 0, 0, 0, -0.25}};
  cylinder.planes = {{0, 0, 1, -0.5}, {0, 0, -1, -0.5}};
  expectRound(cylinder, 0.0, 0.25 * M_PI);
}

TEST(Solids, in_the_plane_hold_the_area_of_the_enlarged_body_and_not_much_more) {
  Eigen::Matrix3Xd square(3, 4);
  square << 0.5, -0.5, -0.5, 0.5, 0.5, 0.5, -0.5, -0.5, 0, 0, 0, 0;
  for (const double p : {0.02, 0.1, 0.5}) {
    const double area = 1.0 + 4.0 * p + M_PI * p * p;
    for (const ShapeDescription &s : {polytope(square), shape(ShapeType::BOX, {1, 1, 1})}) {
      EXPECT_GE(measureOf(s, p, 2), area * (1.0 - 1e-12));
      EXPECT_LE(measureOf(s, p, 2), 1.001 * area);
    }
  }
  const double disc = measureOf(shape(ShapeType::SUPERQUADRIC, {0.5, 0.5, 0.2, 2, 2, 2}), 0.0, 2);
  EXPECT_GE(disc, M_PI * 0.25);
  EXPECT_LE(disc, 1.001 * M_PI * 0.25);
}

ShapeDescription outlineOfL() {
  ShapeDescription out;
  out.type = ShapeType::POLYGON;
  out.vertices =
      (Eigen::Matrix3Xd(3, 6) << -0.5, 0.5, 0.5, -0.1, -0.1, -0.5, -0.5, -0.5, -0.1, -0.1, 0.5, 0.5, 0, 0, 0, 0, 0, 0)
          .finished();
  return out;
}

/* From a rectangle. */
double rectangleDistance(const Eigen::Vector2d &p, const Eigen::Vector2d &low, const Eigen::Vector2d &high) {
  const Eigen::Vector2d out = (low - p).cwiseMax(p - high);
  return out.cwiseMax(0.0).norm() + std::min(0.0, out.maxCoeff());
}

double distanceOfL(const Eigen::Vector2d &p) {
  return std::min(rectangleDistance(p, {-0.5, -0.5}, {0.5, -0.1}), rectangleDistance(p, {-0.5, -0.5}, {-0.1, 0.5}));
}

/* A case by the way of the service and the command line, with poses. */
ConstraintRow answered(ProviderSet &providers, const ShapeDescription &a, double padding, const ShapeDescription &b,
                       const Eigen::Vector3d &at, Workspace &workspace) {
  ConstraintCase asked;
  asked.a.shapes = {a};
  asked.a.padding = padding;
  asked.b.shapes = {b};
  asked.b.pose.translation() = at;
  return answerCase(providers, asked, {}, workspace).front();
}

/* Seed 841: a ball about an L, with and without padding; half of the places are on its surface. */
TEST(Outlines, that_are_not_convex_are_as_they_are_and_never_clear_in_an_overlap) {
  ProviderSet providers({{"gap", "curve_proximity/FourierGap", {{"dimension", 2}, {"samples", 65}}}});
  Workspace workspace;
  Random random(841);
  for (const double padding : {0.0, 0.05}) {
    int clear = 0, deep = 0;
    for (int i = 0; i < 600; ++i) {
      Eigen::Vector2d p(random.uniform(-1, 1), random.uniform(-1, 1));
      if (i % 2)
        for (int k = 0; k < 60; ++k) { // to a distance of 0.1, at most 1e-6 off
          const Eigen::Vector2d dx(1e-6, 0), dy(0, 1e-6);
          const Eigen::Vector2d slope((distanceOfL(p + dx) - distanceOfL(p - dx)) / 2e-6,
                                      (distanceOfL(p + dy) - distanceOfL(p - dy)) / 2e-6);
          p -= (distanceOfL(p) - 0.1 - padding) * slope;
        }
      const double distance = distanceOfL(p) - 0.1 - padding;
      const ConstraintRow row =
          answered(providers, outlineOfL(), padding, shape(ShapeType::SPHERE, {0.1}), {p.x(), p.y(), 0.0}, workspace);
      ASSERT_EQ(row.status, CPROX_OK) << row.message;
      if (distance < -1e-9) {
        EXPECT_LT(row.value.lower, 0.0) << p.transpose() << " overlaps by " << -distance;
      }
      clear += row.value.lower > 0.0, deep += distance < -1e-9;
    }
    EXPECT_GT(clear, 50);
    EXPECT_GT(deep, 50);
  }
  // 0.3 m from both arms, which the hull of the L takes for an overlap
  const ConstraintRow row =
      answered(providers, outlineOfL(), 0.0, shape(ShapeType::SPHERE, {0.1}), {0.3, 0.3, 0.0}, workspace);
  EXPECT_GT(row.value.lower, 0.0);
  ShapeDescription clockwise = outlineOfL();
  clockwise.vertices = outlineOfL().vertices.rowwise().reverse().eval();
  EXPECT_NEAR(
      answered(providers, clockwise, 0.0, shape(ShapeType::SPHERE, {0.1}), {0.3, 0.3, 0.0}, workspace).value.value,
      row.value.value, 1e-9);
}

/* Seed 844: in the plane a cylinder, a capsule and a cone along z are discs at z = 0, the cone one of half its radius. */
TEST(Sections, of_bodies_along_z_are_never_clear_in_an_overlap) {
  ProviderSet providers({{"gap", "curve_proximity/FourierGap", {{"dimension", 2}, {"samples", 33}}}});
  Workspace workspace;
  Random random(844);
  for (const auto &[s, radius] :
       {std::pair(shape(ShapeType::CYLINDER, {0.7, 0.4}), 0.4), std::pair(shape(ShapeType::CAPSULE, {0.7, 0.4}), 0.4),
        std::pair(shape(ShapeType::CONE, {0.7, 0.8}), 0.4)}) {
    int clear = 0, deep = 0;
    for (int i = 0; i < 200; ++i) {
      const Eigen::Vector3d at(random.uniform(-0.9, 0.9), random.uniform(-0.9, 0.9), 0.0);
      const double distance = at.norm() - radius - 0.1;
      const ConstraintRow row = answered(providers, s, 0.0, shape(ShapeType::SPHERE, {0.1}), at, workspace);
      ASSERT_EQ(row.status, CPROX_OK) << row.message;
      if (distance < -1e-9) {
        EXPECT_LT(row.value.lower, 0.0) << at.transpose();
      }
      if (distance > 0.1) {
        EXPECT_GT(row.value.lower, 0.0) << at.transpose();
      }
      clear += row.value.lower > 0.0, deep += distance < -1e-9;
    }
    EXPECT_GT(clear, 50);
    EXPECT_GT(deep, 30);
  }
}

/* Seed 845: a ball over hills with a floor. The truth is the distance of the triangles, by SuperquadricDistance, and the
 * height where the ball's middle is. */
/* An L that is drawn out along z, its caps at -h and h, turned about x. */
ShapeDescription prism(double h, double angle) {
  const double outline[6][2] = {{0, 0}, {1, 0}, {1, 0.4}, {0.4, 0.4}, {0.4, 1}, {0, 1}};
  ShapeDescription out;
  out.type = ShapeType::MESH;
  out.vertices.resize(3, 12);
  for (int i = 0; i < 12; ++i) out.vertices.col(i) << outline[i % 6][0], outline[i % 6][1], i < 6 ? -h : h;
  out.vertices = Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitX()).toRotationMatrix() * out.vertices;
  std::vector<std::array<int, 3>> triangles;
  for (int i = 1; i < 5; ++i) {
    triangles.push_back({0, i + 1, i});
    triangles.push_back({6, 6 + i, 7 + i});
  }
  for (int i = 0; i < 6; ++i) {
    const int j = (i + 1) % 6;
    triangles.push_back({i, j, 6 + j});
    triangles.push_back({i, 6 + j, 6 + i});
  }
  out.triangles.resize(3, static_cast<Eigen::Index>(triangles.size()));
  for (std::size_t i = 0; i < triangles.size(); ++i)
    for (int k = 0; k < 3; ++k)
      out.triangles(k, static_cast<Eigen::Index>(i)) = triangles[i][static_cast<std::size_t>(k)];
  return out;
}

std::string refusalOf(const ShapeDescription &s, int dimension) {
  try {
    measureOf(s, 0.0, dimension);
  } catch (const Error &error) {
    return error.what();
  }
  return "";
}

/* A wall that is cut at an angle has the area of its outline over the cosine; the hull would have .82. */
TEST(Sections, of_meshes_have_their_area) {
  for (const double angle : {0.0, 0.3, -0.8})
    EXPECT_NEAR(measureOf(prism(2.0, angle), 0.0, 2), 0.64 / std::cos(angle), 1e-12);
  EXPECT_GT(measureOf(prism(2.0, 0.0), 0.1, 2), 0.64 + 0.4);
  ShapeDescription through_corners = prism(2.0, 0.0); // z = 0 goes through the lower cap
  through_corners.vertices.row(2).array() += 2.0;
  EXPECT_EQ(refusalOf(through_corners, 2), "mesh: it does not meet the plane z = 0");
  through_corners.vertices.row(2).array() -= 4.0;
  EXPECT_NEAR(measureOf(through_corners, 0.0, 2), 0.64, 1e-12);
  ShapeDescription open = prism(2.0, 0.3);
  open.triangles.conservativeResize(3, open.triangles.cols() - 1);
  EXPECT_EQ(refusalOf(open, 2), "mesh: its surface is not closed");
  ShapeDescription inward = prism(2.0, 0.3);
  inward.triangles.row(0).swap(inward.triangles.row(1));
  EXPECT_EQ(refusalOf(inward, 2),
            "mesh: its section at z = 0 has a hole, or its surface looks inwards: give convex parts");
  for (const int dimension : {2, 3})
    EXPECT_EQ(refusalOf(shape(ShapeType::HALFSPACE, {0, 0, 1, 0}), dimension),
              "halfspace: it has no end, and a gap is periodic: give a box as large as what comes near it");
}

TEST(HeightFields, are_never_clear_in_an_overlap) {
  ProviderSet gaps({{"gap", "curve_proximity/FourierGap", {{"samples", 17}}}}),
      distances({{"distance", "curve_proximity/SuperquadricDistance", {{"epsilon", 1e-9}}}});
  Workspace workspace;
  Random random(845);
  ShapeDescription ground = shape(ShapeType::HEIGHT_FIELD, {0.2, 0.25, 7, 6, -0.5});
  for (int i = 0; i < 42; ++i) ground.values.push_back(random.uniform(-0.2, 0.2));
  int clear = 0, deep = 0;
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector3d at(random.uniform(-0.3, 1.5), random.uniform(-0.3, 1.5), random.uniform(-0.4, 1.3));
    const ShapeDescription ball = shape(ShapeType::SPHERE, {0.1});
    const ConstraintRow row = answered(gaps, ground, 0.0, ball, at, workspace),
                        truth = answered(distances, ground, 0.0, ball, at, workspace);
    ASSERT_EQ(row.status, CPROX_OK) << row.message;
    ASSERT_GE(truth.status, 0) << truth.message;
    const bool overlaps = truth.value.value < -1e-9 || truth.status == CPROX_OVERLAP;
    if (overlaps) {
      EXPECT_LT(row.value.lower, 0.0) << at.transpose();
    }
    clear += row.value.lower > 0.0, deep += overlaps;
  }
  EXPECT_GT(clear, 20);
  EXPECT_GT(deep, 30);
}

/* Seed 842: a cloud of balls, and a ball about it. */
TEST(Clouds, are_never_clear_in_an_overlap) {
  ProviderSet providers({{"gap", "curve_proximity/FourierGap", {{"samples", 17}}}});
  Workspace workspace;
  Random random(842);
  ShapeDescription cloud = shape(ShapeType::POINTS, {0.05});
  cloud.vertices.resize(3, 60);
  for (int i = 0; i < 60; ++i) cloud.vertices.col(i) = random.inCube(0.5).cwiseProduct(Eigen::Vector3d(1, 0.2, 1));
  int clear = 0, deep = 0;
  for (int i = 0; i < 300; ++i) {
    const Eigen::Vector3d at = random.inCube(1.2);
    const double distance = (cloud.vertices.colwise() - at).colwise().norm().minCoeff() - 0.05 - 0.1;
    const ConstraintRow row = answered(providers, cloud, 0.0, shape(ShapeType::SPHERE, {0.1}), at, workspace);
    ASSERT_EQ(row.status, CPROX_OK) << row.message;
    if (distance < -1e-9) {
      EXPECT_LT(row.value.lower, 0.0) << at.transpose() << " overlaps by " << -distance;
    }
    clear += row.value.lower > 0.0, deep += distance < -1e-9;
  }
  EXPECT_GT(clear, 50);
  EXPECT_GT(deep, 5);
}

/* Seed 843: cubic curves past a box: the value is the least of 400 along the curve, its gradient is that of
 * differences, and what is proven clear is. */
TEST(Curves, carry_a_solid_past_another) {
  const Loaded provider("curve_proximity/FourierGap", {{"samples", 9}});
  ConstraintPair pair;
  pair.along_curve = true;
  EXPECT_NE(messageOf([&] { provider->prepare(pair); }).find("give side a a shape"), std::string::npos);
  pair.a = side({shape(ShapeType::SPHERE, {0.2})});
  pair.b = side({shape(ShapeType::BOX, {0.5, 0.7, 0.6})});
  const auto constraint = provider->prepare(pair);
  Workspace workspace;
  Random random(843);
  int proven = 0;
  for (int i = 0; i < 12; ++i) {
    ConstraintCurve curve;
    ConstraintPlace place;
    place.curve = &curve;
    place.b = random.pose(0.2);
    curve.description.points.resize(3, 4);
    for (int k = 0; k < 4; ++k) curve.description.points.col(k) = random.inCube(0.8) + Eigen::Vector3d(0, 0, i % 3);
    const auto valueOf = [&](const Eigen::Matrix3Xd &points, ConstraintValue &value) {
      const Eigen::Matrix3Xd kept = curve.description.points;
      curve.description.points = points;
      curve.curve = compile(curve.description).curve;
      constraint->evaluate(place, workspace, value);
      curve.description.points = kept;
      return value.value;
    };
    ConstraintValue value, unused;
    valueOf(curve.description.points, value);
    proven += value.bounded;
    Eigen::Matrix3Xd step(3, 4);
    for (int k = 0; k < 4; ++k) step.col(k) = random.direction();
    const double h = 1e-5, slope = (valueOf(curve.description.points + h * step, unused) -
                                    valueOf(curve.description.points - h * step, unused)) /
                                   (2.0 * h);
    EXPECT_NEAR(value.points.cwiseProduct(step).sum(), slope, 1e-4 * (1.0 + std::abs(slope))) << i;

    // The same pair standing, at places of the curve.
    ConstraintPair standing = pair;
    standing.along_curve = false;
    const auto at = provider->prepare(standing);
    double least = std::numeric_limits<double>::infinity();
    valueOf(curve.description.points, value);
    for (int k = 0; k <= 100; ++k) {
      ConstraintPlace here;
      here.b = place.b;
      require(cprox_curve_evaluate(curve.curve.get(), 0.01 * k, workspace.get(), &here.a.position, nullptr, nullptr),
              workspace);
      at->evaluate(here, workspace, unused);
      least = std::min(least, unused.value);
    }
    EXPECT_LT(value.value, least + 1e-6);
    EXPECT_GT(value.value, least - 0.2 * (1.0 + std::abs(least)));
    if (value.bounded) {
      EXPECT_GE(least, value.lower);
    }
  }
  EXPECT_GT(proven, 2);
}

/* One occupied child of the root: the cube from (-1, -1, -1) to the origin. */
TEST(Octrees, are_the_cells_that_they_meet) {
  ShapeDescription tree;
  tree.type = ShapeType::OCTREE;
  tree.octree.resolution = 1.0 / 32768.0;
  tree.octree.data = std::string("\x02\x00", 2);
  const double measure = cprox_solid_get_info(makeSolid({{{tree, nullptr, 0.0, nullptr}}, 0.0}, 3).get()).measure;
  EXPECT_GE(measure, 1.0);
  EXPECT_LE(measure, 1.12);
  ProviderSet providers({{"gap", "curve_proximity/FourierGap", {{"samples", 17}}}});
  Workspace workspace;
  const ShapeDescription ball = shape(ShapeType::SPHERE, {0.1});
  EXPECT_LT(answered(providers, tree, 0.0, ball, {-0.05, -0.05, -0.05}, workspace).value.value, 0.0);
  EXPECT_GT(answered(providers, tree, 0.0, ball, {-0.5, -0.5, 1.5}, workspace).value.lower, 0.0);
  ShapeDescription other = tree; // another tree of the same size: not the one that is kept
  other.octree.data = std::string("\x08\x00", 2);
  EXPECT_GT(answered(providers, other, 0.0, ball, {-0.5, -0.5, 1.5}, workspace).value.lower, 0.0);
  EXPECT_GT(answered(providers, other, 0.0, ball, {-1.0, -0.5, -0.5}, workspace).value.value,
            answered(providers, tree, 0.0, ball, {-1.0, -0.5, -0.5}, workspace).value.value);
}

TEST(Files, of_meshes_are_read) {
  ProviderSet providers({{"gap", "curve_proximity/FourierGap", {{"samples", 9}}}});
  Workspace workspace;
  ShapeDescription cube;
  cube.type = ShapeType::MESH;
  cube.resource = ::testing::TempDir() + "cube.obj";
  std::ofstream(cube.resource) << "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 0 0 1\nv 1 0 1\nv 0 1 1\nv 1 1 1\n"
                                  "f 1 3 2\nf 2 3 4\nf 5 6 7\nf 6 8 7\nf 1 2 5\nf 2 6 5\nf 3 7 4\nf 4 7 8\n"
                                  "f 1 5 3\nf 3 5 7\nf 2 4 6\nf 4 8 6\n";
  EXPECT_NEAR(measureOf(cube, 0.0), 1.0, 1e-6);
  const ConstraintRow row = answered(providers, cube, 0.0, shape(ShapeType::SPHERE, {0.1}), {0.5, 0.5, 0.5}, workspace);
  ASSERT_EQ(row.status, CPROX_OK) << row.message;
  EXPECT_LT(row.value.value, 0.0);
  EXPECT_GT(answered(providers, cube, 0.0, shape(ShapeType::SPHERE, {0.1}), {2.5, 0.5, 0.5}, workspace).value.lower,
            0.0);
  std::remove(cube.resource.c_str());
}

} // namespace
} // namespace curve_proximity
