/* SPDX-License-Identifier: BSD-3-Clause */
/** What the checker of certificates reads beside a certificate: the scene, and what moves (doc/certificates.md). */
#ifndef CURVE_PROXIMITY_SCENE_CERTIFICATE_PROBLEM_H
#define CURVE_PROXIMITY_SCENE_CERTIFICATE_PROBLEM_H

#include <cstdint>
#include <string>
#include <vector>

#include <curve_proximity/query.hpp>

#include "subject.h"

namespace curve_proximity {

/** Lines of a problem. */
std::string problemHead();
std::string moverLine(const CurveDescription &curve);
std::string curveObstacleLines(const CurveDescription &curve, bool synchronized = false);
std::string noMoverLine(const std::string &id);

/** Certificates of one mover as one: "CPCP", their number and each behind its length; empty where there is none. */
std::string recordOfParts(const std::vector<std::string> &certificates);

/** Why nothing can be proven of a curve: its basis is none of the six of sums, it is restricted, or its radius changes.
 *  Empty where it can. */
std::string unprovable(const CurveDescription &curve);

/** Why options.certificate does not apply to searches for this subject; empty where it does. */
std::string unprovable(const Subject &subject);

/** A search for one row, as the checker reads it, and what a proof of it does not cover. */
struct Problem {
  std::string text;              /**< the problem with its one mover; empty: see doubt and is_empty */
  std::uint64_t fingerprint = 0; /**< of the text */
  std::string doubt;             /**< why no answer is relied on, whatever is proven; empty: there is no doubt */
  bool is_empty = false;         /**< there is nothing to measure, and the query allows that */
};

/** Of a curve that was compiled from its description, or of a robot in motion. Throws Error as answer() does. Cost: the
 *  length of the text, which has all triangles and points. */
Problem problemOf(const Subject &subject, const Query &query);

} // namespace curve_proximity
#endif
