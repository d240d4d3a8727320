/* SPDX-License-Identifier: BSD-3-Clause */
#include "server.h"

#include <curve_proximity/ClearanceProfile.h>
#include <curve_proximity/Collision.h>
#include <curve_proximity/Distance.h>
#include <curve_proximity/LimitSpeed.h>
#include <curve_proximity/ListLinkPairs.h>
#include <curve_proximity/ListMargins.h>
#include <curve_proximity/ListViolations.h>
#include <curve_proximity/NearestPairs.h>
#include <curve_proximity/SweepVolume.h>
#include <curve_proximity/TimeOfContact.h>
#include <curve_proximity/Tolerance.h>
#include <ros/console.h>
#include <ros/this_node.h>

#include <algorithm>
#include <boost/algorithm/string/join.hpp>
#include <chrono>
#include <curve_proximity/nearest_name.hpp>
#include <optional>
#include <thread>
#include <type_traits>
#include <utility>

#include "../scene/yaml/scene_change.h"
#include "messages/scene_message.h"
#include "queries/link_pairs.h"
#include "transport/checked_stream.h"
#include "transport/guard.h"
#include "transport/memory_account.h"
#include "transport/request_limits.h"
#include "world/robot_description.h"

namespace curve_proximity {
namespace {

/** How long the end waits for stopped queries to hand their answers over. */
constexpr std::chrono::milliseconds FAREWELL{1000};

/** … and how long roscpp may then take to write them. */
constexpr std::chrono::milliseconds LAST_WRITE{50};

/** Objects that may wait on ~collision_object while one is being made. */
constexpr std::uint32_t OBJECTS_KEPT = 1000;

/** Changes of more bytes than this take turns among themselves, so many at a time. */
constexpr std::size_t LARGE_CHANGE = std::size_t{1} << 20;
constexpr int LARGE_CHANGES = 1;

/** What a request takes in memory, for a byte on the wire: its bytes and its message, its curves compiled or its shapes
 *  with their trees. */
constexpr std::size_t QUERY_TIMES_WIRE = 8, SCENE_TIMES_WIRE = 5;

/** Throws ParameterError where its shapes are none. */
void checkPathBody(const Parameters &parameters) {
  try {
    for (const ShapeDescription &shape : parameters.path_body.shapes)
      makeGeometry(shape, resourceOptions("", parameters));
  } catch (const Error &error) {
    throw ParameterError(std::string("parameter ~path_body: ") + error.what());
  }
}

/** Of a request that has one. */
template <class Request>
auto deltaOf(const Request &request, int) -> decltype(request.delta) {
  return request.delta;
}
template <class Request>
double deltaOf(const Request &, long) {
  return 0.0;
}

template <class Request>
Question questionOf(const Request &) {
  return question::Search{};
}
Question questionOf(const Distance::Request &request) {
  if (request.query.gradient) return question::Gradient{};
  return question::Search{};
}
Question questionOf(const NearestPairs::Request &request) {
  if (!(request.within >= 0.0)) throw Error("within is " + std::to_string(request.within) + ": it must be at least 0");
  question::Nearest out;
  if (request.count != 0) out.limits.count = request.count;
  if (request.within > 0.0) out.limits.within = request.within;
  return out;
}
Question questionOf(const TimeOfContact::Request &) {
  return question::Contact{};
}
Question questionOf(const ClearanceProfile::Request &request) {
  if (request.intervals != 0 && !request.breaks.empty()) throw Error("give intervals or breaks, not both");
  if (request.breaks.size() == 1) throw Error("breaks has one value: two make an interval");
  if (!(request.horizon >= 0.0))
    throw Error("horizon is " + std::to_string(request.horizon) + ": it must be at least 0");
  question::Profile out;
  if (request.intervals != 0) out.intervals = request.intervals;
  out.breaks = request.breaks;
  if (request.horizon > 0.0) out.horizon = request.horizon;
  return out;
}
Question questionOf(const ListViolations::Request &request) {
  if (!(request.resolution >= 0.0 && std::isfinite(request.resolution)))
    throw Error("resolution is " + std::to_string(request.resolution) + ": it must be at least 0 and finite");
  return question::Violations{request.resolution};
}

Question questionOf(const LimitSpeed::Request &request) {
  const std::pair<const char *, double> no_default[] = {{"person_speed", request.person_speed},
                                                        {"reaction_time", request.reaction_time},
                                                        {"stopping_time", request.stopping_time}};
  for (const auto &[name, value] : no_default)
    if (!(value > 0.0)) throw Error(std::string(name) + " is " + std::to_string(value) + ": it must be above 0");
  if (request.query.objects.empty()) throw Error("objects is empty: it names the objects in which persons may be");
  question::Speed out;
  out.separation = {request.person_speed,
                    request.reaction_time,
                    request.stopping_time,
                    request.intrusion,
                    request.person_position,
                    request.robot_position,
                    {}};
  if (request.robot_speed != 0.0) out.separation.robot_speed = request.robot_speed;
  if (request.intervals != 0) out.profile.intervals = request.intervals;
  return out;
}
Question questionOf(const ListMargins::Request &request) {
  question::Margins out;
  if (request.within != 0.0) out.within = request.within;
  return out;
}
Question questionOf(const SweepVolume::Request &request) {
  question::Sweep out;
  if (request.resolution != 0.0) out.options.resolution = request.resolution;
  out.options.inside = request.inside != 0;
  out.options.threads = 1; // the turn is this thread's
  out.options.memory_limit = std::size_t{256} << 20;
  return out;
}

template <class Response>
void deliver(const QueryRequest &, QueryResponse &answer, Response &response) {
  response.results = std::move(answer.results);
}
void deliver(const QueryRequest &request, QueryResponse &answer, Distance::Response &response) {
  if (asksFor<question::Gradient>(request.question)) response.gradients = answer.takeDetails<Gradient>();
  response.results = std::move(answer.results);
}
void deliver(const QueryRequest &, QueryResponse &answer, ClearanceProfile::Response &response) {
  response.profiles = takeSummed<Profile>(answer);
}
void deliver(const QueryRequest &, QueryResponse &answer, LimitSpeed::Response &response) {
  response.limits = takeSpeeds(answer);
}
void deliver(const QueryRequest &, QueryResponse &answer, ListMargins::Response &response) {
  response.margins = takeSummed<ObjectMargins>(answer);
}
void deliver(const QueryRequest &, QueryResponse &answer, SweepVolume::Response &response) {
  response.volumes = takeSummed<SweptCells>(answer);
}
void deliver(const QueryRequest &, QueryResponse &answer, ListViolations::Response &response) {
  response.violations = takeViolations(answer);
}

/** Once, here: not in every answer. */
void warnOfOtherLinks(const LiveScene &live) {
  const std::shared_ptr<const Robot> robot = live.scene.snapshot()->robot();
  if (!robot) return;
  const std::string names = boost::algorithm::join(unknownLinks(live.srdf, *robot), ", ");
  if (!names.empty())
    ROS_WARN("the SRDF disables links that robot '%s' does not have: %s", robot->name().c_str(), names.c_str());
}

/** By the joints of the request, else by tf2, else by the latest joint states. */
Eigen::Isometry3d linkPose(const std::string &link, const ros::Time &stamp, const sensor_msgs::JointState &given,
                           const Parameters &parameters, const LiveScene &live, const Snapshot &snapshot,
                           FrameLookup &lookup) {
  const Robot *robot = snapshot.robot().get();
  if (!robot) throw Error("link '" + link + "' is unknown: this server has no robot");
  if (robot->links().count(link) == 0)
    throw Error("robot '" + robot->name() + "' has no link '" + link + "'" + didYouMean(link, namesOf(robot->links())));
  const bool by_joints = !given.name.empty();
  if (!by_joints && (lookup.frames().has(link, stamp) || live.joints.joints().empty()))
    return lookup.toFixed(link, stamp);
  const CurrentJoints joints = currentJoints(given, !by_joints, live.joints);
  const std::string unknown = unknownJoints(*robot, {}, joints.positions, parameters.assumed_joints, link);
  if (!unknown.empty()) throw Error("link '" + link + "': " + unknown);
  return robot->linkPoses(joints.positions, rootPose(*robot, live.srdf, stamp, lookup)).at(link);
}

/** Nothing of the scene before is left. */
bool replacesScene(const SceneChange &change) {
  return change.clear ||
         std::any_of(change.operations.begin(), change.operations.end(), [](const Operation &operation) {
           return operation.kind == Operation::Kind::REMOVE && operation.object.id.empty();
         });
}

std::shared_ptr<const SecondOpinions> secondOpinions(const Parameters &parameters) {
  const std::optional<Peer> peer = peerFromName(parameters.second_opinion);
  return peer ? std::make_shared<const SecondOpinions>(*peer, resourceOptions("", parameters)) : nullptr;
}

} // namespace

ProximityServer::ProximityServer(const ros::NodeHandle &handle, const Parameters &parameters)
    : parameters_(parameters),
      tuning_(parameters_),
      requests_(static_cast<std::size_t>(parameters_.max_waiting) + 1),
      handle_(onQueue(handle, requests_)),
      objects_handle_(onQueue(handle, objects_queue_)),
      control_handle_(onQueue(handle, control_queue_)),
      turns_(parameters_.threads),
      scene_turns_(LARGE_CHANGES),
      frames_(parameters_.fixed_frame, parameters_.tf_timeout, stop_),
      live_(loadRobot(handle, parameters_), loadSrdf(handle, parameters_), resourceOptions("", parameters_)),
      state_file_(handle, parameters_, live_),
      queries_(parameters_, tuning_, live_, frames_, statistics_, stop_,
               loadFurtherRobots(handle, parameters_, live_.scene.snapshot()->robot(), live_.srdf),
               secondOpinions(parameters_)),
      constraints_(parameters_, live_, frames_, queries_.robots()),
      pairs_(parameters_, tuning_, statistics_, secondOpinions(parameters_)) {
  memory::setLimit(static_cast<std::size_t>(parameters_.memory_limit_mb) << 20);
  warnOfOtherLinks(live_);
  checkPathBody(parameters_);
  loadScene();
  restoreScene();
  live_.sensors.appeared = live_.unknowns.changed = [this] { state_file_.changed(); };
  state_file_.watch();
  markers_ = std::make_unique<MarkerPublisher>(
      control_handle_, live_.scene, parameters_.fixed_frame,
      MarkerResources{resourceOptions("", parameters_), resourceOptions(parameters_.urdf_dir, parameters_)});
  sensors_ = std::make_unique<Sensors>(handle, parameters_, live_, frames_);
  serveQueries<Distance>("distance", QueryType::DISTANCE);
  serveQueries<Tolerance>("tolerance", QueryType::TOLERANCE);
  serveQueries<Collision>("collision", QueryType::COLLISION);
  serveQueries<NearestPairs>("nearest_pairs", QueryType::DISTANCE);
  serveQueries<TimeOfContact>("time_of_contact", QueryType::COLLISION);
  serveQueries<ClearanceProfile>("clearance_profile", QueryType::DISTANCE);
  serveQueries<ListViolations>("violations", QueryType::TOLERANCE);
  serveQueries<LimitSpeed>("speed_limits", QueryType::DISTANCE);
  serveQueries<ListMargins>("margins", QueryType::TOLERANCE);
  serveQueries<SweepVolume>("swept_volume", QueryType::DISTANCE);
  serve<ApplyScene>("apply_scene", SCENE_TIMES_WIRE,
                    [this](const Call &call, auto &request, auto &response) { applyScene(call, request, response); });
  serve<GetScene>("get_scene", QUERY_TIMES_WIRE,
                  [this](const Call &, auto &request, auto &response) { getScene(request, response); });
  serve<EvaluateConstraints>("evaluate_constraints", SCENE_TIMES_WIRE,
                             [this](const Call &call, auto &request, auto &response) {
                               Turn turn(turns_, call.client, waitUntil(call));
                               response.frame_id = frames_.fixedFrame();
                               const TimeBudget budget(tuning_.budget_ms, call.arrival, stop_, &turn, call.isGone);
                               constraints_.answer(request, response, budget, &turn);
                             });
  serve<MeasurePairs>("measure_pairs", SCENE_TIMES_WIRE, [this](const Call &call, auto &request, auto &response) {
    Turn turn(turns_, call.client, waitUntil(call));
    TimeBudget budget(tuning_.budget_ms, call.arrival, stop_, &turn, call.isGone);
    pairs_.answer(request, response, budget);
  });
  serve<ListLinkPairs>("collision_matrix", SCENE_TIMES_WIRE, [this](const Call &call, auto &request, auto &response) {
    Turn turn(turns_, call.client, waitUntil(call));
    const double budget_ms = request.budget_ms != 0.0 ? request.budget_ms : tuning_.budget_ms.load();
    if (!(budget_ms > 0.0)) throw Error("budget_ms is " + std::to_string(budget_ms) + ": it must be at least 0");
    TimeBudget budget(budget_ms, call.arrival, stop_, &turn, call.isGone);
    cprox_options options = CPROX_OPTIONS_DEFAULT;
    options.epsilon = tuning_.epsilon;
    options.max_nodes = static_cast<std::uint32_t>(tuning_.max_nodes.load());
    answerLinkPairs(request, response, live_, options, parameters_.max_results, budget);
  });
  ros::SubscribeOptions topics[] = {
      checkedSubscription<CollisionObject, const ObjectEvent &>(
          "collision_object", OBJECTS_KEPT, [this](const ObjectEvent &event) { takeObject(event); }),
      checkedSubscription<AttachedCollisionObject>(
          "attached_collision_object", OBJECTS_KEPT,
          [this](const AttachedCollisionObjectConstPtr &object) { takeAttached(object); })};
  for (ros::SubscribeOptions &topic : topics) objects_.push_back(objects_handle_.subscribe(topic));
  planning_scene_ = std::make_unique<PlanningSceneTopic>(
      handle, parameters_, live_, frames_,
      [this](SceneChange &change, const Snapshot &before) { return applyChange(change, before); },
      [this](const std::string &link, const JointPositions &joints, const Snapshot &snapshot, FrameLookup &lookup) {
        sensor_msgs::JointState given;
        for (const auto &[name, position] : joints) {
          given.name.push_back(name);
          given.position.push_back(position);
        }
        return linkPose(link, ros::Time(), given, parameters_, live_, snapshot, lookup);
      });
  pipeline_ = std::make_unique<Pipeline>(handle, parameters_, tuning_, live_, queries_, *markers_, stop_);
  batches_ = std::make_unique<BatchAction>(control_handle_, parameters_.fixed_frame, queries_, turns_, stop_);
  diagnostics_ =
      std::make_unique<Diagnostics>(control_handle_, statistics_, turns_, *pipeline_, *planning_scene_, live_);
  reconfigure_ =
      std::make_unique<Reconfigure>(control_handle_, tuning_, [this](int threads) { turns_.setSlots(threads); });
  for (ThreadedQueue *queue : std::initializer_list<ThreadedQueue *>{&control_queue_, &objects_queue_, &requests_})
    queue->start();
  const SnapshotPtr snapshot = live_.scene.snapshot();
  ROS_INFO("ready: %zu links, %zu objects%s%s, %zu services", snapshot->robot() ? snapshot->robot()->links().size() : 0,
           snapshot->objects().size() + snapshot->moving().size(), parameters_.scene_file.empty() ? "" : " of ",
           parameters_.scene_file.c_str(), services_.size());
}

ProximityServer::~ProximityServer() {
  // Running queries end with what they have; their answers leave while the services still stand.
  stop_ = true;
  local_.end();
  const bool busy = requests_.running() > 0;
  const auto deadline = std::chrono::steady_clock::now() + FAREWELL;
  while (requests_.running() > 0 && std::chrono::steady_clock::now() < deadline)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  if (busy) std::this_thread::sleep_for(LAST_WRITE);

  // No new calls, then no thread in a callback, then nothing left that names this object.
  for (ros::ServiceServer &service : services_) service.shutdown();
  for (ros::Subscriber &subscriber : objects_) subscriber.shutdown();
  for (ThreadedQueue *queue : std::initializer_list<ThreadedQueue *>{&control_queue_, &objects_queue_, &requests_})
    queue->end();
  reconfigure_.reset();
  diagnostics_.reset();
  batches_.reset();
  pipeline_.reset();
  planning_scene_.reset();
  sensors_.reset();
  markers_.reset();
}

/** Everything that a handler does happens in here: what it throws becomes a message. A request that cannot be read
 * fails the call, by roscpp. times_wire: what it takes in memory, for a byte on the wire. */
template <class Service, class Work>
void ProximityServer::serve(const char *name, std::size_t times_wire, Work work) {
  using Helper = ServiceHelper<Service>;
  const auto handler = [this, times_wire, work](const Call &call, const typename Helper::Read &read,
                                                typename Helper::Response &response) {
    std::optional<memory::Share> share;
    bool admitted = false;
    answered(response, [&] {
      if (stop_) throw Error("the server is shutting down");
      share.emplace(times_wire * call.bytes, requestLimit());
      admitted = true;
    });
    if (!admitted) return;
    typename Helper::Request request;
    read(request);
    answered(response, [&] { work(call, request, response); });
  };
  services_.push_back(advertise<Service>(handle_, name, handler));
  local_.add<Service>(services_.back().getService(), handler);
}

std::size_t ProximityServer::requestLimit() const {
  return static_cast<std::size_t>(parameters_.max_request_mb) << 20;
}

/** How long the request may wait for a turn. The last one that may run does not wait: it refuses further ones. */
Turns::Clock::time_point ProximityServer::waitUntil(const Call &call) {
  if (!call.in_process && requests_.isFull()) return call.arrival;
  return TimeBudget::after(call.arrival, parameters_.max_wait_ms);
}

template <class Service>
void ProximityServer::serveQueries(const char *name, QueryType query_type) {
  const auto work = [this, query_type](const Call &call, typename Service::Request &asked,
                                       typename Service::Response &response) {
    response.frame_id = frames_.fixedFrame();
    Turn turn(turns_, call.client, waitUntil(call));
    QueryRequest request(query_type, deltaOf(asked, 0), asked.query);
    request.question = questionOf(asked);
    if constexpr (std::is_same_v<Service, ClearanceProfile>) request.per_link = asked.per_link != 0;
    request.budget_ms = asked.query.budget_ms;
    request.arrival = call.arrival;
    request.turn = &turn;
    request.cancelled = call.isGone;
    QueryResponse answer;
    auto drawing = std::make_shared<Drawing>();
    if (!markers_->isWatched()) drawing->most_lines = 0;
    queries_.answer(request, answer, *drawing);
    response.success = answer.success;
    response.message = std::move(answer.message);
    response.warnings = std::move(answer.warnings);
    response.scene = std::move(answer.scene);
    deliver(request, answer, response);
    markers_->show(std::move(drawing));
  };
  serve<Service>(name, QUERY_TIMES_WIRE, work);
}

/** Objects come in any frame; what is wrong with one is told, and the others are applied. */
std::vector<std::string> ProximityServer::apply(const ApplyScene::Request &request, bool replaces_srdf) {
  NameLimits(parameters_.max_name_length).check(request);
  FrameLookup lookup(frames_);
  std::vector<std::string> faults;
  const SnapshotPtr before = live_.scene.snapshot();
  const ToFixed to_fixed = [&](const std_msgs::Header &header) {
    return lookup.toFixed(header.frame_id, header.stamp);
  };
  const LinkToFixed link_to_fixed = [&](const std::string &link, const ros::Time &stamp) {
    return linkPose(link, stamp, request.joint_state, parameters_, live_, *before, lookup);
  };
  SceneChange change = toSceneChange(request, to_fixed, faults);
  addAttachments(request, to_fixed, link_to_fixed, *before, change, faults);
  change.clear_allowed = replaces_srdf;
  for (std::string &fault : applyChange(change, *before)) faults.push_back(std::move(fault));
  if (faults.empty() && replacesScene(change)) live_.unknowns.forget(LOST_SCENE);
  return faults;
}

/** Within ~scene_budget_ms; `before`: the scene that the change was made for. */
std::vector<std::string> ProximityServer::applyChange(SceneChange &change, const Snapshot &before) {
  const TimeBudget budget(parameters_.scene_budget_ms, TimeBudget::Clock::now(), stop_, nullptr, {});
  change.stop = [&] { return budget.isReached(); };
  std::vector<std::string> faults = live_.apply(change, before);
  state_file_.changed();
  return faults;
}

void ProximityServer::applyScene(const Call &call, ApplyScene::Request &request, ApplyScene::Response &response) {
  // Small changes pass by the large ones.
  std::optional<Turn> turn;
  if (call.bytes > LARGE_CHANGE) turn.emplace(scene_turns_, call.client, waitUntil(call));
  const std::vector<std::string> faults = apply(request);
  response.success = faults.empty();
  response.message = boost::algorithm::join(faults, "; ");
  response.scene = live_.state();
}

/** As ~apply_scene with one object; there is nobody to be told but the log. */
template <class Fill>
void ProximityServer::changeScene(const char *topic, Fill &&fill) {
  std::string id, about;
  const auto warn = [&](const std::string &why) {
    ROS_ERROR("%s: %s", topic, why.c_str());
    live_.refuse(topic, id, about, why, static_cast<std::size_t>(parameters_.max_name_length));
  };
  guarded(
      [&] {
        ApplyScene::Request request;
        id = fill(request);
        if (request.attached_collision_objects.empty()) about = id; // else it is about the robot
        const memory::Share share(SCENE_TIMES_WIRE * ros::serialization::serializationLength(request), requestLimit());
        for (const std::string &fault : apply(request)) warn(fault);
      },
      warn);
}

/** roscpp numbers the messages that a publisher sends over a connection: one that is left out was lost, because more
 *  than OBJECTS_KEPT came at once. */
void ProximityServer::countObject(const std::string &publisher, std::uint32_t number) {
  constexpr std::size_t MOST = 1000;
  if (publisher == ros::this_node::getName()) return; // those are not numbered
  if (last_objects_.size() > MOST) last_objects_.clear();
  std::uint32_t &last = last_objects_.emplace(publisher, number).first->second;
  if (number > last && number - last > 1) {
    const std::string why = "~collision_object: messages of " + publisher +
                            " were lost, as too many came at once: send the whole scene again (clear: true)";
    ROS_ERROR("%s", why.c_str());
    live_.unknowns.set(REFUSED_OBJECTS, {{why, "", Missing::ANYTHING}});
  }
  last = number;
}

void ProximityServer::takeObject(const ObjectEvent &event) {
  const CollisionObjectConstPtr object = event.getMessage();
  countObject(event.getPublisherName(), object->header.seq);
  changeScene("~collision_object", [&](ApplyScene::Request &request) {
    request.objects.push_back(*object);
    return object->id;
  });
}

void ProximityServer::takeAttached(const AttachedCollisionObjectConstPtr &object) {
  changeScene("~attached_collision_object", [&](ApplyScene::Request &request) {
    request.attached_collision_objects.push_back(*object);
    return object->object.id;
  });
}

/** The scene of ~scene_file: all of it, or no start. */
void ProximityServer::loadScene() {
  if (parameters_.scene_file.empty()) return;
  std::string why;
  try {
    yaml::Warnings warnings;
    const yaml::SceneFile file = yaml::readScene(parameters_.scene_file, warnings);
    const std::vector<std::string> faults = apply(toMessage(yaml::toChange(file, parameters_.scene_file, warnings)));
    for (const std::string &warning : warnings.messages()) ROS_WARN("~scene_file: %s", warning.c_str());
    why = boost::algorithm::join(faults, "; ");
  } catch (const std::exception &error) {
    why = error.what();
  }
  if (!why.empty()) throw ParameterError("parameter ~scene_file: " + why);
}

/** The scene of the server before this one, within the same run. */
void ProximityServer::restoreScene() {
  const std::optional<KeptScene> kept = state_file_.read();
  if (!kept) return;
  const std::vector<std::string> faults = apply(kept->request, kept->replaces_srdf);
  for (const std::string &fault : faults) ROS_WARN("of the scene before the restart: %s", fault.c_str());
  for (const auto &[source, unknowns] : kept->unknowns) live_.unknowns.set(source, unknowns);
  if (kept->behind || !faults.empty()) state_file_.lose();
  for (const std::string &id : kept->sensors) live_.sensors.awaits(id);
  ROS_INFO("the scene is as before the restart: %zu objects; of sensors %zu are awaited",
           live_.scene.snapshot()->objects().size(), kept->sensors.size());
}

void ProximityServer::getScene(const GetScene::Request &request, GetScene::Response &response) {
  LiveScene::Seen seen = live_.seen();
  toMessage(*seen.snapshot, request.ids, response);
  for (CollisionObject &object : response.objects) object.header.frame_id = frames_.fixedFrame();
  response.scene = live_.state(*seen.snapshot, std::move(seen.sensors));
  response.frame_id = frames_.fixedFrame();
  response.success = true;
}

std::vector<Problem> ProximityServer::problems(const ProximityQuery &query) {
  std::vector<Problem> out;
  QueryRequest request(QueryType::TOLERANCE, 0.0, query);
  request.problems = &out;
  QueryResponse unused;
  Drawing drawing;
  drawing.most_lines = 0;
  queries_.answer(request, unused, drawing);
  return out;
}

} // namespace curve_proximity
