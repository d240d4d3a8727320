/* SPDX-License-Identifier: BSD-3-Clause */
/* Shapes from descriptions, meshes and their files. */
#include <unistd.h>
#include <cmath>
#include <filesystem>

#include "geometry/hull.h"
#include "geometry/mesh.h"
#include "geometry/surface.h"
#include "support.h"

using namespace curve_proximity;
using namespace curve_proximity::test;

namespace {

const std::string PANDA = TEST_DATA_DIR "/robots/panda";

std::string refusal(const ShapeDescription &shape, const ResourceOptions &options = {}) {
  return errorOf([&] { makeGeometry(shape, options); });
}

ShapeDescription meshFile(const std::string &resource) {
  ShapeDescription out = shape(ShapeType::MESH, {});
  out.resource = resource;
  return out;
}

ShapeDescription mesh(const Eigen::Matrix3Xd &vertices, const Triangles &triangles) {
  ShapeDescription out = shape(ShapeType::MESH, {});
  out.vertices = vertices;
  out.triangles = triangles;
  return out;
}

/* Triangles over the vertices in their order, each vertex in one at least. */
Triangles anyTriangles(Eigen::Index n) {
  Triangles out(3, n - 2);
  for (Eigen::Index k = 0; k + 2 < n; ++k)
    out.col(k) << static_cast<int>(k), static_cast<int>(k + 1), static_cast<int>(k + 2);
  return out;
}

/* A folder of the test's own, gone with it. */
class Folder {
 public:
  Folder() : path_(std::filesystem::temp_directory_path() / ("curve_proximity_" + std::to_string(::getpid()))) {
    std::filesystem::create_directories(path_);
  }
  ~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  std::string write(const std::string &name, const std::string &content) const {
    const std::string file = (path_ / name).string();
    std::ofstream(file, std::ios::binary) << content;
    return file;
  }
  std::string path() const {
    return path_.string();
  }

 private:
  std::filesystem::path path_;
};

const char *const TRIANGLE_STL =
    "solid t\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid "
    "t\n";

} // namespace

TEST(Shapes, names_and_types_are_one_to_one) {
  for (int i = 0; i <= static_cast<int>(ShapeType::OCTREE); ++i) {
    const auto type = static_cast<ShapeType>(i);
    EXPECT_EQ(shapeTypeFromName(shapeTypeName(type)), type);
  }
  EXPECT_FALSE(shapeTypeFromName("Box").has_value());
  EXPECT_FALSE(shapeTypeFromName("").has_value());
}

/* The nearest point of each to a point outside, by hand. */
TEST(Shapes, dimensions_mean_what_the_header_says) {
  const auto distanceTo = [](const ShapeDescription &s, const Eigen::Vector3d &p) {
    return cprox_body_nearest(makeGeometry(s).body.get(), toVec3(p), nullptr);
  };
  EXPECT_NEAR(distanceTo(shape(ShapeType::POINT, {}), {0, 3, 4}), 5.0, 1e-14);
  EXPECT_NEAR(distanceTo(shape(ShapeType::SPHERE, {0.5}), {0, 3, 4}), 4.5, 1e-14);
  EXPECT_NEAR(distanceTo(shape(ShapeType::BOX, {1, 2, 3}), {1.5, 0, 0}), 1.0, 1e-14);
  EXPECT_NEAR(distanceTo(shape(ShapeType::CAPSULE, {2, 0.5}), {0, 0, 2.5}), 1.0, 1e-14);
  EXPECT_NEAR(distanceTo(shape(ShapeType::CYLINDER, {2, 0.5}), {0, 0, 2.5}), 1.5, 1e-14);
  EXPECT_NEAR(distanceTo(shape(ShapeType::CYLINDER, {2, 0.5}), {1.5, 0, 0}), 1.0, 1e-14);
  EXPECT_NEAR(distanceTo(shape(ShapeType::CONE, {2, 0.5}), {0, 0, 2.0}), 1.0, 1e-14);
  EXPECT_NEAR(distanceTo(shape(ShapeType::CONE, {2, 0.5}), {0, 0, -2.0}), 1.0, 1e-14);
  EXPECT_NEAR(distanceTo(shape(ShapeType::ELLIPSOID, {1, 2, 3}), {0, 0, 4.0}), 1.0, 1e-13);
  EXPECT_NEAR(distanceTo(shape(ShapeType::HALFSPACE, {0, 0, 2, -2}), {7, 7, 3.0}), 2.0, 1e-14);
}

