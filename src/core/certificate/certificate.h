/* SPDX-License-Identifier: BSD-3-Clause */
/* The format of a certificate and its writer. What the numbers mean stands in doc/certificates.md. */
#ifndef CPROX_CERTIFICATE_CERTIFICATE_H
#define CPROX_CERTIFICATE_CERTIFICATE_H

#include <stdbool.h>

#include "base/vec.h"
#include "curve_proximity/cprox/certificate.h"

struct query;

struct cprox_certificate {
  /* Proves the answer of a query, or tells why there is no proof, after what the answer says. Queries call it through
   * the handle: who makes no certificate links no proofs. */
  void (*prove)(const struct query *q, const cprox_result *answer);
  unsigned char *bytes;
  size_t size, capacity;
  bool failed; /* memory was out */
  uint32_t width;
  cprox_claim claim;
  double delta;
};

/* Bytes before the substance. */
enum { CERTIFICATE_HEAD = 24 };

/* Kinds of sections. */
enum { SECTION_CONVEX = 1, SECTION_CURVE = 2, SECTION_ELEMENTS = 3 };

/* Tags of the nodes of a tree of parts of a curve and parts of what stands: of a curve, or of elements. */
enum { COVER_LEAF = 0, COVER_CUT_FIRST = 1, COVER_CUT_SECOND = 2 };

/* Empties it and writes the head; width: bytes of a normal's number, 4 or 8. */
void certificate_begin(cprox_certificate *c, uint32_t width, cprox_claim claim, double delta, uint32_t sections);

void certificate_byte(cprox_certificate *c, unsigned char value);
void certificate_count(cprox_certificate *c, uint32_t value);

/* Returns where it stands, so that it can be overwritten. */
size_t certificate_short(cprox_certificate *c, uint16_t value);
void certificate_restate_short(cprox_certificate *c, size_t place, uint16_t value);

void certificate_number(cprox_certificate *c, double value);
void certificate_vector(cprox_certificate *c, vec3 v);
void certificate_normal(cprox_certificate *c, vec3 n);

/* A number of the width. */
void certificate_real(cprox_certificate *c, double value);

/* How a curve falls into pieces: their number, and the parameters at which they join. */
void certificate_breaks(cprox_certificate *c, const double *breaks, size_t pieces);

/* Lowers the claim. */
void certificate_restate(cprox_certificate *c, double delta);

/* The normal as it will be read: rounded to the width. */
vec3 certificate_round(const cprox_certificate *c, vec3 n);

#endif
