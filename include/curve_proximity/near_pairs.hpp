/* SPDX-License-Identifier: BSD-3-Clause */
/** Contacts and distances, pair by pair, of a robot that stands at one state: given by the poses of its links and by
 *  what they carry, so that one scene serves for all states. RobotMotion answers for states by joint values. */
#ifndef CURVE_PROXIMITY_NEAR_PAIRS_HPP
#define CURVE_PROXIMITY_NEAR_PAIRS_HPP

#include <functional>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include <curve_proximity/motion.hpp>

namespace curve_proximity {

/** Where the links stand, and what they carry. */
struct RobotPlacement {
  std::vector<Eigen::Isometry3d> links; /**< in the fixed frame, one a link in the order of Robot::links() */
  AttachedObjects attached;             /**< all attached objects; those of the snapshot are not read */
};

/** Whose a body is. */
enum class BodyOwner { LINK, ATTACHED, OBJECT };

/** One side of a pair. */
struct PairSide {
  const std::string *name = nullptr; /**< of the link, the attached object or the object */
  BodyOwner owner = BodyOwner::LINK; /**< which of these it is */
  int part = 0;                      /**< the number of the shape in its owner */
};

/** Two bodies that are near each other. */
struct NearPair {
  PairSide a; /**< of the robot */
  PairSide b; /**< of the robot or the scene */

  /** The signed distance, as pair() of core.hpp. verdict: violated where a common point is proven, clear where
   *  lower > 0, else undecided. Between surfaces that touch depth and normal are those of their convex hulls
   *  (CPROX_OVERLAP: the depth of the surfaces is not known, lower only bounds the depth of the hulls). */
  cprox_result result;
};

/** Which pairs are visited. */
struct NearPairsQuery {
  RobotPairs pairs = RobotPairs::WHOLE; /**< of the robot and the objects, of the robot with itself, or both */
  double reach = 0.0;                   /**< [m] >= 0: pairs that are farther are not visited; infinity: all are */

  /** Only pairs of which a side is one of these links, or is carried by one. Empty: all. */
  std::set<std::string> links;

  /** May the two touch? Asked of pairs within reach only; those that may are not visited. Null: Snapshot::mayTouch() of
   *  the snapshot. Beside this rule never visited are: two shapes of one link or of one attached object; an attached
   *  object with its touch_links, with what the same link carries, and with its link. */
  std::function<bool(const std::string &a, const std::string &b)> may_touch;
  bool carriers =
      false; /**< an attached object is visited with its link, too, unless that is a touch link: MoveIt's rule */

  /** Only whether two bodies touch is asked: an interval may be as wide as it likes where it does not contain 0. */
  bool verdicts_only = false;
  cprox_options options = CPROX_OPTIONS_DEFAULT; /**< epsilon, budget and stop function of each pair */
};

/** Is told of a pair, and returns the reach [m] for those that follow; below 0 it ends the visit. */
using NearPairVisitor = std::function<double(const NearPair &pair)>;

/** The robot of a snapshot, made ready for many states. Immutable; shared by any number of threads. */
class StandingRobot {
 public:
  /** Throws Error if the snapshot has no robot. Scales, paddings and objects are the snapshot's. */
  explicit StandingRobot(SnapshotPtr snapshot);

  /** The snapshot that it was made of. */
  const SnapshotPtr &snapshot() const {
    return snapshot_;
  }

  /** Visits the pairs of collision elements in the order in which their boxes come near each other. Meshes are
   *  surfaces, solid or not. Each pair is measured once. Throws Error for a placement with another number of links
   *  than the robot's, poses that are none, an attached object of an unknown link, a scene in which objects move, and
   *  where the core refuses a pair.
   *  Cost: a search in the scene's BVH a body, and a pair() for each pair within reach. */
  void visit(const RobotPlacement &placement, const NearPairsQuery &query, Workspace &workspace,
             const NearPairVisitor &visitor) const;

 private:
  struct Elements;

  SnapshotPtr snapshot_;
  std::shared_ptr<const Elements> elements_; /* of the links */
};

} // namespace curve_proximity
#endif
