/* SPDX-License-Identifier: BSD-3-Clause */
/** The services and topics over one live scene: the whole of the node, and of the nodelet. */
#ifndef CURVE_PROXIMITY_ROS_SERVER_H
#define CURVE_PROXIMITY_ROS_SERVER_H

#include <curve_proximity/ApplyScene.h>
#include <curve_proximity/AttachedCollisionObject.h>
#include <curve_proximity/Collision.h>
#include <curve_proximity/CollisionObject.h>
#include <curve_proximity/Distance.h>
#include <curve_proximity/EvaluateConstraints.h>
#include <curve_proximity/GetScene.h>
#include <curve_proximity/Tolerance.h>
#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/service_server.h>
#include <ros/spinner.h>
#include <ros/subscriber.h>

#include <atomic>
#include <curve_proximity/scene.hpp>
#include <memory>
#include <vector>

#include "batch_action.h"
#include "constraints.h"
#include "diagnostics.h"
#include "frames.h"
#include "markers.h"
#include "parameters.h"
#include "pipeline.h"
#include "queries.h"
#include "reconfigure.h"
#include "sensors.h"
#include "statistics.h"
#include "tuning.h"

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

  void takeObject(const CollisionObjectConstPtr &object);
  void takeAttached(const AttachedCollisionObjectConstPtr &object);
  template <class Fill>
  void changeScene(const char *topic, Fill &&fill);
  std::vector<std::string> apply(const ApplyScene::Request &request);
  void loadScene();

  template <class Request, class Response>
  bool query(QueryType query_type, double delta, const Request &request, Response &response);
  template <class Response, class Work>
  bool handle(Response &response, Work &&work);

  void setThreads(int threads);

  const Parameters parameters_;
  Tuning tuning_;
  Statistics statistics_;
  std::atomic<bool> stop_{false};
  std::atomic<int> running_{0};              /* handlers that have begun and not ended */
  ros::CallbackQueue queue_, control_queue_; /* of requests; of what watches over them, with a thread of its own */
  ros::NodeHandle handle_, control_handle_;  /* their callbacks go to these queues */
  Frames frames_;
  const Srdf srdf_;
  Scene scene_;
  Queries queries_;
  Constraints constraints_;
  std::unique_ptr<MarkerPublisher> markers_;
  std::unique_ptr<Sensors> sensors_;
  std::vector<ros::ServiceServer> services_;
  std::vector<ros::Subscriber> objects_;
  std::unique_ptr<Pipeline> pipeline_;
  std::unique_ptr<BatchAction> batches_;
  std::unique_ptr<Diagnostics> diagnostics_;
  std::unique_ptr<Reconfigure> reconfigure_;
  std::vector<std::unique_ptr<ros::AsyncSpinner>> spinners_; /* ~threads, of a thread each */
  std::unique_ptr<ros::AsyncSpinner> control_spinner_;
};

} // namespace curve_proximity
#endif
