/* SPDX-License-Identifier: BSD-3-Clause */
#include <curve_proximity/robust.hpp>

#include <cmath>
#include <limits>
#include <utility>

#include <curve_proximity/nearest_name.hpp>

#include "answering.h"
#include "asked_pairs.h"

namespace curve_proximity {
namespace {

/* The core's bounds refer to the lists of this. */
class CoreErrors {
 public:
  CoreErrors(const RobotMotion &motion, const ErrorBounds &given) {
    const Kinematics &kinematics = *motion.data().kinematics;
    const Robot &robot = *kinematics.robot;
    const std::size_t n = kinematics.rest.size();
    tracking_.resize(n), speed_.resize(n), acceleration_.resize(n);

    /* the joints with a value of their own */
    std::map<std::string, std::size_t> known;
    for (const Robot::Joint &joint : robot.joints()) {
      const auto variable = kinematics.variables.find(joint.name);
      if (joint.leader.empty() && variable != kinematics.variables.end())
        known.emplace(joint.name, static_cast<std::size_t>(variable->second));
    }
    for (const auto &[name, variable] : known) set(variable, given.every_joint, "every_joint");
    for (const auto &[name, errors] : given.joints) {
      const auto it = known.find(name);
      if (it == known.end())
        throw Error("the robot has no joint '" + name + "' that moves by itself" + didYouMean(name, namesOf(known)));
      set(it->second, errors, "joint '" + name + "'");
    }

    core_.tracking = tracking_.data(), core_.speed = speed_.data(), core_.acceleration = acceleration_.data();
    core_.n_variables = n;
    core_.timing = given.timing;
    core_.base_position = given.base_position, core_.base_rotation = given.base_rotation;
    core_.base_origin = toVec3(motion.linkPoses(motion.domain()[0]).at(robot.rootLink()).translation());
    core_.object_position = given.object_position, core_.object_rotation = given.object_rotation;
    core_.sensor = given.sensor, core_.flex = given.flex;
  }

  const cprox_error_bounds *get() const {
    return &core_;
  }

 private:
  void set(std::size_t variable, const JointErrors &errors, const std::string &whose) {
    for (const double value : {errors.tracking, errors.speed, errors.acceleration})
      if (!(value >= 0.0 && std::isfinite(value)))
        throw Error(whose + ": an error of " + std::to_string(value) + ", must be a finite number of at least 0");
    tracking_[variable] = errors.tracking;
    speed_[variable] = errors.speed;
    acceleration_[variable] = errors.acceleration;
  }

  std::vector<double> tracking_, speed_, acceleration_;
  cprox_error_bounds core_{};
};

void check(const Query &query, RobotPairs against) {
  std::string fault = faultInAll(against, query);
  if (query.query_type == QueryType::DISTANCE) fault = "errors are asked about by a tolerance or collision";
  if (query.options.certificate) fault = "an answer about errors has no certificate";
  if (query.moving_only) fault = "moving_only does not apply: errors move every joint";
  if (!fault.empty()) throw Error(fault);
}

} // namespace

RobustAnswer askRobust(const RobotMotion &motion, bool self, const ErrorBounds &bounds, const Query &query,
                       Workspace &workspace) {
  const Clock::time_point start = Clock::now();
  const RobotPairs against = self ? RobotPairs::SELF : RobotPairs::ENVIRONMENT;
  check(query, against);
  const CoreErrors errors(motion, bounds);
  const Asked asked = askedOf(motion, against, query);
  cprox_result result{};
  result.obstacle_index = -1;
  cprox_robust_scale scale{};
  if (asked.pairs.empty()) {
    answerNothing(query, result);
    scale.certified = scale.refused = std::numeric_limits<double>::infinity();
  } else {
    const Obstacles obstacles(asked.targets, CPROX_INDEX_NONE);
    const cprox_options options = withoutRounding(query.options, asked.rounding);
    result.status = cprox_robust_tolerance(obstacles.get(), asked.mover(), query.delta, errors.get(), &options,
                                           workspace.get(), &result);
    if (result.status < 0) throw Error(workspace.reason(), result.status);
  }
  RobustAnswer out;
  out.answer = toAnswer(asked, result, query, workspace, start);
  if (!asked.pairs.empty() && !out.answer.gap) {
    const Obstacles obstacles(asked.targets, CPROX_INDEX_NONE);
    const cprox_status status = cprox_robust_find_scale(obstacles.get(), asked.mover(), query.delta + asked.rounding,
                                                        errors.get(), &query.options, workspace.get(), &scale);
    if (status < 0) throw Error(workspace.reason(), status);
    out.answer.microseconds = microsecondsSince(start);
  }
  out.certified = out.answer.gap ? 0.0 : scale.certified;
  out.refused = out.answer.gap ? std::numeric_limits<double>::infinity() : scale.refused;
  return out;
}

} // namespace curve_proximity
