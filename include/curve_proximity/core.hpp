/* SPDX-License-Identifier: BSD-3-Clause */
/** The C library in C++: owning handles, exceptions, Eigen types.
 *
 *  Header-only over libcprox, without ROS. Metres and radians throughout. Bodies and
 *  curves are immutable and may be shared by any number of threads; a Workspace belongs to one thread at a time. */
#ifndef CURVE_PROXIMITY_CORE_HPP
#define CURVE_PROXIMITY_CORE_HPP

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <Eigen/Geometry>
#include <exception>
#include <functional>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <curve_proximity/cprox.h>

namespace curve_proximity {

/** A body in its own frame, with shared ownership. Never null when a function below returned it. */
using BodyHandle = std::shared_ptr<const cprox_body>;

/** A compiled curve, with shared ownership. */
using CurveHandle = std::shared_ptr<const cprox_curve>;

/** A failed call. what() is one line that says what is wrong, and where. */
class Error : public std::runtime_error {
 public:
  /** reason: the error message. */
  explicit Error(const std::string &reason, cprox_status status = CPROX_INVALID)
      : std::runtime_error(reason), status_(status) {}

  /** CPROX_INVALID or CPROX_MEMORY. */
  cprox_status status() const {
    return status_;
  }

 private:
  cprox_status status_;
};

/** All memory that queries of one thread need. Movable, not copyable. The constructor throws Error if memory is out. */
class Workspace {
 public:
  Workspace() : handle_(cprox_workspace_create()) {
    if (!handle_) throw Error(cprox_status_text(CPROX_MEMORY), CPROX_MEMORY);
  }

  /** The C handle, owned by this object. */
  cprox_workspace *get() const {
    return handle_.get();
  }

  /** [bytes] What it holds. */
  std::size_t bytes() const {
    return cprox_workspace_bytes(handle_.get());
  }

  /** Why the last call did not end with CPROX_OK; "" where it did. */
  std::string reason() const {
    return cprox_workspace_error(handle_.get());
  }

