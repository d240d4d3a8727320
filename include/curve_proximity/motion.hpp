/* SPDX-License-Identifier: BSD-3-Clause */
/** Queries of a robot along a joint trajectory, against the scene and against itself. */
#ifndef CURVE_PROXIMITY_MOTION_HPP
#define CURVE_PROXIMITY_MOTION_HPP

#include <array>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include <curve_proximity/query.hpp>
#include <curve_proximity/trajectory.hpp>

namespace curve_proximity {

/** The robot of a snapshot, made ready for many motions and states: its kinematic tree, and the pairs of links and
 *  objects that are measured. Immutable; shared by any number of threads. A motion of it then costs microseconds. */
class PreparedRobot {
 public:
  /** snapshot, disabled and base are those of RobotMotion; virtual_joints and base_joints are base and base_joints of
   *  TrajectoryDescription. Throws Error: no robot, no collision geometry, a base joint whose child is not the root
   *  link. Cost: once per robot and scene, some hundred microseconds for an arm. */
  explicit PreparedRobot(SnapshotPtr snapshot, const std::vector<std::array<std::string, 2>> &disabled = {},
                         const std::vector<VirtualJoint> &virtual_joints = {},
                         const std::vector<std::string> &base_joints = {},
                         const Eigen::Isometry3d &base = Eigen::Isometry3d::Identity());

  /** The same in another snapshot, with the same arguments: where the snapshots have the same robot, with the same
   *  scales, paddings and attached objects, its kinematics is shared, and only the pairs with objects are new. */
  PreparedRobot(const PreparedRobot &before, SnapshotPtr snapshot);

  /** The snapshot that it was made of. */
  const SnapshotPtr &snapshot() const;

  struct Data;
  /** Internal. */
  const std::shared_ptr<const Data> &data() const {
    return data_;
  }

 private:
  std::shared_ptr<const Data> data_;
};

/** The robot of a snapshot along a trajectory, or at one state. Immutable; shared by any number of threads. */
class RobotMotion {
 public:
  /** A prepared robot along a trajectory, whose base and base_joints are ignored: the prepared robot has its own.
   *  rest, links and errors as below. Cost: microseconds for an edge. */
  RobotMotion(const PreparedRobot &robot, const TrajectoryDescription &trajectory, const JointPositions &rest = {},
              const std::vector<std::string> &links = {});

  /** A prepared robot at one state; joints that `state` does not name are at rest. All of its links count, and
   *  domain() is [0, 1]. id: of the answers. Throws Error for a joint that the robot does not have and a value that is
   *  not finite. */
  RobotMotion(const PreparedRobot &robot, const JointPositions &state, const std::string &id = "",
              const std::vector<std::string> &links = {});

  /** snapshot    is kept: queries use its robot, paddings, objects and allowed pairs.
   *  trajectory  its fixed_joints are ignored: the caller merges them into `rest`.
   *  rest        values of joints that the trajectory does not move; others are at 0, or at mid-range where 0 is
   *              outside their limits. Names that the robot does not have are an error.
   *  base        where the root link, or the parent frame of its virtual joint, stands in the fixed frame.
   *  disabled    pairs of links that are not checked against each other (an SRDF's). Links that the robot does not have
   *              are ignored (see unknownLinks()).
   *  links       only these links, and what they carry, are measured against objects, and against all of the robot.
   *              Empty: all.
   *
   *  A trajectory of one point at time 0 is a robot that stands there: its domain is [0, 1].
   *
   *  Throws Error: no robot, what checkTrajectory() finds, joints that the robot does not have, a trajectory of one
   *  point at a later time, a base joint whose child is not the root link. A mimic joint follows its leader; what a
   *  trajectory says of
   *  it is not looked at. */
  RobotMotion(SnapshotPtr snapshot, const TrajectoryDescription &trajectory, const JointPositions &rest,
              const std::vector<std::array<std::string, 2>> &disabled = {},
              const Eigen::Isometry3d &base = Eigen::Isometry3d::Identity(),
              const std::vector<std::string> &links = {});
  ~RobotMotion();
  /** Moves. */
  RobotMotion(RobotMotion &&) noexcept;
  /** Moves. */
  RobotMotion &operator=(RobotMotion &&) noexcept;

  /** The trajectory's first and last time [s]. */
  std::array<double, 2> domain() const;

  /** The snapshot that it was made of. */
  const SnapshotPtr &snapshot() const;

  /** Is it one state, which has no times of its own? */
  bool stands() const;

  /** Forward kinematics: the poses of all links at the time t [s]. */
  LinkPoses linkPoses(double t) const;

  /** Geometry that is not checked, with the cause, and links whose meshes are not closed: of these the surface alone
   *  counts. One message each. */
  const std::vector<std::string> &skipped() const;

