/* SPDX-License-Identifier: BSD-3-Clause */
#include <curve_proximity/movers.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <set>

#include "answering.h"
#include "motion_data.h"

namespace curve_proximity {
namespace {

using Clock = std::chrono::steady_clock;
using RobotPtr = std::unique_ptr<cprox_robot, void (*)(cprox_robot *)>;
using MotionPtr = std::unique_ptr<cprox_motion, void (*)(cprox_motion *)>;
using Names = std::array<std::string, 2>;

/* A robot of one link and its motion: what the core makes of a moving object. */
struct ObjectMover {
  std::vector<Geometry> geometries; /* own the bodies */
  RobotPtr robot{nullptr, cprox_robot_free};
  MotionPtr motion{nullptr, cprox_motion_free};
};

/* One geometry of the joined robot. */
struct MoverGeometry {
  std::size_t mover = 0;
  std::string name; /* in answers */
  int part = 0;
  double excess = 0.0;
  bool moves = true;
};

void expect(cprox_status status, const std::string &who, const Workspace &workspace) {
  if (status != CPROX_OK) throw Error(who + ": " + workspace.reason(), status);
}

} // namespace

struct Movers::Data {
  SnapshotPtr snapshot;
  std::vector<std::shared_ptr<const RobotMotion>> robots; /* kept */
  std::vector<ObjectMover> objects;
  RobotPtr robot{nullptr, cprox_robot_free};
  MotionPtr motion{nullptr, cprox_motion_free};
  std::vector<MoverGeometry> geometries;
  std::vector<cprox_obstacle> targets;              /* by item of the snapshot */
  std::vector<cprox_robot_pair> environment, among; /* geometry against target, against geometry */
  double rounding = 0.0;                            /* [m] that the core does not know of */
};

namespace {

/* ---- moving objects ---- */

void makeRobot(const MovingObject &mover, const ResourceOptions &resources, ObjectMover &out) {
  const std::string who = "object '" + mover.object.id + "'";
  if (mover.object.shapes.empty()) throw Error(who + " has no shapes");
  if (!(mover.object.padding >= 0.0) || !std::isfinite(mover.object.padding))
    throw Error(who + ": its padding must be finite and not below 0");
  std::vector<cprox_link_geometry> geometries;
  for (const ShapeDescription &shape : mover.object.shapes) {
    try {
      out.geometries.push_back(makeGeometry(shape, resources));
    } catch (const Error &error) {
      throw Error(who + ": " + error.what(), error.status());
    }
    const Geometry &geometry = out.geometries.back();
    if (!geometry.surface) throw Error(who + ": its octree has no occupied cell");
    geometries.push_back({geometry.surface.get(), toPose(shape.pose), 0, mover.object.padding});
  }
  cprox_link link{};
  link.parent = -1;
  link.type = CPROX_JOINT_FLOATING;
  link.origin.orientation.w = 1.0;
  Workspace workspace;
  cprox_robot *made = nullptr;
  expect(cprox_robot_create(&link, 1, geometries.data(), geometries.size(), 7, workspace.get(), &made), who, workspace);
  out.robot.reset(made);
}

void makeMotion(const MovingObject &mover, ObjectMover &out) {
  const std::string who = "object '" + mover.object.id + "'";
  if (mover.poses.empty()) throw Error(who + " has no poses");
  std::vector<std::array<double, 7>> values;
  for (const TimedPose &point : mover.poses) {
    const cprox_pose pose = toPose(point.pose);
    values.push_back({pose.position.x, pose.position.y, pose.position.z, pose.orientation.x, pose.orientation.y,
                      pose.orientation.z, pose.orientation.w});
  }
  static constexpr std::array<std::int32_t, 7> VARIABLES{0, 1, 2, 3, 4, 5, 6};
  std::vector<cprox_waypoint> points;
  for (std::size_t i = 0; i < values.size(); ++i)
    points.push_back({mover.poses[i].time, values[i].data(), nullptr, nullptr});
  cprox_motion_description description{};
  const bool stands = points.size() == 1;
  description.kind = stands ? CPROX_MOTION_STATE : CPROX_MOTION_WAYPOINTS;
  description.rest = stands ? values.front().data() : nullptr;
  description.variables = stands ? nullptr : VARIABLES.data();
  description.n_variables = stands ? 0 : VARIABLES.size();
  description.waypoints = points.data();
  description.n_waypoints = points.size();
  description.turning = mover.turning == Turning::SCREW ? CPROX_TURNING_SCREW : CPROX_TURNING_SLERP;
  Workspace workspace;
  cprox_motion *made = nullptr;
  expect(cprox_motion_create(out.robot.get(), &description, workspace.get(), &made), who, workspace);
  out.motion.reset(made);
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
}

/* Which pairs of names may touch: of movers, or of what belongs to them. */
class Allowed {
 public:
  explicit Allowed(const std::vector<Names> &pairs) {
    for (const Names &pair : pairs) pairs_.insert(ordered(pair[0], pair[1]));
  }

