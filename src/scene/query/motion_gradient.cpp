/* SPDX-License-Identifier: BSD-3-Clause */
/* Gradients and rows of a robot's clearance along a trajectory, by its points and joints. */
#include <algorithm>
#include <cmath>
#include <limits>

#include "answering.h"
#include "asked_pairs.h"

namespace curve_proximity {
namespace {

/* The arrays that the core writes the derivatives of one row to. */
class Arrays {
 public:
  explicit Arrays(const RobotMotion::Data &data) : stands_(data.stands) {
    const TrajectoryShape &shape = data.shape;
    n_variables_ = data.kinematics->rest.size();
    n_ = stands_ ? 0 : shape.n_points * shape.variable.size();
    n_velocities_ = shape.has_velocities ? n_ : 0;
    n_accelerations_ = shape.has_accelerations ? n_ : 0;
  }

  /* Numbers a row. */
  std::size_t size() const {
    return n_variables_ + n_ + n_velocities_ + n_accelerations_;
  }

  /* Hands the arrays to the core: size() numbers at `memory`. */
  void lend(double *memory, cprox_motion_gradient &gradient) const {
    gradient.variables = memory;
    memory += n_variables_;
    if (n_) gradient.positions = memory;
    memory += n_;
    if (n_velocities_) gradient.velocities = memory;
    memory += n_velocities_;
    if (n_accelerations_) gradient.accelerations = memory;
  }

