/* SPDX-License-Identifier: BSD-3-Clause */
/* Curves: each as a kind of cprox_curve_description, with its points read in place. */
#include <map>

#include "conversion.h"

namespace curve_proximity::python {
namespace {

Curve make(cprox_curve_kind kind, const Array &points, double t0, double t1) {
  const Points p(points, "points");
  cprox_curve_description d = detail::describe(kind, t0, t1);
  d.points = p.data, d.n = p.size;
  return Curve{detail::makeCurve(d)};
}

std::shared_ptr<CurveNumbers> numbersOf(cprox_curve_kind kind, const Array &start, double t0, double t1,
                                        std::size_t n) {
  auto out = std::make_shared<CurveNumbers>();
  out->description = detail::describe(kind, t0, t1);
  out->description.start = toVector(start, kind == CPROX_CURVE_INVOLUTE ? "centre" : "start");
  out->n = n;
  return out;
}

/* Rational, with weights. */
std::shared_ptr<CurveNumbers> numbersOf(cprox_curve_kind kind, const Eigen::Matrix3Xd &points,
                                        const std::vector<double> &weights, double t0, double t1) {
  if (weights.size() != static_cast<std::size_t>(points.cols())) throw Error("a curve needs as many weights as points");
  auto out = std::make_shared<CurveNumbers>();
  out->points = points, out->weights = weights, out->n = weights.size();
  out->description = detail::describe(kind, out->points, t0, t1);
  out->description.weights = out->weights.data();
  return out;
}

Curve make(const std::shared_ptr<CurveNumbers> &numbers) {
  return Curve{detail::makeCurve(numbers->description), py::none(), numbers};
}

Array jacobian(const Curve &curve, double t) {
  if (!curve.numbers) throw Error("the points of this curve alone define it, or other curves do: it has no Jacobian");
  if (!(t >= cprox_curve_get_info(curve.curve.get()).t0 && t <= cprox_curve_get_info(curve.curve.get()).t1))
    throw Error("t is not in the range of the curve");
  Array out({static_cast<py::ssize_t>(curve.numbers->n), py::ssize_t{3}});
  auto *to = reinterpret_cast<cprox_vec3 *>(out.mutable_data());
  if (cprox_curve_jacobian(&curve.numbers->description, t, to) != CPROX_OK)
    throw Error("the curve has no derivatives here: it turns too often, or the circles of its Dubins path coincide");
  return out;
}

std::vector<double> toNumbers(const Array &array, const char *name) {
  if (array.ndim() != 1) throw Error(std::string(name) + " must be an array of shape (n,)");
  return {array.data(), array.data() + array.size()};
}

Eigen::Map<const Eigen::Matrix3Xd> toColumns(const Array &points) {
  const Points p(points, "points");
  return {points.data(), 3, static_cast<Eigen::Index>(p.size)};
}

cprox_dubins_word toWord(const std::string &word) {
  static const std::map<std::string, cprox_dubins_word> words = {{"shortest", CPROX_DUBINS_SHORTEST},
                                                                 {"lsl", CPROX_DUBINS_LSL},
                                                                 {"lsr", CPROX_DUBINS_LSR},
                                                                 {"rsl", CPROX_DUBINS_RSL},
                                                                 {"rsr", CPROX_DUBINS_RSR},
                                                                 {"rlr", CPROX_DUBINS_RLR},
                                                                 {"lrl", CPROX_DUBINS_LRL}};
  const auto found = words.find(word);
  if (found == words.end())
    throw Error("'" + word + "' is no word of a Dubins path: shortest, lsl, lsr, rsl, rsr, rlr, lrl");
  return found->second;
}

/* Point, first and second derivative at each t, as the caller wants them. */
Array evaluate(const Curve &curve, const Array &t, int derivative) {
  if (derivative < 0 || derivative > 2) throw Error("derivative must be 0, 1 or 2");
  if (t.ndim() > 1) throw Error("t must be a number or an array of shape (n,)");
  Workspace &workspace = threadWorkspace();
  std::vector<py::ssize_t> shape(t.shape(), t.shape() + t.ndim());
  shape.push_back(3);
  Array out(shape);
  auto *to = reinterpret_cast<cprox_vec3 *>(out.mutable_data());
  for (py::ssize_t i = 0; i < t.size(); ++i)
    require(cprox_curve_evaluate(curve.curve.get(), t.data()[i], workspace.get(), derivative == 0 ? to + i : nullptr,
                                 derivative == 1 ? to + i : nullptr, derivative == 2 ? to + i : nullptr),
            workspace);
  return out;
}

} // namespace

void addCurves(py::module &module) {
  py::class_<Curve>(module, "Curve", "A parametric curve on [t0, t1]. Immutable, shared by threads.")
      .def_property_readonly(
          "t0", [](const Curve &c) { return cprox_curve_get_info(c.curve.get()).t0; }, "Start.")
      .def_property_readonly(
          "t1", [](const Curve &c) { return cprox_curve_get_info(c.curve.get()).t1; }, "End.")
      .def_property_readonly(
          "n_pieces", [](const Curve &c) { return cprox_curve_get_info(c.curve.get()).n_pieces; }, "Polynomial pieces.")
      .def("restrict",
           recorded("Curve.restrict",
                    [](const Curve &c, double t0, double t1) {
                      return Curve{restrictCurve(c.curve, t0, t1), py::none(), c.numbers};
                    }),
           py::arg("t0"), py::arg("t1"), "The part of the curve on [t0, t1]; its points keep their parameters.")
      .def("__call__", &evaluate, py::arg("t"), py::arg("derivative") = 0,
           "The point at t, or the first or second derivative: (3,) for a number, (n, 3) for an array (n,).")
      .def(
          "jacobian", &jacobian, py::arg("t"),
          "The derivatives of the point at t by the numbers that define the curve: (n, 3), in the order of\n"
          "cprox_curve_jacobian(). clothoid: heading, curvature, curvature_rate. dubins: start_heading, end_heading,\n"
          "radius, x and y of start, of end. involute: heading, radius. pythagorean_hodograph: the preimage, row by "
          "row.\nrational_bezier, nurbs: the weights. jacobian(g['t']) @ g['mover'] are the derivatives of a distance\n"
          "whose distance_gradient() is g. By start or centre they are g['mover'].")
      .def("__reduce__", [](const Curve &c) { return remake(c.made, "this Curve cannot be pickled"); });

  define(
      module, "bezier",
      [](const Array &points, double t0, double t1) { return make(CPROX_CURVE_BEZIER, points, t0, t1); },
      py::arg("points"), py::arg("t0") = 0.0, py::arg("t1") = 1.0,
      "A Bézier curve; points (n, 3) [m]. It begins at t0 and ends at t1; Curve.restrict() makes parts.");
  define(
      module, "bspline",
      [](const Array &points, std::size_t degree, const Array &knots, std::optional<double> t0,
         std::optional<double> t1) {
        const Points p(points, "points");
        if (knots.ndim() != 1) throw Error("knots must be an array of shape (n + degree + 1,)");
        const auto n_knots = static_cast<std::size_t>(knots.shape(0));
        const bool fits = degree < n_knots && p.size < n_knots;
        cprox_curve_description d =
            detail::describe(CPROX_CURVE_BSPLINE, t0.value_or(fits ? knots.data()[degree] : 0.0),
                             t1.value_or(fits ? knots.data()[p.size] : 1.0));
        d.points = p.data, d.n = p.size, d.degree = degree, d.knots = knots.data(), d.n_knots = n_knots;
        return Curve{detail::makeCurve(d)};
      },
      py::arg("points"), py::arg("degree"), py::arg("knots"), py::arg("t0") = py::none(), py::arg("t1") = py::none(),
      "A B-spline curve; points (n, 3) [m], knots (n + degree + 1,), non-decreasing. Its range is that of the knots:\n"
      "[knots[degree], knots[n]].");
  define(
      module, "polynomial",
      [](const Array &coefficients, double t0, double t1) {
        return make(CPROX_CURVE_POLYNOMIAL, coefficients, t0, t1);
      },
      py::arg("coefficients"), py::arg("t0") = 0.0, py::arg("t1") = 1.0, "The sum of coefficients[k] t^k; (n, 3).");
  define(
      module, "trigonometric",
      [](const Array &coefficients, double t0, double t1) {
        return make(CPROX_CURVE_TRIGONOMETRIC, coefficients, t0, t1);
      },
      py::arg("coefficients"), py::arg("t0"), py::arg("t1"),
      "A trigonometric series; the rows of coefficients (2 k + 1, 3) belong to 1, cos t, sin t, cos 2t, …");
  define(
      module, "clothoid",
      [](const Array &start, double heading, double curvature, double curvature_rate, double t0, double t1) {
        const auto numbers = numbersOf(CPROX_CURVE_CLOTHOID, start, t0, t1, 3);
        cprox_curve_description &d = numbers->description;
        d.heading = heading, d.curvature = curvature, d.curvature_rate = curvature_rate;
        return make(numbers);
      },
      py::arg("start"), py::arg("heading"), py::arg("curvature"), py::arg("curvature_rate"), py::arg("t0"),
      py::arg("t1"),
      "A clothoid in a plane z = const; heading [rad] and curvature [1/m] are those at t = 0, t is the arc length.");
  define(
      module, "dubins",
      [](const Array &start, double start_heading, const Array &end, double end_heading, double radius,
         const std::string &word) {
        const auto numbers = numbersOf(CPROX_CURVE_DUBINS, start, 0.0, 0.0, 7);
        cprox_curve_description &d = numbers->description;
        d.heading = start_heading, d.end = toVector(end, "end"), d.end_heading = end_heading, d.radius = radius;
        d.word = toWord(word);
        return make(numbers);
      },
      py::arg("start"), py::arg("start_heading"), py::arg("end"), py::arg("end_heading"), py::arg("radius"),
      py::arg("word") = "shortest", "The shortest Dubins path, or that of a word ('lsl', …); t is the arc length.");
  define(
      module, "involute",
      [](const Array &centre, double heading, double radius, double t0, double t1) {
        const auto numbers = numbersOf(CPROX_CURVE_INVOLUTE, centre, t0, t1, 2);
        numbers->description.heading = heading, numbers->description.radius = radius;
        return make(numbers);
      },
      py::arg("centre"), py::arg("heading"), py::arg("radius"), py::arg("t0"), py::arg("t1"),
      "The involute of a circle; it leaves the circle at t = 0 in the direction of the heading [rad].");
  define(
      module, "pythagorean_hodograph",
      [](const Array &start, const Array &preimage, double t0, double t1) {
        if (preimage.ndim() != 2 || preimage.shape(1) != 4) throw Error("preimage must be an array of shape (n, 4)");
        const auto numbers =
            numbersOf(CPROX_CURVE_PYTHAGOREAN_HODOGRAPH, start, t0, t1, static_cast<std::size_t>(preimage.size()));
        for (const double *q = preimage.data(); q != preimage.data() + preimage.size(); q += 4)
          numbers->preimage.push_back({q[0], q[1], q[2], q[3]});
        cprox_curve_description &d = numbers->description;
        d.preimage = numbers->preimage.data(), d.n = numbers->preimage.size();
        return make(numbers);
      },
      py::arg("start"), py::arg("preimage"), py::arg("t0") = 0.0, py::arg("t1") = 1.0,
      "A Pythagorean-hodograph curve by the Bernstein coefficients of its preimage, quaternions (w, x, y, z): (n, 4).");
  define(
      module, "legendre",
      [](const Array &coefficients, double t0, double t1) { return make(CPROX_CURVE_LEGENDRE, coefficients, t0, t1); },
      py::arg("coefficients"), py::arg("t0") = 0.0, py::arg("t1") = 1.0,
      "The sum of coefficients[k] P_k((2t - t0 - t1)/(t1 - t0)); (n, 3).");
  define(
      module, "lagrange",
      [](const Array &points, const Array &nodes, double t0, double t1) {
        return Curve{makeLagrange(toColumns(points), toNumbers(nodes, "nodes"), t0, t1)};
      },
      py::arg("points"), py::arg("nodes"), py::arg("t0"), py::arg("t1"),
      "The polynomial that passes points[i] at nodes[i]; (n, 3) and (n,).");
  define(
      module, "rational_bezier",
      [](const Array &points, const Array &weights, double t0, double t1) {
        return make(numbersOf(CPROX_CURVE_RATIONAL_BEZIER, toColumns(points), toNumbers(weights, "weights"), t0, t1));
      },
      py::arg("points"), py::arg("weights"), py::arg("t0") = 0.0, py::arg("t1") = 1.0,
      "A rational Bézier curve; points (n, 3) [m], weights (n,) > 0.");
  define(
      module, "nurbs",
      [](const Array &points, const Array &weights, std::size_t degree, const Array &knots, std::optional<double> t0,
         std::optional<double> t1) {
        const std::vector<double> k = toNumbers(knots, "knots");
        const auto columns = toColumns(points);
        const auto n = static_cast<std::size_t>(columns.cols());
        const bool fits = degree < k.size() && n < k.size();
        const auto numbers = numbersOf(CPROX_CURVE_NURBS, columns, toNumbers(weights, "weights"),
                                       t0.value_or(fits ? k[degree] : 0.0), t1.value_or(fits ? k[n] : 1.0));
        numbers->knots = k;
        cprox_curve_description &d = numbers->description;
        d.degree = degree, d.knots = numbers->knots.data(), d.n_knots = k.size();
        return make(numbers);
      },
      py::arg("points"), py::arg("weights"), py::arg("degree"), py::arg("knots"), py::arg("t0") = py::none(),
      py::arg("t1") = py::none(), "A NURBS curve: a B-spline with weights (n,) > 0.");
  define(
      module, "piecewise",
      [](const std::vector<Curve> &curves, const std::vector<double> &ends, double gap) {
        std::vector<CurveHandle> handles;
        for (const Curve &one : curves) handles.push_back(one.curve);
        return Curve{makePiecewise(handles, ends, gap)};
      },
      py::arg("curves"), py::arg("ends") = std::vector<double>{}, py::arg("gap") = 0.0,
      "Curves end to end, on their own ranges or on those between `ends`; gap [m] allowed between them.");
}

} // namespace curve_proximity::python
