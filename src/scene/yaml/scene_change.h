/* SPDX-License-Identifier: BSD-3-Clause */
/** From a scene file to what a live scene is told: the way of `cprox send` and of ~scene_file. */
#ifndef CURVE_PROXIMITY_YAML_SCENE_CHANGE_H
#define CURVE_PROXIMITY_YAML_SCENE_CHANGE_H

#include <string>

#include "scene_yaml.h"

namespace curve_proximity::yaml {

/** The folder that a file lies in. */
std::string folderOf(const std::string &path);

/** The file at `path` as a change. Frames that the file itself explains are resolved; others stay in object.frame, for
 * tf2 to resolve. Mesh files get absolute paths. A file that is no diff (is_diff) replaces the scene: the change clears
 * it. Throws BadUsage naming file and object where the file's frames go in a ring. */
SceneChange toChange(const SceneFile &file, const std::string &path, Warnings &warnings);

} // namespace curve_proximity::yaml
#endif
