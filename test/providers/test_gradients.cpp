/* SPDX-License-Identifier: BSD-3-Clause */
/* Every provider's gradient against finite differences of its own values, over random places; values against the core.
 */
#include "support.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace curve_proximity {
namespace {

/* A small step of everything that a value depends on. */
struct Step {
  Eigen::Vector3d linear_a, angular_a, linear_b, angular_b;
  Eigen::Matrix3Xd points;
  double radius = 0.0;
};

cprox_pose moved(const cprox_pose &pose, const Eigen::Vector3d &linear, const Eigen::Vector3d &angular, double h) {
  const Eigen::Vector3d w = h * angular;
  const double angle = w.norm();
  Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();
  if (angle > 0.0) turn = Eigen::Quaterniond(Eigen::AngleAxisd(angle, w / angle));
  const Eigen::Quaterniond q =
      turn * Eigen::Quaterniond(pose.orientation.w, pose.orientation.x, pose.orientation.y, pose.orientation.z);
  return {toVec3(toEigen(pose.position) + h * linear), {q.w(), q.x(), q.y(), q.z()}};
}

struct Case {
  cprox_pose a = CPROX_POSE_IDENTITY, b = CPROX_POSE_IDENTITY;
  std::optional<CurveDescription> curve;
};

/* Of a series only the first coefficient is a point: it alone moves with the curve. */
bool isSeries(const CurveDescription &curve) {
  return curve.basis == "polynomial" || curve.basis == "legendre" || curve.basis == "trigonometric";
}

double valueAt(const Constraint &constraint, const Case &c, const Step &step, double h, Workspace &workspace,
               ConstraintValue &value) {
  ConstraintPlace place;
  ConstraintCurve curve;
  place.b = moved(c.b, step.linear_b, step.angular_b, h);
  if (c.curve) {
    // The curve as a whole turns about the origin and moves; its points move by themselves on top.
    curve.description = *c.curve;
    Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
    const Eigen::Vector3d w = h * step.angular_a;
    if (w.norm() > 0.0) turn = Eigen::AngleAxisd(w.norm(), w.normalized()).toRotationMatrix();
    curve.description.points = turn * c.curve->points + h * step.points;
    const Eigen::Index n = isSeries(*c.curve) ? 1 : curve.description.points.cols();
    curve.description.points.leftCols(n).colwise() += h * step.linear_a;
    curve.description.radius += h * step.radius;
    curve.curve = compile(curve.description).curve;
    place.curve = &curve;
  } else {
    place.a = moved(c.a, step.linear_a, step.angular_a, h);
  }
  constraint.evaluate(place, workspace, value);
  return value.value;
}

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

Step randomStep(Random &random, const Case &c, bool planar = false) {
  Step s;
  s.linear_a = random.inCube(1.0), s.angular_a = random.inCube(1.0);
  s.linear_b = random.inCube(1.0), s.angular_b = random.inCube(1.0);
  if (planar) {
    s.linear_a.z() = s.linear_b.z() = 0.0;
    s.angular_a.head<2>().setZero();
    s.angular_b.head<2>().setZero();
  }
  if (c.curve) {
    s.points = Eigen::Matrix3Xd::Random(3, c.curve->points.cols());
    for (Eigen::Index i = 0; i < s.points.cols(); ++i) s.points.col(i) = random.inCube(1.0);
    s.radius = c.curve->radius > 0.0 ? random.uniform(-1.0, 1.0) : 0.0;
  }
  return s;
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

/* Seed 819: along 200 straight ways outward through the place where the spheres touch. */
TEST(Values, of_FourierGap_are_continuous_and_rise_where_the_bounding_spheres_part) {
  Random random(819);
  Workspace workspace;
  for (const char *mode : {"certified", "signal"}) {
    const Loaded provider("curve_proximity/FourierGap", {{"mode", std::string(mode)}, {"samples", 9}});
    ConstraintPair pair;
    pair.a = side({shape(ShapeType::BOX, {0.5, 0.7, 0.6})});
    pair.b = side({shape(ShapeType::SPHERE, {0.4})});
    const auto constraint = provider->prepare(pair);
    const double touching = 0.5 * Eigen::Vector3d(0.5, 0.7, 0.6).norm() + 0.4;
    ConstraintValue value;
    for (int i = 0; i < 200; ++i) {
      ConstraintPlace place;
      place.a = random.pose(0.0), place.b = random.pose(0.0);
      const Eigen::Vector3d away = random.direction();
      const auto at = [&](double distance) {
        place.b.position = toVec3(distance * away);
        constraint->evaluate(place, workspace, value);
        return value.value;
      };
      EXPECT_NEAR(at(touching * (1.0 - 1e-7)), at(touching * (1.0 + 1e-7)), 1e-5) << mode;
      double before = at(touching);
      for (const double factor : {1.01, 1.1, 1.3, 2.0, 5.0, 100.0}) {
        const double here = at(factor * touching);
        EXPECT_GT(here, before) << mode << " " << factor;
        before = here;
        if (value.bounded) {
          EXPECT_GE(value.lower, 0.0) << "the spheres are apart, so the bodies are proven to be";
        }
      }
      EXPECT_NEAR(before - at(50.0 * touching), 50.0 * touching, 1e-8) << "1 for each metre";
    }
  }
}

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

/* Seed 815, 300 places of a frustum under a slab, level or tilted by 1e-12 to 1e-2, apart and overlapping. What is
 * called a gradient is the derivative to either side: one-sided differences at steps of 1e-3 to 1e-7 of values that are
 * exact to 1e-12. */
void holdToEitherSide(bool by_planes) {
  const Loaded provider("curve_proximity/SuperquadricDistance", {{"epsilon", 1e-13}});
  Random random(815);
  Workspace workspace;
  ConstraintValue value, there;
  int valid = 0, refused = 0;
  for (int i = 0; i < 300; ++i) {
    ConstraintPair pair;
    const double w = i % 3 ? random.uniform(0.002, 0.02) : random.uniform(0.1, 0.9);
    pair.a = side({by_planes ? frustum(w) : frustumByCorners(w)});
    ShapeDescription slab;
    slab.type = ShapeType::IMPLICIT;
    slab.planes = {{1, 0, 0, -2}, {-1, 0, 0, -2}, {0, 1, 0, -2}, {0, -1, 0, -2}, {0, 0, 1, -1}, {0, 0, -1, -1}};
    pair.b = side({by_planes ? slab : shape(ShapeType::BOX, {4, 4, 2})});
    const auto constraint = provider->prepare(pair);
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
      EXPECT_LT(least, 1e-3) << "case " << i << " tilt " << tilt << " value " << here;
    }
  }
  std::printf("level faces: %d valid, %d refused\n", valid, refused);
  EXPECT_GT(valid, 30);
  EXPECT_GT(refused, 100);
}

TEST(Gradients, of_SuperquadricDistance_hold_to_either_side_where_faces_are_level) {
  holdToEitherSide(true);
}

TEST(Gradients, of_SuperquadricDistance_hold_to_either_side_where_a_polytope_is_level_with_a_box) {
  holdToEitherSide(false);
}

ShapeDescription byPlanes(const std::vector<std::array<double, 4>> &planes,
                          const std::vector<std::array<double, 10>> &quadrics = {}) {
  ShapeDescription out;
  out.type = ShapeType::IMPLICIT;
  out.planes = planes;
  out.quadrics = quadrics;
  return out;
}

/* Seed 817, 600 places. The truth is that of the interior point method for the same bodies by planes and quadrics: it
 * shares neither the support functions nor the search. Both are within 1e-9. */
TEST(Values, of_SuperquadricDistance_are_exact_for_bodies_that_are_no_superquadrics) {
  const Loaded provider("curve_proximity/SuperquadricDistance", {});
  Random random(817);
  Workspace workspace;
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.epsilon = 1e-9;
  std::vector<std::array<double, 4>> octahedron; // |x| + |y| + |z| <= 1/2
  for (int i = 0; i < 8; ++i) octahedron.push_back({i & 1 ? 1.0 : -1.0, i & 2 ? 1.0 : -1.0, i & 4 ? 1.0 : -1.0, -0.5});
  const std::vector<std::array<ShapeDescription, 2>> shapes = {
      {shape(ShapeType::BOX, {1.0, 0.8, 0.5}), byPlanes({{1, 0, 0, -0.5},
                                                         {-1, 0, 0, -0.5},
                                                         {0, 1, 0, -0.4},
                                                         {0, -1, 0, -0.4},
                                                         {0, 0, 1, -0.25},
                                                         {0, 0, -1, -0.25}})},
      {shape(ShapeType::CYLINDER, {0.6, 0.3}),
       byPlanes({{0, 0, 1, -0.3}, {0, 0, -1, -0.3}}, {{1, 0, 0, 1, 0, 0, 0, 0, 0, -0.09}})},
      {polytope(0.5 * (Eigen::Matrix3Xd(3, 6) << 1, -1, 0, 0, 0, 0, 0, 0, 1, -1, 0, 0, 0, 0, 0, 0, 1, -1).finished()),
       byPlanes(octahedron)},
      {shape(ShapeType::SUPERQUADRIC, {0.4, 0.3, 0.5, 2.5, 3.5, 5.0}),
       shape(ShapeType::SUPERQUADRIC, {0.4, 0.3, 0.5, 2.5, 3.5, 5.0})}};
  int overlapping = 0;
  for (std::size_t i = 0; i < 600; ++i) {
    const auto &x = shapes[i % 3], &y = shapes[i / 3 % 4];
    ConstraintPair pair;
    pair.a = side({x[0]});
    pair.b = side({y[0]});
    ConstraintPlace place;
    place.a = random.pose(0.6), place.b = random.pose(0.6);
    const ConstraintValue value = provider->evaluate(pair, place, workspace);
    const cprox_result truth =
        curve_proximity::pair(cprox_obstacle_at(makeGeometry(x[1]).body.get(), place.a),
                              cprox_obstacle_at(makeGeometry(y[1]).body.get(), place.b), options, workspace);
    EXPECT_EQ(value.status, CPROX_OK) << i;
    EXPECT_LE(value.upper - value.lower, 1e-9) << i;
    EXPECT_LE(value.lower, truth.upper) << i;
    EXPECT_GE(value.upper, truth.lower) << i;
    EXPECT_LE(truth.upper - truth.lower, 1e-8) << i;
    overlapping += truth.upper < 0.0;
  }
  EXPECT_GT(overlapping, 100);
  EXPECT_LT(overlapping, 500);
}

TEST(Values, are_negative_inside_and_a_margin_is_taken_off) {
  Workspace workspace;
  ConstraintPair pair;
  pair.along_curve = true;
  pair.b = side({shape(ShapeType::SPHERE, {0.5})});
  ConstraintCurve line;
  line.description.points = (Eigen::Matrix3Xd(3, 2) << -2, 2, 0.2, 0.2, 0, 0).finished();
  line.curve = compile(line.description).curve;
  ConstraintPlace place;
  place.curve = &line;
  const Loaded plain("curve_proximity/CurveDistance", {}),
      with_margin("curve_proximity/CurveDistance", {{"margin", 0.125}}),
      without_sign("curve_proximity/CurveDistance", {{"signed", false}});
  EXPECT_NEAR(plain->evaluate(pair, place, workspace).value, -0.3, 1e-9);
  EXPECT_NEAR(with_margin->evaluate(pair, place, workspace).value, -0.425, 1e-9);
  EXPECT_EQ(without_sign->evaluate(pair, place, workspace).lower, 0.0);
}

/* The same cube as a box and by its six planes, and a roof of five planes: V says clear at the same distance. */
TEST(Values, of_a_certified_FourierGap_of_planes_are_those_of_the_same_box) {
  const Loaded provider("curve_proximity/FourierGap", {});
  Workspace workspace;
  ShapeDescription cube, roof;
  cube.type = roof.type = ShapeType::IMPLICIT;
  cube.planes = {{1, 0, 0, -1}, {-1, 0, 0, -1}, {0, 1, 0, -1}, {0, -1, 0, -1}, {0, 0, 1, -1}, {0, 0, -1, -1}};
  roof.planes = {{0, 0, -1, 0}, {1, 0, 1, -1}, {-1, 0, 1, -1}, {0, 1, 1, -1}, {0, -1, 1, -1}};
  const auto clearFrom = [&](const ShapeDescription &s) {
    ConstraintPair pair;
    pair.a = side({shape(ShapeType::SPHERE, {0.2})});
    pair.b = side({s});
    const auto gap = provider->prepare(pair);
    ConstraintValue value;
    for (double away = 0.05; away < 3.0; away += 0.05) {
      ConstraintPlace place;
      place.a.position = {1.2 + away, 0.3, 0.2};
      gap->evaluate(place, workspace, value);
      if (value.lower >= 0.0) return away;
    }
    return 3.0;
  };
  const double of_box = clearFrom(shape(ShapeType::BOX, {2, 2, 2}));
  EXPECT_LE(of_box, 0.55);
  EXPECT_LE(std::fabs(clearFrom(cube) - of_box), 0.051);
  EXPECT_LE(clearFrom(roof), 0.55);
}

/* Seed 820. The truth is that of the bodies and their paddings themselves, by their support functions. */
TEST(Values, of_a_certified_FourierGap_are_positive_only_where_padded_and_implicit_bodies_do_not_overlap) {
  const Loaded provider("curve_proximity/FourierGap", {{"samples", 9}});
  const Loaded distance("curve_proximity/SuperquadricDistance", {});
  Random random(820);
  Workspace workspace;
  const Eigen::Matrix3Xd tetrahedron =
      (Eigen::Matrix3Xd(3, 4) << 0.5, -0.4, 0, 0, 0, 0.1, 0.5, -0.5, -0.3, -0.2, -0.3, 0.5).finished();
  ShapeDescription slab;
  slab.type = ShapeType::IMPLICIT;
  slab.planes = {{0, 0, 1, -0.1}, {0, 0, -1, -0.1}};
  slab.quadrics = {{1, 0, 0, 2, 0, 0, 0, 0, 0, -0.25}};
  int clear = 0, hit = 0;
  for (const ShapeDescription &s :
       {shape(ShapeType::SUPERQUADRIC, {0.4, 0.3, 0.5, 2.5, 3.5, 5.0}), slab, polytope(tetrahedron),
        shape(ShapeType::CONE, {0.7, 0.4}), shape(ShapeType::BOX, {0.4, 0.6, 0.5}),
        shape(ShapeType::ELLIPSOID, {0.4, 0.2, 0.5}), shape(ShapeType::CYLINDER, {0.6, 0.3}),
        shape(ShapeType::CAPSULE, {0.6, 0.2}), shape(ShapeType::SPHERE, {0.3})}) {
    ConstraintPair pair;
    pair.a = side({s}, 0.15);
    pair.b = side({shape(ShapeType::SPHERE, {0.4})});
    const auto gap = provider->prepare(pair), exact = distance->prepare(pair);
    ConstraintValue value, truth;
    for (int i = 0; i < 60; ++i) {
      ConstraintPlace place;
      place.a = random.pose(0.7), place.b = random.pose(0.7);
      gap->evaluate(place, workspace, value);
      exact->evaluate(place, workspace, truth);
      if (value.lower >= 0.0) {
        EXPECT_GE(truth.upper, 0.0) << shapeTypeName(s.type);
        ++clear;
      }
      hit += truth.upper < 0.0;
    }
  }
  EXPECT_GT(clear, 20);
  EXPECT_GT(hit, 20);
}

TEST(Values, of_a_certified_FourierGap_are_positive_only_where_the_interiors_do_not_overlap) {
  const Loaded provider("curve_proximity/FourierGap", {{"samples", 9}});
  const Loaded distance("curve_proximity/SuperquadricDistance", {});
  Random random(814);
  Workspace workspace;
  ConstraintPair pair;
  pair.a = side({shape(ShapeType::ELLIPSOID, {0.5, 0.3, 0.4})});
  pair.b = side({shape(ShapeType::SPHERE, {0.4})});
  const auto gap = provider->prepare(pair), exact = distance->prepare(pair);
  ConstraintValue value, truth;
  int clear = 0, hit = 0;
  for (int i = 0; i < 500; ++i) {
    ConstraintPlace place;
    place.a = random.pose(1.0), place.b = random.pose(1.0);
    gap->evaluate(place, workspace, value);
    exact->evaluate(place, workspace, truth);
    if (value.lower >= 0.0) {
      EXPECT_GE(truth.upper, 0.0);
      ++clear;
    }
    hit += truth.upper < 0.0;
  }
  EXPECT_GT(clear, 20);
  EXPECT_GT(hit, 20);
}

/* The convex pieces of two unions of boxes, which overlap each other at places. */
ConstraintPair unions() {
  ShapeDescription arm = shape(ShapeType::BOX, {0.3, 0.8, 0.6}), foot = shape(ShapeType::BOX, {0.9, 0.25, 0.6});
  arm.pose.translation() = Eigen::Vector3d(-0.3, 0.3, 0.0);
  ConstraintPair pair;
  pair.a = side({arm, foot}, 0.02);
  pair.b = side({shape(ShapeType::CAPSULE, {0.5, 0.2}), shape(ShapeType::ELLIPSOID, {0.5, 0.3, 0.4})});
  return pair;
}

/* The same place seen from a frame that is turned and moved: the truth is the same, the rounding is not. */
ConstraintPlace seenFrom(const Eigen::Isometry3d &frame, const ConstraintPlace &place) {
  ConstraintPlace out = place;
  for (cprox_pose ConstraintPlace::*side : {&ConstraintPlace::a, &ConstraintPlace::b}) {
    const cprox_pose &p = place.*side;
    const Eigen::Quaterniond q = Eigen::Quaterniond(frame.linear()) *
                                 Eigen::Quaterniond(p.orientation.w, p.orientation.x, p.orientation.y, p.orientation.z);
    out.*side = {toVec3(frame * toEigen(p.position)), {q.w(), q.x(), q.y(), q.z()}};
  }
  return out;
}

/* Seed 821, from the same centre to apart, so that all stages and both hand-overs are met. The distance is that of
 * SuperquadricDistance. */
TEST(Values, of_a_guide_are_the_distance_apart_and_below_0_exactly_where_the_sides_overlap) {
  const Loaded provider("curve_proximity/FourierGap", {{"mode", std::string("guide")}, {"samples", 33}});
  const Loaded distance("curve_proximity/SuperquadricDistance", {});
  Random random(821);
  Workspace workspace;
  const ConstraintPair pair = unions();
  const auto guide = provider->prepare(pair), exact = distance->prepare(pair);
  ConstraintValue value, truth, seen;
  int apart = 0, inside = 0, about = 0;
  double widest = 0.0;
  for (int i = 0; i < 600; ++i) {
    ConstraintPlace place;
    place.a = random.pose(0.2), place.b = random.pose(0.2);
    place.b.position = toVec3(toEigen(place.b.position) + random.uniform(0.0, 1.6) * random.direction());
    exact->evaluate(place, workspace, truth);
    if (i % 3 == 0) { // to within a hundredth of contact
      const double to = random.uniform(-0.01, 0.01);
      for (int k = 0; k < 30; ++k) {
        place.b.position = toVec3(toEigen(place.b.position) + (to - truth.value) * truth.b.linear);
        exact->evaluate(place, workspace, truth);
      }
      about += std::abs(truth.value) < 0.011;
    }
    guide->evaluate(place, workspace, value);
    ASSERT_TRUE(value.bounded);
    EXPECT_LE(value.lower, value.value);
    EXPECT_GE(value.upper, value.value);
    widest = std::max(widest, value.upper - value.lower);
    if (truth.lower > 0.0) {
      EXPECT_EQ(value.value, truth.value);
      EXPECT_EQ(value.valid, truth.valid);
      ++apart;
    } else if (truth.upper < 0.0) {
      EXPECT_LT(value.upper, 0.0) << "at a depth of " << -truth.value;
      ++inside;
    }
    Eigen::Isometry3d frame = Eigen::Isometry3d::Identity();
    frame.linear() = random.rotation().toRotationMatrix();
    frame.translation() = random.inCube(1.0);
    guide->evaluate(seenFrom(frame, place), workspace, seen);
    EXPECT_LE(value.lower, seen.upper);
    EXPECT_GE(value.upper, seen.lower);
  }
  std::printf("guide: %d apart, %d inside, %d about contact, widest %.1e\n", apart, inside, about, widest);
  EXPECT_GT(apart, 100);
  EXPECT_GT(inside, 200);
  EXPECT_GT(about, 100);
  EXPECT_LT(widest, 1e-5);
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

/* Seed 823: along straight ways from within to apart no value jumps by more than its steepest slope allows. */
TEST(Values, of_a_guide_have_no_jump_on_the_way_out) {
  const Loaded provider("curve_proximity/FourierGap", {{"mode", std::string("guide")}, {"samples", 17}});
  Random random(823);
  Workspace workspace;
  const auto guide = provider->prepare(unions());
  ConstraintValue value;
  constexpr double STEP = 1e-3, STEEPEST = 30.0;
  for (int i = 0; i < 4; ++i) {
    ConstraintPlace place;
    place.a = random.pose(0.0), place.b = random.pose(0.0);
    const Eigen::Vector3d away = random.direction();
    double before = std::numeric_limits<double>::quiet_NaN();
    for (double s = 0.0; s < 1.6; s += STEP) {
      place.b.position = toVec3(s * away);
      guide->evaluate(place, workspace, value);
      if (s > 0.0) {
        ASSERT_LE(std::abs(value.value - before), STEEPEST * STEP) << i << " at " << s;
      }
      before = value.value;
    }
  }
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

TEST(Values, of_a_guide_are_refused_where_no_depth_is_known) {
  const Loaded provider("curve_proximity/FourierGap", {{"mode", std::string("guide")}});
  ConstraintPair pair;
  pair.a = side({shape(ShapeType::SPHERE, {0.2})});
  pair.b = pair.a;
  pair.b.parts[0].excess = 1e-3; // a hull stands for it
  try {
    provider->prepare(pair);
    FAIL();
  } catch (const Error &error) {
    EXPECT_NE(std::string(error.what()).find("give convex parts"), std::string::npos) << error.what();
  }
}

/* Seed 825: 100 places of two boxes where V/t = 1: a metre apart is a metre of value there, in the median. */
TEST(Values, of_a_certified_FourierGap_have_a_slope_near_1_where_they_change_sign) {
  Random random(825);
  Workspace workspace;
  ConstraintPair pair;
  pair.a = side({shape(ShapeType::BOX, {0.6, 0.8, 0.5})});
  pair.b = side({shape(ShapeType::BOX, {0.5, 0.4, 0.7})});
  for (const int samples : {17, 33}) {
    const Loaded provider("curve_proximity/FourierGap", {{"samples", samples}});
    const auto gap = provider->prepare(pair);
    ConstraintValue value;
    std::vector<double> slopes;
    for (int i = 0; i < 100; ++i) {
      ConstraintPlace place;
      place.a = random.pose(0.0), place.b = random.pose(0.0);
      const Eigen::Vector3d away = random.direction();
      double low = 0.0, high = 2.0;
      for (int k = 0; k < 30; ++k) {
        const double s = 0.5 * (low + high);
        place.b.position = toVec3(s * away);
        gap->evaluate(place, workspace, value);
        (value.value < 0.0 ? low : high) = s;
      }
      slopes.push_back(value.b.linear.norm());
    }
    std::sort(slopes.begin(), slopes.end());
    EXPECT_GT(slopes[50], 0.75) << samples;
    EXPECT_LT(slopes[50], 1.25) << samples;
    EXPECT_LT(slopes.back(), 3.0) << samples;
  }
}

/* Seed 826: places where two unions of boxes touch, found by their distance. */
TEST(Values, of_a_signal_are_a_penalty_within_its_bounds_where_the_sides_touch) {
  const Loaded provider("curve_proximity/FourierGap", {{"mode", std::string("signal")}, {"samples", 9}});
  const Loaded distance("curve_proximity/SuperquadricDistance", {});
  Random random(826);
  Workspace workspace;
  ConstraintPair pair;
  ShapeDescription arm = shape(ShapeType::BOX, {0.3, 0.8, 0.6}), foot = shape(ShapeType::BOX, {0.9, 0.25, 0.6});
  arm.pose.translation() = Eigen::Vector3d(-0.3, 0.55, 0.0);
  pair.a = side({arm, foot});
  pair.b = side({shape(ShapeType::BOX, {0.5, 0.4, 0.7})});
  const auto signal = provider->prepare(pair), exact = distance->prepare(pair);
  ConstraintValue value, truth;
  int finite = 0;
  for (int i = 0; i < 300; ++i) {
    ConstraintPlace place;
    place.a = random.pose(0.0), place.b = random.pose(0.0);
    const Eigen::Vector3d away = random.direction();
    double low = 0.0, high = 3.0;
    for (int k = 0; k < 60; ++k) {
      const double s = 0.5 * (low + high);
      place.b.position = toVec3(s * away);
      exact->evaluate(place, workspace, truth);
      (truth.value <= 0.0 ? low : high) = s;
    }
    signal->evaluate(place, workspace, value);
    EXPECT_TRUE(value.penalty);
    EXPECT_FALSE(value.bounded);
    EXPECT_GE(value.value, value.touching_least);
    EXPECT_LE(value.value, value.touching_most);
    finite += std::isfinite(value.touching_least);
  }
  EXPECT_EQ(finite, 300);
}

} // namespace
} // namespace curve_proximity
