/* SPDX-License-Identifier: BSD-3-Clause */
/* Queries and changes at the same time; built with the thread sanitizer where CPROX_SANITIZE says so. */
#include <unistd.h>

#include <atomic>
#include <filesystem>
#include <mutex>
#include <thread>

#include <curve_proximity/roadmap.hpp>
#include <curve_proximity/second_opinion.hpp>

#include "geometry/mesh_cache.h"
#include "support.h"

using namespace curve_proximity;
using namespace curve_proximity::test;

namespace {

/* All objects of generation g stand at distance 1 + g from the line of queries, so that an answer tells of which
 * snapshot it is. */
SceneChange generation(int g) {
  SceneChange out;
  for (int k = 0; k < 40; ++k) {
    out.operations.push_back(
        add("o" + std::to_string(k), {shape(ShapeType::SPHERE, {0.5})}, translation(1.5 + g, 0.25 * k, 0)));
  }
  return out;
}

const CurveDescription LINE = line({0, 0, 0}, {0, 10, 0});

/* work(i) for all i < n, each by a thread of its own; none begins before all are there. */
template <typename Work>
void atOnce(int n, const Work &work) {
  std::atomic<int> here{0};
  std::vector<std::thread> threads;
  for (int i = 0; i < n; ++i) {
    threads.emplace_back([&, i] {
      for (++here; here < n;) std::this_thread::yield();
      work(i);
    });
  }
  for (std::thread &thread : threads) thread.join();
}

/* A file of a mesh with a hollow, so that several hulls cover it: two plates that meet at a right angle. */
class AngleFile {
 public:
  AngleFile() : folder_((std::filesystem::temp_directory_path() / "curve_proximity_threads_XXXXXX").string()) {
    if (!mkdtemp(folder_.data())) throw std::runtime_error("no folder");
    std::ofstream file(path());
    const double x[] = {0.0, 0.4, 0.4, 0.05, 0.05, 0.0}, z[] = {0.0, 0.0, 0.05, 0.05, 0.4, 0.4};
    for (const double y : {-0.1, 0.1})
      for (int i = 0; i < 6; ++i) file << "v " << x[i] << " " << y << " " << z[i] << "\n";
    for (const auto &[a, b, c] : std::vector<std::array<int, 3>>{{1, 2, 3}, {1, 3, 4}, {1, 4, 5}, {1, 5, 6}})
      file << "f " << a << " " << b << " " << c << "\nf " << a + 6 << " " << c + 6 << " " << b + 6 << "\n";
    for (int i = 0; i < 6; ++i) {
      const int a = i + 1, b = (i + 1) % 6 + 1;
      file << "f " << b << " " << a << " " << a + 6 << "\nf " << b << " " << a + 6 << " " << b + 6 << "\n";
    }
  }
  ~AngleFile() {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }
  AngleFile(const AngleFile &) = delete;
  AngleFile &operator=(const AngleFile &) = delete;

  std::string path() const {
    return folder_ + "/angle.obj";
  }
  const std::string &folder() const {
    return folder_;
  }

