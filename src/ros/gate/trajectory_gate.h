/* SPDX-License-Identifier: BSD-3-Clause */
/** The stage between the server and a controller: nothing passes that is not certified to be clear. */
#ifndef CURVE_PROXIMITY_ROS_TRAJECTORY_GATE_H
#define CURVE_PROXIMITY_ROS_TRAJECTORY_GATE_H

#include <curve_proximity/ProximityResults.h>
#include <ros/node_handle.h>

#include <cstdint>
#include <deque>
#include <functional>
#include <list>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gate/action_gate.h"
#include "gate/motion_watches.h"
#include "gate/server_calls.h"
#include "parameters/parameters.h"
#include "transport/threaded_queue.h"

namespace curve_proximity {

/** Do these results prove that what they are about stays farther than delta from everything? All rows answered, at
 * least one, and each with a certified lower bound above delta, or the verdict that says so. */
bool isClear(const ProximityResults &results, double delta);

/** Waits for the answer (~proximity) to each message on ~curve, ~trajectory, ~multi_dof_trajectory and ~path, in
 * whichever order they come, and hands on those that are clear, by pointer: ~clear_curve, ~clear_trajectory,
 * ~clear_multi_dof_trajectory, ~clear_path. ~queue_size messages and as many answers wait for each other; what is older
 * never passes. Before it hands a message on, it looks at the scene of ~server: where that is another one than the
 * answer's, it asks again. What does not pass is told on ~refused. With ~watch it looks on while a trajectory runs
 * (MotionWatches, by ~joint_states); where what is left is not clear, a trajectory without points follows on
 * ~clear_trajectory, at which joint_trajectory_controller stops. A trajectory without points is a stop, and passes at
 * once. With ~controller it is also a FollowJointTrajectory action: see ActionGate. */
class TrajectoryGate {
 public:
  /** handle: private. proofs: checks the server's certificates before a message passes, and while it runs; null: the
   *  server is believed. */
  TrajectoryGate(const ros::NodeHandle &handle, const GateParameters &parameters, const ProofCheck *proofs);
  ~TrajectoryGate();

  TrajectoryGate(const TrajectoryGate &) = delete;
  TrajectoryGate &operator=(const TrajectoryGate &) = delete;

 private:
  struct Waiting {
    std::uint64_t fingerprint;
    std::function<void()> pass;
    std::function<void(ProximityQuery &)> ask; /* makes a query of the message */
  };
  struct Answered {
    std::uint64_t fingerprint;
    ProximityResultsConstPtr results;
  };
  template <class Message>
  void connect(const std::string &topic);
  void receive(Waiting message);
  void answer(const ProximityResultsConstPtr &results);
  void decide(const Waiting &message, const ProximityResults &results);
  void watch(ProximityQuery query, const ProximityResults &results, SeenScene scene);
  void forget(const std::vector<std::string> &joints);
  void refuse(Refusal refusal, const ProximityResults &results);

  const GateParameters parameters_;
  std::deque<Waiting> waiting_; /* touched by callbacks of the queue alone */
  std::deque<Answered> answered_;
  std::list<std::shared_ptr<MotionWatch>> running_;
  ThreadedQueue queue_;
  ros::NodeHandle handle_;
  ros::Publisher refused_, clear_trajectory_;
  std::unique_ptr<ServerCalls> calls_;     /* null: the scene is not looked at again */
  std::unique_ptr<MotionWatches> watches_; /* null: nothing is watched */
  std::vector<ros::Subscriber> subscribers_;
  std::unique_ptr<ActionGate> actions_;
};

} // namespace curve_proximity
#endif
