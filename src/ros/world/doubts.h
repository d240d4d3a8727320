/* SPDX-License-Identifier: BSD-3-Clause */
/** Why an answer that is right about the data is not to be relied on: data that is too old, or not there. */
#ifndef CURVE_PROXIMITY_ROS_DOUBTS_H
#define CURVE_PROXIMITY_ROS_DOUBTS_H

#include <curve_proximity/ConstraintResult.h>
#include <curve_proximity/SensorState.h>

#include <curve_proximity/query.hpp>
#include <set>
#include <string>
#include <vector>

namespace curve_proximity {

/** What answers do not cover of the world as it is now. For one request. */
class Doubts {
 public:
  /** max_age [s]: ~max_age, 0 for none. lost: the scene of the server before this one is gone, so that nothing is known
   * of what is not named. */
  Doubts(double max_age, const std::vector<SensorState> &sensors, bool lost = false)
      : max_age_(max_age), sensors_(sensors), lost_(lost) {}

  /** Which objects the rows to come are about: those of the query, or none. */
  void objects(const Query &query, bool any = true);

  /** [s] The ages of transforms and of joint values of the rows to come; NaN: none were used. */
  void ages(double transforms, double joints);

  /** For Query::coverage of the rows to come. */
  Coverage coverage();

  /** Nothing is proven, with the reason. */
  void apply(ConstraintResult &row);

  /** A sentence for each doubt that a row had. */
  void tell(std::vector<std::string> &warnings) const;

 private:
  const double max_age_;
  const std::vector<SensorState> sensors_;
  const bool lost_;
  Coverage objects_, ages_;
  std::set<std::string> told_;
};

} // namespace curve_proximity
#endif
