/* SPDX-License-Identifier: BSD-3-Clause */
/* Which pairs a query about a robot in motion is about, and why others are not. */
#include <curve_proximity/nearest_name.hpp>

#include <algorithm>
#include <set>
#include <string_view>
#include <unordered_set>
#include <utility>

#include "motion_data.h"

namespace curve_proximity {
namespace {

using Links = std::array<std::string, 2>;
using LinkNames = std::pair<std::string_view, std::string_view>;

const std::string NO_NAME; /* no matrix has an entry of it */

/* ---- the pairs ---- */

LinkNames ordered(std::string_view a, std::string_view b) {
  return a < b ? LinkNames{a, b} : LinkNames{b, a};
}

std::string nameOf(const MovingGeometry &geometry) {
  return (geometry.attached ? "object '" : "link '") + geometry.owner() + "'";
}

std::string nameOf(const MovingGeometry &a, const MovingGeometry &b) {
  if (a.attached || b.attached) return nameOf(a) + " and " + nameOf(b);
  return "links '" + *a.link + "' and '" + *b.link + "'";
}

/* What an object may touch as long as a link carries it. */
bool mayTouch(const MovingGeometry &a, const MovingGeometry &b) {
  if (!a.attached || b.attached) return false;
  const std::vector<std::string> &touch = a.attached->touch_links;
  return std::find(touch.begin(), touch.end(), *b.link) != touch.end();
}

/* Why two geometries of the robot are never measured; "" where the motion decides. */
const char *exemptionOf(const MovingGeometry &a, const MovingGeometry &b, const Snapshot &snapshot,
                        const std::set<LinkNames> &off) {
  const bool carried = a.attached || b.attached;
  if (mayTouch(a, b) || mayTouch(b, a)) return "it is one of its touch_links";
  if (!carried && off.count(ordered(*a.link, *b.link)) > 0) return "the SRDF disables them";
  return snapshot.mayTouch(a.owner(), b.owner()) ? "they are allowed to touch" : "";
}

/* The items of each object of the world, and whether the matrix names the object: all others are alike in it. */
struct ObjectItems {
  std::size_t begin, end;
  bool is_named;
};

std::vector<ObjectItems> objectItems(const Snapshot &snapshot) {
  std::unordered_set<std::string_view> named;
  for (const AllowedPair &pair : snapshot.allowed()) named.insert({pair.a, pair.b});
  const std::vector<Item> &items = snapshot.world().items();
  std::vector<ObjectItems> out;
  for (std::size_t k = 0; k < items.size(); ++k) { // the items of an object are neighbours
    if (k == 0 || items[k].owner != items[k - 1].owner) out.push_back({k, k, named.count(*items[k].owner) > 0});
    out.back().end = k + 1;
  }
  return out;
}

/* Does the motion move the geometry against the world? */
bool moves(const RobotMotion::Data &data, std::size_t geometry) {
  return data.stands || cprox_motion_get_link_info(data.core.get(), data.prepared->link[geometry], -1).n_moved > 0;
}

/* The joints between pairs of links, in a time that does not grow with their number: of one first link after the other,
 * and of each all second ones. */
class JointsBetween {
 public:
  explicit JointsBetween(const RobotMotion::Data &data) : data_(data), parents_(data.kinematics->parents) {
    for (std::size_t i = 0; i < parents_.size(); ++i)
      own_.push_back(cprox_motion_get_link_info(data.core.get(), static_cast<std::int32_t>(i), parents_[i]));
  }

  cprox_link_info operator()(const SelfPair &pair) {
    const std::vector<std::int32_t> &link = data_.prepared->link;
    const std::int32_t first = link[static_cast<std::size_t>(pair.pair.geometry)];
    if (first != first_) count(first);
    return from_first_[static_cast<std::size_t>(link[static_cast<std::size_t>(pair.pair.other)])];
  }

 private:
  /* Up from the first link to the fixed frame; every other link adds its own joints to those of its parent. */
  void count(std::int32_t first) {
    first_ = first;
    from_first_.assign(parents_.size(), {});
    std::vector<bool> is_above(parents_.size(), false);
    cprox_link_info sum{};
    for (int i = first; i >= 0; i = parents_[static_cast<std::size_t>(i)]) {
      const auto at = static_cast<std::size_t>(i);
      is_above[at] = true;
      from_first_[at] = sum;
      add(own_[at], sum);
    }
    for (std::size_t i = 0; i < parents_.size(); ++i) { // parents come first
      if (is_above[i]) continue;
      from_first_[i] = parents_[i] < 0 ? sum : from_first_[static_cast<std::size_t>(parents_[i])];
      add(own_[i], from_first_[i]);
    }
  }
  static void add(const cprox_link_info &own, cprox_link_info &sum) {
    sum.n_joints += own.n_joints;
    sum.n_moved += own.n_moved;
  }

