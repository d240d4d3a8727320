/* SPDX-License-Identifier: BSD-3-Clause */
/** A service client that reconnects after the server restarts. */
#ifndef CURVE_PROXIMITY_CLIENT_HPP
#define CURVE_PROXIMITY_CLIENT_HPP

#include <ros/node_handle.h>
#include <ros/service_client.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <mutex>
#include <string>
#include <thread>

namespace curve_proximity {

/** Calls one service over a persistent connection.
 *
 *  A persistent connection costs about a tenth of a new connection per call. ROS does not reconnect a persistent
 *  connection. This class looks the service up again after a failure, with pauses that double from 10 ms to 500 ms.
 *  For one thread, but for end(). */
template <class Service>
class PersistentClient {
 public:
  /** name: the service's name, as for ros::NodeHandle::serviceClient(). */
  PersistentClient(const ros::NodeHandle &handle, const std::string &name) : handle_(handle), name_(name) {}

  /** Calls the service until it answers. Returns false after `patience` seconds of the steady clock.
   *
   *  A call with a lost answer is repeated, so a request may reach the server twice. Queries and ~apply_scene give the
   *  same result then. */
  bool call(Service &service, double patience) {
    const auto deadline =
        std::chrono::steady_clock::now() +
        std::chrono::duration_cast<std::chrono::steady_clock::duration>(std::chrono::duration<double>(patience));
    std::chrono::milliseconds pause{10};
    while (true) {
      ros::ServiceClient client = connected();
      if (client.isValid() && client.call(service)) return true;
      drop(client);
      if (!ros::ok() || ended_ || std::chrono::steady_clock::now() + pause >= deadline) return false;
      std::this_thread::sleep_for(pause);
      pause = std::min(2 * pause, std::chrono::milliseconds{500});
    }
  }

  /** Ends a call that waits for its answer, which returns false, and all later ones. By any thread. */
  void end() {
    const std::lock_guard<std::mutex> lock(mutex_);
    ended_ = true;
    client_.shutdown();
  }

  /** The number of lookups so far. */
  unsigned lookups() const {
    return lookups_;
  }

 private:
  ros::ServiceClient connected() {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (ended_) return {};
    if (!client_.isValid()) {
      ++lookups_;
      client_ = handle_.template serviceClient<Service>(name_, true);
    }
    return client_;
  }

  /* ROS frees a connection that two threads drop at once while one of them is still at it: end() may be. */
  void drop(ros::ServiceClient &client) {
    const std::lock_guard<std::mutex> lock(mutex_);
    client.shutdown();
  }

  ros::NodeHandle handle_;
  const std::string name_;
  std::mutex mutex_; /* of the client, and not held during a call */
  std::atomic<bool> ended_{false};
  ros::ServiceClient client_;
  unsigned lookups_ = 0;
};

} // namespace curve_proximity
#endif
