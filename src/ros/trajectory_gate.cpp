/* SPDX-License-Identifier: BSD-3-Clause */
#include "trajectory_gate.h"

#include <curve_proximity/Curve.h>
#include <nav_msgs/Path.h>
#include <ros/console.h>
#include <trajectory_msgs/JointTrajectory.h>
#include <trajectory_msgs/MultiDOFJointTrajectory.h>

#include <algorithm>
#include <curve_proximity/fingerprint.hpp>
#include <string>
#include <utility>

#include "guard.h"

namespace curve_proximity {
namespace {

constexpr std::uint32_t QUEUE = 100; /* of roscpp: emptied at once */

void complain(const std::string &why) {
  ROS_ERROR("gate: %s", why.c_str());
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
  return std::all_of(results.results.begin(), results.results.end(), [&](const Proximity &row) {
    const bool settled = (tolerant || apart) && row.verdict == "clear";
    return settled || row.lower > delta; // a row without an answer has NaN and no verdict
  });
}

TrajectoryGate::TrajectoryGate(const ros::NodeHandle &handle, const GateParameters &parameters)
    : parameters_(parameters), handle_(handle), spinner_(1, &queue_) {
  handle_.setCallbackQueue(&queue_);
  connect<Curve>("curve");
  connect<trajectory_msgs::JointTrajectory>("trajectory");
  connect<trajectory_msgs::MultiDOFJointTrajectory>("multi_dof_trajectory");
  connect<nav_msgs::Path>("path");
  subscribers_.push_back(handle_.subscribe<ProximityResults>(
      "proximity", QUEUE,
      [this](const ProximityResultsConstPtr &results) { guarded([&] { answer(*results); }, complain); }));
  spinner_.start();
}

TrajectoryGate::~TrajectoryGate() {
  for (ros::Subscriber &subscriber : subscribers_) subscriber.shutdown();
  spinner_.stop();
  queue_.clear();
}

template <class Message>
void TrajectoryGate::connect(const std::string &topic) {
  using Pointer = boost::shared_ptr<const Message>;
  const ros::Publisher out = handle_.advertise<Message>("clear_" + topic, QUEUE);
  subscribers_.push_back(handle_.subscribe<Message>(topic, QUEUE, [this, out](const Pointer &message) {
    guarded([&] { receive({fingerprint(*message), [out, message] { out.publish(message); }}); }, complain);
  }));
}

void TrajectoryGate::receive(Waiting message) {
  const std::optional<Answered> known = take(answered_, message.fingerprint);
  if (!known) {
    keep(waiting_, std::move(message), static_cast<std::size_t>(parameters_.queue_size));
  } else if (known->clear) {
    message.pass();
  }
}

void TrajectoryGate::answer(const ProximityResults &results) {
  const bool clear = isClear(results, parameters_.delta);
  if (!clear)
    ROS_WARN("gate: %s '%s' does not pass: it is not certified to be clear", results.source.c_str(),
             results.id.c_str());
  const std::optional<Waiting> message = take(waiting_, results.fingerprint);
  if (!message) {
    keep(answered_, {results.fingerprint, clear}, static_cast<std::size_t>(parameters_.queue_size));
  } else if (clear) {
    message->pass();
  }
}

} // namespace curve_proximity
