/* SPDX-License-Identifier: BSD-3-Clause */
/** T.yaml: a joint trajectory and what belongs to it. */
#ifndef CURVE_PROXIMITY_CLI_TRAJECTORY_YAML_H
#define CURVE_PROXIMITY_CLI_TRAJECTORY_YAML_H

#include <string>

#include <curve_proximity/trajectory.hpp>

#include "../scene/yaml/yaml_value.h"
#include "failure.h"

namespace curve_proximity::cli {

/** Reads a trajectory; its id is the file's stem. Throws BadUsage naming the file and the place. */
TrajectoryDescription readTrajectory(const std::string &path, Warnings &warnings);

} // namespace curve_proximity::cli
#endif
