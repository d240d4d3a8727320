/* SPDX-License-Identifier: BSD-3-Clause */
/** The rows about one subject, as lines of the results. */
#ifndef CURVE_PROXIMITY_CLI_ANSWERS_H
#define CURVE_PROXIMITY_CLI_ANSWERS_H

#include <string>
#include <vector>

#include "../scene/query/subject.h"
#include "arguments.h"
#include "results.h"
#include "run.h"

namespace curve_proximity::cli {

/** What is asked about, and how its rows name it. */
struct Asked {
  Subject subject;
  std::string id, kind;  /**< the columns */
  std::string place;     /**< for error messages: "curves.csv: row 3 (line 5, id 'a')" */
  Part part;             /**< rows are about this part alone */
  bool ends_run = false; /**< what is wrong with the query ends the run, and is no row */
};

/** The first line of the results, with its newline. */
std::string headerOf(const Arguments &arguments);

/** The columns that the results have beyond the common ones. */
Columns columnsOf(const Arguments &arguments);

/** Adds the rows that answer arguments.question, and the record of their certificate where one is wanted. Throws
 *  only where asked.ends_run. */
void answer(const Asked &asked, const Arguments &arguments, const Query &query, Workspace &workspace, Outcome &out);

/** A task for each part of it that has rows of its own. query is kept by reference. */
void addTasks(const Asked &asked, const Arguments &arguments, const Query &query, std::vector<Task> &tasks);

/** Adds a row without an answer, and the error message that says why. subject: its id, kind, place and part. */
void addFailure(const Asked &asked, const Arguments &arguments, cprox_status status, const std::string &why,
                Outcome &out);

} // namespace curve_proximity::cli
#endif
