/* SPDX-License-Identifier: BSD-3-Clause */
#include "random.h"

#include <math.h>
#include <stdlib.h>

rng rng_seed(uint64_t seed) {
  /* one step of splitmix64, so that neighbouring seeds share nothing; xorshift must not start at 0 */
  uint64_t z = seed + 0x9e3779b97f4a7c15u;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  z ^= z >> 31;
  return (rng){z ? z : 1};
}

uint64_t rng_next(rng *r) {
  r->state ^= r->state >> 12;
  r->state ^= r->state << 25;
  r->state ^= r->state >> 27;
  return r->state * 0x2545f4914f6cdd1du;
}

size_t rng_index(rng *r, size_t n) {
  return (size_t)((rng_next(r) >> 11) % n);
}

double rng_uniform(rng *r, double low, double high) {
  return low + (high - low) * ((double)(rng_next(r) >> 11) * 0x1p-53);
}

double rng_log_uniform(rng *r, double low, double high) {
  return exp(rng_uniform(r, log(low), log(high)));
}

double rng_awkward(rng *r, double scale) {
  const double sign = rng_next(r) >> 63 ? 1.0 : -1.0;
  const int exponent = -(int)rng_index(r, 12);
  switch (rng_index(r, 6)) {
    case 0: return sign * scale * ldexp(1.0 - 0x1p-53, exponent);
    case 1: return sign * scale * ldexp(1.0 - ldexp(1.0, -(int)rng_index(r, 53) - 1), exponent);
    case 2: return sign * scale * ldexp(1.0, exponent);
    case 3: return rng_index(r, 4) ? sign * scale * ldexp(0.5 + 0x1p-53, exponent) : 0.0;
    default: return rng_uniform(r, -scale, scale);
  }
}

vec3 rng_unit(rng *r) {
  const double z = rng_uniform(r, -1.0, 1.0), angle = rng_uniform(r, -3.141592653589793, 3.141592653589793);
  const double radius = sqrt(1.0 - z * z);
  return vec(radius * cos(angle), radius * sin(angle), z);
}

vec3 rng_in_cube(rng *r, double half) {
  const double x = rng_uniform(r, -half, half), y = rng_uniform(r, -half, half), z = rng_uniform(r, -half, half);
  return vec(x, y, z);
}

cprox_quat rng_quat(rng *r) {
  /* Shoemake's uniform rotations */
  const double split = rng_uniform(r, 0.0, 1.0), turn = 6.283185307179586;
  const double a = rng_uniform(r, 0.0, turn), b = rng_uniform(r, 0.0, turn);
  const double p = sqrt(1.0 - split), q = sqrt(split);
  return (cprox_quat){.w = p * cos(a), .x = p * sin(a), .y = q * cos(b), .z = q * sin(b)};
}

cprox_pose rng_pose(rng *r, double half) {
  const vec3 position = rng_in_cube(r, half);
  return (cprox_pose){.position = position, .orientation = rng_quat(r)};
}

size_t test_cases(size_t cases) {
  const char *text = getenv("CPROX_TEST_SCALE");
  const double scale = text ? strtod(text, NULL) : 1.0;
  const double scaled = (double)cases * scale;
  return scaled >= 1.0 ? (size_t)scaled : 1;
}
