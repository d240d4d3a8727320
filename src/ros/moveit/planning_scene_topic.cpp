/* SPDX-License-Identifier: BSD-3-Clause */
#include "moveit/planning_scene_topic.h"

#include <ros/console.h>

#include <algorithm>
#include <curve_proximity/fingerprint.hpp>
#include <iterator>
#include <limits>
#include <utility>

#include "transport/checked_stream.h"
#include "transport/guard.h"
#include "transport/memory_account.h"
#include "transport/request_limits.h"

namespace curve_proximity {
namespace {

/** Diffs that may wait while one is applied; each says what the others do not. */
constexpr std::uint32_t SCENES_KEPT = 100;

/** What a message takes in memory, for a byte on the wire, as for ~apply_scene. */
constexpr std::size_t TIMES_WIRE = 5;

/** Sentences in one line of the log. */
constexpr std::size_t MOST_SENTENCES = 10;

/** [s] Between requests until there is a scene, and until nothing of it differs. */
constexpr double ASK_AGAIN = 1.0;

/** All parts of moveit_msgs/PlanningSceneComponents. */
constexpr std::uint32_t ALL_COMPONENTS = 1023;

/** How soon a new publisher is noticed: roscpp does not tell. */
constexpr std::chrono::milliseconds LOOK_FOR_END{100};

const char *const NO_FULL_SCENE =
    "~planning_scene has sent diffs and no full scene: what else is in that scene is not known";

const char *const NO_SCENE = "no planning scene has come: ~ask_planning_scene expects one of move_group";

const char *const GONE = "move_group has gone: what it would change of its scene is not known";

std::string joined(const std::vector<std::string> &messages) {
  std::string out;
  for (std::size_t i = 0; i < messages.size() && i < MOST_SENTENCES; ++i) out += (i ? "; " : "") + messages[i];
  if (messages.size() > MOST_SENTENCES) out += "; and " + std::to_string(messages.size() - MOST_SENTENCES) + " more";
  return out;
}

/** Those of the first that are among the others, or are not. */
std::vector<std::string> chosen(const std::vector<std::string> &messages, const std::vector<std::string> &others,
                                bool among) {
  std::vector<std::string> out;
  std::copy_if(messages.begin(), messages.end(), std::back_inserter(out), [&](const std::string &message) {
    return (std::find(others.begin(), others.end(), message) != others.end()) == among;
  });
  return out;
}

/** Throws Error for a name that is too long. */
void checkNames(const moveit::PlanningScene &scene, const NameLimits &limits) {
  const auto object = [&](const moveit::CollisionObject &given) {
    limits.check(given.id);
    limits.check(given.header.frame_id);
    limits.check(given.subframe_names);
  };
  for (const moveit::CollisionObject &given : scene.world.collision_objects) object(given);
  for (const moveit::AttachedCollisionObject &given : scene.robot_state.attached_collision_objects) {
    object(given.object);
    limits.check(given.link_name);
    limits.check(given.touch_links);
  }
  limits.check(scene.robot_state.joint_state.name);
  limits.check(scene.allowed_collision_matrix.entry_names);
  limits.check(scene.allowed_collision_matrix.default_entry_names);
  for (const moveit::LinkPadding &given : scene.link_padding) limits.check(given.link_name);
  for (const moveit::LinkScale &given : scene.link_scale) limits.check(given.link_name);
  limits.check(scene.fixed_frame_transforms);
}

} // namespace

PlanningSceneTopic::PlanningSceneTopic(const ros::NodeHandle &handle, const Parameters &parameters, LiveScene &live,
                                       const Frames &frames, Apply apply, LinkPose link_pose)
    : parameters_(parameters),
      live_(live),
      frames_(frames),
      apply_(std::move(apply)),
      link_pose_(std::move(link_pose)),
      handle_(onQueue(handle, queue_)) {
  ros::SubscribeOptions topic = checkedSubscription<moveit::PlanningScene>(
      "planning_scene", SCENES_KEPT,
      [this](const moveit::PlanningSceneConstPtr &message) { take(*message, "~planning_scene"); });
  publishUnknowns();
  subscriber_ = handle_.subscribe(topic);
  queue_.start();
  asking_queue_.start();
  if (parameters_.ask_planning_scene) asking_queue_.post([this] { ask(); });
}

PlanningSceneTopic::~PlanningSceneTopic() {
  {
    const std::lock_guard<std::mutex> lock(asking_);
    ending_ = true;
    client_.shutdown(); // a call that nobody answers ends, too
  }
  wake_.notify_all();
  asking_queue_.end();
  subscriber_.shutdown();
  queue_.end();
}

PlanningSceneReport PlanningSceneTopic::report() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return report_;
}

