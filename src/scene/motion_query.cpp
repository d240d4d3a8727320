/* SPDX-License-Identifier: BSD-3-Clause */
/* Queries about a robot in motion, and their answers by name. */
#include <algorithm>
#include <chrono>
#include <limits>
#include <set>

#include <curve_proximity/nearest_name.hpp>

#include "answering.h"
#include "motion_data.h"
#include "proving.h"

namespace curve_proximity {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double INFINITE = std::numeric_limits<double>::infinity();

double mostExcess(const std::vector<MovingGeometry> &geometries) {
  double most = 0.0;
  for (const MovingGeometry &geometry : geometries) most = std::max(most, geometry.excess);
  return most;
}

/* Whom a query is about: pairs of geometries and some of the world's items, or of geometries alone. */
struct Asked {
  const RobotMotion::Data &data;
  bool self;
  std::vector<std::size_t> items; /* by target */
  std::vector<cprox_obstacle> targets;
  std::vector<cprox_robot_pair> pairs;
  double rounding;                    /* [m] that the core does not know of */
  std::vector<cprox_obstacle> proven; /* the targets as a proof takes them: it must know a hull from a convex body */

  cprox_mover mover() const {
    return self ? cprox_robot_self(data.core.get(), pairs.data(), pairs.size())
                : cprox_robot_along(data.core.get(), pairs.data(), pairs.size());
  }
};

/* Whether a query names the owner of a geometry; without names it means all. */
class Named {
 public:
  /* Throws Error for a name that is none. */
  Named(const RobotMotion::Data &data, const std::vector<std::string> &names)
      : geometries_(data.kinematics->geometries), names_(names.begin(), names.end()) {
    std::set<std::string> known;
    for (const MovingGeometry &geometry : geometries_) known.insert(geometry.owner());
    for (const std::string &name : names_) {
      if (known.count(name) == 0)
        throw Error("the robot has no link with geometry and carries no object '" + name + "'" +
                    didYouMean(name, std::vector<std::string>(known.begin(), known.end())));
    }
  }

  bool operator()(std::int32_t geometry) const {
    return names_.empty() || names_.count(geometries_[static_cast<std::size_t>(geometry)].owner()) > 0;
  }

