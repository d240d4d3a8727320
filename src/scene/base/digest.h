/* SPDX-License-Identifier: BSD-3-Clause */
/* BLAKE2b with 32 bytes of output and no key (RFC 7693): the same bytes have the same digest, and nobody can make other
 * bytes with it. */
#ifndef CURVE_PROXIMITY_SCENE_DIGEST_H
#define CURVE_PROXIMITY_SCENE_DIGEST_H

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

namespace curve_proximity {

using Digest = std::array<std::uint8_t, 32>;

class Hasher {
 public:
  Hasher();
  Hasher &add(const void *data, std::size_t size);
  Hasher &add(const std::string &text); /* its length, too: what follows cannot be taken for a part of it */
  Digest finish();

 private:
  static constexpr std::size_t BLOCK = 128;
  void compress(const std::uint8_t *block, bool last);

  std::array<std::uint64_t, 8> state_;
  std::array<std::uint8_t, BLOCK> open_{};
  std::size_t used_ = 0;
  std::uint64_t total_ = 0;
};

Digest digestOf(const void *data, std::size_t size);

/* 64 lower-case digits. */
std::string toHex(const Digest &digest);

} // namespace curve_proximity
#endif
