/* SPDX-License-Identifier: BSD-3-Clause */
/* cprox: the command line. No exception leaves main(): each becomes one line on standard error. */
#include <console_bridge/console.h>

#include <cstdio>
#include <exception>
#include <new>
#include <string>
#include <vector>

#include "arguments.h"
#include "commands.h"
#include "console.h"
#include "exit_code.h"
#include "help.h"
#include "packages.h"

namespace {

using namespace curve_proximity::cli;

int run(const std::vector<std::string> &words, Console &console) {
  const Arguments arguments = parseArguments(words);
  if (arguments.quiet) console.beQuiet();
  namePackages(arguments.packages);
  switch (arguments.action) {
    case Action::HELP: std::fputs(helpText(arguments.topic).c_str(), stdout); return kAllAnswered;
    case Action::COMPLETION: std::fputs(completion(arguments.topic).c_str(), stdout); return kAllAnswered;
    case Action::MANUAL: std::fputs(manualPage().c_str(), stdout); return kAllAnswered;
    case Action::VERSION: std::puts("cprox " CPROX_VERSION); return kAllAnswered;
    case Action::CURVES: return answerCurves(arguments, console);
    case Action::AGAINST: return answerAgainst(arguments, console);
    case Action::TRAJECTORY:
    case Action::ROBUST:
    case Action::SPEED:
    case Action::MARGINS: return answerTrajectory(arguments, console);
    case Action::MOVERS: return answerMovers(arguments, console);
    case Action::PAIRS: return answerPairs(arguments, console);
    case Action::CONSTRAINTS: return answerConstraints(arguments, console);
    case Action::CHECK: return checkCertificates(arguments, console);
    case Action::CERTIFY: return certifyDataset(arguments, console);
    case Action::MERGE: return mergeShards(arguments, console);
    case Action::ACM: return findLinkContacts(arguments, console);
    case Action::SWEEP: return sweepVolume(arguments, console);
    case Action::REPORT: return writeReport(arguments, console);
    case Action::SEND: return sendScene(arguments, console);
  }
  return kUnanswered;
}

} // namespace

int main(int argc, char **argv) {
  /* urdfdom and the readers of meshes speak to standard error behind our back: what they find is told in one line */
  console_bridge::noOutputHandler();

  Console console;
  try {
    return run(std::vector<std::string>(argv + 1, argv + argc), console);
  } catch (const BadUsage &e) {
    console.print(std::string("cprox: ") + e.what());
    return kUnanswered;
  } catch (const std::bad_alloc &) {
    console.print("cprox: out of memory");
  } catch (const std::exception &e) {
    console.print(std::string("cprox: ") + e.what());
  } catch (...) {
    console.print("cprox: an error without a name");
  }
  return kUnanswered;
}
