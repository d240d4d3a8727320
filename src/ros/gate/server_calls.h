/* SPDX-License-Identifier: BSD-3-Clause */
/** What the gate asks of the server: which scene there is now, and whether a motion is clear of it. */
#ifndef CURVE_PROXIMITY_ROS_SERVER_CALLS_H
#define CURVE_PROXIMITY_ROS_SERVER_CALLS_H

#include <curve_proximity/Proximity.h>
#include <curve_proximity/ProximityQuery.h>
#include <curve_proximity/Refusal.h>
#include <curve_proximity/SceneState.h>
#include <curve_proximity/Tolerance.h>
#include <ros/node_handle.h>

#include <cstdint>
#include <curve_proximity/client.hpp>
#include <functional>
#include <string>

#include "gate/proof_check.h"

namespace curve_proximity {

/** A refusal without a row. */
Refusal refusalBecause(const std::string &why, const SceneState &scene);

/** In the log. */
void logGateError(const std::string &why);

/** What all of a motion was clear of. */
struct SeenScene {
  SceneState state;       /**< of the server */
  std::uint64_t read = 0; /**< the version of what the gate reads itself; 0: nothing */
};

/** For one thread, but for end(). */
class ServerCalls {
 public:
  /** server: the namespace of its services. delta [m]. proofs: checks each answer; null: the server is believed. */
  ServerCalls(const ros::NodeHandle &handle, const std::string &server, double delta, const ProofCheck *proofs)
      : delta_(delta), proofs_(proofs), tolerance_(handle, server + "/tolerance") {}

  /** Ends a call that waits for the server, and all later ones: they fail. By any thread. */
  void end() {
    tolerance_.end();
  }

  /** Makes the query; may throw Error. */
  using Asked = std::function<const ProximityQuery &()>;

  /** True where all of it is clear; else `refusal` says what is not, or why there is no answer. `scene` becomes the one
   *  of the answer. */
  bool isClear(const Asked &query, SeenScene &scene, Refusal &refusal);

  /** The same where the scene is another one than `scene`, or `recent` is false; else all of it was clear of that. */
  bool isStillClear(const Asked &query, bool recent, SeenScene &scene, Refusal &refusal);

 private:
  std::uint64_t read() const {
    return proofs_ ? proofs_->version() : 0;
  }

  const double delta_;
  const ProofCheck *const proofs_;
  PersistentClient<Tolerance> tolerance_;
};

} // namespace curve_proximity
#endif
