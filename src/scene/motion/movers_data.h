/* SPDX-License-Identifier: BSD-3-Clause */
/* What movers are once they are joined into one robot. */
#ifndef CURVE_PROXIMITY_SCENE_MOVERS_DATA_H
#define CURVE_PROXIMITY_SCENE_MOVERS_DATA_H

#include <memory>
#include <string>
#include <vector>

#include <curve_proximity/cprox.h>
#include <curve_proximity/movers.hpp>

#include "world/moving_body.h"

namespace curve_proximity {

/* One geometry of the joined robot. */
struct MoverGeometry {
  std::size_t mover = 0;
  std::string name; /* in answers */
  int part = 0;
  double excess = 0.0;
  bool moves = true; /* along its own motion; of a state true */
  bool is_object = false;
  bool is_mesh = false;
  bool within = false; /* as of MovingGeometry: for pairs within its own robot alone */
};

/* Whose link or object that is: "robot/link" is of "robot". */
inline std::string moverOf(const std::string &name) {
  return name.substr(0, name.find('/'));
}

struct Movers::Data {
  SnapshotPtr snapshot;
  std::vector<std::shared_ptr<const RobotMotion>> robots; /* kept */
  std::vector<std::string> robot_names;
  std::vector<std::shared_ptr<const MovingBody>> objects;
  std::vector<std::string> object_names;
  std::vector<double> object_starts;
  std::unique_ptr<cprox_robot, void (*)(cprox_robot *)> robot{nullptr, cprox_robot_free};
  std::unique_ptr<cprox_motion, void (*)(cprox_motion *)> motion{nullptr, cprox_motion_free};
  std::vector<MoverGeometry> geometries;
  std::vector<cprox_obstacle> obstacles;            /* by item of the snapshot */
  std::vector<cprox_robot_pair> environment, among; /* geometry against obstacle, against geometry */
  std::vector<bool> among_moves;                    /* of each of these: is one moved against the other */
  double rounding = 0.0;                            /* [m] that the core does not know of */
  Coverage coverage;                                /* of the scene, and of all robots with their motions */
};

} // namespace curve_proximity
#endif
