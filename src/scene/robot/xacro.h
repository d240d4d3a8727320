/* SPDX-License-Identifier: BSD-3-Clause */
/** What xacro has left in a URDF or an SRDF. */
#ifndef CURVE_PROXIMITY_SCENE_XACRO_H
#define CURVE_PROXIMITY_SCENE_XACRO_H

#include <string>
#include <vector>

#include <tinyxml2.h>

namespace curve_proximity {

using Words = std::vector<std::string>;

bool isAmong(const std::string &name, const Words &names);

/** Throws Error, with the line, for elements and attributes of xacro, and in the children of these names for values
 * that hold ${…} or $(…). */
void refuseXacro(const tinyxml2::XMLElement &root, const Words &in_use);

} // namespace curve_proximity
#endif
