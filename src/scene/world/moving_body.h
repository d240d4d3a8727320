/* SPDX-License-Identifier: BSD-3-Clause */
/* What the core makes of an object that moves: a robot of one floating link, and its motion. */
#ifndef CURVE_PROXIMITY_SCENE_MOVING_BODY_H
#define CURVE_PROXIMITY_SCENE_MOVING_BODY_H

#include <memory>
#include <vector>

#include <curve_proximity/geometry.hpp>

namespace curve_proximity {

struct MovingBody {
  std::vector<Geometry> geometries; /* own the bodies */
  std::unique_ptr<cprox_robot, void (*)(cprox_robot *)> robot{nullptr, cprox_robot_free};
  std::unique_ptr<cprox_motion, void (*)(cprox_motion *)> motion{nullptr, cprox_motion_free};
};

/* Throws Error, without naming the object: no shapes or poses, a padding that is none, halfspaces, times that do not
 * ascend, orientations half a turn apart. geometries: of the shapes of the object, in their order. */
std::shared_ptr<const MovingBody> makeMovingBody(const ObjectDescription &object, std::vector<Geometry> geometries,
                                                 const std::vector<TimedPose> &poses, Turning turning);

} // namespace curve_proximity
#endif