/* Held against points of the surface that the inequality itself gives: none is nearer than the distance, and a search
 * among them finds one as near. Exponents to both ends of their range, those of an octahedron and a box among them. */
TEST(Shapes, a_superellipsoid_is_that_of_barr) {
  Random random(31);
  const auto norm = [](double x, double y, double p) {
    const double most = std::max(x, y);
    return most > 0.0 ? most * std::pow(std::pow(x / most, p) + std::pow(y / most, p), 1.0 / p) : 0.0;
  };
  for (int i = 0; i < 40; ++i) {
    const auto exponent = [&] {
      const int kind = static_cast<int>(random.uniform(0, 6));
      return kind == 0 ? 2.0 : kind == 1 ? 1.0 : kind == 2 ? 0.01 : random.uniform(0.1, 1.95);
    };
    const Eigen::Vector3d a(random.uniform(.1, 1), random.uniform(.1, 1), random.uniform(.1, 1));
    const double e1 = exponent(), e2 = exponent();
    const auto surface =
        [&](const Eigen::Vector3d &direction) { /* the left side is a power of a norm */
                                                const Eigen::Vector3d x = direction.cwiseAbs().cwiseQuotient(a);
                                                return Eigen::Vector3d(direction /
                                                                       norm(norm(x.x(), x.y(), 2 / e2), x.z(), 2 / e1));
        };
    const Eigen::Vector3d p = 2.0 * Eigen::Vector3d(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(1, 2));
    const double distance = cprox_body_nearest(
        makeGeometry(shape(ShapeType::SUPERELLIPSOID, {a.x(), a.y(), a.z(), e1, e2})).body.get(), toVec3(p), nullptr);
    double nearest = INFINITY;
    Eigen::Vector3d best = Eigen::Vector3d::UnitZ();
    const auto look = [&](const Eigen::Vector3d &direction) {
      const double d = (surface(direction) - p).norm();
      if (d < nearest) nearest = d, best = direction.normalized();
    };
    for (int k = 0; k < 20000; ++k) {
      const double z = random.uniform(-1, 1), turn = random.uniform(-M_PI, M_PI), r = std::sqrt(1 - z * z);
      look({r * std::cos(turn), r * std::sin(turn), z});
    }
    for (double reach = 0.1; reach > 1e-10; reach *= 0.98)
      for (int k = 0; k < 20; ++k)
        look(best + reach * Eigen::Vector3d(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)));
    EXPECT_LE(distance, nearest + 1e-9) << i << ": " << e1 << " " << e2;
    EXPECT_GE(distance, nearest - 1e-4) << i << ": " << e1 << " " << e2; /* the search stops at ridges */
  }
  EXPECT_NEAR(cprox_body_nearest(makeGeometry(shape(ShapeType::SUPERELLIPSOID, {1, 1, 1, 2, 1})).body.get(), {0, 2, 1},
                                 nullptr),
              std::sqrt(2.0), 1e-9); /* a double cone */
  for (const double e : {0.0, 0.001, 2.1})
    expectContains(refusal(shape(ShapeType::SUPERELLIPSOID, {1, 1, 1, e, 1})),
                   e > 0.0 ? "from 0.002 to 2" : "dimension 3");
}

