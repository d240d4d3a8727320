/* SPDX-License-Identifier: BSD-3-Clause */
/* All intervals in which a curve or a robot is within delta of something. */
#include <algorithm>
#include <cmath>
#include <utility>

#include <curve_proximity/motion.hpp>
#include <curve_proximity/query.hpp>

#include "answering.h"
#include "asked_pairs.h"
#include "proving.h"
#include "scene_obstacles.h"

namespace curve_proximity {

namespace {

std::array<double, 2> rangeOf(const cprox_mover &mover) {
  if (mover.motion) {
    const cprox_motion_info info = cprox_motion_get_info(mover.motion);
    return {info.t0, info.t1};
  }
  const cprox_curve_info info = cprox_curve_get_info(mover.curve);
  return {info.t0, info.t1};
}

} // namespace

void checkViolations(const Query &query, double resolution) {
  if (query.query_type != QueryType::TOLERANCE) throw Error("violations are asked for by a tolerance");
  if (query.per_object) throw Error("per_object does not apply: violations are of all objects together");
  if (!(resolution > 0.0)) throw Error("the resolution must be above 0");
}

namespace {

/* What lies between the violations, and a place in each of them. */
void prove(const Stated &stated, const Query &query, const Obstacles &set, const cprox_violation *list,
           std::size_t count, Workspace &workspace, Violations &out) {
  const auto add = [&](const PartialClaim &claim) {
    std::string one = certificateOf(query, stated.mover, set.get(), claim, workspace, out.unproven);
    if (!one.empty()) out.certificates.push_back(std::move(one));
  };
  const std::array<double, 2> all = domainOf(query, rangeOf(stated.mover));
  double clear_from = all[0];
  for (std::size_t i = 0; i <= count; ++i) {
    const double clear_to = i < count ? list[i].enter_lower : all[1];
    if (clear_from < clear_to) add({{clear_from, clear_to}, query.delta, false, false, cprox_result{}});
    if (i == count) break;
    clear_from = list[i].leave_upper;
    if (list[i].verdict != CPROX_VERDICT_VIOLATED) continue;
    PartialClaim near{{}, std::max(query.delta, list[i].upper), true, false, cprox_result{}};
    near.answer.upper = list[i].upper, near.answer.t = list[i].t;
    near.answer.obstacle_index = list[i].obstacle_index, near.answer.mover_part = list[i].mover_part;
    add(near);
  }
}

} // namespace

Violations searchViolations(const Stated &stated, double resolution, const Query &query, Workspace &workspace) {
  constexpr std::size_t FIRST_ROOM = 64, MOST_ROOM = 65536;
  Violations out;
  out.measured = !stated.is_empty;
  if (stated.is_empty) return out;
  const Obstacles set(stated.obstacles, CPROX_INDEX_NONE);
  std::vector<cprox_violation> room(FIRST_ROOM);
  cprox_options options = withoutRounding(query.options, stated.rounding);
  options.certificate = nullptr;
  cprox_violations found{};
  while (true) {
    found = {room.data(), room.size(), 0};
    out.status = cprox_obstacles_violations(set.get(), stated.mover, query.delta + stated.rounding, resolution,
                                            &options, workspace.get(), &found);
    if (out.status != CPROX_BUDGET || found.count < room.size() || room.size() >= MOST_ROOM) break;
    room.resize(4 * room.size());
  }
  if (out.status < 0) throw Error(workspace.reason(), out.status);
  if (out.status != CPROX_OK) out.message = cprox_status_text(out.status);
  if (query.moving_only) out.message += (out.message.empty() ? "" : "; ") + std::string(MOVING_ONLY);
  for (std::size_t i = 0; i < found.count; ++i) {
    const cprox_violation &v = room[i];
    Answer sides;
    sides.result.obstacle_index = v.obstacle_index, sides.result.mover_part = v.mover_part;
    stated.name(sides);
    const bool one_side = std::isinf(sides.result.upper); /* a model answers for one of them */
    out.list.push_back({v.enter_lower, v.enter_upper, v.leave_lower, v.leave_upper,
                        one_side ? CPROX_VERDICT_UNDECIDED : v.verdict, one_side ? INFINITE : v.upper, v.t, sides.a,
                        sides.b});
  }
  if (query.options.certificate) prove(stated, query, set, room.data(), found.count, workspace, out);
  return out;
}

Violations violations(const SceneObstacles &obstacles, const CompiledCurve &curve, double resolution,
                      const Query &query, Workspace &workspace) {
  checkViolations(query, resolution);
  const std::string fault = faultOf(query);
  if (!fault.empty()) throw Error(fault);
  const Stated stated = statedOf(obstacles, curve, query);
  Violations found = searchViolations(stated, resolution, query, workspace);
  const cprox_curve_info info = cprox_curve_get_info(curve.curve.get());
  applyCoverage(coverageOf(query, obstacles.data().coverage, stated.is_empty ? NO_OBJECT : ""),
                domainOf(query, {info.t0, info.t1}), found);
  return found;
}

Violations violations(const RobotMotion &motion, bool self, double resolution, const Query &query,
                      Workspace &workspace) {
  checkViolations(query, resolution);
  const RobotPairs against = againstOf(self);
  const std::string fault = faultInAll(against, query);
  if (!fault.empty()) throw Error(fault);
  const Asked asked = askedOf(motion, against, query);
  Violations found = searchViolations(asked.stated(query), resolution, query, workspace);
  applyCoverage(coverageOf(query, asked), domainOf(query, motion.domain()), found);
  return found;
}

} // namespace curve_proximity
