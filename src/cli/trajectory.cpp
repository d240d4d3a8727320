/* SPDX-License-Identifier: BSD-3-Clause */
/* The robot along a joint trajectory. */
#include "trajectory.h"

#include "certificates.h"
#include "commands.h"
#include "failure.h"
#include "finish.h"
#include "results.h"
#include "run.h"
#include "trajectory_yaml.h"
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

Outcome toOutcome(const std::vector<Answer> &answers, QueryType query_type, const std::string &file,
                  const std::string &proof) {
  Outcome out;
  for (const Answer &answer : answers) {
    out.stopped = out.stopped || answer.result.status == CPROX_STOPPED;
    ResultRow row = toRow(answer, query_type);
    row.proof = proof;
    out.text += resultsLine(row);
    noteVerdict(row, out);
    if (!answer.unproven.empty())
      out.unproven.push_back(file + ": " + answer.kind + ": no certificate: " + answer.unproven);
    if (answer.result.status < 0) out.complaints.push_back(file + ": " + answer.kind + ": " + answer.message);
  }
  return out;
}

/* One of the two queries; with the record of its certificate, where one is wanted. */
Outcome askOne(const RobotMotion &motion, bool self, const Query &query, const Arguments &arguments,
               Workspace &workspace) {
  const CertificateHandle proof = makeCertificate();
  Query asked = query;
  if (!arguments.certificate.empty()) asked.options.certificate = proof.get();
  if (self) asked.per_object = false; /* the robot itself is one row */
  const std::vector<Answer> answers =
      self ? std::vector<Answer>{askSelf(motion, asked, workspace)} : askEnvironment(motion, asked, workspace);
  const bool with_proof = !arguments.certificate.empty();
  Outcome out = toOutcome(answers, query.query_type, arguments.trajectory, with_proof ? proofOf(proof) : "");
  if (with_proof) out.certificate = recordOf(proof);
  return out;
}

} // namespace

RobotMotion readMotion(const Arguments &arguments, const World &world, Warnings &warnings) {
  TrajectoryDescription trajectory = readTrajectory(arguments.trajectory, warnings);
  adoptBase(world.srdf.virtual_joints, trajectory); /* where the file does not name it itself */
  try {
    return RobotMotion(world.snapshot, trajectory, restOf(trajectory, world), world.srdf.disabled);
  } catch (const Error &e) {
    throw BadUsage(arguments.trajectory + ": " + e.what());
  }
}

int answerTrajectory(const Arguments &arguments, Console &console) {
  Warnings warnings;
  const World world = readWorld(arguments, warnings);
  const RobotMotion motion = readMotion(arguments, world, warnings);
  if (world.snapshot->robot())
    for (const std::string &link : unknownLinks(world.srdf, *world.snapshot->robot()))
      warnings.add("the SRDF disables link '" + link + "', which the robot does not have");
  for (const std::string &sentence : motion.warnings()) warnings.add(arguments.trajectory + ": " + sentence);
  Query query = arguments.query;
  query.options.stop = interrupted;

  const std::vector<std::string> inputs{arguments.trajectory, arguments.scene, arguments.robot, arguments.srdf};
  ResultsFile results(arguments.out, inputs);
  std::optional<ResultsFile> certificates;
  if (!arguments.certificate.empty()) {
    certificates.emplace(arguments.certificate, inputs, "--certificate");
    warnOfUnprovable(unprovable(motion, false, query), warnings);
    if (arguments.self) warnOfUnprovable(unprovable(motion, true, query), warnings);
  }
  console.warn(warnings);
  if (arguments.timings) tellTimings(world.timings, console);
  if (arguments.skipped) {
    tellSkipped(world.skipped, console);
    tellSkipped(motion.skipped(), console);
  }

  /* two tasks: the scene, and the robot itself */
  catchInterrupts();
  results.write(resultsHeader(!arguments.certificate.empty()));
  std::vector<Task> tasks;
  tasks.push_back([&](Workspace &workspace) { return askOne(motion, false, query, arguments, workspace); });
  if (arguments.self)
    tasks.push_back([&](Workspace &workspace) { return askOne(motion, true, query, arguments, workspace); });
  Rows rows;
  std::size_t next = 0;
  rows.next = [&]() -> std::optional<Task> {
    return next < tasks.size() ? std::optional<Task>(tasks[next++]) : std::nullopt;
  };
  rows.write = [&](const std::string &text) { results.write(text); };
  if (certificates) rows.certify = [&](const std::string &records) { certificates->write(records); };
  rows.portion = [] { return std::optional<double>(); };
  return finish(runRows(arguments.threads, rows, console), query.query_type, console);
}

} // namespace curve_proximity::cli
