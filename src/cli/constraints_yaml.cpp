/* SPDX-License-Identifier: BSD-3-Clause */
#include "constraints_yaml.h"

#include "../scene/yaml/curve_yaml.h"
#include "../scene/yaml/numbers.h"
#include "../scene/yaml/scene_yaml.h"

namespace curve_proximity::cli {
namespace {

void requireFixed(const YamlValue &value, const std::string &frame) {
  if (!frame.empty() && frame != "world")
    value.fail("frame '" + frame + "': without a node everything stands in the fixed frame, '' or 'world'");
}

ObjectDescription readSide(const YamlValue &value, bool rides, const World &world, Warnings &warnings,
                           std::optional<ResourceOptions> &resources) {
  value.warnOfOthers({"id", "header", "pose", "padding", "primitives", "primitive_poses", "meshes", "mesh_poses",
                      "planes", "plane_poses", "bodies", "body_poses", "operation"},
                     warnings);
  ObjectDescription side = readPlacedShapes(value, warnings);
  requireFixed(value, side.frame);
  const std::optional<YamlValue> id = value.find("id");
  if (!side.shapes.empty() || !id || id->text().empty()) return side;

  // An object of the scene, perhaps elsewhere, or what is on the robot.
  ConstraintSide found;
  try {
    found = sideOf(*world.snapshot, id->text(), [&](const std::string &link) { return world.links.at(link); });
  } catch (const Error &error) {
    id->fail(error.what());
  }
  if (found.is_on_robot && value.find("pose"))
    id->fail("'" + id->text() + "' is on the robot: its joint values say where it is, it takes no pose");
  resources = std::move(found.resources);
  ObjectDescription object = std::move(found.object);
  if (rides || value.find("pose")) object.pose = side.pose;
  return object;
}

ParameterValue toParameterValue(const YAML::Node &node, const std::string &name) {
  if (node.IsSequence()) {
    std::vector<double> numbers;
    for (const YAML::Node &item : node) {
      const std::optional<double> number = item.IsScalar() ? parseFinite(item.Scalar()) : std::nullopt;
      if (!number) throw BadUsage("--parameters: " + name + ": a list holds numbers alone");
      numbers.push_back(*number);
    }
    return numbers;
  }
  if (!node.IsScalar())
    throw BadUsage("--parameters: " + name + ": a number, a word, true, false or a list is expected");
  const std::string &text = node.Scalar();
  if (text == "true" || text == "false") return text == "true";
  int whole;
  if (YAML::convert<int>::decode(node, whole)) return whole;
  if (const std::optional<double> number = parseFinite(text)) return *number;
  return text;
}

} // namespace

std::vector<YamlValue> readCases(const std::string &path, Warnings &warnings) {
  const YamlValue root = loadYaml(path);
  if (!root.isMap() || !root.find("cases") || !root.find("cases")->isSequence())
    throw BadUsage(path + ": must be a map with a list 'cases'");
  root.warnOfOthers({"cases"}, warnings);
  return root.find("cases")->items();
}

std::string caseId(const YamlValue &entry) {
  if (!entry.isMap()) return "";
  const std::optional<YamlValue> id = entry.find("id");
  return id && id->isScalar() ? id->text() : "";
}

ConstraintCase parseCase(const YamlValue &entry, const World &world, Warnings &warnings) {
  const YamlValue value(entry.named(caseId(entry)));
  if (const auto trajectory = value.find("trajectory"))
    trajectory->fail("is given by --trajectory T.yaml and --robot URDF, without --in");
  value.warnOfOthers({"id", "providers", "a", "b", "curve"}, warnings);
  ConstraintCase out;
  out.id = caseId(entry);
  if (const auto curve = value.find("curve")) out.curve = readCurve(*curve, warnings);
  if (const auto a = value.find("a")) out.a = readSide(*a, out.curve.has_value(), world, warnings, out.resources_a);
  out.b = readSide(value.at("b"), false, world, warnings, out.resources_b);
  return out;
}

ParameterMap parseParameters(const std::string &text) {
  ParameterMap out;
  YAML::Node root;
  try {
    root = YAML::Load("{" + text + "}");
  } catch (const YAML::Exception &e) {
    throw BadUsage("--parameters '" + text + "': names and values are expected, 'name: value, …': " + e.msg);
  }
  for (const auto &entry : root) {
    const std::string name = entry.first.IsScalar() ? entry.first.Scalar() : "";
    if (!out.emplace(name, toParameterValue(entry.second, name)).second)
      throw BadUsage("--parameters: " + name + " is given twice");
  }
  return out;
}

} // namespace curve_proximity::cli
