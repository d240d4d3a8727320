/* SPDX-License-Identifier: BSD-3-Clause */
#include "finish.h"

#include <algorithm>
#include <limits>

#include "exit_code.h"

namespace curve_proximity::cli {
namespace {

int finish(const Tally &tally, const Arguments &arguments, Console &console) {
  if (tally.failed) console.say(std::to_string(tally.failed) + " of " + std::to_string(tally.rows) + " rows failed");
  if (tally.unproven) console.say(std::to_string(tally.unproven) + " answers have no certificate (column proof: none)");
  if (tally.interrupted) {
    console.say("interrupted: the output holds the first " + std::to_string(tally.rows) + " rows of the input");
    return kInterrupted;
  }
  if (tally.against_nothing)
    console.say("warning: " + std::to_string(tally.against_nothing) + " of " + std::to_string(tally.rows) +
                " rows were measured against nothing (--allow-empty says that this is meant)");
  if (tally.disputed)
    console.say("warning: the second opinion disagrees in " + std::to_string(tally.disputed) + " of " +
                std::to_string(tally.rows) + " rows (column second_opinion)");
  if (!tally.rows) console.say("warning: the input has no rows");
  if (arguments.verbose)
    console.say(std::to_string(tally.rows) + " rows of the input: " + std::to_string(tally.violated) + " violated, " +
                std::to_string(tally.undecided) + " undecided, " + std::to_string(tally.uncovered) + " not covered, " +
                std::to_string(tally.failed) + " failed");
  if (arguments.strict && tally.uncovered)
    console.print("cprox: --strict: " + std::to_string(tally.uncovered) + " of " + std::to_string(tally.rows) +
                  " rows do not cover all that was given (column message)");
  if (tally.failed || !tally.rows || (arguments.strict && tally.uncovered)) return kUnanswered;
  if (tally.violated) return kSomeViolated;
  return tally.undecided || tally.disputed ? kSomeUndecided : kAllAnswered;
}

} // namespace

void tellSkipped(const std::vector<std::string> &messages, Console &console) {
  for (const std::string &message : messages) console.say("skipped: " + message);
  if (messages.empty()) console.say("skipped: nothing");
}

void tellTimings(const std::vector<std::string> &messages, Console &console) {
  for (const std::string &message : messages) console.say("timing: " + message);
}

void noteGap(const std::optional<Gap> &gap, Outcome &outcome) {
  outcome.undecided = outcome.undecided || gap;
  outcome.uncovered = outcome.uncovered || (gap && *gap != Gap::EMPTY);
}

void noteVerdict(const ResultRow &row, Outcome &outcome) {
  const bool nothing = row.gap == Gap::EMPTY || row.result.lower == std::numeric_limits<double>::infinity();
  outcome.against_nothing = outcome.against_nothing || (row.result.status >= 0 && nothing);
  noteGap(row.gap, outcome);
  outcome.disputed = outcome.disputed || row.second_opinion.verdict == SecondOpinion::DISAGREES;
  if (!row.has_verdict || row.result.status < 0) return;
  outcome.violated = outcome.violated || row.result.verdict == CPROX_VERDICT_VIOLATED;
  outcome.undecided = outcome.undecided || row.result.verdict == CPROX_VERDICT_UNDECIDED;
}

Output::Output(const Arguments &arguments)
    : arguments_(arguments),
      results_(arguments.out, inputsOf(arguments)),
      form_(rowForm(arguments.json, arguments.out)) {
  if (!arguments.certificate.empty())
    certificates_.emplace(arguments.certificate, inputsOf(arguments), "--certificate");
}

int Output::answer(const std::string &header, Rows rows, Console &console) {
  catchInterrupts();
  results_.write(form_(header));
  rows.write = [&](const std::string &text) { results_.write(form_(text)); };
  if (certificates_) rows.certify = [&](const std::string &records) { certificates_->write(records); };
  return finish(runRows(arguments_.threads, rows, console), arguments_, console);
}

int Output::answer(const std::string &header, const std::vector<Task> &tasks, Console &console) {
  Rows rows;
  std::size_t next = 0;
  rows.next = [&]() -> std::optional<Task> {
    return next < tasks.size() ? std::optional<Task>(tasks[next++]) : std::nullopt;
  };
  rows.portion = [&]() -> std::optional<double> {
    return static_cast<double>(next) / static_cast<double>(std::max<std::size_t>(tasks.size(), 1));
  };
  return answer(header, std::move(rows), console);
}

static Arguments withoutOut(Arguments arguments) {
  arguments.out.clear();
  return arguments;
}

FileOutput::FileOutput(const Arguments &arguments)
    : of_rows_(withoutOut(arguments)), file(arguments.out, inputsOf(arguments)), rows(of_rows_) {}

} // namespace curve_proximity::cli
