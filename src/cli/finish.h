/* SPDX-License-Identifier: BSD-3-Clause */
/** What the commands that answer rows say at their beginning and their end. */
#ifndef CURVE_PROXIMITY_CLI_FINISH_H
#define CURVE_PROXIMITY_CLI_FINISH_H

#include <string>
#include <vector>

#include "console.h"
#include "run.h"

namespace curve_proximity::cli {

/** --skipped: what takes no part. */
void tellSkipped(const std::vector<std::string> &sentences, Console &console);

/** The exit code that a run deserves; says how many rows failed, and that it was interrupted. */
int finish(const Tally &tally, Console &console);

} // namespace curve_proximity::cli
#endif
