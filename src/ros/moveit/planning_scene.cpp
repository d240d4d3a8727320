/* SPDX-License-Identifier: BSD-3-Clause */
#include "moveit/planning_scene.h"

#include <algorithm>
#include <cmath>
#include <curve_proximity/nearest_name.hpp>
#include <optional>

#include "messages/geometry_message.h"
#include "messages/scene_message.h"
#include "messages/shape_message.h"

namespace curve_proximity {
namespace {

using moveit::PlanningScene;

/* ---- messages ---- */

/** To MoveIt a quaternion of zeros is no rotation. */
geometry_msgs::Pose withRotation(geometry_msgs::Pose pose) {
  const geometry_msgs::Quaternion &q = pose.orientation;
  if (q.x == 0.0 && q.y == 0.0 && q.z == 0.0 && q.w == 0.0) pose.orientation.w = 1.0;
  return pose;
}

/** As many poses as shapes: to MoveIt those that are missing are the identity. */
std::vector<geometry_msgs::Pose> posesOf(const std::vector<geometry_msgs::Pose> &given, std::size_t shapes) {
  std::vector<geometry_msgs::Pose> out;
  for (const geometry_msgs::Pose &pose : given) out.push_back(withRotation(pose));
  if (out.size() < shapes) out.resize(shapes, withRotation(geometry_msgs::Pose()));
  return out;
}

/** The object without its frame. Throws Error. A single shape of an object without a pose gives the object its pose. */
ObjectDescription toObject(const moveit::CollisionObject &given) {
  CollisionObject message;
  message.id = given.id;
  message.pose = withRotation(given.pose);
  message.operation = CollisionObject::ADD;
  message.primitives = given.primitives;
  message.primitive_poses = posesOf(given.primitive_poses, given.primitives.size());
  message.meshes = given.meshes;
  message.mesh_poses = posesOf(given.mesh_poses, given.meshes.size());
  message.planes = given.planes;
  message.plane_poses = posesOf(given.plane_poses, given.planes.size());
  ObjectDescription object = toOperation(message).object;
  if (object.shapes.size() == 1 && isUnset(given.pose)) std::swap(object.pose, object.shapes.front().pose);
  return object;
}

bool hasShapes(const moveit::CollisionObject &object) {
  return !object.primitives.empty() || !object.meshes.empty() || !object.planes.empty();
}

/** In the order of the shapes of an object: primitives, meshes, planes. */
std::vector<Eigen::Isometry3d> shapePoses(const moveit::CollisionObject &object) {
  std::vector<Eigen::Isometry3d> out;
  for (const auto *poses : {&object.primitive_poses, &object.mesh_poses, &object.plane_poses})
    for (const geometry_msgs::Pose &pose : *poses) out.push_back(toIsometry(withRotation(pose)));
  return out;
}

PlanningSceneState::Subframes toSubframes(const moveit::CollisionObject &object) {
  if (object.subframe_names.size() != object.subframe_poses.size())
    throw Error(std::to_string(object.subframe_names.size()) + " subframe_names have " +
                std::to_string(object.subframe_poses.size()) + " subframe_poses");
  PlanningSceneState::Subframes out;
  for (std::size_t i = 0; i < object.subframe_names.size(); ++i)
    out[object.subframe_names[i]] = toIsometry(withRotation(object.subframe_poses[i]));
  return out;
}

std::string listed(const std::set<std::string> &names) {
  constexpr std::size_t MOST = 10;
  std::string out;
  std::size_t n = 0;
  for (const std::string &name : names) {
    if (++n > MOST) return out + " and " + std::to_string(names.size() - MOST) + " more";
    out += (out.empty() ? "'" : ", '") + name + "'";
  }
  return out;
}

/* ---- who may touch whom ---- */

using Names = PlanningSceneState::Names;

Names ordered(const std::string &a, const std::string &b) {
  return b < a ? Names(b, a) : Names(a, b);
}

/** Throws Error. Entries that say the same as the defaults are left out, as MoveIt does; of two that contradict each
 *  other, above and below the diagonal, the upper one counts. */
std::map<Names, bool> toMatrix(const moveit::AllowedCollisionMatrix &message) {
  const std::size_t n = message.entry_names.size();
  if (message.entry_values.size() != n)
    throw Error(std::to_string(n) + " entry_names have " + std::to_string(message.entry_values.size()) +
                " entry_values");
  if (message.default_entry_names.size() != message.default_entry_values.size())
    throw Error(std::to_string(message.default_entry_names.size()) + " default_entry_names have " +
                std::to_string(message.default_entry_values.size()) + " default_entry_values");
  std::map<Names, bool> out; // a default has an empty second name
  for (std::size_t i = 0; i < message.default_entry_names.size(); ++i) {
    if (message.default_entry_names[i].empty()) throw Error("a default has no name");
    out[{message.default_entry_names[i], ""}] = message.default_entry_values[i] != 0;
  }

  const auto byDefault = [&](const std::string &a, const std::string &b) {
    const auto of_a = out.find({a, ""}), of_b = out.find({b, ""});
    if (of_a == out.end() && of_b == out.end()) return false;
    return (of_a == out.end() || of_a->second) && (of_b == out.end() || of_b->second);
  };
  for (std::size_t i = 0; i < n; ++i) {
    const std::string &name = message.entry_names[i];
    const std::vector<std::uint8_t> &row = message.entry_values[i].enabled;
    if (name.empty()) throw Error("an entry has no name");
    if (row.size() != n)
      throw Error("the row of '" + name + "' has " + std::to_string(row.size()) + " entries, there are " +
                  std::to_string(n) + " names");
    for (std::size_t j = i + 1; j < n; ++j) {
      const std::string &other = message.entry_names[j];
      const bool allowed = row[j] != 0;
      if (other != name && allowed != byDefault(name, other)) out[ordered(name, other)] = allowed;
    }
  }
  return out;
}

/* ---- one message ---- */

class SceneReader {
 public:
  SceneReader(const PlanningScene &message, const PlanningSceneContext &context)
      : message_(message), context_(context), robot_(context.before.robot().get()), full_(message.is_diff == 0) {
    out_.state = context.state;
    out_.change.attachments_first = true;
    for (const auto &[id, object] : context.before.objects())
      if (!full_ || context.kept.count(id) > 0) standing_[id] = object->description.pose;
    for (const auto &[id, object] : context.before.attached()) carried_[id] = {object->link, object->description.pose};
  }

