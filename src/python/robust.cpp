/* SPDX-License-Identifier: BSD-3-Clause */
/* Robots as they are: bounds of their errors, persons who may come, objects that may be moved, where a robot has been,
 * which of its links can touch. */
#include <algorithm>
#include <set>

#include <curve_proximity/collision_matrix.hpp>
#include <curve_proximity/margins.hpp>
#include <curve_proximity/robust.hpp>
#include <curve_proximity/separation.hpp>
#include <curve_proximity/swept_volume.hpp>

#include "robots.h"

namespace curve_proximity::python {
namespace {

/* A dict by names; done() refuses what was not asked for. */
class Fields {
 public:
  Fields(const py::dict &fields, std::string what) : fields_(fields), what_(std::move(what)) {}

  double number(const char *name, std::optional<double> without = 0.0) {
    known_.insert(name);
    if (!fields_.contains(name) && !without) throw Error(what_ + " has no '" + name + "'");
    return fields_.contains(name) ? fields_[name].cast<double>() : *without;
  }

  bool has(const char *name) {
    known_.insert(name);
    return fields_.contains(name);
  }

  py::dict dict(const char *name) {
    return has(name) ? fields_[name].cast<py::dict>() : py::dict();
  }

  void done() const {
    for (const auto &[name, value] : fields_)
      if (known_.count(name.cast<std::string>()) == 0)
        throw Error(what_ + " has no '" + name.cast<std::string>() + "'");
  }

