/* SPDX-License-Identifier: BSD-3-Clause */
/* The module cprox._cprox: conversions, errors, and what the other files add. */
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

Workspace &threadWorkspace() {
  thread_local Workspace workspace;
  return workspace;
}

bool interrupted(void *) {
  const py::gil_scoped_acquire gil;
  return PyErr_Occurred() || PyErr_CheckSignals() != 0;
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
  python::addRobots(module);
  python::addMovers(module);
  python::addRoadmaps(module);
}
