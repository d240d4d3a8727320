/* SPDX-License-Identifier: BSD-3-Clause */
/* Solids of gaps contain what they are made of, with its padding, and not much more. */
#include "solids.h"

#include "support.h"

#include <cmath>

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

} // namespace
} // namespace curve_proximity
