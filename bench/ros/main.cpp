/* SPDX-License-Identifier: BSD-3-Clause */
/** What ROS adds to the core's time: one curve of 6 points against 30 boxes, by a persistent service connection to a
 * node, and by topic through the nodelet in this process, as inside a manager. Beside both a server and a relay that do
 * nothing but take the same message, keep a processor busy for as long as the core does, and answer: what they cost is
 * roscpp's. The nodelet is also called as a function. Then many curves a call and many clients, beside an empty service: see crowds.h. Starts a master and the
 * nodes.
 *
 *  usage: curve_proximity_bench_ros [--quick] [--calls N] [--many]
 *  --many: many curves a call alone, for work on their rate.
 *  Prints rows of results.csv. The memory row's error is what the node's resident set grew by over that many calls
 * [MB]. */
#include <curve_proximity/ApplyScene.h>
#include <curve_proximity/Distance.h>
#include <curve_proximity/ProximityResults.h>
#include <nodelet/loader.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <curve_proximity/client.hpp>
#include <curve_proximity/local_call.hpp>
#include <fstream>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "crowds.h"
#include "graph.h"

namespace {

using namespace curve_proximity;
using namespace bench;

constexpr int OBJECTS = 30;
constexpr const char *WORKLOAD = "one curve of 6 points, 30 boxes";

/* ---- the query ---- */

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

Curve curve() {
  Curve out;
  out.id = "curve";
  out.basis = "bezier";
  for (int i = 0; i < 6; ++i) out.points.push_back(point(-0.5 + 0.2 * i, 0.3 * std::sin(1.0 * i), 0.1 * i));
  return out;
}

void build(const std::string &server) {
  waitFor(server.c_str(), [&] { return ros::service::exists(server + "/apply_scene", false); });
  ApplyScene scene = ring();
  if (!ros::service::call(server + "/apply_scene", scene) || !scene.response.success)
    throw std::runtime_error(server + ": " + scene.response.message);
}

/* ---- what roscpp costs by itself ---- */

constexpr double WORK_US = 20.0; /* about what the core takes for the query */

/** An answer of the usual size after the usual time. */
Proximity plainAnswer() {
  Proximity row;
  const auto begin = Clock::now();
  do {
    row.microseconds = microseconds(Clock::now() - begin);
  } while (row.microseconds < WORK_US);
  row.id = row.a = "curve";
  row.kind = "curve";
  row.b = "box10";
  row.status = "ok";
  row.lod = "hull";
  return row;
}

bool answerPlainly(Distance::Request &, Distance::Response &response) {
  response.success = true;
  response.frame_id = "world";
  response.results.push_back(plainAnswer());
  return true;
}

/** The plain server, as a process: on a queue and a thread of its own, like ours. */
int servePlainly(int argc, char **argv) {
  ros::init(argc, argv, "bench_plain", ros::init_options::NoRosout);
  ros::NodeHandle handle("~");
  ros::CallbackQueue queue;
  handle.setCallbackQueue(&queue);
  const ros::ServiceServer server = handle.advertiseService("distance", answerPlainly);
  ros::AsyncSpinner spinner(1, &queue);
  spinner.start();
  ros::waitForShutdown();
  return 0;
}

/** The plain relay, in this process. */
class PlainRelay {
 public:
  explicit PlainRelay(const std::string &name) : handle_(name), spinner_(1, &queue_) {
    handle_.setCallbackQueue(&queue_);
    publisher_ = handle_.advertise<ProximityResults>("proximity", 10);
    subscriber_ = handle_.subscribe<Curve>("curve", 10, [this](const CurveConstPtr &) {
      const auto results = boost::make_shared<ProximityResults>();
      results->success = true;
      results->results.push_back(plainAnswer());
      publisher_.publish(ProximityResultsConstPtr(results));
    });
    spinner_.start();
  }

 private:
  ros::CallbackQueue queue_;
  ros::NodeHandle handle_;
  ros::Publisher publisher_;
  ros::Subscriber subscriber_;
  ros::AsyncSpinner spinner_;
};

/* ---- rows ---- */

void print(const char *method, const std::string &parameter, double median, double p95, double error = 0.0) {
  printRow(WORKLOAD, method, parameter, median, p95, error);
}

/** The times of one way to ask. */
struct Times {
  std::vector<double> whole, added;

