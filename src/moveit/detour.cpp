/* SPDX-License-Identifier: BSD-3-Clause */
#include "detour.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace curve_proximity {
namespace {

constexpr double LEAST_ROOM = 0.1;         /* [rad], [m] round the rows of a run, for the first try */
constexpr double MOST_ROOM = 6.0;          /* of the last try but one, which takes all of the path */
constexpr std::size_t LEAST_VERTICES = 50; /* likewise; each further try has twice as many of both */
constexpr int SHORTCUTS = 20;              /* of each detour, */
constexpr std::size_t BESIDE = 4;          /* with so many rows before and behind it */
constexpr int MOST_RUNS = 64;
constexpr int SMOOTHINGS = 2;    /* likewise */
constexpr double CLOSEST = 0.01; /* of the step: rows are taken so close at least */
constexpr double STEP = 0.3;     /* of the diagonal of the box, at most; */
constexpr int STEPS = 3;         /* so many lengths are tried, */
constexpr double SHORTER = 0.25; /* each this part of the one before */
constexpr std::uint64_t SEED = 1;
constexpr double TIGHT = 1e-9; /* rows are the same */

double distanceOf(const Row &a, const Row &b) {
  double square = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) square += (a[k] - b[k]) * (a[k] - b[k]);
  return std::sqrt(square);
}

Row between(const Row &a, const Row &b, double u) {
  Row out(a.size());
  for (std::size_t k = 0; k < a.size(); ++k) out[k] = a[k] + u * (b[k] - a[k]);
  return out;
}

struct Tree {
  Path rows;
  std::vector<std::size_t> parents;

  explicit Tree(const Row &root) : rows{root}, parents{0} {}

  std::size_t nearestTo(const Row &row) const {
    const auto square = [&](const Row &other) {
      double out = 0.0;
      for (std::size_t k = 0; k < row.size(); ++k) out += (row[k] - other[k]) * (row[k] - other[k]);
      return out;
    };
    std::size_t best = 0;
    double least = square(rows[0]);
    for (std::size_t i = 1; i < rows.size(); ++i) {
      const double one = square(rows[i]);
      if (one < least) least = one, best = i;
    }
    return best;
  }

  std::size_t add(Row row, std::size_t parent) {
    rows.push_back(std::move(row));
    parents.push_back(parent);
    return rows.size() - 1;
  }

  /* From a row to the root. */
  Path back(std::size_t i) const {
    Path out{rows[i]};
    for (; i != 0; i = parents[i]) out.push_back(rows[parents[i]]);
    return out;
  }
};

/* Steps from a row of the tree towards the target, as long as they hold, at most `steps`; the last row that was
 * reached. */
std::size_t extend(Tree &tree, std::size_t at, const Row &target, double step, int steps, const EdgeTest &holds) {
  for (int shorter = 0; steps > 0 && shorter < STEPS;) {
    const double way = distanceOf(tree.rows[at], target);
    if (way <= TIGHT) break;
    const Row next = way <= step ? target : between(tree.rows[at], target, step / way);
    if (holds(tree.rows[at], next)) {
      at = tree.add(next, at);
      --steps;
    } else {
      step = SHORTER * std::min(step, way);
      ++shorter;
    }
  }
  return at;
}

/* Of rows first to last of the path, with room round them, within the limits. */
JointBox boxOf(const Path &path, std::size_t first, std::size_t last, double room, const JointBox &limits) {
  JointBox out{path[first], path[first]};
  for (std::size_t i = first; i <= last; ++i)
    for (std::size_t k = 0; k < path[i].size(); ++k) {
      out.lower[k] = std::min(out.lower[k], path[i][k]);
      out.upper[k] = std::max(out.upper[k], path[i][k]);
    }
  for (std::size_t k = 0; k < out.lower.size(); ++k) {
    out.lower[k] = std::min(out.lower[k], std::max(limits.lower[k], out.lower[k] - room));
    out.upper[k] = std::max(out.upper[k], std::min(limits.upper[k], out.upper[k] + room));
  }
  return out;
}

