/* SPDX-License-Identifier: BSD-3-Clause */
/** The two ways in which the command line gives up: BadUsage and BadInput, as its readers of files have them. */
#ifndef CURVE_PROXIMITY_CLI_FAILURE_H
#define CURVE_PROXIMITY_CLI_FAILURE_H

#include "../scene/yaml/failure.h"

namespace curve_proximity::cli {

using namespace yaml;

/** What the program leaves behind, as the manual promises. BadUsage: main() prints the one line and ends with
 * kBadUsage. */
enum ExitCode {
  kAllAnswered = 0,    /**< of tolerance and collision: every verdict is clear */
  kSomeRowsFailed = 1, /**< of the commands without verdicts */
  kSomeViolated = 1,   /**< of tolerance and collision: a verdict is violated */
  kBadUsage = 2,       /**< of tolerance and collision also: a row has no answer */
  kSomeUndecided = 3,  /**< of tolerance and collision: none is violated, a verdict is undecided */
  kInterrupted = 130
};

} // namespace curve_proximity::cli
#endif
