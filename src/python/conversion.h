/* SPDX-License-Identifier: BSD-3-Clause */
/** Between NumPy arrays and the types of the C library. Arrays of float64 in C order are read in place. */
#ifndef CURVE_PROXIMITY_PYTHON_CONVERSION_H
#define CURVE_PROXIMITY_PYTHON_CONVERSION_H

#include <memory>
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

/** A body, as Python holds it. made: by which function, with what arguments; for pickle. */
struct Shape {
  BodyHandle body;
  py::object made = py::none();
};

/** What cprox_curve_jacobian() reads of a curve: its description, and what that refers to. */
struct CurveNumbers {
  cprox_curve_description description{};
  std::size_t n = 0; /**< of derivatives */
  Eigen::Matrix3Xd points;
  std::vector<double> weights, knots;
  std::vector<cprox_quat> preimage;
};

/** A curve, as Python holds it. */
struct Curve {
  CurveHandle curve;
  py::object made = py::none();
  std::shared_ptr<const CurveNumbers> numbers = nullptr; /**< null: its points alone define it, or other curves */
};

/** An answer of the core. asked: a verdict was; of a distance it has no meaning. */
struct Result {
  cprox_result result;
  bool asked;
};

/** An array (n, 3) as n vectors, in place. Throws Error that names `what` for any other shape. */
struct Points {
  Points(const Array &array, const char *what);
  const cprox_vec3 *data;
  std::size_t size;
};

/** An argument, for pickle: arrays are copied, as their owner may change them. */
py::object kept(const Array &array);
py::object kept(const py::object &given);
template <typename Value>
py::object kept(const Value &value) {
  if constexpr (std::is_base_of_v<py::object, Value>)
    return kept(static_cast<const py::object &>(value));
  else
    return py::cast(value);
}

inline py::object &madeOf(Shape &shape) {
  return shape.made;
}
inline py::object &madeOf(Curve &curve) {
  return curve.made;
}
template <typename Kind>
py::object &madeOf(const std::shared_ptr<Kind> &one) {
  return one->made;
}

/** A constructor that keeps its name in the package and its arguments in what it makes. */
template <typename Make, typename Out, typename... Given>
auto recorded(const char *name, const Make &make, Out (Make::*)(Given...) const) {
  return [name, make](Given... given) -> Out {
    Out out = make(given...);
    madeOf(out) = py::make_tuple(name, kept(given)...);
    return out;
  };
}
template <typename Make>
auto recorded(const char *name, const Make &make) {
  return recorded(name, make, &Make::operator());
}

/** Adds a function whose results can be pickled. */
template <typename Make, typename... Extra>
void define(py::module &module, const char *name, const Make &make, const Extra &...extra) {
  module.def(name, recorded(name, make), extra...);
}

/** For __reduce__: made is a tuple of a name in the package and arguments. Throws TypeError with `why` where there is
 *  none. */
py::tuple remake(const py::object &made, const char *why);

/** pickle of this class is a TypeError that says why. */
template <typename Class>
void refusePickle(Class &type, const char *why) {
  type.def("__reduce__", [why](const py::object &) { return remake(py::none(), why); });
}

/** Three numbers. */
cprox_vec3 toVector(const Array &array, const char *what);

/** An array of whole numbers from `least` to `most`, in C order. Throws Error that names `what` for others, which a
 * cast would cut or wrap. An empty array may be of any kind. */
using Whole = py::array_t<std::int64_t, py::array::c_style | py::array::forcecast>;
Whole toWhole(const py::object &given, const char *what, std::int64_t least, std::int64_t most);

/** A homogeneous matrix (4, 4) whose linear part is a rotation; None: the identity. */
Eigen::Isometry3d toTransform(const std::optional<Array> &matrix);

/** A vector as an array (3,). */
Array fromVector(const cprox_vec3 &v);

/** Writes a vector into row i of an array (n, 3). */
void setRow(Array &rows, py::ssize_t i, const cprox_vec3 &v);

/** A transform as an array (4, 4). */
Array fromTransform(const Eigen::Isometry3d &transform);

/** The workspace of the calling thread; within a callback another one, since the first is in use. */
Workspace &threadWorkspace();

/** While Python code runs inside a query: what it asks gets a workspace of its own. */
class Callback {
 public:
  Callback();
  ~Callback();
  Callback(const Callback &) = delete;
  Callback &operator=(const Callback &) = delete;
};

/** What Python functions raise while a query calls them, for the caller of the query. One a query, on the stack of the
 *  thread that asks; the threads of pools have one together. Everything but takeFromPools() under the GIL. */
class CallbackErrors {
 public:
  CallbackErrors();
  ~CallbackErrors();
  CallbackErrors(const CallbackErrors &) = delete;
  CallbackErrors &operator=(const CallbackErrors &) = delete;

  /** Keeps the first one that a function ("a distance function") raised. */
  static void keep(const char *function, const py::error_already_set &raised);

  /** What a function has raised on the thread of a pool is the caller's. */
  static void takeFromPools();

  /** Has a function raised? */
  bool any() const;

  /** Throws a ValueError with the cause; what is no Exception (KeyboardInterrupt, SystemExit) as it is. */
  [[noreturn]] void raise();

 private:
  struct Raised {
    std::string function;
    std::optional<py::error_already_set> error;
  };

  static Raised &ofPools();

  Raised raised_;
  Raised *outer_;
};

/** For options.stop: Ctrl-C ends a query, and so does what a callback raised. The core asks now and then. */
bool interrupted(void *);

/** Runs what calls Python functions, and throws what these raise. */
template <typename Ask>
auto withCallbacks(const Ask &ask) {
  CallbackErrors errors;
  try {
    auto answer = ask();
    if (!PyErr_Occurred() && !errors.any()) return answer;
  } catch (const std::exception &) {
    if (!PyErr_Occurred() && !errors.any()) throw;
  }
  if (errors.any()) errors.raise();
  throw py::error_already_set();
}

/** Runs a query that asks interrupted(), without the GIL. Ctrl-C ends it with KeyboardInterrupt. */
template <typename Ask>
auto unlocked(const Ask &ask) {
  return withCallbacks([&] {
    const py::gil_scoped_release release;
    return ask();
  });
}

/** A whole number from 0 to 2^32 - 1; any other number is a ValueError. */
struct Count {
  std::uint32_t value;
  operator std::uint32_t() const {
    return value;
  }
};

/** The number of an argument. Throws Error that names it for a number that is none, TypeError for what is no number. */
std::uint32_t toCount(py::handle given, const std::string &name);

/** What was given, for a message: its type, and in few words its value. */
std::string whatIs(py::handle given);

/* Each adds the classes and functions of its file to the module. */
void addShapes(py::module &module);
void addCurves(py::module &module);
void addQueries(py::module &module);
void addScenes(py::module &module);
void addMotions(py::module &module);
void addMovers(py::module &module);
void addRoadmaps(py::module &module);
void addGaps(py::module &module);

} // namespace curve_proximity::python

namespace pybind11::detail {

template <>
struct type_caster<curve_proximity::python::Count> {
  PYBIND11_TYPE_CASTER(curve_proximity::python::Count, _("int"));

  bool load(handle given, bool) {
    if (PyNumber_Check(given.ptr()) == 0) return false;
    value = {curve_proximity::python::toCount(given, "max_nodes")};
    return true;
  }

  static handle cast(const curve_proximity::python::Count &count, return_value_policy, handle) {
    return PyLong_FromUnsignedLong(count.value);
  }
};

} // namespace pybind11::detail
#endif
