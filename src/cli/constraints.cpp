/* SPDX-License-Identifier: BSD-3-Clause */
#include <utility>

#include "../providers/check_gradient.h"
#include "../providers/constraint_case.h"
#include "../scene/yaml/scene_change.h"
#include "../scene/yaml/scene_yaml.h"
#include "../scene/yaml/trajectory_yaml.h"
#include "commands.h"
#include "constraint_lines.h"
#include "constraints_yaml.h"
#include "exit_code.h"
#include "finish.h"
#include "moving_world.h"
#include "packages.h"
#include "results.h"
#include "run.h"
#include "trajectory.h"
#include "world_files.h"

namespace curve_proximity::cli {
namespace {

/* The objects of --scene and the links of --robot; none without. */
World readSides(const Arguments &arguments, const ResourceOptions &resources, Warnings &warnings) {
  if (!arguments.scene.empty() || !arguments.robot.empty())
    return readStandingWorld(arguments, "'constraints'", warnings);
  World nothing;
  nothing.snapshot = Scene(nullptr, resources).snapshot();
  return nothing;
}

/* The one provider. Whatever is wrong with it, there is nothing to answer. */
std::unique_ptr<ProviderSet> loadProvider(const Arguments &arguments) {
  std::unique_ptr<ProviderSet> set;
  const std::string why = messageOf([&] {
    const std::vector<ProviderSpec> specs = {
        {arguments.provider, arguments.provider, parseParameters(arguments.parameters)}};
    set = std::make_unique<ProviderSet>(specs);
  });
  if (!set) throw BadUsage("--provider " + arguments.provider + ": " + why);
  const LoadedProvider &loaded = set->all().front();
  if (!loaded.provider) throw BadUsage("--provider " + arguments.provider + " failed to load: " + loaded.failure);
  return set;
}

/* What one case is answered by. */
struct Session {
  ProviderSet &providers;
  const Arguments &arguments;
  const ResourceOptions &resources;
};

/* The lines of a case that has been answered, and what its gradient is worth where that is asked. */
void tellAnswer(const Session &session, const ConstraintCase &described, const ConstraintRow &row, Workspace &workspace,
                Outcome &out) {
  if (!session.arguments.check_gradient) {
    out.text = described.motion ? constraintsLines(row, described.motion->trajectory) : constraintsLine(row);
    return;
  }
  const GradientCheck check = checkGradient(session.providers, described, row, session.resources, workspace);
  out.text = gradientsLine(row, &check);
  out.violated = verdictOf(check) == CPROX_VERDICT_VIOLATED;
  out.undecided = verdictOf(check) == CPROX_VERDICT_UNDECIDED;
}

/* Answers a case, or says why it cannot be asked about. */
Outcome answerOne(const Session &session, ConstraintCase described, const std::string &fault, const std::string &place,
                  Workspace &workspace) {
  const Arguments &arguments = session.arguments;
  Outcome out;
  ConstraintRow row = failedRow(described.id, fault);
  if (fault.empty()) {
    described.providers = {arguments.provider};
    row = answerCase(session.providers, described, session.resources, workspace).front();
  }
  row.provider = arguments.provider;
  out.stopped = row.status == CPROX_STOPPED || (row.status < 0 && interrupted(nullptr));
  if (row.status >= 0) {
    const std::string why = messageOf([&] { tellAnswer(session, described, row, workspace, out); }, &row.status);
    out.undecided = out.undecided || row.gap;
    if (row.status >= 0) return out;
    row.message = why;
  }
  if (arguments.check_gradient)
    out.text = gradientsLine(row, nullptr);
  else
    out.text = described.motion ? constraintsLines(row, described.motion->trajectory) : constraintsLine(row);
  out.error_messages.push_back(place + ": " + row.message);
  return out;
}

/* A case for each entry of --in. */
int answerCases(const Arguments &arguments, Console &console) {
  Warnings warnings;
  const std::vector<YamlValue> entries = readCases(arguments.cases, warnings);
  ResourceOptions resources;
  resources.base_dir = folderOf(arguments.cases);
  resources.find_package = packageFinder(resources.base_dir);
  const World world = readSides(arguments, resources, warnings);
  Coverage files = warnings.coverage();
  files.add(world.snapshot->coverage());
  if (world.snapshot->robot()) files.add(world.snapshot->robot()->coverage());
  const std::unique_ptr<ProviderSet> providers = loadProvider(arguments);
  const Session session{*providers, arguments, resources};
  Output output(arguments);

  /* case by case; a warning is told when it first comes up */
  std::size_t given = 0, warned = 0;
  Rows rows;
  rows.next = [&]() -> std::optional<Task> {
    if (given == entries.size()) return std::nullopt;
    const YamlValue &entry = entries[given++];
    ConstraintCase described;
    described.id = caseId(entry);
    const std::string place = arguments.cases + ": case " + std::to_string(given) + " (id '" + described.id + "')";
    Warnings own;
    const std::string fault = messageOf([&] { described = parseCase(entry, world, own); });
    described.coverage = files;
    described.coverage.add(own.coverage());
    warnings.add(own);
    for (; warned < warnings.messages().size(); ++warned) console.say("warning: " + warnings.messages()[warned]);
    return [&, described, fault, place](Workspace &workspace) {
      return answerOne(session, described, fault, place, workspace);
    };
  };
  rows.portion = [&]() -> std::optional<double> {
    return entries.empty() ? 1.0 : static_cast<double>(given) / static_cast<double>(entries.size());
  };
  return output.answer(arguments.check_gradient ? gradientsHeader() : constraintsHeader(), rows, console);
}

/* The robot of the command line along --trajectory, ready to be asked about. */
ConstraintCase readMotionCase(const Arguments &arguments, const World &world, Warnings &warnings) {
  ConstraintCase out;
  MotionCase motion;
  motion.trajectory = readOwnTrajectory(arguments, world, warnings);
  out.stop = interrupted;
  try {
    const Rest rest = restOf(motion.trajectory, world);
    motion.rest = rest.joints;
    motion.robot = std::make_shared<const PreparedRobot>(world.snapshot, world.srdf.disabled, motion.trajectory.base,
                                                         motion.trajectory.base_joints, rest.place);
    const RobotMotion tried(*motion.robot, motion.trajectory, motion.rest);
    for (const std::string &message : tried.warnings()) warnings.add(arguments.trajectory + ": " + message);
    motion.other_robots = furtherRobots(arguments, world);
  } catch (const Error &e) {
    throw BadUsage(arguments.trajectory + ": " + e.what());
  }
  out.id = motion.trajectory.id;
  out.motion = std::move(motion);
  return out;
}

/* One case: the trajectory. */
int answerMotion(const Arguments &arguments, Console &console) {
  Warnings warnings;
  const World world = readWorld(arguments, warnings);
  const ConstraintCase described = readMotionCase(arguments, world, warnings);
  const std::unique_ptr<ProviderSet> providers = loadProvider(arguments);
  const ResourceOptions resources;
  const Session session{*providers, arguments, resources};
  Output output(arguments);
  console.warn(warnings);
  const std::vector<Task> one{
      [&](Workspace &workspace) { return answerOne(session, described, "", arguments.trajectory, workspace); }};
  return output.answer(arguments.check_gradient ? gradientsHeader() : constraintsHeader(described.motion->trajectory),
                       one, console);
}

} // namespace

int answerConstraints(const Arguments &arguments, Console &console) {
  return arguments.trajectory.empty() ? answerCases(arguments, console) : answerMotion(arguments, console);
}

} // namespace curve_proximity::cli
