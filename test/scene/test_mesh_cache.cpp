/* SPDX-License-Identifier: BSD-3-Clause */
/* Meshes that are read once and kept, and the hulls that are kept with them. */
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <filesystem>
#include <thread>

#include "geometry/hull.h"
#include "geometry/mesh_cache.h"
#include "support.h"

using namespace curve_proximity;
using namespace curve_proximity::test;

namespace {

namespace fs = std::filesystem;

const std::string LINK = TEST_DATA_DIR "/robots/fanuc_m10ia/meshes/link_2.stl";

/* A folder of the test's own, gone with it. */
class Folder {
 public:
  Folder() : path_((fs::temp_directory_path() / "curve_proximity_mesh_cache_XXXXXX").string()) {
    if (!mkdtemp(path_.data())) throw std::runtime_error("no folder");
  }
  ~Folder() {
    std::error_code ignored;
    fs::permissions(path_, fs::perms::owner_all, ignored);
    fs::remove_all(path_, ignored);
  }
  const std::string &path() const {
    return path_;
  }
  std::vector<std::string> files() const {
    std::vector<std::string> out;
    for (const auto &entry : fs::directory_iterator(path_)) out.push_back(entry.path().string());
    return out;
  }

 private:
  std::string path_;
};

std::string contentOf(const std::string &file) {
  std::ifstream stream(file, std::ios::binary);
  return std::string((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
}

void write(const std::string &file, const std::string &content) {
  std::ofstream(file, std::ios::binary) << content;
}

PreparedMesh someMesh(std::uint64_t seed) {
  Random random(seed);
  PreparedMesh out;
  out.mesh.vertices.resize(3, 20);
  for (Eigen::Index i = 0; i < 20; ++i) out.mesh.vertices.col(i) = random.vector(1.0);
  out.mesh.triangles.resize(3, 18);
  for (int i = 0; i < 18; ++i) out.mesh.triangles.col(i) << i, i + 1, i + 2;
  for (int i = 0; i < 7; ++i) out.hull.kept.push_back(random.vector(1.0));
  out.hull.excess = 1e-13;
  out.mesh.remark = "its unit is '0.01' m";
  return out;
}

bool same(const PreparedMesh &a, const PreparedMesh &b) {
  return a.mesh.vertices == b.mesh.vertices && a.mesh.triangles == b.mesh.triangles && a.hull.kept == b.hull.kept &&
         a.hull.excess == b.hull.excess && a.mesh.remark == b.mesh.remark;
}

Digest keyNumber(int i) {
  return digestOf(&i, sizeof i);
}

/* Loads LINK; memory is forgotten first. */
Geometry load(const std::string &cache_dir, MeshTiming &timing, const Eigen::Vector3d &scale = {1, 1, 1}) {
  forgetMeshes();
  ResourceOptions options;
  options.cache_dir = cache_dir;
  return loadMeshGeometry({LINK, LINK, scale, true}, options, &timing);
}

/* Exactly the same body: support values in 200 directions, and nearest points. */
void expectSame(const Geometry &a, const Geometry &b) {
  Random random(5);
  EXPECT_EQ(a.hull_excess, b.hull_excess);
  for (int i = 0; i < 200; ++i) {
    const cprox_vec3 d = toVec3(random.vector(1.0));
    for (auto body : {&Geometry::body, &Geometry::hull, &Geometry::surface}) {
      EXPECT_EQ(cprox_body_support((a.*body).get(), d, nullptr), cprox_body_support((b.*body).get(), d, nullptr));
      EXPECT_EQ(cprox_body_nearest((a.*body).get(), d, nullptr), cprox_body_nearest((b.*body).get(), d, nullptr));
    }
  }
}

} // namespace

/* RFC 7693 gives the algorithm; these values are those of Python's hashlib.blake2b(digest_size=32). */
TEST(Digests, are_those_of_blake2b) {
  const auto of = [](const std::string &text) { return toHex(digestOf(text.data(), text.size())); };
  EXPECT_EQ(of(""), "0e5751c026e543b2e8ab2eb06099daa1d1e5df47778f7787faab45cdf12fe3a8");
  EXPECT_EQ(of("abc"), "bddd813c634239723171ef3fee98579b94964e3bb1cb3e427262c8c068d52319");
  std::string text;
  for (int i = 0; i < 257; ++i) text += static_cast<char>(i * 7 + 3);
  EXPECT_EQ(of(text), "4ce481b24d387422d2bc2baa03d1afd55a1327939ff537c71eb9b38709268649");
  for (std::size_t piece = 1; piece < 257; piece += 17) {
    Hasher hasher;
    for (std::size_t i = 0; i < text.size(); i += piece) hasher.add(text.data() + i, std::min(piece, text.size() - i));
    EXPECT_EQ(hasher.finish(), digestOf(text.data(), text.size()));
  }
}

TEST(MeshCache, what_is_saved_is_loaded) {
  const Folder folder;
  const PreparedMesh mesh = someMesh(1);
  saveMesh(folder.path() + "/new/folders", keyNumber(1), mesh);
  const PreparedMeshPtr loaded = loadMesh(folder.path() + "/new/folders", keyNumber(1));
  ASSERT_TRUE(loaded);
  EXPECT_TRUE(same(*loaded, mesh));
  EXPECT_FALSE(loadMesh(folder.path() + "/new/folders", keyNumber(2)));
  EXPECT_FALSE(loadMesh("", keyNumber(1)));
}

/* Each byte changed, and the file cut after each: nothing of it is believed. */
TEST(MeshCache, damaged_files_are_ignored) {
  const Folder folder;
  saveMesh(folder.path(), keyNumber(1), someMesh(2));
  ASSERT_EQ(folder.files().size(), 1U);
  const std::string file = folder.files().front(), good = contentOf(file);
  for (std::size_t i = 0; i < good.size(); ++i) {
    std::string bad = good;
    bad[i] = static_cast<char>(bad[i] ^ (1 << (i % 8)));
    write(file, bad);
    EXPECT_FALSE(loadMesh(folder.path(), keyNumber(1))) << "byte " << i;
    write(file, good.substr(0, i));
    EXPECT_FALSE(loadMesh(folder.path(), keyNumber(1))) << "cut to " << i;
  }
  write(file, good + "x");
  EXPECT_FALSE(loadMesh(folder.path(), keyNumber(1)));
  write(file, good);
  EXPECT_TRUE(loadMesh(folder.path(), keyNumber(1)));
}

TEST(MeshCache, foreign_files_are_ignored) {
  const Folder folder;
  saveMesh(folder.path(), keyNumber(1), someMesh(3));
  const std::string file = folder.files().front();
  chmod(file.c_str(), 0666); // others could have written it
  EXPECT_FALSE(loadMesh(folder.path(), keyNumber(1)));
  chmod(file.c_str(), 0600);
  EXPECT_TRUE(loadMesh(folder.path(), keyNumber(1)));
  fs::rename(file, file + ".elsewhere");
  fs::create_symlink(file + ".elsewhere", file);
  EXPECT_FALSE(loadMesh(folder.path(), keyNumber(1)));
  fs::remove(file);
  fs::create_directory(file);
  EXPECT_FALSE(loadMesh(folder.path(), keyNumber(1)));
  if (geteuid() == 0) { // only root can give a file away
    fs::remove(file);
    fs::rename(file + ".elsewhere", file);
    ASSERT_EQ(chown(file.c_str(), 12345, 12345), 0);
    EXPECT_FALSE(loadMesh(folder.path(), keyNumber(1)));
  }
}

/* One entry's content under another entry's name. */
TEST(MeshCache, a_file_answers_for_its_own_key_only) {
  const Folder folder;
  saveMesh(folder.path(), keyNumber(1), someMesh(4));
  const std::string one = folder.files().front();
  saveMesh(folder.path(), keyNumber(2), someMesh(5));
  for (const std::string &file : folder.files())
    if (file != one) fs::copy_file(one, file, fs::copy_options::overwrite_existing);
  EXPECT_TRUE(loadMesh(folder.path(), keyNumber(1)));
  EXPECT_FALSE(loadMesh(folder.path(), keyNumber(2)));
}

TEST(MeshCache, geometry_is_the_same_from_file_disk_and_memory) {
  const Folder folder;
  MeshTiming first, second, third;
  const Geometry from_file = load(folder.path(), first);
  EXPECT_EQ(first.from, MeshTiming::FILE);
  EXPECT_EQ(folder.files().size(), 1U);
  const Geometry from_disk = load(folder.path(), second);
  EXPECT_EQ(second.from, MeshTiming::CACHE_DIR);
  ResourceOptions options;
  options.cache_dir = folder.path();
  const Geometry from_memory = loadMeshGeometry({LINK, LINK, {1, 1, 1}, true}, options, &third);
  EXPECT_EQ(third.from, MeshTiming::MEMORY);
  expectSame(from_file, from_disk);
  expectSame(from_file, from_memory);

  MeshTiming scaled; // another scale is another mesh
  load(folder.path(), scaled, {2, 1, 1});
  EXPECT_EQ(scaled.from, MeshTiming::FILE);
  EXPECT_EQ(folder.files().size(), 2U);
}

TEST(MeshCache, a_mesh_file_that_changes_is_read_again) {
  const Folder folder, meshes;
  const std::string file = meshes.path() + "/a.stl";
  write(file, contentOf(LINK));
  ResourceOptions options;
  options.cache_dir = folder.path();
  MeshTiming timing;
  const Geometry before = loadMeshGeometry({file, file, {1, 1, 1}, true}, options, &timing);
  std::string other = contentOf(LINK);
  const float far = 7.0F;
  other.replace(84 + 12, sizeof far, reinterpret_cast<const char *>(&far),
                sizeof far); // a corner of the first triangle
  write(file, other);
  const Geometry after = loadMeshGeometry({file, file, {1, 1, 1}, true}, options, &timing);
  EXPECT_EQ(timing.from, MeshTiming::FILE);
  EXPECT_EQ(cprox_body_support(after.hull.get(), {1, 0, 0}, nullptr), 7.0);
  EXPECT_LT(cprox_body_support(before.hull.get(), {1, 0, 0}, nullptr), 7.0);
}

TEST(MeshCache, a_folder_that_cannot_be_written_is_no_fault) {
  MeshTiming timing;
  EXPECT_TRUE(load("/proc/nowhere", timing).is_mesh);
  EXPECT_TRUE(load("", timing).is_mesh);
  EXPECT_EQ(timing.from, MeshTiming::FILE);
}

/* Four threads write and read the same key: each finds all or nothing. */
TEST(MeshCache, writers_and_readers_do_not_meet_half_way) {
  const Folder folder;
  const PreparedMesh mesh = someMesh(6);
  std::atomic<int> faults{0};
  std::vector<std::thread> threads;
  for (int t = 0; t < 4; ++t) {
    threads.emplace_back([&] {
      for (int i = 0; i < 50; ++i) {
        saveMesh(folder.path(), keyNumber(1), mesh);
        const PreparedMeshPtr loaded = loadMesh(folder.path(), keyNumber(1));
        if (!loaded || !same(*loaded, mesh)) ++faults;
      }
    });
  }
  for (std::thread &thread : threads) thread.join();
  EXPECT_EQ(faults, 0);
  EXPECT_EQ(folder.files().size(), 1U);
}

TEST(MeshCache, memory_forgets_what_was_not_used_for_longest) {
  forgetMeshes();
  auto large = std::make_shared<PreparedMesh>();
  large->mesh.vertices.resize(3, 1 << 19); // 12 MiB: five of them are kept
  for (int i = 0; i < 7; ++i) {
    keepMesh(keyNumber(i), large);
    EXPECT_TRUE(recallMesh(keyNumber(0))); // always in use
  }
  EXPECT_FALSE(recallMesh(keyNumber(1)));
  EXPECT_TRUE(recallMesh(keyNumber(6)));
  forgetMeshes();
  EXPECT_FALSE(recallMesh(keyNumber(6)));
}

/* Seed 34: facets that are right, wrong, repeated or degenerate, of hulls of 100 sets of 200 points: all points are
 * covered. Tolerance: the accuracy of cprox_body_nearest. */
TEST(Hulls, cover_all_points_whatever_the_facets_are) {
  Random random(34);
  for (int i = 0; i < 100; ++i) {
    Points all, kept;
    const double size = std::pow(10.0, random.uniform(-3, 3));
    const Eigen::Vector3d half(size, size * std::pow(10.0, random.uniform(-6, 0)), size), at = random.vector(5 * size);
    for (int k = 0; k < 200; ++k) all.push_back(at + random.vector(1.0).cwiseProduct(half));
    for (const Eigen::Vector3d &p : all)
      if (kept.size() < 4 || random.below(4) == 0) kept.push_back(p);
    std::vector<HullFacet> facets;
    const auto corner = [&] { return static_cast<int>(random.below(kept.size())); };
    for (int k = 0; k < 100; ++k) facets.push_back({corner(), corner(), corner()});
    const HullPoints hull = coveringPoints(all, kept, facets);
    const BodyHandle body = polytopeOf(hull.kept);
    const double largest = at.cwiseAbs().maxCoeff() + size;
    EXPECT_LE(hull.excess, 1e-11 * largest);
    for (const Eigen::Vector3d &p : all)
      EXPECT_LE(cprox_body_nearest(body.get(), toVec3(p), nullptr), hull.excess + 64 * 0x1p-53 * 6.0 * largest);
  }
}

/* Seed 35: points on spheres, boxes and cylinders with noise of a rounding error, as meshes have them. */
TEST(Hulls, cover_points_that_are_nearly_on_the_surface) {
  Random random(35);
  for (int i = 0; i < 60; ++i) {
    Points all;
    for (int k = 0; k < 600; ++k) {
      Eigen::Vector3d p = random.vector(1.0);
      if (i % 3 == 0) p.normalize();
      if (i % 3 == 1) p[static_cast<Eigen::Index>(random.below(3))] = random.below(2) ? 1.0 : -1.0;
      if (i % 3 == 2) p.head<2>().normalize();
      all.push_back(p * (1.0 + 1e-16 * static_cast<double>(random.below(7))));
    }
    const HullPoints hull = hullPointsOf(all);
    EXPECT_LE(hull.excess, 2e-12);
    const BodyHandle body = polytopeOf(hull.kept);
    for (const Eigen::Vector3d &p : all)
      EXPECT_LE(cprox_body_nearest(body.get(), toVec3(p), nullptr), hull.excess + 64 * 0x1p-53 * 6.0);
  }
}
