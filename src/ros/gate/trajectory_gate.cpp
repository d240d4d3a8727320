/* SPDX-License-Identifier: BSD-3-Clause */
#include "gate/trajectory_gate.h"

#include <curve_proximity/Curve.h>
#include <nav_msgs/Path.h>
#include <ros/console.h>
#include <trajectory_msgs/JointTrajectory.h>
#include <trajectory_msgs/MultiDOFJointTrajectory.h>

#include <curve_proximity/fingerprint.hpp>
#include <utility>

#include "transport/checked_stream.h"
#include "transport/guard.h"

namespace curve_proximity {
namespace {

using trajectory_msgs::JointTrajectory;

constexpr std::uint32_t MOTION_QUEUE = 100; /* of roscpp: emptied at once */

} // namespace

TrajectoryGate::TrajectoryGate(const ros::NodeHandle &handle, const GateParameters &parameters,
                               const ProofCheck *proofs)
    : parameters_(parameters),
      queue_(static_cast<std::size_t>(parameters.queue_size)),
      handle_(onQueue(handle, queue_)),
      refused_(handle_.advertise<Refusal>("refused", MOTION_QUEUE)),
      clear_trajectory_(handle_.advertise<JointTrajectory>("clear_trajectory", MOTION_QUEUE)),
      calls_(handle_, parameters_.server, parameters_.delta, proofs) {
  if (parameters_.watch) watches_ = std::make_unique<MotionWatches>(handle_, parameters_, proofs);
  if (!parameters_.controller.empty()) actions_ = std::make_unique<ActionGate>(handle, parameters_, refused_, proofs);
  connect("curve", &ProximityQuery::curves, handle_.advertise<Curve>("clear_curve", MOTION_QUEUE));
  connect("trajectory", &ProximityQuery::trajectories, clear_trajectory_);
  connect("multi_dof_trajectory", &ProximityQuery::multi_dof_trajectories,
          handle_.advertise<trajectory_msgs::MultiDOFJointTrajectory>("clear_multi_dof_trajectory", MOTION_QUEUE));
  connect("path", &ProximityQuery::paths, handle_.advertise<nav_msgs::Path>("clear_path", MOTION_QUEUE));
  queue_.start();
}

TrajectoryGate::~TrajectoryGate() {
  for (ros::Subscriber &subscriber : subscribers_) subscriber.shutdown();
  calls_.end();
  queue_.end();
  watches_.reset();
  actions_.reset();
}

template <class Message>
void TrajectoryGate::connect(const std::string &topic, std::vector<Message> ProximityQuery::*motions,
                             const ros::Publisher &out) {
  using Pointer = boost::shared_ptr<const Message>;
  ros::SubscribeOptions options = checkedSubscription<Message>(topic, MOTION_QUEUE, [=](const Pointer &message) {
    if constexpr (std::is_same_v<Message, JointTrajectory>)
      if (message->points.empty()) return stop(message);
    const std::uint64_t stops = stops_;
    queue_.add([=] { guarded([&] { judge(topic, motions, message, stops, out); }, logGateError); });
  });
  subscribers_.push_back(handle_.subscribe(options));
}

void TrajectoryGate::stop(const trajectory_msgs::JointTrajectoryConstPtr &message) {
  const std::lock_guard<std::mutex> lock(passing_);
  ++stops_;
  if (watches_) watches_->forget(message->joint_names);
  clear_trajectory_.publish(message);
}

template <class Message>
void TrajectoryGate::judge(const std::string &topic, std::vector<Message> ProximityQuery::*motions,
                           const boost::shared_ptr<const Message> &message, std::uint64_t stops,
                           const ros::Publisher &out) {
  Motion motion{topic, "", fingerprint(*message)};
  if constexpr (std::is_same_v<Message, Curve>) motion.id = message->id;
  ProximityQuery query;
  (query.*motions).push_back(*message);
  query.current_joints = !query.trajectories.empty() || !query.multi_dof_trajectories.empty();
  query.self_collision = query.current_joints && parameters_.self_collision;
  SeenScene scene;
  Refusal refusal;
  if (!calls_.isClear([&]() -> const ProximityQuery & { return query; }, scene, refusal))
    return refuse(std::move(refusal), motion);
  const std::lock_guard<std::mutex> lock(passing_);
  if (!query.trajectories.empty() && stops_ != stops)
    return refuse(refusalBecause("a stop came after it", scene.state), motion);
  out.publish(message);
  if (!watches_ || query.trajectories.empty()) return;
  const std::vector<std::string> joints = query.trajectories.front().joint_names;
  watches_->forget(joints);
  watches_->add(std::make_shared<MotionWatch>(std::move(query), std::move(scene), parameters_, watches_->continuous(),
                                              [this, motion, joints](Refusal why) {
                                                JointTrajectory stop;
                                                stop.joint_names = joints;
                                                clear_trajectory_.publish(stop);
                                                refuse(std::move(why), motion);
                                              }));
}

void TrajectoryGate::refuse(Refusal refusal, const Motion &motion) {
  refusal.source = motion.topic;
  refusal.id = motion.id;
  refusal.fingerprint = motion.fingerprint;
  refusal.delta = parameters_.delta;
  ROS_WARN("gate: %s '%s' %s: %s", motion.topic.c_str(), motion.id.c_str(),
           refusal.cancelled ? "is stopped" : "does not pass", refusal.message.c_str());
  refused_.publish(refusal);
}

} // namespace curve_proximity
