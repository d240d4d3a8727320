/* SPDX-License-Identifier: BSD-3-Clause */
#include "robot_edges.h"

#include <curve_proximity/roadmap.hpp>

#include <algorithm>

namespace curve_proximity {
namespace {

constexpr cprox_robot_pair NO_PAIR{};

/* A motion of all joints: it has all pairs that an edge can have. */
TrajectoryDescription everyJoint(const std::vector<std::string> &joints) {
  TrajectoryDescription out;
  out.joints = joints;
  out.points = {{std::vector<double>(joints.size(), 1.0), {}, {}, 0.0},
                {std::vector<double>(joints.size(), 2.0), {}, {}, 1.0}};
  return out;
}

} // namespace

RobotEdges::RobotEdges(const PreparedRobot &robot, const std::vector<std::string> &joints,
                       const JointPositions &others_at, RobotPairs against, const Query &query)
    : motion(robot, everyJoint(joints), others_at, query.links),
      asked(askedOf(motion, against, query)),
      rest(cprox_motion_get_info(motion.data().core.get()).n_variables),
      options(query.options) {
  cprox_motion_evaluate(motion.data().core.get(), 0.0, rest.data());
  Workspace workspace;
  if (makeObstacles(asked.obstacles, CPROX_INDEX_NONE, workspace, obstacles) < 0) throw Error(workspace.reason());
  const bool alone = asked.against == RobotPairs::SELF;
  const std::vector<cprox_robot_pair> none, &against_items = alone ? none : asked.pairs,
                                            &against_itself = alone ? asked.pairs : asked.self_pairs;
  cprox_edge_query edges{}; /* NULL would be all pairs */
  edges.obstacles = obstacles.get();
  edges.pairs = against_items.empty() ? &NO_PAIR : against_items.data();
  edges.n_pairs = against_items.size();
  edges.self_pairs = against_itself.empty() ? &NO_PAIR : against_itself.data();
  edges.n_self_pairs = against_itself.size();
  edges.without_self = against_itself.empty();
  edges.options = &options;
  edges.delta = query.query_type == QueryType::TOLERANCE ? query.delta : 0.0;
  edges.rounding = asked.rounding;
  cprox_edge_checker *made = nullptr;
  const cprox_robot *core = motion.data().kinematics->core.get();
  if (cprox_edge_checker_create(core, &edges, workspace.get(), &made) < 0) throw Error(workspace.reason());
  checker.reset(made);
}

std::vector<double> RobotEdges::rowsFor(std::size_t n) const {
  std::vector<double> rows(2 * n * rest.size());
  for (auto row = rows.begin(); row != rows.end();) row = std::copy(rest.begin(), rest.end(), row);
  return rows;
}

void RobotEdges::fill(const double *joints, double *row) const {
  const TrajectoryShape &shape = motion.data().shape;
  for (std::size_t k = 0; k < shape.column.size(); ++k) row[shape.variable[k]] = joints[shape.column[k]];
}

bool RobotEdges::allMove(const double *from, const double *to) const {
  const std::vector<std::size_t> &column = motion.data().shape.column;
  return std::all_of(column.begin(), column.end(), [&](std::size_t k) { return from[k] != to[k]; });
}

void RobotEdges::ask(const std::vector<double> &rows, std::size_t n, std::uint8_t *verdicts,
                     Workspace &workspace) const {
  std::fill(verdicts, verdicts + n, static_cast<std::uint8_t>(CPROX_VERDICT_UNDECIDED));
  cprox_robot_edges(checker.get(), rows.data(), rows.data() + rows.size() / 2, n, workspace.get(), verdicts, nullptr);
}

struct EdgeChecker::Data {
  Data(const PreparedRobot &robot, const std::vector<std::string> &joints, const JointPositions &rest,
       RobotPairs against, const Query &query)
      : model(robot, joints, rest, against, query), coverage(coverageOf(query, model.asked)) {}

  RobotEdges model;
  Coverage coverage;
};

EdgeChecker::EdgeChecker(const PreparedRobot &robot, const std::vector<std::string> &joints, const JointPositions &rest,
                         RobotPairs against, const Query &query) {
  if (query.query_type == QueryType::DISTANCE) throw Error("a verdict is asked of each edge: tolerance or collision");
  if (query.per_object || query.options.certificate || query.options.signed_distance)
    throw Error("edges have one verdict in all, without a certificate and without signed distances");
  const std::string fault = faultInAll(against, query);
  if (!fault.empty()) throw Error(fault);
  data_ = std::make_unique<const Data>(robot, joints, rest, against, query);
}

EdgeChecker::~EdgeChecker() = default;
EdgeChecker::EdgeChecker(EdgeChecker &&) noexcept = default;
EdgeChecker &EdgeChecker::operator=(EdgeChecker &&) noexcept = default;

cprox_verdict EdgeChecker::ask(const double *from, const double *to, Workspace &workspace) const {
  const RobotEdges &model = data_->model;
  std::vector<double> rows = model.rowsFor(1);
  model.fill(from, rows.data());
  model.fill(to, rows.data() + rows.size() / 2);
  std::uint8_t found;
  model.ask(rows, 1, &found, workspace);
  const auto verdict = static_cast<cprox_verdict>(found);
  const bool stands = verdict == CPROX_VERDICT_CLEAR ? data_->coverage.complete() : data_->coverage.provesContact();
  return stands ? verdict : CPROX_VERDICT_UNDECIDED;
}

const Coverage &EdgeChecker::coverage() const {
  return data_->coverage;
}

} // namespace curve_proximity