TEST(Shapes, wrong_dimensions_are_told_in_a_message) {
  EXPECT_EQ(refusal(shape(ShapeType::CYLINDER, {1.0})), "cylinder needs 2 dimensions [height, radius], got 1");
  EXPECT_EQ(refusal(shape(ShapeType::SPHERE, {})), "sphere needs 1 dimension [radius], got 0");
  expectContains(refusal(shape(ShapeType::BOX, {1, 1})), "box needs 3 dimensions");
  expectContains(refusal(shape(ShapeType::POINT, {1})), "point needs no dimensions");
  expectContains(refusal(shape(ShapeType::POLYTOPE, {1})), "polytope needs no dimensions");
  expectContains(refusal(shape(ShapeType::HALFSPACE, {0, 0, 1})), "halfspace needs 4 dimensions");
  expectContains(refusal(shape(ShapeType::BOX, {1, 0, 1})), "box dimension 1");
  expectContains(refusal(shape(ShapeType::BOX, {1, 1, NAN})), "box dimension 2");
  expectContains(refusal(shape(ShapeType::CONE, {-1, 1})), "cone dimension 0");
  expectContains(refusal(shape(ShapeType::ELLIPSOID, {1, INFINITY, 1})), "ellipsoid dimension 1");
  EXPECT_FALSE(refusal(shape(ShapeType::HALFSPACE, {0, 0, 0, 1})).empty());
}

TEST(Shapes, vertices_belong_to_points_polytopes_and_meshes) {
  ShapeDescription s = shape(ShapeType::BOX, {1, 1, 1});
  s.vertices = Eigen::Matrix3Xd::Zero(3, 2);
  expectContains(refusal(s), "box takes no vertices");
  s = shape(ShapeType::POINT, {});
  s.vertices = Eigen::Matrix3Xd::Zero(3, 2);
  expectContains(refusal(s), "at most 1 vertex");
  expectContains(refusal(shape(ShapeType::POLYTOPE, {})), "no vertices");
  expectContains(refusal(shape(ShapeType::POLYGON, {})), "polygon has no vertices");
  expectContains(refusal(shape(ShapeType::POLYGON, {1})), "polygon needs no dimensions");
  s = shape(ShapeType::POLYGON, {});
  s.vertices = Eigen::Matrix3Xd::Identity(3, 3);
  expectContains(refusal(s), "polygon vertex 2 has z = 1");
  s.vertices << 0, 1, 0, 0, 0, 1, 0, 0, 0;
  EXPECT_EQ(cprox_body_get_info(makeGeometry(s).body.get()).kind, CPROX_BODY_POLYGON);
  s = shape(ShapeType::POLYTOPE, {});
  s.vertices = Eigen::Matrix3Xd::Zero(3, 4);
  s.vertices(1, 2) = NAN;
  expectContains(refusal(s), "vertex 2 is not finite");
  s = shape(ShapeType::SPHERE, {1});
  s.resource = "x.stl";
  expectContains(refusal(s), "takes no file");
}

TEST(Meshes, bad_meshes_are_told_in_a_message) {
  Eigen::Matrix3Xd vertices = Eigen::Matrix3Xd::Random(3, 5);
  expectContains(refusal(mesh(vertices, Triangles(3, 0))), "no triangle");
  Triangles triangles = anyTriangles(5);
  triangles(1, 2) = 5;
  expectContains(refusal(mesh(vertices, triangles)), "triangle 2 uses vertex 5");
  triangles(1, 2) = -1;
  expectContains(refusal(mesh(vertices, triangles)), "triangle 2 uses vertex -1");
  vertices(0, 3) = INFINITY;
  expectContains(refusal(mesh(vertices, anyTriangles(5))), "vertex 3 is not finite");
  ShapeDescription s = mesh(Eigen::Matrix3Xd::Random(3, 5), anyTriangles(5));
  s.dimensions = {1, 0, 1};
  expectContains(refusal(s), "scale");
  s.dimensions = {1, NAN, 1};
  expectContains(refusal(s), "finite");
  s.dimensions = {1, 1};
  expectContains(refusal(s), "mesh needs");
}

