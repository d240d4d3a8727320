/* SPDX-License-Identifier: BSD-3-Clause */
#include "robot_state_yaml.h"

#include <set>

namespace curve_proximity::yaml {
namespace {

/* A list beside joint_names, as long as that. */
void requireAsMany(const YamlValue &value, std::size_t names, std::size_t found, const char *what) {
  if (names == found) return;
  value.fail("has " + std::to_string(names) + " names and " + std::to_string(found) + " " + what);
}

} // namespace

std::string readFrame(const YamlValue &value, Warnings &warnings) {
  const std::optional<YamlValue> header = value.find("header");
  if (!header) return "";
  header->warnOfOthers({"seq", "stamp", "frame_id"}, warnings);
  const std::optional<YamlValue> frame = header->find("frame_id");
  return frame ? frame->text() : "";
}

std::vector<cprox_pose> readTransforms(const YamlValue &value, Warnings &warnings) {
  std::vector<cprox_pose> out;
  for (const YamlValue &transform : value.itemsOf("transforms"))
    out.push_back(transform.pose(warnings, "translation", "rotation"));
  return out;
}

JointsFile readJoints(const YamlValue &state, Warnings &warnings) {
  JointsFile out;
  if (const auto joints = state.find("joint_state")) {
    joints->warnOfOthers({"header", "name", "position", "velocity", "effort"}, warnings);
    const std::vector<YamlValue> names = joints->itemsOf("name"), positions = joints->itemsOf("position");
    requireAsMany(*joints, names.size(), positions.size(), "positions");
    for (std::size_t i = 0; i < names.size(); ++i)
      if (!out.joints.emplace(names[i].text(), positions[i].number()).second)
        names[i].fail("joint '" + names[i].text() + "' is named twice");
  }
  if (const auto joints = state.find("multi_dof_joint_state")) {
    joints->warnOfOthers({"header", "joint_names", "transforms", "twist", "wrench"}, warnings);
    const std::string frame = readFrame(*joints, warnings);
    const std::vector<YamlValue> names = joints->itemsOf("joint_names");
    const std::vector<cprox_pose> poses = readTransforms(*joints, warnings);
    requireAsMany(*joints, names.size(), poses.size(), "transforms");
    std::set<std::string> known;
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (!known.insert(names[i].text()).second) names[i].fail("joint '" + names[i].text() + "' is named twice");
      out.free_joints.push_back({names[i].text(), frame, {poses[i]}});
    }
  }
  return out;
}

} // namespace curve_proximity::yaml
