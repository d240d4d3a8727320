/* SPDX-License-Identifier: BSD-3-Clause */
#include <curve_proximity/motion.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <deque>
#include <limits>
#include <map>
#include <optional>
#include <set>

#include "answering.h"
#include "kinematics.h"
#include "world.h"

namespace curve_proximity {

/* Which geometries are asked about against which items or geometries. */
struct RobotMotion::Data {
  SnapshotPtr snapshot;
  std::string id;
  std::shared_ptr<const Kinematics> kinematics;
  std::unique_ptr<cprox_motion, void (*)(cprox_motion *)> core{nullptr, cprox_motion_free};
  std::vector<cprox_robot_pair> self;        /* geometry against geometry */
  std::vector<cprox_robot_pair> environment; /* geometry against item of the snapshot's world */
  std::vector<std::string> skipped;
};

namespace {

using Clock = std::chrono::steady_clock;
using Links = std::array<std::string, 2>;

constexpr double INFINITE = std::numeric_limits<double>::infinity();

/* ---- the motion ---------------------------------------------------------------------------------------------------- */

/* What decides a joint value: its own variable; nothing where it follows another joint or cannot move. */
std::optional<int> variableOf(const Kinematics &kinematics, const std::string &joint) {
  const auto it = kinematics.variables.find(joint);
  if (it != kinematics.variables.end()) return it->second;
  if (kinematics.leaders.count(joint) == 0) {
    throw Error("joint '" + joint + "' is no joint of robot '" + kinematics.robot->name() + "'");
  }
  return std::nullopt;
}

std::vector<double> restOf(const Kinematics &kinematics, const JointPositions &rest) {
  std::vector<double> values = kinematics.rest;
  for (const auto &[joint, value] : rest) {
    if (!std::isfinite(value)) throw Error("the value of joint '" + joint + "' is not finite");
    if (const std::optional<int> variable = variableOf(kinematics, joint))
      values[static_cast<std::size_t>(*variable)] = value;
  }
  return values;
}

/* The trajectory's columns that are variables of the robot. */
struct Columns {
  std::vector<std::size_t> column;
  std::vector<std::int32_t> variable;
};

Columns columnsOf(const Kinematics &kinematics, const TrajectoryDescription &trajectory) {
  Columns out;
  for (std::size_t i = 0; i < trajectory.joints.size(); ++i) {
    const std::string &joint = trajectory.joints[i];
    if (const std::optional<int> variable = variableOf(kinematics, joint)) {
      out.column.push_back(i);
      out.variable.push_back(*variable);
      continue;
    }
    /* a follower needs its leader; one that cannot move needs nothing */
    const std::string &leader = kinematics.leaders.at(joint);
    const auto &names = trajectory.joints;
    if (!leader.empty() && std::find(names.begin(), names.end(), leader) == names.end()) {
      throw Error("joint '" + joint + "' follows joint '" + leader + "', which the trajectory does not name");
    }
  }
  if (out.column.empty()) throw Error("the trajectory moves no joint of the robot");
  return out;
}

/* The chosen columns of one of a point's lists; NULL for the core where there are none. */
const double *chosen(const std::vector<double> &values, const Columns &columns,
                     std::deque<std::vector<double>> &memory) {
  if (values.empty()) return nullptr;
  memory.emplace_back();
  for (const std::size_t column : columns.column) memory.back().push_back(values[column]);
  return memory.back().data();
}

cprox_interpolation toCore(Interpolation interpolation) {
  switch (interpolation) {
    case Interpolation::LINEAR: return CPROX_LINEAR;
    case Interpolation::CUBIC: return CPROX_CUBIC;
    case Interpolation::QUINTIC: return CPROX_QUINTIC;
    case Interpolation::BY_POINTS: break;
  }
  return CPROX_BY_WAYPOINTS;
}

void makeMotion(const TrajectoryDescription &trajectory, const JointPositions &rest, RobotMotion::Data &data) {
  const Kinematics &kinematics = *data.kinematics;
  const Columns columns = columnsOf(kinematics, trajectory);
  const std::vector<double> still = restOf(kinematics, rest);
  std::deque<std::vector<double>> memory;
  std::vector<cprox_waypoint> points;
  for (const TrajectoryPoint &point : trajectory.points) {
    points.push_back({point.time, chosen(point.positions, columns, memory), chosen(point.velocities, columns, memory),
                      chosen(point.accelerations, columns, memory)});
  }
  if (points.size() < 2) throw Error("the trajectory has one point: from where it is reached is not said");

  Workspace workspace;
  cprox_motion *made = nullptr;
  const cprox_status status = cprox_motion_create_waypoints(
      kinematics.core.get(), columns.variable.data(), columns.variable.size(), points.data(), points.size(),
      toCore(trajectory.interpolation), still.data(), workspace.get(), &made);
  if (status != CPROX_OK) throw Error(workspace.reason(), status);
  data.core.reset(made);
}

/* ---- the pairs ----------------------------------------------------------------------------------------------------- */

Links ordered(const std::string &a, const std::string &b) {
  return a < b ? Links{a, b} : Links{b, a};
}

/* Does the allowed collision matrix let two touch? What is said of the pair counts, else what is said of either. */
class Allowed {
 public:
  explicit Allowed(const Snapshot &snapshot) {
    for (const AllowedPair &pair : snapshot.allowed()) {
      if (pair.b.empty()) {
        defaults_[pair.a] = pair.allowed;
      } else {
        pairs_[ordered(pair.a, pair.b)] = pair.allowed;
      }
    }
  }