 private:
  const std::vector<MovingGeometry> &geometries_;
  const std::set<std::string> names_;
};

/* Robots are asked about surfaces: solid meshes are answered by their hulls, which contain their inside. */
Asked askedItems(const RobotMotion::Data &data, std::vector<std::size_t> wanted,
                 const std::vector<std::string> &links) {
  const Named named(data, links);
  Asked asked{data, false, std::move(wanted), {}, {}, mostExcess(data.kinematics->geometries), {}};
  const std::vector<Item> &items = data.snapshot->world().items();
  std::vector<std::int32_t> number(items.size(), -1);
  double rounding = 0.0;
  for (const std::size_t k : asked.items) {
    number[k] = static_cast<std::int32_t>(asked.targets.size());
    const PlacedShape &shape = *items[k].shape;
    const bool by_hull = shape.is_mesh && cprox_body_get_info(shape.target.body).is_solid;
    asked.targets.push_back(by_hull ? shape.hull : shape.target);
    asked.proven.push_back(shape.surface);
    rounding = std::max(rounding, shape.rounding + (by_hull ? shape.hull_excess : 0.0));
  }
  for (const cprox_robot_pair &pair : data.environment) {
    const std::int32_t k = number[static_cast<std::size_t>(pair.other)];
    if (k >= 0 && named(pair.geometry)) asked.pairs.push_back({pair.geometry, k});
  }
  asked.rounding += rounding;
  return asked;
}

Asked askedSelf(const RobotMotion::Data &data, const std::vector<std::string> &links) {
  Asked asked{data, true, {}, {}, {}, 2.0 * mostExcess(data.kinematics->geometries), {}};
  const Named named(data, links);
  for (const cprox_robot_pair &pair : data.self) {
    if (named(pair.geometry) || named(pair.other)) asked.pairs.push_back(pair);
  }
  return asked;
}

/* The items of all objects, or of those that are named. Throws Error for a name that is none. */
std::vector<std::size_t> namedItems(const RobotMotion::Data &data, const std::vector<std::string> &names) {
  for (const std::string &name : names) {
    if (data.snapshot->objects().count(name) == 0) throw Error("there is no object '" + name + "' in the scene");
  }
  std::vector<std::size_t> out;
  const std::vector<Item> &items = data.snapshot->world().items();
  for (std::size_t k = 0; k < items.size(); ++k) {
    if (names.empty() || std::find(names.begin(), names.end(), *items[k].owner) != names.end()) out.push_back(k);
  }
  return out;
}

/* Of an answer that there is: what is special about it. */
void addWarnings(const RobotMotion::Data &data, Answer &answer) {
  if (answer.result.status < 0) return;
  for (const std::string &sentence : data.warnings) answer.message += (answer.message.empty() ? "" : "; ") + sentence;
}

void finish(const RobotMotion::Data &data, Answer &answer, Clock::time_point start) {
  answer.microseconds = std::chrono::duration<double, std::micro>(Clock::now() - start).count();
  if (answer.result.status != CPROX_OK && answer.message.empty())
    answer.message = cprox_status_text(answer.result.status);
  answer.status = cprox_status_name(answer.result.status);
  addWarnings(data, answer);
}

/* Names both sides of an answer that has a witness, and leaves the numbers of their shapes in mover_part and
 * obstacle_index. */
void nameSides(const Asked &asked, const Query &query, Answer &answer) {
  cprox_result &result = answer.result;
  if (result.status < 0 || result.obstacle_index < 0) return;
  const std::vector<MovingGeometry> &geometries = asked.data.kinematics->geometries;
  const MovingGeometry &moving = geometries[static_cast<std::size_t>(result.mover_part)];
  const auto other = static_cast<std::size_t>(result.obstacle_index);
  answer.a = moving.owner();
  result.mover_part = moving.part;
  const bool coarse = query.options.max_lod != CPROX_LOD_MESH;
  answer.by_hull = coarse && moving.is_mesh;
  if (asked.self) {
    const MovingGeometry &standing = geometries[other];
    answer.b = standing.owner();
    answer.b_is_link = !standing.attached;
    result.obstacle_index = standing.part;
    answer.by_hull = answer.by_hull || (coarse && standing.is_mesh);
  } else {
    const Item &item = asked.data.snapshot->world().items()[asked.items[other]];
    answer.b = *item.owner;
    result.obstacle_index = item.part;
    answer.by_hull =
        answer.by_hull || (item.shape->is_mesh && (coarse || cprox_body_get_info(item.shape->target.body).is_solid));
  }
  if (answer.by_hull) answer.message = "the nearest shape is a mesh: its convex hull answers for it";
}

/* What the core said, widened by the rounding that it does not know, and by name. */
Answer toAnswer(const Asked &asked, const cprox_result &result, const Query &query, const Workspace &workspace,
                Clock::time_point start) {
  Answer answer;
  answer.id = asked.data.id;
  answer.kind = asked.self ? "self" : "environment";
  answer.result = result;
  if (result.status < 0) {
    answer.message = workspace.reason();
  } else {
    if (!asked.pairs.empty()) widen(query, asked.rounding, INFINITE, answer.result);
    nameSides(asked, query, answer);
  }
  finish(asked.data, answer, start);
  return answer;
}

Answer answerOf(const Asked &asked, const Query &query, Workspace &workspace) {
  const Clock::time_point start = Clock::now();
  cprox_result result{};
  result.obstacle_index = -1;
  if (asked.pairs.empty()) {
    answerNothing(query, result);
  } else {
    cprox_options options = withoutRounding(query.options, asked.rounding);
    options.certificate = nullptr;
    result.status = askCore(query, options, asked.mover(), asked.targets, workspace, result);
  }
  Answer answer = toAnswer(asked, result, query, workspace, start);
  if (!query.options.certificate) return answer;
  if (!asked.pairs.empty() && result.status >= 0) widen(query, asked.rounding, INFINITE, result);
  leaveProof(query, asked.mover(), asked.proven, result, workspace, answer);
  return answer;
}

/* What is asked for and not heeded, of a query with one answer in all. */
std::string faultInAll(bool self, const Query &query) {
  if (self && !query.objects.empty())
    return "objects do not apply to a robot against itself, '" + query.objects.front() + "' among them";
  return faultOfMotion(query, true);
}

/* What is asked about is a distance. */
void checkDistances(bool self, const Query &query) {
  std::string fault = faultOfDistances(query);
  if (fault.empty()) fault = faultInAll(self, query);
  if (!fault.empty()) throw Error(fault);
}

Asked askedOf(const RobotMotion &motion, bool self, const Query &query) {
  const RobotMotion::Data &data = motion.data();
  return self ? askedSelf(data, query.links) : askedItems(data, namedItems(data, query.objects), query.links);
}

/* A time no later than `t` before which the geometries, moved by their rounding, do not touch either. Steps back from
 * t, each time farther, until the clearance before is proven to be more than the rounding. */
double beforeRounding(const Asked &asked, double t, const cprox_options &options, Workspace &workspace) {
  const double start = cprox_motion_get_info(asked.data.core.get()).t0;
  constexpr double GROWTH = 16.0;
  for (double step = 1e-15 * std::max(1.0, t - start); t - step > start; step *= GROWTH) {
    cprox_options fine = options;
    fine.epsilon = asked.rounding;
    fine.relative_epsilon = 0.5;
    const std::array<double, 2> breaks{start, t - step};
    cprox_profile_interval interval{};
    const cprox_status status =
        cprox_obstacles_profile(nullptr, asked.mover(), breaks.data(), 1, &fine, workspace.get(), &interval);
    if (status < 0) return start;
    if (interval.lower > asked.rounding) return t - step;
  }
  return start;
}

/* The core's answer to the time of contact, true of geometries as rounding may have moved them. */
void searchContact(const Asked &asked, const Query &query, Workspace &workspace, cprox_result &result) {
  std::vector<cprox_obstacle> targets = asked.targets;
  for (cprox_obstacle &target : targets) target.margin += asked.rounding;
  ObstaclesHandle obstacles;
  result.status = makeObstacles(targets, CPROX_INDEX_NONE, workspace, obstacles);
  if (result.status >= 0)
    result.status =
        cprox_obstacles_time_of_contact(obstacles.get(), asked.mover(), &query.options, workspace.get(), &result);
  const bool touches = result.status >= 0 && !(result.lower > asked.rounding);
  if (asked.self && touches && asked.rounding > 0.0)
    result.t_contact_lower = beforeRounding(asked, result.t_contact_lower, query.options, workspace);
}

} // namespace

