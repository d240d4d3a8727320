/* SPDX-License-Identifier: BSD-3-Clause */
/* Where a provider calls its gradient valid: that it is the derivative to either side, and where there is none. */
#include "steps.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

namespace curve_proximity {
namespace {

TEST(Gradients, are_not_valid_where_the_minimiser_is_not_unique) {
  Workspace workspace;
  ConstraintValue value;

  // Two boxes are equally near a ball between them, and a straight line runs along a face.
  const Loaded pairs("curve_proximity/SuperquadricDistance", {});
  ConstraintPair pair;
  ShapeDescription left = shape(ShapeType::SPHERE, {0.2}), right = left;
  left.pose.translation().x() = -1.0, right.pose.translation().x() = 1.0;
  pair.a = side({shape(ShapeType::SPHERE, {0.3})});
  pair.b = side({left, right});
  pairs->prepare(pair)->evaluate({}, workspace, value);
  EXPECT_FALSE(value.valid);
  EXPECT_EQ(value.reason, "two pairs of parts are equally near");

  // A ball at the middle of a ball may leave it any way.
  pair.b = side({shape(ShapeType::SUPERQUADRIC, {0.5, 0.5, 0.5, 2, 2, 2})});
  pair.a = side({shape(ShapeType::SUPERQUADRIC, {0.3, 0.3, 0.3, 2, 2, 2})});
  pairs->prepare(pair)->evaluate({}, workspace, value);
  EXPECT_FALSE(value.valid);
  EXPECT_LE(value.lower, -0.8 + 1e-12);
  EXPECT_GE(value.upper, -0.8 - 1e-12);

  // Face to face.
  ShapeDescription slab;
  slab.type = ShapeType::IMPLICIT;
  slab.planes = {{1, 0, 0, -1}, {-1, 0, 0, -1}, {0, 1, 0, -1}, {0, -1, 0, -1}, {0, 0, 1, -1}, {0, 0, -1, -1}};
  pair.a = pair.b = side({slab});
  ConstraintPlace place;
  place.b.position = {0.1, 0.2, 3.0};
  pairs->prepare(pair)->evaluate(place, workspace, value);
  EXPECT_NEAR(value.value, 1.0, 1e-9);
  EXPECT_FALSE(value.valid);
  EXPECT_EQ(value.reason, "the nearest points are not the only ones");

  const Loaded curves("curve_proximity/CurveDistance", {});
  ConstraintCurve line;
  line.description.points = (Eigen::Matrix3Xd(3, 2) << -0.2, 0.2, 0, 0, 1, 1).finished();
  line.curve = compile(line.description).curve;
  pair.along_curve = true;
  pair.a = {};
  pair.b = side({shape(ShapeType::BOX, {1, 1, 1})});
  place = {};
  place.curve = &line;
  curves->prepare(pair)->evaluate(place, workspace, value);
  EXPECT_NEAR(value.value, 0.5, 1e-9);
  EXPECT_FALSE(value.valid);
  EXPECT_FALSE(value.reason.empty());
}

/* A frustum with a top of half width w: faces that are small against the body count, too. */
ShapeDescription frustum(double w) {
  ShapeDescription out;
  out.type = ShapeType::IMPLICIT;
  const double slope = 1.0 - w; // |x| <= 1 - slope (z + 0.5) between z = -0.5 and 0.5
  out.planes = {{1, 0, slope, 0.5 * slope - 1},
                {-1, 0, slope, 0.5 * slope - 1},
                {0, 1, slope, 0.5 * slope - 1},
                {0, -1, slope, 0.5 * slope - 1},
                {0, 0, 1, -0.5},
                {0, 0, -1, -0.5}};
  return out;
}

/* The corners of the same. */
ShapeDescription frustumByCorners(double w) {
  Eigen::Matrix3Xd corners(3, 8);
  for (int i = 0; i < 8; ++i) {
    const double half = i & 4 ? w : 1.0;
    corners.col(i) << (i & 1 ? half : -half), (i & 2 ? half : -half), (i & 4 ? 0.5 : -0.5);
  }
  return polytope(corners);
}

/* Seed 815, 300 places of a body under another one that is 1 or 0.5 high from its middle, level or tilted by 1e-12 to
 * 1e-2, apart and overlapping. What is called a gradient is the derivative to either side: one-sided differences at steps
 * of 1e-3 to 1e-7 of values that are exact to 1e-12. */
void holdToEitherSide(const std::function<ConstraintPair(Random &, int)> &make, double tolerance) {
  const Loaded provider("curve_proximity/SuperquadricDistance", {{"epsilon", 1e-13}});
  Random random(815);
  Workspace workspace;
  ConstraintValue value, there;
  int valid = 0, refused = 0;
  for (int i = 0; i < 300; ++i) {
    const auto constraint = provider->prepare(make(random, i));
    Case c;
    const double turn = random.uniform(-3.0, 3.0), tilt = i % 2 ? 0.0 : std::pow(10.0, random.uniform(-12.0, -2.0));
    c.a.orientation = {std::cos(turn), tilt, 0.3 * tilt, std::sin(turn)};
    c.b.position = {random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5), i % 5 ? random.uniform(1.6, 3.0) : 1.45};
    Step step = randomStep(random, c);
    const double here = valueAt(*constraint, c, step, 0.0, workspace, value);
    if (!value.valid) {
      ++refused;
      continue;
    }
    ++valid;
    const double expected = value.a.linear.dot(step.linear_a) + value.a.angular.dot(step.angular_a) +
                            value.b.linear.dot(step.linear_b) + value.b.angular.dot(step.angular_b);
    for (const double sign : {1.0, -1.0}) {
      double least = std::numeric_limits<double>::infinity();
      for (const double h : {1e-3, 1e-4, 1e-5, 1e-6, 1e-7})
        least = std::min(
            least, std::abs((valueAt(*constraint, c, step, sign * h, workspace, there) - here) / h - sign * expected));
      EXPECT_LT(least, tolerance) << "case " << i << " tilt " << tilt << " value " << here;
    }
  }
  std::printf("level faces: %d valid, %d refused\n", valid, refused);
  EXPECT_GT(valid, 30);
  EXPECT_GT(refused, 100);
}

/* A frustum under a slab. */
ConstraintPair levelFaces(Random &random, int i, bool by_planes) {
  ConstraintPair pair;
  const double w = i % 3 ? random.uniform(0.002, 0.02) : random.uniform(0.1, 0.9);
  pair.a = side({by_planes ? frustum(w) : frustumByCorners(w)});
  ShapeDescription slab;
  slab.type = ShapeType::IMPLICIT;
  slab.planes = {{1, 0, 0, -2}, {-1, 0, 0, -2}, {0, 1, 0, -2}, {0, -1, 0, -2}, {0, 0, 1, -1}, {0, 0, -1, -1}};
  pair.b = side({by_planes ? slab : shape(ShapeType::BOX, {4, 4, 2})});
  return pair;
}

TEST(Gradients, of_SuperquadricDistance_hold_to_either_side_where_faces_are_level) {
  holdToEitherSide([](Random &random, int i) { return levelFaces(random, i, true); }, 1e-3);
}

TEST(Gradients, of_SuperquadricDistance_hold_to_either_side_where_a_polytope_is_level_with_a_box) {
  holdToEitherSide([](Random &random, int i) { return levelFaces(random, i, false); }, 1e-3);
}

/* Superquadrics of exponents 2.2 to 40 under a box or under each other. At exponent 4 a turn of 1e-7 still moves the
 * nearest point of each by 5e-3 of its size: the tolerance is twice that for both. */
TEST(Gradients, of_SuperquadricDistance_hold_to_either_side_where_rounded_boxes_are_level) {
  const auto exponent = [](Random &random) {
    return random.uniform(0.0, 1.0) < 0.5 ? random.uniform(2.2, 4.0) : random.uniform(5.0, 40.0);
  };
  holdToEitherSide(
      [&](Random &random, int i) {
        ConstraintPair pair;
        const double p = exponent(random), q = exponent(random);
        pair.a = side({shape(ShapeType::SUPERQUADRIC, {1.0, 0.8, 0.5, p, exponent(random), p})});
        pair.b = side({i % 3 ? shape(ShapeType::BOX, {4, 4, 2})
                             : shape(ShapeType::SUPERQUADRIC, {2.0, 2.0, 1.0, q, q, exponent(random)})});
        return pair;
      },
      2e-2);
}

/* Seed 824: bodies level with each other, touching, in line, one within the other, and anywhere. */
TEST(Valid, means_that_the_value_has_this_gradient_to_either_side_whichever_provider_says_so) {
  const std::pair<const char *, ParameterMap> providers[] = {
      {"curve_proximity/CurveDistance", {}},
      {"curve_proximity/SuperquadricDistance", {}},
      {"curve_proximity/GrowthDistance", {}},
      {"curve_proximity/FourierGap", {{"samples", 9}}},
      {"curve_proximity/FourierGap", {{"samples", 9}, {"mode", std::string("guide")}}},
      {"curve_proximity/FourierGap", {{"samples", 9}, {"mode", std::string("signal")}}}};
  const ConstraintBody bodies[] = {side({shape(ShapeType::BOX, {0.4, 0.6, 0.8})}),
                                   side({shape(ShapeType::CYLINDER, {0.8, 0.3})}),
                                   side({shape(ShapeType::SPHERE, {0.4})}),
                                   side({polytope(0.4 * (Eigen::Matrix3Xd(3, 6) << 1, -1, 0, 0, 0, 0, //
                                                         0, 0, 1, -1, 0, 0,                           //
                                                         0, 0, 0, 0, 1, -1)
                                                            .finished())})};
  constexpr double H = 1e-6, TOLERATED = 1e-3;
  for (const auto &[name, parameters] : providers) {
    const Loaded provider(name, parameters);
    Random random(824);
    Workspace workspace;
    ConstraintValue value, other;
    int valid = 0, refused = 0;
    for (int i = 0; i < 240; ++i) {
      ConstraintPair pair;
      pair.a = bodies[i % 4], pair.b = bodies[i / 4 % 4];
      const auto constraint = provider->prepare(pair);
      Case c;
      if (i % 3 == 0) {
        c.b = random.pose(0.5);
      } else {
        const double steps[] = {-1.0, -0.7, -0.6, 0.0, 0.0, 0.2, 0.6, 0.8};
        const auto step = [&] { return steps[static_cast<std::size_t>(random.uniform(0.0, 7.99))]; };
        c.b.position = {step(), step(), step()};
        const double half = std::sqrt(0.5);
        if (i % 3 == 2) c.b.orientation = {half, 0, 0, half};
      }
      const Step way = randomStep(random, c);
      const double here = valueAt(*constraint, c, way, 0.0, workspace, value);
      if (!value.valid) {
        EXPECT_FALSE(value.reason.empty());
        ++refused;
        continue;
      }
      ++valid;
      const double slope = value.a.linear.dot(way.linear_a) + value.a.angular.dot(way.angular_a) +
                           value.b.linear.dot(way.linear_b) + value.b.angular.dot(way.angular_b);
      for (const double h : {H, -H}) {
        const double by_side = (valueAt(*constraint, c, way, h, workspace, other) - here) / h;
        EXPECT_NEAR(by_side, slope, TOLERATED * std::max(1.0, std::abs(slope)))
            << name << " case " << i << " at " << here;
      }
    }
    std::printf("%s: %d valid, %d refused\n", name, valid, refused);
    EXPECT_GT(valid, 80) << name;
  }
}

/* On one axis a way out leads to every side, and the places beside it are as hard to search. */
TEST(Valid, is_false_where_bodies_of_revolution_stand_on_one_axis_and_overlap) {
  const Loaded provider("curve_proximity/SuperquadricDistance", {{"epsilon", 1e-13}});
  const ShapeDescription upright[] = {shape(ShapeType::CYLINDER, {1.2, 1e-3}), shape(ShapeType::CYLINDER, {0.8, 0.4}),
                                      shape(ShapeType::CAPSULE, {0.6, 0.2}), shape(ShapeType::CONE, {0.8, 0.3})};
  Workspace workspace;
  ConstraintValue value;
  int sideways = 0;
  for (const ShapeDescription &one : upright) {
    ConstraintPair pair;
    pair.a = side({one});
    pair.b = side({shape(ShapeType::CONE, {0.8, 0.4})});
    const auto constraint = provider->prepare(pair);
    for (int i = -5; i <= 5; ++i) {
      ConstraintPlace place;
      place.b.position.z = 0.1 * i;
      constraint->evaluate(place, workspace, value);
      if (!(value.upper < 0.0) || std::abs(value.normal.z()) > 0.999) continue;
      ++sideways;
      EXPECT_FALSE(value.valid) << shapeTypeName(one.type) << " at " << place.b.position.z;
    }
  }
  EXPECT_GT(sideways, 10);
}

/* A curve of one point, an arch whose ends are as near as each other, and the same arch a little lower at one end. */
TEST(Valid, is_false_where_the_least_value_along_a_curve_is_attained_twice_whichever_provider_says_so) {
  const std::pair<const char *, ParameterMap> providers[] = {
      {"curve_proximity/CurveDistance", {}},
      {"curve_proximity/GrowthDistance", {}},
      {"curve_proximity/FourierGap", {{"samples", 9}}},
      {"curve_proximity/FourierGap", {{"samples", 9}, {"mode", std::string("guide")}}},
      {"curve_proximity/FourierGap", {{"samples", 9}, {"mode", std::string("signal")}}}};
  Workspace workspace;
  ConstraintPair pair;
  pair.along_curve = true;
  pair.a = side({shape(ShapeType::SPHERE, {0.1})});
  pair.b = side({shape(ShapeType::ELLIPSOID, {0.5, 0.4, 0.3})});
  for (const auto &[name, parameters] : providers) {
    const Loaded provider(name, parameters);
    const auto constraint = provider->prepare(pair);
    for (const double height : {0.2, 0.7, 2.0}) { // in contact at both ends, and apart
      for (const double lower : {0.0, 0.05, -1.0}) {
        ConstraintCurve arch;
        arch.description.points.resize(3, 3);
        arch.description.points << -0.3, 0.0, 0.3, 0.0, 0.0, 0.0, height, height + 1.0, height - lower;
        if (lower < 0.0) arch.description.points.colwise() = Eigen::Vector3d(0.3, 0.0, height);
        arch.curve = compile(arch.description).curve;
        ConstraintPlace place;
        place.curve = &arch;
        ConstraintValue value;
        constraint->evaluate(place, workspace, value);
        EXPECT_EQ(value.valid, lower > 0.0) << name << " at " << height << " lower by " << lower << ' ' << value.reason;
        EXPECT_EQ(value.reason.empty(), value.valid);
      }
    }
  }
}

} // namespace
} // namespace curve_proximity