  PlanningSceneChange read() {
    checkModel();
    if (full_) {
      out_.change.clear_objects = true;
      out_.change.kept.assign(context_.kept.begin(), context_.kept.end());
    }
    readTransforms();
    readRobotState();
    readMatrix();
    readLinkSizes();
    for (const moveit::CollisionObject &object : message_.world.collision_objects)
      attempt(object.id, [&] { readObject(object); });
    readOctomap();
    forgetSubframes();
    for (const auto &[names, allowed] : out_.state.allowed)
      if (out_.change.clear_allowed) out_.change.allowed.push_back({names.first, names.second, allowed});
    return std::move(out_);
  }

 private:
  struct Carried {
    std::string link;
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity(); /* in the link */
  };

  void warn(const std::string &what) {
    out_.wrong.push_back(what);
  }

  template <class Work>
  void attempt(const std::string &id, Work &&work) {
    try {
      work();
    } catch (const std::exception &error) {
      const std::string why = error.what();
      warn(why.rfind("object '", 0) == 0 ? why : "object '" + id + "': " + why);
    }
  }

  void checkModel() {
    const std::string &name = message_.robot_model_name;
    if (!name.empty() && robot_ && name != robot_->name())
      warn("the scene is of robot '" + name + "', and this server's is '" + robot_->name() + "'");
  }

