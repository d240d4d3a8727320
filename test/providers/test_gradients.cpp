/* SPDX-License-Identifier: BSD-3-Clause */
/* Every provider's gradient against finite differences of its own values, over random places. */
#include "steps.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace curve_proximity {
namespace {

/* How far the derivative along the step, by the gradient, is from the nearest of a few central differences with one
 * extrapolation. */
double misfit(const Constraint &constraint, const Case &c, const Step &step, const ConstraintValue &value,
              Workspace &workspace, double *derivative) {
  double expected = value.a.linear.dot(step.linear_a) + value.a.angular.dot(step.angular_a) +
                    value.b.linear.dot(step.linear_b) + value.b.angular.dot(step.angular_b) +
                    value.radius * step.radius;
  if (c.curve) expected += value.points.cwiseProduct(step.points).sum();
  *derivative = expected;
  double best = std::numeric_limits<double>::infinity();
  ConstraintValue unused;
  for (const double width : {3e-3, 1e-3, 3e-4, 1e-4, 1e-5}) {
    double slope[2];
    for (int m = 0; m < 2; ++m) {
      const double h = width / (m + 1);
      slope[m] =
          (valueAt(constraint, c, step, h, workspace, unused) - valueAt(constraint, c, step, -h, workspace, unused)) /
          (2.0 * h);
    }
    best = std::min(best, std::abs((4.0 * slope[1] - slope[0]) / 3.0 - expected));
  }
  return best;
}

CurveDescription randomCurve(Random &random, int k) {
  CurveDescription c;
  const char *names[] = {"bezier", "bspline", "polynomial", "legendre", "lagrange", "trigonometric"};
  c.basis = names[k % 6];
  c.degree = c.basis == "bspline" || c.basis == "trigonometric" ? 3 : 5;
  c.points.resize(3, c.basis == "trigonometric" ? 7 : 6);
  for (Eigen::Index i = 0; i < c.points.cols(); ++i)
    c.points.col(i) = random.inCube(1.0) / (isSeries(c) ? 1.0 + static_cast<double>(i) : 1.0);
  c.points.row(0).head(isSeries(c) ? 1 : c.points.cols()).array() += 1.5;
  if (c.basis == "bspline") c.knots = {0, 0, 0, 0, 0.3, 0.6, 1, 1, 1, 1};
  if (c.basis == "lagrange") c.knots = {0, 0.2, 0.4, 0.6, 0.8, 1};
  c.radius = k % 2 ? 0.05 : 0.0;
  return c;
}

/* 1e-6: central differences of values that are exact to 1e-12, at the best of several widths, err by some 1e-8; the
 * distance along a curve is but once differentiable where the nearest feature changes, which is why the best width
 * counts. */
constexpr double TOLERANCE = 1e-6;

/* A body carried past a superquadric: the core knows their difference by supports alone, its normal to the root of the
 * interval. */
constexpr double TOLERANCE_BY_SUPPORTS = 1e-5;

struct Tally {
  int valid = 0, asked = 0;
  double worst = 0.0;
};

void check(const Constraint &constraint, const Case &c, Random &random, Workspace &workspace, bool planar, Tally &tally,
           double tolerance = TOLERANCE) {
  ConstraintValue value;
  const Step step = randomStep(random, c, planar);
  ++tally.asked;
  valueAt(constraint, c, step, 0.0, workspace, value);
  if (value.bounded) {
    EXPECT_LE(value.lower, value.value);
    EXPECT_GE(value.upper, value.value - 1e-15);
  }
  if (!value.valid) return;
  ++tally.valid;
  double derivative;
  const double error = misfit(constraint, c, step, value, workspace, &derivative) / std::max(1.0, std::abs(derivative));
  EXPECT_LT(error, tolerance) << "case " << tally.asked << " value " << value.value << " derivative " << derivative;
  tally.worst = std::max(tally.worst, error);
}

TEST(Gradients, of_CurveDistance_are_those_of_finite_differences_along_random_steps_of_points_and_poses) {
  const Loaded provider("curve_proximity/CurveDistance", {{"epsilon", 1e-12}});
  Random random(811);
  Workspace workspace;
  Tally tally;
  const std::vector<std::vector<ShapeDescription>> targets = {
      {shape(ShapeType::BOX, {0.5, 0.7, 0.9})},
      {shape(ShapeType::CAPSULE, {0.5, 0.2})},
      {shape(ShapeType::SUPERQUADRIC, {0.4, 0.3, 0.5, 2.5, 3.5, 5.0})},
      {shape(ShapeType::CYLINDER, {0.6, 0.3}), shape(ShapeType::SPHERE, {0.35})},
      {polytope((Eigen::Matrix3Xd(3, 5) << 0.5, -0.4, 0, 0, 0.1, 0, 0.1, 0.5, -0.5, 0, -0.3, -0.2, -0.3, -0.3, 0.5)
                    .finished())}};
  for (int i = 0; i < 300; ++i) {
    ConstraintPair pair;
    pair.along_curve = true;
    pair.b = side(targets[static_cast<std::size_t>(i) % targets.size()], i % 3 ? 0.0 : 0.02);
    if (i % 4 == 0) pair.a = side({shape(ShapeType::BOX, {0.1, 0.2, 0.1})});
    Case c;
    c.curve = randomCurve(random, i);
    c.b = random.pose(0.3);
    const bool by_supports = i % 4 == 0 && pair.b.parts[0].shape.type == ShapeType::SUPERQUADRIC;
    check(*provider->prepare(pair), c, random, workspace, false, tally,
          by_supports ? TOLERANCE_BY_SUPPORTS : TOLERANCE);
  }
  std::printf("CurveDistance: %d of %d valid, worst %.1e\n", tally.valid, tally.asked, tally.worst);
  EXPECT_GT(tally.valid, 200);
}

/* A curve that start, headings and lengths describe, some with a radius that changes. */
CurveDescription namedCurve(Random &random, int i) {
  CurveDescription out;
  const auto number = [&](double low, double high) { return random.uniform(low, high); };
  const Eigen::Vector3d start(number(-1, 1), number(-1, 1), number(0.8, 1.2));
  out.points = start;
  switch (i % 4) {
    case 0:
      out.basis = "clothoid";
      out.parameters = {number(-3, 3), number(-1, 1), number(-1, 1)};
      break;
    case 1:
      out.basis = "involute";
      out.parameters = {number(-3, 3), number(0.1, 0.5)};
      break;
    case 2:
      out.basis = "pythagorean_hodograph";
      out.degree = 1;
      for (int k = 0; k < 8; ++k) out.parameters.push_back(number(-1, 1));
      break;
    default:
      out.basis = "dubins";
      out.points.resize(3, 2);
      out.points << start, start + Eigen::Vector3d(number(-2, 2), number(-2, 2), 0.0);
      out.parameters = {number(-3, 3), number(-3, 3), 0.3};
      out.t0 = out.t1 = 0.0;
  }
  out.pose = Eigen::Translation3d(random.inCube(0.3)) * random.rotation();
  if (i % 3 == 0) out.radius = 0.01, out.radius_polynomial = {0.01, 0.01};
  return out;
}

/* A random step of the points, the parameters and the range of a curve, and the derivative along it by a gradient. */
struct CurveStep {
  Eigen::Matrix3Xd points; /* in the curve's own frame */
  Eigen::VectorXd parameters;
  double start = 0.0, end = 0.0;

