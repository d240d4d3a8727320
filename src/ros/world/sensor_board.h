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
  /** The object is as a message of this stamp shows it. emptied_before: emptied() before it was put into the scene.
   *  Where it is another number now, the object may have gone again, and is unknown. */
  void saw(const std::string &id, const ros::Time &stamp, std::uint64_t emptied_before) {
    change(id, [&](Sensor &sensor) { sensor = {Age(stamp), emptied_before != emptied_}; });
  }

  /** A message of this stamp had no valid point. */
  void sawNothing(const std::string &id, const ros::Time &stamp) {
    change(id, [&](Sensor &sensor) { sensor = {Age(stamp), true}; });
  }

  /** A message came that cannot be used: the object is as old as before, and what is there now is not known. */
  void refused(const std::string &id) {
    change(id, [](Sensor &sensor) { sensor.unknown = true; });
  }

  /** A sensor is expected to show the object; no message has come since the server started. */
  void awaits(const std::string &id) {
    change(id, [](Sensor &sensor) { sensor = {std::nullopt, true}; });
  }

  /** While this lives a change empties the scene, but for some objects. From then on nothing is known of what sensors
   *  see until their next messages. */
  class Emptying {
   public:
    Emptying(SensorBoard &board, std::vector<std::string> kept) : board_(board), kept_(std::move(kept)) {
      const std::lock_guard<std::mutex> lock(board_.mutex_);
      ++board_.emptied_;
      board_.emptyings_.push_back(this);
    }
    ~Emptying() {
      const std::lock_guard<std::mutex> lock(board_.mutex_);
      ++board_.emptied_;
      for (auto &sensor : board_.sensors_)
        if (!keeps(sensor.first)) sensor.second.unknown = true;
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

  /** The object is no sensor's any more: somebody has set or removed it. */
  void forget(const std::string &id) {
    const std::lock_guard<std::mutex> lock(mutex_);
    sensors_.erase(id);
  }

  /** Told of each object that was not there; set before the first message. */
  std::function<void()> appeared;

  std::vector<SensorState> states() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    std::vector<SensorState> out;
    for (const auto &[id, sensor] : sensors_) {
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
  struct Sensor {
    std::optional<Age> age;
    bool unknown = false;
  };

  template <class Work>
  void change(const std::string &id, Work &&work) {
    bool is_new = false;
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      is_new = sensors_.count(id) == 0;
      work(sensors_[id]);
    }
    if (is_new && appeared) appeared();
  }

  mutable std::mutex mutex_;
  std::map<std::string, Sensor> sensors_;
  std::list<const Emptying *> emptyings_; /* under way */
  std::uint64_t emptied_ = 0;
};

} // namespace curve_proximity
#endif
