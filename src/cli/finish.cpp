/* SPDX-License-Identifier: BSD-3-Clause */
#include "finish.h"

#include "failure.h"

namespace curve_proximity::cli {

void tellSkipped(const std::vector<std::string> &sentences, Console &console) {
  for (const std::string &sentence : sentences) console.say("skipped: " + sentence);
  if (sentences.empty()) console.say("skipped: nothing");
}

int finish(const Tally &tally, Console &console) {
  if (tally.failed) console.say(std::to_string(tally.failed) + " of " + std::to_string(tally.rows) + " rows failed");
  if (tally.unproven) console.say(std::to_string(tally.unproven) + " answers have no certificate (column proof: none)");
  if (tally.interrupted) {
    console.say("interrupted: the output holds the first " + std::to_string(tally.rows) + " rows of the input");
    return kInterrupted;
  }
  return tally.failed ? kSomeRowsFailed : kAllAnswered;
}

} // namespace curve_proximity::cli
