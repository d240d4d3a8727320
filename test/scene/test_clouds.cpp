/* SPDX-License-Identifier: BSD-3-Clause */
/* Point clouds and octrees as shapes: held against their own parts one by one, and what is said of bytes that are none.
 */
#include <unistd.h>
#include <cmath>
#include <filesystem>

#include <octomap/ColorOcTree.h>
#include <octomap/OcTree.h>

#include "geometry/octree.h"
#include "support.h"

using namespace curve_proximity;
using namespace curve_proximity::test;

namespace {

ShapeDescription cloud(const Eigen::Matrix3Xd &points, std::vector<double> radius = {}) {
  ShapeDescription out = shape(ShapeType::POINTS, std::move(radius));
  out.vertices = points;
  return out;
}

ShapeDescription octree(const OctreeData &data) {
  ShapeDescription out = shape(ShapeType::OCTREE, {});
  out.octree = data;
  return out;
}

std::string refusal(const ShapeDescription &shape, const ResourceOptions &options = {}) {
  return errorOf([&] { makeGeometry(shape, options); });
}

/* A tree with n cells of 1/8 m measured as occupied and as many as free, anywhere within 2 m of the origin. */
template <class Tree>
void fill(Tree &tree, Random &random, int n) {
  for (int i = 0; i < 2 * n; ++i) {
    const Eigen::Vector3d p = random.vector(2.0);
    tree.updateNode(p.x(), p.y(), p.z(), i % 2 == 0);
  }
  tree.prune();
}

OctreeData serialised(const octomap::OcTree &tree, bool binary) {
  std::ostringstream stream;
  if (binary) {
    tree.writeBinaryData(stream);
  } else {
    tree.writeData(stream);
  }
  return {"OcTree", tree.getResolution(), binary, stream.str()};
}

/* The cells as octomap itself lists them, each a box that stands alone. */
std::vector<Operation> boxesOf(const octomap::OcTree &tree) {
  std::vector<Operation> out;
  for (auto it = tree.begin_leafs(); it != tree.end_leafs(); ++it) {
    if (!tree.isNodeOccupied(*it)) continue;
    const double size = it.getSize();
    out.push_back(add("cell" + std::to_string(out.size()),
                      {shape(ShapeType::BOX, {size, size, size}, translation(it.getX(), it.getY(), it.getZ()))}));
  }
  return out;
}

/* A file of the test's own, gone with it. */
class File {
 public:
  explicit File(const std::string &name)
      : path_(std::filesystem::temp_directory_path() / (std::to_string(::getpid()) + name)) {}
  ~File() {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
  }
  std::string path() const {
    return path_.string();
  }
  void write(const std::string &content) const {
    std::ofstream(path_, std::ios::binary) << content;
  }

 private:
  std::filesystem::path path_;
};

ShapeDescription octreeFile(const std::string &resource) {
  ShapeDescription out = shape(ShapeType::OCTREE, {});
  out.resource = resource;
  return out;
}

/* Both intervals are true for the same distance: they overlap, up to what poses and decimal cells round (1e-9 m). */
void expectSame(const Answer &a, const Answer &b) {
  ASSERT_GE(a.result.status, 0) << a.message;
  ASSERT_GE(b.result.status, 0) << b.message;
  EXPECT_LE(a.result.lower, b.result.upper + 1e-9);
  EXPECT_LE(b.result.lower, a.result.upper + 1e-9);
  EXPECT_LE(a.result.upper - a.result.lower, 1.01e-6);
}

} // namespace

/* Seed 11; 40 curves against 300 points of each radius: by the tree of the cloud, and by 300 balls or points that are
 * objects. */
TEST(Clouds, are_as_far_away_as_their_nearest_point) {
  Random random(11);
  for (const double radius : {0.0, 0.03}) {
    Eigen::Matrix3Xd points(3, 300);
    std::vector<Operation> alone;
    const Eigen::Isometry3d pose = random.pose(1.0);
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
      points.col(i) = random.vector(1.0);
      Eigen::Isometry3d at = pose;
      at.translation() = pose * Eigen::Vector3d(points.col(i));
      alone.push_back(add("p" + std::to_string(i),
                          {radius > 0.0 ? shape(ShapeType::SPHERE, {radius}, at) : shape(ShapeType::POINT, {}, at)}));
    }
    Scene together, apart;
    ASSERT_TRUE(together.apply(change({add("cloud", {cloud(points, {radius})}, pose)})).empty());
    ASSERT_TRUE(apart.apply(change(alone)).empty());
    for (int k = 0; k < 20; ++k) {
      const CurveDescription curve = randomBezier(random, 4, 2.0);
      expectSame(askOne(together, {}, curve, Query()), askOne(apart, {}, curve, Query()));
    }
  }
}

