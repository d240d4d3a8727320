/* SPDX-License-Identifier: BSD-3-Clause */
#include <algorithm>
#include <exception>
#include <iterator>
#include <tuple>
#include <utility>

#include <curve_proximity/scene.hpp>

#include "attaching.h"
#include "geometry/placing.h"
#include "moving_body.h"
#include "world.h"

namespace curve_proximity {
namespace {

using Objects = std::map<std::string, std::shared_ptr<const SceneObject>>;
using MovingObjects = std::map<std::string, std::shared_ptr<const MovingSceneObject>>;

constexpr const char *IT_MOVES = "it moves along a trajectory: ADD replaces it, REMOVE removes it";

/* APPEND's pose must be the object's own, within what a conversion of frames costs. */
constexpr double SAME_POSE = 1e-9;

std::string shapeName(std::size_t number, std::size_t of) {
  return of > 1 ? "shape " + std::to_string(number + 1) + ": " : "";
}

/* The bodies of one operation's shapes, made before the scene is locked. */
struct Prepared {
  std::vector<Geometry> geometries;
  std::exception_ptr fault; /* of the first shape that has no body */
};

Prepared prepare(const ObjectDescription &given, const ResourceOptions &resources, const SceneChange &change) {
  Prepared out;
  const std::vector<ShapeDescription> &shapes = given.shapes;
  ResourceOptions within = resources;
  within.stop = change.stop;
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    try {
      if (change.stop && change.stop()) throw Error("it was not begun", CPROX_STOPPED);
      checkPose(shapes[i].pose, "its pose");
      out.geometries.push_back(makeGeometry(shapes[i], within));
    } catch (const Error &error) {
      const bool late = change.stop && change.stop();
      const std::string why = (late ? "there was no time left to make its shapes: " : "") + std::string(error.what());
      out.fault = std::make_exception_ptr(Error(shapeName(i, shapes.size()) + why, error.status()));
      return out;
    } catch (...) {
      out.fault = std::current_exception();
      return out;
    }
  }
  return out;
}

void addBodies(SceneObject &object, Prepared &prepared) {
  if (prepared.fault) std::rethrow_exception(prepared.fault);
  for (Geometry &geometry : prepared.geometries) {
    object.shapes.emplace_back();
    object.shapes.back().geometry = std::move(geometry);
  }
}

/* All shapes to where the object's pose and padding put them. */
void placeShapes(SceneObject &object) {
  const ObjectDescription &description = object.description;
  for (std::size_t i = 0; i < object.shapes.size(); ++i) {
    ObjectShape &shape = object.shapes[i];
    if (!shape.geometry.isEmpty())
      shape.placed = place(shape.geometry, description.pose, description.shapes[i].pose, description.padding);
  }
}

std::shared_ptr<const SceneObject> added(const ObjectDescription &given, Prepared &prepared) {
  if (given.shapes.empty()) throw Error("it has no shapes");
  const auto object = std::make_shared<SceneObject>();
  object->description = given;
  addBodies(*object, prepared);
  placeShapes(*object);
  return object;
}

std::shared_ptr<const SceneObject> appended(const SceneObject &before, const ObjectDescription &given,
                                            Prepared &prepared) {
  if (given.shapes.empty()) throw Error("APPEND brings no shapes");
  const Eigen::Matrix4d pose = given.pose.matrix();
  const bool own = (pose - before.description.pose.matrix()).cwiseAbs().maxCoeff() <= SAME_POSE;
  if (!own && pose != Eigen::Matrix4d::Identity()) {
    throw Error("APPEND places shapes relative to the object's pose: give that pose or none (MOVE changes it)");
  }

  const auto object = std::make_shared<SceneObject>(before);
  std::vector<ShapeDescription> &shapes = object->description.shapes;
  shapes.insert(shapes.end(), given.shapes.begin(), given.shapes.end());
  if (given.padding > 0.0) object->description.padding = given.padding;
  addBodies(*object, prepared);
  placeShapes(*object);
  return object;
}

std::shared_ptr<const SceneObject> moved(const SceneObject &before, const ObjectDescription &given) {
  if (!given.shapes.empty()) throw Error("MOVE takes no shapes (ADD replaces an object)");
  const auto object = std::make_shared<SceneObject>(before);
  object->description.pose = given.pose;
  object->description.frame = given.frame;
  if (given.padding > 0.0) object->description.padding = given.padding;
  placeShapes(*object);
  return object;
}

/* An object that moves. */
std::shared_ptr<const MovingSceneObject> launched(const Operation &operation, Prepared &prepared) {
  const ObjectDescription &given = operation.object;
  const ObjectTrajectory &trajectory = *operation.trajectory;
  if (!given.pose.matrix().isIdentity(0.0))
    throw Error("it has a pose and a trajectory: the poses of the trajectory say where it is");
  if (prepared.fault) std::rethrow_exception(prepared.fault);
  const auto object = std::make_shared<MovingSceneObject>();
  object->description = given;
  object->trajectory = trajectory;
  object->geometries = prepared.geometries;
  object->body = makeMovingBody(given, std::move(prepared.geometries), trajectory.poses, trajectory.turning);
  return object;
}

/* One operation; throws Error and leaves the objects as they were where it cannot be done. */
void applyOperation(const Operation &operation, Prepared &prepared, const AttachedObjects &attached, Objects &objects,
                    MovingObjects &moving) {
  const ObjectDescription &given = operation.object;
  if (operation.trajectory && operation.kind != Operation::Kind::ADD) throw Error("only ADD takes a trajectory");
  if (operation.kind == Operation::Kind::REMOVE && given.id.empty()) {
    objects.clear();
    moving.clear();
    return;
  }
  if (given.id.empty()) throw Error("it has no id");
  const auto held = attached.find(given.id);
  if (held != attached.end()) throw Error("link '" + held->second->link + "' carries it: detach it first");
  const auto it = objects.find(given.id);
  const bool known = it != objects.end(), moves = moving.count(given.id) > 0;
  if (operation.kind == Operation::Kind::REMOVE) {
    if (moving.erase(given.id) > 0) return;
    if (!known) throw Error("there is no object of that id to remove");
    objects.erase(it);
    return;
  }

  checkPose(given.pose, "its pose");
  checkPadding(given.padding);
  if (moves && operation.kind != Operation::Kind::ADD) throw Error(IT_MOVES);
  if (operation.trajectory) {
    moving[given.id] = launched(operation, prepared);
    objects.erase(given.id);
    return;
  }
  switch (operation.kind) {
    case Operation::Kind::MOVE:
      if (!known) throw Error("there is no object of that id to move");
      it->second = moved(*it->second, given);
      break;
    case Operation::Kind::APPEND:
      if (known) {
        it->second = appended(*it->second, given, prepared);
        break;
      }
      [[fallthrough]];
    default:
      objects[given.id] = added(given, prepared);
      moving.erase(given.id);
      break;
  }
}

/* ---- what links carry ---- */

/* What an attachment changes of a scene. */
struct Carrying {
  const Robot *robot;
  const std::map<std::string, double> &link_scale;
  const ResourceOptions &resources;
  Objects &objects;
  const MovingObjects &moving;
  AttachedObjects &attached;

