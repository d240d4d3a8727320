/* SPDX-License-Identifier: BSD-3-Clause */
/* Curves against curves: row i of one file against row i of the other. */
#include <chrono>

#include "answers.h"
#include "certificates.h"
#include "commands.h"
#include "csv.h"
#include "exit_code.h"
#include "finish.h"
#include "run.h"

namespace curve_proximity::cli {
namespace {

/* What a row of one file and the row of the other need to be answered. */
struct RowPair {
  std::optional<CsvRow> first, second;
};

cprox_status search(const CompiledCurve &a, const CompiledCurve &b, bool synchronized, const Query &query,
                    Workspace &workspace, cprox_result &result) {
  const cprox_mover mover = moverOf(a);
  const cprox_obstacle obstacle =
      synchronized ? cprox_synchronized(moverOf(b)) : cprox_obstacle_curve(b.curve.get(), b.radius);
  if (!synchronized && b.radius_curve) throw Error("the radius of the second curve changes: give --synchronized");
  switch (query.query_type) {
    case QueryType::DISTANCE: return cprox_distance(mover, obstacle, &query.options, workspace.get(), &result);
    case QueryType::TOLERANCE:
      return cprox_tolerance(mover, obstacle, query.delta, &query.options, workspace.get(), &result);
    case QueryType::COLLISION: return cprox_collision(mover, obstacle, &query.options, workspace.get(), &result);
  }
  return CPROX_INVALID;
}

/* Reads and compiles one side; what is wrong with it is thrown with its place. */
CompiledCurve curveOf(const std::optional<CsvRow> &row, const std::string &file, bool with_proof) {
  if (!row) throw BadInput(file + ": has no row for it");
  try {
    const CurveDescription description = parseCurve(row->text);
    if (with_proof) requireCheckable(description);
    return compile(description);
  } catch (const std::bad_alloc &) {
    throw;
  } catch (const std::exception &e) {
    throw BadInput(placeOf(*row, file) + ": " + e.what());
  }
}

Outcome answerPair(const RowPair &rows, const Arguments &arguments, const Query &given, Workspace &workspace) {
  const CertificateHandle proof = makeCertificate();
  const bool with_proof = !arguments.certificate.empty();
  Query query = given;
  if (with_proof) query.options.certificate = proof.get();
  using Clock = std::chrono::steady_clock;
  ResultRow row;
  row.kind = "curve_curve";
  row.id = row.a = rows.first ? rowId(rows.first->text) : "";
  row.b = rows.second ? rowId(rows.second->text) : "";
  row.has_verdict = query.query_type != QueryType::DISTANCE;
  Outcome out;
  try {
    const CompiledCurve a = curveOf(rows.first, arguments.curves, with_proof),
                        b = curveOf(rows.second, arguments.against, with_proof);
    const Clock::time_point start = Clock::now();
    row.result.status = search(a, b, arguments.synchronized, query, workspace, row.result);
    row.microseconds = std::chrono::duration<double, std::micro>(Clock::now() - start).count();
    row.has_t = row.has_t_b = row.has_points = row.result.obstacle_index >= 0;
    out.stopped = row.result.status == CPROX_STOPPED;
    if (row.result.status != CPROX_OK) row.message = cprox_status_text(row.result.status);
    if (row.result.status < 0) {
      row.message = cprox_workspace_error(workspace.get());
      out.error_messages.push_back(placeOf(*rows.first, arguments.curves) + ": " + row.message);
    }
    if (with_proof && row.result.status >= 0 && cprox_certificate_get_info(proof.get()).size == 0)
      out.unproven.push_back(placeOf(*rows.first, arguments.curves) + ": " + cprox_workspace_error(workspace.get()));
  } catch (const std::bad_alloc &) {
    row.result.status = CPROX_MEMORY;
    row.message = cprox_status_text(CPROX_MEMORY);
    out.error_messages.push_back(arguments.curves + ": id '" + row.id + "': " + cprox_status_text(CPROX_MEMORY));
  } catch (const std::exception &e) {
    row.result.status = CPROX_INVALID;
    row.message = e.what();
    const bool own = !rows.second && rows.first;
    out.error_messages.push_back(own ? placeOf(*rows.first, arguments.curves) + ": " + e.what() : e.what());
  }
  if (with_proof) row.proof = proofOf(proof);
  if (with_proof) out.certificate = recordOf(proof);
  out.text = resultsLine(row, columnsOf(arguments));
  noteVerdict(row, out);
  return out;
}

} // namespace

int answerAgainst(const Arguments &arguments, Console &console) {
  Query query = arguments.query;
  query.options.stop = interrupted;
  CsvFile first(arguments.curves), second(arguments.against);
  Output output(arguments);
  Warnings warnings;
  console.warn(warnings);

  Rows rows;
  rows.next = [&]() -> std::optional<Task> {
    RowPair pair{first.next(), second.next()};
    if (!pair.first && !pair.second) return std::nullopt;
    return [&, pair = std::move(pair)](Workspace &workspace) { return answerPair(pair, arguments, query, workspace); };
  };
  rows.portion = [&] { return first.portion(); };
  return output.answer(headerOf(arguments), rows, console);
}

} // namespace curve_proximity::cli
