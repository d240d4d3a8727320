/* SPDX-License-Identifier: BSD-3-Clause */
/** The world that queries are asked about: a scene that changes, and immutable snapshots of it.
 *
 *  A query works on a Snapshot, so that queries and changes never wait for each other. Everything stands in one fixed
 *  frame; callers bring poses to it before they call. */
#ifndef CURVE_PROXIMITY_SCENE_HPP
#define CURVE_PROXIMITY_SCENE_HPP

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <curve_proximity/description.hpp>
#include <curve_proximity/geometry.hpp>
#include <curve_proximity/robot.hpp>

namespace curve_proximity {

class World;

/** One change of one object. */
struct Operation {
  /** ADD     a new object, or in the place of the one with that id.
   *  APPEND  further shapes for an object (relative to the object's pose; operation.object.pose must be that pose or
   *          the identity); without such an object the same as ADD.
   *  MOVE    a new pose for an object; shapes given with it are an error.
   *  REMOVE  away with an object; with an empty id, with all.
   *  The object's padding is set by ADD; by APPEND and MOVE only where it is not 0. */
  enum class Kind { ADD, APPEND, MOVE, REMOVE };
  Kind kind = Kind::ADD;
  ObjectDescription object; /**< MOVE and REMOVE use its id (and pose) only */
};

/** Whether two of objects and links may touch (see Snapshot::mayTouch()); b empty: the default of a. */
struct AllowedPair {
  std::string a, b;
  bool allowed = true;
};

/** One change of what the robot carries. */
struct Attachment {
  /** ATTACH  a link carries an object from now on: `object`, its pose in the link's frame, in the place of one of that
   *  id in the
   *          scene or on any link; without shapes the object of the scene of that id, which stays where it is at
   *          link_pose.
   *  DETACH  the object of that id stands in the scene from now on, where it is at link_pose; with an empty id, all
   *          that the link carries; with an empty link too, everything. */
  enum class Kind { ATTACH, DETACH };
  Kind kind = Kind::ATTACH;
  std::string link;
  std::vector<std::string> touch_links; /**< links that the object may touch, beside the one that carries it */
  ObjectDescription object;
  std::map<std::string, Eigen::Isometry3d> link_poses; /**< where links are in the fixed frame: those that are needed */
};

/** A change of the scene. What is left empty stays as it was. */
struct SceneChange {
  bool clear = false; /**< first away with all objects, carried ones too, allowed pairs but the scene's first ones, link
                           paddings and scales */
  std::vector<Operation> operations;          /**< applied in order */
  std::vector<Attachment> attachments;        /**< after the operations, in order */
  std::map<std::string, double> link_padding; /**< [m] >= 0, by link */
  std::optional<double> default_link_padding; /**< [m] >= 0, of the links not named */
  std::map<std::string, double> link_scale;   /**< > 0, by link: see Snapshot::linkGeometry() */
  std::vector<AllowedPair> allowed;           /**< each replaces the entry of the same two names, in either order */
};

/** A body where it stands in the fixed frame. */
struct PlacedShape {
  cprox_obstacle target{};  /**< padding included; the body is owned by whoever owns this */
  cprox_obstacle hull{};    /**< the same; a mesh by its convex hull */
  cprox_obstacle surface{}; /**< the same; a mesh that has an inside without it */
  double hull_excess = 0.0; /**< [m] how far points of the shape may be outside `hull`, beside rounding */
  Eigen::AlignedBox3d box;  /**< [m] contains the padded body, rounding included; infinite for a halfspace */
  double rounding = 0.0;    /**< [m] how far the rounding of poses can have moved a point of it */
  double turning = 0.0;     /**< of a halfspace: the same for each metre that a point is away from target.pose */
  bool is_mesh = false;
  bool is_open = false; /**< a mesh that was to be solid, but is not closed */
};

/** One shape of an object. */
struct ObjectShape {
  Geometry geometry;
  PlacedShape placed;
};

/** An object as the scene holds it. */
struct SceneObject {
  ObjectDescription description;   /**< as given, pose and padding brought up to date */
  std::vector<ObjectShape> shapes; /**< as many as description.shapes */
};

/** An object that a link carries. */
struct AttachedObject {
  std::string link;
  std::vector<std::string> touch_links;
  ObjectDescription description;    /**< as given; its pose is in the link's frame */
  std::vector<LinkGeometry> shapes; /**< in the link's frame, at the link's scale */
};

/** The scene at one moment: immutable, read by any number of threads. */
class Snapshot {
 public:
  ~Snapshot();

  /** Counts the changes of its scene, from 0. */
  std::uint64_t version() const {
    return version_;
  }

