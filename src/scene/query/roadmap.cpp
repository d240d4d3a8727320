/* SPDX-License-Identifier: BSD-3-Clause */
#include <curve_proximity/roadmap.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

#include "answering.h"
#include "robot/short_way.h"
#include "robot_edges.h"

namespace curve_proximity {
namespace {

/** Edges that a thread takes at a time, at most: each takes some microseconds, or some hundred where it needs a motion,
 *  and a call of the core costs as much as two of them. */
constexpr std::size_t LEAST_PART = 16, LARGEST_PART = 1024;

/* Each thread takes several parts, so that all end at about the same time. */
std::size_t partOf(std::size_t n, unsigned threads) {
  constexpr std::size_t PARTS = 8;
  return std::clamp(n / (PARTS * threads), LEAST_PART, LARGEST_PART);
}

const double *beginOf(const EdgeList &edges, std::size_t i) {
  return edges.from + (edges.ends ? edges.ends[i][0] : i) * edges.joints.size();
}

const double *endOf(const EdgeList &edges, std::size_t i) {
  return edges.to + (edges.ends ? edges.ends[i][1] : i) * edges.joints.size();
}

void checkRows(const EdgeList &edges, const double *rows, const char *what) {
  const std::size_t width = edges.joints.size();
  for (std::size_t i = 0; i < edges.n_rows * width; ++i)
    if (!std::isfinite(rows[i])) throw Error(what + std::to_string(i / width) + " is not finite");
}

void check(const EdgeList &edges, const Query &query, const std::vector<cprox_verdict> &known) {
  checkRows(edges, edges.from, edges.ends ? "vertex " : "the beginning of edge ");
  if (edges.to != edges.from) checkRows(edges, edges.to, "the end of edge ");
  for (std::size_t i = 0; i < edges.n && edges.ends; ++i) {
    for (const std::uint32_t end : edges.ends[i]) {
      if (end >= edges.n_rows)
        throw Error("edge " + std::to_string(i) + " ends at vertex " + std::to_string(end) + ", there are " +
                    std::to_string(edges.n_rows));
    }
  }
  if (!known.empty() && known.size() != edges.n)
    throw Error("known has " + std::to_string(known.size()) + " verdicts, there are " + std::to_string(edges.n) +
                " edges");
  if (query.query_type == QueryType::DISTANCE) throw Error("a verdict is asked of each edge: tolerance or collision");
  if (query.options.certificate) throw Error("edges have no certificates: ask about one motion");
}

/* The verdict of a motion; what has no answer is undecided. */
cprox_verdict verdictOf(const RobotMotion &motion, RobotPairs against, const Query &query, Workspace &workspace) {
  if (against == RobotPairs::WHOLE) {
    const cprox_verdict verdict = verdictOf(motion, RobotPairs::ENVIRONMENT, query, workspace);
    return verdict == CPROX_VERDICT_CLEAR ? verdictOf(motion, RobotPairs::SELF, query, workspace) : verdict;
  }
  const bool self = against == RobotPairs::SELF;
  const Answer answer = self ? askSelf(motion, query, workspace) : askEnvironment(motion, query, workspace).front();
  if (answer.result.status == CPROX_INVALID) throw Error(answer.message);
  return answer.result.status < 0 ? CPROX_VERDICT_UNDECIDED : answer.result.verdict;
}

TrajectoryDescription straight(const EdgeList &edges, std::size_t i) {
  const auto at = [&](const double *row, double time) {
    return TrajectoryPoint{std::vector<double>(row, row + edges.joints.size()), {}, {}, time};
  };
  TrajectoryDescription out;
  out.joints = edges.joints;
  out.points = {at(beginOf(edges, i), 0.0), at(endOf(edges, i), 1.0)};
  out.shortest_way = edges.shortest_way;
  return out;
}

/* The core's handle, for all pairs that an edge of the list can have. */
class Lanes {
 public:
  Lanes(const PreparedRobot &robot, const EdgeList &edges, RobotPairs against, const Query &query)
      : edges_(edges), model_(robot, edges.joints, edges.rest, against, query) {
    if (edges.shortest_way) robot_ = robot.snapshot()->robot();
  }

  /* Of both at once one alone may have pairs. */
  RobotPairs against() const {
    return model_.asked.against;
  }

  /* Is there no pair to measure? */
  bool isEmpty() const {
    return model_.asked.pairs.empty();
  }

  /* The verdicts of those of edges first … last - 1 whose verdict is clear so far, at most LARGEST_PART; undecided
   * where that is not the verdict of its motion as well: what is clear of all pairs is; else its motion must have all
   * pairs, as it has where all joints move. */
  void ask(std::size_t first, std::size_t last, const std::vector<cprox_verdict> &so_far, std::uint8_t *verdicts,
           Workspace &workspace) const {
    std::vector<double> rows = model_.rowsFor(last - first);
    std::array<std::size_t, LARGEST_PART> which;
    std::array<bool, LARGEST_PART> all_move;
    std::array<std::uint8_t, LARGEST_PART> found;
    std::size_t n = 0;
    for (std::size_t i = first; i < last; ++i)
      if (so_far[i] == CPROX_VERDICT_CLEAR) all_move[n] = fill(i, n, rows), which[n++] = i - first;
    model_.ask(rows, n, found.data(), workspace);
    for (std::size_t k = 0; k < n; ++k)
      if (found[k] == CPROX_VERDICT_CLEAR || all_move[k]) verdicts[which[k]] = found[k];
  }

