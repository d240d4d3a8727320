/* SPDX-License-Identifier: BSD-3-Clause */
#include "crowds.h"

#include <curve_proximity/ApplyScene.h>
#include <curve_proximity/Distance.h>
#include <geometry_msgs/TransformStamped.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <tf2_ros/static_transform_broadcaster.h>

#include <cmath>
#include <curve_proximity/client.hpp>
#include <memory>

#include "graph.h"

namespace bench {
namespace {

using namespace curve_proximity;

constexpr const char *EMPTY = "/bench_empty";
constexpr int EMPTY_THREADS = 4;
constexpr int HEAVY_CLIENTS = 8, LOST_CLIENTS = 12;
constexpr int HEAVY_CURVES = 2000;

CollisionObject ball() {
  CollisionObject object;
  object.id = "ball";
  shape_msgs::SolidPrimitive sphere;
  sphere.type = shape_msgs::SolidPrimitive::SPHERE;
  sphere.dimensions.assign(1, 0.25);
  object.primitives.push_back(sphere);
  object.pose.orientation.w = 1.0;
  return object;
}

Curve line(int i, const std::string &frame) {
  Curve out;
  out.header.frame_id = frame;
  out.id = "curve" + std::to_string(i);
  out.basis = "bezier";
  out.points.resize(4);
  for (int j = 0; j < 4; ++j) {
    out.points[static_cast<std::size_t>(j)].x = -1.0 + 0.6 * j;
    out.points[static_cast<std::size_t>(j)].y = 0.3 * std::sin(i + 2.0 * j);
    out.points[static_cast<std::size_t>(j)].z = 1.0 + 0.2 * std::cos(i - j);
  }
  return out;
}

Distance question(int curves, const std::string &frame = "") {
  Distance out;
  for (int i = 0; i < curves; ++i) out.request.query.curves.push_back(line(i, frame));
  return out;
}

bool answerNothing(Distance::Request &request, Distance::Response &response) {
  Proximity row;
  row.kind = "curve";
  row.status = "ok";
  row.lod = "mesh";
  row.id = row.a = "curve100";
  row.b = "ball";
  response.success = true;
  response.frame_id = "world";
  response.results.assign(request.query.curves.size(), row);
  return true;
}

/** One connection. */
class Asker {
 public:
  Asker(const ros::NodeHandle &handle, const std::string &server) : client_(handle, server + "/distance") {}

  /** [us] of one call after the other, for so many seconds and at least one. may_fail: nobody looks at the answers. */
  std::vector<double> ask(Distance &call, double seconds, bool may_fail = false) {
    std::vector<double> times;
    const auto end = Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
    do {
      const auto begin = Clock::now();
      const bool came = client_.call(call, 20.0);
      if (!may_fail && !(came && call.response.success))
        throw std::runtime_error("a call failed: " + call.response.message);
      times.push_back(microseconds(Clock::now() - begin));
    } while (Clock::now() < end && ros::ok());
    return times;
  }

