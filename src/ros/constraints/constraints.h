/* SPDX-License-Identifier: BSD-3-Clause */
/** ~evaluate_constraints between its request and its response, and ~constraint_providers. */
#ifndef CURVE_PROXIMITY_ROS_CONSTRAINTS_H
#define CURVE_PROXIMITY_ROS_CONSTRAINTS_H

#include <curve_proximity/EvaluateConstraints.h>
#include <ros/node_handle.h>

#include <curve_proximity/scene.hpp>
#include <memory>
#include <string>
#include <vector>

#include "../../providers/constraint_case.h"
#include "../../providers/provider_set.h"
#include "parameters/parameters.h"
#include "queries/surroundings.h"
#include "queries/time_budget.h"
#include "transport/workspaces.h"
#include "world/frames.h"
#include "world/live_scene.h"

namespace curve_proximity {

/** The providers of a node. */
class Constraints {
 public:
  /** Loads those of parameters.constraint_providers. Throws ParameterError, naming the parameter, for a type that no
   * package declares and for parameters that a provider refuses. A plugin that does not load, or throws, is told by
   * name on the log and in every answer; the others go on. All is kept by reference. */
  Constraints(const Parameters &parameters, const LiveScene &live, const Frames &frames, const FurtherRobots &robots);

  /** Throws Error where nothing can be answered at all; what is wrong with one case or provider becomes its row, and so
   * does what is not begun when the budget is over. */
  void answer(const EvaluateConstraints::Request &request, EvaluateConstraints::Response &response,
              const TimeBudget &budget, Turn *turn);

  /** A message for each provider that failed to load. */
  std::vector<std::string> failures() const;

 private:
  struct Work;
  std::size_t checkLimits(const EvaluateConstraints::Request &request) const; /* bytes */
  ConstraintCase toCase(const ConstraintQuery &message, Work &work) const;
  Eigen::Isometry3d linkPose(const ConstraintQuery &message, const std::string &link, LinkPoses &poses,
                             Work &work) const;
  MotionCase toMotionCase(const ConstraintQuery &message, Work &work) const;
  void gatherOthers(const ConstraintQuery &message, MotionCase &out, Work &work) const;

  const Parameters &parameters_;
  const LiveScene &live_;
  const Frames &frames_;
  const FurtherRobots &robots_;
  std::unique_ptr<ProviderSet> providers_;
  WorkspacePool workspaces_;
};

} // namespace curve_proximity
#endif
