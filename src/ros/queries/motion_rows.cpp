/* SPDX-License-Identifier: BSD-3-Clause */
/* What a request asks of motions: trajectories of the robot, the robot where it stands, and all that moves. */
#include <algorithm>
#include <cmath>
#include <iterator>

#include "messages/scene_message.h"
#include "messages/topics.h"
#include "messages/trajectory_message.h"
#include "queries/queries.h"
#include "queries/time_budget.h"
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

/** Throws Error where the budget of a query is over before what is asked about is made. */
void demandTime(const Query &query) {
  static_cast<const TimeBudget *>(query.options.stop_user)->demand();
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
    const auto make = [&](std::string &remark) { return toDescription(trajectory, work.joints.positions, remark); };
    answerMotion(trajectoryName(work), trajectory.header.stamp, make, work);
    tellProgress(work);
  }
}

/** Of the robot, or of what flies by itself. */
void Queries::answerMultiDofTrajectories(Work &work) {
  for (const auto &trajectory : work.request.multi_dof_trajectories) {
    const Robot *robot = work.snapshot->robot().get();
    if (movesRobot(trajectory, robot, live_.srdf)) {
      const auto make = [&](std::string &remark) {
        return toDescription(toJointTrajectory(trajectory, *robot, live_.srdf), work.joints.positions, remark);
      };
      answerMotion(trajectoryName(work), trajectory.header.stamp, make, work);
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

/** What is asked about, and what of it is drawn. */
struct Queries::Moving {
  std::vector<Row> rows;
  std::vector<Proof> proofs;        /**< of the rows, if they are asked for */
  std::string remark;               /**< of each row that has an answer */
  TrajectoryDescription trajectory; /**< of gradients */
  Drawing::Motion drawn;

  /** Adds the rows of all parts of a subject. */
  void ask(const Subject &subject, const Query &query, const QueryRequest &request, Workspace &workspace) {
    if (request.problems) return request.problems->push_back(problemOf(subject, query));
    const std::vector<Part> parts = partsOf(subject, request.question, query, request.per_link);
    std::vector<Row> answered =
        answerParts(subject, parts, request.question, provable(subject, query), Beside::SEARCH, workspace);
    for (Row &row : answered) {
      if (row.answer.a.empty()) row.answer.a = row.part.link; // nothing is near it
      if (row.answer.b.empty()) row.answer.b = row.part.object;
    }
    if (query.options.certificate) // there is one row
      for (const Row &row : answered) proofs.push_back(takeProof(subject, query, row));
    rows.insert(rows.end(), std::make_move_iterator(answered.begin()), std::make_move_iterator(answered.end()));
  }
};

/** Adds the rows that `ask` has gathered, or a row of each of the kinds that has failed. */
void Queries::answerMoving(const std::string &id, const std::vector<std::string> &kinds, Work &work,
                           const std::function<void(Workspace &, Moving &)> &ask) {
  const std::size_t before = work.response.results.size();
  std::vector<Problem> *problems = work.request.problems;
  const std::size_t problems_before = problems ? problems->size() : 0;
  if (work.request.turn) work.request.turn->yield();
  try {
    Moving moving;
    const WorkspacePool::Lease workspace(workspaces_);
    ask(*workspace, moving);
    std::vector<DetailMessage> details;
    details.reserve(moving.rows.size());
    for (const Row &row : moving.rows) details.push_back(toMessage(row, &moving.trajectory));
    std::vector<Answer> &answers = moving.drawn.answers;
    answers.reserve(details.size());
    for (std::size_t i = 0; i < details.size(); ++i) {
      Answer &answer = answers.emplace_back(std::move(moving.rows[i].answer));
      answer.id = id;
      if (kinds.front() == Proximity::KIND_MOVERS) answer.kind = kinds.front();
      Proximity &row = work.response.add(std::move(details[i]));
      fillRow(answer, work.request.question, work.query.query_type, row);
      if (answer.result.status >= 0) addRemark(moving.remark, row);
      if (const auto *scale = std::get_if<RobustScale>(&moving.rows[i].detail))
        row.certified_scale = scale->certified, row.refused_scale = scale->refused;
      if (i < moving.proofs.size()) addProof(std::move(moving.proofs[i]), row);
    }
    if (moving.drawn.robot || !work.drawing.motion.robot) work.drawing.motion = std::move(moving.drawn);
  } catch (const Error &error) {
    if (problems) problems->resize(problems_before);
    for (const std::string &kind : kinds) {
      if (problems) problems->push_back(doubtful(error.what()));
      work.response.add() = toFailedRow(id, kind, error.what());
    }
  }
  tellFailure(id, before, work.response);
}

/** A body along poses in a frame. */
void Queries::answerRide(const std::string &id, const std::string &frame, const std::function<PathPoses()> &poses,
                         Work &work) {
  answerMoving(id, {Proximity::KIND_MOVERS}, work, [&](Workspace &workspace, Moving &out) {
    PathPoses along = poses();
    work.lookup.begin();
    if (!work.query.links.empty()) throw Error("links and group do not apply to a body");
    if (work.errors) throw Error("errors do not apply to a body");
    const Eigen::Isometry3d in_fixed = work.lookup.toFixed(frame, along.stamp);
    for (TimedPose &pose : along.poses) pose.pose = in_fixed * pose.pose;
    demandTime(work.query);
    const MovingObject rides = toRider(work.request.more, *work.snapshot, std::move(along.poses));
    const Surroundings around(work.snapshot, work.request.more, robots_, rides, resourceOptions("", parameters_),
                              along.stamp, work.lookup, mostBytes(), stopOf(work.query));
    work.doubts.joints(around.unknown());
    out.ask(around.subject(false), covered(work.query, NAN, true, work), work.request, workspace);
    out.remark = along.remark;
    out.drawn.movers = around.movers();
    out.drawn.others = around.robots();
    out.drawn.rider = rides.object;
  });
}

void Queries::answerFlight(const trajectory_msgs::MultiDOFJointTrajectory &trajectory, Work &work) {
  if (carriesBody(work.request)) {
    for (std::size_t i = 0; i < trajectory.joint_names.size(); ++i) {
      const auto poses = [&] { return PathPoses{toPoses(trajectory, i), trajectory.header.stamp, ""}; };
      answerRide(trajectory.joint_names[i], trajectory.header.frame_id, poses, work);
    }
    return;
  }
  CurveSearch &search = curveSearch(work);
  try {
    if (work.errors) throw Error("errors do not apply to what flies by itself");
    if (!work.request.more.moving_robots.empty())
      throw Error("moving_robots do not apply to what flies by itself: ask about it without");
    for (const Curve &curve : toCurves(trajectory, parameters_.path_radius)) answerCurve(curve, search, work);
  } catch (const Error &error) {
    refuseCurve(trajectory.joint_names.empty() ? "" : trajectory.joint_names.front(), error.what(), search, work);
  }
}

/** The name of the robot's next trajectory. */
std::string Queries::trajectoryName(Work &work) const {
  const auto &others = work.request.multi_dof_trajectories;
  const auto moving = std::count_if(others.begin(), others.end(), [&](const auto &other) {
    return movesRobot(other, work.snapshot->robot().get(), live_.srdf);
  });
  return numbered("trajectory", work.trajectories++,
                  work.request.trajectories.size() + static_cast<std::size_t>(moving));
}

/** The robot where it stands: a trajectory of one point. */
void Queries::answerState(Work &work) {
  if (!work.request.more.robot_state) return;
  if (!work.snapshot->robot()) throw Error("robot_state needs a robot, and this server has none");
  TrajectoryDescription state;
  state.points.emplace_back();
  for (const auto &[joint, position] : work.joints.positions) {
    state.joints.push_back(joint);
    state.points.back().positions.push_back(position);
  }
  answerMotion(
      "state", work.request.more.joint_state.header.stamp, [&](std::string &) { return state; }, work);
}

/** All that moves, with nobody in its middle. */
void Queries::answerMovers(Work &work) {
  const QueryRequest &request = work.request;
  if (!request.more.movers) return;
  answerMoving("movers", {Proximity::KIND_MOVERS}, work, [&](Workspace &workspace, Moving &out) {
    if (!work.query.links.empty()) throw Error("links and group do not apply to movers");
    const Surroundings around(work.snapshot, request.more, robots_, nullptr, ros::Time(), 0, work.lookup, mostBytes(),
                              stopOf(work.query));
    work.doubts.joints(around.unknown());
    out.ask(around.subject(request.more.self_collision != 0), covered(work.query, NAN, true, work), request, workspace);
    out.drawn.movers = around.movers();
    out.drawn.others = around.robots();
  });
}

/** The robot along what `make` makes. */
void Queries::answerMotion(const std::string &id, const ros::Time &stamp, const MakeTrajectory &make, Work &work) {
  const QueryRequest &request = work.request;
  std::vector<std::string> kinds{Proximity::KIND_ENVIRONMENT};
  if (request.more.self_collision) kinds.push_back(Proximity::KIND_SELF);
  answerMoving(id, kinds, work, [&](Workspace &workspace, Moving &out) {
    // The trajectory, the joints that it leaves alone, and where the robot stands.
    work.lookup.begin();
    TrajectoryDescription &trajectory = out.trajectory = make(out.remark);
    trajectory.id = id;
    trajectory.coverage.add(request.coverage);
    demandTime(work.query);
    const Robot &robot = *work.snapshot->robot();
    adoptBase(live_.srdf.virtual_joints, robot, trajectory);
    const std::string unknown =
        unknownJoints(robot, trajectory.joints, work.joints.positions, parameters_.assumed_joints);
    work.doubts.joints(unknown);
    const Eigen::Isometry3d base = trajectory.base.empty()
                                       ? rootPose(robot, live_.srdf, stamp, work.lookup)
                                       : work.lookup.toFixed(trajectory.base.front().parent_frame, stamp);
    demandTime(work.query);
    const auto motion = std::make_shared<const RobotMotion>(work.snapshot, trajectory, work.joints.positions,
                                                            live_.disabled(*work.snapshot), base, work.query.links);
    out.drawn.robot = motion;

    Query environment = work.query;
    environment.links.clear(); // the motion has them
    const ErrorBounds *errors = work.errors ? &*work.errors : nullptr;
    if (movesBeside(request.more, *work.snapshot)) {
      if (errors) throw Error("errors do not apply among objects that move");
      const Surroundings around(work.snapshot, request.more, robots_, motion, stamp, trajectory.points.size(),
                                work.lookup, mostBytes(), stopOf(work.query));
      const std::vector<std::string> own = ownNames(*work.snapshot, work.query.links);
      if (unknown.empty()) work.doubts.joints(around.unknown());
      Query among = covered(environment, work.joints.age, true, work);
      among.links = own;
      out.ask(around.subject(false), among, request, workspace);
      out.drawn.movers = around.movers();
      out.drawn.others.assign(around.robots().begin() + 1, around.robots().end());
    } else {
      const bool by_objects = !asksFor<question::Sweep>(request.question);
      out.ask(MotionSubject{*motion, false, errors}, covered(environment, work.joints.age, by_objects, work), request,
              workspace);
    }
    if (!request.more.self_collision) return;
    Query self = environment; // of no objects
    self.per_object = false;
    self.objects.clear();
    if (request.turn) request.turn->yield();
    work.doubts.joints(unknown);
    out.ask(MotionSubject{*motion, true, errors}, covered(self, work.joints.age, false, work), request, workspace);
  });
}

} // namespace curve_proximity
