/* SPDX-License-Identifier: BSD-3-Clause */
/** The client helper against a server that goes and comes back, and calls of a nodelet in this process. */
#include <curve_proximity/ApplyScene.h>
#include <curve_proximity/Distance.h>
#include <curve_proximity/GetScene.h>
#include <gtest/gtest.h>
#include <nodelet/loader.h>
#include <ros/ros.h>

#include <atomic>
#include <chrono>
#include <curve_proximity/client.hpp>
#include <curve_proximity/local_call.hpp>
#include <thread>
#include <vector>

#include "transport/local_services.h"

namespace curve_proximity {
namespace {

bool answer(GetScene::Request &, GetScene::Response &response) {
  response.success = true;
  return true;
}

ros::ServiceServer serve() {
  return ros::NodeHandle().advertiseService("restarting/get_scene", answer);
}

TEST(PersistentClient, one_lookup_serves_many_calls) {
  ros::ServiceServer server = serve();
  PersistentClient<GetScene> client(ros::NodeHandle(), "restarting/get_scene");
  GetScene call;
  for (int i = 0; i < 100; ++i) ASSERT_TRUE(client.call(call, 5.0));
  EXPECT_TRUE(call.response.success);
  EXPECT_EQ(client.lookups(), 1u);
}

TEST(PersistentClient, a_restarted_server_is_found_again_after_few_lookups) {
  ros::ServiceServer server = serve();
  PersistentClient<GetScene> client(ros::NodeHandle(), "restarting/get_scene");
  GetScene call;
  ASSERT_TRUE(client.call(call, 5.0));
  server.shutdown();
  std::thread restart([&server] {
    std::this_thread::sleep_for(std::chrono::milliseconds(1500));
    server = serve();
  });
  EXPECT_TRUE(client.call(call, 10.0));
  restart.join();
  // pauses of 10, 20, 40, 80, 160, 320, 500, 500 … ms
  EXPECT_LE(client.lookups(), 15u);
}

TEST(PersistentClient, a_server_that_stays_away_is_given_up_in_time) {
  PersistentClient<GetScene> client(ros::NodeHandle(), "restarting/nobody");
  GetScene call;
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_FALSE(client.call(call, 1.0));
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(3));
  EXPECT_LE(client.lookups(), 10u);
}

/* What ends a call and what gives it up drop one connection. */
TEST(PersistentClient, a_call_that_hangs_is_ended_by_another_thread) {
  std::atomic<bool> asked{false}, ending{false};
  ros::NodeHandle handle;
  const boost::function<bool(GetScene::Request &, GetScene::Response &)> hang = [&](GetScene::Request &,
                                                                                    GetScene::Response &) {
    asked = true;
    while (!ending) std::this_thread::sleep_for(std::chrono::microseconds(100));
    asked = false;
    return true;
  };
  const ros::ServiceServer server = handle.advertiseService("hanging/get_scene", hang);
  for (int i = 0; i < 300; ++i) {
    ending = false;
    PersistentClient<GetScene> client(handle, "hanging/get_scene");
    std::thread calling([&] {
      GetScene call;
      EXPECT_FALSE(client.call(call, 30.0));
    });
    while (!asked) std::this_thread::yield();
    client.end();
    calling.join();
    ending = true;
    while (asked) std::this_thread::yield();
  }
}

Distance lineBesideABall() {
  Distance out;
  Curve curve;
  curve.id = "line";
  curve.basis = "bezier";
  curve.points.resize(2);
  curve.points[1].x = 1.0;
  out.request.query.curves.push_back(curve);
  return out;
}

ApplyScene ball(double z) {
  ApplyScene out;
  out.request.clear = true;
  out.request.objects.resize(1);
  CollisionObject &object = out.request.objects.front();
  object.id = "ball";
  object.pose.position.z = z;
  object.pose.orientation.w = 1.0;
  object.primitives.resize(1);
  object.primitives[0].type = shape_msgs::SolidPrimitive::SPHERE;
  object.primitives[0].dimensions = {0.5};
  return out;
}

TEST(callInProcess, answers_as_the_service_does_until_the_nodelet_is_unloaded) {
  ros::NodeHandle().setParam("/local/state_file", "");
  nodelet::Loader loader;
  ASSERT_TRUE(loader.load("/local", "curve_proximity/ProximityServer", {}, {}));
  ApplyScene scene = ball(2.0);
  ASSERT_TRUE(callInProcess("/local/apply_scene", scene));
  ASSERT_TRUE(scene.response.success) << scene.response.message;
  Distance here = lineBesideABall(), there = lineBesideABall();
  ASSERT_TRUE(callInProcess("/local/distance", here));
  ASSERT_TRUE(ros::service::call("/local/distance", there));
  ASSERT_TRUE(here.response.success) << here.response.message;
  EXPECT_NEAR(here.response.results.at(0).lower, 1.5, 1e-6);
  EXPECT_EQ(here.response.results[0].lower, there.response.results.at(0).lower);
  EXPECT_EQ(here.response.results[0].upper, there.response.results[0].upper);
  Distance wrong = lineBesideABall();
  wrong.request.query.curves[0].basis = "none";
  ASSERT_TRUE(callInProcess("/local/distance", wrong));
  EXPECT_FALSE(wrong.response.success);

  GetScene other;
  EXPECT_FALSE(callInProcess("/local/distance", other)); // of another type
  EXPECT_FALSE(callInProcess("/local/nothing", other));

  // While threads call it goes: each call is answered, or says that nothing is there.
  std::atomic<int> answered{0};
  std::vector<std::thread> calling;
  for (int i = 0; i < 4; ++i) {
    calling.emplace_back([&] {
      Distance call = lineBesideABall();
      while (callInProcess("/local/distance", call)) {
        EXPECT_TRUE(call.response.success || !call.response.message.empty());
        ++answered;
      }
    });
  }
  while (answered < 100) std::this_thread::yield();
  EXPECT_TRUE(loader.unload("/local"));
  for (std::thread &thread : calling) thread.join();
  EXPECT_FALSE(callInProcess("/local/distance", here));
}

TEST(callInProcess, a_later_server_of_the_same_name_outlives_the_one_before) {
  const auto saying = [](const char *what) {
    return [what](const Call &, const ServiceHelper<GetScene>::Read &, GetScene::Response &response) {
      response.message = what;
    };
  };
  LocalServices before, after;
  before.add<GetScene>("/twice/get_scene", saying("before"));
  after.add<GetScene>("/twice/get_scene", saying("after"));
  before.end();
  GetScene call;
  ASSERT_TRUE(callInProcess("/twice/get_scene", call));
  EXPECT_EQ(call.response.message, "after");
  after.end();
  EXPECT_FALSE(callInProcess("/twice/get_scene", call));
}

} // namespace
} // namespace curve_proximity

int main(int argc, char **argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "client");
  const ros::NodeHandle handle;
  ros::AsyncSpinner spinner(1);
  spinner.start();
  return RUN_ALL_TESTS();
}
