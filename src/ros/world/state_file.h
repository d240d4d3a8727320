/* SPDX-License-Identifier: BSD-3-Clause */
/** Keeps the scene on disk, so that a server that comes after a crash has it again, or says that it has not. */
#ifndef CURVE_PROXIMITY_ROS_STATE_FILE_H
#define CURVE_PROXIMITY_ROS_STATE_FILE_H

#include <curve_proximity/ApplyScene.h>
#include <ros/node_handle.h>

#include <chrono>
#include <condition_variable>
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
  std::vector<std::string> sensors; /**< objects that sensors kept, and objects too large to be written */
  UnknownsBySource unknowns;        /**< what was not known of the scene, and the new server does not find out itself */
  bool replaces_srdf = false;       /**< Snapshot::replacesSrdf() of the scene */
  bool behind = false;              /**< the last changes are not in it */
};

/** The file: a line of text ("curve_proximity scene 5"), the run (/run_id), a digest of what the scene began with (the
 * scene file, the robot, the fixed frame), the type's MD5, a count of bytes and their digest, a line each; then
 * the names of sensors' objects, what is unknown, replaces_srdf and the request of ~apply_scene, serialised. Beside it
 * stands a file ".behind" with the run from a change of the scene until it is written. */
class StateFile {
 public:
  /** handle: private. live: kept by reference. Writes nothing before watch(). */
  StateFile(const ros::NodeHandle &handle, const Parameters &parameters, LiveScene &live);

  /** Writes what has changed since the last time. */
  ~StateFile();

  /** The scene of the server before this one; nothing where there is none, or where it began with another scene file,
   *  robot or fixed frame. Where there was one that cannot be read: lose(). */
  std::optional<KeptScene> read();

  /** From now on nothing is known of the scene, until one is sent. */
  void lose();

  /** From now on changes are written, once a second at most. fixed_frame: that of the objects' poses. */
  void watch(const std::string &fixed_frame);

  /** Somebody has changed the scene, and not by a sensor. When it returns, a server that is killed leaves a word of it.
   */
  void changed();

 private:
  void writeSoon();
  void writeChanges();
  void write();
  std::string behindPath() const;
  bool isKept() const;
  void markBehind() const;

  LiveScene &live_;
  ros::NodeHandle handle_;
  const std::string path_;
  std::string run_, beginning_, fixed_frame_;
  std::mutex mutex_;
  std::condition_variable wake_;
  bool watching_ = false, changed_ = false, awaits_writing_ = false, ending_ = false;
  bool told_ = false, failed_ = false;              /* of the one that writes */
  std::chrono::steady_clock::time_point may_write_; /* likewise */
  ThreadedQueue queue_;
};

} // namespace curve_proximity
#endif
