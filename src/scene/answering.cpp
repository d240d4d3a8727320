/* SPDX-License-Identifier: BSD-3-Clause */
#include "answering.h"

#include <algorithm>
#include <limits>

namespace curve_proximity {
namespace {

/* The verdict once more, by the interval as it is now: it may only have become less certain. */
void reviewVerdict(const Query &query, cprox_result &result) {
  const bool tolerance = query.query_type == QueryType::TOLERANCE;
  const double limit = tolerance ? query.delta : 0.0;
  if (result.verdict == CPROX_VERDICT_CLEAR && !(result.lower > limit)) result.verdict = CPROX_VERDICT_UNDECIDED;
  if (tolerance && result.verdict == CPROX_VERDICT_VIOLATED && !(result.upper <= limit))
    result.verdict = CPROX_VERDICT_UNDECIDED;
}

} // namespace

std::optional<cprox_lod> lodFromName(const std::string &name) {
  for (const cprox_lod lod : {CPROX_LOD_SPHERE, CPROX_LOD_HULL, CPROX_LOD_MESH}) {
    if (name == cprox_lod_name(lod)) return lod;
  }
  return std::nullopt;
}

std::string faultOf(const Query &query) {
  if (query.query_type != QueryType::TOLERANCE && query.delta != 0.0)
    return "delta is " + std::to_string(query.delta) + ": it is the clearance that tolerance asks for, and must be 0";
  if (query.query_type != QueryType::DISTANCE && query.options.signed_distance)
    return "signed_distance does not apply to tolerance and collision: it is an option of distance queries";
  if (query.per_object && query.options.certificate)
    return "a certificate is about all objects at once: ask without per_object";
  return "";
}

std::string faultOfMotion(const Query &query, bool in_all) {
  if (query.options.signed_distance)
    return "signed_distance does not apply to robots: how deep they overlap is not measured";
  if (!query.links.empty())
    return "links do not apply to a robot in motion, '" + query.links.front() +
           "' among them: all that it moves are asked about";
  if (in_all && query.per_object) return "per_object does not apply: there is no answer for each object here";
  return faultOf(query);
}

Answer refusal(const std::string &id, const std::string &kind, const std::string &why) {
  Answer answer;
  answer.id = id;
  answer.kind = kind;
  answer.result.status = CPROX_INVALID;
  answer.result.verdict = CPROX_VERDICT_UNDECIDED;
  answer.result.obstacle_index = -1;
  answer.status = cprox_status_name(CPROX_INVALID);
  answer.message = why;
  return answer;
}

cprox_options withoutRounding(cprox_options options, double rounding) {
  if (options.epsilon > 4.0 * rounding) options.epsilon -= 2.0 * rounding;
  return options;
}

cprox_status askCore(const Query &query, const cprox_options &options, const cprox_mover &mover,
                     const std::vector<cprox_obstacle> &targets, Workspace &workspace, cprox_result &result) {
  ObstaclesHandle obstacles;
  const cprox_status made = makeObstacles(targets, CPROX_INDEX_NONE, workspace, obstacles);
  return made < 0 ? made : askCore(query, options, mover, obstacles.get(), workspace, result);
}

cprox_status askCore(const Query &query, const cprox_options &options, const cprox_mover &mover,
                     const cprox_obstacles *obstacles, Workspace &workspace, cprox_result &result) {
  cprox_workspace *w = workspace.get();
  switch (query.query_type) {
    case QueryType::DISTANCE: return cprox_obstacles_distance(obstacles, mover, &options, w, &result, nullptr);
    case QueryType::TOLERANCE:
      return cprox_obstacles_tolerance(obstacles, mover, query.delta, &options, w, &result, nullptr);
    case QueryType::COLLISION: break;
  }
  return cprox_obstacles_collision(obstacles, mover, &options, w, &result, nullptr);
}

void widen(const Query &query, double rounding, double left_out, cprox_result &result) {
  const cprox_options &options = query.options;
  result.lower = std::min(result.lower - rounding, left_out);
  if (!options.signed_distance) result.lower = std::max(0.0, result.lower);
  if (options.signed_distance || result.upper > 0.0) result.upper += rounding;

  if (query.query_type != QueryType::DISTANCE) {
    reviewVerdict(query, result);
    return;
  }
  const double asked = std::max(options.epsilon, options.relative_epsilon * result.upper);
  const bool narrow = result.upper - result.lower <= asked;
  if (result.status == CPROX_OK && !narrow) result.status = CPROX_PRECISION;
}

void answerNothing(const Query &query, cprox_result &result) {
  result.lower = result.upper = std::numeric_limits<double>::infinity();
  result.obstacle_index = -1;
  result.verdict = query.query_type == QueryType::DISTANCE ? CPROX_VERDICT_UNDECIDED : CPROX_VERDICT_CLEAR;
}

} // namespace curve_proximity