 private:
  struct Free {
    void operator()(cprox_workspace *handle) const {
      cprox_workspace_free(handle);
    }
  };
  std::unique_ptr<cprox_workspace, Free> handle_;
};

/** Throws Error with the workspace's error message if the status is negative; otherwise returns the status. */
inline cprox_status require(cprox_status status, const Workspace &workspace) {
  if (status >= 0) return status;
  const std::string reason = workspace.reason();
  throw Error(reason.empty() ? cprox_status_text(status) : reason, status);
}

/* ---- Eigen and C ---- */

/** From Eigen to C. */
inline cprox_vec3 toVec3(const Eigen::Vector3d &v) {
  return {v.x(), v.y(), v.z()};
}

/** From C to Eigen. */
inline Eigen::Vector3d toEigen(const cprox_vec3 &v) {
  return {v.x, v.y, v.z};
}

/** The pose of a rigid transform. A rotation part that is exactly the identity gives exactly the identity quaternion;
 *  any other is rounded to within 16 2^-53 of a turn. The linear part must be a rotation. */
inline cprox_pose toPose(const Eigen::Isometry3d &transform) {
  const Eigen::Quaterniond q(transform.linear());
  return {toVec3(transform.translation()), {q.w(), q.x(), q.y(), q.z()}};
}

/** The transform of a pose; the quaternion need not be normalised. Throws Error for one of norm 0 or not finite. */
inline Eigen::Isometry3d toIsometry(const cprox_pose &pose) {
  const cprox_quat &o = pose.orientation;
  Eigen::Quaterniond q(o.w, o.x, o.y, o.z);
  const double largest = q.coeffs().cwiseAbs().maxCoeff();
  if (!q.coeffs().allFinite()) throw Error("the quaternion is not finite");
  if (!(largest > 0.0)) throw Error("the quaternion's norm is 0");
  q.coeffs() /= largest; // so that neither tiny nor huge ones leave the range of double
  Eigen::Isometry3d transform = Eigen::Isometry3d::Identity();
  transform.linear() = q.normalized().toRotationMatrix();
  transform.translation() = toEigen(pose.position);
  return transform;
}

/** The columns of a matrix as C vectors. */
inline std::vector<cprox_vec3> toVec3s(const Eigen::Matrix3Xd &points) {
  std::vector<cprox_vec3> out(static_cast<std::size_t>(points.cols()));
  for (Eigen::Index i = 0; i < points.cols(); ++i) out[static_cast<std::size_t>(i)] = toVec3(points.col(i));
  return out;
}

/* ---- makers: each as the function of cprox/body.h or cprox/curve.h of that name, throwing Error ---- */

/** Asked now and then while the BVH of a body is built; true: the maker throws Error. Null: never. It throws nothing.
 */
using Stop = std::function<bool()>;

namespace detail {

/** The columns as the C library reads them, in place. */
inline const cprox_vec3 *columns(const Eigen::Matrix3Xd &points) {
  static_assert(sizeof(cprox_vec3) == 3 * sizeof(double), "a column is a cprox_vec3");
  return reinterpret_cast<const cprox_vec3 *>(points.data());
}

/** Runs a C constructor of a body and takes the handle over. `keep` lives as long as the body. */
template <typename Create, typename Keep = std::nullptr_t>
BodyHandle makeBody(Create create, Keep keep = nullptr, const Stop &stop = nullptr) {
  Workspace workspace;
  if (stop) {
    const auto call = [](void *user) { return (*static_cast<const Stop *>(user))(); };
    cprox_workspace_set_stop(workspace.get(), call, const_cast<Stop *>(&stop));
  }
  cprox_body *body = nullptr;
  require(create(workspace.get(), &body), workspace);
  return BodyHandle(body, [keep](const cprox_body *b) {
    (void)keep;
    cprox_body_free(const_cast<cprox_body *>(b));
  });
}

/** Makes the curve of a description and takes the handle over. `keep` lives as long as the curve. */
template <typename Keep = std::nullptr_t>
CurveHandle createCurve(const cprox_curve_description &description, Workspace &workspace, Keep keep = nullptr) {
  cprox_curve *curve = nullptr;
  require(cprox_curve_create(&description, workspace.get(), &curve), workspace);
  return CurveHandle(curve, [keep](const cprox_curve *c) {
    (void)keep;
    cprox_curve_free(const_cast<cprox_curve *>(c));
  });
}

/** The same with a workspace of its own. */
template <typename Keep = std::nullptr_t>
CurveHandle makeCurve(const cprox_curve_description &description, Keep keep = nullptr) {
  Workspace workspace;
  return createCurve(description, workspace, keep);
}

/** The description of a kind over [t0, t1], without its other members. */
inline cprox_curve_description describe(cprox_curve_kind kind, double t0, double t1) {
  cprox_curve_description d{};
  d.kind = kind, d.t0 = t0, d.t1 = t1;
  return d;
}

/** The same with points or coefficients, which stay the matrix's. */
inline cprox_curve_description describe(cprox_curve_kind kind, const Eigen::Matrix3Xd &points, double t0, double t1) {
  cprox_curve_description d = describe(kind, t0, t1);
  d.points = columns(points), d.n = static_cast<std::size_t>(points.cols());
  return d;
}

} // namespace detail

/** A point. */
inline BodyHandle makePoint(const Eigen::Vector3d &point) {
  return detail::makeBody(
      [&](cprox_workspace *w, cprox_body **b) { return cprox_body_create_point(toVec3(point), w, b); });
}

/** A sphere about the origin; radius > 0 [m]. */
inline BodyHandle makeSphere(double radius) {
  return detail::makeBody([&](cprox_workspace *w, cprox_body **b) { return cprox_body_create_sphere(radius, w, b); });
}

/** A box about the origin; size: full edge lengths [m]. */
inline BodyHandle makeBox(const Eigen::Vector3d &size) {
  return detail::makeBody(
      [&](cprox_workspace *w, cprox_body **b) { return cprox_body_create_box(toVec3(size), w, b); });
}

/** A capsule along z about the origin; height: between the centres of the hemispheres [m]. */
inline BodyHandle makeCapsule(double height, double radius) {
  return detail::makeBody(
      [&](cprox_workspace *w, cprox_body **b) { return cprox_body_create_capsule(height, radius, w, b); });
}

/** A cylinder along z about the origin. */
inline BodyHandle makeCylinder(double height, double radius) {
  return detail::makeBody(
      [&](cprox_workspace *w, cprox_body **b) { return cprox_body_create_cylinder(height, radius, w, b); });
}

/** A cone along z about mid-height, with the apex at +z. */
inline BodyHandle makeCone(double height, double radius) {
  return detail::makeBody(
      [&](cprox_workspace *w, cprox_body **b) { return cprox_body_create_cone(height, radius, w, b); });
}

/** An ellipsoid about the origin. */
inline BodyHandle makeEllipsoid(const Eigen::Vector3d &semi_axes) {
  return detail::makeBody(
      [&](cprox_workspace *w, cprox_body **b) { return cprox_body_create_ellipsoid(toVec3(semi_axes), w, b); });
}

/** The halfspace normal·x + offset <= 0. */
inline BodyHandle makeHalfspace(const Eigen::Vector3d &normal, double offset) {
  return detail::makeBody(
      [&](cprox_workspace *w, cprox_body **b) { return cprox_body_create_halfspace(toVec3(normal), offset, w, b); });
}

/** A superquadric: the sum of |x_i/semi_axes_i|^exponents_i is <= 1. */
inline BodyHandle makeSuperquadric(const Eigen::Vector3d &semi_axes, const Eigen::Vector3d &exponents) {
  return detail::makeBody([&](cprox_workspace *w, cprox_body **b) {
    return cprox_body_create_superquadric(toVec3(semi_axes), toVec3(exponents), w, b);
  });
}

/** The intersection of hyperquadrics, each a list of terms [a, b, c, d, n], planes [b1, b2, b3, c] and quadrics
 *  [q11, q12, q13, q22, q23, q33, b1, b2, b3, c]. */
inline BodyHandle makeImplicit(const std::vector<std::vector<std::array<double, 5>>> &hyperquadrics,
                               const std::vector<std::array<double, 4>> &planes,
                               const std::vector<std::array<double, 10>> &quadrics) {
  std::vector<cprox_hyperquadric> lists;
  for (const auto &terms : hyperquadrics)
    lists.push_back({reinterpret_cast<const double(*)[5]>(terms.data()), terms.size()});
  cprox_implicit_description description = {};
  description.hyperquadrics = lists.data();
  description.n_hyperquadrics = lists.size();
  description.planes = reinterpret_cast<const double(*)[4]>(planes.data());
  description.n_planes = planes.size();
  description.quadrics = reinterpret_cast<const double(*)[10]>(quadrics.data());
  description.n_quadrics = quadrics.size();
  return detail::makeBody(
      [&](cprox_workspace *w, cprox_body **b) { return cprox_body_create_implicit(&description, nullptr, w, b); });
}

/** A superquadric or implicit body deformed: the image under x -> linear x + translation, and with other exponents, one
 *  for each term; none: as they are. Both sides of a pair may be deformed from query to query. */
inline BodyHandle makeDeformed(const BodyHandle &body, const Eigen::Matrix3d &linear,
                               const Eigen::Vector3d &translation = Eigen::Vector3d::Zero(),
                               const std::vector<double> &exponents = {}) {
  cprox_implicit_description description = {};
  description.deformed = body.get();
  description.exponents = exponents.empty() ? nullptr : exponents.data();
  description.n_exponents = exponents.size();
  cprox_affine map = {{}, toVec3(translation)};
  for (Eigen::Index i = 0; i < 9; ++i) map.linear[i] = linear(i / 3, i % 3);
  return detail::makeBody(
      [&](cprox_workspace *w, cprox_body **b) { return cprox_body_create_implicit(&description, &map, w, b); });
}

/** The convex hull of points, one a column, in any order and of any dimension. */
inline BodyHandle makePolytope(const Eigen::Matrix3Xd &vertices) {
  const std::vector<cprox_vec3> points = toVec3s(vertices);
  return detail::makeBody([&](cprox_workspace *w, cprox_body **b) {
    return cprox_body_create_polytope(points.data(), points.size(), w, b);
  });
}

/** A point cloud: a ball of the radius >= 0 about each column. memory_limit: the largest size of the body in bytes. */
inline BodyHandle makePoints(const Eigen::Matrix3Xd &points, double radius = 0.0,
                             std::size_t memory_limit = std::numeric_limits<std::size_t>::max(),
                             const Stop &stop = nullptr) {
  const auto create = [&](cprox_workspace *w, cprox_body **b) {
    return cprox_body_create_points(detail::columns(points), static_cast<std::size_t>(points.cols()), radius,
                                    memory_limit, w, b);
  };
  return detail::makeBody(create, nullptr, stop);
}

/** Solid axis-aligned boxes from low.col(i) to high.col(i). Both matrices have as many columns. */
inline BodyHandle makeBoxes(const Eigen::Matrix3Xd &low, const Eigen::Matrix3Xd &high,
                            std::size_t memory_limit = std::numeric_limits<std::size_t>::max(),
                            const Stop &stop = nullptr) {
  if (low.cols() != high.cols()) throw Error("boxes need as many low corners as high ones");
  const auto create = [&](cprox_workspace *w, cprox_body **b) {
    return cprox_body_create_boxes(detail::columns(low), detail::columns(high), static_cast<std::size_t>(low.cols()),
                                   memory_limit, w, b);
  };
  return detail::makeBody(create, nullptr, stop);
}

/** A triangle mesh. Each column of `triangles` holds three column indices of `vertices`, from 0. */
inline BodyHandle makeMesh(const Eigen::Matrix3Xd &vertices, const Eigen::Matrix<int, 3, Eigen::Dynamic> &triangles,
                           cprox_mesh_fill fill = CPROX_MESH_FILL_SURFACE,
                           std::size_t memory_limit = std::numeric_limits<std::size_t>::max(),
                           const Stop &stop = nullptr) {
  // An index below 0 becomes one that is out of range.
  const Eigen::Matrix<std::uint32_t, 3, Eigen::Dynamic> indices = triangles.cast<std::uint32_t>();
  const auto create = [&](cprox_workspace *w, cprox_body **b) {
    return cprox_body_create_mesh(detail::columns(vertices), static_cast<std::size_t>(vertices.cols()),
                                  reinterpret_cast<const std::uint32_t(*)[3]>(indices.data()),
                                  static_cast<std::size_t>(indices.cols()), fill, memory_limit, w, b);
  };
  return detail::makeBody(create, nullptr, stop);
}

/** A mesh without its inside; it shares the triangles and keeps the mesh alive. */
inline BodyHandle makeSurface(const BodyHandle &mesh) {
  return detail::makeBody(
      [&](cprox_workspace *w, cprox_body **b) { return cprox_body_create_surface(mesh.get(), w, b); }, mesh);
}

/** A mesh, point cloud or set of boxes with its convex hull as a fast first test. It keeps both alive.
 *  excess: no point of the mesh is farther than this from the hull [m], >= 0. */
inline BodyHandle makeLod(const BodyHandle &hull, double excess, const BodyHandle &mesh) {
  return detail::makeBody(
      [&](cprox_workspace *w, cprox_body **b) { return cprox_body_create_lod(hull.get(), excess, mesh.get(), w, b); },
      std::make_pair(hull, mesh));
}

/** The distance of a point from a set [m]; inside, 0 or minus the depth. */
using DistanceFunction = std::function<double(const Eigen::Vector3d &point)>;

/** A set known by its distance function, which the body keeps: it lies within `radius` [m] of the centre; values are
 *  within `error` [m] of the distance. See cprox_body_create_distance(). A function that throws answers NaN: the maker
 *  and the queries then refuse it. It must be safe to call from all threads that ask. */
inline BodyHandle makeDistance(DistanceFunction distance, const Eigen::Vector3d &centre, double radius,
                               double lipschitz = 1.0, double error = 0.0) {
  if (!distance) throw Error("the distance function is empty");
  const auto kept = std::make_shared<const DistanceFunction>(std::move(distance));
  const cprox_distance_fn call = [](const void *shape, const double point[3]) {
    try {
      return (*static_cast<const DistanceFunction *>(shape))(Eigen::Vector3d(point[0], point[1], point[2]));
    } catch (...) {
      return std::numeric_limits<double>::quiet_NaN();
    }
  };
  return detail::makeBody(
      [&](cprox_workspace *w, cprox_body **b) {
        return cprox_body_create_distance(call, kept.get(), toVec3(centre), radius, lipschitz, error, w, b);
      },
      kept);
}

/** The value of a convex function at a point, and what it writes there: its gradient and its Hessian. */
using ConvexFunction =
    std::function<double(const Eigen::Vector3d &point, Eigen::Vector3d &gradient, Eigen::Matrix3d &hessian)>;

/** The convex body of all points where a convex function, which the body keeps, is <= 0: it lies within `radius` [m] of
 *  `interior`, a point where the function is negative; values are within `error` of the function. planar: of x and y
 *  alone, and the body is flat, at z = 0. margin: a ball that is added [m]. See cprox_body_create_convex_function(). A
 *  function that throws answers NaN: the maker and the queries then refuse it. It must be safe to call from all threads
 *  that ask. */
inline BodyHandle makeConvexFunction(ConvexFunction function, const Eigen::Vector3d &interior, double radius,
                                     double error = 0.0, bool planar = false, double margin = 0.0) {
  if (!function) throw Error("the convex function is empty");
  const auto kept = std::make_shared<const ConvexFunction>(std::move(function));
  const cprox_convex_fn call = [](const void *user, const double point[3], double gradient[3], double hessian[6]) {
    try {
      Eigen::Vector3d g = Eigen::Vector3d::Zero();
      Eigen::Matrix3d h = Eigen::Matrix3d::Zero();
      const double value =
          (*static_cast<const ConvexFunction *>(user))(Eigen::Vector3d(point[0], point[1], point[2]), g, h);
      for (int i = 0; i < 3; ++i) gradient[i] = g[i];
      for (int i = 0, next = 0; i < 3; ++i)
        for (int k = i; k < 3; ++k) hessian[next++] = 0.5 * (h(i, k) + h(k, i));
      return value;
    } catch (...) {
      return std::numeric_limits<double>::quiet_NaN();
    }
  };
  const cprox_convex_function described = {call, kept.get(), toVec3(interior), radius, error, planar};
  return detail::makeBody(
      [&](cprox_workspace *w, cprox_body **b) { return cprox_body_create_convex_function(&described, margin, w, b); },
      kept);
}

/** A grid of distances (ESDF): n[0] n[1] n[2] values, x running fastest, from the origin of the frame on, `cell` [m]
 *  apart. error: of the values [m]; truncated_at: values from here on say "at least so far". */
inline BodyHandle makeDistanceGrid(const std::array<std::size_t, 3> &n, double cell, const std::vector<double> &values,
                                   double error = 0.0, double truncated_at = std::numeric_limits<double>::infinity()) {
  const double points = static_cast<double>(n[0]) * static_cast<double>(n[1]) * static_cast<double>(n[2]);
  if (points != static_cast<double>(values.size())) throw Error("a distance grid needs one value for each point");
  const cprox_distance_grid grid = {{n[0], n[1], n[2]}, {0.0, 0.0, 0.0}, cell, values.data(), error, truncated_at};
  return detail::makeBody(
      [&](cprox_workspace *w, cprox_body **b) { return cprox_body_create_distance_grid(&grid, w, b); });
}

/** The mesh of a height field: n[0] n[1] heights [m], x running fastest, from the origin of the frame on, `cell` [m]
 *  apart. It is solid down to the floor; NaN: a surface. */
inline BodyHandle makeHeightField(const std::array<std::size_t, 2> &n, const std::array<double, 2> &cell,
                                  const std::vector<double> &heights,
                                  double floor = std::numeric_limits<double>::quiet_NaN(),
                                  std::size_t memory_limit = std::numeric_limits<std::size_t>::max(),
                                  const Stop &stop = nullptr) {
  if (static_cast<double>(n[0]) * static_cast<double>(n[1]) != static_cast<double>(heights.size()))
    throw Error("a height field needs one height for each point");
  const cprox_height_field field = {{n[0], n[1]}, {0.0, 0.0}, {cell[0], cell[1]}, heights.data(), floor};
  const auto create = [&](cprox_workspace *w, cprox_body **b) {
    return cprox_body_create_height_field(&field, memory_limit, w, b);
  };
  return detail::makeBody(create, nullptr, stop);
}

/** A planar convex polygon at z = 0; the vertices are columns, in order. */
inline BodyHandle makePolygon(const Eigen::Matrix2Xd &vertices) {
  std::vector<std::array<double, 2>> points(static_cast<std::size_t>(vertices.cols()));
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto column = static_cast<Eigen::Index>(i);
    points[i] = {vertices(0, column), vertices(1, column)};
  }
  return detail::makeBody([&](cprox_workspace *w, cprox_body **b) {
    return cprox_body_create_polygon(reinterpret_cast<const double(*)[2]>(points.data()), points.size(), w, b);
  });
}

