/* SPDX-License-Identifier: BSD-3-Clause */
/* Loaded by name: the parameter ~collision_detector of move_group. */
#include <moveit/collision_detection/collision_plugin.h>
#include <pluginlib/class_list_macros.hpp>

#include "collision_env.h"

namespace curve_proximity {

class CollisionPlugin : public collision_detection::CollisionPlugin {
 public:
  bool initialize(const planning_scene::PlanningScenePtr &scene, bool exclusive) const override {
    try {
      scene->setActiveCollisionDetector(CollisionDetectorAllocatorCurveProximity::create(), exclusive);
    } catch (const std::exception &error) {
      ROS_ERROR_STREAM_NAMED("collision_detection.curve_proximity",
                             "robot '" << scene->getRobotModel()->getName() << "': " << error.what());
      return false;
    }
    return true;
  }
};

} // namespace curve_proximity

PLUGINLIB_EXPORT_CLASS(curve_proximity::CollisionPlugin, collision_detection::CollisionPlugin)
