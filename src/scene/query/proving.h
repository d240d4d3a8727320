/* SPDX-License-Identifier: BSD-3-Clause */
/* Certificates of answers, and queries as the program cprox_check reads them. */
#ifndef CURVE_PROXIMITY_SCENE_PROVING_H
#define CURVE_PROXIMITY_SCENE_PROVING_H

#include <array>
#include <string>
#include <vector>

#include <curve_proximity/query.hpp>

namespace curve_proximity {

/* Writes the proof of an answer to query.options.certificate, or to answer.unproven why there is none. `result` is the
 * answer in the core's numbers, with the interval of the answer; `obstacles` are described to the checker by
 * obstacleLines(). */
void leaveProof(const Query &query, const cprox_mover &mover, const std::vector<cprox_obstacle> &obstacles,
                const cprox_result &result, Workspace &workspace, Answer &answer);

/* The same of the time of contact: `result` is the core's, of these obstacles or of larger ones. */
void leaveContactProof(const Query &query, const cprox_mover &mover, const std::vector<cprox_obstacle> &obstacles,
                       const cprox_result &result, Workspace &workspace, Answer &answer);

/* A claim about a part of the range, or that the distance is at most delta where the answer says. */
struct PartialClaim {
  std::array<double, 2> range;
  double delta;
  bool near;
  bool distance; /* of a distance: the claim may be weaker by epsilon */
  cprox_result answer;
};

/* The certificate of a claim; empty, with a message in `unproven`, where there is none. */
std::string certificateOf(const Query &query, const cprox_mover &mover, const cprox_obstacles *obstacles,
                          const PartialClaim &claim, Workspace &workspace, std::string &unproven);

/* Why nothing at all can be proven where this body takes part; empty where it can. `who`: "object 'can'". moves: it
 * is a link, or attached. */
std::string unprovable(const std::string &who, const cprox_obstacle &obstacle, bool moves = false);

/* The number of lines and a line a convex part, with the name of its owner; empty where a body is of a kind that has no
 * certificates. */
std::string obstacleLines(const std::vector<cprox_obstacle> &obstacles, const std::vector<std::string> &names);

/* What moves by joints against the obstacles, as the checker reads it, with these after obstacleLines(); empty where a
 * body or a motion is of a kind that has no certificates. */
std::string describeQuery(const cprox_mover &mover, const std::vector<cprox_obstacle> &obstacles,
                          const std::vector<std::string> &names, const std::string &id);

/* The text as one word. */
std::string wordOf(const std::string &text);

} // namespace curve_proximity
#endif
