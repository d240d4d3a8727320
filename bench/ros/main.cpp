/* SPDX-License-Identifier: BSD-3-Clause */
/** What ROS adds to the core's time: one curve of 6 points against 30 boxes, by a persistent service connection to a node, and by
 *  topic through the nodelet in this process, as inside a manager. Starts a master and a node of its own.
 *
 *  usage: curve_proximity_bench_ros [--quick] [--calls N]
 *  Prints rows of results.csv. The memory row's error is what the node's resident set grew by over that many calls [MB]. */
#include <curve_proximity/ApplyScene.h>
#include <curve_proximity/Distance.h>
#include <curve_proximity/ProximityResults.h>
#include <netinet/in.h>
#include <nodelet/loader.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <curve_proximity/client.hpp>
#include <fstream>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace {

using namespace curve_proximity;
using Clock = std::chrono::steady_clock;

constexpr int OBJECTS = 30;
constexpr const char *WORKLOAD = "one curve of 6 points, 30 boxes";

double microseconds(Clock::duration time) {
  return std::chrono::duration<double, std::micro>(time).count();
}

/* ---- processes ----------------------------------------------------------------------------------------------------- */

/** A program that ends with this object. */
class Program {
 public:
  explicit Program(std::vector<std::string> arguments) {
    std::vector<char *> argv;
    for (std::string &argument : arguments) argv.push_back(argument.data());
    argv.push_back(nullptr);
    pid_ = fork();
    if (pid_ != 0) return;
    if (!std::freopen("/dev/null", "w", stdout)) _exit(126);
    execvp(argv[0], argv.data());
    _exit(127);
  }
  ~Program() {
    if (pid_ <= 0) return;
    kill(pid_, SIGINT);
    waitpid(pid_, nullptr, 0);
  }
  Program(const Program &) = delete;
  Program &operator=(const Program &) = delete;

  double residentMb() const {
    std::ifstream status("/proc/" + std::to_string(pid_) + "/status");
    for (std::string line; std::getline(status, line);)
      if (line.rfind("VmRSS:", 0) == 0) return std::atof(line.c_str() + 6) / 1024.0;
    return 0.0;
  }

 private:
  pid_t pid_;
};

int freePort() {
  const int probe = socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  const bool found = bind(probe, reinterpret_cast<sockaddr *>(&address), size) == 0 &&
                     getsockname(probe, reinterpret_cast<sockaddr *>(&address), &size) == 0;
  close(probe);
  if (!found) throw std::runtime_error("no free port");
  return ntohs(address.sin_port);
}

