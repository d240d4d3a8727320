/* SPDX-License-Identifier: BSD-3-Clause */
/** What robots, movers and roadmaps share: scenes, queries, answers as Python's. */
#ifndef CURVE_PROXIMITY_PYTHON_ROBOTS_H
#define CURVE_PROXIMITY_PYTHON_ROBOTS_H

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <curve_proximity/motion.hpp>
#include <curve_proximity/srdf.hpp>

#include "obstacles.h"

namespace curve_proximity::python {

using Packages = std::map<std::string, std::string>;

/** Of files beside `path`, with the folders of packages. */
ResourceOptions resourcesOf(const std::string &path, const Packages &packages);

/** As Python's warnings, which may be errors. */
void warn(const std::string &path, const std::vector<std::string> &messages);

/** A robot with what its SRDF says. */
struct LoadedRobot {
  std::shared_ptr<const Robot> robot;
  Srdf srdf;
  py::object made = py::none(); /* of which texts, for pickle */
};

/** A scene whose changes throw. */
class PythonScene {
 public:
  PythonScene(std::shared_ptr<LoadedRobot> robot, const Packages &packages)
      : robot_(std::move(robot)),
        resources_(resourcesOf("", packages)),
        scene_(robot_ ? robot_->robot : nullptr, resources_,
               robot_ ? allowedPairs(robot_->srdf) : std::vector<AllowedPair>{}) {}

  void change(const SceneChange &change) {
    std::vector<std::string> wrong;
    {
      const py::gil_scoped_release release;
      wrong = scene_.apply(change);
    }
    if (!wrong.empty()) throw Error(wrong.front());
  }

  void load(const std::string &path);

  void add(const std::string &id, const std::string &type, const std::vector<double> &dimensions,
           const std::optional<Array> &pose, double padding, const std::optional<Array> &vertices,
           const py::object &triangles, const std::string &resource, bool solid);

  void operate(Operation::Kind kind, const std::string &id, const Eigen::Isometry3d &pose) {
    Operation operation;
    operation.kind = kind, operation.object.id = id, operation.object.pose = pose;
    SceneChange change;
    change.operations.push_back(std::move(operation));
    this->change(change);
  }

  void allow(const std::string &a, const std::string &b, bool allowed) {
    SceneChange change;
    change.allowed.push_back({a, b, allowed});
    this->change(change);
  }

  /** What stands in the scene, without the robot and what it carries. Throws Error where that is not all. */
  std::shared_ptr<ObstacleSet> obstacles(const std::string &index) const;

  SnapshotPtr snapshot() const {
    return scene_.snapshot();
  }
  const LoadedRobot *robot() const {
    return robot_.get();
  }
  /** Where the scene's files put the robot's root link. */
  const Eigen::Isometry3d &base() const {
    return base_;
  }
  /** Where joints stand that a motion does not move: as the scene's files say, or better, as the caller does. */
  JointPositions rest(const JointPositions &given) const {
    JointPositions out = joints_;
    for (const auto &[joint, value] : given) out[joint] = value;
    return out;
  }

 private:
  /* Warns of what was done to read the object's mesh files that their user may not expect. */
  void tellMeshes(const std::string &where, const ObjectDescription &object) const;

  std::shared_ptr<LoadedRobot> robot_;
  ResourceOptions resources_;
  Scene scene_;
  JointPositions joints_;
  Eigen::Isometry3d base_ = Eigen::Isometry3d::Identity();
};

using Names = std::vector<std::string>;

/** Of work, where the caller names none. */
inline constexpr std::uint32_t DEFAULT_BUDGET = 500000;

/** type: "distance", "tolerance" or "collision". Throws Error for another. */
Query queryOf(const std::string &type, double delta, double epsilon, std::uint32_t max_nodes, const Names &links = {},
              const Names &objects = {}, bool allow_empty = false, bool moving_only = false);

/** Throws Error for an answer that is a refusal. asked: a verdict was. */
py::dict answerOf(const Answer &answer, bool asked = false);

/** The answer to the query with its proof, and the text of the query as cprox_check reads it, which `ask` writes. `ask`
 *  runs without the GIL. Throws Error where there is no proof. */
py::dict provenAnswer(Query &query, const std::function<Answer(std::string &text)> &ask);

/** The answer with its derivatives. */
py::dict toDict(const ClearanceRow &row);

/** Adds valid, reason and t. */
void addValidity(const ClearanceGradient &gradient, py::dict &out);

/** Adds the numbers. */
void addDerivatives(const ClearanceGradient &gradient, py::dict &out);

/** A clearance profile as columns. */
py::dict toDict(const std::vector<ClearanceInterval> &intervals);

/** Throws where the budget ended. */
py::list toList(const Violations &found);

/** Answers one by one. */
py::list toList(const std::vector<Answer> &answers);

using SceneClass = py::class_<PythonScene, std::shared_ptr<PythonScene>>;

/** Its methods that ask about curves. */
void addCurveQueries(SceneClass &scene);

using MotionClass = py::class_<RobotMotion, std::shared_ptr<RobotMotion>>;

/** Its methods about errors, persons, objects that may be moved, and what it passes through. */
void addRobust(py::module &module, MotionClass &motion);

using RobotClass = py::class_<LoadedRobot, std::shared_ptr<LoadedRobot>>;

/** Its method about links that can touch. */
void addMatrix(RobotClass &robot);

} // namespace curve_proximity::python
#endif