TEST(Clouds, refuse_what_is_none) {
  expectContains(refusal(cloud(Eigen::Matrix3Xd(3, 0))), "no vertices");
  expectContains(refusal(cloud(Eigen::Matrix3Xd::Constant(3, 2, NAN))), "vertex 0 is not finite");
  expectContains(refusal(cloud(Eigen::Matrix3Xd::Zero(3, 2), {-0.1})), "not below 0");
  expectContains(refusal(cloud(Eigen::Matrix3Xd::Zero(3, 2), {1, 2})), "got 2");
}

TEST(Clouds, beyond_the_memory_limit_name_the_bytes_they_need) {
  ResourceOptions options;
  options.memory_limit = 1000000;
  const std::string why = refusal(cloud(Eigen::Matrix3Xd::Random(3, 100000)), options);
  expectContains(why, "100000 points need up to ");
  expectContains(why, "bytes, above the limit of 1000000");
}

/* Seed 12; 30 curves against trees of 200 cells, as bytes of both kinds: the cells one by one are what octomap lists.
 */
TEST(Octrees, are_as_far_away_as_their_nearest_occupied_cell) {
  Random random(12);
  octomap::OcTree tree(0.125);
  fill(tree, random, 200);
  Scene apart;
  ASSERT_TRUE(apart.apply(change(boxesOf(tree))).empty());
  for (const bool binary : {true, false}) {
    Scene together;
    ASSERT_TRUE(together.apply(change({add("map", {octree(serialised(tree, binary))})})).empty());
    for (int k = 0; k < 15; ++k) {
      const CurveDescription curve = randomBezier(random, 4, 3.0);
      expectSame(askOne(together, {}, curve, Query()), askOne(apart, {}, curve, Query()));
    }
  }
}

/* Eight occupied cells are one cube of twice the size, here [0, 1]³; one of its neighbours is known to be free. */
TEST(Octrees, of_eight_equal_cells_are_one_cube) {
  octomap::OcTree tree(0.5);
  for (int i = 0; i < 8; ++i)
    tree.updateNode(0.25 + 0.5 * (i & 1), 0.25 + 0.5 * (i >> 1 & 1), 0.25 + 0.5 * (i >> 2), true);
  tree.updateNode(1.25, 0.25, 0.25, false);
  Scene scene;
  ASSERT_TRUE(scene.apply(change({add("map", {octree(serialised(tree, false))})})).empty());
  const Answer answer = askOne(scene, {}, line({3, 0.5, 0.5}, {3, 0.6, 0.5}), Query());
  EXPECT_LE(answer.result.lower, 2.0);
  EXPECT_GE(answer.result.upper, 2.0);
  const cprox_body *body = scene.snapshot()->objects().at("map")->shapes[0].geometry.body.get();
  const BodyHandle one = makeBoxes(Eigen::Vector3d::Zero(), Eigen::Vector3d::Ones());
  EXPECT_EQ(cprox_body_get_info(body).bytes, cprox_body_get_info(one.get()).bytes);
}

/* Two cells are measured, one occupied and one free, a metre apart: between them lies what nobody has seen. */
TEST(Octrees, count_the_unknown_as_they_are_told) {
  octomap::OcTree tree(0.25);
  tree.updateNode(0.125, 0.125, 0.125, true);
  tree.updateNode(1.125, 0.125, 0.125, false);
  for (const bool occupied : {false, true}) {
    ShapeDescription map = octree(serialised(tree, true));
    map.unknown_is_occupied = occupied;
    Scene scene;
    ASSERT_TRUE(scene.apply(change({add("map", {map})})).empty());
    const auto upper = [&](double x) {
      return askOne(scene, {}, line({x, 0.1, 0.5}, {x, 0.2, 0.5}), Query()).result.upper;
    };
    EXPECT_NEAR(upper(0.125), 0.25, 2e-6);                                   // the occupied one
    EXPECT_NEAR(upper(0.6), occupied ? 0.25 : std::hypot(0.35, 0.25), 2e-6); // the unknown between them
    EXPECT_NEAR(upper(1.125), occupied ? std::hypot(0.125, 0.25) : std::hypot(0.875, 0.25), 2e-6); // the free one
    EXPECT_NEAR(upper(2.0), occupied ? std::hypot(1.0, 0.25) : std::hypot(1.75, 0.25), 2e-6); // none outside of all
  }
}

