/* SPDX-License-Identifier: BSD-3-Clause */
/** Why an answer that is right about the data is not to be relied on: data that is too old, or not there. */
#ifndef CURVE_PROXIMITY_ROS_DOUBTS_H
#define CURVE_PROXIMITY_ROS_DOUBTS_H

#include <curve_proximity/ConstraintResult.h>
#include <curve_proximity/SensorState.h>

#include <curve_proximity/query.hpp>
#include <curve_proximity/scene.hpp>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "world/unknowns.h"

namespace curve_proximity {

/** What answers do not cover of the world as it is now. For one request. */
class Doubts {
 public:
  /** max_age [s]: ~max_age, 0 for none. snapshot: what answers are measured against. */
  Doubts(double max_age, SnapshotPtr snapshot, const std::vector<SensorState> &sensors, std::vector<Unknown> unknowns)
      : max_age_(max_age), snapshot_(std::move(snapshot)), sensors_(sensors), unknowns_(std::move(unknowns)) {}

  /** Which objects the rows to come are about: those of the query, or none. */
  void objects(const Query &query, bool any = true);

  /** [s] The ages of transforms and of joint values of the rows to come; NaN: none were used. */
  void ages(double transforms, double joints);

  /** What is not known of the joints of the rows to come; "": nothing. */
  void joints(const std::string &unknown);

  /** For Query::coverage of the rows to come. */
  Coverage coverage();

  /** Nothing is proven, with the reason. */
  void apply(ConstraintResult &row);

  /** A message for each doubt that a row had, and for all that is unknown of the scene. */
  void tell(std::vector<std::string> &warnings) const;

 private:
  const double max_age_;
  const SnapshotPtr snapshot_;
  const std::vector<SensorState> sensors_;
  const std::vector<Unknown> unknowns_;
  Coverage objects_, ages_, joints_;
  std::set<std::string> told_;
};

} // namespace curve_proximity
#endif
