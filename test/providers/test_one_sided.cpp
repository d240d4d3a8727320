/* SPDX-License-Identifier: BSD-3-Clause */
/* A hull bounds from one side only: distances of meshes and outlines that are not convex, against their triangles and
 * edges. */
#include <cmath>

#include "support.h"

namespace curve_proximity {
namespace {

/* A block with a V-groove along y: its walls go from (0.5, y, 0.1) up to both sides at z = 0.5. */
ShapeDescription groove() {
  ShapeDescription out;
  out.type = ShapeType::MESH;
  out.solid = true;
  out.vertices.resize(3, 10);
  out.vertices << 0, 1, 1, 0, 0, 0, 1, 1, 0.5, 0.5, 0, 0, 0.5, 0.5, 0, 0.5, 0, 0.5, 0, 0.5, 0, 0, 0, 0, 0.5, 0.5, 0.5,
      0.5, 0.1, 0.1;
  out.triangles.resize(3, 16);
  out.triangles << 0, 0, 1, 3, 3, 2, 0, 1, 0, 3, 1, 2, 4, 5, 8, 9, 8, 1, 6, 5, 9, 9, 3, 3, 4, 4, 2, 7, 8, 8, 6, 6, 4, 8,
      8, 9, 2, 7, 1, 2, 3, 5, 6, 6, 5, 9, 9, 7;
  return out;
}

/* An L in the plane, its arms 0.1 wide. */
ShapeDescription angle() {
  ShapeDescription out;
  out.type = ShapeType::POLYGON;
  out.vertices.resize(3, 6);
  out.vertices << 0, 0.3, 0.3, 0.1, 0.1, 0, 0, 0, 0.1, 0.1, 0.3, 0.3, 0, 0, 0, 0, 0, 0;
  return out;
}

/* As the doors ask: of a standing body at a place, or of a ball along a curve. */
ConstraintRow ask(ProviderSet &providers, ConstraintCase described) {
  Workspace workspace;
  described.providers = {"it"};
  ConstraintRow row = answerCase(providers, described, ResourceOptions(), workspace).front();
  row.constraint.reset(); // it must not outlive its provider
  return row;
}

ConstraintRow ask(const ConstraintCase &described, const std::string &type, const ParameterMap &parameters) {
  ProviderSet providers({{"it", type, parameters}});
  return ask(providers, described);
}

ObjectDescription object(const std::vector<ShapeDescription> &shapes) {
  ObjectDescription out;
  out.shapes = shapes;
  return out;
}

ConstraintCase standing(const ShapeDescription &a, const Eigen::Vector3d &at, const ShapeDescription &b) {
  ConstraintCase out;
  out.a = object({a});
  out.a.pose.translation() = at;
  out.b = object({b});
  return out;
}

ConstraintCase along(const Eigen::Vector3d &from, const Eigen::Vector3d &to, double radius, const ShapeDescription &b) {
  ConstraintCase out;
  out.b = object({b});
  out.curve.emplace();
  out.curve->basis = "bezier";
  out.curve->radius = radius;
  out.curve->points.resize(3, 2);
  out.curve->points << from, to;
  return out;
}

const std::vector<std::string> BOTH = {"curve_proximity/CurveDistance", "curve_proximity/SuperquadricDistance"};

void expectAnswer(const ConstraintRow &row, double lower, double upper) {
  ASSERT_GE(row.status, 0) << row.message;
  EXPECT_TRUE(row.value.bounded);
  EXPECT_LE(row.value.lower, upper + 1e-8);
  EXPECT_GE(row.value.upper, lower - 1e-8);
  EXPECT_LE(row.value.upper - row.value.lower, upper - lower + 2e-8);
  EXPECT_LE(row.value.lower - 1e-12, row.value.value);
  EXPECT_LE(row.value.value, row.value.upper + 1e-12);
}

/* To the walls, which pass through (0.5, 0.1) and rise by 0.4 over 0.5. */
double toWall(double x, double z) {
  return ((z - 0.1) * 0.5 - std::abs(x - 0.5) * 0.4) / std::hypot(0.5, 0.4);
}

TEST(OneSided, a_ball_in_a_groove_is_as_far_as_from_its_walls_and_has_no_gradient_between_them) {
  const double wanted = toWall(0.5, 0.45) - 0.02;
  EXPECT_NEAR(wanted, 0.2533, 1e-4);
  for (const std::string &type : BOTH) {
    for (const bool curve : {false, true}) {
      const auto at = [&](double x) {
        return curve ? along({x, 0.2, 0.45}, {x, 0.3, 0.45}, 0.02, groove())
                     : standing(shape(ShapeType::SPHERE, {0.02}), {x, 0.25, 0.45}, groove());
      };
      const ConstraintRow between = ask(at(0.5), type, {});
      expectAnswer(between, wanted, wanted);
      EXPECT_EQ(between.status, CPROX_OK);
      EXPECT_FALSE(between.value.valid);
      EXPECT_FALSE(between.message.empty());
      const ConstraintRow beside = ask(at(0.45), type, {});
      expectAnswer(beside, toWall(0.45, 0.45) - 0.02, toWall(0.45, 0.45) - 0.02);
      if (curve) continue; /* the wall is level with the curve */
      EXPECT_TRUE(beside.value.valid) << beside.message;
      EXPECT_NEAR(beside.value.a.linear.z(), 0.5 / std::hypot(0.5, 0.4), 1e-6);
    }
  }
}

TEST(OneSided, a_ball_beside_the_notch_of_an_outline_is_as_far_as_from_its_arms) {
  for (const std::string &type : BOTH) {
    expectAnswer(ask(along({0.25, 0.25, 0.0}, {0.25, 0.25, 0.1}, 0.02, angle()), type, {}), 0.13, 0.13);
    expectAnswer(ask(standing(shape(ShapeType::SPHERE, {0.02}), {0.25, 0.25, 0.0}, angle()), type, {}), 0.13, 0.13);
  }
  ShapeDescription crossed = angle();
  crossed.vertices.col(1).swap(crossed.vertices.col(2));
  const ConstraintRow row = ask(standing(shape(ShapeType::SPHERE, {0.02}), {0, 0, 1}, crossed), BOTH[1], {});
  EXPECT_LT(row.status, 0);
  EXPECT_NE(row.message.find("crosses itself"), std::string::npos) << row.message;
}

TEST(OneSided, what_is_carried_or_stands_as_a_mesh_is_measured_as_well) {
  /* the block as side a, the ball as side b: at its origin the block has the ball in its groove */
  ConstraintCase carried = along({0, 0, 0}, {0, 0.1, 0}, 0.0, shape(ShapeType::SPHERE, {0.02}));
  carried.a = object({groove()});
  carried.b.pose.translation() = Eigen::Vector3d(0.5, 0.25, 0.45);
  const double wanted = toWall(0.5, 0.45) - 0.02;
  for (const std::string &type : BOTH) {
    expectAnswer(ask(carried, type, {}), wanted, wanted);
    ConstraintCase two = standing(groove(), {0, 0, 0}, shape(ShapeType::SPHERE, {0.02}));
    two.b.pose.translation() = Eigen::Vector3d(0.5, 0.25, 0.45);
    expectAnswer(ask(two, type, {}), wanted, wanted);
    /* inside of the solid it overlaps, though no surface is near */
    carried.b.pose.translation() = Eigen::Vector3d(0.1, 0.25, 0.2);
    const ConstraintRow inside = ask(carried, type, {});
    EXPECT_EQ(inside.status, CPROX_OVERLAP) << inside.message;
    EXPECT_LT(inside.value.lower, -0.1);
    EXPECT_EQ(inside.value.upper, 0.0);
    carried.b.pose.translation() = Eigen::Vector3d(0.5, 0.25, 0.45);
  }
}

TEST(OneSided, in_an_overlap_the_hull_gives_value_gradient_and_the_lower_end_alone) {
  for (const std::string &type : BOTH) {
    const ConstraintRow row = ask(standing(shape(ShapeType::SPHERE, {0.02}), {0.2, 0.25, 0.29}, groove()), type, {});
    EXPECT_EQ(row.status, CPROX_OVERLAP);
    EXPECT_NEAR(row.value.value, -0.22, 1e-6); /* out by the end, or the hull's top: 0.21 and the radius */
    EXPECT_LE(row.value.lower, row.value.value);
    EXPECT_EQ(row.value.upper, 0.0);
  }
}

TEST(OneSided, by_hulls_the_upper_end_is_that_of_the_shapes) {
  const double wanted = toWall(0.5, 0.45) - 0.02;
  for (const std::string &type : BOTH) {
    for (const ConstraintCase &described : {along({0.5, 0.2, 0.45}, {0.5, 0.3, 0.45}, 0.02, groove()),
                                            standing(shape(ShapeType::SPHERE, {0.02}), {0.5, 0.25, 0.45}, groove())}) {
      const ConstraintRow row = ask(described, type, {{"meshes", std::string("hull")}});
      ASSERT_GE(row.status, 0) << row.message;
      EXPECT_NEAR(row.value.value, -0.07, 1e-6);
      EXPECT_NEAR(row.value.lower, -0.07, 1e-6);
      EXPECT_NEAR(row.value.upper, wanted, 1e-6);
    }
  }
}

TEST(OneSided, superquadrics_that_enclose_a_mesh_claim_no_more_than_it_proves) {
  const ConstraintRow row =
      ask(standing(shape(ShapeType::SPHERE, {0.02}), {0.5, 0.25, 0.45}, groove()), BOTH[1], {{"most_exponent", 16.0}});
  ASSERT_GE(row.status, 0) << row.message;
  EXPECT_LE(row.value.lower, -0.07);
  EXPECT_NEAR(row.value.upper, toWall(0.5, 0.45) - 0.02, 1e-6);
}

/* ---- outlines at random ---- */

/* A star-shaped outline about the origin, of either orientation. */
ShapeDescription anyOutline(Random &random) {
  const int n = 3 + static_cast<int>(random.uniform(0.0, 9.0));
  ShapeDescription out;
  out.type = ShapeType::POLYGON;
  out.vertices.resize(3, n);
  const double way = random.uniform(-1.0, 1.0) > 0.0 ? 1.0 : -1.0;
  for (int i = 0; i < n; ++i) {
    const double r = random.uniform(0.05, 1.0), turn = way * 2.0 * M_PI * (i + random.uniform(0.0, 0.8)) / n;
    out.vertices.col(i) << r * std::cos(turn), r * std::sin(turn), 0.0;
  }
  return out;
}

/* Of a point from the filled outline: by its edges, and inside by a ray's crossings. */
double trueDistance(const Eigen::Matrix3Xd &v, const Eigen::Vector3d &p) {
  double least = INFINITY;
  bool inside = false;
  const Eigen::Vector3d foot(p.x(), p.y(), 0.0);
  for (Eigen::Index i = 0, n = v.cols(); i < n; ++i) {
    const Eigen::Vector3d a = v.col(i), b = v.col((i + 1) % n), along = b - a;
    const double t = std::clamp((p - a).dot(along) / along.squaredNorm(), 0.0, 1.0);
    least = std::min(least, (a + t * along - p).norm());
    if ((a.y() > foot.y()) != (b.y() > foot.y()) &&
        foot.x() < a.x() + (foot.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x()))
      inside = !inside;
  }
  return inside ? std::abs(p.z()) : least;
}

/* 3,000 outlines (seed 3902), a ball beside each. */
TEST(OneSided, outlines_have_the_distance_of_their_edges_and_of_what_they_fill) {
  Random random(3902);
  ProviderSet providers({{"it", BOTH[1], {}}});
  std::size_t apart = 0;
  for (int i = 0; i < 3000; ++i) {
    const ShapeDescription outline = anyOutline(random);
    const Eigen::Vector3d at = random.inCube(0.8);
    const double radius = 0.02, wanted = trueDistance(outline.vertices, at) - radius;
    const ConstraintRow row = ask(providers, standing(shape(ShapeType::SPHERE, {radius}), at, outline));
    ASSERT_GE(row.status, 0) << i << ": " << row.message;
    ASSERT_LE(row.value.lower, wanted + 1e-9) << i;
    if (wanted > 0.0) {
      ASSERT_NEAR(row.value.upper, wanted, 1e-8) << i;
    }
    ASSERT_GE(row.value.upper, wanted - 1e-8) << i;
    apart += wanted > 0.0;
  }
  EXPECT_GT(apart, 1500u);
}

} // namespace
} // namespace curve_proximity
