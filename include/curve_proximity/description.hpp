/* SPDX-License-Identifier: BSD-3-Clause */
/** Plain data: how messages, YAML files and URDF describe shapes, objects and curves to this package. Nothing here is
 *  checked; what makes bodies and curves of it checks once and says what is wrong. Metres, radians, right-handed. */
#ifndef CURVE_PROXIMITY_DESCRIPTION_HPP
#define CURVE_PROXIMITY_DESCRIPTION_HPP

#include <array>
#include <cstddef>
#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

namespace curve_proximity {

/** A column a triangle: three indices of vertices, from 0. */
using Triangles = Eigen::Matrix<int, 3, Eigen::Dynamic>;

/** What a shape is, and what its dimensions mean:
 *    POINT      none; `vertices` with one column, or none (the origin of `pose`)
 *    SPHERE     [radius]
 *    BOX        [x, y, z] full edge lengths
 *    CAPSULE    [height, radius] along z about mid-height; height between the centres of the hemispheres
 *    CYLINDER   [height, radius] along z about mid-height
 *    CONE       [height, radius] along z about mid-height, apex at +z
 *    ELLIPSOID  [x, y, z] semi-axes
 *    HALFSPACE  [a, b, c, d]: ax + by + cz + d <= 0
 *    SUPERQUADRIC  [a1, a2, a3, n1, n2, n3]: sum |x_i/a_i|^n_i <= 1, exponents 1 … 1000
 *    IMPLICIT   none; the intersection of `hyperquadrics`, `planes` and `quadrics`, bounded and with an interior
 *    POLYTOPE   none; the convex hull of `vertices`, solid, of any dimension
 *    POLYGON    none; a convex polygon in the plane z = 0 of its frame, its `vertices` in order, z = 0. Curves in its
 *               plane get planar answers: its inside counts as inside
 *    MESH       none, or a scale [x, y, z]; `vertices` and `triangles`, or `resource`: a surface, with `solid` also
 *               its inside
 *    POINTS     none, or [radius] >= 0: a ball of that radius about each of `vertices`, as sensors measure them
 *    OCTREE     none; the occupied cells of `octree`, or of the .bt or .ot file `resource` */
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
  IMPLICIT,
  POINTS,
  OCTREE
};

/** "point", "sphere", …, "mesh". */
const char *shapeTypeName(ShapeType type);

/** The type of that name (lower case, as above); nothing for any other word. */
std::optional<ShapeType> shapeTypeFromName(const std::string &name);

/** An occupancy octree as octomap serialises it, the fields of octomap_msgs/Octomap. Cell (0, 0, 0) begins at the
 *  origin. */
struct OctreeData {
  std::string id = "OcTree"; /**< of its nodes: "OcTree" or "ColorOcTree" */
  double resolution = 0.0;   /**< [m] > 0: edge length of the smallest cells */
  bool binary = true;        /**< what follows `data` in a .bt file, else in an .ot file */
  std::string data;          /**< the bytes; empty: no octree */
};

/** sum over its terms [a, b, c, d, n] of |a x + b y + c z + d|^n <= 1. */
using HyperquadricTerms = std::vector<std::array<double, 5>>;

struct ShapeDescription {
  ShapeType type = ShapeType::BOX;
  std::vector<double> dimensions;               /**< [m], see ShapeType */
  Eigen::Matrix3Xd vertices;                    /**< [m] in the shape's frame */
  Triangles triangles;                          /**< of a MESH given by its vertices */
  std::vector<HyperquadricTerms> hyperquadrics; /**< of an IMPLICIT */
  std::vector<std::array<double, 4>> planes;    /**< of an IMPLICIT, each [b1, b2, b3, c]: b·x + c <= 0 */
  /** of an IMPLICIT, each [q11, q12, q13, q22, q23, q33, b1, b2, b3, c]: x'Qx + b·x + c <= 0 */
  std::vector<std::array<double, 10>> quadrics;
  bool solid = false;   /**< of a MESH: its inside belongs to it if it is closed; where it is not, answers say so */
  std::string resource; /**< URI or path of the file of a MESH or an OCTREE; then what it stands for is empty */
  OctreeData octree;    /**< of an OCTREE given by its bytes */
  /** of an OCTREE: cells that were never measured count as occupied, within the box of those that were; else as free */
  bool unknown_is_occupied = false;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity(); /**< in the object's frame */
};

struct ObjectDescription {
  std::string id;
  std::string frame; /**< in which `pose` is given; whoever calls Scene::apply has brought `pose` to the fixed frame */
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity(); /**< of the object; the shapes' poses are relative to it */
  std::vector<ShapeDescription> shapes;
  double padding = 0.0; /**< [m] >= 0: all points within this of the shapes belong to the object */
};

struct CurveDescription {
  std::string id;
  std::string basis = "bezier"; /**< "bezier", "bspline", "polynomial", "legendre", "lagrange" or "trigonometric" */
  std::size_t degree = 0;       /**< of a bezier 0 or the number of points less one */
  double t0 = 0.0, t1 = 1.0;    /**< the parameter range, t0 < t1 */
  double radius = 0.0;          /**< [m] >= 0: of the ball that rides the curve */
  /** [m] in the fixed frame, a column a control point, coefficient or value: degree + 1 of them, of a bspline more,
   *  of a trigonometric series 2 degree + 1 */
  Eigen::Matrix3Xd points;
  /** of a bspline: points.cols() + degree + 1, non-decreasing; of a lagrange curve its nodes; else none */
  std::vector<double> knots;
};

} // namespace curve_proximity
#endif
