/* SPDX-License-Identifier: BSD-3-Clause */
/* Which links of a robot can touch each other within the limits of its joints, and an SRDF that says so. */
#include <algorithm>
#include <cstdio>

#include <curve_proximity/collision_matrix.hpp>

#include "commands.h"
#include "csv.h"
#include "exit_code.h"
#include "finish.h"
#include "robot_file.h"
#include "run.h"
#include "world_files.h"

namespace curve_proximity::cli {
namespace {

constexpr const char *kNever = "Never", *kAdjacent = "Adjacent", *kAlways = "Always";

const DisabledPair *find(const std::vector<DisabledPair> &pairs, const std::string &a, const std::string &b) {
  for (const DisabledPair &pair : pairs)
    if ((pair.links[0] == a && pair.links[1] == b) || (pair.links[0] == b && pair.links[1] == a)) return &pair;
  return nullptr;
}

/* Why the new SRDF disables a pair; nothing: it does not. What a person decided stays; that two links never touch is
 * no decision. */
std::string reasonOf(const LinkContact &contact, const DisabledPair *before) {
  if (contact.result.verdict == CPROX_VERDICT_CLEAR) return kNever;
  if (contact.result.verdict == CPROX_VERDICT_VIOLATED && contact.rigid) return kAlways;
  if (contact.adjacent) return kAdjacent;
  return before && before->reason != kNever ? before->reason : "";
}

std::string postureOf(const LinkContact &contact) {
  std::string out;
  for (const auto &[joint, value] : contact.posture) {
    char text[40];
    std::snprintf(text, sizeof text, ": %.17g", value);
    out += (out.empty() ? "" : ", ") + joint + text;
  }
  return out;
}

std::string lineOf(const LinkContact &contact, const DisabledPair *before, const std::string &reason) {
  std::string line = quotedField(contact.a) + ',' + quotedField(contact.b) + ',' + contactName(contact) + ',' +
                     (before ? quotedField(before->reason) : "") + ',' + quotedField(reason);
  appendField(line, contact.result.lower);
  appendField(line, contact.result.upper);
  line += ',' + std::to_string(contact.result.nodes) + ',' + std::to_string(contact.result.distance_queries) + ',' +
          quotedField(contact.result.verdict == CPROX_VERDICT_CLEAR ? "" : postureOf(contact)) + ',' +
          quotedField(contact.message);
  return line + '\n';
}

} // namespace

int findLinkContacts(const Arguments &arguments, Console &console) {
  Warnings warnings;
  const World world = readWorld(arguments, warnings);
  const CollisionMatrix matrix(world.snapshot);
  const std::string srdf = arguments.srdf.empty() ? "" : readText(arguments.srdf);
  const std::vector<DisabledPair> before = srdf.empty() ? std::vector<DisabledPair>() : disabledPairs(srdf);
  cprox_options options = arguments.query.options;
  options.stop = interrupted;

  FileOutput output(arguments);
  console.warn(warnings);
  if (arguments.timings) tellTimings(world.timings, console);
  if (arguments.skipped) tellSkipped(world.skipped, console);

  std::vector<DisabledPair> after(matrix.pairs().size());
  std::vector<Task> tasks;
  for (std::size_t i = 0; i < matrix.pairs().size(); ++i)
    tasks.push_back([&, i](Workspace &workspace) {
      Outcome out;
      const auto &[a, b] = matrix.pairs()[i];
      try {
        const LinkContact contact = matrix.ask(i, options, workspace);
        const DisabledPair *known = find(before, a, b);
        after[i] = {{a, b}, reasonOf(contact, known)};
        out.text = lineOf(contact, known, after[i].reason);
        out.stopped = contact.result.status == CPROX_STOPPED;
        out.undecided = contact.result.verdict == CPROX_VERDICT_UNDECIDED;
        out.violated = known && contact.result.verdict == CPROX_VERDICT_VIOLATED && known->reason == kNever;
        if (out.violated)
          console.say("warning: " + arguments.srdf + ": '" + a + "' and '" + b +
                      "' are disabled as Never, and touch at " + postureOf(contact));
      } catch (const Error &e) {
        out.error_messages.push_back(a + " and " + b + ": " + e.what());
      }
      return out;
    });
  const int code = output.rows.answer(
      "a,b,contact,disabled_before,disabled,lower,upper,nodes,distance_queries,posture,message\n", tasks, console);
  if (code == kInterrupted) return code;
  after.erase(std::remove_if(after.begin(), after.end(), [](const DisabledPair &pair) { return pair.reason.empty(); }),
              after.end());
  output.file.write(withDisabledPairs(srdf, world.snapshot->robot()->name(), after));
  return code;
}

} // namespace curve_proximity::cli
