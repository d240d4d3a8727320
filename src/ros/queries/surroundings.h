/* SPDX-License-Identifier: BSD-3-Clause */
/** What moves beside a robot: objects of the scene and further robots of a request, on one clock. */
#ifndef CURVE_PROXIMITY_ROS_SURROUNDINGS_H
#define CURVE_PROXIMITY_ROS_SURROUNDINGS_H

#include <curve_proximity/ProximityQuery.h>
#include <ros/time.h>

#include <curve_proximity/movers.hpp>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "../scene/query/subject.h"
#include "transport/memory_account.h"
#include "world/frames.h"
#include "world/robot_description.h"

namespace curve_proximity {

/** Robots by the name that requests give them. */
using FurtherRobots = std::map<std::string, FurtherRobot>;

/** Does anything move beside the robot that is asked about? */
bool movesBeside(const ProximityQuery &query, const Snapshot &snapshot);

/** Further robots that move, and how many variables they have at all of their waypoints. */
struct GatheredRobots {
  std::vector<MovingRobot> robots;
  std::size_t values = 0;
  std::string unknown; /**< which joints of one of them nobody told, as a message; "": of none */
};

/** The robots of a request. origin: [ns] the moment that is time 0. Throws Error, which names the robot. */
GatheredRobots gatherRobots(const std::vector<RobotTrajectory> &messages, const FurtherRobots &robots,
                            std::int64_t origin, FrameLookup &lookup);

/** What Movers of these take. values: of all robots. */
std::size_t bytesOfMovers(const std::vector<MovingObject> &objects, std::size_t values);

/** Robots and objects on one clock, and how they are asked about. */
class Surroundings {
 public:
  /** rides: a body that moves beside all of these, and is asked about alone; resources: of its shapes. Else as below,
   * without a subject. */
  Surroundings(const SnapshotPtr &snapshot, const ProximityQuery &query, const FurtherRobots &robots,
               const MovingObject &rides, const ResourceOptions &resources, const ros::Time &stamp, FrameLookup &lookup,
               std::size_t most_bytes, const Stop &stop);

  /** subject: the robot that is asked about, with its stamp and the number of its points; null: nobody. most_bytes:
   * what the joined motion may take. stop: asked while it is made, ends that. Throws Error, which names the mover: a
   * robot that is not known, what RobotMotion and Movers refuse, a trajectory that is stale or in the future; and where
   * it would take more memory. */
  Surroundings(const SnapshotPtr &snapshot, const ProximityQuery &query, const FurtherRobots &robots,
               std::shared_ptr<const RobotMotion> subject, const ros::Time &stamp, std::size_t points,
               FrameLookup &lookup, std::size_t most_bytes, const Stop &stop);

  /** The subject, else all that moves; against_self: each robot against itself, too. Kept by reference. */
  MoversSubject subject(bool against_self) const;

  const std::shared_ptr<const Movers> &movers() const {
    return movers_;
  }
  const std::vector<MovingRobot> &robots() const {
    return gathered_.robots;
  }
  /** As of GatheredRobots. */
  const std::string &unknown() const {
    return gathered_.unknown;
  }

 private:
  bool has_subject_ = false;
  std::string rides_;                  /* the body that is asked about; else empty */
  std::array<double, 2> rides_over_{}; /* [s] from when to when */
  std::optional<memory::Share> share_;
  GatheredRobots gathered_; /* the subject first */
  std::shared_ptr<const Movers> movers_;
};

} // namespace curve_proximity
#endif