  void add(Clock::duration took, const Proximity &row) {
    whole.push_back(microseconds(took));
    added.push_back(whole.back() - row.microseconds);
  }
};

void printAdded(const std::string &way, const Times &ours, const Times &plain) {
  const auto row = [](const char *method, const std::string &parameter, const std::vector<double> &times) {
    print(method, parameter, percentile(times, 0.5), percentile(times, 0.95));
  };
  row("whole call", way, ours.whole);
  row("curve_proximity", way, ours.added);
  row("plain roscpp", way, plain.added);
  for (const auto &[method, times] : {std::make_pair("curve_proximity", &ours), std::make_pair("plain roscpp", &plain)})
    print(method, way + " p99", percentile(times->added, 0.99), percentile(times->added, 0.99));
  // each call beside its neighbour, in blocks: what the machine does meanwhile is in both
  constexpr std::size_t BLOCK = 100;
  std::vector<double> blocks;
  for (std::size_t begin = 0; begin < ours.added.size(); begin += BLOCK) {
    std::vector<double> more;
    for (std::size_t i = begin; i < std::min(begin + BLOCK, ours.added.size()); ++i)
      more.push_back(ours.added[i] - plain.added[i]);
    blocks.push_back(percentile(more, 0.5));
  }
  print("curve_proximity", way + " more than plain roscpp", percentile(blocks, 0.5), percentile(blocks, 0.95));
}

/* ---- the measurements ---- */

/** One call after the other over one connection each: to ours, the plain one, the plain one, ours, and again. So neither is
 * always the second of a pair. */
void measureService(ros::NodeHandle &handle, const std::string &server, const std::string &plain, int calls) {
  PersistentClient<Distance> clients[] = {{handle, server + "/distance"}, {handle, plain + "/distance"}};
  Times times[2];
  Distance call;
  call.request.query.curves.push_back(curve());
  for (int i = 0; i < 2 * calls; ++i) {
    const int which = (i + 1) / 2 % 2;
    const auto begin = Clock::now();
    if (!clients[which].call(call, 10.0) || !call.response.success)
      throw std::runtime_error("a call failed: " + call.response.message);
    times[which].add(Clock::now() - begin, call.response.results.front());
  }
  printAdded("service", times[0], times[1]);
}

/** Publishes curves to a namespace, and waits for each result. */
class Asker {
 public:
  Asker(const ros::NodeHandle &handle, const std::string &server) : own_(handle), spinner_(1, &queue_) {
    own_.setCallbackQueue(&queue_);
    publisher_ = own_.advertise<Curve>(server + "/curve", 10);
    subscriber_ = own_.subscribe<ProximityResults>(server + "/proximity", 10,
                                                   [this](const ProximityResultsConstPtr &results) { take(results); });
    spinner_.start();
    waitFor(server.c_str(), [&] { return publisher_.getNumSubscribers() > 0 && subscriber_.getNumPublishers() > 0; });
  }
  ~Asker() {
    subscriber_.shutdown();
    spinner_.stop();
  }

  void ask(Times &times) {
    const CurveConstPtr message = boost::make_shared<Curve>(curve());
    std::unique_lock<std::mutex> lock(mutex_);
    last_.reset();
    lock.unlock();
    const auto begin = Clock::now();
    publisher_.publish(message);
    lock.lock();
    if (!came_.wait_for(lock, std::chrono::seconds(5), [&] { return last_ != nullptr; }))
      throw std::runtime_error("a message was not answered");
    if (!last_->success) throw std::runtime_error("a message failed: " + last_->message);
    times.add(arrived_ - begin, last_->results.front());
  }

 private:
  void take(const ProximityResultsConstPtr &results) {
    const auto now = Clock::now();
    const std::lock_guard<std::mutex> lock(mutex_);
    arrived_ = now;
    last_ = results;
    came_.notify_one();
  }

