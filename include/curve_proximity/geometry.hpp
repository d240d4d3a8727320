/* SPDX-License-Identifier: BSD-3-Clause */
/** From descriptions to what queries take: bodies, and mesh files. */
#ifndef CURVE_PROXIMITY_GEOMETRY_HPP
#define CURVE_PROXIMITY_GEOMETRY_HPP

#include <cstddef>
#include <functional>
#include <limits>
#include <string>

#include <curve_proximity/core.hpp>
#include <curve_proximity/description.hpp>

namespace curve_proximity {

/** Where files of meshes and octrees are looked for, and how large what they hold may be. */
struct ResourceOptions {
  /** The folder to which paths without a scheme are relative; empty: only absolute paths are accepted. */
  std::string base_dir;

  /** The folder of a ROS package, "" if there is none of that name (ros::package::getPath has this shape). Empty: then
   *  package:// is an error. Called from the thread that makes the body. */
  std::function<std::string(const std::string &package)> find_package;

  /** [bytes] The most that the body of one mesh, set of points or octree may take. */
  std::size_t memory_limit = std::numeric_limits<std::size_t>::max();
};

/** The file that a URI means: package://NAME/path, file:///path, an absolute path, or a path relative to base_dir.
 *  Throws Error, naming `what` it is for ("mesh", "octree") and the URI, for http and other schemes, an unknown
 *  package, and a file that is not there, is no regular file or is empty. */
std::string resolveResource(const std::string &uri, const ResourceOptions &options, const std::string &what = "mesh");

/** A body made of a description. */
struct Geometry {
  BodyHandle
      body; /**< of a mesh a level-of-detail body: its convex hull, and its triangles where the hull cannot decide */
  BodyHandle hull;     /**< of a mesh its convex hull alone, else the body */
  BodyHandle surface;  /**< the body without its inside, where it is a mesh that has one; else the body */
  double excess = 0.0; /**< [m] how far points of the shape may be outside the body, as whoever moved it knows */
  /** [m] of a mesh: no point of it is farther than this from `hull` (vertices that the hull computation dropped; at
   *  the scale of rounding). The body knows it */
  double hull_excess = 0.0;
  bool is_mesh = false;
  bool is_open = false; /**< a mesh that was to be solid, but is not closed: its surface alone counts */
};

/** Checks the description once and makes its body, in the shape's own frame (shape.pose is left to the caller).
 *
 *  Throws Error: dimensions that are too few or too many, not finite or not positive ("cylinder needs 2 dimensions
 *  [height, radius], got 1"); vertices that are missing or not finite; a mesh without triangles or with an index out of
 *  range, a scale that is 0 or not finite; a resource that cannot be read (see resolveResource), has no triangle or a
 *  vertex that is not finite; points that are none; an octree that is cut short, of an unknown kind or without an
 *  occupied cell; CPROX_MEMORY, with the bytes that it needs, for what would exceed the memory limit. Flat meshes and
 *  polytopes of any dimension are accepted.
 *  Thread safety: any number of threads. */
Geometry makeGeometry(const ShapeDescription &shape, const ResourceOptions &options = {});

/** Boxes along the axes, a column each [m]. */
struct Boxes {
  Eigen::Matrix3Xd low, high;
};

/** The boxes that the body of an OCTREE is made of, in the shape's own frame. Throws as makeGeometry() does. */
Boxes octreeBoxes(const ShapeDescription &shape, const ResourceOptions &options = {});

/** Whether nothing of an octree can be held against, which makeGeometry() refuses. Throws as that does. */
bool isEmpty(const OctreeData &octree, bool unknown_is_occupied);

} // namespace curve_proximity
#endif
