/* SPDX-License-Identifier: BSD-3-Clause */
/* What FCL and libccd describe is what our bodies are: distances of adapted pairs against FCL's own. */
#include <cmath>

#include <fcl/config.h>
#if FCL_MAJOR_VERSION == 0 && FCL_MINOR_VERSION < 6
#error "this test is written for the interface of FCL 0.6 and later"
#endif
#include <fcl/geometry/geometric_shape_to_BVH_model.h>
#include <fcl/geometry/shape/plane.h>
#include <fcl/narrowphase/distance.h>

#include <curve_proximity/ccd.hpp>
#include <curve_proximity/fcl.hpp>

#include "support.h"

using namespace curve_proximity;
using namespace curve_proximity::test;

namespace {

using Geometry = std::shared_ptr<fcl::CollisionGeometryd>;

/* What FCL's iterative solvers reach on shapes of about 1 m with the tolerance asked below. */
constexpr double TOLERANCE = 1e-6;

double byFcl(const fcl::CollisionObjectd &a, const fcl::CollisionObjectd &b) {
  fcl::DistanceRequestd request;
  request.distance_tolerance = 1e-10;
  fcl::DistanceResultd result;
  return fcl::distance(&a, &b, request, result);
}

cprox_result byUs(const fcl::CollisionObjectd &a, const fcl::CollisionObjectd &b) {
  Workspace workspace;
  const PosedBody p = fromFcl(a), q = fromFcl(b);
  return pair(at(p.body, p.pose), at(q.body, q.pose), CPROX_OPTIONS_DEFAULT, workspace);
}

/* 200 poses of the two, at least 3 m and at most 8 m from centre to centre: apart for shapes of up to 1.4 m. */
void expectSameDistances(const Geometry &a, const Geometry &b, std::uint64_t seed) {
  Random random(seed);
  for (int i = 0; i < 200; ++i) {
    Eigen::Vector3d away = random.vector(1.0);
    while (away.norm() < 0.1) away = random.vector(1.0);
    const Eigen::Isometry3d from = random.pose(1.0);
    Eigen::Isometry3d to = random.pose(1.0);
    to.translation() = from.translation() + away.normalized() * random.uniform(3.0, 8.0);
    const fcl::CollisionObjectd one(a, from), other(b, to);
    const cprox_result r = byUs(one, other);
    const double d = byFcl(one, other);
    ASSERT_GT(d, 0.0);
    EXPECT_LE(r.lower, d + TOLERANCE) << i;
    EXPECT_GE(r.upper, d - TOLERANCE) << i;
    EXPECT_LE(r.upper - r.lower, 1e-6);
  }
}

Geometry ball() {
  return std::make_shared<fcl::Sphered>(0.7);
}

Geometry tetrahedron() {
  const auto vertices = std::make_shared<std::vector<fcl::Vector3d>>(
      std::vector<fcl::Vector3d>{{1, 0, 0}, {-0.5, 0.8, 0}, {-0.5, -0.8, 0}, {0, 0, 1.2}});
  const auto faces =
      std::make_shared<std::vector<int>>(std::vector<int>{3, 0, 2, 1, 3, 0, 1, 3, 3, 1, 2, 3, 3, 2, 0, 3});
  return std::make_shared<fcl::Convexd>(vertices, 4, faces);
}

} // namespace

TEST(FclAdapter, spheres_are_the_same) {
  expectSameDistances(ball(), ball(), 11);
}
TEST(FclAdapter, boxes_are_the_same) {
  expectSameDistances(std::make_shared<fcl::Boxd>(0.5, 1.0, 1.5), ball(), 12);
  expectSameDistances(std::make_shared<fcl::Boxd>(0.5, 1.0, 1.5), std::make_shared<fcl::Boxd>(0.3, 0.4, 0.5), 13);
}
TEST(FclAdapter, capsules_are_the_same) {
  expectSameDistances(std::make_shared<fcl::Capsuled>(0.4, 1.1), ball(), 14);
}
TEST(FclAdapter, cylinders_are_the_same) {
  expectSameDistances(std::make_shared<fcl::Cylinderd>(0.4, 1.1), ball(), 15);
}
TEST(FclAdapter, cones_are_the_same) {
  expectSameDistances(std::make_shared<fcl::Coned>(0.6, 1.3), ball(), 16);
}
TEST(FclAdapter, ellipsoids_are_the_same) {
  expectSameDistances(std::make_shared<fcl::Ellipsoidd>(0.3, 0.6, 1.0), ball(), 17);
}
TEST(FclAdapter, convex_meshes_are_the_same) {
  expectSameDistances(tetrahedron(), ball(), 18);
}
/* FCL has no distance of a triangle alone: a ball of 0.7 whose centre is 3 above its inside, however it is turned. */
TEST(FclAdapter, triangles_are_the_same) {
  Random random(19);
  const auto triangle =
      std::make_shared<fcl::TrianglePd>(fcl::Vector3d(0, 0, 0), fcl::Vector3d(1, 0, 0), fcl::Vector3d(0, 0.9, 0));
  for (int i = 0; i < 100; ++i) {
    const Eigen::Isometry3d turn = random.pose(3.0);
    const cprox_result r =
        byUs(fcl::CollisionObjectd(ball(), turn * translation(0.2, 0.3, 3.0)), fcl::CollisionObjectd(triangle, turn));
    EXPECT_LE(r.lower, 2.3 + 1e-12);
    EXPECT_GE(r.upper, 2.3 - 1e-12);
  }
}

