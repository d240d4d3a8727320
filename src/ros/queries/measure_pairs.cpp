/* SPDX-License-Identifier: BSD-3-Clause */
#include "queries/measure_pairs.h"

#include <cmath>
#include <utility>

#include "../../providers/provider_set.h"
#include "../../scene/query/pair_query.h"
#include "messages/geometry_message.h"
#include "messages/shape_message.h"
#include "queries/row_message.h"
#include "transport/request_limits.h"
#include "world/robot_description.h"

namespace curve_proximity {
namespace {

PlacedBody toPlacedBody(const Body &body, const geometry_msgs::Pose &pose, const char *name) {
  try {
    PlacedBody out;
    out.shape = toShape(body);
    if (isUnset(pose)) return out;
    toIsometry(pose); // so that it is finite, and the quaternion a rotation
    out.pose = {{pose.position.x, pose.position.y, pose.position.z},
                {pose.orientation.w, pose.orientation.x, pose.orientation.y, pose.orientation.z}};
    return out;
  } catch (const Error &error) {
    throw Error(std::string(name) + ": " + error.what(), error.status());
  }
}

/** Throws Error: an unknown question, a velocity or duration of bodies that stand. */
PairDescription toPairDescription(const PairQuery &message) {
  const std::optional<PairDescription::Asked> asked = pairQuestion(message.ask);
  if (!asked)
    throw Error("ask '" + message.ask +
                "' is unknown; it must be distance, growth, translating_distance or translating_contact");
  PairDescription out;
  out.asked = *asked;
  out.id = message.id;
  out.a = toPlacedBody(message.a, message.pose_a, "a");
  out.b = toPlacedBody(message.b, message.pose_b, "b");
  out.velocity_a = {message.velocity_a.x, message.velocity_a.y, message.velocity_a.z};
  out.velocity_b = {message.velocity_b.x, message.velocity_b.y, message.velocity_b.z};
  out.duration = message.duration;
  const bool moves = !out.velocity_a.isZero(0.0) || !out.velocity_b.isZero(0.0) || out.duration != 0.0;
  if (moves && !isTranslating(out.asked))
    throw Error("there is a velocity or a duration: bodies move with translating_distance and translating_contact");
  return out;
}

Proximity toRow(const Answer &answer, PairDescription::Asked asked) {
  Proximity row;
  Question question = question::Search{};
  if (asked == PairDescription::TRANSLATING_CONTACT) question = question::Contact{};
  fillRow(answer, question, isTranslating(asked) ? QueryType::COLLISION : QueryType::DISTANCE, row);
  return row;
}

} // namespace

Pairs::Pairs(const Parameters &parameters, const Tuning &tuning, Statistics &statistics,
             std::shared_ptr<const SecondOpinions> opinions)
    : parameters_(parameters), tuning_(tuning), statistics_(statistics), opinions_(std::move(opinions)) {}

void Pairs::answer(const MeasurePairs::Request &request, MeasurePairs::Response &response, TimeBudget &budget) {
  const TimeBudget::Clock::time_point begin = TimeBudget::Clock::now();
  demandAtMost("max_curves", parameters_.max_curves, request.pairs.size(), "pairs");
  NameLimits(parameters_.max_name_length).check(request);
  if (!(request.epsilon >= 0.0) || !std::isfinite(request.epsilon))
    throw Error("epsilon is " + std::to_string(request.epsilon) + ": it must be finite and at least 0");

  Query query;
  query.options.epsilon = request.epsilon > 0.0 ? request.epsilon : tuning_.epsilon.load();
  query.options.max_nodes = static_cast<std::uint32_t>(tuning_.max_nodes.load());
  query.options.stop = TimeBudget::isOver;
  query.options.stop_user = &budget;
  query.second_opinion = opinions_;
  ResourceOptions resources = resourceOptions("", parameters_);
  resources.mesh_tolerance = 0.0; // pairs are of the meshes themselves
  resources.stop = [&budget] { return TimeBudget::isOver(&budget); };
  const WorkspacePool::Lease workspace(workspaces_);

  Failures failures;
  for (std::size_t i = 0; i < request.pairs.size(); ++i) {
    const PairQuery &asked = request.pairs[i];
    Proximity row;
    const std::string why = messageOf([&] {
      budget.demand();
      const PairDescription pair = toPairDescription(asked);
      row = toRow(askPair(pair, query, resources, *workspace), pair.asked);
    });
    if (!why.empty()) {
      row = toFailedRow(asked.id, asked.ask.empty() || asked.ask == PairQuery::DISTANCE ? "pair" : asked.ask, why);
      row.b = asked.id;
      failures.count("pair " + std::to_string(i) + " ('" + asked.id + "'): " + why);
    }
    response.results.push_back(std::move(row));
  }
  response.success = true;
  failures.tell(response);
  statistics_.record(TimeBudget::Clock::now() - begin, response.success != 0, response.results);
}

} // namespace curve_proximity
