/* SPDX-License-Identifier: BSD-3-Clause */
/** Paths as lines of numbers: TUM's and EuRoC's. */
#ifndef CURVE_PROXIMITY_YAML_PATH_TEXT_H
#define CURVE_PROXIMITY_YAML_PATH_TEXT_H

#include <string>

#include "path_yaml.h"

namespace curve_proximity::yaml {

/** True for names that end in .txt, .tum or .csv. */
bool isPathText(const std::string &path);

/** Reads a pose a line: `stamp x y z qx qy qz qw` with blanks, the stamp in seconds (TUM), or `stamp, x, y, z, qw, qx,
 *  qy, qz` with commas, the stamp in nanoseconds (EuRoC); nine more numbers of EuRoC, velocities and biases, are not
 *  looked at. Lines that begin with # are skipped. The frame is the fixed one. turns: as of readPath(). Throws BadInput
 *  naming the line. */
PathFile readPathText(const std::string &path, bool turns, Warnings &warnings);

} // namespace curve_proximity::yaml
#endif
