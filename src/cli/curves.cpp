/* SPDX-License-Identifier: BSD-3-Clause */
#include "certificates.h"
#include "csv.h"
#include "failure.h"
#include "finish.h"
#include "results.h"
#include "run.h"
#include "verbs.h"
#include "world.h"

namespace curve_proximity::cli {
namespace {

/* The row of a curve that could not be asked about, and the sentence that says why. */
Outcome failedCurve(const std::string &id, const std::string &place, const std::string &why, cprox_status status) {
  ResultRow row;
  row.id = row.a = id;
  row.kind = "curve";
  row.result.status = status;
  Outcome out;
  out.text = resultsLine(row);
  out.complaints.push_back(place + ": " + why);
  out.certificate = emptyRecord();
  return out;
}

/* All rows of one curve. */
Outcome answerCurve(const CsvRow &csv, const std::string &file, const Targets &targets, const Question &question,
                    const std::optional<std::vector<cprox_target>> &to_certify, Workspace &workspace) {
  const std::string id = rowId(csv.text);
  const std::string place = placeOf(csv, file);
  try {
    const CompiledCurve curve = compile(parseCurve(csv.text));
    Outcome out;
    for (const Answer &answer : ask(targets, curve, question, workspace)) {
      const cprox_status status = answer.result.status;
      out.stopped = out.stopped || status == CPROX_STOPPED;
      out.text += resultsLine(toRow(answer, question.verb));
      if (to_certify) {
        cprox_result named = answer.result;
        named.target_index = coreTargetOf(targets, answer);
        out.certificate = certificateRecord(curve, *to_certify, named, question, workspace);
      }
      if (status < 0) {
        const std::string against = answer.b.empty() ? "" : ": against '" + answer.b + "'";
        out.complaints.push_back(place + against + ": " + answer.message);
      }
    }
    return out;
  } catch (const Error &e) {
    return failedCurve(id, place, e.what(), e.status());
  } catch (const std::bad_alloc &) {
    return failedCurve(id, place, cprox_status_text(CPROX_MEMORY), CPROX_MEMORY);
  } catch (const std::exception &e) {
    return failedCurve(id, place, e.what(), CPROX_INVALID);
  }
}

} // namespace

int answerCurves(const Arguments &arguments, Console &console) {
  /* what curves are measured against */
  Warnings warnings;
  const World world = readWorld(arguments, warnings);
  Question question = arguments.question;
  question.options.stop = interrupted;
  const Targets targets(world.snapshot, world.links, question);

  CsvFile file(arguments.curves);
  const std::vector<std::string> inputs{arguments.curves, arguments.scene, arguments.robot, arguments.srdf};
  ResultsFile results(arguments.out, inputs);
  std::optional<ResultsFile> certificates;
  std::optional<std::vector<cprox_target>> to_certify;
  if (!arguments.certificate.empty()) {
    certificates.emplace(arguments.certificate, inputs, "--certificate");
    to_certify = coreTargets(targets);
  }
  console.warn(warnings);
  if (arguments.skipped) tellSkipped(world.skipped, console);

  /* row by row */
  catchInterrupts();
  results.write(resultsHeader());
  Rows rows;
  rows.next = [&]() -> std::optional<Task> {
    std::optional<CsvRow> row = file.next();
    if (!row) return std::nullopt;
    return [&, csv = *std::move(row)](Workspace &workspace) {
      return answerCurve(csv, arguments.curves, targets, question, to_certify, workspace);
    };
  };
  rows.write = [&](const std::string &text) { results.write(text); };
  if (certificates) rows.certify = [&](const std::string &records) { certificates->write(records); };
  rows.portion = [&] { return file.portion(); };
  return finish(runRows(arguments.threads, rows, console), console);
}

} // namespace curve_proximity::cli
