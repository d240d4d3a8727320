/* SPDX-License-Identifier: BSD-3-Clause */
#include "queries/link_pairs.h"

#include <cmath>
#include <curve_proximity/collision_matrix.hpp>
#include <curve_proximity/nearest_name.hpp>
#include <set>

#include "transport/request_limits.h"

namespace curve_proximity {
namespace {

using NamePair = std::array<std::string, 2>;

NamePair sorted(const NamePair &pair) {
  return pair[1] < pair[0] ? NamePair{pair[1], pair[0]} : pair;
}

void fill(const LinkContact &contact, LinkPair &row) {
  row.contact = contactName(contact);
  row.adjacent = contact.adjacent;
  row.lower = contact.result.lower;
  row.upper = contact.result.upper;
  for (const auto &[joint, value] : contact.posture) row.joints.push_back(joint), row.positions.push_back(value);
  row.nodes = contact.result.nodes;
  row.distance_queries = contact.result.distance_queries;
  row.message = contact.message;
}

} // namespace

void answerLinkPairs(const ListLinkPairs::Request &request, ListLinkPairs::Response &response, const LiveScene &live,
                     cprox_options options, int most_pairs, TimeBudget &budget) {
  if (!(request.epsilon >= 0.0 && std::isfinite(request.epsilon)))
    throw Error("epsilon is " + std::to_string(request.epsilon) + ": it must be finite and at least 0");
  if (request.epsilon > 0.0) options.epsilon = request.epsilon;
  if (request.max_nodes != 0) options.max_nodes = request.max_nodes;
  options.stop = TimeBudget::isOver;
  options.stop_user = &budget;
  const SnapshotPtr snapshot = live.scene.snapshot();
  if (!snapshot->robot()) throw Error("this server has no robot, only objects");
  const auto &links = snapshot->robot()->links();
  for (const std::string &link : request.links)
    if (links.count(link) == 0) throw Error("the robot has no link '" + link + "'" + didYouMean(link, namesOf(links)));

  const std::set<std::string> asked(request.links.begin(), request.links.end());
  const auto isAsked = [&](const std::string &link) { return asked.empty() || asked.count(link) > 0; };
  std::uint64_t with_geometry = 0, not_asked = 0;
  for (const auto &[link, geometries] : links)
    if (!geometries.empty()) ++with_geometry, not_asked += !isAsked(link);
  const auto pairsOf = [](std::uint64_t n) { return n * (n - 1) / 2; };
  demandAtMost("max_results", most_pairs, pairsOf(with_geometry) - pairsOf(not_asked), "pairs of links");

  const CollisionMatrix matrix(snapshot);
  std::set<NamePair> disabled; // a list of them is as long as the matrix
  for (const NamePair &pair : live.disabled(*snapshot)) disabled.insert(sorted(pair));
  Workspace workspace;
  response.success = true;
  for (std::size_t i = 0; i < matrix.pairs().size(); ++i) {
    const NamePair &pair = matrix.pairs()[i];
    if (!isAsked(pair[0]) && !isAsked(pair[1])) continue;
    LinkPair row;
    row.a = pair[0], row.b = pair[1];
    row.allowed = disabled.count(sorted(pair)) > 0 || snapshot->mayTouch(pair[0], pair[1]);
    row.contact = LinkPair::UNDECIDED;
    row.upper = INFINITY;
    try {
      if (budget.isReached())
        row.message = budget.reason();
      else
        fill(matrix.ask(i, options, workspace), row);
    } catch (const Error &error) {
      row.message = error.what();
      if (response.success) response.message = pair[0] + " and " + pair[1] + ": " + error.what();
      response.success = false;
    }
    response.pairs.push_back(std::move(row));
  }
}

} // namespace curve_proximity
