/* SPDX-License-Identifier: BSD-3-Clause */
/** The mode guide of FourierGap: gaps from coarse to fine deep inside, the distance itself from contact on. */
#ifndef CURVE_PROXIMITY_PROVIDERS_FOURIER_GUIDE_H
#define CURVE_PROXIMITY_PROVIDERS_FOURIER_GUIDE_H

#include <curve_proximity/constraint_provider.hpp>
#include <memory>
#include <vector>

namespace curve_proximity {

/** A certified gap of a guide. */
struct GuideStage {
  std::unique_ptr<const Constraint> gap; /**< its value is at most 0 where the sides overlap */
  double sample;                         /**< [m] its period over its samples, below that of the stage before */
};

/** A value that is below 0 exactly where the sides overlap. It is their signed distance wherever they do not, and
 *  passes continuously, with its gradient, to the gaps: to the finest about a sample below contact, and to coarser ones
 *  the deeper those are. Along a curve it is the least of these values: the certified distance where that is above 0,
 *  else the least that is met.
 *
 *  stages: one or more, the coarsest first, each of the standing pair. Throws Error where a part has no depth of its
 *  own. */
std::unique_ptr<const Constraint> makeGuide(const ConstraintPair &pair, std::vector<GuideStage> stages);

} // namespace curve_proximity
#endif
