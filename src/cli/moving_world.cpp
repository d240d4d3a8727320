/* SPDX-License-Identifier: BSD-3-Clause */
/* Robots and objects that move on one clock. */
#include "moving_world.h"

#include <curve_proximity/movers.hpp>

#include "commands.h"
#include "exit_code.h"
#include "finish.h"
#include "robot_file.h"
#include "trajectory.h"

namespace curve_proximity::cli {
namespace {

/* What is not available of movers. Throws BadUsage with one line. */
void checkAsked(const Arguments &arguments) {
  const auto refuse = [&](const std::string &what) {
    throw BadUsage(arguments.scene + ": " + what + " is not available where objects or further robots move");
  };
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

int answer(const Arguments &arguments, const World &world, std::shared_ptr<const RobotMotion> motion,
           Warnings &warnings, Console &console) {
  checkAsked(arguments);
  const MovingWorld moving = gatherMovers(arguments, world, std::move(motion));
  const RobotMotion *robot = moving.subject ? moving.subject->motion.get() : nullptr;
  for (const MovingRobot &other : moving.others)
    for (const std::string &message : other.motion->warnings())
      warnings.add(arguments.scene + ": moving robot '" + other.name + "': " + message);
  const Query query = queryOf(arguments, world, warnings);
  Output output(arguments);
  console.warn(warnings);
  if (arguments.timings) tellTimings(world.timings, console);
  if (arguments.skipped) tellSkipped(world.skipped, console);
  std::vector<Task> tasks;
  addTasks(askedAmong(moving, arguments), arguments, query, tasks);
  if (robot && arguments.self) addTasks(askedAlong(*robot, true, arguments), arguments, query, tasks);
  return output.answer(headerOf(arguments), tasks, console);
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

Asked askedAmong(const MovingWorld &moving, const Arguments &arguments) {
  const MovingRobot *robot = moving.subject ? &*moving.subject : nullptr;
  const Against against = arguments.self ? Against::BOTH : Against::OTHERS;
  const std::string kind = robot ? "environment" : "movers";
  const std::string &file = robot ? arguments.trajectory : arguments.path;
  return {MoversSubject{moving.movers, robot, against, moving.rider, moving.rides},
          file.empty() ? "movers" : stemOf(file),
          kind,
          (file.empty() ? arguments.scene : file) + ": " + kind,
          {}};
}

int answerAmongMovers(const Arguments &arguments, const World &world, Warnings &warnings, Console &console) {
  auto motion = std::make_shared<const RobotMotion>(readMotion(arguments, world, warnings));
  for (const std::string &message : motion->warnings()) warnings.add(arguments.trajectory + ": " + message);
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
