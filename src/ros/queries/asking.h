/* SPDX-License-Identifier: BSD-3-Clause */
/** What a service asks of each curve and motion, and the rows that answer it. */
#ifndef CURVE_PROXIMITY_ROS_ASKING_H
#define CURVE_PROXIMITY_ROS_ASKING_H

#include <curve_proximity/Profile.h>
#include <curve_proximity/Proximity.h>
#include <curve_proximity/ViolationIntervals.h>

#include <cstddef>
#include <curve_proximity/motion.hpp>
#include <limits>
#include <vector>

namespace curve_proximity {

/** What is asked of each curve and motion. */
struct Asking {
  enum Kind { ANSWER, GRADIENT, NEAREST, CONTACT, PROFILE, VIOLATIONS };
  Kind kind = ANSWER;
  PairLimits limits;                                        /**< of NEAREST */
  std::size_t intervals = 0;                                /**< of PROFILE, where there are no breaks */
  std::vector<double> breaks;                               /**< of PROFILE */
  double horizon = std::numeric_limits<double>::infinity(); /**< [m] of PROFILE */
  bool per_link = false;                                    /**< of PROFILE */
  double resolution = 0.0;                                  /**< of VIOLATIONS; 0: a part of the range */
};

/** Where the intervals of a profile over [t0, t1] begin and end. */
std::vector<double> breaksOf(const Asking &asking, double t0, double t1);

/** So many violations of one curve or motion are listed at most; where there are more, that is an error. */
constexpr std::size_t MOST_VIOLATIONS = 256;

/** How finely the ends of violations over [t0, t1] are searched. */
double resolutionOf(const Asking &asking, double t0, double t1);

/** Appends one curve's answers. Without anything to measure against the nearest pairs are answered as a distance is. */
void askCurve(const Targets &targets, const CompiledCurve &curve, const Query &query, const Asking &asking,
              Workspace &workspace, std::vector<Answer> &answers);

/** The profile of one curve, of Asking::PROFILE; the summary is not filled in. */
Profile profileOf(const Targets &targets, const CompiledCurve &curve, const Query &query, const Asking &asking,
                  Workspace &workspace);

/** The violations of one curve, of Asking::VIOLATIONS; the summary is not filled in. */
ViolationIntervals violationsOf(const Targets &targets, const CompiledCurve &curve, const Query &query,
                                const Asking &asking, Workspace &workspace);

/** The rows of a motion. */
struct MotionRows {
  std::vector<Answer> answers;
  std::vector<Profile> profiles;              /* of Asking::PROFILE: one for each answer */
  std::vector<ClearanceGradient> gradients;   /* of Asking::GRADIENT likewise */
  std::vector<ViolationIntervals> violations; /* of Asking::VIOLATIONS likewise */
};

/** Appends the rows of one kind: against objects, or of the robot with itself. */
void askMotion(const RobotMotion &motion, const Query &query, bool self, const Asking &asking, Workspace &workspace,
               MotionRows &out);

/** Fills the row of an answer, which is as it was made. */
void fillRow(const Answer &answer, const Query &query, const Asking &asking, Proximity &row);

} // namespace curve_proximity
#endif
