/* SPDX-License-Identifier: BSD-3-Clause */
/** Identifies messages by their content: stamps may be 0 or equal. */
#ifndef CURVE_PROXIMITY_FINGERPRINT_HPP
#define CURVE_PROXIMITY_FINGERPRINT_HPP

#include <ros/message_traits.h>
#include <ros/serialization.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <vector>

namespace curve_proximity {

/** A 64-bit hash of a message.
 *
 *  The hash covers the serialised bytes. Of a message that begins with a Header, header.seq counts as 0, because roscpp
 *  changes it at each hop. The hash begins with h = 0xcbf29ce484222325 ^ length. For each eight bytes (little-endian,
 *  the last word filled with 0) h = (h ^ word) 0x9e3779b97f4a7c15 mod 2^64, then h = h ^ (h >> 29). It is no protection
 *  against an adversary. Cost: about a nanosecond a byte. */
template <class Message>
std::uint64_t fingerprint(const Message &message) {
  const std::uint32_t length = ros::serialization::serializationLength(message);
  std::vector<std::uint8_t> bytes(length);
  ros::serialization::OStream stream(bytes.data(), length);
  ros::serialization::serialize(stream, message);
  if constexpr (ros::message_traits::HasHeader<Message>::value)
    std::fill_n(bytes.begin(), std::min<std::size_t>(sizeof message.header.seq, bytes.size()), std::uint8_t{0});

  std::uint64_t hash = 0xcbf29ce484222325u ^ length;
  for (std::size_t i = 0; i < bytes.size(); i += sizeof hash) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes.data() + i, std::min(sizeof word, bytes.size() - i));
    hash = (hash ^ word) * 0x9e3779b97f4a7c15u;
    hash ^= hash >> 29;
  }
  return hash;
}

} // namespace curve_proximity
#endif
