/* SPDX-License-Identifier: BSD-3-Clause */
#include "messages/scene_message.h"

#include <algorithm>

#include "messages/geometry_message.h"
#include "messages/shape_message.h"
#include "messages/trajectory_message.h"

namespace curve_proximity {
namespace {

Operation::Kind toKind(int operation) {
  switch (operation) {
    case CollisionObject::ADD: return Operation::Kind::ADD;
    case CollisionObject::REMOVE: return Operation::Kind::REMOVE;
    case CollisionObject::APPEND: return Operation::Kind::APPEND;
    case CollisionObject::MOVE: return Operation::Kind::MOVE;
    default: throw Error("unknown operation " + std::to_string(operation));
  }
}

CollisionObject::_operation_type toOperationByte(Operation::Kind kind) {
  switch (kind) {
    case Operation::Kind::REMOVE: return CollisionObject::REMOVE;
    case Operation::Kind::APPEND: return CollisionObject::APPEND;
    case Operation::Kind::MOVE: return CollisionObject::MOVE;
    case Operation::Kind::ADD: break;
  }
  return CollisionObject::ADD;
}

/** An object that stands in `frame_in_fixed` gets its pose in the fixed frame. APPEND may leave the pose out: then the
 *  shapes are relative to the object that is there, and nothing is to be brought anywhere. */
void bringToFixed(Operation &operation, const Eigen::Isometry3d &frame_in_fixed) {
  const bool relative = operation.kind == Operation::Kind::APPEND && operation.object.pose.matrix().isIdentity(0.0);
  if (operation.trajectory) {
    for (TimedPose &waypoint : operation.trajectory->poses) waypoint.pose = frame_in_fixed * waypoint.pose;
  } else if (!relative) {
    operation.object.pose = frame_in_fixed * operation.object.pose;
  }
}

/** A missing transform is told with the object's name. */
Eigen::Isometry3d frameOf(const CollisionObject &object, const ToFixed &to_fixed) {
  try {
    return to_fixed(object.header);
  } catch (const std::exception &error) {
    throw Error("object '" + object.id + "': " + error.what());
  }
}

/** An object that names its link's frame needs no transform; others are brought there. */
Attachment toAttachment(const AttachedCollisionObject &message, const ToFixed &to_fixed,
                        const LinkToFixed &link_to_fixed, const Snapshot &before) {
  Operation operation = toOperation(message.object);
  if (operation.trajectory)
    throw Error("object '" + message.object.id + "': what a link carries moves with it, and takes no trajectory");
  Attachment out;
  out.link = message.link_name;
  out.touch_links = message.touch_links;
  const std_msgs::Header &header = message.object.header;
  const auto locate = [&](const std::string &link) {
    if (out.link_poses.count(link) == 0) out.link_poses[link] = link_to_fixed(link, header.stamp);
  };
  try {
    if (operation.kind == Operation::Kind::REMOVE) {
      out.kind = Attachment::Kind::DETACH;
      for (const auto &entry : before.attached()) locate(entry.second->link);
    } else if (operation.kind != Operation::Kind::ADD) {
      throw Error("what a link carries is added or removed, not appended to or moved");
    } else if (operation.object.shapes.empty()) {
      locate(out.link);
    } else if (header.frame_id != out.link) {
      locate(out.link);
      const bool on_link = before.robot() && before.robot()->links().count(header.frame_id) > 0;
      const Eigen::Isometry3d frame = on_link ? link_to_fixed(header.frame_id, header.stamp) : to_fixed(header);
      operation.object.pose = out.link_poses.at(out.link).inverse() * frame * operation.object.pose;
    }
  } catch (const std::exception &error) {
    throw Error("object '" + message.object.id + "': " + error.what());
  }
  out.object = std::move(operation.object);
  return out;
}

/** Paddings and scales of links, and who may touch whom. */
template <class Message>
void addSizes(const SceneChange &change, Message &message) {
  const auto pad = [&message](const std::string &link, double padding) {
    message.link_padding.emplace_back();
    message.link_padding.back().link_name = link;
    message.link_padding.back().padding = padding;
  };
  if (change.default_link_padding) pad("", *change.default_link_padding);
  for (const auto &[link, padding] : change.link_padding) pad(link, padding);
  for (const auto &[link, scale] : change.link_scale) {
    message.link_scale.emplace_back();
    message.link_scale.back().link_name = link;
    message.link_scale.back().scale = scale;
  }
  for (const AllowedPair &pair : change.allowed) {
    message.allowed_contacts.emplace_back();
    message.allowed_contacts.back().first = pair.a;
    message.allowed_contacts.back().second = pair.b;
    message.allowed_contacts.back().allowed = pair.allowed;
  }
}

} // namespace

Operation toOperation(const CollisionObject &message) {
  Operation out;
  out.object.id = message.id;
  out.object.frame = message.header.frame_id;
  out.object.padding = message.padding;
  try {
    out.kind = toKind(message.operation);
    if (out.kind == Operation::Kind::REMOVE) return out;
    if (out.kind == Operation::Kind::MOVE || !isUnset(message.pose)) out.object.pose = toIsometry(message.pose);
    out.object.shapes = toShapes(message);
    if (!message.trajectory.waypoints.empty()) out.trajectory = toTrajectory(message.trajectory);
  } catch (const Error &error) {
    throw Error("object '" + message.id + "': " + error.what());
  }
  return out;
}

SceneChange toSceneChange(const ApplySceneRequest &request, const ToFixed &to_fixed, std::vector<std::string> &faults) {
  SceneChange change;
  change.clear = request.clear;
  for (const CollisionObject &object : request.objects) {
    try {
      Operation operation = toOperation(object);
      if (operation.kind != Operation::Kind::REMOVE) bringToFixed(operation, frameOf(object, to_fixed));
      change.operations.push_back(std::move(operation));
    } catch (const std::exception &error) {
      faults.push_back(error.what());
    }
  }
  for (const LinkPadding &padding : request.link_padding) {
    if (padding.link_name.empty()) {
      change.default_link_padding = padding.padding;
    } else {
      change.link_padding[padding.link_name] = padding.padding;
    }
  }
  for (const LinkScale &scale : request.link_scale) change.link_scale[scale.link_name] = scale.scale;
  for (const AllowedContact &contact : request.allowed_contacts)
    change.allowed.push_back({contact.first, contact.second, contact.allowed != 0});
  return change;
}

void addAttachments(const ApplySceneRequest &request, const ToFixed &to_fixed, const LinkToFixed &link_to_fixed,
                    const Snapshot &before, SceneChange &change, std::vector<std::string> &faults) {
  for (const AttachedCollisionObject &message : request.attached_collision_objects) {
    try {
      change.attachments.push_back(toAttachment(message, to_fixed, link_to_fixed, before));
    } catch (const std::exception &error) {
      faults.push_back(error.what());
    }
  }
}

AttachedCollisionObject toMessage(const Attachment &attachment) {
  AttachedCollisionObject message;
  message.link_name = attachment.link;
  message.touch_links = attachment.touch_links;
  message.object = toMessage(attachment.object);
  return message;
}

CollisionObject toMessage(const ObjectDescription &object) {
  CollisionObject message;
  message.header.frame_id = object.frame;
  message.id = object.id;
  message.pose = toMessage(object.pose);
  message.padding = object.padding;
  message.operation = CollisionObject::ADD;
  for (const ShapeDescription &shape : object.shapes) addShape(message, shape);
  return message;
}

/* What ~apply_scene would take to build it again. */
static CollisionObject toMessage(const MovingSceneObject &object) {
  CollisionObject message = toMessage(object.description);
  message.trajectory = toMessage(object.trajectory);
  return message;
}

void toMessage(const Snapshot &snapshot, const std::vector<std::string> &ids, GetSceneResponse &response) {
  if (ids.empty()) {
    for (const auto &object : snapshot.objects()) response.objects.push_back(toMessage(object.second->description));
    for (const auto &object : snapshot.moving()) response.objects.push_back(toMessage(*object.second));
  }
  for (const std::string &id : ids) {
    const auto object = snapshot.objects().find(id);
    const auto moving = snapshot.moving().find(id);
    if (object != snapshot.objects().end()) {
      response.objects.push_back(toMessage(object->second->description));
    } else if (moving != snapshot.moving().end()) {
      response.objects.push_back(toMessage(*moving->second));
    } else if (snapshot.attached().count(id) == 0) {
      throw Error("there is no object '" + id + "'");
    }
  }
  for (const auto &entry : snapshot.attached()) {
    if (!ids.empty() && std::find(ids.begin(), ids.end(), entry.first) == ids.end()) continue;
    const AttachedObject &object = *entry.second;
    response.attached_collision_objects.push_back(
        toMessage(Attachment{Attachment::Kind::ATTACH, object.link, object.touch_links, object.description, {}}));
  }
  SceneChange sizes;
  if (snapshot.defaultLinkPadding() != 0.0) sizes.default_link_padding = snapshot.defaultLinkPadding();
  sizes.link_padding = snapshot.linkPaddings();
  sizes.link_scale = snapshot.linkScales();
  sizes.allowed = snapshot.allowed();
  addSizes(sizes, response);
}

ApplySceneRequest toMessage(const SceneChange &change) {
  ApplySceneRequest request;
  request.clear = change.clear;
  for (const Operation &operation : change.operations) {
    request.objects.push_back(toMessage(operation.object));
    request.objects.back().operation = toOperationByte(operation.kind);
    if (operation.trajectory) request.objects.back().trajectory = toMessage(*operation.trajectory);
  }
  for (const Attachment &attachment : change.attachments)
    request.attached_collision_objects.push_back(toMessage(attachment));
  addSizes(change, request);
  return request;
}

} // namespace curve_proximity
