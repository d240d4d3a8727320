/* SPDX-License-Identifier: BSD-3-Clause */
/** Plain descriptions of shapes, objects and curves, from messages, YAML files and URDF.
 *
 *  Nothing here is checked. makeGeometry() and compile() check a description once. Metres, radians, right-handed
 *  frames. */
#ifndef CURVE_PROXIMITY_DESCRIPTION_HPP
#define CURVE_PROXIMITY_DESCRIPTION_HPP

#include <array>
#include <cstddef>
#include <cstdint>
#include <Eigen/Geometry>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace curve_proximity {

/** Triangles of a mesh: each column holds three vertex indices, from 0. */
using Triangles = Eigen::Matrix<int, 3, Eigen::Dynamic>;

/** The type of a shape, and the meaning of its dimensions:
 *    POINT      none; `vertices` with one column, or none (the origin of `pose`)
 *    SPHERE     [radius]
 *    BOX        [x, y, z] full edge lengths
 *    CAPSULE    [height, radius] along z about mid-height; height between the centres of the hemispheres
 *    CYLINDER   [height, radius] along z about mid-height
 *    CONE       [height, radius] along z about mid-height, apex at +z
 *    ELLIPSOID  [x, y, z] semi-axes
 *    HALFSPACE  [a, b, c, d]: ax + by + cz + d <= 0
 *    SUPERQUADRIC  [a1, a2, a3, n1, n2, n3]: sum |x_i/a_i|^n_i <= 1, exponents 1 … 1000
 *    SUPERELLIPSOID  [a1, a2, a3, e1, e2] (Barr): (|x/a1|^(2/e2) + |y/a2|^(2/e2))^(e2/e1) + |z/a3|^(2/e1) <= 1,
 *               exponents 0.002 … 2: convex
 *    IMPLICIT   none; the intersection of `hyperquadrics`, `planes` and `quadrics`, bounded and with an interior
 *    POLYTOPE   none; the convex hull of `vertices`, solid, of any dimension
 *    POLYGON    none; a convex polygon in the plane z = 0 of its frame; `vertices` in order, with z = 0. For a curve in
 *               its plane the interior of the polygon counts as inside
 *    MESH       none, or a scale [x, y, z]; `vertices` and `triangles`, or `resource`. A hollow surface; with
 *               `solid` its interior too
 *    POINTS     none, or [radius] >= 0: a ball of that radius about each of `vertices` (a point cloud)
 *    OCTREE     none; the occupied cells of `octree`, or of the .bt or .ot file `resource`
 *    HEIGHT_FIELD   [cell_x, cell_y, n_x, n_y] or with a floor; n_x n_y heights in `values`, x running fastest, the
 *               first one above the frame's origin. The ground is solid down to the floor; without one it is a
 *               surface
 *    DISTANCE_GRID  [cell, n_x, n_y, n_z], then the error of the values and where they are truncated; n_x n_y n_z
 *               signed distances in `values`, x running fastest, from the frame's origin on (an ESDF). For curves only
 *    CURVE      none; the ball of `curve.radius` at all points of `curve`; with `synchronized` at one moment only where
 *               the curve that is asked about is at the same parameter. For curves only */
enum class ShapeType {
  POINT,
  SPHERE,
  BOX,
  CAPSULE,
  CYLINDER,
  CONE,
  ELLIPSOID,
  HALFSPACE,
  POLYTOPE,
  POLYGON,
  MESH,
  SUPERQUADRIC,
  SUPERELLIPSOID,
  IMPLICIT,
  POINTS,
  OCTREE,
  HEIGHT_FIELD,
  DISTANCE_GRID,
  CURVE
};

/** "point", "sphere", …, "mesh". */
const char *shapeTypeName(ShapeType type);

/** The type with that lower-case name; std::nullopt for any other word. */
std::optional<ShapeType> shapeTypeFromName(const std::string &name);

/** The shortest rotation that turns the direction `from` to the direction `to`. (Eigen's FromTwoVectors; its singular
 * value decomposition takes a compiler ten seconds wherever it stands.) */
Eigen::Quaterniond rotationBetween(const Eigen::Vector3d &from, const Eigen::Vector3d &to);

/** An occupancy octree as octomap serialises it: the fields of octomap_msgs/Octomap. The corner of cell (0, 0, 0) is
 *  at the origin. */
struct OctreeData {
  std::string id = "OcTree"; /**< the type of the tree: "OcTree" or "ColorOcTree" */
  double resolution = 0.0;   /**< [m] edge length of the smallest cells, > 0 */
  bool binary = true;        /**< `data` is the body of a .bt file; otherwise of an .ot file */
  std::string data;          /**< the bytes; empty if there is no octree */
};

/** A hyperquadric: the sum over its terms [a, b, c, d, n] of |a x + b y + c z + d|^n is <= 1. */
using HyperquadricTerms = std::vector<std::array<double, 5>>;

/** A curve of any basis that needs no functions. msg/Curve.msg says what points, knots and parameters of each basis
 * mean.
 */
