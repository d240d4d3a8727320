/* SPDX-License-Identifier: BSD-3-Clause */
/** The services over one live scene: the whole of the node, and of the nodelet. */
#ifndef CURVE_PROXIMITY_ROS_SERVER_H
#define CURVE_PROXIMITY_ROS_SERVER_H

#include <curve_proximity/ApplyScene.h>
#include <curve_proximity/Collision.h>
#include <curve_proximity/Distance.h>
#include <curve_proximity/EvaluateConstraints.h>
#include <curve_proximity/GetScene.h>
#include <curve_proximity/Tolerance.h>
#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/service_server.h>
#include <ros/spinner.h>

#include <atomic>
#include <curve_proximity/scene.hpp>
#include <memory>
#include <vector>

#include "constraints.h"
#include "frames.h"
#include "markers.h"
#include "parameters.h"
#include "queries.h"
#include "sensors.h"

namespace curve_proximity {

/** Serves until it is destroyed. It owns its callback queue and threads: a nodelet manager's own would still be running
 *  callbacks while the nodelet is being unloaded. */
class ProximityServer {
 public:
  /** handle: private; services and parameters live in its namespace. Throws what loadRobot() throws. */
  ProximityServer(const ros::NodeHandle &handle, const Parameters &parameters);

  /** Ends running queries by their stop flag, gives their answers a moment to leave, and joins all threads. */
  ~ProximityServer();

  ProximityServer(const ProximityServer &) = delete;
  ProximityServer &operator=(const ProximityServer &) = delete;

 private:
  bool distance(Distance::Request &request, Distance::Response &response);
  bool tolerance(Tolerance::Request &request, Tolerance::Response &response);
  bool collision(Collision::Request &request, Collision::Response &response);
  bool applyScene(ApplyScene::Request &request, ApplyScene::Response &response);
  bool getScene(GetScene::Request &request, GetScene::Response &response);
  bool evaluateConstraints(EvaluateConstraints::Request &request, EvaluateConstraints::Response &response);

  template <class Request, class Response>
  bool query(Verb verb, double delta, const Request &request, Response &response);
  template <class Response, class Work>
  bool handle(Response &response, Work &&work);

  const Parameters parameters_;
  std::atomic<bool> stop_{false};
  std::atomic<int> running_{0}; /* handlers that have begun and not ended */
  ros::CallbackQueue queue_;
  ros::NodeHandle handle_; /* its callbacks go to queue_ */
  Frames frames_;
  Scene scene_;
  const Srdf srdf_;
  Queries queries_;
  Constraints constraints_;
  std::unique_ptr<MarkerPublisher> markers_;
  std::unique_ptr<Sensors> sensors_;
  std::vector<ros::ServiceServer> services_;
  std::unique_ptr<ros::AsyncSpinner> spinner_;
};

} // namespace curve_proximity
#endif
