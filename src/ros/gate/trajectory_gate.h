/* SPDX-License-Identifier: BSD-3-Clause */
/** The stage between the server and a controller: nothing passes that is not certified to be clear. */
#ifndef CURVE_PROXIMITY_ROS_TRAJECTORY_GATE_H
#define CURVE_PROXIMITY_ROS_TRAJECTORY_GATE_H

#include <ros/node_handle.h>

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "gate/action_gate.h"
#include "gate/motion_watches.h"
#include "gate/server_calls.h"
#include "parameters/parameters.h"
#include "transport/job_queue.h"

namespace curve_proximity {

/** Asks ~server about each message on ~curve, ~trajectory, ~multi_dof_trajectory and ~path, one after the other, and
 * hands on those that are clear, by pointer: ~clear_curve, ~clear_trajectory, ~clear_multi_dof_trajectory, ~clear_path.
 * ~queue_size messages wait; what is older never passes. What does not pass is told on ~refused. With ~watch it looks
 * on while a trajectory runs (MotionWatches, by ~joint_states); where what is left is not clear, a trajectory without
 * points follows on ~clear_trajectory, at which joint_trajectory_controller stops. A trajectory without points is a
 * stop: it passes at once, and no trajectory passes that came before it. With ~controller it is also a
 * FollowJointTrajectory action: see ActionGate. */
class TrajectoryGate {
 public:
  /** handle: private. proofs: as of ServerCalls. */
  TrajectoryGate(const ros::NodeHandle &handle, const GateParameters &parameters, const ProofCheck *proofs);
  ~TrajectoryGate();

  TrajectoryGate(const TrajectoryGate &) = delete;
  TrajectoryGate &operator=(const TrajectoryGate &) = delete;

 private:
  /* What a refusal is about. id: of a curve. */
  struct Motion {
    std::string topic, id;
    std::uint64_t fingerprint;
  };
  template <class Message>
  void connect(const std::string &topic, std::vector<Message> ProximityQuery::*motions, const ros::Publisher &out);
  template <class Message>
  void judge(const std::string &topic, std::vector<Message> ProximityQuery::*motions,
             const boost::shared_ptr<const Message> &message, std::uint64_t stops, const ros::Publisher &out);
  void stop(const trajectory_msgs::JointTrajectoryConstPtr &message);
  void refuse(Refusal refusal, const Motion &motion);

  const GateParameters parameters_;
  JobQueue queue_;
  ros::NodeHandle handle_;
  const ros::Publisher refused_, clear_trajectory_;
  ServerCalls calls_;
  std::unique_ptr<MotionWatches> watches_; /* null: nothing is watched */
  std::mutex passing_;                     /* one message passes at a time */
  std::atomic<std::uint64_t> stops_{0};    /* that have passed: no trajectory passes that came before one of them */
  std::vector<ros::Subscriber> subscribers_;
  std::unique_ptr<ActionGate> actions_;
};

} // namespace curve_proximity
#endif
