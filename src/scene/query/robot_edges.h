/* SPDX-License-Identifier: BSD-3-Clause */
/* The core's handle for edges of a robot in a scene, for all pairs that an edge of some joints can have. */
#ifndef CURVE_PROXIMITY_SCENE_ROBOT_EDGES_H
#define CURVE_PROXIMITY_SCENE_ROBOT_EDGES_H

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "asked_pairs.h"

namespace curve_proximity {

struct RobotEdges {
  RobotEdges(const PreparedRobot &robot, const std::vector<std::string> &joints, const JointPositions &rest,
             RobotPairs against, const Query &query);

  /* Rows of all variables: of n edges where they begin, then where they end. */
  std::vector<double> rowsFor(std::size_t n) const;
  /* A value for each joint into such a row. */
  void fill(const double *joints, double *row) const;
  /* Whether each joint ends elsewhere than it begins. */
  bool allMove(const double *from, const double *to) const;
  /* The verdicts of the first n edges of such rows; what is refused is undecided. */
  void ask(const std::vector<double> &rows, std::size_t n, std::uint8_t *verdicts, Workspace &workspace) const;

  RobotMotion motion; /* of all joints */
  Asked asked;
  std::vector<double> rest; /* of all variables of the core's robot */
  cprox_options options;
  ObstaclesHandle obstacles;
  std::unique_ptr<cprox_edge_checker, void (*)(cprox_edge_checker *)> checker{nullptr, cprox_edge_checker_free};
};

} // namespace curve_proximity
#endif
