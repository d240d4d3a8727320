/* SPDX-License-Identifier: BSD-3-Clause */
#include "answers.h"

#include <cmath>
#include <utility>

#include "certificates.h"
#include "exit_code.h"
#include "finish.h"

namespace curve_proximity::cli {
namespace {

/* In a row about one link that link is side a. */
template <class Sides>
void putLinkFirst(const std::string &link, Sides &sides, cprox_vec3 &point_a, cprox_vec3 &point_b) {
  if (link.empty() || sides.a == link) return;
  if (sides.b == link) {
    sides.b = sides.a;
    std::swap(point_a, point_b);
  }
  sides.a = link;
}

/* Adds the lines of a row: which they are says its detail. */
class Lines {
 public:
  Lines(const Asked &asked, const Arguments &arguments, const std::string &proof, Outcome &out)
      : asked_(asked), arguments_(arguments), proof_(proof), out_(out) {}

  void add(Row row) {
    const auto *scale = std::get_if<RobustScale>(&row.detail);
    if (scale || std::holds_alternative<std::monostate>(row.detail)) return add(std::move(row.answer), scale);
    std::visit([&](auto &detail) { add(detail); }, row.detail);
  }

 private:
  void add(Answer answer, const RobustScale *scale) {
    answer.id = asked_.id;
    putLinkFirst(asked_.part.link, answer, answer.result.witness_mover, answer.result.witness_obstacle);
    const bool one_of_several = asked_.kind == "curve" && !answer.b.empty();
    const std::string against = one_of_several ? ": against '" + answer.b + "'" : "";
    if (answer.b.empty()) answer.b = asked_.part.object;
    out_.stopped = out_.stopped || answer.result.status == CPROX_STOPPED;
    ResultRow row = toRow(answer, arguments_.query.query_type);
    row.proof = proof_;
    if (scale) row.certified_scale = scale->certified, row.refused_scale = scale->refused;
    out_.text += resultsLine(row, columnsOf(arguments_));
    noteVerdict(row, out_);
    if (!answer.unproven.empty()) out_.unproven.push_back(asked_.place + ": no certificate: " + answer.unproven);
    if (answer.result.status < 0) out_.error_messages.push_back(asked_.place + against + ": " + answer.message);
  }

  void add(std::vector<ClearanceInterval> &profile) {
    for (ClearanceInterval &interval : profile) {
      putLinkFirst(asked_.part.link, interval, interval.witness_a, interval.witness_b);
      if (interval.b.empty()) interval.b = asked_.part.object;
      out_.stopped = out_.stopped || interval.status == CPROX_STOPPED;
      out_.against_nothing = out_.against_nothing || interval.gap == Gap::EMPTY || std::isinf(interval.lower);
      noteGap(interval.gap, out_);
      out_.text += profileLine(asked_.id, asked_.kind, interval);
    }
    if (arguments_.certificate.empty()) return;
    std::vector<std::string> proofs;
    std::size_t measured = 0;
    std::string why;
    for (const ClearanceInterval &interval : profile) {
      if (why.empty()) why = interval.unproven;
      measured += std::isfinite(interval.lower) && interval.status >= 0 ? 1 : 0;
      if (!interval.certificate.empty()) proofs.push_back(interval.certificate);
    }
    out_.certificate = recordOf(proofs);
    if (proofs.size() < measured)
      out_.unproven.push_back(asked_.place + ": no certificate of " + std::to_string(measured - proofs.size()) +
                              " of " + std::to_string(measured) + " intervals: " + why);
  }

  void add(const Violations &found) {
    out_.stopped = out_.stopped || found.status == CPROX_STOPPED;
    out_.against_nothing = out_.against_nothing || !found.measured;
    noteGap(found.gap, out_);
    if (found.list.empty()) out_.text += clearLine(asked_.id, asked_.kind, found.status, found.message);
    for (Violation one : found.list) {
      if (!asked_.part.link.empty() && one.b == asked_.part.link) std::swap(one.a, one.b);
      out_.violated = out_.violated || one.verdict == CPROX_VERDICT_VIOLATED;
      out_.undecided = out_.undecided || one.verdict == CPROX_VERDICT_UNDECIDED;
      out_.text += violationLine(asked_.id, asked_.kind, found, one);
    }
    if (arguments_.certificate.empty()) return;
    out_.certificate = recordOf(found.certificates);
    if (!found.unproven.empty())
      out_.unproven.push_back(asked_.place + ": a part has no certificate: " + found.unproven);
  }

