/* SPDX-License-Identifier: BSD-3-Clause */
/** A robot from its URDF: all collision elements of all links as bodies, and where the links are for given joints. */
#ifndef CURVE_PROXIMITY_ROBOT_HPP
#define CURVE_PROXIMITY_ROBOT_HPP

#include <cmath>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <curve_proximity/core.hpp>
#include <curve_proximity/geometry.hpp>

namespace curve_proximity {

/** Joint values by name: radians, or metres for prismatic joints. A planar joint has NAME/x, NAME/y, NAME/theta; a
 *  floating one NAME/trans_x, _y, _z and NAME/rot_x, _y, _z, _w, as in MoveIt. */
using JointPositions = std::map<std::string, double>;

/** The pose of each link's frame in the fixed frame, by link name. */
using LinkPoses = std::map<std::string, Eigen::Isometry3d>;

struct RobotOptions {
  ResourceOptions resources; /**< resources.base_dir: the folder of the URDF (`urdf_dir`) */

  /** Collision elements that are unusable are left out with a warning rather than refused. */
  bool allow_missing_geometry = false;
};

/** One collision element of a link. */
struct LinkGeometry {
  Geometry geometry;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity(); /**< in the link's frame */
  ShapeDescription description;                           /**< what it was made of (its pose included) */
};

/** Immutable once made; shared by any number of threads. */
class Robot {
 public:
  enum class JointType { FIXED, REVOLUTE, PRISMATIC, PLANAR, FLOATING };

  struct Joint {
    std::string name;
    JointType type = JointType::FIXED;
    std::string parent, child;                                /**< links */
    Eigen::Isometry3d origin = Eigen::Isometry3d::Identity(); /**< of the joint's frame in the parent's */
    Eigen::Vector3d axis = Eigen::Vector3d::UnitX();          /**< unit; planar: the plane's normal */
    double lower = -INFINITY, upper = INFINITY;               /**< limits, where the URDF has them */
    double rest = 0.0;                                        /**< the value where none is given */
    std::string leader;                                       /**< of a mimic joint, never a mimic itself; else empty */
    double multiplier = 1.0, offset = 0.0;                    /**< of a mimic joint */
  };

  /** Reads a URDF.
   *
   *  Throws Error, naming link or joint and what is wrong: XML that is not a URDF; a tree that is none; a collision
   *  element that urdfdom drops (an unknown geometry such as capsule, a number that is none), dimensions that are not
   *  finite and positive, meshes that are missing, empty or unusable, a mesh scale of 0; origins or axes that are not
   *  finite, an axis of length 0; mimic joints without a leader or in a ring. With allow_missing_geometry the faults of
   *  collision elements become warnings().
   *  Cost: milliseconds, and about 2 ms a mesh file. */
  static std::shared_ptr<const Robot> fromUrdf(const std::string &xml, const RobotOptions &options = {});

  const std::string &name() const {
    return name_;
  }

  /** Where its mesh files were looked for. */
  const ResourceOptions &resources() const {
    return resources_;
  }

  const std::string &rootLink() const {
    return root_link_;
  }

  /** All links by name, each with its collision elements in the order of the URDF (none: an empty list). */
  const std::map<std::string, std::vector<LinkGeometry>> &links() const {
    return links_;
  }

  /** All joints, parents first. */
  const std::vector<Joint> &joints() const {
    return joints_;
  }

  /** What was left out under allow_missing_geometry, a sentence each. */
  const std::vector<std::string> &warnings() const {
    return warnings_;
  }

  /** The names that linkPoses() accepts: movable joints, mimics among them, and the parts of planar and floating ones.
   */
  const std::vector<std::string> &variables() const {
    return variables_;
  }

  /** Is there a joint of that name, fixed ones included, or a part of one (NAME/x)? */
  bool hasJoint(const std::string &name) const;

  /** Where every link is.
   *
   *  positions  joints that are not named are at 0, or at mid-range where 0 is outside their limits; values beyond the
   *             limits are taken as they are. Mimic joints follow their leader; a value given for one counts only if
   *             its leader has one too, and then is not looked at. Fixed joints may be named; their value is not looked
   *             at.
   *  base       the pose of the root link in the fixed frame.
   *
   *  Throws Error for a name that is no joint of this robot, a value that is not finite, a follower without its leader,
   *  a quaternion of norm 0.
   *  Rounding: within 1e-15 of the chain's length a joint. */
  LinkPoses linkPoses(const JointPositions &positions,
                      const Eigen::Isometry3d &base = Eigen::Isometry3d::Identity()) const;

 private:
  friend class RobotReader;

  Robot() = default;
  void checkPositions(const JointPositions &positions) const;
  double value(const Joint &joint, const JointPositions &positions) const;
  Eigen::Isometry3d motion(const Joint &joint, const JointPositions &positions) const;

  std::string name_, root_link_;
  ResourceOptions resources_;
  std::map<std::string, std::vector<LinkGeometry>> links_;
  std::vector<Joint> joints_; /* parents first */
  std::map<std::string, std::size_t> joint_by_name_;
  std::vector<std::string> variables_, warnings_;
};

} // namespace curve_proximity
#endif
