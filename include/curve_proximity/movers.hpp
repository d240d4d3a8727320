/* SPDX-License-Identifier: BSD-3-Clause */
/** Robots and objects that move at the same time: against each other, and against the objects that stand. */
#ifndef CURVE_PROXIMITY_MOVERS_HPP
#define CURVE_PROXIMITY_MOVERS_HPP

#include <array>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include <curve_proximity/motion.hpp>

namespace curve_proximity {

/** An object that moves. */
struct MovingObject {
  ObjectDescription object;         /**< its id names it; its frame and pose are not used: `poses` has them */
  std::vector<TimedPose> poses;     /**< in the fixed frame; at least one; one: it stands there */
  Turning turning = Turning::SLERP; /**< between two poses */
  double start = 0.0;               /**< [s] is added to all times */
  /** [s] The start is only known to within this, before or after; infinity: anywhere on its way at any time. */
  double tolerance = 0.0;

  /** What Snapshot::moving() has made of object, poses and turning; null: it is made of them. */
  std::shared_ptr<const MovingBody> body;
};

/** The objects of a snapshot that move. origin: [ns] the moment that is time 0, on the clock of stamps. */
std::vector<MovingObject> movingObjects(const Snapshot &snapshot, std::int64_t origin = 0);

/** What a link carries, to move by itself: the attached object of that id, with its pose in the link's frame, its scale
 *  and its padding. poses: those of the link. Throws Error where no link carries such an object, and as Movers does. */
MovingObject carriedObject(const Snapshot &snapshot, const std::string &id, std::vector<TimedPose> poses,
                           Turning turning = Turning::SLERP);

/** A robot that moves. */
struct MovingRobot {
  std::string name;                          /**< names it in answers: its link L is "name/L" */
  std::shared_ptr<const RobotMotion> motion; /**< its trajectory, base and SRDF */
  double start = 0.0;                        /**< [s] is added to all times */
  /** [s] The start is only known to within this, before or after; infinity: anywhere on its way at any time. */
  double tolerance = 0.0;
};

/** What movers are tested against. */
enum class Against {
  OBJECTS, /**< the objects that stand */
  MOVERS,  /**< each other; and each robot against itself, as askSelf() does */
  BOTH,    /**< all of these at once */
  OTHERS   /**< all of these at once, but no robot against itself */
};

/** Robots and objects on one clock. It begins with the first of them and ends with the last one; a mover that has not
 *  begun stands at its first pose, one that has ended at its last one. Where starts are only known to a tolerance,
 *  answers hold for all that are possible: the clock begins with the earliest and ends with the latest one, and a time
 *  in an answer is the earliest at which that can be. Immutable; shared by any number of threads. */
class Movers {
 public:
  /** snapshot   the objects that stand, and allowed pairs; its robot does not count. Of a robot's own snapshot only the
   *             robot, what it carries, paddings and allowed pairs count.
   *  objects    those of movingObjects() among them.
   *  allowed    pairs of names that may touch: movers, links of moving robots ("name/link"), objects.
   *  resources  for shapes of moving objects that come from files.
   *  stop       asked now and then while all are being joined: true ends that, by an Error.
   *
   *  Throws Error: no mover; names that are empty, contain '/' or clash with another mover or an object that stands; an
   *  object that moves in the snapshot and is not among `objects`; a moving object without shapes or poses; what
   *  makeGeometry() refuses, and halfspaces; times that do not ascend; orientations that are half a turn apart; clocks
   *  that leave a pause in which nothing moves. The message names the mover. */
  Movers(SnapshotPtr snapshot, const std::vector<MovingRobot> &robots, const std::vector<MovingObject> &objects,
         const std::vector<std::array<std::string, 2>> &allowed = {}, const ResourceOptions &resources = {},
         const Stop &stop = nullptr);
  ~Movers();
  /** Moves. */
  Movers(Movers &&) noexcept;
  /** Moves. */
  Movers &operator=(Movers &&) noexcept;

  /** The first start and the last end [s]. */
  std::array<double, 2> domain() const;

  /** Where a moving object's frame is at the time t [s] of the clock, if it starts on time. Throws Error for a name
   * that is none. */
  Eigen::Isometry3d objectPose(const std::string &name, double t) const;

  struct Data;
  /** Internal. */
  const Data &data() const {
    return *data_;
  }

 private:
  std::unique_ptr<const Data> data_;
};

/** What is asked about among movers: pairs of all of them, or one of the robots. */
struct Whom {
  Against against = Against::OTHERS;  /**< without a robot */
  const MovingRobot *robot = nullptr; /**< one of the movers, at the times of its own motion (one that stands: at all
                                           times), against all that stands and all others that move */

