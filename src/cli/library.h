/* SPDX-License-Identifier: BSD-3-Clause */
/** Robots and scenes of a dataset: each is loaded once and shared by all rows and threads. */
#ifndef CURVE_PROXIMITY_CLI_LIBRARY_H
#define CURVE_PROXIMITY_CLI_LIBRARY_H

#include <condition_variable>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <string>

#include <curve_proximity/motion.hpp>

#include "world_files.h"

namespace curve_proximity::cli {

/** A robot in a scene, or why there is none. */
struct Place {
  std::shared_ptr<const World> world; /**< null: see fault */
  std::string fault;
  bool missing = false; /**< a file that is named is not there */

  /** The robot made ready for the motions of this trajectory's base, or where it stands: once for all of them. Throws
   *  Error as PreparedRobot does. Any number of threads. */
  PreparedRobot prepared(const TrajectoryDescription &trajectory, const Eigen::Isometry3d &place) const;

 private:
  mutable std::mutex mutex_;
  mutable std::map<std::string, PreparedRobot> prepared_; /* by base */
};

/** Keeps the places that were used last. Any number of threads; one that asks for what another loads waits for it. */
class Library {
 public:
  /** A robot, its SRDF and a scene; empty paths: none. Never throws but for memory. */
  std::shared_ptr<const Place> place(const std::string &robot, const std::string &srdf, const std::string &scene);

 private:
  static constexpr std::size_t kMostPlaces = 256;

  std::shared_ptr<const Place> load(const std::string &robot, const std::string &srdf, const std::string &scene);
  std::shared_ptr<const Robot> robot(const std::string &path);

  /** A place, and where its key stands among those used last; no place: it is being loaded. */
  struct Entry {
    std::shared_ptr<const Place> place;
    std::list<std::string>::iterator used;
  };
  std::mutex mutex_;
  std::condition_variable loaded_;
  std::map<std::string, Entry> places_;
  std::list<std::string> used_; /* the latest first */

  /** A robot, or why it cannot be read: then it is not read again for the next scene. */
  struct ReadRobot {
    std::shared_ptr<const Robot> robot;
    std::string fault;
  };
  std::mutex robots_mutex_; /* held while a robot is read: all wait for the one that they are about to share */
  std::map<std::string, ReadRobot> robots_;
};

/** The digest of a file and of the mesh files that it names (as filename="…" or resource: …), 64 digits; of one that
 *  cannot be read 64 times '-'. */
std::string digestOfFile(const std::string &path, bool with_meshes);

} // namespace curve_proximity::cli
#endif
