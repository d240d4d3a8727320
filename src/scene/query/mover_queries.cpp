/* SPDX-License-Identifier: BSD-3-Clause */
/* Queries about robots and objects that move at the same time. */
#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <set>

#include <curve_proximity/movers.hpp>
#include <curve_proximity/nearest_name.hpp>

#include "answering.h"
#include "motion/movers_data.h"
#include "proving.h"
#include "second_opinion.h"

namespace curve_proximity {
namespace {

std::string faultOfMovers(const Query &query) {
  if (query.options.signed_distance) return "signed_distance does not apply: movers on one clock have no depth";
  return faultOfMotion(query, true);
}

/* What a query is about: pairs with objects that stand, and pairs of movers. */
struct Pairs {
  Against against = Against::BOTH;
  std::vector<cprox_robot_pair> environment, among;
};

/* Does a list of movers ("name") and links ("name/link") have it? */
bool isNamed(const std::vector<std::string> &names, const std::string &name) {
  return std::any_of(names.begin(), names.end(),
                     [&](const std::string &one) { return one == name || one == moverOf(name); });
}

/* The geometries that query.links names; all where it names none. Throws Error for a name that is none. */
std::vector<bool> namedGeometries(const Movers::Data &data, const std::vector<std::string> &names) {
  std::vector<bool> out(data.geometries.size(), names.empty());
  for (const std::string &name : names) {
    bool found = false;
    for (std::size_t i = 0; i < out.size(); ++i) {
      const std::string &own = data.geometries[i].name;
      const bool fits = own == name || moverOf(own) == name;
      out[i] = out[i] || fits;
      found = found || fits;
    }
    if (!found) throw Error("'" + name + "' is no mover, and no link of one, that has geometry");
  }
  return out;
}

/* Is it one of query.objects, or of a robot that these name? All are where they name none. */
class AskedObjects {
 public:
  AskedObjects(const Movers::Data &data, const Query &query) : names_(query.objects.begin(), query.objects.end()) {
    std::set<std::string> known(data.object_names.begin(), data.object_names.end());
    for (const MoverGeometry &geometry : data.geometries) known.insert(moverOf(geometry.name));
    for (const Item &item : data.snapshot->world().items()) known.insert(*item.owner);
    for (const std::string &name : names_)
      if (known.count(name) == 0)
        throw Error("there is no object '" + name + "' in the scene" + didYouMean(name, {known.begin(), known.end()}));
  }

  bool has(const std::string &name) const {
    return names_.empty() || names_.count(name) > 0 || names_.count(moverOf(name)) > 0;
  }

