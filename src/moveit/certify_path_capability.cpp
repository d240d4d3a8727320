/* SPDX-License-Identifier: BSD-3-Clause */
/* A capability of move_group: a service that certifies trajectories which no planning pipeline has made. */
#include <moveit/move_group/move_group_capability.h>
#include <moveit/planning_scene_monitor/planning_scene_monitor.h>
#include <class_loader/class_loader.hpp>

#include "certify_path.h"

namespace curve_proximity {

class CertifyPathCapability : public move_group::MoveGroupCapability {
 public:
  CertifyPathCapability() : MoveGroupCapability("CertifyPath") {}

  void initialize() override {
    service_ = root_node_handle_.advertiseService("certify_path", &CertifyPathCapability::answer, this);
  }

 private:
  /* Without the monitor's updateFrameTransforms(): no certificate needs transforms, and it counts as an update. */
  bool answer(CertifyPath::Request &req, CertifyPath::Response &res) {
    const planning_scene_monitor::PlanningSceneMonitorPtr &monitor = context_->planning_scene_monitor_;
    const planning_scene_monitor::LockedPlanningSceneRO scene(monitor); // it cannot change
    const planning_scene::PlanningSceneConstPtr &locked = scene;
    certifyPath(req, *locked, certifier_, res);
    res.scene_stamp = monitor->getLastUpdateTime();
    return true;
  }

  Certifier certifier_;
  ros::ServiceServer service_;
};

} // namespace curve_proximity

CLASS_LOADER_REGISTER_CLASS(curve_proximity::CertifyPathCapability, move_group::MoveGroupCapability)