  double scaleOf(const std::string &link) const {
    const auto it = link_scale.find(link);
    return it == link_scale.end() ? 1.0 : it->second;
  }
};

/* Without shapes of its own, the object of the scene of that id, where it stands. */
void attach(const Attachment &given, Carrying &scene) {
  const std::string &id = given.object.id;
  if (id.empty()) throw Error("it has no id");
  if (scene.moving.count(id) > 0) throw Error(IT_MOVES);
  checkLink(given.link, scene.robot);
  checkPose(given.object.pose, "its pose");
  checkPadding(given.object.padding);
  Attachment whole = given;
  const auto standing = scene.objects.find(id);
  if (given.object.shapes.empty() && standing != scene.objects.end()) {
    whole.object = standing->second->description;
    whole.object.pose = poseOfLink(given, given.link).inverse() * whole.object.pose;
  }
  scene.attached[id] = carried(whole, scene.scaleOf(given.link), scene.resources);
  if (standing != scene.objects.end()) scene.objects.erase(standing);
}

/* The object as it stands in the scene, at its own size. */
std::shared_ptr<const SceneObject> detached(const AttachedObject &object, const Attachment &given,
                                            const ResourceOptions &resources) {
  ObjectDescription standing = object.description;
  standing.frame.clear();
  standing.pose = poseOfLink(given, object.link) * standing.pose;
  Prepared prepared = prepare(standing, resources, {});
  return added(standing, prepared);
}

/* Throws Error and leaves the scene as it was where it cannot be done. */
void applyAttachment(const Attachment &given, Carrying &scene) {
  if (given.kind == Attachment::Kind::ATTACH) return attach(given, scene);
  const bool one = !given.object.id.empty();
  if (one && scene.attached.count(given.object.id) == 0) throw Error("no link carries an object of that id");
  Objects standing;
  for (const auto &[id, object] : scene.attached) {
    const bool meant = one ? id == given.object.id : given.link.empty() || object->link == given.link;
    if (meant && one && !given.link.empty() && object->link != given.link)
      throw Error("link '" + object->link + "' carries it, not '" + given.link + "'");
    if (meant) standing[id] = detached(*object, given, scene.resources);
  }
  for (auto &[id, object] : standing) {
    scene.attached.erase(id);
    scene.objects[id] = std::move(object);
  }
}

void checkLinkPaddings(const std::map<std::string, double> &paddings, const Robot *robot) {
  for (const auto &[link, padding] : paddings) {
    try {
      checkPadding(padding);
    } catch (const Error &error) {
      throw Error("link '" + link + "': " + error.what());
    }
    checkLink(link, robot, "link padding: ");
  }
}

/* ---- who may touch whom ---- */

using NamedPair = std::pair<const std::string &, const std::string &>;

/* Each replaces the entry of the same names. Returns a matrix with an entry for each pair of names, sorted by name. */
std::vector<AllowedPair> mergeAllowed(const std::vector<AllowedPair> &before, const std::vector<AllowedPair> &change) {
  std::map<std::pair<std::string, std::string>, bool> entries;
  for (const AllowedPair &pair : before) entries[{pair.a, pair.b}] = pair.allowed;
  for (const AllowedPair &pair : change) {
    if (pair.a.empty()) throw Error("an allowed pair has no first name");
    const bool turned = !pair.b.empty() && pair.b < pair.a;
    entries[turned ? std::make_pair(pair.b, pair.a) : std::make_pair(pair.a, pair.b)] = pair.allowed;
  }
  std::vector<AllowedPair> out;
  out.reserve(entries.size());
  for (const auto &[names, allowed] : entries) out.push_back({names.first, names.second, allowed});
  return out;
}

/* The entry of two names in their order, or of a name and "". Null where there is none. */
const AllowedPair *findAllowed(const std::vector<AllowedPair> &matrix, const NamedPair &names) {
  const auto it = std::lower_bound(matrix.begin(), matrix.end(), names, [](const AllowedPair &x, const NamedPair &y) {
    return std::tie(x.a, x.b) < std::tie(y.first, y.second);
  });
  return it != matrix.end() && it->a == names.first && it->b == names.second ? &*it : nullptr;
}

} // namespace

