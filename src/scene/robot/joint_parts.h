/* SPDX-License-Identifier: BSD-3-Clause */
/* The names of the values of joints that have several, as MoveIt composes them: the joint's name, then one of these. */
#ifndef CURVE_PROXIMITY_SCENE_JOINT_PARTS_H
#define CURVE_PROXIMITY_SCENE_JOINT_PARTS_H

namespace curve_proximity {

constexpr const char *PLANAR_PARTS[] = {"/x", "/y", "/theta"};
constexpr const char *FLOATING_PARTS[] = {"/trans_x", "/trans_y", "/trans_z", "/rot_x", "/rot_y", "/rot_z", "/rot_w"};

} // namespace curve_proximity
#endif
