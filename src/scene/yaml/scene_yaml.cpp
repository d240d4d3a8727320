/* SPDX-License-Identifier: BSD-3-Clause */
#include "scene_yaml.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>
#include <utility>

#include "bad_input.h"
#include "body_yaml.h"
#include "cloud_file.h"
#include "numbers.h"
#include "robot_state_yaml.h"
#include "scene_change.h"
#include "scene_text.h"
#include "trajectory_yaml.h"

namespace curve_proximity::yaml {
namespace {

/* ---- words or numbers, as the constants of moveit_msgs and shape_msgs count them */

/* The place of the value among the names: by name, or by its number counted from `first`. */
template <std::size_t N>
std::size_t choose(const YamlValue &value, const std::array<const char *, N> &names, std::size_t first,
                   const std::string &what) {
  std::string text = value.text(), list;
  for (char &c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  const std::optional<std::uint64_t> number = parseCount(text);
  for (std::size_t i = 0; i < N; ++i) {
    if (text == names[i] || (number && *number == first + i)) return i;
    list += (i ? ", " : "") + std::string(names[i]) + " (" + std::to_string(first + i) + ")";
  }
  value.fail(what + " '" + value.text() + "' is none of " + list);
}

/* ---- one collision object */

/* The poses that belong to n shapes; none at all means that each stands at the object's pose. */
std::vector<Eigen::Isometry3d> readPoses(const YamlValue &object, const char *key, std::size_t n, const char *shapes,
                                         Warnings &warnings) {
  const std::vector<YamlValue> poses = object.itemsOf(key);
  if (!poses.empty() && poses.size() != n) {
    object.fail("has " + std::to_string(n) + " " + shapes + " and " + std::to_string(poses.size()) + " " + key);
  }
  std::vector<Eigen::Isometry3d> out(n, Eigen::Isometry3d::Identity());
  for (std::size_t i = 0; i < poses.size(); ++i) out[i] = toIsometry(poses[i].pose(warnings));
  return out;
}

ShapeDescription readPrimitive(const YamlValue &value, Warnings &warnings) {
  static const std::array<const char *, 4> kNames = {"box", "sphere", "cylinder", "cone"};
  static const std::array<ShapeType, 4> kTypes = {ShapeType::BOX, ShapeType::SPHERE, ShapeType::CYLINDER,
                                                  ShapeType::CONE};
  value.warnOfOthers({"type", "dimensions", "polygon"}, warnings); /* of ROS 2: the outline of a prism, which none is */
  ShapeDescription shape;
  shape.type = kTypes[choose(value.at("type"), kNames, 1, "the primitive")];
  shape.dimensions = value.at("dimensions").numbers();
  return shape;
}

ShapeDescription readPlane(const YamlValue &value, Warnings &warnings) {
  value.warnOfOthers({"coef"}, warnings);
  ShapeDescription shape;
  shape.type = ShapeType::HALFSPACE;
  shape.dimensions = value.at("coef").numbers();
  return shape;
}

ShapeDescription readMeshEntry(const YamlValue &value, Warnings &warnings) {
  ShapeDescription shape;
  readMesh(value, shape, warnings);
  return shape;
}

/* A BODY; a pose of its own comes after that of body_poses. */
ShapeDescription readBodyEntry(const YamlValue &value, Warnings &warnings) {
  ShapeDescription shape = readBody(value, warnings);
  if (const auto pose = value.find("pose")) shape.pose = toIsometry(pose->pose(warnings));
  return shape;
}

/* One of the four lists of shapes, each with its list of poses. */
void readShapes(const YamlValue &value, const char *key, const char *poses_key,
                ShapeDescription (*read)(const YamlValue &, Warnings &), ObjectDescription &object,
                Warnings &warnings) {
  const std::vector<YamlValue> shapes = value.itemsOf(key);
  const std::vector<Eigen::Isometry3d> poses = readPoses(value, poses_key, shapes.size(), key, warnings);
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    ShapeDescription shape = read(shapes[i], warnings);
    shape.pose = poses[i] * shape.pose;
    object.shapes.push_back(std::move(shape));
  }
}

Operation readObject(const YamlValue &plain, Warnings &warnings) {
  Operation out;
  ObjectDescription &object = out.object;
  if (const auto id = plain.find("id")) object.id = id->text();
  const YamlValue value = object.id.empty() ? plain : plain.named(object.id);
  value.warnOfOthers(
      {"header", "pose", "id", "type", "primitives", "primitive_poses", "meshes", "mesh_poses", "planes", "plane_poses",
       "bodies", "body_poses", "padding", "subframe_names", "subframe_poses", "operation", "trajectory"},
      warnings);

  /* what is to be done with it; a file is a scene, so ADD is what is meant where nothing is said */
  static const std::array<const char *, 4> kOperations = {"add", "remove", "append", "move"};
  static const std::array<Operation::Kind, 4> kKinds = {Operation::Kind::ADD, Operation::Kind::REMOVE,
                                                        Operation::Kind::APPEND, Operation::Kind::MOVE};
  if (const auto operation = value.find("operation")) {
    out.kind = kKinds[choose(*operation, kOperations, 0, "the operation")];
  }
  if (object.id.empty() && out.kind != Operation::Kind::REMOVE) value.fail("the object has no id");

  /* where it stands, and what it consists of */
  const std::string id = object.id;
  object = readPlacedShapes(value, warnings);
  object.id = id;
  const bool shapes_expected = out.kind == Operation::Kind::ADD || out.kind == Operation::Kind::APPEND;
  if (shapes_expected && object.shapes.empty()) {
    value.fail("the object has no shape: neither primitives, meshes, planes nor bodies");
  }
  if (const auto trajectory = value.find("trajectory")) {
    if (value.find("pose")) value.fail("has a pose and a trajectory: the trajectory says where the object is");
    out.trajectory = readObjectTrajectory(*trajectory, warnings);
  }
  return out;
}

/* ---- the other parts of the file */

/* octomap_msgs/OctomapWithPose; without data there is none. Its name is the one by which MoveIt knows it. */
void readOctomap(const YamlValue &value, SceneFile &out, Warnings &warnings) {
  value.warnOfOthers({"header", "origin", "octomap"}, warnings);
  const std::optional<YamlValue> map = value.find("octomap");
  if (!map) return;
  map->warnOfOthers({"header", "binary", "id", "resolution", "data"}, warnings);
  const std::vector<YamlValue> bytes = map->itemsOf("data");
  if (bytes.empty()) return;

  Operation operation;
  ObjectDescription &object = operation.object;
  object.id = "<octomap>";
  object.frame = readFrame(value, warnings);
  if (const auto origin = value.find("origin")) object.pose = toIsometry(origin->pose(warnings));
  object.shapes.emplace_back();
  object.shapes.front().type = ShapeType::OCTREE;
  OctreeData &octree = object.shapes.front().octree;
  octree.binary = map->at("binary").truth();
  octree.id = map->at("id").text();
  octree.resolution = map->at("resolution").number();
  for (const YamlValue &byte : bytes) {
    const double number = byte.number(); /* an int8, or a byte without sign */
    if (!(number >= -128.0 && number <= 255.0 && number == std::floor(number))) byte.fail("is no byte");
    octree.data += static_cast<char>(static_cast<int>(number));
  }
  out.operations.push_back(std::move(operation));
}

void readWorld(const YamlValue &world, SceneFile &out, Warnings &warnings) {
  world.warnOfOthers({"collision_objects", "octomap"}, warnings);
  for (const YamlValue &object : world.itemsOf("collision_objects")) {
    out.operations.push_back(readObject(object, warnings));
  }

  if (const auto stamped = world.find("octomap")) readOctomap(*stamped, out, warnings);
}

void readTransforms(const YamlValue &root, SceneFile &out, Warnings &warnings) {
  for (const YamlValue &value : root.itemsOf("fixed_frame_transforms")) {
    value.warnOfOthers({"header", "child_frame_id", "transform"}, warnings);
    FrameTransform transform;
    transform.parent = readFrame(value, warnings);
    transform.child = value.at("child_frame_id").text();
    transform.pose = toIsometry(value.at("transform").pose(warnings, "translation", "rotation"));
    out.transforms.push_back(std::move(transform));
  }
}

void readRobotState(const YamlValue &root, SceneFile &out, Warnings &warnings) {
  const std::optional<YamlValue> state = root.find("robot_state");
  if (!state) return;
  state->warnOfOthers({"joint_state", "multi_dof_joint_state", "attached_collision_objects", "is_diff"}, warnings);

  const JointsFile joints = readJoints(*state, warnings);
  out.joints = joints.joints;
  out.free_joints = joints.free_joints;
  for (const YamlValue &value : state->itemsOf("attached_collision_objects")) {
    value.warnOfOthers({"link_name", "object", "touch_links", "detach_posture", "weight"}, warnings);
    const Operation operation = readObject(value.at("object"), warnings);
    if (operation.kind != Operation::Kind::ADD) value.fail("an attached object's operation must be add (0)");
    if (operation.trajectory) value.fail("an attached object moves with its link: it takes no trajectory");
    Attachment attachment;
    attachment.link = value.at("link_name").text();
    attachment.object = operation.object;
    for (const YamlValue &link : value.itemsOf("touch_links")) attachment.touch_links.push_back(link.text());
    out.attached.push_back(std::move(attachment));
  }
}

void readLinkSizes(const YamlValue &root, SceneFile &out, Warnings &warnings) {
  for (const YamlValue &value : root.itemsOf("link_padding")) {
    value.warnOfOthers({"link_name", "padding"}, warnings);
    const YamlValue padding = value.at("padding");
    if (padding.number() < 0.0) padding.fail("a padding below 0 is not available");
    const YamlValue link = value.at("link_name");
    if (!out.link_padding.emplace(link.text(), padding.number()).second) link.fail("has a padding already");
  }
  std::set<std::string> scaled;
  for (const YamlValue &value : root.itemsOf("link_scale")) {
    value.warnOfOthers({"link_name", "scale"}, warnings);
    const YamlValue scale = value.at("scale");
    if (!(scale.number() > 0.0)) scale.fail("a scale must be above 0");
    const YamlValue link = value.at("link_name");
    if (!scaled.insert(link.text()).second) link.fail("has a scale already");
    if (scale.number() != 1.0) out.link_scale[link.text()] = scale.number();
  }
}

/* A row of the matrix, as AllowedCollisionEntry prints it, or as a list. */
std::vector<YamlValue> readMatrixRow(const YamlValue &row) {
  if (row.isMap()) row.refuseOthers({"enabled"});
  return row.isMap() ? row.itemsOf("enabled") : row.items();
}

/* The entries of the matrix, each once, with both of its values. Two that contradict each other are an error: neither
 * of them can be meant. `second` empty: the default of the first. */
class AllowedEntries {
 public:
  void add(const YamlValue &first, const std::string &second, const YamlValue &value) {
    const std::string name = first.text();
    if (name.empty()) first.fail("must be a name");
    const bool allowed = value.truth(), turned = !second.empty() && second < name;
    const auto [it, is_new] = entries_.emplace(turned ? Names(second, name) : Names(name, second), allowed);
    if (is_new || it->second == allowed) return;
    value.fail("contradicts an earlier entry of '" + name + (second.empty() ? "'" : "' and '" + second + "'"));
  }

