/* SPDX-License-Identifier: BSD-3-Clause */
/* All intervals in which a curve or a robot is within delta of something. */
#include <curve_proximity/motion.hpp>
#include <curve_proximity/query.hpp>

#include "answering.h"
#include "asked_pairs.h"
#include "targets.h"

namespace curve_proximity {

void checkViolations(const Query &query, double resolution) {
  if (query.query_type != QueryType::TOLERANCE) throw Error("violations are asked for by a tolerance");
  if (query.per_object) throw Error("per_object does not apply: violations are of all objects together");
  if (query.options.certificate) throw Error("there is no certificate of violations");
  if (!(resolution > 0.0)) throw Error("the resolution must be above 0");
}

Violations violationsOfNothing() {
  Violations out;
  out.measured = false;
  return out;
}

void claimOneSide(Violation &violation) {
  violation.upper = INFINITE;
  violation.verdict = CPROX_VERDICT_UNDECIDED;
}

Violations searchViolations(const Obstacles &obstacles, const cprox_mover &mover, double rounding, double resolution,
                            const Query &query, Workspace &workspace, const ViolationNamer &name) {
  constexpr std::size_t FIRST_ROOM = 64, MOST_ROOM = 65536;
  std::vector<cprox_violation> room(FIRST_ROOM);
  const cprox_options options = withoutRounding(query.options, rounding);
  Violations out;
  cprox_violations found{};
  while (true) {
    found = {room.data(), room.size(), 0};
    out.status = cprox_obstacles_violations(obstacles.get(), mover, query.delta + rounding, resolution, &options,
                                            workspace.get(), &found);
    if (out.status != CPROX_BUDGET || found.count < room.size() || room.size() >= MOST_ROOM) break;
    room.resize(4 * room.size());
  }
  if (out.status < 0) throw Error(workspace.reason(), out.status);
  if (out.status != CPROX_OK) out.message = cprox_status_text(out.status);
  if (query.moving_only) out.message += (out.message.empty() ? "" : "; ") + std::string(MOVING_ONLY);
  for (std::size_t i = 0; i < found.count; ++i) {
    const cprox_violation &v = room[i];
    Violation one{v.enter_lower, v.enter_upper, v.leave_lower, v.leave_upper, v.verdict, v.upper, v.t, "", ""};
    name(v, one);
    out.list.push_back(std::move(one));
  }
  return out;
}

Violations violations(const Targets &targets, const CompiledCurve &curve, double resolution, const Query &query,
                      Workspace &workspace) {
  checkViolations(query, resolution);
  const std::string fault = faultOf(query);
  if (!fault.empty()) throw Error(fault);
  const std::vector<Item> &items = targets.data().items;
  const auto name = [&](const cprox_violation &found, Violation &out) {
    out.a = curve.id;
    if (found.obstacle_index < 0) return;
    const Item &item = items[static_cast<std::size_t>(found.obstacle_index)];
    out.b = *item.owner;
    if (isReplaced(query.options.max_lod, item.shape->is_mesh)) claimOneSide(out);
  };
  Violations found = violationsOfNothing();
  if (!items.empty()) {
    const Obstacles obstacles(coreTargets(targets), CPROX_INDEX_NONE);
    found = searchViolations(obstacles, moverOf(curve), roundingOf(curve, items), resolution, query, workspace, name);
  }
  const cprox_curve_info info = cprox_curve_get_info(curve.curve.get());
  applyCoverage(coverageOf(query, targets.data().coverage, items.empty() ? NO_OBJECT : ""),
                domainOf(query, {info.t0, info.t1}), found);
  return found;
}

Violations violations(const RobotMotion &motion, bool self, double resolution, const Query &query,
                      Workspace &workspace) {
  checkViolations(query, resolution);
  const RobotPairs against = self ? RobotPairs::SELF : RobotPairs::ENVIRONMENT;
  const std::string fault = faultInAll(against, query);
  if (!fault.empty()) throw Error(fault);
  const Asked asked = askedOf(motion, against, query);
  const auto name = [&](const cprox_violation &found, Violation &out) {
    Answer names;
    names.result.obstacle_index = found.obstacle_index;
    names.result.mover_part = found.mover_part;
    nameSides(asked, query, names);
    out.a = names.a;
    out.b = names.b;
    if (isReplaced(query.options.max_lod, names.by_hull)) claimOneSide(out);
  };
  Violations found = violationsOfNothing();
  if (!asked.pairs.empty()) {
    const Obstacles obstacles(asked.targets, CPROX_INDEX_NONE);
    found = searchViolations(obstacles, asked.mover(), asked.rounding, resolution, query, workspace, name);
  }
  applyCoverage(coverageOf(query, asked), domainOf(query, motion.domain()), found);
  return found;
}

} // namespace curve_proximity
