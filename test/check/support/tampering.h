/* SPDX-License-Identifier: BSD-3-Clause */
/* Certificates that were tampered with. */
#ifndef CHECK_TEST_TAMPERING_H
#define CHECK_TEST_TAMPERING_H

#include <stdio.h>

#include "support/random.h"

enum { MOST_BYTES = 65536, HEAD = 24 };

typedef struct bytes {
  size_t n;
  unsigned char at[MOST_BYTES];
} bytes;

/* Tampers; returns what was done. b has room for 16 bytes more. */
const char *tamper(bytes *b, rng *r, const bytes *other);

/* A record of a file of certificates. */
void tampering_write(FILE *out, const bytes *b);

#endif