  std::mutex mutex_;
  std::condition_variable came_;
  Clock::time_point arrived_;
  ProximityResultsConstPtr last_;
  ros::CallbackQueue queue_;
  ros::NodeHandle own_;
  ros::Publisher publisher_;
  ros::Subscriber subscriber_;
  ros::AsyncSpinner spinner_;
};

/** A message each millisecond, by pointer, in turn to ours and to the plain relay; from its publication to the arrival
 * of its result. */
void measureNodelet(ros::NodeHandle &handle, const std::string &server, int messages) {
  const std::string relay = "/bench_relay";
  const PlainRelay plain(relay);
  Asker askers[] = {{handle, server}, {handle, relay}};
  Times times[2];
  auto next = Clock::now();
  for (int i = 0; i < 2 * messages; ++i) {
    next += std::chrono::milliseconds(1);
    std::this_thread::sleep_until(next);
    askers[i % 2].ask(times[i % 2]);
  }
  printAdded("nodelet 1 kHz", times[0], times[1]);
}

/** The nodelet called as a function. */
void measureLocalCalls(const std::string &server, int calls) {
  Times times;
  Distance call;
  call.request.query.curves.push_back(curve());
  for (int i = 0; i < calls; ++i) {
    const auto begin = Clock::now();
    if (!callInProcess(server + "/distance", call) || !call.response.success)
      throw std::runtime_error("a call in this process failed: " + call.response.message);
    times.add(Clock::now() - begin, call.response.results.front());
  }
  print("curve_proximity", "call in this process", percentile(times.added, 0.5), percentile(times.added, 0.95));
}

/** The resident set of the node before and after many calls. */
void measureMemory(ros::NodeHandle &handle, const std::string &server, const Program &node, int calls) {
  PersistentClient<Distance> client(handle, server + "/distance");
  Distance call;
  call.request.query.curves.push_back(curve());
  const auto repeat = [&](int n) {
    const auto begin = Clock::now();
    for (int i = 0; i < n; ++i)
      if (!client.call(call, 1.0)) throw std::runtime_error("a call failed");
    return microseconds(Clock::now() - begin) / n;
  };
  repeat(2000);
  const double before = node.residentMb();
  const double each = repeat(calls);
  print("curve_proximity", "memory over " + std::to_string(calls) + " calls", each, each, node.residentMb() - before);
}

void measure(bool quick, int calls, bool many) {
  const std::string node = "/bench_node", nodelet = "/bench_nodelet";
  ros::NodeHandle handle;
  {
    const Program server({"rosrun", "curve_proximity", "curve_proximity_node", "__name:=bench_node"});
    build(node);
    if (many) return measureCrowds(handle, node, quick, true);
    {
      const Program plain({PROGRAM, "--plain"});
      waitFor("the plain server", [] { return ros::service::exists("/bench_plain/distance", false); });
      measureService(handle, node, "/bench_plain", quick ? 5000 : 20000);
    }
    measureMemory(handle, node, server, calls);
    measureCrowds(handle, node, quick, false);
  }
  handle.setParam(nodelet + "/query_type", "distance");
  nodelet::Loader loader;
  if (!loader.load(nodelet, "curve_proximity/ProximityServer", {}, {}))
    throw std::runtime_error("the nodelet does not load");
  std::thread asking([&] { build(nodelet); });
  asking.join();
  measureLocalCalls(nodelet, quick ? 5000 : 20000);
  measureNodelet(handle, nodelet, quick ? 3000 : 10000);
  loader.clear();
}

} // namespace

int main(int argc, char **argv) {
  if (argc > 1 && std::strcmp(argv[1], "--plain") == 0) return servePlainly(argc, argv);
  if (argc > 1 && std::strcmp(argv[1], "--empty") == 0) return serveEmpty(argc, argv);
  if (argc > 3 && std::strcmp(argv[1], "--crowd") == 0) return runCrowd(argc, argv);
  bool quick = false, many = false;
  int calls = 0;
  for (int i = 1; i < argc; ++i) {
    quick = quick || std::strcmp(argv[i], "--quick") == 0;
    many = many || std::strcmp(argv[i], "--many") == 0;
    if (std::strcmp(argv[i], "--calls") == 0 && i + 1 < argc) calls = std::atoi(argv[++i]);
  }
  if (calls <= 0) calls = quick ? 20000 : 1000000;
  try {
    const std::string port = std::to_string(freePort());
    setenv("ROS_MASTER_URI", ("http://localhost:" + port).c_str(), 1);
    setenv("ROS_HOSTNAME", "localhost", 1);
    const Program master({"rosmaster", "--core", "-p", port});
    ros::init(argc, argv, "bench_ros", ros::init_options::NoRosout);
    if (ros::console::set_logger_level(ROSCONSOLE_ROOT_LOGGER_NAME, ros::console::levels::Warn))
      ros::console::notifyLoggerLevelsChanged(); // standard output belongs to the rows
    waitFor("the master", [] { return ros::master::check(); });
    measure(quick, calls, many);
    ros::shutdown();
  } catch (const std::exception &error) {
    std::fprintf(stderr, "ros: %s\n", error.what());
    return 1;
  }
  return 0;
}
