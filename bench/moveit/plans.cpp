/* SPDX-License-Identifier: BSD-3-Clause */
/* Plans of a running move_group, by two pipelines in turn: `ompl`, and `ompl_certified`, which has the adapter besides
 * (bench/moveit/move_group.launch). scripts/moveit_beside runs it and draws the page.
 *
 *   moveit_plans ROUNDS SCENE REQUEST [SCENE REQUEST ...]
 *
 * The robot is that of the parameter robot_description. Each request is planned from its start to its goal and from its
 * goal to its start. Each plan is judged twice: by the capability CertifyPath, and by FCL at many moments of the quintic
 * spline that a controller executes.
 *
 * Prints rows of CSV: robot, scene, way, round, pipeline, plan (1: there is one), ms (of the service call), cpu_ms (of
 * all threads of move_group meanwhile: other work on the machine counts little there), proven,
 * certify_ms (of that service), hits (moments at which FCL finds a contact), moments, duration [s] of the plan. Ends with 1
 * where a plan of ompl_certified is not proven or hits something. */
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>

#include <moveit/planning_scene/planning_scene.h>
#include <moveit/robot_state/conversions.h>
#include <moveit/robot_trajectory/robot_trajectory.h>
#include <moveit_msgs/ApplyPlanningScene.h>
#include <moveit_msgs/GetMotionPlan.h>
#include <ros/console.h>
#include <ros/master.h>
#include <ros/network.h>
#include <ros/ros.h>
#include <XmlRpcClient.h>

#include <curve_proximity/CertifyPath.h>

#include "problems.h"

