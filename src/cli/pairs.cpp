/* SPDX-License-Identifier: BSD-3-Clause */
#include <variant>

#include "../scene/query/pair_query.h"
#include "../scene/yaml/scene_change.h"
#include "commands.h"
#include "exit_code.h"
#include "finish.h"
#include "packages.h"
#include "pairs_yaml.h"
#include "results.h"
#include "robot_file.h"
#include "run.h"
#include "world_files.h"

namespace curve_proximity::cli {
namespace {

/* A pair that can be asked about, or why it cannot. */
struct PairRow {
  std::size_t number = 0; /* in the file, from 1 */
  std::string id;
  std::variant<PairDescription, std::string> pair;
  Coverage coverage; /* of the entry */
};

/* The answer; throws Error where there is none. */
ResultRow measure(const PairDescription &pair, const Query &query, const ResourceOptions &resources,
                  Workspace &workspace) {
  const Answer answer = askPair(pair, query, resources, workspace);
  ResultRow row;
  row.kind = answer.kind;
  row.id = answer.id, row.a = answer.a, row.b = answer.b;
  row.result = answer.result;
  row.gap = answer.gap;
  row.microseconds = answer.microseconds;
  row.second_opinion = answer.second_opinion;
  row.message = answer.message;
  row.has_points = pair.asked != PairDescription::GROWTH;
  row.has_contact = pair.asked == PairDescription::TRANSLATING_CONTACT;
  row.has_t = row.has_verdict = isTranslating(pair.asked);
  return row;
}

Outcome failedPair(const PairRow &pair, const std::string &place, const std::string &why, cprox_status status,
                   const Columns &columns) {
  ResultRow row;
  row.kind = "pair";
  row.id = row.a = row.b = pair.id;
  row.result.status = status;
  row.message = why;
  Outcome out;
  out.text = resultsLine(row, columns);
  out.error_messages.push_back(place + ": " + why);
  return out;
}

Outcome answerPair(const PairRow &pair, const std::string &file, const Query &query, const ResourceOptions &resources,
                   const Columns &columns, Workspace &workspace) {
  const std::string place = file + ": row " + std::to_string(pair.number) + " (id '" + pair.id + "')";
  Outcome out;
  const auto work = [&] {
    if (const auto *why = std::get_if<std::string>(&pair.pair)) throw BadInput(*why);
    Query own = query;
    own.coverage = pair.coverage;
    const ResultRow row = measure(std::get<PairDescription>(pair.pair), own, resources, workspace);
    out.stopped = row.result.status == CPROX_STOPPED;
    out.text = resultsLine(row, columns);
    noteVerdict(row, out);
  };
  attempt(work, [&](cprox_status status, const char *why) { out = failedPair(pair, place, why, status, columns); });
  return out;
}

/* YAML nodes belong to one thread: what the others get is plain data. */
PairRow toPlain(const YamlValue &entry, std::size_t number, Warnings &warnings) {
  PairRow row;
  row.number = number;
  try {
    row.id = pairId(entry);
    Warnings own;
    row.pair = parsePair(entry, own);
    row.coverage = own.coverage();
    warnings.add(own);
  } catch (const std::exception &e) {
    row.pair = std::string(e.what());
  }
  return row;
}

} // namespace

int answerPairs(const Arguments &arguments, Console &console) {
  const std::vector<YamlValue> entries = readPairs(arguments.pairs);
  Columns columns; /* t_contact_lower where an entry asks for contact */
  for (const YamlValue &entry : entries) {
    const auto asked = entry.isMap() ? entry.find("ask") : std::nullopt;
    columns.contact = columns.contact || (asked && asked->isScalar() && asked->text() == "translating_contact");
  }
  ResourceOptions resources;
  resources.base_dir = folderOf(arguments.pairs);
  resources.find_package = packageFinder(resources.base_dir);
  Query query = arguments.query;
  query.options.stop = interrupted;
  query.second_opinion = secondOpinions(arguments, resources);
  columns.opinion = query.second_opinion != nullptr;

  Output output(arguments);
  if (arguments.skipped) tellSkipped({}, console);

  /* pair by pair; a warning is told when it first comes up */
  Warnings warnings;
  std::size_t given = 0, warned = 0;
  Rows rows;
  rows.next = [&]() -> std::optional<Task> {
    if (given == entries.size()) return std::nullopt;
    PairRow pair = toPlain(entries[given], given + 1, warnings);
    ++given;
    for (; warned < warnings.messages().size(); ++warned) console.say("warning: " + warnings.messages()[warned]);
    return [&, pair = std::move(pair)](Workspace &workspace) {
      return answerPair(pair, arguments.pairs, query, resources, columns, workspace);
    };
  };
  rows.portion = [&]() -> std::optional<double> {
    return entries.empty() ? 1.0 : static_cast<double>(given) / static_cast<double>(entries.size());
  };
  return output.answer(resultsHeader(columns), rows, console);
}

} // namespace curve_proximity::cli