TEST(Meshes, flat_thin_and_single_triangles_are_bodies) {
  Eigen::Matrix3Xd vertices(3, 40);
  Random random(31);
  for (int i = 0; i < 40; ++i) vertices.col(i) << random.uniform(-1, 1), random.uniform(-1, 1), 0.0;
  vertices.col(0) << 0, 0, 0;
  for (const double thickness : {0.0, 1e-13, 1e-10}) {
    vertices(2, 7) = thickness;
    const Geometry flat = makeGeometry(mesh(vertices, anyTriangles(40)));
    EXPECT_NEAR(cprox_body_nearest(flat.body.get(), {0, 0, 1}, nullptr), 1.0, 2e-10);
    EXPECT_TRUE(flat.is_mesh);
  }
  // Collinear, and all in one place.
  for (int i = 0; i < 40; ++i) vertices.col(i) << i, 0, 0;
  EXPECT_NEAR(cprox_body_nearest(makeGeometry(mesh(vertices, anyTriangles(40))).body.get(), {5.5, 1, 0}, nullptr), 1.0,
              1e-12);
  vertices.setConstant(2.0);
  EXPECT_NEAR(cprox_body_nearest(makeGeometry(mesh(vertices, anyTriangles(40))).body.get(), {2, 2, 3}, nullptr), 1.0,
              1e-12);
}

/* 200 meshes, of up to 400 vertices, from near-flat to cubical and of all sizes: some with many coplanar vertices.
 * Tolerance: the accuracy of cprox_body_nearest, 64 2^-53 (|point| + size), and the geometry's own excess. */
TEST(Meshes, the_hull_contains_every_vertex) {
  Random random(32);
  for (int i = 0; i < 200; ++i) {
    const auto n = static_cast<Eigen::Index>(4 + random.below(397));
    const double size = std::pow(10.0, random.uniform(-6, 6));
    const Eigen::Vector3d half(size, size * std::pow(10.0, random.uniform(-8, 0)), size);
    Eigen::Matrix3Xd vertices(3, n);
    for (Eigen::Index k = 0; k < n; ++k) {
      vertices.col(k) = random.vector(1.0).cwiseProduct(half);
      if (random.below(3) == 0) vertices(static_cast<Eigen::Index>(random.below(3)), k) = 0.5 * size; // onto a plane
    }
    const Geometry geometry = makeGeometry(mesh(vertices, anyTriangles(n)));
    EXPECT_LE(geometry.hull_excess, 1e-11 * size);
    for (Eigen::Index k = 0; k < n; ++k) {
      const double out_by = cprox_body_nearest(geometry.hull.get(), toVec3(vertices.col(k)), nullptr);
      EXPECT_LE(out_by, geometry.hull_excess + 64 * 0x1p-53 * 6.0 * size);
    }
  }
}

/* Seed 33: whatever a hull computation drops, all points stay covered. Tolerances as above. */
TEST(Meshes, vertices_that_were_dropped_are_covered_or_taken_back) {
  Random random(33);
  for (int i = 0; i < 100; ++i) {
    std::vector<Eigen::Vector3d> all, kept;
    for (int k = 0; k < 60; ++k) all.push_back(random.vector(1.0));
    for (const Eigen::Vector3d &p : all) {
      if (kept.size() < 4 || random.below(3) == 0) kept.push_back(p);
    }
    all.push_back(kept[0] * (1.0 + 1e-14)); // stands out by no more than rounding
    const HullPoints hull = coveringPoints(all, kept);
    EXPECT_LE(hull.excess, 1e-11);
    const BodyHandle body = polytopeOf(hull.kept);
    for (const Eigen::Vector3d &p : all) {
      EXPECT_LE(cprox_body_nearest(body.get(), toVec3(p), nullptr), hull.excess + 64 * 0x1p-53 * 6.0);
    }
  }
}

/* Counts, not times: each report of qhull asks once. */
TEST(Meshes, hulls_of_many_points_can_be_stopped) {
  Random random(43);
  Points points;
  for (int k = 0; k < 20000; ++k) points.push_back(random.vector(1.0).normalized());
  int asked = 0, most = 0;
  const auto stop = [&] { return ++asked == most; };
  EXPECT_EQ(hullSurfaceOf(points, stop).facets.size(), 2 * points.size() - 4); // Euler: all of them are vertices
  EXPECT_GT(asked, 50);
  for (const int at : {1, 2, asked / 2, asked}) {
    asked = 0, most = at;
    try {
      hullSurfaceOf(points, stop);
      ADD_FAILURE() << at;
    } catch (const Error &error) {
      EXPECT_EQ(error.status(), CPROX_STOPPED);
    }
    EXPECT_EQ(asked, at);
  }
}

