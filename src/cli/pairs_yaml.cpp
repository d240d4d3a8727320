/* SPDX-License-Identifier: BSD-3-Clause */
#include "pairs_yaml.h"

#include "../scene/yaml/body_yaml.h"
#include "failure.h"

namespace curve_proximity::cli {
namespace {

PlacedShape readPlaced(const YamlValue &value, Warnings &warnings) {
  PlacedShape out;
  out.shape = readBody(value, warnings);
  if (const auto pose = value.find("pose")) out.pose = pose->pose(warnings);
  return out;
}

} // namespace

std::vector<YamlValue> readPairs(const std::string &path) {
  const YamlValue root = loadYaml(path);
  if (!root.isSequence()) throw BadUsage(path + ": must be a list of {id, a: BODY, b: BODY}");
  return root.items();
}

std::string pairId(const YamlValue &entry) {
  if (!entry.isMap()) return "";
  const std::optional<YamlValue> id = entry.find("id");
  return id && id->isScalar() ? id->text() : "";
}

PairDescription parsePair(const YamlValue &entry, Warnings &warnings) {
  const YamlValue value(entry.named(pairId(entry)));
  value.warnOfOthers({"id", "a", "b"}, warnings);
  PairDescription out;
  out.id = value.at("id").text();
  out.a = readPlaced(value.at("a"), warnings);
  out.b = readPlaced(value.at("b"), warnings);
  return out;
}

} // namespace curve_proximity::cli
