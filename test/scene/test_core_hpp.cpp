/* SPDX-License-Identifier: BSD-3-Clause */
/* The C++ face of the core: handles, conversions, failures as exceptions. */
#include "support.h"

using namespace curve_proximity;
using namespace curve_proximity::test;

TEST(CoreHpp, a_failure_is_an_error_with_the_cores_message) {
  const std::string reason = errorOf([] { makeSphere(-1.0); });
  EXPECT_FALSE(reason.empty());
  expectContains(reason, "radius");
}

TEST(CoreHpp, identity_rotations_stay_exact) {
  const cprox_pose pose = toPose(translation(1.0, -2.0, 0.1));
  EXPECT_EQ(pose.orientation.w, 1.0);
  EXPECT_EQ(pose.orientation.x, 0.0);
  EXPECT_EQ(pose.orientation.y, 0.0);
  EXPECT_EQ(pose.orientation.z, 0.0);
  EXPECT_EQ(pose.position.z, 0.1);
}

/* Tolerance: 16 roundings each way (core.hpp), 2^-53 each. */
TEST(CoreHpp, poses_survive_the_way_to_quaternions_and_back) {
  Random random(1);
  for (int i = 0; i < 10000; ++i) {
    const Eigen::Isometry3d pose = random.pose(2.0);
    EXPECT_LE((toIsometry(toPose(pose)).matrix() - pose.matrix()).cwiseAbs().maxCoeff(), 32 * 0x1p-53);
  }
}

TEST(CoreHpp, quaternions_need_no_norm_but_not_0) {
  const Eigen::Isometry3d tiny = toIsometry({{0, 0, 0}, {1e-200, 0, 0, 1e-200}});
  EXPECT_NEAR(tiny.linear()(1, 0), 1.0, 1e-15); // a quarter turn about z
  const Eigen::Isometry3d huge = toIsometry({{0, 0, 0}, {1e300, 0, 0, 1e300}});
  EXPECT_NEAR(huge.linear()(1, 0), 1.0, 1e-15);
  expectContains(errorOf([] { toIsometry({{0, 0, 0}, {0, 0, 0, 0}}); }), "norm is 0");
  expectContains(errorOf([] { toIsometry({{0, 0, 0}, {0, NAN, 0, 1}}); }), "not finite");
}

TEST(CoreHpp, a_compound_keeps_its_parts_alive) {
  BodyHandle compound;
  {
    const BodyHandle ball = makeSphere(0.5);
    compound = makeCompound({ball, ball}, {translation(-2, 0, 0), translation(2, 0, 0)});
  }
  EXPECT_NEAR(cprox_body_nearest(compound.get(), {2.0, 0.0, 1.5}, nullptr), 1.0, 1e-14);
  expectContains(errorOf([] { makeCompound({makeSphere(1.0)}, {}); }), "as many poses");
}

TEST(CoreHpp, queries_answer_with_eigen_in_and_out) {
  Workspace workspace;
  const cprox_options options = CPROX_OPTIONS_DEFAULT;
  Eigen::Matrix3Xd points(3, 3);
  points << -1, 0, 1, /**/ 2, 1, 2, /**/ 0, 0, 0;
  const CurveHandle curve = makeBezier(points);
  const BodyHandle box = makeBox({1.0, 1.0, 1.0});

  // The curve's lowest point is (0, 1.5, 0): 1 above the box's top at 0.5.
  const cprox_result r = distance(along(curve), at(box), options, workspace);
  EXPECT_EQ(r.status, CPROX_OK);
  EXPECT_LE(r.lower, 1.0);
  EXPECT_GE(r.upper, 1.0);
  EXPECT_NEAR((toEigen(r.witness_mover) - Eigen::Vector3d(0, 1.5, 0)).norm(), 0.0, 1e-2);
  EXPECT_EQ(tolerance(along(curve), at(box), 0.99, options, workspace).verdict, CPROX_VERDICT_CLEAR);
  EXPECT_EQ(tolerance(along(curve, 0.1), at(box), 0.99, options, workspace).verdict, CPROX_VERDICT_VIOLATED);
  EXPECT_EQ(collision(along(curve), at(box, translation(0, 1.25, 0)), options, workspace).verdict,
            CPROX_VERDICT_VIOLATED);
  EXPECT_EQ(collision(along(curve), at(box, Eigen::Isometry3d::Identity(), 1.1), options, workspace).verdict,
            CPROX_VERDICT_VIOLATED);

  // Planar polygons and standing pairs.
  Eigen::Matrix2Xd triangle(2, 3);
  triangle << 0, 1, 0, /**/ 0, 0, 1;
  const BodyHandle polygon = makePolygon(triangle);
  const cprox_result p = pair(at(polygon), at(box, translation(-1.5, 0, 0)), options, workspace);
  EXPECT_LE(p.lower, 1.0);
  EXPECT_GE(p.upper, 1.0);
}

