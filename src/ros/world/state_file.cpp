/* SPDX-License-Identifier: BSD-3-Clause */
#include "world/state_file.h"

#include <ros/console.h>
#include <ros/serialization.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <system_error>

#include "../../scene/base/digest.h"
#include "messages/scene_message.h"
#include "transport/checked_stream.h"
#include "transport/guard.h"
#include "world/robot_description.h"

namespace curve_proximity {
namespace {

/* The first line of the file, of one length: a change of the scene makes it BEHIND in place, until the file is written
 * anew. */
constexpr const char *WRITTEN = "written", *BEHIND = "behind ";
constexpr double WRITING_PERIOD = 1.0; /* [s] */
constexpr std::size_t MOST_BYTES = std::size_t{64} << 20;

template <class Message>
std::string serialised(const Message &message) {
  std::string out(ros::serialization::serializationLength(message), '\0');
  ros::serialization::OStream stream(reinterpret_cast<std::uint8_t *>(out.data()),
                                     static_cast<std::uint32_t>(out.size()));
  ros::serialization::serialize(stream, message);
  return out;
}

std::string automaticPath(const std::string &name) {
  const char *ros_home = std::getenv("ROS_HOME");
  const char *home = std::getenv("HOME");
  if (!ros_home && !home) return "";
  const std::filesystem::path folder =
      (ros_home ? std::filesystem::path(ros_home) : std::filesystem::path(home) / ".ros") / "curve_proximity";
  std::string file = name.substr(name.find_first_not_of('/'));
  std::replace(file.begin(), file.end(), '/', '.');
  return (folder / (file + ".scene")).string();
}

std::string textOf(const std::string &path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  if (file) text << file.rdbuf();
  return text.str();
}

/** What is to be there again; objects that sensors keep come by themselves. */
KeptScene keptOf(const LiveScene &live, const std::string &fixed_frame) {
  KeptScene out;
  const LiveScene::Seen seen = live.seen();
  for (const SensorState &sensor : seen.sensors) out.sensors.push_back(sensor.id);
  GetSceneResponse scene;
  toMessage(*seen.snapshot, {}, scene);
  out.replaces_srdf = seen.snapshot->replacesSrdf();
  std::size_t bytes = 0;
  out.request.clear = true;
  for (CollisionObject &object : scene.objects) {
    if (std::find(out.sensors.begin(), out.sensors.end(), object.id) != out.sensors.end()) continue;
    object.header.frame_id = fixed_frame;
    const std::size_t size = ros::serialization::serializationLength(object);
    if (bytes + size > MOST_BYTES) {
      out.sensors.push_back(object.id);
      continue;
    }
    bytes += size;
    out.request.objects.push_back(std::move(object));
  }
  out.request.attached_collision_objects = std::move(scene.attached_collision_objects);
  out.request.link_padding = std::move(scene.link_padding);
  out.request.link_scale = std::move(scene.link_scale);
  out.request.allowed_contacts = std::move(scene.allowed_contacts);
  // the rest of an incomplete scene comes with the next whole one, whoever sends that
  for (const auto &[source, unknowns] : live.unknowns.bySource()) {
    if (source == AWAITED_SCENE) continue;
    const bool is_object = source.rfind(REFUSED_OBJECT, 0) == 0;
    std::vector<Unknown> &to = out.unknowns[is_object ? source : LOST_SCENE];
    to.insert(to.end(), unknowns.begin(), unknowns.end());
  }
  return out;
}

/** A row of source, message, object and missing for each. */
std::vector<std::string> toTable(const UnknownsBySource &unknowns) {
  std::vector<std::string> out;
  for (const auto &[source, list] : unknowns)
    for (const Unknown &unknown : list)
      out.insert(out.end(), {source, unknown.message, unknown.object,
                             unknown.missing == Missing::GEOMETRY ? "geometry" : "anything"});
  return out;
}

UnknownsBySource fromTable(const std::vector<std::string> &table) {
  UnknownsBySource out;
  for (std::size_t i = 0; i + 3 < table.size(); i += 4)
    out[table[i]].push_back(
        {table[i + 1], table[i + 2], table[i + 3] == "geometry" ? Missing::GEOMETRY : Missing::ANYTHING});
  return out;
}

KeptScene keptFrom(std::string bytes, bool behind) {
  KeptScene out;
  std::vector<std::string> unknowns;
  std::uint8_t replaces_srdf = 0;
  CheckedStream stream(reinterpret_cast<std::uint8_t *>(bytes.data()), bytes.size());
  stream.next(out.sensors);
  stream.next(unknowns);
  stream.next(replaces_srdf);
  stream.next(out.request);
  out.unknowns = fromTable(unknowns);
  out.replaces_srdf = replaces_srdf != 0;
  out.behind = behind;
  return out;
}

} // namespace

StateFile::StateFile(const ros::NodeHandle &handle, const Parameters &parameters, LiveScene &live)
    : live_(live),
      handle_(onQueue(handle, queue_)),
      path_(parameters.state_file == "auto" ? automaticPath(handle.getNamespace()) : parameters.state_file),
      fixed_frame_(parameters.fixed_frame) {
  handle_.getParam("/run_id", run_);
  std::string name;
  const std::string description = robotText(handle, parameters, name);
  Hasher beginning;
  for (const std::string *part : {&parameters.scene_file, &description, &fixed_frame_}) beginning.add(*part);
  beginning_ = toHex(beginning.add(textOf(parameters.scene_file)).finish());
}

StateFile::~StateFile() {
  timer_.stop();
  queue_.end();
  told_ = true; // the master may be gone
  if (watching_) write();
}

std::optional<KeptScene> StateFile::read() {
  std::string before; // the run in which a server of this name had a scene
  handle_.getParam(KEPT_BY_SERVER, before);
  std::ifstream file(path_, std::ios::binary);
  std::string state, run, beginning, md5;
  for (std::string *line : {&state, &run, &beginning, &md5}) std::getline(file, *line);
  const bool of_this_run = isKept() && run == run_;
  std::optional<KeptScene> out;
  if (of_this_run && !beginning.empty() && beginning != beginning_) {
    ROS_WARN(
        "the scene of the server before this one is not taken over: it began with another scene file, robot or "
        "fixed frame");
  } else {
    if (of_this_run && md5 == ros::message_traits::md5sum<ApplySceneRequest>()) {
      std::ostringstream rest;
      rest << file.rdbuf();
      guarded([&] { out = keptFrom(rest.str(), state == BEHIND); },
              [&](const std::string &why) { ROS_WARN("'%s' is not used: %s", path_.c_str(), why.c_str()); });
    }
    if (!out && !run_.empty() && (of_this_run || before == run_)) lose();
  }
  std::error_code none;
  if (!out) std::filesystem::remove(path_, none);
  return out;
}

void StateFile::lose() {
  // Missing::ANYTHING: what was moved or removed last is back where it was
  live_.unknowns.set(LOST_SCENE, {{"the scene of the server before this one, or its last change, is lost, and none has "
                                   "been sent since: send the whole of it again (clear: true)",
                                   "", Missing::ANYTHING}});
  ROS_WARN("the scene of the server before this one is lost: answers say so until a whole scene is sent");
  changed();
}

/** Without a run nothing would tell this one from the next one. */
bool StateFile::isKept() const {
  return !path_.empty() && !run_.empty();
}

/** For a server that comes after this one, should it be killed. */
void StateFile::markBehind() const {
  if (!isKept()) return;
  std::fstream file(path_, std::ios::in | std::ios::out | std::ios::binary);
  if (!file.is_open()) file.open(path_, std::ios::out | std::ios::binary);
  file << BEHIND << '\n' << run_ << '\n' << beginning_ << '\n';
}

void StateFile::watch() {
  std::error_code none; // then the first writing says so
  if (isKept()) std::filesystem::create_directories(std::filesystem::path(path_).parent_path(), none);
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    watching_ = changed_ = true; // who comes after this one is to know what it began with
    markBehind();
  }
  timer_ = handle_.createWallTimer(ros::WallDuration(WRITING_PERIOD), [this](const ros::WallTimerEvent &) { write(); });
  queue_.start();
}

