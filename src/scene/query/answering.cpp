/* SPDX-License-Identifier: BSD-3-Clause */
#include "answering.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "proving.h"

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

/* How far the curve's points can be from a position. */
double farthest(const CompiledCurve &curve, const cprox_vec3 &from) {
  double far = 0.0;
  const auto look = [&](const Eigen::AlignedBox3d &box) {
    const Eigen::Vector3d p = toEigen(from);
    far = std::max(far, (box.min() - p).cwiseAbs().cwiseMax((box.max() - p).cwiseAbs()).norm());
  };
  for (const Eigen::AlignedBox3d &box : curve.boxes) look(box);
  if (curve.boxes.empty()) {
    const cprox_curve_info info = cprox_curve_get_info(curve.curve.get());
    look({toEigen(info.lowest), toEigen(info.highest)});
  }
  return far + curve.reach;
}

/* What of a mesh has answered. */
void sayModel(cprox_lod max_lod, const PlacedShape &shape, Answer &answer) {
  const bool coarse = max_lod == CPROX_LOD_SPHERE || max_lod == CPROX_LOD_HULL;
  answer.by_hull = coarse;
  if (coarse) {
    const std::string model = max_lod == CPROX_LOD_HULL ? "convex hull" : "bounding sphere";
    answer.message = "the nearest shape is a mesh: its " + model + " answers for it";
  } else if (shape.is_open) {
    answer.message = "the nearest shape is a mesh that is not closed: its surface alone counts";
  } else {
    answer.message = cprox_body_get_info(shape.obstacle.body).is_solid
                         ? "the nearest shape is a closed mesh: its inside counts"
                         : "the nearest shape is a mesh: its surface alone counts";
  }
}

} // namespace

double microsecondsSince(Clock::time_point start) {
  return std::chrono::duration<double, std::micro>(Clock::now() - start).count();
}

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
  if (in_all && query.per_object) return "per_object does not apply: there is no answer for each object here";
  return faultOf(query);
}

