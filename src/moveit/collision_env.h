/* SPDX-License-Identifier: BSD-3-Clause */
/* MoveIt's collision environment on the scene library. */
#ifndef CURVE_PROXIMITY_MOVEIT_COLLISION_ENV_H
#define CURVE_PROXIMITY_MOVEIT_COLLISION_ENV_H

#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <vector>

#include <moveit/collision_detection/collision_detector_allocator.h>
#include <moveit/collision_detection/collision_env.h>

#include "moveit_scene.h"

namespace curve_proximity {

/* A state or a trajectory counts as in collision unless it is proven free. So does whatever cannot be answered: an
 * object or a shape that has no counterpart, a motion that is not known. The log says why.
 *
 * Any number of threads may ask at a time; changes of the world and of paddings come in between, as MoveIt's other
 * environments want it. They are applied by the next query. Octrees that are changed in place are compared before each
 * motion(), and by queries about states ten times a second: a hash of 100,000 cells takes as long as many states.
 *
 * A copy shares what it does not change. */
class CollisionEnvCurveProximity : public collision_detection::CollisionEnv {
 public:
  using Matrix = collision_detection::AllowedCollisionMatrix;
  using Request = collision_detection::CollisionRequest;
  using Result = collision_detection::CollisionResult;
  using State = moveit::core::RobotState;

  explicit CollisionEnvCurveProximity(const moveit::core::RobotModelConstPtr &model, double padding = 0.0,
                                      double scale = 1.0);
  CollisionEnvCurveProximity(const moveit::core::RobotModelConstPtr &model, const collision_detection::WorldPtr &world,
                             double padding = 0.0, double scale = 1.0);
  CollisionEnvCurveProximity(const CollisionEnvCurveProximity &other, const collision_detection::WorldPtr &world);
  ~CollisionEnvCurveProximity() override;

  /* Objects that both worlds have stay as they are. */
  void setWorld(const collision_detection::WorldPtr &world) override;

  void checkSelfCollision(const Request &req, Result &res, const State &state) const override;
  void checkSelfCollision(const Request &req, Result &res, const State &state, const Matrix &acm) const override;
  void checkRobotCollision(const Request &req, Result &res, const State &state) const override;
  void checkRobotCollision(const Request &req, Result &res, const State &state, const Matrix &acm) const override;

  /* The straight motion from one state to the other, certified: not sampled. The attached bodies are those of the
   * first state. A contact has the time of contact as its percent_interpolation. */
  void checkRobotCollision(const Request &req, Result &res, const State &state1, const State &state2,
                           const Matrix &acm) const override;
  void checkRobotCollision(const Request &req, Result &res, const State &state1, const State &state2) const override;

  void distanceSelf(const collision_detection::DistanceRequest &req, collision_detection::DistanceResult &res,
                    const State &state) const override;
  void distanceRobot(const collision_detection::DistanceRequest &req, collision_detection::DistanceResult &res,
                     const State &state) const override;

  /* A trajectory among the objects of the world, for queries; `at` gives the joints that the trajectory does not move,
   * and what is attached. Throws Error. */
  RobotMotion motion(const TrajectoryDescription &trajectory, const State &at, const Matrix &acm) const;

  /* A robot made ready for motions of some joints, with what is attached in a state, and the values of its joints
   * there. Its base has joints of its own only where the motions move it: else it stands, as robots do that lanes can
   * ask. */
  struct Ready {
    std::shared_ptr<const PreparedRobot> robot;
    JointPositions rest;
  };

  /* The robot among the objects of the world, for motions of these joints. Throws Error. */
  Ready robot(const State &at, const std::vector<std::string> &joints, const Matrix &acm) const;

 protected:
  void updatedPaddingOrScaling(const std::vector<std::string> &links) override;

 private:
  /* What the last changes have made of the scene, for one query. */
  struct Current {
    SnapshotPtr scene;
    AttachedObjects attached;
    std::string fault; /* what of the world could not be taken over; "": nothing */
  };

  /* A robot made ready for motions, for as long as attached objects, matrix and the place of the base are these. */
  struct Prepared {
    std::vector<AllowedPair> allowed; /* in the order of allowedPairs() */
    bool base_moves;
    Eigen::Isometry3d base; /* of one that stands */
    std::shared_ptr<const PreparedRobot> robot;
  };

  void checkModel(const State &state) const;
  Current current(const State &state, bool sees_octrees) const;
  void applyChanges() const;
  void compareOctrees(bool now) const;
  void changeObject(const std::string &id, bool only_moved, const Snapshot &before, SceneChange &change) const;
  void compareWorld(const collision_detection::World &world);
  void observe();
  RobotPlacement placement(const State &state, AttachedObjects attached) const;
  void check(const Request &req, Result &res, const State &state, const Matrix *acm, RobotPairs pairs) const;
  void checkMotion(const Request &req, Result &res, const State &from, const State &to, const Matrix *acm) const;
  void distances(const collision_detection::DistanceRequest &req, collision_detection::DistanceResult &res,
                 const State &state, RobotPairs pairs) const;
  std::shared_ptr<const StandingRobot> standing(const Current &now) const;
  Ready prepared(const Current &now, const State &at, const std::vector<std::string> &joints, const Matrix *acm) const;
  std::set<std::string> linksOf(const std::string &group) const;

  std::shared_ptr<const Robot> robot_;
  std::vector<const moveit::core::LinkModel *> links_; /* in the order of the robot's */
  std::vector<VirtualJoint> base_;
  collision_detection::World::ObserverHandle observer_;

  const std::shared_ptr<KnownShapes> shapes_; /* shared by all copies */

  mutable std::mutex mutex_; /* of all that follows */
  mutable std::unique_ptr<Scene> scene_;
  mutable std::map<std::string, collision_detection::World::ObjectConstPtr> taken_; /* what the scene was made of */
  mutable std::set<std::string> changed_;              /* objects that the scene does not have as the world has them, */
  mutable std::set<std::string> moved_;                /* and those of which only poses have changed */
  mutable std::map<std::string, std::string> faults_;  /* by object: why the scene does not have it; by "": paddings */
  mutable std::map<std::string, std::uint64_t> cells_; /* cellsOf() the objects with octrees */
  mutable std::chrono::steady_clock::time_point octrees_compared_; /* with cells_ */
  mutable bool resized_ = true;                                    /* paddings or scales have changed */
  mutable std::shared_ptr<const StandingRobot> standing_;
  mutable AttachedBodies bodies_;
  mutable std::vector<Prepared> prepared_; /* of the scene as it is or was, the latest last */
};

/* What MoveIt's planning scene makes such environments with. */
class CollisionDetectorAllocatorCurveProximity
    : public collision_detection::CollisionDetectorAllocatorTemplate<CollisionEnvCurveProximity,
                                                                     CollisionDetectorAllocatorCurveProximity> {
 public:
  const std::string &getName() const override;
};

} // namespace curve_proximity
#endif
