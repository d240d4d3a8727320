/* SPDX-License-Identifier: BSD-3-Clause */
#include "world/live_scene.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <set>
#include <sstream>
#include <utility>

#include "../../scene/robot/free_joints.h"
#include "messages/trajectory_message.h"

namespace curve_proximity {
namespace {

const VirtualJoint *fixedJointOf(const Robot &robot, const Srdf &srdf) {
  for (const VirtualJoint &joint : srdf.virtual_joints)
    if (joint.type == "fixed" && joint.child_link == robot.rootLink()) return &joint;
  return nullptr;
}

/** The names of the values that say where a joint is. */
std::vector<std::string> variablesOf(const Robot::Joint &joint) {
  const bool planar = joint.type == Robot::JointType::PLANAR;
  if (planar || joint.type == Robot::JointType::FLOATING) return variablesOf(FreeJoint{joint.name, planar, "", false});
  return {joint.leader.empty() ? joint.name : joint.leader};
}

} // namespace

SceneState LiveScene::state(const Snapshot &snapshot, std::vector<SensorState> seen) const {
  SceneState out;
  out.epoch = epoch;
  out.version = snapshot.version();
  out.joint_state_age = out.transform_age = std::numeric_limits<double>::quiet_NaN();
  out.sensors = std::move(seen);
  out.objects =
      static_cast<std::uint32_t>(snapshot.objects().size() + snapshot.moving().size() + snapshot.attached().size());
  if (!snapshot.robot()) return out;
  for (const auto &link : snapshot.robot()->links()) out.links += !link.second.empty();
  return out;
}

SceneState LiveScene::state() const {
  Seen now = seen();
  return state(*now.snapshot, std::move(now.sensors));
}

/* What is unknown is looked at before the scene: an object may be newer than what is said of it, and not older. Where
 * nothing of the sensors changes meanwhile, their states and the scene are of one moment. */
LiveScene::Seen LiveScene::seen() const {
  constexpr int MOST = 100;
  Seen out;
  for (int i = 0; i < MOST; ++i) {
    const std::uint64_t changes = sensors.changes();
    out.unknowns = unknowns.all();
    out.snapshot = scene.snapshot();
    out.sensors = sensors.states(out.snapshot->version());
    if (sensors.changes() == changes) return out;
  }
  for (SensorState &sensor : out.sensors) sensor.unknown = true;
  return out;
}

std::vector<std::string> LiveScene::apply(const SceneChange &change, const Snapshot &before) {
  const auto removesAll = [](const Operation &operation) {
    return operation.kind == Operation::Kind::REMOVE && operation.object.id.empty();
  };
  std::optional<SensorBoard::Emptying> emptying;
  if (change.clear || std::any_of(change.operations.begin(), change.operations.end(), removesAll))
    emptying.emplace(sensors, std::vector<std::string>());
  else if (change.clear_objects)
    emptying.emplace(sensors, change.kept);
  std::uint64_t version = 0;
  std::vector<std::string> errors = scene.apply(change, [&](std::uint64_t applied) { version = applied; });

  // What somebody has set or removed by name is no sensor's until its next message.
  const SnapshotPtr after = scene.snapshot();
  if (!errors.empty()) version = after->version();
  const auto object = [](const Snapshot &snapshot, const std::string &id) {
    const auto found = snapshot.objects().find(id);
    return found == snapshot.objects().end() ? nullptr : found->second;
  };
  for (const Operation &operation : change.operations) {
    const std::string &id = operation.object.id;
    if (!errors.empty() && object(before, id) == object(*after, id)) continue;
    // what is moved, or has another part, is as unknown as before
    if (operation.kind != Operation::Kind::ADD && operation.kind != Operation::Kind::REMOVE) continue;
    if (!removesAll(operation)) sensors.forget(id, version);
    unknowns.forget(REFUSED_OBJECT + id);
  }
  for (const Attachment &attachment : change.attachments)
    if (errors.empty() && attachment.kind == Attachment::Kind::ATTACH && !attachment.object.shapes.empty())
      unknowns.forget(REFUSED_OBJECT + attachment.object.id);
  if (change.clear) {
    unknowns.forgetAll(REFUSED_OBJECT);
    unknowns.forget(REFUSED_OBJECTS);
  }
  return errors;
}

void LiveScene::applySeen(const SceneChange &change, const std::string &id, const ros::Time &stamp) {
  const std::uint64_t emptied = sensors.emptied();
  const auto note = [&](std::uint64_t version) { sensors.saw(id, stamp, emptied, version); };
  for (const std::string &error : scene.apply(change, note)) throw Error(error);
}

void LiveScene::refuse(const std::string &topic, const std::string &id, const std::string &about,
                       const std::string &why, std::size_t most_name) {
  constexpr std::size_t MOST = 1000;
  const std::string source = REFUSED_OBJECT + id;
  const UnknownsBySource others = unknowns.bySource();
  if (id.size() > most_name || (others.size() >= MOST && others.count(source) == 0))
    return unknowns.set(REFUSED_OBJECTS,
                        {{topic + ": objects are not used, the last one because " + why, "", Missing::ANYTHING}});
  // as it was before it may be here still
  const SnapshotPtr now = scene.snapshot();
  const bool is_here = now->objects().count(id) + now->moving().count(id) + now->attached().count(id) > 0;
  unknowns.set(source, {{topic + ": object '" + id + "' is not used: " + why, about,
                         is_here ? Missing::ANYTHING : Missing::GEOMETRY}});
}

const std::vector<std::array<std::string, 2>> &LiveScene::disabled(const Snapshot &snapshot) const {
  static const std::vector<std::array<std::string, 2>> none;
  return snapshot.replacesSrdf() ? none : srdf.disabled;
}

void LiveScene::demand(const Snapshot &snapshot, const ros::Time &epoch_wanted, std::uint64_t version_wanted) const {
  if (!epoch_wanted.isZero() && epoch_wanted != epoch) {
    std::ostringstream what;
    what << "scene_epoch is " << epoch_wanted << ", and this server started at " << epoch
         << ": what was sent to the one before may be lost";
    throw Error(what.str());
  }
  if (version_wanted > snapshot.version())
    throw Error("scene_version is " + std::to_string(version_wanted) + ", and the scene is at version " +
                std::to_string(snapshot.version()));
}

Eigen::Isometry3d rootPose(const Robot &robot, const Srdf &srdf, const ros::Time &stamp, FrameLookup &lookup) {
  const VirtualJoint *joint = fixedJointOf(robot, srdf);
  const bool by_tf = !joint || lookup.frames().has(robot.rootLink(), stamp);
  if (by_tf) return lookup.toFixed(robot.rootLink(), stamp);
  if (lookup.frames().settled()) return lookup.toFixed(joint->parent_frame, stamp);
  try {
    return lookup.toFixed(robot.rootLink(), stamp); // in the first moments tf2 may still hear of it
  } catch (const Error &) {
    return lookup.toFixed(joint->parent_frame, stamp);
  }
}

CurrentJoints currentJoints(const sensor_msgs::JointState &given, bool current, const JointBoard &board,
                            bool may_be_none) {
  CurrentJoints out;
  out.positions = toJointPositions(given);
  if (!current) return out;
  for (const auto &[name, joint] : board.joints()) {
    if (!out.positions.emplace(name, joint.position).second) continue;
    out.age = std::fmax(out.age, joint.age.seconds());
  }
  if (out.positions.empty() && !may_be_none)
    throw Error("no joint position is known: joint_state names none, and none has come on ~joint_states");
  return out;
}

std::string unknownJoints(const Robot &robot, const std::vector<std::string> &moved, const JointPositions &positions,
                          const std::vector<std::string> &assumed, const std::string &link) {
  constexpr std::size_t MOST = 5;
  const auto among = [](const std::vector<std::string> &names, const std::string &name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  const auto is_told = [&](const std::string &variable) {
    return positions.count(variable) > 0 || among(moved, variable) || among(assumed, variable);
  };
  std::set<std::string> above{link}, unknown; // links from `link` to the root; joints
  for (auto joint = robot.joints().rbegin(); joint != robot.joints().rend(); ++joint) { // children first
    if (!link.empty() && above.count(joint->child) == 0) continue;
    above.insert(joint->parent);
    if (joint->type == Robot::JointType::FIXED) continue;
    const std::string &name = joint->leader.empty() ? joint->name : joint->leader;
    const std::vector<std::string> variables = variablesOf(*joint);
    if (!among(assumed, name) && !std::all_of(variables.begin(), variables.end(), is_told)) unknown.insert(name);
  }
  if (unknown.empty()) return "";
  std::string names;
  std::size_t n = 0;
  for (const std::string &name : unknown)
    if (n++ < MOST) names += (names.empty() ? "'" : ", '") + name + "'";
  if (n > MOST) names += " and " + std::to_string(n - MOST) + " more";
  return "where joint " + names + " is was not told: neither by the request nor on ~joint_states (~assumed_joints)";
}

} // namespace curve_proximity