std::string faultOfMoving(const Snapshot &snapshot, const std::vector<std::string> &objects) {
  const auto &moving = snapshot.moving();
  if (moving.empty()) return "";
  std::string name = objects.empty() ? moving.begin()->first : "";
  for (const std::string &object : objects)
    if (moving.count(object) > 0) name = object;
  return name.empty() ? "" : "object '" + name + "' moves along a trajectory, and this query takes objects that stand";
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

Answer unasked(const std::string &id, const std::string &kind, const Query &query) {
  Answer answer = refusal(id, kind, cprox_status_text(CPROX_STOPPED));
  cprox_result &result = answer.result;
  result.status = CPROX_STOPPED;
  result.mover_part = -1;
  result.lower = query.options.signed_distance ? -INFINITE : 0.0;
  result.upper = INFINITE;
  result.t_obstacle = std::numeric_limits<double>::quiet_NaN();
  answer.status = cprox_status_name(CPROX_STOPPED);
  return answer;
}

Query withoutCertificate(Query query) {
  query.options.certificate = nullptr;
  return query;
}

cprox_options withoutRounding(cprox_options options, double rounding) {
  if (options.epsilon > 4.0 * rounding) options.epsilon -= 2.0 * rounding;
  return options;
}

cprox_status askCore(const Query &query, const cprox_options &options, const cprox_mover &mover,
                     const std::vector<cprox_obstacle> &obstacles, Workspace &workspace, cprox_result &result) {
  ObstaclesHandle set;
  const cprox_status made = makeObstacles(obstacles, CPROX_INDEX_NONE, workspace, set);
  return made < 0 ? made : askCore(query, options, mover, set.get(), workspace, result);
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

namespace {

/* An interval of a profile, widened by rounding; `status` is that of the whole profile. */
ClearanceInterval toInterval(const cprox_profile_interval &found, double rounding, const cprox_options &options,
                             double horizon, cprox_status status) {
  ClearanceInterval out;
  out.t0 = found.t0;
  out.t1 = found.t1;
  out.t = found.t;
  out.witness_a = found.witness_mover, out.witness_b = found.witness_obstacle;
  out.lower = std::max(0.0, found.lower - rounding);
  out.upper = found.upper > 0.0 ? found.upper + rounding : found.upper;
  const bool wide = out.upper - out.lower > std::max(options.epsilon, options.relative_epsilon * out.upper);
  if (wide && !(out.lower > horizon)) out.status = status == CPROX_OK ? CPROX_PRECISION : status;
  return out;
}

/* That the distance is greater than its lower bound, or at most the upper one. */
std::string provenInterval(const Query &query, const Stated &stated, const Obstacles &set,
                           const cprox_profile_interval &found, Workspace &workspace, std::string &unproven) {
  PartialClaim claim{{found.t0, found.t1}, found.lower, !(found.lower > 0.0), true, cprox_result{}};
  if (claim.near) claim.delta = std::max(found.upper, 0.0);
  if (!std::isfinite(claim.delta)) return {};
  claim.answer.verdict = CPROX_VERDICT_UNDECIDED;
  claim.answer.lower = found.lower, claim.answer.upper = found.upper, claim.answer.t = found.t;
  claim.answer.obstacle_index = found.obstacle_index, claim.answer.mover_part = found.mover_part;
  claim.answer.witness_mover = found.witness_mover, claim.answer.witness_obstacle = found.witness_obstacle;
  return certificateOf(query, stated.mover, set.get(), claim, workspace, unproven);
}

} // namespace

std::vector<ClearanceInterval> searchProfile(const Stated &stated, const std::vector<double> &breaks, double horizon,
                                             const Query &query, Workspace &workspace) {
  if (stated.is_empty) return profileOfNothing(breaks);
  std::vector<cprox_profile_interval> intervals(breaks.size() - 1);
  const Obstacles set(stated.obstacles, CPROX_INDEX_NONE);
  cprox_options options = withoutRounding(query.options, stated.rounding);
  options.certificate = nullptr;
  const cprox_status status =
      cprox_obstacles_profile(set.get(), stated.mover, breaks.data(), intervals.size(), horizon + stated.rounding,
                              &options, workspace.get(), intervals.data());
  if (status < 0) throw Error(workspace.reason(), status);
  std::vector<ClearanceInterval> out;
  for (const cprox_profile_interval &found : intervals) {
    out.push_back(toInterval(found, stated.rounding, query.options, horizon, status));
    Answer sides;
    sides.result.obstacle_index = found.obstacle_index, sides.result.mover_part = found.mover_part;
    sides.result.witness_mover = found.witness_mover, sides.result.witness_obstacle = found.witness_obstacle;
    stated.name(sides);
    out.back().a = sides.a, out.back().witness_a = sides.result.witness_mover;
    out.back().b = sides.b, out.back().witness_b = sides.result.witness_obstacle;
    if (std::isinf(sides.result.upper)) out.back().upper = INFINITE;
    if (query.options.certificate)
      out.back().certificate = provenInterval(query, stated, set, found, workspace, out.back().unproven);
  }
  return out;
}

std::vector<ClearanceInterval> profileOfNothing(const std::vector<double> &breaks) {
  std::vector<ClearanceInterval> out(breaks.size() - 1);
  for (std::size_t i = 0; i < out.size(); ++i) {
    out[i].t0 = out[i].t = breaks[i];
    out[i].t1 = breaks[i + 1];
    out[i].lower = out[i].upper = INFINITE;
  }
  return out;
}

void searchContact(const cprox_mover &mover, const std::vector<cprox_obstacle> &enlarged, const Query &query,
                   Workspace &workspace, cprox_result &result) {
  ObstaclesHandle set;
  cprox_options options = query.options;
  options.certificate = nullptr; // it is about obstacles that are not enlarged
  result.status = makeObstacles(enlarged, CPROX_INDEX_NONE, workspace, set);
  if (result.status >= 0)
    result.status = cprox_obstacles_time_of_contact(set.get(), mover, &options, workspace.get(), &result);
}

std::string faultOfDistances(const Query &query) {
  if (query.query_type != QueryType::DISTANCE)
    return "query_type does not apply: pairs and clearance profiles are answered by their distances";
  if (query.options.certificate) return "a certificate does not apply: nearest pairs have none";
  return "";
}

std::string faultOfProfile(const Query &query, const std::vector<double> &breaks, double horizon) {
  if (breaks.size() < 2) return "a clearance profile needs at least two breaks";
  if (!(horizon >= 0.0)) return "horizon is " + std::to_string(horizon) + ", must be 0 or more, or infinity";
  if (query.options.signed_distance)
    return "signed_distance does not apply: a clearance profile does not measure depths";
  return "";
}

std::string faultOfContact(const Query &query) {
  if (query.query_type != QueryType::COLLISION)
    return "query_type does not apply: the time of contact is a query of type collision";
  return "";
}

double roundingOf(const CompiledCurve &curve, const PlacedShape &shape) {
  if (!(shape.turning > 0.0)) return shape.rounding;
  return shape.rounding + shape.turning * farthest(curve, shape.obstacle.pose.position);
}

void nameItem(const Item &item, cprox_lod max_lod, Answer &answer) {
  answer.result.obstacle_index = item.part;
  answer.b = *item.owner;
  answer.b_is_link = item.is_link;
  if (item.shape->is_mesh) sayModel(max_lod, *item.shape, answer);
  if (isReplaced(max_lod, item.shape->is_mesh)) claimOneSide(answer.result);
}

void claimOneSide(cprox_result &result) {
  result.upper = INFINITE;
  if (result.verdict == CPROX_VERDICT_VIOLATED) result.verdict = CPROX_VERDICT_UNDECIDED;
}

void finishAnswer(const Workspace &workspace, Answer &answer) {
  const cprox_result &result = answer.result;
  if (result.status < 0) answer.message = workspace.reason();
  if (result.status != CPROX_OK && answer.message.empty()) answer.message = cprox_status_text(result.status);
  answer.status = cprox_status_name(result.status);
}

void Unlisted::add(cprox_status of_list, const cprox_listed &listed, double rounding) {
  if (of_list > CPROX_OK) status = of_list;
  lower = std::min(lower, std::max(0.0, listed.others - rounding));
}

void Unlisted::addRow(const PairLimits &limits, const cprox_options &options, const std::string &id,
                      const std::string &kind, std::vector<Answer> &answers) const {
  double limit = limits.within;
  if (answers.size() >= limits.count) { // what is as far as the last one may as well be left out
    const double last = answers.back().result.upper;
    if (std::isfinite(last))
      limit = std::min(limit, last - 2.0 * std::max(options.epsilon, options.relative_epsilon * last));
  }
  if (status == CPROX_OK || !(lower < limit)) return;
  Answer row = refusal(id, kind,
                       "the list is not complete: pairs that it does not name are only known to be at least " +
                           std::to_string(lower) + " m away");
  row.is_unlisted = true;
  row.result.status = status;
  row.result.lower = lower;
  row.result.upper = INFINITE;
  row.result.t = row.result.t_obstacle = std::numeric_limits<double>::quiet_NaN();
  row.result.mover_part = -1;
  row.status = cprox_status_name(status);
  answers.push_back(std::move(row));
}

void answerNothing(const Query &query, cprox_result &result) {
  result.lower = result.upper = INFINITE;
  result.obstacle_index = -1;
  result.verdict = query.query_type == QueryType::DISTANCE ? CPROX_VERDICT_UNDECIDED : CPROX_VERDICT_CLEAR;
}

Coverage coverageOf(const Query &query, const Coverage &given, const std::string &nothing) {
  Coverage out = given;
  out.add(query.coverage);
  if (!nothing.empty() && !query.allow_empty)
    out.add(Gap::EMPTY, "nothing was measured: " + nothing, Missing::GEOMETRY);
  return out;
}

void applyCoverage(const Coverage &coverage, const Query &query, Answer &answer) {
  cprox_result &result = answer.result;
  if (result.status < 0 || coverage.complete()) return;
  answer.gap = coverage.gap();
  answer.status = coverage.status();
  answer.message += (answer.message.empty() ? "" : "; ") + coverage.message();
  result.lower = query.options.signed_distance ? -INFINITE : 0.0;
  result.t_contact_lower = std::numeric_limits<double>::quiet_NaN();
  if (result.verdict == CPROX_VERDICT_CLEAR || !coverage.provesContact()) result.verdict = CPROX_VERDICT_UNDECIDED;
}

void applyCoverage(const Coverage &coverage, const Query &query, const Answer &nothing, std::vector<Answer> &answers) {
  if (coverage.complete()) return;
  if (answers.empty()) {
    answers.push_back(nothing);
    answers.back().result = cprox_result();
    answerNothing(query, answers.back().result);
  }
  for (Answer &answer : answers) applyCoverage(coverage, query, answer);
}

void applyCoverage(const Coverage &coverage, std::vector<ClearanceInterval> &profile) {
  if (coverage.complete()) return;
  for (ClearanceInterval &interval : profile) interval.lower = 0.0, interval.gap = coverage.gap();
}

std::array<double, 2> domainOf(const Query &query, const std::array<double, 2> &all) {
  const double *interval = query.options.interval;
  return interval ? std::array<double, 2>{interval[0], interval[1]} : all;
}

void applyCoverage(const Coverage &coverage, const std::array<double, 2> &domain, Violations &violations) {
  if (coverage.complete()) return;
  violations.gap = coverage.gap();
  violations.message += (violations.message.empty() ? "" : "; ") + coverage.message();
  std::vector<Violation> &list = violations.list;
  if (list.empty()) {
    list.emplace_back();
    list.front().enter_upper = list.front().leave_lower = list.front().t = domain[0];
    list.front().upper = INFINITE;
  }
  double before = domain[0];
  for (Violation &one : list) {
    one.enter_lower = before;
    before = one.leave_upper = std::max(one.leave_lower, one.enter_upper);
    if (!coverage.provesContact()) one.verdict = CPROX_VERDICT_UNDECIDED;
  }
  list.back().leave_upper = domain[1];
}

} // namespace curve_proximity
