/* SPDX-License-Identifier: BSD-3-Clause */
#include "certifier.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>

#include <curve_proximity/roadmap.hpp>

namespace curve_proximity {
namespace {

using Clock = std::chrono::steady_clock;
using Env = CollisionEnvCurveProximity;

constexpr double RESOLUTION = 1000.0; /* parts of a duration: how closely intervals are found */

/* What stays of a robot from plan to plan. */
Workspace &certifierWorkspace() {
  thread_local Workspace own;
  return own;
}

/* Is polled by the search; true: the time is over. */
bool isOver(void *end) {
  return Clock::now() >= *static_cast<const Clock::time_point *>(end);
}

/* "from 1.2 to 1.35 s, from 2 to 2.1 s". */
std::string textOf(const Violations &violations) {
  std::string out;
  for (const Violation &violation : violations.list) {
    char text[80];
    std::snprintf(text, sizeof text, "%sfrom %.4g to %.4g s", out.empty() ? "" : ", ", violation.enter_lower,
                  violation.leave_upper);
    out += text;
  }
  return out;
}

/* One query about a motion, with what follows where it is not proven. */
class Look {
 public:
  Look(const RobotMotion &motion, bool self, const CertifySettings &settings)
      : motion_(motion), self_(self), settings_(settings) {
    query_.query_type = settings.clearance > 0.0 ? QueryType::TOLERANCE : QueryType::COLLISION;
    query_.delta = settings.clearance;
    query_.allow_empty = true; // MoveIt's scene is whole
    query_.options.epsilon = settings.epsilon;
    query_.options.stop = isOver;
    query_.options.stop_user = &end_;
  }

  /* Adds to the finding what is not proven; where and by how much if it `measures`. */
  void operator()(Finding &out, bool measures) {
    beginBudget();
    Answer answer = ask();
    if (answer.result.status >= 0 && answer.result.verdict == CPROX_VERDICT_CLEAR) return;
    if (!out.why.empty()) out.why += "; ";
    out.why += answer.kind + ": ";
    out.of_self = self_;
    if (answer.result.status < 0) {
      out.why += "failed, " + answer.message;
      out.clear_until = motion_.domain()[0];
      return;
    }
    out.why += cprox_verdict_name(answer.result.verdict);
    if (!measures) return;
    const std::string remark = answer.message.empty() ? "" : " (" + answer.message + ")";
    Doubt doubt;
    doubt.where = intervals();
    const std::vector<Violation> &list = doubt.where.list;
    out.clear_until = std::min(out.clear_until, list.empty() ? motion_.domain()[0] : list.front().enter_lower);
    measure(answer);
    out.why += textOf(answer, doubt.where) + remark;
    doubt.answer = std::move(answer);
    out.doubts.push_back(std::move(doubt));
  }

 private:
  void beginBudget() {
    end_ = Clock::now() + std::chrono::microseconds(std::llround(1e3 * settings_.budget_ms));
  }

  Answer ask() {
    return self_ ? askSelf(motion_, query_, workspace_) : askEnvironment(motion_, query_, workspace_).front();
  }

  /* Of a robot that stands: everywhere, and so none. */
  Violations intervals() {
    if (motion_.stands()) return {};
    beginBudget();
    query_.query_type = QueryType::TOLERANCE;
    const double duration = motion_.domain()[1] - motion_.domain()[0];
    return violations(motion_, self_, duration / RESOLUTION, query_, workspace_);
  }

  /* By how much? In contact by the depth, where that is known. */
  void measure(Answer &answer) {
    const cprox_verdict verdict = answer.result.verdict;
    query_.query_type = QueryType::DISTANCE;
    query_.delta = 0.0;
    const Answer distance = ask();
    if (distance.result.status == CPROX_OK) answer = distance;
    if (answer.result.upper <= 0.0) {
      query_.options.signed_distance = 1;
      try {
        const Answer depth = ask();
        if (depth.result.status == CPROX_OK) answer = depth;
      } catch (const Error &) {
      }
    }
    answer.result.verdict = verdict;
  }

  std::string textOf(const Answer &answer, const Violations &where) const {
    char text[160];
    std::snprintf(text, sizeof text, ": between %.6g and %.6g m%s at t = %.4g s, up to %.3g m less than asked",
                  answer.result.lower, answer.result.upper, answer.by_hull ? " of convex hulls" : "", answer.result.t,
                  std::max(0.0, settings_.clearance - answer.result.lower));
    const std::string intervals = curve_proximity::textOf(where);
    return ", " + (answer.b.empty() ? "the nearest pair is not known" : "'" + answer.a + "' and '" + answer.b + "'") +
           text + (intervals.empty() ? "" : ", not proven " + intervals);
  }

