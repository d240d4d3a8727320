/* SPDX-License-Identifier: BSD-3-Clause */
/** A roadmap of a hundred thousand edges, all of them proven, beside the same edges sampled. */
#ifndef EXAMPLES_OMPL_LAZY_PRM_HPP
#define EXAMPLES_OMPL_LAZY_PRM_HPP

#include <vector>

#include "edges.hpp"

/** Prints what the edges cost, how many samples pass wrongly, and whether a path along sampled edges is clear.
 *
 *  lowest, highest  of the joints [rad]
 *  edges            so many, or a few less: each posture has one to each of its ten nearest
 *
 *  False where an edge that is proven clear has a sample that is not. */
bool planByRoadmap(const Task &task, const std::vector<double> &lowest, const std::vector<double> &highest,
                   std::size_t edges);

#endif
