/* SPDX-License-Identifier: BSD-3-Clause */
#include "pipeline.h"

#include <ros/console.h>
#include <ros/subscribe_options.h>

#include <curve_proximity/fingerprint.hpp>
#include <memory>
#include <utility>

#include "guard.h"
#include "topics.h"

namespace curve_proximity {
namespace {

constexpr std::uint32_t RESULTS_KEPT = 100; /* for subscribers in other processes that are slow */

/** One thread answers, the other takes in what comes meanwhile. */
constexpr std::uint32_t THREADS = 2;

const char *topicOf(const CurveConstPtr &) {
  return "curve";
}
const char *topicOf(const trajectory_msgs::JointTrajectoryConstPtr &) {
  return "trajectory";
}
const char *topicOf(const trajectory_msgs::MultiDOFJointTrajectoryConstPtr &) {
  return "multi_dof_trajectory";
}
const char *topicOf(const nav_msgs::PathConstPtr &) {
  return "path";
}

std::string idOf(const Curve &curve) {
  return curve.id;
}
template <class Message>
std::string idOf(const Message &) {
  return "";
}

} // namespace

Pipeline::Pipeline(const ros::NodeHandle &handle, const Parameters &parameters, const Tuning &tuning,
                   const Scene &scene, const Srdf &srdf, Queries &queries, MarkerPublisher &markers,
                   const std::atomic<bool> &stop)
    : parameters_(parameters),
      tuning_(tuning),
      scene_(scene),
      srdf_(srdf),
      queries_(queries),
      markers_(markers),
      stop_(stop),
      query_type_(queryTypeFromName(parameters.query_type)),
      jobs_(static_cast<std::size_t>(parameters.queue_size)),
      handle_(handle),
      spinner_(THREADS, &queue_) {
  handle_.setCallbackQueue(&queue_);
  results_ = handle_.advertise<ProximityResults>("proximity", RESULTS_KEPT);
  listen<Curve>("curve");
  listen<trajectory_msgs::JointTrajectory>("trajectory");
  listen<trajectory_msgs::MultiDOFJointTrajectory>("multi_dof_trajectory");
  listen<nav_msgs::Path>("path");
  subscribers_.push_back(handle_.subscribe<sensor_msgs::JointState>(
      "joint_states", RESULTS_KEPT, [this](const sensor_msgs::JointStateConstPtr &state) {
        guarded([&] { keepJoints(*state); },
                [](const std::string &why) { ROS_ERROR("~joint_states: %s", why.c_str()); });
      }));
  spinner_.start();
}

Pipeline::~Pipeline() {
  for (ros::Subscriber &subscriber : subscribers_) subscriber.shutdown();
  spinner_.stop();
  queue_.clear();
}

/** roscpp's own queue drops what is oldest too, but counts nothing: it is left without a limit, and emptied at once. */
template <class Message>
void Pipeline::listen(const char *topic) {
  using Pointer = boost::shared_ptr<const Message>;
  ros::SubscribeOptions options;
  options.init<Message>(topic, 0, [this](const Pointer &message) {
    if (!message || !jobs_.push(Job(message))) return;
    work();
  });
  options.callback_queue = &queue_;
  options.allow_concurrent_callbacks = true;
  options.transport_hints = ros::TransportHints().tcpNoDelay();
  subscribers_.push_back(handle_.subscribe(options));
}

void Pipeline::work() {
  Job job;
  while (jobs_.next(job)) {
    if (stop_) continue;
    guarded([&] { handle(job); },
            [](const std::string &why) { ROS_ERROR("a message is not answered: %s", why.c_str()); });
  }
}

void Pipeline::keepJoints(const sensor_msgs::JointState &state) {
  const std::lock_guard<std::mutex> lock(joints_mutex_);
  for (std::size_t i = 0; i < state.name.size() && i < state.position.size(); ++i)
    joints_[state.name[i]] = state.position[i];
}

void Pipeline::handle(const Job &job) {
  // What is known of the message before anything can go wrong with it.
  const auto results = boost::make_shared<ProximityResults>();
  std::visit(
      [&](const auto &message) {
        results->header.stamp = message->header.stamp;
        results->source = topicOf(message);
        results->id = idOf(*message);
        results->fingerprint = fingerprint(*message);
      },
      job);
  results->header.frame_id = parameters_.fixed_frame;
  results->query_type = parameters_.query_type;
  results->delta = query_type_ == QueryType::TOLERANCE ? tuning_.delta.load() : 0.0;
  results->epsilon = tuning_.epsilon;

  const auto drawing = std::make_shared<Drawing>();
  guarded(
      [&] {
        Asked asked;
        std::visit([&](const auto &message) { toAsked(*message, asked); }, job);

        // Curves meet the robot where tf2 has it; joints that a trajectory leaves alone stand as they were last told.
        sensor_msgs::JointState state;
        if (asked.trajectories.size() > 0) {
          const std::lock_guard<std::mutex> lock(joints_mutex_);
          for (const auto &joint : joints_) {
            state.name.push_back(joint.first);
            state.position.push_back(joint.second);
          }
        }
        const std::vector<std::string> everything;
        const bool self = parameters_.self_collision && asked.trajectories.size() > 0;
        QueryRequest request{query_type_, results->delta, asked.curves, asked.trajectories,
                             self,        everything,     everything,   state};
        QueryResponse answer;
        queries_.answer(request, answer, *drawing);
        results->success = answer.success;
        results->message = std::move(answer.message);
        results->results = std::move(answer.results);
      },
      [&](const std::string &why) {
        results->success = false;
        results->message = why;
      });
  results->dropped = jobs_.dropped();
  results_.publish(ProximityResultsPtr(results));
  markers_.show(drawing);
}

void Pipeline::toAsked(const Curve &message, Asked &asked) const {
  asked.curves = List<Curve>(&message, 1);
}

void Pipeline::toAsked(const trajectory_msgs::JointTrajectory &message, Asked &asked) const {
  asked.trajectories = List<trajectory_msgs::JointTrajectory>(&message, 1);
}

void Pipeline::toAsked(const trajectory_msgs::MultiDOFJointTrajectory &message, Asked &asked) const {
  asked.own_trajectory = toJointTrajectory(message, scene_.snapshot()->robot().get(), srdf_);
  if (!asked.own_trajectory.joint_names.empty()) {
    asked.trajectories = List<trajectory_msgs::JointTrajectory>(&asked.own_trajectory, 1);
    return;
  }
  asked.own_curves = toCurves(message, parameters_.path_radius);
  asked.curves = List<Curve>(asked.own_curves);
}

void Pipeline::toAsked(const nav_msgs::Path &message, Asked &asked) const {
  asked.own_curves = {toCurve(message, parameters_.path_radius)};
  asked.curves = List<Curve>(asked.own_curves);
}

} // namespace curve_proximity
