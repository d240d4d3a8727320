/* SPDX-License-Identifier: BSD-3-Clause */
#include "separation_yaml.h"

#include "bad_input.h"
#include "yaml_value.h"

namespace curve_proximity::yaml {
namespace {

double numberOf(const YamlValue &value) {
  if (value.number() < 0.0) value.fail("is below 0");
  return value.number();
}

/* The number under a key; 0 where there is none. */
double optionalNumber(const YamlValue &map, const char *key) {
  const std::optional<YamlValue> value = map.find(key);
  return value ? numberOf(*value) : 0.0;
}

/* What has no default that would be safe. */
double requiredNumber(const YamlValue &map, const char *key) {
  const std::optional<YamlValue> value = map.find(key);
  if (!value) map.fail(std::string("has no ") + key);
  return numberOf(*value);
}

Separation readSeparation(const YamlValue &root) {
  if (root.isEmpty()) root.fail("is empty: person and robot are needed");
  root.refuseOthers({"person", "robot", "intrusion"});
  const std::optional<YamlValue> person = root.find("person"), robot = root.find("robot");
  if (!person || !robot) root.fail(std::string("has no ") + (person ? "robot" : "person"));
  person->refuseOthers({"speed", "position"});
  robot->refuseOthers({"reaction_time", "stopping_time", "position", "speed"});
  Separation out;
  out.person_speed = requiredNumber(*person, "speed");
  out.person_position = optionalNumber(*person, "position");
  out.reaction_time = requiredNumber(*robot, "reaction_time");
  out.stopping_time = requiredNumber(*robot, "stopping_time");
  out.robot_position = optionalNumber(*robot, "position");
  if (robot->find("speed")) out.robot_speed = requiredNumber(*robot, "speed");
  out.intrusion = optionalNumber(root, "intrusion");
  return out;
}

} // namespace

Separation readSeparation(const std::string &path) {
  try {
    return readSeparation(loadYaml(path));
  } catch (const BadInput &e) {
    throw BadUsage(path + ": " + e.what());
  }
}

} // namespace curve_proximity::yaml