  CurveStep(const CurveDescription &curve, Random &random)
      : points(3, curve.points.cols()), parameters(static_cast<Eigen::Index>(curve.parameters.size())) {
    for (Eigen::Index k = 0; k < points.cols(); ++k) points.col(k) = random.direction();
    if (curve.basis == "dubins") points(2, 1) = points(2, 0); // it stays planar
    for (Eigen::Index k = 0; k < parameters.size(); ++k) parameters[k] = random.uniform(-1.0, 1.0);
    if (curve.basis != "clothoid" && curve.basis != "involute") return;
    start = random.uniform(-1.0, 1.0), end = random.uniform(-1.0, 1.0);
  }

  CurveDescription of(CurveDescription curve, double h) const {
    curve.points += h * points;
    for (std::size_t k = 0; k < curve.parameters.size(); ++k)
      curve.parameters[k] += h * parameters[static_cast<Eigen::Index>(k)];
    curve.t0 += h * start, curve.t1 += h * end;
    return curve;
  }

  double along(const CurveDescription &curve, const ConstraintValue &value) const {
    return value.points.cwiseProduct(curve.pose->linear() * points).sum() + value.parameters.dot(parameters) +
           value.range_start * start + value.range_end * end;
  }
};

/* Seed 821, 400 curves without control points, in a frame of their own: the derivatives by a step of the whole curve, and
 * by what defines it, are central differences at 1e-5. 1e-4 is what second derivatives leave; those of a Dubins path
 * grow without limit where its circles nearly touch, so 2 of its 100 may be farther off. */
TEST(Gradients, of_curves_without_control_points_are_those_of_a_step_of_the_whole_curve_and_of_what_defines_it) {
  constexpr double STEP = 1e-5;
  const Loaded provider("curve_proximity/CurveDistance", {{"epsilon", 1e-12}});
  Random random(821);
  Workspace workspace;
  int valid = 0, off = 0, at_an_end = 0;
  for (int i = 0; i < 400; ++i) {
    ConstraintPair pair;
    pair.along_curve = true;
    pair.b = side({i % 2 ? shape(ShapeType::BOX, {0.5, 0.7, 0.9}) : shape(ShapeType::SPHERE, {0.35})});
    const CurveDescription given = namedCurve(random, i);
    ConstraintPlace place;
    place.b = random.pose(0.5);
    const auto constraint = provider->prepare(pair);
    const auto valueOf = [&](const CurveDescription &curve, ConstraintValue &value) {
      const CompiledCurve compiled = compile(curve);
      const ConstraintCurve along{curve, compiled.curve, compiled.radius_curve};
      place.curve = &along;
      constraint->evaluate(place, workspace, value);
      return value.value;
    };
    ConstraintValue here, there;
    valueOf(given, here);
    ASSERT_EQ(here.points.cols(), given.points.cols()) << given.basis;
    ASSERT_EQ(static_cast<std::size_t>(here.parameters.size()), given.parameters.size()) << given.basis;
    if (!here.valid) continue;
    ++valid;
    at_an_end += here.range_start != 0.0 || here.range_end != 0.0;
    const Eigen::Vector3d linear = random.direction(), angular = random.direction();
    const CurveStep numbers(given, random);
    double value[2], by_numbers[2];
    for (int k = 0; k < 2; ++k) {
      const double h = k ? STEP : -STEP;
      CurveDescription moved = given;
      moved.pose = Eigen::Translation3d(h * linear) * Eigen::AngleAxisd(h, angular) * *given.pose;
      value[k] = valueOf(moved, there);
      by_numbers[k] = valueOf(numbers.of(given, h), there);
    }
    const double expected = (value[1] - value[0]) / (2.0 * STEP);
    EXPECT_NEAR(here.a.linear.dot(linear) + here.a.angular.dot(angular), expected, 1e-4) << given.basis << ' ' << i;
    const double slope = (by_numbers[1] - by_numbers[0]) / (2.0 * STEP);
    const bool fits = std::fabs(numbers.along(given, here) - slope) < 1e-4 * (1.0 + std::fabs(slope));
    EXPECT_TRUE(fits || given.basis == "dubins")
        << given.basis << ' ' << i << ": " << numbers.along(given, here) << " beside " << slope;
    off += !fits;
  }
  EXPECT_GT(valid, 200);
  EXPECT_GT(at_an_end, 20);
  EXPECT_LE(off, 2);
}

TEST(Gradients, of_SuperquadricDistance_are_those_of_finite_differences_apart_and_overlapping) {
  const Loaded provider("curve_proximity/SuperquadricDistance", {{"epsilon", 1e-13}, {"most_exponent", 8}});
  Random random(812);
  Workspace workspace;
  Tally apart, inside;
  ShapeDescription implicit;
  implicit.type = ShapeType::IMPLICIT;
  implicit.hyperquadrics = {{{1.8, 0.2, 0, 0, 4.0}, {0, 2.1, 0.3, 0, 3.0}, {0.1, 0, 1.7, 0, 2.0}}};
  const std::vector<ShapeDescription> shapes = {
      shape(ShapeType::SUPERQUADRIC, {0.4, 0.3, 0.5, 2.5, 3.5, 5.0}), shape(ShapeType::ELLIPSOID, {0.3, 0.5, 0.4}),
      shape(ShapeType::BOX, {0.6, 0.8, 0.5}), shape(ShapeType::SPHERE, {0.4}), implicit};
  std::vector<std::unique_ptr<const Constraint>> constraints;
  for (std::size_t i = 0; i < shapes.size(); ++i)
    for (std::size_t j = 0; j < 4; ++j) {
      ConstraintPair pair;
      pair.a = side({shapes[i]}, j == 1 ? 0.03 : 0.0);
      pair.b = side({shapes[j]});
      constraints.push_back(provider->prepare(pair));
    }
  for (int i = 0; i < 400; ++i) {
    const Constraint &constraint = *constraints[static_cast<std::size_t>(i) % constraints.size()];
    Case c;
    const bool overlapping = i % 5 == 4;
    c.a = random.pose(0.2);
    c.b = random.pose(0.2);
    if (!overlapping) c.b.position = toVec3(toEigen(c.b.position) + random.uniform(1.2, 3.0) * random.direction());
    check(constraint, c, random, workspace, false, overlapping ? inside : apart);
  }
  std::printf("SuperquadricDistance: apart %d of %d valid, worst %.1e; near or inside %d of %d, worst %.1e\n",
              apart.valid, apart.asked, apart.worst, inside.valid, inside.asked, inside.worst);
  EXPECT_GT(apart.valid, 300);
  EXPECT_GT(inside.valid, 20);
}

/* Bodies with faces and edges as they are. Between two of them places are generic: no two faces are level. */
TEST(Gradients, of_SuperquadricDistance_are_those_of_finite_differences_where_bodies_answer_as_they_are) {
  const Loaded provider("curve_proximity/SuperquadricDistance", {{"epsilon", 1e-13}});
  Random random(816);
  Workspace workspace;
  Tally apart, inside;
  const Eigen::Matrix3Xd tetrahedron =
      (Eigen::Matrix3Xd(3, 4) << 0.5, -0.4, 0, 0, 0, 0.1, 0.5, -0.5, -0.3, -0.2, -0.3, 0.5).finished();
  const std::vector<ShapeDescription> shapes = {shape(ShapeType::BOX, {0.6, 0.8, 0.5}),
                                                shape(ShapeType::CYLINDER, {0.7, 0.3}),
                                                shape(ShapeType::CONE, {0.7, 0.4}),
                                                shape(ShapeType::CAPSULE, {0.5, 0.2}),
                                                polytope(tetrahedron),
                                                shape(ShapeType::SUPERQUADRIC, {0.4, 0.3, 0.5, 2.5, 3.5, 5.0})};
  std::vector<std::unique_ptr<const Constraint>> constraints;
  for (std::size_t i = 0; i < shapes.size(); ++i)
    for (std::size_t j = i; j < shapes.size(); ++j) {
      ConstraintPair pair;
      pair.a = side({shapes[i]}, j == i ? 0.03 : 0.0);
      pair.b = side({shapes[j]});
      constraints.push_back(provider->prepare(pair));
    }
  for (std::size_t i = 0; i < 420; ++i) {
    const Constraint &constraint = *constraints[i % constraints.size()];
    Case c;
    const bool overlapping = i % 5 == 4;
    c.a = random.pose(0.2);
    c.b = random.pose(0.2);
    if (!overlapping) c.b.position = toVec3(toEigen(c.b.position) + random.uniform(1.2, 3.0) * random.direction());
    check(constraint, c, random, workspace, false, overlapping ? inside : apart);
  }
  std::printf(
      "SuperquadricDistance as they are: apart %d of %d valid, worst %.1e; near or inside %d of %d, worst %.1e\n",
      apart.valid, apart.asked, apart.worst, inside.valid, inside.asked, inside.worst);
  EXPECT_GT(apart.valid, 300);
  EXPECT_GT(inside.valid, 40);
}

/* Growth distances apart, about contact and deep inside; the sides stand at poses of their own, and two of them have two
 * parts. */
TEST(Gradients, of_GrowthDistance_are_those_of_finite_differences_apart_touching_and_deep) {
  const Loaded provider("curve_proximity/GrowthDistance", {{"epsilon", 1e-10}});
  Random random(818);
  Workspace workspace;
  Tally apart, inside;
  Eigen::Matrix3Xd corners(3, 6); /* a polytope is scaled about the middle of its box, which must be inside */
  corners << 0.5, -0.4, 0, 0.1, 0.1, -0.1, 0, 0.1, 0.5, -0.5, 0.1, -0.1, -0.1, 0.1, 0, 0.1, 0.4, -0.5;
  std::vector<ShapeDescription> shapes = {shape(ShapeType::BOX, {0.6, 0.8, 0.5}),
                                          shape(ShapeType::CYLINDER, {0.7, 0.3}),
                                          shape(ShapeType::CONE, {0.7, 0.4}),
                                          shape(ShapeType::CAPSULE, {0.5, 0.2}),
                                          polytope(corners),
                                          shape(ShapeType::ELLIPSOID, {0.3, 0.5, 0.4}),
                                          shape(ShapeType::SUPERQUADRIC, {0.4, 0.3, 0.5, 2.5, 3.5, 5.0})};
  for (ShapeDescription &s : shapes) {
    s.pose.translation() = random.inCube(0.3);
    s.pose.linear() = random.rotation().toRotationMatrix();
  }
  std::vector<std::unique_ptr<const Constraint>> constraints;
  for (std::size_t i = 0; i < shapes.size(); ++i)
    for (std::size_t j = i; j < shapes.size(); ++j) {
      ConstraintPair pair;
      pair.a = i == j ? side({shapes[i], shapes[(i + 1) % shapes.size()]}) : side({shapes[i]});
      pair.b = side({shapes[j]});
      constraints.push_back(provider->prepare(pair));
    }
  for (std::size_t i = 0; i < 420; ++i) {
    const Constraint &constraint = *constraints[i % constraints.size()];
    Case c;
    const bool overlapping = i % 2 == 1;
    c.a = random.pose(0.2);
    c.b = random.pose(0.2);
    if (!overlapping) c.b.position = toVec3(toEigen(c.b.position) + random.uniform(0.5, 3.0) * random.direction());
    check(constraint, c, random, workspace, false, overlapping ? inside : apart);
  }
  std::printf("GrowthDistance: apart %d of %d valid, worst %.1e; near or inside %d of %d, worst %.1e\n", apart.valid,
              apart.asked, apart.worst, inside.valid, inside.asked, inside.worst);
  EXPECT_GT(apart.valid, 205);
  EXPECT_GT(inside.valid, 205);
}

/* Boxes of 1 m, 3 m apart: by positions 1 per metre; faces that are parallel have no gradient. Scaled by 2, they would
 * touch: with the level 2 the value is 1 less. */
TEST(Gradients, of_GrowthDistance_are_refused_between_parallel_faces_and_what_has_no_growth_is_refused) {
  const Loaded provider("curve_proximity/GrowthDistance", {}), larger("curve_proximity/GrowthDistance", {{"level", 2}});
  Workspace workspace;
  ConstraintPair pair;
  pair.a = pair.b = side({shape(ShapeType::BOX, {1, 1, 1})});
  ConstraintPlace place;
  place.b.position = {3, 0.2, 0.1};
  ConstraintValue value;
  provider->prepare(pair)->evaluate(place, workspace, value);
  EXPECT_FALSE(value.valid);
  EXPECT_NE(value.reason.find("more than one point"), std::string::npos) << value.reason;
  EXPECT_LE(value.lower, 2.0);
  EXPECT_GE(value.upper, 2.0 - 1e-12);
  EXPECT_NEAR(value.value, 2.0, 1e-9);
  EXPECT_NEAR(value.b.linear.x(), 1.0, 1e-12);
  larger->prepare(pair)->evaluate(place, workspace, value);
  EXPECT_NEAR(value.value, 1.0, 1e-9);

  pair.along_curve = true;
  pair.is_named = false;
  EXPECT_THROW(provider->prepare(pair), DoesNotApply);
  pair.is_named = true;
  pair.a = ConstraintBody(); /* the curve's ball has no size to scale */
  EXPECT_THROW(provider->prepare(pair), Error);
  pair.a = pair.b;
  pair.along_curve = false;
  pair.b = side({shape(ShapeType::BOX, {1, 1, 1})}, 0.1);
  EXPECT_THROW(provider->prepare(pair), Error);
  for (const ShapeDescription &refused : {shape(ShapeType::HALFSPACE, {0, 0, 1, 0}), shape(ShapeType::POINT, {})}) {
    pair.b = side({refused});
    EXPECT_THROW(provider->prepare(pair), Error);
  }
}

/* Seed 822, 120 curves of six bases that carry a body in a pose of its own, some of two parts, past boxes, ellipsoids and
 * cylinders: by the curve's points, by steps of the whole curve, and of what stands. */
TEST(Gradients, of_GrowthDistance_along_curves_are_those_of_finite_differences) {
  const Loaded provider("curve_proximity/GrowthDistance", {{"epsilon", 1e-11}});
  Random random(822);
  Workspace workspace;
  Tally tally;
  const std::vector<ShapeDescription> targets = {shape(ShapeType::BOX, {0.5, 0.7, 0.9}),
                                                 shape(ShapeType::ELLIPSOID, {0.3, 0.5, 0.4}),
                                                 shape(ShapeType::CYLINDER, {0.7, 0.3})};
  for (int i = 0; i < 120; ++i) {
    ConstraintPair pair;
    pair.along_curve = true;
    ShapeDescription rider = shape(ShapeType::BOX, {0.3, 0.2, 0.4}), other = shape(ShapeType::SPHERE, {0.2});
    rider.pose = Eigen::Translation3d(random.inCube(0.2)) * random.rotation();
    other.pose.translation() = random.inCube(0.3);
    pair.a = i % 3 ? side({rider}) : side({rider, other});
    pair.b = side({targets[static_cast<std::size_t>(i) % targets.size()]});
    Case c;
    c.curve = randomCurve(random, i);
    c.curve->radius = 0.0;
    c.b = random.pose(0.3);
    check(*provider->prepare(pair), c, random, workspace, false, tally, TOLERANCE_BY_SUPPORTS);
  }
  std::printf("GrowthDistance along curves: %d of %d valid, worst %.1e\n", tally.valid, tally.asked, tally.worst);
  EXPECT_GT(tally.valid, 100);
}

/* Seed 823, 200 places of two boxes whose faces are parallel, apart, touching and deep: with a smoothing of 0.01 rad the
 * gradient exists, is the central difference of the value, and the value is within the bound of
 * doc/constraint-providers.md of the growth distance. */
TEST(Gradients, of_GrowthDistance_with_a_smoothing_exist_between_parallel_faces) {
  constexpr double ANGLE = 0.01, STEP = 1e-6;
  const Loaded provider("curve_proximity/GrowthDistance", {{"epsilon", 1e-11}, {"smoothing", ANGLE}});
  Random random(823);
  Workspace workspace;
  int valid = 0;
  ConstraintPair pair;
  pair.a = side({shape(ShapeType::BOX, {1, 0.8, 0.6})});
  pair.b = side({shape(ShapeType::BOX, {0.5, 0.9, 0.7})});
  const auto constraint = provider->prepare(pair);
  const double turned = 2.0 * std::sin(0.5 * ANGLE) * 0.5 * Eigen::Vector3d(0.5, 0.9, 0.7).norm() / (0.299 + 0.249);
  for (int i = 0; i < 200; ++i) {
    ConstraintPlace place;
    place.a = random.pose(0.5);
    place.b.orientation = place.a.orientation;
    place.b.position = toVec3(toEigen(place.a.position) + random.uniform(0.1, 2.0) * random.direction());
    ConstraintValue here, there;
    constraint->evaluate(place, workspace, here);
    EXPECT_LE(std::abs(here.value - here.lower), (here.lower + 1.0) * turned / (1.0 - turned));
    if (!here.valid) continue;
    ++valid;
    const Eigen::Vector3d linear = random.direction(), angular = random.direction();
    double value[2];
    for (int k = 0; k < 2; ++k) {
      ConstraintPlace near = place;
      near.b = moved(place.b, linear, angular, k ? STEP : -STEP);
      near.a = moved(place.a, -0.5 * angular, linear, k ? STEP : -STEP);
      constraint->evaluate(near, workspace, there);
      value[k] = there.value;
    }
    const double expected = here.b.linear.dot(linear) + here.b.angular.dot(angular) - 0.5 * here.a.linear.dot(angular) +
                            here.a.angular.dot(linear);
    EXPECT_NEAR((value[1] - value[0]) / (2.0 * STEP), expected, 1e-5) << i;
  }
  EXPECT_GT(valid, 195);
}

cprox_pose planar(cprox_pose pose, Random &random) {
  const double angle = random.uniform(-M_PI, M_PI);
  pose.position.z = 0.0;
  pose.orientation = {std::cos(angle), 0, 0, std::sin(angle)};
  return pose;
}

TEST(Gradients, of_FourierGap_are_those_of_finite_differences_in_the_plane_and_in_space) {
  Random random(813);
  Workspace workspace;
  const Eigen::Matrix3Xd kite = (Eigen::Matrix3Xd(3, 4) << 0.5, 0, -0.3, 0, 0, 0.4, 0, -0.4, 0, 0, 0, 0).finished();
  const Eigen::Matrix3Xd tetrahedron =
      (Eigen::Matrix3Xd(3, 4) << 0.5, -0.4, 0, 0, 0, 0.1, 0.5, -0.5, -0.3, -0.2, -0.3, 0.5).finished();
  for (const int dimension : {2, 3}) {
    for (const char *mode : {"certified", "signal"}) {
      const Loaded provider(
          "curve_proximity/FourierGap",
          {{"mode", std::string(mode)}, {"dimension", dimension}, {"samples", dimension == 2 ? 17 : 9}});
      ConstraintPair pair;
      pair.a = side({dimension == 2 ? polytope(kite) : polytope(tetrahedron)});
      pair.b = side({shape(ShapeType::BOX, {0.5, 0.7, 0.6})});
      const auto constraint = provider->prepare(pair);
      Tally tally;
      for (int i = 0; i < 60; ++i) {
        Case c;
        c.a = random.pose(0.3), c.b = random.pose(0.3);
        if (dimension == 2) c.a = planar(c.a, random), c.b = planar(c.b, random);
        check(*constraint, c, random, workspace, dimension == 2, tally);
      }
      std::printf("FourierGap %d-D %s: %d of %d valid, worst %.1e\n", dimension, mode, tally.valid, tally.asked,
                  tally.worst);
      EXPECT_GT(tally.valid, 40) << mode << " " << dimension;
      EXPECT_LT(tally.worst, 1e-7) << mode << " " << dimension;
    }
  }
}

/* Seed 818: sides whose spheres are not about their origins, from where the spheres touch to five of their radii away.
 */
TEST(Gradients, of_FourierGap_are_those_of_finite_differences_beyond_the_bounding_spheres) {
  Random random(818);
  Workspace workspace;
  ShapeDescription arm = shape(ShapeType::BOX, {0.5, 0.7, 0.6}), ball = shape(ShapeType::SPHERE, {0.3});
  arm.pose.translation() = Eigen::Vector3d(0.2, -0.1, 0.0);
  for (const int dimension : {2, 3}) {
    for (const char *mode : {"certified", "signal"}) {
      const Loaded provider("curve_proximity/FourierGap",
                            {{"mode", std::string(mode)}, {"dimension", dimension}, {"samples", 9}});
      ConstraintPair pair;
      pair.a = side({arm});
      pair.b = side({ball, shape(ShapeType::ELLIPSOID, {0.5, 0.2, 0.4})});
      const auto constraint = provider->prepare(pair);
      Tally tally;
      ConstraintValue value;
      for (int i = 0; i < 60; ++i) {
        Case c;
        c.a = random.pose(0.3), c.b = random.pose(0.3);
        const Eigen::Vector3d away = random.direction(), flat(away.x(), away.y(), 0.0);
        c.b.position = toVec3((dimension == 2 ? flat.normalized() : away) * random.uniform(2.0, 6.0));
        if (dimension == 2) c.a = planar(c.a, random), c.b = planar(c.b, random);
        valueAt(*constraint, c, randomStep(random, c, dimension == 2), 0.0, workspace, value);
        EXPECT_TRUE(std::isfinite(value.value));
        EXPECT_TRUE(value.valid) << value.reason;
        EXPECT_GT(value.b.linear.norm(), 0.1) << mode << " " << dimension;
        check(*constraint, c, random, workspace, dimension == 2, tally);
      }
      EXPECT_EQ(tally.valid, 60) << mode << " " << dimension;
    }
  }
}

/* Seed 822. The distance is known to 1e-9, and about contact the value changes by up to ten times as much: differences at
 * the best of steps of 1e-5 to 3e-3 err by some 1e-4. */
TEST(Gradients, of_a_guide_are_those_of_finite_differences_at_every_depth) {
  const Loaded provider("curve_proximity/FourierGap", {{"mode", std::string("guide")}, {"samples", 33}});
  Random random(822);
  Workspace workspace;
  const ConstraintPair pair = unions();
  const auto guide = provider->prepare(pair);
  Tally tally;
  for (int i = 0; i < 150; ++i) {
    Case c;
    c.a = random.pose(0.2), c.b = random.pose(0.2);
    c.b.position = toVec3(toEigen(c.b.position) + random.uniform(0.0, 1.4) * random.direction());
    check(*guide, c, random, workspace, false, tally, 1e-4);
  }
  std::printf("guide: %d of %d valid, worst %.1e\n", tally.valid, tally.asked, tally.worst);
  EXPECT_GT(tally.valid, 120);
}

/* Seed 824: a ball on a line past a box, in contact and not. */
TEST(Values, of_a_guide_along_a_curve_are_the_distance_apart_and_below_0_in_contact) {
  const Loaded provider("curve_proximity/FourierGap", {{"mode", std::string("guide")}, {"samples", 17}});
  const Loaded distance("curve_proximity/CurveDistance", {});
  Random random(824);
  Workspace workspace;
  ConstraintPair pair;
  pair.along_curve = true;
  pair.a = side({shape(ShapeType::SPHERE, {0.2})});
  pair.b = side({shape(ShapeType::BOX, {0.5, 0.7, 0.6})});
  const auto guide = provider->prepare(pair), exact = distance->prepare(pair);
  ConstraintValue value, truth;
  int apart = 0, inside = 0;
  Tally tally;
  for (int i = 0; i < 60; ++i) {
    Case c;
    c.curve = randomCurve(random, 0);
    c.curve->points.row(0).array() -= random.uniform(0.5, 1.5);
    c.curve->radius = 0.0;
    c.b = random.pose(0.2);
    ConstraintCurve curve;
    curve.description = *c.curve;
    curve.curve = compile(*c.curve).curve;
    ConstraintPlace place;
    place.b = c.b;
    place.curve = &curve;
    guide->evaluate(place, workspace, value);
    exact->evaluate(place, workspace, truth);
    if (truth.lower > 0.0) {
      EXPECT_NEAR(value.value, truth.value, 1e-8);
      ++apart;
    } else if (truth.upper < -1e-6) {
      EXPECT_LT(value.value, 0.0);
      ++inside;
    }
    check(*guide, c, random, workspace, false, tally, TOLERANCE_BY_SUPPORTS);
  }
  EXPECT_GT(apart, 10);
  EXPECT_GT(inside, 10);
  EXPECT_GT(tally.valid, 40);
}

} // namespace
} // namespace curve_proximity
