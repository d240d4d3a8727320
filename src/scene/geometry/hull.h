/* SPDX-License-Identifier: BSD-3-Clause */
/* Convex hulls of many points: qhull finds the extreme points, and a test of our own proves that they cover all. */
#ifndef CURVE_PROXIMITY_SCENE_HULL_H
#define CURVE_PROXIMITY_SCENE_HULL_H

#include <array>
#include <functional>
#include <vector>

#include <curve_proximity/core.hpp>

namespace curve_proximity {

using Points = std::vector<Eigen::Vector3d>;

/* Some points of a set, and how far a point of the set may stand out of their hull [m]. */
struct HullPoints {
  Points kept;
  double excess = 0.0;
};

/* A triangle of a hull's surface: numbers of points. */
using HullFacet = std::array<int, 3>;

/* A hull's extreme points, and its surface as triangles of their numbers. */
struct HullSurface {
  Points points;
  std::vector<HullFacet> facets;
};

/* The hull's surface as qhull finds it, each triangle either way round. Empty where qhull gives up: of fewer than four
 * points, or of flat ones. stop: asked some hundred times a second; once it holds, Error with CPROX_STOPPED is
 * thrown. */
HullSurface hullSurfaceOf(const Points &points, const std::function<bool()> &stop = {});

/* The extreme points of `all`, or all of them where they are few or flat. `all`: at least one, finite, each once. */
HullPoints hullPointsOf(const Points &all);

/* Makes `kept`, some of the points of `all`, cover all of them: by their hull, by the excess where a point stands out
 * by no more than rounding, or by taking it back.
 *
 *  facets  the surface of the hull of `kept`, numbers of points in `kept`. They only save time: a point that they do
 * not prove to be covered is asked of the core. */
HullPoints coveringPoints(const Points &all, Points kept, const std::vector<HullFacet> &facets = {});

/* The polytope of points. */
BodyHandle polytopeOf(const Points &points);

} // namespace curve_proximity
#endif
