/* SPDX-License-Identifier: BSD-3-Clause */
/** What the commands that answer rows do and say at their beginning and their end. */
#ifndef CURVE_PROXIMITY_CLI_FINISH_H
#define CURVE_PROXIMITY_CLI_FINISH_H

#include <optional>
#include <string>
#include <vector>

#include "arguments.h"
#include "console.h"
#include "results.h"
#include "row_text.h"
#include "run.h"

namespace curve_proximity::cli {

/** --timings: how long loading took. */
void tellTimings(const std::vector<std::string> &messages, Console &console);

/** --skipped: what takes no part. */
void tellSkipped(const std::vector<std::string> &messages, Console &console);

/** Notes what a row does not cover. */
void noteGap(const std::optional<Gap> &gap, Outcome &outcome);

/** Notes the verdict of a row of the results, and its second opinion, so that a run can count it. */
void noteVerdict(const ResultRow &row, Outcome &outcome);

/** The files that a run writes: the results, and certificates where these are wanted. */
class Output {
 public:
  /** Keeps the arguments. Throws BadUsage where a file cannot be written, or is one of the inputs. */
  explicit Output(const Arguments &arguments);

  /** Writes the header and answers all rows; rows.write and rows.certify are set here. Returns the exit code that the
   *  run deserves, see ExitCode; says how many rows failed, and that it was interrupted. Warns of an input without
   *  rows, of rows that were measured against nothing, and of second opinions that disagree. */
  int answer(const std::string &header, Rows rows, Console &console);

  /** The same of tasks that are all known. */
  int answer(const std::string &header, const std::vector<Task> &tasks, Console &console);

 private:
  const Arguments &arguments_;
  ResultsFile results_;
  RowText form_;
  std::optional<ResultsFile> certificates_;
};

/** Of a command whose --out is no table: that file, and its rows on standard output. */
class FileOutput {
 public:
  /** Throws BadUsage as Output does. */
  explicit FileOutput(const Arguments &arguments);

 private:
  Arguments of_rows_;

 public:
  ResultsFile file;
  Output rows;
};

} // namespace curve_proximity::cli
#endif
