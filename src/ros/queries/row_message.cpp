/* SPDX-License-Identifier: BSD-3-Clause */
#include "queries/row_message.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "messages/geometry_message.h"
#include "messages/gradient_message.h"
#include "messages/shape_message.h"

namespace curve_proximity {
namespace {

ViolationIntervals toMessage(const Violations &violations) {
  if (violations.list.size() > MOST_VIOLATIONS)
    throw Error("there are more than " + std::to_string(MOST_VIOLATIONS) +
                " violations: a larger resolution has fewer");
  ViolationIntervals message;
  for (const Violation &one : violations.list) {
    message.enter_lower.push_back(one.enter_lower);
    message.enter_upper.push_back(one.enter_upper);
    message.leave_lower.push_back(one.leave_lower);
    message.leave_upper.push_back(one.leave_upper);
    message.verdict.emplace_back(cprox_verdict_name(one.verdict));
    message.upper.push_back(one.upper);
    message.t.push_back(one.t);
    message.a.push_back(one.a);
    message.b.push_back(one.b);
  }
  return message;
}

Profile toMessage(const std::vector<ClearanceInterval> &intervals) {
  Profile message;
  for (const ClearanceInterval &interval : intervals) {
    message.t0.push_back(interval.t0);
    message.t1.push_back(interval.t1);
    message.lower.push_back(interval.lower);
    message.upper.push_back(interval.upper);
    message.t.push_back(interval.t);
    message.a.push_back(interval.a);
    message.b.push_back(interval.b);
    message.witness_a.push_back(toPointMessage(interval.witness_a));
    message.witness_b.push_back(toPointMessage(interval.witness_b));
    message.converged.push_back(interval.status == CPROX_OK);
  }
  return message;
}

SpeedProfile toMessage(const SpeedLimits &limits) {
  SpeedProfile message;
  message.profile = toMessage(limits.profile);
  message.overrides = limits.overrides;
  message.constant = limits.constant;
  message.unwatched = limits.unwatched;
  return message;
}

ObjectMargins toMessage(const std::vector<ObjectMargin> &margins) {
  ObjectMargins message;
  for (const ObjectMargin &margin : margins) {
    message.object.push_back(margin.object);
    message.direction.push_back(margin.direction);
    message.free.push_back(margin.free);
    message.blocked.push_back(margin.blocked);
    message.t.push_back(margin.t);
    message.a.push_back(margin.a);
    message.toward.push_back(toVectorMessage(margin.toward));
    message.converged.push_back(margin.status == CPROX_OK);
  }
  return message;
}

SweptCells toMessage(const SweptVolume &volume) {
  SweptCells message;
  const auto inside = std::count(volume.inside.begin(), volume.inside.end(), true);
  if (!volume.cells.empty()) message.outside = toOctreeMessage(toOctree(volume));
  if (inside > 0) message.inside = toOctreeMessage(toOctree(volume, true));
  message.outside_cells = static_cast<std::uint32_t>(volume.cells.size());
  message.inside_cells = static_cast<std::uint32_t>(inside);
  message.gap = volume.gap;
  return message;
}

} // namespace

void fillRow(const Answer &answer, const Question &question, QueryType query_type, Proximity &message) {
  if (answer.result.status < 0) {
    message = toFailedRow(answer.id, answer.kind, answer.message);
    message.status = answer.status;
    return;
  }
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  const cprox_result &result = answer.result;
  message.id = answer.id;
  message.kind = answer.kind;
  message.status = answer.status;
  if (query_type != QueryType::DISTANCE || answer.is_unlisted) message.verdict = cprox_verdict_name(result.verdict);
  message.lower = result.lower;
  message.upper = result.upper;
  message.t = result.t;
  const bool on_curve = answer.kind == Proximity::KIND_CURVE && result.obstacle_index >= 0;
  message.t_b = on_curve ? result.t_obstacle : none;
  message.t_contact_lower = asksFor<question::Contact>(question) ? result.t_contact_lower : none;
  message.certified_scale = message.refused_scale = none;
  message.second_opinion = secondOpinionName(answer.second_opinion.verdict);
  message.second_distance = answer.second_opinion.distance;
  message.witness_a = toPointMessage(result.witness_mover);
  message.witness_b = toPointMessage(result.witness_obstacle);
  message.normal = toVectorMessage(toEigen(result.normal));
  message.a = answer.a;
  message.b = answer.b;
  message.nodes = result.nodes;
  message.distance_queries = result.distance_queries;
  message.microseconds = answer.microseconds;
  message.lod = cprox_lod_name(result.lod);
  message.message = answer.message;
}

Proximity toFailedRow(const std::string &id, const std::string &kind, const std::string &why) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  Proximity message;
  message.id = id;
  message.kind = kind;
  message.status = cprox_status_name(CPROX_INVALID);
  message.lower = message.upper = message.t = message.t_b = message.t_contact_lower = message.second_distance = none;
  message.certified_scale = message.refused_scale = none;
  message.witness_a.x = message.witness_a.y = message.witness_a.z = none;
  message.witness_b = message.witness_a;
  message.normal.x = message.normal.y = message.normal.z = none;
  message.microseconds = none;
  message.a = id;
  message.lod = cprox_lod_name(CPROX_LOD_NONE);
  message.message = why;
  return message;
}

