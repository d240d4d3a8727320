/* SPDX-License-Identifier: BSD-3-Clause */
/** Clearance profiles as topics of stamped numbers, which rqt_plot and PlotJuggler draw as they are. */
#ifndef CURVE_PROXIMITY_ROS_CLEARANCE_TOPICS_H
#define CURVE_PROXIMITY_ROS_CLEARANCE_TOPICS_H

#include <curve_proximity/Profile.h>
#include <ros/node_handle.h>
#include <std_msgs/Header.h>

#include <curve_proximity/robot.hpp>
#include <map>
#include <string>

namespace curve_proximity {

/** Publishes on ~clearance/KIND, and with links on ~clearance/KIND/LINK. For one thread. */
class ClearanceTopics {
 public:
  /** handle: the server's private one. intervals: of a profile at most. robot: whose links have topics from the start;
   * null: none. */
  ClearanceTopics(const ros::NodeHandle &handle, std::size_t intervals, const Robot *robot);

  bool isWatched() const;

  /** Each interval by its two ends. begin: of the motion, and the frame. What a stamp cannot hold is left out. */
  void publish(const Profile &profile, const std_msgs::Header &begin);

 private:
  ros::Publisher &topic(const std::string &name);

  ros::NodeHandle handle_;
  const std::uint32_t queue_size_;
  std::map<std::string, ros::Publisher> topics_; /* by name, without ~clearance/ */
};

} // namespace curve_proximity
#endif
