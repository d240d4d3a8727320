/* SPDX-License-Identifier: BSD-3-Clause */
/** Calls of a server in the same process, such as a nodelet in the same manager. */
#ifndef CURVE_PROXIMITY_LOCAL_CALL_HPP
#define CURVE_PROXIMITY_LOCAL_CALL_HPP

#include <ros/service_traits.h>

#include <string>

namespace curve_proximity {
namespace local {

/** For callInProcess(): md5sum names the type of request and response. */
bool call(const std::string &name, const std::string &md5sum, const void *request, void *response);

} // namespace local

/** Calls a service of a curve_proximity/ProximityServer in this process by a plain function call. Nothing is
 *  serialized, no socket is used, and the calling thread does the work. The response is that of the ROS service.
 *
 *  name: the service's resolved name, e.g. "/curve_proximity/distance". Returns false if no server in this process has
 *  a service of this name and type; the response is unchanged then. Any number of threads. */
template <class Service>
bool callInProcess(const std::string &name, Service &service) {
  return local::call(name, ros::service_traits::md5sum<Service>(), &service.request, &service.response);
}

} // namespace curve_proximity
#endif
