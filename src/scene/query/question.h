/* SPDX-License-Identifier: BSD-3-Clause */
/** What can be asked about what moves. About which of its parts, and how exactly, says Query. */
#ifndef CURVE_PROXIMITY_SCENE_QUESTION_H
#define CURVE_PROXIMITY_SCENE_QUESTION_H

#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <curve_proximity/query.hpp>
#include <curve_proximity/separation.hpp>
#include <curve_proximity/swept_volume.hpp>

namespace curve_proximity {
namespace question {

/** Distance, tolerance or collision: Query::query_type. */
struct Search {};

/** The least distance with its derivatives. */
struct Gradient {};

/** The pairs that come closest. */
struct Nearest {
  PairLimits limits;
};

/** The time of contact. */
struct Contact {};

/** The clearance on each interval of the parameter. */
struct Profile {
  std::size_t intervals = 100; /**< of equal length; not used if there are breaks */
  std::vector<double> breaks;
  double horizon = std::numeric_limits<double>::infinity(); /**< [m] clearance beyond it is only bounded */
};

/** The intervals within Query::delta. */
struct Violations {
  double resolution = 0.0; /**< in units of the parameter; 0: a thousandth of the domain */
};

/** How fast the robot may go while persons, who are in the objects, may walk up to it. */
struct Speed {
  Separation separation;
  Profile profile; /**< the intervals of the limits */
};

/** How far each object may be moved before the motion is no longer farther than Query::delta. */
struct Margins {
  double within = 1.0; /**< [m] objects are moved no farther */
};

/** What the robot passes through. */
struct Sweep {
  SweepOptions options; /**< its stop function is not used: that of the query is */
};

} // namespace question

using Question =
    std::variant<question::Search, question::Gradient, question::Nearest, question::Contact, question::Profile,
                 question::Violations, question::Speed, question::Margins, question::Sweep>;

/** distance, tolerance or collision. */
std::optional<QueryType> queryTypeFromName(const std::string &name);

/** Is it one of these kinds? */
template <class... Kinds>
bool asksFor(const Question &question) {
  return (std::holds_alternative<Kinds>(question) || ...);
}

/** The intervals of a profile over a domain: its breaks, or as many of equal length as the domain has room for. The
 *  first and the last break are exactly those of the domain. */
std::vector<double> breaksOf(const question::Profile &profile, const std::array<double, 2> &domain);

} // namespace curve_proximity
#endif
