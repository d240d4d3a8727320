/* SPDX-License-Identifier: BSD-3-Clause */
/* What moves, obstacles, and the queries about them. Queries release the GIL. */
#include <map>

#include <curve_proximity/parallel.hpp>

#include "conversion.h"

namespace curve_proximity::python {
namespace {

/* A mover, and what it refers to. */
struct Mover {
  cprox_mover mover{};
  CurveHandle curve, radius;
  BodyHandle body;
};

struct Obstacle {
  cprox_obstacle obstacle{};
  BodyHandle body;
  CurveHandle curve;
  std::vector<std::shared_ptr<Mover>> others; /* at the same parameter */
};

/* Many obstacles, and what they refer to; immutable. The batch index is made when it is first wanted. */
class ObstacleSet {
 public:
  ObstacleSet(std::vector<std::shared_ptr<Obstacle>> list, const std::string &index)
      : list_(std::move(list)), targets_(targetsOf(list_)), obstacles_(targets_, indexOf(index)) {}

  const Obstacles &get() const {
    return obstacles_;
  }

  const Batch &batch() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!batch_) batch_ = std::make_unique<Batch>(targets_);
    return *batch_;
  }

 private:
  static std::vector<cprox_obstacle> targetsOf(const std::vector<std::shared_ptr<Obstacle>> &list) {
    std::vector<cprox_obstacle> out;
    for (const auto &one : list) out.push_back(one->obstacle);
    return out;
  }

  static cprox_obstacle_index indexOf(const std::string &name) {
    if (name == "bvh") return CPROX_INDEX_BVH;
    if (name == "none") return CPROX_INDEX_NONE;
    throw Error("index must be 'bvh' or 'none', got '" + name + "'");
  }

  std::vector<std::shared_ptr<Obstacle>> list_;
  std::vector<cprox_obstacle> targets_;
  Obstacles obstacles_;
  mutable std::mutex mutex_;
  mutable std::unique_ptr<Batch> batch_;
};

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

std::string describe(const cprox_result &r) {
  return "<cprox.Result [" + std::to_string(r.lower) + ", " + std::to_string(r.upper) + "] " +
         cprox_verdict_name(r.verdict) + " at t = " + std::to_string(r.t) + ", " + cprox_status_name(r.status) + ">";
}

/* One array a column, for many results. */
py::dict columnsOf(const std::vector<cprox_result> &results) {
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
  out["obstacle"] = obstacle, out["verdict"] = verdict, out["status"] = status;
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
py::dict askBatch(const Array &points, double radius, unsigned threads, const Ask &ask) {
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
  return columnsOf(answers.results);
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
  out["result"] = r, out["valid"] = g.valid, out["reason"] = g.valid ? "" : reason, out["t"] = g.t;
  out["mover"] = fromVector(g.mover), out["position"] = fromVector(g.position),
  out["rotation"] = fromVector(g.rotation);
  out["radius"] = g.radius, out["margin"] = g.margin, out["t0"] = g.t0, out["t1"] = g.t1;
  return out;
}

/* A query by its function for one obstacle, which needs no index, or by that for many. */
template <typename One, typename Many>
cprox_result ask(const py::object &mover, const py::object &obstacles, const py::kwargs &given, const One &one,
                 const Many &many) {
  const std::shared_ptr<Mover> moving = moverOf(mover);
  cprox_options options = optionsOf(given);
  Workspace &workspace = threadWorkspace();
  cprox_result result{};
  if (py::isinstance<Obstacle>(obstacles)) {
    const cprox_obstacle &target = obstacles.cast<const Obstacle &>().obstacle;
    require(unlocked(options, [&] { return one(moving->mover, target, &options, workspace.get(), &result); }),
            workspace);
  } else {
    const std::shared_ptr<ObstacleSet> set = setOf(obstacles);
    const cprox_obstacles *all = set->get().get();
    require(unlocked(options, [&] { return many(all, moving->mover, &options, workspace.get(), &result); }), workspace);
  }
  return result;
}

} // namespace

