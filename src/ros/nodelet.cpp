/* SPDX-License-Identifier: BSD-3-Clause */
/** The server as a nodelet: curve_proximity/ProximityServer. */
#include <nodelet/nodelet.h>
#include <pluginlib/class_list_macros.hpp>

#include <memory>

#include "parameters.h"
#include "server.h"

namespace curve_proximity {

class ProximityServerNodelet : public nodelet::Nodelet {
 private:
  /** What this throws fails the load with its sentence and leaves the manager as it was. */
  void onInit() override {
    server_ = std::make_unique<ProximityServer>(getPrivateNodeHandle(), readParameters(getPrivateNodeHandle()));
  }

  std::unique_ptr<ProximityServer> server_;
};

} // namespace curve_proximity

PLUGINLIB_EXPORT_CLASS(curve_proximity::ProximityServerNodelet, nodelet::Nodelet)