  /* ---- frames ---- */

  void readTransforms() {
    for (const geometry_msgs::TransformStamped &given : message_.fixed_frame_transforms) {
      const std::string child = withoutSlash(given.child_frame_id), parent = withoutSlash(given.header.frame_id);
      if (child == parent) continue;
      try {
        if (child.empty()) throw Error("it has no name");
        out_.state.transforms[child] = {parent, toIsometry(given.transform)};
      } catch (const Error &error) {
        warn("fixed_frame_transforms, frame '" + child + "': " + error.what());
      }
    }
  }

  bool hasLink(const std::string &name) const {
    return robot_ && robot_->links().count(name) > 0;
  }

  const Eigen::Isometry3d &linkPose(const std::string &link) {
    const auto known = links_.find(link);
    if (known != links_.end()) return known->second;
    return links_[link] = context_.link_to_fixed(link, out_.state.joints);
  }

  std::optional<Eigen::Isometry3d> objectPose(const std::string &id) {
    const auto held = carried_.find(id);
    if (held != carried_.end()) return linkPose(held->second.link) * held->second.pose;
    const auto it = standing_.find(id);
    if (it == standing_.end()) return std::nullopt;
    return it->second;
  }

  /** Of an object's subframe, OBJECT/NAME; either may hold slashes. */
  std::optional<Eigen::Isometry3d> subframePose(const std::string &frame) {
    for (std::size_t slash = frame.find('/'); slash != std::string::npos; slash = frame.find('/', slash + 1)) {
      const auto object = out_.state.subframes.find(frame.substr(0, slash));
      if (object == out_.state.subframes.end()) continue;
      const auto subframe = object->second.find(frame.substr(slash + 1));
      if (subframe == object->second.end()) continue;
      const std::optional<Eigen::Isometry3d> pose = objectPose(object->first);
      if (pose) return *pose * subframe->second;
    }
    return std::nullopt;
  }

  Eigen::Isometry3d toFixed(const std::string &given, std::size_t depth = 0) {
    const std::string frame = withoutSlash(given);
    if (depth > out_.state.transforms.size()) throw Error("fixed_frame_transforms go in a ring at '" + frame + "'");
    if (hasLink(frame)) return linkPose(frame);
    if (const auto pose = objectPose(frame)) return *pose;
    if (const auto pose = subframePose(frame)) return *pose;
    const auto fixed = out_.state.transforms.find(frame);
    if (fixed != out_.state.transforms.end()) return toFixed(fixed->second.parent, depth + 1) * fixed->second.pose;
    return context_.to_fixed(frame);
  }

  /* ---- the robot ---- */

  void readRobotState() {
    const moveit::RobotState &state = message_.robot_state;
    const sensor_msgs::JointState &joints = state.joint_state;
    bool valid = true;
    if (joints.name.size() != joints.position.size()) {
      valid = false;
      warn("robot_state: " + std::to_string(joints.name.size()) + " joints have " +
           std::to_string(joints.position.size()) + " positions");
    }
    std::set<std::string> unknown;
    for (std::size_t i = 0; valid && i < joints.name.size(); ++i) {
      if (!robot_ || !robot_->hasJoint(joints.name[i])) {
        unknown.insert(joints.name[i]);
      } else if (std::isfinite(joints.position[i])) {
        out_.state.joints[joints.name[i]] = joints.position[i];
      } else {
        warn("robot_state: the position of joint '" + joints.name[i] + "' is not finite");
      }
    }
    if (!unknown.empty()) warn("robot_state names joints that the robot does not have: " + listed(unknown));

    const bool told = !joints.name.empty() || !state.multi_dof_joint_state.joint_names.empty();
    if (valid && told && state.is_diff == 0) {
      out_.change.clear_attached = true;
      carried_.clear();
    }
    for (const moveit::AttachedCollisionObject &attached : state.attached_collision_objects)
      attempt(attached.object.id, [&] { readAttached(attached); });
  }

