/* SPDX-License-Identifier: BSD-3-Clause */
/** Queries about curves as the checker of certificates reads them (doc/certificates.md). */
#ifndef CURVE_PROXIMITY_PROOF_HPP
#define CURVE_PROXIMITY_PROOF_HPP

#include <string>

#include <curve_proximity/query.hpp>

namespace curve_proximity {

/** The query of a curve against these obstacles, with its head; empty where something is of a kind that has no
 *  certificates. */
std::string describeQuery(const SceneObstacles &obstacles, const CurveDescription &curve);

} // namespace curve_proximity
#endif
