/* SPDX-License-Identifier: BSD-3-Clause */
/* The robot along a joint trajectory. */
#include "trajectory.h"

#include <filesystem>

#include "../scene/yaml/errors_yaml.h"
#include "../scene/yaml/separation_yaml.h"
#include "../scene/yaml/trajectory_yaml.h"
#include "certificates.h"
#include "commands.h"
#include "exit_code.h"
#include "finish.h"
#include "moving_world.h"
#include "world_files.h"

namespace curve_proximity::cli {
namespace {

/* The command that takes scenes in which nothing else moves; "": this one takes all. */
std::string standingOnly(const Arguments &arguments) {
  if (asksFor<question::Speed>(arguments.question)) return "speed";
  if (asksFor<question::Margins>(arguments.question)) return "margins";
  return arguments.errors.empty() ? "" : "robust";
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

void warnOfMotion(const RobotMotion &motion, const Arguments &arguments, const World &world, Warnings &warnings) {
  if (world.snapshot->robot())
    for (const std::string &link : unknownLinks(world.srdf, *world.snapshot->robot()))
      warnings.add("the SRDF disables link '" + link + "', which the robot does not have");
  for (const std::string &message : motion.warnings()) warnings.add(arguments.trajectory + ": " + message);
}

std::string stemOf(const std::string &path) {
  return std::filesystem::path(path).stem().string();
}

Asked askedAlong(const RobotMotion &motion, bool self, const Arguments &arguments) {
  const std::string kind = self ? "self" : "environment";
  return {MotionSubject{motion, self}, stemOf(arguments.trajectory), kind, arguments.trajectory + ": " + kind, {}};
}

void tellOfReading(const World &world, const RobotMotion &motion, const Arguments &arguments, Console &console) {
  if (arguments.timings) tellTimings(world.timings, console);
  if (!arguments.skipped) return;
  tellSkipped(world.skipped, console);
  tellSkipped(motion.skipped(), console);
}

int answerTrajectory(const Arguments &given, Console &console) {
  Arguments arguments = given;
  Warnings warnings;
  const std::string alone = standingOnly(arguments);
  const World world = alone.empty() ? readWorld(arguments, warnings) : readStandingWorld(arguments, alone, warnings);
  if (world.moves()) return answerAmongMovers(arguments, world, warnings, console);
  const RobotMotion motion = readMotion(arguments, world, warnings);
  warnOfMotion(motion, arguments, world, warnings);
  auto *speed = std::get_if<question::Speed>(&arguments.question);
  if (speed) speed->separation = yaml::readSeparation(arguments.separation);
  std::optional<ErrorBounds> errors;
  if (!arguments.errors.empty()) errors = yaml::readErrors(arguments.errors);
  const Query query = queryOf(arguments, world, warnings);
  Query around = query; // who asks about the robot itself and gives no scene means that there is none
  around.allow_empty = query.allow_empty || (arguments.self && arguments.scene.empty());

  Output output(arguments);
  if (!arguments.certificate.empty()) {
    warnOfUnprovable(unprovable(motion, false, query), warnings);
    if (arguments.self) warnOfUnprovable(unprovable(motion, true, query), warnings);
  }
  console.warn(warnings);
  tellOfReading(world, motion, arguments, console);
  std::vector<Task> tasks;
  for (const bool self : {false, true}) {
    if (self && !arguments.self) continue;
    Asked asked = askedAlong(motion, self, arguments);
    if (asksFor<question::Speed, question::Margins>(arguments.question)) asked.place = arguments.trajectory; // no kinds
    if (errors) std::get<MotionSubject>(asked.subject).errors = &*errors;
    asked.ends_run = alone.empty() && asksFor<question::Search>(arguments.question);
    addTasks(asked, arguments, self ? query : around, tasks);
  }
  return output.answer(headerOf(arguments), tasks, console);
}

} // namespace curve_proximity::cli
