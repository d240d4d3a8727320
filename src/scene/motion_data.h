/* SPDX-License-Identifier: BSD-3-Clause */
/* A robot along a trajectory, made ready: the motion, and the pairs that are asked about. */
#ifndef CURVE_PROXIMITY_SCENE_MOTION_DATA_H
#define CURVE_PROXIMITY_SCENE_MOTION_DATA_H

#include <array>
#include <memory>
#include <string>
#include <vector>

#include <curve_proximity/motion.hpp>

#include "kinematics.h"
#include "world.h"

namespace curve_proximity {

/* Which geometries are asked about against which items or geometries. */
struct RobotMotion::Data {
  SnapshotPtr snapshot;
  std::string id;
  std::shared_ptr<const Kinematics> kinematics;
  std::unique_ptr<cprox_motion, void (*)(cprox_motion *)> core{nullptr, cprox_motion_free};
  bool stands = false;                       /* one waypoint: the robot does not move */
  std::vector<cprox_robot_pair> self;        /* geometry against geometry */
  std::vector<cprox_robot_pair> environment; /* geometry against item of the snapshot's world */
  std::vector<std::string> skipped, warnings;
};

/* Fills self, environment and skipped; `disabled` are pairs of links, `only` the links wanted (empty: all). */
void choosePairs(const std::vector<std::array<std::string, 2>> &disabled, const std::vector<std::string> &only,
                 RobotMotion::Data &data);

} // namespace curve_proximity
#endif