  void readAttached(const moveit::AttachedCollisionObject &message) {
    const moveit::CollisionObject &object = message.object;
    if (object.id == MOVEIT_OCTOMAP) throw Error("this name is reserved for the octomap");
    const bool appends = object.operation == moveit::CollisionObject::APPEND;
    if (message_.robot_state.is_diff == 0 && object.operation != moveit::CollisionObject::ADD)
      throw Error("robot_state is no diff: what links carry can only be added");
    if (object.operation == moveit::CollisionObject::REMOVE) return detach(message);
    if (object.operation != moveit::CollisionObject::ADD && !appends)
      throw Error("what a link carries is added, appended to or removed; its operation is " +
                  std::to_string(object.operation));
    if (!hasLink(message.link_name))
      throw Error(robot_ ? "the robot has no link '" + message.link_name + "'" +
                               didYouMean(message.link_name, namesOf(robot_->links()))
                         : "link '" + message.link_name + "': this server has no robot");
    attach(message, appends);
  }

  void attach(const moveit::AttachedCollisionObject &message, bool appends) {
    const moveit::CollisionObject &given = message.object;
    Attachment out;
    out.link = message.link_name;
    out.touch_links = message.touch_links;
    out.object.id = given.id;
    const auto standing = standing_.find(given.id);
    if (!appends && !hasShapes(given)) {
      if (standing == standing_.end()) throw Error("it has no shapes, and the world has no object of that id");
      out.link_poses[out.link] = linkPose(out.link);
      carried_[given.id] = {out.link, linkPose(out.link).inverse() * standing->second};
    } else {
      out.object = toObject(given);
      const std::string frame = withoutSlash(given.header.frame_id);
      if (frame != out.link) out.object.pose = linkPose(out.link).inverse() * toFixed(frame) * out.object.pose;
      PlanningSceneState::Subframes subframes = toSubframes(given);
      const auto held = context_.before.attached().find(given.id);
      if (appends && held != context_.before.attached().end() && carried_.count(given.id) > 0)
        addTo(*held->second, isUnset(given.pose), out, subframes);
      out_.state.subframes[given.id] = std::move(subframes);
      carried_[given.id] = {out.link, out.object.pose};
    }
    if (standing != standing_.end()) standing_.erase(standing);
    out_.change.attachments.push_back(std::move(out));
  }

  /** Appends: the shapes, subframes and touch links that are there stay, and the pose where none is given. */
  void addTo(const AttachedObject &before, bool same_pose, Attachment &out, PlanningSceneState::Subframes &subframes) {
    const ObjectDescription &object = before.description;
    out.object.shapes.insert(out.object.shapes.end(), object.shapes.begin(), object.shapes.end());
    if (same_pose) out.object.pose = object.pose;
    out.touch_links.insert(out.touch_links.end(), before.touch_links.begin(), before.touch_links.end());
    const auto there = out_.state.subframes.find(object.id);
    if (there != out_.state.subframes.end()) subframes.insert(there->second.begin(), there->second.end());
  }

  void detach(const moveit::AttachedCollisionObject &message) {
    const std::string &id = message.object.id;
    std::vector<std::string> meant;
    for (const auto &[name, held] : carried_) {
      if (id.empty() ? message.link_name.empty() || held.link == message.link_name : name == id) meant.push_back(name);
    }
    if (meant.empty() && !id.empty()) throw Error("no link carries an object of that id");
    for (const std::string &name : meant) {
      const Carried held = carried_.at(name);
      if (!id.empty() && !message.link_name.empty() && held.link != message.link_name)
        throw Error("link '" + held.link + "' carries it, not '" + message.link_name + "'");
      Attachment out;
      out.kind = Attachment::Kind::DETACH;
      out.object.id = name;
      try {
        out.link_poses[held.link] = linkPose(held.link);
      } catch (const Error &) {
        if (!addedToWorld(name)) throw;
        out.link_poses[held.link] = Eigen::Isometry3d::Identity(); // the world says where it stands
      }
      standing_[name] = out.link_poses[held.link] * held.pose;
      carried_.erase(name);
      out_.change.attachments.push_back(std::move(out));
    }
  }

