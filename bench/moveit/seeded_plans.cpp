/* SPDX-License-Identifier: BSD-3-Clause */
/* A planning request adapter for measurements: the random numbers of OMPL and MoveIt begin anew with each request, by the
 * number of the request. Two pipelines that are asked the same requests then get the same first plans. It stands first
 * in the list. */
#include <atomic>

#include <moveit/planning_request_adapter/planning_request_adapter.h>
#include <ompl/util/RandomNumbers.h>
#include <pluginlib/class_list_macros.hpp>

#include "seeded_numbers.h"

constexpr unsigned int BETWEEN = 10000; /* seeds of two requests: a request takes some */

class SeededPlans : public planning_request_adapter::PlanningRequestAdapter {
 public:
  void initialize(const ros::NodeHandle &) override {}

  std::string getDescription() const override {
    return "Seeded Plans";
  }

  bool adaptAndPlan(const PlannerFn &planner, const planning_scene::PlanningSceneConstPtr &scene,
                    const planning_interface::MotionPlanRequest &req, planning_interface::MotionPlanResponse &res,
                    std::vector<std::size_t> &) const override {
    const unsigned int seed = BETWEEN * ++requests_;
    ompl::RNG::setSeed(seed);
    seedNumbers(seed);
    return planner(scene, req, res);
  }

 private:
  mutable std::atomic<unsigned int> requests_{0};
};

PLUGINLIB_EXPORT_CLASS(SeededPlans, planning_request_adapter::PlanningRequestAdapter)
