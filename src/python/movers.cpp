/* SPDX-License-Identifier: BSD-3-Clause */
/* Robots and objects that move on one clock. Queries release the GIL. */
#include <curve_proximity/movers.hpp>

#include "robots.h"

namespace curve_proximity::python {
namespace {

using Motions = std::map<std::string, std::shared_ptr<RobotMotion>>;
using Numbers = std::map<std::string, double>;
using NamePairs = std::vector<std::array<std::string, 2>>;

/* A number of each motion, for those that `numbers` names. */
double numberOf(const Numbers &numbers, const std::string &name) {
  const auto found = numbers.find(name);
  return found == numbers.end() ? 0.0 : found->second;
}

void requireMotions(const Numbers &numbers, const Motions &motions, const std::string &what) {
  for (const auto &entry : numbers)
    if (motions.count(entry.first) == 0) throw Error(what + " name '" + entry.first + "', which is no motion");
}

Against againstOf(const std::string &name) {
  const std::map<std::string, Against> known = {
      {"others", Against::OTHERS}, {"objects", Against::OBJECTS}, {"movers", Against::MOVERS}, {"both", Against::BOTH}};
  const auto found = known.find(name);
  if (found == known.end()) throw Error("against must be 'others', 'objects', 'movers' or 'both', got '" + name + "'");
  return found->second;
}

/* Motions by name and the objects of a scene that move, on one clock. */
class PythonMovers {
 public:
  PythonMovers(const PythonScene &scene, const Motions &motions, const Numbers &starts, const Numbers &tolerances,
               const NamePairs &allowed) {
    std::vector<MovingRobot> robots;
    for (const auto &[name, motion] : motions) {
      if (!motion) throw Error("'" + name + "' has no motion");
      robots.push_back({name, motion, numberOf(starts, name), numberOf(tolerances, name)});
      robots_[name] = robots.back();
    }
    requireMotions(starts, motions, "starts");
    requireMotions(tolerances, motions, "tolerances");
    const SnapshotPtr snapshot = scene.snapshot();
    movers_ = unlocked([&] {
      return std::make_unique<const Movers>(snapshot, robots, movingObjects(*snapshot), allowed, ResourceOptions{},
                                            [] { return interrupted(nullptr); });
    });
  }

  const Movers &get() const {
    return *movers_;
  }

  const MovingRobot &find(const std::string &robot) const {
    const auto found = robots_.find(robot);
    if (found == robots_.end()) throw Error("there is no motion '" + robot + "'");
    return found->second;
  }

  /* Calls a query of one of the robots; robot '': of all that moves. */
  template <typename Call>
  auto ask(const std::string &robot, const std::string &against, const Call &call) const {
    const Against pairs = againstOf(against);
    if (!robot.empty() && pairs != Against::OTHERS)
      throw Error("against does not apply to robot '" + robot + "': one robot is measured against all others");
    const MovingRobot *one = robot.empty() ? nullptr : &find(robot);
    return unlocked([&] { return one ? call(*one) : call(pairs); });
  }

  /* Of a query of one of the robots, or of all: how finely the ends of violations are searched. */
  double resolution(const std::string &robot) const {
    constexpr double PART = 1e-3;
    const bool own = !robot.empty() && !find(robot).motion->stands();
    const std::array<double, 2> domain = own ? find(robot).motion->domain() : movers_->domain();
    return PART * (domain[1] - domain[0]);
  }