  bool addedToWorld(const std::string &id) const {
    const auto &objects = message_.world.collision_objects;
    return std::any_of(objects.begin(), objects.end(), [&](const moveit::CollisionObject &object) {
      return object.id == id && object.operation == moveit::CollisionObject::ADD;
    });
  }

  /* ---- the matrix, paddings and scales ---- */

  void readMatrix() {
    const moveit::AllowedCollisionMatrix &matrix = message_.allowed_collision_matrix;
    if (!full_ && matrix.entry_names.empty()) return;
    try {
      out_.state.allowed = toMatrix(matrix);
      out_.change.clear_allowed = true;
    } catch (const Error &error) {
      warn(std::string("allowed_collision_matrix: ") + error.what() + "; the one before stays");
    }
  }

  void readLinkSizes() {
    std::set<std::string> unknown;
    for (const moveit::LinkPadding &given : message_.link_padding) {
      if (!hasLink(given.link_name)) {
        unknown.insert(given.link_name);
      } else if (!(std::isfinite(given.padding) && given.padding >= 0.0)) {
        warn("link_padding: that of link '" + given.link_name + "' is " + std::to_string(given.padding) +
             ": it must be finite and not below 0");
      } else if (given.padding != context_.before.linkPadding(given.link_name)) {
        out_.change.link_padding[given.link_name] = given.padding;
      }
    }
    for (const moveit::LinkScale &given : message_.link_scale) {
      const auto &scales = context_.before.linkScales();
      const auto before = scales.find(given.link_name);
      if (!hasLink(given.link_name)) {
        unknown.insert(given.link_name);
      } else if (!(std::isfinite(given.scale) && given.scale > 0.0)) {
        warn("link_scale: that of link '" + given.link_name + "' is " + std::to_string(given.scale) +
             ": it must be finite and above 0");
      } else if (given.scale != (before == scales.end() ? 1.0 : before->second)) {
        out_.change.link_scale[given.link_name] = given.scale;
      }
    }
    if (!unknown.empty()) warn("paddings or scales name links that the robot does not have: " + listed(unknown));
  }

  /* ---- the world ---- */

  void readObject(const moveit::CollisionObject &given) {
    if (given.id == MOVEIT_OCTOMAP) throw Error("this name is reserved for the octomap");
    switch (given.operation) {
      case moveit::CollisionObject::ADD:
      case moveit::CollisionObject::APPEND: return add(given);
      case moveit::CollisionObject::REMOVE: return remove(given);
      case moveit::CollisionObject::MOVE: return move(given);
      default: throw Error("unknown operation " + std::to_string(given.operation));
    }
  }

  void add(const moveit::CollisionObject &given) {
    if (given.id.empty()) throw Error("it has no id");
    if (!hasShapes(given)) throw Error("it has no shapes");
    const bool appends = given.operation == moveit::CollisionObject::APPEND && standing_.count(given.id) > 0;
    Operation out;
    out.kind = appends ? Operation::Kind::APPEND : Operation::Kind::ADD;
    out.object = toObject(given);
    const Eigen::Isometry3d pose = toFixed(given.header.frame_id) * out.object.pose;
    out.object.pose = appends ? Eigen::Isometry3d::Identity() : pose; // MoveIt's APPEND leaves the pose
    out_.state.subframes[given.id] = toSubframes(given);
    if (!appends) standing_[given.id] = pose;
    out_.change.operations.push_back(std::move(out));
  }