/** The union of convex bodies, each at its pose. It keeps its parts alive. There are as many poses as parts. */
inline BodyHandle makeCompound(const std::vector<BodyHandle> &parts, const std::vector<Eigen::Isometry3d> &poses) {
  if (parts.size() != poses.size()) throw Error("a compound needs as many poses as parts");
  std::vector<const cprox_body *> handles;
  std::vector<cprox_pose> placed;
  for (const BodyHandle &part : parts) handles.push_back(part.get());
  for (const Eigen::Isometry3d &pose : poses) placed.push_back(toPose(pose));
  return detail::makeBody(
      [&](cprox_workspace *w, cprox_body **b) {
        return cprox_body_create_compound(handles.data(), placed.data(), handles.size(), w, b);
      },
      parts);
}

/** A Bézier curve on [t0, t1]; a column a control point. */
inline CurveHandle makeBezier(const Eigen::Matrix3Xd &points, double t0 = 0.0, double t1 = 1.0) {
  return detail::makeCurve(detail::describe(CPROX_CURVE_BEZIER, points, t0, t1));
}

/** A B-spline curve on [t0, t1]; a column a control point, points.cols() + degree + 1 knots. */
inline CurveHandle makeBspline(const Eigen::Matrix3Xd &points, std::size_t degree, const std::vector<double> &knots,
                               double t0, double t1) {
  cprox_curve_description d = detail::describe(CPROX_CURVE_BSPLINE, points, t0, t1);
  d.degree = degree, d.knots = knots.data(), d.n_knots = knots.size();
  return detail::makeCurve(d);
}

