/* SPDX-License-Identifier: BSD-3-Clause */
#include "library.h"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>

#include "../scene/base/digest.h"
#include "../scene/yaml/scene_change.h"
#include "packages.h"
#include "robot_file.h"

namespace curve_proximity::cli {
namespace {

std::optional<std::string> textOf(const std::string &path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return std::nullopt;
  std::ifstream stream(path, std::ios::binary);
  std::string text((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
  if (!stream) return std::nullopt;
  return text;
}

/* Where the file of a mesh is; "" where its package is not found. */
std::string meshPath(const std::string &resource, const std::string &folder) {
  const std::string package = "package://", file = "file://";
  if (resource.rfind(file, 0) == 0) return resource.substr(file.size());
  if (resource.rfind(package, 0) != 0) return (std::filesystem::path(folder) / resource).string();
  const std::size_t slash = std::min(resource.find('/', package.size()), resource.size());
  const std::string found = packageFinder(folder)(resource.substr(package.size(), slash - package.size()));
  return found.empty() ? "" : found + resource.substr(slash);
}

} // namespace

std::string digestOfFile(const std::string &path, bool with_meshes) {
  constexpr std::size_t kDigits = 64;
  const std::optional<std::string> text = textOf(path);
  if (!text) return std::string(kDigits, '-');
  Hasher hasher;
  hasher.add(*text);
  if (!with_meshes) return toHex(hasher.finish());
  static const std::regex named(
      R"re((?:filename\s*=\s*|resource["']?\s*:\s*)(?:"([^"]+)"|'([^']+)'|([^\s"',}\]]+)))re");
  const std::string folder = yaml::folderOf(path);
  for (std::sregex_iterator it(text->begin(), text->end(), named), end; it != end; ++it) {
    const std::size_t group = (*it)[1].matched ? 1 : (*it)[2].matched ? 2 : 3;
    const std::optional<std::string> mesh = textOf(meshPath((*it)[group].str(), folder));
    hasher.add(mesh ? *mesh : "-");
  }
  return toHex(hasher.finish());
}

PreparedRobot Place::prepared(const TrajectoryDescription &trajectory, const Eigen::Isometry3d &place) const {
  constexpr std::size_t kMostBases = 16; /* a dataset has one, or none */
  std::string key = std::to_string(trajectory.base.size());
  for (const VirtualJoint &joint : trajectory.base)
    for (const std::string *word : {&joint.name, &joint.type, &joint.parent_frame, &joint.child_link})
      key += *word + '\0';
  for (const std::string &joint : trajectory.base_joints) key += joint + '\0';
  const std::lock_guard<std::mutex> lock(mutex_);
  const auto found = prepared_.find(key);
  if (found != prepared_.end()) return found->second;
  if (prepared_.size() == kMostBases) prepared_.clear();
  return prepared_
      .emplace(key,
               PreparedRobot(world->snapshot, world->srdf.disabled, trajectory.base, trajectory.base_joints, place))
      .first->second;
}

std::shared_ptr<const Robot> Library::robot(const std::string &path) {
  const std::lock_guard<std::mutex> lock(robots_mutex_);
  ReadRobot &read = robots_[path];
  if (!read.robot && read.fault.empty()) {
    try {
      read.robot = readRobot(path);
    } catch (const std::bad_alloc &) {
      throw;
    } catch (const std::exception &e) {
      read.fault = e.what();
    }
  }
  if (!read.robot) throw Error(read.fault);
  return read.robot;
}

std::shared_ptr<const Place> Library::load(const std::string &robot, const std::string &srdf,
                                           const std::string &scene) {
  auto out = std::make_shared<Place>();
  for (const std::string *path : {&robot, &srdf, &scene}) {
    std::error_code error;
    if (path->empty() || std::filesystem::exists(*path, error)) continue;
    out->missing = true;
    out->fault = *path + ": there is no such file";
    return out;
  }
  try {
    Arguments files;
    files.robot = robot;
    files.srdf = srdf;
    files.scene = scene;
    Warnings warnings;
    out->world = std::make_shared<const World>(
        readStandingWorld(files, "a dataset", warnings, [this](const std::string &path) { return this->robot(path); }));
  } catch (const std::bad_alloc &) {
    throw;
  } catch (const std::exception &e) {
    out->fault = e.what();
  }
  return out;
}

std::shared_ptr<const Place> Library::place(const std::string &robot, const std::string &srdf,
                                            const std::string &scene) {
  const std::string key = robot + '\0' + srdf + '\0' + scene;
  std::unique_lock<std::mutex> lock(mutex_);
  for (auto it = places_.find(key); it != places_.end(); it = places_.find(key)) {
    if (it->second.place) {
      used_.splice(used_.begin(), used_, it->second.used);
      return it->second.place;
    }
    loaded_.wait(lock);
  }

  /* not there: this thread loads it */
  used_.push_front(key);
  places_[key] = {nullptr, used_.begin()};
  lock.unlock();
  std::shared_ptr<const Place> place;
  try {
    place = load(robot, srdf, scene);
  } catch (...) {
    lock.lock();
    used_.erase(places_[key].used);
    places_.erase(key);
    loaded_.notify_all();
    throw;
  }
  lock.lock();
  places_[key].place = place;
  loaded_.notify_all();

  /* those that were not used for longest go */
  while (used_.size() > kMostPlaces && places_[used_.back()].place) {
    places_.erase(used_.back());
    used_.pop_back();
  }
  return place;
}

} // namespace curve_proximity::cli