TEST(Octrees, come_from_files_of_octomap) {
  Random random(13);
  octomap::OcTree plain(0.1);
  octomap::ColorOcTree coloured(0.1);
  fill(plain, random, 100);
  fill(coloured, random, 100);
  const File bt(".bt"), ot(".ot"), colour(".colour.ot");
  ASSERT_TRUE(plain.writeBinaryConst(bt.path()));
  ASSERT_TRUE(plain.write(ot.path()));
  ASSERT_TRUE(coloured.write(colour.path()));
  EXPECT_NE(makeGeometry(octreeFile(colour.path())).body, nullptr);

  Scene of_bt, of_ot;
  ASSERT_TRUE(of_bt.apply(change({add("map", {octreeFile(bt.path())})})).empty());
  ASSERT_TRUE(of_ot.apply(change({add("map", {octreeFile(ot.path())})})).empty());
  const CurveDescription curve = randomBezier(random, 4, 3.0);
  expectSame(askOne(of_bt, {}, curve, Query()), askOne(of_ot, {}, curve, Query()));
}

/* Every shorter length of a file is refused in one line that names it; so is every header that is none. */
TEST(Octrees, cut_short_are_refused_by_name) {
  Random random(14);
  octomap::OcTree tree(0.1);
  fill(tree, random, 4);
  for (const bool binary : {true, false}) {
    const File file(binary ? ".bt" : ".ot");
    if (binary) {
      ASSERT_TRUE(tree.writeBinaryConst(file.path()));
    } else {
      ASSERT_TRUE(tree.write(file.path()));
    }
    const std::string whole = readText(file.path());
    for (std::size_t n = 1; n < whole.size(); ++n) {
      file.write(whole.substr(0, n));
      const std::string why = refusal(octreeFile(file.path()));
      ASSERT_NE(why.find(file.path()), std::string::npos) << n << ": " << why;
      ASSERT_EQ(why.find('\n'), std::string::npos) << why;
    }
    file.write("solid t\n" + whole);
    expectContains(refusal(octreeFile(file.path())), "no octomap header");
  }
}

/* Seed 15, 3000 trees with up to four bytes that are others: each is refused or is a body; octomap never sees what it
 * cannot bear. */
TEST(Octrees, of_wrong_bytes_are_refused_or_bodies) {
  Random random(15);
  octomap::OcTree tree(0.1);
  fill(tree, random, 8);
  int refused = 0;
  for (int k = 0; k < 3000; ++k) {
    OctreeData data = serialised(tree, k % 2 == 0);
    for (std::size_t i = random.below(4) + 1; i > 0; --i)
      data.data[random.below(data.data.size())] = static_cast<char>(random.bits());
    try {
      makeGeometry(octree(data));
    } catch (const Error &) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 100);
  EXPECT_LT(refused, 2900);
}

TEST(Octrees, refuse_what_is_none) {
  const OctreeData deep{"OcTree", 0.1, true, std::string(1000, '\xff')};
  expectContains(refusal(octree(deep)), "deeper than 16 levels");
  octomap::OcTree tree(0.1);
  tree.updateNode(0.0, 0.0, 0.0, false);
  OctreeData free = serialised(tree, true);
  EXPECT_FALSE(makeGeometry(octree(free)).body); // the empty set
  free.resolution = 0.0;
  expectContains(refusal(octree(free)), "resolution");
  free.resolution = 0.1, free.id = "OcTreeBaseImpl";
  expectContains(refusal(octree(free)), "OcTreeBaseImpl");
  expectContains(refusal(shape(ShapeType::OCTREE, {})), "neither a file nor bytes");
  expectContains(refusal(octreeFile("/nowhere.bt")), "octree '/nowhere.bt': there is no file");

  ResourceOptions options;
  options.memory_limit = 1000;
  tree.updateNode(1.0, 1.0, 1.0, true);
  expectContains(refusal(octree(serialised(tree, true)), options), "above the limit of 1000");
}
