/* SPDX-License-Identifier: BSD-3-Clause */
#include "constraints/constraints.h"

#include <ros/console.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "messages/curve_message.h"
#include "messages/geometry_message.h"
#include "messages/gradient_message.h"
#include "messages/scene_message.h"
#include "messages/trajectory_message.h"
#include "queries/row_message.h"
#include "transport/memory_account.h"
#include "transport/request_limits.h"
#include "transport/turns.h"
#include "world/doubts.h"
#include "world/robot_description.h"

namespace curve_proximity {
namespace {

constexpr double NONE = std::numeric_limits<double>::quiet_NaN();

/* ---- from messages ---- */

bool hasShapes(const CollisionObject &side) {
  return !side.primitives.empty() || !side.meshes.empty() || !side.planes.empty() || !side.bodies.empty();
}

/** A side as described, or the scene's object of that id; its pose in the fixed frame, unless it rides a curve. */
ObjectDescription toSide(const CollisionObject &message, const Snapshot &snapshot, FrameLookup &lookup, bool rides,
                         const LinkPlaces &places, std::optional<ResourceOptions> &resources) {
  ObjectDescription side;
  if (!message.trajectory.waypoints.empty()) throw Error("a side of a constraint takes no trajectory of its own");
  if (snapshot.moving().count(message.id) > 0 && !hasShapes(message))
    throw Error("object '" + message.id + "' moves along a trajectory, and constraints take objects that stand");
  if (hasShapes(message)) {
    CollisionObject object = message;
    object.operation = CollisionObject::ADD;
    side = toOperation(object).object;
  } else if (!message.id.empty()) {
    ConstraintSide found = sideOf(snapshot, message.id, places);
    side = std::move(found.object);
    resources = std::move(found.resources);
    if (found.is_on_robot && !isUnset(message.pose))
      throw Error("'" + message.id + "' is on the robot: its joint values say where it is, leave its pose unset");
    if (rides) side.pose = Eigen::Isometry3d::Identity();
    if (isUnset(message.pose)) return side;
    side.pose = toIsometry(message.pose);
  } else if (!isUnset(message.pose)) {
    side.pose = toIsometry(message.pose);
  }
  if (!rides) side.pose = lookup.toFixed(message.header.frame_id, message.header.stamp) * side.pose;
  return side;
}

bool hasTrajectory(const ConstraintQuery &message) {
  return !message.trajectory.joint_names.empty() || !message.trajectory.points.empty();
}

/** A piecewise curve has no points of its own. */
bool isSet(const Curve &curve) {
  return !curve.points.empty() || !curve.pieces.empty();
}

bool isNamed(const CollisionObject &side) {
  return hasShapes(side) || !side.id.empty();
}

/* ---- to messages ---- */

geometry_msgs::Twist toTwistMessage(const ConstraintGradient &gradient) {
  return curve_proximity::toTwistMessage(gradient.linear, gradient.angular);
}

/** What all rows of a result share: the points and the normal. */
template <class Message>
void fillWitness(const ConstraintValue &value, bool answered, Message &message) {
  const Eigen::Vector3d nothing = Eigen::Vector3d::Constant(NONE);
  const bool points = answered && value.has_points;
  message.witness_a = toPointMessage(toVec3(points ? value.witness_a : nothing));
  message.witness_b = toPointMessage(toVec3(points ? value.witness_b : nothing));
  message.normal = toVectorMessage(points ? value.normal : nothing);
}

TrajectoryConstraint constraintMessage(const MotionRow &row) {
  TrajectoryConstraint message;
  message.kind = row.kind;
  message.a = row.side_a;
  message.b = row.side_b;
  message.value = row.value;
  message.lower = row.bounded ? row.lower : NONE;
  message.upper = row.bounded ? row.upper : NONE;
  message.t0 = row.t0;
  message.t1 = row.t1;
  message.t = row.t;
  message.valid = row.valid;
  message.message = row.reason;
  message.gradient_positions = toList(row.positions);
  message.gradient_velocities = toList(row.velocities);
  message.gradient_accelerations = toList(row.accelerations);
  message.gradient_duration = row.duration;
  message.gradient_start = row.start;
  message.gradient_a = toTwistMessage(row.a);
  message.gradient_b = toTwistMessage(row.b);
  fillWitness(row, true, message);
  return message;
}

ConstraintResult constraintMessage(const ConstraintRow &row, const ConstraintCase &asked) {
  ConstraintResult message;
  message.id = row.id;
  message.provider = row.provider;
  message.status = statusName(row);
  message.message = row.message;

  // What has no value has no numbers.
  const Eigen::Vector3d nothing = Eigen::Vector3d::Constant(NONE);
  const bool answered = row.status >= 0;
  const ConstraintValue &value = row.value;
  const ConstraintGradient none{nothing, nothing};
  message.value = answered ? value.value : NONE;
  message.lower = answered && value.bounded ? value.lower : NONE;
  message.upper = answered && value.bounded ? value.upper : NONE;
  message.touching_least = answered && value.penalty ? value.touching_least : NONE;
  message.touching_most = answered && value.penalty ? value.touching_most : NONE;
  message.valid = answered && value.valid;
  message.gradient_a = toTwistMessage(answered ? value.a : none);
  message.gradient_b = toTwistMessage(answered ? value.b : none);
  for (Eigen::Index i = 0; answered && i < value.points.cols(); ++i)
    message.gradient_points.push_back(toVectorMessage(value.points.col(i)));
  if (answered)
    message.gradient_parameters.assign(value.parameters.data(), value.parameters.data() + value.parameters.size());
  message.gradient_radius = answered ? value.radius : NONE;
  message.gradient_range = {answered ? value.range_start : NONE, answered ? value.range_end : NONE};
  message.t = answered ? value.t : NONE;
  fillWitness(value, answered, message);
  if (answered && row.motion) {
    const TrajectoryDescription &trajectory = asked.motion->trajectory;
    message.joints = trajectory.joints;
    for (const TrajectoryPoint &point : trajectory.points) message.times.push_back(point.time);
    for (const MotionRow &one : row.motion->rows) message.rows.push_back(constraintMessage(one));
  }
  message.microseconds = answered ? row.microseconds : NONE;
  return message;
}

/** By the points of a trajectory, in all rows. */
std::size_t countDerivatives(const ConstraintRow &row) {
  Eigen::Index count = 0;
  if (row.motion)
    for (const MotionRow &one : row.motion->rows)
      count += one.positions.size() + one.velocities.size() + one.accelerations.size();
  return static_cast<std::size_t>(count);
}

} // namespace

Constraints::Constraints(const Parameters &parameters, const LiveScene &live, const Frames &frames,
                         const FurtherRobots &robots)
    : parameters_(parameters), live_(live), frames_(frames), robots_(robots) {
  try {
    providers_ = std::make_unique<ProviderSet>(parameters.constraint_providers);
  } catch (const ProviderError &error) {
    throw ParameterError("parameter ~constraint_providers[" + std::to_string(error.place()) + "] ('" +
                         parameters.constraint_providers[error.place()].name + "'): " + error.what());
  }
  for (const std::string &failure : failures()) ROS_ERROR("%s", failure.c_str());
}

std::vector<std::string> Constraints::failures() const {
  std::vector<std::string> messages;
  for (const LoadedProvider &loaded : providers_->all())
    if (!loaded.provider)
      messages.push_back("constraint provider '" + loaded.spec.name + "' (" + loaded.spec.type +
                         ") failed to load: " + loaded.failure);
  return messages;
}

/** Throws Error for what is beyond a limit; how many bytes the largest case takes, about. */
std::size_t Constraints::checkLimits(const EvaluateConstraints::Request &request) const {
  demandAtMost("max_curves", parameters_.max_curves, request.cases.size(), "cases");
  NameLimits(parameters_.max_name_length).check(request);
  std::size_t points = 0, values = 0, results = 0, bytes = 0;
  for (const ConstraintQuery &asked : request.cases) {
    const std::size_t points_before = points, values_before = values;
    points += asked.curve.points.size();
    values += asked.trajectory.points.size() * asked.trajectory.joint_names.size();
    for (const RobotTrajectory &robot : asked.moving_robots)
      values += robot.trajectory.points.size() * robot.trajectory.joint_names.size();
    bytes = std::max(bytes, (points - points_before) * memory::OF_POINT + (values - values_before) * memory::OF_VALUE);
    results += asked.providers.empty() ? providers_->all().size() : asked.providers.size();
  }
  demandAtMost("max_control_points", parameters_.max_control_points, points, "control points");
  demandAtMost("max_control_points", parameters_.max_control_points, values, "joint values");
  demandAtMost("max_results", parameters_.max_results, results, "results");
  return bytes;
}

/* A request on its way. */
struct Constraints::Work {
  const SnapshotPtr snapshot;
  TimeBudget budget;
  FrameLookup lookup;
  std::size_t derivatives = 0; /* of all rows so far */
  CurrentJoints joints = {};   /* of the case at hand */
  std::string unknown = {};    /* which of them nobody told, as a message */

