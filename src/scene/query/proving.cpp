/* SPDX-License-Identifier: BSD-3-Clause */
#include "proving.h"

#include <algorithm>
#include <cmath>

namespace curve_proximity {
namespace {

/* What the answer claims: the limit of a verdict; of a distance its lower bound, or where that is 0 its upper bound. */
double claimOf(const Query &query, const cprox_result &result) {
  switch (query.query_type) {
    case QueryType::DISTANCE: break;
    case QueryType::TOLERANCE: return query.delta;
    case QueryType::COLLISION: return 0.0;
  }
  return result.lower > 0.0 ? result.lower : std::max(result.upper, 0.0);
}

/* Whether there is an answer to be proven; then of the options what is of its proof. */
bool beginProof(const Query &query, const cprox_result &result, cprox_options &options, Answer &answer) {
  cprox_certificate_clear(query.options.certificate);
  if (result.status < 0) return false; // the answer says why
  if (answer.gap) answer.unproven = answer.message;
  options = query.options; // what is of the query alone is not of its proof
  options.certificate = nullptr;
  options.signed_distance = false;
  options.stop = nullptr;
  return !answer.gap;
}

/* Is it all of a motion? */
bool isWhole(const double *interval, const cprox_mover &mover) {
  if (!interval || !mover.motion) return false;
  const cprox_motion_info info = cprox_motion_get_info(mover.motion);
  return interval[0] <= info.t0 && interval[1] >= info.t1;
}

} // namespace

void leaveProof(const Query &query, const cprox_mover &mover, const std::vector<cprox_obstacle> &obstacles,
                const cprox_result &result, Workspace &workspace, Answer &answer) {
  cprox_options options;
  if (!beginProof(query, result, options, answer)) return;
  const double delta = claimOf(query, result);
  if (!std::isfinite(delta)) {
    answer.unproven = "there is nothing to measure";
    return;
  }
  if (result.upper <= delta || isWhole(options.interval, mover)) options.interval = nullptr; // near is of one time
  ObstaclesHandle set;
  cprox_status status = makeObstacles(obstacles, CPROX_INDEX_NONE, workspace, set);
  if (status == CPROX_OK)
    status = cprox_certify(mover, set.get(), delta, &result, &options, workspace.get(), query.options.certificate);
  if (status != CPROX_OK) answer.unproven = workspace.reason();
}

void leaveContactProof(const Query &query, const cprox_mover &mover, const std::vector<cprox_obstacle> &obstacles,
                       const cprox_result &result, Workspace &workspace, Answer &answer) {
  cprox_options options;
  if (!beginProof(query, result, options, answer)) return;
  ObstaclesHandle set;
  cprox_status status = makeObstacles(obstacles, CPROX_INDEX_NONE, workspace, set);
  if (isWhole(options.interval, mover)) options.interval = nullptr;
  std::array<double, 2> before{};
  if (options.interval && status == CPROX_OK) { // what was before its begin is not asked
    before = {options.interval[0], std::min(result.t_contact_lower, options.interval[1])};
    options.interval = before.data();
    status = cprox_certify(mover, set.get(), 0.0, nullptr, &options, workspace.get(), query.options.certificate);
  } else if (status == CPROX_OK)
    status = cprox_certify_contact(mover, set.get(), &result, &options, workspace.get(), query.options.certificate);
  if (status != CPROX_OK) answer.unproven = workspace.reason();
}

std::string certificateOf(const Query &query, const cprox_mover &mover, const cprox_obstacles *obstacles,
                          const PartialClaim &claim, Workspace &workspace, std::string &unproven) {
  cprox_certificate *certificate = query.options.certificate;
  cprox_options options = query.options;
  options.certificate = nullptr;
  options.signed_distance = false;
  options.stop = nullptr;
  options.interval = claim.near ? nullptr : claim.range.data();
  const bool with_answer = claim.near || claim.distance;
  const cprox_status status = cprox_certify(mover, obstacles, claim.delta, with_answer ? &claim.answer : nullptr,
                                            &options, workspace.get(), certificate);
  if (status != CPROX_OK) {
    unproven = workspace.reason();
    return {};
  }
  const cprox_certificate_info info = cprox_certificate_get_info(certificate);
  return {static_cast<const char *>(info.bytes), info.size};
}

std::string unprovable(const std::string &who, const cprox_obstacle &obstacle, bool moves) {
  const cprox_body_kind kind = obstacle.body ? cprox_body_get_info(obstacle.body).kind : CPROX_BODY_POINT;
  const bool elements = kind == CPROX_BODY_MESH || kind == CPROX_BODY_POINTS || kind == CPROX_BODY_OCTREE;
  if (!(moves && elements) && !obstacle.curve && cprox_obstacle_describe(&obstacle, nullptr, 0) > 0) return {};
  return who + " is of a kind that has no certificates: " +
         (obstacle.body ? cprox_body_kind_name(cprox_body_get_info(obstacle.body).kind) : "curve");
}

std::string wordOf(const std::string &text) {
  std::string word = text.empty() ? "-" : text;
  std::replace_if(
      word.begin(), word.end(), [](unsigned char c) { return c <= ' '; }, '_');
  return word;
}

std::string obstacleLines(const std::vector<cprox_obstacle> &obstacles, const std::vector<std::string> &names) {
  std::string all;
  std::size_t count = 0;
  for (std::size_t i = 0; i < obstacles.size(); ++i) {
    std::string lines(cprox_obstacle_describe(&obstacles[i], nullptr, 0) + 1, '\0');
    if (lines.size() == 1 || obstacles[i].curve) return {};
    cprox_obstacle_describe(&obstacles[i], lines.data(), lines.size());
    lines.pop_back();
    for (const char c : lines) {
      if (c == '\n') all += " called " + wordOf(names[i]);
      count += c == '\n' ? 1 : 0;
      all += c;
    }
  }
  return "targets " + std::to_string(count) + "\n" + all;
}

std::string describeQuery(const cprox_mover &mover, const std::vector<cprox_obstacle> &obstacles,
                          const std::vector<std::string> &names, const std::string &id) {
  const std::string bodies = obstacleLines(obstacles, names);
  if (bodies.empty()) return {};
  Workspace workspace;
  const Obstacles set(obstacles, CPROX_INDEX_NONE);
  const std::string word = wordOf(id);
  const auto describe = [&](char *text, std::size_t size) {
    return cprox_mover_describe(&mover, set.get(), word.c_str(), workspace.get(), text, size);
  };
  std::string robot(describe(nullptr, 0) + 1, '\0');
  if (describe(robot.data(), robot.size()) == 0) return {};
  robot.pop_back();
  return bodies + robot;
}

} // namespace curve_proximity
