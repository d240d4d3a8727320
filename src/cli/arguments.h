/* SPDX-License-Identifier: BSD-3-Clause */
/** What was typed, checked: no file has been opened yet. */
#ifndef CURVE_PROXIMITY_CLI_ARGUMENTS_H
#define CURVE_PROXIMITY_CLI_ARGUMENTS_H

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <curve_proximity/query.hpp>

#include "../scene/query/question.h"

namespace curve_proximity::cli {

enum class Action {
  HELP,
  VERSION,
  COMPLETION,
  MANUAL,
  CURVES,
  AGAINST,
  TRAJECTORY,
  MOVERS,
  PAIRS,
  CONSTRAINTS,
  ROBUST,
  ACM,
  SPEED,
  MARGINS,
  SWEEP,
  REPORT,
  SEND,
  CHECK,
  CERTIFY,
  MERGE
};

struct Arguments {
  std::vector<std::string> words; /**< as they were typed */
  Action action = Action::HELP;
  std::string topic; /**< HELP: the command that it is about; empty: all */
  Query query;       /**< CURVES, AGAINST, PAIRS and REPORT: the command, and how it is to be answered */
  Question question; /**< of CURVES, TRAJECTORY, MOVERS, ROBUST, SPEED (without its constants) and MARGINS */

  question::Profile profile; /**< REPORT: of each curve or link */
  question::Nearest nearest; /**< REPORT */

  std::optional<Peer> second_opinion; /**< CURVES, TRAJECTORY and PAIRS: who measures pairs again */

  bool has_delta = false; /**< REPORT: ask for a verdict at query.delta, too */

  std::string curves, scene;   /**< files; curves: of CURVES, AGAINST and CHECK, scene: of CURVES, CHECK and SEND */
  bool synchronized = false;   /**< AGAINST: both curves are at the same parameter */
  std::string against;         /**< file of AGAINST; of CHECK where it was given */
  std::string trajectory;      /**< file of TRAJECTORY; of CHECK and CONSTRAINTS where it was given */
  std::string path, body;      /**< files of MOVERS: a nav_msgs/Path and what rides along it; empty: none */
  double radius = 0.0;         /**< [m] of the ball that rides along the path where there is no body */
  bool shortest_way = false;   /**< with a trajectory: continuous joints turn the shorter way between two waypoints */
  bool self = false;           /**< with a trajectory, or of MOVERS: ask about the robot itself, too */
  bool per_link = false;       /**< with a trajectory: for each link and attached object */
  std::string errors;          /**< file of ROBUST */
  std::string separation;      /**< file of SPEED */
  double resolution = 0.01;    /**< [m] SWEEP: the edge of a cell */
  std::string inside;          /**< file of SWEEP: the cells inside; empty: they are not wanted */
  std::string certificate;     /**< file: written by CURVES, AGAINST and TRAJECTORY, empty: none; read by CHECK */
  std::string robot, srdf;     /**< files of the robot; empty: none */
  std::string state;           /**< "joint: value, …" */
  std::string pairs;           /**< file of PAIRS */
  std::string cases;           /**< file of CONSTRAINTS */
  std::string provider;        /**< CONSTRAINTS: the plugin */
  std::string parameters;      /**< CONSTRAINTS: "name: value, …" */
  bool check_gradient = false; /**< CONSTRAINTS: hold gradients against differences */
  std::string node;            /**< SEND: the node's name */
  std::optional<bool> replace; /**< SEND: as the file's is_diff says, unless set */
  std::string dataset;         /**< CERTIFY: the manifest */
  std::size_t shards = 1;      /**< CERTIFY: into how many parts it is cut */
  std::optional<std::size_t> shard;  /**< CERTIFY: the one that is wanted; else all */
  std::string progress;              /**< CERTIFY: "line" or "json" */
  std::optional<std::string> failed; /**< CERTIFY: why all rows of the shard are failed */
  std::string shard_folder;          /**< MERGE */
  std::string out;                   /**< file of the results; empty: standard output */
  bool json = false;                 /**< rows as JSON, not as CSV */
  bool quiet = false;                /**< standard error has what ends the run alone */
  bool verbose = false;              /**< at the end, how many rows there were, and which */
  bool strict = false;               /**< a row that does not cover all that was given is one without an answer */
  std::size_t threads = 1;
  bool skipped = false;                        /**< tell on standard error what takes no part, and why */
  bool timings = false;                        /**< tell on standard error how long loading takes */
  double mesh_tolerance = 0.0;                 /**< [m] of ResourceOptions */
  bool allow_missing_geometry = false;         /**< of RobotOptions */
  std::map<std::string, std::string> packages; /**< folders of packages by name */
};

/** Reads the words after the program's name. Throws BadUsage with one line for words, options and values that are not
 *  known, are missing, are given twice or cannot be meant. */
Arguments parseArguments(const std::vector<std::string> &words);

/** The files that are read. */
std::vector<std::string> inputsOf(const Arguments &arguments);

} // namespace curve_proximity::cli
#endif
