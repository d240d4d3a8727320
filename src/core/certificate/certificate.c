/* SPDX-License-Identifier: BSD-3-Clause */
#include "certificate/certificate.h"

#include <stdlib.h>
#include <string.h>

/* After the magic and the width. */
enum { PLACE_OF_DELTA = 8 };

void cprox_certificate_free(cprox_certificate *certificate) {
  if (!certificate) return;
  free(certificate->bytes);
  free(certificate);
}

cprox_certificate_info cprox_certificate_get_info(const cprox_certificate *certificate) {
  return (cprox_certificate_info){
      .claim = certificate->claim, .delta = certificate->delta, .bytes = certificate->bytes, .size = certificate->size};
}

/* Room for n bytes more, or NULL. */
static unsigned char *extend(cprox_certificate *c, size_t n) {
  if (c->failed) return NULL;
  if (c->size + n > c->capacity) {
    const size_t capacity = 2 * c->capacity + n + 256;
    unsigned char *bytes = realloc(c->bytes, capacity);
    if (!bytes) {
      c->failed = true;
      return NULL;
    }
    c->bytes = bytes;
    c->capacity = capacity;
  }
  c->size += n;
  return c->bytes + c->size - n;
}

static void store(unsigned char *at, uint64_t bits, size_t n) {
  for (size_t i = 0; i < n; i++) at[i] = (unsigned char)(bits >> (8 * i) & 0xff);
}

static void put(cprox_certificate *c, uint64_t bits, size_t n) {
  unsigned char *at = extend(c, n);
  if (at) store(at, bits, n);
}

void certificate_begin(cprox_certificate *c, uint32_t width, cprox_claim claim, double delta, uint32_t sections) {
  c->size = 0;
  c->failed = false;
  c->width = width;
  c->claim = claim;
  c->delta = delta;
  for (const char *magic = "CPC1"; *magic; magic++) certificate_byte(c, (unsigned char)*magic);
  certificate_count(c, width);
  certificate_number(c, delta);
  certificate_count(c, (uint32_t)claim);
  certificate_count(c, sections);
}

void cprox_certificate_clear(cprox_certificate *c) {
  if (!c) return;
  c->size = 0;
  c->claim = CPROX_CLAIM_NONE;
  c->delta = 0.0;
}

void certificate_byte(cprox_certificate *c, unsigned char value) {
  put(c, value, 1);
}

void certificate_count(cprox_certificate *c, uint32_t value) {
  put(c, value, 4);
}

size_t certificate_short(cprox_certificate *c, uint16_t value) {
  put(c, value, 2);
  return c->size - 2;
}

void certificate_restate_short(cprox_certificate *c, size_t place, uint16_t value) {
  if (!c->failed) store(c->bytes + place, value, 2);
}

void certificate_number(cprox_certificate *c, double value) {
  uint64_t bits;
  memcpy(&bits, &value, sizeof bits);
  put(c, bits, 8);
}

void certificate_vector(cprox_certificate *c, vec3 v) {
  certificate_number(c, v.x);
  certificate_number(c, v.y);
  certificate_number(c, v.z);
}

static void put_float(cprox_certificate *c, float value) {
  uint32_t bits;
  memcpy(&bits, &value, sizeof bits);
  put(c, bits, 4);
}

void certificate_real(cprox_certificate *c, double value) {
  if (c->width == 4)
    put_float(c, (float)value);
  else
    certificate_number(c, value);
}

void certificate_normal(cprox_certificate *c, vec3 n) {
  certificate_real(c, n.x);
  certificate_real(c, n.y);
  certificate_real(c, n.z);
}

void certificate_breaks(cprox_certificate *c, const double *breaks, size_t pieces) {
  certificate_count(c, (uint32_t)pieces);
  for (size_t i = 1; i < pieces; i++) certificate_number(c, breaks[i]);
}

void certificate_restate(cprox_certificate *c, double delta) {
  uint64_t bits;
  memcpy(&bits, &delta, sizeof bits);
  c->delta = delta;
  if (!c->failed) store(c->bytes + PLACE_OF_DELTA, bits, 8);
}

/* Through memory: where two neighbours are rounded to float and back side by side, GCC 12 at -O3 leaves both as they
 * were. */
static double round_to_float(double x) {
  const volatile float rounded = (float)x;
  return (double)rounded;
}

vec3 certificate_round(const cprox_certificate *c, vec3 n) {
  if (c->width != 4) return n;
  return vec(round_to_float(n.x), round_to_float(n.y), round_to_float(n.z));
}
