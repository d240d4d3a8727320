/* SPDX-License-Identifier: BSD-3-Clause */
/* Robots and objects that move are joined into one robot on one clock; and which of their pairs are tested. */
#include <curve_proximity/movers.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <curve_proximity/nearest_name.hpp>
#include <set>

#include "motion_data.h"
#include "movers_data.h"
#include "world/world.h"

namespace curve_proximity {
namespace {

using TwoNames = std::array<std::string, 2>;

void expect(cprox_status status, const std::string &who, const Workspace &workspace) {
  if (status != CPROX_OK) throw Error(who + ": " + workspace.reason(), status);
}

/* ---- moving objects ---- */

std::shared_ptr<const MovingBody> bodyOf(const MovingObject &mover, const ResourceOptions &resources) {
  if (mover.body) return mover.body;
  try {
    std::vector<Geometry> geometries;
    for (const ShapeDescription &shape : mover.object.shapes) geometries.push_back(makeGeometry(shape, resources));
    return makeMovingBody(mover.object, std::move(geometries), mover.poses, mover.turning);
  } catch (const Error &error) {
    throw Error("object '" + mover.object.id + "': " + error.what(), error.status());
  }
}

/* ---- names ---- */

void checkNames(const Snapshot &snapshot, const std::vector<MovingRobot> &robots,
                const std::vector<MovingObject> &objects) {
  std::set<std::string> known;
  const auto check = [&](const std::string &name) {
    if (name.empty()) throw Error("a mover has no name");
    if (name.find('/') != std::string::npos) throw Error("'" + name + "' is no name of a mover: it contains '/'");
    if (!known.insert(name).second) throw Error("two movers are named '" + name + "'");
    if (snapshot.objects().count(name) > 0)
      throw Error("'" + name + "' is a mover and an object that stands: names must differ");
  };
  for (const MovingRobot &robot : robots) check(robot.name);
  for (const MovingObject &object : objects) check(object.object.id);
  if (known.empty()) throw Error("nothing moves: there is no mover");
  for (const auto &[id, object] : snapshot.moving())
    if (known.count(id) == 0) throw Error("object '" + id + "' moves in the scene, and is none of the movers");
}

/* Which pairs of names may touch: of movers, or of what belongs to them. */
class Allowed {
 public:
  explicit Allowed(const std::vector<TwoNames> &pairs) {
    for (const TwoNames &pair : pairs) pairs_.insert(ordered(pair[0], pair[1]));
  }

  void addNames(std::set<std::string> &names) const {
    for (const auto &pair : pairs_) names.insert(pair.begin(), pair.end());
  }

  bool has(const std::string &a, const std::string &b) const {
    for (const std::string &x : {a, moverOf(a)})
      for (const std::string &y : {b, moverOf(b)})
        if (pairs_.count(ordered(x, y)) > 0) return true;
    return false;
  }

 private:
  static TwoNames ordered(const std::string &a, const std::string &b) {
    return a < b ? TwoNames{a, b} : TwoNames{b, a};
  }

  std::set<TwoNames> pairs_;
};

/* ---- joining ---- */

/* The parts of the joined robot, robots first, in the order of their geometries. */
class Joiner {
 public:
  Joiner(const std::vector<MovingRobot> &robots, const std::vector<MovingObject> &objects, const Stop &stop,
         Movers::Data &out)
      : robots_(robots), objects_(objects), stop_(stop), out_(out) {}

  void join() {
    const bool moves = std::any_of(robots_.begin(), robots_.end(),
                                   [](const MovingRobot &robot) { return robot.motion && !robot.motion->stands(); }) ||
                       std::any_of(objects_.begin(), objects_.end(),
                                   [](const MovingObject &object) { return object.poses.size() != 1; });
    for (const MovingRobot &robot : robots_) addRobot(robot);
    for (std::size_t i = 0; i < objects_.size(); ++i) addObject(objects_[i], *out_.objects[i]);
    if (!moves) throw Error("nothing moves: each mover has one pose, '" + names_.front() + "' among them");
    Workspace workspace;
    if (stop_) {
      const auto call = [](void *user) { return (*static_cast<const Stop *>(user))(); };
      cprox_workspace_set_stop(workspace.get(), call, const_cast<Stop *>(&stop_));
    }
    cprox_robot *robot = nullptr;
    expect(cprox_robot_join(cores_.data(), nullptr, cores_.size(), workspace.get(), &robot), "the movers", workspace);
    out_.robot.reset(robot);
    cprox_motion_description description{};
    description.kind = CPROX_MOTION_JOINED;
    description.joined = motions_.data();
    description.n_joined = motions_.size();
    cprox_motion *motion = nullptr;
    const cprox_status made = cprox_motion_create(robot, &description, workspace.get(), &motion);
    if (made != CPROX_OK && stop_ && stop_()) throw Error("stopped while the movers were being joined");
    expect(made, names(), workspace);
    out_.motion.reset(motion);
  }