  /* The robot made ready last, for trajectories that begin at the same base. */
  std::shared_ptr<const PreparedRobot> robot = nullptr;
  Eigen::Isometry3d base = Eigen::Isometry3d::Identity();

  /* What the movers of the case at hand take. */
  std::optional<memory::Share> share = std::nullopt;
};

MotionCase Constraints::toMotionCase(const ConstraintQuery &message, Work &work) const {
  if (!work.snapshot->robot()) throw Error("a trajectory needs a robot, and this server has none");
  if (isNamed(message.a) || isNamed(message.b) || isSet(message.curve))
    throw Error("a case is about a trajectory or about two sides: give one of them");
  MotionCase out;
  work.joints = currentJoints(message.joint_state, message.current_joints, live_.joints);
  std::string remark;
  out.trajectory = toDescription(message.trajectory, work.joints.positions, remark);
  out.trajectory.id = message.id;
  out.rest = work.joints.positions;
  checkTrajectory(out.trajectory);

  // Where the robot stands, or the frame that its virtual joint moves in.
  adoptBase(live_.srdf.virtual_joints, *work.snapshot->robot(), out.trajectory);
  work.unknown =
      unknownJoints(*work.snapshot->robot(), out.trajectory.joints, work.joints.positions, parameters_.assumed_joints);
  const bool on_joint = !out.trajectory.base.empty();
  const ros::Time &stamp = message.trajectory.header.stamp;
  const Eigen::Isometry3d base = on_joint ? work.lookup.toFixed(out.trajectory.base.front().parent_frame, stamp)
                                          : rootPose(*work.snapshot->robot(), live_.srdf, stamp, work.lookup);
  if (on_joint || !work.robot || work.base.matrix() != base.matrix()) {
    out.robot = std::make_shared<const PreparedRobot>(work.snapshot, live_.disabled(*work.snapshot),
                                                      out.trajectory.base, out.trajectory.base_joints, base);
    work.base = base;
    work.robot = on_joint ? nullptr : out.robot;
  } else {
    out.robot = work.robot;
  }
  gatherOthers(message, out, work);
  return out;
}

/* What moves beside the robot. */
void Constraints::gatherOthers(const ConstraintQuery &message, MotionCase &out, Work &work) const {
  const ros::Time &stamp = message.trajectory.header.stamp;
  out.origin = static_cast<std::int64_t>((stamp.isZero() ? ros::Time::now() : stamp).toNSec());
  GatheredRobots others = gatherRobots(message.moving_robots, robots_, out.origin, work.lookup);
  out.other_robots = std::move(others.robots);
  if (work.unknown.empty()) work.unknown = others.unknown;
  if (!out.isAmongMovers()) return;
  const std::size_t own = work.snapshot->robot()->links().size() * (out.trajectory.points.size() + 2);
  work.share.emplace(bytesOfMovers(movingObjects(*work.snapshot, out.origin), own + others.values),
                     static_cast<std::size_t>(parameters_.max_request_mb) << 20);
}

Eigen::Isometry3d Constraints::linkPose(const ConstraintQuery &message, const std::string &link, LinkPoses &poses,
                                        Work &work) const {
  if (message.joint_state.name.empty() && !message.current_joints) return work.lookup.toFixed(link, ros::Time());
  const Robot &robot = *work.snapshot->robot();
  if (poses.empty()) {
    work.joints = currentJoints(message.joint_state, message.current_joints, live_.joints);
    poses = robot.linkPoses(work.joints.positions, rootPose(robot, live_.srdf, ros::Time(), work.lookup));
  }
  const std::string unknown = unknownJoints(robot, {}, work.joints.positions, parameters_.assumed_joints, link);
  if (!unknown.empty()) work.unknown = unknown;
  return poses.at(link);
}

ConstraintCase Constraints::toCase(const ConstraintQuery &message, Work &work) const {
  ConstraintCase out;
  out.id = message.id;
  out.providers = message.providers;
  out.stop = TimeBudget::isOver;
  out.stop_user = &work.budget;
  if (hasTrajectory(message)) {
    out.motion = toMotionCase(message, work);
    return out;
  }
  if (!message.moving_robots.empty()) throw Error("moving_robots move beside a trajectory, and there is none");
  const bool rides = isSet(message.curve);
  LinkPoses poses; /* by joint values; without any tf2 knows */
  const LinkPlaces places = [&](const std::string &link) { return linkPose(message, link, poses, work); };
  out.a = toSide(message.a, *work.snapshot, work.lookup, rides, places, out.resources_a);
  out.b = toSide(message.b, *work.snapshot, work.lookup, false, places, out.resources_b);
  if (poses.empty() && (!message.joint_state.name.empty() || message.current_joints))
    throw Error("joint_state and current_joints are about a trajectory or a link, and there is neither");
  if (rides) {
    const std_msgs::Header &header = message.curve.header;
    out.curve = toDescription(message.curve, work.lookup.toFixed(header.frame_id, header.stamp));
  }
  return out;
}

void Constraints::answer(const EvaluateConstraints::Request &request, EvaluateConstraints::Response &response,
                         const TimeBudget &budget, Turn *turn) {
  if (providers_->all().empty()) throw Error("~constraint_providers names none");
  const memory::Share share(checkLimits(request), static_cast<std::size_t>(parameters_.max_request_mb) << 20);
  LiveScene::Seen seen = live_.seen();
  const SnapshotPtr snapshot = seen.snapshot;
  response.scene = live_.state(*snapshot, std::move(seen.sensors));
  live_.demand(*snapshot, request.scene_epoch, request.scene_version);
  const ResourceOptions resources = resourceOptions("", parameters_);
  const WorkspacePool::Lease workspace(workspaces_);
  Work work{snapshot, budget, FrameLookup(frames_, turn)};
  Doubts doubts(parameters_.max_age, snapshot, response.scene.sensors, std::move(seen.unknowns));
  Failures failures;
  for (std::size_t i = 0; i < request.cases.size(); ++i) {
    const ConstraintQuery &asked = request.cases[i];
    if (turn) turn->yield();
    work.lookup.begin();
    work.joints = CurrentJoints();
    work.unknown.clear();
    work.share.reset();
    std::vector<ConstraintRow> rows;
    ConstraintCase described;
    cprox_status fault = CPROX_OK;
    const std::string why = messageOf(
        [&] {
          budget.demand();
          described = toCase(asked, work);
          rows = answerCase(*providers_, described, resources, *workspace);
          for (const ConstraintRow &row : rows) work.derivatives += countDerivatives(row);
          demandAtMost("max_control_points", parameters_.max_control_points, work.derivatives, "derivatives");
        },
        &fault);
    if (fault < 0) rows = {failedRow(asked.id, why, fault)};

    // A trajectory is measured against all objects.
    Query about;
    if (!described.motion) about.objects = {asked.a.id, asked.b.id};
    doubts.objects(about);
    doubts.ages(work.lookup.age(), work.joints.age);
    doubts.joints(work.unknown);
    response.scene.joint_state_age = std::fmax(response.scene.joint_state_age, work.joints.age);

    for (const ConstraintRow &row : rows) {
      if (row.status < 0)
        failures.count("case " + std::to_string(i) + " ('" + row.id + "')" +
                       (row.provider.empty() ? "" : ", provider '" + row.provider + "'") + ": " + row.message);
      response.results.push_back(constraintMessage(row, described));
      doubts.apply(response.results.back());
    }
  }
  response.scene.transform_age = work.lookup.oldest();
  doubts.tell(response.warnings);
  response.success = true;
  failures.tell(response);
}

} // namespace curve_proximity
