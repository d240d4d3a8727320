/* SPDX-License-Identifier: BSD-3-Clause */
/** The results of constraints as CSV: answers about sides and curves, about trajectories, and checks of gradients. */
#ifndef CURVE_PROXIMITY_CLI_CONSTRAINT_LINES_H
#define CURVE_PROXIMITY_CLI_CONSTRAINT_LINES_H

#include <string>

#include "../providers/check_gradient.h"
#include "../providers/constraint_case.h"

namespace curve_proximity::cli {

/** The first line, with its newline; of a trajectory with a column for each number of its points. */
std::string constraintsHeader();
std::string constraintsHeader(const TrajectoryDescription &trajectory);
std::string gradientsHeader();

/** The line of an answer about sides or a curve. A row without an answer has a status and a message alone. */
std::string constraintsLine(const ConstraintRow &row);

/** The lines of an answer about a trajectory, one for each of its rows; one without numbers where it has none. */
std::string constraintsLines(const ConstraintRow &row, const TrajectoryDescription &trajectory);

/** The line of a check; check: none where the row has no answer. */
std::string gradientsLine(const ConstraintRow &row, const GradientCheck *check);

} // namespace curve_proximity::cli
#endif
