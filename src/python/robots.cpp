/* SPDX-License-Identifier: BSD-3-Clause */
/* Robots along joint trajectories. Queries release the GIL. */
#include <optional>

#include <curve_proximity/files.hpp>

#include "robots.h"

namespace curve_proximity::python {
namespace {

/* A matrix as an array (rows, columns); none: None. */
py::object fromMatrix(const Eigen::MatrixXd &matrix) {
  if (matrix.size() == 0) return py::none();
  Array out({matrix.rows(), matrix.cols()});
  for (Eigen::Index i = 0; i < matrix.rows(); ++i)
    for (Eigen::Index k = 0; k < matrix.cols(); ++k) out.mutable_at(i, k) = matrix(i, k);
  return out;
}

} // namespace

Query queryOf(const std::string &type, double delta, double epsilon, std::uint32_t max_nodes, const Names &links,
              const Names &objects, bool allow_empty, bool moving_only) {
  Query out;
  out.links = links, out.objects = objects, out.allow_empty = allow_empty, out.moving_only = moving_only;
  if (type == "tolerance")
    out.query_type = QueryType::TOLERANCE;
  else if (type == "collision")
    out.query_type = QueryType::COLLISION;
  else if (type != "distance")
    throw Error("there is no query '" + type + "'");
  out.delta = delta, out.options.epsilon = epsilon, out.options.max_nodes = max_nodes;
  out.options.stop = interrupted;
  return out;
}

py::dict answerOf(const Answer &answer, bool asked) {
  if (answer.result.status < 0) throw Error(answer.message, answer.result.status);
  py::dict out;
  out["result"] = Result{answer.result, asked}, out["kind"] = answer.kind, out["a"] = answer.a, out["b"] = answer.b;
  out["by_hull"] = answer.by_hull, out["message"] = answer.message, out["status"] = answer.status;
  return out;
}

py::dict provenAnswer(Query &query, const std::function<Answer(std::string &text)> &ask) {
  const std::unique_ptr<cprox_certificate, decltype(&cprox_certificate_free)> certificate(cprox_certificate_create(),
                                                                                          cprox_certificate_free);
  if (!certificate) throw std::bad_alloc();
  query.options.certificate = certificate.get();
  std::string text;
  const Answer answer = unlocked([&] { return ask(text); });
  py::dict out = answerOf(answer, query.query_type != QueryType::DISTANCE);
  if (!answer.unproven.empty()) throw Error("no certificate: " + answer.unproven);
  const cprox_certificate_info info = cprox_certificate_get_info(certificate.get());
  if (info.claim == CPROX_CLAIM_NONE) throw Error("no certificate: the answer is not decided");
  out["claim"] = info.claim == CPROX_CLAIM_APART ? "apart" : "near";
  out["record"] = py::bytes(static_cast<const char *>(info.bytes), info.size);
  out["query"] = text;
  return out;
}

void addValidity(const ClearanceGradient &g, py::dict &out) {
  out["valid"] = g.valid, out["reason"] = g.reason, out["t"] = g.t;
}

void addDerivatives(const ClearanceGradient &g, py::dict &out) {
  out["positions"] = fromMatrix(g.positions), out["velocities"] = fromMatrix(g.velocities);
  out["accelerations"] = fromMatrix(g.accelerations), out["duration"] = g.duration;
  out["base_linear"] = fromVector(toVec3(g.base_linear)), out["base_angular"] = fromVector(toVec3(g.base_angular));
  out["object_linear"] = fromVector(toVec3(g.object_linear));
  out["object_angular"] = fromVector(toVec3(g.object_angular));
}

py::dict toDict(const ClearanceRow &row) {
  py::dict out = answerOf(row.answer);
  addValidity(row.gradient, out);
  addDerivatives(row.gradient, out);
  return out;
}

py::dict toDict(const std::vector<ClearanceInterval> &intervals) {
  const auto n = static_cast<py::ssize_t>(intervals.size());
  Array lower(n), upper(n), t(n), witness_a({n, py::ssize_t{3}}), witness_b({n, py::ssize_t{3}});
  py::list a, b;
  for (py::ssize_t i = 0; i < n; ++i) {
    const ClearanceInterval &one = intervals[static_cast<std::size_t>(i)];
    setRow(witness_a, i, one.witness_a), setRow(witness_b, i, one.witness_b);
    lower.mutable_data()[i] = one.lower, upper.mutable_data()[i] = one.upper, t.mutable_data()[i] = one.t;
    a.append(one.a), b.append(one.b);
  }
  py::dict out;
  out["lower"] = lower, out["upper"] = upper, out["t"] = t, out["a"] = a, out["b"] = b;
  out["witness_a"] = witness_a, out["witness_b"] = witness_b;
  const std::optional<Gap> gap = intervals.empty() ? std::nullopt : intervals.front().gap;
  out["gap"] = gap ? gapName(*gap) : "";
  return out;
}

py::list toList(const Violations &found) {
  if (found.status != CPROX_OK) throw std::runtime_error(found.message);
  py::list out;
  for (const Violation &v : found.list) {
    py::dict one;
    one["enter_lower"] = v.enter_lower, one["enter_upper"] = v.enter_upper;
    one["leave_lower"] = v.leave_lower, one["leave_upper"] = v.leave_upper;
    one["verdict"] = cprox_verdict_name(v.verdict), one["upper"] = v.upper, one["t"] = v.t;
    one["a"] = v.a, one["b"] = v.b;
    out.append(one);
  }
  return out;
}

py::list toList(const std::vector<Answer> &answers) {
  py::list out;
  for (const Answer &answer : answers) out.append(answerOf(answer));
  return out;
}

namespace {

/* ---- motions ---- */

std::vector<double> row(const Array &rows, py::ssize_t i) {
  return {rows.data(i), rows.data(i) + rows.shape(1)};
}

void requireRows(const Array &rows, std::size_t n, std::size_t joints, const char *what) {
  if (rows.ndim() != 2 || static_cast<std::size_t>(rows.shape(0)) != n ||
      static_cast<std::size_t>(rows.shape(1)) != joints)
    throw Error(std::string(what) + " must be an array of shape (" + std::to_string(n) + ", " + std::to_string(joints) +
                "): one row a time, one column a joint");
}

std::shared_ptr<RobotMotion> move(const PythonScene &scene, TrajectoryDescription trajectory,
                                  const JointPositions &rest, const std::optional<Array> &base) {
  if (!scene.robot()) throw Error("the scene has no robot");
  adoptBase(scene.robot()->srdf.virtual_joints, *scene.robot()->robot, trajectory);
  JointPositions still = scene.rest(trajectory.fixed_joints);
  for (const auto &[joint, value] : rest) still[joint] = value;
  const Eigen::Isometry3d at = base ? toTransform(base) : placeOf(trajectory, scene.base(), still);
  std::shared_ptr<RobotMotion> out;
  {
    const py::gil_scoped_release release;
    out = std::make_shared<RobotMotion>(scene.snapshot(), trajectory, still, scene.robot()->srdf.disabled, at);
  }
  warn(trajectory.id, longWays(*scene.robot()->robot, trajectory));
  return out;
}

std::shared_ptr<RobotMotion> makeMotion(const PythonScene &scene, const std::vector<std::string> &joints,
                                        const std::vector<double> &times, const Array &positions,
                                        const std::optional<Array> &velocities,
                                        const std::optional<Array> &accelerations, const JointPositions &rest,
                                        const std::optional<Array> &base, bool shortest_way) {
  requireRows(positions, times.size(), joints.size(), "positions");
  if (velocities) requireRows(*velocities, times.size(), joints.size(), "velocities");
  if (accelerations) requireRows(*accelerations, times.size(), joints.size(), "accelerations");
  TrajectoryDescription trajectory;
  trajectory.id = "trajectory", trajectory.joints = joints, trajectory.shortest_way = shortest_way;
  for (std::size_t i = 0; i < times.size(); ++i) {
    const auto k = static_cast<py::ssize_t>(i);
    TrajectoryPoint point;
    point.time = times[i], point.positions = row(positions, k);
    if (velocities) point.velocities = row(*velocities, k);
    if (accelerations) point.accelerations = row(*accelerations, k);
    trajectory.points.push_back(std::move(point));
  }
  return move(scene, std::move(trajectory), rest, base);
}

std::shared_ptr<RobotMotion> loadMotion(const PythonScene &scene, const std::string &path, const JointPositions &rest,
                                        const std::optional<Array> &base, bool shortest_way) {
  std::vector<std::string> warnings;
  TrajectoryDescription trajectory;
  {
    const py::gil_scoped_release release;
    trajectory = loadTrajectoryFile(path, &warnings);
  }
  warn(path, warnings);
  trajectory.shortest_way = trajectory.shortest_way || shortest_way;
  return move(scene, std::move(trajectory), rest, base);
}

py::dict ask(const RobotMotion &motion, bool self, const Query &query) {
  const Answer answer = unlocked([&] {
    return self ? askSelf(motion, query, threadWorkspace()) : askEnvironment(motion, query, threadWorkspace()).front();
  });
  return answerOf(answer, query.query_type != QueryType::DISTANCE);
}

py::dict contactOf(const RobotMotion &motion, bool self, double epsilon, Count max_nodes, const Names &links,
                   const Names &objects, bool allow_empty, bool moving_only) {
  const Answer answer = unlocked([&] {
    return timeOfContact(motion, self,
                         queryOf("collision", 0.0, epsilon, max_nodes, links, objects, allow_empty, moving_only),
                         threadWorkspace());
  });
  return answerOf(answer, true);
}

py::dict certificateOf(const RobotMotion &motion, std::optional<double> delta, bool self, double epsilon,
                       Count max_nodes, const Names &links, const Names &objects, bool allow_empty, bool moving_only) {
  Query query = queryOf(delta ? "tolerance" : "distance", delta.value_or(0.0), epsilon, max_nodes, links, objects,
                        allow_empty, moving_only);
  return provenAnswer(query, [&](std::string &text) {
    text = "cprox-problem 1\n" + describeQuery(motion, self, query);
    return self ? askSelf(motion, query, threadWorkspace()) : askEnvironment(motion, query, threadWorkspace()).front();
  });
}

py::dict gradientOf(const RobotMotion &motion, bool self, double epsilon, Count max_nodes, const Names &links,
                    const Names &objects, bool allow_empty, bool is_signed, bool moving_only) {
  Query query = queryOf("distance", 0.0, epsilon, max_nodes, links, objects, allow_empty, moving_only);
  query.options.signed_distance = is_signed;
  const ClearanceRow row = unlocked([&] {
    return clearanceGradient(motion, self ? RobotPairs::SELF : RobotPairs::ENVIRONMENT, query, threadWorkspace());
  });
  return toDict(row);
}

/* One array of all rows' matrices (rows, points, joints); None if no point has such numbers. */
py::object stacked(const std::vector<ClearanceRow> &rows, Eigen::MatrixXd ClearanceGradient::*matrix) {
  if (rows.empty() || (rows.front().gradient.*matrix).size() == 0) return py::none();
  const Eigen::MatrixXd &first = rows.front().gradient.*matrix;
  Array out({static_cast<py::ssize_t>(rows.size()), first.rows(), first.cols()});
  double *to = out.mutable_data();
  for (const ClearanceRow &row : rows)
    for (Eigen::Index i = 0; i < first.rows(); ++i)
      for (Eigen::Index k = 0; k < first.cols(); ++k) *to++ = (row.gradient.*matrix)(i, k);
  return out;
}

/* One array of all rows' vectors (rows, 3). */
Array stacked(const std::vector<ClearanceRow> &rows, Eigen::Vector3d ClearanceGradient::*vector) {
  Array out({static_cast<py::ssize_t>(rows.size()), py::ssize_t{3}});
  for (std::size_t i = 0; i < rows.size(); ++i)
    setRow(out, static_cast<py::ssize_t>(i), toVec3(rows[i].gradient.*vector));
  return out;
}

py::dict rowsOf(const RobotMotion &motion, double horizon, std::size_t per_pair, const std::vector<double> &breaks,
                bool self, double epsilon, Count max_nodes, const Names &links, const Names &objects, bool allow_empty,
                bool is_signed, std::size_t most, bool moving_only) {
  Query query = queryOf("distance", 0.0, epsilon, max_nodes, links, objects, allow_empty, moving_only);
  query.options.signed_distance = is_signed;
  RowLimits limits;
  limits.horizon = horizon, limits.per_pair = per_pair, limits.most = most, limits.breaks = breaks;
  const ClearanceRows found = unlocked([&] {
    return clearanceRows(motion, self ? RobotPairs::SELF : RobotPairs::ENVIRONMENT, limits, query, threadWorkspace());
  });
  if (found.status != CPROX_OK) throw std::runtime_error(found.message);
  const std::vector<ClearanceRow> &rows = found.rows;
  const auto n = static_cast<py::ssize_t>(rows.size());
  Array lower(n), upper(n), t(n), t0(n), t1(n), duration(n), witness_a({n, py::ssize_t{3}}),
      witness_b({n, py::ssize_t{3}});
  py::array_t<bool> valid(n);
  py::list a, b, reason;
  for (py::ssize_t i = 0; i < n; ++i) {
    const ClearanceRow &row = rows[static_cast<std::size_t>(i)];
    const cprox_result &result = row.answer.result;
    lower.mutable_data()[i] = result.lower, upper.mutable_data()[i] = result.upper, t.mutable_data()[i] = result.t;
    t0.mutable_data()[i] = row.t0, t1.mutable_data()[i] = row.t1, duration.mutable_data()[i] = row.gradient.duration;
    setRow(witness_a, i, result.witness_mover), setRow(witness_b, i, result.witness_obstacle);
    valid.mutable_data()[i] = row.gradient.valid, reason.append(row.gradient.reason);
    a.append(row.answer.a), b.append(row.answer.b);
  }
  py::dict out;
  out["lower"] = lower, out["upper"] = upper, out["t"] = t, out["t0"] = t0, out["t1"] = t1;
  out["a"] = a, out["b"] = b, out["witness_a"] = witness_a, out["witness_b"] = witness_b;
  out["valid"] = valid, out["reason"] = reason, out["duration"] = duration;
  out["positions"] = stacked(rows, &ClearanceGradient::positions);
  out["velocities"] = stacked(rows, &ClearanceGradient::velocities);
  out["accelerations"] = stacked(rows, &ClearanceGradient::accelerations);
  out["base_linear"] = stacked(rows, &ClearanceGradient::base_linear);
  out["base_angular"] = stacked(rows, &ClearanceGradient::base_angular);
  out["object_linear"] = stacked(rows, &ClearanceGradient::object_linear);
  out["object_angular"] = stacked(rows, &ClearanceGradient::object_angular);
  out["gap"] = found.gap ? gapName(*found.gap) : "";
  return out;
}

py::list violationsOf(const RobotMotion &motion, double delta, std::optional<double> resolution, bool self,
                      double epsilon, const Names &links, const Names &objects, bool allow_empty, bool moving_only) {
  constexpr double PART = 1e-3;
  const std::array<double, 2> domain = motion.domain();
  const Violations found = unlocked([&] {
    return violations(motion, self, resolution.value_or(PART * (domain[1] - domain[0])),
                      queryOf("tolerance", delta, epsilon, DEFAULT_BUDGET, links, objects, allow_empty, moving_only),
                      threadWorkspace());
  });
  return toList(found);
}

py::dict profileOf(const RobotMotion &motion, const std::vector<double> &breaks, bool self, double epsilon,
                   const Names &links, double horizon, const Names &objects, bool allow_empty, bool moving_only) {
  const Query query = queryOf("distance", 0.0, epsilon, DEFAULT_BUDGET, links, objects, allow_empty, moving_only);
  const std::vector<ClearanceInterval> intervals =
      unlocked([&] { return clearanceProfile(motion, self, breaks, query, threadWorkspace(), horizon); });
  return toDict(intervals);
}

py::list pairsOf(const RobotMotion &motion, std::size_t k, double within, bool self, double epsilon, const Names &links,
                 const Names &objects, bool allow_empty, bool moving_only) {
  const std::vector<Answer> answers = unlocked([&] {
    return nearestPairs(motion, self, {k, within},
                        queryOf("distance", 0.0, epsilon, DEFAULT_BUDGET, links, objects, allow_empty, moving_only),
                        threadWorkspace());
  });
  return toList(answers);
}

} // namespace

void addMotions(py::module &module) {
  MotionClass motion(
      module, "Motion",
      "The robot of a scene along a joint trajectory, in the scene as it was when the motion was made.\n"
      "links, objects of its queries: of these alone, names of links() and of the scene; with self_collision pairs of "
      "which\na link is one, and no objects.");
  refusePickle(motion, "a Motion cannot be pickled: make it again of a Scene in the other process");
  motion
      .def(
          py::init(&makeMotion), py::arg("scene"), py::arg("joints"), py::arg("times"), py::arg("positions"),
          py::arg("velocities") = py::none(), py::arg("accelerations") = py::none(), py::arg("rest") = JointPositions{},
          py::arg("base") = py::none(), py::arg("shortest_way") = false,
          "Waypoints: times (n,) [s], positions (n, joints); with velocities the motion is cubic between them, with\n"
          "accelerations too quintic, else linear. rest: values of the other joints by name. shortest_way: continuous\n"
          "joints turn the shorter way between two waypoints.")
      .def_static(
          "from_file", &loadMotion, py::arg("scene"), py::arg("path"), py::arg("rest") = JointPositions{},
          py::arg("base") = py::none(), py::arg("shortest_way") = false,
          "The trajectory of a file (YAML). rest: joints that stand elsewhere than the files say. shortest_way:\n"
          "continuous joints turn the shorter way between two waypoints.")
      .def_property_readonly("domain", &RobotMotion::domain, "[s] The first and the last time.")
      .def(
          "link_poses",
          [](const RobotMotion &m, double t) {
            const std::array<double, 2> domain = m.domain();
            if (!(t >= domain[0] && t <= domain[1]))
              throw Error("t must be within the motion's domain [" + std::to_string(domain[0]) + ", " +
                          std::to_string(domain[1]) + "] s, got " + std::to_string(t));
            py::dict out;
            for (const auto &[link, pose] : m.linkPoses(t)) out[py::str(link)] = fromTransform(pose);
            return out;
          },
          py::arg("t"), "The pose (4, 4) of each link at the time t [s].")
      .def(
          "distance",
          [](const RobotMotion &m, bool self, double epsilon, Count max_nodes, bool is_signed, const Names &links,
             const Names &objects, bool allow_empty, bool moving_only) {
            Query query = queryOf("distance", 0.0, epsilon, max_nodes, links, objects, allow_empty, moving_only);
            query.options.signed_distance = is_signed;
            return ask(m, self, query);
          },
          py::arg("self_collision") = false, py::arg("epsilon") = 1e-6, py::arg("max_nodes") = DEFAULT_BUDGET,
          py::arg("signed") = false, py::arg("links") = Names{}, py::arg("objects") = Names{},
          py::arg("allow_empty") = false, py::arg("moving_only") = false,
          "The least distance to the objects, or of the robot to itself: a dict of result, kind, a (link), b (object "
          "or\n"
          "link), by_hull, message. With moving_only what the motion does not move is left out. With signed overlaps "
          "are\n"
          "negative: minus the deepest one. Where meshes overlap, lower is that of their hulls, and the status is\n"
          "overlap.")
      .def(
          "tolerance",
          [](const RobotMotion &m, double delta, bool self, double epsilon, Count max_nodes, const Names &links,
             const Names &objects, bool allow_empty, bool moving_only) {
            return ask(m, self,
                       queryOf("tolerance", delta, epsilon, max_nodes, links, objects, allow_empty, moving_only));
          },
          py::arg("delta"), py::arg("self_collision") = false, py::arg("epsilon") = 1e-6,
          py::arg("max_nodes") = DEFAULT_BUDGET, py::arg("links") = Names{}, py::arg("objects") = Names{},
          py::arg("allow_empty") = false, py::arg("moving_only") = false,
          "Is the robot farther than delta [m] everywhere? As distance().")
      .def(
          "collision",
          [](const RobotMotion &m, bool self, double epsilon, Count max_nodes, const Names &links, const Names &objects,
             bool allow_empty, bool moving_only) {
            return ask(m, self,
                       queryOf("collision", 0.0, epsilon, max_nodes, links, objects, allow_empty, moving_only));
          },
          py::arg("self_collision") = false, py::arg("epsilon") = 1e-6, py::arg("max_nodes") = DEFAULT_BUDGET,
          py::arg("links") = Names{}, py::arg("objects") = Names{}, py::arg("allow_empty") = false,
          py::arg("moving_only") = false, "Does the robot touch or overlap an object, or itself? As distance().")
      .def("time_of_contact", &contactOf, py::arg("self_collision") = false, py::arg("epsilon") = 1e-6,
           py::arg("max_nodes") = DEFAULT_BUDGET, py::arg("links") = Names{}, py::arg("objects") = Names{},
           py::arg("allow_empty") = false, py::arg("moving_only") = false,
           "When the robot first touches an object, or itself: in [t_contact_lower, t] of the result [s]. Never late.\n"
           "As distance().")
      .def("certificate", &certificateOf, py::arg("delta") = py::none(), py::arg("self_collision") = false,
           py::arg("epsilon") = 1e-6, py::arg("max_nodes") = DEFAULT_BUDGET, py::arg("links") = Names{},
           py::arg("objects") = Names{}, py::arg("allow_empty") = false, py::arg("moving_only") = false,
           "A proof of tolerance(delta), or without delta of distance(): their dict with claim ('apart' or 'near'), "
           "record\n"
           "(bytes) and query (str), which check() verifies. ValueError where there is no proof, with the cause.")
      .def("gradient", &gradientOf, py::arg("self_collision") = false, py::arg("epsilon") = 1e-6,
           py::arg("max_nodes") = DEFAULT_BUDGET, py::arg("links") = Names{}, py::arg("objects") = Names{},
           py::arg("allow_empty") = false, py::arg("signed") = false, py::arg("moving_only") = false,
           "The least distance and its derivatives: the dict of distance() with valid, reason, t, positions (points, "
           "joints),\n"
           "velocities and accelerations likewise or None, duration, base_linear, base_angular, object_linear,\n"
           "object_angular (3,). Where valid is False there is no derivative, and reason says why.")
      .def(
          "rows", &rowsOf, py::arg("horizon"), py::arg("per_pair") = 1, py::arg("breaks") = std::vector<double>{},
          py::arg("self_collision") = false, py::arg("epsilon") = 1e-6, py::arg("max_nodes") = DEFAULT_BUDGET,
          py::arg("links") = Names{}, py::arg("objects") = Names{}, py::arg("allow_empty") = false,
          py::arg("signed") = false, py::arg("most") = 1000, py::arg("moving_only") = false,
          "Constraints for an optimiser: of each pair that comes within the horizon [m] its least distances between "
          "each two\nof breaks [s] (empty: the trajectory's times), the per_pair nearest, with their derivatives. "
          "A dict of arrays with an\nentry a row: lower, upper, t, t0, t1, valid, duration (n,), positions (n, points, "
          "joints), velocities and accelerations\nlikewise or None, witness_a, witness_b, base_linear, base_angular, "
          "object_linear, object_angular (n, 3), and lists a, b,\nreason; and gap, as profile(). A pair without a row "
          "is "
          "farther than the horizon, or the motion does not move it.\nRuntimeError where there are more than most "
          "rows.")
      .def("violations", &violationsOf, py::arg("delta"), py::arg("resolution") = py::none(),
           py::arg("self_collision") = false, py::arg("epsilon") = 1e-6, py::arg("links") = Names{},
           py::arg("objects") = Names{}, py::arg("allow_empty") = false, py::arg("moving_only") = false,
           "All intervals of time within delta [m] of an object, or of the robot itself: a list of dicts of "
           "enter_lower,\n"
           "enter_upper, leave_lower, leave_upper [s], verdict, upper, t, a, b. Farther than delta before enter_lower "
           "and\n"
           "after leave_upper, within it from enter_upper to leave_lower. resolution [s]: how finely the ends are "
           "searched,\n"
           "a thousandth of the motion if None. RuntimeError where the budget ends.")
      .def(
          "links", &askedNames, py::arg("self_collision") = false, py::arg("moving_only") = false,
          "The links that have geometry, and what they carry; of those alone that are measured against the robot. With "
          "moving_only those that the motion moves.")
      .def(
          "profile", &profileOf, py::arg("breaks"), py::arg("self_collision") = false, py::arg("epsilon") = 1e-6,
          py::arg("links") = Names{}, py::arg("horizon") = std::numeric_limits<double>::infinity(),
          py::arg("objects") = Names{}, py::arg("allow_empty") = false, py::arg("moving_only") = false,
          "The clearance between each two of breaks (n + 1,) [s]: a dict of lower, upper, t (n,), witness_a, witness_b "
          "(n, 3)\nand lists a, b. Beyond the horizon [m] it is only bounded: "
          "lower > horizon.")
      .def("nearest_pairs", &pairsOf, py::arg("k") = 10, py::arg("within") = std::numeric_limits<double>::infinity(),
           py::arg("self_collision") = false, py::arg("epsilon") = 1e-6, py::arg("links") = Names{},
           py::arg("objects") = Names{}, py::arg("allow_empty") = false, py::arg("moving_only") = false,
           "The k pairs that come closest, nearest first; each as distance() gives it.");
  addRobust(module, motion);
}

} // namespace curve_proximity::python
