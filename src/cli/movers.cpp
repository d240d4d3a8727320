/* SPDX-License-Identifier: BSD-3-Clause */
/* Robots and objects that move on one clock. */
#include "movers.h"

#include <curve_proximity/movers.hpp>
#include <filesystem>

#include "asking.h"
#include "commands.h"
#include "failure.h"
#include "finish.h"
#include "results.h"
#include "robot_file.h"
#include "run.h"
#include "trajectory.h"

namespace curve_proximity::cli {
namespace {

/* What is not available of movers. Throws BadUsage with one line. */
void checkAsked(const Arguments &arguments) {
  const auto refuse = [&](const std::string &what) {
    throw BadUsage(arguments.scene + ": " + what + " is not available where objects or further robots move");
  };
  if (arguments.asking == Asking::PROFILE) refuse("'profile'");
  if (arguments.asking == Asking::NEAREST) refuse("'nearest'");
  if (arguments.asking == Asking::VIOLATIONS) refuse("'violations'");
  if (!arguments.certificate.empty()) refuse("--certificate");
  if (arguments.query.per_object) refuse("--per-object");
  if (arguments.per_link) refuse("--per-link");
  if (arguments.query.options.signed_distance) refuse("--signed");
}

MovingRobot load(const MovingRobotFile &file, const std::string &scene) {
  const std::string place = scene + ": moving robot '" + file.name + "': ";
  try {
    const Srdf srdf = file.srdf.empty() ? Srdf() : readSrdf(file.srdf);
    const Scene own(readRobot(file.urdf), {}, allowedPairs(srdf));
    TrajectoryDescription trajectory = file.trajectory;
    adoptBase(srdf.virtual_joints, trajectory);
    return {file.name,
            std::make_shared<const RobotMotion>(own.snapshot(), trajectory, trajectory.fixed_joints, srdf.disabled,
                                                file.base),
            file.start};
  } catch (const Error &e) {
    throw BadUsage(place + e.what());
  } catch (const BadUsage &e) {
    throw BadUsage(place + e.what());
  }
}

/* The robot of the command line. */
struct OneRobot {
  MovingRobot robot;
  std::string id;
};

Movers gather(const Arguments &arguments, const World &world, const std::optional<OneRobot> &subject) {
  std::vector<MovingRobot> robots;
  for (const MovingRobotFile &file : world.moving_robots) robots.push_back(load(file, arguments.scene));
  const std::vector<MovingObject> objects = movingObjects(*world.snapshot);
  try {
    if (subject) checkClocks(subject->robot, robots, objects);
    if (subject) robots.insert(robots.begin(), subject->robot);
    return Movers(world.snapshot, robots, objects);
  } catch (const Error &e) {
    throw BadUsage(arguments.scene + ": " + e.what());
  }
}

void addRow(const Answer &answer, const Arguments &arguments, const std::string &place, Outcome &out) {
  out.stopped = out.stopped || answer.result.status == CPROX_STOPPED;
  const ResultRow row = toRow(answer, arguments.query.query_type);
  out.text += resultsLine(row, columnsOf(arguments));
  noteVerdict(row, out);
  if (answer.result.status < 0) out.complaints.push_back(place + ": " + answer.kind + ": " + answer.message);
}

Outcome askMovers(const Movers &movers, const std::optional<OneRobot> &subject, const Query &query,
                  const Arguments &arguments, const std::string &place, Workspace &workspace) {
  const bool contact = arguments.asking == Asking::CONTACT;
  Answer answer;
  if (subject) {
    answer = contact ? timeOfContact(movers, subject->robot, query, workspace)
                     : ask(movers, subject->robot, query, workspace);
    answer.id = subject->id;
  } else {
    const Against against = arguments.self ? Against::BOTH : Against::OTHERS;
    answer = contact ? timeOfContact(movers, against, query, workspace) : ask(movers, against, query, workspace);
  }
  Outcome out;
  addRow(answer, arguments, place, out);
  return out;
}

Outcome askItself(const OneRobot &subject, const Query &query, const Arguments &arguments, const std::string &place,
                  Workspace &workspace) {
  Answer answer = arguments.asking == Asking::CONTACT ? timeOfContact(*subject.robot.motion, true, query, workspace)
                                                      : askSelf(*subject.robot.motion, query, workspace);
  answer.id = subject.id;
  Outcome out;
  addRow(answer, arguments, place, out);
  return out;
}

int answer(const Arguments &arguments, const World &world, const std::optional<OneRobot> &subject, Warnings &warnings,
           Console &console) {
  checkAsked(arguments);
  const Movers movers = gather(arguments, world, subject);
  Query query = arguments.query;
  query.options.stop = interrupted;
  query.second_opinion = secondOpinions(arguments, world.resources);
  const std::string place = subject ? arguments.trajectory : arguments.scene;
  ResultsFile results(arguments.out, {arguments.trajectory, arguments.scene, arguments.robot, arguments.srdf});
  console.warn(warnings);
  if (arguments.timings) tellTimings(world.timings, console);
  if (arguments.skipped) tellSkipped(world.skipped, console);

  catchInterrupts();
  results.write(headerOf(arguments));
  std::vector<Task> tasks;
  tasks.push_back([&](Workspace &workspace) { return askMovers(movers, subject, query, arguments, place, workspace); });
  if (subject && arguments.self)
    tasks.push_back([&](Workspace &workspace) { return askItself(*subject, query, arguments, place, workspace); });
  Rows rows;
  std::size_t next = 0;
  rows.next = [&]() -> std::optional<Task> {
    return next < tasks.size() ? std::optional<Task>(tasks[next++]) : std::nullopt;
  };
  rows.write = [&](const std::string &text) { results.write(text); };
  rows.portion = [] { return std::optional<double>(); };
  return finish(runRows(arguments.threads, rows, console), console);
}

} // namespace

int answerAmongMovers(const Arguments &arguments, const World &world, Warnings &warnings, Console &console) {
  OneRobot subject;
  subject.robot.name = world.snapshot->robot()->name();
  subject.robot.motion = std::make_shared<const RobotMotion>(readMotion(arguments, world, warnings));
  subject.id = std::filesystem::path(arguments.trajectory).stem().string();
  for (const std::string &sentence : subject.robot.motion->warnings())
    warnings.add(arguments.trajectory + ": " + sentence);
  return answer(arguments, world, subject, warnings, console);
}

int answerMovers(const Arguments &arguments, Console &console) {
  Warnings warnings;
  const World world = readWorld(arguments, warnings);
  if (!world.moves()) throw BadUsage(arguments.scene + ": nothing moves in this scene: no object has a trajectory");
  return answer(arguments, world, std::nullopt, warnings, console);
}

} // namespace curve_proximity::cli