  void add(const SpeedLimits &limits) {
    for (std::size_t i = 0; i < limits.profile.size(); ++i) {
      const ClearanceInterval &interval = limits.profile[i];
      out_.stopped = out_.stopped || interval.status == CPROX_STOPPED;
      out_.against_nothing = out_.against_nothing || interval.gap == Gap::EMPTY;
      noteGap(interval.gap, out_);
      out_.text += speedLine(asked_.id, interval, limits.overrides[i], limits.constant, limits.unwatched);
    }
  }

  void add(const std::vector<ObjectMargin> &margins) {
    out_.against_nothing = margins.empty();
    for (const ObjectMargin &margin : margins) {
      out_.stopped = out_.stopped || margin.status == CPROX_STOPPED;
      out_.violated = out_.violated || margin.blocked == 0.0;
      noteGap(margin.gap, out_);
      out_.text += marginLine(asked_.id, margin);
    }
  }

  /* No command asks for derivatives, and a swept volume is no row. */
  template <class Detail>
  void add(const Detail &) {}

  const Asked &asked_;
  const Arguments &arguments_;
  const std::string &proof_;
  Outcome &out_;
};

void addRows(const Asked &asked, const Arguments &arguments, const Query &query, Workspace &workspace, Outcome &out) {
  const bool with_proof = !arguments.certificate.empty();
  const CertificateHandle proof = makeCertificate();
  Query proven;
  if (with_proof) proven = query, proven.options.certificate = proof.get();
  std::vector<Row> rows = curve_proximity::answer(asked.subject, asked.part, arguments.question,
                                                  with_proof ? proven : query, Beside::NOTHING, workspace);
  const std::string claim = with_proof ? proofOf(proof) : "";
  if (with_proof) out.certificate = recordOf(proof);
  const auto *nearest = std::get_if<question::Nearest>(&arguments.question);
  if (nearest && rows.empty() && std::isinf(nearest->limits.within)) out.against_nothing = true;
  Lines lines(asked, arguments, claim, out);
  for (Row &row : rows) lines.add(std::move(row));
}

} // namespace

Columns columnsOf(const Arguments &arguments) {
  Columns columns;
  columns.proof = !arguments.certificate.empty();
  columns.contact = asksFor<question::Contact>(arguments.question);
  columns.opinion = arguments.second_opinion.has_value();
  columns.scale = !arguments.errors.empty() && asksFor<question::Search>(arguments.question);
  return columns;
}

std::string headerOf(const Arguments &arguments) {
  if (asksFor<question::Profile>(arguments.question)) return profileHeader();
  if (asksFor<question::Violations>(arguments.question)) return violationsHeader();
  if (asksFor<question::Speed>(arguments.question)) return speedHeader();
  if (asksFor<question::Margins>(arguments.question)) return marginHeader();
  return resultsHeader(columnsOf(arguments));
}

void addFailure(const Asked &asked, const Arguments &arguments, cprox_status status, const std::string &why,
                Outcome &out) {
  out.error_messages.push_back(asked.place + ": " + why);
  if (!arguments.certificate.empty()) out.certificate = emptyRecord();
  const std::string header = headerOf(arguments);
  if (header != resultsHeader(columnsOf(arguments))) {
    out.text += failedLine(header, asked.id, asked.kind, status, why);
    return;
  }
  ResultRow row;
  row.id = asked.id;
  row.kind = asked.kind;
  row.a = asked.kind == "curve" ? asked.id : asked.part.link;
  row.b = asked.part.object;
  row.result.status = status;
  row.message = why;
  row.proof = "none";
  out.text += resultsLine(row, columnsOf(arguments));
}

void answer(const Asked &asked, const Arguments &arguments, const Query &query, Workspace &workspace, Outcome &out) {
  if (asked.ends_run) return addRows(asked, arguments, query, workspace, out);
  attempt([&] { addRows(asked, arguments, query, workspace, out); },
          [&](cprox_status status, const char *why) { addFailure(asked, arguments, status, why, out); });
}

void addTasks(const Asked &asked, const Arguments &arguments, const Query &query, std::vector<Task> &tasks) {
  for (const Part &part : partsOf(asked.subject, arguments.question, query, arguments.per_link)) {
    Asked one = asked;
    one.part = part;
    tasks.push_back([one, &arguments, &query](Workspace &workspace) {
      Outcome out;
      answer(one, arguments, query, workspace, out);
      return out;
    });
  }
}

} // namespace curve_proximity::cli
