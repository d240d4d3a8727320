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

/** Notes the verdict of a row of the results, so that finish() can count it. */
void noteVerdict(const ResultRow &row, Outcome &outcome);

/** The exit code that a run deserves; says how many rows failed, and that it was interrupted. A shell may gate on the
 *  code of tolerance and collision: only 0 means that all is proven clear. A row without an answer (2) outweighs a
 *  violated verdict (1), and that an undecided one (3). Without any row nothing is proven (2). Warns of rows that were
 *  measured against nothing. */
int finish(const Tally &tally, QueryType query_type, Console &console);

} // namespace curve_proximity::cli
#endif
