/* SPDX-License-Identifier: BSD-3-Clause */
/* What moves, obstacles, and the queries about them. Queries release the GIL. */
#include <map>
#include <sstream>

#include "obstacles.h"

namespace curve_proximity::python {
namespace {

/* ---- many obstacles ---- */

std::vector<cprox_obstacle> obstaclesOf(const std::vector<std::shared_ptr<Obstacle>> &list) {
  std::vector<cprox_obstacle> out;
  for (const auto &one : list) {
    if (!one) throw py::type_error("obstacles must be a list of Obstacle, got None in it");
    out.push_back(one->obstacle);
  }
  return out;
}

cprox_obstacle_index indexOf(const std::string &name) {
  if (name == "bvh") return CPROX_INDEX_BVH;
  if (name == "none") return CPROX_INDEX_NONE;
  throw Error("index must be 'bvh' or 'none', got '" + name + "'");
}

} // namespace

ObstacleSet::ObstacleSet(std::vector<std::shared_ptr<Obstacle>> list, const std::string &index,
                         std::vector<std::string> names)
    : list_(std::move(list)),
      names_(std::move(names)),
      obstacles_(obstaclesOf(list_)),
      set_(obstacles_, indexOf(index)) {}

const Batch &ObstacleSet::batch() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!batch_) batch_ = std::make_unique<Batch>(obstacles_);
  return *batch_;
}

