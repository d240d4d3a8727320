/* SPDX-License-Identifier: BSD-3-Clause */
#include "dataset.h"

#include <algorithm>
#include <array>
#include <filesystem>

#include "../scene/base/digest.h"
#include "../scene/query/question.h"
#include "../scene/yaml/numbers.h"
#include "../scene/yaml/scene_change.h"
#include "../scene/yaml/trajectory_yaml.h"
#include "csv.h"
#include "exit_code.h"
#include "json.h"

namespace curve_proximity::cli {
namespace {

const std::array<const char *, 8> kKeys = {"id", "robot", "srdf", "scene", "trajectory", "query", "delta", "self"};

void requireKnown(const std::string &key) {
  if (std::find_if(kKeys.begin(), kKeys.end(), [&](const char *known) { return key == known; }) != kKeys.end()) return;
  std::string known;
  for (const char *name : kKeys) known += (known.empty() ? "" : ", ") + std::string(name);
  throw BadInput("'" + key + "' is none of " + known);
}

/* The id of a row, or its number. */
std::string idIn(const YamlValue &row, std::size_t number) {
  const std::optional<YamlValue> id = row.find("id");
  return id && id->isScalar() ? id->text() : std::to_string(number);
}

} // namespace

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

/* A row of CSV: its fields as texts, empty ones left out. */
YamlValue Dataset::valueOf(const std::string &text) const {
  if (!is_csv_) return parseJson(text);
  const std::vector<std::string> fields = splitFields(text);
  if (fields.size() != columns_.size())
    throw BadInput("it has " + std::to_string(fields.size()) + " columns, the header " +
                   std::to_string(columns_.size()));
  YAML::Node row(YAML::NodeType::Map);
  for (std::size_t i = 0; i < fields.size(); ++i)
    if (const std::string field(yaml::trimmed(fields[i])); !field.empty()) row[columns_[i]] = field;
  return {row, ""};
}

std::string Dataset::fileOf(const YamlValue &row, const char *key) const {
  const std::optional<YamlValue> value = row.find(key);
  if (!value || value->text().empty()) return "";
  const std::string file = value->text();
  return file.front() == '/' ? file : folder_ + '/' + file;
}

RowFiles Dataset::filesIn(const YamlValue &row) const {
  RowFiles out;
  out.robot = fileOf(row, "robot");
  out.srdf = fileOf(row, "srdf");
  out.scene = fileOf(row, "scene");
  if (out.robot.empty()) throw BadInput("it names no robot");
  const std::optional<YamlValue> trajectory = row.find("trajectory");
  if (!trajectory) throw BadInput("it names no trajectory");
  if (!trajectory->isMap()) out.trajectory = fileOf(row, "trajectory");
  return out;
}

RowFiles Dataset::filesOf(const ManifestRow &row) const {
  return filesIn(is_csv_ ? valueOf(row.text) : outlineOfJson(row.text));
}

DatasetRow Dataset::parse(const ManifestRow &row) const {
  const YamlValue value = valueOf(row.text);
  if (!value.isMap()) throw BadInput("a row must be a map");
  for (const auto &[key, entry] : value.entries()) requireKnown(key);
  DatasetRow out;
  out.id = idIn(value, row.number);
  out.files = filesIn(value);
  Warnings warnings; /* what it leaves out is in its coverage */
  const YamlValue trajectory = value.at("trajectory");
  if (trajectory.isMap()) out.inline_trajectory = readTrajectoryValue(trajectory, folder_, warnings);

  /* the query */
  const std::optional<YamlValue> query = value.find("query"), delta = value.find("delta"), self = value.find("self");
  if (query) {
    const std::optional<QueryType> known = queryTypeFromName(query->text());
    if (!known) throw BadInput("query is '" + query->text() + "'; it must be distance, tolerance or collision");
    out.query_type = *known;
  }
  if (delta) out.delta = delta->number();
  if (self) out.self = self->truth();
  if (!query && delta) out.query_type = QueryType::TOLERANCE;
  const bool tolerance = out.query_type == QueryType::TOLERANCE;
  if (tolerance && !delta) throw BadInput("tolerance needs a delta");
  if (!tolerance && out.delta != 0.0) throw BadInput("delta is for tolerance");
  if (out.delta < 0.0) throw BadInput("delta is below 0");
  return out;
}

std::string Dataset::idOf(const ManifestRow &row) const {
  try {
    return idIn(valueOf(row.text), row.number);
  } catch (const BadInput &) {
    return std::to_string(row.number);
  }
}

} // namespace curve_proximity::cli
