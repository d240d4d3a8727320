/* SPDX-License-Identifier: BSD-3-Clause */
#include "dataset.h"

#include <algorithm>
#include <array>
#include <filesystem>

#include "../scene/base/digest.h"
#include "../scene/motion/trajectory_points.h"
#include "../scene/query/question.h"
#include "../scene/yaml/numbers.h"
#include "../scene/yaml/scene_change.h"
#include "csv.h"
#include "failure.h"

namespace curve_proximity::cli {
namespace {

const std::array<const char *, 8> kKeys = {"id", "robot", "srdf", "scene", "trajectory", "query", "delta", "self"};

void requireKnown(const std::string &key) {
  if (std::find_if(kKeys.begin(), kKeys.end(), [&](const char *known) { return key == known; }) != kKeys.end()) return;
  std::string known;
  for (const char *name : kKeys) known += (known.empty() ? "" : ", ") + std::string(name);
  throw BadInput("'" + key + "' is none of " + known);
}

/* Others are not known here; the reader of YAML says what it makes of them. */
void requireKeys(const Json &map, std::initializer_list<const char *> known) {
  for (const auto &member : map.members)
    if (std::find(known.begin(), known.end(), member.first) == known.end())
      throw BadInput("the trajectory's key '" + member.first + "' is not known here: use a YAML file");
}

double timeOf(const Json &value) {
  if (value.kind != Json::Kind::MAP) return value.number("time_from_start");
  const bool second = value.find("sec") || value.find("nanosec"); /* of ROS 2 */
  const char *const keys[] = {second ? "sec" : "secs", second ? "nanosec" : "nsecs"};
  requireKeys(value, {keys[0], keys[1]});
  const Json *seconds = value.find(keys[0]), *nanoseconds = value.find(keys[1]);
  if (!seconds && !nanoseconds) throw BadInput("time_from_start needs secs or nsecs");
  return (seconds ? seconds->number("secs") : 0.0) + 1e-9 * (nanoseconds ? nanoseconds->number("nsecs") : 0.0);
}

TrajectoryPoint toPoint(const Json &value) {
  requireKeys(value, {"positions", "velocities", "accelerations", "effort", "time_from_start"});
  TrajectoryPoint out;
  const auto list = [&](const char *key) {
    const Json *found = value.find(key);
    return found ? found->numbers(key) : std::vector<double>();
  };
  out.positions = list("positions");
  out.velocities = list("velocities");
  out.accelerations = list("accelerations");
  const Json *time = value.find("time_from_start");
  if (!time) throw BadInput("a point of the trajectory has no time_from_start");
  out.time = timeOf(*time);
  return out;
}

/* The id of a row, or its number. */
std::string idIn(const Json &row, std::size_t number) {
  const Json *id = row.find("id");
  if (id && id->kind == Json::Kind::TEXT) return id->text_value;
  if (!id || id->kind != Json::Kind::NUMBER) return std::to_string(number);
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", id->number_value);
  return text;
}

} // namespace

TrajectoryDescription toTrajectory(const Json &value) {
  if (value.kind != Json::Kind::MAP) throw BadInput("the trajectory must be a map with joint_trajectory");
  requireKeys(value, {"joint_trajectory", "interpolation", "shortest_way", "fixed_joints", "robot", "scene"});
  TrajectoryDescription out;
  const Json *trajectory = value.find("joint_trajectory");
  if (!trajectory || !trajectory->find("joint_names") || !trajectory->find("points"))
    throw BadInput("the trajectory needs joint_trajectory with joint_names and points");
  requireKeys(*trajectory, {"header", "joint_names", "points"});
  if (const Json *header = trajectory->find("header")) {
    if (header->kind != Json::Kind::MAP) throw BadInput("the trajectory's header must be a map");
    requireKeys(*header, {"seq", "stamp", "frame_id"});
  }
  if (const Json *way = value.find("shortest_way")) out.shortest_way = way->truth("shortest_way");
  if (const Json *given = value.find("interpolation")) {
    const std::string name = given->text("interpolation");
    const std::optional<Interpolation> known = interpolationFromName(name);
    if (!known) throw BadInput("interpolation is '" + name + "'; it must be linear, cubic or quintic");
    out.interpolation = *known;
  }
  if (const Json *fixed = value.find("fixed_joints")) {
    if (fixed->kind != Json::Kind::MAP) throw BadInput("fixed_joints must be a map");
    for (const auto &member : fixed->members) out.fixed_joints[member.first] = member.second.number("fixed_joints");
  }
  for (const Json &name : trajectory->find("joint_names")->list("joint_names"))
    out.joints.push_back(name.text("joint_names"));
  for (const Json &point : trajectory->find("points")->list("points")) out.points.push_back(toPoint(point));
  return out;
}

ShardRange cut(std::size_t rows, std::size_t shards, std::size_t shard) {
  /* rows * shard / shards without a product that is too large */
  const auto begin = [&](std::size_t i) { return rows / shards * i + rows % shards * i / shards; };
  return {begin(shard), begin(shard + 1)};
}

Dataset::Dataset(const std::string &path) : path_(path), folder_(yaml::folderOf(path)) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) throw BadUsage(path + ": is a folder, not a manifest");
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw BadUsage(path + ": cannot be read");
  is_csv_ = std::filesystem::path(path).extension() == ".csv";

  Hasher hasher;
  std::string line;
  while (std::getline(stream, line)) {
    hasher.add(line);
    if (!isRow(line)) continue;
    if (is_csv_ && columns_.empty()) {
      if (line.back() == '\r') line.pop_back();
      try {
        for (const std::string &field : splitFields(line)) {
          columns_.emplace_back(yaml::trimmed(field));
          requireKnown(columns_.back());
        }
      } catch (const BadInput &e) {
        throw BadUsage(path + ": its first row must name its columns: " + e.what());
      }
      continue;
    }
    ++rows_;
  }
  if (stream.bad()) throw BadUsage(path + ": cannot be read");
  digest_ = toHex(hasher.finish());
}

