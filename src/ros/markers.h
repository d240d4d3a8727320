/* SPDX-License-Identifier: BSD-3-Clause */
/** What RViz shows: the last query's curves coloured by clearance, its closest pairs, and the scene. */
#ifndef CURVE_PROXIMITY_ROS_MARKERS_H
#define CURVE_PROXIMITY_ROS_MARKERS_H

#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <ros/wall_timer.h>
#include <visualization_msgs/MarkerArray.h>

#include <atomic>
#include <memory>
#include <mutex>
#include <string>

#include "queries.h"

namespace curve_proximity {

/** All markers of a drawing in the fixed frame, after one that deletes what was shown before. Drawing may be null: then
 *  the scene alone. A closest pair is shown only as long as the scene is the one it was measured in.
 *
 *  The colours come from plain point distances at sampled parameters: they are for the eye; the certified answer is the
 *  closest pair and its label. */
visualization_msgs::MarkerArray toMarkers(const Snapshot &scene, const Drawing *drawing, const std::string &frame);

/** Publishes ~markers, latched, a few times a second at most and only where somebody listens. */
class MarkerPublisher {
 public:
  /** handle: its callback queue runs the timer. */
  MarkerPublisher(ros::NodeHandle &handle, const Scene &scene, const std::string &frame);

  /** What is to be shown next; never waits for what is being published. */
  void show(std::shared_ptr<const Drawing> drawing);

 private:
  void publishIfNew();

  const Scene &scene_;
  const std::string frame_;
  std::mutex mutex_;
  std::shared_ptr<const Drawing> drawing_;
  bool changed_ = true;
  std::uint64_t shown_scene_ = 0;
  ros::Publisher publisher_;
  ros::WallTimer timer_;
};

} // namespace curve_proximity
#endif
