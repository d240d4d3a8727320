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

PairDescription::Asked readAsked(const YamlValue &value) {
  const std::string name = value.text();
  if (name == "distance") return PairDescription::DISTANCE;
  if (name == "growth") return PairDescription::GROWTH;
  if (name == "translating_distance") return PairDescription::TRANSLATING_DISTANCE;
  if (name == "translating_contact") return PairDescription::TRANSLATING_CONTACT;
  value.fail("ask '" + name + "' is unknown; it must be distance, growth, translating_distance or translating_contact");
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
  value.warnOfOthers({"id", "a", "b", "ask", "velocity_a", "velocity_b", "duration"}, warnings);
  PairDescription out;
  out.id = value.at("id").text();
  out.a = readPlaced(value.at("a"), warnings);
  out.b = readPlaced(value.at("b"), warnings);
  if (const auto asked = value.find("ask")) out.asked = readAsked(*asked);
  const bool moves =
      out.asked == PairDescription::TRANSLATING_DISTANCE || out.asked == PairDescription::TRANSLATING_CONTACT;
  for (const char *key : {"velocity_a", "velocity_b", "duration"})
    if (!moves && value.find(key))
      value.fail(std::string("has a ") + key + ": bodies move with ask: translating_distance");
  if (!moves) return out;
  if (const auto velocity = value.find("velocity_a")) out.velocity_a = velocity->vector();
  if (const auto velocity = value.find("velocity_b")) out.velocity_b = velocity->vector();
  out.duration = value.at("duration").number();
  return out;
}

} // namespace curve_proximity::cli
