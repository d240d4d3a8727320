/* SPDX-License-Identifier: BSD-3-Clause */
#include "queries/asking.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "queries/row_message.h"

namespace curve_proximity {

std::vector<double> breaksOf(const Asking &asking, double t0, double t1) {
  if (!asking.breaks.empty()) return asking.breaks;
  std::vector<double> breaks(asking.intervals + 1);
  const auto n = static_cast<double>(asking.intervals);
  for (std::size_t i = 0; i < asking.intervals; ++i) breaks[i] = t0 + (t1 - t0) * (static_cast<double>(i) / n);
  breaks.back() = t1;
  return breaks;
}

double resolutionOf(const Asking &asking, double t0, double t1) {
  constexpr double PART = 1e-3;
  return asking.resolution > 0.0 ? asking.resolution : PART * (t1 - t0);
}

void askCurve(const Targets &targets, const CompiledCurve &curve, const Query &query, const Asking &asking,
              Workspace &workspace, std::vector<Answer> &answers) {
  if (asking.kind == Asking::CONTACT) {
    answers.push_back(timeOfContact(targets, curve, query, workspace));
    return;
  }
  if (asking.kind == Asking::NEAREST) {
    std::vector<Answer> pairs = nearestPairs(targets, curve, asking.limits, query, workspace);
    std::move(pairs.begin(), pairs.end(), std::back_inserter(answers));
    if (!pairs.empty() || std::isfinite(asking.limits.within)) return;
  }
  ask(targets, curve, query, workspace, answers);
}

Profile profileOf(const Targets &targets, const CompiledCurve &curve, const Query &query, const Asking &asking,
                  Workspace &workspace) {
  const cprox_curve_info info = cprox_curve_get_info(curve.curve.get());
  return toMessage(
      clearanceProfile(targets, curve, breaksOf(asking, info.t0, info.t1), query, workspace, asking.horizon));
}

ViolationIntervals violationsOf(const Targets &targets, const CompiledCurve &curve, const Query &query,
                                const Asking &asking, Workspace &workspace) {
  const cprox_curve_info info = cprox_curve_get_info(curve.curve.get());
  return toMessage(violations(targets, curve, resolutionOf(asking, info.t0, info.t1), query, workspace));
}

void fillRow(const Answer &answer, const Query &query, const Asking &asking, Proximity &row) {
  fillRow(answer, query.query_type, row);
  if (asking.kind == Asking::CONTACT && answer.result.status >= 0) row.t_contact_lower = answer.result.t_contact_lower;
}

void askMotion(const RobotMotion &motion, const Query &query, bool self, const Asking &asking, Workspace &workspace,
               MotionRows &out) {
  const auto plainly = [&](const Query &wanted) {
    if (self) return std::vector<Answer>{askSelf(motion, wanted, workspace)};
    return askEnvironment(motion, wanted, workspace);
  };
  std::vector<Answer> answers;
  if (asking.kind == Asking::CONTACT) answers = {timeOfContact(motion, self, query, workspace)};
  if (asking.kind == Asking::NEAREST) {
    answers = nearestPairs(motion, self, asking.limits, query, workspace);
    if (answers.empty() && !std::isfinite(asking.limits.within)) answers = plainly(query);
  }
  if (asking.kind == Asking::ANSWER) answers = plainly(query);
  if (asking.kind == Asking::GRADIENT) {
    const RobotPairs pairs = self ? RobotPairs::SELF : RobotPairs::ENVIRONMENT;
    ClearanceRow row = clearanceGradient(motion, pairs, query, workspace);
    out.gradients.push_back(std::move(row.gradient));
    answers = {std::move(row.answer)};
  }
  if (asking.kind == Asking::VIOLATIONS) {
    const double resolution = resolutionOf(asking, motion.domain()[0], motion.domain()[1]);
    answers = plainly(query);
    out.violations.push_back(toMessage(violations(motion, self, resolution, query, workspace)));
  }
  if (asking.kind == Asking::PROFILE) {
    const std::vector<double> breaks = breaksOf(asking, motion.domain()[0], motion.domain()[1]);
    std::vector<std::string> links =
        asking.per_link ? askedNames(motion, self, query.moving_only) : std::vector<std::string>();
    if (links.empty()) links.emplace_back();
    for (const std::string &link : links) {
      Query of_link = query;
      if (!link.empty()) of_link.links.push_back(link);
      answers.push_back(plainly(of_link).front());
      if (answers.back().a.empty()) answers.back().a = link; // nothing is near it
      out.profiles.push_back(toMessage(clearanceProfile(motion, self, breaks, of_link, workspace, asking.horizon)));
      out.profiles.back().link = link;
    }
  }
  std::move(answers.begin(), answers.end(), std::back_inserter(out.answers));
}

} // namespace curve_proximity
