/* SPDX-License-Identifier: BSD-3-Clause */
/** Holds the gradient that a provider gives against central differences of its values. */
#ifndef CURVE_PROXIMITY_PROVIDERS_CHECK_GRADIENT_H
#define CURVE_PROXIMITY_PROVIDERS_CHECK_GRADIENT_H

#include <string>

#include "constraint_case.h"

namespace curve_proximity {

/** One derivative beside its difference. Misfit and doubt are relative to 1 + |difference|. */
struct GradientMisfit {
  std::string derivative;  /**< by what: "b linear y", "point 2 x", "position 1 panda_joint4" */
  double gradient = 0.0;   /**< as the provider gives it */
  double difference = 0.0; /**< by central differences */
  double misfit = 0.0;     /**< |gradient - difference| */
  double doubt = 0.0;      /**< how far differences with half the step are from it */
};

/** The derivatives of one answer. */
struct GradientCheck {
  std::size_t count = 0; /**< of derivatives; 0: the gradient is not valid, or there is none */
  GradientMisfit worst;  /**< the one with the largest misfit; of those that differ, if there are any */
  std::string reason;    /**< why nothing can be told; else empty */

  /** Every derivative agrees within the tolerance. */
  bool agrees = false;
  /** One of them does not, by more than its differences leave open. */
  bool differs = false;
};

/** clear: every derivative agrees. violated: one of them does not. undecided: nothing was compared, or the differences
 *  leave it open. */
inline cprox_verdict verdictOf(const GradientCheck &check) {
  if (check.differs) return CPROX_VERDICT_VIOLATED;
  return check.agrees && check.count > 0 ? CPROX_VERDICT_CLEAR : CPROX_VERDICT_UNDECIDED;
}

/** How much misfit is no fault, relative to 1 + |difference|. */
constexpr double GRADIENT_TOLERANCE = 1e-3;

/** By the steps of both sides; or by the curve's points, parameters, range and radius and steps of b; or by the numbers
 *  of a trajectory's points and its duration. The steps are 2e-4 m or rad, and half of that. given: the provider's
 *  answer to the case, with a value. Costs four evaluations a derivative. Throws Error where the provider does not
 *  answer beside the place. */
GradientCheck checkGradient(ProviderSet &providers, const ConstraintCase &asked, const ConstraintRow &given,
                            const ResourceOptions &resources, Workspace &workspace);

} // namespace curve_proximity
#endif
