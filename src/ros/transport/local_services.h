/* SPDX-License-Identifier: BSD-3-Clause */
/** The services of a server for callers in the same process: local_call.hpp. */
#ifndef CURVE_PROXIMITY_ROS_LOCAL_SERVICES_H
#define CURVE_PROXIMITY_ROS_LOCAL_SERVICES_H

#include <ros/serialization.h>
#include <ros/service_traits.h>

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "transport/service.h"

namespace curve_proximity {

struct LocalService;

/** Those of one server. A later server of the same name takes the place of the one before. */
class LocalServices {
 public:
  LocalServices() = default;
  ~LocalServices() {
    end();
  }
  LocalServices(const LocalServices &) = delete;
  LocalServices &operator=(const LocalServices &) = delete;

  /** handler: as that of the service of this resolved name. */
  template <class Service>
  void add(const std::string &name, typename ServiceHelper<Service>::Handler handler) {
    using Request = typename Service::Request;
    using Response = typename Service::Response;
    add(name, ros::service_traits::md5sum<Service>(), [handler](const void *request, void *response) {
      const auto &asked = *static_cast<const Request *>(request);
      Call call;
      call.client = "this process";
      call.in_process = true;
      call.bytes = ros::serialization::serializationLength(asked);
      Response answer;
      handler(
          call, [&](Request &read) { read = asked; }, answer);
      *static_cast<Response *>(response) = std::move(answer);
    });
  }

  /** No call runs when it has ended, nor will one begin. */
  void end();

 private:
  using Work = std::function<void(const void *request, void *response)>;
  void add(const std::string &name, const std::string &md5sum, Work work);

  std::vector<std::pair<std::string, std::shared_ptr<LocalService>>> services_; /* by name */
};

} // namespace curve_proximity
#endif