  const RobotMotion &motion_;
  const bool self_;
  const CertifySettings &settings_;
  Workspace &workspace_ = certifierWorkspace();
  Query query_;
  Clock::time_point end_;
};

/* MoveIt checks the robot with itself at its own size. */
std::shared_ptr<const Env> atItsOwnSize(const std::shared_ptr<const Env> &env) {
  std::map<std::string, double> scales = env->getLinkScale();
  const auto is_one = [](const std::pair<const std::string, double> &scale) { return scale.second == 1.0; };
  if (std::all_of(scales.begin(), scales.end(), is_one)) return env;
  for (auto &[link, scale] : scales) scale = 1.0;
  const auto out = std::make_shared<Env>(*env, std::make_shared<collision_detection::World>(*env->getWorld()));
  out->setLinkScale(scales);
  return out;
}

} // namespace

/* The scene's own environment where it is one of ours; else one of the same world, made of the one before. */
std::shared_ptr<const Env> Certifier::envOf(const planning_scene::PlanningScene &scene) const {
  if (const auto own = std::dynamic_pointer_cast<const Env>(scene.getCollisionEnv())) return own;
  const auto world = std::make_shared<collision_detection::World>(*scene.getWorld());
  const std::lock_guard<std::mutex> lock(mutex_);
  const bool is_known = last_ && last_->getRobotModel() == scene.getRobotModel();
  const auto env =
      is_known ? std::make_shared<Env>(*last_, world) : std::make_shared<Env>(scene.getRobotModel(), world);
  env->setLinkPadding(scene.getCollisionEnv()->getLinkPadding());
  env->setLinkScale(scene.getCollisionEnv()->getLinkScale());
  last_ = env;
  return env;
}

Finding Certifier::find(const planning_scene::PlanningScene &scene, const robot_trajectory::RobotTrajectory &trajectory,
                        const CertifySettings &settings, bool measures) const {
  Finding out;
  try {
    if (trajectory.getWayPointCount() == 0) throw Error("it has no waypoint");
    const std::shared_ptr<const Env> env = envOf(scene), own_size = atItsOwnSize(env);
    const TrajectoryDescription spline = timed(trajectory);
    const auto motion = [&](const Env &of) {
      return of.motion(spline, trajectory.getFirstWayPoint(), scene.getAllowedCollisionMatrix());
    };
    const RobotMotion among_objects = motion(*env);
    out.clear_until = among_objects.domain()[1];
    out.warnings = among_objects.warnings();
    Look(among_objects, false, settings)(out, measures);
    if (!measures && !out.why.empty()) return out;
    if (own_size == env) {
      Look(among_objects, true, settings)(out, measures);
    } else {
      const RobotMotion with_itself = motion(*own_size);
      Look(with_itself, true, settings)(out, measures);
    }
  } catch (const std::exception &error) {
    out = {};
    out.why = std::string("the trajectory cannot be certified: ") + error.what();
  }
  return out;
}

EdgeTest Certifier::edges(const planning_scene::PlanningScene &scene, const moveit::core::RobotState &at,
                          const std::vector<std::string> &joints, RobotPairs against,
                          const CertifySettings &settings) const {
  const std::shared_ptr<const Env> env = against == RobotPairs::SELF ? atItsOwnSize(envOf(scene)) : envOf(scene);
  Query query;
  query.query_type = settings.clearance > 0.0 ? QueryType::TOLERANCE : QueryType::COLLISION;
  query.delta = settings.clearance;
  query.allow_empty = true; // MoveIt's scene is whole
  query.options.epsilon = settings.epsilon;
  const Env::Ready ready = env->robot(at, joints, scene.getAllowedCollisionMatrix());
  const auto checker = std::make_shared<EdgeChecker>(*ready.robot, joints, ready.rest, against, query);
  const auto workspace = std::make_shared<Workspace>();
  return [checker, workspace](const Row &from, const Row &to) {
    return checker->ask(from.data(), to.data(), *workspace) == CPROX_VERDICT_CLEAR;
  };
}

Finding Certifier::certify(const planning_scene::PlanningScene &scene,
                           const robot_trajectory::RobotTrajectory &trajectory, const CertifySettings &settings) const {
  return find(scene, trajectory, settings, true);
}

Finding Certifier::judge(const planning_scene::PlanningScene &scene,
                         const robot_trajectory::RobotTrajectory &trajectory, const CertifySettings &settings) const {
  return find(scene, trajectory, settings, false);
}

} // namespace curve_proximity
