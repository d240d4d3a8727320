/* SPDX-License-Identifier: BSD-3-Clause */
#include "gate/action_gate.h"

#include <ros/console.h>

#include <algorithm>
#include <utility>

#include "transport/guard.h"

namespace curve_proximity {
namespace {

void complain(const std::string &why) {
  ROS_ERROR("gate: %s", why.c_str());
}

} // namespace

ActionGate::ActionGate(const ros::NodeHandle &handle, const GateParameters &parameters, ros::Publisher refused)
    : parameters_(parameters),
      handle_(handle),
      refused_(std::move(refused)),
      calls_(handle, parameters.server, parameters.delta),
      spinner_(1, &queue_) {
  handle_.setCallbackQueue(&queue_);
  client_ = std::make_unique<Client>(handle_, parameters_.controller, &queue_);
  server_ = std::make_unique<Server>(
      handle_, "follow_joint_trajectory",
      [this](Server::GoalHandle goal) { guarded([&] { begin(std::move(goal)); }, complain); },
      [this](Server::GoalHandle goal) { guarded([&] { cancel(std::move(goal)); }, complain); }, false);
  server_->start();
  timer_ = handle_.createWallTimer(ros::WallDuration(MotionWatch::PERIOD),
                                   [this](const ros::WallTimerEvent &) { guarded([this] { watch(); }, complain); });
  spinner_.start();
}

ActionGate::~ActionGate() {
  timer_.stop();
  spinner_.stop();
  for (Running &running : running_) running.out.cancel(); // nobody would watch it
  running_.clear();
  server_.reset();
  client_.reset();
  queue_.clear();
}

ProximityQuery ActionGate::queryOf(const trajectory_msgs::JointTrajectory &trajectory) const {
  ProximityQuery query;
  query.trajectories.push_back(trajectory);
  query.trajectories.front().header.stamp = ros::Time(); // the scene as it is now
  query.current_joints = true;
  query.self_collision = parameters_.self_collision;
  return query;
}

void ActionGate::tell(Refusal refusal, const std::string &id, bool cancelled) {
  refusal.source = Refusal::ACTION;
  refusal.id = id;
  refusal.cancelled = cancelled;
  ROS_WARN("gate: goal '%s' %s: %s", id.c_str(), cancelled ? "is cancelled" : "does not pass", refusal.message.c_str());
  refused_.publish(refusal);
}

void ActionGate::begin(Server::GoalHandle goal) {
  const auto asked = goal.getGoal();
  const std::string id = goal.getGoalID().id;
  control::FollowJointTrajectoryResult result;
  result.error_code = control::FollowJointTrajectoryResult::INVALID_GOAL;
  Refusal refusal;
  bool clear = false;
  const ProximityQuery query = queryOf(asked->trajectory);
  guarded([&] { clear = calls_.isClear(query, refusal); }, [&](const std::string &why) { refusal.message = why; });
  if (clear && !client_->isServerConnected()) {
    refusal = Refusal();
    refusal.message = "the controller's action '" + parameters_.controller + "' is not there";
    clear = false;
  }
  if (!clear) {
    result.error_string = refusal.message;
    goal.setRejected(result, refusal.message);
    return tell(std::move(refusal), id, false);
  }
  goal.setAccepted();
  running_.push_back({goal, {}, MotionWatch(query, asked->trajectory.header.stamp, refusal.scene), ""});
  Running &running = running_.back();
  running.out = client_->sendGoal(
      *asked, [this](Client::GoalHandle done) { guarded([&] { end(std::move(done)); }, complain); },
      [this](Client::GoalHandle from, const boost::shared_ptr<const control::FollowJointTrajectoryFeedback> &feedback) {
        guarded(
            [&] {
              for (Running &one : running_)
                if (one.out == from) one.in.publishFeedback(*feedback);
            },
            complain);
      });
}

void ActionGate::cancel(Server::GoalHandle goal) {
  for (Running &running : running_)
    if (running.in == goal) running.out.cancel();
}

void ActionGate::end(Client::GoalHandle done) {
  const auto running =
      std::find_if(running_.begin(), running_.end(), [&](const Running &one) { return one.out == done; });
  if (running == running_.end() || !(done.getCommState() == actionlib::CommState::DONE)) return;
  const auto given = done.getResult();
  control::FollowJointTrajectoryResult result = given ? *given : control::FollowJointTrajectoryResult();
  const actionlib::TerminalState state = done.getTerminalState();
  if (!running->stopped.empty()) {
    result.error_code = control::FollowJointTrajectoryResult::PATH_TOLERANCE_VIOLATED;
    result.error_string = running->stopped;
    running->in.setAborted(result, running->stopped);
  } else if (state == actionlib::TerminalState::SUCCEEDED) {
    running->in.setSucceeded(result, state.getText());
  } else if (state == actionlib::TerminalState::PREEMPTED || state == actionlib::TerminalState::RECALLED) {
    running->in.setCanceled(result, state.getText());
  } else {
    running->in.setAborted(result, state.getText());
  }
  running_.erase(running);
}

void ActionGate::check(Running &running) {
  Refusal refusal;
  if (running.watch.isStillClear(calls_, refusal)) return;
  running.stopped = refusal.message;
  running.out.cancel();
  tell(std::move(refusal), running.in.getGoalID().id, true);
}

void ActionGate::watch() {
  for (Running &running : running_)
    if (running.stopped.empty()) check(running);
}

} // namespace curve_proximity
