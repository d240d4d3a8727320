/* SPDX-License-Identifier: BSD-3-Clause */
#include "gate/action_gate.h"

#include <ros/console.h>

#include <algorithm>
#include <cstddef>
#include <utility>

#include "transport/checked_stream.h"
#include "transport/guard.h"

namespace curve_proximity {
namespace {

using trajectory_msgs::JointTrajectory;

constexpr std::size_t AT_ONCE = 4;
constexpr double LOOK_PERIOD = 0.1; /* [s] between two looks for the controller */

} // namespace

ActionGate::ActionGate(const ros::NodeHandle &handle, const GateParameters &parameters, ros::Publisher refused,
                       const ProofCheck *proofs)
    : parameters_(parameters),
      queue_(AT_ONCE),
      handle_(onQueue(handle, queue_)),
      refused_(std::move(refused)),
      calls_(handle, parameters.server, parameters.delta, proofs) {
  watches_ = std::make_unique<MotionWatches>(handle_, parameters_, proofs);
  client_ = std::make_unique<Client>(handle_, parameters_.controller, &queue_);
  server_ = std::make_unique<Server>(
      handle_, "follow_joint_trajectory",
      [this](Server::GoalHandle goal) { guarded([&] { begin(std::move(goal)); }, logGateError); },
      [this](Server::GoalHandle goal) { guarded([&] { cancel(goal); }, logGateError); }, false);
  server_->start();
  timer_ = handle_.createWallTimer(ros::WallDuration(LOOK_PERIOD), [this](const ros::WallTimerEvent &) {
    guarded([this] { findLost(); }, logGateError);
  });
  queue_.start();
}

ActionGate::~ActionGate() {
  calls_.end();
  timer_.stop();
  queue_.end();
  watches_.reset();
  for (const RunningPointer &running : all()) running->out.cancel(); // nobody would watch it
  for (const RunningPointer &running : all()) running->out.reset();
  running_.clear();
  server_.reset();
  client_.reset();
}

void ActionGate::tell(Refusal refusal, const std::string &id, bool cancelled) {
  refusal.source = Refusal::ACTION;
  refusal.id = id;
  refusal.cancelled = cancelled;
  refusal.delta = parameters_.delta;
  ROS_WARN("gate: goal '%s' %s: %s", id.c_str(), cancelled ? "is cancelled" : "does not pass", refusal.message.c_str());
  refused_.publish(refusal);
}

std::vector<ActionGate::RunningPointer> ActionGate::all() {
  const std::lock_guard<std::mutex> lock(mutex_);
  return {running_.begin(), running_.end()};
}

/** Whether it was there: whoever forgets it tells its client how it ended. */
bool ActionGate::forget(const RunningPointer &running) {
  if (running->watch) watches_->remove(running->watch);
  const std::lock_guard<std::mutex> lock(mutex_);
  running->ended = true;
  running->out.reset();
  const auto found = std::find(running_.begin(), running_.end(), running);
  if (found == running_.end()) return false;
  running_.erase(found);
  return true;
}

/* ---- a new goal ---- */

void ActionGate::begin(Server::GoalHandle goal) {
  const JointTrajectory &trajectory = goal.getGoal()->trajectory;
  Refusal refusal;
  ProximityQuery query;
  SeenScene scene;
  const auto asked = [&]() -> const ProximityQuery & {
    query.trajectories = {watches_->fromHere(trajectory)};
    query.current_joints = true;
    query.self_collision = parameters_.self_collision;
    return query;
  };
  bool passes = trajectory.points.empty() || calls_.isClear(asked, scene, refusal);
  if (passes && !client_->isServerConnected()) {
    refusal = refusalBecause(lostController(), SceneState());
    passes = false;
  }
  if (!passes) {
    control_msgs::FollowJointTrajectoryResult result;
    result.error_code = control_msgs::FollowJointTrajectoryResult::INVALID_GOAL;
    result.error_string = refusal.message;
    goal.setRejected(result, refusal.message);
    return tell(std::move(refusal), goal.getGoalID().id, false);
  }
  if (goal.getGoalStatus().status == actionlib_msgs::GoalStatus::RECALLING) return goal.setCanceled();

  goal.setAccepted();
  const auto running = std::make_shared<Running>();
  running->in = goal;
  if (!trajectory.points.empty()) {
    const std::weak_ptr<Running> weak = running;
    running->watch = std::make_shared<MotionWatch>(std::move(query), std::move(scene), parameters_,
                                                   watches_->continuous(), [this, weak](Refusal why) {
                                                     const RunningPointer stopped = weak.lock();
                                                     if (!stopped) return;
                                                     stop(stopped, why.message);
                                                     tell(std::move(why), stopped->in.getGoalID().id, true);
                                                   });
  }
  send(running);
}

void ActionGate::send(const RunningPointer &running) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    running_.push_back(running);
  }
  if (running->watch) watches_->add(running->watch);
  Client::GoalHandle out = client_->sendGoal(
      *running->in.getGoal(),
      [this, running](Client::GoalHandle done) { guarded([&] { end(running, done); }, logGateError); },
      [running](Client::GoalHandle,
                const boost::shared_ptr<const control_msgs::FollowJointTrajectoryFeedback> &feedback) {
        guarded(
            [&] {
              if (running->watch)
                running->watch->tell(feedback->joint_names, feedback->actual.positions, feedback->header.stamp);
              running->in.publishFeedback(*feedback);
            },
            logGateError);
      });
  bool unwanted;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (running->ended) return;
    running->out = out;
    unwanted = !running->stopped.empty();
  }
  if (unwanted || running->in.getGoalStatus().status == actionlib_msgs::GoalStatus::PREEMPTING) out.cancel();
}