 private:
  const bool stands_;
  std::size_t n_variables_, n_, n_velocities_, n_accelerations_;
};

/* The core turns an obstacle about its own position, we the object about its origin. */
void toObject(const Asked &asked, const cprox_result &result, const cprox_motion_gradient &in, ClearanceGradient &out) {
  if (result.obstacle_index < 0 || asked.isSelf(result)) return;
  const auto obstacle = static_cast<std::size_t>(result.obstacle_index);
  const Item &item = asked.data.snapshot->world().items()[asked.items[obstacle]];
  const Eigen::Vector3d origin = asked.data.snapshot->objects().at(*item.owner)->description.pose.translation();
  out.object_linear = toEigen(in.position);
  out.object_angular =
      toEigen(in.rotation) + (toEigen(asked.obstacles[obstacle].pose.position) - origin).cross(out.object_linear);
}

ClearanceGradient toGradient(const Asked &asked, const cprox_result &result, const cprox_motion_gradient &in,
                             const std::string &reason) {
  const RobotMotion::Data &data = asked.data;
  const TrajectoryShape &shape = data.shape;
  ClearanceGradient out;
  out.valid = in.valid;
  out.reason = in.valid ? "" : reason;
  out.t = in.t;
  out.positions = toMatrix(shape, in.positions);
  if (shape.has_velocities) out.velocities = toMatrix(shape, in.velocities);
  if (shape.has_accelerations) out.accelerations = toMatrix(shape, in.accelerations);
  for (std::size_t k = 0; data.stands && in.variables && k < shape.variable.size(); ++k)
    out.positions(0, static_cast<Eigen::Index>(shape.column[k])) = in.variables[shape.variable[k]];
  for (const auto &[name, variable] : data.kinematics->variables)
    out.joints[name] = in.variables ? in.variables[variable] : 0.0;
  out.duration = in.duration;
  out.base_linear = toEigen(in.base_position);
  out.base_angular = toEigen(in.base_rotation);
  toObject(asked, result, in, out);
  out.margin = in.margin;
  return out;
}

ClearanceRow toRow(const Asked &asked, const cprox_result &result, const cprox_motion_gradient &gradient,
                   const std::string &reason, const Query &query, const Workspace &workspace, Clock::time_point start) {
  ClearanceRow row;
  row.gradient = toGradient(asked, result, gradient, reason);
  row.answer = toAnswer(asked, result, query, workspace, start);
  applyGap(row.answer, row.gradient);
  return row;
}

/* Numbers that rows take at most: 256 MB of doubles. */
constexpr std::size_t MOST_NUMBERS = std::size_t{1} << 25;

/* Room for rows, so many that the core can gather all intervals of a pair before it leaves out those that are too many.
 * Throws Error where there is none. */
std::size_t roomFor(const Asked &asked, const RowLimits &limits, std::size_t left, std::size_t n_intervals,
                    std::size_t size) {
  const std::size_t all = asked.pairs.size() * std::min(limits.per_pair, n_intervals);
  const std::size_t wanted = std::min(left, all) + n_intervals, most = MOST_NUMBERS / std::max<std::size_t>(1, size);
  if (most < n_intervals)
    throw Error("rows of " + std::to_string(asked.data.shape.n_points) + " points between " +
                std::to_string(n_intervals + 1) + " breaks take more than 256 MB: ask about fewer at a time");
  return std::min(wanted, most);
}

/* Why a row has no gradient, as far as the core's last message does not say it of this row. */
std::string reasonOf(const cprox_motion_row &row) {
  if (row.gradient.valid) return "";
  if (row.result.upper < 0.0 || row.result.status == CPROX_OVERLAP)
    return "there is more than one way out, or its minimum is not the only one";
  return row.result.upper > 0.0 ? "its minimum or its nearest points are not the only ones, or not proven to be"
                                : "they touch or overlap: how deep is an option (signed_distance)";
}

/* Adds the rows against the objects, or with itself, to those that there are. */
void addRows(const RobotMotion &motion, RobotPairs against, const RowLimits &limits, const Query &query,
             Workspace &workspace, ClearanceRows &out) {
  const Clock::time_point start = Clock::now();
  const Asked asked = askedOf(motion, against, query);
  const Coverage coverage = coverageOf(query, asked);
  if (!coverage.complete()) out.gap = coverage.gap(), out.message = coverage.message();
  if (asked.pairs.empty()) return;
  const std::vector<double> &times = limits.breaks.empty() ? asked.data.shape.times : limits.breaks;
  const std::size_t n_intervals = times.size() - 1, left = limits.most - std::min(limits.most, out.rows.size());
  const Arrays arrays(asked.data);
  std::vector<cprox_motion_row> rows(roomFor(asked, limits, left, n_intervals, arrays.size()));
  const std::unique_ptr<double[]> memory(new double[rows.size() * arrays.size()]); // the core fills it row by row
  for (std::size_t i = 0; i < rows.size(); ++i) arrays.lend(memory.get() + i * arrays.size(), rows[i].gradient);

  cprox_rows_query wanted{};
  wanted.breaks = times.data();
  wanted.n_intervals = n_intervals;
  wanted.horizon = limits.horizon + asked.rounding;
  wanted.per_pair = limits.per_pair;
  const cprox_options options = withoutRounding(query.options, asked.rounding);
  const Obstacles obstacles(asked.obstacles, CPROX_INDEX_NONE);
  std::size_t count = 0;
  const cprox_status status = cprox_robot_rows(obstacles.get(), asked.mover(), &wanted, &options, workspace.get(),
                                               rows.data(), rows.size(), &count);
  if (status < 0) throw Error(workspace.reason(), status);
  if (status != CPROX_OK) {
    out.status = status;
    out.message = workspace.reason();
  }
  if (count > left) {
    out.status = CPROX_BUDGET;
    out.message = "there are more than " + std::to_string(limits.most) + " rows";
  }
  for (std::size_t i = 0; i < std::min(count, left); ++i) {
    const std::string reason = reasonOf(rows[i]);
    out.rows.push_back(toRow(asked, rows[i].result, rows[i].gradient, reason, query, workspace, start));
    out.rows.back().t0 = times[rows[i].interval];
    out.rows.back().t1 = times[rows[i].interval + 1];
  }
}

void checkLimits(const RowLimits &limits) {
  if (limits.per_pair == 0 || limits.most == 0) throw Error("per_pair and most must be at least 1");
  if (limits.breaks.size() == 1) throw Error("one break parts nothing: give two or more, or none");
  if (!(limits.horizon >= 0.0) || !std::isfinite(limits.horizon))
    throw Error("the horizon is " + std::to_string(limits.horizon) + ": it must be at least 0 and finite");
}

/* Whether a mesh is asked about, as what it is. */
void refuseMeshes(const Asked &asked, const Query &query) {
  if (query.options.max_lod != CPROX_LOD_MESH) return;
  const auto refuse = [](const std::string &name) {
    throw Error("'" + name + "' is a mesh, which has no growth distance: ask about its hull (max_lod)");
  };
  const std::vector<MovingGeometry> &geometries = asked.data.kinematics->geometries;
  const auto refuseGeometry = [&](std::int32_t i) {
    const MovingGeometry &geometry = geometries[static_cast<std::size_t>(i)];
    if (geometry.is_mesh) refuse(geometry.owner());
  };
  for (const std::vector<cprox_robot_pair> *pairs : {&asked.pairs, &asked.self_pairs}) {
    const bool self = asked.against == RobotPairs::SELF || pairs == &asked.self_pairs;
    for (const cprox_robot_pair &pair : *pairs) {
      refuseGeometry(pair.geometry);
      if (self) refuseGeometry(pair.other);
      if (self) continue;
      const Item &item = asked.data.snapshot->world().items()[asked.items[static_cast<std::size_t>(pair.other)]];
      if (item.shape->is_mesh) refuse(*item.owner);
    }
  }
}

/* The query of the core that gives one row. */
using AskRow = cprox_status (*)(const Asked &asked, const cprox_options &options, Workspace &workspace,
                                cprox_result &result, cprox_motion_gradient &gradient, double &steepest);

cprox_status askDistance(const Asked &asked, const cprox_options &options, Workspace &workspace, cprox_result &result,
                         cprox_motion_gradient &gradient, double & /*steepest*/) {
  const Obstacles obstacles(asked.obstacles, CPROX_INDEX_NONE);
  return cprox_robot_distance_gradient(obstacles.get(), asked.mover(), &options, workspace.get(), &result, &gradient);
}

cprox_status askGrowth(const Asked &asked, const cprox_options &options, Workspace &workspace, cprox_result &result,
                       cprox_motion_gradient &gradient, double &steepest) {
  const Obstacles obstacles(asked.obstacles, CPROX_INDEX_NONE);
  cprox_motion_growth found{};
  const cprox_status status =
      cprox_robot_growth(obstacles.get(), asked.mover(), &options, workspace.get(), &found, &gradient);
  if (status < 0) return status;
  result.status = status;
  result.lower = found.growth.lower;
  result.upper = found.growth.upper;
  result.normal = found.growth.normal;
  result.distance_queries = found.growth.pairs;
  result.t = found.t;
  result.mover_part = found.mover_part;
  result.obstacle_index = found.obstacle_index;
  result.witness_mover = result.witness_obstacle = found.touch;
  steepest = found.steepest;
  return status;
}

ClearanceRow askRow(const RobotMotion &motion, Asked asked, const cprox_options &options, const Query &query,
                    AskRow ask, Workspace &workspace) {
  const Clock::time_point start = Clock::now();
  const Arrays arrays(asked.data);
  std::vector<double> memory(arrays.size());
  cprox_motion_gradient gradient{};
  arrays.lend(memory.data(), gradient);
  gradient.t = std::numeric_limits<double>::quiet_NaN();
  cprox_result result{};
  result.obstacle_index = -1;
  std::string reason = "there is nothing to measure against";
  if (asked.pairs.empty()) {
    answerNothing(query, result);
  } else {
    double steepest = 1.0;
    const cprox_status status = ask(asked, options, workspace, result, gradient, steepest);
    if (status < 0) throw Error(workspace.reason(), status);
    asked.rounding *= steepest; // [m] become what they change of the value
    reason = workspace.reason();
  }
  ClearanceRow row = toRow(asked, result, gradient, reason, query, workspace, start);
  const std::array<double, 2> domain = motion.domain();
  row.t0 = domain[0];
  row.t1 = domain[1];
  return row;
}

} // namespace

Eigen::MatrixXd toMatrix(const TrajectoryShape &shape, const double *values) {
  Eigen::MatrixXd out =
      Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(shape.n_points), static_cast<Eigen::Index>(shape.n_joints));
  const std::size_t n = shape.column.size();
  for (std::size_t i = 0; values && i < shape.n_points; ++i)
    for (std::size_t k = 0; k < n; ++k)
      out(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(shape.column[k])) = values[i * n + k];
  return out;
}

ClearanceRow clearanceGradient(const RobotMotion &motion, RobotPairs against, const Query &query,
                               Workspace &workspace) {
  checkDistances(against, query);
  const Asked asked = askedOf(motion, against, query);
  return askRow(motion, asked, withoutRounding(query.options, asked.rounding), query, askDistance, workspace);
}

ClearanceRow growthGradient(const RobotMotion &motion, RobotPairs against, const Query &query, Workspace &workspace) {
  checkDistances(against, query);
  if (query.second_opinion) throw Error("there is no second opinion about growth distances");
  const Asked asked = askedOf(motion, against, query);
  refuseMeshes(asked, query);
  return askRow(motion, asked, query.options, query, askGrowth, workspace);
}

ClearanceRows clearanceRows(const RobotMotion &motion, RobotPairs against, const RowLimits &limits, const Query &query,
                            Workspace &workspace) {
  checkDistances(against, query);
  checkLimits(limits);
  ClearanceRows out;
  if (against != RobotPairs::SELF) addRows(motion, RobotPairs::ENVIRONMENT, limits, query, workspace, out);
  if (against != RobotPairs::ENVIRONMENT) addRows(motion, RobotPairs::SELF, limits, query, workspace, out);
  return out;
}

} // namespace curve_proximity
