/* SPDX-License-Identifier: BSD-3-Clause */
/* The module cprox._cprox: conversions, errors, and what the other files add. */
#include <deque>
#include <limits>
#include <new>

#include "conversion.h"

namespace curve_proximity::python {

Points::Points(const Array &array, const char *what) {
  if (array.ndim() != 2 || array.shape(1) != 3)
    throw Error(std::string(what) + " must be an array of shape (n, 3), got " + std::to_string(array.ndim()) +
                " dimensions" + (array.ndim() == 2 ? " and rows of " + std::to_string(array.shape(1)) : ""));
  static_assert(sizeof(cprox_vec3) == 3 * sizeof(double), "a row is a cprox_vec3");
  data = reinterpret_cast<const cprox_vec3 *>(array.data());
  size = static_cast<std::size_t>(array.shape(0));
}

py::object kept(const Array &array) {
  return array.attr("copy")();
}

py::object kept(const py::object &given) {
  return py::module::import("copy").attr("deepcopy")(given);
}

py::tuple remake(const py::object &made, const char *why) {
  if (made.is_none()) throw py::type_error(why);
  return py::make_tuple(py::module::import("cprox").attr("_make"), made);
}

cprox_vec3 toVector(const Array &array, const char *what) {
  if (array.ndim() != 1 || array.shape(0) != 3) throw Error(std::string(what) + " must be three numbers");
  return {array.at(0), array.at(1), array.at(2)};
}

Eigen::Isometry3d toTransform(const std::optional<Array> &matrix) {
  Eigen::Isometry3d out = Eigen::Isometry3d::Identity();
  if (!matrix) return out;
  if (matrix->ndim() != 2 || matrix->shape(0) != 4 || matrix->shape(1) != 4)
    throw Error("a pose must be a homogeneous matrix of shape (4, 4)");
  for (int i = 0; i < 4; ++i)
    for (int k = 0; k < 4; ++k) out.matrix()(i, k) = matrix->at(i, k);
  if (!out.matrix().allFinite()) throw Error("a pose must be finite");
  const Eigen::Matrix3d r = out.linear();
  const bool rotates = (r.transpose() * r).isIdentity(1e-9) && r.determinant() > 0.0;
  if (!rotates || !out.matrix().row(3).isApprox(Eigen::RowVector4d(0, 0, 0, 1)))
    throw Error("a pose must be a rigid transform: its upper left part a rotation, its last row 0, 0, 0, 1");
  return out;
}

Array fromVector(const cprox_vec3 &v) {
  Array out(3);
  double *to = out.mutable_data();
  to[0] = v.x, to[1] = v.y, to[2] = v.z;
  return out;
}

void setRow(Array &rows, py::ssize_t i, const cprox_vec3 &v) {
  double *to = rows.mutable_data(i, 0);
  to[0] = v.x, to[1] = v.y, to[2] = v.z;
}

Array fromTransform(const Eigen::Isometry3d &transform) {
  Array out({4, 4});
  for (int i = 0; i < 4; ++i)
    for (int k = 0; k < 4; ++k) out.mutable_at(i, k) = transform.matrix()(i, k);
  return out;
}

namespace {

/* So many callbacks are running on this thread, each inside a query of the one before. */
thread_local std::size_t callbacks = 0;

} // namespace

Workspace &threadWorkspace() {
  thread_local std::deque<Workspace> workspaces; // they stay where they are
  while (workspaces.size() <= callbacks) workspaces.emplace_back();
  return workspaces[callbacks];
}

Callback::Callback() {
  ++callbacks;
}

Callback::~Callback() {
  --callbacks;
}

/* ---- what callbacks raise ---- */

namespace {

thread_local void *errors_of_thread = nullptr;

} // namespace

CallbackErrors::Raised &CallbackErrors::ofPools() {
  static auto *raised = new Raised; // never freed: it may outlive the interpreter
  return *raised;
}

CallbackErrors::CallbackErrors() : outer_(static_cast<Raised *>(errors_of_thread)) {
  errors_of_thread = &raised_;
}

CallbackErrors::~CallbackErrors() {
  errors_of_thread = outer_;
}

void CallbackErrors::keep(const char *function, const py::error_already_set &raised) {
  Raised &to = errors_of_thread ? *static_cast<Raised *>(errors_of_thread) : ofPools();
  if (to.error) return;
  to.function = function;
  to.error.emplace(raised);
}

void CallbackErrors::takeFromPools() {
  const py::gil_scoped_acquire lock;
  Raised &from = ofPools();
  if (from.error && errors_of_thread) keep(from.function.c_str(), *from.error);
  from.error.reset();
}

bool CallbackErrors::any() const {
  return raised_.error.has_value();
}

void CallbackErrors::raise() {
  PyErr_Clear();
  raised_.error->restore();
  PyObject *type = nullptr, *cause = nullptr, *trace = nullptr;
  PyErr_Fetch(&type, &cause, &trace);
  PyErr_NormalizeException(&type, &cause, &trace);
  if (trace) PyException_SetTraceback(cause, trace);
  if (PyErr_GivenExceptionMatches(type, PyExc_Exception) == 0) {
    PyErr_Restore(type, cause, trace);
    throw py::error_already_set();
  }
  const py::object name = py::handle(type).attr("__name__"), value = py::str(py::handle(cause));
  PyErr_SetString(
      PyExc_ValueError,
      (raised_.function + " raised " + std::string(py::str(name)) + ": " + std::string(py::str(value))).c_str());
  Py_XDECREF(type);
  Py_XDECREF(trace);
  PyObject *error = nullptr;
  PyErr_Fetch(&type, &error, &trace);
  PyErr_NormalizeException(&type, &error, &trace);
  PyException_SetCause(error, cause); // takes it over
  PyErr_Restore(type, error, trace);
  throw py::error_already_set();
}

bool interrupted(void *) {
  const Callback callback; // signal handlers may ask anything
  const py::gil_scoped_acquire gil;
  return PyErr_Occurred() || PyErr_CheckSignals() != 0;
}

/* ---- numbers ---- */

std::string whatIs(py::handle given) {
  std::string value = py::str(py::repr(given));
  constexpr std::size_t MOST = 40;
  if (value.size() > MOST) value = value.substr(0, MOST) + "…";
  return value + " (" + std::string(py::str(py::type::handle_of(given).attr("__name__"))) + ")";
}

std::uint32_t toCount(py::handle given, const std::string &name) {
  if (PyNumber_Check(given.ptr()) == 0) throw py::type_error(name + " must be a whole number, got " + whatIs(given));
  const auto number = py::reinterpret_steal<py::object>(PyNumber_Index(given.ptr()));
  long long value = -1;
  if (number) value = PyLong_AsLongLong(number.ptr());
  PyErr_Clear();
  if (value < 0 || value > std::numeric_limits<std::uint32_t>::max())
    throw Error(name + " must be a whole number from 0 to 4294967295, got " + whatIs(given));
  return static_cast<std::uint32_t>(value);
}

Whole toWhole(const py::object &given, const char *what, std::int64_t least, std::int64_t most) {
  const py::array any = py::array::ensure(given);
  if (!any) throw py::type_error(std::string(what) + " must be an array, got " + whatIs(given));
  const std::string kinds = "iub"; // of whole numbers
  if (any.size() > 0 && kinds.find(any.dtype().kind()) == std::string::npos)
    throw Error(std::string(what) + " must be whole numbers, got an array of " + std::string(py::str(any.dtype())));
  Whole out(any);
  for (py::ssize_t i = 0; i < out.size(); ++i) {
    if (out.data()[i] < least || out.data()[i] > most)
      throw Error(std::string(what) + " must be whole numbers from " + std::to_string(least) + " to " +
                  std::to_string(most) + ", got " + std::to_string(out.data()[i]));
  }
  return out;
}

} // namespace curve_proximity::python

PYBIND11_MODULE(_cprox, module) {
  namespace py = pybind11;
  using namespace curve_proximity;
  module.doc() = "Certified proximity queries of continuous motions. Metres, radians, seconds.";
  module.attr("__version__") = cprox_version();

  /* A failed call is a ValueError with the library's message. */
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const Error &e) {
      PyErr_SetString(e.status() == CPROX_MEMORY ? PyExc_MemoryError : PyExc_ValueError, e.what());
    }
  });

  python::addShapes(module);
  python::addCurves(module);
  python::addQueries(module);
  python::addScenes(module);
  python::addMotions(module);
  python::addMovers(module);
  python::addRoadmaps(module);
  python::addGaps(module);
}
