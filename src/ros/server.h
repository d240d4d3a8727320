/* SPDX-License-Identifier: BSD-3-Clause */
/** The services and topics over one live scene: the whole of the node, and of the nodelet. */
#ifndef CURVE_PROXIMITY_ROS_SERVER_H
#define CURVE_PROXIMITY_ROS_SERVER_H

#include <curve_proximity/ApplyScene.h>
#include <curve_proximity/AttachedCollisionObject.h>
#include <curve_proximity/CollisionObject.h>
#include <curve_proximity/EvaluateConstraints.h>
#include <curve_proximity/GetScene.h>
#include <ros/node_handle.h>
#include <ros/service_server.h>
#include <ros/subscriber.h>

#include <atomic>
#include <cstdint>
#include <curve_proximity/scene.hpp>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "constraints/constraints.h"
#include "diagnostics.h"
#include "markers/markers.h"
#include "moveit/planning_scene_topic.h"
#include "parameters/parameters.h"
#include "parameters/reconfigure.h"
#include "parameters/tuning.h"
#include "pipeline/pipeline.h"
#include "queries/batch_action.h"
#include "queries/measure_pairs.h"
#include "queries/queries.h"
#include "transport/local_services.h"
#include "transport/service.h"
#include "transport/statistics.h"
#include "transport/threaded_queue.h"
#include "transport/turns.h"
#include "world/frames.h"
#include "world/live_scene.h"
#include "world/sensors.h"
#include "world/state_file.h"

namespace curve_proximity {

/** Serves until it is destroyed. It owns its callback queues and threads: a nodelet manager's own would still be
 *  running callbacks while the nodelet is being unloaded. */
class ProximityServer {
 public:
  /** handle: private; services and parameters live in its namespace. Throws what loadRobot() throws. */
  ProximityServer(const ros::NodeHandle &handle, const Parameters &parameters);

  /** Ends running queries by their stop flag, gives their answers a moment to leave, and joins all threads. */
  ~ProximityServer();

  /** The rows of a query as the checker of certificates reads them, by what this server knows now; nothing is searched.
   *  Throws Error where nothing can be told at all. By any thread. */
  std::vector<Problem> problems(const ProximityQuery &query);

  /** The number of changes of its scene. */
  std::uint64_t version() const {
    return live_.scene.snapshot()->version();
  }

  ProximityServer(const ProximityServer &) = delete;
  ProximityServer &operator=(const ProximityServer &) = delete;

 private:
  template <class Service, class Work>
  void serve(const char *name, std::size_t times_wire, Work work);
  template <class Service>
  void serveQueries(const char *name, QueryType query_type);
  Turns::Clock::time_point waitUntil(const Call &call);

  void applyScene(const Call &call, ApplyScene::Request &request, ApplyScene::Response &response);
  void getScene(const GetScene::Request &request, GetScene::Response &response);

  using ObjectEvent = ros::MessageEvent<const CollisionObject>;
  void countObject(const std::string &publisher, std::uint32_t number);
  void takeObject(const ObjectEvent &event);
  void takeAttached(const AttachedCollisionObjectConstPtr &object);
  template <class Fill>
  void changeScene(const char *topic, Fill &&fill);
  std::vector<std::string> apply(const ApplyScene::Request &request, bool replaces_srdf = false);
  std::vector<std::string> applyChange(SceneChange &change, const Snapshot &before);
  void loadScene();
  void restoreScene();
  std::size_t requestLimit() const;

  const Parameters parameters_;
  Tuning tuning_;
  Statistics statistics_;
  std::atomic<bool> stop_{false};
  ServiceQueue requests_;
  ThreadedQueue objects_queue_, control_queue_;              /* ~collision_object; what watches over all */
  ros::NodeHandle handle_, objects_handle_, control_handle_; /* their callbacks go to these queues */
  Turns turns_, scene_turns_; /* of queries; of large changes of the scene, which are made beside them */
  Frames frames_;
  LiveScene live_;
  StateFile state_file_;
  Queries queries_;
  Constraints constraints_;
  Pairs pairs_;
  std::unique_ptr<MarkerPublisher> markers_;
  std::unique_ptr<Sensors> sensors_;
  std::unique_ptr<PlanningSceneTopic> planning_scene_;
  std::vector<ros::ServiceServer> services_;
  LocalServices local_; /* the same */
  std::vector<ros::Subscriber> objects_;
  std::map<std::string, std::uint32_t> last_objects_; /* the number of the last one of each publisher */
  std::unique_ptr<Pipeline> pipeline_;
  std::unique_ptr<BatchAction> batches_;
  std::unique_ptr<Diagnostics> diagnostics_;
  std::unique_ptr<Reconfigure> reconfigure_;
};

} // namespace curve_proximity
#endif
