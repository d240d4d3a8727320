/* SPDX-License-Identifier: BSD-3-Clause */
/** The robot of --robot, --srdf and --state. */
#ifndef CURVE_PROXIMITY_CLI_ROBOT_FILE_H
#define CURVE_PROXIMITY_CLI_ROBOT_FILE_H

#include <memory>
#include <string>

#include <curve_proximity/robot.hpp>
#include <curve_proximity/srdf.hpp>

#include "../scene/yaml/yaml_value.h"
#include "exit_code.h"

namespace curve_proximity::cli {

/** A file's text. Throws BadUsage with the file's name where it cannot be read. */
std::string readText(const std::string &path);

/** Reads a URDF; mesh files without a scheme are relative to its folder. Throws BadUsage with the file's name. */
std::shared_ptr<const Robot> readRobot(const std::string &path, double mesh_tolerance = 0.0,
                                       bool allow_missing_geometry = false);

/** Throws BadUsage with the file's name where it cannot be read or is no SRDF. */
Srdf readSrdf(const std::string &path);

/** "joint: value, …" of --state. Throws BadUsage: no such text, a value that is not a finite number, a joint that the
 *  robot does not have. */
JointPositions readState(const std::string &text, const Robot &robot);

} // namespace curve_proximity::cli
#endif
