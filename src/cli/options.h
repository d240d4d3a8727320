/* SPDX-License-Identifier: BSD-3-Clause */
/** The commands of cprox and their options: what may be typed, and what the help says of it. */
#ifndef CURVE_PROXIMITY_CLI_OPTIONS_H
#define CURVE_PROXIMITY_CLI_OPTIONS_H

#include <string>
#include <vector>

#include "arguments.h"

namespace curve_proximity::cli {

struct Command {
  const char *word;
  Action action;
  const char *usage; /**< a form a line, behind "cprox WORD"; INPUTS: those of inputForms() */
  const char *help;
  const char *examples; /**< a line each, behind "cprox " */
  const char *columns;  /**< of its results; "": it has none */
  QueryType query_type = QueryType::DISTANCE;
  Question question = question::Search{};
};

struct Option {
  const char *name;
  const char *value;    /**< the word for its value; "" where it has none */
  const char *commands; /**< the commands that take it; "queries": the seven questions about what moves */
  const char *help;
};

/** In the order of the help. */
const std::vector<Command> &commands();

/** In the order of the help. */
const std::vector<Option> &options();

/** Null for any other word. */
const Command *findCommand(const std::string &word);
const Option *findOption(const std::string &name);

/** The words of the commands that take the option. */
std::vector<std::string> commandsOf(const Option &option);

/** Does the command take it? */
bool takes(const Command &command, const Option &option);

} // namespace curve_proximity::cli
#endif