/** Objects of sensors are not move_group's: a full scene leaves them. */
PlanningSceneContext PlanningSceneTopic::context(const Snapshot &snapshot, FrameLookup &lookup) const {
  PlanningSceneContext out{snapshot, state_, {}, parameters_.unknown_is_occupied, {}, {}};
  for (const SensorState &sensor : live_.sensors.states()) out.kept.insert(sensor.id);
  out.to_fixed = [&lookup](const std::string &frame) { return lookup.toFixed(frame, ros::Time()); };
  out.link_to_fixed = [this, &snapshot, &lookup](const std::string &link, const JointPositions &joints) {
    return link_pose_(link, joints, snapshot, lookup);
  };
  return out;
}

void PlanningSceneTopic::take(const moveit::PlanningScene &message, const char *source) {
  const std::lock_guard<std::mutex> lock(taking_);
  tryToUse(message, source);
  publishUnknowns();
}

void PlanningSceneTopic::tryToUse(const moveit::PlanningScene &message, const char *source) {
  guarded([&] { use(message); },
          [&](const std::string &why) {
            keepUnused({why}, false);
            warn(std::string(source) + ": a scene is not used: " + why);
          });
}

void PlanningSceneTopic::use(const moveit::PlanningScene &message) {
  const std::size_t bytes = ros::serialization::serializationLength(message);
  const memory::Share share(TIMES_WIRE * bytes, static_cast<std::size_t>(parameters_.max_request_mb) << 20);
  checkNames(message, NameLimits(parameters_.max_name_length));
  FrameLookup lookup(frames_);
  const SnapshotPtr before = live_.scene.snapshot();
  PlanningSceneChange change = toSceneChange(message, context(*before, lookup));
  std::vector<std::string> wrong = std::move(change.wrong);
  for (std::string &fault : apply_(change.change, *before)) wrong.push_back(std::move(fault));
  state_ = std::move(change.state);
  if (message.is_diff == 0 && wrong.empty()) live_.unknowns.forget(LOST_SCENE);
  live_.joints.take(message.robot_state.joint_state, before->robot().get(), false);

  {
    const std::lock_guard<std::mutex> lock(mutex_);
    const bool full = message.is_diff == 0;
    ++(full ? report_.full : report_.diffs);
    report_.diffs_since_full = full ? 0 : report_.diffs_since_full + 1;
    (full ? report_.fingerprint : report_.diff_fingerprint) = fingerprint(message);
  }
  keepUnused(wrong, message.is_diff == 0);
  if (!wrong.empty()) warn("~planning_scene: " + joined(wrong) + "; the rest is used");
}

std::vector<std::string> PlanningSceneTopic::differencesTo(const moveit::PlanningScene &message) const {
  constexpr std::size_t MOST = 100;
  const std::size_t bytes = ros::serialization::serializationLength(message);
  const memory::Share share(TIMES_WIRE * bytes, static_cast<std::size_t>(parameters_.max_request_mb) << 20);
  checkNames(message, NameLimits(parameters_.max_name_length));
  FrameLookup lookup(frames_);
  const SnapshotPtr before = live_.scene.snapshot();
  return differences(message, context(*before, lookup), MOST);
}

/** A difference that one answer shows and the next does not was a diff on its way. One that both show is a diff that
 *  never came: then the scene becomes the answer. What still differs after that is reported, and is no reason to take
 *  the next answer as well. */
bool PlanningSceneTopic::compare(const moveit::PlanningScene &message) {
  const std::lock_guard<std::mutex> lock(taking_);
  bool same = false;
  guarded(
      [&] {
        std::vector<std::string> now = differencesTo(message);
        std::vector<std::string> both = chosen(now, suspected_, true);
        beyond_repair_ = chosen(beyond_repair_, now, true); // what has come right may be lost again
        const std::vector<std::string> lost = chosen(both, beyond_repair_, false);
        if (!lost.empty()) {
          warn("~planning_scene lacked what ~get_planning_scene has, and that scene replaces the one here: " +
               joined(lost));
          tryToUse(message, "~get_planning_scene");
          both = now = beyond_repair_ = differencesTo(message);
        }
        same = lost.empty() && chosen(now, beyond_repair_, false).empty();
        suspected_ = std::move(now);
        const std::lock_guard<std::mutex> report(mutex_);
        ++report_.checks;
        report_.replaced += lost.empty() ? 0 : 1;
        report_.differences = std::move(both);
        if (suspected_.empty()) report_.unused.clear();
      },
      [&](const std::string &why) { warn("~get_planning_scene: the scene cannot be compared: " + why); });
  const std::vector<std::string> found = report().differences;
  if (!found.empty()) warn("the scene differs from that of ~get_planning_scene: " + joined(found));
  publishUnknowns();
  return same;
}

/** What is missing stays missing until a full scene comes, or a comparison finds nothing. */
void PlanningSceneTopic::keepUnused(const std::vector<std::string> &wrong, bool full) {
  const std::lock_guard<std::mutex> lock(mutex_);
  std::vector<std::string> &unused = report_.unused;
  if (full) unused.clear();
  for (const std::string &what : wrong) {
    const bool known = std::find(unused.begin(), unused.end(), what) != unused.end();
    if (!known && unused.size() < MOST_SENTENCES) unused.push_back(what);
  }
}

