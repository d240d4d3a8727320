/* SPDX-License-Identifier: BSD-3-Clause */
#include "collision_env.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <limits>

#include <ros/console.h>

namespace curve_proximity {
namespace {

namespace cd = collision_detection;

constexpr char LOG[] = "collision_detection.curve_proximity";
constexpr double INFINITE = std::numeric_limits<double>::infinity();
constexpr std::chrono::seconds COMPLAIN_PERIOD{5};
constexpr std::chrono::milliseconds OCTREE_PERIOD{100};
constexpr std::size_t KEPT_PREPARED = 4; /* robots: with and without an attached object, and with another matrix */

Workspace &workspace() {
  thread_local Workspace own;
  return own;
}

cd::BodyType typeOf(BodyOwner owner) {
  switch (owner) {
    case BodyOwner::LINK: return cd::BodyTypes::ROBOT_LINK;
    case BodyOwner::ATTACHED: return cd::BodyTypes::ROBOT_ATTACHED;
    case BodyOwner::OBJECT: break;
  }
  return cd::BodyTypes::WORLD_OBJECT;
}

std::pair<std::string, std::string> keyOf(const std::string &a, const std::string &b) {
  return a < b ? std::make_pair(a, b) : std::make_pair(b, a);
}

bool touches(const NearPair &near) {
  return near.result.verdict != CPROX_VERDICT_CLEAR;
}

/* MoveIt's normals go from the first body to the second one, ours back. */
cd::Contact toContact(const NearPair &near) {
  const cprox_result &result = near.result;
  cd::Contact out;
  out.nearest_points[0] = toEigen(result.witness_mover);
  out.nearest_points[1] = toEigen(result.witness_obstacle);
  out.pos = 0.5 * (out.nearest_points[0] + out.nearest_points[1]);
  out.normal = -toEigen(result.normal);
  out.depth = std::max(0.0, -result.lower);
  out.percent_interpolation = 0.0;
  out.body_name_1 = *near.a.name;
  out.body_type_1 = typeOf(near.a.owner);
  out.body_name_2 = *near.b.name;
  out.body_type_2 = typeOf(near.b.owner);
  return out;
}

cd::DistanceResultsData toDistance(const NearPair &near) {
  const cprox_result &result = near.result;
  cd::DistanceResultsData out;
  out.distance = result.lower;
  out.nearest_points[0] = toEigen(result.witness_mover);
  out.nearest_points[1] = toEigen(result.witness_obstacle);
  out.normal = -toEigen(result.normal);
  out.link_names[0] = *near.a.name;
  out.link_names[1] = *near.b.name;
  out.body_types[0] = typeOf(near.a.owner);
  out.body_types[1] = typeOf(near.b.owner);
  return out;
}

/* Does the matrix let these two touch here? */
bool isAllowedContact(const cd::AllowedCollisionMatrix *acm, cd::Contact &contact) {
  cd::DecideContactFn decide;
  return acm && acm->getAllowedCollision(contact.body_name_1, contact.body_name_2, decide) && decide(contact);
}

/* Takes contacts as the request wants them, and says when it has enough. */
class Collector {
 public:
  Collector(const cd::CollisionRequest &req, cd::CollisionResult &res) : req_(req), res_(res) {}

  /* Is another contact wanted? */
  bool add(const cd::Contact &contact) {
    res_.collision = true;
    if (req_.contacts && res_.contact_count < req_.max_contacts) {
      std::vector<cd::Contact> &of_pair = res_.contacts[keyOf(contact.body_name_1, contact.body_name_2)];
      if (of_pair.size() < req_.max_contacts_per_pair) {
        of_pair.push_back(contact);
        ++res_.contact_count;
      }
    }
    if (req_.verbose)
      ROS_INFO_STREAM_NAMED(LOG, "'" << contact.body_name_1 << "' touches '" << contact.body_name_2 << "'");
    return req_.contacts && res_.contact_count < req_.max_contacts && !(req_.is_done && req_.is_done(res_));
  }

