/* SPDX-License-Identifier: BSD-3-Clause */
/** A robot from its URDF: the collision elements of all links as bodies, and forward kinematics. */
#ifndef CURVE_PROXIMITY_ROBOT_HPP
#define CURVE_PROXIMITY_ROBOT_HPP

#include <cmath>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <curve_proximity/core.hpp>
#include <curve_proximity/coverage.hpp>
#include <curve_proximity/geometry.hpp>

namespace curve_proximity {

/** Joint values by name: radians, or metres for prismatic joints. A planar joint has NAME/x, NAME/y, NAME/theta; a
 *  floating one NAME/trans_x, _y, _z and NAME/rot_x, _y, _z, _w, as in MoveIt. */
using JointPositions = std::map<std::string, double>;

/** The pose of each link's frame in the fixed frame, by link name. */
using LinkPoses = std::map<std::string, Eigen::Isometry3d>;

/** How a URDF is read. */
struct RobotOptions {
  ResourceOptions resources; /**< resources.base_dir: the folder of the URDF (`urdf_dir`) */

  /** Unusable collision elements are skipped with a warning instead of an error. */
  bool allow_missing_geometry = false;

  /** How many threads load mesh files; 0: as many as the machine has. */
  unsigned threads = 0;

  /** Links whose collision elements are in memory: these replace the elements of the URDF, whose files are not read.
   *  A mesh is solid only if its description says so; closed meshes of the URDF are. Names that the robot does not have
   *  are an error. */
  std::map<std::string, std::vector<ShapeDescription>> link_shapes = {};
};

/** One collision element of a link. */
struct LinkGeometry {
  Geometry geometry;                                      /**< the body */
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity(); /**< in the link's frame */
  ShapeDescription description;                           /**< its description, pose included */
};

/** A robot model. Immutable; shared by any number of threads. */
class Robot {
 public:
  /** The type of a joint; a continuous joint is REVOLUTE without limits. */
  enum class JointType { FIXED, REVOLUTE, PRISMATIC, PLANAR, FLOATING };

  /** A joint of the URDF. */
  struct Joint {
    std::string name;                                         /**< as in the URDF */
    JointType type = JointType::FIXED;                        /**< its kind of motion */
    std::string parent;                                       /**< the link above */
    std::string child;                                        /**< the link below */
    Eigen::Isometry3d origin = Eigen::Isometry3d::Identity(); /**< of the joint's frame in the parent's frame */
    Eigen::Vector3d axis = Eigen::Vector3d::UnitX();          /**< unit; planar: the plane's normal */
    double lower = -INFINITY;                                 /**< lower limit, if the URDF has one */
    double upper = INFINITY;                                  /**< upper limit, if the URDF has one */
    double rest = 0.0;                                        /**< the value if none is given */
    std::string leader;      /**< of a mimic joint: the joint it follows, never a mimic; else empty */
    double multiplier = 1.0; /**< of a mimic joint */
    double offset = 0.0;     /**< of a mimic joint */
  };

  /** Reads a URDF.
   *
   *  Throws Error, naming link or joint and what is wrong: XML that is not a URDF, or that xacro has to expand first; a
   *  tree that is none; a collision element with an unknown geometry, two geometries, or a number that is none;
   *  dimensions that are not finite or below 0 (0 makes a point, a line or a disc); meshes that are missing, empty or
   *  unusable, a mesh scale of 0; origins or axes that are not finite, an axis of length 0; mimic joints without a
   *  leader or in a ring. With allow_missing_geometry the faults of collision elements become warnings(). Elements and
   *  attributes that are not known become warnings(), and coverage() is partial.
   *  Cost: milliseconds, and about 10 ms a mesh file and thread; 1 ms once its content is in resources.cache_dir. */
  static std::shared_ptr<const Robot> fromUrdf(const std::string &xml, const RobotOptions &options = {});

  /** The robot's name. */
  const std::string &name() const {
    return name_;
  }

  /** Where mesh files were searched. */
  const ResourceOptions &resources() const {
    return resources_;
  }

  /** The name of the root link. */
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

  /** The collision elements that allow_missing_geometry skipped, and elements that are not known, one message each. */
  const std::vector<std::string> &warnings() const {
    return warnings_;
  }

  /** What of the URDF answers about the robot do not cover. */
  const Coverage &coverage() const {
    return coverage_;
  }

  /** How long each mesh file took. A file that several links name with the same scale is loaded once. */
  const std::vector<MeshTiming> &meshTimings() const {
    return mesh_timings_;
  }

  /** The names that linkPoses() accepts: movable joints (mimics included) and the variables of planar and floating
   *  joints. */
  const std::vector<std::string> &variables() const {
    return variables_;
  }

  /** True if a joint (fixed ones included) or a joint's variable (NAME/x) has that name. */
  bool hasJoint(const std::string &name) const;

  /** Forward kinematics: the pose of every link.
   *
   *  positions  a joint without a value is at 0, or at mid-range if 0 is outside its limits. Limits are not enforced.
   *             Mimic joints follow their leader; a value for a mimic joint is ignored, and is an error if its leader
   *             has none. Values of fixed joints are ignored.
   *  base       the pose of the root link in the fixed frame.
   *
   *  Throws Error for an unknown joint, a value that is not finite, a mimic joint's value without its leader's, and a
   *  quaternion of norm 0. Rounding: within 1e-15 of the chain's length per joint. */
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
  Coverage coverage_;
  std::vector<MeshTiming> mesh_timings_;
};

} // namespace curve_proximity
#endif
