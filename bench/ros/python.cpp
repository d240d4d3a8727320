/* SPDX-License-Identifier: BSD-3-Clause */
/* What the Python package adds to the core's calls: the same question asked from C++ and from a loop in Python, in
 * turns, in one process. The loop itself counts.
 *
 * Workloads named "... adds" have the difference for their time. */
#include <pybind11/embed.h>

#include <cstring>
#include <functional>
#include <string>
#include <vector>

#include <curve_proximity/core.hpp>

#include "added.h"

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
  return 0;
}
