/* SPDX-License-Identifier: BSD-3-Clause */
/** The two ways in which the command line gives up: BadUsage and BadInput, as its readers of files have them. */
#ifndef CURVE_PROXIMITY_CLI_FAILURE_H
#define CURVE_PROXIMITY_CLI_FAILURE_H

#include "../scene/yaml/failure.h"

namespace curve_proximity::cli {

using namespace yaml;

/** What the program leaves behind: one rule for all commands. BadUsage: main() prints the one line and ends with
 *  kUnanswered. Of several, kUnanswered comes before kSomeViolated, and that before kSomeUndecided. */
enum ExitCode {
  kAllAnswered = 0,   /**< every row is answered; every verdict is clear, every certificate proven */
  kSomeViolated = 1,  /**< a verdict is violated, or a certificate does not prove its answer */
  kUnanswered = 2,    /**< a row has no answer, there is no row, or the command line or a file cannot be used */
  kSomeUndecided = 3, /**< a verdict is undecided */
  kInterrupted = 130
};

} // namespace curve_proximity::cli
#endif
