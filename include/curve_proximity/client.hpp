/* SPDX-License-Identifier: BSD-3-Clause */
/** A caller of the server's services that outlives the server's restarts. */
#ifndef CURVE_PROXIMITY_CLIENT_HPP
#define CURVE_PROXIMITY_CLIENT_HPP

#include <ros/node_handle.h>
#include <ros/service_client.h>

#include <algorithm>
#include <chrono>
#include <string>
#include <thread>

namespace curve_proximity {

/** Calls one service over a persistent connection: about a tenth of the cost of a connection a call. Such a handle
 *  stays failed once its server has gone, and a loop that just tries again spins through millions of failures a second;
 *  this one looks the service up again, with pauses that double from 10 ms to 500 ms. For one thread. */
template <class Service>
class PersistentClient {
 public:
  /** name: of the service, as for ros::NodeHandle::serviceClient(). */
  PersistentClient(const ros::NodeHandle &handle, const std::string &name) : handle_(handle), name_(name) {}

  /** Calls until the server has answered or the patience [s], counted on the steady clock, is over: then false. A call
   *  whose answer was lost is made again, so it may reach the server twice: queries and ~apply_scene can bear that. */
  bool call(Service &service, double patience) {
    const auto deadline =
        std::chrono::steady_clock::now() +
        std::chrono::duration_cast<std::chrono::steady_clock::duration>(std::chrono::duration<double>(patience));
    std::chrono::milliseconds pause{10};
    while (true) {
      if (!client_.isValid()) {
        ++lookups_;
        client_ = handle_.template serviceClient<Service>(name_, true);
      }
      if (client_.isValid() && client_.call(service)) return true;
      client_.shutdown();
      if (!ros::ok() || std::chrono::steady_clock::now() + pause >= deadline) return false;
      std::this_thread::sleep_for(pause);
      pause = std::min(2 * pause, std::chrono::milliseconds{500});
    }
  }

  /** How often the service has been looked up. */
  unsigned lookups() const {
    return lookups_;
  }

 private:
  ros::NodeHandle handle_;
  const std::string name_;
  ros::ServiceClient client_;
  unsigned lookups_ = 0;
};

} // namespace curve_proximity
#endif
