/* SPDX-License-Identifier: BSD-3-Clause */
/** The two ways in which the command line gives up: BadUsage and BadInput, as its readers of files have them. */
#ifndef CURVE_PROXIMITY_CLI_FAILURE_H
#define CURVE_PROXIMITY_CLI_FAILURE_H

#include "../scene/yaml/failure.h"

namespace curve_proximity::cli {

using namespace yaml;

/** What the program leaves behind, as the manual promises. BadUsage: main() prints the one line and ends with kBadUsage. */
enum ExitCode { kAllAnswered = 0, kSomeRowsFailed = 1, kBadUsage = 2, kInterrupted = 130 };

} // namespace curve_proximity::cli
#endif
