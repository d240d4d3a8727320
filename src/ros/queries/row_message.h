/* SPDX-License-Identifier: BSD-3-Clause */
/** Rows of answers. */
#ifndef CURVE_PROXIMITY_ROS_ROW_MESSAGE_H
#define CURVE_PROXIMITY_ROS_ROW_MESSAGE_H

#include <curve_proximity/Profile.h>
#include <curve_proximity/Proximity.h>
#include <curve_proximity/ViolationIntervals.h>

#include <curve_proximity/query.hpp>
#include <string>
#include <vector>

namespace curve_proximity {

/** Fills one row of the results, which is as it was made. What has no answer has NaN for numbers. */
void fillRow(const Answer &answer, QueryType query_type, Proximity &message);

/** The row of a curve or motion that could not be asked about. */
Proximity toFailedRow(const std::string &id, const std::string &kind, const std::string &why);

/** The intervals of what the summary is about, without that. */
ViolationIntervals toMessage(const Violations &violations);

/** The profile of what the summary is about, without that. */
Profile toMessage(const std::vector<ClearanceInterval> &intervals);

} // namespace curve_proximity
#endif
