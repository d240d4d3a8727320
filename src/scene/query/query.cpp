/* SPDX-License-Identifier: BSD-3-Clause */
#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include <curve_proximity/query.hpp>

#include "answering.h"
#include "geometry/placing.h"
#include "proving.h"
#include "scene_obstacles.h"
#include "second_opinion.h"

namespace curve_proximity {
namespace {

/* Room for the rounding of a sum of a few lengths. */
constexpr double SUMS = 1e-14;

/* One search: a curve against some of the items. */
struct Search {
  const CompiledCurve &curve;
  const Query &query;
  const std::vector<Item> &items;
  const cprox_obstacles *all; /* all items, ready made; may be null */
  Workspace &workspace;

  std::vector<std::uint32_t> chosen; /* indices of items that the core is to look at */
  double left_out = INFINITE;        /* [m] what was not chosen is farther than this */

  const PlacedShape &shape(std::uint32_t index) const {
    return *items[index].shape;
  }
};

/* ---- rounding ---- */

/* The most that rounding can have moved any of the chosen shapes. */
double roundingOf(const Search &search) {
  double most = 0.0;
  for (const std::uint32_t index : search.chosen) most = std::max(most, roundingOf(search.curve, search.shape(index)));
  return most;
}

/* ---- the choice of what can matter ---- */

double gapTo(const CompiledCurve &curve, const PlacedShape &shape) {
  double gap = INFINITE;
  for (const Eigen::AlignedBox3d &box : curve.boxes) gap = std::min(gap, boxGap(box, shape.box));
  return gap;
}

/* The bounded item whose box is nearest. */
NearestBox nearestBoxOf(const Search &search, const SceneObstacles::Data &data) {
  NearestBox nearest = data.snapshot->world().nearest(search.curve.boxes);
  for (std::size_t i = data.in_tree; i < search.items.size(); ++i) {
    const auto index = static_cast<std::uint32_t>(i);
    const double gap = unbounded(search.shape(index)) ? INFINITE : gapTo(search.curve, search.shape(index));
    if (gap < nearest.gap) nearest = {index, gap};
  }
  return nearest;
}

/* Chooses the items whose boxes are within reach of the curve's, the halfspaces and the seed. */
void chooseWithin(double reach, const NearestBox &seed, const SceneObstacles::Data &data, Search &search) {
  const World &world = data.snapshot->world();
  std::vector<std::uint32_t> &chosen = search.chosen;
  world.within(search.curve.boxes, reach, chosen);
  chosen.insert(chosen.end(), world.unbounded().begin(), world.unbounded().end());
  for (std::size_t i = data.in_tree; i < search.items.size(); ++i) {
    const auto index = static_cast<std::uint32_t>(i);
    if (!(gapTo(search.curve, search.shape(index)) > reach)) chosen.push_back(index);
  }
  chosen.push_back(seed.id);

  std::sort(chosen.begin(), chosen.end());
  chosen.erase(std::unique(chosen.begin(), chosen.end()), chosen.end());
}

void chooseAll(Search &search, std::size_t first, std::size_t last) {
  search.chosen.reserve(last - first);
  for (std::size_t i = first; i < last; ++i) search.chosen.push_back(static_cast<std::uint32_t>(i));
}

/* Distance: nothing whose box is farther than some point of the curve is from the seed can be the nearest. */
void chooseForDistance(const NearestBox &seed, const SceneObstacles::Data &data, Search &search) {
  cprox_options rough = search.query.options;
  rough.relative_epsilon = std::max(rough.relative_epsilon, 0.1);
  cprox_result result{};
  const cprox_status status =
      cprox_distance(moverOf(search.curve), search.shape(seed.id).obstacle, &rough, search.workspace.get(), &result);
  if (status < 0) { // the core will refuse again, and say why
    search.chosen.push_back(seed.id);
    return;
  }
  const double upper = result.upper + search.shape(seed.id).rounding;
  chooseWithin((upper + search.curve.reach) * (1.0 + SUMS), seed, data, search);
  search.left_out = upper;
}

/* Verdicts: nothing whose box is farther than the limit, and a little more, can touch them. */
void chooseForVerdict(double limit, const NearestBox &seed, const SceneObstacles::Data &data, Search &search) {
  const double wide = limit + search.curve.reach;
  const double more = std::max({search.query.options.epsilon, 1e-3 * wide, 1e-6});
  if (!std::isfinite(wide + more) || wide < 0.0) { // the core will refuse, and say why
    search.chosen.push_back(seed.id);
    return;
  }
  chooseWithin(wide + more, seed, data, search);
  const double boxes_apart = seed.gap * (1.0 - 1e-12) - search.curve.reach * (1.0 + SUMS);
  search.left_out = std::max(limit + 0.5 * more, boxes_apart);
}

void choose(const SceneObstacles::Data &data, Search &search) {
  const bool with_tree = data.in_tree > 0 && search.items.size() > FEW_SHAPES && !search.curve.boxes.empty();
  const NearestBox seed = with_tree ? nearestBoxOf(search, data) : NearestBox();
  if (seed.gap == INFINITE) {
    chooseAll(search, 0, search.items.size());
    return;
  }
  switch (search.query.query_type) {
    case QueryType::DISTANCE: chooseForDistance(seed, data, search); break;
    case QueryType::TOLERANCE: chooseForVerdict(search.query.delta, seed, data, search); break;
    case QueryType::COLLISION: chooseForVerdict(0.0, seed, data, search); break;
  }
  if (search.chosen.size() == search.items.size()) search.left_out = INFINITE;
}

/* ---- the search ---- */

cprox_status runCore(const Search &search, const cprox_options &options, cprox_result &result) {
  const cprox_mover mover = moverOf(search.curve);
  if (search.all && search.chosen.size() == search.items.size())
    return askCore(search.query, options, mover, search.all, search.workspace, result);
  std::vector<cprox_obstacle> obstacles;
  obstacles.reserve(search.chosen.size());
  for (const std::uint32_t index : search.chosen) obstacles.push_back(search.shape(index).obstacle);
  return askCore(search.query, options, mover, obstacles, search.workspace, result);
}

void nameObstacle(const Search &search, Answer &answer) {
  const std::int32_t found = answer.result.obstacle_index;
  if (found < 0) return;
  nameItem(search.items[search.chosen[static_cast<std::size_t>(found)]], search.query.options.max_lod, answer);
}

void answerOf(const Search &search, const Coverage &given, Answer &answer) {
  answer.id = answer.a = search.curve.id;

  const double rounding = roundingOf(search);
  const cprox_options options = withoutRounding(search.query.options, rounding);

  cprox_result &result = answer.result;
  result.obstacle_index = -1;
  result.status = runCore(search, options, result);
  if (result.status >= 0 && search.chosen.empty()) {
    answerNothing(search.query, result);
  } else if (result.status >= 0) {
    widen(search.query, rounding, search.left_out, result);
    nameObstacle(search, answer);
  }
  finishAnswer(search.workspace, answer);
  applyCoverage(coverageOf(search.query, given, search.chosen.empty() ? NO_OBJECT : ""), search.query, answer);
}

/* With the proof of the one answer: about everything that was asked about, and not only what the search chose. */
Answer askWithProof(const SceneObstacles &obstacles, const CompiledCurve &curve, const Query &query,
                    Workspace &workspace) {
  Query bare = query;
  bare.options.certificate = nullptr;
  Answer answer = ask(obstacles, curve, bare, workspace).front();
  cprox_result named = answer.result;
  named.obstacle_index = coreObstacleOf(obstacles, answer);
  leaveProof(query, moverOf(curve), coreObstacles(obstacles), named, workspace, answer);
  return answer;
}

} // namespace

std::vector<Answer> ask(const SceneObstacles &obstacles, const CompiledCurve &curve, const Query &query,
                        Workspace &workspace) {
  std::vector<Answer> answers;
  ask(obstacles, curve, query, workspace, answers);
  return answers;
}

void ask(const SceneObstacles &obstacles, const CompiledCurve &curve, const Query &query, Workspace &workspace,
         std::vector<Answer> &answers) {
  cprox_certificate_clear(query.options.certificate);
  const std::string fault = faultOf(query);
  if (!fault.empty()) {
    answers.push_back(refusal(curve.id, "curve", fault));
    answers.back().a = curve.id;
    return;
  }
  if (query.options.certificate) {
    answers.push_back(askWithProof(obstacles, curve, query, workspace));
    return;
  }
  const SceneObstacles::Data &data = obstacles.data();
  const std::vector<Item> &items = data.items;

  // One in all.
  if (!query.per_object || items.empty()) {
    const Clock::time_point start = Clock::now();
    Search search{curve, query, items, data.few.get(), workspace, {}, INFINITE};
    choose(data, search);
    answers.emplace_back();
    answerOf(search, data.coverage, answers.back());
    answers.back().microseconds = microsecondsSince(start);
    addSecondOpinion(data, curve, query, answers.back());
    return;
  }

  // One for each run of items of the same owner.
  for (std::size_t first = 0; first < items.size();) {
    const Clock::time_point start = Clock::now();
    std::size_t last = first + 1;
    while (last < items.size() && items[last].owner == items[first].owner) ++last;
    const bool ended = !answers.empty() && query.options.stop && query.options.stop(query.options.stop_user);
    if (ended) {
      answers.push_back(unasked(curve.id, "curve", query));
      answers.back().a = curve.id;
      applyCoverage(coverageOf(query, data.coverage, ""), query, answers.back());
    } else {
      Search search{curve, query, items, nullptr, workspace, {}, INFINITE};
      chooseAll(search, first, last);
      answers.emplace_back();
      answerOf(search, data.coverage, answers.back());
    }
    if (answers.back().b.empty()) { // refused: say of which
      answers.back().b = *items[first].owner;
      answers.back().b_is_link = items[first].is_link;
    }
    answers.back().microseconds = microsecondsSince(start);
    addSecondOpinion(data, curve, query, answers.back());
    first = last;
  }
}

std::vector<Answer> ask(const SnapshotPtr &snapshot, const LinkPoses &links, const CurveDescription &curve,
                        const Query &query, Workspace &workspace) {
  try {
    return ask(SceneObstacles(snapshot, links, query), compile(curve), query, workspace);
  } catch (const Error &error) {
    Answer answer;
    answer.id = answer.a = curve.id;
    answer.result.status = error.status();
    answer.result.obstacle_index = -1;
    answer.status = cprox_status_name(error.status());
    answer.message = error.what();
    return {answer};
  }
}

} // namespace curve_proximity
