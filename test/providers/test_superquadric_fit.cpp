/* SPDX-License-Identifier: BSD-3-Clause */
/* Fits enclose what they are fitted to, and stand out by no more than they say. */
#include "support.h"

#include <cmath>
#include <curve_proximity/superquadric_fit.hpp>

namespace curve_proximity {
namespace {

double inside(const SuperquadricFit &fit, const Eigen::Vector3d &point) {
  const Eigen::Vector3d x = fit.pose.inverse() * point;
  double sum = 0.0;
  for (int i = 0; i < 3; ++i) sum += std::pow(std::abs(x[i]) / fit.semi_axes[i], fit.exponents[i]);
  return sum;
}

std::vector<ShapeDescription> someShapes(Random &random, int n) {
  std::vector<ShapeDescription> out;
  for (int i = 0; i < n; ++i) {
    const double a = random.uniform(0.05, 1.0), b = random.uniform(0.05, 1.0), c = random.uniform(0.05, 1.0);
    switch (i % 5) {
      case 0: out.push_back(shape(ShapeType::BOX, {a, b, c})); break;
      case 1: out.push_back(shape(ShapeType::CYLINDER, {a, b})); break;
      case 2: out.push_back(shape(ShapeType::CAPSULE, {a, b})); break;
      case 3: out.push_back(shape(ShapeType::CONE, {a, b})); break;
      default: {
        Eigen::Matrix3Xd vertices(3, 4 + i % 30);
        for (Eigen::Index k = 0; k < vertices.cols(); ++k)
          vertices.col(k) = Eigen::Vector3d(3, 1, 2) + Eigen::Vector3d(a, b, c).cwiseProduct(random.inCube(1.0));
        out.push_back(polytope(vertices));
      }
    }
  }
  return out;
}

TEST(Fits, enclose_the_body_in_every_direction_and_at_every_point_of_it) {
  Random random(821);
  for (const ShapeDescription &s : someShapes(random, 40)) {
    const BodyHandle body = makeGeometry(s).body;
    const SuperquadricFit fit = fitSuperquadric(body);
    for (int i = 0; i < 3000; ++i) {
      const Eigen::Vector3d u = random.direction();
      cprox_vec3 on_body, on_fit;
      const double height = cprox_body_support(body.get(), toVec3(u), &on_body);
      const double over = cprox_body_support(fit.body.get(), toVec3(fit.pose.linear().transpose() * u), &on_fit) +
                          u.dot(fit.pose.translation());
      ASSERT_LE(height, over) << shapeTypeName(s.type);
      ASSERT_LE(inside(fit, toEigen(on_body)), 1.0) << shapeTypeName(s.type);
    }
    for (Eigen::Index k = 0; k < s.vertices.cols(); ++k) ASSERT_LE(inside(fit, s.vertices.col(k)), 1.0);
  }
}

/* No point on the surface, found by rays from the centre, is farther from the body than the excess; and some come near
 * to it. */
TEST(Fits, stand_out_by_no_more_than_they_say_and_not_by_much_less) {
  Random random(822);
  double least_share = 1.0;
  for (const ShapeDescription &s : someShapes(random, 40)) {
    const BodyHandle body = makeGeometry(s).body;
    const SuperquadricFit fit = fitSuperquadric(body);
    double farthest = 0.0;
    for (int i = 0; i < 3000; ++i) {
      Eigen::Vector3d x = random.direction().cwiseProduct(fit.semi_axes);
      double low = 0.0, high = 2.0;
      for (int k = 0; k < 60; ++k) {
        const double middle = 0.5 * (low + high);
        (inside(fit, fit.pose * Eigen::Vector3d(middle * x)) > 1.0 ? high : low) = middle;
      }
      x = fit.pose * Eigen::Vector3d(low * x);
      const double out = cprox_body_nearest(body.get(), toVec3(x), nullptr);
      ASSERT_LE(out, fit.excess) << shapeTypeName(s.type);
      farthest = std::max(farthest, out);
    }
    least_share = std::min(least_share, farthest / fit.excess);
  }
  EXPECT_GT(least_share, 0.5);
}

TEST(Fits, of_boxes_are_tighter_with_higher_exponents) {
  const BodyHandle box = makeBox({0.4, 0.6, 0.2});
  double before = std::numeric_limits<double>::infinity();
  for (const double most : {2.0, 4.0, 16.0, 100.0}) {
    SuperquadricFitOptions options;
    options.most_exponent = most;
    const double excess = fitSuperquadric(box, options).excess;
    EXPECT_LT(excess, before);
    before = excess;
  }
  EXPECT_LT(before, 0.01);
}

TEST(Fits, of_what_has_no_bounds_or_no_single_part_are_refused_by_name) {
  for (const BodyHandle &body : {makePoint({0, 0, 0}), makeHalfspace({0, 0, 1}, 0),
                                 makeCompound({makeSphere(1)}, {Eigen::Isometry3d::Identity()})}) {
    try {
      fitSuperquadric(body);
      FAIL() << "a fit";
    } catch (const Error &error) {
      EXPECT_NE(std::string(error.what()).find(cprox_body_kind_name(cprox_body_get_info(body.get()).kind)),
                std::string::npos);
    }
  }
}

/* The true gap of two balls is the difference of radii plus the distance of the centres. */
TEST(SupportGaps, are_above_the_true_one_and_within_the_tolerance_of_it) {
  Random random(823);
  for (int i = 0; i < 50; ++i) {
    const double r = random.uniform(0.1, 1.0), s = random.uniform(0.1, 1.0);
    const Eigen::Vector3d c = random.inCube(0.5);
    const SupportFunction inner = [&](const Eigen::Vector3d &u, Eigen::Vector3d &p) {
      p = c + r * u;
      return u.dot(p);
    };
    const SupportFunction outer = [&](const Eigen::Vector3d &u, Eigen::Vector3d &p) {
      p = s * u;
      return s;
    };
    const double truth = c.norm() + r - s, bound = supportGap(inner, outer, 1e-3, 100000);
    EXPECT_GE(bound, truth);
    EXPECT_LE(bound, truth + 1.1e-3);
  }
}

/* The interval of a pair of fits contains the true signed distance of what was fitted. */
TEST(SuperquadricDistances, of_fitted_bodies_contain_the_true_distance) {
  const Loaded provider("curve_proximity/SuperquadricDistance", {{"most_exponent", 16.0}});
  Random random(824);
  Workspace workspace;
  ConstraintValue value;
  int overlapping = 0;
  const std::vector<ShapeDescription> shapes = someShapes(random, 10);
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    ConstraintPair pair;
    pair.a = side({shapes[i]});
    pair.b = side({shapes[(i + 3) % shapes.size()]});
    const auto constraint = provider->prepare(pair);
    for (int k = 0; k < 50; ++k) {
      ConstraintPlace place;
      place.a = random.pose(1.0), place.b = random.pose(1.0);
      constraint->evaluate(place, workspace, value);
      const cprox_result truth = curve_proximity::pair(cprox_obstacle_at(pair.a.parts[0].body.get(), place.a),
                                                       cprox_obstacle_at(pair.b.parts[0].body.get(), place.b),
                                                       CPROX_OPTIONS_DEFAULT, workspace);
      ASSERT_LE(value.lower, truth.upper);
      ASSERT_GE(value.upper, truth.lower);
      overlapping += truth.upper < 0.0;
    }
  }
  EXPECT_GT(overlapping, 20);
}

} // namespace
} // namespace curve_proximity
