/* SPDX-License-Identifier: BSD-3-Clause */
/** What RViz shows: the scene, the last curves and the last trajectory that were asked about, coloured by clearance,
 * and their closest pairs. */
#ifndef CURVE_PROXIMITY_ROS_MARKERS_H
#define CURVE_PROXIMITY_ROS_MARKERS_H

#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <ros/wall_timer.h>

#include <memory>
#include <mutex>
#include <string>

#include "queries/queries.h"

namespace curve_proximity {

/** Where the mesh files of the objects and of the robot are. */
struct MarkerResources {
  ResourceOptions objects, robot;
};

/** Publishes ~markers, latched, a few times a second at most: all in the fixed frame, after one that deletes what was
 *  shown before. Where nobody listens nothing is drawn, and no drawing is kept: it would hold the scene that it was made
 *  in. By namespace:
 *    scene    the objects
 *    curves   the curves, coloured by clearance: tubes of their radius
 *    robot    the robot: along a trajectory at its closest moment, each link coloured by its clearance from the objects
 *    swept    the robot on its way
 *    sweep    the way of the point of the robot that comes closest
 *    pairs    the closest pairs, each a line with its ends; labels: how long they are
 *  Pairs are shown only as long as the scene is the one they were measured in.
 *
 *  Colours come from plain distances at sampled parameters: they are for the eye. The certified answers are the pairs
 * with their labels. */
class MarkerPublisher {
 public:
  /** handle: its callback queue runs the timer. scene: kept by reference. */
  MarkerPublisher(ros::NodeHandle &handle, const Scene &scene, const std::string &frame, MarkerResources resources);

  /** What is to be shown next: its curves in the place of the last ones, its motion in that of the last one. Never
   * waits for what is being published. */
  void show(std::shared_ptr<const Drawing> drawing);

  /** The robot as it stands: shown as long as there is no motion. */
  void showState(std::shared_ptr<const Drawing> drawing);

  /** Does anybody listen? */
  bool isWatched() const {
    return publisher_.getNumSubscribers() > 0;
  }

 private:
  void publishIfNew();

  const Scene &scene_;
  const std::string frame_;
  const MarkerResources resources_;
  std::mutex mutex_;
  std::shared_ptr<const Drawing> curves_, motion_, state_;
  bool changed_ = true;
  std::uint64_t shown_scene_ = 0;
  ros::Publisher publisher_;
  ros::WallTimer timer_;
};

} // namespace curve_proximity
#endif