 private:
  /* Whether all joints move on the edge. */
  bool fill(std::size_t i, std::size_t row, std::vector<double> &rows) const {
    if (!robot_) return fill(beginOf(edges_, i), endOf(edges_, i), row, rows);
    TrajectoryDescription motion = straight(edges_, i);
    takeShortWays(*robot_, motion);
    return fill(motion.points[0].positions.data(), motion.points[1].positions.data(), row, rows);
  }

  bool fill(const double *from, const double *to, std::size_t row, std::vector<double> &rows) const {
    double *begin = rows.data() + row * model_.rest.size();
    model_.fill(from, begin);
    model_.fill(to, begin + rows.size() / 2);
    return model_.allMove(from, to);
  }

  const EdgeList &edges_;
  RobotEdges model_;
  std::shared_ptr<const Robot> robot_; /* where edges go the shorter way */
};

/* Whether verdicts of the core are those of the motions: nothing is left out, and no coarser model is asked for. */
bool speaksForAll(const PreparedRobot &robot, const Query &query) {
  const SnapshotPtr &snapshot = robot.snapshot();
  const cprox_lod finest = query.options.max_lod;
  return query.coverage.complete() && coverageOf(*snapshot).complete() && snapshot->robot()->coverage().complete() &&
         !query.per_object && !query.options.signed_distance && (finest == CPROX_LOD_MESH || finest == CPROX_LOD_NONE);
}

} // namespace

EdgeList::EdgeList(const Roadmap &roadmap)
    : joints(roadmap.joints),
      rest(roadmap.rest),
      shortest_way(roadmap.shortest_way),
      from(roadmap.vertices.data()),
      to(from),
      n_rows(static_cast<std::size_t>(roadmap.vertices.cols())),
      ends(roadmap.edges.data()),
      n(roadmap.edges.size()) {
  if (static_cast<std::size_t>(roadmap.vertices.rows()) != joints.size())
    throw Error("vertices have " + std::to_string(roadmap.vertices.rows()) + " rows, there are " +
                std::to_string(joints.size()) + " joints");
}

std::vector<std::string> longWays(const Robot &robot, const EdgeList &edges) {
  std::vector<std::string> out;
  std::size_t n = 0;
  for (std::size_t i = 0; i < edges.n && !edges.shortest_way; ++i) {
    const double *from = beginOf(edges, i), *to = endOf(edges, i);
    double most = 0.0;
    for (std::size_t k = 0; k < edges.joints.size(); ++k) most = std::max(most, std::abs(to[k] - from[k]));
    if (most <= M_PI) continue;
    const std::vector<std::string> ways = longWays(robot, straight(edges, i));
    if (ways.empty() || n++ > 0) continue;
    for (const std::string &way : ways) out.push_back("edge " + std::to_string(i) + ": " + way);
  }
  if (n > 1) out.back() += " (" + std::to_string(n) + " edges do so)";
  return out;
}

std::vector<cprox_verdict> edgeVerdicts(const PreparedRobot &robot, const EdgeList &edges, RobotPairs against,
                                        const Query &query, const std::vector<cprox_verdict> &known, Pool &pool) {
  check(edges, query, known);
  std::vector<cprox_verdict> verdicts = known;
  if (verdicts.empty()) verdicts.assign(edges.n, CPROX_VERDICT_CLEAR);
  std::optional<Lanes> lanes;
  if (edges.n > 0 && speaksForAll(robot, query)) lanes.emplace(robot, edges, against, query);
  if (lanes && lanes->isEmpty()) lanes.reset(); // no edge is clear of nothing, but where the query allows it
  if (lanes && lanes->against() != against) {   // one of both after the other
    const std::vector<cprox_verdict> of_objects =
        edgeVerdicts(robot, edges, RobotPairs::ENVIRONMENT, query, known, pool);
    return edgeVerdicts(robot, edges, RobotPairs::SELF, query, of_objects, pool);
  }
  pool.run(edges.n, partOf(edges.n, pool.threads()), [&](std::size_t first, std::size_t last, Workspace &workspace) {
    std::array<std::uint8_t, LARGEST_PART> found;
    found.fill(CPROX_VERDICT_UNDECIDED);
    const bool stops = query.options.stop && query.options.stop(query.options.stop_user);
    if (lanes && !stops) lanes->ask(first, last, verdicts, found.data(), workspace);
    for (std::size_t i = first; i < last; ++i) {
      if (verdicts[i] != CPROX_VERDICT_CLEAR) continue;
      verdicts[i] = static_cast<cprox_verdict>(found[i - first]);
      if (verdicts[i] != CPROX_VERDICT_UNDECIDED) continue;
      const RobotMotion motion(robot, straight(edges, i), edges.rest, query.links);
      verdicts[i] = verdictOf(motion, against, query, workspace);
    }
  });
  return verdicts;
}

} // namespace curve_proximity
