/* SPDX-License-Identifier: BSD-3-Clause */
#include "scene_change.h"

#include <filesystem>

#include "failure.h"
#include "frames.h"

namespace curve_proximity::yaml {
namespace {

/* Frames that only the node's tf2 knows stay as they are; those that the file itself explains are resolved. */
void resolveFrame(ObjectDescription &object, const Frames &frames) {
  if (!frames.knows(object.frame)) return;
  object.pose = frames.find(object.frame) * object.pose;
  object.frame.clear();
}

/* The node does not know the folder that paths in the file are relative to. */
void makeResourcesAbsolute(ObjectDescription &object, const std::string &folder) {
  for (ShapeDescription &shape : object.shapes) {
    const bool relative = !shape.resource.empty() && shape.resource.find("://") == std::string::npos &&
                          std::filesystem::path(shape.resource).is_relative();
    if (relative) shape.resource = (std::filesystem::path(folder) / shape.resource).string();
  }
}

} // namespace

std::string folderOf(const std::string &path) {
  std::error_code error;
  if (path == "/dev/stdin") return std::filesystem::current_path(error).string();
  return std::filesystem::absolute(path, error).parent_path().string();
}

SceneChange toChange(const SceneFile &file, const std::string &path, Warnings &warnings) {
  const Frames frames({}, file.transforms, {}, warnings);
  SceneChange change;
  change.clear = !file.is_diff;
  change.operations = file.operations;
  change.attachments = file.attached;
  const auto prepare = [&](ObjectDescription &object) {
    try {
      resolveFrame(object, frames);
    } catch (const BadInput &e) {
      throw BadUsage(path + ": object '" + object.id + "': " + e.what());
    }
    makeResourcesAbsolute(object, folderOf(path));
  };
  for (Operation &operation : change.operations) prepare(operation.object);
  for (Attachment &attachment : change.attachments) prepare(attachment.object);
  change.link_padding = file.link_padding;
  change.link_scale = file.link_scale;
  change.allowed = file.allowed;
  return change;
}

} // namespace curve_proximity::yaml