void addQueries(py::module &module) {
  py::class_<cprox_result>(module, "Result", "A certified answer: lower <= true value <= upper [m].")
      .def_readonly("lower", &cprox_result::lower, "[m] The true value is not below this.")
      .def_readonly("upper", &cprox_result::upper, "[m] The true value is not above this.")
      .def_readonly("t", &cprox_result::t, "Where on the mover's curve upper is attained.")
      .def_readonly("t_obstacle", &cprox_result::t_obstacle, "Where on an obstacle that is a curve; NaN for shapes.")
      .def_readonly("t_contact_lower", &cprox_result::t_contact_lower, "Time of contact: no contact before this.")
      .def_readonly("obstacle", &cprox_result::obstacle_index, "Which obstacle; -1: none.")
      .def_readonly("obstacle_part", &cprox_result::obstacle_part, "Which part of a compound.")
      .def_readonly("nodes", &cprox_result::nodes, "Parameter intervals examined.")
      .def_readonly("distance_queries", &cprox_result::distance_queries, "Nearest-point queries.")
      .def_property_readonly(
          "witness_mover", [](const cprox_result &r) { return fromVector(r.witness_mover); }, "(3,)")
      .def_property_readonly(
          "witness_obstacle", [](const cprox_result &r) { return fromVector(r.witness_obstacle); }, "(3,)")
      .def_property_readonly(
          "normal", [](const cprox_result &r) { return fromVector(r.normal); },
          "(3,) unit, from obstacle to mover; 0 where there is none.")
      .def_property_readonly(
          "verdict", [](const cprox_result &r) { return cprox_verdict_name(r.verdict); },
          "'clear', 'violated' or 'undecided'; undecided counts as unsafe.")
      .def_property_readonly(
          "status", [](const cprox_result &r) { return cprox_status_name(r.status); },
          "'ok', or why the interval is wider than asked: 'budget', 'precision', 'inexact', 'stopped'.")
      .def("__repr__", &describe);

  py::class_<Mover, std::shared_ptr<Mover>>(module, "Mover", "What moves: a point, a ball or a shape along a curve.");
  module.def(
      "tube",
      [](const Curve &curve, const Array &radius) {
        if (radius.ndim() > 1 || radius.size() == 0) throw Error("radius must be a number or an array of shape (n,)");
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
  module.def(
      "carried",
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
      .def(py::init([](const Shape &shape, const std::optional<Array> &pose, double margin) {
             auto out = std::make_shared<Obstacle>();
             out->body = shape.body;
             out->obstacle = cprox_with_margin(cprox_obstacle_at(out->body.get(), toPose(toTransform(pose))), margin);
             return out;
           }),
           py::arg("shape"), py::arg("pose") = py::none(), py::arg("margin") = 0.0,
           "A shape at a pose (4, 4), None: the identity; margin >= 0 [m].")
      .def_static(
          "from_curve",
          [](const Curve &curve, double radius, const std::optional<Array> &pose) {
            auto out = std::make_shared<Obstacle>();
            out->curve = curve.curve, out->obstacle = cprox_obstacle_curve(out->curve.get(), radius);
            out->obstacle.pose = toPose(toTransform(pose));
            return out;
          },
          py::arg("curve"), py::arg("radius") = 0.0, py::arg("pose") = py::none(),
          "A curve that stands, as thick as a ball of the radius.")
      .def_static(
          "synchronized",
          [](const py::object &other) {
            auto out = std::make_shared<Obstacle>();
            out->others.push_back(moverOf(other));
            out->obstacle = cprox_synchronized(out->others.back()->mover);
            return out;
          },
          py::arg("mover"), "Another mover, at the same parameter as the mover of the query.");

  py::class_<ObstacleSet, std::shared_ptr<ObstacleSet>>(
      module, "Obstacles", "Many obstacles behind one index. Immutable, shared by threads.")
      .def(py::init<std::vector<std::shared_ptr<Obstacle>>, const std::string &>(), py::arg("obstacles"),
           py::arg("index") = "bvh", "index: 'bvh', or 'none' for a few obstacles.")
      .def("__len__", [](const ObstacleSet &set) { return set.get().size(); })
      .def(
          "nearest",
          [](const ObstacleSet &set, const py::object &mover, std::size_t k, const py::kwargs &given) {
            const std::shared_ptr<Mover> moving = moverOf(mover);
            cprox_options options = optionsOf(given);
            return unlocked(options, [&] { return set.get().nearest(moving->mover, k, options, threadWorkspace()); });
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
            return askBatch(points, radius, threads, [&](const std::vector<cprox_mover> &movers, Pool &pool) {
              return set.batch().distance(movers, options, pool);
            });
          },
          py::arg("points"), py::arg("radius") = 0.0, py::arg("threads") = 0,
          "The distance of each of N Bézier curves, points (N, n, 3): a dict of arrays (N,) lower, upper, t, "
          "obstacle,\n"
          "verdict, status. threads 0: as many as the machine has.")
      .def(
          "tolerance_batch",
          [](const ObstacleSet &set, const Array &points, double delta, double radius, unsigned threads,
             const py::kwargs &given) {
            const cprox_options options = optionsOf(given);
            return askBatch(points, radius, threads, [&](const std::vector<cprox_mover> &movers, Pool &pool) {
              return set.batch().tolerance(movers, delta, options, pool);
            });
          },
          py::arg("points"), py::arg("delta"), py::arg("radius") = 0.0, py::arg("threads") = 0,
          "Whether each of N Bézier curves is farther than delta [m] everywhere; as distance_batch(). verdict: 0 "
          "clear,\n"
          "1 violated, 2 undecided.");

  module.def(
      "distance",
      [](const py::object &mover, const py::object &obstacles, const py::kwargs &given) {
        return ask(mover, obstacles, given, cprox_distance, [](auto o, auto m, auto options, auto w, auto r) {
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
            mover, obstacles, given,
            [&](auto m, auto o, auto options, auto w, auto r) { return cprox_tolerance(m, o, delta, options, w, r); },
            [&](auto o, auto m, auto options, auto w, auto r) {
              return cprox_obstacles_tolerance(o, m, delta, options, w, r, nullptr);
            });
      },
      py::arg("mover"), py::arg("obstacles"), py::arg("delta"), "Is the mover farther than delta >= 0 [m] everywhere?");
  module.def(
      "collision",
      [](const py::object &mover, const py::object &obstacles, const py::kwargs &given) {
        return ask(mover, obstacles, given, cprox_collision, [](auto o, auto m, auto options, auto w, auto r) {
          return cprox_obstacles_collision(o, m, options, w, r, nullptr);
        });
      },
      py::arg("mover"), py::arg("obstacles"), "Does the mover touch or overlap an obstacle anywhere?");
  module.def(
      "time_of_contact",
      [](const py::object &mover, const py::object &obstacles, const py::kwargs &given) {
        return ask(mover, obstacles, given, cprox_time_of_contact, cprox_obstacles_time_of_contact);
      },
      py::arg("mover"), py::arg("obstacles"), "Where the mover first touches: in [t_contact_lower, t]. Never late.");
  module.def(
      "pair",
      [](const Obstacle &a, const Obstacle &b, const py::kwargs &given) {
        cprox_options options = optionsOf(given);
        return unlocked(options, [&] { return pair(a.obstacle, b.obstacle, options, threadWorkspace()); });
      },
      py::arg("a"), py::arg("b"), "The signed distance of two shapes that stand [m].");
  module.def(
      "translating_distance",
      [](const Obstacle &a, const Obstacle &b, const Array &velocity_a, const Array &velocity_b, double duration,
         const py::kwargs &given) {
        const cprox_options options = optionsOf(given);
        const cprox_translating first = {a.obstacle, toVector(velocity_a, "velocity_a")},
                                second = {b.obstacle, toVector(velocity_b, "velocity_b")};
        return translatingDistance(first, second, duration, options, threadWorkspace());
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
        return unlocked(options,
                        [&] { return translatingContact(first, second, duration, options, threadWorkspace()); });
      },
      py::arg("a"), py::arg("b"), py::arg("velocity_a"), py::arg("velocity_b"), py::arg("duration"),
      "When two convex shapes that translate first touch: in [t_contact_lower, t]. Never late.");
  module.def(
      "growth_distance",
      [](const Obstacle &a, const Obstacle &b, const py::kwargs &given) {
        const cprox_options options = optionsOf(given);
        const cprox_growth growth = growthDistance(a.obstacle, b.obstacle, options, threadWorkspace());
        py::dict out;
        out["status"] = cprox_status_name(growth.status);
        out["lower"] = growth.lower;
        out["upper"] = growth.upper;
        out["normal"] = fromVector(growth.normal);
        return out;
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
        py::dict out;
        out["status"] = cprox_status_name(growth.status);
        out["lower"] = growth.lower;
        out["upper"] = growth.upper;
        out["normal"] = fromVector(growth.normal);
        out["valid"] = d.valid;
        out["valid_position"] = d.valid_position;
        out["reason"] = d.valid ? "" : cprox_workspace_error(workspace.get());
        out["a_position"] = fromVector(d.a_position);
        out["a_rotation"] = fromVector(d.a_rotation);
        out["b_position"] = fromVector(d.b_position);
        out["b_rotation"] = fromVector(d.b_rotation);
        out["touch"] = fromVector(d.touch);
        return out;
      },
      py::arg("a"), py::arg("b"),
      "growth_distance with its derivatives: also valid, valid_position, reason, a_position, a_rotation, b_position,\n"
      "b_rotation, touch (where the scaled shapes touch).");
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