  /** Pairs of all. */
  Whom(Against pairs) : against(pairs) {}
  /** Of one robot, which is referred to. */
  Whom(const MovingRobot &one) : robot(&one) {}
};

/** How close movers come. kind is "environment" where b is an object that stands, else "movers"; a and b are names of
 *  moving objects or links ("name/link"), result.t is the time [s]. query.links: only pairs with one of these movers
 *  ("name") or links ("name/link"), and a is one of these; an object of one pose is measured against objects that stand
 *  only if it is named. query.objects: only pairs with one of these objects, that
 * stand or move, or robots. query.options.interval: only these times. Queries take no per_object and no
 *  signed_distance: such a query is refused, with status "invalid".
 *  Of one of the robots: kind is "environment", a is its link or carried object by its own name. query.links: only
 *  these of its own. */
Answer ask(const Movers &movers, const Whom &whom, const Query &query, Workspace &workspace);

/** Throws Error where a mover has ended before the robot `subject` begins, or begins after that has ended: by how much.
 *  A robot or object that stands is never late. */
void checkClocks(const MovingRobot &subject, const std::vector<MovingRobot> &robots,
                 const std::vector<MovingObject> &objects);

/** The time of contact: result.t_contact_lower [s] is never after the first contact; of objects that robots carry their
 *  poses count as rounded. Verdict violated: contact at result.t, within the rounding of poses. The query is of type
 *  COLLISION. Everything else as for ask(). */
Answer timeOfContact(const Movers &movers, const Whom &whom, const Query &query, Workspace &workspace);

/** The clearance between each two of breaks [s], ascending and within domain(): as clearanceProfile() of motion.hpp.
 * Throws Error for what ask() refuses, for an interval and for another query than DISTANCE. */
std::vector<ClearanceInterval> clearanceProfile(const Movers &movers, const Whom &whom,
                                                const std::vector<double> &breaks, const Query &query,
                                                Workspace &workspace,
                                                double horizon = std::numeric_limits<double>::infinity());

/** The pairs that come closest, nearest first; each answer is that to DISTANCE for its pair alone. Throws Error for
 * what ask() refuses, and for another query than DISTANCE. */
std::vector<Answer> nearestPairs(const Movers &movers, const Whom &whom, const PairLimits &limits, const Query &query,
                                 Workspace &workspace);

/** The least distance of one of the robots, as ask() of one of them tells it, and its derivatives by what that robot's
 *  trajectory was made of: positions, velocities, accelerations and joints, the duration with the start kept, and the
 *  start (cprox_robot_distance_gradient()), by steps of its base and of an object that stands or moves; 0 for a link of
 *  another robot. What else moves goes on as it does. duration and start are NaN where the minimiser is at a kink of
 * the robot and of another mover. Throws Error for what ask() refuses, for another query than DISTANCE, for starts with
 * a tolerance, and for a robot that is none of these. */
ClearanceRow clearanceGradient(const Movers &movers, const MovingRobot &robot, const Query &query,
                               Workspace &workspace);

/** The derivatives of a clearance by one of the movers. */
struct MoverGradient {
  std::string name; /**< of the robot or object that moves */
  /** Of a robot what its own clearanceGradient() tells of this pair; all numbers are 0 where neither side belongs to
   * the robot, and steps of its base are where both do. Of an object its duration and start, and by a step of all of
   * its poses object_linear and object_angular; no rows. */
  ClearanceGradient gradient;
};

/** A clearance among movers with its derivatives by all of them. */
struct MoversClearance {
  Answer answer;                        /**< names, interval, witness points, result.t as of ask() */
  std::vector<MoverGradient> gradients; /**< of the robots, then of the objects, in the order of the constructor's */
};

/** The least distance of all that moves, as ask() tells it, and its derivatives by each robot's trajectory and each
 *  object's clock, by one search: for a planner that changes several motions at once. Shapes and units are those of
 *  ClearanceGradient; valid, reason, t and margin are the same in all of them. duration and start are NaN for both
 *  sides where the minimiser is at a kink of both. Throws Error for what ask() refuses, for another query than
 *  DISTANCE and for starts with a tolerance. Cost: one search, as clearanceGradient(), however many move. */
MoversClearance clearanceGradients(const Movers &movers, Against against, const Query &query, Workspace &workspace);

/** All intervals of time [s] in which movers are within query.delta of something: as violations() of query.hpp. Throws
 *  Error for what ask() refuses. */
Violations violations(const Movers &movers, const Whom &whom, double resolution, const Query &query,
                      Workspace &workspace);

/** The query as the checker of certificates reads it, but for its head (doc/certificates.md); empty where there is
 *  nothing to measure, or where a body or a motion is of a kind that has no certificates. Throws Error for a name that
 *  is none. */
std::string describeQuery(const Movers &movers, const Whom &whom, const Query &query);

} // namespace curve_proximity
#endif