  std::vector<AllowedPair> pairs() const {
    std::vector<AllowedPair> out;
    for (const auto &[names, allowed] : entries_) out.push_back({names.first, names.second, allowed});
    return out;
  }

 private:
  using Names = std::pair<std::string, std::string>;
  std::map<Names, bool> entries_;
};

/* What the matrix says of every pair of entry_names counts, `false` too: it wins over the defaults. */
void readEntries(const YamlValue &matrix, AllowedEntries &entries) {
  const std::vector<YamlValue> names = matrix.itemsOf("entry_names"), rows = matrix.itemsOf("entry_values");
  if (names.size() != rows.size()) {
    matrix.fail("has " + std::to_string(names.size()) + " entry_names and " + std::to_string(rows.size()) +
                " entry_values");
  }
  for (const YamlValue &name : names) {
    if (name.text().empty()) name.fail("must be a name");
  }
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const std::vector<YamlValue> row = readMatrixRow(rows[i]);
    if (row.size() != names.size()) rows[i].fail("must have an entry for each of the entry_names");
    for (std::size_t j = 0; j < row.size(); ++j) {
      if (j != i) entries.add(names[i], names[j].text(), row[j]);
    }
  }
}

void readAllowed(const YamlValue &root, SceneFile &out, Warnings &warnings) {
  const std::optional<YamlValue> matrix = root.find("allowed_collision_matrix");
  if (!matrix) return;
  matrix->warnOfOthers({"entry_names", "entry_values", "default_entry_names", "default_entry_values"}, warnings);

  AllowedEntries entries;
  readEntries(*matrix, entries);
  const std::vector<YamlValue> defaults = matrix->itemsOf("default_entry_names");
  const std::vector<YamlValue> values = matrix->itemsOf("default_entry_values");
  if (defaults.size() != values.size()) matrix->fail("has default_entry_names and _values of different number");
  for (std::size_t i = 0; i < defaults.size(); ++i) entries.add(defaults[i], "", values[i]);
  out.allowed = entries.pairs();
}

/* Further robots, each along its trajectory. */
void readMovingRobots(const YamlValue &root, const std::string &folder, SceneFile &out, Warnings &warnings) {
  const auto fileOf = [&](const YamlValue &value) {
    return (std::filesystem::path(folder) / value.text()).lexically_normal().string();
  };
  for (const YamlValue &plain : root.itemsOf("moving_robots")) {
    MovingRobotFile robot;
    robot.name = plain.at("name").text();
    const YamlValue value = plain.named(robot.name);
    value.warnOfOthers({"name", "robot", "srdf", "base", "trajectory", "start", "start_tolerance", "any_time"},
                       warnings);
    robot.urdf = fileOf(value.at("robot"));
    if (const auto srdf = value.find("srdf")) robot.srdf = fileOf(*srdf);
    if (const auto base = value.find("base")) robot.base = toIsometry(base->pose(warnings));
    robot.trajectory = readTrajectoryValue(value.at("trajectory"), folder, warnings);
    if (const auto start = value.find("start")) robot.start = readTime(*start);
    robot.tolerance = readStartTolerance(value);
    out.moving_robots.push_back(std::move(robot));
  }
}

constexpr std::initializer_list<const char *> kSceneKeys = {"name",
                                                            "robot_model_name",
                                                            "robot_state",
                                                            "fixed_frame_transforms",
                                                            "allowed_collision_matrix",
                                                            "link_padding",
                                                            "link_scale",
                                                            "object_colors",
                                                            "world",
                                                            "is_diff",
                                                            "robot",
                                                            "scene",
                                                            "moving_robots"};

/* Objects that stand elsewhere than in a scene's world would be left out. */
void requireScene(const YamlValue &root) {
  const std::string cure = ": objects stand under world: collision_objects";
  if (root.find("collision_objects")) root.fail("collision_objects stand at its top" + cure);
  const bool is_object = root.find("primitives") || root.find("meshes") || root.find("planes") || root.find("bodies");
  if (is_object) root.fail("is a collision object, not a scene" + cure);
  if (std::none_of(kSceneKeys.begin(), kSceneKeys.end(), [&](const char *key) { return root.has(key); }))
    root.fail("has none of the keys of a scene" + cure);
}

} // namespace

