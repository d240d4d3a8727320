/* SPDX-License-Identifier: BSD-3-Clause */
/** Files of points: PCD, PLY, XYZ. */
#ifndef CURVE_PROXIMITY_YAML_CLOUD_FILE_H
#define CURVE_PROXIMITY_YAML_CLOUD_FILE_H

#include <string>

#include <curve_proximity/description.hpp>

namespace curve_proximity::yaml {

/** The points of a file, a column each: PCD (ascii, binary), PLY (the vertices; ascii, little-endian), or XYZ, three or
 *  more numbers a line. Points of which a coordinate is NaN are no measurement and left out, as sensors write them.
 *  Throws BadInput that names the file: another format, numbers that are none or infinite, a file that ends too early,
 *  no point. Cost: the file's size in memory twice. */
Eigen::Matrix3Xd readCloud(const std::string &path);

/** Reads the files of an object's points, relative to a folder: `resource` becomes `vertices`. Throws BadInput. */
void readClouds(ObjectDescription &object, const std::string &folder);

} // namespace curve_proximity::yaml
#endif