  /** Joints that exceed their limits, one message each. Limits are not enforced; every answer's message repeats this.
   *  */
  const std::vector<std::string> &warnings() const;

  struct Data;
  /** Internal. */
  const Data &data() const {
    return *data_;
  }

 private:
  std::unique_ptr<const Data> data_;
};

/** Queries about a robot in motion: askEnvironment(), askSelf() and the gradients take signed_distance. Meshes that
 *  are apart are measured. Where they overlap, their hulls bound the depth: the status is CPROX_OVERLAP, lower, witness
 *  points and gradient are those of the hulls, upper is 0 or what convex bodies prove, and Answer::by_hull says so.
 *  Points, boxes and meshes without a hull are refused with it. All others refuse signed_distance. askSelf(),
 * nearestPairs(), clearanceProfile() and timeOfContact() take no per_object, none about the robot itself takes
 * query.objects. nearestPairs() and clearanceProfile() take no other query than DISTANCE and no certificate,
 * timeOfContact() none but COLLISION.
 *
 *  query.links restricts all of these queries to pairs of the links or attached objects that it names (of the robot
 *  itself: either of the pair). Here a link does not stand for what it carries: an attached object has a name of its
 *  own. A name that is none of movingNames() is an error.
 *
 *  How close all links and what they carry come to the objects (query.objects: only these; per_object: an
 *  answer for each object, in the order of their names). kind "environment", a the link or the carried object, b the
 *  object, result.t the time [s], result.mover_part the number of the collision element of a. As ask() of query.hpp in
 *  everything else. */
std::vector<Answer> askEnvironment(const RobotMotion &motion, const Query &query, Workspace &workspace);

/** How close the robot comes to itself: pairs of links between which at least two joints can move, and pairs of what a
 *  link carries and any other link, or what that carries, between which one can; whether or not this trajectory moves
 *  them, as in a state; less those that are disabled, touch_links or allowed to touch. kind "self", a and b links or
 *  carried objects; result.obstacle_index is the number of the collision element of b. */
Answer askSelf(const RobotMotion &motion, const Query &query, Workspace &workspace);

/** The time of contact, as timeOfContact() of query.hpp: with the objects, or with `self` of the robot with itself.
 *  result.t and result.t_contact_lower in seconds. */
Answer timeOfContact(const RobotMotion &motion, bool self, const Query &query, Workspace &workspace);

/** The names of the links with geometry, and of the attached objects: what query.links may name. Sorted. */
std::vector<std::string> movingNames(const RobotMotion &motion);

/** Those of them that are asked about: against the objects, or with `self` against the robot; `moving_only` as in
 *  Query. Sorted. */
std::vector<std::string> askedNames(const RobotMotion &motion, bool self, bool moving_only = false);

/** The query as the program cprox_check reads it (doc/certificates.md): where things stand, the robot along its
 *  motion, the pairs that askEnvironment() or with `self` askSelf() asks about; links that are meshes by their convex
 *  hulls. A certificate of these (options.certificate) is about this text. Empty where there is no pair, or a body of
 *  a kind that has no certificates. */
std::string describeQuery(const RobotMotion &motion, bool self, const Query &query);

/** What has no certificates, with its kind: a message each. Where there is any, no answer can be proven. */
std::vector<std::string> unprovable(const RobotMotion &motion, bool self, const Query &query);

/** The pairs that come closest, nearest first: of a link or carried object and an object (query.objects: only
 *  these), or, `self`, of two that belong to the robot. Each answer is that to DISTANCE for its pair alone; pairs are
 *  of single collision elements. */
std::vector<Answer> nearestPairs(const RobotMotion &motion, bool self, const PairLimits &limits, const Query &query,
                                 Workspace &workspace);

/** The swept clearance: the least distance of the robot to the objects (query.objects: only these), or with `self`
 *  to itself, on each interval between two breaks [s], ascending and within domain(); beyond the horizon as of curves.
 *  Throws Error for breaks that are not, and where the core refuses. */
std::vector<ClearanceInterval> clearanceProfile(const RobotMotion &motion, bool self, const std::vector<double> &breaks,
                                                const Query &query, Workspace &workspace,
                                                double horizon = std::numeric_limits<double>::infinity());

/** All intervals of time [s] in which the robot is within query.delta of an object, or with `self` of itself: as
 *  violations() of query.hpp, without signed_distance. */
Violations violations(const RobotMotion &motion, bool self, double resolution, const Query &query,
                      Workspace &workspace);

/* ---- gradients ---- */

/** Which pairs of a robot in motion are measured. */
enum class RobotPairs {
  ENVIRONMENT, /**< links and objects */
  SELF,        /**< links of the robot */
  WHOLE        /**< both */
};

/** The derivatives of a clearance along a motion, at its minimiser t. */
struct ClearanceGradient {
  bool valid = false; /**< the clearance is differentiable here; the numbers are else those of one minimiser, or 0 */
  std::string reason; /**< why valid is false */
  double t = std::numeric_limits<double>::quiet_NaN(); /**< [s] the minimiser; NaN: none was found */

