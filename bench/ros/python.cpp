/* SPDX-License-Identifier: BSD-3-Clause */
/* What the Python package adds to the core's calls: the same question asked from C++ and from a loop in Python, in
 * turns, in one process. The loop itself counts.
 *
 * Workloads named "... adds" have the difference for their time. */
#include <pybind11/embed.h>
#include <pybind11/numpy.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <curve_proximity/core.hpp>

#include "added.h"
extern "C" {
#include "support/robot_case.h"
}

namespace py = pybind11;
using namespace curve_proximity;

namespace {

/* So many calls of one question. */
using Calls = std::function<void(int)>;

void measure(const std::string &question, int rounds, const Calls &core, const Calls &python) {
  constexpr int CALLS = 1000;
  std::vector<double> by_core, by_python, added;
  for (int round = 0; round < rounds; ++round) {
    const double begin = now();
    core(CALLS);
    const double between = now();
    python(CALLS);
    by_core.push_back((between - begin) / CALLS);
    by_python.push_back((now() - between) / CALLS);
    added.push_back(by_python.back() - by_core.back());
  }
  printRow("python", question, "curve_proximity", by_python);
  printRow("python", question, "core", by_core);
  printRow("python", question + " adds", "curve_proximity", added);
}

/* The same robot, scene and edges in both languages. */
struct Edges {
  static constexpr std::size_t N = 100000;
  robot_case scene{}, model{};
  cprox_obstacles *obstacles = nullptr;
  cprox_edge_checker *checker = nullptr;
  std::vector<double> from, to;
  std::vector<std::uint8_t> verdicts = std::vector<std::uint8_t>(N);
  Workspace workspace;

  Edges() {
    std::size_t n = 0;
    FILE *f = std::fopen(BENCH_DATA_DIR "/motion/cases.txt", "r");
    if (!f || std::fscanf(f, "%zu", &n) != 1 || !robot_case_read(f, BENCH_DATA_DIR "/motion", &scene) ||
        !robot_case_read_robot(BENCH_DATA_DIR "/motion", "panda_spheres", &model))
      std::abort();
    std::fclose(f);
    cprox_obstacles_create(scene.targets, scene.n_targets, CPROX_INDEX_NONE, workspace.get(), &obstacles);
    cprox_edge_query asked{};
    asked.obstacles = obstacles, asked.self_pairs = model.self_pairs, asked.n_self_pairs = model.n_self_pairs;
    if (cprox_edge_checker_create(model.robot, &asked, workspace.get(), &checker) != CPROX_OK) std::abort();
    std::mt19937_64 engine(9);
    std::uniform_real_distribution<double> at(-2.5, 2.5), way(-0.7, 0.7);
    from.resize(N * model.n_variables), to.resize(from.size());
    for (std::size_t i = 0; i < from.size(); ++i) from[i] = at(engine), to[i] = from[i] + way(engine);
  }
  ~Edges() {
    cprox_edge_checker_free(checker);
    cprox_obstacles_free(obstacles);
    robot_case_free(&model);
    robot_case_free(&scene);
  }
  Edges(const Edges &) = delete;
  Edges &operator=(const Edges &) = delete;
};

constexpr const char *EDGES_SCRIPT = R"(
import numpy
robot = cprox.Robot.from_urdf(folder + '/robots/panda_spheres/panda_spheres.urdf', srdf=folder + '/robots/panda/panda.srdf')
scene = cprox.Scene(robot)
scene.load(folder + '/scenes/mbm/bookshelf_small_panda/scene0001.yaml')
joints = ['panda_joint%d' % i for i in range(1, 8)]
def edges():
    return cprox.edges(scene, joints, start, end, threads=1)
)";

/* A hundred thousand edges in one call. What is wrong is what differs from the core's verdict. */
void manyEdges(int rounds) {
  Edges given;
  const auto array = [&](const std::vector<double> &values) {
    const auto columns = static_cast<py::ssize_t>(given.model.n_variables);
    return py::array_t<double>({static_cast<py::ssize_t>(Edges::N), columns}, values.data());
  };
  py::globals()["folder"] = BENCH_DATA_DIR;
  py::globals()["start"] = array(given.from);
  py::globals()["end"] = array(given.to);
  py::exec(EDGES_SCRIPT);
  std::vector<double> by_core, by_python;
  std::size_t wrong = 0;
  for (int round = 0; round < rounds; ++round) {
    const double begin = now();
    cprox_robot_edges(given.checker, given.from.data(), given.to.data(), Edges::N, given.workspace.get(),
                      given.verdicts.data(), nullptr);
    const double between = now();
    const py::array_t<std::uint8_t> found = py::globals()["edges"]();
    by_core.push_back(between - begin);
    by_python.push_back(now() - between);
    for (std::size_t i = 0; i < Edges::N; ++i) wrong += found.data()[i] != given.verdicts[i];
  }
  for (const auto &[method, times] : {std::pair("curve_proximity", by_python), std::pair("core", by_core)})
    std::printf("python,100000 edges,%s,,%.6g,%.6g,0,0,0,%zu,0\n", method, quantile(times, 0.5), quantile(times, 0.95),
                wrong);
}

/* The same curve, ball and obstacle in both languages. */
constexpr const char *SCRIPT = R"(
import cprox
mover = cprox.tube(cprox.bezier([[-1, 0, 0], [0, 1, 0], [1, 0, 0]]), 0.2)
ball = cprox.Obstacle(cprox.sphere(0.1), cprox.transform([0.3, 2, 0]))
def tolerance(n):
    for _ in range(n):
        cprox.tolerance(mover, ball, 0.1)
def distance(n):
    for _ in range(n):
        cprox.distance(mover, ball)
)";

} // namespace

int main(int argc, char **argv) {
  const bool quick = argc > 1 && std::strcmp(argv[1], "--quick") == 0;
  const int rounds = quick ? 50 : 500;
  const py::scoped_interpreter interpreter;
  py::exec(SCRIPT);
  const auto from = [](const char *name) { return [function = py::globals()[name]](int n) { function(n); }; };

  Eigen::Matrix3Xd points(3, 3);
  points << -1, 0, 1, 0, 1, 0, 0, 0, 0;
  const CurveHandle curve = makeBezier(points);
  const BodyHandle ball = makeSphere(0.1);
  const cprox_mover mover = along(curve, 0.2);
  const cprox_obstacle obstacle =
      cprox_obstacle_at(ball.get(), toPose(Eigen::Isometry3d(Eigen::Translation3d(0.3, 2, 0))));
  const cprox_options options = CPROX_OPTIONS_DEFAULT;
  Workspace workspace;
  measure(
      "tolerance", rounds,
      [&](int n) {
        while (n-- > 0) tolerance(mover, obstacle, 0.1, options, workspace);
      },
      from("tolerance"));
  measure(
      "distance", rounds,
      [&](int n) {
        while (n-- > 0) distance(mover, obstacle, options, workspace);
      },
      from("distance"));
  manyEdges(quick ? 3 : 15);
  return 0;
}
