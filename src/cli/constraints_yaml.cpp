/* SPDX-License-Identifier: BSD-3-Clause */
#include "constraints_yaml.h"

#include "../ros/conversions.h"
#include "../scene/yaml/numbers.h"
#include "../scene/yaml/scene_yaml.h"

namespace curve_proximity::cli {
namespace {

void requireFixed(const YamlValue &value, const std::string &frame) {
  if (!frame.empty() && frame != "world")
    value.fail("frame '" + frame + "': without a node everything stands in the fixed frame, '' or 'world'");
}

ObjectDescription readSide(const YamlValue &value, bool rides, const Snapshot &snapshot, Warnings &warnings) {
  value.warnOfOthers({"id", "header", "pose", "padding", "primitives", "primitive_poses", "meshes", "mesh_poses",
                      "planes", "plane_poses", "bodies", "body_poses", "operation"},
                     warnings);
  ObjectDescription side = readPlacedShapes(value, warnings);
  requireFixed(value, side.frame);
  const std::optional<YamlValue> id = value.find("id");
  if (!side.shapes.empty() || !id || id->text().empty()) return side;

  // An object of the scene, perhaps elsewhere.
  const auto found = snapshot.objects().find(id->text());
  if (found == snapshot.objects().end()) id->fail("there is no object '" + id->text() + "' in the scene");
  ObjectDescription object = found->second->description;
  if (rides || value.find("pose")) object.pose = side.pose;
  return object;
}

/* What a curve and a piece have in common. */
template <typename Message>
void readBasis(const YamlValue &value, Message &message) {
  message.basis = value.at("basis").text();
  if (const auto degree = value.find("degree")) message.degree = static_cast<std::uint32_t>(degree->count());
  if (const auto t0 = value.find("t0")) message.t0 = t0->number();
  if (const auto t1 = value.find("t1")) message.t1 = t1->number();
  if (const auto knots = value.find("knots")) message.knots = knots->numbers();
  if (const auto parameters = value.find("parameters")) message.parameters = parameters->numbers();
  if (message.basis == Curve::PIECEWISE) return;
  for (const YamlValue &point : value.at("points").items())
    message.points.push_back(toPointMessage(toVec3(point.vector())));
}

CurveDescription readCurve(const YamlValue &value, Warnings &warnings) {
  value.warnOfOthers({"header", "id", "basis", "degree", "t0", "t1", "radius", "points", "knots", "parameters",
                      "pieces", "restrict_t0", "restrict_t1"},
                     warnings);
  if (const auto header = value.find("header"))
    if (const auto frame = header->find("frame_id")) requireFixed(value, frame->text());
  Curve message;
  readBasis(value, message);
  if (const auto radius = value.find("radius")) message.radius = radius->number();
  if (const auto from = value.find("restrict_t0")) message.restrict_t0 = from->number();
  if (const auto to = value.find("restrict_t1")) message.restrict_t1 = to->number();
  for (const YamlValue &piece : value.itemsOf("pieces")) {
    piece.warnOfOthers({"basis", "degree", "t0", "t1", "points", "knots", "parameters"}, warnings);
    message.pieces.emplace_back();
    readBasis(piece, message.pieces.back());
  }
  return toDescription(message, Eigen::Isometry3d::Identity());
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

ConstraintCase parseCase(const YamlValue &entry, const Snapshot &snapshot, Warnings &warnings) {
  const YamlValue value(entry.named(caseId(entry)));
  if (const auto trajectory = value.find("trajectory"))
    trajectory->fail("is given by --trajectory T.yaml and --robot URDF, without --in");
  value.warnOfOthers({"id", "providers", "a", "b", "curve"}, warnings);
  ConstraintCase out;
  out.id = caseId(entry);
  if (const auto curve = value.find("curve")) out.curve = readCurve(*curve, warnings);
  if (const auto a = value.find("a")) out.a = readSide(*a, out.curve.has_value(), snapshot, warnings);
  out.b = readSide(value.at("b"), false, snapshot, warnings);
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
    out[name] = toParameterValue(entry.second, name);
  }
  return out;
}

} // namespace curve_proximity::cli