std::vector<Answer> askEnvironment(const RobotMotion &motion, const Query &query, Workspace &workspace) {
  const RobotMotion::Data &data = motion.data();
  cprox_certificate_clear(query.options.certificate);
  const std::string fault = faultOfMotion(query, false);
  if (!fault.empty()) return {refusal(data.id, "environment", fault)};
  const std::vector<std::size_t> named = namedItems(data, query.objects);
  if (!query.per_object || named.empty()) return {answerOf(askedItems(data, named, query.links), query, workspace)};

  /* one for each run of items of the same object */
  const std::vector<Item> &items = data.snapshot->world().items();
  std::vector<Answer> answers;
  std::vector<std::size_t> wanted;
  for (std::size_t i = 0; i < named.size(); ++i) {
    wanted.push_back(named[i]);
    if (i + 1 < named.size() && items[named[i + 1]].owner == items[named[i]].owner) continue;
    answers.push_back(answerOf(askedItems(data, wanted, query.links), query, workspace));
    answers.back().b = *items[named[i]].owner;
    wanted.clear();
  }
  return answers;
}

Answer askSelf(const RobotMotion &motion, const Query &query, Workspace &workspace) {
  cprox_certificate_clear(query.options.certificate);
  const std::string fault = faultInAll(true, query);
  if (!fault.empty()) return refusal(motion.data().id, "self", fault);
  return answerOf(askedSelf(motion.data(), query.links), query, workspace);
}

Answer timeOfContact(const RobotMotion &motion, bool self, const Query &query, Workspace &workspace) {
  const Clock::time_point start = Clock::now();
  std::string fault = faultOfContact(query);
  if (fault.empty()) fault = faultInAll(self, query);
  if (!fault.empty()) return refusal(motion.data().id, self ? "self" : "environment", fault);
  const Asked asked = askedOf(motion, self, query);
  cprox_result result{};
  result.obstacle_index = -1;
  if (asked.pairs.empty()) {
    answerNothing(query, result);
    result.t_contact_lower = motion.domain()[1];
  } else {
    searchContact(asked, query, workspace, result);
  }
  return toAnswer(asked, result, query, workspace, start);
}

std::vector<std::string> movingNames(const RobotMotion &motion) {
  std::set<std::string> names;
  for (const MovingGeometry &geometry : motion.data().kinematics->geometries) names.insert(geometry.owner());
  return {names.begin(), names.end()};
}

std::vector<std::string> askedNames(const RobotMotion &motion, bool self) {
  const RobotMotion::Data &data = motion.data();
  const std::vector<MovingGeometry> &geometries = data.kinematics->geometries;
  std::set<std::string> names;
  for (const cprox_robot_pair &pair : self ? data.self : data.environment) {
    names.insert(geometries[static_cast<std::size_t>(pair.geometry)].owner());
    if (self) names.insert(geometries[static_cast<std::size_t>(pair.other)].owner());
  }
  return {names.begin(), names.end()};
}