  bool has(const std::string &a, const std::string &b) const {
    for (const std::string &x : {a, moverOf(a)})
      for (const std::string &y : {b, moverOf(b)})
        if (pairs_.count(ordered(x, y)) > 0) return true;
    return false;
  }

 private:
  static Names ordered(const std::string &a, const std::string &b) {
    return a < b ? Names{a, b} : Names{b, a};
  }

  static std::string moverOf(const std::string &name) {
    return name.substr(0, name.find('/'));
  }

  std::set<Names> pairs_;
};

/* ---- joining ---- */

/* The parts of the joined robot, robots first, in the order of their geometries. */
class Joiner {
 public:
  Joiner(const std::vector<MovingRobot> &robots, const std::vector<MovingObject> &objects, Movers::Data &out)
      : robots_(robots), objects_(objects), out_(out) {}

  void join() {
    for (const MovingRobot &robot : robots_) addRobot(robot);
    for (std::size_t i = 0; i < objects_.size(); ++i) addObject(objects_[i], out_.objects[i]);
    Workspace workspace;
    cprox_robot *robot = nullptr;
    expect(cprox_robot_join(cores_.data(), nullptr, cores_.size(), workspace.get(), &robot), "the movers", workspace);
    out_.robot.reset(robot);
    cprox_motion_description description{};
    description.kind = CPROX_MOTION_JOINED;
    description.joined = motions_.data();
    description.n_joined = motions_.size();
    cprox_motion *motion = nullptr;
    expect(cprox_motion_create(robot, &description, workspace.get(), &motion), names(), workspace);
    out_.motion.reset(motion);
  }

 private:
  void addRobot(const MovingRobot &robot) {
    if (!robot.motion) throw Error("robot '" + robot.name + "' has no motion");
    const RobotMotion::Data &data = robot.motion->data();
    const auto first = static_cast<std::int32_t>(out_.geometries.size());
    for (const MovingGeometry &geometry : data.kinematics->geometries) {
      const auto link = static_cast<std::int32_t>(data.kinematics->links.at(*geometry.link));
      const bool moves = data.stands || cprox_motion_get_link_info(data.core.get(), link, -1).n_moved > 0;
      out_.geometries.push_back(
          {cores_.size(), robot.name + "/" + geometry.owner(), geometry.part, geometry.excess, moves});
    }
    for (const cprox_robot_pair &pair : data.self) out_.among.push_back({pair.geometry + first, pair.other + first});
    cores_.push_back(data.kinematics->core.get());
    motions_.push_back({data.core.get(), robot.start});
    names_.push_back(robot.name);
    out_.robots.push_back(robot.motion);
  }

