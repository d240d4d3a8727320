/* SPDX-License-Identifier: BSD-3-Clause */
/** The results as CSV: one shape of row for all commands. */
#ifndef CURVE_PROXIMITY_CLI_RESULTS_H
#define CURVE_PROXIMITY_CLI_RESULTS_H

#include <cstdio>
#include <string>
#include <vector>

#include <curve_proximity/margins.hpp>
#include <curve_proximity/query.hpp>

namespace curve_proximity::cli {

/** One row. Where result.status is negative there is no answer, and its numbers stay empty. */
struct ResultRow {
  std::string id, kind;
  cprox_result result{};
  std::string a, b;
  double microseconds = 0.0;
  bool has_verdict = false;     /**< tolerance and collision */
  bool has_contact = false;     /**< a time of contact was asked for */
  bool has_t = false;           /**< the witness has a parameter: there is a curve, and something to measure against */
  bool has_t_b = false;         /**< so has that of a second curve */
  bool has_points = false;      /**< there is something to measure against */
  std::optional<Gap> gap;       /**< what the row does not cover: it names the status */
  std::string proof;            /**< where certificates are asked for: what is proven (proofOf()) */
  SecondOpinion second_opinion; /**< where one is asked for */
  double certified_scale = 0.0, refused_scale = 0.0; /**< of bounds of errors */
  std::string message;                               /**< why there is no answer, or a remark */
};

/** Which columns the results have beyond those that all have. */
struct Columns {
  bool proof = false;   /**< of certificates */
  bool contact = false; /**< t_contact_lower */
  bool opinion = false; /**< second_opinion, second_distance */
  bool scale = false;   /**< certified_scale, refused_scale */
};

/** The column status: the gap, or what the core says. */
const char *statusOf(cprox_status status, const std::optional<Gap> &gap);

/** What the scene says, as a row. */
ResultRow toRow(const Answer &answer, QueryType query_type);

/** The first line, with its newline. */
std::string resultsHeader(const Columns &columns = {});

/** The line of a row, with its newline. Numbers have 17 significant digits. */
std::string resultsLine(const ResultRow &row, const Columns &columns = {});

/** The same of clearance profiles: a line an interval. id and kind are those of the curve or motion. */
std::string profileHeader();
std::string profileLine(const std::string &id, const std::string &kind, const ClearanceInterval &interval);

/** The same of limits of the speed: a line an interval. */
std::string speedHeader();
std::string speedLine(const std::string &id, const ClearanceInterval &interval, double limit, double constant,
                      double unwatched);

/** The same of margins: a line an object and direction. */
std::string marginHeader();
std::string marginLine(const std::string &id, const ObjectMargin &margin);

/** The same of violations: a line each. Without any: the line that all is clear. */
std::string violationsHeader();
std::string violationLine(const std::string &id, const std::string &kind, const Violations &of, const Violation &found);
std::string clearLine(const std::string &id, const std::string &kind, cprox_status status, const std::string &message);

/** The line of what there is no answer to, in the columns of one of these headers. */
std::string failedLine(const std::string &header, const std::string &id, const std::string &kind, cprox_status status,
                       const std::string &message);

/** Where results go: standard output, or a file that is written anew. */
class ResultsFile {
 public:
  /** path empty: standard output. Throws BadUsage, naming the option, where the file cannot be written, or is one of
   *  the inputs. */
  ResultsFile(const std::string &path, const std::vector<std::string> &inputs, const std::string &option = "--out");
  ~ResultsFile();
  ResultsFile(const ResultsFile &) = delete;
  ResultsFile &operator=(const ResultsFile &) = delete;

  /** Hands the text on to the system at once, so that a run that is killed keeps it. Throws std::runtime_error where
   *  that fails (the disk is full). */
  void write(const std::string &text);

 private:
  std::string path_;
  std::FILE *file_;
};

} // namespace curve_proximity::cli
#endif
