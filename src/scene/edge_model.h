/* SPDX-License-Identifier: BSD-3-Clause */
/* The core's handle for edges of a robot in a scene, for all pairs that an edge of some joints can have. */
#ifndef CURVE_PROXIMITY_SCENE_EDGE_MODEL_H
#define CURVE_PROXIMITY_SCENE_EDGE_MODEL_H

#include <memory>
#include <string>
#include <vector>

#include "asked_pairs.h"

namespace curve_proximity {

struct EdgeModel {
  EdgeModel(const PreparedRobot &robot, const std::vector<std::string> &joints, const JointPositions &rest,
            RobotPairs against, const Query &query);

  struct Found {
    cprox_verdict verdict;
    bool all_move; /* each joint ends elsewhere than it begins */
  };
  /* A value for each joint. */
  Found ask(const double *from, const double *to, Workspace &workspace) const;

  RobotMotion motion; /* of all joints */
  Asked asked;
  std::vector<double> rest; /* of all variables of the core's robot */
  cprox_options options;
  ObstaclesHandle obstacles;
  using Handle = std::unique_ptr<cprox_edge_checker, void (*)(cprox_edge_checker *)>;
  Handle clears{nullptr, cprox_edge_checker_free};   /* what it says is clear is, whatever was rounded; */
  Handle violates{nullptr, cprox_edge_checker_free}; /* what it says is violated is; NULL: the same one */
};

} // namespace curve_proximity
#endif
