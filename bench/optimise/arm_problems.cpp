/* SPDX-License-Identifier: BSD-3-Clause */
#include "arm_problems.h"

#include <random>

namespace curve_proximity {

const std::vector<std::string> kFamilies = {"bookshelf_small", "bookshelf_tall",  "bookshelf_thin", "box", "cage",
                                            "table_pick",      "table_under_pick"};

namespace {

const char *const kRequests[] = {"0001", "0017", "0042"};
constexpr int kScenes = sizeof kRequests / sizeof *kRequests;
constexpr double kStepOfEnds = 0.2; /* [rad] at most, by joint */
constexpr int kTries = 10000;

std::shared_ptr<const ArmScene> readArmScene(const std::string &family, const std::string &request) {
  const std::string data = BENCH_DATA_DIR, panda = data + "/robots/panda/panda";
  const auto out = std::make_shared<ArmScene>();
  out->srdf = parseSrdf(readText(panda + ".srdf"));
  out->snapshot =
      readScene(panda + ".urdf", out->srdf, data + "/scenes/mbm/" + family + "_panda/scene" + request + ".yaml");
  out->robot = std::make_unique<PreparedRobot>(out->snapshot, out->srdf.disabled);
  out->path = readPath(data + "/trajectories/panda_" + family + "_" + request + "_rrt.yaml", out->rest);
  return out;
}

/* Within its limits, and clear of everything? */
bool isClear(const ArmScene &scene, const std::vector<double> &positions, Workspace &workspace) {
  JointPositions state = scene.rest;
  for (std::size_t j = 0; j < positions.size(); ++j) state[scene.path.joints[j]] = positions[j];
  for (const Robot::Joint &joint : scene.snapshot->robot()->joints()) {
    const auto found = std::find(scene.path.joints.begin(), scene.path.joints.end(), joint.name);
    if (found == scene.path.joints.end()) continue;
    if (!(state[joint.name] >= joint.lower && state[joint.name] <= joint.upper)) return false;
  }
  const RobotMotion motion(*scene.robot, state);
  return askEnvironment(motion, {}, workspace).front().result.lower > kEndsClear &&
         askSelf(motion, {}, workspace).result.lower > kEndsClear;
}

/* A clear state near one; the same from every standard library. */
std::vector<double> clearNear(const ArmScene &scene, const std::vector<double> &given, bool as_it_is,
                              std::mt19937_64 &source, Workspace &workspace) {
  if (as_it_is && isClear(scene, given, workspace)) return given;
  for (int i = 0; i < kTries; ++i) {
    std::vector<double> out = given;
    for (double &value : out) value += kStepOfEnds * (std::ldexp(static_cast<double>(source() >> 11), -52) - 1.0);
    if (isClear(scene, out, workspace)) return out;
  }
  throw Error("no clear end of the motion was found");
}

/* The path with other ends: what lies between is moved by as much of both steps as its time says. */
TrajectoryDescription withEnds(TrajectoryDescription path, const std::vector<double> &first,
                               const std::vector<double> &last) {
  const TrajectoryPoint a = path.points.front(), b = path.points.back();
  for (TrajectoryPoint &point : path.points) {
    const double s = (point.time - a.time) / (b.time - a.time);
    for (std::size_t j = 0; j < first.size(); ++j)
      point.positions[j] += (1.0 - s) * (first[j] - a.positions[j]) + s * (last[j] - b.positions[j]);
  }
  return path;
}

} // namespace

std::vector<ArmProblem> arm_problems(const std::string &family, int n, std::uint64_t seed) {
  std::mt19937_64 source(seed);
  Workspace workspace;
  std::vector<std::shared_ptr<const ArmScene>> scenes;
  for (int i = 0; i < std::min(n, kScenes); ++i) scenes.push_back(readArmScene(family, kRequests[i]));
  std::vector<ArmProblem> out;
  for (int i = 0; i < n; ++i) {
    const std::shared_ptr<const ArmScene> &scene = scenes[i % kScenes];
    const bool straight = i / kScenes % 2 == 1, as_it_is = i < 2 * kScenes;
    const std::vector<TrajectoryPoint> &points = scene->path.points;
    const std::vector<double> first = clearNear(*scene, points.front().positions, as_it_is, source, workspace);
    const std::vector<double> last = clearNear(*scene, points.back().positions, as_it_is, source, workspace);
    TrajectoryDescription path = withEnds(scene->path, first, last);
    if (straight) path.points = {path.points.front(), path.points.back()};
    out.push_back({scene, controlsOf(path)});
  }
  return out;
}

} // namespace curve_proximity
