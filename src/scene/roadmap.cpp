/* SPDX-License-Identifier: BSD-3-Clause */
#include <curve_proximity/roadmap.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

#include "answering.h"
#include "edge_model.h"
#include "short_way.h"

namespace curve_proximity {
namespace {

/** Edges that a thread takes at a time: each takes some microseconds, or some hundred where it needs a motion. */
constexpr std::size_t A_PART = 16;

void check(const Roadmap &roadmap, const Query &query, const std::vector<cprox_verdict> &known) {
  const auto joints = static_cast<std::size_t>(roadmap.vertices.rows());
  const auto vertices = static_cast<std::size_t>(roadmap.vertices.cols());
  if (joints != roadmap.joints.size())
    throw Error("vertices have " + std::to_string(joints) + " rows, there are " +
                std::to_string(roadmap.joints.size()) + " joints");
  for (Eigen::Index i = 0; i < roadmap.vertices.cols(); ++i) {
    if (!roadmap.vertices.col(i).allFinite()) throw Error("vertex " + std::to_string(i) + " is not finite");
  }
  for (std::size_t i = 0; i < roadmap.edges.size(); ++i) {
    for (const std::uint32_t end : roadmap.edges[i]) {
      if (end >= vertices)
        throw Error("edge " + std::to_string(i) + " ends at vertex " + std::to_string(end) + ", there are " +
                    std::to_string(vertices));
    }
  }
  if (!known.empty() && known.size() != roadmap.edges.size())
    throw Error("known has " + std::to_string(known.size()) + " verdicts, there are " +
                std::to_string(roadmap.edges.size()) + " edges");
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

TrajectoryPoint pointAt(const Roadmap &roadmap, std::uint32_t vertex, double time) {
  const double *first = roadmap.vertices.col(vertex).data();
  TrajectoryPoint point;
  point.time = time;
  point.positions.assign(first, first + roadmap.vertices.rows());
  return point;
}

TrajectoryDescription straight(const Roadmap &roadmap, const std::array<std::uint32_t, 2> &edge) {
  TrajectoryDescription out;
  out.joints = roadmap.joints;
  out.points = {pointAt(roadmap, edge[0], 0.0), pointAt(roadmap, edge[1], 1.0)};
  out.shortest_way = roadmap.shortest_way;
  return out;
}

/* With a vertex of its own for each edge that goes the shorter way to where it is after whole turns. */
Roadmap shortened(const Robot &robot, const Roadmap &roadmap) {
  Roadmap out = roadmap;
  std::vector<Eigen::VectorXd> further;
  for (std::array<std::uint32_t, 2> &edge : out.edges) {
    TrajectoryDescription motion = straight(roadmap, edge);
    takeShortWays(robot, motion);
    const std::vector<double> &end = motion.points[1].positions;
    const Eigen::Map<const Eigen::VectorXd> to(end.data(), static_cast<Eigen::Index>(end.size()));
    if (to == roadmap.vertices.col(edge[1])) continue;
    edge[1] = static_cast<std::uint32_t>(static_cast<std::size_t>(roadmap.vertices.cols()) + further.size());
    further.push_back(to);
  }
  const Eigen::Index before = roadmap.vertices.cols();
  out.vertices.conservativeResize(Eigen::NoChange, before + static_cast<Eigen::Index>(further.size()));
  for (std::size_t i = 0; i < further.size(); ++i) out.vertices.col(before + static_cast<Eigen::Index>(i)) = further[i];
  return out;
}

/* The core's handle, for all pairs that an edge of the roadmap can have. */
class Lanes {
 public:
  Lanes(const PreparedRobot &robot, const Roadmap &roadmap, RobotPairs against, const Query &query)
      : roadmap_(roadmap), model_(robot, roadmap.joints, roadmap.rest, against, query) {}

  /* Of both at once one alone may have pairs. */
  RobotPairs against() const {
    return model_.asked.against;
  }

  /* Is there no pair to measure? */
  bool isEmpty() const {
    return model_.asked.pairs.empty();
  }

  /* The verdict of an edge, if that is the verdict of its motion as well: what is clear of all pairs is; else its
   * motion must have all pairs, as it has where all joints move. */
  std::optional<cprox_verdict> ask(const std::array<std::uint32_t, 2> &edge, Workspace &workspace) const {
    const auto from = roadmap_.vertices.col(edge[0]), to = roadmap_.vertices.col(edge[1]);
    const EdgeModel::Found found = model_.ask(from.data(), to.data(), workspace);
    const bool stands = found.verdict == CPROX_VERDICT_CLEAR || found.all_move;
    if (found.verdict == CPROX_VERDICT_UNDECIDED || !stands) return std::nullopt;
    return found.verdict;
  }

 private:
  const Roadmap &roadmap_;
  EdgeModel model_;
};

/* Whether verdicts of the core are those of the motions: nothing is left out, and no coarser model is asked for. */
bool speaksForAll(const PreparedRobot &robot, const Query &query) {
  const SnapshotPtr &snapshot = robot.snapshot();
  const cprox_lod finest = query.options.max_lod;
  return query.coverage.complete() && coverageOf(*snapshot).complete() && snapshot->robot()->coverage().complete() &&
         !query.per_object && !query.options.signed_distance && (finest == CPROX_LOD_MESH || finest == CPROX_LOD_NONE);
}

} // namespace

std::vector<std::string> longWays(const Robot &robot, const Roadmap &roadmap) {
  std::vector<std::string> out;
  std::size_t n = 0;
  for (std::size_t i = 0; i < roadmap.edges.size(); ++i) {
    const auto [from, to] = roadmap.edges[i];
    if ((roadmap.vertices.col(to) - roadmap.vertices.col(from)).cwiseAbs().maxCoeff() <= M_PI) continue;
    const std::vector<std::string> ways = longWays(robot, straight(roadmap, roadmap.edges[i]));
    if (ways.empty() || n++ > 0) continue;
    for (const std::string &way : ways) out.push_back("edge " + std::to_string(i) + ": " + way);
  }
  if (n > 1) out.back() += " (" + std::to_string(n) + " edges do so)";
  return out;
}

std::vector<cprox_verdict> edgeVerdicts(const PreparedRobot &robot, const Roadmap &given, RobotPairs against,
                                        const Query &query, const std::vector<cprox_verdict> &known, Pool &pool) {
  check(given, query, known);
  const bool shortens = given.shortest_way && robot.snapshot()->robot();
  const Roadmap roadmap = shortens ? shortened(*robot.snapshot()->robot(), given) : given;
  const std::size_t n = roadmap.edges.size();
  std::vector<cprox_verdict> verdicts = known;
  if (verdicts.empty()) verdicts.assign(n, CPROX_VERDICT_CLEAR);
  std::optional<Lanes> lanes;
  if (n > 0 && speaksForAll(robot, query)) lanes.emplace(robot, roadmap, against, query);
  if (lanes && lanes->isEmpty()) lanes.reset(); // no edge is clear of nothing, but where the query allows it
  if (lanes && lanes->against() != against) {   // one of both after the other
    const std::vector<cprox_verdict> of_objects =
        edgeVerdicts(robot, given, RobotPairs::ENVIRONMENT, query, known, pool);
    return edgeVerdicts(robot, given, RobotPairs::SELF, query, of_objects, pool);
  }
  pool.run(n, A_PART, [&](std::size_t first, std::size_t last, Workspace &workspace) {
    for (std::size_t i = first; i < last; ++i) {
      if (verdicts[i] != CPROX_VERDICT_CLEAR) continue;
      const bool stops = query.options.stop && query.options.stop(query.options.stop_user);
      if (const std::optional<cprox_verdict> verdict =
              lanes && !stops ? lanes->ask(roadmap.edges[i], workspace) : std::nullopt) {
        verdicts[i] = *verdict;
        continue;
      }
      const RobotMotion motion(robot, straight(roadmap, roadmap.edges[i]), roadmap.rest, query.links);
      verdicts[i] = verdictOf(motion, against, query, workspace);
    }
  });
  return verdicts;
}

} // namespace curve_proximity