  void removeOne(const std::string &id) {
    Operation out;
    out.kind = Operation::Kind::REMOVE;
    out.object.id = id;
    out_.change.operations.push_back(std::move(out));
    standing_.erase(id);
    auto &allowed = out_.state.allowed;
    for (auto it = allowed.begin(); it != allowed.end();) {
      const bool names = !it->first.second.empty() && (it->first.first == id || it->first.second == id);
      if (names) out_.change.clear_allowed = true;
      it = names ? allowed.erase(it) : std::next(it);
    }
  }

  void remove(const moveit::CollisionObject &given) {
    if (!given.id.empty()) {
      if (standing_.count(given.id) == 0) throw Error("there is no object of that id to remove");
      return removeOne(given.id);
    }
    for (const std::string &id : namesOf(standing_))
      if (context_.kept.count(id) == 0 && id != MOVEIT_OCTOMAP) removeOne(id);
  }

  void move(const moveit::CollisionObject &given) {
    const auto it = standing_.find(given.id);
    if (it == standing_.end()) throw Error("there is no object of that id to move");
    const Eigen::Isometry3d pose = toFixed(given.header.frame_id) * toIsometry(withRotation(given.pose));
    const std::vector<Eigen::Isometry3d> poses = shapePoses(given);
    Operation out;
    out.kind = Operation::Kind::MOVE;
    out.object.id = given.id;
    if (!poses.empty()) {
      const ObjectDescription *object = description(given.id);
      if (!object || object->shapes.size() != poses.size())
        throw Error("MOVE brings " + std::to_string(poses.size()) + " poses of shapes, the object has " +
                    std::to_string(object ? object->shapes.size() : 0) + " shapes");
      out.kind = Operation::Kind::ADD;
      out.object = *object;
      for (std::size_t i = 0; i < poses.size(); ++i) out.object.shapes[i].pose = poses[i];
    }
    out.object.pose = it->second = pose;
    out_.change.operations.push_back(std::move(out));
  }

  /** Of an object that this message has added, or that stood there before; null: neither. */
  const ObjectDescription *description(const std::string &id) const {
    const auto &operations = out_.change.operations;
    for (auto it = operations.rbegin(); it != operations.rend(); ++it)
      if (it->object.id == id && it->kind == Operation::Kind::ADD) return &it->object;
    const auto before = context_.before.objects().find(id);
    return before == context_.before.objects().end() ? nullptr : &before->second->description;
  }

  void readOctomap() {
    const octomap_msgs::OctomapWithPose &given = message_.world.octomap;
    const octomap_msgs::Octomap &map = given.octomap;
    if (map.data.empty()) {
      if (!full_ && !map.id.empty() && standing_.count(MOVEIT_OCTOMAP) > 0) removeOne(MOVEIT_OCTOMAP);
      return;
    }
    try {
      if (map.id != "OcTree" && map.id != "ColorOcTree")
        throw Error("its type is '" + map.id + "', and OcTree and ColorOcTree are known");
      Operation out;
      out.object.id = MOVEIT_OCTOMAP;
      out.object.pose = toFixed(given.header.frame_id) * toIsometry(withRotation(given.origin));
      ShapeDescription shape;
      shape.type = ShapeType::OCTREE;
      shape.unknown_is_occupied = context_.unknown_is_occupied;
      shape.octree = toOctree(map);
      out.object.shapes.push_back(std::move(shape));
      out_.change.operations.push_back(std::move(out));
    } catch (const std::exception &error) {
      out_.change.kept.emplace_back(MOVEIT_OCTOMAP);
      warn(std::string("octomap: ") + error.what() + "; the one before stays");
    }
  }

  void forgetSubframes() {
    auto &subframes = out_.state.subframes;
    for (auto it = subframes.begin(); it != subframes.end();) {
      const bool there = standing_.count(it->first) > 0 || carried_.count(it->first) > 0;
      it = there && !it->second.empty() ? std::next(it) : subframes.erase(it);
    }
  }

