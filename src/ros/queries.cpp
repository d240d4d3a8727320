/* SPDX-License-Identifier: BSD-3-Clause */
#include "queries.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <iterator>
#include <map>
#include <mutex>
#include <sstream>

#include "curve_message.h"
#include "gradient_message.h"
#include "guard.h"
#include "memory_account.h"
#include "name_limits.h"
#include "row_message.h"
#include "topics.h"

namespace curve_proximity {
namespace {

/** Curves that a thread takes at a time. */
constexpr std::size_t A_PART = 8;

/** [bytes] A curve takes no less in a request. */
constexpr std::size_t LEAST_CURVE = 128;

/** Ends a query when its time is over or the server goes, and makes way for others meanwhile. */
class TimeBudget {
 public:
  /** turn: of the thread that asks; may be null. */
  TimeBudget(double milliseconds, const QueryRequest &request, const std::atomic<bool> &stop, Turn *turn)
      : milliseconds_(milliseconds),
        deadline_(deadlineOf(request.arrival, milliseconds)),
        stop_(stop),
        cancelled_(request.cancelled),
        turn_(turn) {}

  /** In the shape of cprox_options.stop. */
  static bool isOver(void *user) {
    const TimeBudget &budget = *static_cast<const TimeBudget *>(user);
    if (budget.turn_) budget.turn_->yield();
    return budget.isReached();
  }

  /** Once reached it stays so. */
  bool isReached() const {
    return stop_ || isCancelled() || Clock::now() >= deadline_;
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

  static Clock::time_point deadlineOf(Clock::time_point arrival, double milliseconds) {
    constexpr double FOREVER = 1e12; /* [ms] decades: within what the clock can count */
    const std::chrono::duration<double, std::milli> wait(std::min(milliseconds, FOREVER));
    return arrival + std::chrono::duration_cast<Clock::duration>(wait);
  }

  bool isCancelled() const {
    return cancelled_ && *cancelled_;
  }

  const double milliseconds_;
  const Clock::time_point deadline_;
  const std::atomic<bool> &stop_;
  const std::atomic<bool> *const cancelled_;
  Turn *const turn_;
};

/** Of a row: itself, its answer in the scene's form, its bytes on the wire, names of usual length. */
constexpr std::size_t ROW_BYTES = 2 * sizeof(Proximity) + sizeof(Answer) + 512;

void limit(const char *parameter, std::size_t most, std::size_t count, const char *what) {
  if (count <= most) return;
  throw Error(std::to_string(count) + " " + what + " are more than ~" + parameter + " = " + std::to_string(most));
}

/** Everything that a query is measured against, for one stamp after the other. For one thread. */
class StampedTargets {
 public:
  StampedTargets(SnapshotPtr snapshot, const Query &query, const Srdf &srdf, const JointPositions *joints,
                 FrameLookup &lookup)
      : snapshot_(std::move(snapshot)), query_(query), srdf_(srdf), joints_(joints), lookup_(lookup) {
    const bool everything = query.objects.empty() && query.links.empty();
    if (!query.links.empty() && !snapshot_->robot())
      throw Error("link '" + query.links.front() + "': this server has no robot, only objects");
    const auto carried = [&](const std::string &id) { return snapshot_->attached().count(id) > 0; };
    carried_ =
        everything ? !snapshot_->attached().empty() : std::any_of(query.objects.begin(), query.objects.end(), carried);
    with_robot_ = snapshot_->robot() && (everything || carried_ || !query.links.empty());
  }

  bool withRobot() const {
    return with_robot_;
  }

  struct Stamped {
    LinkPoses links;
    Targets targets;
    double age; /* [s] of the transforms */
  };

  const Stamped &at(const ros::Time &stamp) {
    // Without a robot nothing depends on the stamp.
    const ros::Time key = with_robot_ ? stamp : ros::Time();
    auto found = stamped_.find(key);
    if (found == stamped_.end()) {
      lookup_.begin();
      LinkPoses links = with_robot_ ? linkPoses(stamp) : LinkPoses();
      Targets targets(snapshot_, links, query_);
      found = stamped_.emplace(key, Stamped{std::move(links), std::move(targets), lookup_.age()}).first;
    }
    return found->second;
  }

