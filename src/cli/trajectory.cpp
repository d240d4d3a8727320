/* SPDX-License-Identifier: BSD-3-Clause */
/* The robot along a joint trajectory. */
#include <curve_proximity/motion.hpp>

#include "failure.h"
#include "finish.h"
#include "results.h"
#include "run.h"
#include "trajectory_yaml.h"
#include "verbs.h"
#include "world.h"

namespace curve_proximity::cli {
namespace {

/* Joints that the trajectory does not move: --state, then its own fixed_joints, then the scene's robot_state. */
JointPositions restOf(const TrajectoryDescription &trajectory, const World &world) {
  JointPositions out = world.scene_joints;
  for (const auto &[joint, value] : trajectory.fixed_joints) out[joint] = value;
  for (const auto &[joint, value] : world.state) out[joint] = value;
  return out;
}

RobotMotion readMotion(const Arguments &arguments, const World &world, Warnings &warnings) {
  TrajectoryDescription trajectory = readTrajectory(arguments.trajectory, warnings);
  adoptBase(world.srdf.virtual_joints, trajectory); /* where the file does not name it itself */
  try {
    return RobotMotion(world.snapshot, trajectory, restOf(trajectory, world), world.srdf.disabled);
  } catch (const Error &e) {
    throw BadUsage(arguments.trajectory + ": " + e.what());
  }
}

Outcome toOutcome(const std::vector<Answer> &answers, Verb verb, const std::string &file) {
  Outcome out;
  for (const Answer &answer : answers) {
    out.stopped = out.stopped || answer.result.status == CPROX_STOPPED;
    out.text += resultsLine(toRow(answer, verb));
    if (answer.result.status < 0) out.complaints.push_back(file + ": " + answer.kind + ": " + answer.message);
  }
  return out;
}

} // namespace

int answerTrajectory(const Arguments &arguments, Console &console) {
  Warnings warnings;
  for (const std::string &sentence : arguments.warnings) warnings.add(sentence);
  const World world = readWorld(arguments, warnings);
  const RobotMotion motion = readMotion(arguments, world, warnings);
  for (const std::string &sentence : motion.warnings()) warnings.add(arguments.trajectory + ": " + sentence);
  Question question = arguments.question;
  question.options.stop = interrupted;

  ResultsFile results(arguments.out, {arguments.trajectory, arguments.scene, arguments.robot, arguments.srdf});
  console.warn(warnings);
  if (arguments.skipped) {
    tellSkipped(world.skipped, console);
    tellSkipped(motion.skipped(), console);
  }

  /* two tasks: the scene, and the robot itself */
  catchInterrupts();
  results.write(resultsHeader());
  std::vector<Task> tasks;
  tasks.push_back([&](Workspace &workspace) {
    return toOutcome(askEnvironment(motion, question, workspace), question.verb, arguments.trajectory);
  });
  if (arguments.self) {
    tasks.push_back([&](Workspace &workspace) {
      return toOutcome({askSelf(motion, question, workspace)}, question.verb, arguments.trajectory);
    });
  }
  Rows rows;
  std::size_t next = 0;
  rows.next = [&]() -> std::optional<Task> {
    return next < tasks.size() ? std::optional<Task>(tasks[next++]) : std::nullopt;
  };
  rows.write = [&](const std::string &text) { results.write(text); };
  rows.portion = [] { return std::optional<double>(); };
  return finish(runRows(arguments.threads, rows, console), console);
}

} // namespace curve_proximity::cli