 private:
  std::set<std::string> names_;
};

Pairs pairsOf(const Movers::Data &data, Against against, const Query &query) {
  Pairs out;
  const std::vector<bool> named = namedGeometries(data, query.links);
  const AskedObjects objects(data, query);
  const auto at = [](std::int32_t geometry) { return static_cast<std::size_t>(geometry); };
  if (against != Against::MOVERS) {
    for (const cprox_robot_pair &pair : data.environment) {
      const MoverGeometry &geometry = data.geometries[at(pair.geometry)];
      /* an object that stands is one of many that do, unless it is asked about */
      const bool counts = geometry.moves || (!query.moving_only && (!geometry.is_object || !query.links.empty()));
      if (counts && named[at(pair.geometry)] && objects.has(*data.snapshot->world().items()[at(pair.other)].owner))
        out.environment.push_back(pair);
    }
  }
  if (against != Against::OBJECTS) {
    for (std::size_t i = 0; i < data.among.size(); ++i) {
      const cprox_robot_pair &pair = data.among[i];
      if (query.moving_only && !data.among_moves[i]) continue;
      if (!objects.has(data.geometries[at(pair.geometry)].name) && !objects.has(data.geometries[at(pair.other)].name))
        continue;
      const bool self = data.geometries[at(pair.geometry)].mover == data.geometries[at(pair.other)].mover;
      if (self && against == Against::OTHERS) continue;
      if (named[at(pair.geometry)] || named[at(pair.other)]) out.among.push_back(pair);
    }
  }
  /* a list of no pairs would mean all of them to the core */
  if (out.among.empty()) {
    out.against = against == Against::MOVERS ? Against::MOVERS : Against::OBJECTS;
  } else {
    out.against = out.environment.empty() ? Against::MOVERS : Against::BOTH;
  }
  return out;
}

cprox_mover joinedMover(const Movers::Data &data, const Pairs &pairs) {
  if (pairs.against == Against::MOVERS)
    return cprox_robot_self(data.motion.get(), pairs.among.data(), pairs.among.size());
  const cprox_mover along = cprox_robot_along(data.motion.get(), pairs.environment.data(), pairs.environment.size());
  return pairs.against == Against::BOTH ? cprox_robot_whole(along, pairs.among.data(), pairs.among.size()) : along;
}

/* Those that stand, where pairs have one of them. */
std::vector<cprox_obstacle> obstaclesOf(const Movers::Data &data, const Pairs &pairs) {
  return pairs.against == Against::MOVERS ? std::vector<cprox_obstacle>() : data.obstacles;
}

Coverage coverageOf(const Movers::Data &data, const Pairs &pairs, const Query &query) {
  const bool nothing = pairs.environment.empty() && pairs.among.empty();
  return coverageOf(query, data.coverage, nothing ? "there is no pair to measure" : "");
}

void sayReplaced(const Query &query, bool is_mesh, Answer &answer) {
  if (!isReplaced(query.options.max_lod, is_mesh)) return;
  answer.by_hull = is_mesh;
  if (is_mesh) answer.message = MESH_BY_HULL;
  claimOneSide(answer.result);
}

/* Side a is one of the query's links, where there are any. */
void nameSides(const Movers::Data &data, Against against, const Query &query, Answer &answer) {
  cprox_result &result = answer.result;
  if (result.status < 0 || result.obstacle_index < 0) return;
  const MoverGeometry &moving = data.geometries[static_cast<std::size_t>(result.mover_part)];
  const std::size_t standing = against == Against::MOVERS ? 0 : data.obstacles.size();
  const auto index = static_cast<std::size_t>(result.obstacle_index);
  answer.a = moving.name;
  result.mover_part = moving.part;
  if (index < standing) {
    const Item &item = data.snapshot->world().items()[index];
    answer.b = *item.owner;
    result.obstacle_index = item.part;
    sayReplaced(query, moving.is_mesh || item.shape->is_mesh, answer);
    return;
  }
  const MoverGeometry &other = data.geometries[index - standing];
  sayReplaced(query, moving.is_mesh || other.is_mesh, answer);
  answer.kind = "movers";
  answer.b = other.name;
  answer.b_is_link = other.mover < data.robots.size();
  result.obstacle_index = other.part;
  if (isNamed(query.links, answer.a) || !isNamed(query.links, answer.b)) return;
  answer.b_is_link = moving.mover < data.robots.size();
  std::swap(answer.a, answer.b);
  std::swap(result.mover_part, result.obstacle_index);
  std::swap(result.witness_mover, result.witness_obstacle);
  result.normal = {-result.normal.x, -result.normal.y, -result.normal.z};
}

/* The query by the names of all movers, the time that it is about, and what its rows say. */
struct AskedMovers {
  Against against;
  const MovingRobot *robot;
  Query query;
  std::array<double, 2> interval{};

  AskedMovers(const Whom &whom, const Query &given) : against(whom.against), robot(whom.robot), query(given) {
    if (!robot) return;
    for (std::string &link : query.links) link = robot->name + "/" + link;
    if (query.links.empty()) query.links = {robot->name};
    if (robot->motion->stands() || std::isinf(robot->tolerance)) return;
    for (std::size_t i = 0; i < interval.size(); ++i)
      interval[i] = robot->motion->domain()[i] + robot->start + (i == 0 ? -robot->tolerance : robot->tolerance);
    query.options.interval = interval.data();
  }
  AskedMovers(const AskedMovers &) = delete;
  AskedMovers &operator=(const AskedMovers &) = delete;

  /* The kind of rows that name no pair. */
  std::string kind() const {
    return against == Against::MOVERS ? "movers" : "environment";
  }