TEST(CoreHpp, a_spline_is_the_same_as_its_only_span) {
  Random random(2);
  const CurveDescription d = randomBezier(random, 3, 1.0);
  const CurveHandle bezier = makeBezier(d.points, 2.0, 5.0);
  const CurveHandle spline = makeBspline(d.points, 3, {2, 2, 2, 2, 5, 5, 5, 5}, 2.0, 5.0);
  for (const double t : {2.0, 2.7, 4.1, 5.0}) {
    cprox_vec3 a, b;
    ASSERT_EQ(cprox_curve_evaluate(bezier.get(), t, nullptr, &a, nullptr, nullptr), CPROX_OK);
    ASSERT_EQ(cprox_curve_evaluate(spline.get(), t, nullptr, &b, nullptr, nullptr), CPROX_OK);
    EXPECT_NEAR((toEigen(a) - toEigen(b)).norm(), 0.0, 1e-14);
  }
}

TEST(CoreHpp, a_refused_query_throws_and_the_next_is_answered) {
  Workspace workspace;
  const BodyHandle box = makeBox({1.0, 1.0, 1.0});
  const CurveHandle curve = makeBezier(Eigen::Matrix3Xd::Random(3, 4) + Eigen::Matrix3Xd::Constant(3, 4, 5.0));
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.epsilon = NAN;
  expectContains(errorOf([&] { distance(along(curve), at(box), options, workspace); }), "epsilon");
  EXPECT_GT(distance(along(curve), at(box), CPROX_OPTIONS_DEFAULT, workspace).lower, 0.0);
}

/* The unit circle about z, four ways, and the ball of radius 1/2 about (3, 0, 0) that is 1.5 away from it. */
TEST(CoreHpp, every_maker_of_a_circle_makes_the_same_circle) {
  Workspace workspace;
  const double pi = 3.14159265358979323846;
  SmoothCurve smooth;
  smooth.evaluate = [](double t) {
    const Eigen::Vector3d x(std::cos(t), std::sin(t), 0.0);
    return std::array<Eigen::Vector3d, 3>{{x, Eigen::Vector3d(-x.y(), x.x(), 0.0), -x}};
  };
  smooth.sixth = [](double, double) { return 1.0; };
  smooth.error = {{4e-16, 4e-16, 4e-16}};
  RectifiableCurve rectifiable;
  rectifiable.point = [](double t) { return Eigen::Vector3d(std::cos(t), std::sin(t), 0.0); };
  rectifiable.length = [](double a, double b) { return (b - a) * (1.0 + 1e-15); };
  rectifiable.error = 4e-16;

  const std::vector<CurveHandle> circles = {
      makeClothoid({1, 0, 0}, 0.5 * pi, 1.0, 0.0, -pi, pi),
      makeDubins({0, -1, 0}, 0.0, {0, 1, 0}, pi, 1.0),
      makeSmooth(smooth, -pi, pi),
      makeRectifiable(rectifiable, -pi, pi),
      makePiecewise({makeSmooth(smooth, -pi, 0.0), makeSmooth(smooth, 0.0, pi)}),
  };
  const BodyHandle ball = makeSphere(0.5);
  for (const CurveHandle &circle : circles) {
    const cprox_result r = distance(along(circle), at(ball, translation(3, 0, 0)), CPROX_OPTIONS_DEFAULT, workspace);
    EXPECT_LE(r.lower, 1.5);
    EXPECT_GE(r.upper, 1.5);
    EXPECT_EQ(r.status, CPROX_OK);
  }
}

