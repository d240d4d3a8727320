/* SPDX-License-Identifier: BSD-3-Clause */
#include "trajectory_yaml.h"

#include <array>
#include <cmath>
#include <filesystem>

#include "failure.h"

namespace curve_proximity::yaml {
namespace {

Interpolation readInterpolation(const YamlValue &value) {
  const std::string text = value.text();
  if (text == "linear") return Interpolation::LINEAR;
  if (text == "cubic") return Interpolation::CUBIC;
  if (text == "quintic") return Interpolation::QUINTIC;
  value.fail("the interpolation '" + text + "' is none of linear, cubic, quintic");
}

/* Seconds and nanoseconds, as ROS prints a duration. */
std::array<double, 2> readParts(const YamlValue &value) {
  const auto part = [&](const char *key) {
    const std::optional<YamlValue> found = value.find(key);
    return found ? found->number() : 0.0;
  };
  if (!value.find("secs") && !value.find("nsecs")) value.fail("needs secs or nsecs");
  return {part("secs"), part("nsecs")};
}

std::vector<double> readList(const YamlValue &point, const char *key) {
  const std::optional<YamlValue> list = point.find(key);
  return list ? list->numbers() : std::vector<double>();
}

TrajectoryPoint readPoint(const YamlValue &value, Warnings &warnings) {
  value.warnOfOthers({"positions", "velocities", "accelerations", "effort", "time_from_start"}, warnings);
  TrajectoryPoint out;
  out.positions = readList(value, "positions");
  out.velocities = readList(value, "velocities");
  out.accelerations = readList(value, "accelerations");
  out.time = readTime(value.at("time_from_start"));
  return out;
}

void readFixed(const YamlValue &value, JointPositions &out) {
  for (const auto &[joint, entry] : value.entries()) out[joint] = entry.number();
}

void readBase(const YamlValue &value, TrajectoryDescription &out, Warnings &warnings) {
  value.warnOfOthers({"name", "type", "joints", "parent_frame", "child_link"}, warnings);
  VirtualJoint joint;
  if (const auto name = value.find("name")) joint.name = name->text();
  joint.type = value.at("type").text();
  if (joint.type != "planar" && joint.type != "floating") value.fail("the type must be planar or floating");
  if (const auto frame = value.find("parent_frame")) joint.parent_frame = frame->text();
  joint.child_link = value.at("child_link").text();
  for (const YamlValue &part : value.itemsOf("joints")) out.base_joints.push_back(part.text());
  const std::size_t parts = joint.type == "planar" ? 3 : 7;
  if (!out.base_joints.empty() && out.base_joints.size() != parts) {
    value.fail("joints must name the " + std::to_string(parts) + " parts of a " + joint.type + " joint");
  }
  if (out.base_joints.empty() && joint.name.empty()) value.fail("needs joints, or a name that their names begin with");
  out.base.push_back(joint);
}

/* joint_spline: a B-spline of the joint values, by its control points. */
void readSpline(const YamlValue &spline, TrajectoryDescription &out, Warnings &warnings) {
  spline.warnOfOthers({"header", "joint_names", "degree", "knots", "control_points"}, warnings);
  for (const YamlValue &name : spline.at("joint_names").items()) out.joints.push_back(name.text());
  out.degree = spline.at("degree").count();
  if (out.degree < 1) spline.at("degree").fail("the degree of a spline is at least 1");
  out.knots = spline.at("knots").numbers();
  for (const YamlValue &point : spline.at("control_points").items()) {
    out.points.emplace_back();
    out.points.back().positions = point.numbers();
  }
}

TrajectoryDescription readTrajectoryMap(const YamlValue &root, Warnings &warnings) {
  if (!root.isMap()) root.fail("must be a map with joint_trajectory or joint_spline");
  root.warnOfOthers(
      {"joint_trajectory", "joint_spline", "interpolation", "fixed_joints", "virtual_joint", "robot", "scene"},
      warnings);
  TrajectoryDescription out;
  if (const auto interpolation = root.find("interpolation")) out.interpolation = readInterpolation(*interpolation);
  if (const auto fixed = root.find("fixed_joints")) readFixed(*fixed, out.fixed_joints);
  if (const auto base = root.find("virtual_joint")) readBase(*base, out, warnings);

  if (const auto spline = root.find("joint_spline")) {
    if (root.find("joint_trajectory")) root.fail("has both a joint_trajectory and a joint_spline");
    if (root.find("interpolation")) root.fail("a joint_spline has no interpolation");
    readSpline(*spline, out, warnings);
    return out;
  }
  const YamlValue trajectory = root.at("joint_trajectory");
  trajectory.warnOfOthers({"header", "joint_names", "points"}, warnings);
  for (const YamlValue &name : trajectory.at("joint_names").items()) out.joints.push_back(name.text());
  for (const YamlValue &point : trajectory.at("points").items()) out.points.push_back(readPoint(point, warnings));
  return out;
}

TrajectoryDescription readFile(const YamlValue &root, Warnings &told) {
  Warnings warnings;
  TrajectoryDescription out = readTrajectoryMap(root, warnings);
  out.coverage = warnings.coverage();
  told.add(warnings);
  return out;
}

} // namespace

std::int64_t readStamp(const YamlValue &value) {
  constexpr double BILLION = 1e9, MOST = 9.2e9; /* [s] */
  const std::array<double, 2> parts = value.isMap() ? readParts(value) : std::array<double, 2>{value.number(), 0.0};
  if (!(std::abs(parts[0]) < MOST && std::abs(parts[1]) < BILLION)) value.fail("is out of range");
  const double whole = std::floor(parts[0]);
  return static_cast<std::int64_t>(whole) * 1000000000 + std::llround((parts[0] - whole) * BILLION + parts[1]);
}

double readTime(const YamlValue &value) {
  if (!value.isMap()) return value.number();
  const std::array<double, 2> parts = readParts(value);
  return parts[0] + 1e-9 * parts[1];
}

double readStartTolerance(const YamlValue &value) {
  const auto tolerance = value.find("start_tolerance"), anywhere = value.find("any_time");
  double out = 0.0;
  if (tolerance) out = tolerance->number();
  if (!(out >= 0.0)) tolerance->fail("is " + tolerance->text() + ": it must be at least 0");
  return anywhere && anywhere->truth() ? std::numeric_limits<double>::infinity() : out;
}

ObjectTrajectory readObjectTrajectory(const YamlValue &value, Warnings &warnings) {
  if (!value.isMap()) value.fail("must be a map with waypoints: [{time, pose}]");
  value.warnOfOthers({"start", "start_tolerance", "any_time", "turning", "waypoints"}, warnings);
  ObjectTrajectory out;
  if (const auto start = value.find("start")) out.start = readStamp(*start);
  out.tolerance = readStartTolerance(value);
  if (const auto turning = value.find("turning")) {
    const std::optional<Turning> known = turningFromName(turning->text());
    if (!known) turning->fail("the turning '" + turning->text() + "' is none of slerp, screw");
    out.turning = *known;
  }
  for (const YamlValue &point : value.at("waypoints").items()) {
    point.warnOfOthers({"time", "pose"}, warnings);
    const double time = readTime(point.at("time"));
    if (!out.poses.empty() && !(time > out.poses.back().time))
      point.at("time").fail("does not ascend: the waypoint before is at " + std::to_string(out.poses.back().time) +
                            " s");
    out.poses.push_back({time, toIsometry(point.at("pose").pose(warnings))});
  }
  if (out.poses.empty()) value.fail("there are no waypoints");
  return out;
}

TrajectoryDescription readTrajectoryValue(const YamlValue &value, const std::string &folder, Warnings &warnings) {
  if (value.isScalar()) return readTrajectory((std::filesystem::path(folder) / value.text()).string(), warnings);
  TrajectoryDescription out = readFile(value, warnings);
  try {
    checkTrajectory(out);
  } catch (const Error &error) {
    value.fail(error.what());
  }
  return out;
}

TrajectoryDescription readTrajectory(const std::string &path, Warnings &warnings) {
  try {
    TrajectoryDescription out = readFile(loadYaml(path), warnings);
    out.id = std::filesystem::path(path).stem().string();
    checkTrajectory(out);
    return out;
  } catch (const BadInput &e) {
    throw BadUsage(path + ": " + e.what());
  } catch (const Error &e) {
    throw BadUsage(path + ": " + e.what());
  }
}

} // namespace curve_proximity::yaml
