/* SPDX-License-Identifier: BSD-3-Clause */
#include "gate/motion_watches.h"

#include <algorithm>
#include <cstdint>
#include <curve_proximity/core.hpp>
#include <sstream>
#include <utility>

#include "../../scene/motion/trajectory_points.h"
#include "transport/checked_stream.h"
#include "transport/guard.h"

namespace curve_proximity {
namespace {

using std::chrono::steady_clock;
using trajectory_msgs::JointTrajectory;

constexpr std::chrono::seconds AT_LEAST{1};
constexpr std::uint32_t SCENE_QUEUE = 10;

std::set<std::string> continuousJoints(const ros::NodeHandle &handle) {
  std::set<std::string> out;
  std::string name, urdf;
  if (!handle.searchParam("robot_description", name) || !handle.getParam(name, urdf)) return out;
  guarded([&] { out = continuousJoints(urdf); },
          [&](const std::string &why) { logGateError("the URDF in '" + name + "': " + why); });
  return out;
}

} // namespace

/* ---- one ---- */

MotionWatch::MotionWatch(ProximityQuery query, SeenScene scene, const GateParameters &parameters,
                         const std::set<std::string> &continuous, Stop stop)
    : began_(std::max(ros::Time::now(), query.trajectories.front().header.stamp)),
      patience_(parameters.feedback_timeout),
      stop_(std::move(stop)),
      query_(std::move(query)),
      scene_(std::move(scene)),
      progress_(query_.trajectories.front(), parameters.path_tolerance, continuous),
      told_(began_) {}

void MotionWatch::tell(const std::vector<std::string> &names, const std::vector<double> &positions, ros::Time stamp) {
  const ros::Time now = ros::Time::now();
  if (stamp.isZero() || stamp > now) stamp = now;
  if (stamp < began_) return;
  const std::lock_guard<std::mutex> lock(mutex_);
  for (const std::string &joint : trajectory().joint_names)
    if (std::find(names.begin(), names.end(), joint) == names.end()) return;
  const std::string why = progress_.tell(names, positions, std::max(0.0, (stamp - told_).toSec()));
  elsewhere_ = why;
  if (why.empty()) told_ = std::max(told_, stamp);
}

bool MotionWatch::isOver() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return progress_.isAtEnd() && ros::Time::now() > began_ + trajectory().points.back().time_from_start;
}

std::string MotionWatch::doubt() {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!elsewhere_.empty()) return elsewhere_;
  const ros::Time now = ros::Time::now();
  latest_ = std::max(latest_, now);
  const double silence = (now - told_).toSec(), back = (latest_ - now).toSec();
  std::ostringstream text;
  text.precision(3);
  if (back > patience_) {
    text << "ROS time has gone back by " << back << " s";
    return text.str();
  }
  if (silence <= patience_) return "";
  text << "the robot has not told where its joints are for " << silence
       << " s, longer than ~feedback_timeout = " << patience_;
  return text.str();
}

JointTrajectory MotionWatch::rest() const {
  std::size_t first;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    first = progress_.point();
  }
  const auto &points = trajectory().points;
  const ros::Duration elapsed = ros::Time::now() - began_;
  JointTrajectory rest = trajectory();
  if (elapsed <= ros::Duration(0)) return rest;
  const ros::Duration next = points[std::min(first + 1, points.size() - 1)].time_from_start;
  const ros::Duration now = std::max(points[first].time_from_start, std::min(elapsed, next));
  rest.header.stamp = ros::Time();
  rest.points.erase(rest.points.begin(), rest.points.begin() + static_cast<std::ptrdiff_t>(first));
  for (auto &point : rest.points) point.time_from_start -= now;
  return rest;
}

bool MotionWatch::isStillClear(ServerCalls &calls, Refusal &refusal) {
  const auto now = steady_clock::now();
  const bool recent = now - asked_ < AT_LEAST;
  const auto left = [&]() -> const ProximityQuery & {
    asked_ = now;
    query_.trajectories.front() = rest();
    return query_;
  };
  return calls.isStillClear(left, recent, scene_, refusal);
}

void MotionWatch::stop(Refusal refusal) {
  if (stopped_.exchange(true)) return;
  refusal.cancelled = true;
  guarded([&] { stop_(std::move(refusal)); }, logGateError);
}

/* ---- all ---- */

