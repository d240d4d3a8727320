/* SPDX-License-Identifier: BSD-3-Clause */
/** FollowJointTrajectory in and out: goals that are clear go to the controller, and are watched while they run. */
#ifndef CURVE_PROXIMITY_ROS_ACTION_GATE_H
#define CURVE_PROXIMITY_ROS_ACTION_GATE_H

#include <actionlib/client/action_client.h>
#include <actionlib/server/action_server.h>
#include <curve_proximity/Refusal.h>
#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/spinner.h>
#include <ros/wall_timer.h>

#include <list>
#include <memory>
#include <string>

#include "gate/motion_watch.h"
#include "gate/server_calls.h"
#include "moveit/follow_joint_trajectory.h"
#include "parameters/parameters.h"

namespace curve_proximity {

/** A goal of ~follow_joint_trajectory is asked about from where the robot is by ~joint_states of the server. It is
 * rejected, or handed to the action ~controller. While it runs it is watched (MotionWatch); the controller is told to
 * cancel where what is left is not clear, or the server does not answer. One thread. */
class ActionGate {
 public:
  /** handle: private. refused: where refusals go. */
  ActionGate(const ros::NodeHandle &handle, const GateParameters &parameters, ros::Publisher refused);
  ~ActionGate();

  ActionGate(const ActionGate &) = delete;
  ActionGate &operator=(const ActionGate &) = delete;

 private:
  using Server = actionlib::ActionServer<control::FollowJointTrajectoryAction>;
  using Client = actionlib::ActionClient<control::FollowJointTrajectoryAction>;
  struct Running {
    Server::GoalHandle in;
    Client::GoalHandle out;
    MotionWatch watch;
    std::string stopped; /* why the gate has cancelled it; empty: it has not */
  };

  void begin(Server::GoalHandle goal);
  void cancel(Server::GoalHandle goal);
  void end(Client::GoalHandle goal);
  void watch();
  void check(Running &running);
  ProximityQuery queryOf(const trajectory_msgs::JointTrajectory &trajectory) const;
  void tell(Refusal refusal, const std::string &id, bool cancelled);

  const GateParameters parameters_;
  ros::CallbackQueue queue_;
  ros::NodeHandle handle_;
  ros::Publisher refused_;
  ServerCalls calls_;
  std::list<Running> running_;
  std::unique_ptr<Client> client_;
  std::unique_ptr<Server> server_;
  ros::WallTimer timer_;
  ros::AsyncSpinner spinner_;
};

} // namespace curve_proximity
#endif
