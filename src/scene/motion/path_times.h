/* SPDX-License-Identifier: BSD-3-Clause */
/** When something that rides along a nav_msgs/Path is at each of its poses: the same for the node and for files. */
#ifndef CURVE_PROXIMITY_SCENE_PATH_TIMES_H
#define CURVE_PROXIMITY_SCENE_PATH_TIMES_H

#include <algorithm>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace curve_proximity {

struct PathTimes {
  std::vector<double> times; /**< [s] ascending, the first is 0 */
  std::int64_t origin = 0;   /**< [ns] the stamp of time 0; 0: none */
  std::string remark;        /**< what a reader should know of them; empty: they are those of the stamps */
};

/** The times of the stamps of poses [ns], one at least. Where these do not ascend, pose i is at i. `header`: the path's
 *  own stamp, which is that of time 0 where the poses have none. */
inline PathTimes timesOf(const std::vector<std::int64_t> &stamps, std::int64_t header) {
  constexpr double SECOND = 1e9;
  PathTimes out;
  out.origin = header;
  if (std::adjacent_find(stamps.begin(), stamps.end(), std::greater_equal<>()) == stamps.end()) {
    for (const std::int64_t stamp : stamps) out.times.push_back(static_cast<double>(stamp - stamps.front()) / SECOND);
    if (stamps.size() > 1 && stamps.front() != 0) out.origin = stamps.front();
    return out;
  }
  const bool same = std::adjacent_find(stamps.begin(), stamps.end(), std::not_equal_to<>()) == stamps.end();
  out.remark =
      same ? "its stamps are all the same: t counts its poses" : "its stamps do not ascend: t counts its poses";
  for (std::size_t i = 0; i < stamps.size(); ++i) out.times.push_back(static_cast<double>(i));
  return out;
}

} // namespace curve_proximity
#endif
