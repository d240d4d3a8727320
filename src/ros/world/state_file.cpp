/* SPDX-License-Identifier: BSD-3-Clause */
#include "world/state_file.h"

#include <fcntl.h>
#include <ros/console.h>
#include <ros/serialization.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "../../scene/base/digest.h"
#include "messages/scene_message.h"
#include "transport/guard.h"
#include "world/robot_description.h"

namespace curve_proximity {
namespace {

constexpr const char *MAGIC = "curve_proximity scene 5";
constexpr std::chrono::seconds WRITING_PERIOD{1}; /* between two writings at least */
constexpr std::size_t MOST_BYTES = std::size_t{64} << 20;

std::string digestTextOf(const std::string &bytes) {
  return toHex(digestOf(bytes.data(), bytes.size()));
}

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

/** All of a file, or nothing: written beside it, flushed, then renamed. */
void writeAtomically(const std::string &path, const std::string &text) {
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  if (!folder.empty()) std::filesystem::create_directories(folder);
  const std::string beside = path + "." + std::to_string(getpid()) + ".new";
  const int file = open(beside.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
  bool good = file >= 0;
  for (std::size_t done = 0; good && done < text.size();) {
    const ssize_t n = ::write(file, text.data() + done, text.size() - done);
    good = n > 0;
    done += good ? static_cast<std::size_t>(n) : 0;
  }
  good = good && fsync(file) == 0;
  if (file >= 0) good = close(file) == 0 && good;
  good = good && std::rename(beside.c_str(), path.c_str()) == 0;
  if (good) return;
  unlink(beside.c_str());
  throw Error("'" + path + "' cannot be written");
}

/** What is to be there again; objects that sensors keep come by themselves. */
KeptScene keptOf(const LiveScene &live, const std::string &fixed_frame) {
  KeptScene out;
  for (const SensorState &sensor : live.sensors.states()) out.sensors.push_back(sensor.id);
  GetSceneResponse scene;
  const SnapshotPtr snapshot = live.scene.snapshot();
  toMessage(*snapshot, {}, scene);
  out.replaces_srdf = snapshot->replacesSrdf();
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

} // namespace

StateFile::StateFile(const ros::NodeHandle &handle, const Parameters &parameters, LiveScene &live)
    : live_(live),
      handle_(handle),
      path_(parameters.state_file == "auto" ? automaticPath(handle.getNamespace()) : parameters.state_file) {
  handle_.getParam("/run_id", run_);
  std::string name;
  const std::string description = robotText(handle, parameters, name);
  Hasher beginning;
  for (const std::string *part : {&parameters.scene_file, &description, &parameters.fixed_frame}) beginning.add(*part);
  beginning_ = toHex(beginning.add(textOf(parameters.scene_file)).finish());
}

StateFile::~StateFile() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ending_ = true;
  }
  wake_.notify_all();
  queue_.end();
  if (watching_ && changed_) writeChanges();
}

std::optional<KeptScene> StateFile::read() {
  std::string before; // the run in which a server of this name had a scene
  handle_.getParam(KEPT_BY_SERVER, before);
  const bool is_behind = isKept() && textOf(behindPath()) == run_;
  bool expected = !run_.empty() && (before == run_ || is_behind);
  std::optional<KeptScene> out;
  const auto complain = [&](const std::string &why) {
    ROS_WARN("the state file '%s' is not used: %s", path_.c_str(), why.c_str());
  };
  guarded(
      [&] {
        if (!isKept()) return;
        std::ifstream file(path_, std::ios::binary);
        if (!file) return;
        std::string magic, run, beginning, md5, size, digest;
        for (std::string *line : {&magic, &run, &beginning, &md5, &size, &digest}) std::getline(file, *line);
        if (magic != MAGIC) throw Error("it is none");
        if (run != run_) return; // another run's
        if (beginning != beginning_) {
          expected = false;
          ROS_WARN(
              "the scene of the server before this one is not taken over: it began with another scene file, robot "
              "or fixed frame");
          return;
        }
        if (md5 != ros::message_traits::md5sum<ApplySceneRequest>()) throw Error("it is of another version");
        std::ostringstream rest;
        rest << file.rdbuf();
        const std::string bytes = rest.str();
        if (std::to_string(bytes.size()) != size || digestTextOf(bytes) != digest) throw Error("it is damaged");
        KeptScene kept;
        ros::serialization::IStream stream(reinterpret_cast<std::uint8_t *>(const_cast<char *>(bytes.data())),
                                           static_cast<std::uint32_t>(bytes.size()));
        ros::serialization::deserialize(stream, kept.sensors);
        std::vector<std::string> unknowns;
        ros::serialization::deserialize(stream, unknowns);
        kept.unknowns = fromTable(unknowns);
        std::uint8_t replaces_srdf = 0;
        ros::serialization::deserialize(stream, replaces_srdf);
        kept.replaces_srdf = replaces_srdf != 0;
        ros::serialization::deserialize(stream, kept.request);
        kept.behind = is_behind;
        out = std::move(kept);
      },
      complain);
  if (expected && !out) lose();
  return out;
}

void StateFile::lose() {
  live_.unknowns.set(LOST_SCENE,
                     {{"the scene of the server before this one, or its last change, is lost, and none has been "
                       "sent since: send the whole of it again (clear: true)",
                       "", Missing::ANYTHING}}); // what was moved or removed last is back where it was
  ROS_WARN("the scene of the server before this one is lost: answers say so until a whole scene is sent");
}

/** For a server that comes after this one, should it be killed. */
void StateFile::markBehind() const {
  if (isKept()) std::ofstream(behindPath()) << run_;
}

/** Without a run nothing would tell this one from the next one. */
bool StateFile::isKept() const {
  return !path_.empty() && !run_.empty();
}

std::string StateFile::behindPath() const {
  return path_ + ".behind";
}

void StateFile::watch(const std::string &fixed_frame) {
  const std::lock_guard<std::mutex> lock(mutex_);
  fixed_frame_ = fixed_frame;
  watching_ = true;
  queue_.start();
  if (!changed_) return;
  markBehind();
  writeSoon();
}

void StateFile::changed() {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!changed_ && watching_) markBehind();
  changed_ = true;
  if (watching_) writeSoon();
}

