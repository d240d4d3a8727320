/* SPDX-License-Identifier: BSD-3-Clause */
/** What a robot passes through along its motion, as cells of a grid: a certified cover from outside and from inside. */
#ifndef CURVE_PROXIMITY_SWEPT_VOLUME_HPP
#define CURVE_PROXIMITY_SWEPT_VOLUME_HPP

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <curve_proximity/motion.hpp>

namespace curve_proximity {

/** Cells of a grid over a swept volume. Cell (i, j, k) reaches from (i, j, k) to (i+1, j+1, k+1) times the resolution,
 *  in the fixed frame. */
struct SweptVolume {
  double resolution = 0.0;                        /**< [m] edge of a cell */
  std::vector<std::array<std::int32_t, 3>> cells; /**< the robot touches no other cell at any time; ascending */
  std::vector<bool> inside; /**< of each: the robot fills all of it at one time, where that was asked */
  double gap = 0.0;         /**< [m] every point of a cell is within this of a point that the robot passes through */
  std::size_t n_poses = 0;  /**< so many bodies at poses were looked at */
};

/** How a swept volume is found. */
struct SweepOptions {
  double resolution = 0.01;                        /**< [m] above 0 */
  bool inside = false;                             /**< find the cells inside, too: several times the work */
  std::vector<std::string> links;                  /**< these links and what they carry; empty: all of the motion's */
  unsigned threads = 0;                            /**< 0: as many as the machine has */
  std::size_t memory_limit = std::size_t{1} << 30; /**< bytes: cells of the box round the motion, bodies at poses */
  bool (*stop)(void *) = nullptr; /**< polled by all threads; true ends the work with Error, status CPROX_STOPPED */
  void *stop_user = nullptr;      /**< its argument */
};

/** The swept volume of all links that the motion asks about, with their paddings and what they carry. Throws Error: a
 *  resolution that is not above 0, an unknown link, more memory than the limit (known before the work begins). */
SweptVolume sweptVolume(const RobotMotion &motion, const SweepOptions &options = {});

/** The surface of the cells as triangles, a binary STL; `inside_only`: of the cells inside. Closed. */
std::string toStl(const SweptVolume &volume, bool inside_only = false);

/** The cells as an octree of the same resolution: a shape of an object. Throws Error: the volume is larger than an
 *  octree of this resolution. */
OctreeData toOctree(const SweptVolume &volume, bool inside_only = false);

/** The same as a file in octomap's binary format. */
std::string toOctomap(const SweptVolume &volume, bool inside_only = false);

} // namespace curve_proximity
#endif