/** sum of coefficients.col(k) t^k on [t0, t1]. */
inline CurveHandle makePolynomial(const Eigen::Matrix3Xd &coefficients, double t0, double t1) {
  return detail::makeCurve(detail::describe(CPROX_CURVE_POLYNOMIAL, coefficients, t0, t1));
}

/** sum of coefficients.col(k) P_k((2t - t0 - t1)/(t1 - t0)). */
inline CurveHandle makeLegendre(const Eigen::Matrix3Xd &coefficients, double t0, double t1) {
  return detail::makeCurve(detail::describe(CPROX_CURVE_LEGENDRE, coefficients, t0, t1));
}

/** The polynomial through points.col(i) at nodes[i], restricted to [t0, t1]. */
inline CurveHandle makeLagrange(const Eigen::Matrix3Xd &points, const std::vector<double> &nodes, double t0,
                                double t1) {
  cprox_curve_description d = detail::describe(CPROX_CURVE_LAGRANGE, points, t0, t1);
  d.knots = nodes.data(), d.n_knots = nodes.size();
  return detail::makeCurve(d);
}

/** A trigonometric series; the columns belong to 1, cos t, sin t, cos 2t, sin 2t, … */
inline CurveHandle makeTrigonometric(const Eigen::Matrix3Xd &coefficients, double t0, double t1) {
  return detail::makeCurve(detail::describe(CPROX_CURVE_TRIGONOMETRIC, coefficients, t0, t1));
}

