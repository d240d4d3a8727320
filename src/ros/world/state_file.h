/* SPDX-License-Identifier: BSD-3-Clause */
/** Keeps the scene on disk, so that a server that comes after a crash has it again, or says that it has not. */
#ifndef CURVE_PROXIMITY_ROS_STATE_FILE_H
#define CURVE_PROXIMITY_ROS_STATE_FILE_H

#include <curve_proximity/ApplyScene.h>
#include <ros/node_handle.h>
#include <ros/wall_timer.h>

#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "parameters/parameters.h"
#include "transport/threaded_queue.h"
#include "world/live_scene.h"

namespace curve_proximity {

/** What was read back. */
struct KeptScene {
  ApplySceneRequest request;        /**< replaces the scene */
  std::vector<std::string> sensors; /**< objects that sensors kept, or that are too large to be written */
  UnknownsBySource unknowns;        /**< what was not known, and the new server does not find out itself */
  bool replaces_srdf = false;       /**< Snapshot::replacesSrdf() of the scene */
  bool behind = false;              /**< the last changes are not in it */
};

/** The file has a line each of:
 *   - "written" or, from a change of the scene until it is written, "behind ";
 *   - the run (/run_id);
 *   - a digest of what the scene began with: the scene file, the robot, the fixed frame;
 *   - the type's MD5.
 * Then, serialised: the names of sensors' objects, what is unknown, replaces_srdf and the request of ~apply_scene. */
class StateFile {
 public:
  /** handle: private. live: kept by reference. Writes nothing before watch(). */
  StateFile(const ros::NodeHandle &handle, const Parameters &parameters, LiveScene &live);

  /** Writes what has changed since the last time. */
  ~StateFile();

  /** The scene of the server before this one; nothing where there is none, or where it began with another scene file,
   * robot or fixed frame. Where there was one that cannot be read: lose(). */
  std::optional<KeptScene> read();

  /** From now on nothing is known of the scene, until one is sent. */
  void lose();

  /** From now on changes are written, once a second at most. */
  void watch();

  /** Somebody has changed the scene, and not by a sensor. When it returns, the file of a server that is killed is
   * marked as behind. */
  void changed();

 private:
  void write();
  bool isKept() const;
  void markBehind() const;

  LiveScene &live_;
  ThreadedQueue queue_;
  ros::NodeHandle handle_; /* its callbacks go to queue_ */
  const std::string path_, fixed_frame_;
  std::string run_, beginning_;
  std::mutex mutex_; /* of what follows */
  bool watching_ = false, changed_ = false;
  bool told_ = false, failed_ = false; /* of the one that writes */
  ros::WallTimer timer_;
};

} // namespace curve_proximity
#endif
