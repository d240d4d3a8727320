/* SPDX-License-Identifier: BSD-3-Clause */
/* Robots and objects that move on one clock. Queries release the GIL. */
#include <curve_proximity/movers.hpp>

#include "robots.h"

namespace curve_proximity::python {
namespace {

/* Motions by name and the objects of a scene that move, on one clock. */
class PythonMovers {
 public:
  PythonMovers(const PythonScene &scene, const std::map<std::string, std::shared_ptr<RobotMotion>> &motions,
               const std::map<std::string, double> &starts) {
    std::vector<MovingRobot> robots;
    for (const auto &[name, motion] : motions) {
      if (!motion) throw Error("'" + name + "' has no motion");
      const auto start = starts.find(name);
      robots.push_back({name, motion, start == starts.end() ? 0.0 : start->second, 0.0});
      robots_[name] = robots.back();
    }
    for (const auto &entry : starts)
      if (motions.count(entry.first) == 0) throw Error("starts name '" + entry.first + "', which is no motion");
    const SnapshotPtr snapshot = scene.snapshot();
    const py::gil_scoped_release release;
    movers_ = std::make_unique<const Movers>(snapshot, robots, movingObjects(*snapshot));
  }

  std::array<double, 2> domain() const {
    return movers_->domain();
  }

  /* robot '': of all that moves. */
  py::dict ask(const std::string &robot, const Query &query) const {
    const MovingRobot *one = robot.empty() ? nullptr : &find(robot);
    Answer answer;
    {
      const py::gil_scoped_release release;
      answer = one ? curve_proximity::ask(*movers_, *one, query, threadWorkspace())
                   : curve_proximity::ask(*movers_, Against::OTHERS, query, threadWorkspace());
    }
    return answerOf(answer);
  }

  py::dict gradient(const std::string &robot, double epsilon, std::uint32_t max_nodes, const Names &links,
                    const Names &objects) const {
    const MovingRobot &one = find(robot);
    ClearanceRow row;
    {
      const py::gil_scoped_release release;
      row = clearanceGradient(*movers_, one, queryOf("distance", 0.0, epsilon, max_nodes, links, objects),
                              threadWorkspace());
    }
    py::dict out = toDict(row);
    out["start"] = row.gradient.start;
    return out;
  }

 private:
  const MovingRobot &find(const std::string &robot) const {
    const auto found = robots_.find(robot);
    if (found == robots_.end()) throw Error("there is no motion '" + robot + "'");
    return found->second;
  }

  std::map<std::string, MovingRobot> robots_;
  std::unique_ptr<const Movers> movers_;
};

} // namespace

void addMovers(py::module &module) {
  py::class_<PythonMovers, std::shared_ptr<PythonMovers>>(
      module, "Movers",
      "Motions of robots, and the objects of a scene that move, on one clock: against each other and what stands.\n"
      "robot of its queries: the name of the motion that is asked about, at its times; '': all that moves.\n"
      "links: of that robot alone, or of all 'name/link'. objects: names of objects or robots.\n"
      "No robot is measured against itself.")
      .def(py::init<const PythonScene &, const std::map<std::string, std::shared_ptr<RobotMotion>> &,
                    const std::map<std::string, double> &>(),
           py::arg("scene"), py::arg("motions"), py::arg("starts") = std::map<std::string, double>{},
           "motions: Motion by name, each of a scene whose robot, paddings and allowed pairs count alone.\n"
           "starts: [s] by name, added to the times of the motion; others 0.")
      .def_property_readonly("domain", &PythonMovers::domain, "[s] The first start and the last end.")
      .def(
          "distance",
          [](const PythonMovers &m, const std::string &robot, double epsilon, std::uint32_t max_nodes,
             const Names &links, const Names &objects) {
            return m.ask(robot, queryOf("distance", 0.0, epsilon, max_nodes, links, objects));
          },
          py::arg("robot") = "", py::arg("epsilon") = 1e-6, py::arg("max_nodes") = 20000, py::arg("links") = Names{},
          py::arg("objects") = Names{}, "The least distance: the dict of Motion.distance().")
      .def(
          "tolerance",
          [](const PythonMovers &m, double delta, const std::string &robot, double epsilon, std::uint32_t max_nodes,
             const Names &links, const Names &objects) {
            return m.ask(robot, queryOf("tolerance", delta, epsilon, max_nodes, links, objects));
          },
          py::arg("delta"), py::arg("robot") = "", py::arg("epsilon") = 1e-6, py::arg("max_nodes") = 20000,
          py::arg("links") = Names{}, py::arg("objects") = Names{},
          "Are they farther apart than delta [m] at all times?")
      .def("gradient", &PythonMovers::gradient, py::arg("robot"), py::arg("epsilon") = 1e-6,
           py::arg("max_nodes") = 20000, py::arg("links") = Names{}, py::arg("objects") = Names{},
           "The least distance of one of the motions and its derivatives by that motion: the dict of\n"
           "Motion.gradient() with start, by when it begins. What else moves goes on as it does.");
}

} // namespace curve_proximity::python
