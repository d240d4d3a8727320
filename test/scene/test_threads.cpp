/* SPDX-License-Identifier: BSD-3-Clause */
/* Queries and changes at the same time; built with the thread sanitizer where CPROX_SANITIZE says so. */
#include <atomic>
#include <thread>

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
