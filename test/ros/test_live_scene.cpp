/* SPDX-License-Identifier: BSD-3-Clause */
/* The scene and what sensors show of it belong together, whoever changes and reads them at once. */
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <string>
#include <thread>
#include <vector>

#include "world/live_scene.h"

namespace curve_proximity {
namespace {

const std::string CLOUD = "cloud";

SceneChange cloud(int count = 50) {
  Operation operation;
  operation.object.id = CLOUD;
  ShapeDescription points;
  points.type = ShapeType::POINTS;
  points.dimensions = {0.01};
  points.vertices = Eigen::Matrix3Xd::Random(3, count);
  operation.object.shapes = {points};
  SceneChange out;
  out.operations = {operation};
  return out;
}

void show(LiveScene &live) {
  live.applySeen(cloud(), CLOUD, ros::Time());
}

std::vector<std::string> apply(LiveScene &live, const SceneChange &change) {
  return live.apply(change, *live.scene.snapshot());
}

/* A row that takes in the cloud is clear although the cloud is not in the scene: as if the sensor had seen nothing. */
bool isFalselyClear(const LiveScene::Seen &seen) {
  const auto sensor = std::find_if(seen.sensors.begin(), seen.sensors.end(),
                                   [](const SensorState &state) { return state.id == CLOUD; });
  return seen.snapshot->objects().count(CLOUD) == 0 && (sensor == seen.sensors.end() || !sensor->unknown);
}

/* A sensor shows its cloud 400 times while the scene is changed by `emptied`, and read by two threads. */
void stress(const SceneChange &emptied) {
  LiveScene live(nullptr, Srdf(), ResourceOptions());
  live.sensors.awaits(CLOUD);
  std::atomic<bool> done{false};
  std::atomic<int> wrong{0}, there{0}, gone{0};
  std::vector<std::thread> threads;
  for (int i = 0; i < 2; ++i) {
    threads.emplace_back([&] {
      while (!done) {
        const LiveScene::Seen seen = live.seen();
        wrong += isFalselyClear(seen);
        ++(seen.snapshot->objects().count(CLOUD) > 0 ? there : gone);
      }
    });
  }
  threads.emplace_back([&] {
    while (!done) apply(live, emptied);
  });
  for (int i = 0; i < 400 || there == 0 || gone == 0; ++i) {
    show(live);
    if (i % 10 == 0) std::this_thread::yield();
  }
  done = true;
  for (std::thread &thread : threads) thread.join();
  EXPECT_EQ(wrong, 0);
  EXPECT_FALSE(isFalselyClear(live.seen()));
}

TEST(LiveScene, a_cloud_that_a_clear_takes_away_is_unknown_at_once) {
  SceneChange clear;
  clear.clear = true;
  stress(clear);
}

/* Two clouds by turns, of other points and of another age: what is read shows both of the same message. */
TEST(LiveScene, a_cloud_is_as_old_as_the_message_that_shows_it) {
  ros::Time::init();
  LiveScene live(nullptr, Srdf(), ResourceOptions());
  const ros::Time now = ros::Time::now();
  const auto show_one = [&](int i) { // the odd ones are older and of two points
    live.applySeen(cloud(1 + i % 2), CLOUD, now - ros::Duration(i % 2 ? 3000 : 1000));
  };
  show_one(0);
  std::atomic<bool> done{false};
  std::atomic<int> mixed{0}, odd{0}, even{0};
  std::vector<std::thread> threads;
  for (int i = 0; i < 3; ++i) {
    threads.emplace_back([&] {
      while (!done) {
        const LiveScene::Seen seen = live.seen();
        const bool is_odd = seen.snapshot->objects().at(CLOUD)->description.shapes.front().vertices.cols() == 2;
        mixed += is_odd != (seen.sensors.front().age > 2000);
        ++(is_odd ? odd : even);
      }
    });
  }
  for (int i = 0; i < 20000 || odd == 0 || even == 0; ++i) show_one(i);
  done = true;
  for (std::thread &thread : threads) thread.join();
  EXPECT_EQ(mixed, 0);
}

TEST(LiveScene, a_message_that_came_after_an_object_was_set_stays) {
  ros::Time::init();
  SensorBoard board;
  board.saw(CLOUD, ros::Time::now(), 0, 5);
  board.forget(CLOUD, 4);
  EXPECT_EQ(board.states().size(), 1u);
  board.forget(CLOUD, 5);
  EXPECT_TRUE(board.states().empty());
}

/* A whole scene of move_group keeps the objects of those sensors that were known when it was made. */
TEST(LiveScene, a_cloud_that_a_whole_scene_takes_away_is_unknown_at_once) {
  SceneChange whole;
  whole.clear_objects = true;
  stress(whole);
}

TEST(LiveScene, a_whole_scene_leaves_what_it_keeps_known) {
  LiveScene live(nullptr, Srdf(), ResourceOptions());
  show(live);
  SceneChange whole;
  whole.clear_objects = true;
  whole.kept = {CLOUD};
  EXPECT_TRUE(apply(live, whole).empty());
  EXPECT_EQ(live.seen().snapshot->objects().count(CLOUD), 1u);
  EXPECT_FALSE(live.seen().sensors.front().unknown);
}

TEST(LiveScene, an_object_that_somebody_sets_is_no_sensors) {
  LiveScene live(nullptr, Srdf(), ResourceOptions());
  show(live);
  live.unknowns.set(REFUSED_OBJECT + CLOUD, {{"it could not be used", CLOUD, Missing::GEOMETRY}});
  EXPECT_TRUE(apply(live, cloud()).empty());
  EXPECT_TRUE(live.seen().sensors.empty());
  EXPECT_TRUE(live.seen().unknowns.empty());
}

/* What cannot be applied leaves the object as old as it was, and its sensor's. */
TEST(LiveScene, a_faulty_change_notes_nothing) {
  LiveScene live(nullptr, Srdf(), ResourceOptions());
  show(live);
  SceneChange bad = cloud();
  bad.operations.front().object.padding = -1.0;
  EXPECT_FALSE(apply(live, bad).empty());
  EXPECT_EQ(live.seen().sensors.size(), 1u);
  live.sensors.refused(CLOUD);
  EXPECT_THROW(live.applySeen(bad, CLOUD, ros::Time()), Error);
  EXPECT_TRUE(live.seen().sensors.front().unknown);
}

} // namespace
} // namespace curve_proximity