 private:
  const py::dict fields_;
  const std::string what_;
  std::set<std::string> known_;
};

JointErrors jointErrorsOf(const py::dict &given, const std::string &what) {
  Fields fields(given, what);
  const JointErrors out{fields.number("tracking"), fields.number("speed"), fields.number("acceleration")};
  fields.done();
  return out;
}

void readPlace(const py::dict &given, const std::string &what, double &position, double &rotation) {
  Fields fields(given, what);
  position = fields.number("position"), rotation = fields.number("rotation");
  fields.done();
}

ErrorBounds boundsOf(const py::dict &given) {
  Fields fields(given, "errors");
  ErrorBounds out;
  out.every_joint = jointErrorsOf(fields.dict("every_joint"), "every_joint");
  for (const auto &[name, value] : fields.dict("joints"))
    out.joints[name.cast<std::string>()] = jointErrorsOf(value.cast<py::dict>(), "joints");
  readPlace(fields.dict("base"), "base", out.base_position, out.base_rotation);
  readPlace(fields.dict("objects"), "objects", out.object_position, out.object_rotation);
  out.timing = fields.number("timing"), out.sensor = fields.number("sensor"), out.flex = fields.number("flex");
  fields.done();
  return out;
}

Separation separationOf(const py::dict &given) {
  Fields fields(given, "separation");
  Fields person(fields.dict("person"), "person"), robot(fields.dict("robot"), "robot");
  Separation out;
  out.person_speed = person.number("speed", std::nullopt), out.person_position = person.number("position");
  out.reaction_time = robot.number("reaction_time", std::nullopt);
  out.stopping_time = robot.number("stopping_time", std::nullopt);
  out.robot_position = robot.number("position");
  if (robot.has("speed")) out.robot_speed = robot.number("speed");
  out.intrusion = fields.number("intrusion");
  person.done(), robot.done(), fields.done();
  return out;
}

py::dict robustOf(const RobotMotion &motion, const py::dict &errors, double delta, bool self, double epsilon,
                  Count max_nodes, const Names &links, const Names &objects, bool allow_empty) {
  const ErrorBounds bounds = boundsOf(errors);
  const Query query = queryOf("tolerance", delta, epsilon, max_nodes, links, objects, allow_empty, false);
  const RobustAnswer found = unlocked([&] { return askRobust(motion, self, bounds, query, threadWorkspace()); });
  py::dict out = answerOf(found.answer, true);
  out["certified_scale"] = found.certified, out["refused_scale"] = found.refused;
  return out;
}

py::dict robustProfileOf(const RobotMotion &motion, const std::vector<double> &breaks, const py::dict &errors,
                         bool self, double epsilon, const Names &links, const Names &objects, bool allow_empty) {
  const ErrorBounds bounds = boundsOf(errors);
  const Query query = queryOf("distance", 0.0, epsilon, DEFAULT_BUDGET, links, objects, allow_empty, false);
  return toDict(unlocked([&] { return robustProfile(motion, self, bounds, breaks, query, threadWorkspace()); }));
}

py::dict speedLimitsOf(const RobotMotion &motion, const py::dict &separation, const Names &objects,
                       std::size_t intervals, double epsilon, const Names &links) {
  if (objects.empty()) throw Error("objects is empty: it names the objects in which persons may be");
  if (intervals == 0) throw Error("intervals must be above 0");
  const Separation constants = separationOf(separation);
  const Query query = queryOf("distance", 0.0, epsilon, DEFAULT_BUDGET, links, objects, false, false);
  const SpeedLimits found =
      unlocked([&] { return speedLimits(motion, intervals, constants, query, threadWorkspace()); });
  const auto n = static_cast<py::ssize_t>(found.overrides.size());
  Array t0(n), t1(n), lower(n), limit(n);
  for (py::ssize_t i = 0; i < n; ++i) {
    const ClearanceInterval &interval = found.profile[static_cast<std::size_t>(i)];
    t0.mutable_data()[i] = interval.t0, t1.mutable_data()[i] = interval.t1;
    lower.mutable_data()[i] = interval.lower;
    limit.mutable_data()[i] = found.overrides[static_cast<std::size_t>(i)];
  }
  py::dict out;
  out["t0"] = t0, out["t1"] = t1, out["lower"] = lower, out["override"] = limit;
  out["constant_override"] = found.constant, out["unwatched_override"] = found.unwatched;
  return out;
}

py::list marginsOf(const RobotMotion &motion, double within, double delta, double epsilon, const Names &links,
                   const Names &objects) {
  const Query query = queryOf("tolerance", delta, epsilon, DEFAULT_BUDGET, links, objects, false, false);
  const std::vector<ObjectMargin> rows =
      unlocked([&] { return objectMargins(motion, within, query, threadWorkspace()); });
  py::list out;
  for (const ObjectMargin &row : rows) {
    py::dict one;
    one["object"] = row.object, one["direction"] = row.direction, one["toward"] = fromVector(toVec3(row.toward));
    one["free"] = row.free, one["blocked"] = row.blocked, one["t"] = row.t, one["a"] = row.a;
    one["gap"] = row.gap ? gapName(*row.gap) : "";
    out.append(one);
  }
  return out;
}

SweptVolume sweepOf(const RobotMotion &motion, double resolution, bool inside, const Names &links, unsigned threads) {
  SweepOptions options;
  options.resolution = resolution, options.inside = inside, options.links = links, options.threads = threads;
  options.stop = interrupted;
  return unlocked([&] { return sweptVolume(motion, options); });
}

py::array_t<std::int32_t> cellsOf(const SweptVolume &volume) {
  const auto n = static_cast<py::ssize_t>(volume.cells.size());
  py::array_t<std::int32_t> out({n, py::ssize_t{3}});
  auto cells = out.mutable_unchecked<2>();
  for (py::ssize_t i = 0; i < n; ++i)
    for (py::ssize_t k = 0; k < 3; ++k)
      cells(i, k) = volume.cells[static_cast<std::size_t>(i)][static_cast<std::size_t>(k)];
  return out;
}

py::array_t<bool> insideOf(const SweptVolume &volume) {
  py::array_t<bool> out(static_cast<py::ssize_t>(volume.inside.size()));
  std::copy(volume.inside.begin(), volume.inside.end(), out.mutable_data());
  return out;
}

py::list matrixOf(const LoadedRobot &robot, double epsilon, Count max_nodes, const Names &links) {
  const Scene scene(robot.robot);
  const CollisionMatrix matrix(scene.snapshot());
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.epsilon = epsilon, options.max_nodes = max_nodes, options.stop = interrupted;
  const auto isAsked = [&](const std::string &link) {
    return links.empty() || std::find(links.begin(), links.end(), link) != links.end();
  };
  for (const std::string &link : links)
    if (robot.robot->links().count(link) == 0) throw Error("the robot has no link '" + link + "'");
  py::list out;
  for (std::size_t i = 0; i < matrix.pairs().size(); ++i) {
    if (!isAsked(matrix.pairs()[i][0]) && !isAsked(matrix.pairs()[i][1])) continue;
    const LinkContact found = unlocked([&] { return matrix.ask(i, options, threadWorkspace()); });
    py::dict row;
    row["a"] = found.a, row["b"] = found.b, row["contact"] = contactName(found), row["adjacent"] = found.adjacent;
    row["lower"] = found.result.lower, row["upper"] = found.result.upper, row["posture"] = py::cast(found.posture);
    row["nodes"] = found.result.nodes, row["message"] = found.message;
    out.append(row);
  }
  return out;
}

py::bytes stlOf(const SweptVolume &volume, bool inside_only) {
  return toStl(volume, inside_only);
}

py::bytes octomapOf(const SweptVolume &volume, bool inside_only) {
  return toOctomap(volume, inside_only);
}

} // namespace

void addMatrix(RobotClass &robot) {
  robot.def("collision_matrix", &matrixOf, py::arg("epsilon") = 1e-6, py::arg("max_nodes") = DEFAULT_BUDGET,
            py::arg("links") = Names{},
            "Which links can touch for some joint values within the limits: a dict for each pair of a, b, contact\n"
            "('never', 'always', 'possible' or 'undecided'), adjacent, lower, upper, posture (where their distance is\n"
            "upper), nodes, message. links: only pairs with one of these.");
}

void addRobust(py::module &module, MotionClass &motion) {
  py::class_<SweptVolume>(module, "SweptVolume", "Cells of a grid over what a robot passes through.")
      .def_readonly("resolution", &SweptVolume::resolution, "[m] edge of a cell.")
      .def_readonly("gap", &SweptVolume::gap, "[m] every point of a cell is so near what the robot passes through.")
      .def_property_readonly("cells", &cellsOf,
                             "(n, 3) whole numbers: a cell reaches from them to 1 more, times the resolution, in the\n"
                             "fixed frame. The robot touches no other cell at any time.")
      .def_property_readonly("inside", &insideOf, "(n,): does the robot fill the cell at one time, where asked?")
      .def("to_stl", &stlOf, py::arg("inside_only") = false, "The closed surface of the cells: bytes of a binary STL.")
      .def("to_octomap", &octomapOf, py::arg("inside_only") = false, "The cells as an octree: bytes of a .bt file.");
  motion
      .def("sweep", &sweepOf, py::arg("resolution") = 0.01, py::arg("inside") = false, py::arg("links") = Names{},
           py::arg("threads") = 0,
           "The SweptVolume of the motion, of all links or of these, with what they carry. threads: 0 for all.")
      .def("robust", &robustOf, py::arg("errors"), py::arg("delta") = 0.0, py::arg("self_collision") = false,
           py::arg("epsilon") = 1e-6, py::arg("max_nodes") = DEFAULT_BUDGET, py::arg("links") = Names{},
           py::arg("objects") = Names{}, py::arg("allow_empty") = false,
           "Is every execution within bounds of its errors farther than delta [m]? The dict of tolerance() with\n"
           "certified_scale and refused_scale: by how much all bounds may grow. errors: a dict by the keys of\n"
           "ERRORS.yaml, every_joint, joints, timing, base, objects, sensor, flex.")
      .def("robust_profile", &robustProfileOf, py::arg("breaks"), py::arg("errors"), py::arg("self_collision") = false,
           py::arg("epsilon") = 1e-6, py::arg("links") = Names{}, py::arg("objects") = Names{},
           py::arg("allow_empty") = false,
           "profile() of all executions within bounds of their errors: lower is certified for each of them.")
      .def("speed_limits", &speedLimitsOf, py::arg("separation"), py::arg("objects"), py::arg("intervals") = 100,
           py::arg("epsilon") = 1e-6, py::arg("links") = Names{},
           "How fast the robot may go while persons in objects may walk up to it (speed and separation): arrays t0, "
           "t1,\n"
           "lower, override (n,); constant_override, unwatched_override. separation: a dict by the keys of\n"
           "SEPARATION.yaml, person, robot, intrusion.")
      .def(
          "margins", &marginsOf, py::arg("within") = 1.0, py::arg("delta") = 0.0, py::arg("epsilon") = 1e-6,
          py::arg("links") = Names{}, py::arg("objects") = Names{},
          "How far each object may be moved before the motion is no longer farther than delta [m] from it: a dict for\n"
          "each object and direction ('any', '+x', ...) of object, direction, toward (3,), free (certified), blocked\n"
          "(proven, or inf), t, a, gap.");
}

} // namespace curve_proximity::python
