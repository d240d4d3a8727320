/* SPDX-License-Identifier: BSD-3-Clause */
/* Plans of MoveIt's OMPL interface by three ways to check an edge: states by FCL's detector, states by ours, and proven
 * edges in OMPL's motion validator. scripts/moveit_beside runs it beside bench/moveit/move_group.launch, which sets the
 * parameters of the robot and of the planner, and draws the page.
 *
 *   moveit_detectors ROUNDS SCENE REQUEST [SCENE REQUEST ...]
 *
 * Each request is planned from its start to its goal and back. All three get the same random numbers. Each plan is the
 * polyline through its waypoints, as the planner leaves it: MoveIt's own check of the path, our proof of all its edges,
 * and FCL at many states judge it.
 *
 * Prints rows of CSV: robot, scene, way, round, edges (fcl, ours or proven), plan (1: there is one), cpu_ms, valid (1:
 * MoveIt calls the path valid), proven (1: all edges are), hits (states at which FCL finds a contact), states. */
#include <cstdio>
#include <cstdlib>
#include <ctime>

#include <moveit/ompl_interface/model_based_planning_context.h>
#include <moveit/ompl_interface/ompl_interface.h>
#include <ompl/util/Console.h>
#include <ompl/util/RandomNumbers.h>
#include <ros/console.h>
#include <ros/ros.h>

#include "certifier.h"
#include "problems.h"
#include "seeded_numbers.h"

namespace {

using moveit::core::RobotState;

constexpr const char *PARAMETERS = "/move_group/planning_pipelines/ompl";
constexpr double PLANNING_TIME = 60.0;  /* [s] */
constexpr double BETWEEN_STATES = 1e-3; /* [rad], of the joint that moves the most */

enum class Edges { FCL, OURS, PROVEN };
constexpr const char *NAMES[] = {"fcl", "ours", "proven"};

/* Edges between states of one group of joints. */
class ProvenEdges : public ompl::base::MotionValidator {
 public:
  ProvenEdges(const ompl::base::SpaceInformationPtr &si, curve_proximity::EdgeTest edges)
      : MotionValidator(si), edges_(std::move(edges)) {}

  bool checkMotion(const ompl::base::State *from, const ompl::base::State *to) const override {
    const bool valid = si_->satisfiesBounds(to) && edges_(rowOf(from), rowOf(to));
    ++(valid ? valid_ : invalid_);
    return valid;
  }

  bool checkMotion(const ompl::base::State *from, const ompl::base::State *to,
                   std::pair<ompl::base::State *, double> &last) const override {
    if (checkMotion(from, to)) return true;
    if (last.first) si_->copyState(last.first, from);
    last.second = 0.0; // the edge is not proven from where it begins
    return false;
  }

 private:
  curve_proximity::Row rowOf(const ompl::base::State *state) const {
    const double *values = state->as<ompl_interface::ModelBasedStateSpace::StateType>()->values;
    return curve_proximity::Row(values, values + si_->getStateDimension());
  }

