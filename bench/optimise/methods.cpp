/* SPDX-License-Identifier: BSD-3-Clause */
#include "methods.h"

#include <nlopt.h>

#include <cmath>
#include <ctime>
#include <limits>

#include "sampled_arm.h"

namespace curve_proximity {
namespace {

constexpr int kPairs = 3;          /* constraints a span: the pairs that come nearest */
constexpr double kMargin = 1e-4;   /* [m] what rows ask for beyond kClear */
constexpr double kHinge = 1e-3;    /* [m] what hinges ask for beyond it: where they balance the jerk they are not 0 */
constexpr double kHorizon = 0.02;  /* [m] */
constexpr int kEvaluations = 200;  /* at most, in all */
constexpr double kRelative = 1e-3; /* the objective's change at which a search ends */
constexpr double kWeights[] = {1e4, 1e5, 1e6, 1e7, 1e8}; /* of hinges, beside a jerk of 1 at the beginning */

double thread_microseconds() {
  timespec now = {};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e6 * static_cast<double>(now.tv_sec) + 1e-3 * static_cast<double>(now.tv_nsec);
}

/* ---- sampled states ---- */

/* A state of the spline, and what each control point weighs in it. */
struct SplineState {
  int span;
  Eigen::Vector4d weights; /* of the span's four control points */
};

std::vector<SplineState> states_of(int n) {
  std::vector<SplineState> out;
  for (int i = 0; i < n; ++i) {
    const double at = static_cast<double>(kSpans) * i / (n - 1);
    const int span = std::min(static_cast<int>(at), kSpans - 1);
    const double u = at - span, v = 1.0 - u;
    out.push_back({span, Eigen::Vector4d(v * v * v, 3.0 * u * u * u - 6.0 * u * u + 4.0,
                                         3.0 * v * v * v - 6.0 * v * v + 4.0, u * u * u) /
                             6.0});
  }
  return out;
}

struct Sample {
  std::size_t state;
  PairDistance near;
};

/* All pairs within the horizon at all states. */
std::vector<Sample> sample(SampledArm &arm, const std::vector<SplineState> &states, const Eigen::MatrixXd &control) {
  std::vector<Sample> out;
  std::vector<PairDistance> found;
  for (std::size_t i = 0; i < states.size(); ++i) {
    arm.measure(states[i].weights.transpose() * control.middleRows<4>(states[i].span), kHorizon, found);
    for (PairDistance &near : found) out.push_back({i, std::move(near)});
  }
  return out;
}

double least_of(const std::vector<Sample> &samples) {
  double least = kHorizon;
  for (const Sample &one : samples) least = std::min(least, one.near.distance);
  return least;
}

/* Adds the gradient by the control points. */
void add_gradient(const SplineState &state, const PairDistance &near, double factor, Eigen::MatrixXd &by_controls) {
  by_controls.middleRows<4>(state.span) += factor * state.weights * near.by_joints;
}

/* ---- what the optimiser asks ---- */

struct Task {
  explicit Task(const ArmProblem &given) : problem(given) {}

