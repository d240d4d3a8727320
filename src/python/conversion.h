/* SPDX-License-Identifier: BSD-3-Clause */
/** Between NumPy arrays and the types of the C library. Arrays of float64 in C order are read in place. */
#ifndef CURVE_PROXIMITY_PYTHON_CONVERSION_H
#define CURVE_PROXIMITY_PYTHON_CONVERSION_H

#include <optional>
#include <string>
#include <vector>

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <curve_proximity/core.hpp>

namespace curve_proximity::python {

namespace py = pybind11;

/** An array of float64 in C order; others are copied into one. */
using Array = py::array_t<double, py::array::c_style | py::array::forcecast>;

/** A body, as Python holds it. */
struct Shape {
  BodyHandle body;
};

/** A curve, as Python holds it. */
struct Curve {
  CurveHandle curve;
};

/** An array (n, 3) as n vectors, in place. Throws Error that names `what` for any other shape. */
struct Points {
  Points(const Array &array, const char *what);
  const cprox_vec3 *data;
  std::size_t size;
};

/** Three numbers. */
cprox_vec3 toVector(const Array &array, const char *what);

/** A homogeneous matrix (4, 4) whose linear part is a rotation; None: the identity. */
Eigen::Isometry3d toTransform(const std::optional<Array> &matrix);

/** A vector as an array (3,). */
Array fromVector(const cprox_vec3 &v);

/** Writes a vector into row i of an array (n, 3). */
void setRow(Array &rows, py::ssize_t i, const cprox_vec3 &v);

/** A transform as an array (4, 4). */
Array fromTransform(const Eigen::Isometry3d &transform);

/** The workspace of the calling thread. */
Workspace &threadWorkspace();

/** For options.stop: Ctrl-C ends a query. The core asks now and then. */
bool interrupted(void *);

/** Runs a query that asks interrupted(), without the GIL. Ctrl-C ends it with KeyboardInterrupt. */
template <typename Ask>
auto unlocked(const Ask &ask) {
  try {
    auto answer = [&] {
      const py::gil_scoped_release release;
      return ask();
    }();
    if (!PyErr_Occurred()) return answer;
  } catch (const std::exception &) {
    if (!PyErr_Occurred()) throw;
  }
  throw py::error_already_set();
}

/* Each adds the classes and functions of its file to the module. */
void addShapes(py::module &module);
void addCurves(py::module &module);
void addQueries(py::module &module);
void addRobots(py::module &module);
void addMovers(py::module &module);
void addRoadmaps(py::module &module);

} // namespace curve_proximity::python
#endif
