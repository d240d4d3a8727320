/* SPDX-License-Identifier: BSD-3-Clause */
/* Values of the providers against the core, against supports, and along ways that part the sides. */
#include "support.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace curve_proximity {
namespace {

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
