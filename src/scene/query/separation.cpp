/* SPDX-License-Identifier: BSD-3-Clause */
#include <curve_proximity/separation.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "answering.h"
#include "question.h"

namespace curve_proximity {
namespace {

/* Limits are lowered by this part, far beyond the rounding of the few operations that make them. */
constexpr double SPARE = 1e-12;

void checkSeparation(const Separation &s) {
  const std::pair<const char *, double> numbers[] = {{"person_speed", s.person_speed},
                                                     {"reaction_time", s.reaction_time},
                                                     {"stopping_time", s.stopping_time},
                                                     {"intrusion", s.intrusion},
                                                     {"person_position", s.person_position},
                                                     {"robot_position", s.robot_position},
                                                     {"robot_speed", s.robot_speed.value_or(0.0)}};
  for (const auto &[name, value] : numbers)
    if (!(value >= 0.0 && std::isfinite(value)))
      throw Error(std::string(name) + " is " + std::to_string(value) + ", must be a finite number of at least 0");
}

/* The distance that is left to a person and a robot that brakes, of a clearance. */
double roomOf(double clearance, const Separation &s) {
  return clearance - (s.intrusion + s.person_position + s.robot_position) - s.person_speed * s.reaction_time -
         SPARE * std::min(clearance, 1e9);
}

/* The largest k in [0, 1] with a k + b k² <= room, of a and b that are not negative. */
double largestOverride(double a, double b, double room) {
  if (!(room >= 0.0)) return 0.0;
  if (a + b <= room) return 1.0;
  return std::min(1.0, 2.0 * room / (a + std::sqrt(a * a + 4.0 * b * room))); // a + b > room: the root is above 0
}

/* The override that is safe from anywhere in interval i, if the robot is no faster until it brakes. */
double limitOf(const std::vector<ClearanceInterval> &profile, std::size_t i, const Separation &s) {
  const double to_brake = 0.5 * s.stopping_time;
  if (s.robot_speed)
    return largestOverride(s.person_speed * s.stopping_time + *s.robot_speed * s.reaction_time,
                           *s.robot_speed * to_brake, roomOf(profile[i].lower, s));
  double least = profile[i].lower, limit = 0.0;
  for (std::size_t j = i;; ++j) { // the robot comes to rest in interval j at the latest
    least = std::min(least, profile[j].lower);
    const double by_person = largestOverride(s.person_speed * s.stopping_time, 0.0, roomOf(least, s));
    const double by_way =
        j + 1 == profile.size() ? 1.0 : largestOverride(s.reaction_time, to_brake, profile[j].t1 - profile[i].t1);
    limit = std::max(limit, std::min(by_person, by_way));
    if (by_person <= by_way) return limit;
  }
}

double unwatchedOf(const std::vector<ClearanceInterval> &profile, const Separation &s) {
  double least = 0.0;
  for (const ClearanceInterval &interval : profile) {
    const double reach = s.person_speed * (interval.t1 - profile.front().t0), room = roomOf(interval.lower, s);
    if (!(room >= 0.0) || (room == 0.0 && reach > 0.0)) return INFINITE;
    if (reach > 0.0) least = std::max(least, reach / room * (1.0 + SPARE));
  }
  return least > 1.0 ? INFINITE : least;
}

} // namespace

SpeedLimits limitSpeed(std::vector<ClearanceInterval> profile, const Separation &separation) {
  checkSeparation(separation);
  SpeedLimits out;
  std::vector<double> own(profile.size());
  for (std::size_t i = 0; i < profile.size(); ++i) own[i] = limitOf(profile, i, separation) * (1.0 - SPARE);

  /* whoever is in interval i stays within its limit until the robot brakes */
  out.overrides = own;
  for (std::size_t i = 0; i < profile.size(); ++i) {
    const double reached = profile[i].t1 + own[i] * separation.reaction_time;
    for (std::size_t j = i + 1; j < profile.size() && profile[j].t0 <= reached; ++j)
      out.overrides[j] = std::min(out.overrides[j], own[i]);
    out.constant = std::min(out.constant, own[i]);
  }
  out.unwatched = unwatchedOf(profile, separation);
  out.profile = std::move(profile);
  return out;
}

SpeedLimits speedLimits(const RobotMotion &motion, std::size_t n, const Separation &separation, const Query &query,
                        Workspace &workspace) {
  checkSeparation(separation);
  question::Profile asked;
  asked.intervals = n;
  return limitSpeed(clearanceProfile(motion, false, breaksOf(asked, motion.domain()), query, workspace), separation);
}

} // namespace curve_proximity
