/* SPDX-License-Identifier: BSD-3-Clause */
#include "asking.h"

#include <limits>
#include <utility>

#include "failure.h"
#include "finish.h"

namespace curve_proximity::cli {
namespace {

void addAnswer(const Subject &subject, const Arguments &arguments, Answer answer, Outcome &out) {
  answer.id = subject.id;
  putLinkFirst(subject.link, answer);
  if (answer.b.empty()) answer.b = subject.object;
  out.stopped = out.stopped || answer.result.status == CPROX_STOPPED;
  const ResultRow row = toRow(answer, arguments.query.query_type);
  out.text += resultsLine(row, columnsOf(arguments));
  noteVerdict(row, out);
  if (answer.result.status < 0) out.complaints.push_back(subject.place + ": " + answer.message);
}

void addProfile(const Subject &subject, std::vector<ClearanceInterval> intervals, Outcome &out) {
  for (ClearanceInterval &interval : intervals) {
    if (!subject.link.empty() && interval.a != subject.link) {
      if (interval.b == subject.link) {
        interval.b = interval.a;
        std::swap(interval.witness_a, interval.witness_b);
      }
      interval.a = subject.link;
    }
    if (interval.b.empty()) interval.b = subject.object;
    out.stopped = out.stopped || interval.status == CPROX_STOPPED;
    out.against_nothing = out.against_nothing || interval.gap == Gap::EMPTY || std::isinf(interval.lower);
    out.undecided = out.undecided || interval.gap;
    out.text += profileLine(subject.id, subject.kind, interval);
  }
}

void addViolations(const Subject &subject, const Violations &found, Outcome &out) {
  out.stopped = out.stopped || found.status == CPROX_STOPPED;
  out.against_nothing = out.against_nothing || !found.measured;
  if (found.list.empty()) out.text += clearLine(subject.id, subject.kind, found.status, found.message);
  for (Violation one : found.list) {
    if (!subject.link.empty() && one.b == subject.link) std::swap(one.a, one.b);
    out.violated = out.violated || one.verdict == CPROX_VERDICT_VIOLATED;
    out.undecided = out.undecided || one.verdict == CPROX_VERDICT_UNDECIDED;
    out.text += violationLine(subject.id, subject.kind, found, one);
  }
}

double resolutionOf(const Arguments &arguments, const std::array<double, 2> &domain) {
  constexpr double kPart = 1e-3;
  return arguments.resolution > 0.0 ? arguments.resolution : kPart * (domain[1] - domain[0]);
}

} // namespace

std::array<double, 2> CurveSubject::domain() const {
  const cprox_curve_info info = cprox_curve_get_info(curve_.curve.get());
  return {info.t0, info.t1};
}

std::vector<Answer> CurveSubject::nearest(const PairLimits &limits, const Query &query, Workspace &workspace) const {
  return nearestPairs(targets_, curve_, limits, query, workspace);
}

std::vector<ClearanceInterval> CurveSubject::profile(const std::vector<double> &breaks, double horizon,
                                                     const Query &query, Workspace &workspace) const {
  return clearanceProfile(targets_, curve_, breaks, query, workspace, horizon);
}

Answer CurveSubject::contact(const Query &query, Workspace &workspace) const {
  return timeOfContact(targets_, curve_, query, workspace);
}

std::vector<Answer> CurveSubject::search(const Query &query, Workspace &workspace) const {
  return ask(targets_, curve_, query, workspace);
}

Violations CurveSubject::violations(double resolution, const Query &query, Workspace &workspace) const {
  return curve_proximity::violations(targets_, curve_, resolution, query, workspace);
}

std::array<double, 2> MotionSubject::domain() const {
  return motion_.domain();
}

Query MotionSubject::named(const Query &query) const {
  Query out = query;
  if (self_) out.objects.clear(); // the robot itself is none of them, and is one row
  if (self_) out.per_object = false;
  if (!link.empty()) out.links = {link};
  if (!object.empty()) out.objects = {object};
  return out;
}

std::vector<Answer> MotionSubject::nearest(const PairLimits &limits, const Query &query, Workspace &workspace) const {
  return nearestPairs(motion_, self_, limits, named(query), workspace);
}

std::vector<ClearanceInterval> MotionSubject::profile(const std::vector<double> &breaks, double horizon,
                                                      const Query &query, Workspace &workspace) const {
  return clearanceProfile(motion_, self_, breaks, named(query), workspace, horizon);
}

Answer MotionSubject::contact(const Query &query, Workspace &workspace) const {
  return timeOfContact(motion_, self_, named(query), workspace);
}

std::vector<Answer> MotionSubject::search(const Query &query, Workspace &workspace) const {
  const Query asked = named(query);
  if (self_) return {askSelf(motion_, asked, workspace)};
  return askEnvironment(motion_, asked, workspace);
}

Violations MotionSubject::violations(double resolution, const Query &query, Workspace &workspace) const {
  return curve_proximity::violations(motion_, self_, resolution, named(query), workspace);
}

std::vector<double> breaksOf(const Arguments &arguments, const std::array<double, 2> &domain) {
  if (!arguments.breaks.empty()) return arguments.breaks;
  const std::size_t n = arguments.intervals;
  std::vector<double> out;
  for (std::size_t i = 0; i < n; ++i) {
    const double part = static_cast<double>(i) / static_cast<double>(n);
    const double next = domain[0] * (1.0 - part) + domain[1] * part;
    if (out.empty() || next > out.back()) out.push_back(next); // a domain may have fewer numbers than intervals
  }
  out.front() = domain[0];
  while (out.size() > 1 && out.back() >= domain[1]) out.pop_back();
  out.push_back(domain[1]);
  return out;
}

Columns columnsOf(const Arguments &arguments) {
  Columns columns;
  columns.proof = !arguments.certificate.empty();
  columns.contact = arguments.asking == Asking::CONTACT;
  columns.opinion = arguments.second_opinion.has_value();
  return columns;
}

std::string headerOf(const Arguments &arguments) {
  switch (arguments.asking) {
    case Asking::PROFILE: return profileHeader();
    case Asking::VIOLATIONS: return violationsHeader();
    default: return resultsHeader(columnsOf(arguments));
  }
}

void putLinkFirst(const std::string &link, Answer &answer) {
  if (link.empty() || answer.a == link) return;
  if (answer.b == link) {
    std::swap(answer.a, answer.b);
    std::swap(answer.result.witness_mover, answer.result.witness_obstacle);
  } else {
    answer.a = link;
  }
}

void addFailure(const Subject &subject, const Arguments &arguments, cprox_status status, const std::string &why,
                Outcome &out) {
  out.complaints.push_back(subject.place + ": " + why);
  if (arguments.asking == Asking::PROFILE) {
    out.text += failedProfileLine(subject.id, subject.kind, status, why);
    return;
  }
  if (arguments.asking == Asking::VIOLATIONS) {
    out.text += clearLine(subject.id, subject.kind, status, why);
    return;
  }
  ResultRow row;
  row.id = subject.id;
  row.kind = subject.kind;
  row.a = subject.kind == "curve" ? subject.id : subject.link;
  row.b = subject.object;
  row.result.status = status;
  row.message = why;
  row.proof = "none";
  out.text += resultsLine(row, columnsOf(arguments));
}

void answer(const Subject &subject, const Arguments &arguments, const Query &query, Workspace &workspace,
            Outcome &out) {
  Query one = query; // subjects are about one object or link already
  one.per_object = false;
  try {
    switch (arguments.asking) {
      case Asking::SEARCH:
        for (const Answer &answer : subject.search(one, workspace)) addAnswer(subject, arguments, answer, out);
        break;
      case Asking::PROFILE:
        addProfile(subject, subject.profile(breaksOf(arguments, subject.domain()), arguments.horizon, one, workspace),
                   out);
        break;
      case Asking::NEAREST: {
        const std::vector<Answer> answers = subject.nearest(arguments.limits, one, workspace);
        for (const Answer &answer : answers) addAnswer(subject, arguments, answer, out);
        if (answers.empty() && std::isinf(arguments.limits.within)) out.against_nothing = true;
        break;
      }
      case Asking::CONTACT: addAnswer(subject, arguments, subject.contact(one, workspace), out); break;
      case Asking::VIOLATIONS:
        addViolations(subject, subject.violations(resolutionOf(arguments, subject.domain()), one, workspace), out);
        break;
    }
  } catch (const Error &e) {
    addFailure(subject, arguments, e.status(), e.what(), out);
  } catch (const std::bad_alloc &) {
    addFailure(subject, arguments, CPROX_MEMORY, cprox_status_text(CPROX_MEMORY), out);
  } catch (const std::exception &e) {
    addFailure(subject, arguments, CPROX_INVALID, e.what(), out);
  }
}

} // namespace curve_proximity::cli
