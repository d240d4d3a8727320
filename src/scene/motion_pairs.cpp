/* SPDX-License-Identifier: BSD-3-Clause */
/* Which pairs a query about a robot in motion is about, and why others are not. */
#include <algorithm>
#include <set>

#include "motion_data.h"

namespace curve_proximity {
namespace {

using Links = std::array<std::string, 2>;

/* ---- the pairs ---- */

Links ordered(const std::string &a, const std::string &b) {
  return a < b ? Links{a, b} : Links{b, a};
}

bool moves(const RobotMotion::Data &data, const MovingGeometry &geometry) {
  const auto link = static_cast<std::int32_t>(data.kinematics->links.at(*geometry.link));
  return data.stands || cprox_motion_get_link_info(data.core.get(), link, -1).n_moved > 0;
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

/* Why two geometries of the robot are not asked about; "" where they are. Neighbours in the chain overlap by their
 * making; what is carried does not, and is asked about as soon as a joint moves it against the other. */
std::string exemptionOf(const MovingGeometry &a, const MovingGeometry &b, const RobotMotion::Data &data,
                        const std::set<Links> &off) {
  const auto link_a = static_cast<std::int32_t>(data.kinematics->links.at(*a.link));
  const auto link_b = static_cast<std::int32_t>(data.kinematics->links.at(*b.link));
  const cprox_link_info between = cprox_motion_get_link_info(data.core.get(), link_a, link_b);
  const bool carried = a.attached || b.attached;
  const std::size_t moved = data.stands ? between.n_joints : between.n_moved; // of a robot that stands all joints count
  if (carried && moved == 0) return "this trajectory does not move them against each other";
  if (!carried && (between.n_joints < 2 || moved == 0))
    return "this trajectory does not move them against each other, or a single joint does";
  if (mayTouch(a, b) || mayTouch(b, a)) return "it is one of its touch_links";
  if (!carried && off.count(ordered(*a.link, *b.link)) > 0) return "the SRDF disables them";
  return data.snapshot->mayTouch(a.owner(), b.owner()) ? "they are allowed to touch" : "";
}

} // namespace

void choosePairs(const std::vector<Links> &disabled, const std::vector<std::string> &only, RobotMotion::Data &data) {
  const std::vector<MovingGeometry> &geometries = data.kinematics->geometries;
  std::set<Links> off;
  for (const Links &pair : disabled) off.insert(ordered(pair[0], pair[1]));
  std::set<std::string> told;
  const auto tell = [&](const std::string &sentence) {
    if (told.insert(sentence).second) data.skipped.push_back(sentence);
  };

  const auto wanted = [&](const MovingGeometry &geometry) {
    return only.empty() || std::find(only.begin(), only.end(), *geometry.link) != only.end();
  };

  const std::vector<Item> &items = data.snapshot->world().items();
  for (std::size_t i = 0; i < geometries.size(); ++i) {
    const std::string name = nameOf(geometries[i]);

    /* what it may touch in the scene */
    if (!wanted(geometries[i])) tell(name + ": the query does not name it");
    if (!moves(data, geometries[i])) tell(name + ": the trajectory does not move it");
    for (std::size_t k = 0; k < items.size() && wanted(geometries[i]) && moves(data, geometries[i]); ++k) {
      const std::string &object = *items[k].owner;
      if (data.snapshot->mayTouch(geometries[i].owner(), object)) {
        tell(name + " and object '" + object + "': they are allowed to touch");
      } else {
        data.environment.push_back({static_cast<std::int32_t>(i), static_cast<std::int32_t>(k)});
      }
    }

    /* and of itself */
    for (std::size_t k = i + 1; k < geometries.size(); ++k) {
      if (geometries[i].link == geometries[k].link) continue;
      if (!wanted(geometries[i]) && !wanted(geometries[k])) continue;
      const std::string why = exemptionOf(geometries[i], geometries[k], data, off);
      if (why.empty()) {
        data.self.push_back({static_cast<std::int32_t>(i), static_cast<std::int32_t>(k)});
      } else {
        tell(nameOf(geometries[i], geometries[k]) + ": " + why);
      }
    }
  }
}

} // namespace curve_proximity
