/* SPDX-License-Identifier: BSD-3-Clause */
/** What a request may hold: so much of each thing, and no id or name longer than ~max_name_length. */
#ifndef CURVE_PROXIMITY_ROS_REQUEST_LIMITS_H
#define CURVE_PROXIMITY_ROS_REQUEST_LIMITS_H

#include <curve_proximity/Body.h>
#include <ros/message_traits.h>
#include <ros/serialization.h>

#include <algorithm>
#include <curve_proximity/core.hpp>
#include <string>
#include <type_traits>
#include <vector>

namespace curve_proximity {

/** Throws Error for more of something than a parameter allows. */
inline void demandAtMost(const char *parameter, int most, std::size_t count, const char *what) {
  if (count <= static_cast<std::size_t>(most)) return;
  throw Error(std::to_string(count) + " " + what + " are more than ~" + parameter + " = " + std::to_string(most));
}

/** Answers repeat ids and names once a row. Visits all texts of a message, as its serializer does. A body may name a
 *  file, so its texts may be as long as a path. */
class NameLimits {
 public:
  explicit NameLimits(int most) : most_(static_cast<std::size_t>(most)) {}

  /** Throws Error for the first text that is too long, with its message's type and its first letters. */
  template <class Message>
  void check(const Message &message) const {
    NameLimits(*this).next(message);
  }

  /** The parts of generated messages come here. */
  template <class T>
  void next(const T &value) {
    if constexpr (std::is_same_v<T, std::string>) {
      if (value.size() > most_)
        throw Error("'" + value.substr(0, 32) + "…', a text of a " + type_ + ", has " + std::to_string(value.size()) +
                    " bytes, more than ~max_name_length = " + std::to_string(most_));
    } else if constexpr (!ros::message_traits::IsFixedSize<T>::value) {
      NameLimits inside(*this);
      inside.type_ = ros::message_traits::datatype<T>();
      if constexpr (std::is_same_v<T, Body>) inside.most_ = std::max(most_, LONGEST_PATH);
      ros::serialization::Serializer<T>::write(inside, value);
    }
  }

  template <class T, class Allocator>
  void next(const std::vector<T, Allocator> &values) {
    if constexpr (!ros::message_traits::IsFixedSize<T>::value)
      for (const T &value : values) next(value);
  }

 private:
  static constexpr std::size_t LONGEST_PATH = 4096;

  std::size_t most_;
  const char *type_ = "message";
};

} // namespace curve_proximity
#endif
