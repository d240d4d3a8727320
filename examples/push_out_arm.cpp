/* SPDX-License-Identifier: BSD-3-Clause */
/** Makes the way of a Panda through a shelf smooth and 10 mm clear: NLopt's SLSQP, with the rows and gradients of the
 * provider curve_proximity/RobotDistance.
 *
 *      push_out_arm [--straight] PANDA.urdf PANDA.srdf SCENE.yaml TRAJECTORY.yaml [BEFORE.yaml AFTER.yaml]
 *
 *  TRAJECTORY.yaml is the path of a planner; with --straight only its ends are taken, and the way between them may be
 * in contact: distances are signed, so that the gradient leads out. It becomes a cubic B-spline of all joints, which
 * begins and ends at rest. The variables are the inner control points; the objective is the square of the jerk, the
 * bounds are the joint limits. The constraints are, for each span of the spline, the pairs of links and objects, or of
 * two links, that come nearest. At the end the whole spline is asked about once more: its clearance is then proven, not
 * sampled. BEFORE.yaml and AFTER.yaml get the spline before and after, for `cprox tolerance --trajectory` and for
 * draw_push_out_arm.py. */
#include <nlopt.h>
#include <pluginlib/class_loader.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include <curve_proximity/constraint_provider.hpp>

#include "arm_spline.h"

using namespace curve_proximity;

