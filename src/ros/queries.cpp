/* SPDX-License-Identifier: BSD-3-Clause */
#include "queries.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <sstream>

#include "conversions.h"

namespace curve_proximity {
namespace {

/** Markers show no more curves than a person can tell apart. */
constexpr std::size_t MAX_DRAWN_CURVES = 100;

/** Ends a query when its time is over or the server goes. */
class TimeBudget {
 public:
  TimeBudget(double milliseconds, const std::atomic<bool> &stop, const std::atomic<bool> *cancelled)
      : milliseconds_(milliseconds), deadline_(deadlineOf(milliseconds)), stop_(stop), cancelled_(cancelled) {}

  /** In the shape of cprox_options.stop. */
  static bool isOver(void *user) {
    const TimeBudget &budget = *static_cast<const TimeBudget *>(user);
    return budget.stop_ || budget.isCancelled() || Clock::now() >= budget.deadline_;
  }

  std::string reason() const {
    if (stop_) return "the server is shutting down";
    if (isCancelled()) return "cancelled";
    std::ostringstream text;
    text << "~budget_ms = " << milliseconds_ << " are over";
    return text.str();
  }

 private:
  using Clock = std::chrono::steady_clock;

  static Clock::time_point deadlineOf(double milliseconds) {
    constexpr double FOREVER = 1e12; /* [ms] decades: within what the clock can count */
    const std::chrono::duration<double, std::milli> wait(std::min(milliseconds, FOREVER));
    return Clock::now() + std::chrono::duration_cast<Clock::duration>(wait);
  }

  bool isCancelled() const {
    return cancelled_ && *cancelled_;
  }

  const double milliseconds_;
  const Clock::time_point deadline_;
  const std::atomic<bool> &stop_;
  const std::atomic<bool> *const cancelled_;
};

void limit(const char *parameter, std::size_t most, std::size_t count, const char *what) {
  if (count <= most) return;
  throw Error(std::to_string(count) + " " + what + " are more than ~" + parameter + " = " + std::to_string(most));
}

/** Everything that a query is measured against, for one stamp after the other. For one thread. */
class StampedTargets {
 public:
  StampedTargets(SnapshotPtr snapshot, const Query &query, const sensor_msgs::JointState &joint_state,
                 FrameLookup &lookup)
      : snapshot_(std::move(snapshot)), query_(query), lookup_(lookup) {
    const bool everything = query.objects.empty() && query.links.empty();
    if (!query.links.empty() && !snapshot_->robot())
      throw Error("link '" + query.links.front() + "': this server has no robot, only objects");
    const auto carried = [&](const std::string &id) { return snapshot_->attached().count(id) > 0; };
    carried_ =
        everything ? !snapshot_->attached().empty() : std::any_of(query.objects.begin(), query.objects.end(), carried);
    with_robot_ = snapshot_->robot() && (everything || carried_ || !query.links.empty());
    from_joints_ = with_robot_ && !joint_state.name.empty();
    if (from_joints_) positions_ = toJointPositions(joint_state);
  }

  struct Stamped {
    LinkPoses links;
    Targets targets;
  };

  const Stamped &at(const ros::Time &stamp) {
    // Without a robot nothing depends on the stamp.
    const ros::Time key = with_robot_ ? stamp : ros::Time();
    auto found = stamped_.find(key);
    if (found == stamped_.end()) {
      LinkPoses links = with_robot_ ? linkPoses(stamp) : LinkPoses();
      Targets targets(snapshot_, links, query_);
      found = stamped_.emplace(key, Stamped{std::move(links), std::move(targets)}).first;
    }
    return found->second;
  }

 private:
  /** From the request's joints, the root link brought to the fixed frame by tf2; else every link by tf2. */
  LinkPoses linkPoses(const ros::Time &stamp) {
    const Robot &robot = *snapshot_->robot();
    if (from_joints_) return robot.linkPoses(positions_, lookup_.toFixed(robot.rootLink(), stamp));
    LinkPoses poses;
    if (query_.links.empty()) {
      for (const auto &link : robot.links()) {
        if (!link.second.empty()) poses[link.first] = lookup_.toFixed(link.first, stamp);
      }
    }
    for (const std::string &link : query_.links) {
      if (robot.links().count(link)) poses[link] = lookup_.toFixed(link, stamp);
    }
    for (const auto &object : snapshot_->attached()) {
      if (carried_) poses[object.second->link] = lookup_.toFixed(object.second->link, stamp);
    }
    return poses;
  }

