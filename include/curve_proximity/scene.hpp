/* SPDX-License-Identifier: BSD-3-Clause */
/** A scene of objects, links and attached objects, and immutable snapshots of it.
 *
 *  A query works on a Snapshot, so queries and changes never wait for each other. All poses are in one fixed frame;
 *  callers convert poses first. */
#ifndef CURVE_PROXIMITY_SCENE_HPP
#define CURVE_PROXIMITY_SCENE_HPP

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <curve_proximity/coverage.hpp>
#include <curve_proximity/description.hpp>
#include <curve_proximity/geometry.hpp>
#include <curve_proximity/robot.hpp>

namespace curve_proximity {

class World;
struct MovingBody;

/** One change of one object. */
struct Operation {
  /** ADD     adds an object, or replaces the object with that id.
   *  APPEND  adds shapes to an object (relative to the object's pose; operation.object.pose must be that pose or the
   *          identity). Without such an object it is ADD.
   *  MOVE    sets the pose of an object; shapes are an error.
   *  REMOVE  removes an object; with an empty id, all objects.
   *  ADD sets the object's padding; APPEND and MOVE set it only if it is not 0. */
  enum class Kind { ADD, APPEND, MOVE, REMOVE };
  Kind kind = Kind::ADD;    /**< what to do */
  ObjectDescription object; /**< MOVE uses its id and pose, REMOVE its id */

  /** ADD: the object moves (Snapshot::moving()). The poses are in the fixed frame, and object.pose is the identity. */
  std::optional<ObjectTrajectory> trajectory = std::nullopt;
};

/** An entry of the allowed collision matrix (see Snapshot::mayTouch()). */
struct AllowedPair {
  std::string a;       /**< an object or a link */
  std::string b;       /**< another one; empty: the entry is the default of a */
  bool allowed = true; /**< they may touch */
};

/** Attaches an object to a link, or detaches it. */
struct Attachment {
  /** ATTACH  attaches `object` to a link; its pose is in the link's frame. It replaces an object of that id in the
   *          scene or on any link. Without shapes, the scene's object of that id is attached where it stands.
   *  DETACH  puts the attached object of that id into the scene, where it stands. With an empty id, all objects of the
   *          link; with an empty link too, all attached objects. */
  enum class Kind { ATTACH, DETACH };
  Kind kind = Kind::ATTACH;                            /**< what to do */
  std::string link;                                    /**< the link */
  std::vector<std::string> touch_links;                /**< further links that the object may touch */
  ObjectDescription object;                            /**< the object, or only its id */
  std::map<std::string, Eigen::Isometry3d> link_poses; /**< the needed links in the fixed frame */
};

/** A change of the scene. Empty members change nothing. */
struct SceneChange {
  /** First removes all objects (attached too), link paddings and scales, and all allowed pairs but those that the scene
   *  began with. */
  bool clear = false;
  bool clear_objects = false;    /**< First removes all objects of the scene but those in `kept`. */
  std::vector<std::string> kept; /**< ids that clear_objects leaves */
  bool clear_attached = false;   /**< First removes all attached objects; they do not return into the scene. */
  /** First removes all allowed pairs, also those that the scene began with: see Snapshot::replacesSrdf(). */
  bool clear_allowed = false;
  std::vector<Operation> operations;   /**< applied in order */
  std::vector<Attachment> attachments; /**< after the operations, in order */
  bool attachments_first = false;      /**< the attachments come before the operations */
  /** [m] >= 0, by link. Counts against everything but the robot itself and what it carries, as in MoveIt. */
  std::map<std::string, double> link_padding;
  std::optional<double> default_link_padding; /**< [m] >= 0, of the links not named */
  std::map<std::string, double> link_scale;   /**< > 0, by link: see Snapshot::linkGeometry() */
  std::vector<AllowedPair> allowed;           /**< each replaces the entry of the same two names, in either order */

  /** What of the change's source is not used: Snapshot::coverage() has it until a change that clears the scene. */
  Coverage coverage;