/** The lock is held. */
void StateFile::writeSoon() {
  if (awaits_writing_) return;
  awaits_writing_ = true;
  queue_.post([this] {
    {
      std::unique_lock<std::mutex> lock(mutex_);
      wake_.wait_until(lock, may_write_, [this] { return ending_; });
      awaits_writing_ = false;
    }
    writeChanges();
    may_write_ = std::chrono::steady_clock::now() + WRITING_PERIOD;
  });
}

void StateFile::writeChanges() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    changed_ = false;
  }
  guarded(
      [&] {
        if (!told_ && !ending_) handle_.setParam(KEPT_BY_SERVER, run_);
        told_ = true;
        write();
        const std::lock_guard<std::mutex> lock(mutex_);
        if (!changed_) std::filesystem::remove(behindPath());
      },
      [&](const std::string &why) {
        if (!failed_) ROS_WARN("the scene is not kept: %s", why.c_str());
        failed_ = true;
      });
}

void StateFile::write() {
  if (!isKept()) return;
  const KeptScene kept = keptOf(live_, fixed_frame_);
  const std::string bytes = serialised(kept.sensors) + serialised(toTable(kept.unknowns)) +
                            serialised(std::uint8_t{kept.replaces_srdf}) + serialised(kept.request);
  std::ostringstream text;
  text << MAGIC << '\n'
       << run_ << '\n'
       << beginning_ << '\n'
       << ros::message_traits::md5sum<ApplySceneRequest>() << '\n'
       << bytes.size() << '\n'
       << digestTextOf(bytes) << '\n'
       << bytes;
  writeAtomically(path_, text.str());
  failed_ = false;
}

} // namespace curve_proximity