TEST(CoreHpp, curves_of_functions_keep_them_and_say_what_went_wrong) {
  Workspace workspace;
  CurveHandle curve;
  {
    RectifiableCurve line;
    const auto far = std::make_shared<double>(5.0);
    line.point = [far](double t) { return Eigen::Vector3d(*far, t, 0.0); };
    line.velocity = [](double) { return Eigen::Vector3d(0.0, 1.0, 0.0); };
    line.error = 1e-15;
    curve = makeRectifiable(line, -1.0, 1.0);
  }
  const BodyHandle ball = makeSphere(1.0);
  const cprox_result r = distance(along(curve), at(ball), CPROX_OPTIONS_DEFAULT, workspace);
  EXPECT_NEAR(r.upper, 4.0, 1e-5);

  RectifiableCurve wrong;
  wrong.point = [](double t) -> Eigen::Vector3d { return t < 0.5 ? Eigen::Vector3d(t, 0, 0) : throw Error("no"); };
  wrong.length = [](double a, double b) { return b - a; };
  expectContains(errorOf([&] { makeRectifiable(wrong, 0.0, 1.0); }), "at t = 0.5 the curve's point is (nan");

  SmoothCurve thrower;
  thrower.evaluate = [](double) -> std::array<Eigen::Vector3d, 3> { throw Error("mine"); };
  thrower.sixth = [](double, double) { return 0.0; };
  EXPECT_EQ(errorOf([&] { makeSmooth(thrower, 0.0, 1.0); }), "mine");
}

TEST(CoreHpp, involutes_and_pythagorean_curves_are_made) {
  const CurveHandle involute = makeInvolute({1, 2, 3}, 0.5, 0.0, 0.0, 6.0);
  cprox_vec3 x;
  ASSERT_EQ(cprox_curve_evaluate(involute.get(), 0.0, nullptr, &x, nullptr, nullptr), CPROX_OK);
  EXPECT_NEAR((toEigen(x) - Eigen::Vector3d(1.5, 2, 3)).norm(), 0.0, 1e-12);

  // (1 + is)²: (s - s³/3, s²)
  const CurveHandle cubic = makePythagoreanHodograph({0, 0, 0}, {{1, 0, 0, 0}, {1, 0, 0, 1}});
  ASSERT_EQ(cprox_curve_evaluate(cubic.get(), 1.0, nullptr, &x, nullptr, nullptr), CPROX_OK);
  EXPECT_NEAR((toEigen(x) - Eigen::Vector3d(2.0 / 3.0, 1, 0)).norm(), 0.0, 1e-15);
  expectContains(errorOf([&] { makePiecewise({cubic, cubic}, {0.0, 1.0}); }), "n + 1");
}

TEST(CoreHpp, a_set_answers_as_its_targets_do) {
  const BodyHandle ball = makeSphere(0.5), floor = makeHalfspace({0, 0, 1}, 3.0);
  std::vector<cprox_obstacle> targets{at(floor)};
  for (int i = 0; i < 40; ++i) targets.push_back(at(ball, Eigen::Isometry3d(Eigen::Translation3d(i, 0.1 * i, 2.0))));
  const Obstacles set(targets), list(targets, CPROX_INDEX_NONE);
  EXPECT_EQ(set.size(), 41u);
  const CurveHandle curve = makeBezier((Eigen::Matrix3Xd(3, 2) << 5, 9, 0, 0, 0, 0).finished());
  Workspace workspace;
  const cprox_options options = CPROX_OPTIONS_DEFAULT;
  const cprox_result all = list.distance(along(curve), options, workspace);
  EXPECT_NEAR(set.distance(along(curve), options, workspace).upper, all.upper, 1e-6);
  EXPECT_EQ(set.collision(along(curve), options, workspace).verdict, CPROX_VERDICT_CLEAR);
  EXPECT_EQ(set.tolerance(along(curve), 1.0, options, workspace).verdict, CPROX_VERDICT_CLEAR);
  EXPECT_EQ(set.timeOfContact(along(curve, 1.6), options, workspace).verdict, CPROX_VERDICT_VIOLATED);
  const std::vector<cprox_result> nearest = set.nearest(along(curve), 3, options, workspace);
  ASSERT_EQ(nearest.size(), 3u);
  EXPECT_LE(nearest[0].upper, nearest[2].upper);
  EXPECT_EQ(nearest[0].obstacle_index, all.obstacle_index);
  expectContains(errorOf([&] { Obstacles({cprox_obstacle{}}); }), "obstacle 0");
}