 private:
  PersistentClient<Distance> client_;
};

void append(std::vector<double> &to, const std::vector<double> &more) {
  to.insert(to.end(), more.begin(), more.end());
}

/** In turns, ours and the empty one. The rate is that of the mean: a call now and then that takes long counts. */
void measureMany(ros::NodeHandle &handle, const std::string &node, int curves, double seconds) {
  constexpr int TURNS = 10;
  Asker askers[] = {{handle, node}, {handle, EMPTY}};
  Distance call = question(curves);
  std::vector<double> times[2];
  for (Asker &asker : askers) asker.ask(call, 0.1);
  for (int i = 0; i < 2 * TURNS; ++i) append(times[i % 2], askers[i % 2].ask(call, seconds / TURNS));
  for (int i = 0; i < 2; ++i) {
    double sum = 0.0;
    for (const double time : times[i]) sum += time;
    const std::string method = i == 0 ? "curve_proximity" : "empty roscpp service";
    const std::string workload = std::to_string(curves) + (curves == 1 ? " curve a call" : " curves a call");
    printRow(workload.c_str(), method, "mean", sum / static_cast<double>(times[i].size()), percentile(times[i], 0.95));
    printRow(workload.c_str(), method, "median", percentile(times[i], 0.5), percentile(times[i], 0.95));
  }
}

/** A client with one curve a call, alone and while others are there. */
void measureBeside(ros::NodeHandle &handle, const std::string &server, const char *kind, const char *workload,
                   const std::string &who, double seconds) {
  Asker asker(handle, server);
  Distance call = question(1);
  asker.ask(call, 0.1);
  std::vector<double> alone = asker.ask(call, seconds), beside;
  {
    const Program crowd({PROGRAM, "--crowd", server, kind});
    std::this_thread::sleep_for(std::chrono::milliseconds(1500));
    beside = asker.ask(call, seconds);
  }
  for (const double quantile : {0.5, 0.99}) {
    const std::string name = quantile == 0.5 ? "p50" : "p99";
    printRow(workload, who + " alone", name, percentile(alone, quantile), percentile(alone, 0.95));
    printRow(workload, who, name, percentile(beside, quantile), percentile(beside, 0.95));
  }
}

} // namespace

int serveEmpty(int argc, char **argv) {
  ros::init(argc, argv, "bench_empty", ros::init_options::NoRosout);
  ros::NodeHandle handle("~");
  ros::CallbackQueue queue;
  handle.setCallbackQueue(&queue);
  const ros::ServiceServer server = handle.advertiseService("distance", answerNothing);
  ros::AsyncSpinner spinner(EMPTY_THREADS, &queue);
  spinner.start();
  ros::waitForShutdown();
  return 0;
}

int runCrowd(int argc, char **argv) {
  const std::string server = argv[2], kind = argv[3];
  ros::init(argc, argv, "bench_crowd", ros::init_options::NoRosout | ros::init_options::AnonymousName);
  ros::NodeHandle handle;
  const bool heavy = kind == "heavy";

  // A frame that has been heard of, so that it may come, and does not.
  tf2_ros::StaticTransformBroadcaster broadcaster;
  geometry_msgs::TransformStamped island;
  island.header.frame_id = "elsewhere";
  island.child_frame_id = "nowhere";
  island.transform.rotation.w = 1.0;
  broadcaster.sendTransform(island);
  std::vector<std::thread> clients;
  for (int i = 0; i < (heavy ? HEAVY_CLIENTS : LOST_CLIENTS); ++i) {
    clients.emplace_back([&] {
      Distance call = heavy ? question(HEAVY_CURVES) : question(1, "nowhere");
      Asker asker(handle, server);
      while (ros::ok()) asker.ask(call, 1.0, true);
    });
  }
  for (std::thread &client : clients) client.join();
  return 0;
}

void measureCrowds(ros::NodeHandle &handle, const std::string &node, bool quick, bool many_alone) {
  const double seconds = quick ? 2.0 : 10.0;
  ApplyScene scene;
  scene.request.clear = true;
  scene.request.objects.push_back(ball());
  if (!ros::service::call(node + "/apply_scene", scene) || !scene.response.success)
    throw std::runtime_error(node + ": " + scene.response.message);
  const Program empty({PROGRAM, "--empty"});
  waitFor(EMPTY, [] { return ros::service::exists(std::string(EMPTY) + "/distance", false); });
  for (const int curves : {1, 100, 1000}) measureMany(handle, node, curves, seconds);
  if (many_alone) return;
  const char *heavy = "one curve a call beside 8 clients with 2000 curves a call";
  measureBeside(handle, node, "heavy", heavy, "curve_proximity", seconds);
  measureBeside(handle, EMPTY, "heavy", heavy, "empty roscpp service", seconds);
  const char *lost = "one curve a call beside 12 clients that wait for a transform";
  measureBeside(handle, node, "lost", lost, "curve_proximity", seconds);
}

} // namespace bench
