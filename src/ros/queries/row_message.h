/* SPDX-License-Identifier: BSD-3-Clause */
/** Rows of answers. */
#ifndef CURVE_PROXIMITY_ROS_ROW_MESSAGE_H
#define CURVE_PROXIMITY_ROS_ROW_MESSAGE_H

#include <curve_proximity/Gradient.h>
#include <curve_proximity/Profile.h>
#include <curve_proximity/Proximity.h>
#include <curve_proximity/ViolationIntervals.h>

#include <curve_proximity/query.hpp>
#include <string>
#include <variant>

#include "../scene/query/subject.h"

namespace curve_proximity {

/** What a row has beside its results message; nothing for rows without an answer. Summaries are not filled in. */
using DetailMessage = std::variant<std::monostate, Gradient, Profile, ViolationIntervals>;

/** So many violations of one curve or motion are listed at most; where there are more, that is an error. */
constexpr std::size_t MOST_VIOLATIONS = 256;

/** Fills one row of the results, which is as it was made. What has no answer has NaN for numbers. */
void fillRow(const Answer &answer, QueryType query_type, Proximity &message);

/** The same of a row that answers a question. */
void fillRow(const Answer &answer, const Question &question, QueryType query_type, Proximity &message);

/** The detail of a row. trajectory: of a motion whose gradient it is. Throws Error for too many violations. */
DetailMessage toMessage(const Row &row, const TrajectoryDescription *trajectory = nullptr);

/** The row of a curve or motion that could not be asked about. */
Proximity toFailedRow(const std::string &id, const std::string &kind, const std::string &why);

} // namespace curve_proximity
#endif