TEST(CoreHpp, sets_by_their_distance_are_asked_like_bodies) {
  const CurveHandle line = makeBezier((Eigen::Matrix3Xd(3, 2) << -1, 1, 0.8, 0.8, 0, 0).finished());
  const auto distance = [&](const BodyHandle &body) {
    Workspace workspace;
    cprox_result result = {};
    require(cprox_distance(along(line), at(body), nullptr, workspace.get(), &result), workspace);
    return result;
  };
  const auto ball = [](const Eigen::Vector3d &x) { return x.norm() - 0.5; };
  EXPECT_NEAR(distance(makeDistance(ball, {0, 0, 0}, 0.5)).upper, 0.3, 1e-6);
  const BodyHandle off = makeDistance(ball, {0, 0, 0}, 0.6, 1.0, 0.01);
  EXPECT_LE(distance(off).lower, 0.3 - 0.01 + 1e-6);
  EXPECT_GE(distance(off).upper, 0.3 + 0.01 - 1e-6);
  const auto throws = [](const Eigen::Vector3d &x) { return x.x() > 5.0 ? throw Error("mine") : x.norm() - 0.5; };
  EXPECT_NEAR(distance(makeDistance(throws, {0, 0, 0}, 0.5)).upper, 0.3, 1e-6);
  const auto always = [](const Eigen::Vector3d &) -> double { throw Error("mine"); };
  expectContains(errorOf([&] { makeDistance(always, {0, 0, 0}, 0.5); }), "answered nan at");
  expectContains(errorOf([&] { makeDistance(nullptr, {0, 0, 0}, 0.5); }), "empty");

  // a point at the origin of a grid, and ground at height 0
  std::vector<double> values;
  for (int i = 0; i < 27; ++i) values.push_back(Eigen::Vector3d(i % 3, i / 3 % 3, i / 9).norm());
  const cprox_result grid = distance(makeDistanceGrid({3, 3, 3}, 1.0, values));
  EXPECT_LE(grid.lower, 0.8);
  EXPECT_GE(grid.upper, 0.8);
  expectContains(errorOf([&] { makeDistanceGrid({3, 3, 2}, 1.0, values); }), "one value for each point");
  const BodyHandle ground = makeHeightField({2, 2}, {1.0, 0.5}, {0.0, 0.0, 0.0, 0.0}, -1.0);
  EXPECT_NEAR(distance(ground).upper, 0.3, 1e-6);
  EXPECT_TRUE(cprox_body_get_info(ground.get()).is_solid);
  expectContains(errorOf([&] { makeHeightField({2, 2}, {1.0, 0.5}, {0.0}); }), "one height for each point");
}

TEST(CoreHpp, convex_functions_that_throw_are_refused_by_maker_and_query) {
  const CurveHandle line = makeBezier((Eigen::Matrix3Xd(3, 2) << -1, 1, 0.8, 0.8, 0, 0).finished());
  std::string says = "a ball";
  const auto function = [&](const Eigen::Vector3d &x, Eigen::Vector3d &gradient, Eigen::Matrix3d &hessian) {
    if (says == "throws") throw Error("mine");
    gradient = 2.0 * x;
    hessian = 2.0 * Eigen::Matrix3d::Identity();
    return says == "nan" ? std::numeric_limits<double>::quiet_NaN() : x.squaredNorm() - 0.25;
  };
  const BodyHandle ball = makeConvexFunction(function, {0, 0, 0}, 0.6);
  const auto distance = [&] {
    Workspace workspace;
    cprox_result result = {};
    require(cprox_distance(along(line), at(ball), nullptr, workspace.get(), &result), workspace);
    return result.upper;
  };
  EXPECT_NEAR(distance(), 0.3, 1e-6);
  for (const char *word : {"throws", "nan"}) {
    says = word;
    EXPECT_NE(errorOf(distance), "") << word;
    expectContains(errorOf([&] { makeConvexFunction(function, {0, 0, 0}, 0.6); }), "not finite");
  }
  expectContains(errorOf([] { makeConvexFunction(nullptr, {0, 0, 0}, 1.0); }), "empty");
}
