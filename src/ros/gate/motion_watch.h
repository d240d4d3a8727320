/* SPDX-License-Identifier: BSD-3-Clause */
/** A trajectory that runs, and whether what is left of it is still clear. */
#ifndef CURVE_PROXIMITY_ROS_MOTION_WATCH_H
#define CURVE_PROXIMITY_ROS_MOTION_WATCH_H

#include <curve_proximity/ProximityQuery.h>
#include <curve_proximity/Refusal.h>
#include <curve_proximity/SceneState.h>
#include <ros/time.h>

#include <chrono>

#include "gate/server_calls.h"

namespace curve_proximity {

class MotionWatch {
 public:
  static constexpr double PERIOD = 0.05; /**< [s] between two looks at the scene */

  /** query: about one joint trajectory. It begins now or at `stamp`, whichever is later. scene: it was clear of this.
   */
  MotionWatch(ProximityQuery query, const ros::Time &stamp, SceneState scene);

  const trajectory_msgs::JointTrajectory &trajectory() const {
    return query_.trajectories.front();
  }

  /** Its last point's time has come. */
  bool isOver() const;

  /** Asks about what is left where the scene is another one than that of the last answer, and once a second: data may
   *  have become too old. The rest begins at the last point before now. False: `refusal` says why. */
  bool isStillClear(ServerCalls &calls, Refusal &refusal);

 private:
  ProximityQuery query_;
  SceneState scene_;
  ros::Time began_;
  std::chrono::steady_clock::time_point asked_ = std::chrono::steady_clock::now();
};

} // namespace curve_proximity
#endif
