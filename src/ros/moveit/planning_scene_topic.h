/* SPDX-License-Identifier: BSD-3-Clause */
/** move_group's scene by topic and by service: the server follows it, and tells where it does not. */
#ifndef CURVE_PROXIMITY_ROS_PLANNING_SCENE_TOPIC_H
#define CURVE_PROXIMITY_ROS_PLANNING_SCENE_TOPIC_H

#include <ros/node_handle.h>
#include <ros/service_client.h>
#include <ros/subscriber.h>

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <curve_proximity/scene.hpp>
#include <functional>
#include <mutex>
#include <string>
#include <vector>

#include "moveit/moveit_messages.h"
#include "moveit/planning_scene.h"
#include "parameters/parameters.h"
#include "transport/log_limit.h"
#include "transport/threaded_queue.h"
#include "world/frames.h"
#include "world/live_scene.h"

namespace curve_proximity {

/** What became of ~planning_scene. */
struct PlanningSceneReport {
  std::uint64_t full = 0, diffs = 0;    /**< messages taken in */
  std::uint64_t diffs_since_full = 0;   /**< of these since the last full one */
  std::uint64_t fingerprint = 0;        /**< of the last full message, see fingerprint.hpp */
  std::uint64_t diff_fingerprint = 0;   /**< of the last diff */
  std::vector<std::string> unused;      /**< what was not used of the last full scene and of the diffs since then */
  std::vector<std::string> differences; /**< from ~get_planning_scene, where that has been asked */
  std::uint64_t checks = 0;             /**< answers of ~get_planning_scene that were compared */
  std::uint64_t replaced = 0;           /**< of these taken over, as the scene lacked a diff */
  bool gone = false;                    /**< ~get_planning_scene has answered, and is not there any more */
};

/** ~planning_scene, and ~get_planning_scene as a client. Both have queues of their own: building a scene takes no
 *  place from the queries, and a move_group that does not answer holds up nothing. A message is applied as one change.
 */
class PlanningSceneTopic {
 public:
  /** Applies a change; returns what could not be applied. */
  using Apply = std::function<std::vector<std::string>(SceneChange &change, const Snapshot &before)>;
  /** A link in the fixed frame, by these joints or, where there are none, as the server knows it. Throws Error. */
  using LinkPose = std::function<Eigen::Isometry3d(const std::string &link, const JointPositions &joints,
                                                   const Snapshot &snapshot, FrameLookup &lookup)>;

  /** handle: private. All references are kept. */
  PlanningSceneTopic(const ros::NodeHandle &handle, const Parameters &parameters, LiveScene &live, const Frames &frames,
                     Apply apply, LinkPose link_pose);

  /** No callback runs, nor will one begin, when it has ended. */
  ~PlanningSceneTopic();

  PlanningSceneReport report() const;

  PlanningSceneTopic(const PlanningSceneTopic &) = delete;
  PlanningSceneTopic &operator=(const PlanningSceneTopic &) = delete;

 private:
  void take(const moveit::PlanningScene &message, const char *source);
  void use(const moveit::PlanningScene &message);
  void tryToUse(const moveit::PlanningScene &message, const char *source);
  std::vector<std::string> differencesTo(const moveit::PlanningScene &message) const;
  /** Whether nothing differs but what a full scene does not mend. */
  bool compare(const moveit::PlanningScene &message);
  PlanningSceneContext context(const Snapshot &snapshot, FrameLookup &lookup) const;
  void keepUnused(const std::vector<std::string> &wrong, bool full);
  void publishUnknowns();
  void setGone(bool gone);
  void warn(const std::string &why);
  void ask();
  bool wait(double period, std::uint32_t &publishers, bool &begun);
  bool askOnce(moveit::PlanningScene &scene);

  const Parameters &parameters_;
  LiveScene &live_;
  const Frames &frames_;
  const Apply apply_;
  const LinkPose link_pose_;
  ThreadedQueue queue_, asking_queue_;
  ros::NodeHandle handle_; /* its callbacks go to queue_ */
  std::mutex taking_;      /* one message at a time: those of the topic, and those of the service */
  PlanningSceneState state_;
  mutable std::mutex mutex_; /* of the report */
  PlanningSceneReport report_;
  std::vector<std::string> suspected_;     /* what differed the last time */
  std::vector<std::string> beyond_repair_; /* what still differed when the last answer had been taken over */
  LogLimit log_limit_{std::chrono::seconds(60)};
  ros::Subscriber subscriber_;
  std::mutex asking_; /* of the client and of ending_ */
  std::condition_variable wake_;
  ros::ServiceClient client_;
  bool ending_ = false;
};

} // namespace curve_proximity
#endif