  const SnapshotPtr snapshot_;
  const Query &query_;
  FrameLookup &lookup_;
  bool with_robot_ = false, from_joints_ = false, carried_ = false;
  JointPositions positions_;
  std::map<ros::Time, Stamped> stamped_;
};

/** Counts the rows that have no answer and keeps the first one's reason. */
class Failures {
 public:
  void count(const Proximity &row, std::size_t curve) {
    if (failed_++ == 0) first_ = "curve " + std::to_string(curve) + " ('" + row.id + "'): " + row.message;
  }

  void tell(QueryResponse &response) const {
    if (failed_ == 0) return;
    response.success = false;
    response.message =
        std::to_string(failed_) + " of " + std::to_string(response.results.size()) + " rows failed; " + first_;
  }

 private:
  std::size_t failed_ = 0;
  std::string first_;
};

} // namespace

QueryType queryTypeFromName(const std::string &name) {
  if (name == "distance") return QueryType::DISTANCE;
  if (name == "tolerance") return QueryType::TOLERANCE;
  if (name == "collision") return QueryType::COLLISION;
  throw Error("the query '" + name + "' is none of distance, tolerance, collision");
}

Query Queries::toQuery(const QueryRequest &request) const {
  // Here NaN and negative numbers are told once, not once a row; 0 means the server's own.
  if (request.epsilon != 0.0 && !(request.epsilon > 0.0 && std::isfinite(request.epsilon)))
    throw Error("epsilon is " + std::to_string(request.epsilon) + ": it must be above 0 and finite, or 0 for ~epsilon");
  if (!(request.budget_ms >= 0.0))
    throw Error("budget_ms is " + std::to_string(request.budget_ms) + ": it must be at least 0");
  if (!(request.delta >= 0.0 && std::isfinite(request.delta)))
    throw Error("delta is " + std::to_string(request.delta) + ": it must be at least 0 and finite");

  // What no row would heed is an error, too.
  if (request.delta != 0.0 && request.query_type != QueryType::TOLERANCE)
    throw Error("delta is " + std::to_string(request.delta) + ": it is the clearance that tolerance asks for");
  if (request.self_collision && request.trajectories.size() == 0)
    throw Error("self_collision is about the robot along a trajectory, and there is none");
  Query query;
  query.query_type = request.query_type;
  query.delta = request.delta;
  query.options.epsilon = request.epsilon != 0.0 ? request.epsilon : tuning_.epsilon.load();
  query.options.max_nodes = request.max_nodes != 0 ? request.max_nodes : static_cast<std::uint32_t>(tuning_.max_nodes);
  query.options.max_lod = *lodFromName(parameters_.max_lod);
  query.per_object = request.per_object;
  query.objects = request.objects;
  query.links = request.links;
  return query;
}

void Queries::checkLimits(const QueryRequest &request, const Snapshot &snapshot) const {
  limit("max_curves", static_cast<std::size_t>(parameters_.max_curves), request.curves.size(), "curves");
  std::size_t points = 0;
  for (const Curve &curve : request.curves) points += curve.points.size();
  limit("max_control_points", static_cast<std::size_t>(parameters_.max_control_points), points, "control points");

  // With per_object the answer may be far larger than the query.
  std::size_t targets = 1;
  if (request.per_object) {
    const bool everything = request.objects.empty() && request.links.empty();
    targets = request.objects.size() + request.links.size();
    if (everything) targets = snapshot.objects().size() + (snapshot.robot() ? snapshot.robot()->links().size() : 0);
  }
  limit("max_results", static_cast<std::size_t>(parameters_.max_results), request.curves.size() * targets, "results");
}

void Queries::answer(const QueryRequest &request, QueryResponse &response, Drawing &drawing) {
  const auto begin = Statistics::Clock::now();
  try {
    answerAll(request, response, drawing);
  } catch (...) {
    statistics_.record(Statistics::Clock::now() - begin, false, response.results);
    throw;
  }
  statistics_.record(Statistics::Clock::now() - begin, response.success, response.results);
}

void Queries::answerAll(const QueryRequest &request, QueryResponse &response, Drawing &drawing) {
  // One snapshot for all: what changes meanwhile does not change this answer.
  Query query = toQuery(request);
  TimeBudget budget(request.budget_ms != 0.0 ? request.budget_ms : tuning_.budget_ms.load(), stop_, request.cancelled);
  query.options.stop = TimeBudget::isOver;
  query.options.stop_user = &budget;
  const SnapshotPtr snapshot = scene_.snapshot();
  checkLimits(request, *snapshot);
  if (!snapshot->robot() && !request.joint_state.name.empty())
    throw Error("joint_state names '" + request.joint_state.name.front() + "', and this server has no robot");

  answerCurves(request, query, snapshot, response, drawing);
  answerTrajectories(request, query, snapshot, response, drawing);
  for (Proximity &row : response.results)
    if (row.status == cprox_status_name(CPROX_STOPPED)) row.message = budget.reason();
  drawing.query_type = request.query_type;
  drawing.snapshot = snapshot;
}

void Queries::answerCurves(const QueryRequest &request, const Query &query, const SnapshotPtr &snapshot,
                           QueryResponse &response, Drawing &drawing) {
  // Each curve is answered on its own: what is wrong with it fails its row only.
  FrameLookup lookup(frames_);
  StampedTargets targets(snapshot, query, request.joint_state, lookup);
  const WorkspacePool::Lease workspace(workspaces_);
  response.results.reserve(request.curves.size());
  Failures failures;
  for (const Curve &message : request.curves) {
    const auto i = static_cast<std::size_t>(&message - request.curves.begin());
    try {
      // The curve's frame, the robot and the curve itself: each may be what is wrong with this row.
      const CurveDescription description =
          toDescription(message, lookup.toFixed(message.header.frame_id, message.header.stamp));
      CompiledCurve curve = compile(description);
      const StampedTargets::Stamped &stamped = targets.at(message.header.stamp);
      std::vector<Answer> answers = ask(stamped.targets, curve, query, *workspace);
      for (const Answer &answer : answers) {
        response.results.push_back(toMessage(answer, request.query_type));
        if (answer.result.status < 0) failures.count(response.results.back(), i);
      }
      if (drawing.lines.size() < MAX_DRAWN_CURVES) {
        drawing.links = stamped.links;
        drawing.lines.push_back({std::move(curve), std::move(answers)});
      }
    } catch (const Error &error) {
      response.results.push_back(toFailedRow(message.id, error.what()));
      failures.count(response.results.back(), i);
    }
    if (request.progress) (*request.progress)(response, i + 1);
  }
  failures.tell(response);
}

void Queries::answerTrajectories(const QueryRequest &request, const Query &query, const SnapshotPtr &snapshot,
                                 QueryResponse &response, Drawing &drawing) {
  const auto &trajectories = request.trajectories;
  if (trajectories.size() == 0) return;
  if (!snapshot->robot()) throw Error("a trajectory needs a robot, and this server has none");
  std::size_t values = 0;
  for (const auto &trajectory : trajectories) values += trajectory.points.size() * trajectory.joint_names.size();
  limit("max_control_points", static_cast<std::size_t>(parameters_.max_control_points), values, "joint values");

  for (const auto &trajectory : trajectories) {
    const auto i = static_cast<std::size_t>(&trajectory - trajectories.begin());
    const std::string id = trajectories.size() == 1 ? "trajectory" : "trajectory/" + std::to_string(i);
    answerTrajectory(trajectory, id, request, query, snapshot, response, drawing);
    if (request.progress) (*request.progress)(response, request.curves.size() + i + 1);
  }
}

void Queries::answerTrajectory(const trajectory_msgs::JointTrajectory &message, const std::string &id,
                               const QueryRequest &request, const Query &query, const SnapshotPtr &snapshot,
                               QueryResponse &response, Drawing &drawing) {
  // The trajectory, the joints that it leaves alone, and where the robot stands.
  try {
    const JointPositions rest = toJointPositions(request.joint_state);
    TrajectoryDescription trajectory = toDescription(message, rest);
    trajectory.id = id;
    adoptBase(srdf_.virtual_joints, trajectory);
    FrameLookup lookup(frames_);
    const std::string frame =
        trajectory.base.empty() ? snapshot->robot()->rootLink() : trajectory.base.front().parent_frame;
    auto motion = std::make_shared<const RobotMotion>(snapshot, trajectory, rest, srdf_.disabled,
                                                      lookup.toFixed(frame, message.header.stamp));

    const WorkspacePool::Lease workspace(workspaces_);
    std::vector<Answer> answers = askEnvironment(*motion, query, *workspace);
    Query self = query; // one row, of no objects
    self.per_object = false;
    self.objects.clear();
    if (request.self_collision) answers.push_back(askSelf(*motion, self, *workspace));
    for (const Answer &answer : answers) response.results.push_back(toMessage(answer, request.query_type));
    drawing.motion = std::move(motion);
    drawing.motion_answers = std::move(answers);
  } catch (const Error &error) {
    response.results.push_back(toFailedRow(id, error.what()));
  }

  // A row that failed fails the call, as a curve's does.
  const Proximity &last = response.results.back();
  if (response.success && last.status == cprox_status_name(CPROX_INVALID)) {
    response.success = false;
    response.message = id + ": " + last.message;
  }
}

} // namespace curve_proximity
