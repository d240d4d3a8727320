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
    adoptBase(srdf.virtual_joints, *own.snapshot()->robot(), trajectory);
    return {file.name,
            std::make_shared<const RobotMotion>(own.snapshot(), trajectory, trajectory.fixed_joints, srdf.disabled,
                                                file.base),
            file.start, file.tolerance};
  } catch (const Error &e) {
    throw BadUsage(place + e.what());
  } catch (const BadUsage &e) {
    throw BadUsage(place + e.what());
  }
}

/* Kept by reference. */
class MoversSubject : public Subject {
 public:
  MoversSubject(const MovingWorld &moving, Against against)
      : moving_(moving),
        movers_(moving.movers),
        robot_(moving.subject ? &*moving.subject : nullptr),
        against_(against) {
    id = "movers";
    kind = robot_ ? "environment" : "movers";
  }
  std::array<double, 2> domain() const override {
    if (rides()) return moving_.rides;
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
    Query asked = named(query);
    asked.options.interval = query.options.interval; // breaks say which times
    if (robot_) return clearanceProfile(movers_, *robot_, breaks, asked, workspace, horizon);
    return clearanceProfile(movers_, against_, breaks, asked, workspace, horizon);
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
    if (!moving_.rider.empty()) out.links = {moving_.rider};
    if (rides()) out.options.interval = moving_.rides.data();
    return out;
  }
  bool rides() const {
    return moving_.rides[0] < moving_.rides[1];
  }

  const MovingWorld &moving_;
  const Movers &movers_;
  const MovingRobot *robot_;
  const Against against_;
};

std::string stemOf(const std::string &path) {
  return std::filesystem::path(path).stem().string();
}

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

int answer(const Arguments &arguments, const World &world, std::shared_ptr<const RobotMotion> motion,
           Warnings &warnings, Console &console) {
  checkAsked(arguments);
  const MovingWorld moving = gatherMovers(arguments, world, std::move(motion));
  const RobotMotion *robot = moving.subject ? moving.subject->motion.get() : nullptr;
  for (const MovingRobot &other : moving.others)
    for (const std::string &sentence : other.motion->warnings())
      warnings.add(arguments.scene + ": moving robot '" + other.name + "': " + sentence);
  Query query = arguments.query;
  query.options.stop = interrupted;
  query.coverage = warnings.coverage();
  query.second_opinion = secondOpinions(arguments, world.resources);
  const std::string place = robot ? arguments.trajectory : arguments.path.empty() ? arguments.scene : arguments.path;
  ResultsFile results(arguments.out, {arguments.trajectory, arguments.path, arguments.body, arguments.scene,
                                      arguments.robot, arguments.srdf});
  console.warn(warnings);
  if (arguments.timings) tellTimings(world.timings, console);
  if (arguments.skipped) tellSkipped(world.skipped, console);

  /* a task for each part that has rows of its own */
  catchInterrupts();
  results.write(headerOf(arguments));
  std::vector<Task> tasks;
  const auto add = [&](std::shared_ptr<Subject> subject, const std::string &link, const std::string &object) {
    subject->place = place + ": " + subject->kind;
    subject->link = link;
    subject->object = object;
    tasks.push_back([&, subject](Workspace &workspace) {
      Outcome out;
      cli::answer(*subject, arguments, query, workspace, out);
      return out;
    });
  };
  const std::vector<std::string> names = robot ? movingNames(*robot) : std::vector<std::string>();
  for (const std::string &link : linksOf(names, arguments))
    for (const std::string &object : objectsOf(world, arguments)) add(subjectAmong(moving, arguments), link, object);
  if (robot && arguments.self) {
    for (const std::string &link : linksOf(askedNames(*robot, true, arguments.query.moving_only), arguments)) {
      auto itself = std::make_shared<MotionSubject>(*robot, true);
      itself->id = stemOf(arguments.trajectory);
      add(itself, link, "");
    }
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

MovingObject toMover(const Ride &ride, const Snapshot &scene) {
  if (ride.body.shapes.empty()) return carriedObject(scene, ride.body.id, ride.poses);
  MovingObject out;
  out.object = ride.body;
  out.poses = ride.poses;
  return out;
}

} // namespace

std::vector<MovingRobot> furtherRobots(const Arguments &arguments, const World &world, std::int64_t origin) {
  constexpr double NANOSECOND = 1e-9;
  std::vector<MovingRobot> out;
  for (const MovingRobotFile &file : world.moving_robots) {
    out.push_back(load(file, arguments.scene));
    if (file.start != 0.0) out.back().start -= NANOSECOND * static_cast<double>(origin);
  }
  return out;
}

MovingWorld gatherMovers(const Arguments &arguments, const World &world, std::shared_ptr<const RobotMotion> subject) {
  std::optional<MovingRobot> robot;
  if (subject) robot = MovingRobot{world.snapshot->robot()->name(), std::move(subject), 0.0, 0.0};
  const std::int64_t origin = world.ride ? world.ride->origin : 0;
  std::vector<MovingRobot> others = furtherRobots(arguments, world, origin);
  std::vector<MovingObject> objects = movingObjects(*world.snapshot, origin);
  try {
    if (robot) checkClocks(*robot, others, objects);
    if (world.ride) objects.push_back(toMover(*world.ride, *world.snapshot));
    std::vector<MovingRobot> all = others;
    if (robot) all.insert(all.begin(), *robot);
    MovingWorld out{robot, std::move(others), Movers(world.snapshot, all, objects, {}, world.resources)};
    if (!world.ride) return out;
    out.rider = world.ride->body.id;
    out.rides = {world.ride->poses.front().time, world.ride->poses.back().time};
    return out;
  } catch (const Error &e) {
    throw BadUsage((arguments.path.empty() ? arguments.scene : arguments.path) + ": " + e.what());
  }
}

std::unique_ptr<Subject> subjectAmong(const MovingWorld &moving, const Arguments &arguments) {
  auto out = std::make_unique<MoversSubject>(moving, arguments.self ? Against::BOTH : Against::OTHERS);
  if (moving.subject) out->id = stemOf(arguments.trajectory);
  if (!moving.rider.empty()) out->id = stemOf(arguments.path);
  return out;
}

int answerAmongMovers(const Arguments &arguments, const World &world, Warnings &warnings, Console &console) {
  auto motion = std::make_shared<const RobotMotion>(readMotion(arguments, world, warnings));
  for (const std::string &sentence : motion->warnings()) warnings.add(arguments.trajectory + ": " + sentence);
  return answer(arguments, world, std::move(motion), warnings, console);
}

int answerMovers(const Arguments &arguments, Console &console) {
  Warnings warnings;
  const World world = readWorld(arguments, warnings);
  if (!world.moves() && !world.ride)
    throw BadUsage(arguments.scene + ": nothing moves in this scene: no object has a trajectory");
  return answer(arguments, world, nullptr, warnings, console);
}

} // namespace curve_proximity::cli
