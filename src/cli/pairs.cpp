/* SPDX-License-Identifier: BSD-3-Clause */
#include <chrono>
#include <variant>

#include "../scene/yaml/scene_change.h"
#include "commands.h"
#include "failure.h"
#include "finish.h"
#include "packages.h"
#include "pairs_yaml.h"
#include "results.h"
#include "robot_file.h"
#include "run.h"

namespace curve_proximity::cli {
namespace {

/* A pair that can be asked about, or why it cannot. */
struct PairRow {
  std::size_t number = 0; /* in the file, from 1 */
  std::string id;
  std::variant<PairDescription, std::string> pair;
};

cprox_obstacle place(const Geometry &geometry, const PlacedShape &shape) {
  return cprox_obstacle_at(geometry.body.get(), shape.pose);
}

/* The signed distance; throws Error where there is none. */
ResultRow measure(const PairDescription &pair, const Query &query, const ResourceOptions &resources,
                  Workspace &workspace) {
  const Geometry a = makeGeometry(pair.a.shape, resources), b = makeGeometry(pair.b.shape, resources);
  ResultRow row;
  row.kind = "pair";
  row.id = row.a = row.b = pair.id;
  row.has_points = true;
  const auto begin = std::chrono::steady_clock::now();
  row.result = curve_proximity::pair(place(a, pair.a), place(b, pair.b), query.options, workspace);
  row.microseconds = std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - begin).count();
  if (row.result.status != CPROX_OK) row.message = cprox_status_text(row.result.status);
  return row;
}

Outcome failedPair(const PairRow &pair, const std::string &place, const std::string &why, cprox_status status) {
  ResultRow row;
  row.kind = "pair";
  row.id = row.a = row.b = pair.id;
  row.result.status = status;
  row.message = why;
  Outcome out;
  out.text = resultsLine(row);
  out.complaints.push_back(place + ": " + why);
  return out;
}

Outcome answerPair(const PairRow &pair, const std::string &file, const Query &query, const ResourceOptions &resources,
                   Workspace &workspace) {
  const std::string place = file + ": row " + std::to_string(pair.number) + " (id '" + pair.id + "')";
  try {
    if (const auto *why = std::get_if<std::string>(&pair.pair)) return failedPair(pair, place, *why, CPROX_INVALID);
    const ResultRow row = measure(std::get<PairDescription>(pair.pair), query, resources, workspace);
    Outcome out;
    out.stopped = row.result.status == CPROX_STOPPED;
    out.text = resultsLine(row);
    return out;
  } catch (const Error &e) {
    return failedPair(pair, place, e.what(), e.status());
  } catch (const std::bad_alloc &) {
    return failedPair(pair, place, cprox_status_text(CPROX_MEMORY), CPROX_MEMORY);
  } catch (const std::exception &e) {
    return failedPair(pair, place, e.what(), CPROX_INVALID);
  }
}

/* YAML nodes belong to one thread: what the others get is plain data. */
PairRow toPlain(const YamlValue &entry, std::size_t number, Warnings &warnings) {
  PairRow row;
  row.number = number;
  try {
    row.id = pairId(entry);
    row.pair = parsePair(entry, warnings);
  } catch (const std::exception &e) {
    row.pair = std::string(e.what());
  }
  return row;
}

} // namespace

int answerPairs(const Arguments &arguments, Console &console) {
  const std::vector<YamlValue> entries = readPairs(arguments.pairs);
  ResourceOptions resources;
  resources.base_dir = folderOf(arguments.pairs);
  resources.find_package = packageFinder(resources.base_dir);
  Query query = arguments.query;
  query.options.stop = interrupted;

  ResultsFile results(arguments.out, {arguments.pairs});
  if (arguments.skipped) tellSkipped({}, console);

  /* pair by pair; a warning is told when it first comes up */
  catchInterrupts();
  results.write(resultsHeader());
  Warnings warnings;
  std::size_t given = 0, warned = 0;
  Rows rows;
  rows.next = [&]() -> std::optional<Task> {
    if (given == entries.size()) return std::nullopt;
    PairRow pair = toPlain(entries[given], given + 1, warnings);
    ++given;
    for (; warned < warnings.sentences().size(); ++warned) console.say("warning: " + warnings.sentences()[warned]);
    return [&, pair = std::move(pair)](Workspace &workspace) {
      return answerPair(pair, arguments.pairs, query, resources, workspace);
    };
  };
  rows.write = [&](const std::string &text) { results.write(text); };
  rows.portion = [&]() -> std::optional<double> {
    return entries.empty() ? 1.0 : static_cast<double>(given) / static_cast<double>(entries.size());
  };
  return finish(runRows(arguments.threads, rows, console), console);
}

} // namespace curve_proximity::cli
