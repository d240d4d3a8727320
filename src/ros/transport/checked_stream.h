/* SPDX-License-Identifier: BSD-3-Clause */
/** Reads messages whose bytes may claim more elements than they hold. */
#ifndef CURVE_PROXIMITY_ROS_CHECKED_STREAM_H
#define CURVE_PROXIMITY_ROS_CHECKED_STREAM_H

#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/serialization.h>
#include <ros/subscribe_options.h>
#include <ros/subscription_callback_helper.h>

#include <algorithm>
#include <boost/array.hpp>
#include <boost/make_shared.hpp>
#include <cstdint>
#include <cstring>
#include <functional>
#include <string>
#include <vector>

namespace curve_proximity {

/** In place of ros::serialization::IStream, which resizes a vector to whatever count stands before it: this one first
 *  looks whether the bytes left can hold so many elements. So a message takes at most a few times its bytes: an empty
 *  string, the worst, 32 bytes for 4. Throws ros::serialization::StreamOverrunException. */
class CheckedStream {
 public:
  CheckedStream(std::uint8_t *data, std::size_t size) : at_(data), end_(data + size) {}

  /** The parts of generated messages come here. */
  template <class T>
  void next(T &value) {
    ros::serialization::Serializer<T>::read(*this, value);
  }

  template <class T, std::size_t N>
  void next(boost::array<T, N> &values) {
    for (T &value : values) next(value);
  }

  template <class T, class Allocator>
  void next(std::vector<T, Allocator> &values) {
    static const std::size_t least = leastSizeOf<T>();
    std::uint32_t count = 0;
    next(count);
    if (count > static_cast<std::size_t>(end_ - at_) / least) overrun();
    values.resize(count);
    if constexpr (ros::message_traits::IsSimple<T>::value) {
      const std::size_t bytes = count * sizeof(T);
      std::uint8_t *from = advance(static_cast<std::uint32_t>(bytes));
      if (bytes > 0) std::memcpy(values.data(), from, bytes);
    } else {
      for (T &value : values) next(value);
    }
  }

  /** The next bytes. */
  std::uint8_t *advance(std::uint32_t size) {
    if (size > static_cast<std::size_t>(end_ - at_)) overrun();
    std::uint8_t *from = at_;
    at_ += size;
    return from;
  }

 private:
  /* On the wire an element takes no less than one without text and without elements of its own. */
  template <class T>
  static std::size_t leastSizeOf() {
    return std::max(1u, ros::serialization::serializationLength(T()));
  }

  [[noreturn]] static void overrun() {
    throw ros::serialization::StreamOverrunException("the message is shorter than its counts say");
  }

  std::uint8_t *at_;
  std::uint8_t *const end_;
};

/** The same node, its callbacks on a queue of their own. */
inline ros::NodeHandle onQueue(const ros::NodeHandle &handle, ros::CallbackQueue &queue) {
  ros::NodeHandle own(handle);
  own.setCallbackQueue(&queue);
  return own;
}

/** As ros::NodeHandle::subscribe(), by CheckedStream. Within a process messages go by pointer, as ever.
 *  Parameter: of the callback. */
template <class Message, class Parameter = const boost::shared_ptr<const Message> &, class Callback>
ros::SubscribeOptions checkedSubscription(const std::string &topic, std::uint32_t queue_size, Callback callback) {
  class Helper : public ros::SubscriptionCallbackHelperT<Parameter> {
   public:
    using ros::SubscriptionCallbackHelperT<Parameter>::SubscriptionCallbackHelperT;
    ros::VoidConstPtr deserialize(const ros::SubscriptionCallbackHelperDeserializeParams &params) override {
      const auto message = boost::make_shared<Message>();
      CheckedStream stream(params.buffer, params.length);
      stream.next(*message);
      return message;
    }
  };
  ros::SubscribeOptions options;
  options.init<Message>(topic, queue_size, {});
  options.helper = boost::make_shared<Helper>(callback);
  return options;
}

} // namespace curve_proximity
#endif
