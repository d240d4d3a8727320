/* SPDX-License-Identifier: BSD-3-Clause */
/* The robot along a joint trajectory. */
#include "trajectory.h"

#include <filesystem>

#include "../scene/yaml/trajectory_yaml.h"
#include "asking.h"
#include "certificates.h"
#include "commands.h"
#include "failure.h"
#include "finish.h"
#include "movers.h"
#include "results.h"
#include "run.h"
#include "world.h"

namespace curve_proximity::cli {
namespace {

void addAnswers(const std::vector<Answer> &answers, const Arguments &arguments, const std::string &proof,
                Outcome &out) {
  for (const Answer &answer : answers) {
    out.stopped = out.stopped || answer.result.status == CPROX_STOPPED;
    ResultRow row = toRow(answer, arguments.query.query_type);
    row.proof = proof;
    out.text += resultsLine(row, columnsOf(arguments));
    noteVerdict(row, out);
    const std::string place = arguments.trajectory + ": " + answer.kind + ": ";
    if (!answer.unproven.empty()) out.unproven.push_back(place + "no certificate: " + answer.unproven);
    if (answer.result.status < 0) out.complaints.push_back(place + answer.message);
  }
}

/* The intervals of one of the two queries, of one link or all; with the record of its certificate, where one is wanted.
 */
void search(const MotionSubject &subject, const Query &query, const Arguments &arguments, Workspace &workspace,
            Outcome &out) {
  const CertificateHandle proof = makeCertificate();
  const bool with_proof = !arguments.certificate.empty();
  Query asked = query;
  if (with_proof) asked.options.certificate = proof.get();
  std::vector<Answer> answers = subject.search(asked, workspace);
  for (Answer &answer : answers) putLinkFirst(subject.link, answer);
  addAnswers(answers, arguments, with_proof ? proofOf(proof) : "", out);
  if (with_proof) out.certificate = recordOf(proof);
}

/* One of the two queries, of one link or all. */
Outcome askOne(const RobotMotion &motion, bool self, const std::string &link, const std::string &object,
               const Query &query, const Arguments &arguments, Workspace &workspace) {
  Outcome out;
  MotionSubject subject(motion, self);
  subject.id = std::filesystem::path(arguments.trajectory).stem().string();
  subject.place = arguments.trajectory + ": " + subject.kind;
  subject.link = link;
  subject.object = object;
  if (arguments.asking == Asking::SEARCH) {
    search(subject, query, arguments, workspace, out);
  } else {
    answer(subject, arguments, query, workspace, out);
  }
  return out;
}

/* The links that have rows of their own; "": all are one. */
std::vector<std::string> linksOf(const RobotMotion &motion, bool self, const Arguments &arguments) {
  std::vector<std::string> links;
  if (arguments.per_link)
    links =
        arguments.query.links.empty() ? askedNames(motion, self, arguments.query.moving_only) : arguments.query.links;
  if (links.empty()) links.emplace_back();
  return links;
}

/* The objects that have rows of their own, where askEnvironment() does not part them itself. */
std::vector<std::string> objectsOf(const World &world, bool self, const Arguments &arguments) {
  std::vector<std::string> objects;
  if (arguments.query.per_object && !self && arguments.asking != Asking::SEARCH) {
    objects = arguments.query.objects;
    if (objects.empty())
      for (const auto &object : world.snapshot->objects()) objects.push_back(object.first);
  }
  if (objects.empty()) objects.emplace_back();
  return objects;
}

} // namespace

Rest restOf(const TrajectoryDescription &trajectory, const World &world) {
  Rest out;
  out.joints = world.scene_joints;
  for (const auto &[joint, value] : trajectory.fixed_joints) out.joints[joint] = value;
  for (const auto &[joint, value] : world.state) out.joints[joint] = value;
  out.place = placeOf(trajectory, world.base, out.joints);
  return out;
}

TrajectoryDescription readOwnTrajectory(const Arguments &arguments, const World &world, Warnings &warnings) {
  TrajectoryDescription out = readTrajectory(arguments.trajectory, warnings);
  out.shortest_way = out.shortest_way || arguments.shortest_way;
  try {
    if (world.snapshot->robot()) adoptBase(world.srdf.virtual_joints, *world.snapshot->robot(), out);
  } catch (const Error &e) {
    throw BadUsage(arguments.trajectory + ": " + e.what());
  }
  return out;
}

RobotMotion readMotion(const Arguments &arguments, const World &world, Warnings &warnings) {
  const TrajectoryDescription trajectory = readOwnTrajectory(arguments, world, warnings);
  try {
    const Rest rest = restOf(trajectory, world);
    return RobotMotion(world.snapshot, trajectory, rest.joints, world.srdf.disabled, rest.place);
  } catch (const Error &e) {
    throw BadUsage(arguments.trajectory + ": " + e.what());
  }
}

int answerTrajectory(const Arguments &arguments, Console &console) {
  Warnings warnings;
  const World world = readWorld(arguments, warnings);
  if (world.moves()) return answerAmongMovers(arguments, world, warnings, console);
  const RobotMotion motion = readMotion(arguments, world, warnings);
  if (world.snapshot->robot())
    for (const std::string &link : unknownLinks(world.srdf, *world.snapshot->robot()))
      warnings.add("the SRDF disables link '" + link + "', which the robot does not have");
  for (const std::string &sentence : motion.warnings()) warnings.add(arguments.trajectory + ": " + sentence);
  Query query = arguments.query;
  query.options.stop = interrupted;
  query.coverage = warnings.coverage();
  query.second_opinion = secondOpinions(arguments, world.resources);
  Query around = query; // who asks about the robot itself and gives no scene means that there is none
  around.allow_empty = query.allow_empty || (arguments.self && arguments.scene.empty());

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

  /* the scene, and the robot itself; a task for each part that has rows of its own */
  catchInterrupts();
  results.write(headerOf(arguments));
  std::vector<Task> tasks;
  for (const bool self : {false, true}) {
    if (self && !arguments.self) continue;
    for (const std::string &link : linksOf(motion, self, arguments)) {
      for (const std::string &object : objectsOf(world, self, arguments))
        tasks.push_back([&, self, link, object](Workspace &workspace) {
          return askOne(motion, self, link, object, self ? query : around, arguments, workspace);
        });
    }
  }
  Rows rows;
  std::size_t next = 0;
  rows.next = [&]() -> std::optional<Task> {
    return next < tasks.size() ? std::optional<Task>(tasks[next++]) : std::nullopt;
  };
  rows.write = [&](const std::string &text) { results.write(text); };
  if (certificates) rows.certify = [&](const std::string &records) { certificates->write(records); };
  rows.portion = [] { return std::optional<double>(); };
  return finish(runRows(arguments.threads, rows, console), console);
}

} // namespace curve_proximity::cli
