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
#include "world.h"

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

/* What is asked of two bodies, without the time that it takes. */
cprox_result ask(const PairDescription &pair, const cprox_obstacle &a, const cprox_obstacle &b,
                 const cprox_options &options, Workspace &workspace) {
  const auto moving = [&](const auto &query, const cprox_options &with) {
    return query(translating(a, pair.velocity_a), translating(b, pair.velocity_b), pair.duration, with, workspace);
  };
  cprox_options unstopped = options; /* it is short and does not poll */
  unstopped.stop = nullptr;
  switch (pair.asked) {
    case PairDescription::TRANSLATING_DISTANCE: return moving(translatingDistance, unstopped);
    case PairDescription::TRANSLATING_CONTACT: return moving(translatingContact, options);
    case PairDescription::DISTANCE: return curve_proximity::pair(a, b, options, workspace);
    case PairDescription::GROWTH: break;
  }
  const cprox_growth growth = growthDistance(a, b, options, workspace);
  cprox_result out{};
  out.status = growth.status, out.lower = growth.lower, out.upper = growth.upper;
  out.distance_queries = growth.pairs;
  return out;
}

const char *kindOf(PairDescription::Asked asked) {
  switch (asked) {
    case PairDescription::GROWTH: return "growth";
    case PairDescription::TRANSLATING_DISTANCE: return "translating_distance";
    case PairDescription::TRANSLATING_CONTACT: return "translating_contact";
    case PairDescription::DISTANCE: break;
  }
  return "pair";
}

/* What a peer says of bodies that stand. */
void addOpinion(const PairDescription &pair, const Query &query, ResultRow &row) {
  if (!query.second_opinion || row.result.status < 0) return;
  if (pair.asked == PairDescription::DISTANCE) {
    row.second_opinion = query.second_opinion->ofPair(pair.a.shape, toIsometry(pair.a.pose), pair.b.shape,
                                                      toIsometry(pair.b.pose), row.result.lower, row.result.upper);
  } else {
    row.second_opinion.verdict = SecondOpinion::UNKNOWN;
    row.second_opinion.message = "no second opinion: peers are asked about bodies that stand";
  }
  if (!row.second_opinion.message.empty())
    row.message += (row.message.empty() ? "" : "; ") + row.second_opinion.message;
}

/* The answer; throws Error where there is none. */
ResultRow measure(const PairDescription &pair, const Query &query, const ResourceOptions &resources,
                  Workspace &workspace) {
  const Geometry a = makeGeometry(pair.a.shape, resources), b = makeGeometry(pair.b.shape, resources);
  ResultRow row;
  row.kind = kindOf(pair.asked);
  row.id = row.a = row.b = pair.id;
  row.has_points = pair.asked != PairDescription::GROWTH;
  row.has_contact = pair.asked == PairDescription::TRANSLATING_CONTACT;
  row.has_t = row.has_verdict = row.has_contact || pair.asked == PairDescription::TRANSLATING_DISTANCE;
  const auto begin = std::chrono::steady_clock::now();
  row.result = ask(pair, place(a, pair.a), place(b, pair.b), query.options, workspace);
  row.microseconds = std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - begin).count();
  if (row.result.status != CPROX_OK) row.message = cprox_status_text(row.result.status);
  addOpinion(pair, query, row);
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
  out.complaints.push_back(place + ": " + why);
  return out;
}

Outcome answerPair(const PairRow &pair, const std::string &file, const Query &query, const ResourceOptions &resources,
                   const Columns &columns, Workspace &workspace) {
  const std::string place = file + ": row " + std::to_string(pair.number) + " (id '" + pair.id + "')";
  try {
    if (const auto *why = std::get_if<std::string>(&pair.pair))
      return failedPair(pair, place, *why, CPROX_INVALID, columns);
    const ResultRow row = measure(std::get<PairDescription>(pair.pair), query, resources, workspace);
    Outcome out;
    out.stopped = row.result.status == CPROX_STOPPED;
    out.text = resultsLine(row, columns);
    noteVerdict(row, out);
    return out;
  } catch (const Error &e) {
    return failedPair(pair, place, e.what(), e.status(), columns);
  } catch (const std::bad_alloc &) {
    return failedPair(pair, place, cprox_status_text(CPROX_MEMORY), CPROX_MEMORY, columns);
  } catch (const std::exception &e) {
    return failedPair(pair, place, e.what(), CPROX_INVALID, columns);
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

  ResultsFile results(arguments.out, {arguments.pairs});
  if (arguments.skipped) tellSkipped({}, console);

  /* pair by pair; a warning is told when it first comes up */
  catchInterrupts();
  results.write(resultsHeader(columns));
  Warnings warnings;
  std::size_t given = 0, warned = 0;
  Rows rows;
  rows.next = [&]() -> std::optional<Task> {
    if (given == entries.size()) return std::nullopt;
    PairRow pair = toPlain(entries[given], given + 1, warnings);
    ++given;
    for (; warned < warnings.sentences().size(); ++warned) console.say("warning: " + warnings.sentences()[warned]);
    return [&, pair = std::move(pair)](Workspace &workspace) {
      return answerPair(pair, arguments.pairs, query, resources, columns, workspace);
    };
  };
  rows.write = [&](const std::string &text) { results.write(text); };
  rows.portion = [&]() -> std::optional<double> {
    return entries.empty() ? 1.0 : static_cast<double>(given) / static_cast<double>(entries.size());
  };
  return finish(runRows(arguments.threads, rows, console), console);
}

} // namespace curve_proximity::cli