struct CurveDescription {
  std::string id; /**< names the curve in results */
  /** "bezier", "bspline", "polynomial", "legendre", "lagrange", "trigonometric", "rational_bezier", "nurbs",
   * "clothoid", "dubins" (with a word: "dubins_lsl" …), "involute", "pythagorean_hodograph" or "piecewise" */
  std::string basis = "bezier";
  std::size_t degree = 0; /**< bezier, rational_bezier: 0, or the number of points minus one */
  double t0 = 0.0;        /**< the parameter range begins here; not read for dubins and piecewise */
  double t1 = 1.0;        /**< and ends here, t0 < t1 */
  double radius = 0.0;    /**< [m] >= 0, radius of the ball that moves along the curve */
  /** [m/(unit of t)^k] Of t, t², …: the radius at t is `radius` and this polynomial. Empty: it does not change. */
  std::vector<double> radius_polynomial;
  /** [m] Control points, coefficients or values, one a column, in the fixed frame or in that of `pose`: degree + 1
   *  columns; a bspline has more, a trigonometric series has 2 degree + 1. */
  Eigen::Matrix3Xd points;
  /** bspline, nurbs: points.cols() + degree + 1 knots, non-decreasing. lagrange: the nodes. Otherwise empty. */
  std::vector<double> knots;
  /** weights of a rational basis; the numbers of a curve that is known by more than points */
  std::vector<double> parameters;
  /** of a piecewise curve: curves end to end, none of them piecewise; their ids and radii are not read */
  std::vector<CurveDescription> pieces;
  double restrict_t0 = 0.0; /**< with restrict_t1: only this part of the curve, at the parameters that it has there */
  double restrict_t1 = 0.0; /**< both 0: all of the curve */
  std::optional<Eigen::Isometry3d> pose; /**< of the frame of the points in the fixed frame; none: the identity */
};

/** How a SUPERQUADRIC or IMPLICIT shape is deformed: x -> linear x + translation. */
struct ShapeDeformation {
  Eigen::Matrix3d linear = Eigen::Matrix3d::Identity();  /**< invertible */
  Eigen::Vector3d translation = Eigen::Vector3d::Zero(); /**< [m] */
  std::vector<double> exponents; /**< in the place of those of the terms, one each; empty: as they are */
};

struct Geometry;

/** A shape in the frame of its object. */
struct ShapeDescription {
  ShapeType type = ShapeType::BOX;              /**< selects the members that are used */
  std::vector<double> dimensions;               /**< [m], see ShapeType */
  Eigen::Matrix3Xd vertices;                    /**< [m] in the shape's frame */
  Triangles triangles;                          /**< triangles of a MESH that is given by its vertices */
  std::vector<HyperquadricTerms> hyperquadrics; /**< IMPLICIT: hyperquadrics */
  std::vector<std::array<double, 4>> planes;    /**< IMPLICIT: [b1, b2, b3, c] for b·x + c <= 0 */
  /** IMPLICIT: [q11, q12, q13, q22, q23, q33, b1, b2, b3, c] for x'Qx + b·x + c <= 0. */
  std::vector<std::array<double, 10>> quadrics;
  std::vector<double> values; /**< [m] HEIGHT_FIELD: heights; DISTANCE_GRID: distances */
  bool solid = false;         /**< MESH: its interior belongs to it, if it is closed; results say if it is not */
  std::string resource;       /**< URI or path of a MESH or OCTREE file; replaces vertices, triangles, octree */
  OctreeData octree;          /**< OCTREE that is given by its bytes */
  std::shared_ptr<const CurveDescription> curve; /**< CURVE */
  bool synchronized = false; /**< CURVE: at the parameter of the curve that is asked about; both have one range */
  std::optional<ShapeDeformation> deformed; /**< SUPERQUADRIC, IMPLICIT: applied in the shape's frame */
  /** OCTREE: unmeasured cells inside the bounding box of the measured cells count as occupied; otherwise as free. */
  bool unknown_is_occupied = false;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity(); /**< in the object's frame */
  /** What makeGeometry() has made of this shape before, whatever its pose: it is shared instead of made again, and not
   *  checked again. Null: it is made. Whoever changes another member of a copy resets this one. */
  std::shared_ptr<const Geometry> made;
};

/** A collision object: shapes that move together. */
struct ObjectDescription {
  std::string id;    /**< unique in a scene */
  std::string frame; /**< the frame of `pose`; the caller of Scene::apply() converts `pose` to the fixed frame */
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity(); /**< the poses of the shapes are relative to it */
  std::vector<ShapeDescription> shapes;                   /**< at least one */
  double padding = 0.0;                                   /**< [m] >= 0, a ball that is added to the shapes */
};

/** How an object goes from one pose to the next. */
enum class Turning {
  SLERP, /**< its origin along a straight line, turning about one axis at a constant rate, the shorter way */
  SCREW  /**< with a constant twist: about one line and along it, at constant rates */
};

/** "slerp", "screw". */
const char *turningName(Turning turning);

/** The turning with that name, and SLERP for ""; std::nullopt for any other word. */
std::optional<Turning> turningFromName(const std::string &name);

/** A pose at a time. */
struct TimedPose {
  double time = 0.0;                                      /**< [s] ascending */
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity(); /**< of the object's frame */
};

/** The trajectory of an object that moves. */
struct ObjectTrajectory {
  std::vector<TimedPose> poses;     /**< at least one */
  Turning turning = Turning::SLERP; /**< between two poses */
  /** [ns] The moment of time 0, on the clock of stamps: since 1970 or by a simulation. 0: when the motion begins that a
   *  query is about. */
  std::int64_t start = 0;
  /** [s] The start is only known to within this, before or after; infinity: anywhere on the way at any time. */
  double tolerance = 0.0;
};

} // namespace curve_proximity
#endif