  void addObject(const MovingObject &object, const ObjectMover &made) {
    for (std::size_t i = 0; i < made.geometries.size(); ++i)
      out_.geometries.push_back(
          {cores_.size(), object.object.id, static_cast<int>(i), made.geometries[i].excess, object.poses.size() > 1});
    cores_.push_back(made.robot.get());
    motions_.push_back({made.motion.get(), object.start});
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
  Movers::Data &out_;
  std::vector<const cprox_robot *> cores_;
  std::vector<cprox_joined_motion> motions_;
  std::vector<std::string> names_;
};

/* ---- pairs ---- */

void choosePairs(const Allowed &allowed, Movers::Data &data) {
  const std::vector<MoverGeometry> &geometries = data.geometries;
  const std::vector<Item> &items = data.snapshot->world().items();
  double most = 0.0, rounding = 0.0;
  for (const Item &item : items) {
    const PlacedShape &shape = *item.shape;
    const bool by_hull = shape.is_mesh && cprox_body_get_info(shape.target.body).is_solid;
    data.targets.push_back(by_hull ? shape.hull : shape.target);
    rounding = std::max(rounding, shape.rounding + (by_hull ? shape.hull_excess : 0.0));
  }
  for (std::size_t i = 0; i < geometries.size(); ++i) {
    most = std::max(most, geometries[i].excess);
    const std::size_t mover = geometries[i].mover;
    const std::string &name = geometries[i].name;
    const std::string own = name.substr(name.find('/') + 1); /* in the robot's own snapshot */
    for (std::size_t k = 0; k < items.size() && geometries[i].moves; ++k) {
      const std::string &object = *items[k].owner;
      const bool by_robot = mover < data.robots.size() && data.robots[mover]->data().snapshot->mayTouch(own, object);
      if (!by_robot && !data.snapshot->mayTouch(name, object) && !allowed.has(name, object))
        data.environment.push_back({static_cast<std::int32_t>(i), static_cast<std::int32_t>(k)});
    }
    for (std::size_t k = i + 1; k < geometries.size(); ++k) {
      if (geometries[k].mover == mover || allowed.has(name, geometries[k].name)) continue;
      data.among.push_back({static_cast<std::int32_t>(i), static_cast<std::int32_t>(k)});
    }
  }
  data.rounding = most + std::max(most, rounding);
}

/* ---- queries ---- */

std::string faultOfMovers(const Query &query) {
  if (!query.objects.empty()) return "objects do not apply to movers, '" + query.objects.front() + "' among them";
  if (!query.links.empty()) return "links do not apply to movers, '" + query.links.front() + "' among them";
  if (query.options.certificate) return "a certificate does not apply: movers on one clock have none";
  return faultOfMotion(query, true);
}

cprox_mover moverOf(const Movers::Data &data, Against against) {
  cprox_mover mover = against == Against::MOVERS
                          ? cprox_robot_self(data.motion.get(), data.among.data(), data.among.size())
                          : cprox_robot_along(data.motion.get(), data.environment.data(), data.environment.size());
  if (against == Against::BOTH) {
    mover.kind = CPROX_MOVER_ROBOT_WHOLE;
    mover.self_pairs = data.among.data();
    mover.n_self_pairs = data.among.size();
  }
  return mover;
}

/* What there are pairs of; a list of no pairs would mean all of them. */
Against narrowed(const Movers::Data &data, Against against) {
  if (against != Against::BOTH) return against;
  if (data.environment.empty()) return Against::MOVERS;
  return data.among.empty() ? Against::OBJECTS : Against::BOTH;
}

void nameSides(const Movers::Data &data, Against against, Answer &answer) {
  cprox_result &result = answer.result;
  if (result.status < 0 || result.obstacle_index < 0) return;
  const MoverGeometry &moving = data.geometries[static_cast<std::size_t>(result.mover_part)];
  const std::size_t standing = against == Against::MOVERS ? 0 : data.targets.size();
  const auto index = static_cast<std::size_t>(result.obstacle_index);
  answer.a = moving.name;
  result.mover_part = moving.part;
  if (index < standing) {
    const Item &item = data.snapshot->world().items()[index];
    answer.b = *item.owner;
    result.obstacle_index = item.part;
    return;
  }
  const MoverGeometry &other = data.geometries[index - standing];
  answer.kind = "movers";
  answer.b = other.name;
  answer.b_is_link = other.mover < data.robots.size();
  result.obstacle_index = other.part;
}

template <class Core>
Answer answerOf(const Movers &movers, Against asked, const Query &query, const std::string &fault,
                const Workspace &workspace, Core core) {
  const Movers::Data &data = movers.data();
  const Against against = narrowed(data, asked);
  const std::string kind = against == Against::MOVERS ? "movers" : "environment";
  if (!fault.empty()) return refusal("movers", kind, fault);
  const Clock::time_point start = Clock::now();
  Answer answer;
  answer.id = "movers";
  answer.kind = kind;
  answer.result.obstacle_index = -1;
  if ((against == Against::MOVERS ? data.among : data.environment).empty()) {
    answerNothing(query, answer.result);
  } else {
    const std::vector<cprox_obstacle> none;
    core(moverOf(data, against), against == Against::MOVERS ? none : data.targets, answer.result);
    if (answer.result.status < 0) answer.message = workspace.reason();
    nameSides(data, against, answer);
  }
  answer.microseconds = std::chrono::duration<double, std::micro>(Clock::now() - start).count();
  if (answer.result.status != CPROX_OK && answer.message.empty())
    answer.message = cprox_status_text(answer.result.status);
  answer.status = cprox_status_name(answer.result.status);
  return answer;
}

} // namespace

Movers::Movers(SnapshotPtr snapshot, const std::vector<MovingRobot> &robots, const std::vector<MovingObject> &objects,
               const std::vector<Names> &allowed, const ResourceOptions &resources) {
  checkNames(*snapshot, robots, objects);
  auto data = std::make_unique<Data>();
  data->snapshot = std::move(snapshot);
  for (const MovingObject &object : objects) {
    data->objects.emplace_back();
    makeRobot(object, resources, data->objects.back());
    makeMotion(object, data->objects.back());
  }
  Joiner(robots, objects, *data).join();
  choosePairs(Allowed(allowed), *data);
  data_ = std::move(data);
}

Movers::~Movers() = default;
Movers::Movers(Movers &&) noexcept = default;
Movers &Movers::operator=(Movers &&) noexcept = default;

std::array<double, 2> Movers::domain() const {
  const cprox_motion_info info = cprox_motion_get_info(data_->motion.get());
  return {info.t0, info.t1};
}

Answer ask(const Movers &movers, Against against, const Query &query, Workspace &workspace) {
  const double rounding = movers.data().rounding;
  return answerOf(movers, against, query, faultOfMovers(query), workspace,
                  [&](const cprox_mover &mover, const std::vector<cprox_obstacle> &targets, cprox_result &result) {
                    const cprox_options options = withoutRounding(query.options, rounding);
                    result.status = askCore(query, options, mover, targets, workspace, result);
                    if (result.status >= 0) widen(query, rounding, std::numeric_limits<double>::infinity(), result);
                  });
}

Answer timeOfContact(const Movers &movers, Against against, const Query &query, Workspace &workspace) {
  std::string fault = faultOfMovers(query);
  if (fault.empty()) fault = faultOfContact(query);
  const auto core = [&](const cprox_mover &mover, const std::vector<cprox_obstacle> &targets, cprox_result &result) {
    /* what is nearer than the rounding may be in contact: standing bodies grow by it */
    std::vector<cprox_obstacle> grown = targets;
    for (cprox_obstacle &target : grown) target.margin += movers.data().rounding;
    ObstaclesHandle obstacles;
    result.status = makeObstacles(grown, CPROX_INDEX_NONE, workspace, obstacles);
    if (result.status >= 0)
      result.status = cprox_obstacles_time_of_contact(obstacles.get(), mover, &query.options, workspace.get(), &result);
  };
  return answerOf(movers, against, query, fault, workspace, core);
}

} // namespace curve_proximity
