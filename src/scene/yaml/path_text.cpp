/* SPDX-License-Identifier: BSD-3-Clause */
#include "path_text.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>
#include <utility>

#include "bad_input.h"
#include "motion/path_times.h"
#include "numbers.h"

namespace curve_proximity::yaml {
namespace {

constexpr std::size_t POSE = 8, WITH_STATE = 17; /* numbers of a line; EuRoC's with velocity and biases */

/* Digits, and of seconds nine behind a point: exact, where a double has not as many. */
std::optional<std::int64_t> nanosecondsOf(const std::string &word, bool seconds) {
  constexpr std::size_t MOST = 18, BEHIND = 9;
  const std::size_t point = std::min(word.find('.'), word.size());
  std::string digits = word.substr(0, point), behind = point < word.size() ? word.substr(point + 1) : "";
  if (digits.empty() || (digits + behind).find_first_not_of("0123456789") != std::string::npos) return std::nullopt;
  if (!seconds && !behind.empty()) return std::nullopt;
  behind.resize(seconds ? BEHIND : 0, '0');
  digits += behind;
  digits.erase(0, std::min(digits.find_first_not_of('0'), digits.size() - 1));
  if (digits.size() > MOST + 1) return std::nullopt;
  return std::stoll(digits);
}

struct StampedPose {
  std::int64_t stamp;
  Eigen::Isometry3d pose;
};

StampedPose poseOf(const std::string &line, bool turns, const std::string &place, Warnings &warnings) {
  const bool commas = line.find(',') != std::string::npos;
  std::string blanks = line;
  std::replace(blanks.begin(), blanks.end(), ',', ' ');
  std::istringstream stream(blanks);
  std::vector<std::string> words;
  for (std::string word; stream >> word;) words.push_back(word);
  if (words.size() != POSE && !(commas && words.size() == WITH_STATE))
    throw BadInput(place + "has " + std::to_string(words.size()) +
                   " numbers: a pose is stamp x y z qx qy qz qw, or with commas stamp, x, y, z, qw, qx, qy, qz");
  const std::optional<std::int64_t> stamp = nanosecondsOf(words[0], !commas);
  if (!stamp) throw BadInput(place + "the stamp '" + words[0] + (commas ? "' is no nanoseconds" : "' is no seconds"));
  std::array<double, POSE - 1> v{};
  for (std::size_t i = 0; i < v.size(); ++i) {
    const std::optional<double> value = parseFinite(words[i + 1]);
    if (!value) throw BadInput(place + "'" + words[i + 1] + "' is not a finite number");
    v[i] = *value;
  }
  cprox_pose pose = CPROX_POSE_IDENTITY;
  pose.position = {v[0], v[1], v[2]};
  if (turns) {
    const cprox_quat q = commas ? cprox_quat{v[3], v[4], v[5], v[6]} : cprox_quat{v[6], v[3], v[4], v[5]};
    const double norm = Eigen::Vector4d(q.w, q.x, q.y, q.z).stableNorm();
    if (!(norm > 0.0)) throw BadInput(place + "the quaternion's norm is 0");
    if (std::abs(norm - 1.0) > 1e-3)
      warnings.add(place + "the quaternion's norm is " + std::to_string(norm) + "; it is normalised");
    pose.orientation = q;
  }
  return {*stamp, toIsometry(pose)};
}

} // namespace

bool isPathText(const std::string &path) {
  const std::string end = std::filesystem::path(path).extension().string();
  return end == ".txt" || end == ".tum" || end == ".csv";
}

PathFile readPathText(const std::string &path, bool turns, Warnings &warnings) {
  std::ifstream in(path);
  if (!in || std::filesystem::is_directory(path)) throw BadInput("cannot be read");
  PathFile out;
  std::vector<std::int64_t> stamps;
  std::size_t number = 0;
  for (std::string line; std::getline(in, line);) {
    ++number;
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (trimmed(line).empty() || trimmed(line).front() == '#') continue;
    const StampedPose found = poseOf(line, turns, "line " + std::to_string(number) + ": ", warnings);
    stamps.push_back(found.stamp);
    out.poses.push_back({0.0, found.pose});
  }
  if (in.bad()) throw BadInput("reading failed after line " + std::to_string(number));
  if (out.poses.empty()) throw BadInput("the path has no poses");
  PathTimes at = timesOf(stamps, 0);
  for (std::size_t i = 0; i < out.poses.size(); ++i) out.poses[i].time = at.times[i];
  out.origin = at.origin;
  out.remark = std::move(at.remark);
  return out;
}

} // namespace curve_proximity::yaml
