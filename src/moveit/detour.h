/* SPDX-License-Identifier: BSD-3-Clause */
/* A path of straight edges in joint space is led round those of its edges that do not hold. */
#ifndef CURVE_PROXIMITY_MOVEIT_DETOUR_H
#define CURVE_PROXIMITY_MOVEIT_DETOUR_H

#include <cstddef>
#include <functional>
#include <random>
#include <vector>

namespace curve_proximity {

using Row = std::vector<double>; /* a value for each joint */
using Path = std::vector<Row>;

/* Does the straight motion from one row to the other hold? */
using EdgeTest = std::function<bool(const Row &from, const Row &to)>;

struct JointBox {
  Row lower, upper;
};

/* RRT-Connect (Kuffner and LaValle 2000) with steps of this length at most. Edges are proven and not sampled, so that
 * no step is too long. Empty: no path with so many samples and vertices, or `is_over`. */
Path rrtConnect(const Row &from, const Row &to, const JointBox &box, double step, std::size_t most_vertices,
                const EdgeTest &holds, const std::function<bool()> &is_over, std::mt19937_64 &random);

struct Detours {
  EdgeTest stays;               /* edges of the path that do not hold are led round; the others stay as they are */
  std::vector<EdgeTest> wanted; /* of new edges, the most clearance first; each is tried before a search goes farther */
  EdgeTest needed;              /* of new edges that begin or end at a row of the path: it may stand closer */
  JointBox limits;              /* of the joints */
  double step;                  /* of new rows, at most; less where corners want it */
  std::function<bool()> is_over; /* the time is */
};

/* A path with the same ends. Each run of edges that do not hold is planned anew between the rows before and behind it,
 * and where there is no way between them, between rows farther and farther apart. What is new is shortened, its
 * corners are rounded, and its rows are at equal distances: edges between them cut what is left of the corners. All
 * else stays as it is. The same for the same path. Empty: none is found. */
Path around(const Path &path, const Detours &detours);

/* Rows at equal distances along the path, at most `step`; corners between them are cut. */
Path resampled(const Path &path, double step);

/* With a row in the middle of each edge. */
Path halved(const Path &path);

double lengthOf(const Path &path);

} // namespace curve_proximity
#endif
