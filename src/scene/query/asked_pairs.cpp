/* SPDX-License-Identifier: BSD-3-Clause */
#include "asked_pairs.h"

#include <algorithm>
#include <limits>
#include <set>
#include <string_view>

#include <curve_proximity/nearest_name.hpp>

#include "answering.h"
#include "second_opinion.h"

namespace curve_proximity {
namespace {

double mostExcess(const std::vector<MovingGeometry> &geometries) {
  double most = 0.0;
  for (const MovingGeometry &geometry : geometries) most = std::max(most, geometry.excess);
  return most;
}

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

/* Of an answer that there is: what is special about it. */
void addWarnings(const RobotMotion::Data &data, const Query &query, Answer &answer) {
  if (answer.result.status < 0) return;
  const auto add = [&](const std::string &message) {
    answer.message += (answer.message.empty() ? "" : "; ") + message;
  };
  if (query.moving_only) add(MOVING_ONLY);
  for (const std::string &message : data.warnings) add(message);
}

void finish(const RobotMotion::Data &data, const Query &query, Answer &answer, Clock::time_point start) {
  answer.microseconds = microsecondsSince(start);
  if (answer.result.status != CPROX_OK && answer.message.empty())
    answer.message = cprox_status_text(answer.result.status);
  answer.status = cprox_status_name(answer.result.status);
  addWarnings(data, query, answer);
}

} // namespace

cprox_mover Asked::mover() const {
  if (against == RobotPairs::SELF) return cprox_robot_self(data.core.get(), pairs.data(), pairs.size());
  const cprox_mover along = cprox_robot_along(data.core.get(), pairs.data(), pairs.size());
  if (against == RobotPairs::ENVIRONMENT) return along;
  return cprox_robot_whole(along, self_pairs.data(), self_pairs.size());
}

Stated Asked::stated(const Query &query) const {
  return {mover(), obstacles, rounding, pairs.empty(), [&](Answer &answer) { nameSides(*this, query, answer); }};
}

Asked askedItems(const RobotMotion::Data &data, std::vector<std::size_t> wanted, const Query &query) {
  const Named named(data, query.links);
  Asked asked{data, RobotPairs::ENVIRONMENT, std::move(wanted), {}, {}, {}, mostExcess(data.kinematics->geometries)};
  const std::vector<Item> &items = data.snapshot->world().items();
  double rounding = 0.0;
  for (const std::size_t k : asked.items) {
    const PlacedShape &shape = *items[k].shape;
    requireBody(items[k]);
    const cprox_body_kind kind = cprox_body_get_info(shape.obstacle.body).kind;
    if (kind == CPROX_BODY_DISTANCE_GRID)
      throw Error("object '" + *items[k].owner + "' is a distance_grid: it is asked about curves, not about robots");
    const bool has_hull = kind != CPROX_BODY_MESH && kind != CPROX_BODY_POINTS && kind != CPROX_BODY_OCTREE;
    if (query.options.signed_distance && !has_hull)
      throw Error("signed_distance: object '" + *items[k].owner +
                  "' is a mesh without a hull, points or boxes: how deep a robot overlaps these is not measured");
    asked.obstacles.push_back(shape.obstacle);
    rounding = std::max(rounding, shape.rounding);
  }
  /* both ascend; what is not among a geometry's pairs is allowed to touch it */
  const auto before = [](const cprox_robot_pair &pair, std::size_t item) {
    return static_cast<std::size_t>(pair.other) < item;
  };
  for (std::size_t i = 0; i < data.wanted.size(); ++i) {
    const auto geometry = static_cast<std::int32_t>(i);
    if (!data.wanted[i] || (query.moving_only && !data.moves[i]) || !named(geometry)) continue;
    const std::vector<cprox_robot_pair> &pairs = data.prepared->environment[i];
    auto next = pairs.begin();
    for (std::size_t k = 0; k < asked.items.size(); ++k) {
      if (next == pairs.end() || static_cast<std::size_t>(next->other) != asked.items[k])
        next = std::lower_bound(next, pairs.end(), asked.items[k], before);
      if (next == pairs.end()) break;
      if (static_cast<std::size_t>(next->other) != asked.items[k]) continue;
      asked.pairs.push_back({geometry, static_cast<std::int32_t>(k)});
      ++next;
    }
  }
  asked.rounding += rounding;
  return asked;
}

Asked askedSelf(const RobotMotion::Data &data, const Query &query) {
  Asked asked{data, RobotPairs::SELF, {}, {}, {}, {}, 2.0 * mostExcess(data.kinematics->geometries)};
  const Named named(data, query.links);
  for (std::size_t i = 0; i < data.self.size(); ++i) {
    const cprox_robot_pair &pair = data.self[i];
    if (query.moving_only && !data.self_moves[i]) continue;
    if (named(pair.geometry) || named(pair.other)) asked.pairs.push_back(pair);
  }
  return asked;
}

std::vector<std::size_t> namedItems(const RobotMotion::Data &data, const std::vector<std::string> &names) {
  const std::string fault = faultOfMoving(*data.snapshot, names);
  if (!fault.empty()) throw Error(fault);
  for (const std::string &name : names) {
    if (data.snapshot->objects().count(name) == 0) throw Error("there is no object '" + name + "' in the scene");
  }
  const std::set<std::string_view> wanted(names.begin(), names.end());
  std::vector<std::size_t> out;
  const std::vector<Item> &items = data.snapshot->world().items();
  for (std::size_t k = 0; k < items.size(); ++k) {
    if (names.empty() || wanted.count(*items[k].owner) > 0) out.push_back(k);
  }
  return out;
}

void nameSides(const Asked &asked, const Query &query, Answer &answer) {
  cprox_result &result = answer.result;
  if (result.status < 0 || result.obstacle_index < 0) return;
  const std::vector<MovingGeometry> &geometries = asked.data.kinematics->geometries;
  const MovingGeometry &moving = geometries[static_cast<std::size_t>(result.mover_part)];
  const auto other = static_cast<std::size_t>(result.obstacle_index);
  answer.a = moving.owner();
  result.mover_part = moving.part;
  const bool deep = query.options.signed_distance && result.status == CPROX_OVERLAP;
  const bool coarse = query.options.max_lod != CPROX_LOD_MESH || deep;
  answer.by_hull = coarse && moving.is_mesh;
  if (asked.isSelf(result)) {
    const MovingGeometry &standing =
        geometries[asked.against == RobotPairs::WHOLE ? other - asked.obstacles.size() : other];
    answer.b = standing.owner();
    answer.b_is_link = !standing.attached;
    result.obstacle_index = standing.part;
    answer.by_hull = answer.by_hull || (coarse && standing.is_mesh);
  } else {
    const Item &item = asked.data.snapshot->world().items()[asked.items[other]];
    answer.b = *item.owner;
    result.obstacle_index = item.part;
    answer.by_hull = answer.by_hull || (item.shape->is_mesh && coarse);
    if (item.shape->is_open && !answer.by_hull)
      answer.message = "the nearest shape is a mesh that is not closed: its surface alone counts";
  }
  if (isReplaced(query.options.max_lod, answer.by_hull)) claimOneSide(result);
  if (!answer.by_hull) return;
  answer.message = deep ? "meshes overlap: their convex hulls say how deep at most" : MESH_BY_HULL;
}

Answer toAnswer(const Asked &asked, const cprox_result &result, const Query &query, const Workspace &workspace,
                Clock::time_point start) {
  Answer answer;
  answer.id = asked.data.id;
  answer.result = result;
  answer.kind = result.obstacle_index >= 0 && asked.isSelf(result) ? "self" : "environment";
  if (asked.against == RobotPairs::SELF) answer.kind = "self";
  if (result.status < 0) {
    answer.message = workspace.reason();
  } else {
    if (!asked.pairs.empty()) widen(query, asked.rounding, asked.left_out, answer.result);
    nameSides(asked, query, answer);
  }
  finish(asked.data, query, answer, start);
  applyCoverage(coverageOf(query, asked), query, answer);
  addSecondOpinion(asked.data, query, answer);
  return answer;
}

Coverage coverageOf(const Query &query, const Asked &asked) {
  const char *nothing = "";
  if (asked.pairs.empty()) {
    const bool no_object = asked.against != RobotPairs::SELF && asked.obstacles.empty();
    nothing = no_object ? NO_OBJECT : "there is no pair to measure (--skipped, RobotMotion::skipped() say why)";
  }
  return coverageOf(query, asked.data.coverage, nothing);
}

std::string faultInAll(RobotPairs against, const Query &query) {
  if (against == RobotPairs::SELF && !query.objects.empty())
    return "objects do not apply to a robot against itself, '" + query.objects.front() + "' among them";
  return faultOfMotion(query, true);
}

void checkDistances(RobotPairs against, const Query &query) {
  std::string fault = faultOfDistances(query);
  if (fault.empty()) fault = faultInAll(against, query);
  if (!fault.empty()) throw Error(fault);
}

Asked askedOf(const RobotMotion &motion, RobotPairs against, const Query &query) {
  const RobotMotion::Data &data = motion.data();
  if (against == RobotPairs::SELF) return askedSelf(data, query);
  Asked asked = askedItems(data, namedItems(data, query.objects), query);
  if (against == RobotPairs::ENVIRONMENT) return asked;
  Asked self = askedSelf(data, query);
  if (self.pairs.empty()) return asked;
  if (asked.pairs.empty()) return self;
  asked.against = RobotPairs::WHOLE;
  asked.self_pairs = std::move(self.pairs);
  asked.rounding = std::max(asked.rounding, self.rounding);
  return asked;
}

} // namespace curve_proximity
