/* SPDX-License-Identifier: BSD-3-Clause */
#include "queries/surroundings.h"

#include <algorithm>
#include <curve_proximity/nearest_name.hpp>

#include "messages/geometry_message.h"
#include "messages/trajectory_message.h"
#include "world/live_scene.h"

namespace curve_proximity {
namespace {

constexpr double NANOSECOND = 1e-9;

/** unknown: as of GatheredRobots, where a joint of this one is. */
MovingRobot toMovingRobot(const RobotTrajectory &message, const FurtherRobots &robots, std::int64_t origin,
                          FrameLookup &lookup, std::string &unknown) {
  try {
    const auto found = robots.find(message.robot);
    if (found == robots.end() && message.robot.empty()) throw Error("this server has no robot of its own");
    if (found == robots.end())
      throw Error("there is no '" + message.robot + "' in ~robots" + didYouMean(message.robot, namesOf(robots)));
    const FurtherRobot &robot = found->second;
    const JointPositions rest = toJointPositions(message.joint_state);
    std::string remark;
    TrajectoryDescription trajectory = toDescription(message.trajectory, rest, remark);
    if (!remark.empty()) throw Error(remark);
    adoptBase(robot.srdf.virtual_joints, *robot.robot, trajectory);
    const std::string untold = unknownJoints(*robot.robot, trajectory.joints, rest, robot.assumed);
    if (!untold.empty()) unknown = "robot '" + message.name + "': " + untold;
    const std_msgs::Header &header = message.base.header;
    const Eigen::Isometry3d base =
        lookup.toFixed(header.frame_id, header.stamp) *
        (isUnset(message.base.pose) ? Eigen::Isometry3d::Identity() : toIsometry(message.base.pose));
    const std::int64_t stamp = static_cast<std::int64_t>(message.trajectory.header.stamp.toNSec());
    MovingRobot out;
    out.name = message.name;
    out.motion = std::make_shared<const RobotMotion>(robot.alone, trajectory, rest, robot.srdf.disabled, base);
    out.start = stamp != 0 ? NANOSECOND * static_cast<double>(stamp - origin) : 0.0;
    out.tolerance = toStartTolerance(message.start_tolerance, message.any_time != 0);
    return out;
  } catch (const Error &error) {
    throw Error("robot '" + message.name + "': " + error.what(), error.status());
  }
}

/** The moment that is time 0: the stamp of the subject, or now; without a subject the earliest stamp. */
std::int64_t originOf(const ProximityQuery &query, const Snapshot &snapshot, bool subject, const ros::Time &stamp) {
  if (subject) return static_cast<std::int64_t>((stamp.isZero() ? ros::Time::now() : stamp).toNSec());
  std::vector<std::int64_t> stamps;
  for (const auto &robot : query.moving_robots)
    stamps.push_back(static_cast<std::int64_t>(robot.trajectory.header.stamp.toNSec()));
  for (const auto &entry : snapshot.moving()) stamps.push_back(entry.second->trajectory.start);
  stamps.erase(std::remove(stamps.begin(), stamps.end(), 0), stamps.end());
  return stamps.empty() ? 0 : *std::min_element(stamps.begin(), stamps.end());
}

} // namespace

/** What the joined motion takes: each variable of an object or robot has a polynomial between any two of its waypoints,
 *  and stands before and after. Any two objects are a pair. */
std::size_t bytesOfMovers(const std::vector<MovingObject> &objects, std::size_t values) {
  constexpr std::size_t POLYNOMIAL = 128, OF_OBJECT = 7;
  std::size_t polynomials = values;
  for (const MovingObject &object : objects) polynomials += OF_OBJECT * (object.poses.size() + 2);
  return polynomials * POLYNOMIAL + objects.size() * objects.size() * sizeof(cprox_robot_pair);
}

GatheredRobots gatherRobots(const std::vector<RobotTrajectory> &messages, const FurtherRobots &robots,
                            std::int64_t origin, FrameLookup &lookup) {
  GatheredRobots out;
  for (const RobotTrajectory &message : messages) {
    out.robots.push_back(toMovingRobot(message, robots, origin, lookup, out.unknown));
    out.values += robots.at(message.robot).robot->links().size() * (message.trajectory.points.size() + 2);
  }
  return out;
}

bool movesBeside(const ProximityQuery &query, const Snapshot &snapshot) {
  return !query.moving_robots.empty() || !snapshot.moving().empty();
}

Surroundings::Surroundings(const SnapshotPtr &snapshot, const ProximityQuery &query, const FurtherRobots &robots,
                           std::shared_ptr<const RobotMotion> subject, const ros::Time &stamp, std::size_t points,
                           FrameLookup &lookup, std::size_t most_bytes, const Stop &stop)
    : has_subject_(subject != nullptr) {
  const std::int64_t origin = originOf(query, *snapshot, has_subject_, stamp);
  const std::vector<MovingObject> objects = movingObjects(*snapshot, origin);
  const std::size_t own = has_subject_ ? snapshot->robot()->links().size() * (points + 2) : 0;
  gathered_ = gatherRobots(query.moving_robots, robots, origin, lookup);
  share_.emplace(bytesOfMovers(objects, own + gathered_.values), most_bytes);
  if (subject) {
    const MovingRobot robot{snapshot->robot()->name(), std::move(subject), 0.0, 0.0};
    checkClocks(robot, gathered_.robots, objects);
    gathered_.robots.insert(gathered_.robots.begin(), robot);
  }
  const std::vector<std::array<std::string, 2>> none;
  movers_ = std::make_shared<const Movers>(snapshot, gathered_.robots, objects, none, ResourceOptions(), stop);
}

Surroundings::Surroundings(const SnapshotPtr &snapshot, const ProximityQuery &query, const FurtherRobots &robots,
                           const MovingObject &rides, const ResourceOptions &resources, const ros::Time &stamp,
                           FrameLookup &lookup, std::size_t most_bytes, const Stop &stop)
    : rides_(rides.object.id), rides_over_{rides.poses.front().time, rides.poses.back().time} {
  const std::int64_t origin = originOf(query, *snapshot, true, stamp);
  std::vector<MovingObject> objects = movingObjects(*snapshot, origin);
  objects.push_back(rides);
  gathered_ = gatherRobots(query.moving_robots, robots, origin, lookup);
  share_.emplace(bytesOfMovers(objects, gathered_.values), most_bytes);
  const std::vector<std::array<std::string, 2>> none;
  movers_ = std::make_shared<const Movers>(snapshot, gathered_.robots, objects, none, resources, stop);
}

MoversSubject Surroundings::subject(bool against_self) const {
  return {*movers_, has_subject_ ? &gathered_.robots.front() : nullptr, against_self ? Against::BOTH : Against::OTHERS,
          rides_, rides_over_};
}

} // namespace curve_proximity
