/* SPDX-License-Identifier: BSD-3-Clause */
/** T.yaml: a joint trajectory and what belongs to it. */
#ifndef CURVE_PROXIMITY_YAML_TRAJECTORY_YAML_H
#define CURVE_PROXIMITY_YAML_TRAJECTORY_YAML_H

#include <string>

#include <curve_proximity/trajectory.hpp>

#include "yaml_value.h"

namespace curve_proximity::yaml {

/** Reads a trajectory; its id is the file's stem. Throws BadUsage naming the file and the place. */
TrajectoryDescription readTrajectory(const std::string &path, Warnings &warnings);

} // namespace curve_proximity::yaml
#endif
