/* SPDX-License-Identifier: BSD-3-Clause */
/** Plans for a Panda in a bookshelf by RRT-Connect, with edges that are proven clear and with edges that are sampled;
 *  then by a roadmap of a hundred thousand edges, all of them proven. Paths and edges of samples are held against the
 *  proof: how many touch something after all?
 *
 *    example_ompl ROBOT.urdf ROBOT.srdf SCENE.yaml TRAJECTORY.yaml [RUNS [OUT.yaml [EDGES]]]
 *
 *  TRAJECTORY.yaml: from its first to its last point is planned. OUT.yaml: the last certified path, as `cprox collision
 *  --trajectory` reads it. EDGES of the roadmap; 0: none.
 *
 *  All four validators ask the same function, samples as edges of length 0. The planners draw the same postures, so
 *  their times differ by what validation costs. */
#include <ompl/base/ProblemDefinition.h>
#include <ompl/base/spaces/RealVectorStateSpace.h>
#include <ompl/geometric/PathGeometric.h>
#include <ompl/geometric/planners/rrt/RRTConnect.h>
#include <ompl/util/Console.h>
#include <ompl/util/RandomNumbers.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <memory>

#include "edges.hpp"
#include "lazy_prm.hpp"
#include "reading.hpp"

namespace base = ompl::base;
namespace geometric = ompl::geometric;

namespace {

/* The Panda's limits [rad], rounded inwards. */
constexpr std::array<double, 7> LOWEST = {-2.89, -1.76, -2.89, -3.07, -2.89, -0.01, -2.89};
constexpr std::array<double, 7> HIGHEST = {2.89, 1.76, 2.89, -0.07, 2.89, 3.75, 2.89};

/* How edges are validated: by a proof, or by samples so far apart at most [rad]. */
struct Validation {
  const char *name;
  double step; /* 0: proven */
};

/* What MoveIt samples edges with: steps of this fraction of the space's extent. */
constexpr double MOVEIT_FRACTION = 0.01;

struct Plan {
  double seconds = 0.0;
  unsigned edges = 0;                    /* validated */
  std::vector<std::vector<double>> path; /* empty: none was found */
};

/* Postures by a seed of their own. */
class SeededSampler : public base::RealVectorStateSampler {
 public:
  SeededSampler(const base::StateSpace *space, std::uint_fast32_t seed) : RealVectorStateSampler(space) {
    rng_.setLocalSeed(seed);
  }
};

double extent() {
  double sum = 0.0;
  for (unsigned i = 0; i < 7; ++i) sum += (HIGHEST[i] - LOWEST[i]) * (HIGHEST[i] - LOWEST[i]);
  return std::sqrt(sum);
}

Plan plan(const Task &task, const Validation &by, std::uint_fast32_t seed, double limit) {
  const auto space = std::make_shared<base::RealVectorStateSpace>(task.joints.size());
  base::RealVectorBounds bounds(7);
  for (unsigned i = 0; i < 7; ++i) {
    bounds.setLow(i, LOWEST[i]);
    bounds.setHigh(i, HIGHEST[i]);
  }
  space->setBounds(bounds);
  space->setLongestValidSegmentFraction(by.step > 0.0 ? by.step / extent() : MOVEIT_FRACTION);
  space->setStateSamplerAllocator(
      [seed](const base::StateSpace *of) { return std::make_shared<SeededSampler>(of, seed); });

  const auto information = std::make_shared<base::SpaceInformation>(space);
  information->setStateValidityChecker(std::make_shared<StateChecker>(information, task));
  if (by.step == 0.0) information->setMotionValidator(std::make_shared<CertifiedMotionValidator>(information, task));
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
  out.edges = information->getMotionValidator()->getValidMotionCount() +
              information->getMotionValidator()->getInvalidMotionCount();
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
    in_doubt += !isClear(task, plan.path[i - 1].data(), plan.path[i].data(), workspace);
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

/* Of some runs. */
struct Sum {
  double seconds = 0.0;
  std::vector<double> ratios; /* proven over this one */
  unsigned long edges = 0;
  int found = 0, paths_in_doubt = 0, edges_in_doubt = 0;
};

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values.empty() ? 0.0 : values[values.size() / 2];
}

} // namespace

int main(int argc, char **argv) {
  if (argc < 5 || argc > 8) {
    std::fprintf(stderr, "usage: %s ROBOT.urdf ROBOT.srdf SCENE.yaml TRAJECTORY.yaml [RUNS [OUT.yaml [EDGES]]]\n",
                 argv[0]);
    return 2;
  }
  const int runs = argc > 5 ? std::atoi(argv[5]) : 10;
  const std::size_t edges = argc > 7 ? std::strtoul(argv[7], nullptr, 10) : 100000;
  ompl::msg::setLogLevel(ompl::msg::LOG_ERROR);
  ompl::RNG::setSeed(1);

  Task task;
  try {
    task = readTask(argv[1], argv[2], argv[3], argv[4]);
  } catch (const std::exception &e) {
    std::fprintf(stderr, "%s\n", e.what());
    return 1;
  }

  const std::array<Validation, 4> all = {
      {{"proven", 0.0}, {"MoveIt's step", MOVEIT_FRACTION * extent()}, {".05 rad", 0.05}, {".01 rad", 0.01}}};
  std::array<Sum, 4> sums;
  Plan last;
  std::printf("ms of RRT-Connect, and edges of its path that are not clear\nrun %20s %20s %20s %20s\n", all[0].name,
              all[1].name, all[2].name, all[3].name);
  for (int run = 0; run < runs; ++run) {
    double proven = 0.0;
    std::printf("%3d", run);
    for (std::size_t k = 0; k < all.size(); ++k) {
      const Plan found = plan(task, all[k], static_cast<std::uint_fast32_t>(run + 1), 60.0);
      const int in_doubt = edgesInDoubt(task, found);
      if (k == 0) proven = found.seconds;
      if (k == 0 && !found.path.empty()) last = found;
      sums[k].seconds += found.seconds;
      sums[k].ratios.push_back(proven / found.seconds);
      sums[k].edges += found.edges;
      sums[k].found += !found.path.empty();
      sums[k].paths_in_doubt += in_doubt > 0;
      sums[k].edges_in_doubt += in_doubt;
      std::printf(" %14.2f ms, %2d", 1e3 * found.seconds, in_doubt);
    }
    std::printf("\n");
    std::fflush(stdout);
  }
  for (std::size_t k = 0; k < all.size(); ++k)
    std::printf(
        "%-14s %2d of %d paths found, %9.2f ms in all, %7lu edges; %2d paths have %2d edges that are not clear; "
        "proven takes %.2f of its time in the median\n",
        all[k].name, sums[k].found, runs, 1e3 * sums[k].seconds, sums[k].edges, sums[k].paths_in_doubt,
        sums[k].edges_in_doubt, median(sums[k].ratios));
  std::printf("%d of %d paths proven clear\n", sums[0].found, runs);
  const bool mapped =
      edges == 0 || planByRoadmap(task, {LOWEST.begin(), LOWEST.end()}, {HIGHEST.begin(), HIGHEST.end()}, edges);
  if (argc > 6) write(task, last, argv[6]);
  return sums[0].found == runs && sums[0].edges_in_doubt == 0 && mapped ? 0 : 1;
}