  bool operator()(const std::string &a, const std::string &b) const {
    const auto pair = pairs_.find(ordered(a, b));
    if (pair != pairs_.end()) return pair->second;
    const auto of = [this](const std::string &name) {
      const auto it = defaults_.find(name);
      return it != defaults_.end() && it->second;
    };
    return of(a) || of(b);
  }

 private:
  std::map<Links, bool> pairs_;
  std::map<std::string, bool> defaults_;
};

bool moves(const RobotMotion::Data &data, const MovingGeometry &geometry) {
  return cprox_motion_moves_link(data.core.get(), data.kinematics->links.at(*geometry.link));
}

void choosePairs(const std::vector<Links> &disabled, RobotMotion::Data &data) {
  const std::vector<MovingGeometry> &geometries = data.kinematics->geometries;
  const std::map<std::string, std::size_t> &links = data.kinematics->links;
  const Allowed allowed(*data.snapshot);
  std::set<Links> off;
  for (const Links &pair : disabled) off.insert(ordered(pair[0], pair[1]));
  std::set<std::string> told;
  const auto tell = [&](const std::string &sentence) {
    if (told.insert(sentence).second) data.skipped.push_back(sentence);
  };

  const std::vector<Item> &items = data.snapshot->world().items();
  for (std::size_t i = 0; i < geometries.size(); ++i) {
    const std::string &link = *geometries[i].link;

    /* what it may touch in the scene */
    if (!moves(data, geometries[i])) tell("link '" + link + "': the trajectory does not move it");
    for (std::size_t k = 0; k < items.size() && moves(data, geometries[i]); ++k) {
      const std::string &object = *items[k].owner;
      if (allowed(link, object)) {
        tell("link '" + link + "' and object '" + object + "': they are allowed to touch");
      } else {
        data.environment.push_back({static_cast<std::int32_t>(i), static_cast<std::int32_t>(k)});
      }
    }

    /* and of itself */
    for (std::size_t k = i + 1; k < geometries.size(); ++k) {
      const std::string &other = *geometries[k].link;
      if (link == other) continue;
      const std::string pair = "links '" + link + "' and '" + other + "': ";
      if (!cprox_motion_relates_links(data.core.get(), links.at(link), links.at(other))) {
        tell(pair + "this trajectory does not move them against each other, or a single joint does");
      } else if (off.count(ordered(link, other))) {
        tell(pair + "the SRDF disables them");
      } else if (allowed(link, other)) {
        tell(pair + "they are allowed to touch");
      } else {
        data.self.push_back({static_cast<std::int32_t>(i), static_cast<std::int32_t>(k)});
      }
    }
  }
}

/* ---- asking ---------------------------------------------------------------------------------------------------------- */

double mostExcess(const std::vector<MovingGeometry> &geometries) {
  double most = 0.0;
  for (const MovingGeometry &geometry : geometries) most = std::max(most, geometry.excess);
  return most;
}

/* What the core says of a mover, widened by the rounding that it does not know. */
Answer answerFor(const RobotMotion::Data &data, const cprox_mover &mover, const std::vector<cprox_target> &targets,
                 double rounding, const Question &question, Workspace &workspace) {
  Answer answer;
  answer.id = data.id;
  cprox_result &result = answer.result;
  result.target_index = -1;
  const cprox_options options = withoutRounding(question.options, rounding);
  result.status = askCore(question, options, mover, targets, workspace, result);
  if (result.status < 0) {
    answer.message = workspace.reason();
  } else {
    widen(question, rounding, INFINITE, result);
  }
  return answer;
}

void finish(Answer &answer, Clock::time_point start) {
  answer.microseconds = std::chrono::duration<double, std::micro>(Clock::now() - start).count();
  if (answer.result.status != CPROX_OK && answer.message.empty())
    answer.message = cprox_status_text(answer.result.status);
  answer.status = cprox_status_name(answer.result.status);
}

/* Names the moving link of an answer that has a witness, and leaves the number of its collision element in mover_part. */
void nameLink(const RobotMotion::Data &data, Answer &answer) {
  if (answer.result.target_index < 0) return;
  const MovingGeometry &geometry = data.kinematics->geometries[static_cast<std::size_t>(answer.result.mover_part)];
  answer.a = *geometry.link;
  answer.result.mover_part = geometry.part;
  answer.by_hull = geometry.by_hull;
}

void sayHull(Answer &answer) {
  if (answer.by_hull) answer.message = "the nearest shape is a mesh: its convex hull answers for it";
}

/* The items first … last - 1 of the world, as one answer. */
Answer answerItems(const RobotMotion::Data &data, const std::vector<std::size_t> &wanted, const Question &question,
                   Workspace &workspace) {
  const Clock::time_point start = Clock::now();
  const std::vector<Item> &items = data.snapshot->world().items();
  std::vector<cprox_target> targets;
  std::vector<std::int32_t> number(items.size(), -1);
  double rounding = 0.0;
  for (const std::size_t k : wanted) {
    number[k] = static_cast<std::int32_t>(targets.size());
    targets.push_back(items[k].shape->target);
    rounding = std::max(rounding, items[k].shape->rounding);
  }
  std::vector<cprox_robot_pair> pairs;
  for (const cprox_robot_pair &pair : data.environment) {
    const std::int32_t k = number[static_cast<std::size_t>(pair.other)];
    if (k >= 0) pairs.push_back({pair.geometry, k});
  }

  Answer answer;
  answer.id = data.id;
  if (pairs.empty()) {
    answerNothing(question, answer.result);
  } else {
    const cprox_mover mover = cprox_robot_along(data.core.get(), pairs.data(), pairs.size());
    answer = answerFor(data, mover, targets, rounding + mostExcess(data.kinematics->geometries), question, workspace);
    nameLink(data, answer);
  }
  if (answer.result.status >= 0 && answer.result.target_index >= 0) {
    const Item &item = items[wanted[static_cast<std::size_t>(answer.result.target_index)]];
    answer.b = *item.owner;
    answer.result.target_index = item.part;
    answer.by_hull = answer.by_hull || item.shape->by_hull;
    sayHull(answer);
  }
  answer.kind = "environment";
  finish(answer, start);
  return answer;
}

} // namespace

RobotMotion::RobotMotion(SnapshotPtr snapshot, const TrajectoryDescription &trajectory, const JointPositions &rest,
                         const std::vector<std::array<std::string, 2>> &disabled, const Eigen::Isometry3d &base) {
  checkTrajectory(trajectory);
  auto data = std::make_unique<Data>();
  data->snapshot = std::move(snapshot);
  data->id = trajectory.id;
  data->kinematics = makeKinematics(*data->snapshot, trajectory.base, trajectory.base_joints, base);
  makeMotion(trajectory, rest, *data);
  choosePairs(disabled, *data);
  data_ = std::move(data);
}

RobotMotion::~RobotMotion() = default;
RobotMotion::RobotMotion(RobotMotion &&) noexcept = default;
RobotMotion &RobotMotion::operator=(RobotMotion &&) noexcept = default;

std::array<double, 2> RobotMotion::domain() const {
  std::array<double, 2> out{};
  cprox_motion_domain(data_->core.get(), &out[0], &out[1]);
  return out;
}

LinkPoses RobotMotion::linkPoses(double t) const {
  const Kinematics &kinematics = *data_->kinematics;
  std::vector<double> values(kinematics.rest.size());
  cprox_motion_evaluate(data_->core.get(), t, values.data());
  LinkPoses out;
  for (const auto &[name, link] : kinematics.links) {
    cprox_vec3 position;
    Eigen::Matrix<double, 3, 3, Eigen::RowMajor> rotation;
    cprox_robot_link_frame(kinematics.core.get(), values.data(), link, &position, rotation.data());
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.linear() = rotation;
    pose.translation() = toEigen(position);
    out.emplace(name, pose);
  }
  return out;
}

const std::vector<std::string> &RobotMotion::skipped() const {
  return data_->skipped;
}

std::vector<Answer> askEnvironment(const RobotMotion &motion, const Question &question, Workspace &workspace) {
  const RobotMotion::Data &data = motion.data();
  const std::vector<Item> &items = data.snapshot->world().items();
  for (const std::string &name : question.objects) {
    if (data.snapshot->objects().count(name) == 0) throw Error("there is no object '" + name + "' in the scene");
  }
  const auto named = [&](const Item &item) {
    const auto &names = question.objects;
    return names.empty() || std::find(names.begin(), names.end(), *item.owner) != names.end();
  };

  /* all in one, or one for each run of items of the same object */
  std::vector<Answer> answers;
  std::vector<std::size_t> wanted;
  for (std::size_t k = 0; k < items.size(); ++k) {
    if (!named(items[k])) continue;
    wanted.push_back(k);
    const bool last = k + 1 == items.size() || items[k + 1].owner != items[k].owner;
    if (!question.per_object || !last) continue;
    answers.push_back(answerItems(data, wanted, question, workspace));
    answers.back().b = *items[k].owner;
    wanted.clear();
  }
  if (answers.empty()) answers.push_back(answerItems(data, wanted, question, workspace));
  return answers;
}

Answer askSelf(const RobotMotion &motion, const Question &question, Workspace &workspace) {
  const Clock::time_point start = Clock::now();
  const RobotMotion::Data &data = motion.data();
  Answer answer;
  answer.id = data.id;
  if (data.self.empty()) {
    answerNothing(question, answer.result);
  } else {
    const cprox_mover mover = cprox_robot_self(data.core.get(), data.self.data(), data.self.size());
    answer = answerFor(data, mover, {}, 2.0 * mostExcess(data.kinematics->geometries), question, workspace);
    nameLink(data, answer);
  }
  if (answer.result.status >= 0 && answer.result.target_index >= 0) {
    const MovingGeometry &other = data.kinematics->geometries[static_cast<std::size_t>(answer.result.target_index)];
    answer.b = *other.link;
    answer.b_is_link = true;
    answer.result.target_index = other.part;
    answer.by_hull = answer.by_hull || other.by_hull;
    sayHull(answer);
  }
  answer.kind = "self";
  finish(answer, start);
  return answer;
}

} // namespace curve_proximity
