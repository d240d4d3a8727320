/* SPDX-License-Identifier: BSD-3-Clause */
/* Curves against a scene, its robot included. Queries release the GIL. */
#include <algorithm>
#include <array>

#include "robots.h"

namespace curve_proximity::python {
namespace {

/* What all questions of a scene about a curve are given. */
struct Given {
  double radius;
  const JointPositions &positions;
  double epsilon;
  Count max_nodes;
  const Names &objects, &links;
  bool allow_empty;
};

/* A question made ready: the scene as it is now, the robot where its joints say. */
struct Asked {
  Query query;
  SceneObstacles obstacles;
  CompiledCurve curve;

  Asked(const PythonScene &scene, const Curve &path, const std::string &type, double delta, const Given &given)
      : query(queryOf(type, delta, given.epsilon, given.max_nodes, given.links, given.objects, given.allow_empty)),
        obstacles(scene.snapshot(), linksOf(scene, given.positions), query),
        curve(compile("curve", path.curve, given.radius, obstacles.boxes())) {}

 private:
  static LinkPoses linksOf(const PythonScene &scene, const JointPositions &positions) {
    if (scene.robot()) return scene.robot()->robot->linkPoses(scene.rest(positions), scene.base());
    if (!positions.empty()) throw Error("positions: the scene has no robot");
    return {};
  }
};

py::dict answer(const Asked &asked) {
  return answerOf(unlocked([&] { return ask(asked.obstacles, asked.curve, asked.query, threadWorkspace()).front(); }),
                  asked.query.query_type != QueryType::DISTANCE);
}

/* A curve as the function that made it was told; throws Error for a kind that has no certificates. */
CurveDescription describe(const Curve &path, double radius) {
  static constexpr std::array<const char *, 6> bases = {"bezier",   "bspline",  "polynomial",
                                                        "legendre", "lagrange", "trigonometric"};
  CurveDescription out;
  const auto made = path.made.is_none() ? py::tuple() : py::tuple(path.made);
  out.basis = made.empty() ? "given" : made[0].cast<std::string>();
  if (std::find(bases.begin(), bases.end(), out.basis) == bases.end())
    throw Error("no certificate: a " + out.basis + " curve has none");
  const Array given = made[1].cast<Array>();
  const Points points(given, "points");
  out.points = Eigen::Map<const Eigen::Matrix3Xd>(&points.data->x, 3, static_cast<Eigen::Index>(points.size));
  const auto numbers = [](const Array &row) { return std::vector<double>(row.data(), row.data() + row.size()); };
  out.degree = out.basis == "trigonometric" ? (points.size - 1) / 2 : points.size - 1;
  if (out.basis == "bspline") out.degree = made[2].cast<std::size_t>(), out.knots = numbers(made[3].cast<Array>());
  if (out.basis == "lagrange") out.knots = numbers(made[2].cast<Array>());
  const cprox_curve_info info = cprox_curve_get_info(path.curve.get());
  out.id = "curve", out.t0 = info.t0, out.t1 = info.t1, out.radius = radius;
  return out;
}

py::dict certificateOf(const PythonScene &scene, const Curve &curve, std::optional<double> delta, const Given &given) {
  const CurveDescription description = describe(curve, given.radius);
  Asked asked(scene, curve, delta ? "tolerance" : "distance", delta.value_or(0.0), given);
  return provenAnswer(asked.query, [&](std::string &text) {
    text = describeQuery(asked.obstacles, description);
    return ask(asked.obstacles, asked.curve, asked.query, threadWorkspace()).front();
  });
}

/* Adds one method: its own arguments come first. */
template <typename Class, typename Method, typename... Own>
void add(Class &scene, const char *name, const Method &method, const char *help, const Own &...own) {
  scene.def(name, method, py::arg("curve"), own..., py::kw_only(), py::arg("radius") = 0.0,
            py::arg("positions") = JointPositions{}, py::arg("epsilon") = 1e-6, py::arg("max_nodes") = DEFAULT_BUDGET,
            py::arg("objects") = Names{}, py::arg("links") = Names{}, py::arg("allow_empty") = false, help);
}

} // namespace

void addCurveQueries(SceneClass &scene) {
  using Scene = const PythonScene &;
  add(
      scene, "distance",
      [](Scene s, const Curve &curve, bool is_signed, double radius, const JointPositions &positions, double epsilon,
         Count max_nodes, const Names &objects, const Names &links, bool allow_empty) {
        Asked asked(s, curve, "distance", 0.0, {radius, positions, epsilon, max_nodes, objects, links, allow_empty});
        asked.query.options.signed_distance = is_signed;
        return answer(asked);
      },
      "The least distance of a ball along the curve to the objects and the robot's links: a dict of result, kind, a, "
      "b\n"
      "(object or link), by_hull, message, status. radius [m] of the ball. The robot stands as the scene's files say, "
      "or\n"
      "better, as positions do (joint values by name). objects, links: of these alone.",
      py::arg("signed") = false);
  add(
      scene, "tolerance",
      [](Scene s, const Curve &curve, double delta, double radius, const JointPositions &positions, double epsilon,
         Count max_nodes, const Names &objects, const Names &links, bool allow_empty) {
        return answer(
            {s, curve, "tolerance", delta, {radius, positions, epsilon, max_nodes, objects, links, allow_empty}});
      },
      "Is the curve farther than delta [m] everywhere? As distance().", py::arg("delta"));
  add(
      scene, "collision",
      [](Scene s, const Curve &curve, double radius, const JointPositions &positions, double epsilon, Count max_nodes,
         const Names &objects, const Names &links, bool allow_empty) {
        return answer(
            {s, curve, "collision", 0.0, {radius, positions, epsilon, max_nodes, objects, links, allow_empty}});
      },
      "Does the curve touch or overlap something? As distance().");
  add(
      scene, "certificate",
      [](Scene s, const Curve &curve, std::optional<double> delta, double radius, const JointPositions &positions,
         double epsilon, Count max_nodes, const Names &objects, const Names &links, bool allow_empty) {
        return certificateOf(s, curve, delta, {radius, positions, epsilon, max_nodes, objects, links, allow_empty});
      },
      "The answer of tolerance(), or without delta that of distance(), with its proof, as Motion.certificate():\n"
      "claim, record and query, for check(). Of curves by bezier(), bspline(), polynomial(), legendre(), lagrange()\n"
      "and trigonometric().",
      py::arg("delta") = py::none());
  add(
      scene, "time_of_contact",
      [](Scene s, const Curve &curve, double radius, const JointPositions &positions, double epsilon, Count max_nodes,
         const Names &objects, const Names &links, bool allow_empty) {
        const Asked asked(s, curve, "collision", 0.0,
                          {radius, positions, epsilon, max_nodes, objects, links, allow_empty});
        return answerOf(
            unlocked([&] { return timeOfContact(asked.obstacles, asked.curve, asked.query, threadWorkspace()); }),
            true);
      },
      "Where the curve first touches: in [t_contact_lower, t] of the result. Never late. As distance().");
  add(
      scene, "nearest_pairs",
      [](Scene s, const Curve &curve, std::size_t k, double within, double radius, const JointPositions &positions,
         double epsilon, Count max_nodes, const Names &objects, const Names &links, bool allow_empty) {
        const Asked asked(s, curve, "distance", 0.0,
                          {radius, positions, epsilon, max_nodes, objects, links, allow_empty});
        return toList(unlocked([&] {
          return nearestPairs(asked.obstacles, asked.curve, {k, within}, asked.query, threadWorkspace());
        }));
      },
      "The k shapes that come closest, nearest first; each as distance() gives it.", py::arg("k") = 10,
      py::arg("within") = std::numeric_limits<double>::infinity());
  add(
      scene, "profile",
      [](Scene s, const Curve &curve, const std::vector<double> &breaks, double horizon, double radius,
         const JointPositions &positions, double epsilon, Count max_nodes, const Names &objects, const Names &links,
         bool allow_empty) {
        const Asked asked(s, curve, "distance", 0.0,
                          {radius, positions, epsilon, max_nodes, objects, links, allow_empty});
        return toDict(unlocked([&] {
          return clearanceProfile(asked.obstacles, asked.curve, breaks, asked.query, threadWorkspace(), horizon);
        }));
      },
      "The clearance between each two of breaks (n + 1,): a dict of lower, upper, t (n,), witness_a, witness_b (n, 3) "
      "and\n"
      "lists a, b. Beyond the horizon [m] it is only bounded: lower > horizon.",
      py::arg("breaks"), py::arg("horizon") = std::numeric_limits<double>::infinity());
  add(
      scene, "violations",
      [](Scene s, const Curve &curve, double delta, std::optional<double> resolution, double radius,
         const JointPositions &positions, double epsilon, Count max_nodes, const Names &objects, const Names &links,
         bool allow_empty) {
        constexpr double PART = 1e-3;
        const Asked asked(s, curve, "tolerance", delta,
                          {radius, positions, epsilon, max_nodes, objects, links, allow_empty});
        const cprox_curve_info info = cprox_curve_get_info(curve.curve.get());
        return toList(unlocked([&] {
          return violations(asked.obstacles, asked.curve, resolution.value_or(PART * (info.t1 - info.t0)), asked.query,
                            threadWorkspace());
        }));
      },
      "The intervals in which the curve is within delta [m] of something, as Motion.violations().", py::arg("delta"),
      py::arg("resolution") = py::none());
}

} // namespace curve_proximity::python
