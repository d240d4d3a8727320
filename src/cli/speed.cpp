/* SPDX-License-Identifier: BSD-3-Clause */
/* How fast a robot may go along its trajectory while a person may walk up to it. */
#include <curve_proximity/robust.hpp>
#include <curve_proximity/separation.hpp>

#include "../scene/query/question.h"
#include "../scene/yaml/errors_yaml.h"
#include "../scene/yaml/separation_yaml.h"
#include "commands.h"
#include "csv.h"
#include "failure.h"
#include "finish.h"
#include "trajectory.h"
#include "world.h"

namespace curve_proximity::cli {
namespace {

Outcome limitOne(const RobotMotion &motion, const Separation &separation, const std::optional<ErrorBounds> &errors,
                 const Arguments &arguments, const Query &query, Workspace &workspace) {
  Outcome out;
  const std::string id = stemOf(arguments.trajectory);
  try {
    const SpeedLimits limits =
        errors ? limitSpeed(robustProfile(motion, false, *errors, breaksOf(arguments.profile, motion.domain()), query,
                                          workspace),
                            separation)
               : speedLimits(motion, arguments.profile.intervals, separation, query, workspace);
    for (std::size_t i = 0; i < limits.profile.size(); ++i) {
      const ClearanceInterval &interval = limits.profile[i];
      out.stopped = out.stopped || interval.status == CPROX_STOPPED;
      out.against_nothing = out.against_nothing || interval.gap == Gap::EMPTY;
      noteGap(interval.gap, out);
      out.text += speedLine(id, interval, limits.overrides[i], limits.constant, limits.unwatched);
    }
  } catch (const Error &e) {
    out.text = failedSpeedLine(id, e.status(), e.what());
    out.complaints.push_back(arguments.trajectory + ": " + e.what());
  }
  return out;
}

} // namespace

int limitSpeeds(const Arguments &arguments, Console &console) {
  Warnings warnings;
  const World world = readStandingWorld(arguments, "speed", warnings);
  const RobotMotion motion = readMotion(arguments, world, warnings);
  warnOfMotion(motion, arguments, world, warnings);
  const Separation separation = yaml::readSeparation(arguments.separation);
  std::optional<ErrorBounds> errors;
  if (!arguments.errors.empty()) errors = yaml::readErrors(arguments.errors);
  const Query query = queryOf(arguments, world, warnings);

  Output output(arguments);
  console.warn(warnings);
  tellOfReading(world, motion, arguments, console);
  return output.answer(speedHeader(), {[&](Workspace &workspace) {
                         return limitOne(motion, separation, errors, arguments, query, workspace);
                       }},
                       console);
}

} // namespace curve_proximity::cli
