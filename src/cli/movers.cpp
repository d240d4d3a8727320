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
  if (!arguments.certificate.empty()) refuse("--certificate");
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

/* The robot against all that stands and moves, or without a robot all that moves. Kept by reference. */
class MoversSubject : public Subject {
 public:
  MoversSubject(const Movers &movers, const std::optional<OneRobot> &robot, Against against)
      : movers_(movers), robot_(robot ? &robot->robot : nullptr), against_(against) {
    id = robot ? robot->id : "movers";
    kind = robot ? "environment" : "movers";
  }
  std::array<double, 2> domain() const override {
    if (!robot_ || robot_->motion->stands()) return movers_.domain();
    const std::array<double, 2> own = robot_->motion->domain();
    return {own[0] + robot_->start, own[1] + robot_->start};
  }
  std::vector<Answer> nearest(const PairLimits &limits, const Query &query, Workspace &workspace) const override {
    if (robot_) return nearestPairs(movers_, *robot_, limits, named(query), workspace);
    return nearestPairs(movers_, against_, limits, named(query), workspace);
  }
  std::vector<ClearanceInterval> profile(const std::vector<double> &breaks, double horizon, const Query &query,
                                         Workspace &workspace) const override {
    if (robot_) return clearanceProfile(movers_, *robot_, breaks, named(query), workspace, horizon);
    return clearanceProfile(movers_, against_, breaks, named(query), workspace, horizon);
  }
  Answer contact(const Query &query, Workspace &workspace) const override {
    if (robot_) return timeOfContact(movers_, *robot_, named(query), workspace);
    return timeOfContact(movers_, against_, named(query), workspace);
  }
  Violations violations(double resolution, const Query &query, Workspace &workspace) const override {
    if (robot_) return curve_proximity::violations(movers_, *robot_, resolution, named(query), workspace);
    return curve_proximity::violations(movers_, against_, resolution, named(query), workspace);
  }
  std::vector<Answer> search(const Query &query, Workspace &workspace) const override {
    if (robot_) return {ask(movers_, *robot_, named(query), workspace)};
    return {ask(movers_, against_, named(query), workspace)};
  }

 private:
  Query named(const Query &query) const {
    Query out = query;
    if (!link.empty()) out.links = {link};
    if (!object.empty()) out.objects = {object};
    return out;
  }

  const Movers &movers_;
  const MovingRobot *robot_;
  const Against against_;
};

/* Links that have rows of their own, of those that could; "": all are one. */
std::vector<std::string> linksOf(const std::vector<std::string> &names, const Arguments &arguments) {
  if (!arguments.per_link) return {""};
  return arguments.query.links.empty() ? names : arguments.query.links;
}

/* Likewise what they are measured against: objects that stand, objects and robots that move. */
std::vector<std::string> objectsOf(const World &world, const Arguments &arguments) {
  if (!arguments.query.per_object) return {""};
  std::vector<std::string> out = arguments.query.objects;
  if (!out.empty()) return out;
  for (const auto &object : world.snapshot->objects()) out.push_back(object.first);
  for (const auto &object : world.snapshot->moving()) out.push_back(object.first);
  for (const MovingRobotFile &robot : world.moving_robots) out.push_back(robot.name);
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
  const auto add = [&](const auto &of, const std::string &link, const std::string &object) {
    tasks.push_back([&, of, link, object](Workspace &workspace) {
      auto one = of;
      one.place = place + ": " + of.kind;
      one.link = link;
      one.object = object;
      Outcome out;
      cli::answer(one, arguments, query, workspace, out);
      return out;
    });
  };
  const Against against = arguments.self ? Against::BOTH : Against::OTHERS;
  const std::vector<std::string> names = subject ? movingNames(*subject->robot.motion) : std::vector<std::string>();
  for (const std::string &link : linksOf(names, arguments))
    for (const std::string &object : objectsOf(world, arguments))
      add(MoversSubject(movers, subject, against), link, object);
  if (subject && arguments.self) {
    MotionSubject itself(*subject->robot.motion, true);
    itself.id = subject->id;
    for (const std::string &link : linksOf(askedNames(*subject->robot.motion, true), arguments)) add(itself, link, "");
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