namespace {

constexpr int kPairs = 3;        /* constraints a span: the pairs that come nearest */
constexpr double kClear = 0.01;  /* [m] what is to be proven */
constexpr double kMargin = 1e-4; /* [m] what is asked of the optimiser beyond that */
constexpr double kHorizon = 0.02;

/* ---- the problem ---- */

struct Problem {
  std::vector<std::string> joints;
  JointPositions rest;
  std::unique_ptr<PreparedRobot> robot;
  std::unique_ptr<const MotionConstraint> constraint;
  Eigen::MatrixXd control;
  Workspace workspace;
  MotionValue value;
  unsigned evaluations = 0;
  nlopt_opt optimiser = nullptr;
  std::string failure; /* no exception may pass through NLopt */
};

Eigen::MatrixXd controlAt(const Problem &problem, const double *x) {
  return withInner(problem.control, x);
}

double jerk(unsigned, const double *x, double *gradient, void *data) {
  Eigen::MatrixXd by_controls;
  const double sum = squaredJerk(controlAt(*static_cast<const Problem *>(data), x), by_controls);
  if (gradient) putInner(by_controls, gradient);
  return sum;
}

/* The provider's rows, the nearest ones of each span. A span with fewer rows is clear by the horizon. */
void clearances(Problem &problem, unsigned n, const double *x, double *result, double *gradient) {
  const TrajectoryDescription trajectory = trajectoryOf(problem.joints, controlAt(problem, x));
  const RobotMotion motion(*problem.robot, trajectory, problem.rest);
  problem.constraint->evaluate({trajectory, motion}, problem.workspace, problem.value);
  ++problem.evaluations;
  if (problem.value.status != CPROX_OK && problem.value.status != CPROX_OVERLAP) throw Error(problem.value.message);
  constexpr std::size_t m = kSpans * kPairs;
  std::fill(result, result + m, kHorizon - kClear - kMargin);
  if (gradient) std::fill(gradient, gradient + m * n, 0.0);
  std::vector<int> taken(kSpans, 0);
  for (const MotionRow &row : problem.value.rows) { // the least first
    const auto span = static_cast<std::size_t>(std::lround(row.t0 / kStep));
    if (taken[span] == kPairs) continue;
    const std::size_t slot = span * kPairs + static_cast<std::size_t>(taken[span]++);
    result[slot] = row.value;
    if (gradient) putInner(byControls(row), gradient + slot * n);
  }
}

/* NLopt wants c(x) <= 0: minus the values. */
void tooNear(unsigned m, double *result, unsigned n, const double *x, double *gradient, void *data) {
  Problem &problem = *static_cast<Problem *>(data);
  try {
    clearances(problem, n, x, result, gradient);
  } catch (const std::exception &error) {
    problem.failure = error.what();
    nlopt_force_stop(problem.optimiser);
  }
  for (unsigned i = 0; i < m; ++i) result[i] = -result[i];
  for (unsigned i = 0; gradient && i < m * n; ++i) gradient[i] = -gradient[i];
}

/* ---- the example ---- */

void write(const char *path, const Problem &problem, const TrajectoryDescription &trajectory) {
  std::ofstream out(path);
  out.precision(17);
  const auto list = [&out](const auto &values) {
    const char *comma = "[";
    for (const auto &value : values) out << std::exchange(comma, ", ") << value;
    out << "]";
  };
  out << "interpolation: cubic\nfixed_joints:\n";
  for (const auto &[joint, value] : problem.rest) out << "  " << joint << ": " << value << "\n";
  out << "joint_trajectory:\n  joint_names: ";
  list(trajectory.joints);
  out << "\n  points:\n";
  for (const TrajectoryPoint &point : trajectory.points) {
    out << "    - {time_from_start: " << point.time << ", positions: ";
    list(point.positions);
    out << ", velocities: ";
    list(point.velocities);
    out << "}\n";
  }
  if (!out) throw Error(std::string(path) + " cannot be written");
}

/* What is proven of a whole trajectory: is it farther than kClear from all objects and from itself? */
bool tell(const char *when, Problem &problem, const TrajectoryDescription &trajectory) {
  const RobotMotion motion(*problem.robot, trajectory, problem.rest);
  Query distance, tolerance;
  tolerance.query_type = QueryType::TOLERANCE;
  tolerance.delta = kClear;
  const ClearanceRow least = clearanceGradient(motion, RobotPairs::WHOLE, distance, problem.workspace);
  const bool clear =
      askEnvironment(motion, tolerance, problem.workspace).front().result.verdict == CPROX_VERDICT_CLEAR &&
      askSelf(motion, tolerance, problem.workspace).result.verdict == CPROX_VERDICT_CLEAR;
  std::printf("%s at least %.4f mm, between %s and %s; more than %g mm everywhere: %s\n", when,
              1e3 * least.answer.result.lower, least.answer.a.c_str(), least.answer.b.c_str(), 1e3 * kClear,
              clear ? "proven" : "no");
  return clear;
}

int run(char **arguments, bool straight, const char *before_file, const char *after_file) {
  Problem problem;
  const Srdf srdf = parseSrdf(readText(arguments[2]));
  const SnapshotPtr snapshot = readScene(arguments[1], srdf, arguments[3]);
  problem.robot = std::make_unique<PreparedRobot>(snapshot, srdf.disabled);
  TrajectoryDescription path = readPath(arguments[4], problem.rest);
  if (straight) path.points = {path.points.front(), path.points.back()};
  problem.joints = path.joints;
  problem.control = controlsOf(path);
  pluginlib::ClassLoader<ConstraintProvider> plugins("curve_proximity", "curve_proximity::ConstraintProvider");
  const auto provider = plugins.createUniqueInstance("curve_proximity/RobotDistance");
  provider->initialise(
      {{"horizon", kHorizon}, {"per_pair", kSpans}, {"margin", kClear + kMargin}, {"epsilon", 1e-6}, {"signed", true}});
  problem.constraint = provider->prepareMotion(*problem.robot);

  // From the planner's path to the smoothest spline that is clear.
  const auto n = static_cast<unsigned>(kInner * problem.control.cols());
  constexpr unsigned m = kSpans * kPairs;
  const std::unique_ptr<nlopt_opt_s, void (*)(nlopt_opt)> optimiser(nlopt_create(NLOPT_LD_SLSQP, n), nlopt_destroy);
  problem.optimiser = optimiser.get();
  const std::vector<double> tolerances(m, 1e-6);
  nlopt_set_min_objective(optimiser.get(), jerk, &problem);
  nlopt_add_inequality_mconstraint(optimiser.get(), m, tooNear, &problem, tolerances.data());
  std::vector<double> lower, upper;
  limitsOf(*snapshot->robot(), problem.joints, lower, upper);
  nlopt_set_lower_bounds(optimiser.get(), lower.data());
  nlopt_set_upper_bounds(optimiser.get(), upper.data());
  nlopt_set_maxeval(optimiser.get(), 200);
  nlopt_set_ftol_rel(optimiser.get(), 1e-3);
  std::vector<double> x(n);
  putInner(problem.control, x.data());
  const double first = jerk(n, x.data(), nullptr, &problem);
  const TrajectoryDescription before = trajectoryOf(problem.joints, problem.control);
  double least = 0.0;
  const nlopt_result result = nlopt_optimize(optimiser.get(), x.data(), &least);
  if (!problem.failure.empty()) throw Error(problem.failure);
  const TrajectoryDescription after = trajectoryOf(problem.joints, controlAt(problem, x.data()));

  tell("before:", problem, before);
  const bool clear = tell("after: ", problem, after);
  std::printf("the squared jerk fell to %.1f %%; %u evaluations, NLopt said %d\n", 100.0 * least / first,
              problem.evaluations, static_cast<int>(result));
  if (before_file) write(before_file, problem, before);
  if (after_file) write(after_file, problem, after);
  return clear ? 0 : 1;
}

} // namespace

int main(int argc, char **argv) {
  const bool straight = argc > 1 && std::string(argv[1]) == "--straight";
  if (straight) ++argv, --argc;
  if (argc != 5 && argc != 7) {
    std::fprintf(stderr,
                 "usage: push_out_arm [--straight] PANDA.urdf PANDA.srdf SCENE.yaml TRAJECTORY.yaml "
                 "[BEFORE.yaml AFTER.yaml]\n");
    return 2;
  }
  try {
    return run(argv, straight, argc == 7 ? argv[5] : nullptr, argc == 7 ? argv[6] : nullptr);
  } catch (const std::exception &error) {
    std::fprintf(stderr, "push_out_arm: %s\n", error.what());
    return 1;
  }
}