TEST(Meshes, only_vertices_of_triangles_count) {
  Eigen::Matrix3Xd vertices(3, 4);
  vertices << 0, 1, 0, 100, /**/ 0, 0, 1, 100, /**/ 0, 0, 0, 100;
  Triangles one(3, 1);
  one << 0, 1, 2;
  EXPECT_NEAR(cprox_body_nearest(makeGeometry(mesh(vertices, one)).body.get(), {0, 0, 2}, nullptr), 2.0, 1e-14);
}

TEST(Meshes, scale_stretches_and_mirrors) {
  ShapeDescription s = meshFile(PANDA + "/meshes/finger.stl");
  const BodyHandle plain = makeGeometry(s).body;
  s.dimensions = {2, -3, 0.5};
  const BodyHandle scaled = makeGeometry(s).body;
  const Eigen::Vector3d d(0.3, -0.7, 0.4); // the support function of the image is that of the transposed direction
  EXPECT_NEAR(cprox_body_support(scaled.get(), toVec3(d), nullptr),
              cprox_body_support(plain.get(), {2 * d.x(), -3 * d.y(), 0.5 * d.z()}, nullptr), 1e-12);
}

TEST(Resources, files_are_found_by_every_kind_of_uri) {
  ResourceOptions options;
  options.base_dir = PANDA;
  options.find_package = [](const std::string &name) { return name == "panda_description" ? PANDA : std::string(); };
  for (const std::string uri : {"meshes/finger.stl", "package://panda_description/meshes/finger.stl"}) {
    EXPECT_TRUE(std::filesystem::equivalent(resolveResource(uri, options), PANDA + "/meshes/finger.stl")) << uri;
    EXPECT_TRUE(makeGeometry(meshFile(uri), options).is_mesh);
  }
  for (const std::string start : {"", "file://", "file://localhost"}) {
    EXPECT_EQ(resolveResource(start + PANDA + "/meshes/finger.stl", {}), PANDA + "/meshes/finger.stl");
  }
  const Folder folder;
  folder.write("a b%.stl", TRIANGLE_STL);
  EXPECT_TRUE(makeGeometry(meshFile("file://" + folder.path() + "/a%20b%25.stl")).is_mesh);
  EXPECT_TRUE(makeGeometry(meshFile(folder.path() + "/a b%.stl")).is_mesh);
}

TEST(Resources, what_cannot_be_read_is_told_by_name) {
  ResourceOptions options;
  options.base_dir = PANDA;
  options.find_package = [](const std::string &) { return std::string(); };
  const auto why = [&](const std::string &uri) { return refusal(meshFile(uri), options); };
  expectContains(why("meshes/none.stl"), "meshes/none.stl");
  expectContains(why("meshes/none.stl"), "there is no file");
  expectContains(why("meshes"), "no regular file");
  expectContains(why("http://example.org/a.stl"), "http:// is not fetched");
  expectContains(why("https://example.org/a.stl"), "https:// is not fetched");
  expectContains(why("package://nobody/a.stl"), "package 'nobody' was not found");
  expectContains(why("package://nobody"), "package://NAME/path");
  expectContains(why("file://meshes/finger.stl"), "absolute");
  expectContains(refusal(meshFile("package://p/a.stl")), "nowhere to look for package 'p'");
  expectContains(refusal(meshFile("meshes/finger.stl")), "relative");
  EXPECT_FALSE(refusal(shape(ShapeType::MESH, {})).empty());
}

TEST(Resources, broken_files_are_told_by_name) {
  const Folder folder;
  const auto why = [&](const std::string &name, const std::string &content) {
    return refusal(meshFile(folder.write(name, content)));
  };
  expectContains(why("empty.stl", ""), "empty.stl' is empty");
  expectContains(why("noise.stl", "this is no mesh"), "noise.stl");
  expectContains(why("noise.dae", "<COLLADA"), "noise.dae");
  expectContains(why("hollow.stl", "solid t\nendsolid t\n"), "hollow.stl");

  // A binary STL: a header of 80 bytes, the number of triangles, 50 bytes each.
  const float nan = NAN;
  std::string binary(80, ' ');
  binary += std::string("\1\0\0\0", 4) + std::string(50, '\0');
  binary.replace(84 + 12, 4, reinterpret_cast<const char *>(&nan), 4);
  expectContains(why("nan.stl", binary), "nan.stl");
  expectContains(why("nan2.stl", binary), "not finite");
  binary.replace(80, 4, "\xff\xff\xff\x7f");
  expectContains(why("short.stl", binary), "short.stl");
}