 private:
  std::map<std::string, MovingRobot> robots_;
  std::unique_ptr<const Movers> movers_;
};

py::dict answer(const PythonMovers &m, const std::string &robot, const std::string &against, const Query &query) {
  return answerOf(m.ask(robot, against, [&](const auto &of) { return ask(m.get(), of, query, threadWorkspace()); }),
                  query.query_type != QueryType::DISTANCE);
}

py::dict contactOf(const PythonMovers &m, const std::string &robot, double epsilon, Count max_nodes, const Names &links,
                   const Names &objects, bool allow_empty, const std::string &against, bool moving_only) {
  const Query query = queryOf("collision", 0.0, epsilon, max_nodes, links, objects, allow_empty, moving_only);
  return answerOf(
      m.ask(robot, against, [&](const auto &of) { return timeOfContact(m.get(), of, query, threadWorkspace()); }),
      true);
}

py::dict profileOf(const PythonMovers &m, const std::vector<double> &breaks, const std::string &robot, double epsilon,
                   const Names &links, double horizon, const Names &objects, bool allow_empty,
                   const std::string &against, bool moving_only) {
  const Query query = queryOf("distance", 0.0, epsilon, DEFAULT_BUDGET, links, objects, allow_empty, moving_only);
  return toDict(m.ask(robot, against, [&](const auto &of) {
    return clearanceProfile(m.get(), of, breaks, query, threadWorkspace(), horizon);
  }));
}

py::list violationsOf(const PythonMovers &m, double delta, const std::string &robot, std::optional<double> resolution,
                      double epsilon, const Names &links, const Names &objects, bool allow_empty,
                      const std::string &against, bool moving_only) {
  const Query query = queryOf("tolerance", delta, epsilon, DEFAULT_BUDGET, links, objects, allow_empty, moving_only);
  const double fine = resolution.value_or(m.resolution(robot));
  return toList(
      m.ask(robot, against, [&](const auto &of) { return violations(m.get(), of, fine, query, threadWorkspace()); }));
}

py::list pairsOf(const PythonMovers &m, std::size_t k, const std::string &robot, double within, double epsilon,
                 const Names &links, const Names &objects, bool allow_empty, const std::string &against,
                 bool moving_only) {
  const Query query = queryOf("distance", 0.0, epsilon, DEFAULT_BUDGET, links, objects, allow_empty, moving_only);
  return toList(m.ask(robot, against, [&](const auto &of) {
    return nearestPairs(m.get(), of, {k, within}, query, threadWorkspace());
  }));
}

py::dict gradientOf(const PythonMovers &m, const std::string &robot, double epsilon, Count max_nodes,
                    const Names &links, const Names &objects, bool allow_empty, bool moving_only) {
  const MovingRobot &one = m.find(robot);
  const ClearanceRow row = unlocked([&] {
    return clearanceGradient(m.get(), one,
                             queryOf("distance", 0.0, epsilon, max_nodes, links, objects, allow_empty, moving_only),
                             threadWorkspace());
  });
  py::dict out = toDict(row);
  out["start"] = row.gradient.start;
  return out;
}

py::dict gradientsOf(const PythonMovers &m, double epsilon, Count max_nodes, const Names &links, const Names &objects,
                     bool allow_empty, const std::string &against, bool moving_only) {
  const Query query = queryOf("distance", 0.0, epsilon, max_nodes, links, objects, allow_empty, moving_only);
  const Against pairs = againstOf(against);
  const MoversClearance found = unlocked([&] { return clearanceGradients(m.get(), pairs, query, threadWorkspace()); });
  py::dict out = answerOf(found.answer), gradients;
  addValidity(found.gradients.front().gradient, out);
  for (const MoverGradient &by : found.gradients) {
    py::dict one;
    addDerivatives(by.gradient, one);
    one["start"] = by.gradient.start;
    gradients[py::str(by.name)] = one;
  }
  out["gradients"] = gradients;
  return out;
}

} // namespace

void addMovers(py::module &module) {
  py::class_<PythonMovers, std::shared_ptr<PythonMovers>> movers(
      module, "Movers",
      "Motions of robots, and the objects of a scene that move, on one clock: against each other and what stands.\n"
      "robot of its queries: the name of the motion that is asked about, at its times; '': all that moves.\n"
      "links: of that robot alone, or of all 'name/link'. objects: names of objects or robots.\n"
      "against, where robot is '': 'others', all but no robot against itself; 'both', all; 'movers', each other and "
      "each\n"
      "robot against itself; 'objects', the objects that stand.");
  refusePickle(movers, "Movers cannot be pickled: make them again in the other process");
  movers
      .def(
          py::init<const PythonScene &, const Motions &, const Numbers &, const Numbers &, const NamePairs &>(),
          py::arg("scene"), py::arg("motions"), py::arg("starts") = Numbers{}, py::arg("tolerances") = Numbers{},
          py::arg("allowed") = NamePairs{},
          "motions: Motion by name, each of a scene whose robot, paddings and allowed pairs count alone.\n"
          "starts: [s] by name, added to the times of the motion; others 0.\n"
          "tolerances: [s] by name: the start is only known to within this, before or after; inf: anywhere on its way\n"
          "at any time. Answers hold for all starts that are possible.\n"
          "allowed: pairs of names that may touch: motions, links 'name/link', objects.")
      .def_property_readonly(
          "domain", [](const PythonMovers &m) { return m.get().domain(); }, "[s] The first start and the last end.")
      .def(
          "object_pose",
          [](const PythonMovers &m, const std::string &name, double t) {
            return fromTransform(m.get().objectPose(name, t));
          },
          py::arg("name"), py::arg("t"), "The pose (4, 4) of an object that moves at the time t [s] of the clock.")
      .def(
          "distance",
          [](const PythonMovers &m, const std::string &robot, double epsilon, Count max_nodes, const Names &links,
             const Names &objects, bool allow_empty, const std::string &against, bool moving_only) {
            return answer(m, robot, against,
                          queryOf("distance", 0.0, epsilon, max_nodes, links, objects, allow_empty, moving_only));
          },
          py::arg("robot") = "", py::arg("epsilon") = 1e-6, py::arg("max_nodes") = DEFAULT_BUDGET,
          py::arg("links") = Names{}, py::arg("objects") = Names{}, py::arg("allow_empty") = false,
          py::arg("against") = "others", py::arg("moving_only") = false,
          "The least distance: the dict of Motion.distance().")
      .def(
          "tolerance",
          [](const PythonMovers &m, double delta, const std::string &robot, double epsilon, Count max_nodes,
             const Names &links, const Names &objects, bool allow_empty, const std::string &against, bool moving_only) {
            return answer(m, robot, against,
                          queryOf("tolerance", delta, epsilon, max_nodes, links, objects, allow_empty, moving_only));
          },
          py::arg("delta"), py::arg("robot") = "", py::arg("epsilon") = 1e-6, py::arg("max_nodes") = DEFAULT_BUDGET,
          py::arg("links") = Names{}, py::arg("objects") = Names{}, py::arg("allow_empty") = false,
          py::arg("against") = "others", py::arg("moving_only") = false,
          "Are they farther apart than delta [m] at all times?")
      .def(
          "collision",
          [](const PythonMovers &m, const std::string &robot, double epsilon, Count max_nodes, const Names &links,
             const Names &objects, bool allow_empty, const std::string &against, bool moving_only) {
            return answer(m, robot, against,
                          queryOf("collision", 0.0, epsilon, max_nodes, links, objects, allow_empty, moving_only));
          },
          py::arg("robot") = "", py::arg("epsilon") = 1e-6, py::arg("max_nodes") = DEFAULT_BUDGET,
          py::arg("links") = Names{}, py::arg("objects") = Names{}, py::arg("allow_empty") = false,
          py::arg("against") = "others", py::arg("moving_only") = false, "Do they touch or overlap at any time?")
      .def("time_of_contact", &contactOf, py::arg("robot") = "", py::arg("epsilon") = 1e-6,
           py::arg("max_nodes") = DEFAULT_BUDGET, py::arg("links") = Names{}, py::arg("objects") = Names{},
           py::arg("allow_empty") = false, py::arg("against") = "others", py::arg("moving_only") = false,
           "When they first touch: in [t_contact_lower, t] of the result [s]. Never late.")
      .def("gradient", &gradientOf, py::arg("robot"), py::arg("epsilon") = 1e-6, py::arg("max_nodes") = DEFAULT_BUDGET,
           py::arg("links") = Names{}, py::arg("objects") = Names{}, py::arg("allow_empty") = false,
           py::arg("moving_only") = false,
           "The least distance of one of the motions and its derivatives by that motion: the dict of\n"
           "Motion.gradient() with start, by when it begins. What else moves goes on as it does.")
      .def("gradients", &gradientsOf, py::arg("epsilon") = 1e-6, py::arg("max_nodes") = DEFAULT_BUDGET,
           py::arg("links") = Names{}, py::arg("objects") = Names{}, py::arg("allow_empty") = false,
           py::arg("against") = "others", py::arg("moving_only") = false,
           "The least distance of all that moves and its derivatives by every motion, by one search: the dict of\n"
           "distance() with valid, reason, t, and gradients: of each motion, then of each object that moves, by its "
           "name a\n"
           "dict of positions, velocities, accelerations, duration, base_linear, base_angular, object_linear,\n"
           "object_angular and start as gradient() has them. All are 0 for what is not of the nearest pair; the first "
           "three\n"
           "None for objects. Costs what gradient() costs.")
      .def("violations", &violationsOf, py::arg("delta"), py::arg("robot") = "", py::arg("resolution") = py::none(),
           py::arg("epsilon") = 1e-6, py::arg("links") = Names{}, py::arg("objects") = Names{},
           py::arg("allow_empty") = false, py::arg("against") = "others", py::arg("moving_only") = false,
           "All intervals of time within delta [m]: the list of Motion.violations(). resolution [s]: a thousandth of\n"
           "the motion, or of all, if None.")
      .def("profile", &profileOf, py::arg("breaks"), py::arg("robot") = "", py::arg("epsilon") = 1e-6,
           py::arg("links") = Names{}, py::arg("horizon") = std::numeric_limits<double>::infinity(),
           py::arg("objects") = Names{}, py::arg("allow_empty") = false, py::arg("against") = "others",
           py::arg("moving_only") = false,
           "The clearance between each two of breaks (n + 1,) [s], within domain: the dict of Motion.profile().")
      .def("nearest_pairs", &pairsOf, py::arg("k") = 10, py::arg("robot") = "",
           py::arg("within") = std::numeric_limits<double>::infinity(), py::arg("epsilon") = 1e-6,
           py::arg("links") = Names{}, py::arg("objects") = Names{}, py::arg("allow_empty") = false,
           py::arg("against") = "others", py::arg("moving_only") = false,
           "The k pairs that come closest, nearest first; each as distance() gives it.");
}

} // namespace curve_proximity::python