  const RobotMotion::Data &data_;
  const std::vector<int> &parents_;
  std::vector<cprox_link_info> own_, from_first_; /* of each link: to its parent; to the first link */
  std::int32_t first_ = -1;
};

/* Why a pair is left out; "" where it is not. Neighbours in the chain overlap by design; what is carried does not, and
 * is measured where a joint can move it against the other. */
const char *leftOut(const SelfPair &pair, std::size_t joints) {
  if (pair.carried) return joints < 1 ? "no joint can move them against each other" : "";
  return joints < 2 ? "at most one joint can move them against each other" : "";
}

bool isWanted(const RobotMotion::Data &data, const SelfPair &pair) {
  return data.wanted[static_cast<std::size_t>(pair.pair.geometry)] ||
         data.wanted[static_cast<std::size_t>(pair.pair.other)];
}

} // namespace

void preparePairs(const std::vector<Links> &disabled, PreparedRobot::Data &data) {
  const std::vector<MovingGeometry> &geometries = data.kinematics->geometries;
  const std::vector<Item> &items = data.snapshot->world().items();
  std::set<LinkNames> off;
  for (const Links &pair : disabled) off.insert(ordered(pair[0], pair[1]));

  const std::vector<ObjectItems> objects = objectItems(*data.snapshot);
  data.self.reserve(geometries.size() * geometries.size() / 2);
  data.environment.resize(geometries.size());
  data.allowed.resize(geometries.size());
  for (const MovingGeometry &geometry : geometries)
    data.link.push_back(static_cast<std::int32_t>(data.kinematics->links.at(*geometry.link)));
  for (std::size_t i = 0; i < geometries.size(); ++i) {
    if (geometries[i].within) continue;
    const bool may_touch_all = data.snapshot->mayTouch(geometries[i].owner(), NO_NAME);
    data.environment[i].reserve(items.size());
    for (const ObjectItems &object : objects) {
      const std::string &owner = *items[object.begin].owner;
      if (object.is_named ? data.snapshot->mayTouch(geometries[i].owner(), owner) : may_touch_all) {
        data.allowed[i].push_back(owner);
        continue;
      }
      for (std::size_t k = object.begin; k < object.end; ++k)
        data.environment[i].push_back({static_cast<std::int32_t>(i), static_cast<std::int32_t>(k)});
    }
    for (std::size_t k = i + 1; k < geometries.size(); ++k) {
      if (geometries[k].within || geometries[i].link == geometries[k].link) continue;
      data.self.push_back({{geometries[i].unpadded, geometries[k].unpadded},
                           geometries[i].attached || geometries[k].attached,
                           exemptionOf(geometries[i], geometries[k], *data.snapshot, off)});
    }
  }
}

void choosePairs(const std::vector<std::string> &links, RobotMotion::Data &data) {
  const PreparedRobot::Data &prepared = *data.prepared;
  const Kinematics &kinematics = *prepared.kinematics;
  for (const std::string &link : links) {
    if (kinematics.links.count(link) == 0)
      throw Error("link '" + link + "' is no link of robot '" + kinematics.robot->name() + "'" +
                  didYouMean(link, namesOf(kinematics.links)));
  }
  for (const MovingGeometry &geometry : kinematics.geometries)
    data.wanted.push_back(links.empty() || std::find(links.begin(), links.end(), *geometry.link) != links.end());

  for (std::size_t i = 0; i < kinematics.geometries.size(); ++i) data.moves.push_back(moves(data, i));
  JointsBetween between(data);
  for (const SelfPair &pair : prepared.self) {
    if (*pair.exemption != '\0' || !isWanted(data, pair)) continue;
    const cprox_link_info info = between(pair);
    if (*leftOut(pair, info.n_joints) != '\0') continue;
    data.self.push_back(pair.pair);
    data.self_moves.push_back(data.stands || info.n_moved > 0);
  }
}

std::vector<std::string> skippedPairs(const RobotMotion::Data &data) {
  const PreparedRobot::Data &prepared = *data.prepared;
  const std::vector<MovingGeometry> &geometries = prepared.kinematics->geometries;
  std::vector<std::string> out;
  std::set<std::string> told;
  JointsBetween between(data);
  const auto tell = [&](const std::string &message) {
    if (told.insert(message).second) out.push_back(message);
  };
  for (std::size_t i = 0, next = 0; i < geometries.size(); ++i) {
    const std::string name = nameOf(geometries[i]);
    if (!data.wanted[i]) tell(name + ": the query does not name it");
    if (geometries[i].is_open) tell(name + ": a mesh of it is not closed: its surface alone counts");
    for (const std::string &object : prepared.allowed[i]) {
      if (data.wanted[i]) tell(name + " and object '" + object + "': they are allowed to touch");
    }
    for (; next < prepared.self.size(); ++next) {
      const SelfPair &pair = prepared.self[next];
      if (static_cast<std::size_t>(pair.pair.geometry) != i) break;
      const char *left_out = leftOut(pair, between(pair).n_joints);
      const std::string why = *left_out != '\0' ? left_out : pair.exemption;
      if (isWanted(data, pair) && !why.empty())
        tell(nameOf(geometries[i], geometries[static_cast<std::size_t>(pair.pair.other)]) + ": " + why);
    }
  }
  return out;
}

} // namespace curve_proximity
