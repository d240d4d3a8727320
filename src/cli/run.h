/* SPDX-License-Identifier: BSD-3-Clause */
/** Many rows by several threads, written in the order in which they came. */
#ifndef CURVE_PROXIMITY_CLI_RUN_H
#define CURVE_PROXIMITY_CLI_RUN_H

#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <curve_proximity/core.hpp>

#include "console.h"

namespace curve_proximity::cli {

/** What became of one row of the input. */
struct Outcome {
  std::string text;             /**< the lines of the results */
  std::string certificate;      /**< its record, where certificates are wanted */
  bool violated = false;        /**< a verdict is violated */
  bool undecided = false;       /**< a verdict is undecided */
  bool uncovered = false;       /**< it does not cover all that was given, though there was something to measure */
  bool disputed = false;        /**< a second opinion disagrees */
  bool against_nothing = false; /**< there was nothing to measure against */
  std::vector<std::string> error_messages; /**< for standard error: why there is no answer */
  std::vector<std::string> unproven;       /**< likewise, of an answer: why the certificate that is wanted is empty */
  bool stopped = false;                    /**< it was interrupted: it is not to be written */
};

/** Answers one row; called by one of the threads, each with its own workspace. Must not throw. */
using Task = std::function<Outcome(Workspace &)>;

/** Counts of a run so far. */
struct Tally {
  std::size_t rows = 0, failed = 0; /**< rows of the input */
  std::size_t unproven = 0;         /**< answers without the certificate that was wanted */
  std::size_t violated = 0;         /**< rows of the input with a violated verdict */
  std::size_t undecided = 0;        /**< and without one, but with an undecided verdict */
  std::size_t uncovered = 0;        /**< rows of the input that do not cover all that was given */
  std::size_t disputed = 0;         /**< rows of the input with a second opinion that disagrees */
  std::size_t against_nothing = 0;  /**< rows of the input that had nothing to measure against */
  bool interrupted = false;
};

/** Where the rows come from and where they go. Each function is called by one thread at a time; `next` may wait for its
 *  input while the others go on. */
struct Rows {
  std::function<std::optional<Task>()> next;        /**< nothing at the end */
  std::function<void(const std::string &)> write;   /**< lines of the results */
  std::function<void(const std::string &)> certify; /**< records of certificates; empty where none are wanted */
  std::function<std::optional<double>()> portion;   /**< of the input that has been read, 0 to 1, if it is known */
  std::function<void(const Tally &)> progress;      /**< instead of the usual progress line; may be empty */

  /** So many error messages are told; all are counted. */
  std::size_t most_messages = std::numeric_limits<std::size_t>::max();
};

/** From now on SIGINT and SIGTERM end a run in good order; a second one ends the program at once. */
void catchInterrupts();

/** Has there been one? To be polled by queries (cprox_options.stop). */
bool interrupted(void *);

/** Answers all rows with `threads` threads. Each row's lines are handed to `write` as soon as all rows before it are
 *  written, so that what stands in the output is always a beginning of the whole. Exceptions of `next` and `write` end
 *  the run and are thrown on. */
Tally runRows(std::size_t threads, const Rows &rows, Console &console);

} // namespace curve_proximity::cli
#endif