TEST(FclAdapter, a_mesh_is_its_hull) {
  const fcl::Boxd box(0.5, 1.0, 1.5);
  const auto mesh = std::make_shared<fcl::BVHModel<fcl::OBBRSSd>>();
  fcl::generateBVHModel(*mesh, box, fcl::Transform3d::Identity());
  const fcl::CollisionObjectd as_mesh(mesh, translation(0.1, 0.2, 0.3)), far(ball(), translation(3, 2, 1));
  const fcl::CollisionObjectd as_box(std::make_shared<fcl::Boxd>(box), translation(0.1, 0.2, 0.3));
  EXPECT_NEAR(byUs(as_mesh, far).upper, byFcl(as_box, far), TOLERANCE);
}

/* FCL has no distance to halfspaces: the plane z = 1.5 below a ball of 0.7 at z = 4 is 1.8 away, however it is turned.
 */
TEST(FclAdapter, halfspaces_are_the_same) {
  Random random(20);
  const auto half = std::make_shared<fcl::Halfspaced>(fcl::Vector3d(0, 0, 1), 1.5);
  for (int i = 0; i < 100; ++i) {
    const Eigen::Isometry3d turn = random.pose(3.0);
    const fcl::CollisionObjectd ground(half, turn), above(ball(), turn * translation(i, -i, 4.0));
    const cprox_result r = byUs(above, ground);
    EXPECT_LE(r.lower, 1.8 + 1e-12);
    EXPECT_GE(r.upper, 1.8 - 1e-12);
  }
}

TEST(FclAdapter, what_is_no_solid_convex_set_is_refused_by_name) {
  expectContains(errorOf([] { bodyFromFcl(fcl::Planed(fcl::Vector3d::UnitZ(), 0.0)); }), "plane");
  expectContains(errorOf([] { bodyFromFcl(fcl::Sphered(-1.0)); }), "radius");
}

namespace {

/* A libccd support callback of a box, as in libccd's own manual: answers in the world. */
struct WorldBox {
  Eigen::Vector3d half;
  Eigen::Isometry3d pose;
};

void boxSupport(const void *object, const ccd_vec3_t *direction, ccd_vec3_t *point) {
  const auto &box = *static_cast<const WorldBox *>(object);
  const Eigen::Vector3d d(direction->v[0], direction->v[1], direction->v[2]);
  const Eigen::Vector3d local = box.pose.linear().transpose() * d;
  const Eigen::Vector3d corner = local.cwiseSign().cwiseProduct(box.half);
  const Eigen::Vector3d world = box.pose * corner;
  ccdVec3Set(point, world.x(), world.y(), world.z());
}

void silentSupport(const void *, const ccd_vec3_t *, ccd_vec3_t *) {}

} // namespace

TEST(CcdAdapter, a_support_callback_is_the_shape_it_describes) {
  Random random(21);
  Workspace workspace;
  for (int i = 0; i < 200; ++i) {
    const WorldBox box{{0.25, 0.5, 0.75}, random.pose(1.0)};
    const BodyHandle body = makeSupport(&boxSupport, &box, box.pose.translation(), box.half.norm() * 1.001, 1e-14);
    const double y = random.uniform(-2, 2), z = random.uniform(-2, 2);
    const BodyHandle sphere = makeSphere(0.3), reference = makeBox(2.0 * box.half);
    const cprox_obstacle ball = at(sphere, translation(3.0, y, z));
    const cprox_result mine = pair(at(body), ball, CPROX_OPTIONS_DEFAULT, workspace);
    const cprox_result its = pair(at(reference, box.pose), ball, CPROX_OPTIONS_DEFAULT, workspace);
    EXPECT_LE(mine.lower, its.upper);
    EXPECT_GE(mine.upper, its.lower);
  }
}

TEST(CcdAdapter, a_curve_is_measured_against_a_callback) {
  const WorldBox box{{0.25, 0.5, 0.75}, translation(0, 0, 0)};
  const BodyHandle body = makeSupport(&boxSupport, &box, Eigen::Vector3d::Zero(), box.half.norm() * 1.001, 0.0, 0.05);
  Workspace workspace;
  const CompiledCurve curve = compile(line({1.25, -3, 0}, {1.25, 3, 0}));
  const cprox_result r = distance(along(curve.curve), at(body), CPROX_OPTIONS_DEFAULT, workspace);
  EXPECT_LE(r.lower, 0.95);
  EXPECT_GE(r.upper, 0.95);
}

TEST(CcdAdapter, a_callback_that_writes_nothing_is_caught) {
  Workspace workspace;
  const int nothing = 0;
  const CompiledCurve curve = compile(line({1, 0, 0}, {2, 0, 0}));
  EXPECT_FALSE(errorOf([&] {
                 const BodyHandle body = makeSupport(&silentSupport, &nothing, Eigen::Vector3d::Zero(), 1.0);
                 distance(along(curve.curve), at(body), CPROX_OPTIONS_DEFAULT, workspace);
               }).empty());
  EXPECT_FALSE(errorOf([&] { makeSupport(nullptr, &nothing, Eigen::Vector3d::Zero(), 1.0); }).empty());
}