  /** By id. */
  const std::map<std::string, std::shared_ptr<const SceneObject>> &objects() const {
    return objects_;
  }

  /** Null where the scene has no robot. */
  const std::shared_ptr<const Robot> &robot() const {
    return robot_;
  }

  /** What links carry, by id; no object has the same id. It moves with its link, and is enlarged as the link is. */
  const std::map<std::string, std::shared_ptr<const AttachedObject>> &attached() const {
    return attached_;
  }

  /** [m] The padding of a carried object: its own and its link's. */
  double attachedPadding(const AttachedObject &object) const {
    return object.description.padding + linkPadding(object.link);
  }

  /** The collision elements of a link of the robot at its scale. A scale enlarges each of them, of any type, about its
   *  own origin; a mesh about the mean of its vertices, as MoveIt does. */
  const std::vector<LinkGeometry> &linkGeometry(const std::string &link) const;

  /** The scales that are not 1, by link. */
  const std::map<std::string, double> &linkScales() const {
    return link_scale_;
  }

  /** [m] The padding of a link: its own, else the default. */
  double linkPadding(const std::string &link) const;
  const std::map<std::string, double> &linkPaddings() const {
    return link_padding_;
  }
  double defaultLinkPadding() const {
    return default_link_padding_;
  }

  /** The allowed collision matrix: an entry for each pair of names, `false` ones too. Sorted by name; a <= b, or b
   *  empty. */
  const std::vector<AllowedPair> &allowed() const {
    return *allowed_;
  }

  /** Whether the allowed collision matrix lets two of objects and links touch, as moveit_msgs/AllowedCollisionMatrix
   *  says: the entry of the pair wins. Without one, the default of either name counts; where both names have a default,
   *  both must be true. Without entry and default the answer is false. Cost: a search in allowed(). */
  bool mayTouch(const std::string &a, const std::string &b) const;

  /** The objects' shapes with the tree over them (a part of the library, not of its interface). */
  const World &world() const {
    return *world_;
  }

 private:
  friend class Scene;
  Snapshot();
  Snapshot(const Snapshot &other);
  void scaleLinks(const std::map<std::string, double> &scales, const ResourceOptions &resources);

  std::uint64_t version_ = 0;
  std::map<std::string, std::shared_ptr<const SceneObject>> objects_;
  std::shared_ptr<const Robot> robot_;
  std::map<std::string, std::shared_ptr<const AttachedObject>> attached_;
  std::map<std::string, double> link_padding_, link_scale_;
  std::map<std::string, std::shared_ptr<const std::vector<LinkGeometry>>> scaled_; /* of the links in link_scale_ */
  double default_link_padding_ = 0.0;
  std::shared_ptr<const std::vector<AllowedPair>> allowed_; /* shared by the snapshots that do not change it */
  std::unique_ptr<const World> world_;
};

using SnapshotPtr = std::shared_ptr<const Snapshot>;

/** Thread safety: any number of threads; changes wait for each other, snapshot() never waits for a change in the
 *  making.
 */
class Scene {
 public:
  /** robot may be null. resources: where the objects' mesh files are looked for. allowed: entries of the allowed
   *  collision matrix that stand there from the beginning, and again after a change that clears the scene
   *  (allowedPairs() of an SRDF). Throws Error for one without a first name. */
  explicit Scene(std::shared_ptr<const Robot> robot = nullptr, ResourceOptions resources = {},
                 const std::vector<AllowedPair> &allowed = {});

  /** The scene as it is now. */
  SnapshotPtr snapshot() const;

  /** Applies a change; what can be applied becomes visible at once, as one new snapshot.
   *
   *  All or nothing for each operation and attachment, and for the link paddings, scales and allowed pairs each: what
   *  is faulty leaves the scene as it was and is told in a sentence that names it ("object 'box1': cylinder needs 2
   *  dimensions [height, radius], got 1"). Returns these sentences in the order of the change; none: all was applied.
   *  An unknown id on MOVE or REMOVE, an object without an id or with that of a carried one, poses and paddings that
   *  are not finite, a padding < 0, an unknown link, an allowed pair without a first name and a halfspace that is to be
   *  carried are faults. Cost: microseconds an object that stays, more for those that are made; bodies that stay are
   *  shared. */
  std::vector<std::string> apply(const SceneChange &change);

 private:
  const ResourceOptions resources_;
  const std::shared_ptr<const std::vector<AllowedPair>> first_allowed_;
  std::mutex changing_;        /* held while a change is in the making */
  mutable std::mutex current_; /* held for a moment, to read or set the pointer */
  SnapshotPtr snapshot_;
};

} // namespace curve_proximity
#endif
