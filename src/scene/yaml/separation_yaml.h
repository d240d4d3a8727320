/* SPDX-License-Identifier: BSD-3-Clause */
/** SEPARATION.yaml: the constants of speed and separation monitoring. */
#ifndef CURVE_PROXIMITY_YAML_SEPARATION_YAML_H
#define CURVE_PROXIMITY_YAML_SEPARATION_YAML_H

#include <string>

#include <curve_proximity/separation.hpp>

namespace curve_proximity::yaml {

/** Throws BadUsage naming the file, the place and the line: keys that are not known, numbers below 0, a file without
 *  person.speed, robot.reaction_time or robot.stopping_time. */
Separation readSeparation(const std::string &path);

} // namespace curve_proximity::yaml
#endif
