/* SPDX-License-Identifier: BSD-3-Clause */
#include <algorithm>

#include "asking.h"
#include "certificates.h"
#include "commands.h"
#include "csv.h"
#include "failure.h"
#include "finish.h"
#include "results.h"
#include "run.h"
#include "world.h"

namespace curve_proximity::cli {
namespace {

/* What curves are measured against: everything, or one object or link. */
struct Side {
  std::string name; /* empty: everything */
  Targets targets;
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
    sides.push_back({name, Targets(world.snapshot, world.links, named)});
  };
  if (query.per_object && arguments.asking != Asking::SEARCH) {
    for (const auto &object : world.snapshot->objects()) add(object.first, &Query::objects);
    for (const auto &link : world.links) {
      if (!world.snapshot->linkGeometry(link.first).empty()) add(link.first, &Query::links);
    }
    for (const auto &object : world.snapshot->attached()) add(object.first, &Query::objects);
  }
  if (sides.empty()) sides.push_back({"", Targets(world.snapshot, world.links, query)});
  return sides;
}

/* The intervals of one curve, with its certificate where one is wanted. */
void search(const CompiledCurve &curve, const std::string &place, const Targets &targets, const Arguments &arguments,
            const Query &query, Workspace &workspace, Outcome &out) {
  const bool with_proof = !arguments.certificate.empty();
  const CertificateHandle proof = makeCertificate();
  Query asked = query;
  if (with_proof) asked.options.certificate = proof.get();
  for (const Answer &answer : ask(targets, curve, asked, workspace)) {
    const cprox_status status = answer.result.status;
    out.stopped = out.stopped || status == CPROX_STOPPED;
    ResultRow row = toRow(answer, query.query_type);
    if (with_proof) row.proof = proofOf(proof);
    if (with_proof) out.certificate = recordOf(proof);
    if (!answer.unproven.empty()) out.unproven.push_back(place + ": no certificate: " + answer.unproven);
    out.text += resultsLine(row, columnsOf(arguments));
    noteVerdict(row, out);
    if (status < 0) {
      const std::string against = answer.b.empty() ? "" : ": against '" + answer.b + "'";
      out.complaints.push_back(place + against + ": " + answer.message);
    }
  }
}

/* All rows of one curve. */
Outcome answerCurve(const CsvRow &csv, const std::vector<Side> &sides, const Arguments &arguments, const Query &query,
                    Workspace &workspace) {
  const std::string place = placeOf(csv, arguments.curves);
  CompiledCurve curve;
  CurveSubject failed(sides.front().targets, curve); // a curve that could not be asked about
  failed.id = rowId(csv.text);
  failed.place = place;
  const auto fail = [&](cprox_status status, const std::string &why) {
    Outcome out;
    addFailure(failed, arguments, status, why, out);
    out.certificate = emptyRecord();
    return out;
  };
  try {
    const CurveDescription description = parseCurve(csv.text);
    if (!arguments.certificate.empty()) requireCheckable(description);
    curve = compile(description);
    Outcome out;
    for (const Side &side : sides) {
      if (arguments.asking == Asking::SEARCH) {
        search(curve, place, side.targets, arguments, query, workspace, out);
        continue;
      }
      CurveSubject subject(side.targets, curve);
      subject.place = place;
      subject.object = side.name;
      answer(subject, arguments, query, workspace, out);
    }
    return out;
  } catch (const Error &e) {
    return fail(e.status(), e.what());
  } catch (const std::bad_alloc &) {
    return fail(CPROX_MEMORY, cprox_status_text(CPROX_MEMORY));
  } catch (const std::exception &e) {
    return fail(CPROX_INVALID, e.what());
  }
}

} // namespace

int answerCurves(const Arguments &arguments, Console &console) {
  /* what curves are measured against */
  Warnings warnings;
  const World world = readStandingWorld(arguments, "a query of curves", warnings);
  Query query = arguments.query;
  query.options.stop = interrupted;
  query.coverage = warnings.coverage();
  query.second_opinion = secondOpinions(arguments, world.resources);
  const std::vector<Side> sides = sidesOf(world, arguments, query);

  CsvFile file(arguments.curves);
  const std::vector<std::string> inputs{arguments.curves, arguments.scene, arguments.robot, arguments.srdf};
  ResultsFile results(arguments.out, inputs);
  std::optional<ResultsFile> certificates;
  if (!arguments.certificate.empty()) {
    certificates.emplace(arguments.certificate, inputs, "--certificate");
    warnOfUnprovable(unprovable(sides.front().targets), warnings);
  }
  console.warn(warnings);
  if (arguments.timings) tellTimings(world.timings, console);
  if (arguments.skipped) tellSkipped(world.skipped, console);

  /* row by row */
  catchInterrupts();
  results.write(headerOf(arguments));
  Rows rows;
  rows.next = [&]() -> std::optional<Task> {
    std::optional<CsvRow> row = file.next();
    if (!row) return std::nullopt;
    return [&, csv = *std::move(row)](Workspace &workspace) {
      return answerCurve(csv, sides, arguments, query, workspace);
    };
  };
  rows.write = [&](const std::string &text) { results.write(text); };
  if (certificates) rows.certify = [&](const std::string &records) { certificates->write(records); };
  rows.portion = [&] { return file.portion(); };
  return finish(runRows(arguments.threads, rows, console), console);
}

} // namespace curve_proximity::cli
