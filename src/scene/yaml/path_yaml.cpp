/* SPDX-License-Identifier: BSD-3-Clause */
#include "path_yaml.h"

#include <utility>

#include "bad_input.h"
#include "motion/path_times.h"
#include "path_text.h"
#include "scene_yaml.h"
#include "trajectory_yaml.h"

namespace curve_proximity::yaml {
namespace {

struct Header {
  std::string frame;
  std::int64_t stamp = 0; /* [ns] */
};

Header readHeader(const YamlValue &value, Warnings &warnings) {
  Header out;
  const std::optional<YamlValue> header = value.find("header");
  if (!header) return out;
  header->warnOfOthers({"seq", "stamp", "frame_id"}, warnings);
  if (const auto frame = header->find("frame_id")) out.frame = frame->text();
  if (const auto stamp = header->find("stamp")) out.stamp = readStamp(*stamp);
  return out;
}

Eigen::Isometry3d readPose(const YamlValue &value, bool turns, Warnings &warnings) {
  if (turns) return toIsometry(value.pose(warnings));
  value.warnOfOthers({"position", "orientation"}, warnings);
  const std::optional<YamlValue> position = value.find("position");
  return Eigen::Isometry3d(Eigen::Translation3d(position ? position->vector() : Eigen::Vector3d::Zero()));
}

PathFile readPoses(const YamlValue &root, bool turns, Warnings &warnings) {
  if (!root.isMap()) root.fail("must be a map with header and poses, as rostopic prints a nav_msgs/Path");
  root.warnOfOthers({"header", "poses"}, warnings);
  const Header header = readHeader(root, warnings);
  PathFile out;
  out.frame = header.frame;
  std::vector<std::int64_t> stamps;
  for (const YamlValue &entry : root.at("poses").items()) {
    if (entry.find("position") || entry.find("orientation")) { /* of a geometry_msgs/PoseArray */
      stamps.push_back(0);
      out.poses.push_back({0.0, readPose(entry, turns, warnings)});
      continue;
    }
    entry.warnOfOthers({"header", "pose"}, warnings);
    const Header own = readHeader(entry, warnings);
    if (!own.frame.empty() && own.frame != out.frame)
      entry.fail("is in frame '" + own.frame + "', the path in '" + out.frame + "'");
    stamps.push_back(own.stamp);
    out.poses.push_back({0.0, readPose(entry.at("pose"), turns, warnings)});
  }
  if (out.poses.empty()) root.fail("the path has no poses");
  PathTimes at = timesOf(stamps, header.stamp);
  for (std::size_t i = 0; i < out.poses.size(); ++i) out.poses[i].time = at.times[i];
  out.origin = at.origin;
  out.remark = std::move(at.remark);
  return out;
}

} // namespace

PathFile readPath(const std::string &path, bool turns, Warnings &warnings) {
  try {
    return isPathText(path) ? readPathText(path, turns, warnings) : readPoses(loadYaml(path), turns, warnings);
  } catch (const BadInput &e) {
    throw BadUsage(path + ": " + e.what());
  }
}

ObjectDescription readRider(const YamlValue &value, Warnings &warnings) {
  value.warnOfOthers(
      {"id", "pose", "padding", "primitives", "primitive_poses", "meshes", "mesh_poses", "bodies", "body_poses"},
      warnings);
  ObjectDescription body = readPlacedShapes(value, warnings);
  body.id = value.at("id").text();
  return body;
}

} // namespace curve_proximity::yaml