DetailMessage toMessage(const Row &row, const TrajectoryDescription *trajectory) {
  if (const auto *gradient = std::get_if<CurveGradient>(&row.detail)) return toMessage(*gradient);
  if (const auto *gradient = std::get_if<ClearanceGradient>(&row.detail)) return toMessage(*gradient, *trajectory);
  if (const auto *found = std::get_if<Violations>(&row.detail)) return toMessage(*found);
  if (const auto *limits = std::get_if<SpeedLimits>(&row.detail)) return toMessage(*limits);
  if (const auto *margins = std::get_if<std::vector<ObjectMargin>>(&row.detail)) return toMessage(*margins);
  if (const auto *volume = std::get_if<SweptVolume>(&row.detail)) return toMessage(*volume);
  const auto *intervals = std::get_if<std::vector<ClearanceInterval>>(&row.detail);
  if (!intervals) return {};
  Profile profile = toMessage(*intervals);
  profile.link = row.part.link;
  return profile;
}

Query provable(const Subject &subject, Query query) {
  if (query.options.certificate && !unprovable(subject).empty()) query.options.certificate = nullptr;
  return query;
}

Proof takeProof(const Subject &subject, const Query &query, const Row &row) {
  Proof out;
  if (row.answer.result.status < 0) return out;
  out.unproven = unprovable(subject);
  if (!out.unproven.empty()) return out;
  std::string record;
  if (const auto *found = std::get_if<Violations>(&row.detail)) {
    record = recordOfParts(found->certificates);
    out.unproven = found->unproven;
  } else if (const auto *intervals = std::get_if<std::vector<ClearanceInterval>>(&row.detail)) {
    std::vector<std::string> parts;
    for (const ClearanceInterval &interval : *intervals) {
      if (!interval.certificate.empty()) parts.push_back(interval.certificate);
      if (out.unproven.empty()) out.unproven = interval.unproven;
    }
    record = recordOfParts(parts);
  } else {
    const cprox_certificate_info info = cprox_certificate_get_info(query.options.certificate);
    record.assign(static_cast<const char *>(info.bytes), info.size);
    out.unproven = row.answer.unproven;
  }
  if (record.empty()) return out;
  out.certificate.assign(record.begin(), record.end());
  out.fingerprint = problemOf(subject, query).fingerprint;
  return out;
}

void addProof(Proof proof, Proximity &row) {
  row.certificate = std::move(proof.certificate);
  row.problem_fingerprint = proof.fingerprint;
  if (proof.unproven.empty() || proof.unproven == row.message) return;
  row.message += (row.message.empty() ? "no certificate: " : "; no certificate: ") + proof.unproven;
}

Problem doubtful(const std::string &why) {
  Problem out;
  out.doubt = why;
  return out;
}

} // namespace curve_proximity
