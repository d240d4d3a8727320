/* SPDX-License-Identifier: BSD-3-Clause */
#include <curve_proximity/motion.hpp>

#include <algorithm>
#include <cmath>
#include <deque>
#include <optional>

#include "motion_data.h"
#include "robot/short_way.h"
#include "world/world.h"

namespace curve_proximity {
namespace {

/* What decides a joint value: its own variable; nothing where it follows another joint or cannot move. */
std::optional<int> variableOf(const Kinematics &kinematics, const std::string &joint) {
  const auto it = kinematics.variables.find(joint);
  if (it != kinematics.variables.end()) return it->second;
  if (kinematics.leaders.count(joint) == 0) {
    throw Error("joint '" + joint + "' is no joint of robot '" + kinematics.robot->name() + "'");
  }
  return std::nullopt;
}

std::vector<double> restOf(const Kinematics &kinematics, const JointPositions &rest) {
  std::vector<double> values = kinematics.rest;
  for (const auto &[joint, value] : rest) {
    if (!std::isfinite(value)) throw Error("the value of joint '" + joint + "' is not finite");
    if (const std::optional<int> variable = variableOf(kinematics, joint))
      values[static_cast<std::size_t>(*variable)] = value;
  }
  return values;
}

/* The trajectory's columns that are variables of the robot. */
struct Columns {
  std::vector<std::size_t> column;
  std::vector<std::int32_t> variable;
};

Columns columnsOf(const Kinematics &kinematics, const TrajectoryDescription &trajectory) {
  Columns out;
  for (std::size_t i = 0; i < trajectory.joints.size(); ++i) {
    const std::string &joint = trajectory.joints[i];
    if (const std::optional<int> variable = variableOf(kinematics, joint)) {
      out.column.push_back(i);
      out.variable.push_back(*variable);
      continue;
    }
    /* a follower needs its leader; one that cannot move needs nothing */
    const std::string &leader = kinematics.leaders.at(joint);
    const auto &names = trajectory.joints;
    if (!leader.empty() && std::find(names.begin(), names.end(), leader) == names.end()) {
      throw Error("joint '" + joint + "' follows joint '" + leader + "', which the trajectory does not name");
    }
  }
  if (out.column.empty()) throw Error("the trajectory moves no joint of the robot");
  return out;
}

/* The chosen columns of one of a point's lists; NULL for the core where there are none. */
const double *chosen(const std::vector<double> &values, const Columns &columns,
                     std::deque<std::vector<double>> &memory) {
  if (values.empty()) return nullptr;
  memory.emplace_back();
  for (const std::size_t column : columns.column) memory.back().push_back(values[column]);
  return memory.back().data();
}

TrajectoryShape shapeOf(const TrajectoryDescription &trajectory, const Columns &columns) {
  TrajectoryShape out;
  out.n_points = trajectory.points.size();
  out.n_joints = trajectory.joints.size();
  for (const TrajectoryPoint &point : trajectory.points) {
    out.has_velocities = out.has_velocities || !point.velocities.empty();
    out.has_accelerations = out.has_accelerations || !point.accelerations.empty();
    out.times.push_back(point.time);
  }
  if (trajectory.degree > 0) {
    out.has_velocities = out.has_accelerations = false;
    out.times = {trajectory.knots[trajectory.degree], trajectory.knots[out.n_points]};
  }
  out.column = columns.column;
  out.variable = columns.variable;
  return out;
}

cprox_interpolation toCore(Interpolation interpolation) {
  switch (interpolation) {
    case Interpolation::LINEAR: return CPROX_INTERPOLATION_LINEAR;
    case Interpolation::CUBIC: return CPROX_INTERPOLATION_CUBIC;
    case Interpolation::QUINTIC: return CPROX_INTERPOLATION_QUINTIC;
    case Interpolation::BY_POINTS: break;
  }
  return CPROX_INTERPOLATION_BY_WAYPOINTS;
}

/* A workspace is made for the error message only: it costs more than the motion. */
void createCore(const cprox_motion_description &description, RobotMotion::Data &data) {
  cprox_motion *made = nullptr;
  if (cprox_motion_create(data.kinematics->core.get(), &description, nullptr, &made) != CPROX_OK) {
    Workspace workspace;
    const cprox_status status = cprox_motion_create(data.kinematics->core.get(), &description, workspace.get(), &made);
    if (status != CPROX_OK) throw Error(workspace.reason(), status);
  }
  data.core.reset(made);
}

void makeState(const std::vector<double> &values, RobotMotion::Data &data) {
  cprox_motion_description description{};
  description.kind = CPROX_MOTION_STATE;
  description.rest = values.data();
  data.stands = true;
  data.shape.times = {0.0, 1.0};
  createCore(description, data);
}

/* Of the columns' variables; all others stand still. What it is made of must outlive it. */
cprox_motion_description describe(cprox_motion_kind kind, const Columns &columns, const std::vector<double> &still) {
  cprox_motion_description description{};
  description.kind = kind;
  description.variables = columns.variable.data();
  description.n_variables = columns.variable.size();
  description.rest = still.data();
  return description;
}

void makeSpline(const TrajectoryDescription &trajectory, const Columns &columns, const std::vector<double> &still,
                RobotMotion::Data &data) {
  std::vector<double> control;
  for (const TrajectoryPoint &point : trajectory.points)
    for (const std::size_t column : columns.column) control.push_back(point.positions[column]);
  cprox_motion_description description = describe(CPROX_MOTION_BSPLINE, columns, still);
  description.control = control.data();
  description.n_control = trajectory.points.size();
  description.degree = trajectory.degree;
  description.knots = trajectory.knots.data();
  description.n_knots = trajectory.knots.size();
  createCore(description, data);
}

void makeMotion(const TrajectoryDescription &trajectory, const JointPositions &rest, RobotMotion::Data &data) {
  const Kinematics &kinematics = *data.kinematics;
  const Columns columns = columnsOf(kinematics, trajectory);
  std::vector<double> still = restOf(kinematics, rest);
  data.shape = shapeOf(trajectory, columns);
  if (trajectory.degree > 0) return makeSpline(trajectory, columns, still, data);
  if (trajectory.points.size() == 1) {
    const TrajectoryPoint &point = trajectory.points.front();
    if (point.time > 0.0)
      throw Error(
          "the trajectory has one point: from where it is reached is not said (at time 0 the robot stands there)");
    for (std::size_t i = 0; i < columns.column.size(); ++i)
      still[static_cast<std::size_t>(columns.variable[i])] = point.positions[columns.column[i]];
    makeState(still, data);
    return;
  }
  std::deque<std::vector<double>> memory;
  std::vector<cprox_waypoint> points;
  for (const TrajectoryPoint &point : trajectory.points) {
    points.push_back({point.time, chosen(point.positions, columns, memory), chosen(point.velocities, columns, memory),
                      chosen(point.accelerations, columns, memory)});
  }
  cprox_motion_description description = describe(CPROX_MOTION_WAYPOINTS, columns, still);
  description.waypoints = points.data();
  description.n_waypoints = points.size();
  description.interpolation = toCore(trajectory.interpolation);
  createCore(description, data);
}

/* Is all that kinematics is made of the same? What it points to then belongs to both snapshots. */
bool hasSameRobot(const Snapshot &a, const Snapshot &b) {
  if (a.robot() != b.robot() || !a.robot() || a.attached() != b.attached()) return false;
  const auto &links = a.robot()->links();
  return std::all_of(links.begin(), links.end(), [&](const auto &link) {
    return &a.linkGeometry(link.first) == &b.linkGeometry(link.first) &&
           a.linkPadding(link.first) == b.linkPadding(link.first);
  });
}

std::shared_ptr<const PreparedRobot::Data> preparedIn(SnapshotPtr snapshot, PreparedWith with,
                                                      const PreparedRobot::Data *before) {
  auto data = std::make_shared<PreparedRobot::Data>();
  data->snapshot = std::move(snapshot);
  data->with = std::move(with);
  if (before && hasSameRobot(*before->snapshot, *data->snapshot)) {
    data->kinematics = before->kinematics;
  } else {
    data->kinematics =
        makeKinematics(*data->snapshot, data->with.virtual_joints, data->with.base_joints, data->with.base);
  }
  if (data->kinematics->geometries.empty())
    throw Error("robot '" + data->kinematics->robot->name() +
                "' has no collision geometry: nothing of it can come close to anything");
  preparePairs(data->with.disabled, *data);
  return data;
}

std::unique_ptr<RobotMotion::Data> startOf(const PreparedRobot &robot, const std::string &id) {
  auto data = std::make_unique<RobotMotion::Data>();
  data->prepared = robot.data();
  data->snapshot = data->prepared->snapshot;
  data->kinematics = data->prepared->kinematics;
  data->id = id;
  data->coverage = coverageOf(*data->snapshot);
  data->coverage.add(data->kinematics->robot->coverage());
  return data;
}

/* What can only be told of a scene, and what adoptBase() has not resolved. */
void checkFor(const Snapshot &scene, const TrajectoryDescription &trajectory) {
  if (!trajectory.free_joints.empty())
    throw Error("the trajectory has poses of joint '" + trajectory.free_joints.front().joint +
                "': adoptBase() makes values of them");
  for (const std::string &id : trajectory.carried)
    if (scene.attached().count(id) == 0)
      throw Error("a link carries '" + id + "' when the motion begins, and in the scene none does: attach it there");
}

void finish(const std::vector<std::string> &links, RobotMotion::Data &data) {
  choosePairs(links, data);
  data.warnings = beyondLimits(*data.kinematics, *data.core);
}

} // namespace

PreparedRobot::PreparedRobot(SnapshotPtr snapshot, const std::vector<std::array<std::string, 2>> &disabled,
                             const std::vector<VirtualJoint> &virtual_joints,
                             const std::vector<std::string> &base_joints, const Eigen::Isometry3d &base)
    : data_(preparedIn(std::move(snapshot), {disabled, virtual_joints, base_joints, base}, nullptr)) {}

PreparedRobot::PreparedRobot(const PreparedRobot &before, SnapshotPtr snapshot)
    : data_(preparedIn(std::move(snapshot), before.data_->with, before.data_.get())) {}

const SnapshotPtr &PreparedRobot::snapshot() const {
  return data_->snapshot;
}

RobotMotion::RobotMotion(const PreparedRobot &robot, const TrajectoryDescription &trajectory,
                         const JointPositions &rest, const std::vector<std::string> &links) {
  checkTrajectory(trajectory);
  checkFor(*robot.snapshot(), trajectory);
  auto data = startOf(robot, trajectory.id);
  data->coverage.add(trajectory.coverage);
  const Robot &model = *data->kinematics->robot;
  if (trajectory.shortest_way) {
    TrajectoryDescription shortened = trajectory;
    takeShortWays(model, shortened);
    makeMotion(shortened, rest, *data);
  } else {
    makeMotion(trajectory, rest, *data);
  }
  finish(links, *data);
  const std::vector<std::string> ways = longWays(model, trajectory);
  data->warnings.insert(data->warnings.end(), ways.begin(), ways.end());
  data_ = std::move(data);
}

RobotMotion::RobotMotion(const PreparedRobot &robot, const JointPositions &state, const std::string &id,
                         const std::vector<std::string> &links) {
  auto data = startOf(robot, id);
  makeState(restOf(*data->kinematics, state), *data);
  finish(links, *data);
  data_ = std::move(data);
}

RobotMotion::RobotMotion(SnapshotPtr snapshot, const TrajectoryDescription &trajectory, const JointPositions &rest,
                         const std::vector<std::array<std::string, 2>> &disabled, const Eigen::Isometry3d &base,
                         const std::vector<std::string> &links)
    : RobotMotion((checkTrajectory(trajectory),
                   PreparedRobot(std::move(snapshot), disabled, trajectory.base, trajectory.base_joints, base)),
                  trajectory, rest, links) {}

RobotMotion::~RobotMotion() = default;
RobotMotion::RobotMotion(RobotMotion &&) noexcept = default;
RobotMotion &RobotMotion::operator=(RobotMotion &&) noexcept = default;

std::array<double, 2> RobotMotion::domain() const {
  const cprox_motion_info info = cprox_motion_get_info(data_->core.get());
  return {info.t0, info.t1};
}

const SnapshotPtr &RobotMotion::snapshot() const {
  return data_->snapshot;
}

bool RobotMotion::stands() const {
  return data_->stands;
}

const Geometry &shapeOf(const RobotMotion::Data &data, std::size_t geometry) {
  const MovingGeometry &moving = data.kinematics->geometries[geometry];
  const auto &shapes = moving.attached ? moving.attached->shapes : data.snapshot->linkGeometry(*moving.link);
  return shapes.at(static_cast<std::size_t>(moving.part)).geometry;
}

double marginOf(const RobotMotion::Data &data, std::size_t geometry) {
  const MovingGeometry &moving = data.kinematics->geometries[geometry];
  return shapeOf(data, geometry).margin + moving.excess + data.snapshot->linkPadding(*moving.link) +
         (moving.attached ? moving.attached->description.padding : 0.0);
}

LinkPoses linkPosesOf(const RobotMotion::Data &data, double t) {
  const Kinematics &kinematics = *data.kinematics;
  std::vector<double> values(kinematics.rest.size());
  cprox_motion_evaluate(data.core.get(), t, values.data());
  LinkPoses out;
  for (const auto &[name, link] : kinematics.links) {
    cprox_vec3 position;
    Eigen::Matrix<double, 3, 3, Eigen::RowMajor> rotation;
    cprox_robot_link_frame(kinematics.core.get(), values.data(), link, &position, rotation.data());
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.linear() = rotation;
    pose.translation() = toEigen(position);
    out.emplace(name, pose);
  }
  return out;
}

LinkPoses RobotMotion::linkPoses(double t) const {
  return linkPosesOf(*data_, t);
}

const std::vector<std::string> &RobotMotion::skipped() const {
  std::call_once(data_->skipped_once, [this] { data_->skipped = skippedPairs(*data_); });
  return data_->skipped;
}

const std::vector<std::string> &RobotMotion::warnings() const {
  return data_->warnings;
}

} // namespace curve_proximity