  const ArmProblem &problem;
  Workspace *workspace = nullptr; /* of clearances of the motion, else */
  SampledArm *arm = nullptr;      /* of states */
  std::vector<SplineState> states;
  double jerk = 1.0;   /* at the beginning: the objective is in its units */
  double weight = 0.0; /* of hinges; 0: rows are constraints */
  unsigned evaluations = 0;
  nlopt_opt optimiser = nullptr;
  std::string failure; /* no exception may pass through NLopt */
};

double objective(unsigned, const double *x, double *gradient, void *data) {
  Task &task = *static_cast<Task *>(data);
  const Eigen::MatrixXd control = withInner(task.problem.control, x);
  Eigen::MatrixXd by_controls;
  double sum = squaredJerk(control, by_controls) / task.jerk;
  by_controls /= task.jerk;
  if (task.weight > 0.0) {
    ++task.evaluations;
    const double mean = task.weight / static_cast<double>(task.states.size());
    for (const Sample &one : sample(*task.arm, task.states, control)) {
      const double missing = kClear + kHinge - one.near.distance;
      if (missing <= 0.0) continue;
      sum += mean * missing * missing;
      add_gradient(task.states[one.state], one.near, -2.0 * mean * missing, by_controls);
    }
  }
  if (gradient) putInner(by_controls, gradient);
  return sum;
}

/* A constraint: how far below what is wanted, and its gradient. */
struct Row {
  double value;
  int span;
  Eigen::MatrixXd by_controls;
};

std::vector<Row> rows_of_motion(Task &task, const Eigen::MatrixXd &control) {
  const ArmScene &scene = *task.problem.scene;
  const RobotMotion motion(*scene.robot, trajectoryOf(scene.path.joints, control), scene.rest);
  Query query;
  query.options.signed_distance = true;
  query.options.epsilon = 1e-6;
  RowLimits limits;
  limits.horizon = kHorizon;
  limits.per_pair = kSpans;
  const ClearanceRows found = clearanceRows(motion, RobotPairs::WHOLE, limits, query, *task.workspace);
  if (found.status != CPROX_OK) throw Error(found.message);
  std::vector<Row> out;
  for (const ClearanceRow &row : found.rows)
    out.push_back({row.answer.result.upper, static_cast<int>(std::lround(row.t0 / kStep)), byControls(row.gradient)});
  return out;
}

/* Of each pair the least sample of each span. */
std::vector<Row> rows_of_samples(Task &task, const Eigen::MatrixXd &control) {
  std::map<std::pair<int, std::size_t>, Sample> least;
  for (Sample &one : sample(*task.arm, task.states, control)) {
    const auto [at, is_new] = least.try_emplace({task.states[one.state].span, one.near.pair}, one);
    if (!is_new && one.near.distance < at->second.near.distance) at->second = std::move(one);
  }
  std::vector<Row> out;
  for (const auto &[key, one] : least) {
    Row row = {one.near.distance, key.first, Eigen::MatrixXd::Zero(control.rows(), control.cols())};
    add_gradient(task.states[one.state], one.near, 1.0, row.by_controls);
    out.push_back(std::move(row));
  }
  return out;
}

/* The nearest rows of each span. A span with fewer is clear by the horizon. NLopt wants c(x) <= 0. */
void too_near(unsigned m, double *result, unsigned n, const double *x, double *gradient, void *data) {
  Task &task = *static_cast<Task *>(data);
  std::fill(result, result + m, kClear + kMargin - kHorizon);
  if (gradient) std::fill(gradient, gradient + m * n, 0.0);
  try {
    const Eigen::MatrixXd control = withInner(task.problem.control, x);
    ++task.evaluations;
    std::vector<Row> rows = task.arm ? rows_of_samples(task, control) : rows_of_motion(task, control);
    std::stable_sort(rows.begin(), rows.end(), [](const Row &a, const Row &b) { return a.value < b.value; });
    std::vector<int> taken(kSpans, 0);
    for (const Row &row : rows) {
      if (taken[row.span] == kPairs) continue;
      const int slot = row.span * kPairs + taken[row.span]++;
      result[slot] = kClear + kMargin - row.value;
      if (gradient) putInner(-row.by_controls, gradient + static_cast<std::size_t>(slot) * n);
    }
  } catch (const std::exception &error) {
    task.failure = error.what();
    nlopt_force_stop(task.optimiser);
  }
}

/* One search from x. */
void search(Task &task, std::vector<double> &x) {
  const auto n = static_cast<unsigned>(x.size());
  const std::unique_ptr<nlopt_opt_s, void (*)(nlopt_opt)> optimiser(nlopt_create(NLOPT_LD_SLSQP, n), nlopt_destroy);
  task.optimiser = optimiser.get();
  constexpr unsigned m = kSpans * kPairs;
  const std::vector<double> tolerances(m, 1e-6);
  nlopt_set_min_objective(optimiser.get(), objective, &task);
  if (task.weight == 0.0) nlopt_add_inequality_mconstraint(optimiser.get(), m, too_near, &task, tolerances.data());
  std::vector<double> lower, upper;
  limitsOf(*task.problem.scene->snapshot->robot(), task.problem.scene->path.joints, lower, upper);
  nlopt_set_lower_bounds(optimiser.get(), lower.data());
  nlopt_set_upper_bounds(optimiser.get(), upper.data());
  nlopt_set_maxeval(optimiser.get(), kEvaluations - static_cast<int>(task.evaluations));
  nlopt_set_ftol_rel(optimiser.get(), kRelative);
  double value = 0.0;
  nlopt_optimize(optimiser.get(), x.data(), &value);
  if (!task.failure.empty()) throw Error(task.failure);
}

std::vector<double> begin(Task &task) {
  std::vector<double> x(static_cast<std::size_t>(kInner * task.problem.control.cols()));
  putInner(task.problem.control, x.data());
  Eigen::MatrixXd unused;
  task.jerk = squaredJerk(task.problem.control, unused);
  return x;
}

Outcome by_samples(const ArmProblem &problem, int states, bool hinges) {
  SampledArm arm(*problem.scene);
  const double start = thread_microseconds();
  Task task(problem);
  task.arm = &arm;
  task.states = states_of(states);
  std::vector<double> x = begin(task);
  Outcome out;
  double least = 0.0;
  for (const double weight : kWeights) {
    task.weight = hinges ? weight : 0.0;
    search(task, x);
    out.control = withInner(problem.control, x.data());
    least = least_of(sample(arm, task.states, out.control));
    if (!hinges || least >= kClear || task.evaluations >= kEvaluations) break;
  }
  out.says_clear = least >= kClear, out.says_free = least > 0.0;
  out.evaluations = task.evaluations;
  out.microseconds = thread_microseconds() - start;
  return out;
}

RobotMotion motion_of(const ArmProblem &problem, const Eigen::MatrixXd &control) {
  const ArmScene &scene = *problem.scene;
  return RobotMotion(*scene.robot, trajectoryOf(scene.path.joints, control), scene.rest);
}

} // namespace

Outcome by_rows(const ArmProblem &problem, Workspace &workspace) {
  const double start = thread_microseconds();
  Task task(problem);
  task.workspace = &workspace;
  std::vector<double> x = begin(task);
  search(task, x);
  Outcome out;
  out.control = withInner(problem.control, x.data());
  const RobotMotion motion = motion_of(problem, out.control);
  Query tolerance, collision;
  tolerance.query_type = QueryType::TOLERANCE, tolerance.delta = kClear;
  collision.query_type = QueryType::COLLISION;
  const auto is_clear = [&](const Query &query) {
    return askEnvironment(motion, query, workspace).front().result.verdict == CPROX_VERDICT_CLEAR &&
           askSelf(motion, query, workspace).result.verdict == CPROX_VERDICT_CLEAR;
  };
  out.says_clear = is_clear(tolerance);
  out.says_free = out.says_clear || is_clear(collision);
  out.evaluations = task.evaluations;
  out.microseconds = thread_microseconds() - start;
  return out;
}

Outcome by_sampled_rows(const ArmProblem &problem, int states) {
  return by_samples(problem, states, false);
}

Outcome by_sampled_hinges(const ArmProblem &problem, int states) {
  return by_samples(problem, states, true);
}

Truth truth_of(const ArmProblem &problem, const Eigen::MatrixXd &control, int states, Workspace &workspace) {
  const RobotMotion motion = motion_of(problem, control);
  Query query;
  query.options.signed_distance = true;
  query.options.epsilon = 1e-7;
  const Answer scene = askEnvironment(motion, query, workspace).front(), self = askSelf(motion, query, workspace);
  SampledArm arm(*problem.scene);
  return {std::min(scene.result.lower, self.result.lower), std::min(scene.result.upper, self.result.upper),
          least_of(sample(arm, states_of(states), control))};
}

} // namespace curve_proximity