namespace {

/* ---- options ---- */

cprox_options optionsOf(const py::kwargs &given) {
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  for (const auto &[key, value] : given) {
    const auto name = key.cast<std::string>();
    const auto take = [&name, given_value = value](auto wanted) {
      try {
        return given_value.template cast<decltype(wanted)>();
      } catch (const py::cast_error &) {
        const char *kind = std::is_same_v<decltype(wanted), double> ? "a number"
                           : std::is_same_v<decltype(wanted), bool> ? "True or False"
                                                                    : "a word";
        throw py::type_error(name + " must be " + kind + ", got " + whatIs(given_value));
      }
    };
    if (name == "epsilon")
      options.epsilon = take(0.0);
    else if (name == "relative_epsilon")
      options.relative_epsilon = take(0.0);
    else if (name == "max_nodes")
      options.max_nodes = toCount(value, name);
    else if (name == "signed")
      options.signed_distance = take(false);
    else if (name == "max_lod") {
      const auto word = take(std::string());
      const std::map<std::string, cprox_lod> words = {
          {"sphere", CPROX_LOD_SPHERE}, {"hull", CPROX_LOD_HULL}, {"mesh", CPROX_LOD_MESH}};
      if (words.count(word) == 0) throw Error("max_lod must be 'sphere', 'hull' or 'mesh', got '" + word + "'");
      options.max_lod = words.at(word);
    } else {
      throw py::type_error("unexpected option '" + name +
                           "': options are epsilon, relative_epsilon, max_nodes, signed, max_lod");
    }
  }
  return options;
}

template <typename Ask>
auto unlocked(cprox_options &options, const Ask &ask) {
  options.stop = interrupted;
  return python::unlocked(ask);
}

/* A curve alone is a point along it. */
std::shared_ptr<Mover> moverOf(const py::object &given) {
  if (py::isinstance<Mover>(given)) return given.cast<std::shared_ptr<Mover>>();
  if (!py::isinstance<Curve>(given)) throw py::type_error("the mover must be a Curve or a Mover, got " + whatIs(given));
  auto out = std::make_shared<Mover>();
  out->curve = given.cast<Curve>().curve;
  out->mover = cprox_point_along(out->curve.get());
  return out;
}

std::shared_ptr<ObstacleSet> setOf(const py::object &given) {
  if (py::isinstance<ObstacleSet>(given)) return given.cast<std::shared_ptr<ObstacleSet>>();
  try {
    return std::make_shared<ObstacleSet>(given.cast<std::vector<std::shared_ptr<Obstacle>>>(), "none");
  } catch (const py::cast_error &) {
    throw py::type_error("obstacles must be an Obstacle, a list of them or an ObstacleSet, got " + whatIs(given));
  }
}

/* ---- answers ---- */

std::string describe(const Result &answer) {
  const cprox_result &r = answer.result;
  return "<cprox.Result [" + std::to_string(r.lower) + ", " + std::to_string(r.upper) + "]" +
         (answer.asked ? std::string(" ") + cprox_verdict_name(r.verdict) : "") + " at t = " + std::to_string(r.t) +
         ", " + cprox_status_name(r.status) + ">";
}

/* The same as a table for notebooks. */
std::string tableOf(const Result &answer) {
  const cprox_result &r = answer.result;
  std::ostringstream out;
  out.precision(9);
  out << "<table>";
  const auto row = [&out](const char *name, const auto &value, const char *unit = "") {
    out << "<tr><th>" << name << "</th><td>" << value << unit << "</td></tr>";
  };
  if (answer.asked) row("verdict", cprox_verdict_name(r.verdict));
  row("lower", r.lower, " m"), row("upper", r.upper, " m"), row("t", r.t);
  row("status", cprox_status_name(r.status));
  out << "</table>";
  return out.str();
}

const char *lodName(cprox_lod lod) {
  return lod == CPROX_LOD_SPHERE ? "sphere" : lod == CPROX_LOD_HULL ? "hull" : "mesh";
}

/* All that a Result holds, for pickle. */
py::tuple numbersOf(const Result &answer) {
  const cprox_result &r = answer.result;
  const auto three = [](const cprox_vec3 &v) { return py::make_tuple(v.x, v.y, v.z); };
  return py::make_tuple(answer.asked, static_cast<int>(r.status), static_cast<int>(r.verdict), r.lower, r.upper, r.t,
                        r.t_obstacle, three(r.witness_mover), three(r.witness_obstacle), three(r.normal),
                        r.obstacle_index, r.obstacle_part, r.mover_part, static_cast<int>(r.lod), r.nodes,
                        r.distance_queries, r.t_contact_lower);
}

Result resultOf(const py::tuple &numbers) {
  using Three = std::array<double, 3>;
  if (numbers.size() != 17) throw Error("the pickled Result is of another version");
  const auto three = [](const py::handle &given) {
    const auto v = given.cast<Three>();
    return cprox_vec3{v[0], v[1], v[2]};
  };
  Result out{};
  cprox_result &r = out.result;
  out.asked = numbers[0].cast<bool>();
  r.status = static_cast<cprox_status>(numbers[1].cast<int>());
  r.verdict = static_cast<cprox_verdict>(numbers[2].cast<int>());
  r.lower = numbers[3].cast<double>(), r.upper = numbers[4].cast<double>(), r.t = numbers[5].cast<double>();
  r.t_obstacle = numbers[6].cast<double>();
  r.witness_mover = three(numbers[7]), r.witness_obstacle = three(numbers[8]), r.normal = three(numbers[9]);
  r.obstacle_index = numbers[10].cast<std::int32_t>(), r.obstacle_part = numbers[11].cast<std::int32_t>();
  r.mover_part = numbers[12].cast<std::int32_t>(), r.lod = static_cast<cprox_lod>(numbers[13].cast<int>());
  r.nodes = numbers[14].cast<std::uint32_t>(), r.distance_queries = numbers[15].cast<std::uint32_t>();
  r.t_contact_lower = numbers[16].cast<double>();
  return out;
}

std::vector<Result> measured(const std::vector<cprox_result> &results) {
  std::vector<Result> out;
  for (const cprox_result &one : results) out.push_back({one, false});
  return out;
}

/* One array a column, for many results. */
py::dict columnsOf(const std::vector<cprox_result> &results, bool asked) {
  const auto n = static_cast<py::ssize_t>(results.size());
  Array lower(n), upper(n), t(n);
  py::array_t<std::int32_t> obstacle(n);
  py::array_t<std::int8_t> verdict(n), status(n);
  for (py::ssize_t i = 0; i < n; ++i) {
    const cprox_result &r = results[static_cast<std::size_t>(i)];
    lower.mutable_data()[i] = r.lower, upper.mutable_data()[i] = r.upper, t.mutable_data()[i] = r.t;
    obstacle.mutable_data()[i] = r.obstacle_index;
    verdict.mutable_data()[i] = static_cast<std::int8_t>(r.verdict);
    status.mutable_data()[i] = static_cast<std::int8_t>(r.status);
  }
  py::dict out;
  out["lower"] = lower, out["upper"] = upper, out["t"] = t;
  out["obstacle"] = obstacle, out["status"] = status;
  if (asked) out["verdict"] = verdict;
  return out;
}

py::dict profileOf(const ObstacleSet &set, const Mover &mover, const Array &breaks, double horizon,
                   cprox_options options) {
  if (breaks.ndim() != 1 || breaks.shape(0) < 2) throw Error("breaks must be an array of two and more parameters");
  const auto n = static_cast<std::size_t>(breaks.shape(0)) - 1;
  std::vector<cprox_profile_interval> intervals(n);
  unlocked(options, [&] {
    Workspace &workspace = threadWorkspace();
    return require(cprox_obstacles_profile(set.get().get(), mover.mover, breaks.data(), n, horizon, &options,
                                           workspace.get(), intervals.data()),
                   workspace);
  });
  const auto rows = static_cast<py::ssize_t>(n);
  Array lower(rows), upper(rows), t(rows), witness_mover({rows, py::ssize_t{3}}),
      witness_obstacle({rows, py::ssize_t{3}});
  py::array_t<std::int32_t> obstacle(rows);
  for (py::ssize_t i = 0; i < rows; ++i) {
    const cprox_profile_interval &one = intervals[static_cast<std::size_t>(i)];
    setRow(witness_mover, i, one.witness_mover), setRow(witness_obstacle, i, one.witness_obstacle);
    lower.mutable_data()[i] = one.lower, upper.mutable_data()[i] = one.upper, t.mutable_data()[i] = one.t;
    obstacle.mutable_data()[i] = one.obstacle_index;
  }
  py::dict out;
  out["lower"] = lower, out["upper"] = upper, out["t"] = t, out["obstacle"] = obstacle;
  out["witness_mover"] = witness_mover, out["witness_obstacle"] = witness_obstacle;
  return out;
}

/* ---- many curves ---- */

/* Bézier curves of one degree, (N, n, 3); made and asked by the threads of a pool. */
template <typename Ask>
py::dict askBatch(const Array &points, double radius, unsigned threads, bool asked, const Ask &ask) {
  if (points.ndim() != 3 || points.shape(2) != 3) throw Error("points must be an array of shape (N, n, 3)");
  const auto count = static_cast<std::size_t>(points.shape(0)), n = static_cast<std::size_t>(points.shape(1));
  const auto *data = reinterpret_cast<const cprox_vec3 *>(points.data());
  const Batch::Answers answers = python::unlocked([&] {
    std::vector<CurveHandle> curves(count);
    std::vector<cprox_mover> movers(count);
    Pool pool(threads);
    pool.run(count, 256, [&](std::size_t first, std::size_t last, Workspace &) {
      for (std::size_t i = first; i < last; ++i) {
        cprox_curve_description d = detail::describe(CPROX_CURVE_BEZIER, 0.0, 1.0);
        d.points = data + i * n, d.n = n;
        try {
          curves[i] = detail::makeCurve(d);
        } catch (const Error &e) {
          throw Error("curve " + std::to_string(i) + ": " + e.what(), e.status());
        }
        movers[i] = cprox_tube_along(curves[i].get(), radius);
      }
    });
    Batch::Answers found = ask(movers, pool);
    CallbackErrors::takeFromPools();
    return found;
  });
  if (answers.status < 0) throw Error(answers.reason, answers.status);
  return columnsOf(answers.results, asked);
}

/* ---- the gradient ---- */

py::dict gradientOf(const Mover &mover, const Obstacle &obstacle, cprox_options options) {
  cprox_gradient g{};
  cprox_result r{};
  std::string reason;
  unlocked(options, [&] {
    Workspace &workspace = threadWorkspace();
    require(cprox_distance(mover.mover, obstacle.obstacle, &options, workspace.get(), &r), workspace);
    const cprox_status status =
        cprox_distance_gradient(mover.mover, obstacle.obstacle, &options, &r, workspace.get(), &g);
    reason = workspace.reason();
    return require(status, workspace);
  });
  py::dict out;
  out["result"] = Result{r, false}, out["valid"] = g.valid, out["reason"] = g.valid ? "" : reason, out["t"] = g.t;
  out["mover"] = fromVector(g.mover), out["position"] = fromVector(g.position),
  out["rotation"] = fromVector(g.rotation);
  out["radius"] = g.radius, out["margin"] = g.margin, out["t0"] = g.t0, out["t1"] = g.t1;
  return out;
}

/* A query by its function for one obstacle, which needs no index, or by that for many. */
template <typename One, typename Many>
Result ask(const py::object &mover, const py::object &obstacles, const py::kwargs &given, bool asked, const One &one,
           const Many &many) {
  const std::shared_ptr<Mover> moving = moverOf(mover);
  cprox_options options = optionsOf(given);
  Workspace &workspace = threadWorkspace();
  cprox_result result{};
  if (py::isinstance<Obstacle>(obstacles)) {
    const cprox_obstacle &obstacle = obstacles.cast<const Obstacle &>().obstacle;
    require(unlocked(options, [&] { return one(moving->mover, obstacle, &options, workspace.get(), &result); }),
            workspace);
  } else {
    const std::shared_ptr<ObstacleSet> set = setOf(obstacles);
    const cprox_obstacles *all = set->get().get();
    require(unlocked(options, [&] { return many(all, moving->mover, &options, workspace.get(), &result); }), workspace);
  }
  return {result, asked};
}

py::dict growthDict(const cprox_growth &growth) {
  py::dict out;
  out["status"] = cprox_status_name(growth.status);
  out["lower"] = growth.lower;
  out["upper"] = growth.upper;
  out["normal"] = fromVector(growth.normal);
  return out;
}

py::dict growthDict(const cprox_growth &growth, const cprox_growth_derivatives &d, const Workspace &workspace) {
  py::dict out = growthDict(growth);
  out["valid"] = d.valid;
  out["valid_position"] = d.valid_position;
  out["reason"] = d.valid ? "" : cprox_workspace_error(workspace.get());
  out["a_position"] = fromVector(d.a_position);
  out["a_rotation"] = fromVector(d.a_rotation);
  out["b_position"] = fromVector(d.b_position);
  out["b_rotation"] = fromVector(d.b_rotation);
  out["touch"] = fromVector(d.touch);
  return out;
}

} // namespace

