/* SPDX-License-Identifier: BSD-3-Clause */
#include "server.h"

#include <ros/console.h>

#include <chrono>
#include <thread>
#include <utility>

#include "conversions.h"
#include "guard.h"
#include "robot_description.h"

namespace curve_proximity {
namespace {

/** How long the end waits for stopped queries to hand their answers over. */
constexpr std::chrono::milliseconds FAREWELL{1000};

/** … and how long roscpp may then take to write them. */
constexpr std::chrono::milliseconds LAST_WRITE{50};

ros::NodeHandle onQueue(const ros::NodeHandle &handle, ros::CallbackQueue &queue) {
  ros::NodeHandle own(handle);
  own.setCallbackQueue(&queue);
  return own;
}

std::string joined(const std::vector<std::string> &sentences) {
  std::string text;
  for (const std::string &sentence : sentences) text += (text.empty() ? "" : "; ") + sentence;
  return text;
}

} // namespace

ProximityServer::ProximityServer(const ros::NodeHandle &handle, const Parameters &parameters)
    : parameters_(parameters),
      handle_(onQueue(handle, queue_)),
      frames_(parameters_.fixed_frame, parameters_.tf_timeout, stop_),
      scene_(loadRobot(handle, parameters_), resourceOptions("", parameters_.max_shape_mb)),
      srdf_(loadSrdf(handle, parameters_)),
      queries_(parameters_, scene_, srdf_, frames_, stop_),
      constraints_(parameters_, scene_, frames_, stop_) {
  markers_ = std::make_unique<MarkerPublisher>(handle_, scene_, parameters_.fixed_frame);
  sensors_ = std::make_unique<Sensors>(handle, parameters_, scene_, frames_);
  services_ = {handle_.advertiseService("distance", &ProximityServer::distance, this),
               handle_.advertiseService("tolerance", &ProximityServer::tolerance, this),
               handle_.advertiseService("collision", &ProximityServer::collision, this),
               handle_.advertiseService("apply_scene", &ProximityServer::applyScene, this),
               handle_.advertiseService("get_scene", &ProximityServer::getScene, this),
               handle_.advertiseService("evaluate_constraints", &ProximityServer::evaluateConstraints, this)};
  spinner_ = std::make_unique<ros::AsyncSpinner>(static_cast<std::uint32_t>(parameters_.threads), &queue_);
  spinner_->start();
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
  spinner_->stop();
  sensors_.reset();
  markers_.reset();
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
bool ProximityServer::query(Verb verb, double delta, const Request &request, Response &response) {
  return handle(response, [&] {
    const QueryRequest common{verb,
                              delta,
                              request.curves,
                              request.trajectory,
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
  return query(Verb::DISTANCE, 0.0, request, response);
}

bool ProximityServer::tolerance(Tolerance::Request &request, Tolerance::Response &response) {
  return query(Verb::TOLERANCE, request.delta, request, response);
}

bool ProximityServer::collision(Collision::Request &request, Collision::Response &response) {
  return query(Verb::COLLISION, 0.0, request, response);
}

bool ProximityServer::applyScene(ApplyScene::Request &request, ApplyScene::Response &response) {
  return handle(response, [&] {
    FrameLookup lookup(frames_);
    std::vector<std::string> faults;
    const ToFixed to_fixed = [&](const std_msgs::Header &header) {
      return lookup.toFixed(header.frame_id, header.stamp);
    };
    SceneChange change = toSceneChange(request, to_fixed, faults);
    addAttachments(request, to_fixed, *scene_.snapshot(), change, faults);
    for (std::string &fault : scene_.apply(change)) faults.push_back(std::move(fault));
    response.success = faults.empty();
    response.message = joined(faults);
  });
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
    constraints_.answer(request, response);
  });
}

} // namespace curve_proximity
