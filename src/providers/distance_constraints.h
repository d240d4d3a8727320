/* SPDX-License-Identifier: BSD-3-Clause */
/** The two kinds of pairs that CurveDistance and SuperquadricDistance both answer for. */
#ifndef CURVE_PROXIMITY_PROVIDERS_DISTANCE_CONSTRAINTS_H
#define CURVE_PROXIMITY_PROVIDERS_DISTANCE_CONSTRAINTS_H

#include <curve_proximity/constraint_provider.hpp>
#include <curve_proximity/superquadric_fit.hpp>
#include <memory>
#include <optional>

namespace curve_proximity {

/** What measures meshes and outlines that are not convex. */
enum class Meshes {
  EXACT, /**< themselves where they are apart; where they overlap their hulls say how deep at most */
  HULL   /**< their hulls, which bound the distance from below */
};

/** The parameter of that name. */
inline Meshes readMeshes(ParameterReader &reader) {
  return reader.word("meshes", "exact", {"exact", "hull"}) == "exact" ? Meshes::EXACT : Meshes::HULL;
}

/** How a distance along a curve is measured. */
struct CurveDistanceParameters {
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  double margin = 0.0; /**< [m] */
  Meshes meshes = Meshes::EXACT;
};

/** How a distance of standing bodies is measured. */
struct StandingDistanceParameters {
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  std::optional<SuperquadricFitOptions> fit; /**< superquadrics in place of what is not smooth */
  double margin = 0.0;                       /**< [m] */
  Meshes meshes = Meshes::EXACT;
};

/** Of a pair along a curve; of standing bodies. Throw Error for sides that cannot be measured. */
std::unique_ptr<const Constraint> curveDistance(const CurveDistanceParameters &parameters, const ConstraintPair &pair);
std::unique_ptr<const Constraint> standingDistance(const StandingDistanceParameters &parameters,
                                                   const ConstraintPair &pair);

} // namespace curve_proximity
#endif