  /** By the positions of the trajectory's points: a row a point, a column a joint of the trajectory [m/rad], [m/m]. 0
   * for joints that follow others. No rows for a state that is no trajectory. */
  Eigen::MatrixXd positions;
  /** By the velocities likewise [m s/rad], [m s/m]; no rows if no point has velocities. 0 where the interpolation does
   *  not use them. */
  Eigen::MatrixXd velocities;
  Eigen::MatrixXd accelerations; /**< by the accelerations, likewise */
  JointPositions joints; /**< by each joint value of the robot at t, or at rest if the trajectory does not name it */
  double duration = 0.0; /**< [m/s] by the duration: all times are stretched alike, the points' numbers are kept */
  double start = 0.0;    /**< [m/s] by the start on the clock, beside others that move (movers.hpp); else 0 */

  Eigen::Vector3d base_linear = Eigen::Vector3d::Zero(); /**< by a shift of the whole robot, fixed frame */
  Eigen::Vector3d base_angular =
      Eigen::Vector3d::Zero(); /**< [m/rad] by its small turn about the fixed frame's origin */
  Eigen::Vector3d object_linear = Eigen::Vector3d::Zero();  /**< by a shift of the nearest object; 0: it is the robot */
  Eigen::Vector3d object_angular = Eigen::Vector3d::Zero(); /**< [m/rad] by its small turn about its own origin */
  double margin = 0.0; /**< by the margin of one side: -1; 0 if there is nothing to measure */
};

/** A clearance along a motion with its gradient. */
struct ClearanceRow {
  /** Names, interval, witness points; result.t in seconds. kind: "environment" or "self", whichever is the nearest. */
  Answer answer;
  ClearanceGradient gradient; /**< at answer.result.t, as far as the search tells it */
  double t0 = 0.0;            /**< [s] the start of the part of the motion that the row is about */
  double t1 = 0.0;            /**< [s] the end of it */
};

/** The least distance of the robot along its motion and its derivatives, by one search
 *  (cprox_robot_distance_gradient()). The guarantees of askEnvironment() and askSelf(). Without anything to measure
 *  valid is false, as with any gap. With signed_distance overlaps have a gradient, too: it leads out.
 *  Takes no other query than DISTANCE, no per_object and no certificate; throws Error for those, and where the core
 *  refuses. Cost: about 1.5 distances. */
ClearanceRow clearanceGradient(const RobotMotion &motion, RobotPairs pairs, const Query &query, Workspace &workspace);

/** The least growth distance of the robot along its motion and its derivatives (cprox_robot_growth()): 1 is contact,
 *  below 1 the two overlap. answer.result.lower and upper are bounds of that, without a unit; its witness points are
 *  where both touch once they are scaled. Meshes have none: with query.options.max_lod of CPROX_LOD_HULL their hulls
 *  answer, which bound no growth distance of the meshes from above. Throws Error as clearanceGradient(), and for links
 *  and objects that are not convex, or have padding. */
ClearanceRow growthGradient(const RobotMotion &motion, RobotPairs pairs, const Query &query, Workspace &workspace);

/** What rows clearanceRows() gives. */
struct RowLimits {
  double horizon = 0.0;       /**< [m] >= 0, finite: rows of what comes within it */
  std::size_t per_pair = 1;   /**< >= 1: at most so many rows a pair of collision elements, the nearest ones */
  std::size_t most = 1000;    /**< >= 1: at most so many rows in all; more is CPROX_BUDGET */
  std::vector<double> breaks; /**< [s] rows are minima between two of these, ascending; empty: the trajectory's times */
};

/** The rows of a clearance constraint. */
struct ClearanceRows {
  std::vector<ClearanceRow> rows; /**< of one pair after those of another; of a pair the nearest first */
  cprox_status status = CPROX_OK; /**< CPROX_BUDGET: rows are left out, or a search ended early */
  std::string message;            /**< why the status is not CPROX_OK, or there is a gap */
  std::optional<Gap> gap;         /**< the rows do not cover all that was given: others may be missing */
};

/** For each pair of collision elements that comes within the horizon: its least distances along the motion, with their
 *  gradients (cprox_robot_rows(), which says what is certified of pairs without a row). Throws Error as
 *  clearanceGradient(). */
ClearanceRows clearanceRows(const RobotMotion &motion, RobotPairs pairs, const RowLimits &limits, const Query &query,
                            Workspace &workspace);

} // namespace curve_proximity
#endif
