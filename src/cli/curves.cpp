/* SPDX-License-Identifier: BSD-3-Clause */
#include <algorithm>

#include "answers.h"
#include "certificates.h"
#include "commands.h"
#include "csv.h"
#include "exit_code.h"
#include "finish.h"
#include "run.h"
#include "world_files.h"

namespace curve_proximity::cli {
namespace {

/* What curves are measured against: everything, or one object or link. */
struct Side {
  std::string name; /* empty: everything */
  SceneObstacles obstacles;
};

/* One side, or one for each object and link, where the query is about each and ask() does not part them itself. */
std::vector<Side> sidesOf(const World &world, const Arguments &arguments, const Query &query) {
  std::vector<Side> sides;
  const auto &objects = query.objects, &links = query.links;
  const auto add = [&](const std::string &name, std::vector<std::string> Query::*names) {
    const std::vector<std::string> &only = query.*names;
    if (!objects.empty() || !links.empty()) {
      if (std::find(only.begin(), only.end(), name) == only.end()) return;
    }
    Query named = query;
    named.objects.clear(), named.links.clear();
    (named.*names).push_back(name);
    sides.push_back({name, SceneObstacles(world.snapshot, world.links, named)});
  };
  if (query.per_object && !asksFor<question::Search>(arguments.question)) {
    for (const auto &object : world.snapshot->objects()) add(object.first, &Query::objects);
    for (const auto &link : world.links) {
      if (!world.snapshot->linkGeometry(link.first).empty()) add(link.first, &Query::links);
    }
    for (const auto &object : world.snapshot->attached()) add(object.first, &Query::objects);
  }
  if (sides.empty()) sides.push_back({"", SceneObstacles(world.snapshot, world.links, query)});
  return sides;
}

/* All rows of one curve. */
Outcome answerCurve(const CsvRow &csv, const std::vector<Side> &sides, const Arguments &arguments, const Query &query,
                    Workspace &workspace) {
  const std::string place = placeOf(csv, arguments.curves);
  CompiledCurve curve;
  Outcome out;
  const auto work = [&] {
    const CurveDescription description = parseCurve(csv.text);
    if (!arguments.certificate.empty()) requireCheckable(description);
    curve = compile(description);
    for (const Side &side : sides)
      answer({CurveSubject{side.obstacles, curve}, curve.id, "curve", place, {"", side.name}}, arguments, query,
             workspace, out);
  };
  attempt(work, [&](cprox_status status, const char *why) {
    out = Outcome();
    addFailure({CurveSubject{sides.front().obstacles, curve}, rowId(csv.text), "curve", place, {}}, arguments, status,
               why, out);
  });
  return out;
}

} // namespace

int answerCurves(const Arguments &arguments, Console &console) {
  /* what curves are measured against */
  Warnings warnings;
  const World world = readStandingWorld(arguments, "a query of curves", warnings);
  const Query query = queryOf(arguments, world, warnings);
  const std::vector<Side> sides = sidesOf(world, arguments, query);

  CsvFile file(arguments.curves);
  Output output(arguments);
  if (!arguments.certificate.empty()) warnOfUnprovable(unprovable(sides.front().obstacles), warnings);
  console.warn(warnings);
  if (arguments.timings) tellTimings(world.timings, console);
  if (arguments.skipped) tellSkipped(world.skipped, console);

  Rows rows;
  rows.next = [&]() -> std::optional<Task> {
    std::optional<CsvRow> row = file.next();
    if (!row) return std::nullopt;
    return [&, csv = *std::move(row)](Workspace &workspace) {
      return answerCurve(csv, sides, arguments, query, workspace);
    };
  };
  rows.portion = [&] { return file.portion(); };
  return output.answer(headerOf(arguments), rows, console);
}

} // namespace curve_proximity::cli