TEST(Resources, a_mesh_has_a_file_or_vertices_not_both) {
  ShapeDescription s = meshFile(PANDA + "/meshes/finger.stl");
  s.vertices = Eigen::Matrix3Xd::Zero(3, 3);
  expectContains(refusal(s), "give one of the two");
}

static double distanceFrom(const ShapeDescription &s, const Eigen::Vector3d &p) {
  return cprox_body_nearest(makeGeometry(s).body.get(), toVec3(p), nullptr);
}

TEST(Surfaces, a_height_field_is_drawn_by_its_heights) {
  ShapeDescription field = shape(ShapeType::HEIGHT_FIELD, {0.5, 2.0, 4, 3});
  for (int k = 0; k < 12; ++k) field.values.push_back(0.1 * (k * k % 7));
  const Surface found = surfaceOf(field, nullptr, {}, 100, 1.0);
  ASSERT_EQ(found.triangles.cols(), 12);
  std::set<int> seen;
  for (Eigen::Index i = 0; i < found.triangles.cols(); ++i) {
    const Eigen::Vector3d a = found.vertices.col(found.triangles(0, i)), b = found.vertices.col(found.triangles(1, i)),
                          c = found.vertices.col(found.triangles(2, i));
    EXPECT_NEAR((b - a).cross(c - a).z(), 0.5 * 2.0, 1e-12); // half a cell each, and it looks up
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d p = found.vertices.col(found.triangles(k, i));
      const int at = static_cast<int>(std::lround(p.x() / 0.5) + 4 * std::lround(p.y() / 2.0));
      EXPECT_EQ(p.z(), field.values.at(static_cast<std::size_t>(at)));
      seen.insert(at);
    }
  }
  EXPECT_EQ(seen.size(), 12u);
}

TEST(Grids, ground_is_as_far_as_its_triangles) {
  ShapeDescription field = shape(ShapeType::HEIGHT_FIELD, {1.0, 1.0, 3, 2});
  field.values = {0.0, 0.5, 0.0, 0.0, 0.5, 0.0};
  EXPECT_NEAR(distanceFrom(field, {1.0, 0.5, 1.5}), 1.0, 1e-12);
  EXPECT_NEAR(distanceFrom(field, {1.0, 0.5, 0.0}), 0.5 * 2.0 / std::sqrt(5.0), 1e-12);
  EXPECT_TRUE(makeGeometry(field).is_mesh);
  field.dimensions.push_back(-1.0);
  EXPECT_LE(distanceFrom(field, {1.0, 0.5, 0.0}), 0.0);
  EXPECT_FALSE(makeGeometry(field).is_open);
  field.dimensions.back() = 0.0;
  expectContains(refusal(field), "above the floor");
  field.values.pop_back();
  expectContains(refusal(field), "5 values, but 6 points");
  ShapeDescription box = shape(ShapeType::BOX, {1, 1, 1});
  box.values = {1.0};
  expectContains(refusal(box), "takes no values");
}

TEST(Grids, distances_are_certified_relative_to_their_error) {
  ShapeDescription grid = shape(ShapeType::DISTANCE_GRID, {0.5, 2, 2, 2, 0.01});
  for (int i = 0; i < 8; ++i)
    grid.values.push_back(0.5 * Eigen::Vector3d(i % 2, i / 2 % 2, i / 4).norm()); // from the first grid point
  EXPECT_NEAR(distanceFrom(grid, {0.5, 0.0, 0.0}), 0.5, 0.02);
  EXPECT_NEAR(distanceFrom(grid, {0.25, 0.0, 0.0}), 0.25, 0.02);
  grid.values[7] = 2.0;
  expectContains(refusal(grid), "neighbour");
  grid.dimensions[1] = 1;
  expectContains(refusal(grid), "whole number");
}