 private:
  const cd::CollisionRequest &req_;
  cd::CollisionResult &res_;
};

/* Seldom, by a clock of its own: ROS's throttle needs ROS time, which may not have begun, or stand still. */
void warn(const std::string &what) {
  using Clock = std::chrono::steady_clock;
  static std::atomic<Clock::rep> next{std::numeric_limits<Clock::rep>::min()};
  const Clock::rep now = Clock::now().time_since_epoch().count();
  Clock::rep due = next;
  if (now >= due && next.compare_exchange_strong(due, now + Clock::duration(COMPLAIN_PERIOD).count()))
    ROS_ERROR_STREAM_NAMED(LOG, what);
}

/* What cannot be answered counts as a collision. */
void fail(const std::string &why, cd::CollisionResult &res) {
  warn(why + ": the state counts as in collision");
  res.collision = true;
  res.distance = std::min(res.distance, 0.0);
}

void fail(const std::string &why, cd::DistanceResult &res) {
  warn(why + ": the distance counts as 0");
  res.collision = true;
  res.minimum_distance.distance = std::min(res.minimum_distance.distance, 0.0);
}

bool sameAllowed(const std::vector<AllowedPair> &a, const std::vector<AllowedPair> &b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const AllowedPair &x, const AllowedPair &y) {
    return x.allowed == y.allowed && x.a == y.a && x.b == y.b;
  });
}

bool samePoses(const ObjectDescription &object, const cd::World::Object &world) {
  if (object.shapes.size() != world.shape_poses_.size()) return false;
  for (std::size_t i = 0; i < object.shapes.size(); ++i)
    if (object.shapes[i].pose.matrix() != world.shape_poses_[i].matrix()) return false;
  return true;
}

bool isEmpty(const SceneChange &change) {
  return change.operations.empty() && change.link_padding.empty() && change.link_scale.empty();
}

} // namespace

/* ---- the scene ---- */

CollisionEnvCurveProximity::CollisionEnvCurveProximity(const moveit::core::RobotModelConstPtr &model, double padding,
                                                       double scale)
    : CollisionEnvCurveProximity(model, std::make_shared<cd::World>(), padding, scale) {}

CollisionEnvCurveProximity::CollisionEnvCurveProximity(const moveit::core::RobotModelConstPtr &model,
                                                       const cd::WorldPtr &world, double padding, double scale)
    : CollisionEnv(model, world, padding, scale),
      robot_(toRobot(*model)),
      links_(linksInOrder(*robot_, *model)),
      base_(virtualJoints(*model)),
      shapes_(std::make_shared<KnownShapes>()),
      scene_(std::make_unique<Scene>(robot_)) {
  observe();
  getWorld()->notifyObserverAllObjects(observer_, cd::World::CREATE);
}

CollisionEnvCurveProximity::CollisionEnvCurveProximity(const CollisionEnvCurveProximity &other,
                                                       const cd::WorldPtr &world)
    : CollisionEnv(other, world),
      robot_(other.robot_),
      links_(other.links_),
      base_(other.base_),
      shapes_(other.shapes_) {
  {
    const std::lock_guard<std::mutex> lock(other.mutex_);
    other.applyChanges();
    scene_ = std::make_unique<Scene>(other.scene_->snapshot());
    taken_ = other.taken_;
    faults_ = other.faults_;
    cells_ = other.cells_;
    octrees_compared_ = other.octrees_compared_;
    resized_ = false;
    standing_ = other.standing_;
    bodies_ = other.bodies_;
    prepared_ = other.prepared_;
  }
  compareWorld(*world);
  observe();
}

CollisionEnvCurveProximity::~CollisionEnvCurveProximity() {
  getWorld()->removeObserver(observer_);
}

void CollisionEnvCurveProximity::observe() {
  observer_ = getWorld()->addObserver([this](const cd::World::ObjectConstPtr &object, cd::World::Action action) {
    const std::lock_guard<std::mutex> lock(mutex_);
    const bool only_moved = action == cd::World::MOVE_SHAPE && changed_.count(object->id_) == 0;
    (only_moved ? moved_ : changed_).insert(object->id_);
  });
}

/* Objects of MoveIt's world are replaced when they are changed while somebody else has them. */
void CollisionEnvCurveProximity::compareWorld(const cd::World &world) {
  for (const auto &[id, object] : taken_)
    if (world.getObject(id) != object) changed_.insert(id);
  for (const auto &[id, object] : world) {
    const auto taken = taken_.find(id);
    if (taken == taken_.end() || taken->second != object) changed_.insert(id);
  }
}