  /* A row of a robot, which side a is, by its own name; other rows as nameSides() has them. */
  Answer seen(Answer answer) const {
    if (!robot) return answer;
    const std::string prefix = robot->name + "/";
    answer.kind = "environment";
    if (answer.a.rfind(prefix, 0) == 0) answer.a.erase(0, prefix.size());
    return answer;
  }
};

/* Leaves the proof of an answer, by its interval in the core's numbers. */
using Prove = void (*)(const Query &query, const cprox_mover &mover, const std::vector<cprox_obstacle> &obstacles,
                       const cprox_result &result, Workspace &workspace, Answer &answer);

template <class Core>
Answer answerOf(const Movers &movers, const AskedMovers &asked, const std::string &fault, Prove prove,
                Workspace &workspace, Core core) {
  const Movers::Data &data = movers.data();
  const Query &query = asked.query;
  const std::string kind = asked.kind();
  cprox_certificate_clear(query.options.certificate);
  if (!fault.empty()) return refusal("movers", kind, fault);
  const Clock::time_point start = Clock::now();
  Pairs pairs;
  try {
    pairs = pairsOf(data, asked.against, query);
  } catch (const Error &error) {
    return refusal("movers", kind, error.what());
  }
  Answer answer;
  answer.id = "movers";
  answer.kind = kind;
  answer.result.obstacle_index = -1;
  cprox_result found{};
  found.status = CPROX_INVALID;
  if (pairs.environment.empty() && pairs.among.empty()) {
    answerNothing(query, answer.result);
    answer.result.t_contact_lower = movers.domain()[1];
  } else {
    core(joinedMover(data, pairs), obstaclesOf(data, pairs), answer.result);
    if (answer.result.status < 0) answer.message = workspace.reason();
    found = answer.result;
    nameSides(data, pairs.against, query, answer);
  }
  if (query.moving_only && answer.result.status >= 0)
    answer.message += (answer.message.empty() ? "" : "; ") + std::string(MOVING_ONLY);
  answer.microseconds = microsecondsSince(start);
  if (answer.result.status != CPROX_OK && answer.message.empty())
    answer.message = cprox_status_text(answer.result.status);
  answer.status = cprox_status_name(answer.result.status);
  applyCoverage(coverageOf(data, pairs, query), query, answer);
  refuseSecondOpinion(query, "the peers are not asked about what moves beside the robot", answer);
  if (query.options.certificate)
    prove(query, joinedMover(data, pairs), obstaclesOf(data, pairs), found, workspace, answer);
  return answer;
}

Stated statedOf(const Movers::Data &data, const Pairs &pairs, const AskedMovers &asked) {
  const auto name = [&](Answer &answer) {
    nameSides(data, pairs.against, asked.query, answer);
    answer = asked.seen(std::move(answer));
  };
  return {joinedMover(data, pairs), obstaclesOf(data, pairs), data.rounding,
          pairs.environment.empty() && pairs.among.empty(), name};
}

/* Throws Error where movers cannot be asked in this way. */
void refuse(const std::string &fault) {
  if (!fault.empty()) throw Error(fault);
}

/* Where the numbers of one of the robots are in those of the joined one. Robots come first; one that stands has no
 * points. */
struct PlaceOfRobot {
  std::size_t variable = 0, point_value = 0;
  const RobotMotion::Data *data = nullptr;

  PlaceOfRobot(const Movers::Data &movers, std::size_t wanted) : data(&movers.robots[wanted]->data()) {
    for (std::size_t i = 0; i < wanted; ++i) {
      const RobotMotion::Data &before = movers.robots[i]->data();
      variable += before.kinematics->rest.size();
      if (!before.stands) point_value += before.shape.n_points * before.shape.variable.size();
    }
  }
};

/* Which of the robots it is: two may share a motion. */
std::size_t numberOf(const Movers::Data &movers, const MovingRobot &robot) {
  for (std::size_t i = 0; i < movers.robots.size(); ++i)
    if (movers.robot_names[i] == robot.name && movers.robots[i] == robot.motion) return i;
  throw Error("robot '" + robot.name + "' is none of the movers");
}

/* What the core writes derivatives of the joined robot to. */
struct JoinedArrays {
  std::vector<double> variables, positions, velocities, accelerations, starts, durations;

  explicit JoinedArrays(const Movers::Data &data) : variables(cprox_motion_get_info(data.motion.get()).n_variables) {
    std::size_t n = 0;
    for (const auto &motion : data.robots)
      if (!motion->data().stands) n += motion->data().shape.n_points * motion->data().shape.variable.size();
    for (std::vector<double> *rows : {&positions, &velocities, &accelerations}) rows->resize(n);
    for (std::vector<double> *each : {&starts, &durations}) each->resize(data.robots.size() + data.objects.size());
  }

