/* SPDX-License-Identifier: BSD-3-Clause */
/* A Robot as the core has it: links and geometries by number, joint values as variables. */
#ifndef CURVE_PROXIMITY_SCENE_KINEMATICS_H
#define CURVE_PROXIMITY_SCENE_KINEMATICS_H

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <curve_proximity/cprox.h>
#include <curve_proximity/scene.hpp>
#include <curve_proximity/srdf.hpp>

namespace curve_proximity {

/* One collision element of a link, or one shape of an object that a link carries. */
struct MovingGeometry {
  const std::string *link = nullptr;        /* its name, the robot's own */
  const AttachedObject *attached = nullptr; /* NULL: the link's own */
  int part = 0;                             /* its number among the link's or the object's */
  double excess = 0.0;                      /* [m] how far points of the shape may be outside its body */
  bool is_mesh = false;
  bool is_open = false; /* a mesh that is to be solid and is not closed */
  const cprox_body *body = nullptr;
  bool within = false; /* for pairs within the robot alone: the geometry before it, without the padding of the link */
  std::int32_t unpadded = 0; /* the number of the one that stands for it in such pairs: its own, or the next */

  const std::string &owner() const {
    return attached ? attached->description.id : *link;
  }
};

/* Immutable; lives as long as the snapshot that it was made of, which owns the bodies. */
struct Kinematics {
  std::shared_ptr<const Robot> robot;
  std::unique_ptr<cprox_robot, void (*)(cprox_robot *)> core{nullptr, cprox_robot_free};
  std::map<std::string, std::size_t> links;   /* by name: number in the core */
  std::vector<int> parents;                   /* of each link of the core, its parent's number; -1: the fixed frame */
  std::map<std::string, int> variables;       /* joint values by name; mimic joints have none */
  std::map<std::string, std::string> leaders; /* mimic and fixed joints: who decides ("" for fixed) */
  std::vector<double> rest;                   /* of all variables */
  std::vector<MovingGeometry> geometries;     /* those of padded links twice */
};

/* The robot of the snapshot, its root link at `place` in the fixed frame or on a joint of its own there. Throws Error.
 */
std::shared_ptr<const Kinematics> makeKinematics(const Snapshot &snapshot, const std::vector<VirtualJoint> &base,
                                                 const std::vector<std::string> &base_joints,
                                                 const Eigen::Isometry3d &place);

/* The joints that the motion takes beyond their limits, followers included: a message each. */
std::vector<std::string> beyondLimits(const Kinematics &kinematics, const cprox_motion &motion);

} // namespace curve_proximity
#endif
