/* SPDX-License-Identifier: BSD-3-Clause */
/* A robot's trajectory for every execution within bounds of its errors. */
#include <curve_proximity/robust.hpp>

#include "../scene/yaml/errors_yaml.h"
#include "commands.h"
#include "failure.h"
#include "finish.h"
#include "trajectory.h"
#include "world.h"

namespace curve_proximity::cli {
namespace {

const Columns COLUMNS = [] {
  Columns columns;
  columns.scale = true;
  return columns;
}();

Outcome answerOne(const RobotMotion &motion, bool self, const ErrorBounds &errors, const Arguments &arguments,
                  const Query &query, Workspace &workspace) {
  Outcome out;
  ResultRow row;
  try {
    const RobustAnswer found = askRobust(motion, self, errors, query, workspace);
    row = toRow(found.answer, query.query_type);
    row.certified_scale = found.certified, row.refused_scale = found.refused;
    out.stopped = row.result.status == CPROX_STOPPED;
  } catch (const Error &e) {
    row.kind = self ? "self" : "environment";
    row.result.status = e.status();
    row.message = e.what();
    out.complaints.push_back(arguments.trajectory + ": " + row.kind + ": " + e.what());
  }
  row.id = stemOf(arguments.trajectory);
  out.text = resultsLine(row, COLUMNS);
  noteVerdict(row, out);
  return out;
}

} // namespace

int answerRobust(const Arguments &arguments, Console &console) {
  Warnings warnings;
  const World world = readStandingWorld(arguments, "robust", warnings);
  const RobotMotion motion = readMotion(arguments, world, warnings);
  warnOfMotion(motion, arguments, world, warnings);
  const ErrorBounds errors = yaml::readErrors(arguments.errors);
  const Query query = queryOf(arguments, world, warnings);
  Query around = query; // as of answerTrajectory()
  around.allow_empty = query.allow_empty || (arguments.self && arguments.scene.empty());

  Output output(arguments);
  console.warn(warnings);
  if (arguments.timings) tellTimings(world.timings, console);
  if (arguments.skipped) {
    tellSkipped(world.skipped, console);
    tellSkipped(motion.skipped(), console);
  }
  std::vector<Task> tasks;
  for (const bool self : {false, true}) {
    if (self && !arguments.self) continue;
    const Query &asked = self ? query : around;
    tasks.push_back(
        [&, self](Workspace &workspace) { return answerOne(motion, self, errors, arguments, asked, workspace); });
  }
  return output.answer(resultsHeader(COLUMNS), tasks, console);
}

} // namespace curve_proximity::cli
