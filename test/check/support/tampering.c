/* SPDX-License-Identifier: BSD-3-Clause */
#include "support/tampering.h"

#include <string.h>

static void store_double(bytes *b, size_t place, double x) {
  memcpy(b->at + place, &x, sizeof x);
}

static double load_double(const bytes *b, size_t place) {
  double x;
  memcpy(&x, b->at + place, sizeof x);
  return x;
}

/* The file's numbers are little endian, as this machine's are. */
const char *tamper(bytes *b, rng *r, const bytes *other) {
  const size_t place = rng_index(r, b->n);
  switch (rng_index(r, 9)) {
    case 0: b->at[place] ^= (unsigned char)(1u << rng_index(r, 8)); return "bit";
    case 1: b->at[place] = (unsigned char)rng_index(r, 256); return "byte";
    case 2: b->n = place; return "cut";
    case 3: b->n += 1 + rng_index(r, 8); return "longer";
    case 4: store_double(b, 8, load_double(b, 8) * (1.0 + rng_log_uniform(r, 1e-15, 1.0))); return "delta";
    case 5: store_double(b, 8, rng_log_uniform(r, 1e-6, 1e3)); return "any delta";
    case 6: { /* eight bytes scaled as if they were a number */
      if (b->n < HEAD + 8) return "nothing";
      const size_t at = HEAD + rng_index(r, b->n - HEAD - 7);
      store_double(b, at, load_double(b, at) * (1.0 + rng_log_uniform(r, 1e-15, 0.1)));
      return "number";
    }
    case 7: { /* an interval goes or comes twice */
      if (b->n < HEAD + 2) return "nothing";
      const size_t from = HEAD + rng_index(r, b->n - HEAD), length = rng_index(r, b->n - from) + 1;
      memmove(b->at + from, b->at + from + length, b->n - from - length);
      b->n -= length;
      return "gap";
    }
    default: *b = *other; return "of another query";
  }
}

void tampering_write(FILE *out, const bytes *b) {
  const uint32_t n = (uint32_t)b->n;
  const unsigned char length[4] = {(unsigned char)(n & 255), (unsigned char)(n >> 8 & 255),
                                   (unsigned char)(n >> 16 & 255), (unsigned char)(n >> 24)};
  fwrite(length, 1, 4, out);
  fwrite(b->at, 1, b->n, out);
}
