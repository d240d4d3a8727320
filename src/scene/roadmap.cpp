/* SPDX-License-Identifier: BSD-3-Clause */
#include <curve_proximity/roadmap.hpp>

namespace curve_proximity {
namespace {

/** Motions that a thread takes at a time: each takes some hundred microseconds. */
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
cprox_verdict verdictOf(const RobotMotion &motion, bool self, const Query &query, Workspace &workspace) {
  const Answer answer = self ? askSelf(motion, query, workspace) : askEnvironment(motion, query, workspace).front();
  if (answer.result.status == CPROX_INVALID) throw Error(answer.message);
  return answer.result.status < 0 ? CPROX_VERDICT_UNDECIDED : answer.result.verdict;
}

TrajectoryDescription straight(const Roadmap &roadmap, const std::array<std::uint32_t, 2> &edge) {
  TrajectoryDescription out;
  out.joints = roadmap.joints;
  for (const std::uint32_t end : edge) {
    const double *first = roadmap.vertices.col(end).data();
    TrajectoryPoint point;
    point.time = static_cast<double>(out.points.size());
    point.positions.assign(first, first + roadmap.vertices.rows());
    out.points.push_back(std::move(point));
  }
  return out;
}

} // namespace

std::vector<cprox_verdict> edgeVerdicts(const PreparedRobot &robot, const Roadmap &roadmap, bool self,
                                        const Query &query, const std::vector<cprox_verdict> &known, Pool &pool) {
  check(roadmap, query, known);
  const std::size_t n = roadmap.edges.size();
  std::vector<cprox_verdict> verdicts = known;
  if (verdicts.empty()) verdicts.assign(n, CPROX_VERDICT_CLEAR);
  pool.run(n, A_PART, [&](std::size_t first, std::size_t last, Workspace &workspace) {
    for (std::size_t i = first; i < last; ++i) {
      if (verdicts[i] != CPROX_VERDICT_CLEAR) continue;
      const RobotMotion motion(robot, straight(roadmap, roadmap.edges[i]), roadmap.rest, query.links);
      verdicts[i] = verdictOf(motion, self, query, workspace);
    }
  });
  return verdicts;
}

} // namespace curve_proximity