template <class Condition>
void waitFor(const char *what, Condition condition) {
  const auto deadline = Clock::now() + std::chrono::seconds(30);
  while (!condition()) {
    if (Clock::now() > deadline) throw std::runtime_error(std::string(what) + " is not there after 30 s");
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
}

/* ---- the question -------------------------------------------------------------------------------------------------- */

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

/* ---- rows ---------------------------------------------------------------------------------------------------------- */

double percentile(std::vector<double> values, double fraction) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(fraction * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/** One row; `method` ours, or the whole of what ours is a part of. */
void print(const char *method, const std::string &parameter, double median, double p95, double error = 0.0) {
  std::printf("ros,\"%s\",%s,%s,%.3f,%.3f,0,0,%.3g,0,0\n", WORKLOAD, method, parameter.c_str(), median, p95, error);
  std::fflush(stdout);
}

void printAdded(const std::string &way, const std::vector<double> &whole, const std::vector<double> &added) {
  print("whole call", way, percentile(whole, 0.5), percentile(whole, 0.95));
  print("curve_proximity", way, percentile(added, 0.5), percentile(added, 0.95));
  print("curve_proximity", way + " p99", percentile(added, 0.99), percentile(added, 0.99));
}

/* ---- the measurements ---------------------------------------------------------------------------------------------- */

/** One call after the other over one connection. */
void measureService(ros::NodeHandle &handle, const std::string &server, int calls) {
  PersistentClient<Distance> client(handle, server + "/distance");
  Distance call;
  call.request.curves.push_back(curve());
  std::vector<double> whole, added;
  for (int i = 0; i < calls; ++i) {
    const auto begin = Clock::now();
    if (!client.call(call, 1.0) || !call.response.success)
      throw std::runtime_error("a call failed: " + call.response.message);
    whole.push_back(microseconds(Clock::now() - begin));
    added.push_back(whole.back() - call.response.results.front().microseconds);
  }
  printAdded("service", whole, added);
}

/** A message each millisecond, by pointer; from its publication to the arrival of its result. */
void measureNodelet(ros::NodeHandle &handle, const std::string &server, int messages) {
  std::mutex mutex;
  std::condition_variable came;
  Clock::time_point arrived;
  ProximityResultsConstPtr last;
  ros::CallbackQueue queue;
  ros::NodeHandle own(handle);
  own.setCallbackQueue(&queue);
  ros::Publisher publisher = own.advertise<Curve>(server + "/curve", 10);
  const ros::Subscriber subscriber =
      own.subscribe<ProximityResults>(server + "/proximity", 10, [&](const ProximityResultsConstPtr &results) {
        const auto now = Clock::now();
        const std::lock_guard<std::mutex> lock(mutex);
        arrived = now;
        last = results;
        came.notify_one();
      });
  ros::AsyncSpinner spinner(1, &queue);
  spinner.start();
  waitFor("the nodelet", [&] { return publisher.getNumSubscribers() > 0 && subscriber.getNumPublishers() > 0; });

  std::vector<double> whole, added;
  auto next = Clock::now();
  for (int i = 0; i < messages; ++i) {
    next += std::chrono::milliseconds(1);
    std::this_thread::sleep_until(next);
    const auto message = boost::make_shared<Curve>(curve());
    std::unique_lock<std::mutex> lock(mutex);
    last.reset();
    lock.unlock();
    const auto begin = Clock::now();
    publisher.publish(CurveConstPtr(message));
    lock.lock();
    if (!came.wait_for(lock, std::chrono::seconds(5), [&] { return last != nullptr; }))
      throw std::runtime_error("a message was not answered");
    if (!last->success) throw std::runtime_error("a message failed: " + last->message);
    whole.push_back(microseconds(arrived - begin));
    added.push_back(whole.back() - last->results.front().microseconds);
  }
  spinner.stop();
  printAdded("nodelet 1 kHz", whole, added);
}

/** The resident set of the node before and after many calls. */
void measureMemory(ros::NodeHandle &handle, const std::string &server, const Program &node, int calls) {
  PersistentClient<Distance> client(handle, server + "/distance");
  Distance call;
  call.request.curves.push_back(curve());
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

void measure(bool quick, int calls) {
  const std::string node = "/bench_node", nodelet = "/bench_nodelet";
  ros::NodeHandle handle;
  {
    const Program server({"rosrun", "curve_proximity", "curve_proximity_node", "__name:=bench_node"});
    build(node);
    measureService(handle, node, quick ? 5000 : 20000);
    measureMemory(handle, node, server, calls);
  }
  handle.setParam(nodelet + "/verb", "distance");
  nodelet::Loader loader;
  if (!loader.load(nodelet, "curve_proximity/ProximityServer", {}, {}))
    throw std::runtime_error("the nodelet does not load");
  std::thread asking([&] { build(nodelet); });
  asking.join();
  measureNodelet(handle, nodelet, quick ? 3000 : 10000);
  loader.clear();
}

} // namespace

int main(int argc, char **argv) {
  bool quick = false;
  int calls = 0;
  for (int i = 1; i < argc; ++i) {
    quick = quick || std::strcmp(argv[i], "--quick") == 0;
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
    measure(quick, calls);
    ros::shutdown();
  } catch (const std::exception &error) {
    std::fprintf(stderr, "ros: %s\n", error.what());
    return 1;
  }
  return 0;
}
