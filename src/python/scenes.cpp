/* SPDX-License-Identifier: BSD-3-Clause */
/* Robots and scenes. */
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>

#include <curve_proximity/files.hpp>
#include <curve_proximity/mesh_remarks.hpp>

#include "robots.h"

namespace curve_proximity::python {

void warn(const std::string &path, const std::vector<std::string> &messages) {
  for (const std::string &message : messages) {
    if (PyErr_WarnEx(PyExc_UserWarning, (path + ": " + message).c_str(), 1) != 0) throw py::error_already_set();
  }
}

ResourceOptions resourcesOf(const std::string &path, const Packages &packages) {
  ResourceOptions out;
  const std::size_t slash = path.rfind('/');
  out.base_dir = slash == std::string::npos ? "." : path.substr(0, slash + 1);
  out.find_package = [packages](const std::string &name) {
    const auto found = packages.find(name);
    return found == packages.end() ? std::string() : found->second;
  };
  return out;
}

void PythonScene::load(const std::string &path) {
  SceneFileContents contents;
  {
    const py::gil_scoped_release release;
    contents = robot_ ? loadSceneFile(path, robot_->robot.get(), robot_->srdf) : loadSceneFile(path);
  }
  if (!contents.moving_robots.empty())
    throw Error(path + ": moving robot '" + contents.moving_robots.front().name +
                "': further robots are made as Motions, and joined by Movers");
  warn(path, contents.warnings);
  change(contents.change);
  for (const Operation &operation : contents.change.operations) tellMeshes(path, operation.object);
  for (const Attachment &attachment : contents.change.attachments) tellMeshes(path, attachment.object);
  for (const auto &[joint, value] : contents.joints) joints_[joint] = value;
  if (contents.change.clear || !contents.base.matrix().isIdentity(0.0)) base_ = contents.base;
}

void PythonScene::add(const std::string &id, const std::string &type, const std::vector<double> &dimensions,
                      const std::optional<Array> &pose, double padding, const std::optional<Array> &vertices,
                      const py::object &triangles, const std::string &resource, bool solid) {
  const std::optional<ShapeType> known = shapeTypeFromName(type);
  if (!known) throw Error("object '" + id + "': there is no shape '" + type + "'");
  ShapeDescription shape;
  shape.type = *known, shape.dimensions = dimensions, shape.resource = resource, shape.solid = solid;
  if (vertices) {
    const Points points(*vertices, "vertices");
    shape.vertices = Eigen::Map<const Eigen::Matrix3Xd>(vertices->data(), 3, static_cast<Eigen::Index>(points.size));
  }
  if (!triangles.is_none()) {
    const Whole indices = toWhole(triangles, "triangles", 0, std::numeric_limits<int>::max());
    if (indices.ndim() != 2 || indices.shape(1) != 3) throw Error("triangles must be an array of shape (m, 3)");
    shape.triangles =
        Eigen::Map<const Eigen::Matrix<std::int64_t, 3, Eigen::Dynamic>>(indices.data(), 3, indices.shape(0))
            .cast<int>();
  }
  Operation add;
  add.object.id = id, add.object.pose = toTransform(pose), add.object.padding = padding;
  add.object.shapes.push_back(std::move(shape));
  SceneChange change;
  change.operations.push_back(std::move(add));
  this->change(change);
  tellMeshes("object '" + id + "'", change.operations.front().object);
}

void PythonScene::tellMeshes(const std::string &where, const ObjectDescription &object) const {
  std::vector<std::string> remarks;
  {
    const py::gil_scoped_release release;
    remarks = meshRemarks(object, resources_);
  }
  warn(where, remarks);
}

std::shared_ptr<ObstacleSet> PythonScene::obstacles(const std::string &index) const {
  const SnapshotPtr now = snapshot();
  if (!now->coverage().complete()) throw Error("obstacles() is not all of the scene: " + now->coverage().message());
  if (!now->moving().empty())
    throw Error("obstacles() is not all of the scene: object '" + now->moving().begin()->first + "' moves");
  if (!now->attached().empty())
    throw Error("obstacles() is not all of the scene: the robot carries '" + now->attached().begin()->first + "'");
  std::vector<std::shared_ptr<Obstacle>> list;
  std::vector<std::string> names;
  for (const auto &[id, object] : now->objects()) {
    for (const ObjectShape &shape : object->shapes) {
      if (!shape.geometry.body && !shape.placed.obstacle.curve) continue; // an empty octree
      auto one = std::make_shared<Obstacle>();
      one->owner = now, one->obstacle = shape.placed.obstacle;
      one->obstacle.margin += shape.placed.rounding;
      list.push_back(std::move(one));
      names.push_back(id);
    }
  }
  if (list.empty()) throw Error("the scene has no object");
  return std::make_shared<ObstacleSet>(std::move(list), index, std::move(names));
}

namespace {

std::string readText(const std::string &path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  if (!in) throw Error(path + ": the file cannot be read");
  return text.str();
}

/* A robot of texts; path: the file of the URDF, beside which its meshes are. */
std::shared_ptr<LoadedRobot> robotOf(const std::string &path, const std::string &urdf, const std::string &srdf_path,
                                     const std::optional<std::string> &srdf, const Packages &packages) {
  auto out = std::make_shared<LoadedRobot>();
  RobotOptions options;
  options.resources = resourcesOf(path, packages);
  const auto read = [](const std::string &file, const std::string &text, const auto &parse) {
    try {
      return parse(text);
    } catch (const Error &e) {
      throw Error(file + ": " + e.what(), e.status());
    }
  };
  {
    const py::gil_scoped_release release;
    out->robot = read(path, urdf, [&](const std::string &text) { return Robot::fromUrdf(text, options); });
    if (srdf) out->srdf = read(srdf_path, *srdf, [](const std::string &text) { return parseSrdf(text); });
  }
  out->made =
      py::make_tuple("Robot._from_text", std::filesystem::absolute(path).string(), urdf, srdf_path, srdf, packages);
  return out;
}

std::shared_ptr<LoadedRobot> load(const std::string &urdf, const std::optional<std::string> &srdf,
                                  const Packages &packages) {
  const std::string text = readText(urdf);
  std::optional<std::string> rules;
  if (srdf) rules = readText(*srdf);
  const std::shared_ptr<LoadedRobot> out = robotOf(urdf, text, srdf.value_or(""), rules, packages);
  warn(urdf, out->robot->warnings());
  return out;
}

/* The limits of each variable; infinite where the URDF has none. */
py::dict limitsOf(const LoadedRobot &loaded) {
  constexpr double INF = std::numeric_limits<double>::infinity();
  py::dict out;
  for (const std::string &name : loaded.robot->variables()) out[py::str(name)] = py::make_tuple(-INF, INF);
  for (const Robot::Joint &joint : loaded.robot->joints())
    if (out.contains(joint.name)) out[py::str(joint.name)] = py::make_tuple(joint.lower, joint.upper);
  return out;
}

} // namespace

void addScenes(py::module &module) {
  RobotClass robot(module, "Robot", "A robot from its URDF. Immutable.");
  addMatrix(robot);
  robot
      .def_static("from_urdf", &load, py::arg("urdf"), py::arg("srdf") = py::none(), py::arg("packages") = Packages{},
                  "Reads the file of a URDF, and of an SRDF. packages: the folder of each package:// in them.")
      .def_property_readonly("name", [](const LoadedRobot &r) { return r.robot->name(); })
      .def_property_readonly(
          "variables", [](const LoadedRobot &r) { return r.robot->variables(); }, "The names of all joints that move.")
      .def_property_readonly("limits", &limitsOf,
                             "The limits (lower, upper) [rad or m] of each of variables, by name, as the URDF says; "
                             "infinite where it has none.\nQueries do not enforce them.")
      .def_static("_from_text", &robotOf)
      .def("__reduce__", [](const LoadedRobot &r) { return remake(r.made, "this Robot cannot be pickled"); })
      .def(
          "link_poses",
          [](const LoadedRobot &r, const JointPositions &positions) {
            py::dict out;
            for (const auto &[link, pose] : r.robot->linkPoses(positions)) out[py::str(link)] = fromTransform(pose);
            return out;
          },
          py::arg("positions"), "Forward kinematics: the pose (4, 4) of each link for joint values by name.");

  SceneClass scene(module, "Scene", "Objects by name, and a robot.");
  addCurveQueries(scene);
  scene
      .def(py::init<std::shared_ptr<LoadedRobot>, const Packages &>(), py::arg("robot") = nullptr,
           py::arg("packages") = Packages{})
      .def(
          "load", &PythonScene::load, py::arg("path"),
          "Takes over a scene file (YAML), which replaces the scene unless it is a diff. Where its robot_state has the "
          "joints,\n"
          "they stand in motions that are made later and do not say better. What is ignored is a UserWarning.")
      .def("add", &PythonScene::add, py::arg("id"), py::arg("type"), py::arg("dimensions") = std::vector<double>{},
           py::arg("pose") = py::none(), py::arg("padding") = 0.0, py::arg("vertices") = py::none(),
           py::arg("triangles") = py::none(), py::arg("resource") = "", py::arg("solid") = false,
           "Adds or replaces an object: type 'box', dimensions [x, y, z] and so on, as in a scene file.")
      .def(
          "move",
          [](PythonScene &s, const std::string &id, const Array &pose) {
            s.operate(Operation::Kind::MOVE, id, toTransform(pose));
          },
          py::arg("id"), py::arg("pose"))
      .def(
          "remove",
          [](PythonScene &s, const std::string &id) {
            s.operate(Operation::Kind::REMOVE, id, Eigen::Isometry3d::Identity());
          },
          py::arg("id"))
      .def("allow", &PythonScene::allow, py::arg("a"), py::arg("b"), py::arg("allowed") = true,
           "Sets an entry of the allowed collision matrix; b '': the default of a.")
      .def_property_readonly("objects",
                             [](const PythonScene &s) {
                               py::list out;
                               const SnapshotPtr snapshot = s.snapshot();
                               for (const auto &[id, object] : snapshot->objects()) out.append(id);
                               return out;
                             })
      .def("obstacles", &PythonScene::obstacles, py::arg("index") = "bvh",
           "What stands in the scene as Obstacles for the functions of this module, as it is now: an obstacle a shape; "
           "names says\nof which object. The robot is not among them. margin: the padding, and the rounding of poses. "
           "ValueError where the scene\nhas no object, or more than that: objects that move or that the robot carries, "
           "geometry that a file had and that\nis not used.");
  refusePickle(scene, "a Scene cannot be pickled: load it again in the other process");
}

} // namespace curve_proximity::python
