/* SPDX-License-Identifier: BSD-3-Clause */
#include "answering.h"

#include <algorithm>
#include <limits>

namespace curve_proximity {
namespace {

/* The verdict once more, by the interval as it is now: it may only have become less certain. */
void reviewVerdict(const Question &question, cprox_result &result) {
  const bool tolerance = question.verb == Verb::TOLERANCE;
  const cprox_verdict apart = tolerance ? CPROX_YES : CPROX_NO;
  const double limit = tolerance ? question.delta : 0.0;
  if (result.verdict == apart && !(result.lower > limit)) result.verdict = CPROX_UNDECIDED;
  if (tolerance && result.verdict == CPROX_NO && !(result.upper <= limit)) result.verdict = CPROX_UNDECIDED;
}

} // namespace

std::optional<cprox_rung> rungFromName(const std::string &name) {
  for (const cprox_rung rung : {CPROX_RUNG_SPHERE, CPROX_RUNG_HULL, CPROX_RUNG_MESH}) {
    if (name == cprox_rung_name(rung)) return rung;
  }
  return std::nullopt;
}

std::string faultOf(const Question &question) {
  if (question.verb != Verb::TOLERANCE && question.delta != 0.0)
    return "delta is " + std::to_string(question.delta) +
           ": it is the clearance that tolerance asks for, and must be 0";
  if (question.verb != Verb::DISTANCE && question.options.signed_distance)
    return "signed_distance does not apply to tolerance and collision: it is an option of distance queries";
  if (question.per_object && question.options.certificate)
    return "a certificate is about all objects at once: ask without per_object";
  return "";
}

std::string faultOfMotion(const Question &question, bool in_all) {
  if (question.options.signed_distance)
    return "signed_distance does not apply to robots: how deep they overlap is not measured";
  if (!question.links.empty())
    return "links do not apply to a robot in motion, '" + question.links.front() +
           "' among them: all that it moves are asked about";
  if (in_all && question.per_object) return "per_object does not apply: there is no answer for each object here";
  return faultOf(question);
}

Answer refusal(const std::string &id, const std::string &kind, const std::string &why) {
  Answer answer;
  answer.id = id;
  answer.kind = kind;
  answer.result.status = CPROX_INVALID;
  answer.result.verdict = CPROX_UNDECIDED;
  answer.result.target_index = -1;
  answer.status = cprox_status_name(CPROX_INVALID);
  answer.message = why;
  return answer;
}

cprox_options withoutRounding(cprox_options options, double rounding) {
  if (options.epsilon > 4.0 * rounding) options.epsilon -= 2.0 * rounding;
  return options;
}

cprox_status askCore(const Question &question, const cprox_options &options, const cprox_mover &mover,
                     const std::vector<cprox_target> &targets, Workspace &workspace, cprox_result &result) {
  cprox_workspace *w = workspace.get();
  switch (question.verb) {
    case Verb::DISTANCE:
      return cprox_distance_all(mover, targets.data(), targets.size(), &options, w, &result, nullptr);
    case Verb::TOLERANCE:
      return cprox_tolerance_all(mover, targets.data(), targets.size(), question.delta, &options, w, &result, nullptr);
    case Verb::COLLISION: break;
  }
  return cprox_collision_all(mover, targets.data(), targets.size(), &options, w, &result, nullptr);
}

void widen(const Question &question, double rounding, double left_out, cprox_result &result) {
  const cprox_options &options = question.options;
  result.lower = std::min(result.lower - rounding, left_out);
  if (!options.signed_distance) result.lower = std::max(0.0, result.lower);
  if (options.signed_distance || result.upper > 0.0) result.upper += rounding;

  if (question.verb != Verb::DISTANCE) {
    reviewVerdict(question, result);
    return;
  }
  const double asked = std::max(options.epsilon, options.relative_epsilon * result.upper);
  const bool narrow = result.upper - result.lower <= asked;
  if (result.status == CPROX_OK && !narrow) result.status = CPROX_PRECISION;
}

void answerNothing(const Question &question, cprox_result &result) {
  result.lower = result.upper = std::numeric_limits<double>::infinity();
  result.target_index = -1;
  result.verdict = question.verb == Verb::DISTANCE    ? CPROX_UNDECIDED
                   : question.verb == Verb::TOLERANCE ? CPROX_YES
                                                      : CPROX_NO;
}

} // namespace curve_proximity
