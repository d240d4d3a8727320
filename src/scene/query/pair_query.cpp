/* SPDX-License-Identifier: BSD-3-Clause */
#include "pair_query.h"

#include <array>
#include <chrono>
#include <utility>

#include "answering.h"

namespace curve_proximity {
namespace {

constexpr std::array<std::pair<PairDescription::Asked, const char *>, 4> NAMES = {
    {{PairDescription::DISTANCE, "distance"},
     {PairDescription::GROWTH, "growth"},
     {PairDescription::TRANSLATING_DISTANCE, "translating_distance"},
     {PairDescription::TRANSLATING_CONTACT, "translating_contact"}}};

cprox_obstacle place(const Geometry &geometry, const PlacedBody &body) {
  return cprox_obstacle_at(geometry.body.get(), body.pose);
}

Geometry bodyOf(const PlacedBody &body, const ResourceOptions &resources) {
  Geometry out = makeGeometry(body.shape, resources);
  if (out.curve) throw Error("a pair is of two bodies, and one is a curve: ask for the distance of curves");
  if (!out.body) throw Error("a pair is of two bodies, and one is an octree without an occupied cell");
  return out;
}

/* What is asked of two bodies, without the time that it takes. */
cprox_result ask(const PairDescription &pair, const cprox_obstacle &a, const cprox_obstacle &b,
                 const cprox_options &options, Workspace &workspace) {
  const auto moving = [&](const auto &query, const cprox_options &with) {
    return query(translating(a, pair.velocity_a), translating(b, pair.velocity_b), pair.duration, with, workspace);
  };
  cprox_options unstopped = options; /* it is short and does not poll */
  unstopped.stop = nullptr;
  switch (pair.asked) {
    case PairDescription::TRANSLATING_DISTANCE: return moving(translatingDistance, unstopped);
    case PairDescription::TRANSLATING_CONTACT: return moving(translatingContact, options);
    case PairDescription::DISTANCE: return curve_proximity::pair(a, b, options, workspace);
    case PairDescription::GROWTH: break;
  }
  const cprox_growth growth = growthDistance(a, b, options, workspace);
  cprox_result out{};
  out.status = growth.status, out.lower = growth.lower, out.upper = growth.upper;
  out.distance_queries = growth.pairs;
  return out;
}

/* What a peer says of bodies that stand. */
void addOpinion(const PairDescription &pair, const Query &query, Answer &answer) {
  if (!query.second_opinion || answer.result.status < 0) return;
  if (pair.asked == PairDescription::DISTANCE) {
    answer.second_opinion =
        query.second_opinion->ofPair(pair.a.shape, toIsometry(pair.a.pose), pair.b.shape, toIsometry(pair.b.pose),
                                     answer.result.lower, answer.result.upper);
  } else {
    answer.second_opinion.verdict = SecondOpinion::UNKNOWN;
    answer.second_opinion.message = "no second opinion: peers are asked about bodies that stand";
  }
  if (!answer.second_opinion.message.empty())
    answer.message += (answer.message.empty() ? "" : "; ") + answer.second_opinion.message;
}

} // namespace

std::optional<PairDescription::Asked> pairQuestion(const std::string &name) {
  if (name.empty()) return PairDescription::DISTANCE;
  for (const auto &entry : NAMES)
    if (entry.second == name) return entry.first;
  return std::nullopt;
}

const char *pairKind(PairDescription::Asked asked) {
  for (const auto &entry : NAMES)
    if (entry.first == asked && asked != PairDescription::DISTANCE) return entry.second;
  return "pair";
}

bool isTranslating(PairDescription::Asked asked) {
  return asked == PairDescription::TRANSLATING_DISTANCE || asked == PairDescription::TRANSLATING_CONTACT;
}

Answer askPair(const PairDescription &pair, const Query &query, const ResourceOptions &resources,
               Workspace &workspace) {
  const Geometry a = bodyOf(pair.a, resources), b = bodyOf(pair.b, resources);
  Answer answer;
  answer.kind = pairKind(pair.asked);
  answer.id = answer.a = answer.b = pair.id;
  const Clock::time_point begin = Clock::now();
  answer.result = ask(pair, place(a, pair.a), place(b, pair.b), query.options, workspace);
  answer.microseconds = microsecondsSince(begin);
  answer.status = cprox_status_name(answer.result.status);
  if (answer.result.status != CPROX_OK) answer.message = cprox_status_text(answer.result.status);
  Query depth = query; // pairs always have one
  depth.options.signed_distance = pair.asked == PairDescription::DISTANCE;
  if (isReplaced(query.options.max_lod, a.is_mesh || b.is_mesh)) claimOneSide(answer.result);
  applyCoverage(coverageOf(query, {}, ""), depth, answer);
  addOpinion(pair, query, answer);
  return answer;
}

} // namespace curve_proximity