/** What answers do not know of the scene. */
void PlanningSceneTopic::publishUnknowns() {
  const PlanningSceneReport now = report();
  std::vector<Unknown> unknowns;
  if (now.full == 0 && now.diffs > 0) unknowns.push_back({NO_FULL_SCENE, ""});
  if (now.gone) unknowns.push_back({GONE, "", Missing::ANYTHING});
  if (!now.unused.empty())
    unknowns.push_back({"not used of ~planning_scene: " + joined(now.unused), "", Missing::ANYTHING});
  if (!now.differences.empty())
    unknowns.push_back(
        {"the scene differs from that of ~get_planning_scene: " + joined(now.differences), "", Missing::ANYTHING});
  if (now.full == 0 && now.diffs == 1) warn(NO_FULL_SCENE);
  live_.unknowns.set("planning scene", std::move(unknowns));
  const bool awaited = now.full == 0 && now.diffs == 0 && parameters_.ask_planning_scene;
  live_.unknowns.set(AWAITED_SCENE, awaited ? std::vector<Unknown>{{NO_SCENE, ""}} : std::vector<Unknown>{});
}

void PlanningSceneTopic::setGone(bool gone) {
  const std::lock_guard<std::mutex> lock(taking_);
  {
    const std::lock_guard<std::mutex> report(mutex_);
    if (std::exchange(report_.gone, gone) == gone) return;
  }
  if (gone) warn(GONE);
  publishUnknowns();
}

void PlanningSceneTopic::warn(const std::string &why) {
  if (log_limit_.isDue(why)) ROS_WARN_STREAM(why);
}

/* ---- the service ---- */

/** A diff that is published before the topic is connected is lost. So the scene is asked for when the topic has a
 *  publisher, anew whenever it gets another one, and once where it has none. Then comparisons follow: until one finds
 *  nothing, and after that as often as ~check_planning_scene says. */
void PlanningSceneTopic::ask() {
  const double never = std::numeric_limits<double>::infinity();
  const double check = parameters_.check_planning_scene == 0.0 ? never : parameters_.check_planning_scene;
  std::uint32_t publishers = 0;
  double period = ASK_AGAIN;
  bool begun = false;
  while (wait(period, publishers, begun)) {
    moveit::PlanningScene scene;
    bool same = false;
    if (askOnce(scene)) {
      scene.is_diff = scene.robot_state.is_diff = 0;
      if (begun)
        same = compare(scene);
      else
        take(scene, "~get_planning_scene");
      begun = true;
      setGone(false);
    }
    const bool settled = begun && (same || publishers == 0);
    period = settled ? check : ASK_AGAIN;
  }
}

/** False: the topic ends. A publisher more, and a service that goes, end the waiting, and what had begun. */
bool PlanningSceneTopic::wait(double period, std::uint32_t &publishers, bool &begun) {
  const auto start = std::chrono::steady_clock::now();
  std::unique_lock<std::mutex> lock(asking_);
  while (!ending_) {
    const std::uint32_t before = std::exchange(publishers, subscriber_.getNumPublishers());
    const bool gone = begun && !client_.isValid(); // the connection ends with move_group
    if (gone) setGone(true);
    if (gone || publishers > before) {
      begun = false;
      return true;
    }
    const std::chrono::duration<double> left =
        std::chrono::duration<double>(period) - (std::chrono::steady_clock::now() - start);
    if (left.count() <= 0.0) return true;
    wake_.wait_for(lock, std::min<std::chrono::duration<double>>(left, LOOK_FOR_END));
  }
  return false;
}

bool PlanningSceneTopic::askOnce(moveit::PlanningScene &scene) {
  ros::ServiceClient client;
  {
    const std::lock_guard<std::mutex> lock(asking_);
    if (ending_) return false;
    if (!client_.isValid()) client_ = handle_.serviceClient<moveit::GetPlanningScene>("get_planning_scene", true);
    client = client_;
  }
  if (!client.isValid()) return false;
  bool good = false;
  guarded(
      [&] {
        moveit::GetPlanningSceneRequest all;
        all.components.components = ALL_COMPONENTS;
        const ros::SerializedMessage request = ros::serialization::serializeMessage(all);
        ros::SerializedMessage answer;
        if (!client.call(request, answer, ros::service_traits::md5sum<moveit::GetPlanningScene>())) return;
        const auto read = static_cast<std::size_t>(answer.message_start - answer.buf.get());
        CheckedStream stream(answer.message_start, answer.num_bytes - read);
        moveit::GetPlanningSceneResponse response;
        stream.next(response);
        scene = std::move(response.scene);
        good = true;
      },
      [&](const std::string &why) { warn("~get_planning_scene: " + why); });
  if (good) return true;
  const std::lock_guard<std::mutex> lock(asking_); // roscpp frees a connection twice that two threads end at once
  client.shutdown();
  return false;
}

} // namespace curve_proximity
