/* SPDX-License-Identifier: BSD-3-Clause */
/** Which objects sensors keep, how old each is, and whether anything is known of it. */
#ifndef CURVE_PROXIMITY_ROS_SENSOR_BOARD_H
#define CURVE_PROXIMITY_ROS_SENSOR_BOARD_H

#include <curve_proximity/SensorState.h>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <limits>
#include <list>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "world/age.h"

namespace curve_proximity {

/** Any number of threads. */
class SensorBoard {
 public:
  /** From this version of the scene on the object is as a message of this stamp shows it. emptied_before: emptied()
   *  before it was put into the scene. Where it is another number now, the object may have gone again, and is unknown. */
  void saw(const std::string &id, const ros::Time &stamp, std::uint64_t emptied_before, std::uint64_t version = 0) {
    change(id, [&](Sensor &sensor) {
      sensor.before = sensor.now;
      sensor.now = {Age(stamp), emptied_before != emptied_};
      sensor.since = version;
    });
  }

  /** A message of this stamp had no valid point. */
  void sawNothing(const std::string &id, const ros::Time &stamp) {
    change(id, [&](Sensor &sensor) { sensor.now = {Age(stamp), true}; });
  }

  /** A message came that cannot be used: the object is as old as before, and what is there now is not known. */
  void refused(const std::string &id) {
    change(id, [](Sensor &sensor) { sensor.now.unknown = true; });
  }

  /** A sensor is expected to show the object; no message has come since the server started. */
  void awaits(const std::string &id) {
    change(id, [](Sensor &sensor) { sensor.now = {std::nullopt, true}; });
  }

  /** While this lives a change empties the scene, but for some objects. From then on nothing is known of what sensors
   *  see until their next messages. */
  class Emptying {
   public:
    Emptying(SensorBoard &board, std::vector<std::string> kept) : board_(board), kept_(std::move(kept)) {
      const std::lock_guard<std::mutex> lock(board_.mutex_);
      ++board_.emptied_;
      ++board_.changes_;
      board_.emptyings_.push_back(this);
    }
    ~Emptying() {
      const std::lock_guard<std::mutex> lock(board_.mutex_);
      ++board_.emptied_;
      ++board_.changes_;
      for (auto &[id, sensor] : board_.sensors_)
        if (!keeps(id)) sensor.before.unknown = sensor.now.unknown = true;
      board_.emptyings_.remove(this);
    }
    Emptying(const Emptying &) = delete;
    Emptying &operator=(const Emptying &) = delete;

    bool keeps(const std::string &id) const {
      return std::find(kept_.begin(), kept_.end(), id) != kept_.end();
    }

   private:
    SensorBoard &board_;
    const std::vector<std::string> kept_;
  };

  /** How often an Emptying has begun or ended. */
  std::uint64_t emptied() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return emptied_;
  }

  /** How often anything of this has changed. */
  std::uint64_t changes() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return changes_;
  }

  /** The object is no sensor's any more: somebody has set or removed it in this version of the scene. A message that
   *  came later stays. */
  void forget(const std::string &id, std::uint64_t version) {
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto found = sensors_.find(id);
    if (found == sensors_.end() || found->second.since > version) return;
    sensors_.erase(found);
    ++changes_;
  }

  /** Told of each object that was not there; set before the first message. */
  std::function<void()> appeared;

  /** version: of the scene that they are about, at most one message before the latest. */
  std::vector<SensorState> states(std::uint64_t version = std::numeric_limits<std::uint64_t>::max()) const {
    const std::lock_guard<std::mutex> lock(mutex_);
    std::vector<SensorState> out;
    for (const auto &[id, of] : sensors_) {
      const Sight &sensor = of.since <= version ? of.now : of.before;
      if (!sensor.age && !sensor.unknown) continue; // it was no sensor's yet
      SensorState state;
      state.id = id;
      state.age = sensor.age ? sensor.age->seconds() : std::numeric_limits<double>::infinity();
      state.unknown = sensor.unknown || std::any_of(emptyings_.begin(), emptyings_.end(),
                                                    [&id = id](const Emptying *one) { return !one->keeps(id); });
      out.push_back(state);
    }
    return out;
  }

 private:
  struct Sight {
    std::optional<Age> age;
    bool unknown = false;
  };
  struct Sensor {
    Sight now, before;       /* before: in versions of the scene before `since` */
    std::uint64_t since = 0; /* the version that has the object as it is now */
  };

  template <class Work>
  void change(const std::string &id, Work &&work) {
    bool is_new = false;
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      ++changes_;
      is_new = sensors_.count(id) == 0;
      work(sensors_[id]);
    }
    if (is_new && appeared) appeared();
  }

  mutable std::mutex mutex_;
  std::map<std::string, Sensor> sensors_;
  std::list<const Emptying *> emptyings_; /* under way */
  std::uint64_t emptied_ = 0, changes_ = 0;
};

} // namespace curve_proximity
#endif
