/* SPDX-License-Identifier: BSD-3-Clause */
/* Shapes of geometric_shapes are our shapes: which points they contain, against the bodies of geometric_shapes. */
#include <curve_proximity/geometric_shapes.hpp>

#include <geometric_shapes/body_operations.h>
#include <geometric_shapes/shape_operations.h>

#include "support.h"

using namespace curve_proximity;
using namespace curve_proximity::test;

namespace {

/* A cube of triangles, its middle beside the origin. */
std::shared_ptr<shapes::Mesh> cube() {
  auto out = std::make_shared<shapes::Mesh>(8, 12);
  for (unsigned i = 0; i < 8; ++i)
    for (unsigned axis = 0; axis < 3; ++axis) out->vertices[3 * i + axis] = ((i >> axis) & 1) * 0.6 - 0.2;
  const unsigned triangles[12][3] = {{0, 2, 1}, {3, 1, 2}, {4, 5, 6}, {7, 6, 5}, {0, 1, 4}, {5, 4, 1},
                                     {2, 6, 3}, {7, 3, 6}, {0, 4, 2}, {6, 2, 4}, {1, 3, 5}, {7, 5, 3}};
  for (unsigned i = 0; i < 12; ++i) std::copy(triangles[i], triangles[i] + 3, out->triangles + 3 * i);
  return out;
}

/* The distance of a point to a convex body, or to the hull of a mesh. */
double distanceOf(const Geometry &geometry, const Eigen::Vector3d &point, Workspace &workspace) {
  const BodyHandle dot = makePoint(point);
  return pair(at(dot), at(geometry.hull), CPROX_OPTIONS_DEFAULT, workspace).upper;
}

} // namespace

/* 400 points (seed 91) a shape; points within 1e-6 m of the surface say nothing. */
TEST(GeometricShapes, contain_the_same_points) {
  Random random(91);
  Workspace workspace;
  const std::vector<std::shared_ptr<const shapes::Shape>> all = {std::make_shared<shapes::Sphere>(0.4),
                                                                 std::make_shared<shapes::Box>(0.3, 0.6, 0.9),
                                                                 std::make_shared<shapes::Cylinder>(0.25, 0.7), cube()};
  for (const auto &given : all) {
    const Geometry geometry = makeGeometry(fromShape(*given));
    const std::unique_ptr<bodies::Body> body(bodies::createBodyFromShape(given.get()));
    int inside = 0;
    for (int i = 0; i < 400; ++i) {
      const Eigen::Vector3d point = random.vector(0.6);
      const double distance = distanceOf(geometry, point, workspace);
      if (std::abs(distance) < 1e-6) continue;
      EXPECT_EQ(body->containsPoint(point), distance < 0.0) << shapes::shapeStringName(given.get());
      inside += distance < 0.0;
    }
    EXPECT_GT(inside, 10);
    EXPECT_LT(inside, 390);
  }
}

/* By formula: geometric_shapes has no bodies of these. */
TEST(GeometricShapes, cones_and_planes_are_where_their_definition_puts_them) {
  Workspace workspace;
  const Geometry cone = makeGeometry(fromShape(shapes::Cone(0.3, 0.8)));
  EXPECT_NEAR(distanceOf(cone, {0.0, 0.0, 0.5}, workspace), 0.1, 1e-6) << "above the apex";
  EXPECT_NEAR(distanceOf(cone, {0.3, 0.0, -0.5}, workspace), 0.1, 1e-6) << "below the rim";
  const Geometry plane = makeGeometry(fromShape(shapes::Plane(0.0, 0.0, 2.0, -1.0)));
  EXPECT_NEAR(distanceOf(plane, {3.0, 4.0, 0.7}, workspace), 0.2, 1e-9);
  EXPECT_LT(distanceOf(plane, {3.0, 4.0, -0.7}, workspace), 0.0);
}

TEST(GeometricShapes, octrees_keep_their_occupied_cells) {
  auto tree = std::make_shared<octomap::OcTree>(0.1);
  for (const float x : {0.05f, 0.15f, 0.95f}) tree->updateNode(octomap::point3d(x, 0.05f, 0.05f), true);
  tree->updateNode(octomap::point3d(0.55f, 0.05f, 0.05f), false);
  const ShapeDescription shape = fromShape(shapes::OcTree(tree));
  const Boxes boxes = octreeBoxes(shape);
  double volume = 0.0;
  for (Eigen::Index i = 0; i < boxes.low.cols(); ++i) volume += (boxes.high.col(i) - boxes.low.col(i)).prod();
  EXPECT_NEAR(volume, 3.0 * 1e-3, 1e-12);
  EXPECT_FALSE(makeGeometry(fromShape(shapes::OcTree(std::make_shared<octomap::OcTree>(0.1)))).body) << "no cell";
  EXPECT_THROW(fromShape(shapes::OcTree()), Error) << "no tree";
}
