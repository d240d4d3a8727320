/* SPDX-License-Identifier: BSD-3-Clause */
#include "queries/queries.h"

#include <algorithm>
#include <cmath>

#include "queries/curve_search.h"
#include "queries/time_budget.h"
#include "transport/memory_account.h"
#include "transport/request_limits.h"

namespace curve_proximity {
namespace {

constexpr std::size_t DIRECTIONS = 7; /* of an object's margins */

/** Of a row: itself, its answer in the scene's form, its bytes on the wire, names of usual length. */
constexpr std::size_t ROW_BYTES = 2 * sizeof(Proximity) + sizeof(Answer) + 512;

double numberOf(const std::vector<double> &numbers, std::size_t i, std::size_t joints) {
  if (numbers.size() != joints && !numbers.empty())
    throw Error("errors: a list has " + std::to_string(numbers.size()) + " numbers for " + std::to_string(joints) +
                " joints");
  return numbers.empty() ? 0.0 : numbers[i];
}

std::optional<ErrorBounds> toErrors(const std::vector<ExecutionErrors> &messages) {
  if (messages.empty()) return std::nullopt;
  if (messages.size() > 1) throw Error("there are " + std::to_string(messages.size()) + " errors: give one");
  const ExecutionErrors &message = messages.front();
  ErrorBounds out;
  out.every_joint = {message.tracking, message.speed, message.acceleration};
  const std::size_t n = message.joints.size();
  for (std::size_t i = 0; i < n; ++i)
    out.joints[message.joints[i]] = {numberOf(message.joint_tracking, i, n), numberOf(message.joint_speed, i, n),
                                     numberOf(message.joint_acceleration, i, n)};
  out.timing = message.timing;
  out.base_position = message.base_position;
  out.base_rotation = message.base_rotation;
  out.object_position = message.object_position;
  out.object_rotation = message.object_rotation;
  out.sensor = message.sensor;
  out.flex = message.flex;
  return out;
}

} // namespace

std::string Queries::numbered(const std::string &name, std::size_t i, std::size_t all) {
  return all == 1 ? name : name + "/" + std::to_string(i);
}

std::vector<SpeedProfile> takeSpeeds(QueryResponse &answer) {
  std::vector<SpeedProfile> speeds = answer.takeDetails<SpeedProfile>();
  for (std::size_t i = 0; i < speeds.size(); ++i) {
    SpeedProfile &speed = speeds[i];
    speed.profile.summary = std::move(answer.results[i]);
    if (speed.overrides.empty()) speed.constant = speed.unwatched = NAN; // there is no answer
  }
  return speeds;
}

std::vector<ViolationIntervals> takeViolations(QueryResponse &answer) {
  std::vector<ViolationIntervals> violations = takeSummed<ViolationIntervals>(answer);
  for (ViolationIntervals &found : violations)
    for (std::string &a : found.a)
      if (a.empty()) a = found.summary.a; // a curve is one thing
  return violations;
}

std::size_t Queries::mostBytes() const {
  return static_cast<std::size_t>(parameters_.max_request_mb) << 20;
}

Query Queries::toQuery(const QueryRequest &request, const Snapshot &snapshot) const {
  const ProximityQuery &more = request.more;
  if (!(more.epsilon >= 0.0 && std::isfinite(more.epsilon)))
    throw Error("epsilon is " + std::to_string(more.epsilon) + ": it must be at least 0 and finite");
  if (!(request.budget_ms >= 0.0))
    throw Error("budget_ms is " + std::to_string(request.budget_ms) + ": it must be at least 0");
  if (!(request.delta >= 0.0 && std::isfinite(request.delta)))
    throw Error("delta is " + std::to_string(request.delta) + ": it must be at least 0 and finite");

  // What no row would heed is an error, too.
  if (request.delta != 0.0 && request.query_type != QueryType::TOLERANCE)
    throw Error("delta is " + std::to_string(request.delta) + ": it is the clearance that tolerance asks for");
  const std::size_t motions = request.trajectories.size() + request.multi_dof_trajectories.size();
  const bool own_rows = !asksFor<question::Search, question::Gradient>(request.question);
  if (own_rows && more.per_object) throw Error("per_object does not apply: it is of distance, tolerance and collision");
  if (!more.body.id.empty() && request.paths.empty() && request.multi_dof_trajectories.empty())
    throw Error("body applies to paths and multi_dof_trajectories: there is none");
  if (more.gradient && !asksFor<question::Gradient>(request.question))
    throw Error("gradient does not apply: it is of the service distance");
  const bool proves =
      asksFor<question::Search, question::Contact, question::Profile, question::Violations>(request.question);
  if (more.certificate && (!proves || more.per_object || request.per_link))
    throw Error(
        "certificate does not apply: it is of distance, tolerance, collision, time_of_contact, "
        "clearance_profile and violations, without gradient, per_object and per_link");
  if (more.gradient && more.per_object)
    throw Error("gradient does not apply with per_object: there is one for the nearest object");
  if (request.per_link && motions == 0 && !more.robot_state)
    throw Error("per_link is about the robot along a trajectory or as it stands (robot_state): there is neither");
  if (more.self_collision && motions == 0 && !more.robot_state && !more.movers)
    throw Error("self_collision is about the robot along a trajectory or as it stands (robot_state): there is neither");
  if (!more.moving_robots.empty() && motions == 0 && !more.robot_state && !more.movers)
    throw Error("moving_robots are about trajectories, robot_state or movers: there is none of these");
  if (!more.errors.empty() &&
      (request.curves.size() + request.paths.size() > 0 || !more.moving_robots.empty() || more.movers))
    throw Error(
        "errors are those of the robot among objects that stand: ask about its trajectories or robot_state alone");
  if (!more.moving_robots.empty() && request.curves.size() + request.paths.size() > 0)
    throw Error("moving_robots do not apply to curves and paths: ask about them without");
  Query query;
  query.query_type = request.query_type;
  query.delta = request.delta;
  query.options.epsilon = more.epsilon != 0.0 ? more.epsilon : tuning_.epsilon.load();
  query.options.max_nodes = more.max_nodes != 0 ? more.max_nodes : static_cast<std::uint32_t>(tuning_.max_nodes);
  query.options.max_lod = *lodFromName(parameters_.max_lod);
  query.second_opinion = second_opinions_;
  query.per_object = more.per_object != 0;
  query.objects = more.objects;
  query.links = more.links;
  query.moving_only = more.moving_only;
  if (more.group.empty()) return query;
  if (!snapshot.robot()) throw Error("group '" + more.group + "': this server has no robot, only objects");

  // Of curves only links with geometry can be obstacles, and a group may have others.
  for (const std::string &link : linksOfGroup(live_.srdf, *snapshot.robot(), more.group))
    if (!snapshot.robot()->links().at(link).empty()) query.links.push_back(link);
  if (query.links.empty()) throw Error("group '" + more.group + "': none of its links has collision geometry");
  return query;
}

/** Throws Error for what is beyond a limit; how many bytes curves, motions and the answer take, about. */
std::size_t Queries::checkLimits(const QueryRequest &request, const Snapshot &snapshot) const {
  const NameLimits names(parameters_.max_name_length);
  names.check(request.more);
  std::size_t curves = request.curves.size() + request.paths.size(), points = 0, values = 0;
  for (const Curve &curve : request.curves) {
    names.check(curve);
    points += curve.points.size();
    for (const CurvePiece &piece : curve.pieces) points += piece.points.size() + piece.parameters.size();
  }
  for (const nav_msgs::Path &path : request.paths) {
    names.check(path);
    points += path.poses.size();
  }
  for (const auto &trajectory : request.multi_dof_trajectories) {
    names.check(trajectory);
    curves += trajectory.joint_names.size();
    for (const auto &point : trajectory.points) points += point.transforms.size();
  }
  demandAtMost("max_curves", parameters_.max_curves, curves + request.trajectories.size(), "curves");
  demandAtMost("max_control_points", parameters_.max_control_points, points, "control points");
  for (const auto &trajectory : request.trajectories) {
    names.check(trajectory);
    values += trajectory.points.size() * trajectory.joint_names.size();
  }
  for (const RobotTrajectory &robot : request.more.moving_robots)
    values += robot.trajectory.points.size() * robot.trajectory.joint_names.size();
  demandAtMost("max_control_points", parameters_.max_control_points, values, "joint values");
  demandAtMost("max_curves", parameters_.max_curves, request.more.moving_robots.size(), "moving robots");

  // With per_object the answer may be far larger than the query.
  std::size_t obstacles = 1;
  if (request.more.per_object) {
    const bool everything = request.more.objects.empty() && request.more.links.empty();
    obstacles = request.more.objects.size() + request.more.links.size();
    if (everything || !request.more.group.empty())
      obstacles += snapshot.objects().size() + snapshot.moving().size() + request.more.moving_robots.size() +
                   (snapshot.robot() ? snapshot.robot()->links().size() : 0);
  }
  const std::size_t motions =
      request.trajectories.size() + request.multi_dof_trajectories.size() + (request.more.robot_state ? 1 : 0);
  if (const auto *nearest = std::get_if<question::Nearest>(&request.question)) obstacles = nearest->limits.count;
  if (const auto *profile = std::get_if<question::Profile>(&request.question))
    obstacles = std::max(profile->intervals, profile->breaks.size());
  if (const auto *speed = std::get_if<question::Speed>(&request.question)) obstacles = speed->profile.intervals;
  if (asksFor<question::Margins>(request.question)) obstacles = DIRECTIONS * (snapshot.objects().size() + 1);
  if (asksFor<question::Violations>(request.question)) obstacles = MOST_VIOLATIONS;
  demandAtMost("max_results", parameters_.max_results, obstacles, "results");
  const bool often = !asksFor<question::Search, question::Gradient>(request.question) &&
                     request.more.self_collision; // as many rows of kind self
  const std::size_t profiles =
      (request.per_link && snapshot.robot() ? snapshot.robot()->links().size() + snapshot.attached().size() : 1) *
      (often ? 2 : 1);
  const std::size_t movers = request.more.movers ? 1 : 0;
  const std::size_t rows = (curves + motions * profiles + movers) * obstacles + motions + movers;
  demandAtMost("max_results", parameters_.max_results, rows, "results");
  constexpr std::size_t VECTOR = 3 * sizeof(double), COPIES = 2, KINDS = 2, DERIVATIVES = 3;
  std::size_t bytes = rows * ROW_BYTES + points * memory::OF_POINT + values * memory::OF_VALUE;
  if (const auto *sweep = std::get_if<question::Sweep>(&request.question)) bytes += sweep->options.memory_limit;
  if (asksFor<question::Gradient>(request.question))
    bytes += COPIES * (rows * sizeof(Gradient) + points * VECTOR + values * KINDS * DERIVATIVES * sizeof(double));
  return bytes;
}

void Queries::answer(const QueryRequest &request, QueryResponse &response, Drawing &drawing) {
  const auto begin = request.arrival;
  try {
    answerAll(request, response, drawing);
  } catch (...) {
    statistics_.record(Statistics::Clock::now() - begin, false, response.results);
    throw;
  }
  statistics_.record(Statistics::Clock::now() - begin, response.success, response.results);
}

void Queries::answerAll(const QueryRequest &request, QueryResponse &response, Drawing &drawing) {
  // One moment for all: what changes meanwhile does not change this answer.
  LiveScene::Seen seen = live_.seen();
  const SnapshotPtr snapshot = seen.snapshot;
  response.scene = live_.state(*snapshot, std::move(seen.sensors));
  live_.demand(*snapshot, request.more.scene_epoch, request.more.scene_version);
  Query query = toQuery(request, *snapshot);
  const double budget_ms = request.budget_ms != 0.0 ? request.budget_ms : tuning_.budget_ms.load();
  TimeBudget budget(budget_ms, request.arrival, stop_, request.turn, request.cancelled);
  query.allow_empty = parameters_.allow_empty;
  query.options.stop = TimeBudget::isOver;
  query.options.stop_user = &budget;
  const memory::Share share(checkLimits(request, *snapshot), mostBytes());
  if (!snapshot->robot() && !request.more.joint_state.name.empty())
    throw Error("joint_state names '" + request.more.joint_state.name.front() + "', and this server has no robot");

  const bool current = request.more.current_joints || request.more.robot_state;
  Work work{request,
            snapshot,
            toErrors(request.more.errors),
            std::move(query),
            FrameLookup(frames_, request.turn),
            currentJoints(request.more.joint_state, current && snapshot->robot(), live_.joints,
                          !request.more.robot_state && request.curves.size() == 0),
            Doubts(parameters_.max_age, snapshot, response.scene.sensors, std::move(seen.unknowns)),
            response,
            drawing,
            nullptr};
  if (request.more.certificate && !request.problems) {
    work.certificate.reset(cprox_certificate_create());
    if (!work.certificate) throw std::bad_alloc();
    work.query.options.certificate = work.certificate.get();
  }
  if (request.size() == 0 && !request.more.robot_state && !request.more.movers) {
    response.success = false;
    response.message = "nothing is asked: there is no curve, path or trajectory, no robot_state and no movers";
  }
  answerCurves(work);
  answerTrajectories(work);
  answerMultiDofTrajectories(work);
  answerState(work);
  answerMovers(work);
  if (work.search) {
    work.search->failures.tell(response);
    if (work.search->drawn) drawing.links = *work.search->drawn;
  }
  if (budget.isReached()) {
    for (Proximity &row : response.results)
      if (row.status == Proximity::STATUS_STOPPED) row.message = budget.reason();
  }
  describe(work);
  drawing.snapshot = snapshot;
}

/** What the answer was about, and what a reader should know of it. */
void Queries::describe(Work &work) const {
  QueryResponse &response = work.response;
  response.scene.transform_age = work.lookup.oldest();
  response.scene.joint_state_age = work.joints.age;
  const Query &query = work.query;
  const bool with_curves = work.search != nullptr;
  if (!query.objects.empty()) response.scene.objects = static_cast<std::uint32_t>(query.objects.size());
  if (!query.links.empty()) response.scene.links = static_cast<std::uint32_t>(query.links.size());
  if (query.objects.empty() && !query.links.empty() && with_curves) response.scene.objects = 0;
  if (!query.objects.empty() && query.links.empty() && with_curves) response.scene.links = 0;

  const auto nothing = [](const Proximity &row) {
    return (row.status == Proximity::STATUS_EMPTY || std::isinf(row.lower)) && row.b.empty();
  };
  const auto first = std::find_if(response.results.begin(), response.results.end(), nothing);
  if (first != response.results.end())
    response.warnings.push_back("row '" + first->id + "' (" + first->kind + ") was measured against nothing" +
                                (response.scene.objects == 0 ? ": there is no object" : ""));
  work.doubts.tell(response.warnings);
}

void Queries::tellProgress(Work &work) {
  ++work.done;
  if (work.request.progress) work.request.progress(work.response, work.done);
}

} // namespace curve_proximity
