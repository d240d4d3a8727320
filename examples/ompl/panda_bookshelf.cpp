/* SPDX-License-Identifier: BSD-3-Clause */
/** Plans for a Panda in a bookshelf twice, by RRT-Connect: with edges that are proven clear, and with edges that are
 * sampled as is usual. Then both paths are held against the proof: how many of the sampled one's edges touch something
 * after all?
 *
 *    example_ompl ROBOT.urdf ROBOT.srdf SCENE.yaml TRAJECTORY.yaml [RUNS] [OUT.yaml]
 *
 *  TRAJECTORY.yaml: from its first to its last point is planned. OUT.yaml: the last certified path, as `cprox collision
 * --trajectory` reads it. */
#include <ompl/base/ProblemDefinition.h>
#include <ompl/base/spaces/RealVectorStateSpace.h>
#include <ompl/geometric/PathGeometric.h>
#include <ompl/geometric/planners/rrt/RRTConnect.h>
#include <ompl/util/Console.h>
#include <ompl/util/RandomNumbers.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <memory>

#include "edges.hpp"
#include "reading.hpp"

namespace base = ompl::base;
namespace geometric = ompl::geometric;

namespace {

/* The Panda's limits [rad], rounded inwards. */
constexpr std::array<double, 7> LOWEST = {-2.89, -1.76, -2.89, -3.07, -2.89, -0.01, -2.89};
constexpr std::array<double, 7> HIGHEST = {2.89, 1.76, 2.89, -0.07, 2.89, 3.75, 2.89};

/* What MoveIt samples edges with: steps of this fraction of the space's extent. */
constexpr double LONGEST_SEGMENT = 0.01;

struct Plan {
  double seconds = 0.0;
  std::vector<std::vector<double>> path; /* empty: none was found */
};

Plan plan(const Task &task, bool certified, double limit) {
  const auto space = std::make_shared<base::RealVectorStateSpace>(task.joints.size());
  base::RealVectorBounds bounds(7);
  for (unsigned i = 0; i < 7; ++i) {
    bounds.setLow(i, LOWEST[i]);
    bounds.setHigh(i, HIGHEST[i]);
  }
  space->setBounds(bounds);
  space->setLongestValidSegmentFraction(LONGEST_SEGMENT);

  const auto information = std::make_shared<base::SpaceInformation>(space);
  information->setStateValidityChecker(std::make_shared<StateChecker>(information, task));
  if (certified) information->setMotionValidator(std::make_shared<CertifiedMotionValidator>(information, task));
  information->setup();

  const auto problem = std::make_shared<base::ProblemDefinition>(information);
  base::ScopedState<base::RealVectorStateSpace> start(space), goal(space);
  for (unsigned i = 0; i < 7; ++i) {
    start[i] = task.start[i];
    goal[i] = task.goal[i];
  }
  problem->setStartAndGoalStates(start, goal);
  geometric::RRTConnect planner(information);
  planner.setProblemDefinition(problem);
  planner.setup();

  Plan out;
  const auto begin = std::chrono::steady_clock::now();
  const base::PlannerStatus status = planner.solve(base::timedPlannerTerminationCondition(limit));
  out.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  if (status != base::PlannerStatus::EXACT_SOLUTION) return out;
  for (const base::State *state : problem->getSolutionPath()->as<geometric::PathGeometric>()->getStates()) {
    const double *values = state->as<base::RealVectorStateSpace::StateType>()->values;
    out.path.emplace_back(values, values + 7);
  }
  return out;
}

/* How many edges of a path are not proven clear. */
int edgesInDoubt(const Task &task, const Plan &plan) {
  curve_proximity::Workspace workspace;
  int in_doubt = 0;
  for (std::size_t i = 1; i < plan.path.size(); ++i)
    in_doubt += !clearBetween(task, plan.path[i - 1], plan.path[i], workspace);
  return in_doubt;
}

void write(const Task &task, const Plan &plan, const char *file) {
  std::ofstream out(file);
  out.precision(17);
  const auto list = [&out](const auto &values) {
    out << "[";
    for (std::size_t i = 0; i < values.size(); ++i) out << (i ? ", " : "") << values[i];
    out << "]";
  };
  out << "interpolation: linear\nfixed_joints:\n";
  for (const auto &[joint, value] : task.rest) out << "  " << joint << ": " << value << "\n";
  out << "joint_trajectory:\n  joint_names: ";
  list(task.joints);
  out << "\n  points:\n";
  for (std::size_t i = 0; i < plan.path.size(); ++i) {
    out << "    - {time_from_start: " << i << ", positions: ";
    list(plan.path[i]);
    out << "}\n";
  }
}

} // namespace

int main(int argc, char **argv) {
  if (argc < 5 || argc > 7) {
    std::fprintf(stderr, "usage: %s ROBOT.urdf ROBOT.srdf SCENE.yaml TRAJECTORY.yaml [RUNS] [OUT.yaml]\n", argv[0]);
    return 2;
  }
  const int runs = argc > 5 ? std::atoi(argv[5]) : 10;
  ompl::msg::setLogLevel(ompl::msg::LOG_ERROR);
  ompl::RNG::setSeed(1);

  Task task;
  try {
    task = readTask(argv[1], argv[2], argv[3], argv[4]);
  } catch (const std::exception &e) {
    std::fprintf(stderr, "%s\n", e.what());
    return 1;
  }

  std::printf("run  edges proven: path, seconds, in doubt | edges sampled: path, seconds, in doubt\n");
  int proven = 0, in_doubt = 0, wrong = 0;
  Plan last;
  for (int run = 0; run < runs; ++run) {
    const Plan certified = plan(task, true, 60.0), sampled = plan(task, false, 60.0);
    const int doubt_certified = edgesInDoubt(task, certified), doubt_sampled = edgesInDoubt(task, sampled);
    std::printf("%3d  %17zu %8.3f %9d | %18zu %8.3f %9d\n", run, certified.path.size(), certified.seconds,
                doubt_certified, sampled.path.size(), sampled.seconds, doubt_sampled);
    std::fflush(stdout);
    proven += !certified.path.empty();
    wrong += doubt_certified;
    in_doubt += doubt_sampled > 0;
    if (!certified.path.empty()) last = certified;
  }
  std::printf("%d of %d paths proven clear; %d of the sampled paths have an edge that is not\n", proven, runs,
              in_doubt);
  if (argc > 6) write(task, last, argv[6]);
  return proven == runs && wrong == 0 ? 0 : 1;
}
