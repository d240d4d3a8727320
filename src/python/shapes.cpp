/* SPDX-License-Identifier: BSD-3-Clause */
/* Shapes: each as the function of cprox/body.h. */
#include "conversion.h"

namespace curve_proximity::python {
namespace {

BodyHandle makeMeshOf(const Array &vertices, const py::object &given, bool solid) {
  const Points points(vertices, "vertices");
  const Whole triangles = toWhole(given, "triangles", 0, std::numeric_limits<std::uint32_t>::max());
  if (triangles.ndim() != 2 || triangles.shape(1) != 3) throw Error("triangles must be an array of shape (m, 3)");
  std::vector<std::array<std::uint32_t, 3>> indices(static_cast<std::size_t>(triangles.shape(0)));
  for (std::size_t i = 0; i < indices.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int64_t index = triangles.at(static_cast<py::ssize_t>(i), static_cast<py::ssize_t>(k));
      if (static_cast<std::size_t>(index) >= points.size)
        throw Error("triangle " + std::to_string(i) + ": there is no vertex " + std::to_string(index));
      indices[i][k] = static_cast<std::uint32_t>(index);
    }
  const BodyHandle body = detail::makeBody([&](cprox_workspace *w, cprox_body **b) {
    return cprox_body_create_mesh(points.data, points.size, reinterpret_cast<const std::uint32_t(*)[3]>(indices.data()),
                                  indices.size(), solid ? CPROX_MESH_FILL_SOLID : CPROX_MESH_FILL_SURFACE,
                                  std::numeric_limits<std::size_t>::max(), w, b);
  });
  if (solid && !cprox_body_get_info(body.get()).is_solid) throw Error("the mesh is not closed, so it has no interior");
  return body;
}

BodyHandle polytopeOf(const Array &vertices) {
  const Points points(vertices, "vertices");
  return detail::makeBody(
      [&](cprox_workspace *w, cprox_body **b) { return cprox_body_create_polytope(points.data, points.size, w, b); });
}

BodyHandle cloudOf(const Array &points, double radius) {
  const Points cloud(points, "points");
  return detail::makeBody([&](cprox_workspace *w, cprox_body **b) {
    return cprox_body_create_points(cloud.data, cloud.size, radius, std::numeric_limits<std::size_t>::max(), w, b);
  });
}

std::vector<double> numbersOf(const Array &values) {
  return {values.data(), values.data() + values.size()};
}

std::size_t extent(const Array &values, py::ssize_t axis) {
  return static_cast<std::size_t>(values.shape(axis));
}

Eigen::Matrix3d linearOf(const Array &matrix) {
  if (matrix.ndim() != 2 || matrix.shape(0) != 3 || matrix.shape(1) != 3)
    throw Error("linear must be an array of shape (3, 3)");
  Eigen::Matrix3d out;
  for (int i = 0; i < 9; ++i) out(i / 3, i % 3) = matrix.at(i / 3, i % 3);
  return out;
}

/* Rows run along y, as of an image. */
BodyHandle heightFieldOf(const Array &heights, const Array &cell, const std::optional<double> &floor) {
  if (heights.ndim() != 2) throw Error("heights must be an array of shape (n_y, n_x)");
  if (cell.ndim() != 1 || cell.shape(0) != 2) throw Error("cell must be two lengths, along x and along y");
  return makeHeightField({extent(heights, 1), extent(heights, 0)}, {cell.at(0), cell.at(1)}, numbersOf(heights),
                         floor ? *floor : std::numeric_limits<double>::quiet_NaN());
}

BodyHandle distanceGridOf(const Array &values, double cell, double error, double truncated_at) {
  if (values.ndim() != 3) throw Error("values must be an array of shape (n_z, n_y, n_x)");
  return makeDistanceGrid({extent(values, 2), extent(values, 1), extent(values, 0)}, cell, numbersOf(values), error,
                          truncated_at);
}

constexpr double NO_NUMBER = std::numeric_limits<double>::quiet_NaN();

/* Keeps a Python function, which may be dropped by any thread. */
std::shared_ptr<py::function> keep(py::function function) {
  return {new py::function(std::move(function)), [](py::function *f) {
            const py::gil_scoped_acquire lock;
            delete f;
          }};
}

/* Calls a Python function at a point inside a query, and hands on what it returned. What it raises, also by an answer
 * of another kind than `wanted`, reaches the caller of the query: the core refuses a value that is no number. Queries
 * let other threads run, so that the lock is taken for each value. */
template <typename Take>
double callAt(const py::function &function, const char *name, const char *wanted, const Eigen::Vector3d &x,
              const Take &take) {
  const Callback callback;
  const py::gil_scoped_acquire lock;
  try {
    const py::object answer = function(py::make_tuple(x.x(), x.y(), x.z()));
    try {
      return take(answer);
    } catch (const py::cast_error &) {
      PyErr_SetString(PyExc_TypeError, (std::string("it must return ") + wanted + ", got " + whatIs(answer)).c_str());
      throw py::error_already_set();
    }
  } catch (py::error_already_set &raised) {
    CallbackErrors::keep(name, raised);
  }
  return NO_NUMBER;
}

BodyHandle distanceOf(py::function function, const Array &centre, double radius, double lipschitz, double error) {
  const auto call = [kept = keep(std::move(function))](const Eigen::Vector3d &x) {
    return callAt(*kept, "a distance function", "a number", x,
                  [](const py::object &answer) { return answer.cast<double>(); });
  };
  return withCallbacks(
      [&] { return makeDistance(call, toEigen(toVector(centre, "centre")), radius, lipschitz, error); });
}

/* function(point) is (value, gradient, Hessian). */
BodyHandle convexOf(py::function function, const Array &interior, double radius, double error, bool planar,
                    double margin) {
  const auto call = [kept = keep(std::move(function))](const Eigen::Vector3d &x, Eigen::Vector3d &gradient,
                                                       Eigen::Matrix3d &hessian) {
    return callAt(*kept, "a convex function", "a value, a gradient (3,) and a Hessian (3, 3)", x,
                  [&](const py::object &answer) {
                    const auto [value, slope, curvature] = answer.cast<std::tuple<double, Array, Array>>();
                    if (slope.ndim() != 1 || slope.shape(0) != 3 || curvature.ndim() != 2 || curvature.shape(0) != 3 ||
                        curvature.shape(1) != 3)
                      throw py::cast_error();
                    for (py::ssize_t i = 0; i < 3; ++i) {
                      gradient[i] = slope.at(i);
                      for (py::ssize_t k = 0; k < 3; ++k) hessian(i, k) = curvature.at(i, k);
                    }
                    return value;
                  });
  };
  return withCallbacks(
      [&] { return makeConvexFunction(call, toEigen(toVector(interior, "interior")), radius, error, planar, margin); });
}

BodyHandle polygonOf(const Array &vertices) {
  if (vertices.ndim() != 2 || vertices.shape(1) != 2) throw Error("vertices must be an array of shape (n, 2)");
  return detail::makeBody([&](cprox_workspace *w, cprox_body **b) {
    return cprox_body_create_polygon(reinterpret_cast<const double(*)[2]>(vertices.data()),
                                     static_cast<std::size_t>(vertices.shape(0)), w, b);
  });
}

BodyHandle compoundOf(const std::vector<Shape> &parts, const std::vector<Array> &poses) {
  std::vector<BodyHandle> bodies;
  for (const Shape &part : parts) bodies.push_back(part.body);
  std::vector<Eigen::Isometry3d> placed;
  for (const Array &pose : poses) placed.push_back(toTransform(pose));
  return makeCompound(bodies, placed);
}

} // namespace

void addShapes(py::module &module) {
  py::class_<Shape>(module, "Shape", "A set of points in its own frame. Immutable, shared by threads.")
      .def("__reduce__", [](const Shape &s) { return remake(s.made, "this Shape cannot be pickled"); });
  define(
      module, "point", [](const Array &position) { return Shape{makePoint(toEigen(toVector(position, "position")))}; },
      py::arg("position") = py::make_tuple(0.0, 0.0, 0.0), "A point (3,) [m].");
  define(
      module, "sphere", [](double radius) { return Shape{makeSphere(radius)}; }, py::arg("radius"),
      "A ball about the origin; radius > 0 [m].");
  define(
      module, "box", [](const Array &size) { return Shape{makeBox(toEigen(toVector(size, "size")))}; }, py::arg("size"),
      "A box about the origin; size (3,): full edge lengths [m].");
  define(
      module, "capsule", [](double height, double radius) { return Shape{makeCapsule(height, radius)}; },
      py::arg("height"), py::arg("radius"),
      "A capsule along z about the origin; height: between the centres of the hemispheres [m].");
  define(
      module, "cylinder", [](double height, double radius) { return Shape{makeCylinder(height, radius)}; },
      py::arg("height"), py::arg("radius"), "A cylinder along z about the origin [m].");
  define(
      module, "cone", [](double height, double radius) { return Shape{makeCone(height, radius)}; }, py::arg("height"),
      py::arg("radius"), "A cone along z about mid-height, apex at +z [m].");
  define(
      module, "ellipsoid",
      [](const Array &semi_axes) { return Shape{makeEllipsoid(toEigen(toVector(semi_axes, "semi_axes")))}; },
      py::arg("semi_axes"), "An ellipsoid about the origin; semi_axes (3,) [m].");
  define(
      module, "halfspace",
      [](const Array &normal, double offset) {
        return Shape{makeHalfspace(toEigen(toVector(normal, "normal")), offset)};
      },
      py::arg("normal"), py::arg("offset"), "The halfspace normal·x + offset <= 0.");
  define(
      module, "superquadric",
      [](const Array &semi_axes, const Array &exponents) {
        return Shape{
            makeSuperquadric(toEigen(toVector(semi_axes, "semi_axes")), toEigen(toVector(exponents, "exponents")))};
      },
      py::arg("semi_axes"), py::arg("exponents"), "The sum of |x_i/semi_axes_i|^exponents_i is <= 1; exponents >= 1.");
  define(
      module, "implicit",
      [](const std::vector<std::vector<std::array<double, 5>>> &hyperquadrics,
         const std::vector<std::array<double, 4>> &planes, const std::vector<std::array<double, 10>> &quadrics) {
        return Shape{makeImplicit(hyperquadrics, planes, quadrics)};
      },
      py::arg("hyperquadrics") = py::list(), py::arg("planes") = py::list(), py::arg("quadrics") = py::list(),
      "An intersection: hyperquadrics, each a list of terms [a, b, c, d, n]; planes [b1, b2, b3, c]; quadrics [q11, "
      "q12, "
      "q13,\nq22, q23, q33, b1, b2, b3, c]. Bounded, with an interior.");
  define(
      module, "deformed",
      [](const Shape &shape, const Array &linear, const Array &translation, const std::vector<double> &exponents) {
        return Shape{
            makeDeformed(shape.body, linearOf(linear), toEigen(toVector(translation, "translation")), exponents)};
      },
      py::arg("shape"), py::arg("linear"), py::arg("translation") = py::make_tuple(0.0, 0.0, 0.0),
      py::arg("exponents") = py::list(),
      "A superquadric or implicit shape under x -> linear x + translation, with other exponents, one a term; none: as "
      "they\nare.");
  define(
      module, "polytope", [](const Array &vertices) { return Shape{polytopeOf(vertices)}; }, py::arg("vertices"),
      "The convex hull of vertices (n, 3) [m], in any order and of any dimension.");
  define(
      module, "polygon", [](const Array &vertices) { return Shape{polygonOf(vertices)}; }, py::arg("vertices"),
      "A convex polygon in the plane z = 0; vertices (n, 2) [m] in order.");
  define(
      module, "mesh",
      [](const Array &vertices, const py::object &triangles, bool solid) {
        return Shape{makeMeshOf(vertices, triangles, solid)};
      },
      py::arg("vertices"), py::arg("triangles"), py::arg("solid") = false,
      "A triangle mesh: vertices (n, 3) [m], triangles (m, 3) of indices from 0. A hollow surface; with solid, a "
      "closed\n"
      "mesh includes its interior, and one that is not closed is a ValueError.");
  define(
      module, "point_cloud", [](const Array &points, double radius) { return Shape{cloudOf(points, radius)}; },
      py::arg("points"), py::arg("radius") = 0.0, "A ball of the radius >= 0 about each of points (n, 3) [m].");
  define(
      module, "height_field",
      [](const Array &heights, const Array &cell, const std::optional<double> &floor) {
        return Shape{heightFieldOf(heights, cell, floor)};
      },
      py::arg("heights"), py::arg("cell"), py::arg("floor") = py::none(),
      "The ground below heights (n_y, n_x) [m] that stand cell = (along x, along y) [m] apart, the first one above the "
      "origin:\ntwo triangles a cell. Solid down to the floor; without one, a surface.");
  define(
      module, "distance_grid",
      [](const Array &values, double cell, double error, double truncated_at) {
        return Shape{distanceGridOf(values, cell, error, truncated_at)};
      },
      py::arg("values"), py::arg("cell"), py::arg("error") = 0.0,
      py::arg("truncated_at") = std::numeric_limits<double>::infinity(),
      "The set whose signed distances at grid points are values (n_z, n_y, n_x) [m], cell [m] apart, from the origin "
      "on (an\nESDF); each within error of the distance; those from truncated_at on say \"at least so far\". Nothing "
      "stands beyond the\ngrid. For curves.");
  define(
      module, "distance_function",
      [](const py::function &function, const Array &centre, double radius, double lipschitz, double error) {
        return Shape{distanceOf(function, centre, radius, lipschitz, error)};
      },
      py::arg("function"), py::arg("centre"), py::arg("radius"), py::arg("lipschitz") = 1.0, py::arg("error") = 0.0,
      "The set whose distance from a point (x, y, z) is function(point) [m], negative or 0 inside. It lies within "
      "radius "
      "of\ncentre. Values differ by at most lipschitz times the way, and are within error [m] of the distance: answers "
      "are\ncertified relative to error. Values that contradict this are refused. For curves.");
  define(
      module, "convex_function",
      [](const py::function &function, const Array &interior, double radius, double error, bool planar, double margin) {
        return Shape{convexOf(function, interior, radius, error, planar, margin)};
      },
      py::arg("function"), py::arg("interior"), py::arg("radius"), py::arg("error") = 0.0, py::arg("planar") = false,
      py::arg("margin") = 0.0,
      "The convex body of all points (x, y, z) where a convex function is at most 0. function(point) is a tuple: its "
      "value,\nits gradient (3,) and its Hessian (3, 3). The body lies within radius [m] of interior, where the "
      "function "
      "is\nnegative. Values are within error of the function. planar: of x and y alone, the body is flat, at z = 0. A "
      "function\nthat is seen not to be convex is refused with the places that show it.");
  define(
      module, "compound",
      [](const std::vector<Shape> &parts, const std::vector<Array> &poses) { return Shape{compoundOf(parts, poses)}; },
      py::arg("parts"), py::arg("poses"), "The union of convex shapes, each at its pose (4, 4).");
  module.def(
      "transform",
      [](const Array &position, const std::optional<Array> &quaternion) {
        cprox_pose pose = CPROX_POSE_IDENTITY;
        pose.position = toVector(position, "position");
        if (!toEigen(pose.position).allFinite()) throw Error("position must be finite");
        if (quaternion) {
          if (quaternion->ndim() != 1 || quaternion->shape(0) != 4)
            throw Error("a quaternion is four numbers x, y, z, w");
          pose.orientation = {quaternion->at(3), quaternion->at(0), quaternion->at(1), quaternion->at(2)};
        }
        return fromTransform(toIsometry(pose));
      },
      py::arg("position") = py::make_tuple(0.0, 0.0, 0.0), py::arg("quaternion") = py::none(),
      "A pose (4, 4) of a position (3,) [m] and a quaternion x, y, z, w of any norm but 0.");
}

} // namespace curve_proximity::python