 private:
  std::string folder_;
};

const std::vector<std::string> TURNS = {"a", "b"};

/* Two angles on joints a and b; a third one hangs on the base. */
std::shared_ptr<const Robot> angleRobot(const AngleFile &file, const std::string &cache = "") {
  const auto link = [&](const std::string &name) {
    return "<link name='" + name + "'><collision><geometry><mesh filename='" + file.path() +
           "'/></geometry></collision></link>";
  };
  const auto joint = [](const std::string &name, const std::string &parent, const std::string &child,
                        const std::string &xyz) {
    return "<joint name='" + name + "' type='continuous'><parent link='" + parent + "'/><child link='" + child +
           "'/><origin xyz='" + xyz + "'/><axis xyz='0 1 0'/></joint>";
  };
  RobotOptions options;
  options.resources.cache_dir = cache;
  return Robot::fromUrdf("<robot name='angles'>" + link("base") + link("upper") + link("lower") +
                             joint("a", "base", "upper", "0 0 0.6") + joint("b", "upper", "lower", "0.6 0 0") +
                             "</robot>",
                         options);
}

/* The robot among 70 balls: of more than 64 objects verdicts leave out what is far. */
SnapshotPtr amongBalls(std::shared_ptr<const Robot> robot) {
  Scene scene(std::move(robot));
  Random random(83);
  SceneChange change;
  for (int i = 0; i < 70; ++i) {
    const Eigen::Vector3d at = random.vector(2.0);
    change.operations.push_back(
        add("o" + std::to_string(i), {shape(ShapeType::SPHERE, {0.05})}, translation(at.x(), at.y(), at.z())));
  }
  EXPECT_TRUE(scene.apply(change).empty());
  return scene.snapshot();
}

TrajectoryDescription turning(const std::array<double, 4> &ends) {
  TrajectoryDescription out;
  out.id = "turning";
  out.joints = TURNS;
  out.points.resize(2);
  out.points[0].positions = {ends[0], ends[1]};
  out.points[1].positions = {ends[2], ends[3]};
  out.points[1].time = 1.0;
  return out;
}

/* Verdicts of motions of the robot, by a checker of edges and by motions of their own. */
std::vector<int> verdictsOf(const PreparedRobot &robot, const std::vector<std::array<double, 4>> &edges) {
  Query query;
  query.query_type = QueryType::COLLISION;
  Workspace workspace;
  const EdgeChecker checker(robot, TURNS, {}, RobotPairs::WHOLE, query);
  std::vector<int> out;
  for (const std::array<double, 4> &edge : edges) {
    out.push_back(checker.ask(edge.data(), edge.data() + 2, workspace));
    const RobotMotion motion(robot, turning(edge));
    out.push_back(askSelf(motion, query, workspace).result.verdict);
    out.push_back(askEnvironment(motion, query, workspace).front().result.verdict);
  }
  return out;
}

} // namespace

TEST(Threads, every_answer_is_of_one_snapshot) {
  Scene scene;
  ASSERT_TRUE(scene.apply(generation(0)).empty());
  const SnapshotPtr first = scene.snapshot();
  std::atomic<bool> done{false};
  std::atomic<int> wrong{0}, answered{0};

  std::vector<std::thread> askers;
  for (int i = 0; i < 3; ++i) {
    askers.emplace_back([&, i] {
      Workspace workspace;
      while (!done) {
        // One asks the first snapshot for ever, the others the newest.
        const SnapshotPtr snapshot = i == 0 ? first : scene.snapshot();
        const double expected = static_cast<double>(snapshot->version());
        const std::vector<Answer> answers = ask(snapshot, {}, LINE, Query(), workspace);
        const cprox_result &r = answers.at(0).result;
        if (r.status < 0 || r.lower > expected || r.upper < expected) ++wrong;
        ++answered;
      }
    });
  }
  for (int g = 1; g <= 100; ++g) scene.apply(generation(g));
  while (answered < 300) std::this_thread::yield();
  done = true;
  for (std::thread &asker : askers) asker.join();
  EXPECT_EQ(wrong, 0);
  EXPECT_EQ(scene.snapshot()->version(), 101u);
}

TEST(Threads, changes_of_several_threads_all_arrive) {
  Scene scene;
  std::vector<std::thread> changers;
  for (int i = 0; i < 4; ++i) {
    changers.emplace_back([&scene, i] {
      for (int k = 0; k < 25; ++k) {
        const std::string id = std::to_string(i) + "/" + std::to_string(k);
        scene.apply(change({add(id, {shape(ShapeType::SPHERE, {0.5})})}));
      }
    });
  }
  for (std::thread &changer : changers) changer.join();
  EXPECT_EQ(scene.snapshot()->objects().size(), 100u);
  EXPECT_EQ(scene.snapshot()->version(), 100u);
}

