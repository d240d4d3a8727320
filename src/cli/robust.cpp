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

/* Of the duration: how near the time of contact is searched for. */
constexpr double FINE = 1e-4;

Columns columnsOfRobust(const Arguments &arguments) {
  Columns columns;
  columns.contact = asksFor<question::Contact>(arguments.question);
  columns.scale = !columns.contact;
  return columns;
}

struct RobustTask {
  const RobotMotion &motion;
  bool self;
  const ErrorBounds &errors;
  const Arguments &arguments;
  const Query &query;

  const char *kind() const {
    return self ? "self" : "environment";
  }
};

void addProfile(const RobustTask &task, Workspace &workspace, Outcome &out) {
  const std::vector<double> breaks =
      breaksOf(std::get<question::Profile>(task.arguments.question), task.motion.domain());
  for (const ClearanceInterval &interval :
       robustProfile(task.motion, task.self, task.errors, breaks, task.query, workspace)) {
    out.stopped = out.stopped || interval.status == CPROX_STOPPED;
    noteGap(interval.gap, out);
    out.text += profileLine(stemOf(task.arguments.trajectory), task.kind(), interval);
  }
}

void addRow(const RobustTask &task, Workspace &workspace, Outcome &out) {
  ResultRow row;
  if (asksFor<question::Contact>(task.arguments.question)) {
    const std::array<double, 2> domain = task.motion.domain();
    row = toRow(
        robustTimeOfContact(task.motion, task.self, task.errors, FINE * (domain[1] - domain[0]), task.query, workspace),
        task.query.query_type);
  } else {
    const RobustAnswer found = askRobust(task.motion, task.self, task.errors, task.query, workspace);
    row = toRow(found.answer, task.query.query_type);
    row.certified_scale = found.certified, row.refused_scale = found.refused;
  }
  row.id = stemOf(task.arguments.trajectory);
  out.stopped = row.result.status == CPROX_STOPPED;
  out.text = resultsLine(row, columnsOfRobust(task.arguments));
  noteVerdict(row, out);
}

Outcome answerOne(const RobustTask &task, Workspace &workspace) {
  const Arguments &arguments = task.arguments;
  const bool profile = asksFor<question::Profile>(arguments.question);
  Outcome out;
  try {
    profile ? addProfile(task, workspace, out) : addRow(task, workspace, out);
  } catch (const Error &e) {
    ResultRow row;
    row.id = stemOf(arguments.trajectory);
    row.kind = task.kind();
    row.result.status = e.status();
    row.message = e.what();
    out.text = profile ? failedProfileLine(row.id, row.kind, e.status(), e.what())
                       : resultsLine(row, columnsOfRobust(arguments));
    out.complaints.push_back(arguments.trajectory + ": " + row.kind + ": " + e.what());
  }
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
  tellOfReading(world, motion, arguments, console);
  std::vector<Task> tasks;
  for (const bool self : {false, true}) {
    if (self && !arguments.self) continue;
    const Query &asked = self ? query : around;
    const RobustTask task{motion, self, errors, arguments, asked};
    tasks.push_back([task](Workspace &workspace) { return answerOne(task, workspace); });
  }
  const bool profile = asksFor<question::Profile>(arguments.question);
  return output.answer(profile ? profileHeader() : resultsHeader(columnsOfRobust(arguments)), tasks, console);
}

} // namespace curve_proximity::cli
