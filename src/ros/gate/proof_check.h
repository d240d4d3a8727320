/* SPDX-License-Identifier: BSD-3-Clause */
/** Checks the certificates of a server's rows, so that the gate need not believe the server. */
#ifndef CURVE_PROXIMITY_ROS_PROOF_CHECK_H
#define CURVE_PROXIMITY_ROS_PROOF_CHECK_H

#include <curve_proximity/Proximity.h>
#include <curve_proximity/ProximityQuery.h>

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "../scene/query/certificate_problem.h"

namespace curve_proximity {

/** What a query is about is read by the gate itself, from the robot, the frames, the joints and the objects that have
 * come to it; a row of the server proves something of that, or nothing. The check is that of the program cprox_check
 * (check/), which shares no line with the search. By any thread. */
struct ProofCheck {
  /** The rows of a query by the gate's own reading; may throw Error. */
  std::function<std::vector<Problem>(const ProximityQuery &)> problems;

  /** The number of changes of what the gate reads. */
  std::function<std::uint64_t()> version;

  /** Do the certificates of the rows prove that all of the query stays farther than delta from everything? Empty, or
   *  why not. Throws Error where the query cannot be read. */
  std::string doubt(const ProximityQuery &query, const std::vector<Proximity> &rows, double delta) const;
};

} // namespace curve_proximity
#endif