MotionWatches::MotionWatches(const ros::NodeHandle &handle, const GateParameters &parameters, const ProofCheck *proofs)
    : parameters_(parameters),
      continuous_(continuousJoints(handle)),
      calls_(handle, parameters.server, parameters.delta, proofs),
      queue_(2) {
  ros::NodeHandle own = handle;
  ros::SubscribeOptions states = checkedSubscription<sensor_msgs::JointState>(
      "joint_states", SCENE_QUEUE, [this](const auto &state) { guarded([&] { tell(*state); }, logGateError); });
  states_ = own.subscribe(states);
  own.setCallbackQueue(&queue_);
  const ros::WallDuration period(PERIOD);
  looking_ =
      own.createWallTimer(period, [this](const ros::WallTimerEvent &) { guarded([&] { look(); }, logGateError); });
  supervising_ =
      own.createWallTimer(period, [this](const ros::WallTimerEvent &) { guarded([&] { supervise(); }, logGateError); });
  queue_.start();
}

MotionWatches::~MotionWatches() {
  states_.shutdown();
  calls_.end();
  looking_.stop();
  supervising_.stop();
  queue_.end();
}

void MotionWatches::add(std::shared_ptr<MotionWatch> watch) {
  const std::lock_guard<std::mutex> lock(mutex_);
  watches_.push_back(std::move(watch));
}

void MotionWatches::remove(const std::shared_ptr<MotionWatch> &watch) {
  const std::lock_guard<std::mutex> lock(mutex_);
  watches_.remove(watch);
}

void MotionWatches::forget(const std::vector<std::string> &joints) {
  const std::lock_guard<std::mutex> lock(mutex_);
  watches_.remove_if([&](const std::shared_ptr<MotionWatch> &one) {
    const auto &others = one->trajectory().joint_names;
    return joints.empty() ||
           std::find_first_of(others.begin(), others.end(), joints.begin(), joints.end()) != others.end();
  });
}

std::vector<std::shared_ptr<MotionWatch>> MotionWatches::all() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return {watches_.begin(), watches_.end()};
}

void MotionWatches::tell(const sensor_msgs::JointState &state) {
  const ros::Time now = ros::Time::now();
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    const std::size_t n = std::min(state.name.size(), state.position.size());
    for (std::size_t i = 0; i < n; ++i)
      joints_[state.name[i]] = {state.position[i],
                                state.header.stamp.isZero() ? now : std::min(now, state.header.stamp)};
  }
  for (const auto &watch : all()) watch->tell(state.name, state.position, state.header.stamp);
}

JointTrajectory MotionWatches::fromHere(JointTrajectory trajectory) const {
  const ros::Time now = ros::Time::now();
  JointPositions here;
  std::string unknown;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    for (const std::string &joint : trajectory.joint_names) {
      const auto found = joints_.find(joint);
      if (found == joints_.end() || found->second.second > now || // ROS time has gone back since then
          now - found->second.second > ros::Duration(parameters_.feedback_timeout))
        unknown = joint;
      else
        here[joint] = found->second.first;
    }
  }
  if (trajectory.points.front().time_from_start > ros::Duration(0)) {
    if (!beginAt(here, trajectory.joint_names, trajectory.points))
      throw Error(
          "the first point is not at time 0, and where the robot begins is not known: ~joint_states does not "
          "tell of joint '" +
          unknown + "'");
  } else if (unknown.empty() && trajectory.header.stamp <= now) {
    JointTrajectory start = trajectory;
    start.points.resize(1);
    std::vector<double> positions;
    for (const std::string &joint : trajectory.joint_names) positions.push_back(here.at(joint));
    const std::string why =
        TrajectoryProgress(start, parameters_.path_tolerance, continuous_).tell(trajectory.joint_names, positions, 0.0);
    if (!why.empty()) throw Error(why);
  }
  return trajectory;
}

void MotionWatches::look() {
  looked_ = steady_clock::now();
  for (const auto &watch : all()) {
    Refusal refusal;
    if (watch->stopped_ || watch->isOver()) {
      remove(watch);
    } else if (!watch->isStillClear(calls_, refusal)) {
      watch->stop(std::move(refusal));
      remove(watch);
    }
    looked_ = steady_clock::now();
  }
}

/* What the robot tells needs no server; and the server may keep the other thread waiting. */
void MotionWatches::supervise() {
  const std::chrono::duration<double> silence = steady_clock::now() - looked_.load();
  const bool silent = silence.count() > parameters_.server_timeout;
  for (const auto &watch : all()) {
    const std::string why = silent ? "the server has not answered for ~server_timeout" : watch->doubt();
    if (why.empty() || watch->isOver()) continue;
    watch->stop(refusalBecause(why, SceneState()));
    remove(watch);
  }
}

} // namespace curve_proximity