 private:
  /** From the joints of the request, if it has any; else every link by tf2. */
  LinkPoses linkPoses(const ros::Time &stamp) {
    const Robot &robot = *snapshot_->robot();
    if (joints_) return robot.linkPoses(*joints_, rootPose(robot, srdf_, stamp, lookup_));
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
  const Srdf &srdf_;
  const JointPositions *const joints_; /* null: tf2 tells */
  FrameLookup &lookup_;
  bool with_robot_ = false, carried_ = false;
  std::map<ros::Time, Stamped> stamped_;
};

/** Counts the rows that have no answer and keeps the first one's reason. */
class Failures {
 public:
  /** number: of the curve, in the order of the request. */
  void count(const Proximity &row, std::size_t number) {
    if (failed_++ == 0) first_ = "curve " + std::to_string(number) + " ('" + row.id + "'): " + row.message;
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

std::string Queries::numbered(const std::string &name, std::size_t i, std::size_t all) {
  return all == 1 ? name : name + "/" + std::to_string(i);
}

/* What a thread keeps from curve to curve. */
struct Queries::CurveScratch {
  CurveDescription curve; /* the one at hand */
  std::vector<Answer> answers;
};

/* What all curves of a request share. */
struct Queries::CurveSearch {
  StampedTargets targets;
  WorkspacePool::Lease workspace;
  CurveScratch scratch;
  std::size_t curves; /* so far */
  Failures failures;
  const LinkPoses *drawn; /* the robot of the last curve that is drawn; null: none is */
};

/* Where a curve and all that it is measured against stand. */
struct Queries::CurvePlace {
  const Eigen::Isometry3d *frame = nullptr;
  const StampedTargets::Stamped *stamped = nullptr;
  double age = NAN;    /* [s] of the transforms */
  std::string why_not; /* empty where all is known */
};

/* The rows of some curves. */
struct Queries::CurveRows {
  Proximity *in_place = nullptr; /* in the response, which has room for one a curve; null: in `rows` */
  std::vector<Proximity> rows;
  std::vector<std::size_t> counts;            /* of rows, for each curve */
  std::vector<Drawing::Line> lines;           /* of those that are drawn */
  std::vector<Profile> profiles;              /* of Asking::PROFILE: one for each row */
  std::vector<Gradient> gradients;            /* of Asking::GRADIENT likewise */
  std::vector<ViolationIntervals> violations; /* of Asking::VIOLATIONS likewise */

  /* One more, for the curve after those that are counted. */
  Proximity &add() {
    return in_place ? in_place[counts.size()] : rows.emplace_back();
  }

  void fail(const std::string &id, const std::string &why, const Asking &asking) {
    add() = toFailedRow(id, Proximity::KIND_CURVE, why);
    if (asking.kind == Asking::PROFILE) profiles.emplace_back();
    if (asking.kind == Asking::GRADIENT) gradients.emplace_back();
    if (asking.kind == Asking::VIOLATIONS) violations.emplace_back();
  }
};

QueryType queryTypeFromName(const std::string &name) {
  if (name == "distance") return QueryType::DISTANCE;
  if (name == "tolerance") return QueryType::TOLERANCE;
  if (name == "collision") return QueryType::COLLISION;
  throw Error("the query '" + name + "' is none of distance, tolerance, collision");
}

std::vector<Profile> takeProfiles(QueryResponse &answer) {
  std::vector<Profile> profiles = std::move(answer.profiles);
  for (std::size_t i = 0; i < profiles.size(); ++i) {
    Profile &profile = profiles[i];
    profile.summary = std::move(answer.results[i]);
    const std::string &status = profile.summary.status;
    if (status != Proximity::STATUS_STALE && status != Proximity::STATUS_UNKNOWN) continue;
    std::fill(profile.lower.begin(), profile.lower.end(), 0.0);
  }
  return profiles;
}

std::vector<ViolationIntervals> takeViolations(QueryResponse &answer) {
  std::vector<ViolationIntervals> violations = std::move(answer.violations);
  for (std::size_t i = 0; i < violations.size(); ++i) {
    violations[i].summary = std::move(answer.results[i]);
    for (std::string &a : violations[i].a)
      if (a.empty()) a = violations[i].summary.a; // a curve is one thing
  }
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
  const bool own_rows = request.asking.kind != Asking::ANSWER && request.asking.kind != Asking::GRADIENT;
  if (own_rows && more.per_object) throw Error("per_object does not apply: it is of distance, tolerance and collision");
  if (!more.body.id.empty() && request.paths.empty() && request.multi_dof_trajectories.empty())
    throw Error("body applies to paths and multi_dof_trajectories: there is none");
  if (more.gradient && request.asking.kind != Asking::GRADIENT)
    throw Error("gradient does not apply: it is of the service distance");
  if (more.gradient && more.per_object)
    throw Error("gradient does not apply with per_object: there is one for the nearest object");
  if (request.asking.per_link && motions == 0 && !more.robot_state)
    throw Error("per_link is about the robot along a trajectory or as it stands (robot_state): there is neither");
  if (more.self_collision && motions == 0 && !more.robot_state && !more.movers)
    throw Error("self_collision is about the robot along a trajectory or as it stands (robot_state): there is neither");
  if (!more.moving_robots.empty() && motions == 0 && !more.robot_state && !more.movers)
    throw Error("moving_robots are about trajectories, robot_state or movers: there is none of these");
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
  if (more.group.empty()) return query;
  if (!snapshot.robot()) throw Error("group '" + more.group + "': this server has no robot, only objects");

  // Of curves only links with geometry can be targets, and a group may have others.
  for (const std::string &link : linksOfGroup(live_.srdf, *snapshot.robot(), more.group))
    if (!snapshot.robot()->links().at(link).empty()) query.links.push_back(link);
  if (query.links.empty()) throw Error("group '" + more.group + "': none of its links has collision geometry");
  return query;
}

/** Throws Error for what is beyond a limit; how many bytes the answer has at most. */
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
  limit("max_curves", static_cast<std::size_t>(parameters_.max_curves), curves + request.trajectories.size(), "curves");
  limit("max_control_points", static_cast<std::size_t>(parameters_.max_control_points), points, "control points");
  for (const auto &trajectory : request.trajectories) {
    names.check("the name of a joint", trajectory.joint_names);
    values += trajectory.points.size() * trajectory.joint_names.size();
  }
  limit("max_control_points", static_cast<std::size_t>(parameters_.max_control_points), values, "joint values");

  for (const RobotTrajectory &robot : request.more.moving_robots)
    values += robot.trajectory.points.size() * robot.trajectory.joint_names.size();
  limit("max_control_points", static_cast<std::size_t>(parameters_.max_control_points), values, "joint values");
  limit("max_curves", static_cast<std::size_t>(parameters_.max_curves), request.more.moving_robots.size(),
        "moving robots");

  // With per_object the answer may be far larger than the query.
  std::size_t targets = 1;
  if (request.more.per_object) {
    const bool everything = request.more.objects.empty() && request.more.links.empty();
    targets = request.more.objects.size() + request.more.links.size();
    if (everything || !request.more.group.empty())
      targets += snapshot.objects().size() + snapshot.moving().size() + request.more.moving_robots.size() +
                 (snapshot.robot() ? snapshot.robot()->links().size() : 0);
  }
  const std::size_t motions =
      request.trajectories.size() + request.multi_dof_trajectories.size() + (request.more.robot_state ? 1 : 0);
  const Asking &asking = request.asking;
  if (asking.kind == Asking::NEAREST) targets = asking.limits.count;
  if (asking.kind == Asking::PROFILE) targets = std::max(asking.intervals, asking.breaks.size());
  if (asking.kind == Asking::VIOLATIONS) targets = MOST_VIOLATIONS;
  limit("max_results", static_cast<std::size_t>(parameters_.max_results), targets, "results");
  const bool often = asking.kind != Asking::ANSWER && asking.kind != Asking::GRADIENT &&
                     request.more.self_collision; // as many rows of kind self
  const std::size_t profiles =
      (asking.per_link && snapshot.robot() ? snapshot.robot()->links().size() + snapshot.attached().size() : 1) *
      (often ? 2 : 1);
  const std::size_t movers = request.more.movers ? 1 : 0;
  const std::size_t rows = (curves + motions * profiles + movers) * targets + motions + movers;
  limit("max_results", static_cast<std::size_t>(parameters_.max_results), rows, "results");
  constexpr std::size_t VECTOR = 3 * sizeof(double), COPIES = 2, KINDS = 2, DERIVATIVES = 3;
  std::size_t bytes = rows * ROW_BYTES;
  if (asking.kind == Asking::GRADIENT)
    bytes += COPIES * (rows * sizeof(Gradient) + points * VECTOR + values * KINDS * DERIVATIVES * sizeof(double));
  return bytes;
}

void Queries::expect(std::size_t bytes) {
  if (bytes >= MANY_CURVES * LEAST_CURVE) crew_.rouse();
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
  // One snapshot for all: what changes meanwhile does not change this answer.
  const SnapshotPtr snapshot = live_.scene.snapshot();
  response.scene = live_.state(*snapshot);
  live_.demand(*snapshot, request.more.scene_epoch, request.more.scene_version);
  Query query = toQuery(request, *snapshot);
  const double budget_ms = request.budget_ms != 0.0 ? request.budget_ms : tuning_.budget_ms.load();
  TimeBudget budget(budget_ms, request, stop_, request.turn);
  query.options.stop = TimeBudget::isOver;
  query.options.stop_user = &budget;
  const memory::Share share(checkLimits(request, *snapshot), mostBytes());
  if (!snapshot->robot() && !request.more.joint_state.name.empty())
    throw Error("joint_state names '" + request.more.joint_state.name.front() + "', and this server has no robot");

  const bool current = request.more.current_joints || request.more.robot_state;
  Work work{request,
            snapshot,
            std::move(query),
            FrameLookup(frames_, request.turn),
            currentJoints(request.more.joint_state, current && snapshot->robot(), live_.joints),
            Doubts(parameters_.max_age, response.scene.sensors, live_.lost),
            response,
            drawing,
            budget_ms,
            0,
            0,
            nullptr};
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
  drawing.query_type = request.query_type;
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

  const auto nothing = [](const Proximity &row) { return std::isinf(row.lower) && row.b.empty(); };
  const auto first = std::find_if(response.results.begin(), response.results.end(), nothing);
  if (first != response.results.end())
    response.warnings.push_back("row '" + first->id + "' (" + first->kind + ") was measured against nothing" +
                                (response.scene.objects == 0 ? ": there is no object" : ""));
  work.doubts.tell(response.warnings);
  const auto &said = response.warnings;
  for (std::string &remark : live_.remarks.get()) response.warnings.push_back(std::move(remark));
  if (live_.lost && std::find(said.begin(), said.end(), SCENE_LOST) == said.end())
    response.warnings.push_back(SCENE_LOST);
}

/** Ready for the next curve. */
Queries::CurveSearch &Queries::curveSearch(Work &work) {
  if (!work.search) {
    const bool by_joints = !work.joints.positions.empty();
    work.search.reset(new CurveSearch{StampedTargets(work.snapshot, work.query, live_.srdf,
                                                     by_joints ? &work.joints.positions : nullptr, work.lookup),
                                      WorkspacePool::Lease(workspaces_),
                                      {},
                                      0,
                                      {},
                                      nullptr});
  }
  work.doubts.objects(work.query);
  return *work.search;
}

void Queries::tellProgress(Work &work) {
  ++work.done;
  if (work.request.progress) (*work.request.progress)(work.response, work.done);
}

void Queries::answerCurves(Work &work) {
  const QueryRequest &request = work.request;
  if (request.curves.size() + request.paths.size() == 0) return;
  CurveSearch &search = curveSearch(work);
  work.response.results.reserve(request.curves.size() + request.paths.size());
  if (request.progress || request.curves.size() < MANY_CURVES) {
    for (const Curve &curve : request.curves) {
      answerCurve(curve, search, work);
      tellProgress(work);
    }
  } else {
    answerManyCurves(search, work);
  }
  for (const nav_msgs::Path &path : request.paths) {
    const auto i = static_cast<std::size_t>(&path - request.paths.begin());
    const std::string id = numbered("path", i, request.paths.size());
    if (carriesBody(request)) {
      answerPath(path, id, work);
      tellProgress(work);
      continue;
    }
    try {
      Curve curve = toCurve(path, parameters_.path_radius);
      curve.id = id;
      answerCurve(curve, search, work);
    } catch (const Error &error) {
      refuseCurve(id, error.what(), search, work);
    }
    tellProgress(work);
  }
}

Queries::CurvePlace Queries::place(const Curve &curve, CurveSearch &search, Work &work) {
  CurvePlace place;
  try {
    work.lookup.begin();
    place.frame = &work.lookup.toFixed(curve.header.frame_id, curve.header.stamp);
    const double age = work.lookup.age();
    place.stamped = &search.targets.at(curve.header.stamp);
    place.age = std::fmax(age, place.stamped->age);
  } catch (const Error &error) {
    place.why_not = error.what();
  }
  return place;
}

/** What is wrong with a curve fails its row only. Any number of threads, each with its own query and workspace. */
void Queries::search(const Curve &message, const CurvePlace &place, const Query &query, const Asking &asking,
                     bool drawn, Workspace &workspace, CurveScratch &scratch, CurveRows &out) {
  std::vector<Answer> &answers = scratch.answers;
  answers.clear();
  std::size_t count = 1;
  try {
    if (!place.why_not.empty()) throw Error(place.why_not);
    const Targets &targets = place.stamped->targets;
    toDescription(message, *place.frame, scratch.curve);
    CompiledCurve curve = compile(scratch.curve, targets.boxes(), workspace);
    if (asking.kind == Asking::GRADIENT) {
      CurveClearance clearance = clearanceGradient(targets, curve, scratch.curve, query, workspace);
      answers.push_back(std::move(clearance.answer));
      out.gradients.push_back(toMessage(clearance.gradient));
    } else {
      askCurve(targets, curve, query, asking, workspace, answers);
    }
    if (asking.kind == Asking::PROFILE) out.profiles.push_back(profileOf(targets, curve, query, asking, workspace));
    if (asking.kind == Asking::VIOLATIONS)
      out.violations.push_back(violationsOf(targets, curve, query, asking, workspace));
    for (const Answer &answer : answers) fillRow(answer, query, asking, out.add());
    count = answers.size();
    if (drawn) out.lines.push_back({std::move(curve), std::move(answers)});
  } catch (const Error &error) {
    out.fail(message.id, error.what(), asking);
  }
  out.counts.push_back(count);
}

/** Hands the rows of some curves over, in their order. */
void Queries::gather(const CurvePlace *places, CurveRows &&found, CurveSearch &search, Work &work) {
  Proximity *row = found.in_place ? found.in_place : found.rows.data();
  for (const std::size_t count : found.counts) {
    const CurvePlace &place = *places++;
    work.doubts.ages(place.age, search.targets.withRobot() ? work.joints.age : NAN);
    for (std::size_t i = 0; i < count; ++i, ++row) {
      work.doubts.apply(*row);
      if (std::isnan(row->lower)) search.failures.count(*row, search.curves);
      if (!found.in_place) work.response.results.push_back(std::move(*row));
    }
    ++search.curves;
    if (place.stamped && work.drawing.hasRoom()) search.drawn = &place.stamped->links;
  }
  std::move(found.lines.begin(), found.lines.end(), std::back_inserter(work.drawing.lines));
  std::move(found.profiles.begin(), found.profiles.end(), std::back_inserter(work.response.profiles));
  std::move(found.gradients.begin(), found.gradients.end(), std::back_inserter(work.response.gradients));
  std::move(found.violations.begin(), found.violations.end(), std::back_inserter(work.response.violations));
}

void Queries::answerCurve(const Curve &message, CurveSearch &search, Work &work) {
  if (work.request.turn) work.request.turn->yield();
  const CurvePlace where = place(message, search, work);
  CurveRows found;
  Queries::search(message, where, work.query, work.request.asking, work.drawing.hasRoom(), *search.workspace,
                  search.scratch, found);
  gather(&where, std::move(found), search, work);
}

/** The row of what could not be made a curve. */
void Queries::refuseCurve(const std::string &id, const std::string &why, CurveSearch &search, Work &work) {
  CurveRows found;
  found.fail(id, why, work.request.asking);
  found.counts.push_back(1);
  const CurvePlace nowhere;
  gather(&nowhere, std::move(found), search, work);
}

/* Parts of a request's curves that several threads answer. It outlives the request where a thread comes too late. */
struct Queries::SharedRows {
  explicit SharedRows(std::size_t n) : parts(n) {}

