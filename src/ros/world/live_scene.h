/* SPDX-License-Identifier: BSD-3-Clause */
/** The scene with all that is known about it while a server runs: its epoch, its sensors, the joints of its robot. */
#ifndef CURVE_PROXIMITY_ROS_LIVE_SCENE_H
#define CURVE_PROXIMITY_ROS_LIVE_SCENE_H

#include <curve_proximity/SceneState.h>
#include <ros/time.h>

#include <array>
#include <curve_proximity/scene.hpp>
#include <curve_proximity/srdf.hpp>
#include <string>
#include <vector>

#include "world/frames.h"
#include "world/joint_board.h"
#include "world/sensor_board.h"
#include "world/unknowns.h"

namespace curve_proximity {

/** What the services, the topics and the sensors share. */
struct LiveScene {
  LiveScene(std::shared_ptr<const Robot> robot, const Srdf &given, const ResourceOptions &resources)
      : srdf(given), scene(std::move(robot), resources, allowedPairs(given)) {
    const ros::WallTime now = ros::WallTime::now();
    epoch = ros::Time(now.sec, now.nsec);
  }

  const Srdf srdf;
  Scene scene;
  SensorBoard sensors;
  JointBoard joints;
  ros::Time epoch; /**< when the server started */
  Unknowns unknowns;

  /** What is known at one moment. The states of sensors are those of the snapshot's objects. */
  struct Seen {
    std::vector<Unknown> unknowns;
    std::vector<SensorState> sensors;
    SnapshotPtr snapshot;
  };
  Seen seen() const;

  /** Applies a change that comes from no sensor, and notes what it does to objects of sensors and to what was refused.
   *  before: the scene that the change was made for. Returns what Scene::apply() returns. */
  std::vector<std::string> apply(const SceneChange &change, const Snapshot &before);

  /** Applies a change by which an object becomes as a sensor's message of this stamp shows it. Throws Error where it
   *  cannot be applied; then it is as old as before. */
  void applySeen(const SceneChange &change, const std::string &id, const ros::Time &stamp);

  /** An object came by a topic and could not be used. about: the object, or "" for what the robot carries. Of more than
   *  1000 such objects, or of ids that no object can have, one message for all is kept. */
  void refuse(const std::string &topic, const std::string &id, const std::string &about, const std::string &why,
              std::size_t most_name);

  /** The pairs of links that are not checked against each other, beside the allowed pairs of the snapshot. */
  const std::vector<std::array<std::string, 2>> &disabled(const Snapshot &snapshot) const;

  /** The scene of a snapshot, with sensors as they were when it was taken; what was measured and the ages of joints and
   *  transforms are left open. */
  SceneState state(const Snapshot &snapshot, std::vector<SensorState> seen) const;
  SceneState state() const; /**< of the latest snapshot */

  /** Throws Error where the snapshot is not the one that is meant. 0: any. */
  void demand(const Snapshot &snapshot, const ros::Time &epoch_wanted, std::uint64_t version_wanted) const;
};

/** Sources of LiveScene::unknowns. */
constexpr const char *LOST_SCENE = "lost scene"; /**< of the server before this one, until a whole scene is sent */
constexpr const char *AWAITED_SCENE = "awaited scene"; /**< ~ask_planning_scene, until one comes */
constexpr const char *REFUSED_OBJECT = "object ";      /**< and its id: it came by topic and could not be used */
constexpr const char *REFUSED_OBJECTS = "objects";     /**< … those that are too many to be kept one by one */

/** Where the root link stands in the fixed frame: by tf2, or where tf2 knows nothing by a fixed virtual joint. Throws
 *  Error where neither does. */
Eigen::Isometry3d rootPose(const Robot &robot, const Srdf &srdf, const ros::Time &stamp, FrameLookup &lookup);

/** Positions of joints, and how old the oldest of those is that ~joint_states told. */
struct CurrentJoints {
  JointPositions positions;
  double age = std::numeric_limits<double>::quiet_NaN(); /**< [s]; NaN: none of them was told */
};

/** `given`, and where `current` is set the latest values of the others. Throws Error where there are none and
 *  `may_be_none` is not set, and for what toJointPositions() refuses. */
CurrentJoints currentJoints(const sensor_msgs::JointState &given, bool current, const JointBoard &board,
                            bool may_be_none = false);

/** A message about the joints of a robot of which neither `moved` nor `positions` nor `assumed` tells; "": there is
 *  none. link: of those alone that move it; "": of all. Mimic joints follow; a planar or floating joint is known by all
 *  of its variables. */
std::string unknownJoints(const Robot &robot, const std::vector<std::string> &moved, const JointPositions &positions,
                          const std::vector<std::string> &assumed, const std::string &link = "");

} // namespace curve_proximity
#endif
