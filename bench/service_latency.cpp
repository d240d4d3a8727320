/* SPDX-License-Identifier: BSD-3-Clause */
/** What the service adds to the core's time: one curve of 6 points against 30 objects, over a persistent connection to a
 *  running node. Prints the 50th and 99th percentile of the call, of the core's share, and of the difference [µs].
 *
 *  usage: curve_proximity_bench_service [node name, default curve_proximity] [calls, default 20000] */
#include <curve_proximity/ApplyScene.h>
#include <curve_proximity/Distance.h>
#include <ros/ros.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <curve_proximity/client.hpp>
#include <string>
#include <vector>

namespace {

using namespace curve_proximity;

constexpr int OBJECTS = 30;

geometry_msgs::Point point(double x, double y, double z) {
  geometry_msgs::Point p;
  p.x = x;
  p.y = y;
  p.z = z;
  return p;
}

/** Boxes on a ring about the curve. */
ApplyScene ring() {
  ApplyScene scene;
  scene.request.clear = true;
  for (int i = 0; i < OBJECTS; ++i) {
    CollisionObject object;
    object.id = "box" + std::to_string(i);
    shape_msgs::SolidPrimitive box;
    box.type = shape_msgs::SolidPrimitive::BOX;
    box.dimensions.assign(3, 0.1);
    object.primitives.push_back(box);
    object.pose.position = point(std::cos(0.2 * i), std::sin(0.2 * i), 0.03 * i);
    object.pose.orientation.w = 1.0;
    scene.request.objects.push_back(object);
  }
  return scene;
}

Distance question() {
  Distance call;
  Curve curve;
  curve.id = "curve";
  curve.basis = "bezier";
  for (int i = 0; i < 6; ++i) curve.points.push_back(point(-0.5 + 0.2 * i, 0.3 * std::sin(1.0 * i), 0.1 * i));
  call.request.curves.push_back(curve);
  return call;
}

double percentile(std::vector<double> values, double fraction) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(fraction * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

void print(const char *what, const std::vector<double> &values) {
  std::printf("%-18s p50 %8.1f   p99 %8.1f us\n", what, percentile(values, 0.5), percentile(values, 0.99));
}

} // namespace

int main(int argc, char **argv) {
  ros::init(argc, argv, "curve_proximity_bench_service", ros::init_options::AnonymousName);
  ros::NodeHandle handle;
  const std::string name = argc > 1 ? argv[1] : "curve_proximity";
  const int calls = argc > 2 ? std::max(1, std::atoi(argv[2])) : 20000;
  ApplyScene scene = ring();
  if (!ros::service::waitForService(name + "/distance", 5000) || !ros::service::call(name + "/apply_scene", scene) ||
      !scene.response.success) {
    std::fprintf(stderr, "no answer from node '%s': %s\n", name.c_str(), scene.response.message.c_str());
    return 1;
  }

  PersistentClient<Distance> client(handle, name + "/distance");
  Distance call = question();
  std::vector<double> whole, core, added;
  for (int i = 0; i < calls; ++i) {
    const auto begin = std::chrono::steady_clock::now();
    if (!client.call(call, 1.0) || !call.response.success) {
      std::fprintf(stderr, "call %d failed: %s\n", i, call.response.message.c_str());
      return 1;
    }
    whole.push_back(std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - begin).count());
    core.push_back(call.response.results.front().microseconds);
    added.push_back(whole.back() - core.back());
  }
  std::printf("%d calls, %d objects, one curve of 6 points\n", calls, OBJECTS);
  print("call", whole);
  print("core", core);
  print("added by service", added);
  return 0;
}