/* ---- Snapshot ---- */

Snapshot::Snapshot() : allowed_(std::make_shared<const std::vector<AllowedPair>>()) {}
Snapshot::~Snapshot() = default;

Snapshot::Snapshot(const Snapshot &other)
    : version_(other.version_),
      coverage_(other.coverage_),
      objects_(other.objects_),
      moving_(other.moving_),
      robot_(other.robot_),
      attached_(other.attached_),
      link_padding_(other.link_padding_),
      link_scale_(other.link_scale_),
      scaled_(other.scaled_),
      default_link_padding_(other.default_link_padding_),
      allowed_(other.allowed_),
      replaces_srdf_(other.replaces_srdf_) {}

double Snapshot::linkPadding(const std::string &link) const {
  const auto it = link_padding_.find(link);
  return it == link_padding_.end() ? default_link_padding_ : it->second;
}

bool Snapshot::mayTouch(const std::string &a, const std::string &b) const {
  const std::vector<AllowedPair> &matrix = *allowed_;
  if (const AllowedPair *entry = findAllowed(matrix, a < b ? NamedPair(a, b) : NamedPair(b, a))) return entry->allowed;
  const std::string none;
  const AllowedPair *of_a = findAllowed(matrix, {a, none}), *of_b = findAllowed(matrix, {b, none});
  return (of_a || of_b) && (!of_a || of_a->allowed) && (!of_b || of_b->allowed);
}

const std::vector<LinkGeometry> &Snapshot::linkGeometry(const std::string &link) const {
  const auto it = scaled_.find(link);
  return it == scaled_.end() ? robot_->links().at(link) : *it->second;
}

/* All or nothing: what links carry is enlarged with them. */
void Snapshot::scaleLinks(const std::map<std::string, double> &scales, const ResourceOptions &resources) {
  checkLinkScales(scales, robot_.get());
  auto scaled = scaled_;
  auto attached = attached_;
  for (const auto &[link, scale] : scales) {
    scaled.erase(link);
    if (scale != 1.0) scaled[link] = scaledLink(*robot_, link, scale);
    for (auto &[id, object] : attached)
      if (object->link == link) object = rescaled(*object, scale, resources);
  }
  scaled_ = std::move(scaled);
  attached_ = std::move(attached);
  for (const auto &[link, scale] : scales) link_scale_[link] = scale;
  for (auto it = link_scale_.begin(); it != link_scale_.end();) it = it->second == 1.0 ? link_scale_.erase(it) : ++it;
}

SnapshotPtr Snapshot::variant(const SceneVariant &variant) const {
  const std::shared_ptr<Snapshot> out(new Snapshot(*this));
  out->world_ = world_;
  if (variant.allowed)
    out->allowed_ = std::make_shared<const std::vector<AllowedPair>>(mergeAllowed({}, *variant.allowed));
  if (!variant.attached) return out;
  for (const auto &[id, object] : *variant.attached) {
    checkLink(object->link, robot_.get());
    if (objects_.count(id) > 0 || moving_.count(id) > 0)
      throw Error("attached object '" + id + "': an object of the scene has the same id");
  }
  out->attached_ = *variant.attached;
  return out;
}

