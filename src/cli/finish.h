/* SPDX-License-Identifier: BSD-3-Clause */
/** What the commands that answer rows say at their beginning and their end. */
#ifndef CURVE_PROXIMITY_CLI_FINISH_H
#define CURVE_PROXIMITY_CLI_FINISH_H

#include <string>
#include <vector>

#include "console.h"
#include "results.h"
#include "run.h"

namespace curve_proximity::cli {

/** --timings: how long loading took. */
void tellTimings(const std::vector<std::string> &sentences, Console &console);

/** --skipped: what takes no part. */
void tellSkipped(const std::vector<std::string> &sentences, Console &console);

/** Notes the verdict of a row of the results, and its second opinion, so that finish() can count it. */
void noteVerdict(const ResultRow &row, Outcome &outcome);

/** The exit code that a run deserves, see ExitCode; says how many rows failed, and that it was interrupted. Warns of an
 *  input without rows, of rows that were measured against nothing, and of second opinions that disagree. */
int finish(const Tally &tally, Console &console);

} // namespace curve_proximity::cli
#endif