void StateFile::changed() {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!changed_ && watching_) markBehind();
  changed_ = true;
}

void StateFile::write() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!changed_) return;
    changed_ = false;
  }
  guarded(
      [&] {
        if (!told_) handle_.setParam(KEPT_BY_SERVER, run_);
        told_ = true;
        if (!isKept()) return;
        const KeptScene kept = keptOf(live_, fixed_frame_);
        const std::string beside = path_ + "." + std::to_string(getpid()) + ".new";
        std::ofstream file(beside, std::ios::binary);
        file << WRITTEN << '\n'
             << run_ << '\n'
             << beginning_ << '\n'
             << ros::message_traits::md5sum<ApplySceneRequest>() << '\n'
             << serialised(kept.sensors) << serialised(toTable(kept.unknowns))
             << serialised(std::uint8_t{kept.replaces_srdf}) << serialised(kept.request);
        file.close();
        if (!file) throw Error("'" + path_ + "' cannot be written");
        const std::lock_guard<std::mutex> lock(mutex_);
        if (!changed_) std::filesystem::rename(beside, path_);
        failed_ = false;
      },
      [&](const std::string &why) {
        if (!failed_) ROS_WARN("the scene is not kept: %s", why.c_str());
        failed_ = true;
      });
}

} // namespace curve_proximity
