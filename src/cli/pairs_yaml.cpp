/* SPDX-License-Identifier: BSD-3-Clause */
#include "pairs_yaml.h"

#include "../scene/yaml/body_yaml.h"
#include "exit_code.h"

namespace curve_proximity::cli {
namespace {

PlacedBody readPlaced(const YamlValue &value, Warnings &warnings) {
  PlacedBody out;
  out.shape = readBody(value, warnings);
  if (const auto pose = value.find("pose")) out.pose = pose->pose(warnings);
  return out;
}

PairDescription::Asked readAsked(const YamlValue &value) {
  const std::optional<PairDescription::Asked> asked = pairQuestion(value.text());
  if (!asked)
    value.fail("ask '" + value.text() +
               "' is unknown; it must be distance, growth, translating_distance or translating_contact");
  return *asked;
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
  value.refuseOthers({"id", "a", "b", "ask", "velocity_a", "velocity_b", "duration"});
  PairDescription out;
  out.id = value.at("id").text();
  out.a = readPlaced(value.at("a"), warnings);
  out.b = readPlaced(value.at("b"), warnings);
  if (const auto asked = value.find("ask")) out.asked = readAsked(*asked);
  const bool moves = isTranslating(out.asked);
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