  /** Asked before each new shape is made; true: shapes not made yet are errors. Null: never. */
  std::function<bool()> stop;
};

/** A body at its pose in the fixed frame. */
struct PlacedShape {
  cprox_obstacle obstacle{}; /**< padding included; the body belongs to the owner of this struct */
  cprox_obstacle hull{};     /**< the same, with a mesh's convex hull */
  cprox_obstacle surface{};  /**< the same, with a solid mesh as a surface */
  double hull_excess = 0.0;  /**< [m] how far points of the shape may be outside `hull`, beside rounding */
  Eigen::AlignedBox3d box;   /**< [m] contains the padded body, rounding included; infinite for a halfspace */
  double rounding = 0.0;     /**< [m] how far the rounding of poses can have moved a point of it */
  double turning = 0.0;      /**< of a halfspace: the same per metre of distance from obstacle.pose */
  bool is_mesh = false;      /**< the shape is a mesh */
  bool is_open = false;      /**< `solid` was requested, but the mesh is not closed */
};

/** One shape of an object. */
struct ObjectShape {
  Geometry geometry;  /**< in the shape's frame */
  PlacedShape placed; /**< in the fixed frame */
};

/** An object of the scene. */
struct SceneObject {
  ObjectDescription description;   /**< as given, with the current pose and padding */
  std::vector<ObjectShape> shapes; /**< as many as description.shapes; that of an empty octree has no body */
};

/** An object of the scene that moves along a trajectory. */
struct MovingSceneObject {
  ObjectDescription description;          /**< as given */
  ObjectTrajectory trajectory;            /**< as given */
  std::vector<Geometry> geometries;       /**< of description.shapes */
  std::shared_ptr<const MovingBody> body; /**< internal */
};

/** An object that is attached to a link. */
struct AttachedObject {
  std::string link;                     /**< the link */
  std::vector<std::string> touch_links; /**< further links that it may touch */
  ObjectDescription description;        /**< as given; its pose is in the link's frame */
  std::vector<LinkGeometry> shapes;     /**< in the link's frame, at the link's scale */
};

/** Attached objects by id. */
using AttachedObjects = std::map<std::string, std::shared_ptr<const AttachedObject>>;

/** An attached object that belongs to a state of the robot and not to a scene (SceneVariant, RobotPlacement).
 *  given.object.pose is in the link's frame; given.kind and given.link_poses are not read. link_scale: as in
 *  Snapshot::linkGeometry(). Throws Error as Scene::apply() reports. */
std::shared_ptr<const AttachedObject> attachedObject(const Attachment &given, double link_scale = 1.0,
                                                     const ResourceOptions &resources = {});

/** What a variant of a snapshot has in place of what the snapshot has. Absent members are those of the snapshot. */
struct SceneVariant {
  std::optional<AttachedObjects> attached;         /**< all attached objects */
  std::optional<std::vector<AllowedPair>> allowed; /**< all entries of the allowed collision matrix */
};

/** The scene at one moment. Immutable; any number of threads may read it. */
class Snapshot {
 public:
  ~Snapshot();

  /** The number of changes of the scene before this snapshot. */
  std::uint64_t version() const {
    return version_;
  }

  /** What of the changes since the scene was last cleared is not used: no answer is then 'clear'. */
  const Coverage &coverage() const {
    return coverage_;
  }

  /** The objects by id. */
  const std::map<std::string, std::shared_ptr<const SceneObject>> &objects() const {
    return objects_;
  }

  /** The objects that move, by id; none of objects() has the same id. Queries of movers.hpp test against them. All
   *  others refuse to answer about a scene in which anything moves, unless they name objects that stand. */
  const std::map<std::string, std::shared_ptr<const MovingSceneObject>> &moving() const {
    return moving_;
  }

  /** The robot; null if the scene has none. */
  const std::shared_ptr<const Robot> &robot() const {
    return robot_;
  }

  /** Attached objects by id; no object of the scene has the same id. They have the padding and scale of their link. */
  const AttachedObjects &attached() const {
    return attached_;
  }

  /** [m] The padding of an attached object: its own plus its link's. */
  double attachedPadding(const AttachedObject &object) const {
    return object.description.padding + linkPadding(object.link);
  }

  /** The collision elements of a link at the link's scale. A scale enlarges each element about its own origin, a mesh
   *  about the mean of its vertices, as in MoveIt. */
  const std::vector<LinkGeometry> &linkGeometry(const std::string &link) const;

  /** The scales that are not 1, by link. */
  const std::map<std::string, double> &linkScales() const {
    return link_scale_;
  }

  /** [m] The padding of a link: its own, else the default. */
  double linkPadding(const std::string &link) const;
  /** [m] The paddings of links that have their own. */
  const std::map<std::string, double> &linkPaddings() const {
    return link_padding_;
  }
  /** [m] The padding of all other links. */
  double defaultLinkPadding() const {
    return default_link_padding_;
  }

  /** The entries of the allowed collision matrix, `false` ones included. Sorted by name; a <= b, or b is empty. */
  const std::vector<AllowedPair> &allowed() const {
    return *allowed_;
  }

