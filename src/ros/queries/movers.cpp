/* SPDX-License-Identifier: BSD-3-Clause */
#include "queries/movers.h"

#include <algorithm>
#include <cmath>
#include <curve_proximity/nearest_name.hpp>
#include <iterator>

#include "messages/geometry_message.h"
#include "messages/trajectory_message.h"
#include "queries/row_message.h"

namespace curve_proximity {
namespace {

constexpr double NANOSECOND = 1e-9;

/** A message that nobody filled in has zeros everywhere. */
Eigen::Isometry3d poseOf(const geometry_msgs::Pose &pose) {
  const geometry_msgs::Quaternion &q = pose.orientation;
  const geometry_msgs::Point &p = pose.position;
  const bool unset = p.x == 0 && p.y == 0 && p.z == 0 && q.x == 0 && q.y == 0 && q.z == 0 && q.w == 0;
  return unset ? Eigen::Isometry3d::Identity() : toIsometry(pose);
}

MovingRobot toMovingRobot(const RobotTrajectory &message, const FurtherRobots &robots, std::int64_t origin,
                          FrameLookup &lookup) {
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
    adoptBase(robot.srdf.virtual_joints, *robot.alone->robot(), trajectory);
    const std_msgs::Header &header = message.base.header;
    const Eigen::Isometry3d base = lookup.toFixed(header.frame_id, header.stamp) * poseOf(message.base.pose);
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
    out.robots.push_back(toMovingRobot(message, robots, origin, lookup));
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
    : snapshot_(snapshot), has_subject_(subject != nullptr) {
  const std::int64_t origin = originOf(query, *snapshot, has_subject_, stamp);
  const std::vector<MovingObject> objects = movingObjects(*snapshot, origin);
  const std::size_t own = has_subject_ ? snapshot->robot()->links().size() * (points + 2) : 0;
  share_.emplace(bytesOfMovers(objects, own + gather(query, robots, origin, lookup)), most_bytes);
  if (subject) {
    const MovingRobot robot{snapshot->robot()->name(), std::move(subject), 0.0, 0.0};
    checkClocks(robot, robots_, objects);
    robots_.insert(robots_.begin(), robot);
  }
  const std::vector<std::array<std::string, 2>> none;
  movers_ = std::make_shared<const Movers>(snapshot, robots_, objects, none, ResourceOptions(), stop);
}

Surroundings::Surroundings(const SnapshotPtr &snapshot, const ProximityQuery &query, const FurtherRobots &robots,
                           const MovingObject &rides, const ResourceOptions &resources, const ros::Time &stamp,
                           FrameLookup &lookup, std::size_t most_bytes, const Stop &stop)
    : snapshot_(snapshot), rides_(rides.object.id), rides_over_{rides.poses.front().time, rides.poses.back().time} {
  const std::int64_t origin = originOf(query, *snapshot, true, stamp);
  std::vector<MovingObject> objects = movingObjects(*snapshot, origin);
  objects.push_back(rides);
  share_.emplace(bytesOfMovers(objects, gather(query, robots, origin, lookup)), most_bytes);
  const std::vector<std::array<std::string, 2>> none;
  movers_ = std::make_shared<const Movers>(snapshot, robots_, objects, none, resources, stop);
}

/** The further robots; returns how many values they have. */
std::size_t Surroundings::gather(const ProximityQuery &query, const FurtherRobots &robots, std::int64_t origin,
                                 FrameLookup &lookup) {
  GatheredRobots gathered = gatherRobots(query.moving_robots, robots, origin, lookup);
  robots_ = std::move(gathered.robots);
  return gathered.values;
}

/** What the subject is measured against by name: objects that stand, objects and robots that move. */
std::vector<std::string> Surroundings::namesBeside() const {
  std::vector<std::string> out;
  for (const auto &object : snapshot_->objects()) out.push_back(object.first);
  for (const auto &object : snapshot_->moving()) out.push_back(object.first);
  for (std::size_t i = has_subject_ ? 1 : 0; i < robots_.size(); ++i) out.push_back(robots_[i].name);
  return out;
}

void Surroundings::ask(const Query &query, bool against_self, const Asking &asking, Workspace &workspace,
                       MotionRows &out) const {
  if (asking.kind == Asking::GRADIENT && !has_subject_)
    throw Error("gradients among what moves are by a trajectory of the robot: ask about one");
  const Against against = against_self ? Against::BOTH : Against::OTHERS;
  if (!query.per_object) return askOnce(query, against, asking, workspace, out);
  for (const std::string &name : query.objects.empty() ? namesBeside() : query.objects) {
    Query one = query;
    one.per_object = false;
    one.objects = {name};
    askOnce(one, against, asking, workspace, out);
    if (out.answers.back().b.empty()) out.answers.back().b = name; // nothing of it is measured
  }
}

void Surroundings::askOnce(const Query &asked, Against against, const Asking &asking, Workspace &workspace,
                           MotionRows &out) const {
  Query query = asked;
  if (!rides_.empty()) {
    query.links = {rides_};
    if (rides_over_[0] < rides_over_[1] && asking.kind != Asking::PROFILE) query.options.interval = rides_over_.data();
  }
  const MovingRobot *subject = has_subject_ ? &robots_.front() : nullptr;
  const auto plainly = [&](const Query &one) {
    return subject ? curve_proximity::ask(*movers_, *subject, one, workspace)
                   : curve_proximity::ask(*movers_, against, one, workspace);
  };
  if (asking.kind == Asking::ANSWER) out.answers.push_back(plainly(query));
  if (asking.kind == Asking::GRADIENT) {
    ClearanceRow row = clearanceGradient(*movers_, *subject, query, workspace);
    out.gradients.push_back(std::move(row.gradient));
    out.answers.push_back(std::move(row.answer));
  }
  if (asking.kind == Asking::CONTACT)
    out.answers.push_back(subject ? timeOfContact(*movers_, *subject, query, workspace)
                                  : timeOfContact(*movers_, against, query, workspace));
  if (asking.kind == Asking::NEAREST) {
    std::vector<Answer> pairs = subject ? nearestPairs(*movers_, *subject, asking.limits, query, workspace)
                                        : nearestPairs(*movers_, against, asking.limits, query, workspace);
    if (pairs.empty() && !std::isfinite(asking.limits.within)) pairs = {plainly(query)};
    std::move(pairs.begin(), pairs.end(), std::back_inserter(out.answers));
  }
  std::array<double, 2> domain = movers_->domain();
  if (subject && !subject->motion->stands()) domain = subject->motion->domain();
  if (rides_over_[0] < rides_over_[1]) domain = rides_over_;
  if (asking.kind == Asking::VIOLATIONS) {
    const double resolution = resolutionOf(asking, domain[0], domain[1]);
    out.answers.push_back(plainly(query));
    out.violations.push_back(toMessage(subject ? violations(*movers_, *subject, resolution, query, workspace)
                                               : violations(*movers_, against, resolution, query, workspace)));
  }
  if (asking.kind == Asking::PROFILE) {
    const std::vector<double> breaks = breaksOf(asking, domain[0], domain[1]);
    std::vector<std::string> links{""};
    if (asking.per_link && subject) links = query.links.empty() ? movingNames(*subject->motion) : query.links;
    for (const std::string &link : links) {
      Query of_link = query;
      if (!link.empty()) of_link.links = {link};
      out.answers.push_back(plainly(of_link));
      if (out.answers.back().a.empty()) out.answers.back().a = link; // nothing is near it
      out.profiles.push_back(
          toMessage(subject ? clearanceProfile(*movers_, *subject, breaks, of_link, workspace, asking.horizon)
                            : clearanceProfile(*movers_, against, breaks, of_link, workspace, asking.horizon)));
      out.profiles.back().link = link;
    }
  }
}

} // namespace curve_proximity
