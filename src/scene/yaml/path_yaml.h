/* SPDX-License-Identifier: BSD-3-Clause */
/** A nav_msgs/Path as YAML, and the body that rides along one. */
#ifndef CURVE_PROXIMITY_YAML_PATH_YAML_H
#define CURVE_PROXIMITY_YAML_PATH_YAML_H

#include <cstdint>
#include <string>
#include <vector>

#include <curve_proximity/description.hpp>

#include "yaml_value.h"

namespace curve_proximity::yaml {

/** The poses of a path, at the times of their stamps: the first one's is 0. */
struct PathFile {
  std::string frame;
  std::int64_t origin = 0; /**< [ns] the stamp of time 0; 0: none */
  std::vector<TimedPose> poses;
  std::string remark; /**< what a reader should know of the times; empty: nothing */
};

/** Reads a path, as rostopic prints one, a geometry_msgs/PoseArray likewise, or the lines of readPathText().
 *
 *  turns: else orientations are not looked at, and all poses are upright. Throws BadUsage naming the file and the
 *   place: no poses, one that is no pose, or in another frame than the path's. */
PathFile readPath(const std::string &path, bool turns, Warnings &warnings);

/** A body in the words of an object of a scene file; without shapes it names one that a link carries. Its pose is in
 *  the frame of each pose of a path. Throws BadInput. */
ObjectDescription readRider(const YamlValue &value, Warnings &warnings);

} // namespace curve_proximity::yaml
#endif
