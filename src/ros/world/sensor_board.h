/* SPDX-License-Identifier: BSD-3-Clause */
/** Which objects sensors keep, how old each is, and whether anything is known of it. */
#ifndef CURVE_PROXIMITY_ROS_SENSOR_BOARD_H
#define CURVE_PROXIMITY_ROS_SENSOR_BOARD_H

#include <curve_proximity/SensorState.h>

#include <functional>
#include <limits>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "world/age.h"

namespace curve_proximity {

/** Any number of threads. */
class SensorBoard {
 public:
  /** The object is as a message of this stamp shows it. */
  void saw(const std::string &id, const ros::Time &stamp) {
    set(id, {Age(stamp), false});
  }

  /** A message of this stamp had no valid point. */
  void sawNothing(const std::string &id, const ros::Time &stamp) {
    set(id, {Age(stamp), true});
  }

  /** A message came that cannot be used: the object is as old as before, and what is there now is not known. */
  void refused(const std::string &id) {
    change(id, [](Sensor &sensor) { sensor.unknown = true; });
  }

  /** A sensor is expected to show the object; no message has come since the server started. */
  void awaits(const std::string &id) {
    set(id, {std::nullopt, true});
  }

  /** The scene was emptied: nothing is known of what sensors see until their next messages. */
  void awaitsAll() {
    const std::lock_guard<std::mutex> lock(mutex_);
    for (auto &sensor : sensors_) sensor.second.unknown = true;
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
      state.unknown = sensor.unknown;
      out.push_back(state);
    }
    return out;
  }

 private:
  struct Sensor {
    std::optional<Age> age;
    bool unknown = false;
  };

  void set(const std::string &id, const Sensor &now) {
    change(id, [&](Sensor &sensor) { sensor = now; });
  }

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
};

} // namespace curve_proximity
#endif