/* Leaves out what lies between two points of the path by a straight edge, where that holds: so many tries. */
void shorten(Path &path, int tries, const EdgeTest &holds, std::mt19937_64 &random) {
  std::uniform_real_distribution<double> share(0.0, 1.0);
  for (; tries > 0 && path.size() > 2; --tries) {
    const double n = static_cast<double>(path.size() - 1);
    double a = n * share(random), b = n * share(random);
    if (a > b) std::swap(a, b);
    const auto i = static_cast<std::size_t>(a), j = std::min(static_cast<std::size_t>(b), path.size() - 2);
    if (i == j) continue;
    const Row p = between(path[i], path[i + 1], a - std::floor(a)),
              q = between(path[j], path[j + 1], b - static_cast<double>(j));
    if (!holds(p, q)) continue;
    Path out(path.begin(), path.begin() + static_cast<std::ptrdiff_t>(i) + 1);
    if (distanceOf(out.back(), p) > TIGHT) out.push_back(p);
    if (distanceOf(q, path[j + 1]) > TIGHT) out.push_back(q);
    out.insert(out.end(), path.begin() + static_cast<std::ptrdiff_t>(j) + 1, path.end());
    path = std::move(out);
  }
}

/* Halves edges, whose halves hold as they do, and rounds corners, where that holds: each row moves half of the way to
 * the middle of those beside it. */
void smooth(Path &path, const EdgeTest &holds) {
  path = halved(path);
  for (std::size_t i = 1; i + 1 < path.size(); ++i) {
    const Row nearer = between(path[i], between(path[i - 1], path[i + 1], 0.5), 0.5);
    if (holds(path[i - 1], nearer) && holds(nearer, path[i + 1])) path[i] = nearer;
  }
}

/* Resampled, with rows so close to each other that the edges hold which cut corners; where none are, all corners
 * stay. */
Path resampledSo(const Path &path, double step, const EdgeTest &holds) {
  for (double closer = step; closer > CLOSEST * step; closer *= 0.5) {
    Path out = resampled(path, closer);
    bool all = true;
    for (std::size_t i = 0; all && i + 1 < out.size(); ++i) all = holds(out[i], out[i + 1]);
    if (all) return out;
  }
  Path out{path.front()};
  for (std::size_t i = 0; i + 1 < path.size(); ++i) {
    const Path edge = resampled({path[i], path[i + 1]}, step);
    out.insert(out.end(), edge.begin() + 1, edge.end());
  }
  return out;
}

/* A run of edges that do not hold, and the way round it. */
struct Way {
  std::size_t begin, end; /* rows of the path */
  Path rows;              /* from the first to the last of them; empty: none was found */
  EdgeTest holds;         /* of its edges */
};

Way wayRound(const Path &path, std::size_t begin, std::size_t end, const Detours &detours, std::mt19937_64 &random) {
  const auto is_old = [&path](const Row &row) { return std::find(path.begin(), path.end(), row) != path.end(); };
  std::vector<EdgeTest> tests;
  for (const EdgeTest &wanted : detours.wanted)
    tests.push_back([&detours, &wanted, is_old](const Row &a, const Row &b) { // nothing holds when the time is over
      if (detours.is_over()) return false;
      if (wanted(a, b)) return true;
      return !detours.is_over() && (is_old(a) || is_old(b)) && detours.needed(a, b);
    });
  double room = LEAST_ROOM;
  std::size_t vertices = LEAST_VERTICES;
  for (std::size_t wider = std::max<std::size_t>(1, end - begin);; wider *= 2, room *= 2.0, vertices *= 2) {
    const JointBox box = boxOf(path, begin, end, room, detours.limits);
    for (const EdgeTest &holds : tests) {
      Path rows = rrtConnect(path[begin], path[end], box, STEP * distanceOf(box.lower, box.upper), vertices, holds,
                             detours.is_over, random);
      if (!rows.empty()) return {begin, end, std::move(rows), holds};
    }
    if (detours.is_over() || room > MOST_ROOM) return {begin, end, {}, {}};
    begin -= std::min(begin, wider);
    end = std::min(path.size() - 1, end + wider);
  }
}

} // namespace