TEST(Threads, one_set_of_targets_serves_many_curves_at_once) {
  Scene scene(dataRobot("panda"));
  scene.apply(generation(0));
  const LinkPoses poses = scene.snapshot()->robot()->linkPoses({});
  const Query query;
  const SceneObstacles targets(scene.snapshot(), poses, query);
  Random random(81);
  std::vector<CompiledCurve> curves;
  std::vector<double> expected;
  Workspace workspace;
  for (int i = 0; i < 50; ++i) {
    curves.push_back(compile(randomBezier(random, 6, 2.0)));
    expected.push_back(ask(targets, curves.back(), query, workspace).at(0).result.upper);
  }
  std::atomic<int> wrong{0};
  std::vector<std::thread> askers;
  for (int i = 0; i < 3; ++i) {
    askers.emplace_back([&] {
      Workspace mine;
      for (std::size_t k = 0; k < curves.size(); ++k) {
        if (ask(targets, curves[k], query, mine).at(0).result.upper != expected[k]) ++wrong;
      }
    });
  }
  for (std::thread &asker : askers) asker.join();
  EXPECT_EQ(wrong, 0);
}

TEST(Threads, robots_are_read_by_several_threads_at_once) {
  std::vector<std::thread> readers;
  std::atomic<std::size_t> links{0};
  for (int i = 0; i < 3; ++i) readers.emplace_back([&] { links += dataRobot("panda")->links().size(); });
  for (std::thread &reader : readers) reader.join();
  EXPECT_EQ(links, 3 * dataRobot("panda")->links().size());
}

/* What covers a robot and its meshes is made by the first query that wants it. In each of 6 rounds 4 threads want it at
 * once: two share a prepared robot, two have one each, whose meshes are the same. */
TEST(Threads, a_robot_is_covered_by_whoever_asks_first) {
  const AngleFile file;
  Random random(82);
  std::vector<std::array<double, 4>> edges(12);
  for (std::array<double, 4> &edge : edges)
    for (double &value : edge) value = random.uniform(-3.0, 3.0);
  const SnapshotPtr known = amongBalls(angleRobot(file));
  const std::vector<int> expected = verdictsOf(PreparedRobot(known), edges);
  EXPECT_GT(std::count(expected.begin(), expected.end(), CPROX_VERDICT_CLEAR), 3);
  EXPECT_GT(std::count(expected.begin(), expected.end(), CPROX_VERDICT_VIOLATED), 3);
  std::atomic<int> wrong{0};
  for (int round = 0; round < 6; ++round) {
    const SnapshotPtr snapshot = amongBalls(angleRobot(file));
    const PreparedRobot shared(snapshot);
    const RobotMotion motion(shared, turning(edges[0]));
    atOnce(4, [&](int i) {
      if (verdictsOf(i < 2 ? shared : PreparedRobot(snapshot), edges) != expected) ++wrong;
      if (motion.skipped().empty()) ++wrong; // neighbours in the tree
    });
  }
  EXPECT_EQ(wrong, 0);
}

/* A robot, its motions and curves among objects that change: 70 spheres of generation g are 1 + g from both. Whoever
 * finds a new scene prepares the robot anew of the latest one. */
