/* SPDX-License-Identifier: BSD-3-Clause */
/* How far objects may be moved before a robot's motion is no longer clear of them. */
#include <curve_proximity/margins.hpp>

#include "commands.h"
#include "failure.h"
#include "finish.h"
#include "trajectory.h"
#include "world.h"

namespace curve_proximity::cli {
namespace {

Outcome marginsOf(const RobotMotion &motion, const Arguments &arguments, const Query &query, Workspace &workspace) {
  Outcome out;
  const std::string id = stemOf(arguments.trajectory);
  try {
    const std::vector<ObjectMargin> rows = objectMargins(motion, arguments.nearest.limits.within, query, workspace);
    out.against_nothing = rows.empty();
    for (const ObjectMargin &row : rows) {
      out.stopped = out.stopped || row.status == CPROX_STOPPED;
      out.violated = out.violated || row.blocked == 0.0;
      noteGap(row.gap, out);
      out.text += marginLine(id, row);
    }
  } catch (const Error &e) {
    out.text = failedMarginLine(id, e.status(), e.what());
    out.complaints.push_back(arguments.trajectory + ": " + e.what());
  }
  return out;
}

} // namespace

int listMargins(const Arguments &arguments, Console &console) {
  Warnings warnings;
  const World world = readStandingWorld(arguments, "margins", warnings);
  const RobotMotion motion = readMotion(arguments, world, warnings);
  warnOfMotion(motion, arguments, world, warnings);
  const Query query = queryOf(arguments, world, warnings);

  Output output(arguments);
  console.warn(warnings);
  tellOfReading(world, motion, arguments, console);
  return output.answer(marginHeader(),
                       {[&](Workspace &workspace) { return marginsOf(motion, arguments, query, workspace); }}, console);
}

} // namespace curve_proximity::cli
