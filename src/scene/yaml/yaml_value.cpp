/* SPDX-License-Identifier: BSD-3-Clause */
#include "yaml_value.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "failure.h"
#include "numbers.h"

namespace curve_proximity::yaml {
namespace {

std::string join(const std::string &where, const std::string &key) {
  return where.empty() ? key : where + "." + key;
}

/* The place without what counts list entries, so that a hundred objects give one warning. */
std::string withoutNumbers(const std::string &where) {
  std::string out;
  bool inside = false;
  for (std::size_t i = 0; i < where.size(); ++i) {
    if (where[i] == '[' || where.compare(i, 2, " '") == 0) inside = true;
    if (!inside) out += where[i];
    if (where[i] == ']' || (where[i] == '\'' && where[i - 1] != ' ')) inside = false;
  }
  return out;
}

} // namespace

void YamlValue::fail(const std::string &what) const {
  const YAML::Mark mark = node_.Mark();
  const std::string line = mark.is_null() ? "" : " (line " + std::to_string(mark.line + 1) + ")";
  throw BadInput((where_.empty() ? "the file" : where_) + line + ": " + what);
}

std::optional<YamlValue> YamlValue::find(const char *key) const {
  if (!node_.IsMap()) fail("must be a map");
  const YAML::Node value = static_cast<const YAML::Node &>(node_)[key];
  if (!value || value.IsNull()) return std::nullopt;
  return YamlValue(value, join(where_, key));
}

YamlValue YamlValue::at(const char *key) const {
  std::optional<YamlValue> value = find(key);
  if (!value) fail("has no '" + std::string(key) + "'");
  return *std::move(value);
}

std::vector<YamlValue> YamlValue::items() const {
  if (node_.IsNull()) return {};
  if (!node_.IsSequence()) fail("must be a list");
  std::vector<YamlValue> out;
  out.reserve(node_.size());
  for (const YAML::Node &item : node_) out.emplace_back(item, where_ + "[" + std::to_string(out.size()) + "]");
  return out;
}

std::vector<std::pair<std::string, YamlValue>> YamlValue::entries() const {
  if (node_.IsNull()) return {};
  if (!node_.IsMap()) fail("must be a map");
  std::vector<std::pair<std::string, YamlValue>> out;
  for (const auto &entry : node_) {
    const std::string key = YamlValue(entry.first, where_).text();
    out.emplace_back(key, YamlValue(entry.second, join(where_, key)));
  }
  return out;
}

std::vector<YamlValue> YamlValue::itemsOf(const char *key) const {
  const std::optional<YamlValue> value = find(key);
  return value ? value->items() : std::vector<YamlValue>{};
}

void YamlValue::warnOfOthers(std::initializer_list<const char *> known, Warnings &warnings) const {
  if (!node_.IsMap()) fail("must be a map");
  for (const auto &entry : node_) {
    const std::string key = entry.first.IsScalar() ? entry.first.Scalar() : "(not a word)";
    if (std::find(known.begin(), known.end(), key) != known.end()) continue;
    warnings.add("unknown key '" + join(withoutNumbers(where_), key) + "' is ignored");
  }
}

std::string YamlValue::text() const {
  if (!node_.IsScalar()) fail("must be a word");
  return node_.Scalar();
}

double YamlValue::number() const {
  const std::optional<double> value = node_.IsScalar() ? parseFinite(node_.Scalar()) : std::nullopt;
  if (!value) fail((node_.IsScalar() ? "'" + node_.Scalar() + "' is" : "is") + " not a finite number");
  return *value;
}

std::size_t YamlValue::count() const {
  const std::optional<std::uint64_t> value = node_.IsScalar() ? parseCount(node_.Scalar()) : std::nullopt;
  if (!value) fail((node_.IsScalar() ? "'" + node_.Scalar() + "' is" : "is") + " not a whole number from 0");
  return static_cast<std::size_t>(*value);
}

bool YamlValue::truth() const {
  bool value = false;
  if (node_.IsScalar() && (node_.Scalar() == "1" || node_.Scalar() == "0")) return node_.Scalar() == "1";
  if (!node_.IsScalar() || !YAML::convert<bool>::decode(node_, value)) fail("must be true or false");
  return value;
}

std::vector<double> YamlValue::numbers() const {
  std::vector<double> out;
  if (node_.IsNull()) return out;
  if (!node_.IsSequence()) fail("must be a list of numbers");
  out.reserve(node_.size());
  for (const YAML::Node &item : node_) {
    const std::optional<double> value = item.IsScalar() ? parseFinite(item.Scalar()) : std::nullopt;
    if (value)
      out.push_back(*value);
    else
      YamlValue(item, where_ + "[" + std::to_string(out.size()) + "]").number(); /* says so */
  }
  return out;
}

Eigen::Vector3d YamlValue::vector() const {
  if (node_.IsMap()) return {at("x").number(), at("y").number(), at("z").number()};
  if (!node_.IsSequence() || node_.size() != 3) fail("must be [x, y, z] or a map of x, y and z");
  const std::vector<double> v = numbers();
  return {v[0], v[1], v[2]};
}

Eigen::Quaterniond YamlValue::quaternion(Warnings &warnings) const {
  Eigen::Quaterniond q;
  if (node_.IsMap()) {
    q.coeffs() << at("x").number(), at("y").number(), at("z").number(), at("w").number();
  } else {
    if (!node_.IsSequence() || node_.size() != 4) fail("must be [x, y, z, w] or a map of x, y, z and w");
    const std::vector<double> v = numbers();
    q.coeffs() << v[0], v[1], v[2], v[3];
  }

  /* the norm, of quaternions whose squares leave the range of a double, too */
  const double norm = q.coeffs().stableNorm();
  if (!(norm > 0.0)) fail("the quaternion's norm is 0");
  if (std::abs(norm - 1.0) > 1e-3) {
    warnings.add(where_ + ": the quaternion's norm is " + std::to_string(norm) + "; it is normalised");
  }
  return q;
}

cprox_pose YamlValue::pose(Warnings &warnings, const char *position, const char *orientation) const {
  warnOfOthers({position, orientation}, warnings);
  cprox_pose out = CPROX_POSE_IDENTITY;
  if (const auto p = find(position)) out.position = toVec3(p->vector());
  if (const auto o = find(orientation)) {
    const Eigen::Quaterniond q = o->quaternion(warnings);
    out.orientation = {q.w(), q.x(), q.y(), q.z()};
  }
  return out;
}

YamlValue loadYaml(const std::string &path) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) throw BadUsage(path + ": is a folder, not a file");
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw BadUsage(path + ": cannot be read");

  try {
    return YamlValue(YAML::Load(stream), "");
  } catch (const YAML::ParserException &e) {
    throw BadUsage(path + ": line " + std::to_string(e.mark.line + 1) + ": no YAML: " + e.msg);
  } catch (const YAML::Exception &e) {
    throw BadUsage(path + ": no YAML: " + e.msg);
  }
}

} // namespace curve_proximity::yaml