 private:
  void addRobot(const MovingRobot &robot) {
    if (!robot.motion) throw Error("robot '" + robot.name + "' has no motion");
    const RobotMotion::Data &data = robot.motion->data();
    out_.coverage.add(data.coverage);
    const auto first = static_cast<std::int32_t>(out_.geometries.size());
    for (const MovingGeometry &geometry : data.kinematics->geometries) {
      const bool moves = data.moves[out_.geometries.size() - static_cast<std::size_t>(first)];
      out_.geometries.push_back({cores_.size(), robot.name + "/" + geometry.owner(), geometry.part, geometry.excess,
                                 moves, false, geometry.is_mesh, geometry.within});
    }
    for (const cprox_robot_pair &pair : data.self) out_.among.push_back({pair.geometry + first, pair.other + first});
    out_.among_moves.insert(out_.among_moves.end(), data.self_moves.begin(), data.self_moves.end());
    cores_.push_back(data.kinematics->core.get());
    motions_.push_back({data.core.get(), robot.start, robot.tolerance});
    names_.push_back(robot.name);
    out_.robots.push_back(robot.motion);
    out_.robot_names.push_back(robot.name);
  }

  void addObject(const MovingObject &object, const MovingBody &made) {
    for (std::size_t i = 0; i < made.geometries.size(); ++i)
      out_.geometries.push_back({cores_.size(), object.object.id, static_cast<int>(i), made.geometries[i].excess,
                                 object.poses.size() > 1, true, made.geometries[i].is_mesh});
    cores_.push_back(made.robot.get());
    motions_.push_back({made.motion.get(), object.start, object.tolerance});
    names_.push_back(object.object.id);
  }

  /* The core numbers motions. */
  std::string names() const {
    std::string out = "motions";
    for (std::size_t i = 0; i < names_.size(); ++i)
      out += (i > 0 ? ", " : " ") + std::to_string(i) + " = '" + names_[i] + "'";
    return out;
  }

