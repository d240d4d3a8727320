/* SPDX-License-Identifier: BSD-3-Clause */
/* What a robot passes through along a trajectory, as cells of a grid. */
#include <curve_proximity/swept_volume.hpp>

#include <algorithm>

#include "commands.h"
#include "csv.h"
#include "exit_code.h"
#include "finish.h"
#include "run.h"
#include "trajectory.h"
#include "world_files.h"

namespace curve_proximity::cli {
namespace {

bool endsIn(const std::string &path, const std::string &end) {
  return path.size() >= end.size() && path.compare(path.size() - end.size(), end.size(), end) == 0;
}

/* By the name of the file: an octree or a mesh. */
std::string fileOf(const std::string &path, const SweptVolume &volume, bool inside_only) {
  return endsIn(path, ".stl") ? toStl(volume, inside_only) : toOctomap(volume, inside_only);
}

void checkName(const std::string &path, const std::string &option) {
  if (!path.empty() && !endsIn(path, ".stl") && !endsIn(path, ".bt"))
    throw BadUsage(option + " is '" + path + "'; its name must end in .bt (octomap) or .stl");
}

} // namespace

int sweepVolume(const Arguments &arguments, Console &console) {
  checkName(arguments.out, "--out");
  checkName(arguments.inside, "--inside");
  Warnings warnings;
  const World world = readStandingWorld(arguments, "sweep", warnings);
  const RobotMotion motion = readMotion(arguments, world, warnings);
  warnOfMotion(motion, arguments, world, warnings);
  FileOutput output(arguments);
  console.warn(warnings);
  tellOfReading(world, motion, arguments, console);

  SweptVolume volume;
  const auto work = [&](Workspace &) {
    Outcome out;
    try {
      SweepOptions options;
      options.resolution = arguments.resolution;
      options.links = arguments.query.links;
      options.inside = !arguments.inside.empty();
      options.threads = static_cast<unsigned>(arguments.threads);
      options.stop = interrupted;
      volume = sweptVolume(motion, options);
      const auto inside = std::count(volume.inside.begin(), volume.inside.end(), true);
      const double cell = volume.resolution * volume.resolution * volume.resolution;
      out.text = quotedField(stemOf(arguments.trajectory)) + ',' + std::to_string(volume.cells.size()) + ',' +
                 (options.inside ? std::to_string(inside) : "");
      appendField(out.text, cell * static_cast<double>(volume.cells.size()));
      appendField(out.text, cell * static_cast<double>(inside), options.inside);
      appendField(out.text, volume.gap);
      out.text += ',' + std::to_string(volume.n_poses) + '\n';
    } catch (const Error &e) {
      out.stopped = e.status() == CPROX_STOPPED;
      out.error_messages.push_back(arguments.trajectory + ": " + e.what());
    }
    return out;
  };
  const int code = output.rows.answer("id,cells,inside,volume,volume_inside,gap,poses\n", {work}, console);
  if (volume.cells.empty()) return code;
  output.file.write(fileOf(arguments.out, volume, false));
  if (!arguments.inside.empty()) {
    ResultsFile inside(arguments.inside, inputsOf(arguments), "--inside");
    inside.write(fileOf(arguments.inside, volume, true));
  }
  return code;
}

} // namespace curve_proximity::cli