  const PlanningScene &message_;
  const PlanningSceneContext &context_;
  const Robot *const robot_;
  const bool full_;
  PlanningSceneChange out_;
  std::map<std::string, Eigen::Isometry3d> standing_; /* the world's objects so far, in the fixed frame */
  std::map<std::string, Carried> carried_;            /* what links carry so far */
  LinkPoses links_;                                   /* looked up so far */
};

/* ---- what differs ---- */

constexpr double SAME = 1e-6; /* [m], and in entries of rotations */

bool same(const Eigen::Isometry3d &a, const Eigen::Isometry3d &b) {
  return (a.matrix() - b.matrix()).cwiseAbs().maxCoeff() <= SAME;
}

/** Empty where the two are the same. */
std::string difference(const ObjectDescription &theirs, const ObjectDescription &ours) {
  if (theirs.shapes.size() != ours.shapes.size())
    return "has " + std::to_string(ours.shapes.size()) + " shapes instead of " + std::to_string(theirs.shapes.size());
  for (std::size_t i = 0; i < theirs.shapes.size(); ++i) {
    const ShapeDescription &a = theirs.shapes[i], &b = ours.shapes[i];
    const bool equal = a.type == b.type && a.dimensions == b.dimensions && a.vertices.cols() == b.vertices.cols() &&
                       a.vertices == b.vertices && a.triangles.cols() == b.triangles.cols() &&
                       a.triangles == b.triangles && a.octree.data == b.octree.data &&
                       a.octree.resolution == b.octree.resolution;
    if (!equal) return "has another shape " + std::to_string(i + 1);
    if (!same(theirs.pose * a.pose, ours.pose * b.pose)) return "stands elsewhere";
  }
  return "";
}

} // namespace

PlanningSceneChange toSceneChange(const PlanningScene &message, const PlanningSceneContext &context) {
  return SceneReader(message, context).read();
}

std::vector<std::string> differences(const PlanningScene &message, const PlanningSceneContext &context,
                                     std::size_t most) {
  PlanningScene full = message;
  full.is_diff = full.robot_state.is_diff = 0;
  const PlanningSceneChange theirs = toSceneChange(full, context);
  std::vector<std::string> out;
  const auto tell = [&](const std::string &what) {
    if (out.size() < most) out.push_back(what);
  };

  // Each object by its name and, where a link carries it, by that link.
  const auto named = [](const std::string &id, const std::string &link) {
    return "object '" + id + (link.empty() ? "'" : "' on link '" + link + "'");
  };
  std::map<std::string, const ObjectDescription *> wanted, here;
  for (const Operation &operation : theirs.change.operations)
    if (operation.kind == Operation::Kind::ADD) wanted[named(operation.object.id, "")] = &operation.object;
  for (const Attachment &attachment : theirs.change.attachments)
    wanted[named(attachment.object.id, attachment.link)] = &attachment.object;
  for (const auto &[id, object] : context.before.objects())
    if (context.kept.count(id) == 0 || wanted.count(named(id, "")) > 0) here[named(id, "")] = &object->description;
  for (const auto &[id, object] : context.before.attached()) here[named(id, object->link)] = &object->description;
  for (const auto &[name, object] : wanted) {
    const auto ours = here.find(name);
    const std::string what = ours == here.end() ? "is missing here" : difference(*object, *ours->second);
    if (!what.empty()) tell(name + " " + what);
  }
  for (const auto &entry : here)
    if (wanted.count(entry.first) == 0) tell(entry.first + " is here alone");

  for (const auto &padding : theirs.change.link_padding) tell("link '" + padding.first + "' has another padding");
  for (const auto &scale : theirs.change.link_scale) tell("link '" + scale.first + "' has another scale");
  if (theirs.change.clear_allowed && theirs.state.allowed != context.state.allowed)
    tell("the allowed collision matrix is another one");
  for (const std::string &what : theirs.wrong) tell(what);
  return out;
}

} // namespace curve_proximity
