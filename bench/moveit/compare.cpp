/* SPDX-License-Identifier: BSD-3-Clause */
/* MoveIt's collision detectors side by side in one process: FCL's, Bullet's and ours, each inside its own
 * CollisionEnv, on a Panda in scenes of MotionBenchMaker. scripts/moveit_beside runs it and draws the page.
 *
 *   moveit_compare STATES SCENE TRAJECTORY [SCENE TRAJECTORY ...]
 *
 * Prints rows of CSV: scene, query, method, cases, hits, differs, median_us, error. `differs` counts the verdicts that
 * are not ours; `error` is the largest amount [m] by which a distance lies above ours. */
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <regex>
#include <sstream>

#include <geometric_shapes/shape_operations.h>
#include <moveit/collision_detection_bullet/collision_detector_allocator_bullet.h>
#include <moveit/collision_detection_fcl/collision_detector_allocator_fcl.h>
#include <ros/console.h>
#include <ros/time.h>
#include <urdf_parser/urdf_parser.h>

#include "collision_env.h"
#include "worlds.h"

namespace cd = collision_detection;
namespace cp = curve_proximity;
using moveit::core::RobotState;

namespace {

std::string readText(const std::string &path) {
  std::ifstream file(path);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

/* The Panda of test/data; its mesh paths are absolute for MoveIt. */
moveit::core::RobotModelPtr panda() {
  const std::string folder = TEST_DATA_DIR "/robots/panda/";
  const std::string text = std::regex_replace(readText(folder + "panda.urdf"), std::regex("filename=\"meshes"),
                                              "filename=\"file://" + folder + "meshes");
  const auto urdf = urdf::parseURDF(text);
  auto srdf = std::make_shared<srdf::Model>();
  srdf->initString(*urdf, readText(folder + "panda.srdf"));
  return std::make_shared<moveit::core::RobotModel>(urdf, srdf);
}

double now() {
  return std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + values.size() / 2, values.end());
  return values[values.size() / 2];
}

/* One method on all cases: its value and its time for each. */
struct Run {
  std::vector<double> value, us;
};

Run run(std::size_t cases, const std::function<double(std::size_t)> &ask) {
  Run out;
  for (std::size_t i = 0; i < cases; ++i) {
    const double begin = now();
    out.value.push_back(ask(i));
    out.us.push_back(now() - begin);
  }
  return out;
}

void printVerdicts(const std::string &scene, const char *query, const char *method, const Run &run, const Run &ours) {
  int hits = 0, differs = 0;
  for (std::size_t i = 0; i < run.value.size(); ++i) {
    hits += run.value[i] > 0.0;
    differs += run.value[i] != ours.value[i];
  }
  std::printf("%s,%s,%s,%zu,%d,%d,%.2f,\n", scene.c_str(), query, method, run.value.size(), hits, differs,
              median(run.us));
}

/* Distances below 0 are all contact. */
void printDistances(const std::string &scene, const char *query, const char *method, const Run &run, const Run &ours) {
  double error = 0.0;
  int hits = 0, differs = 0;
  for (std::size_t i = 0; i < run.value.size(); ++i) {
    const double value = std::max(0.0, run.value[i]), other = std::max(0.0, ours.value[i]);
    error = std::max(error, value - other);
    hits += value <= 0.0;
    differs += std::abs(value - other) > 1e-4;
  }
  std::printf("%s,%s,%s,%zu,%d,%d,%.2f,%.2g\n", scene.c_str(), query, method, run.value.size(), hits, differs,
              median(run.us), error);
}

/* Half of the states on the trajectory or beside it, half anywhere. */
std::vector<RobotState> statesOf(const moveit::core::RobotModelPtr &model, const cp::TrajectoryDescription &path,
                                 std::size_t n) {
  random_numbers::RandomNumberGenerator random(71);
  std::vector<RobotState> out;
  for (std::size_t i = 0; i < n; ++i) {
    RobotState state(model);
    state.setToDefaultValues();
    if (i % 2 == 0) state.setToRandomPositions(model->getJointModelGroup("panda_arm"), random);
    if (i % 2 == 1)
      for (std::size_t k = 0; k < path.joints.size(); ++k)
        state.setVariablePosition(path.joints[k],
                                  path.points[i % path.points.size()].positions[k] + random.uniformReal(-0.2, 0.2));
    state.enforceBounds();
    state.update();
    out.push_back(state);
  }
  return out;
}

/* States on the way from one state to another, at most .05 rad apart in any joint: the samples of MoveIt's planners. */
bool sampled(const cd::CollisionEnv &env, const RobotState &from, const RobotState &to,
             const cd::AllowedCollisionMatrix &acm) {
  double farthest = 0.0;
  for (std::size_t i = 0; i < from.getVariableCount(); ++i)
    farthest = std::max(farthest, std::abs(from.getVariablePosition(i) - to.getVariablePosition(i)));
  const int steps = std::max(1, static_cast<int>(std::ceil(farthest / 0.05)));
  RobotState state(from);
  for (int i = 0; i <= steps; ++i) {
    from.interpolate(to, static_cast<double>(i) / steps, state);
    state.update();
    cd::CollisionResult res;
    env.checkRobotCollision({}, res, state, acm);
    if (res.collision) return true;
  }
  return false;
}

void compare(const moveit::core::RobotModelPtr &model, const std::string &scene, const std::string &trajectory,
             std::size_t n) {
  const cp::TrajectoryDescription path = cp::loadTrajectoryFile(trajectory);
  const cd::WorldPtr world = worldOf(scene);
  const cd::AllowedCollisionMatrix acm(*model->getSRDF());
  const std::string folder = scene.substr(0, scene.rfind('/')), name = folder.substr(folder.rfind('/') + 1);
  const auto ours = cp::CollisionDetectorAllocatorCurveProximity::create()->allocateEnv(world, model);
  const std::vector<std::pair<const char *, cd::CollisionEnvPtr>> envs = {
      {"curve_proximity", ours},
      {"FCL", cd::CollisionDetectorAllocatorFCL::create()->allocateEnv(world, model)},
      {"Bullet", cd::CollisionDetectorAllocatorBullet::create()->allocateEnv(world, model)}};
  const std::vector<RobotState> states = statesOf(model, path, n);
  const auto check = [&](const cd::CollisionEnv &env, std::size_t i) {
    cd::CollisionResult res;
    env.checkSelfCollision({}, res, states[i], acm);
    if (!res.collision) env.checkRobotCollision({}, res, states[i], acm);
    return res.collision ? 1.0 : 0.0;
  };
  const auto distance = [&](const cd::CollisionEnv &env, std::size_t i) { return env.distanceRobot(states[i], acm); };
  Run first;
  for (const auto &[method, env] : envs) {
    check(*env, 0);
    const Run found = run(n, [&, env = env](std::size_t i) { return check(*env, i); });
    if (env == ours) first = found;
    printVerdicts(name, "state", method, found, first);
  }
  for (const auto &[method, env] : envs) {
    if (std::string(method) == "Bullet") continue; // it has no distances
    const Run found = run(n, [&, env = env](std::size_t i) { return distance(*env, i); });
    if (env == ours) first = found;
    printDistances(name, "distance", method, found, first);
  }

  /* Segments from each state to the one after the next, against the scene: certified, cast and sampled. */
  const std::size_t segments = n / 4;
  const auto cast = [&](const cd::CollisionEnv &env, std::size_t i) {
    cd::CollisionResult res;
    env.checkRobotCollision({}, res, states[i], states[i + 2], acm);
    return res.collision ? 1.0 : 0.0;
  };
  first = run(segments, [&](std::size_t i) { return cast(*ours, i); });
  printVerdicts(name, "segment", "curve_proximity", first, first);
  printVerdicts(name, "segment", "Bullet cast", run(segments, [&](std::size_t i) { return cast(*envs[2].second, i); }),
                first);
  printVerdicts(
      name, "segment", "FCL sampled",
      run(segments, [&](std::size_t i) { return sampled(*envs[1].second, states[i], states[i + 2], acm) ? 1.0 : 0.0; }),
      first);
}

} // namespace

int main(int argc, char **argv) {
  constexpr std::size_t FEWEST = 4; // states: so many make a segment
  const std::size_t states = argc > 1 ? std::strtoul(argv[1], nullptr, 10) : 0;
  if (argc < 4 || argc % 2 != 0 || states < FEWEST) {
    std::fprintf(stderr,
                 "usage: moveit_compare STATES SCENE TRAJECTORY [SCENE TRAJECTORY ...]   STATES: at least %zu\n",
                 FEWEST);
    return 2;
  }
  ros::Time::init();
  ros::console::set_logger_level(ROSCONSOLE_ROOT_LOGGER_NAME,
                                 ros::console::levels::Error); // its other lines go to stdout
  ros::console::notifyLoggerLevelsChanged();
  const auto model = panda();
  std::printf("scene,query,method,cases,hits,differs,median_us,error\n");
  for (int i = 2; i + 1 < argc; i += 2) compare(model, argv[i], argv[i + 1], states);
  return 0;
}
