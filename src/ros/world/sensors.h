/* SPDX-License-Identifier: BSD-3-Clause */
/** What sensors see, as topics: each message takes the place of the object that the one before it made. */
#ifndef CURVE_PROXIMITY_ROS_SENSORS_H
#define CURVE_PROXIMITY_ROS_SENSORS_H

#include <foreign/octomap_msgs/Octomap.h>
#include <ros/node_handle.h>
#include <ros/subscriber.h>
#include <sensor_msgs/PointCloud2.h>

#include <chrono>
#include <curve_proximity/scene.hpp>
#include <string>
#include <vector>

#include "parameters/parameters.h"
#include "transport/log_limit.h"
#include "transport/threaded_queue.h"
#include "world/frames.h"
#include "world/live_scene.h"

namespace curve_proximity {

/** ~cloud and ~octomap. They have a queue of their own, so that what is built at the rate of a sensor takes no place
 * from the queries, which work on the snapshot before it. Of messages that come too fast the oldest are dropped.
 *
 *  A cloud without a point makes the object unknown, or with ~empty_cloud_clears takes it away; an octree without an
 *  occupied cell is an empty object. A message that cannot be used leaves the object as it was and
 *  unknown until the next one, and a warning says why.
 */
class Sensors {
 public:
  /** All are kept by reference. handle: private. */
  Sensors(const ros::NodeHandle &handle, const Parameters &parameters, LiveScene &live, const Frames &frames);

  /** No callback runs, nor will one begin, when it has ended. */
  ~Sensors();

  Sensors(const Sensors &) = delete;
  Sensors &operator=(const Sensors &) = delete;

 private:
  void takeCloud(const sensor_msgs::PointCloud2::ConstPtr &message);
  void takeOctomap(const octomap_msgs::Octomap::ConstPtr &message);
  void replace(const std::string &id, const std_msgs::Header &header, ShapeDescription shape);
  void remove(const std::string &id, const ros::Time &stamp);
  template <class Work>
  void take(const std::string &topic, const std::string &id, Work &&work);

  const Parameters &parameters_;
  LiveScene &live_;
  const Frames &frames_;
  ThreadedQueue queue_;
  ros::NodeHandle handle_; /* its callbacks go to queue_ */
  std::vector<ros::Subscriber> subscribers_;
  LogLimit log_limit_{std::chrono::seconds(5)};
};

} // namespace curve_proximity
#endif
