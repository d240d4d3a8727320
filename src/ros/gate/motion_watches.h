/* SPDX-License-Identifier: BSD-3-Clause */
/** Trajectories that run, and whether what is left of each is still clear. */
#ifndef CURVE_PROXIMITY_ROS_MOTION_WATCHES_H
#define CURVE_PROXIMITY_ROS_MOTION_WATCHES_H

#include <curve_proximity/ProximityQuery.h>
#include <curve_proximity/Refusal.h>
#include <ros/node_handle.h>
#include <ros/subscriber.h>
#include <ros/time.h>
#include <ros/wall_timer.h>
#include <sensor_msgs/JointState.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "gate/server_calls.h"
#include "gate/trajectory_progress.h"
#include "parameters/parameters.h"
#include "transport/threaded_queue.h"

namespace curve_proximity {

/** One trajectory that runs. What the robot tells of its joints says where on it the robot is. */
class MotionWatch {
 public:
  /** Called once, by a thread of MotionWatches: why the motion must end. */
  using Stop = std::function<void(Refusal)>;

  /** query: about one joint trajectory. It begins now or at its stamp, whichever is later. scene: it was clear of this.
   *  continuous: as of TrajectoryProgress. */
  MotionWatch(ProximityQuery query, SeenScene scene, const GateParameters &parameters,
              const std::set<std::string> &continuous, Stop stop);

  const trajectory_msgs::JointTrajectory &trajectory() const {
    return progress_.trajectory();
  }

  /** The joints at `stamp` (0: now), of which others may be among them. What does not name all is not counted. */
  void tell(const std::vector<std::string> &names, const std::vector<double> &positions, ros::Time stamp);

  /** The robot is at its end, and the last point's time has come. */
  bool isOver() const;

  /** Why there is doubt without a question: the robot has not told where it is, or is elsewhere, or ROS time has gone
   *  back. "": there is none. */
  std::string doubt();

 private:
  friend class MotionWatches;

  /** Asks about what is left where the scene is another one than that of the last answer, and once a second: data may
   *  have become too old. False: `refusal` says why. */
  bool isStillClear(ServerCalls &calls, Refusal &refusal);

  /** From the last point before the robot on, as a trajectory whose time 0 is now: objects that move do so on that
   *  clock. Before its beginning: all of it, by its stamp. */
  trajectory_msgs::JointTrajectory rest() const;

  /** Calls the stop, the first time. */
  void stop(Refusal refusal);

  const ros::Time began_;
  const double patience_; /* [s] without a word of the robot */
  const Stop stop_;
  std::atomic<bool> stopped_{false};
  ProximityQuery query_; /* of the one thread that asks, as are the next two */
  SeenScene scene_;
  std::chrono::steady_clock::time_point asked_ = std::chrono::steady_clock::now();
  mutable std::mutex mutex_; /* of what follows */
  TrajectoryProgress progress_;
  ros::Time told_, latest_; /* when the robot was on it; the latest time that was seen */
  std::string elsewhere_;   /* why the robot is not on the trajectory */
};

/** Hears ~joint_states for all of them. Looks at all of them 20 times a second, by a queue of its own: what else the
 * gate asks does not wait for it, nor it for that. A second timer ends the motions where the server has kept the first
 * one waiting for ~server_timeout. */
class MotionWatches {
 public:
  static constexpr double PERIOD = 0.05; /**< [s] between two looks at the scene */

  /** proofs: as of ServerCalls. */
  MotionWatches(const ros::NodeHandle &handle, const GateParameters &parameters, const ProofCheck *proofs);

  /** Nothing is stopped any more. */
  ~MotionWatches();

  MotionWatches(const MotionWatches &) = delete;
  MotionWatches &operator=(const MotionWatches &) = delete;

  /** The continuous joints of the robot description; none where there is no description. */
  const std::set<std::string> &continuous() const {
    return continuous_;
  }

  void add(std::shared_ptr<MotionWatch> watch);

  /** Its stop may be under way. */
  void remove(const std::shared_ptr<MotionWatch> &watch);

  /** Removes those that move one of the joints; an empty list is all. */
  void forget(const std::vector<std::string> &joints);

  /** The trajectory as it will run: a controller that is given a first point at a later time than 0 begins where the
   *  robot is. Throws Error where the robot is known not to be where the trajectory begins, and where it would begin is
   *  not known. */
  trajectory_msgs::JointTrajectory fromHere(trajectory_msgs::JointTrajectory trajectory) const;

 private:
  std::vector<std::shared_ptr<MotionWatch>> all() const;
  void tell(const sensor_msgs::JointState &state);
  void look();
  void supervise();

  const GateParameters parameters_;
  const std::set<std::string> continuous_;
  ServerCalls calls_;
  ros::Subscriber states_;
  mutable std::mutex mutex_;
  std::list<std::shared_ptr<MotionWatch>> watches_;
  std::map<std::string, std::pair<double, ros::Time>> joints_; /* of ~joint_states: the latest of each, and when */
  std::atomic<std::chrono::steady_clock::time_point> looked_{std::chrono::steady_clock::now()};
  ThreadedQueue queue_; /* of the timers, at once */
  ros::WallTimer looking_, supervising_;
};

} // namespace curve_proximity
#endif
