/* SPDX-License-Identifier: BSD-3-Clause */
/** Trajectories in by topic, results out by topic: the server as a stage between a planner and a controller. */
#ifndef CURVE_PROXIMITY_ROS_PIPELINE_H
#define CURVE_PROXIMITY_ROS_PIPELINE_H

#include <curve_proximity/ProximityResults.h>
#include <ros/node_handle.h>
#include <ros/wall_timer.h>

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "markers/markers.h"
#include "messages/clearance_topics.h"
#include "moveit/moveit_messages.h"
#include "parameters/parameters.h"
#include "queries/queries.h"
#include "transport/job_queue.h"
#include "transport/log_limit.h"
#include "transport/threaded_queue.h"

namespace curve_proximity {

/** Answers what comes on ~curve, ~trajectory, ~multi_dof_trajectory, ~path, ~robot_trajectory and ~display_trajectory,
 * one message after the other, on ~proximity, and tells contacts on ~contacts. Messages are taken and results handed on
 * by pointer: within one nodelet manager nothing is copied. While one message is being answered ~queue_size others
 * wait; what is older than these is dropped and counted. With ~profile_intervals the clearance profile follows on
 * ~clearance. With ~state_rate it also tells on ~state_proximity how close the robot is as it stands. */
class Pipeline {
 public:
  /** handle: the server's private one. All are kept by reference. stop: as that of Queries. */
  Pipeline(const ros::NodeHandle &handle, const Parameters &parameters, const Tuning &tuning, LiveScene &live,
           Queries &queries, MarkerPublisher &markers, const std::atomic<bool> &stop);

  /** A query that runs must have been told to stop. */
  ~Pipeline();

  std::uint64_t dropped() const {
    return queue_.dropped();
  }

 private:
  template <class Message>
  void listen(const char *topic);
  template <class Message>
  void handle(const char *topic, const Message &message);
  void describe(ProximityResults &results) const;
  void answer(const QueryRequest &request, ProximityResults &results, Drawing &drawing);
  using Ask = std::function<void(const QueryRequest &)>;
  template <class Message>
  void requestOfMotions(const Message &message, ProximityQuery &more, ProximityResults &results, const Ask &ask);
  void tellContacts(const ProximityResults &results);
  void tellClearance(const QueryRequest &request, const ProximityResults &results);
  void tellState();

  template <class Message>
  bool movesRobot(const Message &message) const;

  const Parameters &parameters_;
  const Tuning &tuning_;
  LiveScene &live_;
  Queries &queries_;
  MarkerPublisher &markers_;
  const std::atomic<bool> &stop_;
  const QueryType query_type_;
  JobQueue queue_;
  ros::NodeHandle handle_;
  ros::Publisher results_, contacts_;
  std::unique_ptr<ClearanceTopics> clearance_; /* null: without ~profile_intervals */
  LogLimit log_limit_{std::chrono::seconds(60)};
  ThreadedQueue state_queue_; /* it waits for no message; what has callbacks on it ends before it */
  ros::NodeHandle state_handle_;
  ros::Publisher states_;
  ros::WallTimer state_timer_;
  std::uint32_t state_seq_ = 0;
  std::vector<ros::Subscriber> subscribers_;
};

} // namespace curve_proximity
#endif
