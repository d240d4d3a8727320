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
  return std::filesystem::absolute(path, error).parent_path().string();
}

SceneChange toChange(const SceneFile &file, const std::string &path, Warnings &warnings) {
  const Frames frames({}, file.transforms, {}, warnings);
  SceneChange change;
  change.operations = file.operations;
  for (const AttachedObject &attached : file.attached) {
    warnings.add("object '" + attached.object.id + "' is attached to '" + attached.link +
                 "'; in the node it stands still where the link is now");
    change.operations.push_back({Operation::Kind::ADD, attached.object});
  }
  for (Operation &operation : change.operations) {
    try {
      resolveFrame(operation.object, frames);
    } catch (const BadInput &e) {
      throw BadUsage(path + ": object '" + operation.object.id + "': " + e.what());
    }
    makeResourcesAbsolute(operation.object, folderOf(path));
  }
  change.link_padding = file.link_padding;
  change.allowed = file.allowed;
  return change;
}

} // namespace curve_proximity::yaml
