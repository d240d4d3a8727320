/* SPDX-License-Identifier: BSD-3-Clause */
/* Little-endian numbers from a row of bytes. Reading past the end, and numbers that are not finite, are bad and stay
 * so. */
#ifndef CHECK_BYTES_H
#define CHECK_BYTES_H

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>

typedef struct reader {
  const unsigned char *at, *end;
  bool bad;
} reader;

static inline size_t reader_left(const reader *r) {
  return (size_t)(r->end - r->at);
}

static inline uint64_t reader_bits(reader *r, size_t n) {
  if (r->bad || reader_left(r) < n) {
    r->bad = true;
    return 0;
  }
  uint64_t bits = 0;
  for (size_t i = 0; i < n; i++) bits |= (uint64_t)r->at[i] << (8 * i);
  r->at += n;
  return bits;
}

static inline unsigned char reader_byte(reader *r) {
  return (unsigned char)reader_bits(r, 1);
}

static inline uint32_t reader_count(reader *r) {
  return (uint32_t)reader_bits(r, 4);
}

static inline double reader_number(reader *r) {
  const uint64_t bits = reader_bits(r, 8);
  double x;
  memcpy(&x, &bits, sizeof x);
  if (!isfinite(x)) r->bad = true;
  return x;
}

/* Of 4 or 8 bytes. */
static inline double reader_real(reader *r, uint32_t width) {
  if (width == 8) return reader_number(r);
  const uint32_t bits = (uint32_t)reader_bits(r, 4);
  float x;
  memcpy(&x, &bits, sizeof x);
  if (!isfinite(x)) r->bad = true;
  return (double)x;
}

static inline void reader_normal(reader *r, uint32_t width, double n[3]) {
  for (int k = 0; k < 3; k++) n[k] = reader_real(r, width);
}

#endif
