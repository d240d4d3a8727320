/* SPDX-License-Identifier: BSD-3-Clause */
#include "digest.h"

#include <algorithm>
#include <cstring>

namespace curve_proximity {
namespace {

constexpr std::array<std::uint64_t, 8> START = {0x6a09e667f3bcc908, 0xbb67ae8584caa73b, 0x3c6ef372fe94f82b,
                                                0xa54ff53a5f1d36f1, 0x510e527fade682d1, 0x9b05688c2b3e6c1f,
                                                0x1f83d9abfb41bd6b, 0x5be0cd19137e2179};

/* The order of a block's words in each of twelve rounds. */
constexpr std::uint8_t ORDER[12][16] = {
    {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15}, {14, 10, 4, 8, 9, 15, 13, 6, 1, 12, 0, 2, 11, 7, 5, 3},
    {11, 8, 12, 0, 5, 2, 15, 13, 10, 14, 3, 6, 7, 1, 9, 4}, {7, 9, 3, 1, 13, 12, 11, 14, 2, 6, 5, 10, 4, 0, 15, 8},
    {9, 0, 5, 7, 2, 4, 10, 15, 14, 1, 11, 12, 6, 8, 3, 13}, {2, 12, 6, 10, 0, 11, 8, 3, 4, 13, 7, 5, 15, 14, 1, 9},
    {12, 5, 1, 15, 14, 13, 4, 10, 0, 7, 6, 3, 9, 2, 8, 11}, {13, 11, 7, 14, 12, 1, 3, 9, 5, 0, 15, 4, 8, 6, 2, 10},
    {6, 15, 14, 9, 11, 3, 0, 8, 12, 2, 13, 7, 1, 4, 10, 5}, {10, 2, 8, 4, 7, 6, 1, 5, 15, 11, 9, 14, 3, 12, 13, 0},
    {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15}, {14, 10, 4, 8, 9, 15, 13, 6, 1, 12, 0, 2, 11, 7, 5, 3}};

inline std::uint64_t turned(std::uint64_t x, int by) {
  return x >> by | x << (64 - by);
}

inline void mix(std::uint64_t *v, int a, int b, int c, int d, std::uint64_t x, std::uint64_t y) {
  v[a] += v[b] + x;
  v[d] = turned(v[d] ^ v[a], 32);
  v[c] += v[d];
  v[b] = turned(v[b] ^ v[c], 24);
  v[a] += v[b] + y;
  v[d] = turned(v[d] ^ v[a], 16);
  v[c] += v[d];
  v[b] = turned(v[b] ^ v[c], 63);
}

/* Little-endian words, whatever the machine has. */
inline std::uint64_t wordAt(const std::uint8_t *bytes) {
  std::uint64_t word = 0;
  std::memcpy(&word, bytes, sizeof word);
#if __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__
  word = __builtin_bswap64(word);
#endif
  return word;
}

} // namespace

Hasher::Hasher() : state_(START) {
  state_[0] ^= 0x01010000 ^ std::tuple_size<Digest>::value;
}

void Hasher::compress(const std::uint8_t *block, bool last) {
  std::uint64_t m[16], v[16];
  for (int i = 0; i < 16; ++i) m[i] = wordAt(block + 8 * i);
  for (std::size_t i = 0; i < 8; ++i) {
    v[i] = state_[i];
    v[i + 8] = START[i];
  }
  v[12] ^= total_;
  if (last) v[14] = ~v[14];
#pragma GCC unroll 12
  for (int round = 0; round < 12; ++round) {
    const std::uint8_t *s = ORDER[round];
    mix(v, 0, 4, 8, 12, m[s[0]], m[s[1]]);
    mix(v, 1, 5, 9, 13, m[s[2]], m[s[3]]);
    mix(v, 2, 6, 10, 14, m[s[4]], m[s[5]]);
    mix(v, 3, 7, 11, 15, m[s[6]], m[s[7]]);
    mix(v, 0, 5, 10, 15, m[s[8]], m[s[9]]);
    mix(v, 1, 6, 11, 12, m[s[10]], m[s[11]]);
    mix(v, 2, 7, 8, 13, m[s[12]], m[s[13]]);
    mix(v, 3, 4, 9, 14, m[s[14]], m[s[15]]);
  }
  for (std::size_t i = 0; i < 8; ++i) state_[i] ^= v[i] ^ v[i + 8];
}

/* The last block waits for finish(), even where it is full. */
Hasher &Hasher::add(const void *data, std::size_t size) {
  const auto *at = static_cast<const std::uint8_t *>(data);
  while (size > 0) {
    if (used_ == BLOCK) {
      total_ += BLOCK;
      compress(open_.data(), false);
      used_ = 0;
    }
    if (used_ == 0 && size > BLOCK) {
      total_ += BLOCK;
      compress(at, false);
      at += BLOCK;
      size -= BLOCK;
      continue;
    }
    const std::size_t n = std::min(size, BLOCK - used_);
    std::memcpy(open_.data() + used_, at, n);
    used_ += n;
    at += n;
    size -= n;
  }
  return *this;
}

Hasher &Hasher::add(const std::string &text) {
  const std::uint64_t size = text.size();
  return add(&size, sizeof size).add(text.data(), text.size());
}

Digest Hasher::finish() {
  total_ += used_;
  std::fill(open_.begin() + static_cast<std::ptrdiff_t>(used_), open_.end(), std::uint8_t{0});
  compress(open_.data(), true);
  Digest out{};
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = static_cast<std::uint8_t>(state_[i / 8] >> (8 * (i % 8)));
  return out;
}

Digest digestOf(const void *data, std::size_t size) {
  return Hasher().add(data, size).finish();
}

std::string toHex(const Digest &digest) {
  static const char *const DIGITS = "0123456789abcdef";
  std::string out;
  for (const std::uint8_t byte : digest) {
    out += DIGITS[byte >> 4];
    out += DIGITS[byte & 15];
  }
  return out;
}

} // namespace curve_proximity
