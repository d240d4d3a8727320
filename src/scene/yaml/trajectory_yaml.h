/* SPDX-License-Identifier: BSD-3-Clause */
/** T.yaml: a joint trajectory and what belongs to it. */
#ifndef CURVE_PROXIMITY_YAML_TRAJECTORY_YAML_H
#define CURVE_PROXIMITY_YAML_TRAJECTORY_YAML_H

#include <cstdint>
#include <string>

#include <curve_proximity/description.hpp>
#include <curve_proximity/trajectory.hpp>

#include "yaml_value.h"

namespace curve_proximity::yaml {

/** Seconds, or {secs, nsecs} as ROS prints a time or a duration. */
double readTime(const YamlValue &value);

/** A stamp [ns]: seconds, or {secs, nsecs}; times since 1970 have no room in a double. */
std::int64_t readStamp(const YamlValue &value);

/** `start_tolerance` and `any_time` of what moves: [s], infinity where that is true. */
double readStartTolerance(const YamlValue &value);

/** The trajectory of an object: {start, turning, waypoints: [{time, pose}]}. */
ObjectTrajectory readObjectTrajectory(const YamlValue &value, Warnings &warnings);

/** A trajectory as a map in another file, or as the path of its file, relative to `folder`. */
TrajectoryDescription readTrajectoryValue(const YamlValue &value, const std::string &folder, Warnings &warnings);

/** Reads a trajectory; its id is the file's stem. Throws BadUsage naming the file and the place. */
TrajectoryDescription readTrajectory(const std::string &path, Warnings &warnings);

} // namespace curve_proximity::yaml
#endif
