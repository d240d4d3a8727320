/* SPDX-License-Identifier: BSD-3-Clause */
/* Meshes with fewer triangles: how far they are from those they come from, and that nothing is clear that these hit. */
#include <array>
#include <cmath>

#include "geometry/simplify.h"
#include "support.h"

using namespace curve_proximity;
using namespace curve_proximity::test;

namespace {

constexpr double PI = 3.14159265358979323846;

/* A closed surface of 2 n (n - 1) triangles or so about the origin; bumps: by how much its radius varies. */
MeshData bumpyBall(Random &random, int n, double radius, double bumps) {
  MeshData out;
  out.vertices.resize(3, 2 + (n - 1) * n);
  out.triangles.resize(3, 2 * n * (n - 1));
  const auto at = [&](int ring, int k) { return 2 + (ring - 1) * n + (k + n) % n; };
  out.vertices.col(0) = Eigen::Vector3d(0, 0, radius);
  out.vertices.col(1) = Eigen::Vector3d(0, 0, -radius);
  for (int ring = 1; ring < n; ++ring)
    for (int k = 0; k < n; ++k) {
      const double a = PI * ring / n, b = 2.0 * PI * k / n, r = radius * (1.0 + bumps * random.uniform(-1.0, 1.0));
      out.vertices.col(at(ring, k)) =
          r * Eigen::Vector3d(std::sin(a) * std::cos(b), std::sin(a) * std::sin(b), std::cos(a));
    }
  Eigen::Index i = 0;
  for (int k = 0; k < n; ++k) {
    out.triangles.col(i++) << 0, at(1, k), at(1, k + 1);
    out.triangles.col(i++) << 1, at(n - 1, k + 1), at(n - 1, k);
    for (int ring = 1; ring + 1 < n; ++ring) {
      out.triangles.col(i++) << at(ring, k), at(ring + 1, k), at(ring + 1, k + 1);
      out.triangles.col(i++) << at(ring, k), at(ring + 1, k + 1), at(ring, k + 1);
    }
  }
  return out;
}

/* A grid of n x n squares whose heights vary. */
MeshData sheet(Random &random, int n, double size, double heights) {
  MeshData out;
  out.vertices.resize(3, (n + 1) * (n + 1));
  out.triangles.resize(3, 2 * n * n);
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= n; ++j)
      out.vertices.col(i * (n + 1) + j) << size * i / n, size * j / n, heights * random.uniform(-1.0, 1.0);
  Eigen::Index t = 0;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const int a = i * (n + 1) + j, b = a + n + 1;
      out.triangles.col(t++) << a, b, b + 1;
      out.triangles.col(t++) << a, b + 1, a + 1;
    }
  return out;
}

MeshData soup(Random &random, int n, double size) {
  MeshData out;
  out.vertices.resize(3, 3 * n);
  out.triangles.resize(3, n);
  for (int i = 0; i < n; ++i) {
    const Eigen::Vector3d middle = random.vector(1.0);
    for (int k = 0; k < 3; ++k) out.vertices.col(3 * i + k) = middle + random.vector(size);
    out.triangles.col(i) << 3 * i, 3 * i + 1, 3 * i + 2;
  }
  return out;
}

MeshData someMesh(Random &random, int kind) {
  switch (kind) {
    case 0: return bumpyBall(random, 16, 1.0, 0.1);
    case 1: return bumpyBall(random, 24, 1.0, 0.0);
    case 2: return sheet(random, 16, 1.0, 0.0);
    case 3: return sheet(random, 16, 1.0, 0.2);
    case 4: return soup(random, 100, 0.2);
    default: return soup(random, 100, 0.01);
  }
}

BodyHandle bodyOf(const MeshData &mesh, const Eigen::Vector3d &scale, cprox_mesh_fill fill) {
  const Eigen::Matrix3Xd vertices = scale.asDiagonal() * mesh.vertices;
  return makeMesh(vertices, mesh.triangles, fill);
}

double nearest(const BodyHandle &body, const Eigen::Vector3d &p) {
  return cprox_body_nearest(body.get(), toVec3(p), nullptr);
}

/* Seed 1; 240 meshes by six kinds, 60 places each: 14,400 places. */
TEST(Simplify, surfaces_are_within_what_was_moved_of_each_other) {
  Random random(1);
  for (int round = 0; round < 240; ++round) {
    const MeshData mesh = someMesh(random, round % 6);
    const Eigen::Vector3d scale(random.uniform(0.5, 2.0), -random.uniform(0.5, 2.0), random.uniform(0.5, 2.0));
    const double tolerance = std::pow(10.0, random.uniform(-3.0, 0.5));
    const SimplifiedMesh simple = simplify(mesh, scale, tolerance);
    EXPECT_LE(simple.moved, tolerance);
    EXPECT_LE(simple.mesh.triangles.cols(), mesh.triangles.cols());
    const BodyHandle before = bodyOf(mesh, scale, CPROX_MESH_FILL_SURFACE),
                     after = bodyOf(simple.mesh, scale, CPROX_MESH_FILL_SURFACE);
    for (int k = 0; k < 60; ++k) {
      /* half of the places are on one of the surfaces, where the bound is tightest */
      const Eigen::Vector3d anywhere = random.vector(3.0);
      cprox_vec3 on{};
      cprox_body_nearest((k % 4 == 1 ? before : after).get(), toVec3(anywhere), &on);
      const Eigen::Vector3d p = k % 2 ? toEigen(on) : anywhere;
      EXPECT_NEAR(nearest(before, p), nearest(after, p), simple.moved + 1e-9) << "round " << round;
    }
  }
}

