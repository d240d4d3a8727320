/* SPDX-License-Identifier: BSD-3-Clause */
/* MoveIt's model, world, states and trajectories in the scene library's terms. */
#ifndef CURVE_PROXIMITY_MOVEIT_MOVEIT_SCENE_H
#define CURVE_PROXIMITY_MOVEIT_MOVEIT_SCENE_H

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include <moveit/collision_detection/collision_matrix.h>
#include <moveit/collision_detection/world.h>
#include <moveit/robot_state/robot_state.h>
#include <moveit/robot_trajectory/robot_trajectory.h>

#include <curve_proximity/motion.hpp>
#include <curve_proximity/near_pairs.hpp>

namespace curve_proximity {

/* The model with the shapes that MoveIt has loaded: no file is read again. */
std::shared_ptr<const Robot> toRobot(const moveit::core::RobotModel &model);

/* Its links in the order of Robot::links(). */
std::vector<const moveit::core::LinkModel *> linksInOrder(const Robot &robot, const moveit::core::RobotModel &model);

/* Its root joint where that moves: no or one virtual joint. */
std::vector<VirtualJoint> virtualJoints(const moveit::core::RobotModel &model);

/* Where the root link is in a state: on the root joint. */
Eigen::Isometry3d baseAt(const moveit::core::RobotState &state);

/* Meshes and octrees of MoveIt, taken over once for as long as MoveIt keeps them. Any number of threads. */
class KnownShapes {
 public:
  /* The shape at a pose. A mesh that is known is the one that was passed before; an octree too, unless its cells have
   * changed since. Throws Error for a shape that has no counterpart. */
  ShapeDescription at(const shapes::ShapeConstPtr &shape, const Eigen::Isometry3d &pose);

 private:
  struct Known {
    std::weak_ptr<const shapes::Shape> shape;
    std::uint64_t cells = 0; /* cellsOf() of an octree */
    ShapeDescription description;
  };
  std::mutex mutex_; /* of all that follows */
  std::map<const shapes::Shape *, Known> known_;
  std::size_t most_ = 16; /* known_ is searched for shapes that MoveIt has given up when it is as large */
};

/* A hash of an octree's cells and of which of them are occupied; 0: the shape is no octree. MoveIt's monitor changes
 * octrees in place and does not tell. */
std::uint64_t cellsOf(const shapes::Shape &shape);

/* The same of all octrees of an object. */
std::uint64_t cellsOf(const collision_detection::World::Object &object);

/* An object of the world with its shapes. Throws Error. */
ObjectDescription toObject(const collision_detection::World::Object &object, KnownShapes &shapes);

/* Does the matrix always let them touch? A conditional entry does not. */
bool alwaysAllowed(const collision_detection::AllowedCollisionMatrix &matrix, const std::string &a,
                   const std::string &b);

/* The entries of the matrix about links with geometry and attached objects, and the defaults of these and of the
 * scene's objects: how many objects there are beyond those that the matrix names costs little. */
std::vector<AllowedPair> allowedPairs(const collision_detection::AllowedCollisionMatrix &matrix, const Snapshot &scene,
                                      const AttachedObjects &attached);

/* What states attach: the last ways in which objects were attached are kept. Not for several threads. */
class AttachedBodies {
 public:
  /* Throws Error for a shape that has no counterpart. */
  AttachedObjects of(const moveit::core::RobotState &state, const Snapshot &scene, KnownShapes &shapes);

 private:
  struct Known {
    std::string id, link;
    std::set<std::string> touch_links;
    std::vector<shapes::ShapeConstPtr> shapes;
    EigenSTL::vector_Isometry3d poses;
    double scale;
    std::uint64_t cells; /* of the octrees among the shapes */
    std::shared_ptr<const AttachedObject> object;
  };
  std::vector<Known> known_; /* the latest last */
};

/* The values of all joints of a state that have values of their own. */
JointPositions jointPositions(const moveit::core::RobotState &state);

/* The straight motion from one state to another, from time 0 to 1: as RobotState::interpolate(), the shorter way round
 * for joints without limits. Throws Error where MoveIt's interpolation is another curve (a differential drive). */
TrajectoryDescription straight(const moveit::core::RobotState &from, const moveit::core::RobotState &to);

/* A timed trajectory as a controller executes it: cubic where all waypoints have velocities, quintic where they have
 * accelerations too. Joints without limits go the shorter way from waypoint to waypoint. Throws Error. */
TrajectoryDescription timed(const robot_trajectory::RobotTrajectory &trajectory);

/* The same path up to the time `end` [s], without times. */
robot_trajectory::RobotTrajectoryPtr upTo(const robot_trajectory::RobotTrajectory &trajectory, double end);

} // namespace curve_proximity
#endif
