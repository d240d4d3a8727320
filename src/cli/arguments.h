/* SPDX-License-Identifier: BSD-3-Clause */
/** What was typed, checked: no file has been opened yet. */
#ifndef CURVE_PROXIMITY_CLI_ARGUMENTS_H
#define CURVE_PROXIMITY_CLI_ARGUMENTS_H

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <curve_proximity/query.hpp>

namespace curve_proximity::cli {

enum class Action { HELP, VERSION, CURVES, AGAINST, TRAJECTORY, PAIRS, CONSTRAINTS, SEND, CHECK };

struct Arguments {
  Action action = Action::HELP;
  Query query; /**< CURVES, AGAINST and PAIRS: the command, and how it is to be answered */

  std::string curves, scene;   /**< files; curves: of CURVES, AGAINST and CHECK, scene: of CURVES, CHECK and SEND */
  std::string against;         /**< file of AGAINST; of CHECK where it was given */
  std::string trajectory;      /**< file of TRAJECTORY; of CHECK where it was given */
  bool self = false;           /**< with a trajectory: ask about the robot itself, too */
  std::string certificate;     /**< file: written by CURVES, AGAINST and TRAJECTORY, empty: none; read by CHECK */
  std::string robot, srdf;     /**< files of the robot; empty: none */
  std::string state;           /**< "joint: value, …" */
  std::string pairs;           /**< file of PAIRS */
  std::string cases;           /**< file of CONSTRAINTS */
  std::string provider;        /**< CONSTRAINTS: the plugin */
  std::string parameters;      /**< CONSTRAINTS: "name: value, …" */
  std::string node;            /**< SEND: the node's name */
  std::optional<bool> replace; /**< SEND: as the file's is_diff says, unless set */
  std::string out;             /**< file of the results; empty: standard output */
  std::size_t threads = 1;
  bool skipped = false; /**< tell on standard error what takes no part, and why */
  bool timings = false; /**< tell on standard error how long loading takes */
};

/** Reads the words after the program's name. Throws BadUsage with one line for words, options and values that are not
 *  known, are missing, are given twice or cannot be meant. */
Arguments parseArguments(const std::vector<std::string> &words);

/** What --help prints. */
std::string helpText();

} // namespace curve_proximity::cli
#endif