/** A rational Bézier curve on [t0, t1]; a weight > 0 for each column. */
inline CurveHandle makeRationalBezier(const Eigen::Matrix3Xd &points, const std::vector<double> &weights,
                                      double t0 = 0.0, double t1 = 1.0) {
  if (weights.size() != static_cast<std::size_t>(points.cols())) throw Error("a curve needs as many weights as points");
  cprox_curve_description d = detail::describe(CPROX_CURVE_RATIONAL_BEZIER, points, t0, t1);
  d.weights = weights.data();
  return detail::makeCurve(d);
}

/** A NURBS curve on [t0, t1]: a B-spline with a weight > 0 for each column. */
inline CurveHandle makeNurbs(const Eigen::Matrix3Xd &points, const std::vector<double> &weights, std::size_t degree,
                             const std::vector<double> &knots, double t0, double t1) {
  if (weights.size() != static_cast<std::size_t>(points.cols())) throw Error("a curve needs as many weights as points");
  cprox_curve_description d = detail::describe(CPROX_CURVE_NURBS, points, t0, t1);
  d.degree = degree, d.knots = knots.data(), d.n_knots = knots.size(), d.weights = weights.data();
  return detail::makeCurve(d);
}

/** A part of a curve: points keep their parameters. It stands at the pose; a curve known by its arc length takes none
 *  but the identity. */
inline CurveHandle restrictCurve(const CurveHandle &curve, double t0, double t1,
                                 const Eigen::Isometry3d &pose = Eigen::Isometry3d::Identity()) {
  const cprox_curve *whole = curve.get();
  cprox_curve_description d = detail::describe(CPROX_CURVE_PART, t0, t1);
  d.curves = &whole, d.n = 1;
  const cprox_pose placed = toPose(pose);
  if (!pose.matrix().isIdentity(0.0)) d.pose = &placed;
  return detail::makeCurve(d, curve);
}

/** The derivatives of the curve's point at t by the n numbers that define it, one a column, as cprox_curve_jacobian().
 *  Throws Error where there are none. */
inline Eigen::Matrix3Xd curveJacobian(const cprox_curve_description &description, double t, std::size_t n) {
  Eigen::Matrix3Xd out(3, static_cast<Eigen::Index>(n));
  if (cprox_curve_jacobian(&description, t, reinterpret_cast<cprox_vec3 *>(out.data())) != CPROX_OK)
    throw Error("the curve has no numbers beside its points, or no derivatives by them", CPROX_INVALID);
  return out;
}

/** A clothoid: at `start` with the heading and curvature at t = 0, t being arc length. */
inline CurveHandle makeClothoid(const Eigen::Vector3d &start, double heading, double curvature, double curvature_rate,
                                double t0, double t1) {
  cprox_curve_description d = detail::describe(CPROX_CURVE_CLOTHOID, t0, t1);
  d.start = toVec3(start), d.heading = heading, d.curvature = curvature, d.curvature_rate = curvature_rate;
  return detail::makeCurve(d);
}

/** A Dubins path over [0, its length]; cprox_curve_info.dubins says what it consists of. */
inline CurveHandle makeDubins(const Eigen::Vector3d &start, double start_heading, const Eigen::Vector3d &end,
                              double end_heading, double radius, cprox_dubins_word word = CPROX_DUBINS_SHORTEST) {
  cprox_curve_description d = detail::describe(CPROX_CURVE_DUBINS, 0.0, 0.0);
  d.start = toVec3(start), d.heading = start_heading, d.end = toVec3(end), d.end_heading = end_heading;
  d.radius = radius, d.word = word;
  return detail::makeCurve(d);
}

