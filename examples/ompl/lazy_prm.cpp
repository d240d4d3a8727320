/* SPDX-License-Identifier: BSD-3-Clause */
#include "lazy_prm.hpp"

#include <ompl/util/RandomNumbers.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <limits>
#include <queue>
#include <utility>

namespace {

constexpr std::size_t NEIGHBOURS = 10;
constexpr double SPREAD = 0.4; /* [rad] */

using Posture = std::vector<double>;
using Edge = std::pair<std::size_t, std::size_t>;

double apart(const Posture &a, const Posture &b) {
  double sum = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) sum += (a[k] - b[k]) * (a[k] - b[k]);
  return std::sqrt(sum);
}

/* Start, goal and random clear postures, a fifth of them about start and goal. */
std::vector<Posture> drawPostures(const Task &task, const std::vector<double> &lowest,
                                  const std::vector<double> &highest, std::size_t n) {
  curve_proximity::Workspace workspace;
  ompl::RNG random;
  std::vector<Posture> out = {task.start, task.goal};
  while (out.size() < n) {
    Posture posture(lowest.size());
    const Posture *about = out.size() % 10 < 2 ? &out[out.size() % 10] : nullptr;
    for (std::size_t k = 0; k < posture.size(); ++k)
      posture[k] = about ? std::clamp(random.gaussian((*about)[k], SPREAD), lowest[k], highest[k])
                         : random.uniformReal(lowest[k], highest[k]);
    if (isClear(task, posture.data(), posture.data(), workspace)) out.push_back(std::move(posture));
  }
  return out;
}

/* To the nearest ones, each pair once. */
std::vector<Edge> drawEdges(const std::vector<Posture> &postures) {
  std::vector<Edge> out;
  std::vector<std::pair<double, std::size_t>> others(postures.size());
  for (std::size_t i = 0; i < postures.size(); ++i) {
    for (std::size_t k = 0; k < postures.size(); ++k) others[k] = {apart(postures[i], postures[k]), k};
    const auto end = others.begin() + std::min(NEIGHBOURS + 1, others.size());
    std::partial_sort(others.begin(), end, others.end());
    for (auto other = others.begin() + 1; other != end; ++other) out.emplace_back(std::minmax(i, other->second));
  }
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

/* The edges of the shortest way from the first to the second posture along edges that pass; empty: there is none. */
std::vector<std::size_t> shortestWay(const std::vector<Posture> &postures, const std::vector<Edge> &edges,
                                     const std::vector<bool> &pass) {
  std::vector<std::vector<std::size_t>> of(postures.size());
  for (std::size_t e = 0; e < edges.size(); ++e) {
    if (!pass[e]) continue;
    of[edges[e].first].push_back(e);
    of[edges[e].second].push_back(e);
  }
  std::vector<double> length(postures.size(), std::numeric_limits<double>::infinity());
  std::vector<std::size_t> by(postures.size(), edges.size());
  std::priority_queue<std::pair<double, std::size_t>> open; /* negative lengths: the shortest first */
  length[0] = 0.0;
  open.emplace(0.0, 0);
  while (!open.empty()) {
    const auto [so_far, at] = open.top();
    open.pop();
    if (-so_far > length[at]) continue;
    for (const std::size_t e : of[at]) {
      const std::size_t next = edges[e].first == at ? edges[e].second : edges[e].first;
      const double longer = length[at] + apart(postures[at], postures[next]);
      if (longer >= length[next]) continue;
      length[next] = longer;
      by[next] = e;
      open.emplace(-longer, next);
    }
  }
  std::vector<std::size_t> way;
  for (std::size_t at = 1; at != 0 && by[at] != edges.size();) {
    way.push_back(by[at]);
    at = edges[by[at]].first == at ? edges[by[at]].second : edges[by[at]].first;
  }
  return way;
}

} // namespace

bool planByRoadmap(const Task &task, const std::vector<double> &lowest, const std::vector<double> &highest,
                   std::size_t n) {
  const std::vector<Posture> postures = drawPostures(task, lowest, highest, n / 6 + 2);
  std::vector<Edge> edges = drawEdges(postures);
  if (edges.size() > n) {
    std::vector<Edge> kept; /* those of start and goal first */
    for (const Edge &edge : edges)
      if (edge.first < 2 || kept.size() < n) kept.push_back(edge);
    edges = std::move(kept);
  }
  curve_proximity::Workspace workspace;
  std::vector<bool> proven;
  bool good = true;
  std::printf(
      "a roadmap of %zu postures and %zu edges\n"
      "%-30s %8s %12s %8s %14s %17s\n",
      postures.size(), edges.size(), "edges", "seconds", "us an edge", "clear", "wrongly clear", "path, in contact");
  for (const double step : {0.0, 0.05, 0.01}) {
    std::vector<bool> pass(edges.size());
    const auto begin = std::chrono::steady_clock::now();
    for (std::size_t e = 0; e < edges.size(); ++e) {
      const double *from = postures[edges[e].first].data(), *to = postures[edges[e].second].data();
      pass[e] = step > 0.0 ? isClearAtSamples(task, from, to, step, workspace) : isClear(task, from, to, workspace);
    }
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    if (step == 0.0) proven = pass;
    std::size_t clear = 0, wrong = 0, in_contact = 0;
    for (std::size_t e = 0; e < edges.size(); ++e) {
      clear += pass[e];
      wrong += pass[e] && !proven[e];
      good = good && (pass[e] || !proven[e]);
    }
    const std::vector<std::size_t> way = shortestWay(postures, edges, pass);
    for (const std::size_t e : way) in_contact += !proven[e];
    char name[40];
    std::snprintf(name, sizeof name, step > 0.0 ? "sampled each %g rad" : "proven", step);
    std::printf("%-30s %8.3f %12.2f %8zu %14zu %10zu, %zu\n", name, seconds,
                1e6 * seconds / static_cast<double>(edges.size()), clear, wrong, way.size(), in_contact);
    std::fflush(stdout);
  }
  return good;
}