void CollisionEnvCurveProximity::setWorld(const cd::WorldPtr &world) {
  if (world == getWorld()) return;
  getWorld()->removeObserver(observer_);
  CollisionEnv::setWorld(world);
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    compareWorld(*world);
    if (faults_.count("") > 0) resized_ = true; // so that it is told again
  }
  observe();
}

void CollisionEnvCurveProximity::updatedPaddingOrScaling(const std::vector<std::string> &) {
  const std::lock_guard<std::mutex> lock(mutex_);
  resized_ = true;
}

/* Which objects have octrees that were changed in place? */
void CollisionEnvCurveProximity::compareOctrees(bool now) const {
  const auto time = std::chrono::steady_clock::now();
  if (cells_.empty() || (!now && time - octrees_compared_ < OCTREE_PERIOD)) return;
  octrees_compared_ = time;
  for (const auto &[id, cells] : cells_)
    if (cellsOf(*taken_.at(id)) != cells) changed_.insert(id);
}

/* One change for all that has come since the last query. An object that cannot be taken over leaves a fault. */
void CollisionEnvCurveProximity::applyChanges() const {
  if (!resized_ && changed_.empty() && moved_.empty()) return;
  const SnapshotPtr before = scene_->snapshot();
  SceneChange change;
  if (resized_) {
    faults_.erase("");
    const auto knows = [this](const std::string &link) {
      if (robot_->links().count(link) > 0) return true;
      ROS_WARN_STREAM_NAMED(LOG, "a padding or scale is not used: the robot has no link '" << link << "'");
      return false;
    };
    for (const auto &[link, padding] : getLinkPadding())
      if (knows(link) && padding != before->linkPadding(link)) change.link_padding[link] = padding;
    for (const auto &[link, scale] : getLinkScale()) {
      const auto known = before->linkScales().find(link);
      if (scale == (known == before->linkScales().end() ? 1.0 : known->second)) continue;
      if (knows(link)) change.link_scale[link] = scale;
    }
  }
  for (const std::string &id : moved_)
    if (changed_.count(id) == 0) changeObject(id, true, *before, change);
  for (const std::string &id : changed_) changeObject(id, false, *before, change);
  changed_.clear();
  moved_.clear();
  resized_ = false;
  if (isEmpty(change)) return;
  standing_.reset();
  if (scene_->apply(change).empty()) return;

  /* One by one, to tell whose fault it is; what cannot be taken over must not stay as it was before. */
  for (const Operation &operation : change.operations) {
    SceneChange one;
    one.operations = {operation};
    const std::vector<std::string> faults = scene_->apply(one);
    if (faults.empty()) continue;
    faults_[operation.object.id] = faults.front();
    one.operations.front().kind = Operation::Kind::REMOVE;
    scene_->apply(one);
  }
  change.operations.clear();
  const std::vector<std::string> faults = scene_->apply(change);
  if (!faults.empty()) faults_[""] = faults.front();
}

void CollisionEnvCurveProximity::changeObject(const std::string &id, bool only_moved, const Snapshot &before,
                                              SceneChange &change) const {
  const bool was_faulty = faults_.erase(id) > 0; // then the scene may have what stood there before
  const cd::World::ObjectConstPtr object = getWorld()->getObject(id);
  const auto known = before.objects().find(id);
  Operation operation;
  operation.object.id = id;
  if (object) {
    taken_[id] = object;
  } else {
    taken_.erase(id);
  }
  if (object && only_moved && !was_faulty && known != before.objects().end() &&
      samePoses(known->second->description, *object)) {
    operation.kind = Operation::Kind::MOVE;
    operation.object.pose = object->pose_;
    change.operations.push_back(operation);
    return; // with the cells that it had: if there are others now, that is seen later
  }
  cells_.erase(id);
  if (!object || object->shapes_.empty()) {
    operation.kind = Operation::Kind::REMOVE;
    if (known != before.objects().end()) change.operations.push_back(operation);
    return;
  }
  if (const std::uint64_t cells = cellsOf(*object)) cells_[id] = cells;
  try {
    operation.object = toObject(*object, *shapes_);
    change.operations.push_back(operation);
  } catch (const Error &error) {
    faults_[id] = "object '" + id + "': " + error.what();
  }
}