/* Seed 2; 60 closed meshes, 200 places each. */
TEST(Simplify, closed_meshes_stay_closed_and_keep_their_inside) {
  Random random(2);
  int inside = 0, outside = 0;
  for (int round = 0; round < 60; ++round) {
    const MeshData mesh = someMesh(random, round % 2);
    const Eigen::Vector3d scale(random.uniform(0.5, 2.0), random.uniform(0.5, 2.0), random.uniform(0.05, 2.0));
    const double tolerance = std::pow(10.0, random.uniform(-2.0, 0.0));
    const SimplifiedMesh simple = simplify(mesh, scale, tolerance);
    const BodyHandle before = bodyOf(mesh, scale, CPROX_MESH_FILL_SOLID),
                     after = bodyOf(simple.mesh, scale, CPROX_MESH_FILL_SOLID);
    ASSERT_TRUE(cprox_body_get_info(before.get()).is_solid);
    if (simple.mesh.vertices.cols() > 1) {
      ASSERT_TRUE(cprox_body_get_info(after.get()).is_solid) << "round " << round;
    }
    const BodyHandle surface = bodyOf(mesh, scale, CPROX_MESH_FILL_SURFACE);
    for (int k = 0; k < 200; ++k) {
      const Eigen::Vector3d p = random.vector(1.5);
      if (nearest(surface, p) <= simple.moved + 1e-9) continue;
      const bool was = nearest(before, p) <= 0.0, is = nearest(after, p) <= 0.0;
      EXPECT_EQ(was, is) << "round " << round;
      ++(was ? inside : outside);
    }
  }
  EXPECT_GT(inside, 500);
  EXPECT_GT(outside, 2000);
}

TEST(Simplify, flat_faces_lose_most_of_their_triangles) {
  Random random(3);
  const MeshData mesh = sheet(random, 100, 1.0, 0.0); /* 20,000 triangles with sides of 1 cm */
  const SimplifiedMesh simple = simplify(mesh, Eigen::Vector3d::Ones(), 0.1);
  EXPECT_LT(simple.mesh.triangles.cols(), 20000 / 15);
  EXPECT_GT(simple.moved, 0.0);
}

TEST(Simplify, what_is_finer_than_doubles_stays) {
  Random random(4);
  const MeshData mesh = sheet(random, 4, 1.0, 0.1);
  const SimplifiedMesh simple = simplify(mesh, Eigen::Vector3d::Ones(), 1e-18);
  EXPECT_EQ(simple.moved, 0.0);
  EXPECT_EQ(simple.mesh.triangles.cols(), mesh.triangles.cols());
}

/* A ball past a mesh, by each door of makeGeometry(): the distance lies between that to the mesh, less twice what was
 * moved, and that to the mesh. Seed 5, 120 scenes. */
TEST(Simplify, nothing_is_clear_that_the_mesh_would_hit) {
  Random random(5);
  for (int round = 0; round < 120; ++round) {
    ShapeDescription shape = test::shape(ShapeType::MESH, {});
    const MeshData mesh = someMesh(random, round % 6);
    shape.vertices = mesh.vertices;
    shape.triangles = mesh.triangles;
    shape.solid = round % 4 == 0;
    const SceneChange scene_change = change({add("mesh", {shape}, random.pose(1.0))});
    const CurveDescription path = line(random.vector(2.0), random.vector(2.0));
    std::array<Answer, 2> answers;
    double moved = 0.0;
    for (const bool simple : {false, true}) {
      ResourceOptions resources;
      resources.mesh_tolerance = simple ? 0.3 : 0.0;
      Scene scene(nullptr, resources);
      ASSERT_TRUE(scene.apply(scene_change).empty());
      const Geometry &made = scene.snapshot()->objects().begin()->second->shapes.front().geometry;
      moved = made.margin;
      answers[simple ? 1 : 0] = askOne(scene, {}, path, Query());
      ASSERT_EQ(answers[simple ? 1 : 0].status, made.is_open ? "partial" : "ok");
    }
    EXPECT_GT(moved, 0.0);
    EXPECT_LE(answers[1].result.lower, answers[0].result.upper);
    EXPECT_GE(answers[1].result.upper, answers[0].result.lower - 2.0 * moved);
  }
}

} // namespace
