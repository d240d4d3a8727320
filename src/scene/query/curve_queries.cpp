/* SPDX-License-Identifier: BSD-3-Clause */
/* Queries of a curve that have several answers, or a time: nearest pairs, clearance profile, time of contact. */
#include <algorithm>
#include <chrono>
#include <limits>

#include <curve_proximity/query.hpp>

#include "answering.h"
#include "proving.h"
#include "scene_obstacles.h"
#include "second_opinion.h"

namespace curve_proximity {
namespace {

Answer answerOf(const CompiledCurve &curve, const cprox_result &result, Clock::time_point start) {
  Answer answer;
  answer.id = answer.a = curve.id;
  answer.result = result;
  answer.microseconds = microsecondsSince(start);
  return answer;
}

void requireDistances(const Query &query) {
  const std::string fault = faultOfDistances(query);
  if (!fault.empty()) throw Error(fault);
  if (query.per_object) throw Error("per_object does not apply: there is no answer for each object here");
  if (query.delta != 0.0) throw Error(faultOf(query));
}

Coverage coverageOf(const Query &query, const SceneObstacles &obstacles) {
  return coverageOf(query, obstacles.data().coverage, obstacles.data().items.empty() ? NO_OBJECT : "");
}

} // namespace

double roundingOf(const CompiledCurve &curve, const std::vector<Item> &items) {
  double most = 0.0;
  for (const Item &item : items) most = std::max(most, roundingOf(curve, *item.shape));
  return most;
}

Stated statedOf(const SceneObstacles &obstacles, const CompiledCurve &curve, const Query &query) {
  const std::vector<Item> &items = obstacles.data().items;
  const auto name = [&](Answer &answer) {
    answer.a = curve.id;
    const std::int32_t found = answer.result.obstacle_index;
    if (found >= 0) nameItem(items[static_cast<std::size_t>(found)], query.options.max_lod, answer);
  };
  return {moverOf(curve), coreObstacles(obstacles), roundingOf(curve, items), items.empty(), name};
}

std::vector<Answer> nearestPairs(const SceneObstacles &obstacles, const CompiledCurve &curve, const PairLimits &limits,
                                 const Query &query, Workspace &workspace) {
  const Clock::time_point start = Clock::now();
  requireDistances(query);
  const std::vector<Item> &items = obstacles.data().items;
  const Coverage coverage = coverageOf(query, obstacles);
  Answer nothing;
  nothing.id = nothing.a = curve.id;
  std::vector<Answer> answers;
  if (items.empty()) {
    applyCoverage(coverage, query, nothing, answers);
    return answers;
  }
  const Obstacles set(coreObstacles(obstacles), CPROX_INDEX_NONE);
  const double rounding = roundingOf(curve, items);
  const cprox_options options = withoutRounding(query.options, rounding);
  std::vector<cprox_result> results(std::min(limits.count, items.size()));
  cprox_listed listed{};
  const cprox_status status = cprox_obstacles_nearest(set.get(), moverOf(curve), limits.count, &options,
                                                      workspace.get(), results.data(), &listed);
  if (status < 0) throw Error(workspace.reason(), status);

  /* nearest first; what is proven to be beyond the limit is left out */
  for (std::size_t i = 0; i < listed.count; ++i) {
    Answer answer = answerOf(curve, results[i], start);
    widen(query, rounding, INFINITE, answer.result);
    if (answer.result.lower > limits.within) continue;
    nameItem(items[static_cast<std::size_t>(answer.result.obstacle_index)], query.options.max_lod, answer);
    finishAnswer(workspace, answer);
    addSecondOpinion(obstacles.data(), curve, query, answer);
    answers.push_back(std::move(answer));
  }
  Unlisted unlisted;
  unlisted.add(status, listed, rounding);
  unlisted.addRow(limits, query.options, curve.id, "curve", answers);
  applyCoverage(coverage, query, nothing, answers);
  return answers;
}

std::vector<ClearanceInterval> clearanceProfile(const SceneObstacles &obstacles, const CompiledCurve &curve,
                                                const std::vector<double> &breaks, const Query &query,
                                                Workspace &workspace, double horizon) {
  requireDistances(withoutCertificate(query));
  const std::string fault = faultOfProfile(query, breaks, horizon);
  if (!fault.empty()) throw Error(fault);
  Stated stated = statedOf(obstacles, curve, query);
  stated.is_empty = false; /* the core checks the breaks, whatever there is to measure against */
  std::vector<ClearanceInterval> profile = searchProfile(stated, breaks, horizon, query, workspace);
  applyCoverage(coverageOf(query, obstacles), profile);
  return profile;
}

Answer timeOfContact(const SceneObstacles &obstacles, const CompiledCurve &curve, const Query &query,
                     Workspace &workspace) {
  const Clock::time_point start = Clock::now();
  cprox_certificate_clear(query.options.certificate);
  std::string fault = faultOfContact(query);
  if (fault.empty() && query.per_object) fault = "per_object does not apply: there is no answer for each object here";
  if (fault.empty()) fault = faultOf(query);
  if (!fault.empty()) {
    Answer answer = refusal(curve.id, "curve", fault);
    answer.a = curve.id;
    return answer;
  }

  /* each obstacle enlarged by what rounding can have moved it, so that no contact comes before the time */
  const std::vector<Item> &items = obstacles.data().items;
  std::vector<cprox_obstacle> enlarged = coreObstacles(obstacles);
  for (std::size_t i = 0; i < items.size(); ++i)
    enlarged[i].margin += curve_proximity::roundingOf(curve, *items[i].shape);
  cprox_result result{};
  result.obstacle_index = -1;
  searchContact(moverOf(curve), enlarged, query, workspace, result);
  Answer answer = answerOf(curve, result, start);
  if (result.status >= 0) {
    widen(query, 2.0 * roundingOf(curve, items), INFINITE, answer.result);
    if (result.obstacle_index >= 0)
      nameItem(items[static_cast<std::size_t>(result.obstacle_index)], query.options.max_lod, answer);
  }
  finishAnswer(workspace, answer);
  applyCoverage(coverageOf(query, obstacles), query, answer);
  if (query.options.certificate)
    leaveContactProof(query, moverOf(curve), coreObstacles(obstacles), result, workspace, answer);
  addSecondOpinion(obstacles.data(), curve, query, answer);
  return answer;
}

} // namespace curve_proximity