  /* The next part that nobody has begun; the request then waits until finish() is called for it. */
  bool claim(std::size_t &part) {
    part = next++;
    return part < parts.size();
  }

  void finish() {
    const std::lock_guard<std::mutex> lock(mutex);
    if (++finished == parts.size()) all_finished.notify_all();
  }

  /* The part at hand cannot be answered, and no other shall be. */
  void fail(const std::string &why) {
    {
      const std::lock_guard<std::mutex> lock(mutex);
      failure = why;
    }
    finish();
    for (std::size_t part; claim(part);) finish();
  }

  /* turn: may be null. */
  void wait(Turn *turn) {
    const auto done = [this] { return finished == parts.size(); };
    // A part takes some 20 us: to sleep meanwhile, and to be woken, takes longer.
    const auto soon = std::chrono::steady_clock::now() + std::chrono::microseconds(100);
    while (std::chrono::steady_clock::now() < soon) {
      if (done()) return;
      std::this_thread::yield();
    }
    std::unique_lock<std::mutex> lock(mutex);
    if (all_finished.wait_for(lock, std::chrono::milliseconds(1), done)) return;
    lock.unlock();
    const Turn::Pause pause(turn); // one that is not done may wait for a turn
    lock.lock();
    all_finished.wait(lock, done);
  }

