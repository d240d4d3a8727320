/* SPDX-License-Identifier: BSD-3-Clause */
/* What a request asks of motions: trajectories of the robot, the robot where it stands, and all that moves. */
#include <algorithm>
#include <cmath>
#include <iterator>

#include "messages/gradient_message.h"
#include "messages/scene_message.h"
#include "messages/topics.h"
#include "messages/trajectory_message.h"
#include "queries/queries.h"
#include "queries/row_message.h"
#include "world/robot_description.h"

namespace curve_proximity {
namespace {

/** Links with geometry, and what they carry; none: all. */
std::vector<std::string> ownNames(const Snapshot &snapshot, const std::vector<std::string> &links) {
  std::vector<std::string> out;
  for (const std::string &link : links) {
    const auto found = snapshot.robot()->links().find(link);
    if (found != snapshot.robot()->links().end() && !found->second.empty()) out.push_back(link);
    for (const auto &entry : snapshot.attached())
      if (entry.second->link == link && !entry.second->shapes.empty()) out.push_back(entry.first);
  }
  if (!links.empty() && out.empty()) throw Error("none of the links has collision geometry");
  return out;
}

/** A row that failed fails the call, as a curve's does: the first of those from `before` on. */
void tellFailure(const std::string &id, std::size_t before, QueryResponse &response) {
  for (std::size_t i = before; i < response.results.size() && response.success; ++i) {
    if (!std::isnan(response.results[i].lower)) continue;
    response.success = false;
    response.message = id + ": " + response.results[i].message;
  }
}

/** Of a row that has an answer. */
void addRemark(const std::string &remark, Proximity &row) {
  if (!remark.empty()) row.message += (row.message.empty() ? "" : "; ") + remark;
}

/** What ends a query ends what is made for it. */
Stop stopOf(const Query &query) {
  const cprox_options &options = query.options;
  return [stop = options.stop, user = options.stop_user] { return stop != nullptr && stop(user); };
}

} // namespace

/** The query with what its answers do not cover, after all look-ups. joints: [s] their age. with_objects: it is about
 *  objects, too. */
Query Queries::covered(Query query, double joints, bool with_objects, Work &work) {
  work.doubts.objects(query, with_objects);
  work.doubts.ages(work.lookup.age(), joints);
  query.coverage = work.doubts.coverage();
  return query;
}

void Queries::answerTrajectories(Work &work) {
  const auto &trajectories = work.request.trajectories;
  if (trajectories.size() == 0) return;
  if (!work.snapshot->robot()) throw Error("a trajectory needs a robot, and this server has none");
  for (const auto &trajectory : trajectories) {
    answerTrajectory(trajectory, work);
    tellProgress(work);
  }
}

/** Of the robot, or of what flies by itself. */
void Queries::answerMultiDofTrajectories(Work &work) {
  for (const auto &trajectory : work.request.multi_dof_trajectories) {
    const Robot *robot = work.snapshot->robot().get();
    if (movesRobot(trajectory, robot, live_.srdf)) {
      trajectory_msgs::JointTrajectory joints;
      std::string why_not;
      try {
        joints = toJointTrajectory(trajectory, *robot, live_.srdf);
      } catch (const Error &error) {
        why_not = error.what();
      }
      answerTrajectory(joints, work, why_not);
    } else {
      answerFlight(trajectory, work);
    }
    tellProgress(work);
  }
}

bool Queries::carriesBody(const QueryRequest &request) const {
  return !request.more.body.id.empty() || !parameters_.path_body.id.empty();
}

/** The request's body, or that of ~path_body; without shapes what a link carries. Its pose is in the frame of each of
 *  the poses. */
MovingObject Queries::toRider(const ProximityQuery &query, const Snapshot &snapshot,
                              std::vector<TimedPose> poses) const {
  MovingObject out;
  if (query.body.id.empty()) {
    out.object = parameters_.path_body;
  } else {
    Operation operation = toOperation(query.body);
    if (operation.kind != Operation::Kind::ADD || operation.trajectory)
      throw Error("body: it is no plain object: its operation is ADD, and it has no trajectory");
    out.object = std::move(operation.object);
  }
  for (TimedPose &pose : poses) pose.pose = pose.pose * out.object.pose;
  if (out.object.shapes.empty()) return carriedObject(snapshot, out.object.id, std::move(poses));
  out.object.pose = Eigen::Isometry3d::Identity();
  out.poses = std::move(poses);
  return out;
}

/** A body along poses in the frame of the header. */
void Queries::answerRide(const std::string &id, const std::string &frame, const ros::Time &stamp,
                         std::vector<TimedPose> poses, const std::string &remark, Work &work) {
  const QueryRequest &request = work.request;
  const std::size_t before = work.response.results.size();
  if (request.turn) request.turn->yield();
  work.lookup.begin();
  try {
    if (!work.query.links.empty()) throw Error("links and group do not apply to a body");
    const Eigen::Isometry3d in_fixed = work.lookup.toFixed(frame, stamp);
    for (TimedPose &pose : poses) pose.pose = in_fixed * pose.pose;
    const MovingObject rides = toRider(request.more, *work.snapshot, std::move(poses));
    const Surroundings around(work.snapshot, request.more, robots_, rides, resourceOptions("", parameters_), stamp,
                              work.lookup, mostBytes(), stopOf(work.query));
    const WorkspacePool::Lease workspace(workspaces_);
    MotionRows rows;
    around.ask(covered(work.query, NAN, true, work), false, request.asking, *workspace, rows);
    std::move(rows.profiles.begin(), rows.profiles.end(), std::back_inserter(work.response.profiles));
    std::move(rows.violations.begin(), rows.violations.end(), std::back_inserter(work.response.violations));
    for (Answer &answer : rows.answers) {
      answer.kind = Proximity::KIND_MOVERS;
      answer.id = id;
      work.response.results.emplace_back();
      fillRow(answer, work.query, request.asking, work.response.results.back());
      if (answer.result.status >= 0) addRemark(remark, work.response.results.back());
    }
    if (!work.drawing.motion) {
      work.drawing.movers = around.movers();
      work.drawing.robots = around.robots();
      work.drawing.rider = rides.object;
      work.drawing.motion_answers = std::move(rows.answers);
    }
  } catch (const Error &error) {
    work.response.results.push_back(toFailedRow(id, Proximity::KIND_MOVERS, error.what()));
    work.response.fillUp(request.asking);
  }
  tellFailure(id, before, work.response);
}

void Queries::answerPath(const nav_msgs::Path &path, const std::string &id, Work &work) {
  PathPoses along;
  try {
    along = toPoses(path);
  } catch (const Error &error) {
    work.response.results.push_back(toFailedRow(id, Proximity::KIND_MOVERS, error.what()));
    work.response.fillUp(work.request.asking);
    tellFailure(id, work.response.results.size() - 1, work.response);
    return;
  }
  answerRide(id, path.header.frame_id, along.stamp, std::move(along.poses), along.remark, work);
}

void Queries::answerFlight(const trajectory_msgs::MultiDOFJointTrajectory &trajectory, Work &work) {
  if (carriesBody(work.request)) {
    for (std::size_t i = 0; i < trajectory.joint_names.size(); ++i) {
      std::vector<TimedPose> poses;
      try {
        poses = toPoses(trajectory, i);
      } catch (const Error &error) {
        work.response.results.push_back(toFailedRow(trajectory.joint_names[i], Proximity::KIND_MOVERS, error.what()));
        work.response.fillUp(work.request.asking);
        tellFailure(trajectory.joint_names[i], work.response.results.size() - 1, work.response);
        continue;
      }
      answerRide(trajectory.joint_names[i], trajectory.header.frame_id, trajectory.header.stamp, std::move(poses), "",
                 work);
    }
    return;
  }
  CurveSearch &search = curveSearch(work);
  try {
    if (!work.request.more.moving_robots.empty())
      throw Error("moving_robots do not apply to what flies by itself: ask about it without");
    for (const Curve &curve : toCurves(trajectory, parameters_.path_radius)) answerCurve(curve, search, work);
  } catch (const Error &error) {
    refuseCurve(trajectory.joint_names.empty() ? "" : trajectory.joint_names.front(), error.what(), search, work);
  }
}

/** why_not: what is wrong with it already. */
void Queries::answerTrajectory(const trajectory_msgs::JointTrajectory &message, Work &work, std::string why_not) {
  const QueryRequest &request = work.request;
  TrajectoryDescription trajectory;
  std::string remark;
  try {
    if (why_not.empty()) trajectory = toDescription(message, work.joints.positions, remark);
  } catch (const Error &error) {
    why_not = error.what();
  }
  const auto &others = request.multi_dof_trajectories;
  const auto moving = std::count_if(others.begin(), others.end(), [&](const auto &other) {
    return movesRobot(other, work.snapshot->robot().get(), live_.srdf);
  });
  trajectory.id =
      numbered("trajectory", work.trajectories++, request.trajectories.size() + static_cast<std::size_t>(moving));
  answerMotion(std::move(trajectory), message.header.stamp, remark, why_not, work);
}

/** The robot where it stands: a trajectory of one point. */
void Queries::answerState(Work &work) {
  if (!work.request.more.robot_state) return;
  if (!work.snapshot->robot()) throw Error("robot_state needs a robot, and this server has none");
  TrajectoryDescription state;
  state.id = "state";
  state.points.emplace_back();
  for (const auto &[joint, position] : work.joints.positions) {
    state.joints.push_back(joint);
    state.points.back().positions.push_back(position);
  }
  answerMotion(std::move(state), work.request.more.joint_state.header.stamp, "", "", work);
}

/** All that moves, with nobody in its middle. */
void Queries::answerMovers(Work &work) {
  const QueryRequest &request = work.request;
  if (!request.more.movers) return;
  const std::size_t before = work.response.results.size();
  try {
    if (!work.query.links.empty()) throw Error("links and group do not apply to movers");
    const Surroundings around(work.snapshot, request.more, robots_, nullptr, ros::Time(), 0, work.lookup, mostBytes(),
                              stopOf(work.query));
    const WorkspacePool::Lease workspace(workspaces_);
    MotionRows rows;
    around.ask(covered(work.query, NAN, true, work), request.more.self_collision != 0, request.asking, *workspace,
               rows);
    std::move(rows.profiles.begin(), rows.profiles.end(), std::back_inserter(work.response.profiles));
    std::move(rows.violations.begin(), rows.violations.end(), std::back_inserter(work.response.violations));
    for (Answer &answer : rows.answers) {
      answer.kind = Proximity::KIND_MOVERS;
      work.response.results.emplace_back();
      fillRow(answer, work.query, request.asking, work.response.results.back());
    }
    if (!work.drawing.motion) {
      work.drawing.movers = around.movers();
      work.drawing.robots = around.robots();
      work.drawing.rider.reset();
      work.drawing.motion_answers = std::move(rows.answers);
    }
  } catch (const Error &error) {
    work.response.results.push_back(toFailedRow("movers", Proximity::KIND_MOVERS, error.what()));
    work.response.fillUp(request.asking);
  }
  tellFailure("movers", before, work.response);
}

void Queries::answerMotion(TrajectoryDescription trajectory, const ros::Time &stamp, const std::string &remark,
                           const std::string &why_not, Work &work) {
  const QueryRequest &request = work.request;
  QueryResponse &response = work.response;
  const std::string id = trajectory.id;
  const std::size_t before = response.results.size();
  if (request.turn) request.turn->yield();

  // The trajectory, the joints that it leaves alone, and where the robot stands.
  work.lookup.begin();
  try {
    if (!why_not.empty()) throw Error(why_not);
    const Robot &robot = *work.snapshot->robot();
    adoptBase(live_.srdf.virtual_joints, robot, trajectory);
    std::string told = remark;
    for (const std::string &way : longWays(robot, trajectory)) told += (told.empty() ? "" : "; ") + way;
    const Eigen::Isometry3d base = trajectory.base.empty()
                                       ? rootPose(robot, live_.srdf, stamp, work.lookup)
                                       : work.lookup.toFixed(trajectory.base.front().parent_frame, stamp);
    auto motion = std::make_shared<const RobotMotion>(work.snapshot, trajectory, work.joints.positions,
                                                      live_.disabled(), base, work.query.links);

    const WorkspacePool::Lease workspace(workspaces_);
    Query environment = work.query;
    environment.links.clear(); // the motion has them
    MotionRows rows;
    if (movesBeside(request.more, *work.snapshot)) {
      const Surroundings around(work.snapshot, request.more, robots_, motion, stamp, trajectory.points.size(),
                                work.lookup, mostBytes(), stopOf(work.query));
      Query among = environment;
      among.links = ownNames(*work.snapshot, work.query.links);
      among.coverage = covered(environment, work.joints.age, true, work).coverage;
      around.ask(among, false, request.asking, *workspace, rows);
      for (Answer &answer : rows.answers) answer.id = id;
      work.drawing.movers = around.movers();
      work.drawing.robots.assign(around.robots().begin() + 1, around.robots().end());
    } else {
      work.drawing.movers = nullptr;
      work.drawing.robots.clear();
      askMotion(*motion, covered(environment, work.joints.age, true, work), false, request.asking, *workspace, rows);
    }
    if (request.more.self_collision) {
      Query self = environment; // of no objects
      self.per_object = false;
      self.objects.clear();
      if (request.turn) request.turn->yield();
      askMotion(*motion, covered(self, work.joints.age, false, work), true, request.asking, *workspace, rows);
    }
    std::vector<Answer> &answers = rows.answers;
    std::move(rows.profiles.begin(), rows.profiles.end(), std::back_inserter(response.profiles));
    std::move(rows.violations.begin(), rows.violations.end(), std::back_inserter(response.violations));
    for (const ClearanceGradient &gradient : rows.gradients)
      response.gradients.push_back(toMessage(gradient, trajectory));
    for (const Answer &answer : answers) {
      response.results.emplace_back();
      Proximity &row = response.results.back();
      fillRow(answer, environment, request.asking, row);
      if (answer.result.status >= 0) addRemark(told, row);
    }
    work.drawing.rider.reset();
    work.drawing.motion = std::move(motion);
    work.drawing.motion_answers = std::move(answers);
  } catch (const Error &error) {
    response.results.push_back(toFailedRow(id, Proximity::KIND_ENVIRONMENT, error.what()));
    if (request.more.self_collision) response.results.push_back(toFailedRow(id, Proximity::KIND_SELF, error.what()));
    response.fillUp(request.asking);
  }

  tellFailure(id, before, response);
}

} // namespace curve_proximity