std::string describeQuery(const RobotMotion &motion, bool self, const Query &query) {
  const Asked asked = askedOf(motion, self, query);
  if (asked.pairs.empty()) return {};
  std::vector<std::string> names;
  for (const std::size_t item : asked.items) names.push_back(*asked.data.snapshot->world().items()[item].owner);
  const std::string bodies = targetLines(asked.proven, names);
  if (bodies.empty()) return {};
  const std::string id = wordOf(motion.data().id + (self ? ".self" : ".environment"));
  Workspace workspace;
  const cprox_mover mover = asked.mover();
  const Obstacles obstacles(asked.proven, CPROX_INDEX_NONE);
  const auto describe = [&](char *text, std::size_t size) {
    return cprox_mover_describe(&mover, obstacles.get(), id.c_str(), workspace.get(), text, size);
  };
  std::string robot(describe(nullptr, 0) + 1, '\0');
  if (describe(robot.data(), robot.size()) == 0) return {};
  robot.pop_back();
  return bodies + robot;
}

std::vector<std::string> unprovable(const RobotMotion &motion, bool self, const Query &query) {
  const Asked asked = askedOf(motion, self, query);
  std::vector<std::string> sentences;
  const auto look = [&](const std::string &who, const cprox_body *body) {
    const std::string sentence = unprovableBody(who, body);
    if (!sentence.empty()) sentences.push_back(sentence);
  };
  for (const MovingGeometry &geometry : asked.data.kinematics->geometries)
    look((geometry.attached ? "object '" : "link '") + geometry.owner() + "'", geometry.body);
  for (std::size_t i = 0; i < asked.items.size(); ++i)
    look("object '" + *asked.data.snapshot->world().items()[asked.items[i]].owner + "'", asked.proven[i].body);
  return sentences;
}

std::vector<Answer> nearestPairs(const RobotMotion &motion, bool self, const PairLimits &limits, const Query &query,
                                 Workspace &workspace) {
  const Clock::time_point start = Clock::now();
  checkDistances(self, query);
  const Asked asked = askedOf(motion, self, query);
  if (asked.pairs.empty()) return {};
  const cprox_options options = withoutRounding(query.options, asked.rounding);
  std::vector<cprox_result> results(std::min(limits.count, asked.pairs.size()));
  std::size_t count = 0;
  const Obstacles obstacles(asked.targets, CPROX_INDEX_NONE);
  const cprox_status status = cprox_obstacles_nearest_pairs(obstacles.get(), asked.mover(), limits.count, limits.within,
                                                            &options, workspace.get(), results.data(), &count);
  if (status < 0) throw Error(workspace.reason(), status);
  std::vector<Answer> answers;
  for (std::size_t i = 0; i < count; ++i) answers.push_back(toAnswer(asked, results[i], query, workspace, start));
  return answers;
}

std::vector<ClearanceInterval> clearanceProfile(const RobotMotion &motion, bool self, const std::vector<double> &breaks,
                                                const Query &query, Workspace &workspace) {
  if (breaks.size() < 2) throw Error("a clearance profile needs at least two breaks");
  checkDistances(self, query);
  const Asked asked = askedOf(motion, self, query);
  std::vector<cprox_profile_interval> intervals(breaks.size() - 1);
  for (std::size_t i = 0; i < intervals.size(); ++i)
    intervals[i] = {breaks[i], breaks[i + 1], INFINITE, INFINITE, breaks[i], -1, -1, {}};
  cprox_status status = CPROX_OK;
  if (!asked.pairs.empty()) {
    const cprox_options options = withoutRounding(query.options, asked.rounding);
    const Obstacles obstacles(asked.targets, CPROX_INDEX_NONE);
    status = cprox_obstacles_profile(obstacles.get(), asked.mover(), breaks.data(), intervals.size(), &options,
                                     workspace.get(), intervals.data());
    if (status < 0) throw Error(workspace.reason(), status);
  }
  std::vector<ClearanceInterval> out;
  for (const cprox_profile_interval &interval : intervals) {
    Answer names;
    names.result.obstacle_index = interval.obstacle_index;
    names.result.mover_part = interval.mover_part;
    nameSides(asked, query, names);
    out.push_back(toInterval(interval, asked.rounding, query.options, status));
    out.back().a = names.a;
    out.back().b = names.b;
  }
  return out;
}

} // namespace curve_proximity
