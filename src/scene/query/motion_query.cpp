/* SPDX-License-Identifier: BSD-3-Clause */
/* Queries about a robot in motion, and their answers by name. */
#include <algorithm>
#include <limits>
#include <set>

#include "answering.h"
#include "asked_pairs.h"
#include "near_items.h"
#include "proving.h"

namespace curve_proximity {
namespace {

Answer answerOf(const Asked &asked, const Query &query, Workspace &workspace) {
  const Clock::time_point start = Clock::now();
  cprox_result result{};
  result.obstacle_index = -1;
  if (asked.pairs.empty()) {
    answerNothing(query, result);
  } else {
    cprox_options options = withoutRounding(query.options, asked.rounding);
    options.certificate = nullptr;
    result.status = askCore(query, options, asked.mover(), asked.obstacles, workspace, result);
  }
  Answer answer = toAnswer(asked, result, query, workspace, start);
  if (!query.options.certificate) return answer;
  if (!asked.pairs.empty() && result.status >= 0) widen(query, asked.rounding, INFINITE, result);
  leaveProof(query, asked.mover(), asked.obstacles, result, workspace, answer);
  return answer;
}

/* Against the items of a verdict that matter; where nothing of these can be asked about, against all. */
Asked askedNear(const RobotMotion::Data &data, const std::vector<std::size_t> &items, const Query &query,
                Workspace &workspace) {
  NearItems near = nearItems(data, items, query, workspace);
  if (near.items.size() == items.size()) return askedItems(data, items, query);
  Asked asked = askedItems(data, std::move(near.items), query);
  if (asked.pairs.empty()) return askedItems(data, items, query);
  asked.left_out = near.left_out;
  return asked;
}

/* A time no later than `t` before which the geometries, moved by their rounding, do not touch either. Steps back from
 * t, each time farther, until the clearance before is proven to be more than the rounding. */
double beforeRounding(const Asked &asked, double t, const cprox_options &options, Workspace &workspace) {
  const double start = cprox_motion_get_info(asked.data.core.get()).t0;
  constexpr double GROWTH = 16.0;
  for (double step = 1e-15 * std::max(1.0, t - start); t - step > start; step *= GROWTH) {
    cprox_options fine = options;
    fine.epsilon = asked.rounding;
    fine.relative_epsilon = 0.5;
    fine.certificate = nullptr;
    const std::array<double, 2> breaks{start, t - step};
    cprox_profile_interval interval{};
    const cprox_status status =
        cprox_obstacles_profile(nullptr, asked.mover(), breaks.data(), 1, INFINITE, &fine, workspace.get(), &interval);
    if (status < 0) return start;
    if (interval.lower > asked.rounding) return t - step;
  }
  return start;
}

/* The core's answer to the time of contact, true of geometries as rounding may have moved them. */
void searchContact(const Asked &asked, const Query &query, Workspace &workspace, cprox_result &result) {
  std::vector<cprox_obstacle> obstacles = asked.obstacles;
  for (cprox_obstacle &obstacle : obstacles) obstacle.margin += asked.rounding;
  searchContact(asked.mover(), obstacles, query, workspace, result);
  const bool touches = result.status >= 0 && !(result.lower > asked.rounding);
  if (asked.against == RobotPairs::SELF && touches && asked.rounding > 0.0)
    result.t_contact_lower = beforeRounding(asked, result.t_contact_lower, query.options, workspace);
}

} // namespace

std::vector<Answer> askEnvironment(const RobotMotion &motion, const Query &query, Workspace &workspace) {
  const RobotMotion::Data &data = motion.data();
  cprox_certificate_clear(query.options.certificate);
  const std::string fault = faultOfMotion(query, false);
  if (!fault.empty()) return {refusal(data.id, "environment", fault)};
  const std::vector<std::size_t> named = namedItems(data, query.objects);
  if (!query.per_object || named.empty()) return {answerOf(askedNear(data, named, query, workspace), query, workspace)};

  /* one for each run of items of the same object */
  const std::vector<Item> &items = data.snapshot->world().items();
  std::vector<Answer> answers;
  std::vector<std::size_t> wanted;
  for (std::size_t i = 0; i < named.size(); ++i) {
    wanted.push_back(named[i]);
    if (i + 1 < named.size() && items[named[i + 1]].owner == items[named[i]].owner) continue;
    const bool ended = !answers.empty() && query.options.stop && query.options.stop(query.options.stop_user);
    if (ended) {
      answers.push_back(unasked(data.id, "environment", query));
      applyCoverage(coverageOf(query, data.coverage, ""), query, answers.back());
    } else {
      answers.push_back(answerOf(askedItems(data, wanted, query), query, workspace));
    }
    answers.back().b = *items[named[i]].owner;
    wanted.clear();
  }
  return answers;
}

Answer askSelf(const RobotMotion &motion, const Query &query, Workspace &workspace) {
  cprox_certificate_clear(query.options.certificate);
  const std::string fault = faultInAll(RobotPairs::SELF, query);
  if (!fault.empty()) return refusal(motion.data().id, "self", fault);
  return answerOf(askedSelf(motion.data(), query), query, workspace);
}

Answer timeOfContact(const RobotMotion &motion, bool self, const Query &query, Workspace &workspace) {
  const Clock::time_point start = Clock::now();
  cprox_certificate_clear(query.options.certificate);
  std::string fault = faultOfContact(query);
  if (fault.empty()) fault = faultInAll(againstOf(self), query);
  if (!fault.empty()) return refusal(motion.data().id, self ? "self" : "environment", fault);
  const RobotMotion::Data &data = motion.data();
  const Asked asked =
      self ? askedSelf(data, query) : askedNear(data, namedItems(data, query.objects), query, workspace);
  cprox_result result{};
  result.obstacle_index = -1;
  if (asked.pairs.empty()) {
    answerNothing(query, result);
    result.t_contact_lower = motion.domain()[1];
  } else {
    searchContact(asked, query, workspace, result);
  }
  Answer answer = toAnswer(asked, result, query, workspace, start);
  if (query.options.certificate && !asked.pairs.empty())
    leaveContactProof(query, asked.mover(), asked.obstacles, result, workspace, answer);
  return answer;
}

std::vector<std::string> movingNames(const RobotMotion &motion) {
  std::set<std::string> names;
  for (const MovingGeometry &geometry : motion.data().kinematics->geometries) names.insert(geometry.owner());
  return {names.begin(), names.end()};
}

std::vector<std::string> askedNames(const RobotMotion &motion, bool self, bool moving_only) {
  const RobotMotion::Data &data = motion.data();
  const std::vector<MovingGeometry> &geometries = data.kinematics->geometries;
  std::set<std::string> names;
  if (self) {
    for (std::size_t i = 0; i < data.self.size(); ++i) {
      if (moving_only && !data.self_moves[i]) continue;
      for (const std::int32_t side : {data.self[i].geometry, data.self[i].other})
        names.insert(geometries[static_cast<std::size_t>(side)].owner());
    }
    return {names.begin(), names.end()};
  }
  for (std::size_t i = 0; i < geometries.size(); ++i) {
    const bool asked = data.wanted[i] && !data.prepared->environment[i].empty();
    if (asked && (!moving_only || data.moves[i])) names.insert(geometries[i].owner());
  }
  return {names.begin(), names.end()};
}

std::string describeQuery(const RobotMotion &motion, bool self, const Query &query) {
  const Asked asked = askedOf(motion, againstOf(self), query);
  if (asked.pairs.empty()) return {};
  std::vector<std::string> names;
  for (const std::size_t item : asked.items) names.push_back(*asked.data.snapshot->world().items()[item].owner);
  return describeQuery(asked.mover(), asked.obstacles, names, motion.data().id + (self ? ".self" : ".environment"));
}

std::vector<std::string> unprovable(const RobotMotion &motion, bool self, const Query &query) {
  const Asked asked = askedOf(motion, againstOf(self), query);
  std::vector<std::string> messages;
  const auto look = [&](const std::string &who, const cprox_body *body, bool moves) {
    const std::string message = unprovable(who, cprox_obstacle_at(body, CPROX_POSE_IDENTITY), moves);
    if (!message.empty()) messages.push_back(message);
  };
  for (const MovingGeometry &geometry : asked.data.kinematics->geometries)
    if (!geometry.within)
      look((geometry.attached ? "object '" : "link '") + geometry.owner() + "'", geometry.body, true);
  for (std::size_t i = 0; i < asked.items.size(); ++i)
    look("object '" + *asked.data.snapshot->world().items()[asked.items[i]].owner + "'", asked.obstacles[i].body,
         false);
  return messages;
}

std::vector<Answer> nearestPairs(const RobotMotion &motion, bool self, const PairLimits &limits, const Query &query,
                                 Workspace &workspace) {
  const Clock::time_point start = Clock::now();
  checkDistances(againstOf(self), query);
  const Asked asked = askedOf(motion, againstOf(self), query);
  const Coverage coverage = coverageOf(query, asked);
  Answer nothing;
  nothing.id = asked.data.id, nothing.kind = self ? "self" : "environment";
  std::vector<Answer> answers;
  if (asked.pairs.empty()) {
    applyCoverage(coverage, query, nothing, answers);
    return answers;
  }
  const cprox_options options = withoutRounding(query.options, asked.rounding);
  std::vector<cprox_result> results(std::min(limits.count, asked.pairs.size()));
  cprox_listed listed{};
  const Obstacles obstacles(asked.obstacles, CPROX_INDEX_NONE);
  const cprox_status status = cprox_obstacles_nearest_pairs(obstacles.get(), asked.mover(), limits.count, limits.within,
                                                            &options, workspace.get(), results.data(), &listed);
  if (status < 0) throw Error(workspace.reason(), status);
  for (std::size_t i = 0; i < listed.count; ++i)
    answers.push_back(toAnswer(asked, results[i], query, workspace, start));
  Unlisted unlisted;
  unlisted.add(status, listed, asked.rounding);
  unlisted.addRow(limits, query.options, asked.data.id, self ? "self" : "environment", answers);
  if (answers.empty())
    applyCoverage(coverage, query, nothing, answers);
  else if (answers.back().is_unlisted)
    applyCoverage(coverage, query, answers.back());
  return answers;
}

std::vector<ClearanceInterval> clearanceProfile(const RobotMotion &motion, bool self, const std::vector<double> &breaks,
                                                const Query &query, Workspace &workspace, double horizon) {
  checkDistances(againstOf(self), withoutCertificate(query));
  const std::string fault = faultOfProfile(query, breaks, horizon);
  if (!fault.empty()) throw Error(fault);
  const Asked asked = askedOf(motion, againstOf(self), query);
  std::vector<ClearanceInterval> profile = searchProfile(asked.stated(query), breaks, horizon, query, workspace);
  applyCoverage(coverageOf(query, asked), profile);
  return profile;
}

} // namespace curve_proximity
