/* SPDX-License-Identifier: BSD-3-Clause */
/* A Robot as the core has it: links and geometries by number, joint values as variables. */
#ifndef CURVE_PROXIMITY_SCENE_KINEMATICS_H
#define CURVE_PROXIMITY_SCENE_KINEMATICS_H

#include <map>
#include <memory>
#include <string>
#include <vector>

#include <curve_proximity/cprox.h>
#include <curve_proximity/scene.hpp>
#include <curve_proximity/srdf.hpp>

namespace curve_proximity {

/* One collision element. */
struct MovingGeometry {
  const std::string *link = nullptr; /* its name, the robot's own */
  int part = 0;                      /* its number among the link's */
  double excess = 0.0;               /* [m] how far points of the shape may be outside its body */
  bool by_hull = false;
};

/* Immutable. */
struct Kinematics {
  std::shared_ptr<const Robot> robot; /* owns the bodies */
  std::unique_ptr<cprox_robot, void (*)(cprox_robot *)> core{nullptr, cprox_robot_free};
  std::map<std::string, std::size_t> links;   /* by name: number in the core */
  std::map<std::string, int> variables;       /* joint values by name; mimic joints have none */
  std::map<std::string, std::string> leaders; /* mimic and fixed joints: who decides ("" for fixed) */
  std::vector<double> rest;                   /* of all variables */
  std::vector<MovingGeometry> geometries;
};

/* The robot of the snapshot, its root link at `place` in the fixed frame or on a joint of its own there. Throws Error. */
std::shared_ptr<const Kinematics> makeKinematics(const Snapshot &snapshot, const std::vector<VirtualJoint> &base,
                                                 const std::vector<std::string> &base_joints,
                                                 const Eigen::Isometry3d &place);

} // namespace curve_proximity
#endif