  std::vector<CurveRows> parts;
  std::atomic<std::size_t> next{0};
  std::mutex mutex;
  std::condition_variable all_finished;
  std::atomic<std::size_t> finished{0};
  std::string failure;
};

/** By several threads, as long as turns are free: each takes the next few curves. */
void Queries::answerManyCurves(CurveSearch &search, Work &work) {
  const List<Curve> &curves = work.request.curves;
  std::vector<CurvePlace> places;
  places.reserve(curves.size());
  for (const Curve &curve : curves) {
    const Curve *before = places.empty() ? nullptr : &curve - 1;
    const bool same =
        before && before->header.frame_id == curve.header.frame_id && before->header.stamp == curve.header.stamp;
    if (same) {
      places.push_back(places.back());
    } else {
      places.push_back(place(curve, search, work));
    }
  }

  const Asking &asking = work.request.asking;
  std::vector<Proximity> &results = work.response.results;
  const std::size_t before = results.size();
  const std::size_t most_drawn = work.drawing.most_lines;
  const bool one_row_each = !work.query.per_object && asking.kind != Asking::NEAREST;
  if (one_row_each) results.resize(before + curves.size());
  const auto rows = std::make_shared<SharedRows>((curves.size() + A_PART - 1) / A_PART);
  const auto answerParts = [&, rows = rows.get()](std::size_t part, const Query &query, Turn *turn,
                                                  Workspace &workspace, CurveScratch &scratch) {
    for (bool claimed = true; claimed;) {
      const std::size_t first = part * A_PART, last = std::min(first + A_PART, curves.size());
      CurveRows &out = rows->parts[part];
      if (one_row_each) out.in_place = &results[before + first];
      out.counts.reserve(last - first);
      if (first < most_drawn) out.lines.reserve(last - first);
      for (std::size_t i = first; i < last; ++i) {
        if (turn) turn->yield();
        Queries::search(curves.begin()[i], places[i], query, asking, i < most_drawn, workspace, scratch, out);
      }
      claimed = rows->claim(part); // before the request may go on without this thread
      rows->finish();
    }
  };
  const auto fail = [rows](const std::string &why) { rows->fail(why); };

  // What belongs to this request is touched by those alone that it waits for: they have claimed a part.
  Turn *const own = work.request.turn;
  const auto help = [&, this](std::size_t part, Turn *turn) {
    TimeBudget budget(work.budget_ms, work.request, stop_, turn);
    Query query = work.query;
    query.options.stop_user = &budget;
    const WorkspacePool::Lease workspace(workspaces_);
    CurveScratch scratch;
    answerParts(part, query, turn, *workspace, scratch);
  };
  const std::size_t most = own ? std::min(crew_.most(), 2 * curves.size() / MANY_CURVES - 1) : 0;
  for (std::size_t i = 0; i < most; ++i) {
    const bool offered = crew_.offer([rows, fail, &help, others = own->others()] {
      if (rows->next >= rows->parts.size()) return;
      const std::unique_ptr<Turn> turn = others();
      std::size_t part = 0;
      if (turn && rows->claim(part)) guarded([&] { help(part, turn.get()); }, fail);
    });
    if (!offered) break;
  }
  guarded(
      [&] {
        std::size_t part = 0;
        if (rows->claim(part)) answerParts(part, work.query, own, *search.workspace, search.scratch);
      },
      fail);
  rows->wait(own);
  if (!rows->failure.empty()) {
    results.resize(before);
    throw Error(rows->failure);
  }
  for (std::size_t part = 0; part < rows->parts.size(); ++part)
    gather(&places[part * A_PART], std::move(rows->parts[part]), search, work);
}

} // namespace curve_proximity
