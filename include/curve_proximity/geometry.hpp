/* SPDX-License-Identifier: BSD-3-Clause */
/** Makes bodies from descriptions; reads mesh and octree files. */
#ifndef CURVE_PROXIMITY_GEOMETRY_HPP
#define CURVE_PROXIMITY_GEOMETRY_HPP

#include <cstddef>
#include <functional>
#include <limits>
#include <string>

#include <curve_proximity/core.hpp>
#include <curve_proximity/description.hpp>

namespace curve_proximity {

/** The folder in which meshes that were read once are kept: curve_proximity/meshes in $XDG_CACHE_HOME or ~/.cache; ""
 *  where neither is known. */
std::string userCacheDir();

/** Where mesh and octree files are searched, and how much memory a body may take. */
struct ResourceOptions {
  /** The folder of paths without a scheme. If empty, only absolute paths are accepted. */
  std::string base_dir;

  /** Returns the folder of a ROS package, "" for an unknown package, as ros::package::getPath() does. If empty,
   *  package:// is an error. Called from the thread that makes the body. */
  std::function<std::string(const std::string &package)> find_package;

  /** [bytes] The largest size of the body of one mesh, point cloud or octree. */
  std::size_t memory_limit = std::numeric_limits<std::size_t>::max();

  /** Asked now and then while a body is made; true: makeGeometry() throws Error. Null: never. It throws nothing. */
  std::function<bool()> stop;

  /** Where meshes that were read, and their convex hulls, are kept for the next time; "": nowhere. The files are found
   *  by the content of the mesh file, its scale and the version of this library. Files that are damaged or belong to
   *  another user are ignored and made again. At most 1 GiB is kept. */
  std::string cache_dir = userCacheDir();

  /** [m] >= 0. Where it is above 0, a mesh is replaced by one with fewer triangles, and with a margin so that it
   * contains the mesh: at most this, and at most twice this stands out. Nothing is clear that the mesh would hit. What
   * is less than twice this away may read as a hit. */
  double mesh_tolerance = 0.0;
};

/** How long it took to load one mesh file. */
struct MeshTiming {
  /** Where the mesh came from. */
  enum Source {
    FILE,      /**< the mesh file */
    CACHE_DIR, /**< ResourceOptions::cache_dir */
    MEMORY     /**< this process had read the same content before */
  };
  std::string file;          /**< its path */
  Source from = FILE;        /**< where it came from */
  double read = 0.0;         /**< [s] for vertices and triangles */
  std::size_t triangles = 0; /**< that count, after ResourceOptions::mesh_tolerance */
  double hull = 0.0;         /**< [s] for the convex hull, and for keeping it */
  double tree = 0.0;         /**< [s] for the bounding-volume hierarchy over the triangles */
};

/** The file of a URI: package://NAME/path, file:///path, an absolute path, or a path relative to base_dir.
 *
 *  Throws Error for other schemes, an unknown package, and a file that is missing, not regular or empty. The message
 *  names `what` ("mesh", "octree") and the URI. */
std::string resolveResource(const std::string &uri, const ResourceOptions &options, const std::string &what = "mesh");

/** A body made from a description. */
struct Geometry {
  BodyHandle body; /**< of a mesh: with its convex hull as a coarser level of detail; null: an empty octree, a curve */
  BodyHandle hull; /**< the convex hull of a mesh; otherwise the body */
  BodyHandle surface;  /**< a solid mesh without its interior; otherwise the body */
  double excess = 0.0; /**< [m] how far points of the shape may be outside the body; set by the caller */
  /** [m] No point of the mesh is farther than this from `hull`: the hull computation drops vertices at the scale of
   *  rounding. The body takes it into account. */
  double hull_excess = 0.0;
  double margin = 0.0;  /**< [m] a margin that belongs to all three bodies: that of a mesh that was simplified */
  bool is_mesh = false; /**< the shape is a MESH */
  bool is_open = false; /**< `solid` was requested, but the mesh is not closed: only its surface counts */

  CurveHandle curve;         /**< of a CURVE; null: the shape is none */
  CurveHandle radius_curve;  /**< its x is added to `radius` at each parameter; null: nothing is */
  double radius = 0.0;       /**< [m] of the ball along the curve */
  bool synchronized = false; /**< the curve is on the clock of the one that is asked about */

  /** True if there is nothing there: an octree without an occupied cell. */
  bool isEmpty() const {
    return !body && !curve;
  }
};

/** Checks a description and makes its body, in the shape's own frame; shape.pose is not used. With shape.made that is
 *  returned.
 *
 *  Throws Error: dimensions that are too few or too many, not finite or not positive ("cylinder needs 2 dimensions
 *  [height, radius], got 1"); vertices that are missing or not finite; a mesh without triangles or with an index out of
 *  range, a scale that is 0 or not finite; a resource that cannot be read (see resolveResource), has no triangle or a
 *  vertex that is not finite; points that are none; an octree that is cut short or of an unknown kind; CPROX_MEMORY,
 *  with the bytes that it needs, for what would exceed the memory limit. Flat meshes and
 *  polytopes of any dimension are accepted. An octree without an occupied cell is the empty set: the body is null. So
 * is that of a curve, which has a handle of its own. Thread safety: any number of threads. */
Geometry makeGeometry(const ShapeDescription &shape, const ResourceOptions &options = {});

/** Axis-aligned boxes [m]. */
struct Boxes {
  Eigen::Matrix3Xd low;  /**< the least corners, one a column */
  Eigen::Matrix3Xd high; /**< the greatest corners, as many columns */
};

/** The boxes of an OCTREE's body, in the shape's own frame. Throws as makeGeometry() does. */
Boxes octreeBoxes(const ShapeDescription &shape, const ResourceOptions &options = {});

/** True if the octree has no occupied cell: makeGeometry() makes no body then. Throws as makeGeometry() does. */
bool isEmpty(const OctreeData &octree, bool unknown_is_occupied);

} // namespace curve_proximity
#endif
