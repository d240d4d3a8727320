/* SPDX-License-Identifier: BSD-3-Clause */
/* Edges of roadmaps, by several threads. */
#include <curve_proximity/roadmap.hpp>

#include "robots.h"

namespace curve_proximity::python {
namespace {

using Ends = std::vector<std::array<std::uint32_t, 2>>;

Ends endsOf(const py::object &given) {
  const Whole edges = toWhole(given, "edges", 0, std::numeric_limits<std::uint32_t>::max());
  if (edges.ndim() != 2 || edges.shape(1) != 2) throw Error("edges must be an array of shape (m, 2): rows of vertices");
  Ends out;
  out.reserve(static_cast<std::size_t>(edges.shape(0)));
  for (py::ssize_t i = 0; i < edges.shape(0); ++i)
    out.push_back({static_cast<std::uint32_t>(edges.at(i, 0)), static_cast<std::uint32_t>(edges.at(i, 1))});
  return out;
}

void checkRows(const Array &rows, const char *what, const std::vector<std::string> &joints) {
  if (rows.ndim() != 2) throw Error(what + std::string(" must be an array of shape (n, joints): one row a posture"));
  if (static_cast<std::size_t>(rows.shape(1)) != joints.size())
    throw Error(what + std::string(" have ") + std::to_string(rows.shape(1)) + " columns, there are " +
                std::to_string(joints.size()) + " joints");
}

py::array_t<std::int8_t> edgeVerdictsOf(const PythonScene &scene, const std::vector<std::string> &joints,
                                        const Array &vertices, const py::object &edges, double delta, bool self,
                                        const py::object &known, const JointPositions &rest,
                                        const std::optional<Array> &base, double epsilon, Count max_nodes,
                                        unsigned threads, bool allow_empty, bool shortest_way, bool whole,
                                        const std::optional<Array> &to) {
  if (!scene.robot()) throw Error("the scene has no robot");
  checkRows(vertices, "vertices", joints);
  if (to) checkRows(*to, "to", joints);
  if (to ? !edges.is_none() || to->shape(0) != vertices.shape(0) : edges.is_none())
    throw Error("edges are rows of vertices, or None where `to` has a row for each of them");
  const Ends ends = to ? Ends() : endsOf(edges);
  EdgeList list;
  list.joints = joints, list.rest = scene.rest(rest), list.shortest_way = shortest_way;
  list.from = vertices.data(), list.to = to ? to->data() : list.from;
  list.n = list.n_rows = static_cast<std::size_t>(vertices.shape(0));
  if (!to) list.ends = ends.data(), list.n = ends.size();
  std::vector<cprox_verdict> before;
  if (!known.is_none()) {
    const Whole verdicts = toWhole(known, "known", CPROX_VERDICT_CLEAR, CPROX_VERDICT_UNDECIDED);
    for (py::ssize_t i = 0; i < verdicts.size(); ++i) before.push_back(static_cast<cprox_verdict>(verdicts.data()[i]));
  }
  const Eigen::Isometry3d at = base ? toTransform(base) : scene.base();
  Query query = queryOf("tolerance", delta, epsilon, max_nodes, {}, {}, allow_empty);
  query.options.stop = nullptr; // one thread alone would be interrupted
  std::vector<cprox_verdict> found;
  {
    const py::gil_scoped_release release;
    Pool pool(threads);
    const PreparedRobot robot(scene.snapshot(), scene.robot()->srdf.disabled, {}, {}, at);
    const RobotPairs against = whole ? RobotPairs::WHOLE : self ? RobotPairs::SELF : RobotPairs::ENVIRONMENT;
    found = edgeVerdicts(robot, list, against, query, before, pool);
  }
  warn("edge_verdicts", longWays(*scene.robot()->robot, list));
  py::array_t<std::int8_t> out(static_cast<py::ssize_t>(found.size()));
  for (std::size_t i = 0; i < found.size(); ++i) out.mutable_data()[i] = static_cast<std::int8_t>(found[i]);
  return out;
}

} // namespace

void addRoadmaps(py::module &module) {
  module.def(
      "edge_verdicts", &edgeVerdictsOf, py::arg("scene"), py::arg("joints"), py::arg("vertices"), py::arg("edges"),
      py::arg("delta"), py::arg("self_collision") = false, py::arg("known") = py::none(),
      py::arg("rest") = JointPositions{}, py::arg("base") = py::none(), py::arg("epsilon") = 1e-6,
      py::arg("max_nodes") = DEFAULT_BUDGET, py::arg("threads") = 0, py::arg("allow_empty") = false,
      py::arg("shortest_way") = false, py::arg("whole") = false, py::arg("to") = py::none(),
      "Straight motions between postures, the edges of a roadmap: is the robot farther than delta [m] "
      "everywhere?\n"
      "vertices (n, joints), edges (m, 2) of their rows; or edges None and to (n, joints): from row i to row i.\n"
      "known (m,): verdicts of an earlier call; those that are "
      "not 0\n"
      "stand. With self_collision it is asked from itself alone, with whole from the objects and itself.\n"
      "shortest_way: continuous joints turn the shorter way along an edge. Returns int8 (m,): 0 clear, 1 "
      "violated, 2 undecided. All threads work (0: one a processor).");
}

} // namespace curve_proximity::python
