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

/* fault: what the query says against it already. */
void check(const Query &query, RobotPairs against, std::string fault) {
  if (fault.empty()) fault = faultInAll(against, query);
  if (query.options.certificate) fault = "an answer about errors has no certificate";
  if (query.moving_only) fault = "moving_only does not apply: errors move every joint";
  if (!fault.empty()) throw Error(fault);
}

} // namespace

RobustAnswer askRobust(const RobotMotion &motion, bool self, const ErrorBounds &bounds, const Query &query,
                       Workspace &workspace) {
  const Clock::time_point start = Clock::now();
  const RobotPairs against = againstOf(self);
  const bool distance = query.query_type == QueryType::DISTANCE;
  check(query, against, "");
  const CoreErrors errors(motion, bounds);
  const Asked asked = askedOf(motion, against, query);
  cprox_result result{};
  result.obstacle_index = -1;
  cprox_robust_scale scale{};
  if (asked.pairs.empty()) {
    answerNothing(query, result);
    scale.certified = scale.refused = std::numeric_limits<double>::infinity();
  } else {
    const Obstacles obstacles(asked.obstacles, CPROX_INDEX_NONE);
    const cprox_options options = withoutRounding(query.options, asked.rounding);
    result.status = distance ? cprox_robust_distance(obstacles.get(), asked.mover(), errors.get(), &options,
                                                     workspace.get(), &result)
                             : cprox_robust_tolerance(obstacles.get(), asked.mover(), query.delta, errors.get(),
                                                      &options, workspace.get(), &result);
    if (result.status < 0) throw Error(workspace.reason(), result.status);
  }
  RobustAnswer out;
  out.answer = toAnswer(asked, result, query, workspace, start);
  if (distance) {
    out.certified = out.refused = std::numeric_limits<double>::quiet_NaN();
    return out;
  }
  if (!asked.pairs.empty() && !out.answer.gap) {
    const Obstacles obstacles(asked.obstacles, CPROX_INDEX_NONE);
    const cprox_status status = cprox_robust_find_scale(obstacles.get(), asked.mover(), query.delta + asked.rounding,
                                                        errors.get(), &query.options, workspace.get(), &scale);
    if (status < 0) throw Error(workspace.reason(), status);
    out.answer.microseconds = microsecondsSince(start);
  }
  out.certified = out.answer.gap ? 0.0 : scale.certified;
  out.refused = out.answer.gap ? std::numeric_limits<double>::infinity() : scale.refused;
  return out;
}

std::vector<ClearanceInterval> robustProfile(const RobotMotion &motion, bool self, const ErrorBounds &bounds,
                                             const std::vector<double> &breaks, const Query &query,
                                             Workspace &workspace) {
  const RobotPairs against = againstOf(self);
  std::string fault = faultOfDistances(query);
  if (fault.empty()) fault = faultOfProfile(query, breaks, INFINITE);
  check(query, against, fault);
  const std::array<double, 2> domain = motion.domain();
  for (std::size_t i = 0; i < breaks.size(); ++i)
    if (!(breaks[i] >= domain[0] && breaks[i] <= domain[1]) || (i > 0 && !(breaks[i] > breaks[i - 1])))
      throw Error("break " + std::to_string(i) + " is " + std::to_string(breaks[i]) +
                  ": breaks ascend within the trajectory's time");
  const CoreErrors errors(motion, bounds);
  const Asked asked = askedOf(motion, against, query);
  std::vector<ClearanceInterval> profile = profileOfNothing(breaks);
  if (!asked.pairs.empty()) {
    const Obstacles obstacles(asked.obstacles, CPROX_INDEX_NONE);
    const auto stops = [&options = query.options] { return options.stop && options.stop(options.stop_user); };
    for (ClearanceInterval &one : profile) {
      if (stops()) { // no other search begins
        one.status = CPROX_STOPPED;
        one.lower = 0.0;
        continue;
      }
      const std::array<double, 2> interval{one.t0, one.t1};
      cprox_options options = withoutRounding(query.options, asked.rounding);
      options.interval = interval.data();
      Answer found;
      cprox_result &result = found.result;
      result.status =
          cprox_robust_distance(obstacles.get(), asked.mover(), errors.get(), &options, workspace.get(), &result);
      if (result.status < 0) throw Error(workspace.reason(), result.status);
      widen(query, asked.rounding, INFINITE, result);
      one.status = result.status;
      one.lower = result.lower, one.upper = result.upper;
      if (result.obstacle_index < 0) continue;
      one.t = result.t;
      one.witness_a = result.witness_mover, one.witness_b = result.witness_obstacle;
      nameSides(asked, query, found);
      one.a = found.a, one.b = found.b;
      if (isReplaced(query.options.max_lod, found.by_hull)) one.upper = INFINITE;
    }
  }
  applyCoverage(coverageOf(query, asked), profile);
  return profile;
}

namespace {

/* Until when no execution touches anything. What is not certified is halved. */
double certifiedUntil(const Asked &asked, const CoreErrors &errors, double resolution, const Query &query,
                      Workspace &workspace, cprox_result &total) {
  const Obstacles obstacles(asked.obstacles, CPROX_INDEX_NONE);
  const cprox_motion_info info = cprox_motion_get_info(asked.data.core.get());
  double free = info.t0, refused = INFINITE, end = info.t1;
  while (free < info.t1 && refused - free > resolution) {
    const std::array<double, 2> interval{free, end};
    cprox_options options = query.options;
    options.interval = interval.data();
    cprox_result result{};
    const cprox_status status = cprox_robust_tolerance(obstacles.get(), asked.mover(), asked.rounding, errors.get(),
                                                       &options, workspace.get(), &result);
    if (status < 0) throw Error(workspace.reason(), status);
    total.nodes += result.nodes, total.distance_queries += result.distance_queries;
    (result.verdict == CPROX_VERDICT_CLEAR ? free : refused) = end;
    if (status != CPROX_OK) total.status = status;
    if (status == CPROX_STOPPED) break;
    end = 0.5 * (free + refused);
    if (!(end > free && end < refused)) break;
  }
  return free;
}

} // namespace

Answer robustTimeOfContact(const RobotMotion &motion, bool self, const ErrorBounds &bounds, double resolution,
                           const Query &query, Workspace &workspace) {
  const Clock::time_point start = Clock::now();
  const RobotPairs against = againstOf(self);
  check(query, against, faultOfContact(query));
  if (!(resolution > 0.0)) throw Error("the resolution must be above 0");
  const CoreErrors errors(motion, bounds);
  const Asked asked = askedOf(motion, against, query);
  if (asked.pairs.empty()) return timeOfContact(motion, self, query, workspace);
  cprox_result total{};
  const double free = certifiedUntil(asked, errors, resolution, query, workspace, total);
  const bool clear = free >= motion.domain()[1];
  Answer out = timeOfContact(motion, self, query, workspace);
  cprox_result &result = out.result;
  if (result.status < 0) return out;
  result.nodes += total.nodes, result.distance_queries += total.distance_queries;
  out.microseconds = microsecondsSince(start);
  if (out.gap) return out;
  result.t_contact_lower = std::min(result.t_contact_lower, free);
  result.lower = 0.0; // of all executions, nothing more is known
  if (result.verdict == CPROX_VERDICT_CLEAR && !clear) {
    result.verdict = CPROX_VERDICT_UNDECIDED;
    if (total.status != CPROX_OK) result.status = total.status, out.status = cprox_status_name(total.status);
  }
  return out;
}

} // namespace curve_proximity