/* ---- one query ---- */

/* Links are found in a state by their number. */
void CollisionEnvCurveProximity::checkModel(const State &state) const {
  const moveit::core::RobotModelConstPtr &other = state.getRobotModel();
  if (other != robot_model_ && other->getLinkModelNames() != robot_model_->getLinkModelNames())
    throw Error("a state of robot '" + other->getName() + "' in a scene of robot '" + robot_model_->getName() + "'");
}

CollisionEnvCurveProximity::Current CollisionEnvCurveProximity::current(const State &state, bool sees_octrees) const {
  checkModel(state);
  const std::lock_guard<std::mutex> lock(mutex_);
  compareOctrees(sees_octrees);
  applyChanges();
  const SnapshotPtr scene = scene_->snapshot();
  Current out{scene, bodies_.of(state, *scene, *shapes_), {}};
  for (const auto &[id, fault] : faults_) out.fault += (out.fault.empty() ? "" : "; ") + fault;
  return out;
}

/* Another thread may have changed the scene since: the robot is that of the query's. */
std::shared_ptr<const StandingRobot> CollisionEnvCurveProximity::standing(const Current &now) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (standing_ && standing_->snapshot() == now.scene) return standing_;
  const auto out = std::make_shared<const StandingRobot>(now.scene);
  if (now.scene == scene_->snapshot()) standing_ = out;
  return out;
}

RobotPlacement CollisionEnvCurveProximity::placement(const State &state, AttachedObjects attached) const {
  RobotPlacement out;
  out.links.reserve(links_.size());
  for (const moveit::core::LinkModel *link : links_) out.links.push_back(state.getGlobalLinkTransform(link));
  out.attached = std::move(attached);
  return out;
}

std::set<std::string> CollisionEnvCurveProximity::linksOf(const std::string &group) const {
  std::set<std::string> out;
  if (!robot_model_->hasJointModelGroup(group)) return out;
  for (const moveit::core::LinkModel *link : robot_model_->getJointModelGroup(group)->getUpdatedLinkModelsSet())
    out.insert(link->getName());
  return out;
}

void CollisionEnvCurveProximity::check(const Request &req, Result &res, const State &state, const Matrix *acm,
                                       RobotPairs pairs) const {
  try {
    Current now = current(state, false);
    if (!now.fault.empty() && pairs != RobotPairs::SELF) fail(now.fault, res);
    const RobotPlacement robot = placement(state, std::move(now.attached));
    NearPairsQuery query;
    query.pairs = pairs;
    query.links = linksOf(req.group_name);
    query.carriers = true;
    query.verdicts_only = !req.contacts;
    query.may_touch = [acm](const std::string &a, const std::string &b) { return acm && alwaysAllowed(*acm, a, b); };
    Collector collector(req, res);
    standing(now)->visit(robot, query, workspace(), [&](const NearPair &near) {
      if (!touches(near)) return 0.0;
      cd::Contact contact = toContact(near);
      return isAllowedContact(acm, contact) || collector.add(contact) ? 0.0 : -1.0;
    });
  } catch (const std::exception &error) {
    fail(error.what(), res);
  }
  if (!req.distance) return;
  cd::DistanceRequest distance;
  cd::DistanceResult found;
  distance.group_name = req.group_name;
  distance.acm = acm;
  distance.enableGroup(robot_model_);
  distances(distance, found, state, pairs);
  res.distance = std::min(res.distance, found.minimum_distance.distance);
  if (req.detailed_distance) res.distance_result = found;
}