bool Dataset::isRow(const std::string &line) const {
  return !yaml::trimmed(line).empty() && line != "\r" && !(is_csv_ && line.front() == '#');
}

Dataset::Reader::Reader(const Dataset &dataset, const ShardRange &range)
    : dataset_(dataset), stream_(dataset.path_, std::ios::binary), range_(range) {}

std::optional<ManifestRow> Dataset::Reader::next() {
  std::string line;
  bool header = dataset_.is_csv_ && at_ == 0;
  while (at_ < range_.last && std::getline(stream_, line)) {
    if (!dataset_.isRow(line)) continue;
    if (header) {
      header = false;
      continue;
    }
    if (at_++ < range_.first) continue;
    if (line.back() == '\r') line.pop_back();
    return ManifestRow{at_ - 1, std::move(line)};
  }
  if (at_ < range_.last) throw BadUsage(dataset_.path_ + ": has changed while it was read");
  return std::nullopt;
}

/* A row of CSV: its fields as texts, empty ones left out; numbers and truths are read from their texts. */
Json Dataset::toJson(const std::string &text) const {
  if (!is_csv_) return parseJson(text);
  const std::vector<std::string> fields = splitFields(text);
  if (fields.size() != columns_.size())
    throw BadInput("it has " + std::to_string(fields.size()) + " columns, the header " +
                   std::to_string(columns_.size()));
  Json row = Json::mapOf({});
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const std::string field(yaml::trimmed(fields[i]));
    if (field.empty()) continue;
    Json value = field;
    if (columns_[i] == "delta") {
      const std::optional<double> number = yaml::parseFinite(field);
      if (!number) throw BadInput("delta is '" + field + "', not a finite number");
      value = *number;
    } else if (columns_[i] == "self") {
      if (field != "true" && field != "false") throw BadInput("self is '" + field + "', not true or false");
      value = field == "true";
    }
    row.members.emplace_back(columns_[i], std::move(value));
  }
  return row;
}

std::string Dataset::fileOf(const Json &row, const char *key) const {
  const Json *value = row.find(key);
  if (!value || value->text(key).empty()) return "";
  const std::string &file = value->text(key);
  return file.front() == '/' ? file : folder_ + '/' + file;
}

RowFiles Dataset::filesIn(const Json &row) const {
  RowFiles out;
  out.robot = fileOf(row, "robot");
  out.srdf = fileOf(row, "srdf");
  out.scene = fileOf(row, "scene");
  if (out.robot.empty()) throw BadInput("it names no robot");
  const Json *trajectory = row.find("trajectory");
  if (!trajectory) throw BadInput("it names no trajectory");
  if (trajectory->kind != Json::Kind::MAP) out.trajectory = fileOf(row, "trajectory");
  return out;
}

RowFiles Dataset::filesOf(const ManifestRow &row) const {
  return filesIn(is_csv_ ? toJson(row.text) : outlineOfJson(row.text));
}

DatasetRow Dataset::parse(const ManifestRow &row) const {
  const Json value = toJson(row.text);
  if (value.kind != Json::Kind::MAP) throw BadInput("a row must be a map");
  for (const auto &member : value.members) requireKnown(member.first);
  DatasetRow out;
  out.id = idIn(value, row.number);
  out.files = filesIn(value);
  const Json *trajectory = value.find("trajectory");
  if (trajectory->kind == Json::Kind::MAP) out.inline_trajectory = toTrajectory(*trajectory);

  /* the query */
  const Json *query = value.find("query"), *delta = value.find("delta"), *self = value.find("self");
  if (query) {
    const std::optional<QueryType> known = queryTypeFromName(query->text("query"));
    if (!known) throw BadInput("query is '" + query->text_value + "'; it must be distance, tolerance or collision");
    out.query_type = *known;
  }
  if (delta) out.delta = delta->number("delta");
  if (self) out.self = self->truth("self");
  if (!query && delta) out.query_type = QueryType::TOLERANCE;
  const bool tolerance = out.query_type == QueryType::TOLERANCE;
  if (tolerance && !delta) throw BadInput("tolerance needs a delta");
  if (!tolerance && out.delta != 0.0) throw BadInput("delta is for tolerance");
  if (out.delta < 0.0) throw BadInput("delta is below 0");
  return out;
}

std::string Dataset::idOf(const ManifestRow &row) const {
  try {
    return idIn(toJson(row.text), row.number);
  } catch (const BadInput &) {
    return std::to_string(row.number);
  }
}

} // namespace curve_proximity::cli