/** The involute of a circle; it leaves the circle at t = 0 in the direction of the angle. */
inline CurveHandle makeInvolute(const Eigen::Vector3d &centre, double radius, double angle, double t0, double t1) {
  cprox_curve_description d = detail::describe(CPROX_CURVE_INVOLUTE, t0, t1);
  d.start = toVec3(centre), d.radius = radius, d.heading = angle;
  return detail::makeCurve(d);
}

/** A Pythagorean-hodograph curve by the Bernstein coefficients of its preimage; planar ones have x = y = 0. */
inline CurveHandle makePythagoreanHodograph(const Eigen::Vector3d &start,
                                            const std::vector<Eigen::Quaterniond> &preimage, double t0 = 0.0,
                                            double t1 = 1.0) {
  std::vector<cprox_quat> a;
  for (const Eigen::Quaterniond &q : preimage) a.push_back({q.w(), q.x(), q.y(), q.z()});
  cprox_curve_description d = detail::describe(CPROX_CURVE_PYTHAGOREAN_HODOGRAPH, t0, t1);
  d.start = toVec3(start), d.preimage = a.data(), d.n = a.size();
  return detail::makeCurve(d);
}

/** Curves end to end. `ends`: empty, for their own ranges, or one more than there are curves. */
inline CurveHandle makePiecewise(const std::vector<CurveHandle> &curves, const std::vector<double> &ends = {},
                                 double gap = 0.0) {
  std::vector<const cprox_curve *> handles;
  for (const CurveHandle &curve : curves) handles.push_back(curve.get());
  cprox_curve_description d = detail::describe(CPROX_CURVE_PIECEWISE, 0.0, 0.0);
  d.curves = handles.data(), d.n = handles.size(), d.gap = gap;
  d.knots = ends.empty() ? nullptr : ends.data(), d.n_knots = ends.size();
  return detail::makeCurve(d);
}

/** A smooth curve given by functions, as cprox_smooth_curve. */
struct SmoothCurve {
  std::function<std::array<Eigen::Vector3d, 3>(double)> evaluate; /**< value and two derivatives at t */
  std::function<double(double, double)> sixth;                    /**< bound of the sixth derivative on [a, b] */
  std::array<double, 3> error = {{0.0, 0.0, 0.0}};                /**< errors of value and derivatives */
  double accuracy = 1e-12;                                        /**< [m] of the compiled curve */
};

/** Compiles a smooth curve. Exceptions of the functions are rethrown. */
inline CurveHandle makeSmooth(const SmoothCurve &functions, double t0, double t1) {
  if (!functions.evaluate || !functions.sixth) throw Error("a smooth curve needs both its functions");
  struct Call {
    const SmoothCurve &functions;
    std::exception_ptr thrown;
  } call = {functions, nullptr};
  cprox_smooth_curve c{};
  c.evaluate = [](void *user, double t, cprox_vec3 jet[3]) {
    auto *self = static_cast<Call *>(user);
    try {
      const std::array<Eigen::Vector3d, 3> d = self->functions.evaluate(t);
      for (std::size_t k = 0; k < 3; ++k) jet[k] = toVec3(d[k]);
    } catch (...) {
      if (!self->thrown) self->thrown = std::current_exception();
    }
  };
  c.sixth = [](void *user, double a, double b) {
    auto *self = static_cast<Call *>(user);
    try {
      return self->functions.sixth(a, b);
    } catch (...) {
      if (!self->thrown) self->thrown = std::current_exception();
      return std::numeric_limits<double>::quiet_NaN();
    }
  };
  c.user = &call;
  for (std::size_t k = 0; k < 3; ++k) c.error[k] = functions.error[k];
  c.accuracy = functions.accuracy;
  cprox_curve_description d = detail::describe(CPROX_CURVE_SMOOTH, t0, t1);
  d.smooth = &c;
  try {
    return detail::makeCurve(d);
  } catch (const Error &) {
    if (call.thrown) std::rethrow_exception(call.thrown);
    throw;
  }
}

/** A curve given by points and arc lengths, as cprox_rectifiable_curve; `length` or `velocity` may be empty.
 *
 *  Queries call the functions from their own threads. An exception ends the query with an Error that says where. */
struct RectifiableCurve {
  std::function<Eigen::Vector3d(double)> point;    /**< the point at t */
  std::function<double(double, double)> length;    /**< an upper bound of the arc length of [a, b] */
  std::function<Eigen::Vector3d(double)> velocity; /**< the derivative at t */
  double error = 0.0;                              /**< [m] of a point */
  double velocity_error = 0.0;                     /**< [m/unit of t] of a velocity */
  double quadrature_error = 0.0;                   /**< relative error of the quadrature of the arc length */
};

/** Makes a curve from points and arc lengths. The functions live as long as the curve. */
inline CurveHandle makeRectifiable(RectifiableCurve functions, double t0, double t1) {
  const auto keep = std::make_shared<RectifiableCurve>(std::move(functions));
  cprox_rectifiable_curve c{};
  if (keep->point) {
    c.point = [](void *user, double t, cprox_vec3 *point) {
      try {
        *point = toVec3(static_cast<RectifiableCurve *>(user)->point(t));
      } catch (...) { // no exception may pass through C: the point stays the NaN that it was
      }
    };
  }
  if (keep->length) {
    c.length = [](void *user, double a, double b) {
      try {
        return static_cast<RectifiableCurve *>(user)->length(a, b);
      } catch (...) {
        return std::numeric_limits<double>::quiet_NaN();
      }
    };
  }
  if (keep->velocity) {
    c.velocity = [](void *user, double t, cprox_vec3 *velocity) {
      try {
        *velocity = toVec3(static_cast<RectifiableCurve *>(user)->velocity(t));
      } catch (...) { // as for points
      }
    };
  }
  c.user = keep.get();
  c.error = keep->error, c.velocity_error = keep->velocity_error, c.quadrature_error = keep->quadrature_error;
  cprox_curve_description d = detail::describe(CPROX_CURVE_RECTIFIABLE, t0, t1);
  d.rectifiable = &c;
  return detail::makeCurve(d, keep);
}