  cprox_motion_gradient lend() {
    cprox_motion_gradient out{};
    out.t = std::numeric_limits<double>::quiet_NaN();
    out.variables = variables.data(), out.starts = starts.data(), out.durations = durations.data();
    out.positions = positions.data(), out.velocities = velocities.data(), out.accelerations = accelerations.data();
    return out;
  }
};

/* A least distance, and its derivatives as the core tells them. */
struct Differentiated {
  Answer answer;
  JoinedArrays arrays;
  cprox_motion_gradient gradient;
  std::string reason = "there is nothing to measure against";

  explicit Differentiated(const Movers::Data &data) : arrays(data), gradient(arrays.lend()) {}
  Differentiated(const Differentiated &) = delete; // gradient refers to arrays
  Differentiated &operator=(const Differentiated &) = delete;
};

void differentiate(const Movers &movers, const AskedMovers &asked, Workspace &workspace, Differentiated &out) {
  const Query &query = asked.query;
  refuse(faultOfMovers(query));
  refuse(faultOfDistances(query));
  const double rounding = movers.data().rounding;
  out.answer =
      answerOf(movers, asked, "", leaveProof, workspace,
               [&](const cprox_mover &mover, const std::vector<cprox_obstacle> &obstacles, cprox_result &result) {
                 const cprox_options options = withoutRounding(query.options, rounding);
                 const Obstacles set(obstacles, CPROX_INDEX_NONE);
                 const cprox_status status =
                     cprox_robot_distance_gradient(set.get(), mover, &options, workspace.get(), &result, &out.gradient);
                 if (status < 0) throw Error(workspace.reason(), status);
                 out.reason = workspace.reason();
                 widen(query, rounding, INFINITE, result);
               });
  if (out.answer.result.status < 0) throw Error(out.answer.message, out.answer.result.status);
}

/* By Danskin's theorem a rigid step of one side moves its nearest point along the normal. The name is that of a mover:
 * it may be side a or b, both or neither. */
void fillSteps(const Movers &movers, const Answer &answer, const std::string &name, bool is_robot,
               ClearanceGradient &out) {
  const Eigen::Vector3d normal = toEigen(answer.result.normal);
  if (answer.b.empty() || !normal.allFinite()) return;
  const bool is_a = moverOf(answer.a) == name, is_b = answer.kind == "movers" && moverOf(answer.b) == name;
  if (is_a == is_b) return;
  const Eigen::Vector3d a = toEigen(answer.result.witness_mover), b = toEigen(answer.result.witness_obstacle);
  const auto addObject = [&](const std::string &object, const Eigen::Vector3d &point, const Eigen::Vector3d &outwards) {
    const auto standing = movers.data().snapshot->objects().find(object);
    const Eigen::Isometry3d at = standing != movers.data().snapshot->objects().end()
                                     ? standing->second->description.pose
                                     : movers.objectPose(object, answer.result.t);
    out.object_linear = outwards;
    out.object_angular = (point - at.translation()).cross(outwards);
  };
  const Eigen::Vector3d outwards = is_a ? normal : Eigen::Vector3d(-normal);
  if (!is_robot) {
    addObject(name, is_a ? a : b, outwards);
    return;
  }
  out.base_linear = outwards;
  out.base_angular = (is_a ? a : b).cross(outwards);
  const bool meets_robot = is_a ? answer.b_is_link : answer.a.find('/') != std::string::npos;
  if (!meets_robot) addObject(is_a ? answer.b : answer.a, is_a ? b : a, -outwards);
}

/* By the motion of one of the movers, robots first. */
ClearanceGradient gradientBy(const Movers &movers, const Differentiated &in, std::size_t mover) {
  const Movers::Data &joined = movers.data();
  ClearanceGradient out;
  out.valid = in.gradient.valid;
  if (!out.valid) out.reason = in.reason;
  applyGap(in.answer, out);
  out.t = in.gradient.t, out.margin = in.gradient.margin;
  out.duration = in.arrays.durations[mover], out.start = in.arrays.starts[mover];
  const bool is_robot = mover < joined.robots.size();
  const std::string &name = is_robot ? joined.robot_names[mover] : joined.object_names[mover - joined.robots.size()];
  fillSteps(movers, in.answer, name, is_robot, out);
  if (!is_robot) return out;
  const PlaceOfRobot place(joined, mover);
  const RobotMotion::Data &data = *place.data;
  const TrajectoryShape &shape = data.shape;
  const auto rows = [&](const std::vector<double> &all) {
    return toMatrix(shape, data.stands ? nullptr : all.data() + place.point_value);
  };
  out.positions = rows(in.arrays.positions);
  if (shape.has_velocities) out.velocities = rows(in.arrays.velocities);
  if (shape.has_accelerations) out.accelerations = rows(in.arrays.accelerations);
  for (const auto &[joint, variable] : data.kinematics->variables)
    out.joints[joint] = in.arrays.variables[place.variable + static_cast<std::size_t>(variable)];
  for (std::size_t k = 0; data.stands && k < shape.variable.size(); ++k)
    out.positions(0, static_cast<Eigen::Index>(shape.column[k])) =
        in.arrays.variables[place.variable + static_cast<std::size_t>(shape.variable[k])];
  return out;
}

} // namespace

ClearanceRow clearanceGradient(const Movers &movers, const MovingRobot &robot, const Query &query,
                               Workspace &workspace) {
  const std::size_t number = numberOf(movers.data(), robot);
  const AskedMovers asked(robot, query);
  Differentiated found(movers.data());
  differentiate(movers, asked, workspace, found);
  ClearanceRow row;
  row.gradient = gradientBy(movers, found, number);
  row.answer = asked.seen(std::move(found.answer));
  const auto domain = asked.query.options.interval ? asked.interval : movers.domain();
  row.t0 = domain[0], row.t1 = domain[1];
  return row;
}

MoversClearance clearanceGradients(const Movers &movers, Against against, const Query &query, Workspace &workspace) {
  const Movers::Data &data = movers.data();
  Differentiated found(data);
  differentiate(movers, AskedMovers(against, query), workspace, found);
  MoversClearance out;
  for (std::size_t i = 0; i < data.robots.size() + data.objects.size(); ++i) {
    const bool is_robot = i < data.robots.size();
    out.gradients.push_back(
        {is_robot ? data.robot_names[i] : data.object_names[i - data.robots.size()], gradientBy(movers, found, i)});
  }
  out.answer = std::move(found.answer);
  return out;
}

std::vector<ClearanceInterval> clearanceProfile(const Movers &movers, const Whom &whom,
                                                const std::vector<double> &breaks, const Query &given,
                                                Workspace &workspace, double horizon) {
  AskedMovers asked(whom, given);
  asked.query.options.interval = given.options.interval; // breaks say which times
  const Query &query = asked.query;
  refuse(faultOfMovers(query));
  refuse(faultOfDistances(withoutCertificate(query)));
  refuse(faultOfProfile(query, breaks, horizon));
  if (query.options.interval) throw Error("an interval does not apply: breaks say where a profile begins and ends");
  const Movers::Data &data = movers.data();
  const Pairs pairs = pairsOf(data, asked.against, query);
  std::vector<ClearanceInterval> profile =
      searchProfile(statedOf(data, pairs, asked), breaks, horizon, query, workspace);
  applyCoverage(coverageOf(data, pairs, query), profile);
  return profile;
}

std::vector<Answer> nearestPairs(const Movers &movers, const Whom &whom, const PairLimits &limits, const Query &given,
                                 Workspace &workspace) {
  const AskedMovers asked(whom, given);
  const Query &query = asked.query;
  refuse(faultOfMovers(query));
  refuse(faultOfDistances(query));
  if (query.second_opinion) throw Error("a second opinion does not apply to what moves beside the robot");
  const Movers::Data &data = movers.data();
  const Pairs pairs = pairsOf(data, asked.against, query);
  const cprox_options options = withoutRounding(query.options, data.rounding);
  std::vector<Answer> out;
  Unlisted unlisted;
  const auto add = [&](const Pairs &some) {
    const std::size_t n = some.environment.size() + some.among.size();
    if (n == 0) return;
    const Clock::time_point start = Clock::now();
    const Obstacles set(obstaclesOf(data, some), CPROX_INDEX_NONE);
    std::vector<cprox_result> results(std::min(limits.count, n));
    cprox_listed listed{};
    const cprox_status status =
        cprox_obstacles_nearest_pairs(set.get(), joinedMover(data, some), limits.count, limits.within + data.rounding,
                                      &options, workspace.get(), results.data(), &listed);
    if (status < 0) throw Error(workspace.reason(), status);
    unlisted.add(status, listed, data.rounding);
    for (std::size_t i = 0; i < listed.count; ++i) {
      Answer answer;
      answer.id = "movers", answer.kind = "environment";
      answer.result = results[i];
      widen(query, data.rounding, INFINITE, answer.result);
      nameSides(data, some.against, query, answer);
      answer.microseconds = microsecondsSince(start);
      answer.status = cprox_status_name(answer.result.status);
      if (answer.result.status != CPROX_OK) answer.message = cprox_status_text(answer.result.status);
      out.push_back(asked.seen(std::move(answer)));
    }
  };
  add({Against::OBJECTS, pairs.environment, {}});
  add({Against::MOVERS, {}, pairs.among});
  const auto far = [](const cprox_result &one) { return std::isfinite(one.upper) ? one.upper : one.lower; };
  std::stable_sort(out.begin(), out.end(),
                   [&](const Answer &x, const Answer &y) { return far(x.result) < far(y.result); });
  for (std::size_t i = limits.count; i < out.size(); ++i)
    unlisted.lower = std::min(unlisted.lower, std::max(0.0, out[i].result.lower));
  if (out.size() > limits.count) out.resize(limits.count);
  unlisted.addRow(limits, query.options, "movers", asked.kind(), out);
  Answer nothing;
  nothing.id = "movers", nothing.kind = "environment";
  applyCoverage(coverageOf(data, pairs, query), query, nothing, out);
  return out;
}

Violations violations(const Movers &movers, const Whom &whom, double resolution, const Query &given,
                      Workspace &workspace) {
  const AskedMovers asked(whom, given);
  const Query &query = asked.query;
  checkViolations(query, resolution);
  refuse(faultOfMovers(query));
  const Movers::Data &data = movers.data();
  const Pairs pairs = pairsOf(data, asked.against, query);
  Violations found = searchViolations(statedOf(data, pairs, asked), resolution, query, workspace);
  applyCoverage(coverageOf(data, pairs, query), domainOf(query, movers.domain()), found);
  return found;
}

Answer ask(const Movers &movers, const Whom &whom, const Query &given, Workspace &workspace) {
  const AskedMovers asked(whom, given);
  const Query &query = asked.query;
  const double rounding = movers.data().rounding;
  const auto core = [&](const cprox_mover &mover, const std::vector<cprox_obstacle> &obstacles, cprox_result &result) {
    cprox_options options = withoutRounding(query.options, rounding);
    options.certificate = nullptr;
    result.status = askCore(query, options, mover, obstacles, workspace, result);
    if (result.status >= 0) widen(query, rounding, INFINITE, result);
  };
  return asked.seen(answerOf(movers, asked, faultOfMovers(query), leaveProof, workspace, core));
}

Answer timeOfContact(const Movers &movers, const Whom &whom, const Query &given, Workspace &workspace) {
  const AskedMovers asked(whom, given);
  const Query &query = asked.query;
  std::string fault = faultOfMovers(query);
  if (fault.empty()) fault = faultOfContact(query);
  const auto core = [&](const cprox_mover &mover, const std::vector<cprox_obstacle> &obstacles, cprox_result &result) {
    /* what is nearer than the rounding may be in contact: standing bodies grow by it */
    std::vector<cprox_obstacle> grown = obstacles;
    for (cprox_obstacle &obstacle : grown) obstacle.margin += movers.data().rounding;
    searchContact(mover, grown, query, workspace, result);
  };
  return asked.seen(answerOf(movers, asked, fault, leaveContactProof, workspace, core));
}

std::string describeQuery(const Movers &movers, const Whom &whom, const Query &given) {
  const AskedMovers asked(whom, given);
  const Movers::Data &data = movers.data();
  const Pairs pairs = pairsOf(data, asked.against, asked.query);
  if (pairs.environment.empty() && pairs.among.empty()) return {};
  const std::vector<cprox_obstacle> obstacles = obstaclesOf(data, pairs);
  std::vector<std::string> names;
  for (std::size_t i = 0; i < obstacles.size(); ++i) names.push_back(*data.snapshot->world().items()[i].owner);
  return describeQuery(joinedMover(data, pairs), obstacles, names, asked.robot ? asked.robot->name : "movers");
}

} // namespace curve_proximity
