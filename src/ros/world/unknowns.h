/* SPDX-License-Identifier: BSD-3-Clause */
/** What is not known of the scene: what was expected and has not come, and what came and could not be used. */
#ifndef CURVE_PROXIMITY_ROS_UNKNOWNS_H
#define CURVE_PROXIMITY_ROS_UNKNOWNS_H

#include <curve_proximity/coverage.hpp>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

namespace curve_proximity {

/** One thing, as a message. */
struct Unknown {
  std::string message;
  std::string object; /**< what it is about; "": anything, also objects that are named, and what the robot carries */
  Missing missing = Missing::GEOMETRY;

  bool operator==(const Unknown &other) const {
    return message == other.message && object == other.object && missing == other.missing;
  }
};

/** By the source that says so. */
using UnknownsBySource = std::map<std::string, std::vector<Unknown>>;

/** Rows that take in what is unknown are never clear. Any number of threads. */
class Unknowns {
 public:
  /** Those of one source take the place of those that it told before; none: all is known. */
  void set(const std::string &source, std::vector<Unknown> unknowns) {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      const auto before = sources_.find(source);
      if (before == sources_.end() ? unknowns.empty() : before->second == unknowns) return;
      if (unknowns.empty())
        sources_.erase(source);
      else
        sources_[source] = std::move(unknowns);
    }
    if (changed) changed();
  }

  void forget(const std::string &source) {
    set(source, {});
  }

  /** Those of all sources whose names begin so. */
  void forgetAll(const std::string &prefix) {
    for (const auto &source : bySource())
      if (source.first.compare(0, prefix.size(), prefix) == 0) forget(source.first);
  }

  UnknownsBySource bySource() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return sources_;
  }

  /** Called after each change; set before there are threads. */
  std::function<void()> changed;

  /** Of all sources. */
  std::vector<Unknown> all() const {
    std::vector<Unknown> out;
    for (const auto &source : bySource()) out.insert(out.end(), source.second.begin(), source.second.end());
    return out;
  }

 private:
  mutable std::mutex mutex_;
  UnknownsBySource sources_;
};

} // namespace curve_proximity
#endif
