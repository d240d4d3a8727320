/* SPDX-License-Identifier: BSD-3-Clause */
#include "server.h"

#include <ros/console.h>

#include <chrono>
#include <thread>
#include <utility>

#include "../scene/yaml/scene_change.h"
#include "conversions.h"
#include "guard.h"
#include "robot_description.h"

namespace curve_proximity {
namespace {

/** How long the end waits for stopped queries to hand their answers over. */
constexpr std::chrono::milliseconds FAREWELL{1000};

/** … and how long roscpp may then take to write them. */
constexpr std::chrono::milliseconds LAST_WRITE{50};

/** Objects that may wait on ~collision_object while one is being made. */
constexpr std::uint32_t OBJECTS_KEPT = 1000;

ros::NodeHandle onQueue(const ros::NodeHandle &handle, ros::CallbackQueue &queue) {
  ros::NodeHandle own(handle);
  own.setCallbackQueue(&queue);
  return own;
}

/** A request about curves alone leaves the trajectory as it is made. */
List<trajectory_msgs::JointTrajectory> trajectoriesOf(const trajectory_msgs::JointTrajectory &trajectory) {
  const bool none = trajectory.joint_names.empty() && trajectory.points.empty();
  return {&trajectory, none ? std::size_t{0} : std::size_t{1}};
}

std::string joined(const std::vector<std::string> &sentences) {
  std::string text;
  for (const std::string &sentence : sentences) text += (text.empty() ? "" : "; ") + sentence;
  return text;
}

} // namespace

ProximityServer::ProximityServer(const ros::NodeHandle &handle, const Parameters &parameters)
    : parameters_(parameters),
      tuning_(parameters_),
      handle_(onQueue(handle, queue_)),
      control_handle_(onQueue(handle, control_queue_)),
      frames_(parameters_.fixed_frame, parameters_.tf_timeout, stop_),
      srdf_(loadSrdf(handle, parameters_)),
      scene_(loadRobot(handle, parameters_), resourceOptions("", parameters_.max_shape_mb), allowedPairs(srdf_)),
      queries_(parameters_, tuning_, scene_, srdf_, frames_, statistics_, stop_),
      constraints_(parameters_, scene_, frames_, stop_) {
  loadScene();
  markers_ = std::make_unique<MarkerPublisher>(
      control_handle_, scene_, parameters_.fixed_frame,
      MarkerResources{resourceOptions("", parameters_.max_shape_mb),
                      resourceOptions(parameters_.urdf_dir, parameters_.max_shape_mb)});
  sensors_ = std::make_unique<Sensors>(handle, parameters_, scene_, frames_);
  services_ = {handle_.advertiseService("distance", &ProximityServer::distance, this),
               handle_.advertiseService("tolerance", &ProximityServer::tolerance, this),
               handle_.advertiseService("collision", &ProximityServer::collision, this),
               handle_.advertiseService("apply_scene", &ProximityServer::applyScene, this),
               handle_.advertiseService("get_scene", &ProximityServer::getScene, this),
               handle_.advertiseService("evaluate_constraints", &ProximityServer::evaluateConstraints, this)};
  objects_ = {handle_.subscribe("collision_object", OBJECTS_KEPT, &ProximityServer::takeObject, this),
              handle_.subscribe("attached_collision_object", OBJECTS_KEPT, &ProximityServer::takeAttached, this)};
  pipeline_ = std::make_unique<Pipeline>(handle, parameters_, tuning_, scene_, srdf_, queries_, *markers_, stop_);
  batches_ = std::make_unique<BatchAction>(control_handle_, parameters_.fixed_frame, queries_, stop_);
  diagnostics_ = std::make_unique<Diagnostics>(control_handle_, statistics_, *pipeline_, *sensors_, frames_, scene_);
  reconfigure_ = std::make_unique<Reconfigure>(control_handle_, tuning_, [this](int threads) { setThreads(threads); });
  setThreads(parameters_.threads);
  control_spinner_ = std::make_unique<ros::AsyncSpinner>(1, &control_queue_);
  control_spinner_->start();
}

/** Ends a thread only when its request has been answered; the others go on. */
void ProximityServer::setThreads(int threads) {
  const auto wanted = static_cast<std::size_t>(threads);
  while (spinners_.size() > wanted) {
    spinners_.back()->stop();
    spinners_.pop_back();
  }
  while (spinners_.size() < wanted) {
    spinners_.push_back(std::make_unique<ros::AsyncSpinner>(1, &queue_));
    spinners_.back()->start();
  }
}

ProximityServer::~ProximityServer() {
  // Running queries end with what they have; their answers leave while the services still stand.
  stop_ = true;
  const bool busy = running_ > 0;
  const auto deadline = std::chrono::steady_clock::now() + FAREWELL;
  while (running_ > 0 && std::chrono::steady_clock::now() < deadline)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  if (busy) std::this_thread::sleep_for(LAST_WRITE);

  // No new calls, then no thread in a callback, then nothing left that names this object.
  for (ros::ServiceServer &service : services_) service.shutdown();
  for (ros::Subscriber &subscriber : objects_) subscriber.shutdown();
  control_spinner_->stop();
  setThreads(0);
  reconfigure_.reset();
  diagnostics_.reset();
  batches_.reset();
  pipeline_.reset();
  sensors_.reset();
  markers_.reset();
  control_queue_.clear();
  queue_.clear();
}

/** Everything that a handler does happens in here: what it throws becomes a message, and it is counted while it runs. */
template <class Response, class Work>
bool ProximityServer::handle(Response &response, Work &&work) {
  struct Count {
    explicit Count(std::atomic<int> &n) : running(n) {
      ++running;
    }
    ~Count() {
      --running;
    }
    std::atomic<int> &running;
  } const count(running_);
  return answered(response, [&] {
    if (stop_) throw Error("the server is shutting down");
    work();
  });
}

template <class Request, class Response>
bool ProximityServer::query(QueryType query_type, double delta, const Request &request, Response &response) {
  return handle(response, [&] {
    const QueryRequest common{query_type,
                              delta,
                              List<Curve>(request.curves),
                              trajectoriesOf(request.trajectory),
                              request.self_collision != 0,
                              request.objects,
                              request.links,
                              request.joint_state,
                              request.epsilon,
                              request.max_nodes,
                              request.per_object != 0};
    QueryResponse answer;
    auto drawing = std::make_shared<Drawing>();
    queries_.answer(common, answer, *drawing);
    response.success = answer.success;
    response.message = std::move(answer.message);
    response.frame_id = frames_.fixedFrame();
    response.results = std::move(answer.results);
    markers_->show(std::move(drawing));
  });
}

bool ProximityServer::distance(Distance::Request &request, Distance::Response &response) {
  return query(QueryType::DISTANCE, 0.0, request, response);
}

bool ProximityServer::tolerance(Tolerance::Request &request, Tolerance::Response &response) {
  return query(QueryType::TOLERANCE, request.delta, request, response);
}

bool ProximityServer::collision(Collision::Request &request, Collision::Response &response) {
  return query(QueryType::COLLISION, 0.0, request, response);
}

/** Objects come in any frame; what is wrong with one is told, and the others are applied. */
std::vector<std::string> ProximityServer::apply(const ApplyScene::Request &request) {
  FrameLookup lookup(frames_);
  std::vector<std::string> faults;
  const ToFixed to_fixed = [&](const std_msgs::Header &header) {
    return lookup.toFixed(header.frame_id, header.stamp);
  };
  SceneChange change = toSceneChange(request, to_fixed, faults);
  addAttachments(request, to_fixed, *scene_.snapshot(), change, faults);
  for (std::string &fault : scene_.apply(change)) faults.push_back(std::move(fault));
  return faults;
}

bool ProximityServer::applyScene(ApplyScene::Request &request, ApplyScene::Response &response) {
  return handle(response, [&] {
    const std::vector<std::string> faults = apply(request);
    response.success = faults.empty();
    response.message = joined(faults);
  });
}

/** As ~apply_scene with one object; there is nobody to be told but the log. */
template <class Fill>
void ProximityServer::changeScene(const char *topic, Fill &&fill) {
  const auto complain = [&](const std::string &why) { ROS_ERROR("%s: %s", topic, why.c_str()); };
  guarded(
      [&] {
        ApplyScene::Request request;
        fill(request);
        for (const std::string &fault : apply(request)) complain(fault);
      },
      complain);
}

void ProximityServer::takeObject(const CollisionObjectConstPtr &object) {
  changeScene("~collision_object", [&](ApplyScene::Request &request) { request.objects.push_back(*object); });
}

void ProximityServer::takeAttached(const AttachedCollisionObjectConstPtr &object) {
  changeScene("~attached_collision_object",
              [&](ApplyScene::Request &request) { request.attached_collision_objects.push_back(*object); });
}

/** The scene of ~scene_file: all of it, or no start. */
void ProximityServer::loadScene() {
  if (parameters_.scene_file.empty()) return;
  std::string why;
  try {
    yaml::Warnings warnings;
    const yaml::SceneFile file = yaml::readScene(parameters_.scene_file, warnings);
    const std::vector<std::string> faults = apply(toMessage(yaml::toChange(file, parameters_.scene_file, warnings)));
    for (const std::string &warning : warnings.sentences()) ROS_WARN("~scene_file: %s", warning.c_str());
    why = joined(faults);
  } catch (const std::exception &error) {
    why = error.what();
  }
  if (!why.empty()) throw ParameterError("parameter ~scene_file: " + why);
}

bool ProximityServer::getScene(GetScene::Request &request, GetScene::Response &response) {
  return handle(response, [&] {
    toMessage(*scene_.snapshot(), request.ids, response);
    for (CollisionObject &object : response.objects) object.header.frame_id = frames_.fixedFrame();
    response.frame_id = frames_.fixedFrame();
    response.success = true;
  });
}

bool ProximityServer::evaluateConstraints(EvaluateConstraints::Request &request,
                                          EvaluateConstraints::Response &response) {
  return handle(response, [&] {
    response.frame_id = frames_.fixedFrame();
    std::shared_ptr<const LevelDrawing> drawing;
    constraints_.answer(request, response, drawing);
    if (drawing) markers_->show(std::move(drawing));
  });
}

} // namespace curve_proximity