/* ---- a goal that runs ---- */

void ActionGate::cancel(const Server::GoalHandle &goal) {
  for (const RunningPointer &running : all())
    if (running->in == goal) stop(running, "");
}

/** why: ""; the client wants it. */
void ActionGate::stop(const RunningPointer &running, const std::string &why) {
  Client::GoalHandle out;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (running->ended) return;
    if (!why.empty()) running->stopped = why;
    out = running->out;
  }
  if (!out.isExpired()) out.cancel(); // else send() will
}

void ActionGate::end(const RunningPointer &running, const Client::GoalHandle &done) {
  if (!(done.getCommState() == actionlib::CommState::DONE)) return;
  const auto given = done.getResult();
  control_msgs::FollowJointTrajectoryResult result = given ? *given : control_msgs::FollowJointTrajectoryResult();
  const actionlib::TerminalState state = done.getTerminalState();
  if (!forget(running)) return;
  if (!running->stopped.empty()) {
    result.error_code = control_msgs::FollowJointTrajectoryResult::PATH_TOLERANCE_VIOLATED;
    result.error_string = running->stopped;
    running->in.setAborted(result, running->stopped);
  } else if (state == actionlib::TerminalState::SUCCEEDED) {
    running->in.setSucceeded(result, state.getText());
  } else if (state == actionlib::TerminalState::PREEMPTED || state == actionlib::TerminalState::RECALLED) {
    running->in.setCanceled(result, state.getText());
  } else {
    running->in.setAborted(result, state.getText());
  }
}

/** A controller that has gone ends nothing itself. */
void ActionGate::findLost() {
  const std::vector<RunningPointer> running = all();
  if (running.empty() || client_->isServerConnected()) return;
  for (const RunningPointer &one : running) {
    if (!forget(one)) continue;
    Refusal refusal = refusalBecause(lostController(), SceneState());
    control_msgs::FollowJointTrajectoryResult result;
    result.error_code = control_msgs::FollowJointTrajectoryResult::PATH_TOLERANCE_VIOLATED;
    result.error_string = refusal.message;
    one->in.setAborted(result, refusal.message);
    tell(std::move(refusal), one->in.getGoalID().id, true);
  }
}

std::string ActionGate::lostController() const {
  return "the controller's action '" + parameters_.controller + "' is not there";
}

} // namespace curve_proximity
