/* SPDX-License-Identifier: BSD-3-Clause */
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

/* The row of a curve that could not be asked about, and the sentence that says why. */
Outcome failedCurve(const std::string &id, const std::string &place, const std::string &why, cprox_status status,
                    bool with_proof) {
  ResultRow row;
  row.proof = with_proof ? "none" : "";
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
Outcome answerCurve(const CsvRow &csv, const std::string &file, const Targets &targets, const Query &query,
                    bool with_proof, Workspace &workspace) {
  const std::string id = rowId(csv.text);
  const std::string place = placeOf(csv, file);
  try {
    const CompiledCurve curve = compile(parseCurve(csv.text));
    Outcome out;
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
      out.text += resultsLine(row);
      noteVerdict(row, out);
      if (status < 0) {
        const std::string against = answer.b.empty() ? "" : ": against '" + answer.b + "'";
        out.complaints.push_back(place + against + ": " + answer.message);
      }
    }
    return out;
  } catch (const Error &e) {
    return failedCurve(id, place, e.what(), e.status(), with_proof);
  } catch (const std::bad_alloc &) {
    return failedCurve(id, place, cprox_status_text(CPROX_MEMORY), CPROX_MEMORY, with_proof);
  } catch (const std::exception &e) {
    return failedCurve(id, place, e.what(), CPROX_INVALID, with_proof);
  }
}

} // namespace

int answerCurves(const Arguments &arguments, Console &console) {
  /* what curves are measured against */
  Warnings warnings;
  const World world = readWorld(arguments, warnings);
  Query query = arguments.query;
  query.options.stop = interrupted;
  const Targets targets(world.snapshot, world.links, query);

  CsvFile file(arguments.curves);
  const std::vector<std::string> inputs{arguments.curves, arguments.scene, arguments.robot, arguments.srdf};
  ResultsFile results(arguments.out, inputs);
  std::optional<ResultsFile> certificates;
  const bool with_proofs = !arguments.certificate.empty();
  if (with_proofs) {
    certificates.emplace(arguments.certificate, inputs, "--certificate");
    warnOfUnprovable(unprovable(targets), warnings);
  }
  console.warn(warnings);
  if (arguments.timings) tellTimings(world.timings, console);
  if (arguments.skipped) tellSkipped(world.skipped, console);

  /* row by row */
  catchInterrupts();
  results.write(resultsHeader(with_proofs));
  Rows rows;
  rows.next = [&]() -> std::optional<Task> {
    std::optional<CsvRow> row = file.next();
    if (!row) return std::nullopt;
    return [&, csv = *std::move(row)](Workspace &workspace) {
      return answerCurve(csv, arguments.curves, targets, query, with_proofs, workspace);
    };
  };
  rows.write = [&](const std::string &text) { results.write(text); };
  if (certificates) rows.certify = [&](const std::string &records) { certificates->write(records); };
  rows.portion = [&] { return file.portion(); };
  return finish(runRows(arguments.threads, rows, console), query.query_type, console);
}

} // namespace curve_proximity::cli