void CollisionEnvCurveProximity::distances(const cd::DistanceRequest &req, cd::DistanceResult &res, const State &state,
                                           RobotPairs pairs) const {
  const bool global = req.type == cd::DistanceRequestType::GLOBAL;
  const std::size_t of_pair = req.type == cd::DistanceRequestType::SINGLE ? 1 : req.max_contacts_per_body;
  try {
    Current now = current(state, false);
    if (!now.fault.empty() && pairs != RobotPairs::SELF) fail(now.fault, res);
    const RobotPlacement robot = placement(state, std::move(now.attached));
    NearPairsQuery query;
    query.pairs = pairs;
    query.reach = req.distance_threshold >= std::numeric_limits<double>::max() ? INFINITE : req.distance_threshold;
    query.carriers = true;
    if (req.active_components_only)
      for (const moveit::core::LinkModel *link : *req.active_components_only) query.links.insert(link->getName());
    query.may_touch = [&req](const std::string &a, const std::string &b) {
      return req.acm && alwaysAllowed(*req.acm, a, b);
    };
    standing(now)->visit(robot, query, workspace(), [&](const NearPair &near) {
      const cd::DistanceResultsData found = toDistance(near);
      if (found.distance < res.minimum_distance.distance) res.minimum_distance = found;
      res.collision = res.collision || touches(near);
      if (global) return std::max(0.0, res.minimum_distance.distance);
      std::vector<cd::DistanceResultsData> &list = res.distances[keyOf(found.link_names[0], found.link_names[1])];
      list.insert(std::upper_bound(list.begin(), list.end(), found,
                                   [](cd::DistanceResultsData a, const cd::DistanceResultsData &b) { return a < b; }),
                  found);
      if (list.size() > of_pair) list.pop_back();
      return query.reach;
    });
  } catch (const std::exception &error) {
    fail(error.what(), res);
  }
}

void CollisionEnvCurveProximity::checkSelfCollision(const Request &req, Result &res, const State &state) const {
  check(req, res, state, nullptr, RobotPairs::SELF);
}

void CollisionEnvCurveProximity::checkSelfCollision(const Request &req, Result &res, const State &state,
                                                    const Matrix &acm) const {
  check(req, res, state, &acm, RobotPairs::SELF);
}

void CollisionEnvCurveProximity::checkRobotCollision(const Request &req, Result &res, const State &state) const {
  check(req, res, state, nullptr, RobotPairs::ENVIRONMENT);
}

void CollisionEnvCurveProximity::checkRobotCollision(const Request &req, Result &res, const State &state,
                                                     const Matrix &acm) const {
  check(req, res, state, &acm, RobotPairs::ENVIRONMENT);
}

void CollisionEnvCurveProximity::distanceSelf(const cd::DistanceRequest &req, cd::DistanceResult &res,
                                              const State &state) const {
  distances(req, res, state, RobotPairs::SELF);
}

void CollisionEnvCurveProximity::distanceRobot(const cd::DistanceRequest &req, cd::DistanceResult &res,
                                               const State &state) const {
  distances(req, res, state, RobotPairs::ENVIRONMENT);
}

/* ---- motions ---- */

/* Planners ask about many motions in one scene with one matrix: the last robots are kept. */
CollisionEnvCurveProximity::Ready CollisionEnvCurveProximity::prepared(const Current &now, const State &at,
                                                                       const std::vector<std::string> &joints,
                                                                       const Matrix *acm) const {
  const SnapshotPtr &scene = now.scene;
  const moveit::core::JointModel &root = *robot_model_->getRootJoint();
  const bool base_moves =
      std::any_of(joints.begin(), joints.end(), [&root](const std::string &name) { return root.hasVariable(name); });
  const Eigen::Isometry3d base = base_moves ? Eigen::Isometry3d::Identity() : baseAt(at);
  Ready out{nullptr, jointPositions(at)};
  if (!base_moves)
    for (const std::string &variable : root.getVariableNames()) out.rest.erase(variable);
  std::vector<AllowedPair> allowed;
  if (acm) allowed = allowedPairs(*acm, *scene, now.attached);
  const std::lock_guard<std::mutex> lock(mutex_);
  const auto known = std::find_if(prepared_.begin(), prepared_.end(), [&](const Prepared &other) {
    const Snapshot &of_other = *other.robot->snapshot();
    return &of_other.world() == &scene->world() && of_other.version() == scene->version() &&
           of_other.attached() == now.attached && sameAllowed(other.allowed, allowed) &&
           other.base_moves == base_moves && other.base.matrix() == base.matrix();
  });
  if (known != prepared_.end()) {
    std::rotate(known, known + 1, prepared_.end());
  } else {
    const SnapshotPtr variant = scene->variant({now.attached, allowed});
    const auto like = std::find_if(prepared_.rbegin(), prepared_.rend(), [&](const Prepared &other) {
      return other.robot->snapshot()->attached() == now.attached && other.base_moves == base_moves &&
             other.base.matrix() == base.matrix();
    });
    std::shared_ptr<const PreparedRobot> made;
    if (like != prepared_.rend()) {
      made = std::make_shared<const PreparedRobot>(*like->robot, variant);
    } else {
      made = std::make_shared<const PreparedRobot>(variant, std::vector<std::array<std::string, 2>>(),
                                                   base_moves ? base_ : std::vector<VirtualJoint>(),
                                                   std::vector<std::string>(), base);
    }
    if (prepared_.size() == KEPT_PREPARED) prepared_.erase(prepared_.begin());
    prepared_.push_back({allowed, base_moves, base, made});
  }
  out.robot = prepared_.back().robot;
  return out;
}

