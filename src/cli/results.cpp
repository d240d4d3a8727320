/* SPDX-License-Identifier: BSD-3-Clause */
#include "results.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>

#include "csv.h"
#include "exit_code.h"

namespace curve_proximity::cli {
namespace {

void appendPoint(std::string &line, const cprox_vec3 &v, bool known) {
  for (const double coordinate : {v.x, v.y, v.z}) appendField(line, coordinate, known);
}

/* What is handed over leaves in one piece, so that a run that is killed leaves no half row. */
void writeWhole(std::FILE *file) {
  std::setvbuf(file, nullptr, _IONBF, 0);
}

} // namespace

const char *statusOf(cprox_status status, const std::optional<Gap> &gap) {
  return gap && status >= 0 ? gapName(*gap) : cprox_status_name(status);
}

ResultRow toRow(const Answer &answer, QueryType query_type) {
  ResultRow row;
  row.id = answer.id;
  row.kind = answer.kind;
  row.result = answer.result;
  row.gap = answer.gap;
  row.a = answer.a;
  row.b = answer.b;
  row.microseconds = answer.microseconds;
  row.has_verdict = query_type != QueryType::DISTANCE || answer.is_unlisted;
  row.has_contact = query_type == QueryType::COLLISION; /* printed where the time of contact is asked for */
  row.has_t = row.has_points = answer.result.obstacle_index >= 0 && std::isfinite(answer.result.upper);
  row.has_t_b = row.has_t && answer.kind == "curve" && std::isfinite(answer.result.t_obstacle);
  row.second_opinion = answer.second_opinion;
  row.message = answer.message;
  return row;
}

std::string resultsHeader(const Columns &columns) {
  return std::string(
             "id,kind,status,verdict,lower,upper,t,a_x,a_y,a_z,b_x,b_y,b_z,a,b,nodes,distance_queries,microseconds,t_b,"
             "lod,message") +
         (columns.proof ? ",proof" : "") + (columns.contact ? ",t_contact_lower" : "") +
         (columns.opinion ? ",second_opinion,second_distance" : "") +
         (columns.scale ? ",certified_scale,refused_scale" : "") + "\n";
}

std::string resultsLine(const ResultRow &row, const Columns &columns) {
  const cprox_result &result = row.result;
  const bool answered = result.status >= 0;
  std::string line = quotedField(row.id) + ',' + row.kind + ',' + statusOf(result.status, row.gap) + ',';
  if (answered && row.has_verdict) line += cprox_verdict_name(result.verdict);

  appendField(line, result.lower, answered);
  appendField(line, result.upper, answered);
  appendField(line, result.t, answered && row.has_t);
  appendPoint(line, result.witness_mover, answered && row.has_points);
  appendPoint(line, result.witness_obstacle, answered && row.has_points);
  line += ',' + quotedField(row.a) + ',' + quotedField(row.b);

  /* what it cost, and the parameter of a second curve */
  if (answered) {
    char time[40];
    std::snprintf(time, sizeof time, "%.1f", row.microseconds);
    line += ',' + std::to_string(result.nodes) + ',' + std::to_string(result.distance_queries) + ',' + time;
    appendField(line, result.t_obstacle, row.has_t_b);
    line += std::string(",") + cprox_lod_name(result.lod);
  } else {
    line += ",,,,,";
  }
  line += ',' + quotedField(row.message);
  if (columns.proof) line += ',' + row.proof;
  if (columns.contact) appendField(line, result.t_contact_lower, answered && row.has_contact);
  if (columns.opinion) {
    line += std::string(",") + secondOpinionName(row.second_opinion.verdict);
    appendField(line, row.second_opinion.distance, std::isfinite(row.second_opinion.distance));
  }
  if (columns.scale) {
    appendField(line, row.certified_scale, answered);
    appendField(line, row.refused_scale, answered);
  }
  return line + '\n';
}

/* Why an interval or a margin is not as it should be; "": it is. */
template <class Row>
static std::string messageOf(const Row &row) {
  if (row.gap) return gapText(*row.gap);
  return row.status == CPROX_OK ? "" : cprox_status_text(row.status);
}

std::string profileHeader() {
  return "id,kind,status,t0,t1,lower,upper,t,a_x,a_y,a_z,b_x,b_y,b_z,a,b,message\n";
}

std::string profileLine(const std::string &id, const std::string &kind, const ClearanceInterval &interval) {
  std::string line = quotedField(id) + ',' + kind + ',' + statusOf(interval.status, interval.gap);
  for (const double value : {interval.t0, interval.t1, interval.lower, interval.upper}) appendField(line, value);
  const bool measured = std::isfinite(interval.upper);
  appendField(line, interval.t, measured);
  appendPoint(line, interval.witness_a, measured);
  appendPoint(line, interval.witness_b, measured);
  return line + ',' + quotedField(interval.a) + ',' + quotedField(interval.b) + ',' + quotedField(messageOf(interval)) +
         '\n';
}

std::string speedHeader() {
  return "id,status,t0,t1,lower,override,constant_override,unwatched_override,a,b,message\n";
}

std::string speedLine(const std::string &id, const ClearanceInterval &interval, double limit, double constant,
                      double unwatched) {
  std::string line = quotedField(id) + ',' + statusOf(interval.status, interval.gap);
  for (const double value : {interval.t0, interval.t1, interval.lower, limit, constant, unwatched})
    appendField(line, value);
  return line + ',' + quotedField(interval.a) + ',' + quotedField(interval.b) + ',' + quotedField(messageOf(interval)) +
         '\n';
}

std::string marginHeader() {
  return "id,status,object,direction,x,y,z,free,blocked,t,a,message\n";
}

std::string marginLine(const std::string &id, const ObjectMargin &margin) {
  std::string line = quotedField(id) + ',' + statusOf(margin.status, margin.gap) + ',' + quotedField(margin.object) +
                     ',' + margin.direction;
  for (const double coordinate : {margin.toward.x(), margin.toward.y(), margin.toward.z()})
    appendField(line, coordinate);
  appendField(line, margin.free);
  appendField(line, margin.blocked);
  appendField(line, margin.t, !margin.a.empty());
  return line + ',' + quotedField(margin.a) + ',' +
         quotedField(!margin.gap && margin.status == CPROX_PRECISION ? "the object grazes the way: more is not known"
                                                                     : messageOf(margin)) +
         '\n';
}

std::string violationsHeader() {
  return "id,kind,status,verdict,enter_lower,enter_upper,leave_lower,leave_upper,upper,t,a,b,message\n";
}

std::string violationLine(const std::string &id, const std::string &kind, const Violations &of,
                          const Violation &found) {
  std::string line =
      quotedField(id) + ',' + kind + ',' + statusOf(of.status, of.gap) + ',' + cprox_verdict_name(found.verdict);
  for (const double value :
       {found.enter_lower, found.enter_upper, found.leave_lower, found.leave_upper, found.upper, found.t})
    appendField(line, value);
  return line + ',' + quotedField(found.a) + ',' + quotedField(found.b) + ',' + quotedField(of.message) + '\n';
}

std::string clearLine(const std::string &id, const std::string &kind, cprox_status status, const std::string &message) {
  return quotedField(id) + ',' + kind + ',' + cprox_status_name(status) + ',' +
         cprox_verdict_name(CPROX_VERDICT_CLEAR) + ",,,,,,,,," + quotedField(message) + '\n';
}

std::string failedLine(const std::string &header, const std::string &id, const std::string &kind, cprox_status status,
                       const std::string &message) {
  const bool has_kind = header.rfind("id,kind,", 0) == 0;
  const auto columns = std::count(header.begin(), header.end(), ',') - (has_kind ? 2 : 1);
  return quotedField(id) + ',' + (has_kind ? kind + ',' : "") + cprox_status_name(status) +
         std::string(static_cast<std::size_t>(columns), ',') + quotedField(message) + '\n';
}

ResultsFile::ResultsFile(const std::string &path, const std::vector<std::string> &inputs, const std::string &option)
    : path_(path.empty() ? "standard output" : path), file_(path.empty() ? stdout : nullptr) {
  if (file_) {
    writeWhole(file_);
    return;
  }

  /* opening empties the file: not one that is yet to be read */
  for (const std::string &input : inputs) {
    std::error_code error;
    if (std::filesystem::equivalent(path, input, error))
      throw BadUsage(option + " " + path + ": is an input of this run");
  }
  errno = 0;
  file_ = std::fopen(path.c_str(), "wb");
  if (!file_) throw BadUsage(option + " " + path + ": cannot be written: " + std::strerror(errno));
  writeWhole(file_);
}

ResultsFile::~ResultsFile() {
  if (file_ != stdout) std::fclose(file_);
}

void ResultsFile::write(const std::string &text) {
  errno = 0;
  const bool written = std::fwrite(text.data(), 1, text.size(), file_) == text.size() && std::fflush(file_) == 0;
  if (!written) throw std::runtime_error(path_ + ": writing failed: " + std::strerror(errno));
}

} // namespace curve_proximity::cli
