/* SPDX-License-Identifier: BSD-3-Clause */
#include "gate/trajectory_gate.h"

#include <curve_proximity/Curve.h>
#include <nav_msgs/Path.h>
#include <ros/console.h>
#include <trajectory_msgs/JointTrajectory.h>
#include <trajectory_msgs/MultiDOFJointTrajectory.h>

#include <algorithm>
#include <cmath>
#include <curve_proximity/core.hpp>
#include <curve_proximity/fingerprint.hpp>
#include <string>
#include <type_traits>
#include <utility>

#include "transport/checked_stream.h"
#include "transport/guard.h"

namespace curve_proximity {
namespace {

constexpr std::uint32_t MOTION_QUEUE = 100; /* of roscpp: emptied at once */

void addTo(ProximityQuery &query, const Curve &curve) {
  query.curves.push_back(curve);
}
void addTo(ProximityQuery &query, const nav_msgs::Path &path) {
  query.paths.push_back(path);
}
void addTo(ProximityQuery &query, const trajectory_msgs::JointTrajectory &trajectory) {
  query.trajectories.push_back(trajectory);
}
void addTo(ProximityQuery &query, const trajectory_msgs::MultiDOFJointTrajectory &trajectory) {
  query.multi_dof_trajectories.push_back(trajectory);
}

/** The joints of a trajectory that tells a controller to stop; null: the message is none. */
template <class Message>
const std::vector<std::string> *stopOf(const Message &message) {
  if constexpr (std::is_same_v<Message, trajectory_msgs::JointTrajectory>)
    return message.points.empty() ? &message.joint_names : nullptr;
  else
    return nullptr;
}

template <class Entry>
void keep(std::deque<Entry> &entries, Entry entry, std::size_t most) {
  if (entries.size() == most) entries.pop_front();
  entries.push_back(std::move(entry));
}

/** Takes the entry of that fingerprint out. */
template <class Entry>
std::optional<Entry> take(std::deque<Entry> &entries, std::uint64_t fingerprint) {
  const auto found = std::find_if(entries.begin(), entries.end(),
                                  [&](const Entry &entry) { return entry.fingerprint == fingerprint; });
  if (found == entries.end()) return std::nullopt;
  std::optional<Entry> out(std::move(*found));
  entries.erase(found);
  return out;
}

} // namespace

bool isClear(const ProximityResults &results, double delta) {
  if (!results.success || results.results.empty()) return false;
  const bool tolerant = results.query_type == "tolerance" && results.delta >= delta;
  const bool apart = results.query_type == "collision" && delta == 0.0;
  return std::all_of(results.results.begin(), results.results.end(),
                     [&](const Proximity &row) { return isClear(row, delta, tolerant || apart); });
}

TrajectoryGate::TrajectoryGate(const ros::NodeHandle &handle, const GateParameters &parameters,
                               const ProofCheck *proofs)
    : parameters_(parameters), handle_(onQueue(handle, queue_)) {
  refused_ = handle_.advertise<Refusal>("refused", MOTION_QUEUE);
  if (!parameters_.server.empty())
    calls_ = std::make_unique<ServerCalls>(handle_, parameters_.server, parameters_.delta, proofs);
  if (parameters_.watch) watches_ = std::make_unique<MotionWatches>(handle_, parameters_, proofs);
  if (!parameters_.controller.empty()) actions_ = std::make_unique<ActionGate>(handle, parameters_, refused_, proofs);
  connect<Curve>("curve");
  connect<trajectory_msgs::JointTrajectory>("trajectory");
  connect<trajectory_msgs::MultiDOFJointTrajectory>("multi_dof_trajectory");
  connect<nav_msgs::Path>("path");
  subscribers_.push_back(handle_.subscribe<ProximityResults>(
      "proximity", MOTION_QUEUE,
      [this](const ProximityResultsConstPtr &results) { guarded([&] { answer(results); }, logGateError); }));
  queue_.start();
}

TrajectoryGate::~TrajectoryGate() {
  if (calls_) calls_->end(); // a subscriber that is shut down waits for its callback
  for (ros::Subscriber &subscriber : subscribers_) subscriber.shutdown();
  queue_.end();
  watches_.reset();
  actions_.reset();
}

template <class Message>
void TrajectoryGate::connect(const std::string &topic) {
  using Pointer = boost::shared_ptr<const Message>;
  const ros::Publisher out = handle_.advertise<Message>("clear_" + topic, MOTION_QUEUE);
  if (std::is_same_v<Message, trajectory_msgs::JointTrajectory>) clear_trajectory_ = out;
  subscribers_.push_back(handle_.subscribe<Message>(topic, MOTION_QUEUE, [this, out](const Pointer &message) {
    guarded(
        [&] {
          if (const auto *stop = stopOf(*message)) {
            forget(*stop);
            return out.publish(message);
          }
          receive({fingerprint(*message), [out, message] { out.publish(message); },
                   [message](ProximityQuery &query) { addTo(query, *message); }});
        },
        logGateError);
  }));
}

void TrajectoryGate::receive(Waiting message) {
  const std::optional<Answered> known = take(answered_, message.fingerprint);
  if (known) return decide(message, *known->results);
  keep(waiting_, std::move(message), static_cast<std::size_t>(parameters_.queue_size));
}

void TrajectoryGate::answer(const ProximityResultsConstPtr &results) {
  const std::optional<Waiting> message = take(waiting_, results->fingerprint);
  if (message) return decide(*message, *results);
  keep(answered_, {results->fingerprint, results}, static_cast<std::size_t>(parameters_.queue_size));
}

void TrajectoryGate::decide(const Waiting &message, const ProximityResults &results) {
  Refusal refusal;
  if (!isClear(results, parameters_.delta)) {
    refusal = refusalOf(results.results, parameters_.delta, results.scene);
    if (!results.success) refusal.message = results.message;
    return refuse(std::move(refusal), results);
  }
  if (!calls_) return message.pass();
  ProximityQuery query;
  message.ask(query);
  query.current_joints = !std::isnan(results.scene.joint_state_age);
  query.self_collision = std::any_of(results.results.begin(), results.results.end(),
                                     [](const Proximity &row) { return row.kind == Proximity::KIND_SELF; });
  const bool moves = !query.trajectories.empty() || !query.multi_dof_trajectories.empty();
  if (parameters_.verify && moves) { // the server does not say what is asked
    query.current_joints = true;
    query.self_collision = parameters_.self_collision;
  }
  SeenScene scene;
  scene.state = results.scene;
  const auto all = [&]() -> const ProximityQuery & { return query; };
  // it may have changed since the answer; and the answer has no certificates
  if (!calls_->isStillClear(all, !parameters_.verify, ServerCalls::PATIENCE, scene, refusal))
    return refuse(std::move(refusal), results);
  message.pass();
  if (watches_ && !query.trajectories.empty()) watch(std::move(query), results, std::move(scene));
}

void TrajectoryGate::watch(ProximityQuery query, const ProximityResults &results, SeenScene scene) {
  ProximityResults of; // the head of its answer, without rows
  of.header = results.header;
  of.source = results.source;
  of.id = results.id;
  of.fingerprint = results.fingerprint;
  const std::vector<std::string> joints = query.trajectories.front().joint_names;
  const auto end = [this, of, joints](Refusal refusal) {
    trajectory_msgs::JointTrajectory stop;
    stop.joint_names = joints;
    clear_trajectory_.publish(stop);
    refuse(std::move(refusal), of);
  };
  forget(joints);
  running_.push_back(std::make_shared<MotionWatch>(std::move(query), std::move(scene), parameters_, end));
  watches_->add(running_.back());
}

/** A trajectory of the same joints takes the place of the one before it; an empty list of joints is all. */
void TrajectoryGate::forget(const std::vector<std::string> &joints) {
  running_.remove_if([&](const std::shared_ptr<MotionWatch> &one) {
    const auto &others = one->trajectory().joint_names;
    const bool same = joints.empty() ||
                      std::find_first_of(others.begin(), others.end(), joints.begin(), joints.end()) != others.end();
    if (same) watches_->remove(one);
    return same || one->isOver();
  });
}

void TrajectoryGate::refuse(Refusal refusal, const ProximityResults &results) {
  refusal.header.frame_id = results.header.frame_id;
  refusal.source = results.source;
  refusal.id = results.id;
  refusal.fingerprint = results.fingerprint;
  refusal.delta = parameters_.delta;
  ROS_WARN("gate: %s '%s' %s: %s", results.source.c_str(), results.id.c_str(),
           refusal.cancelled ? "is stopped" : "does not pass", refusal.message.c_str());
  refused_.publish(refusal);
}

} // namespace curve_proximity
