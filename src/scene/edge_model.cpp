/* SPDX-License-Identifier: BSD-3-Clause */
#include "edge_model.h"

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

EdgeModel::EdgeModel(const PreparedRobot &robot, const std::vector<std::string> &joints,
                     const JointPositions &others_at, RobotPairs against, const Query &query)
    : motion(robot, everyJoint(joints), others_at, query.links),
      asked(askedOf(motion, against, query)),
      rest(cprox_motion_get_info(motion.data().core.get()).n_variables),
      options(query.options) {
  cprox_motion_evaluate(motion.data().core.get(), 0.0, rest.data());
  Workspace workspace;
  if (makeObstacles(asked.targets, CPROX_INDEX_NONE, workspace, obstacles) < 0) throw Error(workspace.reason());
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
  const double delta = query.query_type == QueryType::TOLERANCE ? query.delta : 0.0;
  const auto make = [&](double farther_than, Handle &handle) {
    edges.delta = farther_than;
    cprox_edge_checker *made = nullptr;
    const cprox_robot *core = motion.data().kinematics->core.get();
    if (cprox_edge_checker_create(core, &edges, workspace.get(), &made) < 0) throw Error(workspace.reason());
    handle.reset(made);
  };
  make(delta + asked.rounding, clears);
  if (asked.rounding > 0.0) make(std::max(delta - asked.rounding, 0.0), violates);
}

EdgeModel::Found EdgeModel::ask(const double *from, const double *to, Workspace &workspace) const {
  std::vector<double> begin = rest, end = rest;
  const TrajectoryShape &shape = motion.data().shape;
  Found found{CPROX_VERDICT_UNDECIDED, true};
  for (std::size_t k = 0; k < shape.column.size(); ++k) {
    const auto variable = static_cast<std::size_t>(shape.variable[k]);
    begin[variable] = from[shape.column[k]];
    end[variable] = to[shape.column[k]];
    found.all_move = found.all_move && begin[variable] != end[variable];
  }
  const auto by = [&](const Handle &handle) {
    std::uint8_t verdict = CPROX_VERDICT_UNDECIDED;
    const cprox_status status =
        cprox_robot_edges(handle.get(), begin.data(), end.data(), 1, workspace.get(), &verdict, nullptr);
    return status < 0 ? CPROX_VERDICT_UNDECIDED : static_cast<cprox_verdict>(verdict);
  };
  found.verdict = by(clears);
  if (found.verdict == CPROX_VERDICT_VIOLATED && violates && by(violates) != CPROX_VERDICT_VIOLATED)
    found.verdict = CPROX_VERDICT_UNDECIDED;
  return found;
}

struct EdgeChecker::Data {
  Data(const PreparedRobot &robot, const std::vector<std::string> &joints, const JointPositions &rest,
       RobotPairs against, const Query &query)
      : model(robot, joints, rest, against, query), coverage(coverageOf(query, model.asked)) {}

  EdgeModel model;
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
  const cprox_verdict verdict = data_->model.ask(from, to, workspace).verdict;
  const bool stands = verdict == CPROX_VERDICT_CLEAR ? data_->coverage.complete() : data_->coverage.provesContact();
  return stands ? verdict : CPROX_VERDICT_UNDECIDED;
}

const Coverage &EdgeChecker::coverage() const {
  return data_->coverage;
}

} // namespace curve_proximity