TEST(Threads, prepared_robots_are_handed_on_while_the_scene_changes) {
  const auto objects = [](int g) {
    SceneChange out;
    for (int k = 0; k < 70; ++k)
      out.operations.push_back(
          add("o" + std::to_string(k), {shape(ShapeType::SPHERE, {0.5})}, translation(1.6 + g, 0.02 * k, 0)));
    return out;
  };
  Scene scene(Robot::fromUrdf(
      "<robot name='m'><link name='base'/><link name='ball'><collision><geometry><sphere radius='0.1'/></geometry>"
      "</collision></link><joint name='j' type='prismatic'><parent link='base'/><child link='ball'/><axis xyz='0 1 0'/>"
      "<limit lower='-9' upper='9'/></joint></robot>"));
  ASSERT_TRUE(scene.apply(objects(0)).empty());
  TrajectoryDescription way;
  way.joints = {"j"};
  way.points.resize(2);
  way.points[0].positions = {0.0};
  way.points[1].positions = {1.0};
  way.points[1].time = 1.0;
  CurveDescription curve = line({0, 0, 0}, {0, 1, 0});
  curve.radius = 0.1;

  std::mutex mutex;
  std::shared_ptr<const PreparedRobot> latest = std::make_shared<PreparedRobot>(scene.snapshot());
  std::atomic<bool> done{false};
  std::atomic<int> wrong{0}, answered{0};
  const auto prepared = [&] {
    std::shared_ptr<const PreparedRobot> before;
    {
      const std::lock_guard<std::mutex> lock(mutex);
      before = latest;
    }
    const SnapshotPtr now = scene.snapshot();
    if (before->snapshot() == now) return before;
    auto made = std::make_shared<const PreparedRobot>(*before, now);
    const std::lock_guard<std::mutex> lock(mutex);
    latest = made;
    return std::shared_ptr<const PreparedRobot>(made);
  };
  atOnce(4, [&](int i) {
    if (i == 0) {
      for (int g = 1; g <= 60; ++g) scene.apply(objects(g));
      while (answered < 200) std::this_thread::yield();
      done = true;
      return;
    }
    Workspace workspace;
    while (!done) {
      const std::shared_ptr<const PreparedRobot> robot = prepared();
      const auto distance = static_cast<double>(robot->snapshot()->version());
      Query query;
      query.query_type = QueryType::TOLERANCE;
      for (const double off : {-1e-3, 1e-3}) {
        query.delta = distance + off;
        const cprox_verdict expected = off < 0.0 ? CPROX_VERDICT_CLEAR : CPROX_VERDICT_VIOLATED;
        const RobotMotion motion(*robot, way);
        if (askEnvironment(motion, query, workspace).front().result.verdict != expected) ++wrong;
        if (ask(robot->snapshot(), {}, curve, query, workspace).front().result.verdict != expected) ++wrong;
      }
      ++answered;
    }
  });
  EXPECT_EQ(wrong, 0);
}

/* Meshes of files are read once for all opinions, and FCL's tree over one is made by the first that wants it. */
TEST(Threads, second_opinions_share_the_meshes_of_files) {
  const AngleFile file;
  ShapeDescription mesh = shape(ShapeType::MESH, {});
  mesh.resource = file.path();
  const ShapeDescription ball = shape(ShapeType::SPHERE, {0.1});
  std::atomic<int> wrong{0};
  for (int round = 0; round < 8; ++round) {
    const SecondOpinions opinions(Peer::FCL);
    atOnce(4, [&](int i) {
      const double distance = 0.5 + i; // the mesh ends at x = .4
      const SecondOpinion said = opinions.ofPair(mesh, Eigen::Isometry3d::Identity(), ball,
                                                 translation(distance + 0.5, 0, 0.025), distance, distance);
      if (said.verdict != SecondOpinion::AGREES) ++wrong;
    });
  }
  EXPECT_EQ(wrong, 0);
}

/* Threads that find a mesh in memory, in the folder or in neither, while others forget and write it. */
TEST(Threads, meshes_are_kept_and_forgotten_at_once) {
  const AngleFile file;
  const std::string cache = file.folder() + "/cache";
  const std::size_t shapes = 3;
  std::atomic<int> wrong{0};
  atOnce(4, [&](int i) {
    for (int k = 0; k < 8; ++k) {
      if (i == 0) forgetMeshes();
      std::error_code ignored; // of files that come while it removes them
      if (i == 1) std::filesystem::remove_all(cache, ignored);
      const std::shared_ptr<const Robot> robot = angleRobot(file, cache);
      std::size_t found = 0;
      for (const auto &link : robot->links()) found += link.second.size();
      if (found != shapes) ++wrong;
    }
  });
  EXPECT_EQ(wrong, 0);
}