  /** True if allowed() says it all: SceneChange::clear_allowed has replaced the pairs that the scene began with, so
   *  those that an SRDF disables do not count apart. */
  bool replacesSrdf() const {
    return replaces_srdf_;
  }

  /** True if the allowed collision matrix lets two objects or links touch. The rules are those of
   *  moveit_msgs/AllowedCollisionMatrix: the entry of the pair wins. Without an entry the default of either name
   *  counts; if both names have a default, both must be true. Otherwise false. Cost: a search in allowed(). */
  bool mayTouch(const std::string &a, const std::string &b) const;

  /** The same scene with other attached objects, or another allowed collision matrix: of one query, or of one state of
   *  the robot. Objects and their BVH are shared. Throws Error for a link that the robot does not have, an attached
   *  object with the id of an object, and an allowed pair without a first name. Cost: microseconds. */
  std::shared_ptr<const Snapshot> variant(const SceneVariant &variant) const;

  /** The shapes of the objects with their broadphase. Internal. */
  const World &world() const {
    return *world_;
  }

 private:
  friend class Scene;
  Snapshot();
  Snapshot(const Snapshot &other);
  void scaleLinks(const std::map<std::string, double> &scales, const ResourceOptions &resources);

  std::uint64_t version_ = 0;
  Coverage coverage_;
  std::map<std::string, std::shared_ptr<const SceneObject>> objects_;
  std::map<std::string, std::shared_ptr<const MovingSceneObject>> moving_;
  std::shared_ptr<const Robot> robot_;
  AttachedObjects attached_;
  std::map<std::string, double> link_padding_, link_scale_;
  std::map<std::string, std::shared_ptr<const std::vector<LinkGeometry>>> scaled_; /* of the links in link_scale_ */
  double default_link_padding_ = 0.0;
  std::shared_ptr<const std::vector<AllowedPair>> allowed_; /* shared by the snapshots that do not change it */
  bool replaces_srdf_ = false;
  std::shared_ptr<const World> world_; /* shared by the variants */
};

/** A shared snapshot. */
using SnapshotPtr = std::shared_ptr<const Snapshot>;

/** A scene that changes.
 *
 *  Thread safety: any number of threads. Changes wait for each other; snapshot() never waits for a change. */
class Scene {
 public:
  /** robot may be null. resources: where the objects' mesh files are searched. allowed: entries of the allowed
   *  collision matrix from the beginning, and again after a change that clears the scene (allowedPairs() of an SRDF).
   *  Throws Error for an entry without a first name. */
  explicit Scene(std::shared_ptr<const Robot> robot = nullptr, ResourceOptions resources = {},
                 const std::vector<AllowedPair> &allowed = {});

  /** A scene without a robot. */
  explicit Scene(std::nullptr_t, ResourceOptions resources = {}, const std::vector<AllowedPair> &allowed = {})
      : Scene(std::shared_ptr<const Robot>(), std::move(resources), allowed) {}

  /** A scene that begins as a snapshot, with its robot; so it is again what it allows, after a change that clears the
   *  scene. Throws Error for null. */
  explicit Scene(const SnapshotPtr &begin, ResourceOptions resources = {});

  /** The current scene. */
  SnapshotPtr snapshot() const;

  /** Applies a change as one new snapshot.
   *
   *  Each operation, each attachment, the link paddings, the scales and the allowed pairs are applied all or nothing. A
   *  faulty one changes nothing and gives an error message ("object 'box1': cylinder needs 2 dimensions
   *  [height, radius], got 1"). Returns the messages in the order of the change; empty: all was applied.
   *
   *  Errors are: an unknown id on MOVE or REMOVE; an object without an id, or with that of an attached object; poses or
   *  paddings that are not finite; a padding < 0; an unknown link; an allowed pair without a first name; a halfspace to
   *  attach; MOVE, APPEND and attaching of an object that moves; a trajectory whose times do not ascend, or with
   *  orientations half a turn apart. Cost: microseconds per unchanged object, whose bodies are shared; more for new
   * objects, whose bodies are made before other changes have to wait. */
  std::vector<std::string> apply(const SceneChange &change);

  /** The same. on_applied: called with the new snapshot's version just before snapshot() returns it, unless there are
   *  errors. Other changes wait for it. */
  std::vector<std::string> apply(const SceneChange &change, const std::function<void(std::uint64_t)> &on_applied);

 private:
  const ResourceOptions resources_;
  const std::shared_ptr<const std::vector<AllowedPair>> first_allowed_;
  std::mutex changing_;        /* held while a change is in the making */
  mutable std::mutex current_; /* held for a moment, to read or set the pointer */
  SnapshotPtr snapshot_;
};

} // namespace curve_proximity
#endif