ObjectDescription readPlacedShapes(const YamlValue &value, Warnings &warnings) {
  ObjectDescription object;
  object.frame = readFrame(value, warnings);
  if (const auto pose = value.find("pose")) object.pose = toIsometry(pose->pose(warnings));
  if (const auto padding = value.find("padding")) object.padding = padding->number();
  readShapes(value, "primitives", "primitive_poses", readPrimitive, object, warnings);
  readShapes(value, "meshes", "mesh_poses", readMeshEntry, object, warnings);
  readShapes(value, "planes", "plane_poses", readPlane, object, warnings);
  readShapes(value, "bodies", "body_poses", readBodyEntry, object, warnings);
  return object;
}

SceneFile readScene(const std::string &path, Warnings &told) {
  const YamlValue root = isSceneText(path) ? loadSceneText(path) : loadYaml(path);
  SceneFile out;
  Warnings warnings;
  try {
    if (root.isEmpty()) root.fail("is empty: that is no scene");

    requireScene(root);
    root.warnOfOthers(kSceneKeys, warnings);
    if (const auto world = root.find("world")) readWorld(*world, out, warnings);
    if (const auto name = root.find("name")) name->text(); // not what belongs elsewhere
    if (const auto robot = root.find("robot_model_name")) out.robot = robot->text();
    if (const auto diff = root.find("is_diff")) out.is_diff = diff->truth();
    readTransforms(root, out, warnings);
    readRobotState(root, out, warnings);
    readLinkSizes(root, out, warnings);
    readAllowed(root, out, warnings);
    readMovingRobots(root, folderOf(path), out, warnings);
    for (Operation &operation : out.operations) readClouds(operation.object, folderOf(path));
    for (Attachment &attachment : out.attached) readClouds(attachment.object, folderOf(path));
  } catch (const BadInput &e) {
    throw BadUsage(path + ": " + e.what());
  } catch (const Error &e) {
    throw BadUsage(path + ": " + e.what());
  } catch (const YAML::Exception &e) {
    throw BadUsage(path + ": " + e.what());
  }
  out.coverage = warnings.coverage();
  told.add(warnings);
  return out;
}

} // namespace curve_proximity::yaml
