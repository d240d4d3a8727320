/* SPDX-License-Identifier: BSD-3-Clause */
/* Whom a query about a robot in motion is about, in the core's form, and the names of what the core found. */
#ifndef CURVE_PROXIMITY_SCENE_ASKED_PAIRS_H
#define CURVE_PROXIMITY_SCENE_ASKED_PAIRS_H

#include <limits>
#include <string>
#include <vector>

#include "answering.h"
#include "motion/motion_data.h"

namespace curve_proximity {

/* Pairs of geometries and some of the world's items, pairs of geometries alone, or both. */
struct Asked {
  const RobotMotion::Data &data;
  RobotPairs against;
  std::vector<std::size_t> items; /* by obstacle */
  std::vector<cprox_obstacle> obstacles;
  std::vector<cprox_robot_pair> pairs;                       /* with obstacles; against itself: of geometries */
  std::vector<cprox_robot_pair> self_pairs;                  /* of both at once: of geometries */
  double rounding;                                           /* [m] that the core does not know of */
  double left_out = std::numeric_limits<double>::infinity(); /* [m] objects that are not among the items are farther */

  /* Is a result about two geometries of the robot? */
  bool isSelf(const cprox_result &result) const {
    return against == RobotPairs::SELF ||
           (against == RobotPairs::WHOLE && static_cast<std::size_t>(result.obstacle_index) >= obstacles.size());
  }

  cprox_mover mover() const;
  Stated stated(const Query &query) const; /* both outlive it */
};

inline RobotPairs againstOf(bool self) {
  return self ? RobotPairs::SELF : RobotPairs::ENVIRONMENT;
}

/* The items of all objects, or of those that are named. Throws Error for a name that is none. */
std::vector<std::size_t> namedItems(const RobotMotion::Data &data, const std::vector<std::string> &names);

/* Whom a query is about; of both at once the other one where one has no pairs. Throws Error for a name that is none. */
Asked askedItems(const RobotMotion::Data &data, std::vector<std::size_t> wanted, const Query &query);
Asked askedSelf(const RobotMotion::Data &data, const Query &query);
Asked askedOf(const RobotMotion &motion, RobotPairs against, const Query &query);

/* What is asked for and not heeded, of a query with one answer in all. */
std::string faultInAll(RobotPairs against, const Query &query);

/* What answers about them do not cover. */
Coverage coverageOf(const Query &query, const Asked &asked);

/* Throws Error where what is asked about is no distance. */
void checkDistances(RobotPairs against, const Query &query);

/* Names both sides of an answer that has a witness, and leaves the numbers of their shapes in mover_part and
 * obstacle_index. */
void nameSides(const Asked &asked, const Query &query, Answer &answer);

/* What the core said, widened by the rounding that it does not know, and by name. */
Answer toAnswer(const Asked &asked, const cprox_result &result, const Query &query, const Workspace &workspace,
                Clock::time_point start);

} // namespace curve_proximity
#endif
