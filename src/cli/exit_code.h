/* SPDX-License-Identifier: BSD-3-Clause */
/** The two ways in which the command line gives up: BadUsage and BadInput, as its readers of files have them. */
#ifndef CURVE_PROXIMITY_CLI_EXIT_CODE_H
#define CURVE_PROXIMITY_CLI_EXIT_CODE_H

#include <curve_proximity/core.hpp>
#include <new>

#include "../scene/yaml/bad_input.h"

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

/** Does the work of a row. Of what it throws becomes fail(status, why). */
template <class Work, class Fail>
void attempt(const Work &work, const Fail &fail) {
  try {
    work();
  } catch (const Error &e) {
    fail(e.status(), e.what());
  } catch (const std::bad_alloc &) {
    fail(CPROX_MEMORY, cprox_status_text(CPROX_MEMORY));
  } catch (const std::exception &e) {
    fail(CPROX_INVALID, e.what());
  }
}

} // namespace curve_proximity::cli
#endif