/* ---- the queries: as in cprox/query.h, throwing Error where there is no answer -------------------------------------
 * */

/** A body at a pose. The body is kept by reference, so the BodyHandle must outlive the result. margin >= 0 [m]. */
inline cprox_obstacle at(const BodyHandle &body, const Eigen::Isometry3d &pose = Eigen::Isometry3d::Identity(),
                         double margin = 0.0) {
  return cprox_with_margin(cprox_obstacle_at(body.get(), toPose(pose)), margin);
}
cprox_obstacle at(BodyHandle &&body, const Eigen::Isometry3d &pose = Eigen::Isometry3d::Identity(),
                  double margin = 0.0) = delete; // the obstacle would dangle

/** A ball of the radius (0: a point) along the curve, which must outlive the mover. */
inline cprox_mover along(const CurveHandle &curve, double radius = 0.0) {
  return cprox_tube_along(curve.get(), radius);
}
cprox_mover along(CurveHandle &&curve, double radius = 0.0) = delete;

/** A ball whose radius changes: at each parameter it is the x of the second curve. Both must outlive the mover. */
inline cprox_mover along(const CurveHandle &curve, const CurveHandle &radius) {
  cprox_mover mover = cprox_point_along(curve.get());
  mover.radius_curve = radius.get();
  return mover;
}
cprox_mover along(CurveHandle &&curve, const CurveHandle &radius) = delete;
cprox_mover along(const CurveHandle &curve, CurveHandle &&radius) = delete;
cprox_mover along(CurveHandle &&curve, CurveHandle &&radius) = delete;

/** The least distance, as cprox_distance(). */
inline cprox_result distance(const cprox_mover &mover, const cprox_obstacle &obstacle, const cprox_options &options,
                             Workspace &workspace) {
  cprox_result result{};
  require(cprox_distance(mover, obstacle, &options, workspace.get(), &result), workspace);
  return result;
}

/** The tolerance verdict, as cprox_tolerance(). */
inline cprox_result tolerance(const cprox_mover &mover, const cprox_obstacle &obstacle, double delta,
                              const cprox_options &options, Workspace &workspace) {
  cprox_result result{};
  require(cprox_tolerance(mover, obstacle, delta, &options, workspace.get(), &result), workspace);
  return result;
}

/** The collision verdict, as cprox_collision(). */
inline cprox_result collision(const cprox_mover &mover, const cprox_obstacle &obstacle, const cprox_options &options,
                              Workspace &workspace) {
  cprox_result result{};
  require(cprox_collision(mover, obstacle, &options, workspace.get(), &result), workspace);
  return result;
}

/** The signed distance of a static pair, as cprox_pair(). */
inline cprox_result pair(const cprox_obstacle &a, const cprox_obstacle &b, const cprox_options &options,
                         Workspace &workspace) {
  cprox_result result{};
  require(cprox_pair(a, b, &options, workspace.get(), &result), workspace);
  return result;
}

/** Whether a static pair is farther apart than delta [m], as cprox_pair_tolerance(); delta 0: whether it touches. */
inline cprox_result pairTolerance(const cprox_obstacle &a, const cprox_obstacle &b, double delta,
                                  const cprox_options &options, Workspace &workspace) {
  cprox_result result{};
  require(cprox_pair_tolerance(a, b, delta, &options, workspace.get(), &result), workspace);
  return result;
}

/** When a moving vertex (the first point) touches a moving triangle, as cprox_ccd_vertex_face(); margin [m]. */
inline cprox_ccd ccdVertexFace(const std::array<Eigen::Vector3d, 4> &start, const std::array<Eigen::Vector3d, 4> &end,
                               double margin, const cprox_options &options, Workspace &workspace) {
  cprox_ccd ccd{};
  const std::array<cprox_vec3, 4> from{toVec3(start[0]), toVec3(start[1]), toVec3(start[2]), toVec3(start[3])};
  const std::array<cprox_vec3, 4> to{toVec3(end[0]), toVec3(end[1]), toVec3(end[2]), toVec3(end[3])};
  require(cprox_ccd_vertex_face(from.data(), to.data(), margin, &options, workspace.get(), &ccd), workspace);
  return ccd;
}

/** When two moving edges (two points each) touch, as cprox_ccd_edge_edge(); margin [m]. */
inline cprox_ccd ccdEdgeEdge(const std::array<Eigen::Vector3d, 4> &start, const std::array<Eigen::Vector3d, 4> &end,
                             double margin, const cprox_options &options, Workspace &workspace) {
  cprox_ccd ccd{};
  const std::array<cprox_vec3, 4> from{toVec3(start[0]), toVec3(start[1]), toVec3(start[2]), toVec3(start[3])};
  const std::array<cprox_vec3, 4> to{toVec3(end[0]), toVec3(end[1]), toVec3(end[2]), toVec3(end[3])};
  require(cprox_ccd_edge_edge(from.data(), to.data(), margin, &options, workspace.get(), &ccd), workspace);
  return ccd;
}

/** A body that moves on from where it stands, without turning; velocity [m/s], world frame. */
inline cprox_translating translating(const cprox_obstacle &from, const Eigen::Vector3d &velocity) {
  return {from, toVec3(velocity)};
}