void addQueries(py::module &module) {
  py::class_<Result>(module, "Result", "A certified answer: lower <= true value <= upper [m].")
      .def_property_readonly(
          "lower", [](const Result &r) { return r.result.lower; }, "[m] The true value is not below this.")
      .def_property_readonly(
          "upper", [](const Result &r) { return r.result.upper; }, "[m] The true value is not above this.")
      .def_property_readonly(
          "t", [](const Result &r) { return r.result.t; }, "Where on the mover's curve upper is attained.")
      .def_property_readonly(
          "t_obstacle", [](const Result &r) { return r.result.t_obstacle; },
          "Where on an obstacle that is a curve; NaN for shapes.")
      .def_property_readonly(
          "t_contact_lower", [](const Result &r) { return r.result.t_contact_lower; },
          "Time of contact: no contact before this.")
      .def_property_readonly(
          "obstacle", [](const Result &r) { return r.result.obstacle_index; }, "Which obstacle; -1: none.")
      .def_property_readonly(
          "obstacle_part", [](const Result &r) { return r.result.obstacle_part; }, "Which part of a compound.")
      .def_property_readonly(
          "nodes", [](const Result &r) { return r.result.nodes; }, "Parameter intervals examined.")
      .def_property_readonly(
          "distance_queries", [](const Result &r) { return r.result.distance_queries; }, "Nearest-point queries.")
      .def_property_readonly(
          "witness_mover", [](const Result &r) { return fromVector(r.result.witness_mover); }, "(3,)")
      .def_property_readonly(
          "witness_obstacle", [](const Result &r) { return fromVector(r.result.witness_obstacle); }, "(3,)")
      .def_property_readonly(
          "normal", [](const Result &r) { return fromVector(r.result.normal); },
          "(3,) unit, from obstacle to mover; 0 where there is none.")
      .def_property_readonly(
          "verdict",
          [](const Result &r) -> py::object {
            if (!r.asked) return py::none();
            return py::str(cprox_verdict_name(r.result.verdict));
          },
          "'clear', 'violated' or 'undecided', which counts as unsafe; None of a distance, where none was asked.")
      .def_property_readonly(
          "lod", [](const Result &r) { return lodName(r.result.lod); },
          "The finest level of detail that the answer needed: 'sphere', 'hull' or 'mesh'.")
      .def_property_readonly(
          "status", [](const Result &r) { return cprox_status_name(r.result.status); },
          "'ok', or why the interval is wider than asked: 'budget', 'precision', 'inexact', 'stopped'.")
      .def(py::pickle(&numbersOf, &resultOf))
      .def("_repr_html_", &tableOf)
      .def("__repr__", &describe);

  py::class_<Mover, std::shared_ptr<Mover>>(module, "Mover", "What moves: a point, a ball or a shape along a curve.")
      .def("__reduce__", [](const Mover &m) { return remake(m.made, "this Mover cannot be pickled"); });
  define(
      module, "tube",
      [](const Curve &curve, const Array &radius) {
        if (radius.ndim() > 1 || radius.size() == 0) throw Error("radius must be a number or an array of shape (n,)");
        if (!(radius.size() > 1 || radius.data()[0] >= 0.0)) throw Error("radius must be 0 or more");
        auto out = std::make_shared<Mover>();
        out->curve = curve.curve, out->mover = cprox_tube_along(out->curve.get(), radius.data()[0]);
        if (radius.size() == 1) return out;
        Eigen::Matrix3Xd points = Eigen::Matrix3Xd::Zero(3, static_cast<Eigen::Index>(radius.size()));
        for (py::ssize_t i = 1; i < radius.size(); ++i) points(0, static_cast<Eigen::Index>(i)) = radius.data()[i];
        const cprox_curve_info info = cprox_curve_get_info(out->curve.get());
        out->radius = makePolynomial(points, info.t0, info.t1), out->mover.radius_curve = out->radius.get();
        return out;
      },
      py::arg("curve"), py::arg("radius"),
      "A ball along the curve. radius: [m] >= 0, or the coefficients of 1, t, t², … of a radius that changes.");
  define(
      module, "carried",
      [](const Shape &shape, const Curve &curve, double margin) {
        auto out = std::make_shared<Mover>();
        out->curve = curve.curve, out->body = shape.body;
        out->mover = cprox_body_along(out->body.get(), out->curve.get());
        out->mover.radius = margin;
        return out;
      },
      py::arg("shape"), py::arg("curve"), py::arg("margin") = 0.0,
      "A convex shape or a compound, carried along the curve without turning.");

  py::class_<Obstacle, std::shared_ptr<Obstacle>>(module, "Obstacle", "A shape at a pose, or a curve.")
      .def(py::init(recorded("Obstacle",
                             [](const Shape &shape, const std::optional<Array> &pose, double margin) {
                               if (!(margin >= 0.0)) throw Error("margin must be 0 or more");
                               auto out = std::make_shared<Obstacle>();
                               out->body = shape.body;
                               out->obstacle = cprox_with_margin(
                                   cprox_obstacle_at(out->body.get(), toPose(toTransform(pose))), margin);
                               return out;
                             })),
           py::arg("shape"), py::arg("pose") = py::none(), py::arg("margin") = 0.0,
           "A shape at a pose (4, 4), None: the identity; margin >= 0 [m].")
      .def_static("from_curve",
                  recorded("Obstacle.from_curve",
                           [](const Curve &curve, double radius, const std::optional<Array> &pose) {
                             if (!(radius >= 0.0)) throw Error("radius must be 0 or more");
                             auto out = std::make_shared<Obstacle>();
                             out->curve = curve.curve, out->obstacle = cprox_obstacle_curve(out->curve.get(), radius);
                             out->obstacle.pose = toPose(toTransform(pose));
                             return out;
                           }),
                  py::arg("curve"), py::arg("radius") = 0.0, py::arg("pose") = py::none(),
                  "A curve that stands, as thick as a ball of the radius.")
      .def_static(
          "synchronized",
          [](const py::object &other) {
            auto out = std::make_shared<Obstacle>();
            out->made = py::make_tuple("Obstacle.synchronized", other);
            out->others.push_back(moverOf(other));
            out->obstacle = cprox_synchronized(out->others.back()->mover);
            return out;
          },
          py::arg("mover"), "Another mover, at the same parameter as the mover of the query.")
      .def("__reduce__", [](const Obstacle &o) { return remake(o.made, "this Obstacle cannot be pickled"); });

  py::class_<ObstacleSet, std::shared_ptr<ObstacleSet>>(
      module, "Obstacles", "Many obstacles behind one index. Immutable, shared by threads.")
      .def(py::init(recorded("Obstacles",
                             [](const std::vector<std::shared_ptr<Obstacle>> &list, const std::string &index) {
                               return std::make_shared<ObstacleSet>(list, index);
                             })),
           py::arg("obstacles"), py::arg("index") = "bvh", "index: 'bvh', or 'none' for a few obstacles.")
      .def_property_readonly("names", &ObstacleSet::names,
                             "Of Scene.obstacles(): the object that each obstacle belongs to; else empty.")
      .def("__len__", [](const ObstacleSet &set) { return set.get().size(); })
      .def(
          "nearest",
          [](const ObstacleSet &set, const py::object &mover, std::size_t k, const py::kwargs &given) {
            const std::shared_ptr<Mover> moving = moverOf(mover);
            cprox_options options = optionsOf(given);
            return measured(
                unlocked(options, [&] { return set.get().nearest(moving->mover, k, options, threadWorkspace()); }));
          },
          py::arg("mover"), py::arg("k"), "The k nearest obstacles, a Result each, in ascending order.")
      .def(
          "profile",
          [](const ObstacleSet &set, const py::object &mover, const Array &breaks, double horizon,
             const py::kwargs &given) { return profileOf(set, *moverOf(mover), breaks, horizon, optionsOf(given)); },
          py::arg("mover"), py::arg("breaks"), py::arg("horizon") = std::numeric_limits<double>::infinity(),
          "The clearance on each interval between two of breaks (n + 1,): a dict of arrays (n,) lower, upper, t, "
          "obstacle,\nand (n, 3) witness_mover, witness_obstacle. Beyond the horizon [m] it is only bounded: lower > "
          "horizon.")
      .def(
          "distance_batch",
          [](const ObstacleSet &set, const Array &points, double radius, unsigned threads, const py::kwargs &given) {
            const cprox_options options = optionsOf(given);
            return askBatch(points, radius, threads, false, [&](const std::vector<cprox_mover> &movers, Pool &pool) {
              return set.batch().distance(movers, options, pool);
            });
          },
          py::arg("points"), py::arg("radius") = 0.0, py::arg("threads") = 0,
          "The distance of each of N Bézier curves, points (N, n, 3): a dict of arrays (N,) lower, upper, t, "
          "obstacle,\n"
          "status. threads 0: as many as the machine has.")
      .def(
          "tolerance_batch",
          [](const ObstacleSet &set, const Array &points, double delta, double radius, unsigned threads,
             const py::kwargs &given) {
            const cprox_options options = optionsOf(given);
            return askBatch(points, radius, threads, true, [&](const std::vector<cprox_mover> &movers, Pool &pool) {
              return set.batch().tolerance(movers, delta, options, pool);
            });
          },
          py::arg("points"), py::arg("delta"), py::arg("radius") = 0.0, py::arg("threads") = 0,
          "Whether each of N Bézier curves is farther than delta [m] everywhere; as distance_batch(), and verdict: 0 "
          "clear,\n"
          "1 violated, 2 undecided.")
      .def("__reduce__", [](const ObstacleSet &set) {
        return remake(set.made, "the Obstacles of a scene cannot be pickled: pickle numbers, or load the scene again");
      });

  module.def(
      "distance",
      [](const py::object &mover, const py::object &obstacles, const py::kwargs &given) {
        return ask(mover, obstacles, given, false, cprox_distance, [](auto o, auto m, auto options, auto w, auto r) {
          return cprox_obstacles_distance(o, m, options, w, r, nullptr);
        });
      },
      py::arg("mover"), py::arg("obstacles"),
      "The least distance over the whole curve [m]. obstacles: Obstacles, one Obstacle or a list of them.\n"
      "Options: epsilon=1e-6, relative_epsilon=0, max_nodes=500000, signed=False, max_lod='mesh'.");
  module.def(
      "tolerance",
      [](const py::object &mover, const py::object &obstacles, double delta, const py::kwargs &given) {
        return ask(
            mover, obstacles, given, true,
            [&](auto m, auto o, auto options, auto w, auto r) { return cprox_tolerance(m, o, delta, options, w, r); },
            [&](auto o, auto m, auto options, auto w, auto r) {
              return cprox_obstacles_tolerance(o, m, delta, options, w, r, nullptr);
            });
      },
      py::arg("mover"), py::arg("obstacles"), py::arg("delta"), "Is the mover farther than delta >= 0 [m] everywhere?");
  module.def(
      "collision",
      [](const py::object &mover, const py::object &obstacles, const py::kwargs &given) {
        return ask(mover, obstacles, given, true, cprox_collision, [](auto o, auto m, auto options, auto w, auto r) {
          return cprox_obstacles_collision(o, m, options, w, r, nullptr);
        });
      },
      py::arg("mover"), py::arg("obstacles"), "Does the mover touch or overlap an obstacle anywhere?");
  module.def(
      "time_of_contact",
      [](const py::object &mover, const py::object &obstacles, const py::kwargs &given) {
        return ask(mover, obstacles, given, true, cprox_time_of_contact, cprox_obstacles_time_of_contact);
      },
      py::arg("mover"), py::arg("obstacles"), "Where the mover first touches: in [t_contact_lower, t]. Never late.");
  module.def(
      "pair",
      [](const Obstacle &a, const Obstacle &b, const py::kwargs &given) {
        cprox_options options = optionsOf(given);
        return Result{unlocked(options, [&] { return pair(a.obstacle, b.obstacle, options, threadWorkspace()); }),
                      false};
      },
      py::arg("a"), py::arg("b"), "The signed distance of two shapes that stand [m].");
  module.def(
      "translating_distance",
      [](const Obstacle &a, const Obstacle &b, const Array &velocity_a, const Array &velocity_b, double duration,
         const py::kwargs &given) {
        const cprox_options options = optionsOf(given);
        const cprox_translating first = {a.obstacle, toVector(velocity_a, "velocity_a")},
                                second = {b.obstacle, toVector(velocity_b, "velocity_b")};
        return Result{translatingDistance(first, second, duration, options, threadWorkspace()), false};
      },
      py::arg("a"), py::arg("b"), py::arg("velocity_a"), py::arg("velocity_b"), py::arg("duration"),
      "The least distance [m] of two convex shapes that move at constant velocities (3,) [m/s] for the duration [s].");
  module.def(
      "translating_contact",
      [](const Obstacle &a, const Obstacle &b, const Array &velocity_a, const Array &velocity_b, double duration,
         const py::kwargs &given) {
        cprox_options options = optionsOf(given);
        const cprox_translating first = {a.obstacle, toVector(velocity_a, "velocity_a")},
                                second = {b.obstacle, toVector(velocity_b, "velocity_b")};
        return Result{
            unlocked(options, [&] { return translatingContact(first, second, duration, options, threadWorkspace()); }),
            true};
      },
      py::arg("a"), py::arg("b"), py::arg("velocity_a"), py::arg("velocity_b"), py::arg("duration"),
      "When two convex shapes that translate first touch: in [t_contact_lower, t]. Never late.");
  module.def(
      "growth_distance",
      [](const Obstacle &a, const Obstacle &b, const py::kwargs &given) {
        const cprox_options options = optionsOf(given);
        return growthDict(growthDistance(a.obstacle, b.obstacle, options, threadWorkspace()));
      },
      py::arg("a"), py::arg("b"),
      "The least factor by which two convex shapes, each scaled about its centre, touch: a dict of status, lower, "
      "upper,\nnormal. Below 1 they overlap.");
  module.def(
      "growth_gradient",
      [](const Obstacle &a, const Obstacle &b, const py::kwargs &given) {
        const cprox_options options = optionsOf(given);
        Workspace &workspace = threadWorkspace();
        cprox_growth_derivatives d{};
        const cprox_growth growth = growthGradient(a.obstacle, b.obstacle, options, workspace, d);
        return growthDict(growth, d, workspace);
      },
      py::arg("a"), py::arg("b"),
      "growth_distance with its derivatives: also valid, valid_position, reason, a_position, a_rotation, b_position,\n"
      "b_rotation, touch (where the scaled shapes touch).");
  module.def(
      "growth_along",
      [](const Obstacle &a, const Curve &curve, const Obstacle &b, const py::kwargs &given) {
        const cprox_options options = optionsOf(given);
        Workspace &workspace = threadWorkspace();
        cprox_growth_derivatives d{};
        double t = 0.0;
        const cprox_growth growth = growthAlong(a.obstacle, curve.curve.get(), b.obstacle, options, workspace, t, d);
        py::dict out = growthDict(growth, d, workspace);
        out["t"] = t;
        return out;
      },
      py::arg("a"), py::arg("curve"), py::arg("b"),
      "The least growth distance of a, which the curve carries at its pose without turning it, from b: as\n"
      "growth_gradient at the parameter t where it is least.");
  module.def(
      "distance_gradient",
      [](const py::object &mover, const Obstacle &obstacle, const py::kwargs &given) {
        return gradientOf(*moverOf(mover), obstacle, optionsOf(given));
      },
      py::arg("mover"), py::arg("obstacle"),
      "The distance and its derivatives: a dict of result, valid, reason, t, mover (by the point at t), position,\n"
      "rotation (of the obstacle), radius, margin, t0, t1.");
}

} // namespace curve_proximity::python
