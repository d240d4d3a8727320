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

/** Publishes on ~clearance/KIND, and for links on ~clearance/KIND/LINK. What a link carries counts in KIND alone: its
 * names come and go, and would leave topics behind. For one thread. */
class ClearanceTopics {
 public:
  /** handle: the server's private one. intervals: of a profile at most. robot: null: there is none. per_link: its links
   * have topics, too. */
  ClearanceTopics(const ros::NodeHandle &handle, std::size_t intervals, const Robot *robot, bool per_link);

  bool isWatched() const;

  /** Each interval by its two ends. begin: of the motion, and the frame. What a stamp cannot hold is left out. */
  void publish(const Profile &profile, const std_msgs::Header &begin);

 private:
  std::map<std::string, ros::Publisher> topics_; /* by name, without ~clearance/ */
};

} // namespace curve_proximity
#endif
