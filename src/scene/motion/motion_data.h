/* SPDX-License-Identifier: BSD-3-Clause */
/* A robot along a trajectory, made ready: the motion, and the pairs that are asked about. */
#ifndef CURVE_PROXIMITY_SCENE_MOTION_DATA_H
#define CURVE_PROXIMITY_SCENE_MOTION_DATA_H

#include <array>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include <curve_proximity/motion.hpp>

#include "robot/kinematics.h"
#include "world/world.h"

namespace curve_proximity {

/* Two geometries of the robot, and what does not depend on the motion. */
struct SelfPair {
  cprox_robot_pair pair;
  bool carried;          /* one of them is an object that a link carries */
  const char *exemption; /* why they are not measured, whatever moves; "": they are */
};

/* What a robot was prepared with, beside its snapshot. */
struct PreparedWith {
  std::vector<std::array<std::string, 2>> disabled;
  std::vector<VirtualJoint> virtual_joints;
  std::vector<std::string> base_joints;
  Eigen::Isometry3d base;
};

/* What all motions of a robot in a snapshot share. */
struct PreparedRobot::Data {
  PreparedWith with;
  SnapshotPtr snapshot;
  std::shared_ptr<const Kinematics> kinematics;
  std::vector<std::int32_t> link;                         /* of each geometry, its number in the core */
  std::vector<std::vector<cprox_robot_pair>> environment; /* of each geometry, against items of the snapshot's world */
  std::vector<std::vector<std::string>> allowed;          /* of each geometry, the objects that it may touch */
  std::vector<SelfPair> self;                             /* in the order of their first geometries */
};

/* Fills all but snapshot and kinematics; `disabled` are pairs of links. */
void preparePairs(const std::vector<std::array<std::string, 2>> &disabled, PreparedRobot::Data &data);

/* Where the numbers of a trajectory are in the core's motion. */
struct TrajectoryShape {
  std::size_t n_points = 0, n_joints = 0;
  bool has_velocities = false, has_accelerations = false; /* any of the points has them */
  std::vector<double> times;                              /* [s] of the points; of a state 0 and 1 */
  std::vector<std::size_t> column;                        /* of each variable that the motion gives: its joint */
  std::vector<std::int32_t> variable;                     /* the variables that the motion gives */
};

/* A motion, and which geometries are measured against which items or geometries. */
struct RobotMotion::Data {
  std::shared_ptr<const PreparedRobot::Data> prepared;
  SnapshotPtr snapshot;                         /* the prepared robot's */
  std::shared_ptr<const Kinematics> kinematics; /* likewise */
  std::string id;
  std::unique_ptr<cprox_motion, void (*)(cprox_motion *)> core{nullptr, cprox_motion_free};
  TrajectoryShape shape;
  bool stands = false;                /* a state: the robot does not move */
  std::vector<bool> wanted;           /* of each geometry: does the query name its link */
  std::vector<bool> moves;            /* of each geometry: does the motion move it; of a state all */
  std::vector<cprox_robot_pair> self; /* geometry against geometry */
  std::vector<bool> self_moves;       /* of each of these: does the motion move the one against the other */
  std::vector<std::string> warnings;
  Coverage coverage;                   /* of the trajectory, the scene and the robot */
  mutable std::once_flag skipped_once; /* the messages are made when somebody asks for them */
  mutable std::vector<std::string> skipped;
};

/* Numbers by the points of a trajectory, from the core's columns: a row a point, a column a joint. Null: all 0. */
Eigen::MatrixXd toMatrix(const TrajectoryShape &shape, const double *values);

/* The poses of all links at the time t [s]. */
LinkPoses linkPosesOf(const RobotMotion::Data &data, double t);

/* The shape of a geometry, and how far its points may be from its body's core: margin, padding and excess [m]. */
const Geometry &shapeOf(const RobotMotion::Data &data, std::size_t geometry);
double marginOf(const RobotMotion::Data &data, std::size_t geometry);

/* Fills wanted, moves, self and self_moves; `links` are the links wanted (empty: all). */
void choosePairs(const std::vector<std::string> &links, RobotMotion::Data &data);

/* What choosePairs() left out, with the cause, one message each. */
std::vector<std::string> skippedPairs(const RobotMotion::Data &data);

} // namespace curve_proximity
#endif
