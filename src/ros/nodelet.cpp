/* SPDX-License-Identifier: BSD-3-Clause */
/** The nodelets curve_proximity/ProximityServer and curve_proximity/TrajectoryGate. */
#include <nodelet/nodelet.h>
#include <pluginlib/class_list_macros.hpp>

#include <memory>

#include "gate/proof_check.h"
#include "gate/trajectory_gate.h"
#include "parameters/parameters.h"
#include "server.h"

namespace curve_proximity {

class ProximityServerNodelet : public nodelet::Nodelet {
 private:
  /** What this throws fails the load with its message and leaves the manager as it was. */
  void onInit() override {
    server_ = std::make_unique<ProximityServer>(getPrivateNodeHandle(), readParameters(getPrivateNodeHandle()));
  }

  std::unique_ptr<ProximityServer> server_;
};

class TrajectoryGateNodelet : public nodelet::Nodelet {
 private:
  void onInit() override {
    const ros::NodeHandle &handle = getPrivateNodeHandle();
    const GateParameters parameters = readGateParameters(handle);
    if (parameters.verify) {
      const ros::NodeHandle own(handle, READING_OF_GATE);
      reading_ = std::make_unique<ProximityServer>(own, readParameters(own));
      proofs_ = std::make_unique<ProofCheck>(
          ProofCheck{[this](const ProximityQuery &query) { return reading_->problems(query); },
                     [this] { return reading_->version(); }});
    }
    gate_ = std::make_unique<TrajectoryGate>(handle, parameters, proofs_.get());
  }

  std::unique_ptr<ProximityServer> reading_; /* what the gate reads itself; null: it believes the server */
  std::unique_ptr<ProofCheck> proofs_;
  std::unique_ptr<TrajectoryGate> gate_;
};

} // namespace curve_proximity

PLUGINLIB_EXPORT_CLASS(curve_proximity::ProximityServerNodelet, nodelet::Nodelet)
PLUGINLIB_EXPORT_CLASS(curve_proximity::TrajectoryGateNodelet, nodelet::Nodelet)
