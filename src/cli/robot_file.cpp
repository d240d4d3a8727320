/* SPDX-License-Identifier: BSD-3-Clause */
#include "robot_file.h"

#include <filesystem>
#include <fstream>
#include <iterator>

#include "../scene/yaml/scene_change.h"
#include "exit_code.h"
#include "packages.h"

namespace curve_proximity::cli {
std::string readText(const std::string &path) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) throw BadUsage(path + ": is a folder, not a file");
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw BadUsage(path + ": cannot be read");
  return std::string((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
}

std::shared_ptr<const Robot> readRobot(const std::string &path, double mesh_tolerance, bool allow_missing_geometry) {
  RobotOptions options;
  options.allow_missing_geometry = allow_missing_geometry;
  options.resources.base_dir = folderOf(path);
  options.resources.find_package = packageFinder(options.resources.base_dir);
  options.resources.mesh_tolerance = mesh_tolerance;
  try {
    return Robot::fromUrdf(readText(path), options);
  } catch (const Error &e) {
    throw BadUsage(path + ": " + e.what());
  }
}

Srdf readSrdf(const std::string &path) {
  try {
    return parseSrdf(readText(path));
  } catch (const Error &e) {
    throw BadUsage(path + ": " + e.what());
  }
}

JointPositions readState(const std::string &text, const Robot &robot) {
  JointPositions out;
  try {
    const YAML::Node map = YAML::Load("{" + text + "}");
    for (const auto &entry : map) {
      const std::string joint = YamlValue(entry.first, "--state").text();
      if (!robot.hasJoint(joint)) throw BadUsage("--state: '" + joint + "' is no joint of the robot");
      const double value = YamlValue(entry.second, "--state: " + joint).number();
      if (!out.emplace(joint, value).second) throw BadUsage("--state: '" + joint + "' is given twice");
    }
  } catch (const YAML::Exception &) {
    throw BadUsage("--state is '" + text + "'; it must be \"joint: value, joint: value, …\"");
  } catch (const BadInput &e) {
    throw BadUsage(e.what());
  }
  return out;
}

} // namespace curve_proximity::cli