/* ---- Scene ---- */

Scene::Scene(std::shared_ptr<const Robot> robot, ResourceOptions resources, const std::vector<AllowedPair> &allowed)
    : resources_(std::move(resources)),
      first_allowed_(std::make_shared<const std::vector<AllowedPair>>(mergeAllowed({}, allowed))) {
  const std::shared_ptr<Snapshot> first(new Snapshot);
  first->allowed_ = first_allowed_;
  first->robot_ = std::move(robot);
  first->world_ = std::make_shared<const World>(first->objects_);
  snapshot_ = first;
}

Scene::Scene(const SnapshotPtr &begin, ResourceOptions resources)
    : resources_(std::move(resources)), first_allowed_(begin ? begin->allowed_ : nullptr), snapshot_(begin) {
  if (!begin) throw Error("a scene cannot begin as no snapshot");
}

SnapshotPtr Scene::snapshot() const {
  const std::lock_guard<std::mutex> lock(current_);
  return snapshot_;
}

std::vector<std::string> Scene::apply(const SceneChange &change) {
  return apply(change, nullptr);
}

std::vector<std::string> Scene::apply(const SceneChange &change, const std::function<void(std::uint64_t)> &on_applied) {
  // What takes long, the bodies, before anybody has to wait for it.
  std::vector<Prepared> prepared;
  prepared.reserve(change.operations.size());
  for (const Operation &operation : change.operations) {
    const bool shapes = operation.kind == Operation::Kind::ADD || operation.kind == Operation::Kind::APPEND;
    prepared.push_back(shapes ? prepare(operation.object, resources_, change) : Prepared());
  }

  const std::lock_guard<std::mutex> one_at_a_time(changing_);
  std::vector<std::string> faults;
  const SnapshotPtr before = snapshot();
  const std::shared_ptr<Snapshot> next(new Snapshot(*before));
  ++next->version_;
  if (change.clear) {
    next->coverage_ = Coverage();
    next->objects_.clear();
    next->moving_.clear();
    next->allowed_ = first_allowed_;
    next->replaces_srdf_ = false;
    next->attached_.clear();
    next->link_padding_.clear();
    next->default_link_padding_ = 0.0;
    next->link_scale_.clear();
    next->scaled_.clear();
  }
  next->coverage_.add(change.coverage);
  if (change.clear_objects) {
    const auto clear = [&](auto &objects) {
      for (auto it = objects.begin(); it != objects.end();) {
        const bool kept = std::find(change.kept.begin(), change.kept.end(), it->first) != change.kept.end();
        it = kept ? std::next(it) : objects.erase(it);
      }
    };
    clear(next->objects_);
    clear(next->moving_);
  }
  if (change.clear_attached) next->attached_.clear();
  if (change.clear_allowed) {
    next->allowed_ = std::make_shared<const std::vector<AllowedPair>>();
    next->replaces_srdf_ = true;
  }

  const auto attempt = [&](const std::string &whose, const auto &work) {
    try {
      work();
    } catch (const std::exception &error) {
      faults.push_back(whose + error.what());
    }
  };
  const auto apply_operations = [&] {
    for (std::size_t i = 0; i < change.operations.size(); ++i)
      attempt("object '" + change.operations[i].object.id + "': ", [&] {
        applyOperation(change.operations[i], prepared[i], next->attached_, next->objects_, next->moving_);
      });
  };
  if (!change.attachments_first) apply_operations();
  attempt("", [&] { next->scaleLinks(change.link_scale, resources_); });
  Carrying carrying{next->robot_.get(), next->link_scale_, resources_, next->objects_, next->moving_, next->attached_};
  for (const Attachment &attachment : change.attachments)
    attempt("object '" + attachment.object.id + "': ", [&] { applyAttachment(attachment, carrying); });
  if (change.attachments_first) apply_operations();
  attempt("", [&] {
    checkLinkPaddings(change.link_padding, next->robot_.get());
    if (change.default_link_padding) checkPadding(*change.default_link_padding);
    for (const auto &[link, padding] : change.link_padding) next->link_padding_[link] = padding;
    if (change.default_link_padding) next->default_link_padding_ = *change.default_link_padding;
  });
  attempt("", [&] {
    if (change.allowed.empty()) return;
    next->allowed_ = std::make_shared<const std::vector<AllowedPair>>(mergeAllowed(*next->allowed_, change.allowed));
  });

  // Made in full before it becomes visible.
  next->world_ = std::make_shared<const World>(next->objects_, &before->world());
  if (on_applied && faults.empty()) on_applied(next->version_);
  const std::lock_guard<std::mutex> lock(current_);
  snapshot_ = next;
  return faults;
}

} // namespace curve_proximity
