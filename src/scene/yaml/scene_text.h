/* SPDX-License-Identifier: BSD-3-Clause */
/** MoveIt's own text form of a scene (*.scene), as RViz's planning panel and planning_scene::saveGeometryToStream()
 *  write it. */
#ifndef CURVE_PROXIMITY_YAML_SCENE_TEXT_H
#define CURVE_PROXIMITY_YAML_SCENE_TEXT_H

#include <string>

#include "yaml_value.h"

namespace curve_proximity::yaml {

/** Whether the file's name ends in .scene. */
bool isSceneText(const std::string &path);

/** The file as the map that the same scene has in YAML. Throws BadUsage naming the file and the line. Colours are
 *  ignored. */
YamlValue loadSceneText(const std::string &path);

} // namespace curve_proximity::yaml
#endif
