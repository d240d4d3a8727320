/* SPDX-License-Identifier: BSD-3-Clause */
/* Robots as they are: bounds of their errors, persons who may come, objects that may be moved. */
#include <set>

#include <curve_proximity/margins.hpp>
#include <curve_proximity/robust.hpp>
#include <curve_proximity/separation.hpp>

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

} // namespace

void addRobust(MotionClass &motion) {
  motion
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