Path rrtConnect(const Row &from, const Row &to, const JointBox &box, double step, std::size_t most_vertices,
                const EdgeTest &holds, const std::function<bool()> &is_over, std::mt19937_64 &random) {
  if (holds(from, to)) return {from, to};
  std::array<Tree, 2> trees{Tree(from), Tree(to)};
  for (std::size_t sample = 0; sample < most_vertices && trees[0].rows.size() + trees[1].rows.size() < most_vertices;
       ++sample) {
    if (is_over()) break;
    Tree &grows = trees[sample % 2], &meets = trees[1 - sample % 2];
    Row target(from.size());
    for (std::size_t k = 0; k < target.size(); ++k)
      target[k] = std::uniform_real_distribution<double>(box.lower[k], box.upper[k])(random);
    const std::size_t before = grows.rows.size();
    const std::size_t reached = extend(grows, grows.nearestTo(target), target, step, 1, holds);
    if (grows.rows.size() == before) continue;
    const Row &aim = grows.rows[reached];
    const std::size_t met = extend(meets, meets.nearestTo(aim), aim, step, 1000, holds);
    if (distanceOf(meets.rows[met], aim) > TIGHT) continue;
    Path out = trees[0].back(sample % 2 == 0 ? reached : met);
    std::reverse(out.begin(), out.end());
    const Path rest = trees[1].back(sample % 2 == 0 ? met : reached);
    out.insert(out.end(), rest.begin() + 1, rest.end());
    return out;
  }
  return {};
}

Path around(const Path &path, const Detours &detours) {
  std::mt19937_64 random(SEED);
  const auto stays = [&detours](const Row &a, const Row &b) { return !detours.is_over() && detours.stays(a, b); };
  Path out = path;
  int runs = 0;
  for (std::size_t i = 0; i + 1 < out.size();) {
    if (stays(out[i], out[i + 1])) {
      ++i;
      continue;
    }
    if (++runs > MOST_RUNS || detours.is_over()) return {};
    std::size_t end = i + 1;
    while (end + 1 < out.size() && !stays(out[end], out[end + 1])) ++end;
    const Way way = wayRound(out, i, end, detours, random);
    if (way.rows.empty()) return {};
    const auto row = [&out](std::size_t k) { return out.begin() + static_cast<std::ptrdiff_t>(k); };
    const std::size_t before = way.begin - std::min(way.begin, BESIDE);
    std::size_t behind = way.end; // as far as the edges hold
    while (behind < way.end + BESIDE && behind + 1 < out.size() && stays(out[behind], out[behind + 1])) ++behind;
    Path part(row(before), row(way.begin));
    part.insert(part.end(), way.rows.begin(), way.rows.end());
    part.insert(part.end(), row(way.end) + 1, row(behind) + 1);
    shorten(part, SHORTCUTS, way.holds, random);
    for (int k = 0; k < SMOOTHINGS; ++k) smooth(part, way.holds);
    part = resampledSo(part, detours.step, stays);
    out.erase(row(before), row(behind) + 1);
    out.insert(row(before), part.begin(), part.end());
    i = before + part.size() - 1;
  }
  return out;
}

Path halved(const Path &path) {
  Path out{path.front()};
  for (std::size_t i = 0; i + 1 < path.size(); ++i) {
    out.push_back(between(path[i], path[i + 1], 0.5));
    out.push_back(path[i + 1]);
  }
  return out;
}

double lengthOf(const Path &path) {
  double out = 0.0;
  for (std::size_t i = 0; i + 1 < path.size(); ++i) out += distanceOf(path[i], path[i + 1]);
  return out;
}

Path resampled(const Path &path, double step) {
  const double parts = std::max(1.0, std::ceil(lengthOf(path) / step - TIGHT)), part = lengthOf(path) / parts;
  Path out{path.front()};
  double before = 0.0; // the way to row i
  for (std::size_t i = 0; i + 1 < path.size(); ++i) {
    const double way = distanceOf(path[i], path[i + 1]);
    for (double next = static_cast<double>(out.size()); next < parts && next * part <= before + way; ++next)
      out.push_back(between(path[i], path[i + 1], std::max(0.0, next * part - before) / way));
    before += way;
  }
  out.push_back(path.back());
  return out;
}

} // namespace curve_proximity
