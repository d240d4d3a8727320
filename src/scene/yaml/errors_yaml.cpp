/* SPDX-License-Identifier: BSD-3-Clause */
#include "errors_yaml.h"

#include "bad_input.h"
#include "yaml_value.h"

namespace curve_proximity::yaml {
namespace {

/* The bound under a key; 0 where there is none. */
double readBound(const YamlValue &map, const char *key) {
  const std::optional<YamlValue> value = map.find(key);
  if (!value) return 0.0;
  if (value->number() < 0.0) value->fail("is below 0: it bounds an error");
  return value->number();
}

JointErrors readJoint(const YamlValue &value) {
  value.refuseOthers({"tracking", "speed", "acceleration"});
  return {readBound(value, "tracking"), readBound(value, "speed"), readBound(value, "acceleration")};
}

/* {position, rotation} */
void readPlace(const YamlValue &root, const char *key, double &position, double &rotation) {
  const std::optional<YamlValue> value = root.find(key);
  if (!value) return;
  value->refuseOthers({"position", "rotation"});
  position = readBound(*value, "position");
  rotation = readBound(*value, "rotation");
}

ErrorBounds readErrors(const YamlValue &root) {
  if (root.isEmpty()) root.fail("is empty: no error is bounded");
  root.refuseOthers({"every_joint", "joints", "timing", "base", "objects", "sensor", "flex"});
  ErrorBounds out;
  if (const auto every = root.find("every_joint")) out.every_joint = readJoint(*every);
  if (const auto joints = root.find("joints"))
    for (const auto &[name, value] : joints->entries()) out.joints[name] = readJoint(value);
  out.timing = readBound(root, "timing");
  readPlace(root, "base", out.base_position, out.base_rotation);
  readPlace(root, "objects", out.object_position, out.object_rotation);
  out.sensor = readBound(root, "sensor");
  out.flex = readBound(root, "flex");
  return out;
}

} // namespace

ErrorBounds readErrors(const std::string &path) {
  try {
    return readErrors(loadYaml(path));
  } catch (const BadInput &e) {
    throw BadUsage(path + ": " + e.what());
  }
}

} // namespace curve_proximity::yaml
