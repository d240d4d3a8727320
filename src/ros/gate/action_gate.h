/* SPDX-License-Identifier: BSD-3-Clause */
/** FollowJointTrajectory in and out: goals that are clear go to the controller, and are watched while they run. */
#ifndef CURVE_PROXIMITY_ROS_ACTION_GATE_H
#define CURVE_PROXIMITY_ROS_ACTION_GATE_H

#include <actionlib/client/action_client.h>
#include <actionlib/server/action_server.h>
#include <curve_proximity/Refusal.h>
#include <foreign/control_msgs/FollowJointTrajectoryAction.h>
#include <ros/node_handle.h>
#include <ros/wall_timer.h>

#include <list>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "gate/motion_watches.h"
#include "gate/server_calls.h"
#include "parameters/parameters.h"
#include "transport/threaded_queue.h"

namespace curve_proximity {

/** A goal of ~follow_joint_trajectory is asked about from where the robot is by ~joint_states. It is rejected, or
 * handed to the action ~controller. While it runs it is watched (MotionWatches) by the controller's feedback and
 * ~joint_states; the controller is told to cancel where what is left is not clear, where the robot does not tell where
 * it is, or the server does not answer. A goal without points is a stop, and passes. Questions about new goals,
 * cancelling and feedback each have a thread. */
class ActionGate {
 public:
  /** handle: private. refused: where refusals go. proofs: as of ServerCalls. */
  ActionGate(const ros::NodeHandle &handle, const GateParameters &parameters, ros::Publisher refused,
             const ProofCheck *proofs);
  ~ActionGate();

  ActionGate(const ActionGate &) = delete;
  ActionGate &operator=(const ActionGate &) = delete;

 private:
  using Server = actionlib::ActionServer<control_msgs::FollowJointTrajectoryAction>;
  using Client = actionlib::ActionClient<control_msgs::FollowJointTrajectoryAction>;
  struct Running {
    Server::GoalHandle in;
    Client::GoalHandle out;
    std::shared_ptr<MotionWatch> watch; /* null: a stop */
    std::string stopped;                /* why the gate has cancelled it; empty: it has not */
    bool ended = false;
  };
  using RunningPointer = std::shared_ptr<Running>;

  void begin(Server::GoalHandle goal);
  void send(const RunningPointer &running);
  void cancel(const Server::GoalHandle &goal);
  void stop(const RunningPointer &running, const std::string &why);
  void end(const RunningPointer &running, const Client::GoalHandle &done);
  bool forget(const RunningPointer &running);
  void findLost();
  std::vector<RunningPointer> all();
  void tell(Refusal refusal, const std::string &id, bool cancelled);
  std::string lostController() const;

  const GateParameters parameters_;
  ThreadedQueue queue_;
  ros::NodeHandle handle_;
  ros::Publisher refused_;
  ServerCalls calls_; /* of new goals */
  /* Of the list and its entries; no action is called while it is held: they have locks of their own. */
  std::mutex mutex_;
  std::list<RunningPointer> running_;
  std::unique_ptr<MotionWatches> watches_;
  std::unique_ptr<Client> client_;
  std::unique_ptr<Server> server_;
  ros::WallTimer timer_;
};

} // namespace curve_proximity
#endif