  curve_proximity::EdgeTest edges_;
};

double processorTime() {
  timespec now;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

class Bench {
 public:
  explicit Bench(const ros::NodeHandle &node) : model_(robotModel(node)) {
    for (int i = 0; i < 3; ++i)
      planners_.push_back(std::make_unique<ompl_interface::OMPLInterface>(model_, ros::NodeHandle(PARAMETERS)));
  }

  void ask(const std::string &scene, const std::string &request, int rounds) {
    Problem problem = problemOf(model_, scene, request);
    for (const char *way : {"there", "back"}) {
      for (int round = 0; round < rounds; ++round) {
        ++number_;
        for (int i = 0; i < 3; ++i) ask(problem, way, round, static_cast<Edges>((round + i) % 3));
      }
      std::swap(problem.from, problem.to);
    }
  }

 private:
  curve_proximity::EdgeTest edgesOf(const planning_scene::PlanningScene &scene, const Problem &problem) const {
    using curve_proximity::RobotPairs;
    const auto of = [&](RobotPairs against) {
      const std::vector<std::string> &joints = model_->getJointModelGroup(problem.group)->getVariableNames();
      return certifier_.edges(scene, *problem.from, joints, against, {});
    };
    const curve_proximity::EdgeTest objects = of(RobotPairs::ENVIRONMENT), itself = of(RobotPairs::SELF);
    return [objects, itself](const curve_proximity::Row &from, const curve_proximity::Row &to) {
      return objects(from, to) && itself(from, to);
    };
  }

  void ask(const Problem &problem, const char *way, int round, Edges edges) {
    const auto scene = std::make_shared<planning_scene::PlanningScene>(
        model_, std::make_shared<collision_detection::World>(*problem.scene->getWorld()));
    scene->setCurrentState(*problem.from);
    if (edges != Edges::FCL)
      scene->setActiveCollisionDetector(curve_proximity::CollisionDetectorAllocatorCurveProximity::create(), true);
    ompl::RNG::setSeed(1000 * number_);
    seedNumbers(1000 * number_);
    const double begin = processorTime();
    moveit_msgs::MoveItErrorCodes error;
    const auto context =
        planners_[static_cast<std::size_t>(edges)]->getPlanningContext(scene, requestOf(problem, PLANNING_TIME), error);
    if (!context) throw curve_proximity::Error(problem.name + ": the planner refuses the request");
    const ompl::base::SpaceInformationPtr &space = context->getOMPLSimpleSetup()->getSpaceInformation();
    if (edges == Edges::PROVEN)
      space->setMotionValidator(std::make_shared<ProvenEdges>(space, edgesOf(*scene, problem)));
    planning_interface::MotionPlanResponse res;
    const bool planned = context->solve(res);
    const double ms = processorTime() - begin;
    std::printf("%s,%s,%s,%d,%s,%d,%.2f,", model_->getName().c_str(), problem.name.c_str(), way, round,
                NAMES[static_cast<int>(edges)], planned ? 1 : 0, ms);
    if (planned)
      judge(problem, *scene, *res.trajectory_);
    else
      std::printf(",,,\n");
    std::fflush(stdout);
  }

  void judge(const Problem &problem, const planning_scene::PlanningScene &scene,
             const robot_trajectory::RobotTrajectory &path) const {
    const bool valid = scene.isPathValid(path, problem.group);
    const curve_proximity::EdgeTest proven = edgesOf(*problem.scene, problem);
    bool all_proven = true;
    std::size_t hits = 0, states = 0;
    curve_proximity::Row from, to;
    for (std::size_t i = 0; i < path.getWayPointCount(); ++i, from = to) {
      path.getWayPoint(i).copyJointGroupPositions(problem.group, to);
      if (i == 0) continue;
      all_proven = all_proven && proven(from, to);
      double way = 0.0;
      for (std::size_t k = 0; k < to.size(); ++k) way = std::max(way, std::abs(to[k] - from[k]));
      const int n = 1 + static_cast<int>(way / BETWEEN_STATES);
      RobotState state(*problem.from);
      for (int j = 0; j < n; ++j) {
        path.getWayPoint(i - 1).interpolate(path.getWayPoint(i), static_cast<double>(j) / n, state);
        state.update();
        hits += pairInContact(*problem.scene, state, problem.group).empty() ? 0 : 1;
      }
      states += static_cast<std::size_t>(n);
    }
    std::printf("%d,%d,%zu,%zu\n", valid ? 1 : 0, all_proven ? 1 : 0, hits, states);
  }

  moveit::core::RobotModelPtr model_;
  std::vector<std::unique_ptr<ompl_interface::OMPLInterface>> planners_; /* one for each way to check edges */
  curve_proximity::Certifier certifier_;
  unsigned int number_ = 0; /* of the request */
};

} // namespace

int main(int argc, char **argv) {
  ros::init(argc, argv, "moveit_detectors");
  const int rounds = argc > 1 ? std::atoi(argv[1]) : 0;
  if (argc < 4 || argc % 2 != 0 || rounds < 1) {
    std::fprintf(stderr, "usage: moveit_detectors ROUNDS SCENE REQUEST [SCENE REQUEST ...]\n");
    return 2;
  }
  ros::console::set_logger_level(ROSCONSOLE_ROOT_LOGGER_NAME,
                                 ros::console::levels::Error); // its other lines go to stdout
  ros::console::notifyLoggerLevelsChanged();
  ompl::msg::noOutputHandler();
  ros::NodeHandle node;
  try {
    Bench bench(node);
    std::printf("robot,scene,way,round,edges,plan,cpu_ms,valid,proven,hits,states\n");
    for (int i = 2; i + 1 < argc; i += 2) bench.ask(argv[i], argv[i + 1], rounds);
    return 0;
  } catch (const std::exception &error) {
    std::fprintf(stderr, "moveit_detectors: %s\n", error.what());
    return 2;
  }
}
