/* SPDX-License-Identifier: BSD-3-Clause */
#include "pipeline/pipeline.h"

#include <ros/console.h>
#include <sensor_msgs/JointState.h>

#include <curve_proximity/fingerprint.hpp>
#include <iterator>
#include <type_traits>
#include <utility>

#include "messages/topics.h"
#include "moveit/robot_trajectory.h"
#include "transport/checked_stream.h"
#include "transport/guard.h"

namespace curve_proximity {
namespace {

constexpr std::uint32_t RESULTS_KEPT = 100; /* for subscribers in other processes that are slow */

template <class Message>
ros::Time stampOf(const Message &message) {
  return message.header.stamp;
}
ros::Time stampOf(const moveit::RobotTrajectory &message) {
  const ros::Time stamp = message.joint_trajectory.header.stamp;
  return stamp.isZero() ? message.multi_dof_joint_trajectory.header.stamp : stamp;
}
ros::Time stampOf(const moveit::DisplayTrajectory &message) {
  return message.trajectory.empty() ? ros::Time() : stampOf(message.trajectory.front());
}

template <class Message>
constexpr bool isOfMoveIt =
    std::is_same_v<Message, moveit::RobotTrajectory> || std::is_same_v<Message, moveit::DisplayTrajectory>;

/** The request is about a message. */
void fill(const Curve &message, QueryRequest &request) {
  request.curves = {&message, &message + 1};
}
void fill(const nav_msgs::Path &message, QueryRequest &request) {
  request.paths = {&message, &message + 1};
}
void fill(const trajectory_msgs::JointTrajectory &message, QueryRequest &request) {
  request.trajectories = {&message, &message + 1};
}
void fill(const trajectory_msgs::MultiDOFJointTrajectory &message, QueryRequest &request) {
  request.multi_dof_trajectories = {&message, &message + 1};
}

std::string idOf(const Curve &curve) {
  return curve.id;
}
template <class Message>
std::string idOf(const Message &) {
  return "";
}

} // namespace

Pipeline::Pipeline(const ros::NodeHandle &handle, const Parameters &parameters, const Tuning &tuning, LiveScene &live,
                   Queries &queries, MarkerPublisher &markers, const std::atomic<bool> &stop)
    : parameters_(parameters),
      tuning_(tuning),
      live_(live),
      queries_(queries),
      markers_(markers),
      stop_(stop),
      query_type_(*queryTypeFromName(parameters.query_type)),
      queue_(static_cast<std::size_t>(parameters.queue_size)),
      handle_(onQueue(handle, queue_)),
      state_handle_(onQueue(handle, state_queue_)) {
  results_ = handle_.advertise<ProximityResults>("proximity", RESULTS_KEPT);
  contacts_ = handle_.advertise<moveit::ContactInformation>("contacts", RESULTS_KEPT);
  if (parameters_.profile_intervals > 0)
    clearance_ = std::make_unique<ClearanceTopics>(handle_, static_cast<std::size_t>(parameters_.profile_intervals),
                                                   live_.scene.snapshot()->robot().get(), parameters_.profile_per_link);
  listen<Curve>("curve");
  listen<trajectory_msgs::JointTrajectory>("trajectory");
  listen<trajectory_msgs::MultiDOFJointTrajectory>("multi_dof_trajectory");
  listen<nav_msgs::Path>("path");
  listen<moveit::RobotTrajectory>("robot_trajectory");
  listen<moveit::DisplayTrajectory>("display_trajectory");
  ros::SubscribeOptions joints = checkedSubscription<sensor_msgs::JointState>(
      "joint_states", RESULTS_KEPT, [this](const sensor_msgs::JointStateConstPtr &state) {
        guarded([&] { live_.joints.take(*state, live_.scene.snapshot()->robot().get()); },
                [](const std::string &why) { ROS_ERROR("~joint_states: %s", why.c_str()); });
      });
  subscribers_.push_back(handle_.subscribe(joints));
  queue_.start();
  if (parameters_.state_rate == 0.0) return;
  states_ = state_handle_.advertise<ProximityResults>("state_proximity", 1);
  state_timer_ = state_handle_.createWallTimer(
      ros::WallDuration(1.0 / parameters_.state_rate), [this](const ros::WallTimerEvent &) {
        guarded([this] { tellState(); },
                [](const std::string &why) { ROS_ERROR("~state_proximity: %s", why.c_str()); });
      });
  state_queue_.start();
}

Pipeline::~Pipeline() {
  for (ros::Subscriber &subscriber : subscribers_) subscriber.shutdown();
  state_timer_.stop();
  queue_.end();
  state_queue_.end();
}

/** roscpp's queue is left without a limit, and emptied at once. */
template <class Message>
void Pipeline::listen(const char *topic) {
  using Pointer = boost::shared_ptr<const Message>;
  ros::SubscribeOptions options = checkedSubscription<Message>(topic, 0, [this, topic](const Pointer &message) {
    if (message)
      queue_.add([this, topic, message] {
        guarded([&] { handle(topic, *message); },
                [](const std::string &why) { ROS_ERROR("a message is not answered: %s", why.c_str()); });
      });
  });
  options.transport_hints = ros::TransportHints().tcpNoDelay();
  subscribers_.push_back(handle_.subscribe(options));
}

template <class Message>
void Pipeline::handle(const char *topic, const Message &message) {
  if (stop_) return;
  // What is known of the message before anything can go wrong with it.
  const auto results = boost::make_shared<ProximityResults>();
  results->source = topic;
  results->header.stamp = stampOf(message);
  results->id = idOf(message);
  results->fingerprint = fingerprint(message);
  describe(*results);

  const auto drawing = std::make_shared<Drawing>();
  bool published = false;
  const auto publish = [&] {
    published = true;
    results->dropped = queue_.dropped();
    results_.publish(ProximityResultsPtr(results));
    tellContacts(*results);
    markers_.show(drawing);
  };
  const auto ask = [&](const QueryRequest &request) {
    answer(request, *results, *drawing);
    publish(); // nobody has to wait for the profile
    tellClearance(request, *results);
  };
  guarded(
      [&] {
        // Curves meet the robot where tf2 has it; joints that a trajectory leaves alone stand as they were last told.
        ProximityQuery more;
        more.current_joints = movesRobot(message);
        more.self_collision = parameters_.self_collision && more.current_joints;
        if constexpr (isOfMoveIt<Message>) {
          requestOfMotions(message, more, *results, ask);
        } else {
          QueryRequest request(query_type_, results->delta, more);
          fill(message, request);
          ask(request);
        }
      },
      [&](const std::string &why) {
        if (published) ROS_ERROR("~clearance: %s", why.c_str());
        if (published) return;
        results->success = false;
        results->message = why;
      });
  if (!published) publish();
}

/** What is not used of the message is told in the answer and in the log. */
template <class Message>
void Pipeline::requestOfMotions(const Message &message, ProximityQuery &more, ProximityResults &results,
                                const Ask &ask) {
  RobotMotions motions = toMotions(message, *live_.scene.snapshot(), live_.srdf);
  more.joint_state = motions.start;
  more.joint_state.header.stamp = ros::Time(); // when the trajectory was planned is no time to look transforms up for
  QueryRequest request(query_type_, results.delta, more);
  request.trajectories = listOf(motions.trajectories);
  request.coverage = std::move(motions.coverage);
  for (std::string &remark : motions.remarks) {
    const std::string line = "~" + results.source + ": " + remark;
    if (log_limit_.isDue(line)) ROS_WARN_STREAM(line);
    results.warnings.push_back(std::move(remark));
  }
  ask(request);
}

/** moveit_msgs has no list of contacts: a message each. */
void Pipeline::tellContacts(const ProximityResults &results) {
  if (contacts_.getNumSubscribers() == 0) return;
  const SnapshotPtr snapshot = live_.scene.snapshot();
  for (const Proximity &row : results.results) {
    std::optional<moveit::ContactInformation> contact = toContact(row, results.epsilon, *snapshot);
    if (!contact) continue;
    contact->header = results.header;
    contacts_.publish(*contact);
  }
}

/** The profile of what was answered. It is asked for only where somebody looks. */
void Pipeline::tellClearance(const QueryRequest &request, const ProximityResults &results) {
  if (!clearance_ || !clearance_->isWatched()) return;
  QueryRequest again(request);
  again.query_type = QueryType::DISTANCE;
  again.delta = 0.0;
  again.arrival = std::chrono::steady_clock::now();
  question::Profile asked;
  asked.intervals = static_cast<std::size_t>(parameters_.profile_intervals);
  again.question = asked;
  std_msgs::Header begin = results.header;
  if (begin.stamp.isZero()) begin.stamp = ros::Time::now();
  for (const bool per_link : {false, true}) {
    if (per_link && (!parameters_.profile_per_link || request.trajectories.empty())) continue;
    again.per_link = per_link;
    QueryResponse answer;
    Drawing not_drawn;
    queries_.answer(again, answer, not_drawn);
    if (!answer.success && log_limit_.isDue(answer.message)) ROS_WARN("~clearance: %s", answer.message.c_str());
    for (const Profile &profile : takeSummed<Profile>(answer)) clearance_->publish(profile, begin);
  }
}

/** What is asked of every message. */
void Pipeline::describe(ProximityResults &results) const {
  results.header.frame_id = parameters_.fixed_frame;
  results.query_type = parameters_.query_type;
  results.delta = query_type_ == QueryType::TOLERANCE ? tuning_.delta.load() : 0.0;
  results.epsilon = tuning_.epsilon;
}

void Pipeline::answer(const QueryRequest &request, ProximityResults &results, Drawing &drawing) {
  QueryResponse answer;
  queries_.answer(request, answer, drawing);
  results.success = answer.success;
  results.message = std::move(answer.message);
  std::move(answer.warnings.begin(), answer.warnings.end(), std::back_inserter(results.warnings));
  results.scene = std::move(answer.scene);
  results.results = std::move(answer.results);
}

void Pipeline::tellState() {
  if (stop_ || (states_.getNumSubscribers() == 0 && !markers_.isWatched())) return;
  const auto results = boost::make_shared<ProximityResults>();
  results->header.seq = state_seq_++;
  results->header.stamp = ros::Time::now();
  results->source = results->id = ProximityResults::SOURCE_STATE;
  describe(*results);
  const auto drawing = std::make_shared<Drawing>();
  guarded(
      [&] {
        ProximityQuery more;
        more.robot_state = true;
        more.self_collision = parameters_.self_collision;
        answer(QueryRequest(query_type_, results->delta, more), *results, *drawing);
      },
      [&](const std::string &why) {
        results->success = false;
        results->message = why;
      });
  states_.publish(ProximityResultsPtr(results));
  if (drawing->motion.robot) markers_.showState(drawing);
}

/** Is the message about the robot? */
template <class Message>
bool Pipeline::movesRobot(const Message &message) const {
  if constexpr (std::is_same_v<Message, trajectory_msgs::MultiDOFJointTrajectory>)
    return curve_proximity::movesRobot(message, live_.scene.snapshot()->robot().get(), live_.srdf);
  return !std::is_same_v<Message, Curve> && !std::is_same_v<Message, nav_msgs::Path>;
}

} // namespace curve_proximity