  const std::vector<MovingRobot> &robots_;
  const std::vector<MovingObject> &objects_;
  const Stop &stop_;
  Movers::Data &out_;
  std::vector<const cprox_robot *> cores_;
  std::vector<cprox_joined_motion> motions_;
  std::vector<std::string> names_;
};

/* ---- pairs ---- */

/* Does the snapshot of the robot that the geometry belongs to let it touch the object? */
bool mayTouchInOwn(const Movers::Data &data, const MoverGeometry &geometry, const std::string &object) {
  if (geometry.mover >= data.robots.size()) return false;
  const std::string link = geometry.name.substr(geometry.name.find('/') + 1);
  return data.robots[geometry.mover]->data().snapshot->mayTouch(link, object);
}

/* The same of an object that moves. */
bool ownMayTouch(const Movers::Data &data, std::size_t i, std::size_t object) {
  const MoverGeometry &other = data.geometries[object];
  return other.mover >= data.robots.size() && mayTouchInOwn(data, data.geometries[i], other.name);
}

/* By the scene's list, where the robot's own one has no entry of the pair that forbids it: an entry of a pair wins over
 * the defaults of names, and the names of this list are other ones. */
bool mayTouchInScene(const Movers::Data &data, const MoverGeometry &geometry, const std::string &object) {
  if (!data.snapshot->mayTouch(geometry.name, object)) return false;
  if (geometry.mover >= data.robots.size()) return true;
  const std::string link = geometry.name.substr(geometry.name.find('/') + 1);
  for (const AllowedPair &pair : data.robots[geometry.mover]->data().snapshot->allowed()) {
    const bool same = (pair.a == link && pair.b == object) || (pair.a == object && pair.b == link);
    if (same && !pair.allowed) return false;
  }
  return true;
}

/* Of each geometry whether some list of allowed pairs has a name of it: two of which none has may not touch. */
std::vector<bool> namedAnywhere(const Allowed &allowed, const Movers::Data &data) {
  std::set<std::string> names;
  allowed.addNames(names);
  const auto add = [&](const Snapshot &snapshot) {
    for (const AllowedPair &pair : snapshot.allowed()) names.insert(pair.a), names.insert(pair.b);
  };
  add(*data.snapshot);
  for (const auto &robot : data.robots) add(*robot->data().snapshot);
  std::vector<bool> out;
  for (const MoverGeometry &geometry : data.geometries) {
    const std::string mover = moverOf(geometry.name);
    const std::string link = geometry.name.substr(std::min(mover.size() + 1, geometry.name.size()));
    out.push_back(names.count(geometry.name) + names.count(mover) + names.count(link) > 0);
  }
  return out;
}

void choosePairs(const Allowed &allowed, const Stop &stop, Movers::Data &data) {
  const std::vector<MoverGeometry> &geometries = data.geometries;
  const std::vector<Item> &items = data.snapshot->world().items();
  double most = 0.0, rounding = 0.0;
  for (const Item &item : items) {
    const PlacedShape &shape = *item.shape;
    requireBody(item);
    data.obstacles.push_back(shape.obstacle);
    rounding = std::max(rounding, shape.rounding);
  }
  const std::vector<bool> named = namedAnywhere(allowed, data);
  for (std::size_t i = 0; i < geometries.size(); ++i) {
    if (stop && stop()) throw Error("stopped while the pairs of the movers were being listed");
    most = std::max(most, geometries[i].excess);
    if (geometries[i].within) continue;
    const std::size_t mover = geometries[i].mover;
    const std::string &name = geometries[i].name;
    for (std::size_t k = 0; k < items.size(); ++k) {
      const std::string &object = *items[k].owner;
      if (!mayTouchInOwn(data, geometries[i], object) && !mayTouchInScene(data, geometries[i], object) &&
          !allowed.has(name, object))
        data.environment.push_back({static_cast<std::int32_t>(i), static_cast<std::int32_t>(k)});
    }
    for (std::size_t k = i + 1; k < geometries.size(); ++k) {
      if (geometries[k].mover == mover || geometries[k].within) continue;
      if ((named[i] || named[k]) &&
          (allowed.has(name, geometries[k].name) ||
           (mayTouchInScene(data, geometries[i], geometries[k].name) && mayTouchInScene(data, geometries[k], name)) ||
           ownMayTouch(data, i, k) || ownMayTouch(data, k, i)))
        continue;
      data.among.push_back({static_cast<std::int32_t>(i), static_cast<std::int32_t>(k)});
      data.among_moves.push_back(geometries[i].moves || geometries[k].moves);
    }
  }
  data.rounding = most + std::max(most, rounding);
}

} // namespace

Movers::Movers(SnapshotPtr snapshot, const std::vector<MovingRobot> &robots, const std::vector<MovingObject> &objects,
               const std::vector<TwoNames> &allowed, const ResourceOptions &resources, const Stop &stop) {
  checkNames(*snapshot, robots, objects);
  auto data = std::make_unique<Data>();
  data->snapshot = std::move(snapshot);
  data->coverage = coverageOf(*data->snapshot);
  for (const MovingObject &object : objects) {
    data->objects.push_back(bodyOf(object, resources));
    data->object_names.push_back(object.object.id);
    data->object_starts.push_back(object.start);
  }
  Joiner(robots, objects, stop, *data).join();
  choosePairs(Allowed(allowed), stop, *data);
  data_ = std::move(data);
}

Movers::~Movers() = default;
Movers::Movers(Movers &&) noexcept = default;
Movers &Movers::operator=(Movers &&) noexcept = default;

MovingObject carriedObject(const Snapshot &snapshot, const std::string &id, std::vector<TimedPose> poses,
                           Turning turning) {
  const auto found = snapshot.attached().find(id);
  if (found == snapshot.attached().end())
    throw Error("no link carries an object '" + id + "'" + didYouMean(id, namesOf(snapshot.attached())));
  const AttachedObject &carried = *found->second;
  MovingObject out;
  out.object = carried.description;
  out.object.pose = Eigen::Isometry3d::Identity();
  out.object.padding = snapshot.attachedPadding(carried);
  std::vector<Geometry> geometries;
  for (std::size_t i = 0; i < carried.shapes.size(); ++i) {
    out.object.shapes[i] = carried.shapes[i].description;
    out.object.shapes[i].pose = carried.shapes[i].pose;
    geometries.push_back(carried.shapes[i].geometry);
  }
  out.poses = std::move(poses);
  out.turning = turning;
  try {
    out.body = makeMovingBody(out.object, std::move(geometries), out.poses, turning);
  } catch (const Error &error) {
    throw Error("object '" + id + "': " + error.what(), error.status());
  }
  return out;
}

std::vector<MovingObject> movingObjects(const Snapshot &snapshot, std::int64_t origin) {
  constexpr double NANOSECOND = 1e-9;
  std::vector<MovingObject> out;
  for (const auto &[id, object] : snapshot.moving()) {
    MovingObject mover;
    mover.object = object->description;
    mover.poses = object->trajectory.poses;
    mover.turning = object->trajectory.turning;
    if (object->trajectory.start != 0)
      mover.start = NANOSECOND * static_cast<double>(object->trajectory.start - origin);
    mover.tolerance = object->trajectory.tolerance;
    mover.body = object->body;
    out.push_back(std::move(mover));
  }
  return out;
}

void checkClocks(const MovingRobot &subject, const std::vector<MovingRobot> &robots,
                 const std::vector<MovingObject> &objects) {
  if (subject.motion->stands()) return;
  const auto domain = subject.motion->domain();
  const double begin = domain[0] + subject.start - subject.tolerance,
               end = domain[1] + subject.start + subject.tolerance;
  const auto check = [&](const std::string &who, double earliest, double latest, double tolerance) {
    const double first = earliest - tolerance, last = latest + tolerance;
    char seconds[40];
    if (last < begin) {
      std::snprintf(seconds, sizeof seconds, "%.6g", begin - last);
      throw Error(who + ": its trajectory is stale: it ends " + seconds + " s before that of '" + subject.name +
                  "' begins");
    }
    if (first > end) {
      std::snprintf(seconds, sizeof seconds, "%.6g", first - end);
      throw Error(who + ": its trajectory is in the future: it begins " + seconds + " s after that of '" +
                  subject.name + "' has ended");
    }
  };
  for (const MovingRobot &robot : robots) {
    if (!robot.motion || robot.motion->stands()) continue;
    const auto of = robot.motion->domain();
    check("robot '" + robot.name + "'", of[0] + robot.start, of[1] + robot.start, robot.tolerance);
  }
  for (const MovingObject &object : objects)
    if (object.poses.size() > 1)
      check("object '" + object.object.id + "'", object.poses.front().time + object.start,
            object.poses.back().time + object.start, object.tolerance);
}

std::array<double, 2> Movers::domain() const {
  const cprox_motion_info info = cprox_motion_get_info(data_->motion.get());
  return {info.t0, info.t1};
}

Eigen::Isometry3d Movers::objectPose(const std::string &name, double t) const {
  const auto found = std::find(data_->object_names.begin(), data_->object_names.end(), name);
  if (found == data_->object_names.end()) throw Error("'" + name + "' is no moving object");
  const auto i = static_cast<std::size_t>(found - data_->object_names.begin());
  const MovingBody &body = *data_->objects[i];
  const cprox_motion_info info = cprox_motion_get_info(body.motion.get());
  std::array<double, 7> values{};
  cprox_motion_evaluate(body.motion.get(), std::clamp(t - data_->object_starts[i], info.t0, info.t1), values.data());
  cprox_vec3 position;
  Eigen::Matrix<double, 3, 3, Eigen::RowMajor> rotation;
  cprox_robot_link_frame(body.robot.get(), values.data(), 0, &position, rotation.data());
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = rotation;
  pose.translation() = toEigen(position);
  return pose;
}

} // namespace curve_proximity