void CollisionEnvCurveProximity::checkMotion(const Request &req, Result &res, const State &from, const State &to,
                                             const Matrix *acm) const {
  try {
    checkModel(from);
    checkModel(to);
    const TrajectoryDescription path = straight(from, to);
    if (path.joints.empty()) return check(req, res, from, acm, RobotPairs::ENVIRONMENT);
    const Current now = current(from, false);
    if (!now.fault.empty()) return fail(now.fault, res);
    const std::set<std::string> links = linksOf(req.group_name);
    const Ready ready = prepared(now, from, path.joints, acm);
    const RobotMotion motion(*ready.robot, path, ready.rest, {links.begin(), links.end()});
    Query query;
    query.allow_empty = true; // MoveIt's scene is whole
    if (req.distance) {
      const Answer answer = askEnvironment(motion, query, workspace()).front();
      if (answer.result.status < 0) throw Error(answer.message);
      res.distance = std::min(res.distance, answer.result.lower);
    }
    query.query_type = QueryType::COLLISION;
    const Answer answer = req.contacts ? timeOfContact(motion, false, query, workspace())
                                       : askEnvironment(motion, query, workspace()).front();
    if (answer.result.status < 0) throw Error(answer.message);
    if (answer.result.verdict == CPROX_VERDICT_CLEAR) return;
    res.collision = true;
    if (!req.contacts) return;
    cd::Contact contact;
    contact.nearest_points[0] = toEigen(answer.result.witness_mover);
    contact.nearest_points[1] = toEigen(answer.result.witness_obstacle);
    contact.pos = 0.5 * (contact.nearest_points[0] + contact.nearest_points[1]);
    contact.normal = -toEigen(answer.result.normal);
    contact.depth = 0.0;
    contact.percent_interpolation = answer.result.t;
    contact.body_name_1 = answer.a;
    contact.body_type_1 = now.attached.count(answer.a) > 0 ? cd::BodyTypes::ROBOT_ATTACHED : cd::BodyTypes::ROBOT_LINK;
    contact.body_name_2 = answer.b;
    contact.body_type_2 = cd::BodyTypes::WORLD_OBJECT;
    Collector(req, res).add(contact);
  } catch (const std::exception &error) {
    fail(error.what(), res);
  }
}

void CollisionEnvCurveProximity::checkRobotCollision(const Request &req, Result &res, const State &state1,
                                                     const State &state2, const Matrix &acm) const {
  checkMotion(req, res, state1, state2, &acm);
}

void CollisionEnvCurveProximity::checkRobotCollision(const Request &req, Result &res, const State &state1,
                                                     const State &state2) const {
  checkMotion(req, res, state1, state2, nullptr);
}

RobotMotion CollisionEnvCurveProximity::motion(const TrajectoryDescription &trajectory, const State &at,
                                               const Matrix &acm) const {
  const Ready ready = robot(at, trajectory.joints, acm);
  return RobotMotion(*ready.robot, trajectory, ready.rest);
}

CollisionEnvCurveProximity::Ready CollisionEnvCurveProximity::robot(const State &at,
                                                                    const std::vector<std::string> &joints,
                                                                    const Matrix &acm) const {
  const Current now = current(at, true);
  if (!now.fault.empty()) throw Error(now.fault);
  return prepared(now, at, joints, &acm);
}

const std::string &CollisionDetectorAllocatorCurveProximity::getName() const {
  static const std::string name = "CurveProximity";
  return name;
}

} // namespace curve_proximity
