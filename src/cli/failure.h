/* SPDX-License-Identifier: BSD-3-Clause */
/** The two ways in which the command line gives up. */
#ifndef CURVE_PROXIMITY_CLI_FAILURE_H
#define CURVE_PROXIMITY_CLI_FAILURE_H

#include <stdexcept>
#include <string>

namespace curve_proximity::cli {

/** What the program leaves behind, as the manual promises. */
enum ExitCode { kAllAnswered = 0, kSomeRowsFailed = 1, kBadUsage = 2, kInterrupted = 130 };

/** Options or input files that cannot be used: main() prints the one line and ends with kBadUsage. */
class BadUsage : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/** A row, or a value in a file, that cannot be used: what() names what and where within it. A row becomes an invalid
 *  row and the others are answered; a scene becomes BadUsage, for a scene that lacks an object answers wrongly. */
class BadInput : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

} // namespace curve_proximity::cli
#endif