/** The least distance of two convex bodies that translate for the duration [s], as cprox_translating_distance(). */
inline cprox_result translatingDistance(const cprox_translating &a, const cprox_translating &b, double duration,
                                        const cprox_options &options, Workspace &workspace) {
  cprox_result result{};
  require(cprox_translating_distance(a, b, duration, &options, workspace.get(), &result), workspace);
  return result;
}

/** When two convex bodies that translate first touch, as cprox_translating_contact(). */
inline cprox_result translatingContact(const cprox_translating &a, const cprox_translating &b, double duration,
                                       const cprox_options &options, Workspace &workspace) {
  cprox_result result{};
  require(cprox_translating_contact(a, b, duration, &options, workspace.get(), &result), workspace);
  return result;
}

/** The least factor by which two convex bodies, each scaled about its centre, touch, as cprox_growth_distance(). */
inline cprox_growth growthDistance(const cprox_obstacle &a, const cprox_obstacle &b, const cprox_options &options,
                                   Workspace &workspace) {
  cprox_growth growth{};
  require(cprox_growth_distance(a, b, &options, workspace.get(), &growth), workspace);
  return growth;
}

/** A growth distance with its derivatives by the poses of both bodies, as cprox_growth_gradient(). */
inline cprox_growth growthGradient(const cprox_obstacle &a, const cprox_obstacle &b, const cprox_options &options,
                                   Workspace &workspace, cprox_growth_derivatives &derivatives) {
  cprox_growth growth{};
  require(cprox_growth_gradient(a, b, &options, workspace.get(), &growth, &derivatives), workspace);
  return growth;
}

/** The least growth distance along a curve with its derivatives and its parameter t, as cprox_growth_along(). */
inline cprox_growth growthAlong(const cprox_obstacle &a, const cprox_curve *curve, const cprox_obstacle &b,
                                const cprox_options &options, Workspace &workspace, double &t,
                                cprox_growth_derivatives &derivatives) {
  cprox_growth growth{};
  require(cprox_growth_along(a, curve, b, &options, workspace.get(), &growth, &t, &derivatives), workspace);
  return growth;
}

namespace detail {
struct FreeObstacles {
  void operator()(cprox_obstacles *handle) const {
    cprox_obstacles_free(handle);
  }
};
} // namespace detail

/** The C handle of many obstacles, freed with its owner. */
using ObstaclesHandle = std::unique_ptr<cprox_obstacles, detail::FreeObstacles>;

/** cprox_obstacles_create() without an exception: *handle is untouched on failure, and the workspace says why. */
inline cprox_status makeObstacles(const std::vector<cprox_obstacle> &obstacles, cprox_obstacle_index index,
                                  Workspace &workspace, ObstaclesHandle &handle) {
  cprox_obstacles *made = nullptr;
  const cprox_status status = cprox_obstacles_create(obstacles.data(), obstacles.size(), index, workspace.get(), &made);
  if (status == CPROX_OK) handle.reset(made);
  return status;
}

/** Many obstacles behind one handle: cprox_obstacles. Any number of threads may ask, each with its own workspace.
 *  Functions throw Error where there is no answer. */
class Obstacles {
 public:
  /** What the obstacles name must outlive this object. */
  explicit Obstacles(const std::vector<cprox_obstacle> &obstacles, cprox_obstacle_index index = CPROX_INDEX_BVH) {
    Workspace workspace;
    require(makeObstacles(obstacles, index, workspace, handle_), workspace);
  }

  /** The least distance to all of them. */
  cprox_result distance(const cprox_mover &mover, const cprox_options &options, Workspace &workspace) const {
    cprox_result result{};
    require(cprox_obstacles_distance(handle_.get(), mover, &options, workspace.get(), &result, nullptr), workspace);
    return result;
  }

  /** The tolerance verdict; delta >= 0 [m]. */
  cprox_result tolerance(const cprox_mover &mover, double delta, const cprox_options &options,
                         Workspace &workspace) const {
    cprox_result result{};
    require(cprox_obstacles_tolerance(handle_.get(), mover, delta, &options, workspace.get(), &result, nullptr),
            workspace);
    return result;
  }

  /** The collision verdict. */
  cprox_result collision(const cprox_mover &mover, const cprox_options &options, Workspace &workspace) const {
    cprox_result result{};
    require(cprox_obstacles_collision(handle_.get(), mover, &options, workspace.get(), &result, nullptr), workspace);
    return result;
  }

  /** The time of contact. */
  cprox_result timeOfContact(const cprox_mover &mover, const cprox_options &options, Workspace &workspace) const {
    cprox_result result{};
    require(cprox_obstacles_time_of_contact(handle_.get(), mover, &options, workspace.get(), &result), workspace);
    return result;
  }

  /** The k >= 1 nearest, in ascending order. */
  std::vector<cprox_result> nearest(const cprox_mover &mover, std::size_t k, const cprox_options &options,
                                    Workspace &workspace) const {
    std::vector<cprox_result> results(std::min(k, size()));
    cprox_listed listed{};
    require(cprox_obstacles_nearest(handle_.get(), mover, k, &options, workspace.get(), results.data(), &listed),
            workspace);
    results.resize(listed.count);
    return results;
  }

  /** How many there are. */
  std::size_t size() const {
    return cprox_obstacles_get_info(handle_.get()).n;
  }

  /** The C handle, owned by this object. */
  const cprox_obstacles *get() const {
    return handle_.get();
  }

 private:
  ObstaclesHandle handle_;
};

} // namespace curve_proximity
#endif