namespace {

using moveit::core::RobotState;
using Clock = std::chrono::steady_clock;

constexpr const char *PIPELINES[] = {"ompl", "ompl_certified"};
constexpr double PLANNING_TIME = 60.0;   /* [s] */
constexpr double BETWEEN_MOMENTS = 1e-3; /* [rad], of the joint that moves the most */
constexpr std::size_t LEAST_MOMENTS = 4; /* of the spline between two waypoints */

double millisecondsSince(Clock::time_point begin) {
  return std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
}

/* The clock of a node's processor time. */
clockid_t processorClockOf(const std::string &node) {
  XmlRpc::XmlRpcValue asked, caller, response, payload;
  asked[0] = caller[0] = ros::this_node::getName();
  asked[1] = node;
  std::string host;
  std::uint32_t port = 0;
  if (!ros::master::execute("lookupNode", asked, response, payload, false) ||
      !ros::network::splitURI(payload, host, port))
    throw curve_proximity::Error("there is no node " + node);
  XmlRpc::XmlRpcClient client(host.c_str(), static_cast<int>(port), "/");
  clockid_t out;
  if (!client.execute("getPid", caller, response) || clock_getcpuclockid(static_cast<int>(response[2]), &out) != 0)
    throw curve_proximity::Error(node + " does not run on this machine");
  return out;
}

double millisecondsOf(clockid_t clock) {
  timespec now;
  clock_gettime(clock, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

template <typename Service>
void call(ros::ServiceClient &client, Service &service) {
  if (!client.call(service))
    throw curve_proximity::Error("no answer of the service " + std::string(client.getService()));
}

/* The quintic polynomial over [0, h] with these values, velocities and accelerations at both ends. */
double quintic(const double *p, const double *v, const double *a, double h, double t) {
  const double u = t / h, d = p[1] - p[0];
  const double v0 = v[0] * h, v1 = v[1] * h, a0 = a[0] * h * h, a1 = a[1] * h * h;
  const double c3 = 10.0 * d - 6.0 * v0 - 4.0 * v1 - 1.5 * a0 + 0.5 * a1;
  const double c4 = -15.0 * d + 8.0 * v0 + 7.0 * v1 + 1.5 * a0 - a1;
  const double c5 = 6.0 * d - 3.0 * (v0 + v1) + 0.5 * (a1 - a0);
  return p[0] + u * (v0 + u * (0.5 * a0 + u * (c3 + u * (c4 + u * c5))));
}

struct Sampled {
  std::size_t hits = 0, moments = 0;
  std::string pair; /* of the first hit */
};

Sampled sample(const Problem &problem, const RobotState &start, const trajectory_msgs::JointTrajectory &path) {
  Sampled out;
  RobotState state(start);
  for (std::size_t i = 1; i < path.points.size(); ++i) {
    const auto &from = path.points[i - 1], &to = path.points[i];
    if (from.accelerations.empty() || to.accelerations.empty())
      throw curve_proximity::Error("a plan without accelerations");
    const double duration = (to.time_from_start - from.time_from_start).toSec();
    double way = 0.0;
    for (std::size_t k = 0; k < from.positions.size(); ++k)
      way = std::max(way, std::abs(to.positions[k] - from.positions[k]));
    const std::size_t moments = LEAST_MOMENTS + static_cast<std::size_t>(way / BETWEEN_MOMENTS);
    for (std::size_t j = 0; j < moments; ++j) {
      for (std::size_t k = 0; k < from.positions.size(); ++k) {
        const double p[] = {from.positions[k], to.positions[k]}, v[] = {from.velocities[k], to.velocities[k]},
                     a[] = {from.accelerations[k], to.accelerations[k]};
        state.setVariablePosition(
            path.joint_names[k],
            quintic(p, v, a, duration, duration * static_cast<double>(j) / static_cast<double>(moments)));
      }
      state.update();
      const std::string pair = pairInContact(*problem.scene, state, problem.group);
      if (pair.empty()) continue;
      if (out.hits++ == 0) out.pair = pair;
    }
    out.moments += moments;
  }
  return out;
}

class Bench {
 public:
  explicit Bench(ros::NodeHandle &node)
      : model_(robotModel(node)),
        processor_(processorClockOf("/move_group")),
        apply_(node.serviceClient<moveit_msgs::ApplyPlanningScene>("apply_planning_scene", true)),
        plan_(node.serviceClient<moveit_msgs::GetMotionPlan>("plan_kinematic_path", true)),
        certify_(node.serviceClient<curve_proximity::CertifyPath>("certify_path", true)) {}

  void ask(const std::string &scene, const std::string &request, int rounds) {
    Problem problem = problemOf(model_, scene, request);
    show(problem);
    for (const char *way : {"there", "back"}) {
      for (int round = 0; round < rounds; ++round)
        for (int i = 0; i < 2; ++i) ask(problem, way, round, (round + i) % 2); // which one comes first alternates
      std::swap(problem.from, problem.to);
    }
  }

  bool isGood() const {
    return plans_ > 0 && faults_ == 0;
  }

 private:
  /* By a diff: move_group plans in the scene before for a while after a whole scene. */
  void show(const Problem &problem) {
    moveit_msgs::ApplyPlanningScene applied;
    moveit_msgs::PlanningScene &scene = applied.request.scene;
    problem.scene->getPlanningSceneMsg(scene);
    moveit_msgs::CollisionObject none;
    none.header.frame_id = problem.scene->getPlanningFrame();
    none.operation = moveit_msgs::CollisionObject::REMOVE; // without a name: all
    scene.world.collision_objects.insert(scene.world.collision_objects.begin(), none);
    scene.is_diff = scene.robot_state.is_diff = true;
    call(apply_, applied);
    if (!applied.response.success) throw curve_proximity::Error(problem.name + ": move_group refuses the scene");
  }

  void ask(const Problem &problem, const char *way, int round, int pipeline) {
    moveit_msgs::GetMotionPlan asked;
    asked.request.motion_plan_request = requestOf(problem, PLANNING_TIME);
    asked.request.motion_plan_request.pipeline_id = PIPELINES[pipeline];
    const Clock::time_point begin = Clock::now();
    const double processor_begin = millisecondsOf(processor_);
    call(plan_, asked);
    const double ms = millisecondsSince(begin), cpu_ms = millisecondsOf(processor_) - processor_begin;
    const moveit_msgs::MotionPlanResponse &res = asked.response.motion_plan_response;
    std::printf("%s,%s,%s,%d,%s,", model_->getName().c_str(), problem.name.c_str(), way, round, PIPELINES[pipeline]);
    if (res.error_code.val != moveit_msgs::MoveItErrorCodes::SUCCESS) {
      std::printf("0,%.2f,%.2f,,,,,\n", ms, cpu_ms);
      return;
    }
    curve_proximity::CertifyPath judged;
    judged.request.joint_trajectory = res.trajectory.joint_trajectory;
    judged.request.start_state = res.trajectory_start.joint_state;
    const Clock::time_point asked_again = Clock::now();
    call(certify_, judged);
    const double certify_ms = millisecondsSince(asked_again);
    const Sampled sampled = sample(problem, *problem.from, res.trajectory.joint_trajectory);
    std::printf("1,%.2f,%.2f,%d,%.2f,%zu,%zu,%.3f\n", ms, cpu_ms, judged.response.certified ? 1 : 0, certify_ms,
                sampled.hits, sampled.moments, res.trajectory.joint_trajectory.points.back().time_from_start.toSec());
    std::fflush(stdout);
    if (pipeline == 0) return;
    ++plans_;
    if (judged.response.certified && sampled.hits == 0) return;
    ++faults_;
    std::fprintf(stderr, "%s, %s: %zu moments in contact (%s), certified %d: %s\n", problem.name.c_str(), way,
                 sampled.hits, sampled.pair.c_str(), judged.response.certified, judged.response.message.c_str());
  }

  moveit::core::RobotModelPtr model_;
  clockid_t processor_; /* of move_group */
  ros::ServiceClient apply_, plan_, certify_;
  int plans_ = 0, faults_ = 0;
};

} // namespace

int main(int argc, char **argv) {
  ros::init(argc, argv, "moveit_plans");
  const int rounds = argc > 1 ? std::atoi(argv[1]) : 0;
  if (argc < 4 || argc % 2 != 0 || rounds < 1) {
    std::fprintf(stderr, "usage: moveit_plans ROUNDS SCENE REQUEST [SCENE REQUEST ...]\n");
    return 2;
  }
  ros::console::set_logger_level(ROSCONSOLE_ROOT_LOGGER_NAME,
                                 ros::console::levels::Error); // its other lines go to stdout
  ros::console::notifyLoggerLevelsChanged();
  ros::NodeHandle node;
  try {
    for (const char *service : {"plan_kinematic_path", "apply_planning_scene", "certify_path"})
      if (!ros::service::waitForService(service, ros::Duration(60.0)))
        throw curve_proximity::Error(std::string("there is no service ") + service);
    Bench bench(node);
    std::printf("robot,scene,way,round,pipeline,plan,ms,cpu_ms,proven,certify_ms,hits,moments,duration\n");
    for (int i = 2; i + 1 < argc; i += 2) bench.ask(argv[i], argv[i + 1], rounds);
    return bench.isGood() ? 0 : 1;
  } catch (const std::exception &error) {
    std::fprintf(stderr, "moveit_plans: %s\n", error.what());
    return 2;
  }
}
