/* SPDX-License-Identifier: BSD-3-Clause */
/* A planning request adapter for measurements: OMPL's random numbers begin anew with each request, by the number of the
 * request. Two pipelines that are asked the same requests then get the same first plans. It stands first in the list. */
#include <atomic>

#include <moveit/planning_request_adapter/planning_request_adapter.h>
#include <ompl/util/RandomNumbers.h>
#include <pluginlib/class_list_macros.hpp>

class SeededPlans : public planning_request_adapter::PlanningRequestAdapter {
 public:
  void initialize(const ros::NodeHandle &) override {}

  std::string getDescription() const override {
    return "Seeded Plans";
  }

  bool adaptAndPlan(const PlannerFn &planner, const planning_scene::PlanningSceneConstPtr &scene,
                    const planning_interface::MotionPlanRequest &req, planning_interface::MotionPlanResponse &res,
                    std::vector<std::size_t> &) const override {
    ompl::RNG::setSeed(++requests_);
    return planner(scene, req, res);
  }

 private:
  mutable std::atomic<std::uint_fast32_t> requests_{0};
};

PLUGINLIB_EXPORT_CLASS(SeededPlans, planning_request_adapter::PlanningRequestAdapter)
